"""Standard contact force of RecurDyn: a power of the penetration, and damping by another power of it."""

from sympy import Rational, Symbol
from sympy.core.parameters import evaluate

from ..code import STRENGTHS, SimulationCode, Typed, alpha, depth
from ..law import ForceLaw, m_red, rate, v_0, x

k, c, m_1, m_3 = (Symbol(name, positive=True) for name in ("k", "c", "m_1", "m_3"))
with evaluate(False):
    LAW = k * x**m_1 + c * rate * x**m_3
MM = Rational(1000)

CODE = SimulationCode(
    name="recurdyn",
    title="RecurDyn, standard contact force",
    version="the manufacturer's help and questions, as stored; the formula itself is a picture there",
    sources=(
        "functionbay.com/documentation/onlinehelp, Characteristic Page, Standard Contact Force (in words)",
        "functionbay.co.kr, questions: What is the indentation effect of the contact force? (in words: "
        "spring and damping coefficients, exponents m1 of stiffness, m2 of damping, m3 of indentation)",
    ),
    law=ForceLaw("the standard contact force", LAW),
    typed=(
        Typed("Stiffness Coefficient", k, "N/mm^m1", "spring coefficient", scale=MM**-m_1),
        Typed("Stiffness Exponent", m_1, "1", "m1, of the penetration", value=alpha),
        Typed("Damping Coefficient", c, "N s/mm^(1 + m3)", "with m2 = 1", scale=MM ** (-1 - m_3)),
        Typed("Indentation Exponent", m_3, "1", "m3, as m1: the force never pulls", value=alpha),
    ),
    stiffness=k,
    damping=c,
    damping_unit=m_red * v_0 / depth ** (1 + alpha),
    damping_ends=STRENGTHS,
    snippet="Stiffness Coefficient {Stiffness Coefficient}, Damping Coefficient {Damping Coefficient}, "
    "Stiffness Exponent {Stiffness Exponent}, Damping Exponent 1, "
    "Indentation Exponent {Indentation Exponent}",
    notes=(
        "numbers are for the units mm, kg, N, s",
        "the formula was read from the words that go with its picture, and not seen",
    ),
)
