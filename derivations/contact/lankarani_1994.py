"""Lankarani and Nikravesh 1994: Hertz's loading, and unloading from there to an imprint.

Source: H M Lankarani, P E Nikravesh, Continuous contact force models for impact analysis in multibody
systems, Nonlinear Dynamics 5 (1994) 193-207. The paper itself was not read for it: the law is that of (2).
"""

from __future__ import annotations

from sympy.core.parameters import evaluate

from .. import soft_impact as paper
from ..equation import Derivation, Equation
from ..soft_impact import XM, XP, E
from ..symbols import k
from ..vocabulary import Quantity, Vocabulary
from . import hertz
from .model import ContactModel
from .one_constant import LOSES
from .quantities import SHARED

OWN = (
    Quantity(
        "x_p_lankarani", "imprint by Lankarani and Nikravesh", "m", r"x_{p,\mathrm{LN}%s}", (1e-6, 1e-4)
    ),
    Quantity(
        "t_lankarani",
        "duration of the contact by Lankarani and Nikravesh",
        "s",
        r"t_{\mathrm{LN}%s}",
        (1e-6, 1e-3),
    ),
)  # fmt: skip
_WORDS = Vocabulary(*SHARED.values(), *hertz.OWN, *OWN)
(e,) = SHARED.plain("e")
x_m, peak, x_p, t = _WORDS.plain("x_m_hertz F_m_hertz x_p_lankarani t_lankarani")

with evaluate(False):
    imprint = Equation(
        "(L134)",
        (x_p, x_m * (1 - e**2)),
        "what is not given back is the area between both branches",
        title="imprint by Lankarani and Nikravesh",
        defines=x_p,
    )
    by_force = Equation(
        "(L165)",
        (x_p, 5 * hertz.m_red * hertz.v**2 * (1 - e**2) / (4 * peak)),
        "the same, told by the greatest force",
        title="imprint by the greatest force",
    )
    lasting = hertz.timed(
        "(L166)", t, "duration of the contact by Lankarani and Nikravesh", hertz.duration, x_m, x_p, e
    )

LANKARANI_1994 = ContactModel(
    name="lankarani",
    title="Lankarani and Nikravesh 1994",
    mark="LN",
    assumes="loading is Hertz's, whatever yields; the restitution is told, and the imprint follows",
    source="H M Lankarani, P E Nikravesh, Nonlinear Dynamics 5 (1994) 193-207, 10.1007/BF00045676",
    quantities=OWN,
    entries=(
        Derivation.of(
            imprint,
            (
                paper.ratio.at(
                    {XM[k]: x_m, XP[k]: x_p, E[k]: e, paper.alpha: hertz.hertz, paper.beta: hertz.hertz}
                ),
            ),
            (x_p,),
            "Read it for Hertz's exponent on both branches, and solve for the imprint.",
            after=(paper.ratio_step,),
        ),
        Derivation.of(
            by_force,
            (imprint, hertz.greatest, hertz.approach),
            (x_p, peak, x_m),
            "Put approach and force in.",
        ),
        lasting,
    ),
    cells=(hertz.approach, hertz.greatest, imprint, lasting.claim),
    predicts={"t": t, "x_p": x_p},
    needs={x_p: LOSES},
    loading=hertz.HERTZ.loading,
    unloading=hertz.unloads(peak, x_m, x_p),
)
