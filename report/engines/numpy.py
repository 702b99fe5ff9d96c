"""The NumPy engine: prints each rule as a function of arrays and runs it over all rows at once.

The last dimension of every array is the rows of its column's axis (one row for a scalar); leading
dimensions are a batch, so that one program serves one report and a million draws. The program is text
made by :mod:`~loopsheet.report.engines.numpy_code` from the sheet's own expressions.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..cells.layout import Layout, height, lay_out, precedents
from ..cells.values import Status, Values, how_many, inherited, rows_kept
from ..plan.kept import of_sheet
from ..quantity import SMALLEST
from ..sheet import Column, Loop, Sheet
from .kernels import SAME, Array, Function, Kernel, compiled
from .numpy_loop import LoopProgram, Settling
from .numpy_root import RootProgram
from .numpy_rows import Kept, chosen, in_groups

Codes = NDArray[np.uint8]
Masks = Mapping[str, NDArray[np.bool_]]

BLOCK = 1 << 13
"""How many roots are sought at a time: their intermediate results then stay in the processor's cache."""
WIDEST = 1 << 16
"""How many cells the widest column has, at most, of what is computed of a batch at a time."""


@dataclass(frozen=True, eq=False)
class Program:
    """The function of a sheet, and the parts that it asks for."""

    sheet: Sheet
    known: Collection[str]
    """Columns that are computed already."""
    function: Function
    """Called with a run."""
    roots: Mapping[str, RootProgram]
    """By column name."""
    loops: Mapping[str, LoopProgram]
    """By column name."""
    source: str
    """The text of the function; those of roots and loops are their own."""
    functions: Any = SAME
    """What computes exponentials, logarithms and powers."""
    _laid: dict[Any, Laid] = field(default_factory=dict, repr=False)

    @classmethod
    def of(
        cls, sheet: Sheet, known: Collection[str] = (), functions: Any = SAME, alone: str | None = None
    ) -> Program:
        """Generate the program of a sheet, or take it as it was printed before.

        Parameters
        ----------
        known : collection of str
            Columns that are computed already.
        functions : module
            What computes exponentials, logarithms and powers: NumPy itself is several times as fast, for
            draws by the million, but its last bits hang on the processor.
        alone : str, optional
            A column of which nothing is wanted but its values, where it is known that it has them.

        Raises
        ------
        SheetError
            A formula has a part that NumPy cannot compute.
        """

        def make() -> dict[str, Any]:
            from ..plan.lowering import lowered
            from .numpy_texts import program_texts

            plan = lowered(sheet, known)
            return program_texts(sheet, plan.alone(alone) if alone else plan)

        what = f"NumPy program of {alone} alone" if alone else "NumPy program"
        texts = of_sheet(sheet, what, sorted(known), make)
        return cls.of_texts(sheet, texts, functions, known)

    @classmethod
    def of_texts(
        cls,
        sheet: Sheet,
        texts: Mapping[str, Any],
        functions: Any = SAME,
        known: Collection[str] = (),
    ) -> Program:
        """The program of printed functions.

        `texts`: from :func:`~loopsheet.report.engines.numpy_texts.program_texts`. `functions` and `known`: as
        for :meth:`of`.
        """
        roots = {name: RootProgram.of(root, functions) for name, root in texts["roots"].items()}
        loops = {name: LoopProgram.of(loop, functions) for name, loop in texts["loops"].items()}
        function = compiled(texts["sheet"], functions)
        return cls(sheet, known, function, roots, loops, texts["sheet"], functions)

    def run(
        self,
        labels: Mapping[str, Sequence[int]],
        counts: Mapping[str, int],
        data: Mapping[str, Array],
        out: Mapping[str, Array] | None = None,
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
        out : mapping of column name to float array (..., rows), optional
            As for :func:`evaluate`.
        """
        laid = self.laid(labels, counts)
        batch = np.broadcast_shapes(*(own.shape[:-1] for own in data.values()))
        widest = max(map(laid.size, self.sheet.columns))
        blocks: list[Any] = [block for block, _ in _blocks((*batch, widest), WIDEST)] if batch else [...]
        if len(blocks) < 2 and out is None:
            return _Run(self, laid, data).values()
        shapes = laid.shapes(data)
        whole: dict[str, Any] = {"value": _writable(out or {}, shapes, data)}
        # What rests on nothing that is split into blocks is the same in all of them.
        split = {name for name, shape in shapes.items() if len(shape) > len(batch) and shape[0] > 1}
        first = None
        for block in blocks:
            own = {name: datum[block] if name in split else datum for name, datum in data.items()}
            found = _Run(self, laid, own).values()
            first = first or found
            for kind in ("value", "status", "broken"):
                arrays = whole.setdefault(kind, {})
                for name, part in getattr(found, kind).items():
                    if out is None or name in out:
                        if name not in arrays:
                            arrays[name] = np.empty(shapes[name], part.dtype)
                        arrays[name][block if name in split else ...] = part
        assert first is not None
        return replace(first, **whole)

    def laid(self, labels: Mapping[str, Sequence[int]], counts: Mapping[str, int]) -> Laid:
        """The sheet over rows; that of the last ones is kept."""
        key = tuple((name, tuple(own)) for name, own in labels.items()), tuple(counts.items())
        if key not in self._laid:
            self._laid.clear()
            self._laid[key] = Laid(self.sheet, lay_out(self.sheet, labels, counts))
        return self._laid[key]

    @cached_property
    def guessing(self) -> Program:
        """The same without counting roots by intervals: what it finds is not known to be the only root."""
        if all(root.enclosing is None for root in self.roots.values()):
            return self
        return replace(self, roots={name: replace(root, counted=False) for name, root in self.roots.items()})

    def conditions(self, name: str) -> tuple[_Condition, _Condition]:
        """Where a formula is positive although no double may hold it, and where it has a value at all."""
        if name not in self._conditions:

            def make() -> list[Any]:
                from ..plan.lowering import lowered
                from .numpy_texts import condition_texts

                return condition_texts(lowered(self.sheet, self.known), name)

            texts = of_sheet(self.sheet, "conditions of a value", [name, *sorted(self.known)], make)
            positive, defined = (_Condition.of(each, self.functions) for each in texts)
            self._conditions[name] = positive, defined
        return self._conditions[name]

    @cached_property
    def _conditions(self) -> dict[str, tuple[_Condition, _Condition]]:
        return {}


@dataclass(frozen=True)
class _Condition:
    """A condition that holds always, never, or where a function says so of what it reads."""

    certain: bool
    kernel: Kernel | None = None
    reads: Sequence[tuple[str, str, str, str]] = ()

    @classmethod
    def of(cls, texts: Any, functions: Any) -> _Condition:
        """That of what :func:`~loopsheet.report.engines.numpy_texts.condition_texts` prints."""
        if isinstance(texts, bool):
            return cls(texts)
        return cls(False, Kernel.of_plain(texts["kernel"], functions), texts["reads"])


class Laid:
    """A sheet over the rows of its axes: what does not change with the data."""

    def __init__(self, sheet: Sheet, layouts: dict[str, Layout]) -> None:
        self.sheet, self.layouts = sheet, layouts
        self.named = {c.name: precedents(sheet, layouts, c) for c in sheet.columns}
        self.names = {name: {each.column.name for each in named} for name, named in self.named.items()}
        self.empty = {
            name
            for name, named in self.named.items()
            if any(each.over is not None and not layouts[each.over.name].size for each in named)
        }
        """The columns that sum over no rows at all."""
        self.every = {name: self.kept(name, np.ones(own.size, dtype=bool)) for name, own in layouts.items()}

    def kept(self, axis: str, mask: NDArray[np.bool_]) -> Any:
        """Some rows of an axis, those of each group by themselves if it has groups."""
        return in_groups(Kept(mask), self.layouts[axis])

    def shapes(self, data: Mapping[str, Array]) -> dict[str, tuple[int, ...]]:
        """The shape of every column: a batch has what rests on one."""
        found: dict[str, tuple[int, ...]] = {name: own.shape for name, own in data.items()}
        for column in self.sheet.order:
            if column.name not in found:
                loop = self.sheet.loop_of.get(column.name) or Loop.of([column])
                named = set().union(*(self.names[name] for name in loop.names)) - loop.names
                leading = np.broadcast_shapes(*(found[name][:-1] for name in named))
                found |= {each.name: (*leading, self.size(each)) for each in loop.columns}
        return found

    def size(self, column: Column) -> int:
        """How many rows a column has."""
        return height(column, self.layouts)


class Numbered:
    """What printed functions ask of the rows of an axis before there are any values."""

    laid: Laid

    def ordinal(self, axis: str, index: str) -> Array:
        """A running number of the rows of an axis."""
        return self.laid.layouts[axis].ordinals[index]

    def size(self, axis: str) -> Array:
        """How many rows an axis has."""
        return np.array([self.laid.layouts[axis].size], dtype=np.float64)


class _Run(Numbered):
    """One evaluation: what the printed function calls, column by column in the sheet's order.

    As long as no cell that is named is in error, nothing is asked of single rows.
    """

    def __init__(
        self, program: Program, laid: Laid, data: Mapping[str, Array], known: Values | None = None
    ) -> None:
        self.program, self.laid, self.data, self.sheet = program, laid, data, program.sheet
        self.value: dict[str, Array] = dict(known.value) if known else {}
        self.status: dict[str, Codes] = dict(known.status) if known else {}
        self.roots: dict[str, Mapping[int, tuple[float, ...]]] = dict(known.roots) if known else {}
        self.counted: dict[str, Mapping[str, int]] = dict(known.counted) if known else {}
        self.broken: dict[str, Codes] = dict(known.broken) if known else {}
        self.wrong = {name for name, codes in self.status.items() if codes.any()}
        """The columns of which some cell is in error."""
        self.masks: dict[str, Masks] = {}
        self.parts: dict[str, Array] = {}
        self.passes = dict(known.passes) if known else {}

    def values(self) -> Values:
        with np.errstate(all="ignore"):
            self.program.function(self)
        return Values(
            self.sheet, self.laid.layouts, self.value, self.status, self.roots, self.counted, self.broken,
            passes=self.passes,
        )  # fmt: skip

    # --- rows

    def rows(self, name: str, axis: str, index: str) -> Array:
        """The cells of a column that the rows of an axis name by an index."""
        rows = self.laid.layouts[axis].rows[index]
        # take() keeps the rows of each batch element together in memory, indexing does not.
        return self.value[name].take(rows, axis=-1)

    def kept(self, name: str, axis: str) -> Any:
        """The rows of an axis over which the sums of a column run."""
        mask = self._masks(name).get(axis)
        return self.laid.every[axis] if mask is None else self.laid.kept(axis, mask)

    def _odd(self, name: str) -> bool:
        """Whether a column may inherit an error."""
        return name in self.laid.empty or not self.wrong.isdisjoint(self.laid.names[name])

    def _masks(self, name: str) -> Masks:
        """For the axes that a column sums over, the rows kept, if some are left out."""
        if not self._odd(name):
            return {}
        if name not in self.masks:
            self.masks[name] = rows_kept(self.laid.named[name], self.laid.layouts, self.status)
            if some := how_many(self.masks[name]):
                self.counted[name] = some
        return self.masks[name]

    def part(self, name: str, axis: str | None, value: Any) -> Array:
        """Numbers that are no column; NaN where there are none."""
        size = 1 if axis is None else self.laid.layouts[axis].size
        if np.shape(value)[-1:] != (size,):
            value = np.broadcast_to(value, np.broadcast_shapes(np.shape(value), (size,)))
        known = np.isfinite(value)
        self.parts[name] = value if known.all() else np.where(known, value, np.nan)
        return self.parts[name]

    # --- columns

    def given(self, name: str, value: Array, allowed: Any = True) -> Array:
        """The data of a column."""
        size = self.laid.size(self.sheet[name])
        if value.shape[-1] != size:
            raise ValueError(f"{name} has {value.shape[-1]} rows, not {size}: the last dimension is the rows")
        allowed = np.isfinite(value) & allowed
        return self._hold(name, value, np.where(allowed, Status.OK, Status.INPUT).astype(np.uint8))

    def formula(self, name: str, value: Any, *requires: Any) -> Array:
        """A column by its formula, and whether its conditions hold."""
        column = self.sheet[name]
        size = self.laid.size(column)
        value = np.asarray(value, dtype=np.float64)  # one of several whole numbers is a number, too
        shape = value.shape
        if requires or not shape or shape[-1] != size:
            shape = np.broadcast_shapes(shape, (size,), *map(np.shape, requires))
            value = np.broadcast_to(value, shape).copy()
        if not self._odd(name) and _held(value, column.positive).all() and all(map(np.all, requires)):
            if requires:
                self.broken[name] = np.zeros(shape, dtype=np.uint8)
            return self._hold(name, value, np.zeros(shape, dtype=np.uint8))
        return self._computed(column, value, self._found(column, value), requires)

    def root(self, name: str, arguments: Sequence[Array], requires: Sequence[Any] = ()) -> Array:
        """A column by its root."""
        column, program = self.sheet[name], self.program.roots[name]
        status = self._inherited(column)
        value, found = self._solved(column, program, arguments, status)
        beyond = np.isinf(value) | (column.positive & (value > 0) & (value < SMALLEST))
        odd = [(found == Status.OK) & condition for condition in (np.isnan(value), beyond)]
        found = chosen(odd, [Status.DOMAIN, Status.OVERFLOW], found).astype(np.uint8)
        return self._computed(column, value, found, requires, status)

    def loop(self, name: str) -> None:
        """Columns that rest on one another, by passes until they stay."""
        program = self.program.loops[name]
        every = [self.sheet[each] for each in (*program.formulas, *program.iterated)]
        for column in every:
            self._hold(column.name, np.full(size := self.laid.size(column), np.nan), np.zeros(size, np.uint8))
        while True:  # until all know of the errors before the loop that reach them
            known = [self.status[column.name] for column in every]
            for column in every:
                self.masks.pop(column.name, None)
                own = self._inherited(column)
                self._hold(column.name, np.full(own.shape, np.nan), own)
            if all(map(np.array_equal, known, (self.status[column.name] for column in every))):
                break
        program.start(self)
        begun = {each: self.status[each] for each in program.iterated}
        settling = Settling(begun)
        while not settling.ended:
            before = {each: self.value[each] for each in program.iterated}
            self._again(program)
            settling.after(before, self.value, self.status)
            self._put(settling.values, begun)
        self.passes[name] = settling.passes
        if settling.failed.any():
            self._put(settling.values, settling.statuses)
        values, statuses = dict(settling.values), {each: self.status[each] for each in program.iterated}
        self._again(program)  # the formulas of what it came to
        self._put(values, statuses)

    def _again(self, program: LoopProgram) -> None:
        """One pass."""
        for each in (*program.iterated, *program.formulas):
            self.masks.pop(each, None)
        program.once(self)

    def _put(self, values: Mapping[str, Array], statuses: Mapping[str, Codes]) -> None:
        for each, value in values.items():
            shape = np.broadcast_shapes(value.shape, statuses[each].shape)
            self._hold(each, np.broadcast_to(value, shape), np.broadcast_to(statuses[each], shape))

    def _computed(
        self, column: Column, value: Array, found: Codes, requires: Sequence[Any], status: Codes | None = None
    ) -> Array:
        """A column of which some cells may be in error: what they inherit comes before what they are."""
        status = self._inherited(column) if status is None else status
        if requires:
            # What breaks a condition is outside the domain, whatever the rule made of it.
            broken: Any = np.zeros(1, dtype=np.uint8)
            for number, holds in enumerate(requires, start=1):
                broken = np.where((broken == 0) & ~np.asarray(holds, dtype=bool), number, broken)
            broken = np.where(status == Status.OK, broken, 0).astype(np.uint8)
            self.broken[column.name] = broken
            found = np.where(broken > 0, Status.DOMAIN, found).astype(np.uint8)
        shape = np.broadcast_shapes(value.shape, found.shape, status.shape)
        status = np.where(status == Status.OK, found, status)
        return self._hold(
            column.name, np.broadcast_to(value, shape).copy(), np.broadcast_to(status, shape).copy()
        )

    def _hold(self, name: str, value: Array, status: Codes) -> Array:
        if status.any():
            self.wrong.add(name)
            value = np.where(status == Status.OK, value, np.nan)
        self.value[name], self.status[name] = value, status
        return value

    def _inherited(self, column: Column) -> Codes:
        if not self._odd(column.name):
            shapes = (self.status[name].shape[:-1] for name in self.laid.names[column.name])
            return np.zeros((*np.broadcast_shapes(*shapes), self.laid.size(column)), dtype=np.uint8)
        masks = self._masks(column.name)
        return inherited(self.laid.named[column.name], masks, self.status, self.laid.size(column))

    def _found(self, column: Column, value: Array) -> Codes:
        """What the values of a formula are: one that a double holds, one that none does, or none."""
        held, beyond = _held(value, column.positive), ~np.isfinite(value)
        if column.positive:
            beyond = (beyond & (value != -np.inf)) | ((value > 0) & (value < SMALLEST))
        if held.all():
            return np.zeros(value.shape, dtype=np.uint8)
        positive, defined = self.program.conditions(column.name)
        beyond = beyond | ((value == 0) & self._holds(positive, column))
        beyond = beyond & self._holds(defined, column)
        found: Codes = chosen([held, beyond], [Status.OK, Status.OVERFLOW], Status.DOMAIN).astype(np.uint8)
        return found

    def _holds(self, condition: _Condition, column: Column) -> Any:
        """Whether a condition on the cells that a column names holds."""
        asked = condition.kernel
        if asked is None:
            return condition.certain
        arguments = [self._fetched(*read) for read in condition.reads]
        found = asked.run(*arguments, *(self.kept(column.name, axis) for axis in asked.totals))[0]
        return np.broadcast_to(found, np.broadcast_shapes(np.shape(found), (self.laid.size(column),))).astype(
            bool
        )

    def _fetched(self, kind: str, name: str, axis: str, index: str | None) -> Array:
        """What a leaf of the plan stands for."""
        if kind == "cells":
            return self.value[name] if index is None else self.rows(name, axis, index)
        if kind == "ordinal":
            assert index is not None
            return self.ordinal(axis, index)
        return self.size(axis) if kind == "size" else self.kept(name, axis).number

    # --- roots

    def _solved(
        self, column: Column, program: RootProgram, arguments: Sequence[Array], inherited: Codes
    ) -> tuple[Array, Codes]:
        totals = {axis.name: self.kept(column.name, axis.name) for axis in self.sheet.axes}
        names = program.arguments
        if program.totals:
            batch = [kept.number.shape for kept in totals.values()]
            batch += [inherited.shape, *((*a.shape[:-1], 1) for a in arguments)]
            shape = np.broadcast_shapes(*batch, (self.laid.size(column),))
            solved = program.solve(dict(zip(names, arguments, strict=True)), totals, shape)
            if solved.several and inherited.reshape(-1)[0] == Status.OK:
                self.roots[column.name] = solved.several
            return solved.value, solved.status
        shape = np.broadcast_shapes(*(a.shape for a in arguments), inherited.shape)
        value, status = np.empty(shape), np.empty(shape, dtype=np.uint8)
        several: dict[int, tuple[float, ...]] = {}
        for block, own in _blocks(shape, BLOCK):
            part = [a[block] if a.ndim == len(shape) and a.shape[0] > 1 else a for a in arguments]
            solved = program.solve(dict(zip(names, part, strict=True)), totals, own)
            value[block], status[block] = solved.value, solved.status
            for row, roots in solved.several.items():
                if inherited[min(row + block.start, inherited.shape[-1] - 1)] == Status.OK:
                    several[row + block.start] = roots
        if several:
            self.roots[column.name] = several
        return value, status


def _held(value: Array, positive: bool) -> NDArray[np.bool_]:
    """Which values doubles hold with all their digits."""
    finite = np.isfinite(value)
    return finite & (value >= SMALLEST) if positive else finite


def _blocks(shape: tuple[int, ...], most: int) -> Iterator[tuple[slice, tuple[int, ...]]]:
    """Slices of the first dimension that make blocks of about so many cells, and their shapes."""
    each = max(1, most // max(1, math.prod(shape[1:])))
    for start in range(0, shape[0], each):
        stop = min(start + each, shape[0])
        yield slice(start, stop), (stop - start, *shape[1:])


def _writable(
    out: Mapping[str, Array], shapes: Mapping[str, tuple[int, ...]], data: Mapping[str, Array]
) -> dict[str, Array]:
    """Arrays to which the values of columns of some shapes can go."""
    for name, own in out.items():
        wrong = ""
        if name not in shapes:
            wrong = "is no column of the sheet"
        elif not isinstance(own, np.ndarray) or own.dtype != np.float64:
            wrong = f"holds {getattr(own, 'dtype', 'no array')}, not float64"
        elif own.shape != shapes[name]:
            wrong = f"has the shape {own.shape}, not {shapes[name]}"
        elif not own.flags.writeable:
            wrong = "is read-only"
        elif read := [given for given, datum in data.items() if np.may_share_memory(own, datum)]:
            wrong = f"shares memory with the data of {read[0]}, which would be written over"
        if wrong:
            raise ValueError(f"out[{name!r}] {wrong}")
    return dict(out)


def evaluate(
    sheet: Sheet,
    labels: Mapping[str, Sequence[int]],
    data: Mapping[str, Any],
    program: Program | None = None,
    out: Mapping[str, Array] | None = None,
) -> Values:
    """Compute a sheet from given columns.

    Parameters
    ----------
    labels : mapping of axis name to sequence of int
        Row numbers of the axes that come with the data.
    data : mapping of column name to float array (..., rows) or float
        The given columns in SI; a scalar has one row, so that a batch of it has the shape (..., 1).
    program : Program, optional
        The sheet's program, if it was generated before.
    out : mapping of column name to float array (..., rows), optional
        Where the values of some columns go, float64, each of the shape that they have: with a batch if the
        column rests on one. A part of a larger array will do. Of columns that are not named nothing is kept:
        a batch then takes no memory but for the statuses of these, and for a block of all.

    Raises
    ------
    ValueError
        A column has not as many rows as its axis, a batch has several numbers of rows, or an array of `out`
        cannot hold the column.
    """
    arrays = _arrays(data)
    return (program or Program.of(sheet)).run(labels, _counts(sheet, arrays), arrays, out)


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
    arrays = _arrays(data)
    layouts = lay_out(sheet, values.given_labels, _counts(sheet, {**values.value, **arrays}))
    return _Run(Program.of(sheet, tuple(values.value)), Laid(sheet, layouts), arrays, values).values()


def again(values: Values, taken: Mapping[str, str], program: Program, laid: Laid) -> Values:
    """Compute columns again that are computed, with others in the places of what they rest on.

    Parameters
    ----------
    values : Values
        All columns of the sheet.
    taken : mapping of str to str
        Of known columns, which others are taken for them.
    program : Program
        Of the sheet, of which all columns are known but those that are computed again.
    laid : Laid
        The sheet over its rows.
    """
    names = {name: taken.get(name, name) for name in program.known}
    held = replace(
        values,
        value={name: values.value[own] for name, own in names.items()},
        status={name: values.status[own] for name, own in names.items()},
    )
    return _Run(program, laid, {}, held).values()


def parts(program: Program, values: Values, laid: Laid | None = None) -> dict[str, Array]:
    """Compute the parts of a plan from finished values.

    Parameters
    ----------
    program : Program
        Of the plan.
    values : Values
        All columns that the plan names.
    laid : Laid, optional
        The program's sheet over the rows, if that is known.

    Returns
    -------
    mapping of name to float array (..., rows)
    """
    run = _Run(program, laid or Laid(program.sheet, dict(values.layouts)), {}, values)
    with np.errstate(all="ignore"):
        program.function(run)
    return run.parts


def _arrays(data: Mapping[str, Any]) -> dict[str, Array]:
    return {name: np.atleast_1d(np.asarray(values, dtype=np.float64)) for name, values in data.items()}


def _counts(sheet: Sheet, values: Mapping[str, Array]) -> dict[str, int]:
    """How often each axis that repeats another does: one number for a whole batch, 0 if it is not allowed."""
    counts = {}
    for axis in sheet.axes:
        if axis.repeats:
            numbers = np.unique(values[axis.repeats]).tolist()
            if len(numbers) != 1:
                found = ", ".join(map(str, numbers))
                raise ValueError(f"{axis.repeats} must be one number for the whole batch, not {found}")
            counts[axis.repeats] = int(numbers[0]) if sheet.bounds[axis.repeats].allow(numbers[0]) else 0
    return counts
