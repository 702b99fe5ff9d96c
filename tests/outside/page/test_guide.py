"""What the guide says of an edit in the page is what a reader of it sees."""

import re
from collections.abc import Callable
from pathlib import Path

from driving import Live
from test_docs import DOCS

from loopsheet.report.cli import main


def test_the_edit_of_the_guide(
    open_page: Callable[..., Live], tmp_path: Path, chdir: Callable[[Path], None]
) -> None:
    text = " ".join((DOCS / "guide.md").read_text(encoding="utf-8").split())
    said = re.search(
        r"period of swing (\d), type `(.+?)` in the place of `(.+?)`.* result goes from `(.+?)` to `(.+?)`",
        text,
    )
    assert said
    swing, typed, stood, before, after = said.groups()
    chdir(tmp_path)
    assert main(["new", "pendulum", "--workbook", "formula"]) == 0
    assert main(["build", "pendulum", "--to", "html"]) == 0
    live = open_page(tmp_path / "pendulum" / "out" / "report.html")
    assert (live.cell("T", swing).text, live.cell("g").text) == (stood, before)
    live.type("T", swing, typed)
    assert (live.cell("g").text, live.cell("g").changed) == (after, True)
    live.click("live-reset")
    assert live.cell("g").text == before
