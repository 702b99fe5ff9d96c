"""What the page is for, in the browsers of its readers: in all of them as Python computes it."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import driving
import elsewhere
import mpmath
import pytest
from driving import Live

from loopsheet.report.engines import exact
from loopsheet.report.judge.engines import EPS, Judge
from loopsheet.report.prepared import Prepared
from loopsheet.report.result.agreement import LIMIT
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study

DEEPER = {("x_p", 2): "29.8"}
LIVELIER = {("e", 2): ".900"}


@pytest.fixture(scope="module", params=["Chromium", *elsewhere.BROWSERS])
def anywhere(
    request: pytest.FixtureRequest, require: Callable[..., str], tmp_path_factory: pytest.TempPathFactory
) -> Iterator[elsewhere.Open]:
    """Open a page in one browser after the other."""
    if request.param == "Chromium":
        browser = request.getfixturevalue("browser")

        def open_it(path: Path) -> Live:
            live = Live(browser.new_page(), path)
            live.load()
            return live

        yield open_it
    else:
        folder = tmp_path_factory.mktemp("elsewhere")
        with elsewhere.BROWSERS[request.param](require, folder) as opened:
            yield opened


@pytest.fixture
def live(anywhere: elsewhere.Open, issued: Path) -> Iterator[Live]:
    live = anywhere(issued)
    yield live
    assert live.heard() == []
    live.page.close()


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Report]:
    """What Python makes of other tests; of the same ones once for all browsers."""
    made: dict[str, Report] = {}

    def of(tests: driving.Tests) -> Report:
        name = json.dumps(tests)
        if name not in made:
            made[name] = driving.built(
                tmp_path_factory.mktemp("built") / "folder",
                tests,
                published=set(tests) == set(driving.paper()),
            )
        return made[name]

    return of


Built = Callable[[driving.Tests], Report]


def same(live: Live, report: Report) -> bool:
    """Every cell, and nothing else, with its value and its code."""
    return driving.differences(live.cells(), report.values) == []


def test_page_shows_the_values_of_values_json(live: Live, issued: Path) -> None:
    cells = json.loads(issued.with_name("values.json").read_text(encoding="utf-8"))["cells"]
    seen = live.cells()
    assert len(seen) > 100
    for cell in seen:
        known = cells[cell.name]
        value, status = known["value"], known["status"]
        if known["axis"] is not None:
            labels = [
                "-".join(map(str, label)) if isinstance(label, list) else str(label)
                for label in known["index"]
            ]
            row = labels.index(cell.index)
            value, status = value[row], status[row]
        assert (float(cell.value), cell.status) == (value, status), cell


def test_edit_is_recalculated_within_what_rounding_may_do(
    live: Live, built: Built, summary: Callable[[str], None], request: pytest.FixtureRequest
) -> None:
    live.type("x_p", 2, "29.8")
    report = built(driving.edited(DEEPER))
    assert same(live, report)
    prepared = Prepared(report.inputs, report.sheet)
    judge = Judge.of(report.sheet, report.values.layouts, prepared.labels, prepared.exact_data)
    worst, where = 0.0, ""
    with mpmath.workdps(exact.DIGITS):
        for cell in live.cells():
            labels = ["-".join(map(str, label)) for label in report.values.labels(report.sheet[cell.name])]
            row = labels.index(cell.index)
            difference = abs(mpmath.mpf(float(cell.value)) - judge.judged.value[cell.name][row])
            units = float(difference / (EPS * judge.bounds.allowing(cell.name, row, float(difference))))
            worst, where = max((worst, where), (units, f"{cell.name}[{cell.index}]"))
    summary(
        f"page in {request.node.callspec.params['anywhere']}: at most {worst:.2f} eps x condition ({where})"
    )
    assert worst <= LIMIT


def test_what_is_shown_is_what_python_prints(
    live: Live, anywhere: elsewhere.Open, built: Built, tmp_path: Path
) -> None:
    """Digits, decimal points below each other, marks, and what stands around the tables."""
    live.type("e", 2, ".900")
    report = built(driving.edited(LIVELIER))
    assert same(live, report)
    assert live.cell("alpha", "1-2").text == "#NOROOT!"
    shown, around = driving.shown(live.cells(outside="p")), live.around()
    other = anywhere(driving.static(report, tmp_path / "edited.html"))
    assert driving.alike(shown, driving.shown(other.cells(outside="p")))
    assert driving.alike(around, other.around())
    other.page.close()


def test_input_that_is_no_number_says_so(live: Live, built: Built) -> None:
    report = built(driving.paper())
    for text in ("abc", "-3", "", "1e999"):
        live.type("x_p", 3, text) if text else (live.input("x_p", 3).click(), live.press("Delete"))
        refused = driving.with_missing(report, ("x_p", 3))
        assert driving.differences(live.cells(), refused) == [], text
        cell = live.cell("x_p", "3")
        assert (cell.status, cell.text) == ("#INPUT!", text)
        assert "; it must be " in cell.title
        assert live.cell("alpha", "3-4").title.startswith("#INPUT! alpha[3-4] needs x_p[3]: ")
        live.type("x_p", 3, "41.6")
        assert same(live, report)


def test_tests_come_and_go_and_reset_restores_every_character(live: Live, built: Built) -> None:
    before, tests = live.state(), driving.paper()
    live.click("live-add")
    for text in ("5.5", "0.44", "56.6"):
        live.page.keyboard.type(text)
        live.press("Tab")
    tests[6] = {"v": "5.5", "e": "0.44", "x_p": "56.6"}
    assert same(live, built(tests))
    live.page.locator('[data-use="3"]').click()
    del tests[3]
    assert same(live, built(tests))
    live.page.locator('[data-remove="5"]').click()
    del tests[5]
    assert same(live, built(tests))
    after = live.cells()
    live.click("live-reset")
    assert live.state() == before
    live.press("Control+z")
    assert live.cells() == after
    for _ in range(6):
        live.click("live-undo")
    assert live.state() == before
    assert live.page.locator("#live-undo").is_disabled()
    live.press("Control+y", "Control+Shift+z")
    live.click("live-undo")
    live.click("live-undo")
    assert live.state() == before


def test_block_is_pasted_and_taken_back(live: Live, built: Built) -> None:
    live.input("v", 1).click()
    live.paste("2,334\t0,530\t23,5\r\n2,940\t0,512\t29,8\r\n")
    assert same(live, built(driving.edited(DEEPER)))
    live.press("Control+z")
    assert same(live, built(driving.paper()))
    assert live.text("live-banner") == ""


def test_keys_move_as_in_a_spreadsheet(live: Live) -> None:
    live.input("v", 1).click()
    for key, there in (
        ("ArrowDown", "v[2]"), ("Enter", "v[3]"), ("Shift+Enter", "v[2]"), ("Tab", "e[2]"),
        ("Shift+Tab", "v[2]"), ("ArrowRight", "e[2]"), ("ArrowUp", "e[1]"), ("Control+ArrowDown", "e[5]"),
        ("ArrowLeft", "v[5]"),
    ):  # fmt: skip
        live.press(key)
        assert live.focused() == there, key
    live.input("x_p", 2).click()
    live.press("F2", "Backspace", "8", "ArrowLeft", "Home", "Escape")
    assert live.input("x_p", 2).input_value() == "29.7"
    live.press("F2", "Backspace", "8", "Enter")
    assert (live.focused(), live.cell("x_p", "2").text) == ("x_p[3]", "29.8")


def test_bar_says_where_a_number_comes_from(live: Live) -> None:
    live.page.locator("#cell-x_m2-1-2").click()
    assert live.text("bar-name").endswith("x_m2[1-2]")
    assert live.text("bar-source").startswith("from (")
    live.page.locator('#bar-precedents button[data-goto="x_p[2]"]').click()
    assert live.focused() == "x_p[2]"
    assert "measurements.csv, test 2" in live.text("bar-source")


_BROKEN = """() => Array.from(document.querySelectorAll("main math[display=block]")).filter((math) => {
  const parts = Array.from(math.children, (part) => part.getBoundingClientRect());
  const highest = parts.reduce((one, other) => (one.height >= other.height ? one : other));
  return parts.some(({ top, bottom }) => top >= highest.bottom || bottom <= highest.top);
}).map((math) => math.closest("article, section")?.id)"""


def test_no_browser_breaks_an_equation_and_cuts_what_is_below(live: Live) -> None:
    """It stays on its line, which scrolls where it is too long."""
    assert live.page.evaluate(_BROKEN) == []


_READ_ON = """async () => {
  for (const one of document.querySelectorAll("main section, main h3, main .table, main figure")) {
    one.scrollIntoView();
    await FRAME;
    await FRAME;
  }
}""".replace("FRAME", driving.FRAME)


def test_page_is_read_to_its_end_after_an_edit(live: Live) -> None:
    """What is laid out only when it comes into sight makes nothing complain."""
    live.type("e", 2, ".900")
    live.page.evaluate(_READ_ON)
    assert live.page.evaluate("() => document.visibilityState") == "visible"


def test_saved_files_give_the_numbers_of_the_page(live: Live, tmp_path: Path) -> None:
    live.type("x_p", 2, "29.8")
    live.type("beta", "", "1.4")
    live.page.locator('[data-use="4"]').click()
    folder = driving.compared(live.save(tmp_path / "saved"), published=False)
    report = Study(folder).computed
    assert report.inputs.parameters["beta"].text == "1.4"
    assert same(live, report)


@pytest.fixture(scope="module")
def drawn() -> list[list[str]]:
    """What each browser told of its draws."""
    return []


def test_draws_come_from_the_background_and_are_the_same_everywhere(
    live: Live, drawn: list[list[str]]
) -> None:
    """Engines differ in the last bits of a draw, and in nothing that is shown."""
    live.type("x_p", 2, "29.8")
    texts: list[str] = []
    for _ in range(300):
        texts = live.page.evaluate(
            "() => Array.from(document.querySelectorAll('#live-panel td span'), (one) => one.textContent)"
        )
        if texts and "…" not in texts:
            break
        time.sleep(0.1)
    drawn.append(texts)
    assert len(texts) == 4
    assert all(" … " in text for text in texts)
    assert texts == drawn[0]
