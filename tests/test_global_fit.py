"""The fit of one curve to all tests: known digits, other least squares, and campaigns made for it."""

from __future__ import annotations

import shutil
from fractions import Fraction
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.stats import t as student

from loopsheet.report.cells.values import Status, Values
from loopsheet.report.engines import exact
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.numpy import Program
from loopsheet.report.referee.campaign import Campaign
from loopsheet.report.referee.problem import Problem
from loopsheet.report.referee.values import verdicts
from loopsheet.report.result.result import Report
from loopsheet.report.result.verdict import EXACT, NOT_FOUND, REACHABLE, UNREACHABLE
from loopsheet.report.study import Study
from loopsheet.report.workbooks.soft_impact import WORKBOOK

Array = NDArray[np.float64]
FOLDER = Path(__file__).resolve().parents[1] / "data" / "soft_steel"
SHEET = WORKBOOK.sheet(frozenset({"ball_mass"}))
PROGRAM = Program.of(SHEET)
MASS, BETA, ALPHA, C = 0.008366, 1.5, 1.3, 9.6e8

V = np.array([2.334, 2.940, 4.089, 4.504, 4.993])
E = np.array([0.530, 0.512, 0.479, 0.467, 0.453])
X = np.array([23.5, 29.7, 41.6, 45.97, 51.03]) * 1e-6
U = [np.array(half) / 2 / np.sqrt(3) for half in ([1e-3] * 5, [1e-3] * 5, [1e-7, 1e-7, 1e-7, 1e-8, 1e-8])]


def data(v: Any, e: Any, x_p: Any, u_v: Any, u_e: Any, u_x: Any) -> dict[str, Any]:
    more = {"u_v": u_v, "u_e": u_e, "u_x_p": u_x, "ball_mass": MASS, "beta": BETA, "points_per_pair": 2.0}
    return {"v": v, "e": e, "x_p": x_p, **more}


def fitted(*given: Any) -> Values:
    return engine.evaluate(SHEET, {"tests": range(1, given[0].shape[-1] + 1)}, data(*given), PROGRAM)


def depth(
    v: Array, e: Array, alpha: Any, F: Any, x_0: float, mass: float = MASS, beta: float = BETA
) -> Array:
    """The imprint depth on a curve, by (6), (7) and (9)."""
    A = alpha + 1
    found: Array = x_0 * (A * mass * v**2 / (2 * F * x_0)) ** (1 / A) * (1 - e**2 * (beta + 1) / A)
    return found


def by_scipy(
    v: Array, e: Array, x_p: Array, u_v: Array, u_e: Array, u_x: Array, start: float = 1.3
) -> tuple[float, float, float]:
    """Exponent, sum of squares and standard uncertainty, with all true values as unknowns of their own."""
    n, x_0 = v.size, float(x_p.mean())

    def deviations(z: Array) -> Array:
        dv, de = z[2 : 2 + n], z[2 + n :]
        true = depth(v + u_v * dv, e + u_e * de, z[0], np.exp(z[1]), x_0)
        return np.concatenate([dv, de, (x_p - true) / u_x])

    # The force with which the mean test lies on the first curve.
    left = depth(v, e, start, 1.0, x_0) / x_p
    begin = np.concatenate([[start, (start + 1) * np.log(left.mean())], np.zeros(2 * n)])
    found = least_squares(deviations, begin, method="lm", xtol=1e-15, ftol=1e-15, gtol=1e-15)
    covariance = np.linalg.inv(found.jac.T @ found.jac)
    return float(found.x[0]), 2 * float(found.cost), float(np.sqrt(covariance[0, 0]))


# --- known digits ------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def report() -> Report:
    return Study(FOLDER).computed


