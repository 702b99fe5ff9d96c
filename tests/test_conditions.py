"""Bounds of rounding errors: by hand on small sheets, and on the paper against 50-digit differences."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from sympy import Expr, IndexedBase, Integer, Max, Min, Piecewise, Sum, Symbol, floor, log, sqrt

from loopsheet.derivations.equation import Equation, Kind
from loopsheet.derivations.reductions import Greatest, Least, Median
from loopsheet.report.engines import exact
from loopsheet.report.engines.numpy import evaluate
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.judge import bounds as numbers
from loopsheet.report.judge.chain import Chain, SheetDerivatives
from loopsheet.report.judge.sensitivity import NumericSweep
from loopsheet.report.plan import derivatives
from loopsheet.report.prepared import Prepared
from loopsheet.report.sheet import Axis, Column, Formula, Given, Root, Sheet
from loopsheet.report.study import Study

k, n = Symbol("k", integer=True, positive=True), Symbol("n", integer=True, positive=True)
ROWS = Axis("rows", k, n)
a, b = (Column(name, None, Given()) for name in "ab")
x = Column("x", ROWS, Given())
u = Symbol("u", positive=True)


def formula(name: str, value: Expr, axis: Axis | None = None) -> Column:
    return Column(
        name, axis, Formula(Equation("", (Symbol(name), value), "", Kind.DEFINITION)), positive=False
    )


def root(
    name: str, form: Expr, value: Expr, low: float = 0.01, high: float = 10.0, unknown: Symbol = u
) -> Column:
    equation = Equation("", (form, Integer(0)), "", Kind.DEFINITION)
    start = (low + high) / 2
    rule = Root(
        equation, equation, unknown, value, Integer(0) + low, Integer(0) + high, Integer(0) + start, steps=8
    )
    return Column(name, None, rule, positive=False)


def bounded(*columns: Column, **data: Any) -> dict[str, Any]:
    sheet = Sheet((a, b, x, *columns))
    data = {"a": 3.0, "b": 2.0, "x": [1.0, 2.0, 5.0], **data}
    values = evaluate(sheet, {"rows": [1, 2, 3]}, data)
    return {"value": values.value, **numbers.RoundingBounds(sheet, values.layouts, values.value)}


A, B = a.symbol, b.symbol


@pytest.mark.parametrize(
    ("value", "bound"),
    [
        (A * B, 6 + 2 * 3 + 3 * 2),
        (A / B, 1.5 + 3 / 2 + 3 / 4 * 2),
        (A - B, (3 + 2) + 3 + 2),
        (-A, 3),
        (log(A), np.log(3) + 1),
        (A**B, 9 + 6 * 3 + 9 * np.log(3) * 2),
        (sqrt(A - B), 1 + 5 / 2 + (3 + 2) / 2),
        (Max(A, B), 3),
        (A * Max(0, A - B), 3 + 3 * (3 + 2) + (1 + 3) * 3 + 3 * 2),
        (A * Max(0, B - A), 0),
        (Min(A, B), 2),
        (abs(A - B), (3 + 2) + 3 + 2),
        (abs(B - A), (3 + 2) + 3 + 2),
        (Piecewise((A * B, A < B), (A + B, True)), 5 + 5),
        (A * B / A, 2),
    ],
)
def test_one_formula(value: Expr, bound: float) -> None:
    assert bounded(formula("c", value))["c"] == pytest.approx([bound])


def test_a_difference_that_cancels() -> None:
    found = bounded(formula("c", A - B), a=1.0 + 1e-9, b=1.0)
    assert found["c"] / found["value"]["c"] == pytest.approx([4e9], rel=1e-6)


def test_what_cancels_between_two_cells_cancels() -> None:
    """d = a b, c = d / a: the error of a goes both ways and is lost, that of the operations stays."""
    d = formula("d", A * B)
    found = bounded(d, formula("c", d.symbol / A))
    assert found["c"] == pytest.approx([2 + 6 / 3 + 3 * 2 / 3])


@pytest.mark.parametrize("of_a_cell", [True, False])
def test_the_square_of_what_is_nothing_but_rounding(of_a_cell: bool) -> None:
    """It has no slope at 0; as far as rounding goes, 8 eps times the bound of the difference, it has."""
    d = formula("d", A - B)
    sheet = Sheet((a, b, d, formula("c", (d.symbol if of_a_cell else A - B) ** 2)))

    def bounds(one: float, other: float) -> numbers.RoundingBounds:
        values = evaluate(sheet, {}, {"a": one, "b": other})
        return numbers.RoundingBounds(sheet, values.layouts, values.value)

    most = 2 * (8 * numbers.EPS * 4) * 4
    square = (2 * numbers.EPS) ** 2
    assert bounds(1.0, 1.0)["c"] == [0]
    assert (
        square
        <= numbers.LIMIT * numbers.EPS * bounds(1.0, 1.0).allowing("c", 0, square)
        <= 8 * numbers.EPS * most
    )
    assert bounds(1.0, 1.0).allowing("c", 0, 1e-20) <= most
    assert bounds(1.0, 2.0).allowing("c", 0, 1e-20) == bounds(1.0, 2.0)["c"] == pytest.approx(1 + 2 * 6)


def test_what_rests_on_a_root_of_nothing_but_rounding() -> None:
    """The root has no slope at 0, and where it is nothing its square has none either; next to that they have.

    Of readings that are equal: their scatter, its square, the root of that, and again, however often."""
    columns = [a, b, formula("s0", (A - B) ** 2)]
    for n in range(1, 9):
        root = formula(f"r{n}", sqrt(columns[-1].symbol))
        columns += [root, formula(f"s{n}", root.symbol**2)]
    sheet, off = Sheet(tuple(columns)), (2 * numbers.EPS) ** 2
    values = evaluate(sheet, {}, {"a": 1.0, "b": 1.0})
    bounds = numbers.RoundingBounds(sheet, values.layouts, values.value)
    assert bounds["r8"] == [np.inf]
    for n in range(9):
        assert not bounds[f"s{n}"] > 0
        allowed = numbers.LIMIT * numbers.EPS * bounds.allowing(f"s{n}", 0, off)
        assert off <= allowed <= 2.0**20 * off, n


def test_a_row_is_its_own() -> None:
    found = bounded(formula("c", x[k] ** 2 * A, ROWS))
    own = np.array([1.0, 4.0, 25.0])
    assert found["c"] == pytest.approx(own * 3 + own * 3 + 2 * own * 3 + own * 3)


def test_a_sum() -> None:
    terms = Sum(x[k] * A, (k, 1, n))
    assert bounded(formula("c", terms))["c"] == pytest.approx([24 + 24 + 24 + 24])
    # Twice the same datum with the other sign: only what the operations round is left of it.
    less = terms - A * Sum(x[k], (k, 1, n))
    assert bounded(formula("c", less))["c"] == pytest.approx([24 + 24 + 24 + 24 + 24 + 3 * 8])


def test_a_sum_leaves_rows_out() -> None:
    found = bounded(formula("c", Sum(x[k] * A, (k, 1, n)) / n), x=[1.0, None, 5.0])
    assert found["c"] == pytest.approx([(4 * 18 + 18) / 2])
    assert np.isnan(found["x"][1])


@pytest.mark.parametrize(("value", "slope"), [(u, 1.0), (1 / u - 1, -1 / 1.5**2), (u**3 - u, 3 * 1.5**2 - 1)])
def test_a_root(value: Expr, slope: float) -> None:
    """b u = a at u = 1.5: it may be off by what the equation rounds and by both data, over b."""
    found = bounded(root("c", B * u - A, value))
    here = 1.5 + (3 + 3 + 3) / 2 + 3 / 2 + 1.5 * 2 / 2
    own = {0: 0.0, 1: 1 / 1.5 + 1 / 1.5 + 1, 2: 1.5**3 + 1.5**3 + 1.5}[(u, 1 / u - 1, u**3 - u).index(value)]
    assert found["c"] == pytest.approx([own + abs(slope) * here])


def test_a_root_below_zero_that_its_cell_does_not_tell() -> None:
    below = Symbol("below", real=True)
    found = bounded(root("c", B * below + A, below**3 - below, -10.0, -0.01, below))
    assert found["c"] == pytest.approx(bounded(root("c", B * u - A, u**3 - u))["c"])


def test_a_root_of_sums() -> None:
    found = bounded(root("c", Sum(x[k], (k, 1, n)) * u - A, u))
    at, total = 3 / 8, 8.0
    assert found["c"] == pytest.approx([at + (3 + 3 + 3) / total + 3 / total + at / total * (8 + 8)])


def test_what_is_not_known_is_infinite() -> None:
    d = formula("d", sqrt(A - B))
    found = bounded(d, formula("c", d.symbol + 1), formula("e", B + 1), formula("f", floor(A)), a=2.0)
    assert np.isinf([found["d"], found["c"], found["f"]]).all()
    assert found["e"] == pytest.approx([5])


@pytest.mark.parametrize("most", [0, numbers.EXPANDED])
def test_a_large_sheet_has_no_smaller_bounds(monkeypatch: pytest.MonkeyPatch, most: int) -> None:
    """Where rows rest on two scalars; what one does to them is the same in a sheet of any size."""
    monkeypatch.setattr(numbers, "EXPANDED", most)
    mean, more = formula("m", Sum(x[k], (k, 1, n)) / n), formula("d", A + 1)
    one = formula("c", x[k] - mean.symbol, ROWS)
    two = formula("f", x[k] - mean.symbol + more.symbol, ROWS)
    found = bounded(mean, more, one, two)
    exactly = np.array([1.0, 2.0, 5.0])
    m = 8 / 3
    rest = m + 8 / 3  # the quotient and the sum
    apart, alone = exactly + 8 / 3, exactly * 2 / 3 + (8 - exactly) / 3
    assert found["c"] == pytest.approx(exactly + m + rest + alone)
    third = 4 + (4 + 3)  # its size, its own rounding and that of its datum
    assert found["f"] == pytest.approx(exactly + m + rest + third + (apart if most == 0 else alone))


def test_what_is_not_known_beside_a_scalar_is_infinite() -> None:
    """By its own rounding or by the scalar's, and nowhere else."""
    jumps = formula("j", floor(A))
    y = formula("y", sqrt(x[k] - 1), ROWS)  # its slope has no value where it begins
    own = Column("y", ROWS, Given(), positive=False)[k]
    found = bounded(
        jumps,
        y,
        formula("d", A + 1),
        formula("c", own * Symbol("d"), ROWS),
        formula("f", own * Symbol("j"), ROWS),
    )
    assert np.isinf(found["c"]).tolist() == [True, False, False]
    assert np.isinf(found["f"]).all()


