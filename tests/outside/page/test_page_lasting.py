"""Edits outlive the page: it keeps them, links carry them, closing asks; what does not fit is left alone."""

import base64
import json
import re
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import driving
import html5lib
import pytest
from driving import Live
from playwright.sync_api import Dialog

from loopsheet.report import build
from loopsheet.report.study import Study

Open = Callable[..., Live]

OTHER_ISSUE = "another issue of this report"


@pytest.fixture
def copied(issued: Path, tmp_path: Path) -> Path:
    """The page of the paper at an address of its own."""
    path = tmp_path / "report.html"
    path.write_bytes(issued.read_bytes())
    return path


WAYS = ("undo", "redo", "reset")


def leave(dialog: Dialog) -> None:
    dialog.accept()


def reload(live: Live) -> None:
    live.page.on("dialog", leave)
    live.page.reload()
    live.page.remove_listener("dialog", leave)


def link(live: Live) -> str:
    live.click("live-link")
    href = live.page.locator("#live-note a").get_attribute("href")
    assert href is not None
    return href


def as_issued(live: Live) -> bool:
    cells = live.cells()
    return not live.text("live-banner") and not any(cell.changed or cell.added for cell in cells)


def edit(live: Live) -> None:
    """Digits, a test that is left out and why, one more test, a parameter."""
    live.type("x_p", 2, "29.80")
    live.page.locator('[data-use="3"]').click()
    live.page.locator('[data-reason="3"]').fill('heard "twice", ☃')
    live.press("Enter")
    live.click("live-add")
    for text in ("5.50", "0.44", "56.6"):
        live.page.keyboard.type(text)
        live.press("Tab")
    live.type("beta", "", "1.40")


def test_two_windows_show_the_same_edits(open_page: Open, copied: Path) -> None:
    """Neither writes over what the other one keeps."""
    one = open_page(copied)
    other = Live(one.page.context.new_page(), copied)
    other.load()
    one.type("x_p", 2, "30.0")
    other.page.wait_for_function(
        "document.querySelector('#live-note').textContent.includes('another window')"
    )
    other.type("v", 1, "2.5")
    one.page.wait_for_function("document.querySelector('#live-note').textContent.includes('another window')")
    for live in (one, other):
        assert (live.input("x_p", 2).input_value(), live.input("v", 1).input_value()) == ("30.0", "2.5")
    assert one.cells() == other.cells()
    other.click("live-reset")
    one.page.wait_for_function("!document.querySelector('#live-banner').textContent")
    assert as_issued(one)
    assert other.errors == []


def test_edits_are_there_after_a_reload(open_page: Open, copied: Path) -> None:
    live = open_page(copied)
    edit(live)
    cells, around, paths = live.cells(), live.around(), live.paths("loops")
    reload(live)
    assert "here again" in live.text("live-note")
    assert live.text("live-banner").startswith("Edited: ")
    assert live.cells() == cells
    assert live.input("x_p", 2).input_value() == "29.80"
    assert live.page.locator('[data-reason="3"]').input_value() == 'heard "twice", ☃'
    assert (live.around(), live.paths("loops")) == (around, paths)
    live.click("live-reset")
    assert as_issued(live)
    assert live.text("live-note") == ""
    reload(live)
    assert as_issued(live)
    assert live.text("live-note") == ""


def test_edits_are_undone_one_by_one_after_a_reload(open_page: Open, copied: Path) -> None:
    live = open_page(copied)
    for column, text in (("x_p", "29.80"), ("v", "2.941"), ("e", "0.513")):
        live.type(column, 2, text)
    reload(live)
    seen = [live.text("live-banner")]
    for _ in range(3):
        live.click("live-undo")
        seen.append(live.text("live-banner"))
    assert [re.sub(" from .*", "", text) for text in seen] == [
        *("Edited: 3 inputs differ", "Edited: 2 inputs differ", "Edited: 1 input differs", ""),
    ]
    assert as_issued(live)


def stored(live: Live, path: Path) -> Path:
    """The page as a browser stores it: not the file that it read, but what stands in the window."""
    path.write_text(live.page.content(), encoding="utf-8")
    return path


def opened(open_page: Open, path: Path) -> Live:
    """A stored page, whose policy refuses the widths that scripts had set and set again."""
    live = open_page(path)
    live.errors[:] = [error for error in live.errors if not error.startswith("Applying inline style")]
    return live


