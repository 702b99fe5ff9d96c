"""The live page as its users meet it: typed into, pasted into, taken back, saved; always against NumPy."""

import random
import re
from collections.abc import Callable
from pathlib import Path

import driving
import pytest
from campaign_sizes import SEED, Sizes
from driving import Live
from test_toy_workbook import FILES as ORBIT

from loopsheet.report import build
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.messages.errors import InputError
from loopsheet.report.study import Study
from loopsheet.report.views import live as live_view

Open = Callable[..., Live]

DEEPER = {("x_p", 2): "29.8"}
LIVELIER = {("e", 2): ".900"}


# --- an edit ------------------------------------------------------------------------------------------------


def test_edit_recalculates_every_cell_as_numpy_does(live: Live, open_page: Open, tmp_path: Path) -> None:
    before = {(cell.name, cell.index, n): cell for n, cell in enumerate(live.cells())}
    live.type("x_p", 2, "29.8")
    report = driving.built(tmp_path / "folder", driving.edited(DEEPER), published=True)
    cells = live.cells()
    assert driving.differences(cells, report.values) == []
    assert float(live.cell("alpha", "1-2").value) == pytest.approx(1.2277, abs=5e-5)
    assert float(live.cell("alpha_mean").value) == pytest.approx(1.3049, abs=5e-5)
    # What it shows is what Python would have printed.
    fresh = open_page(driving.static(report, tmp_path / "edited.html"))
    assert driving.alike(driving.shown(cells), driving.shown(fresh.cells()))
    assert driving.alike(live.around(), fresh.around())
    # Marked is what changed, nothing else.
    differing = {
        place for place, cell in before.items() if not driving.close(cells[place[2]].value, float(cell.value))
    }
    assert differing == {(cell.name, cell.index, n) for n, cell in enumerate(cells) if cell.changed}
    assert {("x_p", "2"), ("alpha", "1-2"), ("alpha_mean", "")} < {place[:2] for place in differing}
    assert ("alpha", "1-3") not in {place[:2] for place in differing}
    assert not any(cell.added for cell in cells)
    assert live.text("live-banner") == "Edited: 1 input differs from the report as issued."
    assert live.cell("alpha", "1-2").title == "as issued: 1.258"


def test_the_banner_says_what_has_no_value_now(live: Live) -> None:
    live.type("x_p", 3, "lost")
    differs = "Edited: 1 input differs from the report as issued."
    assert live.text("live-banner") == f"{differs} Without a value now: x_p[3], and what needs it."
    live.click("live-undo")
    live.type("beta", "", "none")
    gone = "alpha_eiv, C_eiv, chi2_eiv, alpha_mean and 5 more"
    assert live.text("live-banner") == f"{differs} Without a value now: {gone}."
    live.type("beta", "", "1.4")
    assert live.text("live-banner") == differs


def test_figures_are_drawn_again(live: Live) -> None:
    drawn = "#figure-loops svg.picture"
    assert live.page.locator(drawn).count() == 0  # the issued picture was drawn by another program
    live.type("x_p", 2, "29.8")
    first = {name: live.paths(name) for name in ("loops", "alpha_pairs")}
    live.type("x_p", 2, "31")
    for name, paths in first.items():
        again = live.paths(name)
        assert len(paths) > 3
        assert again != paths
        assert not re.search("NaN|Infinity|undefined", "".join(again))
    live.click("live-undo")
    assert live.paths("loops") == first["loops"]
    assert live.page.locator(drawn).count() == 1
    live.click("live-undo")
    assert live.page.locator(drawn).count() == 0


