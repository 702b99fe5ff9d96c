"""What is asked of the referee: unknown inputs within their printed digits, and what they must yield.

Everything that is printed stands for an interval. The unknowns are the given cells that the published ones
rest on, each anywhere within its interval; what the publication does not print at all is free. An answer is
a point of that box whose every published cell lies within the interval of its print.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...engines.numpy import Program, evaluate
from ...inputs import Inputs
from ...published import PublishedValue
from ...quantity import Bounds, Printed
from ...sheet import Given, Sheet
from ...values import Status, Values
from ...verdict import Witness

__all__ = ["Box", "Campaign", "Problem", "Unknown"]

Array = NDArray[np.float64]

FREE = 1e15
"""What is not printed is looked for between its recomputed value over and times so much."""


@dataclass(frozen=True)
class Unknown:
    """A given cell.

    Parameters
    ----------
    column : str
    row : int
    index : tuple of int
        How the row is called.
    printed : Printed or None
        None for what is not printed.
    start : float
        Its value in SI as printed, or as recomputed.
    allowed : Bounds
        What it may be, whatever is printed.
    """

    column: str
    row: int
    index: tuple[int, ...]
    printed: Printed | None
    start: float
    allowed: Bounds = field(default_factory=Bounds)

    def interval(self, mode: str = "") -> tuple[float, float]:
        """Where it may lie, in SI; under another manner of printing than was declared."""
        if self.printed is None:
            ends = (self.start / FREE, self.start * FREE)
            return self.allowed.clip(min(ends), max(ends))
        printed = replace(self.printed, mode=mode) if mode else self.printed
        low, high = printed.interval
        return self.allowed.clip(float(low), float(high))

    def witness(self, value: float) -> Witness:
        """A value of it, in the unit that it is printed in."""
        scale = float(self.printed.scale) if self.printed is not None else 1.0
        return Witness(self.column, self.index, value / scale, self.printed)


@dataclass(frozen=True)
class Box:
    """Where the unknowns may lie.

    Parameters
    ----------
    low, high : float arrays (unknowns,)
        In SI, ends included.
    start : float array (unknowns,)
        Where a search begins.
    """

    low: Array
    high: Array
    start: Array

    @property
    def width(self) -> Array:
        """How far each may move."""
        return self.high - self.low

    def moved(self, which: Sequence[int], low: Sequence[float], high: Sequence[float], start: Any) -> Box:
        """The box with other intervals for some unknowns."""
        found = Box(self.low.copy(), self.high.copy(), self.start.copy())
        for array, values in ((found.low, low), (found.high, high), (found.start, start)):
            array[list(which)] = values
        return found


@dataclass(frozen=True)
class Campaign:
    """A report's sheet and inputs, as the referee asks them.

    Parameters
    ----------
    sheet : Sheet
    inputs : Inputs
    values : Values
        As recomputed from what is printed.
    data : mapping of column name to float or sequence of float
        The given columns in SI.
    free : tuple of str
        Columns that the publication does not print: given or computed, they may have any value.
    """

    sheet: Sheet
    inputs: Inputs
    values: Values
    data: Mapping[str, Any]
    free: tuple[str, ...] = ()

    @cached_property
    def labels(self) -> dict[str, tuple[int, ...]]:
        """Row numbers of the axes that come with the data."""
        return {axis.name: self.inputs.tests for axis in self.sheet.axes if not axis.parents}

    def problem(self, published: Sequence[PublishedValue], tied: Sequence[str] = ()) -> Problem:
        """Ask for published values together.

        Parameters
        ----------
        published : sequence of PublishedValue
        tied : sequence of str
            Free columns that shall follow from the others all the same.
        """
        cut = tuple(name for name in self.free if name not in tied)
        program = self.program({value.cell for value in published}, cut)
        return Problem(self, program, tuple(self._unknowns(program.sheet, cut)), tuple(published))

    def program(self, wanted: Collection[str], cut: tuple[str, ...] = ()) -> Program:
        """The program of some columns and what they rest on, where some others are given."""
        whole = self._with_free(cut)
        needed = frozenset(wanted) | {a.name for name in wanted for a in whole.ancestors(whole[name])}
        if (cut, needed) not in self._programs:
            sheet = Sheet(tuple(column for column in whole.columns if column.name in needed))
            self._programs[cut, needed] = Program.of(sheet)
        return self._programs[cut, needed]

    def _with_free(self, cut: tuple[str, ...]) -> Sheet:
        """The sheet with some columns given that it would compute."""
        if cut not in self._sheets:
            self._sheets[cut] = Sheet(
                tuple(
                    replace(column, rule=Given("free"), requires=()) if column.name in cut else column
                    for column in self.sheet.columns
                )
            )
        return self._sheets[cut]

    @cached_property
    def derivatives(self) -> dict[int, Any]:
        """What the certificates know of the derivatives of each program."""
        return {}

    # The same columns are asked for again and again; to print their program takes longer than to run it.
    @cached_property
    def _sheets(self) -> dict[tuple[str, ...], Sheet]:
        return {}

    @cached_property
    def _programs(self) -> dict[tuple[tuple[str, ...], frozenset[str]], Program]:
        return {}

    def _unknowns(self, sheet: Sheet, cut: Sequence[str]) -> Iterator[Unknown]:
        """The given cells that are not exact; free ones without their print."""
        for column in sheet.columns:
            if not isinstance(column.rule, Given) or column.exact:
                continue
            printed = self.inputs.printed(column.name)
            values = np.broadcast_to(self.values.value[column.name], (len(self.values.labels(column)),))
            for row, (index, value) in enumerate(
                zip(self.values.labels(column), values.tolist(), strict=True)
            ):
                text = None if column.name in cut else printed[row]
                start = value if np.isfinite(value) else 1.0
                start = start if text is None else float(text.value)
                yield Unknown(column.name, row, index, text, start, sheet.bounds[column.name])


@dataclass(frozen=True)
class Problem:
    """Published values that shall come out together.

    Parameters
    ----------
    campaign : Campaign
    program : Program
        Of the columns that they rest on, what is free being given.
    unknowns : tuple of Unknown
    published : tuple of PublishedValue
    """

    campaign: Campaign
    program: Program
    unknowns: tuple[Unknown, ...]
    published: tuple[PublishedValue, ...]

    @property
    def sheet(self) -> Sheet:
        """The columns that are computed."""
        return self.program.sheet

    @cached_property
    def size(self) -> int:
        """How many cells its sheet has."""
        layouts = self.campaign.values.layouts
        return sum(1 if c.axis is None else layouts[c.axis.name].size for c in self.sheet.columns)

    @cached_property
    def box(self) -> Box:
        """Everything within its printed digits."""
        ends = [unknown.interval() for unknown in self.unknowns]
        low, high = (np.array([end[n] for end in ends]) for n in (0, 1))
        start = np.array([unknown.start for unknown in self.unknowns])
        return Box(low, high, start)

    @cached_property
    def centre(self) -> Array:
        """The middle of what prints as published, in SI."""
        ends = [value.printed.interval for value in self.published]
        return np.array([float((low + high) / 2) for low, high in ends], dtype=np.float64)

    @cached_property
    def half(self) -> Array:
        """Half of its width, in SI."""
        return np.array([float(value.printed.half_unit) for value in self.published])

    @cached_property
    def places(self) -> list[tuple[str, int]]:
        """Column and row of each published value."""
        values = self.campaign.values
        return [(p.cell, values.row(self.campaign.sheet[p.cell], p.index)) for p in self.published]

    @cached_property
    def rows(self) -> dict[str, list[int]]:
        """For each given column with unknowns, their places among all, in the order of its rows."""
        found: dict[str, list[int]] = {}
        for n, unknown in enumerate(self.unknowns):
            found.setdefault(unknown.column, []).append(n)
        return found

    def data(self, points: Any) -> dict[str, Any]:
        """The given columns of the sheet, with the unknowns taken from the last dimension of points."""
        found = {
            c.name: self.campaign.data[c.name] for c in self.sheet.columns if c.name in self.campaign.data
        }
        return found | {name: points[..., rows] for name, rows in self.rows.items()}

    def restarted(self, points: Array) -> Array:
        """Points (points, unknowns) with what is free as it would follow from the rest.

        Where the search for another input begins, a fit that is not printed is better taken from that
        input than from the one that is printed.
        """
        sheet = self.campaign.sheet
        free = [
            n for n, unknown in enumerate(self.unknowns)
            if unknown.printed is None and not isinstance(sheet[unknown.column].rule, Given)
        ]  # fmt: skip
        if not free:
            return points
        names = {self.unknowns[n].column for n in free}
        program = self.campaign.program(names)
        given = [column.name for column in program.sheet.columns if isinstance(column.rule, Given)]
        data = {name: self.campaign.data[name] for name in given}
        data |= {name: points[..., rows] for name, rows in self.rows.items() if name in data}
        values = evaluate(program.sheet, self.campaign.labels, data, program)
        found = points.copy()
        for n in free:
            unknown = self.unknowns[n]
            own = values.value[unknown.column][..., unknown.row]
            found[..., n] = np.where(np.isfinite(own), own, points[..., n])
        return found

    def evaluate(self, points: Array) -> Array:
        """The published cells (points, published) in SI at points (points, unknowns); NaN for no value."""
        values = evaluate(self.sheet, self.campaign.labels, self.data(points), self.program)
        columns = [values.value[name][..., row] for name, row in self.places]
        alive = [values.status[name][..., row] == Status.OK for name, row in self.places]
        found = [np.where(ok, each, np.nan) for each, ok in zip(columns, alive, strict=True)]
        empty = np.empty((len(points), 0))  # the others of a single value
        return np.column_stack([empty, *(np.broadcast_to(each, points.shape[:1]) for each in found)])

    def mismatch(self, cells: Array) -> Array:
        """How far cells are from what was published, in half units of the last digit."""
        return (cells - self.centre) / self.half

    def slopes(self, point: Array, box: Box) -> Array:
        """Derivatives (published, unknowns) at a point, by central differences within the box's scale."""
        size = np.abs(point)
        steps = np.maximum(1e-4 * np.minimum(box.width, 0.1 * size), 1e-8 * size)
        steps = np.where(box.width > 0, np.where(size > 0, steps, 1e-4 * box.width), 0.0)
        moving = np.flatnonzero(steps)
        ahead = np.repeat(point[None], 2 * len(moving), axis=0)
        ahead[np.arange(len(moving)), moving] += steps[moving]
        ahead[len(moving) + np.arange(len(moving)), moving] -= steps[moving]
        cells = self.evaluate(ahead) if len(moving) else np.empty((0, len(self.published)))
        found = np.zeros((len(self.published), len(point)))
        found[:, moving] = ((cells[: len(moving)] - cells[len(moving) :]) / (2 * steps[moving])[:, None]).T
        return found

    def witness(self, point: Array) -> tuple[Witness, ...]:
        """A point in words."""
        return tuple(u.witness(float(x)) for u, x in zip(self.unknowns, point, strict=True))

    def only(self, which: Sequence[int]) -> Problem:
        """Fewer of the published values."""
        return self.asking([self.published[n] for n in which])

    def asking(self, published: Sequence[PublishedValue]) -> Problem:
        """The same unknowns, asked for other published values of the same columns."""
        return replace(self, published=tuple(published))
