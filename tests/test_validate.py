"""`loopsheet validate`: shipped examples come out as published, and the record says whether they do."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from shutil import copytree
from typing import Any
from xml.etree import ElementTree

import pytest

from loopsheet.report.cli import main
from loopsheet.report.engines import numpy as engine
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.machine import kept

GAUGE = PAPER.parent / "gum_h1"


@pytest.fixture
def gauge(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of a shipped example where one stands, and no programs, which take their time."""
    monkeypatch.setenv("PATH", "")
    monkeypatch.chdir(tmp_path)
    copytree(GAUGE, "gauge", ignore=lambda *_: ["out", "__pycache__"])
    return Path("gauge")


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text(encoding="utf-8")
    assert text.count(old) == 1
    file.write_text(text.replace(old, new), encoding="utf-8")


def test_a_record_says_what_was_run_and_that_it_passes(
    gauge: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["validate", "gauge", "--out", "record.txt"]) == 0
    told = capsys.readouterr().out
    assert Path("record.txt").read_text(encoding="utf-8") == told
    assert "PASS: 21 checks of 1 example, 2 not checked: a program is not installed\n" in told
    assert "gauge: GUM H.1, end-gauge calibration" in told
    for line in ("H.1.5 l 50.000838 mm 50.000838 mm pass", "H.1.7 u(l) 34 nm 34 nm pass"):
        assert line in [" ".join(found.split()) for found in told.splitlines()]
    assert str(Path.cwd()) not in told
    assert "Date  " in told
    assert main(["validate", "gauge"]) == 0
    assert capsys.readouterr().out == told


@pytest.mark.usefixtures("keeping")
def test_what_is_not_checked_says_why(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A sum of squares that a shared error hides waits for no program."""
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr(kept, "nothing_kept", nullcontext)  # the algebra of the paper is a build of its own
    steel = copytree(PAPER, tmp_path / "steel", ignore=lambda *_: ["out"])
    shared = '[uncertainty.shared.datum]\nof = "x_p"\nstated = "u = 1 m"\n\n[published]'
    edit(steel / "report.toml", "[published]", shared)
    (steel / "published.csv").write_text("source,cell,index,value,unit\nhere,alpha_mean,,1.303,1\n")
    text = (steel / "report.toml").read_text()
    (steel / "report.toml").write_text(text[: text.index("by = ")])
    assert main(["validate", str(steel)]) == 0
    told = capsys.readouterr().out
    assert "2 not checked: a program is not installed, 1 not checked: chi2_eiv: errors are shared" in told


@pytest.mark.parametrize(
    ("printed", "wrong", "named"),
    [
        ("50.000838", "50.000839", "H.1.5 l 50.000839 mm 50.000838 mm FAIL (reachable)"),
        (",34,nm", ",35,nm", "H.1.7 u(l) 35 nm 34 nm FAIL (reachable)"),
        (",2.92,1,", ",2.93,1,", "H.1.6 k99(l) 2.93 2.92 FAIL (differs)"),
        (",16.6,nm", ",16.7,nm", "Table H.1 u(l, dtheta) 16.7 nm 16.6 nm FAIL (reachable)"),
    ],
)
def test_one_wrong_digit_fails(
    gauge: Path, printed: str, wrong: str, named: str, capsys: pytest.CaptureFixture[str]
) -> None:
    edit(gauge / "published.csv", printed, wrong)
    assert main(["validate", "gauge"]) == 1
    told = [" ".join(line.split()) for line in capsys.readouterr().out.splitlines()]
    assert named in told
    assert any(line.startswith("FAIL: ") and line.endswith("of 21 checks of 1 example, 2 not checked: a "
               "program is not installed") for line in told)  # fmt: skip


def test_a_wrong_engine_fails(
    gauge: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def wrong(*arguments: Any) -> Any:
        values = right(*arguments)
        return replace(values, value={**values.value, "l": values.value["l"] * (1 + 1e-13)})

    right: Callable[..., Any] = engine.evaluate
    monkeypatch.setattr(engine, "evaluate", wrong)
    assert main(["validate", "gauge"]) == 1
    assert "FAIL engine l" in capsys.readouterr().out


def test_machines_are_told_the_same(gauge: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(gauge / "published.csv", ",34,nm", ",35,nm")
    assert main(["validate", "gauge", "--format", "json"]) == 1
    told = json.loads(capsys.readouterr().out)
    (example,) = told["examples"]
    assert (told["passed"], example["passed"]) == (False, False)
    assert [each["what"] for each in example["published"] if "FAIL" in each["verdict"]] == ["u(l)"]
    assert main(["validate", "gauge", "--format", "junit"]) == 1
    assert ElementTree.fromstring(capsys.readouterr().out).get("failures") == "1"
    assert main(["validate", "gauge", "--format", "markdown"]) == 1
    assert "| H.1.7 | u(l) | 35 nm | 34 nm | FAIL (reachable) |" in capsys.readouterr().out


def test_what_cannot_be_written_leaves_what_is_there(gauge: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["validate", "gauge", "--out", "gauge"]) == 2
    assert "'gauge' cannot be written: it is a folder" in capsys.readouterr().err
    assert sorted(path.name for path in gauge.iterdir()) == ["published.csv", "report.toml", "workbook.py"]


@pytest.mark.parametrize("kind", ["text", "markdown", "json", "junit"])
def test_a_record_replaces_a_record_and_nothing_else(
    gauge: Path, kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    order = ["validate", "gauge", "--format", kind, "--out", "record"]
    Path("record").write_text("my own notes\n", encoding="utf-8")
    assert main(order) == 2
    assert "'record' is there already, and is no 'Validation of loopsheet'" in capsys.readouterr().err
    assert Path("record").read_text(encoding="utf-8") == "my own notes\n"
    Path("record").unlink()
    assert main(order) == main(order) == 0
    capsys.readouterr()


def test_where_nothing_is_published_nothing_was_validated(
    gauge: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    copytree("gauge", "silent")
    edit(Path("silent/report.toml"), '[published]\nfile = "published.csv"\n', "")
    assert main(["validate", "silent"]) == 0
    told = capsys.readouterr().out
    assert "NOTHING TO COMPARE: no value is published; " in told
    assert "NOTHING TO COMPARE: JCGM 100" in told
    assert "PASS" not in told
    assert main(["validate", "silent", "gauge"]) == 0
    told = capsys.readouterr().out
    assert "; nothing to compare in silent\n" in told
    assert "PASS: JCGM 100" in told
    main(["validate", "silent", "--format", "json"])
    assert json.loads(capsys.readouterr().out)["examples"][0]["passed"] is None
