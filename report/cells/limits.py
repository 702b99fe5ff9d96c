"""How far inside of a limit a row lies, as algebra."""

from __future__ import annotations

from sympy import And, Basic, Expr, Ge, Gt, Le, Lt, Max, Min, Or, Symbol

from ...derivations.equation import Equation, Kind
from ..named import within
from ..quantity import Bounds
from ..sheet import Column, Limit, SheetError


def inside(limit: Limit, column: Column, name: str, says: str) -> Equation:
    """What a margin is, in the cells that the limit compares.

    Parameters
    ----------
    column : Column
        Whose limit it is.
    name : str
        What the margin is called.

    Raises
    ------
    SheetError
        The limit is no comparison, or several joined by and or or.
    """
    return Equation("", (Symbol(name), _of(limit, column)), says, Kind.DEFINITION, says)


def _of(limit: Limit, column: Column) -> Expr:
    """How far inside of a limit a row lies."""
    if not isinstance(limit.inside, Bounds):
        return _margin(limit.inside, column)
    datum = Symbol(column.name, real=True)
    found: Expr = _margin(within(datum, limit.inside), column).xreplace({datum: column.cell})
    return found


def _margin(inside: Basic, column: Column) -> Expr:
    """What is negative where a relation does not hold."""
    match inside:
        case And():
            return Min(*(_margin(part, column) for part in inside.args))
        case Or():
            return Max(*(_margin(part, column) for part in inside.args))
        case Le() | Lt():
            return inside.rhs - inside.lhs
        case Ge() | Gt():
            return inside.lhs - inside.rhs
    raise SheetError(f"{column.name}: a limit compares by < or >, it cannot be {inside}", column.name)
