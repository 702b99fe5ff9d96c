"""A sheet as a workbook's cells: laid out once for all data, with the values that they have now."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import chain, count
from types import MappingProxyType
from typing import Any

from ..cells.grid import SCALARS, SLOPES, STEPS, CellBlock, Grid, Grouped, Place, Product
from ..cells.layout import Layout
from ..cells.values import Values
from ..charts import Drawn
from ..plan.kept import of_data, of_sheet
from ..sheet import Axis, MemberAxis, Sheet
from .excel_loops import PASSES, pass_columns, passes_of
from .excel_values import (
    NotPrintable,
    auxiliary_values,
    filled,
    loops_settle,
    settles,
    slope_values,
    with_passes,
)
from .numpy import extend

MOST_ROWS = 40_000
"""Rows of a worksheet; a million would fit, but these take half a gigabyte to make, and more to open."""
_RESERVED = (SCALARS, STEPS, SLOPES, "figures", "published", "equations", "history")
"""Worksheets that are there already, and one that Excel keeps for itself."""
_LONGEST_NAME = 31
"""Characters of a worksheet's name."""
_TIMES = (2, 4, 8)
"""So many times a root's own steps are laid out, the first that settle all rows as they are."""
_PASSES = (PASSES, 2 * PASSES, 4 * PASSES)
"""So many passes a loop has, the first in which it settles as it is."""


class TooManyRows(ValueError):
    """An axis has more rows than a worksheet should hold."""


def grid(
    sheet: Sheet,
    values: Values,
    units: Mapping[str, str],
    first: Sequence[str] = (),
    drawn: Drawn | None = None,
    worded: Mapping[str, Sequence[str]] = MappingProxyType({}),
    limited: Sequence[str] = (),
) -> Grid:
    """Lay a sheet out as the cells of a workbook, with the values that they have now.

    Parameters
    ----------
    values : Values
        All columns, computed, without a batch dimension; those that are not of the sheet are the margins
        of its limits.
    units : mapping of str to str
        The unit that each column is shown in; one that is no plain multiple of SI's leaves SI.
    first : sequence of str
        The scalars that are the result.
    drawn : Drawn or None
        What is drawn as native charts.
    worded : mapping of str to sequence of str
        By index set, the columns of words that stand beside the numbers of rows that are made of no others.
    limited : sequence of str
        Other columns whose derivatives have cells, too.

    Raises
    ------
    TooManyRows
        An axis has more than :data:`MOST_ROWS` rows.
    NotPrintable
        A formula has no spreadsheet formula.
    """
    check_rows(values.layouts)
    if taken := passes_of(sheet, _PASSES[-1]).keys() & values.sheet.by_name.keys():
        raise NotPrintable(
            f"{min(taken)} is what a worksheet calls a step of a fit: call the column otherwise"
        )
    drawn = with_first_pass(drawn, sheet)
    thinned = drawn.thinned if drawn else ()
    every = values if drawn is None else extend(values, drawn.columns, drawn.given)
    whole, layouts = every.sheet, every.layouts
    counts = {axis.repeats: every.scalar(axis.repeats) for axis in whole.axes if axis.repeats}

    worksheets = _worksheets(whole.axes)

    def make(times: int) -> dict[str, Any]:
        from .excel_assembly import Assembly

        return Assembly(
            worksheets,
            sheet,
            judged=values.sheet,
            whole=whole,
            layouts=layouts,
            counts=counts,
            units=units,
            first=first,
            results=results,
            worded=beside,
            thinned=thinned,
            times=times,
            last=last,
        ).told()

    own = [
        layouts[axis.name].labels.tolist()
        for axis in whole.axes
        if axis.is_given or isinstance(axis, MemberAxis)
    ]
    words = [(column.meaning, column.unit, column.display, column.source) for column in whole.columns]
    names = [list(each.by_name) for each in (sheet, values.sheet)]
    beside = {axis: list(columns) for axis, columns in worded.items()}
    results = list(dict.fromkeys((*first, *limited)))
    sizes = (
        sorted(counts.items()),
        sorted(units.items()),
        list(first),
        results,
        sorted(beside.items()),
        thinned,
    )
    hangs_on = repr((names, own, words, sizes))
    shown, done = every, 1
    for last in _PASSES:
        shown, done = with_passes(shown, sheet, last, done), last
        if loops_settle(shown, sheet, last):
            break
    else:
        last = PASSES  # where none is enough, they are not laid out for nothing
    for times in _TIMES:
        parts = [hangs_on, str(times), str(last)]
        told = of_sheet(whole, "formulas of the workbook", parts, partial(make, times))
        found = [auxiliary_values(every, root) for root in told["roots"]]
        if all(settles(every, root, own) for root, own in zip(told["roots"], found, strict=True)):
            break
    axes = dict(zip(worksheets.values(), whole.axes, strict=True))
    slopes = slope_values(values, sheet, told["slopes"])
    steps = dict(chain.from_iterable(own.items() for own in found))
    blocks = filled(of_data(told["blocks"], tuple[CellBlock, ...]), steps, shown, slopes)
    notes = of_data(told["notes"], dict[str, Place])
    words_at = of_data(told["words"], dict[str, tuple[Place, ...]])
    ways = of_data(told["slopes"]["ways"], dict[str, dict[str, tuple[Product, ...]]])
    groups = of_data(told["groups"], dict[str, tuple[Grouped, ...]])
    return Grid(tuple(blocks), axes, drawn, notes, words_at, groups, ways, last)


def with_first_pass(drawn: Drawn | None, sheet: Sheet) -> Drawn | None:
    """What is drawn, and the first pass of each loop."""
    own = drawn or Drawn()
    there = {column.name for column in own.columns}
    passes = () if there & passes_of(sheet).keys() else pass_columns(sheet)
    return replace(own, columns=(*own.columns, *passes)) if passes else drawn


def check_rows(layouts: Mapping[str, Layout]) -> None:
    """Refuse what no worksheet should hold.

    Raises
    ------
    TooManyRows
        An axis has more than :data:`MOST_ROWS` rows.
    """
    for name, layout in layouts.items():
        if layout.size > MOST_ROWS:
            raise TooManyRows(f"{name} has {layout.size} rows")


def _worksheets(axes: Iterable[Axis]) -> dict[str, str]:
    """The worksheets' names of axes, short enough for Excel, which does not tell capitals apart."""
    names: dict[str, str] = {}
    taken = set(_RESERVED)
    for axis in axes:
        endings = chain(("", "_rows"), (f"_rows_{number}" for number in count(2)))
        tried = (axis.name[: _LONGEST_NAME - len(ending)] + ending for ending in endings)
        names[axis.name] = next(name for name in tried if name.lower() not in taken)
        taken.add(names[axis.name].lower())
    return names
