"""Compares published values with their recomputation, each in the digits that were printed."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from decimal import Context, Decimal
from fractions import Fraction

from ..cells.values import Cell, Values
from ..inputs.expected import Expectation
from ..inputs.published import PublishedValue
from ..quantity import Printed
from ..result import verdict_words as words
from ..result.result import Comparison
from ..result.verdict import (
    EXACT,
    NOT_CHECKABLE,
    OTHERWISE,
    REACHABLE,
    UNAMENDED,
    UNEXPECTED,
    UNEXPLAINED,
    UNPINNED,
    UNREASONED,
    Referee,
    Verdict,
)

DIGITS = 15
"""Of a decimal number, how many every double keeps."""


def print_as(value: float, like: Printed) -> str:
    """Print a value as another number was printed: in its unit, with its decimals, shortened as that was.

    Parameters
    ----------
    value : float
        In SI.

    Examples
    --------
    >>> from fractions import Fraction
    >>> print_as(4.15439e-05, Printed("41.61", "um", Fraction("4.161e-5"), Fraction(1, 10**6)))
    '41.54'

    The nearest double to 0.232818234301152496 is a little more than what is rounded up, and a half may have
    gone either way:

    >>> for value, text in (0.232818234301152496, "0.232818234301152"), (0.125, "0.12"), (0.125, "0.13"):
    ...     print_as(value, Printed(text, "1", Fraction(text), Fraction(1)))
    '0.232818234301152'
    '0.12'
    '0.13'
    """
    exact, places = like.of(Fraction(value)), like.decimals
    sign = "-" if exact < 0 else ""
    texts = [sign + _written(abs(digits), places) for digits in _digits(value, exact, like)]
    return next((text for text in texts if Fraction(text) == Fraction(like.text)), texts[0])


def _digits(value: float, exact: Fraction, like: Printed) -> Iterator[int]:
    """What a value is as a number of the last printed digits; another, too, where both would be right.

    `exact`: the value as a number of the printed unit.
    """
    unit = Fraction(10) ** -like.decimals
    if like.mode == "rounded" and like.digits >= DIGITS:
        # It stands for all that rounds to it, of which one may print so.
        for way in (0, -1, 1):
            yield round(like.of(Fraction(value) + way * Fraction(math.ulp(value)) / 2) / unit)
        return
    # A double is a little less or more than the decimal number it stands for: 29.7 is not cut to 29.6.
    near = Fraction(Context(prec=DIGITS).divide(Decimal(exact.numerator), Decimal(exact.denominator))) / unit
    if like.mode == "truncated":
        yield math.trunc(near)
    elif like.mode == "up":
        yield math.ceil(near)
    elif near % 1 == Fraction(1, 2):
        yield from sorted((math.floor(near), math.ceil(near)), key=abs, reverse=True)
    else:
        yield round(near)


def _written(digits: int, places: int) -> str:
    text = str(digits * 10 ** max(0, -places)).zfill(places + 1)
    point = len(text) - places
    return f"{text[:point]}{'.' if places > 0 else ''}{text[point:]}"


def prints_same(value: float, printed: Printed) -> bool:
    """Whether a value in SI prints as it was printed: by value and decimals, whatever the notation.

    >>> from fractions import Fraction
    >>> like = Printed("2.3894e+02", "1", Fraction("238.94"), Fraction(1))
    >>> prints_same(238.94213, like), prints_same(math.nan, like)
    (True, False)
    """
    return math.isfinite(value) and Fraction(print_as(value, printed)) == Fraction(printed.text)


def compare(
    published: tuple[PublishedValue, ...], values: Values, expected: Sequence[Expectation] = ()
) -> tuple[Comparison, ...]:
    """Set every published value beside its cell."""
    cells = [values.cell(value.cell, value.index) for value in published]
    return tuple(
        beside(value, cell, expected=missing_as_expected(cell, values, expected))
        for value, cell in zip(published, cells, strict=True)
    )


def missing_as_expected(cell: Cell, values: Values, expected: Sequence[Expectation]) -> bool:
    """Whether a cell has no value, and somebody expects that, of it or of the cell where the error began."""
    begun = (cell, *([cell.culprit] if cell.culprit else []))
    return cell.value is None and any(
        each.covers(one.name, one.label, values.tests(one)) for each in expected for one in begun
    )


def beside(published: PublishedValue, cell: Cell, *, expected: bool = False) -> Comparison:
    """Set a published number beside a cell that holds what is computed.

    `expected`: whether it is expected that the cell has no value.
    """
    printed = published.printed
    if cell.value is None:
        again, distance, verdict = cell.status.code, None, "not-checkable"
    else:
        again = print_as(cell.value, printed)
        distance = _double((Fraction(cell.value) - printed.value) / (2 * printed.half_unit))
        verdict = "same" if prints_same(cell.value, printed) else "differs"
    finding = "" if expected and not published.expect else _finding(published, again, verdict)
    return Comparison(published, cell, again, distance, verdict, finding)


def _double(number: Fraction) -> float:
    """The nearest double: the largest there is for what is larger."""
    most = Fraction(sys.float_info.max)
    return float(max(-most, min(number, most)))


def _finding(published: PublishedValue, again: str, verdict: str) -> str:
    """What is not as expected, before the referee was asked."""
    if not published.expect:
        return "" if verdict == "same" else UNEXPECTED
    if verdict == "same":
        return UNEXPECTED
    if published.pin is None:
        return UNPINNED
    if not published.pin.holds(published.printed, again):
        return OTHERWISE
    return "" if published.reason else UNREASONED


def refereed(comparisons: tuple[Comparison, ...], found: Referee) -> tuple[Comparison, ...]:
    """Comparisons with what the referee says of each."""
    return tuple(
        replace(comparison, refereed=verdict, finding=_refereed(comparison, verdict, found))
        for comparison, verdict in zip(comparisons, found.values, strict=True)
    )


def _refereed(comparison: Comparison, verdict: Verdict, found: Referee) -> str:
    """What is not as expected: the referee excuses what is reachable, and knows what explains the rest."""
    published = comparison.published
    if not published.expect and verdict.verdict == NOT_CHECKABLE:
        return comparison.finding  # nothing excuses what nobody can recompute
    if not published.expect:
        # That all come out of one input says nothing of a column that may have any value there.
        as_printed = found.as_printed and published.cell not in found.free
        return "" if verdict.verdict in (EXACT, REACHABLE) or as_printed else UNEXPECTED
    if comparison.finding:
        return comparison.finding
    own = (published.source, published.cell, published.index)
    wrong = (change for each in found.misprints for change in each.changes)
    if own in {(change.source, change.cell, change.index) for change in wrong}:
        return UNAMENDED
    return "" if words.holds(published.explained, found.possible_reasons) else UNEXPLAINED
