"""A worksheet that takes a column of cells at once.

A workbook of many tests has half a million cells. XlsxWriter asks of each where it lies and what it is,
though all cells of a column are alike; that took more than half of the time.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import Any, NamedTuple
from xml.sax.saxutils import escape

from xlsxwriter.worksheet import Worksheet

from ..cells.grid import letters

__all__ = ["ColumnwiseSheet"]

_letters = lru_cache(letters)


class _Written(NamedTuple):
    """A cell as the file says it: its type, as an attribute, and what is in it."""

    kind: str
    inside: str
    format: Any


class ColumnwiseSheet(Worksheet):  # type: ignore[misc] # XlsxWriter comes without types
    """A worksheet whose formulas are taken as they are, one by one or a column at once."""

    def write_numbers(self, row: int, column: int, numbers: Iterable[float], form: Any) -> None:
        """Write whole numbers one below the other."""
        self._put(row, column, [_Written("", f"<v>{number:.0f}</v>", form) for number in numbers])

    def write_formulas(
        self,
        row: int,
        column: int,
        formulas: Iterable[str],
        values: Iterable[float | str | None],
        forms: Iterable[Any],
    ) -> None:
        """Write formulas one below the other, with the values that they have now; of None, an error."""
        cells = zip(formulas, values, forms, strict=True)
        self._put(row, column, [_formula(formula.removeprefix("="), *cell) for formula, *cell in cells])

    def _put(self, row: int, column: int, cells: list[_Written]) -> None:
        for place, cell in enumerate(cells, start=row):
            self.table[place][column] = cell
        for place in (row, row + len(cells) - 1) if cells else ():
            self._check_dimensions(place, column)

    def _prepare_formula(self, formula: str, expand_future_functions: bool = False) -> str:
        # XlsxWriter looks into each for thirty functions of newer Excels; the engine prints none of them.
        return formula.removeprefix("{").removeprefix("=").removesuffix("}")

    def _write_cell(self, row: int, col: int, cell: Any) -> None:
        if isinstance(cell, _Written):
            attributes = f'r="{_letters(col)}{row + 1}" s="{cell.format._get_xf_index()}"{cell.kind}'
            self.fh.write(f"<c {attributes}>{cell.inside}</c>")
        else:
            super()._write_cell(row, col, cell)


def _formula(text: str, value: float | str | None, form: Any) -> _Written:
    """A formula with the value that it has now."""
    told = "#N/A" if value is None else value
    kind = ' t="e"' if value is None else ' t="str"' if isinstance(value, str) and value else ""
    return _Written(kind, f"<f>{escape(text)}</f><v>{told}</v>", form)
