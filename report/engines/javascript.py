"""The JavaScript engine: prints each rule as a function of a row, for the page that recalculates itself.

The program is an object literal: the index sets, and for each column the cells it names and its functions.
templates/engines/runtime.js runs it, in a browser or in node.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import count, groupby
from pathlib import Path
from typing import Any

from sympy import Expr, Piecewise, Symbol, cse, numbered_symbols
from sympy.core.symbol import Str
from sympy.printing.jscode import JavascriptCodePrinter

from ..plan.lowering import lowered
from ..plan.nodes import GivenNode, Leaf, LoopNode, Map, OverRows, Plan, RootNode, RowOrder, RowSum, Total
from ..plan.nodes import Node as PlanNode
from ..sheet import Axis, Column, CountedAxis, GroupAxis, MemberAxis, PairAxis, RepeatAxis, Sheet
from .certified import certified, slope, typed_form
from .javascript_intervals import NOTHING, enclose, needed

_TEMPLATES = Path(__file__).resolve().parents[2] / "templates"
RUNTIME = _TEMPLATES / "minified" / "runtime.js"
"""What runs a program."""
LOOPS = _TEMPLATES / "minified" / "loops.js"
"""What a program with loops brings along."""

_ASKS = re.compile(r"\bu\b")
"""A function that asks for the unknown."""
_NULL = Symbol("null", real=True)
"""JavaScript's null."""
_FURTHER = "{0}.reduce((m, kept, q) => kept && !(m %s {1}) ? {1} : m, NaN)"
_BY_ORDER = {"median": "median({0}, (q) => {1})", "max": _FURTHER % ">=", "min": _FURTHER % "<="}
"""What is taken by order of terms over the rows that are kept; NaN where there is none."""


class JavaScriptPrinter(JavascriptCodePrinter):
    """sympy's JavaScript, with small powers multiplied out as NumPy does."""

    def _print_Pow(self, expr: Any) -> str:
        base, exponent = expr.args
        if exponent in (2, 3) and base.is_Atom:
            return "(" + "*".join([self._print(base)] * int(exponent)) + ")"
        if exponent.is_Integer and exponent < -1:
            return f"(1/{self.parenthesize(base**-exponent, 70)})"
        return str(super()._print_Pow(expr))

    def _print_Max(self, expr: Any) -> str:
        return f"Math.max({', '.join(self._print(a) for a in sorted(expr.args, key=str))})"

    def _print_Min(self, expr: Any) -> str:
        return f"Math.min({', '.join(self._print(a) for a in sorted(expr.args, key=str))})"

    def _print_Unequality(self, expr: Any) -> str:
        return f"({self._print(expr.lhs)} !== {self._print(expr.rhs)})"

    def _print_BooleanTrue(self, expr: Any) -> str:
        return "true"

    def _print_BooleanFalse(self, expr: Any) -> str:
        return "false"

    def _print_NaN(self, expr: Any) -> str:
        return "NaN"

    def _print_Infinity(self, expr: Any) -> str:
        return "Infinity"


