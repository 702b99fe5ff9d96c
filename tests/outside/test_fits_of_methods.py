"""Fits of methods in LibreOffice: after an edit they are what NumPy makes of it."""

from collections.abc import Callable
from typing import Any

import pytest
import spreadsheets

from loopsheet.report.cells.values import CODES
from loopsheet.report.inputs.folders import PAPER

Read = dict[str, dict[str, dict[str, Any]]]

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
    delivered: dict[str, spreadsheets.Delivered],
    require: Callable[..., str],
    tmp_path_factory: pytest.TempPathFactory,
) -> Read:
    soffice = require("soffice", "libreoffice")
    books = {name: delivered[folder].edited(edits) for name, (folder, edits) in EDITS.items()}
    return spreadsheets.recalculate(soffice, tmp_path_factory.mktemp("office"), books)


@pytest.mark.parametrize("name", EDITS)
def test_an_edited_workbook_is_what_numpy_makes_of_it(
    delivered: dict[str, spreadsheets.Delivered], read: Read, name: str
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
