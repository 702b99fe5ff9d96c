"""The distribution of a cell by Monte Carlo (JCGM 101), with the engine's batch axes.

All errors of what was given are drawn from their distributions and go through the sheet, batch after batch.
Quantiles come first: they exist for any distribution. A mean and a standard deviation are told only where the
tails let them exist, and an interval only if nearly all draws have a value. One whose sums run over other
rows than those of the estimate has none: it is a value of another estimator.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..cells.values import Status, Values, other_rows
from ..column import Column
from ..distribution import DIVISORS, PARTS, Shape
from ..engines.elementary import log
from ..engines.intervals import Intervals
from ..engines.numpy import Laid, Program, evaluate
from ..engines.numpy_beside import BESIDE, Beside
from ..inputs.inputs import Inputs
from ..judge.enclosure import Enclosure
from ..laws import Samples
from ..quantity import SMALLEST
from ..result.uncertain import Budget, Distributed, ErrorSource
from ..sheet import Sheet
from .second_order import root_of
from .sources import correlated, given, sources

Array = NDArray[np.float64]

MOST = 1_000_000
"""Draws, at most, where nobody asks for another number."""
SOME = 20_000
"""Draws, where nobody asks for any and the law of propagation does not serve."""
BEYOND = 10
"""Draws beyond either end of an interval, of fewer of which it is known to no digit."""
FEWEST = 10
"""Batches before it is asked whether they are enough."""
FAR = 5.0
"""In standard uncertainties: what is drawn farther out, where an error has no end, is asked for by itself."""
WITHOUT = 0.025
"""Of so many draws without a value no interval of 95 % is told: it might as well lie there."""
NO_MEAN, NO_DEVIATION = 1.1, 2.2
"""Up to which tail index, with what its estimate may be off, there is no mean and no standard deviation."""


def least(level: float) -> int:
    """How many draws are the fewest of which an interval is told.

    >>> least(0.95), least(0.9973)
    (400, 7407)
    """
    return round(2 * BEYOND / (1 - level))


def draw(
    inputs: Inputs,
    values: Values,
    budget: Budget,
    most: int = MOST,
    seed: int = 1,
    step: Callable[[str], None] = lambda _: None,
    tolerance: float | None = None,
) -> Distributed:
    """Draw until the interval is known to a tolerance, or `most` times.

    Parameters
    ----------
    values : Values
        All columns, without a batch.
    budget : Budget
        Of the cell, by the law of propagation, which is compared.
    most, seed : int
        The same seed draws the same.
    step : callable
        Told what is begun.
    tolerance : float, optional
        In SI; half a unit of the second digit of the standard uncertainty, if nobody asks for another.

    Returns
    -------
    Distributed

    Notes
    -----
    It is enough when twice the standard deviations of mean, standard uncertainty and both ends, averaged over
    the batches, are below the tolerance (JCGM 101, 7.9.4).
    """
    drawn = _Draws(inputs, values, budget.name, seed)
    row = values.row(values.sheet[budget.name], budget.label)
    size = min(most, max(10_000, math.ceil(100 / (1 - budget.level))))
    found: list[Array] = []
    told: list[tuple[float, ...]] = []
    lost, tolerance = 0, _tolerance(budget.u) if tolerance is None else tolerance

    for number, batch in enumerate(drawn.batches(size, most), start=1):
        step(f"drawing {number * size} times")
        own, there = drawn.of(batch, row)
        found.append(own[there])
        lost += own.size - found[-1].size
        if found[-1].size:
            told.append(_told(found[-1], budget.level)[0])
        if number >= FEWEST and len(told) == number and _is_enough(told, tolerance):
            break
    return _distributed(np.concatenate(found), lost, budget, tolerance, told)


def sample(inputs: Inputs, values: Values, name: str, rows: Sequence[int]) -> list[Array]:
    """Draws of some rows of a column, of each those that have a value.

    `values`: all columns, without a batch.
    """
    drawn = _Draws(inputs, values, name, seed=1)
    value, there = drawn.of(next(drawn.batches(SOME, SOME)), list(rows))
    return [own[known] for own, known in zip(value.T, there.T, strict=True)]


def by_draws(draws: Array, budget: Budget, why: str = "") -> Budget:
    """A budget with the distribution of its cell as draws tell it, in place of that of its errors.

    Parameters
    ----------
    draws : float array (draws,)
        As :func:`sample` gives them of the cell.
    budget : Budget
        With a standard uncertainty that is not 0, or of one that is not known: then that of the draws is.
    why : str
        It is asked for, if not for terms of second order.

    Returns
    -------
    Budget
        Without a coverage factor where too many draws have no value.
    """
    errors = draws - budget.value  # of a cell without a value there are draws, and no errors
    errors = errors[np.isfinite(errors)]
    if errors.size < (1 - WITHOUT) * SOME:
        return replace(budget, factor=math.nan, because="too many draws have no value")
    if not budget.is_known:
        budget = replace(budget, u=float(np.std(errors)))
    if not budget.u:
        return replace(budget, factor=0.0)
    errors = errors / budget.u
    unless = "terms of second order count" if budget.second else "terms of second order were not looked at"
    told, law = f"{SOME} draws: {why or unless}", Samples(errors)
    factor = law.half(budget.level)
    return replace(budget, factor=factor, because=told, shape=Shape.SAMPLES, law=law, draws=SOME)


class _Draws:
    """Draws of what a column rests on."""

    def __init__(self, inputs: Inputs, values: Values, name: str, seed: int) -> None:
        column = values.sheet[name]
        self.sheet, self.estimate = _begun(inputs, values, (*values.sheet.ancestors(column), column)), values
        self.labels = values.given_labels
        self.program, self.name = Program.of(self.sheet), name
        self.generator = np.random.Generator(np.random.PCG64(seed))
        self.base = {
            own.name: values.value[own.name] for own in self.sheet.columns if own.name in self.sheet.bounds
        }
        for own in given(values):
            if own.name in self.base:
                shifts = [float(each.shift) if each else 0.0 for each in inputs.printed(own.name)]
                self.base[own.name] = self.base[own.name] + shifts
        self.sources = [
            source for source in sources(inputs, values) if any(move[0] in self.base for move in source.moves)
        ]
        pairs = correlated(self.sources, inputs, values)
        self.root = root_of(len(self.sources), pairs)
        self.mixed = {n for a, b, _ in pairs for n in (a, b) if not self.sources[n].table}
        estimated = Counter(source.sample for source in self.sources if source.shape is Shape.STUDENT)
        self.samples = {sample for sample, number in estimated.items() if sample and number > 1}
        self.beside = self._beside(values)

    def _beside(self, values: Values) -> Beside | None:
        """What computes nearly all draws, if every cell has a value wherever they are."""
        if not Beside.serves(self.program):
            return None
        reach = {name: np.zeros(own.shape) for name, own in self.base.items()}
        for source in self.sources:
            for name, row, u in source.moves:
                if name in reach:
                    ends = source.shape in PARTS
                    reach[name][row] += abs(u) * (DIVISORS[source.shape] * (1 + 2.0**-40) if ends else FAR)
        box = {name: Intervals(own - reach[name], own + reach[name]) for name, own in self.base.items()}
        laid = Laid(self.sheet, dict(values.layouts))
        cells = Enclosure(self.sheet, self.program, laid.layouts, box)
        for column in self.sheet.columns:
            held = cells.value[column.name].low >= SMALLEST if column.positive else True
            if not np.all(cells.sure[column.name] & held):
                return None
        program = Program.of(self.sheet, functions=BESIDE, alone=self.name)
        return Beside(program, laid, self.base, cells.value)

    def batches(self, size: int, most: int) -> Iterator[dict[str, Array]]:
        """What was given, one batch after another (size, rows)."""
        for first in range(0, most, size):
            yield self._batch(min(size, most - first))

    def _batch(self, size: int) -> dict[str, Array]:
        moved: dict[str, Array] = {}
        for source, errors in zip(self.sources, self._errors(size), strict=True):
            for name, row, u in source.moves:
                if name in self.base:
                    if name not in moved:
                        moved[name] = np.repeat(self.base[name][:, None], size, axis=1).T
                    moved[name][:, row] += u * errors
        return moved

    def _errors(self, size: int) -> Iterator[Array]:
        """Errors in units of their standard uncertainty; correlated ones are normal.

        Those of one sample are together as wrong as their common estimate is: a t distribution of many
        dimensions, so that the mean of readings has the degrees of freedom of the readings (JCGM 101, 6.4.9).
        """
        if self.mixed:
            together = self.generator.standard_normal((size, len(self.sources))) @ self.root.T
        scales: dict[str, Array] = {}
        rows: dict[str | int, Array] = {}
        for n, source in enumerate(self.sources):
            if source.law is not None and n not in self.mixed:
                table = source.table or n
                if table not in rows:  # what stands in one row of a table of draws is drawn together
                    rows[table] = self.generator.random(size)
                yield source.law.quantile(rows[table])
                continue
            if source.sample not in self.samples or source.shape is not Shape.STUDENT:
                yield together[:, n] if n in self.mixed else self._error(source, size)
                continue
            if source.sample not in scales:
                scales[source.sample] = np.sqrt(source.dof / self.generator.chisquare(source.dof, size))
            normal = together[:, n] if n in self.mixed else self.generator.standard_normal(size)
            yield normal * scales[source.sample]

    def _error(self, source: ErrorSource, size: int) -> Array:
        draws, shape = self.generator, source.shape
        if shape is Shape.NORMAL:
            return draws.standard_normal(size)
        if shape is Shape.STUDENT:
            return draws.standard_t(source.dof, size)
        if shape is Shape.TRIANGULAR:
            return DIVISORS[shape] * (draws.random(size) - draws.random(size))
        if shape is Shape.ARCSINE:
            return DIVISORS[shape] * np.sin(2 * np.pi * draws.random(size))
        errors = draws.random(size)
        errors *= 2 * DIVISORS[shape]
        errors -= DIVISORS[shape]
        return errors

    def of(self, batch: dict[str, Array], row: int | list[int]) -> tuple[Array, NDArray[np.bool_]]:
        """One row of the column, or some, and whether they have a value (size,) or (size, rows)."""
        if self.beside is None or not batch:
            return self._asked(batch, row)
        own, known = self.beside.column(self.name, row, batch)
        # An enclosure of a function that is bounded may hide that what it is a function of has no value.
        finite = np.isfinite(own)
        known = known & (finite.all(axis=-1) if isinstance(row, list) else finite)
        there = np.ones(own.shape, dtype=bool)
        if not known.all():
            left = {name: each[~known] for name, each in batch.items()}
            own[~known], there[~known] = self._asked(left, row)
        return own, there

    def _asked(self, batch: dict[str, Array], row: int | list[int]) -> tuple[Array, NDArray[np.bool_]]:
        """The same, asked of every draw whether it has a value by the rows of the estimate."""
        values = evaluate(self.sheet, self.labels, self.base | batch, self.program)
        size = max((len(own) for own in batch.values()), default=1)
        own, there = values.value[self.name][..., row], values.status[self.name][..., row] == Status.OK
        for others in other_rows(values, self.estimate).values():
            there = there & ~(others[..., None] if isinstance(row, list) else others)
        shape = (size, *own.shape[-1:]) if isinstance(row, list) else size
        return np.broadcast_to(own, shape), np.broadcast_to(there, shape)


def _begun(inputs: Inputs, values: Values, columns: Sequence[Column]) -> Sheet:
    """A sheet whose fits begin at the estimate: draws lie about it, their author's start may be far."""
    fitted = {name for curve in inputs.workbook.curves for name in curve.fitted}
    stepped = [each.name for each in columns if each.name in fitted and each.name in values.sheet.loop_of]
    there = {name: value for name in stepped if math.isfinite(value := values.scalar(name))}
    sheet = Sheet(tuple(columns))
    if not there:
        return sheet
    from ..engines.fit_starts import begun_at  # which imports sympy

    return begun_at(sheet, there)


