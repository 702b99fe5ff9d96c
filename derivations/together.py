"""Whether all that a ledger assumes and proves can hold together: one point at which it does is sought.

If none is found, as few statements as possible are named that do not hold together.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from sympy import Expr, Integral, Rational
from sympy.core.function import AppliedUndef

from .algebra import in_powers
from .equation import Equation, Kind, Ledger, Step
from .few_rows import Statement
from .grounds import is_assumed
from .proved import enumerated
from .reductions import REDUCTIONS
from .search import are_impossible, seek

_NEARLY_ZERO = Rational(1, 10**6)
"""Where a quantity that goes to zero is looked at."""


@dataclass(frozen=True)
class Contradiction:
    """Statements that were not seen to hold together, as few as there were found."""

    culprit: Equation
    """The last of them: without it, everything before it in the ledger holds together."""
    others: tuple[Equation, ...]
    """What it does not agree with."""
    certain: bool
    """Whether they cannot hold together; else no point was found at which they do."""

    @property
    def sentence(self) -> str:
        """The finding, in words."""
        nowhere = "no point was found where"
        if not self.others:
            return (
                f"{self.culprit.label} cannot hold"
                if self.certain
                else f"{nowhere} {self.culprit.label} holds"
            )
        others = enumerated(dict.fromkeys(other.label for other in self.others))
        if self.certain:
            return f"{self.culprit.label} cannot hold together with {others}"
        return f"{nowhere} {self.culprit.label} holds together with {others}"


@lru_cache(maxsize=16)
def conflict(
    ledger: Ledger, standing: frozenset[Equation], claims: frozenset[Equation]
) -> Contradiction | None:
    """What of a ledger does not agree with the rest; None where a point was found at which all of it holds.

    `standing`: of the ledger, what nothing was found against. `claims`: of these, what was proved without
    going to a limit.
    """
    if ledger.parts:
        parts = (replace(ledger, entries=entries, parts=()) for entries in ledger.parts)
        return next(filter(None, (conflict(part, standing, claims) for part in parts)), None)
    everything, words = _statements(ledger, standing, claims), ledger.vocabulary
    # Claims for different domains need not hold at one point: each must with what holds everywhere.
    everywhere = [s for s in everything if is_assumed(s.source) or not s.conditions]
    alone = [[*everywhere, s] for s in everything if s not in everywhere]
    for some in (everything, everywhere, *alone):
        sought = seek(some, words)
        if sought.point is not None:
            if some is everything:
                return None
        elif some is not everything or not alone:
            *others, culprit = (statement.source for statement in sought.within)
            return Contradiction(culprit, tuple(others), are_impossible(sought.within, words))
    return None


# --- what is to hold -------------------------------------------------------------------------------------


def _statements(
    ledger: Ledger, standing: frozenset[Equation], claims: frozenset[Equation]
) -> list[Statement]:
    """Everything that a ledger assumes, as its steps use it, and its claims, in its order."""
    found: list[Statement] = []
    for entry in ledger.entries:
        if isinstance(entry, Equation):
            found += [_statement(entry, {}, ())] if entry in standing else []
        elif entry.claim in standing:
            found += [statement for step in entry.steps for statement in _of_step(step)]
            found += [_statement(entry.claim, {}, ())] if entry.claim in claims else []
    return list({(s.source.label, s.sides, s.conditions): s for s in reversed(found)}.values())[::-1]


def _of_step(step: Step) -> Iterator[Statement]:
    """What a step assumes: laws of functions are put into the others."""
    hints = dict(zip(step.premises, step.eliminate, strict=False))
    laws = {hint: premise.sides[-1] for premise, hint in hints.items() if isinstance(hint, AppliedUndef)}
    for premise in step.premises:
        if is_assumed(premise) and hints.get(premise) not in laws:
            yield _statement(premise, laws, (hints[premise],) if premise in hints else ())


def _statement(equation: Equation, laws: Mapping[Any, Expr], hints: tuple[Expr, ...]) -> Statement:
    sides = [_summed(side.xreplace(laws)) for side in equation.sides]
    if equation.kind is Kind.LIMIT:
        sides = [sides[0], _NEARLY_ZERO]
    stated = [side for side in sides if not isinstance(side, Expr)]
    equal = [side for side in sides if isinstance(side, Expr) and not _is_unknown(side)]
    defined = () if equation.defines is None else (equation.defines,)
    return Statement(equation, tuple(equal), (*stated, *equation.conditions), (*defined, *hints, *equal[:1]))


def _summed(side: Any) -> Any:
    """A side with the integrals of powers in closed form: a search evaluates it some thousand times."""
    closed = {each: in_powers(each) for each in side.atoms(Integral) if not each.atoms(AppliedUndef)}
    return side.xreplace({each: value for each, value in closed.items() if value is not None})


def _is_unknown(side: Expr) -> bool:
    """Whether a side integrates or sums a function of which nothing is said."""
    return any(loop.atoms(AppliedUndef) for loop in side.atoms(Integral, *REDUCTIONS))
