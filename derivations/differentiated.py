"""The derivative of long expressions: sympy's, without what it asks on the way.

Sympy looks through all of an expression at each of its parts, and asks of each derivative whether what is
assumed of its symbols makes it zero: nearly all of the time that the derivatives of a sheet took. Here each
part is differentiated once; what comes out is the same expression.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from sympy import Add, DiracDelta, Expr, Function, Integer, Mul, Piecewise, Pow, Symbol, diff, log
from sympy.core.function import ArgumentIndexError

_ZERO, _ONE = Integer(0), Integer(1)


@lru_cache(maxsize=20_000)
def differentiated(expression: Expr, by: Symbol) -> Any:
    """The derivative of an expression, as ``diff`` writes it.

    `expression`: in plain symbols; of a kind that has a rule of its own, such as a sum, sympy is asked.
    """
    if not expression.args:
        return _ONE if expression == by else _ZERO
    if isinstance(expression, Add):
        return Add(*(differentiated(term, by) for term in expression.args))
    if isinstance(expression, Mul):
        return Add(*_of_product(expression.args, by))
    if isinstance(expression, Piecewise):
        return Piecewise(*((differentiated(value, by), condition) for value, condition in expression.args))
    if isinstance(expression, Pow):
        base, exponent = expression.args
        inner, outer = differentiated(base, by), differentiated(exponent, by)
        if inner == 0 == outer:
            return _ZERO
        return expression * (outer * log(base) + inner * exponent / base)
    if isinstance(expression, Function) and type(expression)._eval_derivative is Function._eval_derivative:
        moving = [(n, differentiated(each, by)) for n, each in enumerate(expression.args, start=1)]
        try:
            return Add(*(expression.fdiff(n) * inner for n, inner in moving if inner != 0))
        except ArgumentIndexError:
            pass
    return diff(expression, by)


def beside_corners(derivative: Any) -> Any:
    """A derivative as it is to both sides of where a slope jumps: nothing is infinite there."""
    return derivative.replace(DiracDelta, lambda *_: _ZERO) if derivative.has(DiracDelta) else derivative


def _of_product(factors: tuple[Expr, ...], by: Symbol) -> list[Expr]:
    found = ((n, differentiated(factor, by)) for n, factor in enumerate(factors))
    return [Mul(*factors[:n], inner, *factors[n + 1 :]) for n, inner in found if inner != 0]
