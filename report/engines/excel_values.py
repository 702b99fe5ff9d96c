"""What the cells on the way to a root show before a spreadsheet has recalculated them, by NumPy."""

from __future__ import annotations

from typing import Any

import numpy as np
from sympy import Expr, Indexed, Sum, Symbol

from ..layout import precedents, rows_of
from ..sheet import Axis, name_of
from ..values import CODES, Status, Values, inherited, rows_kept
from .excel_roots import READY, Unrolled
from .numpy_code import write

__all__ = ["auxiliary_values"]


def auxiliary_values(values: Values, unrolled: Unrolled) -> dict[str, tuple[float | str, ...]]:
    """The values of every cell of an unrolled root, by name; an empty text where there is none.

    Parameters
    ----------
    values : Values
        All columns, computed, without a batch.
    unrolled : Unrolled
    """
    return _Evaluation(values, unrolled).run()


class _Evaluation:
    """The values of the cells so far: arrays over the rows of the root's axis."""

    def __init__(self, values: Values, unrolled: Unrolled) -> None:
        self.values, self.unrolled, self.column = values, unrolled, unrolled.column
        self.sheet, self.layouts = values.sheet, values.layouts
        self.rows = len(values.value[self.column.name])
        self.named = precedents(self.sheet, self.layouts, self.column)
        self.kept = rows_kept(self.named, self.layouts, values.status)
        self.known: dict[str, Any] = {}
        self.functions: dict[tuple[Expr, tuple[Symbol, ...]], Any] = {}

    def run(self) -> dict[str, tuple[float | str, ...]]:
        codes = inherited(self.named, self.kept, self.values.status, self.rows)
        ready = codes == Status.OK
        shown: dict[str, tuple[float | str, ...]] = {
            self.unrolled.check.name: tuple(READY if c == Status.OK else CODES[Status(int(c))] for c in codes)
        }
        for symbol, known in zip(
            (self.unrolled.issued, self.unrolled.counted), (np.ones(self.rows), self._counted()), strict=True
        ):
            if symbol is not None:
                self.known[symbol.name], shown[symbol.name] = known, tuple(known.tolist())
        for cell in self.unrolled.cells:
            with np.errstate(all="ignore"):
                found = np.broadcast_to(self._at(cell.expression), (self.rows,)).astype(np.float64)
            self.known[cell.name] = found
            wanted = ready & (self.known[self.unrolled.number.name] == 1) if cell.alone else ready
            shown[cell.name] = tuple(
                float(x) + 0.0 if want and np.isfinite(x) else ""
                for x, want in zip(found, wanted, strict=True)
            )
        return shown

    def _counted(self) -> Any:
        """How many roots each row has; -1 where that is not certain."""
        status = self.values.status[self.column.name]
        roots = self.values.roots.get(self.column.name, {})
        several = [max(2, len(roots.get(row, ()))) for row in range(self.rows)]
        codes = [Status.NOROOT, Status.TWOROOTS, Status.UNDECIDED]
        return np.select([status == code for code in codes], [0, several, -1], 1).astype(np.float64)

    def _at(self, expression: Expr) -> Any:
        if isinstance(expression, Sum):
            return self._sum(expression)
        return self._evaluated(expression, self.column.axis, over=False)

    def _sum(self, total: Sum) -> Any:
        """One number a row of the root: its terms may name the unknown there."""
        axis = self.sheet.indices[total.limits[0][0]]
        mask = self.kept[axis.name]
        terms = np.broadcast_to(self._evaluated(total.function, axis, over=True), (self.rows, len(mask)))
        return np.where(mask, terms, 0.0).sum(axis=-1)

    def _evaluated(self, expression: Expr, axis: Axis | None, over: bool) -> Any:
        """An expression over all rows of an axis; inside of a sum, the root's own rows go down."""
        numbers: dict[Symbol, Any] = {}

        def stand_in(value: Any) -> Symbol:
            symbol = Symbol(f"leaf_{len(numbers)}", real=True)
            numbers[symbol] = value
            return symbol

        plain = {total: stand_in(self._sum(total)) for total in sorted(expression.atoms(Sum), key=str)}
        body = expression.xreplace(plain)
        cells = {cell: stand_in(self._cell(cell, axis)) for cell in sorted(body.atoms(Indexed), key=str)}
        body = body.xreplace(cells)
        own = {
            s: stand_in(self._plain(s, axis, over)) for s in sorted(body.free_symbols - set(numbers), key=str)
        }
        return self._function(body.xreplace(own), tuple(numbers))(*numbers.values())[0]

    def _function(self, body: Expr, leaves: tuple[Symbol, ...]) -> Any:
        """The expression as a function: the steps to a root all have the same, of other cells."""
        if (body, leaves) not in self.functions:
            self.functions[body, leaves] = write(leaves, (), [body])[1]
        return self.functions[body, leaves]

    def _cell(self, cell: Indexed, axis: Axis | None) -> Any:
        value, rows = self.values.value[name_of(cell)], rows_of(cell, axis, self.layouts)
        return value if rows is None else value[rows]

    def _plain(self, symbol: Symbol, axis: Axis | None, over: bool) -> Any:
        if symbol.name in self.known:
            return self.known[symbol.name][:, np.newaxis] if over else self.known[symbol.name]
        if symbol in self.sheet.sizes:
            summed = self.sheet.sizes[symbol].name
            return float(self.kept[summed].sum() if summed in self.kept else self.layouts[summed].size)
        if axis is not None and symbol in axis.ordinals:
            return self.layouts[axis.name].ordinals[symbol]
        return self.values.value[symbol.name]
