"""From a sheet to its plan: rows become arrays, sums become nodes of their own."""

from __future__ import annotations

from collections.abc import Collection
from itertools import chain, count
from typing import Any

from sympy import Eq, Expr, Indexed, Symbol, false, true
from sympy.core.symbol import Str

from ...derivations.rebuilt import in_absolute_values, rebuilt
from ...derivations.reductions import REDUCTIONS, OrderStatistic, taken_of
from ..named import name_of
from ..sheet import Axis, Column, Formula, Given, Iterated, MemberAxis, Root, Sheet
from .domain import defined, is_positive, noticed, outside, positive, typed_symbols
from .nodes import GivenNode, Leaf, LoopNode, Map, Node, OverRows, Plan, RootNode, RowOrder, RowSum, Total
from .special import SPECIAL, in_elementary_terms

_REAL = Symbol("_", real=True)

RESERVED = ("numpy", "run")
"""What printed programs call something else."""


def lowered(sheet: Sheet, known: Collection[str] = ()) -> Plan:
    """Lower a sheet.

    `known`: columns that are computed already: they have no node.
    """
    key = frozenset(known)
    if key not in sheet.plans:
        lowering = Lowering(sheet)
        left = [column for column in sheet.order if column.name not in known]
        nodes = [node for column in left for node in lowering.nodes(column)]
        sheet.plans[key] = Plan(tuple(nodes), lowering.leaves)
    return sheet.plans[key]  # type: ignore[no-any-return]


def lowered_column(sheet: Sheet, column: Column) -> Plan:
    """The nodes of one column alone."""
    lowering = Lowering(sheet)
    return Plan(tuple(lowering.nodes(column)), lowering.leaves)


