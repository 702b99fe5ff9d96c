"""The JavaScript engine: what it prints, and that node computes what NumPy and 50 digits compute."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import engine_cases
import numpy as np
import pytest
from sympy import Max, Piecewise, Symbol, exp, log, pi, sqrt

from loopsheet.report.cells.trace import dependents_of, precedents_of
from loopsheet.report.cells.values import Status
from loopsheet.report.engines import javascript
from loopsheet.report.engines.javascript import RUNTIME, JavaScriptPrinter
from loopsheet.report.workbooks.soft_impact import WORKBOOK

x, y = Symbol("x", positive=True), Symbol("y", positive=True)

TOLD = """
const text = require("fs").readFileSync(0, "utf8");
const [labels, data] = JSON.parse(text, (key, value) => (value === null ? NaN : value));
const sheet = evaluateSheet(program, labels, data), axes = {}, cells = {};
const declared = Object.fromEntries(program.columns.map(({ name }) => [name, {}]));
const trace = new Trace(program, declared, sheet);
const rows = (groups) => groups.map(({ name, rows }) => [name, rows]);
for (const name in sheet.layouts) axes[name] = sheet.layouts[name].labels;
for (const { name } of program.columns) {
  cells[name] = Array.from(sheet.value[name], (_, row) => {
    const { name: other, row: its } = trace.culprit(name, row);
    const error = trace.isOk(name, row) ? null : trace.address(other, its);
    return [error, rows(trace.precedents(name, row)), rows(trace.dependents(name, row))];
  });
}
console.log(JSON.stringify({ axes, cells, counted: sheet.counted, broken: sheet.broken }));
"""


@pytest.mark.parametrize(
    ("expression", "printed"),
    [
        (x**2, "(x*x)"),
        (x**3, "(x*x*x)"),
        (x**-1, "1/x"),
        (x**-2, "(1/((x*x)))"),
        (x**y, "Math.pow(x, y)"),
        (sqrt(x), "Math.sqrt(x)"),
        (log(x) + exp(y), "Math.exp(y) + Math.log(x)"),
        (Max(x, y), "Math.max(x, y)"),
        (pi * x, "Math.PI*x"),
        (x / y / 3, "(1/3)*x/y"),
    ],
)
def test_printer(expression: Any, printed: str) -> None:
    assert JavaScriptPrinter().doprint(expression) == printed


def test_piecewise_is_a_choice() -> None:
    assert "?" in JavaScriptPrinter().doprint(Piecewise((x, x > y), (y, True)))


def test_no_name_of_a_model_in_the_runtime() -> None:
    text = RUNTIME.read_text(encoding="utf-8")
    assert not any(word in text for word in ("alpha", "x_p", "Math.pow", "Math.log", "eval(", "Function("))


def test_the_program_is_the_same_text_every_time() -> None:
    sheets = (WORKBOOK.sheet(frozenset({"ball_mass"})) for _ in range(2))
    assert len(set(map(javascript.program, sheets))) == 1


def test_what_the_page_tells_of_cells_is_what_the_terminal_tells(
    require: Callable[..., str], tmp_path: Path
) -> None:
    """Labels, rows left out, broken conditions; what a cell rests on, what on it, where an error began."""
    sheet, ours = engine_cases.SHEET, engine_cases.values()
    script = tmp_path / "cases.js"
    parts = [RUNTIME, RUNTIME.parents[1] / "live" / "trace.js"]
    text = "\n".join(path.read_text(encoding="utf-8") for path in parts)
    script.write_text(f"{text}\nconst program = {javascript.program(sheet)};\n{TOLD}", encoding="utf-8")
    data = {name: np.atleast_1d(own).tolist() for name, own in engine_cases.DATA.items()}
    given = json.dumps([{name: list(rows) for name, rows in engine_cases.LABELS.items()}, data])
    done = subprocess.run(
        [require("node"), str(script)], input=given.replace("NaN", "null"),
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    theirs = json.loads(done.stdout)
    assert theirs["axes"] == {name: layout.labels.tolist() for name, layout in ours.layouts.items()}
    assert theirs["counted"] == ours.counted
    broken = {
        name: {str(r): int(codes[r]) for r in np.flatnonzero(codes)} for name, codes in ours.broken.items()
    }
    assert theirs["broken"] == {name: rows for name, rows in broken.items() if rows}
    for column in sheet.columns:
        for row, (cell, (error, needs, used)) in enumerate(
            zip(ours.cells(column.name), theirs["cells"][column.name], strict=True)
        ):
            began = None if cell.status is Status.OK else (cell.culprit or cell).address
            assert error == began, cell
            for groups, told in ((precedents_of, needs), (dependents_of, used)):
                found = [[group.column.name, list(group.rows)] for group in groups(ours, column, row)]
                assert told == found, (groups.__name__, cell)
