"""The page reads and saves temperatures in degC as a build does, and what is said of them in words."""

from collections.abc import Callable
from pathlib import Path

import driving
import gas
import pytest
from driving import Live

from loopsheet.report import build
from loopsheet.report.study import Study


@pytest.mark.usefixtures("unrefereed")
def test_a_temperature_that_is_edited_is_saved_as_it_was_typed(
    open_page: Callable[..., Live], tmp_path: Path
) -> None:
    rows = zip(gas.TABLE.splitlines(), ("remark", "", '"warm, too"', "cold"), strict=True)
    folder = gas.folder(tmp_path / "gas", table="".join(f"{row},{said}\n" for row, said in rows))
    build.build(Study(folder), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html")
    assert driving.differences(live.cells(), Study(folder).computed.values) == []
    live.type("T", 3, "-13.7")
    live.type("dT", "", "2.25")
    assert live.cell("warm", "3").text in ("-11.45", "−11.45")
    assert live.cell("T", "3").value == "259.45"
    live.type("T", 1, "60.1")
    assert "between -50 and 60 degC (temperature)" in " ".join(live.around())
    live.type("T", 1, "59.9")
    saved = live.save(tmp_path / "saved", "workbook.py", "published.csv")
    lines = (saved / "measurements.csv").read_text(encoding="utf-8").splitlines()
    assert lines == ["reading,T [degC],remark", "1,59.9,", '2,21.5,"warm, too"', "3,-13.7,cold"]
    report = Study(saved).computed
    assert report.values.value["T"].tolist() == [333.05, 294.65, 259.45]
    assert driving.differences(live.cells(), report.values) == []


_WORDS = """() => Array.from(document.querySelectorAll("main table:not(.list) tr[data-label]"), (row) => [
  row.dataset.label, ...Array.from(row.querySelectorAll("td:is(.row, .w)"), (cell) => cell.textContent),
])"""


def test_rows_keep_their_names_and_a_new_one_gets_one(open_page: Callable[..., Live], tmp_path: Path) -> None:
    folder = gas.folder(tmp_path / "gas", table=gas.NAMED, code=gas.IN_TABLES)
    build.build(Study(folder), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html")

    def words() -> list[list[str]]:
        found: list[list[str]] = live.page.evaluate(_WORDS)
        return found

    note, code = "the door was open, 5 % of the time", r"#9 {\a}"
    measured = [["1", "", "=1+1"], ["2", note, "@x <b>y</b>"], ["3", "", code], ["4", "", "17"]]
    computed = [["1", "=1+1"], ["2", "@x <b>y</b>"], ["3", code]]
    assert words() == measured + computed
    live.type("T", 1, "20.5")
    live.page.locator('[data-remove="2"]').click()
    live.page.locator('[data-use="4"]').click()
    measured.pop(1), computed.pop(1)
    assert words() == [*measured, *computed, ["4", "17"]]
    assert live.cell("warm", "4").text == "31.50"
    live.click("live-undo")
    live.click("live-undo")  # the second row is made again
    measured.insert(1, ["2", note, "@x <b>y</b>"])
    computed.insert(1, ["2", "@x <b>y</b>"])
    assert words() == measured + computed
    live.type("T", 2, "22.5")
    assert live.cell("warm", "2").text == "24.00"
    live.page.locator('[data-remove="4"]').click()
    live.click("live-add")  # and is no other's, whose words would stand beside it
    live.page.keyboard.type("25.0")
    live.press("Enter")
    assert words() == [*measured[:3], ["5", "", "reading 5"], *computed, ["5", "reading 5"]]
    saved = live.save(tmp_path / "saved", "workbook.py", "published.csv")
    assert (saved / "measurements.csv").read_text(encoding="utf-8").splitlines() == [
        "reading,note,specimen,T [degC],left out",
        '1,,"=1+1",20.5,',
        f'2,"{note}","@x <b>y</b>",22.5,',
        f'3,,"{code}",-3.2,',
        "4,,17,30,fell",
        "5,,reading 5,25.0,",
    ]
    assert Study(saved).inputs.only.naming == ("specimen",)
    live.click("live-reset")
    assert words() == [*measured[:3], ["4", "", "17"], *computed]


@pytest.mark.usefixtures("unrefereed")
def test_bars_are_no_longer_there_where_points_may_have_moved(
    open_page: Callable[..., Live], tmp_path: Path
) -> None:
    build.build(Study(gas.folder(tmp_path / "gas")), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html")
    figure = live.page.locator("#figure-plot_1 svg")
    assert "bars: standard uncertainty" in (figure.text_content() or "")
    live.type("T", 3, "-13.7")
    live.drawn()
    assert "bars" not in (figure.text_content() or "")
    live.click("live-reset")
    assert "bars: standard uncertainty" in (figure.text_content() or "")


def test_a_number_may_have_its_own_unit_and_u_behind_it_and_else_it_is_said_at_once(live: Live) -> None:
    live.type("x_p", 2, "29.8 µm")
    assert live.input("x_p", 2).input_value() == "29.8"
    live.type("x_p", 2, "29.8(5)um")
    assert live.input("x_p", 2).input_value() == "29.8(5)"
    assert live.text("live-note") == ""
    live.page.locator("#cell-x_p-2").click()
    assert "u = 0.50" in live.text("bar-sure")
    live.type("x_p", 2, "0.0298 mm")
    said = "x_p[2]: “0.0298 mm” is not a number: write it alone, in µm, or as 46.7(5) with its u"
    assert live.text("live-note").startswith(said)
    assert live.focused() == "x_p[3]"
    live.type("e", 2, "0.512 m")
    assert "write it alone, or as 46.7(5)" in live.text("live-note")
    live.type("v", 2, "2.94 ms")
    assert "“2.94 ms” is not a number" in live.text("live-note")
    live.click("live-undo")
    assert live.text("live-note") == ""
