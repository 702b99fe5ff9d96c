"""The fits of a power law: what the proved equations give is what least squares gives."""

import math
import random

import mpmath
import numpy as np
import pytest

from loopsheet.derivations import power_law_fit as fit
from loopsheet.derivations.equation import Derivation, Equation
from loopsheet.derivations.evaluation import Tape
from loopsheet.derivations.proof import check_step
from loopsheet.derivations.proved import ProofStatus
from loopsheet.derivations.rebuilt import evaluated
from loopsheet.derivations.symbols import VOCABULARY

x, F = (VOCABULARY[name].symbol for name in ("x", "F"))
x_ref, F_ref, alpha, C = (VOCABULARY[name].symbol for name in ("x_ref", "F_ref", "alpha", "C"))


def points(seed: int, scatter: float) -> tuple[list[float], list[float]]:
    rng = random.Random(seed)
    depths = [1e-5 * (n + 1) for n in range(12)]
    return depths, [3e7 * d**1.31 * math.exp(scatter * rng.gauss(0, 1)) for d in depths]


def logarithms(depths: list[float], forces: list[float]) -> dict[str, list[mpmath.mpf]]:
    """Of points, over an approach of 4e-5 m and a force of 300 N."""
    return {
        name: [mpmath.log(mpmath.mpf(value) / scale) for value in column]
        for name, column, scale in (("X", depths, 4e-5), ("Y", forces, 300))
    }


def compute(equation: Equation, **values: object) -> mpmath.mpf:
    """The value of a formula; columns are lists that begin with row 1."""
    expression = evaluated(equation.members[-1] if equation.members[-1] != 0 else equation.members[0])
    given = [*values]
    known = (name for name in given if name in VOCABULARY)
    symbols = {"n_points": fit.size, **{name: VOCABULARY[name].symbol for name in known}}
    program = Tape([symbols[name] for name in given])
    group = program.add([expression])
    program.start(
        [[0, *map(mpmath.mpf, v)] if isinstance(v, list) else mpmath.mpf(v) for v in values.values()]
    )
    return program.values(group)[0]


@pytest.mark.parametrize("seed", range(5))
def test_the_log_fit_is_the_straight_line_through_the_logarithms(seed: int) -> None:
    depths, forces = points(seed, 0.05)
    d0, f0 = 4e-5, 300.0
    X, Y = ([math.log(value / scale) for value in column] for column, scale in ((depths, d0), (forces, f0)))
    x_mean, y_mean = (
        compute(e, **{n: c, "n_points": 12}) for e, n, c in ((fit.mean_X, "X", X), (fit.mean_Y, "Y", Y))
    )
    slope = compute(fit.alpha_log, X=X, Y=Y, Xmean=x_mean, Ymean=y_mean, n_points=12)
    height = compute(fit.intercept, Xmean=x_mean, Ymean=y_mean, b=slope)
    coefficient = compute(fit.log_scale, F_ref=f0, x_ref=d0, a=height, b=slope)
    b, a = np.polyfit(np.log(depths), np.log(forces), 1)
    assert float(slope) == pytest.approx(b, rel=1e-10)
    assert math.log(coefficient) == pytest.approx(a, rel=1e-10)


@pytest.mark.parametrize("seed", range(5))
def test_the_linear_fit_is_least_in_force(seed: int) -> None:
    depths, forces = points(seed, 0.05)
    with mpmath.workdps(30):
        logs = logarithms(depths, forces)

        def coefficient(exponent: object) -> mpmath.mpf:
            return compute(fit.lin_scale, **logs, F_ref=300.0, x_ref=4e-5, alpha=exponent, n_points=12)

        def squares(exponent: object) -> mpmath.mpf:
            c = coefficient(exponent)
            return mpmath.fsum(
                (f - c * mpmath.mpf(d) ** exponent) ** 2 for d, f in zip(depths, forces, strict=True)
            )

        exponent = mpmath.findroot(lambda p: compute(fit.alpha_lin, **logs, alpha=p, n_points=12), (1.2, 1.4))
        least = squares(exponent)
        assert 1.1 < exponent < 1.5
        for off in (-0.01, -1e-4, 1e-4, 0.01):
            assert squares(exponent + off) > least
        c = coefficient(exponent)
        for off in (0.999, 1.001):
            moved = mpmath.fsum(
                (f - c * off * mpmath.mpf(d) ** exponent) ** 2 for d, f in zip(depths, forces, strict=True)
            )
            assert moved > least


def test_without_scatter_both_fits_give_the_law_back() -> None:
    logs = {**logarithms(*points(0, 0.0)), "n_points": 12}
    there, beside = (compute(fit.alpha_lin, alpha=exponent, **logs) for exponent in (1.31, 1.32))
    assert abs(there) < 1e-12 * abs(beside)
    scale = compute(fit.lin_scale, alpha=1.31, F_ref=300.0, x_ref=4e-5, **logs)
    assert float(scale) == pytest.approx(3e7, rel=1e-10)


@pytest.mark.parametrize("derivation", [*fit.LOG_FIT, *fit.LIN_FIT], ids=lambda d: d.claim.label)
def test_each_follows_from_the_normal_equations(derivation: Derivation) -> None:
    for step in derivation.steps:
        assert check_step(step).status is ProofStatus.PROVED


def test_sums_of_squares_are_what_is_differentiated() -> None:
    names = {
        premise.title
        for derivation in (*fit.LOG_FIT, *fit.LIN_FIT)
        for step in derivation.steps
        for premise in step.premises
    }
    assert {f"normal equation of the {p}" for p in ("intercept", "slope", "coefficient", "exponent")} <= names
