"""Law (3) of the soft-impact paper as one model among others: its curve is the one nearest to all tests."""

from __future__ import annotations

from sympy.core.parameters import evaluate

from .. import soft_impact as paper
from ..equation import Derivation, Equation, define
from ..fit_checks import FREE
from ..soft_impact import XM, XP, E
from ..symbols import VOCABULARY as PAPER
from ..symbols import k
from ..vocabulary import Quantity, Vocabulary
from .hertz import duration, timed
from .model import ContactModel
from .quantities import SHARED

OWN = (
    Quantity("x_m_power", "maximum approach by law (3)", "m", r"x_{m,(3)%s}", (1e-5, 1e-4)),
    Quantity("F_m_power", "greatest force by law (3)", "N", r"F_{m,(3)%s}", (100.0, 1e4)),
    Quantity("x_p_power", "imprint by law (3)", "m", r"x_{p,(3)%s}", (1e-6, 1e-4)),
    Quantity("t_power", "duration of the contact by law (3)", "s", r"t_{(3)%s}", (1e-6, 1e-3)),
    Quantity(
        "x_p_power_without",
        "imprint by law (3) through all tests but one",
        "m",
        r"x'_{p,(3)%s}",
        (1e-6, 1e-4),
    ),
)
_WORDS = Vocabulary(*SHARED.values(), *OWN)
e, beta = SHARED.plain("e beta")
x_m, peak, x_p, t = _WORDS.plain("x_m_power F_m_power x_p_power t_power")
R, H, OBSERVED, WITHOUT = PAPER["R"], PAPER["h"], PAPER["x_obs"], _WORDS["x_p_power_without"]

with evaluate(False):
    imprint = Equation(
        "(L161)",
        (x_p, x_m * (1 - (beta + 1) / (paper.alpha + 1) * e**2)),
        "the energy ratio, solved for the imprint",
        title="imprint by law (3)",
        defines=x_p,
    )
    lasting = timed(
        "(L162)", t, "duration of the contact by law (3)", duration, x_m, x_p, e, paper.alpha, beta
    )
    without = define(
        "(L163)",
        WITHOUT.symbol,
        OBSERVED.symbol - R.symbol / (1 - H.symbol),
        "imprint by law (3) through all tests but one",
        "a test that is left out lies this much farther off, along the tangents of the fit",
    )

_ALONE = "the others alone tell no curve: it takes three tests, none with all the weight"
_one = {paper.x_m: x_m, paper.Cprime: peak}
approach = paper.x_m_of_test.at(_one)
greatest = paper.eq9.reversed.at(_one)

POWER_LAW = ContactModel(
    name="power",
    title="law (3) of the paper",
    assumes="loading is the power law that comes nearest to all tests; the restitution is told",
    mark="(3)",
    source="F C Ciornei and others, (3), with the constants of the global fit",
    quantities=OWN,
    constants=2,
    left_out={x_p: WITHOUT.symbol},
    needs={
        WITHOUT.symbol: (1 - H.symbol > FREE, _ALONE),
        x_p: (
            e**2 < (paper.alpha + 1) / (beta + 1),
            "e^2 is not below (alpha + 1)/(beta + 1): the recovery is the whole approach",
        ),
    },
    entries=(
        Derivation.of(
            imprint,
            (paper.ratio.at({XM[k]: x_m, XP[k]: x_p, E[k]: e}),),
            (x_p,),
            "Solve it for the imprint.",
            after=(paper.ratio_step,),
        ),
        lasting,
        without,
    ),
    cells=(approach, greatest, imprint, lasting.claim, without),
    predicts={"x_m": x_m, "F_m": peak, "t": t, "x_p": x_p},
    loading=paper.law_c.value,
    unloading=paper.law_r.value.xreplace({paper.Cprime: peak, paper.x_m: x_m, paper.x_p: x_p}),
)
