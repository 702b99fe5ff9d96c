"""The exact engine: the same sheet at 50 digits, cell by cell, to judge all other engines.

It shares the sheet's rules with the others and nothing of their programs: expressions are printed for
mpmath (:mod:`~loopsheet.report.engines.exact_texts`), roots are bracketed and then narrowed until 50 digits
stand. It is slow and not meant for large data.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from statistics import median
from types import ModuleType
from typing import Any

import mpmath
import numpy as np
from mpmath.libmp import round_nearest, to_float
from numpy.typing import NDArray

from ..cells.layout import Layout, height, lay_out, precedents
from ..cells.values import Status, Values, how_many, inherited, rows_kept
from ..plan.kept import of_sheet
from ..plan.order import Word
from ..quantity import LARGEST, SMALLEST, Bounds
from ..sheet import Column, Formula, Given, Loop, Sheet
from .exact_roots import Enclose, brackets, of_arrays, of_mpmath
from .intervals import Intervals
from .isolation import Doubtful
from .kernels import Enclosing, function_of
from .numpy_loop import ENOUGH, MOST

DIGITS = 50
_GUARD = 15
"""Digits carried beyond those that are promised: sums and differences eat some."""
_TINY = mpmath.mpf("1e-30")
"""What is smaller may be what rounding left of a difference; it is looked at with more digits."""
_CLOSE = mpmath.mpf(f"1e-{DIGITS + 5}")
_NEAR = mpmath.mpf("1e-30")
_PASSES = 400
"""How many passes a loop gets; nearer than that, one that moves no less than the one before the last moves by
rounding only."""
_TAKEN: Mapping[Word, Callable[..., Any]] = {"sum": mpmath.fsum, "median": median, "max": max, "min": min}
_ROUGHLY = 1e-12
"""As parts of a root: how close it is sought, and how close doubles should come."""


@dataclass(frozen=True)
class ExactValues:
    """Values of every cell to 50 digits."""

    value: Mapping[str, list[Any]]
    """By column name; SI; None where the status is not OK."""
    status: Mapping[str, list[Status]]
    """By column name."""
    roots: Mapping[str, Mapping[int, tuple[Any, ...]]]
    """By column name; all roots of ambiguous cells; of undecided ones, the part of the interval that was not
    decided."""
    layouts: Mapping[str, Layout]
    counted: Mapping[str, Mapping[str, int]]
    broken: Mapping[str, NDArray[np.uint8]]
    """`layouts`, `counted` and `broken`: as those of :class:`~loopsheet.report.cells.values.Values`."""

    def rounded(self, sheet: Sheet) -> Values:
        """Every cell as the double that is nearest to it, the same on every processor.

        `sheet`: what was evaluated, or a part that rests on nothing else.
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
    found = value if isinstance(value, float | int) else to_float(value._mpf_, rnd=round_nearest)
    return float(found) + 0.0


class _Failed(Exception):
    """A cell has an error value instead of a number."""

    def __init__(self, status: Status) -> None:
        self.status = status


@contextmanager
def _real(strict: bool) -> Iterator[None]:
    """Refuses what is no real number: its absolute value would be one."""
    before = mpmath.mp.trap_complex
    mpmath.mp.trap_complex = strict
    try:
        yield
    finally:
        mpmath.mp.trap_complex = before


def _log(x: Any) -> Any:
    """A logarithm; mpmath's of 0 is infinite, which a quotient would make 0."""
    if x == 0:
        raise ZeroDivisionError
    return mpmath.log(x)


_OF_REALS = ModuleType("mpmath of real numbers")
vars(_OF_REALS).update(vars(mpmath), log=_log)


def _rows(values: Any) -> Any:
    return values if isinstance(values, (list, tuple, np.ndarray)) else [values]


def _datum(value: Any, bounds: Bounds) -> Any:
    """A datum as mpf: fractions and texts exactly, a double as the double it is; NaN if it is not allowed."""
    value = Fraction(value) if isinstance(value, str) else value
    if isinstance(value, Fraction) and abs(value) >= LARGEST:
        return mpmath.nan  # no double holds it: it is no datum to the other engines either
    if value is None or not bounds.allow(value if isinstance(value, Fraction) else float(value)):
        return mpmath.nan
    return as_mpf(value)


