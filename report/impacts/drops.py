"""What a campaign says to simulations: restitution and imprint over speed, and the identified law."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from sympy import Expr, Float, Piecewise

from ...derivations import soft_impact as paper
from ...derivations.algebra import solve_for
from ...derivations.symbols import k
from .law import ForceLaw, x, x_max


@dataclass(frozen=True)
class Drop:
    """An impact at one speed, in SI; NaN is what is not known."""

    speed: float
    e: float
    x_p: float
    x_m: float


@dataclass(frozen=True)
class Drops:
    """Measured impacts of one ball on one target, in SI."""

    mass: float
    """The reduced mass."""
    v: tuple[float, ...]
    e: tuple[float, ...]
    x_p: tuple[float, ...]
    """`v`, `e` and `x_p`: impact speed, restitution and imprint of each test; NaN where one is missing."""
    alpha: float = math.nan
    C: float = math.nan
    beta: float = math.nan
    """`alpha`, `C` and `beta`: the identified law (3): its loading curve and the exponent of unloading; NaN
    where there is none."""
    radius: float = math.nan
    """The effective one; NaN if it is not known."""
    flat: bool = True
    """Whether that is the radius of the ball."""
    nu: float = math.nan
    """Poisson's ratio of the ball; NaN if it is not known."""

    @cached_property
    def tests(self) -> tuple[Drop, ...]:
        """The tests whose speed and restitution are known, by speed; of one speed their mean."""
        rows = zip(self.v, self.e, self.x_p, strict=True)
        known = [row for row in rows if not _lacks(row[0], row[1])]
        found = []
        for speed in sorted({row[0] for row in known}):
            alike = np.array([row for row in known if row[0] == speed])
            depths = alike[np.isfinite(alike[:, 2]), 2]
            depth = float(depths.mean()) if depths.size else math.nan
            found.append(Drop(speed, float(alike[:, 1].mean()), depth, self.depth(speed)))
        return tuple(found)

    @property
    def aside(self) -> tuple[tuple[int, str], ...]:
        """The rows that are no tests for a simulation, from 0, and why."""
        found = enumerate(map(_lacks, self.v, self.e))
        return tuple((row, why) for row, why in found if why)

    @property
    def averaged(self) -> tuple[tuple[int, ...], ...]:
        """The rows, from 0, of the tests at one speed: those of each speed that several have."""
        aside = dict(self.aside)
        rows = [row for row in range(len(self.v)) if row not in aside]
        alike = (tuple(row for row in rows if self.v[row] == test.speed) for test in self.tests)
        return tuple(each for each in alike if len(each) > 1)

    @property
    def middle(self) -> Drop:
        """The test in the middle of the speeds: the slower of two."""
        return self.tests[(len(self.tests) - 1) // 2]

    @property
    def has_curve(self) -> bool:
        """Whether the loading curve is known."""
        return math.isfinite(self.alpha * self.C)

    def depth(self, speed: float) -> float:
        """The greatest approach on the identified curve, by (L3); NaN where there is none."""
        if not self.has_curve:
            return math.nan
        given = {paper.alpha: self.alpha, paper.C: self.C, paper.m_red: self.mass, paper.v: speed}
        return float(paper.x_m_of_test.value.subs(given))

    def at(self, speed: float) -> Drop | None:
        """An impact at a speed: a power law between its neighbours; None outside of what was measured."""
        tests = self.tests
        if not tests or not tests[0].speed <= speed <= tests[-1].speed:
            return None
        exact = next((test for test in tests if test.speed == speed), None)
        if exact is not None:
            return exact
        at, speeds = math.log(speed), [math.log(test.speed) for test in tests]
        e, x_p = (
            math.exp(float(np.interp(at, speeds, [math.log(value) for value in values])))
            for values in ([test.e for test in tests], [test.x_p for test in tests])
        )
        return Drop(speed, e, x_p, self.depth(speed))

    def law(self) -> ForceLaw:
        """The identified law (3) as a force law for any turning point.

        The imprint that belongs to a greatest approach follows from the restitution; its share of that is
        interpolated between the tests and kept beyond them: so every test returns what was measured.
        """
        given = ((paper.C, self.C), (paper.alpha, self.alpha), (paper.beta, self.beta))
        numbers: dict[Expr, Expr] = {symbol: _number(value) for symbol, value in given}
        share = _imprint_share()
        knots = [(test.x_m, float(share.subs({**numbers, paper.e: test.e}))) for test in self.tests]
        back = paper.law_r.value.xreplace({paper.Cprime: paper.eq9.sides[0]}).xreplace({paper.x_m: x_max})
        loading, back = (part.xreplace({paper.x: x, **numbers}) for part in (paper.law_c.value, back))
        return ForceLaw("law (3)", loading, back, paper.x_p, where=((paper.x_p, x_max * _between(knots)),))


def _lacks(speed: float, e: float) -> str:
    """Why a contact cannot be held to an impact; empty if it can."""
    if math.isnan(speed + e):
        return "no speed or no restitution"
    if not e < 1:
        return f"e = {e:g}, nothing is lost"
    return "" if e > 0 else "e = 0, nothing comes back"


def _imprint_share() -> Expr:
    """The imprint over the greatest approach, by the energy ratio of a test."""
    one = paper.ratio.at({paper.XM[k]: paper.x_m, paper.XP[k]: paper.x_p, paper.E[k]: paper.e})
    solved = solve_for(paper.x_p, *one.sides)
    assert solved is not None
    return (solved.value / paper.x_m).expand()


def _number(value: float) -> Expr:
    return Float(repr(value), 17)


def _between(knots: list[tuple[float, float]]) -> Expr:
    """A function of the greatest approach: straight between the knots, constant beyond."""
    points = [(_number(place), _number(value)) for place, value in knots]
    cases: list[tuple[Expr, Expr | bool]] = [(points[0][1], x_max <= points[0][0])]
    for (a, low), (b, high) in pairwise(points):
        cases.append((low + (high - low) / (b - a) * (x_max - a), x_max <= b))
    return Piecewise(*cases, (points[-1][1], True)) if len(points) > 1 else points[0][1]