def test_a_chart_of_ones_own_is_drawn_again(open_page: Open, tmp_path: Path) -> None:
    for name, text in ORBIT.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    build.build(Study(tmp_path), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html")
    live.type("t", 2, "110")
    first = live.paths("orbit")
    live.type("t", 2, "120")
    again = live.paths("orbit")
    assert len(first) == len(again) > 5
    assert first != again
    assert not re.search("NaN|Infinity|undefined", "".join(again))
    live.drawn()
    said = live.page.locator("#figure-orbit svg text").all_text_contents()
    assert {"half a turn after each sighting", "3 sightings", "distance r / Gm", "2", "3", "4"} <= set(said)


def test_pair_without_a_root_says_why_as_the_terminal_does(
    live: Live, open_page: Open, tmp_path: Path
) -> None:
    live.type("e", 2, ".900")
    report = driving.built(tmp_path / "folder", driving.edited(LIVELIER), published=True)
    assert driving.differences(live.cells(), report.values) == []
    assert live.cell("alpha", "1-2").status == "#NOROOT!"
    broken = [cell for cell in live.cells() if cell.status != "ok"]
    assert len({cell.name for cell in broken}) > 3
    for cell in broken:
        label = tuple(int(part) for part in cell.index.split("-")) if cell.index else ()
        assert cell.text == cell.status
        assert cell.title.startswith(report.values.cell(cell.name, label).reason), cell
    fresh = open_page(driving.static(report, tmp_path / "edited.html"))
    assert driving.alike(live.around(), fresh.around())
    # The formula bar names the cell where the error began, and leads there.
    live.page.locator("#cell-C-1-2").click(position={"x": 3, "y": 3})
    origin = report.values.cell("C", (1, 2)).culprit
    assert origin is not None
    assert live.text("bar-reason").startswith(f"needs {origin.address} #NOROOT!: ")
    assert origin.why in live.text("bar-reason")
    live.page.locator(f'#bar-reason button[data-goto="{origin.address}"]').click()
    assert live.focused() == "alpha[1-2]"
    assert live.text("bar-reason") == origin.why
    # The code in the cell leads to the row that says why.
    live.page.locator("#cell-C-1-2 a").click()
    assert live.page.url.endswith("#why-alpha-1-2")
    assert live.page.locator("#why-alpha-1-2").is_visible()


FASTER = {("v", 2): "4.0", ("e", 4): ".48"}


def test_cells_outside_of_what_is_expected_are_marked_and_counted(
    live: Live, open_page: Open, tmp_path: Path
) -> None:
    assert not any(cell.mark for cell in live.cells())
    assert "10 of 10 pairs lie inside" in live.text("result")
    before = live.state()
    live.type("v", 2, "4.0")
    live.type("e", 4, ".48")
    live.type("ball_diameter", "", ".05")
    folder = driving.write(tmp_path / "folder", driving.edited(FASTER), published=True)
    toml = folder / "report.toml"
    toml.write_text(toml.read_text(encoding="utf-8").replace("12.7 mm", ".05 mm"), encoding="utf-8")
    report = Study(folder).computed
    cells = live.cells()
    assert driving.differences(cells, report.values) == []
    for name in ("alpha", "x_p", "alpha_mean", "alpha_lin", "v"):
        ours = {cell.mark for cell in cells if cell.name == name}
        assert ours == set(report.marks.of(name)), name
        assert (ours == {""}) == (name in ("alpha_mean", "v"))
    fresh = open_page(driving.static(report, tmp_path / "edited.html"))
    assert driving.alike(driving.shown(cells), driving.shown(fresh.cells()))
    live.wait_for_draws()
    assert driving.alike(live.around(), fresh.around())
    told = live.page.locator("#missing").text_content() or ""
    assert "deeper than the radius of the ball" in told
    assert "e rises with the speed" in told
    assert live.cell("alpha", "1-2").title == "outside (4); as issued: 1.258"
    inside = report.marks.limited("alpha").inside
    assert f"{inside} lie inside" in live.text("result")
    assert live.page.locator("#table-alpha .marks").is_visible()
    assert not live.page.locator("#table-tests .marks").is_visible()
    live.click("live-reset")
    assert live.state() == before


NO_NUMBERS = ("abc", "-3", "0", "1e999", "", "1..2", "0x10", "NaN", "<b>1</b>", "∞")


def test_input_that_is_no_number_says_so(live: Live, tmp_path: Path) -> None:
    report = driving.built(tmp_path / "folder", driving.paper())
    values = driving.with_missing(report, ("x_p", 3))
    for text in NO_NUMBERS:
        if text:
            live.type("x_p", 3, text)
        else:
            live.input("x_p", 3).click()
            live.press("Delete")
        assert driving.differences(live.cells(), values) == [], text
        cell = live.cell("x_p", "3")
        assert (cell.status, cell.text) == ("#INPUT!", text)
        assert cell.title.startswith("#INPUT! x_p[3]: ")
        assert "; it must be " in cell.title
        assert live.cell("alpha", "3-4").title.startswith("#INPUT! alpha[3-4] needs x_p[3]: ")
    assert live.input("x_p", 3).get_attribute("aria-invalid") == "true"
    # The page goes on.
    live.type("x_p", 3, "41.6")
    assert driving.differences(live.cells(), report.values) == []
    assert live.text("live-banner") == ""
    assert live.input("x_p", 3).get_attribute("aria-invalid") is None


REFUSED = {("v", 1): "0", ("e", 1): "1.2", ("x_p", 1): "-23.5", ("v", 2): "fast", ("x_p", 2): ""}


def test_what_is_pasted_is_refused_as_the_reader_refuses_it(open_page: Open, tmp_path: Path) -> None:
    """In the same cells, in the words of the reader; taken back, all is as it was."""
    live = open_page(permissions=["clipboard-read", "clipboard-write"])
    before = live.cells()
    live.input("v", 1).click()
    block = "0\t1.2\t-23.5\nfast\t0.512\t\n"
    live.page.evaluate("text => navigator.clipboard.writeText(text)", block)
    live.press("Control+v")
    with pytest.raises(InputError) as told:
        driving.built(tmp_path / "folder", driving.edited(REFUSED))
    findings = told.value.diagnostics
    places = [(2, "LS406"), (2, "LS406"), (2, "LS406"), (3, "LS401")]
    assert [(finding.at.line, finding.code) for finding in findings] == places
    for (name, test), text in REFUSED.items():
        cell = live.cell(name, str(test))
        assert (cell.status, cell.text) == ("#INPUT!", text)
        allowed = [d.allowed for d in findings if d.code == "LS406" and d.message.startswith(f"{name} ")]
        assert f"it must be {allowed[0]}; as issued" in cell.title
    report = driving.built(tmp_path / "issued", driving.paper())
    values = driving.with_missing(report, *REFUSED)
    assert driving.differences(live.cells(), values) == []
    live.press("Control+z")
    assert live.cells() == before
    live.press("Control+y")
    assert driving.differences(live.cells(), values) == []


@pytest.mark.parametrize("first", ["n/a\tn/a\tn/a", "\t\t", "NaN\t0.53\t23.5", "0,5 mm\t.53\t23.5"])
def test_a_line_without_data_keeps_its_row(open_page: Open, first: str) -> None:
    """Or the next line would be taken for another test's."""
    live = open_page(permissions=["clipboard-read", "clipboard-write"])
    live.input("v", 1).click()
    live.page.evaluate("text => navigator.clipboard.writeText(text)", f"{first}\n2.95\t0.512\t29.8\n")
    live.press("Control+v")
    assert live.cell("v", "1").status == "#INPUT!"
    assert [live.input(name, 2).input_value() for name in ("v", "e", "x_p")] == ["2.95", "0.512", "29.8"]
    assert live.input("v", 3).input_value() == "4.089"


def test_a_comma_that_may_group_digits_is_not_guessed(open_page: Open) -> None:
    """As the reader of a folder: 1,234 is a little more than one, or a thousand."""
    live = open_page(permissions=["clipboard-read", "clipboard-write"])
    live.type("v", 2, "2,940", key="Enter")
    assert live.input("v", 2).input_value() == "2,940"
    assert live.cell("v", "2").status == "#INPUT!"
    live.input("v", 2).click()
    assert "“2,940” is not a number: write 2.940 or 2940, whichever is meant" in live.text("bar-reason")
    live.paste("2,940\t0.512\n")
    assert live.cell("v", "2").status == "#INPUT!"
    live.press("Control+z")
    live.input("v", 2).click()
    live.paste("2,940\t0,512\n")  # here the block tells
    assert live.input("v", 2).input_value() == "2.940"
    assert live.input("e", 2).input_value() == "0.512"


def test_what_is_no_number_stays_as_it_was_typed(live: Live) -> None:
    """Without its comma it would be another number, but for a word that is soon taken away."""
    for typed in ("200.0, exact", "2.940 m/s, u = 0.01", "1,5 mm"):
        live.type("v", 2, typed, key="Enter")
        assert live.input("v", 2).input_value() == typed
        assert live.cell("v", "2").status == "#INPUT!"
    live.type("v", 2, "2.940,5(2)", key="Enter")
    assert live.input("v", 2).input_value() == "2940.5(2)"


def test_what_printed_digits_may_explain_is_left_to_a_build(open_page: Open, tmp_path: Path) -> None:
    """A page has no referee: of what was edited it says that it differs, of all else what was found."""
    build.build(Study(PAPER.parent / "worked_example"), tmp_path, ("html",))
    live = open_page(tmp_path / "report.html")
    before = live.around()
    live.type("x_p", 2, "0.03400", key="Enter")
    live.state()  # once it has been recalculated
    rows = [text for text in live.around() if re.search(r"differs|same", text)]
    number = sum(text.endswith("differs") for text in rows)
    assert 0 < number < sum("differs" in text or "same" in text for text in rows)
    assert not any("unexpectedly" in text for text in live.around())
    (told,) = (text for text in live.around() if text.startswith("Of ") and "published values" in text)
    assert f"A build of what stands here tells whether printed digits explain {number} of these" in told
    live.press("Control+z")
    live.state()
    assert live.around() == before


def test_parameters_are_edited_too(live: Live, tmp_path: Path) -> None:
    live.type("beta", "", "1,25")
    folder = driving.write(tmp_path / "folder", driving.paper())
    toml = folder / "report.toml"
    toml.write_text(toml.read_text(encoding="utf-8").replace('"1.5"', '"1.25"'), encoding="utf-8")
    assert driving.differences(live.cells(), Study(folder).computed.values) == []
    assert live.input("beta").input_value() == "1.25"


def test_scripts_do_not_take_each_others_names() -> None:
    """They share one scope with the program that computes, where the last of two functions would win."""
    templates = Path(live_view.__file__).parents[2] / "templates"
    paths = [templates / "engines" / "runtime.js", *(templates / "live" / name for name in live_view.SCRIPTS)]
    names: list[str] = []
    for path in paths:
        text = path.read_text(encoding="utf-8")
        names += re.findall(r"^(?:async )?(?:function\*?|const|let|class) (\w+)", text, re.MULTILINE)
    assert len(names) > 100
    assert [name for name in set(names) if names.count(name) > 1] == []


# --- taking back --------------------------------------------------------------------------------------------


def test_reset_restores_every_character(live: Live) -> None:
    before = live.state()
    live.type("e", 2, ".9")
    live.page.locator("#cell-C-1-2").click(position={"x": 3, "y": 3})
    live.page.locator('[data-use="4"]').click()
    live.page.locator('[data-remove="5"]').click()
    live.click("live-add")
    live.page.keyboard.type("5.2")
    live.press("Enter")
    live.type("beta", "", "xyz")
    assert live.state() != before
    live.click("live-reset")
    assert live.state() == before
    assert live.text("live-banner") == ""
    assert not live.page.evaluate("() => 'edited' in document.documentElement.dataset")
    # A reset can be taken back as well.
    live.click("live-undo")
    assert live.cell("beta").status == "#INPUT!"


def test_undo_and_redo(live: Live, tmp_path: Path) -> None:
    undo, redo = live.page.locator("#live-undo"), live.page.locator("#live-redo")
    assert undo.is_disabled()
    assert redo.is_disabled()
    live.type("x_p", 2, "29.8")
    once = live.cells()
    live.type("v", 4, "4.6")
    twice = live.cells()
    undo.click()
    assert live.cells() == once
    live.press("Control+z")
    assert [c for c in live.cells() if c.changed] == []
    assert undo.is_disabled()
    live.press("Control+y")
    assert live.cells() == once
    live.press("Control+Shift+z")
    assert live.cells() == twice
    assert redo.is_disabled()
    undo.click()
    undo.click()
    assert live.page.locator("#live-reset").is_disabled()
    assert live.text("live-banner") == ""
    redo.click()
    assert live.cells() == once
    # A new edit ends what could be redone.
    live.type("e", 1, "0.5")
    assert redo.is_disabled()
    both = driving.edited({**DEEPER, ("e", 1): "0.5"})
    assert driving.differences(live.cells(), driving.built(tmp_path / "f", both).values) == []


# --- tests come and go --------------------------------------------------------------------------------------


def test_excluded_test_has_no_part_and_comes_back(live: Live, tmp_path: Path) -> None:
    before = live.cells()
    live.page.locator('[data-use="3"]').click()
    four = driving.paper()
    del four[3]
    report = driving.built(tmp_path / "four", four)
    assert driving.differences(live.cells(), report.values) == []
    assert live.input("x_p", 3).input_value() == "41.6"
    assert live.page.locator('tr.excluded[data-label="3"]').count() == 1
    # An edit of it changes nothing but itself.
    live.type("x_p", 3, "40")
    assert driving.differences(live.cells(), report.values) == []
    live.type("x_p", 3, "41.6")
    live.page.locator('[data-use="3"]').click()
    assert live.cells() == before
    live.page.locator('[data-remove="3"]').click()
    assert driving.differences(live.cells(), report.values) == []
    assert live.page.locator('tr[data-label="3"] input').count() == 0
    live.press("Control+z")
    assert [(c.name, c.index, c.value) for c in live.cells()] == [(c.name, c.index, c.value) for c in before]


def test_two_tests_stay(live: Live) -> None:
    for test in (1, 2, 3):
        live.page.locator(f'[data-use="{test}"]').click()
    live.page.locator('[data-use="4"]').click()
    assert live.page.locator('[data-use="4"]').is_checked()
    live.page.locator('[data-remove="5"]').click()
    assert "Two tests" in live.text("live-note")
    assert live.input("v", 5).count() == 1


def test_sixth_test(live: Live, open_page: Open, tmp_path: Path) -> None:
    live.click("live-add")
    assert live.focused() == "v[6]"
    assert live.cell("v", "6").status == "#INPUT!"
    for text in ("5.5", "0.44", "56.6"):
        live.page.keyboard.type(text)
        live.press("Tab")
    six = {**driving.paper(), 6: {"v": "5.5", "e": "0.44", "x_p": "56.6"}}
    report = driving.built(tmp_path / "six", six)
    cells = live.cells()
    assert driving.differences(cells, report.values) == []
    assert {(c.name, c.index) for c in cells if c.added} > {("v", "6"), ("alpha", "1-6"), ("x_m", "6")}
    fresh = open_page(driving.static(report, tmp_path / "six.html"))
    assert driving.alike(driving.shown(fresh.cells()), driving.shown(cells))
    assert live.text("live-note") == ""


# --- the clipboard ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "block",
    [
        "2,334\t0,530\t23,5\r\n2,940\t0,512\t29,8\r\n",  # as a spreadsheet gives it, with its last line end
        "v\te\tx_p\n2.334\t0.530\t23.5\n2.940\t.512\t29.8",  # with a head
    ],
)
def test_block_is_pasted(open_page: Open, tmp_path: Path, block: str) -> None:
    live = open_page(permissions=["clipboard-read", "clipboard-write"])
    live.input("v", 1).click()
    live.page.evaluate("text => navigator.clipboard.writeText(text)", block)
    live.press("Control+v")
    report = driving.built(tmp_path / "folder", driving.edited(DEEPER))
    assert driving.differences(live.cells(), report.values) == []
    assert live.text("live-banner").startswith("Edited: ")
    live.press("Control+z")
    assert live.text("live-banner") == ""


