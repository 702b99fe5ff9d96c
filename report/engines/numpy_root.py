"""The only root of an equation, for all rows at once, with NumPy.

How many roots there are is decided first, by the signs of the equation between its turning points. Then
every row takes the same number of fourth-order steps inside its bracket. A row that they leave anywhere but
where rounding leaves nothing of the equation is bisected until no double is left between the ends.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from sympy import Expr, Integer, Symbol

from ..sheet import Axis, Root
from ..values import Status
from .numpy_code import Array, Function, Kernel, Writer, totals_in, write
from .numpy_rows import Kept
from .roots import hoist, magnitude, step

__all__ = ["RootProgram", "Solved"]

Mask = NDArray[np.bool_]

NOISE = 16 * float(np.finfo(float).eps)
"""Where the equation is smaller than this share of its terms, rounding hides the rest: the row is settled."""


@dataclass(frozen=True)
class Solved:
    """The unknown of every row and how many there are.

    Parameters
    ----------
    value : float array
        The cell's value; NaN where there is not one root.
    status : integer array
        OK, NOROOT, TWOROOTS; DOMAIN where the equation has no sign.
    several : mapping of position to tuple of float
        For ambiguous rows, the values of all roots, increasing.
    bisected : int
        How many rows the steps did not settle.
    """

    value: Array
    status: NDArray[np.uint8]
    several: Mapping[int, tuple[float, ...]]
    bisected: int


@dataclass(frozen=True)
class RootProgram:
    """Everything a root needs, printed.

    Parameters
    ----------
    rule : Root
    fixed : Kernel
        What does not change with the unknown: low, high, start, the sign at each end (a number only where
        the rule gives it), the turning points, then the constants of the functions below.
    totals : tuple of str
        The axes that these sum over; they are called with the unknown, the constants and the totals.
    at : callable
        The equation.
    step : callable
        The equation, and what is subtracted from the unknown.
    terms : callable
        The equation with nothing cancelling.
    value : callable
        The cell's value.
    source : str
        The text of all of them.
    """

    rule: Root
    fixed: Kernel
    totals: tuple[str, ...]
    at: Function
    step: Function
    terms: Function
    value: Function
    source: str

    @classmethod
    def of(cls, rule: Root, sums: Mapping[Symbol, Axis]) -> RootProgram:
        """Print the functions of one root."""
        writer = Writer(sums)
        f, value = writer.plain(rule.expression), writer.plain(rule.value)
        unknown = writer.plain(rule.unknown)
        constants: dict[Expr, Symbol] = {}
        f, value = hoist(f, unknown, constants), hoist(value, unknown, constants)
        ends = [
            Integer(0) if end is None else writer.plain(end)  # no sign is given: the equation is evaluated
            for end in (rule.low, rule.high, rule.start, rule.sign_low, rule.sign_high, *rule.turning)
        ]
        # Cells that need no computation are constants too.
        named = f.free_symbols | value.free_symbols
        cells = sorted(named.intersection(writer.symbols.values()) - {unknown}, key=str)
        fixed = writer.kernel([*ends, *constants, *cells])
        arguments = [unknown, *constants.values(), *cells]
        totals = totals_in([f, value])
        bodies = {"at": [f], "step": [f, step(f, unknown)], "terms": [magnitude(f)], "value": [value]}
        printed = {name: write(arguments, totals, body) for name, body in bodies.items()}
        source = "\n".join(
            [f"# fixed\n{fixed.source}", *(f"# {n}\n{text}" for n, (text, _) in printed.items())]
        )
        at, go, terms, of_unknown = (function for _, function in printed.values())
        return cls(rule, fixed, totals, at, go, terms, of_unknown, source)

    # --- numbers --------------------------------------------------------------------------------------

    def solve(self, arguments: Sequence[Array], totals: Mapping[str, Kept], shape: tuple[int, ...]) -> Solved:
        """Find the root of every row.

        Parameters
        ----------
        arguments : sequence of float array
            What :attr:`fixed` is called with.
        totals : mapping of axis name to Kept
            What takes sums and medians over its rows.
        shape : tuple of int
            Of the rows, batch first.
        """
        out = self.fixed.run(*arguments, *(totals[axis] for axis in self.fixed.totals))
        fixed = [np.atleast_1d(np.asarray(each, dtype=np.float64)) for each in out]
        ends = [np.broadcast_to(end, shape) for end in fixed[: 5 + len(self.rule.turning)]]
        rows = _Rows(self, fixed[len(ends) :], [totals[axis] for axis in self.totals])
        stretches, odd = self._stretches(ends, rows)
        number = sum(stretch.crosses.astype(np.uint8) for stretch in stretches)
        status = np.select(
            [odd, number == 1, number > 1], [Status.DOMAIN, Status.OK, Status.TWOROOTS], Status.NOROOT
        )
        crossings, alone = [stretch.crosses for stretch in stretches], status == Status.OK
        left = np.select(crossings, [stretch.left for stretch in stretches], np.nan)
        right = np.select(crossings, [stretch.right for stretch in stretches], np.nan)
        rising = np.select(crossings, [stretch.rising for stretch in stretches], np.nan)
        found, bisected = rows.narrow(left, right, rising, ends[_START], alone)
        value = np.where(alone, rows.call(self.value, found), np.nan)
        several = {}
        if not self.totals and len(shape) == 1:
            several = self._several(stretches, rows, ends[_START], status == Status.TWOROOTS)
        return Solved(value, status.astype(np.uint8), several, bisected)

    def _stretches(self, ends: Sequence[Array], rows: _Rows) -> tuple[list[_Stretch], Mask]:
        """The stretches between turning points, and where the equation has no sign at one of their ends."""
        low, high, _, at_low, at_high, *turning = ends
        places = [low]
        signs = [np.sign(at_low if self.rule.sign_low is not None else rows.call(self.at, low))]
        for point in turning:
            # A turning point outside the interval, or not a number, closes an empty stretch at its left end.
            inside = (point > places[-1]) & (point < high)
            here = np.where(inside, point, places[-1])
            signs.append(np.where(inside, np.sign(rows.call(self.at, here)), signs[-1]))
            places.append(here)
        places.append(high)
        signs.append(np.sign(at_high if self.rule.sign_high is not None else rows.call(self.at, high)))
        stretches = [
            _Stretch(left, right, after, before * after < 0)
            for (left, right), (before, after) in zip(pairwise(places), pairwise(signs), strict=True)
        ]
        return stretches, np.isnan(sum(signs))

    def _several(
        self, stretches: Sequence[_Stretch], rows: _Rows, start: Array, ambiguous: Mask
    ) -> dict[int, tuple[float, ...]]:
        """All roots of the ambiguous rows, so that a message can name them."""
        found: dict[int, list[float]] = {row: [] for row in np.flatnonzero(ambiguous).tolist()}
        for stretch in stretches:
            which = np.flatnonzero(stretch.crosses & ambiguous)
            if which.size:
                own, every = rows.only(which, ambiguous.shape), np.ones(which.size, dtype=bool)
                ends = stretch.left[which], stretch.right[which], stretch.rising[which]
                root, _ = own.narrow(*ends, start[which], every)
                for row, value in zip(which.tolist(), own.call(self.value, root).tolist(), strict=True):
                    found[row].append(value)
        return {row: tuple(sorted(roots)) for row, roots in found.items()}


_START = 2
"""Where the first guess stands among what :attr:`RootProgram.fixed` returns."""


@dataclass(frozen=True)
class _Stretch:
    """Part of the interval in which the equation changes sign at most once, for every row."""

    left: Array
    right: Array
    rising: Array
    """The sign at the right end."""
    crosses: Mask
    """Whether the sign at the left end is the other one."""


@dataclass(frozen=True)
class _Rows:
    """The functions of a root with the constants of some rows."""

    program: RootProgram
    constants: Sequence[Array]
    totals: Sequence[Kept]

    def call(self, function: Function, at: Array) -> Array:
        """A function of the unknown."""
        return np.broadcast_to(function(at, *self.constants, *self.totals)[0], at.shape)

    def only(self, which: NDArray[np.intp], shape: tuple[int, ...]) -> _Rows:
        """Fewer rows, by their positions in the flattened shape."""
        fewer = [
            c.reshape(()) if c.size == 1 else np.broadcast_to(c, shape).reshape(-1)[which]
            for c in self.constants
        ]
        return _Rows(self.program, fewer, self.totals)

    def narrow(
        self, left: Array, right: Array, rising: Array, start: Array, wanted: Mask
    ) -> tuple[Array, int]:
        """The unknown in its bracket, and how many of the wanted rows had to be bisected."""
        here = np.where((start > left) & (start < right), start, (left + right) / 2)
        f = before = there = here
        for _ in range(self.program.rule.steps):
            f, back = self.program.step(here, *self.constants, *self.totals)
            # The bracket moves on a sign only: what is no number moves neither end.
            side = f * rising
            left, right = np.where(side <= 0, here, left), np.where(side > 0, here, right)
            there, before = here - back, here
            # A step out of the bracket is replaced by the middle of what is left of it.
            inside = (there >= left) & (there <= right)
            here = there if inside.all() else np.where(inside, there, (left + right) / 2)
        settled = np.abs(f) <= NOISE * self.call(self.program.terms, before)
        # Within the noise the bracket may be closed up already, and the last step out of it by an ulp.
        here = np.where(settled, np.where(np.isfinite(there), np.clip(there, left, right), before), here)
        rest = wanted & ~settled
        count = int(np.count_nonzero(rest))
        if count and self.totals:
            here = np.where(rest, self._bisect(left, right, rising), here)
        elif count:
            which = np.flatnonzero(rest)
            own = [np.broadcast_to(each, rest.shape).reshape(-1)[which] for each in (left, right, rising)]
            here.reshape(-1)[which] = self.only(which, rest.shape)._bisect(*own)
        return here, count

    def _bisect(self, left: Array, right: Array, rising: Array) -> Array:
        """Halve brackets until no double lies between their ends; NaN where the equation has no sign."""
        while True:
            middle = left + (right - left) / 2
            inside = (middle > left) & (middle < right)
            if not inside.any():
                return right
            side = self.call(self.program.at, middle) * rising
            left = np.where(inside & (side <= 0), middle, left)
            right = np.where(inside & (side > 0), middle, np.where(inside & np.isnan(side), np.nan, right))