def as_mpf(value: float | Fraction) -> Any:
    """A number as it is: a fraction is one of whole numbers."""
    if isinstance(value, Fraction):
        return mpmath.mpf(value.numerator) / value.denominator
    return mpmath.mpf(value)


def _held(value: Any, positive: bool) -> Any:
    """A value that a double can hold, be it rounded; a formula without cells may be a plain number."""
    value = mpmath.mpmathify(value)
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
    labels : mapping of axis name to sequence of int
    data : mapping of column name to a number, or a sequence of numbers, in SI
        Fractions are taken exactly; None or NaN is a missing datum.
    """
    layouts = laid_out(sheet, labels, data)

    def run(digits: int, zeros: Set[tuple[str, int]] = frozenset()) -> ExactValues:
        with mpmath.workdps(digits):
            given = {
                name: [_datum(x, sheet.bounds[name]) for x in _rows(data[name])] for name in sheet.bounds
            }
            return _Exact(sheet, layouts, given, zeros).run()

    found = run(DIGITS + _GUARD)
    tiny = {
        (column.name, row): value
        for column in sheet.order
        if not isinstance(column.rule, Given) and column.name not in sheet.loop_of  # a loop tells itself
        for row, value in enumerate(found.value[column.name])
        if value is not None and 0 < abs(value) < _TINY
    }
    if not tiny:
        return found
    # What is nothing becomes smaller by the digits that are added; what is something stays.
    better = run(DIGITS + 2 * _GUARD).value
    zeros = {
        (name, row)
        for (name, row), value in tiny.items()
        if (there := better[name][row]) is not None and abs(there) < _ROUGHLY * abs(value)
    }
    return run(DIGITS + _GUARD, zeros) if zeros else found


def laid_out(sheet: Sheet, labels: Mapping[str, Sequence[int]], data: Mapping[str, Any]) -> dict[str, Layout]:
    """The rows of every axis.

    `sheet`, `labels` and `data`: as for :func:`evaluate`.
    """
    repeats = [axis.repeats for axis in sheet.axes if axis.repeats]
    numbers = {name: _datum(_rows(data[name])[0], sheet.bounds[name]) for name in repeats}
    counts = {name: 0 if mpmath.isnan(number) else int(number) for name, number in numbers.items()}
    return lay_out(sheet, labels, counts)


def _texts(sheet: Sheet) -> Mapping[str, Any]:
    """What is computed of each column, printed now or before."""

    def make() -> dict[str, Any]:
        from .exact_texts import exact_texts

        return exact_texts(sheet)

    found: Mapping[str, Any] = of_sheet(sheet, "program at 50 digits", (), make)
    return found


def follows(
    column: Column,
    sheet: Sheet,
    layouts: Mapping[str, Layout],
    value: Mapping[str, Sequence[float | Fraction | None]],
    status: Mapping[str, Sequence[Status]],
) -> list[Status]:
    """What the cells of a column are at 50 digits if all that it names is what another engine has made of it.

    Parameters
    ----------
    column : Column
        Not given, and in no loop.
    value, status : mapping of column name to sequence
        Of all columns; in SI, None where there is no number.
    """
    with mpmath.workdps(DIGITS + _GUARD):
        engine = _Exact(sheet, layouts, {})
        engine.value = {
            name: [None if each is None else as_mpf(each) for each in own] for name, own in value.items()
        }
        engine.status = {name: np.array(own, dtype=np.uint8) for name, own in status.items()}
        return [Status(code) for code in engine._column(column)[1].tolist()]


class _Exact:
    """One evaluation at 50 digits."""

    def __init__(
        self,
        sheet: Sheet,
        layouts: Mapping[str, Layout],
        given: Mapping[str, list[Any]],
        zeros: Set[tuple[str, int]] = frozenset(),
    ) -> None:
        self.sheet, self.layouts, self.given, self.zeros = sheet, layouts, given, zeros
        self.texts = _texts(sheet)
        self.value: dict[str, list[Any]] = {}
        self.status: dict[str, NDArray[np.uint8]] = {}
        self.roots: dict[str, dict[int, tuple[Any, ...]]] = {}
        self.counted: dict[str, dict[str, int]] = {}
        self.broken: dict[str, NDArray[np.uint8]] = {}

    def run(self) -> ExactValues:
        for column in self.sheet.order:
            loop = self.sheet.loop_of.get(column.name)
            if loop is None:
                self.value[column.name], self.status[column.name] = self._column(column)
            elif column is loop.columns[-1]:
                self._loop(loop)
        codes = {name: [Status(code) for code in status.tolist()] for name, status in self.status.items()}
        return ExactValues(self.value, codes, self.roots, self.layouts, self.counted, self.broken)

    def _column(self, column: Column, what: str = "value") -> tuple[list[Any], NDArray[np.uint8]]:
        """The values of a column, and their statuses."""
        status, compute = self._rule(column, height(column, self.layouts), what)
        values: list[Any] = [None] * status.size
        for row in np.flatnonzero(status == Status.OK).tolist():
            try:
                values[row] = compute(row)
            except _Failed as failed:
                status[row] = failed.status
        return values, status

    def _loop(self, loop: Loop) -> None:
        """Columns that rest on one another: passes until 50 digits stay."""
        for column in loop.columns:
            # Nothing is in error because of what is not there yet.
            self.value[column.name] = [None] * height(column, self.layouts)
            self.status[column.name] = np.zeros(height(column, self.layouts), dtype=np.uint8)
        while True:  # until all know of the errors before the loop that reach them
            known = [self.status[column.name] for column in loop.columns]
            for column in loop.columns:
                self.status[column.name] = self._named(column)[2]
            if all(map(np.array_equal, known, (self.status[column.name] for column in loop.columns))):
                break
        begun = {}
        for column in loop.iterated:
            begun[column.name] = self._column(column, "start")
            self._put({column.name: begun[column.name]})
        before = last = mpmath.inf
        for number in range(1, _PASSES + 1):
            earlier = {column.name: self.value[column.name] for column in loop.formulas}
            for column in loop.formulas:
                self._put({column.name: self._column(column)})
            after = {column.name: self._column(column) for column in loop.iterated}
            if any((status != begun[name][1]).any() for name, (_, status) in after.items()):
                break  # a value got lost on the way
            moved = max(
                (
                    abs(new - old) / abs(new)
                    for name, (values, _) in after.items()
                    for new, old in zip(values, self.value[name], strict=True)
                    if new is not None and new != old
                ),
                default=mpmath.mpf(0),
            )
            if number == MOST and moved > ENOUGH:
                break  # it has no value in doubles
            if moved <= _CLOSE or (moved <= _NEAR and moved >= before):
                for name, values in earlier.items():
                    self.value[name] = [*map(_come_to, self.value[name], values)]
                return
            self._put(after)
            before, last = last, moved
        for name, (values, status) in begun.items():
            status[status == Status.OK] = Status.NOROOT
            self._put({name: ([None] * len(values), status)})
        for column in loop.formulas:
            self._put({column.name: self._column(column)})

    def _put(self, found: Mapping[str, tuple[list[Any], NDArray[np.uint8]]]) -> None:
        for name, (values, status) in found.items():
            self.value[name], self.status[name] = values, status

    # --- rules ----------------------------------------------------------------------------------------

    def _rule(self, column: Column, size: int, what: str) -> tuple[NDArray[np.uint8], Callable[[int], Any]]:
        """The errors that the rows inherit, and what computes the others."""
        if isinstance(column.rule, Given):
            return np.zeros(size, dtype=np.uint8), lambda row: self._given(column, row)
        kept, some, status = self._named(column)
        if some:
            self.counted[column.name] = some
        scope = _Scope(self, column, {axis: np.flatnonzero(mask).tolist() for axis, mask in kept.items()})
        texts = self.texts[column.name]
        conditions = [scope.function(condition) for condition in texts["requires"]]
        # An end of a root may be infinite, and a step of a fit too long; a formula has a value or none.
        is_strict = isinstance(column.rule, Formula) and column.name not in self.sheet.loop_of
        scope.module = _OF_REALS if is_strict else mpmath
        body = scope.function(texts[what]) if "form" not in texts else self._root(texts, column, scope)

        broken = np.zeros(size, dtype=np.uint8)
        if conditions:
            self.broken[column.name] = broken

        def compute(row: int) -> Any:
            for number, condition in enumerate(conditions, start=1):
                if not condition(row):
                    broken[row] = number
                    raise _Failed(Status.DOMAIN)
            with _real(is_strict):
                exactly = body(row)
            return _held(mpmath.mpf(0) if (column.name, row) in self.zeros else exactly, column.positive)

        return status, compute

    def _named(self, column: Column) -> tuple[Mapping[str, Any], dict[str, int], NDArray[np.uint8]]:
        """The rows that a column's sums run over, how many where some are left out, its inherited errors."""
        named = precedents(self.sheet, self.layouts, column)
        kept = rows_kept(named, self.layouts, self.status)
        return kept, how_many(kept), inherited(named, kept, self.status, height(column, self.layouts))

    def _given(self, column: Column, row: int) -> Any:
        value = self.given[column.name][row]
        if mpmath.isnan(value):
            raise _Failed(Status.INPUT)
        return value

    # --- roots ----------------------------------------------------------------------------------------

    def _root(self, texts: Mapping[str, Any], column: Column, scope: _Scope) -> Callable[[int], Any]:
        """Count the sign changes between turning points, then narrow the only bracket down."""
        form, value, low, high = (scope.function(texts[name]) for name in ("form", "value", "low", "high"))
        given = [None if end is None else scope.function(end) for end in texts["signs"]]
        counted = None if texts["counted"] is None else scope.enclosing(texts["counted"])
        turning = [scope.function(point) for point in texts["turning"]]
        # A sum takes long at 50 digits, and as doubles no time.
        rough = None if texts["rough"] is None else _Roughly(scope).root(texts["rough"])

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


