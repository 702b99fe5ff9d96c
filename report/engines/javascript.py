"""The JavaScript engine: prints each rule as a function of a row, for the page that recalculates itself.

The program is an object literal: the index sets, and for each column the cells it names and its functions.
templates/engines/runtime.js runs it, in a browser or in node.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from itertools import count
from pathlib import Path
from typing import Any

from sympy import Basic, Dummy, Indexed, Sum, Symbol, cse, numbered_symbols
from sympy.printing.jscode import JavascriptCodePrinter

from ...derivations.reductions import Median
from ..plan.domain import defined, positive, typed
from ..sheet import Axis, Column, Formula, Given, PairAxis, RepeatAxis, Root, Sheet, name_of
from .certified import certified, slope
from .javascript_intervals import enclose, needed

__all__ = ["RUNTIME", "program"]

RUNTIME = Path(__file__).resolve().parents[2] / "templates" / "engines" / "runtime.js"
"""What runs a program."""

_NULL = Dummy()
"""JavaScript's null."""


class Printer(JavascriptCodePrinter):
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

    def _print_Infinity(self, expr: Any) -> str:
        return "Infinity"


class _Scope:
    """Prints the functions of one column and, before them, what they share.

    That is the arrays of the cells by short names, with a dollar in them that no column's name has, and the
    totals that do not move with the unknown.
    """

    def __init__(self, sheet: Sheet, column: Column, unknown: Symbol | None) -> None:
        self.sheet, self.column, self.unknown = sheet, column, unknown
        self.printer = Printer()
        self.names: dict[str, str] = {}
        self.head: list[str] = []
        self.fixed: dict[Sum, Symbol] = {}
        self.numbers = count()

    def leaf(self, cell: Basic, axis: Axis | None, row: str) -> Symbol:
        """A cell as JavaScript: a symbol whose name is the text to print."""
        if cell == self.unknown:
            text = "u"
        elif cell == _NULL:
            text = "null"
        elif cell in self.sheet.sizes:
            text = f"n.{self.sheet.sizes[cell].name}"
        elif isinstance(cell, Indexed):
            assert axis is not None
            name, index = name_of(cell), cell.indices[0]
            if index != axis.index:
                row = f"{self.named(f'{axis.name}${index}', f'a.{axis.name}.rows.{index}')}[{row}]"
            text = f"{self.named(f'${name}', f'c.{name}')}[{row}]"
        elif axis is not None and cell in axis.ordinals:
            text = f"{self.named(f'{axis.name}${cell}', f'a.{axis.name}.ordinals.{cell}')}[{row}]"
        else:
            text = self.named(f"${cell}", f"c.{cell}[0]")
        return Symbol(text, **cell.assumptions0)

    def named(self, name: str, text: str) -> str:
        self.names[name] = text
        return name

    def plain(self, expression: Any, axis: Axis | None, row: str, sums: dict[Sum, Symbol]) -> Any:
        """Replace cells by what is printed for them, sums and medians by the names of what they come to."""
        if isinstance(expression, Median):
            return self.median(expression)
        if isinstance(expression, Sum):
            # Twice a sum is not another sum.
            number, terms = expression.function.as_coeff_Mul()
            total = Sum(terms, *expression.limits)
            name = self.fixed.get(total) or sums.get(total) or Symbol(f"S{next(self.numbers)}", real=True)
            if total not in self.fixed:
                sums[total] = name
            return number * name
        if isinstance(expression, (Indexed, Symbol)):
            return self.leaf(expression, axis, row)
        if not expression.args:
            return expression
        return expression.func(*(self.plain(argument, axis, row, sums) for argument in expression.args))

    def median(self, taken: Median) -> Symbol:
        """The name of a median: it is taken once, at the head."""
        axis = self.sheet.indices[taken.limits[0][0]]
        name = Symbol(f"M{next(self.numbers)}", **taken.assumptions0)
        term = self.printer.doprint(self.plain(taken.function, axis, "q", {}))
        self.head.append(f"      const {name} = median(k.{axis.name}, (q) => {term});")
        return name

    def body(self, expressions: Sequence[Any], indent: str) -> tuple[list[str], list[str]]:
        """Statements that compute what expressions have in common, and the texts of the expressions."""
        common, reduced = cse(list(expressions), symbols=numbered_symbols("t_"), order="none", list=True)
        lines = [f"{indent}const {name} = {self.printer.doprint(value)};" for name, value in common]
        return lines, [self.printer.doprint(value) for value in reduced]

    def function(self, *expressions: Any, alone: bool = False) -> str:
        """A function of the row (and the unknown): it returns the expressions' values, or the only one's."""
        sums: dict[Sum, Symbol] = {}
        plain = [self.plain(e, self.column.axis, "r", sums) for e in expressions]
        lines, texts = self.body(plain, "      ")
        lines = self.totals(sums) + lines
        result = texts[0] if alone else f"[{', '.join(texts)}]"
        if not lines:
            return f"(r, u) => {result}"
        return "\n".join(["(r, u) => {", *lines, f"      return {result};", "    }"])

    def enclose(self, rule: Root) -> str:
        """The function of the row and an interval of the unknown that tells the form and its slope there."""
        plain = Symbol(rule.unknown.name, real=True)
        form = typed(self.sheet, rule.expression).xreplace({rule.unknown: plain})
        steepness, known = slope(form, plain)
        axes = self.sheet.indices

        def terms(total: Sum) -> tuple[str, Any]:
            axis = axes[total.limits[0][0]]
            inner: dict[Sum, Symbol] = {}
            body = self.plain(total.function, axis, "q", inner)
            return axis.name, Symbol("ALL") if inner else body

        fixed, self.fixed, self.unknown = self.fixed, {}, plain
        text = enclose(form, steepness, known, lambda e, s: self.plain(e, self.column.axis, "r", s), terms)
        self.fixed, self.unknown = fixed, rule.unknown
        return text

    def moves(self, expression: Any) -> bool:
        return self.unknown is not None and bool(expression.has(self.unknown))

    def totals(self, sums: dict[Sum, Symbol]) -> list[str]:
        """Statements for the sums that move with the unknown; all others are taken once, at the head."""
        still = {total: name for total, name in sums.items() if not self.moves(total)}
        self.fixed |= still
        self.head += self.passes(still)
        return self.passes({total: name for total, name in sums.items() if total not in still})

    def passes(self, sums: dict[Sum, Symbol]) -> list[str]:
        """One pass over each axis for all its sums: they share most of their work."""
        lines: list[str] = []
        for axis in self.sheet.axes:
            mine = [total for total in sums if total.limits[0][0] == axis.index]
            if not mine:
                continue
            inner: dict[Sum, Symbol] = {}
            terms = [self.plain(total.function, axis, "q", inner) for total in mine]
            lines += self.totals(inner)
            common, texts = self.body(terms, " " * 10)
            parts = [f"s_{n}" for n in range(len(mine))]
            lines += [
                f"      const [{', '.join(sums[total].name for total in mine)}] = "
                f"total(k.{axis.name}, {len(mine)}, (q, end, kept) => {{",
                f"        let {', '.join(f'{part} = 0' for part in parts)};",
                "        for (; q < end; q++) if (kept[q]) {",
                *common,
                *(f"          {part} += {text};" for part, text in zip(parts, texts, strict=True)),
                "        }",
                f"        return [{', '.join(parts)}];",
                "      });",
            ]
        return lines


