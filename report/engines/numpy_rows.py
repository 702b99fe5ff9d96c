"""What a printed function takes over the rows of an axis that have values: their sum, or some by order."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from functools import cached_property, reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..cells.layout import Layout
from ..plan.order import Word, places
from .intervals import Intervals


def chosen(conditions: Sequence[Any], values: Sequence[Any], default: Any) -> Any:
    """What belongs to the first condition that holds: numpy.select, which takes longer for few rows."""
    pairs = zip(reversed(conditions), reversed(values), strict=True)
    return reduce(lambda rest, pair: np.where(pair[0], pair[1], rest), pairs, default)


@dataclass(frozen=True)
class Kept:
    """The rows of an axis, and which of them have values; those that have none may hold anything."""

    mask: NDArray[np.bool_]
    """Of shape (..., rows)."""

    def total(self, terms: Any) -> Any:
        """The sum of the kept rows (..., 1); NumPy adds pairwise along the last dimension.

        Infinite is no number, so that a formula which divides by it is none.
        """
        every = self._every(terms)
        every = np.ascontiguousarray(every) if self._all else np.where(self.mask, every, 0.0)
        total = every.sum(axis=-1, keepdims=True)
        return total + (total - total)

    def ordered(self, terms: Any, word: Word) -> Any:
        """What is taken of the kept rows by their order (..., 1); NaN where there is none."""
        # Those that are left out come last.
        ordered = np.sort(np.where(self.mask, self._every(terms), np.inf), axis=-1)
        number = np.broadcast_to(self.number.astype(np.intp), (*ordered.shape[:-1], 1))
        if not ordered.size:
            return np.full(number.shape, np.nan)
        taken = [
            np.take_along_axis(ordered, np.clip(place, 0, ordered.shape[-1] - 1), axis=-1)
            for place in places(word, number)  # of a batch without rows, cut off below
        ]
        return np.where(number > 0, sum(taken) / len(taken), np.nan)

    @cached_property
    def number(self) -> NDArray[np.float64]:
        """How many rows are kept (..., 1)."""
        return np.count_nonzero(self.mask, axis=-1, keepdims=True).astype(np.float64)

    @cached_property
    def _all(self) -> bool:
        return bool(self.mask.all())

    def _every(self, terms: Any) -> Any:
        if np.shape(terms)[-1:] == self.mask.shape[-1:]:
            return terms
        # A term that names no row is the same for all.
        return np.broadcast_to(terms, np.broadcast_shapes(np.shape(terms), self.mask.shape[-1:]))


@dataclass(frozen=True)
class KeptIntervals:
    """The same for a function that runs on intervals."""

    mask: NDArray[np.bool_]
    """Of shape (..., rows)."""
    sure: NDArray[np.bool_] | None = None
    """Of shape (..., rows); which of the kept rows have values whatever lies in the intervals; of a sum over
    others nothing is known."""

    def total(self, terms: Any) -> Intervals:
        """The sum of the kept rows (..., 1)."""
        every = self.every(terms)
        if not self.mask.all():
            every = Intervals(*(np.where(self.mask, end, 0.0) for end in (every.low, every.high)))
        return every.total()

    def ordered(self, terms: Any, word: Word) -> Intervals:
        """What is taken of all rows: one that is missing moves it less than one that may lie at any end."""
        every = self.every(terms)
        taken = every.in_order(places(word, every.shape[-1]))
        return sum(taken[1:], taken[0]) / len(taken)  # type: ignore[no-any-return]

    @cached_property
    def number(self) -> Intervals:
        """How many rows are kept (..., 1)."""
        most = np.count_nonzero(self.mask, axis=-1, keepdims=True).astype(np.float64)
        if self.sure is None:
            return Intervals(most, most)
        least = np.count_nonzero(self.mask & self.sure, axis=-1, keepdims=True).astype(np.float64)
        return Intervals(*np.broadcast_arrays(least, most))

    def every(self, terms: Any) -> Intervals:
        """The terms, a row each."""
        terms = Intervals.of(terms)
        every = terms.broadcast(np.broadcast_shapes(terms.shape, self.mask.shape))
        return every if self.sure is None or self.sure.all() else every.where(self.sure)  # type: ignore[no-any-return]


@dataclass(frozen=True)
class KeptBetween:
    """Sums of terms that each rise or fall, between points at which they are computed in doubles."""

    mask: NDArray[np.bool_]
    """Of shape (..., rows)."""
    low: NDArray[np.intp]
    high: NDArray[np.intp]
    """`low` and `high`: of shape (parts,); the numbers of the points at the ends of each part."""

    def total(self, terms: Any) -> Intervals:
        """The sum of the kept rows (parts, 1): each term lies between what it is at both ends.

        `terms` (float array (points, rows)): each with an error of at most 2^-31 of its size.
        """
        every = np.where(self.mask, terms, 0.0)
        thin, sizes = (each.sum(axis=-1, keepdims=True) for each in (every, np.abs(every)))
        first, last = every[self.low[self.wide]], every[self.high[self.wide]]
        least, most = thin[self.low], thin[self.low]
        least[self.wide] = np.minimum(first, last).sum(axis=-1, keepdims=True)
        most[self.wide] = np.maximum(first, last).sum(axis=-1, keepdims=True)
        # Twice the terms' own error: what adding them loses is far below the other half.
        slack = 2.0**-30 * (sizes[self.low] + sizes[self.high])
        return Intervals(least - slack, most + slack)

    @cached_property
    def wide(self) -> NDArray[np.intp]:
        """The parts that are no points."""
        return np.flatnonzero(self.low != self.high)


@dataclass(frozen=True)
class InGroups:
    """Rows of which those of a group stand beside one another: what is taken of each group (..., groups)."""

    groups: tuple[Kept | KeptIntervals, ...]
    """The rows of each."""
    where: tuple[slice, ...]
    """Where these stand."""
    size: int
    """How many rows there are."""

    def total(self, terms: Any) -> Any:
        """The sums of the kept rows."""
        return _joined([own.total(some) for own, some in self._each(terms)])

    def ordered(self, terms: Any, word: Word) -> Any:
        """What is taken of the kept rows by their order."""
        return _joined([own.ordered(some, word) for own, some in self._each(terms)])

    @property
    def number(self) -> Any:
        """How many rows are kept."""
        return _joined([own.number for own in self.groups])

    def _each(self, terms: Any) -> Iterator[tuple[Kept | KeptIntervals, Any]]:
        has_rows = getattr(terms, "shape", ())[-1:] == (self.size,)  # of intervals, too
        for own, where in zip(self.groups, self.where, strict=True):
            yield own, terms[..., where] if has_rows else terms


def _joined(parts: Sequence[Any]) -> Any:
    """Numbers, or intervals, beside one another."""
    if not isinstance(parts[0], Intervals):
        return np.concatenate(np.broadcast_arrays(*parts), axis=-1)
    return Intervals(_joined([part.low for part in parts]), _joined([part.high for part in parts]))


def in_groups(kept: Kept | KeptIntervals, layout: Layout) -> Any:
    """What takes something of rows, or of the rows of each group, if they stand in groups."""
    if layout.starts is None:
        return kept
    masks: list[Any] = [getattr(kept, each.name) for each in fields(kept)]

    def part(where: slice) -> Kept | KeptIntervals:
        own: list[Any] = [each if each is None else each[..., where] for each in masks]
        return type(kept)(*own)

    return InGroups(tuple(map(part, layout.groups)), tuple(layout.groups), layout.size)