def _come_to(last: Any, before: Any) -> Any:
    """What a cell has come to where a loop rests: zero, as steps do, if no digit of a tiny one has stayed.

    What is not tiny may have moved, too: a fit may come from afar to where it rests in a single pass.
    """
    tiny = last is not None and before is not None and abs(last) < _TINY
    return mpmath.mpf(0) if tiny and 10 * abs(last - before) > abs(last) else last


class _Scope:
    """Functions of a row of a column (and of the unknown of a root), of texts.

    `kept` (mapping of axis name to list of int): the rows that sums over an axis run over.
    """

    module: ModuleType = mpmath

    def __init__(self, engine: _Exact, column: Column, kept: Mapping[str, list[int]]) -> None:
        self.engine, self.column, self.kept = engine, column, kept
        self.axis = None if column.axis is None else column.axis.name

    def function(self, texts: Mapping[str, Any]) -> Callable[..., Any]:
        """An expression of the column's own row."""
        compute = self._many(texts, self.axis)

        def run(row: int, *at: Any) -> Any:
            try:
                return compute(row, *at)[0]
            except (ZeroDivisionError, ValueError):
                return mpmath.nan

        return run

    def enclosing(self, texts: Mapping[str, Any]) -> Callable[[int], Enclose]:
        """What encloses the form of a root, for each row."""
        if "interval" in texts:
            readers = [self._reader(cell, self.axis) for cell in texts["cells"]]
            of_row = of_mpmath(texts["interval"], texts["kinds"])
            return lambda row: of_row([read(row) for read in readers])
        kernel, reads = Enclosing.of_plain(texts["kernel"]), []
        for name, over, cell, written in texts["reads"]:
            read = self.function(written) if written else self._reader(cell, over or self.axis)
            reads.append((name, over if name in texts["terms"] else None, read))
        kept = {}
        for name in kernel.totals:
            kept[name] = np.zeros(self._size(name), dtype=bool)
            kept[name][list(self.kept.get(name, range(kept[name].size)))] = True

        def of_rows(row: int) -> Enclose:
            given = {}
            for name, over, read in reads:
                rows = [row] if over is None else range(self._size(over))
                numbers = [np.nan if (x := read(each)) is None else float(x) for each in rows]
                given[name] = Intervals.near(numbers, numbers)
            return of_arrays(kernel, given, texts["terms"], kept)

        return of_rows

    def _many(self, texts: Mapping[str, Any], axis: str | None) -> Callable[..., Sequence[Any]]:
        """Several expressions of a row of an axis at once, so that their common parts are computed once."""
        function = _function(texts["source"], self.module)
        readers = [self._reader(cell, axis) for cell in texts["cells"]]
        sums = self._totals(texts)

        def run(row: int, *at: Any) -> Sequence[Any]:
            computed: Sequence[Any] = function(*(read(row) for read in readers), *sums(row, *at), *at)
            return computed

        return run

    def _totals(self, texts: Mapping[str, Any]) -> Callable[..., list[Any]]:
        """All sums, those over one axis in one pass; one that the unknown does not move is taken once."""
        take = texts["words"]
        passes = []
        for told in texts["passes"]:
            rows = self._summed(told["axis"])
            passes.append((told["which"], self._many(told["terms"], told["axis"]), rows, told["moving"]))
        fixed: dict[tuple[int, int], list[Any]] = {}

        def run(row: int, *at: Any) -> list[Any]:
            found: list[Any] = [None] * len(take)
            for number, (mine, terms, rows, moving) in enumerate(passes):
                which = row if len(rows) > 1 else 0  # the only rows there are, or those of a group
                sums = fixed.get((number, which))
                if sums is None:
                    sums = self._taken([take[n] for n in mine], terms, rows[which], at)
                    if not moving:
                        fixed[number, which] = sums
                for n, total in zip(mine, sums or [mpmath.mpf(0)] * len(mine), strict=True):
                    found[n] = total
            return found

        return run

    def _summed(self, axis: str) -> Sequence[Sequence[int]]:
        """The rows of an axis that sums run over, those of each group by themselves if it has groups."""
        layout, kept = self.engine.layouts[axis], self.kept.get(axis, range(self._size(axis)))
        if layout.starts is None:
            return [kept]
        return [[row for row in kept if each.start <= row < each.stop] for each in layout.groups]

    def _taken(
        self, words: Sequence[Word], terms: Callable[..., Any], rows: Sequence[int], at: Sequence[Any]
    ) -> list[Any]:
        """What is taken of several terms over rows; nothing of no rows, no number where one is complex."""
        columns = zip(*(terms(row, *at) for row in rows), strict=True)
        return [
            mpmath.nan if any(isinstance(each, mpmath.mpc) for each in column) else _TAKEN[word](column)
            for word, column in zip(words, columns, strict=False)
        ]

    def _numbers(self, numbers: list[Any]) -> Any:
        """What is read, row by row."""
        return numbers

    def _size(self, axis: str) -> int:
        return self.engine.layouts[axis].size

    def _reader(self, cell: Sequence[Any], axis: str | None) -> Callable[[int], Any]:
        """What gives the value of a cell, size or running number for a row of an axis."""
        kind, name, index = cell
        layouts = self.engine.layouts
        if kind == "size":
            number = mpmath.mpf(len(self.kept.get(name, range(self._size(name)))))
            (number,) = self._numbers([number])
            return lambda _: number
        if kind == "ordinal":
            assert axis is not None
            ordinals = [mpmath.mpf(n) for n in layouts[axis].ordinals[name].tolist()]
            return self._numbers(ordinals).__getitem__  # type: ignore[no-any-return]
        values = self._numbers(self.engine.value[name])
        if index is None:
            return lambda _: values[0]
        assert axis is not None
        rows = layouts[axis].rows[index]
        return lambda row: values[rows[row]]


