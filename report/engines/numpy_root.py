"""The only root of an equation, for all rows at once, with NumPy.

How many roots there are is decided first: by the signs of the equation between its turning points where it
is certified to change sign once between them, else for each row by intervals. Then every row takes the same
number of fourth-order steps inside its bracket. A row that they leave anywhere but where rounding leaves
nothing of the equation is bisected until no double is left between the ends.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sympy import Expr, Integer, Symbol

from ..cells.values import Status
from ..plan import Plan, Root, RowSum, taken_over
from ..sheet import Sheet
from .certified import certified, enclosing
from .intervals import Intervals, whole
from .isolation import Isolated, isolate
from .numpy_code import SAME, Array, Function, Kernel, kernel, write
from .numpy_rows import Kept, KeptIntervals
from .roots import hoist, magnitude, step

__all__ = ["EnclosedRows", "RootProgram", "Solved", "terms_of"]

Mask = NDArray[np.bool_]

NOISE = 16 * float(np.finfo(float).eps)
"""Where the equation is smaller than this share of its terms, rounding hides the rest: the row is settled."""

NEAR = (2.0**-17, 2.0**-30)
"""How small a step is, of fourth order and of Newton's, that leaves less than rounding does."""


_UNWATCHED = 2
"""How many fourth-order steps are taken before it is asked where they led to."""


@dataclass(frozen=True)
class Solved:
    """The unknown of every row and how many there are.

    Parameters
    ----------
    value : float array
        The cell's value; NaN where there is not one root.
    status : integer array
        OK, NOROOT, TWOROOTS, UNDECIDED; DOMAIN where the equation has no sign.
    several : mapping of position to tuple of float
        For ambiguous rows, the values of all roots, increasing; for undecided ones, the ends of the part of
        the unknown's interval where it was not decided.
    bisected : int
        How many rows the steps did not settle.
    """

    value: Array
    status: NDArray[np.uint8]
    several: Mapping[int, tuple[float, ...]]
    bisected: int


def terms_of(node: Root) -> frozenset[str]:
    """The names of what stands in the sums of a root's equation: its rows are their terms."""
    return frozenset(symbol.name for total in node.form.atoms(RowSum) for symbol in total.free_symbols)


