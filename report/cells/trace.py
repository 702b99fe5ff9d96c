"""Which cells a cell is computed from, and which are computed from it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..sheet import Column
from .layout import Precedent, precedents
from .values import Cell, Values


@dataclass(frozen=True)
class Group:
    """Some cells of one column."""

    column: Column
    rows: tuple[int, ...]
    """Their rows, from 0."""

    def cells(self, values: Values) -> Iterator[Cell]:
        """The cells, in the order of the rows."""
        labels = values.labels(self.column)
        return (values.cell(self.column.name, labels[row]) for row in self.rows)


def precedents_of(values: Values, column: Column, row: int) -> tuple[Group, ...]:
    """The cells that a cell is computed from, one group for each cell or sum that its rule names.

    `row`: from 0.
    """
    named = precedents(values.sheet, values.layouts, column)
    return tuple(Group(one.column, _named_by(one, row, values)) for one in named)


def _named_by(precedent: Precedent, row: int, values: Values) -> tuple[int, ...]:
    """The rows that a row names: one, or all that a sum runs over."""
    if precedent.over is None or precedent.column.axis is None:
        return (precedent.row(row),)
    rows = np.arange(values.layouts[precedent.over.name].size) if precedent.rows is None else precedent.rows
    return tuple(rows[precedent.summed(row)].tolist())


def dependents_of(values: Values, column: Column, row: int) -> tuple[Group, ...]:
    """The cells that are computed from a cell directly, in the order of the sheet."""
    found = []
    for other in values.sheet.dependents(column):
        rows: set[int] = set()
        for precedent in precedents(values.sheet, values.layouts, other):
            if precedent.column.name == column.name:
                rows |= _naming(precedent, row, other, values)
        if rows:
            found.append(Group(other, tuple(sorted(rows))))
    return tuple(found)


def _naming(precedent: Precedent, row: int, other: Column, values: Values) -> set[int]:
    """The rows of another column that name this row."""
    every = set(range(len(values.labels(other))))
    if precedent.column.axis is None:
        return every
    if precedent.over is not None:
        same = precedent.starts is None  # then all rows name the same
        return {each for each in every if row in _named_by(precedent, 0 if same else each, values)}
    return {row} if precedent.rows is None else set(np.flatnonzero(precedent.rows == row).tolist())
