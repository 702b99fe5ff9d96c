"""A plan as text that a person can read: a node a line, then what its symbols stand for."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any

from sympy import Ne, Or, default_sort_key
from sympy.printing.str import StrPrinter

from .nodes import GivenNode, Leaf, LoopNode, Map, Node, Part, Plan, RootNode, Total, expressions


class _Printer(StrPrinter):
    """Formulas as a person types them."""

    def _print_Relational(self, expr: Any) -> str:
        word = "!=" if isinstance(expr, Ne) else expr.rel_op
        return f"{self._print(expr.lhs)} {word} {self._print(expr.rhs)}"

    def _print_And(self, expr: Any) -> str:
        parts = sorted(expr.args, key=default_sort_key)
        return " and ".join(f"({self._print(p)})" if isinstance(p, Or) else self._print(p) for p in parts)

    def _print_Or(self, expr: Any) -> str:
        return " or ".join(map(self._print, sorted(expr.args, key=default_sort_key)))


def _plain(expr: Any) -> str:
    return str(_Printer({"full_prec": False}).doprint(expr))


def text(plan: Plan, columns: Collection[str] | None = None) -> str:
    """Write a plan, or the nodes of some columns.

    `columns`: all of them, if it is left out.
    """
    nodes = [node for node in plan.nodes if columns is None or _names(node) & set(columns)]
    lines = [line for node in nodes for line in _node(plan, node)]
    named = {symbol.name for node in nodes for each in expressions(node) for symbol in each.free_symbols}
    told = [(name, _stands_for(leaf)) for name, leaf in plan.named.items() if name in named]
    legend = [f"{name} = {said}" for name, said in sorted(told) if said]
    return "\n".join([*lines, *(["", *legend] if legend else [])]) + "\n"


def _names(node: Node) -> set[str]:
    """The columns that a node computes, or takes part in."""
    return {each.column.name for each in (node.body if isinstance(node, LoopNode) else (node,))}


def _on(node: GivenNode | Map | RootNode) -> str:
    return f" on {node.column.axis.name}" if node.column.axis is not None else ""


def _node(plan: Plan, node: Node) -> Iterator[str]:
    """The lines of a node: what it is, then what is asked of it."""
    if isinstance(node, Total):
        yield f"{node.symbol}: {node.word} over {node.over.name} of {_plain(node.terms)}"
        return
    if isinstance(node, Part):
        on = "" if node.axis is None else f" on {node.axis.name}"
        yield f"{node.symbol}{on} = {_plain(node.value)}"
        return
    if isinstance(node, LoopNode):
        yield f"{', '.join(str(plan.own[column.name]) for column in node.columns)}: again and again"
        for title, own in (("from", node.starts), ("then", node.body)):
            yield f"    {title}"
            yield from (f"        {line}" for each in own for line in _node(plan, each))
        return
    name = f"{plan.own[node.column.name]}{_on(node)}"
    if isinstance(node, GivenNode):
        yield f"{name}: given"
        if node.allowed is not None:
            yield f"    allowed: {_plain(node.allowed)}"
        return
    if isinstance(node, Map):
        yield f"{name} = {_plain(node.value)}"
        if str(node.defined) != "True":
            yield f"    defined: {_plain(node.defined)}"
        if str(node.noticed) != "True":
            yield f"    finite only if: {_plain(node.noticed)}"
        if str(node.positive) not in ("True", "False"):
            yield f"    positive: {_plain(node.positive)}"
    else:
        yield f"{name} = {_plain(node.value)} for the only root {node.unknown} of"
        yield f"    0 = {_plain(node.form)}"
        yield f"    between: {_plain(node.low)} and {_plain(node.high)}"
        signs = ((node.sign_low, "lower"), (node.sign_high, "upper"))
        yield from (f"    sign at the {end} end: {sign}" for sign, end in signs if sign is not None)
        yield from (f"    turning at: {_plain(point)}" for point in node.turning)
        yield f"    start: {_plain(node.start)}, {node.steps} steps"
    yield from (f"    requires: {_plain(condition)}" for condition in node.requires)


def _stands_for(leaf: Leaf) -> str:
    """What a symbol stands for that is not called as it is."""
    axis = "" if leaf.axis is None else leaf.axis.name
    if leaf.kind == "cells" and leaf.index is not None:
        return f"{leaf.written} on {axis}"
    if leaf.kind == "size":
        return f"number of {axis}"
    if leaf.kind == "kept":
        return f"number of {axis} that the sums of {leaf.name} keep"
    if leaf.kind == "ordinal":
        return f"running number {leaf.index} on {axis}"
    return ""
