"""Values of one report in another: as if both were one, in value and in uncertainty."""

from __future__ import annotations

import json
import math
import re
import shutil
from pathlib import Path
from typing import Any

import openpyxl
import pytest
from helpers import method_folder
from two_reports import forged

from loopsheet.report.cli import main
from loopsheet.report.inputs.inputs import load
from loopsheet.report.machine.kept import SETTING
from loopsheet.report.messages.errors import InputError, render
from loopsheet.report.result.uncertain import Budget
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.monte_carlo import draw
from loopsheet.report.uncertainty.propagation import Spread
from loopsheet.report.views.budget import FORMATS
from loopsheet.report.which_workbook import find_workbook

HEAD = """\
from sympy import Symbol, pi
from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.quantity import Bounds
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.workbook import Measured, Parameter, Workbook

k, n = (Symbol(s, integer=True, positive=True) for s in ("k", "n"))
r = Column("r", Axis("readings", k, n), Given("measured"), "1", "a reading", positive=False)
made, equations = {}, []

def given(name, unit):
    made[name] = Column(name, None, Given("parameter"), unit, name)
    return made[name].symbol

def computed(name, unit, right):
    eq = Equation(f"({len(equations) + 1})", (Symbol(name), right), "definition", Kind.DEFINITION, name)
    equations.append(eq)
    made[name] = Column(name, None, Formula(eq), unit, name)
    return made[name].symbol
"""
TAIL = """
given = [c for c in made.values() if isinstance(c.rule, Given)]
parameters = tuple(Parameter(c.name, c.unit, c.name, Bounds(low=0, low_open=True)) for c in given)
WORKBOOK = Workbook(
    name="made", title="Made", source="none", ledger=lambda: Ledger(tuple(equations)),
    measured=(Measured("r", "1", "a reading"),), parameters=parameters,
    sheet=lambda names: Sheet((r, *made.values())), headline=tuple(HEADLINE),
)
"""
BALL = """
d, reading, gain, air = given("d", "m"), given("reading", "kg"), given("gain", "1"), given("air", "kg/m^3")
V = computed("V", "m^3", pi / 6 * d**3)
m = computed("m", "kg", gain * reading + air * V)
HEADLINE = ["m", "V"]
"""
DENSITY = """
rho = computed("rho", "kg/m^3", m / V)
h = computed("h", "m^2", m / V / rho_w * d_2**2)
HEADLINE = ["rho", "h"]
"""
TAKING = """
m, V, rho_w, d_2 = given("m", "kg"), given("V", "m^3"), given("rho_w", "kg/m^3"), given("d_2", "m")
"""
GIVEN = {
    "d": "12.70 mm, U = 0.03, k = 2",
    "reading": "8.366 g, s = 0.02, n = 5",
    "gain": "1.000, u = 0.002",
    "air": "1.2 kg/m^3, +-0.1 rect",
}
WATER = {"rho_w": "998.2 kg/m^3, +-0.5 rect", "d_2": "3.1 mm, u = 0.01"}
MORE = '[uncertainty.correlation]\n"d, air" = "0.4"\n'


def folder(at: Path, workbook: str, parameters: dict[str, str], more: str = "") -> Path:
    """Write a report folder; what begins with a brace is no text."""
    said = "".join(f"{n} = {t}\n" if t[0] == "{" else f'{n} = "{t}"\n' for n, t in parameters.items())
    code = HEAD + workbook + TAIL
    return method_folder(at, code, "test,r [1]\n1,1\n2,2\n", f"[parameters]\n{said}{more}")


def build(at: Path) -> Path:
    """Its values.json."""
    assert main(["build", str(at), "--to", "json"]) == 0
    return at / "out" / "values.json"


def taken(**cells: str) -> dict[str, str]:
    """Parameters as cells of the report of the ball."""
    return {name: f'{{ from = "ball/out/values.json", cell = "{cell}" }}' for name, cell in cells.items()}