def test_a_page_that_a_browser_stored_goes_on_from_its_edits(
    open_page: Open, copied: Path, tmp_path: Path
) -> None:
    issued = open_page(copied).cells()
    live = open_page(copied)
    edit(live)
    other = opened(open_page, stored(live, tmp_path / "stored.html"))
    assert "stored with the page" in other.text("live-note")
    assert other.cells() == live.cells()
    assert (other.around(), other.paths("loops")) == (live.around(), live.paths("loops"))
    assert other.page.locator("#live-panel").count() == 1
    other.type("v", 1, "2.4")
    again = opened(open_page, stored(other, tmp_path / "again.html"))
    assert again.input("v", 1).input_value() == "2.4"
    again.click("live-undo")
    assert again.cells() == live.cells()
    again.click("live-reset")
    assert again.cells() == issued
    assert as_issued(again)
    assert (live.errors, other.errors, again.errors) == ([], [], [])


def test_a_page_that_was_stored_as_issued_is_as_issued(open_page: Open, copied: Path, tmp_path: Path) -> None:
    live = open_page(copied)
    other = opened(open_page, stored(live, tmp_path / "stored.html"))
    assert as_issued(other)
    assert other.cells() == live.cells()
    for selector in ("#live-panel", "[data-copy]", "[data-remove]"):
        assert other.page.locator(selector).count() == live.page.locator(selector).count()


def test_a_stored_page_shows_the_inputs_of_its_numbers_without_a_script(
    open_page: Open, copied: Path, tmp_path: Path
) -> None:
    """As readers of mails and archives do, which run none."""
    live = open_page(copied)
    edit(live)
    page = html5lib.parse(stored(live, tmp_path / "stored.html").read_text(encoding="utf-8"))
    tag = "{http://www.w3.org/1999/xhtml}"
    (main,) = page.iter(f"{tag}main")
    inputs = [one for one in main.iter(f"{tag}input") if one.get("data-cell")]
    of = {(one.get("data-cell"), one.get("data-index")): one.get("value") for one in inputs}
    assert of == {
        (cell, index): live.input(cell, index).input_value() for cell, index in of if cell is not None
    }
    assert (of["x_p", "2"], of["beta", ""], of["v", "6"]) == ("29.80", "1.40", "5.50")
    used = [one.get("data-use") for one in main.iter(f"{tag}input") if one.get("checked") is not None]
    assert used == ["1", "2", "4", "5", "6"]


def test_what_was_said_of_edits_goes_with_the_next(open_page: Open, copied: Path) -> None:
    live = open_page(copied)
    live.type("x_p", 2, "29.8")
    for do in (lambda: live.type("e", 1, "0.52"), *(partial(live.click, f"live-{word}") for word in WAYS)):
        link(live)
        assert live.text("live-note") != ""
        do()
        assert live.text("live-note") == ""


def test_what_was_said_of_a_cell_without_a_place_goes_with_a_reset(live: Live) -> None:
    hint = live.page.locator("#bar-hint").text_content()
    live.page.locator("#cell-alpha-1-3").click()
    live.page.locator('[data-use="3"]').click()
    assert "no place in the sheet now" in live.text("bar-hint")
    live.click("live-reset")
    assert live.page.locator("#bar-hint").text_content() == hint


def test_what_is_being_typed_is_there_after_a_reload(open_page: Open, copied: Path) -> None:
    live = open_page(copied)
    live.input("x_p", 2).click()
    live.page.keyboard.type("29.99")
    reload(live)
    assert live.input("x_p", 2).input_value() == "29.99"


def test_a_link_carries_the_edits(open_page: Open, copied: Path) -> None:
    live = open_page(copied)
    edit(live)
    href = link(live)
    other = open_page(copied)
    assert as_issued(other)
    other.page.goto(href)
    other.page.reload()  # the file is the same, so that following the link loads nothing
    assert "came with the link" in other.text("live-note") or "here again" in other.text("live-note")
    assert other.cells() == live.cells()
    fresh = open_page(copied)
    fresh.page.goto("about:blank")
    fresh.page.goto(href)
    assert "came with the link" in fresh.text("live-note")
    assert fresh.cells() == live.cells()
    assert "#" not in fresh.page.url
    # What is edited from there on is not taken back by the link.
    fresh.type("e", 1, "0.52")
    reload(fresh)
    assert fresh.input("e", 1).input_value() == "0.52"
    assert fresh.input("x_p", 2).input_value() == "29.80"


