"""Many campaigns in few workbooks: to open a file takes LibreOffice longer than to recalculate a campaign.

Every campaign has worksheets of its own with the formulas that the Excel engine prints for it, and no
results. In its given cells stands what somebody may have pasted: numbers, allowed or not, words, errors,
nothing.
"""

from __future__ import annotations

import io
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xlsxwriter
from random_campaigns import MEASURED, NO_NUMBERS, SHEETS, UNCERTAIN, Campaign
from spreadsheets import recalculated

from loopsheet.report.cells.grid import Grid, as_issued
from loopsheet.report.cells.values import CODES, Status
from loopsheet.report.engines import excel_grid
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.numpy import Program
from loopsheet.report.judge.readers import Reading, _columns, read_cells
from loopsheet.report.sheet import Root
from loopsheet.report.views.xlsx_columns import ColumnwiseSheet

MOST = 50
"""Campaigns of a workbook."""
_INPUT = CODES[Status.INPUT]
_COUNTS = {Status.NOROOT: 0, Status.TWOROOTS: 2, Status.UNDECIDED: -1}


def workbook_reads(soffice: str, folder: Path, campaigns: Sequence[Campaign]) -> list[Reading]:
    """What the workbooks of campaigns of at least two tests say after LibreOffice has recalculated them.

    A workbook has as many rows as it was made for: a number of points that is refused leaves none to the
    other engines, and here as many as the least that is allowed, each with the code.
    """
    alike = {_shape(campaign): campaign for campaign in campaigns}
    grids = {shape: grid_of(campaign) for shape, campaign in alike.items()}
    parts = [campaigns[start : start + MOST] for start in range(0, len(campaigns), MOST)]
    books = {str(n): book_of([(grids[_shape(each)], each) for each in part]) for n, part in enumerate(parts)}
    read = {name: read_cells(content) for name, content in recalculated(soffice, folder, books).items()}
    return [
        reading_of(grids[_shape(each)], each, read[str(n)], place)
        for n, part in enumerate(parts)
        for place, each in enumerate(part)
    ]


# --- what a workbook is made for ---------------------------------------------------------------------------


def _points(campaign: Campaign) -> float:
    """How many points of a pair the campaign's workbook is made for."""
    bounds, points = SHEETS[campaign.variant].bounds["points_per_pair"], campaign.data["points_per_pair"][0]
    assert bounds.low is not None
    return points if bounds.allow(points) else bounds.low


def _shape(campaign: Campaign) -> tuple[int, int, float]:
    return campaign.variant, len(campaign.tests), _points(campaign)


def grid_of(campaign: Campaign) -> Grid:
    """The cells of the campaign's workbook, all in SI, as they are made from sound data."""
    sheet = SHEETS[campaign.variant]
    rows = range(1, len(campaign.tests) + 1)
    measured = MEASURED + UNCERTAIN
    data: dict[str, Any] = dict.fromkeys(sheet.bounds, 1.0) | {name: [0.5] * len(rows) for name in measured}
    labels = {"tests": list(rows)}
    values = engine.evaluate(sheet, labels, data | {"points_per_pair": _points(campaign)}, Program.of(sheet))
    return excel_grid.grid(sheet, values, {column.name: column.unit for column in sheet.columns})


# --- files -------------------------------------------------------------------------------------------------

_WORKSHEET = re.compile(r"(?<![\w'\"])(\w+)!(?=\$)")


def book_of(campaigns: Sequence[tuple[Grid, Campaign]]) -> bytes:
    """A workbook of campaigns: the worksheets of the n-th have its number in their names."""
    buffer = io.BytesIO()
    with xlsxwriter.Workbook(buffer, {"in_memory": True}) as book:
        for n, (grid, campaign) in enumerate(campaigns):
            sheets = {name: book.add_worksheet(f"{name} {n}", ColumnwiseSheet) for name in _worksheets(grid)}
            issued = _issued(campaign)
            for block in grid.blocks:
                sheet, place = sheets[block.place.worksheet], block.place
                for row in range(place.rows):
                    at = (place.row + row, place.column)
                    if block.kind == "given":
                        _paste(sheet, at, campaign.data[block.name][row], row)
                    elif block.kind == "index":
                        sheet.write_number(*at, block.values[row])
                    elif block.name in issued:
                        sheet.write(*at, issued[block.name][row])
                    else:
                        formula = _WORKSHEET.sub(rf"'\1 {n}'!", block.formulas[row])
                        write = sheet.write_array_formula if block.array else sheet.write_formula
                        write(*(at * 2 if block.array else at), formula, None, "")
    return buffer.getvalue()


def _issued(campaign: Campaign) -> dict[str, list[float | str]]:
    """What a workbook keeps of the inputs that it was made from, and how many roots were counted then."""
    sheet = SHEETS[campaign.variant]
    values = engine.evaluate(sheet, campaign.labels, campaign.data, Program.of(sheet))
    found: dict[str, list[float | str]] = {
        as_issued(name): [x if sheet.bounds[name].allow(x) else _INPUT for x in column]
        for name, column in campaign.data.items()
    }
    for column in sheet.columns:
        if isinstance(column.rule, Root):
            codes = [Status(int(code)) for code in values.status[column.name]]
            found[f"{column.name}.counted"] = [_COUNTS.get(code, 1) for code in codes]
    return found


def _worksheets(grid: Grid) -> list[str]:
    return list(dict.fromkeys(block.place.worksheet for block in grid.blocks))


def _paste(sheet: Any, at: tuple[int, int], x: float, row: int) -> None:
    """A datum as a number; what is none as a word, a truth value, an error, or nothing."""
    words: list[Any] = [*NO_NUMBERS, True]
    word = words[(at[0] + at[1] + row) % len(words)]
    if math.isfinite(x):
        sheet.write_number(*at, x)
    elif isinstance(word, bool):
        sheet.write_boolean(*at, word)
    elif word.startswith("#"):
        sheet.write_formula(*at, "=NA()", None, word)
    elif word:
        sheet.write_string(*at, word)


# --- what is read ------------------------------------------------------------------------------------------


def reading_of(
    grid: Grid, campaign: Campaign, cells: Mapping[str, Mapping[str, float | str]], n: int
) -> Reading:
    """What the n-th campaign's cells say."""
    sheet = SHEETS[campaign.variant]
    own = {name: cells[f"{name} {n}"] for name in _worksheets(grid)}
    value, status, rounded = _columns(sheet, grid, own)
    if not sheet.bounds["points_per_pair"].allow(campaign.data["points_per_pair"][0]):
        for column in sheet.columns:
            if column.axis is not None and column.axis.name == "points":
                assert set(status[column.name]) == {_INPUT}, (column.name, campaign)
                value[column.name], status[column.name], rounded[column.name] = [], [], []
    return Reading("xlsx", "LibreOffice", value, status, rounded=rounded)
