"""The numerical half of a proof: the claim is evaluated with 50 digits where its premises hold."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import mpmath
from sympy import Abs, Add, Expr, Indexed, Integral, Mul, Pow, Sum, Symbol

from .evaluation import UNDEFINED, Tape, is_real
from .proved import DIGITS, said
from .reductions import Greatest, OrderStatistic
from .space import SampledRows, Space, apart
from .system import Refused, System

POINTS = 20
"""How many seeded points of the domain every claim is evaluated at; fewer prove nothing."""
AGREES = mpmath.mpf(10) ** (10 - DIGITS)
"""Largest relative residual that counts as zero: ten guard digits for the arithmetic in between."""
DETERMINES = mpmath.mpf(10) ** (-DIGITS // 2)
"""Smallest relative divisor that counts as not zero."""
_ROUNDING = mpmath.mpf(10) ** -3
"""How much less a difference is with twice as many digits if it is rounding; any other stays what it is."""
_TRIES, _UNDEFINED = 60 * POINTS, 5 * POINTS
"""How many points are drawn, and after how many without a value none is looked for that refutes."""


def exact(program: Tape) -> Any:
    """The residual up to which sides may be equal, for all that is known at the point."""
    return max(AGREES, 1000 * program.blur)


@dataclass(frozen=True)
class Outcome:
    """What the numbers say of a claim: a counterexample, or how many points agree how well."""

    points: int
    worst: float
    counterexample: Mapping[str, str] | None = None
    sides: tuple[str, str] = ("", "")


class _Trial:
    """The operations of one step, and how to judge them at a point."""

    def __init__(self, system: System) -> None:
        self.unknowns = [unknown for unknown, _ in system.chain]
        self.space = Space(system.expressions, system.names, system.vocabulary, self.unknowns)
        self.labels = [label for label, _, _ in system.premises]
        self.program = program = Tape(self.space.symbols)
        self.rows = [self._row(unknown) for unknown in self.unknowns]
        self.found = [program.define(unknown, solved.value) for unknown, solved in system.chain]
        self.powers = program.add(power for _, solved in system.chain for power in solved.powers)
        self.conditions = program.add(system.conditions)
        pivots = [pivot for _, solved in system.chain for pivot in solved.pivots]
        self.pivots = list(map(self.add, pivots))
        self.premises = [(self.add(left), self.add(right)) for _, left, right in system.premises]
        self.claim = list(map(self.add, system.claim))
        self.multiplied = None if system.multiplied is None else list(map(self.add, system.multiplied))
        self.magnitudes: dict[Expr, Any] = {}

    def add(self, side: Expr) -> tuple[Expr, Any]:
        """An expression, and the group that computes it."""
        return side, self.program.add([side])

    def _row(self, unknown: Expr) -> tuple[int, Any] | None:
        """Where an eliminated cell stands in its column: the column's place in a point, and the row."""
        if not isinstance(unknown, Indexed):
            return None
        return self.space.symbols.index(unknown.base.label), self.program.add([unknown.indices[0]])

    def value(self, side: tuple[Expr, Any]) -> Any:
        return self.program.values(side[1])[0]

    def size(self, *sides: tuple[Expr, Any]) -> Any:
        """What rounding errors of the sides are small against; computed only where it is asked for."""
        for side, _ in sides:
            if side not in self.magnitudes:
                self.magnitudes[side] = self.program.add([magnitude(side)])
        return max(abs(self.program.values(self.magnitudes[side])[0]) for side, _ in sides)

    def gap(self, *sides: tuple[Expr, Any]) -> Iterator[tuple[Any, Any, Any]]:
        """Neighbouring sides and their relative difference."""
        values = [self.value(side) for side in sides]
        size = max(map(abs, values))
        # `not <=` so that a NaN disagrees.
        if any(not abs(a - b) <= AGREES * size for a, b in pairwise(values)):
            size = self.size(*sides)  # a sum that cancels is small against its terms
        for a, b in pairwise(values):
            yield a, b, abs(a - b) / size if size else mpmath.mpf(0)

    def lies_in_domain(self, point: list[Any]) -> bool:
        """Begin at a point; whether the premises have a positive solution there and the conditions hold."""
        self.program.start(point)
        for unknown, group, row in zip(self.unknowns, self.found, self.rows, strict=True):
            value = self.program.values(group)
            if not is_real(value) or (unknown.is_positive and value <= 0):
                return False
            if row is not None:  # it is one of the data that a sum runs over
                place, number = row
                point[place].known[int(self.program.values(number)[0])] = value
        powers = self.program.values(self.powers)
        return all(is_real(power) and power > 0 for power in powers) and all(
            self.program.values(self.conditions)
        )

    def check_premises(self) -> None:
        """The solution must be one, and the only one."""
        for pivot in self.pivots:
            if not abs(self.value(pivot)) > DETERMINES * self.size(pivot):
                raise Refused("a premise does not determine what it is solved for")
        for label, (left, right) in zip(self.labels, self.premises, strict=True):
            if any(not residual <= exact(self.program) for _, _, residual in self.gap(left, right)):
                raise Refused(f"what {label} was solved for does not satisfy it")

    def residuals(self) -> Iterator[tuple[Any, Any, Any]]:
        """Neighbouring sides of the claim and their relative difference."""
        if self.multiplied is None:
            yield from self.gap(*self.claim)
            return
        multiple, size = self.multiple()
        difference = self.value(self.claim[0]) - self.value(self.claim[1])
        yield difference, multiple, abs(difference - multiple) / max(size, self.size(*self.claim))

    def multiple(self) -> tuple[Any, Any]:
        """The unsolved premise times its factor, and the size of its terms."""
        assert self.multiplied is not None
        factor, left, right = self.multiplied
        scale = self.value(factor)
        return scale * (self.value(left) - self.value(right)), abs(scale) * self.size(left, right)

    def describe(self, point: list[Any]) -> dict[str, str]:
        solved = {u: self.program.values(group) for u, group in zip(self.unknowns, self.found, strict=True)}
        return self.space.describe(point, solved)


