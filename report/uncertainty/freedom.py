"""Degrees of freedom of a sum of errors (JCGM 100, annex G.4)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..distribution import MOST_DOF
from ..result.uncertain import ErrorSource

Array = NDArray[np.float64]


def effective(u: float, contributions: Array, dof: Sequence[float]) -> float:
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
    return float(max(1, math.floor(round(1 / below, 2)))) if below * MOST_DOF > 1 else math.inf


def of_sum(
    sources: Sequence[ErrorSource],
    contributions: Array,
    pairs: Sequence[tuple[int, int, float]],
    u: float | None = None,
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

    Returns
    -------
    (float, float)
        The second is NaN where correlated sources of two samples have finite degrees of freedom.
    """
    together = with_correlated(contributions, pairs)
    if u is None:
        u = math.sqrt(max(float(contributions @ together), 0.0))
    samples = [source.sample or n for n, source in enumerate(sources)]
    moving = [(a, b) for a, b, _ in pairs if contributions[a] and contributions[b]]
    apart = (n for pair in moving if len({samples[n] for n in pair}) > 1 for n in pair)
    if any(np.isfinite(sources[n].dof) for n in apart):
        return u, math.nan
    variances: dict[str | int, float] = {}
    for n, sample in enumerate(samples):
        variances[sample] = variances.get(sample, 0.0) + float(contributions[n] * together[n])
    dof = {sample: source.dof for sample, source in zip(samples, sources, strict=True)}
    parts = np.sqrt(np.maximum(list(variances.values()), 0.0))
    return u, effective(u, parts, list(dof.values()))


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
