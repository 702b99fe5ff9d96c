"""What may be typed into the workbook: the given cells, what they may be, and what is said where not.

Excel's own validation sees what is typed, and nothing that is pasted, filled down or put in by a program. So
it only comes first: no formula names a given cell but the one that checks it, and that tells what it found.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

from ..cells.grid import FIRST_ROW, SCALARS, CellBlock, Grid, Place, checked, letters
from ..cells.values import CODES, Status
from ..quantity import Printed, behind
from ..result.result import Report
from .xlsx_style import Style, number_format, open_format, said

_MOST_NOTES = 500
"""Cells of a column that get a note of their own; a longer one has it in its header only."""
_BELOW = 1000
"""Rows below the last one in which numbers are looked for that are in no formula."""
_LONGEST = 255
"""Characters of a text in a formula; Excel takes no more."""
_LARGEST = 1e90
"""Of a larger number no cell holds the third power, times that of its row."""
_SAME = 1e-12
"""How far, of the sum of its terms, a sum may be off by rounding: that of a thousand terms is off by less."""
_NONE = 1e-12
"""Of an uncertainty, what is left of it besides a share is this small where nothing is."""
_ROWS_TOLD = FIRST_ROW - 5
"""The row, from 0, of the cell that says whether the rows are those that the formulas are for."""
_CODE, _FINE = CODES[Status.INPUT], "ok"
_MOVED = f"{_CODE} not the row as issued: its number, name or group is another one"
"""What a row is told that was sorted to here, or whose words were edited."""
_ORDER = f"{_CODE} rows that are not those as issued, by which groups, limits and errors go: "
"""What is told above all of them, with their number."""
_SORTED = " has its numbers as issued in another order: what else belongs to a row stays where it was. "
"""What is told there of a column that was sorted."""


class GivenCells:
    """The given cells: each column's printed numbers, what is allowed, and what is refused."""

    def __init__(self, report: Report, grid: Grid) -> None:
        self.report, self.grid = report, grid
        self.counts = {axis.repeats for axis in grid.axes.values() if axis.repeats}

    def allowed(self, block: CellBlock) -> str:
        """What a cell must be, as a sentence without its full stop."""
        if block.name in self.counts:
            return f"{block.name} decides how many rows there are: change report.toml and build again"
        return f"{block.name} must be {block.bounds}{behind(block.unit)}"

    # --- cells

    def write(self, sheet: Any, style: Style, block: CellBlock) -> None:
        """Write the given cells of a column, with what Excel is to accept in them."""
        printed, place = self.report.inputs.printed(block.name), block.place
        fixed = block.name in self.counts
        if not printed:
            shares = self.shares.get(block.name)
            # Of an empty cell there is no uncertainty: a code.
            numbers = [None if isinstance(number, str) else number for number in block.values]
            whole = all(number is None or number.is_integer() for number in numbers)
            figures = [None] * len(numbers) if whole else self.report.figures(block.name)
            for row, (number, figure) in enumerate(zip(numbers, figures, strict=True)):
                at, formula = (place.row + row, place.column), shares[row] if shares else ""
                form = style("fixed", "0" if whole else number_format(figure))
                if formula:
                    style.formula(sheet, *at, formula, number, form)
                else:
                    sheet.write(*at, number, form)
            return
        for row, each in enumerate(printed):
            at = (place.row + row, place.column)
            if each is None:
                sheet.write_blank(*at, None, style("input"))
            else:
                form = style("fixed" if fixed else "input", as_printed(self.report, block, row))
                sheet.write_number(*at, _number(each, place), form)
            if row < _MOST_NOTES:
                sheet.write_comment(*at, self.note(block, each), {"x_scale": 2.2, "y_scale": 1.1})
        every = (place.row, place.column, place.row + place.rows - 1, place.column)
        sheet.data_validation(*every, self.validation(block))
        refused = {"type": "formula", "criteria": f"={self._refused(block)}".replace("$", "")}
        sheet.conditional_format(*every, refused | {"format": style("finding")})

    @cached_property
    def shares(self) -> dict[str, list[str]]:
        """The formulas of the standard uncertainties that rows are weighed by, by column: see `_of_share`."""
        weighed = self.report.sheet.weighed
        return {
            block.name: [self._of_share(block, row) for row in range(block.place.rows)]
            for block in self.grid.blocks
            if block.name in weighed and block.kind == "given"
        }

    def _of_share(self, block: CellBlock, row: int) -> str:
        """The formula of a standard uncertainty of which a share of its number is a part; of others nothing.

        As issued it is what it was: what is weighed by it has the same digits.
        """
        inputs, of, u = self.report.inputs, self.report.sheet.weighed[block.name], block.values[row]
        printed, number = inputs.printed(of)[row], self.grid[checked(of)].place
        if printed is None or not isinstance(u, float) or number.zero or of in inputs.taken:
            return ""
        cell, terms = number.cell(row, block.place.worksheet), list[str]()
        for error in printed.stated or ():
            said = inputs.uncertainty.again(error.said, printed.unit, error.shape)
            if said is None or error.law is not None:  # where it is cut off, its width is another one
                return ""
            scales = float(number.scale), float(block.place.scale)
            terms.append(
                share_of(said.parts[0].share, float(printed.value), error.u, f"ABS({cell})", *scales)
            )
        if not any("ABS" in term for term in terms):
            return ""
        told = terms[0] if len(terms) == 1 else f"SQRT(SUMSQ({','.join(filter(None, terms))}))"
        return f"=IF(ISNUMBER({cell}),IF({cell}={_number(printed, number)!r},{u!r},{told}),{u!r})"

    def note(self, block: CellBlock, printed: Printed | None) -> str:
        """What a cell is, what it may be, and where its number comes from, if it has one."""
        if printed is None:
            return f"{block.name}: {block.meaning}.\n{self.allowed(block)}.\nNone is given."
        given = (
            f"Given as {printed.text} {printed.unit} in {printed.where}." if printed.where else "The default."
        )
        if printed.stated and block.name in self.report.inputs.taken:
            given = f"Taken {printed.stated[0].said}."
        told = [f"{block.name}: {block.meaning}.", f"{self.allowed(block)}.", given]
        if printed.stated is not None:
            u = self.report.sure(block.name, printed.u).text
            told.append(f"Its stated standard uncertainty is {u}{behind(printed.unit)}.")
        return "\n".join(told)

    def validation(self, block: CellBlock) -> dict[str, Any]:
        """What Excel is to accept in the cells of a column."""
        return {
            "validate": "custom",
            "value": f"={block.guard.format(block.place.cell(0, block.place.worksheet).replace('$', ''))}",
            "ignore_blank": False,
            "error_title": block.name[:32],
            "error_message": f"{self.allowed(block)}."[:_LONGEST],
        }

    # --- what is told beside the cells

    def write_told(self, sheet: Any, style: Style, blocks: Sequence[CellBlock], note: Place) -> None:
        """Write beside each row which of its given cells are refused, and above all what became of rows."""
        for row in range(note.rows):
            told = self.told(blocks, row, self._same(note, row))
            style.formula(sheet, note.row + row, note.column, told, _FINE, style("aside"))
        style.formula(sheet, _ROWS_TOLD, 0, self._rows(blocks, note), "", style("error"))

    def write_left_out(self, sheet: Any, style: Style, blocks: Sequence[CellBlock], note: Place) -> int:
        """Write those that are left out below, as texts that no formula counts; how many rows that takes."""
        table = self.report.inputs.on(self.grid.axes[note.worksheet].name)
        if not (left_out := table.left_out):
            return 0
        first = note.row + note.rows + 1
        style.text(sheet, first, 0, "left out, and in no formula:", "subtitle")
        for row, each in enumerate(left_out, start=first + 1):
            style.text(sheet, row, 0, str(each.test), "index")
            for block in (block for block in blocks if block.name in each.texts):
                text, unit = each.texts[block.name], table.header_units[block.name]
                style.text(sheet, row, block.place.column, text + said(unit), "aside")
            words = self.grid.words.get(note.worksheet, ())
            for place, name in zip(words, table.remarks, strict=False):
                style.text(sheet, row, place.column, each.texts[name], "aside")
            style.text(sheet, row, note.column, each.reason, "aside")
        return 2 + len(left_out)

    def told(self, blocks: Sequence[CellBlock], row: int = 0, same: Sequence[str] = ()) -> str:
        """The formula that tells whether a row is another one, else which of its given cells are refused."""
        refused = [self._refused(block, row) for block in blocks]
        told = [
            f'IF({test},{_text(f"{self.allowed(block)}. ")},"")'
            for test, block in zip(refused, blocks, strict=True)
        ]
        moved = f"IF(NOT(AND({','.join(same)})),{_text(_MOVED)}," if same else ""
        return f'={moved}IF(OR({",".join(refused)}),"{_CODE} "&{"&".join(told)},"{_FINE}"){")" * bool(same)}'

    def _numbers(self, note: Place) -> list[CellBlock]:
        """The numbers of the rows."""
        return [block for block in self.grid.on(note.worksheet, "index") if block.place.rows == note.rows]

    def _same(self, note: Place, row: int) -> list[str]:
        """What says that a row is the one as issued: its number, its name, and the words of its groups."""
        here, words = note.worksheet, self.grid.words.get(note.worksheet, ())
        same = [f"{block.place.cell(row, here)}={block.values[row]:.0f}" for block in self._numbers(note)]
        grouped = self.grid.groups.get(here, ())
        same += [
            each.same(each.own.cell(row, here), each.group.cell(each.rows[row], here)) for each in grouped
        ]
        axis = self.grid.axes[here]
        if not axis.is_given:
            return same
        table = self.report.inputs.on(axis.name)
        for place, name in zip(words, table.remarks, strict=False):
            if name in table.naming and place not in [each.own for each in grouped]:
                word = table.texts[table.tests[row]][name][:_LONGEST]
                same.append(f"EXACT(LEFT({place.cell(row, here)},{_LONGEST}),{_text(word)})")
        return same

    def _refused(self, block: CellBlock, row: int = 0) -> str:
        """The formula, without its equals sign, that says whether a given cell is refused."""
        place = self.grid[checked(block.name)].place
        return f"NOT(ISNUMBER({place.cell(row, place.worksheet)}))"

    def _rows(self, blocks: Sequence[CellBlock], note: Place) -> str:
        """The formula that tells of rows that were put in, taken out, moved or written below the last."""
        columns, first = [block.place.column for block in blocks], note.row + note.rows + 1
        below = f"${letters(min(columns))}${first}:${letters(max(columns))}${first + _BELOW - 1}"
        where = f"{_CODE} the formulas are for {note.rows} rows"
        again = "change the file of the measurements and build again"
        moved = _text(f"{where}, and some were put in or taken out: {again}")
        more = _text(f"{where}, and there are numbers below them: {again}")
        notes = note.range(note.worksheet)
        others = f"COUNTIF({notes},{_text(_MOVED)})"
        order = f"{_text(_ORDER)}&{others}&{_text(f'; {again}')}"
        each = (
            f'IF({self._sorted(block, number)},{_text(block.name + _SORTED)},"")'
            for block in blocks
            for number in self._numbers(note)
            if self.report.inputs.printed(block.name)
        )
        alone = "&".join(each) or '""'
        told = f"IF({others}>0,{order},IF(COUNT({below})>0,{more},{alone}))"
        return f"=IF(ROWS({notes})<>{note.rows},{moved},{told})"

    def _sorted(self, block: CellBlock, numbers: CellBlock) -> str:
        """What says that a column has its numbers as issued, but not where they were.

        Its sums of powers are as issued, and those of their products with the numbers of the rows are not;
        the first of these alone is the same of 1, 3, 2 and of 2, 1, 3.
        """
        place, printed = block.place, self.report.inputs.printed(block.name)
        issued = [_number(each, place) if each else 0.0 for each in printed]
        if max(map(abs, issued), default=0.0) > _LARGEST:
            return "FALSE"
        cells = self.grid[checked(block.name)].place.range(place.worksheet)

        def as_issued(power: int, at: Sequence[float], *beside: str) -> str:
            terms = [row * number**power for row, number in zip(at, issued, strict=True)]
            told = ",".join((*[cells] * power, *beside))
            return same_sum(told, terms)

        same = [as_issued(power, [1.0] * len(issued)) for power in (1, 2, 3)]
        rows = numbers.place.range(place.worksheet)
        of_rows = [number for number in numbers.values if isinstance(number, float)]
        where = [as_issued(power, of_rows, rows) for power in (1, 2)]
        # Where a number is so large that its cube is none, it is not one that was issued.
        return f"IFERROR(AND({','.join(same)},NOT(AND({','.join(where)}))),FALSE)"

    def summary(self) -> str:
        """The formula that tells on the first worksheet whether anything given is refused."""
        given = [b for b in self.grid.blocks if b.kind == "checked" and b.of in self.report.sheet]
        ranges = [block.place.range(SCALARS) for block in given]
        number = "+".join(f"ROWS({cells})-COUNT({cells})" for cells in ranges)
        refused = f'"{_CODE} given cells that are refused: "&{number}&". "'
        rows = [Place(worksheet, _ROWS_TOLD, 0).cell(0, SCALARS) for worksheet in self.grid.notes]
        return "=" + "&".join([f'IF({number}>0,{refused},"")', *rows])


