"""Expressions made again: with sympy's own evaluation, or without any and with other symbols."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sympy import Add, Basic, Integral, Mul, Pow, Symbol

from .reductions import REDUCTIONS

__all__ = ["evaluated", "replaced"]


def evaluated(expression: Any) -> Any:
    """The expression that is computed: the author's, rebuilt with sympy's own evaluation.

    Integrals and reductions stay unevaluated; only the order of terms and trivial factors are normalised.
    """
    if not isinstance(expression, Basic) or not expression.args or isinstance(expression, Symbol):
        return expression
    arguments = [evaluated(argument) for argument in expression.args]
    if isinstance(expression, (Integral, *REDUCTIONS)):
        return expression.func(arguments[0], *expression.limits)
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
