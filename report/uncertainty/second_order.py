"""The terms of second order of the law of propagation (JCGM 100, 5.1.2, note).

They count where a cell's first derivatives vanish or change within the errors themselves: a product of two
errors around zero, say, has no uncertainty to first order. The derivatives are the sheet's own, exact; their
changes are taken from sheets that are computed a little to either side.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..cells.layout import how_large
from ..cells.values import Values, other_rows
from ..distribution import FOURTH
from ..engines.numpy import Program, evaluate
from ..judge.chain import Chain
from ..judge.sensitivity import NumericSweep, without_rounding
from ..result.uncertain import COUNTS, ErrorSource
from ..sheet import Column, Formula, Iterated, Sheet

Array = NDArray[np.float64]

STEP = 1 / 16
"""In standard uncertainties. For cells that are of third order in their inputs any step would do."""
FAR = 2.0
"""In standard uncertainties: about as far as a coverage interval reaches."""
LARGEST = 1 << 23
"""Sheets times cells; beyond, the terms are not looked at."""

NOISE = 2.0**-40
"""Of a value: what changes by less may be its rounding."""

CORNERS = frozenset({"Abs", "Max", "Min", "Piecewise", "sign"})
"""Functions with corners or jumps, as sympy calls them."""


def root_of(number: int, pairs: Sequence[tuple[int, int, float]]) -> Array:
    """What makes correlated errors of independent ones (number, number): a root of their correlation matrix.

    `number`: of sources. `pairs`: the correlation coefficients of some; an error that is in none is itself.
    """
    matrix = np.eye(number)
    for a, b, r in pairs:
        matrix[a, b] = matrix[b, a] = r
    mixed = sorted({n for a, b, _ in pairs for n in (a, b)})
    values, vectors = np.linalg.eigh(matrix[np.ix_(mixed, mixed)])
    root = np.eye(number)
    root[np.ix_(mixed, mixed)] = vectors * np.sqrt(np.maximum(values, 0.0))
    return root


class SecondOrder:
    """What a sheet's second derivatives add to its variances.

    Parameters
    ----------
    chain : Chain
        From the given numbers to all cells.
    program : Program
        Of their sheet.
    root : float array (sources, sources)
        What makes the errors of independent ones: its product with its transpose is their correlation matrix.
    weights : float array (numbers, sources)
        By how much a standard uncertainty of each source moves the numbers that derivatives are taken by.
    """

    def __init__(
        self,
        chain: Chain,
        values: Values,
        program: Program,
        sources: Sequence[ErrorSource],
        root: Array,
        weights: Array,
    ) -> None:
        self.sources, self.root, self.weights = sources, root, weights @ root
        own = np.array([s.law.moment(4) if s.law else FOURTH.get(s.shape, 3.0) for s in sources])
        leans = np.array([s.law.moment(3) if s.law else 0.0 for s in sources])
        alone = np.count_nonzero(root, axis=0) == 1  # what is mixed of several is taken as normal
        self.fourth, self.third = np.where(alone, own, 3.0), np.where(alone, leans, 0.0)
        self.width = 2 * len(sources) * max(1, chain.number)
        self.jumping: dict[str, str] = {}
        """What rests on rows by their order, and how these are taken: where two change places, derivatives
        jump, and they hardly bend."""
        for node in chain.made.nodes:
            words = (self.jumping[slope.by] for slope in node.slopes if slope.by in self.jumping)
            if word := node.word if node.by_order else next(words, ""):
                self.jumping[node.name] = word
        sheet = values.sheet
        sharp = {c.name for c in sheet.columns if _has_corner(c) and not _only_steers(sheet, c)}
        self.cornered = _resting_on(sharp, sheet)
        """What rests on a function that has a corner: near it, derivatives jump."""
        self.above_zero = {name for name in self.cornered if sheet[name].nonnegative}
        self.rough = dict.fromkeys(self.cornered, False) | dict.fromkeys(self.jumping, True)
        """Both, and whether it is the order of rows."""
        number, some = len(sources), np.random.default_rng(1).standard_normal((len(sources), 1))
        sides = np.hstack([np.eye(number), -np.eye(number)])
        steps = np.hstack([sides, FAR / STEP * sides, some @ np.array([[1.0, 2.0, 4.0]])])
        every = beside(values, program, sources, STEP * (root @ steps))
        ends = pairwise((0, 2 * number, 4 * number, 4 * number + 3))
        near, far, together = (every.of_batch(slice(*each)) for each in ends)
        self._along = NumericSweep(chain, near).go()
        with np.errstate(all="ignore"):  # a derivative may be beyond all doubles
            self._through = self._along.whole @ self.weights
        """The derivatives of hubs by the errors (steps, hubs, errors)."""
        self._uses = (self._through != 0).any(axis=0)
        self.torn, self.torn_far = (_resting_on(other_rows(there, values), sheet) for there in (near, far))
        """What rests on sums that run over other rows a step away, and where U reaches: other estimators."""
        self.overdone = set[str]()
        """What has cells of which the terms of second order take away more than half of the first."""
        self.bending = set[str]()
        """What has cells that first order tells near their values, and not as far away as U reaches."""
        self._value, self._near, self._far = values.value, near.value, far.value
        self.creeping = {name: _creeps(found, values.value[name]) for name, found in together.value.items()}
        """How far cells change along all errors at once as a power of them that is higher than the first."""

    def hides(self, name: str, row: int) -> bool:
        """Whether a cell changes, but for terms of third order and higher ones alone, or beyond a corner."""
        return self.creeps(name, row) > 0 or (name in self.rough and self._moves(name, row))

    def shift(self, name: str, row: int) -> float:
        """How far the expectation of a cell is from its value, by its bends along each error."""
        with np.errstate(all="ignore"):
            bends = np.sum(self._far[name][..., row] - self._value[name][row]) / FAR**2
        return float(bends) if self._far[name].ndim > 1 and np.isfinite(bends) else 0.0

    def creeps(self, name: str, row: int) -> float:
        """How far a cell is from its value a step away by terms of second order or higher; else 0.

        Infinite where none of second order are seen, but higher ones.
        """
        found = self.creeping.get(name)
        return 0.0 if found is None else float(found[row])

    def _moves(self, name: str, row: int) -> bool:
        """Whether a cell has another value a step away."""
        there, value = self._near[name][..., row], self._value[name][row]
        return bool(np.any(np.abs(there - value) > NOISE * abs(value)))

    @staticmethod
    def is_small(values: Values, sources: Sequence[ErrorSource]) -> bool:
        """Whether the sheet is small enough for it."""
        return 2 * len(sources) * how_large(values.sheet, values.layouts) <= LARGEST

    def why(self, name: str) -> str:
        """Why nothing is known of a column's cell."""
        if name in self.jumping:
            return f"it rests on a {self.jumping[name]}, which other rows take over when inputs move"
        if name in self.cornered:
            return "it has a corner here (Abs, Max, Min or cases), where derivatives jump"
        if name in self.torn:
            return f"{STEP:.2g} u from what was given its sums run over other rows"
        if name in self.bending and name in self.torn_far:
            return f"{FAR:g} u from what was given its sums run over other rows"
        if name in self.bending:
            return (
                f"it is no straight line as far as {FAR:g} u from what was given, though near its value it is"
            )
        if name in self.overdone:
            return "its terms take away most of those of first order, so that others count, too"
        return "the sheet has no values so far from what was given"

    def variance(self, cells: Sequence[tuple[str, int]], first: Array, little: bool = False) -> Array:
        """The variance of some cells that the terms of second order make (cells,).

        Parameters
        ----------
        first : float array (cells, sources)
            What each source contributes to first order.
        little : bool
            Whether what does not count is asked for, too.

        Returns
        -------
        float array (cells,)
            In the squares of the cells' SI units; 0 where it does not count, unless that is asked for. NaN
            where a cell has no value so near to its own, has it of sums over other rows, or rests on what is
            taken by order; and where terms that count come from a function with corners.
        """
        with np.errstate(all="ignore"):
            used, up, down = self._nearby(cells, still=np.all(first == 0, axis=1))
            first = np.take_along_axis(first @ self.root, used, axis=1)
            fourth, third_moment = self.fourth[used][:, None, :], self.third[used][:, None, :]
            # [cell, i, j]: by error i and error j, and by i and twice by j
            second = np.swapaxes(up - down, 1, 2) / (2 * STEP)
            third = np.swapaxes(up - 2 * first[:, None, :] + down, 1, 2) / STEP**2
            itself = np.eye(used.shape[1], dtype=bool)
            bends = second**2 * np.where(itself, (fourth - 1) / 4, 1 / 2)
            turns = first[:, :, None] * third * np.where(itself, fourth / 3, 1.0)
            turns += first[:, :, None] * second * np.where(itself, third_moment, 0.0)
            bent, turned = bends.sum(axis=(1, 2)), turns.sum(axis=(1, 2))
            own = np.sum(first**2, axis=1)
            more = bent + turned
            values = np.array([self._value[name][row] for name, row in cells])
            rounding = own <= np.square(NOISE * values)
            # Of terms that alternate and fall so slowly the next ones count, too.
            overdone = (more < -own / 2) & ~rounding
            self.overdone |= {name for (name, _), is_over in zip(cells, overdone, strict=True) if is_over}
            more = np.where(own + more > 0, more, bent)  # a sum that would be negative is no variance
            nothing = np.maximum(bent, np.abs(more)) <= COUNTS * own
            bending = nothing & ~rounding & (self._bent_far(cells, used, first) > COUNTS * own)
            self.bending |= {name for (name, _), is_bent in zip(cells, bending, strict=True) if is_bent}
            unknown = np.array([name in self.jumping or name in self.torn for name, _ in cells], dtype=bool)
            cornered = np.array([name in self.cornered for name, _ in cells], dtype=bool)
            # What cannot be negative has its corner at 0, and all errors together reach it.
            reached = np.array([name in self.above_zero for name, _ in cells], dtype=bool)
            reached &= FAR * np.sqrt(own) > values
            sharp = cornered & (~nothing | reached)
            told = more if little else np.where(nothing, 0.0, more)
            found: Array = np.where(unknown | sharp | overdone | bending, np.nan, told)
        return found

    def _bent_far(self, cells: Sequence[tuple[str, int]], used: NDArray[np.intp], first: Array) -> Array:
        """The variance that bends would make which make what is off as far away as U reaches (cells,)."""
        half = len(self.sources)
        off = np.zeros((2, *used.shape))
        for n, (name, row) in enumerate(cells):
            far = np.broadcast_to(self._far[name], (2 * half, len(self._value[name])))[:, row]
            change = FAR * first[n]
            off[:, n] = far[used[n]] - change, far[half + used[n]] + change
            off[:, n] -= self._value[name][row]
        # By a second derivative f'' it is FAR^2 f'' / 2, and the variance is f''^2 / 2.
        found: Array = np.sum(np.nan_to_num(off) ** 2, axis=(0, 2)) / FAR**4
        return found

    def _nearby(
        self, cells: Sequence[tuple[str, int]], still: NDArray[np.bool_]
    ) -> tuple[NDArray[np.intp], Array, Array]:
        """The independent errors that some cells rest on, and derivatives a step up and down along each.

        Parameters
        ----------
        still : bool array (cells,)
            Cells that do not change by first order: there the rounding of derivatives would be told.

        Returns
        -------
        integer array (cells, errors)
            Their numbers. Cells that rest on fewer than others have some on which they do not rest.
        float arrays (cells, errors, errors)
            At [cell, i, j] a step along i, by j.
        """
        along, half = self._along, len(self.sources)
        pattern = along.chain.cells(cells)
        direct = pattern.by < len(self.weights)
        rows, by, at = pattern.rows[direct], pattern.by[direct], pattern.entries[direct]
        place = _places(rows)
        entries = np.zeros((len(cells), place.max(initial=-1) + 1), dtype=np.intp)
        weights = np.zeros((*entries.shape, half))
        entries[rows, place], weights[rows, place] = at, self.weights[by]
        rows, by, at = pattern.rows[~direct], pattern.by[~direct], pattern.entries[~direct]
        hubs = by - len(self.weights)
        uses = (weights != 0).any(axis=1)
        np.logical_or.at(uses, rows, self._uses[hubs])
        used = np.argsort(~uses, axis=1, kind="stable")[:, : uses.sum(axis=1).max(initial=0)]
        weights = np.take_along_axis(weights, used[:, None, :], axis=2)
        # The rows of a column name the same hubs: all of them at once, along every error.
        named, which = np.unique(hubs, return_inverse=True)
        by_hubs = np.zeros((2 * half, len(cells), named.size))
        by_hubs[:, rows, which] = along.entries[:, at]
        through, cell = by_hubs @ self._through[:, named], np.arange(len(cells))[:, None, None]
        terms = np.zeros_like(through)
        terms[:, still] = np.abs(by_hubs[:, still]) @ np.abs(self._through[:, named])

        def stepped(step: NDArray[np.intp]) -> Array:
            step = step[:, :, None]
            own = along.entries[step, entries[:, None, :]] @ weights
            place = step, cell, used[:, None, :]
            return without_rounding(own + through[place], terms[place])

        up, down = stepped(used), stepped(half + used)
        for n, odd in along.without_value(cells):
            dead = np.broadcast_to(odd, 2 * half)
            up[n, dead[used[n]]] = down[n, dead[half + used[n]]] = np.nan
        return used, up, down


