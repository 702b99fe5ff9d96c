"""A workbook in the hands of its users: inputs are edited in the delivered file, other programs recalculate.

The stored values are left in it, stale, so that a reader that recalculates nothing is found out.
"""

import io
import re
import subprocess
import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numpy as np
from uncertain_data import MISFITS, lost_to_differences

from loopsheet.report import stages
from loopsheet.report.cells.grid import Grid, checked
from loopsheet.report.cells.layout import evenly
from loopsheet.report.cells.values import CODES, Status, Values
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.certified import certified
from loopsheet.report.engines.excel_loops import pass_name, passes_of
from loopsheet.report.engines.excel_values import STAYS, with_passes
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.judge.readers import ALWAYS_RECALCULATE
from loopsheet.report.result.result import Report
from loopsheet.report.sheet import Column, Given, RepeatAxis, Root, Sheet
from loopsheet.report.study import Study


class Error(str):
    """An error of Excel's, such as ``#DIV/0!``."""


Typed = float | str | bool | Error | None
Edits = Mapping[tuple[str, int], Typed]
"""What is typed: by column and row (from 0), a number in the cell's unit, a text, or None for nothing."""

Cells = dict[str, dict[str, dict[str, Any]]]
"""Values of workbooks, by name, worksheet and address."""
Recalculate = Callable[[Mapping[str, bytes]], Cells]

LARGEST = 1e-12
"""Largest difference, relative to the cell or to a millionth of its column's largest."""


@dataclass(frozen=True)
class Delivered:
    """A report as its workbook."""

    report: Report
    grid: Grid
    content: bytes

    @cached_property
    def whole(self) -> Sheet:
        """The sheet with its margins and what the charts draw."""
        drawn = self.grid.drawn.columns if self.grid.drawn else ()
        return Sheet((*self.report.marks.values.sheet.columns, *drawn))

    @cached_property
    def program(self) -> engine.Program:
        return engine.Program.of(self.whole)

    @cached_property
    def every(self) -> dict[str, Column]:
        """The columns that have cells, passes among them, each with the column that has its rule."""
        found = {column.name: column for column in self.whole.columns}
        passes = passes_of(self.report.sheet, self.grid.passes)
        return found | {name: found[each.rule] for name, each in passes.items()}

    def edited(self, edits: Edits) -> bytes:
        """The delivered file after somebody typed into it, everything else as it was stored."""
        return typed(self.content, self.cells(edits))

    def cells(self, edits: Edits) -> dict[str, dict[str, Typed]]:
        """What is typed, by worksheet and address."""
        by_sheet: dict[str, dict[str, Typed]] = {}
        for (name, row), value in edits.items():
            place = self.grid[name].place
            by_sheet.setdefault(place.worksheet, {})[place.cell(row, place.worksheet).replace("$", "")] = (
                value
            )
        return by_sheet

    def values(self, edits: Edits) -> Values:
        """What the NumPy engine makes of the same inputs; as many rows as there are, or none at all."""
        data: dict[str, Any] = {}
        for column in self.whole.columns:
            if isinstance(column.rule, Given):
                block = self.grid[column.name]
                cells: list[Any] = [self._given(column.name, row) for row in range(block.place.rows)]
                for (name, row), value in edits.items():
                    if name == column.name:
                        cells[row] = value
                numbers = [
                    x * block.place.scale if isinstance(x, Fraction) else _number(x, block.place.scale)
                    for x in cells
                ]
                fixed = column.name in self.counts and cells[0] != block.values[0]
                data[column.name] = np.array([np.nan if fixed else float(x) for x in numbers])
        first = engine.evaluate(self.whole, self.report.values.given_labels, data, self.program)
        values = with_passes(first, self.report.sheet, self.grid.passes, 1)
        changed = {name for (name, row), value in edits.items() if value != self.grid[name].values[row]}
        return self._as_counted(values, changed)

    def _as_counted(self, values: Values, changed: set[str]) -> Values:
        """After an edit no formula counts roots: where they were counted row by row, nothing is certain."""
        value, status = dict(values.value), dict(values.status)
        lost: set[str] = set()
        for column in self.whole.order:
            named = {precedent.name for precedent in self.whole.precedents(column)}
            if isinstance(column.rule, Root) and not certified(self.whole, column):
                here = {c.name for c in self.whole.ancestors(column)} & changed
                fresh = np.array([cell.culprit is None for cell in values.cells(column.name)])
            else:
                here = named & lost
                fresh = status[column.name] == Status.OK
            if here:
                lost.add(column.name)
                status[column.name] = np.where(fresh, Status.UNDECIDED, status[column.name]).astype(np.uint8)
                value[column.name] = np.where(fresh, np.nan, value[column.name])
        return replace(values, value=value, status=status)

    @property
    def counts(self) -> set[str]:
        """The given columns that say how many rows there are."""
        return {axis.count for axis in self.whole.axes if isinstance(axis, RepeatAxis)}

    def _given(self, name: str, row: int) -> Fraction:
        """An input as it stands in its cell."""
        value = self.grid[name].values[row]
        assert isinstance(value, float)
        inputs = self.report.inputs
        known = inputs.measured[name][row] if name in inputs.measured else inputs.parameters.get(name)
        return Fraction(value) if known is None else known.value / self.grid[name].place.scale


