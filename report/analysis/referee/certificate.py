"""What is certain: bounds of published cells over a whole box of inputs, and of their worst mismatch."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...conditions import conditions
from ...layout import Layout
from ...sheet import SheetError
from ..enclosure import Enclosure, slope_kernels
from ..intervals import Intervals
from .problem import Array, Problem

__all__ = ["Certificate"]

MOST = 1 << 24
"""Derivatives that are kept at once; of a larger campaign nothing is made certain."""


@dataclass(frozen=True)
class Certificate:
    """Bounds that hold for every input in a problem's box.

    Parameters
    ----------
    problem : Problem
    """

    problem: Problem

    @property
    def _layouts(self) -> dict[str, Layout]:
        return dict(self.problem.campaign.values.layouts)

    def _enclosed(self, low: Array, high: Array) -> Enclosure:
        problem = self.problem
        data = {
            name: Intervals.of(np.atleast_1d(np.asarray(value, dtype=np.float64)))
            for name, value in problem.data(low).items()
        }
        data |= {name: Intervals.near(low[rows], high[rows]) for name, rows in problem.rows.items()}
        return Enclosure(problem.sheet, problem.program, self._layouts, data)

    @cached_property
    def _over_box(self) -> Enclosure:
        return self._enclosed(self.problem.box.low, self.problem.box.high)

    @cached_property
    def _middle(self) -> Array:
        box = self.problem.box
        with np.errstate(over="ignore"):
            middle = np.clip(box.low / 2 + box.high / 2, box.low, box.high)
        # What is free is best looked at where the others put it.
        wide = np.array([unknown.printed is None for unknown in self.problem.unknowns], dtype=bool)
        return np.where(wide, box.start, middle)

    @cached_property
    def _cells(self) -> tuple[Intervals, Intervals]:
        """The published cells over the box, and in its middle."""
        places = self.problem.places
        return tuple(  # type: ignore[return-value]
            Intervals(*(np.array([getattr(found.value[name], end)[row] for name, row in places])
                        for end in ("low", "high")))
            for found in (self._over_box, self._enclosed(self._middle, self._middle))
        )  # fmt: skip

    @cached_property
    def _slopes(self) -> Intervals:
        """Derivatives (published, unknowns) over the box."""
        problem = self.problem
        if problem.size * len(problem.unknowns) > MOST:
            raise _TooLarge
        known = problem.campaign.derivatives
        if id(problem.program) not in known:  # the campaign keeps its programs
            made = conditions(problem.sheet)
            known[id(problem.program)] = made, slope_kernels(made)
        made, kernels = known[id(problem.program)]
        sources = {name: np.array(rows) for name, rows in problem.rows.items()}
        found = self._over_box.derivatives(made, kernels, sources)
        ends = (
            np.array([getattr(found[name], end)[row] for name, row in problem.places])
            for end in ("low", "high")
        )
        return Intervals(*ends)

    @cached_property
    def _offsets(self) -> Intervals:
        box = self.problem.box
        middle = Intervals(self._middle, self._middle)
        return Intervals.near(box.low, box.high) - middle  # type: ignore[no-any-return]

    @cached_property
    def bounds(self) -> Intervals:
        """What no input in the box can leave, for each published cell in SI; infinite if not known."""
        try:
            over, middle = self._cells
            mean_value = middle + (self._slopes * self._offsets).total(axis=1, keepdims=False)
            found: Intervals = over.within(mean_value)
        except _NOT_POSSIBLE:
            nothing = np.full(len(self.problem.published), np.inf)
            return Intervals(-nothing, nothing)
        return found

    def at_least(self, weights: Array) -> float:
        """What the worst mismatch is at least, for every input in the box.

        Whatever the weights w, whose sizes sum to W, the worst of the mismatches r_k is at least
        sum(w_k r_k) / W; the sum is bounded by its own mean-value form, so that what cancels in it cancels.

        Parameters
        ----------
        weights : float array (published,)
            Best those of the linear program that could not do better.
        """
        which = np.flatnonzero(np.abs(weights) > 1e-9)
        if not which.size:
            return 0.0
        try:
            cells, slopes = self._cells[1][which], self._slopes[which]
        except _NOT_POSSIBLE:
            return 0.0
        own = weights[which]
        half, centre = (
            Intervals.near(ends, ends)[which] for ends in (self.problem.half, self.problem.centre)
        )
        share = Intervals.of(own / np.abs(own).sum()) / half
        with np.errstate(all="ignore"):
            at_middle = (share * (cells - centre)).total(keepdims=False)
            along = (share[:, None] * slopes).total(axis=0, keepdims=False)
            bound = at_middle + (along * self._offsets).total(keepdims=False)
        return max(0.0, float(bound.low), float(-bound.high))


class _TooLarge(Exception):
    """More derivatives than are worth keeping."""


_NOT_POSSIBLE: Any = (_TooLarge, SheetError, TypeError)
"""A campaign that is too large, or a program with a function that intervals do not know."""
