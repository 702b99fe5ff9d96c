"""Cells outside what is expected of them: they keep their values, carry a mark, and are counted.

What a sheet declares as limits becomes columns of numbers: the margin of a cell is how far inside its limit
it lies, negative outside. Every engine computes margins as it does other columns, and none knows of marks.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, count
from typing import cast

import numpy as np
from numpy.typing import NDArray

from ..partly import partly
from ..sheet import Column, Formula, Limit, Sheet
from .values import Cell, Status, Values


@dataclass(frozen=True)
class Margin:
    """One limit of a column, and the column that says how far inside of it each row lies."""

    of: Column
    """Whose cells carry the mark."""
    limit: Limit
    column: Column
    """In SI units of what the limit compares; negative outside."""


@dataclass(frozen=True)
class MarkCount:
    """How many rows lie outside of a limit, of those for which that is known and tells something."""

    margin: Margin
    number: int
    size: int

    @property
    def rows(self) -> str:
        """What the rows are: ``pairs``."""
        axis = self.margin.of.axis
        return "cells" if axis is None else axis.name

    @property
    def what(self) -> str:
        """``pairs outside (4)``."""
        return self.margin.limit.rows(self.rows)

    @property
    def inside(self) -> str:
        """How many lie inside: ``7 of 10 pairs``."""
        return f"{self.size - self.number} of {self.size} {self.rows}"

    @property
    def said(self) -> str:
        """``3 of 10 pairs outside (4)``."""
        return f"{self.number} of {self.size} {self.what}"


def margins(sheet: Sheet) -> tuple[Margin, ...]:
    """The margins of all limits of a sheet, in the order in which its columns are computed.

    Raises
    ------
    SheetError
        A limit is no comparison, or several joined by and or or.
    """
    found: list[Margin] = []
    taken = set(sheet.by_name)
    for column in sheet.order:
        for limit in column.limits:
            names = chain([f"{column.name}_margin"], (f"{column.name}_margin_{n}" for n in count(2)))
            name = next(name for name in names if name not in taken)
            taken.add(name)
            found.append(Margin(column, limit, _column(name, column, limit)))
    return tuple(found)


def _column(name: str, of: Column, limit: Limit) -> Column:
    """The column of a margin; its algebra is made at once only if it has to be read."""
    says = f"{limit.mark} where this is negative"

    def whole() -> Column:
        from .limits import inside

        return Column(name, of.axis, Formula(inside(limit, of, name, says)), meaning=says, positive=False)

    if limit.mentioned is None:
        return whole()
    rule = partly(Formula, {}, lambda: cast(Formula, whole().rule))
    known = {"mentioned": limit.mentioned, "content": limit.mentioned.content, "source": says, "requires": ()}
    return partly(Column, {**vars(Column(name, of.axis, rule, meaning=says, positive=False)), **known}, whole)


def with_margins(sheet: Sheet) -> Sheet:
    """The sheet with its margins behind its columns."""
    return Sheet((*sheet.columns, *(margin.column for margin in margins(sheet))))


@dataclass(frozen=True)
class Marks:
    """Which cells lie outside of what limits."""

    values: Values
    """Of the sheet with its margins, without a batch."""
    margins: tuple[Margin, ...]

    def outside(self, margin: Margin) -> NDArray[np.bool_]:
        """Which rows lie outside (rows,)."""
        found: NDArray[np.bool_] = self.values.value[margin.column.name] < 0
        return found

    def telling(self, margin: Margin) -> NDArray[np.bool_]:
        """Which rows are known and tell something: those of which a report is silent do not (rows,)."""
        found: NDArray[np.bool_] = self.values.status[margin.column.name] == Status.OK
        for other in self._by_name.get(margin.of.name, ()):
            if other.limit.silent and other is not margin:
                found = found & ~self.outside(other)
        return found

    def count(self, margin: Margin) -> MarkCount:
        """How many of these do."""
        known = self.telling(margin)
        return MarkCount(margin, int((self.outside(margin) & known).sum()), int(known.sum()))

    def limiting(self, name: str) -> tuple[Margin, ...]:
        """The margins of a column's limits."""
        return tuple(self._by_name.get(name, ()))

    def limited(self, name: str) -> MarkCount:
        """How many cells of a column lie outside of the first statement that limits it."""
        return next(self.count(margin) for margin in self._by_name[name] if margin.limit.source)

    def of(self, name: str) -> list[str]:
        """The mark of every cell of a column; empty where it has none, or no value."""
        marks: list[list[str]] = [[] for _ in self.values.value[name]]
        for margin in self._by_name.get(name, ()):
            has = self.values.status[name] == Status.OK
            for row in np.flatnonzero(self.outside(margin) & has).tolist():
                marks[row].append(margin.limit.mark)
        return ["; ".join(own) for own in marks]

    def is_faultless(self, cell: Cell) -> bool:
        """Whether an error begins where nobody is to blame: in a spare column, or as a silent limit says."""
        column, broken = self.values.sheet[cell.name], self.values.broken.get(cell.name)
        row = self.values.row(column, cell.label)
        number = 0 if broken is None else int(broken[row])
        if number and (column.spare or column.conditions[number - 1] in self._silent):
            return True
        return any(each.limit.silent and self.outside(each)[row] for each in self.limiting(cell.name))

    @cached_property
    def _silent(self) -> set[str]:
        return {margin.limit.mark for margin in self.margins if margin.limit.silent}

    def behind(self, column: Column) -> Iterator[MarkCount]:
        """For a scalar, how many of the rows that it rests on lie outside, limit by limit."""
        if column.axis is None:
            names = {ancestor.name for ancestor in self.values.sheet.ancestors(column)}
            for margin in self.margins:
                if margin.of.axis is not None and margin.of.name in names:
                    yield self.count(margin)

    @cached_property
    def _by_name(self) -> dict[str, list[Margin]]:
        found: dict[str, list[Margin]] = {}
        for margin in self.margins:
            found.setdefault(margin.of.name, []).append(margin)
        return found