@pytest.fixture
def apart(tmp_path: Path) -> Path:
    """A density from mass and volume of another report."""
    at = folder(tmp_path / "density", TAKING + DENSITY, taken(m="m", V="V") | WATER)
    build(folder(at / "ball", BALL, GIVEN, MORE))
    return at


def budget(at: Path, cell: str = "rho") -> tuple[Budget, Spread]:
    report = Study(at).computed
    spread = Spread(report.inputs, report.values)
    return spread.budget(cell, 0), spread


def test_a_number_is_the_same_in_one_folder_and_in_two(apart: Path, tmp_path: Path) -> None:
    water = 'rho_w, d_2 = given("rho_w", "kg/m^3"), given("d_2", "m")\n'
    whole = folder(tmp_path / "whole", BALL + water + DENSITY, GIVEN | WATER, MORE)
    for cell in ("rho", "h"):
        (one, own), (other, several) = budget(whole, cell), budget(apart, cell)
        assert other.value == pytest.approx(one.value, rel=1e-15)
        assert other.u == pytest.approx(one.u, rel=1e-12)
        assert other.dof == one.dof
        assert other.factor == pytest.approx(one.factor, rel=1e-12)
    cells = [("rho", 0), ("h", 0), ("m", 0), ("V", 0)]
    assert several.covariance(cells) == pytest.approx(own.covariance(cells), rel=1e-12)
    # had both been independent, the diameter would have counted once too often or too seldom
    m, V = (several.budget(name, 0) for name in "mV")
    alone = other.value and math.hypot(m.u / m.value, V.u / V.value) * budget(apart)[0].value
    assert abs(alone - budget(apart)[0].u) > 1e-4 * alone


SQUARE = """
a, b = given("a", "1"), given("b", "1")
c, d = computed("c", "1", 2 * a), computed("d", "1", b**2)
HEADLINE = ["c", "d"]
"""
AGAIN = """
c, d = given("c", "1"), given("d", "1")
e, f = computed("e", "1", c * 3), computed("f", "1", d * 3)
HEADLINE = ["e", "f"]
"""


@pytest.mark.parametrize("error", ["u = 0.2, min = 0", "exponential"])
def test_a_distribution_comes_with_a_number(tmp_path: Path, error: str) -> None:
    at = folder(tmp_path / "again", AGAIN, taken(c="c", d="d"))
    build(folder(at / "ball", SQUARE, {"a": f"0.1, {error}", "b": "1.0, u = 0.1"}))
    (own, _), (other, _) = budget(at / "ball", "c"), budget(at, "e")
    assert other.factor == pytest.approx(own.factor, rel=1e-9) != pytest.approx(1.96, abs=0.01)
    assert other.u == pytest.approx(3 * own.u, rel=1e-9)


def test_what_is_doubted_of_a_number_is_told_where_it_is_taken(tmp_path: Path) -> None:
    at = folder(tmp_path / "again", AGAIN, taken(c="c", d="d"))
    build(folder(at / "ball", SQUARE, {"a": "0.1, u = 0.01", "b": "0.1, u = 0.1"}))
    told = {check.name: check for check in Study(at).computed.oddities if check.kind == "taken"}
    assert told["c"].note == ""
    assert told["d"].note == "warning"
    assert "ball/out/values.json, where of d: U may not hold: second order counts" in told["d"].message


def test_monte_carlo_draws_what_is_shared_once(apart: Path) -> None:
    report = Study(apart).computed
    own = Spread(report.inputs, report.values).budget("rho", 0)
    found = draw(report.inputs, report.values, own, 100_000, tolerance=0.0)
    assert found.symmetric[1] - found.symmetric[0] == pytest.approx(2 * own.expanded, rel=0.03)


