"""A second reader of the workbook, HyperFormula in node: its formulas mean the same there."""

import json
import random
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sample_sheet
import spreadsheets
from campaign_sizes import Sizes

from loopsheet.report.cells.grid import Grid
from loopsheet.report.cells.values import CODES, Status
from loopsheet.report.engines import excel_grid
from loopsheet.report.engines import numpy as engine
from loopsheet.report.sheet import Given

HERE = Path(__file__).parent

Recalculate = Callable[..., dict[str, Any]]


@pytest.fixture(scope="session")
def hyperformula(require: Callable[..., str], npm_packages: Callable[[Path], Path]) -> Recalculate:
    """Recalculate books of formulas; the package is installed once, outside of the checkout."""
    node, packages = require("node"), npm_packages(HERE)

    def recalculate(
        books: Mapping[str, Any],
        mutants: list[list[str]] | None = None,
        changes: Mapping[str, Any] | None = None,
        edits: Mapping[str, Any] | None = None,
    ) -> dict[str, Any]:
        asked = {"books": books, "mutants": mutants or [], "changes": changes or {}, "edits": edits or {}}
        run = subprocess.run(
            [node, str(HERE / "hyperformula.js")],
            input=json.dumps({"module": str(packages / "hyperformula"), **asked}),
            capture_output=True, text=True, timeout=300, check=False,
        )  # fmt: skip
        assert run.returncode == 0, run.stderr
        found: dict[str, Any] = json.loads(run.stdout)
        return found

    return recalculate


EDITS: dict[str, spreadsheets.Edits] = {
    "as issued": {},
    "x_p of test 2": {("x_p", 1): 29.8},
    "e of test 3": {("e", 2): 0.9},
    "an empty input": {("x_p", 1): None},
    "nothing measured": {("v", row): None for row in range(5)},
    "e above 1": {("e", 1): 1.2},
    "a truth": {("v", 1): True},
    "a number with its unit": {("x_p", 1): "29.7 um"},
    "an error": {("x_p", 1): spreadsheets.Error("#DIV/0!")},
    "more points": {("points_per_pair", 0): 60.0},
}


def test_recalculates_the_paper_as_numpy_does(hyperformula: Recalculate) -> None:
    paper = spreadsheets.paper()
    read = hyperformula(
        {"paper": spreadsheets.formulas_of(paper.content)},
        edits={name: paper.cells(edits) for name, edits in EDITS.items()},
    )
    for name, edits in EDITS.items():
        found = spreadsheets.compare(paper, paper.values(edits), read[name])
        assert not found.wrong, (name, len(found.wrong), found.wrong[:5])
        assert found.cells > 3800


def test_rows_that_come_and_go_are_told(hyperformula: Recalculate) -> None:
    """The formulas are for the rows there were: one taken out, an empty one put in, one written below."""
    paper = spreadsheets.paper()
    book = spreadsheets.formulas_of(paper.content)
    below = {**book, "tests": {**book["tests"], "A13": 6, "B13": 5.9, "C13": 0.43, "D13": 61.0}}
    changes = {"taken out": [["tests", 8, -1]], "put in": [["tests", 8, 1]]}
    read = hyperformula({"issued": book, "taken out": book, "put in": book, "below": below}, changes=changes)
    mean = paper.grid["alpha_mean"].place.cell(0, "report").replace("$", "")
    alpha = {name: [cells["pairs"][f"C{row}"] for row in range(8, 18)] for name, cells in read.items()}
    for name in ("taken out", "put in", "below"):
        told = read[name]["tests"]["A3"]
        assert told.startswith("#INPUT! the formulas are for 5 rows, and ")
        assert told.endswith("change the file of the measurements and build again")
        assert told in read[name]["report"]["A3"], "on the first worksheet, too"
    assert [read["issued"][sheet]["A3"] for sheet in ("report", "tests")] == ["", ""]
    # The pairs of the others stay what they were, and nothing is made of half a test.
    assert alpha["put in"] == alpha["below"] == alpha["issued"]
    pairs = zip(paper.report.values.labels(paper.report.sheet["alpha"]), alpha["issued"], strict=True)
    assert alpha["taken out"] == ["#INPUT!" if 2 in label else value for label, value in pairs]
    assert read["taken out"]["report"][mean] != read["issued"]["report"][mean]


# --- a sheet that uses everything ---------------------------------------------------------------------------


