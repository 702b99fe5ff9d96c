"""The paper's formulas in a workbook: what they use, and that they name cells that are there."""

import re

import pytest

from loopsheet.report import stages
from loopsheet.report.cells.grid import CellBlock, Grid, letters
from loopsheet.report.engines import excel_grid
from loopsheet.report.result.result import Report


@pytest.fixture(scope="module")
def paper(report: Report) -> Grid:
    units = {name: shown.unit for name, shown in report.shown.items()}
    drawn = stages.for_a_grid(report)
    return excel_grid.grid(report.sheet, report.values, units, report.workbook.headline, drawn)


def every(grid: Grid) -> list[tuple[CellBlock, str]]:
    return [(block, formula) for block in grid.blocks for formula in block.formulas]


def test_nothing_younger_than_excel_2016_is_used(paper: Grid) -> None:
    used = {name for _, formula in every(paper) for name in re.findall(r"([A-Z][A-Z0-9.]*)\(", formula)}
    assert used <= {
        "ABS", "AND", "COUNT", "COUNTIF", "EXP", "FALSE", "IF", "IFERROR", "INDEX", "INT", "ISLOGICAL",
        "ISNUMBER", "LN", "MAX", "MEDIAN", "MIN", "NA", "NOT", "OR", "PI", "ROWS", "SIGN", "SMALL", "SQRT",
        "SUM", "SUMPRODUCT",
    }  # fmt: skip


def test_formulas_have_no_notation_that_readers_disagree_on(paper: Grid) -> None:
    for block, formula in every(paper):
        bare = re.sub(r'"[^"]*"', "", formula)
        assert not re.search(r"\d[eE][+-]?\d", bare), (block.name, formula)
        assert not re.search(r"(^=|[(,*/^<>=])-", bare), (block.name, formula)
        assert not re.search(r"\^(?!\()|(?<!\))\^", bare), (block.name, formula)
        assert formula.startswith("=")
        assert len(formula) < 8192
        assert max(_depth(bare)) <= 64


def _depth(formula: str) -> list[int]:
    depths, depth = [], 0
    for letter in formula:
        depth += (letter == "(") - (letter == ")")
        depths.append(depth)
    assert depth == 0, formula
    return depths


def test_only_formulas_over_ranges_are_array_formulas(paper: Grid) -> None:
    nested = "[^()]*"
    for _ in range(12):
        nested = rf"(?:[^()]|\({nested}\))*"
    # A count, and a sum of products without IF, ask whole ranges in any formula.
    asks = re.compile(rf"\b(?:COUNTIF|ROWS|COUNT|SUMPRODUCT)\((?!{nested}\bIF\(){nested}\)")
    for block in paper.blocks:
        if block.formulas:
            assert block.array == (":" in asks.sub("", block.formulas[0])), block.name


def test_no_two_blocks_stand_on_one_cell(paper: Grid) -> None:
    taken = [
        (b.place.worksheet, b.place.column, row)
        for b in paper.blocks
        for row in range(b.place.row, b.place.row + b.place.rows)
    ]
    assert len(taken) == len(set(taken))


def test_every_reference_names_a_cell_that_is_there(paper: Grid) -> None:
    there = {
        (b.place.worksheet, f"${letters(b.place.column)}${row + 1}")
        for b in paper.blocks
        for row in range(b.place.row, b.place.row + b.place.rows)
    }
    for block, formula in every(paper):
        for sheet, cell in re.findall(r"(?:(\w+)!)?(\$[A-Z]+\$\d+)(?!:)", formula):
            if f":{cell}" not in formula:
                assert (sheet or block.place.worksheet, cell) in there, (block.name, formula)


def test_the_values_are_the_reports(paper: Grid) -> None:
    assert paper["alpha"].values[0] == pytest.approx(1.2579969787, abs=1e-9)
    assert paper["x_m2"].values[0] == pytest.approx(41.845, abs=1e-3)
    assert paper["plotted_x"].values == paper["x"].values
