"""The JavaScript engine: what it prints, and that node computes what NumPy and 50 digits compute."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sympy import Max, Piecewise, Sum, Symbol, exp, log, pi, sqrt

from loopsheet.derivations.equation import Equation
from loopsheet.derivations.reductions import Median
from loopsheet.report.cells.values import Status
from loopsheet.report.engines import javascript
from loopsheet.report.engines.javascript import RUNTIME, JavaScriptPrinter
from loopsheet.report.engines.numpy import Program, evaluate
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.sheet import Axis, Column, Formula, Given, PairAxis, RepeatAxis, Sheet
from loopsheet.report.study import Study
from loopsheet.report.workbooks.soft_impact import WORKBOOK

EPS = float(np.finfo(float).eps)
x, y = Symbol("x", positive=True), Symbol("y", positive=True)

CASES = """
const text = require("fs").readFileSync(0, "utf8");
const [labels, cases] = JSON.parse(text, (key, value) => (value === "missing" ? NaN : value));
for (const [tests, data] of cases) {
  const found = evaluateSheet(program, { tests }, data);
  const out = {};
  for (const name of Object.keys(found.value)) {
    const value = Array.from(found.value[name], (v) => (Number.isNaN(v) ? null : v));
    out[name] = [value, Array.from(found.status[name])];
  }
  console.log(JSON.stringify({ out, roots: found.roots, counted: found.counted, broken: found.broken }));
}
"""


@pytest.fixture(scope="module")
def sheet() -> Sheet:
    return WORKBOOK.sheet(frozenset({"ball_mass"}))


@pytest.fixture(scope="module")
def node(
    require: Callable[..., str], sheet: Sheet, tmp_path_factory: pytest.TempPathFactory
) -> Callable[[list[Any]], list[Any]]:
    """Evaluate campaigns in node, all in one process."""
    program = require("node")
    script = tmp_path_factory.mktemp("js") / "sheet.js"
    source = RUNTIME.read_text(encoding="utf-8")
    script.write_text(f"{source}\nconst program = {javascript.program(sheet)};\n{CASES}", encoding="utf-8")

    def run(cases: list[Any]) -> list[Any]:
        text = json.dumps([None, cases]).replace("NaN", '"missing"')
        done = subprocess.run([program, str(script)], input=text, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return [json.loads(line) for line in done.stdout.splitlines()]

    return run


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


def test_the_program_is_the_same_text_every_time(sheet: Sheet) -> None:
    again = WORKBOOK.sheet(frozenset({"ball_mass"}))
    assert javascript.program(sheet) == javascript.program(again)


def campaigns(count: int, seed: int) -> list[Any]:
    """Campaigns of 2 to 12 tests from the model, disturbed: some pairs have no root, or two."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        size = int(rng.integers(2, 13))
        alpha, beta = rng.uniform(1, 1.5), rng.choice([1.25, 1.5, 2.0])
        v = np.sort(rng.uniform(0.5, 8, size))
        e = np.sort(rng.uniform(0.05, 0.7, size))[::-1] * rng.uniform(1 - 0.2 * (rng.random() < 0.3), 1, size)
        power, ratio = alpha + 1, (beta + 1) / (alpha + 1)
        x_m = 3e-5 * v ** (2 / power)
        noise = 1 + rng.choice([0, 0.001, 0.03]) * rng.standard_normal(size)
        x_p = x_m * (1 - ratio * e**2) * noise
        if rng.random() < 0.2:
            e[rng.integers(size)] = 0.95
        if rng.random() < 0.1:  # an exponent of 190
            v[1], e[1], x_p[1] = 1.1 * v[0], e[0], 1.001 * x_p[0]
        if rng.random() < 0.1:
            v[rng.integers(size)] = np.nan
        data = {"v": v.tolist(), "e": e.tolist(), "x_p": x_p.tolist(), "beta": [float(beta)]}
        data |= {"ball_mass": [0.008], "points_per_pair": [10]}
        found.append([list(range(1, size + 1)), data])
    return found


def test_hundreds_of_campaigns_as_numpy_has_them(
    node: Callable[[list[Any]], list[Any]], sheet: Sheet
) -> None:
    """Statuses are the same in place and code; exponents agree to a few roundings times their condition."""
    program = Program.of(sheet)
    cases = campaigns(250, 20)
    seen = set()
    for (tests, data), theirs in zip(cases, node(cases), strict=True):
        ours = evaluate(sheet, {"tests": tests}, data, program)
        for column in sheet.order:
            codes = theirs["out"][column.name][1]
            assert codes == ours.status[column.name].tolist(), (column.name, data)
            seen |= set(codes)
        assert theirs["counted"] == {c: dict(n) for c, n in ours.counted.items()}
        _same_exponents(sheet, tests, data, program, theirs["out"]["alpha"][0])
    assert seen == set(Status) - {Status.UNDECIDED}


def _same_exponents(sheet: Sheet, tests: list[int], data: Any, program: Program, theirs: list[Any]) -> None:
    """Both engines within 8 eps x condition; the condition measured by moving each input a little."""
    labels = {"tests": tests}
    step = 2.0**-26
    base = evaluate(sheet, labels, data, program).value["alpha"]
    batch: dict[str, Any] = {}
    for place, name in enumerate(("v", "e", "x_p")):
        batch[name] = np.tile(data[name], (3 * len(tests), 1))
        for row in range(len(tests)):
            batch[name][place * len(tests) + row, row] *= 1 + step
    moved = evaluate(sheet, labels, {**data, **batch}, program).value["alpha"]
    condition = np.abs(np.nan_to_num(moved - base)).sum(axis=0) / step
    other = np.array([np.nan if v is None else v for v in theirs])
    bound = 8 * EPS * np.maximum(np.maximum(1, np.abs(base)), condition)
    assert (np.isnan(base) == np.isnan(other)).all()
    assert (np.abs(base - other)[~np.isnan(base)] <= bound[~np.isnan(base)]).all()


