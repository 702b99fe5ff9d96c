"""What is on the screen: the result while one edits, the bar, wide equations, chapters that are as issued."""

from collections.abc import Callable
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest
from driving import FRAME, Live
from helpers import method_folder

from loopsheet.report import build
from loopsheet.report.study import Study

Open = Callable[..., Live]

WIDTHS = [360, 400, 500, 600, 700, 840, 1000, 1200, 1600]

_ON_SCREEN = """(selector) => {
  const panel = document.getElementById("live-panel");
  panel.style.pointerEvents = "auto"; // what it lets through it covers all the same
  const seen = (element) => {
    const box = element.getBoundingClientRect();
    const dock = document.getElementById("live-dock").getBoundingClientRect();
    if (box.width === 0 || box.left < 0 || box.right > innerWidth + 1) return false;
    if (box.top < 0 || box.bottom > dock.top + 1) return false;
    const there = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
    return element.contains(there) || (there?.contains(element) ?? false);
  };
  const all = Array.from(document.querySelectorAll(selector));
  const found = all.filter((one) => one.checkVisibility()).map(seen);
  panel.style.pointerEvents = "";
  return found;
}"""


def seen(live: Live, selector: str) -> list[bool]:
    found: list[bool] = live.page.evaluate(_ON_SCREEN, selector)
    return found


@pytest.mark.parametrize("width", WIDTHS)
def test_the_result_is_on_the_screen_while_the_tests_are_edited(open_page: Open, width: int) -> None:
    live = open_page(viewport={"width": width, "height": 850})
    live.type("x_p", 2, "29.8")
    live.drawn()
    panel = live.page.locator("#live-panel")
    shown = [text for text in panel.locator("tbody tr").all_inner_texts() if text]
    assert [word for word in shown[0].split() if word[0] in "1("][:3] == ["1.3013", "1.3066", "(31)"]
    assert all(seen(live, "#live-panel tbody tr:nth-child(-n+3), #live-panel svg"))
    assert panel.locator("tbody tr").count() == live.page.locator(".headline > div").count() > 3
    # The others are scrolled to, and stay there while it follows.
    results = panel.locator(".results")
    results.evaluate("box => box.scrollTop = box.scrollHeight")
    assert seen(live, "#live-panel tbody tr:last-child") == [True]
    live.type("x_p", 2, "29.9")
    assert results.evaluate("box => box.scrollTop") > 0
    live.drawn()
    results.evaluate("box => box.scrollTop = 0")
    assert seen(live, "#live-panel svg") == [True]
    assert all(seen(live, "#cell-x_p-2, #cell-x_p-3"))
    # It follows, and with the last edit taken back it is as it was.
    live.type("x_p", 2, "30.5")
    assert "1.3066" not in panel.locator("tbody tr").first.inner_text()
    live.click("live-reset")
    cells = panel.locator("tbody tr").first.locator("td").all_inner_texts()
    assert cells == ["", "1.3013 (31)"]


@pytest.mark.parametrize("width", [390, 1280])
def test_a_long_number_makes_its_card_wider(open_page: Open, width: int) -> None:
    live = open_page(viewport={"width": width, "height": 850})
    number = live.page.locator(".headline .value").nth(1)
    number.evaluate("one => (one.textContent = '−2.56288012\u00a0×\u00a010⁻⁴')")
    cards = live.page.locator(".headline > div")
    assert cards.evaluate_all("all => all.map((one) => one.scrollWidth - one.clientWidth)") == [0] * 9


@pytest.mark.parametrize("height", [664, 844])
def test_most_of_a_phone_is_left_to_the_table(open_page: Open, height: int) -> None:
    live = open_page(viewport={"width": 390, "height": height})
    live.type("x_p", 2, "29.8")
    size = "id => document.getElementById(id).getBoundingClientRect().height"
    taken = [live.page.evaluate(size, part) for part in ("live-panel", "live-dock")]
    assert min(taken) > 0
    assert sum(taken) <= 0.4 * height
    assert seen(live, "#cell-x_p-3") == [True]


