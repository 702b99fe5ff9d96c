"""The solver: what it finds, and what it says where there is nothing to find."""

from __future__ import annotations

import os
import subprocess
import sys

import nist_strd
import numpy as np
import pytest
from processors import lesser

from loopsheet.report.fitting.least_squares import Ending, Fitted, Function, NotFitted, least_squares
from loopsheet.report.fitting.triangle import Triangle

STRD = nist_strd.nonlinear()
EIGHT = np.arange(1.0, 9)


@pytest.mark.parametrize("start", [0, 1])
@pytest.mark.parametrize("name", STRD)
def test_certified_values_come_out_from_both_starts(name: str, start: int) -> None:
    one = STRD[name]
    fit = one.fit(one.starts[start]).fitted
    assert fit.ending is Ending.CONVERGED
    assert nist_strd.digits(fit.parameters, one.certified) > 10
    # Doubles know residuals to the rounding of the data; Lanczos1 has 1e-13 of y, and NIST more digits.
    scatter = np.sqrt(one.squares / fit.freedom)
    known = np.log10(scatter / np.abs(one.y).max() / np.finfo(float).eps)
    least = min(10, known - 1)
    assert least > 6 or name == "Lanczos1"
    assert nist_strd.digits(fit.u_by_scatter, one.deviations) > least
    assert nist_strd.digits(np.array([fit.chi2]), np.array([one.squares])) > least


def test_all_sets_are_there() -> None:
    assert len(STRD) == 27
    assert sum(len(one.y) for one in STRD.values()) == 2176


LINEAR = {
    "Norris": (14, 13),
    "Pontius": (12, 13),
    "NoInt1": (14, 15),
    "NoInt2": (15, 15),
    "Filip": (7, 7),
    "Longley": (10, 12),
    "Wampler1": (9, None),
    "Wampler2": (12, None),
    "Wampler3": (9, 13),
    "Wampler4": (7, 13),
    "Wampler5": (5, 13),
}
"""How many digits of values and standard deviations come out, of 15; those of Wampler1 and 2 are 0.

In Wampler3-5 the scatter grows, and takes as many digits as the condition does."""


@pytest.mark.parametrize("name", LINEAR)
def test_linear_sets_come_out_to_what_doubles_leave(name: str) -> None:
    one = nist_strd.linear()[name]
    fit = one.fit(one.starts[0]).fitted
    values, deviations = LINEAR[name]
    assert nist_strd.digits(fit.parameters, one.certified, 15) >= values
    if deviations is None:
        assert fit.u_by_scatter.max() < 1e-9
    else:
        assert nist_strd.digits(fit.u_by_scatter, one.deviations, 15) >= deviations


@pytest.mark.parametrize(
    ("ending", "residuals", "jacobian", "start"),
    [
        # two parameters that stand only in their sum
        (
            Ending.SINGULAR,
            lambda b: b[0] + b[1] - np.array([1.0, 2, 3]),
            lambda b: np.ones((3, 2)),
            [0, 0],
        ),
        # more parameters than numbers
        (Ending.SINGULAR, lambda b: b[:1] - 1, lambda b: np.eye(1, 2), [0, 0]),
        # a parameter that does nothing
        (
            Ending.SINGULAR,
            lambda b: b[0] - np.array([1.0, 3]),
            lambda b: np.stack([np.ones(2), np.zeros(2)], 1),
            [0, 0],
        ),
        # a Jacobian of the wrong sign
        (Ending.STUCK, lambda b: b - np.array([1.0]), lambda b: -np.eye(1), [3]),
        (Ending.STUCK, lambda b: b - np.array([1.0]), lambda b: -np.eye(1), [0]),
        # it is least at infinity alone
        (Ending.UNFINISHED, lambda b: 1 / np.maximum(b, 1), lambda b: -np.diag(b**-2), [2]),
        # an exponential through numbers that alternate
        (
            Ending.UNFINISHED,
            lambda b: b[0] * np.exp(-b[1] * EIGHT) - (-1) ** EIGHT,
            lambda b: (np.exp(-b[1] * EIGHT) * [EIGHT**0, -b[0] * EIGHT]).T,
            [-5, 1],
        ),
        (Ending.OUTSIDE, np.log, lambda b: np.diag(1 / b), [-1]),
        (Ending.OUTSIDE, lambda b: b, lambda b: np.diag(np.inf / b), [1]),
    ],
)
def test_what_has_no_fit_says_why(
    ending: Ending, residuals: Function, jacobian: Function, start: list[float]
) -> None:
    fit = least_squares(residuals, jacobian, np.array(start, dtype=float))
    assert fit.ending is ending
    for number in ("parameters", "chi2", "covariance", "u", "birge", "u_by_scatter", "correlation"):
        with pytest.raises(NotFitted, match=fit.ending.value[:20]):
            getattr(fit, number)


def line(u: float) -> Fitted:
    x, y = np.array([0.0, 1, 2, 3]), np.array([1.0, 3, 4, 8])
    return least_squares(lambda b: (b[0] + b[1] * x - y) / u, lambda b: np.stack([x**0, x], 1) / u, [0, 0])


