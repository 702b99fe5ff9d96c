"""Words of a method for what a reader is shown of it: figures and tables."""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ..charts import COLOURS, INK, STYLES, Chart, Series, series_of
from ..column import Column, Given, SheetError
from ..messages.errors import listing, sentence_case
from ..named import name_of
from ..workbook import FigureSpec, TableSpec
from .errors import current, told_together


@told_together
def plot(
    *shown: Any,
    caption: str = "",
    log: str = "",
    title: str = "",
    labels: tuple[str, str] = ("", ""),
    name: str = "",
    number: str = "",
    alt: str = "",
    from_zero: bool = False,
    whole: bool = True,
    height: float = 8,
) -> None:
    """Show points of two columns, with bars of standard uncertainties, and what is computed beside them.

    Parameters
    ----------
    *shown : Expr
        Two columns, x and y, over the rows, and further ones: what is measured as points, what is computed as
        a line in the order of x; single numbers, each across all of it; pairs ``(x, y)``, of what
        :func:`sketch` made, too, that have points, or a line, of their own. Each of them, and the first two,
        may be what :func:`trace` returns.
    caption : str
        Below the figure; what its axes are, without.
    log : str
        The axes with a logarithmic scale: ``x``, ``y`` or ``xy``. What is zero or below is left out there,
        and the caption says so of columns that may be.
    title, labels : str, tuple of str
        Of the chart in a workbook, and of both axes; what the first columns mean, without.
    name, number : str
        How a narrative asks for it, and that of the figure of the source that it is.
    alt : str
        What the picture shows, for those who cannot see it.
    from_zero : bool
        Whether both axes begin at zero.
    whole : bool
        Whether every point is drawn where it is, however far from the lines and the other points.
    height : float
        In centimetres, of 16 cm of width.
    """
    body = current()
    if log not in ("", "x", "y", "xy"):
        raise SheetError(f"log={log!r} names no axes: x, y or xy")
    first, *others = shown or [None]
    if not isinstance(first, Series):
        if not others:
            raise SheetError("plot(x, y) is of two columns")
        first = series_of(*map(_over_rows, (first, others.pop(0))))
    across, up = (_column(cell) for cell in (first.x, first.y))
    series = [first]
    for curve, colour in zip(others, itertools.cycle(COLOURS), strict=False):
        if isinstance(curve, Series):
            series.append(curve)
        elif isinstance(curve, tuple):
            series.append(replace(series_of(*_columns(*curve)), colour=colour))
        else:
            (column,) = _columns(curve)
            is_read = isinstance(column.rule, Given) and column.axis is not None
            style = "points" if is_read else "level" if column.axis is None else "line"
            series.append(Series(across.name, column.name, column.meaning, style, colour, bars=is_read))
    said, number = f"{up.meaning} over {across.meaning}", number or str(len(body.figures) + 1)
    labels = (labels[0] or across.meaning, labels[1] or up.meaning)
    chart = Chart(title or said, *labels, tuple(series), log, from_zero, whole=whole, height=height)
    caption = caption or f"{sentence_case(said)}."
    if any(not _column(getattr(each, axis)).positive for each in series for axis in log):
        caption += " What is zero or below has no place on a logarithmic axis."
    body.figures.append(FigureSpec(name or f"plot_{number}", number, caption, alt=alt, chart=chart))


@told_together
def trace(
    x: Any,
    y: Any,
    label: str = "",
    style: str = "",
    colour: str = INK,
    *,
    each: bool = False,
    named: bool = False,
    bars: bool = False,
    value: Any = None,
) -> Series:
    """Say how two columns look in a :func:`plot`.

    Parameters
    ----------
    x, y : Expr
        Columns of the same rows, of what :func:`sketch` made, too; or a single number as `y`, a level.
    label : str
        What the legend says; ``%s`` in it stands for the rows: ``10 pairs``. Without, what `y` means.
    style : str
        ``points``, ``line`` or ``level``; without, points of rows and a line of what is generated.
    colour : str
        ``#rrggbb``.
    each : bool
        Whether each row that has points of its own has a line of its own; ``%s`` is then its name.
    named : bool
        Whether the points have the names of their rows.
    bars : bool
        Whether points have bars of standard uncertainties.
    value : Expr, optional
        A single number that the label is told to be, behind it.
    """
    across, (up,) = _over_rows(x), _columns(y)
    own = "level" if up.axis is None else "line" if up.axis.ordinals else "points"
    style = style or own
    if style not in STYLES or (style == "level") != (own == "level"):
        raise SheetError(f"style={style!r} is none of {up.name}: a level is of one number, others of columns")
    if own != "level":
        series_of(across, up)  # which says what is wrong
    if not re.fullmatch("#[0-9a-f]{6}", colour):
        raise SheetError(f"colour={colour!r} is none: #rrggbb, as '#0072b2'")
    told = "" if value is None else _columns(value)[0].name
    return Series(across.name, up.name, label or up.meaning, style, colour, each, named, told, bars)


@told_together
def drawing(name: str, caption: str, *, number: str, alt: str) -> None:
    """Show a picture that is the same for all data.

    A function draws it, of a report, which returns a figure of matplotlib: below the class stands
    ``WORKBOOK = replace(Name.workbook, drawings=lambda: {"rig": draw_rig})``.

    Parameters
    ----------
    name, number, caption, alt : str
        As for :func:`plot`.
    """
    current().figures.append(FigureSpec(name, number, caption, alt=alt, fixed=True))


def _column(name: str) -> Column:
    """What the body, or a sketch in it, calls so."""
    body = current()
    return next((each for each in body.drawn if each.name == name), None) or body.column(name)


def _over_rows(cell: Any) -> Column:
    (column,) = _columns(cell)
    if column.axis is None:
        raise SheetError(f"{column.name} is a single number, which is no column to plot", column.name)
    return column


def _columns(*cells: Any) -> list[Column]:
    return [_column(name_of(cell)) for cell in cells]


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
