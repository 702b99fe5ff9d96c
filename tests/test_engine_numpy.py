"""The NumPy engine: what it prints, scopes of sums, batches, and what it refuses."""

import gc
import sys
import tracemalloc
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from helpers import formula, whole
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import (
    And,
    Expr,
    Function,
    Integer,
    Max,
    Min,
    Ne,
    Or,
    Piecewise,
    Rational,
    Sum,
    Symbol,
    exp,
    log,
    oo,
    pi,
    sqrt,
)
from uncertain_data import uncertain

from loopsheet.derivations.equation import Equation
from loopsheet.derivations.reductions import Greatest, Least, Median
from loopsheet.report.cells.values import Status, Values
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.numpy import Program
from loopsheet.report.engines.numpy_code import ArrayPrinter, kernel
from loopsheet.report.engines.numpy_rows import Kept
from loopsheet.report.engines.numpy_texts import program_texts
from loopsheet.report.plan.lowering import lowered
from loopsheet.report.plan.nodes import RowSum
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet, SheetError
from loopsheet.report.workbooks.soft_impact import sheet as soft_impact

x, y, z = (Symbol(name, positive=True) for name in "xyz")


# ----------------------------------------------------------------------------------------- printing
@pytest.mark.parametrize(
    ("expression", "code"),
    [
        (x**2, "(x*x)"),
        (x**3, "(x*x*x)"),
        ((x + y) ** 3, "numpy.power(x + y, 3)"),
        (x**-1, "(1/x)"),
        (x**-2, "(1/(x*x))"),
        (x / y**2, "x/(y*y)"),
        (x**y, "numpy.power(x, y)"),
        (sqrt(x), "numpy.sqrt(x)"),
        (x * pi / 6, "(1/6)*numpy.pi*x"),
        (exp(x) + log(y), "numpy.exp(x) + numpy.log(y)"),
        (Max(x, y, z), "numpy.maximum(numpy.maximum(x, y), z)"),
        (Min(x, y), "numpy.minimum(x, y)"),
        (Or(Ne(x, y), Ne(y, z)), "numpy.logical_or(numpy.not_equal(x, y), numpy.not_equal(y, z))"),
        (And(x > y, y > z), "numpy.logical_and(numpy.greater(x, y), numpy.greater(y, z))"),
        (Piecewise((x, x > y), (y, True)), "choose(numpy.greater(x, y), lambda: x, lambda: y)"),
        (Piecewise((x, x > y)), "choose(numpy.greater(x, y), lambda: x, lambda: numpy.nan)"),
        (
            Piecewise((x, x > 2), (y, x > 1), (z, True)),
            "choose(numpy.greater(x, 2), lambda: x, "
            "lambda: choose(numpy.greater(x, 1), lambda: y, lambda: z))",
        ),
        (Rational(1, 3) * x, "(1/3)*x"),
        (Integer(2) * oo, "numpy.inf"),
    ],
)
def test_an_expression_is_printed_as(expression: Expr, code: str) -> None:
    assert ArrayPrinter().doprint(expression) == code


def test_a_kernel_is_called_with_its_symbols_in_the_order_of_their_names() -> None:
    found = kernel([x * y, RowSum(x, Symbol("rows")) + y])
    assert found.arguments == ("x", "y")
    assert found.source == "def kernel(x, y, rows_kept):\n    return (x*y, y + rows_kept.total(x),)"
    own, total = found.run(np.array([1.0, 2.0]), 3.0, Kept(np.array([True, True])))
    assert (own.tolist(), total.tolist()) == ([3.0, 6.0], [6.0])


def test_common_parts_are_computed_once() -> None:
    t_0 = Symbol("t_0", positive=True)
    found = kernel([exp(x + y) * t_0, exp(x + y) + 1])
    assert found.source.count("numpy.exp") == 1
    assert found.run(1.0, 0.5, 0.25)[0] == np.exp(0.75) * 1.0


def test_what_numpy_has_no_word_for_is_refused() -> None:
    with pytest.raises(SheetError, match=r"^NumPy cannot compute this: .*unheard"):
        kernel([Function("unheard")(x)])


# ------------------------------------------------------------------------------------------- scopes
k, n = whole("k"), whole("n")
ROWS = Axis("rows", k, n)
a = Column("a", ROWS, Given())


