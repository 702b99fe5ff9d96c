"""The sheet: named columns over index sets, each with one rule, in the order that the algebra dictates.

Nothing here knows a model, a number or an output. A formula is a sympy expression whose symbols are other
columns' names, so the graph of what depends on what is read from the algebra and declared nowhere.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from keyword import iskeyword
from typing import TYPE_CHECKING, Any

from .axis import Axis, CountedAxis, GroupAxis, MemberAxis, PairAxis, RepeatAxis
from .column import Column, Formula, Given, Iterated, Limit, Reference, Root, Rule, SheetError
from .partly import partly
from .quantity import Bounds

if TYPE_CHECKING:
    from sympy import Symbol
    from sympy.logic.boolalg import Boolean

    from .named import Named

__all__ = [
    "Axis",
    "Column",
    "CountedAxis",
    "CycleError",
    "Formula",
    "Given",
    "GroupAxis",
    "Iterated",
    "Limit",
    "Loop",
    "MemberAxis",
    "PairAxis",
    "Reference",
    "RepeatAxis",
    "Root",
    "Rule",
    "Sheet",
    "SheetError",
    "with_parents",
]


class CycleError(SheetError):
    """Columns that wait for one another."""

    def __init__(self, path: tuple[str, ...]) -> None:
        self.path = path
        super().__init__("columns depend on one another in a circle: " + " -> ".join(path), *path)


@dataclass(frozen=True)
class Loop:
    """Columns that rest on one another, in the order of a pass."""

    formulas: tuple[Column, ...]
    """Computed from the last values of those that are iterated."""
    iterated: tuple[Column, ...]
    """Given their next values, all at once."""

    @classmethod
    def of(cls, columns: Iterable[Column]) -> Loop:
        """Tell both kinds apart."""
        kinds: tuple[list[Column], list[Column]] = [], []
        for column in columns:
            kinds[isinstance(column.rule, Iterated)].append(column)
        return cls(*map(tuple, kinds))

    @property
    def columns(self) -> tuple[Column, ...]:
        """All of them."""
        return (*self.formulas, *self.iterated)

    @property
    def name(self) -> str:
        """What it is called: as the first that is iterated."""
        return self.iterated[0].name

    @cached_property
    def names(self) -> frozenset[str]:
        """What its columns are called."""
        return frozenset(column.name for column in self.columns)


@dataclass(frozen=True)
class Sheet:
    """Columns in an order in which each finds its precedents computed.

    Raises
    ------
    SheetError
        A name has two rules, a symbol has none, an index does not belong to the axis.
    CycleError
        Columns wait for one another; its message shows the path.
    """

    columns: tuple[Column, ...]
    """In the order they are declared, which is the order they are shown."""
    by_name: Mapping[str, Column] = field(init=False, repr=False)
    order: tuple[Column, ...] = field(init=False, repr=False)
    """Order of evaluation; ties break by declaration. A loop's columns stand together, the iterated last."""
    loops: tuple[Loop, ...] = field(init=False, repr=False)
    """Columns that rest on one another by way of iterated ones."""
    _named: Mapping[str, tuple[Reference, ...]] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        names: dict[str, Column] = {}
        for column in self.columns:
            if column.name in names:
                raise SheetError(
                    f"the column {column.name!r} has two rules; a name has exactly one", column.name
                )
            names[column.name] = column
        object.__setattr__(self, "by_name", names)
        _check_names(self)
        for column in self.columns:
            if column.mentioned is None and column.expressions:
                self.algebra.check(column)
        object.__setattr__(self, "_named", {c.name: tuple(self._read(c)) for c in self.columns})
        groups = tuple(self._sorted())
        object.__setattr__(self, "order", tuple(column for group in groups for column in group))
        object.__setattr__(
            self, "loops", tuple(loop for group in groups if (loop := Loop.of(group)).iterated)
        )
        for column in self.columns:
            if column.mentioned is None and column.name in self.loop_of:
                self.algebra.check_in_loop(column, self.loop_of[column.name].names)

    def __getitem__(self, name: str) -> Column:
        return self.by_name[name]

    def __contains__(self, name: object) -> bool:
        return name in self.by_name

    # --- index sets -----------------------------------------------------------------------------------

    @cached_property
    def axes(self) -> tuple[Axis, ...]:
        """All index sets, each after those it is made of."""
        found: dict[str, Axis] = {}

        def add(axis: Axis) -> None:
            for parent in axis.parents:
                add(parent)
            if (same := found.setdefault(axis.name, axis)) is not axis and same != axis:
                raise SheetError(f"two different index sets are called {axis.name!r}", axis.name)

        for column in self.columns:
            if column.axis is not None:
                add(column.axis)
        return tuple(found.values())

    @property
    def weighed(self) -> dict[str, str]:
        """The columns of stated standard uncertainties, and of what."""
        return {c.name: c.rule.u_of for c in self.columns if isinstance(c.rule, Given) and c.rule.u_of}

    @cached_property
    def algebra(self) -> Named:
        """What the symbols of its rules mean."""
        from .named import Named

        return Named(self.by_name, self.axes)

    # --- what may be given ----------------------------------------------------------------------------

    def bounded(self, declared: Mapping[str, Bounds]) -> Sheet:
        """The sheet with what its given columns may be, in SI."""

        def bound(column: Column) -> Column:
            if not isinstance(column.rule, Given) or column.name not in declared:
                return column
            return replace(column, rule=replace(column.rule, bounds=declared[column.name]))

        return Sheet(tuple(map(bound, self.columns)))

    @cached_property
    def bounds(self) -> dict[str, Bounds]:
        """What each given column may be, in SI; one that says how many rows there are counts from 1."""
        found = {c.name: c.rule.bounds for c in self.columns if isinstance(c.rule, Given)}
        for axis in self.axes:
            if axis.repeats:
                own = replace(found[axis.repeats], integer=True)
                some = own.low is not None and own.low >= 1
                found[axis.repeats] = own if some else replace(own, low=1, low_open=False)
        return found

    @cached_property
    def guards(self) -> dict[str, tuple[Symbol, Boolean]]:
        """For each given column that is bound, a datum and what it must satisfy, for engines to print."""
        from sympy import Symbol

        from .named import within

        data = {name: Symbol(name, real=True) for name, own in self.bounds.items() if own != Bounds()}
        return {name: (datum, within(datum, self.bounds[name])) for name, datum in data.items()}

    @cached_property
    def plans(self) -> dict[frozenset[str], Any]:
        """What it was lowered to, by the columns that are known: several ask, and it takes long."""
        return {}

    # --- the graph ------------------------------------------------------------------------------------

    def named(self, column: Column) -> tuple[Reference, ...]:
        """The cells that a column's rule names, each once; those of columns declared first come first."""
        return self._named[column.name]

    def precedents(self, column: Column) -> tuple[Column, ...]:
        """The columns that a column is computed from, in the order they were declared."""
        return tuple(self.by_name[name] for name in dict.fromkeys(r.name for r in self.named(column)))

    def dependents(self, column: Column) -> tuple[Column, ...]:
        """The columns that are computed from a column directly."""
        return tuple(c for c in self.columns if any(p.name == column.name for p in self.precedents(c)))

    def ancestors(self, column: Column, without: Collection[str] = ()) -> tuple[Column, ...]:
        """All columns that a column rests on, but not by way of some, in order of evaluation."""
        seen, waiting = {column.name}, [column]
        while waiting:
            new = [p for p in self.precedents(waiting.pop()) if p.name not in {*seen, *without}]
            seen |= {precedent.name for precedent in new}
            waiting += new
        return tuple(c for c in self.order if c.name in seen and c.name != column.name)

    def summed_axes(self, column: Column) -> tuple[Axis, ...]:
        """The axes that its rule takes something over."""
        if column.mentioned is not None:
            return tuple(axis for axis in self.axes if axis.name in column.mentioned.summed)
        return self.algebra.summed(column) if column.expressions else ()

    def rows_of(self, axis: str) -> str:
        """What the rows of an index set are called, those of groups once more as themselves."""
        found = next(each for each in self.axes if each.name == axis)
        return found.of.name if isinstance(found, MemberAxis) else axis

    def _read(self, column: Column) -> Iterator[Reference]:
        """The cells that a column names, in the order of declaration."""
        if column.mentioned is not None:
            here = (each for each in column.mentioned.named if each[0] in self.by_name)
            yield from (self._known(column, *each) for each in here)
            return
        found = set(self.algebra.of(column)) if column.expressions else set()
        for axis in with_parents((column.axis, *self.summed_axes(column))):
            if axis.repeats:
                found.add(Reference(self.by_name[axis.repeats].symbol))
        declared = {c.name: n for n, c in enumerate(self.columns)}
        order = {axis.name: n for n, axis in enumerate(self.axes)}
        yield from sorted(
            found,
            key=lambda r: (declared[r.name], r.written, -1 if r.over is None else order[r.over.name]),
        )

    def _known(self, column: Column, name: str, index: str | None, over: str | None) -> Reference:
        """What a column names, of which only the words are known."""
        summed = next((axis for axis in self.axes if axis.name == over), None)

        def whole() -> Reference:
            on, other = summed or column.axis, self.by_name[name]
            if index is None or on is None:
                return Reference(other.symbol, summed)
            return Reference(other[next(i for i in self.algebra.maps(on) if i.name == index)], summed)

        return partly(Reference, {"name": name, "index": index, "over": summed}, whole)

    def _sorted(self) -> Iterator[tuple[Column, ...]]:
        """Each column after its precedents, those of a loop together.

        Depth first in the order of declaration (Tarjan): columns that wait for one another come out as one
        group.
        """
        number: dict[str, int] = {}
        waiting: list[Column] = []
        done: set[str] = set()

        def visit(column: Column) -> Iterator[tuple[Column, ...]]:
            own = earliest = number[column.name] = len(number)
            waiting.append(column)
            for precedent in self.precedents(column):
                if precedent.name not in number:
                    yield from visit(precedent)
                if precedent.name not in done:
                    earliest = min(earliest, number[precedent.name])
            number[column.name] = earliest
            if earliest == own:
                place = [each.name for each in waiting].index(column.name)
                group = waiting[place:]
                del waiting[place:]
                done.update(member.name for member in group)
                yield tuple(self._in_loop(group))

        for column in self.columns:
            if column.name not in number:
                yield from visit(column)

    def _in_loop(self, group: Sequence[Column]) -> Iterator[Column]:
        """Columns of which each waits for all: formulas from the last values of iterated ones, then these."""
        names, done, path = {column.name for column in group}, set[str](), list[str]()

        def visit(column: Column) -> Iterator[Column]:
            if column.name in done:
                return
            if column.name in path:
                raise CycleError((*path[path.index(column.name) :], column.name))
            path.append(column.name)
            for precedent in self.precedents(column):
                if precedent.name in names and not isinstance(precedent.rule, Iterated):
                    yield from visit(precedent)
            path.pop()
            done.add(column.name)
            yield column

        declared = Loop.of(column for column in self.columns if column.name in names)
        for column in declared.formulas:
            yield from visit(column)
        yield from declared.iterated

    @cached_property
    def loop_of(self) -> dict[str, Loop]:
        """The loop that a column is part of, by its name, if it is."""
        return {column.name: loop for loop in self.loops for column in loop.columns}


