"""What is printed steers no terminal, whoever wrote it, and tells machines of every end."""

from __future__ import annotations

import io
import json
import os
import sys
import unicodedata
from pathlib import Path
from xml.etree import ElementTree

import pytest
from small_report import FILES, SOURCE, end_gauge

from loopsheet.report import stages
from loopsheet.report.cli import main
from loopsheet.report.messages.diagnostics import VisibleStream

FOREIGN = "a\u202eb\u200fc\u00add\U000e0041e\u2066f"
"""Characters that turn text around, or have no glyph."""


def hidden(text: str) -> set[str]:
    return {c for c in text if unicodedata.category(c) in ("Cc", "Cf", "Co", "Cs", "Zl", "Zp") and c != "\n"}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder whose texts are foreign; no programs, which take their time."""
    monkeypatch.setenv("PATH", "")
    monkeypatch.chdir(tmp_path)
    published = f'source,cell,index,value,unit,expect,reason\n{FOREIGN},l,1,51.0,mm,differs,"{FOREIGN}"\n'
    folder = end_gauge(
        tmp_path,
        published,
        report=f'title = "{FOREIGN}"\n' + FILES["report.toml"],
        workbook=SOURCE.replace("length of the end gauge", FOREIGN).replace(
            'title="End', f'title="{FOREIGN}'
        ),
    )
    return folder


@pytest.mark.parametrize(
    "arguments",
    [
        *(["check", ".", "--format", form] for form in ("text", "json")),
        ["build", ".", "--out", "out", "--to", "json"],
        ["show", "l", "."],
        ["why", "l[1]", "."],
        ["prove", "(H.1)", "."],
    ],
    ids=" ".join,
)
def test_foreign_text_is_clean_wherever_it_is_printed(
    arguments: list[str], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = main(arguments)
    out, err = capsys.readouterr()
    assert code in (0, 1), err
    assert out
    assert hidden(out + err) == set()
    if "json" in arguments and arguments[0] == "check":
        assert json.loads(out)["title"] == FOREIGN


def test_what_is_compared_is_clean_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cells = {FOREIGN: {"axis": None, "unit": FOREIGN, "value": 1, "status": FOREIGN, "rule": FOREIGN}}
    content = {"schema": 1, "title": "t", "workbook": "w", "cells": cells, "proofs": {}, "published": []}
    for name, word in (("a.json", "w"), ("b.json", FOREIGN)):
        (tmp_path / name).write_text(json.dumps({**content, "workbook": word}))
    for form in ("text", "markdown"):
        assert main(["diff", str(tmp_path / "a.json"), str(tmp_path / "b.json"), "--format", form]) == 1
        said = capsys.readouterr()
        assert hidden(said.out + said.err) == set()


def test_all_else_is_written_as_it_is(capsys: pytest.CaptureFixture[str]) -> None:
    print("α ≥ 1\n\nü", file=VisibleStream(sys.stdout))  # type: ignore[arg-type]
    assert capsys.readouterr().out == "α ≥ 1\n\nü\n"


@pytest.mark.parametrize("form", ["text", "json", "junit", "github", "markdown"])
def test_a_bug_is_told_to_machines(
    form: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise RuntimeError(f"x{FOREIGN}")

    monkeypatch.setattr(stages, "evaluated", fail)
    assert main(["check", "paper", "--format", form]) == 3
    out, err = capsys.readouterr()
    assert "bug: RuntimeError: xa\\u202eb" in err
    assert hidden(out + err) == set()
    assert ("RuntimeError: xa" in out) is (form != "text")
    if form == "json":
        assert not json.loads(out)["passed"]
        assert json.loads(out)["checks"][0]["kind"] == "bug"
    if form == "junit":
        assert ElementTree.fromstring(out.encode()).get("failures") == "1"


def test_a_terminal_of_another_encoding_gets_escapes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    content = {"schema": 1, "title": "t", "workbook": "α", "cells": {}, "proofs": {}, "published": []}
    (tmp_path / "a.json").write_text(json.dumps(content))
    (tmp_path / "b.json").write_text(json.dumps({**content, "workbook": "β"}))
    terminal = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr(sys, "stdout", terminal)
    assert main(["diff", str(tmp_path / "a.json"), str(tmp_path / "b.json")]) == 1
    assert b"\\u03b1" in terminal.buffer.getvalue()  # type: ignore[attr-defined]


def test_the_name_of_a_folder_stays_on_its_line(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One with a line break is told with an escape, as text in a file is."""
    broken = os.fspath(tmp_path / "first\nsecond")
    main(["build", os.fspath(folder), "--out", broken, "--to", "json"])
    assert main(["crate", broken, os.fspath(folder), "--date", "2026-03-31", "--license", "MIT"]) == 0
    assert main(["new", os.path.join(broken, "own")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert sum(line.startswith("second") for line in lines) == 1  # a command as it has to be typed
    assert sum(r"first\x0asecond" in line for line in lines) == 5
