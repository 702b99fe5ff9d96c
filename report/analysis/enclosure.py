"""What the cells of a sheet, and their derivatives, can be while the given cells move within intervals.

The sheet's program runs on intervals as it is. A root is enclosed by certain signs of its equation on both
sides of it: between turning points it changes sign at most once, which is certified or counted here, so that
with certain signs at the ends and no turning point inside there is one root, whatever the values inside the
intervals. Derivatives
are the sheet's own, made by algebra (:mod:`~loopsheet.report.conditions`), and added up along all ways.

A mean-value form then bounds the cells far better than the program alone:
f(X) lies in f(m) + f'(X) (X - m).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sympy import Indexed

from ..conditions import Conditions, Node, Slope
from ..engines.numpy import Kernel, Program, kernel
from ..engines.numpy_root import EnclosedRows, RootProgram
from ..engines.numpy_rows import KeptIntervals
from ..intervals import Intervals, whole
from ..layout import Layout, rows_of
from ..sheet import Column, Formula, Given, Reference, Root, Sheet, name_of

__all__ = ["Enclosure"]

HALVINGS = 60
SETTLED = 2.0**-50
"""What a step may move a point, relatively, that is near enough to a root."""
APART = 2.0**-26
"""How far apart two points are that a slope is taken from, of what lies beside them."""


class Enclosure:
    """The cells of a sheet for given cells that lie in intervals.

    Parameters
    ----------
    sheet : Sheet
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
        self.sheet, self.layouts = sheet, layouts
        self.value: dict[str, Intervals] = {}
        self.sure: dict[str, NDArray[np.bool_]] = {}
        with np.errstate(all="ignore"):
            for column in sheet.order:
                size = self.size(column)
                if isinstance(column.rule, Given):
                    found = data[column.name]
                    sure = self._allowed(program, column, found)
                elif isinstance(column.rule, Root):
                    found, sure = self._root(program.roots[column.name], column)
                else:
                    found, sure = self._formula(program.formulas[column.name], column)
                for held in self._called(program.conditions.get(column.name), column):
                    sure = sure & (held.low == 1)
                for reference in sheet.named(column):
                    theirs = self.sure[name_of(reference.cell)]
                    rows = rows_of(reference.cell, reference.over or column.axis, layouts)
                    theirs = theirs if rows is None else theirs.take(rows, axis=-1)
                    sure = sure & (theirs.all(axis=-1, keepdims=True) if reference.over else theirs)
                shape = np.broadcast_shapes(found.shape, sure.shape, (size,))
                self.value[column.name] = found.broadcast(shape)
                self.sure[column.name] = np.broadcast_to(sure, shape)

    def size(self, column: Column) -> int:
        """How many rows a column has."""
        return 1 if column.axis is None else self.layouts[column.axis.name].size

    def _allowed(self, program: Program, column: Column, found: Intervals) -> NDArray[np.bool_]:
        """Whether a given column may be whatever lies in the intervals."""
        sure = np.isfinite(found.low) & np.isfinite(found.high)
        if column.name in program.guards:
            low, high = (program.guards[column.name](end)[0] for end in (found.low, found.high))
            sure &= np.logical_and(low, high)
        if self.sheet.bounds[column.name].integer:
            sure &= found.low == found.high  # between two whole numbers are others
        return sure

    # --- what a kernel is called with ----------------------------------------------------------------

    def _called(self, kernel: Kernel | None, column: Column) -> list[Intervals]:
        if kernel is None:
            return []
        return self.call(kernel, column, self.value)

    def call(self, kernel: Kernel, column: Column, value: Mapping[str, Intervals]) -> list[Intervals]:
        """What a printed function gives for all rows of a column."""
        arguments = [self._argument(reference, column, value) for reference in kernel.references]
        results = kernel.run(*arguments, *(self._rows(axis) for axis in kernel.totals))
        return [Intervals.of(result) for result in results]

    def _argument(self, reference: Reference, column: Column, value: Mapping[str, Intervals]) -> Any:
        cell, axis = reference.cell, reference.over or column.axis
        if cell in self.sheet.sizes:
            return Intervals.of(self.layouts[self.sheet.sizes[cell].name].size)
        if axis is not None and cell in axis.ordinals:
            return Intervals.of(self.layouts[axis.name].ordinals[cell])
        rows = rows_of(cell, axis, self.layouts)
        found = value[name_of(cell)]
        if reference.over is not None:
            # A sum leaves out the rows without a value; of one that may have none, anything may be missing.
            # Of a median too: one that is missing moves it less than one that may lie at either end.
            found = found.where(self.sure[name_of(cell)])
        return found if rows is None else found.take(rows)

    def _rows(self, axis: str) -> KeptIntervals:
        return KeptIntervals(np.ones(self.layouts[axis].size, dtype=bool))

    # --- rules ----------------------------------------------------------------------------------------

    def _formula(self, kernel: Kernel, column: Column) -> tuple[Intervals, NDArray[np.bool_]]:
        (found,) = self._called(kernel, column)
        if column.positive:
            found = Intervals(np.maximum(found.low, 0.0), found.high)
        sure = (
            np.isfinite(found.low) & np.isfinite(found.high) & (~np.array(column.positive) | (found.low > 0))
        )
        return found, sure

    def _root(self, program: RootProgram, column: Column) -> tuple[Intervals, NDArray[np.bool_]]:
        fixed = self._called(program.fixed, column)
        rule, totals = program.rule, [self._rows(axis) for axis in program.totals]
        ends, rest = fixed[: 5 + len(rule.turning)], fixed[5 + len(rule.turning) :]
        # What a sum runs over are its terms: such a root is one, and not one a term.
        rows = [(*each.shape[:-1], 1) if totals else each.shape for each in rest]
        shape = np.broadcast_shapes(*(each.shape for each in ends), *rows, (self.size(column),))
        low, high, _, at_low, at_high, *turning = (each.broadcast(shape) for each in ends)

        # Generated functions are typed for arrays; intervals are as good.
        run_at: Any = program.at
        run_value: Any = program.value

        def at(point: NDArray[np.float64]) -> Intervals:
            (value,) = run_at(Intervals(point, point), *rest, *totals)
            return Intervals.of(value).broadcast(shape)

        before = at_low.sign if rule.sign_low is not None else at(low.low).sign
        after = at_high.sign if rule.sign_high is not None else at(high.high).sign
        one = before * after < 0
        for turn in turning:
            one &= (turn.high <= low.low) | (turn.low >= high.high)
        if program.enclosing is not None:
            one &= self._counted(program, column, low, high, (at_low.sign, at_high.sign)) == 1
        if not one.any():
            return whole(shape), one
        left, right = self._bracket(at, low.low.copy(), high.high.copy(), after)
        (value,) = run_value(Intervals(left, right), *rest, *totals)
        found = Intervals.of(value).broadcast(shape)
        return found.where(one), one

    def _counted(
        self, program: RootProgram, column: Column, low: Intervals, high: Intervals, signs: Any
    ) -> NDArray[np.intp]:
        """How many roots there are whatever the values inside the intervals; -1 where that is not certain."""
        assert program.enclosing is not None
        cells = {r: Intervals.of(self._argument(r, column, self.value)) for r in program.fixed.references}
        kept = {axis: np.ones(self.layouts[axis].size, dtype=bool) for axis in program.enclosing.totals}
        rows = EnclosedRows(program.enclosing, cells, kept, low.shape, moving=True)
        ends = [end.reshape(-1) for end in (low.low, high.high, *signs)]
        found = rows.isolate(np.arange(ends[0].size), ends[0], ends[1], (ends[2], ends[3]))
        number = [-1 if row in found.undecided else len(own) for row, own in enumerate(found.brackets)]
        return np.array(number).reshape(low.shape)

    def _bracket(self, at: Any, low: Any, high: Any, after: Any) -> tuple[Any, Any]:
        """The largest point that is certainly before the root, and the smallest certainly behind it."""
        centre, slope = _centre(lambda point: _middle(at(point)) * after, low, high)
        here = at(centre)
        # As far from the centre as its enclosure is wide, the sign may be certain.
        near = np.maximum(np.abs(here.low), np.abs(here.high)) / np.abs(slope)
        ends = np.stack([low, high])
        share = np.nan_to_num(near / np.abs(ends - centre) / 2, nan=0.0, posinf=1.0)
        left, right = _certain(
            at, centre, ends, np.stack([-after, after]), np.clip(share, 2.0**-52, 2.0**-10)
        )
        return left, right

    # --- derivatives ----------------------------------------------------------------------------------

    def derivatives(
        self, made: Conditions, kernels: Mapping[str, Kernel], sources: Mapping[str, NDArray[np.intp]]
    ) -> dict[str, Intervals]:
        """Total derivatives of every column by given cells.

        Parameters
        ----------
        made : Conditions
            Of the sheet.
        kernels : mapping of column name to Kernel
            Of the slopes among its columns.
        sources : mapping of column name to integer array (rows,)
            For given columns, the number of each row among all that derivatives are taken by.

        Returns
        -------
        mapping of column name to Intervals (rows, sources)
        """
        number = 1 + max((int(rows.max()) for rows in sources.values()), default=-1)
        value = dict(self.value)
        for name, (_, axis) in made.counts.items():
            value[name] = Intervals.of(np.array([float(self.layouts[axis.name].size)]))
        found: dict[str, Intervals] = {}
        with np.errstate(all="ignore"):
            for node in made.nodes:
                found[node.name] = self._spread(node, made, kernels, sources, value, found, number)
        return found

    def _spread(
        self,
        node: Node,
        made: Conditions,
        kernels: Mapping[str, Kernel],
        sources: Mapping[str, NDArray[np.intp]],
        value: Mapping[str, Intervals],
        found: Mapping[str, Intervals],
        number: int,
    ) -> Intervals:
        size = self.size(made.sheet[node.of]) if node.over is None else 1
        own = np.zeros((size, number))
        if node.name in sources:
            own[np.arange(size), sources[node.name]] = 1.0
        total = Intervals(own, own)
        for slope in node.slopes:
            column = made.sheet[slope.column]
            if slope.column in kernels:
                (values,) = self.call(kernels[slope.column], column, value)
            else:
                values = whole((1,))
            by = slope.by if isinstance(slope.by, str) else name_of(slope.by)
            theirs, rows = found[by], self._named(slope, node)
            theirs = theirs if rows is None else theirs[rows]
            length = self.size(column)
            product = values.broadcast((length,))[:, None] * theirs
            if node.middle:
                row_of = rows_of(slope.by, node.over, self.layouts)
                terms = self.value[by] if row_of is None else self.value[by].take(row_of)
                product = _shares(terms.where(self.sure[by])) * product
            if node.over is not None:
                product = product.broadcast((length, number)).total(axis=0)
            total = total + product
        if node.over is None and node.name in self.sure and not self.sure[node.name].all():
            total = total.where(self.sure[node.name][:, None] | ((total.low == 0) & (total.high == 0)))
        return total

    def _named(self, slope: Slope, node: Node) -> NDArray[np.intp] | None:
        if not isinstance(slope.by, Indexed):
            return None
        return rows_of(slope.by, node.over or node.axis, self.layouts)