# --- what draws tell ---------------------------------------------------------------------------------------


def _tolerance(u: float) -> float:
    """Half a unit of the second digit of a standard uncertainty."""
    return 0.5 * 10.0 ** (math.floor(math.log10(u)) - 1) if u > 0 and math.isfinite(u) else 0.0


def _told(draws: Array, level: float) -> tuple[tuple[float, float, float, float], Array]:
    """Mean, standard deviation and the ends of the interval with equal tails; and the draws, :func:`_parted`.

    All are NaN if there are no draws.
    """
    parted = _parted(draws, level)
    if not draws.size:
        return (math.nan,) * 4, parted
    u = float(draws.std(ddof=1)) if draws.size > 1 else 0.0
    low, high = (_quantile(parted, (1 + side * level) / 2) for side in (-1, 1))
    return (float(draws.mean()), u, low, high), parted


def _parted(draws: Array, level: float) -> Array:
    """The draws, sorted at both ends as far as is asked for below, and parted in their middle."""
    number = draws.size
    ends, middle = max(number - math.ceil(level * number), math.isqrt(number)) + 2, (number - 1) // 2
    if 2 * ends >= number:
        return np.sort(draws)
    parted = np.partition(draws, (ends, middle, middle + 1, number - ends))
    parted[:ends].sort()
    parted[-ends:].sort()
    return parted


