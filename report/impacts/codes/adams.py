"""IMPACT of Adams and MotionSolve: a power of the penetration, and a dashpot that a cubic step turns on."""

from sympy import Piecewise, Rational, Symbol
from sympy.core.parameters import evaluate

from ..code import STRENGTHS, SimulationCode, Typed, alpha, depth
from ..law import ForceLaw, m_red, rate, v_0, x

k, exponent, c_max, d = (Symbol(name, positive=True) for name in ("k", "e_x", "c_max", "d"))
with evaluate(False):
    STEP = Piecewise(((x / d) ** 2 * (3 - 2 * x / d), x < d), (1, True))
    LAW = k * x**exponent + c_max * STEP * rate
MM = Rational(1000)

CODE = SimulationCode(
    name="adams",
    title="Adams and MotionSolve, IMPACT",
    version="the IMPACT function as documented for SolidWorks 2021, which has Adams as its solver",
    sources=(
        "SolidWorks 2021 help, Motion studies, IMPACT function: "
        "max(0, k (x1 - x)^e - STEP(x, x1 - d, cmax, x1, 0) x')",
        "Adams/Solver, IMPACT: the damping is a cubic step of the penetration, cmax at d (in words)",
        "Altair MotionSolve 2022.2, IMPACT: the same arguments in the same order; its formula was not seen",
    ),
    law=ForceLaw("IMPACT", LAW),
    typed=(
        Typed("k", k, "N/mm^e", "stiffness", scale=MM**-exponent),
        Typed("e", exponent, "1", "force exponent", value=alpha),
        Typed("cmax", c_max, "N s/mm", "greatest damping", scale=1 / MM),
        Typed("d", d, "mm", "penetration at which damping is whole: a tenth of the greatest", depth / 10, MM),
    ),
    stiffness=k,
    damping=c_max,
    damping_unit=m_red * v_0 / depth,
    damping_ends=STRENGTHS,
    snippet="IMPACT(distance, rate, x1, {k}, {e}, {cmax}, {d})",
    notes=("numbers are for the units mm, kg, N, s",),
)
