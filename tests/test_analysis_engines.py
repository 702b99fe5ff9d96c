"""Engines against 50 digits: honest ones agree within their condition, every other is named with its cell."""

from __future__ import annotations

import io
import json
import re
import sys
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import engine_cases
import mpmath
import pytest
from helpers import method_folder

from loopsheet.report import stages
from loopsheet.report.cells.grid import Place, checked
from loopsheet.report.cells.values import Status, Values
from loopsheet.report.engines import ENGINES, exact, excel_grid
from loopsheet.report.engines import numpy as engine
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.judge import engines, readers
from loopsheet.report.judge.readers import Book, Case, Reading
from loopsheet.report.prepared import Prepared
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.views import xlsx

CELLS = 2228


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    return Study(PAPER).prepared


@pytest.fixture(scope="module")
def judge(report: Report, prepared: Prepared) -> engines.Judge:
    return engines.Judge.of(prepared.sheet, report.values.layouts, prepared.labels, prepared.exact_data)


@pytest.fixture(scope="module")
def computed(prepared: Prepared) -> Values:
    """What NumPy computes; what is reported has no error."""
    return engine.evaluate(prepared.sheet, prepared.labels, prepared.data)


@pytest.fixture(scope="module")
def book(report: Report) -> Book:
    units = {name: shown.unit for name, shown in report.shown.items()}
    grid = excel_grid.grid(report.sheet, report.values, units, report.workbook.headline)
    return Book(xlsx.render(report, grid), grid)


def honest(agreement: engines.Agreement) -> bool:
    return not agreement.findings and agreement.cells == CELLS and 0 < agreement.units < 2


@pytest.mark.parametrize("name", ENGINES)
def test_an_engine_agrees_with_50_digits_on_the_paper(
    name: str,
    require: Callable[..., str],
    judge: engines.Judge,
    prepared: Prepared,
    computed: Values,
    book: Book,
) -> None:
    asked = Case(prepared.sheet, prepared.labels, prepared.data, computed, book)
    agreement = judge.agreement(engine_cases.found_by(name, asked, require))
    assert honest(agreement), agreement
    assert agreement.unbounded == 0
    assert agreement.line.startswith(f"{name:11} {CELLS} cells, at most 0.")
    program = f", {agreement.program}" if agreement.program else ""
    assert agreement.line.endswith(f" eps x condition ({agreement.units_where}){program}")
    assert json.loads(json.dumps(agreement.data))["eps_condition"] == agreement.units


