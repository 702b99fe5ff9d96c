"""Small changes of what is printed with which everything published comes out.

Only what can matter is tried: the linear program that finds the least worst mismatch says which published
values press against it, and a change that touches none of them cannot relieve them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

import numpy as np
from scipy.optimize import linear_sum_assignment

from ...quantity import Printed
from ...verdict import INPUT, Change, Explanation
from .comparison import print_as
from .minimax import Best, best
from .problem import Array, Box, Problem

__all__ = ["Explained", "explanations"]

RANGE = 10.0
"""A misprinted number is looked for between a tenth and ten times what is printed."""
TRIED = 160
"""How many values in that range a search may begin at."""
HOPELESS = 3.0
"""What is promised to stay so many half units off is not looked into: derivatives are not that wrong."""
MOST_DIGITS = 40
"""How many ways to print a misprinted cell are listed at most."""


@dataclass(frozen=True)
class Explained:
    """An explanation, and the problem as it would be.

    Parameters
    ----------
    explanation : Explanation
    problem : Problem
    box : Box
    best : Best
    """

    explanation: Explanation
    problem: Problem
    box: Box
    best: Best


def explanations(problem: Problem, found: Best) -> tuple[Explained, ...]:
    """Find the smallest changes with which all published values come out.

    Parameters
    ----------
    problem : Problem
        One that cannot be met.
    found : Best
        Its best point.

    Returns
    -------
    tuple of Explained
        All that change as little as the least; those that move a digit least come first.
    """
    search = _Search(problem, found)
    one = [*search.truncated(), *search.misprints(), *search.misprints_in_tables(), *search.exchanges()]
    all_of_them = one or [*search.columns(), *search.orders()]
    least = min((each.explanation.count for each in all_of_them), default=0)
    equal = [each for each in all_of_them if each.explanation.count == least]
    return tuple(sorted(equal, key=lambda each: _digits_moved(each.explanation.first)))


class _Search:
    """The changes of one problem."""

    def __init__(self, problem: Problem, found: Best) -> None:
        self.problem, self.found = problem, found
        self.pressing = set(found.pressing.tolist()) or set(range(len(problem.published)))
        # If a change is right, then what is printed is nearer to the truth than the best that was found
        # without it: the search for it begins there.
        self.cells = problem.evaluate(problem.box.start[None])[0]
        self.slopes = problem.slopes(problem.box.start, problem.box)
        pressed = np.abs(self.slopes[sorted(self.pressing)])
        self.touching = np.flatnonzero((np.nan_to_num(pressed, nan=1.0) > 0).any(axis=0)).tolist()
        self.groups: dict[tuple[str, str], list[int]] = {}
        for n, value in enumerate(problem.published):
            self.groups.setdefault((value.source, value.cell), []).append(n)

    def best(self, problem: Problem, box: Box, until: float = 0.0, unless: float = np.inf) -> Best:
        """The best point near what is printed, beginning with the derivatives there."""
        known = self.slopes if np.isfinite(self.slopes).all() else None
        return best(problem, box, until, unless, known)

    def explained(self, change: Change, problem: Problem, box: Box, now: Best) -> Explained:
        """What a change of the print makes of the published values."""
        found = Explanation((change,), now.mismatch, len(problem.published), len(self.problem.published))
        return Explained(found, problem, box, now)

    # --- how a column was shortened -------------------------------------------------------------------

    def truncated(self) -> Iterator[Explained]:
        """A column of input or of a table that was cut where it is said to be rounded, or the reverse."""
        problem, box = self.problem, self.problem.box
        for name, members in problem.rows.items():
            printed = [problem.unknowns[n].printed for n in members]
            if not set(members) & set(self.touching) or printed[0] is None:
                continue
            was, would = printed[0].mode, _other(printed[0].mode)
            ends = [problem.unknowns[n].interval(would) for n in members]
            lows, highs = ([end[n] for end in ends] for n in (0, 1))
            middles = [(low + high) / 2 for low, high in ends]
            moved = box.moved(members, lows, highs, middles)
            now = self.best(problem, moved)
            if now.mismatch <= 1:
                change = Change("truncated", name, (), INPUT, was, would)
                yield self.explained(change, problem, moved, now)
        for (source, cell), members in self.groups.items():
            if not set(members) & self.pressing:
                continue
            was = problem.published[members[0]].printed.mode
            changed = self.printed_otherwise({
                n: replace(problem.published[n].printed, mode=_other(was)) for n in members
            })  # fmt: skip
            now = self.best(changed, changed.box)
            if now.mismatch <= 1:
                change = Change("truncated", cell, (), source, was, _other(was))
                yield self.explained(change, changed, changed.box, now)

    def printed_otherwise(self, changes: dict[int, Printed]) -> Problem:
        """The problem with other prints of some published values."""
        published = tuple(
            replace(value, printed=changes.get(n, value.printed))
            for n, value in enumerate(self.problem.published)
        )
        return self.problem.asking(published)

    # --- one cell -------------------------------------------------------------------------------------

    def misprints(self) -> Iterator[Explained]:
        """One given cell that would have to be printed otherwise."""
        for n in self.touching:
            printed = self.problem.unknowns[n].printed
            if printed is None:
                continue
            freed = self.freed(n)
            if freed is None:
                continue
            # Around the value that was found, all prints that are possible, and no others.
            middle = Fraction(print_as(float(freed[n]), printed)) * printed.scale
            possible: list[tuple[str, Box, Best]] = []
            for way in (1, -1):
                steps = range(0 if way == 1 else 1, MOST_DIGITS)
                for step in steps:
                    tried = self.reprinted(n, printed, middle + way * step * 2 * printed.half_unit, freed)
                    if tried is None:
                        if step or way == -1:
                            break
                        continue
                    possible.append(tried)
            if not possible:
                continue
            possible.sort(key=lambda each: Fraction(each[0]))
            would, box, now = possible[len(possible) // 2]
            also = tuple(text for text, _, _ in possible if text != would)
            unknown = self.problem.unknowns[n]
            change = Change("misprint", unknown.column, unknown.index, INPUT, printed.text, would, also)
            yield self.explained(change, self.problem, box, now)

    def reprinted(
        self, n: int, printed: Printed, value: Fraction, near: Array
    ) -> tuple[str, Box, Best] | None:
        """Try another print of a given cell."""
        text = print_as(float(value), printed)
        if Fraction(text) == Fraction(printed.text):
            return None
        low, high = map(float, replace(printed, text=text, value=value).interval)
        start = [min(max(float(near[n]), low), high)]
        box = replace(self.problem.box, start=near).moved([n], [low], [high], start)
        now = self.best(self.problem, box)
        return (text, box, now) if now.mismatch <= 1 else None

    def freed(self, n: int) -> Array | None:
        """An input in which one given cell has any value, and everything comes out; None if there is none."""
        box, own = self.problem.box, float(self.problem.box.start[n])
        if own == 0:
            scale = max(np.abs(self.problem.box.start[self.problem.rows[self.problem.unknowns[n].column]]))
            low, high = -scale, scale
        else:
            low, high = sorted((own / RANGE, own * RANGE))
        start = self.best_start(n, low, high)
        if start is None:
            return None
        wide = replace(box, start=start).moved([n], [low], [high], [start[n]])
        now = best(self.problem, wide, until=1.0)
        if now.mismatch > 1:
            now = self.best(self.problem, box.moved([n], [low], [high], [own]), until=1.0)
        return now.point if now.mismatch <= 1 else None

    def best_start(self, n: int, low: float, high: float) -> Array | None:
        """Among points with many values of one cell, the one that leaves least to what the others can do.

        None if what is left is too much even between the points.
        """
        box = self.problem.box
        values = np.geomspace(low, high, TRIED) if low > 0 else np.linspace(low, high, TRIED)
        points = np.repeat(box.start[None], TRIED, axis=0)
        points[:, n] = values
        points = self.problem.restarted(points)
        mismatch = self.problem.mismatch(self.problem.evaluate(points))
        slopes = np.abs(np.nan_to_num(self.slopes))
        slopes[:, n] = 0
        reach = slopes @ (box.width / 2) / self.problem.half
        with np.errstate(invalid="ignore"):
            steps = np.nan_to_num(np.abs(np.diff(mismatch, axis=0)), nan=np.inf)
            between = np.maximum(np.vstack([steps, steps[-1:]]), np.vstack([steps[:1], steps]))
            off = np.max(np.abs(mismatch) - reach, axis=1)
            left = np.max(np.abs(mismatch) - reach - between, axis=1)
        if np.isnan(off).all() or np.nanmin(left) > HOPELESS:
            return None
        found: Array = points[np.nanargmin(off)]
        return found

    def misprints_in_tables(self) -> Iterator[Explained]:
        """One published value without which the others come out."""
        for n in sorted(self.pressing):
            others = self.problem.asking([value for m, value in enumerate(self.problem.published) if m != n])
            now = best(others, unless=HOPELESS)
            if now.mismatch > 1:
                continue
            value = self.problem.published[n]
            cell = float(self.problem.evaluate(now.point[None])[0, n])
            would = print_as(cell, value.printed) if np.isfinite(cell) else "no value"
            change = Change("misprint", value.cell, value.index, value.source, value.printed.text, would)
            yield self.explained(change, others, others.box, now)

    # --- rows and columns under the wrong name --------------------------------------------------------

    def exchanges(self) -> Iterator[Explained]:
        """Two numbers of a column that stand in each other's place."""
        yield from self.exchanged_in_tables()
        yield from self.exchanged_inputs()

    def exchanged_in_tables(self) -> Iterator[Explained]:
        published = self.problem.published
        for members in self.groups.values():
            for n, m in _pairs(members, self.pressing):
                one, other = published[n], published[m]
                if one.printed.text == other.printed.text:
                    continue
                changed = self.printed_otherwise({n: other.printed, m: one.printed})
                now = self.hopeful(changed)
                if now is not None and now.mismatch <= 1:
                    texts = one.printed.text, other.printed.text
                    change = Change("label", one.cell, one.index, one.source, *texts, other=other.index)
                    yield self.explained(change, changed, changed.box, now)

    def exchanged_inputs(self) -> Iterator[Explained]:
        for name, members in self.problem.rows.items():
            for n, m in _pairs(members, set(self.touching)):
                one, other = self.problem.unknowns[n], self.problem.unknowns[m]
                if one.printed is None or other.printed is None or one.printed.text == other.printed.text:
                    continue
                ends = [other.interval(), one.interval()]
                box = self.problem.box.moved(
                    [n, m], [end[0] for end in ends], [end[1] for end in ends], [other.start, one.start]
                )
                box = replace(box, start=self.problem.restarted(box.start))
                if not self.promising(box):
                    continue
                now = best(self.problem, box, unless=HOPELESS)
                if now.mismatch <= 1:
                    texts = one.printed.text, other.printed.text
                    change = Change("label", name, one.index, INPUT, *texts, other=other.index)
                    yield self.explained(change, self.problem, box, now)

    @cached_property
    def reach(self) -> Array:
        """How far the published cells can move within the box, in SI, as far as derivatives tell."""
        found: Array = np.abs(self.slopes) @ self.problem.box.width
        return found

    def promising(self, box: Box) -> bool:
        """Whether values can be reached that well, as far as the sizes of the derivatives tell."""
        problem = self.problem
        cells = problem.evaluate(box.start[None])[0]
        if not np.isfinite(cells).all():
            return False
        reach = np.abs(problem.slopes(box.start, box)) @ box.width / problem.half
        return bool((np.abs(problem.mismatch(cells)) <= 1.5 * reach + 3).all())

    def hopeful(self, changed: Problem) -> Best | None:
        """The best point of a problem with other prints, if it can be any good."""
        reach = self.reach / changed.half
        if not (np.abs(changed.mismatch(self.cells)) <= 1.5 * reach + 3).all():
            return None
        return self.best(changed, changed.box, unless=HOPELESS)

    def columns(self) -> Iterator[Explained]:
        """A row of a table that holds another column than the one it is named after."""
        sheet = self.problem.campaign.sheet
        for (source, cell), members in self.groups.items():
            if not set(members) & self.pressing:
                continue
            own = sheet[cell]
            for column in sheet.columns:
                if column.name == cell or column.axis != own.axis or column.unit != own.unit:
                    continue
                changed = self.problem.campaign.problem([
                    replace(value, cell=column.name) if n in members else value
                    for n, value in enumerate(self.problem.published)
                ])  # fmt: skip
                now = best(changed)
                if now.mismatch <= 1:
                    change = Change("label", cell, (), source, cell, column.name)
                    yield self.explained(change, changed, changed.box, now)

    def orders(self) -> Iterator[Explained]:
        """A list of a table that stands in another order than its rows."""
        for (source, cell), members in self.groups.items():
            if len(members) < 3 or not set(members) & self.pressing:
                continue
            changed, point, order = self.problem, self.problem.box.start, list(members)
            for _ in range(5):
                cells = self.problem.evaluate(point[None])[0]
                if not np.isfinite(cells).all():
                    break
                new = self.assigned(members, cells)
                if new == order:
                    break
                order = new
                changed = self.printed_otherwise({
                    n: self.problem.published[m].printed for n, m in zip(members, order, strict=True)
                })  # fmt: skip
                point = best(changed, replace(changed.box, start=point)).point
            if order == members:
                continue
            now = best(changed, replace(changed.box, start=point))
            if now.mismatch > 1:
                continue
            texts, would = (
                ", ".join(self.problem.published[n].printed.text for n in rows) for rows in (members, order)
            )
            change = Change("order", cell, (), source, texts, would, count=_exchanges(members, order))
            yield self.explained(change, changed, changed.box, now)

    def assigned(self, members: Sequence[int], cells: Array) -> list[int]:
        """Which print goes best with which row."""
        centre, half = self.problem.centre[list(members)], self.problem.half[list(members)]
        cost = ((cells[list(members)][:, None] - centre) / half) ** 2
        _, columns = linear_sum_assignment(cost)
        return [members[n] for n in columns.tolist()]


def _digits_moved(change: Change) -> float:
    """By how many units of the last digit a print moves; by none, where it only was made in another way."""
    if change.kind == "truncated":
        return 0.0
    try:
        printed, would = Fraction(change.printed), Fraction(change.would_print)
    except ValueError:
        return np.inf
    decimals = len(change.printed.partition(".")[2])
    return float(abs(printed - would) * 10**decimals)


def _other(mode: str) -> str:
    return "rounded" if mode == "truncated" else "truncated"


def _pairs(members: Sequence[int], touched: set[int]) -> Iterable[tuple[int, int]]:
    """Every two of them of which one is touched."""
    for place, n in enumerate(members):
        for m in members[place + 1 :]:
            if n in touched or m in touched:
                yield n, m


def _exchanges(before: Sequence[int], after: Sequence[int]) -> int:
    """How many exchanges of two make one order out of another."""
    follows, seen, cycles = dict(zip(before, after, strict=True)), set(), 0
    for start in before:
        here, cycles = start, cycles + (start not in seen)
        while here not in seen:
            seen.add(here)
            here = follows[here]
    return len(before) - cycles
