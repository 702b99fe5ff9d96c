"""Constants of nature in a method: their digits are CODATA's, and their errors are not independent."""

import json
from pathlib import Path

import pytest
from helpers import method_folder
from scipy.constants import physical_constants

import loopsheet
import loopsheet.report.method.words
from loopsheet.report.cli import main
from loopsheet.report.column import SheetError
from loopsheet.report.study import Study


def test_constants_of_nature_have_their_digits(tmp_path: Path) -> None:
    code = (
        "from loopsheet import Method, constant, given, let\nclass Gas(Method):\n"
        "    p = given('kPa', 'pressure')\n    V = given('L', 'volume')\n"
        "    T = given('degC', 'temperature')\n"
        "    R = constant('molar gas constant')\n    G = constant('Newtonian constant of gravitation')\n"
        "    n = let(p * V / (R * T), 'amount')\n    twice = let(2 * G, 'twice')\n"
    )
    more = '[parameters]\np = "101.325 kPa"\nV = "22.41396954 L"\nT = "0 degC"\n'
    path = method_folder(tmp_path, code, more=more)
    made = loopsheet.load(path)
    assert made["n"].value == pytest.approx(1, rel=1e-9)  # of an ideal gas
    assert made["n"].unit == "mol"
    assert made["G"].value == pytest.approx(6.6743e-11, rel=1e-4)
    assert made["twice"].u == pytest.approx(2 * made["G"].u)
    assert made["G"].u > 0 == made["R"].u


@pytest.mark.parametrize("taken", ["8.314", "8.31"])
def test_a_constant_of_fewer_digits_explains_what_was_published(tmp_path: Path, taken: str) -> None:
    """And accuses no number of being misprinted."""
    code = (
        "from loopsheet import Method, constant, given, let\n\n\nclass Energy(Method):\n"
        "    b = given('K', 'slope')\n    c = given('K', 'another')\n    R = constant('molar gas constant')\n"
        "    E_b = let(b * R, 'energy', 'kJ/mol')\n    E_c = let(c * R, 'another', 'kJ/mol')\n"
    )
    rows = (f"text,E_{n},,{float(taken) * size:.3f},J/mol" for n, size in (("b", 11823.29), ("c", 7512.40)))
    more = '[parameters]\nb = "11823.29 K"\nc = "7512.40 K"\n'
    published = "\n".join(["source,cell,index,value,unit", *rows, ""])
    path = method_folder(tmp_path, code, more=more, published=published)
    referee = Study(path).refereed.referee
    first, *others = referee.explanations
    assert [(each.kind, each.cell, each.would_print) for each in first.changes] == [("parameter", "R", taken)]
    assert others == []
    (path / "report.toml").write_text(
        (path / "report.toml")
        .read_text()
        .replace("[published]", f'R = "{taken} J/(mol*K), exact"\n[published]')
    )
    assert all(each.verdict == "same" for each in Study(path).refereed.comparisons)


@pytest.mark.parametrize(
    ("formula", "stated", "warns"),
    [
        ("e**2 / (4 * pi * eps * m * c**2)", "", True),  # CODATA's classical electron radius: u 1.3e-24 m
        ("e**2 / (4 * pi * eps * m * c**2)", '[uncertainty.correlation]\n"eps, m" = "-0.99"\n', False),
        ("m * c**2 / e", "", False),
    ],
)
def test_constants_that_were_adjusted_together_are_correlated(
    formula: str, stated: str, warns: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = "from sympy import pi\nfrom loopsheet import Method, constant, let\n\n\nclass Radius(Method):\n"
    code += "    e, m = constant('elementary charge'), constant('electron mass')\n"
    code += (
        "    eps = constant('vacuum electric permittivity')\n    c = constant('speed of light in vacuum')\n"
    )
    code += f"    r = let({formula}, 'radius')\n"
    path = method_folder(tmp_path, code, more=f"[parameters]\n{stated}")
    assert main(["check", str(path), "--format", "json"]) == 0
    checks = json.loads(capsys.readouterr().out)["checks"]
    told = [each["message"] for each in checks if each["kind"] == "constants"]
    says = "r rests on eps and m, which were adjusted together: their errors are correlated, which its u "
    assert told == [f"{says}leaves out; state it under [uncertainty.correlation]"] * warns


def test_every_constant_may_be_declared_or_is_refused() -> None:
    refused = {}
    for name in physical_constants:
        try:
            exec(
                f"class One(Method):\n    c = constant({name!r})\n    d = let(2 * c, 'twice')\n",
                {**vars(loopsheet.report.method.words)},
            )
        except SheetError as error:
            refused[name] = str(error)
    assert all("unit" in said for said in refused.values()), refused
    assert len(refused) < 0.1 * len(physical_constants)
    with pytest.raises(SheetError, match="do you mean molar gas constant"):
        exec(
            "class One(Method):\n    c = constant('gas constant')\n", {**vars(loopsheet.report.method.words)}
        )
