"""Campaigns made forward from the model give back what they were made of.

The forward calculation is its own: from an exponent and a coefficient, equation (6) gives each approach, (9)
each force and (7) each imprint depth, at 50 digits. What the engine then sees are the nearest doubles.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mpmath import mpf
from uncertain_data import uncertain

from loopsheet.report.cells.values import Values
from loopsheet.report.engines import exact
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.numpy import Program
from loopsheet.report.workbooks.soft_impact import sheet as soft_impact

EPS = float(np.finfo(float).eps)
WORST = 1e-11
SHEET = soft_impact(frozenset({"ball_mass", "target_mass"}))
PROGRAM = Program.of(SHEET)


@dataclass(frozen=True)
class Campaign:
    """What was put in, and what each test's approach, force and imprint then are."""

    alpha: Any
    C: Any
    data: dict[str, Any]
    x_m: list[Any]
    Cprime: list[Any]


def campaign(
    v: Sequence[float], e: Sequence[float], alpha: float, beta: float, C: float = 9.6e8, points: int = 5
) -> Campaign:
    """Make a campaign forward at 50 digits: a ball of 8.4 g on a target of 1.5 kg."""
    with mpmath.workdps(50):
        a, b, c, m_1, m_2 = (mpf(value) for value in (alpha, beta, C, 0.0084, 1.5))
        m = m_1 * m_2 / (m_1 + m_2)  # (8)
        x_m, force, x_p = [], [], []
        for speed, rebound in zip(map(mpf, v), map(mpf, e), strict=True):
            x = ((a + 1) * m * speed**2 / (2 * c)) ** (1 / (a + 1))  # (6)
            F = c * x**a  # (9)
            x_m.append(x)
            force.append(F)
            x_p.append(x - (b + 1) * m * (rebound * speed) ** 2 / (2 * F))  # (7)
        assert min(x_p) > 0
    masses = {"ball_mass": 0.0084, "target_mass": 1.5}
    measured = {"v": list(v), "e": list(e), "x_p": [float(x) for x in x_p]}
    given = uncertain({**measured, **masses, "beta": beta, "points_per_pair": points})
    return Campaign(a, c, given, x_m, force)


def labels(made: Campaign) -> dict[str, range]:
    return {"tests": range(1, len(made.x_m) + 1)}


def run(made: Campaign) -> Values:
    return engine.evaluate(SHEET, labels(made), made.data, PROGRAM)


def errors(made: Campaign, values: Values) -> dict[str, Any]:
    """Relative differences from what was put in, cell by cell."""
    pairs = values.layouts["pairs"].rows
    first, second = (next(rows for index, rows in pairs.items() if str(index) == name) for name in "ij")
    expected = {
        **{name: [made.alpha] for name in ("alpha", "alpha_mean", "alpha_log", "alpha_lin")},
        **{name: [made.C] for name in ("C", "C_log", "C_lin")},
        "x_m": made.x_m,
        "Cprime_eq7": made.Cprime,
        "Cprime_eq9": made.Cprime,
        "x_m1": [made.x_m[row] for row in first],
        "x_m2": [made.x_m[row] for row in second],
        "Cprime_1": [made.Cprime[row] for row in first],
        "Cprime_2": [made.Cprime[row] for row in second],
    }
    found: dict[str, Any] = {}
    for name, true in expected.items():
        assert not values.status[name].any(), name
        numbers = np.broadcast_to(np.array([float(value) for value in true]), values.value[name].shape)
        found[name] = abs(values.value[name] / numbers - 1)
    return found


