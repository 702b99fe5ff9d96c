"""The RO-Crate that loopsheet writes, judged by roc-validator in an environment of its own."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from loopsheet.report.archive.crate import NAME, write

HERE = Path(__file__).parent

Judge = Callable[[Path], dict[str, Any]]


@pytest.fixture(scope="session")
def judge(environment: Callable[..., Path]) -> Judge:
    """The pinned judge."""
    python = environment("crate")

    def ask(folder: Path) -> dict[str, Any]:
        run = subprocess.run(
            [python, HERE / "validate_crate.py", folder], capture_output=True, text=True, check=False
        )
        assert run.returncode == 0, run.stderr
        found: dict[str, Any] = json.loads(run.stdout.splitlines()[-1])
        return found

    return ask


@pytest.fixture(scope="module")
def out(issued: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return shutil.copytree(issued / "out", tmp_path_factory.mktemp("crate") / "out")


def test_with_all_that_may_be_said_nothing_is_missing(out: Path, judge: Judge) -> None:
    write(
        out,
        "2026-03-31",
        "CC-BY-4.0",
        "Somebody <https://orcid.org/0000-0002-1825-0097>",
        "A university <https://example.edu>",
    )
    found = judge(out)
    assert found["issues"] == []
    assert found["checks"] > 50


def test_with_as_little_as_may_be_said_nothing_required_is_missing(out: Path, judge: Judge) -> None:
    write(out, "2026-03-31", "https://example.org/licence")
    assert {severity for severity, _ in judge(out)["issues"]} <= {"RECOMMENDED"}


def test_the_judge_sees_what_is_wrong(out: Path, judge: Judge) -> None:
    path = write(out, "2026-03-31", "CC-BY-4.0")
    path.write_text(path.read_text(encoding="utf-8").replace('"datePublished"', '"dateWritten"'))
    issues = judge(out)["issues"]
    assert any(severity == "REQUIRED" for severity, _ in issues), issues
    assert path.name == NAME