def _kernels(sheet: Sheet, column: Column) -> str:
    """The functions of a column, by the names that the runtime calls them; nothing for a given one."""
    rule = column.rule
    scope = _Scope(sheet, column, rule.unknown if isinstance(rule, Root) else None)
    found: dict[str, str] = {}
    if isinstance(rule, Formula):
        value, formula = scope.function(rule.expression, alone=True), typed(sheet, rule.expression)
        if (domain := defined(formula)) != True:  # noqa: E712 - sympy's true
            found["defined"] = scope.function(domain, alone=True)
        if column.positive and (sign := positive(formula)) not in (True, False):
            found["positive"] = scope.function(sign, alone=True)
        found["value"] = value
    elif isinstance(rule, Root):
        # An end whose sign is not given is evaluated as any other point.
        signs = [_NULL if sign is None else sign for sign in (rule.sign_low, rule.sign_high)]
        known = certified(sheet, column)
        ends = [rule.low, rule.high, *signs, *(rule.turning if known else ())]
        found["ends"] = scope.function(*ends)
        if not known:
            found |= {"isolate": "", "enclose": scope.enclose(rule)}
        found["at"] = scope.function(rule.expression, alone=True)
        found["value"] = scope.function(rule.value, alone=True)
    if column.requires:
        found["requires"] = scope.function(*(condition for condition, _ in column.requires))
    if not found:
        return ""
    arrays = ", ".join(f"{name} = {text}" for name, text in sorted(scope.names.items()))
    lines = [f"      const {arrays};"] if arrays else []
    inner = ",\n".join(
        f"    {name}: {function}" if function else f"    {name}" for name, function in found.items()
    )
    return "\n".join(["(c, a, n, k) => {", *lines, *scope.head, f"    return {{\n{inner}\n    }};", "  }"])


