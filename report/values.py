"""Finished values: a number or an error code for every cell, and where an error came from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray
from sympy import Indexed

from .layout import Layout
from .sheet import Column, Root, Sheet, name_of

__all__ = ["CODES", "Cell", "Status", "Values"]


class Status(IntEnum):
    """What a cell holds; everything but OK is an error value."""

    OK = 0
    INPUT = 1
    DOMAIN = 2
    NOROOT = 3
    TWOROOTS = 4

    @property
    def code(self) -> str:
        """The code a reader sees."""
        return CODES[self]


CODES = {
    Status.OK: "ok",
    Status.INPUT: "#INPUT!",
    Status.DOMAIN: "#DOMAIN!",
    Status.NOROOT: "#NOROOT!",
    Status.TWOROOTS: "#TWOROOTS!",
}


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

    @property
    def address(self) -> str:
        """``alpha[1-2]``, ``x_m[3]``, ``alpha_mean``."""
        return f"{self.name}[{'-'.join(map(str, self.label))}]" if self.label else self.name

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

    Parameters
    ----------
    sheet : Sheet
    layouts : mapping of axis name to Layout
    value : mapping of column name to float array (..., rows)
        SI; NaN where the status is not OK. A scalar has one row.
    status : mapping of column name to integer array (..., rows)
        :class:`Status`.
    roots : mapping of column name to mapping of row to tuple of float
        For ambiguous cells, all the roots that were found.
    counted : mapping of column name to mapping of axis name to int
        How many rows the sums of a column ran over, where some were left out.
    """

    sheet: Sheet
    layouts: Mapping[str, Layout]
    value: Mapping[str, NDArray[np.float64]]
    status: Mapping[str, NDArray[np.uint8]]
    roots: Mapping[str, Mapping[int, tuple[float, ...]]] = field(default_factory=dict)
    counted: Mapping[str, Mapping[str, int]] = field(default_factory=dict)

    def labels(self, column: Column) -> list[tuple[int, ...]]:
        """How the rows of a column are called; one empty label for a scalar."""
        if column.axis is None:
            return [()]
        return [tuple(map(int, label)) for label in self.layouts[column.axis.name].labels]

    def row(self, column: Column, label: tuple[int, ...]) -> int:
        """The row of a label.

        Raises
        ------
        KeyError
            There is no such row.
        """
        labels = self.labels(column)
        if label not in labels:
            raise KeyError(label)
        return labels.index(label)

    def cells(self, name: str) -> Iterator[Cell]:
        """All cells of a column, in the order of its rows."""
        column = self.sheet[name]
        for row, label in enumerate(self.labels(column)):
            yield self._cell(column, row, label)

    def cell(self, name: str, label: tuple[int, ...] = ()) -> Cell:
        """One cell by its label."""
        column = self.sheet[name]
        return self._cell(column, self.row(column, label), label)

    def scalar(self, name: str) -> float:
        """The value of a scalar; NaN if it has none."""
        return float(self.value[name][..., 0])

    def errors(self) -> Iterator[Cell]:
        """All cells where an error begins."""
        for column in self.sheet.order:
            for row in np.flatnonzero(self.status[column.name]):
                cell = self._cell(column, int(row), self.labels(column)[row])
                if cell.culprit is None:
                    yield cell

    def _cell(self, column: Column, row: int, label: tuple[int, ...]) -> Cell:
        status = Status(int(self.status[column.name][row]))
        if status is Status.OK:
            return Cell(column.name, label, float(self.value[column.name][row]), status)
        culprit = self._culprit(column, row)
        if culprit is not None:
            return Cell(column.name, label, None, status, culprit)
        return Cell(column.name, label, None, status, None, self._why(column, row, status))

    def _culprit(self, column: Column, row: int) -> Cell | None:
        """Follow the first precedent that is in error to where the error began."""
        for other, other_row in self._precedent_rows(column, row):
            if self.status[other.name][other_row] != Status.OK:
                deeper = self._culprit(other, other_row)
                if deeper is not None:
                    return deeper
                return self._cell(other, other_row, self.labels(other)[other_row])
        return None

    def _precedent_rows(self, column: Column, row: int) -> Iterator[tuple[Column, int]]:
        """The cells that a cell is computed from; for a sum, those of its first rows that are in error."""
        references = self.sheet.references(column)
        declared = {c.name: i for i, c in enumerate(self.sheet.columns)}
        for cell in sorted(references, key=lambda c: (declared[name_of(c)], str(c))):
            other = self.sheet[name_of(cell)]
            if not isinstance(cell, Indexed):
                yield other, 0
                continue
            index = cell.indices[0]
            if column.axis is not None and index in column.axis.maps:
                yield other, int(self.layouts[column.axis.name].rows[index][row])
                continue
            for axis in self.sheet.summed_axes(column):
                if index in axis.maps:
                    named = self.layouts[axis.name].rows[index]
                    # A sum is in error only if no row of its axis has a value: the first one tells why.
                    for candidate in named[:1]:
                        yield other, int(candidate)

    def _why(self, column: Column, row: int, status: Status) -> str:
        rule = column.rule
        if status is Status.INPUT:
            return "the datum is missing or invalid"
        if isinstance(rule, Root) and status is Status.NOROOT:
            return f"{column.source} has no root here: {rule.none}"
        if isinstance(rule, Root) and status is Status.TWOROOTS:
            found = " and ".join(f"{root:.6g}" for root in self.roots.get(column.name, {}).get(row, ()))
            return f"{column.source} has more than one root here: {found or rule.two}" + (f" ({rule.two})" if found else "")
        stated = "; ".join(sentence for _, sentence in column.requires)
        return f"outside the domain of {column.source}" + (f": {stated}" if stated else "")
