"""The exact engine: the same sheet at 50 digits, cell by cell, to judge all other engines.

It shares the sheet's rules with the others and nothing of their programs: expressions are printed for
mpmath, roots are bracketed and then narrowed until 50 digits stand. It is slow and not meant for large data.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from statistics import median
from typing import Any

import mpmath
import numpy as np
from mpmath.libmp import round_nearest, to_float
from numpy.typing import NDArray
from sympy import Basic, Expr, Indexed, Symbol, lambdify

from ...derivations.reductions import REDUCTIONS, Median
from ..cells.layout import Layout, lay_out, precedents, rows_of
from ..cells.values import Status, Values, how_many, inherited, rows_kept
from ..plan import Leaf, RootNode, lowered_column
from ..plan.domain import LARGEST, SMALLEST, typed
from ..quantity import Bounds
from ..sheet import Axis, Column, Formula, Given, Root, Sheet, name_of
from .certified import certified, enclosing, slope
from .exact_roots import Enclose, brackets, of_arrays, of_mpmath
from .intervals import Intervals
from .isolation import Doubtful
from .numpy_root import terms_of

__all__ = ["DIGITS", "ExactValues", "evaluate", "laid_out"]

DIGITS = 50
_GUARD = 15
"""Digits carried beyond those that are promised: sums and differences eat some."""
_CLOSE = mpmath.mpf(f"1e-{DIGITS + 5}")
_ROUGHLY = 1e-12
"""As parts of a root: how close it is sought, and how close doubles should come."""


@dataclass(frozen=True)
class ExactValues:
    """Values of every cell to 50 digits.

    Parameters
    ----------
    value : mapping of column name to list of mpf or None
        SI; None where the status is not OK.
    status : mapping of column name to list of Status
    roots : mapping of column name to mapping of row to tuple of mpf
        All roots of ambiguous cells; of undecided ones, the part of the interval that was not decided.
    layouts, counted, broken
        As those of :class:`~loopsheet.report.cells.values.Values`.
    """

    value: Mapping[str, list[Any]]
    status: Mapping[str, list[Status]]
    roots: Mapping[str, Mapping[int, tuple[Any, ...]]]
    layouts: Mapping[str, Layout]
    counted: Mapping[str, Mapping[str, int]]
    broken: Mapping[str, NDArray[np.uint8]]

    def rounded(self, sheet: Sheet) -> Values:
        """Every cell as the double that is nearest to it, the same on every processor.

        Parameters
        ----------
        sheet : Sheet
            What was evaluated, or a part that rests on nothing else.
        """
        names = [column.name for column in sheet.order]
        return Values(
            sheet,
            self.layouts,
            {n: np.array([np.nan if x is None else _nearest(x) for x in self.value[n]]) for n in names},
            {n: np.array(self.status[n], dtype=np.uint8) for n in names},
            {
                name: {row: tuple(map(_nearest, found)) for row, found in rows.items()}
                for name, rows in self.roots.items()
            },
            {name: found for name, found in self.counted.items() if name in names},
            {name: found for name, found in self.broken.items() if name in names},
        )


def _nearest(value: Any) -> float:
    """The nearest double, whatever precision the caller works with; of nothing, without a sign."""
    found = value if isinstance(value, float) else to_float(value._mpf_, rnd=round_nearest)
    return float(found) + 0.0


class _Failed(Exception):
    """A cell has an error value instead of a number."""

    def __init__(self, status: Status) -> None:
        self.status = status


def _rows(values: Any) -> Any:
    return values if isinstance(values, (list, tuple, np.ndarray)) else [values]


def _datum(value: Any, bounds: Bounds) -> Any:
    """A datum as mpf: fractions and texts exactly, a double as the double it is; NaN if it is not allowed."""
    value = Fraction(value) if isinstance(value, str) else value
    if isinstance(value, Fraction) and abs(value) >= LARGEST:
        return mpmath.nan  # no double holds it: it is no datum to the other engines either
    if value is None or not bounds.allow(value if isinstance(value, Fraction) else float(value)):
        return mpmath.nan
    if isinstance(value, Fraction):
        return mpmath.mpf(value.numerator) / value.denominator
    return mpmath.mpf(value)


def _held(value: Any, positive: bool) -> Any:
    """A value that a double can hold, be it rounded."""
    if isinstance(value, mpmath.mpc) or not mpmath.isfinite(value) or (positive and not value > 0):
        raise _Failed(Status.DOMAIN)
    if -1000 < mpmath.mag(value) < 1000:
        return value  # its size is known without comparing it with numbers of a thousand bits
    if abs(value) >= LARGEST or (positive and value < SMALLEST):
        raise _Failed(Status.OVERFLOW)
    return value


def evaluate(sheet: Sheet, labels: Mapping[str, Sequence[int]], data: Mapping[str, Any]) -> ExactValues:
    """Compute a sheet from given columns.

    Parameters
    ----------
    sheet : Sheet
    labels : mapping of axis name to sequence of int
    data : mapping of column name to a number, or a sequence of numbers, in SI
        Fractions are taken exactly; None or NaN is a missing datum.
    """
    layouts = laid_out(sheet, labels, data)
    with mpmath.workdps(DIGITS + _GUARD):
        given = {name: [_datum(x, sheet.bounds[name]) for x in _rows(data[name])] for name in sheet.bounds}
        return _Exact(sheet, layouts, given).run()


def laid_out(sheet: Sheet, labels: Mapping[str, Sequence[int]], data: Mapping[str, Any]) -> dict[str, Layout]:
    """The rows of every axis.

    Parameters
    ----------
    sheet, labels, data
        As for :func:`evaluate`.
    """
    repeats = [axis.repeats for axis in sheet.axes if axis.repeats]
    numbers = {name: _datum(_rows(data[name])[0], sheet.bounds[name]) for name in repeats}
    counts = {name: 0 if mpmath.isnan(number) else int(number) for name, number in numbers.items()}
    return lay_out(sheet, labels, counts)


class _Exact:
    """One evaluation at 50 digits."""

    def __init__(self, sheet: Sheet, layouts: Mapping[str, Layout], given: Mapping[str, list[Any]]) -> None:
        self.sheet, self.layouts, self.given = sheet, layouts, given
        self.value: dict[str, list[Any]] = {}
        self.status: dict[str, NDArray[np.uint8]] = {}
        self.roots: dict[str, dict[int, tuple[Any, ...]]] = {}
        self.counted: dict[str, dict[str, int]] = {}
        self.broken: dict[str, NDArray[np.uint8]] = {}

    def run(self) -> ExactValues:
        for column in self.sheet.order:
            size = 1 if column.axis is None else self.layouts[column.axis.name].size
            status, compute = self._rule(column, size)
            self.value[column.name] = values = [None] * size
            for row in np.flatnonzero(status == Status.OK).tolist():
                try:
                    values[row] = compute(row)
                except _Failed as failed:
                    status[row] = failed.status
            self.status[column.name] = status
        codes = {name: [Status(code) for code in status.tolist()] for name, status in self.status.items()}
        return ExactValues(self.value, codes, self.roots, self.layouts, self.counted, self.broken)

    # --- rules ----------------------------------------------------------------------------------------

    def _rule(self, column: Column, size: int) -> tuple[NDArray[np.uint8], Callable[[int], Any]]:
        """The errors that the rows inherit, and what computes the others."""
        rule = column.rule
        if isinstance(rule, Given):
            return np.zeros(size, dtype=np.uint8), lambda row: self._given(column, row)
        named = precedents(self.sheet, self.layouts, column)
        kept = rows_kept(named, self.layouts, self.status)
        if some := how_many(kept):
            self.counted[column.name] = some
        status = inherited(named, kept, self.status, size)
        scope = _Scope(self, column, {axis: np.flatnonzero(mask).tolist() for axis, mask in kept.items()})
        conditions = [scope.function(condition) for condition, _ in column.requires]
        body = (
            scope.function(rule.expression) if isinstance(rule, Formula) else self._root(rule, column, scope)
        )

        broken = np.zeros(size, dtype=np.uint8)
        if conditions:
            self.broken[column.name] = broken

        def compute(row: int) -> Any:
            for number, condition in enumerate(conditions, start=1):
                if not condition(row):
                    broken[row] = number
                    raise _Failed(Status.DOMAIN)
            return _held(body(row), column.positive)

        return status, compute

    def _given(self, column: Column, row: int) -> Any:
        value = self.given[column.name][row]
        if mpmath.isnan(value):
            raise _Failed(Status.INPUT)
        return value

    # --- roots ----------------------------------------------------------------------------------------

    def _root(self, rule: Root, column: Column, scope: _Scope) -> Callable[[int], Any]:
        """Count the sign changes between turning points, then narrow the only bracket down."""
        form, value = (scope.function(e, rule.unknown) for e in (rule.expression, rule.value))
        low, high = scope.function(rule.low), scope.function(rule.high)
        given = [None if end is None else scope.function(end) for end in (rule.sign_low, rule.sign_high)]
        counted = None if certified(self.sheet, column) else scope.enclosing(rule)
        turning = [] if counted else [scope.function(point) for point in rule.turning]
        # A sum takes long at 50 digits, and as doubles no time.
        rough = _Roughly(scope).root(rule) if _sums([rule.expression]) else None

        def solve(row: int) -> Any:
            points, right = [low(row)], high(row)
            for point in turning:
                place = point(row)
                if not isinstance(place, mpmath.mpc) and points[-1] < place < right:
                    points.append(place)
            points.append(right)
            inner = [form(row, point) for point in points[1:-1]]
            first, last = (
                form(row, end) if sign is None else sign(row)
                for end, sign in zip((points[0], right), given, strict=True)
            )
            signs = [mpmath.sign(f) for f in (first, *inner, last)]
            if any(mpmath.isnan(sign) for sign in signs):
                raise _Failed(Status.DOMAIN)
            found: Iterable[tuple[Any, Any, Any]] = (
                (a, b, rising)
                for (a, b), (falling, rising) in zip(pairwise(points), pairwise(signs), strict=True)
                if falling * rising < 0
            )
            if counted is not None:
                told = [None if sign is None else sign(row) for sign in given]
                try:
                    found = brackets(counted(row), points[0], right, told)
                except Doubtful as doubtful:
                    self.roots.setdefault(column.name, {})[row] = doubtful.part
                    raise _Failed(Status.UNDECIDED) from None
            roots = []
            for a, b, rising in found:
                guess = None if rough is None else rough(row, *map(float, (a, b, rising)))
                roots.append(value(row, _narrow(lambda u: form(row, u), a, b, rising, _CLOSE, guess=guess)))
            if len(roots) == 1:
                return roots[0]
            if not roots:
                raise _Failed(Status.NOROOT)
            self.roots.setdefault(column.name, {})[row] = tuple(sorted(roots))
            raise _Failed(Status.TWOROOTS)

        return solve


def _narrow(
    form: Callable[[Any], Any], left: Any, right: Any, rising: Any, close: Any, guess: Any = None
) -> Any:
    """The sign change between two points, as close as is asked, in the arithmetic of the points.

    To both sides of the guess, then halving, until the equation itself has been seen with either sign, so
    that it need not have one at the ends; then Anderson and Björck's regula falsi, which keeps the bracket
    and gains digits fast.

    Source: N. Anderson and Å. Björck, A new high order method of regula falsi type for computing a root of
    an equation, BIT 13 (1973) 253-264.
    """
    near = [] if guess is None else [guess * (1 - _ROUGHLY), guess * (1 + _ROUGHLY)]
    at_left = at_right = None
    while at_left is None or at_right is None:
        here = next((point for point in near if left < point < right), (left + right) / 2)
        f = form(here) * rising
        if f == 0 or mpmath.isnan(f) or right - left <= abs(here) * close:
            return here if f == f else f
        if f > 0:
            right, at_right = here, f
        else:
            left, at_left = here, f
    before, kept = None, 0
    while True:
        here = right - at_right * (right - left) / (at_right - at_left)
        if before is not None and abs(here - before) <= abs(here) * close:
            return here
        f = form(here) * rising
        if f == 0 or mpmath.isnan(f):
            return here if f == f else f
        # An end that is kept twice has its value reduced, or it would be kept for ever.
        if f > 0:
            at_left *= _share(f, at_right) if kept < 0 else 1
            right, at_right, kept = here, f, -1
        else:
            at_right *= _share(f, at_left) if kept > 0 else 1
            left, at_left, kept = here, f, 1
        before = here


def _share(new: Any, old: Any) -> Any:
    """What is left of the value of an end that is kept twice, from the values at the other end."""
    share = 1 - new / old
    return share if share > 0 else type(share)(0.5)


class _Scope:
    """Turns the expressions of a column into functions of a row (and of the unknown of a root).

    Parameters
    ----------
    engine : _Exact
    column : Column
    kept : mapping of axis name to list of int
        The rows that sums over an axis run over.
    """

    def __init__(self, engine: _Exact, column: Column, kept: Mapping[str, list[int]]) -> None:
        self.engine, self.column, self.kept = engine, column, kept

    modules = "mpmath"
    """What expressions are printed for."""

    def function(self, expression: Basic, unknown: Symbol | None = None) -> Callable[..., Any]:
        """An expression of the column's own row."""
        compute = self._many([expression], self.column.axis, unknown)

        def run(row: int, *at: Any) -> Any:
            try:
                return compute(row, *at)[0]
            except (ZeroDivisionError, ValueError):
                return mpmath.nan

        return run

    def enclosing(self, rule: Root) -> Callable[[int], Enclose]:
        """What encloses the form of a root, for each row."""
        sheet, axis = self.engine.sheet, self.column.axis
        plain = Symbol(rule.unknown.name, real=True)
        form = typed(sheet, rule.expression).xreplace({rule.unknown: plain})
        named = {cell: Symbol(f"cell_{n}") for n, cell in enumerate(sorted(form.atoms(Indexed), key=str))}
        parts = [each.xreplace(named) for each in (form, *slope(form, plain))]
        possible = of_mpmath(*parts, plain)
        if possible is not None:
            symbols, of_row = possible
            cells = {symbol: cell for cell, symbol in named.items()}
            readers = [self._reader(cells.get(symbol, symbol), axis) for symbol in symbols]
            return lambda row: of_row([read(row) for read in readers])
        plan = lowered_column(sheet, self.column)
        node = plan.nodes[-1]
        assert isinstance(node, RootNode)
        kernel, terms = enclosing(sheet, plan, node), terms_of(node)
        leaves, written = plan.named, {name: total.written for name, total in plan.totals.items()}
        named = {
            name: self.function(written[name]) if name in written else self._read_leaf(leaves[name])
            for name in kernel.arguments
            if name != plain.name
        }
        kept = {}
        for name in kernel.totals:
            kept[name] = np.zeros(self.engine.layouts[name].size, dtype=bool)
            kept[name][list(self.kept.get(name, range(kept[name].size)))] = True

        def of_rows(row: int) -> Enclose:
            given = {}
            for name, read in named.items():
                over = leaves[name].axis if name in terms else None
                rows = [row] if over is None else range(self._size(over))
                numbers = [np.nan if (x := read(each)) is None else float(x) for each in rows]
                given[name] = Intervals.near(numbers, numbers)
            return of_arrays(kernel, given, terms, kept)

        return of_rows

    def _read_leaf(self, leaf: Leaf) -> Callable[[int], Any]:
        """A cell, size or running number of the plan, for the rows it is read on."""
        if leaf.kind in ("size", "kept"):
            assert leaf.axis is not None
            return self._reader(leaf.axis.size, None)
        if leaf.kind == "ordinal":
            assert leaf.index is not None
            return self._reader(leaf.index, leaf.axis)
        column = self.engine.sheet[leaf.name]
        return self._reader(column.cell if leaf.index is None else column[leaf.index], leaf.axis)

    def _many(
        self, expressions: Sequence[Basic], axis: Axis | None, unknown: Symbol | None
    ) -> Callable[..., Sequence[Any]]:
        """Several expressions of a row of an axis at once, so that their common parts are computed once."""
        printed = _printed(tuple(expressions), unknown, self.modules)
        readers = [self._reader(cell, axis) for cell in printed.cells]
        sums = self._totals(printed.totals, unknown)

        def run(row: int, *at: Any) -> Sequence[Any]:
            computed: Sequence[Any] = printed.function(*(read(row) for read in readers), *sums(*at), *at)
            return computed

        return run

    def _totals(self, totals: Sequence[Expr], unknown: Symbol | None) -> Callable[..., list[Any]]:
        """All sums, those over one axis in one pass; one that the unknown does not move is taken once."""
        passes = []
        take = [isinstance(total, Median) for total in totals]
        for axis in self.engine.sheet.axes:
            for moving in (False, True):
                mine = [
                    n
                    for n, total in enumerate(totals)
                    if total.limits[0][0] == axis.index and total.has(unknown or Symbol("")) is moving
                ]
                if mine:
                    terms = self._many([totals[n].function for n in mine], axis, unknown)
                    passes.append((mine, terms, self.kept.get(axis.name, range(self._size(axis))), moving))
        fixed: dict[int, list[Any]] = {}

        def run(*at: Any) -> list[Any]:
            found: list[Any] = [None] * len(totals)
            for number, (mine, terms, rows, moving) in enumerate(passes):
                sums = fixed.get(number)
                if sums is None:
                    sums = self._taken([take[n] for n in mine], terms, rows, at)
                    if not moving:
                        fixed[number] = sums
                for n, total in zip(mine, sums or [mpmath.mpf(0)] * len(mine), strict=True):
                    found[n] = total
            return found

        return run

    def _taken(
        self, medians: Sequence[bool], terms: Callable[..., Any], rows: Sequence[int], at: Sequence[Any]
    ) -> list[Any]:
        """The medians or sums of several terms over rows; nothing of no rows."""
        columns = zip(*(terms(row, *at) for row in rows), strict=True)
        taken = zip(medians, columns, strict=False)
        return [median(column) if middle else mpmath.fsum(column) for middle, column in taken]

    def _numbers(self, numbers: list[Any]) -> Any:
        """What is read, row by row."""
        return numbers

    def _size(self, axis: Axis) -> int:
        return self.engine.layouts[axis.name].size

    def _reader(self, cell: Expr, axis: Axis | None) -> Callable[[int], Any]:
        """What gives a cell's value for a row of the axis."""
        sheet, layouts = self.engine.sheet, self.engine.layouts
        if cell in sheet.sizes:
            counted = sheet.sizes[cell]
            number = mpmath.mpf(len(self.kept.get(counted.name, range(self._size(counted)))))
            (number,) = self._numbers([number])
            return lambda _: number
        if axis is not None and cell in axis.ordinals:
            ordinals = [mpmath.mpf(n) for n in layouts[axis.name].ordinals[cell].tolist()]
            return self._numbers(ordinals).__getitem__  # type: ignore[no-any-return]
        values = self._numbers(self.engine.value[name_of(cell)])
        if not isinstance(cell, Indexed):
            return lambda _: values[0]
        rows = rows_of(cell, axis, layouts)
        if rows is None:
            return values.__getitem__  # type: ignore[no-any-return]
        return lambda row: values[rows[row]]


