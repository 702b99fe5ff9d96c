"""Steps to the root of every row: unwatched where they lead to it, else in a bracket, else by bisection."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .kernels import Array, Function
from .numpy_rows import Kept

__all__ = ["RootRows", "Stretch"]

Mask = NDArray[np.bool_]

NOISE = 16 * float(np.finfo(float).eps)
"""Where the equation is smaller than this share of its terms, rounding hides the rest: the row is settled."""
NEAR = (2.0**-17, 2.0**-30)
"""How small a step is, of fourth order and of Newton's, that leaves less than rounding does."""
UNWATCHED = 2
"""How many of Newton's steps follow one of fourth order before it is asked where they led to."""


class PrintedRoot(Protocol):
    """What is printed of a root (:class:`~loopsheet.report.engines.numpy_root.RootProgram`)."""

    @property
    def steps(self) -> int: ...
    @property
    def at(self) -> Function: ...
    @property
    def newton(self) -> Function: ...
    @property
    def step(self) -> Function: ...
    @property
    def check(self) -> Function: ...


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

    program: PrintedRoot
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
