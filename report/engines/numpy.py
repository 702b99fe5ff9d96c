"""The NumPy engine: prints each rule as a function of arrays and runs it over all rows at once.

The last dimension of every array is the rows of its column's axis (one row for a scalar); leading
dimensions are a batch, so that one program serves one report and a million draws. The program is text
made by the printer below from the sheet's own expressions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sympy import Basic, Expr, Function, Indexed, Piecewise, Sum, Symbol, cse, numbered_symbols
from sympy.printing.numpy import NumPyPrinter

from ..layout import Layout, lay_out
from ..sheet import Axis, Column, Formula, Given, RepeatAxis, Root, Sheet, name_of
from ..values import Status, Values
from .roots import derivatives, householder

__all__ = ["Kernel", "Program", "evaluate"]

Array = NDArray[np.float64]
Codes = NDArray[np.uint8]


class Printer(NumPyPrinter):  # type: ignore[misc]
    """NumPy's printer, with what broadcasting over columns needs."""

    def _print_Max(self, expr: Expr) -> str:
        return self._pairwise("numpy.maximum", expr)

    def _print_Min(self, expr: Expr) -> str:
        return self._pairwise("numpy.minimum", expr)

    def _pairwise(self, function: str, expr: Expr) -> str:
        # sympy stacks the arguments, which must then have one shape; columns and scalars do not.
        parts = [self._print(argument) for argument in sorted(expr.args, key=str)]
        return reduce(lambda a, b: f"{function}({a}, {b})", parts)

    def _print_Pow(self, expr: Expr, rational: bool = False) -> str:
        # x**(-2) of an array is slower and less exact than a division.
        if expr.exp.is_Integer and expr.exp < 0:
            return f"(1/{self.parenthesize(expr.base ** -expr.exp, 70)})"
        return str(super()._print_Pow(expr, rational=rational))

    def _print_Piecewise(self, expr: Piecewise) -> str:
        pairs = [(self._print(body), self._print(condition)) for body, condition in expr.args]
        last = pairs.pop()[0] if expr.args[-1].cond == True else "numpy.nan"  # noqa: E712
        return reduce(lambda rest, pair: f"numpy.where({pair[1]}, {pair[0]}, {rest})", reversed(pairs), last)


@dataclass(frozen=True)
class Kernel:
    """One printed function: what it is called with, its text, and the function itself."""

    arguments: tuple[Expr, ...]
    totals: tuple[str, ...]
    """The axes it sums over."""
    source: str
    run: Callable[..., tuple[Array, ...]]


def kernel(expressions: Sequence[Basic], sums: Mapping[Symbol, Axis], extra: Sequence[Symbol] = ()) -> Kernel:
    """Print expressions as one function of arrays, common parts computed once.

    Parameters
    ----------
    expressions : sequence of Basic
        What the function returns, in order.
    sums : mapping of index to Axis
        The axes that sums in them may run over.
    extra : sequence of Symbol
        Arguments that are always there, such as the unknown of a root.
    """
    leaves: dict[Expr, Symbol] = {}
    totals: dict[str, str] = {}

    def arrays(expression: Any) -> Any:
        if isinstance(expression, Sum):
            # In array language a sum is a function of the array of its terms.
            axis = sums[expression.limits[0][0]].name
            totals[axis] = f"total_{axis}"
            return Function(totals[axis])(arrays(expression.function))
        if isinstance(expression, Indexed):
            plain = Symbol(f"{name_of(expression)}_of_{expression.indices[0]}", **expression.base.label.assumptions0)
            return leaves.setdefault(expression, plain)
        if isinstance(expression, Symbol):
            return leaves.setdefault(expression, expression)
        return expression.func(*map(arrays, expression.args)) if expression.args else expression

    bodies = [arrays(expression) for expression in expressions]
    printer = Printer({"user_functions": {name: name for name in totals.values()}, "allow_unknown_functions": True})
    common, bodies = cse(bodies, symbols=numbered_symbols("t_"), order="none", list=True)
    arguments = sorted(set(leaves) | set(extra), key=str)
    names = [str(leaves.get(a, a)) for a in arguments]
    lines = [f"def kernel({', '.join([*names, *totals.values()])}):"]
    lines += [f"    {name} = {printer.doprint(value)}" for name, value in common]
    lines += [f"    return ({', '.join(printer.doprint(body) for body in bodies)},)"]
    source = "\n".join(lines)
    namespace: dict[str, Any] = {"numpy": np}
    exec(compile(source, "<generated>", "exec"), namespace)  # printed from our own expressions, never foreign text
    return Kernel(tuple(arguments), tuple(totals), source, namespace["kernel"])


