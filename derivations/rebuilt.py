"""Expressions made again: with sympy's own evaluation, or without any and with other symbols."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from sympy import Abs, Add, Basic, Function, Integral, Max, Min, Mul, Piecewise, Pow, Symbol
from sympy.core.relational import Relational

from .reductions import REDUCTIONS

_COMPARED = (Max, Min, Relational)
"""What sympy decided by comparing its parts when it was first made."""
_DECIDED = (Function, Piecewise, Pow)
"""What it decided by what is assumed of its parts, or by what these are."""


def evaluated(expression: Any) -> Any:
    """The expression that is computed: the author's, rebuilt with sympy's own evaluation.

    Integrals and reductions stay unevaluated; only the order of terms and trivial factors are normalised.
    """
    if not isinstance(expression, Basic) or not expression.args or isinstance(expression, Symbol):
        return expression
    arguments = [evaluated(argument) for argument in expression.args]
    if isinstance(expression, (Integral, *REDUCTIONS)):
        return expression.func(arguments[0], *expression.limits)
    if isinstance(expression, Relational) and tuple(arguments) == expression.args:
        return expression  # what can be compared was, when it was made
    return expression.func(*arguments)


def replaced(expression: Any, where: Mapping[Any, Any]) -> Any:
    """Put symbols in without evaluating: the author's order of terms stays."""
    if expression in where:
        return where[expression]
    if not isinstance(expression, Basic) or not expression.args:
        return expression
    arguments = [replaced(argument, where) for argument in expression.args]
    if all(new is old for new, old in zip(arguments, expression.args, strict=True)):
        return expression
    if isinstance(expression, (Add, Mul, Pow)):
        return expression.func(*arguments, evaluate=False)
    return expression.func(*arguments)


def rebuilt(expression: Basic, parts: Sequence[Any]) -> Any:
    """The expression of other parts, of which is assumed what was assumed of its own.

    Where these are only called otherwise, nothing but the order of terms and factors, which hangs on names,
    is found anew: to ask again what has a sign or can be compared takes sympy most of its time.
    """
    decided = isinstance(expression, _COMPARED) or (
        isinstance(expression, _DECIDED) and all(map(_alike, parts, expression.args))
    )
    return expression.func(*parts, evaluate=False) if decided else expression.func(*parts)


def in_absolute_values(expression: Any, by: Basic | None = None) -> Any:
    """The same without Max and Min, whose derivatives few know: Max(a, b) is (a + b + |a - b|)/2.

    `by`: what those name that are meant; all are, if left out.

    >>> x, y = Symbol("x", real=True), Symbol("y", real=True)
    >>> in_absolute_values(Max(x, y) + Max(y, 1), x)
    x/2 + y/2 + Abs(x - y)/2 + Max(1, y)
    """
    return expression.replace(
        lambda part: isinstance(part, (Max, Min)) and (by is None or part.has(by)),
        lambda part: part.rewrite(Abs),
    )


def _alike(new: Basic, old: Basic) -> bool:
    return new.func is old.func or (new.is_symbol and old.is_symbol)


def renamed(expression: Any, names: Mapping[Any, Any]) -> Any:
    """The expression with other symbols or cells, of each of which is assumed what is assumed of its own.

    `expression`: as sympy evaluates it. `names`: no two have the same new name.
    """
    known: dict[Any, Any] = {old: new for old, new in names.items() if old != new}

    def put(part: Any) -> Any:
        if part not in known:
            parts = [put(argument) for argument in part.args]
            same = all(new is old for new, old in zip(parts, part.args, strict=True))
            known[part] = part if same else rebuilt(part, parts)
        return known[part]

    return put(expression) if known else expression