def test_a_row_of_a_budget_says_of_which_taken_number_it_tells(apart: Path) -> None:
    """The estimate beside an error of another report is the number that was taken, with its u's digits."""
    report = Study(apart).computed
    rows = FORMATS["text"](report, Spread(report.inputs, report.values).budget("rho", 0)).splitlines()
    found = [re.split(r"  +", row)[:2] for row in rows if "values.json)  " in row]
    alone = [estimate for _, estimate in found if estimate != "—"]  # what moves several has no estimate
    assert alone
    for estimate in alone:
        name, _, told = estimate.partition(" = ")
        assert name in ("m", "V")
        value, u = report.values.scalar(name), report.inputs.printed(name)[0].u
        assert told.split()[0] == report.stated(name, value, u)[0].text.split()[0]


def begun(spread: Spread) -> set[str]:
    """Where errors of other reports begin, as they are named."""
    return {source.name.partition(" (")[2] for source in spread.sources if source.origin}


def test_what_two_reports_share_with_a_third_is_still_one(apart: Path, tmp_path: Path) -> None:
    build(apart)
    last = """
rho, m, V = given("rho", "kg/m^3"), given("m", "kg"), given("V", "m^3")
one = computed("one", "1", rho * V / m)
HEADLINE = ["one"]
"""
    at = tmp_path / "last"
    said = {"rho": '{ from = "density/out/values.json", cell = "rho" }'}
    said |= {name: f'{{ from = "density/ball/out/values.json", cell = "{name}" }}' for name in "mV"}
    folder(at, last, said)
    for file in ("density/out/values.json", "density/ball/out/values.json"):
        (at / file).parent.mkdir(parents=True, exist_ok=True)
        (at / file).write_bytes((tmp_path / file).read_bytes())
    found, spread = budget(at, "one")
    assert found.value == pytest.approx(1, rel=1e-15)
    assert spread.covariance([("one", 0)])[0, 0] < 1e-28
    # d, reading, gain and air: each is one, by whatever way it came
    assert len([source for source in spread.sources if source.origin]) == 4
    assert begun(spread) == {"density/ball/out/values.json)"}
    alone = tmp_path / "alone"
    one = 'rho = given("rho", "kg/m^3")\none = computed("one", "kg/m^3", rho)\nHEADLINE = ["one"]\n'
    folder(alone, one, {"rho": '{ from = "density/out/values.json", cell = "rho" }'})
    (alone / "density/out").mkdir(parents=True)
    (alone / "density/out/values.json").write_bytes((tmp_path / "density/out/values.json").read_bytes())
    _, spread = budget(alone, "one")
    assert begun(spread) == {"through density/out/values.json)"}


def test_the_manifest_names_what_was_taken(apart: Path, capsys: pytest.CaptureFixture[str]) -> None:
    build(apart)
    manifest = json.loads((apart / "out/manifest.json").read_text(encoding="utf-8"))
    assert "ball/out/values.json" in manifest["inputs"]
    capsys.readouterr()
    assert main(["budget", "rho", str(apart)]) == 0
    told = capsys.readouterr().out
    assert "reading (ball/out/values.json)" in told
    assert "d (ball/out/values.json) and air (ball/out/values.json) are correlated: 0.4" in told


def refused(at: Path) -> tuple[str, str]:
    """The code of the one finding, and how it reads."""
    with pytest.raises(InputError) as caught:
        load(at, find_workbook)
    (found,) = caught.value.diagnostics
    assert found.at.path.endswith("report.toml")
    return found.code, render(found)


def test_a_report_does_not_begin_with_its_own_result(apart: Path) -> None:
    folder(apart, TAKING + DENSITY, taken(V="V") | WATER | {"m": '{ from = "out/values.json", cell = "m" }'})
    shutil.copytree(apart / "ball" / "out", apart / "out")
    code, told = refused(apart)
    assert (code, "would begin with the last one" in told) == ("LS437", True)


