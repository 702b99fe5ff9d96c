"""Compliant point contact of Drake: linear in the penetration, with Hunt and Crossley's dissipation."""

from sympy import Symbol
from sympy.core.parameters import evaluate

from ..code import STRENGTHS, SimulationCode, Typed
from ..law import ForceLaw, rate, v_0, x

k_1, k, d = (Symbol(name, positive=True) for name in ("k_1", "k", "d"))
with evaluate(False):
    LAW = k * x * (1 + d * rate)
    IN_SERIES = ((k, k_1 / 2),)

CODE = SimulationCode(
    name="drake",
    title="Drake, compliant point contact",
    version="commit 0465a03; run in 1.51.1",
    sources=("github.com/RobotLocomotion/drake multibody/plant/contact_model_doxygen.h, Modeling of Forces",),
    law=ForceLaw("point contact", LAW, where=IN_SERIES),
    typed=(
        Typed("point_contact_stiffness", k_1, "N/m", "of both geometries, which are in series"),
        Typed("hunt_crossley_dissipation", d, "s/m", "of both geometries"),
    ),
    stiffness=k_1,
    damping=d,
    damping_unit=1 / v_0,
    damping_ends=STRENGTHS,
    snippet="AddContactMaterial({hunt_crossley_dissipation}, {point_contact_stiffness}, friction, "
    "&properties)",
    notes=("both geometries get the same numbers; the time step must be short beside the contact time",),
)
