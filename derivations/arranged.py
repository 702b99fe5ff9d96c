"""Equations arranged to be satisfied: each solved for one of its symbols, so long as none rests on itself."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

from sympy import Expr, Rel, Symbol, factor

from .algebra import definite, solve_for
from .equation import Equation
from .few_rows import FewRows, Statement
from .space import Space
from .vocabulary import Vocabulary


@dataclass(frozen=True)
class Sides:
    """Two sides, and the statement that says they are equal."""

    left: Expr
    right: Expr
    of: Statement

    @property
    def sides(self) -> tuple[Expr, Expr]:
        """Both of them."""
        return self.left, self.right

    @cached_property
    def symbols(self) -> tuple[Expr, ...]:
        """What it is about."""
        return tuple(sorted(self.left.free_symbols | self.right.free_symbols, key=str))


class Arranged:
    """Equations, each solved for one symbol where that can be, and points at which all may hold.

    `vocabulary`: where free symbols are drawn from. `left_open`: what is not to be solved; inequalities of
    these are written with what remains, a > b as a = b + t.
    """

    def __init__(
        self,
        statements: Sequence[Statement],
        vocabulary: Vocabulary,
        left_open: Collection[Equation] = (),
    ) -> None:
        plain = FewRows(statements)
        equations = [Sides(*pair, s) for s in plain.statements for pair in pairwise(s.sides)]
        self.sizes = plain.sizes
        self.solved: dict[Expr, tuple[Expr, Sides]] = {}
        # What says of a symbol what it is is solved for that; whatever is left, for anything that it holds.
        waiting = [e for e in equations if e.of.source in left_open or not self._solve(e, (e.left, e.right))]
        self.open = [
            e for e in waiting if e.of.source in left_open or not self._solve(e, (*e.of.hints, *e.symbols))
        ]
        self.conditions = [(condition, s) for s in plain.statements for condition in s.conditions]
        for condition, of in self.conditions:
            if of.source in left_open and (margin := _margin(condition, of, len(equations))) is not None:
                self._solve(margin, margin.symbols)
                equations.append(margin)
        parts = [*(condition for condition, _ in self.conditions), *(s for e in equations for s in e.sides)]
        self.space = Space(parts, plain.names, vocabulary, self.solved)

    def _solve(self, equation: Sides, symbols: Iterable[Expr]) -> bool:
        """Solve for the first of some symbols that has one value, and that the others do not rest on."""
        for symbol in dict.fromkeys(symbols):
            if symbol not in equation.symbols or symbol in self.solved:
                continue
            # The others are computed from it already: it would rest on itself.
            if symbol in self.below(other for other in equation.symbols if other != symbol):
                continue
            found = solve_for(symbol, *equation.sides)
            if found is not None and all(map(definite, found.pivots)):
                self.solved[symbol] = found.value, equation
                return True
        return False

    def below(self, symbols: Iterable[Expr]) -> list[Expr]:
        """Some symbols and all that they rest on, each after what it is computed from."""
        done: dict[Expr, None] = {}

        def visit(symbol: Expr) -> None:
            if symbol not in done:
                for other in symbols_of(self.solved[symbol][0]) if symbol in self.solved else ():
                    visit(other)
                done[symbol] = None

        for symbol in symbols:
            visit(symbol)
        return list(done)

    def behind(self, statement: Statement) -> frozenset[Equation]:
        """What the statements say that a statement rests on by what its symbols are solved from."""
        held = [e for e in self.open if e.of is statement]
        held += [e for _, e in self.solved.values() if e.of is statement]
        symbols = [s for e in held for s in e.symbols]
        symbols += [s for condition, of in self.conditions if of is statement for s in symbols_of(condition)]
        used = [self.solved[s][1].of for s in self.below(symbols) if s in self.solved]
        return frozenset({statement.source, *(of.source for of in used)})

    def is_impossible(self) -> bool:
        """Whether the signs of what is solved or left open exclude every point."""
        if self.sizes:
            return False  # other sizes were not tried
        solution: dict[Expr, Expr] = {}
        # From what rests on nothing upwards: each value is then one of free symbols alone.
        for symbol in self.below(self.solved):
            if symbol in self.solved:
                solution[symbol] = self.solved[symbol][0].xreplace(solution)
        return any(symbol.is_positive and value.is_nonpositive for symbol, value in solution.items()) or any(
            factor((equation.left - equation.right).xreplace(solution)).is_zero is False
            for equation in self.open
        )


def _margin(condition: Any, of: Statement, number: int) -> Sides | None:
    """An inequality as an equation with what remains: a > b as a = b + t; None for what is none."""
    if not isinstance(condition, Rel) or condition.rel_op not in (">", ">=", "<", "<="):
        return None
    sign = {"positive": True} if condition.rel_op in "<>" else {"nonnegative": True}
    return Sides(condition.gts, condition.lts + Symbol(f"~ margin {number}", **sign), of)


def symbols_of(expression: Any) -> list[Symbol]:
    """The symbols of an expression, always in the same order."""
    return sorted(expression.free_symbols, key=str)
