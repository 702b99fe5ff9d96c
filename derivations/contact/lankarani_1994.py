"""Lankarani and Nikravesh 1994: Hertz's loading, and unloading from there to an imprint.

Source: H M Lankarani, P E Nikravesh, Continuous contact force models for impact analysis in multibody
systems, Nonlinear Dynamics 5 (1994) 193-207. The paper itself was not read for it: the law is that of (2).
"""

from __future__ import annotations

from sympy.core.parameters import evaluate

from .. import soft_impact as paper
from ..equation import Derivation, Equation, Step
from ..soft_impact import XM, XP, E
from ..symbols import k
from ..vocabulary import Quantity, Vocabulary
from . import hertz
from .model import ContactModel
from .one_constant import LOSES
from .quantities import SHARED

__all__ = ["LANKARANI_1994"]

OWN = (
    Quantity(
        "x_p_lankarani", "imprint by Lankarani and Nikravesh", "m", r"x_{p,\mathrm{LN}%s}", (1e-6, 1e-4)
    ),
)  # fmt: skip
_WORDS = Vocabulary(*SHARED.values(), *hertz.OWN, *OWN)
(e,) = SHARED.plain("e")
x_m, peak, x_p = _WORDS.plain("x_m_hertz F_m_hertz x_p_lankarani")

with evaluate(False):
    imprint = Equation(
        "(L134)",
        (x_p, x_m * (1 - e**2)),
        "what is not given back is the area between both branches",
        title="imprint by Lankarani and Nikravesh",
        defines=x_p,
    )

LANKARANI_1994 = ContactModel(
    name="lankarani",
    title="Lankarani and Nikravesh 1994",
    mark="LN",
    assumes="loading is Hertz's, whatever yields; the restitution is told, and the imprint follows",
    source="H M Lankarani, P E Nikravesh, Nonlinear Dynamics 5 (1994) 193-207, 10.1007/BF00045676",
    quantities=OWN,
    entries=(
        Derivation(
            (
                paper.ratio_step,
                Step(
                    imprint,
                    (
                        paper.ratio.at(
                            {
                                XM[k]: x_m,
                                XP[k]: x_p,
                                E[k]: e,
                                paper.alpha: hertz.hertz,
                                paper.beta: hertz.hertz,
                            }
                        ),
                    ),
                    (x_p,),
                    "Read it for Hertz's exponent on both branches, and solve for the imprint.",
                ),
            ),
        ),
    ),
    cells=(hertz.approach, hertz.greatest, imprint),
    predicts={"x_p": x_p},
    needs={x_p: LOSES},
    loading=hertz.HERTZ.loading,
    unloading=hertz.unloads(peak, x_m, x_p),
)