def test_javascript_in_chromium(
    require: Callable[..., str],
    judge: engines.Judge,
    prepared: Prepared,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    require(*readers._BROWSERS)
    monkeypatch.setattr(readers, "_find", without(readers._find, "node"))
    agreement = judge.agreement(readers.run_javascript(Case(prepared.sheet, prepared.labels, prepared.data)))
    assert honest(agreement), agreement
    assert agreement.program.startswith("Chromium ")


# --- what is wrong is found -------------------------------------------------------------------------------


@pytest.mark.parametrize("engine", ["numpy", "JavaScript", "xlsx"])
def test_a_wrong_value_and_a_wrong_status_are_named(
    report: Report, judge: engines.Judge, engine: str
) -> None:
    found = readers.of_values(report.values)
    value, status = ({name: list(each) for name, each in m.items()} for m in (found.value, found.status))
    assert value["alpha"][3] is not None
    value["alpha"][3] = float(value["alpha"][3]) + 100 * engines.EPS * judge.bounds["alpha"][3]
    status["F"][7] = "#DOMAIN!"
    agreement = judge.agreement(Reading(engine, "", value, status))
    assert len(agreement.findings) == 2
    assert agreement.findings[0].startswith(f"alpha[1-5]: {engine} is off by ")
    assert agreement.findings[1] == f"F[1-2-8]: {engine} says #DOMAIN!, 50 digits say ok"
    assert agreement.units == pytest.approx(100, abs=1)
    assert agreement.units_where == "alpha[1-5]"


EXACTLY = """
from loopsheet import Method, fit, let, measured, unknown

class Line(Method):
    "A line."
    x = measured("mm", "place")
    y = measured("N", "force")
    a = unknown("intercept")
    b = unknown("slope")
    line = fit(y, a + b * x)
    scaled = let(line.residual / line.s, "residual in scatters")
    last = let(max(scaled), "the largest")
"""


def test_an_engine_follows_its_own_rounding(tmp_path: Path) -> None:
    """Of points on a line the residuals in scatters are 0/0, of doubles next to it they are something."""
    rows = "reading,x [mm],y [N]\n1,0,1\n2,1,2\n3,2,3\n"
    prepared = Study(method_folder(tmp_path, EXACTLY, rows)).prepared
    values = engine.evaluate(prepared.sheet, prepared.labels, prepared.data)
    exactly = exact.evaluate(prepared.sheet, prepared.labels, prepared.exact_data)
    assert set(exactly.status["scaled"]) == {Status.DOMAIN}
    assert not values.status["scaled"].any()
    data = prepared.labels, prepared.exact_data
    judge = engines.Judge.of(prepared.sheet, values.layouts, *data)
    found = readers.of_values(values)
    assert not judge.agreement(found).findings
    # What does not follow from it is a fault.
    status = {**found.status, "scaled": ["ok", "#OVERFLOW!", "ok"]}
    (told,) = judge.agreement(replace(found, status=status)).findings
    assert told == "scaled[2]: numpy says #OVERFLOW!, 50 digits say #DOMAIN!"
    assert judge.agreement(replace(found, status={**found.status, "a": ["#NOROOT!"]})).findings


@pytest.mark.parametrize(("units", "believed"), [(7.8, True), (8.2, False)])
def test_eight_units_are_believed_and_no_more(
    report: Report, judge: engines.Judge, units: float, believed: bool
) -> None:
    found = replace(readers.of_values(report.values), engine="node")
    value = {name: list(each) for name, each in found.value.items()}
    true, bound = judge.judged.value["alpha"][7], judge.bounds["alpha"][7]
    value["alpha"][7] = float(true + units * engines.EPS * bound)
    agreement = judge.agreement(replace(found, value=value))
    assert agreement.units == pytest.approx(units, abs=0.15)
    assert (agreement.findings == ()) is believed


def test_steps_that_do_not_settle_are_told_as_such(report: Report, judge: engines.Judge) -> None:
    found = replace(readers.of_values(report.values), engine="xlsx")
    status = {**found.status, "alpha": ["#STEPS!", *found.status["alpha"][1:]]}
    (finding,) = judge.agreement(replace(found, status=status)).findings
    assert finding == (
        "alpha[1-2]: the steps of xlsx to a root do not settle (#STEPS!), 50 digits say ok: take a start "
        "nearer to it, or more steps, root(..., start=..., steps=60)"
    )


def test_many_findings_are_counted(report: Report, judge: engines.Judge) -> None:
    found = readers.of_values(report.values)
    value = {name: [x and x * (1 + 1e-6) for x in each] for name, each in found.value.items()}
    findings = judge.agreement(replace(found, value=value)).findings
    assert len(findings) == engines.MOST_FINDINGS + 1
    assert findings[-1].endswith(" more cells differ")


def test_rows_that_are_missing_are_a_finding(report: Report, judge: engines.Judge) -> None:
    found = readers.of_values(report.values)
    agreement = judge.agreement(replace(found, value={**found.value, "alpha": [1.0]}))
    assert agreement.findings == ("alpha: numpy has 1 rows, not 10",)


def test_what_a_file_has_cut_is_not_held_against_the_engine(report: Report, judge: engines.Judge) -> None:
    found = replace(readers.of_values(report.values), engine="xlsx")
    cut = {name: [float(f"{x:.14e}") for x in each] for name, each in found.value.items()}
    lost = {name: [readers._lost(x) for x in each] for name, each in cut.items()}
    before, after = (judge.agreement(replace(found, value=cut, rounded=each)) for each in ({}, lost))
    assert before.units > 1 > after.units
    assert honest(after)
    cut["alpha"][0] += 1e-11
    assert judge.agreement(replace(found, value=cut, rounded=lost)).findings


# --- programs that are missing or fail --------------------------------------------------------------------


def without(find: Any, *names: str) -> Any:
    return lambda *wanted: find(*(name for name in wanted if name not in names))


def test_a_missing_program_is_told_and_is_no_finding(
    monkeypatch: pytest.MonkeyPatch,
    judge: engines.Judge,
    computed: Values,
    prepared: Prepared,
    book: Book,
) -> None:
    monkeypatch.setattr(readers, "_find", lambda *names: None)
    found = engines.compare_all(judge, Case(prepared.sheet, prepared.labels, prepared.data, computed, book))
    assert [agreement.line for agreement in found[1:]] == [
        "JavaScript  node or Chromium not found",
        "xlsx        LibreOffice not found",
    ]
    assert not any(agreement.findings for agreement in found)
    assert honest(found[0])


@pytest.mark.parametrize(
    ("script", "said"),
    [
        ("raise SystemExit('no memory')", "ended with code 1: no memory"),
        ("import time; time.sleep(60)", "took more than 1 s"),
        ("print('{}')", "its answer cannot be read"),
        ("", "its answer cannot be read"),
    ],
)
def test_a_program_that_fails_is_a_finding(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    judge: engines.Judge,
    prepared: Prepared,
    script: str,
    said: str,
) -> None:
    program = tmp_path / "node"
    program.write_text(f"#!{sys.executable}\n{script}\n")
    program.chmod(0o755)
    if "sleep" in script:  # the others may take their time to start
        monkeypatch.setattr(readers, "SCRIPT_SECONDS", 1)
    monkeypatch.setattr(readers, "_version", lambda path, name: f"{name} 1.0")
    monkeypatch.setattr(readers, "_find", lambda *names: ("node", str(program)))
    agreement = judge.agreement(readers.run_javascript(Case(prepared.sheet, prepared.labels, prepared.data)))
    (finding,) = agreement.findings
    assert finding.startswith(f"JavaScript (node 1.0) failed: {said}")
    assert agreement.line == "JavaScript  failed, node 1.0"


def test_an_office_that_makes_no_file_is_a_finding(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, prepared: Prepared, book: Book
) -> None:
    program = tmp_path / "soffice"
    program.write_text(f"#!{sys.executable}\n")
    program.chmod(0o755)
    monkeypatch.setattr(readers, "_find", lambda *names: ("soffice", str(program)))
    assert readers.run_workbook(Case(prepared.sheet, {}, {}, book=book)).failure == "made no file"


def test_a_budget_that_comes_out_otherwise_is_a_finding(require: Callable[..., str]) -> None:
    """Sensitivities are no cells of the sheet: what is made of them has to be as it was issued."""
    require("soffice", "libreoffice")
    report = Study(PAPER.parent / "gum_h1").computed
    grid, content = stages.book(report)
    wrong = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(wrong, "w") as new:
        for name in old.namelist():
            new.writestr(name, re.sub(rb",D(\d+)\*G\1,", rb",2*D\1*G\1,", old.read(name), count=1))
    right, other = (
        readers.run_workbook(Case(report.sheet, {}, {}, book=Book(each, grid)))
        for each in (content, wrong.getvalue())
    )
    assert right is not None
    assert other is not None
    assert (right.failure, right.beside) == ("", ())
    assert {said.partition(" in ")[2].partition(",")[0][:13] for said in other.beside} == {
        "uncertainty!B",
        "uncertainty!H",
        "uncertainty!I",
    }


# --- files ------------------------------------------------------------------------------------------------


def test_a_delivered_workbook_is_read_as_it_is_stored(report: Report, book: Book) -> None:
    cells = readers.read_cells(book.content)
    value, status, _ = readers._columns(report.sheet, book.grid, cells)
    assert float(value["alpha"][0] or 0) == report.values.value["alpha"][0]
    assert set(status["alpha"]) == {"ok"}
    bare = readers.read_cells(readers.without_results(book.content))
    value, status, _ = readers._columns(report.sheet, book.grid, bare)
    assert set(status["alpha"]) == {"nothing"} == set(status["v"]), "what is typed is checked by a formula"


def test_what_is_given_is_what_its_check_says(report: Report, book: Book) -> None:
    cells: dict[str, dict[str, float | str]] = {
        name: dict(each) for name, each in readers.read_cells(book.content).items()
    }
    place: Place = book.grid[checked("v")].place
    first, second = (place.cell(row, place.worksheet).replace("$", "") for row in range(2))
    cells[place.worksheet][first] = "#INPUT!"
    del cells[place.worksheet][second]
    _, status, _ = readers._columns(report.sheet, book.grid, cells)
    assert status["v"][:3] == ["#INPUT!", "nothing", "ok"]


def test_digits_of_the_caller_do_not_matter(report: Report, judge: engines.Judge) -> None:
    with mpmath.workdps(15):
        few = judge.agreement(readers.of_values(report.values))
    with mpmath.workdps(exact.DIGITS):
        assert few == judge.agreement(readers.of_values(report.values))
