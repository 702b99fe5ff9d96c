"""Prints expressions as functions of NumPy arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import count
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sympy import Basic, Expr, Indexed, Max, Min, Piecewise, S, Symbol, cse, numbered_symbols
from sympy.printing.codeprinter import PrintMethodNotImplementedError
from sympy.printing.numpy import NumPyPrinter

from ...derivations.reductions import REDUCTIONS, Median
from .. import elementary
from ..sheet import Axis, Reference, SheetError, name_of
from .roots import Total

__all__ = ["SAME", "Array", "Function", "Kernel", "Writer", "kernel"]

Array = NDArray[np.float64]
Function = Callable[..., tuple[Array, ...]]


class _Same:
    """NumPy, but its functions whose last bits hang on the processor are our own."""

    exp, log, power = (
        staticmethod(elementary.exp),
        staticmethod(elementary.log),
        staticmethod(elementary.power),
    )

    def __getattr__(self, name: str) -> Any:
        return getattr(np, name)


SAME: Any = _Same()
"""What printed functions call, if they are not told to call NumPy itself, which is faster."""


class Printer(NumPyPrinter):
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
        return reduce(lambda rest, pair: f"numpy.where({pair[1]}, {pair[0]}, {rest})", reversed(pairs), last)

    def _print_Total(self, expr: Total) -> str:
        terms, axis = expr.args
        return f"{axis}_kept.total({self._print(terms)})"

    def _print_Middle(self, expr: Middle) -> str:
        terms, axis = expr.args
        return f"{axis}_kept.median({self._print(terms)})"


class Middle(Expr):
    """A median over an axis' rows as a function of the array of its terms.

    Parameters
    ----------
    terms : Expr
        In plain symbols, each of which stands for an array.
    axis : Symbol
        The axis' name.
    """

    is_commutative = True
    is_real = True


@dataclass(frozen=True)
class Kernel:
    """One printed function: what it is called with, its text, and the function itself.

    Parameters
    ----------
    references : tuple of Reference
        Its arguments, in order.
    totals : tuple of str
        The axes it sums over, or takes a median over: after its arguments, it is called with what does
        that for each, a :class:`~loopsheet.report.engines.numpy_rows.Kept`.
    source : str
        Its text.
    run : callable
        Returns one array for each expression.
    """

    references: tuple[Reference, ...]
    totals: tuple[str, ...]
    source: str
    run: Function

    @property
    def arguments(self) -> tuple[Expr, ...]:
        """The cells it is called with."""
        return tuple(reference.cell for reference in self.references)


class Writer:
    """Writes functions over the same cells.

    Parameters
    ----------
    sums : mapping of index to Axis
        The axes that sums may run over.
    functions : module
        What they call: :data:`SAME`, or NumPy.
    """

    def __init__(self, sums: Mapping[Symbol, Axis], functions: Any = SAME) -> None:
        self.sums, self.functions = sums, functions
        self.symbols: dict[Reference, Symbol] = {}
        self._ordinals = {symbol for axis in sums.values() for symbol in axis.ordinals}
        self._reserved = {"numpy", *(f"{axis.name}_kept" for axis in sums.values())}

    def plain(self, expression: Any, over: Axis | None = None) -> Any:
        """The expression in plain symbols, each the name of an array; a sum is a :class:`Total`."""
        if isinstance(expression, REDUCTIONS):
            axis = self.sums[expression.limits[0][0]]
            taken = Middle if isinstance(expression, Median) else Total
            return taken(self.plain(expression.function, axis), Symbol(axis.name))
        if isinstance(expression, (Indexed, Symbol)):
            by_row = isinstance(expression, Indexed) or expression in self._ordinals
            reference = Reference(expression, over if by_row else None)
            if reference not in self.symbols:
                self.symbols[reference] = self._symbol(reference)
            return self.symbols[reference]
        if not expression.args:
            return expression
        parts = [self.plain(argument, over) for argument in expression.args]
        if isinstance(expression, (Max, Min)):
            return expression.func(
                *parts, evaluate=False
            )  # what can be compared was, before the names changed
        return expression.func(*parts)

    def _symbol(self, reference: Reference) -> Symbol:
        cell = reference.cell
        name = f"{name_of(cell)}_of_{cell.indices[0]}" if isinstance(cell, Indexed) else cell.name
        label = cell.base.label if isinstance(cell, Indexed) else cell
        taken = {symbol.name for symbol in self.symbols.values()} | self._reserved
        free = next(n for suffix in count() if (n := name + "_" * suffix) not in taken)
        return Symbol(free, **label.assumptions0)

    def kernel(self, expressions: Sequence[Any]) -> Kernel:
        """A function of the cells that the expressions, in plain symbols, name."""
        used = set().union(*(expression.free_symbols for expression in expressions))
        references = sorted((r for r, s in self.symbols.items() if s in used), key=_by_name)
        totals = totals_in(expressions)
        source, run = write([self.symbols[r] for r in references], totals, expressions, self.functions)
        return Kernel(tuple(references), totals, source, run)


def _by_name(reference: Reference) -> tuple[str, str]:
    return str(reference.cell), "" if reference.over is None else reference.over.name


def totals_in(expressions: Iterable[Basic]) -> tuple[str, ...]:
    """The axes that expressions sum over, or take a median over."""
    found = (taken for expression in expressions for taken in expression.atoms(Total, Middle))
    return tuple(sorted({taken.args[1].name for taken in found}))


def write(
    arguments: Sequence[Symbol], totals: Sequence[str], expressions: Sequence[Any], functions: Any = SAME
) -> tuple[str, Function]:
    """Print expressions as one function, common parts computed once; return its text and the function.

    Raises
    ------
    SheetError
        NumPy has no word for some part of them.
    """
    symbols = numbered_symbols("t_", exclude=arguments)
    common, bodies = cse(expressions, symbols=symbols, order="none", list=True)
    printer = Printer()
    names = [*(a.name for a in arguments), *(f"{axis}_kept" for axis in totals)]
    try:
        lines = [f"def kernel({', '.join(names)}):"]
        lines += [f"    {name} = {printer.doprint(value)}" for name, value in common]
        lines += [f"    return ({', '.join(printer.doprint(body) for body in bodies)},)"]
    except PrintMethodNotImplementedError as error:
        raise SheetError(f"NumPy cannot compute this: {error}") from error
    source = "\n".join(lines)
    namespace: dict[str, Any] = {"numpy": functions}
    exec(
        compile(source, "<generated>", "exec"), namespace
    )  # printed from our own expressions, never foreign text
    return source, namespace["kernel"]


def kernel(expressions: Sequence[Basic], sums: Mapping[Symbol, Axis], functions: Any = SAME) -> Kernel:
    """Print expressions as one function of arrays.

    Parameters
    ----------
    expressions : sequence of Basic
        What the function returns, in order.
    sums : mapping of index to Axis
        The axes that sums in them may run over.
    functions : module
        As for :class:`Writer`.
    """
    writer = Writer(sums, functions)
    return writer.kernel([writer.plain(expression) for expression in expressions])
