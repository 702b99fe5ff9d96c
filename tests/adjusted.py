"""A fit by another way than the sheet's: the true value of each datum with an error is one more unknown.

What methods eliminate row by row is left to SciPy here, as one large problem of least squares. Derivatives
are by complex steps; those of Gauss and Newton follow where the sum of squares is too flat for more digits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from sympy import Expr, Symbol, lambdify

Array = NDArray[np.float64]


class Adjusted(NamedTuple):
    """What was found.

    Attributes
    ----------
    parameters, covariance : array (p,), (p, p)
        The latter from the given uncertainties alone, by the adjusted points (ISO/TS 28037:2010).
    chi2 : float
    points : mapping of Symbol to array (n,)
        The adjusted values of what has errors besides y.
    """

    parameters: Array
    covariance: Array
    chi2: float
    points: dict[Symbol, Array]

    @property
    def u(self) -> Array:
        return np.sqrt(np.diagonal(self.covariance))


def adjusted(
    model: Expr,
    y: Symbol,
    parameters: Sequence[Symbol],
    data: Mapping[Symbol, Array],
    sizes: Mapping[Symbol, Array],
    start: Sequence[float],
) -> Adjusted:
    """The likeliest parameters of y = model, for normal errors of y and of other variables.

    `data`, `sizes`: the rows (n,) of all variables, and the standard uncertainties of those that have errors.
    """
    uncertain = [symbol for symbol in data if symbol in sizes and symbol != y]
    count, rows = len(parameters), len(data[y])
    curve = lambdify([*parameters, *(symbol for symbol in data if symbol != y)], model)

    def parted(unknowns: Array) -> tuple[Array, dict[Symbol, Array]]:
        own = unknowns[count:].reshape(len(uncertain), rows)
        return unknowns[:count], dict(zip(uncertain, own, strict=True))

    def residuals(unknowns: Array) -> Array:
        place, true = parted(unknowns)
        at = [true.get(symbol, values) for symbol, values in data.items() if symbol != y]
        off = [(data[y] - curve(*place, *at)) / sizes[y]]
        return np.concatenate([*off, *((true[each] - data[each]) / sizes[each] for each in uncertain)])

    first = np.concatenate([np.asarray(start, dtype=float), *(data[symbol] for symbol in uncertain)])
    step = 1e-30

    def slopes(unknowns: Array) -> Array:
        return np.stack([residuals(unknowns + step * 1j * e).imag / step for e in np.eye(len(first))], axis=1)

    found = least_squares(residuals, first, slopes, method="lm", x_scale="jac").x
    for _ in range(20):
        found = found - np.linalg.lstsq(slopes(found), residuals(found))[0]
    place, points = parted(found)
    covariance = np.linalg.inv(slopes(found).T @ slopes(found))[:count, :count]
    return Adjusted(place, covariance, float(np.sum(residuals(found) ** 2)), points)