def _quantile(ordered: Array, share: float) -> float:
    """Below which such a share of the draws lies, between two of them in proportion."""
    beyond, below = math.modf(share * (ordered.size - 1))
    low, high = ordered[int(below)], ordered[min(int(below) + 1, ordered.size - 1)]
    return float(low + beyond * (high - low))


def _is_enough(told: Sequence[tuple[float, ...]], tolerance: float) -> bool:
    spread = np.std(np.array(told), axis=0, ddof=1) / math.sqrt(len(told))
    return bool(np.all(2 * spread < tolerance))


def _shortest(ordered: Array, level: float) -> tuple[float, float]:
    """The shortest interval that holds so many of the draws (JCGM 101, 7.7)."""
    inside = min(ordered.size - 1, math.ceil(level * ordered.size))
    widths = ordered[inside:] - ordered[: ordered.size - inside]
    first = int(np.argmin(widths))
    return float(ordered[first]), float(ordered[first + inside])


def _tail(ordered: Array) -> float:
    """The tail index by Hill: the chance to be further out than t falls as t to minus this power."""
    number = math.isqrt(ordered.size)
    if number < 10:
        return math.inf
    ends = np.concatenate([ordered[: number + 1], ordered[-number - 1 :]])
    out = np.sort(np.abs(ends - _quantile(ordered, 0.5)))[-number - 1 :]
    slope = float(np.mean(log(out[1:] / out[0]))) if out[0] > 0 else 0.0
    return 1 / slope if slope > 0 else math.inf


def _distributed(
    draws: Array, lost: int, budget: Budget, tolerance: float, told: Sequence[tuple[float, ...]]
) -> Distributed:
    number, nothing = draws.size + lost, math.nan
    (mean, u, low, high), ordered = _told(draws, budget.level)
    tail = _tail(ordered)
    median = _quantile(ordered, 0.5) if ordered.size else nothing
    stated = ordered.size > 1 and lost <= WITHOUT * number
    ends = (low, high) if stated else (nothing, nothing)
    return Distributed(
        number,
        lost,
        median,
        mean if tail > NO_MEAN else nothing,
        u if tail > NO_DEVIATION else nothing,
        ends,
        _shortest(ordered, budget.level) if stated else ends,
        tail,
        tolerance,
        len(told) >= FEWEST and _is_enough(told, tolerance),
        (
            abs(budget.value - budget.expanded - ends[0]),
            abs(budget.value + budget.expanded - ends[1]),
        ),
    )
