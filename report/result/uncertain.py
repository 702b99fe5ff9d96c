"""What is known of the uncertainty of cells: where it comes from, cell by cell."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING

from ..distribution import Shape
from .numbers import degrees_of_freedom, rounded

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ..inputs.limits import Limits
    from ..inputs.taken import Origin
    from ..laws import Law

TOLERANCE = 1e-3
"""An eigenvalue that is a smaller part of the largest one tells nothing of its own."""


COUNTS = 0.05
"""Terms of second order count from this share of the variance of first order on."""
COUNT, UNLOOKED = "second order counts", "second order was not looked at"
"""Why an expanded uncertainty may not hold."""


@dataclass(frozen=True)
class ErrorSource:
    """One error that is independent of all others, unless a correlation says otherwise."""

    name: str
    """The address of the cell it is an error of, or the name of what cells share."""
    shape: Shape
    dof: float
    """Degrees of freedom; infinite where its standard uncertainty is known."""
    moves: tuple[tuple[str, int, float], ...]
    """Columns and rows that it is an error of, and what a standard uncertainty moves each by, in SI."""
    said: str = ""
    """How it was stated; empty if it follows from printed digits."""
    sample: str = ""
    law: Law | None = None
    """`sample` and `law`: as of :class:`~loopsheet.report.distribution.Error`."""
    origin: Origin | None = None
    """What it is in the report that stated it, where that is another one."""

    @property
    def u(self) -> float | None:
        """Its standard uncertainty in SI; None if it is larger in one cell than in another."""
        sizes = {abs(u) for _, _, u in self.moves}
        return sizes.pop() if len(sizes) == 1 else None

    @property
    def table(self) -> str:
        """The table of draws that it is of; empty if there is none."""
        return self.law.table if self.law else ""


@dataclass(frozen=True)
class Contribution:
    """What one source does to a cell."""

    source: ErrorSource
    estimate: float | None
    """The value it is an error of, in SI; None if there are several."""
    unit: str
    """The SI unit of estimate and uncertainty."""
    u: float
    """To first order, with the sign of the sensitivity, in the SI unit of the cell."""
    share: float
    """Of the variance of the cell; all of them together are 1. With correlations it may be negative."""

    @property
    def sensitivity(self) -> float | None:
        """How much the cell changes with it, in SI."""
        return self.u / self.source.u if self.source.u else None


@dataclass(frozen=True)
class Together:
    """How much the cells of a column that is summed tell together: they may rest on the same errors."""

    name: str
    """Of the column."""
    eigenvalues: tuple[float, ...]
    """Of the correlation matrix of its cells, the largest first; that many ones if all are independent."""

    @property
    def rank(self) -> int:
        """How many eigenvalues there are beside which the others are nothing."""
        return sum(value > TOLERANCE * self.eigenvalues[0] for value in self.eigenvalues)


@dataclass(frozen=True)
class Scattered:
    """How uncertain a fitted number is by how far the rows lie off the curve: u times Birge's ratio."""

    u: float
    """In SI."""
    dof: int
    """Degrees of freedom: the squares that were summed less what was fitted."""
    factor: float
    """Coverage factor, of Student's t."""

    @property
    def expanded(self) -> float:
        """The expanded uncertainty, in SI."""
        return self.factor * self.u


