"""Results are selected and copied as from a spreadsheet: by keys, by the pointer, by a button."""

from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import grouped
import pytest
from driving import Live
from playwright.sync_api import Locator

from loopsheet.report.build import build
from loopsheet.report.study import Study

Open = Callable[..., Live]


@pytest.fixture
def page(open_page: Open) -> Live:
    return open_page(permissions=["clipboard-read", "clipboard-write"])


def clipboard(live: Live) -> tuple[str, list[list[str]]]:
    """The text, and the cells of the table in HTML."""
    text, html = live.page.evaluate(
        """async () => {
          const [item] = await navigator.clipboard.read();
          const as = async (type) => (await item.getType(type)).text();
          return [await as("text/plain"), await as("text/html")];
        }"""
    )
    return text, cells_of(html)


class Cells(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.rows: list[list[str]] = []
        self.inside = False

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        if tag == "tr":
            self.rows.append([])
        elif tag == "td":
            self.rows[-1].append("")
            self.inside = True

    def handle_endtag(self, tag: str) -> None:
        self.inside = self.inside and tag != "td"

    def handle_data(self, data: str) -> None:
        if self.inside:
            self.rows[-1][-1] += data


def cells_of(html: str) -> list[list[str]]:
    cells = Cells()
    cells.feed(html)
    return cells.rows


def as_text(rows: list[list[str]]) -> str:
    return "\n".join("\t".join(row) for row in rows)


def picked(live: Live) -> int:
    return live.page.locator("[aria-selected=true]").count()


def drag(live: Live, start: Locator, end: Locator) -> None:
    start.scroll_into_view_if_needed()
    boxes = [one.bounding_box() for one in (start, end)]
    (x, y), (to_x, to_y) = [
        (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2) for box in boxes if box is not None
    ]
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    live.page.mouse.move((x + to_x) / 2, (y + to_y) / 2)
    live.page.mouse.move(to_x, to_y)
    live.page.mouse.up()


def values(live: Live, names: list[str], indices: list[str]) -> list[list[str]]:
    """What stands in cells, as a program would type it."""
    shown = {(cell.name, cell.index): cell.text for cell in live.cells()}
    rows = [[shown[name, index] for name in names] for index in indices]
    powers = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
    return [
        [
            text.translate(powers).replace("\u202f", "").replace("−", "-").replace("\u00a0×\u00a010", "e")
            for text in row
        ]
        for row in rows
    ]


def test_shift_and_arrows_select_results_and_copy_them(page: Live) -> None:
    page.page.locator("#cell-x_m1-1-2").click()
    page.press("Shift+ArrowRight", "Shift+ArrowDown", "Shift+ArrowDown")
    assert picked(page) == 6
    assert page.focused() == "x_m1[1-2]"
    page.press("Control+c")
    text, html = clipboard(page)
    wanted = values(page, ["x_m1", "x_m2"], ["1-2", "1-3", "1-4"])
    assert text == as_text(wanted)
    assert html == wanted
    for row in wanted:
        assert all(float(cell) > 1 for cell in row)
    # Back again, and beyond the first cell to the other side.
    page.press("Shift+ArrowUp", "Shift+ArrowUp", "Shift+ArrowLeft", "Shift+ArrowLeft", "Control+c")
    assert clipboard(page)[0].split("\t")[-1] == wanted[0][0]
    # An arrow alone selects one cell, and that is copied.
    page.press("ArrowDown")
    assert picked(page) == 0
    page.press("Control+c")
    assert clipboard(page)[0] == values(page, ["x_m1"], ["1-3"])[0][0]
    page.press("Control+Shift+ArrowDown", "Control+c")
    assert len(clipboard(page)[0].splitlines()) == 9


def test_delete_empties_all_that_is_selected(page: Live) -> None:
    typed = [page.input(name, row).input_value() for row in (2, 3) for name in ("v", "e", "x_p")]
    page.input("v", 2).click()
    page.press("Shift+ArrowRight", "Shift+ArrowDown", "Delete")
    assert [page.input(name, row).input_value() for row in (2, 3) for name in ("v", "e")] == [""] * 4
    assert page.input("x_p", 2).input_value() == typed[2]
    page.press("Control+z")  # in one step
    assert [page.input(name, row).input_value() for row in (2, 3) for name in ("v", "e", "x_p")] == typed


def test_a_column_with_its_unit_behind_each_number_is_pasted(page: Live) -> None:
    page.input("x_p", 2).click()
    page.paste("29.8 um\n41,7 µm\n46.0\n")
    assert [page.input("x_p", row).input_value() for row in (2, 3, 4)] == ["29.8", "41.7", "46.0"]
    page.press("Control+z")
    page.input("x_p", 2).click()
    page.paste("0.0298 mm\n41.7 um\n")
    assert page.cell("x_p", "2").status == "#INPUT!"


@pytest.mark.parametrize(
    ("block", "becomes"),
    [
        ("\t\t23.00\n", ["", "", "23.00"]),
        ("\t0.51\t\n", ["", "0.51", ""]),
        ("2.300\t\t\n", ["2.300", "", ""]),
    ],
)
def test_one_row_is_pasted_into_its_columns(page: Live, block: str, becomes: list[str]) -> None:
    """As many rows are; what is empty in a block is empty then."""
    page.input("v", 2).click()
    page.paste(block)
    assert [page.input(name, 2).input_value() for name in ("v", "e", "x_p")] == becomes


def test_rows_without_a_number_have_no_place(page: Live) -> None:
    page.input("v", 1).click()
    page.paste("test\tv\n1\t2.3\n2\t2.9\n\t\n3\t3.5\n\t\n4\t4.1\n")
    assert page.text("live-note") == "Pasted, but 2 rows had no place."


def test_powers_and_signs_are_copied_as_programs_read_them(page: Live) -> None:
    page.page.locator("#cell-C-1-2").click()
    page.press("Shift+ArrowDown", "Control+c")
    for line in clipboard(page)[0].splitlines():
        assert float(line) > 1e6
    cell = page.page.locator("[data-published]").first
    cell.click()
    page.press("Shift+ArrowRight", "Shift+ArrowRight", "Shift+ArrowDown", "Control+c")
    again, unit, off = clipboard(page)[0].splitlines()[0].split("\t")
    assert (float(again), unit) == (1.258, "–")
    assert float(off) == pytest.approx(24, abs=1)


def test_what_begins_as_a_formula_is_copied_as_a_text(open_page: Open, tmp_path: Path) -> None:
    said = ['=HYPERLINK("x")', "+1+cmd|x", "@now", "-x", "-1.5", "plain", "x" * 3000]
    rows = tuple(("A", f"{n}.5", f'"{word.replace(chr(34), chr(34) * 2)}"') for n, word in enumerate(said, 1))
    folder = grouped.write(tmp_path / "few", rows, "instrument,y [mm],remark")
    build(Study(folder), folder / "out", ("html",))
    live = open_page(folder / "out" / "report.html", permissions=["clipboard-read", "clipboard-write"])
    live.page.locator(".table:has(input[data-cell=y]) > button[data-copy]").click()
    found = [line.split("\t")[2] for line in clipboard(live)[0].splitlines()[1:]]
    assert found == [*(f"'{word}" for word in said[:4]), *said[4:]]
    wide = live.page.locator("td.w", has_text="xxx").first.bounding_box()
    assert wide is not None
    assert wide["width"] < 600


def test_dragging_selects_a_rectangle(page: Live) -> None:
    one = page.page.locator("#cell-x_m1-1-3")
    drag(page, one, page.page.locator("#cell-x_m2-1-5"))
    page.press("Control+c")
    assert clipboard(page)[0] == as_text(values(page, ["x_m1", "x_m2"], ["1-3", "1-4", "1-5"]))
    assert page.page.evaluate("() => getSelection().isCollapsed")
    page.press("Escape")
    assert picked(page) == 0
    # Inputs as well, and Shift with a press.
    drag(page, page.input("v", 2), page.input("x_p", 3))
    page.press("Control+c")
    assert clipboard(page)[0] == "2.940\t0.512\t29.7\n4.089\t0.479\t41.6"
    page.input("e", 1).click()
    page.input("x_p", 2).click(modifiers=["Shift"])
    page.press("Control+c")
    assert clipboard(page)[0] == "0.530\t23.5\n0.512\t29.7"
    assert page.text("live-banner") == ""
    # What was copied can be pasted; an edit ends the selection.
    page.input("e", 4).click()
    page.press("Control+v")
    assert picked(page) == 0
    assert page.input("x_p", 5).input_value() == "29.7"


def test_while_a_text_is_typed_its_own_keys_hold(page: Live) -> None:
    page.input("x_p", 2).click()
    page.press("F2", "Shift+ArrowLeft", "Control+c")
    assert page.page.evaluate("() => navigator.clipboard.readText()") == "7"
    assert picked(page) == 0
    page.press("Escape")
    assert page.input("x_p", 2).input_value() == "29.7"


def test_words_of_a_table_can_be_marked_and_copied(page: Live) -> None:
    reason = page.page.locator("#published .compared td:last-child").first
    reason.scroll_into_view_if_needed()
    reason.dblclick()
    page.press("Control+c")
    assert page.page.evaluate("() => navigator.clipboard.readText()").strip() in reason.inner_text()


def test_every_table_has_a_button_that_copies_all_of_it(page: Live) -> None:
    tables = page.page.locator("main .table")
    assert tables.count() > 10
    for table in tables.all():
        button = table.locator("> button[data-copy]")
        assert button.inner_text() == "Copy"
        button.click()
        text, html = clipboard(page)
        rows = text.split("\n")
        assert len(rows) == table.locator("tr").count()
        assert [row.split("\t") for row in rows] == html
        assert "×" not in rows[1].split("\t")
    page.page.locator("#table-measured > button").click()
    assert clipboard(page)[0].splitlines()[:2] == ["test\tv [m/s]\te [1]\tx_p [µm]", "1\t2.334\t0.530\t23.5"]
    assert "Copied 6 rows" in page.text("live-said")


def test_a_table_is_copied_with_what_is_left_out_of_it(page: Live) -> None:
    page.page.locator('[data-use="3"]').click()
    page.page.locator('[data-use="4"]').click()
    page.page.locator('[data-reason="3"]').fill("bounced twice")
    page.press("Enter")
    page.page.locator("#table-measured > button").click()
    rows = [row.split("\t") for row in clipboard(page)[0].splitlines()]
    assert [row[4] for row in rows] == ["left out", "", "", "bounced twice", "no reason was given", ""]
