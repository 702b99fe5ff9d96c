"""What a plan is made of: nodes in plain symbols, and what each symbol stands for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, Literal

from sympy import Basic, Expr, Integer, Piecewise, Symbol, false, nan, true
from sympy.logic.boolalg import Boolean

from ...derivations.differentiated import differentiated
from ..axis import Axis, MemberAxis
from ..column import Column
from .order import Word

Kind = Literal["cells", "total", "part", "size", "kept", "ordinal"]


@dataclass(frozen=True)
class Leaf:
    """What a plain symbol stands for: an array with a number for each row of an axis, or one number."""

    kind: Kind
    """``cells`` of a column; a ``total`` over rows; a ``part`` that is neither; the ``size`` of an axis; how
    many of its rows are ``kept`` in the sums of a column; the ``ordinal``, a running number of them."""
    name: str = ""
    """Of the column, the total or the part."""
    axis: Axis | None = None
    """On whose rows it is read, or whose rows are counted; None for one number. A total over the rows of a
    group has a number for each group."""
    index: str | None = None
    """For cells, the index that names them from there; None if they stand on the same rows. For an ordinal,
    the running number."""

    @property
    def written(self) -> str:
        """Cells as the sheet writes them: ``x_p[j]``, ``beta``."""
        return self.name if self.axis is None else f"{self.name}[{self.index or self.axis.index_name}]"


# --- what is taken over rows ------------------------------------------------------------------------------


class OverRows(Expr):
    """What is taken over an axis' rows, as a function of the array of its terms.

    `terms`: in plain symbols, each of which stands for an array. `axis`: the axis' name.
    """

    is_commutative = True  # sympy asks for it
    is_real = True

    def _eval_is_positive(self) -> bool | None:
        return True if self.args[0].is_positive else None  # there are rows, or it has no value

    def _sympystr(self, printer: Any) -> str:
        terms, axis = map(printer._print, self.args[:2])
        return f"{self.word}({terms}, {axis})"


class RowSum(OverRows):
    """A sum: linear, which is all algebra needs."""

    def __new__(cls, terms: Expr, axis: Symbol) -> Expr:
        """Take numbers out, so that twice a sum is not another sum."""
        number, rest = terms.as_coeff_Mul()
        if number == 0:
            return Integer(0)
        total = super().__new__(cls, rest, axis)
        return total if number == 1 else number * total

    word: ClassVar[Word] = "sum"

    def _eval_derivative(self, symbol: Symbol) -> Expr:
        terms, axis = self.args
        return RowSum(differentiated(terms, symbol), axis)


class RowOrder(OverRows):
    """What is taken by order, with its word besides: ``median``, ``max`` or ``min``."""

    @property
    def word(self) -> Word:
        """What is taken."""
        return self.args[2].name  # type: ignore[no-any-return]


def free_name(wanted: str, taken: set[str]) -> str:
    """A name like the one that is wanted which is not taken; now it is."""
    while wanted in taken:
        wanted += "_"
    taken.add(wanted)
    return wanted


def taken_over(expressions: Iterable[Basic]) -> tuple[str, ...]:
    """The axes over which expressions take something, by name."""
    found = (taken for expression in expressions for taken in expression.atoms(OverRows))
    return tuple(sorted({taken.args[1].name for taken in found}))


# --- nodes ------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class GivenNode:
    """A column whose values come with the data."""

    column: Column
    datum: Symbol
    """Stands for a value in `allowed`."""
    allowed: Boolean | None = None
    """What a value must satisfy; None if any number will do."""


@dataclass(frozen=True)
class Total:
    """What is taken over those rows of an axis of which all cells that its column sums have values."""

    column: Column
    """In whose rule it stands."""
    symbol: Symbol
    """What stands for it."""
    over: Axis
    terms: Expr
    written: Expr
    """As the rule has it, in cells of rows."""
    word: Word = "sum"
    """What is taken."""

    @property
    def axis(self) -> Axis | None:
        """On whose rows it has numbers: groups if it is taken over the rows of each."""
        return self.column.axis if isinstance(self.over, MemberAxis) else None


@dataclass(frozen=True)
class Map:
    """A column of which each row is a formula of rows."""

    column: Column
    value: Expr
    requires: tuple[Boolean, ...]
    """The column's conditions, in their order."""
    defined: Boolean
    """Where it has a value at all; its sums stand in it. False where that is not known."""
    positive: Boolean
    """Where it is positive although no double may hold it; false if its value alone says it."""
    noticed: Boolean = true
    """Where a finite value is one: 1/(1/x + 1/y) is 0 in doubles where x is 0, and has no value."""

    @property
    def value_in_doubles(self) -> Expr:
        """The value, for engines that go on with the infinity of a division by zero: not a number there."""
        return self.value if self.noticed == true else Piecewise((self.value, self.noticed), (nan, True))


