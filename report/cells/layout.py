"""How many rows each index set has for given data, and which rows of other sets each of them names."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..sheet import Axis, Column, CountedAxis, GroupAxis, MemberAxis, PairAxis, RepeatAxis, Sheet


@dataclass(frozen=True)
class Layout:
    """The rows of one axis."""

    size: int
    """How many rows."""
    rows: Mapping[str, NDArray[np.intp]]
    """Of shape (size,); for each index that formulas may use, by what it is called, the row it names, from 0:
    its own, those that it is made of, the groups that it belongs to."""
    ordinals: Mapping[str, NDArray[np.float64]]
    """Of shape (size,); running numbers that formulas use as values, from 1."""
    labels: NDArray[np.int64]
    """Of shape (size, parts); how each row is called: ``2`` for a test, ``1 2`` for a pair, ``1 2 7`` for a
    point."""
    starts: NDArray[np.intp] | None = None
    """Of rows in groups, the first of each group."""

    @cached_property
    def groups(self) -> list[slice]:
        """Of rows in groups, those of each; of others, all together."""
        if self.starts is None:
            return [slice(0, self.size)]
        ends = [*self.starts.tolist(), self.size]
        return [slice(*each) for each in pairwise(ends)]

    @cached_property
    def group(self) -> NDArray[np.intp]:
        """In which of these each row is, from 0."""
        return np.repeat(np.arange(len(self.groups)), [rows.stop - rows.start for rows in self.groups])

    @cached_property
    def lasts(self) -> NDArray[np.intp]:
        """Of rows in groups, the last of each."""
        return np.array([rows.stop - 1 for rows in self.groups], dtype=np.intp)


def evenly(size: int, most: int) -> NDArray[np.intp]:
    """At most so many of the rows, evenly from the first to the last.

    Not every n-th: in step with the rows of a pair, that would always take the same ones.

    >>> evenly(5, 9).tolist(), evenly(9, 5).tolist()
    ([0, 1, 2, 3, 4], [0, 2, 4, 6, 8])
    """
    return np.linspace(0, size - 1, min(size, most)).round().astype(np.intp)


def lay_out(
    sheet: Sheet, labels: Mapping[str, Sequence[int]], counts: Mapping[str, int]
) -> dict[str, Layout]:
    """Lay out every axis of a sheet.

    Parameters
    ----------
    labels : mapping of axis name to sequence of int
        The rows' numbers of the axes that come with the data; of rows in groups, that of each row's group.
    counts : mapping of column name to int
        Values of the scalars that say how often an axis repeats another; 0 where that is not known.

    Raises
    ------
    ValueError
        A count is not a whole number of at least 0.
    """
    layouts: dict[str, Layout] = {}
    for axis in sheet.axes:
        if isinstance(axis, PairAxis):
            layouts[axis.name] = _pairs(axis, layouts[axis.of.name])
        elif isinstance(axis, RepeatAxis):
            layouts[axis.name] = _repeats(axis, layouts[axis.of.name], counts[axis.count])
        elif isinstance(axis, CountedAxis):
            layouts[axis.name] = _counted(axis)
        elif isinstance(axis, MemberAxis):
            layouts[axis.name] = _members(axis, layouts[axis.of.name], labels[axis.name])
        elif isinstance(axis, GroupAxis):
            members = layouts[axis.members.name]
            layouts[axis.name] = _given(axis, members.labels[members.starts, 0].tolist())
        else:
            groups = {each.group_name: labels[each.name] for each in axis.grouped(sheet.axes)}
            layouts[axis.name] = _given(axis, labels[axis.name], groups)
    return layouts


def how_large(sheet: Sheet, layouts: Mapping[str, Layout]) -> int:
    """How many cells a sheet has."""
    return sum(height(column, layouts) for column in sheet.columns)


def height(column: Column, layouts: Mapping[str, Layout]) -> int:
    """How many rows a column has: one, if it is on no axis."""
    return 1 if column.axis is None else layouts[column.axis.name].size


def _given(axis: Axis, labels: Sequence[int], groups: Mapping[str, Sequence[int]] | None = None) -> Layout:
    rows = {index: np.unique(numbers, return_inverse=True)[1] for index, numbers in (groups or {}).items()}
    rows[axis.index_name] = np.arange(len(labels))
    return Layout(len(labels), rows, {}, np.asarray(labels, dtype=np.int64).reshape(-1, 1))


@cache
def _chosen(axis: PairAxis) -> Callable[..., NDArray[np.bool_]]:
    from sympy import lambdify

    chosen: Callable[..., NDArray[np.bool_]] = lambdify((axis.first, axis.second), axis.chosen, "numpy")
    return chosen


def _pairs(axis: PairAxis, parent: Layout) -> Layout:
    number = np.arange(1, parent.size + 1)
    chosen = _chosen(axis) if axis.choice else np.less
    first, second = np.nonzero(np.broadcast_to(chosen(number[:, None], number), (parent.size,) * 2))
    rows = {axis.index_name: np.arange(first.size), **dict(zip(axis.members, (first, second), strict=True))}
    return Layout(first.size, rows, {}, np.hstack([parent.labels[first], parent.labels[second]]))


def _repeats(axis: RepeatAxis, parent: Layout, count: int) -> Layout:
    if count < 0 or count != int(count):
        raise ValueError(f"{axis.count} must be a whole number of at least 0, not {count}")
    which = np.repeat(np.arange(parent.size), int(count))
    step = np.tile(np.arange(1, int(count) + 1), parent.size)
    rows = {index: named[which] for index, named in parent.rows.items()}
    rows[axis.index_name] = np.arange(which.size)
    ordinals = {name: number[which] for name, number in parent.ordinals.items()}
    ordinals[axis.step_name] = step.astype(np.float64)
    return Layout(which.size, rows, ordinals, np.hstack([parent.labels[which], step.reshape(-1, 1)]))


def _counted(axis: CountedAxis) -> Layout:
    step = np.arange(1, axis.number + 1)
    ordinals = {axis.step_name: step.astype(np.float64)}
    return Layout(axis.number, {axis.index_name: step - 1}, ordinals, step.reshape(-1, 1))


def _members(axis: MemberAxis, parent: Layout, groups: Sequence[int]) -> Layout:
    numbers = np.asarray(groups, dtype=np.int64)
    own = np.argsort(numbers, kind="stable")
    _, starts = np.unique(numbers[own], return_index=True)
    rows = {index: named[own] for index, named in parent.rows.items()}
    rows[axis.index_name] = np.arange(own.size)
    labels = np.hstack([numbers[own].reshape(-1, 1), parent.labels[own]])
    return Layout(own.size, rows, {}, labels, starts)


@dataclass(frozen=True)
class Precedent:
    """A cell that a rule names, with the rows it stands for."""

    column: Column
    """The column it belongs to."""
    over: Axis | None
    """The axis it is summed over; None if a row names it itself."""
    rows: NDArray[np.intp] | None
    """For each row of the naming column's axis, or of the summed one, the row it names. None: each names the
    row of the same number, or the only one."""
    starts: NDArray[np.intp] | None = None
    """Where it is summed over a group, the first of the rows of each, on the axis that it is summed over."""

    def summed(self, row: int) -> slice:
        """The rows that the sum of a row runs over, on the axis that it is summed over."""
        if self.starts is None:
            return slice(None)
        return slice(*[*self.starts[row : row + 2].tolist(), None][:2])  # the last group has no end

    def row(self, row: int) -> int:
        """The row that a row names."""
        if self.rows is not None:
            return int(self.rows[row])
        return 0 if self.column.axis is None else row

    def take(self, array: NDArray[np.generic]) -> NDArray[np.generic]:
        """From an array (..., rows) of the column, what each naming row names."""
        return array if self.rows is None else array.take(self.rows, axis=-1)


def precedents(sheet: Sheet, layouts: Mapping[str, Layout], column: Column) -> tuple[Precedent, ...]:
    """Everything that a column's rule names; columns declared first come first."""
    return tuple(
        Precedent(
            sheet[r.name],
            r.over,
            rows_of(r.index, r.over or column.axis, layouts),
            layouts[r.over.name].starts if r.over else None,
        )
        for r in sheet.named(column)
    )


def rows_of(index: str | None, axis: Axis | None, layouts: Mapping[str, Layout]) -> NDArray[np.intp] | None:
    """The rows that an index names for each row of an axis; None where they are the same, or a scalar's."""
    if axis is None or index is None or index == axis.index_name:
        return None
    return layouts[axis.name].rows[index]
