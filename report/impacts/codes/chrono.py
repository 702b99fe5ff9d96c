"""Smooth contact of Chrono by the model Flores: Hertz, with the damping of Flores and others."""

from sympy import Rational
from sympy.core.parameters import evaluate

from ....derivations.contact.damping import K_T
from ..code import HERTZ, E, SimulationCode, Typed, e, nu
from ..law import ForceLaw, rate, v_0, x

with evaluate(False):
    LAW = K_T * x ** Rational(3, 2) * (1 + Rational(8, 5) * (1 - e) / e * rate / v_0)

CODE = SimulationCode(
    name="chrono",
    title="Chrono, SMC contact by the model Flores",
    version="Chrono::Multicore, commit e8057d0",
    sources=(
        "github.com/projectchrono/chrono src/chrono_multicore/solver/ChIterativeSolverMulticoreSMC.cpp, "
        "function_CalcContactForces",
    ),
    law=ForceLaw("Flores", LAW, where=HERTZ),
    typed=(
        Typed("young_modulus", E, "Pa", "of both bodies"),
        Typed("poisson_ratio", nu, "1", "of both bodies", value=nu),
        Typed("restitution", e, "1", "to be typed in, not the one that is returned"),
    ),
    stiffness=E,
    damping=e,
    by_hertz=E,
    snippet="SetYoungModulus({young_modulus}), SetPoissonRatio({poisson_ratio}), "
    "SetRestitution({restitution})",
    notes=(
        "tangential displacement MultiStep: the damping is then divided by the impact speed of each contact",
    ),
)
