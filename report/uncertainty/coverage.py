"""How a sum of errors is distributed: its degrees of freedom, its shape, what covers it (JCGM 100, annex G).

To first order a cell's error is such a sum. Of errors that are not all normal or t, each becomes shares of
bins of one width, exactly, and all of them together are convolved by Fourier's transform (EA-4/02, S10): the
only error is that of the bins' width, squared.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from statistics import NormalDist
from typing import Any

import numpy as np

from ..distribution import DIVISORS, DOMINANT, LEVEL, MOST_DOF, PARTS, Shape
from ..laws import Array, Law, Samples
from ..result.numbers import degrees_of_freedom
from ..result.uncertain import ErrorSource
from .conformity import beyond_each

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
LITTLE_OF = 1e-3
"""What contributes at most such a share of u is a millionth of the variance: no degrees of freedom count."""
ROUNDED = 1e-12
"""A limit so near to an end, as a share of it, is meant to be there."""


# --- degrees of freedom


def effective(u: float, contributions: Array, dof: Sequence[float], whole: bool = True) -> float:
    """Effective degrees of freedom of a sum, by Welch and Satterthwaite (JCGM 100, G.2b).

    Parameters
    ----------
    u : float
        The combined standard uncertainty.
    contributions : float array (estimates,)
        In the same unit: each of what one estimate tells of.
    dof : sequence of float
        Of each estimate, which is independent of the others.
    whole : bool
        Whether it is truncated, as for a table of t (G.4.1).

    Returns
    -------
    float
        Rounded to two decimals, then truncated: 8.999 is 9, 8.99 is 8. At least 1; infinite if all are, or
        where those that are not contribute next to nothing.

    Examples
    --------
    >>> effective(5.0, np.array([3.0, 4.0]), [4.0, math.inf])
    30.0
    >>> effective(5.0, np.array([1e-4, 5.0]), [4.0, math.inf])
    inf
    """
    below = sum(c**4 / n for c, n in zip((contributions / u).tolist(), dof, strict=True)) if u > 0 else 0.0
    if below * MOST_DOF <= 1:
        return math.inf
    return float(max(1, math.floor(round(1 / below, 2)))) if whole else 1 / below


def of_sum(
    sources: Sequence[ErrorSource],
    contributions: Array,
    pairs: Sequence[tuple[int, int, float]],
    u: float | None = None,
    whole: bool = True,
) -> tuple[float, float]:
    """The standard uncertainty of a sum of errors, and its effective degrees of freedom.

    Parameters
    ----------
    sources : sequence of ErrorSource
        Those of one sample are one estimate.
    contributions : float array (sources,)
        What a standard uncertainty of each makes, with its sign.
    pairs : sequence of (int, int, float)
        Places of two sources that are correlated, and their coefficient.
    u : float, optional
        The standard uncertainty, where it is known.
    whole : bool
        As for :func:`effective`.

    Returns
    -------
    (float, float)
        The second is NaN where correlated sources of two samples have finite degrees of freedom.
    """
    together = with_correlated(contributions, pairs)
    if u is None:
        u = math.sqrt(max(float(contributions @ together), 0.0))
    samples = [source.sample or n for n, source in enumerate(sources)]
    moving = [pair for *pair, _ in pairs if np.abs(contributions[pair]).min() > LITTLE_OF * u]
    apart = (n for pair in moving if len({samples[n] for n in pair}) > 1 for n in pair)
    if any(np.isfinite(sources[n].dof) for n in apart):
        return u, math.nan
    variances: dict[str | int, float] = {}
    for n, sample in enumerate(samples):
        variances[sample] = variances.get(sample, 0.0) + float(contributions[n] * together[n])
    dof = {sample: source.dof for sample, source in zip(samples, sources, strict=True)}
    parts = np.sqrt(np.maximum(list(variances.values()), 0.0))
    return u, effective(u, parts, list(dof.values()), whole)


def with_correlated(contributions: Any, pairs: Sequence[tuple[int, int, float]]) -> Any:
    """Contributions (..., sources), each together with what is correlated with it; sparse ones, too."""
    found = contributions.copy()
    if pairs and not isinstance(found, np.ndarray):
        *both, of = map(np.array, zip(*pairs, strict=True))
        beside = type(found)((of, tuple(both)), (found.shape[1], found.shape[1]))
        return found + found @ (beside + beside.T)
    for a, b, r in pairs:
        found[..., a] += r * contributions[..., b]
        found[..., b] += r * contributions[..., a]
    return found


# --- convolved


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
    sources: Sequence[ErrorSource], contributions: Array, u: float, pairs: Sequence[tuple[int, int, float]]
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
    found = (_one([(sources[n], float(sizes[n])) for n in of]) for of in together.values())
    parts = [part for part in found if abs(part.size) > ROUNDED]
    rest = sizes.copy()
    rest[ended] = 0.0
    size, dof = of_sum(sources, rest, [each for each in pairs if not {*each[:2]} & {*ended}])
    if size > ROUNDED:
        shape = Shape.NORMAL if math.isinf(dof) else Shape.STUDENT
        parts.append(_Part(shape, size, dof, of=int(np.count_nonzero(rest))))
    return Convolved(tuple(_fewer(parts))) if parts else None


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
    return _Part(Shape.SAMPLES, sd, math.inf, Samples(errors / sd if sd else errors, first.table))


# --- assigned and covered


def assigned(
    sources: Sequence[ErrorSource],
    contributions: Array,
    u: float,
    dof: float,
    second: float = 0.0,
    pairs: Sequence[tuple[int, int, float]] = (),
) -> tuple[Shape, Law | None]:
    """The distribution of a sum, and its law if it has one.

    Parameters
    ----------
    contributions : float array (sources,)
        What each makes.
    u : float
        The standard uncertainty of the sum.
    dof : float
        Its effective degrees of freedom.
    second : float
        The part of the variance that is of second order. Where there is one, the sum is no longer all: it has
        the shape of a source that dominates, or none but the normal one.
    pairs : sequence of (int, int, float)
        Places of two sources that are correlated, and their coefficient.
    """
    plain = Shape.NORMAL if math.isinf(dof) else Shape.STUDENT
    if not second and u > 0 and not math.isnan(dof):
        every = convolved(sources, contributions, u, pairs)
        if every is None:
            return plain, None
        one = every.parts[0]
        if len(every.parts) > 1:
            return Shape.CONVOLVED, every
        return one.shape, one.law.turned() if one.law and one.size < 0 else one.law
    sizes = np.abs(contributions)
    if sizes.size:
        largest = int(sizes.argmax())
        rest = math.sqrt(float(np.sum(np.delete(sizes, largest) ** 2)) + abs(second))
        most, sure = sources[largest], math.isinf(sources[largest].dof)
        dominates = bool(sizes[largest]) and rest <= DOMINANT * sizes[largest]
        if sure and dominates and most.law is not None:
            return most.shape, most.law if contributions[largest] > 0 else most.law.turned()
        if sure and dominates and most.shape in PARTS:
            return most.shape, None
    return plain, None


def coverage(shape: Shape, law: Law | None, dof: float, level: float = LEVEL) -> tuple[float, str]:
    """The coverage factor of a distribution that is assigned, and what it was taken from.

    Parameters
    ----------
    shape, law
        As :func:`assigned` tells.
    dof : float
        The effective degrees of freedom.
    level : float
        The coverage probability.

    Examples
    --------
    >>> coverage(Shape.RECTANGULAR, None, math.inf)
    (1.6454482671904334, 'the rectangular source that dominates')
    """
    if math.isnan(dof):
        return math.nan, "correlated sources have finite degrees of freedom"
    if isinstance(law, Convolved):
        one, because = law.effective, "the convolved distributions of its sources"
        if math.isfinite(one):
            because += f", those without ends as one t with {degrees_of_freedom(one)}"
        return law.half(level), because
    if law is not None or shape in PARTS:
        factor = DIVISORS[shape] * PARTS[shape](level) if law is None else law.half(level)
        return factor, f"the {shape} source that dominates"
    if shape is Shape.NORMAL:
        return NormalDist().inv_cdf((1 + level) / 2), "a normal distribution"
    from scipy.special import stdtrit  # a quarter of a second, for those who have degrees of freedom

    return float(stdtrit(dof, (1 + level) / 2)), f"a t distribution with {degrees_of_freedom(dof)}"
