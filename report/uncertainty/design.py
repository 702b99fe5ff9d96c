"""Campaigns that are planned: how sure a cell will be, which choice is best, which uncertainty is needed.

Planned rows are made forward (:class:`~loopsheet.report.workbook.Design`); then they are computed as measured
ones are, and the law of propagation tells the rest.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from ...derivations.unit_text import parse_unit
from ..cells.marks import Marks
from ..cells.values import Status, Values
from ..engines.numpy import Program, evaluate
from ..inputs.inputs import Inputs
from ..inputs.planned import Said, planned
from ..inputs.stated import read_statement
from ..result.design import BestChoice, Needed
from ..sheet import Sheet
from ..workbook import Design
from .propagation import Spread

Array = NDArray[np.float64]

GRID = 12
"""Intervals of the range at first; then they are halved."""
HALVINGS = 7
"""A choice is then known to a fifteen-hundredth of the range."""
STRIDE = 8
"""From the uncertainty that is there to one with which the cell is not sure enough."""
CLOSE = 1e-12
"""As a part of it: how close a needed uncertainty is told."""
LARGEST = 1e60
"""Of an uncertainty that can be stated."""
ENDLESS = 1e9
"""A cell that is sure enough at so many times the number itself does not hang on it but for rounding."""


class NotPlanned(ValueError):
    """Rows cannot be made forward; the sentence says why."""


@dataclass(frozen=True)
class Planner:
    """Rows by what is chosen, and how sure a cell will be."""

    inputs: Inputs
    """Of what was measured."""
    values: Values
    """Computed from it."""
    design: Design
    compute: Callable[[Inputs], Marks]
    """Takes inputs; returns the cell, all measured columns and what they rest on, with the marks of these."""
    cell: tuple[str, tuple[int, ...]]
    """Its column, and the label of its row."""
    said: Said
    """What is stated of columns and parameters for the planned rows."""
    _asked: list[Spread] = field(default_factory=list, init=False, repr=False)
    """The last one: all are of one sheet, of which not everything is made again."""

    @cached_property
    def _known(self) -> dict[str, Array]:
        """What planned rows are made of: the numbers of the sheet, and those fitted to its rows."""
        fitted = Sheet(self.design.fitted)
        tests = {axis.name: self.inputs.only.tests for axis in fitted.axes}
        also = evaluate(fitted, tests, {name: self.values.value[name] for name in fitted.bounds})
        found = {}
        for name in Sheet(self.design.planned).bounds.keys() - {self.design.chosen}:
            where = also if name in also.value else self.values
            if where.status[name][0] != Status.OK:
                raise NotPlanned(f"there is no curve to plan on: {where.cell(name).reason}")
            found[name] = where.value[name]
        return found

    @cached_property
    def _program(self) -> Program:
        return Program.of(Sheet(self.design.planned))

    def like(self, chosen: Sequence[float]) -> list[int]:
        """For each planned row the measured one that is nearest to it."""
        own = self.values.value[self.design.chosen]
        return [int(np.argmin(np.abs(own - each))) for each in chosen]

    def rows(self, chosen: Sequence[float]) -> dict[str, Array]:
        """The measured columns of planned rows, in SI.

        Raises
        ------
        NotPlanned
            A number would be one that the workbook does not allow.
        """
        name, sheet = self.design.chosen, self._program.sheet
        labels = {axis.name: range(1, len(chosen) + 1) for axis in sheet.axes}
        made = evaluate(sheet, labels, {**self._known, name: np.array(chosen)}, self._program)
        for own in self.inputs.workbook.measured:
            for row, value in enumerate(made.value[own.name].tolist()):
                if made.status[own.name][row] != Status.OK or not own.bounds.allow(value):
                    size = parse_unit(own.unit)
                    at = f"{name} = {chosen[row]:.6g} {self.values.sheet[name].unit}"
                    got = (
                        f"{(value - float(size.zero)) / float(size.scale):.6g}"
                        if math.isfinite(value)
                        else "no number"
                    )
                    allowed = own.bounds.said(own.unit)
                    raise NotPlanned(f"at {at} the curve gives {own.name} = {got}, which must be {allowed}")
        return {own.name: made.value[own.name] for own in self.inputs.workbook.measured}

    def inputs_of(self, chosen: Sequence[float], like: Sequence[int] | None = None) -> Inputs:
        """What a folder with planned rows would say.

        Parameters
        ----------
        chosen : sequence of float
            In SI.
        like : sequence of int, optional
            For each row the measured one whose digits and errors it has; without it, the nearest.

        Raises
        ------
        NotPlanned
            As :meth:`rows`.
        """
        rows = {name: column.tolist() for name, column in self.rows(chosen).items()}
        return planned(self.inputs, rows, self.like(chosen) if like is None else like, self.said)

    def u(self, inputs: Inputs) -> float:
        """The standard uncertainty of the cell, in SI; infinite where it has none."""
        return self._judged(inputs)[1]

    def _judged(self, inputs: Inputs) -> tuple[float, float]:
        """How many cells that it rests on are odd, without a value or outside of a limit; and that."""
        marks = self.compute(inputs)
        values, (name, label) = marks.values, self.cell
        failed = sum(int(np.count_nonzero(status != Status.OK)) for status in values.status.values())
        spread = Spread(inputs, values, next(iter(self._asked), None))
        self._asked[:] = [spread]
        u = float(spread.u(name)[values.row(values.sheet[name], label)])
        odd = failed + sum(marks.count(margin).number for margin in marks.margins)
        return odd, u if math.isfinite(u) else math.inf

    # --- the best choice ---

    @staticmethod
    def equal(number: int, ends: tuple[float, float]) -> list[float]:
        """Equal steps from one end to the other."""
        found: list[float] = np.linspace(*ends, number).tolist()
        return found

    def best(self, number: int, ends: tuple[float, float]) -> tuple[list[float], BestChoice]:
        """The choice in a range with the least uncertainty of the cell.

        Parameters
        ----------
        number : int
            Of rows, at least 2.
        ends : tuple of float
            In SI, the lesser first.

        Returns
        -------
        list of float
            In SI, increasing.
        BestChoice

        Notes
        -----
        One row after another goes to its best place on a grid until none moves, from equal steps and from
        both ends; then the grid is made finer. It is the best that was found, of which nothing is proved.
        Before it is sure, a choice is ordinary: as few cells as may be are without a value or outside of a
        limit, for two rows that are planned alike will not be measured alike, and tell anything then.

        Raises
        ------
        NotPlanned
            The cell has an uncertainty for no choice that was tried.
        """
        found: dict[tuple[float, ...], tuple[float, float]] = {}

        def judged(chosen: Sequence[float]) -> tuple[float, float]:
            key = tuple(sorted(chosen))
            if key not in found:
                try:
                    found[key] = self._judged(self.inputs_of(key))
                except NotPlanned:
                    found[key] = math.inf, math.inf
            return found[key]

        low, high = ends
        places = np.linspace(low, high, GRID + 1).tolist()
        equal = self.equal(number, ends)
        ends_first = [*places[: (number + 1) // 2], *places[::-1][: number // 2]]
        starts = (_settled(start, judged, lambda _: places) for start in (equal, ends_first))
        here, step = min(starts, key=judged), (high - low) / GRID
        for _ in range(HALVINGS):
            step /= 2
            here = _settled(here, judged, partial(_beside, by=step, ends=ends))
        if math.isinf(judged(here)[1]):
            raise NotPlanned("the cell has no uncertainty for any choice that was tried")
        return sorted(here), BestChoice(ends, judged(here)[1], judged(equal)[1], len(found))

    # --- backwards ---

    def needed(self, of: str, wanted: float, inputs: Inputs) -> Needed:
        """The largest uncertainty of a column with which the cell has no larger one than is wanted.

        Parameters
        ----------
        of : str
            A measured column or a parameter: all its own errors are one with this standard uncertainty.
        wanted : float
            Of the cell, in SI.
        inputs : Inputs
            Of planned rows.
        """

        def u(own: float) -> float:
            size = f"{own!r}".replace("e+", "e")  # a plus adds what follows it
            said = {of: read_statement(f"u = {size}", parse_unit(self.values.sheet[of].unit))}
            same = {name: [float(each.value) for each in inputs.numbers(name)] for name in inputs.measured}
            return self.u(planned(inputs, same, range(len(inputs.only.tests)), said))

        others = u(0.0)
        if not others <= wanted:
            return Needed(of, wanted, math.nan, others)
        numbers = inputs.numbers(of)
        low, high = 0.0, max((each.u for each in numbers), default=0.0) or float(abs(numbers[0].value)) * 1e-3
        endless = min(LARGEST, ENDLESS * max(high, *(abs(float(each.value)) for each in numbers)))
        while (there := u(high)) <= wanted:
            if high >= endless:
                return Needed(of, wanted, math.inf, others)
            low, high = high, min(STRIDE * high, LARGEST)
        while math.isinf(there) and high - low > CLOSE * high:
            middle = (low + high) / 2
            low, high, there = (low, middle, far) if (far := u(middle)) > wanted else (middle, high, there)
        if math.isfinite(there) and high - low > CLOSE * high:
            from scipy.optimize import brentq  # half a second, for those who ask backwards

            low = brentq(lambda own: u(own) - wanted, low, high, xtol=CLOSE * high, rtol=CLOSE)
        return Needed(of, wanted, low, others)


def _beside(at: float, by: float, ends: tuple[float, float]) -> list[float]:
    return [max(ends[0], at - by), min(ends[1], at + by)]


def _settled(
    start: Sequence[float],
    judged: Callable[[Sequence[float]], tuple[float, float]],
    near: Callable[[float], list[float]],
) -> list[float]:
    """Each of some numbers at its best place among those near to it, the others where they are."""
    here, least = list(start), (math.inf, math.inf)
    while (now := judged(here)) < least:
        least = now
        for row, at in enumerate(here):
            choices = [[*here[:row], place, *here[row + 1 :]] for place in (at, *near(at))]
            here = min(choices, key=judged)
    return here