def _places(rows: NDArray[np.intp]) -> NDArray[np.intp]:
    """The place of each entry among those of its row."""
    order = np.argsort(rows, kind="stable")
    first = np.searchsorted(rows[order], rows[order])
    found = np.empty_like(order)
    found[order] = np.arange(order.size) - first
    return found


def _has_corner(column: Column) -> bool:
    """Whether its formula has a function with a corner; one of which only a part is known has none."""
    if not isinstance(column.rule, Formula) or column.mentioned is not None:
        return False
    return bool(column.rule.expression.find(lambda part: type(part).__name__ in CORNERS))


def _only_steers(sheet: Sheet, column: Column) -> bool:
    """Whether it says how far a loop steps, and no more: where that rests, what it multiplies is nothing."""
    loop, users = sheet.loop_of.get(column.name), sheet.dependents(column)
    return loop is not None and all(
        isinstance(user.rule, Iterated) and not ((user.rule.step - user.cell) / column.cell).has(column.cell)
        for user in users
    )


def _creeps(found: Array, value: Array) -> Array:
    """How far cells (3, rows) are at one step from their values (rows,), if they leave faster and faster.

    `found`: at one, two and four steps. What eight times as much becomes of two steps is of third order or
    higher: no first and no second derivative is told there by slopes a step to either side (infinite).
    """
    with np.errstate(all="ignore"):
        one, two, four = np.abs(np.broadcast_to(found, (3, value.size)) - value)
        seen: NDArray[np.bool_] = (one > 0) & (four > NOISE * np.abs(value))
        least = np.minimum(two / one, four / two)
    return np.where(seen & (least >= 7), np.inf, np.where(seen & (least >= 3), one, 0.0))


def _resting_on(names: Collection[str], sheet: Sheet) -> set[str]:
    """The columns that are one of some, or rest on one."""
    return {c.name for c in sheet.columns if any(own.name in names for own in (c, *sheet.ancestors(c)))}


def beside(values: Values, program: Program, sources: Sequence[ErrorSource], errors: Array) -> Values:
    """The sheets with such errors, in standard uncertainties (sources, sheets): of each (sheets, rows)."""
    sheet = values.sheet
    moved = {
        name: np.tile(values.value[name], (errors.shape[1], 1))
        for name in dict.fromkeys(name for source in sources for name, _, _ in source.moves)
    }
    for source, own in zip(sources, errors, strict=True):
        for name, row, u in source.moves:
            moved[name][:, row] += u * own
    given = {name: values.value[name] for name in sheet.bounds if name in values.value}
    return evaluate(sheet, values.given_labels, given | moved, program)
