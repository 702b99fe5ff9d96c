"""What computed a report, by content: the same from a checkout and from a wheel, another after any change."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from loopsheet.report.machine.provenance import PARTS, ROOT, sources


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """The package's files without anything that was made from them."""
    root = tmp_path / "package"
    for name in ("__init__.py", "__main__.py"):
        root.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, root)
    for name in ("derivations", "report", "templates"):
        shutil.copytree(ROOT / name, root / name, ignore=shutil.ignore_patterns("__pycache__"))
    return root


def test_each_part_has_a_sum_and_no_place(package: Path) -> None:
    found = sources()
    assert list(found) == list(PARTS) == ["method", "program", "templates"]
    assert all(len(value) == 64 for value in found.values())
    assert len(set(found.values())) == 3
    assert sources(package) == found


@pytest.mark.parametrize(
    ("file", "part"),
    [
        ("derivations/hertz.py", "method"),
        ("report/workbooks/soft_impact.py", "method"),
        ("report/engines/numpy.py", "program"),
        ("report/cli.py", "program"),
        ("__init__.py", "program"),
        ("templates/new.txt", "templates"),
    ],
)
def test_a_change_shows_in_its_part_alone(file: str, part: str, package: Path) -> None:
    before = sources(package)
    with (package / file).open("a") as opened:
        opened.write("\n# one more line\n")
    after = sources(package)
    assert [name for name in PARTS if before[name] != after[name]] == [part]


def test_a_file_that_moves_is_a_change(package: Path) -> None:
    before = sources(package)
    (package / "report" / "cells" / "layout.py").rename(package / "report" / "layout2.py")
    assert sources(package)["program"] != before["program"]


def test_what_is_made_from_the_sources_does_not_count(package: Path) -> None:
    before = sources(package)
    for name in (
        "report/__pycache__/x.py",
        "templates/.hidden",
        "templates/__pycache__/y",
        "report/notes.txt",
    ):
        (package / name).parent.mkdir(exist_ok=True)
        (package / name).write_text("x")
    assert sources(package) == before
