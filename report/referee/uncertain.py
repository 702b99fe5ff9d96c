"""Published uncertainties beside the computed ones, in the digits that were printed.

How readings scatter, and what slopes are, hangs on digits that are not printed: what differs is looked for
among the numbers that print as given, each by itself, along the slopes from those that are printed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..cells.marks import Marks
from ..cells.values import Cell, Status, Values
from ..inputs.about import About
from ..inputs.inputs import Inputs
from ..inputs.planned import otherwise
from ..result.result import Comparison
from ..result.verdict import REACHABLE, Verdict
from ..sheet import Column, Sheet
from ..uncertainty.monte_carlo import draw
from ..uncertainty.propagation import Spread
from .campaign import Array, Campaign
from .comparison import beside, missing_as_expected, prints_same

if TYPE_CHECKING:
    from ..inputs.published import PublishedValue
    from ..result.uncertain import Budget

NOTHING = "nothing is known of its uncertainty"
NO_FREEDOM = "nothing is known of the degrees of freedom of its uncertainty"
FINER = 5
"""A printed end of an interval is drawn to a fifth of half of its last unit."""
MOST = 10_000_000
"""Draws, at most."""


MOST_MOVED = 300
"""Numbers that are looked for at once, at most: each takes an evaluation."""
_HALVINGS = 40

_SAID = re.compile(
    r"(?!.* \+ )(?:[uUs] = ([0-9]*\.?[0-9]*)(?:e[+-]?[0-9]+)?(?! ?(?:%|ppm|digit))(?=[ ,]|$)|.*\(([0-9]+)\))"
)
"""A standard or expanded uncertainty or a standard deviation as it was stated; last digits in parentheses.
No share of a reading, no number of digits, which count, and no sum of several."""

Compute = Callable[[Inputs], Marks]
"""Computes some columns of a sheet for other inputs."""


def compare_uncertainties(
    inputs: Inputs,
    values: Values,
    computing: Callable[[Sequence[Column]], Compute],
    step: Callable[[str], None],
) -> tuple[Comparison, ...]:
    """Set everything that is published of uncertainties beside what is computed.

    `values`: all columns, without a batch. `computing`: makes what computes some columns again. `step`: told
    what is begun.
    """
    if not inputs.published_u:
        return ()
    asked = _Asked(inputs, values, step)
    return tuple(asked.refereed(each, computing) for each in inputs.published_u)


class _Asked:
    """What is told of cells."""

    def __init__(
        self, inputs: Inputs, values: Values, step: Callable[[str], None], like: Spread | None = None
    ) -> None:
        self.inputs, self.values, self.step = inputs, values, step
        self.spread = Spread(inputs, values, like)
        self.drawn: dict[tuple[str, float, float], tuple[float, float]] = {}

    def compared(self, published: PublishedValue) -> Comparison:
        """It beside what is computed; if its cell has no value, that may be expected."""
        assert published.about is not None
        there = self.values.cell(published.about.cell, published.index)
        expected = missing_as_expected(there, self.values, self.inputs.expected)
        found = beside(published, self.cell(published), expected=expected)
        return replace(found, instead=self.instead(published)) if found.verdict == "differs" else found

    def refereed(
        self, published: PublishedValue, computing: Callable[[Sequence[Column]], Compute]
    ) -> Comparison:
        """The same; what comes out of numbers that print as given does not differ from them."""
        found = self.compared(published)
        if found.verdict != "differs" or published.expect or found.instead:
            return found
        self.step(f"refereeing {published.cell}")
        verdict = self.reached(published, computing)
        return found if verdict is None else replace(found, refereed=verdict, finding="")

    def reached(
        self, published: PublishedValue, computing: Callable[[Sequence[Column]], Compute]
    ) -> Verdict | None:
        """What numbers that print as given yield, if one of them is what was published; else None."""
        about, sheet = published.about, self.values.sheet
        if about is None or about.kind in ("low", "high"):
            return None  # draws
        if (verdict := self.of_rounded(published)) is not None:
            return verdict
        columns = [sheet[name] for name in (about.cell, about.other) if name]
        above = {each.name for column in columns for each in (column, *sheet.ancestors(column))}
        part = Sheet(tuple(column for column in sheet.columns if column.name in above))
        unknowns = list(Campaign(sheet, self.inputs, self.values, {}).unknowns(part, ()))
        if len(unknowns) > MOST_MOVED:
            return None
        compute, like = computing(columns), list[Spread]()
        start = np.array([unknown.start for unknown in unknowns])
        low, high = np.array([unknown.interval() for unknown in unknowns]).reshape(-1, 2).T

        every = {
            name: np.broadcast_to(self.values.value[name], len(self.values.labels(sheet[name]))).tolist()
            for name in dict.fromkeys(unknown.column for unknown in unknowns)
        }

        def at(point: Array) -> float:
            numbers = {name: [*column] for name, column in every.items()}
            for unknown, value in zip(unknowns, point.tolist(), strict=True):
                numbers[unknown.column][unknown.row] = value
            inputs = otherwise(self.inputs, numbers)
            asked = _Asked(inputs, compute(inputs).values, self.step, *like)
            like[:] = [asked.spread]
            return asked.number(about, published.index, 0.0, whole=not published.printed.decimals)

        here, printed = at(start), published.printed
        slopes = np.array([at(np.where(own, high, start)) - here for own in np.eye(len(start), dtype=bool)])
        ahead = np.sign((float(printed.value) - here) * slopes)
        corner = np.where(ahead > 0, high, np.where(ahead < 0, low, start))
        far = at(corner)
        if not prints_same(far, printed) and (far - float(printed.value)) * (here - float(printed.value)) > 0:
            return None
        # Between what prints less and what prints more.
        ends, found = (0.0, 1.0), far
        for _ in range(_HALVINGS):
            if prints_same(found, printed):
                off = abs(found - float(printed.value)) / float(printed.half_unit)
                return Verdict(REACHABLE, min(here, found), max(here, found), mismatch=off)
            share = sum(ends) / 2
            found = at(start + share * (corner - start))
            is_ahead = (found - float(printed.value)) * (here - float(printed.value)) > 0
            ends = (share, ends[1]) if is_ahead else (ends[0], share)
        return None

    def of_rounded(self, published: PublishedValue) -> Verdict | None:
        """The same of stated uncertainties that print as given: authors compute with more digits of them."""
        about, printed = published.about, published.printed
        if about is None or about.other or about.kind not in ("u", "U"):
            return None
        row = self.values.row(self.values.sheet[about.cell], published.index)
        budget = self.spread.budget(about.cell, row, about.level)
        if not budget.u > 0 or budget.second or budget.correlations or budget.tied:
            return None
        own = np.array([each.u for each in budget.contributions])
        rounded = np.array([_rounded(each.source.said) for each in budget.contributions])
        here, value = self.number(about, published.index, 0.0), float(printed.value)
        low, high = (here * float(np.linalg.norm(own * (1 + side * rounded))) / budget.u for side in (-1, 1))
        nearest = min(max(value, low), high)
        if not (low < high and prints_same(nearest, printed)):
            return None
        return Verdict(REACHABLE, low, high, mismatch=abs(nearest - value) / float(printed.half_unit))

    def instead(self, published: PublishedValue) -> str:
        """Which of u, U and 2 u prints as another of them was published; empty if none does."""
        about = published.about
        if about is None or about.other or about.kind not in ("u", "U"):
            return ""
        row = self.values.row(self.values.sheet[about.cell], published.index)
        budget = self.spread.budget(about.cell, row, about.level)
        others = {"U": budget.expanded, "2 u": 2 * budget.u} if about.kind == "u" else {"u": budget.u}
        return next((each for each, u in others.items() if prints_same(u, published.printed)), "")

    def cell(self, published: PublishedValue) -> Cell:
        """What is computed, as a cell of its own name; without a value where the cell has none."""
        assert published.about is not None
        about, index = published.about, published.index
        there = self.values.cell(about.cell, index)
        if there.value is None:
            return replace(there, name=published.cell, culprit=there.culprit or there)
        number = self.number(about, index, float(published.printed.half_unit) / FINER)
        if not math.isfinite(number):
            known = about.kind in ("U", "k", "dof") and math.isfinite(
                self.number(About("u", about.cell), index, 0.0)
            )
            why = NO_FREEDOM if known else NOTHING
            return Cell(published.cell, index, None, Status.DOMAIN, None, why, there.word)
        if about.kind == "dof" and not prints_same(number, published.printed):
            # Truncated they are for a table of t; some print what they were before.
            before = self.number(about, index, 0.0, whole=False)
            number = (
                before if published.printed.decimals or prints_same(before, published.printed) else number
            )
        return Cell(published.cell, index, number, Status.OK, word=there.word)

    def number(self, about: About, index: tuple[int, ...], tolerance: float, whole: bool = True) -> float:
        """What is told, in SI; NaN where nothing is known. Draws tell it to a tolerance.

        `whole`: whether degrees of freedom are truncated.
        """
        row = self.values.row(self.values.sheet[about.cell], index)
        if about.kind == "r":
            return self._correlation((about.cell, row), (about.other, row))
        if about.other:
            return self._contribution(about, row)
        budget = self.spread.budget(about.cell, row, about.level)
        if about.kind in ("low", "high"):
            return self._interval(budget, tolerance)[about.kind == "high"]
        known = {
            "u": budget.u,
            "U": about.factor * budget.u or budget.expanded,
            "k": budget.factor,
            "dof": budget.dof if whole else self.spread.freedom(about.cell, row),
        }
        return known.get(about.kind, math.sqrt(max(budget.u**2 - budget.second, 0.0)))

    def _correlation(self, *cells: tuple[str, int]) -> float:
        found = self.spread.covariance(cells)
        with np.errstate(all="ignore"):
            return float(found[0, 1] / np.sqrt(found[0, 0] * found[1, 1]))

    def _contribution(self, about: About, row: int) -> float:
        """Of all errors of a column together, to first order."""
        own = self.spread.contributions([(about.cell, row)])[0]
        names = [{name for name, _, _ in source.moves} for source in self.spread.sources]
        return math.hypot(*(own[n] for n, moved in enumerate(names) if about.other in moved))

    def _interval(self, budget: Budget, tolerance: float) -> tuple[float, float]:
        """By draws, the same for both of its ends."""
        key = budget.cell, budget.level, tolerance
        if key not in self.drawn:
            told = draw(self.inputs, self.values, budget, MOST, step=self.step, tolerance=tolerance)
            self.drawn[key] = told.symmetric
        return self.drawn[key]


def _rounded(said: str) -> float:
    """Which share of it half a unit of the last digit of a stated uncertainty is; else 0.

    >>> _rounded("u = 0.25 mm"), _rounded("12.3(5)"), _rounded("u = 1 % of reading"), _rounded("+-0.1 rect")
    (0.02, 0.1, 0.0, 0.0)
    >>> _rounded("u = 2 digits"), _rounded("u = 200 ppm"), _rounded("u = 0.1 mm + 2 %")
    (0.0, 0.0, 0.0)
    """
    found = _SAID.match(said)
    text = (found[1] or found[2]) if found else ""
    if not text or not float(text):
        return 0.0
    return float(f"5e-{len(text.partition('.')[2]) + 1}") / float(text)
