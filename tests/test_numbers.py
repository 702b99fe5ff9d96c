"""Numbers and units as they are shown."""

import math
from fractions import Fraction

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from loopsheet.report.result.numbers import (
    at,
    decimals,
    last_place,
    order,
    read,
    rounded,
    shown,
    stated,
    table_format,
    uncertainty,
)
from loopsheet.report.views.units import unit_html, unit_tex

THIN, NARROW = "\u202f", "\u00a0"


@pytest.mark.parametrize(
    ("value", "digits", "plain"),
    [
        (1.25799697873123, 4, "1.258"),
        (2.0, 4, "2.000"),
        (0.5, 3, "0.500"),
        (9.9996, 4, "10.000"),
        (1525.37, 4, "1525"),
        (1525.37, 3, "1525"),  # a zero in place of a known digit would be wrong
        (-0.0003, 1, "-3e-4"),
        (0.00123, 2, "0.0012"),
        (1.019e9, 4, "1.019e9"),
        (321032.0, 3, "3.21e5"),
        (65810.0, 4, "65810"),
        (9.999996e8, 4, "1.000e9"),
        (0.0, 3, "0.00"),
        (-1e-30, 2, "-1.0e-30"),
        (2.5, 1, "3"),  # a half goes up
        (0.0437225, 5, "0.043723"),
        (0.04372249999999999, 5, "0.043723"),  # on whichever side of it the double lies
        (0.0437224999999999, 5, "0.043722"),
        (0.1 + 0.2, 17, "0.30000000000000004"),
    ],
)
def test_significant_digits(value: float, digits: int, plain: str) -> None:
    assert rounded(value, digits).plain == plain


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (1.019e9, 4, f"1.019{NARROW}×{NARROW}10⁹"),
        (-2.5e-7, 2, f"\u22122.5{NARROW}×{NARROW}10⁻⁷"),
        (12345.678, 6, f"12{THIN}345.7"),
        (1516.0, 4, "1516"),
    ],
)
def test_the_eye_gets_a_minus_sign_thin_spaces_and_powers_of_ten(
    value: float, digits: int, text: str
) -> None:
    assert rounded(value, digits).text == text


def test_siunitx_gets_plain_digits() -> None:
    assert rounded(-1.019e9, 4).plain == "-1.019e9"


def test_a_rounded_nothing_has_no_sign() -> None:
    assert decimals(-0.0004, 2).text == "0.00"


NONE = math.nan


@pytest.mark.parametrize(
    ("value", "u", "plain"),
    [
        (1.30264345, 0.00350146, "1.3026"),
        (1.31035710, 0.0196257, "1.310"),
        (50.000838e-3, 31.7e-9, "0.050000838"),
        (0.0034, 0.02, "0.003"),  # u larger than the value: it keeps the place
        (0.0044, 0.2, "0.004"),  # less than the last digit of u: not zero, so it keeps one
        (-0.00044, 0.02, "-4e-4"),
        (3.4e6, 2e7, "3e6"),
        (8.8e11, 3e14, "9e11"),
        (9.99964e9, 2e7, "1.000e10"),
        (9.6e9, 2e12, "1e10"),
        (123.456, 9.96, "123"),  # 9.96 is 10, not 10.0
        (1.23456, 0.0996, "1.23"),  # 0.0996 is 0.10
        (1525.37, 99.6, "1.53e3"),  # a zero before the point would pass for a known digit
        (1525.37, 350.0, "1.53e3"),
        (1525.37, 94.0, "1525"),
        (9.9996, 0.02, "10.000"),
        (6.2e-34, 1e-37, "6.2000e-34"),
        (6.02214076e23, 5e16, "6.02214076e23"),
        (1.0, 1e-25, "1.00000000000000"),  # a double has no more digits
        (0.0, 0.0035, "0.0000"),
        (0.0, 2e-9, "0.0000000000"),
        # certain: without idle zeros
        (0.0, 0.0, "0"),
        (12.0, 0.0, "12"),
        (12.5, 0.0, "12.5"),
        (1500.0, 0.0, "1500"),
        (100000.0, 0.0, "100000"),
        (1 / 3, 0.0, "0.3333"),
        # nothing is known: as many digits as the inputs warrant
        (1.30264345, NONE, "1.303"),
        (12.0, NONE, "12.00"),
        (0.0, NONE, "0.000"),
        (15253.7, NONE, "15254"),
        (1.0, math.inf, "1.000"),
    ],
)
def test_the_digits_of_a_number_follow_from_its_uncertainty(value: float, u: float, plain: str) -> None:
    assert at(value, last_place(value, u, 4)).plain == plain


@pytest.mark.parametrize(
    ("u", "one", "two"),
    [
        (9.96, "1e1", "10"),
        (0.0996, "0.1", "0.10"),
        (0.96, "1", "0.96"),
        (0.949, "1", "0.95"),  # 0.9 would be more than 5 % less; rounded up, it has still one digit
        (0.951, "1", "0.95"),
        (0.0104, "0.01", "0.010"),
        (0.0106, "0.02", "0.011"),
        (0.0105, "0.01", "0.011"),
        (0.475, "0.5", "0.48"),  # a half goes up, on whichever side of it the double lies
        (0.0475, "0.05", "0.048"),
        (0.47499999999999987, "0.5", "0.48"),
        (0.474999, "0.5", "0.47"),  # no half in six digits
        (2.0, "2", "2.0"),
        (5e-324, "5e-324", "4.9e-324"),
    ],
)
def test_an_uncertainty_has_at_most_two_digits_and_never_loses_a_twentieth(
    u: float, one: str, two: str
) -> None:
    assert [uncertainty(u, most).plain for most in (1, 2)] == [one, two]