class _Roughly(_Scope):
    """The same in doubles, all terms of a sum at once: where a root is about."""

    module = np

    def __init__(self, scope: _Scope) -> None:
        super().__init__(scope.engine, scope.column, scope.kept)

    def root(self, texts: Mapping[str, Any]) -> Callable[..., Any]:
        """Where a row has its root between two ends; NaN if doubles do not tell."""
        form = self.function(texts)

        def guess(row: int, left: float, right: float, rising: float) -> Any:
            with np.errstate(all="ignore"):
                return mpmath.mpf(_narrow(lambda u: form(row, u), left, right, rising, _ROUGHLY))

        return guess

    def _numbers(self, numbers: list[Any]) -> Any:
        return np.array([np.nan if number is None else float(number) for number in numbers])

    def _taken(
        self, words: Sequence[Word], terms: Callable[..., Any], rows: Sequence[int], at: Sequence[Any]
    ) -> list[Any]:
        which = np.array(rows, dtype=np.intp)
        columns = [np.broadcast_to(column, which.shape) for column in terms(which, *at)]
        return [getattr(np, word)(column) for word, column in zip(words, columns, strict=True)]


@lru_cache(maxsize=1024)
def _function(source: str, module: ModuleType) -> Any:
    """The function of a text, which calls those of a module."""
    return function_of(source, vars(module))