def test_a_median_rests_on_the_rows_in_the_middle() -> None:
    """And on those that rounding may exchange with them; on no others, however badly they are known."""
    y = formula("y", Piecewise((x[k] - A, x[k] > 100), (x[k], True)), ROWS)
    middle = formula("c", Median(Column("y", ROWS, Given(), positive=False)[k], (k, 1, n)))
    far = bounded(y, middle, a=1e9, x=[1.0, 2.0, 1e9 + 5])
    assert far["y"][2] == pytest.approx(4e9 + 10)  # the data, and their difference
    assert far["c"] == pytest.approx([2 + 2])  # the datum, and the mean of the two in the middle
    tied = bounded(y, middle, a=1e9, x=[1.0, 2.0, 1e9 + 2])
    assert tied["c"] == pytest.approx([2 + 2 + tied["y"][2]])
    two = formula("d", Median(x[k], (k, 1, n)) ** 2)
    assert bounded(two, x=[2.0, np.nan, 5.0])["d"] == pytest.approx([3.5**2 + 7 * (3.5 + (2 + 5) / 2)])


@pytest.mark.parametrize(("kind", "sign"), [(Greatest, 1), (Least, -1)])
def test_an_extreme_rests_on_the_outermost_row(kind: Any, sign: int) -> None:
    """And on those that rounding may exchange with it; taking it rounds nothing."""
    y = formula("y", sign * Piecewise((x[k] - A, x[k] > 100), (x[k], True)), ROWS)
    outermost = formula("c", kind(Column("y", ROWS, Given(), positive=False)[k], (k, 1, n)))
    far = bounded(y, outermost, a=1e9, x=[9.0, 1.0, 1e9 + 5])
    assert far["c"] == pytest.approx([9])
    near = bounded(y, outermost, a=1e9 + 2**-22, x=[5.0, 1.0, 1e9 + 5])
    assert near["value"]["y"][2] != near["value"]["y"][0] == near["value"]["c"]
    assert near["c"] == pytest.approx([5 + near["y"][2]])
    assert near["y"][2] > 1e9


