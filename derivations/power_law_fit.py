"""Least-squares fits of F = C x^alpha to points (x_q, F_q): the equations and their derivations.

Two fits are in use and differ: the straight line through the logarithms, which has a closed form, and
the least squares of the force itself, which leaves one equation for alpha. Both follow from setting the
derivatives of their sum of squares to zero.
"""

from __future__ import annotations

from sympy import Integer, Sum, Symbol, diff, exp, log
from sympy.core.parameters import evaluate

from .equation import Derivation, Equation, Kind, assume, define
from .normal_equation import normal_equation
from .symbols import VOCABULARY, q

X, Y, x, F = (VOCABULARY[name] for name in ("X", "Y", "x", "F"))
a, b, Xmean, Ymean, C, C_b, alpha, x_ref, F_ref = VOCABULARY.plain("a b Xmean Ymean C C_b alpha x_ref F_ref")
size = Symbol("n_points", integer=True, positive=True)
"""How many points there are; the sums run over all of them."""
_all = (q, 1, size)

# --- what a fit minimises -----------------------------------------------------------------------------

_squares_log = Sum((Y[q] - a - b * X[q]) ** 2, _all)
# (L13) and (L14) read from right to left: the points by their logarithms.
_in_logs = {x[q]: x_ref * exp(X[q]), F[q]: F_ref * exp(Y[q])}
_squares_lin = Sum((F[q] - C * x[q] ** alpha) ** 2, _all).xreplace(_in_logs)
_F_0 = Symbol("F_0", positive=True)
_squares_at_ref = Sum((F[q] - _F_0 * (x[q] / x_ref) ** alpha) ** 2, _all).xreplace(_in_logs)
"""The same with the force at the reference approach: only of pure numbers has an exponent a logarithm."""


_normal_a = normal_equation(diff(_squares_log, a), "intercept")
_normal_b = normal_equation(diff(_squares_log, b), "slope")
_normal_C = normal_equation(diff(_squares_lin, C), "coefficient")
_normal_alpha = normal_equation(
    diff(_squares_at_ref, alpha).xreplace({_F_0: C * x_ref**alpha}),
    "exponent",
    ", for a given force at the reference approach",
)

# --- the equations, in the order of terms in which they are shown -----------------------------------------

with evaluate(False):
    # The straight line through the logarithms.

    log_x = define("(L13)", X[q], log(x[q] / x_ref), "logarithm of the approach")

    log_F = define("(L14)", Y[q], log(F[q] / F_ref), "logarithm of the force")

    mean_X = define("(L15)", Xmean, Sum(X[q], _all) / size, "mean of X")

    mean_Y = define("(L16)", Ymean, Sum(Y[q], _all) / size, "mean of Y")

    # Deviations from the mean, not raw sums: N Sum(XY) - Sum(X) Sum(Y) cancels.
    alpha_log = Equation(
        "(L17)",
        (b, Sum((X[q] - Xmean) * (Y[q] - Ymean), _all) / Sum((X[q] - Xmean) ** 2, _all)),
        "slope of the least-squares line through the logarithms of the points",
        title="log-log fit: exponent",
    )

    intercept = Equation(
        "(L18)",
        (a, Ymean - b * Xmean),
        "the least-squares line passes through the mean point",
        title="log-log fit: intercept",
    )

    _line = assume(
        (log(C_b * x[q] ** b / F_ref), a + b * log(x[q] / x_ref)),
        "the fitted line, read as a force law",
        "the line as a force law",
        Kind.DEFINITION,
    )

    log_scale = Equation(
        "(L19)",
        (C_b, F_ref / x_ref**b * exp(a)),
        "the intercept of the line, turned back into a coefficient",
        title="log-log fit: coefficient",
    )

    # Least squares of the force, in the logarithms of the points: no power of them leaves the numbers that a
    # computer has.
    _power, _product = exp(2 * alpha * X[q]), exp(Y[q] + alpha * X[q])
    lin_scale = Equation(
        "(L20)",
        (C, F_ref / x_ref**alpha * (Sum(_product, _all) / Sum(_power, _all))),
        "for a given exponent the best coefficient is a ratio of two sums",
        title="least squares of force: coefficient",
    )

    alpha_lin = Equation(
        "(L21)",
        (
            Sum(_product * X[q], _all) * Sum(_power, _all) - Sum(_product, _all) * Sum(_power * X[q], _all),
            Integer(0),
        ),
        "the best exponent, with the best coefficient already put in",
        title="least squares of force: exponent",
    )

# --- why they hold ------------------------------------------------------------------------------------

LOG_FIT = (
    Derivation.of(
        alpha_log,
        (mean_X, mean_Y, _normal_a, _normal_b),
        (Xmean, Ymean, a, b),
        "Both normal equations are linear; solve them for the slope and the intercept.",
    ),
    Derivation.of(
        intercept,
        (mean_X, mean_Y, _normal_a),
        (Xmean, Ymean, a),
        "Solve the normal equation of the intercept.",
    ),
    Derivation.of(log_scale, (_line,), (C_b,), "Solve the line for the coefficient."),
)
LIN_FIT = (
    Derivation.of(lin_scale, (_normal_C,), (C,), "The normal equation is linear in C."),
    Derivation.of(
        alpha_lin,
        (_normal_C, _normal_alpha),
        (C,),
        "Put the best C in; what is left is a multiple of the equation.",
        multiplier=-Sum(_power, _all) / (2 * C * x_ref**alpha * F_ref),
    ),
)

ENTRIES = (log_x, log_F, mean_X, mean_Y, *LOG_FIT, *LIN_FIT)
"""Everything above, in the order of a ledger."""
