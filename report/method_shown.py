"""Words of a method for what a reader is shown of it: figures and tables."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from .charts import COLOURS, Chart, Series, series_of
from .column import Column, Given, SheetError
from .messages.errors import listing
from .method_errors import current, told_together
from .named import name_of
from .workbook import FigureSpec, TableSpec, sentence_case

__all__ = ["plot", "table"]


@told_together
def plot(x: Any, y: Any, *curves: Any, caption: str = "", log: str = "") -> None:
    """Show points of two columns, with bars of standard uncertainties, and what is computed beside them.

    Parameters
    ----------
    x, y : Expr
        Columns over the rows.
    *curves : Expr
        Further columns: what is measured as points, what is computed as a line in the order of x; single
        numbers, each across all of it; or pairs ``(x, y)``, of what :func:`sketch` made, too, that have
        points, or a line, of their own.
    caption : str
        Below the figure; what its axes are, without.
    log : str
        The axes with a logarithmic scale: ``x``, ``y`` or ``xy``. What is zero or below is left out there,
        and the caption says so of columns that may be.
    """
    body = current()
    if log not in ("", "x", "y", "xy"):
        raise SheetError(f"log={log!r} names no axes: x, y or xy")

    sketched = {column.name: column for column in body.drawn}

    def called(name: str) -> Column:
        return sketched.get(name) or body.column(name)

    def named(*cells: Any) -> list[Column]:
        return [called(name_of(cell)) for cell in cells]

    across, up = named(x, y)
    for each in (across, up):
        if each.axis is None:
            raise SheetError(f"{each.name} is a single number, which is no column to plot", each.name)
    series = [series_of(across, up)]
    for curve, colour in zip(curves, itertools.cycle(COLOURS), strict=False):
        if isinstance(curve, tuple):
            series.append(replace(series_of(*named(*curve)), colour=colour))
        else:
            (column,) = named(curve)
            is_read = isinstance(column.rule, Given) and column.axis is not None
            style = "points" if is_read else "level" if column.axis is None else "line"
            series.append(Series(across.name, column.name, column.meaning, style, colour, bars=is_read))
    said, number = f"{up.meaning} over {across.meaning}", str(len(body.figures) + 1)
    chart = Chart(said, across.meaning, up.meaning, tuple(series), log, whole=True)
    caption = caption or f"{sentence_case(said)}."
    if any(not called(getattr(each, axis)).positive for each in series for axis in log):
        caption += " What is zero or below has no place on a logarithmic axis."
    body.figures.append(FigureSpec(f"plot_{number}", number, caption, chart=chart))


@told_together
def table(
    title: str,
    *columns: Any,
    note: str = "",
    name: str = "",
    number: str = "",
    beside: tuple[str, Mapping[Any, str]] = ("", {}),
) -> None:
    """Show columns beside each other, or numbers below each other; all that no table shows follows by itself.

    Parameters
    ----------
    title : str
        Its caption.
    *columns : Expr
        Names of the body, in their order: all of the rows, all of the pairs, or all single numbers.
    note : str
        Below it.
    name, number : str
        How a narrative asks for it, and that of the table of the source that it is.
    beside : tuple of (str, mapping of Expr to str)
        Of single numbers: what stands above one more column, and what that says of each.
    """
    body = current()
    shown = [body.column(name_of(cell)) for cell in columns]
    if len({column.axis for column in shown}) != 1:
        told = listing([column.name for column in shown]) if shown else "nothing"
        raise SheetError(f"the table '{title}' is of one kind of rows, or of single numbers, not of {told}")
    names, said = tuple(column.name for column in shown), ((name_of(c), s) for c, s in beside[1].items())
    own = name or f"table_{len(body.tables) + 1}"
    body.tables.append(TableSpec(own, title, names, note, number, beside=(beside[0], tuple(said))))
