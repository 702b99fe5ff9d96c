"""What the cells on the way to a root show before a spreadsheet has recalculated them, by NumPy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..cells.layout import precedents
from ..cells.values import CODES, Status, Values, inherited, rows_kept
from .excel_roots import READY, Unrolled
from .numpy import Program, parts, program_texts
from .numpy_code import Array

__all__ = ["auxiliary_values"]


def auxiliary_values(values: Values, unrolled: Unrolled) -> dict[str, tuple[float | str, ...]]:
    """The values of every cell of an unrolled root, by name; an empty text where there is none.

    Parameters
    ----------
    values : Values
        All columns, computed, without a batch.
    unrolled : Unrolled
    """
    column, sheet = unrolled.column, values.sheet
    named, rows = precedents(sheet, values.layouts, column), len(values.value[column.name])
    codes = inherited(named, rows_kept(named, values.layouts, values.status), values.status, rows)
    asked = (unrolled.issued, np.ones(rows)), (unrolled.counted, _counted(values, column.name))
    told = {cell.name: known for cell, known in asked if cell is not None}
    found = parts(
        Program.of_texts(sheet, program_texts(sheet, unrolled.plan), lambda: unrolled.plan),
        replace(values, value={**values.value, **told}),
    )
    cells = {cell.name: found[cell.part.symbol.name] for cell in unrolled.cells}
    ready = codes == Status.OK
    alone = ready & (cells[unrolled.number.name] == 1)
    shown: dict[str, tuple[float | str, ...]] = {name: tuple(own.tolist()) for name, own in told.items()}
    shown |= {c.name: _shown(cells[c.name], alone if c.alone else ready) for c in unrolled.cells}
    check = (READY if code == Status.OK else CODES[Status(int(code))] for code in codes)
    return shown | {unrolled.check.name: tuple(check)}


def _shown(numbers: Array, wanted: NDArray[np.bool_]) -> tuple[float | str, ...]:
    """Numbers where they are wanted and there are any."""
    pairs = zip(numbers.tolist(), (wanted & np.isfinite(numbers)).tolist(), strict=True)
    return tuple(number + 0.0 if there else "" for number, there in pairs)


def _counted(values: Values, name: str) -> Array:
    """How many roots each row has; -1 where that is not certain."""
    status, roots = values.status[name], values.roots.get(name, {})
    several = [max(2, len(roots.get(row, ()))) for row in range(len(status))]
    codes = [Status.NOROOT, Status.TWOROOTS, Status.UNDECIDED]
    return np.select([status == code for code in codes], [0, several, -1], 1).astype(np.float64)
