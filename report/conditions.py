"""How rounding errors arise in a sheet and how they spread: its own derivatives, as one more sheet.

Every column, and every sum in its rule, is a node. A node c = f(r, s, ...) has

- the rounding R that its own operations leave, in units of eps, its cells taken as exact: |c| for a given
  column, whose double is the nearest to what was printed; for a formula one rounding of each operation's
  result, a sum with nothing cancelling, each times the derivative of what is computed from it; for a root
  c = w(u) of G(u, r) = 0 the rounding of w, and |w'| (|u| + R(G) / |G_u|), because an equation that
  is computed wrong by R(G) has its root shifted by R(G) / G_u;
- slopes: the derivative of f by each cell and each sum that it names, w_r - w' G_r / G_u for a root.

Both are formulas of the sheet's cells, made by sympy; none is typed for any model. What they amount to,
the error of a cell as the sum of all roundings times what they do to it, is a matter of numbers:
:mod:`~loopsheet.report.analysis.bounds`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from itertools import count
from typing import Any

from sympy import (
    Abs,
    Add,
    Basic,
    Derivative,
    DiracDelta,
    Expr,
    Ge,
    Heaviside,
    Indexed,
    Integer,
    Le,
    Max,
    Min,
    Mul,
    Piecewise,
    Poly,
    PolynomialError,
    Pow,
    S,
    Subs,
    Sum,
    Symbol,
    diff,
    exp,
    log,
    numer,
    together,
)
from sympy.core.function import ArgumentIndexError

from ..derivations.equation import Equation, Kind
from ..derivations.reductions import REDUCTIONS, Median
from .sheet import Axis, Column, Formula, Given, Root, Sheet

__all__ = ["Conditions", "Node", "Slope", "conditions"]

_NO_FUNCTIONS = (Derivative, Subs, DiracDelta, Heaviside)


@dataclass(frozen=True)
class Slope:
    """The derivative of a node by what it names.

    Parameters
    ----------
    column : str
        The column that holds it, on the axis of the node; for a sum, on the axis that it runs over.
    by : Expr or str
        The cell, as it stands in the rule, or the name of the node of a sum.
    """

    column: str
    by: Expr | str


@dataclass(frozen=True)
class Node:
    """A column, or a sum or median in the rule of one.

    Parameters
    ----------
    name : str
        The column's name; for a sum, that of the column which holds its rounding.
    axis : Axis or None
        None for a scalar and for every sum and median.
    over : Axis or None
        The axis that a sum or a median runs over.
    of : str
        The column in whose rule it stands.
    rounding : str
        The column that holds its rounding in SI, in units of eps.
    slopes : tuple of Slope
    middle : bool
        Whether it is a median: of its slopes only those of the rows in the middle count.
    """

    name: str
    axis: Axis | None
    over: Axis | None
    of: str
    rounding: str
    slopes: tuple[Slope, ...]
    middle: bool = False


@dataclass(frozen=True)
class Conditions:
    """A sheet of roundings and derivatives.

    Parameters
    ----------
    sheet : Sheet
        The columns of the other sheet, all of them given: nothing is computed or solved again. Then their
        roundings and slopes; where one has no value, nothing is known of the error.
    nodes : tuple of Node
        Each after those that it names.
    counts : mapping of str to tuple of str and Axis
        Given scalars of the sheet: how many rows of an axis the sums of a column run over.
    """

    sheet: Sheet
    nodes: tuple[Node, ...]
    counts: Mapping[str, tuple[str, Axis]]


def conditions(sheet: Sheet) -> Conditions:
    """Make the sheet of another's roundings and derivatives.

    Parameters
    ----------
    sheet : Sheet

    Raises
    ------
    SheetError
        The result is no sheet; a bug of this module.
    """
    taken = {*sheet.by_name, *map(str, _symbols(sheet))}
    columns = [replace(column, rule=Given("computed"), requires=()) for column in sheet.columns]
    nodes: list[Node] = []
    counts: dict[str, tuple[str, Axis]] = {}
    for column in sheet.order:
        algebra = _Algebra(sheet, column, taken)
        nodes += algebra.nodes()
        columns += algebra.columns
        counts |= {name.name: (column.name, axis) for axis, name in algebra.counts.items()}
    return Conditions(Sheet(tuple(columns)), tuple(nodes), counts)


def _symbols(sheet: Sheet) -> Iterator[Symbol]:
    """What else has a name: sizes, indices, running numbers and unknowns."""
    for axis in sheet.axes:
        yield from (axis.size, *axis.maps, *axis.ordinals)
    for column in sheet.columns:
        if isinstance(column.rule, Root):
            yield column.rule.unknown


class _Made(Formula):
    """A formula that sympy has evaluated already; to do it again takes a third of the time."""

    @property
    def expression(self) -> Expr:
        """What is computed."""
        found: Expr = self.equation.members[-1]
        return found


@dataclass(frozen=True)
class _Total:
    """A sum or median of a rule: its axis, its terms in plain symbols, and as it is written."""

    axis: Axis
    terms: Expr
    written: Sum | Median


class _Algebra:
    """The algebra of one column: cells as plain symbols, sums as symbols of their own.

    Parameters
    ----------
    sheet : Sheet
    column : Column
    taken : set of str
        Names that are in use; new ones are added.
    """

    def __init__(self, sheet: Sheet, column: Column, taken: set[str]) -> None:
        self.sheet, self.column, self.taken = sheet, column, taken
        self.unknown = column.rule.unknown if isinstance(column.rule, Root) else None
        self.cells: dict[tuple[Expr, Axis | None], Symbol] = {}
        self.totals: dict[Symbol, _Total] = {}
        self.columns: list[Column] = []
        self.counts: dict[Axis, Symbol] = {}
        self.summed_axes = sheet.summed_axes(column)

    def nodes(self) -> Iterator[Node]:
        """The sums of the rule, then the column itself."""
        rule, column = self.column.rule, self.column
        if isinstance(rule, Given):
            yield self.node("", None, _size(column.cell), {})
            return
        value = self.plain(rule.value if isinstance(rule, Root) else rule.expression)
        form = self.plain(rule.expression) if isinstance(rule, Root) else None
        names: dict[Symbol, str] = {}
        for symbol, total in list(self.totals.items()):
            terms = total.terms
            # A median's terms are cells; the mean of the two in the middle is rounded.
            rounding = self.summed(_size(terms) + self.rounding(terms), total.axis)
            if isinstance(total.written, Median):
                rounding = _size(symbol)
            slopes = {by: diff(terms, by) for by in self.named_in(terms)}
            sum_node = self.node(f"_sum_{len(names)}", total, rounding, slopes, names)
            names[symbol] = sum_node.name
            yield sum_node
        rounding = self.rounding(value)
        if form is None:
            yield self.node("", None, rounding, {by: diff(value, by) for by in self.named_in(value)}, names)
            return
        assert self.unknown is not None
        ratio = self.total_derivative(value) / self.total_derivative(form)
        rounding += _size(self.total_derivative(value)) * _size(self.unknown)
        rounding += _size(ratio) * self.rounding(form)
        slopes = {by: diff(value, by) - ratio * diff(form, by) for by in self.named_in(value, form)}
        yield self.node("", None, rounding, slopes, names)

    def node(
        self,
        suffix: str,
        total: _Total | None,
        rounding: Expr,
        slopes: dict[Symbol, Expr],
        names: dict[Symbol, str] | None = None,
    ) -> Node:
        """A node, and the columns of its numbers."""
        own, axis = self.column, self.column.axis if total is None else None
        over = None if total is None else total.axis
        cells = {symbol: cell for (cell, _), symbol in self.cells.items()}
        held = self.hold(f"{own.name}{suffix}_rounding", axis, rounding)
        found = tuple(
            Slope(
                self.hold(f"{own.name}{suffix}_slope_{n}", over or axis, slope),
                cells[by] if by in cells else (names or {})[by],
            )
            for n, (by, slope) in enumerate(slopes.items())
            if slope != 0
        )
        middle = total is not None and isinstance(total.written, Median)
        return Node(held if total else own.name, axis, over, own.name, held, found, middle)

    def hold(self, name: str, axis: Axis | None, expression: Expr) -> str:
        """A new column; its name."""
        found, because = self.free(name), "made from the rule by sympy"
        # What jumps has no derivative that could be printed.
        value = S.NaN if expression.has(*_NO_FUNCTIONS) else self.cells_again(expression)
        definition = Equation("", (Symbol(found), value), because, Kind.DEFINITION, found)
        self.columns.append(Column(found, axis, _Made(definition), positive=False))
        return found

    def free(self, name: str) -> str:
        """A name that is not in use."""
        found = next(n for suffix in count() if (n := name + "_" * suffix) not in self.taken)
        self.taken.add(found)
        return found

    # --- plain symbols

    def plain(self, expression: Any, over: Axis | None = None) -> Any:
        """The expression with a symbol for every cell and every sum; choices written as such."""
        if isinstance(expression, REDUCTIONS):
            axis = self.sheet.indices[expression.limits[0][0]]
            return self.named(_Total(axis, self.plain(expression.function, axis), expression))
        if isinstance(expression, Indexed) or (isinstance(expression, Symbol) and self.is_cell(expression)):
            label = expression.base.label if isinstance(expression, Indexed) else expression
            # A scalar is the same inside and outside of sums.
            key = (expression, over if isinstance(expression, Indexed) else None)
            return self.cells.setdefault(key, Symbol(f"cell_{len(self.cells)}", **label.assumptions0))
        if self.sheet.sizes.get(expression) in self.summed_axes:
            return self.count(self.sheet.sizes[expression])
        if not expression.args:
            return expression
        parts = [self.plain(argument, over) for argument in expression.args]
        if isinstance(expression, (Max, Min)):
            order = Ge if isinstance(expression, Max) else Le
            return reduce(lambda a, b: Piecewise((a, order(a, b)), (b, True)), parts)
        if isinstance(expression, Abs):
            return Piecewise((parts[0], parts[0] >= 0), (-parts[0], True))
        return expression.func(*parts)

    def is_cell(self, symbol: Symbol) -> bool:
        """Whether a symbol is a scalar of the sheet; others are exact, or the unknown."""
        return symbol.name in self.sheet and symbol != self.unknown

    def count(self, axis: Axis) -> Symbol:
        """How many rows the column's sums run over: a derivative without a sum could not tell."""
        if axis not in self.counts:
            name = self.free(f"{self.column.name}_{axis.name}_kept")
            held = Column(name, None, Given("computed"), exact=True)
            self.columns.append(held)
            self.counts[axis] = held.symbol
        return self.counts[axis]

    def named(self, total: _Total) -> Symbol:
        """The symbol of a sum."""
        for symbol, known in self.totals.items():
            if known.written == total.written:
                return symbol
        symbol = Symbol(f"sum_{len(self.totals)}", real=True)
        self.totals[symbol] = total
        return symbol

    def summed(self, terms: Expr, axis: Axis) -> Expr:
        """A new sum of terms in plain symbols."""
        if terms == 0:
            return terms
        return self.named(_Total(axis, terms, Sum(self.written(terms), (axis.index, 1, axis.size))))

    def written(self, expression: Expr) -> Expr:
        """The expression in cells and sums, the unknown of a root as it is."""
        back: dict[Basic, Basic] = {symbol: cell for (cell, _), symbol in self.cells.items()}
        back |= {symbol: total.written for symbol, total in self.totals.items()}
        found: Expr = expression.xreplace(back)
        return found

    def cells_again(self, expression: Expr) -> Expr:
        """The expression in cells alone; NaN where that cannot be written."""
        found = self.written(expression)
        if self.unknown is None or self.unknown not in found.free_symbols:
            return found
        sums = any(self.unknown in total.free_symbols for total in found.atoms(Sum))
        # A sum cannot name a row of the cell; each row would have a sum of its own.
        return S.NaN if sums and self.column.axis is not None else found.xreplace({self.unknown: self.back})

    @cached_property
    def back(self) -> Expr:
        """The unknown of the root in terms of its cell; where that is no line, it is sought once more."""
        assert isinstance(self.column.rule, Root)
        value, unknown = self.column.rule.value, self.column.rule.unknown
        if value == unknown:
            return self.column.cell
        own = Symbol("own", real=True)
        try:
            slope, rest = Poly(numer(together(value - own)), unknown).all_coeffs()
        except (PolynomialError, ValueError):
            rule = replace(self.column.rule, value=unknown)
            name = self.free(f"{self.column.name}_unknown")
            again = replace(self.column, name=name, rule=rule, positive=False, requires=())
            self.columns.append(again)
            return again.cell
        found: Expr = (-rest / slope).xreplace({own: self.column.cell})
        return found

    # --- derivatives

    def named_in(self, *expressions: Expr) -> list[Symbol]:
        """The cells and sums that expressions name, in the order they were found."""
        named = set().union(*(expression.free_symbols for expression in expressions))
        return [symbol for symbol in (*self.cells.values(), *self.totals) if symbol in named]

    def total_derivative(self, expression: Expr) -> Expr:
        """By the unknown of the root, sums included."""
        found = diff(expression, self.unknown)
        for symbol, total in list(self.totals.items()):
            if symbol in expression.free_symbols:
                inner = self.summed(self.total_derivative(total.terms), total.axis)
                found += diff(expression, symbol) * inner
        return found

    # --- rounding

    def rounding(self, expression: Expr) -> Expr:
        """What the operations of an expression round, in units of eps: cells are exact, results are not."""
        if expression.is_Symbol:
            return Integer(0)  # cells, and sums, which are nodes of their own
        if expression.is_Number or not expression.args:
            exact = expression.is_Rational and bin(expression.q).count("1") == 1
            return Integer(0) if exact else _size(expression)
        if isinstance(expression, Piecewise):
            return Piecewise(*((self.rounding(value), condition) for value, condition in expression.args))
        if isinstance(expression, Add):
            return Add(*map(_size, expression.args), *map(self.rounding, expression.args))
        if isinstance(expression, Mul):
            return self._product(expression)
        if isinstance(expression, Pow):
            base, exponent = expression.args
            inside = _size(exponent * base ** (exponent - 1)) * self.rounding(base)
            if not exponent.is_number:
                inside += _size(expression * log(base)) * self.rounding(exponent)
            return _size(expression) + inside
        inner = [(n, self.rounding(argument)) for n, argument in enumerate(expression.args, start=1)]
        try:
            return Add(_size(expression), *(_size(expression.fdiff(n)) * each for n, each in inner if each))
        except ArgumentIndexError:
            return S.NaN  # a function that sympy cannot differentiate

    def _product(self, product: Expr) -> Expr:
        """A product: a sign rounds nothing, and a quotient is rounded once."""
        factors = [factor for factor in product.args if factor not in (1, -1)]
        found = _size(product) if len(factors) > 1 else Integer(0)
        for factor in factors:
            inside = self.rounding(factor)
            if isinstance(factor, Pow) and factor.exp == -1 and len(factors) > 1:
                inside = _size(factor) ** 2 * self.rounding(factor.base)
            if inside != 0:
                found += _size(product / factor) * inside
        return found


def _size(expression: Expr) -> Expr:
    """The absolute value, without asking sympy for the sign of long expressions."""
    if expression.is_Number or expression.is_Symbol or isinstance(expression, Indexed):
        return Abs(expression)
    if isinstance(expression, Mul):
        return Mul(*map(_size, expression.args))
    if isinstance(expression, exp) or (isinstance(expression, Pow) and expression.base.is_positive):
        return expression
    if isinstance(expression, Pow) and expression.exp.is_Integer:
        return _size(expression.base) ** expression.exp
    return Abs(expression, evaluate=False)
