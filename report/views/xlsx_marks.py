"""Marks in the workbook: cells outside of what is expected are coloured and counted, by live formulas."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..cells.grid import CellBlock, Grid, letters
from ..result.result import Report
from .xlsx_style import Style

TITLE = "Inside what is expected (negative: outside)"
"""What stands above margins."""


def mark_outside(sheets: Mapping[str, Any], style: Style, report: Report, grid: Grid) -> None:
    """Colour the cells that lie outside, and their margins.

    `grid`: one that holds no margins has no marks.
    """
    for margin in report.marks.margins:
        if margin.column.name not in grid.by_name:
            continue
        own, room = grid[margin.of.name].place, grid[margin.column.name].place
        test = f"${letters(room.column)}{room.row + 1}"
        rule = {"type": "formula", "criteria": f"=AND(ISNUMBER({test}),{test}<0)", "format": style("outside")}
        for place in (own, room):
            sheets[place.worksheet].conditional_format(
                place.row, place.column, place.row + place.rows - 1, place.column, rule
            )


def counted(report: Report, grid: Grid, block: CellBlock) -> tuple[str, str]:
    """From how many rows a scalar was computed, how many carry marks: a formula, and as it is now."""
    parts, now = [], []
    for axis, formula in block.kept.items():
        size = report.values.layouts[axis].size
        parts.append(f'{formula.removeprefix("=")}&" of {size} {axis}"')
        now.append(f"{report.values.rows_summed(block.name, axis)} of {size} {axis}")
    text, value = '&", "&'.join(parts), ", ".join(now)
    for count in report.marks.behind(report.sheet[block.name]):
        if count.margin.column.name not in grid.by_name:
            continue
        margins = grid[count.margin.column.name].place.range(block.place.worksheet)
        outside = f'COUNTIF({margins},"<0")'
        text += f'&IF({outside}>0,"; "&{outside}&" of "&COUNT({margins})&" {_quoted(count.what)}","")'
        value += f"; {count.said}" if count.number else ""
    return f"={text}", value


def _quoted(text: str) -> str:
    return text.replace('"', '""')
