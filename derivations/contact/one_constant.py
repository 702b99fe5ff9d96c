"""How the one number of a model is taken from the tests: the geometric mean of what each would need.

A test that is left out leaves the mean of the others, exactly: nothing is fitted again.
"""

from __future__ import annotations

from sympy import Expr, exp, log
from sympy.core.parameters import evaluate

from ..equation import Derivation, Equation, Kind
from ..global_fit import n_tests, over_tests
from ..symbols import k
from ..vocabulary import Quantity
from .model import Constant

__all__ = ["taken"]


def taken(
    of_test: tuple[Equation, ...],
    mean: Quantity,
    alone: Quantity,
    without: Quantity,
    scale: Expr,
    numbers: tuple[str, str],
) -> tuple[Constant, tuple[Equation | Derivation, ...]]:
    """The mean over the tests and over all but one, and how the second follows from the first.

    Parameters
    ----------
    of_test : tuple of Equation
        What a test alone would need.
    mean, alone, without : Quantity
        Over all tests, by one, by all but one.
    scale : Expr
        Of the same dimension: of pure numbers alone there are logarithms.
    numbers : tuple of str
        Of both equations.
    """
    with evaluate(False):
        over_all = Equation(
            numbers[0],
            (mean.symbol, scale * exp(over_tests(log(alone[k] / scale)) / n_tests)),
            "geometric mean over the tests: each restitution counts alike",
            Kind.DEFINITION,
            mean.meaning,
            defines=mean.symbol,
        )
        others = Equation(
            "",
            (
                log(without.symbol / scale) * (n_tests - 1),
                n_tests * log(mean.symbol / scale) - log(alone.symbol / scale),
            ),
            "the logarithm of the test is missing in the sum, and one test in the number of tests",
            Kind.DEFINITION,
            f"logarithms of the others: {without.meaning}",
        )
        left = Equation(
            numbers[1],
            (without.symbol, mean.symbol * (mean.symbol / alone.symbol) ** (1 / (n_tests - 1))),
            "the geometric mean of the others",
            title=without.meaning,
            defines=without.symbol,
        )
    step = Derivation.of(left, (others,), (without.symbol,), "Solve for the mean of the others.")
    return Constant(of_test, over_all, left), (over_all, step)
