"""Functions and decimals that a method may hold, in roots and in models of fits: all engines, and proofs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from helpers import method_folder
from scipy.optimize import curve_fit

from loopsheet.report.cli import main
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.propagation import Spread

ROOTS = """from sympy import Abs, Max, acos, asin, cosh, pi, tan

from loopsheet import Method, given, measured, root, unknown


class Roots(Method, rows="slabs"):
    Bi = measured("1", "Biot number", positive=True)
    A = given("1", "a share", low=0, high=1)
    x = unknown()
    x = root(x * tan(x), Bi, "first eigenvalue of a slab", low=0.001, high=1.57)
    s = unknown()
    s = root(asin(s / 2) + asin(s / 3), A, "sine", low=0, high=1.9)
    c = unknown()
    c = root(acos(c), 2 * A, "cosine", low=-1, high=1)
    q = unknown()
    q = root(cosh(q), 1 + A, "a catenary", low=0, high=5)
    b = unknown()
    b = root(b * Abs(b) + 2 * b, A, "either side of 0", low=-0.9, high=0.9)
    m = unknown()
    m = root(Max(m, 0.1) + 2 * m, A, "with a threshold", low=-0.9, high=0.9)
"""
STICK = """from sympy import Abs, Max, Min

from loopsheet import Method, fit, measured, unknown


class Stick(Method, rows="rows"):
    x = measured("1", "abscissa", positive=True)
    y = measured("1", "ordinate")
    a = unknown("slope", start=1)
    b = unknown("threshold", start=0.5)
    c = unknown("of a power", start=0.1)
    line = fit(y, 1.02 * a * {model} + c * x**1.5)
"""
STICKS = {
    "Max": ("Max(x - b, 0)", lambda x, b: np.maximum(x - b, 0)),
    "Min": ("Min(x, b + 0.3)", lambda x, b: np.minimum(x, b + 0.3)),
    "Abs": ("Abs(x - b)", lambda x, b: np.abs(x - b)),
    "straight": ("(x - b)", lambda x, b: x - b),
}
X = np.array([0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4])


@pytest.fixture(scope="module")
def programs(require: Callable[..., str]) -> None:
    """What `check` asks of a machine that has it."""
    require("node")
    require("soffice", "libreoffice")


@pytest.mark.usefixtures("programs")
def test_every_function_has_its_roots_in_every_engine(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """H. S. Carslaw and J. C. Jaeger, Conduction of Heat in Solids, 1959, table I: x tan x = Bi."""
    more = '[parameters]\nA = "0.8"\n'
    folder = method_folder(tmp_path, ROOTS, "slab,Bi [1]\n1,0.1\n2,1.0\n3,10\n", more)
    assert main(["check", str(folder)]) == 0, capsys.readouterr()
    values = Study(folder).computed.values
    assert values.value["x"] == pytest.approx([0.3111, 0.8603, 1.4289], abs=5e-5)
    found = {name: values.scalar(name) for name in "scqbm"}
    s = found.pop("s")
    assert np.arcsin(s / 2) + np.arcsin(s / 3) == pytest.approx(0.8, rel=1e-14)
    expected = {"c": np.cos(1.6), "q": np.arccosh(1.8), "b": np.sqrt(1.8) - 1, "m": 0.8 / 3}
    assert found == pytest.approx(expected, rel=1e-14)


@pytest.mark.usefixtures("programs")
@pytest.mark.parametrize("which", STICKS)
def test_a_model_with_corners_and_decimals_is_proved_and_fitted(
    which: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Such fits may come from afar to where they rest in a single pass, which 50 digits took for rounding."""
    text, model = STICKS[which]
    rng = np.random.default_rng(5)
    y = 1.02 * 1.3 * model(X, 0.57) + 0.2 * X**1.5 + rng.normal(0, 0.004, X.size)
    rows = "".join(f"{n},{x:.1f},{own:.4f}\n" for n, (x, own) in enumerate(zip(X, y, strict=True), start=1))
    code = STICK.format(model=text)
    folder = method_folder(
        tmp_path, code, f"row,x [1],y [1]\n{rows}", '[uncertainty]\nx = "exact"\ny = "u = 0.004"\n'
    )
    assert main(["check", str(folder)]) == 0, capsys.readouterr()
    report = Study(folder).computed
    theirs, covariance = curve_fit(
        lambda x, a, b, c: 1.02 * a * model(x, b) + c * x**1.5, X, y.round(4), (1.3, 0.57, 0.2),
        sigma=np.full(X.size, 0.004), absolute_sigma=True, xtol=1e-14, ftol=1e-14,
    )  # fmt: skip
    assert [report.values.scalar(name) for name in "abc"] == pytest.approx(theirs, rel=1e-6)
    spread = Spread(report.inputs, report.values)
    u = [spread.budget(name, 0).u for name in "abc"]
    residuals = y.round(4) - 1.02 * theirs[0] * model(X, theirs[1]) - theirs[2] * X**1.5
    assert report.values.value["line_residual"] == pytest.approx(residuals, abs=1e-7)
    assert u == pytest.approx(np.sqrt(np.diagonal(covariance)), rel=1e-3)


CORNER = """from sympy import Max

from loopsheet import Method, given, let, measured


class Corner(Method, rows="shifts"):
    t = measured("h", "time at work")
    most = given("h", "time agreed")
    over = let(Max(t - most, 0), "time beyond")
"""


def test_of_what_lies_on_a_corner_no_uncertainty_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It was exact to first order: only to one side of where it is; draws tell of both."""
    table = "shift,t [h]\n1,8.25\n2,7.00\n3,8.00\n"
    folder = method_folder(tmp_path, CORNER, table, '[parameters]\nmost = "8 h, exact"\n')
    report = Study(folder).computed
    spread = Spread(report.inputs, report.values)
    u = [spread.budget("over", row).u for row in range(3)]
    assert u == pytest.approx([18 / 3**0.5, 0, np.nan], nan_ok=True)  # half of 0.01 h is 18 s
    assert main(["budget", "over[3]", str(folder), "--draws", "20000"]) == 0
    told = capsys.readouterr().out
    assert "over[3] = 0.000 h, and its uncertainty is not known: it has a corner here" in told
    assert "Monte Carlo, 20000 draws: median 0.0000 h, u = 0.0016 h" in told
    assert main(["budget", "over[2]", str(folder)]) == 0
    assert capsys.readouterr().out == "over[2] = 0.0 h, exactly\n"


CUBE = """from sympy import log

from loopsheet import Method, given, let, measured


class Cube(Method, rows="points"):
    R = measured("kohm", "resistance", positive=True)
    R_0 = given("kohm", "reference", positive=True)
    l = let(log(R / R_0), "logarithm")
    l3 = let(l**3, "its cube")
"""


def test_of_what_is_of_third_order_alone_no_rounding_is_told(tmp_path: Path) -> None:
    """What second derivatives are but for rounding was u, a millionth of what it is."""
    more = '[parameters]\nR_0 = "10 kohm, exact"\n[uncertainty]\nR = "u = 0.003"\n'
    folder = method_folder(tmp_path, CUBE, "point,R [kohm]\n1,12.500\n2,10.000\n", more)
    report = Study(folder).computed
    spread = Spread(report.inputs, report.values)
    slope = 3 * np.log(1.25) ** 2 * 0.003 / 12.5
    assert [spread.budget("l3", row).u for row in range(2)] == pytest.approx([slope, np.nan], nan_ok=True)
