"""A point at which equations hold, sought by numbers.

What could not be solved is brought to zero from random points of the vocabulary's spans, by the shortest
steps that do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import mpmath
from sympy import Expr

from .arranged import Arranged, Sides, symbols_of
from .equation import Equation
from .evaluation import UNDEFINED, Tape, is_real
from .few_rows import Statement
from .proved import DIGITS
from .sampling import exact, magnitude
from .vocabulary import Vocabulary

_NUDGE = mpmath.mpf(10) ** -20
"""Relative step of the differences that a search takes for derivatives."""
_TRIES, _SEARCHES, _STEPS, _SLOW = 1000, 4, 15, 3
"""Points that are drawn, how many of them a search starts from, its steps, and how many may bring little."""
_LONGEST = 2
"""How far a step may go: in the logarithm of what is positive."""
_FARTHEST = mpmath.mpf(10) ** 9
"""How far a search may go: beyond all bounds any two sides look alike beside their other terms."""


@dataclass(frozen=True)
class Sought:
    """What came of a search."""

    point: Mapping[str, str] | None
    """Where everything holds; None if no point was found."""
    within: tuple[Statement, ...] = ()
    """Where none was found: as few of the statements as none was found for either, in their order."""


def seek(statements: Sequence[Statement], vocabulary: Vocabulary) -> Sought:
    """Look for a point at which everything holds.

    What did not hold at some point is tried alone, with all that it rests on, and is not solved in the next
    round: steps may lead to where it is positive and its conditions hold.

    `vocabulary`: where free symbols are drawn from, to begin with.
    """
    left_open: set[Equation] = set()
    tried: set[frozenset[Equation]] = set()
    within = tuple(statements)
    while True:
        arranged = Arranged(statements, vocabulary, left_open)
        point, blamed = _find(arranged)
        if point is not None:
            return Sought(point)
        for suspects in sorted(dict.fromkeys(map(arranged.behind, blamed)), key=len):
            alone = [statement for statement in statements if statement.source in suspects]
            if len(alone) < len(within) and suspects not in tried:
                tried.add(suspects)
                found = seek(alone, vocabulary)
                if found.point is None:
                    if are_impossible(found.within, vocabulary):
                        return found
                    within = found.within
        sources = {statement.source for statement in blamed}
        if sources <= left_open:
            return Sought(None, within if len(within) < len(statements) else _fewest(within, vocabulary))
        left_open |= sources


def _fewest(statements: tuple[Statement, ...], vocabulary: Vocabulary) -> tuple[Statement, ...]:
    """As few as no point was found for, of statements for which none was."""
    size = len(statements) // 2
    while size:
        for start in range(0, len(statements), size):
            found = seek(statements[:start] + statements[start + size :], vocabulary)
            if found.point is None:
                return found.within
        size //= 2
    return statements


def are_impossible(statements: Sequence[Statement], vocabulary: Vocabulary) -> bool:
    """Whether signs exclude every point of some statements, solved or with their inequalities as margins."""
    sources = {statement.source for statement in statements}
    return any(Arranged(statements, vocabulary, left).is_impossible() for left in ((), sources))


def _find(arranged: Arranged) -> tuple[dict[str, str] | None, list[Statement]]:
    """A point at which everything holds, or what did not where it was sought.

    What is broken at a point is drawn again with all that it rests on, and the rest is left alone.
    """
    blamed: dict[Statement, None] = {}
    with mpmath.workdps(DIGITS):
        whole = _Trial(arranged, arranged.open, arranged.space.symbols)
        searches = 0
        point: list[Any] = []
        for drawn in arranged.space.points("together", _TRIES):
            point = point or drawn
            broken = whole.broken(point)
            if broken is not None:
                statement, places = broken
                blamed[statement] = None
                point = [
                    new if n in places else old for n, (old, new) in enumerate(zip(point, drawn, strict=True))
                ]
                continue
            left = whole.unequal()
            trial = _Trial(arranged, left)
            found = trial.search(point) if left else point
            if found is not None and whole.broken(found) is None and not whole.unequal():
                return whole.describe(found), []
            blamed |= dict.fromkeys(e.of for e in left)
            searches += bool(trial.moved)
            if searches == _SEARCHES:
                break
            point = []
    return None, list(blamed)


class _Trial:
    """Some of the equations, what they rest on, and the steps that bring them to zero."""

    def __init__(self, arranged: Arranged, equations: Sequence[Sides], more: Iterable[Expr] = ()) -> None:
        self.space, self.equations = arranged.space, equations
        self.program = program = Tape(arranged.space.symbols)
        places = {symbol: n for n, symbol in enumerate(arranged.space.symbols)}

        def rests(symbols: Iterable[Expr]) -> list[int]:
            return [places[symbol] for symbol in arranged.below(symbols) if symbol in places]

        used = arranged.below(
            [*(s for e in equations for s in e.symbols), *(arranged.solved if more else ())]
        )
        self.moved = [n for n in rests(used) if not arranged.space.symbols[n].is_integer]
        self.solved = []
        for symbol in used:
            if symbol in arranged.solved:
                value, equation = arranged.solved[symbol]
                self.solved.append((symbol, program.define(symbol, value), equation.of, rests([symbol])))
        self.conditions = [
            (program.add([condition]), of, rests(symbols_of(condition)))
            for condition, of in (arranged.conditions if more else ())
        ]
        self.sides = [
            program.add([e.left, e.right, magnitude(e.left), magnitude(e.right)]) for e in equations
        ]

    def broken(self, point: list[Any]) -> tuple[Statement, list[int]] | None:
        """Begin at a point; the first statement that does not hold of itself, and what it rests on."""
        self.program.start(point)
        for symbol, slot, of, rests in self.solved:
            try:
                value = self.program.values(slot)
            except UNDEFINED:
                return of, rests
            if not is_real(value) or (symbol.is_positive and value <= 0):
                return of, rests
        for group, of, rests in self.conditions:
            try:
                if not all(self.program.values(group)):
                    return of, rests
            except UNDEFINED:
                return of, rests
        return None

    def residuals(self) -> list[Any]:
        """How far the equations are from holding, relative to their terms; NaN where one has no value."""
        return self._compared(lambda left, right, size: (left - right) / size if left != right else left * 0)

    def distances(self) -> list[Any]:
        """The same, by logarithms where both sides are positive: they still tell how far apart these are."""
        return self._compared(
            lambda left, right, size: (
                mpmath.log(left / right)
                if is_real(left) and is_real(right) and left > 0 < right
                else (left - right) / size
            )
        )

    def _compared(self, by: Callable[[Any, Any, Any], Any]) -> list[Any]:
        found = []
        for group in self.sides:
            try:
                left, right, *sizes = self.program.values(group)
                found.append(by(left, right, sum(map(abs, sizes))))
            except UNDEFINED:
                found.append(mpmath.nan)
        return found

    def unequal(self) -> list[Sides]:
        """The equations that do not hold where it stands."""
        pairs = zip(self.equations, self.residuals(), strict=True)
        return [equation for equation, residual in pairs if not abs(residual) <= exact(self.program)]

    def describe(self, point: list[Any]) -> dict[str, str]:
        """Where a point lies."""
        return self.space.describe(point, {s: self.program.values(slot) for s, slot, *_ in self.solved})

    def at(self, point: list[Any]) -> list[Any] | None:
        """The residuals at a point; None outside of the domain."""
        if self.broken(point) is not None:
            return None
        found = self.distances()
        return found if all(map(is_real, found)) else None

    def search(self, start: list[Any]) -> list[Any] | None:
        """Go from a point by the shortest steps that would satisfy the equations if they were linear."""
        if not self.moved:
            return None
        point, residuals, slow = start, self.at(start), 0
        for _ in range(_STEPS):
            if residuals is None or not self.unequal():
                break
            step = self._step(point, residuals)
            # The linear step may leave the domain, or go too far: it is halved until it brings something.
            for halvings in range(6):
                nearer = self._moved(point, {place: part / 2**halvings for place, part in step.items()})
                tried = self.at(nearer)
                if tried is not None and _norm(tried) < _norm(residuals):
                    break
            else:
                return None
            # A norm of squares that falls by less than half: near a root, Newton's falls by much more.
            slow += _norm(tried) > _norm(residuals) / 2
            point, residuals = nearer, tried
            if slow > _SLOW or not all(map(_is_near, point, start)):
                return None
        return point

    def _step(self, point: list[Any], residuals: list[Any]) -> dict[int, Any]:
        columns = []
        for place in self.moved:
            nudged = self.at(self._moved(point, {place: _NUDGE})) or residuals
            columns.append([(b - a) / _NUDGE for a, b in zip(residuals, nudged, strict=True)])
        jacobian = mpmath.matrix(columns).T
        square = jacobian * jacobian.T
        # The shortest of all steps that satisfy the linear equations J s = -r: s = J' (J J')^-1 (-r).
        # Equations that follow from others have no direction of their own.
        slack = _NUDGE * (1 + max(square[n, n] for n in range(len(residuals))))
        for n in range(len(residuals)):
            square[n, n] += slack
        step = jacobian.T * mpmath.lu_solve(square, -mpmath.matrix(residuals))
        return dict(zip(self.moved, step, strict=True))

    def _moved(self, point: list[Any], step: Mapping[int, Any]) -> list[Any]:
        """A point with some values moved: what is positive by a factor, all else by a term."""
        moved = list(point)
        for place, part in step.items():
            most = max(-_LONGEST, min(_LONGEST, part))
            grows = self.space.symbols[place].is_positive
            moved[place] = moved[place] * mpmath.exp(most) if grows else moved[place] + most
        return moved


def _is_near(value: Any, start: Any) -> bool:
    return bool(abs(value) < _FARTHEST * abs(start) and abs(start) < _FARTHEST * abs(value))


def _norm(residuals: list[Any]) -> Any:
    return mpmath.fsum(r * r for r in residuals)
