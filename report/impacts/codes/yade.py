"""Hertz and Mindlin of Yade with a typed restitution: Tsuji's damping, with a force that pulls at the end."""

from ..code import BY_RATIO, TSUJI, E, SimulationCode, Typed, e, nu
from ..law import ForceLaw

CODE = SimulationCode(
    name="yade",
    title="Yade, Ip2_FrictMat_FrictMat_MindlinPhys with en",
    version="commit 15182ac of its MPI branch",
    sources=("github.com/bchareyre/yade-mpi pkg/dem/HertzMindlin.cpp, Law2_ScGeom_MindlinPhys_Mindlin",),
    law=ForceLaw("MindlinPhys", TSUJI, pulls=True, where=BY_RATIO),
    typed=(
        Typed("young", E, "Pa", "of both materials"),
        Typed("poisson", nu, "1", "of both materials", value=nu),
        Typed("en", e, "1", "normal coefficient of restitution"),
    ),
    stiffness=E,
    damping=e,
    by_hertz=E,
    snippet="FrictMat(young={young}, poisson={poisson}), Ip2_FrictMat_FrictMat_MindlinPhys(en={en})",
    notes=("the force pulls at the end of the contact: that is how the typed restitution comes out",),
)
