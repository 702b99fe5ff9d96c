"""What a user's own workbook names to be shown: every word of it must be there."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from ...derivations.unit_text import UnitError, parse_unit
from ..messages.errors import listing, suggest
from ..sheet import GroupAxis
from ..workbook import FigureSpec, Measured, Parameter, RowTable, TableSpec

if TYPE_CHECKING:
    from ..sheet import Sheet
    from ..workbook import Workbook

_TEXTS = ("name", "title", "source", "prose")
_LISTS: dict[str, type] = {
    "measured": Measured,
    "parameters": Parameter,
    "several": RowTable,
    "headline": str,
    "fits": str,
    "tables": TableSpec,
    "figures": FigureSpec,
}
_FILE = re.compile(r"[\w-]+")


def mistyped(workbook: Workbook) -> Iterator[tuple[str, str, str]]:
    """The fields that are not of the kind that they should be, the word in it if it is one, a sentence."""
    for name in _TEXTS:
        if not isinstance(getattr(workbook, name), str):
            yield name, "", f"{name} is no text in quotes"
    for name, kind in _LISTS.items():
        each: Any = getattr(workbook, name)
        if isinstance(each, (tuple, list)) and all(isinstance(one, kind) for one in each):
            yield from ((name, *wrong) for one in each if (wrong := _wrong(one)))
        else:
            kinds = "names in quotes" if kind is str else kind.__name__
            yield name, "", f"{name} is no tuple of {kinds}; one alone is written (it,)"
    if len(workbook.fits) not in (0, 3):
        yield "fits", "", "fits names the mean and two fits, or nothing"
    titles: Any = workbook.published_as
    if not isinstance(titles, Mapping):
        yield "published_as", "", "published_as is no dict of titles"


def _wrong(declared: object) -> tuple[str, str] | None:
    """A unit that is none, or the name of a figure whose chart is none, with a sentence."""
    if isinstance(declared, FigureSpec):
        from ..charts import Chart  # with sympy, which an answer that is kept does without

        chart: Any = declared.chart
        none = f"the chart of figure '{declared.name}' is no Chart"
        return None if isinstance(chart, Chart | None) else (declared.name, none)
    if isinstance(declared, (Measured, Parameter)):
        try:
            parse_unit(declared.unit)
        except UnitError as error:
            return (
                declared.unit,
                f"the unit {declared.unit!r} of {declared.name} cannot be read at {error.text!r}",
            )
    return None


def misnamed(
    workbook: Workbook,
    sheet: Sheet,
    narratives: Mapping[str, Collection[str]],
    drawings: Callable[[], Collection[str]],
) -> Iterator[tuple[str, str, str]]:
    """The words that name nothing: the field that each stands in, the word, and a sentence.

    Parameters
    ----------
    sheet : Sheet
        Its sheet for what was given.
    narratives : mapping of str to collection of str
        The texts there are, with the cells, axes and equations that each tells of.
    drawings : callable
        Returns the names of the drawings there are; asked only if the workbook has figures.
    """
    scalars = [column.name for column in sheet.columns if column.axis is None]
    grouped = [column.name for column in sheet.columns if isinstance(column.axis, GroupAxis)]
    for where in ("headline", "fits"):
        for name in getattr(workbook, where):
            if where == "headline" and name in grouped:
                continue  # a line for each group
            if name in sheet.by_name and name not in scalars:
                or_groups = ", or what has one for each group" if where == "headline" else ""
                yield where, name, f"'{name}' has many rows, and {where} names single numbers{or_groups}"
            elif name not in scalars:
                yield where, name, _unknown("cell", where, name, scalars)
    if workbook.prose not in narratives:
        yield "prose", workbook.prose, _unknown("text", "prose", workbook.prose, narratives)
    elif told := narratives[workbook.prose]:
        there = {*sheet.by_name, *(axis.name for axis in sheet.axes)}
        there.update(equation.label for equation in workbook.ledger().equations())
        if missing := [word for word in told if word not in there]:
            where = (
                f"the text '{workbook.prose}' tells of {listing(missing)}, which this workbook does not have"
            )
            yield "prose", workbook.prose, f"{where}; without prose it has the generic text"
    for figure in workbook.figures:
        if figure.drawing not in (known := drawings()):
            yield "figures", figure.drawing, _unknown("drawing", "figures", figure.drawing, known)
        yield from (("figures", *wrong) for wrong in _undrawable(figure, sheet, workbook))
        if not _FILE.fullmatch(figure.name):
            yield "figures", figure.name, f"'{figure.name}' cannot be the name of a figure's file"


def _undrawable(figure: FigureSpec, sheet: Sheet, workbook: Workbook) -> Iterator[tuple[str, str]]:
    """What no view could draw of a chart: the word in it, and a sentence."""
    from ..charts import STYLES

    chart, drawn = figure.chart, workbook.drawn(sheet).columns if workbook.drawn else ()
    if chart is None:
        return
    axes = {column.name: column.axis for column in (*sheet.columns, *drawn)}
    if chart.log not in ("", "x", "y", "xy"):
        yield chart.log, f"the logarithmic axes of a chart are x, y or xy, not '{chart.log}'"
    for one in chart.series:
        unknown = [name for name in (one.x, one.y, one.value or one.x) if name not in axes]
        if unknown:
            yield unknown[0], _unknown("column", "a chart", unknown[0], axes)
        elif one.style not in STYLES:
            yield one.style, f"a chart has no style '{one.style}'; there are {listing(STYLES)}"
        elif axes[one.x] is None:
            yield one.x, f"'{one.x}' is a single number, and a chart needs rows"
        elif one.style == "level" and axes[one.y]:
            yield one.y, f"'{one.y}' has many rows, and is one level"
        elif one.style != "level" and axes[one.y] != axes[one.x]:
            yield one.y, f"'{one.y}' is not of the rows of '{one.x}'"
        elif one.value and (axes[one.value] or one.value not in sheet):
            yield one.value, f"'{one.value}' has many rows, and stands behind a label"


def _unknown(kind: str, where: str, name: str, known: Collection[str]) -> str:
    hint = suggest(name, known)
    return f"there is no {kind} '{name}', which {where} names; {hint or f'there is {listing(known)}'}"
