"""Pair style granular of LAMMPS: hertz/material with damping coeff_restitution, limited so as not to pull."""

from ..code import BY_RATIO, TSUJI, E, SimulationCode, Typed, e, nu
from ..law import ForceLaw

CODE = SimulationCode(
    name="lammps",
    title="LAMMPS, granular hertz/material, damping coeff_restitution, limit_damping",
    version="commits 07b704c and 14dc2fb; run in 22 Jul 2025",
    sources=(
        "github.com/lammps/lammps src/GRANULAR/gran_sub_mod_damping.cpp, GranSubModDampingCoeffRestitution",
        "github.com/lammps/lammps src/GRANULAR/granular_model.cpp, calculate_forces",
    ),
    law=ForceLaw("hertz/material", TSUJI, where=BY_RATIO),
    typed=(
        Typed("E", E, "Pa", "Young's modulus of both bodies"),
        Typed("e", e, "1", "to be typed in, not the one that is returned"),
        Typed("nu", nu, "1", "Poisson's ratio of both bodies", value=nu),
    ),
    stiffness=E,
    damping=e,
    by_hertz=E,
    snippet="pair_coeff * * hertz/material {E} {e} {nu} tangential ... damping coeff_restitution "
    "limit_damping",
    notes=(
        "numbers are for units si",
        "without limit_damping the force pulls at the end and the typed restitution is returned",
    ),
)
