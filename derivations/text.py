"""Writes expressions and equations for a terminal, in their author's order of terms.

The notation is a calculator's: ``*`` and ``/`` from left to right, ``^`` for powers. Names follow
:data:`~loopsheet.derivations.symbols.TABLE`: the approach of the second test is ``x_m2``, and that of
test k is ``x_m,k``.
"""

from __future__ import annotations

from typing import Any

from sympy import (
    Add,
    And,
    Basic,
    Expr,
    Indexed,
    Integral,
    Mul,
    Number,
    Or,
    Piecewise,
    Pow,
    Rational,
    Rel,
    Sum,
    Symbol,
    sstr,
)
from sympy.core.function import Application

from . import symbols
from .equation import Equation

__all__ = ["text", "text_of_equation"]

_SUM, _PRODUCT, _SIGN, _POWER, _ATOM = range(5)
"""How tightly an expression holds together; a looser one gets parentheses inside a tighter one."""


def text(expression: Any) -> str:
    """Write an expression as a reader at a terminal expects it.

    Parameters
    ----------
    expression : Expr, Boolean or other Basic

    Examples
    --------
    >>> from loopsheet.derivations.soft_impact import eq12b, eq12c
    >>> text(eq12b.members[1])
    "x_m2*(v'_1/v'_2)^(2/(alpha + 1))"
    >>> text(eq12c.members[1])
    "m_red*v'_2^2/2*(alpha + 1)/x_m2^(alpha + 1)"
    """
    return _write(expression)[0]


def text_of_equation(equation: Equation) -> str:
    """Write all members of an equation, ``C*x_m^alpha = C'``."""
    return " = ".join(map(text, equation.members))


def _write(expression: Any) -> tuple[str, int]:
    """The text of an expression and how tightly it holds together."""
    match expression:
        case Indexed():
            return _name(expression.base.label, ",".join(map(text, expression.indices))), _ATOM
        case Symbol():
            return _name(expression, ""), _ATOM
        case Number():
            tight = _SIGN if expression < 0 else _PRODUCT if not expression.is_Integer else _ATOM
            return sstr(expression), tight
        case Add():
            return _sum(expression), _SUM
        case Mul():
            return _product(expression)
        case Pow():
            return _power(expression)
        case Piecewise():
            return "; ".join(f"{text(law)} for {text(where)}" for law, where in expression.args), _SUM
        case Integral() | Sum():
            name = "int" if isinstance(expression, Integral) else "sum"
            ends = (
                f"{text(variable)} = {text(low)}..{text(high)}" for variable, low, high in expression.limits
            )
            return f"{name}({text(expression.function)}, {', '.join(ends)})", _ATOM
        case And():
            return _chain(expression), _SUM
        case Or():
            return " or ".join(map(text, expression.args)), _SUM
        case Rel():
            sign = {"==": "=", "!=": "<>"}.get(expression.rel_op, expression.rel_op)
            return f"{text(expression.lhs)} {sign} {text(expression.rhs)}", _SUM
        case Application():
            name = {"Max": "max", "Min": "min"}.get(expression.func.__name__, expression.func.__name__)
            return f"{name}({', '.join(map(text, expression.args))})", _ATOM
    return sstr(expression), _ATOM if isinstance(expression, Basic) and expression.is_Atom else _SUM


def _inside(expression: Any, tight: int) -> str:
    """The text of a part, in parentheses where it holds together less tightly than it must."""
    written, holds = _write(expression)
    return written if holds >= tight else f"({written})"


def _name(symbol: Symbol, subscript: str) -> str:
    quantity = symbols.find(symbol)
    if quantity is not None and quantity.text:
        return quantity.text % (f"_{subscript}" if subscript else "")
    name = str(symbol)
    if not subscript:
        return name
    join = "_" if "_" not in name else "" if subscript.isdigit() else ","
    return f"{name}{join}{subscript}"


def _sum(expression: Add) -> str:
    written = ""
    for term in _flat(expression, Add):
        part = _inside(term, _PRODUCT) if not isinstance(term, Number) else text(term)
        negative = part.startswith("-")
        part = part.removeprefix("-")
        if not written:
            written = f"-{part}" if negative else part
        else:
            written += f" {'-' if negative else '+'} {part}"
    return written


def _flat(expression: Any, kind: type[Basic]) -> list[Any]:
    """The parts of nested sums or nested products, from left to right."""
    if not isinstance(expression, kind):
        return [expression]
    return [part for argument in expression.args for part in _flat(argument, kind)]


def _product(expression: Mul) -> tuple[str, int]:
    """Factors from left to right; what has a negative power is divided by."""
    factors = [factor for factor in _flat(expression, Mul) if factor != 1]
    sign = ""
    while factors and factors[0] == -1:
        sign = "" if sign else "-"
        factors.pop(0)
    written = ""
    for factor in factors:
        below = _divisor(factor)
        if below is None:
            # A fraction that leads needs no parentheses, and neither does a leading minus.
            part = _inside(factor, _POWER) if written else _inside(factor, _PRODUCT)
            written = f"{written}*{part}" if written else part
        else:
            written = f"{written or '1'}/{_inside(below, _POWER)}"
    written = written or "1"
    if sign and written.startswith("-"):
        written = f"({written})"
    return sign + written, _PRODUCT if not sign else _SIGN if len(factors) == 1 else _PRODUCT


def _divisor(factor: Any) -> Expr | None:
    """What a factor divides by, if it does."""
    if isinstance(factor, Rational) and factor.p == 1 and factor.q != 1:
        return Rational(factor.q)
    if isinstance(factor, Pow) and isinstance(factor.exp, Number) and factor.exp < 0:
        return factor.base if factor.exp == -1 else Pow(factor.base, -factor.exp, evaluate=False)
    return None


def _power(expression: Pow) -> tuple[str, int]:
    base, exponent = expression.args
    below = _divisor(expression)
    if below is not None:
        return f"1/{_inside(below, _POWER)}", _PRODUCT
    if exponent == Rational(1, 2):
        return f"sqrt({text(base)})", _ATOM
    return f"{_inside(base, _ATOM)}^{_inside(exponent, _ATOM)}", _POWER


def _chain(expression: And) -> str:
    """Two inequalities that meet in the middle are one: a <= x <= b."""
    first, second = expression.args if len(expression.args) == 2 else (None, None)
    for a, b in ((first, second), (second, first)):
        if isinstance(a, Rel) and isinstance(b, Rel) and a.rel_op in ("<", "<="):
            if a.rhs == b.lhs and b.rel_op in ("<", "<="):
                return f"{text(a.lhs)} {a.rel_op} {text(a.rhs)} {b.rel_op} {text(b.rhs)}"
            if a.rhs == b.rhs and b.rel_op in (">", ">="):
                return f"{text(a)} and {text(b)}"
    return " and ".join(map(text, expression.args))