def test_what_lies_below_the_panel_can_be_pressed(open_page: Open) -> None:
    live = open_page(viewport={"width": 390, "height": 664})
    live.input("v", 2).click()
    cell = live.page.locator("#cell-x_p-3")
    cell.evaluate("cell => scrollTo(0, scrollY + cell.getBoundingClientRect().top - 20)")
    boxes = [live.page.locator(f"#{one}").bounding_box() for one in ("live-panel", "cell-x_p-3")]
    panel, below = [box for box in boxes if box]
    assert below["y"] + below["height"] < panel["y"] + panel["height"]
    live.page.mouse.click(below["x"] + below["width"] / 2, below["y"] + below["height"] / 2)
    assert live.focused() == "x_p[3]"


def test_nothing_shows_through_the_head_of_a_long_table(open_page: Open) -> None:
    live = open_page(permissions=["clipboard-read", "clipboard-write"])
    live.input("v", 5).click()
    live.paste("\n".join(f"{5 + n / 10}\t0.453\t{51 + n}" for n in range(40)))
    for down in range(40, 200, 20):
        live.page.evaluate("down => document.querySelector('.tall').scrollTo(0, down)", down)
        over: list[bool] = live.page.evaluate(
            """() => Array.from(document.querySelector(".tall thead tr").cells, (cell) => {
              const { left, right, top, bottom } = cell.getBoundingClientRect();
              return cell.contains(document.elementFromPoint((left + right) / 2, (top + bottom) / 2));
            })"""
        )
        assert all(over), down


def test_a_cell_without_a_value_shows_its_code_there(live: Live) -> None:
    live.type("beta", "", "x")
    assert "#INPUT!" in live.page.locator("#live-panel").inner_text()


_COVERED = """() => {
  const parts = "#live-banner, #live-dock button, #formula-bar .head > *, #bar-hint, #live-note";
  const boxes = Array.from(document.querySelectorAll(parts))
    .filter((one) => one.checkVisibility() && one.textContent).flatMap((one) => {
      const text = document.createRange();
      text.selectNodeContents(one);
      const boxes = one.tagName === "BUTTON" ? [one.getBoundingClientRect()] : text.getClientRects();
      return Array.from(boxes).map((box) => [one.id || one.textContent, box]);
    });
  const found = [];
  for (const [name, a] of boxes) {
    for (const [other, b] of boxes) {
      const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (name < other && wide > 1 && high > 1) found.push([name, other]);
    }
    if (a.left < 0 || a.right > innerWidth) found.push([name, "outside"]);
  }
  return found;
}"""


@pytest.mark.parametrize("width", WIDTHS)
def test_the_bar_does_not_cover_itself(open_page: Open, width: int) -> None:
    live = open_page(viewport={"width": width, "height": 850})
    assert live.page.evaluate(_COVERED) == []
    live.type("x_p", 2, "29.8")
    live.page.locator("#cell-C_log").click(position={"x": 3, "y": 3})
    live.click("live-link")
    assert live.page.evaluate(_COVERED) == []


@pytest.mark.parametrize("width", [400, 700, 1200])
def test_wide_equations_fit_or_show_that_they_scroll(open_page: Open, width: int) -> None:
    live = open_page(viewport={"width": width, "height": 850})
    for name in ("L6", "L8"):
        found: dict[str, Any] = live.page.locator(f"#eq-{name} > div").evaluate(
            """(box) => ({ wide: box.scrollWidth > box.clientWidth, tab: box.tabIndex,
              shadow: getComputedStyle(box).backgroundImage.includes("gradient"),
              reach: box.firstElementChild.getBoundingClientRect().x - box.getBoundingClientRect().x })"""
        )
        assert found["reach"] >= -1, name  # nothing is out of reach to the left
        assert not found["wide"] or (found["shadow"] and found["tab"] == 0), name


def test_chapters_that_are_as_issued_say_so(live: Live) -> None:
    chapters = live.page.locator("section[data-issued]")
    issued = ["uncertainty", "referee", "errata", "engines"]
    assert chapters.evaluate_all("all => all.map((one) => one.id)") == issued
    words = live.page.locator("[data-issued] > .stale")
    assert [word.is_visible() for word in words.all()] == [False] * 3
    live.type("x_p", 2, "29.8")
    for chapter in chapters.all()[1:]:  # how sure the results are follows every edit
        assert "as issued, before the edits" in chapter.locator("> .stale").inner_text()
    assert "As issued, before the edits" in live.page.locator("#result .note").last.inner_text()
    live.click("live-undo")
    assert [word.is_visible() for word in words.all()] == [False] * 3


