"""The NumPy engine: prints each rule as a function of arrays and runs it over all rows at once.

The last dimension of every array is the rows of its column's axis (one row for a scalar); leading
dimensions are a batch, so that one program serves one report and a million draws. The program is text
made by :mod:`~loopsheet.report.engines.numpy_code` from the sheet's own expressions.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..layout import Layout, lay_out, precedents, rows_of
from ..sheet import Column, Formula, Given, Reference, RepeatAxis, Root, Sheet, name_of
from ..values import Status, Values, how_many, inherited, rows_kept
from .domain import SMALLEST, defined, positive, typed
from .numpy_code import SAME, Array, Function, Kernel, kernel, write
from .numpy_root import RootProgram
from .numpy_rows import Kept

__all__ = ["Kernel", "Program", "evaluate", "extend", "kernel"]

Codes = NDArray[np.uint8]
Masks = Mapping[str, NDArray[np.bool_]]

BLOCK = 1 << 13
"""How many roots are sought at a time: their intermediate results then stay in the processor's cache."""


@dataclass(frozen=True)
class Program:
    """The kernels of a sheet: of each column's formula, or of its root's parts, and of its conditions.

    For a given column, that of what its values must satisfy; for a formula that has no value somewhere, that
    of where it has one, and for one of which more than its value says so, that of where it is positive.
    """

    sheet: Sheet
    formulas: Mapping[str, Kernel]
    roots: Mapping[str, RootProgram]
    conditions: Mapping[str, Kernel]
    guards: Mapping[str, Function]
    domains: Mapping[str, Kernel]
    positive: Mapping[str, Kernel]

    @classmethod
    def of(cls, sheet: Sheet, known: Collection[str] = (), functions: Any = SAME) -> Program:
        """Generate the program of a sheet.

        Parameters
        ----------
        sheet : Sheet
        known : collection of str
            Columns that are computed already.
        functions : module
            What computes exponentials, logarithms and powers: NumPy itself is several times as fast, for
            draws by the million, but its last bits hang on the processor.

        Raises
        ------
        SheetError
            A formula has a part that NumPy cannot compute.
        """
        formulas, roots, conditions, guards, domains, signs = {}, {}, {}, {}, {}, {}
        for column in sheet.order:
            if column.name in known:
                continue
            if column.name in sheet.guards:
                datum, allowed = sheet.guards[column.name]
                _, guards[column.name] = write([datum], (), [allowed], functions)
            if isinstance(column.rule, Formula):
                formulas[column.name] = kernel([column.rule.expression], sheet.indices, functions)
                formula = typed(sheet, column.rule.expression)
                if column.positive and (sign := positive(formula)) != False:  # noqa: E712 - sympy's false
                    signs[column.name] = kernel([sign], sheet.indices, functions)
                if (domain := defined(formula)) != True:  # noqa: E712 - sympy's true
                    domains[column.name] = kernel([domain], sheet.indices, functions)
            elif isinstance(column.rule, Root):
                roots[column.name] = RootProgram.of(sheet, column, functions)
            if column.requires:
                conditions[column.name] = kernel([c for c, _ in column.requires], sheet.indices, functions)
        return cls(sheet, formulas, roots, conditions, guards, domains, signs)

    @cached_property
    def guessing(self) -> Program:
        """The same without counting roots by intervals: what it finds is not known to be the only root."""
        if all(root.enclosing is None for root in self.roots.values()):
            return self
        return replace(self, roots={name: replace(root, counted=False) for name, root in self.roots.items()})

    @property
    def source(self) -> str:
        """The whole program as text, for whoever wants to read what was run."""
        parts = [f"# {name}\n{k.source}" for name, k in self.formulas.items()]
        parts += [f"# {name}\n{root.source}" for name, root in self.roots.items()]
        parts += [f"# {name}: conditions\n{k.source}" for name, k in self.conditions.items()]
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
            The given columns in SI; NaN is a missing datum. Leading dimensions broadcast.
        """
        return _Run(self, lay_out(self.sheet, labels, counts), data).values()


class _Run:
    """One evaluation: fills values and statuses column by column, in the sheet's order."""

    def __init__(
        self,
        program: Program,
        layouts: dict[str, Layout],
        data: Mapping[str, Array],
        known: Values | None = None,
    ) -> None:
        self.program, self.layouts, self.data = program, layouts, data
        self.sheet = program.sheet
        self.value: dict[str, Array] = dict(known.value) if known else {}
        self.status: dict[str, Codes] = dict(known.status) if known else {}
        self.roots: dict[str, Mapping[int, tuple[float, ...]]] = dict(known.roots) if known else {}
        self.counted: dict[str, Mapping[str, int]] = dict(known.counted) if known else {}
        self.broken: dict[str, Codes] = dict(known.broken) if known else {}

    def values(self) -> Values:
        with np.errstate(all="ignore"):
            for column in self.sheet.order:
                if column.name in self.value:
                    continue
                given = isinstance(column.rule, Given)
                value, status = self._given(column) if given else self._computed(column)
                self.value[column.name] = np.where(status == Status.OK, value, np.nan)
                self.status[column.name] = status.astype(np.uint8)
        return Values(
            self.sheet, self.layouts, self.value, self.status, self.roots, self.counted, self.broken
        )

    def _given(self, column: Column) -> tuple[Array, Codes]:
        value = np.atleast_1d(np.asarray(self.data[column.name], dtype=np.float64))
        size = self._size(column)
        if value.shape[-1] != size:
            raise ValueError(
                f"{column.name} has {value.shape[-1]} rows, not {size}: the last dimension is the rows"
            )
        allowed = np.isfinite(value)
        if column.name in self.program.guards:
            allowed = allowed & self.program.guards[column.name](value)[0]
        return value, np.where(allowed, Status.OK, Status.INPUT).astype(np.uint8)

    def _computed(self, column: Column) -> tuple[Array, Codes]:
        named = precedents(self.sheet, self.layouts, column)
        kept = rows_kept(named, self.layouts, self.status)
        self._count(column, kept)
        status = inherited(named, kept, self.status, self._size(column))
        if isinstance(column.rule, Root):
            value, found = self._root(column, kept, status)
            beyond = np.isinf(value) | (column.positive & (value > 0) & (value < SMALLEST))
            odd = [(found == Status.OK) & condition for condition in (np.isnan(value), beyond)]
            found = np.select(odd, [Status.DOMAIN, Status.OVERFLOW], found).astype(np.uint8)
        else:
            (value,) = self._call(self.program.formulas[column.name], column, kept)
            found = self._found(column, value, kept)
        if column.requires:
            found = self._required(column, kept, status, found)
        shape = np.broadcast_shapes(value.shape, found.shape, status.shape)
        status = np.where(status == Status.OK, found, status)
        return np.broadcast_to(value, shape), np.broadcast_to(status, shape)

    def _found(self, column: Column, value: Array, kept: Masks) -> Codes:
        """What the values of a formula are: one that a double holds, one that none does, or none."""
        held, beyond = np.isfinite(value), ~np.isfinite(value)
        if column.positive:
            beyond = (beyond & (value != -np.inf)) | ((value > 0) & (value < SMALLEST))
            held = held & (value >= SMALLEST)
        if held.all():
            return np.zeros(value.shape, dtype=np.uint8)
        if column.name in self.program.positive:
            beyond = beyond | ((value == 0) & self._holds(self.program.positive, column, kept))
        if column.name in self.program.domains:
            beyond = beyond & self._holds(self.program.domains, column, kept)
        found = np.select([held, beyond], [Status.OK, Status.OVERFLOW], Status.DOMAIN)
        return found.astype(np.uint8)

    def _holds(self, kernels: Mapping[str, Kernel], column: Column, kept: Masks) -> Array:
        (holds,) = self._call(kernels[column.name], column, kept)
        return holds.astype(bool)

    def _required(self, column: Column, kept: Masks, status: Codes, found: Codes) -> Codes:
        """What breaks a condition is outside the domain, whatever the rule made of it."""
        held = self._call(self.program.conditions[column.name], column, kept)
        broken: Any = np.zeros(1, dtype=np.uint8)
        for number, holds in enumerate(held, start=1):
            broken = np.where((broken == 0) & ~np.asarray(holds, dtype=bool), number, broken)
        broken = np.where(status == Status.OK, broken, 0).astype(np.uint8)
        self.broken[column.name] = broken
        return np.where(broken > 0, Status.DOMAIN, found).astype(np.uint8)

    def _count(self, column: Column, kept: Masks) -> None:
        if some := how_many(kept):
            self.counted[column.name] = some

    # --- what a kernel is called with ----------------------------------------------------------------

    def _size(self, column: Column) -> int:
        return 1 if column.axis is None else self.layouts[column.axis.name].size

    def _call(self, function: Kernel, column: Column, kept: Masks) -> list[Array]:
        arguments = [self._argument(reference, column, kept) for reference in function.references]
        totals = self._totals(kept)
        results = function.run(*arguments, *(totals[axis] for axis in function.totals))
        size = self._size(column)
        return [np.broadcast_to(r, np.broadcast_shapes(np.shape(r), (size,))) for r in results]

    def _argument(self, reference: Reference, column: Column, kept: Masks) -> Array:
        """All rows of what a kernel names."""
        cell, axis = reference.cell, reference.over or column.axis
        if cell in self.sheet.sizes:
            return self._how_many(self.sheet.sizes[cell].name, kept)
        if axis is not None and cell in axis.ordinals:
            return self.layouts[axis.name].ordinals[cell]
        rows = rows_of(cell, axis, self.layouts)
        value = self.value[name_of(cell)]
        # take() keeps the rows of each batch element together in memory, indexing does not.
        return value if rows is None else value.take(rows, axis=-1)

    def _how_many(self, axis: str, kept: Masks) -> Array:
        """How many rows an axis has; for a column that sums over it, those that it sums."""
        return self._kept(axis, kept).number

    def _totals(self, kept: Masks) -> dict[str, Kept]:
        return {axis.name: self._kept(axis.name, kept) for axis in self.sheet.axes}

    def _kept(self, axis: str, kept: Masks) -> Kept:
        return Kept(kept.get(axis, np.ones(self.layouts[axis].size, dtype=bool)))

    # --- roots ----------------------------------------------------------------------------------------

    def _root(self, column: Column, kept: Masks, inherited: Codes) -> tuple[Array, Codes]:
        program, totals = self.program.roots[column.name], self._totals(kept)
        references = program.fixed.references
        if program.totals or program.fixed.totals:
            arguments = [self._argument(reference, column, kept) for reference in references]
            batch = [
                inherited.shape,
                *(self._how_many(a.name, kept).shape for a in self.sheet.summed_axes(column)),
            ]
            batch += [(*a.shape[:-1], 1) for a in arguments]
            solved = program.solve(arguments, totals, np.broadcast_shapes(*batch, (self._size(column),)))
            if solved.several and inherited.reshape(-1)[0] == Status.OK:
                self.roots[column.name] = solved.several
            return solved.value, solved.status
        arguments = [self._argument(reference, column, kept) for reference in references]
        shape = np.broadcast_shapes(*(a.shape for a in arguments), inherited.shape)
        value, status = np.empty(shape), np.empty(shape, dtype=np.uint8)
        several: dict[int, tuple[float, ...]] = {}
        for block, own in _blocks(shape):
            part = [a[block] if a.ndim == len(shape) and a.shape[0] > 1 else a for a in arguments]
            solved = program.solve(part, totals, own)
            value[block], status[block] = solved.value, solved.status
            for row, roots in solved.several.items():
                if inherited[min(row + block.start, inherited.shape[-1] - 1)] == Status.OK:
                    several[row + block.start] = roots
        if several:
            self.roots[column.name] = several
        return value, status


