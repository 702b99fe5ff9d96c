"""The exact engine: 50 digits that stand against closed forms, and the same errors as the other engines."""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest
from helpers import formula, whole
from judged_values import compare
from mpmath import mpf
from sympy import Expr, Integer, Piecewise, Rational, Sum, Symbol, cos, log, sqrt
from uncertain_data import uncertain

from loopsheet.derivations.equation import Equation
from loopsheet.report.cells.values import Status
from loopsheet.report.engines import exact
from loopsheet.report.engines import numpy as engine
from loopsheet.report.judge.engines import _Tally
from loopsheet.report.sheet import Axis, Column, Given, Root, Sheet
from loopsheet.report.workbooks.soft_impact import sheet as soft_impact

k, n = whole("k"), whole("n")
ROWS = Axis("rows", k, n)
a, b = Column("a", ROWS, Given()), Column("b", None, Given())
x = Symbol("x", positive=True)


def root(form: Expr, low: Expr, high: Expr, **more: Any) -> Column:
    equation = Equation("(2)", (form, 0 * x), "")
    return Column("r", None, Root(equation, equation, x, x, low, high, high / 2, **more), positive=False)


def evaluate(*columns: Column, **data: Any) -> exact.ExactValues:
    a_column = data.get("a")
    rows = len(a_column) if a_column is not None else 0
    return exact.evaluate(Sheet(columns), {"rows": range(1, rows + 1)}, data)


def close(value: Any, expected: Any) -> bool:
    with mpmath.workdps(60):
        return bool(abs(value / expected - 1) < mpf(10) ** -50)


def test_data_are_taken_exactly() -> None:
    values = evaluate(a, b, formula("f", a[k] * b.symbol, ROWS), a=[Fraction(1, 3), 0.1, "0.1"], b=3)
    one, double, text = values.value["f"]
    with mpmath.workdps(60):
        assert abs(one - 1) < mpf(10) ** -60
        assert double == mpf(0.1) * 3 != text
        assert close(text, mpf(3) / 10)


def test_sums_have_fifty_digits_although_they_cancel() -> None:
    rows = [Fraction(10) ** 20, Fraction(1, 3), -(Fraction(10) ** 20)]
    values = evaluate(a, formula("f", Sum(a[k], (k, 1, n))), a=rows)
    with mpmath.workdps(60):
        assert close(values.value["f"][0], mpf(1) / 3)


def test_what_rounding_leaves_of_a_difference_is_nothing_and_what_is_small_stays() -> None:
    g = formula("g", sqrt(b.symbol))
    left = formula("f", g.symbol**2 - b.symbol)
    sign_of_it = formula("h", Piecewise((Integer(1), left.symbol > 0), (Integer(2), True)))
    small = formula("s", b.symbol * Rational(1, 10**60))
    values = evaluate(b, g, left, sign_of_it, small, b=5)
    with mpmath.workdps(65):
        assert mpmath.sqrt(5) ** 2 != 5
    assert values.value["f"] == [0]
    assert values.value["h"] == [2], "what rests on it is computed from nothing"
    with mpmath.workdps(60):
        assert close(values.value["s"][0], mpf(5) / mpf(10) ** 60)


@pytest.mark.parametrize(
    ("form", "low", "high", "expected"),
    [
        (cos(x) - x, 0, 1, lambda: mpmath.findroot(lambda t: mpmath.cos(t) - t, 0.7)),
        ((x - Rational(1, 7)) * (1 - Rational(1, 10**30)), 0, 1, lambda: mpf(1) / 7),
        (log(x), Rational(1, 10**30), 10**30, lambda: mpf(1)),
        ((x - 3) ** 3, 0, 10, lambda: mpf(3)),
    ],
)
def test_roots_have_fifty_digits(form: Expr, low: int, high: int, expected: Any) -> None:
    values = evaluate(root(form, Rational(low), Rational(high)))
    with mpmath.workdps(60):
        # A triple root has a third of the digits, as it must.
        digits = 18 if form == (x - 3) ** 3 else 50
        assert abs(values.value["r"][0] / expected() - 1) < mpf(10) ** -digits