def test_pasted_block_makes_new_tests_and_stays_within_its_columns(open_page: Open, tmp_path: Path) -> None:
    live = open_page(permissions=["clipboard-read", "clipboard-write"])
    live.input("e", 5).click()
    live.paste("0.453\t51.03\t999\n0.44\t56.6\t999\n")
    assert live.text("live-note") == "Nothing was pasted: 3 columns for 2: copy them with their heads."
    assert live.text("live-banner") == ""
    live.paste("0.453\t51.03\n0.44\t56.6\t999\n")
    assert live.text("live-note") == "Nothing was pasted: 3 columns for 2: copy them with their heads."
    live.paste("0.453\t51.03\t\n0.44\t56.6\t\n")
    assert live.cell("v", "6").status == "#INPUT!"
    live.type("v", 6, "5.5")
    six = {**driving.paper(), 6: {"v": "5.5", "e": "0.44", "x_p": "56.6"}}
    assert driving.differences(live.cells(), driving.built(tmp_path / "six", six).values) == []


NAMED = {("v", 1): "2.4", ("v", 2): "3.0", ("x_p", 1): "24.1", ("x_p", 2): "30.1"}


@pytest.mark.parametrize(
    ("cell", "block", "said"),
    [
        ("e", "x_p [µm]\tv [m/s]\n24,1\t2,4\n\n30,1\t3,0\n", ""),  # a blank line is no row
        ("v", "test\tv\tx_p [um]\n2\t3.0\t30.1\n1\t2.4\t24.1\n", ""),
        ("v", "v\twhere\tx_p\n2.4\tlab 3\t24.1\n3.0\tlab 4\t30.1\n", "Pasted, but 1 column had no place."),
        ("v", "test\tv\tx_p\n2\t3.0\t30.1\n9\t2\t2\n1\t2.4\t24.1\n", "Pasted, but 1 row had no place."),
    ],
)
def test_names_in_the_first_line_choose_the_columns(
    open_page: Open, tmp_path: Path, cell: str, block: str, said: str
) -> None:
    live = open_page(permissions=["clipboard-read", "clipboard-write"])
    live.input(cell, 1).click()
    live.paste(block)
    report = driving.built(tmp_path / "folder", driving.edited(NAMED))
    assert driving.differences(live.cells(), report.values) == []
    assert live.text("live-note") == said