def test_columns_may_be_called_as_the_program_calls_its_own() -> None:
    names = ("numpy", "t_0", "rows_kept", "kernel", "kept_0", "run", "sheet", "a_k", "f_sum_1", "n_of_f")
    scalars = [Column(name, None, Given()) for name in names]
    product = sum((column.symbol for column in scalars), Integer(0))
    sheet = Sheet((a, *scalars, formula("f", (product + a[k]) * (product + Sum(a[k], (k, 1, n))), ROWS)))
    values = engine.evaluate(sheet, {"rows": [1, 2]}, {"a": [1.0, 2.0], **dict.fromkeys(names, 1.0)})
    every = len(names)
    assert values.value["f"].tolist() == [(every + 1) * (every + 3), (every + 2) * (every + 3)]


# ------------------------------------------------------------------------------------------ batches
SHEET = soft_impact(frozenset({"ball_diameter", "ball_density", "target_mass"}))
PROGRAM = Program.of(SHEET)
PAPER = {
    "v": np.array([2.334, 2.940, 4.089, 4.504, 4.993]),
    "e": np.array([0.530, 0.512, 0.479, 0.467, 0.453]),
    "x_p": np.array([23.5, 29.7, 41.6, 45.97, 51.03]) * 1e-6,
}
PARAMETERS = {
    "ball_diameter": 0.0127,
    "ball_density": 7800.0,
    "target_mass": 3.0,
    "beta": 1.5,
    "points_per_pair": 7,
}
TESTS = {"tests": [1, 2, 3, 4, 5]}


def run(data: Mapping[str, Any]) -> Values:
    return engine.evaluate(SHEET, TESTS, uncertain({**PAPER, **PARAMETERS, **data}), PROGRAM)


def noisy(shape: tuple[int, ...], seed: int, noise: float = 0.05) -> dict[str, Any]:
    """Campaigns with noise, so large that pairs without a root and with two are among them, lost data,
    tests that were written down twice, and pairs with an exponent of 190."""
    rng = np.random.default_rng(seed)
    data = {name: values * rng.normal(1, noise, (*shape, 5)) for name, values in PAPER.items()}
    data["e"] = np.clip(data["e"], 0, 1)
    twice, steep = (np.arange(np.prod(shape)).reshape(shape) % 10 == n for n in (3, 7))
    for name, values in data.items():
        values[twice, 1] = values[twice, 0]
        values[steep, 1] = values[steep, 0] * {"v": 1.1, "e": 1, "x_p": 1.001}[name]
    data["x_p"][rng.random((*shape, 5)) < 0.02] = np.nan
    data["beta"] = rng.uniform(1, 2.5, (*shape, 1))
    return data


@pytest.mark.parametrize("shape", [(40,), (3, 7), (1,), (2, 1, 3)])
def test_a_batch_is_the_same_as_one_by_one_bit_for_bit(shape: tuple[int, ...]) -> None:
    data = noisy(shape, seed=len(shape))
    together = run(data)
    codes = set()
    for place in np.ndindex(*shape):
        alone = run({name: values[place] for name, values in data.items()})
        for column in SHEET.columns:
            name = column.name
            many = np.broadcast_to(together.value[name], (*shape, alone.value[name].shape[-1]))
            status = np.broadcast_to(together.status[name], many.shape)
            np.testing.assert_array_equal(many[place], alone.value[name], err_msg=name)
            np.testing.assert_array_equal(status[place], alone.status[name], err_msg=name)
            codes |= set(status[place].tolist())
    if np.prod(shape) >= 20:
        assert codes == set(Status) - {Status.UNDECIDED}


def test_only_what_rests_on_a_batch_has_one() -> None:
    values = run({"beta": np.array([[1.25], [1.5], [2.0]])})
    assert values.value["m_red"].shape == (1,)
    assert values.value["alpha"].shape == (3, 10)
    assert values.value["alpha_log"].shape == (3, 1)
    assert values.value["v"].shape == (5,)


def test_a_parameter_may_be_a_batch_against_measurements_of_another() -> None:
    rng = np.random.default_rng(5)
    v = PAPER["v"] * rng.normal(1, 0.01, (4, 1, 5))
    values = run({"v": v, "beta": np.array([[1.25], [1.5]])})
    assert values.value["alpha"].shape == (4, 2, 10)
    one = run({"v": v[2, 0], "beta": 1.5})
    np.testing.assert_array_equal(values.value["alpha"][2, 1], one.value["alpha"])
    np.testing.assert_array_equal(values.value["alpha_lin"][2, 1], one.value["alpha_lin"])


