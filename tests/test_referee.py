"""Published values beside their recomputation."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from loopsheet.report.analysis.referee import print_as
from loopsheet.report.build import PAPER, compute
from loopsheet.report.quantity import Printed


def printed(text: str, unit: str = "1", scale: Fraction = Fraction(1)) -> Printed:
    """A printed number without a file."""
    return Printed(text, unit, Fraction(text) * scale, scale)


@pytest.mark.parametrize(
    ("value", "like", "again"),
    [
        (1.2579969787, printed("1.234"), "1.258"),
        (1.2, printed("1.30"), "1.20"),
        (4.15439e-05, printed("41.61", "um", Fraction(1, 10**6)), "41.54"),
        (1524.587, printed("1516"), "1525"),
        (1524.587, printed("15e2"), "1500"),
        (-0.0004, printed("0.12"), "-0.00"),
        (2.5, printed("7"), "2"),
    ],
)
def test_printed_again_in_the_same_digits(value: float, like: Printed, again: str) -> None:
    assert print_as(value, like) == again


@given(st.floats(-1e6, 1e6), st.integers(0, 9))
def test_printing_moves_a_value_by_half_a_digit_at_most(value: float, decimals: int) -> None:
    like = printed("1." + "0" * decimals if decimals else "1")
    assert abs(Fraction(Decimal(print_as(value, like))) - Fraction(value)) <= like.half_unit


def test_the_paper_value_by_value() -> None:
    """All 27 published values are compared; each known difference differs, none is hidden."""
    comparisons = compute(PAPER, prove=False).comparisons
    assert len(comparisons) == 27
    assert {c.published.source for c in comparisons} == {"Table 2", "Table 3", "text"}
    assert all(c.as_expected for c in comparisons)
    first = comparisons[0]
    assert (first.published.printed.text, first.again, first.verdict) == ("1.234", "1.258", "differs")
    assert first.distance == pytest.approx(23.996978731236837, rel=1e-12)
    assert all(c.again in c.published.reason for c in comparisons if c.verdict == "differs")
