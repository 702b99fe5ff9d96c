"""The curves of the figures: they are the equations', they close, and their area is the energy lost."""

import subprocess
import sys
from dataclasses import replace
from runpy import run_module

import numpy as np
import pytest
from numpy.typing import NDArray
from sympy import Float, lambdify
from uncertain_data import uncertain

from loopsheet.derivations import soft_impact as model
from loopsheet.report.cells.values import Status, Values
from loopsheet.report.engines.numpy import evaluate, extend
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.workbook import Workbook
from loopsheet.report.workbooks.soft_impact import WORKBOOK
from loopsheet.report.workbooks.soft_impact_schematics import (
    FRICTION,
    SCHEMATIC,
    force,
    hysteresis,
    lankarani,
)

Array = NDArray[np.float64]

WORKBOOK_MODULE = "loopsheet.report.workbooks.soft_impact"
GIVEN = frozenset({"ball_mass"})
SHEET = WORKBOOK.sheet(GIVEN)
MASS = 8.366e-3
TABLE_1 = {
    "v": [2.334, 2.940, 4.089, 4.504, 4.993],
    "e": [0.530, 0.512, 0.479, 0.467, 0.453],
    "x_p": [23.5e-6, 29.7e-6, 41.6e-6, 45.97e-6, 51.03e-6],
}


def values_of(v: list[float], e: list[float], x_p: list[float], beta: float = 1.5) -> Values:
    data = {"v": v, "e": e, "x_p": x_p, "beta": beta, "ball_mass": MASS, "points_per_pair": 50}
    return evaluate(SHEET, {"tests": range(1, len(v) + 1)}, uncertain(data))


def consistent(tests: int, alpha: float, beta: float, C: float = 1.1e9) -> Values:
    """A campaign that obeys the model without any error."""
    v, e = np.linspace(2.0, 5.0, tests), np.linspace(0.53, 0.41, tests)
    x_m = ((alpha + 1) * MASS * v**2 / (2 * C)) ** (1 / (alpha + 1))
    x_p = x_m * (1 - (beta + 1) / (alpha + 1) * e**2)
    return values_of(v.tolist(), e.tolist(), x_p.tolist(), beta)


def drawn_of(values: Values, samples: int | None = None, workbook: Workbook = WORKBOOK) -> Values:
    """The same with the columns that only the charts ask for."""
    assert workbook.drawn is not None
    more = workbook.drawn(SHEET)
    return extend(values, more.columns, {**more.given, **({"loop_points": samples} if samples else {})})


def branch(values: Values, name: str) -> dict[int, tuple[Array, Array]]:
    """The points of a branch by test: ``loading``, ``unloading``."""
    x, F = (values.value[f"{name}_{of}"] for of in "xF")
    ok = (values.status[f"{name}_x"] == 0) & (values.status[f"{name}_F"] == 0)
    layout, labels = values.layouts["loops"], values.layouts["tests"].labels[:, 0]
    which = labels[layout.rows["k"]]
    return {int(test): (x[ok & (which == test)], F[ok & (which == test)]) for test in np.unique(which[ok])}


@pytest.fixture(scope="module")
def paper() -> Values:
    return values_of(TABLE_1["v"], TABLE_1["e"], TABLE_1["x_p"])


# ------------------------------------------------------------------------------------- the force laws


def test_the_branches_are_those_of_the_derivations() -> None:
    x = np.linspace(1e-6, 6e-5, 7)
    C, alpha = model.C, model.alpha
    expected = lambdify([model.x, C, alpha], model.law_c.value, "mpmath")
    got = force(model.law_c.value, x, C=1.1e9, alpha=1.3)
    exact = [float(expected(Float(v, 40), Float(1.1e9, 40), Float(1.3, 40))) for v in x]
    np.testing.assert_allclose(got, exact, rtol=4e-15)


