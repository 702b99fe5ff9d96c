"""Differences of temperatures, which have no zero: a formula tells them from temperatures.

It is asked whether its value stays where every temperature is moved by as much. What is declared in a unit
with a zero is a temperature; of all else that is computed, its own formula tells.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import Any

import mpmath
from sympy import Expr, Float, Indexed, Integer, Rational, Symbol
from sympy.concrete.expr_with_limits import ExprWithLimits

from ...derivations.evaluation import UNDEFINED, NotEvaluable, Tape
from ...derivations.reductions import Member
from ..axis import Axis
from ..column import Column, Formula, shown_in
from ..named import name_of

_MOVE = Symbol("move", real=True)
_FAR = 10**4
"""By how much, up and down: farther than cells lie apart, so that none is the largest in both."""
_ROWS = (5, 6, 7)
"""How many rows are written out in turn: what divides by the degrees of freedom may have none."""
_DIGITS, _SAME = 50, 1e-30
"""Of the values that are compared, and by how much of them they may differ."""


def is_difference(formula: Expr, columns: Mapping[str, Column], axis: Axis) -> bool:
    """Whether a formula of temperatures stays where all of them are moved; also if it cannot be told.

    Parameters
    ----------
    formula : Expr
        In SI.
    columns : mapping of str to Column
        What it names.
    axis : Axis
        The rows that it has a value for, or sums over.
    """
    moved, named = _moved(formula, columns)
    return named and not any(_moves(moved, axis, rows) for rows in _ROWS)


def _moved(formula: Expr, columns: Mapping[str, Column]) -> tuple[Expr, bool]:
    """The formula with temperatures moved, other formulas put in, and whether there are any."""
    put, named = {}, False
    for cell in formula.atoms(Symbol, Indexed):
        column = columns.get(name_of(cell))
        if column is None or (column.axis is None) is isinstance(cell, Indexed):
            continue  # the name of a column by itself is part of its cell
        if shown_in(column, columns).zero:
            put[cell], named = cell + _MOVE, True
        elif isinstance(column.rule, Formula):
            inner, rests = _moved(column.rule.expression, columns)
            put[cell], named = inner, named or rests
    return formula.xreplace(put), named


def _moves(moved: Expr, axis: Axis, rows: int) -> bool:
    """Whether the value is seen to move, at drawn values of all cells."""
    moved = moved.replace(Member, lambda *_: Integer(1))  # one group of all rows
    moved = moved.xreplace({number: Rational(str(number)) for number in moved.atoms(Float)})
    moved = moved.xreplace(
        {last: Integer(rows) for each in moved.atoms(ExprWithLimits) for _, _, last in each.limits}
    )
    cells = moved.atoms(Indexed)
    columns = sorted({cell.base.label for cell in cells}, key=str)
    scalars = sorted(moved.free_symbols - {*cells, *columns, axis.size, axis.index, _MOVE}, key=str)
    draw = random.Random(rows)
    with mpmath.workdps(_DIGITS):

        def drawn() -> Any:
            return mpmath.mpf(draw.randint(1000, 9999)) / 1000

        given = [[drawn() for _ in range(rows + 1)] for _ in columns] + [drawn() for _ in scalars]
        tape, found = Tape([axis.size, axis.index, *columns, *scalars, _MOVE]), []
        try:
            value = tape.add([moved])
            for by in (-_FAR, _FAR):
                tape.start([mpmath.mpf(rows), mpmath.mpf(1), *given, mpmath.mpf(by)])
                found += tape.values(value)
        except (NotEvaluable, *UNDEFINED):
            return False
        known = all(map(mpmath.isfinite, found))
        return bool(known and abs(found[1] - found[0]) > _SAME * (1 + abs(found[0])))
