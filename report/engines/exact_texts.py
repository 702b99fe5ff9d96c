"""The rules of a sheet, printed for mpmath: texts that are made once, and of which the exact engine runs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from sympy import Basic, Expr, Indexed, Symbol

from ...derivations.reductions import REDUCTIONS, OrderStatistic, taken_of
from ..named import name_of
from ..plan.domain import typed
from ..plan.lowering import lowered_column
from ..plan.nodes import Leaf, RootNode
from ..plan.special import EXACT, in_elementary_terms
from ..sheet import Axis, Column, Given, Iterated, Root, Sheet
from .certified import certified, enclosing, slope
from .mpmath_intervals import differences, source_of, text_of
from .numpy_texts import terms_of


def exact_texts(sheet: Sheet) -> dict[str, Any]:
    """All that is computed of the columns that are not given.

    An expression is the text of a function (``source``) of cells, of what is taken over rows (``words`` says
    what), and of the unknown of a root. A cell is its kind, its name and its index; the terms of all sums
    over an axis that the unknown moves, or does not, are one expression (``passes``). Where a root of sums is
    about is told by the same in doubles (``rough``).
    """
    return {c.name: _Rule(sheet, c).texts() for c in sheet.order if not isinstance(c.rule, Given)}


class _Rule:
    """What is computed of one column."""

    def __init__(self, sheet: Sheet, column: Column) -> None:
        self.sheet, self.column = sheet, column

    def texts(self) -> dict[str, Any]:
        rule, conditions = self.column.rule, [self.of(condition) for condition, _ in self.column.requires]
        if isinstance(rule, Iterated):
            return {"requires": conditions, "value": self.of(rule.step), "start": self.of(rule.start)}
        if not isinstance(rule, Root):
            return {"requires": conditions, "value": self.of(self.column.rule.expression)}  # type: ignore[union-attr]
        counted = None if certified(self.sheet, self.column) else self.counted(rule)
        return {
            "requires": conditions,
            "form": self.of(rule.expression, rule.unknown),
            "rough": self.of(rule.expression, rule.unknown, "numpy") if _sums([rule.expression]) else None,
            "value": self.of(rule.value, rule.unknown),
            "low": self.of(rule.low),
            "high": self.of(rule.high),
            "signs": [end if end is None else self.of(end) for end in (rule.sign_low, rule.sign_high)],
            "turning": [self.of(point) for point in rule.turning] if counted is None else [],
            "counted": counted,
        }

    def of(self, expression: Basic, unknown: Symbol | None = None, modules: str = "mpmath") -> dict[str, Any]:
        """An expression of the column's own row."""
        return self.many((expression,), self.column.axis, unknown, modules)

    def many(
        self, expressions: tuple[Basic, ...], axis: Axis | None, unknown: Symbol | None, modules: str
    ) -> dict[str, Any]:
        """Several expressions of a row of an axis."""
        cells, totals, source = _printed(expressions, unknown, modules)
        passes = []
        for over in self.sheet.axes:
            for moving in (False, True):
                mine = [
                    n
                    for n, total in enumerate(totals)
                    if self.sheet.algebra.over(total) == over and total.has(unknown or Symbol("")) is moving
                ]
                if mine:
                    terms = self.many(tuple(taken_of(totals[n]) for n in mine), over, unknown, modules)
                    passes.append({"axis": over.name, "moving": moving, "which": mine, "terms": terms})
        return {
            "cells": [self.cell(cell, axis) for cell in cells],
            "words": [total.word if isinstance(total, OrderStatistic) else "sum" for total in totals],
            "passes": passes,
            "source": source,
        }

    def cell(self, cell: Expr, axis: Axis | None) -> tuple[str, str, str | None]:
        """What a cell, size or running number is called."""
        if cell in self.sheet.algebra.sizes:
            return "size", self.sheet.algebra.sizes[cell].name, None
        if axis is not None and cell in axis.ordinals:
            return "ordinal", cell.name, None
        return "cell", name_of(cell), cell.indices[0].name if isinstance(cell, Indexed) else None

    # --- what counts roots ------------------------------------------------------------------------------

    def counted(self, rule: Root) -> dict[str, Any]:
        """What encloses the form of a root: mpmath's intervals, or the program of intervals of arrays."""
        plain = Symbol(rule.unknown.name, real=True)
        form = typed(self.sheet, rule.expression).xreplace({rule.unknown: plain})
        cells = sorted(form.atoms(Indexed), key=str)
        named = {cell: Symbol(f"cell_{n}") for n, cell in enumerate(cells)}
        of_name = {symbol: cell for cell, symbol in named.items()}
        form, steepness, known = (each.xreplace(named) for each in (form, *slope(form, plain)))
        compared, symbols = differences(known), sorted(form.free_symbols - {plain}, key=str)
        if compared is not None:
            text = text_of([*symbols, plain], [form, steepness, *(each for _, each in compared)])
            if text is not None:
                read = [self.cell(of_name.get(symbol, symbol), self.column.axis) for symbol in symbols]
                return {"interval": text, "kinds": [kind for kind, _ in compared], "cells": read}
        plan = lowered_column(self.sheet, self.column)
        node = plan.nodes[-1]
        assert isinstance(node, RootNode)
        kernel, reads = enclosing(self.sheet, plan, node), []
        for name in kernel.arguments:
            if name != plain.name:
                leaf = plan.named[name]
                reads.append((name, leaf.axis and leaf.axis.name, *self.read(leaf, plan.totals.get(name))))
        return {"kernel": kernel.plain, "terms": sorted(terms_of(node)), "reads": reads}

    def read(self, leaf: Leaf, total: Any) -> tuple[Any, Any]:
        """What a leaf of the plan is: a cell, or a total as it is written."""
        if total is not None:
            return None, self.of(total.written)
        if leaf.kind in ("size", "kept"):
            assert leaf.axis is not None
            return ("size", leaf.axis.name, None), None
        if leaf.kind == "ordinal":
            return ("ordinal", leaf.index, None), None
        own = leaf.axis and leaf.axis.index_name
        return ("cell", leaf.name, leaf.index or own), None


@lru_cache(maxsize=512)
def _printed(
    expressions: tuple[Basic, ...], unknown: Symbol | None, modules: str
) -> tuple[tuple[Expr, ...], tuple[Any, ...], str]:
    """The cells and totals that expressions name, and their function; the same expressions come again."""
    expressions = tuple(in_elementary_terms(expression, EXACT) for expression in expressions)
    totals = {total: Symbol(f"total_{n}") for n, total in enumerate(_sums(expressions))}
    outer = [expression.xreplace(totals) for expression in expressions]
    cells = sorted(set().union(*(e.atoms(Indexed) for e in outer)), key=str)
    plain = {cell: Symbol(f"cell_{n}") for n, cell in enumerate(cells)}
    bodies = [expression.xreplace(plain) for expression in outer]
    named = {*plain.values(), *totals.values(), unknown}
    symbols = sorted(set().union(*(body.free_symbols for body in bodies)) - named, key=str)
    arguments = [*plain.values(), *symbols, *totals.values()] + ([] if unknown is None else [unknown])
    return (*cells, *symbols), tuple(totals), source_of(arguments, bodies, len(bodies) > 1, modules)


def _sums(expressions: Sequence[Basic]) -> list[Expr]:
    """What expressions take over rows that stands in no other such."""
    found: dict[Expr, None] = {}
    for expression in expressions:
        if isinstance(expression, REDUCTIONS):
            found[expression] = None
        else:
            found.update(dict.fromkeys(_sums(expression.args)))
    return list(found)
