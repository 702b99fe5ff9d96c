"""Prints expressions as functions of NumPy arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce
from types import MappingProxyType
from typing import Any

from sympy import Basic, Expr, Piecewise, S, Symbol, cse, log, numbered_symbols
from sympy.printing.codeprinter import PrintMethodNotImplementedError
from sympy.printing.numpy import NumPyPrinter

from ..plan.nodes import RowOrder, RowSum, taken_over
from ..sheet import SheetError
from .kernels import Kernel


class ArrayPrinter(NumPyPrinter):
    """NumPy's printer, with what broadcasting over columns needs; what it cannot print, it refuses."""

    def __init__(self) -> None:
        super().__init__({"strict": True})

    def _print_Max(self, expr: Expr) -> str:
        return self._pairwise("numpy.maximum", expr)

    def _print_Min(self, expr: Expr) -> str:
        return self._pairwise("numpy.minimum", expr)

    def _print_And(self, expr: Expr) -> str:
        return self._pairwise("numpy.logical_and", expr)

    def _print_Or(self, expr: Expr) -> str:
        return self._pairwise("numpy.logical_or", expr)

    def _as_ordered_terms(self, expr: Expr, order: Any = None) -> list[Expr]:
        # A difference takes one operation less than a sum with an opposite.
        terms: list[Expr] = super()._as_ordered_terms(expr, order=order)
        first = next((n for n, term in enumerate(terms) if not term.as_coeff_Mul()[0].is_negative), 0)
        return [terms.pop(first), *terms]

    def _pairwise(self, function: str, expr: Expr) -> str:
        # sympy stacks the arguments, which must then have one shape; columns and scalars do not.
        parts = [self._print(argument) for argument in sorted(expr.args, key=str)]
        return str(reduce(lambda a, b: f"{function}({a}, {b})", parts))

    def _print_Pow(self, expr: Expr, rational: bool = False) -> str:
        # x**(-2) of an array is slower and less exact than a division, x**3 than a product.
        base, exponent = expr.args
        if exponent in (2, 3, 4) and base.is_Symbol:
            return "(" + "*".join([self._print(base)] * int(exponent)) + ")"
        if exponent.is_Integer and exponent < 0:
            inner = self.parenthesize(base, 70) if exponent == -1 else self._print(base**-exponent)
            return f"(1/{inner})"
        if abs(exponent) == S.Half:
            return str(super()._print_Pow(expr, rational=rational))  # a square root is IEEE 754's
        return f"numpy.power({self._print(base)}, {self._print(exponent)})"

    def _print_Piecewise(self, expr: Piecewise) -> str:
        pairs = [(self._print(body), self._print(condition)) for body, condition in expr.args]
        last = pairs.pop()[0] if expr.args[-1].cond == True else "numpy.nan"  # noqa: E712
        return reduce(
            lambda rest, pair: f"choose({pair[1]}, lambda: {pair[0]}, lambda: {rest})", reversed(pairs), last
        )

    def _print_RowSum(self, expr: RowSum) -> str:
        terms, axis = expr.args
        return f"{axis}_kept.total({self._print(terms)})"

    def _print_RowOrder(self, expr: RowOrder) -> str:
        terms, axis, _ = expr.args
        return f'{axis}_kept.ordered({self._print(terms)}, "{expr.word}")'


def printed(printer: ArrayPrinter, expression: Any) -> str:
    """The text of an expression.

    Raises
    ------
    SheetError
        NumPy has no word for some part of it.
    """
    try:
        return str(printer.doprint(expression))
    except PrintMethodNotImplementedError as error:
        raise SheetError(f"NumPy cannot compute this: {error}") from error


def text_of(name: str, arguments: Sequence[str], lines: Sequence[str]) -> str:
    """The text of a function of printed lines."""
    return "\n".join([f"def {name}({', '.join(arguments)}):", *(f"    {line}" for line in lines)])


def write(
    arguments: Sequence[Symbol],
    totals: Sequence[str],
    expressions: Sequence[Any],
    parts: Mapping[Symbol, Any] = MappingProxyType({}),
) -> str:
    """Print expressions as one function, common parts computed once.

    Parameters
    ----------
    totals : sequence of str
        As for :class:`Kernel`.
    expressions : sequence of Expr
        What it returns.
    parts : mapping of Symbol to Expr
        What the expressions are made of besides, each of what comes before it.

    Raises
    ------
    SheetError
        NumPy has no word for some part of them.
    """
    symbols = numbered_symbols("t_", exclude=(*arguments, *parts))
    every = [*parts.values(), *expressions]
    opposite = _opposite(every)
    common, bodies = cse(
        [each.xreplace(opposite) for each in every], symbols=symbols, order="none", list=True
    )
    printer = ArrayPrinter()
    names = [*(a.name for a in arguments), *(f"{axis}_kept" for axis in totals)]
    waiting, bodies = [*common, *zip(parts, bodies, strict=False)], bodies[len(parts) :]
    lines, unknown = [], {name for name, _ in waiting}
    while waiting:
        name, value = ready = next(each for each in waiting if unknown.isdisjoint(each[1].free_symbols))
        lines.append(f"{name} = {printed(printer, value)}")
        waiting.remove(ready)
        unknown.remove(name)
    lines += [f"return ({', '.join(printed(printer, body) for body in bodies)},)"]
    return text_of("kernel", names, lines)


def _opposite(expressions: Sequence[Any]) -> dict[Expr, Expr]:
    """Logarithms of what other logarithms are of the reciprocals of: one of both is enough."""
    found: dict[Expr, Expr] = {}
    for each in sorted(set().union(*(e.atoms(log) for e in expressions)), key=str):
        reciprocal = log(1 / each.args[0])
        if reciprocal.func is log and reciprocal in found:
            found[each] = -reciprocal
        else:
            found[each] = each
    return found


def kernel(expressions: Sequence[Basic]) -> Kernel:
    """Print expressions in plain symbols as one function of these, sorted by name.

    `expressions`: what the function returns, in order.
    """
    totals = taken_over(expressions)
    axes = {Symbol(axis) for axis in totals}
    arguments = sorted(set().union(*(e.free_symbols for e in expressions)) - axes, key=str)
    names = tuple(argument.name for argument in arguments)
    return Kernel(names, totals, write(arguments, totals, expressions))
