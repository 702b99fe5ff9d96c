"""Adjusted points: where a model g(xi, theta) = 0 is nearest to rows of data, counted in their uncertainties.

The points are eliminated row by row: what is left is a least-squares problem for the parameters alone, whose
residuals are the distances d of the rows. With V the covariance of a row x,

    xi = x - lambda V dg/dxi,   g(xi) = 0,   d = lambda sigma,   sigma^2 = (dg/dxi)^T V dg/dxi,

and the Jacobian is exact: dd/dtheta = (dg/dtheta)/sigma at xi.

Source: W. H. Southwell, Fitting data to nonlinear functions with uncertainties in all measurement variables,
The Computer Journal 19 (1976) 69-73.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .triangle import EPS, Array, product

__all__ = ["NOTHING", "Feet", "Known", "Second", "solved"]

ROUNDS = 50
"""Steps towards the adjusted points of given parameters; a row that needs more has none."""


class Second(NamedTuple):
    """What exact second derivatives say at the least sum of squares.

    Attributes
    ----------
    hessian : array (p, p)
        Of half of chi2.
    pull : array (p, n, m)
        What one standard uncertainty of each datum adds to half of the gradient of chi2.
    known : array (p, k)
        The same of what was known of the parameters before.
    """

    hessian: Array
    pull: Array
    known: Array


class Known(NamedTuple):
    """What is known of parameters before the fit: each is a datum of its own.

    Attributes
    ----------
    which : array of int (k,)
        Their places among the parameters.
    values, sizes : array (k,)
        The values and their standard uncertainties.
    """

    which: NDArray[np.intp]
    values: Array
    sizes: Array


NOTHING = Known(np.empty(0, dtype=np.intp), np.empty(0), np.empty(0))


class Feet:
    """The adjusted points of given parameters, found anew for each of these.

    Parameters
    ----------
    slopes : callable
        Of points (n, m) and parameters (p,): g and its derivatives by the variables, then by the parameters
        (n, 1 + m + p).
    curvatures : callable
        Of the same: the second derivatives by variables and parameters (n, m + p, m + p).
    rows, sizes : array (n, m)
        The data and their standard uncertainties, of which each row has one that is not zero.
    shared : array (n, m, m)
        The correlation of the errors of a row.
    flat : bool
        Whether no second derivative by anything that has errors is there: a point is found at once.
    known : Known
        What is known of parameters.
    """

    def __init__(
        self,
        slopes: Callable[[Array, Array], Array],
        curvatures: Callable[[Array, Array], Array],
        rows: Array,
        sizes: Array,
        shared: Array,
        flat: bool = False,
        known: Known = NOTHING,
    ) -> None:
        self.slopes, self.curvatures, self.flat, self.known = slopes, curvatures, flat, known
        self.rows, self.sizes, self.shared = rows, sizes, shared
        self.width = rows.shape[1]
        self._at(np.zeros(rows.shape), None)

    @property
    def points(self) -> Array:
        """The adjusted points (n, m)."""
        return self.rows + self.sizes * self.eta

    def _at(self, eta: Array, place: Array | None) -> None:
        """Go `eta` standard uncertainties away from the rows, and see where the model is."""
        self.eta = eta
        if place is None:
            return
        values = self.slopes(self.points, place)
        self.by_place = values[:, 1 + self.width :]
        steep = self.sizes * values[:, 1 : 1 + self.width]
        toward = product(self.shared, steep[..., None])[..., 0]
        self.sigma = np.sqrt(np.sum(steep * toward, axis=-1))
        self.steep, self.toward = steep / self.sigma[:, None], toward / self.sigma[:, None]
        self.off = values[:, 0] / self.sigma
        self.distance: Array = self.off - np.sum(self.steep * eta, axis=-1)

    def residuals(self, place: Array) -> Array:
        """The distances for parameters (p,), and how far these are from what was known of them (n + k,)."""
        which, values, sizes = self.known
        return np.concatenate([self.distances(place), (place[which] - values) / sizes])

    def jacobian(self, place: Array) -> Array:
        """The derivatives (n + k, p) of the residuals that were asked last."""
        return np.concatenate([self.by_place / self.sigma[:, None], self._certain(len(place))])

    def _certain(self, count: int) -> Array:
        which, _, sizes = self.known
        return np.eye(count)[which] / sizes[:, None]

    def distances(self, place: Array) -> Array:
        """The distances (n,) for parameters (p,); not finite where a row has no adjusted point."""
        with np.errstate(all="ignore"):
            self._at(np.zeros(self.rows.shape), place)
            if self.flat:
                self.eta = -self.distance[:, None] * self.toward
                return self.distance
            before = np.inf
            for turn in range(ROUNDS):
                # The foot for a plane first; then Newton's steps.
                move = -self.distance[:, None] * self.toward - self.eta
                if turn > 1:
                    right = np.concatenate([move, -self.off[:, None]], axis=1)
                    move = solved(self._bordered(place)[0], right[..., None])[:, :-1, 0]
                largest = np.max(np.abs(move) / (1 + np.abs(self.eta)))
                self._at(self.eta + move, place)
                if not np.isfinite(largest) or not np.isfinite(self.distance).all():
                    break
                # After a Newton's step the error is its square; what shrinks no more is rounding.
                if largest <= (EPS**0.5 if turn > 1 else 4 * EPS) or (before < 1e-6 and largest > before / 2):
                    return self.distance
                before = largest
            return np.full(len(self.rows), np.nan)

    def _bordered(self, place: Array) -> tuple[Array, Array]:
        """The derivatives (n, m + 1, m + 1) of the conditions of a foot by (eta, distance).

        With them, all second derivatives (n, m + p, m + p), by variables in their uncertainties.
        """
        width = self.width
        curved = self.curvatures(self.points, place)
        scale = np.ones(curved.shape[:2])
        scale[:, :width] = self.sizes
        curved = curved * scale[:, :, None] * scale[:, None, :]
        matrix = np.zeros((len(self.rows), width + 1, width + 1))
        bent = product(self.shared, curved[:, :width, :width])
        matrix[:, :width, :width] = np.eye(width) + (self.distance / self.sigma)[:, None, None] * bent
        matrix[:, :width, width] = self.toward
        matrix[:, width, :width] = self.steep
        return matrix, curved

    def second(self, place: Array) -> Second:
        """The second derivatives of half of chi2 at parameters (p,), by the implicit function theorem."""
        self.distances(place)
        matrix, curved = self._bordered(place)
        width = self.width
        mixed, own = curved[:, width:, :width], curved[:, width:, width:]
        pull = (self.distance / self.sigma)[:, None, None]
        over = (self.by_place / self.sigma[:, None])[:, :, None]
        by_place = np.concatenate(
            [pull * product(self.shared, np.swapaxes(mixed, 1, 2)), np.swapaxes(over, 1, 2)], axis=1
        )
        by_data = np.broadcast_to(np.eye(width + 1, width), (len(self.rows), width + 1, width))
        moved = solved(matrix, np.concatenate([-by_place, by_data], axis=2))
        # d(lambda g_theta): lambda by way of the distance, g_theta by way of the point.
        change = over * moved[:, None, width] + pull * product(mixed, moved[:, :width])
        count = own.shape[1]
        certain = self._certain(count)
        hessian = np.sum(change[:, :, :count] + pull * own, axis=0) + product(certain.T, certain)
        return Second((hessian + hessian.T) / 2, np.swapaxes(change[:, :, count:], 0, 1), -certain.T)


def solved(matrix: Array, right: Array) -> Array:
    """The solutions (n, k, c) of systems (n, k, k), by Gauss and Jordan with row exchanges."""
    size, every = matrix.shape[-1], np.arange(len(matrix))
    work = np.concatenate([matrix, right], axis=-1)
    for k in range(size):
        best = k + np.argmax(np.abs(work[:, k:, k]), axis=1)
        work[every, best], work[:, k] = work[:, k].copy(), work[every, best]
        work[:, k] /= work[:, k, k, None]
        factor = work[:, :, k].copy()
        factor[:, k] = 0
        work -= factor[:, :, None] * work[:, None, k]
    return work[..., size:]