@dataclass(frozen=True)
class Budget:
    """The uncertainty of one cell and where it comes from (JCGM 100, 5 and annex H)."""

    cell: str
    """Its address."""
    name: str
    label: tuple[int, ...]
    """`name` and `label`: its column, and the label of its row."""
    value: float
    u: float = math.nan
    """`value` and `u`: in SI; `u` is the combined standard uncertainty, NaN where nothing is known of it."""
    contributions: tuple[Contribution, ...] = ()
    """The largest first; what does nothing is left out."""
    correlations: Mapping[tuple[str, str], float] = field(default_factory=dict)
    """By (str, str); between these sources."""
    dof: float = math.nan
    """Effective degrees of freedom by the formula of Welch and Satterthwaite, rounded to two decimals, then
    truncated; NaN where correlated sources have a finite number."""
    level: float = math.nan
    """Coverage probability."""
    factor: float = math.nan
    """Coverage factor; NaN where there are no degrees of freedom."""
    because: str = ""
    """What the coverage factor was taken from, or why there is none."""
    second: float = 0.0
    """The part of the variance that is of second order, in the square of the cell's SI unit; 0 where first
    order is enough."""
    unlooked: str = ""
    """Why nothing is known of second order; empty if it was looked at."""
    shape: Shape = Shape.NORMAL
    """The distribution that is assigned to it: normal, Student's t, that of the sum of its errors, or that of
    a source which dominates."""
    law: Law | None = None
    """As of :class:`~loopsheet.report.distribution.Error`: of what the quantity is more than the value."""
    summed: tuple[Together, ...] = ()
    """Columns over pairs of rows that the cell sums: pairs share their rows."""
    draws: int = 0
    """So many told its distribution and the coverage factor; 0 where the errors' own did."""
    least: float = -math.inf
    """What the quantity cannot fall below, in SI."""
    idle: tuple[Contribution, ...] = ()
    """The other sources, which do nothing at these values."""
    tied: Mapping[tuple[str, str], float] = field(default_factory=dict)
    """By (str, str); correlations with these."""
    little: float = 0.0
    """What second order makes of the variance, in the unit of `second`, where that is too little to count."""

    @property
    def estimates(self) -> list[list[Contribution]]:
        """The contributions, those of one estimate together, as of readings; the largest sum first."""
        found: dict[str, list[Contribution]] = {}
        for each in self.contributions:
            found.setdefault(each.source.sample or f"{each.source.name} alone", []).append(each)
        return sorted(found.values(), key=lambda own: -abs(sum(each.share for each in own)))

    @property
    def fails(self) -> bool:
        """Whether first order plainly fails: second order makes more of the variance, or U leads too low."""
        if not self.of_second_order:
            return False
        return abs(self.second) > self.u**2 - self.second or self.value - self.expanded < self.least

    @property
    def of_second_order(self) -> bool:
        """Whether terms of second order count, or nobody knows."""
        return self.is_known and self.u > 0 and bool(self.second or self.unlooked)

    @property
    def hold(self) -> str:
        """How far the expanded uncertainty is to be believed where terms of second order are not nothing."""
        return "U does not hold" if self.fails else "U may not hold"

    @property
    def doubt(self) -> str:
        """That, with its reason; nothing where first order is enough, nor of a cell without a value."""
        if math.isnan(self.value):
            return ""
        if not self.is_known:
            return f"U is not known: {self.unlooked}" if self.unlooked else ""
        if math.isnan(self.factor):
            return f"U is not known: {self.because}"
        if not self.of_second_order:
            return ""
        return f"{self.hold}: {COUNT if self.second else UNLOOKED}"

    @property
    def asks_for_draws(self) -> bool:
        """Whether only draws tell an interval: first order plainly fails, or tells nothing."""
        return self.fails or not self.is_known

    @property
    def advice(self) -> str:
        """The doubt for where the number stands, and what to use instead where first order plainly fails."""
        return (
            f"{self.doubt}; use '{draws_of(self.cell)}'" if self.doubt and self.asks_for_draws else self.doubt
        )

    @property
    def expanded(self) -> float:
        """The expanded uncertainty, in SI."""
        return self.factor * self.u

    @property
    def is_known(self) -> bool:
        """Whether there is a standard uncertainty, even if it is 0."""
        return math.isfinite(self.u)


def draws_of(cell: str) -> str:
    """The command that draws what a cell rests on."""
    return f"loopsheet budget {cell} --draws 1000000"


@dataclass(frozen=True)
class Distributed:
    """The distribution of one cell by Monte Carlo (JCGM 101), and how the law of propagation fits it."""

    number: int
    lost: int
    """`number` and `lost`: draws, and those of them without a value, or with sums over other rows than those
    of the estimate: all else is of the others."""
    median: float
    mean: float
    u: float
    """`median`, `mean` and `u`: in SI; mean and standard uncertainty are NaN where the tails are too
    heavy."""
    symmetric: tuple[float, float]
    shortest: tuple[float, float]
    """`symmetric` and `shortest`: the ends of the intervals with equal tails and of least width, at the level
    of the budget; NaN where too many draws have no value."""
    tail: float
    """The tail index; infinite where the tails end or fall faster than any power."""
    tolerance: float
    """To which the interval was asked for: half a unit of the second digit of the standard uncertainty."""
    stable: bool
    """Whether it is known to that."""
    differences: tuple[float, float]
    """Of both ends of the interval with equal tails from those by the law of propagation."""

    @property
    def validates(self) -> bool:
        """Whether the law of propagation gives the same interval within the tolerance (JCGM 101, 8)."""
        return max(self.differences) <= self.tolerance


class Decision(StrEnum):
    """What the rule decides."""

    CONFORMS = "conforms"
    DOES_NOT = "does not conform"
    NONE = "no decision"


MORE_LIKELY = 0.505
"""A specific risk from here on is more than an even one, which a value has that lies on a limit."""


