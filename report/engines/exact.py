"""The exact engine: the same sheet at 50 digits, cell by cell, to judge all other engines.

It shares the sheet's rules with the others and nothing of their programs: expressions are printed for
mpmath, roots are bracketed and then narrowed until 50 digits stand. It is slow and not meant for large data.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import mpmath
from sympy import Basic, Expr, Indexed, Sum, Symbol, lambdify

from ..layout import Layout, lay_out
from ..sheet import Column, Formula, Given, RepeatAxis, Root, Sheet, name_of
from ..values import Status

__all__ = ["DIGITS", "ExactValues", "evaluate"]

DIGITS = 50
_GUARD = 15
"""Digits carried beyond those that are promised: sums and differences eat some."""
_HALVINGS = 24
"""Bisections before the secant method: the bracket is then a millionth of the interval."""


@dataclass(frozen=True)
class ExactValues:
    """Values of every cell to 50 digits.

    Parameters
    ----------
    value : mapping of column name to list of mpf or None
        SI; None where the status is not OK.
    status : mapping of column name to list of Status
    roots : mapping of column name to mapping of row to tuple of mpf
        All roots of ambiguous cells.
    """

    value: Mapping[str, list[Any]]
    status: Mapping[str, list[Status]]
    roots: Mapping[str, Mapping[int, tuple[Any, ...]]]


class _Failed(Exception):
    """A cell has an error value instead of a number."""

    def __init__(self, status: Status) -> None:
        self.status = status


def _number(value: Any) -> Any:
    """A datum as mpf: fractions and strings exactly, doubles as the doubles they are."""
    if isinstance(value, Fraction):
        return mpmath.mpf(value.numerator) / value.denominator
    return mpmath.mpf(value)


def evaluate(sheet: Sheet, labels: Mapping[str, Sequence[int]], data: Mapping[str, Any]) -> ExactValues:
    """Compute a sheet from given columns.

    Parameters
    ----------
    sheet : Sheet
    labels : mapping of axis name to sequence of int
    data : mapping of column name to a number, or a sequence of numbers, in SI
        Fractions are taken exactly; None is a missing datum.
    """
    with mpmath.workdps(DIGITS + _GUARD):
        given = {
            name: [None if x is None else _number(x) for x in (v if isinstance(v, (list, tuple)) else [v])]
            for name, v in data.items()
        }
        counts = {a.count: int(given[a.count][0]) for a in sheet.axes if isinstance(a, RepeatAxis)}
        return _Exact(sheet, lay_out(sheet, labels, counts), given).run()


class _Exact:
    """One evaluation at 50 digits."""

    def __init__(self, sheet: Sheet, layouts: Mapping[str, Layout], given: Mapping[str, list[Any]]) -> None:
        self.sheet, self.layouts, self.given = sheet, layouts, given
        self.value: dict[str, list[Any]] = {}
        self.status: dict[str, list[Status]] = {}
        self.roots: dict[str, dict[int, tuple[Any, ...]]] = {}
        self.rows_kept: dict[tuple[str, str], list[int]] = {}

    def run(self) -> ExactValues:
        for column in self.sheet.order:
            self.value[column.name], self.status[column.name] = [], []
            compute = self._rule(column)
            for row in range(1 if column.axis is None else self.layouts[column.axis.name].size):
                try:
                    value, status = compute(row), Status.OK
                except _Failed as failed:
                    value, status = None, failed.status
                self.value[column.name].append(value)
                self.status[column.name].append(status)
        return ExactValues(self.value, self.status, self.roots)

    # --- rules ----------------------------------------------------------------------------------------

    def _rule(self, column: Column) -> Callable[[int], Any]:
        rule = column.rule
        if isinstance(rule, Given):
            return lambda row: self._given(column, row)
        conditions = [self._function(condition, column) for condition, _ in column.requires]
        if isinstance(rule, Formula):
            body = self._function(rule.expression, column)
        else:
            body = self._root(rule, column)
        inherit = self._inheritance(column)

        def compute(row: int) -> Any:
            inherit(row)
            if not all(condition(row) for condition in conditions):
                # A condition may rest on the value's own domain; what fails first is the domain.
                raise _Failed(Status.DOMAIN)
            return self._finite(body(row))

        return compute

    def _given(self, column: Column, row: int) -> Any:
        value = self.given[column.name][row]
        if value is None or not mpmath.isfinite(value):
            raise _Failed(Status.INPUT)
        return value

    @staticmethod
    def _finite(value: Any) -> Any:
        if isinstance(value, mpmath.mpc) or not mpmath.isfinite(value):
            raise _Failed(Status.DOMAIN)
        return value

    def _inheritance(self, column: Column) -> Callable[[int], None]:
        """Carry the first error of the precedents on; a sum has one only if none of its rows has a value."""
        declared = {c.name: n for n, c in enumerate(self.sheet.columns)}
        sources: list[tuple[list[Status], Any]] = []
        for cell in sorted(self.sheet.references(column), key=lambda c: (declared[name_of(c)], str(c))):
            status = self.status[name_of(cell)]
            if not isinstance(cell, Indexed):
                sources.append((status, None))
            elif column.axis is not None and cell.indices[0] in column.axis.maps:
                sources.append((status, self.layouts[column.axis.name].rows[cell.indices[0]]))
            else:
                axis = next(a for a in self.sheet.summed_axes(column) if cell.indices[0] in a.maps)
                if not self._kept(column, axis.name):
                    first = int(self.layouts[axis.name].rows[cell.indices[0]][0])
                    sources.append((status[first : first + 1], None))

        def inherit(row: int) -> None:
            for status, rows in sources:
                theirs = status[0 if rows is None else int(rows[row])]
                if theirs is not Status.OK:
                    raise _Failed(theirs)

        return inherit

    def _kept(self, column: Column, axis_name: str) -> list[int]:
        """The rows of a summed axis whose cells all have values."""
        known = self.rows_kept.get((column.name, axis_name))
        if known is not None:
            return known
        axis = next(a for a in self.sheet.axes if a.name == axis_name)
        layout = self.layouts[axis_name]
        kept = list(range(layout.size))
        for cell in self.sheet.references(column):
            if isinstance(cell, Indexed) and cell.indices[0] in axis.maps:
                named = layout.rows[cell.indices[0]]
                status = self.status[name_of(cell)]
                kept = [row for row in kept if status[int(named[row])] is Status.OK]
        self.rows_kept[column.name, axis_name] = kept
        return kept

    # --- expressions ----------------------------------------------------------------------------------

    def _function(self, expression: Basic, column: Column, unknown: Symbol | None = None) -> Callable[..., Any]:
        """An expression as a function of the row (and of the unknown of a root)."""
        totals = sorted(expression.atoms(Sum), key=str)
        stand_ins = {total: Symbol(f"total_{n}") for n, total in enumerate(totals)}
        outer = expression.xreplace(stand_ins)
        inner = [self._terms(total, column, unknown) for total in totals]
        cells = sorted(outer.atoms(Indexed), key=str)
        plain = {cell: Symbol(f"cell_{n}") for n, cell in enumerate(cells)}
        body = outer.xreplace(plain)
        symbols = sorted(body.free_symbols - set(plain.values()) - set(stand_ins.values()) - {unknown}, key=str)
        arguments = [*plain.values(), *symbols, *stand_ins.values()] + ([] if unknown is None else [unknown])
        function = lambdify(arguments, body, modules="mpmath")
        axis = None if column.axis is None else self.layouts[column.axis.name]

        def run(row: int, *at: Any) -> Any:
            values = [self._cell(cell, axis, row) for cell in cells]
            values += [self._plain(symbol, column, axis, row) for symbol in symbols]
            values += [total(*at) for total in inner]
            try:
                return function(*values, *at)
            except (ZeroDivisionError, ValueError):
                return mpmath.nan

        return run

    def _terms(self, total: Sum, column: Column, unknown: Symbol | None) -> Callable[..., Any]:
        """A sum as a function of the unknown: its terms, row by row of its axis, added without loss."""
        axis = self.sheet.indices[total.limits[0][0]]
        layout = self.layouts[axis.name]
        expression = total.function
        cells = sorted(expression.atoms(Indexed), key=str)
        plain = {cell: Symbol(f"cell_{n}") for n, cell in enumerate(cells)}
        body = expression.xreplace(plain)
        symbols = sorted(body.free_symbols - set(plain.values()) - {unknown}, key=str)
        arguments = [*plain.values(), *symbols] + ([] if unknown is None else [unknown])
        function = lambdify(arguments, body, modules="mpmath")
        rows = [
            [self._cell(c, layout, r) for c in cells] + [self._plain(s, column, layout, r) for s in symbols]
            for r in self._kept(column, axis.name)
        ]

        def run(*at: Any) -> Any:
            return mpmath.fsum(function(*values, *at) for values in rows)

        return run

    def _cell(self, cell: Indexed, layout: Layout | None, row: int) -> Any:
        assert layout is not None
        return self.value[name_of(cell)][int(layout.rows[cell.indices[0]][row])]

    def _plain(self, symbol: Symbol, column: Column, layout: Layout | None, row: int) -> Any:
        if symbol in self.sheet.sizes:
            axis = self.sheet.sizes[symbol]
            return mpmath.mpf(len(self._kept(column, axis.name)))
        if layout is not None and symbol in layout.ordinals:
            return mpmath.mpf(layout.ordinals[symbol][row])
        return self.value[symbol.name][0]

    # --- roots ----------------------------------------------------------------------------------------

    def _root(self, rule: Root, column: Column) -> Callable[[int], Any]:
        """Count the sign changes between turning points, then narrow the only bracket down."""
        form = self._function(rule.expression, column, rule.unknown)
        low, high = self._function(rule.low, column), self._function(rule.high, column)
        signs = [None if s is None else self._function(s, column) for s in (rule.sign_low, rule.sign_high)]
        turning = [self._function(point, column) for point in rule.turning]
        value = self._function(rule.value, column, rule.unknown)

        def solve(row: int) -> Any:
            left, right = low(row), high(row)
            points = [left]
            for point in turning:
                place = point(row)
                if not isinstance(place, mpmath.mpc) and mpmath.isfinite(place) and points[-1] < place < right:
                    points.append(place)
            points.append(right)
            at = [form(row, point) for point in points]
            at[0] = at[0] if signs[0] is None else signs[0](row)
            at[-1] = at[-1] if signs[1] is None else signs[1](row)
            brackets = [(a, b, y) for a, b, x, y in zip(points, points[1:], at, at[1:], strict=False) if x * y < 0]
            if not brackets:
                raise _Failed(Status.NOROOT)
            roots = [value(row, _narrow(lambda u: form(row, u), *bracket)) for bracket in brackets]
            if len(roots) > 1:
                self.roots.setdefault(column.name, {})[row] = tuple(sorted(roots))
                raise _Failed(Status.TWOROOTS)
            return roots[0]

        return solve


def _narrow(form: Callable[[Any], Any], left: Any, right: Any, at_right: Any) -> Any:
    """The sign change between two points, to working precision.

    Bisection until the secant method, which gains digits faster than any derivative costs, is safe; the
    result must still lie in the bracket.
    """
    for _ in range(_HALVINGS):
        middle = (left + right) / 2
        if form(middle) * at_right > 0:
            right = middle
        else:
            left = middle
    previous, here = left, right
    f_previous, f_here = form(previous), form(here)
    while f_here != f_previous and abs(here - previous) > abs(here) * mpmath.mpf(10) ** -(DIGITS + 5):
        previous, here = here, here - f_here * (here - previous) / (f_here - f_previous)
        f_previous, f_here = f_here, form(here)
    if not left <= here <= right:
        raise ArithmeticError("the 50-digit root left its bracket")
    return here
