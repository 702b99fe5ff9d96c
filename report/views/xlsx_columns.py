"""A worksheet that takes a column of cells at once.

A workbook of many tests has half a million cells. XlsxWriter asks of each where it lies and what it is,
though all cells of a column are alike; that took more than half of the time.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from itertools import chain, repeat
from typing import Any, NamedTuple
from xml.sax.saxutils import escape

from xlsxwriter.worksheet import Worksheet

from ..cells.grid import FilledDown, letters

_letters = lru_cache(letters)


class _Written(NamedTuple):
    """A cell as the file says it: its type, as an attribute, and what is in it."""

    kind: str
    inside: str
    format: Any


class ColumnwiseSheet(Worksheet):  # type: ignore[misc] # XlsxWriter comes without types
    """A worksheet whose formulas are taken as they are, one by one or a column at once."""

    shared = 0
    """How many formulas are filled down."""

    def write_numbers(self, row: int, column: int, numbers: Iterable[float], form: Any) -> None:
        """Write whole numbers one below the other."""
        self._put(row, column, [_Written("", f"<v>{number:.0f}</v>", form) for number in numbers])

    def write_filled(
        self,
        row: int,
        column: int,
        filled: Iterable[FilledDown],
        values: Iterable[float | str | None],
        forms: Iterable[Any],
    ) -> None:
        """Write formulas that are filled down, with the values that they have now; of None, an error."""
        texts = chain.from_iterable(self._texts(row, column, filled))
        cells = zip(texts, values, forms, strict=True)
        self._put(row, column, [_formula(*cell) for cell in cells])

    def _texts(self, row: int, column: int, filled: Iterable[FilledDown]) -> Iterator[Iterable[str]]:
        """The elements of such formulas: what is filled down is said once."""
        for rows, first in filled:
            text = escape(first.removeprefix("="))
            if rows == 1:
                yield (f"<f>{text}</f>",)
            else:
                shared = f't="shared" si="{self.shared}"'
                cells = f"{_letters(column)}{row + 1}:{_letters(column)}{row + rows}"
                yield chain([f'<f {shared} ref="{cells}">{text}</f>'], repeat(f"<f {shared}/>", rows - 1))
                self.shared += 1
            row += rows

    def _put(self, row: int, column: int, cells: list[_Written]) -> None:
        for place, cell in enumerate(cells, start=row):
            self.table[place][column] = cell
        for place in (row, row + len(cells) - 1) if cells else ():
            self._check_dimensions(place, column)

    def _calculate_spans(self) -> None:
        """Leave out from where to where a row has cells: no reader needs it, and every cell is asked."""

    def _prepare_formula(self, formula: str, expand_future_functions: bool = False) -> str:
        # XlsxWriter looks into each for thirty functions of newer Excels; the engine prints none of them.
        return formula.removeprefix("{").removeprefix("=").removesuffix("}")

    def _write_cell(self, row: int, col: int, cell: Any) -> None:
        if isinstance(cell, _Written):
            attributes = f'r="{_letters(col)}{row + 1}" s="{cell.format._get_xf_index()}"{cell.kind}'
            self.fh.write(f"<c {attributes}>{cell.inside}</c>")
        else:
            super()._write_cell(row, col, cell)


def _formula(element: str, value: float | str | None, form: Any) -> _Written:
    """A formula's element with the value that it has now."""
    told = "#N/A" if value is None else value
    kind = ' t="e"' if value is None else ' t="str"' if isinstance(value, str) and value else ""
    return _Written(kind, f"{element}<v>{told}</v>", form)
