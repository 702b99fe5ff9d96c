"""Fits of methods in LibreOffice: after an edit they are what NumPy makes of it."""

from pathlib import Path

import numpy as np
import pytest
import spreadsheets
from helpers import method_folder
from test_fit_of_both import pearson

from loopsheet.report.cells.values import CODES
from loopsheet.report.inputs.folders import PAPER

EDITS: dict[str, tuple[str, spreadsheets.Edits]] = {
    "a line": ("gum_h3", {}),
    "another correction": ("gum_h3", {("b", 3): -0.170}),
    "a correction that was not taken": ("gum_h3", {("b", 3): None}),
    "three readings": ("gum_h3", {("b", row): None for row in range(3, 11)}),
    "two readings": ("gum_h3", {("b", row): None for row in range(2, 11)}),
    "one temperature": ("gum_h3", {("t", row): 21.5 for row in range(11)}),
    "a curve": ("misra1a", {}),
    "another volume": ("misra1a", {("y", 13): 80.5}),
    "a volume that was not taken": ("misra1a", {("y", 5): None}),
    "one pressure": ("misra1a", {("x", row): 77.6 for row in range(14)}),
}
CODE = {
    "two readings": {"line_s": "#DOMAIN!", "y_2": "ok"},
    "one temperature": {"y_1": "#DOMAIN!", "line_fitted": "#DOMAIN!"},
    "one pressure": {"b_1": "#NOROOT!"},
}
"""What has no value after an edit; after the others all has one."""


@pytest.fixture(scope="module")
def delivered() -> dict[str, spreadsheets.Delivered]:
    return {name: spreadsheets.deliver(PAPER.parent / name) for name in ("gum_h3", "misra1a")}


@pytest.fixture(scope="module")
def read(
    delivered: dict[str, spreadsheets.Delivered], recalculate: spreadsheets.Recalculate
) -> spreadsheets.Cells:
    return recalculate({name: delivered[folder].edited(edits) for name, (folder, edits) in EDITS.items()})


@pytest.mark.parametrize("name", EDITS)
def test_an_edited_workbook_is_what_numpy_makes_of_it(
    delivered: dict[str, spreadsheets.Delivered], read: spreadsheets.Cells, name: str
) -> None:
    folder, edits = EDITS[name]
    values = delivered[folder].values(edits)
    codes = {cell: CODES[values.status[cell][0]] for cell in CODE.get(name, {})}
    assert codes == CODE.get(name, {})
    found = spreadsheets.compare(delivered[folder], values, read[name])
    # Two slopes that are the same leave rounding on the way, and LibreOffice takes little for nothing.
    lost = "_pass_" if name == "one pressure" else "nothing"
    assert [line for line in found.wrong if lost not in line] == []
    assert found.cells > 50
    if not edits:
        other = delivered[folder].values({(values.sheet.columns[0].name, 0): 70.0})
        assert spreadsheets.compare(delivered[folder], other, read[name]).wrong


MANY = 500
METHOD = '''"""A curve of third degree."""

from loopsheet import Method, fit, let, measured, unknown


class Cubic(Method, headline="a b c d spread"):
    """A curve through many readings."""

    x = measured("V", "voltage")
    y = measured("K", "temperature", positive=True)
    a = unknown("first coefficient", "K")
    b = unknown("second coefficient", "K/V")
    c = unknown("third coefficient", "K/V^2")
    d = unknown("fourth coefficient", "K/V^3")
    curve = fit(y, a + b * x + c * x**2 + d * x**3)
    off = let(y - curve.fitted, "deviation", "mK")
    spread = let(max(off) - min(off), "range of the deviations", "mK")
'''


def test_a_fit_to_many_rows_has_a_value_in_every_cell(
    tmp_path: Path, recalculate: spreadsheets.Recalculate
) -> None:
    """LibreOffice computes such columns in threads, if it may, and then leaves #VALUE! in some."""
    generator = np.random.default_rng(1)
    x = np.linspace(0.5, 2.0, MANY)
    y = 250 + 40 * x - 3 * x**2 + 0.5 * x**3 + generator.normal(0, 0.01, MANY)
    rows = [f"{n},{at:.4f},{height:.3f}" for n, (at, height) in enumerate(zip(x, y, strict=True), 1)]
    folder = method_folder(tmp_path / "cubic", METHOD, "\n".join(["test,x [V],y [K]", *rows, ""]))
    book = spreadsheets.deliver(folder, drawn=False)
    read = recalculate({"many": book.edited({})})
    found = spreadsheets.compare(book, book.values({}), read["many"])
    assert found.cells > 10 * MANY
    assert [line for line in found.wrong if "'#" in line] == []  # what is left of 290 K has lost some digits


def test_a_line_with_errors_in_both_variables(tmp_path: Path, recalculate: spreadsheets.Recalculate) -> None:
    """The points that rows belong to are passes of the loop, too."""
    book = spreadsheets.deliver(pearson(tmp_path), drawn=False)
    every: dict[str, spreadsheets.Edits] = {
        "as it is": {}, "another ordinate": {("y", 3): 4.9}, "one that is missing": {("y", 3): None}
    }  # fmt: skip
    read = recalculate({name: book.edited(edits) for name, edits in every.items()})
    slopes = set()
    for name, edits in every.items():
        values = book.values(edits)
        found = spreadsheets.compare(book, values, read[name])
        assert found.wrong == [], name
        assert found.cells > 1000
        slopes.add(values.scalar("b"))
    assert len(slopes) == 3


GROWTH = '''"""A growth."""

from sympy import log

from loopsheet import Method, fit, measured, unknown


class Growth(Method, rows="points"):
    """By a logarithm, from a start at which whole steps leave its domain."""

    x = measured("m", "place", positive=True)
    y = measured("V", "voltage")
    a = unknown("size", "V", start=5)
    b = unknown("rate", "1/m", start=20)
    curve = fit(y, a * log(1 + b * x))
'''
READINGS = (0.605, 1.045, 1.431, 1.742, 2.019, 2.263, 2.479, 2.671, 2.845, 3.004)


def test_a_step_that_leaves_the_domain_is_too_long_in_a_worksheet_too(
    tmp_path: Path, recalculate: spreadsheets.Recalculate
) -> None:
    """The sum of squares there has no value, and nothing that followed had one."""
    rows = "".join(f"{n},{n / 2:.1f},{y:.3f}\n" for n, y in enumerate(READINGS, start=1))
    folder = method_folder(tmp_path / "growth", GROWTH, f"point,x [m],y [V]\n{rows}")
    book = spreadsheets.deliver(folder, drawn=False)
    every: dict[str, spreadsheets.Edits] = {
        "as it is": {}, "another": {("y", 4): 1.9}, "one that is missing": {("y", 3): None},
        "all but one": {("y", row): None for row in range(1, 10)},
    }  # fmt: skip
    read = recalculate({name: book.edited(edits) for name, edits in every.items()})
    for name, edits in every.items():
        values = book.values(edits)
        assert np.isfinite(values.scalar("b")) == (name != "all but one")
        wrong = spreadsheets.compare(book, values, read[name]).wrong
        of_rounding = ("_pass_", "curve_d", "curve_step")  # the last steps
        assert [line for line in wrong if not any(each in line for each in of_rounding)] == [], name
