"""The law of propagation of uncertainty over a whole sheet (JCGM 100, 5.1 and 5.2).

A cell's derivatives by all that was given come from the sheet itself, exactly
(:mod:`~loopsheet.report.judge.sensitivity`). What two cells share is counted once: a mean of pairs that rest
on the same tests has the variance it has, no other.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..cells.address import address
from ..cells.layout import how_large, precedents
from ..cells.values import Status, Values, rows_kept
from ..distribution import DIVISORS, LEVEL, PARTS, Shape
from ..engines.numpy import Program
from ..inputs.inputs import Inputs
from ..inputs.limits import Limits
from ..judge.chain import Chain, SheetDerivatives
from ..judge.sensitivity import AT_ONCE, NumericSweep
from ..result.uncertain import (
    COUNT,
    COUNTS,
    UNLOOKED,
    Budget,
    Conformity,
    Contribution,
    Influence,
    Misfit,
    Scattered,
    Together,
    Uncertainties,
)
from ..sheet import Column, CountedAxis, Given, PairAxis, RepeatAxis
from ..workbook import Curve, SquareSum, Workbook
from .conformity import conformity, past
from .coverage import assigned, coverage, of_sum, with_correlated
from .large import Contributions, largest
from .misfit import least_squares_of_errors
from .monte_carlo import SOME, by_draws, sample
from .second_order import SecondOrder, beside, root_of
from .sources import correlated, given, sources

Array = NDArray[np.float64]

LARGEST = 300_000
"""Cells; beyond, nothing is told of what rests on generated rows: the way to each would have to be held."""
MOST_BUDGETS = 20
"""Budgets of a report."""
MOST_CELLS = 300
"""Of a column that is summed; of more, nobody reads eigenvalues."""
MOST_PASSED = 100_000
"""Influences on the rows of columns that are passed on to other reports: some megabytes of a file."""
ROUNDED = 2.0**-52
"""Of a value: an uncertainty that is less may come from the rounding of a derivative that is 0."""
ROUNDINGS = 2.0**10
"""It is at most so many times that, times what share of an input its uncertainty is."""
MOST_ROWS = 1000
"""Of a curve; of more, the covariance of all residuals is too large to be taken apart."""
FARTHEST = 5.0
"""In standard uncertainties: an error comes that far once in a million times."""
MOST_DRAWN = 1 << 24
"""Numbers: of a column of which there would be more, each cell is drawn by itself."""
MOVED = 1e-3
"""A probability that bending changes by less is told by first order: draws leave as much open."""
NOTHING = 1e-12
"""A contribution that is less than this share of the largest is left out of a budget."""


class Spread:
    """How the errors of what was given spread over a sheet.

    Parameters
    ----------
    values : Values
        All columns, without a batch.
    like : Spread, optional
        Of other values of the same sheet: what is made of the sheet alone is then taken from it.

    Attributes
    ----------
    sources : tuple of ErrorSource
    """

    def __init__(self, inputs: Inputs, values: Values, like: Spread | None = None) -> None:
        self.inputs, self.values = inputs, values
        self.sources = sources(inputs, values)
        self._pairs = correlated(self.sources, inputs, values)
        numbers, size = {}, 0
        for column in given(values):
            rows = len(values.labels(column))
            numbers[column.name] = np.arange(size, size + rows)
            size += rows
        self._numbers = numbers
        moves = [(n, *move) for n, source in enumerate(self.sources) for move in source.moves]
        self._by = np.array([numbers[name][row] for _, name, row, _ in moves], dtype=np.intp)
        self._u = np.array([u for *_, u in moves])
        self._first = np.searchsorted([n for n, *_ in moves], np.arange(len(self.sources)))
        sizes = [max(map(self._share, source.moves), default=0.0) for source in self.sources]
        self._shares = np.array(sizes or [0.0])
        self._known = _known(values)
        self._sample: tuple[str, list[Array]] | None = None
        self._made: SheetDerivatives = like._made if like else SheetDerivatives.of(values.sheet)
        self._program: Program | None = like._program if like else None
        shared = like._chain if like and self._lies_as(like) else None
        self._chain: Chain = shared or Chain(self._made.only(self._known), values.layouts, numbers)
        self._along = NumericSweep(self._chain, values).go()
        self.second: SecondOrder | None = None
        """What is of second order; None for a sheet that is too large."""
        if self.sources and SecondOrder.is_small(values, self.sources):
            self._program = self._program or Program.of(values.sheet)
            root = root_of(len(self.sources), self._pairs)
            weights = np.zeros((size, len(self.sources)))
            np.add.at(weights, (self._by, np.array([n for n, *_ in moves])), self._u)
            self.second = SecondOrder(self._chain, values, self._program, self.sources, root, weights)

    def _share(self, move: tuple[str, int, float]) -> float:
        """Of what is moved, at most all of it."""
        name, row, u = move
        moved = abs(self.values.value[name][row])
        return min(1.0, abs(u) / moved) if moved else 1.0

    def _lies_as(self, other: Spread) -> bool:
        """Whether all rows stand where those of another do, so that the same ways lead between cells."""
        own, theirs = self.values.layouts, other.values.layouts
        alike = own.keys() == theirs.keys() and all(
            np.array_equal(layout.labels, theirs[name].labels) for name, layout in own.items()
        )
        return alike and self._known == other._known

    def contributions(self, cells: Sequence[tuple[str, int]]) -> Array:
        """What each source contributes to some cells, with its sign.

        Parameters
        ----------
        cells : sequence of (str, int)
            Columns and rows.

        Returns
        -------
        float array (cells, sources)
            In the SI unit of each cell; NaN for a cell without a value.
        """
        if not self.sources:
            dead = [self.values.status[name][row] != Status.OK for name, row in cells]
            return np.where(np.array(dead, dtype=bool)[:, None], np.nan, np.zeros((len(cells), 1)))
        return self._by_source(self._along.at(cells))

    def knows(self, name: str) -> bool:
        """Whether anything is told of a column."""
        return name in self._known

    def _by_source(self, derivatives: Array) -> Array:
        """From derivatives by the given numbers to what a standard uncertainty of each source does."""
        with np.errstate(all="ignore"):  # a derivative may be beyond all doubles
            moved = derivatives[..., self._by] * self._u
            found: Array = np.add.reduceat(moved, self._first, axis=-1)
        return found

    def u(self, name: str) -> Array:
        """The combined standard uncertainty of every row of a column (rows,), in SI."""
        found = np.sqrt(np.sum(self.variances(name), axis=0))
        return np.where(np.isfinite(found), found, np.nan)

    def variances(self, name: str) -> Array:
        """The variance of every row of a column, of first order and of second (2, rows), in SI."""
        rows = len(self.values.status[name])
        found = np.full((2, rows), np.nan)
        for cells, own in self._blocks(name) if name in self._known else ():
            first, second = self._orders(cells, own)
            found[:, cells[0][1] : cells[-1][1] + 1] = first, np.nan_to_num(second)
        found[0, self.values.status[name] != Status.OK] = np.nan
        return found

    def _blocks(self, name: str) -> Iterator[tuple[list[tuple[str, int]], Any]]:
        """All cells of a column with their :meth:`contributions`, as many at once as memory holds.

        Of a column that memory does not hold at once all cells come together: without their zeros, as a
        sparse array, or, where these are too few for what they share, as
        :class:`~loopsheet.report.uncertainty.large.Contributions`.
        """
        chain, rows = self._along.chain, len(self.values.status[name])
        if self.second or not self.sources or rows * chain.number <= AT_ONCE:
            yield from ((cells, self.contributions(cells)) for cells in self._some(name))
            return
        from scipy.sparse import csr_array

        pattern, number = chain.patterns[name], chain.number
        entries, of = self._along.entries[pattern.entries], pattern.by >= number
        slopes, by_hubs = (
            csr_array((entries[own], (pattern.rows[own], pattern.by[own] - behind)), (rows, width))
            for own, behind, width in ((~of, 0, number), (of, number, chain.hubs_number))
        )
        sources = np.repeat(np.arange(len(self.sources)), np.diff(self._first, append=self._by.size))
        weights = csr_array((self._u, (self._by, sources)), (number, len(self.sources)))
        with np.errstate(all="ignore"):  # a derivative may be beyond all doubles
            found = Contributions(slopes, by_hubs, self._along.whole, weights)
            yield (
                [(name, row) for row in range(rows)],
                found.sparse() if not by_hubs.nnz or found.filled <= AT_ONCE else found,
            )

    def _some(self, name: str) -> Iterator[list[tuple[str, int]]]:
        """All cells of a column, as many at once as memory holds."""
        rows = len(self.values.status[name])
        width = max(1, self._along.chain.number, self.second.width if self.second else 0)
        some = max(1, AT_ONCE // width)
        for first in range(0, rows, some):
            yield [(name, row) for row in range(first, min(first + some, rows))]

    def _more(self, cells: Sequence[tuple[str, int]], own: Any) -> Array:
        """The variance of second order; NaN where it is not known."""
        if not self.sources:
            return np.zeros(len(cells))
        return np.full(len(cells), np.nan) if self.second is None else self.second.variance(cells, own)

    def covariance(self, cells: Sequence[tuple[str, int]]) -> Array:
        """Variances and covariances of some cells (cells, cells)."""
        found = self.contributions(cells)
        with np.errstate(all="ignore"):
            beside: Array = with_correlated(found, self._pairs)
            return found @ beside.T

    def _variance(self, found: Any) -> Array:
        """Of first order."""
        with np.errstate(all="ignore"):
            if isinstance(found, Contributions):
                variance = found.variances(self._pairs)
            else:
                variance = np.sum(found * with_correlated(found, self._pairs), axis=1)
        return np.maximum(variance, 0.0)

    def _orders(self, cells: Sequence[tuple[str, int]], own: Any) -> tuple[Array, Array]:
        """The variances of cells, of first order and of second; this is NaN where it is not known.

        A computed value has none less than what the rounding of derivatives that are 0 comes to, nor than
        what terms of higher order make of it a small step away.
        """
        first, second = self._variance(own), self._more(cells, own)
        computed = [not isinstance(self.values.sheet[name].rule, Given) for name, _ in cells]
        values = np.array([self.values.value[name][row] for name, row in cells])
        many = isinstance(own, Contributions)
        share = own.largest(self._shares) if many else largest(own != 0, self._shares)
        share = np.where(share > 0, share, self._shares.max())  # of second order alone: of any
        noise = ROUNDED * np.minimum(1.0, ROUNDINGS * share)
        with np.errstate(all="ignore"):
            least = np.maximum(np.abs(noise * np.where(computed, values, 0.0)), self._creeping(cells))
            little = first + np.nan_to_num(second) <= np.square(least)
        first = np.where(little, 0.0, first)
        asked = np.flatnonzero(little)
        first[asked[self._hidden([cells[n] for n in asked.tolist()])]] = np.nan
        return first, np.where(little, 0.0 * second, second)

    def _creeping(self, cells: Sequence[tuple[str, int]]) -> Array:
        """How far cells are from their values a step away, if by terms of second order or higher alone."""
        return np.array([self.second.creeps(*cell) if self.second else 0.0 for cell in cells])

    def _hidden(self, cells: Sequence[tuple[str, int]]) -> NDArray[np.bool_]:
        """Which cells change all the same where what first and second order tell is nothing."""
        return np.array([self.second is not None and self.second.hides(*cell) for cell in cells], dtype=bool)

    # --- one cell ---

    def budget(self, name: str, row: int, level: float = LEVEL) -> Budget:
        """Where the uncertainty of a cell comes from.

        `name`: its column. `level`: the coverage probability of its expanded uncertainty.
        """
        column = self.values.sheet[name]
        label = self.values.labels(column)[row]
        value = float(self.values.value[name][row])
        if name not in self._known:
            return Budget(self.values.address(name, row), name, label, value, level=level)
        cell = [(name, row)]
        found = self.contributions(cell)
        (first,), more = self._orders(cell, found)
        second, unlooked = float(np.nan_to_num(more)[0]), ""
        if not np.isfinite(more[0]):
            unlooked = "the sheet is too large for that" if self.second is None else self.second.why(name)
        found = found if first or second else np.zeros_like(found)
        own = found[0, : len(self.sources)]
        u = math.sqrt(first + second) if math.isfinite(first + second) else math.nan
        if math.isnan(u):
            why = "a derivative has no value here"
            if self._hidden(cell)[0]:
                flat = "its first and second derivatives are 0 here"
                why = unlooked or ("terms of higher order make most of it" if np.any(found) else flat)
            own_address = self.values.address(name, row)
            return Budget(own_address, name, label, value, level=level, unlooked=why)
        shares = own / u * (with_correlated(own, self._pairs) / u) if u > 0 else np.zeros(len(own))
        _, dof = of_sum(self.sources, own, self._pairs, math.sqrt(first))
        shape, law = assigned(self.sources, own, u, dof, second, self._pairs)
        factor, because = coverage(shape, law, dof, level)
        order = np.argsort(-np.abs(shares), kind="stable")
        order = order[np.abs(own[order]) > NOTHING * np.abs(own).max(initial=0.0)].tolist()
        told = tuple(self._contribution(n, float(own[n]), float(shares[n])) for n in order)
        known = set(order)
        idle = tuple(self._contribution(n, 0.0, 0.0) for n in self._leading_to(name, row) if n not in known)
        pairs, tied = (
            {
                (self.sources[a].name, self.sources[b].name): r
                for a, b, r in self._pairs
                if ({a, b} <= known) is alone
            }
            for alone in (True, False)
        )
        own_parts = value, u, told, pairs, dof, level, factor, because, second, unlooked, shape, law
        summed, least = tuple(self._summed(column)), self._least(column)
        little = 0.0
        if self.second and not (second or unlooked):
            little = float(np.nan_to_num(self.second.variance(cell, found, little=True))[0])
        return Budget(
            self.values.address(name, row),
            name,
            label,
            *own_parts,
            summed,
            least=least,
            idle=idle,
            tied=tied,
            little=little,
        )

    def _leading_to(self, name: str, row: int) -> list[int]:
        """The sources from which a way leads to a cell, whatever they do to it now; by a hub, from all."""
        by, number = self._along.chain.cells([(name, row)]).by, len(self.sources)
        if (by >= self._along.chain.number).any() or not number:
            return list(range(number))
        reached = np.zeros(self._along.chain.number, dtype=bool)
        reached[by] = True
        return np.flatnonzero(np.logical_or.reduceat(reached[self._by], self._first)).tolist()

    def freedom(self, name: str, row: int) -> float:
        """The effective degrees of freedom of a cell, before they are truncated."""
        own = self.contributions([(name, row)])[0, : len(self.sources)]
        return of_sum(self.sources, own, self._pairs, whole=False)[1]

    def unresolved(self, name: str, row: int) -> float:
        """What the digits of paired readings leave of a cell, in SI; 0 unless they scatter by less than half.

        What is computed of readings in one row may not scatter at all, though each of them does. Where it is
        little beside all else it is 0, too.
        """
        paired = self.inputs.uncertainty.paired
        printed = {of: self.inputs.printed(of) for of in paired if of in self._numbers}
        if not printed or name not in self._known:
            return 0.0
        (slopes,), (own,) = self._along.at([(name, row)]), self.contributions([(name, row)])
        left = 0.0
        for of, readings in printed.items():
            halves = [0.0 if each is None else float(each.half_unit) for each in readings]
            left += float(np.sum(np.square(slopes[self._numbers[of]] * halves))) / 3  # rectangular
        theirs = [any(column in paired for column, *_ in source.moves) for source in self.sources]
        scatter, every = self._variance(np.array([np.where(theirs, own, 0.0), own])).tolist()
        return math.sqrt(left) if max(4 * scatter, COUNTS * every) < left < math.inf else 0.0

    def scattered(self, name: str, level: float) -> Scattered | None:
        """How uncertain a number is by the scatter of the rows that it was fitted to, if it was fitted."""
        workbook, values = self.inputs.workbook, self.values
        fits: tuple[SquareSum | Curve, ...] = (*workbook.squares, *workbook.curves)
        for fitted in fits:
            if (own := fitted.by_scatter.get(name)) is None or values.sheet[own].axis is not None:
                continue
            dof, u = fitted.freedom(values.rows_summed(fitted.name, fitted.axis)), values.scalar(own)
            return Scattered(u, dof, coverage(Shape.STUDENT, None, dof, level)[0]) if u > 0 else None
        return None

    def _summed(self, column: Column) -> Iterator[Together]:
        """The columns over pairs of rows that a column sums, of the rows that it sums."""
        sheet, status = self.values.sheet, self.values.status
        layouts, beside = self.values.layouts, {other.name for other in column.alongside}
        kept = rows_kept(precedents(sheet, layouts, column), layouts, status)
        summed = dict.fromkeys(each.name for each in sheet.named(column) if each.over)
        for own in (sheet[name] for name in summed if name not in beside):
            if own.axis is None:
                continue
            rows = kept.get(own.axis.name, status[own.name] == Status.OK)
            cells = [(own.name, int(row)) for row in np.flatnonzero(rows)]
            few = 1 < len(cells) <= MOST_CELLS
            if not (few and isinstance(own.axis, PairAxis) and self.knows(own.name)):
                continue
            covariance = self.covariance(cells)
            u = np.sqrt(np.diag(covariance))
            if np.isfinite(u).all() and (u > 0).all():
                found = np.linalg.eigvalsh(covariance / np.outer(u, u))[::-1]
                yield Together(own.name, tuple(np.maximum(found, 0.0).tolist()))

    def conformity(self, limits: Limits) -> Conformity:
        """A cell beside its limits."""
        name, label = limits.cell
        row = self.values.row(self.values.sheet[name], label)
        budget = self.budget(name, row, limits.guard.level)
        if (budget.u > 0 or not budget.is_known) and (budget.second or budget.unlooked):
            budget = by_draws(self._drawn(name, row), budget)
        elif budget.u > 0 and budget.factor > 0 and self._bends(budget, row, limits):
            drawn = by_draws(self._drawn(name, row), budget, "it bends between its value and a limit")
            return conformity(budget, limits, drawn if drawn.factor > 0 else budget)
        return conformity(budget, limits, budget)

    def _drawn(self, name: str, row: int) -> Array:
        """Draws of a cell; those of its column are kept until others are asked for, if they have room."""
        if len(self.values.status[name]) * SOME > MOST_DRAWN:
            return sample(self.inputs, self.values, name, [row])[0]
        if self._sample is None or self._sample[0] != name:
            rows = range(len(self.values.status[name]))
            self._sample = name, sample(self.inputs, self.values, name, rows)
        return self._sample[1][row]

    def _bends(self, budget: Budget, row: int, limits: Limits) -> bool:
        """Whether a cell bends so much on its way to a limit that it is beyond it more or less often.

        That way is the one on which errors reach the limit most probably, to first order, at most as far as
        nearly all of them come; and besides, bends to all sides shift the mean.
        """
        if self._program is None or self.second is None:
            return False
        own = self.contributions([(budget.name, row)])[0]
        sides = [(side, end) for side, end in zip((-1, 1), limits.ends, strict=True) if math.isfinite(end)]
        ends = np.array([end - budget.value for _, end in sides])
        way = np.clip(ends, -FARTHEST * budget.u, FARTHEST * budget.u)
        most = np.array([[DIVISORS[s.shape] if s.shape in PARTS else math.inf] for s in self.sources])
        errors = np.outer(with_correlated(own, self._pairs), way) / budget.u**2
        errors = np.clip(errors, -most, most)
        there = beside(self.values, self._program, self.sources, errors)
        value = np.broadcast_to(there.value[budget.name], (len(ends), len(self.values.status[budget.name])))
        off = value[:, row] - budget.value - own @ errors + self.second.shift(budget.name, row)
        for n, (side, _) in enumerate(sides):
            straight = past(budget, side * ends[n], side)
            if math.isnan(off[n]):  # there is no value there
                bends = past(budget, side * way[n], side) > MOVED
            else:
                bends = abs(past(budget, side * (ends[n] - off[n]), side) - straight) > MOVED
            if bends:
                return True
        return False

    def influence(self, cells: Sequence[tuple[str, int]], columns: Sequence[str] = ()) -> Influence:
        """What every source does to some cells; those without a value are left out.

        `cells`: columns and rows. `columns`: others, of all their rows: most sources move one of these. One
        that would make more than :data:`MOST_PASSED` numbers of all of them is left out.
        """
        own = self.contributions(cells)
        at, second, doubts = self._addressed(cells, own)
        known = {cell: own[n, : len(self.sources)].tolist() for cell, n in at.items()}
        rows: dict[str, Sequence[tuple[int, float]]] = {}
        for name in columns:
            more: dict[str, Sequence[tuple[int, float]]] = {}
            for some, own in self._blocks(name):
                if isinstance(own, Contributions):  # far more than are passed on
                    break
                at, bent, doubted = self._addressed(some, own)
                more |= {cell: _moved(own, n) for cell, n in at.items()}
                second, doubts = second | bent, doubts | doubted
                if sum(1 + len(moved) for moved in (*rows.values(), *more.values())) > MOST_PASSED:
                    break
            else:
                rows |= more
        return Influence(self.sources, known, rows, second, self._pairs, doubts)

    def _addressed(
        self, cells: Sequence[tuple[str, int]], own: Any
    ) -> tuple[dict[str, int], dict[str, float], dict[str, str]]:
        """Those of some cells that have a value, by their addresses, what second order adds, and doubts."""
        more = self._more(cells, own)
        second = np.nan_to_num(more)
        at = [address(name, self.values.labels(self.values.sheet[name])[row]) for name, row in cells]
        with np.errstate(invalid="ignore"):  # what is beyond all doubles times 0
            finite = np.isfinite(own @ np.zeros(own.shape[1])) & np.isfinite(self._orders(cells, own)[0])
        known = [n for n, (name, row) in enumerate(cells) if finite[n] and not self.values.status[name][row]]
        added = {at[n]: math.sqrt(second[n]) for n in known if second[n] > 0}
        moving = abs(own) @ np.ones(own.shape[1])
        asked = [n for n in known if more[n] != 0 and (second[n] or moving[n])]
        doubts = {at[n]: f"U may not hold: {COUNT if second[n] else UNLOOKED}" for n in asked}
        return {at[n]: n for n in known}, added, doubts

    def _least(self, column: Column) -> float:
        """What its cells cannot fall below, in SI, as far as its rule or the workbook tells."""
        rule, workbook = column.rule, self.inputs.workbook
        if isinstance(rule, Given) and rule.bounds.low is not None:
            return float(rule.bounds.low)
        sums = {each.name for each in workbook.squares} | {each.name for each in workbook.curves}
        return 0.0 if column.nonnegative or column.name in sums else -math.inf

    def _contribution(self, n: int, u: float, share: float) -> Contribution:
        source = self.sources[n]
        name, row, _ = source.moves[0]
        estimate = float(self.values.value[name][row]) if len(source.moves) == 1 else None
        return Contribution(source, estimate, self.values.sheet[name].unit, u, share)

    def misfit(self, curve: Curve) -> Misfit | None:
        """What the residuals of a curve come to beside the uncertainties that are propagated to them.

        None where nothing is left over, where a row has no uncertainty, and where there are too many rows.
        """
        # Of groups of rows each has a fit of its own.
        rows, fitted = self._valued(curve.residual), len(curve.fitted) * len(self._valued(curve.name))
        if not fitted < len(rows) <= MOST_ROWS or not self.knows(curve.residual):
            return None
        residuals = self.values.value[curve.residual][rows]
        own = self.covariance([(curve.residual, row) for row in rows])
        moved = self.contributions([(curve.observed, row) for row in rows])
        return self._misfit(residuals, own, moved, fitted)

    def misfit_of_squares(self, squares: SquareSum) -> Misfit | None:
        """The same of a sum of squares: with what the errors of its rows have in common."""
        rows = self._valued(squares.residual)
        if not squares.fitted < len(rows) <= MOST_ROWS or not self.knows(squares.residual):
            return None
        cells = [(squares.residual, row) for row in rows]
        residuals, weights = (self.values.value[name][rows] for name in (squares.residual, squares.weight))
        moved = self.contributions(cells)
        found = self._misfit(residuals, self.covariance(cells), moved, squares.fitted, weights**-0.5)
        # Beside a shared error that is a million times as large the others are lost in rounding.
        return found if found and found.dof == squares.freedom(len(rows)) else None

    def misfit_of_mean(self, name: str) -> Misfit | None:
        """The same of a column about its mean: stated is what makes its rows differ, but for a little."""
        rows = self._valued(name)
        if not 1 < len(rows) <= MOST_ROWS or not self.knows(name):
            return None
        cells, about = [(name, row) for row in rows], np.eye(len(rows)) - 1 / len(rows)
        residuals, moved = about @ self.values.value[name][rows], self.contributions(cells)
        found = self._misfit(residuals, about @ self.covariance(cells) @ about, moved, 1)
        if found is None:
            return None
        differing = np.any(moved != 0, axis=0) & np.any(moved == 0, axis=0)
        said = np.array([source.said for source in self.sources], dtype=bool)
        every, unsaid = (np.sum(np.square(moved[:, own]), axis=1) for own in (differing, differing & ~said))
        return replace(found, is_stated=bool(np.all(unsaid <= COUNTS * every)))

    def _valued(self, name: str) -> list[int]:
        """The rows that have a value."""
        return np.flatnonzero(self.values.status[name] == Status.OK).tolist()

    def _misfit(
        self, residuals: Array, covariance: Array, moved: Array, fitted: int, size: Array | None = None
    ) -> Misfit | None:
        """`moved`: what every error does to what was observed, of shape (rows, errors)."""
        u = np.sqrt(self._variance(moved))
        size = u if size is None else size
        with np.errstate(all="ignore"):
            known = np.all(size > 0) and np.isfinite(np.outer(size, size)).all()
        if not known or not np.isfinite(covariance).all():
            return None
        chi2, dof = least_squares_of_errors(residuals, covariance, size, fitted)
        each = zip(moved, u.tolist(), strict=True)
        known_by = min(of_sum(self.sources, own, self._pairs, u)[1] for own, u in each)
        moving = np.any(moved != 0, axis=0)
        stated = any(source.said for source, moves in zip(self.sources, moving, strict=True) if moves)
        return Misfit(chi2, dof, known_by, stated) if dof else None


def _known(values: Values) -> set[str]:
    """The columns of which something is told: of a large sheet, those that rest on no generated rows."""
    sheet = values.sheet
    if how_large(sheet, values.layouts) <= LARGEST:
        return set(sheet.by_name)
    generated = {column.name for column in sheet.columns if isinstance(column.axis, RepeatAxis)}
    return {
        column.name
        for column in sheet.columns
        if generated.isdisjoint(each.name for each in (column, *sheet.ancestors(column)))
    }


def _moved(own: Any, n: int) -> Sequence[tuple[int, float]]:
    """The sources that move a cell, by their numbers, and by how much."""
    if isinstance(own, np.ndarray):
        which = np.flatnonzero(own[n])
        return list(zip(which.tolist(), own[n, which].tolist(), strict=True))
    part = slice(*own.indptr[n : n + 2].tolist())
    return sorted(zip(own.indices[part].tolist(), own.data[part].tolist(), strict=True))


def _misfits(spread: Spread, workbook: Workbook) -> Iterator[tuple[str, Misfit | None]]:
    yield from ((curve.name, spread.misfit(curve)) for curve in workbook.curves)
    yield from ((name, spread.misfit_of_mean(of)) for name, of in workbook.means)
    yield from ((each.name, spread.misfit_of_squares(each)) for each in workbook.squares if each.residual)


def uncertainties(inputs: Inputs, values: Values, headline: Sequence[str]) -> Uncertainties:
    """The standard uncertainty of every cell that is listed, and the budgets of some.

    Parameters
    ----------
    inputs : Inputs
    values : Values
        All columns, without a batch.
    headline : sequence of str
        The columns whose cells get a budget each; none: those of which nothing else is computed.
    """
    spread, sheet = Spread(inputs, values), values.sheet
    used = {precedent.name for column in sheet.columns for precedent in sheet.precedents(column)}
    computed = (c for c in sheet.columns if not isinstance(c.rule, Given))
    last = [c.name for c in computed if c.name not in used and not isinstance(c.axis, CountedAxis)]
    every = ((name, row) for name in headline or last for row in range(len(values.status[name])))
    cells = list(islice(every, MOST_BUDGETS))
    listed = [
        c.name for c in sheet.columns if not isinstance(c.axis, RepeatAxis) or isinstance(c.rule, Given)
    ]
    variances = {name: spread.variances(name) for name in listed}
    u = {name: np.sqrt(first + second) for name, (first, second) in variances.items()}
    return Uncertainties(
        u={name: np.where(np.isfinite(found), found, np.nan) for name, found in u.items()},
        budgets=tuple(spread.budget(*cell) for cell in cells),
        conformities=tuple(map(spread.conformity, inputs.limits)),
        influence=_passed_on(spread, cells),
        second={name: second for name, (_, second) in variances.items()},
        misfits={name: found for name, found in _misfits(spread, inputs.workbook) if found},
        rough=spread.second.rough if spread.second else {},
        unresolved={cell: left for cell in cells if (left := spread.unresolved(*cell))},
    )


def _passed_on(spread: Spread, cells: Sequence[tuple[str, int]]) -> Influence | None:
    """What other reports are told: of some cells, all scalars and, in a workbook of one's own, all rows.

    These are columns over the rows of the data: nobody but its author knows which of them is a result.
    """
    columns = spread.values.sheet.columns
    scalars = ((c.name, 0) for c in columns if c.axis is None)
    rows = [c.name for c in columns if spread.inputs.own_workbook and c.axis and c.axis.is_given]
    asked = (cell for cell in dict.fromkeys((*cells, *scalars)) if cell[0] not in rows)
    known = [cell for cell in asked if spread.knows(cell[0])]
    return spread.influence(known, list(filter(spread.knows, rows)))
