"""What the cells of a sheet, and their derivatives, can be while the given cells move within intervals.

The sheet's program runs on intervals as it is. A root is enclosed by certain signs of its equation on both
sides of it: between turning points it changes sign at most once, which is certified or counted here, so that
with certain signs at the ends and no turning point inside there is one root, whatever the values inside the
intervals. Derivatives are the sheet's own, made by algebra (:mod:`~loopsheet.report.plan.derivatives`), and
added up along all ways.

A mean-value form then bounds the cells far better than the program alone:
f(X) lies in f(m) + f'(X) (X - m).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..cells.layout import Layout, height, rows_of
from ..engines.intervals import Intervals, joined, whole
from ..engines.numpy import Program
from ..engines.numpy_enclosed import EnclosedRows
from ..engines.numpy_root import RootProgram
from ..engines.numpy_rows import KeptIntervals, in_groups
from ..plan.order import places
from ..plan.slopes import NodeDerivatives, Slope
from ..sheet import Column, Reference, Sheet
from .chain import Chain, SheetDerivatives
from .sensitivity import ForwardSweep

HALVINGS = 60
SETTLED = 2.0**-50
"""What a step may move a point, relatively, that is near enough to a root."""
APART = 2.0**-26
"""How far apart two points are that a slope is taken from, of what lies beside them."""

Mask = NDArray[np.bool_]


class _Rows:
    """What printed functions ask of columns that are intervals.

    Parameters
    ----------
    layouts : mapping of axis name to Layout
    value, sure
        As for :class:`Enclosure`.
    """

    def __init__(
        self,
        sheet: Sheet,
        layouts: Mapping[str, Layout],
        value: dict[str, Intervals],
        sure: dict[str, Mask],
    ) -> None:
        self.sheet, self.layouts, self.value, self.sure = sheet, layouts, value, sure

    def rows(self, name: str, axis: str, index: str) -> Intervals:
        """The cells of a column that the rows of an axis name by an index."""
        return self.value[name].take(self.layouts[axis].rows[index])

    def ordinal(self, axis: str, index: str) -> Intervals:
        """A running number of the rows of an axis."""
        return Intervals.of(self.layouts[axis].ordinals[index])

    def size(self, axis: str) -> Intervals:
        """How many rows an axis has."""
        return Intervals.of(self.layouts[axis].size)

    def kept(self, name: str, axis: str) -> Any:
        """The rows of an axis over which the sums of a column run."""
        sure = np.ones(self.layouts[axis].size, dtype=bool)
        for reference in self.sheet.named(self.sheet[name]):
            if reference.over is not None and reference.over.name == axis:
                sure = sure & self.known(reference, self.sheet[name])
        return in_groups(
            KeptIntervals(np.ones(self.layouts[axis].size, dtype=bool), sure), self.layouts[axis]
        )

    def known(self, reference: Reference, column: Column) -> Mask:
        """Which of the cells that a column names are sure to have a value."""
        theirs = self.sure[reference.name]
        rows = rows_of(reference.index, reference.over or column.axis, self.layouts)
        return theirs if rows is None else theirs.take(rows, axis=-1)


class Enclosure(_Rows):
    """The cells of a sheet for given cells that lie in intervals.

    Parameters
    ----------
    program : Program
        The sheet's.
    layouts : mapping of axis name to Layout
    data : mapping of column name to Intervals (..., rows)
        The given columns in SI.

    Attributes
    ----------
    value : dict of column name to Intervals (..., rows)
        Where they have a value at all.
    sure : dict of column name to boolean array (..., rows)
        Whether they have a value for whatever given cells in the intervals.
    """

    def __init__(
        self, sheet: Sheet, program: Program, layouts: Mapping[str, Layout], data: Mapping[str, Intervals]
    ) -> None:
        super().__init__(sheet, layouts, {}, {})
        self.program, self.data = program, data
        with np.errstate(all="ignore"):
            program.function(self)

    # --- what the function calls

    def given(self, name: str, value: Intervals, allowed: Any = True) -> Intervals:
        """The data of a column: a value that may be another than is allowed is not sure."""
        sure = np.isfinite(value.low) & np.isfinite(value.high) & (Intervals.of(allowed).low == 1)
        if self.sheet.bounds[name].integer:
            sure &= value.low == value.high  # between two whole numbers are others
        return self._hold(self.sheet[name], value, sure)

    def formula(self, name: str, value: Any, *requires: Any) -> Intervals:
        """A column by its formula, and whether its conditions hold."""
        column, found = self.sheet[name], Intervals.of(value)
        sure = np.isfinite(found.low) & np.isfinite(found.high)
        if column.positive:
            found = Intervals(np.maximum(found.low, 0.0), found.high)
            sure = sure & (found.low > 0)
        return self._hold(column, found, sure, requires)

    def loop(self, name: str) -> None:
        """Columns that rest on one another: nothing is known of them."""
        program = self.program.loops[name]
        for each in (*program.iterated, *program.formulas):
            rows = height(self.sheet[each], self.layouts)
            self.value[each], self.sure[each] = whole((rows,)), np.zeros(rows, dtype=bool)

    def root(self, name: str, arguments: Sequence[Any], requires: Sequence[Any] = ()) -> Intervals:
        """A column by its root."""
        column, program = self.sheet[name], self.program.roots[name]
        cells = {}
        for (argument, axis), each in zip(program.arguments.items(), arguments, strict=True):
            over = axis if argument in program.terms_of else None
            own = Intervals.of(each)
            cells[argument] = own if over is None else self.kept(name, over).every(own)
        number = height(column, self.layouts)
        shape = np.broadcast_shapes((number,), *(own.shape for own in cells.values()))
        if len(shape) < 2 or program.terms_of:
            return self._hold(column, *self._root(program, column, cells, number), requires)
        # Boxes of a search differ in one cell, and most rows do not rest on it.
        cells = {argument: own.broadcast(shape) for argument, own in cells.items()}
        first, again = _distinct(list(cells.values()))
        cells = {argument: own[first] for argument, own in cells.items()}
        found, one = self._root(program, column, cells, first[0].size)
        return self._hold(column, found[again], one[again], requires)

    def _hold(self, column: Column, found: Intervals, sure: Mask, requires: Sequence[Any] = ()) -> Intervals:
        for held in requires:
            sure = sure & (Intervals.of(held).low == 1)
        for reference in self.sheet.named(column):
            theirs = self.known(reference, column)
            sure = sure & (theirs.all(axis=-1, keepdims=True) if reference.over else theirs)
        shape = np.broadcast_shapes(found.shape, sure.shape, (height(column, self.layouts),))
        self.value[column.name] = found.broadcast(shape)
        self.sure[column.name] = np.broadcast_to(sure, shape)
        return self.value[column.name]

    # --- roots ----------------------------------------------------------------------------------------

    def _root(
        self, program: RootProgram, column: Column, cells: Mapping[str, Intervals], number: int
    ) -> tuple[Intervals, Mask]:
        # Generated functions are typed for arrays; intervals are as good.
        run_fixed: Any = program.fixed.run
        run_at: Any = program.at
        run_value: Any = program.value
        fixed = [Intervals.of(each) for each in run_fixed(*(cells[each] for each in program.fixed.arguments))]
        totals = [self.kept(column.name, axis) for axis in program.totals]
        ends, rest = fixed[: 5 + program.turning], fixed[5 + program.turning :]
        # What a sum runs over are its terms: such a root is one, and not one a term.
        rows = [(*each.shape[:-1], 1) if totals else each.shape for each in rest]
        shape = np.broadcast_shapes(*(each.shape for each in ends), *rows, (number,))
        low, high, _, at_low, at_high, *turning = (each.broadcast(shape) for each in ends)

        def at(point: NDArray[np.float64]) -> Intervals:
            (value,) = run_at(Intervals(point, point), *rest, *totals)
            return Intervals.of(value).broadcast(np.broadcast_shapes(point.shape, shape))

        # Signs at the outermost ends: a root for any values inside lies between them.
        before = at_low.sign if program.told[0] else at(low.low).sign
        after = at_high.sign if program.told[1] else at(high.high).sign
        one = before * after < 0
        for turn in turning:
            # A turning point that may lie inside would allow for a second root.
            one &= (turn.high <= low.low) | (turn.low >= high.high)
        if program.enclosing is not None:
            one &= self._counted(program, cells, low, high, (at_low.sign, at_high.sign)) == 1
        if not one.any():
            return whole(shape), one
        left, right = self._bracket(at, low.low.copy(), high.high.copy(), after, one)
        (value,) = run_value(Intervals(left, right), *rest, *totals)
        found = Intervals.of(value).broadcast(shape)
        return found.where(one), one

    def _counted(
        self,
        program: RootProgram,
        cells: Mapping[str, Intervals],
        low: Intervals,
        high: Intervals,
        signs: Any,
    ) -> NDArray[np.intp]:
        """How many roots there are whatever the values inside the intervals; -1 where that is not certain."""
        assert program.enclosing is not None
        kept = {axis: np.ones(self.layouts[axis].size, dtype=bool) for axis in program.enclosing.totals}
        rows = EnclosedRows(program.enclosing, cells, program.terms_of, kept, low.shape, moving=True)
        ends = [end.reshape(-1) for end in (low.low, high.high, *signs)]
        found = rows.isolate(np.arange(ends[0].size), ends[0], ends[1], (ends[2], ends[3]))
        number = [-1 if row in found.undecided else len(own) for row, own in enumerate(found.brackets)]
        return np.array(number).reshape(low.shape)

    def _bracket(self, at: Any, low: Any, high: Any, after: Any, asked: Mask) -> tuple[Any, Any]:
        """The largest point that is certainly before the root, and the smallest certainly behind it."""
        centre, slope = _centre(lambda point: _middle(at(point)) * after, low, high, asked)
        here = at(centre)
        # As far from the centre as its enclosure is wide, the sign may be certain.
        near = np.maximum(np.abs(here.low), np.abs(here.high)) / np.abs(slope)
        ends = np.stack([low, high])
        share = np.nan_to_num(near / np.abs(ends - centre) / 2, nan=0.0, posinf=1.0)
        left, right = _certain(
            at, centre, ends, np.stack([-after, after]), np.clip(share, 2.0**-52, 2.0**-10), asked
        )
        return left, right

    # --- derivatives ----------------------------------------------------------------------------------

    def derivatives(
        self, made: SheetDerivatives, sources: Mapping[str, NDArray[np.intp]]
    ) -> dict[str, Intervals]:
        """Total derivatives of every column by given cells.

        Parameters
        ----------
        made : SheetDerivatives
            Of the sheet.
        sources : mapping of column name to integer array (rows,)
            For given columns, the number of each row among all that derivatives are taken by.

        Returns
        -------
        mapping of column name to Intervals (rows, sources)
        """
        chain = Chain(made, self.layouts, sources)
        spread = _Along(chain, self).go()
        return {name: spread.of(name) for name in self.value}


class _Slopes(_Rows):
    """What the function of a plan of derivatives calls.

    What it has besides slopes is of no use here, and a root that it would seek again is not known.
    """

    def __init__(self, cells: Enclosure, made: SheetDerivatives) -> None:
        super().__init__(made.program.sheet, cells.layouts, dict(cells.value), dict(cells.sure))
        self.parts: dict[str, Intervals] = {}
        with np.errstate(all="ignore"):
            made.program.function(self)

    def part(self, name: str, axis: str | None, value: Any) -> Intervals:
        """Numbers that are no column."""
        size = 1 if axis is None else self.layouts[axis].size
        found = Intervals.of(value)
        self.parts[name] = found.broadcast(np.broadcast_shapes(found.shape, (size,)))
        return self.parts[name]

    def root(self, name: str, _: Any, requires: Any = ()) -> Intervals:
        """The unknown of a root that its cell does not tell."""
        column = self.sheet[name]
        self.value[name] = whole((height(column, self.layouts),))
        self.sure[name] = np.zeros(height(column, self.layouts), dtype=bool)
        return self.value[name]


class _Along(ForwardSweep):
    """The derivatives while the given cells move within their intervals."""

    def __init__(self, chain: Chain, cells: Enclosure) -> None:
        super().__init__(chain, lambda shape: Intervals(np.zeros(shape), np.zeros(shape)))
        self.cells = _Slopes(cells, chain.made)

    def slope(self, node: NodeDerivatives, slope: Slope) -> Intervals:
        found, by = self.cells.parts[slope.value], slope.by
        if not node.by_order:
            return found
        rows = self.chain.named(node, slope)
        terms = self.cells.value[by].where(self.cells.sure[by]).take(rows)
        return joined([_shares(terms[own], node.word) for own in self.groups(node)]) * found  # type: ignore[no-any-return]

    def ended(self, node: NodeDerivatives) -> None:
        """What may have no value may have any derivative by what it rests on."""
        if node.over is not None or self.cells.sure[node.of].all():
            return
        cells = self.chain.patterns[node.name]
        own = self.entries[cells.entries]
        nothing = (own.low == 0) & (own.high == 0)
        self.entries[cells.entries] = own.where(self.cells.sure[node.of][cells.rows] | nothing)


def _shares(terms: Intervals, word: str) -> Intervals:
    """How much of the change of each row counts by its place: any part of one that may be there."""
    total = Intervals(np.zeros(terms.shape), np.zeros(terms.shape))
    taken = terms.in_order(places(word, terms.shape[-1]))
    for one in taken:
        may_be = (terms.low <= one.high) & (terms.high >= one.low)
        certain = may_be & (np.count_nonzero(may_be) == 1)
        total = total + Intervals(certain / len(taken), may_be / len(taken))
    return total


def _distinct(cells: Sequence[Intervals]) -> tuple[tuple[NDArray[np.intp], ...], NDArray[np.intp]]:
    """Where rows of a batch stand, without those that are as in its first element; which each is."""
    shape = cells[0].shape
    own = np.arange(np.prod(shape)).reshape(-1, shape[-1])
    ends = (end.reshape(own.shape) for each in cells for end in (each.low, each.high))
    moving = np.any([(end != end[0]).any(axis=0) for end in ends], axis=0)
    places, again = np.unique(np.where(moving, own, own[0]), return_inverse=True)
    return np.unravel_index(places, shape), again.reshape(shape)


def _middle(found: Intervals) -> Any:
    return (found.low + found.high) / 2


def _centre(value: Any, low: Any, high: Any, asked: Mask) -> tuple[Any, Any]:
    """Where an increasing function is about zero, and about its slope there; it proves nothing.

    Regula falsi, in which an end that stays counts for half (Illinois); where that leads nowhere, the middle.
    """
    left, right = low, high
    at_left, at_right = np.full_like(low, np.nan), np.full_like(low, np.nan)
    point, stayed = left + (right - left) / 2, np.zeros_like(low)
    for _ in range(HALVINGS):
        here = value(point)
        behind = here > 0
        at_left, at_right = (
            np.where(behind, np.where(stayed < 0, at_left / 2, at_left), here),
            np.where(behind, here, np.where(stayed > 0, at_right / 2, at_right)),
        )
        stayed = np.where(behind, -1.0, 1.0)
        left, right = np.where(behind, left, point), np.where(behind, point, right)
        before, middle = point, left + (right - left) / 2
        point = right - at_right * (right - left) / (at_right - at_left)
        point = np.where((point > left) & (point < right), point, middle)
        if (~asked | (np.abs(point - before) <= SETTLED * np.abs(point))).all():
            break
    ahead = point + APART * (np.where(high - point > point - low, high, low) - point)
    return point, (value(ahead) - value(point)) / (ahead - point)


def _certain(at: Any, centre: Any, ends: Any, sign: Any, share: Any, asked: Mask) -> Any:
    """The nearest points between the centre and each end where the equation certainly has a sign."""
    # The distance is doubled until the sign is certain, then halved back.
    near, far = np.zeros_like(share), np.ones_like(share)
    found = np.zeros(share.shape, dtype=bool)

    def certain(share: Any) -> Any:
        return at(centre + share * (ends - centre)).sign == sign

    for _ in range(53):
        held = certain(share)
        far = np.where(held & ~found, share, far)
        near = np.where(held | found, near, share)
        found |= held
        if (~asked | found | (share >= 1)).all():
            break
        share = np.minimum(2 * share, 1.0)
    for _ in range(6):
        middle = (near + far) / 2
        held = certain(middle)
        near, far = np.where(held, near, middle), np.where(held, middle, far)
    # Where it is never certain, the end itself bounds the root.
    return np.where(found, centre + far * (ends - centre), ends)