def _number(printed: Printed, place: Place) -> float:
    """A printed number in the unit of its cell."""
    return float((printed.value - place.zero) / place.scale)


def share_of(share: float, value: float, u: float, size: str, scale: float, unit: float) -> str:
    """The formula of a standard uncertainty of which a share of a number is a part, the rest is a number.

    Parameters
    ----------
    share, value, u : float
        The share, the number and the standard uncertainty, in SI.
    size : str
        The formula of the size of the number.
    scale, unit : float
        The units of the number in its cell, and of the formula, in SI.
    """
    fixed = u - share * abs(value)
    more = f"{fixed / unit:+.15g}" if abs(fixed) > _NONE * u else ""
    return f"{share * (scale / unit):.15g}*{size}{more}" if share else more


def same_sum(told: str, terms: Sequence[float]) -> str:
    """The formula that says whether a sum of products of cells is that of some numbers."""
    return f"ABS(SUMPRODUCT({told})-({sum(terms)!r}))<={_SAME * sum(map(abs, terms))!r}"


def as_printed(report: Report, block: CellBlock, row: int) -> str:
    """A number format with as many decimals as a given number has, or more where more are typed."""
    printed, value = report.inputs.printed(block.name), block.values[row]
    number = value if isinstance(value, float) else 0.0
    if block.name in report.inputs.taken:
        return open_format(-report.places(block.name)[row], number)
    each = printed[row] if printed else None
    # In another unit than that of its cell it has other decimals.
    return open_format(each.decimals if each and each.scale == block.place.scale else 0, number)


def _text(words: str) -> str:
    """A text in a formula."""
    return '"' + words[:_LONGEST].replace('"', '""') + '"'
