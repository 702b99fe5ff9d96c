"""Loops as visible cells: each pass is columns of its own, formulas as all others are.

Other engines go on until nothing moves; a workbook has a number of passes, and its own code where they do not
settle.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ..column import Column, Formula
from ..sheet import Loop, Sheet

if TYPE_CHECKING:
    from sympy import Basic

__all__ = ["PASSES", "pass_columns", "pass_name", "passes_of"]

PASSES = 20
"""How many a workbook has; a step that does not come near by a tenth each time would need more."""


def pass_name(name: str, number: int) -> str:
    """What the column of a pass is called; 0 is the start.

    >>> pass_name("alpha_eiv", 2)
    'alpha_eiv_pass_2'
    """
    return f"{name}_pass_{number}"


def passes_of(sheet: Sheet) -> dict[str, tuple[str, str, int]]:
    """The columns of all passes of a sheet's loops.

    Returns
    -------
    mapping of str to (str, str, int)
        The name of the loop's first iterated column, the column that is passed, and the number of the pass.
    """
    found: dict[str, tuple[str, str, int]] = {}
    for loop in sheet.loops:
        for number in range(PASSES + 1):
            for column in loop.columns if number else loop.iterated:
                found[pass_name(column.name, number)] = loop.name, column.name, number
    return found


def pass_columns(sheet: Sheet) -> tuple[Column, ...]:
    """The passes of a sheet's loops as columns with formulas.

    Returns
    -------
    tuple of Column
        Declared in the order of what is passed: of several errors, cells inherit the same as those.
    """
    of = passes_of(sheet)
    declared = {column.name: n for n, column in enumerate(sheet.columns)}
    every = (column for loop in sheet.loops for column in _of_loop(loop))
    return tuple(sorted(every, key=lambda column: declared[of[column.name][1]]))


def _of_loop(loop: Loop) -> Iterator[Column]:
    for column in loop.iterated:
        yield _passed(column, 0, _rule(column).start, {})
    before = {column.name for column in loop.iterated}
    for number in range(1, PASSES + 1):
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
    meaning = f"{column.meaning}, pass {number}" if number else f"{column.meaning}, at the start"
    requires = tuple((_renamed(condition, now), says) for condition, says in column.requires)
    return replace(
        own,
        rule=Formula(equation),
        meaning=meaning,
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