@dataclass(frozen=True)
class RootNode:
    """A column of which each row is made of the only zero of an equation in an interval."""

    column: Column
    unknown: Symbol
    low: Expr
    high: Expr
    start: Expr
    """`low`, `high` and `start`: the ends of the interval, and a first guess."""
    sign_low: Expr | None
    sign_high: Expr | None
    """`sign_low` and `sign_high`: what has the equation's sign at the ends; None if it is evaluated there."""
    turning: tuple[Expr, ...]
    """Points between which it changes sign at most once."""
    form: Expr
    """What must vanish. Sums of terms with the unknown stand in it; all others are nodes."""
    value: Expr
    """The column's value in terms of the unknown."""
    requires: tuple[Boolean, ...]
    """The column's conditions, in their order."""
    positive: bool
    """Whether its value is positive although no double may hold it, by what is assumed of what it names."""
    steps: int
    """How many steps a row takes at most before it is bisected."""


@dataclass(frozen=True)
class Part:
    """Numbers for the rows of an axis that are no column."""

    column: Column
    """Whose sums stand in them."""
    symbol: Symbol
    """What stands for them."""
    axis: Axis | None
    value: Expr


@dataclass(frozen=True)
class LoopNode:
    """Columns that rest on one another: computed again and again until the iterated ones stay."""

    columns: tuple[Column, ...]
    """The iterated ones, in their order."""
    starts: tuple[Node, ...]
    """What gives them their first values."""
    body: tuple[Node, ...]
    """A pass: the columns that are formulas, then the iterated ones, which name each other's last values."""

    @property
    def column(self) -> Column:
        """The one that it is called by."""
        return self.columns[0]


Node = GivenNode | Total | Part | Map | RootNode | LoopNode


def expressions(node: Node) -> Iterator[Basic]:
    """All that is evaluated for a node."""
    if isinstance(node, LoopNode):
        yield from (expression for each in (*node.starts, *node.body) for expression in expressions(each))
    elif isinstance(node, Total):
        yield node.terms
    elif isinstance(node, GivenNode):
        yield from () if node.allowed is None else (node.allowed,)
    elif isinstance(node, Part):
        yield node.value
    elif isinstance(node, Map):
        yield from (node.value, node.defined, node.positive, node.noticed, *node.requires)
    else:
        signs = (each for each in (node.sign_low, node.sign_high) if each is not None)
        yield from (node.value, node.form, node.low, node.high, node.start, *signs, *node.turning)
        yield from node.requires


@dataclass(frozen=True)
class Plan:
    """What is computed, in an order in which each node finds what it names."""

    nodes: tuple[Node, ...]
    """The totals of a column come right before it."""
    leaves: Mapping[Symbol, Leaf]
    """What every symbol stands for, but the unknowns of roots."""

    @cached_property
    def own(self) -> dict[str, Symbol]:
        """For every column, what stands for its cells on their own rows."""
        return {leaf.name: s for s, leaf in self.leaves.items() if leaf.kind == "cells" and not leaf.index}

    @cached_property
    def named(self) -> dict[str, Leaf]:
        """What a symbol stands for, by its name: of some is assumed more elsewhere."""
        return {symbol.name: leaf for symbol, leaf in self.leaves.items()}

    @cached_property
    def axes(self) -> dict[str, Axis]:
        """The axes of what its symbols stand for, and those that they are made of."""
        found, waiting = dict[str, Axis](), [leaf.axis for leaf in self.leaves.values()]
        while waiting:
            axis = waiting.pop()
            if axis is not None:
                found[axis.name] = axis
                waiting += axis.parents
        return found

    @cached_property
    def every(self) -> tuple[Node, ...]:
        """Its nodes, those in loops one by one: the starts before the passes."""
        loops = ((*n.starts, *n.body) if isinstance(n, LoopNode) else (n,) for n in self.nodes)
        return tuple(node for loop in loops for node in loop)

    @cached_property
    def loops(self) -> dict[str, LoopNode]:
        """Its loops, by what they are called."""
        return {node.column.name: node for node in self.nodes if isinstance(node, LoopNode)}

    @cached_property
    def totals(self) -> dict[str, Total]:
        """What it takes over rows, by the names of what stands for that."""
        return {node.symbol.name: node for node in self.every if isinstance(node, Total)}

    def alone(self, name: str) -> Plan:
        """What the values of a column rest on, and nothing that only says whether there are any.

        `name`: of a column of a plan without loops.
        """
        nodes, wanted = list[Node](), {name}
        for node in reversed(self.nodes):
            named = self.leaves[node.symbol] if isinstance(node, (Total, Part)) else node.column
            if named.name in wanted:
                nodes.append(_bare(node))
                symbols = {symbol for each in expressions(nodes[-1]) for symbol in each.free_symbols}
                wanted |= {self.leaves[symbol].name for symbol in symbols if symbol in self.leaves}
        return Plan(tuple(reversed(nodes)), self.leaves)


def _bare(node: Node) -> Node:
    """A node without what only says whether it has a value."""
    if isinstance(node, GivenNode):
        return replace(node, allowed=None)
    if isinstance(node, Map):
        return replace(node, requires=(), defined=true, positive=false, noticed=true)
    return replace(node, requires=()) if isinstance(node, RootNode) else node
