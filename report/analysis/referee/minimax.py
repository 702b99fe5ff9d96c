"""The input for which the worst of all published values is least wrong.

The worst mismatch is minimised over a box by a sequence of linear programs, each the best that the
derivatives promise within a region where they are trusted. What comes out was evaluated: a mismatch is
never that of a linearisation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from .problem import Array, Box, Problem

__all__ = ["Best", "best"]

STEPS = 40
PATIENCE = 5
"""After how many steps that gain next to nothing a search that only has to get somewhere gives up."""
ENOUGH = 1e-6
"""What a step must gain, in half units of the last digit."""


@dataclass(frozen=True)
class Best:
    """The best point that was found.

    Parameters
    ----------
    point : float array (unknowns,)
    cells : float array (published,)
        The published cells there, in SI.
    mismatch : float
        The worst of them, in half units of the last digit; infinite if some have no value.
    weights : float array (published,)
        How much each value presses against the bound, and to which side: the multipliers of the last
        linear program, whose sizes sum to 1.
    """

    point: Array
    cells: Array
    mismatch: float
    weights: Array

    @property
    def pressing(self) -> NDArray[np.intp]:
        """The values that keep the worst mismatch from being less."""
        return np.flatnonzero(np.abs(self.weights) > 1e-9)


def best(
    problem: Problem,
    box: Box | None = None,
    until: float = 0.0,
    unless: float = np.inf,
    slopes: Array | None = None,
) -> Best:
    """Search a box for the point with the least worst mismatch.

    Parameters
    ----------
    problem : Problem
    box : Box, optional
        That of the printed digits, if left out.
    until : float
        Stop as soon as the worst mismatch is not more.
    unless : float
        Stop as soon as the derivatives promise no less than this.
    slopes : float array (published, unknowns), optional
        Derivatives near the start, if they are known.
    """
    box = box or problem.box
    point = np.clip(box.start, box.low, box.high)
    cells = problem.evaluate(point[None])[0]
    worst, trust, weights = _worst(problem, cells), 1.0, np.zeros(len(cells))
    scale = _scale(box, point)
    moving = np.flatnonzero(scale)
    stale, slow = slopes is not None, 0
    for _ in range(STEPS):
        if not worst > until or not np.isfinite(worst) or not moving.size:
            break
        if slopes is None:
            slopes, stale = problem.slopes(point, box), False
        if not np.isfinite(slopes[:, moving]).all():
            break
        scaled = slopes[:, moving] * scale[moving] / problem.half[:, None]
        low = np.maximum((box.low - point)[moving] / scale[moving], -trust)
        high = np.minimum((box.high - point)[moving] / scale[moving], trust)
        step, promised, weights = _linear(scaled, problem.mismatch(cells), low, high)
        if promised > unless:
            break
        there = point.copy()
        there[moving] = np.clip(point[moving] + step * scale[moving], box.low[moving], box.high[moving])
        its = problem.evaluate(there[None])[0]
        new = _worst(problem, its)
        gain, hoped = worst - new, worst - promised
        if gain > 0:
            point, cells, worst = there, its, new
        if stale and (gain < 0.5 * hoped or hoped < ENOUGH):
            slopes = None  # derivatives of another point have led as far as they can
            continue
        stale = True
        if gain > 0.75 * hoped:
            trust = min(2 * trust, 1e6)
        elif gain < 0.25 * hoped:
            trust = min(trust, float(np.abs(step).max(initial=0.0))) / 4
        if hoped < ENOUGH or trust < 1e-9 or (0 < gain < ENOUGH and hoped < 10 * ENOUGH):
            break
        slow += worst - until > 30 * gain
        if until and slow > PATIENCE:
            break  # it would take too long to get there
    return Best(point, cells, worst, weights)


def _scale(box: Box, point: Array) -> Array:
    """What each unknown is counted in: its interval, or, if that is wide, a share of itself."""
    found: Array = np.minimum(box.width, 0.1 * np.maximum(np.abs(point), 1e-300))
    return np.where(box.width > 0, np.maximum(found, 1e-300), 0.0)


def _worst(problem: Problem, cells: Array) -> float:
    with np.errstate(invalid="ignore"):
        found = float(np.max(np.abs(problem.mismatch(cells)), initial=0.0))
    return found if np.isfinite(found) else np.inf


def _linear(slopes: Array, off: Array, low: Array, high: Array) -> tuple[Array, float, Array]:
    """The step within bounds that makes the worst |off + slopes step| least, that, and its multipliers."""
    number, moving = slopes.shape
    ones = np.ones((number, 1))
    rows = np.block([[slopes, -ones], [-slopes, -ones]])
    cost = np.zeros(moving + 1)
    cost[-1] = 1
    bounds = [*zip(low.tolist(), high.tolist(), strict=True), (0, None)]
    found = linprog(cost, A_ub=rows, b_ub=np.concatenate([-off, off]), bounds=bounds, method="highs")
    if found.x is None:
        return np.zeros(moving), float(np.abs(off).max()), np.zeros(number)
    above, below = -found.ineqlin.marginals[:number], -found.ineqlin.marginals[number:]
    return found.x[:-1], float(found.x[-1]), above - below
