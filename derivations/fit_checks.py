"""What a fit to all tests says of each test, and whether its exponent goes with the depth.

A test that is left out moves the curve along the tangents that the fit has already, and a further parameter
is looked for along one more: nothing is fitted again.

Source: R. D. Cook and S. Weisberg, Residuals and Influence in Regression, 1982, for tests left out;
C. R. Rao, Proc. Camb. Phil. Soc. 44 (1948) 50 for the parameter that is not fitted.
"""

from __future__ import annotations

from dataclasses import replace

from sympy import Expr, Rational, diff, log, sqrt
from sympy.core.parameters import evaluate

from . import global_fit as fit
from .equation import Derivation, Equation, Kind, assume, define
from .symbols import VOCABULARY, k

XM, XP, W, D, R, LAM, H, Z, A_K, G, T, GAMMA = (
    VOCABULARY[name]
    for name in ("x_m", "x_p", "W", "D", "R", "lam", "h", "z_R", "alpha_k", "G", "T", "gamma")
)
ALPHA, F_0, x_0, S_DD, S_DX, S_XX, Delta = VOCABULARY.plain("alpha F_0 x_0 S_DD S_DX S_XX Delta")
S_TT, S_TD, S_TX, Q, tau, u_tau, X2, phi = VOCABULARY.plain("S_TT S_TD S_TX Q tau u_tau dchi2 phi")
_A = ALPHA + 1
FREE = Rational(1, 2**10)
"""What a leverage leaves of 1 is more than rounding from here on: the other tests alone tell a curve."""

with evaluate(False):
    leverage = define(
        "(L54)",
        H[k],
        W[k] * (S_XX * D[k] ** 2 - 2 * S_DX * D[k] * XP[k] + S_DD * XP[k] ** 2) / Delta,
        "leverage of a test",
        "how far the curve follows the test: 0 not at all, 1 wherever it lies",
    )

    deviation = define(
        "(L48)",
        Z[k],
        R[k] * sqrt(W[k] / (1 - H[k])),
        "misfit in standard deviations",
        "the misfit over its standard deviation, which is smaller where the curve follows the test",
    )

    without = Equation(
        "(L55)",
        (A_K[k], ALPHA - LAM[k] * (S_XX * D[k] - S_DX * XP[k]) / (Delta * (1 - H[k]))),
        "the normal equations without the test, along the tangents of all",
        title="exponent without a test",
        defines=A_K[k],
    )

    trend_of_approach = Equation(
        "(L56)",
        (G[k], -XM[k] / 2 * (log(XM[k] / x_0) ** 2 / _A - 2 * log(XM[k] / x_0) / _A**2 + 2 / _A**3)),
        "the work of compression stays what it is while the exponent goes with the depth",
        title="change of the approach with the trend",
        defines=G[k],
    )

    trend_of_depth = Equation(
        "(L57)",
        (
            T[k],
            G[k] + (XM[k] - XP[k]) * (ALPHA * G[k] / XM[k] + log(XM[k] / x_0) ** 2 / 2),
        ),
        "the work of restitution stays what it is",
        title="change of the imprint depth with the trend",
        defines=T[k],
    )

    squares_T = fit.in_normal_matrix("(L58)", S_TT, T[k] ** 2, "trend")
    trend_with_exponent = fit.in_normal_matrix("(L59)", S_TD, T[k] * D[k], "trend and exponent")
    trend_by_depth = fit.in_normal_matrix("(L60)", S_TX, T[k] * XP[k], "trend and force")

    projected = define(
        "(L61)",
        Q,
        S_TT - (S_XX * S_TD**2 - 2 * S_DX * S_TD * S_TX + S_DD * S_TX**2) / Delta,
        "normal matrix: trend alone",
        "what exponent and force do not make up for",
    )

    trend = define(
        "(L62)",
        tau,
        fit.over_tests(LAM[k] * T[k]) / Q,
        "trend of the exponent",
        "the first step of a fit with a third parameter",
    )

    uncertain_trend = define(
        "(L63)",
        u_tau,
        1 / sqrt(Q),
        "standard uncertainty of the trend",
        "the inverse of the normal matrix, for errors as stated",
    )

    taken_off = define(
        "(L64)",
        X2,
        tau**2 / u_tau**2,
        "sum of squares of the trend",
        "what the third parameter takes off the sum of squares, by one step",
    )

# --- why they hold -----------------------------------------------------------------------------------------


def _left(exponent: Expr, force: Expr, pull: Expr, name: str) -> Equation:
    """A normal equation of the tests that are left, for what the exponent and the force move then."""
    return assume(
        (exponent * (A_K[k] - ALPHA) - force * phi, pull),
        "with all tests it holds where nothing moves; without one, what that one pulled is missing",
        f"normal equation of the {name} without the test",
        Kind.DEFINITION,
    )


_products = S_DX - W[k] * D[k] * XP[k]
_of_exponent = _left(S_DD - W[k] * D[k] ** 2, _products, -LAM[k] * D[k], "exponent")
_of_force = _left(_products, S_XX - W[k] * XP[k] ** 2, -LAM[k] * XP[k], "force")

_work = F_0 * x_0 * (XM[k] / x_0) ** _A / _A
_compression = assume(
    (F_0 * (XM[k] / x_0) ** ALPHA * G[k], -diff(_work, ALPHA, 2) / 2),
    "to first order a trend multiplies the force by 1 + trend ln(x/x_0)^2/2; under the integral of the work "
    "that is half the second derivative by the exponent",
    "work of compression, differentiated by the trend",
    Kind.DEFINITION,
)
_peak = define(
    "",
    GAMMA[k],
    ALPHA * G[k] / XM[k] + log(XM[k] / x_0) ** 2 / 2,
    "maximum force, differentiated by the trend",
    "of the logarithm of the force at the maximum approach, which moves itself",
)
_restitution = assume(
    (GAMMA[k] * (XM[k] - XP[k]) + G[k], T[k]),
    "by (7) the maximum force times the elastic recovery stays what it is",
    "work of restitution, differentiated by the trend",
    Kind.DEFINITION,
)


def _entries() -> tuple[Equation | Derivation, ...]:
    """All of it, in the order of a ledger."""
    return (
        leverage,
        deviation,
        Derivation.of(
            without,
            (_of_exponent, _of_force, leverage, fit.determinant),
            (A_K[k], phi, H[k], Delta),
            "Solve the normal equations of the tests that are left, and put the leverage in.",
        ),
        Derivation.of(trend_of_approach, (_compression,), (G[k],), "Solve for the change of the approach."),
        Derivation.of(
            trend_of_depth,
            (_peak, _restitution),
            (GAMMA[k], T[k]),
            "Put the change of the force into that of the work.",
        ),
        squares_T,
        trend_with_exponent,
        trend_by_depth,
        projected,
        trend,
        uncertain_trend,
        taken_off,
    )


LEDGER = replace(fit.LEDGER, entries=(*fit.LEDGER.entries, *_entries()))
"""The equations of the paper, those of the fit, then these."""
