"""Numbers as text: plain decimal notation, exactly, and nothing else."""

from decimal import Decimal
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from loopsheet.derivations.unit_text import parse_unit
from loopsheet.report.inputs.number_text import NumberError, read_number, read_printed


@pytest.mark.parametrize(
    "text", ["0", "2.940", "-3", "+.5", "7.", "1e3", "1.25E-7", "0e5", "00.10", "1e-300", "9" * 100]
)
def test_numbers_are_exact(text: str) -> None:
    assert read_number(text) == Fraction(Decimal(text))


@given(st.decimals(allow_nan=False, allow_infinity=False, places=6))
def test_decimals_come_back_exactly(number: Decimal) -> None:
    assert read_number(str(number)) == Fraction(number)


REFUSED = {
    "LS401": [
        "abc", "1_000", "0x10", "1e", "e5", ".", "+", "--1", "1.2.3", "1 000", "１", "٣", "−1", "1/2", "1+1",
        "2.3 mm", "1e5.5", "\x00", "½", "1d5", "0b1", "1j", "True", "__import__('os')", "9**9", "$5", "~5",
        "5%", "<3", "1.0,60", "1,5.70", "12,34.5", "0.234,5", "1.2.3,4",
    ],
    "LS402": ["2,334", "-0,5", "1.002,5", "1,002.5", "1 002,5", ",5", "1,5e3"],
    "LS403": [""],
    "LS404": ["nan", "NaN", "-nan", "inf", "-Infinity", "∞", "#N/A", "#DIV/0!"],
    "LS405": ["1" * 101, "1e301", "1e-301", "1e99999999999", "1e-99999999999", "1e" + "9" * 90, "x" * 101],
}  # fmt: skip


@pytest.mark.parametrize(
    ("code", "text"), [(code, text) for code, texts in REFUSED.items() for text in texts]
)
def test_anything_else_is_refused_with_its_reason(code: str, text: str) -> None:
    with pytest.raises(NumberError) as caught:
        read_number(text)
    assert caught.value.code == code


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("\u22120.35", "write the minus sign as an ordinary hyphen"),
        ("<0.05", "what is beyond a limit has no number"),
        ("\u2265 12", "what is beyond a limit has no number"),
        ("1.0,60", "are these two numbers, each for a column?"),
        ("12,34.5", "are these two numbers, each for a column?"),
        ("\u2013", "in a table of measurements the cell of what was not measured is empty"),
    ],
)
def test_what_is_no_number_is_told_how_to_be_one(text: str, hint: str) -> None:
    with pytest.raises(NumberError) as caught:
        read_number(text)
    assert caught.value.fields["suggestion"].startswith(hint)


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        ("2,334", "2.334"),
        ("1.002,5", "1002.5"),
        ("1,002.5", "1002.5"),
        ("1 002,5", "1002.5"),
        ("1.002.003,5", "1002003.5"),
        ("1,002,003.5", "1002003.5"),
        ("-0,5", "-0.5"),
        ("\u22120,35", "-0.35"),
    ],
)
def test_a_decimal_comma_is_shown_as_it_should_be_written(text: str, plain: str) -> None:
    with pytest.raises(NumberError) as caught:
        read_number(text)
    assert caught.value.fields["example"] == plain
    both = {"2,334": " or '2334', whichever is meant"}
    assert caught.value.fields["thousands"] == both.get(text, "")


@given(st.text(max_size=120))
def test_any_text_is_a_number_or_refused(text: str) -> None:
    value = code = None
    try:
        value = read_number(text)
    except NumberError as error:
        code = error.code
    assert code in REFUSED or value == Fraction(text)


def test_a_printed_number_keeps_digits_unit_and_exact_value() -> None:
    number = read_printed("23.50", parse_unit("um"), mode="truncated", where="m.csv:2:3")
    assert (number.text, number.unit, number.mode, number.where) == ("23.50", "um", "truncated", "m.csv:2:3")
    assert number.value == Fraction(235, 10**7)
    assert number.half_unit == Fraction(5, 10**9)


@pytest.mark.parametrize(
    ("text", "unit"), [("1e300", "km"), ("1e-298", "mm"), ("1.0000e-298", "1"), ("0.0e-300", "1")]
)
def test_what_no_double_could_hold_in_si_is_refused(text: str, unit: str) -> None:
    with pytest.raises(NumberError) as caught:
        read_printed(text, parse_unit(unit))
    assert caught.value.code == "LS405"


@given(st.from_regex(r"[0-9]{1,20}(\.[0-9]{0,20})?(e-?[0-9]{1,3})?", fullmatch=True))
def test_every_printed_number_has_a_finite_double_and_a_positive_uncertainty(text: str) -> None:
    number, code = None, ""
    try:
        number = read_printed(text, parse_unit("um"))
    except NumberError as error:
        code = error.code
    if number is None:
        assert code == "LS405"
        return
    assert float(number.value) < float("inf")
    assert number.u > 0
    assert number.text == text