def _blocks(shape: tuple[int, ...]) -> Iterator[tuple[slice, tuple[int, ...]]]:
    """Slices of the first dimension that make blocks of about :data:`BLOCK` cells, and their shapes."""
    each = max(1, BLOCK // max(1, int(np.prod(shape[1:]))))
    for start in range(0, shape[0], each):
        stop = min(start + each, shape[0])
        yield slice(start, stop), (stop - start, *shape[1:])


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
        The given columns in SI; a scalar has one row, so that a batch of it has the shape (..., 1).
    program : Program, optional
        The sheet's program, if it was generated before.

    Raises
    ------
    ValueError
        A column has not as many rows as its axis, or a batch has several numbers of rows.
    """
    arrays = _arrays(data)
    return (program or Program.of(sheet)).run(labels, _counts(sheet, arrays), arrays)


def extend(values: Values, columns: Sequence[Column], data: Mapping[str, Any]) -> Values:
    """Compute more columns of a sheet; those that are computed stay as they are.

    Parameters
    ----------
    values : Values
        All columns of the sheet.
    columns : sequence of Column
        Those that come after them.
    data : mapping of column name to float array (..., rows) or float
        The given ones among these, in SI.

    Raises
    ------
    ValueError
        As for :func:`evaluate`.
    """
    sheet = Sheet((*values.sheet.columns, *columns))
    labels = {
        axis.name: values.layouts[axis.name].labels[:, 0].tolist() for axis in sheet.axes if not axis.parents
    }
    arrays = _arrays(data)
    layouts = lay_out(sheet, labels, _counts(sheet, {**values.value, **arrays}))
    return _Run(Program.of(sheet, values.value), layouts, arrays, values).values()


def _arrays(data: Mapping[str, Any]) -> dict[str, Array]:
    return {name: np.atleast_1d(np.asarray(values, dtype=np.float64)) for name, values in data.items()}


def _counts(sheet: Sheet, values: Mapping[str, Array]) -> dict[str, int]:
    """How often each axis that repeats another does: one number for a whole batch, 0 if it is not allowed."""
    counts = {}
    for axis in sheet.axes:
        if isinstance(axis, RepeatAxis):
            numbers = np.unique(values[axis.count]).tolist()
            if len(numbers) != 1:
                raise ValueError(
                    f"{axis.count} must be one number for the whole batch, not {', '.join(map(str, numbers))}"
                )
            counts[axis.count] = int(numbers[0]) if sheet.bounds[axis.count].allow(numbers[0]) else 0
    return counts
