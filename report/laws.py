"""Distributions of an error that the word for a shape does not tell whole, in standard uncertainties.

The error is what the quantity is more than the number that was given, which need not be its expectation: a
normal distribution that is cut off at one end has its mean on the other side.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_NODES = 200
_NARROW = 1e-6
"""Between ends that are so near, in standard deviations, a normal distribution is level to 12 digits."""
_FAR = 12.0
"""Beyond so many standard deviations a normal distribution holds less than a double can tell of 1."""


class Law(ABC):
    """A distribution with the standard deviation 1.

    Attributes
    ----------
    table : str
        What else is drawn with it, row by row; empty if it is drawn for itself.
    """

    table: str = ""

    @property
    @abstractmethod
    def mean(self) -> float:
        """How far the expectation is from the given number."""

    @abstractmethod
    def moment(self, power: int) -> float:
        """The third central moment, or the fourth."""

    @abstractmethod
    def below(self, z: float) -> float:
        """The probability that the error is at most z."""

    def above(self, z: float) -> float:
        """The probability that the error is larger than z."""
        return 1 - self.below(z)

    @abstractmethod
    def quantile(self, shares: Array) -> Array:
        """The errors that so many are below: of random numbers from 0 to 1, draws."""

    def half(self, level: float) -> float:
        """The half-width of the interval around the given number that holds so much.

        >>> round(Exponential().half(0.95), 4)
        1.9957
        """
        low, high = 0.0, 1.0
        while self.below(high) - self.below(-high) < level:
            low, high = high, 2 * high
        while low < (middle := (low + high) / 2) < high:
            if self.below(middle) - self.below(-middle) < level:
                low = middle
            else:
                high = middle
        return high

    def turned(self) -> Law:
        """That of the error with the other sign."""
        return _Turned(self)


@dataclass(frozen=True)
class _Turned(Law):
    of: Law

    @property
    def mean(self) -> float:
        return -self.of.mean

    def moment(self, power: int) -> float:
        return -self.of.moment(power) if power % 2 else self.of.moment(power)

    def below(self, z: float) -> float:
        return self.of.above(-z)

    def above(self, z: float) -> float:
        return self.of.below(-z)

    def quantile(self, shares: Array) -> Array:
        return -self.of.quantile(1 - shares)


@dataclass(frozen=True)
class Exponential(Law):
    """A quantity that is not negative and of which its best estimate alone is known (JCGM 101, 6.4.10).

    The standard uncertainty is the estimate, and the error at least minus that.
    """

    mean = 0.0

    def moment(self, power: int) -> float:
        """As above."""
        return {3: 2.0, 4: 9.0}[power]

    def below(self, z: float) -> float:
        """As above.

        >>> Exponential().below(-1.0), round(Exponential().below(0.0), 4)
        (0.0, 0.6321)
        """
        return -math.expm1(-(z + 1)) if z > -1 else 0.0

    def above(self, z: float) -> float:
        """As above, where it is little, too.

        >>> Exponential().above(99.0) == math.exp(-100)
        True
        """
        return math.exp(-(z + 1)) if z > -1 else 1.0

    def quantile(self, shares: Array) -> Array:
        """As above."""
        return -np.log1p(-shares) - 1


@dataclass(frozen=True)
class TruncatedNormal(Law):
    """A normal distribution around the given number that is cut off."""

    low: float
    high: float
    """`low` and `high`: the ends, in standard deviations of the normal distribution from the number, which
    lies between them. Either may be infinite."""

    @cached_property
    def _moments(self) -> tuple[float, float, float, float]:
        """Mean and standard deviation in those of the normal distribution, and both other moments.

        By Gauss and Legendre: the closed forms are differences that have no digits left between near ends.
        """
        near = min(max(self.low, 0.0), self.high)
        low, high = max(self.low, near - _FAR), min(self.high, near + _FAR)
        nodes, weights = np.polynomial.legendre.leggauss(_NODES)
        x = (high - low) / 2 * nodes + (high + low) / 2
        weights = weights * np.exp((near**2 - x**2) / 2)
        weights /= weights.sum()
        mean = float(weights @ x)
        sd = math.sqrt(float(weights @ (x - mean) ** 2))
        z = (x - mean) / sd
        return mean, sd, float(weights @ z**3), float(weights @ z**4)

    @property
    def sd(self) -> float:
        """Its standard deviation over that of the normal distribution.

        >>> round(TruncatedNormal(0.0, math.inf).sd ** 2, 12) == round(1 - 2 / math.pi, 12)
        True
        """
        return self._moments[1]

    @property
    def mean(self) -> float:
        """As above."""
        return self._moments[0] / self.sd

    def moment(self, power: int) -> float:
        """As above."""
        return self._moments[power - 1]

    def _share(self, low: float, high: float) -> float:
        """Of what is within the ends, how much lies between two others, in the same unit."""
        low, high = (min(max(z, self.low), self.high) for z in (low, high))
        return _normal(low, high) / _normal(self.low, self.high)

    def below(self, z: float) -> float:
        """As above."""
        return self._share(-math.inf, z * self.sd)

    def above(self, z: float) -> float:
        """As above, where it is little, too.

        >>> round(TruncatedNormal(-1e-20, 1e-20).above(1.0), 4)
        0.2113
        """
        return self._share(z * self.sd, math.inf)

    def quantile(self, shares: Array) -> Array:
        """As above."""
        from scipy.special import ndtri

        if self.high - self.low < _NARROW:
            found: Array = self.low + shares * (self.high - self.low)
        else:
            found = ndtri(_normal(-math.inf, self.low) + shares * _normal(self.low, self.high))
        drawn: Array = np.clip(found, self.low, self.high) / self.sd
        return drawn


@dataclass(frozen=True)
class Samples(Law):
    """Draws that somebody else made: each is as likely as any other."""

    errors: Array = field(compare=False, repr=False)
    """Of shape (draws,); each minus the given number, over the standard deviation of all; row by row as in
    the table."""
    table: str = ""
    """Its name: what stands in one row of it belongs together."""

    @classmethod
    def around(cls, value: float, draws: Sequence[float], table: str) -> tuple[float, Samples]:
        """The standard deviation of draws, which differ, and what they say of a number (JCGM 101, 7.6)."""
        drawn = np.array(draws)
        sd = float(drawn.std(ddof=1))
        return sd, cls((drawn - value) / sd, table)

    @cached_property
    def _ordered(self) -> Array:
        return np.sort(self.errors)

    @property
    def mean(self) -> float:
        """As above."""
        return float(self.errors.mean())

    def moment(self, power: int) -> float:
        """As above."""
        return float(np.mean((self.errors - self.mean) ** power))

    def below(self, z: float) -> float:
        """As above."""
        return float(np.searchsorted(self._ordered, z, side="right")) / self.errors.size

    def above(self, z: float) -> float:
        """As above, by the rule of succession: that none of so many draws is there does not make it 0."""
        number = self.errors.size
        return (number - float(np.searchsorted(self._ordered, z, side="right")) + 1) / (number + 2)

    def quantile(self, shares: Array) -> Array:
        """As above: the same share is the same row of the table, for every column of it."""
        rows = np.minimum((shares * self.errors.size).astype(np.intp), self.errors.size - 1)
        return self.errors[rows]

    def turned(self) -> Samples:
        """As above."""
        return Samples(-self.errors, self.table)

    def correlation(self, other: Samples) -> float:
        """That with another column of the same table."""
        products = (self.errors - self.mean) * (other.errors - other.mean)
        return min(max(float(products.sum()) / (self.errors.size - 1), -1.0), 1.0)


def _normal(low: float, high: float) -> float:
    """The share of a normal distribution between two numbers of standard deviations.

    By what keeps its digits: beside 0 that is little, far out what is left to the end.
    """
    low, high = low / math.sqrt(2), high / math.sqrt(2)
    if low > 1:
        return (math.erfc(low) - math.erfc(high)) / 2
    if high < -1:
        return (math.erfc(-high) - math.erfc(-low)) / 2
    return (math.erf(high) - math.erf(low)) / 2
