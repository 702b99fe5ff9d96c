"""Numbers and units as they are shown."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from loopsheet.report.document.numbers import (
    decimals,
    read,
    rounded,
    shown,
    table_format,
)
from loopsheet.report.views.units import unit_html, unit_tex

THIN, NARROW = "\u202f", "\u00a0"


@pytest.mark.parametrize(
    ("value", "digits", "plain"),
    [
        (1.25799697873123, 4, "1.258"),
        (2.0, 4, "2.000"),
        (0.5, 3, "0.500"),
        (9.9996, 4, "10.00"),
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
        (2.5, 1, "2"),  # the exact half goes to the even digit
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
    assert rounded(-1.019e9, 4).tex == r"\num{-1.019e9}"


def test_a_rounded_nothing_has_no_sign() -> None:
    assert decimals(-0.0004, 2).text == "0.00"


@given(
    st.floats(allow_nan=False, allow_infinity=False), st.integers(1, 17), st.sampled_from([None, True, False])
)
def test_rounding_moves_no_value_by_more_than_half_a_unit_of_its_last_digit(
    value: float, digits: int, scientific: bool | None
) -> None:
    figure = rounded(value, digits, scientific)
    unit = Fraction(10) ** ((figure.exponent or 0) - len(figure.fraction))
    assert abs(Fraction(figure.plain) - Fraction(value)) <= unit / 2


@given(st.floats(allow_nan=False, allow_infinity=False, min_value=1e-12, max_value=1e12), st.integers(1, 12))
def test_as_many_digits_as_asked_for(value: float, digits: int) -> None:
    figure = rounded(value, digits)
    shown_digits = len((figure.whole + figure.fraction).lstrip("0"))
    assert digits <= shown_digits <= digits + 2


def test_a_column_has_one_notation() -> None:
    plain = [figure.plain for figure in shown([9.5e8, 1.2e3, None], 1.0, 3) if figure is not None]
    assert plain == ["9.50e8", "1.20e3"]
    assert shown([None], 1.0, 3) == [None]


def test_a_column_is_shown_in_its_unit() -> None:
    assert [f.plain for f in shown([3.4e-5, 4.154e-5], 1e-6, 4) if f] == ["34.00", "41.54"]


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
        ("kg m**-3", f"kg{THIN}m⁻³", r"\unit{kg.m^{-3}}"),
        ("m·s⁻¹", f"m{THIN}s⁻¹", r"\unit{m.s^{-1}}"),
        ("inch", "inch", r"\unit{inch}"),
        ("%", "%", r"\unit{\text{\%}}"),
        ("N/m^alpha", "N/m<sup>alpha</sup>", r"\unit{N/m^{alpha}}"),
        ("<b>", "&lt;b&gt;", r"\unit{\text{\textless{}}b\text{\textgreater{}}}"),
    ],
)
def test_units(unit: str, in_html: str, in_tex: str) -> None:
    assert (unit_html(unit), unit_tex(unit)) == (in_html, in_tex)