class _Roughly(_Scope):
    """The same in doubles, all terms of a sum at once: where a root is about."""

    modules = "numpy"

    def __init__(self, scope: _Scope) -> None:
        super().__init__(scope.engine, scope.column, scope.kept)

    def root(self, rule: Root) -> Callable[..., Any]:
        """Where a row has its root between two ends; NaN if doubles do not tell."""
        form = self.function(rule.expression, rule.unknown)

        def guess(row: int, left: float, right: float, rising: float) -> Any:
            with np.errstate(all="ignore"):
                return mpmath.mpf(_narrow(lambda u: form(row, u), left, right, rising, _ROUGHLY))

        return guess

    def _numbers(self, numbers: list[Any]) -> Any:
        return np.array([np.nan if number is None else float(number) for number in numbers])

    def _taken(
        self, medians: Sequence[bool], terms: Callable[..., Any], rows: Sequence[int], at: Sequence[Any]
    ) -> list[Any]:
        which = np.array(rows, dtype=np.intp)
        columns = [np.broadcast_to(column, which.shape) for column in terms(which, *at)]
        taken = zip(medians, columns, strict=True)
        return [np.median(column) if middle else column.sum() for middle, column in taken]


@dataclass(frozen=True)
class _Printed:
    """Expressions as a function of the cells and totals that they name, and of the unknown if any."""

    cells: tuple[Expr, ...]
    totals: tuple[Expr, ...]
    function: Callable[..., Sequence[Any]]


