"""How many roots each row has, and where: branch and bound with intervals of an equation and of its slope.

A part of the interval is settled where the equation is certainly not zero, or certainly rises, or certainly
falls; any other is halved. Between parts where it is not zero it then crosses zero once if its signs there
differ, and never if they do not. What remains of a row after all halvings, such as a double root, where the
equation touches zero, leaves it undecided: nothing is guessed.

Source: R. E. Moore, R. B. Kearfott and M. J. Cloud, Introduction to Interval Analysis, SIAM, 2009, chapter 8.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .intervals import Intervals

Array = NDArray[np.float64]
Enclose = Callable[[NDArray[np.intp], Array, Array], tuple[Intervals, Intervals, NDArray[np.bool_]]]

HALVINGS = 48
"""How often a part is halved before it is given up."""
CROWD = 64
"""How many parts of a row may be unsettled at a time."""


class Doubtful(Exception):
    """The roots in a part of an interval could not be counted."""

    def __init__(self, low: Any, high: Any) -> None:
        self.part = (low, high)


@dataclass
class Isolated:
    """The roots of every row, each between two points where the equation certainly has a sign."""

    brackets: list[list[tuple[float, float, float]]]
    """Increasing."""
    undecided: dict[int, tuple[float, float]] = field(default_factory=dict)
    """By row; the part of the interval in which the roots of a row could not be counted."""

    def doubt(self, row: int, low: float, high: float) -> None:
        """Leave a row undecided because of a part of its interval."""
        before = self.undecided.get(row, (low, high))
        self.undecided[row] = (min(low, before[0]), max(high, before[1]))


def isolate(
    enclose: Enclose, low: Array, high: Array, signs: tuple[Array, Array], parts: int = 1
) -> Isolated:
    """Isolate all roots of the open intervals.

    Parameters
    ----------
    enclose : callable
        For numbers of rows and the ends of a part of each: an interval that holds the equation's values there
        and one that holds its slope, all of the numbers where the equation may not be continuous; then,
        whether to give the row up.
    low, high : float arrays (rows,)
    signs : tuple of float array (rows,)
        The equation's signs at both ends where intervals cannot tell them; 0 where nobody can.
    parts : int
        In how many an interval is asked about at first.
    """
    rows = np.arange(len(low))
    found = Isolated([[] for _ in rows])
    if not rows.size:
        return found
    settled: list[Any] = []
    open_rows = np.flatnonzero(low < high)
    first, last = low[open_rows, None], high[open_rows, None]
    inner = np.minimum(first + (last - first) * np.arange(1, parts) / parts, last)
    edges = np.concatenate([first, inner, last], axis=1)
    # One call for both ends of every row, as intervals without width, and for the first parts.
    asked = np.concatenate([rows, rows, np.repeat(open_rows, parts)])
    a, b = (np.concatenate([low, high, own.reshape(-1)]) for own in (edges[:, :-1], edges[:, 1:]))
    value, slope, hopeless = enclose(asked, a, b)
    count = 2 * len(rows)
    both = value.sign[:count].reshape(2, -1)
    before, after = (np.where(at == 0, told, at) for at, told in zip(both, signs, strict=True))
    rows, a, b = (each[count:] for each in (asked, a, b))
    value, slope, hopeless = value[count:], slope[count:], hopeless[count:]
    for _ in range(HALVINGS):
        middle = a + (b - a) / 2
        done = (value.sign != 0) | (slope.sign != 0)
        settled.append([each[done] for each in (rows, a, b, value.sign, slope.sign)])
        rows, a, b, middle, hopeless = (each[~done] for each in (rows, a, b, middle, hopeless))
        # Many open parts side by side: the slope's interval stays too wide, and halving would not end.
        crowded = np.bincount(rows, minlength=len(low))[rows] > CROWD
        whole = crowded | hopeless | ~((middle > a) & (middle < b))
        for row, left, right in zip(*(each[whole].tolist() for each in (rows, a, b)), strict=True):
            found.doubt(row, left, right)
        # Of a row that is given up nothing more is asked.
        kept = ~np.isin(rows, list(found.undecided))
        rows, a, b, middle = (each[kept] for each in (rows, a, b, middle))
        if not rows.size:
            break
        rows, a, b = np.tile(rows, 2), np.concatenate([a, middle]), np.concatenate([middle, b])
        value, slope, hopeless = enclose(rows, a, b)
    for row, left, right in zip(rows.tolist(), a.tolist(), b.tolist(), strict=True):
        found.doubt(row, left, right)
    every = [np.concatenate(each) for each in zip(*settled, strict=True)]
    # By row, then from left to right: parts were settled in the order of their size.
    order = np.lexsort((every[1], every[0]))
    by_row: list[list[Any]] = [[] for _ in low]
    for row, *part in zip(*(each[order].tolist() for each in every), strict=True):
        by_row[row].append(part)
    for row, own in enumerate(by_row):
        if own and row not in found.undecided:
            try:
                found.brackets[row] = crossings((low[row], high[row]), (before[row], after[row]), own)
            except Doubtful as doubtful:
                found.doubt(row, *doubtful.part)
    return found


def crossings(
    ends: tuple[Any, Any], signs: tuple[Any, Any], parts: Iterable[Sequence[Any]]
) -> list[tuple[Any, Any, Any]]:
    """Follow the settled parts of an interval from the left, and note where the sign changes.

    Parameters
    ----------
    ends : tuple of numbers
        Of the interval.
    signs : tuple of numbers
        The equation's there; 0 where it is not known.
    parts : iterable of (left, right, sign, sign of the slope)
        All of the interval, in order; a sign is 0 where it is not certain.

    Returns
    -------
    list of (left, right, sign at the right end)
        Each holds one root.

    Raises
    ------
    Doubtful
        There is a part of which nothing is certain, or the sign beside one that rises or falls is not known.
    """
    found = []
    place, before, way = ends[0], signs[0], 0
    for left, right, sign, slope in [*parts, (ends[1], ends[1], signs[1], 0)]:
        # Parts side by side in which it rises are one stretch; so are those in which it falls.
        if sign == 0 and way * slope >= 0 and slope:
            way = slope
            continue
        if sign == 0 and left < right:
            raise Doubtful(left, right)
        # Between two parts with a sign lies a stretch of one slope: one root, or none.
        if left > place:
            if before * sign == 0:
                raise Doubtful(place, left)
            if before * sign < 0:
                found.append((place, left, sign))
        elif before * sign < 0:
            raise Doubtful(place, place)  # a jump
        place, before, way = right, sign, 0
    return found
