"""What the law of propagation does not describe is not told as if it did: beside closed forms."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from loopsheet.report.cli import main
from loopsheet.report.judge import engines
from loopsheet.report.study import Study

WORKBOOK = """\
from sympy import Abs, Max, Min, sin, sqrt, tanh

from loopsheet import Method, given, let, mean, measured


class Far(Method):
    \"""Nowhere near a straight line.\"""

    a = given("mm", "one")
    b = given("mm", "another")
    x = given("1", "a number")
    y = measured("mm", "reading")
    c = let(FORMULA, "result")
"""
TOML = """\
workbook = "workbook.py"
[parameters]
a = "{a} mm, u = {u} mm"
b = "{b} mm, u = {u} mm"
x = "0.0, u = {u}"
[measurements]
file = "m.csv"
[limits]
c = "{low} .. {high}{unit}"
"""


def normal(z: float) -> float:
    return math.erfc(-z / math.sqrt(2)) / 2


CASES = {
    # formula: a, b, u, limits in SI and their unit, probability
    "a**3": ("0.0", "0.0", "1", "-0.1", "0.1", " mm^3", 2 * normal(0.1 ** (1 / 3)) - 1),
    "a * b * 0 + (a + b)**3": ("0.0", "0.0", "1", "-1", "1", " mm^3", 2 * normal(1 / 2**0.5) - 1),
    "sqrt(a**2 + b**2)": ("0.0", "0.0", "1", "0", "0.1", " mm", 1 - math.exp(-0.005)),
    "tanh(x)": ("0", "0", "3", "-1", "1", "", 1.0),
    "sin(x)": ("0", "0", "1.2", "-0.9", "0.9", "", 0.7404),
    "Max(a, b)": ("1.000", "1.005", "0.02", "0", "1.03", " mm", normal(1.5) * normal(1.25)),
    "Min(a, b)": ("1.000", "1.005", "0.02", "0.98", "9", " mm", normal(1.0) * normal(1.25)),
    "Abs(a - b)": (
        *("1.000", "1.005", "0.02", "0", "0.03", " mm"),
        normal(0.025 / 0.02 / 2**0.5) - normal(-0.035 / 0.02 / 2**0.5),
    ),
    "2 * Abs(a - b)": (  # no error alone reaches the corner, both together do: U = 0.11 mm of 0.1 mm
        *("1.000", "1.050", "0.02", "0", "0.06", " mm"),
        normal(-0.02 / 0.02 / 2**0.5) - normal(-0.08 / 0.02 / 2**0.5),
    ),
}


def folder(path: Path, formula: str, a: str, b: str, u: str, low: str, high: str, unit: str) -> Path:
    (path / "workbook.py").write_text(WORKBOOK.replace("FORMULA", formula), encoding="utf-8")
    (path / "m.csv").write_text("y [mm]\n1.0\n1.2\n1.7\n", encoding="utf-8")
    told = TOML.format(a=a, b=b, u=u, low=low, high=high, unit=unit)
    (path / "report.toml").write_text(told, encoding="utf-8")
    return path


@pytest.mark.parametrize("formula", CASES)
def test_limits_are_drawn_and_the_doubt_stands_beside_the_result(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], formula: str
) -> None:
    *own, probability = CASES[formula]
    report = Study(folder(tmp_path, formula, *own)).computed
    (found,) = report.uncertain().conformities
    assert found.budget.draws == 20_000
    assert found.probability == pytest.approx(probability, abs=0.012)
    assert report.uncertain().advice["c"].startswith(("U may not hold", "U does not hold", "U is not known"))
    assert main(["budget", "c", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert "exactly" not in told
    assert "by 20000 draws" in told


@pytest.mark.parametrize(
    ("formula", "u"),
    [("a - a + 3 * x / (1 + x * 0) * 0 + 1", 0.0), ("mean(y - mean(y)) + a", 1.0), ("a + b", 2**0.5)],
)
def test_what_does_not_move_and_what_is_linear_is_told_as_before(
    tmp_path: Path, formula: str, u: float
) -> None:
    unit = "" if u == 0 else " mm"
    report = Study(folder(tmp_path, formula, "0.0", "0.0", "1", "-9", "9", unit)).computed
    (found,) = report.uncertain().conformities
    assert found.budget.u == pytest.approx(u * (1e-3 if unit else 1), rel=1e-6)
    assert not found.budget.draws
    assert not report.uncertain().advice.get("c")


@pytest.mark.parametrize("power", [3, 4, 6])
def test_an_unknown_uncertainty_is_drawn_where_it_is_asked_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], power: int
) -> None:
    """Of even powers, too: how slopes change a step away is no second derivative there."""
    *own, unit = CASES["a**3"][:-1]
    where = str(folder(tmp_path, f"a**{power}", *own, unit.replace("3", str(power))))
    assert main(["budget", "c", where, "--draws", "40000"]) == 0
    told = capsys.readouterr().out
    assert "its first and second derivatives are 0 here" in told
    assert "Monte Carlo, 40000 draws" in told
    assert main(["build", str(tmp_path), "--to", "html"]) == 0
    assert "(U is not known: its first and second derivatives are 0 here; use" in capsys.readouterr().out
    assert "U is not known: its first" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_an_estimate_that_no_draw_comes_near_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each of ten squares is above that of the estimate: their sum is, in all draws."""
    formula, own = "sqrt(total((y - mean(y))**2))", ("1", "1", "1", "0", "9", " mm")
    where = folder(tmp_path, formula, *own)
    code = (where / "workbook.py").read_text(encoding="utf-8").replace("measured", "measured, total", 1)
    (where / "workbook.py").write_text(code, encoding="utf-8")
    rows = "\n".join(f"{10 + n % 2 / 1000}" for n in range(10))
    (where / "m.csv").write_text(f"y [mm]\n{rows}\n", encoding="utf-8")
    with (where / "report.toml").open("a", encoding="utf-8") as file:
        file.write('[uncertainty]\ny = "u = 0.1 mm"\n')
    assert main(["budget", "c", str(where), "--draws", "20000"]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "the estimate lies below the draws: errors move it up" in told
    assert "the interval of the draws holds" not in told


def test_what_underflows_is_no_finding_and_what_is_off_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """exp(-2500) is 0 for a double, and 1e-1086 at 50 digits."""
    own = ("0.0", "0.0", "1", "-9", "9", "")
    where = folder(tmp_path, "exp(-2500 + x)", *own)
    code = (where / "workbook.py").read_text(encoding="utf-8").replace("import Abs", "import exp, Abs", 1)
    (where / "workbook.py").write_text(code, encoding="utf-8")
    (numpy,) = Study(where).numpy
    assert not numpy.findings
    monkeypatch.setattr(engines, "SMALLEST", 0)
    (numpy,) = Study(where).numpy
    assert numpy.findings
