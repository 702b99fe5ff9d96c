"""The sheet: what it refuses, in these words, and the graph and order that it reads from the algebra."""

import os
import subprocess
import sys
from dataclasses import replace

import pytest
from helpers import whole
from sympy import Expr, IndexedBase, Rel, Sum, Symbol

from loopsheet.derivations.equation import Equation, Ledger
from loopsheet.derivations.reductions import Greatest, Least, Median
from loopsheet.report.quantity import Bounds
from loopsheet.report.sheet import (
    Axis,
    Column,
    CycleError,
    Formula,
    Given,
    PairAxis,
    Reference,
    RepeatAxis,
    Root,
    Sheet,
    SheetError,
)
from loopsheet.report.workbook import Measured, Parameter, Workbook

k, i, j, p, q, s = (whole(name) for name in "kijpqs")
n, n_pairs, n_points = whole("n"), whole("n_pairs"), whole("n_points")
ROWS = Axis("rows", k, n)
PAIRS = PairAxis("pairs", p, n_pairs, of=ROWS, first=i, second=j)
POINTS = RepeatAxis("points", q, n_points, of=PAIRS, step=s, count="count")


def given(name: str, axis: Axis | None = None) -> Column:
    return Column(name, axis, Given())


def formula(
    name: str, expression: Expr, axis: Axis | None = None, requires: tuple[tuple[Rel, str], ...] = ()
) -> Column:
    equation = Equation("(T)", (Symbol(name, positive=True), expression), "for this test")
    return Column(name, axis, Formula(equation), requires=requires)


def root(name: str, expression: Expr, unknown: Symbol, axis: Axis | None = None) -> Column:
    equation = Equation("(T)", (expression, 0 * unknown), "for this test")
    low, high = Symbol("low", positive=True), Symbol("high", positive=True)
    return Column(name, axis, Root(equation, equation, unknown, unknown, low, high, low))


a, b, count = given("a", ROWS), given("b"), given("count")
mean = formula("mean", Sum(a[k], (k, 1, n)) / n)
step = formula("step", a[j] - a[i], PAIRS)
ramp = formula("ramp", step[p] * s / count.symbol, POINTS)
excess = formula("excess", step[p] - Sum(step[p], (p, 1, n_pairs)) / n_pairs, PAIRS)
SHEET = Sheet((ramp, excess, step, mean, a, b, count))


# ------------------------------------------------------------------------------------------ graph
def names(columns: tuple[Column, ...]) -> list[str]:
    return [column.name for column in columns]


def test_precedents_come_first_and_ties_break_by_declaration() -> None:
    assert names(SHEET.order) == ["a", "step", "count", "ramp", "excess", "mean", "b"]


def test_the_graph_is_read_from_the_algebra() -> None:
    assert names(SHEET.precedents(ramp)) == ["step", "count"]
    assert names(SHEET.dependents(a)) == ["step", "mean"]
    assert names(SHEET.dependents(step)) == ["ramp", "excess"]
    assert names(SHEET.ancestors(ramp)) == ["a", "step", "count"]
    assert SHEET.ancestors(a) == () == SHEET.dependents(b)
    assert SHEET.summed_axes(mean) == (ROWS,)
    assert SHEET.axes == (ROWS, PAIRS, POINTS)


def test_a_rows_own_cell_and_the_summed_one_are_two_references() -> None:
    assert SHEET.named(excess) == (Reference(step[p]), Reference(step[p], PAIRS))
    assert {each.cell for each in SHEET.named(excess)} == {step[p]}
    assert SHEET.named(step) == (Reference(a[i]), Reference(a[j]))


def test_an_axis_that_is_repeated_rests_on_its_count() -> None:
    total = formula("total", Sum(ramp[q], (q, 1, n_points)))
    sheet = Sheet((*SHEET.columns, total))
    assert names(sheet.precedents(total)) == ["ramp", "count"]


def test_an_unknown_is_no_precedent() -> None:
    u = Symbol("u", positive=True)
    sheet = Sheet((given("low"), given("high"), b, root("r", b.symbol - u, u)))
    assert names(sheet.precedents(sheet["r"])) == ["low", "high", "b"]


PROGRAM = """\
from loopsheet.report.workbooks.soft_impact import sheet
from loopsheet.report.engines.numpy_texts import program_texts
from loopsheet.report.plan.lowering import lowered
found = sheet(frozenset({'ball_diameter', 'ball_density', 'target_mass'}))
print([(c.name, found.named(c)) for c in found.order])
print(program_texts(found, lowered(found)))
"""
CELLS = """\
from loopsheet.report.engines import excel_grid
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.study import Study
r = Study(PAPER).computed
units = {n: s.unit for n, s in r.shown.items()}
print(excel_grid.grid(r.sheet, r.values, units, r.workbook.headline).blocks)
"""