@dataclass(frozen=True)
class RootProgram:
    """Everything a root needs, printed.

    Parameters
    ----------
    node : Root
        Of the plan.
    arguments : tuple of Symbol
        What :meth:`solve` is called with: cells, totals and sizes that the root names.
    terms_of : frozenset of str
        Those of them whose rows are the terms of its sums.
    fixed : Kernel
        What does not change with the unknown: low, high, start, the sign at each end (a number only where
        the rule gives it), the turning points, then the constants of the functions below.
    totals : tuple of str
        The axes that these sum over; they are called with the unknown, the constants and the totals.
    at : callable
        The equation.
    step : callable
        The equation, and what is subtracted from the unknown.
    check : callable
        The equation, and the same with nothing cancelling.
    value : callable
        The cell's value.
    source : str
        The text of all of them.
    enclosing : Kernel or None
        What intervals are put into (:func:`~loopsheet.report.engines.certified.enclosing`), where the number
        of roots is not certified for all inputs at once.
    counted : bool
        Whether :meth:`solve` counts the roots by these intervals before it takes one. It takes long, and a
        search that proves nothing does without until it has found something.
    """

    node: Root
    arguments: tuple[Symbol, ...]
    terms_of: frozenset[str]
    fixed: Kernel
    totals: tuple[str, ...]
    at: Function
    step: Function
    check: Function
    value: Function
    source: str
    enclosing: Kernel | None = None
    counted: bool = True

    @classmethod
    def of(cls, sheet: Sheet, plan: Plan, node: Root, functions: Any = SAME) -> RootProgram:
        """Print the functions of one root."""
        enclosed = None if certified(sheet, node.column) else enclosing(sheet, plan, node)
        if enclosed is not None:
            node = replace(node, turning=())  # what nobody proved is not used
        unknown, constants = node.unknown, dict[Expr, Symbol]()
        f, value = (hoist(each, unknown, constants) for each in (node.form, node.value))
        ends = [
            Integer(0) if end is None else end  # no sign is given: the equation is evaluated
            for end in (node.low, node.high, node.start, node.sign_low, node.sign_high, *node.turning)
        ]
        # Cells that need no computation are constants too.
        axes = {Symbol(axis) for axis in taken_over([f, value])}
        cells = sorted((f.free_symbols | value.free_symbols) - {unknown, *constants.values(), *axes}, key=str)
        fixed = kernel([*ends, *constants, *cells], functions)
        arguments = [unknown, *constants.values(), *cells]
        totals = taken_over([f, value])
        parts, back = step(f, unknown)
        bodies = {"at": [f], "step": [f, back], "check": [f, magnitude(f)], "value": [value]}
        printed = {
            name: write(arguments, totals, body, functions, parts if name == "step" else {})
            for name, body in bodies.items()
        }
        source = "\n".join(
            [f"# fixed\n{fixed.source}", *(f"# {n}\n{text}" for n, (text, _) in printed.items())]
        )
        named = {symbol.name: symbol for symbol in plan.leaves}
        asked = {s.name for s in (*fixed.arguments, *(() if enclosed is None else enclosed.arguments))}
        every = tuple(named[name] for name in sorted(asked - {unknown.name}))
        at, go, check, of_unknown = (function for _, function in printed.values())
        return cls(node, every, terms_of(node), fixed, totals, at, go, check, of_unknown, source, enclosed)

    # --- numbers --------------------------------------------------------------------------------------

    def solve(
        self, arguments: Mapping[str, Array], totals: Mapping[str, Kept], shape: tuple[int, ...]
    ) -> Solved:
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
        out = self.fixed.run(*(arguments[a.name] for a in self.fixed.arguments))
        fixed = [np.atleast_1d(np.asarray(each, dtype=np.float64)) for each in out]
        ends, constants = fixed[: 5 + len(self.node.turning)], fixed[5 + len(self.node.turning) :]
        rows = _Rows(self, constants, [totals[axis] for axis in self.totals], shape)
        counted_by = self.enclosing if self.counted else None
        stretches, odd = self._stretches(ends, rows)
        if len(stretches) == 1 and counted_by is None and stretches[0].crosses.all():
            found, bisected = rows.narrow(stretches[0], ends[_START], stretches[0].crosses)
            return Solved(rows.call(self.value, found), np.zeros(shape, dtype=np.uint8), {}, bisected)
        doubts: Mapping[int, tuple[float, float]] = {}
        if counted_by is not None:
            thin = {name: Intervals(cell, cell) for name, cell in arguments.items()}
            masks = {axis: totals[axis].mask for axis in counted_by.totals}
            cells = EnclosedRows(counted_by, thin, self.terms_of, masks, shape)
            stretches, doubts = self._isolated(ends, cells, odd)
        doubtful = np.zeros(odd.size, dtype=bool)
        doubtful[list(doubts)] = True
        number = sum((stretch.crosses.astype(np.uint8) for stretch in stretches), np.zeros(shape, np.uint8))
        status = np.select(
            [odd, doubtful.reshape(shape), number == 1, number > 1],
            [Status.DOMAIN, Status.UNDECIDED, Status.OK, Status.TWOROOTS],
            Status.NOROOT,
        )
        crossings, alone = [stretch.crosses for stretch in stretches], status == Status.OK
        left, right, after = (
            np.select(crossings, [getattr(stretch, part) for stretch in stretches], np.nan)
            for part in ("left", "right", "after")
        )
        only = _Stretch(left, right, after, alone)
        found, bisected = rows.narrow(only, ends[_START], alone)
        value = np.where(alone, rows.call(self.value, found), np.nan)
        several: dict[int, tuple[float, ...]] = {}
        if len(shape) == 1:
            several |= self._several(stretches, rows, ends[_START], status == Status.TWOROOTS)
            several |= {row: doubts[row] for row in np.flatnonzero(status == Status.UNDECIDED).tolist()}
        return Solved(value, status.astype(np.uint8), several, bisected)

    def _stretches(self, ends: Sequence[Array], rows: _Rows) -> tuple[list[_Stretch], Mask]:
        """The stretches between turning points, and where the equation has no sign at one of their ends."""
        low, high, _, at_low, at_high, *turning = ends
        places = [low]
        values = [at_low if self.node.sign_low is not None else rows.call(self.at, low)]
        for point in turning:
            # A turning point outside the interval, or not a number, closes an empty stretch at its left end.
            inside = point > places[-1]
            if inside.any() and (inside := inside & (point < high)).any():
                here = np.where(inside, point, places[-1])
                values.append(np.where(inside, rows.call(self.at, here), values[-1]))
                places.append(here)
        places.append(high)
        values.append(at_high if self.node.sign_high is not None else rows.call(self.at, high))
        pairs = zip(pairwise(places), pairwise(values), strict=True)
        stretches = [_Stretch.between(*place, *value, rows.shape) for place, value in pairs]
        odd = np.zeros(rows.shape, dtype=bool)
        if not stretches[0].crosses.all():
            for value in values:
                odd |= np.isnan(value)
        return stretches, odd

    def _isolated(
        self, ends: Sequence[Array], cells: EnclosedRows, odd: Mask
    ) -> tuple[list[_Stretch], Mapping[int, tuple[float, float]]]:
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
            stretches.append(_Stretch(left, right, after, ~np.isnan(after)))
        return stretches, {int(asked[row]): part for row, part in found.undecided.items()}

    def _several(
        self, stretches: Sequence[_Stretch], rows: _Rows, start: Array, ambiguous: Mask
    ) -> dict[int, tuple[float, ...]]:
        """All roots of the ambiguous rows, so that a message can name them."""
        found: dict[int, list[float]] = {row: [] for row in np.flatnonzero(ambiguous).tolist()}
        for stretch in stretches:
            which = np.flatnonzero(stretch.crosses & ambiguous)
            if which.size:
                own, part = rows.only(which), stretch.only(which)
                root, _ = own.narrow(part, np.broadcast_to(start, rows.shape)[which], part.crosses)
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
    after: Array
    """The equation at the right end, or what has its sign."""
    crosses: Mask
    """Whether the sign at the left end is the other one."""

    @classmethod
    def between(
        cls, left: Array, right: Array, before: Array, after: Array, shape: tuple[int, ...]
    ) -> _Stretch:
        """The stretch between two points, by what has the equation's sign there."""
        crosses = before * after < 0
        if not crosses.all():  # or the product is too small for a double
            crosses = ((before < 0) & (after > 0)) | ((before > 0) & (after < 0))
        return cls(left, right, after, np.broadcast_to(crosses, shape))

    def only(self, which: NDArray[np.intp]) -> _Stretch:
        """That of fewer rows, by their positions in the flattened shape."""
        left, right, after = (
            np.broadcast_to(each, self.crosses.shape).reshape(-1)[which]
            for each in (self.left, self.right, self.after)
        )
        return _Stretch(left, right, after, self.crosses.reshape(-1)[which])


