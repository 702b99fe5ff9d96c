"""A pair's loading curve by its force at one depth, without its coefficient.

The coefficient C of a curve C x^alpha is as large as a force over a depth to the power alpha: for a large
exponent no double holds it, although every force on the curve is an ordinary one. The paper's fits need the
forces alone.
"""

from __future__ import annotations

from sympy import Integer, log
from sympy.core.parameters import evaluate

from .equation import Derivation, Equation
from .power_law_fit import log_F
from .symbols import VOCABULARY, F_of, k, q

V, XM, CP, X, F, Y = (VOCABULARY[name] for name in ("v", "x_m", "Cprime", "x", "F", "Y"))
x, C, alpha, m_red, F_ref = VOCABULARY.plain("x C alpha m_red F_ref")

with evaluate(False):
    peak = Equation(
        "(L26)",
        (CP[k], (alpha + 1) * m_red * V[k] ** 2 / (2 * XM[k])),
        "(10a) and (10c), without the coefficient",
        title="maximum force by the approach",
    )

    on_curve = Equation(
        "(L27)",
        (F_of(x), CP[2] * (x / XM[2]) ** alpha),
        "the loading curve passes through the maximum force of the second test",
        title="loading curve by its force at one depth",
    )

    log_force = Equation(
        "(L28)",
        (Y[q], log(CP[2] / F_ref) + alpha * log(X[q] / XM[2])),
        "(L27) in logarithms: they are ordinary numbers where the force is next to nothing",
        title="logarithm of a generated force",
        defines=Y[q],
    )


def entries(work: Equation, force: Equation, law: Equation) -> tuple[Derivation, ...]:
    """The derivations, in the order of a ledger.

    Parameters
    ----------
    work : Equation
        The work of compression of test k is its kinetic energy, (10a).
    force : Equation
        The maximum force of test k lies on the loading curve, (10c).
    law : Equation
        The loading curve, of (3).
    """
    point = on_curve.at({F_of(x): F[q], x: X[q]})
    return (
        Derivation.of(peak, (work, force), (C, CP[k]), "Put the coefficient that (10a) gives into (10c)."),
        Derivation.of(
            on_curve,
            (law, force.at({k: Integer(2)})),
            (F_of(x), C),
            "Put the coefficient that (10c) gives for test 2 into the compression branch of (3).",
        ),
        Derivation.of(log_force, (log_F, point), (Y[q], F[q]), "Put (L27) into the definition of Y."),
    )
