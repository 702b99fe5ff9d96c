"""What is asked of the referee: unknown inputs within their printed digits, and what they must yield.

Everything that is printed stands for an interval. The unknowns are the given cells that the published ones
rest on, each anywhere within its interval; what the publication does not print at all is free. An answer is
a point of that box whose every published cell lies within the interval of its print.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..cells.layout import height, how_large, precedents
from ..cells.values import Status, Values
from ..engines.numpy import Program, evaluate
from ..inputs.published import PublishedValue
from ..judge.chain import Chain, SheetDerivatives
from ..judge.sensitivity import NumericSweep
from ..quantity import Printed
from ..result.verdict import Witness
from ..sheet import Given, Sheet
from .campaign import Array, Campaign, Unknown
from .ways import Way

ENOUGH = 1e-6
"""What is less makes no difference, in half units of the last digit."""


@dataclass(frozen=True)
class Box:
    """Where the unknowns may lie."""

    low: Array
    high: Array
    """`low` and `high`: of shape (unknowns,); in SI, ends included."""
    start: Array
    """Of shape (unknowns,); where a search begins."""

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


class Here(NamedTuple):
    """A point (unknowns,), the published cells there in SI, NaN for no value, and all that is computed."""

    point: Array
    cells: Array
    values: Values


@dataclass(frozen=True)
class Problem:
    """Published values that shall come out together."""

    campaign: Campaign
    program: Program
    """Of the columns that they rest on, what is free being given."""
    unknowns: tuple[Unknown, ...]
    published: tuple[PublishedValue, ...]
    ways: tuple[Way | None, ...]
    """How each of them is computed; None for what follows the sheet."""
    ignored: frozenset[int] = frozenset()
    """Places of published values that need not come out."""

    @classmethod
    def of(
        cls,
        campaign: Campaign,
        published: Sequence[PublishedValue],
        tied: Sequence[str] = (),
        asked: Sequence[str] = (),
    ) -> Problem:
        """Ask for published values together.

        `tied`: free columns that shall follow from the others all the same. `asked`: conventions of the
        workbook that are asked for too.
        """
        cut = tuple(name for name in campaign.free if name not in tied)
        program = campaign.program({value.cell for value in published}, cut)
        unknowns = tuple(campaign.unknowns(program.sheet, cut, asked))
        return cls(campaign, program, unknowns, tuple(published), (None,) * len(published))

    @property
    def sheet(self) -> Sheet:
        """The columns that are computed."""
        return self.program.sheet

    @property
    def asked_of(self) -> tuple[Any, ...]:
        """What is the same for all problems of a campaign that compute the same of the same unknowns."""
        return id(self.sheet), *self.rows  # the campaign keeps its sheets

    @property
    def made(self) -> SheetDerivatives:
        """The derivatives of its sheet."""
        known, key = self.campaign.made.derivatives, id(self.sheet)  # the campaign keeps its sheets
        if key not in known:
            known[key] = SheetDerivatives.of(self.sheet)
        return known[key]

    @cached_property
    def guessing(self) -> Problem:
        """The same for a search: its roots are not counted, so that nothing may be told that it evaluates."""
        program = self.program.guessing
        if program is self.program and all(way is None or way.guessing is way for way in self.ways):
            return self
        return replace(self, program=program, ways=tuple(way and way.guessing for way in self.ways))

    @cached_property
    def size(self) -> int:
        """How many cells its sheet has."""
        return how_large(self.sheet, self.campaign.values.layouts)

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
        return np.array([value.printed.spread[0] for value in self.published], dtype=np.float64)

    @cached_property
    def half(self) -> Array:
        """Half of its width, in SI."""
        return np.array([value.printed.spread[1] for value in self.published])

    @cached_property
    def places(self) -> list[tuple[str, int]]:
        """Column and row of each published value."""
        values = self.campaign.values
        return [(p.cell, values.row(self.campaign.sheet[p.cell], p.index)) for p in self.published]

    @cached_property
    def _asked(self) -> dict[Way | None, dict[str, tuple[list[int], list[int]]]]:
        """For each way and column, the places of the published values among all, and their rows."""
        found: dict[Way | None, dict[str, tuple[list[int], list[int]]]] = {}
        for n, (way, (name, row)) in enumerate(zip(self.ways, self.places, strict=True)):
            which, rows = found.setdefault(way, {}).setdefault(name, ([], []))
            which.append(n)
            rows.append(row)
        return found

    @cached_property
    def rows(self) -> dict[str, list[int]]:
        """For each given column with unknowns, their places among all, in the order of its rows."""
        found: dict[str, list[int]] = {}
        for n, unknown in enumerate(self.unknowns):
            found.setdefault(unknown.column, []).append(n)
        return found

    @cached_property
    def sources(self) -> dict[str, NDArray[np.intp]]:
        """The same for derivatives, row by row: -1 for one that is missing."""
        found = {}
        for name, places in self.rows.items():
            found[name] = np.full(len(self.campaign.values.labels(self.sheet[name])), -1)
            found[name][[self.unknowns[n].row for n in places]] = places
        return found

    def data(self, points: Any) -> dict[str, Any]:
        """The given columns of the sheet, with the unknowns taken from the last dimension of points."""
        found = {
            c.name: self.campaign.data[c.name] for c in self.sheet.columns if c.name in self.campaign.data
        }
        return found | {name: self.column(name, points) for name in self.rows}

    def column(self, name: str, points: Any) -> Array:
        """A given column with its unknowns (..., rows) at points (..., unknowns); NaN for a missing datum."""
        places = self.sources[name]
        return np.where(places < 0, np.nan, points[..., places])

    @cached_property
    def fitted(self) -> list[int]:
        """The places of those unknowns that are not printed, and that the sheet computes."""
        sheet = self.campaign.sheet
        return [
            n for n, unknown in enumerate(self.unknowns)
            if unknown.printed is None and not isinstance(sheet[unknown.column].rule, Given)
        ]  # fmt: skip

    def fitted_to(self, name: str) -> list[int]:
        """Those of them that follow from a given column."""
        sheet = self.campaign.sheet
        return [n for n in self.fitted if sheet[name] in sheet.ancestors(sheet[self.unknowns[n].column])]

    def restarted(self, points: Array) -> Array:
        """Points (points, unknowns) with what is free as it would follow from the rest.

        Where the search for another input begins, a fit that is not printed is better taken from that
        input than from the one that is printed.
        """
        free = self.fitted
        if not free:
            return points
        names = {self.unknowns[n].column for n in free}
        program = self.campaign.program(names)
        given = [column.name for column in program.sheet.columns if isinstance(column.rule, Given)]
        data = {name: self.campaign.data[name] for name in given}
        data |= {name: self.column(name, points) for name in self.rows if name in data}
        values = evaluate(program.sheet, self.campaign.labels, data, program.guessing)
        found = points.copy()
        for n in free:
            unknown = self.unknowns[n]
            own = values.value[unknown.column][..., unknown.row]
            found[..., n] = np.where(np.isfinite(own), own, points[..., n])
        return found

    def evaluate(self, points: Array) -> Array:
        """The published cells (points, published) in SI at points (points, unknowns); NaN for no value."""
        return self._cells(points, self._values(points))

    def _values(self, points: Array) -> Values:
        """All that the sheet computes at points."""
        return evaluate(self.sheet, self.campaign.labels, self.data(points), self.program)

    @cached_property
    def _rounded(self) -> dict[str, Array]:
        """What NumPy's cells lack of the campaign's values at what is printed: what rounding took from them.

        It counts where more digits are published than doubles keep through the calculation.
        """
        own = self.campaign.values

        def lacking() -> dict[str, Array]:
            start = np.array([own.value[u.column][..., u.row].item() for u in self.unknowns])
            here = self._values(start[None]).value
            # What rests on nothing that may move has no axis of points.
            return {
                name: np.nan_to_num(each - here[name].reshape(each.shape))
                for name, each in own.value.items()
                if name in here
            }

        return self.campaign.once(("rounded", *self._printed), lacking)

    def _cells(self, points: Array, plain: Values) -> Array:
        found = np.empty((len(points), len(self.published)))
        for way in dict.fromkeys(self.ways):
            values = plain if way is None else way.evaluate(self.campaign, self.data(points), plain)
            for name, (which, rows) in self._asked[way].items():
                alive, cells = values.status[name][..., rows] == Status.OK, values.value[name][..., rows]
                if way is None:
                    lacks = self._rounded[name][rows]
                    cells = cells + np.where(np.abs(lacks) > ENOUGH * self.half[which], lacks, 0.0)
                found[:, which] = np.where(alive, cells, np.nan)
        return found

    def mismatch(self, cells: Array) -> Array:
        """How far cells are from what was published, in half units of the last digit."""
        with np.errstate(over="ignore"):
            found: Array = (cells - self.centre) / self.half
        if self.ignored:
            found[..., list(self.ignored)] = 0.0
        return found

    def at(self, point: Array) -> Here:
        """The published cells at a point. Most searches begin at what is printed: that is computed once."""
        points, printed = point[None], np.array_equal(point, self.box.start)
        make = partial(self._values, points)
        values = self.campaign.once(self._printed, make) if printed else make()
        return Here(point, self._cells(points, values)[0], values)

    @property
    def _printed(self) -> tuple[Any, ...]:
        return "printed", id(self.program), *self.asked_of

    def _differences(self, point: Array, box: Box) -> Array:
        size = np.abs(point)
        steps = np.maximum(1e-4 * np.minimum(box.width, 0.1 * size), 1e-8 * size)
        steps = np.where(size > 0, steps, 1e-4 * box.width)
        moving = np.flatnonzero(steps > 0)
        ahead, behind = (point + way * np.diag(steps)[moving] for way in (1, -1))
        cells = self.evaluate(np.concatenate([ahead, behind])).reshape(2, moving.size, -1)
        found = np.zeros((len(self.published), len(point)))
        found[:, moving] = ((cells[0] - cells[1]) / (2 * steps[moving])[:, None]).T
        return found

    def slopes(self, here: Here, box: Box) -> Array:
        """The derivatives (published, unknowns) of cells that have to come out, by what may move in a box.

        What follows the sheet has those of its rules. Of what is computed in another way none are made: it is
        asked for too few times, and has central differences within the box's scale.
        """
        found = np.zeros((len(self.published), len(self.unknowns)))
        following = [n for n, way in enumerate(self.ways) if way is None and n not in self.ignored]
        found[following] = self._along(here).at([self.places[n] for n in following])[0]
        asked = [n for n, way in enumerate(self.ways) if way is not None and n not in self.ignored]
        if asked:
            found[asked] = self._differences(here.point, box)[asked]
        found[:, box.width <= 0] = 0.0
        return found

    def _along(self, here: Here) -> NumericSweep:
        """What all derivatives at a point are made of; at what is printed they are made once."""

        def make() -> NumericSweep:
            return NumericSweep(self._chain, here.values).go()

        printed = self.campaign.shared.get(self._printed)
        return self.campaign.once(("along", *self._printed), make) if here.values is printed else make()

    @property
    def _chain(self) -> Chain:
        """What the cells of the sheet rest on."""
        layouts = self.campaign.values.layouts
        return self.campaign.once(("chain", *self.asked_of), lambda: Chain(self.made, layouts, self.sources))

    def witness(self, point: Array) -> tuple[Witness, ...]:
        """A point in words."""
        return tuple(u.witness(float(x)) for u, x in zip(self.unknowns, point, strict=True))

    def only(self, which: Sequence[int]) -> Problem:
        """Fewer of the published values."""
        published = tuple(self.published[n] for n in which)
        return replace(self, published=published, ways=tuple(self.ways[n] for n in which))

    @property
    def conventions(self) -> tuple[str, ...]:
        """The conventions that are asked for too."""
        return tuple(name for name in self.rows if self.campaign.sheet[name].exact)

    def renamed(self, which: Collection[int], cell: str) -> Problem:
        """The same with some published values taken for those of another column."""
        published = [
            replace(value, cell=cell) if n in which else value for n, value in enumerate(self.published)
        ]
        ways = tuple(None if n in which else way for n, way in enumerate(self.ways))
        asked = Problem.of(self.campaign, published, asked=self.conventions)
        return replace(asked, ways=ways, ignored=self.ignored)

    def ignoring(self, which: Collection[int]) -> Problem:
        """The same, but some published values need not come out."""
        return replace(self, ignored=self.ignored | frozenset(which))

    def reprinted(self, changes: Mapping[int, Printed]) -> Problem:
        """The same with other prints of some published values."""
        published = [
            replace(value, printed=changes.get(n, value.printed)) for n, value in enumerate(self.published)
        ]
        return replace(self, published=tuple(published))

    def computed(self, way: Way, members: Collection[int]) -> Problem:
        """The same with some published values computed in another way."""
        ways = [way if n in members else own for n, own in enumerate(self.ways)]
        return replace(self, ways=tuple(ways))

    @cached_property
    def touched(self) -> NDArray[np.bool_]:
        """Whether a published cell rests on an unknown (published, unknowns), by the sheet's own graph."""
        rests = self.campaign.once(("rests", *self.asked_of), self._rests)
        found = [rests[name][:, row] for name, row in self.places]
        return np.array(found).reshape(-1, len(self.unknowns))

    def _rests(self) -> dict[str, NDArray[np.bool_]]:
        """Whether a cell of each column rests on an unknown (unknowns, rows)."""
        number, layouts = len(self.unknowns), self.campaign.values.layouts
        rests: dict[str, NDArray[np.bool_]] = {}
        for column in self.sheet.columns:
            size = height(column, layouts)
            rests[column.name] = np.zeros((number, size), dtype=bool)
            for n in self.rows.get(column.name, ()):
                rests[column.name][n, self.unknowns[n].row] = True
        again = True
        while again:  # once, but for columns that rest on one another
            again = False
            for column in self.sheet.order:
                found = rests[column.name]
                for precedent in precedents(self.sheet, layouts, column):
                    theirs = precedent.take(rests[precedent.column.name]).astype(bool)
                    found = found | (theirs if precedent.over is None else theirs.any(axis=-1, keepdims=True))
                again |= bool(self.sheet.loops) and not np.array_equal(found, rests[column.name])
                rests[column.name] = found
        return rests
