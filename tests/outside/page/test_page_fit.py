"""One curve for all tests in the page: after an edit it is what a folder with the edit gives."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import driving
import pytest
from driving import Live

from loopsheet.report.build import build
from loopsheet.report.result.chi_square import SIGNIFICANT, tail
from loopsheet.report.result.numbers import probability
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


def test_the_verdict_follows_while_it_is_the_same(live: Live) -> None:
    note, issued = (
        live.page.locator("#result .note").first,
        live.page.locator("#result .note").first.inner_text(),
    )
    live.type("x_p", 2, "29.8")
    p = tail(float(live.cell("chi2_eiv").value), 3)
    shown = probability(p).replace("e-", " × 10⁻").translate(str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹"))
    assert p < SIGNIFICANT
    assert shown[-2:] == note.locator("[data-tail]").inner_text()[-2:]
    assert "As issued" not in note.inner_text()
    live.click("live-reset")
    assert note.inner_text() == issued


def test_a_verdict_that_no_longer_holds_says_so(live: Live) -> None:
    note = live.page.locator("#result .note").first
    for test in (4, 5):  # the farthest of all, and then of four
        live.page.locator(f'[data-use="{test}"]').click()
    p = tail(float(live.cell("chi2_eiv").value), 1)
    assert p > SIGNIFICANT
    assert note.inner_text().startswith("As issued, before the edits: No single power law")
    assert note.inner_text().endswith(f"With the edits it is {probability(p)}: this no longer holds.")
    live.page.locator('[data-use="3"]').click()  # two tests are on one curve anyway
    assert note.inner_text().endswith("With the edits there is none: this no longer holds.")


def test_the_last_two_tests_stay_and_that_is_said(live: Live) -> None:
    for test in (3, 4, 5):
        live.page.locator(f'[data-use="{test}"]').click()
    assert live.text("live-note") == ""
    live.page.locator('[data-use="2"]').click()
    assert live.page.locator('[data-use="2"]').is_checked()
    assert live.text("live-note") == "Two tests are the least that a report needs: test 2 stays."
    live.page.locator('[data-remove="1"]').click()
    assert live.text("live-note").endswith("test 1 stays.")
    live.page.locator('[data-use="4"]').click()
    assert live.text("live-note") == ""
