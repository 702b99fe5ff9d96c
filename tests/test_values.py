"""Error values: they spread with their first culprit, sums leave them out and count what is left."""

from dataclasses import replace

import numpy as np
import pytest
from sympy import Expr, Rational, Sum, Symbol, log

from loopsheet.derivations.equation import Equation
from loopsheet.report.cells.values import CODES, Status, Values
from loopsheet.report.engines import exact
from loopsheet.report.engines import numpy as engine
from loopsheet.report.sheet import Axis, Column, Formula, Given, PairAxis, Root, Sheet

NAN = float("nan")


def whole(name: str) -> Symbol:
    return Symbol(name, integer=True, positive=True)


k, i, j, p, n, n_pairs = (whole(name) for name in ("k", "i", "j", "p", "n", "n_pairs"))
ROWS = Axis("rows", k, n)
PAIRS = PairAxis("pairs", p, n_pairs, of=ROWS, first=i, second=j)
a, b, c = Column("a", ROWS, Given()), Column("b", ROWS, Given()), Column("c", None, Given())


def formula(name: str, expression: Expr, axis: Axis | None = None, **more: object) -> Column:
    return Column(name, axis, Formula(Equation("(1)", (Symbol(name), expression), "")), **more)  # type: ignore[arg-type]


def parabola() -> Column:
    """One root, two or none: x^2 - a x + b = 0 between 0 and 10, which turns at a/2."""
    x = Symbol("x", positive=True)
    equation = Equation("(2)", (x**2 - (a[i] + a[j]) * x + b[i] * b[j], 0 * x), "")
    return Column(
        "x0",
        PAIRS,
        Root(equation, equation, x, x, Rational(0), Rational(10), Rational(1), turning=((a[i] + a[j]) / 2,)),
        requires=((b[i] < 1000, "b is below 1000"),),
    )


slope = formula(
    "slope", log(b[j] / b[i]) / (a[j] - a[i]), PAIRS, positive=False,
    requires=((a[j] > a[i], "a must rise"), (b[i] < 100, "b is at most 100")),
)  # fmt: skip
x0 = parabola()
mean = formula("mean", Sum(slope[p], (p, 1, n_pairs)) / n_pairs, positive=False)
scaled = formula("scaled", mean.symbol * c.symbol, positive=False)
offset = formula("offset", a[k] - mean.symbol, ROWS, positive=False)
excess = formula("excess", a[k] - Sum(a[k], (k, 1, n)) / n, ROWS, positive=False)
root_sum = formula("root_sum", Sum(x0[p], (p, 1, n_pairs)))
gap = formula("gap", b[k] - 1, ROWS)
lift = formula("lift", b[k] - Sum(a[k], (k, 1, n)) / n, ROWS, positive=False)
SHEET = Sheet((a, b, c, slope, x0, mean, scaled, offset, excess, root_sum, gap, lift))
PROGRAM = engine.Program.of(SHEET)


def compute(
    a: list[float], b: list[float], c: float = 2.0, labels: list[int] | None = None, agree: bool = True
) -> Values:
    """Both engines must say the same everywhere."""
    rows = {"rows": labels or list(range(1, len(a) + 1))}
    values = engine.evaluate(SHEET, rows, {"a": a, "b": b, "c": c}, PROGRAM)
    judged = exact.evaluate(SHEET, rows, {"a": a, "b": b, "c": c})
    if agree:
        for name, status in judged.status.items():
            assert values.status[name].tolist() == status, name
        for name, numbers in judged.value.items():
            expected = [NAN if x is None else float(x) for x in numbers]
            np.testing.assert_allclose(values.value[name], expected, rtol=1e-13, atol=1e-300)
    return values


def reasons(values: Values, name: str) -> list[str]:
    return [cell.reason for cell in values.cells(name)]


def test_without_errors_every_cell_has_a_number() -> None:
    values = compute([6, 7, 8], [2, 3, 5])
    assert not list(values.errors())
    assert values.counted == {}
    assert values.cell("slope", (1, 3)).value == pytest.approx(np.log(5 / 2) / 2)
    assert values.scalar("scaled") == 2 * values.scalar("mean")
    assert reasons(values, "mean") == [""]


def test_a_missing_datum_is_named_as_the_culprit_wherever_it_is_needed() -> None:
    values = compute([6, 7, 8], [2, NAN, 5], labels=[4, 7, 9])
    assert [cell.address for cell in values.errors()] == ["b[7]"]
    assert reasons(values, "b") == ["", "#INPUT! b[7]: the datum is missing or invalid", ""]
    assert reasons(values, "slope") == [
        "#INPUT! slope[4-7] needs b[7]: the datum is missing or invalid",
        "",
        "#INPUT! slope[7-9] needs b[7]: the datum is missing or invalid",
    ]