@pytest.mark.parametrize(
    ("kind", "shares"),
    [
        (Greatest, [[0, 0, 0, 4], [0, 2, 2, 0]]),
        (Least, [[4, 0, 0, 0], [2, 0, 0, 2]]),
        (Median, [[0, 2, 2, 0], [1, 1, 1, 1]]),
    ],
)
def test_rows_of_one_value_share_what_they_do(kind: Any, shares: list[list[float]]) -> None:
    """By hand, in quarters: of all rows, and of three that have a value."""
    sheet = Sheet((x, formula("c", kind(x[k], (k, 1, n)) * 4)))
    given = np.array([[2.0, 5.0, 10.0, 17.0], [2.0, 7.0, 7.0, 2.0], [4.0, np.nan, 4.0, 4.0]])
    values = evaluate(sheet, {"rows": [1, 2, 3, 4]}, {"x": given})
    found = (
        NumericSweep(Chain(SheetDerivatives.of(sheet), values.layouts, {"x": np.arange(4)}), values)
        .go()
        .at([("c", 0)])
    )
    assert found[:, 0] == pytest.approx(np.array([*shares, [4 / 3, 0, 4 / 3, 4 / 3]]))


def test_a_batch_of_sensitivities_has_no_number_where_a_cell_has_no_value() -> None:
    """By hand: a sum leaves out what has no value, and a median rests on its middle alone."""
    y = formula("y", sqrt(x[k] - A), ROWS)
    middle = formula("c", Median(Column("y", ROWS, Given(), positive=False)[k], (k, 1, n)))
    total = formula("t", B * Sum(Column("y", ROWS, Given(), positive=False)[k], (k, 1, n)))
    sheet, given = (
        Sheet((a, b, x, y, middle, total)),
        np.array([[2.0, 5.0, 10.0, 17.0], [0.5, 5.0, 10.0, 2.0]]),
    )
    values = evaluate(sheet, {"rows": [1, 2, 3, 4]}, {"a": 1.0, "b": 3.0, "x": given})
    chain = Chain(SheetDerivatives.of(sheet), values.layouts, {"x": np.arange(4), "b": np.array([4])})
    found = NumericSweep(chain, values).go().at([("y", 0), ("c", 0), ("t", 0)])
    slope = 0.5 / np.sqrt(np.maximum(given - 1, 0.25))
    none = np.full(5, np.nan)
    assert found[0] == pytest.approx(
        np.array(
            [
                [slope[0, 0], 0, 0, 0, 0],
                [0, slope[0, 1] / 2, slope[0, 2] / 2, 0, 0],
                [*3 * slope[0], 1 + 2 + 3 + 4],
            ]
        )
    )
    rest = np.array([[0, slope[1, 1], 0, 0, 0], [0, *3 * slope[1, 1:], 2 + 3 + 1]])
    assert found[1] == pytest.approx(np.vstack([none, rest]), nan_ok=True)