def test_the_paper_has_one_curve_only_if_its_digits_are_worse_than_printed(report: Report) -> None:
    names = ("alpha_eiv", "chi2_eiv", "u_alpha_eiv", "birge_eiv")
    found = [f"{report.values.scalar(name):.8g}" for name in names]
    assert found == ["1.3013045", "55.190784", "0.003053929", "4.289164"]
    # By propagation the uncertainty is another one in its third digit: the weights move with the data.
    assert f"{report.uncertain().u['alpha_eiv'][0]:.5g}" == "0.0030676"


def test_other_least_squares_find_the_same() -> None:
    values = fitted(V, E, X, *U)
    alpha, chi2, u = by_scipy(V, E, X, *U)
    # It stops a hair's breadth from the least sum, by differences: ours may not be larger.
    assert values.scalar("alpha_eiv") == pytest.approx(alpha, abs=1e-7)
    assert chi2 - 1e-6 <= values.scalar("chi2_eiv") <= chi2
    assert values.scalar("u_alpha_eiv") == pytest.approx(u, rel=1e-5)


@settings(max_examples=25, deadline=None)
@given(st.integers(3, 8), st.floats(0.002, 0.02), st.integers(0, 10**6), st.tuples(*[st.floats(0.2, 3)] * 3))
def test_other_least_squares_find_the_same_of_any_campaign(
    tests: int, noise: float, seed: int, parts: tuple[float, ...]
) -> None:
    rng = np.random.default_rng(seed)
    v = np.linspace(2, 6, tests)
    e = 0.62 * v**-0.2
    true = [v, e, depth(v, e, ALPHA, C * 4e-5**ALPHA, 4e-5)]
    us = [noise * part * own for part, own in zip(parts, true, strict=True)]
    measured = [own + u * rng.standard_normal(tests) for own, u in zip(true, us, strict=True)]
    values = fitted(*measured, *us)
    alpha, chi2, u = by_scipy(*measured, *us)
    assert values.scalar("alpha_eiv") == pytest.approx(alpha, abs=1e-6)
    assert values.scalar("chi2_eiv") == pytest.approx(chi2, rel=1e-6)
    assert values.scalar("u_alpha_eiv") == pytest.approx(u, rel=1e-4)


def test_two_tests_give_what_their_pair_gives() -> None:
    two = slice(0, 2)
    values = fitted(V[two], E[two], X[two], *(u[two] for u in U))
    assert values.scalar("alpha_eiv") == pytest.approx(values.value["alpha"][0], rel=1e-12)
    assert values.scalar("C_eiv") == pytest.approx(values.value["C"][0], rel=1e-11)
    assert values.scalar("chi2_eiv") == 0
    assert values.status["birge_eiv"][0] == Status.DOMAIN


def test_one_test_has_no_exponent() -> None:
    values = fitted(V[:1], E[:1], X[:1], *(u[:1] for u in U))
    assert values.cell("alpha_eiv").reason.startswith("#DOMAIN! alpha_eiv needs alpha_0: outside the domain")
    assert values.cell("v_eiv", (1,)).reason.startswith("#DOMAIN! v_eiv[1] needs alpha_0: outside the domain")
    assert values.cell("chi2_eiv").culprit is not None


@pytest.mark.parametrize(("speed", "number"), [(3.0, 3), (2.9, 3), (2.3, 7)])
def test_tests_at_one_speed_say_why_they_tell_no_exponent(speed: float, number: int) -> None:
    """Whether or not rounding makes the mean of equal speeds that speed."""
    v, part = np.full(number, speed), 1 + 1e-3 * np.arange(number)
    us = [np.full(number, u) for u in (1e-3, 1e-3, 1e-7)]
    reason = fitted(v, 0.5 * part, 3e-5 * part, *us).cell("alpha_eiv").reason
    assert reason == (
        "#DOMAIN! alpha_eiv needs alpha_0: outside the domain of (L49): all tests are at one speed, which "
        "tells no exponent"
    )
    v[0] *= 1 + 1e-6
    assert fitted(v, 0.5 * part, 3e-5 * part, *us).status["alpha_0"][0] == Status.OK


