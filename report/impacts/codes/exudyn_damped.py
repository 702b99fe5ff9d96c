"""Impact model 2 of Exudyn: Hunt and Crossley's force with c by Carvalho and Martins, or by Gonthier."""

from sympy import Piecewise, Rational, Symbol
from sympy.core.parameters import evaluate

from ....derivations.contact.damping import c, carvalho_martins, gonthier
from ..code import SimulationCode, Typed, alpha, e
from ..law import ForceLaw, rate, v_0, x

k, n = Symbol("k", positive=True), Symbol("n", positive=True)
with evaluate(False):
    NUMBER = Piecewise((carvalho_martins.members[-1], e > Rational(1, 3)), (gonthier.members[-1], True))
    LAW = k * x**n * (1 + c * rate / v_0)

CODE = SimulationCode(
    name="exudyn-damped",
    title="Exudyn, ObjectContactSphereSphere with impactModel 2",
    version="1.13.6; source of commit e4b8e51",
    sources=(
        "github.com/jgerstmayr/EXUDYN main/src/Objects/CObjectContactSphereSphere.cpp, ComputeContactForces",
    ),
    law=ForceLaw("impact model 2", LAW, where=((c, NUMBER),)),
    typed=(
        Typed("contactStiffness", k, "N/m^n", "stiffness"),
        Typed("contactStiffnessExponent", n, "1", "exponent of the force", value=alpha),
        Typed("restitutionCoefficient", e, "1", "to be typed in"),
    ),
    stiffness=k,
    damping=e,
    snippet="ObjectContactSphereSphere(..., contactStiffness={contactStiffness}, contactDamping=0, "
    "contactStiffnessExponent={contactStiffnessExponent}, restitutionCoefficient={restitutionCoefficient}, "
    "impactModel=2)",
    notes=("minimumImpactVelocity below the slowest impact",),
)
