"""What is known of an error: its distribution, as JCGM 100 and JCGM 101 describe what is known of a quantity.

A width is kept exactly as it was said; the standard uncertainty is made of it where it is asked for.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from fractions import Fraction
from types import MappingProxyType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .laws import Law

LEVEL = 0.95
"""The coverage probability that is stated where nobody asks for another; 0.9545 is another one."""
SCATTER = "scatter"
"""How it is stated that a column of readings has their own standard deviation."""
MOST_DOF = 10**9
"""More degrees of freedom are as good as infinitely many, and no spreadsheet takes them."""
DOMINANT = 0.3
"""One source dominates where all others together are at most so much of it (EA-4/02, S9.14)."""


class Shape(StrEnum):
    """How an error is distributed; its width is half of what it may be, without ends its standard deviation.

    A Student t has the width s / sqrt(n) of JCGM 100 (4.2.3): the scale, not the standard deviation. What the
    word does not tell whole, from the truncated normal on, has a law; convolved is what a sum of errors is.
    """

    NORMAL = "normal"
    STUDENT = "t"
    RECTANGULAR = "rectangular"
    TRIANGULAR = "triangular"
    ARCSINE = "arcsine"
    TRUNCATED = "truncated normal"
    EXPONENTIAL = "exponential"
    SAMPLES = "samples"
    CONVOLVED = "convolved"


DIVISORS: Mapping[Shape, float] = MappingProxyType(
    {
        Shape.NORMAL: 1.0,
        Shape.STUDENT: 1.0,
        Shape.RECTANGULAR: math.sqrt(3),
        Shape.TRIANGULAR: math.sqrt(6),
        Shape.ARCSINE: math.sqrt(2),
        Shape.TRUNCATED: 1.0,
        Shape.EXPONENTIAL: 1.0,
        Shape.SAMPLES: 1.0,
        Shape.CONVOLVED: 1.0,
    }
)
"""The width over the standard uncertainty (JCGM 100, 4.3.7, 4.3.9; JCGM 101, 6.4.6)."""
SHARES: Mapping[Shape, Callable[[float], float]] = MappingProxyType(
    {
        Shape.RECTANGULAR: lambda x: x,
        Shape.TRIANGULAR: lambda x: 1 - (1 - x) ** 2,
        Shape.ARCSINE: lambda x: 2 / math.pi * math.asin(x),
    }
)
"""The share of a distribution with ends that lies within a part of its width."""
PARTS: Mapping[Shape, Callable[[float], float]] = MappingProxyType(
    {
        Shape.RECTANGULAR: lambda p: p,
        Shape.TRIANGULAR: lambda p: 1 - math.sqrt(1 - p),
        Shape.ARCSINE: lambda p: math.sin(p * math.pi / 2),
    }
)
"""The other way round: which part of the width holds the middle share p."""
FOURTH: Mapping[Shape, float] = MappingProxyType(
    {Shape.RECTANGULAR: 9 / 5, Shape.TRIANGULAR: 12 / 5, Shape.ARCSINE: 3 / 2}
)
"""The fourth moment over the square of the variance; 3 for a normal error, as JCGM 100 takes all errors."""


@dataclass(frozen=True)
class Error:
    """One error of a number, or of several."""

    width: Fraction
    """In SI, at least 0: half of the range, or the standard uncertainty itself where there are no ends."""
    shape: Shape = Shape.NORMAL
    dof: float = math.inf
    """Degrees of freedom of the standard uncertainty; infinite where it is known."""
    said: str = ""
    """How it was stated; empty if it follows from printed digits."""
    sample: str = ""
    """What its standard uncertainty was estimated from, by a name that others of the same estimate have:
    their degrees of freedom are the same ones. Empty for an estimate of its own."""
    law: Law | None = None
    """How it is distributed, where the shape does not tell it whole."""
    where: str = field(default="", compare=False)
    """``file:line:column`` of what states it of one number alone; empty elsewhere."""

    @property
    def table(self) -> str:
        """The table of draws that it is of; empty if there is none."""
        return self.law.table if self.law else ""

    @property
    def u(self) -> float:
        """The standard uncertainty, in SI.

        >>> Error(Fraction(1, 2), Shape.RECTANGULAR).u
        0.2886751345948129
        """
        return float(self.width) / DIVISORS[self.shape]