@dataclass(frozen=True)
class EnclosedRows:
    """The cells that a root names, for intervals of the unknown of some rows.

    Parameters
    ----------
    kernel : Kernel
        The root's, from :func:`~loopsheet.report.engines.certified.enclosing`.
    cells : mapping of name to Intervals
        Its arguments, but the unknown.
    terms_of : collection of str
        Those of them whose rows are the terms of sums.
    kept : mapping of axis name to boolean array (..., rows)
        For the axes that it sums over, the rows that have values.
    shape : tuple of int
        Of the root's rows, batch first.
    moving : bool
        Whether cells are intervals: halving the unknown's then settles nothing around a point where nothing
        is certain, and the row is given up.
    """

    kernel: Kernel
    cells: Mapping[str, Intervals]
    terms_of: Collection[str]
    kept: Mapping[str, Mask]
    shape: tuple[int, ...]
    moving: bool = False

    def isolate(
        self, asked: NDArray[np.intp], low: Array, high: Array, signs: tuple[Array, Array]
    ) -> Isolated:
        """The roots of some rows, numbered in the flattened shape."""
        return isolate(lambda rows, a, b: self.enclose(asked[rows], a, b), low, high, signs)

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
        return _joined(values), _joined(slopes), np.concatenate(hopeless)

    def _block(self, rows: NDArray[np.intp], low: Array, high: Array) -> tuple[Intervals, Intervals, Mask]:
        middle = low + (high - low) / 2
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
        batch = rows // self.shape[-1]

        def of_rows(end: Array) -> Array:
            if end.size == 1:
                return end.reshape(1, 1)
            return np.broadcast_to(end, self.shape).reshape(-1)[rows][:, None]

        def of_terms(end: Any) -> Any:
            if end.ndim == 1:
                return end
            return np.broadcast_to(end, (*self.shape[:-1], end.shape[-1])).reshape(-1, end.shape[-1])[batch]

        def taken(name: str) -> Intervals:
            found = self.cells.get(name)
            if found is None:
                return Intervals(low[:, None], high[:, None])  # the unknown
            take = of_terms if name in self.terms_of else of_rows
            first = take(found.low)
            return Intervals(first, first if found.low is found.high else take(found.high))

        given: Any = [taken(argument.name) for argument in self.kernel.arguments]
        sums: Any = [KeptIntervals(of_terms(self.kept[axis])) for axis in self.kernel.totals]
        parts: Any
        try:
            with np.errstate(all="ignore"):
                parts = self.kernel.run(*given, *sums)
        except TypeError:  # intervals do not know some function
            parts = (whole((1,)), whole((1,)), np.zeros(1))
        return [Intervals.of(part).broadcast((len(rows), 1))[:, 0] for part in parts]


