"""Compares published values with their recomputation, each in the digits that were printed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from decimal import ROUND_DOWN, ROUND_HALF_EVEN, Decimal, localcontext
from fractions import Fraction

from ...published import PublishedValue
from ...quantity import Printed
from ...result import Comparison
from ...values import Values
from ...verdict import EXACT, REACHABLE, WITHIN, Explanation, Referee, Verdict

__all__ = ["compare", "print_as", "prints_same", "refereed"]


def print_as(value: float, like: Printed) -> str:
    """Print a value as another number was printed: in its unit, with its decimals, rounded or truncated.

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
        how = ROUND_DOWN if like.mode == "truncated" else ROUND_HALF_EVEN
        return f"{exact.quantize(Decimal(1).scaleb(-like.decimals), rounding=how):f}"


def prints_same(value: float, printed: Printed) -> bool:
    """Whether a value in SI prints as it was printed."""
    return Decimal(print_as(value, printed)) == Decimal(printed.text)


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
    verdict = "same" if prints_same(cell.value, printed) else "differs"
    return Comparison(
        published,
        cell,
        again,
        distance,
        verdict,
        as_expected=(verdict == "differs") == (published.expect == "differs"),
    )


def refereed(comparisons: tuple[Comparison, ...], found: Referee) -> tuple[Comparison, ...]:
    """Comparisons with what the referee says of each."""
    return tuple(
        replace(comparison, refereed=verdict, as_expected=_as_expected(comparison, verdict, found.misprints))
        for comparison, verdict in zip(comparisons, found.values, strict=True)
    )


def _as_expected(comparison: Comparison, verdict: Verdict, misprints: Sequence[Explanation]) -> bool:
    """A known difference must differ, and only as is known; anything else must be possible."""
    published = comparison.published
    if published.expect == "differs":
        own = (published.source, published.cell, published.index)
        return comparison.verdict == "differs" and own not in {(m.source, m.cell, m.index) for m in misprints}
    return verdict.verdict in (EXACT, REACHABLE, WITHIN)
