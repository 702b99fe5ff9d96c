"""The chain rule over the rows of a sheet: which cell rests on which, and along which ways.

That is the same whatever the values, and is found once. Along it go numbers, whole batches of them, or
intervals (:mod:`~loopsheet.report.judge.sensitivity`).

A row rests on few cells, but by way of a scalar, a mean say, on almost all: a hub, as the total of a large
group of rows is one to these. So a derivative is kept in two parts: the entries of a row by ways that pass no
hub, and its entries by hubs; what these rest on is kept once.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..cells.layout import Layout
from ..engines.numpy import Laid, Program
from ..plan.kept import as_data, of_data, of_sheet
from ..plan.slopes import NodeDerivatives, Slope, with_unknowns
from ..sheet import Sheet

Numbered = NDArray[np.intp]
_NONE = np.zeros(0, dtype=np.intp)

MOST = 1 << 18
"""So many entries of rows by one another are kept, without a hub."""


@dataclass(frozen=True)
class SheetDerivatives:
    """The derivatives of a sheet: its nodes, each after those that it names, and what computes them."""

    nodes: tuple[NodeDerivatives, ...]
    program: Program

    @classmethod
    def of(cls, sheet: Sheet, roundings: bool = False) -> SheetDerivatives:
        """Make them, what rounding does only if it is asked for; or take them as they were made before."""

        def make() -> dict[str, Any]:
            from ..engines.numpy_texts import program_texts
            from ..plan.derivatives import derivatives

            found = derivatives(sheet, roundings)
            texts = program_texts(with_unknowns(sheet, found.again), found.plan)
            return {"nodes": as_data(found.nodes), "again": found.again, "program": texts}

        told = of_sheet(sheet, "derivatives and roundings" if roundings else "derivatives", (), make)
        nodes = of_data(told["nodes"], tuple[NodeDerivatives, ...])
        return cls(nodes, Program.of_texts(with_unknowns(sheet, told["again"]), told["program"]))

    def only(self, names: Collection[str]) -> SheetDerivatives:
        """Those of some nodes, and of what they rest on."""
        needed, kept = set(names), []
        for node in reversed(self.nodes):
            if node.name in needed:
                needed.update(slope.by for slope in node.slopes)
                kept.append(node)
        return replace(self, nodes=tuple(reversed(kept)))


@dataclass(frozen=True)
class SparseRows:
    """Entries of a node or of some cells, those of a row beside one another."""

    rows: Numbered
    by: Numbered
    entries: Numbered
    """`rows`, `by` and `entries`: of shape (entries,); the row of each, the number of what it is a derivative
    by (behind all sources, of a hub), and its place among the entries of all nodes."""

    def by_hubs(self, sources: int) -> tuple[Numbered, Numbered, Numbered, Numbered]:
        """What comes by way of hubs: their numbers behind the sources, and the places of the entries.

        Those of a row are beside one another; the first of each row, and which row that is, follow.
        """
        if sources not in self._by_hubs:
            own = np.flatnonzero(self.by >= sources)
            own = own[np.lexsort((self.by[own], self.rows[own]))]
            first = np.flatnonzero(np.diff(self.rows[own], prepend=-1))
            self._by_hubs[sources] = (
                self.by[own] - sources,
                self.entries[own],
                first,
                self.rows[own[first]],
            )
        return self._by_hubs[sources]

    @cached_property
    def _by_hubs(self) -> dict[int, tuple[Numbered, Numbered, Numbered, Numbered]]:
        return {}

    def only(self, rows: Numbered) -> SparseRows:
        """That of some rows, one after another, numbered anew; a row may come twice."""
        first, last = (np.searchsorted(self.rows, rows, side) for side in ("left", "right"))
        counts = last - first
        which = np.arange(counts.sum()) + np.repeat(first - np.cumsum(counts) + counts, counts)
        return SparseRows(np.repeat(np.arange(rows.size), counts), self.by[which], self.entries[which])


@dataclass(frozen=True)
class Level:
    """Nodes that rest on none of one another."""

    nodes: tuple[NodeDerivatives, ...]
    slopes: tuple[tuple[NodeDerivatives, Slope, slice], ...]
    """The slopes of all of them, one after another."""
    of: Numbered
    along: Numbered
    """`of` and `along`: of shape (terms,); the slope of each term of their entries, and the entry that it is
    multiplied with."""
    starts: Numbered
    """Of shape (entries,); the first term of each entry."""
    entries: slice
    """The places of these."""

    @property
    def width(self) -> int:
        """How many rows all slopes have."""
        return self.slopes[-1][2].stop if self.slopes else 0


class Chain:
    """Which cells rest on which, over the rows of a sheet.

    Parameters
    ----------
    made : SheetDerivatives
        The sheet's derivatives.
    layouts : mapping of axis name to Layout
    sources : mapping of node name to integer array (rows,)
        For what derivatives are taken by, the number of each row among all of it; -1 for a row that is not.
    """

    def __init__(
        self, made: SheetDerivatives, layouts: Mapping[str, Layout], sources: Mapping[str, Numbered]
    ) -> None:
        self.made, self.layouts, self.sources = made, layouts, sources
        self.number = 1 + max((int(own.max(initial=-1)) for own in sources.values()), default=-1)
        nodes = made.nodes
        self.sizes = {node.name: self.size(node) for node in nodes}
        computed = [node.name for node in nodes if node.axis is None and node.slopes]
        self.hubs = {name: self.number + n for n, name in enumerate(computed)}
        """The number of the first row of each, behind all sources."""
        self.hubs_number = len(computed)
        self.length = 1
        """How many entries there are. The first is 1."""
        self.patterns: dict[str, SparseRows] = {}
        for node in nodes:
            by = sources.get(node.name, _NONE)
            rows = np.flatnonzero(by >= 0)
            self._add(node.name, rows, by[rows])
        self.ones = self.length  # what a source is by itself
        depth: dict[str, int] = {}
        for node in nodes:
            depth[node.name] = max((1 + depth[slope.by] for slope in node.slopes), default=0)
        deep = sorted(nodes, key=lambda node: depth[node.name])
        self.steps = [self._step(tuple(own)) for _, own in groupby(deep, key=lambda node: depth[node.name])]

    def size(self, node: NodeDerivatives) -> int:
        """How many rows a node has."""
        return 1 if node.axis is None else self.layouts[node.axis].size

    def terms(self, node: NodeDerivatives) -> int:
        """How many rows its slopes have."""
        return self.size(node) if node.over is None else self.layouts[node.over].size

    def totals(self, node: NodeDerivatives) -> Numbered:
        """For each row that a total runs over, the row of the total: of the only one, or of a group's."""
        own = np.zeros(self.terms(node), dtype=np.intp)
        if node.axis is not None and node.over is not None:
            for group, rows in enumerate(self.layouts[node.over].groups):
                own[rows] = group
        return own

    def named(self, node: NodeDerivatives, slope: Slope) -> Numbered:
        """The row of what a slope is by, for each row of the slope."""
        number = self.terms(node)
        if slope.axis is None:
            return np.zeros(number, dtype=np.intp)
        return np.arange(number) if slope.index is None else self.layouts[slope.axis].rows[slope.index]

    def cells(self, places: Sequence[tuple[str, int]]) -> SparseRows:
        """The entries of some cells, by column and row; each cell is a row."""
        numbers: dict[str, list[int]] = {}
        for number, (name, _) in enumerate(places):
            numbers.setdefault(name, []).append(number)
        found = [(_NONE, _NONE, _NONE)]
        for name, which in numbers.items():
            own = self.patterns[name].only(np.array([places[number][1] for number in which]))
            found.append((np.array(which)[own.rows], own.by, own.entries))
        rows, by, entries = map(np.concatenate, zip(*found, strict=True))
        return SparseRows(rows, by, entries)

    @cached_property
    def laid(self) -> Laid:
        """The sheet of the derivatives over the rows."""
        return Laid(self.made.program.sheet, dict(self.layouts))

    def _step(self, nodes: tuple[NodeDerivatives, ...]) -> Level:
        """The nodes' entries, and how they come about."""
        first, width, terms = self.length, 0, 0
        slopes, of, along, starts = [], [_NONE], [_NONE], [_NONE]
        for node in nodes:
            every = []
            for slope in node.slopes:
                theirs = self._theirs(node, slope)
                rows = theirs.rows if node.over is None else self.totals(node)[theirs.rows]
                every.append((rows, theirs.by, width + theirs.rows, theirs.entries))
                slopes.append((node, slope, slice(width, width + self.terms(node))))
                width += self.terms(node)
            if every:
                rows, by, mine, others = map(np.concatenate, zip(*every, strict=True))
                order = np.lexsort((by, rows))
                rows, by = rows[order], by[order]
                begins = np.flatnonzero(np.diff(rows, prepend=-1) | np.diff(by, prepend=-1))
                starts.append(terms + begins)
                of.append(mine[order])
                along.append(others[order])
                terms += order.size
                self._add(node.name, rows[begins], by[begins])
                if node.name not in self.hubs and self._is_hub(node.name):
                    self.hubs[node.name] = self.number + self.hubs_number
                    self.hubs_number += self.sizes[node.name]
        terms_of, theirs_at, begin = (np.concatenate(each) for each in (of, along, starts))
        return Level(nodes, tuple(slopes), terms_of, theirs_at, begin, slice(first, self.length))

    def _add(self, name: str, rows: Numbered, by: Numbered) -> None:
        """Entries of a node."""
        own, entries = self.patterns.get(name), np.arange(self.length, self.length + rows.size)
        self.length += rows.size
        if own is not None:
            rows, by = np.concatenate([own.rows, rows]), np.concatenate([own.by, by])
            entries = np.concatenate([own.entries, entries])
        order = np.argsort(rows, kind="stable")
        self.patterns[name] = SparseRows(rows[order], by[order], entries[order])

    def _theirs(self, node: NodeDerivatives, slope: Slope) -> SparseRows:
        """The entries of what a slope is by, for each row of the slope."""
        if slope.by not in self.hubs:
            return self.patterns[slope.by].only(self.named(node, slope))
        rows = np.arange(self.terms(node))
        return SparseRows(rows, self.hubs[slope.by] + self.named(node, slope), np.zeros_like(rows))

    def _is_hub(self, name: str) -> bool:
        """Whether few rows of a node rest on so many that as many rows resting on it had too many entries."""
        own, rows = self.patterns[name].rows.size, self.sizes[name]
        return rows * rows <= own and own * own > rows * MOST
