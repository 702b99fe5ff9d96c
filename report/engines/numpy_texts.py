"""The NumPy program of a sheet, printed: texts that are made once, and of which it runs whatever the data."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from sympy import Expr, Integer, Symbol

from ...derivations.differentiated import differentiated
from ..plan.nodes import LoopNode, Map, Plan, RootNode, RowSum, taken_over
from ..sheet import Sheet
from .certified import certified, enclosing
from .numpy_code import kernel, write
from .numpy_sheet import sheet_function
from .roots import hoist, magnitude, step


def program_texts(sheet: Sheet, plan: Plan) -> dict[str, Any]:
    """The functions of a plan, printed: data of which :class:`Program` is made.

    Parameters
    ----------
    plan : Plan
        What computes something of it.

    Raises
    ------
    SheetError
        A formula has a part that NumPy cannot compute.
    """
    nodes = {node.column.name: node for node in plan.nodes if isinstance(node, RootNode)}
    roots = {name: root_texts(sheet, plan, node) for name, node in nodes.items()}
    asked = {name: texts["arguments"] for name, texts in roots.items()}
    loops = {name: loop_texts(plan, node) for name, node in plan.loops.items()}
    return {"sheet": sheet_function(plan, asked), "roots": roots, "loops": loops}


def loop_texts(plan: Plan, node: LoopNode) -> dict[str, Any]:
    """The functions of a loop, printed: what it starts from, and a pass."""
    start = sheet_function(Plan(node.starts, plan.leaves), {})
    once = sheet_function(Plan(node.body, plan.leaves), {}, node.columns)
    formulas = dict.fromkeys(each.column.name for each in node.body if isinstance(each, Map))
    iterated = [column.name for column in node.columns]
    return {
        "iterated": iterated,
        "formulas": [name for name in formulas if name not in iterated],
        "start": start,
        "pass": once,
    }


def root_texts(sheet: Sheet, plan: Plan, node: RootNode) -> dict[str, Any]:
    """The functions of one root, printed: data of which :class:`RootProgram` is made."""
    enclosed = None if certified(sheet, node.column) else enclosing(sheet, plan, node)
    if enclosed is not None:
        node = replace(node, turning=())  # what nobody proved is not used
    unknown, constants = node.unknown, dict[Expr, Symbol]()
    f, value = (hoist(each, unknown, constants) for each in (node.form, node.value))
    ends = [
        Integer(0) if end is None else end  # no sign is given: the equation is evaluated
        for end in (node.low, node.high, node.start, node.sign_low, node.sign_high, *node.turning)
    ]
    # Cells that need no computation are constants too.
    axes = {Symbol(axis) for axis in taken_over([f, value])}
    cells = sorted((f.free_symbols | value.free_symbols) - {unknown, *constants.values(), *axes}, key=str)
    fixed = kernel([*ends, *constants, *cells])
    arguments = [unknown, *constants.values(), *cells]
    totals = taken_over([f, value])
    parts, back = step(f, unknown)
    asked = {*fixed.arguments, *(() if enclosed is None else enclosed.arguments)} - {unknown.name}
    named = plan.named
    return {
        "arguments": {name: (axis := named[name].axis) and axis.name for name in sorted(asked)},
        "terms_of": sorted(terms_of(node)),
        "told": [node.sign_low is not None, node.sign_high is not None],
        "turning": len(node.turning),
        "steps": node.steps,
        "fixed": fixed.plain,
        "constants": kernel([*constants, *cells]).plain,
        "totals": totals,
        "at": write(arguments, totals, [f]),
        "newton": write(arguments, totals, [f, f / differentiated(f, unknown)]),
        "step": write(arguments, totals, [f, back], parts),
        "check": write(arguments, totals, [f, magnitude(f)]),
        "value": write(arguments, totals, [value]),
        "enclosing": enclosed and enclosed.plain,
    }


def terms_of(node: RootNode) -> frozenset[str]:
    """The names of what stands in the sums of a root's equation: its rows are their terms."""
    return frozenset(symbol.name for total in node.form.atoms(RowSum) for symbol in total.free_symbols)


def condition_texts(plan: Plan, name: str) -> list[Any]:
    """Where a formula is positive although no double may hold it, and where it has a value at all."""
    node = next(n for n in plan.every if isinstance(n, Map) and n.column.name == name)
    return [_texts_of(each, plan) for each in (node.positive, node.defined)]


def _texts_of(condition: Any, plan: Plan) -> Any:
    """A condition on the cells that a column names, printed, as data: what it reads of each leaf, and how."""
    if condition in (True, False):
        return bool(condition)
    asked = kernel([condition])
    leaves = [plan.named[name] for name in asked.arguments]
    reads = [(leaf.kind, leaf.name, leaf.axis and leaf.axis.name, leaf.index) for leaf in leaves]
    return {"kernel": asked.plain, "reads": reads}
