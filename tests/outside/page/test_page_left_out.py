"""What the page knows of a test that is left out: it is taken in, edited and saved as it was given."""

from collections.abc import Callable
from pathlib import Path

import driving
import pytest
from driving import Live

from loopsheet.report import build
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study

Open = Callable[..., Live]

STATED = """\
test,v [m/s],u(v) [mm/s],e [1],u(e) [1],x_p [um],u(x_p) [nm],left out
1,2.200,4,0.5350,0.001,22.58,50,
2,3.100,5,0.5050,0.001,31.92,60,
3,4.300,8,0.4700,0.0012,44.61,80,
4,3.600,8,0.4905,0.0012,38.21,9e2,bad
"""
CONCISE = """\
test,e [1],v [km/h],x_p [um],u(x_p) [nm],left out
1,0.5350(10),7.920,22.58,50,
2,0.5050(10),11.16,31.92,60,
3,0.4700(12),15.480,44.61,80,
4,0.4905(12),12.960,47.21,80,bounced twice
"""


def folder_of(place: Path, table: str, more: str = "") -> Path:
    place.mkdir()
    (place / "measurements.csv").write_text(table, encoding="utf-8")
    toml = (PAPER / "report.toml").read_text(encoding="utf-8").partition("[published]")[0]
    (place / "report.toml").write_text(toml + more, encoding="utf-8")
    return place


def computed(place: Path, table: str, more: str = "") -> Report:
    return Study(folder_of(place, table, more)).computed


@pytest.fixture
def open_table(open_page: Open, tmp_path: Path) -> Callable[..., Live]:
    def open_it(table: str, more: str = "") -> Live:
        folder = folder_of(tmp_path / "issued", table, more)
        build.build(Study(folder), tmp_path / "out", ("html",))
        return open_page(tmp_path / "out" / "report.html")

    return open_it


def saved(live: Live, place: Path) -> str:
    """The table that the page saves."""
    with live.page.expect_download() as found:
        live.click("live-save")
    place.mkdir()
    found.value.save_as(place / found.value.suggested_filename)
    live.page.wait_for_timeout(700)  # the second file comes by itself
    return (place / "measurements.csv").read_text(encoding="utf-8")


@pytest.mark.parametrize("table", [STATED, CONCISE])
def test_what_was_not_edited_is_saved_as_it_was_given(
    open_table: Callable[..., Live], tmp_path: Path, table: str
) -> None:
    live = open_table(table)
    live.type("x_p", 1, "22.60")
    assert saved(live, tmp_path / "saved") == table.replace("22.58", "22.60")
    live.page.locator('[data-use="4"]').click()
    again = table.replace("22.58", "22.60").replace("bad", "").replace("bounced twice", "")
    lines = saved(live, tmp_path / "again")
    assert lines == "".join(line.removesuffix(",") + "\n" for line in again.splitlines()) or lines == again


@pytest.mark.parametrize("table", [STATED, CONCISE])
def test_it_is_taken_in_with_its_own_uncertainty(
    open_table: Callable[..., Live], tmp_path: Path, table: str
) -> None:
    live = open_table(table)
    live.page.locator('[data-use="4"]').click()
    whole = computed(tmp_path / "whole", table.replace("bad", "").replace("bounced twice", ""))
    assert driving.differences(live.cells(), whole.values) == []


def test_a_statement_of_the_column_is_one_of_it(open_table: Callable[..., Live], tmp_path: Path) -> None:
    """What is cut off has no share that the page could take: it comes with the test."""
    table = "\n".join(line.replace("(10)", "").replace("(12)", "") for line in CONCISE.splitlines()) + "\n"
    more = '[uncertainty]\ne = "u = 0.002, min = 0.1"\nv = "0.5 % of reading"\n'
    live = open_table(table, more)
    live.page.locator('[data-use="4"]').click()
    whole = computed(tmp_path / "whole", table.replace("bounced twice", ""), more)
    assert driving.differences(live.cells(), whole.values) == []


