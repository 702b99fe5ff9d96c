"""The sheet: named columns over index sets, each with one rule, in the order that the algebra dictates.

Nothing here knows a model, a number or an output. A formula is a sympy expression whose symbols are other
columns' names, so the graph of what depends on what is read from the algebra and declared nowhere.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from sympy import Basic, Expr, Indexed, IndexedBase, Rel, Sum, Symbol

from ..derivations.equation import Equation

__all__ = [
    "Axis",
    "Column",
    "CycleError",
    "Formula",
    "Given",
    "PairAxis",
    "RepeatAxis",
    "Root",
    "Rule",
    "Sheet",
    "SheetError",
]


class SheetError(ValueError):
    """A workbook declares something that cannot be a sheet."""


class CycleError(SheetError):
    """Columns that wait for one another."""

    def __init__(self, path: tuple[str, ...]) -> None:
        self.path = path
        super().__init__("columns depend on one another in a circle: " + " -> ".join(path))


# --- index sets ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Axis:
    """An index set whose rows come with the data, such as the tests of a campaign.

    Parameters
    ----------
    name : str
        ``tests``, ``pairs``, ``points``.
    index : Symbol
        The running number of a row in formulas, ``k``.
    size : Symbol
        How many rows there are: the upper limit of sums over the axis.
    """

    name: str
    index: Symbol
    size: Symbol

    @property
    def maps(self) -> dict[Symbol, Axis]:
        """For every index that may be used in a formula on this axis, the axis whose rows it names."""
        return {self.index: self}

    @property
    def ordinals(self) -> tuple[Symbol, ...]:
        """Running numbers that a formula on this axis may use as values."""
        return ()

    @property
    def parents(self) -> tuple[Axis, ...]:
        """The axes that its rows are made of."""
        return ()


@dataclass(frozen=True)
class PairAxis(Axis):
    """Every pair i < j of another axis' rows, in lexical order."""

    of: Axis
    first: Symbol
    second: Symbol

    @property
    def maps(self) -> dict[Symbol, Axis]:
        """The pair's own number and those of its two members."""
        return {self.index: self, self.first: self.of, self.second: self.of}

    @property
    def parents(self) -> tuple[Axis, ...]:
        """The axis that is paired."""
        return (self.of,)


@dataclass(frozen=True)
class RepeatAxis(Axis):
    """A number of rows, counted by `step` = 1, 2, ..., for each row of another axis."""

    of: Axis
    step: Symbol
    count: str
    """Name of the given scalar that says how many."""

    @property
    def maps(self) -> dict[Symbol, Axis]:
        """The row's own number, and all that its parent's row may name."""
        return {self.index: self, **self.of.maps}

    @property
    def ordinals(self) -> tuple[Symbol, ...]:
        """The running number within the parent's row."""
        return (self.step,)

    @property
    def parents(self) -> tuple[Axis, ...]:
        """The axis that is repeated."""
        return (self.of,)


# --- rules -----------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Given:
    """The value comes from the user, as printed."""

    source: str = "given"


@dataclass(frozen=True)
class Formula:
    """The last side of an equation of the ledger, in the sheet's symbols."""

    equation: Equation

    @property
    def expression(self) -> Expr:
        """What is computed."""
        return self.equation.value


@dataclass(frozen=True)
class Root:
    """The only root of an equation in an interval; that it is the only one is decided before it is sought.

    Parameters
    ----------
    equation : Equation
        What the root satisfies, as published.
    form : Equation
        What is solved: equivalent on the interval, its left side smooth, its right side zero.
    unknown : Symbol
        The unknown of `form`.
    value : Expr
        The cell's value in terms of the unknown.
    low, high : Expr
        The open interval of the unknown.
    sign_low, sign_high : Expr or None
        Expressions with the sign of `form` at the ends of the interval, where it cannot be evaluated or
        where rounding would decide; None evaluates it.
    turning : tuple of Expr
        Increasing points of the interval between which `form` changes sign at most once; one that is not
        a number, or lies outside, does not count.
    start : Expr
        A first guess. It costs steps, never truth: the bracket decides.
    steps : int
        How many fourth-order steps every cell gets.
    none : str
        What it means when there is no root, for the reader.
    two : str
        What it means when there are several.
    """

    equation: Equation
    form: Equation
    unknown: Symbol
    value: Expr
    low: Expr
    high: Expr
    start: Expr
    sign_low: Expr | None = None
    sign_high: Expr | None = None
    turning: tuple[Expr, ...] = ()
    steps: int = 4
    none: str = "no value of the interval satisfies the equation"
    two: str = "several values of the interval satisfy the equation"

    @property
    def expression(self) -> Expr:
        """What must vanish."""
        sides = self.form.sides
        return sides[0] - sides[1]

    @property
    def expressions(self) -> tuple[Expr, ...]:
        """Everything that is evaluated, in terms of other columns and the unknown."""
        signs = tuple(s for s in (self.sign_low, self.sign_high) if s is not None)
        return (self.expression, self.value, self.low, self.high, self.start, *signs, *self.turning)


