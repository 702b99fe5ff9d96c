"""The worksheets of an axis' rows and of the steps to a scalar root."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..cells.grid import FIRST_ROW, SLOPES, STEPS, CellBlock, Grid, Place, letters
from ..result.result import Report
from ..sheet import Axis, GroupAxis, RepeatAxis
from .xlsx_inputs import GivenCells
from .xlsx_marks import TITLE
from .xlsx_style import Style, height, number_format, said, typical_format

_GROUP, _NAME, _MEANING, _SOURCE, _SYMBOL = range(FIRST_ROW - 5, FIRST_ROW)
_WIDTH, _STEP_WIDTH, _INDEX_WIDTH, _NOTE_WIDTH = 15.0, 13.0, 9.0, 40.0
_SMALL = 1.15
"""How many small letters take the room of one."""
_GROUPS = {
    "margin": TITLE,
    "drawn": "for the charts",
    "checked": "as checked",
    "carried": "of other worksheets",
    "slope": "derivatives for the budgets, in SI",
}


# --- the cells of a block ----------------------------------------------------------------------------------


def write_block(
    sheet: Any, style: Style, report: Report, block: CellBlock, inputs: GivenCells, name: str = "number"
) -> None:
    """Write the cells of a block."""
    if block.kind == "given":
        inputs.write(sheet, style, block)
        return
    place = block.place
    if block.kind == "index":
        sheet.write_numbers(place.row, place.column, block.values, style("index"))
        return
    forms = [style(name, form) if form else style("step") for form in _number_formats(report, block)]
    if block.array:
        for row, cell in enumerate(zip(block.formulas, block.values, forms, strict=True), start=place.row):
            style.formula(sheet, row, place.column, *cell, array=True)
    else:
        sheet.write_filled(place.row, place.column, block.filled, block.values, forms)
    if block.kind == "computed":
        # No formula names the roots that there are; as issued they are known.
        values, labels = report.values, report.values.labels(report.sheet[block.name])
        for row in values.roots.get(block.name, {}):
            reason = values.cell(block.name, labels[row]).reason
            sheet.write_comment(place.row + row, place.column, f"as issued: {reason}", {"x_scale": 3})


def _number_formats(report: Report, block: CellBlock) -> Sequence[str]:
    """Of each cell that the report shows its own; else one for all; none of a step."""
    rows = block.place.rows
    if block.kind in ("step", "slope"):
        return [""] * rows
    column = report.sheet.by_name.get(block.of or block.name)
    if column and block.kind in ("computed", "checked") and not isinstance(column.axis, RepeatAxis):
        return [number_format(figure) for figure in report.figures(column.name)]
    shown = report.shown.get(block.of or block.name)
    return [typical_format(block.values, shown.digits if shown else 4)] * rows


# --- the worksheet of an axis ----------------------------------------------------------------------------


def write_axis(sheet: Any, name: str, style: Style, report: Report, grid: Grid, inputs: GivenCells) -> None:
    """Write the worksheet that holds the rows of an axis."""
    axis, blocks, below = grid.axes[name], grid.on(name), 0
    # Of points that are only drawn, how many there are stands above them.
    main = [b for b in blocks if b.kind in ("given", "computed") and b.place.row == FIRST_ROW] or list(blocks)
    style.page(sheet, f"{name}: {axis.described}")
    if name in grid.notes:
        below = _write_notes(sheet, name, style, report, grid, inputs)
    words = grid.words.get(name, ())
    _write_all_words(sheet, style, report, axis, words)
    for block in blocks:
        if block.place.row == FIRST_ROW:
            _write_header(sheet, style, report, block)
        elif block.kind == "given":
            style.text(sheet, block.place.row, 0, block.name, "subtitle")
        write_block(sheet, style, report, block, inputs)
    _write_groups(sheet, style, report, blocks)
    meanings = [(b.meaning, _SMALL * _width(b)) for b in blocks if b.place.row == FIRST_ROW]
    sheet.set_row(_MEANING, 0.82 * height(meanings, 2))
    sheet.set_row(_NAME, 20)
    if isinstance(axis, GroupAxis):
        named = [1]
    else:
        own = report.inputs.on(axis.name) if words else None
        named = [own.remarks.index(column) + 1 for column in own.naming] if own else []
    indices = len([b for b in blocks if b.kind == "index"])
    sheet.freeze_panes(FIRST_ROW, indices + sum(named))
    last, size = max(b.place.column for b in blocks), max(b.place.rows for b in blocks)
    first = words[-1].column + 1 if words else 0
    mark_errors(sheet, style, FIRST_ROW, first, FIRST_ROW + size - 1, last)
    every = f"A1:{letters(last)}{FIRST_ROW + size}"
    sheet.ignore_errors({"formula_differs": every, **({"number_stored_as_text": every} if words else {})})
    sheet.repeat_rows(_NAME, _SYMBOL)
    sheet.print_area(0, 0, FIRST_ROW + size - 1 + below, max(b.place.column for b in main))


def _write_notes(sheet: Any, name: str, style: Style, report: Report, grid: Grid, inputs: GivenCells) -> int:
    """Write what is told of given cells, and what is left out below them; how many rows that takes."""
    note, row = grid.notes[name], grid.axes[name].row
    weighed = [block for block in grid.on(name) if block.name in report.sheet.weighed]
    follow = [
        bool(formula)
        for block in weighed
        for formula, number in zip(inputs.shares[block.name], block.values, strict=True)
        if isinstance(number, float)
    ]
    some = " that are no share of a reading" * any(follow)
    stays = "" if all(follow) else f" but standard uncertainties{some}, which stay as issued"
    says = f"Type over the yellow cells; all else follows{stays}."
    style.text(sheet, 1, 0, f"{says} An empty one leaves its {row} out of all sums.", "subtitle")
    given = [b for b in grid.on(name) if b.kind == "given" and b.place.row == FIRST_ROW]
    says = "whether the given cells are what they may be"
    _write_head(sheet, style, note.column, _NOTE_WIDTH, "check", says)
    inputs.write_told(sheet, style, given, note)
    return inputs.write_left_out(sheet, style, given, note)


def _write_all_words(sheet: Any, style: Style, report: Report, axis: Axis, words: Sequence[Place]) -> None:
    """Write the words beside the numbers of rows, in their places."""
    if isinstance(axis, GroupAxis):
        words_in = report.inputs.on(axis.members.of.name).words(axis.row)
        numbers = report.values.layouts[axis.name].labels[:, 0]
        _write_words(sheet, style, words[0], axis.row, [words_in[number - 1] for number in numbers.tolist()])
    elif words:  # rows made of others have none
        table = report.inputs.on(axis.name)
        for place, column in zip(words, table.remarks, strict=False):
            texts = [table.texts[test][column] for test in table.tests]
            _write_words(sheet, style, place, column, texts)


def mark_errors(
    sheet: Any, style: Style, first_row: int, first_column: int, last_row: int, last_column: int
) -> None:
    """Show the codes of errors in red, wherever they appear."""
    rule = {"type": "text", "criteria": "begins with", "value": "#", "format": style("error")}
    sheet.conditional_format(first_row, first_column, last_row, last_column, rule)


def _width(block: CellBlock) -> float:
    if block.kind == "index":
        return max(_INDEX_WIDTH, 1.15 * len(block.title) + 2)
    if block.kind in ("step", "slope"):
        return _STEP_WIDTH
    return max(_WIDTH, 1.15 * len(block.name) + 6)


def _write_header(sheet: Any, style: Style, report: Report, block: CellBlock) -> None:
    at = block.place.column
    options = {"level": 1} if block.kind in ("step", "carried", "checked", "slope") else {}
    sheet.set_column(at, at, _width(block), None, options)
    unit = said(block.unit) if block.kind not in ("index", "step", "slope") else ""
    style.text(sheet, _NAME, at, block.title + unit, "head")
    style.text(sheet, _MEANING, at, block.meaning, "meaning")
    column = report.sheet.by_name.get(block.name)
    style.text(sheet, _SOURCE, at, block.source, "source")
    if column is not None and column.latex:
        style.symbol(sheet, _SYMBOL, at, column.latex)
    else:
        style.text(sheet, _SYMBOL, at, "", "symbol")


def _write_words(sheet: Any, style: Style, place: Place, name: str, texts: Sequence[str]) -> None:
    """Write a column of words, which no formula reads."""
    width = min(_SMALL * max(map(len, (name, *texts))) + 2, _NOTE_WIDTH)
    _write_head(sheet, style, place.column, width, name)
    for row, words in enumerate(texts, start=place.row):
        if words:
            style.text(sheet, row, place.column, words)


def _write_head(sheet: Any, style: Style, at: int, width: float, name: str, says: str = "") -> None:
    """Write the header of a column that no formula reads."""
    sheet.set_column(at, at, width)
    for row, words, look in (
        (_NAME, name, "head"),
        (_MEANING, says, "meaning"),
        (_SOURCE, "", "source"),
        (_SYMBOL, "", "symbol"),
    ):
        style.text(sheet, row, at, words, look)


def _write_groups(sheet: Any, style: Style, report: Report, blocks: Sequence[CellBlock]) -> None:
    """Say above the columns what the further ones are for."""
    before = ""
    for block in blocks:
        group = _GROUPS.get(block.kind, "")
        if block.kind == "step":
            source = report.sheet[block.of].source
            group = (
                f"the root of {source}: step {block.step}"
                if block.step
                else f"the root of {source}: {block.of}"
            )
        if group and group != before:
            style.text(sheet, _GROUP, block.place.column, group, "group")
        before = group


# --- the steps to a scalar root --------------------------------------------------------------------------


def write_steps(sheet: Any, style: Style, report: Report, grid: Grid) -> None:
    """Write the worksheet of the steps to the scalar roots: what comes before, then a row for each step."""
    says = "NumPy takes the same steps; here each of their quantities has a cell."
    style.page(sheet, "steps: how the scalar roots are found", says, [12])
    sheet.set_column(1, max(b.place.column for b in grid.on(STEPS)), 14)
    before = ""
    for block in grid.on(STEPS):
        place = block.place
        if block.of != before:
            column = report.sheet[block.of]
            title = f"{column.name}: {column.meaning}, the root of {column.source}"
            style.text(sheet, place.row - 1, 0, title, "section")
            before = block.of
        if block.step == 0:
            style.text(sheet, place.row, 0, block.title, "name")
            style.text(sheet, place.row, 2, block.meaning, "aside")
        else:
            if block.step == 1:
                style.text(sheet, place.row - 1, place.column, block.title, "head")
                sheet.write_comment(place.row - 1, place.column, block.meaning, {"x_scale": 2})
            style.text(sheet, place.row, 0, f"step {block.step}", "name")
        style.formula(
            sheet, place.row, place.column, block.formulas[0], block.values[0], style("step"), block.array
        )
    last = max(b.place.row for b in grid.on(STEPS))
    sheet.freeze_panes(0, 1)
    mark_errors(sheet, style, 0, 1, last, 1)


# --- the derivatives that are one number --------------------------------------------------------------------


def write_slopes(sheet: Any, style: Style, grid: Grid) -> None:
    """Write the worksheet of derivatives of results that are one number."""
    says = "In SI; those by rows stand behind the columns of their worksheets. The budgets multiply them."
    style.page(sheet, "derivatives: how results follow what was given", says, [44, 17, 60])
    for at, head in enumerate(("derivative", "value", "meaning")):
        style.text(sheet, 3, at, head, "head")
    for block in grid.on(SLOPES):
        row, column = block.place.row, block.place.column
        if column == 1:
            style.text(sheet, row, 0, block.title, "name")
            style.text(sheet, row, 2, block.meaning, "aside")
        style.formula(sheet, row, column, block.formulas[0], block.values[0], style("step"), block.array)
    sheet.freeze_panes(4, 1)
