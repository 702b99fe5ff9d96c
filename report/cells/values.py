"""Finished values: a number or an error code for every cell, and where an error came from."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import IntEnum
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..column import shown_in
from ..quantity import Bounds, behind
from ..sheet import Column, Formula, GroupAxis, Iterated, MemberAxis, Root, Sheet
from .address import address
from .address import word as is_word
from .layout import Layout, Precedent, precedents

Codes = NDArray[np.uint8]
Mask = NDArray[np.bool_]


class Status(IntEnum):
    """What a cell holds; everything but OK is an error value."""

    OK = 0
    INPUT = 1
    DOMAIN = 2
    NOROOT = 3
    TWOROOTS = 4
    OVERFLOW = 5
    UNDECIDED = 6

    @property
    def code(self) -> str:
        """The code a reader sees."""
        return CODES[self]


CODES = {each: f"#{each.name}!" if each else "ok" for each in Status}

BEYOND = "it, or a step towards it, is above 1.8e308, or positive and below 2.2e-308"
"""What ``#OVERFLOW!`` means, for the reader."""

UNCERTAIN = "it may touch zero, jump, or cross it too often"
"""What ``#UNDECIDED!`` means, for the reader."""

# --- how errors spread: the same for every engine ---------------------------------------------------------


def rows_kept(
    named: Sequence[Precedent], layouts: Mapping[str, Layout], status: Mapping[str, Codes]
) -> dict[str, Mask]:
    """For every axis that a column sums over, the rows whose cells all have values.

    A pair without a root must not take the mean of all others with it. The rows that are left out are
    counted, and every view says so.

    Parameters
    ----------
    named : sequence of Precedent
        What the column names.
    layouts : mapping of axis name to Layout
    status : mapping of column name to integer array (..., rows)

    Returns
    -------
    mapping of axis name to boolean array (..., rows)
    """
    kept: dict[str, Mask] = {}
    for precedent in named:
        if precedent.over is not None:
            axis = precedent.over.name
            mask = kept.get(axis, np.ones(layouts[axis].size, dtype=bool))
            kept[axis] = mask & (precedent.take(status[precedent.column.name]) == Status.OK)
    return kept


def how_many(kept: Mapping[str, Mask]) -> dict[str, int]:
    """For every axis of which sums leave rows out, how many they run over; without a batch.

    `kept` (mapping of axis name to boolean array (..., rows)): from :func:`rows_kept`.
    """
    return {axis: int(mask.sum()) for axis, mask in kept.items() if mask.ndim == 1 and not mask.all()}


def inherited(
    named: Sequence[Precedent], kept: Mapping[str, Mask], status: Mapping[str, Codes], size: int
) -> Codes:
    """The first error among a column's precedents; a sum has one only if none of its rows has a value.

    Parameters
    ----------
    named, kept, status
        As for, and from, :func:`rows_kept`.
    size : int
        How many rows the column has.

    Returns
    -------
    integer array (..., rows)
        What a sum of no rows at all becomes is ``#DOMAIN!``.
    """
    found: Codes = np.zeros(size, dtype=np.uint8)
    for precedent in named:
        theirs = precedent.take(status[precedent.column.name])
        if precedent.over is not None:
            mask = kept[precedent.over.name]
            # Its first row tells why: some cell of it is in error.
            if precedent.starts is not None:
                some: Any = np.logical_or.reduceat(mask, precedent.starts, axis=-1)
                first = theirs.take(precedent.starts, axis=-1)
            else:
                some = mask.any(axis=-1, keepdims=True)
                first = theirs[..., :1] if mask.shape[-1] else np.full((*mask.shape[:-1], 1), Status.DOMAIN)
            theirs = np.where(some, Status.OK, first)
        found = np.where(found == Status.OK, theirs, found).astype(np.uint8)
    return found


# --- cells ------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Cell:
    """One cell: its address, and its value or its error with the first culprit."""

    name: str
    label: tuple[int, ...]
    value: float | None
    status: Status
    culprit: Cell | None = None
    """The cell where the error began; None if this is it, or if there is no error."""
    why: str = ""
    word: str = ""
    """What its group is called, which then stands for the number of its row."""

    @property
    def address(self) -> str:
        """``alpha[1-2]``, ``x_m[3]``, ``alpha_mean``, ``slope[steel]``."""
        return f"{self.name}[{self.word}]" if self.word else address(self.name, self.label)

    @property
    def reason(self) -> str:
        """A sentence that says why there is no value."""
        if self.status is Status.OK:
            return ""
        if self.culprit is None:
            return f"{self.status.code} {self.address}: {self.why}"
        return f"{self.status.code} {self.address} needs {self.culprit.address}: {self.culprit.why}"


