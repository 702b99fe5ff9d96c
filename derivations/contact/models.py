"""All contact models, and their equations beside the tests in one ledger."""

from __future__ import annotations

from .. import global_fit as fit
from .. import soft_impact as paper
from ..equation import Derivation, Equation, Ledger
from ..fit_checks import leverage
from ..symbols import VOCABULARY as PAPER
from ..vocabulary import Vocabulary
from . import checks, prescribed
from .compared import compared
from .hertz import CONTACT, HERTZ
from .johnson import JOHNSON, YIELD
from .lankarani_1994 import LANKARANI_1994
from .model import ContactModel
from .power_law import POWER_LAW
from .quantities import SHARED
from .thornton import THORNTON

MODELS = (HERTZ, LANKARANI_1994, JOHNSON, THORNTON, POWER_LAW)
BESIDE = {model.name: compared(model, f"(L{number})") for number, model in enumerate(MODELS, 191)}
"""Each beside the tests; a new model is the last of them, and there are numbers up to (L200) for it."""

_PREMISES = [
    "(1)",
    "(3)",
    "(5)",
    "(6)",
    "(7)",
    "(8)",
    "(9)",
    "(10a)",
    "(10b)",
    "(10c)",
    "(L1)",
    "(L2)",
    "(L3)",
    "(L4)",
]
"""What the law of the paper and the fit to all tests rest on, of the paper."""


def _of_paper() -> tuple[Equation | Derivation, ...]:
    """The equations of the paper that models need, and those of the fit."""
    labelled = {(e.claim if isinstance(e, Derivation) else e).label: e for e in paper.LEDGER.entries}
    fitted = fit.LEDGER.entries[len(paper.LEDGER.entries) :]
    return (*(labelled[label] for label in _PREMISES), *fitted, leverage)


def _beside(*models: ContactModel) -> tuple[Equation, ...]:
    return tuple(equation for model in models for equation in BESIDE[model.name].equations)


_PAPER = _of_paper()
_ELASTIC = (*CONTACT, *HERTZ.entries)
LEDGER = Ledger(
    entries=(
        *_PAPER,
        *CONTACT,
        *(entry for model in MODELS for entry in model.entries),
        *_beside(*MODELS),
        *checks.ENTRIES,
        *prescribed.ENTRIES,
    ),
    vocabulary=Vocabulary(
        *dict.fromkeys((
            *PAPER.values(),
            *SHARED.values(),
            *(own for model in MODELS for own in model.quantities),
            *(own for beside in BESIDE.values() for own in beside.quantities),
            *checks.OWN,
            *prescribed.OWN,
        ))
    ),
    parts=(
        (*_PAPER, *POWER_LAW.entries, *_beside(POWER_LAW)),
        (*CONTACT, *checks.ENTRIES),
        (*CONTACT, *prescribed.ENTRIES),
        *(
            tuple(dict.fromkeys((*_ELASTIC, *YIELD, *model.entries, *_beside(model))))
            for model in MODELS
            if model is not POWER_LAW
        ),
    ),
)  # fmt: skip
"""The paper's law with its fit, and each other model: they exclude one another."""