def test_without_workers_an_edited_page_says_that_its_expanded_uncertainties_are_of_first_order(
    live: Live,
) -> None:
    words = live.page.get_by_text(
        "This browser tells U by first order alone: a build says where the second counts."
    )
    live.type("x_p", 2, "29.8")
    live.wait_for_draws()
    assert [word.is_visible() for word in words.all()] == [False] * 2
    live.click("live-undo")
    live.page.evaluate("window.Worker = undefined")
    live.type("x_p", 2, "29.9")
    words.first.wait_for()
    assert [word.is_visible() for word in words.all()] == [True] * 2
    below = live.page.locator(".headline + .stale, #uncertain > .stale").all()
    assert [word.text_content() for word in below] == words.all_text_contents()


_BLANK_OR_NEW = """async (selector) => {
  const input = document.getElementById("cell-x_p-2"), picture = document.querySelector(selector), seen = [];
  const drawn = (svg) => Array.from(svg.querySelectorAll("path"), (path) => path.getAttribute("d")).join();
  const blank = (svg) => getComputedStyle(svg).visibility === "hidden";
  const shown = () => Array.from(picture.querySelectorAll("svg"), (svg) => (blank(svg) ? "" : drawn(svg)));
  input.focus();
  input.dispatchEvent(new InputEvent("beforeinput", { bubbles: true }));
  input.value = "29.8";
  input.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true }));
  PRINTED
  picture.scrollIntoView();
  for (let n = 0; n < 30; n++) {
    seen.push(...shown());
    await FRAME;
  }
  return seen;
}""".replace("FRAME", FRAME)


@pytest.mark.parametrize("printed", [False, True])
def test_a_picture_that_is_scrolled_to_after_an_edit_is_the_new_one_or_none(
    open_page: Open, printed: bool
) -> None:
    """What was put off is never seen as it was; print asks for all at once."""
    live = open_page()
    live.type("x_p", 2, "31")
    before = ",".join(live.paths("alpha_pairs"))
    print_it = "dispatchEvent(new Event('beforeprint'));" if printed else ""
    frames = live.page.evaluate(_BLANK_OR_NEW.replace("PRINTED", print_it), "#figure-alpha_pairs")
    # What it shall be: where it was on the screen all the time, and in a page that began with the edit.
    other = open_page()
    other.page.locator("#figure-alpha_pairs").scroll_into_view_if_needed()
    other.page.evaluate(_BLANK_OR_NEW.replace("PRINTED", ""), "#figure-alpha_pairs")
    wanted = ",".join(other.paths("alpha_pairs"))
    assert wanted != before
    assert set(frames) - {""} == {wanted}
    assert (frames[0] == wanted) is printed


def test_marks_of_a_logarithmic_axis_stand_apart(open_page: Open, tmp_path: Path) -> None:
    """Of nine powers of ten in the small picture beside a table, no label stands on another."""
    code = "from loopsheet import Method, let, mean, measured, plot\n\n\n"
    code += 'class Decades(Method, source="own", rows="readings"):\n    "Points over decades."\n'
    code += (
        '    c = measured("mol/L", "concentration", positive=True)\n    c_m = let(mean(c), "mean", like=c)\n'
    )
    code += '    plot(c, c, log="xy")\n'
    rows = "".join(f"{n},1.00e-{9 - n}\n" for n in range(1, 10))
    method_folder(tmp_path, code, f"reading,c [mol/L]\n{rows}")
    build.build(Study(tmp_path), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html", viewport={"width": 1200, "height": 900})
    live.type("c", 2, "1.01e-7")
    live.drawn()
    boxes = live.page.locator("#live-panel svg g text").evaluate_all(
        "all => all.map((one) => one.getBoundingClientRect()).map((box) => [box.left, box.right, box.top,"
        " box.bottom])"
    )
    assert len(boxes) > 6
    for (left, right, top, bottom), other in combinations(boxes, 2):
        assert left >= other[1] or right <= other[0] or top >= other[3] or bottom <= other[2]