def test_a_column_of_the_rows_numbers_is_known(open_page: Open, tmp_path: Path) -> None:
    live = open_page(permissions=["clipboard-read", "clipboard-write"])
    live.input("v", 4).click()
    live.paste("2\t3.0\t0.512\t30.1\n1\t2.4\t0.530\t24.1\n")
    report = driving.built(tmp_path / "folder", driving.edited(NAMED))
    assert driving.differences(live.cells(), report.values) == []


@pytest.mark.parametrize("head", ["", "test\tv\te\tx_p\n"])
@pytest.mark.parametrize("first", [1, 5, 6])
def test_rows_are_added_whose_numbers_come_next(
    open_page: Open, tmp_path: Path, first: int, head: str
) -> None:
    live = open_page(permissions=["clipboard-read", "clipboard-write"])
    rows = {**driving.paper(), 6: {"v": "5.5", "e": "0.44", "x_p": "56.6"}}
    rows[7] = {"v": "5.9", "e": "0.43", "x_p": "60.6"}
    live.input("v", min(first, 5)).click()
    block = "".join("\t".join((str(n), *row.values())) + "\n" for n, row in rows.items() if n >= first)
    live.paste(head + block)
    assert live.text("live-note") == ""
    assert driving.differences(live.cells(), driving.built(tmp_path / "folder", rows).values) == []