@given(st.floats(1e-300, 1e300), st.sampled_from([1, 2]))
def test_rounding_makes_no_uncertainty_smaller_by_more_than_a_twentieth(u: float, most: int) -> None:
    figure = uncertainty(u, most)
    assert Fraction(figure.plain) >= Fraction(u) * Fraction(95, 100)
    assert len((figure.whole + figure.fraction).strip("0")) <= most


@given(st.floats(-1e12, 1e12), st.floats(1e-9, 1e9), st.sampled_from([1, 2]))
def test_a_value_is_stated_as_it_is_shown_alone(value: float, u: float, most: int) -> None:
    both, alone = stated(value, u, most)[0], at(value, last_place(value, u, 4, most))
    if abs(value) > u:
        assert Fraction(both.plain) == Fraction(alone.plain)
    if abs(value) > 2 * u and order(value) == order(float(alone.plain)):
        assert both == alone


@given(
    st.floats(allow_nan=False, allow_infinity=False), st.integers(1, 17), st.sampled_from([None, True, False])
)
def test_rounding_moves_no_value_by_more_than_half_a_unit_of_its_last_digit(
    value: float, digits: int, scientific: bool | None
) -> None:
    place = order(value) - digits + 1
    figure, unit = at(value, place, scientific), Fraction(10) ** place
    off = Fraction(10) ** (order(value) - 14) / 2  # of the fifteen digits that tell whether it is a half
    assert abs(Fraction(figure.plain) - Fraction(value)) <= unit / 2 + (off if digits < 15 else 0)
    last = Fraction(10) ** ((figure.exponent or 0) - len(figure.fraction))
    carried = figure.exponent is not None and figure.exponent > order(value)
    assert last == (unit * 10**carried if figure.exponent is not None else min(unit, 1))


@example(999999999999.5, 10)
@given(st.floats(allow_nan=False, allow_infinity=False, min_value=1e-12, max_value=1e12), st.integers(1, 12))
def test_as_many_digits_as_asked_for(value: float, digits: int) -> None:
    figure = rounded(value, digits)
    shown_digits = len((figure.whole + figure.fraction).lstrip("0"))
    carried = figure.exponent is None and order(float(figure.plain)) > order(value)  # 9.9996 to 10.000
    assert digits + carried <= shown_digits <= digits + 2 + carried


def test_a_column_has_one_notation() -> None:
    plain = [figure.plain for figure in shown([9.5e8, 1.2e3, None], [6, 1, 0]) if figure is not None]
    assert plain == ["9.50e8", "1.20e3"]
    assert shown([None], [0]) == (None,)
    assert [figure.plain for figure in shown([41.6, 5.0], [-1, -3]) if figure] == ["41.6", "5.000"]


@pytest.mark.parametrize(
    ("texts", "form"),
    [
        (["2.334", "-51.0"], "-2.3"),
        (["1516"], "4"),
        (["1.5e-10", "2e9"], "1.1e-2"),
        ([], "1"),
    ],
)
def test_columns_of_siunitx_are_as_wide_as_their_numbers(texts: list[str], form: str) -> None:
    assert table_format(map(read, texts)) == form


@pytest.mark.parametrize("text", ["2.940", "0.530", "-12", "1.50e-3"])
def test_printed_numbers_are_read_as_they_stand(text: str) -> None:
    figure = read(text)
    assert figure is not None
    assert figure.plain == text


@pytest.mark.parametrize("text", [".5", "5.", "+3", "1_000", "٣", "nan", ""])
def test_other_spellings_are_left_as_text(text: str) -> None:
    assert read(text) is None


@pytest.mark.parametrize(
    ("unit", "in_html", "in_tex"),
    [
        ("1", "1", "1"),
        ("um", "µm", r"\unit{\text{\textmu}m}"),
        ("m/s", "m/s", r"\unit{m/s}"),
        ("kg/m^3", "kg/m³", r"\unit{kg/m^{3}}"),
        ("uT^2 / m", "µT²/m", r"\unit{\text{\textmu}T^{2}/m}"),
        ("kg m**-3", f"kg{THIN}m⁻³", r"\unit{kg.m^{-3}}"),
        ("m·s⁻¹", f"m{THIN}s⁻¹", r"\unit{m.s^{-1}}"),
        ("inch", "inch", r"\unit{inch}"),
        ("%", "%", r"\unit{\text{\%}}"),
        ("W/(m^2 K^4)", f"W/(m²{THIN}K⁴)", r"\unit{W/\text{(}m^{2}.K^{4}\text{)}}"),
        ("(kg/m^3)^2", "(kg/m³)²", r"\unit{\text{(}kg/m^{3}\text{)}^{2}}"),
        ("N/m^(3/2)", "N/m<sup>3/2</sup>", r"\unit{N/m^{3/2}}"),
        ("MPa m^0.5", f"MPa{THIN}m<sup>0.5</sup>", r"\unit{MPa.m^{0.5}}"),
        ("N/m^alpha", "N/m<sup>alpha</sup>", r"\unit{N/m^{alpha}}"),
        ("<b>", "&lt;b&gt;", r"\unit{\text{\textless{}}b\text{\textgreater{}}}"),
    ],
)
def test_units(unit: str, in_html: str, in_tex: str) -> None:
    assert (unit_html(unit), unit_tex(unit)) == (in_html, in_tex)
