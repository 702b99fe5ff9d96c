"""How equation (11) is solved: a form without spurious roots, and where it can change its direction.

Equation (11) as printed also vanishes where an approach would be negative, and at alpha <= 0, where
C x^alpha is no loading curve. Written in u = 1/(alpha + 1) its domain is 0 < u < 1 and (beta + 1) e^2 u < 1
for either test: alpha is positive, and both approaches are. There it is smooth, its sign is that of a
logarithm, and the logarithm turns at most once: its roots can be told apart without a search.
"""

from __future__ import annotations

from sympy import Expr, Integer, exp, log, sqrt
from sympy.core.parameters import evaluate

from .equation import Derivation, Equation, Kind, Step, define
from .rebuilt import evaluated
from .symbols import VOCABULARY

__all__ = [
    "ENTRIES",
    "Lambda",
    "end",
    "log_form",
    "log_speeds",
    "logarithm",
    "reciprocal",
    "root_form",
    "slope",
    "slope_law",
    "starting_value",
    "turning",
    "u",
    "u_turn",
]

V, E, XP = (VOCABULARY[name] for name in ("v", "e", "x_p"))
alpha, beta, u, u_turn, Lambda = VOCABULARY.plain("alpha beta u u_turn Lambda")

with evaluate(False):
    reciprocal = Equation("", (u, 1 / (alpha + 1)), "definition", Kind.DEFINITION, "reciprocal of alpha + 1")

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
