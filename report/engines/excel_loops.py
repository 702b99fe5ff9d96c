"""Loops as visible cells: each pass is columns of its own, formulas as all others are.

Other engines go on until nothing moves; a workbook has a number of passes, and its own code where they do not
settle. All passes have one rule: the columns of the first are lowered and printed, and every other pass is
written as that is, with the names of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from ..column import Column, Formula
from ..sheet import Loop, Sheet

if TYPE_CHECKING:
    from sympy import Basic

PASSES = 20
"""How many a workbook has; twice or four times as many where some loop does not settle in them as issued."""


def pass_name(name: str, number: int) -> str:
    """What the column of a pass is called; 0 is the start.

    >>> pass_name("alpha_eiv", 2)
    'alpha_eiv_pass_2'
    """
    return f"{name}_pass_{number}"


@dataclass(frozen=True)
class Pass:
    """A column of a loop in one of its passes."""

    loop: str
    """The name of the loop's first iterated column."""
    of: str
    """The column that is passed."""
    number: int

    @property
    def name(self) -> str:
        """What its column is called."""
        return pass_name(self.of, self.number)

    @property
    def when(self) -> str:
        """Which pass it is, in words."""
        return f"pass {self.number}" if self.number else "at the start"

    @property
    def rule(self) -> str:
        """The column of the sheet that has its rule: the start, or that of the first pass."""
        return pass_name(self.of, min(self.number, 1))


def passes_of(sheet: Sheet, last: int = PASSES) -> dict[str, Pass]:
    """The columns of so many passes of a sheet's loops, by name."""
    found = (
        Pass(loop.name, column.name, number)
        for loop in sheet.loops
        for number in range(last + 1)
        for column in (loop.columns if number else loop.iterated)
    )
    return {each.name: each for each in found}


def names_in(passes: Mapping[str, Pass], number: int) -> Callable[[str], str]:
    """What is called in a pass what the first pass, or its start, calls by a name.

    >>> named = names_in({"x_pass_0": Pass("x", "x", 0)}, 3)
    >>> named("x_pass_0"), named("y")
    ('x_pass_2', 'y')
    """

    def named(name: str) -> str:
        own = passes.get(name) if number > 1 else None
        return name if own is None else pass_name(own.of, own.number + number - 1)

    return named


def pass_columns(sheet: Sheet, last: int = 1) -> tuple[Column, ...]:
    """The passes of a sheet's loops as columns with formulas.

    `last`: up to which pass; those after the first differ from it in their names alone.

    Returns
    -------
    tuple of Column
        Declared in the order of what is passed: of several errors, cells inherit the same as those.
    """
    of = passes_of(sheet, last)
    declared = {column.name: n for n, column in enumerate(sheet.columns)}
    every = (column for loop in sheet.loops for column in _of_loop(loop, last))
    return tuple(sorted(every, key=lambda column: declared[of[column.name].of]))


def _of_loop(loop: Loop, last: int) -> Iterator[Column]:
    for column in loop.iterated:
        yield _passed(column, 0, _rule(column).start, {})
    before = {column.name for column in loop.iterated}
    for number in range(1, last + 1):
        now = {name: pass_name(name, number - (name in before)) for name in loop.names}
        for column in loop.formulas:
            yield _passed(column, number, _rule(column).expression, now)
        for column in loop.iterated:
            yield _passed(column, number, _rule(column).step, now)


def _rule(column: Column) -> Any:
    return column.rule


def _passed(column: Column, number: int, value: Basic, now: Mapping[str, str]) -> Column:
    from ...derivations.equation import Equation, Kind

    name = pass_name(column.name, number)
    own = replace(column, name=name)
    equation = Equation("", (own.cell, _renamed(value, now)), "", Kind.DEFINITION, "a pass")
    requires = tuple((_renamed(condition, now), says) for condition, says in column.requires)
    return replace(
        own,
        rule=Formula(equation),
        requires=requires,
        limits=(),
        display=f"like {column.name}",
    )


def _renamed(expression: Basic, now: Mapping[str, str]) -> Any:
    """The expression in cells of passes."""
    from sympy import Indexed, IndexedBase, Symbol

    from ...derivations.rebuilt import renamed

    def new(symbol: Any) -> Any:
        return Symbol(now[symbol.name], **symbol.assumptions0)

    cells = {
        cell: IndexedBase(new(cell.base.label))[cell.indices]
        for cell in expression.atoms(Indexed)
        if cell.base.label.name in now
    }
    plain = {symbol: new(symbol) for symbol in expression.atoms(Symbol) if symbol.name in now}
    return renamed(expression, cells | plain)