def test_sums_leave_out_what_is_in_error_in_each_element_of_a_batch() -> None:
    x_p = np.tile(PAPER["x_p"], (3, 1))
    x_p[1, 4] = np.nan
    x_p[2, 1:] = np.nan
    values = run({"x_p": x_p})
    alpha = values.value["alpha"]
    without_last = [0, 1, 2, 4, 5, 7]
    np.testing.assert_allclose(
        values.value["alpha_mean"][:2, 0], [alpha[0].mean(), alpha[0][without_last].mean()]
    )
    assert values.status["alpha_mean"][:, 0].tolist() == [Status.OK, Status.OK, Status.INPUT]
    np.testing.assert_array_equal(
        values.value["alpha_median"][:, 0], [np.median(alpha[0]), np.median(alpha[0][without_last]), np.nan]
    )
    assert values.status["alpha_lin"][:, 0].tolist() == [Status.OK, Status.OK, Status.INPUT]


@pytest.mark.parametrize("number", [1, 2, 3, 4, 7])
@pytest.mark.parametrize(
    ("kind", "known"), [(Median, np.nanmedian), (Greatest, np.nanmax), (Least, np.nanmin)]
)
def test_what_is_taken_by_order_is_of_the_rows_that_have_values(kind: Any, known: Any, number: int) -> None:
    """Of any number of them, in each element of a batch; of none there is none."""
    rng = np.random.default_rng(number)
    taken = formula("m", kind(a[k], (k, 1, n)))
    rows = rng.normal(size=(50, number))
    rows[rng.random(rows.shape) < 0.3] = np.nan
    values = engine.evaluate(Sheet((a, taken)), {"rows": range(1, number + 1)}, {"a": rows})
    some = ~np.isnan(rows).all(axis=1)
    np.testing.assert_array_equal(values.value["m"][some, 0], known(rows[some], axis=1))
    assert (values.status["m"][:, 0] == np.where(some, Status.OK, Status.INPUT)).all()
    assert some.any()


def test_the_blocks_in_which_roots_are_sought_do_not_show(monkeypatch: pytest.MonkeyPatch) -> None:
    data = noisy((60,), seed=9)
    whole_batch = run(data)
    rows = {"tests": list(range(1, 31))}
    rng = np.random.default_rng(2)
    long = {
        "v": np.sort(rng.uniform(1, 6, 30)),
        "e": rng.uniform(0.45, 0.6, 30),
        "x_p": np.sort(rng.uniform(1e-5, 6e-5, 30)),
    }
    long_campaign = engine.evaluate(SHEET, rows, uncertain({**PARAMETERS, **long}), PROGRAM)
    monkeypatch.setattr(engine, "BLOCK", 37)
    blocks = run(data)
    small = engine.evaluate(SHEET, rows, uncertain({**PARAMETERS, **long}), PROGRAM)
    np.testing.assert_array_equal(whole_batch.value["alpha"], blocks.value["alpha"])
    np.testing.assert_array_equal(long_campaign.value["alpha"], small.value["alpha"])
    assert long_campaign.roots == small.roots
    assert long_campaign.roots["alpha"]


def test_columns_that_come_later_are_those_of_the_whole_sheet() -> None:
    """Errors, and rows that sums leave out, included; what is there is not computed again."""
    data = uncertain({**PARAMETERS, **PAPER, "x_p": [30e-6, 29.7e-6, 41.6e-6, 45.97e-6, np.nan]})
    order = SHEET.order
    whole_sheet = engine.evaluate(Sheet(order), TESTS, data)
    assert whole_sheet.counted
    loops = SHEET.loop_of
    for cut in range(1, len(order), 6):
        if loops.get(order[cut].name, 0) is loops.get(order[cut - 1].name):
            continue  # what rests on one another comes at once
        first = {c.name for c in order[:cut]}
        some = engine.evaluate(Sheet(order[:cut]), TESTS, {n: v for n, v in data.items() if n in first})
        every = engine.extend(some, order[cut:], {n: v for n, v in data.items() if n not in first})
        for column in order:
            np.testing.assert_array_equal(every.value[column.name], whole_sheet.value[column.name])
            np.testing.assert_array_equal(every.status[column.name], whole_sheet.status[column.name])
            assert list(every.cells(column.name)) == list(whole_sheet.cells(column.name))
        assert all(every.value[name] is some.value[name] for name in first)
        assert (every.roots, every.counted) == (whole_sheet.roots, whole_sheet.counted)


