"""Plastic contact of two spheres of Exudyn: a linear spring that is stiffer when unloaded, and an imprint."""

from sympy import Symbol

from ..code import SimulationCode, Typed
from ..law import ForceLaw, x, x_max

k, ratio = Symbol("k_1", positive=True), Symbol("r", positive=True)

CODE = SimulationCode(
    name="exudyn",
    title="Exudyn, ObjectContactSphereSphere with contactPlasticityRatio",
    version="1.13.6; source of commit e4b8e51",
    sources=(
        "github.com/jgerstmayr/EXUDYN main/src/Objects/CObjectContactSphereSphere.cpp, ComputeContactForces",
    ),
    law=ForceLaw("the plastic contact", k * x, k / (1 - ratio) * (x - ratio * x_max), ratio * x_max),
    typed=(
        Typed("contactStiffness", k, "N/m", "while loading"),
        Typed("contactPlasticityRatio", ratio, "1", "imprint over the greatest approach"),
    ),
    stiffness=k,
    damping=ratio,
    snippet="ObjectContactSphereSphere(..., contactStiffness={contactStiffness}, contactDamping=0, "
    "contactPlasticityRatio={contactPlasticityRatio}, impactModel=0)",
    notes=("contactStiffnessExponent 1, no adhesion and no pull-off force",),
)
