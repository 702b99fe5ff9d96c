"""The straight line y = a + b x with the least weighted sum of squares, from its normal equations.

Without weights (all of them 1) these are the equations of JCGM 100:2008, H.3, which prints them by sums that
cancel; here the means are taken out first.
"""

from __future__ import annotations

from sympy import Expr, IndexedBase, Sum, Symbol, diff
from sympy.core.parameters import evaluate

from .equation import Derivation, Equation, Kind, Ledger
from .normal_equation import normal_equation

__all__ = ["LEDGER", "a", "b", "k", "n", "w", "x", "x_mean", "y", "y_mean"]

k, n = (Symbol(name, integer=True, positive=True) for name in ("k", "n"))
x, y = (IndexedBase(Symbol(name, real=True)) for name in ("x", "y"))
w = IndexedBase(Symbol("w", positive=True))
"""Weights: 1/u(y_k)^2, if y_k has the standard uncertainty u(y_k) and x_k is exact."""
a, b, x_mean, y_mean = (Symbol(name, real=True) for name in ("a", "b", "x_mean", "y_mean"))
_several = (n >= 2,)


def _total(term: Expr) -> Expr:
    return Sum(term, (k, 1, n))


_squares = _total(w[k] * (y[k] - a - b * x[k]) ** 2)


_normal_a = normal_equation(diff(_squares, a), "intercept")
_normal_b = normal_equation(diff(_squares, b), "slope")

with evaluate(False):
    _mean_x = Equation(
        "(1)",
        (x_mean, _total(w[k] * x[k]) / _total(w[k])),
        "definition",
        Kind.DEFINITION,
        "weighted mean of x",
        defines=x_mean,
    )
    _mean_y = Equation(
        "(2)",
        (y_mean, _total(w[k] * y[k]) / _total(w[k])),
        "definition",
        Kind.DEFINITION,
        "weighted mean of y",
        defines=y_mean,
    )
    _slope = Equation(
        "(3)",
        (b, _total(w[k] * (x[k] - x_mean) * (y[k] - y_mean)) / _total(w[k] * (x[k] - x_mean) ** 2)),
        "slope of the line with the least sum of squares",
        title="slope",
        conditions=_several,
    )
    _intercept = Equation(
        "(4)",
        (a, y_mean - b * x_mean),
        "that line passes through the mean point",
        title="intercept",
    )

LEDGER = Ledger(
    (
        _mean_x,
        _mean_y,
        Derivation.of(
            _slope,
            (_mean_x, _mean_y, _normal_a, _normal_b),
            (x_mean, y_mean, a, b),
            "Both normal equations are linear; solve them for the slope and the intercept.",
        ),
        Derivation.of(
            _intercept,
            (_mean_x, _mean_y, _normal_a),
            (x_mean, y_mean, a),
            "Solve the normal equation of the intercept.",
        ),
    )
)
"""Means, slope and intercept."""
