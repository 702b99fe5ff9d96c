"""Least squares of any model: the parameters that make a sum of squares least, or why there are none.

What is guaranteed. A fit that says it has converged is stationary: what of its n residuals is in the tangent
plane is too short to show in the rounded sum of squares (at most sqrt(n eps) of what lies across; `offset`
tells it as Bates and Watts count it), or it is no more than what the rounding of the parameters makes of it.
(That no other place is better nobody can say of a nonlinear model.) Any other end has its name in
:class:`Ending`, and the numbers of such a run are refused, not given.

Steps are Levenberg's and Marquardt's, within a radius, by orthogonal reflections of the Jacobian with scaled
columns; normal equations are never formed. Once Bates and Watts would end, undamped steps follow as long as
they bring the residuals nearer to orthogonal. Standard uncertainties follow from given ones alone (`u`), or
from the scatter alone (`u_by_scatter`): nothing is scaled by chi2 in silence. The bits hang on no processor
if those of the model do not.

Sources: J. J. More, The Levenberg-Marquardt algorithm: implementation and theory, Lecture Notes in
Mathematics 630 (1978) 105-116; D. M. Bates and D. G. Watts, A relative offset orthogonality convergence
criterion for nonlinear least squares, Technometrics 23 (1981) 179-183.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np

from .triangle import EPS, Array, Triangle, lengths

__all__ = ["Ending", "Fitted", "NotFitted", "least_squares"]

STEPS, ROUNDS = 5000, 50
Function = Callable[[Array], Array]


class Ending(Enum):
    """How a run ended: only the first is a fit."""

    CONVERGED = "converged"
    SINGULAR = "the parameters cannot be told apart or run away: the last Jacobian has not full rank"
    STUCK = "no step makes the sum of squares less, though by the Jacobian one should"
    UNFINISHED = f"{STEPS} steps were too few: the parameters run away, or creep along a valley"
    OUTSIDE = "the model, its derivatives or its adjusted points have no value where the run starts"


class NotFitted(ArithmeticError):
    """A number was asked of a run that did not converge."""


@dataclass(frozen=True)
class Fitted:
    """Where a run ended, and what is known there.

    Attributes
    ----------
    ending : Ending
    reached : array (p,)
        Where it ended; if it converged, the parameters.
    residuals : array (n,)
    triangle : Triangle
        Of the Jacobian there, and the residuals with the other sign.
    steps : int
        How many steps were tried.
    """

    ending: Ending
    reached: Array
    residuals: Array
    triangle: Triangle
    steps: int

    @property
    def converged(self) -> bool:
        """Whether there is a fit."""
        return self.ending is Ending.CONVERGED

    @property
    def believed(self) -> Fitted:
        """The fit itself.

        Raises
        ------
        NotFitted
            The run did not converge; the sentence says why. All numbers below ask this first.
        """
        if not self.converged:
            raise NotFitted(self.ending.value)
        return self

    @property
    def parameters(self) -> Array:
        """The parameters (p,) with the least sum of squares."""
        return self.believed.reached

    @property
    def chi2(self) -> float:
        """The least sum of squares."""
        return float(np.sum(self.believed.residuals**2))

    @property
    def freedom(self) -> int:
        """Degrees of freedom, n - p."""
        return len(self.residuals) - len(self.reached)

    @property
    def condition(self) -> float:
        """The condition of the Jacobian with columns of one length."""
        return self.triangle.condition

    @property
    def offset(self) -> float:
        """The relative offset: residuals in the tangent plane beside those across it, each by its dimension.

        Without a degree of freedom, or without residuals, there is none: nan.
        """
        across = self.triangle.outside
        if self.freedom <= 0 or across == 0:
            return np.nan
        return float(self.triangle.inside / across * np.sqrt(self.freedom / len(self.reached)))

    @property
    def covariance(self) -> Array:
        """Of the parameters (p, p), where residuals were divided by their given standard uncertainties."""
        return self.believed.triangle.covariance

    @property
    def u(self) -> Array:
        """Standard uncertainties (p,) from the given ones."""
        return np.sqrt(np.diagonal(self.covariance))

    @property
    def birge(self) -> float:
        """Birge's ratio sqrt(chi2/freedom): about 1 where the given uncertainties explain the scatter.

        Without a degree of freedom there is none: nan.
        """
        return float(np.sqrt(self.chi2 / (self.freedom if self.freedom > 0 else np.nan)))

    @property
    def u_by_scatter(self) -> Array:
        """Standard uncertainties (p,) from the scatter of the residuals, to be used with t(freedom)."""
        return self.birge * self.u

    @property
    def correlation(self) -> Array:
        """Of the parameters (p, p)."""
        return self.covariance / np.multiply.outer(self.u, self.u)


@dataclass(frozen=True)
class _Point:
    """A place where the model has a value."""

    place: Array
    residuals: Array
    length: float
    tangent: Triangle

    @classmethod
    def of(cls, residuals: Function, jacobian: Function, place: Array, most: float = np.inf) -> _Point | None:
        """What is known at a place; nothing outside the domain, or where residuals are longer than `most`."""
        found = np.asarray(residuals(place), dtype=float)
        length = float(lengths(found))
        if not (np.isfinite(place).all() and np.isfinite(found).all() and length <= most):
            return None
        slopes = np.asarray(jacobian(place), dtype=float)
        return cls(place, found, length, Triangle.of(slopes, -found)) if np.isfinite(slopes).all() else None

    @property
    def near(self) -> bool:
        """Whether Bates and Watts would end here."""
        return self.tangent.full and self.tangent.inside <= 1e-3 * self.tangent.outside

    @property
    def stationary(self) -> bool:
        """Whether what lies in the tangent plane is beyond what rounding lets see."""
        seen = (EPS * len(self.residuals)) ** 0.5 * self.tangent.outside
        rounding = 4 * EPS * float(np.sum(np.abs(self.place) * self.tangent.scale))
        return bool(self.tangent.inside <= max(seen, rounding))

    def fit(self, ending: Ending, steps: int) -> Fitted:
        return Fitted(ending, self.place, self.residuals, self.tangent, steps)


@np.errstate(all="ignore")  # what is not finite is looked for
def least_squares(residuals: Function, jacobian: Function, start: Array) -> Fitted:
    """The parameters that make the sum of squared residuals least.

    Parameters
    ----------
    residuals : callable
        Of parameters (p,): the residuals (n,), each divided by its standard uncertainty where that is given.
        Where the model has no value, anything that is not finite: a step there is not taken.
    jacobian : callable
        Of the parameters for which residuals were asked last: their derivatives (n, p).
    start : array (p,)
        Where to begin. The first step is at most as long as this, counted by what it does to the residuals;
        from zeros, as long as these.

    Returns
    -------
    Fitted
        Also of a run that did not converge: its `ending` says why.

    Examples
    --------
    A straight line through (0, 1), (1, 3), (2, 4), (3, 8):

    >>> x, y = np.array([0.0, 1, 2, 3]), np.array([1.0, 3, 4, 8])
    >>> fit = least_squares(lambda b: b[0] + b[1] * x - y, lambda b: np.stack([x**0, x], 1), [0, 0])
    >>> fit.parameters.round(9), fit.freedom, round(fit.chi2, 9)
    (array([0.7, 2.2]), 2, 1.8)
    """
    start = np.array(start, dtype=float)
    here = _Point.of(residuals, jacobian, start)
    if here is None:
        nothing = np.asarray(residuals(start), dtype=float)
        return Fitted(Ending.OUTSIDE, start, nothing, Triangle.of(np.zeros((1, len(start))), np.zeros(1)), 0)
    weights = here.tangent.scale
    radius = float(lengths(weights * start))
    if radius < EPS**0.5 * here.length:
        radius = here.length
    for steps in range(STEPS):
        here = _polished(residuals, jacobian, here)
        if here.stationary:
            return here.fit(Ending.CONVERGED if here.tangent.full else Ending.SINGULAR, steps)
        weights = np.maximum(weights, here.tangent.scale)
        damping, step = _within(here.tangent, weights, radius)
        length = float(lengths(weights * step))
        if not length > EPS * max(float(lengths(weights * here.place)), EPS * here.length):
            return here.fit(Ending.STUCK, steps)
        there = _Point.of(residuals, jacobian, here.place + step, here.length)
        # What the sum of squares loses, in shares of it.
        moved, share = here.tangent.moved(step) / here.length, length / here.length
        foreseen = moved * moved + 2 * damping * share * share  # a power that is too large is an exception
        left = there.length / here.length if there else 1.0
        gain = (1 - left) * (1 + left)
        if gain < 0.25 * foreseen:
            radius = length / 4
        elif gain > 0.75 * foreseen or damping == 0:
            radius = 2 * length
        if there and gain > 1e-4 * foreseen:
            here = there
    return here.fit(Ending.UNFINISHED, STEPS)


def _within(tangent: Triangle, weights: Array, radius: float) -> tuple[float, Array]:
    """How much damping shortens a step to a radius, to a tenth, and the step; none if it is shorter without.

    Newton's steps for 1/length, which is nearly straight: they come from below.
    """
    damping = 0.0 if tangent.full else EPS
    for _ in range(ROUNDS):
        damped = tangent.damped(np.sqrt(damping) * weights) if damping else tangent
        step = damped.solved()
        length = float(lengths(weights * step))
        if not length > 1.1 * radius:
            break
        slope = damped.spread(weights * (weights * step / length))
        damping += (length / radius - 1) / slope / slope
    return damping, step


def _polished(residuals: Function, jacobian: Function, here: _Point) -> _Point:
    """Near the end: where undamped steps lead as long as they bring the residuals nearer to orthogonal.

    The sum of squares is flat there, and rounding hides whether it falls.
    """
    while here.near:
        there = _Point.of(residuals, jacobian, here.place + here.tangent.solved(), here.length * (1 + 1e-6))
        if there is None or there.tangent.inside >= 0.9 * here.tangent.inside:
            break
        here = there
    return here
