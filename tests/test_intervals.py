"""Interval arithmetic encloses: against mpmath's own, and against 50 digits inside of the intervals."""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from loopsheet.report.engines.intervals import Intervals, whole


def between(low: float, high: float) -> st.SearchStrategy[list[float]]:
    """Ends of an interval; the 50 digits of the judge do not reach far below 1e-9."""
    number = st.floats(low, high, allow_nan=False).filter(lambda x: x == 0 or abs(x) > 1e-9)
    return st.tuples(number, number).map(sorted)


pieces = between(-1e6, 1e6)
shares = st.fractions(0, 1, max_denominator=1000)


def interval(ends: Any) -> Intervals:
    return Intervals(np.array([ends[0]]), np.array([ends[1]]))


def inside(ends: Any, share: Any) -> Any:
    """A number of the interval, exactly."""
    low, high = (mpmath.mpf(end) for end in ends)
    return low + (high - low) * mpmath.mpf(share.numerator) / share.denominator


def holds(found: Intervals, value: Any) -> bool:
    return bool(mpmath.mpf(float(found.low[0])) <= value <= mpmath.mpf(float(found.high[0])))


@pytest.mark.parametrize("operation", [operator.add, operator.sub, operator.mul, operator.truediv])
@given(a=pieces, b=pieces, s=shares, t=shares)
def test_arithmetic_holds_what_it_gives_inside(
    operation: Callable[..., Any], a: Any, b: Any, s: Any, t: Any
) -> None:
    found = operation(interval(a), interval(b))
    with mpmath.workdps(50):
        x, y = inside(a, s), inside(b, t)
        if operation is operator.truediv and y == 0:
            return
        assert holds(found, operation(x, y))


FUNCTIONS = (
    "cos",
    "sin",
    "cosh",
    "exp",
    "log",
    "sqrt",
    "expm1",
    "log1p",
    "cbrt",
    "arctan",
    "sinh",
    "tanh",
    "arcsinh",
)


def test_a_root_of_what_begins_at_zero_begins_there() -> None:
    """Rounding outwards leaves some 1e-324 below it, and nothing is left out by that."""
    a, b = interval((0.0, 1.0)), interval((2.0, 3.0))
    for found in (np.sqrt(a * b), np.sqrt(a / b), np.sqrt((a * a).total()), (a * b) ** 1.5):
        assert found.low == 0
    c = interval((-1.0, 2.0))
    assert (c * c).low >= -1e-300 > (c * (c + 0)).low
    assert np.sqrt(c * c + c**2).low == 0
    for found in (np.sqrt(a - 1e-9), (a - 1e-9) ** 1.5):
        assert found.low == -np.inf
    assert np.sqrt(a - b).low == -np.inf


@pytest.mark.parametrize("name", FUNCTIONS)
@given(a=between(-50, 50), s=shares)
def test_functions_hold_what_they_give_inside(name: str, a: Any, s: Any) -> None:
    found = getattr(np, name)(interval(a))
    others = {"arctan": mpmath.atan, "arcsinh": mpmath.asinh}
    exactly = others.get(name) or getattr(mpmath, name)
    with mpmath.workdps(50):
        x = inside(a, s)
        if x <= {"log": 0, "sqrt": -1e-300, "log1p": -1}.get(name, -np.inf):
            return
        value = mpmath.sign(x) * mpmath.cbrt(abs(x)) if name == "cbrt" else exactly(x)
        assert holds(found, value)


@pytest.mark.parametrize(("name", "most"), [("tan", 4.0), ("tan", 400.0), ("arcsin", 1.0), ("arccos", 1.0)])
@given(data=st.data(), s=shares)
def test_what_jumps_or_ends_holds_what_it_gives_inside(name: str, most: float, data: Any, s: Any) -> None:
    a = data.draw(between(-most, most))
    found = getattr(np, name)(interval(a))
    with mpmath.workdps(50):
        assert holds(found, getattr(mpmath, name.replace("arc", "a"))(inside(a, s)))


@pytest.mark.parametrize(
    ("name", "ends", "least", "most"),
    [
        ("tan", (1.0, 1.5), 1.5574, 14.1015), ("tan", (-1.5, 1.0), -14.1015, 1.5575),
        ("tan", (1.5, 1.6), -np.inf, np.inf), ("tan", (-5.0, -4.0), -np.inf, np.inf),
        ("arcsin", (0.5, 1.0), 0.5235, 1.5708), ("arcsin", (0.5, 1.1), -np.inf, np.inf),
        ("arccos", (0.5, 1.0), 0.0, 1.0472), ("arccos", (-1.1, 0.0), -np.inf, np.inf),
    ],
)  # fmt: skip
def test_what_jumps_or_ends_is_no_wider_than_that(
    name: str, ends: tuple[float, float], least: float, most: float
) -> None:
    found = getattr(np, name)(interval(ends))
    assert (found.low[0], found.high[0]) == pytest.approx((least, most), abs=1e-4)


