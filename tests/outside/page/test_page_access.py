"""The live page without a mouse, with a screen reader, on a telephone, in the dark; and as a document."""

import json
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import driving
import pytest
from driving import Live
from test_foreign_words import folder_of

from loopsheet.report import build, stages
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.study import Study

Open = Callable[..., Live]

# --- the keyboard -------------------------------------------------------------------------------------------


def test_keys_move_as_in_a_spreadsheet(live: Live) -> None:
    live.input("v", 1).click()
    for key, there in (
        ("ArrowDown", "v[2]"), ("Enter", "v[3]"), ("Shift+Enter", "v[2]"), ("Tab", "e[2]"), ("Tab", "x_p[2]"),
        ("Tab", "v[3]"), ("Shift+Tab", "x_p[2]"), ("ArrowUp", "x_p[1]"), ("ArrowLeft", "e[1]"),
        ("ArrowRight", "x_p[1]"), ("Control+ArrowDown", "x_p[5]"), ("Control+ArrowUp", "x_p[1]"),
    ):  # fmt: skip
        live.press(key)
        assert live.focused() == there, key
    live.press("Home", "ArrowRight", "Control+End")
    assert live.page.evaluate("() => document.activeElement.closest('tr').dataset.label") == "5"
    # Tables that cannot be edited are walked through as well, and Tab leaves them.
    live.page.locator("#cell-x_m1-1-2").click()
    live.press("ArrowRight", "ArrowDown")
    assert live.focused() == "x_m2[1-3]"
    live.press("End")
    assert live.focused() == "Cprime_2[1-3]"
    live.press("Home")
    assert live.focused() == "x_m1[1-3]"
    live.press("Tab")
    assert not live.focused().endswith("[1-3]")
    assert live.errors == []


def test_typing_replaces_and_escape_takes_it_back(live: Live) -> None:
    live.input("x_p", 2).click()
    before = live.state()
    live.page.keyboard.type("123")
    assert live.input("x_p", 2).input_value() == "123"
    live.press("Escape")
    assert live.input("x_p", 2).input_value() == "29.7"
    assert live.state() == before
    # F2 keeps the text, and then the arrows move in it.
    live.press("F2", "Backspace")
    live.page.keyboard.type("8")
    live.press("ArrowLeft", "Home")
    assert live.focused() == "x_p[2]"
    assert live.input("x_p", 2).input_value() == "29.8"
    live.press("Escape")
    assert live.state() == before
    live.press("F2", "Backspace", "8", "Enter")
    assert live.focused() == "x_p[3]"
    assert live.cell("x_p", "2").text == "29.8"
    assert live.cell("x_p", "2").changed
    # Leaving a cell by any way enters what was typed.
    live.input("e", 1).click()
    live.page.keyboard.type("0.5")
    live.page.locator("h1").click()
    assert live.cell("e", "1").text == "0.5"
    live.page.locator('main input[data-cell="e"][data-index="1"]').dblclick()
    live.press("End", "5", "Enter")
    assert live.cell("e", "1").text == "0.55"


def test_an_edit_without_a_mouse(live: Live) -> None:
    """From the top of the page with Tab alone."""
    for _ in range(60):
        live.press("Tab")
        if live.focused() == "v[1]":
            break
    assert live.focused() == "v[1]"
    live.press("ArrowDown", "ArrowRight", "ArrowRight")
    live.page.keyboard.type("29.8")
    live.press("Enter")
    assert live.cell("alpha", "1-2").value.startswith("1.2277")


def outline(live: Live) -> tuple[str, float]:
    style, width = live.page.evaluate(
        "() => { const style = getComputedStyle(document.activeElement);"
        " return [style.outlineStyle, style.outlineWidth]; }"
    )
    return style, float(width.removesuffix("px"))


def test_focus_is_seen(live: Live) -> None:
    live.press("Tab")
    for _ in range(40):
        style, width = outline(live)
        assert style != "none", live.focused()
        assert width >= 1, live.focused()
        live.press("Tab")
    live.page.locator("#cell-alpha-1-2").click()
    assert outline(live)[1] >= 2
    live.input("x_p", 2).click()
    assert outline(live)[1] >= 2