def with_parents(axes: Iterable[Axis | None]) -> Iterator[Axis]:
    """Axes and all they are made of."""
    for axis in axes:
        if axis is not None:
            yield axis
            yield from with_parents(axis.parents)


# --- what makes a sheet ----------------------------------------------------------------------------------


def _check_names(sheet: Sheet) -> None:
    """A symbol means one thing: a column, an index, a size, a running number or an unknown."""
    taken: dict[str, str] = {}
    for axis in sheet.axes:
        _check_name(axis.name, "an index set's")
        own = {axis.index_name: "the index", axis.size_name: "the size"}
        if isinstance(axis, PairAxis):
            own |= dict(zip(axis.members, ("the first member", "the second member"), strict=True))
        elif isinstance(axis, CountedAxis):
            own |= {axis.step_name: "the running number"}
        elif isinstance(axis, RepeatAxis):
            own |= {axis.step_name: "the running number"}
            count = sheet.by_name.get(axis.count)
            if count is None or count.axis is not None or not isinstance(count.rule, Given):
                raise SheetError(
                    f"{axis.name}: {axis.count!r} must be a given scalar; it says how many rows there are",
                    axis.count,
                )
        for name, what in own.items():
            if name in taken:
                raise SheetError(f"the symbol {name!r} is {taken[name]} and {what} of {axis.name}", name)
            taken[name] = f"{what} of {axis.name}"
    for column in sheet.columns:
        _check_name(column.name, "a column's")
        if column.name in taken:
            raise SheetError(
                f"the column {column.name!r} is called as {taken[column.name]} is; rename one", column.name
            )
        unknown = column.rule.unknown_name if isinstance(column.rule, Root) else column.name
        if unknown != column.name and (unknown in sheet.by_name or unknown in taken):
            raise SheetError(
                f"{column.name}: its unknown {unknown!r} is called as something else of the sheet is",
                unknown,
                column.name,
            )


def _check_name(name: str, whose: str) -> None:
    if not name.isidentifier() or iskeyword(name):
        raise SheetError(f"{name!r} cannot be {whose} name: letters, digits and _ make a name", name)
