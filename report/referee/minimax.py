"""The input for which the worst of all published values is least wrong.

The worst mismatch is minimised over a box by a sequence of linear programs, each the best that the
derivatives promise within a region where they are trusted. What comes out was evaluated: a mismatch is
never that of a linearisation.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from ..engines.elementary import exp, log
from .campaign import Array
from .problem import ENOUGH, Box, Problem

STEPS = 100
PATIENCE = 5
"""After how many steps that gain next to nothing a search that only has to get somewhere gives up."""
WIDE = 4.0
"""How many times its low end the high end of an interval is from which on a search counts in logarithms."""
STARTS = 3
"""How many other points of a box a search begins at, if the first leads nowhere."""
SAMPLES = 128
"""From how many points these are taken: those that are least wrong."""


@dataclass(frozen=True)
class Best:
    """The best point that was found."""

    point: Array
    """Of shape (unknowns,)."""
    cells: Array
    """Of shape (published,); the published cells there, in SI."""
    mismatch: float
    """The worst of them, in half units of the last digit; infinite if some have no value."""
    weights: Array
    """Of shape (published,); how much each value presses against the bound, and to which side: the
    multipliers of the last linear program, whose sizes sum to 1."""
    promised: float = 0.0
    """What that program promised."""

    @property
    def pressing(self) -> NDArray[np.intp]:
        """The values that keep the worst mismatch from being less."""
        return np.flatnonzero(np.abs(self.weights) > 1e-9)


def best(
    problem: Problem,
    box: Box | None = None,
    until: float = 0.0,
    unless: float = np.inf,
) -> Best:
    """Search a box for the point with the least worst mismatch.

    Parameters
    ----------
    box : Box, optional
        That of the printed digits, if left out.
    until : float
        Stop as soon as the worst mismatch is not more.
    unless : float
        Stop as soon as the derivatives promise no less than this.

    Returns
    -------
    Best
        With its roots counted where the mismatch is at most 1, and something would be claimed.
    """
    found = _sought(problem.guessing, box or problem.box, until, unless)
    return counted(problem, found, box) if found.mismatch <= 1 else found


def counted(problem: Problem, found: Best, box: Box | None = None) -> Best:
    """What a search found, with its roots counted: it may be told. If they refute it, what else there is.

    `box`: that it was sought in.
    """
    if problem.guessing is problem or not np.isfinite(found.mismatch):
        return found
    cells = problem.evaluate(found.point[None])[0]
    if np.isfinite(worst := _worst(problem, cells)):
        return replace(found, cells=cells, mismatch=worst)
    return _sought(problem, box or problem.box)


def _sought(problem: Problem, box: Box, until: float = 0.0, unless: float = np.inf) -> Best:
    """The best point for a problem as it is, whether it counts roots or not."""
    here = problem.at(np.clip(box.start, box.low, box.high))
    worst, trust, weights = _worst(problem, here.cells), 1.0, np.zeros(len(here.cells))
    counted = _Counted.of(box, here.point)
    low, high, moving = counted.to(box.low), counted.to(box.high), np.flatnonzero(counted.scale)
    slopes, slow, promised = None, 0, worst
    for _ in range(STEPS):
        if not worst > until or not np.isfinite(worst) or not moving.size:
            break
        if slopes is None:
            slopes = (problem.slopes(here, box) * counted.slope(here.point))[:, moving]
            slopes = slopes / problem.half[:, None]
        if not np.isfinite(slopes).all():
            break
        own = counted.to(here.point)
        least, most = np.maximum(low - own, -trust)[moving], np.minimum(high - own, trust)[moving]
        step, promised, weights = _linear(slopes, problem.mismatch(here.cells), least, most)
        if promised > unless:
            break
        own[moving] += step
        there = problem.at(np.clip(counted.back(own), box.low, box.high))
        new = _worst(problem, there.cells)
        gain, hoped = worst - new, worst - promised
        if gain > 0:
            here, slopes, worst = there, None, new
        if gain > 0.75 * hoped:
            trust = min(2 * trust, 1e6)
        elif gain < 0.25 * hoped:
            trust = min(trust, float(np.abs(step).max(initial=0.0))) / 4
        if hoped < ENOUGH or trust < 1e-9 or (0 < gain < ENOUGH and hoped < 10 * ENOUGH):
            break
        slow += worst - until > 30 * gain
        if until and slow > PATIENCE:
            break  # it would take too long to get there
    return Best(here.point, here.cells, worst, weights, promised)


@dataclass(frozen=True)
class _Counted:
    """The unknowns as a search counts them: in their intervals; in logarithms where these are wide."""

    log: NDArray[np.bool_]
    """Of shape (unknowns,); which may differ by orders of magnitude."""
    scale: Array
    """Of shape (unknowns,); what a unit of each is; none for what cannot move."""

    @classmethod
    def of(cls, box: Box, point: Array) -> _Counted:
        """Those of a box."""
        log = (box.low > 0) & (box.high > WIDE * box.low)
        scale = np.minimum(box.width, 0.1 * np.maximum(np.abs(point), 1e-300))
        scale = np.where(box.width > 0, np.maximum(scale, 1e-300), 0.0)
        return cls(log, np.where(log, 0.1, scale))

    def to(self, points: Array) -> Array:
        """What is counted; what cannot move is nothing."""
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            found: Array = np.where(self.log, log(points), points) / self.scale
        return np.where(self.scale > 0, found, 0.0)

    def back(self, counted: Array) -> Array:
        """What stands for it."""
        with np.errstate(over="ignore"):
            found: Array = np.where(self.log, exp(counted * self.scale), counted * self.scale)
        return found

    def slope(self, points: Array) -> Array:
        """What a unit moves, at a point."""
        found: Array = np.where(self.log, points, 1.0) * self.scale
        return found


def meet(problem: Problem, box: Box | None = None, found: Best | None = None, until: float = 0.0) -> Best:
    """Search a box for a point that yields all published values, from several starts if need be.

    Parameters
    ----------
    box : Box, optional
        That of the printed digits, if left out.
    found : Best, optional
        From its own start, if that was sought already.
    until : float
        As for :func:`best`.

    Returns
    -------
    Best
        With a mismatch of at most 1 if one was found, else the least that was found.
    """
    box = box or problem.box
    found = found or best(problem, box, until)
    if found.mismatch <= 1:
        return found
    for start in _starts(problem, box):
        again = best(problem, replace(box, start=start), until, unless=found.mismatch)
        if again.mismatch < found.mismatch:
            found = again
        if found.mismatch <= 1:
            break
    return found


def _starts(problem: Problem, box: Box) -> Array:
    """Points of the box that are least wrong among some that have no order; the same for the same problem."""
    problem = problem.guessing
    printed = np.array([unknown.printed is not None for unknown in problem.unknowns], dtype=bool)
    # What is looked for in a wide range has a start of its own.
    near = printed & (box.width <= 2 * problem.box.width)
    share = np.random.default_rng(len(problem.unknowns)).random((SAMPLES, len(box.low)))
    points = np.where(near, box.low + share * box.width, np.clip(box.start, box.low, box.high))
    points = np.clip(problem.restarted(points), box.low, box.high)
    off = np.abs(problem.mismatch(problem.evaluate(points)))
    worst = np.nan_to_num(off, nan=np.inf).max(axis=1, initial=0.0)
    # Of those without a value somewhere, the ones with most values.
    order = np.lexsort((worst, np.isnan(off).sum(axis=1)))
    found: Array = points[order[:STARTS]]
    return found


def _worst(problem: Problem, cells: Array) -> float:
    with np.errstate(invalid="ignore"):
        found = float(np.max(np.abs(problem.mismatch(cells)), initial=0.0))
    return found if np.isfinite(found) else np.inf


def _linear(slopes: Array, off: Array, low: Array, high: Array) -> tuple[Array, float, Array]:
    """The step within bounds that makes the worst |off + slopes step| least, that, and its multipliers."""
    moving = slopes.shape[1]
    # A bound counts only if it may be reached where no value is less wrong than the worst must stay.
    rows, ends = np.concatenate([slopes, -slopes]), np.concatenate([off, -off])
    most = ends + np.maximum(rows * low, rows * high).sum(axis=1)
    which = np.flatnonzero(most >= -np.minimum(most, 0.0).min(initial=0.0))
    cost = np.zeros(moving + 1)
    cost[-1] = 1
    found = linprog(
        cost,
        A_ub=np.column_stack([rows[which], -np.ones(which.size)]),
        b_ub=-ends[which],
        bounds=np.column_stack([np.append(low, 0), np.append(high, np.inf)]),
        method="highs",
    )
    if found.x is None:
        return np.zeros(moving), float(np.abs(off).max()), np.zeros(len(off))
    weights = np.zeros(len(rows))
    weights[which] = -found.ineqlin.marginals
    above, below = np.split(weights, 2)
    return found.x[:-1], float(found.x[-1]), above - below
