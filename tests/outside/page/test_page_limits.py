"""Decisions on limits, which follow an edit of the page as far as first order tells U."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from driving import Live
from helpers import method_folder

from loopsheet.report.build import build
from loopsheet.report.study import Study

METHOD = """
from loopsheet import Method, given, let, mean, measured

class Density(Method, headline="rho_mean"):
    "Density of a liquid by weighing."
    m = measured("g", "mass", positive=True)
    V = given("cm^3", "volume", positive=True)
    rho = let(m / V, "density", "g/cm^3")
    rho_mean = let(mean(rho), "mean density", "g/cm^3")
    water = given("g/cm^3", "density of water")
    off = let((rho_mean - water) ** 2, "square of how far it is from water", "kg^2/m^6")
"""
TOML = """title = "Density"
workbook = "workbook.py"

[parameters]
V = "{V}"
water = "1.000 g/cm^3, exact"

[measurements]
file = "measurements.csv"

[uncertainty]
m = "u = 0.02 g"

[limits]
rho_mean = "0.990 .. 1.010 g/cm^3"
"rho[1]" = "0.990 .. 1.010 g/cm^3, guard = U"
"rho[2]" = ">= 0.990 g/cm^3, guard = 0.8 U"
"rho[3]" = "<= 1.010 g/cm^3, guard = 0.004 g/cm^3"
"rho[4]" = "0.990 .. 1.010 g/cm^3, guard = U, level = 99 %"
"rho[5]" = "0.999 .. 1.001 g/cm^3, guard = U"
off = "<= 100 kg^2/m^6, guard = U"
V = "9.8 .. 10.1 cm^3, guard = U"
"""


def folder_of(at: Path, masses: str, volume: str) -> Path:
    at.mkdir()
    (at / "workbook.py").write_text(METHOD)
    (at / "report.toml").write_text(TOML.replace("{V}", volume))
    rows = "".join(f"{n},{mass}\n" for n, mass in enumerate(masses.split(), 1))
    (at / "measurements.csv").write_text(f"test,m [g]\n{rows}")
    return at


def told(live: Live) -> dict[str, str]:
    """What the page decides now, by cell."""
    live.wait_for_draws()
    line = live.page.locator("main .decided + p.stale").text_content() or ""
    _, _, now = line.rstrip(".").partition("With them: ")
    return dict(one.split(" ", 1) for one in now.split("; "))


def rebuilt(folder: Path) -> dict[str, str]:
    """What a build decides."""
    found = Study(folder).report.uncertain().conformities
    return {each.budget.cell: str(each.decision) for each in found}


@pytest.mark.parametrize(
    ("edits", "masses", "volume"),
    [
        ({1: "9.92"}, "9.92 10.00 10.00 10.00 10.00", "10.00(2) cm^3"),
        ({1: "9.95", 2: "9.95", 3: "10.07"}, "9.95 9.95 10.07 10.00 10.00", "10.00(2) cm^3"),
        ({1: "10.2", 4: "10.2", 5: "10.2"}, "10.2 10.00 10.00 10.2 10.2", "10.00(2) cm^3"),
        ({1: "9.91", 2: "9.92", 3: "10.05"}, "9.91 9.92 10.05 10.00 10.00", "10.00(2) cm^3"),
        ({1: "9.99", 2: "10.01"}, "9.99 10.01 10.00 10.00 10.00", "10.00(2) cm^3"),
        ({"V": "10.09"}, "10.00 10.00 10.00 10.00 10.00", "10.09(2) cm^3"),
        ({"V": "9.85"}, "10.00 10.00 10.00 10.00 10.00", "9.85(2) cm^3"),
    ],
)
def test_decisions_are_those_of_a_build(
    open_page: Callable[..., Live], tmp_path: Path, edits: dict[int | str, str], masses: str, volume: str
) -> None:
    folder = folder_of(tmp_path / "issued", "10.00 10.00 10.00 10.00 10.00", "10.00(2) cm^3")
    build(Study(folder), folder / "out", ("html",))
    live = open_page(folder / "out" / "report.html")
    for row, text in edits.items():
        live.type(*(("V", "") if row == "V" else ("m", row)), text)
    now, again = told(live), rebuilt(folder_of(tmp_path / "again", masses, volume))
    assert now.keys() == again.keys()
    for cell, word in now.items():
        if word != "is decided by a build":
            assert again[cell] in word, cell
    assert "…" not in "".join(now.values())
    assert now["rho[4]"] in ("is decided by a build", "does not conform")
    assert {cell for cell, word in now.items() if word == "is decided by a build"} <= {"rho[4]", "off"}


@pytest.mark.parametrize(
    ("mean", "word"), [("2.032", "conforms"), ("2.031", "lies in the guard band: no decision")]
)
def test_a_value_on_an_acceptance_limit_is_on_it(
    open_page: Callable[..., Live], tmp_path: Path, mean: str, word: str
) -> None:
    """The mean of eight readings of 2.032 mm is 2.0319999999999995 to whoever adds them up in metres."""
    code = "from loopsheet import Method, let, mean, measured\n\nclass Mean(Method, headline='w'):\n"
    code += "    'A mean.'\n    x = measured('mm', 'reading')\n    w = let(mean(x), 'mean')\n"
    rows = "".join(f"{n},2.050\n" for n in range(1, 9))
    more = '[limits]\nw = "2.022 .. 2.100 mm, guard = 0.010 mm"\n'
    method_folder(tmp_path, code, f"reading,x [mm]\n{rows}", more)
    build(Study(tmp_path), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html")
    live.input("x", 1).click()
    live.paste(f"{mean}\n" * 8)
    assert told(live) == {"w": word}


def test_of_rows_that_are_new_a_build_decides(open_page: Callable[..., Live], tmp_path: Path) -> None:
    folder = folder_of(tmp_path / "issued", "10.00 10.00 10.00 10.00 10.00", "10.00(2) cm^3")
    build(Study(folder), folder / "out", ("html",))
    live = open_page(folder / "out" / "report.html")
    live.click("live-add")
    live.type("m", 6, "12.00")
    live.wait_for_draws()
    told = live.page.locator("main .decided + p.stale").text_content() or ""
    assert told.endswith("; of new rows a build decides.")


def test_of_a_result_at_a_corner_it_is_told_that_nothing_is_known(
    open_page: Callable[..., Live], tmp_path: Path
) -> None:
    code = (
        "from loopsheet import Method, given, let\n\nclass Corner(Method, headline='p'):\n    'A distance.'\n"
        "    m = given('mm', 'one')\n    z = given('mm', 'other')\n"
        "    p = let(max(m - z, z - m), 'distance')\n"
    )
    method_folder(tmp_path, code, more='[parameters]\nm = "5.2 mm, u = 0.02"\nz = "1.0 mm, u = 0.2"\n')
    build(Study(tmp_path), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html")
    live.type("z", "", "5.2")
    live.wait_for_draws()
    told = "U is not known: second order was not looked at"
    assert told in (live.page.locator(".headline").text_content() or "")
    live.type("z", "", "5.1")
    live.wait_for_draws()
    assert told not in (live.page.locator(".headline").text_content() or "")
