"""Whether a result rests on sums that leave out groups of rows, and on others over the rows of these."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..axis import GroupAxis
from ..cells.layout import precedents
from ..cells.values import rows_kept
from ..messages.diagnostics import Check
from ..messages.errors import listing
from ..sheet import Sheet

if TYPE_CHECKING:
    from ..cells.values import Values
    from ..result.result import Report

MIXED = "mixed"


def names(sheet: Sheet) -> list[str]:
    """The kinds of groups, one check each."""
    return [axis.name for axis in sheet.axes if isinstance(axis, GroupAxis)]


def checks(report: Report) -> Iterator[Check]:
    """Of each kind of groups which results are of no one set of rows.

    A mean over all readings beside a scatter within specimens, one of which has a single reading, may be
    meant so; five readings less two specimens are the degrees of freedom of nothing.
    """
    for axis in report.sheet.axes:
        if isinstance(axis, GroupAxis):
            found, rows = _mixed(report.values, axis), axis.members.of.name
            said = f"no result rests on sums over some {axis.name} and over {rows} of others"
            if found:
                rest = f"{listing(found, last='and')} {'rests' if len(found) == 1 else 'rest'} on sums"
                others = f"others over {rows} of these"
                said = f"{rest} that leave out some {axis.name}, and on {others}, too: is that what is meant?"
            yield Check(MIXED, axis.name, True, said, report.inputs.place, note="warning" if found else "")


def _mixed(values: Values, axis: GroupAxis) -> list[str]:
    """The scalars that rest on both, and on which no other one rests."""
    sheet, layouts, rows = values.sheet, values.layouts, axis.members.of
    kept = {}
    for column in sheet.columns:
        named = [each for each in precedents(sheet, layouts, column) if each.over in (axis, rows)]
        if column.axis is None and named:
            kept[column.name] = rows_kept(named, layouts, values.status)
    group = layouts[rows.name].rows[axis.index_name]
    found = list[str]()
    for column in reversed(sheet.columns):
        if column.axis is not None or any(column in sheet.ancestors(sheet[name]) for name in found):
            continue
        masks = [kept[own.name] for own in (column, *sheet.ancestors(column)) if own.name in kept]
        groups, summed = ([each[name] for each in masks if name in each] for name in (axis.name, rows.name))
        if groups and summed:
            left_out = ~np.logical_and.reduce(groups)[group]
            if np.any(np.logical_or.reduce(summed) & left_out):
                found.insert(0, column.name)
    return found
