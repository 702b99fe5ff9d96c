"""How many rows each index set has for given data, and which rows of other sets each of them names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sympy import Symbol

from .sheet import Axis, PairAxis, RepeatAxis, Sheet

__all__ = ["Layout", "lay_out"]


@dataclass(frozen=True)
class Layout:
    """The rows of one axis.

    Parameters
    ----------
    size : int
        How many rows.
    rows : mapping of Symbol to integer array (size,)
        For each index that formulas may use, the row it names, from 0.
    ordinals : mapping of Symbol to float array (size,)
        Running numbers that formulas use as values, from 1.
    labels : integer array (size, parts)
        How each row is called: ``2`` for a test, ``1 2`` for a pair, ``1 2 7`` for a point.
    """

    size: int
    rows: Mapping[Symbol, NDArray[np.intp]]
    ordinals: Mapping[Symbol, NDArray[np.float64]]
    labels: NDArray[np.int64]


def lay_out(sheet: Sheet, labels: Mapping[str, Sequence[int]], counts: Mapping[str, int]) -> dict[str, Layout]:
    """Lay out every axis of a sheet.

    Parameters
    ----------
    sheet : Sheet
    labels : mapping of axis name to sequence of int
        The rows' numbers of the axes that come with the data.
    counts : mapping of column name to int
        Values of the scalars that say how often an axis repeats another.
    """
    layouts: dict[str, Layout] = {}
    for axis in sheet.axes:
        if isinstance(axis, PairAxis):
            layouts[axis.name] = _pairs(axis, layouts[axis.of.name])
        elif isinstance(axis, RepeatAxis):
            layouts[axis.name] = _repeats(axis, layouts[axis.of.name], counts[axis.count])
        else:
            layouts[axis.name] = _given(axis, labels[axis.name])
    return layouts


def _given(axis: Axis, labels: Sequence[int]) -> Layout:
    own = np.arange(len(labels))
    return Layout(len(labels), {axis.index: own}, {}, np.asarray(labels, dtype=np.int64).reshape(-1, 1))


def _pairs(axis: PairAxis, parent: Layout) -> Layout:
    first, second = np.triu_indices(parent.size, k=1)
    rows = {axis.index: np.arange(first.size), axis.first: first, axis.second: second}
    return Layout(first.size, rows, {}, np.hstack([parent.labels[first], parent.labels[second]]))


def _repeats(axis: RepeatAxis, parent: Layout, count: int) -> Layout:
    which = np.repeat(np.arange(parent.size), count)
    step = np.tile(np.arange(1, count + 1), parent.size)
    rows: dict[Symbol, Any] = {index: named[which] for index, named in parent.rows.items()}
    rows[axis.index] = np.arange(which.size)
    return Layout(
        which.size, rows, {axis.step: step.astype(float)}, np.hstack([parent.labels[which], step.reshape(-1, 1)])
    )
