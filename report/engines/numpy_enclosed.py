"""The equation of a root and its slope, for intervals of the unknown: what counts the roots of a row.

Where the unknown stands in nothing but sums of exponentials, their terms are computed in doubles, at the ends
of many parts at once: each rises or falls, so that it lies between both ends all over the part. What is made
of the sums, with what rounding may have done to them, is intervals again.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .intervals import Intervals, joined, whole
from .isolation import Isolated, isolate
from .kernels import Array, Enclosing
from .numpy_rows import KeptBetween, KeptIntervals

Mask = NDArray[np.bool_]

PARTS = 32
"""How many parts of an interval are asked about at once where that is cheap."""
TAME = (2.0**-60, 2.0**60, 400.0)
"""Between what cells that are not 0 lie in size, and up to what exponents are, so that no term leaves the
doubles."""
_BLOCK = 1 << 18
"""How many terms are put into intervals at a time."""


@dataclass(frozen=True)
class EnclosedRows:
    """The cells that a root names, for intervals of the unknown of some rows."""

    kernel: Enclosing
    """The root's, from :func:`~loopsheet.report.engines.certified.enclosing`."""
    cells: Mapping[str, Intervals]
    """By name; its arguments, but the unknown."""
    terms_of: Collection[str]
    """Those of them whose rows are the terms of sums."""
    kept: Mapping[str, Mask]
    """Of shape (..., rows), by axis name; for the axes that it sums over, the rows that have values."""
    shape: tuple[int, ...]
    """Of the root's rows, batch first."""
    moving: bool = False
    """Whether cells are intervals: halving the unknown's then settles nothing around a point where nothing is
    certain, and the row is given up."""
    by_points: bool = False
    """Whether terms are computed in doubles, at the ends of parts
    (:class:`~loopsheet.report.engines.numpy_rows.KeptBetween`)."""

    def isolate(
        self, asked: NDArray[np.intp], low: Array, high: Array, signs: tuple[Array, Array]
    ) -> Isolated:
        """The roots of some rows, numbered in the flattened shape."""
        own = replace(self, by_points=self._tame(low, high))
        parts = PARTS if own.by_points else 1
        return isolate(lambda rows, a, b: own.enclose(asked[rows], a, b), low, high, signs, parts)

    def _tame(self, low: Array, high: Array) -> bool:
        """Whether doubles hold all terms of the sums, with nearly all of their digits."""
        reach = self.kernel.reach
        cells = {name: self.cells[name] for name in self.kernel.arguments if name in self.cells}
        if reach is None or not low.size or any(cell.low is not cell.high for cell in cells.values()):
            return False
        if any(name not in self.terms_of and cell.low.size > 1 for name, cell in cells.items()):
            return False
        (mask,) = (self.kept[axis] for axis in self.kernel.totals)
        size = {
            name: np.where(mask if name in self.terms_of else True, np.abs(cell.low), 0.0)
            for name, cell in cells.items()
        }
        if not all(((each == 0) | ((each >= TAME[0]) & (each <= TAME[1]))).all() for each in size.values()):
            return False
        most = max(np.abs(low).max(), np.abs(high).max())
        exponents = reach.run(
            *(size[name].max(initial=0.0) if name in size else most for name in reach.arguments)
        )
        return bool(np.isfinite(most) and max(exponents) <= TAME[2])

    def enclose(self, rows: NDArray[np.intp], low: Array, high: Array) -> tuple[Intervals, Intervals, Mask]:
        """The equation, its slope, whole where it does not tell the course, and whether to give the row up.

        Parameters
        ----------
        rows : integer array (parts,)
            In the flattened shape.
        low, high : float arrays (parts,)
        """
        terms = max((self.cells[name].shape[-1] for name in self.terms_of if name in self.cells), default=1)
        each = max(1, _BLOCK // max(1, terms))
        blocks = [slice(n, n + each) for n in range(0, max(len(rows), 1), each)]
        found = [self._block(rows[block], low[block], high[block]) for block in blocks]
        values, slopes, hopeless = zip(*found, strict=True)
        return joined(values), joined(slopes), np.concatenate(hopeless)

    def _block(self, rows: NDArray[np.intp], low: Array, high: Array) -> tuple[Intervals, Intervals, Mask]:
        middle = low if self.by_points else low + (high - low) / 2
        # The middles are asked for with the parts: what it takes is mostly the calling.
        both = np.concatenate([rows, rows])
        at = self._run(both, np.concatenate([low, middle]), np.concatenate([high, middle]))
        at[1] = at[1].where(at[2].low == 1)
        (value, there), (slope, course) = ((each[: len(rows)], each[len(rows) :]) for each in at[:2])
        with np.errstate(all="ignore"):
            mean = there + slope * (Intervals(low, high) - Intervals(middle, middle))
        return value.within(mean), slope, (there.sign == 0) & (course.sign == 0) & self.moving

    def _run(self, rows: NDArray[np.intp], low: Array, high: Array) -> list[Intervals]:
        """What the kernel gives for intervals of the unknown, a row each."""
        draws, batch = math.prod(self.shape[:-1]), rows // self.shape[-1]
        if self.by_points:
            ends = np.tile(batch, 2) + 1j * np.concatenate([low, high])
            points, places = np.unique(ends, return_inverse=True)
            batch = points.real.astype(np.intp)

        def of_rows(end: Array) -> Array:
            if end.size == 1:
                return end.reshape(1, 1)
            return np.broadcast_to(end, self.shape).reshape(-1)[rows][:, None]

        def of_terms(end: Any) -> Any:
            every = np.broadcast_to(end, (*self.shape[:-1], end.shape[-1])).reshape(draws, end.shape[-1])
            return every if draws == 1 else every[batch]

        def taken(name: str) -> Any:
            found = self.cells.get(name)
            if found is None:  # the unknown
                return points.imag[:, None] if self.by_points else Intervals(low[:, None], high[:, None])
            take = of_terms if name in self.terms_of else of_rows
            first = take(found.low)
            if self.by_points:
                return first
            return Intervals(first, first if found.low is found.high else take(found.high))

        given = [taken(name) for name in self.kernel.arguments]
        masks = [of_terms(self.kept[axis]) for axis in self.kernel.totals]
        sums: Any = [
            KeptBetween(mask, *np.split(places, 2)) if self.by_points else KeptIntervals(mask)
            for mask in masks
        ]
        parts: Any
        try:
            with np.errstate(all="ignore"):
                parts = self.kernel.run(*given, *sums)
        except TypeError:  # intervals do not know some function
            parts = (whole((1,)), whole((1,)), np.zeros(1))
        return [Intervals.of(part).broadcast((len(rows), 1))[:, 0] for part in parts]
