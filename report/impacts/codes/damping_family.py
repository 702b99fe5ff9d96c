"""The damping family itself, for a program in which one writes the force down: c is that of (L106)."""

from ....derivations.contact.damping import K, c, family, n
from ..code import STRENGTHS, SimulationCode, Typed, alpha
from ..law import ForceLaw

CODE = SimulationCode(
    name="damping-family",
    title="a force that one writes down, F = K x^n (1 + c x'/v_0)",
    sources=("Y Gonthier and others, Multibody Syst Dyn 11 (2004) 209, 10.1023/B:MUBO.0000029392.21648.bc",),
    law=ForceLaw("the damping family", family.value),
    typed=(
        Typed("K", K, "N/m^n", "stiffness"),
        Typed("n", n, "1", "exponent of the force", value=alpha),
        Typed("c", c, "1", "damping number"),
    ),
    stiffness=K,
    damping=c,
    damping_ends=STRENGTHS,
    snippet="F = {K}*pow(x, {n})*(1 + {c}*xdot/v_0)",
    notes=(
        "v_0 is the speed of each impact; with one number for c/v_0 restitution hangs on the speed",
        "c is exact; 'loopsheet prove damping' tells what authors give for it",
    ),
)