@pytest.mark.parametrize(
    ("v", "e", "x_p"),
    [
        ((2, 2.8, 3.6), (0.93, 0.927, 0.924), (1.8, 2.65, 3.6)),
        ((2, 2.8, 3.6, 4.5), (0.9, 0.897, 0.894, 0.89), (1.07, 1.74, 2.55, 3.7)),
        ((2, 2.8, 3.6, 4.5), (0.95, 0.947, 0.944, 0.94), (1.8, 2.61, 3.51, 4.69)),
    ],
)
def test_of_nearly_elastic_tests_there_is_a_fit(v: Any, e: Any, x_p: Any) -> None:
    """The search passes places where a restitution leaves no imprint."""
    v, e, x_p = np.array(v), np.array(e), np.array(x_p) * 1e-6
    us = [np.full(v.size, half / np.sqrt(3)) for half in (5e-4, 5e-4, 5e-9)]
    values = fitted(v, e, x_p, *us)
    pairs = values.scalar("alpha_median")
    assert abs(values.scalar("alpha_eiv") - pairs) < 3 * values.scalar("u_alpha_eiv")
    assert values.scalar("chi2_eiv") < 1
    assert (values.value["x_p_eiv"] > 0).all()
    # No deviations of any test are smaller: nearby curves and true values have larger sums.
    others = [by_scipy(v, e, x_p, *us, start=pairs + step) for step in (-0.01, 0, 0.01)]
    assert values.scalar("chi2_eiv") <= min(chi2 for _, chi2, _ in others) + 1e-9
    assert values.scalar("alpha_eiv") == pytest.approx(min(others, key=lambda o: o[1])[0], abs=1e-5)


@pytest.mark.parametrize(("u_e", "settles"), [(0.002, True), (0.1, False)])
def test_a_restitution_of_zero_is_a_minimum_or_no_value(u_e: float, settles: bool) -> None:
    """Nothing moves at zero: the sum is the same on both sides of it, be it least there or greatest."""
    third = np.arange(V.size) == 2
    e, us = np.where(third, 0, E), (0.005 * V, np.where(third, u_e, 0.002), 0.005 * X)
    values = fitted(V, e, X, *us)
    assert (values.status["alpha_eiv"][0] == Status.OK) == settles
    near = fitted(V, np.maximum(e, 1e-3), X, *us)
    alpha, chi2, _ = by_scipy(V, np.maximum(e, 1e-3), X, *us)
    # Far from the curve others stop before the least sum.
    assert near.scalar("alpha_eiv") == pytest.approx(alpha, abs=1e-5)
    assert near.scalar("chi2_eiv") <= chi2 == pytest.approx(near.scalar("chi2_eiv"), rel=1e-7)
    if settles:
        assert values.scalar("chi2_eiv") == pytest.approx(chi2, rel=0.01)
    else:
        assert "a restitution of zero" in values.cell("alpha_eiv").reason


def test_a_speed_may_be_exact() -> None:
    """Its error then takes no part, and its true value is the measured one."""
    values = fitted(V, E, X, 0 * U[0], U[1], U[2])
    assert values.value["v_eiv"].tolist() == V.tolist()
    alpha, chi2, _ = by_scipy(V, E, X, 1e-9 * U[0], U[1], U[2])
    assert values.scalar("alpha_eiv") == pytest.approx(alpha, abs=1e-7)
    assert chi2 - 1e-6 <= values.scalar("chi2_eiv") <= chi2


@pytest.mark.parametrize(("e", "alpha"), [(0.0, 1.3), (0.88, 1.3), (0.99, 2.1)])
def test_balls_that_stay_or_nearly_lose_nothing(e: float, alpha: float) -> None:
    """The restitution may be anything for which a test leaves an imprint; here nothing is off by noise."""
    v = np.array([2.0, 3.0, 4.0, 5.0])
    es = np.full(4, e) * v**-0.01
    us = [0.01 * v, np.full(4, 0.003), np.full(4, 3e-8)]
    values = fitted(v, es, depth(v, es, alpha, C * 4e-5**alpha, 4e-5), *us)
    assert values.scalar("alpha_eiv") == pytest.approx(alpha, rel=1e-9)