# --------------------------------------------------------------------------------- wrong or odd data
def test_a_column_must_have_the_rows_of_its_axis() -> None:
    with pytest.raises(ValueError, match=r"^v has 4 rows, not 5: the last dimension is the rows$"):
        run({"v": [1.0, 2.0, 3.0, 4.0]})
    with pytest.raises(ValueError, match=r"^beta has 2 rows, not 1: the last dimension is the rows$"):
        run({"beta": [1.0, 2.0]})


@pytest.mark.parametrize("number", [2.5, 1, 0, -3, 10001, np.nan, np.inf])
def test_a_count_that_is_not_allowed_makes_no_rows(number: float) -> None:
    values = run({"points_per_pair": number})
    assert values.status["points_per_pair"].tolist() == [Status.INPUT]
    assert values.value["x"].size == 0
    assert values.cell("alpha_mean").status is Status.OK
    assert values.cell("alpha_log").reason == (
        "#INPUT! alpha_log needs points_per_pair: the datum is missing or invalid; "
        "it must be a whole number between 2 and 10000"
    )


def test_a_batch_has_one_count() -> None:
    with pytest.raises(ValueError, match=r"^points_per_pair must be one number .* not 2\.0, 3\.0$"):
        run({"points_per_pair": [[2], [3]]})


numbers = st.one_of(
    st.floats(1e-3, 1e3),
    st.sampled_from([0.0, -1.0, 1.0, 1e-300, 1e300, 5e-324, 1.7e308, float("nan"), float("inf")]),
)


@settings(derandomize=True, max_examples=150)
@given(st.lists(st.tuples(numbers, numbers, numbers), min_size=2, max_size=4), numbers)
def test_whatever_the_data_nothing_is_ok_without_a_number_and_nothing_warns(
    rows: list[tuple[float, float, float]], beta: float
) -> None:
    v, e, x_p = zip(*rows, strict=True)
    data = uncertain({**PARAMETERS, "v": v, "e": e, "x_p": x_p, "beta": beta})
    values = engine.evaluate(SHEET, {"tests": range(1, len(rows) + 1)}, data, PROGRAM)
    for name, status in values.status.items():
        assert (np.isfinite(values.value[name]) == (status == Status.OK)).all(), name
        if SHEET[name].positive and isinstance(SHEET[name].rule, Formula):
            assert (values.value[name][status == Status.OK] > 0).all(), name
    for cell in values.errors():
        assert cell.why


def test_the_program_can_be_read() -> None:
    texts = program_texts(SHEET, lowered(SHEET))
    assert texts["sheet"].startswith(
        'def sheet(run):\n    v = run.data["v"]\n    v = run.given("v", v, numpy.greater(v, 0))'
    )
    assert (
        '    alpha_mean = run.formula("alpha_mean", alpha_mean_sum_1/n_pairs_of_alpha_mean)\n'
        in texts["sheet"]
    )
    assert texts["roots"]["alpha"]["fixed"]["source"].startswith("def kernel(")


@pytest.mark.parametrize("shape", [(60,), (7, 3)])
def test_the_blocks_in_which_a_batch_is_computed_do_not_show(
    monkeypatch: pytest.MonkeyPatch, shape: tuple[int, ...]
) -> None:
    data = noisy(shape, seed=11)
    whole = run(data)
    monkeypatch.setattr(engine, "WIDEST", 1000)
    blocks = run(data)
    for kind in ("value", "status", "broken"):
        for name, one in getattr(whole, kind).items():
            np.testing.assert_array_equal(getattr(blocks, kind)[name], one, err_msg=f"{kind} of {name}")
    beta = run({"beta": np.linspace(1, 2, 50)[:, None]})
    assert beta.value["v"].shape == (5,)
    assert beta.value["alpha"].shape == (50, 10)
    assert (
        beta.value["alpha"][33].tolist() == run({"beta": np.linspace(1, 2, 50)[33]}).value["alpha"].tolist()
    )