class Lowering:
    """A sheet being lowered: the symbols so far, and what each stands for."""

    def __init__(self, sheet: Sheet) -> None:
        self.sheet = sheet
        self.leaves: dict[Symbol, Leaf] = {}
        self._symbols: dict[Leaf, Symbol] = {}
        self._totals: dict[str, int] = {}
        """How many there are of each column."""
        self._written: dict[Expr, Expr] = {}
        """What is taken over rows, by what it became."""
        self._axes = {axis.name: axis for axis in sheet.axes}
        self._taken = {*RESERVED, *(f"{axis.name}_kept" for axis in sheet.axes)}
        for column in sheet.columns:
            self.cells(column)  # they have the first claim to their names

    # --- symbols

    def symbol(self, leaf: Leaf, like: Symbol, *names: str) -> Symbol:
        """The symbol of a leaf, of which is assumed what is assumed of another; a new one has a free name."""
        if leaf not in self._symbols:
            wanted = chain(names, (names[-1] + "_" * n for n in count(1)))
            name = next(name for name in wanted if name not in self._taken)
            self._taken.add(name)
            self._symbols[leaf] = Symbol(name, **like.assumptions0)
            self.leaves[self._symbols[leaf]] = leaf
        return self._symbols[leaf]

    def cells(self, column: Column, axis: Axis | None = None, index: Symbol | None = None) -> Symbol:
        """The cells of a column, or those that an index names on the rows of an axis."""
        name = column.name
        if axis is None or index is None or column.axis is None or index == axis.index:
            return self.symbol(Leaf("cells", name, column.axis), column.symbol, name)
        longer = (f"{name}_{index}", f"{name}_{index}_of_{axis.name}")
        return self.symbol(Leaf("cells", name, axis, index.name), column.symbol, *longer)

    def leaf(self, cell: Expr, column: Column, axis: Axis | None) -> Symbol:
        """What an expression on the rows of an axis, in the rule of a column, names."""
        sheet = self.sheet
        if cell in sheet.algebra.sizes:
            counted = sheet.algebra.sizes[cell]
            if counted in sheet.summed_axes(column):
                return self.symbol(Leaf("kept", column.name, counted), cell, f"{cell}_of_{column.name}")
            return self.symbol(Leaf("size", "", counted), cell, str(cell))
        if isinstance(cell, Indexed):
            return self.cells(sheet[name_of(cell)], axis, cell.indices[0])
        if axis is not None and cell in axis.ordinals:
            names = str(cell), f"{cell}_of_{axis.name}"
            return self.symbol(Leaf("ordinal", "", axis, cell.name), cell, *names)
        return self.cells(sheet[cell.name]) if cell.name in sheet else cell

    # --- expressions

    def plain(self, expression: Any, column: Column, axis: Axis | None, unknown: Symbol | None = None) -> Any:
        """An expression in plain symbols; what is taken over rows stands in it.

        Parameters
        ----------
        column : Column
            In whose rule it stands.
        axis : Axis or None
            On whose rows: of the column, or of the sum that it stands in.
        unknown : Symbol, optional
            Of a root, which stays as it is.
        """
        if expression == unknown:
            return expression
        if isinstance(expression, REDUCTIONS):
            over = self.sheet.algebra.over(expression)
            name = Symbol(over.name)
            terms = taken_of(expression)
            if isinstance(expression, OrderStatistic):
                found = RowOrder(self.plain(terms, column, over, unknown), name, Str(expression.word))
                self._written[found] = expression
                return found
            number, terms = terms.as_coeff_Mul()
            found = RowSum(self.plain(terms, column, over, unknown), name)
            more, alone = found.as_coeff_Mul()
            own = expression.function / number / more
            self._written[alone] = expression.func(own, *expression.limits)
            return number * found
        if isinstance(expression, (Indexed, Symbol)):
            return self.leaf(expression, column, axis)
        if isinstance(expression, SPECIAL):
            expression = in_elementary_terms(expression)
        if not expression.args:
            return expression
        parts = [self.plain(argument, column, axis, unknown) for argument in expression.args]
        return rebuilt(expression, parts)

    def nodes(self, column: Column) -> list[Node]:
        """The nodes of a column, or those of its loop, which come with the last column of that."""
        loop = self.sheet.loop_of.get(column.name)
        if loop is None:
            return self.column(column)
        if column.name != loop.columns[-1].name:
            return []
        starts, body = list[Node](), [node for each in loop.formulas for node in self.column(each)]
        for each in loop.iterated:
            assert isinstance(each.rule, Iterated)
            starts += self.formula(each, each.rule.start)
            body += self.step(each, each.rule.step)
        return [LoopNode(loop.iterated, tuple(starts), tuple(body))]

    def column(self, column: Column) -> list[Node]:
        """The nodes of a column: its totals, then itself."""
        rule = column.rule
        if isinstance(rule, Given):
            return [GivenNode(column, *self.sheet.guards.get(column.name, (column.symbol, None)))]
        if isinstance(rule, Formula):
            return self.formula(column, rule.expression)
        assert isinstance(rule, Root)
        return self.root(column, rule)

    def formula(self, column: Column, expression: Expr) -> list[Node]:
        """The nodes of a formula of a column, or of what an iterated one starts from."""
        nodes = list[Node]()
        requires = tuple(self._lower(condition, column, nodes) for condition, _ in column.requires)
        plain = self.plain(expression, column, column.axis)
        asked = self._assuming(plain)
        sign = positive(asked) if column.positive else false
        value = self._lifted(plain, column, None, nodes)
        known = defined(asked)
        seen = true if known == true else self._noticed(value, column, nodes)
        return [*nodes, Map(column, value, requires, known, sign, seen)]

    def _noticed(self, value: Any, column: Column, nodes: list[Node]) -> Any:
        """Where a formula, and each term of its totals, is no finite number in doubles if it has no value."""
        totals = [each for each in nodes if isinstance(each, Total)]
        above_0 = {
            each.symbol: Symbol(each.symbol.name, positive=True)
            for each in totals
            if is_positive(self._assuming(each.terms))
        }

        def seen(expression: Any) -> Any:
            typed = above_0 | self._typed(expression)
            return noticed(expression.xreplace(typed)).xreplace({new: own for own, new in typed.items()})

        found = seen(value)
        for each in totals:
            lost = outside(seen(each.terms))
            if lost != 0:
                found &= Eq(self._lifted(RowSum(lost, Symbol(each.over.name)), column, None, nodes), 0)
        return found

    def step(self, column: Column, expression: Expr) -> list[Node]:
        """The nodes of the next value of an iterated column: where it has none, the whole loop has failed."""
        nodes = list[Node]()
        value = self._lower(expression, column, nodes)
        return [*nodes, Map(column, value, (), false, false)]

    def root(self, column: Column, rule: Root) -> list[Node]:
        """The nodes of a root."""
        nodes = list[Node]()

        def lower(expression: Any) -> Any:
            return self._lower(expression, column, nodes, rule.unknown)

        requires = tuple(lower(condition) for condition, _ in column.requires)
        node = RootNode(
            column,
            rule.unknown,
            lower(rule.low),
            lower(rule.high),
            lower(rule.start),
            None if rule.sign_low is None else lower(rule.sign_low),
            None if rule.sign_high is None else lower(rule.sign_high),
            tuple(map(lower, rule.turning)),
            in_absolute_values(lower(rule.expression), rule.unknown),
            lower(rule.value),
            requires,
            is_positive(self._assuming(self.plain(rule.value, column, column.axis, rule.unknown))),
            rule.steps,
        )
        return [*nodes, node]

    def _lower(
        self, expression: Any, column: Column, nodes: list[Node], unknown: Symbol | None = None
    ) -> Any:
        return self._lifted(self.plain(expression, column, column.axis, unknown), column, unknown, nodes)

    def _assuming(self, plain: Any) -> Any:
        return plain.xreplace(self._typed(plain))

    def _typed(self, plain: Any) -> dict[Symbol, Symbol]:
        """For the cells of an expression, symbols of which is assumed what they may be."""
        named = {symbol: self.leaves[symbol] for symbol in plain.free_symbols if symbol in self.leaves}
        return typed_symbols(self.sheet, named)

    def _lifted(self, expression: Any, column: Column, unknown: Symbol | None, nodes: list[Node]) -> Any:
        """The expression with symbols for what it takes over rows, which become nodes; not for what moves."""
        if not expression.has(OverRows):
            return expression
        parts = [self._lifted(argument, column, unknown, nodes) for argument in expression.args]
        if not isinstance(expression, OverRows):
            return rebuilt(expression, parts)
        terms, axis, *_ = parts
        if unknown is not None and terms.has(unknown):
            return expression.func(*parts)
        over, word = self._axes[axis.name], expression.word
        known = {(each.over, each.terms, each.word): each for each in nodes if isinstance(each, Total)}
        total = known.get((over, terms, word))
        if total is None:
            number = self._totals[column.name] = self._totals.get(column.name, 0) + 1
            rows = column.axis if isinstance(over, MemberAxis) else None
            symbol = self.symbol(
                Leaf("total", f"{column.name}.{number}", rows), _REAL, f"{column.name}_{word}_{number}"
            )
            total = Total(column, symbol, over, terms, self._written.get(expression, terms), word)
            nodes.append(total)
        return total.symbol