def test_another_law_in_the_derivations_is_another_curve(
    paper: Values, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No force law is typed here: what the derivations say is what is drawn."""
    before = drawn_of(paper)
    for law in ("law_c", "law_r"):
        equation = getattr(model, law)
        doubled = replace(equation, members=(equation.members[0], 2 * equation.value))
        monkeypatch.setattr(model, law, doubled)
    monkeypatch.delitem(sys.modules, WORKBOOK_MODULE)
    anew = run_module(WORKBOOK_MODULE)
    after = drawn_of(paper, workbook=anew["WORKBOOK"])
    for name in ("loading_F", "unloading_F"):
        np.testing.assert_array_equal(after.value[name], 2 * before.value[name])


# ------------------------------------------------------------------------------------------ the loops


@pytest.mark.parametrize("beta", [1.25, 1.5, 2.0])
@pytest.mark.parametrize("alpha", [1.0, 1.31, 1.5])
def test_the_area_of_a_loop_is_the_kinetic_energy_lost(alpha: float, beta: float) -> None:
    values = consistent(4, alpha, beta)
    samples = 1001
    found = drawn_of(values, samples)
    up, back = branch(found, "loading"), branch(found, "unloading")
    v, e = values.value["v"], values.value["e"]
    assert list(up) == list(back) == [1, 2, 3, 4]
    for n, test in enumerate(back):
        (x, F), (down_x, down_F) = up[test], back[test]
        x_m, peak = down_x[-1], down_F[-1]
        area = np.trapezoid(F, x) - np.trapezoid(down_F, down_x)
        lost = (1 - e[n] ** 2) * MASS * v[n] ** 2 / 2
        # A convex curve's trapezia are too large, by at most the rise of its slope times step^2 / 8.
        steps = (x[1] - x[0], down_x[1] - down_x[0])
        slopes = (alpha * peak / x_m, beta * peak / (x_m - down_x[0]))
        bounds = [slope * step**2 / 8 for slope, step in zip(slopes, steps, strict=True)]
        assert -bounds[1] - 1e-10 * lost <= area - lost <= bounds[0] + 1e-10 * lost
        assert sum(bounds) < 5e-6 * lost


def test_every_loop_starts_at_the_imprint_and_closes_on_the_fitted_curve(paper: Values) -> None:
    found = drawn_of(paper)
    up, back = branch(found, "loading"), branch(found, "unloading")
    assert list(up) == list(back) == [1, 2, 3, 4, 5]
    for n, ((x, F), (down_x, down_F)) in enumerate(zip(up.values(), back.values(), strict=True)):
        assert (x[0], F[0]) == (0.0, 0.0)
        assert (np.diff(x) > 0).all()
        assert (down_x[0], down_F[0]) == (paper.value["x_p"][n], 0.0)
        assert x[-1] == down_x[-1] == paper.value["x_m"][n]
        assert down_F[-1] == paper.value["Cprime_eq9"][n]
        assert F[-1] == pytest.approx(down_F[-1], rel=4e-15)


# ----------------------------------------------------------------------------------- cells in error


def test_a_pair_in_error_is_left_out() -> None:
    # Test 2 is faster than test 1 and leaves the shallower imprint: pair 1-2 has no root.
    values = values_of([2.334, 2.94, 4.089], [0.53, 0.512, 0.479], [30e-6, 29.7e-6, 41.6e-6])
    assert list(values.status["alpha"]) == [Status.NOROOT, Status.OK, Status.OK]
    found = drawn_of(values)
    assert (found.status["mean_v"] == 0).all()
    assert list(branch(found, "unloading")) == [1, 2, 3]


def test_a_test_without_its_datum_is_left_out() -> None:
    v, e, x_p = (list(column) for column in TABLE_1.values())
    x_p[3] = float("nan")
    assert list(branch(drawn_of(values_of(v, e, x_p)), "unloading")) == [1, 2, 3, 5]


def test_a_test_whose_imprint_is_deeper_than_its_approach_has_no_way_back() -> None:
    # The imprint of test 1 is far too deep for the curve that the others agree on.
    v, e, x_p = (list(column) for column in TABLE_1.values())
    x_p[0] = 80e-6
    values = values_of(v, e, x_p)
    shut = values.value["x_m"] <= values.value["x_p"]
    assert shut.tolist() == [True, False, False, False, False]
    assert list(branch(drawn_of(values), "unloading")) == (np.flatnonzero(~shut) + 1).tolist()


def test_points_without_a_fit_have_no_loops() -> None:
    # The last test is so slow for its imprint that the best power of all points is a falling one.
    values = values_of([1.84, 5.12, 0.82], [0.706, 0.334, 0.277], [12.6e-6, 53.3e-6, 74.4e-6])
    assert list(values.status["alpha_log"]) == [Status.DOMAIN]
    found = drawn_of(values)
    assert branch(found, "loading") == branch(found, "unloading") == {}
    assert (found.status["F"] == 0).any()


# --------------------------------------------------------------------------------- exponents by speed


def test_the_exponents_of_the_paper_climb_with_the_mean_speed(paper: Values) -> None:
    speed, alpha = drawn_of(paper).value["mean_v"], paper.value["alpha"]
    assert speed[0] == pytest.approx(sum(TABLE_1["v"][:2]) / 2)
    assert (np.diff(alpha[np.argsort(speed)]) > 0).all()


# ------------------------------------------------------------------------------------ schematic figures


def test_the_model_of_equation_2_closes_at_the_maximum_approach() -> None:
    up, down = lankarani()
    assert (up.x[0], up.y[0], up.x[-1]) == (0.0, 0.0, 1.0)
    assert up.y[-1] == down.y[-1] == 1.0
    assert (down.x[0], down.y[0]) == (SCHEMATIC["x_p"], 0.0)
    half = np.interp(0.5, up.x, up.y)
    assert half == pytest.approx(0.5**1.5, rel=1e-4)


def test_friction_adds_while_loading_and_takes_while_unloading() -> None:
    up, down, loading, unloading = hysteresis()
    for bare, rubbed, sign in ((up, loading, 1), (down, unloading, -1)):
        np.testing.assert_array_equal(bare.x, rubbed.x)
        assert (sign * (rubbed.y - bare.y)[1:-1] > 0).all()
        assert rubbed.y[0] == 0.0
        assert rubbed.y[-1] == pytest.approx(bare.y[-1], abs=1e-12)
    assert (unloading.y >= 0).all()
    # The share is a friction's, not a force of its own: it never exceeds what it is a share of.
    assert 0 < FRICTION < 1


# --------------------------------------------------------------------------------------- the workbook


def test_curves_are_computed_when_something_draws(report: Report, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    monkeypatch.setattr("loopsheet.report.stages.plotted", lambda *_: asked.append("curves"))
    study = Study(PAPER)
    assert study.computed.values.scalar("alpha_mean") == report.values.scalar("alpha_mean")
    assert asked == []
    for _ in range(2):
        study.computed.plotted()
    assert asked == ["curves"]


def test_a_workbook_loads_no_matplotlib() -> None:
    code = "import sys, loopsheet.report.workbooks.soft_impact; print('matplotlib' in sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["False"]