def test_undo_leads_from_a_link_to_the_own_edits(open_page: Open, copied: Path) -> None:
    live = open_page(copied)
    live.type("v", 1, "2.4")
    href = link(live)
    live.click("live-reset")
    live.type("e", 1, "0.52")
    live.page.goto("about:blank")
    live.page.goto(href)
    assert (live.input("v", 1).input_value(), live.input("e", 1).input_value()) == ("2.4", "0.530")
    live.click("live-undo")
    assert (live.input("v", 1).input_value(), live.input("e", 1).input_value()) == ("2.334", "0.52")
    live.click("live-undo")
    assert as_issued(live)


def encoded(state: Any) -> str:
    text = state if isinstance(state, str) else json.dumps(state)
    return base64.urlsafe_b64encode(text.encode()).decode().rstrip("=")


def issue_of(page: Path) -> str:
    found = re.search(r'"issue":"([0-9a-f]{16})"', page.read_text(encoding="utf-8"))
    assert found is not None
    return found[1]


def state_with(**changes: Any) -> dict[str, Any]:
    """A state that fits, but for what is changed in its first test or in itself."""
    tests: list[dict[str, Any]] = [
        {"label": label, "used": True, "reason": "", "cells": dict(cells)}
        for label, cells in driving.paper().items()
    ]
    parameters = {"ball_diameter": "12.7", "ball_density": "7800", "beta": "1.5", "points_per_pair": "50"}
    whole = {"tests": tests, "parameters": parameters}
    for name, value in changes.items():
        if name in whole:
            whole[name] = value
        else:
            tests[0][name] = value
    return {"tables": {"tests": whole["tests"]}, "parameters": whole["parameters"]}


CELLS = {"v": "2.3", "e": "0.5", "x_p": "23"}
DAMAGED = {
    "cut off": lambda: encoded(state_with())[:-9],
    "no base64": lambda: "%%%",
    "nothing": lambda: "",
    "no JSON": lambda: encoded("{"),
    "no state": lambda: encoded([]),
    "null": lambda: encoded("null"),
    "no tests": lambda: encoded(state_with(tests=[])),
    "tests are none": lambda: encoded(state_with(tests={"length": 3})),
    "a number for a text": lambda: encoded(state_with(cells={"v": 2.3, "e": "0.5", "x_p": "23"})),
    "a column less": lambda: encoded(state_with(cells={"v": "2.3"})),
    "a label twice": lambda: encoded(state_with(label=2)),
    "no label": lambda: encoded(state_with(label="<b>")),
    "a control character": lambda: encoded(state_with(reason="a\x1b[2J")),
    "a line more": lambda: encoded(state_with(reason='"\n[published]')),
    "a long text": lambda: encoded(state_with(reason="x" * 10_000)),
    "too many tests": lambda: encoded(
        state_with(tests=[{"label": n, "used": True, "reason": "", "cells": CELLS} for n in range(1, 5000)])
    ),
    "no parameters": lambda: encoded(state_with(parameters={})),
    "no bytes of text": lambda: "__79",
}


@pytest.mark.parametrize("kind", DAMAGED)
def test_a_damaged_link_is_told_and_not_used(open_page: Open, copied: Path, kind: str) -> None:
    live = open_page(copied, at=f"#edits={issue_of(copied)}.{DAMAGED[kind]()}")
    live.page.wait_for_function("() => document.getElementById('live-note').textContent")
    assert "damaged" in live.text("live-note")
    assert as_issued(live)
    assert live.errors == []
    live.type("x_p", 2, "29.8")
    assert live.text("live-banner").startswith("Edited: ")


def test_a_state_is_read_that_says_more_than_it_should(open_page: Open, copied: Path) -> None:
    """What is not asked for goes nowhere; the rest fits."""
    state = state_with(more="x", cells={"v": "2.4", "e": "0.53", "x_p": "23.5", "__proto__": "x"})
    live = open_page(copied, at=f"#edits={issue_of(copied)}.{encoded(state)}")
    assert live.input("v", 1).input_value() == "2.4"
    assert "more" not in live.page.evaluate("() => Object.values(localStorage).join()")


def test_a_link_of_another_issue_is_told_and_not_used(open_page: Open, copied: Path) -> None:
    live = open_page(copied, at=f"#edits=0123456789abcdef.{encoded(state_with(reason='x'))}")
    assert "another report, or of another issue of this one" in live.text("live-note")
    assert as_issued(live)
    # An address that is no link of ours is left alone.
    live = open_page(copied, at="#referee")
    assert live.page.url.endswith("#referee")
    assert live.text("live-note") == ""