def test_a_cell_takes_what_the_table_takes(open_table: Callable[..., Live], tmp_path: Path) -> None:
    live = open_table(CONCISE)
    live.type("e", 1, "0,5355(20)")
    live.type("e", 2, "0.51")
    live.type("e", 3, "0.469953")
    live.click("live-add")
    for name, text in (("v", "9.36"), ("e", "0.52(1)"), ("x_p", "26.6(2)")):
        live.type(name, 5, text)
    folder = tmp_path / "saved"
    lines = saved(live, folder).splitlines()
    assert lines[1:] == [
        "1,0.5355(20),7.920,22.58,50,",
        "2,0.5100(10),11.16,31.92,60,",
        "3,0.469953(1200),15.480,44.61,80,",
        "4,0.4905(12),12.960,47.21,80,bounced twice",
        "5,0.52(1),9.36,26.6,200,",
    ]
    table = "\n".join([CONCISE.splitlines()[0], *lines[1:]]) + "\n"
    assert driving.differences(live.cells(), computed(tmp_path / "again", table).values) == []


def test_how_sure_a_new_row_is_has_to_be_said(open_table: Callable[..., Live]) -> None:
    """Of e each row says it; of the others a column or nobody does."""
    live = open_table(CONCISE)
    live.click("live-add")
    said = "How sure e of a new row is, its digits tell, unless its u is written behind it, as in 46.7(5)."
    assert live.text("live-note") == said
    live.input("e", 3).click()
    assert live.text("live-note") == said
    live.paste("0.5350(10)\n0.5350\n0.5350\n0.5350\n")
    assert live.text("live-note").endswith(said)


def test_no_uncertainty_is_made_up_where_a_column_states_them(
    open_table: Callable[..., Live], tmp_path: Path
) -> None:
    """Of a row that was added it is not known before it is typed, nor is that of what rests on it."""
    live = open_table(CONCISE)
    live.click("live-add")
    for name, text in (("v", "9.36"), ("e", "0.52(1)"), ("x_p", "26.6")):
        live.type(name, 5, text)
    assert "x_p[5]: its u is not known" in live.text("live-note")
    assert "not known: nothing states u of x_p[5]" in live.page.inner_html("#uncertain")
    live.page.locator('#live-panel td span:text-is("–")').first.wait_for(state="attached")
    assert saved(live, tmp_path / "saved").splitlines()[5] == "5,0.52(1),9.36,26.6,,"
    assert live.text("live-note").endswith("To be filled before a build: u(x_p) of test 5.")
    live.type("x_p", 5, "26.6(2)")
    assert "not known" not in live.page.inner_html("#uncertain")


def test_what_floats_over_the_page_is_not_printed(open_table: Callable[..., Live]) -> None:
    """In a narrow window the result stands at its top: on paper it would on every sheet."""
    live = open_table(CONCISE)
    live.page.set_viewport_size({"width": 700, "height": 720})
    live.type("v", 1, "7.925")
    live.page.locator("#live-panel:not(.beside)").wait_for()
    live.page.emulate_media(media="print")
    assert live.page.locator("#live-panel").is_hidden()


def test_what_a_cell_does_not_take_it_says_in_words(open_table: Callable[..., Live]) -> None:
    live = open_table(STATED.replace("9e2", "much"))
    live.type("x_p", 1, "22.58(5)")
    told = "“22.58(5)” says how sure it is, and so does the column u(x_p): write 22.58"
    assert told in live.cell("x_p", "1").title
    live.press("Control+z")
    live.page.locator('[data-use="4"]').click()
    told = "“much” in the column u(x_p) is not a standard uncertainty of at least 0"
    assert told in live.cell("x_p", "4").title
    live.input("points_per_pair").fill("20(1)")
    live.press("Enter")
    assert "“20(1)” is not a number" in live.cell("points_per_pair").title


def test_what_is_said_around_it_is_so(open_table: Callable[..., Live]) -> None:
    """The list of three uncertainties is none of four tests; counted is what the curve was fitted to."""
    live = open_table(STATED)
    stale = live.page.get_by_text("This list of stated uncertainties is as issued, before the edits.")
    assert stale.count() == 0 or not stale.first.is_visible()
    live.page.locator('[data-use="4"]').click()
    assert stale.first.is_visible()
    counted = live.page.locator("#result p", has_text="The curve nearest to all")
    assert "nearest to all 4 tests" in counted.inner_text()
    live.type("e", 1, "abc")
    assert "nearest to all 3 tests" in counted.inner_text()


def test_one_of_paired_readings_alone_is_told_to_be_none(open_page: Open, tmp_path: Path) -> None:
    """No build takes a row in which one of them is missing: the page says what to do."""
    build.build(Study(PAPER.parent / "gum_h2"), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html")
    live.input("V", 2).click()
    live.press("Delete")
    assert "a build takes none alone: leave the row out" in live.text("live-banner")
    live.press("Control+z")
    assert live.text("live-banner") == ""
