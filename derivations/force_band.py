"""How sure the force of the common curve is: a band about it, and where each test lies beside it.

Exponent and force are known together only: a curve is known best at some depth within the data, and worse
on both sides of it.

Source: N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed. 1998, 3.1 for the bands of a fitted
curve and of a further observation.
"""

from __future__ import annotations

from dataclasses import replace

from sympy import Expr, diff, log, sqrt
from sympy.core.parameters import evaluate

from . import global_fit as fit
from .equation import Derivation, Equation, Kind, assume, define
from .fit_checks import LEDGER as CHECKS
from .soft_impact import law_c, x
from .symbols import VOCABULARY, F_of, k

XM, XP, R, CP, UC, DC, UN = (VOCABULARY[name] for name in ("x_m", "x_p", "R", "Cprime", "u_C", "dC", "u_new"))
ALPHA, C, F_0, x_0, S_DD, S_DX, S_XX, Delta = VOCABULARY.plain("alpha C F_0 x_0 S_DD S_DX S_XX Delta")
c_aa, c_aF, c_FF = VOCABULARY.plain("c_aa c_aF c_FF")
_A = ALPHA + 1
_ln = log(XM[k] / x_0)

with evaluate(False):
    peak = Equation(
        "(L65)",
        (CP[k], F_0 * (XM[k] / x_0) ** ALPHA),
        "(3) by the force at the mean depth",
        title="force at the approach of a test on the common curve",
        defines=CP[k],
    )

    uncertain = Equation(
        "(L66)",
        (UC[k], CP[k] * sqrt((S_XX * _ln**2 + 2 * _A * S_DX * _ln + _A**2 * S_DD) / Delta)),
        "propagation from the exponent and the force at the mean depth, which are known together",
        title="standard uncertainty of the force on the common curve",
        defines=UC[k],
    )

    beside = Equation(
        "(L67)",
        (DC[k], -_A * CP[k] * R[k] / XP[k]),
        "a curve with this much more force has the depth that was measured",
        title="force beside the common curve",
        defines=DC[k],
    )

    further = define(
        "(L68)",
        UN[k],
        sqrt(UC[k] ** 2 + _A**2 * CP[k] ** 2 / (fit.squares_X.value / fit.n_tests)),
        "standard deviation of the force of a further test",
        "a further test scatters about the curve as the tests do in the mean, by their weights",
    )

# --- why they hold -----------------------------------------------------------------------------------------

_force = peak.sides[1]
_by_alpha, _by_F_0 = diff(_force, ALPHA) / _force, F_0 * diff(_force, F_0) / _force
"""Relative to the force, by the exponent and by the logarithm of the force at the mean depth."""


def _covariance(own: Expr, value: Expr, name: str, because: str = "of the same inverse") -> Equation:
    return define("", own, value, name, because)


_INVERSE = "the inverse of the normal matrix, whose unknowns are alpha and -ln(F_0)/(alpha + 1)"
_covariances = (
    _covariance(c_aa, S_XX / Delta, "variance of the exponent", _INVERSE),
    _covariance(c_aF, _A * S_DX / Delta, "covariance of exponent and force"),
    _covariance(c_FF, _A**2 * S_DD / Delta, "variance of the force, relative"),
)
_propagated = assume(
    (UC[k] / CP[k], sqrt(_by_alpha**2 * c_aa + 2 * _by_alpha * _by_F_0 * c_aF + _by_F_0**2 * c_FF)),
    "law of propagation of uncertainty, with correlation (JCGM 100, 5.2.2), relative to (L65)",
    "uncertainty of the force by propagation",
    Kind.DEFINITION,
)
_as_deep = assume(
    (diff(fit.on_curve, F_0) * F_0 * DC[k] / CP[k], R[k]),
    "definition: the force that changes the imprint depth by the misfit, to first order",
    "depth of a curve with more force",
    Kind.DEFINITION,
)


def _entries() -> tuple[Equation | Derivation, ...]:
    """All of it, in the order of a ledger."""
    at_peak = assume((CP[k], F_of(XM[k])), "definition", "force at the approach", Kind.DEFINITION)
    return (
        Derivation.of(
            peak,
            (at_peak, law_c.at({x: XM[k]}), fit.coefficient),
            (CP[k], F_of(XM[k]), C),
            "Put the coefficient (L31) into (3).",
        ),
        Derivation.of(
            uncertain,
            (_propagated, *_covariances),
            (UC[k], c_aa, c_aF, c_FF),
            "Put the covariances in.",
        ),
        Derivation.of(
            beside,
            (_as_deep, fit.depth, fit.approach),
            (DC[k], XP[k], XM[k]),
            "Differentiate (L33) with (L32) in it by the force.",
        ),
        further,
    )


LEDGER = replace(CHECKS, entries=(*CHECKS.entries, *_entries()))
"""The equations of the paper, those of the fit and of its checks, then these."""
