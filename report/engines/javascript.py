"""The JavaScript engine: prints each rule as a function of a row, for the page that recalculates itself.

The program is an object literal: the index sets, and for each column the cells it names and its functions.
templates/engines/runtime.js runs it, in a browser or in node.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from sympy import Basic, Indexed, Sum, Symbol, cse, numbered_symbols
from sympy.printing.jscode import JavascriptCodePrinter

from ..sheet import Axis, Column, Formula, Given, PairAxis, RepeatAxis, Root, Sheet, name_of
from .roots import derivatives, householder, magnitude

__all__ = ["RUNTIME", "program"]

RUNTIME = Path(__file__).resolve().parents[2] / "templates" / "engines" / "runtime.js"


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

    def _print_Infinity(self, expr: Any) -> str:
        return "Infinity"


class _Scope:
    """Prints the expressions of one column: which array a cell is, which row of it, which sums it needs."""

    def __init__(self, sheet: Sheet, column: Column, unknown: Symbol | None) -> None:
        self.sheet, self.column, self.unknown = sheet, column, unknown
        self.printer = Printer()

    def leaf(self, cell: Basic, axis: Axis | None, row: str) -> Symbol:
        """A cell as JavaScript: a symbol whose name is the text to print."""
        if cell == self.unknown:
            text = "u"
        elif cell in self.sheet.sizes:
            text = f"n.{self.sheet.sizes[cell].name}"
        elif isinstance(cell, Indexed):
            assert axis is not None
            index = cell.indices[0]
            where = row if index == axis.index else f"a.{axis.name}.rows.{index}[{row}]"
            text = f"c.{name_of(cell)}[{where}]"
        elif axis is not None and cell in axis.ordinals:
            text = f"a.{axis.name}.ordinals.{cell}[{row}]"
        else:
            text = f"c.{cell}[0]"
        return Symbol(text, **cell.assumptions0)

    def plain(self, expression: Any, axis: Axis | None, row: str, sums: list[Sum]) -> Any:
        """Replace cells by what is printed for them, and sums by elements of an array of totals."""
        if isinstance(expression, Sum):
            if expression not in sums:
                sums.append(expression)
            return Symbol(f"T[{sums.index(expression)}]", real=True)
        if isinstance(expression, (Indexed, Symbol)):
            return self.leaf(expression, axis, row)
        if not expression.args:
            return expression
        return expression.func(*(self.plain(argument, axis, row, sums) for argument in expression.args))

    def body(self, expressions: Sequence[Any], indent: str, assign: str = "") -> list[str]:
        """Statements that compute expressions, common parts once; the last returns or assigns them."""
        common, reduced = cse(list(expressions), symbols=numbered_symbols("t_"), order="none", list=True)
        lines = [f"{indent}const {name} = {self.printer.doprint(value)};" for name, value in common]
        printed = [self.printer.doprint(value) for value in reduced]
        if assign:
            return lines + [f"{indent}{assign}[{n}] = {text};" for n, text in enumerate(printed)]
        return [*lines, f"{indent}return [{', '.join(printed)}];"]

    def function(self, expressions: Sequence[Any]) -> str:
        """A function of the row (and the unknown) that returns the expressions' values as an array."""
        sums: list[Sum] = []
        plain = [self.plain(e, self.column.axis, "r", sums) for e in expressions]
        moving = any(self.unknown is not None and total.has(self.unknown) for total in sums)
        totals = self.totals(sums, "        " if moving else "      ")
        lines = ["(() => {", *([] if moving else totals), "      return (r, u) => {"]
        lines += [*(totals if moving else []), *self.body(plain, "        "), "      };", "    })()"]
        return "\n".join(lines)

    def totals(self, sums: Sequence[Sum], indent: str) -> list[str]:
        """One pass over each axis for all its sums: they share most of their work."""
        lines = [f"{indent}const T = [];"] if sums else []
        for axis in self.sheet.axes:
            mine = [n for n, total in enumerate(sums) if total.limits[0][0] == axis.index]
            if not mine:
                continue
            inner: list[Sum] = []
            terms = [self.plain(sums[n].function, axis, "q", inner) for n in mine]
            name = f"sum_{axis.name}"
            lines += [
                f"{indent}const {name} = total(a.{axis.name}.size, k.{axis.name}, {len(mine)}, (q, out) => {{"
            ]
            lines += [*self.body(terms, indent + "  ", assign="out"), f"{indent}}});"]
            lines += [f"{indent}T[{n}] = {name}[{place}];" for place, n in enumerate(mine)]
        return lines


def _kernels(sheet: Sheet, column: Column) -> dict[str, str]:
    """The functions of a column, by the names that the runtime calls them."""
    rule = column.rule
    found: dict[str, str] = {}
    if isinstance(rule, Formula):
        found["value"] = _Scope(sheet, column, None).function([rule.expression])
    elif isinstance(rule, Root):
        scope, f, unknown = _Scope(sheet, column, rule.unknown), rule.expression, rule.unknown
        low = rule.sign_low if rule.sign_low is not None else f.subs(unknown, rule.low)
        high = rule.sign_high if rule.sign_high is not None else f.subs(unknown, rule.high)
        names = [Symbol(f"f_{n}", real=True) for n in range(4)]
        step = householder(*names).xreplace(dict(zip(names, derivatives(f, unknown), strict=True)))
        found["ends"] = scope.function([rule.low, rule.high, rule.start, low, high, *rule.turning])
        found["at"] = scope.function([f])
        found["noise"] = scope.function([f, magnitude(f)])
        found["step"] = scope.function([f, step])
        found["value"] = scope.function([rule.value])
    if column.requires:
        found["requires"] = _Scope(sheet, column, None).function(
            [condition for condition, _ in column.requires]
        )
    return found


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
            "refs": [] if kind == "given" else list(_references(sheet, column)),
            "sums": [axis.name for axis in sheet.summed_axes(column)],
        }
        if isinstance(column.rule, Formula):
            entry["positive"] = column.positive
        if isinstance(column.rule, Root):
            entry["steps"] = column.rule.steps
        text = json.dumps(entry)[:-1]
        kernels = _kernels(sheet, column)
        if kernels:
            inner = ",\n".join(f"    {name}: {function}" for name, function in kernels.items())
            text += f', "kernels": (c, a, n, k) => ({{\n{inner}\n  }})'
        columns.append(f"  {text}}}")
    axes = ", ".join(json.dumps(_axis(axis)) for axis in sheet.axes)
    fixed = json.dumps({name: [value] for name, value in (constants or {}).items()})
    return (
        f'{{\n "constants": {fixed},\n "axes": [{axes}],\n "columns": [\n' + ",\n".join(columns) + "\n ]\n}"
    )