def _references(sheet: Sheet, column: Column) -> Iterable[tuple[str, str | None, str | None]]:
    """The cells that a column names: the column, the index, and the axis whose rows the index belongs to."""
    for reference in sheet.named(column):
        cell, scope = reference.cell, reference.over or column.axis
        if isinstance(cell, Indexed) and scope is not None:
            yield name_of(cell), str(cell.indices[0]), scope.name
        else:
            yield name_of(cell), None, None if reference.over is None else reference.over.name


def _axis(axis: Axis) -> dict[str, str]:
    entry = {"name": axis.name, "kind": "given", "index": str(axis.index)}
    if isinstance(axis, PairAxis):
        entry |= {"kind": "pairs", "of": axis.of.name, "first": str(axis.first), "second": str(axis.second)}
    elif isinstance(axis, RepeatAxis):
        entry |= {"kind": "repeat", "of": axis.of.name, "step": str(axis.step), "count": axis.count}
    return entry


def program(sheet: Sheet, constants: Mapping[str, float] | None = None) -> str:
    """The sheet as a JavaScript object literal, for ``evaluateSheet`` of the runtime.

    Parameters
    ----------
    sheet : Sheet
    constants : mapping of column name to float
        Given scalars that are no input of the user's.
    """
    columns = []
    for column in sheet.order:
        kind = {Given: "given", Formula: "formula", Root: "root"}[type(column.rule)]
        entry: dict[str, Any] = {
            "name": column.name,
            "axis": None if column.axis is None else column.axis.name,
            "kind": kind,
            "refs": [] if kind == "given" else [_least(each) for each in _references(sheet, column)],
            "sums": [axis.name for axis in sheet.summed_axes(column)],
            "positive": kind != "given" and int(column.positive),
        }
        if isinstance(column.rule, Formula) and column.positive:
            # 2 is positive by what is assumed of the cells: then a zero is a value that no double holds.
            entry["positive"] += positive(typed(sheet, column.rule.expression)) == True  # noqa: E712
        parts = [f"{name}: {json.dumps(value)}" for name, value in entry.items() if value]
        if column.name in sheet.guards:
            datum, allowed = sheet.guards[column.name]
            x = Symbol("x", real=True)
            parts.append(f"allows: (x) => {Printer().doprint(allowed.xreplace({datum: x}))}")
        kernels = _kernels(sheet, column)
        if kernels:
            parts.append(f"kernels: {kernels}")
        columns.append(f"  {{{', '.join(parts)}}}")
    axes = ", ".join(json.dumps(_axis(axis)) for axis in sheet.axes)
    fixed = json.dumps({name: [value] for name, value in (constants or {}).items()})
    listed = ",\n".join(columns)
    text = f'{{\n "constants": {fixed},\n "axes": [{axes}],\n "columns": [\n{listed}\n ]{_WHOLE}\n}}'
    used = needed(text)
    return f"(() => {{\n{used}\nreturn {text};\n}})()" if used else text


_WHOLE = (
    ".map(({ refs = [], ...column }) => ({ axis: null, sums: [], ...column, "
    "refs: refs.map(([name, index = null, over = null]) => [name, index, over]) }))"
)
"""What a column leaves out is put in again."""


def _least(reference: tuple[str | None, ...]) -> list[str | None]:
    """What is left of a reference without the nulls at its end."""
    parts = list(reference)
    while parts[-1] is None:
        parts.pop()
    return parts
