"""How far residuals are from what their uncertainties make them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NOTHING = 1e-9
"""An eigenvalue that is a smaller part of the largest one is what rounding leaves of none."""
ROUNDING = 1e-13
"""And so is one that is smaller than this: errors that all rows share move no residual."""


def least_squares_of_errors(
    residuals: Array, covariance: Array, size: Array, fitted: int
) -> tuple[float, int]:
    """The least sum of squares of errors, each over its standard uncertainty, that make these residuals.

    With the covariance matrix C of the residuals r it is r^T C^+ r. Of a linear model that is the least sum
    of squares by stated weights, whatever weights the residuals were found with; errors of the other
    variables, and such as rows share, count by what they do to the residuals.

    Parameters
    ----------
    residuals : float array (rows,)
    covariance : float array (rows, rows)
        What the errors make of them.
    size : float array (rows,)
        Of the errors of a row, above 0: what its residual is compared with.
    fitted : int
        How many numbers were fitted to the rows: so many eigenvalues are nothing.

    Returns
    -------
    float, int
        The sum, and its degrees of freedom: 0 where the errors move no residual.

    Examples
    --------
    Of the residuals about a mean of three readings:

    >>> about = np.eye(3) - 1 / 3
    >>> chi2, dof = least_squares_of_errors(np.array([1.0, 0.0, -1.0]), about, np.ones(3), 1)
    >>> round(chi2, 9), dof
    (2.0, 2)

    Source: C. R. Rao, Linear Statistical Inference and Its Applications, 1973, 4i and 8a.
    """
    found, across = np.linalg.eigh(covariance / np.outer(size, size))
    kept = (found > max(NOTHING * found[-1], ROUNDING)) & (np.arange(len(found)) >= fitted)
    along = across[:, kept].T @ (residuals / size)
    return float(np.sum(along**2 / found[kept])), int(np.count_nonzero(kept))