class _Finer:
    """The same step with twice as many digits, where these decide: a square root leaves half of them."""

    def __init__(self, system: System) -> None:
        self.system = system

    @cached_property
    def trial(self) -> _Trial:
        """With numbers of a program, 1/3 say, of as many digits."""
        return _Trial(self.system)

    def is_rounding(self, point: list[Any], found: list[tuple[Any, Any, Any]]) -> bool:
        """Whether nothing but rounding keeps sides from being real and equal at a point."""

        def vanishes(old: Any, new: Any) -> bool:
            return bool(abs(new) <= _ROUNDING * abs(old))

        with mpmath.workdps(2 * DIGITS):
            try:
                if not self.trial.lies_in_domain(point):
                    return True  # nor is it more that tells whether this lies in the domain
                again = list(self.trial.residuals())
            except UNDEFINED:
                return False
            return all(
                (residual <= AGREES or vanishes(a - b, c - d))
                and all(vanishes(mpmath.im(old), mpmath.im(new)) for old, new in ((a, c), (b, d)))
                for (a, b, residual), (c, d, _) in zip(found, again, strict=True)
            )


def magnitude(expression: Any) -> Any:
    """The expression with every term taken positive: its rounding errors are small against this."""
    match expression:
        case Add() | Mul():
            return expression.func(*map(magnitude, expression.args), evaluate=False)
        case Integral():
            return Abs(Integral(magnitude(expression.function), *expression.limits), evaluate=False)
        case Sum() | OrderStatistic():
            # What is taken by order is off by no more than the term that is off most.
            kind = Sum if isinstance(expression, Sum) else Greatest
            return kind(magnitude(expression.function), *expression.limits)
        case Pow() if expression.exp.is_Integer and expression.exp.is_positive:
            return Pow(magnitude(expression.base), expression.exp, evaluate=False)
        case Symbol() | Indexed() if expression.is_positive:
            return expression
    return Abs(expression, evaluate=False)


