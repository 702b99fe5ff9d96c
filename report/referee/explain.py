"""Small changes of what is printed with which everything published comes out.

The kinds of change are tried in turn, those that accuse nobody first. Which of them can matter is decided by
conflicts among the published values (:mod:`.conflicts`); one is dropped only with a certificate.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction

from ..result.verdict import Change, Tried
from ..result.verdict_words import mismatch as in_words
from .digits import is_slip
from .exchanges import columns, exchanged_in_tables, exchanged_inputs, orders
from .habits import computed_from_printed, every_row, other_conventions, other_rows
from .misprints import misprints, two_misprints
from .problem import Problem
from .scales import misplaced_inputs, misplaced_tables, truncated_inputs, truncated_tables
from .search import Explained, Search

__all__ = ["Explained", "explanations"]

Kind = Callable[[Search], Iterator[Explained]]

KINDS: tuple[tuple[Kind, ...], ...] = (
    (computed_from_printed, every_row, other_conventions),
    (
        truncated_inputs, truncated_tables, exchanged_inputs, exchanged_in_tables, columns, other_rows,
        misplaced_inputs, misplaced_tables, misprints,
    ),
    (orders, two_misprints),
)  # fmt: skip
"""What is tried, in the order of how much it changes: later ones only where the earlier explain nothing."""


def explanations(problem: Problem) -> tuple[tuple[Explained, ...], Tried]:
    """Find the smallest changes with which all published values come out.

    Parameters
    ----------
    problem : Problem
        One that cannot be met.

    Returns
    -------
    tuple of Explained
        All that change as little as the least; the likelier first.
    Tried
    """
    search, found = Search(problem), list[Explained]()
    for kinds in KINDS:
        found += [each for kind in kinds for each in kind(search)]
        least = min((each.explanation.count for each in found), default=None)
        if least == 0 or (least is not None and kinds is not KINDS[0]):
            break
    equal = [each for each in found if each.explanation.count == least]
    return tuple(sorted(equal, key=_likelihood)), Tried(len(found), search.excluded, search.open)


def _likelihood(each: Explained) -> tuple[int, float, float]:
    """What is likelier comes first: what holds for many numbers or is one slip, then what is met best."""
    change = each.explanation.first
    # A convention with many digits can be made to fit, as the digits of a misprint can.
    long = change.kind == "parameter" and len(change.would_print) > len("1.25")
    plain = change.kind == "misprint" and not is_slip(change.printed, change.would_print)
    order = 2 if plain or long else 1 if change.kind == "misprint" else 0
    return order, float(in_words(each.explanation.mismatch)), _digits_moved(change)


def _digits_moved(change: Change) -> float:
    """By how many units of the last digit a print moves; by none, where it only was made in another way."""
    if change.kind != "misprint":
        return 0.0
    decimals = len(change.printed.partition(".")[2])
    return float(abs(Fraction(change.printed) - Fraction(change.would_print)) * 10**decimals)