def cells(grid: Grid, data: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """A grid as a book: what is given in its unit, and every formula."""
    book: dict[str, dict[str, Any]] = {}
    for block in grid.blocks:
        for row in range(block.place.rows):
            address = block.place.cell(row, block.place.worksheet).replace("$", "")
            if block.formulas:
                content: Any = f"{{{block.formulas[row]}}}" if block.array else block.formulas[row]
            elif block.kind == "given":
                value = np.atleast_1d(np.asarray(data[block.name], dtype=float))[row]
                content = None if np.isnan(value) else value / float(block.place.scale)
            else:
                content = block.values[row]
            book.setdefault(block.place.worksheet, {})[address] = content
    return book


LABELS = {"items": (1, 2, 3, 4)}
NAN = float("nan")
VARIANTS = {
    "plain": {},
    "three roots and none": {"g": [1.0, -30.0, 12.0, 5.0]},
    "a datum is missing": {"a": [0.012, NAN, 0.031, 0.044]},
    "a scalar is missing": {"w": NAN},
    "no row has a value": {"g": [NAN] * 4},
    "outside its conditions": {"g": [-3.0, -3.0, 4.0, 4.0]},
    "a datum is not allowed": {"a": [0.012, -0.025, 0.031, 0.044], "g": [2.5, -3.0, 12.0, 1000.5]},
    "a scalar is not allowed": {"w": 0.0},
}


def test_another_number_of_rows_is_refused(hyperformula: Recalculate) -> None:
    """What NumPy would compute with, this workbook has no rows for."""
    issued = engine.evaluate(sample_sheet.SHEET, LABELS, sample_sheet.DATA)
    grid = excel_grid.grid(sample_sheet.SHEET, issued, sample_sheet.UNITS)
    read = hyperformula({str(per): cells(grid, {**sample_sheet.DATA, "per": per}) for per in (2, 2.5, 3, 4)})
    on_points = [
        c for c in sample_sheet.SHEET.columns if any(a.name == "per" for a in sample_sheet.SHEET.ancestors(c))
    ]
    assert {"wave", "total", "solved", "last"} <= {column.name for column in on_points}
    for per, found in read.items():
        for column in on_points:
            place = grid[column.name].place
            codes = {
                found[place.worksheet][a.replace("$", "")]
                for a in place.cells(range(place.rows), place.worksheet)
            }
            assert (codes == {"#INPUT!"}) == (per != "3"), (per, column.name)


def test_every_construct_means_what_numpy_means(hyperformula: Recalculate) -> None:
    program, labels = engine.Program.of(sample_sheet.SHEET), LABELS
    found, books = {}, {}
    issued = engine.evaluate(sample_sheet.SHEET, labels, sample_sheet.DATA, program)
    grid = excel_grid.grid(sample_sheet.SHEET, issued, sample_sheet.UNITS, ("far",))
    for name, change in VARIANTS.items():
        data = {**sample_sheet.DATA, **change}
        found[name] = engine.evaluate(sample_sheet.SHEET, labels, data, program)
        books[name] = cells(grid, data)
    read = hyperformula(books)
    codes = set()
    for name, values in found.items():
        for column in sample_sheet.SHEET.columns:
            if isinstance(column.rule, Given):
                continue
            place = grid[column.name].place
            for row, (value, status) in enumerate(
                zip(values.value[column.name], values.status[column.name], strict=True)
            ):
                cell = read[name][place.worksheet][place.cell(row, place.worksheet).replace("$", "")]
                codes.add(int(status))
                if status == Status.OK:
                    assert cell * float(place.scale) == pytest.approx(value, rel=1e-12, abs=1e-15), (
                        name,
                        column.name,
                        row,
                    )
                else:
                    assert cell == CODES[Status(int(status))], (name, column.name, row)
    assert codes == set(Status) - {Status.UNDECIDED}, "the variants do not reach every error"


# --- mutations -------------------------------------------------------------------------------------------

_OTHERS = {"+": "-", "-": "+", "*": "/", "/": "*"}
_HELD = ">=(2)^(0-1022),"
"""Before the value of what is positive: that a double holds it."""


def mutants(grid: Grid, how_many: int, seed: int) -> list[list[str]]:
    """Formulas of the first rows with one character of their arithmetic changed."""
    found = []
    for block in grid.blocks:
        # Before the first step the paper leaves much unused (no pair turns); after it, its roots are found.
        if block.kind != "computed" and not (block.kind == "step" and block.step == 1):
            continue
        # What goes wrong in one pass of a loop, the next ones mend; no test is near to deciding alone.
        if "_pass_" in block.name or block.name in ("z_eiv", "alpha_without"):
            continue
        formula, sheet = block.formulas[0], block.place.worksheet
        # What comes before tests for errors, and says the same of good cells when it is changed.
        first = max(formula.find("IFERROR(") + 8, formula.rfind("ISNUMBER("))
        if _HELD in formula:
            first = max(first, formula.rfind(_HELD) + len(_HELD))
        if block.kind == "computed":
            first = max(first, formula.rfind(">0,"), formula.rfind(">0),"))
        if "IF(" in formula[first:].replace("SUM(IF(", ""):
            continue  # a choice: what is not chosen shows nowhere here, but with the variants above
        for place in range(first, len(formula)):
            if formula[place] in _OTHERS and '"' not in formula[place - 1 : place + 2]:
                changed = formula[:place] + _OTHERS[formula[place]] + formula[place + 1 :]
                address = block.place.cell(0, sheet).replace("$", "")
                found.append([sheet, address, f"{{{changed}}}" if block.array else changed])
    return random.Random(seed).sample(found, min(how_many, len(found)))


@pytest.mark.campaigns
def test_one_changed_character_is_noticed(
    hyperformula: Recalculate, sizes: Sizes, summary: Callable[[str], None]
) -> None:
    """In every kind of cell; the value of the cell itself or of one that depends on it is another."""
    paper = spreadsheets.paper()
    # As issued: after an edit nothing is computed where roots were counted for the inputs as issued.
    book = spreadsheets.formulas_of(paper.content)
    changed = mutants(paper.grid, sizes.workbook_mutants, sizes.seed)
    read = hyperformula({"paper": book}, changed)
    unnoticed = [mutant for mutant, differing in zip(changed, read["mutants"], strict=True) if not differing]
    summary(f"characters changed in the workbook: {len(changed) - len(unnoticed)} of {len(changed)} noticed")
    assert not unnoticed, (len(unnoticed), unnoticed[:3])