def _number(value: Typed, scale: Fraction) -> float:
    if value is None or isinstance(value, (str, bool)):
        return float("nan")
    return float(Fraction(repr(value)) * scale)


def deliver(folder: Path = PAPER, drawn: bool = True) -> Delivered:
    """Compute a folder and make its workbook."""
    report = Study(folder).computed
    return Delivered(report, *stages.book(report, drawn))


@cache
def paper() -> Delivered:
    """The shipped campaign's workbook."""
    return deliver()


def folder_with(
    folder: Path,
    tests: Sequence[tuple[float, float, float]],
    more: str = "",
    header: str = "test,v [m/s],e [1],x_p [um]",
) -> Path:
    """A report folder with other tests."""
    folder.mkdir()
    rows = [f"{n},{v},{e},{x_p}" for n, (v, e, x_p) in enumerate(tests, start=1)]
    (folder / "measurements.csv").write_text("\n".join([header, *rows, ""]))
    (folder / "report.toml").write_text(
        f'title = "Made for a test"\nworkbook = "soft_impact"\n[parameters]\nball_mass = "8.366 g"\n{more}'
        '[measurements]\nfile = "measurements.csv"\n'
    )
    return folder


# --- files --------------------------------------------------------------------------------------------------


def parts(content: bytes) -> dict[str, bytes]:
    """The files in a workbook by their names."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def packed(files: Mapping[str, bytes]) -> bytes:
    """A workbook of files."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return buffer.getvalue()


def part_of(files: Mapping[str, bytes], worksheet: str) -> str:
    """The file of a worksheet: they are numbered in their order."""
    names = re.findall(r'<sheet name="([^"]+)"', files["xl/workbook.xml"].decode())
    return f"xl/worksheets/sheet{names.index(worksheet) + 1}.xml"


def typed(content: bytes, by_sheet: Mapping[str, Mapping[str, Typed]]) -> bytes:
    """Put other values into cells, as a program does that saves without recalculating."""
    files = parts(content)
    for worksheet, cells in by_sheet.items():
        name = part_of(files, worksheet)
        text = files[name].decode()
        for address, value in cells.items():
            text, found = re.subn(
                rf'<c r="{address}"( s="\d+")?(?: t="s")?><v>[^<]*</v></c>', _cell(address, value), text
            )
            assert found == 1, (worksheet, address)
        files[name] = text.encode()
    return packed(files)


def _cell(address: str, value: Typed) -> str:
    if value is None:
        return f'<c r="{address}"\\1/>'
    if isinstance(value, bool):
        # It comes with its own format: as a number's, LibreOffice takes it for 1 or 0, and shows it so.
        return f'<c r="{address}" t="b"><v>{int(value)}</v></c>'
    if isinstance(value, Error):
        return f'<c r="{address}"\\1 t="e"><v>{value}</v></c>'
    if isinstance(value, str):
        return f'<c r="{address}"\\1 t="inlineStr"><is><t>{value}</t></is></c>'
    return f'<c r="{address}"\\1><v>{value!r}</v></c>'


# --- comparing -------------------------------------------------------------------------------------------


@dataclass
class Difference:
    """The largest difference of a comparison, how many cells were compared, and what differs too much."""

    cells: int = 0
    worst: float = 0.0
    where: str = ""
    wrong: list[str] = field(default_factory=list)


def still_moving(sheet: Sheet, values: Values, last: int) -> bool:
    """Whether a loop moves in the last pass of a workbook by more than it takes for settled, or nearly so."""
    for column in (column for loop in sheet.loops for column in loop.iterated):
        old, new = (values.value[pass_name(column.name, number)] for number in (last - 1, last))
        if (np.abs(new - old) * 2 * STAYS > np.abs(new)).any():
            return True
    return False