def test_a_test_without_a_depth_is_left_out() -> None:
    x = X.copy()
    x[2] = np.nan
    some = [0, 1, 3, 4]
    whole, rest = fitted(V, E, x, *U), fitted(V[some], E[some], X[some], *(u[some] for u in U))
    assert whole.scalar("alpha_eiv") == pytest.approx(rest.scalar("alpha_eiv"), rel=1e-13)
    assert whole.status["v_eiv"].tolist() == [0, 0, Status.INPUT, 0, 0]
    assert whole.counted["chi2_eiv"] == {"tests": 4}
    assert whole.scalar("birge_eiv") == pytest.approx(rest.scalar("birge_eiv"), rel=1e-9)
    assert whole.cell("v_eiv", (3,)).reason.startswith("#INPUT! v_eiv[3] needs x_p[3]: the datum is missing")


@settings(max_examples=20, deadline=None)
@given(st.floats(0.1, 10), st.floats(0.1, 10))
def test_scales_of_speed_and_depth_cancel(speed: float, scale: float) -> None:
    """A clock or a gauge that is wrong by a factor leaves the exponent, and its uncertainty."""
    one = fitted(V, E, X, *U)
    other = fitted(speed * V, E, scale * X, speed * U[0], U[1], scale * U[2])
    for name in ("alpha_eiv", "chi2_eiv", "u_alpha_eiv"):
        assert other.scalar(name) == pytest.approx(one.scalar(name), rel=1e-10)


def test_derivatives_are_those_of_the_fit_at_fifty_digits(report: Report) -> None:
    """What u rests on: the derivatives of the exponent by all that was measured, by differences."""
    budget = next(one for one in report.uncertain().budgets if one.cell == "alpha_eiv")
    told = {each.source.name: each.u / each.source.moves[0][2] for each in budget.contributions}
    given = {"ball_diameter": 0.0127, "ball_density": 7800.0, "beta": 1.5, "points_per_pair": 2}
    given |= dict(zip(("u_v", "u_e", "u_x_p"), (u.tolist() for u in U), strict=True))
    cells = dict(zip(("v", "e", "x_p"), ([Fraction(x) for x in own] for own in (V, E, X)), strict=True))

    def alpha(name: str, row: int, by: Fraction) -> Any:
        moved = [x + by * (n == row) for n, x in enumerate(cells[name])]
        found = exact.evaluate(report.sheet, {"tests": range(1, 6)}, {**given, **cells, name: moved})
        return found.value["alpha_eiv"][0]

    for name, row in (("v", 4), ("e", 0), ("x_p", 1)):
        step = cells[name][row] / 10**15
        with mpmath.workdps(60):
            slope = (alpha(name, row, step) - alpha(name, row, -step)) / (2 * mpmath.mpf(1) * float(step))
        assert told[f"{name}[{row + 1}]"] == pytest.approx(float(slope), rel=1e-9)


def test_the_referee_says_of_a_published_exponent_what_the_digits_allow(tmp_path: Path) -> None:
    """It follows what a published cell rests on around the loop, and ends."""
    copied = tmp_path / "fit"
    shutil.copytree(FOLDER, copied)
    rows = "source,cell,index,value,unit\nmine,alpha_eiv,,1.25,1\nmine,C_eiv,,1.009e9,N/m^alpha_eiv\n"
    (copied / "published.csv").write_text(rows, encoding="utf-8")
    study = Study(copied)
    made, values = study.prepared, study.computed.values
    campaign = Campaign(made.sheet, made.inputs, values, made.data, made.inputs.free)
    words = [one.verdict for one in verdicts(campaign, made.inputs.published)]
    assert words[0] in (UNREACHABLE, NOT_FOUND)
    assert words[1] in (EXACT, REACHABLE)
    problem = Problem.of(campaign, made.inputs.published)
    moved = {
        unknown.column for unknown, rests in zip(problem.unknowns, problem.touched[0], strict=True) if rests
    }
    assert {"v", "e", "x_p"} <= moved