class _Scope:
    """Prints the functions of one column and, before them, what they share.

    That is the arrays of the cells by short names, with a dollar in them that no column's name has, and the
    totals of the plan.
    """

    def __init__(self, plan: Plan, unknown: Symbol | None) -> None:
        self.plan, self.unknown = plan, unknown
        self.printer = JavaScriptPrinter()
        self.names: dict[str, str] = {}
        self.head: list[str] = []
        self.totals: dict[Expr, Symbol] = {}
        """What is taken over rows, by itself and by the symbols of the plan."""
        self.of_groups: set[Symbol] = set()
        """Those that have a number for each group."""
        self.numbers = count()

    # --- what symbols stand for

    def leaf(self, symbol: Symbol, row: str) -> Symbol:
        """A symbol as JavaScript: one whose name is the text to print."""
        if symbol == self.unknown:
            return Symbol("u", **symbol.assumptions0)
        leaf = self.plan.named.get(symbol.name)
        if leaf is None:
            return symbol
        if leaf.kind == "total":
            return self.taken(symbol, row)
        text = {"cells": self.cells, "ordinal": self.ordinal}.get(leaf.kind, self.size)(leaf, row)
        return Symbol(text, **symbol.assumptions0)

    def cells(self, leaf: Leaf, row: str) -> str:
        if leaf.axis is None:
            return self.named(f"${leaf.name}", f"c.{leaf.name}[0]")
        if leaf.index is not None:
            axis, index = leaf.axis.name, leaf.index
            row = f"{self.named(f'{axis}${index}', f'a.{axis}.rows.{index}')}[{row}]"
        return f"{self.named(f'${leaf.name}', f'c.{leaf.name}')}[{row}]"

    def ordinal(self, leaf: Leaf, row: str) -> str:
        assert leaf.axis is not None
        axis, index = leaf.axis.name, leaf.index
        return f"{self.named(f'{axis}${index}', f'a.{axis}.ordinals.{index}')}[{row}]"

    def size(self, leaf: Leaf, _: str) -> str:
        assert leaf.axis is not None
        return f"n.{leaf.axis.name}"

    def named(self, name: str, text: str) -> str:
        self.names[name] = text
        return name

    def plain(self, expression: Any, row: str, moving: dict[Expr, Symbol] | None = None) -> Any:
        """Replace symbols by what is printed for them, sums by the names of what they come to.

        Those that are not known are new ones, in `moving`.
        """
        if isinstance(expression, OverRows):
            own = expression.xreplace({s: self.own(s) for s in expression.free_symbols})
            if own in self.totals or isinstance(expression, RowOrder):
                return self.taken(own, row)
            assert moving is not None
            if expression not in moving:
                moving[expression] = self.new("S")
            return moving[expression]
        if isinstance(expression, Symbol):
            return self.leaf(expression, row)
        if not expression.args:
            return expression
        return expression.func(*(self.plain(argument, row, moving) for argument in expression.args))

    def taken(self, total: Expr, row: str) -> Symbol:
        """What something taken over rows is called: where it is taken over each group, that of a row."""
        name = self.totals[total]
        return Symbol(f"{name}[{row}]", **name.assumptions0) if name in self.of_groups else name

    def own(self, symbol: Symbol) -> Symbol:
        """The plan's symbol, if nothing more is assumed of this one than of that."""
        leaf = self.plan.named.get(symbol.name)
        return next((s for s, each in self.plan.leaves.items() if each is leaf), symbol) if leaf else symbol

    def new(self, letter: str) -> Symbol:
        return Symbol(f"{letter}{next(self.numbers)}", real=True)

    # --- totals of the plan

    def take(self, totals: Sequence[Total]) -> None:
        """Statements for totals, those of one axis in one pass unless one names another."""
        waiting: dict[Expr, Symbol] = {}
        over = ""
        for total in totals:
            axis = Symbol(total.over.name)
            if total.word != "sum" or axis.name != over or total.terms.free_symbols & set(self.totals):
                self.head += self.passes(waiting)
                waiting, over = {}, axis.name
            name = self.new("S" if total.word == "sum" else "M")
            self.totals[total.symbol] = name
            if total.word == "sum":
                self.totals[RowSum(total.terms, axis)] = waiting[RowSum(total.terms, axis)] = name
            else:
                self.totals[RowOrder(total.terms, axis, Str(total.word))] = name
                term = self.printer.doprint(self.plain(total.terms, "q"))
                taken = _BY_ORDER[total.word]
                if isinstance(total.over, MemberAxis):
                    self.of_groups.add(name)
                    taken = f"ofGroups({{0}}, a.{axis}.starts, (kept) => {taken.format('kept', '{1}')})"
                self.head.append(f"      const {name} = {taken.format(f'k.{axis}', term)};")
        self.head += self.passes(waiting)

    def passes(self, sums: dict[Expr, Symbol]) -> list[str]:
        """One pass over each axis for all its sums: they share most of their work."""
        lines: list[str] = []
        for axis in dict.fromkeys(total.args[1].name for total in sums):
            mine = [total for total in sums if total.args[1].name == axis]
            grouped = isinstance(self.plan.axes[axis], MemberAxis)
            self.of_groups |= {sums[total] for total in mine} if grouped else set()
            inner: dict[Expr, Symbol] = {}
            terms = [self.plain(total.args[0], "q", inner) for total in mine]
            lines += self.passes(inner)
            common, texts = self.body(terms, " " * 10)
            parts = [f"s_{n}" for n in range(len(mine))]
            lines += [
                f"      const [{', '.join(sums[total].name for total in mine)}] = "
                f"{'totals' if grouped else 'total'}(k.{axis}, {len(mine)}, (q, end, kept) => {{",
                f"        let {', '.join(f'{part} = 0' for part in parts)};",
                "        for (; q < end; q++) if (kept[q]) {",
                *common,
                *(f"          {part} += {text};" for part, text in zip(parts, texts, strict=True)),
                "        }",
                f"        return [{', '.join(parts)}];",
                f"      }}, a.{axis}.starts);" if grouped else "      });",
            ]
        return lines

    # --- functions

    def body(self, expressions: Sequence[Any], indent: str) -> tuple[list[str], list[str]]:
        """Statements that compute what expressions have in common, and the texts of the expressions."""
        common, reduced = cse(list(expressions), symbols=numbered_symbols("t_"), order="none", list=True)
        named = ", ".join(f"{name} = {self.printer.doprint(value)}" for name, value in common)
        return [f"{indent}const {named};"] * bool(named), [self.printer.doprint(value) for value in reduced]

    def function(self, *expressions: Any, alone: bool = False) -> str:
        """A function of the row (and the unknown): it returns the expressions' values, or the only one's."""
        moving: dict[Expr, Symbol] = {}
        plain = [self.plain(e, "r", moving) for e in expressions]
        lines, texts = self.body(plain, "      ")
        still = {total: name for total, name in moving.items() if not self.moves(total)}
        self.head += self.passes(still)
        self.totals |= still
        lines = self.passes({total: name for total, name in moving.items() if total not in still}) + lines
        result = texts[0] if alone else f"[{', '.join(texts)}]"
        whole = "\n".join(["{", *lines, f"      return {result};", "    }"]) if lines else result
        return f"{'(r, u)' if _ASKS.search(whole) else 'r'} => {whole}"

    def moves(self, expression: Any) -> bool:
        return self.unknown is not None and bool(expression.has(self.unknown))

    def enclose(self, sheet: Sheet, node: RootNode) -> str:
        """The function of the row and an interval of the unknown that tells the form and its slope there."""
        form, plain = typed_form(sheet, self.plan, node)
        steepness, known = slope(form, plain)

        def terms(total: RowSum) -> tuple[str, Any]:
            inner: dict[Expr, Symbol] = {}
            body = self.plain(total.args[0], "q", inner)
            return total.args[1].name, NOTHING if inner else body

        unknown, self.unknown = self.unknown, plain
        text = enclose(form, steepness, known, lambda e, s: self.plain(e, "r", s), terms)
        self.unknown = unknown
        return text