@pytest.mark.parametrize(
    ("said", "code"),
    [
        ('{ from = "ball/out/values.json" }', "LS204"),
        ('{ from = "ball/out/values.json", cell = "m", units = "g" }', "LS203"),
        ('{ from = "ball/out/values.json", cell = "m", unit = "um" }', "LS422"),
        ('{ from = "ball/out/values.json", cell = 3 }', "LS205"),
        ('{ from = "ball/out/value.json", cell = "m" }', "LS104"),
        ('{ from = "../density/ball/out/values.json", cell = "m" }', "LS107"),
        ('{ from = "ball/report.toml", cell = "m" }', "LS437"),
        ('{ from = "ball/out/manifest.json", cell = "m" }', "LS437"),
        ('{ from = "ball/out/values.json", cell = "mm" }', "LS505"),
        ('{ from = "ball/out/values.json", cell = "m[1]" }', "LS505"),
        ('{ from = "ball/out/values.json", cell = "r[1]" }', "LS422"),
        ('{ from = "ball/out/values.json", cell = "V" }', "LS422"),
    ],
)
def test_what_cannot_be_taken_is_told_where_it_stands(apart: Path, said: str, code: str) -> None:
    folder(apart, TAKING + DENSITY, taken(V="V") | WATER | {"m": said})
    assert refused(apart)[0] == code


def changed(at: Path, **cell: Any) -> None:
    """Change the cell m of the report of the ball."""
    file = at / "ball/out/values.json"
    content = json.loads(file.read_text(encoding="utf-8"))
    content["cells"]["m"] |= cell
    forged(file, content)


@pytest.mark.parametrize(
    ("cell", "code", "word"),
    [
        ({"unit": "g"}, "LS422", "'g'"),
        ({"unit": "mmm"}, "LS422", "mmm"),
        ({"value": None, "status": "#DOMAIN!"}, "LS437", "#DOMAIN!"),
        ({"value": -1.0}, "LS406", "-1.0"),
        ({"value": "8"}, "LS437", "cells.m"),
    ],
)
def test_a_file_that_has_changed_is_told(apart: Path, cell: dict[str, Any], code: str, word: str) -> None:
    changed(apart, **cell)
    found, told = refused(apart)
    assert (found, word in told) == (code, True)


def test_what_is_taken_says_its_uncertainty_itself(apart: Path) -> None:
    for more in ('[uncertainty]\nm = "u = 1 g"\n', '[uncertainty.correlation]\n"m, V" = "0.5"\n'):
        folder(apart, TAKING + DENSITY, taken(m="m", V="V") | WATER, more)
        assert refused(apart)[0] in ("LS433", "LS434")


def test_a_file_that_tells_nothing_of_influences_is_refused(apart: Path) -> None:
    file = apart / "ball/out/values.json"
    content = json.loads(file.read_text(encoding="utf-8"))
    del content["influences"]
    forged(file, content)
    with pytest.raises(InputError) as caught:
        load(apart, find_workbook)
    assert [found.code for found in caught.value.diagnostics] == ["LS437"] * 2  # of m and of V
    content["influences"] = {"inputs": "0", "sources": [], "cells": {"m": [1.0]}}
    forged(file, content)
    code, told = refused(apart)
    assert (code, "its sources do not fit together" in told) == ("LS437", True)


def test_a_file_is_taken_as_it_was_built_or_from_elsewhere(apart: Path) -> None:
    """What lies beside its manifest has its fingerprint; without one it came from elsewhere."""
    file = apart / "ball/out/values.json"
    content = json.loads(file.read_text(encoding="utf-8"))
    content["cells"]["m"]["value"] *= 1.001
    file.write_text(json.dumps(content), encoding="utf-8")
    code, told = refused(apart)
    assert (code, "changed after it was built" in told) == ("LS437", True)
    forged(file, content)
    load(apart, find_workbook)


