"""Derivatives of scalars as formulas: a spreadsheet has none of its own.

Along all ways through formulas and sums that are linear in what is given, each derivative is one formula of
finished cells, made by sympy. A root, a loop or a sum of products would need cells on the way: where one is
met, nothing is told.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from sympy import Derivative, DiracDelta, Expr, Heaviside, Integer, Subs, Symbol, diff

from ..cells.grid import every_row
from ..plan.nodes import Map, Total
from ..sheet import Column, Formula, Given
from .excel_formulas import Formulas, Writing
from .excel_values import NotPrintable

__all__ = ["slopes"]

_UNPRINTED = (Derivative, Subs, DiracDelta, Heaviside)
_LONGEST = 2000
"""Characters of a formula that somebody may still want to read; Excel takes 8192."""


def slopes(formulas: Formulas, column: Column) -> dict[str, str]:
    """The formulas of a scalar's derivatives by what is given, in SI, by the names of the given columns.

    That by a column with rows is the one by the cell of a row, whose number is left open as ``{row}``, and,
    under another name, by all of them. Empty if there is no formula for one of them.
    """
    plan = formulas.plan
    in_sum: dict[Symbol, Total] = {}
    """What stands for whether a row counts in a sum."""

    @cache
    def of(name: str) -> Mapping[str, Expr] | None:
        """The derivatives of a column by what is given."""
        own = formulas.sheet[name]
        if isinstance(own.rule, Given):
            return {name: Integer(1)}
        return along(formulas.maps[name]) if isinstance(own.rule, Formula) and own.axis is None else None

    def along(node: Map) -> Mapping[str, Expr] | None:
        found: dict[str, Expr] = {}
        for symbol in sorted(node.value.free_symbols, key=str):
            leaf, slope = plan.named[symbol.name], diff(node.value, symbol)
            if leaf.kind in ("size", "kept"):
                continue
            if leaf.kind == "total":
                inner = summed(plan.totals[symbol.name])
            else:
                inner = of(leaf.name) if leaf.kind == "cells" and leaf.axis is None else None
            if inner is None or slope.has(*_UNPRINTED):
                return None
            for by, own in inner.items():
                found[by] = found.get(by, Integer(0)) + slope * own
        return found

    def summed(total: Total) -> Mapping[str, Expr] | None:
        """The derivatives of a sum by the cells of its rows, where each is the same for all of them."""
        counts, found = Symbol(f"a row of {total.symbol}"), dict[str, Expr]()
        in_sum[counts] = total
        for symbol in sorted(total.terms.free_symbols, key=str):
            leaf, slope = plan.named[symbol.name], diff(total.terms, symbol)
            own = leaf.kind == "cells" and leaf.index is None and leaf.axis == total.over
            if not own or slope.free_symbols or not isinstance(formulas.sheet[leaf.name].rule, Given):
                return None
            found[leaf.name] = slope * counts
        return found if total.word == "sum" and total.axis is None else None

    found, told = of(column.name) or {}, dict[str, str]()
    writing = Writing(formulas, column, column.name)

    def written(slope: Expr, alone: bool) -> str:
        return writing.elsewhere(slope, {counts: (total, alone) for counts, total in in_sum.items()})

    try:
        for name, slope in found.items():
            told[name] = written(slope, alone=True)
            if formulas.sheet[name].axis is not None:
                told[every_row(name)] = written(slope, alone=False)
    except NotPrintable:
        return {}
    return told if all(len(text) <= _LONGEST for text in told.values()) else {}
