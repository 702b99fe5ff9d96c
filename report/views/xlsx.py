"""report.xlsx: the sheet as a workbook of live formulas, with the values that the report has.

The formulas come from the Excel engine, cell by cell, and so do their places; here they get titles, units,
number formats, notes, checks of what is typed, and charts. Stored values are the report's, so that a viewer
that calculates nothing shows the same numbers.
"""

from __future__ import annotations

import io
from datetime import datetime
from pathlib import Path
from typing import Any

from xlsxwriter import Workbook as Book

from ..cells.grid import BUDGETS, SCALARS, SLOPES, STEPS, Grid
from ..machine.staging import put
from ..result.result import Report
from .issued import Issued
from .xlsx_budget import told_budgets, write_budgets
from .xlsx_cards import write_cards
from .xlsx_charts import charted, write_charts
from .xlsx_columns import ColumnwiseSheet
from .xlsx_inputs import GivenCells
from .xlsx_marks import mark_outside
from .xlsx_pages import write_equations, write_published, write_report
from .xlsx_style import Style
from .xlsx_tables import write_axis, write_slopes, write_steps

_CREATED = datetime(2000, 1, 1)
"""No clock: the same bytes for the same report."""
_FIGURES, _PUBLISHED = "figures", "published"
_CARDS, _EQUATIONS = "cards", "equations"


def write(made: Issued, stage: Path) -> None:
    """Write report.xlsx."""
    put(stage / "report.xlsx", made.workbook)


def render(report: Report, grid: Grid) -> bytes:
    """The workbook as a file.

    `grid`: the report's sheet as cells, from the Excel engine.
    """
    buffer = io.BytesIO()
    options = {
        "in_memory": True,
        "strings_to_formulas": False,
        "strings_to_urls": False,
        "strings_to_numbers": False,
    }
    with Book(buffer, options) as book:
        book.set_properties({"title": report.title, "created": _CREATED, "comments": "Made by loopsheet"})
        book.set_calc_mode("auto")
        _write(book, report, grid)
    return buffer.getvalue()


def _write(book: Any, report: Report, grid: Grid) -> None:
    """Make the worksheets in the order in which they are read, then fill them."""
    style, inputs = Style(book), GivenCells(report, grid)
    names = [SCALARS, *([_FIGURES] if charted(report, grid) else []), *grid.axes]
    names += [STEPS] if grid.on(STEPS) else []
    names += [_PUBLISHED] if report.every_comparison else []
    names += [BUDGETS] if told_budgets(report) or report.uncertain().conformities else []
    names += [SLOPES] if grid.on(SLOPES) else []
    names += [_CARDS] if report.cards().made else []
    sheets = {name: book.add_worksheet(name, ColumnwiseSheet) for name in [*names, _EQUATIONS]}
    stated = write_budgets(sheets[BUDGETS], style, report, grid) if BUDGETS in sheets else {}
    write_report(sheets[SCALARS], style, report, grid, inputs, stated)
    for name in grid.axes:
        write_axis(sheets[name], name, style, report, grid, inputs)
    if STEPS in sheets:
        write_steps(sheets[STEPS], style, report, grid)
    if _PUBLISHED in sheets:
        write_published(sheets[_PUBLISHED], style, report, grid)
    if SLOPES in sheets:
        write_slopes(sheets[SLOPES], style, grid)
    if _CARDS in sheets:
        write_cards(sheets[_CARDS], style, report.cards())
    write_equations(sheets[_EQUATIONS], style, report)
    if _FIGURES in sheets:
        write_charts(book, sheets[_FIGURES], style, report, grid)
    mark_outside(sheets, style, report, grid)
    _define_names(book, report, grid)


def _define_names(book: Any, report: Report, grid: Grid) -> None:
    """A name for the cells of every column: names do not tell capitals, so a second one gets a number."""
    taken: set[str] = set()
    for column in report.sheet.columns:
        name, number = f"ls_{column.name}", 2
        while name.lower() in taken:
            name, number = f"ls_{column.name}_{number}", number + 1
        taken.add(name.lower())
        place = grid[column.name].place
        book.define_name(name, f"={place.cell() if place.rows == 1 else place.range()}")
