"""The only root of an equation, for all rows at once, with NumPy.

How many roots there are is decided first: by the signs of the equation between its turning points where it
is certified to change sign once between them, else for each row by intervals. Then every row takes its steps
(:mod:`~loopsheet.report.engines.numpy_steps`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..cells.values import Status
from .intervals import Intervals
from .kernels import SAME, Array, Enclosing, Function, Kernel, compiled
from .numpy_enclosed import EnclosedRows
from .numpy_rows import Kept, chosen
from .numpy_steps import RootRows, Stretch

__all__ = ["FoundRoots", "RootProgram"]

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class FoundRoots:
    """The unknown of every row and how many there are."""

    value: Array
    """The cell's value; NaN where there is not one root."""
    status: NDArray[np.uint8]
    """OK, NOROOT, TWOROOTS, UNDECIDED; DOMAIN where the equation has no sign."""
    several: Mapping[int, tuple[float, ...]]
    """By position; for ambiguous rows, the values of all roots, increasing; for undecided ones, the ends of
    the part of the unknown's interval where it was not decided."""
    unknown: Array
    """Where the equation vanishes; anything where there is not one root."""


_BODIES = ("at", "newton", "step", "check", "value")
"""The functions of a root's unknown."""


@dataclass(frozen=True)
class RootProgram:
    """Everything a root needs, printed."""

    arguments: Mapping[str, str | None]
    """By name; what :meth:`solve` is called with: cells, totals and sizes that the root names, in order, each
    with the axis whose rows it has."""
    terms_of: frozenset[str]
    """Those of them whose rows are the terms of its sums."""
    told: tuple[bool, bool]
    """Whether the rule gives the sign at the lower end, and at the upper one."""
    turning: int
    """How many turning points it has."""
    steps: int
    """How many steps a row takes at most before it is bisected."""
    fixed: Kernel
    """What does not change with the unknown: low, high, start, the sign at each end (a number only where the
    rule gives it), the turning points, then the constants of the functions below."""
    constants: Kernel
    """Of these, the constants alone."""
    totals: tuple[str, ...]
    """The axes that these sum over; they are called with the unknown, the constants and the totals."""
    at: Function
    """The equation."""
    newton: Function
    step: Function
    """`newton` and `step`: the equation, and what is subtracted from the unknown: by Newton, and of fourth
    order where no derivative is a sum."""
    check: Function
    """The equation, and the same with nothing cancelling."""
    value: Function
    """The cell's value."""
    enclosing: Enclosing | None = None
    """What intervals are put into (:func:`~loopsheet.report.engines.certified.enclosing`), where the number
    of roots is not certified for all inputs at once."""
    counted: bool = True
    """Whether :meth:`solve` counts the roots by these intervals before it takes one. It takes long, and a
    search that proves nothing does without until it has found something."""

    @classmethod
    def of(cls, texts: Mapping[str, Any], functions: Any = SAME) -> RootProgram:
        """The functions of the texts that :func:`~loopsheet.report.engines.numpy_texts.root_texts` prints."""
        low, high = texts["told"]
        at, newton, step, check, value = (compiled(texts[name], functions) for name in _BODIES)
        return cls(
            texts["arguments"], frozenset(texts["terms_of"]), (low, high), texts["turning"], texts["steps"],
            Kernel.of_plain(texts["fixed"], functions), Kernel.of_plain(texts["constants"], functions),
            tuple(texts["totals"]), at, newton, step, check, value,
            None if texts["enclosing"] is None else Enclosing.of_plain(texts["enclosing"]),
        )  # fmt: skip

    # --- numbers --------------------------------------------------------------------------------------

    def solve(
        self, arguments: Mapping[str, Array], totals: Mapping[str, Kept], shape: tuple[int, ...]
    ) -> FoundRoots:
        """Find the root of every row.

        Parameters
        ----------
        arguments : mapping of name to float array
            :attr:`arguments`.
        totals : mapping of axis name to Kept
            What takes sums over its rows: of the axes of :attr:`totals`.
        shape : tuple of int
            Of the rows, batch first.
        """
        out = self.fixed.run(*(arguments[name] for name in self.fixed.arguments))
        fixed = [np.atleast_1d(np.asarray(each, dtype=np.float64)) for each in out]
        ends, constants = fixed[: 5 + self.turning], fixed[5 + self.turning :]
        rows = RootRows(self, constants, [totals[axis] for axis in self.totals], shape)
        counted_by = self.enclosing if self.counted else None
        stretches, odd = self._stretches(ends, rows)
        doubts: Mapping[int, tuple[float, float]] = {}
        if counted_by is not None:
            thin = {name: Intervals(cell, cell) for name, cell in arguments.items()}
            masks = {axis: totals[axis].mask for axis in counted_by.totals}
            cells = EnclosedRows(counted_by, thin, self.terms_of, masks, shape)
            stretches, doubts = self._isolated(ends, cells, odd)
        if len(stretches) == 1 and not doubts and stretches[0].crosses.all():
            found = rows.narrow(stretches[0], ends[_START], stretches[0].crosses)
            value = rows.call(self.value, found)
            return FoundRoots(value, np.zeros(shape, dtype=np.uint8), {}, found)
        doubtful = np.zeros(odd.size, dtype=bool)
        doubtful[list(doubts)] = True
        # One sign change a stretch at most: the stretches that cross are the roots.
        number = sum((stretch.crosses.astype(np.uint8) for stretch in stretches), np.zeros(shape, np.uint8))
        status = chosen(
            [odd, doubtful.reshape(shape), number == 1, number > 1],
            [Status.DOMAIN, Status.UNDECIDED, Status.OK, Status.TWOROOTS],
            Status.NOROOT,
        )
        crossings, alone = [stretch.crosses for stretch in stretches], status == Status.OK
        left, right, after = (
            chosen(crossings, [getattr(stretch, part) for stretch in stretches], np.nan)
            for part in ("left", "right", "after")
        )
        # Rows have their only root in different stretches; one stretch for all keeps the steps vectorised.
        only = Stretch(left, right, after, alone)
        found = rows.narrow(only, ends[_START], alone)
        value = np.where(alone, rows.call(self.value, found), np.nan)
        several: dict[int, tuple[float, ...]] = {}
        if len(shape) == 1:
            several |= self._several(stretches, rows, ends[_START], status == Status.TWOROOTS)
            several |= {row: doubts[row] for row in np.flatnonzero(status == Status.UNDECIDED).tolist()}
        return FoundRoots(value, status.astype(np.uint8), several, found)

    def _stretches(self, ends: Sequence[Array], rows: RootRows) -> tuple[list[Stretch], Mask]:
        """The stretches between turning points, and where the equation has no sign at one of their ends."""
        low, high, _, at_low, at_high, *turning = ends
        if not all(self.told):
            both = rows.call(self.at, np.stack([np.broadcast_to(end, rows.shape) for end in (low, high)]))
            at_low = at_low if self.told[0] else both[0]
            at_high = at_high if self.told[1] else both[1]
        places, values = [low], [at_low]
        for point in turning:
            # A turning point outside the interval, or not a number, closes an empty stretch at its left end.
            inside = point > places[-1]
            if inside.any() and (inside := inside & (point < high)).any():
                here = np.where(inside, point, places[-1])
                values.append(np.where(inside, rows.call(self.at, here), values[-1]))
                places.append(here)
        places.append(high)
        values.append(at_high)
        pairs = zip(pairwise(places), pairwise(values), strict=True)
        stretches = [Stretch.between(*place, *value, rows.shape) for place, value in pairs]
        odd = np.zeros(rows.shape, dtype=bool)
        if len(stretches) > 1 or not stretches[0].crosses.all():
            for value in values:
                odd |= np.isnan(value)
        return stretches, odd

    def _isolated(
        self, ends: Sequence[Array], cells: EnclosedRows, odd: Mask
    ) -> tuple[list[Stretch], Mapping[int, tuple[float, float]]]:
        """A stretch for the first root of each row, one for the second, ...; and what was not decided."""
        asked = np.flatnonzero(~odd)
        low, high, _, *told = (np.broadcast_to(end, odd.shape).reshape(-1)[asked] for end in ends)
        signs = [np.sign(at) for at in told]  # 0 where the rule gives none
        found = cells.isolate(asked, low, high, (signs[0], signs[1]))
        stretches = []
        for n in range(max([1, *map(len, found.brackets)])):
            each = np.full((3, odd.size), np.nan)
            for row, own in zip(asked, found.brackets, strict=True):
                each[:, row] = own[n] if len(own) > n else np.nan
            left, right, after = each.reshape(3, *odd.shape)
            stretches.append(Stretch(left, right, after, ~np.isnan(after)))
        return stretches, {int(asked[row]): part for row, part in found.undecided.items()}

    def _several(
        self, stretches: Sequence[Stretch], rows: RootRows, start: Array, ambiguous: Mask
    ) -> dict[int, tuple[float, ...]]:
        """All roots of the ambiguous rows, so that a message can name them."""
        found: dict[int, list[float]] = {row: [] for row in np.flatnonzero(ambiguous).tolist()}
        for stretch in stretches:
            which = np.flatnonzero(stretch.crosses & ambiguous)
            if which.size:
                own, part = rows.only(which), stretch.only(which)
                root = own.narrow(part, np.broadcast_to(start, rows.shape)[which], part.crosses)
                for row, value in zip(which.tolist(), own.call(self.value, root).tolist(), strict=True):
                    found[row].append(value)
        return {row: tuple(sorted(roots)) for row, roots in found.items()}


_START = 2
"""Where the first guess stands among what :attr:`RootProgram.fixed` returns."""