def test_the_paper_in_node(node: Callable[[list[Any]], list[Any]], tmp_path: Path) -> None:
    prepared = Study(PAPER).prepared
    data = {n: v if isinstance(v, list) else [v] for n, v in prepared.data.items()}
    data["ball_mass"] = [float(evaluate(prepared.sheet, prepared.labels, prepared.data).scalar("ball_mass"))]
    (found,) = node([[[1, 2, 3, 4, 5], data]])
    report = evaluate(prepared.sheet, prepared.labels, prepared.data)
    for name in (
        "alpha",
        "x_m1",
        "C",
        "alpha_mean",
        "alpha_log",
        "C_log",
        "alpha_lin",
        "C_lin",
        "x_m",
        "Cprime_eq7",
    ):
        mine, theirs = report.value[name], np.array(found["out"][name][0])
        assert np.abs(mine - theirs).max() <= 1e-13 * np.abs(mine).max(), name


# --- a sheet of no model: labels, nested sums, conditions -------------------------------------------------


def whole(name: str) -> Symbol:
    return Symbol(name, integer=True, positive=True)


k, i, j, p, q, s, n, n_pairs, n_points = (
    whole(name) for name in ("k", "i", "j", "p", "q", "s", "n", "n_pairs", "n_points")
)
ROWS = Axis("rows", k, n)
PAIRS = PairAxis("pairs", p, n_pairs, of=ROWS, first=i, second=j)
POINTS = RepeatAxis("points", q, n_points, of=PAIRS, step=s, count="count")
a, count, gap = Column("a", ROWS, Given()), Column("count", None, Given()), Column("gap", PAIRS, Given())


def formula(name: str, expression: Any, axis: Axis | None = None, **more: Any) -> Column:
    equation = Equation("(1)", (Symbol(name), expression), "")
    return Column(name, axis, Formula(equation), positive=False, **more)


TOY = Sheet(
    (
        a,
        count,
        formula("gap", a[j] - a[i], PAIRS, requires=((a[j] > a[i], "rises"), (a[j] < a[i] + 5, "not far"))),
        formula("place", gap[p] * s, POINTS),
        formula("twice", Sum(2 * a[k], (k, 1, n)) - Sum(a[k], (k, 1, n))),
        formula("nested", Sum(a[k] * Sum(gap[p] ** 2, (p, 1, n_pairs)), (k, 1, n))),
        formula("powers", Sum(Symbol("count", positive=True) ** (2 * a[k]), (k, 1, n))),
        formula("middle", Median(gap[p], (p, 1, n_pairs)) * Median(a[j], (q, 1, n_points))),
        formula("none", Sum(gap[p], (p, 1, n_pairs)) + 1),
    )
)

TOY_CASES = """
const found = JSON.parse(require("fs").readFileSync(0, "utf8")).map(([rows, data]) => {
  const { value, status, broken, counted, layouts } = evaluateSheet(program, { rows }, data), labels = {};
  for (const name in layouts) labels[name] = layouts[name].labels;
  for (const name in value) [value[name], status[name]] = [Array.from(value[name]), Array.from(status[name])];
  return { value, status, broken, counted, labels };
});
console.log(JSON.stringify(found));
"""


def test_a_sheet_of_no_model_in_node(require: Callable[..., str], tmp_path: Path) -> None:
    """Labels, broken conditions, sums in sums and sums over no rows are what NumPy makes of them."""
    cases: list[tuple[list[int], dict[str, list[float]]]] = [
        ([2, 3, 7], {"a": [1.0, 2.0, 4.0], "count": [2]}),
        ([1, 2, 5, 6], {"a": [3.0, 1.0, 9.0, 4.0], "count": [3]}),
        ([4], {"a": [1.5], "count": [2]}),
    ]
    script = tmp_path / "toy.js"
    runtime = RUNTIME.read_text(encoding="utf-8")
    script.write_text(f"{runtime}\nconst program = {javascript.program(TOY)};\n{TOY_CASES}", encoding="utf-8")
    done = subprocess.run(
        [require("node"), str(script)], input=json.dumps(cases), capture_output=True, text=True, check=True
    )
    broken = []
    for (rows, data), theirs in zip(cases, json.loads(done.stdout), strict=True):
        ours = evaluate(TOY, {"rows": rows}, data)
        for column in TOY.order:
            name = column.name
            assert theirs["status"][name] == ours.status[name].tolist(), name
            value = np.array(theirs["value"][name], dtype=float)
            np.testing.assert_allclose(value, ours.value[name], rtol=1e-15, err_msg=name)
        assert theirs["counted"] == ours.counted
        codes = ours.broken["gap"]
        rows_broken = {str(row): int(codes[row]) for row in np.flatnonzero(codes)}
        assert theirs["broken"] == ({"gap": rows_broken} if rows_broken else {})
        broken += list(rows_broken.values())
        for axis, layout in ours.layouts.items():
            assert theirs["labels"][axis] == layout.labels.tolist()
    assert set(broken) == {1, 2}
