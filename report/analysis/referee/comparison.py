"""Compares published values with their recomputation, each in the digits that were printed."""

from __future__ import annotations

from decimal import ROUND_HALF_EVEN, Decimal, localcontext
from fractions import Fraction

from ..published import PublishedValue
from ..quantity import Printed
from ..result import Comparison
from ..values import Values

__all__ = ["compare", "print_as"]


def print_as(value: float, like: Printed) -> str:
    """Print a value as another number was printed: in its unit, with its decimals.

    Parameters
    ----------
    value : float
        In SI.
    like : Printed

    Examples
    --------
    >>> from fractions import Fraction
    >>> print_as(4.15439e-05, Printed("41.61", "um", Fraction("4.161e-5"), Fraction(1, 10**6)))
    '41.54'
    """
    in_unit = Fraction(value) / like.scale
    with localcontext() as context:
        context.prec = 60
        exact = Decimal(in_unit.numerator) / Decimal(in_unit.denominator)
        return f"{exact.quantize(Decimal(1).scaleb(-like.decimals), rounding=ROUND_HALF_EVEN):f}"


def compare(published: tuple[PublishedValue, ...], values: Values) -> tuple[Comparison, ...]:
    """Set every published value beside its cell."""
    return tuple(_compare(value, values) for value in published)


def _compare(published: PublishedValue, values: Values) -> Comparison:
    cell = values.cell(published.cell, published.index)
    if cell.value is None:
        return Comparison(published, cell, cell.status.code, None, "not-checkable", as_expected=False)
    printed = published.printed
    again = print_as(cell.value, printed)
    distance = float((Fraction(cell.value) - printed.value) / (2 * printed.half_unit))
    verdict = "same" if Decimal(again) == Decimal(printed.text) else "differs"
    return Comparison(
        published,
        cell,
        again,
        distance,
        verdict,
        as_expected=(verdict == "differs") == (published.expect == "differs"),
    )