@pytest.mark.parametrize("rows", [(101,), (101, 102), (101, 103), (1, 8)])
def test_numbers_of_rows_that_are_not_here_are_no_measurements(
    open_page: Open, rows: tuple[int, ...]
) -> None:
    live = open_page(permissions=["clipboard-read", "clipboard-write"])
    live.input("v", 1).click()
    live.paste("".join(f"{row}\t2.1\t0.5\t24.1\n" for row in rows))
    assert live.text("live-note") == "Nothing was pasted: 4 columns for 3: copy them with their heads."
    assert live.text("live-banner") == ""


@pytest.mark.parametrize(
    ("block", "said"),
    [
        ("x_p [mm]\tv [m/s]\n0.0241\t2.4\n", "x_p is in µm here, not in mm."),
        ("speed\tdepth\n2.4\t24.1\n", "no such column is typed here: speed, depth."),
        (
            "v\tu(v)\n2.4\t0.01\n",
            "no column u(v) is typed here: leave it out, or write u behind the number, as 46.7(5).",
        ),
        ("test\tv\n3\t3.5\n2\t3.1\n3\t3.6\n", "test 3 stands twice in it."),
    ],
)
def test_a_block_that_nobody_can_place_is_refused(open_page: Open, block: str, said: str) -> None:
    live = open_page(permissions=["clipboard-read", "clipboard-write"])
    live.input("v", 1).click()
    live.paste(block)
    assert live.text("live-banner") == ""
    assert live.text("live-note") == f"Nothing was pasted: {said}"