def test_what_was_kept_of_a_changed_file_is_not_believed(
    apart: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Built without the manifest, it comes from elsewhere; with the manifest back, it was changed."""
    monkeypatch.setenv(SETTING, str(tmp_path / "kept"))
    file, manifest = apart / "ball/out/values.json", apart / "ball/out/manifest.json"
    content, fingerprints = json.loads(file.read_text(encoding="utf-8")), manifest.read_bytes()
    content["cells"]["m"]["value"] *= 1.001
    file.write_text(json.dumps(content), encoding="utf-8")
    manifest.unlink()
    assert main(["build", str(apart)]) == 0
    manifest.write_bytes(fingerprints)
    assert main(["build", str(apart)]) == 2
    assert "changed after it was built" in capsys.readouterr().err


def test_check_warns_of_outputs_that_are_older_than_their_inputs(
    apart: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def warnings() -> list[str]:
        main(["check", str(apart)])
        return [line for line in capsys.readouterr().out.splitlines() if "is older than" in line]

    build(apart)
    assert warnings() == []
    for at in (apart / "ball", apart):
        with (at / "report.toml").open("a", encoding="utf-8") as file:
            file.write("# another line\n")
    taken, own = warnings()
    assert "ball/out is older" in taken
    assert "report.toml, and so are the numbers that are taken from it" in taken
    assert f"{apart.as_posix()}/out is older than what it was built from, report.toml: build it" in own
    build(apart / "ball")  # whose numbers are the same, and its manifest is not
    assert len(warnings()) == 1


def test_build_warns_of_older_numbers_that_it_takes(apart: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def warnings() -> list[str]:
        build(apart)
        return [line for line in capsys.readouterr().out.splitlines() if "is older than" in line]

    assert warnings() == []
    for at in (apart / "ball", apart):
        with (at / "report.toml").open("a", encoding="utf-8") as file:
            file.write("# another line\n")
    told = warnings()
    assert len(told) == 1  # what is built now is not older
    assert "ball/out is older than what it was built from, report.toml, and so are the numbers" in told[0]
    assert warnings() == told  # of what was kept, too
    build(apart / "ball")
    assert warnings() == []


def test_a_report_that_is_not_built_yet_is_told_how(apart: Path) -> None:
    folder(apart, TAKING + DENSITY, taken(V="V") | WATER | {"m": '{ from = "none/values.json", cell = "m" }'})
    assert "'loopsheet build' of its folder writes it" in refused(apart)[1]


def test_a_number_that_falls_with_an_influence_of_another_report(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The sign of its sensitivity is live in the workbook, and the judge would see another one."""
    head = "from loopsheet import Method, given, let\n\n\n"
    first = head + (
        'class One(Method, source="own", headline="b"):\n    "A density."\n'
        '    m = given("g", "mass", positive=True)\n    V = given("mL", "volume", positive=True)\n'
        '    b = let(m / V, "density", "g/mL")\n'
    )
    second = head + (
        'class Two(Method, source="own", headline="r"):\n    "A density by a factor."\n'
        '    b = given("g/mL", "density", positive=True)\n    c = given("1", "factor")\n'
        '    r = let(c * b, "both", "g/mL")\n'
    )
    one, two = tmp_path / "two" / "one", tmp_path / "two"
    given = 'm = "2.000 g, u = 0.002 g"\nV = "1.000 mL, u = 0.004 mL"'
    taken = 'b = { from = "one/out/values.json", cell = "b" }\nc = "1.000, u = 0.001"'
    for at, code, parameters in ((one, first, given), (two, second, taken)):
        method_folder(at, code, more=f"[parameters]\n{parameters}\n")
    assert main(["build", str(one)]) == main(["build", str(two)]) == 0
    assert main(["check", str(two)]) == 0
    assert "xlsx" in capsys.readouterr().out
    book = openpyxl.load_workbook(two / "out" / "report.xlsx", data_only=True)["uncertainty"]
    told = {str(row[0]): row[6:8] for row in book.iter_rows(values_only=True) if row[6] is not None}
    assert told["V (one/out/values.json)"] == (pytest.approx(-1), pytest.approx(-0.008))
