"""The worksheets for reading: the result and the scalars, the published values, the equations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from ...derivations.proved import IDENTITY
from ..cells.grid import CHECKED, MOST_RESULTS, SCALARS, TOP, CellBlock, Grid, checked, letters
from ..document.material import Material
from ..result.result import Comparison, Report
from ..result.statements import statements
from .json import proof_grounds, proof_statuses
from .xlsx_inputs import GivenCells
from .xlsx_marks import TITLE, counted
from .xlsx_style import Style, height, number_format
from .xlsx_tables import mark_errors, write_block

_RESULT, _WITH_U = "Result", "with its uncertainty"
Stated = Mapping[str, tuple[str, str]]
"""By cell, the formula that names its statement with its uncertainty, and what that says."""

# --- the result and the scalars -----------------------------------------------------------------------------


def write_report(
    sheet: Any, style: Style, report: Report, grid: Grid, inputs: GivenCells, stated: Stated
) -> None:
    """Write the first worksheet: what came out, what went in, how to use the workbook."""
    scalars = grid.on(SCALARS, "given", "computed", "margin")
    names = max([18, *(1.15 * len(block.name) for block in scalars)])
    style.page(sheet, report.title, report.workbook.title, (names, 17, 15, 52, 12, 10, 36, 22))
    style.formula(sheet, 2, 0, inputs.summary(), "", style("error"))
    groups = list(_groups(scalars))
    row = 2  # of what is told there, if there are no scalars
    if not groups or _title(report, groups[0]) != _RESULT:
        row = max(row, _write_results_in_rows(sheet, style, report, grid, TOP - 4, stated))
    for group in groups:
        row, given = group[0].place.row, group[0].kind == "given"
        # Beside what is given stands its check. Over which rows a result is may be long: it comes last.
        said = not given and any(block.name in stated for block in group)
        style.section(sheet, row - 2, _title(report, group), 8 if said else 7)
        last = ("as checked", "check") if given else (*(_WITH_U,) * said, "computed from")
        for at, head in enumerate(("name", "value", "unit", "meaning", "equation", "symbol", *last)):
            style.text(sheet, row - 1, at, head, "head")
        for block in group:
            row = block.place.row
            _write_scalar(sheet, style, report, grid, block, inputs, CHECKED + said)
            if said:
                _write_statement(sheet, style, stated, block.name, row, CHECKED)
        if _title(report, group) == _RESULT:
            row = _write_results_in_rows(sheet, style, report, grid, row, stated)
    _write_notes(sheet, style, report, grid, row + 2)
    for column in (1, CHECKED, CHECKED + 1):
        mark_errors(sheet, style, 0, column, row, column)
    sheet.hide_gridlines(2)


def _groups(blocks: Sequence[CellBlock]) -> Iterator[list[CellBlock]]:
    """Blocks that stand one below the other."""
    group: list[CellBlock] = []
    for block in blocks:
        if group and block.place.row != group[-1].place.row + 1:
            yield group
            group = []
        group.append(block)
    if group:
        yield group


def _title(report: Report, group: Sequence[CellBlock]) -> str:
    if group[0].name in report.workbook.headline:
        return _RESULT
    return {"given": "Given", "margin": TITLE}.get(group[0].kind, "On the way")


def _write_scalar(
    sheet: Any, style: Style, report: Report, grid: Grid, block: CellBlock, inputs: GivenCells, last: int
) -> None:
    column, row = report.marks.values.sheet[block.name], block.place.row
    style.text(sheet, row, 0, block.name, "name")
    write_block(
        sheet, style, report, block, inputs, "result" if block.name in report.workbook.headline else "number"
    )
    style.text(sheet, row, 2, block.unit, "unit")
    style.text(sheet, row, 3, block.meaning, "wrapped")
    style.text(sheet, row, 4, column.source, "text")
    if block.name in report.sheet:
        style.symbol(sheet, row, 5, column.latex or column.name, "text")
    sheet.set_row(row, height([(block.meaning, 52)]))
    if block.kind == "given":
        style.formula(sheet, row, CHECKED + 1, inputs.told([block]), "ok", style("aside"))
        write_block(sheet, style, report, grid[checked(block.name)], inputs)
    if block.kept:
        formula, value = counted(report, grid, block)
        style.formula(sheet, row, last, formula, value, style("text"), array=True)


def _write_statement(sheet: Any, style: Style, stated: Stated, cell: str, row: int, column: int) -> None:
    """Write a result with its uncertainty, if that is known, as its budget has it."""
    if cell in stated:
        style.formula(sheet, row, column, *stated[cell], style("text"))


def _write_results_in_rows(
    sheet: Any, style: Style, report: Report, grid: Grid, row: int, stated: Stated
) -> int:
    """Show results that other worksheets compute, one for each group, say; return the last row."""
    named = [report.sheet[name] for name in report.workbook.headline if name in report.sheet]
    for column in named:
        if column.axis is None or grid[column.name].place.rows > MOST_RESULTS:
            continue
        block, row = grid[column.name], row + 2
        style.section(sheet, row, f"Result: {block.meaning}", 7)
        for own, figure in enumerate(report.figures(column.name)):
            row, cell = row + 1, report.values.address(column.name, own)
            style.text(sheet, row, 0, cell, "name")
            _write_statement(sheet, style, stated, cell, row, 3)
            form = style("result", number_format(figure))
            style.formula(sheet, row, 1, f"={block.place.cell(own)}", block.values[own], form)
            style.text(sheet, row, 2, block.unit, "unit")
            style.text(sheet, row, 4, column.source, "text")
    return row


def _write_notes(sheet: Any, style: Style, report: Report, grid: Grid, row: int) -> None:
    given = list(
        dict.fromkeys(b.place.worksheet for b in grid.blocks if b.kind == "given" and b.name in report.sheet)
    )
    columns = report.sheet.columns
    counts = sorted({axis.repeats for axis in grid.axes.values() if axis.repeats} & set(report.shown))
    odd = [f"{check.word.capitalize()}: {check.message}." for check in report.oddities if check.word]
    (example, *_) = *(name for name in report.workbook.headline if name in report.sheet), columns[-1].name
    rows = " or ".join(
        f"an {axis.row}" if axis.row[0].lower() in "aeiou" else f"a {axis.row}"
        for axis in report.sheet.axes
        if axis.is_given
    )
    rows = rows or "a row"
    notes = [
        f"Inputs are the yellow cells, on {' and '.join(given)}. Type over them: every other number follows, "
        "in any spreadsheet program that recalculates.",
        "Every computed cell is a formula made from the proved equation that its row or header names. "
        f"Names such as ls_{example} stand for whole columns.",
        "A cell that cannot be computed shows a code: #INPUT! a datum is missing or is not what it may be "
        "(the column check says what is wrong, however it came into its cell), #DOMAIN! outside the "
        "equation's domain, #NOROOT! no value satisfies it, #TWOROOTS! several do, #OVERFLOW! there is a "
        "value, but it or a step towards it is too large or too small for any cell, #STEPS! the steps of "
        "this workbook do not reach the root (the page goes on until it is reached), "
        "#UNDECIDED! the number of roots is not certain; where it was counted for the inputs as issued, and "
        "they were changed since, build the report again. "
        "What depends on such a cell shows its code; a sum leaves such rows out and says from how many it "
        "was made.",
        "Numbers are stored in full; only what is shown is rounded, as its uncertainty as issued has it. "
        "Uncertainties follow an edit to first order: terms of second order are those of the inputs as "
        "issued, and count from 5 % of a variance on.",
        f"How many rows there are, and which, is fixed in this workbook: to add {rows}"
        + (f" or change {' or '.join(counts)}" if counts else "")
        + f", build the report again. To leave {rows} out, empty one of its cells. Do not sort the rows: "
        "groups, limits and shared errors go by the rows as issued. One with another number, name or group "
        "is told in the column check"
        + (", and nothing is computed from one of another group." if grid.groups else "."),
        *([f"Source: {report.workbook.source}."] if report.workbook.source else []),
        "Computed with " + ", ".join(f"{name} {version}" for name, version in report.versions.items()) + ".",
    ]
    known = [f"{name}: {said}." for name, said in statements(report)]
    doubts = [f"{name}: {said}." for name, said in report.uncertain().advice.items()]
    parts = (
        ("The data as they were given", odd),
        ("Stated uncertainties", known),
        ("How sure the results are", doubts),
        ("How to use it", notes),
    )
    for title, lines in parts:
        if lines:
            row = _write_lines(sheet, style, row, title, lines) + 2


def _write_lines(sheet: Any, style: Style, row: int, title: str, lines: Sequence[str]) -> int:
    """Write sentences below a title; return the row of the last one."""
    style.section(sheet, row, title, 7)
    for line in lines:
        row += 1
        style.sentence(sheet, row, line, 7, 155)
    return row


# --- the published values ----------------------------------------------------------------------------------

_PUBLISHED = (
    ("source", 12, "where it is printed"),
    ("cell", 14, "the cell that it is a value of"),
    ("index", 8, "which row"),
    ("unit", 8, "as printed"),
    ("printed", 12, "with the digits as printed"),
    ("recomputed", 14, "the workbook's own cell, in the printed unit"),
    ("difference", 12, "recomputed minus printed"),
    ("in last digits", 12, "the difference, in units of the last printed digit"),
    ("verdict", 15, "whether it prints the same"),
    ("expected", 11, "a difference that is known"),
    ("known", 14, "what it is known to differ to"),
    ("as expected", 11, "no: a finding"),
    ("reason", 70, "why a difference is expected"),
)


def write_published(sheet: Any, style: Style, report: Report, grid: Grid) -> None:
    """Write every published value beside its live recomputation."""
    says = "The recomputed values are live: edit an input and see whether the print is met."
    says += " What is recomputed of uncertainties, at the end, is as issued." * bool(report.comparisons_u)
    widths = (width for _, width, _ in _PUBLISHED)
    style.page(sheet, "published: printed values beside their recomputation", says, widths)
    for at, (head, _, meaning) in enumerate(_PUBLISHED):
        style.text(sheet, 3, at, head, "head")
        style.text(sheet, 4, at, meaning, "meaning")
    sheet.set_row(4, 0.85 * height([(meaning, width) for _, width, meaning in _PUBLISHED]))
    for row, comparison in enumerate(report.comparisons, start=5):
        _write_comparison(sheet, style, report, grid, row, comparison)
    last = 4 + len(report.comparisons)
    if report.comparisons:
        mark_errors(sheet, style, 5, 5, last, 5)
        sheet.autofilter(3, 0, last, len(_PUBLISHED) - 1)
    if report.comparisons_u:
        _write_published_u(sheet, style, report, last + 2)
        last += 2 + len(report.comparisons_u)
    finding = {"type": "cell", "criteria": "==", "value": '"no"', "format": style("finding")}
    sheet.conditional_format(5, 11, last, 11, finding)
    sheet.freeze_panes(5, 3)
    sheet.repeat_rows(3, 4)


def _write_comparison(
    sheet: Any, style: Style, report: Report, grid: Grid, row: int, comparison: Comparison
) -> None:
    value, cell = comparison.published, comparison.cell
    given = grid[value.cell].kind == "given"
    printed, place = value.printed, grid[checked(value.cell) if given else value.cell].place
    for at, words in enumerate((value.source, value.cell, value.row, printed.unit)):
        style.text(sheet, row, at, words)
    decimals = printed.decimals
    shown = style("number", f"0.{'0' * decimals}" if decimals > 0 else "0")
    sheet.write_number(row, 4, float(printed.number), shown)
    address = place.cell(report.values.row(report.sheet[value.cell], value.index))
    cells = {name: f"${letters(column)}${row + 1}" for column, (name, _, _) in enumerate(_PUBLISHED)}
    again = None if cell.value is None else printed.of(cell.value)
    shown_in = replace(
        place, scale=place.scale / printed.scale, zero=(place.zero - printed.zero) / printed.scale
    )
    again_of = shown_in.to_si(address)
    live = f"=IF(ISNUMBER({address}),{again_of},{address})"
    style.formula(sheet, row, 5, live, cell.status.code if again is None else again, shown)
    difference = "" if again is None else again - float(printed.number)
    live = f'=IF(ISNUMBER({cells["recomputed"]}),{cells["recomputed"]}-{cells["printed"]},"")'
    style.formula(
        sheet, row, 6, live, difference, style("number", _signed(f"0.{'0' * max(0, decimals + 1)}"))
    )
    unit = f"*{10**decimals}" if decimals >= 0 else f"/{10**-decimals}"
    live = f'=IF(ISNUMBER({cells["difference"]}),{cells["difference"]}{unit},"")'
    distance = "" if comparison.distance is None else comparison.distance
    style.formula(sheet, row, 7, live, distance, style("number", _signed("0.0")))
    shortened = f"ROUND({cells['recomputed']},{decimals})"
    if printed.mode == "truncated":  # in the 15 digits that a double keeps: 29.7 is not cut to 29.6
        shortened = f"TRUNC(ROUND({cells['recomputed']},{15 - printed.digits + decimals}),{decimals})"
    shortened = shortened.replace(",-", ",0-")
    same = f"{shortened}={cells['printed']}"
    live = f'=IF(ISNUMBER({cells["recomputed"]}),IF({same},"same","differs"),"not-checkable")'
    style.formula(sheet, row, 8, live, comparison.verdict, style("unit"))
    style.text(sheet, row, 9, value.expect or "same")
    _write_expected(sheet, style, row, comparison, cells, shortened)
    style.text(sheet, row, 12, value.reason, "wrapped")
    sheet.set_row(row, height([(value.reason, 70)]))


def _write_published_u(sheet: Any, style: Style, report: Report, row: int) -> None:
    """Write what is published of uncertainties beside what was computed, below the values."""
    said = "Published uncertainties, as issued: no cells of the sheet, they do not follow an edit."
    style.text(sheet, row, 0, said, "head")
    for line, one in enumerate(report.comparisons_u, start=row + 1):
        value, printed = one.published, one.published.printed
        style.text(sheet, line, 0, value.source)
        style.text(sheet, line, 1, one.cell.address)
        style.text(sheet, line, 3, printed.unit)
        style.text(sheet, line, 4, printed.text)
        style.text(sheet, line, 5, one.again)
        style.text(sheet, line, 8, one.word, "unit")
        style.text(sheet, line, 9, value.expect or "same")
        style.text(sheet, line, 10, value.pin.again if value.pin else "")
        style.text(sheet, line, 11, "yes" if one.as_expected else "no")
        style.text(sheet, line, 12, value.reason, "wrapped")
        sheet.set_row(line, height([(value.reason, 70)]))


def _write_expected(
    sheet: Any, style: Style, row: int, comparison: Comparison, cells: Mapping[str, str], again: str
) -> None:
    """Write what it is known to differ to and whether it does; `again` is the recomputed value as printed."""
    known, even_so = comparison.known
    verdict = cells["verdict"]
    yes = '"no"' if even_so else '"yes"'
    if known is None:
        live = f'=IF({verdict}="same","yes",IF({verdict}="differs",{yes},"no"))'
    elif known[:1] in {"", "#"}:  # no number: a code, or nothing that would do
        style.text(sheet, row, 10, known)
        live = f'=IF({cells["recomputed"]}={cells["known"]},{yes},"no")' if known else '="no"'
    else:
        sheet.write_number(row, 10, float(known), style("number", "General"))
        live = f'=IF({verdict}="differs",IF({again}={cells["known"]},{yes},"no"),"no")'
    style.formula(sheet, row, 11, live, "yes" if comparison.as_expected else "no", style("text"))


def _signed(form: str) -> str:
    """A number format that shows the sign, be it a plus."""
    return f"+{form};-{form};0"


# --- the equations -----------------------------------------------------------------------------------------

_EQUATIONS = (
    ("number", 10),
    ("title", 34),
    ("claim", 78),
    ("status", 16),
    ("rests on", 34),
    ("why it holds", 60),
)


def write_equations(sheet: Any, style: Style, report: Report) -> None:
    """Write every equation with what is known of it."""
    says = "Numbers that begin with L are not the source's own."
    widths = (width for _, width in _EQUATIONS)
    style.page(sheet, "equations: what the formulas are made from", says, widths)
    for at, (head, _) in enumerate(_EQUATIONS):
        style.text(sheet, 3, at, head, "head")
    material, statuses, grounds = Material(report), proof_statuses(report), proof_grounds(report)
    for row, equation in enumerate(report.ledger.equations(), start=4):
        own = material.written(equation)
        claim = own.text
        if own.where:
            claim += "\nwhere " + ", ".join(own.where)
        cells = (
            equation.label,
            equation.title,
            claim,
            statuses.get(equation.label, "not checked"),
            "; ".join(grounds[equation.label]) or IDENTITY if equation.label in grounds else "",
            equation.because,
        )
        for at, words in enumerate(cells):
            style.text(sheet, row, at, words, "wrapped" if at else "name")
        sheet.set_row(
            row, height([(words, width) for words, (_, width) in zip(cells, _EQUATIONS, strict=True)])
        )
    sheet.freeze_panes(4, 1)
    sheet.repeat_rows(3)