def compare(
    delivered: Delivered, values: Values, read: Mapping[str, Mapping[str, Any]], largest: float = LARGEST
) -> Difference:
    """Every computed cell, and what is checked, against NumPy.

    Parameters
    ----------
    read : mapping of worksheet to mapping of address to value
        What another program shows; an error of Excel's as its text.
    """
    found, lost = Difference(), lost_to_differences(values)
    sheet = delivered.report.marks.values.sheet
    looped, moving = sheet.loop_of.keys(), still_moving(sheet, values, delivered.grid.passes)

    def before(column: Column) -> set[str]:
        """What a column rests on; of one that is drawn, what that is drawn of."""
        own = delivered.whole.by_name.get(column.name.removeprefix("plotted_"), column)
        return {own.name, *(each.name for each in delivered.whole.ancestors(own))}

    for its, column in delivered.every.items():
        given = isinstance(column.rule, Given)
        place = delivered.grid[checked(its) if given else its].place
        name, _, a_pass = its.removeprefix("plotted_").partition("_pass_")
        drawn = not given and not a_pass and its not in sheet
        allowed = largest * (lost if name in MISFITS else 1)
        if a_pass:  # while a loop looks for its place, a pass may double what rounding made of the last one
            allowed *= 2 ** min(int(a_pass), 20)
        known, codes = values.value[its], values.status[its]
        if not known.size:
            # A count that is refused leaves no rows; those of the workbook say so.
            known, codes = np.full(place.rows, np.nan), np.full(place.rows, Status.INPUT)
        elif drawn:  # of a cloud, as many as a chart shows
            some = evenly(known.size, place.rows)
            known, codes = known[some], codes[some]
        scale = 1e-6 * np.nanmax(np.abs(known), initial=0.0) if np.isfinite(known).any() else 0.0
        # A logarithm near zero has no relative precision of its own; its column has.
        if not column.positive:
            scale = max(scale * 1e6, float(column.unit == "1"))
        for row, (value, status) in enumerate(zip(known, codes, strict=True)):
            address = place.cell(row, place.worksheet).replace("$", "")
            cell, code = read[place.worksheet].get(address), CODES[Status(int(status))]
            where = f"{its}, {place.worksheet}!{address}"
            found.cells += 1
            if status != Status.OK:
                expected = "#N/A" if drawn else code
                if cell != expected:
                    found.wrong.append(f"{where}: {cell!r} instead of {expected}")
                continue
            if moving and cell in ("#STEPS!", "#N/A") and (a_pass or looped & {column.name, *before(column)}):
                continue  # NumPy takes as many passes as it needs
            if not isinstance(cell, int | float) or isinstance(cell, bool):
                found.wrong.append(f"{where}: {cell!r} instead of {value / float(place.scale)!r}")
                continue
            difference = abs(cell * float(place.scale) - value) / max(abs(value), scale, 1e-300)
            if difference > found.worst:
                found.worst, found.where = difference, where
            if difference > allowed:
                found.wrong.append(
                    f"{where}: {cell!r} instead of {value / float(place.scale)!r}, {difference:.1e}"
                )
    return found


# --- LibreOffice -----------------------------------------------------------------------------------------


def recalculate(soffice: str, folder: Path, books: Mapping[str, bytes]) -> Cells:
    """Let LibreOffice recalculate workbooks; then read every cell."""
    return {name: cells_of(content) for name, content in recalculated(soffice, folder, books).items()}


def recalculated(soffice: str, folder: Path, books: Mapping[str, bytes]) -> dict[str, bytes]:
    """Let LibreOffice open workbooks, recalculate them and save them, all in one run of the program."""
    profile, given, made = (folder / name for name in ("profile", "given", "made"))
    for each in (profile / "user", given, made):
        each.mkdir(parents=True, exist_ok=True)
    # Without this LibreOffice believes the stored values.
    (profile / "user" / "registrymodifications.xcu").write_text(ALWAYS_RECALCULATE)
    for name, content in books.items():
        (given / f"{name}.xlsx").write_bytes(content)
    command = [soffice, f"-env:UserInstallation=file://{profile}", "--headless", "--convert-to", "xlsx"]
    files = [str(given / f"{name}.xlsx") for name in books]
    run = subprocess.run(
        [*command, "--outdir", str(made), *files], capture_output=True, text=True, timeout=600, check=False
    )
    assert run.returncode == 0, run.stderr
    return {name: (made / f"{name}.xlsx").read_bytes() for name in books}


def cells_of(content: bytes) -> dict[str, dict[str, Any]]:
    """Every value of a saved workbook."""
    import openpyxl

    book = openpyxl.load_workbook(io.BytesIO(content), data_only=True, read_only=True)
    return {
        sheet.title: {
            cell.coordinate: cell.value for row in sheet.iter_rows() for cell in row if cell.value is not None
        }
        for sheet in book.worksheets
    }


def formulas_of(content: bytes) -> dict[str, dict[str, Any]]:
    """Every cell of a delivered workbook: formulas with their equals sign, array formulas in braces."""
    import openpyxl
    from openpyxl.worksheet.formula import ArrayFormula

    book = openpyxl.load_workbook(io.BytesIO(content), read_only=True)
    found: dict[str, dict[str, Any]] = {}
    for sheet in book.worksheets:
        cells = found.setdefault(sheet.title, {})
        for row in sheet.iter_rows():
            for cell in row:
                value = cell.value
                if value is not None:
                    cells[cell.coordinate] = f"{{{value.text}}}" if isinstance(value, ArrayFormula) else value
    return found
