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
    # A result of each group stands on the first worksheet, too, where it follows.
    first = read["edited"]["report"]
    told = [first[f"B{at[1:]}"] for at, text in first.items() if str(text).startswith("b[")]
    assert told == [pytest.approx(cell.value, rel=1e-12) for cell in values.cells("b")]
    assert len(told) > 1


def test_a_row_of_another_group_is_told_and_in_no_sum(
    require: Callable[..., str], tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Sums go by the rows as issued: a number that was sorted to another instrument's row is in none."""
    soffice, folder = require("soffice", "libreoffice"), tmp_path_factory.mktemp("sorted")
    delivered = spreadsheets.deliver(grouped.write(folder / "few"))
    rows = [(n, word, float(y)) for n, (word, y) in enumerate(grouped.FEW, start=1)]

    def typed(rows: list[tuple[int, str, float]], columns: str) -> bytes:
        cells = {
            f"{column}{row}": value
            for row, values in enumerate(rows, start=8)
            for column, value in zip("ABC", values, strict=True)
            if column in columns
        }
        return spreadsheets.typed(delivered.content, {"readings": cells})

    by_number = sorted(rows, key=lambda row: row[2])
    other = {n for n, (row, was) in enumerate(zip(by_number, rows, strict=True)) if row[1] != was[1]}
    moved = {n for n, (row, was) in enumerate(zip(by_number, rows, strict=True)) if row[0] != was[0]}
    assert 0 < len(other) < len(moved) < len(rows)
    renamed = [(n, "B" if n == 1 else word, y) for n, word, y in rows]
    books = {
        "as issued": delivered.content,
        "sorted": typed(by_number, "ABC"),
        "sorted without numbers": typed(by_number, "BC"),
        "a word": typed(renamed, "B"),
        "numbers": typed([(n + 1, *rest) for n, *rest in rows], "A"),
    }
    read = spreadsheets.recalculate(soffice, folder, books)
    all_rows = set(range(len(rows)))
    wanted = {
        "as issued": (set(), set(), rows),
        "sorted": (moved, other, by_number),
        "sorted without numbers": (other, other, by_number),
        "a word": ({0}, {0}, rows),
        "numbers": (all_rows, set(), rows),
    }
    for name, (told, refused, now) in wanted.items():
        cells = read[name]["readings"]
        found = {row for row in all_rows if "not the row as issued" in cells[f"D{row + 8}"]}
        assert found == told, name
        banner = read[name]["report"].get("A3") or ""
        assert (f"errors go: {len(told)}; change the file" in banner) == bool(told), name
        assert bool(cells.get("A3")) == bool(told), name
        edits: spreadsheets.Edits = {("y", row): None if row in refused else now[row][2] for row in all_rows}
        values = delivered.values(edits)
        assert spreadsheets.compare(delivered, values, read[name]).wrong == [], name
