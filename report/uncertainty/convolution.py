"""The distribution of a sum of independent errors: theirs, convolved (EA-4/02, S10).

To first order a cell's error is such a sum. Each error becomes shares of bins of one width, exactly, and all
of them together are convolved by Fourier's transform: the only error is that of the bins' width, squared.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..distribution import DIVISORS, PARTS, Shape
from ..laws import Law, Samples
from ..result.uncertain import ErrorSource
from .conformity import beyond_each
from .freedom import of_sum

Array = NDArray[np.float64]

FINE = 2048
"""Bins in a standard uncertainty."""
MOST = 1 << 18
"""Bins, at most: a t distribution of few degrees of freedom is wide."""
OUTSIDE = 1e-6
"""The share that may lie beyond the bins of an error without ends; it is put into the last one."""
FAR = 12.0
"""Standard uncertainties beyond which many errors with ends and normal ones never are together."""
LEAST = 1e-15
"""A probability that rounding leaves of less; it is nothing only beyond an end."""

LITTLE, MANY = 1e-3, 1e-2
"""Of errors as one normal one: what their fourth powers come to at most, beside the whole and beside them.

Their excess kurtosis is less than 1.5 times as much, and a probability is off by less than 0.55/24 of that.
"""
ROUNDED = 1e-12
"""A limit so near to an end, as a share of it, is meant to be there."""


@dataclass(frozen=True)
class _Part:
    """An independent part of a sum: an error in units of its width, and how often that goes into the sum."""

    shape: Shape
    size: float
    dof: float = math.inf
    law: Law | None = None
    of: int = 1
    """Of so many errors it is the sum."""

    @property
    def ends(self) -> tuple[float, float]:
        """Beyond which there is nothing."""
        far = DIVISORS[self.shape] if self.shape in PARTS else math.inf
        low, high = -far, far
        if self.law is not None and not isinstance(self.law, Samples):
            with np.errstate(divide="ignore"):
                low, high = map(float, self.law.quantile(np.array([0.0, 1.0])))
        return tuple(sorted((self.size * low, self.size * high)))  # type: ignore[return-value]

    @property
    def reach(self) -> float:
        """Up to where bins are needed."""
        if isinstance(self.law, Samples):
            return float(np.abs(self.law.errors).max()) * abs(self.size)
        if self.law is not None:
            far = self.law.quantile(np.array([OUTSIDE, 1 - OUTSIDE]))
            return float(np.abs(far).max()) * abs(self.size)
        if self.shape is Shape.STUDENT:
            from scipy.special import stdtrit

            return float(stdtrit(self.dof, 1 - OUTSIDE)) * abs(self.size)
        return (DIVISORS[self.shape] if self.shape in PARTS else FAR) * abs(self.size)

    def shares(self, side: int) -> Array:
        """How much is in the bin around 0 and in so many to either side; the last hold what is beyond."""
        z = (np.arange(-side, side, dtype=np.float64) + 0.5) / (FINE * abs(self.size))
        above = beyond_each(z, self.shape, self.dof, self.law)
        found = -np.diff(np.concatenate([[1.0], above, [0.0]]))
        return found if self.size > 0 else found[::-1]


@dataclass(frozen=True)
class Convolved(Law):
    """A sum of independent errors, in standard uncertainties of the whole."""

    parts: Sequence[_Part] = field(repr=False)
    """In those."""

    @cached_property
    def ends(self) -> tuple[float, float]:
        """Beyond which there is nothing."""
        low, high = (sum(ends) for ends in zip(*(part.ends for part in self.parts), strict=True))
        return low * (1 - ROUNDED), high * (1 - ROUNDED)

    @property
    def effective(self) -> float:
        """The degrees of freedom of several errors without ends that are taken as one; infinite for none."""
        return min((part.dof for part in self.parts if part.of > 1), default=math.inf)

    @cached_property
    def _bins(self) -> tuple[Array, Array]:
        """Where bins end, and the share of each."""
        wide = [p.law is not None or p.shape is Shape.STUDENT for p in self.parts]
        light = [p for p, far in zip(self.parts, wide, strict=True) if not far]
        near = FINE * min(sum(p.reach for p in light), FAR * math.hypot(*(p.size for p in light)))
        most = [(MOST / 2 - near) / max(1, sum(wide)) if far else math.inf for far in wide]
        sides = [math.ceil(min(FINE * p.reach, room)) for p, room in zip(self.parts, most, strict=True)]
        beyond = sum(side for side, far in zip(sides, wide, strict=True) if far)
        number = 1 << (2 * (math.ceil(near) + beyond + 1)).bit_length()
        spectrum = np.ones(number // 2 + 1, dtype=np.complex128)
        for part, side in zip(self.parts, sides, strict=True):
            around = np.zeros(number)
            around[np.arange(-side, side + 1)] = part.shares(side)
            spectrum *= np.fft.rfft(around)
        found = np.maximum(np.roll(np.fft.irfft(spectrum, number), number // 2), 0.0)
        return (np.arange(number) - number // 2 + 0.5) / FINE, found / found.sum()

    @cached_property
    def _above(self) -> Array:
        return np.append(np.cumsum(self._bins[1][:0:-1])[::-1], 0.0)

    @cached_property
    def _below(self) -> Array:
        return np.cumsum(self._bins[1])

    def _around(self, number: float, power: int) -> float:
        ends, shares = self._bins
        return float(shares @ (ends - 0.5 / FINE - number) ** power)

    @property
    def mean(self) -> float:
        """As above."""
        return self._around(0.0, 1)

    def moment(self, power: int) -> float:
        """As above."""
        return self._around(self.mean, power)

    def below(self, z: float) -> float:
        """As above."""
        return self._told(z, self._below, z >= self.ends[1])

    def above(self, z: float) -> float:
        """As above: what is little keeps its digits."""
        return self._told(z, self._above, z <= self.ends[0])

    def _told(self, z: float, shares: Array, whole: bool) -> float:
        if not self.ends[0] < z < self.ends[1]:
            return float(whole)
        return min(max(float(np.interp(z, self._bins[0], shares)), LEAST), 1.0)

    def quantile(self, shares: Array) -> Array:
        """As above."""
        return np.interp(shares, self._below, self._bins[0])


def convolved(
    sources: Sequence[ErrorSource],
    contributions: Array,
    u: float,
    pairs: Sequence[tuple[int, int, float]] = (),
) -> Convolved | None:
    """The distribution of a sum of errors; None where all of them are normal or t, or a width is not certain.

    Parameters
    ----------
    sources : sequence of ErrorSource
    contributions : float array (sources,)
        What a standard uncertainty of each makes, with its sign.
    u : float
        The standard uncertainty of the sum, in the same unit.
    pairs : sequence of (int, int, float)
        Places of two sources that are correlated, and their coefficient.

    Those from one table of draws come row by row. All that have no ends are one error, normal or t with its
    effective degrees of freedom, as they are where nothing else is: a source with ends that moves next to
    nothing changes next to nothing.
    """
    sizes = contributions / u
    moving = [n for n, size in enumerate(sizes.tolist()) if size]
    # One whose partner moves nothing has the distribution that is stated of it.
    pairs = [each for each in pairs if np.abs(sizes[[*each[:2]]]).min() > ROUNDED]
    mixed = {n for a, b, _ in pairs for n in (a, b) if not sources[n].table}
    ended = [n for n in moving if n not in mixed and (sources[n].law or sources[n].shape in PARTS)]
    doubtful = any(math.isfinite(sources[n].dof) and sources[n].shape is not Shape.STUDENT for n in moving)
    if not ended or doubtful:
        return None
    together: dict[str, list[int]] = {}
    for n in ended:
        together.setdefault(f"table {table}" if (table := sources[n].table) else f"alone {n}", []).append(n)
    parts = [_one([(sources[n], float(sizes[n])) for n in of]) for of in together.values()]
    rest = sizes.copy()
    rest[ended] = 0.0
    size, dof = of_sum(sources, rest, [each for each in pairs if not {*each[:2]} & {*ended}])
    if size:
        shape = Shape.NORMAL if math.isinf(dof) else Shape.STUDENT
        parts.append(_Part(shape, size, dof, of=int(np.count_nonzero(rest))))
    return Convolved(tuple(_fewer(parts)))


def _fewer(parts: Sequence[_Part]) -> list[_Part]:
    """The same with those that are many and little as one normal error, which they come to together."""
    little = sorted((part for part in parts if part.shape in PARTS), key=lambda part: abs(part.size))
    squares = np.cumsum([part.size**2 for part in little])
    fourth = np.cumsum([part.size**4 for part in little])
    number = int(np.max(np.flatnonzero((fourth <= LITTLE) & (fourth <= MANY * squares**2)), initial=-1)) + 1
    if not number:
        return list(parts)
    normal = [part for part in parts if part.shape is Shape.NORMAL]
    variance = float(squares[number - 1]) + sum(part.size**2 for part in normal)
    gone = {id(part) for part in (*little[:number], *normal)}
    one = _Part(Shape.NORMAL, math.sqrt(variance))
    return [*(part for part in parts if id(part) not in gone), one]


def _one(of: Sequence[tuple[ErrorSource, float]]) -> _Part:
    """An error with ends or a law, or all from one table of draws."""
    first, size = of[0]
    if len(of) == 1:
        return _Part(first.shape, size, first.dof, first.law)
    told = [size * source.law.errors for source, size in of if isinstance(source.law, Samples)]
    errors: Array = np.sum(told, axis=0)
    sd = float(np.std(errors, ddof=1))
    return _Part(Shape.SAMPLES, sd, math.inf, Samples(errors / sd, first.table))
