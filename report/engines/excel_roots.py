"""A root as visible cells: everything the solver does, one quantity a cell, unrolled step by step.

The cells are parts of a plan, so the printer that prints formulas prints them as well, and NumPy computes
what they show before a spreadsheet has recalculated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from sympy import Abs, And, Eq, Expr, Integer, Piecewise, Symbol, sign, sqrt, true
from sympy.logic.boolalg import Boolean

from ...derivations.differentiated import differentiated
from ..plan.nodes import Leaf, Node, Part, Plan, RootNode, RowSum, Total, free_name
from ..sheet import Column
from .excel import IfError, IsNumber
from .excel_values import SETTLED
from .roots import derivatives, householder

_PRIMES = "′″‴"
_DERIVATIVES = ("its derivative", "its second derivative", "its third derivative")
_LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")

_REAL = Symbol("_", real=True)


@dataclass(frozen=True)
class Auxiliary:
    """One quantity on the way to a root."""

    name: str
    """The column's name, a dot and its own."""
    title: str
    meaning: str
    """`title` and `meaning`: for the reader."""
    part: Part
    """Of the plan."""
    step: int = 0
    """Which step it belongs to, from 1; 0 before the first."""
    alone: bool = False
    """Whether it is only there where there is one root."""
    residual: bool = False
    """Whether it is a difference that tends to zero, which must not be rounded to it."""


@dataclass(frozen=True)
class Unrolled:
    """A root as cells."""

    node: RootNode
    plan: Plan
    """What its cells are made of."""
    check: Leaf
    """The cell that says whether all precedents have values, and the first error if not."""
    cells: tuple[Auxiliary, ...]
    """In order of evaluation."""
    number: Leaf
    """How many roots there are; no number where the form has no sign."""
    known: Boolean
    settled: Boolean
    """`known` and `settled`: whether the form had a value at the last step, and whether that step was so
    small that the next one would not show."""
    value: Expr
    """The column's value, where there is one root."""
    issued: Leaf | None = None
    counted: Leaf | None = None
    """`issued` and `counted`: where the number of roots is not certified for all inputs: the cell that says
    whether the inputs are those of the report as issued (1 or 0), and the one that holds how many roots there
    are for those, -1 where that is not certain."""

    @property
    def column(self) -> Column:
        """Whose cells they are."""
        return self.node.column


def unroll(plan: Plan, node: RootNode, certified: bool, times: int) -> Unrolled:
    """Lay the solver of a root out as cells.

    `node`: of the plan. `certified`: whether the number of its roots follows from signs for all inputs. No
    formula could count them otherwise: the workbook then keeps to the inputs for which they were counted.
    `times`: of the rule's steps, after which other engines bisect and a workbook ends.
    """
    return _Unrolling(plan, node, certified, times).run()


