"""Two tables of rows in LibreOffice: after edits of both the workbook is what NumPy makes of them."""

from typing import Any

import pytest
import spreadsheets
import two_tables

EDITS: dict[str, spreadsheets.Edits] = {
    "as issued": {},
    "a sample": {("y_s", 1): 0.553},
    "both": {("y_s", 2): 0.4, ("y", 1): 0.213},
    "a sample that was not read": {("y_s", 0): None},
    "a standard that was not read": {("y", 3): None},
}


@pytest.fixture(scope="module")
def delivered(tmp_path_factory: pytest.TempPathFactory) -> spreadsheets.Delivered:
    return spreadsheets.deliver(two_tables.write(tmp_path_factory.mktemp("two") / "tables"))


@pytest.mark.parametrize("name", EDITS)
def test_an_edited_workbook_is_what_numpy_makes_of_it(
    delivered: spreadsheets.Delivered, read: dict[str, dict[str, dict[str, Any]]], name: str
) -> None:
    found = spreadsheets.compare(delivered, delivered.values(EDITS[name]), read[name])
    assert (found.wrong, found.cells > 30) == ([], True)
    other = delivered.values({("y_s", 0): 0.777, ("y", 0): 0.1})
    assert spreadsheets.compare(delivered, other, read[name]).wrong


def test_each_table_has_its_worksheet_with_what_was_left_out(
    read: dict[str, dict[str, dict[str, Any]]],
) -> None:
    standards, samples = (
        list(map(str, read["as issued"][name].values())) for name in ("standards", "samples")
    )
    assert ("spilled" in standards, "spilled" in samples) == (True, False)
    assert ("B-7" in standards, "B-7" in samples) == (False, True)
