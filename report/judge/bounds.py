"""What rounding may do to every cell: all roundings of a sheet, each times what it does to the cell.

To first order the error of a cell is at most eps times the sum, over all cells and sums s that it rests on,
of |dc/ds| R_s, with the total derivative dc/ds along all ways from s to c: what cancels between two ways
cancels here too. This bound over |c|, at least 1, is the condition of the cell. What has no slope where it
is, as the square of a difference of equal numbers, has one where rounding may leave these: there a judge
asks, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..cells.layout import Layout
from ..cells.values import Status, Values
from ..plan.order import places
from ..plan.slopes import NodeDerivatives, Slope
from ..result.agreement import LIMIT
from ..sheet import Sheet
from .chain import Chain, SheetDerivatives
from .sensitivity import NumericSweep

Array = NDArray[np.float64]
EPS = float(np.finfo(float).eps)


MOVES = 3
"""How often values are moved, before a difference is one: by chance two may move alike."""


class RoundingBounds(Mapping[str, Array]):
    """A bound of the rounding error of every cell.

    By column name, of shape (rows,), where the values are; in SI and units of eps, at least the cell's own
    size; infinite where nothing is known, NaN where the cell has no value.

    Parameters
    ----------
    layouts : mapping of axis name to Layout
    value : mapping of column name to float array (rows,)
        All columns in SI; NaN where a cell has no value.
    """

    def __init__(self, sheet: Sheet, layouts: Mapping[str, Layout], value: Mapping[str, Array]) -> None:
        made = SheetDerivatives.of(sheet, True)
        sources, number = {}, 0
        for node in made.nodes:
            size = 1 if node.axis is None else layouts[node.axis].size
            sources[node.name], number = np.arange(number, number + size), number + size
        self.chain = Chain(made, layouts, sources)
        self.sheet, self.layouts, self.value = sheet, layouts, value
        self.tried: list[dict[str, Array]] = []
        self.bare = self._at(value)
        self.room = {name: np.where(np.isfinite(own), own, 0.0) for name, own in self.bare.items()}

    def __getitem__(self, name: str) -> Array:
        return self.bare[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.bare)

    def __len__(self) -> int:
        return len(self.bare)

    def _at(self, value: Mapping[str, Array]) -> dict[str, Array]:
        status = {name: np.where(np.isnan(each), Status.INPUT, Status.OK) for name, each in value.items()}
        return _Spread(self.chain, Values(self.sheet, self.layouts, value, status)).bounds()

    def after_moves(self, number: int) -> dict[str, Array]:
        """The largest bounds where all values are off, each by a random share of what rounding may leave.

        Not less than those where the values are; what is not known there stays.
        """
        while len(self.tried) <= number:
            found = {}
            for name, there in self._near(len(self.tried)).items():
                here = self.tried[-1][name] if self.tried else self.bare[name]
                found[name] = np.where(np.isfinite(there), np.maximum(here, there), here)
            self.tried.append(found)
        return self.tried[number]

    def _near(self, seed: int) -> dict[str, Array]:
        """The bounds where all values are off.

        Of a root of zero nothing is known where the values are. Next to them it is, and then of what is
        computed from it, too.
        """
        while True:
            draw = np.random.default_rng(seed).uniform
            moved = {}
            for name, own in self.value.items():
                share = draw(-1, 1, own.size)
                if self.sheet[name].nonnegative:
                    share = np.where(own == 0, np.abs(share), share)  # below there is no root
                moved[name] = own + LIMIT * EPS * self.room[name] * share
            there = self._at(moved)
            news = {name: (room == 0) & np.isfinite(there[name]) for name, room in self.room.items()}
            if not any(np.any(new & (there[name] > 0)) for name, new in news.items()):
                return there
            self.room = {name: np.where(news[name], there[name], room) for name, room in self.room.items()}

    def allowing(self, name: str, row: int, difference: float) -> float:
        """The bound for a cell that differs by so much: that where its values are, if it is enough."""
        bound = float(self.bare[name][row])
        for number in range(MOVES):
            if not difference > LIMIT * EPS * bound:
                break
            bound = float(self.after_moves(number)[name][row])
        return bound


EXPANDED = 1 << 24
"""Up to so many numbers, what hubs do to a column's rows is added up source by source; beyond, their
bounds are added, which is never less."""


@dataclass(frozen=True)
class _Entries:
    """A matrix of few entries, in the order of its rows and columns; a product adds them up in this order."""

    values: Array
    rows: NDArray[np.intp]
    columns: NDArray[np.intp]
    size: int

    @property
    def counts(self) -> NDArray[np.intp]:
        """How many each row has."""
        return np.bincount(self.rows, minlength=self.size)

    def __abs__(self) -> _Entries:
        return replace(self, values=np.abs(self.values))

    def __matmul__(self, other: Array) -> Array:
        found: Array = np.bincount(self.rows, self.values * other[self.columns], self.size).astype(np.float64)
        return found

    def dense(self, columns: int) -> Array:
        """All of its numbers."""
        places = self.rows * columns + self.columns
        found: Array = np.bincount(places, self.values, self.size * columns).astype(np.float64)
        return found.reshape(self.size, columns)

    def times(self, other: Array) -> Array:
        """The product with a matrix."""
        found = np.zeros((self.size, other.shape[1]))
        place = np.arange(self.rows.size) - np.searchsorted(self.rows, self.rows)
        for n in range(place.max(initial=-1) + 1):
            which = place == n
            found[self.rows[which]] += self.values[which, None] * other[self.columns[which]]
        return found


class _Spread(NumericSweep):
    """The total derivatives of every node by all roundings there are.

    A slope that is not known has no entry, and the rounding of its node may be anything.
    """

    def __init__(self, chain: Chain, values: Values) -> None:
        super().__init__(chain, values)
        self.rounding = np.zeros(chain.number)
        for node in chain.made.nodes:
            own = self.parts[node.rounding]
            alive = node.over is not None or ~np.isnan(values.value[node.of])
            # What has no value has no error; a value whose rounding is unknown may be wrong by anything.
            self.rounding[chain.sources[node.name]] = np.where(alive, np.where(np.isnan(own), np.inf, own), 0)

    def bounds(self) -> dict[str, Array]:
        found = {}
        with np.errstate(all="ignore"):  # a derivative beyond all doubles leaves nothing known of the cell
            self.go()
            of_hubs = self.weighed(self.whole)
            for name in self.values.sheet.by_name:
                own, total = np.abs(self.values.value[name]), self.total(name, of_hubs)
                found[name] = np.where(np.isnan(own), np.nan, np.maximum(total, own))
        return found

    def total(self, name: str, of_hubs: Array) -> Array:
        """All roundings times what they do to each row of a column."""
        direct, hubs = self.matrices(name)
        if hubs.counts.max(initial=0) == 1:
            return self.beside_one(direct, hubs, of_hubs)
        if hubs.rows.size and direct.size * self.chain.number <= EXPANDED:
            return self.weighed(direct.dense(self.chain.number) + hubs.times(self.whole))
        return self.weighed(direct) + _weighed(hubs, of_hubs)

    def beside_one(self, direct: _Entries, hubs: _Entries, of_hubs: Array) -> Array:
        """The same where no row rests on two hubs: what one does to a row, and what is other beside it."""
        size, rows, by = direct.size, direct.rows, direct.columns
        times, which = np.zeros(size), np.zeros(size, dtype=np.intp)
        times[hubs.rows], which[hubs.rows] = hubs.values, hubs.columns
        theirs, errors = times[rows] * self.whole[which[rows], by], self.rounding[by]
        both = direct.values + theirs
        more = np.where(np.isinf(errors) & (both != 0), np.inf, (np.abs(both) - np.abs(theirs)) * errors)
        found = np.where(times == 0, 0.0, np.abs(times) * of_hubs[which])
        total: Array = found + np.bincount(rows, np.where(both == theirs, 0.0, more), size)
        return np.where(np.isfinite(total), total, np.inf)

    def matrices(self, name: str) -> tuple[_Entries, _Entries]:
        """The derivatives of a column by ways that pass no hub, and those by hubs."""
        chain, cells = self.chain, self.chain.patterns[name]
        order = np.lexsort((cells.by, cells.rows))
        rows, by, entries = cells.rows[order], cells.by[order], self.entries[cells.entries[order]]
        direct, size = by < chain.number, chain.sources[name].size
        own, hubs = (
            _Entries(entries[which], rows[which], by[which] - first, size)
            for which, first in ((direct, 0), (~direct, chain.number))
        )
        return own, hubs

    def weighed(self, derivatives: Any) -> Array:
        """The sizes of derivatives times all roundings."""
        return _weighed(derivatives, self.rounding)

    def slope(self, node: NodeDerivatives, slope: Slope) -> Array:
        found = super().slope(node, slope)
        if (unknown := np.isnan(found)).any():
            rows = self.chain.sources[node.name]
            odd = unknown.any() if node.over else unknown & ~np.isnan(self.values.value[node.of])
            self.rounding[rows] = np.where(odd, np.inf, self.rounding[rows])
        return np.nan_to_num(found)

    def share(self, node: NodeDerivatives, name: str, rows: NDArray[np.intp]) -> Array:
        """A row that rounding may exchange with one that is taken counts as that one does."""
        value, summed = self.values.value[name][rows], self.summed(node)
        room = LIMIT * EPS * self.total(name, self.weighed(self.whole))[rows]
        found: Array = np.zeros(value.size)
        for own in self.groups(node):
            ordered = np.sort(value[own][summed[own]])
            taken = ordered[list(places(node.word, ordered.size))] if ordered.size else ordered
            for one in taken.tolist():
                found[own] += (np.abs(value[own] - one) <= room[own]) / taken.size
        return np.where(summed, found, 0.0)


def _weighed(derivatives: Any, errors: Array) -> Array:
    """The sizes of derivatives times errors; an infinite error counts only where something rests on it."""
    sizes, known = abs(derivatives), np.isfinite(errors)
    total: Array = sizes @ np.where(known, errors, 0.0)
    return np.where((sizes @ (~known).astype(float) > 0) | ~np.isfinite(total), np.inf, total)