def test_focus_does_not_hide_behind_the_bar(open_page: Open) -> None:
    live = open_page(viewport={"width": 390, "height": 844})
    live.page.locator("#cell-alpha-1-2").click()
    for _ in range(9):
        live.press("ArrowDown")
        cell, dock = (
            live.page.evaluate(f"() => {what}.getBoundingClientRect().toJSON()")
            for what in ("document.activeElement", "document.getElementById('live-dock')")
        )
        assert cell["bottom"] <= dock["top"], live.focused()


def test_tables_say_what_they_are(live: Live) -> None:
    grids = live.page.locator("main table[role=grid]")
    assert grids.count() >= 6
    for number in range(grids.count()):
        grid = grids.nth(number)
        # One stop for Tab in each, apart from links.
        assert grid.locator("tbody [tabindex='0']").count() == 1
    assert live.page.locator("table[role=grid]:not([aria-readonly]) input[data-cell]").count() > 0
    assert live.page.locator("table[role=grid][aria-readonly] input[data-cell]").count() == 0
    live.type("x_p", 2, "29.8")
    assert "exponent of the global fit (alpha_eiv) changed from 1.3013 to 1.3066" in live.text("live-said")
    labels = live.page.eval_on_selector_all("main input", "all => all.map((one) => one.ariaLabel)")
    assert all(labels)
    assert len(set(labels)) == len(labels)


# --- the formula bar ----------------------------------------------------------------------------------------


def test_formula_bar_says_where_a_number_comes_from(live: Live) -> None:
    assert live.page.locator("#bar-hint").is_visible()
    live.page.locator("#cell-x_m2-1-2").click()
    assert live.page.locator("#formula-bar").get_attribute("data-cell") == "x_m2"
    assert live.text("bar-name").endswith("x_m2[1-2]")
    assert live.text("bar-value").endswith("µm")
    assert "approach of the pair's second test" in live.text("bar-meaning").replace("’", "'")
    assert live.text("bar-source").startswith("from (")
    assert live.page.locator("#bar-source small").inner_text() in ("proved", "proved numerically", "stated")
    assert live.page.locator("#bar-source math").count() == 1
    put = live.text("bar-put")
    for value in ("0.512", "2.97", "1.5", "1.258"):
        assert value in put.replace("\u202f", ""), put
    names = live.page.locator("#bar-precedents button").evaluate_all(
        "all => all.map((one) => one.dataset.goto)"
    )
    assert names == ["e[2]", "x_p[2]", "beta", "alpha[1-2]"]
    marked = live.page.eval_on_selector_all(
        "main .precedent", "all => [...new Set(all.map(({ dataset: d }) => `${d.cell} ${d.index}`))].sort()"
    )
    assert marked == ["alpha 1-2", "beta ", "e 2", "x_p 2"]
    assert live.page.locator("main .selected").count() == 1
    live.page.locator('#bar-precedents button[data-goto="x_p[2]"]').click()
    assert live.focused() == "x_p[2]"
    assert live.page.locator("#formula-bar").get_attribute("data-cell") == "x_p"
    assert "29.7" in live.text("bar-value")
    assert "measurements.csv, test 2" in live.text("bar-source")
    assert live.page.locator('#bar-dependents button[data-goto="x_m2[1-2]"]').count() == 1


def test_formula_bar_follows_the_focus_and_folds(live: Live) -> None:
    live.input("x_p", 2).click()
    live.press("ArrowDown")
    assert live.text("bar-name").endswith("x_p[3]")
    live.page.locator(".headline [data-cell]").first.focus()
    live.press("Enter")
    assert live.page.locator("#formula-bar").get_attribute("data-cell") == "alpha_eiv"
    toggle = live.page.locator("#bar-toggle")
    assert toggle.get_attribute("aria-expanded") == "true"
    toggle.click()
    assert toggle.get_attribute("aria-expanded") == "false"
    assert live.page.locator("#bar-body").is_hidden()
    # What it shows follows an edit.
    before = live.text("bar-value")
    live.type("x_p", 2, "29.8", "Escape")
    live.page.locator("#cell-alpha_eiv").click()
    assert live.text("bar-value") == before
    live.type("x_p", 2, "29.8")
    live.page.locator("#cell-alpha_eiv").click()
    assert live.text("bar-value") != before


