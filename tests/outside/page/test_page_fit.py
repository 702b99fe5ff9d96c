"""One curve for all tests in the page: after an edit it is what a folder with the edit gives."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import driving
import pytest
from driving import Live

from loopsheet.report.build import build
from loopsheet.report.study import Study

Open = Callable[..., Live]

EDITS = {
    "as many digits": ({("x_p", 2): "29.8"}, ()),
    "other digits, other uncertainties": ({("x_p", 4): "46.0", ("v", 1): "2.33", ("e", 5): ".4530"}, ()),
    "a test left out": ({}, (3,)),
    "three tests left": ({}, (1, 3)),
}
SMALL = ("R_eiv", "z_eiv", "chi2_eiv", "birge_eiv", "u_birge_eiv")
"""What is left of differences."""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = driving.write(tmp_path_factory.mktemp("fit") / "paper", driving.paper())
    build(Study(place), place / "out", ("html",))
    return place / "out" / "report.html"


@pytest.mark.parametrize("name", EDITS)
def test_the_edited_page_is_what_a_rebuild_gives(
    open_page: Open, page: Path, tmp_path: Path, name: str
) -> None:
    edits, left_out = EDITS[name]
    live = open_page(page)
    for (column, test), text in edits.items():
        live.type(column, test, text)
    for test in left_out:
        live.page.locator(f'[data-use="{test}"]').click()
    tests = {test: row for test, row in driving.edited(edits).items() if test not in left_out}
    values = Study(driving.write(tmp_path / "edited", tests)).computed.values
    cells = [cell for cell in live.cells() if cell.status or cell.value]
    assert driving.differences([cell for cell in cells if cell.name not in SMALL], values) == []
    for cell in cells:
        if cell.name == "z_eiv":  # a difference of two depths: of two tests next to nothing is left
            row = values.row(values.sheet["z_eiv"], (int(cell.index),))
            assert float(cell.value) == pytest.approx(values.value["z_eiv"][row], abs=1e-8)
