"""The probability that a quantity lies within its limits, and the decision (JCGM 106:2012, 7 and 8)."""

from __future__ import annotations

import math

import numpy as np

from ..distribution import DIVISORS, SHARES, Shape
from ..inputs.limits import Limits
from ..laws import Array, Law
from ..result.uncertain import Budget, Conformity, Decision


def beyond(z: float, shape: Shape, dof: float, law: Law | None = None) -> float:
    """The probability that an error is larger than z standard uncertainties.

    Parameters
    ----------
    shape : Shape
        That the budget assigns; a width is such that the standard uncertainty is 1, of Student's t the scale.
    dof : float
        Of Student's t.
    law : Law, optional
        Where the shape does not tell it whole.

    Examples
    --------
    >>> beyond(math.sqrt(3) / 2, Shape.RECTANGULAR, math.inf), round(beyond(1.4, Shape.NORMAL, math.inf), 4)
    (0.25, 0.0808)
    """
    return float(beyond_each(np.array([z]), shape, dof, law)[0])


def beyond_each(z: Array, shape: Shape, dof: float, law: Law | None) -> Array:
    """The same of many numbers: one by one they take four times as long."""
    if law is not None:
        # Beyond no limit lies nothing, whatever draws leave open.
        return np.array([float(each < 0) if math.isinf(each) else law.above(each) for each in z.tolist()])
    if shape in SHARES:
        inside = np.minimum(np.abs(z) / DIVISORS[shape], 1.0)
        share = np.array([SHARES[shape](each) for each in inside.tolist()])
        return np.where(z > 0, 1 - share, 1 + share) / 2
    if shape is Shape.NORMAL:
        return np.array([math.erfc(each) / 2 for each in (z / math.sqrt(2)).tolist()])
    from scipy.special import stdtr  # a quarter of a second, for those who have degrees of freedom

    return np.asarray(stdtr(dof, -z))


def past(budget: Budget, distance: float, side: int) -> float:
    """The probability that a quantity lies farther out than so far from its value, above it or, -1, below.

    NaN where the budget assigns no distribution.
    """
    if math.isnan(distance) or (math.isnan(budget.factor) and budget.u != 0):
        return math.nan
    z = distance / budget.u if budget.u else math.copysign(math.inf, distance)
    law = budget.law if side > 0 or budget.law is None else budget.law.turned()
    return beyond(z, budget.shape, budget.dof, law)


def conformity(budget: Budget, limits: Limits, by: Budget) -> Conformity:
    """A cell beside its limits.

    `budget`: of the cell, with U at the level of the rule. `by`: the same, with the distribution that tells
    probabilities.
    """
    (low, high), value = limits.ends, budget.value

    below, above = past(by, value - low, -1), past(by, high - value, 1)
    if below > 0.5:  # a difference of small ones, where that of 1 and nearly 1 would have lost its digits
        probability = past(by, low - value, 1) - above
    elif above > 0.5:
        probability = past(by, value - high, -1) - below
    else:
        probability = 1 - (below + above)
    rule = limits.guard
    share = float(rule.times) * budget.expanded if rule.times and budget.u else 0.0
    guard = share if rule.width is None else float(rule.width.value)
    guard = guard if math.isfinite(guard) else math.nan
    decision = _decided(value, (low, high), guard)
    return Conformity(budget, limits, guard, below, above, probability, decision, by)


def _decided(value: float, limits: tuple[float, float], guard: float) -> Decision:
    low, high = limits
    if value < low or value > high:
        return Decision.DOES_NOT
    return Decision.CONFORMS if low + guard <= value <= high - guard else Decision.NONE
