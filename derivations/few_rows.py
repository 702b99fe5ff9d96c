"""Statements about columns, written out for columns of a few rows with a plain symbol for each cell.

What gives a cell of every row is written for each row. The sizes of columns are small whole numbers that
agree with all that is said of sizes alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice, product
from typing import Any

from sympy import Add, Basic, Expr, Indexed, Sum, Symbol, true
from sympy.core.function import AppliedUndef
from sympy.logic.boolalg import Boolean

from .cells import running
from .equation import Equation
from .evaluation import NotEvaluable, Tape
from .reductions import Member, OrderStatistic
from .sums import in_terms

_FEWEST, _MOST, _CHOICES = 3, 12, 500
"""How many rows a column gets at least and at most, and how many choices of all sizes are tried."""


@dataclass(frozen=True)
class Statement:
    """What is to hold: an equation, as a step uses it."""

    source: Equation
    """What a reader knows it as."""
    sides: tuple[Expr, ...]
    """What is equal; empty for conditions alone."""
    conditions: tuple[Boolean, ...]
    """Of an assumption, what holds with it; of a claim, where it holds."""
    hints: tuple[Expr, ...] = ()
    """What it may be solved for, the best first."""

    @property
    def parts(self) -> tuple[Any, ...]:
        """All its expressions."""
        return (*self.sides, *self.conditions, *self.hints)

    @property
    def symbols(self) -> set[Any]:
        """What it is about."""
        return {symbol for part in self.parts for symbol in part.free_symbols}


class FewRows:
    """Statements with a few rows in each column, and a plain symbol for each cell."""

    def __init__(self, statements: Sequence[Statement]) -> None:
        self.names: dict[Any, Any] = {}
        """What each plain symbol stands for, where that is no symbol."""
        parts = [part for statement in statements for part in statement.parts]
        self.sizes = _chosen(_sizes(parts), statements, _rows_named(parts) + 1)
        """How many rows there are, for the symbols that say so."""
        self._rows = max([_FEWEST, *self.sizes.values()])
        self.statements = [plain for statement in statements for plain in self._of_all_rows(statement)]

    def _of_all_rows(self, statement: Statement) -> Iterator[Statement]:
        """A statement, for the first rows or for every row of which it speaks."""
        cells = {cell for part in statement.parts for cell in part.atoms(Indexed)}
        free = statement.symbols - set(self.sizes)
        if statement.symbols and not free:
            return  # the sizes were chosen so that it holds
        if _sizes(statement.parts) & free:
            return  # too many rows to be written out
        numbers = sorted(
            {s for cell in cells for row in cell.indices for s in row.free_symbols} & free, key=str
        )
        # What gives a cell of every row holds for each; else nothing says which symbols belong to the row.
        every = any(
            isinstance(side, Indexed) and set(side.indices) == set(numbers) for side in statement.sides
        )
        first = tuple(range(1, len(numbers) + 1))
        for rows in product(range(1, self._rows + 1), repeat=len(numbers)) if every else [first]:
            where = {**self.sizes, **dict(zip(numbers, rows, strict=True))}
            sides, conditions, hints = (
                tuple(self._plain(part.subs(where)) for part in parts)
                for parts in (statement.sides, statement.conditions, statement.hints)
            )
            if _is_evaluable((*sides, *conditions)):
                yield Statement(statement.source, sides, conditions, hints)

    def _plain(self, expression: Any) -> Any:
        expression = _written_out(expression)
        for kind in (OrderStatistic, Indexed, AppliedUndef):
            plain = {}
            for part in sorted(expression.atoms(kind), key=str):
                of = part.base.label if kind is Indexed else part
                plain[part] = Symbol(str(part), real=True, positive=True if of.is_positive else None)
                self.names[plain[part]] = part
            expression = expression.xreplace(plain)
        return expression


def _written_out(expression: Any) -> Any:
    """Sums over rows that are known by their numbers term by term; others in the common form."""
    if not isinstance(expression, Basic) or not expression.has(Sum):
        return expression
    if isinstance(expression, Sum):
        *inner, (index, low, high) = expression.limits
        body = Sum(expression.function, *inner) if inner else expression.function
        if not (low.is_Integer and high.is_Integer):
            return in_terms(expression)
        rows = range(int(low), int(high) + 1)
        return Add(*(_written_out(body.subs(index, row)) for row in rows))  # what runs within is another one
    return expression.func(*map(_written_out, expression.args))


def _sizes(parts: Iterable[Any]) -> set[Any]:
    """The whole numbers at which sums and integrals begin and end."""
    return {s for _, *ends in running(parts) for end in ends for s in end.free_symbols if s.is_integer}


def _rows_named(parts: Iterable[Any]) -> int:
    """The last row that is called by its number."""
    rows = [row for part in parts for cell in part.atoms(Indexed) for row in cell.indices]
    ends = [end for _, *limits in running(parts) for end in limits]
    return max((int(row) for row in (*rows, *ends) if row.is_Integer), default=0)


def _chosen(sizes: set[Any], statements: Sequence[Statement], least: int) -> dict[Any, int]:
    """The smallest sizes that agree with all that is said of sizes alone; empty if none so small do.

    Where some do, they are as large as conditions of other statements ask for, too.
    """
    ordered = sorted(sizes, key=str)
    said = [statement for statement in statements if statement.symbols and statement.symbols <= sizes]
    every = {condition for statement in statements for condition in statement.conditions}
    more = [condition for condition in every if condition.free_symbols and condition.free_symbols <= sizes]
    more += _in_groups([part for statement in statements for part in statement.parts])
    choices = product(range(max(_FEWEST, least), _MOST + 1), repeat=len(ordered))
    agreed: list[dict[Any, int]] = []
    for counts in islice(sorted(choices, key=max), _CHOICES) if ordered else ():
        where = dict(zip(ordered, counts, strict=True))
        if all(
            len({side.subs(where) for side in statement.sides}) <= 1
            and all(condition.subs(where) == true for condition in statement.conditions)
            for statement in said
        ):
            agreed.append(where)
            if all(condition.subs(where) == true for condition in more):
                return where
    return agreed[0] if agreed else {}


def _in_groups(parts: Iterable[Any]) -> list[Boolean]:
    """That there are more rows than groups of them, for some group has several."""
    parts = list(parts)
    ends = {index: end for index, _, end in running(parts)}
    told = {member.args for part in parts for member in part.atoms(Member)}
    return [ends[group] < ends[row] for row, group in sorted(told, key=str) if {row, group} <= ends.keys()]


def _is_evaluable(parts: Iterable[Any]) -> bool:
    program = Tape(sorted({symbol for part in parts for symbol in part.free_symbols}, key=str))
    try:
        program.add(parts)
    except NotEvaluable:
        return False
    return True
