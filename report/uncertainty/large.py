"""What errors contribute to all cells of a column that has too many for one array of them.

A row rests on few numbers by itself, and by way of what is taken over all rows, a mean say, on all of them:
that part is kept once, and each row only says how much of it is its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..judge.chain import Numbered
from ..judge.sensitivity import AT_ONCE, CANCELLED, without_rounding
from .coverage import with_correlated

Array = NDArray[np.float64]

LEFT = 2.0**-16
"""Of the terms of a variance: what is left of them where they cancel is found anew, from all errors."""


@dataclass(frozen=True)
class Contributions:
    """Those to the cells of a column.

    Attributes
    ----------
    slopes : sparse array (cells, numbers)
        The derivatives by the numbers that were given, along ways that pass no hub.
    by_hubs : sparse array (cells, hubs)
        Those by hubs.
    hubs : float array (hubs, numbers)
        Those of the hubs.
    weights : sparse array (numbers, sources)
        How far a standard uncertainty of each source moves each number.
    """

    slopes: Any
    by_hubs: Any
    hubs: Array
    weights: Any

    @cached_property
    def filled(self) -> int:
        """How many derivatives are not 0, at most."""
        each = np.count_nonzero(self.hubs, axis=1)
        return int(self.slopes.nnz + each[self.by_hubs.indices].sum())

    def sparse(self) -> Any:
        """All contributions (cells, sources), without the zeros."""
        found = self.slopes
        if self.by_hubs.nnz:
            hubs = type(found)(self.hubs)
            found = (found + self.by_hubs @ hubs).tocsr()
            found = found.multiply(abs(found) > CANCELLED * (abs(self.by_hubs) @ abs(hubs))).tocsr()
        return found @ self.weights

    def dense(self, cells: Numbered) -> Array:
        """Those to some cells (some, sources)."""
        by_hubs = self.by_hubs[cells].toarray()
        found = self.slopes[cells].toarray() + by_hubs @ self.hubs
        found = without_rounding(found, np.abs(by_hubs) @ np.abs(self.hubs))
        return np.asarray(found @ self.weights)

    def variances(self, pairs: Sequence[tuple[int, int, float]]) -> Array:
        """The variance of each cell (cells,); `pairs`: the places of two sources, and their correlation."""
        own, hubs = self.slopes @ self.weights, self.hubs @ self.weights
        every = with_correlated(hubs, pairs)
        parts = [
            _sums(own.multiply(with_correlated(own, pairs))),
            2 * _sums(self.by_hubs.multiply(own @ every.T)),
            _sums(self.by_hubs.multiply(self.by_hubs @ (hubs @ every.T))),
        ]
        found: Array = np.sum(parts, axis=0)
        cancelled = np.flatnonzero(found <= LEFT * np.sum(np.abs(parts), axis=0))
        some = max(1, AT_ONCE // max(1, *self.weights.shape))
        for first in range(0, cancelled.size, some):
            cells = cancelled[first : first + some]
            each = self.dense(cells)
            found[cells] = np.sum(each * with_correlated(each, pairs), axis=1)
        return found

    def largest(self, sizes: Array) -> Array:
        """The largest of the sizes (sources,) of what moves each cell (cells,); else 0."""
        hubs = largest(self.hubs @ self.weights != 0, sizes)
        own = largest(self.slopes @ self.weights != 0, sizes)
        return np.maximum(own, largest(self.by_hubs != 0, hubs))


def largest(where: Any, sizes: Array) -> Array:
    """The largest size where a mask (rows, sizes), dense or sparse, is true in a row; else 0."""
    if isinstance(where, np.ndarray):
        return np.asarray(np.max(np.where(where, sizes, 0.0), axis=1, initial=0.0))
    return np.asarray(where.multiply(sizes).max(axis=1).toarray()).ravel()


def _sums(entries: Any) -> Array:
    """Over each row."""
    return np.asarray(entries.sum(axis=1)).ravel()
