"""The contact models in LibreOffice: with other tests and bodies the workbook is what NumPy makes of them."""

from typing import Any

import pytest
import spreadsheets

from loopsheet.report.inputs.folders import PAPER

EDITS: dict[str, spreadsheets.Edits] = {
    "as issued": {},
    "a digit of a restitution": {("e", 0): 0.531},
    "much of it lost": {("e", 3): 0.06},
    "less of it lost": {("e", 1): 0.6},
    "a yield strength and a speed": {("sigma_Y", 0): 0.5, ("v", 2): 3.9},
    "Poisson's ratio": {("nu_2", 0): 0.25},
}


@pytest.fixture(scope="module")
def delivered() -> spreadsheets.Delivered:
    return spreadsheets.deliver(PAPER.parent / "contact_models", drawn=False)


@pytest.mark.parametrize("name", EDITS)
def test_an_edited_workbook_is_what_numpy_makes_of_it(
    delivered: spreadsheets.Delivered, read: dict[str, dict[str, dict[str, Any]]], name: str
) -> None:
    """Nothing of it is undecided: that the roots are the only ones is known of all inputs."""
    values = delivered.values(EDITS[name])
    assert all((status != spreadsheets.Status.UNDECIDED).all() for status in values.status.values())
    found = spreadsheets.compare(delivered, values, read[name])
    assert (found.wrong, found.cells > 300) == ([], True)
    other = delivered.values({("e", 2): 0.5})
    assert spreadsheets.compare(delivered, other, read[name]).wrong


def test_no_formula_is_longer_than_excel_takes(delivered: spreadsheets.Delivered) -> None:
    cells = spreadsheets.formulas_of(delivered.content).values()
    assert max(len(str(content)) for each in cells for content in each.values()) < 8192
