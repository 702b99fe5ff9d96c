"""Workbooks in LibreOffice: after an edit they are what NumPy makes of it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import grouped
import pytest
import spreadsheets
import two_tables

from loopsheet.report.inputs.folders import PAPER


@dataclass(frozen=True)
class Case:
    """A folder, and what is typed into its workbook."""

    write: Callable[[Path], Path]
    edits: dict[str, spreadsheets.Edits]
    other: spreadsheets.Edits
    """An edit of which the workbook must not be what NumPy makes."""
    least: int
    """Fewer cells are not compared."""
    drawn: bool = True


CASES = {
    "groups": Case(
        lambda place: grouped.write(place / "few"),
        {
            "as issued": {},
            "another reading": {("y", 5): 2.85},
            "a reading that was not taken": {("y", 2): None},
            "an instrument without readings": {("y", 1): None, ("y", 5): None},
        },
        {("y", 0): 1.75},
        30,
    ),
    "models": Case(
        lambda _: PAPER.parent / "contact_models",
        {
            "as issued": {},
            "a digit of a restitution": {("e", 0): 0.531},
            "much of it lost": {("e", 3): 0.06},
            "less of it lost": {("e", 1): 0.6},
            "a yield strength and a speed": {("sigma_Y", 0): 0.5, ("v", 2): 3.9},
            "Poisson's ratio": {("nu_2", 0): 0.25},
        },
        {("e", 2): 0.5},
        300,
        drawn=False,
    ),
    "two tables": Case(
        lambda place: two_tables.write(place / "tables"),
        {
            "as issued": {},
            "a sample": {("y_s", 1): 0.553},
            "both": {("y_s", 2): 0.4, ("y", 1): 0.213},
            "a sample that was not read": {("y_s", 0): None},
            "a standard that was not read": {("y", 3): None},
        },
        {("y_s", 0): 0.777, ("y", 0): 0.1},
        30,
    ),
}
EDITED = [(name, edit) for name, case in CASES.items() for edit in case.edits]
Edited = Callable[[str], tuple[spreadsheets.Delivered, spreadsheets.Cells]]


@pytest.fixture(scope="module")
def edited(recalculate: spreadsheets.Recalculate, tmp_path_factory: pytest.TempPathFactory) -> Edited:
    """Give `edited("groups")`: the workbook as it is delivered, and its cells after each edit, made once."""

    @cache
    def made(name: str) -> tuple[spreadsheets.Delivered, spreadsheets.Cells]:
        case = CASES[name]
        delivered = spreadsheets.deliver(case.write(tmp_path_factory.mktemp("case")), case.drawn)
        return delivered, recalculate({edit: delivered.edited(typed) for edit, typed in case.edits.items()})

    return made


@pytest.mark.parametrize(("name", "edit"), EDITED)
def test_an_edited_workbook_is_what_numpy_makes_of_it(edited: Edited, name: str, edit: str) -> None:
    case, (delivered, read) = CASES[name], edited(name)
    values = delivered.values(case.edits[edit])
    found = spreadsheets.compare(delivered, values, read[edit])
    assert (found.wrong, found.cells > case.least) == ([], True)
    assert spreadsheets.compare(delivered, delivered.values(case.other), read[edit]).wrong
    if name == "models":  # that the roots are the only ones is known of all inputs
        assert all((status != spreadsheets.Status.UNDECIDED).all() for status in values.status.values())
    if name == "groups":
        has_value = {cell.label for cell in values.cells("level") if cell.value is not None}
        assert has_value == ({(1,), (3,)} if "without" in edit else {(1,), (2,), (3,)})


def test_no_formula_is_longer_than_excel_takes(edited: Edited) -> None:
    cells = spreadsheets.formulas_of(edited("models")[0].content).values()
    assert max(len(str(content)) for each in cells for content in each.values()) < 8192


def test_each_table_has_its_worksheet_with_what_was_left_out(edited: Edited) -> None:
    issued = edited("two tables")[1]["as issued"]
    standards, samples = (list(map(str, issued[name].values())) for name in ("standards", "samples"))
    assert ("spilled" in standards, "spilled" in samples) == (True, False)
    assert ("B-7" in standards, "B-7" in samples) == (False, True)


def test_an_edited_workbook_fits_each_group_again(
    recalculate: spreadsheets.Recalculate, tmp_path: Path
) -> None:
    folder = grouped.write(tmp_path / "few", grouped.rates(1), grouped.RATES_HEAD, grouped.RATES)
    delivered = spreadsheets.deliver(folder)
    edits: spreadsheets.Edits = {("y", 4): -0.512, ("x", 2): None}
    read = recalculate({"edited": delivered.edited(edits)})
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
    recalculate: spreadsheets.Recalculate, tmp_path: Path
) -> None:
    """Sums go by the rows as issued: a number that was sorted to another instrument's row is in none."""
    delivered = spreadsheets.deliver(grouped.write(tmp_path / "few"))
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
    read = recalculate(books)
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
