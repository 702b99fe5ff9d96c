"""The only root of an equation, for all rows at once, with NumPy.

How many roots there are is decided first: by the signs of the equation between its turning points where it
is certified to change sign once between them, else for each row by intervals. Then every row takes its steps:
unwatched where they lead to the root, else in a bracket, else by bisection.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
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

Mask = NDArray[np.bool_]


NOISE = 16 * float(np.finfo(float).eps)
"""Where the equation is smaller than this share of its terms, rounding hides the rest: the row is settled."""
NEAR = (2.0**-17, 2.0**-30)
"""How small a step is, of fourth order and of Newton's, that leaves less than rounding does."""
UNWATCHED = 2
"""How many of Newton's steps follow one of fourth order before it is asked where they led to."""


@dataclass(frozen=True)
class Stretch:
    """Part of the interval in which the equation changes sign at most once, for every row."""

    left: Array
    right: Array
    after: Array
    """The equation at the right end, or what has its sign."""
    crosses: Mask
    """Whether the sign at the left end is the other one."""

    @classmethod
    def between(
        cls, left: Array, right: Array, before: Array, after: Array, shape: tuple[int, ...]
    ) -> Stretch:
        """The stretch between two points, by what has the equation's sign there."""
        crosses = before * after < 0
        if not crosses.all():  # or the product is too small for a double
            crosses = ((before < 0) & (after > 0)) | ((before > 0) & (after < 0))
        return cls(left, right, after, np.broadcast_to(crosses, shape))

    def only(self, which: NDArray[np.intp]) -> Stretch:
        """That of fewer rows, by their positions in the flattened shape."""
        left, right, after = (
            np.broadcast_to(each, self.crosses.shape).reshape(-1)[which]
            for each in (self.left, self.right, self.after)
        )
        return Stretch(left, right, after, self.crosses.reshape(-1)[which])


@dataclass(frozen=True)
class RootRows:
    """The functions of a root with the constants of some rows."""

    program: RootProgram
    constants: Sequence[Array]
    totals: Sequence[Kept]
    shape: tuple[int, ...]

    def call(self, function: Function, at: Array) -> Array:
        """A function of the unknown."""
        found = function(at, *self.constants, *self.totals)[0]
        return np.broadcast_to(found, np.broadcast_shapes(found.shape, self.shape))

    def only(self, which: NDArray[np.intp]) -> RootRows:
        """Fewer rows, by their positions in the flattened shape."""
        if self.totals:
            return self  # the constants of a sum belong to its terms, and there is one row
        fewer = [
            c.reshape(()) if c.size == 1 else np.broadcast_to(c, self.shape).reshape(-1)[which]
            for c in self.constants
        ]
        return RootRows(self.program, fewer, self.totals, which.shape)

    def narrow(self, stretch: Stretch, start: Array, wanted: Mask) -> Array:
        """The unknown in its bracket, of the wanted rows."""
        here, settled = self._quickly(stretch, start)
        rest = wanted & ~settled
        if not rest.any():
            return here
        bracket = stretch.left, stretch.right, np.sign(stretch.after)
        return self._again(rest, here, RootRows._carefully, *bracket, start)

    def _again(self, some: Mask, here: Array, find: Callable[..., Array], *given: Array) -> Array:
        """What is found of some rows alone, beside what others have."""
        if self.totals:
            return np.where(some, find(self, *given), here)
        which, here = np.flatnonzero(some), here.copy()
        own = (np.broadcast_to(each, self.shape).reshape(-1)[which] for each in given)
        here.reshape(-1)[which] = find(self.only(which), *own)
        return here

    def _quickly(self, stretch: Stretch, start: Array) -> tuple[Array, Mask]:
        """Steps that nobody watches, and where they led to a root: near to it, and inside the bracket."""
        here, near = self.unwatched(start)
        inside = (here >= stretch.left) & (here <= stretch.right)
        return here, inside & near & self._settled(here)

    def unwatched(self, start: Array) -> tuple[Array, Mask]:
        """Steps that nobody watches, and where the last was so small that it left less than rounding does."""
        here, near, most = start, np.zeros(1, dtype=bool), self.program.steps
        # One step of fourth order, and Newton's polish what it leaves: cheaper than watching a bracket.
        if not self.totals:
            here, most = here - self.program.step(here, *self.constants)[1], min(most - 1, UNWATCHED)
        for _ in range(most):
            _, back = self.program.newton(here, *self.constants, *self.totals)
            # A row that is near enough stays where it is, whatever others need.
            here = np.where(near, here, here - back) if near.any() else here - back
            near = near | self._near(here, back, NEAR[1])
            if near.all():
                break
        return np.broadcast_to(here, self.shape), near

    def _near(self, here: Array, back: Array, enough: float) -> Mask:
        """Where a step was so small that the next one would be nothing."""
        return np.abs(back) <= enough * np.abs(here)

    def _settled(self, here: Array) -> Mask:
        """Where rounding leaves nothing of the equation."""
        left, terms = self.program.check(here, *self.constants, *self.totals)
        settled: Mask = np.abs(left) <= NOISE * terms
        return settled

    def _carefully(self, left: Array, right: Array, rising: Array, start: Array) -> Array:
        """Steps that stay inside the bracket, and bisection where they do not settle a row."""
        here = np.where((start > left) & (start < right), start, (left + right) / 2)
        done = np.zeros(here.shape, dtype=bool)
        for _ in range(self.program.steps):
            f, back = self.program.step(here, *self.constants, *self.totals)
            # The bracket moves on a sign only: what is no number moves neither end.
            side = f * rising
            left, right = np.where(side <= 0, here, left), np.where(side > 0, here, right)
            there, near = here - back, self._near(here, back, NEAR[bool(self.totals)])
            inside = (there >= left) & (there <= right)
            # A step out of the bracket is replaced by the middle of what is left of it; but beside the
            # root the bracket may be closed up already, and the step out of it by an ulp.
            there = np.where(inside, there, np.where(near, np.clip(there, left, right), (left + right) / 2))
            # A row that is near enough stays where it is, whatever others need.
            here = np.where(done, here, there)
            done = done | near
            if done.all():
                break
        rest = ~self._settled(here)
        return self._again(rest, here, RootRows._bisect, left, right, rising) if rest.any() else here

    def _bisect(self, left: Array, right: Array, rising: Array) -> Array:
        """Halve brackets until no double lies between their ends; NaN where the equation has no sign."""
        while True:
            # Not (left + right)/2, which may overflow.
            middle = left + (right - left) / 2
            inside = (middle > left) & (middle < right)
            if not inside.any():
                return right
            side = self.call(self.program.at, middle) * rising
            left = np.where(inside & (side <= 0), middle, left)
            right = np.where(inside & (side > 0), middle, np.where(inside & np.isnan(side), np.nan, right))


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