Rule = Given | Formula | Root


@dataclass(frozen=True)
class Column:
    """One quantity over one index set.

    Parameters
    ----------
    name : str
        The cell name, ``x_m1``.
    axis : Axis or None
        None for a scalar.
    rule : Given, Formula or Root
        Where its values come from.
    unit : str
        SI unit; an exponent may be another column's name (``N/m^alpha``).
    meaning : str
        What it is.
    latex : str
        How it is printed; ``%s`` is where an index goes.
    display : str
        The unit it is shown in; ``like x_p`` follows the unit that the user wrote for a given column.
    positive : bool
        Whether it is positive wherever it has a value.
    requires : tuple
        Relations that must hold for a row, each with the sentence that explains a ``#DOMAIN!``.
    exact : bool
        Whether a given value is a choice or a convention, so that its digits say nothing of precision.
    """

    name: str
    axis: Axis | None
    rule: Rule
    unit: str = "1"
    meaning: str = ""
    latex: str = ""
    display: str = ""
    positive: bool = True
    requires: tuple[tuple[Rel, str], ...] = ()
    exact: bool = False

    @cached_property
    def symbol(self) -> Symbol:
        """The name as a sympy symbol, with its assumptions."""
        return Symbol(self.name, positive=True) if self.positive else Symbol(self.name, real=True)

    def __getitem__(self, index: Any) -> Indexed:
        """The cell of a row."""
        return IndexedBase(self.symbol)[index]

    @property
    def cell(self) -> Expr:
        """The column as it stands in formulas on its own axis."""
        return self.symbol if self.axis is None else self[self.axis.index]

    @property
    def equation(self) -> Equation | None:
        """The published equation behind it."""
        return None if isinstance(self.rule, Given) else self.rule.equation

    @property
    def source(self) -> str:
        """Number of its equation, or where it was given."""
        return self.rule.source if isinstance(self.rule, Given) else self.rule.equation.label

    @property
    def expressions(self) -> tuple[Basic, ...]:
        """All expressions that its rule and its conditions evaluate."""
        conditions = tuple(condition for condition, _ in self.requires)
        if isinstance(self.rule, Formula):
            return (self.rule.expression, *conditions)
        return (*self.rule.expressions, *conditions) if isinstance(self.rule, Root) else conditions


