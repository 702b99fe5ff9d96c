"""What is certain: bounds of published cells over a whole box of inputs, and of their worst mismatch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..engines.intervals import Intervals
from ..judge.enclosure import Enclosure
from ..sheet import SheetError
from .campaign import Array
from .problem import Box, Problem

MOST = 1 << 24
"""Derivatives that are kept at once; of a larger campaign nothing is made certain."""


class _Enclosed:
    """The cells of a problem's sheet over a box, whatever was published."""

    def __init__(self, problem: Problem, box: Box) -> None:
        self.problem, self.box = problem, box

    @cached_property
    def over_box(self) -> Enclosure:
        return _enclosure(self.problem, self.box.low, self.box.high)

    @cached_property
    def point(self) -> Array:
        """The middle of the box; what is free is best looked at where the others put it."""
        box = self.box
        with np.errstate(over="ignore"):
            middle = np.clip(box.low / 2 + box.high / 2, box.low, box.high)
        wide = np.array([unknown.printed is None for unknown in self.problem.unknowns], dtype=bool)
        return np.where(wide, np.clip(box.start, box.low, box.high), middle)

    @cached_property
    def at_point(self) -> Enclosure:
        return _enclosure(self.problem, self.point, self.point)

    @cached_property
    def offsets(self) -> Intervals:
        middle = Intervals(self.point, self.point)
        return Intervals.near(self.box.low, self.box.high) - middle  # type: ignore[no-any-return]

    @cached_property
    def slopes(self) -> dict[str, Intervals]:
        """Derivatives (rows, unknowns) of every column over the box."""
        problem = self.problem
        if problem.size * len(problem.unknowns) > MOST:
            raise _TooLarge
        return self.over_box.derivatives(problem.made, problem.sources)


def _enclosure(problem: Problem, low: Array, high: Array) -> Enclosure:
    """The cells for given cells (..., unknowns) in intervals."""
    data = {
        name: Intervals.of(np.atleast_1d(np.asarray(value, dtype=np.float64)))
        for name, value in problem.data(low).items()
        if name not in problem.rows
    }
    ends = {name: (problem.column(name, low), problem.column(name, high)) for name in problem.rows}
    # Of a missing datum nothing is known.
    data |= {name: Intervals.near(*each).where(problem.sources[name] >= 0) for name, each in ends.items()}
    return Enclosure(problem.sheet, problem.program, dict(problem.campaign.values.layouts), data)


@dataclass(frozen=True)
class Certificate:
    """Bounds that hold for every input in a box."""

    problem: Problem
    box: Box | None = None
    """That of the printed digits, if left out."""

    @cached_property
    def _enclosed(self) -> _Enclosed:
        """That of the printed digits is shared by all problems of a program, whatever was published."""
        problem = self.problem
        if self.box is not None:
            return _Enclosed(problem, self.box)
        return problem.campaign.once(("cells", *problem.asked_of), lambda: _Enclosed(problem, problem.box))

    @cached_property
    def _plain(self) -> NDArray[np.intp]:
        """The published values that follow the sheet; of others nothing is known here."""
        return np.flatnonzero([way is None for way in self.problem.ways])

    def _of_published(self, found: Any) -> Intervals:
        """What holds of columns, for the published cells."""
        places = [self.problem.places[n] for n in self._plain]
        return Intervals(
            *(np.array([getattr(found[name], end)[row] for name, row in places]) for end in ("low", "high"))
        )

    @cached_property
    def _cells(self) -> tuple[Intervals, Intervals]:
        """The published cells over the box, and at a point of it."""
        enclosed = self._enclosed
        return self._of_published(enclosed.over_box.value), self._of_published(enclosed.at_point.value)

    @cached_property
    def _sure(self) -> NDArray[np.bool_]:
        """Which published cells have a value wherever in the box."""
        places = (self.problem.places[n] for n in self._plain)
        return np.array([self._enclosed.over_box.sure[name][row] for name, row in places], dtype=bool)

    @cached_property
    def _slopes(self) -> Intervals:
        """Derivatives (published, unknowns) over the box."""
        return self._of_published(self._enclosed.slopes)

    @cached_property
    def bounds(self) -> Intervals:
        """What no input in the box can leave, for each published cell in SI; infinite if not known."""
        nothing = np.full(len(self.problem.published), np.inf)
        low, high = -nothing, nothing.copy()
        try:
            found, middle = self._cells
            if self._sure.any():
                mean_value = middle + (self._slopes * self._enclosed.offsets).total(axis=1, keepdims=False)
                found = found.within(mean_value)
            low[self._plain], high[self._plain] = found.low, found.high
        except _NOT_POSSIBLE:
            pass
        return Intervals(low, high)

    def at_least(self, weights: Array) -> float:
        """What the worst mismatch is at least, for every input in the box.

        Whatever the weights w, whose sizes sum to W, the worst of the mismatches r_k is at least
        sum(w_k r_k) / W; the sum is bounded by its own mean-value form, so that what cancels in it cancels.

        `weights` (float array (published,)): best those of the linear program that could not do better.
        """
        own = weights[self._plain]
        which = np.flatnonzero(np.abs(own) > 1e-9)
        if not which.size:
            return 0.0
        try:
            if not self._sure[which].all():
                return 0.0  # what may have no value may change in any way
            slopes = self._slopes[which]
            moves = (self._enclosed.offsets.low < 0) | (self._enclosed.offsets.high > 0)
            if (np.isinf(slopes.low) & np.isinf(slopes.high) & moves).any():
                return 0.0  # what may do anything over the box need not be looked at in its middle
            cells = self._cells[1][which]
        except _NOT_POSSIBLE:
            return 0.0
        own = own[which]
        half, centre = (
            Intervals.near(ends, ends)[self._plain[which]]
            for ends in (self.problem.half, self.problem.centre)
        )
        share = Intervals.of(own / np.abs(own).sum()) / half
        with np.errstate(all="ignore"):
            at_middle = (share * (cells - centre)).total(keepdims=False)
            along = (share[:, None] * slopes).total(axis=0, keepdims=False)
            bound = at_middle + (along * self._enclosed.offsets).total(keepdims=False)
        return max(0.0, float(bound.low), float(-bound.high))


def excluded(problem: Problem, boxes: Sequence[Box]) -> NDArray[np.bool_]:
    """In which boxes certainly no input yields every value, each looked at by itself."""
    out = np.zeros(len(boxes), dtype=bool)
    try:
        low, high = (np.stack([getattr(box, end) for box in boxes]) for end in ("low", "high"))
        found = _enclosure(problem, low, high).value
    except _NOT_POSSIBLE:
        return out
    asked = zip(problem.published, problem.places, problem.ways, strict=True)
    for n, (value, (name, row), way) in enumerate(asked):
        if way is None and n not in problem.ignored:
            least, largest = (float(end) for end in value.printed.interval)
            least, largest = np.nextafter(least, -np.inf), np.nextafter(largest, np.inf)
            cell = found[name][..., row].broadcast((len(boxes),))
            out |= (cell.high < least) | (cell.low > largest)
    return out


class _TooLarge(Exception):
    """More derivatives than are worth keeping."""


_NOT_POSSIBLE: Any = (_TooLarge, SheetError, TypeError)
"""A campaign that is too large, or a program with a function that intervals do not know."""
