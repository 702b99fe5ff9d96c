"""Error values: they spread with their first culprit, sums leave them out and count what is left.

What every engine makes of these rows stands in `engine_cases`; here is what is told of them.
"""

from dataclasses import replace

import engine_cases
import numpy as np
import pytest
from sympy import Rational, Symbol

from loopsheet.derivations.equation import Equation
from loopsheet.report.cells.values import CODES, Status, Values
from loopsheet.report.engines import numpy as engine
from loopsheet.report.sheet import Column, Given, Root, Sheet

NAN = float("nan")
OUTSIDE, MISSING = "outside the domain of (1)", "the datum is missing or invalid"


@pytest.fixture(scope="module")
def values() -> Values:
    return engine_cases.values()


def reasons(values: Values, name: str) -> list[str]:
    return [cell.reason for cell in values.cells(name)]


def test_without_errors_every_cell_has_a_number(values: Values) -> None:
    names = {column.name for column in engine_cases.group("sound").columns}
    assert not [cell for cell in values.errors() if cell.name in names]
    assert not names & values.counted.keys()
    assert values.scalar("scaled_sound") == 2 * values.scalar("mean_sound")
    assert reasons(values, "mean_sound") == [""]


def test_a_missing_datum_is_named_as_the_culprit_wherever_it_is_needed(values: Values) -> None:
    assert reasons(values, "b_missing") == ["", f"#INPUT! b_missing[30]: {MISSING}", ""]
    assert reasons(values, "slope_missing") == [
        f"#INPUT! slope_missing[10-30] needs b_missing[30]: {MISSING}",
        "",
        f"#INPUT! slope_missing[30-20] needs b_missing[30]: {MISSING}",
    ]


def test_a_sum_leaves_out_the_rows_in_error_and_counts_the_others(values: Values) -> None:
    assert values.counted["mean_missing"] == {"pairs_missing": 1}
    assert "scaled_missing" not in values.counted


def test_a_sum_of_rows_in_error_carries_the_first_ones_error(values: Values) -> None:
    for name, place in (("mean", ""), ("scaled", ""), ("offset", "[3]")):
        said = f"#INPUT! {name}_many_missing{place} needs b_many_missing[1]: {MISSING}"
        assert reasons(values, f"{name}_many_missing")[-1] == said
    assert np.isnan(values.scalar("mean_many_missing"))


def test_of_several_errors_the_first_is_told(values: Values) -> None:
    """The first row of a sum, and of what a rule names the column that was declared first."""
    tag = "of_several_kinds"
    fallen = f"needs slope_{tag}[1-2]: {OUTSIDE}: a must rise"
    lost = f"needs a_{tag}[3]: {MISSING}"
    assert reasons(values, f"slope_{tag}")[1:] == [
        f"#INPUT! slope_{tag}[{pair}] {lost}" for pair in ("1-3", "2-3")
    ]
    assert reasons(values, f"mean_{tag}") == [f"#DOMAIN! mean_{tag} {fallen}"]
    assert reasons(values, f"offset_{tag}") == [
        f"#DOMAIN! offset_{tag}[1] {fallen}",
        f"#DOMAIN! offset_{tag}[2] {fallen}",
        f"#INPUT! offset_{tag}[3] {lost}",
    ]
    assert reasons(values, f"scaled_{tag}") == [f"#INPUT! scaled_{tag} needs c_{tag}: {MISSING}"]


def test_a_sum_that_has_a_value_is_no_culprit(values: Values) -> None:
    said = f"#INPUT! excess_left_out[2] needs a_left_out[2]: {MISSING}"
    assert reasons(values, "excess_left_out") == ["", said, ""]
    tag = "without_a_culprit"
    assert reasons(values, f"lift_{tag}") == ["", "", f"#INPUT! lift_{tag}[3] needs b_{tag}[3]: {MISSING}"]


def test_a_broken_condition_is_told_by_its_own_sentence(values: Values) -> None:
    assert reasons(values, "slope_of_conditions") == [
        f"#DOMAIN! slope_of_conditions[1-2]: {OUTSIDE}: a must rise",
        f"#DOMAIN! slope_of_conditions[1-3]: {OUTSIDE}: b is at most 100",
        "",
    ]


def test_what_is_no_number_or_not_positive_is_outside_the_domain(values: Values) -> None:
    told = f"{OUTSIDE}: it gives no"
    assert reasons(values, "slope_not_positive")[0] == (
        f"#DOMAIN! slope_not_positive[1-2]: {told} finite number here"
    )
    assert reasons(values, "gap_not_positive")[:2] == [
        f"#DOMAIN! gap_not_positive[{row}]: {OUTSIDE}: it has to be positive" for row in (1, 2)
    ]


def test_no_root_and_two_roots_have_their_sentences(values: Values) -> None:
    assert reasons(values, "x0_of_roots")[0] == (
        "#NOROOT! x0_of_roots[1-2]: (2) has no root here: no value of the interval satisfies the equation"
    )
    assert values.cell("x0_of_roots", (1, 4)).reason == (
        "#TWOROOTS! x0_of_roots[1-4]: (2) has more than one root here: 0.267949 and 3.73205 "
        "(several values of the interval satisfy the equation)"
    )
    assert values.counted["root_sum_of_roots"] == {"pairs_of_roots": 1}


