"""Fits of methods in the page: after an edit they are what a folder with the edit gives."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from shutil import copytree

import driving
import pytest
from driving import Live
from helpers import method_folder
from test_fit_of_both import pearson

from loopsheet.report.build import build
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.study import Study

EDITS = {
    "another correction": ("gum_h3", ("b", 4, "-0.170"), "4,23.003,-0.159", "4,23.003,-0.170"),
    "another temperature": ("gum_h3", ("t", 1, "20.521"), "1,21.521,-0.171", "1,20.521,-0.171"),
    "another volume": ("misra1a", ("y", 14, "80.50"), "14,760.0,81.78", "14,760.0,80.50"),
    "another pressure": ("misra1a", ("x", 2, "104.9"), "2,114.9,14.73", "2,104.9,14.73"),
}
HELPERS = ("line_N1", "line_J2_1", "curve_N1", "curve_J1", "curve_step1")


@pytest.mark.parametrize("name", EDITS)
def test_the_edited_page_is_what_a_rebuild_gives(
    open_page: Callable[..., Live], tmp_path: Path, name: str
) -> None:
    shipped, typed, old, new = EDITS[name]
    folder = tmp_path / shipped
    copytree(PAPER.parent / shipped, folder, ignore=lambda *_: ["out", "__pycache__"])
    build(Study(folder), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html")
    issued = Study(folder).computed.values
    live.type(*typed)
    table = folder / "measurements.csv"
    before = table.read_text(encoding="utf-8")
    assert before.count(old) == 1
    table.write_text(before.replace(old, new), encoding="utf-8")
    again = Study(folder).computed.values
    # What is left of a difference of larger numbers is as sure as these are.
    of_differences = [cell for cell in live.cells() if cell.name.endswith("_residual")]
    cells = [cell for cell in live.cells() if cell not in of_differences]
    assert driving.differences(cells, again) == []
    assert driving.differences(cells, issued) != []
    for cell in of_differences:
        row = again.row(again.sheet[cell.name], (int(cell.index),))
        size = abs(again.value[cell.name.replace("residual", "fitted")][row])
        assert float(cell.value) == pytest.approx(again.value[cell.name][row], rel=0, abs=1e-13 * size)
    assert not {cell.name for cell in live.cells()} & set(HELPERS), "what only leads there is in no table"
    assert set(HELPERS) & again.sheet.by_name.keys()
    if shipped == "misra1a":
        live.page.locator('main [data-cell="b_1"]').first.click()
        assert live.page.locator("#formula-bar").get_attribute("data-cell") == "b_1"
        beside = live.page.locator("#bar-precedents button, #bar-dependents button")
        assert "b_1" not in beside.evaluate_all("all => all.map((one) => one.dataset.goto)")


def test_a_line_with_errors_in_both_variables_is_fitted_anew(
    open_page: Callable[..., Live], tmp_path: Path
) -> None:
    folder = pearson(tmp_path)
    build(Study(folder), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html")
    issued = Study(folder).computed.values
    live.type("y", 4, "4.9")
    table = folder / "measurements.csv"
    rows = table.read_text(encoding="utf-8")
    assert rows.count(",4.6,") == 1
    table.write_text(rows.replace(",4.6,", ",4.9,"), encoding="utf-8")
    again = Study(folder).computed.values
    cells = [cell for cell in live.cells() if cell.name in ("a", "b", "u_a", "u_b", "line_at_x", "line_S")]
    assert {cell.name for cell in cells} >= {"a", "b", "u_b", "line_at_x"}
    assert driving.differences(cells, again) == []
    assert driving.differences(cells, issued) != []


COUNTS = """
from sympy import exp

from loopsheet import Method, fit, let, measured, uncertainty, unknown


class Counts(Method, rows="countings", headline="rate y_mean"):
    "A source by counting."
    t = measured("min", "time")
    N = measured("1", "counts", positive=True)
    u_N = uncertainty(N)
    N_0 = unknown("counts at the beginning", "1", start=1000)
    rate = unknown("decay constant", "1/min", start=0.3)
    curve = fit(N, N_0 * exp(-rate * t), u=u_N)
    y = let(u_N / N, "relative uncertainty")
    y_mean = let(sum(y), "all of them")
"""
COUNTED = """\
counting,t [min],N [1],u(N) [1],left out
1,0,1012,31.81,
2,1,790,28.11,
3,2,651,25.51,
4,3,508,22.54,hot
5,4,398,19.95,
"""


def test_stated_uncertainties_that_a_method_names_stand_in_the_page(
    open_page: Callable[..., Live], tmp_path: Path
) -> None:
    """They are told beside what they are of, and follow what is typed there."""
    folder = method_folder(tmp_path / "counts", COUNTS, COUNTED, '[uncertainty]\nt = "exact"\n')
    build(Study(folder), tmp_path / "out", ("html",))
    live = open_page(tmp_path / "out" / "report.html")
    assert live.cell("u_N", "2").text == "28.11"
    assert live.errors == []
    live.type("N", 3, "700")
    live.type("N", 1, "1000")
    live.page.locator('[data-use="4"]').click()
    saved = live.save(tmp_path / "saved", "workbook.py")
    assert live.errors == []
    assert driving.differences(live.cells(), Study(saved).computed.values) == []
