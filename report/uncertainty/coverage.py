"""Degrees of freedom and coverage factors (JCGM 100, annex G; EA-4/02, S9 and S10)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from ..distribution import DIVISORS, DOMINANT, LEVEL, PARTS, Shape
from ..laws import Law
from ..result.uncertain import ErrorSource
from .convolution import Convolved, convolved


def assigned(
    sources: Sequence[ErrorSource],
    contributions: NDArray[np.float64],
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
            because += f", those without ends as one t with {one:.0f} degrees of freedom"
        return law.half(level), because
    if law is not None or shape in PARTS:
        factor = DIVISORS[shape] * PARTS[shape](level) if law is None else law.half(level)
        return factor, f"the {shape} source that dominates"
    if shape is Shape.NORMAL:
        return NormalDist().inv_cdf((1 + level) / 2), "a normal distribution"
    from scipy.special import stdtrit  # a quarter of a second, for those who have degrees of freedom

    return float(stdtrit(dof, (1 + level) / 2)), f"a t distribution with {dof:.0f} degrees of freedom"
