"""The verdict on every published value by itself."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..inputs.published import PublishedValue
from ..result.numbers import for_json
from ..result.verdict import EXACT, NOT_CHECKABLE, NOT_FOUND, REACHABLE, UNREACHABLE, WITHIN, Verdict
from .campaign import COVERAGE, Array, Campaign
from .certificate import Certificate
from .comparison import prints_same
from .minimax import best
from .problem import Problem

HALVINGS = 50
MOST = 1 << 24
"""Cells that are computed at once in search of what is furthest."""
ROUNDED = 2.0**-20
"""A relative derivative of less is what rounding leaves of none: the value does not rest on the unknown."""
CLOSE = 0.1
"""How near to the middle of its print a witness needs to come, in half units of the last digit."""


def verdicts(campaign: Campaign, published: Sequence[PublishedValue]) -> tuple[Verdict, ...]:
    """Judge every published value by itself."""
    found: dict[int, Verdict] = {}
    groups: dict[str, list[int]] = {}
    for n, value in enumerate(published):
        if campaign.values.cell(value.cell, value.index).value is None:
            found[n] = Verdict(NOT_CHECKABLE)
        else:
            # What is free elsewhere follows from the inputs where it is the one that is asked for.
            groups.setdefault(value.cell if value.cell in campaign.free else "", []).append(n)
    for tied, members in groups.items():
        problem = Problem.of(campaign, [published[n] for n in members], (tied,) if tied else ())
        for n, verdict in zip(members, _Alone(problem).verdicts(), strict=True):
            found[n] = verdict
    return tuple(found[n] for n in range(len(published)))


class _Alone:
    """Published values of one sheet, each asked for by itself."""

    def __init__(self, problem: Problem) -> None:
        self.problem, self.certificate = problem, Certificate(problem)
        here = problem.at(problem.box.start)
        self.slopes, self.here = problem.slopes(here, problem.box), here.cells

    def verdicts(self) -> list[Verdict]:
        """In the order of the problem's values."""
        # Where the derivatives keep their signs, these two corners of the box hold the least and the
        # largest value; where they do not, others may.
        box = self.problem.box
        rising = np.nan_to_num(self.slopes) > 0
        low, least = self._furthest(np.where(rising, box.low, box.high), -1)
        high, largest = self._furthest(np.where(rising, box.high, box.low), 1)
        meeting = self._on_the_way(low, high, least, largest)
        cells = np.diagonal(self.problem.evaluate(meeting))
        off = np.nan_to_num(np.abs(self.problem.mismatch(cells)), nan=np.inf)
        seen = np.stack([least, largest, self.here, cells], axis=-1)
        return [self._verdict(n, seen[n], float(off[n])) for n in range(len(cells))]

    def _furthest(self, corners: Array, way: int) -> tuple[Array, Array]:
        """For each value the corner of the box where it is furthest down (way -1) or up (1), and it itself.

        From the given corners (published, unknowns), one unknown after another goes to its other end, the
        one that leads furthest first, until none leads further.
        """
        problem, box = self.problem.guessing, self.problem.box
        known = np.array([unknown.printed is not None for unknown in problem.unknowns], dtype=bool)
        moving = np.flatnonzero(known & (box.width > 0))
        found = np.diagonal(problem.evaluate(corners)).copy()
        going = np.arange(len(found))
        while going.size and moving.size and going.size * moving.size * problem.size <= MOST:
            tried = np.repeat(corners[going, None], moving.size, axis=1)
            turned = np.where(corners == box.low, box.high, box.low)[np.ix_(going, moving)]
            tried[:, np.arange(moving.size), moving] = turned
            cells = problem.evaluate(tried.reshape(-1, tried.shape[-1]))[:, going]
            own = cells.reshape(*tried.shape[:2], going.size)[np.arange(going.size), :, np.arange(going.size)]
            best = np.argmax(np.nan_to_num(way * own, nan=-np.inf), axis=1)
            reached = own[np.arange(going.size), best]
            further = ~(way * reached <= way * found[going]) & np.isfinite(reached)
            going, best, reached = going[further], best[further], reached[further]
            corners[going] = tried[further, best]
            found[going] = reached
        if problem is not self.problem:
            found = np.diagonal(self.problem.evaluate(corners))
        return corners, found

    def _on_the_way(self, start: Array, end: Array, least: Array, largest: Array) -> Array:
        """For each value, a point between its corners that yields what was printed, or what comes nearest."""
        goal = self.problem.centre
        share = np.where(goal < least, 0.0, np.where(goal > largest, 1.0, 0.5))
        low, high = np.zeros(len(goal)), np.ones(len(goal))
        asked = np.flatnonzero(share == 0.5)
        for _ in range(HALVINGS):
            points = start[asked] + share[asked, None] * (end - start)[asked]
            cells = self.problem.guessing.evaluate(points)[np.arange(len(asked)), asked]
            off = np.abs(cells - goal[asked]) / self.problem.half[asked]
            below = cells < goal[asked]
            low[asked] = np.where(below, share[asked], low[asked])
            high[asked] = np.where(below, high[asked], share[asked])
            asked = asked[~(off <= CLOSE)]
            if not asked.size:
                break
            share[asked] = (low[asked] + high[asked]) / 2
        found: Array = start + share[:, None] * (end - start)
        return found

    def _verdict(self, n: int, seen: Array, mismatch: float) -> Verdict:
        problem, published = self.problem, self.problem.published[n]
        bound_low = bound_high = None
        if prints_same(float(self.here[n]), published.printed):
            mismatch, word = abs(float(problem.mismatch(self.here)[n])), EXACT
        else:
            if not mismatch <= 1:
                alone = best(problem.only([n]), until=0.5)
                seen = np.append(seen, alone.cells)
                mismatch = min(mismatch, alone.mismatch)
            word = REACHABLE
            if not mismatch <= 1:
                # What is certain takes longest to find, and is asked for only where something is claimed.
                bounds = self.certificate.bounds[n]
                bound_low, bound_high = for_json(float(bounds.low)), for_json(float(bounds.high))
                word = self._else(n, bounds.low, bounds.high)
        by = np.abs(self.slopes[n] * problem.box.start)
        free = [
            m
            for m, unknown in enumerate(problem.unknowns)
            if unknown.printed is None and self.slopes[n, m] and not 0 < by[m] <= ROUNDED * abs(self.here[n])
        ]
        seen = seen[np.isfinite(seen)]
        low, high = (None, None) if free or not seen.size else (float(seen.min()), float(seen.max()))
        return Verdict(word, low, high, bound_low, bound_high, for_json(mismatch))

    def _else(self, n: int, bound_low: Array, bound_high: Array) -> str:
        """The word for a value that nothing was found for."""
        u = self._u(n)
        distance = abs(self.here[n] - self.problem.published[n].printed.spread[0])
        if u is not None and distance <= COVERAGE * u:
            return WITHIN
        low, high = (float(end) for end in self.problem.published[n].printed.interval)
        return UNREACHABLE if bound_high < low or bound_low > high else NOT_FOUND

    def _u(self, n: int) -> float | None:
        """Combined standard uncertainty, if something that is stated moves the value."""
        campaign, (name, row) = self.problem.campaign, self.problem.places[n]
        if not campaign.states:
            return None
        own = campaign.spread.contributions([(name, row)])[0]
        moving = zip(campaign.spread.sources, own.tolist(), strict=False)
        if not any(source.said for source, moved in moving if moved):
            return None
        return for_json(campaign.spread.budget(name, row).u)
