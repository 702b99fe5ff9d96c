"""Numbers as they were printed, and what values a quantity may have.

A printed number is a string first: ``2.940`` says more than ``2.94``. Its value is kept as an exact
fraction in SI, so that no engine starts from another engine's rounding.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ..derivations.unit_text import parse_open
from .distribution import Error, Shape

if TYPE_CHECKING:
    from collections.abc import Iterable

LARGEST = 2**1024 - 2**970
"""What is no smaller than this rounds to no finite double."""
SMALLEST = 2.0**-1022
"""Below, doubles lose digits, and some programs hold zero: a positive quantity has no value there."""


def behind(unit: str) -> str:
    """A unit as it stands behind a number, with a space; nothing of a pure number.

    >>> behind("um"), behind("1")
    (' um', '')
    """
    return "" if unit == "1" else f" {unit}"


def span(low: str, high: str) -> str:
    """An interval in words, of which an end may be missing.

    >>> span("1.25", "1.35"), span("", "1.35 mm")
    ('1.25 to 1.35', 'at most 1.35 mm')
    """
    return f"{low} to {high}" if low and high else f"at least {low}" if low else f"at most {high}"


@dataclass(frozen=True)
class Bounds:
    """The values that are allowed for an input, in SI, as data."""

    low: float | None = None
    high: float | None = None
    """`low` and `high`: the ends of the interval; None is no end."""
    low_open: bool = False
    high_open: bool = False
    """`low_open` and `high_open`: whether the end itself is excluded."""
    integer: bool = False
    """Whether only whole numbers are allowed."""

    def allow(self, value: Fraction | float) -> bool:
        """Tell whether a value lies inside; what is not finite never does."""
        if not math.isfinite(value) or (self.integer and value != math.floor(value)):
            return False
        # The ends are meant as they are written: the double 0.1 is a little more than a printed 0.1.
        low, high = (
            end if end is None or isinstance(value, float) else Fraction(repr(end))
            for end in (self.low, self.high)
        )
        if low is not None and (value < low or (self.low_open and value == low)):
            return False
        return not (high is not None and (value > high or (self.high_open and value == high)))

    def over(self, scale: Fraction, zero: Fraction = Fraction(0)) -> Bounds:
        """The same in a unit of that size, whose zero is that in SI."""

        def end(value: float | None) -> float | None:
            return None if value is None else float((Fraction(repr(value)) - zero) / scale)

        return replace(self, low=end(self.low), high=end(self.high))

    def clip(self, low: float, high: float) -> tuple[float, float]:
        """What is left of an interval."""
        low = low if self.low is None else max(low, self.low)
        return low, (high if self.high is None else min(high, self.high))

    def within(self, scale: Fraction, zero: Fraction = Fraction(0)) -> Bounds:
        """The same in SI, of bounds in such a unit: what they allowed as written, they allow."""

        def end(value: float | None, outwards: float) -> float | None:
            if value is None:
                return None
            exact = Fraction(repr(value)) * scale + zero
            near = float(exact)
            inside = (Fraction(repr(near)) - exact) * (1 if outwards < 0 else -1) > 0
            return math.nextafter(near, outwards) if inside else near

        return replace(self, low=end(self.low, -math.inf), high=end(self.high, math.inf))

    def said(self, unit: str) -> str:
        """What is allowed, in a unit."""
        size, open_ends = parse_open(unit), self.low is None and self.high is None
        return f"{self.over(size.scale, size.zero)}{' in' * (open_ends and unit != '1')}{behind(unit)}"

    def __str__(self) -> str:
        """Say what is allowed, as the end of the sentence "it must be ..."."""
        kind = "a whole number " if self.integer else ""
        low = None if self.low is None else f"{self.low:.15g}"
        high = None if self.high is None else f"{self.high:.15g}"
        if low is not None and high is not None and not (self.low_open or self.high_open):
            return f"{kind}between {low} and {high}"
        parts = []
        if low is not None:
            parts.append(f"greater than {low}" if self.low_open else f"at least {low}")
        if high is not None:
            parts.append(f"less than {high}" if self.high_open else f"at most {high}")
        return kind + " and ".join(parts) if parts else (kind or "any number").strip()


POISSON = Bounds(low=0, high=0.5)
"""Of no change of breadth, and of none of volume."""


@dataclass(frozen=True)
class Printed:
    """A number as it was printed: its digits are data."""

    text: str
    """The digits as printed, ``"2.940"``."""
    unit: str
    """The unit as printed, ``"um"``; ``"1"`` for a pure number."""
    value: Fraction
    """The exact value in SI."""
    scale: Fraction
    """One printed unit in SI (1/1000000 for ``um``)."""
    mode: str = "rounded"
    """How it was shortened: ``"rounded"`` or ``"truncated"``; ``"up"`` of a published uncertainty that
    was rounded up, so that it promises no more (JCGM 100, 7.2.6)."""
    stated: tuple[Error, ...] | None = None
    """The errors that the user stated, each independent of all others; none of them if it is exact. Without a
    statement the digits say it."""
    where: str = ""
    """``file:line:column``, for messages and for tracing."""
    zero: Fraction = Fraction(0)
    """Zero of that unit in SI (273.15 for ``degC``)."""

    def of(self, value: Any) -> Any:
        """A value in SI, a fraction or a double, as a number of its unit."""
        return (value - self.zero) / self.scale

    @property
    def number(self) -> Fraction:
        """What is printed, as a number of its unit."""
        return Fraction(self.of(self.value))

    @property
    def decimals(self) -> int:
        """Decimal places as printed: 3 for ``2.940``, -2 for ``12e2``."""
        mantissa, _, exponent = self.text.lower().partition("e")
        return len(mantissa.partition(".")[2]) - int(exponent or 0)

    @property
    def digits(self) -> int:
        """Significant digits as printed: 4 for ``2.940``; zeros count unless they lead."""
        mantissa = self.text.lower().partition("e")[0]
        return len(mantissa.replace(".", "").lstrip("+-").lstrip("0")) or 1

    @cached_property
    def half_unit(self) -> Fraction:
        """Half a unit of the last printed digit, in SI."""
        return self.scale * Fraction(1, 2) * Fraction(10) ** -self.decimals

    @cached_property
    def interval(self) -> tuple[Fraction, Fraction]:
        """The least and the largest value in SI that print so, ends included.

        Half a unit of the last digit to both sides if it was rounded; a whole unit away from zero if it
        was truncated.
        """
        if self.mode == "truncated":
            away = -2 * self.half_unit if self.text.startswith("-") else 2 * self.half_unit
            return min(self.value, self.value + away), max(self.value, self.value + away)
        return self.value - self.half_unit, self.value + self.half_unit

    @cached_property
    def spread(self) -> tuple[float, float]:
        """The middle of what prints so, and half of its width, as doubles in SI."""
        return float(sum(self.interval) / 2), float(self.half_unit)

    @property
    def errors(self) -> tuple[Error, ...]:
        """Its errors: the stated ones, else that of the digits.

        The printed value stands for an interval one last-digit unit wide, whether it was rounded or
        truncated: rectangular, half a unit to both sides of its middle (JCGM 100, 4.3.7).
        """
        return (Error(self.half_unit, Shape.RECTANGULAR),) if self.stated is None else self.stated

    @property
    def shift(self) -> Fraction:
        """How much the expectation is larger than what is printed, in SI; half a unit if it was truncated."""
        return sum(self.interval, Fraction(0)) / 2 - self.value if self.stated is None else Fraction(0)

    @property
    def u(self) -> float:
        """Standard uncertainty in SI, of all its errors."""
        return math.hypot(*(error.u for error in self.errors))


def there(numbers: Iterable[Printed | None]) -> tuple[Printed, ...]:
    """Those of a column that are there: a cell may be empty."""
    return tuple(number for number in numbers if number is not None)
