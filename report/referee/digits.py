"""Digits as they are printed and misprinted."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction

from ..quantity import Printed

DIGITS = "0123456789"


def respelt(of: Printed, units: int) -> Printed:
    """A number so many units of its last digit away, in the same notation.

    Examples
    --------
    >>> from fractions import Fraction
    >>> respelt(Printed("2.97e1", "1", Fraction("29.7"), Fraction(1)), 3).text
    '3.00e1'
    """
    mantissa, e, power = of.text.lower().partition("e")
    places = len(mantissa.partition(".")[2])
    text = f"{Decimal(mantissa) + Decimal(units).scaleb(-places):.{places}f}{e}{power}"
    return replace(of, text=text, value=Fraction(text) * of.scale + of.zero)


def moved(of: Printed, value: Fraction) -> int:
    """How many units of its last digit a value is away from a number, to the nearest."""
    return round((value - of.value) / (2 * of.half_unit))


def slips(text: str) -> Iterator[str]:
    """What one slip makes of a number: two neighbouring digits in each other's place, or another digit.

    Examples
    --------
    >>> list(slips("29.7"))[:3]
    ['92.7', '27.9', '09.7']
    """
    places = [n for n, character in enumerate(text.lower().partition("e")[0]) if character.isdigit()]
    for one, other in itertools.pairwise(places):
        if text[one] != text[other]:
            yield text[:one] + text[other] + text[one + 1 : other] + text[one] + text[other + 1 :]
    for place in places:
        yield from (text[:place] + digit + text[place + 1 :] for digit in DIGITS if digit != text[place])


def is_slip(text: str, other: str) -> bool:
    """Whether a number became another by one slip."""
    return other in slips(text)
