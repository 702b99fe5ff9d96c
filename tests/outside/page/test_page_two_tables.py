"""Two tables of rows in the page: each is edited, grows and is saved by itself."""

from collections.abc import Callable
from pathlib import Path

import driving
import pytest
import two_tables
from driving import Live

from loopsheet.report.build import build
from loopsheet.report.study import Study

Open = Callable[..., Live]
FILES = "standards.csv", "samples-today.csv"


def opened(folder: Path, open_page: Open) -> Live:
    build(Study(folder), folder / "out", ("html",))
    return open_page(folder / "out" / "report.html")


@pytest.fixture
def live(open_page: Open, tmp_path: Path) -> Live:
    return opened(two_tables.write(tmp_path / "issued"), open_page)


def test_an_edit_of_either_moves_what_rests_on_it(live: Live, tmp_path: Path) -> None:
    issued = Study(tmp_path / "issued").computed.values
    live.type("y_s", 2, "0.553")  # there is a standard 2, too
    assert live.cell("y", "2").text == "0.209"
    live.type("y", 2, "0.213")
    again = two_tables.write(
        tmp_path / "again",
        today=two_tables.SAMPLES.replace("0.501", "0.553"),
        standards=two_tables.STANDARDS.replace("0.209", "0.213"),
    )
    report = Study(again).computed
    assert driving.differences(live.cells(), report.values) == []
    assert driving.differences(live.cells(), issued) != []
    built = driving.static(report, tmp_path / "again.html")
    live.page.locator('main [data-cell="x"][data-index="2"]').first.click()
    assert live.page.locator("#bar-name code").text_content() == "x[2]"
    beside = "all => all.map((one) => one.dataset.goto)"
    assert live.page.locator("#bar-precedents button").evaluate_all(beside) == ["y_s[2]", "m", "b"]
    live.input("y_s", 2).click()
    assert live.text("bar-source") == "given, in samples-today.csv, sample 2"
    assert built.exists()
    live.click("live-undo")
    live.click("live-undo")
    assert live.text("live-banner") == ""
    assert driving.differences(live.cells(), issued) == []
    assert live.heard() == []


def test_rows_of_either_are_left_out_removed_and_added(live: Live, tmp_path: Path) -> None:
    standards, samples = (live.page.locator(f"table:has(input[data-cell={name}])") for name in ("y", "y_s"))
    samples.locator('[data-use="2"]').click()
    assert standards.locator('[data-use="2"]').is_checked()
    samples.locator('[data-reason="2"]').fill("turbid")
    live.press("Tab")
    standards.locator('[data-use="7"]').click()  # that is taken in again
    samples.locator('[data-remove="4"]').click()
    assert standards.locator('[data-remove="4"]').count() == 1
    live.page.get_by_role("button", name="Add a sample").click()
    assert live.focused() == "y_s[5]"
    live.page.keyboard.type("0.443(4)")
    live.press("Enter")
    samples.locator('[data-use="1"]').click()
    samples.locator('[data-use="5"]').click()
    assert "One sample is the least that a report needs: sample 5 stays." in live.text("live-note")
    samples.locator('[data-use="1"]').click()
    folder = live.save(tmp_path / "saved", "workbook.py", file=FILES)
    assert (folder / "samples-today.csv").read_text(encoding="utf-8").splitlines() == [
        "sample,lot,y_s [1],u(y_s) [1],left out",
        "1,A-1,0.314,0.002,",
        "2,A-2,0.501,0.003,turbid",
        "4,B-7,0.677,0.002,removed",
        "5,sample 5,0.443,0.004,",
    ]
    assert (folder / "standards.csv").read_text(encoding="utf-8").splitlines()[-1] == "7,9.00,0.951,"
    report = Study(folder).computed
    assert report.inputs.on("samples").tests == (1, 5)
    assert report.inputs.on("standards").tests == (1, 2, 3, 4, 5, 7)
    assert driving.differences(live.cells(), report.values) == []
    assert live.heard() == []


def test_a_block_is_pasted_into_the_table_that_has_the_focus(live: Live, tmp_path: Path) -> None:
    live.input("y_s", 1).click()
    live.paste("sample\ty_s [1]\n1\t0.321\n4\t0.654\n")
    assert live.text("live-note") == ""
    assert (live.cell("y_s", "4").text, live.cell("y", "4").text) == ("0.654", "0.605")
    live.paste("standard\ty [1]\n1\t0.2\n")
    assert live.text("live-note").startswith("Nothing was pasted")
    again = two_tables.write(
        tmp_path / "again", today=two_tables.SAMPLES.replace("0.314", "0.321").replace("0.677", "0.654")
    )
    assert driving.differences(live.cells(), Study(again).computed.values) == []


def test_edits_of_both_last(live: Live, tmp_path: Path) -> None:
    live.type("y_s", 2, "0.553")
    live.type("y", 2, "0.213")
    live.page.on("dialog", lambda asked: asked.accept())  # a page that is stayed at says nothing of last time
    live.page.reload()
    live.page.wait_for_selector("html[data-live=ready]")
    assert live.text("live-note") == "Your edits of last time are here again."
    assert (live.cell("y_s", "2").text, live.cell("y", "2").text) == ("0.553", "0.213")
    assert live.text("live-banner").startswith("Edited: 2 inputs differ")


def test_a_row_that_is_gone_does_not_leave_the_focus_to_the_other_table(live: Live) -> None:
    samples = live.page.locator("table:has(input[data-cell=y_s])")
    live.page.get_by_role("button", name="Add a sample").click()
    samples.locator('[data-use="5"]').focus()  # there is a standard 5, too
    live.press("Control+z", "Space")
    assert live.text("live-banner") == ""
    assert live.page.locator('[data-use="5"]').is_checked()