# --- campaigns ---------------------------------------------------------------------------------------------


def campaigns(v: Array, noise: float, number: int) -> tuple[Values, int]:
    """Campaigns of normal errors, relative to what was true."""
    rng = np.random.default_rng(20)
    e = 0.62 * v**-0.2
    true = [v, e, depth(v, e, ALPHA, C * 4e-5**ALPHA, 4e-5)]
    measured = [own * (1 + noise * rng.standard_normal((number, v.size))) for own in true]
    return fitted(*measured, *(noise * own for own in true)), v.size


@pytest.fixture(scope="module")
def five() -> tuple[Values, int]:
    return campaigns(np.array([2.334, 2.940, 4.089, 4.504, 4.993]), 0.01, 2000)


def test_campaigns_give_back_the_exponent(five: tuple[Values, int]) -> None:
    alpha = five[0].value["alpha_eiv"][:, 0]
    assert (five[0].status["alpha_eiv"] == Status.OK).all()
    assert abs(alpha.mean() - ALPHA) <= 0.005
    assert alpha.std() <= 0.054


def test_intervals_hold_what_they_promise(five: tuple[Values, int]) -> None:
    """By the stated uncertainties, and by the scatter with Student's t for two degrees of freedom fewer."""
    values, tests = five
    off = np.abs(values.value["alpha_eiv"] - ALPHA)
    stated = (off <= 1.96 * values.value["u_alpha_eiv"]).mean()
    scattered = (off <= student.ppf(0.975, tests - 2) * values.value["u_birge_eiv"]).mean()
    assert 0.935 <= stated <= 0.965
    assert 0.935 <= scattered <= 0.965


def test_sums_of_squares_are_distributed_as_they_should(five: tuple[Values, int]) -> None:
    chi2 = five[0].value["chi2_eiv"]
    assert chi2.mean() == pytest.approx(3, abs=4 * np.sqrt(6 / 2000))
    assert chi2.var() == pytest.approx(6, abs=1)


def test_twelve_tests_at_four_heights() -> None:
    values, _ = campaigns(np.repeat([2.0, 3.0, 4.0, 5.0], 3), 0.01, 500)
    alpha = values.value["alpha_eiv"][:, 0]
    assert (values.status["alpha_eiv"] == Status.OK).all()
    assert alpha.std() <= 0.034


def test_imprints_that_are_shallow_beside_their_approach_have_a_fit() -> None:
    """There the depth bends so much with the exponent that whole steps lead out of all bounds."""
    rng, number = np.random.default_rng(1), 400
    alpha, rate = rng.uniform(1.0, 1.5, (number, 1)), rng.uniform(0.01, 0.25, (number, 1))
    most = np.sqrt((alpha + 1) / (BETA + 1)) * rng.uniform(0.97, 0.999, (number, 1))
    v, noise = np.sort(rng.uniform(1.5, 5, (number, 4))), 10 ** rng.uniform(-4, -2, (number, 1))
    e = most * (v / v[:, :1]) ** -rate
    true = np.array([v, e, depth(v, e, alpha, 0.75 * C * 4e-5**alpha, 4e-5)])
    us = true * np.array([1, 0.3, 1]).reshape(3, 1, 1) * noise
    values = fitted(*(true + us * rng.standard_normal(true.shape)), *us)
    settled = values.status["alpha_eiv"][:, 0] == Status.OK
    assert settled.mean() > 0.99
    chi2 = values.value["chi2_eiv"][settled, 0]
    assert chi2.mean() == pytest.approx(2, abs=4 * np.sqrt(4 / number))