def test_one_number_is_pasted_into_a_cell(open_page: Open) -> None:
    live = open_page(permissions=["clipboard-read", "clipboard-write"])
    live.input("x_p", 2).click()
    live.page.evaluate("text => navigator.clipboard.writeText(text)", "29,8\n")
    live.press("Control+v", "Enter")
    assert live.input("x_p", 2).input_value() == "29.8"
    assert float(live.cell("alpha", "1-2").value) == pytest.approx(1.2277, abs=5e-5)


# --- saving -------------------------------------------------------------------------------------------------


def test_saved_files_give_the_numbers_of_the_page(live: Live, tmp_path: Path) -> None:
    live.type("x_p", 2, "29.8")
    live.type("beta", "", "1.4")
    live.page.locator('[data-use="4"]').click()
    folder = live.save(tmp_path / "saved")
    text = (folder / "measurements.csv").read_text(encoding="utf-8")
    assert text.splitlines() == [
        "test,v [m/s],e [1],x_p [um],left out", "1,2.334,0.530,23.5,", "2,2.940,0.512,29.8,",
        "3,4.089,0.479,41.6,", "4,4.504,0.467,45.97,no reason was given", "5,4.993,0.453,51.03,",
    ]  # fmt: skip
    toml = (folder / "report.toml").read_text(encoding="utf-8")
    assert toml == (PAPER / "report.toml").read_text(encoding="utf-8").replace('"1.5"', '"1.4"')
    assert (folder / "published.csv").read_bytes() == (PAPER / "published.csv").read_bytes()
    assert driving.differences(live.cells(), Study(folder).computed.values) == []