def _kernels(sheet: Sheet, plan: Plan, nodes: Sequence[PlanNode]) -> str:
    """The functions of a column, by the names that the runtime calls them; nothing for a given one."""
    node = nodes[-1]
    if not isinstance(node, (Map, RootNode)):
        return ""
    scope = _Scope(plan, node.unknown if isinstance(node, RootNode) else None)
    scope.take([each for each in nodes if isinstance(each, Total)])
    found: dict[str, str] = {}
    if isinstance(node, Map):
        value = scope.function(node.value_in_doubles, alone=True)
        if node.defined != True:  # noqa: E712 - sympy's true
            found["defined"] = scope.function(node.defined, alone=True)
        if node.positive not in (True, False):
            found["positive"] = scope.function(node.positive, alone=True)
        found["value"] = value
    else:
        # An end whose sign is not given is evaluated as any other point.
        signs = [_NULL if sign is None else sign for sign in (node.sign_low, node.sign_high)]
        known = certified(sheet, node.column)
        found["ends"] = scope.function(node.low, node.high, *signs, *(node.turning if known else ()))
        if not known:
            found |= {"isolate": "", "enclose": scope.enclose(sheet, node)}
        found["at"] = scope.function(node.form, alone=True)
        found["value"] = scope.function(node.value, alone=True)
    if node.requires:
        found["requires"] = scope.function(*node.requires)
    arrays = ", ".join(f"{name} = {text}" for name, text in sorted(scope.names.items()))
    lines = [f"      const {arrays};"] if arrays else []
    inner = ",\n".join(
        f"    {name}: {function}" if function else f"    {name}" for name, function in found.items()
    )
    return "\n".join(["(c, a, n, k) => {", *lines, *scope.head, f"    return {{\n{inner}\n    }};", "  }"])


def _references(sheet: Sheet, column: Column) -> Iterable[str]:
    """The cells that a column names: the column, the index, and the axis of the sum that it stands in."""
    for reference in sheet.named(column):
        over = reference.over.name if reference.over else ""
        yield f"{reference.name} {reference.index or ''} {over}".rstrip()