def examine(system: System, seed: str) -> Outcome:
    """Evaluate a claim at seeded points where its premises hold, until one disagrees.

    Raises
    ------
    Refused
        Where the points cannot decide: too few of them, a premise that its solution does not satisfy, or a
        claim that is not real.
    """
    with mpmath.workdps(DIGITS):
        trial, finer = _Trial(system), _Finer(system)
        counted, unlike, worst = 0, 0, mpmath.mpf(0)
        undefined: list[dict[str, str]] = []
        for point in trial.space.points(seed, _TRIES):
            try:
                if not trial.lies_in_domain(point):
                    continue
            except UNDEFINED:
                continue
            try:
                trial.check_premises()
                found = list(trial.residuals())
            except UNDEFINED:
                found = [(mpmath.nan,) * 3]
            finite = all(mpmath.isfinite(side) for pair in found for side in pair[:2])
            if not finite or any(AGREES < residual <= exact(trial.program) for _, _, residual in found):
                undefined.append(trial.describe(point))
                if len(undefined) > _UNDEFINED:
                    break
                continue
            doubtful = any(residual > AGREES or not (is_real(a) and is_real(b)) for a, b, residual in found)
            if doubtful and finer.is_rounding(point, found):
                continue
            for a, b, residual in found:
                if not residual <= AGREES:  # also where it is not a number
                    if trial.multiplied is not None:
                        unlike += 1
                        if (witness := _witness(trial, point, counted)) is not None:
                            return witness
                        break
                    return Outcome(counted, float(residual), trial.describe(point), apart(a, b))
                if not (is_real(a) and is_real(b)):
                    raise Refused(f"its sides are not real at {said(trial.describe(point))}")
                worst = max(worst, residual)
            counted += not unlike
            if POINTS in (counted, unlike):
                break
    if unlike:
        raise Refused("the premise times the factor is not the claim")
    if undefined:
        raise Refused(f"it has no value at {said(undefined[0])}" if undefined[0] else "it has no value")
    if counted == POINTS:
        return Outcome(counted, float(worst))
    raise Refused(
        f"only {counted} points of its domain were found"
        if counted
        else "no point satisfies its premises and conditions"
    )


def _witness(trial: _Trial, point: list[Any], counted: int) -> Outcome | None:
    """Where a premise is not solved: move one value until it holds, and look at the claim there."""
    # The first places of a point are the sizes of its columns, which are whole and cannot be moved.
    for place in range(len(trial.space.sizes), len(point)):
        moved = _solved_for(trial, point, place)
        if moved is None:
            continue
        ((*sides, residual),) = trial.gap(*trial.claim)
        if not residual <= AGREES:
            return Outcome(counted, float(residual), trial.describe(moved), apart(sides[0], sides[1]))
    return None


def _solved_for(trial: _Trial, point: list[Any], place: int) -> list[Any] | None:
    """The point with one value (of a column, its first term) moved by secants to where the premise holds."""
    steps: list[tuple[Any, Any]] = []
    for _ in range(40):
        if len(steps) < 2:
            scale = mpmath.mpf(1) + mpmath.mpf(len(steps)) / 8
        else:
            (s, f), (t, g) = steps[-2:]
            if f == g:
                return None
            scale = t - g * (t - s) / (g - f)
        old = point[place]
        new = old.with_row(1, old[1] * scale) if isinstance(old, SampledRows) else old * scale
        moved = [*point[:place], new, *point[place + 1 :]]
        try:
            if not scale > 0 or not trial.lies_in_domain(moved):
                return None
            multiple, size = trial.multiple()
        except UNDEFINED:
            return None
        if abs(multiple) <= AGREES * size:
            return moved
        steps.append((scale, multiple))
    return None
