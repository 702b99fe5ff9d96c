"""Printed numbers keep their digits; bounds are data."""

import math
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from loopsheet.report.distribution import Error
from loopsheet.report.quantity import Bounds, Printed

DIGITS = st.text("0123456789", min_size=1, max_size=12)


@st.composite
def numbers(draw: st.DrawFn) -> str:
    """Draw a number as a publication may print it."""
    sign, whole, exponent = draw(st.sampled_from(["", "-", "+"])), draw(DIGITS), ""
    fraction = draw(st.one_of(st.just(""), st.just("."), DIGITS.map(lambda digits: f".{digits}")))
    if draw(st.booleans()):
        exponent = draw(st.sampled_from("eE")) + str(draw(st.integers(-30, 30)))
    return sign + whole + fraction + exponent


def printed(text: str, scale: Fraction = Fraction(1), u: Fraction | None = None) -> Printed:
    return Printed(text, "u", Fraction(text) * scale, scale, stated=None if u is None else (Error(u),))


@given(numbers())
def test_decimals_and_digits_are_those_of_the_decimal_module(text: str) -> None:
    number, told = printed(text), Decimal(text).as_tuple()
    assert number.decimals == -int(told.exponent)
    # decimal keeps the zeros in front of a number's first digit only where it is zero
    assert number.digits == (len(told.digits) if any(told.digits) else 1)


@pytest.mark.parametrize(
    ("text", "decimals", "digits", "half_unit"),
    [
        ("2.940", 3, 4, "0.0005"),
        ("2.94", 2, 3, "0.005"),
        ("0.0235", 4, 3, "0.00005"),
        ("-12.5", 1, 3, "0.05"),
        ("+.50", 2, 2, "0.005"),
        ("100", 0, 3, "0.5"),
        ("1.", 0, 1, "0.5"),
        ("12e2", -2, 2, "50"),
        ("1.20E-3", 5, 3, "0.000005"),
        ("0.00", 2, 1, "0.005"),
    ],
)
def test_what_the_digits_say(text: str, decimals: int, digits: int, half_unit: str) -> None:
    number = printed(text)
    assert (number.decimals, number.digits, number.half_unit) == (decimals, digits, Fraction(half_unit))


def test_half_a_unit_is_in_si() -> None:
    assert printed("23.5", Fraction(1, 10**6)).half_unit == Fraction(5, 10**8)


def test_the_digits_give_a_rectangular_uncertainty_and_a_given_one_wins() -> None:
    assert printed("2.940").u == 0.0005 / math.sqrt(3)
    assert printed("2.940", u=Fraction(1, 500)).u == 0.002


@pytest.mark.parametrize(("text", "shift"), [("2.94", "0.005"), ("-2.94", "-0.005")])
def test_what_was_truncated_is_expected_half_a_unit_further_from_zero(text: str, shift: str) -> None:
    number = replace(printed(text), mode="truncated")
    assert (number.shift, number.u) == (Fraction(shift), 0.005 / math.sqrt(3))
    assert printed(text).shift == replace(number, stated=(Error(Fraction(1)),)).shift == 0


def test_errors_add_in_squares_and_what_is_exact_has_none() -> None:
    number = replace(printed("2.940"), stated=(Error(Fraction(3)), Error(Fraction(4))))
    assert number.u == 5
    assert replace(number, stated=()).u == 0


@pytest.mark.parametrize(
    ("bounds", "inside", "outside", "sentence"),
    [
        (Bounds(), ["-1e300", "0"], [], "any number"),
        (Bounds(0, 1), ["0", "1", "0.5"], ["-1e-99", "1.0000000000000000001"], "between 0 and 1"),
        (Bounds(low=0, low_open=True), ["1e-300"], ["0", "-1"], "greater than 0"),
        (Bounds(low=2), ["2"], ["1.9"], "at least 2"),
        (Bounds(high=2), ["2"], ["2.1"], "at most 2"),
        (Bounds(high=2, high_open=True), ["1.9"], ["2"], "less than 2"),
        (Bounds(0, 1, low_open=True), ["1"], ["0"], "greater than 0 and at most 1"),
        (Bounds(1, integer=True), ["1", "2"], ["0", "1.5"], "a whole number at least 1"),
        (Bounds(1, 5, integer=True), ["5"], ["6", "4.5"], "a whole number between 1 and 5"),
        (Bounds(integer=True), ["-3"], ["0.5"], "a whole number"),
    ],
)
def test_bounds(bounds: Bounds, inside: list[str], outside: list[str], sentence: str) -> None:
    assert [text for text in inside if not bounds.allow(Fraction(text))] == []
    assert [text for text in outside if bounds.allow(Fraction(text))] == []
    assert str(bounds) == sentence


def test_what_is_allowed_is_said_in_a_unit() -> None:
    assert Bounds(0, 1, low_open=True).said("deg") == "greater than 0 and at most 57.2957795130823 deg"
    assert [Bounds().said(unit) for unit in ("deg", "1")] == ["any number in deg", "any number"]


def test_a_double_is_held_to_doubles_and_is_finite() -> None:
    assert Bounds(0, 0.1).allow(0.1)
    assert not Bounds(0, 0.1, high_open=True).allow(0.1)
    assert not any(Bounds().allow(x) for x in (math.nan, math.inf, -math.inf))
    assert [Bounds(integer=True).allow(x) for x in (1e300, 2.5)] == [True, False]


def test_bounds_in_another_unit() -> None:
    assert Bounds(0, 0.5, low_open=True).over(Fraction(1, 1000)) == Bounds(0, 500, low_open=True)
    assert Bounds(0, 0.5).said("m") == "between 0 and 0.5 m"
    assert Bounds(low=2).said("1") == "at least 2"


def test_what_is_left_of_an_interval() -> None:
    assert Bounds(0, 1).clip(-0.05, 0.05) == (0, 0.05)
    assert Bounds(0, 1).clip(0.995, 1.005) == (0.995, 1)
    assert Bounds().clip(-1.0, 1.0) == (-1, 1)


def test_an_end_means_the_decimal_that_is_written_not_its_double() -> None:
    assert Bounds(0.1, 0.3).allow(Fraction("0.1"))
    assert Bounds(0.1, 0.3).allow(Fraction("0.3"))
    assert not Bounds(0.1, low_open=True).allow(Fraction("0.1"))
    assert str(Bounds(0.123456789, 1e-9)) == "between 0.123456789 and 1e-09"
