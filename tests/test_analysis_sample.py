"""Where there are too many cells for 50 digits, those of some tests are judged: the report's own numbers."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from large_campaigns import write

from loopsheet.report import stages
from loopsheet.report.cells.layout import how_large
from loopsheet.report.cli import main
from loopsheet.report.judge import sample
from loopsheet.report.prepared import Prepared
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study

MOST = 400


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Report:
    return Study(write(tmp_path_factory.mktemp("twelve"), 12)).computed


@pytest.fixture(autouse=True)
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stages, "EXACTLY", MOST)


def drawn(report: Report, most: int = MOST) -> tuple[int, ...]:
    return sample.part(report.inputs, report.marks.values, most).only.tests


def test_as_many_tests_are_drawn_as_there_is_room_for(report: Report) -> None:
    cells = how_large(report.marks.values.sheet, report.marks.values.layouts)
    assert sample.part(report.inputs, report.marks.values, cells) is report.inputs
    numbers = {most: len(drawn(report, most)) for most in (0, MOST, cells - 1)}
    assert numbers[0] == 2
    assert numbers[cells - 1] == 11
    assert 2 < numbers[MOST] < 11
    part = sample.part(report.inputs, report.marks.values, MOST)
    found = stages.evaluated(Prepared(part, report.sheet), report.ledger, stages.silent).marks.values
    assert how_large(found.sheet, found.layouts) <= MOST


def test_what_was_measured_draws_them_and_nothing_else(report: Report) -> None:
    inputs, values = report.inputs, report.marks.values
    assert drawn(report) == drawn(replace(report, title="another")) == tuple(sorted(drawn(report)))
    changed = []
    for row in range(12):
        digits = list(inputs.measured["e"])
        digits[row] = replace(digits[row], text="0.5")
        changed.append(sample.part(inputs.with_numbers({"e": tuple(digits)}), values, MOST).only.tests)
    assert len({drawn(report), *changed}) > 6


def test_it_says_of_how_many_cells_they_are(
    report: Report, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    (found,) = stages.judged(report, every=False).engines
    cells = how_large(report.marks.values.sheet, report.marks.values.layouts)
    assert found.findings == ()
    assert (found.of, found.sample) == (cells, f"{len(drawn(report))} of 12 tests")
    assert 0 < found.cells <= MOST
    said = f"{found.cells} of {cells} cells, those of {found.sample}"
    assert said in found.line
    assert said in found.summary
    assert (found.data["cells"], found.data["of"]) == (found.cells, cells)
    folder = write(tmp_path, 12)
    assert main(["build", str(folder), "--to", "html"]) == 0
    assert f"numpy: {said}, judged at 50 digits\n" in capsys.readouterr().out
    page = (folder / "out" / "report.html").read_text()
    assert said in page
    assert f"every cell of {found.sample}, drawn by what was measured" in page
    assert main(["check", str(folder), "--format", "json"]) == 0
    engines = {each["engine"]: each for each in json.loads(capsys.readouterr().out)["engines"]}
    assert {each["of"] for each in engines.values() if not each["missing"]} == {cells}


def test_nobody_looks_for_what_is_odd_in_them(report: Report, monkeypatch: pytest.MonkeyPatch) -> None:
    """That was told of the whole campaign already, and takes longer than to compare."""
    asked: list[str] = []
    monkeypatch.setattr(
        "loopsheet.report.judge.oddities.oddities", lambda own, _: asked.append(own.title) or ()
    )
    stages.judged(report, every=False)
    assert not asked
    stages.evaluated(Prepared(report.inputs, report.sheet), report.algebra, stages.silent)
    assert asked == [report.title]


def test_the_numbers_that_are_written_are_judged(report: Report) -> None:
    """Not those that the same program would have found in a smaller campaign."""
    values = report.marks.values
    wrong = values.value["alpha"] * (1 + 1e-9)
    marks = replace(report.marks, values=replace(values, value={**values.value, "alpha": wrong}))
    (found,) = stages.judged(replace(report, marks=marks), every=False).engines
    assert found.findings
    assert all(said.startswith("alpha[") or "more cells differ" in said for said in found.findings)