def conditions(made: Campaign) -> dict[str, Any]:
    """For each cell, how much relative errors of the data grow in it: by differences at 50 digits."""
    with mpmath.workdps(60):
        h = mpf(10) ** -25
        exactly = {n: [mpf(x) for x in v] if isinstance(v, list) else mpf(v) for n, v in made.data.items()}
        base = exact.evaluate(SHEET, labels(made), exactly).value
        total = {name: [mpf(0)] * len(column) for name, column in base.items()}
        for name, value in exactly.items():
            if name == "points_per_pair":
                continue
            rows = range(len(value)) if isinstance(value, list) else [None]
            for row in rows:
                moved = (
                    value * (1 + h)
                    if row is None
                    else [x * (1 + h * (n == row)) for n, x in enumerate(value)]
                )
                there = exact.evaluate(SHEET, labels(made), {**exactly, name: moved}).value
                for column, cells in there.items():
                    for n, (new, old) in enumerate(zip(cells, base[column], strict=True)):
                        total[column][n] += abs((new - old) / (h * old)) if old else mpf(0)
        return {name: np.array([float(value) for value in column]) for name, column in total.items()}


@pytest.mark.parametrize("alpha", [1.0, 1.3, 1.5])
@pytest.mark.parametrize("beta", [1.25, 1.5, 2.0])
def test_two_and_three_tests_give_all_back_to_eight_roundoffs_times_the_condition(
    alpha: float, beta: float
) -> None:
    for v, e in (((2.0, 3.5), (0.52, 0.47)), ((5.0, 2.0, 3.0), (0.45, 0.53, 0.50))):
        made = campaign(v, e, alpha, beta, points=2)
        condition = conditions(made)
        for name, error in errors(made, run(made)).items():
            bound = np.minimum(8 * EPS * np.maximum(1, condition[name]), WORST)
            assert (error <= bound).all(), (name, error / EPS, condition[name])


@pytest.mark.parametrize("count", [2, 4, 5, 8, 12])
@pytest.mark.parametrize("beta", [1.25, 1.5, 2.0])
def test_campaigns_of_any_size_come_back(count: int, beta: float) -> None:
    for alpha in (1.0, 1.1, 1.3, 1.5):
        v = np.linspace(1.5, 6.0, count)
        e = np.linspace(0.56, 0.45, count)
        made = campaign(v.tolist(), e.tolist(), alpha, beta)
        for name, error in errors(made, run(made)).items():
            assert error.max() <= 1e-12, name


speeds = st.lists(st.integers(100, 800), min_size=2, max_size=12, unique=True)


@settings(derandomize=True, max_examples=150)
@given(speeds, st.floats(1.0, 1.5), st.sampled_from([1.25, 1.5, 2.0]), st.data())
def test_whatever_was_put_in_comes_back(
    centimetres: list[int], alpha: float, beta: float, data: st.DataObject
) -> None:
    # e falls with the speed, as it does on soft targets: then every pair has exactly one root.
    v = [speed / 100 for speed in centimetres]
    assume(max(v) > 1.05 * min(v))  # or no pair tells an exponent
    drop = data.draw(st.floats(0.0, 0.03))
    e = [0.6 - drop * speed for speed in v]
    made = campaign(v, e, alpha, beta, C=data.draw(st.floats(1e6, 1e11)))
    for name, error in errors(made, run(made)).items():
        assert error.max() <= WORST, name


def test_two_hundred_tests_make_19_900_pairs() -> None:
    v, e = np.linspace(1, 6, 200), np.linspace(0.56, 0.45, 200)
    made = campaign(v.tolist(), e.tolist(), 1.3, 1.5)
    values = run(made)
    assert values.value["alpha"].shape == (19_900,)
    assert values.value["F"].shape == (99_500,)
    found = errors(made, values)
    assert all(error.max() <= WORST for error in found.values())
    assert found["alpha_log"].max() <= 1e-14


def test_the_order_of_the_tests_does_not_matter() -> None:
    v, e = [2.0, 2.6, 3.3, 4.0], [0.55, 0.53, 0.51, 0.48]
    rising = run(campaign(v, e, 1.3, 1.5))
    falling = run(campaign(v[::-1], e[::-1], 1.3, 1.5))
    for name in ("alpha_mean", "alpha_log", "C_log", "alpha_lin"):
        assert rising.scalar(name) == pytest.approx(falling.scalar(name), rel=1e-13)
    np.testing.assert_allclose(rising.value["x_m"], falling.value["x_m"][::-1], rtol=1e-13)