_BLOCK = 1 << 18
"""How many terms are put into intervals at a time."""


def _joined(parts: Sequence[Intervals]) -> Intervals:
    return Intervals(*(np.concatenate([getattr(part, end) for part in parts]) for end in ("low", "high")))


@dataclass(frozen=True)
class _Rows:
    """The functions of a root with the constants of some rows."""

    program: RootProgram
    constants: Sequence[Array]
    totals: Sequence[Kept]
    shape: tuple[int, ...]

    def call(self, function: Function, at: Array) -> Array:
        """A function of the unknown."""
        return np.broadcast_to(function(at, *self.constants, *self.totals)[0], self.shape)

    def only(self, which: NDArray[np.intp]) -> _Rows:
        """Fewer rows, by their positions in the flattened shape."""
        if self.totals:
            return self  # the constants of a sum belong to its terms, and there is one row
        fewer = [
            c.reshape(()) if c.size == 1 else np.broadcast_to(c, self.shape).reshape(-1)[which]
            for c in self.constants
        ]
        return _Rows(self.program, fewer, self.totals, which.shape)

    def narrow(self, stretch: _Stretch, start: Array, wanted: Mask) -> tuple[Array, int]:
        """The unknown in its bracket, and how many of the wanted rows had to be bisected."""
        here, settled = self._quickly(stretch, start)
        if settled.all():
            return here, 0
        rest = wanted & ~settled
        if not rest.any():
            return here, 0
        start = np.broadcast_to(start, self.shape)
        if self.totals:
            careful, count = self._carefully(stretch.left, stretch.right, np.sign(stretch.after), start, rest)
            return np.where(rest, careful, here), count
        which = np.flatnonzero(rest)
        own, part = self.only(which), stretch.only(which)
        here = here.copy()
        here.reshape(-1)[which], count = own._carefully(
            part.left,
            part.right,
            np.sign(part.after),
            start.reshape(-1)[which],
            np.ones(which.size, dtype=bool),
        )
        return here, count

    def _quickly(self, stretch: _Stretch, start: Array) -> tuple[Array, Mask]:
        """Steps that nobody watches, and where they led to a root: near to it, and inside the bracket."""
        here, near, most = start, np.zeros(1, dtype=bool), self.program.node.steps
        if self.totals:
            for _ in range(most):
                _, back = self.program.step(here, *self.constants, *self.totals)
                # A row that is near enough stays where it is, whatever others need.
                here, near = np.where(near, here, here - back), near | self._near(here - back, back)
                if near.all():
                    break
        else:
            for _ in range(min(most, _UNWATCHED)):
                _, back = self.program.step(here, *self.constants)
                here = here - back
            near = self._near(here, back)
        here = np.broadcast_to(here, self.shape)
        inside = (here >= stretch.left) & (here <= stretch.right)
        return here, inside & near & self._settled(here)

    def _near(self, here: Array, back: Array) -> Mask:
        """Where a step was so small that the next one would be nothing."""
        return np.abs(back) <= NEAR[bool(self.totals)] * np.abs(here)

    def _settled(self, here: Array) -> Mask:
        """Where rounding leaves nothing of the equation."""
        left, terms = self.program.check(here, *self.constants, *self.totals)
        settled: Mask = np.abs(left) <= NOISE * terms
        return settled

    def _carefully(
        self, left: Array, right: Array, rising: Array, start: Array, wanted: Mask
    ) -> tuple[Array, int]:
        """Steps that stay inside the bracket, and bisection where they do not settle a row."""
        here = np.where((start > left) & (start < right), start, (left + right) / 2)
        done = ~wanted
        for _ in range(self.program.node.steps):
            f, back = self.program.step(here, *self.constants, *self.totals)
            # The bracket moves on a sign only: what is no number moves neither end.
            side = f * rising
            left, right = np.where(side <= 0, here, left), np.where(side > 0, here, right)
            there, near = here - back, self._near(here, back)
            inside = (there >= left) & (there <= right)
            # A step out of the bracket is replaced by the middle of what is left of it; but beside the
            # root the bracket may be closed up already, and the step out of it by an ulp.
            there = np.where(inside, there, np.where(near, np.clip(there, left, right), (left + right) / 2))
            # A row that is near enough stays where it is, whatever others need.
            here = np.where(done, here, there)
            done = done | near
            if done.all():
                break
        rest = wanted & ~self._settled(here)
        if rest.any():
            here = np.where(rest, self._bisect(left, right, rising), here)
        return here, int(np.count_nonzero(rest))

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