def test_given_uncertainties_and_scatter_are_never_mixed() -> None:
    """The given one scales `u` alone, what the scatter says does not know it."""
    one, tenth = line(1), line(0.1)
    assert one.u == pytest.approx(np.sqrt([0.7, 0.2]), rel=1e-14)
    assert tenth.u == pytest.approx(0.1 * one.u, rel=1e-14)
    assert tenth.u_by_scatter == pytest.approx(one.u_by_scatter, rel=1e-14)
    assert one.u_by_scatter == pytest.approx(np.sqrt(np.array([0.7, 0.2]) * 1.8 / 2), rel=1e-14)
    assert (one.freedom, one.correlation[0, 1]) == (2, pytest.approx(-0.3 / np.sqrt(0.14), rel=1e-14))


def test_without_a_degree_of_freedom_the_scatter_says_nothing() -> None:
    fit = least_squares(lambda b: b - np.array([1.0, 2]), lambda b: np.eye(2), np.zeros(2))
    assert fit.parameters == pytest.approx([1, 2])
    assert fit.chi2 == 0
    assert np.isnan([fit.birge, fit.offset, *fit.u_by_scatter]).all()
    assert fit.u == pytest.approx([1, 1])


def test_a_step_out_of_the_domain_is_not_taken() -> None:
    """Newton's step from 5 for log(b) = 0 leads to -3."""
    fit = least_squares(np.log, lambda b: np.diag(1 / b), np.array([5.0]))
    assert fit.parameters == pytest.approx([1], rel=1e-15)


@pytest.mark.parametrize("size", [1e-300, 1e-160, 1.0, 1e160, 1e300])
@pytest.mark.parametrize("start", [3.0, 0.0, 1e-30])
def test_neither_the_size_of_residuals_nor_that_of_parameters_matters(size: float, start: float) -> None:
    of_residuals = least_squares(
        lambda b: size * np.array([b[0] ** 3 - 1, b[0] - 1.5]),
        lambda b: size * np.array([[3 * b[0] ** 2], [1.0]]),
        [start],
    )
    of_parameters = least_squares(
        lambda b: np.array([(b[0] / size) ** 3 - 1, b[0] / size - 1.5]),
        lambda b: np.array([[3 * (b[0] / size) ** 2 / size], [1 / size]]),
        [start * size],
    )
    (found,) = of_residuals.parameters
    assert 3 * found**2 * (found**3 - 1) + found - 1.5 == pytest.approx(0, abs=1e-14)
    assert of_parameters.parameters == pytest.approx([found * size], rel=1e-14)


def test_a_triangle_is_that_of_the_normal_equations() -> None:
    rng = np.random.default_rng(1)
    matrix, column = rng.normal(size=(9, 4)) * 10.0 ** np.array([0, 3, -3, 150]), rng.normal(size=9)
    triangle = Triangle.of(matrix, column)
    unit = matrix / triangle.scale
    assert triangle.covariance * np.multiply.outer(triangle.scale, triangle.scale) == pytest.approx(
        np.linalg.inv(unit.T @ unit)
    )
    best = np.linalg.lstsq(unit, column, rcond=None)[0]
    assert triangle.solved() * triangle.scale == pytest.approx(best)
    assert triangle.inside**2 + triangle.outside**2 == pytest.approx(column @ column)
    assert triangle.outside == pytest.approx(np.linalg.norm(unit @ best - column))
    weights = np.array([1.0, 2, 3, 4])
    damped = triangle.damped(weights * triangle.scale)
    ridge = np.linalg.inv(unit.T @ unit + np.diag(weights**2))
    assert damped.solved() * triangle.scale == pytest.approx(ridge @ unit.T @ column)
    x = rng.normal(size=4)
    both = np.vstack([unit, np.diag(weights)])
    assert damped.moved(x / triangle.scale) == pytest.approx(np.linalg.norm(both @ x))
    assert damped.spread(x * triangle.scale) == pytest.approx(np.sqrt(x @ ridge @ x))
    assert triangle.moved(x / triangle.scale) == pytest.approx(np.linalg.norm(unit @ x))
    norms = np.linalg.norm(unit), np.linalg.norm(np.linalg.inv(triangle.upper))
    assert triangle.condition == pytest.approx(norms[0] * norms[1])
    assert np.linalg.cond(unit) <= triangle.condition <= 4 * np.linalg.cond(unit)


BITS = """
import sys
sys.path.insert(0, sys.argv[1])
from test_fitting import STRD
for name in ("Gauss1", "Thurber", "MGH10"):
    fit = STRD[name].fit(STRD[name].starts[0]).fitted
    print([each.hex() for numbers in (fit.parameters, fit.u_by_scatter) for each in numbers.tolist()])
from test_fitting_model import LINE, PEARSON, YORK
found = LINE.fit(PEARSON, YORK, [5, 0])
print([each.hex() for numbers in (found.parameters, found.u_propagated) for each in numbers.tolist()])
"""


def test_the_same_bits_on_every_processor() -> None:
    found = {
        subprocess.run(
            [sys.executable, "-c", BITS, os.path.dirname(__file__)],
            env=os.environ | other,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for other in ({}, lesser())
    }
    assert len(found) == 1
