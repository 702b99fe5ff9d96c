"""Rows in groups in LibreOffice: after an edit they are what NumPy makes of it."""

from collections.abc import Callable
from typing import Any

import grouped
import pytest
import spreadsheets

EDITS: dict[str, spreadsheets.Edits] = {
    "as issued": {},
    "another reading": {("y", 5): 2.85},
    "a reading that was not taken": {("y", 2): None},
    "an instrument without readings": {("y", 1): None, ("y", 5): None},
}


@pytest.fixture(scope="module")
def delivered(tmp_path_factory: pytest.TempPathFactory) -> spreadsheets.Delivered:
    return spreadsheets.deliver(grouped.write(tmp_path_factory.mktemp("grouped") / "few"))


@pytest.fixture(scope="module")
def read(
    delivered: spreadsheets.Delivered, require: Callable[..., str], tmp_path_factory: pytest.TempPathFactory
) -> dict[str, dict[str, dict[str, Any]]]:
    soffice = require("soffice", "libreoffice")
    books = {name: delivered.edited(edits) for name, edits in EDITS.items()}
    return spreadsheets.recalculate(soffice, tmp_path_factory.mktemp("office"), books)


@pytest.mark.parametrize("name", EDITS)
def test_an_edited_workbook_is_what_numpy_makes_of_it(
    delivered: spreadsheets.Delivered, read: dict[str, dict[str, dict[str, Any]]], name: str
) -> None:
    values = delivered.values(EDITS[name])
    found = spreadsheets.compare(delivered, values, read[name])
    assert (found.wrong, found.cells > 30) == ([], True)
    other = delivered.values({("y", 0): 1.75})
    assert spreadsheets.compare(delivered, other, read[name]).wrong
    has_value = {cell.label for cell in values.cells("level") if cell.value is not None}
    assert has_value == ({(1,), (3,)} if "without" in name else {(1,), (2,), (3,)})


def test_an_edited_workbook_fits_each_group_again(
    require: Callable[..., str], tmp_path_factory: pytest.TempPathFactory
) -> None:
    soffice, folder = require("soffice", "libreoffice"), tmp_path_factory.mktemp("rates")
    delivered = spreadsheets.deliver(
        grouped.write(folder / "few", grouped.rates(1), grouped.RATES_HEAD, grouped.RATES)
    )
    edits: spreadsheets.Edits = {("y", 4): -0.512, ("x", 2): None}
    read = spreadsheets.recalculate(soffice, folder, {"edited": delivered.edited(edits)})
    values = delivered.values(edits)
    found = spreadsheets.compare(delivered, values, read["edited"])
    assert (found.wrong, found.cells > 60) == ([], True)
    assert spreadsheets.compare(delivered, delivered.values({}), read["edited"]).wrong