class _Unrolling:
    """One root being laid out: the cells so far."""

    def __init__(self, plan: Plan, node: RootNode, certified: bool, times: int) -> None:
        self.node, self.column, self.certified = node, node.column, certified
        self.rule = node if certified else replace(node, turning=())
        self.unknown, self.form = node.unknown, node.form
        self.leaves, self.taken = dict(plan.leaves), {symbol.name for symbol in plan.leaves}
        self.axes = plan.axes
        self.totals = {total.symbol: total for total in plan.totals.values() if total.column == node.column}
        self.nodes: list[Node] = []
        self.sums: dict[tuple[Expr, str], Auxiliary] = {}
        """The cells of sums, by their terms and the axis they run over."""
        self.cells: list[Auxiliary] = []
        # Newton's step where a derivative is a sum: three more passes over all points cost more than steps.
        summed = self.form.has(RowSum)
        self.slopes = (
            (differentiated(self.form, self.unknown),) if summed else derivatives(self.form, self.unknown)[1:]
        )
        self.steps = times * self.rule.steps
        self.now, self.alone = 0, False

    def run(self) -> Unrolled:
        places, signs, start = self.ends()
        number, left, right, rising = self.bracket(places, signs)
        middle = self.middle(left, right)
        inside = And(IsNumber(start), start > left, start < right)
        says = "the guess; the middle of the bracket if it lies outside"
        here = self.place("u_0", self.lowered(0), says, Piecewise((start, inside), (middle, True)))
        form = before = here
        for step in range(1, self.steps + 1):
            self.now, before = step, here
            form, left, right, here = self.step(step, left, right, rising, here)
        known, settled = IsNumber(form), Abs(here - before) * SETTLED <= Abs(here)
        value = self.rule.value.xreplace({self.unknown: here})
        asked = (None, None) if self.certified else (self.told("issued"), self.told("counted"))
        plan = Plan((*self.totals.values(), *self.nodes), self.leaves)
        check, cells = self.told("check"), tuple(self.cells)
        return Unrolled(self.node, plan, check, cells, self.leaves[number], known, settled, value, *asked)

    # --- cells

    def lowered(self, number: int) -> str:
        return f"{self.unknown}{str(number).translate(_LOWERED)}"

    def told(self, name: str) -> Leaf:
        """A cell that no formula of others makes."""
        return Leaf("cells", f"{self.column.name}.{name}", self.column.axis)

    def symbol(self, leaf: Leaf, like: Symbol = _REAL) -> Symbol:
        symbol = Symbol(free_name(leaf.name.replace(".", "_"), self.taken), **like.assumptions0)
        self.leaves[symbol] = leaf
        return symbol

    def add(
        self, name: str, title: str, meaning: str, value: Expr, residual: bool = False, like: Symbol = _REAL
    ) -> Symbol:
        """A cell; its sums get cells of their own first."""
        leaf = replace(self.told(name), kind="part")
        part = Part(self.column, self.symbol(leaf, like), leaf.axis, self.without_sums(value))
        self.nodes.append(part)
        self.cells.append(Auxiliary(leaf.name, title, meaning, part, self.now, self.alone, residual))
        return part.symbol

    def place(self, name: str, title: str, meaning: str, value: Expr) -> Symbol:
        """A cell that holds a value of the unknown: it is assumed to be what the unknown is."""
        return self.add(name, title, meaning, value, like=self.unknown)

    def without_sums(self, expression: Expr) -> Expr:
        """The expression with a cell for each of its sums; equal sums share one."""
        sums = {total: (total.args[0], total.args[1].name) for total in expression.atoms(RowSum)}
        sums |= {s: (t.terms, t.over.name) for s, t in self.totals.items() if expression.has(s)}
        return expression.xreplace({each: self.sum(*sums[each]) for each in sorted(sums, key=str)})

    def sum(self, terms: Expr, axis: str) -> Symbol:
        """The cell of a sum."""
        terms = self.without_sums(terms)
        if (terms, axis) not in self.sums:
            number = 1 + sum(cell.step == self.now for cell in self.sums.values())
            name, title = f"sum_{self.now}_{number}", f"Σ{str(number).translate(_LOWERED)}"
            symbol = self.symbol(Leaf("total", f"{self.column.name}.{name}_of"))
            self.nodes.append(Total(self.column, symbol, self.axes[axis], terms, terms))
            self.add(name, title, self.said(terms), symbol)
            self.sums[terms, axis] = self.cells[-1]
        return self.sums[terms, axis].part.symbol

    def said(self, terms: Expr) -> str:
        """A sum's terms, with cells and the unknown named as the reader knows them."""
        leaves = {symbol: self.leaves[symbol] for symbol in terms.free_symbols}
        own = {s: s.func(leaf.written) for s, leaf in leaves.items() if leaf.kind == "cells"}
        own |= {s: self.unknown for s, leaf in leaves.items() if leaf.kind == "part"}
        own |= {cell.part.symbol: Symbol(f"({cell.meaning})") for cell in self.sums.values()}
        return f"sum of {str(terms.xreplace(own)).replace('**', '^')}"

    # --- how many roots, and where

    def at(self, place: Symbol) -> Expr:
        return self.form.xreplace({self.unknown: place})

    def ends(self) -> tuple[list[Symbol], list[Symbol], Symbol]:
        """The points between which the form changes sign at most once, its signs there, and a first guess."""
        rule = self.rule
        low = self.place("low", "low", "lower end of the interval of the unknown", rule.low)
        high = self.place("high", "high", "upper end of the interval of the unknown", rule.high)
        start = self.add("start", "start", "first guess: it costs steps, never truth", rule.start)
        places, signs = [low], [self.sign("low", "at the lower end", rule.sign_low, low)]
        for number, point in enumerate(rule.turning, start=1):
            name = "turn" if len(rule.turning) == 1 else f"turn{number}"
            raw = self.add(
                f"{name}_raw", "turning", "where the form may turn; empty if there is no such point", point
            )
            inside = And(IsNumber(raw), raw > places[-1], raw < high)
            says = "the turning point if it lies inside, else the point before it"
            place = self.place(name, "place", says, Piecewise((raw, inside), (places[-1], True)))
            form = self.add(f"form_{name}", "form", "value of the form there", self.at(place), residual=True)
            there = Piecewise((sign(form), place > places[-1]), (signs[-1], True))
            signs.append(self.add(f"sign_{name}", "sign", "sign of the form there", there))
            places.append(place)
        places.append(high)
        signs.append(self.sign("high", "at the upper end", rule.sign_high, high))
        return places, signs, start

    def sign(self, name: str, where: str, told: Expr | None, place: Symbol) -> Symbol:
        if told is None:
            told = self.add(
                f"form_{name}", "form", f"value of the form {where}", self.at(place), residual=True
            )
        return self.add(f"sign_{name}", "sign", f"sign of the form {where}", sign(told))

    def bracket(
        self, places: Sequence[Symbol], signs: Sequence[Symbol]
    ) -> tuple[Symbol, Symbol, Symbol, Symbol]:
        """The number of sign changes, and the stretch with the only one."""
        crossings = [a * b < 0 for a, b in pairwise(signs)]
        counted = sum((Piecewise((1, crossing), (0, True)) for crossing in crossings), Integer(0))
        known = And(*(IsNumber(cell) for cell in (*signs, places[0], places[-1])))
        says = "number of sign changes: of roots"
        if not self.certified:
            counted, issued = (self.symbol(self.told(name)) for name in ("counted", "issued"))
            says = "number of roots, if the inputs are those as issued"
            known = And(known, Eq(issued, 1))
        number = self.add("roots", "roots", says, Piecewise((counted, known)))
        self.alone = True

        def choose(values: Sequence[Symbol]) -> Expr:
            return Piecewise(*zip(values, [*crossings[:-1], True], strict=True))

        left = self.place("left_0", "left", "left end of the bracket", choose(places[:-1]))
        right = self.place("right_0", "right", "right end of the bracket", choose(places[1:]))
        rising = self.add("rising", "rising", "sign of the form at its right end", choose(signs[1:]))
        return number, left, right, rising

    # --- one step

    def middle(self, left: Symbol, right: Symbol) -> Expr:
        """The middle of a bracket: of its decades where it may go over three or more."""
        low, high = self.rule.low, self.rule.high
        decades = low.is_positive and (high < 1000 * low) != true
        return sqrt(left) * sqrt(right) if decades else (left + right) / 2

    def step(
        self, n: int, left: Symbol, right: Symbol, rising: Symbol, here: Symbol
    ) -> tuple[Symbol, Symbol, Symbol, Symbol]:
        """The form, what a step leaves of the bracket and where it leads, as all engines take it."""
        f = self.add(f"f_{n}", "f", "value of the form", self.at(here), residual=True)
        slopes = [
            self.add(
                f"slope{order}_{n}", f"f{_PRIMES[order]}", says, form.xreplace({self.unknown: here}), True
            )
            for order, (form, says) in enumerate(zip(self.slopes, _DERIVATIVES, strict=False))
        ]
        by = f / slopes[0] if len(slopes) == 1 else householder(f, *slopes)
        by = self.add(f"step_{n}", "step", "what is subtracted from the unknown", by)
        side = f * rising
        left = self.place(
            f"left_{n}", "left", "left end of what is left of the bracket",
            IfError(Piecewise((here, side <= 0), (left, True)), left),
        )  # fmt: skip
        right = self.place(
            f"right_{n}", "right", "right end of what is left of the bracket",
            IfError(Piecewise((here, side > 0), (right, True)), right),
        )  # fmt: skip
        middle, there = self.middle(left, right), here - by
        inside = And(there >= left, there <= right)
        moved = Piecewise((here, Eq(f, 0)), (there, inside), (middle, True))
        says = "the unknown after the step; a step out of the bracket is replaced by its middle"
        return f, left, right, self.place(f"u_{n}", self.lowered(n), says, IfError(moved, middle))
