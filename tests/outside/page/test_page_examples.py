"""Shipped examples in the page: after an edit it is what a folder with the edit gives, in its own words."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from shutil import copytree

import driving
import pytest
from driving import Live

from loopsheet.report.build import build
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.study import Study

EDITS = {
    "gum_h1": (("theta", "", "-0.3"), "report.toml", 'theta = "-0.1 K', 'theta = "-0.3 K'),
    "colebrook": (("Re", "", "2E5"), "report.toml", 'Re = "1E5', 'Re = "2E5'),
    "hertz": (("nu", "", "0.25"), "report.toml", 'nu = "0.3', 'nu = "0.25'),
    "meyer": (("F", 3, "2942"), "measurements.csv", "2924", "2942"),
    "kepler": (("M", 4, "6"), "measurements.csv", "4,0.4,5", "4,0.4,6"),
}
"""What is typed, and the same in a file; the fits gum_h3 and misra1a are edited elsewhere."""
OF_THE_PAPER = r"generated|alpha_[mle]|x_[pm]\b|impact speed|restitution|imprint depth|ball drop|\btests\b"


@pytest.mark.parametrize("name", EDITS)
def test_the_edited_page_is_what_a_rebuild_gives(
    open_page: Callable[..., Live], tmp_path: Path, name: str
) -> None:
    typed, file, old, new = EDITS[name]
    folder = copytree(PAPER.parent / name, tmp_path / name, ignore=lambda *_: ["out", "__pycache__"])
    build(Study(folder), tmp_path / "out", ("html",))
    issued = Study(folder).computed.values
    live = open_page(tmp_path / "out" / "report.html")
    assert re.findall(OF_THE_PAPER, live.page.locator("main").inner_text(), re.IGNORECASE) == []
    live.type(*typed)
    path = folder / file
    before = path.read_text(encoding="utf-8")
    assert before.count(old) == 1
    path.write_text(before.replace(old, new), encoding="utf-8")
    cells = live.cells()
    assert driving.differences(cells, Study(folder).computed.values) == []
    assert driving.differences(cells, issued) != []
    live.click("live-save")
    saved = live.page.locator("#live-note a[download]").all_inner_texts()
    assert sorted(saved) == sorted(path.name for path in folder.iterdir() if path.name != "__pycache__")