@pytest.mark.parametrize("selector", ["main td[data-cell]", "main input[data-cell]"])
def test_formula_bar_has_something_for_every_cell(live: Live, selector: str) -> None:
    broken = live.page.evaluate(
        """(selector) => {
          const wrong = [];
          for (const cell of document.querySelectorAll(selector)) {
            cell.focus();
            if (cell.tabIndex < 0 && document.activeElement !== cell) cell.tabIndex = -1, cell.focus();
            const { textContent: text, dataset: of } = document.getElementById("formula-bar");
            const { cell: name, index } = cell.dataset;
            if (of.cell !== name || of.index !== index) wrong.push(name);
            if (/@|NaN|undefined|\\[object/.test(text)) wrong.push(text);
          }
          return wrong;
        }""",
        selector,
    )
    assert broken == []


_OUTSIDE = """() => {
  const body = document.getElementById("live-dock").getBoundingClientRect(), found = [];
  const texts = document.createTreeWalker(document.getElementById("formula-bar"), NodeFilter.SHOW_TEXT);
  for (const range = document.createRange(); texts.nextNode(); ) {
    range.selectNodeContents(texts.currentNode);
    const isOutside = ({ left, right }) => left < body.left || right > body.right;
    if (Array.from(range.getClientRects()).some(isOutside)) found.push(texts.currentNode.data);
  }
  return found;
}"""


@pytest.mark.parametrize("cell", ["alpha_mean", "C_log", "alpha-1-3", "x_m2-1-3", "C-1-2"])
def test_formula_bar_can_be_read_on_a_telephone(open_page: Open, cell: str) -> None:
    """Nothing of it is out of sight to the right, formulas and their numbers included."""
    live = open_page(viewport={"width": 390, "height": 844})
    if live.page.locator("#bar-toggle").get_attribute("aria-expanded") == "false":
        live.click("bar-toggle")
    live.type("e", 2, ".900")
    live.page.locator(f"#cell-{cell}").click(position={"x": 3, "y": 3})
    assert live.page.evaluate(_OUTSIDE) == []
    if cell == "alpha_mean":
        assert "over 9 pairs" in live.text("bar-source").replace("\u00a0", " ")


def test_edit_leaves_everything_in_its_place(live: Live) -> None:
    """Tables and figures outside of the window are not laid out again; they keep the room that they had."""
    heights = """() => Array.from(document.querySelectorAll("main :is(.table, figure)"), (one) =>
      [one.id, Math.round(one.getBoundingClientRect().height)])"""
    before = live.page.evaluate(heights)
    live.type("x_p", 2, "29.8")
    after = dict(live.page.evaluate(heights))
    moved = [name for name, height in before if abs(after[name] - height) > 3]
    assert moved == []


# --- judged by others ---------------------------------------------------------------------------------------


# Where a background is a picture axe says nothing, and every table has one: the shadows at its sides. Where a
# layout is put off, it looks at where things would have been.
_SEEN = "* { background-image: none !important; content-visibility: visible !important; }"

_JUDGED = """async () => {
  const id = "color-contrast", { options } = axe._audit.checks[id];
  // By itself it leaves out what has one letter, and signs.
  axe.configure({ checks: [{ id, options: { ...options, ignoreLength: true, ignoreUnicode: false } }] });
  const { violations } = await axe.run(document, { resultTypes: ["violations"] });
  const named = ({ target, failureSummary }) => `${target}: ${failureSummary}`;
  return violations.map(({ id, nodes }) => [id, nodes.length, nodes.slice(0, 3).map(named)]);
}"""


def violations(live: Live, packages: Path) -> list[Any]:
    if not live.page.evaluate("() => 'axe' in window"):
        live.page.add_script_tag(path=packages / "axe-core" / "axe.min.js")
        live.page.add_style_tag(content=_SEEN)
    found: list[Any] = live.page.evaluate(_JUDGED)
    return found


