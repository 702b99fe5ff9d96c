"""Small changes of what is printed with which everything published comes out.

The kinds of change are tried in turn, those that accuse nobody first. Which of them can matter is decided by
conflicts among the published values (:mod:`.search`); one is dropped only with a certificate.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain

import numpy as np

from ..result.verdict import INPUT, Change, Tried
from ..result.verdict_words import mismatch as in_words
from . import habits, scales
from .digits import is_slip
from .exchanges import columns, exchanged_in_tables, exchanged_inputs, exchanged_rows, orders
from .misprints import misprint, misprints, slipped, two_misprints
from .problem import Problem
from .search import Explained, Search

Kind = Callable[[Search], Iterator[Explained]]

KINDS: tuple[tuple[Kind, ...], ...] = (
    (habits.computed_from_printed, habits.every_row, habits.other_conventions, habits.rounded_constants),
    (
        scales.shortened_inputs, scales.shortened_tables, exchanged_inputs, exchanged_in_tables,
        exchanged_rows, columns, habits.without_a_test, habits.other_rows, habits.neglected,
        scales.misplaced_inputs, scales.misplaced_tables, misprints,
    ),
    (orders, scales.misplaced_together, two_misprints),
)  # fmt: skip
"""What is tried, in the order of how much it changes: later ones only where the earlier explain nothing."""


def explanations(problem: Problem, step: Callable[[str], None]) -> tuple[tuple[Explained, ...], Tried]:
    """Find the smallest changes with which all published values come out.

    Parameters
    ----------
    problem : Problem
        One that cannot be met.
    step : callable
        Told what is begun.

    Returns
    -------
    tuple of Explained
        All that change as little as the least; the likelier first.
    Tried
    """
    search, found = Search(problem), list[Explained]()
    number, tried = sum(map(len, KINDS)), 0
    for kinds in KINDS:
        for kind in kinds:
            step(f"refereeing what would explain the difference: {tried} of {number} kinds of change tried")
            found += kind(search)
            tried += 1
        least = min((each.explanation.count for each in found), default=None)
        if least == 0 or (least is not None and kinds is not KINDS[0]):
            break
    found = _without_near_nothing(found)
    doubts = Doubts.of(search)
    if doubts.alone is not None and least == 0:  # no misprints were looked for
        found += filter(doubts.is_slip_of_it, misprint(search, doubts.alone))
    equal = [each for each in found if each.explanation.count == least or doubts.is_slip_of_it(each)]
    return tuple(sorted(equal, key=doubts.likelihood)), Tried(len(found), search.excluded, search.open)


def possibilities(problem: Problem) -> tuple[Explained, ...]:
    """What would explain what the stated uncertainties explain as well: a habit, or one slip."""
    search = Search(problem)
    kinds = (
        *KINDS[0],
        scales.shortened_inputs,
        scales.shortened_tables,
        habits.neglected,
        scales.misplaced_together,
        slipped,
        exchanged_in_tables,
        exchanged_rows,
    )
    found = chain.from_iterable(kind(search) for kind in kinds)
    return tuple(sorted(found, key=lambda each: not each.alone))


def _without_near_nothing(found: Sequence[Explained]) -> list[Explained]:
    """Explanations without those that make nearly nothing of what was taken as nothing: by a power of ten."""
    firsts = [each.explanation.first for each in found]
    nothing = {change.cell for change in firsts if _is_neglect(change) and change.would_print != "1"}

    def is_near(change: Change) -> bool:
        return change.kind == "unit" and change.power < 0 and not change.index and change.cell in nothing

    return [each for each in found if not is_near(each.explanation.first)]


@dataclass(frozen=True)
class Doubts:
    """What is likelier to be wrong than other numbers, and what less likely."""

    alone: int | None = None
    """The place of the published value that alone does not print as it is recomputed, if there is one."""
    its: tuple[str, str, tuple[int, ...]] | None = None
    """Its source, column and index."""
    exact: frozenset[tuple[str, tuple[int, ...]]] = frozenset()
    """Given cells that are known to be what they are printed as."""

    @classmethod
    def of(cls, search: Search) -> Doubts:
        """Those of published values that do not come out of one input."""
        problem, other = search.problem, search.differing
        held = (problem.unknowns[n] for n in np.flatnonzero(problem.box.width == 0))
        exact = frozenset((unknown.column, unknown.index) for unknown in held)
        if len(other) != 1:
            return cls(exact=exact)
        value = problem.published[other[0]]
        return cls(other[0], (value.source, value.cell, value.index), exact)

    def is_slip_of_it(self, each: Explained) -> bool:
        """Whether one slip in the value that alone does not print explains everything."""
        (change, *others) = each.explanation.changes
        own = change.kind == "misprint" and (change.source, change.cell, change.index) == self.its
        return own and not others and is_slip(change.printed, change.would_print)

    def _is_any_number(self, change: Change) -> bool:
        """Whether what is exact would be another number, found among so many that one always does."""
        if change.kind == "parameter":
            return self.alone is not None and _digits(change) > habits.CHOSEN_FOR_ONE
        is_misprint = (change.kind, change.source) == ("misprint", INPUT)
        return is_misprint and (change.cell, change.index) in self.exact

    def likelihood(self, each: Explained) -> tuple[int, bool, bool, float, float]:
        """What is likelier comes first: what holds for many numbers or is one slip, then what is met best.

        Before all stands what accuses nobody, then one slip where one value alone does not print, or what was
        left out altogether; last stands another number for one that is exact. Of other digits those of the
        value that alone does not print come first, and of slips those with which everything comes out while
        all else is exactly as it is printed.
        """
        change = each.explanation.first
        # A convention with many digits can be made to fit, as the digits of a misprint can.
        long = change.kind == "parameter" and len(change.would_print) > len("1.25")
        plain = change.kind == "misprint" and not is_slip(change.printed, change.would_print)
        of_one = change.kind == "misprint" or (change.kind == "unit" and bool(change.index))
        order = 2 if plain or long else 1 if of_one else 0
        if each.explanation.as_printed:
            order = -2
        elif self.is_slip_of_it(each) or _is_rounding(change) or _is_neglect(change):
            order = -1
        elif self._is_any_number(change):
            order = 3
        elsewhere = (change.source, change.cell, change.index) != self.its
        met = float(in_words(each.explanation.mismatch))
        return order, not each.alone, elsewhere, met, _digits_moved(change)


def _is_neglect(change: Change) -> bool:
    """Whether a parameter, or a column, was taken as if there were none of it."""
    parameter = change.kind == "parameter" and change.would_print in habits.NEUTRAL
    return parameter or change.kind == "neglect"


def _is_rounding(change: Change) -> bool:
    """Whether a parameter was taken with fewer digits than it has."""
    if change.kind != "parameter" or change.count:
        return False
    return change.would_print == f"{float(change.printed):.{_digits(change)}g}"


def _digits(change: Change) -> int:
    """How many a number has that would have to stand."""
    return len(change.would_print.partition("e")[0].replace(".", "").lstrip("-0"))


def _digits_moved(change: Change) -> float:
    """By how many units of the last digit a print moves; by none, where it only was made in another way."""
    if change.kind != "misprint":
        return 0.0
    decimals = len(change.printed.partition(".")[2])
    return float(abs(Fraction(change.printed) - Fraction(change.would_print)) * 10**decimals)
