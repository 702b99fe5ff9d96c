"""The equations of a shipped workbook as data: what there is to say of them, and how they are written."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import cache
from typing import Any

from ..derivations.equation import Derivation, Equation, Kind, Ledger, Step
from ..derivations.vocabulary import Quantity, Vocabulary
from .document.parts import Written
from .document.written import gone, written
from .partly import partly

_WORDS = ("number", "part", "title", "because")


@dataclass(frozen=True)
class ToldEquation:
    """What an equation says; `origin` is what it is an instance of."""

    words: dict[str, str]
    kind: str
    written: Written | None
    origin: ToldEquation | None


@dataclass(frozen=True)
class _ToldStep:
    claim: ToldEquation
    premises: tuple[ToldEquation, ...]
    says: str
    gone: tuple[str, ...]


@dataclass(frozen=True)
class ToldLedger:
    """What a ledger says: each entry is an equation, or the steps that end in one."""

    vocabulary: tuple[dict[str, Any], ...]
    entries: tuple[ToldEquation | tuple[_ToldStep, ...], ...]


def told_equation(equation: Equation, names: Mapping[str, str], vocabulary: Vocabulary) -> ToldEquation:
    """What there is to keep of an equation; parameters as for :func:`~.document.written.written`."""
    parent = equation.parent
    origin = None if parent is None else ToldEquation(_words(parent), parent.kind.value, None, None)
    own = written(equation, names, vocabulary)
    return ToldEquation(_words(equation), equation.kind.value, own, origin)


def told_ledger(ledger: Ledger, names: Mapping[str, str]) -> ToldLedger:
    """What there is to keep of a ledger."""

    def equation(own: Equation) -> ToldEquation:
        return told_equation(own, names, ledger.vocabulary)

    def step(own: Step) -> _ToldStep:
        return _ToldStep(equation(own.claim), tuple(map(equation, own.premises)), own.says, gone(own, names))

    return ToldLedger(
        tuple(asdict(quantity) for quantity in ledger.vocabulary.values()),
        tuple(
            tuple(map(step, entry.steps)) if isinstance(entry, Derivation) else equation(entry)
            for entry in ledger.entries
        ),
    )


def _words(equation: Equation) -> dict[str, str]:
    return {name: getattr(equation, name) for name in _WORDS}


def known_equation(told: ToldEquation, whole: Callable[[], Equation]) -> Equation:
    """The equation of what was told.

    `whole`: returns the equation that it was told of.
    """
    parent = None if told.origin is None else known_equation(told.origin, lambda: whole().origin)
    known = {**told.words, "kind": Kind(told.kind), "parent": parent, "written": told.written}
    return partly(Equation, known, whole)


def known_ledger(told: ToldLedger, declared: Callable[[], Ledger]) -> Ledger:
    """The ledger of what was told; parameters as for :func:`known_equation`."""
    declared = cache(declared)
    entries = tuple(_entry(own, declared, n) for n, own in enumerate(told.entries))
    words = ({**own, "span": tuple(own["span"])} for own in told.vocabulary)
    vocabulary = Vocabulary(*(Quantity(**own) for own in words))
    return partly(Ledger, {"entries": entries, "vocabulary": vocabulary}, declared)


def _entry(
    told: ToldEquation | tuple[_ToldStep, ...], declared: Callable[[], Ledger], place: int
) -> Equation | Derivation:
    def whole() -> Any:
        return declared().entries[place]

    if isinstance(told, ToldEquation):
        return known_equation(told, whole)
    steps = tuple(_step(own, lambda n=n: whole().steps[n]) for n, own in enumerate(told))  # type: ignore[misc]
    return partly(Derivation, {"steps": steps}, whole)


def _step(told: _ToldStep, whole: Callable[[], Step]) -> Step:
    premises = tuple(
        known_equation(own, lambda n=n: whole().premises[n])  # type: ignore[misc]
        for n, own in enumerate(told.premises)
    )
    claim = known_equation(told.claim, lambda: whole().claim)
    return partly(Step, {"claim": claim, "premises": premises, "says": told.says, "gone": told.gone}, whole)