def test_a_large_batch_needs_little_more_memory_than_its_values() -> None:
    names = ("v", "e", "x_p", "beta", "alpha", "alpha_mean")
    few = Sheet(tuple(replace(SHEET[name], alongside=()) for name in names))
    program, data = Program.of(few, functions=np), noisy((50_000,), seed=12)
    given = {name: data[name] for name in names[:3]} | {"beta": 1.5}
    engine.evaluate(few, {"tests": range(1, 6)}, given, program)
    tracemalloc.start()
    found = engine.evaluate(few, {"tests": range(1, 6)}, given, program)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 2 * sum(each.nbytes for each in (*found.value.values(), *found.status.values()))


@pytest.mark.parametrize("shape", [(), (60,), (7, 3)])
def test_results_go_where_they_are_wanted(monkeypatch: pytest.MonkeyPatch, shape: tuple[int, ...]) -> None:
    """Into parts of arrays that hold more, block by block; the same bits, of these columns alone."""
    data = uncertain({**PAPER, **PARAMETERS, **noisy(shape, seed=13)})
    whole = run(data)
    wanted = ("alpha_log", "m_red", "alpha", "v")
    larger = {name: np.full((2, *whole.value[name].shape), 7.0) for name in wanted}
    out = {name: array[1] for name, array in larger.items()}
    for widest in (engine.WIDEST, 1000):
        monkeypatch.setattr(engine, "WIDEST", widest)
        found = engine.evaluate(SHEET, TESTS, data, PROGRAM, out)
        assert set(found.value) == set(found.status) == set(wanted)
        for name in wanted:
            assert found.value[name] is out[name]
            np.testing.assert_array_equal(out[name], whole.value[name])
            np.testing.assert_array_equal(found.status[name], whole.status[name])
            assert (larger[name][0] == 7).all()
            out[name][...] = 0


def test_batch_after_batch_takes_no_more_memory_than_a_block(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine, "WIDEST", 1 << 13)
    names, most, held = ("v", "e", "x_p", "beta", "alpha", "alpha_mean"), [], []
    few = Sheet(tuple(replace(SHEET[name], alongside=()) for name in names))
    program, data = Program.of(few, functions=np), noisy((40_000,), seed=12)
    given, out = {name: data[name] for name in names[:3]}, {"alpha_mean": np.empty((40_000, 1))}
    tracemalloc.start()
    for _ in range(4):
        tracemalloc.reset_peak()
        engine.evaluate(few, {"tests": range(1, 6)}, {**given, "beta": 1.5}, program, out)
        most.append(tracemalloc.get_traced_memory()[1])
        gc.collect()
        held.append(sys.getallocatedblocks())
    tracemalloc.stop()
    assert max(most) < 40_000 * 10 * 8  # what alpha alone would take
    assert max(held[1:]) - held[0] < 100


@pytest.mark.parametrize(
    ("name", "array", "said"),
    [
        ("alpha", np.empty((10, 3)), r"out\['alpha'\] has the shape \(10, 3\), not \(4, 10\)"),
        ("m_red", np.empty((4, 1)), r"out\['m_red'\] has the shape \(4, 1\), not \(1,\)"),
        ("alpha", np.empty((4, 10), np.float32), r"out\['alpha'\] holds float32, not float64"),
        ("alpha", [0.0], r"out\['alpha'\] holds no array, not float64"),
        ("alhpa", np.empty((4, 10)), r"out\['alhpa'\] is no column of the sheet"),
        ("alpha", np.broadcast_to(0.0, (4, 10)), r"out\['alpha'\] is read-only"),
        ("v", READ := np.tile(PAPER["v"], (4, 1)), r"out\['v'\] shares memory with the data of v, "),
    ],
)  # fmt: skip
def test_what_results_cannot_go_to_is_refused(name: str, array: Any, said: str) -> None:
    before = READ.copy()
    with pytest.raises(ValueError, match=f"^{said}"):
        engine.evaluate(
            SHEET, TESTS, {**uncertain({**PAPER, **PARAMETERS}), "v": READ}, PROGRAM, {name: array}
        )
    np.testing.assert_array_equal(READ, before)


def test_one_of_several_whole_numbers_is_a_number_as_others_are() -> None:
    """A block of a batch in which all rows have that one does not make whole numbers of the others."""
    of_x = Piecewise((1, x > 2), (Rational(2, 5), True))
    part = Column("part", None, Formula(Equation("(1)", (Symbol("part"), of_x), "")), positive=False)
    sheet = Sheet((Column("x", None, Given()), part))
    for data in ([[3.0]], [[3.0], [1.0]]):
        values = engine.evaluate(sheet, {}, {"x": np.array(data)})
        assert values.value["part"].dtype == np.float64