# --- the sheet -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Sheet:
    """Columns in an order in which each finds its precedents computed.

    Parameters
    ----------
    columns : tuple of Column
        In the order they are declared, which is the order they are shown.

    Raises
    ------
    SheetError
        A name has two rules, a symbol has none, an index does not belong to the axis.
    CycleError
        Columns wait for one another; its message shows the path.
    """

    columns: tuple[Column, ...]
    by_name: Mapping[str, Column] = field(init=False, repr=False)
    order: tuple[Column, ...] = field(init=False, repr=False)
    """Order of evaluation; ties break by declaration."""

    def __post_init__(self) -> None:
        names: dict[str, Column] = {}
        for column in self.columns:
            if column.name in names:
                raise SheetError(f"the column {column.name!r} has two rules; a name has exactly one")
            names[column.name] = column
        object.__setattr__(self, "by_name", names)
        for column in self.columns:
            self._check_symbols(column)
        object.__setattr__(self, "order", tuple(self._sorted()))

    def __getitem__(self, name: str) -> Column:
        return self.by_name[name]

    def __contains__(self, name: object) -> bool:
        return name in self.by_name

    @cached_property
    def axes(self) -> tuple[Axis, ...]:
        """All index sets, each after those it is made of."""
        found: dict[str, Axis] = {}

        def add(axis: Axis) -> None:
            for parent in axis.parents:
                add(parent)
            found.setdefault(axis.name, axis)

        for column in self.columns:
            if column.axis is not None:
                add(column.axis)
        return tuple(found.values())

    @cached_property
    def sizes(self) -> dict[Symbol, Axis]:
        """The axis whose number of rows a symbol stands for."""
        return {axis.size: axis for axis in self.axes}

    @cached_property
    def indices(self) -> dict[Symbol, Axis]:
        """The axis that a sum over a running number runs over."""
        return {axis.index: axis for axis in self.axes}

    def references(self, column: Column) -> tuple[Expr, ...]:
        """The cells that a column's rule names, ``x_p[i]`` and ``beta``, sorted by name."""
        own = {column.rule.unknown} if isinstance(column.rule, Root) else set()
        found: set[Expr] = set()
        for expression in column.expressions:
            found |= cells_of(expression) - own
        counts = {a.count for a in self._used_axes(column) if isinstance(a, RepeatAxis)}
        found |= {self.by_name[name].symbol for name in counts if name in self.by_name}
        running = {symbol for axis in self.axes for symbol in (*axis.maps, *axis.ordinals)} | set(self.sizes)
        return tuple(sorted(found - running, key=str))

    def precedents(self, column: Column) -> tuple[Column, ...]:
        """The columns that a column is computed from, in the order they were declared."""
        names = {name_of(cell) for cell in self.references(column)}
        return tuple(c for c in self.columns if c.name in names)

    def dependents(self, column: Column) -> tuple[Column, ...]:
        """The columns that are computed from a column directly."""
        return tuple(c for c in self.columns if column in self.precedents(c))

    def ancestors(self, column: Column) -> tuple[Column, ...]:
        """All columns that a column rests on, in order of evaluation."""
        seen: set[str] = set()

        def visit(current: Column) -> None:
            for precedent in self.precedents(current):
                if precedent.name not in seen:
                    seen.add(precedent.name)
                    visit(precedent)

        visit(column)
        return tuple(c for c in self.order if c.name in seen)

    def summed_axes(self, column: Column) -> tuple[Axis, ...]:
        """The axes that its rule sums over."""
        over = {
            limit[0]
            for expression in column.expressions
            for total in expression.atoms(Sum)
            for limit in total.limits
        }
        return tuple(axis for axis in self.axes if axis.index in over)

    def _used_axes(self, column: Column) -> Iterator[Axis]:
        for axis in (column.axis, *self.summed_axes(column)):
            while axis is not None:
                yield axis
                axis = axis.parents[0] if axis.parents else None

    def _check_symbols(self, column: Column) -> None:
        """Every symbol is a column, a size, or a running number that means something on this axis."""
        for expression in column.expressions:
            self._check_scope(column, expression, {} if column.axis is None else column.axis.maps)

    def _check_scope(self, column: Column, expression: Basic, maps: Mapping[Symbol, Axis]) -> None:
        if isinstance(expression, Sum):
            index = expression.limits[0][0]
            axis = self.indices.get(index)
            if axis is None or len(expression.limits) != 1 or expression.limits[0][2] != axis.size:
                raise SheetError(f"{column.name}: a sum must run over all rows of one axis, not {expression.limits}")
            self._check_scope(column, expression.function, axis.maps)
            return
        if isinstance(expression, Indexed):
            self._check_cell(column, expression, maps)
            return
        if isinstance(expression, Symbol):
            own = column.rule.unknown if isinstance(column.rule, Root) else None
            if expression == own or expression in self.sizes:
                return
            if any(expression in axis.ordinals for axis in maps.values()):
                return
            other = self.by_name.get(expression.name)
            if other is None:
                raise SheetError(f"{column.name}: no column is called {expression.name!r}")
            if other.axis is not None:
                raise SheetError(f"{column.name}: {expression.name} has one value for each of {other.axis.name}; say which")
        for argument in expression.args:
            self._check_scope(column, argument, maps)

    def _check_cell(self, column: Column, cell: Indexed, maps: Mapping[Symbol, Axis]) -> None:
        name, index = name_of(cell), cell.indices[0]
        other = self.by_name.get(name)
        if other is None:
            raise SheetError(f"{column.name}: no column is called {name!r}")
        where = maps.get(index)
        if where is None or other.axis != where:
            place = "a scalar" if other.axis is None else f"on {other.axis.name}"
            allowed = ", ".join(f"{i} ({axis.name})" for i, axis in maps.items()) or "none"
            raise SheetError(f"{column.name}: {cell} names a row of nothing: {name} is {place}; indices here: {allowed}")

    def _sorted(self) -> Iterator[Column]:
        """Depth first in the order of declaration; a cycle is shown as the path that closes it."""
        done: set[str] = set()
        path: list[str] = []

        def visit(column: Column) -> Iterator[Column]:
            if column.name in done:
                return
            if column.name in path:
                raise CycleError((*path[path.index(column.name) :], column.name))
            path.append(column.name)
            for precedent in self.precedents(column):
                yield from visit(precedent)
            path.pop()
            done.add(column.name)
            yield column

        for column in self.columns:
            yield from visit(column)


def name_of(cell: Expr) -> str:
    """The column's name in a cell, plain or indexed."""
    return str(cell.base.label) if isinstance(cell, Indexed) else str(cell)


def cells_of(expression: Basic) -> set[Expr]:
    """The cells in an expression: indexed ones, and plain symbols that are no part of them."""
    if isinstance(expression, (Indexed, Symbol)):
        return {expression}
    if isinstance(expression, Sum):
        return cells_of(expression.function) - {expression.limits[0][0]}
    found: set[Expr] = set()
    for argument in expression.args:
        found |= cells_of(argument)
    return found
