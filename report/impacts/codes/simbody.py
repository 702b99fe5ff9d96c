"""HuntCrossleyForce of Simbody and OpenSim: Hertz with moduli to the power 2/3, and a dissipation in s/m.

What is typed is raised to the power 2/3 when it is stored. As those powers are put in series, two equal
materials are 0.7071 times as stiff as by Hertz.
"""

from sympy import Rational, Symbol, sqrt
from sympy.core.parameters import evaluate

from ..code import STRENGTHS, R, SimulationCode, Typed, elastic
from ..law import ForceLaw, rate, v_0, x

stiffness, dissipation = Symbol("stiffness", positive=True), Symbol("c", positive=True)
k = Symbol("k", positive=True)
with evaluate(False):
    LAW = Rational(4, 3) * k * x * sqrt(R * k * x) * (1 + Rational(3, 2) * dissipation * rate)
    IN_SERIES = ((k, stiffness ** Rational(2, 3) / 2),)

CODE = SimulationCode(
    name="simbody",
    title="Simbody and OpenSim, HuntCrossleyForce",
    version="simbody commit 178eb21, opensim-core commit 0c0ddb2; run in OpenSim 4.6",
    sources=(
        "github.com/simbody/simbody Simbody/src/HuntCrossleyForce.cpp, calcForce",
        "github.com/simbody/simbody Simbody/src/HuntCrossleyForceImpl.h, Parameters: the power 2/3",
        "github.com/opensim-org/opensim-core OpenSim/Simulation/Model/HuntCrossleyForce.cpp hands both on",
    ),
    law=ForceLaw("HuntCrossleyForce", LAW, where=IN_SERIES),
    typed=(
        Typed("stiffness", stiffness, "Pa", "of both surfaces"),
        Typed("dissipation", dissipation, "s/m", "of both surfaces"),
    ),
    stiffness=stiffness,
    damping=dissipation,
    damping_unit=1 / v_0,
    damping_ends=STRENGTHS,
    by_hertz=2 ** Rational(3, 2) * elastic,
    snippet="setBodyParameters(surface, {stiffness}, {dissipation}, us, ud, uv)",
    notes=("both surfaces get the same numbers; friction is not part of this card",),
)