def test_a_sum_leaves_out_the_rows_in_error_and_counts_the_others() -> None:
    values = compute([1, 2, 3], [2, NAN, 5])
    assert values.scalar("mean") == pytest.approx(np.log(5 / 2) / 2)
    assert values.counted["mean"] == {"pairs": 1}
    assert "scaled" not in values.counted
    assert not values.status["scaled"].any()


def test_a_sum_of_rows_in_error_carries_the_first_ones_error() -> None:
    values = compute([1, 2, 3], [NAN, NAN, 5])
    assert reasons(values, "mean") == ["#INPUT! mean needs b[1]: the datum is missing or invalid"]
    assert reasons(values, "scaled") == ["#INPUT! scaled needs b[1]: the datum is missing or invalid"]
    assert reasons(values, "offset")[2] == "#INPUT! offset[3] needs b[1]: the datum is missing or invalid"
    assert np.isnan(values.scalar("mean"))


def test_of_several_errors_the_first_is_told() -> None:
    """The first row of a sum, and of what a rule names the column that was declared first."""
    values = compute([3, 2, NAN], [2, 3, 5], c=NAN)
    fallen = "slope[1-2]: outside the domain of (1): a must rise"
    missing = "the datum is missing or invalid"
    assert reasons(values, "slope")[1:] == [
        f"#INPUT! slope[{pair}] needs a[3]: {missing}" for pair in ("1-3", "2-3")
    ]
    assert reasons(values, "mean") == [f"#DOMAIN! mean needs {fallen}"]
    assert reasons(values, "offset") == [
        f"#DOMAIN! offset[1] needs {fallen}",
        f"#DOMAIN! offset[2] needs {fallen}",
        f"#INPUT! offset[3] needs a[3]: {missing}",
    ]
    assert reasons(values, "scaled") == [f"#INPUT! scaled needs c: {missing}"]


def test_a_row_in_error_may_still_use_the_sum_over_the_others() -> None:
    values = compute([1, NAN, 4], [2, 3, 5])
    assert reasons(values, "excess") == [
        "",
        "#INPUT! excess[2] needs a[2]: the datum is missing or invalid",
        "",
    ]
    assert values.value["excess"][[0, 2]].tolist() == [-1.5, 1.5]
    assert values.value["lift"].tolist() == [-0.5, 0.5, 2.5]


def test_a_sum_that_has_a_value_is_no_culprit() -> None:
    values = compute([1, NAN, 4], [2, 3, NAN])
    assert reasons(values, "lift") == ["", "", "#INPUT! lift[3] needs b[3]: the datum is missing or invalid"]


def test_a_missing_scalar_spreads_to_all_that_use_it() -> None:
    values = compute([1, 2], [2, 3], c=NAN)
    assert reasons(values, "scaled") == ["#INPUT! scaled needs c: the datum is missing or invalid"]
    assert reasons(values, "mean") == [""]


def test_a_broken_condition_is_told_by_its_own_sentence() -> None:
    values = compute([1, 1, 3], [200, 3, 5])
    assert reasons(values, "slope") == [
        "#DOMAIN! slope[1-2]: outside the domain of (1): a must rise",
        "#DOMAIN! slope[1-3]: outside the domain of (1): b is at most 100",
        "",
    ]


def test_what_is_no_number_or_not_positive_is_outside_the_domain() -> None:
    values = compute([1, 2, 3], [-2, 1, 5])
    outside = "outside the domain of (1): it gives no"
    assert reasons(values, "slope")[0] == f"#DOMAIN! slope[1-2]: {outside} finite number here"
    assert reasons(values, "gap")[:2] == [
        f"#DOMAIN! gap[{row}]: {outside} positive number here" for row in (1, 2)
    ]


def test_no_root_and_two_roots_have_their_sentences() -> None:
    values = compute([0, 0, 10, 4], [1, 21, 1, 1])
    assert [cell.status.code for cell in values.cells("x0")] == [
        "#NOROOT!", "#TWOROOTS!", "#TWOROOTS!", "#TWOROOTS!", "#NOROOT!", "ok",
    ]  # fmt: skip
    assert reasons(values, "x0")[0] == (
        "#NOROOT! x0[1-2]: (2) has no root here: no value of the interval satisfies the equation"
    )
    assert values.cell("x0", (1, 4)).reason == (
        "#TWOROOTS! x0[1-4]: (2) has more than one root here: 0.267949 and 3.73205 "
        "(several values of the interval satisfy the equation)"
    )
    assert values.counted["root_sum"] == {"pairs": 1}


