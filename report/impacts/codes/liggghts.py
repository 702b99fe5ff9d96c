"""The normal model hertz of LIGGGHTS: Tsuji's damping by a typed restitution; the force may not pull."""

from ..code import BY_RATIO, TSUJI, E, SimulationCode, Typed, e, nu
from ..law import ForceLaw

CODE = SimulationCode(
    name="liggghts",
    title="LIGGGHTS-PUBLIC, model hertz with limitForce on",
    version="commits 25fc396 and 84ba3d7; run in 3.8.0",
    sources=(
        "github.com/CFDEMproject/LIGGGHTS-PUBLIC src/normal_model_hertz.h, surfacesIntersect",
        "github.com/CFDEMproject/LIGGGHTS-PUBLIC src/global_properties.cpp, createBetaEff",
    ),
    law=ForceLaw("hertz", TSUJI, where=BY_RATIO),
    typed=(
        Typed("youngsModulus", E, "Pa", "of both bodies"),
        Typed("poissonsRatio", nu, "1", "of both bodies", value=nu),
        Typed("coefficientRestitution", e, "1", "to be typed in, not the one that is returned"),
    ),
    stiffness=E,
    damping=e,
    by_hertz=E,
    snippet="pair_style gran model hertz limitForce on",
    notes=(
        "hard_particles yes before the properties: without it a modulus above 1e9 Pa is refused",
        "with limitForce off, the default, the force pulls at the end and the typed restitution is returned",
    ),
)