def _axis(axis: Axis, sheet: Sheet) -> str:
    entry: dict[str, Any] = {"name": axis.name, "kind": "given", "index": str(axis.index)}
    if isinstance(axis, PairAxis):
        entry |= {"kind": "pairs", "of": axis.of.name, "first": str(axis.first), "second": str(axis.second)}
        chosen = JavaScriptPrinter().doprint(axis.chosen)
        return f'{json.dumps(entry)[:-1]}, "chosen": ({axis.first}, {axis.second}) => {chosen}}}'
    if isinstance(axis, RepeatAxis):
        entry |= {"kind": "repeat", "of": axis.of.name, "step": str(axis.step), "count": axis.count}
    if isinstance(axis, MemberAxis):
        entry |= {"kind": "members", "of": axis.of.name}
    if isinstance(axis, GroupAxis):
        entry |= {"kind": "groups", "of": axis.members.name}
    if isinstance(axis, CountedAxis):
        entry |= {"kind": "counted", "step": str(axis.step), "number": axis.number}
    if groups := {each.group_name: each.name for each in axis.grouped(sheet.axes)}:
        entry["groups"] = groups
    return json.dumps(entry)


def program(sheet: Sheet, constants: Mapping[str, float] | None = None) -> str:
    """The sheet as a JavaScript object literal, for ``evaluateSheet`` of the runtime.

    `constants` (mapping of column name to float): given scalars that are no input of the user's.
    """
    plan, columns = lowered(sheet), []
    passes = [each for n in plan.nodes for each in (n.body if isinstance(n, LoopNode) else (n,))]
    starts = [each for loop in plan.loops.values() for each in loop.starts]
    nodes, begun = (
        {name: list(own) for name, own in groupby(each, lambda node: node.column.name)}
        for each in (passes, starts)
    )
    for column in sheet.order:
        node = nodes[column.name][-1]
        kind = _KINDS[type(node)]
        entry: dict[str, Any] = {
            "name": column.name,
            "axis": None if column.axis is None else column.axis.name,
            "kind": "" if kind == "map" else kind,
            "refs": "" if kind == "given" else ",".join(_references(sheet, column)),
            "sums": _unnamed(sheet, column),
            "positive": kind != "given" and int(column.positive),
        }
        if isinstance(node, Map) and column.positive:
            # 2 is positive by what is assumed of the cells: then a zero is a value that no double holds.
            entry["positive"] += node.positive == True  # noqa: E712
        if isinstance(node, Map) and _is_one_of_several(node.value):
            entry["jumps"] = 1
        parts = [f"{name}: {json.dumps(value)}" for name, value in entry.items() if value]
        if isinstance(node, GivenNode) and node.allowed is not None:
            x = Symbol("x", real=True)
            parts.append(
                f"allows: x => {JavaScriptPrinter().doprint(node.allowed.xreplace({node.datum: x}))}"
            )
        kernels = _kernels(sheet, plan, nodes[column.name])
        if kernels:
            parts.append(f"kernels: {kernels}")
        if column.name in sheet.loop_of:
            parts.append(f'loop: "{sheet.loop_of[column.name].name}"')
        if column.name in begun:
            parts.append(f"start: {_kernels(sheet, plan, begun[column.name])}")
        columns.append(f"  {{{', '.join(parts)}}}")
    axes = ", ".join(_axis(axis, sheet) for axis in sheet.axes)
    fixed = json.dumps({name: [value] for name, value in (constants or {}).items()})
    listed = ",\n".join(columns)
    settle = " settle,\n" if sheet.loops else ""
    text = f'{{\n{settle} "constants": {fixed},\n "axes": [{axes}],\n "columns": [\n{listed}\n ]{_WHOLE}\n}}'
    used = needed(text)
    if sheet.loops:
        used += LOOPS.read_text(encoding="utf-8")
    return f"(() => {{\n{used}\nreturn {text};\n}})()" if used else text


def _is_one_of_several(value: Expr) -> bool:
    """Whether a value is one of several constants: it has no slope, and between them it jumps."""
    return isinstance(value, Piecewise) and all(piece.is_number for piece, _ in value.args)


_KINDS = {GivenNode: "given", Map: "map", RootNode: "root"}
_WHOLE = """.map(({ refs: named = "", ...column }) => {
  const refs = named.split(",").filter(Boolean).map((one) => [0, 1, 2].map((n) => one.split(" ")[n] || null));
  const sums = [...new Set(refs.flatMap((one) => one[2] ?? []))];
  return { axis: null, kind: "map", refs, sums, ...column };
})"""
"""What a column leaves out is put in again."""


def _unnamed(sheet: Sheet, column: Column) -> list[str]:
    """The axes that a column sums over, if its references do not tell them: a sum may count rows only."""
    summed = [axis.name for axis in sheet.summed_axes(column)]
    named = {each.over.name for each in sheet.named(column) if each.over}
    return [] if named == set(summed) else summed