def test_edits_of_an_older_issue_stay_where_they_are(open_page: Open, copied: Path, tmp_path: Path) -> None:
    issued = copied.read_bytes()
    live = open_page(copied)
    live.type("x_p", 2, "29.8")
    folder = driving.write(tmp_path / "folder", driving.edited({("x_p", 2): "29.9"}))
    build.build(Study(folder), tmp_path / "out", ("html",))
    copied.write_bytes((tmp_path / "out" / "report.html").read_bytes())
    reload(live)
    assert OTHER_ISSUE in live.text("live-note")
    assert as_issued(live)
    assert live.input("x_p", 2).input_value() == "29.9"
    live.type("v", 1, "2.4")
    reload(live)
    assert live.input("v", 1).input_value() == "2.4"
    copied.write_bytes(issued)
    reload(live)
    assert (live.input("v", 1).input_value(), live.input("x_p", 2).input_value()) == ("2.334", "29.8")


@pytest.mark.usefixtures("unjudged")
def test_edits_that_were_saved_and_built_are_done_with(open_page: Open, copied: Path, tmp_path: Path) -> None:
    """The day's work in turns: edit, save, build, edit again; no issue of it is one of other edits."""
    live = open_page(copied)
    edit(live)
    live.page.locator('[data-remove="4"]').click()
    for round in ("one", "two"):
        folder = tmp_path / round
        live.save(folder)
        build.build(Study(folder), folder / "out", ("html",))
        copied.write_bytes((folder / "out" / "report.html").read_bytes())
        reload(live)
        assert live.text("live-note") == ""
        assert as_issued(live)
        assert live.input("x_p", 2).input_value() == "29.80"
        assert live.page.evaluate("() => Object.keys(localStorage)") == []
        live.type("v", 1, "2.4")


@pytest.mark.parametrize(
    "text", ["{", '{"tables": {"tests": []}}', "null", '"x"', json.dumps(state_with(label=-1))]
)
def test_what_was_kept_and_cannot_be_read_is_told(open_page: Open, copied: Path, text: str) -> None:
    live = open_page(copied)
    live.type("x_p", 2, "29.8")
    (key,) = live.page.evaluate("() => Object.keys(localStorage)")
    live.page.evaluate("([key, text]) => localStorage.setItem(key, text)", [key, text])
    reload(live)
    assert "cannot be read" in live.text("live-note")
    assert as_issued(live)


NO_MEMORY = """Object.defineProperty(window, "localStorage", {
  get() { throw new DOMException("no", "SecurityError"); },
});"""
FULL = """Storage.prototype.setItem = () => { throw new DOMException("full", "QuotaExceededError"); };"""


@pytest.mark.parametrize("script", [NO_MEMORY, FULL])
def test_a_page_whose_browser_keeps_nothing_works(open_page: Open, copied: Path, script: str) -> None:
    live = open_page(copied, own=True)
    live.page.add_init_script(script)
    reload(live)
    assert live.text("live-note") == ""
    live.type("x_p", 2, "29.8")
    assert "keeps no edits" in live.text("live-note")
    assert live.cell("alpha", "1-2").changed
    href = link(live)
    live.click("live-reset")
    assert as_issued(live)
    live.page.goto("about:blank")
    live.page.goto(href)
    assert live.input("x_p", 2).input_value() == "29.8"


def asked(live: Live) -> list[str]:
    """What the page asks when its window is closed, which it then is: Chromium fell over one that stays."""
    said: list[str] = []
    other = live.page.context.new_page()

    def go(dialog: Dialog) -> None:
        said.append(dialog.type)
        dialog.accept()

    live.page.on("dialog", go)
    live.page.close(run_before_unload=True)
    for _ in range(500):  # ten seconds at most
        if not live.page.is_closed():
            other.wait_for_timeout(20)
    return said


@pytest.mark.parametrize("does", ["nothing", "edit", "edit and link", "edit and reset"])
def test_closing_asks_while_there_are_edits_that_were_not_saved(
    open_page: Open, copied: Path, does: str
) -> None:
    live = open_page(copied)
    live.page.locator("h1").click()  # a page that nobody touched may not ask
    if "edit" in does:
        live.type("x_p", 2, "29.8")
    if "link" in does:
        link(live)
    if "reset" in does:
        live.click("live-reset")
    assert asked(live) == (["beforeunload"] if does == "edit" else [])


def test_closing_does_not_ask_after_saving(open_page: Open, copied: Path, tmp_path: Path) -> None:
    live = open_page(copied)
    live.type("x_p", 2, "29.8")
    live.save(tmp_path / "saved")
    assert asked(live) == []