def test_an_interval_at_whose_end_the_equation_has_no_value_is_told() -> None:
    z, size = Symbol("z", positive=True), Column("size", None, Given(), "1")
    equation = Equation("(2)", (1 / z - 1 / z**2, size.symbol), "")
    root = Root(equation, equation, z, z, Rational(0), Rational(9), Rational(3))
    values = engine.evaluate(Sheet((size, Column("depth", None, root, "1"))), {}, {"size": 0.1})
    assert values.cell("depth").status is Status.DOMAIN
    assert values.cell("depth").reason == (
        "#DOMAIN! depth: outside the domain of (2): it has no value at an end of the interval of its root, "
        "or its root gives none"
    )


@pytest.mark.parametrize(
    ("unit", "display", "told"),
    [("m", "", ["1e-05 m", "2e-05 m"]), ("m", "mm", ["0.01 mm", "0.02 mm"]),
     ("m", "like top", ["10 um", "20 um"]), ("K", "degC", ["-273.15 degC", "-273.15 degC"])],
)  # fmt: skip
def test_roots_are_told_in_the_unit_in_which_they_are_shown(unit: str, display: str, told: list[str]) -> None:
    z = Symbol("z", positive=True)
    left, right = (Column(name, None, Given(), unit) for name in ("left", "right"))
    top = Column("top", None, Given(), unit, display="um" if unit == "m" else "")
    equation = Equation("(2)", ((z - left.symbol) * (z - right.symbol), 0 * z), "")
    root = Root(equation, equation, z, z, Rational(0), top.symbol, top.symbol / 2)
    sheet = Sheet((left, right, top, Column("depth", None, root, unit, display=display)))
    values = engine.evaluate(sheet, {}, {"left": 1e-5, "right": 2e-5, "top": 1e-3})
    assert f"more than one root here: {' and '.join(told)} (several" in values.cell("depth").reason
    values = engine.evaluate(sheet, {}, {"left": 1e-5, "right": 1e-5, "top": 1e-3})
    assert values.cell("depth").status is Status.UNDECIDED
    assert f"cannot be counted near z = {told[0]}: it" in values.cell("depth").reason


def test_a_root_is_not_sought_where_a_condition_is_broken(values: Values) -> None:
    assert reasons(values, "x0_not_sought")[:2] == [
        f"#DOMAIN! x0_not_sought[1-{row}]: outside the domain of (2): b is below 1000" for row in (2, 3)
    ]


def test_two_roots_that_nobody_knows_are_told_without_numbers(values: Values) -> None:
    said = "(2) has more than one root here: several values of the interval satisfy the equation"
    assert reasons(replace(values, roots={}), "two") == [f"#TWOROOTS! two: {said}"]


def of_sound(rows: int, a: object, b: object, c: object) -> Values:
    """Other data of the columns that have no error."""
    data = {"a_sound": a, "b_sound": b, "c_sound": c}
    return engine.evaluate(engine_cases.group("sound"), {"rows_sound": range(1, rows + 1)}, data)


def test_a_sum_without_rows_is_outside_the_domain() -> None:
    values, empty = of_sound(1, [1.0], [2.0], 2.0), f"{OUTSIDE}: pairs_sound has no rows"
    assert reasons(values, "mean_sound") == [f"#DOMAIN! mean_sound: {empty}"]
    assert reasons(values, "scaled_sound") == [f"#DOMAIN! scaled_sound needs mean_sound: {empty}"]
    assert list(values.cells("slope_sound")) == []


def test_a_sum_without_rows_is_so_in_every_draw() -> None:
    values = of_sound(1, [[1.0], [2.0], [3.0]], [[2.0], [3.0], [NAN]], [[1.0], [NAN], [1.0]])
    assert values.status["mean_sound"].tolist() == [[Status.DOMAIN]] * 3
    assert values.status["scaled_sound"].tolist() == [[Status.DOMAIN], [Status.INPUT], [Status.DOMAIN]]
    assert values.status["offset_sound"].tolist() == [[Status.DOMAIN]] * 3


def test_cells_are_found_by_their_labels(values: Values) -> None:
    assert values.labels(values.sheet["slope_missing"]) == [(10, 30), (10, 20), (30, 20)]
    assert values.cell("slope_missing", (30, 20)).address == "slope_missing[30-20]"
    assert values.cell("mean_missing").address == "mean_missing"
    for name, label in (("slope", (20, 30)), ("slope", ()), ("a", (1,)), ("mean", (1,))):
        with pytest.raises(KeyError):
            values.cell(f"{name}_missing", label)


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
    rng = np.random.default_rng(1)
    b = rng.uniform(1, 2, 200)
    b[5] = NAN
    values = of_sound(200, np.sort(rng.uniform(0, 1, 200)), b, 1.0)
    cells = list(values.cells("slope_sound"))
    assert len(cells) == 19_900
    assert sum(cell.culprit is not None and cell.culprit.address == "b_sound[6]" for cell in cells) == 199
    assert values.counted["mean_sound"] == {"pairs_sound": 19_701}
    assert values.cell("slope_sound", (199, 200)) == cells[-1]
