"""Prints a plan as one function: what columns have in common is computed once, in the order of the plan.

The function is told by what it is called with how to fetch rows, add them up, and what to make of a value: so
one text computes numbers (:mod:`~loopsheet.report.engines.numpy`) and intervals
(:mod:`~loopsheet.report.judge.enclosure`).
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from typing import Any

from sympy import Expr, Symbol
from sympy.logic.boolalg import Boolean

from ..column import Column
from ..plan.nodes import GivenNode, Leaf, LoopNode, Map, Node, Part, Plan, RootNode, Total, free_name
from .numpy_code import ArrayPrinter, printed, text_of


def sheet_function(plan: Plan, roots: Mapping[str, Iterable[str]], iterated: Iterable[Column] = ()) -> str:
    """Print a plan.

    Parameters
    ----------
    roots : mapping of column name to iterable of str
        What each root is called with.
    iterated : iterable of Column
        Those that are named as they were before, although they get other values here.

    Raises
    ------
    SheetError
        NumPy has no word for a part of it.
    """
    writing = _Writing(plan, roots)
    writing.need(plan.own[column.name] for column in iterated)
    before = {column.name for column in iterated}
    for node, values in writing.nodes:
        writing.node(node, values, before)
    return text_of("sheet", ["run"], writing.lines or ["pass"])


def _expressions(node: Node, own: Mapping[str, Symbol]) -> tuple[Any, ...]:
    """What a node computes row by row; a root brings functions of its own."""
    if isinstance(node, GivenNode):
        datum = Symbol(own[node.column.name].name, real=True)
        return () if node.allowed is None else (node.allowed.xreplace({node.datum: datum}),)
    if isinstance(node, Total):
        return (node.terms,)
    if isinstance(node, Part):
        return (node.value,)
    if isinstance(node, LoopNode):
        return ()  # it brings functions of its own
    return (node.value_in_doubles, *node.requires) if isinstance(node, Map) else node.requires


def _shared(expressions: Iterable[Any]) -> set[Any]:
    """The parts that stand in expressions more than once."""
    seen: set[Any] = set()
    found: set[Any] = set()
    waiting = list(expressions)
    while waiting:
        part = waiting.pop()
        if part in seen:
            found.add(part)
            if part.is_Pow and part.exp.is_negative and part.base.args:
                found.add(part.base)  # a quotient prints what it divides by, and never its reciprocal
        elif part.args and isinstance(part, (Expr, Boolean)):
            seen.add(part)
            waiting += part.args
        else:
            waiting += part.args
    return found


class _Sharing(ArrayPrinter):
    """Prints a part that stands in several expressions once, on a line before them.

    The order of a product's factors is its own whatever they share: a column has the same bits in any
    company.
    """

    def __init__(self, shared: set[Any], lines: list[str], names: set[str]) -> None:
        super().__init__()
        self.shared, self.lines, self.names = shared, lines, names
        self.named: dict[Any, str] = {}

    def _print(self, expr: Any, **options: Any) -> str:
        return self.name(expr) if expr in self.shared else str(super()._print(expr, **options))

    def parenthesize(self, item: Any, level: int, strict: bool = False) -> str:
        return self.name(item) if item in self.shared else str(super().parenthesize(item, level, strict))

    def _print_Pow(self, expr: Any, rational: bool = False) -> str:
        base, exponent = expr.args
        if exponent in (2, 3, 4) and not base.is_Symbol:
            return "(" + "*".join([self.name(base)] * int(exponent)) + ")"
        return super()._print_Pow(expr, rational=rational)

    def name(self, expr: Any) -> str:
        """The name of a part."""
        if expr not in self.named:
            text = str(super()._print(expr))
            self.named[expr] = free_name(f"t_{len(self.named)}", self.names)
            self.lines.append(f"{self.named[expr]} = {text}")
        return self.named[expr]


class _Writing:
    """The lines so far, and the names that have been given a value in them."""

    def __init__(self, plan: Plan, roots: Mapping[str, Iterable[str]]) -> None:
        self.plan, self.roots = plan, roots
        self.lines: list[str] = []
        self.done: set[Symbol] = set()
        self.kept: dict[tuple[str, str], str] = {}
        self.names = {symbol.name for symbol in plan.leaves}
        self.nodes = [(node, _expressions(node, plan.own)) for node in plan.nodes]
        every = [expression for _, own in self.nodes for expression in own]
        self.printer = _Sharing(_shared(every), self.lines, self.names)

    def node(self, node: Node, values: tuple[Any, ...], before: Container[str]) -> None:
        """The line of a node, after those that it needs."""
        name = node.column.name
        if isinstance(node, Total):
            (terms,) = values
            kept = self.kept_rows(name, node.over.name)
            text = self.text(terms)
            taken = f"total({text})" if node.word == "sum" else f'ordered({text}, "{node.word}")'
            self.define(node.symbol, f"{kept}.{taken}")
            return
        if isinstance(node, Part):
            axis = "None" if node.axis is None else f'"{node.axis.name}"'
            self.define(node.symbol, f'run.part("{node.symbol}", {axis}, {self.text(values[0])})')
            return
        if isinstance(node, LoopNode):
            self.lines.append(f'run.loop("{name}")')
            return
        symbol = self.plan.own[name]
        if isinstance(node, GivenNode):
            self.define(symbol, f'run.data["{name}"]')
            self.define(symbol, f'run.given("{name}", {", ".join([str(symbol), *map(self.text, values)])})')
        elif isinstance(node, Map):
            computed = f'run.formula("{name}", {", ".join(map(self.text, values))})'
            if name in before:
                self.lines.append(computed)
            else:
                self.define(symbol, computed)
        else:
            assert isinstance(node, RootNode)
            named = {symbol.name: symbol for symbol in self.plan.leaves}
            self.need(named[argument] for argument in self.roots[name])
            asked = f", requires=({', '.join(map(self.text, values))},)" if values else ""
            arguments = ", ".join(self.roots[name])
            self.define(symbol, f'run.root("{name}", [{arguments}]{asked})')

    def text(self, expression: Any) -> str:
        """An expression, after the lines of what it names."""
        self.need(expression.free_symbols)
        return printed(self.printer, expression)

    def need(self, symbols: Iterable[Symbol]) -> None:
        for symbol in sorted(symbols, key=str):
            if symbol in self.done:
                continue
            if symbol in self.plan.leaves:
                self.define(symbol, self.fetched(self.plan.leaves[symbol]))

    def fetched(self, leaf: Leaf) -> str:
        """How a leaf comes by its array."""
        if leaf.kind == "cells":
            if leaf.index is None:
                return f'run.value["{leaf.name}"]'
            assert leaf.axis is not None
            return f'run.rows("{leaf.name}", "{leaf.axis.name}", "{leaf.index}")'
        assert leaf.axis is not None
        if leaf.kind == "ordinal":
            return f'run.ordinal("{leaf.axis.name}", "{leaf.index}")'
        if leaf.kind == "size":
            return f'run.size("{leaf.axis.name}")'
        return f"{self.kept_rows(leaf.name, leaf.axis.name)}.number"

    def kept_rows(self, column: str, axis: str) -> str:
        """The rows that the sums of a column keep."""
        if (column, axis) not in self.kept:
            name = self.kept[column, axis] = free_name(f"kept_{len(self.kept)}", self.names)
            self.lines.append(f'{name} = run.kept("{column}", "{axis}")')
        return self.kept[column, axis]

    def define(self, symbol: Symbol, text: str) -> None:
        self.lines.append(f"{symbol} = {text}")
        self.done.add(symbol)
