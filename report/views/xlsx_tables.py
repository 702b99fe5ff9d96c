"""The worksheets of an axis' rows and of the steps to a scalar root."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from ..grid import FIRST_ROW, STEPS, Block, Grid, letters
from ..quantity import Bounds, Printed
from ..result import Report
from ..sheet import Axis, PairAxis, RepeatAxis
from .xlsx_style import Style, height, in_unit, number_format, number_text, open_format, said

__all__ = ["Inputs", "mark_errors", "write_axis", "write_block", "write_steps"]

_GROUP, _NAME, _MEANING, _SOURCE, _SYMBOL = range(FIRST_ROW - 5, FIRST_ROW)
_MOST_NOTES = 500
"""Cells of a column that get a note of their own; a longer one has it in its header only."""
_WIDTH, _STEP_WIDTH, _INDEX_WIDTH = 15.0, 13.0, 9.0
_SMALL = 1.15
"""How many small letters take the room of one."""
_GROUPS = {"drawn": "for the charts", "carried": "repeated for sums"}


class Inputs:
    """What a user may type: each given column's printed numbers, and what is allowed.

    Parameters
    ----------
    report : Report
    grid : Grid
    """

    def __init__(self, report: Report, grid: Grid) -> None:
        self.report = report
        self.bounds = {each.name: each.bounds for each in report.workbook.measured}
        self.bounds |= {each.name: each.bounds for each in report.workbook.parameters}
        self.counts = {axis.count: axis for axis in grid.axes.values() if isinstance(axis, RepeatAxis)}

    def allowed(self, block: Block) -> Bounds:
        """What is allowed, in the unit of the cells."""
        return in_unit(self.bounds.get(block.name, Bounds()), block.place.scale)

    def note(self, block: Block, row: int) -> str:
        """What a cell is, what it may be, and where it comes from."""
        printed = self.report.inputs.printed(block.name)[row]
        lines = [f"{block.name}: {block.meaning}."]
        if block.name in self.counts:
            lines.append(
                "It decides how many rows there are, so it is fixed here: change report.toml and build again."
            )
        else:
            lines.append(f"It must be {self.allowed(block)}, in {block.unit}.")
        source = printed.where.partition(":")[0]
        lines.append(
            f"Given as {printed.text} {printed.unit} in {printed.where}." if source else "The default."
        )
        return "\n".join(lines)

    def validation(self, block: Block, cell: str) -> dict[str, Any]:
        """What Excel is to accept in a cell; `cell` is its relative address."""
        bounds = self.allowed(block)
        message = f"{block.name} must be {bounds}, in {block.unit}."
        if block.name in self.counts:
            (printed,) = self.report.inputs.printed(block.name)
            bounds = Bounds(float(printed.value), float(printed.value))
            message = f"{block.name} decides how many rows there are: change report.toml and build again."
        tests = [f"ISNUMBER({cell})", *([f"{cell}=INT({cell})"] if bounds.integer else [])]
        if bounds.low is not None:
            tests.append(f"{cell}>{'' if bounds.low_open else '='}{number_text(bounds.low)}")
        if bounds.high is not None:
            tests.append(f"{cell}<{'' if bounds.high_open else '='}{number_text(bounds.high)}")
        return {
            "validate": "custom",
            "value": f"=AND({','.join(tests)})",
            "ignore_blank": False,
            "error_title": block.name[:32],
            "error_message": message[:255],
        }


# --- the cells of a block ----------------------------------------------------------------------------------


def write_block(
    sheet: Any, style: Style, report: Report, block: Block, inputs: Inputs, name: str = "number"
) -> None:
    """Write the cells of a block."""
    if block.kind == "given":
        _write_given(sheet, style, block, inputs)
        return
    place = block.place
    if block.kind == "index":
        for row, value in enumerate(block.values):
            sheet.write_number(place.row + row, place.column, value, style("index"))
        return
    form = style("step") if block.kind == "step" else style(name, _number_format(report, block))
    for row, (formula, value) in enumerate(zip(block.formulas, block.values, strict=True)):
        style.formula(sheet, place.row + row, place.column, formula, value, form, block.array)


def _number_format(report: Report, block: Block) -> str:
    shown = report.shown.get(block.of or block.name)
    return number_format(block.values, shown.digits if shown else 4)


def _write_given(sheet: Any, style: Style, block: Block, inputs: Inputs) -> None:
    printed, place = inputs.report.inputs.printed(block.name), block.place
    fixed = block.name in inputs.counts
    if not printed:
        for row, number in enumerate(block.values):
            sheet.write_number(place.row + row, place.column, number, style("fixed", "0"))
        return
    for row, each in enumerate(printed):
        at = (place.row + row, place.column)
        value = each.value / place.scale
        form = style("fixed" if fixed else "input", open_format(_decimals(each, place.scale)))
        sheet.write_number(*at, float(value), form)
        if row < _MOST_NOTES:
            sheet.write_comment(*at, inputs.note(block, row), {"x_scale": 2.2, "y_scale": 1.1})
    first = f"{letters(place.column)}{place.row + 1}"
    last_row = place.row + place.rows - 1
    sheet.data_validation(place.row, place.column, last_row, place.column, inputs.validation(block, first))


def _decimals(printed: Printed, scale: Fraction) -> int:
    """Decimals of a printed number in the unit of its cell."""
    return printed.decimals if printed.scale == scale else 0


# --- the worksheet of an axis ----------------------------------------------------------------------------


def write_axis(sheet: Any, name: str, style: Style, report: Report, grid: Grid, inputs: Inputs) -> None:
    """Write the worksheet that holds the rows of an axis."""
    axis, blocks = grid.axes[name], grid.on(name)
    main = [b for b in blocks if b.kind in ("given", "computed")] or list(blocks)
    style.text(sheet, 0, 0, f"{name}: {_described(axis)}", "title")
    if any(b.kind == "given" and b.place.row == FIRST_ROW for b in blocks):
        says = "Type over the yellow cells; all else follows. An empty one leaves its test out of all sums."
        style.text(sheet, 1, 0, says, "subtitle")
    for block in blocks:
        if block.place.row == FIRST_ROW:
            _write_header(sheet, style, report, block)
        else:
            style.text(sheet, block.place.row, 0, block.name, "subtitle")
        write_block(sheet, style, report, block, inputs)
    _write_groups(sheet, style, report, blocks)
    meanings = [(b.meaning, _SMALL * _width(b)) for b in blocks if b.place.row == FIRST_ROW]
    sheet.set_row(_MEANING, 0.82 * height(meanings, 2))
    sheet.set_row(_NAME, 20)
    indices = len([b for b in blocks if b.kind == "index"])
    sheet.freeze_panes(FIRST_ROW, indices)
    last, size = max(b.place.column for b in blocks), max(b.place.rows for b in blocks)
    mark_errors(sheet, style, FIRST_ROW, 0, FIRST_ROW + size - 1, last)
    sheet.ignore_errors({"formula_differs": f"A1:{letters(last)}{FIRST_ROW + size}"})
    sheet.set_landscape()
    sheet.set_paper(9)
    sheet.fit_to_pages(1, 0)
    sheet.repeat_rows(_NAME, _SYMBOL)
    sheet.print_area(0, 0, FIRST_ROW + size - 1, max(b.place.column for b in main))


def mark_errors(
    sheet: Any, style: Style, first_row: int, first_column: int, last_row: int, last_column: int
) -> None:
    """Show the codes of errors in red, wherever they appear."""
    rule = {"type": "text", "criteria": "begins with", "value": "#", "format": style("error")}
    sheet.conditional_format(first_row, first_column, last_row, last_column, rule)


def _described(axis: Axis) -> str:
    if isinstance(axis, PairAxis):
        return f"every pair {axis.first} < {axis.second} of {axis.of.name}"
    if isinstance(axis, RepeatAxis):
        return f"{axis.step} = 1, 2, ... {axis.count} for each of {axis.of.name}"
    return "one row each"


def _width(block: Block) -> float:
    if block.kind == "index":
        return _INDEX_WIDTH
    if block.kind == "step":
        return _STEP_WIDTH
    return max(_WIDTH, 1.15 * len(block.name) + 6)


def _write_header(sheet: Any, style: Style, report: Report, block: Block) -> None:
    at = block.place.column
    options = {"level": 1} if block.kind in ("step", "carried") else {}
    sheet.set_column(at, at, _width(block), None, options)
    unit = said(block.unit) if block.kind not in ("index", "step") else ""
    style.text(sheet, _NAME, at, block.title + unit, "head")
    style.text(sheet, _MEANING, at, block.meaning, "meaning")
    column = report.sheet.by_name.get(block.name)
    style.text(sheet, _SOURCE, at, block.source, "source")
    if column is not None and column.latex:
        style.symbol(sheet, _SYMBOL, at, column.latex)
    else:
        style.text(sheet, _SYMBOL, at, "", "symbol")


def _write_groups(sheet: Any, style: Style, report: Report, blocks: Sequence[Block]) -> None:
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
    style.text(sheet, 0, 0, "steps: how the scalar roots are found", "title")
    style.text(
        sheet,
        1,
        0,
        "Every engine takes the same steps; here each of their quantities has a cell.",
        "subtitle",
    )
    sheet.set_column(0, 0, 12)
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
    sheet.set_landscape()
    sheet.set_paper(9)
    sheet.fit_to_pages(1, 0)
    sheet.freeze_panes(0, 1)
    mark_errors(sheet, style, 0, 1, last, 1)
