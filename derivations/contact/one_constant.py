"""How the one number of a model is taken from the tests: the geometric mean of what each would need.

A test that is left out leaves the mean of the others, exactly: nothing is fitted again. A test that tells
nothing of it is in no mean.
"""

from __future__ import annotations

from sympy import Expr, Rational, Rel, exp, log
from sympy.core.parameters import evaluate

from ..equation import Equation, define
from ..global_fit import n_tests, over_tests
from ..symbols import k
from ..vocabulary import Quantity
from .model import Constant
from .quantities import SHARED

_e = SHARED["e"].symbol
COMES_BACK = (
    _e > Rational(1, 2**30),
    "e = 0: nothing comes back, which tells nothing of an elastic recovery",
)
LOSES = (_e < 1, "e = 1: nothing is lost, which tells nothing of yield")
"""What a test must have for some conclusions, and why."""


def taken(
    of_test: tuple[Equation, ...],
    mean: Quantity,
    alone: Quantity,
    without: Quantity,
    scale: Expr,
    numbers: tuple[str, str],
    *needs: tuple[Rel, str],
) -> tuple[Constant, tuple[Equation, ...]]:
    """The mean over the tests, and over all but one.

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
    *needs : tuple of (Rel, str)
        Without what a test tells nothing of it.
    """
    with evaluate(False):
        over_all = define(
            numbers[0],
            mean.symbol,
            scale * exp(over_tests(log(alone[k] / scale)) / n_tests),
            mean.meaning,
            "geometric mean over the tests: each restitution counts alike",
        )
        left = define(
            numbers[1],
            without.symbol,
            scale * exp((over_tests(log(alone[k] / scale)) - log(alone.symbol / scale)) / (n_tests - 1)),
            without.meaning,
            "the geometric mean of the others",
        )
    return Constant(of_test, over_all, left, needs), (over_all, left)