# --- what a page must not do --------------------------------------------------------------------------------


def test_page_asks_for_nothing_but_itself(live: Live) -> None:
    live.type("e", 2, ".9")
    live.page.locator("#cell-alpha-2-3").click()
    live.click("live-reset")
    # Its worker is made of its own script.
    asked = [address for address in live.requests if not address.startswith("blob:")]
    assert asked == [live.path.as_uri()]


_INJECT = """async () => {
  const seen = [];
  document.addEventListener("securitypolicyviolation", (event) => seen.push(event.effectiveDirective));
  const script = document.createElement("script");
  script.textContent = "window.ran = 'script'";
  const button = document.createElement("button");
  button.setAttribute("onclick", "window.ran = 'attribute'");
  const image = document.createElement("img"), styled = document.createElement("p");
  image.src = "https://example.org/pixel.png";
  styled.setAttribute("style", "color: red");
  document.body.append(script, button, image, styled);
  button.click();
  try { await fetch("https://example.org/"); } catch { seen.push("fetch failed"); }
  // What is stopped is told a little later; all that runs in spite of it has run by then.
  const wait = () => new Promise((resolve) => setTimeout(resolve, 50));
  for (let n = 0; n < 200 && new Set(seen).size < 6; n++) await wait();
  await wait();
  return { ran: window.ran ?? null, seen: [...new Set(seen)].sort(), width: image.naturalWidth };
}"""


