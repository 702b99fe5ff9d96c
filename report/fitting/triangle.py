"""A triangle of a matrix: orthogonal reflections, the longest column first, columns scaled to one length.

It is made of sums, products and square roots alone, which are the same on every processor. The normal
equations, which square the condition, are never formed.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

__all__ = ["EPS", "Array", "Triangle", "lengths", "product"]

Array = NDArray[np.float64]
EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Triangle:
    """The factor R of a matrix (n, p), and what its reflections make of a column (n,).

    Attributes
    ----------
    scale : array (p,)
        The lengths of the columns, which were divided by them; 1 for a column of zeros.
    order : array of int (p,)
        The columns, as they were taken.
    upper : array (min(n, p), p)
        R, of the scaled columns in that order.
    turned : array (n,)
        The column, reflected: its first `rank` numbers lie in the space of the matrix's columns.
    rank : int
        How many columns rounding leaves independent.
    """

    scale: Array
    order: NDArray[np.intp]
    upper: Array
    turned: Array
    rank: int

    @classmethod
    def of(cls, matrix: Array, column: Array) -> Triangle:
        """Reflect a matrix to a triangle, and a column with it."""
        scale = lengths(matrix)
        scale[scale == 0] = 1.0
        rows, width = matrix.shape
        work = np.column_stack([matrix / scale, column])
        order = np.arange(width)
        rank = min(rows, width)
        for k in range(rank):
            left = np.sqrt(np.add.reduce(work[k:, k:width] ** 2, axis=0))
            best = int(np.argmax(left))
            if left[best] <= EPS * max(rows, width):
                rank = k
                break
            if best:
                work[:, [k, k + best]] = work[:, [k + best, k]]
                order[[k, k + best]] = order[[k + best, k]]
            _reflect(work[k:, k:], left[best])
        return cls(scale, order, np.triu(work[:width, :width]), work[:, width], rank)

    @property
    def full(self) -> bool:
        """Whether all columns are independent."""
        return self.rank == len(self.scale)

    @cached_property
    def inside(self) -> float:
        """The length of what of the column lies in the space of the matrix's columns."""
        return float(lengths(self.turned[: self.rank]))

    @cached_property
    def outside(self) -> float:
        """The length of the rest."""
        return float(lengths(self.turned[self.rank :]))

    @cached_property
    def inverse(self) -> Array:
        """R^-1 (p, p), its rows in the order of the matrix's columns, for full rank."""
        found = np.empty_like(self.upper)
        found[self.order] = _back(self.upper, np.eye(len(self.upper)))
        return found

    @property
    def condition(self) -> float:
        """The condition of the scaled matrix in Frobenius' norm; inf if it has not full rank."""
        if not self.full:
            return np.inf
        return float(lengths(self.upper.ravel()) * lengths(self.inverse.ravel()))

    @cached_property
    def covariance(self) -> Array:
        """The inverse of matrix^T matrix (p, p), for full rank."""
        root = self.inverse / self.scale[:, None]
        return product(root, root.T)

    def solved(self) -> Array:
        """The x (p,) that makes |matrix x - column| least, for full rank."""
        found = np.empty(len(self.scale))
        found[self.order] = _back(self.upper, self.turned[: len(self.upper)])
        return found / self.scale

    def damped(self, weights: Array) -> Triangle:
        """That of the matrix with a diagonal of `weights` (p,) below it, and zeros below the column."""
        rows, width = self.upper.shape
        work = np.zeros((rows + width, width + 1))
        work[:rows, :width], work[:rows, width] = self.upper, self.turned[:rows]
        work[range(rows, rows + width), range(width)] = (weights / self.scale)[self.order]
        for k in range(width):
            _reflect(work[k:, k:], np.sqrt(np.add.reduce(work[k:, k] ** 2)))
        return Triangle(self.scale, self.order, np.triu(work[:width, :width]), work[:, width], width)

    def spread(self, x: Array) -> float:
        """sqrt(x^T (matrix^T matrix)^-1 x) of x (p,), for full rank."""
        found = (x / self.scale)[self.order]
        for k in range(len(found)):
            found[k] /= self.upper[k, k]
            found[k + 1 :] -= self.upper[k, k + 1 :] * found[k]
        return float(lengths(found))

    def moved(self, x: Array) -> float:
        """The length of matrix x, for x (p,)."""
        return float(lengths(np.sum(self.upper * (self.scale * x)[self.order], axis=1)))


def lengths(matrix: Array) -> Array:
    """The lengths of columns (n, ...), however large or small their numbers are."""
    with np.errstate(over="ignore"):
        squares = np.add.reduce(matrix * matrix, axis=0)
    if np.all((squares > 1e-200) & (squares < 1e200)):
        return np.asarray(np.sqrt(squares))
    most = np.max(np.abs(matrix), axis=0, initial=0.0)
    safe = np.where((most > 0) & np.isfinite(most), most, 1.0)
    found: Array = safe * np.sqrt(np.sum((matrix / safe) ** 2, axis=0))
    return found


def product(left: Array, right: Array) -> Array:
    """A product of matrices (..., n, m) and (..., m, p)."""
    found: Array = np.sum(left[..., :, :, None] * right[..., None, :, :], axis=-2)
    return found


def _reflect(block: Array, length: float) -> None:
    """Reflect the first column of a block, of some length, onto its first axis, and the others with it."""
    if length > 0:
        mirror = block[:, 0] / length
        sign = -1.0 if mirror[0] < 0 else 1.0
        mirror[0] += sign
        block -= mirror[:, None] * (np.add.reduce(mirror[:, None] * block, axis=0) / (sign * mirror[0]))


def _back(upper: Array, right: Array) -> Array:
    """What a triangle makes a right side (p, ...) of."""
    found = np.array(right, dtype=float)
    for k in reversed(range(len(upper))):
        found[k] /= upper[k, k]
        found[:k] -= np.multiply.outer(upper[:k, k], found[k])
    return found