@given(a=pieces, n=st.integers(-4, 5), s=shares)
def test_whole_powers_hold_what_they_give_inside(a: Any, n: int, s: Any) -> None:
    found = interval(a) ** n
    with mpmath.workdps(50):
        x = inside(a, s)
        if x == 0 and n < 0:
            return
        assert holds(found, x**n)


@given(a=between(1e-6, 1e3), b=between(-5, 5), s=shares, t=shares)
def test_powers_hold_what_they_give_inside(a: Any, b: Any, s: Any, t: Any) -> None:
    with mpmath.workdps(50):
        assert holds(interval(a) ** interval(b), inside(a, s) ** inside(b, t))


@given(a=between(1e-3, 1e3), b=pieces)
def test_as_narrow_as_the_intervals_of_mpmath(a: Any, b: Any) -> None:
    """Outward rounding costs ulps, not more: a result is as narrow as mpmath's but for 1e-13 of its size."""
    assume(b[0] > 0 or b[1] < 0)
    iv = mpmath.iv
    theirs = iv.log(iv.mpf(a)) * iv.mpf(b) / (iv.mpf(a) + 1)
    ours = np.log(interval(a)) * interval(b) / (interval(a) + 1)
    size = max(abs(float(theirs.a)), abs(float(theirs.b)), 1e-300)
    assert float(ours.low[0]) >= float(theirs.a) - 1e-13 * size
    assert float(ours.high[0]) <= float(theirs.b) + 1e-13 * size


@given(a=pieces, b=pieces, s=shares, t=shares)
def test_comparisons_are_true_only_when_certain(a: Any, b: Any, s: Any, t: Any) -> None:
    truth = interval(a) < interval(b)
    either = np.where(truth, interval(a), interval(b))
    with mpmath.workdps(50):
        x, y = inside(a, s), inside(b, t)
        assert not (truth.low[0] == 1 and not x < y)
        assert not (truth.high[0] == 0 and x < y)
        assert holds(either, x if x < y else y)


@given(st.lists(pieces, min_size=1, max_size=40))
def test_a_sum_holds_the_sums_of_the_ends(ends: list[Any]) -> None:
    found = Intervals([e[0] for e in ends], [e[1] for e in ends]).total()
    with mpmath.workdps(60):
        assert mpmath.mpf(float(found.low[0])) <= mpmath.fsum(e[0] for e in ends)
        assert mpmath.mpf(float(found.high[0])) >= mpmath.fsum(e[1] for e in ends)


def test_what_is_not_known_stays_unknown() -> None:
    nothing = whole((1,))
    for found in (nothing + 1, nothing * interval((1, 2)), interval((-1, 1)) ** -1, np.log(nothing)):
        assert found.low[0] == -np.inf or found.high[0] == np.inf
    assert (nothing * 0).low[0] <= 0 <= (nothing * 0).high[0]
    assert np.isfinite((nothing * 0).low[0])


def test_a_number_that_was_rounded_when_it_was_written_is_no_point() -> None:
    assert Intervals.of(0.1).low < 0.1 < Intervals.of(0.1).high
    assert Intervals.of(3).low == 3 == Intervals.of(3).high


def test_a_function_that_intervals_do_not_know_is_refused() -> None:
    with pytest.raises(TypeError):
        np.arccosh(interval((0, 1)))


@pytest.mark.parametrize(
    ("a", "b", "less", "less_equal", "equal"),
    [
        ((1, 2), (3, 4), (1, 1), (1, 1), (0, 0)),
        ((3, 4), (1, 2), (0, 0), (0, 0), (0, 0)),
        ((1, 3), (2, 4), (0, 1), (0, 1), (0, 1)),
        ((1, 2), (2, 3), (0, 1), (1, 1), (0, 1)),
        ((2, 3), (1, 2), (0, 0), (0, 1), (0, 1)),
        ((2, 2), (2, 2), (0, 0), (1, 1), (1, 1)),
        ((2, 2), (2, 3), (0, 1), (1, 1), (0, 1)),
        ((1, 3), (1, 3), (0, 1), (0, 1), (0, 1)),
    ],
)
def test_a_comparison_is_certain_possible_or_neither(
    a: Any, b: Any, less: Any, less_equal: Any, equal: Any
) -> None:
    one, other = interval(a), interval(b)
    asked = {np.less: less, np.less_equal: less_equal, np.equal: equal}
    asked[np.not_equal] = (1 - equal[1], 1 - equal[0])
    for compare, (certain, possible) in asked.items():
        found = compare(one, other)
        assert (found.low[0], found.high[0]) == (certain, possible), compare
    for compare, (certain, possible) in {np.greater: less, np.greater_equal: less_equal}.items():
        found = compare(other, one)
        assert (found.low[0], found.high[0]) == (certain, possible), compare
