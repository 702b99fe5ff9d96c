"""A report as the referee asks it: its sheet, the digits of its inputs, and what is not printed."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..cells.values import Values
from ..distribution import SCATTER
from ..engines.numpy import Program
from ..inputs.inputs import Inputs
from ..judge.chain import SheetDerivatives
from ..quantity import Bounds, Printed, there
from ..result.verdict import Witness
from ..sheet import Given, Sheet
from ..uncertainty.propagation import Spread

Array = NDArray[np.float64]
T = TypeVar("T")

COVERAGE = 2.0
"""How many standard uncertainties a number may be off (JCGM 100:2008, 6.3.3)."""
FREE = 1e15
"""What is not printed is looked for between its recomputed value over and times so much."""


@dataclass(frozen=True)
class Unknown:
    """A given cell."""

    column: str
    row: int
    index: tuple[int, ...]
    """How the row is called."""
    printed: Printed | None
    """None for what is not printed."""
    start: float
    """Its value in SI as printed, or as recomputed."""
    allowed: Bounds = field(default_factory=Bounds)
    """What it may be, whatever is printed."""
    held: float = inf
    """How far from what is printed it may be at most, in SI, whatever its digits allow."""
    reach: float = 0.0
    """How far from what is printed it may be all the same, in SI."""

    def interval(self, printed: Printed | None = None) -> tuple[float, float]:
        """Where it may lie, in SI, by its digits and by what is stated of it; or if it were printed so."""
        printed = printed or self.printed
        if printed is None:
            ends = (self.start / FREE, self.start * FREE)
            return self.allowed.clip(min(ends), max(ends))
        (low, high), value = map(float, printed.interval), float(printed.value)
        low, high = max(low, value - self.held), min(high, value + self.held)
        return self.allowed.clip(min(low, value - self.reach), max(high, value + self.reach))

    def witness(self, value: float) -> Witness:
        """A value of it, in the unit that it is printed in."""
        return Witness(self.column, self.index, value if self.printed is None else self.printed.of(value))


@dataclass(frozen=True, eq=False)
class Programs:
    """What was made of a sheet. The same columns are asked for again and again, and printing takes long."""

    sheets: dict[tuple[str, ...], Sheet] = field(default_factory=dict)
    programs: dict[tuple[tuple[str, ...], frozenset[str]], Program] = field(default_factory=dict)
    derivatives: dict[int, SheetDerivatives] = field(default_factory=dict)


@dataclass(frozen=True)
class Campaign:
    """A report's sheet and inputs, as the referee asks them."""

    sheet: Sheet
    inputs: Inputs
    values: Values
    """As recomputed from what is printed."""
    data: Mapping[str, Any]
    """By column name; the given columns in SI."""
    free: tuple[str, ...] = ()
    """Columns that the publication does not print: given or computed, they may have any value."""
    made: Programs = field(default_factory=Programs, repr=False)
    """Of the sheet; campaigns with other inputs share them."""
    stated: bool = False
    """Whether an input may be as far from its print as the uncertainties reach that are stated of it."""

    @cached_property
    def spread(self) -> Spread:
        """How the errors of the inputs spread."""
        return Spread(self.inputs, self.values)

    @cached_property
    def reaches(self) -> dict[tuple[str, int], float]:
        """What is stated of given cells, by column and row: so many standard uncertainties, in SI."""
        found: dict[tuple[str, int], list[float]] = {}
        for source in self.spread.sources if self.states else ():
            for name, row, u in source.moves if source.said else ():
                found.setdefault((name, row), []).append(u)
        return {place: COVERAGE * float(np.hypot.reduce(sizes)) for place, sizes in found.items()}

    def _held(self, column: str, row: int, printed: Printed | None) -> float:
        """How far a given cell may be from its print by what is stated of it, in SI; infinite if nothing is.

        How much readings scatter does not say how far one of them is from its print.
        """
        errors = None if printed is None else printed.stated
        if errors is None or any(error.said == SCATTER for error in errors):
            return inf
        return self.reaches.get((column, row), 0.0)

    def suspects(self, name: str) -> bool:
        """Whether the numbers of a given column may be wrong; not a constant of nature that nobody typed."""
        return name in self.inputs.given or name not in self.inputs.workbook.constants

    @property
    def states(self) -> bool:
        """Whether any uncertainty is stated."""
        given = (*self.inputs.measured.values(), self.inputs.parameters.values())
        return bool(self.inputs.uncertainty.shared) or any(
            p.stated for column in given for p in there(column)
        )

    @cached_property
    def labels(self) -> dict[str, tuple[int, ...]]:
        """Row numbers of the axes that come with the data, and of the group of each row."""
        return {name: tuple(numbers) for name, numbers in self.values.given_labels.items()}

    def program(self, wanted: Collection[str], cut: tuple[str, ...] = ()) -> Program:
        """The program of some columns and what they rest on, where some others are given.

        It may compute more columns, of the same given ones: what is printed is not printed again.
        """
        whole = self._with_free(cut)
        needed = frozenset(wanted) | {a.name for name in wanted for a in whole.ancestors(whole[name])}
        key = tuple(name for name in cut if name in needed), needed
        programs, given = self.made.programs, {c.name for c in whole.columns if isinstance(c.rule, Given)}
        if key not in programs:
            more = (
                k for k in programs if k[0] == key[0] and needed < k[1] and given.isdisjoint(k[1] - needed)
            )
            same = next(more, None)
            if same is None:
                programs[key] = Program.of(Sheet(tuple(c for c in whole.columns if c.name in needed)))
            else:
                programs[key] = programs[same]
        return programs[key]

    def _with_free(self, cut: tuple[str, ...]) -> Sheet:
        """The sheet with some columns given that it would compute."""
        if cut not in self.made.sheets:
            self.made.sheets[cut] = Sheet(
                tuple(
                    replace(column, rule=Given("free"), requires=(), alongside=())
                    if column.name in cut
                    else column
                    for column in self.sheet.columns
                )
            )
        return self.made.sheets[cut]

    @cached_property
    def shared(self) -> dict[Any, Any]:
        """What all problems of a program share: its cells over what prints as given, and their graph."""
        return {}

    def once(self, what: tuple[Any, ...], make: Callable[[], T]) -> T:
        """Something that is shared, made when it is first asked for."""
        if what not in self.shared:
            self.shared[what] = make()
        found: T = self.shared[what]
        return found

    def unknowns(self, sheet: Sheet, cut: Sequence[str], asked: Sequence[str] = ()) -> Iterator[Unknown]:
        """The given cells that are not exact; free ones without their print. A missing datum stays missing.

        Parameters
        ----------
        sheet : Sheet
            The columns in question.
        cut : sequence of str
            The free ones.
        asked : sequence of str
            Conventions that are unknowns all the same, each with nothing but its own value.
        """
        for column in sheet.columns:
            if not isinstance(column.rule, Given):
                continue
            known = (*cut, *asked, *(name for name, _ in self.reaches if self.stated))
            if column.exact and (column.name not in known or sheet.bounds[column.name].integer):
                continue
            printed = self.inputs.printed(column.name)
            values = np.broadcast_to(self.values.value[column.name], (len(self.values.labels(column)),))
            for row, (index, value) in enumerate(
                zip(self.values.labels(column), values.tolist(), strict=True)
            ):
                text = None if column.name in cut else printed[row]
                if text is None and column.name not in cut and not np.isfinite(value):
                    continue
                start = value if np.isfinite(value) else 1.0
                start = start if text is None else float(text.value)
                held = self._held(column.name, row, text)
                reach = self.reaches.get((column.name, row), 0.0) if self.stated else 0.0
                yield Unknown(column.name, row, index, text, start, sheet.bounds[column.name], held, reach)