def test_a_guess_saves_looks_at_sums_and_moves_no_digit(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever is guessed, the root is where the equation has been seen with either sign at 50 digits."""
    narrow, looks = exact._narrow, dict.fromkeys((1, 1 + 1e-9, 2, mpf("nan")), 0)
    form = Sum(a[k] * x**40, (k, 1, n)) - Sum(a[k] ** 2, (k, 1, n))
    steady = root(form, Integer(0), Integer(5), sign_low=Integer(-1), sign_high=Integer(1))
    for spoilt in looks:

        def guessing(form: Any, *ends: Any, guess: Any = None, spoilt: Any = spoilt) -> Any:
            def look(u: Any) -> Any:
                looks[spoilt] += guess is not None
                return form(u)

            return narrow(look, *ends, guess and guess * spoilt)

        monkeypatch.setattr(exact, "_narrow", guessing)
        values = evaluate(a, steady, a=[1, 2, 4])
        with mpmath.workdps(70):
            assert close(values.value["r"][0], mpf(3) ** (mpf(1) / 40))
    best, near, *others = looks.values()
    assert 0 < best < near < min(others)
    assert 2 * best < min(others)


def test_two_roots_are_both_found() -> None:
    column = root(x**2 - 3 * x + 2, Rational(0), Rational(9), turning=(Rational(3, 2),))
    values = evaluate(column)
    assert values.status["r"] == [Status.TWOROOTS]
    assert [float(r) for r in values.roots["r"][0]] == [1.0, 2.0]
    assert values.value["r"] == [None]


def test_a_form_without_a_sign_at_an_end_is_outside_the_domain() -> None:
    assert evaluate(root(1 / (x - 1), Rational(0), Rational(1))).status["r"] == [Status.DOMAIN]


# ----------------------------------------------------------------------- the same as the other engine
SHEET = soft_impact(frozenset({"ball_mass"}))
PROGRAM = engine.Program.of(SHEET)


def test_the_comparison_of_engines_finds_what_differs() -> None:
    data = {"v": [2.0, 3.0], "e": [0.5, 0.48], "x_p": [2e-5, 3e-5], "beta": 1.5, "ball_mass": 8e-3}
    labels, data = {"tests": [1, 2]}, uncertain({**data, "points_per_pair": 3})
    values = engine.evaluate(SHEET, labels, data, PROGRAM)
    agreement = compare(values, labels, data)
    assert agreement.findings == ()
    assert agreement.cells == sum(len(values.labels(column)) for column in SHEET.columns)
    assert agreement.units < 1
    assert agreement.summary.startswith(f"numpy agrees with 50 digits on {agreement.cells} cells within ")
    values.value["C_log"][0] *= 1 + 1e-9
    values.status["alpha"][0] = Status.NOROOT
    findings = compare(values, labels, data).findings
    assert findings == (
        "alpha[1-2]: numpy says #NOROOT!, 50 digits say ok",
        "C_log: numpy is off by 1.0e-09",
    )


def test_none_and_nan_are_both_missing() -> None:
    for missing in (None, float("nan"), float("inf")):
        values = evaluate(a, formula("f", a[k] * 2, ROWS), a=[1, missing])
        assert values.status["f"] == [Status.OK, Status.INPUT]
    assert evaluate(a, a=np.array([1.0, 2.0])).value["a"] == [1, 2]


# --- what is written of it --------------------------------------------------------------------------------
SPOILED = uncertain({
    "ball_diameter": 0.0127, "ball_density": 7800.0, "beta": 1.5, "points_per_pair": 3,
    "v": [2.334, 2.940, 4.089, 4.504, 1.0, 1.5, 2.334],
    "e": [0.530, 0.512, 0.479, 0.467, 0.6, 0.67465466, 0.53],
    "x_p": [30e-6, 29.7e-6, 41.6e-6, np.nan, 8.47722741e-6, 10e-6, 25e-6],
})  # fmt: skip
"""No datum, pairs without a root, with two, and of one speed."""


def spoiled() -> tuple[Sheet, exact.ExactValues]:
    sheet = soft_impact(frozenset({"ball_diameter", "ball_density"}))
    return sheet, exact.evaluate(sheet, {"tests": range(1, 8)}, SPOILED)


@pytest.mark.parametrize("digits", [5, 15, 40])
def test_a_rounded_value_is_the_nearest_double(digits: int) -> None:
    sheet, judged = spoiled()
    with mpmath.workdps(digits):  # the caller's, which do not matter
        values = judged.rounded(sheet)
    with mpmath.workdps(60):
        for name, column in values.value.items():
            for double, true in zip(column.tolist(), judged.value[name], strict=True):
                if true is None:
                    assert np.isnan(double)
                    continue
                around = [abs(mpf(each) - true) for each in np.nextafter(double, [-np.inf, np.inf]).tolist()]
                assert abs(mpf(double) - true) <= min(around), name


def test_a_rounded_value_that_is_none_is_told_as_other_engines_tell_it() -> None:
    sheet, judged = spoiled()
    values = judged.rounded(sheet)
    theirs = engine.evaluate(sheet, {"tests": range(1, 8)}, SPOILED)
    codes = {Status(int(code)) for column in values.status.values() for code in column}
    assert {Status.INPUT, Status.NOROOT, Status.TWOROOTS} <= codes
    assert values.counted == theirs.counted != {}
    for column in sheet.columns:
        np.testing.assert_array_equal(values.status[column.name], theirs.status[column.name])
        np.testing.assert_allclose(values.value[column.name], theirs.value[column.name], rtol=1e-9)
        own, other = ([cell.reason for cell in found.cells(column.name)] for found in (values, theirs))
        assert own == other


def test_a_broken_condition_is_told_as_other_engines_tell_it() -> None:
    conditions = ((a[k] > 1, "it is above 1"), (a[k] < 3, "it is below 3"))
    sheet = Sheet((a, replace(formula("f", 1 / a[k], ROWS), requires=conditions)))
    rows, data = {"rows": [1, 2, 3, 4]}, {"a": [0.5, 2, 4, np.nan]}
    values, theirs = exact.evaluate(sheet, rows, data).rounded(sheet), engine.evaluate(sheet, rows, data)
    assert values.broken["f"].tolist() == theirs.broken["f"].tolist() == [1, 0, 2, 0]
    reasons = [cell.reason for cell in values.cells("f")]
    assert reasons == [cell.reason for cell in theirs.cells("f")]
    assert reasons[2].endswith("it is below 3")


def test_a_part_of_a_sheet_is_rounded_alone() -> None:
    sheet, judged = spoiled()
    part = Sheet(tuple(column for column in sheet.columns if isinstance(column.rule, Given)))
    assert set(judged.rounded(part).value) == {column.name for column in part.columns}


def test_what_should_be_nothing_is_told_by_its_size() -> None:
    """Beside 0 nothing is a part of anything: "off by 0.0e+00" told nobody what was wrong."""
    tally = _Tally("abacus")
    tally.add("y", mpmath.mpf("3e-20"), 0.0, 0)
    assert tally.findings == ["y: abacus is off by 3.0e-20 (in SI), where 50 digits say 0"]