@pytest.mark.usefixtures("anew")
def test_the_order_is_the_same_under_every_hash_seed() -> None:
    outputs = {
        subprocess.run(
            [sys.executable, "-c", PROGRAM + CELLS],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("0", "4242")
    }
    (output,) = outputs
    assert "def kernel" in output
    assert "name='alpha_mean'" in output


# ----------------------------------------------------------------------------------------- cycles
def test_a_cycle_is_shown_as_the_path_that_closes_it() -> None:
    x, y, z = (Symbol(name, positive=True) for name in "xyz")
    columns = (formula("w", x), formula("x", y), formula("y", z + 1), formula("z", x**2))
    with pytest.raises(
        CycleError, match=r"^columns depend on one another in a circle: x -> y -> z -> x$"
    ) as error:
        Sheet(columns)
    assert error.value.path == ("x", "y", "z", "x")


def test_a_column_that_names_itself_is_a_cycle() -> None:
    x = Column("x", ROWS, Given())
    with pytest.raises(CycleError, match=r"circle: x -> x$"):
        Sheet((formula("x", x[k] + 1, ROWS),))


def test_a_condition_can_close_a_cycle_too() -> None:
    x, y = Symbol("x", positive=True), Symbol("y", positive=True)
    with pytest.raises(CycleError, match=r"circle: x -> y -> x$"):
        Sheet((formula("x", b.symbol, requires=((y > 1, "y is small"),)), formula("y", x), b))


# --------------------------------------------------------------------------------------- refusals
unknown_size = whole("n_rows")
REFUSED: dict[str, tuple[tuple[Column, ...], str]] = {
    "two rules": ((b, given("b")), "the column 'b' has two rules; a name has exactly one"),
    "no column": (
        (a, formula("f", Symbol("velocity", positive=True))),
        "f: no column is called 'velocity'",
    ),
    "near name": (
        (given("velocity"), formula("f", Symbol("velocty"))),
        "f: no column is called 'velocty'; did you mean 'velocity'?",
    ),
    "near indexed name": (
        (given("x_p", ROWS), formula("f", IndexedBase("x_m")[k], ROWS)),
        "f: no column is called 'x_m'; did you mean 'x_p'?",
    ),
    "no index": ((a, formula("f", a.symbol)), "f: a has one value for each of rows; say which"),
    "index of another axis": (
        (a, formula("f", a[k], PAIRS)),
        "f: a[k] names a row of nothing: a is on rows; indices here: p (pairs), i (rows), j (rows)",
    ),
    "index of no axis": (
        (a, formula("f", a[k])),
        "f: a[k] names a row of nothing: a is on rows; indices here: none",
    ),
    "scalar with an index": (
        (a, b, formula("f", b[k], ROWS)),
        "f: b[k] names a row of nothing: b is a scalar; indices here: k (rows)",
    ),
    "two indices": (
        (a, formula("f", a[k, k], ROWS)),
        "f: a[k, k] names a row of nothing: a is on rows; indices here: k (rows)",
    ),
    "a number as index": (
        (a, formula("f", a[1], ROWS)),
        "f: a[1] names a row of nothing: a is on rows; indices here: k (rows)",
    ),
    "sum over no axis": (
        (a, formula("f", Sum(b.symbol, (i, 1, n))), b),
        "f: a sum runs over all rows of one index set ((k, 1, n)), not over (i, 1, n)",
    ),
    "sum to another end": (
        (a, formula("f", Sum(a[k], (k, 1, unknown_size)))),
        "f: a sum runs over all rows of one index set ((k, 1, n)), not over (k, 1, n_rows)",
    ),
    "sum from another start": (
        (a, formula("f", Sum(a[k], (k, 2, n)))),
        "f: a sum runs over all rows of one index set ((k, 1, n)), not over (k, 2, n)",
    ),
    "sum over two": (
        (a, formula("f", Sum(a[k], (k, 1, n), (k, 1, n)))),
        "f: a sum runs over all rows of one index set ((k, 1, n)), not over (k, 1, n), (k, 1, n)",
    ),
    "inner sum that names the outer row": (
        (a, step, formula("f", Sum(Sum(step[p] * a[k], (p, 1, n_pairs)), (k, 1, n)))),
        "f: a sum runs over all rows of one index set ((k, 1, n), (p, 1, n_pairs)), "
        "not over (p, 1, n_pairs), (k, 1, n)",
    ),
    "median from another start": (
        (a, formula("f", Median(a[k], (k, 2, n)))),
        "f: a sum runs over all rows of one index set ((k, 1, n)), not over (k, 2, n)",
    ),
    "median of an expression": (
        (a, formula("f", Median(2 * a[k], (k, 1, n)))),
        "f: a median is of the cells of a column, not of 2*a[k]; give that a column of its own",
    ),
    "greatest of an expression": (
        (a, formula("f", Greatest(2 * a[k], (k, 1, n)))),
        "f: a max is of the cells of a column, not of 2*a[k]; give that a column of its own",
    ),
    "least in a root": (
        (a, root("f", b.symbol - Least(a[k], (k, 1, n)), b.symbol)),
        "f: a min in a root has to be a column of its own",
    ),
    "median in a root": (
        (a, root("f", b.symbol - Median(a[k], (k, 1, n)), b.symbol)),
        "f: a median in a root has to be a column of its own",
    ),
    "running number of another axis": (
        (a, step, ramp, count, formula("f", step[p] * s, PAIRS)),
        "f: no column is called 's'",
    ),
    "index as a value": ((a, formula("f", a[k] * k, ROWS)), "f: no column is called 'k'"),
    "no name": ((given("a b"),), "'a b' cannot be a column's name: letters, digits and _ make a name"),
    "no name of rows": (
        (given("a", Axis("what I saw", k, n)),),
        "'what I saw' cannot be an index set's name: letters, digits and _ make a name",
    ),
    "a word of Python": (
        (given("lambda"),),
        "'lambda' cannot be a column's name: letters, digits and _ make a name",
    ),
    "named as an index": (
        (a, given("k")),
        "the column 'k' is called as the index of rows is; rename one",
    ),
    "unknown named as a column": (
        (given("low"), given("high"), b, root("r", b.symbol, b.symbol)),
        "r: its unknown 'b' is called as something else of the sheet is",
    ),
    "no count": (
        (a, step, ramp),
        "points: 'count' must be a given scalar; it says how many rows there are",
    ),
    "a computed count": (
        (a, b, step, ramp, formula("count", b.symbol)),
        "points: 'count' must be a given scalar; it says how many rows there are",
    ),
    "one name for two axes": (
        (a, given("c", Axis("rows", whole("l"), whole("m")))),
        "two different index sets are called 'rows'",
    ),
    "alongside what is not summed": (
        (a, step, replace(mean, alongside=(step,))),
        "mean: its sums run over no rows of step, which they shall look at",
    ),
    "one symbol for two axes": (
        (a, given("c", Axis("others", k, whole("m")))),
        "the symbol 'k' is the index of rows and the index of others",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_no_sheet_is_refused_in_these_words(case: str) -> None:
    columns, message = REFUSED[case]
    with pytest.raises(SheetError) as error:
        Sheet(columns)
    assert str(error.value) == message


def test_a_sum_within_a_sum_is_a_sheet() -> None:
    nested = formula("f", Sum(a[k] * Sum(step[p], (p, 1, n_pairs)), (k, 1, n)))
    sheet = Sheet((a, step, nested))
    assert sheet.named(nested) == (Reference(a[k], ROWS), Reference(step[p], PAIRS))
    assert sheet.summed_axes(nested) == (ROWS, PAIRS)


def test_what_a_sum_looks_at_is_named_though_no_formula_has_it() -> None:
    other = formula("other", a[k] - 1, ROWS)
    beside = replace(mean, alongside=(other,))
    sheet = Sheet((a, beside, other))
    assert sheet.named(beside) == (Reference(a[k], ROWS), Reference(other[k], ROWS))
    assert [column.name for column in sheet.order] == ["a", "other", "mean"]
    assert beside.content != mean.content


def test_columns_are_found_by_name() -> None:
    assert SHEET["a"] is a
    assert "a" in SHEET
    assert "alpha" not in SHEET
    assert (a.source, mean.source, a.equation) == ("given", "(T)", None)
    assert a.cell == a[k]
    assert mean.cell == mean.symbol


# ------------------------------------------------------------------------------------------ what may be given
def test_what_is_given_is_bound_as_the_workbook_declares() -> None:
    allowed = Bounds(low=0, low_open=True)
    workbook = Workbook(
        "made", "made", "nobody", lambda: Ledger(()), (Measured("a", "1", "a datum", allowed),),
        (Parameter("b", "1", "a scalar", Bounds(high=2)),), lambda given: SHEET,
    )  # fmt: skip
    sheet = workbook.sheet(frozenset())
    assert sheet.bounds == {"a": allowed, "b": Bounds(high=2), "count": Bounds(low=1, integer=True)}
    assert sheet.order[0].rule == Given("given", allowed)
    assert {name: str(relation) for name, (_, relation) in sheet.guards.items()} == {
        "a": "a > 0",
        "b": "b <= 2",
        "count": "(count >= 1) & Eq(count, floor(count))",
    }


@pytest.mark.parametrize(
    ("declared", "found"),
    [
        (Bounds(), Bounds(1, integer=True)),
        (Bounds(0, 9, low_open=True), Bounds(1, 9, integer=True)),
        (Bounds(1, low_open=True), Bounds(1, low_open=True, integer=True)),
        (Bounds(2, 50), Bounds(2, 50, integer=True)),
    ],
)
def test_a_count_is_a_whole_number_of_at_least_one(declared: Bounds, found: Bounds) -> None:
    assert SHEET.bounded({"count": declared}).bounds["count"] == found