def test_roots_are_told_with_their_unit() -> None:
    z = Symbol("z", positive=True)
    left, right, top = (Column(name, None, Given(), "m") for name in ("left", "right", "top"))
    equation = Equation("(2)", ((z - left.symbol) * (z - right.symbol), 0 * z), "")
    root = Root(equation, equation, z, z, Rational(0), top.symbol, top.symbol / 2)
    sheet = Sheet((left, right, top, Column("depth", None, root, "m")))
    values = engine.evaluate(sheet, {}, {"left": 1e-5, "right": 2e-5, "top": 1e-3})
    assert "more than one root here: 1e-05 m and 2e-05 m (several" in values.cell("depth").reason
    values = engine.evaluate(sheet, {}, {"left": 1e-5, "right": 1e-5, "top": 1e-3})
    assert values.cell("depth").status is Status.UNDECIDED
    assert "cannot be counted near z = 1e-05 m: it" in values.cell("depth").reason


def test_a_root_is_not_sought_where_a_condition_is_broken() -> None:
    values = compute([4, 4, 4], [1000, 1, 2])
    assert reasons(values, "x0")[:2] == [
        f"#DOMAIN! x0[1-{row}]: outside the domain of (2): b is below 1000" for row in (2, 3)
    ]


def test_two_roots_that_nobody_knows_are_told_without_numbers() -> None:
    values = replace(compute([4, 4], [1, 1]), roots={})
    said = "(2) has more than one root here: several values of the interval satisfy the equation"
    assert reasons(values, "x0") == [f"#TWOROOTS! x0[1-2]: {said}"]


def test_a_sum_without_rows_is_outside_the_domain() -> None:
    values = compute([1], [2])
    assert reasons(values, "mean") == ["#DOMAIN! mean: outside the domain of (1): pairs has no rows"]
    assert reasons(values, "scaled") == [
        "#DOMAIN! scaled needs mean: outside the domain of (1): pairs has no rows"
    ]
    assert list(values.cells("slope")) == []


def test_a_sum_without_rows_is_so_in_every_draw() -> None:
    draws = {"a": [[1.0], [2.0], [3.0]], "b": [[2.0], [3.0], [NAN]], "c": [[1.0], [NAN], [1.0]]}
    values = engine.evaluate(SHEET, {"rows": [1]}, draws, PROGRAM)
    assert values.status["mean"].tolist() == [[Status.DOMAIN]] * 3
    assert values.status["scaled"].tolist() == [[Status.DOMAIN], [Status.INPUT], [Status.DOMAIN]]
    assert values.status["offset"].tolist() == [[Status.DOMAIN]] * 3


def test_cells_are_found_by_their_labels() -> None:
    values = compute([1, 2, 3], [2, 3, 5], labels=[10, 30, 20])
    assert values.labels(slope) == [(10, 30), (10, 20), (30, 20)]
    assert values.cell("slope", (30, 20)).address == "slope[30-20]"
    assert values.cell("mean").address == "mean"
    for name, label in (("slope", (20, 30)), ("slope", ()), ("a", (1,)), ("mean", (1,))):
        with pytest.raises(KeyError):
            values.cell(name, label)


def test_every_status_has_a_code() -> None:
    assert list(CODES) == list(Status)
    assert [status.code for status in Status] == [
        "ok",
        "#INPUT!",
        "#DOMAIN!",
        "#NOROOT!",
        "#TWOROOTS!",
        "#OVERFLOW!",
        "#UNDECIDED!",
    ]


def test_nineteen_thousand_cells_are_read_in_one_pass() -> None:
    many = 200
    rng = np.random.default_rng(1)
    b = rng.uniform(1, 2, many)
    b[5] = NAN
    data = {"a": np.sort(rng.uniform(0, 1, many)), "b": b, "c": 1.0}
    values = engine.evaluate(SHEET, {"rows": range(1, many + 1)}, data, PROGRAM)
    cells = list(values.cells("slope"))
    assert len(cells) == 19_900
    assert sum(cell.culprit is not None and cell.culprit.address == "b[6]" for cell in cells) == 199
    assert values.counted["mean"] == {"pairs": 19_701}
    assert values.cell("slope", (199, 200)) == cells[-1]
