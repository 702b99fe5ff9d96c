"""Derivatives of a plan, and what rounding does in it, as a plan of its own.

Every node c = f(r, s, ...) has

- slopes: the derivative of f by each cell and each total that it names; for a root c = w(u) of G(u, r) = 0 by
  the implicit function theorem, w_r - w' G_r / G_u;
- for columns that are iterated, those of a number of passes where they have settled;
- the rounding R that its own operations leave, in units of eps, what it names taken as exact: |c| for a given
  column, whose double is the nearest to what was printed; for a formula one rounding of each operation's
  result, a sum with nothing cancelling, each times the derivative of what is computed from it; for a root
  the rounding of w, and |w'| (|u| + R(G) / |G_u|), because an equation that is computed wrong by R(G) has its
  root shifted by R(G) / G_u.

All of them are formulas of finished cells, made by sympy; none is typed for any model, and nothing is solved
again. What they amount to along all ways through the plan is a matter of numbers
(:mod:`~loopsheet.report.judge.bounds`, :mod:`~loopsheet.report.judge.enclosure`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial, reduce
from typing import Any

import sympy as sp
from sympy.core.function import ArgumentIndexError

from ...derivations.differentiated import beside_corners, differentiated
from ..axis import Axis, MemberAxis
from ..column import Column
from ..sheet import Sheet
from .lowering import RESERVED, lowered
from .nodes import GivenNode, Leaf, LoopNode, Map, Node, Part, Plan, RootNode, RowSum, Total, free_name
from .slopes import NodeDerivatives, Slope, unknown_of

PASSES = 20
"""How many passes of a loop are followed: each leaves a small share of what the last one did."""
_NO_FUNCTIONS = (sp.Derivative, sp.Subs, sp.Heaviside)


@dataclass(frozen=True)
class Derivatives:
    """The derivatives of a sheet."""

    again: Mapping[str, str]
    """Columns with roots whose cells do not tell the unknown, with the name of what stands for it."""
    plan: Plan
    """Its parts hold roundings and slopes; where one has no value, nothing is known."""
    nodes: tuple[NodeDerivatives, ...]
    """Each after those that it names."""


def derivatives(sheet: Sheet, roundings: bool = True) -> Derivatives:
    """Make the plan of a sheet's derivatives.

    `roundings`: whether what rounding does is asked for too.
    """
    plan = lowered(sheet)
    making = _Making(plan, roundings)
    locals_ = tuple(local for node in plan.nodes for local in making.node(node))
    return Derivatives(making.again, Plan(tuple(making.nodes), making.leaves), locals_)


class _Making:
    """The derivatives so far: the nodes of their plan, and what its symbols stand for."""

    def __init__(self, plan: Plan, roundings: bool) -> None:
        self.leaves, self.roundings = dict(plan.leaves), roundings
        self.taken = {*RESERVED, *(symbol.name for symbol in plan.leaves)}
        self.own, self.axes = plan.own, plan.axes
        self.nodes: list[Node] = []
        self.again: dict[str, str] = {}
        self.sums: dict[tuple[str, Axis, sp.Expr], sp.Symbol] = {}

    def node(self, node: Node) -> Iterator[NodeDerivatives]:
        """A node, after the sums of its equation if it is a root."""
        if isinstance(node, RootNode):
            yield from _RootMaking(self, node).locals()
        elif isinstance(node, GivenNode):
            yield self.local(node.column, lambda: _size(self.own[node.column.name]), {})
        elif isinstance(node, Map):
            value = _chosen(node.value)
            yield self.local(node.column, lambda: rounding(value), self.slopes(value))
        elif isinstance(node, LoopNode):
            yield from self.loop(node)
        elif isinstance(node, Total):
            self.nodes.append(node)
            yield self.total(node)

    def loop(self, node: LoopNode) -> Iterator[NodeDerivatives]:
        """Passes of a loop where it has settled: there, derivatives settle with them.

        All passes have the same slopes. In the first, what is iterated does not move.
        """
        once = [local for each in node.body for local in self.node(each)]
        own, iterated = {local.name for local in once}, {column.name for column in node.columns}
        for number in range(PASSES):

            def named(name: str, back: int = 0, number: int = number) -> str:
                left = PASSES - 1 - number + back
                return f"{name}~{left}" if left and name in own else name

            for local in once:
                moving = (slope for slope in local.slopes if number or slope.by not in iterated)
                slopes = (replace(each, by=named(each.by, each.by in iterated)) for each in moving)
                yield replace(local, name=named(local.name), slopes=tuple(slopes))

    def total(self, node: Total) -> NodeDerivatives:
        """What is taken over rows; it is a node of the derivatives too."""
        terms = _chosen(node.terms)
        # What is taken by order is cells; the mean of the two in the middle is rounded.
        return self.local(
            node.column,
            lambda: (
                self.summed(node.column, _size(terms) + rounding(terms), node.over)
                if node.word == "sum"
                else _size(node.symbol)
                if node.word == "median"
                else sp.Integer(0)
            ),
            self.slopes(terms),
            node,
        )

    def local(
        self,
        column: Column,
        own: Callable[[], sp.Expr],
        slopes: dict[sp.Symbol, sp.Expr],
        total: Total | None = None,
    ) -> NodeDerivatives:
        """A node, and the parts of its numbers; its own rounding only if it is asked for."""
        name = column.name if total is None else total.symbol.name
        over, axis = (None, column.axis) if total is None else (total.over, total.axis)
        held = self.part(f"{name}_rounding", column, axis, own()) if self.roundings else ""
        found = tuple(
            self.slope(by, self.part(f"{name}_slope_{n}", column, over or axis, slope))
            for n, (by, slope) in enumerate(slopes.items())
            if slope != 0
        )
        rows, summed = (None if each is None else each.name for each in (axis, over))
        return NodeDerivatives(
            name, rows, summed, column.name, held, found, "" if total is None else total.word
        )

    def slope(self, by: sp.Symbol, value: str) -> Slope:
        """The part that holds the derivative by what a symbol stands for."""
        leaf = self.leaves[by]
        if leaf.kind == "total":
            return Slope(by.name, leaf.axis and leaf.axis.name, None, value)
        return Slope(leaf.name, leaf.axis and leaf.axis.name, leaf.index, value)

    def slopes(self, expression: sp.Expr) -> dict[sp.Symbol, sp.Expr]:
        """The derivatives of an expression by what it names."""
        return {by: differentiated(expression, by) for by in self.named_in(expression)}

    def named_in(self, *expressions: sp.Expr) -> list[sp.Symbol]:
        """The cells and totals that expressions name, sorted by name; all else is exact."""
        free = set().union(*(expression.free_symbols for expression in expressions))
        named = (s for s in free if s in self.leaves and self.leaves[s].kind in ("cells", "total"))
        return sorted(named, key=str)

    def part(self, wanted: str, column: Column, axis: Axis | None, expression: sp.Expr) -> str:
        """A new part; its name."""
        # What jumps has no derivative that could be printed; the slope of a corner has one beside it.
        expression = beside_corners(expression)
        value = sp.S.NaN if expression.has(*_NO_FUNCTIONS) else expression
        symbol = self.symbol(wanted, Leaf("part", wanted, axis))
        self.nodes.append(Part(column, symbol, axis, value))
        return str(symbol.name)

    def symbol(self, wanted: str, leaf: Leaf | None) -> sp.Symbol:
        """A new symbol; without a leaf, whoever asks says what it stands for."""
        found = sp.Symbol(free_name(wanted, self.taken), real=True)
        if leaf is not None:
            self.leaves[found] = leaf
        return found

    def summed(self, column: Column, terms: sp.Expr, over: Axis) -> sp.Expr:
        """The sum of terms over the rows that the sums of a column keep."""
        if terms == 0:
            return terms
        key = column.name, over, terms
        if key not in self.sums:
            wanted = f"{column.name}_more_{len(self.sums)}"
            rows = column.axis if isinstance(over, MemberAxis) else None
            self.sums[key] = self.symbol(wanted, Leaf("total", wanted, rows))
            self.nodes.append(Total(column, self.sums[key], over, terms, terms))
        return self.sums[key]


class _RootMaking:
    """The derivatives of a root: sums with the unknown are nodes of their own, taken where the root lies."""

    def __init__(self, making: _Making, node: RootNode) -> None:
        self.making, self.root, self.column = making, node, node.column
        self.unknown = node.unknown
        self.moving: dict[sp.Symbol, tuple[Axis, sp.Expr]] = {}

    def locals(self) -> Iterator[NodeDerivatives]:
        making = self.making
        form, value = (self.named(_chosen(each)) for each in (self.root.form, self.root.value))
        here = self.here()
        for symbol, (over, terms) in self.moving.items():
            at = terms.xreplace({self.unknown: here})
            node = Total(self.column, symbol, over, at, at)
            making.nodes.append(node)
            slopes = {
                by: differentiated(terms, by).xreplace({self.unknown: here}) for by in self.names_in(terms)
            }
            yield making.local(self.column, partial(self.of_sum, terms, over, here), slopes, node)
        by_value, by_form = (self.by_unknown(each, here) for each in (value, form))
        ratio = by_value / by_form
        slopes = {
            by: differentiated(value, by) - ratio * differentiated(form, by)
            for by in self.names_in(value, form)
        }
        yield making.local(
            self.column,
            lambda: (
                rounding(value) + _size(by_value) * _size(self.unknown) + _size(ratio) * rounding(form)
            ).xreplace({self.unknown: here}),
            {by: slope.xreplace({self.unknown: here}) for by, slope in slopes.items()},
        )

    def of_sum(self, terms: sp.Expr, over: Axis, here: sp.Expr) -> sp.Expr:
        """The rounding of a sum of the equation."""
        own = (_size(terms) + rounding(terms)).xreplace({self.unknown: here})
        return self.making.summed(self.column, own, over)

    def names_in(self, *expressions: sp.Expr) -> list[sp.Symbol]:
        """What expressions name besides the unknown, which may be called as its column is."""
        return [symbol for symbol in self.making.named_in(*expressions) if symbol != self.unknown]

    def named(self, expression: Any) -> Any:
        """The expression with symbols for its sums."""
        if not expression.has(RowSum):
            return expression
        parts = [self.named(argument) for argument in expression.args]
        if not isinstance(expression, RowSum):
            return expression.func(*parts)
        terms, axis = parts
        key = self.making.axes[axis.name], terms
        for symbol, known in self.moving.items():
            if known == key:
                return symbol
        wanted = f"{self.column.name}_sum_{len(self.moving)}"
        symbol = self.making.symbol(wanted, Leaf("total", wanted))
        self.moving[symbol] = key
        return symbol

    def here(self) -> sp.Expr:
        """The unknown in terms of the cell; where that is no line, it is sought once more."""
        own = self.making.own[self.column.name]
        if self.moving and self.column.axis is not None:
            return sp.S.NaN  # a sum cannot name a row of the cell; each row would have a sum of its own
        value = self.root.value
        if value == self.unknown:
            return own
        cell = sp.Symbol("own", real=True)
        try:
            slope, rest = sp.Poly(sp.numer(sp.together(value - cell)), self.unknown).all_coeffs()
        except (sp.PolynomialError, ValueError):
            return self.again()
        found: sp.Expr = (-rest / slope).xreplace({cell: own})
        return found

    def again(self) -> sp.Symbol:
        """The unknown as a root of its own."""
        making, column = self.making, self.column
        symbol = making.symbol(f"{column.name}_unknown", None)
        again = unknown_of(column, symbol.name)
        making.leaves[symbol] = Leaf("cells", again.name, column.axis)
        making.again[column.name] = again.name
        making.nodes.append(replace(self.root, column=again, value=self.unknown, requires=()))
        return symbol

    def by_unknown(self, expression: sp.Expr, here: sp.Expr) -> sp.Expr:
        """The derivative by the unknown, sums included."""
        found = differentiated(expression, self.unknown)
        for symbol, (over, terms) in list(self.moving.items()):
            if symbol in expression.free_symbols:
                inner = self.by_unknown(terms, here).xreplace({self.unknown: here})
                found += differentiated(expression, symbol) * self.making.summed(self.column, inner, over)
        return found


def _chosen(expression: Any) -> Any:
    """Larger, smaller and absolute values written as choices."""
    if not expression.args or not expression.has(sp.Max, sp.Min, sp.Abs):
        return expression
    parts = [_chosen(argument) for argument in expression.args]
    if isinstance(expression, (sp.Max, sp.Min)):
        order = sp.Ge if isinstance(expression, sp.Max) else sp.Le
        return reduce(lambda a, b: sp.Piecewise((a, order(a, b)), (b, True)), parts)
    if isinstance(expression, sp.Abs):
        return sp.Piecewise((parts[0], parts[0] >= 0), (-parts[0], True))
    return expression.func(*parts)


# --- rounding ---------------------------------------------------------------------------------------------


def rounding(expression: sp.Expr) -> sp.Expr:
    """What the operations of an expression round, in units of eps: what it names is exact, results are not.

    `expression`: in plain symbols.
    """
    if expression.is_Symbol:
        return sp.Integer(0)
    if expression.is_Number or not expression.args:
        exact = expression.is_Rational and bin(expression.q).count("1") == 1
        return sp.Integer(0) if exact else _size(expression)
    if isinstance(expression, sp.Piecewise):
        return sp.Piecewise(*((rounding(value), condition) for value, condition in expression.args))
    if isinstance(expression, sp.Add):
        return sp.Add(*map(_size, expression.args), *map(rounding, expression.args))
    if isinstance(expression, sp.Mul):
        return _of_product(expression)
    if isinstance(expression, sp.Pow):
        base, exponent = expression.args
        inside = _size(exponent * base ** (exponent - 1)) * rounding(base)
        if not exponent.is_number:
            inside += _size(expression * sp.log(base)) * rounding(exponent)
        return _size(expression) + inside
    inner = [(n, rounding(argument)) for n, argument in enumerate(expression.args, start=1)]
    try:
        return sp.Add(_size(expression), *(_size(expression.fdiff(n)) * each for n, each in inner if each))
    except ArgumentIndexError:
        return sp.S.NaN  # a function that sympy cannot differentiate


def _of_product(product: sp.Expr) -> sp.Expr:
    """A product: a sign rounds nothing, and a quotient is rounded once."""
    factors = [factor for factor in product.args if factor != -1]
    found = _size(product) if len(factors) > 1 else sp.Integer(0)
    for n, factor in enumerate(product.args):
        inside = rounding(factor)
        if isinstance(factor, sp.Pow) and factor.exp == -1 and len(factors) > 1:
            inside = _size(factor) ** 2 * rounding(factor.base)
        if inside != 0:
            # Without the factor, not by it: what is chosen by cases may be zero.
            found += _size(sp.Mul(*product.args[:n], *product.args[n + 1 :])) * inside
    return found


def _size(expression: sp.Expr) -> sp.Expr:
    """The absolute value, without asking sympy for the sign of long expressions."""
    if expression.is_Number or expression.is_Symbol:
        return sp.Abs(expression)
    if isinstance(expression, sp.Mul):
        return sp.Mul(*map(_size, expression.args))
    if isinstance(expression, sp.exp) or (isinstance(expression, sp.Pow) and expression.base.is_positive):
        return expression
    if isinstance(expression, sp.Pow) and expression.exp.is_Integer:
        return _size(expression.base) ** expression.exp
    return sp.Abs(expression, evaluate=False)