@dataclass(frozen=True)
class Program:
    """The kernels of a sheet: of each column's formula, or of its root's parts."""

    sheet: Sheet
    formulas: Mapping[str, Kernel]
    roots: Mapping[str, _RootKernels]
    conditions: Mapping[str, Kernel]

    @classmethod
    def of(cls, sheet: Sheet) -> Program:
        """Generate the program of a sheet."""
        formulas, roots, conditions = {}, {}, {}
        for column in sheet.order:
            if isinstance(column.rule, Formula):
                formulas[column.name] = kernel([column.rule.expression], sheet.indices)
            elif isinstance(column.rule, Root):
                roots[column.name] = _RootKernels.of(column.rule, sheet.indices)
            if column.requires:
                conditions[column.name] = kernel([c for c, _ in column.requires], sheet.indices)
        return cls(sheet, formulas, roots, conditions)

    @property
    def source(self) -> str:
        """The whole program as text, for whoever wants to read what was run."""
        parts = [f"# {name}\n{k.source}" for name, k in self.formulas.items()]
        parts += [f"# {name}: {part}\n{k.source}" for name, r in self.roots.items() for part, k in r.named]
        return "\n\n".join(parts)

    def run(
        self, labels: Mapping[str, Sequence[int]], counts: Mapping[str, int], data: Mapping[str, Array]
    ) -> Values:
        """Compute every column.

        Parameters
        ----------
        labels : mapping of axis name to sequence of int
            Row numbers of the axes that come with the data.
        counts : mapping of column name to int
            The scalars that say how often an axis repeats another.
        data : mapping of column name to float array (..., rows)
            The given columns in SI; NaN is a missing datum.
        """
        return _Run(self, lay_out(self.sheet, labels, counts), data).values()


@dataclass(frozen=True)
class _RootKernels:
    """Everything a root needs: its ends, its derivatives, and the cell's value from the unknown."""

    rule: Root
    ends: Kernel
    """low, high, start, the signs at the ends, the turning points."""
    at: Kernel
    """The form at the unknown."""
    step: Kernel
    """The form and what is subtracted from the unknown."""
    value: Kernel

    @classmethod
    def of(cls, rule: Root, sums: Mapping[Symbol, Axis]) -> _RootKernels:
        """Print the kernels of one root."""
        f = rule.expression
        unknown = rule.unknown
        low = rule.sign_low if rule.sign_low is not None else f.subs(unknown, rule.low)
        high = rule.sign_high if rule.sign_high is not None else f.subs(unknown, rule.high)
        all_f = derivatives(f, unknown)
        names = [Symbol(f"f_{i}", real=True) for i in range(4)]
        return cls(
            rule,
            kernel([rule.low, rule.high, rule.start, low, high, *rule.turning], sums),
            kernel([f], sums, [unknown]),
            kernel([f, householder(*names).xreplace(dict(zip(names, all_f, strict=True)))], sums, [unknown]),
            kernel([rule.value], sums, [unknown]),
        )

    @property
    def named(self) -> tuple[tuple[str, Kernel], ...]:
        """Its parts with their names."""
        return (("ends", self.ends), ("form", self.at), ("step", self.step), ("value", self.value))


