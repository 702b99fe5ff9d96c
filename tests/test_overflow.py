"""What no double holds has a code and a sentence of its own in every engine, and no fit loses a pair."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import engine_cases
import mpmath
import numpy as np
import pytest
from judged_values import compare
from slipped_campaigns import PAPER, write
from sympy import Ne, Piecewise, Sum, Symbol, acos, acoth, asin, cos, exp, log, symbols, tan
from uncertain_data import uncertain

from loopsheet.report.cells.values import Status
from loopsheet.report.engines import exact
from loopsheet.report.engines import numpy as engine
from loopsheet.report.judge.readers import Case, run_javascript
from loopsheet.report.plan.domain import defined, is_positive
from loopsheet.report.plan.nodes import RowSum
from loopsheet.report.quantity import SMALLEST
from loopsheet.report.study import Study
from loopsheet.report.workbooks.soft_impact import WORKBOOK

k, n = symbols("k n", integer=True, positive=True)
OK, DOMAIN, OVERFLOW = Status.OK, Status.DOMAIN, Status.OVERFLOW


def test_it_says_that_there_is_a_value_and_what_is_in_the_way() -> None:
    values = engine_cases.values()
    assert values.cell("product", (3,)).reason == (
        "#OVERFLOW! product[3]: (1) has a value here that no double holds: "
        "it, or a step towards it, is above 1.8e308, or positive and below 2.2e-308"
    )


def test_50_digits_go_by_what_the_value_rounds_to() -> None:
    with mpmath.workdps(60):
        largest = mpmath.mpf(2) ** 1024 - mpmath.mpf(2) ** 970
        for value, code in (
            (largest * (1 - mpmath.mpf(10) ** -40), None),
            (largest, OVERFLOW),
            (-largest, OVERFLOW),
            (mpmath.mpf(SMALLEST), None),
            (mpmath.mpf(SMALLEST) * (1 - mpmath.mpf(10) ** -40), OVERFLOW),
            (mpmath.mpf(0), DOMAIN),
            (mpmath.nan, DOMAIN),
        ):
            if code is None:
                assert exact._held(value, positive=True) == value
            else:
                with pytest.raises(exact._Failed) as failed:
                    exact._held(value, positive=value >= 0)
                assert failed.value.status is code


def test_a_derivative_that_no_double_holds_is_no_warning(tmp_path: Path) -> None:
    """Of a ball of 1e300 g: warnings are errors here."""
    folder = write(tmp_path, PAPER)
    toml = folder / "report.toml"
    text = toml.read_text()
    toml.write_text(
        text.replace('ball_diameter = "12.7 mm"\nball_density = "7800 kg/m^3"', 'ball_mass = "1e300 g"')
    )
    assert "1e300" in toml.read_text()
    known = Study(folder).computed.uncertain().u
    assert 0 < known["alpha_mean"].item() < 1


# --- where a value is ------------------------------------------------------------------------------------

x, y = symbols("x y", real=True)
P, Q = symbols("P Q", positive=True)


@pytest.mark.parametrize(
    ("expression", "holds", "fails"),
    [
        (1 / x, [1, -1], [0]),
        (x**P, [1, 0], [-1]),
        (x**-P, [1], [-1, 0]),
        (x**y, [2], [0]),
        (log(x) / (x - 2), [1], [2, 0]),
        (Piecewise((1 / x, x > 0), (x, True)), [0, 1, -1], []),
        (Piecewise((x, x > 0)), [1], [-1]),
        (Sum(log(x), (k, 1, 3)), [1], [0]),
    ],
)  # fmt: skip
def test_where_an_expression_is_defined(expression: Any, holds: list[float], fails: list[float]) -> None:
    where = defined(expression)
    for at in holds:
        assert where.subs({x: at, P: 0.5, y: -1}) == True, at  # noqa: E712 - sympy's true
    for at in fails:
        assert where.subs({x: at, P: 0.5, y: -1}) == False, at  # noqa: E712 - sympy's false


@pytest.mark.parametrize(
    "expression",
    [P * Q**-2, exp(x) / (1 + x**2), log(P), Sum(exp(x), (k, 1, n)), RowSum(exp(x), Symbol("rows"))],
)
def test_what_is_defined_everywhere(expression: Any) -> None:
    assert defined(expression) == True  # noqa: E712 - sympy's true


def test_a_function_of_which_nothing_is_known_is_defined_nowhere() -> None:
    assert defined(P * acoth(x)) == False  # noqa: E712 - sympy's false


def test_where_a_function_ends_or_jumps_is_known() -> None:
    assert defined(P * acos(x)) == ((x >= -1) & (x <= 1))
    assert defined(tan(x) + asin(x / 2)) == (Ne(cos(x), 0) & (x / 2 >= -1) & (x / 2 <= 1))


def test_a_sum_of_positive_terms_is_positive() -> None:
    assert is_positive(P * RowSum(exp(x), Symbol("rows")) / n)
    assert not is_positive(RowSum(x, Symbol("rows")))


# --- the paper's workbook --------------------------------------------------------------------------------

PAIRS = WORKBOOK.sheet(frozenset({"ball_mass"}))
STEEP = uncertain(
    {
        # Tests 1 and 2 have one e and almost one imprint: their exponent is 190, and C is 10 to the 880.
        "v": [2.334, 1.1 * 2.334, 4.089, 4.504],
        "e": [0.530, 0.530, 0.479, 0.467],
        "x_p": [23.5e-6, 1.001 * 23.5e-6, 41.6e-6, 45.97e-6],
        "beta": 1.5,
        "ball_mass": 8.366e-3,
        "points_per_pair": 50,
    }
)
TESTS = {"tests": [1, 2, 3, 4]}


def test_no_average_loses_a_pair_because_its_coefficient_is_too_large() -> None:
    values = engine.evaluate(PAIRS, TESTS, STEEP)
    assert values.value["alpha"][0] == pytest.approx(189.7, abs=0.1)
    assert values.cell("C", (1, 2)).status is OVERFLOW
    for name in ("Cprime_1", "Cprime_2", "x_m1", "x_m2", "ln_F"):
        assert (values.status[name] == OK).all(), name
    # The force at a fiftieth of the approach is 10 to the -318 of the largest: no double, but a logarithm.
    assert values.cell("F", (1, 2, 1)).status is OVERFLOW
    assert values.cell("ln_F", (1, 2, 1)).value == pytest.approx(189.7 * np.log(1 / 50), rel=0.02)
    for name in ("alpha_mean", "alpha_log", "alpha_lin", "C_lin"):
        assert values.status[name][0] == OK
        assert name not in values.counted  # nothing was left out


def test_the_engines_agree_on_it(require: Callable[..., str]) -> None:
    values = engine.evaluate(PAIRS, TESTS, STEEP)
    assert compare(values, TESTS, STEEP).findings == ()
    require("node")
    reading = run_javascript(Case(PAIRS, TESTS, STEEP))
    for name in PAIRS.by_name:
        assert reading.status[name] == [Status(int(code)).code for code in values.status[name]], name


def test_a_number_that_no_double_holds_is_no_datum() -> None:
    """A typed 1e400 is missing to every engine, not infinite to one and a number to the other."""
    data = {**STEEP, "ball_mass": "1e400"}
    assert exact.evaluate(PAIRS, TESTS, data).status["ball_mass"] == [Status.INPUT]