@dataclass(frozen=True)
class Values:
    """Values and statuses of every column.

    Arrays have the dimensions (..., rows), the batch first; a scalar has one row. A column that rests on
    nothing with a batch has none. Cells, their labels and reasons are of values without a batch.
    """

    sheet: Sheet
    layouts: Mapping[str, Layout]
    """By axis name."""
    value: Mapping[str, NDArray[np.float64]]
    """Of shape (..., rows), by column name; SI; NaN where the status is not OK."""
    status: Mapping[str, NDArray[np.uint8]]
    """Of shape (..., rows), by column name; :class:`Status`."""
    roots: Mapping[str, Mapping[int, tuple[float, ...]]] = field(default_factory=dict)
    """By column name; for ambiguous cells, all the roots that were found; for undecided ones, the ends of the
    part of the unknown's interval where it was not decided. Without a batch."""
    counted: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    """By column name; how many rows the sums of a column ran over, where some were left out; without a
    batch."""
    broken: Mapping[str, NDArray[np.uint8]] = field(default_factory=dict)
    """Of shape (..., rows), by column name; which of the column's conditions a row breaks first, from 1; 0
    for none."""
    words: Mapping[str, Mapping[tuple[int, ...], str]] = field(default_factory=dict)
    """What the rows of an axis are known by besides their numbers, by its name and their labels."""
    passes: Mapping[str, int] = field(default_factory=dict)
    """How many passes each loop took, by its name."""

    @property
    def plain(self) -> tuple[Any, ...]:
        """All but sheet, layouts and words, in their order: plain data for a process that has those."""
        return self.value, self.status, self.roots, self.counted, self.broken

    @property
    def given_labels(self) -> dict[str, list[int]]:
        """Row numbers of the axes that come with the data, by the name of the axis."""
        axes = (axis for axis in self.sheet.axes if axis.is_given)
        found = {axis.name: self.layouts[axis.name].labels[:, 0].tolist() for axis in axes}
        for axis in self.sheet.axes:
            if isinstance(axis, MemberAxis):
                layout = self.layouts[axis.name]
                found[axis.name] = layout.labels[np.argsort(layout.rows[axis.of.index_name]), 0].tolist()
        return found

    def of_batch(self, block: slice) -> Values:
        """Those of a part of the only dimension of a batch."""
        value = {name: own[block] if own.ndim > 1 else own for name, own in self.value.items()}
        status = {name: own[block] if own.ndim > 1 else own for name, own in self.status.items()}
        return replace(self, value=value, status=status)

    def labels(self, column: Column) -> list[tuple[int, ...]]:
        """How the rows of a column are called; one empty label for a scalar."""
        return [()] if column.axis is None else self._labels(column.axis.name)

    def word(self, column: Column, label: tuple[int, ...]) -> str:
        """What the group is called that a row is; empty where its number stands for it."""
        words = self.words.get(column.axis.name, {}) if isinstance(column.axis, GroupAxis) else {}
        return found if is_word(found := words.get(label, "")) else ""

    def address(self, name: str, row: int) -> str:
        """How a cell of a column is called."""
        column = self.sheet[name]
        label = self.labels(column)[row]
        return Cell(name, label, None, Status.OK, word=self.word(column, label)).address

    def row(self, column: Column, label: tuple[int, ...]) -> int:
        """The row of a label.

        Raises
        ------
        KeyError
            There is no such row.
        """
        if column.axis is None:
            if label:
                raise KeyError(label)
            return 0
        return self._rows_by_label(column.axis.name)[label]

    def tests(self, cell: Cell) -> tuple[tuple[str, int], ...]:
        """The tests that a row rests on: the index set and the number of each; none of a scalar."""
        axis = self.sheet[cell.name].axis
        if axis is None:
            return ()
        layout, row = self.layouts[axis.name], self.row(self.sheet[cell.name], cell.label)
        own = [(index, each.name) for index, each in axis.named.items() if each.is_given]
        labels = {name: self.layouts[name].labels for _, name in own}
        return tuple((name, int(labels[name][layout.rows[index][row], 0])) for index, name in own)

    def cells(self, name: str) -> Iterator[Cell]:
        """All cells of a column, in the order of its rows."""
        column = self.sheet[name]
        for row, label in enumerate(self.labels(column)):
            yield self._cell(column, row, label)

    def numbers(self, name: str) -> list[float | None]:
        """The values of all cells of a column; None where there is none, for whatever reason."""
        pairs = zip(self.value[name].tolist(), self.status[name].tolist(), strict=True)
        return [None if status else value for value, status in pairs]

    def cell(self, name: str, label: tuple[int, ...] = ()) -> Cell:
        """One cell by its label."""
        column = self.sheet[name]
        return self._cell(column, self.row(column, label), label)

    def rows_of_group(self, name: str, axis: MemberAxis, row: int) -> int:
        """Over how many rows of its group a cell sums: those without a value do not count."""
        where, (_, kept) = self.layouts[axis.name].groups[row], self._named(name)
        return int(kept[axis.name][where].sum()) if axis.name in kept else where.stop - where.start

    def left_out(self, name: str, row: int) -> Iterator[tuple[int, int, str]]:
        """Of axes of which a cell does not sum all rows: over how many of how many, and which axis."""
        for axis in self.counted.get(name, {}):
            number, size = self.over(name, row, axis)
            if number != size:
                yield number, size, axis

    def over(self, name: str, row: int, axis: str) -> tuple[int, int]:
        """Over how many of how many rows of an axis a cell sums; one of a group sums those of its group."""
        own = self.sheet[name].axis
        if isinstance(own, GroupAxis) and own.members.name == axis:
            where = self.layouts[axis].groups[row]
            return self.rows_of_group(name, own.members, row), where.stop - where.start
        return self.rows_summed(name, axis), self.layouts[axis].size

    def rows_summed(self, name: str, axis: str) -> int:
        """Over how many rows of an axis a column sums: those without a value do not count."""
        return self.counted.get(name, {}).get(axis, self.layouts[axis].size)

    def scalar(self, name: str) -> float:
        """The value of a scalar; NaN if it has none."""
        return float(self.value[name][..., 0])

    def errors(self) -> tuple[Cell, ...]:
        """All cells where an error begins."""
        return self._errors

    # --- what is looked up again and again -------------------------------------------------------------

    @cached_property
    def _errors(self) -> tuple[Cell, ...]:
        failed = (
            self._cell(column, row, self.labels(column)[row])
            for column in self.sheet.order
            for row in np.flatnonzero(self.status[column.name]).tolist()
        )
        return tuple(cell for cell in failed if cell.culprit is None)

    @cached_property
    def _labels(self) -> Callable[[str], list[tuple[int, ...]]]:
        layouts = self.layouts
        return cache(lambda axis: [tuple(label) for label in layouts[axis].labels.tolist()])

    @cached_property
    def _rows_by_label(self) -> Callable[[str], dict[tuple[int, ...], int]]:
        labels = self._labels
        return cache(lambda axis: {label: row for row, label in enumerate(labels(axis))})

    @cached_property
    def _named(self) -> Callable[[str], tuple[tuple[Precedent, ...], dict[str, Mask]]]:
        sheet, layouts, status = self.sheet, self.layouts, self.status

        def of(name: str) -> tuple[tuple[Precedent, ...], dict[str, Mask]]:
            named = precedents(sheet, layouts, sheet[name])
            return named, rows_kept(named, layouts, status)

        return cache(of)

    # --- why a cell has no value -----------------------------------------------------------------------

    def _cell(self, column: Column, row: int, label: tuple[int, ...]) -> Cell:
        status = Status(int(self.status[column.name][row]))
        if status is Status.OK:
            return self._told(column, label, float(self.value[column.name][row]), status)
        culprit = self._culprit(column, row)
        if culprit is not None:
            return self._told(column, label, None, status, culprit)
        return self._told(column, label, None, status, None, self._why(column, row, status))

    def _told(
        self,
        column: Column,
        label: tuple[int, ...],
        value: float | None,
        status: Status,
        culprit: Cell | None = None,
        why: str = "",
    ) -> Cell:
        return Cell(column.name, label, value, status, culprit, why, self.word(column, label))

    def _culprit(self, column: Column, row: int) -> Cell | None:
        """The cell where the error of a cell began; None if it is this one."""
        other, its_row = self._origin(column, row, set()) or (column, row)
        iterated = isinstance(column.rule, Iterated) and other.name in self._loop(column)
        if (other.name, its_row) == (column.name, row) or iterated:
            return None  # of what a loop iterates, none is to blame for the others
        label, status = self.labels(other)[its_row], Status(int(self.status[other.name][its_row]))
        return self._told(other, label, None, status, None, self._why(other, its_row, status))

    def _loop(self, column: Column) -> frozenset[str]:
        """The names of the columns of its loop; none if it is in none."""
        loop = self.sheet.loop_of.get(column.name)
        return frozenset() if loop is None else loop.names

    def _origin(self, column: Column, row: int, seen: set[tuple[str, int]]) -> tuple[Column, int] | None:
        """Follow the first precedents that are in error to where it began; None if that leads in a circle."""
        seen.add((column.name, row))
        wrong = list(self._wrong(column, row))
        for other, its_row in wrong:
            if (other.name, its_row) not in seen and (found := self._origin(other, its_row, seen)):
                return found
        return None if wrong else (column, row)

    def _wrong(self, column: Column, row: int) -> Iterator[tuple[Column, int]]:
        """The precedents of a cell whose error it may have inherited, first those before its loop.

        A loop that did not settle is where it began.
        """
        named, kept = self._named(column.name)
        loop, status = self._loop(column), self.status[column.name][row]
        failed = isinstance(column.rule, Iterated) and status == Status.NOROOT
        for precedent in sorted(named, key=lambda each: each.column.name in loop):
            other, over = precedent.column, precedent.over
            if failed and other.name in loop:
                continue
            summed = precedent.summed(row)
            if over is not None and (kept[over.name][summed].any() or not kept[over.name].size):
                continue  # a sum is in error only if no row of those that it runs over has a value
            its_row = precedent.row(summed.start or 0 if over is not None else row)
            if self.status[other.name][its_row] == status:
                yield other, its_row

    def _why(self, column: Column, row: int, status: Status) -> str:
        rule = column.rule
        if status is Status.INPUT:
            allowed = self.sheet.bounds[column.name]
            told = "" if allowed == Bounds() else f"; it must be {allowed.said(column.written)}"
            return f"the datum is missing or invalid{told}"
        if isinstance(rule, Iterated) and status is Status.NOROOT:
            return f"{column.source} did not settle: {rule.none}"
        if isinstance(rule, Root) and status is Status.NOROOT:
            return f"{column.source} has no root here: {rule.none}"
        if isinstance(rule, Root) and status is Status.TWOROOTS:
            found = " and ".join(self._told_roots(column, row))
            return f"{column.source} has more than one root here: {found or rule.two}" + (
                f" ({rule.two})" if found else ""
            )
        if isinstance(rule, Root) and status is Status.UNDECIDED:
            ends = dict.fromkeys(self._told_roots(column, row, rule.value == rule.unknown))
            where = f" near {rule.unknown} = {' to '.join(ends)}" if ends else ""
            return f"the roots of {column.source} cannot be counted{where}: {UNCERTAIN}"
        if status is Status.OVERFLOW:
            return f"{column.source} has a value here that no double holds: {BEYOND}"
        outside = f"outside the domain of {column.source}"
        broken = self.broken.get(column.name)
        if broken is not None and broken[row]:
            return f"{outside}: {column.conditions[broken[row] - 1]}"
        empty = [axis for axis, mask in self._named(column.name)[1].items() if not mask.size]
        if empty:
            return f"{outside}: {empty[0]} has no rows"
        if isinstance(rule, Formula):
            return (
                f"{outside}: it {'has to be positive' if column.positive else 'gives no finite number here'}"
            )
        if isinstance(rule, Root):
            return f"{outside}: it has no value at an end of the interval of its root, or its root gives none"
        return outside

    def _told_roots(self, column: Column, row: int, is_value: bool = True) -> list[str]:
        """The roots of a cell, in the unit in which it is shown; those of another unknown as they are."""
        roots = self.roots.get(column.name, {}).get(row, ())
        if not is_value or not roots:
            return [f"{root:.6g}" for root in roots]
        size = shown_in(column, self.sheet.by_name)
        return [f"{(root - float(size.zero)) / float(size.scale):.6g}{behind(size.text)}" for root in roots]


def other_rows(here: Values, there: Values) -> dict[str, Mask]:
    """The columns whose sums run over other rows than elsewhere: what they estimate is then another quantity.

    Parameters
    ----------
    here : Values
        With a batch or without.
    there : Values
        All columns of these over the same rows, without a batch.

    Returns
    -------
    mapping of column name to boolean array (...,)
        For which elements of the batch they do; columns of which none does are not there.
    """
    wrong = {
        column.name
        for column in here.sheet.columns
        if here.status[column.name].any() or there.status[column.name].any()
    }
    found: dict[str, Mask] = {}
    for column in here.sheet.columns:
        summed = [each for each in precedents(here.sheet, here.layouts, column) if each.over is not None]
        if wrong.isdisjoint(each.column.name for each in summed):
            continue
        own, other = (rows_kept(summed, here.layouts, values.status) for values in (here, there))
        moved = [np.any(mask != other[axis], axis=-1) for axis, mask in own.items()]
        if any(each.any() for each in moved):
            found[column.name] = np.logical_or.reduce(np.broadcast_arrays(*moved))
    return found