def test_names_that_are_taken_stay_free() -> None:
    taken = formula("c_rounding", A + 1)
    made = derivatives.derivatives(Sheet((a, b, x, taken, formula("c", A * IndexedBase(x.symbol)[k], ROWS))))
    names = [symbol.name for symbol in made.plan.leaves]
    assert {"c_rounding", "c_rounding_"} <= set(names)
    assert len(set(names)) == len(names)


# --- the paper --------------------------------------------------------------------------------------------


def slopes_of(prepared: Prepared, name: str, row: int) -> tuple[dict[Any, float], float]:
    """The derivatives of a cell by every measured datum, by differences at 50 digits; and their sum."""
    step, found, size = Fraction(1, 10**15), {}, 0.0
    for given in ("v", "e", "x_p"):
        for test, value in enumerate(prepared.exact_data[given][:2]):
            ends = []
            for sign in (1, -1):
                data = {c: list(v)[:2] if isinstance(v, list) else v for c, v in prepared.exact_data.items()}
                data[given][test] = value * (1 + sign * step)
                ends.append(exact.evaluate(prepared.sheet, {"tests": [1, 2]}, data).value[name][row])
            found[given, test] = float((ends[0] - ends[1]) / (2 * step))
            size += abs(found[given, test])
    return found, size


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    return Study(PAPER).prepared


