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

__all__ = ["assigned", "coverage", "effective"]


def effective(u: float, contributions: NDArray[np.float64], dof: Sequence[float]) -> float:
    """Effective degrees of freedom of a sum, by Welch and Satterthwaite (JCGM 100, G.2b).

    Parameters
    ----------
    u : float
        The combined standard uncertainty.
    contributions : float array (estimates,)
        In the same unit: each of what one estimate tells of.
    dof : sequence of float
        Of each estimate, which is independent of the others.

    Returns
    -------
    float
        Rounded to two decimals, then truncated: 8.999 is 9, 8.99 is 8. At least 1; infinite if all are.

    Examples
    --------
    >>> effective(5.0, np.array([3.0, 4.0]), [4.0, math.inf])
    30.0
    """
    below = sum(c**4 / n for c, n in zip((contributions / u).tolist(), dof, strict=True)) if u > 0 else 0.0
    return float(max(1, math.floor(round(1 / below, 2)))) if below > 0 else math.inf


def assigned(
    sources: Sequence[ErrorSource], contributions: NDArray[np.float64], dof: float, second: float = 0.0
) -> tuple[Shape, Law | None]:
    """The distribution of a sum, and its law if it has one; parameters as for :func:`coverage`."""
    sizes = np.abs(contributions)
    if sizes.size:
        largest = int(sizes.argmax())
        rest = math.sqrt(float(np.sum(np.delete(sizes, largest) ** 2)) + abs(second))
        one, sure = sources[largest], math.isinf(sources[largest].dof)
        dominates = bool(sizes[largest]) and rest <= DOMINANT * sizes[largest]
        if sure and dominates and one.law is not None:
            return one.shape, one.law if contributions[largest] > 0 else one.law.turned()
        if sure and dominates and one.shape in PARTS:
            return one.shape, None
    return Shape.NORMAL if math.isinf(dof) else Shape.STUDENT, None


def coverage(
    sources: Sequence[ErrorSource],
    contributions: NDArray[np.float64],
    dof: float,
    level: float = LEVEL,
    second: float = 0.0,
) -> tuple[float, str]:
    """The coverage factor of a sum, and what it was taken from.

    Parameters
    ----------
    sources : sequence of ErrorSource
    contributions : float array (sources,)
        What each makes.
    dof : float
        The effective degrees of freedom.
    level : float
        The coverage probability.
    second : float
        The variance of second order.

    Examples
    --------
    >>> coverage([ErrorSource("g", Shape.RECTANGULAR, math.inf, ())], np.array([1.0]), math.inf)
    (1.6454482671904334, 'the rectangular source that dominates')
    """
    if math.isnan(dof):
        return math.nan, "nothing: correlated sources have finite degrees of freedom"
    shape, law = assigned(sources, contributions, dof, second)
    if law is not None or shape in PARTS:
        factor = DIVISORS[shape] * PARTS[shape](level) if law is None else law.half(level)
        return factor, f"the {shape} source that dominates"
    if shape is Shape.NORMAL:
        return NormalDist().inv_cdf((1 + level) / 2), "a normal distribution"
    from scipy.special import stdtrit  # a quarter of a second, for those who have degrees of freedom

    return float(stdtrit(dof, (1 + level) / 2)), f"a t distribution with {dof:.0f} degrees of freedom"
