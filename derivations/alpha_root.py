"""How equation (11) is solved: a form without spurious roots, and where it can change its direction.

Equation (11) as printed also vanishes where an approach would be negative, and at alpha <= 0, where
C x^alpha is no loading curve. Written in u = 1/(alpha + 1) its domain is 0 < u < 1 and (beta + 1) e^2 u < 1
for either test: alpha is positive, and both approaches are. There it is smooth, its sign is that of a
logarithm, and the logarithm turns at most once: its roots can be told apart without a search.
"""

from __future__ import annotations

from typing import Any

from sympy import Expr, Integer, Max, Ne, Piecewise, Poly, Pow, Rational, exp, log, numer, sqrt, together
from sympy.core.parameters import evaluate

from .equation import Derivation, Equation, Kind, Step, assume, define
from .rebuilt import evaluated
from .symbols import VOCABULARY

V, E, XP = (VOCABULARY[name] for name in ("v", "e", "x_p"))
alpha, beta, u, u_turn, Lambda = VOCABULARY.plain("alpha beta u u_turn Lambda")

with evaluate(False):
    reciprocal = assume((u, 1 / (alpha + 1)), "definition", "reciprocal of alpha + 1", Kind.DEFINITION)

    root_form = Equation(
        "(L5)",
        (
            (1 - (beta + 1) * E[1] ** 2 * u)
            - XP[1] / XP[2] * (1 - (beta + 1) * E[2] ** 2 * u) * (V[2] / V[1]) ** (2 * u),
            Integer(0),
        ),
        "(11) times (beta + 1) u, which is positive: smooth on the whole domain",
        title="(11) in u = 1/(alpha + 1)",
    )

    end = Equation(
        "(L24)",
        (1 - u, alpha * u),
        "alpha is positive where u < 1 and nowhere else: roots of (L5) beyond are none of a loading curve",
        title="end of the domain of (11)",
    )

    logarithm = (
        log(1 - (beta + 1) * E[1] ** 2 * u)
        - log(XP[1] / XP[2])
        - log(1 - (beta + 1) * E[2] ** 2 * u)
        - 2 * u * log(V[2] / V[1])
    )

    log_form = Equation(
        "(L6)",
        (root_form.members[0], (1 - (beta + 1) * E[1] ** 2 * u) * (1 - exp(-logarithm))),
        "where both factors are positive, (L5) has the sign of this logarithm",
        title="sign of (L5)",
        conditions=(1 - (beta + 1) * E[1] ** 2 * u > 0, 1 - (beta + 1) * E[2] ** 2 * u > 0),
    )

    _a1, _a2 = (beta + 1) * E[1] ** 2, (beta + 1) * E[2] ** 2

    log_speeds = define("(L7)", Lambda, log(V[2] / V[1]), "logarithm of the speed ratio")

    turning = define(
        "(L8)",
        u_turn,
        2
        * (1 - (_a2 - _a1) / (2 * Lambda))
        / (_a1 + _a2 + sqrt((_a1 - _a2) ** 2 + 2 * _a1 * _a2 * (_a2 - _a1) / Lambda)),
        "turning point",
        "where the logarithm of (L6) turns, if it does",
        conditions=(1 - _a1 * u_turn > 0, 1 - _a2 * u_turn > 0),
    )

    _slope = (beta + 1) * (E[2] ** 2 - E[1] ** 2) / ((1 - _a1 * u) * (1 - _a2 * u)) - 2 * Lambda

    slope = Equation(
        "(L9)",
        (_slope.xreplace({u: u_turn}), Integer(0)),
        "the denominator falls, so the slope is monotone: it vanishes at (L8) alone, and "
        "(11) has at most one root on each side",
        title="slope of the logarithm at (L8)",
        conditions=(1 - _a1 * u_turn > 0, 1 - _a2 * u_turn > 0),
    )


def starting_value() -> Expr:
    """u near the root of (11), within 3e-4 on the paper: it costs steps, never truth.

    In the logarithm of (L6), log(1 - y) is replaced by its expansion about the mean of the two y; a
    quadratic in 1/u is left. Not a claim, so not in the ledger: the solver's bracket decides.
    """
    a1, a2 = E[1] ** 2, E[2] ** 2
    middle, gap = (a1 + a2) / 2, a1 - a2
    pull, log_depths = 2 * log(V[2] / V[1]) / (beta + 1), log(XP[2] / XP[1])
    t = pull + log_depths * middle + gap
    return 2 * log_depths / ((beta + 1) * (t + sqrt(t**2 - 4 * log_depths * pull * middle)))


def _isolated() -> dict[str, Any]:
    """How the one root of (11) is found, for two tests in any order: in u all of it has a closed form."""
    # Both approaches are positive for alpha + 1 > (beta + 1) e^2 of either test, and alpha is for u < 1.
    livelier = (beta + 1) * Max(E[1] ** 2, E[2] ** 2)
    own = evaluated(logarithm)
    at_one, equal_e = own.xreplace({u: Integer(1)}), own.xreplace({E[2]: E[1], u: 1 / livelier})
    # The definition of u is linear in alpha; sympy's own solve() would load its system of units for this.
    by_alpha, rest = Poly(numer(together(reciprocal.residuals[0])), alpha).all_coeffs()
    # Only a pair whose e rises with the speed may have two roots, others get no point.
    point = turning.value.xreplace({Lambda: log_speeds.value})
    start = starting_value()
    # Exchanging the tests exchanges the roots of its quadratic.
    (root,) = (power for power in start.atoms(Pow) if power.exp == Rational(1, 2))
    return {
        "form": root_form,
        "unknown": u,
        "value": -rest / by_alpha,
        "low": Integer(0),
        "high": 1 / Max(livelier, 1),
        # Where u -> 0 the form tends to 1 - x_p1/x_p2. At the other end, if that is not u = 1, the factor of
        # the livelier test vanishes and the other decides; where both vanish, or none, the logarithm of (L6)
        # does: it takes no square of a speed that doubles may not hold.
        "sign_low": XP[2] - XP[1],
        "sign_high": Piecewise((at_one, livelier < 1), (E[2] - E[1], Ne(E[1], E[2])), (equal_e, True)),
        "turning": (Piecewise((point, (E[2] - E[1]) * (V[2] - V[1]) > 0), (Integer(0), True)),),
        "turning_by": (log_form, slope),
        "start": start.xreplace({root: Piecewise((root, V[2] > V[1]), (-root, True))}),
        "steps": 4,
    }


slope_law = Equation(
    "",
    (evaluated(logarithm).diff(u), _slope),
    "definition of the slope",
    title="slope of the logarithm of (L6)",
    conditions=log_form.conditions,
)

ENTRIES = (
    Derivation.of(end, (reciprocal,), (alpha,), "Solve the definition of u for alpha and put it in."),
    Derivation.of(log_form, (), (), "Expand the right-hand side."),
    log_speeds,
    turning,
    Derivation(
        (
            Step(slope_law, (log_speeds,), (Lambda,), "Differentiate the logarithm of (L6)."),
            Step(slope, (turning,), (u_turn,), "Put (L8) in."),
        )
    ),
)
"""What follows (L5) in the ledger; (L5) itself follows from (11)."""

ISOLATED = _isolated()
"""What says how often (11) has a root, and where it is sought: by what a root of a sheet takes."""