GIVEN = ("v", "e", "x_p")


def of_two_tests(prepared: Prepared, name: str, drawn: int = 0) -> Any:
    """The derivatives of a column by what was measured in the first two tests; or of a batch of them."""
    data = {c: np.array(v[:2]) if isinstance(v, list) else v for c, v in prepared.data.items()}
    if drawn:
        share = 1 + 1e-3 * np.random.default_rng(3).random((drawn, 2))
        data |= {given: data[given] * share for given in GIVEN}
    values = evaluate(prepared.sheet, {"tests": [1, 2]}, data)
    sources = {given: np.arange(2) + 2 * n for n, given in enumerate(GIVEN)}
    found = (
        NumericSweep(Chain(SheetDerivatives.of(prepared.sheet), values.layouts, sources), values)
        .go()
        .of(name)
    )
    return found, values


@pytest.mark.parametrize("name", ["alpha", "x_m1", "C", "alpha_log", "C_lin", "alpha_lin", "alpha_median"])
def test_the_paper_against_differences(prepared: Prepared, name: str) -> None:
    (own, values), (known, size) = of_two_tests(prepared, name), slopes_of(prepared, name, 0)
    for (given, test), slope in known.items():
        found = own[0, 2 * GIVEN.index(given) + test] * values.value[given][test]
        assert found == pytest.approx(slope, rel=1e-7, abs=1e-9 * size)


@pytest.mark.parametrize("name", ["alpha", "alpha_mean", "alpha_median", "C_log"])
def test_a_batch_has_the_derivatives_of_each(prepared: Prepared, name: str) -> None:
    found, values = of_two_tests(prepared, name, drawn=3)
    assert found.shape == (3, values.value[name].shape[-1], 6)
    sheet, made, sources = prepared.sheet, SheetDerivatives.of(prepared.sheet), {"v": np.arange(2)}
    for n in range(3):
        data = {c.name: values.value[c.name] for c in sheet.columns if isinstance(c.rule, Given)}
        alone = evaluate(sheet, {"tests": [1, 2]}, {c: v[n] if v.ndim > 1 else v for c, v in data.items()})
        each = NumericSweep(Chain(made, alone.layouts, sources), alone).go().of(name)
        assert each == pytest.approx(found[n, :, :2], rel=1e-12)


def test_a_term_that_is_dropped_is_noticed(prepared: Prepared, monkeypatch: pytest.MonkeyPatch) -> None:
    """A derivative that forgets one of the form's terms: the differences do not fit any more."""
    whole = derivatives.differentiated

    def dropped(expression: Any, symbol: Symbol) -> Expr:
        found = whole(expression, symbol)
        return found.func(*found.args[1:]) if found.is_Add else found

    monkeypatch.setattr(derivatives, "differentiated", dropped)
    with pytest.raises(AssertionError):
        test_the_paper_against_differences(prepared, "alpha")


def test_bounds_of_the_paper(prepared: Prepared) -> None:
    """At least the cell, and at least what the data's own roundings amount to; not a thousand times that."""
    values = evaluate(prepared.sheet, prepared.labels, prepared.data)
    found = numbers.RoundingBounds(prepared.sheet, values.layouts, values.value)
    for column in prepared.sheet.columns:
        assert np.isfinite(found[column.name]).all(), column.name
        assert (found[column.name] >= np.abs(values.value[column.name])).all(), column.name
    _, size = slopes_of(prepared, "alpha", 0)
    assert size <= found["alpha"][0] <= 20 * size
