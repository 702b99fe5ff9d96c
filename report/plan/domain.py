"""Where an expression has a value at all, by algebra: what tells a value that no double holds from none.

A number that is infinite, or not one, may come of a division by zero or of an intermediate result beyond the
largest double. The operations that have no value somewhere are few; if none of them is where it has none, the
expression has a value, and doubles are to blame.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import sympy as sp
from sympy.core.relational import Relational
from sympy.functions.elementary.piecewise import ExprCondPair
from sympy.logic.boolalg import Boolean

from ...derivations.reductions import REDUCTIONS
from ..quantity import Bounds
from ..sheet import Sheet
from .nodes import Leaf, OverRows, RowSum

_EVERYWHERE = (
    sp.Abs, sp.Add, sp.And, ExprCondPair, sp.Max, sp.Min, sp.Mul, sp.Not, sp.Or, Relational,
    sp.atan, sp.ceiling, sp.cos, sp.cosh, sp.exp, sp.floor, sp.sign, sp.sin, sp.sinh, sp.tanh,
)  # fmt: skip
"""What has a value wherever its arguments have."""


def typed(sheet: Sheet, expression: sp.Expr) -> sp.Expr:
    """The expression in cells of which is assumed what they may be: a given one that is allowed to be 0 is.

    `expression`: a formula of the sheet. What is made of it names the same cells.
    """
    own = {sheet[name].symbol: sp.Symbol(name, **assumed(bounds)) for name, bounds in sheet.bounds.items()}
    found: sp.Expr = expression.xreplace(own)
    return found


def typed_symbols(sheet: Sheet, leaves: Mapping[sp.Symbol, Leaf]) -> dict[sp.Symbol, sp.Symbol]:
    """For the cells of given columns, symbols of which is assumed what they may be."""
    return {
        symbol: sp.Symbol(symbol.name, **assumed(sheet.bounds[leaf.name]))
        for symbol, leaf in leaves.items()
        if leaf.kind == "cells" and leaf.name in sheet.bounds
    }


def assumed(bounds: Bounds) -> dict[str, bool]:
    """What sympy is told of a number within bounds.

    Examples
    --------
    >>> assumed(Bounds(low=0)), assumed(Bounds(low=0, low_open=True)), assumed(Bounds())
    ({'nonnegative': True}, {'positive': True}, {'real': True})
    >>> assumed(Bounds(low=0.5)), assumed(Bounds(low=-0.5, low_open=True))
    ({'positive': True}, {'real': True})
    """
    least = -1 if bounds.low is None else bounds.low
    if least < 0:
        return {"real": True}
    return {"positive" if least > 0 or bounds.low_open else "nonnegative": True}


@lru_cache(maxsize=4096)
def defined(expression: Any) -> Boolean:
    """Say where an expression has a value, as a condition that every engine can print.

    Parameters
    ----------
    expression : Basic
        A formula of a sheet, from :func:`typed`.

    Returns
    -------
    Boolean
        True if it has one everywhere; false also for a function of which that is not known.

    Examples
    --------
    >>> x, y = sp.symbols("x y", positive=True)
    >>> defined(x * y**-2.5 / (x - y)), defined((x - y) ** -2.5)
    (Ne(x - y, 0), x - y > 0)
    >>> defined(sp.log(x / y))
    True
    """
    if not expression.args or expression.is_Atom or expression.is_Indexed:
        return sp.S.true
    if isinstance(expression, REDUCTIONS):
        lost = outside(defined(expression.function))
        return sp.S.true if lost == 0 else sp.Eq(sp.Sum(lost, *expression.limits), 0)
    if isinstance(expression, OverRows):
        lost = outside(defined(expression.args[0]))
        return sp.S.true if lost == 0 else sp.Eq(RowSum(lost, expression.args[1]), 0)
    if isinstance(expression, sp.Piecewise):
        chosen = [sp.Or(sp.Not(condition), defined(value)) for value, condition in expression.args]
        conditions = [condition for _, condition in expression.args]
        return sp.And(*chosen, *map(defined, conditions), sp.Or(*conditions))
    return sp.And(_itself(expression), *map(defined, expression.args))


_PASSING = (sp.Abs, sp.Add, sp.Mul, sp.ceiling, sp.cos, sp.cosh, sp.floor, sp.sin, sp.sinh)
"""What is infinite, or no number, if an argument is."""


@lru_cache(maxsize=4096)
def noticed(expression: Any) -> Boolean:
    """Say where a finite value is one: no operation without a value is lost in another, as 1/0 is in 1/(1/0).

    Parameters
    ----------
    expression : Basic
        A formula of a plan, with symbols for what is taken over rows.

    Returns
    -------
    Boolean
        True if that is so everywhere: what has no value is infinite, or no number, in doubles.

    Examples
    --------
    >>> x, y = sp.symbols("x y", nonnegative=True)
    >>> noticed(1 / (1 / x + 1 / (y + 1))), noticed(sp.exp(-1 / x)), noticed(sp.sqrt(y / x))
    (Ne(x, 0), Ne(x, 0), True)
    """
    if not expression.args or expression.is_Atom or expression.is_Indexed:
        return sp.S.true
    if isinstance(expression, sp.Piecewise):
        chosen = [sp.Or(sp.Not(condition), noticed(value)) for value, condition in expression.args]
        return sp.And(*chosen, *(defined(condition) for _, condition in expression.args))
    is_root = isinstance(expression, sp.Pow) and expression.exp.is_number and expression.exp.is_positive
    passing = is_root or isinstance(expression, (*_PASSING, sp.log))
    return sp.And(*map(noticed if passing else defined, expression.args))


def outside(holds: Boolean) -> sp.Expr:
    """1 where something does not hold, else 0."""
    found: sp.Expr = sp.Piecewise((sp.Integer(0), holds), (sp.Integer(1), True))
    return found


def _itself(expression: Any) -> Boolean:
    """Where an operation has a value if its arguments have."""
    if isinstance(expression, sp.Pow):
        base, exponent = expression.args
        if exponent.is_negative and exponent.is_noninteger:
            return base > 0
        whole = sp.S.true if exponent.is_integer else base >= 0
        if not exponent.is_number:
            whole = sp.Or(whole, sp.Eq(exponent, sp.floor(exponent)))
        some = sp.S.true if exponent.is_nonnegative else sp.Ne(base, 0)
        return sp.And(whole, some if exponent.is_negative else sp.Or(some, exponent > 0))
    if isinstance(expression, sp.log):
        return expression.args[0] > 0
    if isinstance(expression, sp.tan):
        return sp.Ne(sp.cos(expression.args[0]), 0)
    if isinstance(expression, (sp.acos, sp.asin)):
        return sp.And(expression.args[0] >= -1, expression.args[0] <= 1)
    return sp.S.true if isinstance(expression, _EVERYWHERE) else sp.S.false


def is_positive(expression: sp.Expr) -> bool:
    """Whether an expression is positive by what is assumed of its cells; a sum of such has some terms.

    Examples
    --------
    >>> F, n = sp.Symbol("F", positive=True), sp.Symbol("n", positive=True)
    >>> is_positive(RowSum(F, sp.Symbol("points")) / n), is_positive(F - 1)
    (True, False)
    """
    known = {
        total: sp.Dummy(positive=True) for total in expression.atoms(RowSum) if is_positive(total.args[0])
    }
    return bool(expression.xreplace(known).is_positive)


@lru_cache(maxsize=4096)
def positive(expression: sp.Expr) -> Boolean:
    """Say where an expression is positive, by the signs of its factors: no double may hold their product.

    Parameters
    ----------
    expression : Expr
        A formula of a sheet, from :func:`typed`.

    Returns
    -------
    Boolean
        True if it is everywhere; false if its value alone says it.

    Examples
    --------
    >>> x, y, e = *sp.symbols("x y", positive=True), sp.Symbol("e", nonnegative=True)
    >>> positive(x**2 / y), positive(x - y)
    (True, False)
    >>> positive(e**2 * x / (x - y))
    sign(e)**2*sign(x - y) > 0
    """
    factors = [factor for factor in sp.Mul.make_args(expression) if not is_positive(factor)]
    if not factors:
        return sp.S.true
    signs = [
        sp.sign(base) ** (2 if power.is_even else 1)
        for base, power in (factor.as_base_exp() for factor in factors)
    ]
    return sp.S.false if factors == [expression] and not expression.is_Pow else sp.Mul(*signs) > 0