@pytest.fixture(scope="module")
def pages(issued: Path, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The page of the paper, of the worked example, or of a workbook of somebody else's."""
    made = {"paper": issued}

    def page(name: str) -> Path:
        if name not in made:
            out = tmp_path_factory.mktemp(name)
            folder = PAPER.parent / name if name == "worked_example" else folder_of(out, name)
            with pytest.MonkeyPatch.context() as patch:  # the paper's has a referee, who takes long
                patch.setattr(stages, "refereed", lambda report, *_: report)
                build.build(Study(folder), out / "out", ("html",))
            made[name] = out / "out" / "report.html"
        return made[name]

    return page


def as_issued(live: Live) -> None:
    """Nothing is done to it."""


def edited(live: Live) -> None:
    """Numbers, no numbers and none at all; a test left out, another new; one looked at; and saved."""
    inputs = live.page.locator("main input[data-cell]:not([readonly])")
    for number, text in enumerate((".9", "x")):
        inputs.nth(number).click()
        live.page.keyboard.type(text)
        live.press("Enter")
    live.click("live-add")
    live.click("live-add")
    live.page.locator("[data-use]").first.click()
    live.page.locator("[data-remove]").last.click()
    live.page.locator("main td[data-cell][data-status]:not(:has(input))").first.click(
        position={"x": 3, "y": 3}
    )
    if live.page.locator("#bar-toggle").get_attribute("aria-expanded") == "false":
        live.click("bar-toggle")
    live.click("live-save")


def typing(live: Live) -> None:
    """In the middle of a number, with the bar folded."""
    live.page.locator("main input[data-cell]:not([readonly])").first.click()
    if live.page.locator("#bar-toggle").get_attribute("aria-expanded") == "true":
        live.click("bar-toggle")
    live.page.locator("main input[data-cell]:not([readonly])").nth(1).click()
    live.page.keyboard.type("3")


def printed(live: Live) -> None:
    edited(live)
    live.page.emulate_media(media="print")


DESK: Mapping[str, Any] = {"viewport": {"width": 1280, "height": 900}, "color_scheme": "light"}
NIGHT = {**DESK, "color_scheme": "dark"}
PHONE = {**DESK, "viewport": {"width": 390, "height": 844}}
PHONE_AT_NIGHT = {**PHONE, "color_scheme": "dark"}
CONTRAST = {**DESK, "forced_colors": "active"}
STATES = [
    ("paper", DESK, as_issued), ("paper", DESK, edited), ("paper", DESK, typing), ("paper", DESK, printed),
    ("paper", NIGHT, edited), ("paper", PHONE, edited), ("paper", PHONE_AT_NIGHT, as_issued),
    ("paper", PHONE_AT_NIGHT, typing), ("paper", CONTRAST, edited), ("worked_example", NIGHT, as_issued),
    ("gauge", DESK, as_issued), ("gauge", PHONE_AT_NIGHT, edited), ("orbit", PHONE_AT_NIGHT, as_issued),
    ("orbit", DESK, edited),
]  # fmt: skip


@pytest.mark.parametrize(("page", "look", "do"), STATES)
def test_axe_finds_nothing(
    open_page: Open,
    packages: Path,
    pages: Callable[[str], Path],
    page: str,
    look: Any,
    do: Callable[[Live], None],
) -> None:
    # The policy would not let the judge in.
    live = open_page(pages(page), **look, bypass_csp=True)
    do(live)
    assert violations(live, packages) == []


@pytest.mark.parametrize(
    ("wrong", "rule"),
    [
        ("cell => cell.removeAttribute('aria-label')", "label"),
        ("cell => { cell.style.color = '#999'; }", "color-contrast"),
    ],
)
def test_axe_finds_what_is_wrong(open_page: Open, packages: Path, wrong: str, rule: str) -> None:
    live = open_page(bypass_csp=True)
    live.page.eval_on_selector("#cell-x_p-2", wrong)
    assert [name for name, _, _ in violations(live, packages)] == [rule]


def test_validator_finds_nothing(
    live: Live, issued: Path, packages: Path, require: Callable[..., str]
) -> None:
    text = issued.read_text(encoding="utf-8")
    live.type("e", 2, ".9")
    live.type("x_p", 3, "x")
    live.click("live-add")
    live.page.locator("#cell-C-1-2").click(position={"x": 3, "y": 3})
    pages = {
        "as issued": text,
        "edited": "<!DOCTYPE html>\n" + live.page.evaluate("() => document.documentElement.outerHTML"),
        "wrong": text.replace("<main", "<main><p><div></div></p>", 1),
    }
    run = subprocess.run(
        [require("node"), str(Path(driving.__file__).parent / "validate.cjs")],
        input=json.dumps({"module": str(packages / "html-validate"), "pages": pages}),
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    assert found["wrong"], "the validator finds nothing at all"
    assert found["as issued"] == []
    assert found["edited"] == []


@pytest.mark.parametrize("width", [320, 390, 768, 1280])
def test_page_does_not_scroll_sideways(open_page: Open, width: int) -> None:
    live = open_page(viewport={"width": width, "height": 800})
    live.type("e", 2, ".9")
    live.page.locator("#cell-C-1-3").click()
    found = live.page.evaluate("() => [document.documentElement.scrollWidth, innerWidth]")
    assert found[0] <= found[1]
