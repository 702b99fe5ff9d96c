"""How likely a sum of squares is."""

from __future__ import annotations

import mpmath

__all__ = ["SIGNIFICANT", "tail"]

SIGNIFICANT = 0.05
"""A sum of squares that is less likely than this is not taken for chance."""


def tail(chi2: float, dof: int) -> float:
    """The probability of a sum of squares at least so large, of so many independent standard normal numbers.

    Parameters
    ----------
    chi2 : float
    dof : int
        At least 1.

    Examples
    --------
    >>> f"{tail(3.841459, 1):.6f}", f"{tail(55.1908, 3):.2e}"
    ('0.050000', '6.25e-12')
    """
    return float(mpmath.gammainc(mpmath.mpf(dof) / 2, mpmath.mpf(chi2) / 2, regularized=True))