@lru_cache(maxsize=512)
def _printed(expressions: tuple[Basic, ...], unknown: Symbol | None, modules: str) -> _Printed:
    """Print expressions; the same for whatever data, and slower than to evaluate a small sheet."""
    outermost = _sums(expressions)
    totals = {total: Symbol(f"total_{n}") for n, total in enumerate(outermost)}
    outer = [expression.xreplace(totals) for expression in expressions]
    cells = sorted(set().union(*(e.atoms(Indexed) for e in outer)), key=str)
    plain = {cell: Symbol(f"cell_{n}") for n, cell in enumerate(cells)}
    bodies = [expression.xreplace(plain) for expression in outer]
    named = {*plain.values(), *totals.values(), unknown}
    symbols = sorted(set().union(*(body.free_symbols for body in bodies)) - named, key=str)
    arguments = [*plain.values(), *symbols, *totals.values()] + ([] if unknown is None else [unknown])
    function = lambdify(arguments, bodies, modules=modules, cse=len(bodies) > 1)
    return _Printed((*cells, *symbols), tuple(outermost), function)


def _sums(expressions: Sequence[Basic]) -> list[Expr]:
    """The sums and medians in expressions that stand in no other."""
    found: dict[Expr, None] = {}
    for expression in expressions:
        if isinstance(expression, REDUCTIONS):
            found[expression] = None
        else:
            found.update(dict.fromkeys(_sums(expression.args)))
    return list(found)
