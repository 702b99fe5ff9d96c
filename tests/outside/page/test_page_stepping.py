"""Inputs that are moved by their last printed digit, and the curves as issued below those that move."""

from collections.abc import Callable

import pytest
from driving import Live

Open = Callable[..., Live]

GREY = "#figure-alpha_pairs svg path[stroke='#c4c4c4']"


def test_alt_and_an_arrow_step_the_last_digit(live: Live, open_page: Open) -> None:
    issued, typed = live.cells(), open_page()
    live.input("x_p", 2).click()
    live.press("Alt+ArrowUp")
    assert live.focused() == "x_p[2]"
    assert live.input("x_p", 2).input_value() == "29.8"
    typed.type("x_p", 2, "29.8")
    assert live.cells() == typed.cells() != issued
    live.press("Alt+ArrowUp", "Alt+ArrowDown", "Alt+ArrowDown")
    assert live.cells() == issued
    live.press("Control+z")
    assert live.input("x_p", 2).input_value() == "29.8"


@pytest.mark.parametrize(
    ("text", "below"), [("2.5", "2.4"), ("2.50(3)", "2.49(3)"), ("25e-1(2)", "24e-1(2)")]
)
def test_what_is_being_typed_is_stepped(live: Live, text: str, below: str) -> None:
    live.input("v", 1).click()
    live.page.keyboard.type(text)
    live.press("Alt+ArrowDown")
    assert live.input("v", 1).input_value() == below


def test_the_issued_curves_lie_in_grey_below_edited_ones(live: Live) -> None:
    assert live.page.locator(GREY).count() == 0
    live.type("x_p", 2, "29.9")
    live.drawn()
    below = live.page.locator(f"{GREY}[stroke-linecap]")
    assert below.get_attribute("d").count("M") == 10  # type: ignore[union-attr]
    assert "as issued" in live.page.locator("#figure-alpha_pairs svg text").all_text_contents()
    live.click("live-reset")
    assert live.page.locator(GREY).count() == 0