def _shares(terms: Intervals) -> Intervals:
    """How much of the change of each row a median makes (rows, 1): any part of one that may be in the middle.

    Parameters
    ----------
    terms : Intervals (rows,)
    """
    total = Intervals(np.zeros(terms.shape), np.zeros(terms.shape))
    for middle in terms.middle():
        may_be = (terms.low <= middle.high) & (terms.high >= middle.low)
        certain = may_be & (np.count_nonzero(may_be) == 1)
        total = total + Intervals(np.where(certain, 0.5, 0.0), np.where(may_be, 0.5, 0.0))
    return total[:, None]


def _middle(found: Intervals) -> Any:
    return (found.low + found.high) / 2


def _centre(value: Any, low: Any, high: Any) -> tuple[Any, Any]:
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
        if (np.abs(point - before) <= SETTLED * np.abs(point)).all():
            break
    ahead = point + APART * (np.where(high - point > point - low, high, low) - point)
    return point, (value(ahead) - value(point)) / (ahead - point)


def _certain(at: Any, centre: Any, ends: Any, sign: Any, share: Any) -> Any:
    """The nearest points between the centre and each end where the equation certainly has a sign."""
    # The distance is doubled until the sign is certain, then halved back.
    near, far = np.zeros_like(share), np.ones_like(share)
    found = np.zeros(share.shape, dtype=bool)

    def certain(share: Any) -> Any:
        return np.stack([at(point).sign for point in centre + share * (ends - centre)]) == sign

    for _ in range(53):
        held = certain(share)
        far = np.where(held & ~found, share, far)
        near = np.where(held | found, near, share)
        found |= held
        if (found | (share >= 1)).all():
            break
        share = np.minimum(2 * share, 1.0)
    for _ in range(6):
        middle = (near + far) / 2
        held = certain(middle)
        near, far = np.where(held, near, middle), np.where(held, middle, far)
    # Where it is never certain, the end itself bounds the root.
    return np.where(found, centre + far * (ends - centre), ends)


def slope_kernels(made: Conditions) -> dict[str, Kernel]:
    """Functions of the slopes that can be computed from cells alone."""
    found: dict[str, Kernel] = {}
    given = {column.name for column in made.sheet.columns if isinstance(column.rule, Given)}
    for name in {slope.column for node in made.nodes for slope in node.slopes}:
        column = made.sheet[name]
        named = {precedent.name for precedent in made.sheet.precedents(column)}
        if isinstance(column.rule, Formula) and named <= given:
            found[name] = kernel([column.rule.expression], made.sheet.indices)
    return found
