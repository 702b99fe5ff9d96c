"""Sensitivities: the derivatives of chosen cells by chosen ones, along all ways between them.

They come from the slopes of a plan's derivatives (:mod:`~loopsheet.report.plan.derivatives`), for a root by
the implicit function theorem, and from the chain rule over the rows (:mod:`~loopsheet.report.judge.chain`).
What cancels between two ways cancels.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ..cells.values import Status, Values, rows_kept
from ..engines.numpy import parts
from ..plan.order import places
from ..plan.slopes import NodeDerivatives, Slope
from .chain import Chain, Numbered, SparseRows

Array = NDArray[np.float64]

AT_ONCE = 1 << 22
"""So many derivatives are held at the same time."""
CANCELLED = 2.0**-42
"""Of the terms of a sum: what is left of them where they cancel may be rounding."""


def without_rounding(sums: Array, terms: Array) -> Array:
    """Sums without those that are no more than the rounding of their terms, whose sizes are added up."""
    left: Array = np.where(np.abs(sums) <= CANCELLED * terms, 0.0, sums)
    return left


class ForwardSweep:
    """The derivatives along a chain.

    Parameters
    ----------
    nothing : callable
        Makes zeros of a shape, of the kind that goes along.
    batch : tuple of int
        The leading dimensions.

    Attributes
    ----------
    entries : array (..., entries)
    whole : array (..., hubs, sources)
        The derivatives of hubs by all sources.
    """

    def __init__(
        self, chain: Chain, nothing: Callable[..., Any] = np.zeros, batch: tuple[int, ...] = ()
    ) -> None:
        self.chain, self.nothing, self.batch = chain, nothing, batch
        self.entries = nothing((*batch, chain.length))
        self.entries[..., : chain.ones] = 1.0
        self.whole = nothing((*batch, chain.hubs_number, chain.number))

    def go(self) -> Self:
        """Take all steps."""
        with np.errstate(all="ignore"):  # a derivative may be beyond all doubles
            for step in self.chain.steps:
                slopes = self.nothing((*self.batch, step.width))
                for node, slope, where in step.slopes:
                    slopes[..., where] = self.slope(node, slope)
                if step.starts.size:
                    terms = slopes[..., step.of] * self.entries[..., step.along]
                    self.entries[..., step.entries] = np.add.reduceat(terms, step.starts, axis=-1)
                for node in step.nodes:
                    self.ended(node)
                    if node.name in self.chain.hubs:
                        first = self.chain.hubs[node.name] - self.chain.number
                        rows = slice(first, first + self.chain.sizes[node.name])
                        self.whole[..., rows, :] = self.of(node.name)
        return self

    def groups(self, node: NodeDerivatives) -> list[slice]:
        """Where the rows of each group stand, of which something is taken."""
        assert node.over is not None
        return self.chain.layouts[node.over].groups

    def slope(self, node: NodeDerivatives, slope: Slope) -> Any:
        """The values of a slope (..., rows); nothing where a sum leaves a row out."""
        raise NotImplementedError

    def ended(self, node: NodeDerivatives) -> None:
        """The entries of a node are there."""

    def derivatives(self, cells: SparseRows, number: int) -> Any:
        """The derivatives of some cells by all sources (..., cells, sources).

        `cells`: from :meth:`Chain.cells`. `number`: how many they are.
        """
        found, sources = self.nothing((*self.batch, number, self.chain.number)), self.chain.number
        direct = cells.by < sources
        found[..., cells.rows[direct], cells.by[direct]] = self.entries[..., cells.entries[direct]]
        hubs, entries, first, rows = cells.by_hubs(sources)
        if rows.size:
            with np.errstate(all="ignore"):  # a derivative may be beyond all doubles
                terms = self.entries[..., entries, None] * self.whole[..., hubs, :]
                terms[..., first, :] = found[..., rows, :] + terms[..., first, :]
                found[..., rows, :] = np.add.reduceat(terms, first, axis=-2)
        return found

    def of(self, name: str) -> Any:
        """The derivatives of all cells of a column (..., rows, sources)."""
        return self.derivatives(self.chain.patterns[name], self.chain.sizes[name])


class NumericSweep(ForwardSweep):
    """The derivatives at finished values; NaN where they are not known.

    `values`: all columns; a batch is one of derivatives.
    """

    def __init__(self, chain: Chain, values: Values) -> None:
        batch = np.broadcast_shapes(*(own.shape[:-1] for own in values.value.values()))
        super().__init__(chain, np.zeros, batch)
        self.values = values
        self.odd = {name for name, codes in values.status.items() if codes.any()}
        self.kept = {
            column.name: rows_kept(chain.laid.named[column.name], chain.layouts, values.status)
            for column in values.sheet.columns
            if self.odd and values.sheet.summed_axes(column)
        }

    @cached_property
    def parts(self) -> dict[str, Array]:
        """What the slopes are made of."""
        return parts(self.chain.made.program, self.values, self.chain.laid)

    def go(self) -> Self:
        """Take all steps, of a long batch for as many sheets at once as a processor's cache holds."""
        some = max(1, AT_ONCE // self.chain.length)
        if len(self.batch) != 1 or self.batch[0] <= some:
            return super().go()
        for first in range(0, self.batch[0], some):
            block = slice(first, first + some)
            own = NumericSweep(self.chain, self.values.of_batch(block)).go()
            self.entries[block], self.whole[block] = own.entries, own.whole
        return self

    def at(self, cells: Sequence[tuple[str, int]]) -> Array:
        """The derivatives of some cells by the sources of the chain.

        Parameters
        ----------
        cells : sequence of (str, int)
            Columns and rows.

        Returns
        -------
        float array (..., cells, sources)
            In SI; NaN for a cell without a value, and where nothing is known.
        """
        own = self.chain.cells(cells)
        found: Array = self.derivatives(own, len(cells))
        hubs, entries, first, rows = own.by_hubs(self.chain.number)
        if rows.size:
            with np.errstate(all="ignore"):  # a derivative may be beyond all doubles
                terms = np.abs(self.entries[..., entries, None] * self.whole[..., hubs, :])
                all_terms = np.add.reduceat(terms, first, axis=-2)
            found[..., rows, :] = without_rounding(found[..., rows, :], all_terms)
        for n, odd in self.without_value(cells):
            found[..., n, :] = np.where(odd[..., None], np.nan, found[..., n, :])
        return found

    def without_value(self, cells: Sequence[tuple[str, int]]) -> Iterator[tuple[int, NDArray[np.bool_]]]:
        """Which of some cells may have no value, and where in the batch they have none (...,)."""
        for n, (name, row) in enumerate(cells):
            if name in self.odd:
                yield n, self.values.status[name][..., row] != Status.OK

    def slope(self, node: NodeDerivatives, slope: Slope) -> Array:
        """Those of what is taken by order count for the rows that it takes."""
        found = self.parts[slope.value]
        if node.over is None:
            return found
        if node.by_order:
            share = self.share(node, slope.by, self.chain.named(node, slope))
            return np.where(share > 0, share * found, 0.0)
        return np.where(self.summed(node), found, 0.0) if node.of in self.kept else found

    def ended(self, node: NodeDerivatives) -> None:
        """What has no value moves nothing: a sum leaves it out."""
        if node.over is None and node.of in self.odd:
            cells = self.chain.patterns[node.name]
            dead = self.values.status[node.of][..., cells.rows] != Status.OK
            self.entries[..., cells.entries] = np.where(dead, 0.0, self.entries[..., cells.entries])

    def share(self, node: NodeDerivatives, name: str, rows: Numbered) -> Array:
        """How much of the change of each row counts by its place, in its group if rows stand in groups."""
        value = np.where(self.summed(node), self.values.value[name][..., rows], np.inf)
        return np.concatenate([self._shared(node, value[..., own]) for own in self.groups(node)], axis=-1)

    def _shared(self, node: NodeDerivatives, value: Array) -> Array:
        """The same of the rows of one group: rows with one value share it."""
        ordered, number = np.sort(value, axis=-1), np.isfinite(value).sum(axis=-1, keepdims=True)
        found: Array = np.zeros(value.shape)
        taken = places(node.word, number) if value.size else ()
        for place in taken:
            one = np.take_along_axis(ordered, np.clip(place, 0, value.shape[-1] - 1), axis=-1)
            same = (value == one) & np.isfinite(value)
            found += same / np.maximum(same.sum(axis=-1, keepdims=True), 1) / len(taken)
        return found

    def summed(self, node: NodeDerivatives) -> NDArray[np.bool_]:
        """The rows that a sum runs over."""
        assert node.over is not None
        everything = np.ones(self.chain.layouts[node.over].size, dtype=bool)
        return self.kept.get(node.of, {}).get(node.over, everything)
