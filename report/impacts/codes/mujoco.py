"""Contact of MuJoCo by solref in its direct format: a spring and a dashpot, which do not pull."""

from sympy import Integer, Symbol

from ..code import STRENGTHS, SimulationCode, Typed, depth
from ..law import ForceLaw, m_red, rate, v_0, x

k, b = Symbol("k", positive=True), Symbol("b", positive=True)

CODE = SimulationCode(
    name="mujoco",
    title="MuJoCo, solref in the direct format",
    version="4.0.0; documentation of commit 01085bd",
    sources=("github.com/google-deepmind/mujoco doc/modeling.rst, Solver parameters, eq. solref_direct",),
    law=ForceLaw("the soft constraint", m_red * (k * x + b * rate)),
    typed=(
        Typed("solref[0]", k, "1/s^2", "minus the stiffness for each kilogram", scale=Integer(-1)),
        Typed("solref[1]", b, "1/s", "minus the damping for each kilogram", scale=Integer(-1)),
    ),
    stiffness=k,
    damping=b,
    damping_unit=v_0 / depth,
    damping_ends=STRENGTHS,
    snippet='<geom condim="1" solref="{solref[0]} {solref[1]}" solimp="0.999 0.999 0.001"/>',
    notes=(
        "solimp with dmin = dmax, condim 1; with friction the cone has a share in the normal force",
        "the time step must be a small part of the contact time, and the flag refsafe off",
    ),
)
