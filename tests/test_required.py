"""Limits between formulas: what has to stay below another has a margin, on which the report decides."""

from pathlib import Path

import pytest

from loopsheet import Method, given, load, required
from loopsheet.report.cli import main
from loopsheet.report.column import SheetError
from loopsheet.report.result.conformity import decision
from loopsheet.report.study import Study

CODE = """\
from loopsheet import Method, given, let, measured, required


class Column(Method, rows="loads"):
    "A column."

    F = measured("kN", "load", positive=True)
    d = given("mm", "width", positive=True)
    w = given("mm", "greatest width", positive=True)
    Y = given("MPa", "yield stress", positive=True)
    p = let(F / d**2, "stress", "MPa")
    thin = required(d <= w, "room", "mm")
    elastic = required(p < 0.9 * Y, "no yield", "MPa")
"""
TABLE = "load,F [kN]\n1,20.0\n2,35.0\n"
TOML = """\
workbook = "workbook.py"
[parameters]
d = "10.0 mm"
w = "15.0 mm"
Y = "%s MPa"
[measurements]
file = "measurements.csv"
"""


def folder(place: Path, stress: str, more: str = "") -> Path:
    for name, text in (
        ("workbook.py", CODE),
        ("measurements.csv", TABLE),
        ("report.toml", TOML % stress + more),
    ):
        (place / name).write_text(text, encoding="utf-8")
    return place


def test_a_margin_is_computed_and_decided_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = load(folder(tmp_path, "500"))
    assert found["elastic"].value == pytest.approx([0.9 * 500 - 200, 0.9 * 500 - 350])
    assert (float(found["thin"]), found["thin"].unit) == (pytest.approx(5), "mm")
    assert main(["check", str(tmp_path)]) == 0
    capsys.readouterr()
    assert main(["budget", "elastic[2]", str(tmp_path)]) == 0
    assert "limits at least 0 MPa, no guard band\nelastic[2] conforms" in capsys.readouterr().out


def test_the_report_says_of_what_a_margin_is(tmp_path: Path) -> None:
    report = Study(folder(tmp_path, "500")).computed
    said = [decision(report, each) for each in report.uncertain().conformities]
    assert [each.partition(" conforms: ")[0] for each in said] == [
        "Room, margin 5.000 mm: thin",
        "No yield, margin 250.0 MPa: elastic[1]",
        "No yield, margin 100.0 MPa: elastic[2]",
    ]


def test_what_is_not_met_is_a_finding(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert load(folder(tmp_path, "350"))["elastic"].value == pytest.approx([115, -35])
    assert main(["check", str(tmp_path)]) == 1
    told = capsys.readouterr().out
    assert "elastic[2] does not conform" in told
    assert "elastic[1] does not" not in told


@pytest.mark.parametrize(("more", "code"), [('elastic = ">= 150 MPa"', 1), ('elastic = ">= -50 MPa"', 0)])
def test_a_folder_may_say_otherwise(tmp_path: Path, more: str, code: int) -> None:
    stress = "500" if code else "350"
    assert main(["check", str(folder(tmp_path, stress, f"[limits]\n{more}\n"))]) == code


def test_the_rule_of_the_folder_holds_for_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    place = folder(tmp_path, "500", '[limits.rule]\nguard = "200 U"\n')
    assert main(["check", str(place)]) == 1
    assert "no decision on elastic[2]: it lies in the guard band" in capsys.readouterr().out


def test_what_is_no_limit_is_refused() -> None:
    with pytest.raises(SheetError) as told:

        class Wrong(Method):
            """Three of them."""

            a = given("m", "a", positive=True)
            b = given("s", "b", positive=True)
            c = required(a - b, "nothing")
            d = required(a > 0, "what is let in is positive")
            e = required(a < b, "of two kinds")

    for said, word in zip(told.value.__notes__, ("no comparison", "holds always", "cannot add"), strict=True):
        assert word in said
