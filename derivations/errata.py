"""Checks of how a source prints its equations: each looks for one kind of slip and names its evidence.

Every function here returns a check; a check takes the ledger and returns an :class:`Erratum`, or None
where the print is right. What an erratum says is put together from what was found, never written by hand.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath
from sympy import And, Expr, Indexed, Piecewise, Symbol, lambdify, sstr

from . import symbols
from .equation import Equation, Erratum, Kind, Ledger
from .proof import DIGITS

__all__ = [
    "Check",
    "Citation",
    "check_citation",
    "check_count",
    "check_determined",
    "check_overlap",
    "check_range",
    "check_spurious",
    "check_whose",
]

Check = Callable[[Ledger], "Erratum | None"]
_TRIES = 400


@dataclass(frozen=True)
class Citation:
    """A place of the source that names an equation as the origin of a quantity."""

    where: str
    number: str
    quantity: Expr


def _sample(expressions: list[Any], seed: str) -> Any:
    """Yield seeded points of the symbols' spans with the expressions' values there."""
    flat = {
        cell: Symbol(f"{cell.base.label}_{cell.indices[0]}", **cell.base.label.assumptions0)
        for expression in expressions
        for cell in expression.atoms(Indexed)
    }
    plain = [expression.xreplace(flat) for expression in expressions]
    free = sorted({s for expression in plain for s in expression.free_symbols}, key=str)
    cells = {symbol: cell for cell, symbol in flat.items()}
    evaluate = lambdify(free, plain, modules="mpmath")
    rng = random.Random(seed)
    with mpmath.workdps(DIGITS):
        for _ in range(_TRIES):
            point = []
            for symbol in free:
                quantity = symbols.find(cells.get(symbol, symbol))
                low, high = (0.5, 2.0) if quantity is None else quantity.span
                point.append(mpmath.mpf(low) + mpmath.mpf(high - low) * mpmath.mpf(rng.random()))
            names = {str(cells.get(s, s)): mpmath.nstr(x, 4) for s, x in zip(free, point, strict=True)}
            yield names, evaluate(*point)


def _said(point: dict[str, str]) -> str:
    return ", ".join(f"{name} = {value}" for name, value in point.items())


def check_overlap(equation: Equation) -> Check:
    """Look for an approach at which two branches of a law both apply and differ."""

    def check(ledger: Ledger) -> Erratum | None:
        law = next(side for side in equation.members if isinstance(side, Piecewise))
        (first, when_first), (second, when_second) = law.args[:2]
        for point, (a, b, both) in _sample([first, second, And(when_first, when_second)], equation.label):
            if both and abs(a - b) > mpmath.mpf(10) ** (10 - DIGITS) * max(abs(a), abs(b)):
                return Erratum(
                    equation.label,
                    "overlapping branches",
                    f"The branches of {equation.label} overlap on [x_p, x_m]: without saying which phase is meant "
                    "the force has two values there.",
                    f"at {_said(point)} the branches give {mpmath.nstr(a, 4)} and {mpmath.nstr(b, 4)}",
                )
        return None

    return check


def check_range(
    equation: Equation, scale: int, symbol: Symbol, known: tuple[str, Any, Any]
) -> Check:
    """Compare a printed range with a published one of the same quantity times `scale`."""

    def check(ledger: Ledger) -> Erratum | None:
        low_side, high_side = equation.members[0].args
        low, high = scale * low_side.lhs, scale * high_side.rhs
        name, known_low, known_high = known
        if (low, high) == (known_low, known_high):
            return None
        quantity = high_side.lhs
        return Erratum(
            equation.label,
            "range",
            f"The range in {equation.label} is that of Meyer's exponent {symbol} = {scale} {quantity} in "
            f"[{low}, {high}]. {name} is [{known_low}, {known_high}], so {quantity} <= {known_high / scale}.",
            f"{symbol} = {scale} {quantity} at both ends of {equation.label}",
        )

    return check


def check_count(
    group: tuple[Equation, ...], unknowns: tuple[Expr, ...], claimed: tuple[Expr, Expr]
) -> Check:
    """Count equations and unknowns of a system written for k = 1, 2, ...; compare with what is said."""
    k = symbols.k

    def check(ledger: Ledger) -> Erratum | None:
        equations = len(group) * k
        present = [u for u in unknowns if any(side.has(u) for equation in group for side in equation.sides)]
        counted = sum(k if u.has(k) else 1 for u in present)
        if (equations - claimed[0], counted - claimed[1]) == (0, 0) and len(present) == len(unknowns):
            return None
        return Erratum(
            group[0].number,
            "count",
            f"{group[0].number} has {equations} equations and {counted} unknowns, "
            f"not {claimed[0]} and {claimed[1]} as is said.",
        )

    return check


def check_spurious(equation: Equation, solve_for: Expr, approach: Equation, condition: Expr) -> Check:
    """Look for a point where the equation holds but the approach it stands for is negative.

    `condition` is what must be positive and is not said to be.
    """

    def check(ledger: Ledger) -> Erratum | None:
        residual = equation.sides[0] - equation.sides[1]
        root = -residual.subs(solve_for, 0) / residual.diff(solve_for)
        put_in = {solve_for: root}
        for point, (value, depth, margin) in _sample(
            [root, approach.value.xreplace(put_in), condition], equation.label
        ):
            if value > 0 and depth < 0 and margin < 0:
                found = {**point, str(solve_for): mpmath.nstr(value, 4)}
                return Erratum(
                    equation.label,
                    "unstated condition",
                    f"{equation.label} also vanishes where {sstr(condition)} is negative. {approach.label} then gives "
                    f"a negative approach, so such a root belongs to no impact. The condition is not printed.",
                    f"at {_said(found)} {equation.label} holds and {approach.label} gives {mpmath.nstr(depth, 4)}",
                )
        return None

    return check


def check_determined(number: str, unknowns: tuple[Expr, ...]) -> Check:
    """Look whether the printed lines of a numbered group determine every unknown once."""

    def check(ledger: Ledger) -> Erratum | None:
        lines = [equation for equation in ledger.equations() if equation.number == number]
        left = [(line.printed or line.members)[0] for line in lines]
        missing = [u for u in unknowns if u not in left]
        twice = sorted({str(u) for u in left if left.count(u) > 1})
        if not missing:
            return None
        meant = [line.label for line in lines if line.defines in missing]
        return Erratum(
            number,
            "undetermined",
            f"{number} prints {', '.join(twice) or 'no line'} twice and never {', '.join(map(str, missing))}; "
            f"what is meant is {', '.join(meant)}.",
            f"left-hand sides as printed: {', '.join(map(str, left))}",
        )

    return check


def check_citation(citation: Citation) -> Check:
    """Look whether the equation that a place names contains the quantity that is said to come from it."""

    def check(ledger: Ledger) -> Erratum | None:
        lines = [equation for equation in ledger.equations() if equation.number == citation.number]
        if any(side.has(citation.quantity) for line in lines for side in line.sides):
            return None
        holders = [
            equation.label
            for equation in ledger.equations()
            if equation.kind is Kind.CLAIM
            and not equation.own
            and any(side.has(citation.quantity) for side in equation.sides)
        ]
        return Erratum(
            citation.where,
            "wrong number",
            f"{citation.where}: {citation.number} does not contain {citation.quantity}. "
            f"The claims that do are {' and '.join(holders)}.",
            f"symbols of {citation.number}: "
            + ", ".join(sorted({str(s) for line in lines for side in line.sides for s in side.free_symbols})),
        )

    return check


def check_whose(law: Equation, symbol: Symbol, where: str, said: str) -> Check:
    """Look which branch of the law holds a symbol that a passage attributes to the `said` phase."""
    phases = ("compression", "restitution")

    def check(ledger: Ledger) -> Erratum | None:
        branches = next(side for side in law.members if isinstance(side, Piecewise)).args
        holders = [phase for phase, (body, _) in zip(phases, branches, strict=False) if body.has(symbol)]
        if said in holders:
            return None
        return Erratum(
            where,
            "attribution",
            f"The {where} attribute the exponent that is found to the {said} phase. {symbol} occurs only in the "
            f"{' and '.join(holders)} branch of {law.label}.",
        )

    return check