@dataclass(frozen=True)
class Conformity:
    """A cell beside its limits."""

    budget: Budget
    """Its uncertainty, with U at the level of the rule."""
    limits: Limits
    guard: float
    """The width of the guard band in SI; NaN where it is a share of a U that is not known."""
    below: float
    above: float
    """`below` and `above`: the probabilities that the quantity lies outside of its tolerance limits; NaN
    where the budget assigns no distribution."""
    probability: float
    """That it lies within them: the conformance probability (JCGM 106, 3.3.7)."""
    decision: Decision
    by: Budget
    """With the distribution of these probabilities: of draws, where the cell bends on its way to a limit."""

    @property
    def acceptance(self) -> tuple[float, float]:
        """The acceptance limits in SI: the tolerance limits, drawn in by the guard band."""
        low, high = self.limits.ends
        return low + self.guard, high - self.guard

    @property
    def consumer_risk(self) -> float | None:
        """The specific consumer's risk: that what was accepted does not conform (JCGM 106, 9.3.2)."""
        return self.below + self.above if self.decision is Decision.CONFORMS else None

    @property
    def producer_risk(self) -> float | None:
        """The specific producer's risk: that what was rejected conforms (JCGM 106, 9.3.3)."""
        return self.probability if self.decision is Decision.DOES_NOT else None

    @property
    def improbable(self) -> bool:
        """Whether it conforms by the rule, which asks for no uncertainty, and more likely does not."""
        return self.decision is Decision.CONFORMS and self.below + self.above > MORE_LIKELY

    @property
    def because(self) -> str:
        """Why it is decided so."""
        if self.improbable:
            return (
                "it lies within the acceptance limits, but its uncertainty is so large that it is more "
                "likely outside of the tolerance limits"
            )
        if self.decision is Decision.CONFORMS:
            return "it lies within the acceptance limits"
        if self.decision is Decision.DOES_NOT:
            return "it lies outside of the tolerance limits"
        if math.isnan(self.budget.value):
            return "it has no value"
        if math.isnan(self.guard):
            why = self.budget.because or self.budget.unlooked or "nothing is known of the uncertainty"
            return f"the guard band is not known: {why}"
        low, high = self.acceptance
        return "the guard bands meet: no value is accepted" if low > high else "it lies in the guard band"


@dataclass(frozen=True)
class Influence:
    """What every source does to some cells, for reports that take their values."""

    sources: tuple[ErrorSource, ...]
    cells: Mapping[str, Sequence[float]]
    """By the address of a cell, what a standard uncertainty of each source moves it by, in SI."""
    rows: Mapping[str, Sequence[tuple[int, float]]]
    """By the address of a cell of many: the places of the sources that move it, and by how much."""
    second: Mapping[str, float]
    """The standard uncertainty that terms of second order add, where they count."""
    correlations: tuple[tuple[int, int, float], ...]
    """Places of two sources, and their coefficient."""
    doubts: Mapping[str, str]
    """Why an expanded uncertainty may not hold, of the cells of which it may not."""


@dataclass(frozen=True)
class Misfit:
    """What residuals from a curve or a mean come to beside standard uncertainties known before."""

    chi2: float
    """The least sum of squares of errors, each over its standard uncertainty, that make these residuals."""
    dof: int
    """Its degrees of freedom: the rows less what was fitted to them."""
    known_by: float
    """The degrees of freedom of the standard uncertainties themselves, the least of all rows; infinite where
    they are known."""
    is_stated: bool
    """Whether any of them was stated; else they follow from printed digits alone."""

    @property
    def birge(self) -> float:
        """How many times too small the standard uncertainties are, if the model is right (Birge's ratio)."""
        return math.sqrt(self.chi2 / self.dof)

    @property
    def said(self) -> str:
        """What they come to, in words."""
        return f"chi2 = {rounded(self.chi2, 3).plain} on {degrees_of_freedom(self.dof)}"


@dataclass(frozen=True)
class Uncertainties:
    """The standard uncertainty of every cell, and the budgets of the result."""

    u: Mapping[str, NDArray[np.float64]]
    """Of shape (rows,), by column name; in SI; NaN where a cell has no value, and where nothing is known."""
    budgets: tuple[Budget, ...] = ()
    """Of the cells of the headline."""
    conformities: tuple[Conformity, ...] = ()
    """Of the cells that have limits."""
    influence: Influence | None = None
    """On those cells and all scalars."""
    second: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)
    """Of shape (rows,), by column; the variance that terms of second order make; 0 if they do not count."""
    misfits: Mapping[str, Misfit] = field(default_factory=dict)
    """Of the workbook's curves and means, by the cells of their sums of squares or their own; those that are
    known."""
    rough: Mapping[str, bool] = field(default_factory=dict)
    """Columns of which derivatives jump: where rows change places (true), or at corners of a function."""
    unresolved: Mapping[tuple[str, int], float] = field(default_factory=dict)
    """What the digits of paired readings leave of cells of the headline (column, row), in SI, where these
    scatter by far less."""

    @property
    def advice(self) -> dict[str, str]:
        """Of which cells of the headline U may not hold, and why."""
        return {each.cell: each.advice for each in self.budgets if each.advice}