class _Run:
    """One evaluation: fills values and statuses column by column, in the sheet's order."""

    def __init__(self, program: Program, layouts: dict[str, Layout], data: Mapping[str, Array]) -> None:
        self.program, self.layouts, self.data = program, layouts, data
        self.sheet = program.sheet
        self.value: dict[str, Array] = {}
        self.status: dict[str, Codes] = {}
        self.roots: dict[str, dict[int, tuple[float, ...]]] = {}
        self.counted: dict[str, dict[str, int]] = {}

    def values(self) -> Values:
        with np.errstate(all="ignore"):
            for column in self.sheet.order:
                self.compute(column)
        return Values(self.sheet, self.layouts, self.value, self.status, self.roots, self.counted)

    def compute(self, column: Column) -> None:
        if isinstance(column.rule, Given):
            value = np.atleast_1d(np.asarray(self.data[column.name], dtype=np.float64))
            status = np.where(np.isfinite(value), Status.OK, Status.INPUT).astype(np.uint8)
        else:
            kept = self._rows_kept(column)
            status = self._inherited(column, kept)
            if isinstance(column.rule, Root):
                value, found = self._root(column, self.program.roots[column.name], kept, status)
                status = np.where(status == Status.OK, found, status).astype(np.uint8)
            else:
                value = self._call(self.program.formulas[column.name], column, kept)[0]
                shape = np.broadcast_shapes(value.shape, status.shape, (self._size(column),))
                value, status = np.broadcast_to(value, shape), np.broadcast_to(status, shape)
            if column.requires:
                held = self._call(self.program.conditions[column.name], column, kept)
                for holds in held:
                    status = np.where((status == Status.OK) & ~np.asarray(holds, dtype=bool), Status.DOMAIN, status)
        status = np.where((status == Status.OK) & ~np.isfinite(value), Status.DOMAIN, status).astype(np.uint8)
        self.value[column.name] = np.where(status == Status.OK, value, np.nan)
        self.status[column.name] = status

    # --- what a kernel is called with ----------------------------------------------------------------

    def _size(self, column: Column) -> int:
        return 1 if column.axis is None else self.layouts[column.axis.name].size

    def _rows(self, cell: Expr, column: Column) -> NDArray[np.intp] | None:
        """The rows that a cell names, for every row of its axis; None if that is each in turn."""
        index = cell.indices[0]
        for axis in ([] if column.axis is None else [column.axis]) + list(self.sheet.summed_axes(column)):
            if index in axis.maps:
                return None if index == axis.index else self.layouts[axis.name].rows[index]
        raise AssertionError(f"{cell} in {column.name} was not checked by the sheet")

    def _take(self, table: Mapping[str, Any], cell: Expr, column: Column) -> Any:
        array = table[name_of(cell)]
        if not isinstance(cell, Indexed):
            return array
        rows = self._rows(cell, column)
        return array if rows is None else array[..., rows]

    def _argument(self, cell: Expr, column: Column, kept: Mapping[str, Any]) -> Any:
        if cell in self.sheet.sizes:
            axis = self.sheet.sizes[cell]
            mask = kept.get(axis.name)
            if mask is None:
                return np.array([float(self.layouts[axis.name].size)])
            return np.count_nonzero(mask, axis=-1, keepdims=True).astype(float)
        if not isinstance(cell, Indexed) and cell.name not in self.sheet:
            for layout in self.layouts.values():
                if cell in layout.ordinals:
                    return layout.ordinals[cell]
        return self._take(self.value, cell, column)

    def _call(self, function: Kernel, column: Column, kept: Mapping[str, Any], *unknown: Any) -> tuple[Array, ...]:
        own = column.rule.unknown if isinstance(column.rule, Root) else None
        arguments = [unknown[0] if a == own else self._argument(a, column, kept) for a in function.arguments]
        totals = [self._total(kept.get(axis)) for axis in function.totals]
        return tuple(np.asarray(out) for out in function.run(*arguments, *totals))

    @staticmethod
    def _total(mask: Any) -> Callable[[Array], Array]:
        """A sum over the rows that have values; NumPy adds pairwise along the last dimension."""

        def total(terms: Array) -> Array:
            if mask is not None:
                terms = np.where(mask, terms, 0.0)
            return np.asarray(np.sum(np.ascontiguousarray(terms), axis=-1, keepdims=True))

        return total

    # --- statuses -------------------------------------------------------------------------------------

    def _rows_kept(self, column: Column) -> dict[str, NDArray[np.bool_]]:
        """For every axis that is summed over, the rows whose cells all have values.

        A pair without a root must not take the mean of all others with it. The rows that are left out are
        counted, and every view says so.
        """
        kept: dict[str, NDArray[np.bool_]] = {}
        for axis in self.sheet.summed_axes(column):
            mask = np.ones(self.layouts[axis.name].size, dtype=bool)
            for cell in self.sheet.references(column):
                if isinstance(cell, Indexed) and cell.indices[0] in axis.maps:
                    mask = mask & (self._take(self.status, cell, column) == Status.OK)
            kept[axis.name] = mask
            if mask.ndim == 1 and not mask.all():
                self.counted.setdefault(column.name, {})[axis.name] = int(mask.sum())
        return kept

    def _inherited(self, column: Column, kept: Mapping[str, Any]) -> Codes:
        """The first error among the precedents; a sum has one only if none of its rows has a value."""
        status: Any = np.zeros(self._size(column), dtype=np.uint8)
        declared = {c.name: n for n, c in enumerate(self.sheet.columns)}
        for cell in sorted(self.sheet.references(column), key=lambda c: (declared[name_of(c)], str(c))):
            theirs = self._take(self.status, cell, column)
            if isinstance(cell, Indexed) and (column.axis is None or cell.indices[0] not in column.axis.maps):
                mask = next(kept[a.name] for a in self.sheet.summed_axes(column) if cell.indices[0] in a.maps)
                theirs = np.where(mask.any(axis=-1, keepdims=True), 0, theirs[..., :1])
            status = np.where(status == Status.OK, theirs, status)
        return np.asarray(status, dtype=np.uint8)

    # --- roots ----------------------------------------------------------------------------------------

    def _root(
        self, column: Column, kernels: _RootKernels, kept: Mapping[str, Any], inherited: Codes
    ) -> tuple[Array, Codes]:
        """Decide how many roots there are, then take fixed steps inside the bracket of the only one."""
        rule = kernels.rule
        ends = self._call(kernels.ends, column, kept)
        shape = np.broadcast_shapes(*(e.shape for e in ends), inherited.shape)
        low, high, start, at_low, at_high, *turning = (np.broadcast_to(e, shape) for e in ends)
        # A turning point outside the interval, or not a number, closes an empty stretch at its left end.
        places, signs = [low], [np.sign(at_low)]
        for point in turning:
            inside = (point > places[-1]) & (point < high)
            here = np.where(inside, point, places[-1])
            sign = np.sign(self._call(kernels.at, column, kept, here)[0])
            places.append(here)
            signs.append(np.where(inside, sign, signs[-1]))
        places.append(high)
        signs.append(np.sign(at_high))
        crossings = [a * b < 0 for a, b in zip(signs, signs[1:], strict=False)]
        number = sum(c.astype(np.uint8) for c in crossings)
        status = np.select([number == 1, number > 1], [Status.OK, Status.TWOROOTS], Status.NOROOT).astype(np.uint8)

        def solve(which: Sequence[Any]) -> Array:
            bracket = (np.select(which, places[:-1], np.nan), np.select(which, places[1:], np.nan))
            rising = np.select(which, signs[1:], 0.0)
            return self._polish(column, kernels, kept, bracket, rising, start)

        value = solve(crossings)
        if status.ndim == 1 and (status == Status.TWOROOTS).any():
            self._keep_roots(column, crossings, solve, status)
        return self._call(kernels.value, column, kept, value)[0], status

    def _polish(
        self,
        column: Column,
        kernels: _RootKernels,
        kept: Mapping[str, Any],
        bracket: tuple[Array, Array],
        rising: Array,
        start: Array,
    ) -> Array:
        """Fourth-order steps; one that leaves the bracket is replaced by the middle of what is left of it."""
        left, right = bracket
        here = np.where((start > left) & (start < right), start, (left + right) / 2)
        for _ in range(kernels.rule.steps):
            f, step = self._call(kernels.step, column, kept, here)
            beyond = f * rising > 0
            left, right = np.where(beyond, left, here), np.where(beyond, here, right)
            there = here - step
            ok = (there >= left) & (there <= right)
            here = np.where(f == 0, here, np.where(ok, there, (left + right) / 2))
        return here

    def _keep_roots(
        self, column: Column, crossings: Sequence[Any], solve: Callable[[Sequence[Any]], Array], status: Codes
    ) -> None:
        """Solve every stretch of the ambiguous rows, so that the message can name all roots."""
        kernels = self.program.roots[column.name]
        none = [np.zeros_like(c) for c in crossings]
        each = []
        for n, crossing in enumerate(crossings):
            found = solve([*none[:n], crossing, *none[n + 1 :]])
            each.append(np.where(crossing, self._call(kernels.value, column, {}, found)[0], np.nan))
        for row in np.flatnonzero(status == Status.TWOROOTS):
            roots = sorted(float(r[row]) for r in each if np.isfinite(r[row]))
            self.roots.setdefault(column.name, {})[int(row)] = tuple(roots)


def evaluate(
    sheet: Sheet, labels: Mapping[str, Sequence[int]], data: Mapping[str, Any], program: Program | None = None
) -> Values:
    """Compute a sheet from given columns.

    Parameters
    ----------
    sheet : Sheet
    labels : mapping of axis name to sequence of int
        Row numbers of the axes that come with the data.
    data : mapping of column name to float array (..., rows) or float
        The given columns in SI.
    program : Program, optional
        The sheet's program, if it was generated before.
    """
    arrays = {name: np.atleast_1d(np.asarray(values, dtype=np.float64)) for name, values in data.items()}
    counts = {axis.count: int(arrays[axis.count].flat[0]) for axis in sheet.axes if isinstance(axis, RepeatAxis)}
    return (program or Program.of(sheet)).run(labels, counts, arrays)