def test_policy_stops_what_is_injected(live: Live) -> None:
    found = live.page.evaluate(_INJECT)
    assert found["ran"] is None
    assert found["width"] == 0
    assert found["seen"] == [
        "connect-src", "fetch failed", "img-src", "script-src-attr", "script-src-elem",
        "style-src-attr",
    ]  # fmt: skip
    assert live.errors
    live.errors.clear()  # the browser reports every one of them


# --- the comparison itself ----------------------------------------------------------------------------------

_OTHERS = {"+": "-", "-": "+", "*": "/", "/": "*"}


def mutants(text: str, names: set[str], seed: int) -> list[str]:
    """The page with one operator of one column's kernel changed, one page for each column that is shown."""
    found = []
    chance = random.Random(seed)
    for name in sorted(names):
        kernel = re.search(
            rf'\{{name:"{name}",[^{{}}]*?kernels:.*?value:(?P<code>.*?)(?=,requires:|\}};\}}\}}[,\]\n])',
            text,
            re.DOTALL,
        )
        if kernel is None:
            continue
        places = [
            kernel.start("code") + found_at.start()
            for found_at in re.finditer(r"(?<=[\w\])])[-+*/](?=[\w(])", kernel["code"])
        ]
        if places:
            place = chance.choice(places)
            found.append(text[:place] + _OTHERS[text[place]] + text[place + 1 :])
    return found


@pytest.mark.campaigns
def test_one_changed_character_of_the_program_is_noticed(
    live: Live, open_page: Open, issued: Path, tmp_path: Path, sizes: Sizes, summary: Callable[[str], None]
) -> None:
    values = driving.built(tmp_path / "folder", driving.edited(DEEPER)).values
    text = issued.read_text(encoding="utf-8")
    changed = mutants(text, {cell.name for cell in live.cells()}, sizes.seed)
    changed = random.Random(sizes.seed).sample(changed, sizes.page_mutants)
    # The policy knows the hash of the right script and would run none of these.
    other = open_page(bypass_csp=True)
    for number, mutant in enumerate(changed):
        other.path = tmp_path / f"{number}.html"
        other.path.write_text(mutant, encoding="utf-8")
        other.load()
        other.type("x_p", 2, "29.8")
        assert driving.differences(other.cells(), values) != [], number
    other.errors.clear()
    summary(f"characters changed in the program of the page: {len(changed)}, all noticed")


def test_policy_refuses_a_changed_program(open_page: Open, issued: Path, tmp_path: Path) -> None:
    (mutant,) = mutants(issued.read_text(encoding="utf-8"), {"alpha_mean"}, SEED)
    (tmp_path / "changed.html").write_text(mutant, encoding="utf-8")
    live = open_page(tmp_path / "changed.html")
    assert not live.page.evaluate("() => 'live' in document.documentElement.dataset")
    assert live.page.locator("#live-dock").is_hidden()
    assert len(live.errors) == 1
    live.errors.clear()
