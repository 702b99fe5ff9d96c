"""A step made ready for proof: its premises solved in turn, its symbols plain, what it rests on in sight."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from sympy import Expr, Float, Indexed, IndexedBase, Rel, Symbol, true
from sympy.core.function import AppliedUndef

from .algebra import NOTHING, Solved, definite, is_continuous, is_root, settle, solve_for, vanishes
from .cells import Cells, running
from .equation import Equation, Step
from .facts import Facts
from .sums import in_terms
from .text import Wording
from .vocabulary import Vocabulary

Told = Callable[[Any], str]
"""How an expression is written in the words of the ledger."""


class Refused(Exception):
    """A step that cannot be decided; the message is the sentence for the reader."""


@dataclass(frozen=True)
class System:
    """A step whose premises are solved."""

    claim: tuple[Expr, ...]
    """The members that are said to be equal."""
    premises: tuple[tuple[str, Expr, Expr], ...]
    """Label and both sides of what is assumed."""
    chain: tuple[tuple[Expr, Solved], ...]
    """Each eliminated symbol, in the order of evaluation: in terms of free symbols and of those before it."""
    solution: dict[Expr, Expr]
    """Each eliminated symbol in terms of the free ones alone."""
    conditions: tuple[Rel, ...]
    """What the claim says of its domain, and where the cells exist that it names."""
    facts: Facts
    """What follows from them for the algebra."""
    inside: str
    """Where its symbols are known to lie besides, as a sentence goes on."""
    inner: Facts
    """The facts without the ends of the domain: what holds there and is continuous holds at them, too."""
    multiplied: tuple[Expr, Expr, Expr] | None
    """Factor and both sides of the premise that is not solved: factor times premise is the claim."""
    names: dict[Any, Any]
    """What each plain symbol stands for: a cell, or the base of a column under a sum."""
    vocabulary: Vocabulary
    """What the symbols mean."""

    @property
    def expressions(self) -> tuple[Any, ...]:
        """Everything that is to be evaluated."""
        solved = [part for _, s in self.chain for part in (s.value, *s.pivots, *s.powers)]
        sides = [side for _, *pair in self.premises for side in pair]
        return (*solved, *sides, *self.claim, *self.conditions, *(self.multiplied or ()))

    def residual_is_zero(self) -> str | None:
        """Where every difference of neighbouring members vanishes once the premises are put in.

        Returns
        -------
        str or None
            Empty where the claim says itself where it holds; what is known besides of where its symbols lie;
            None where it was not seen to vanish.
        """
        inner = [self.inner] if all(map(is_continuous, self.claim)) else []
        where = ""
        for a, b in pairwise(self.claim):
            if self._are_roots_of_the_same(a, b) or vanishes(self._residual(a, b, NOTHING)):
                continue
            if not any(vanishes(self._residual(a, b, facts)) for facts in (self.facts, *inner)):
                return None
            where = self.inside
        return where

    def expands_to_zero(self) -> bool:
        """Whether every difference of neighbouring members vanishes by expanding it, which is soon seen."""
        return all(vanishes(self._residual(a, b, NOTHING), cheaply=True) for a, b in pairwise(self.claim))

    def _are_roots_of_the_same(self, a: Expr, b: Expr) -> bool:
        """Whether two members that are not negative have the same square."""
        if self.multiplied is not None or not all(is_root(settle(part, self.solution)) for part in (a, b)):
            return False
        return vanishes(self._residual(a**2, b**2, NOTHING))

    def _residual(self, a: Expr, b: Expr, facts: Facts) -> Expr:
        """What must vanish for two members to be equal."""
        parts = [settle(part, self.solution, facts) for part in (a, b, *(self.multiplied or ()))]
        residual = parts[0] - parts[1]
        if self.multiplied is not None:
            factor, left, right = parts[2:]
            residual -= factor * (left - right)
        # A row that was eliminated may come out of a sum.
        return facts.put(in_terms(residual).xreplace(self.solution))


def prepare(step: Step, vocabulary: Vocabulary) -> System:
    """Solve the premises of a step in turn.

    Parameters
    ----------
    vocabulary : Vocabulary
        Of the ledger that it belongs to.

    Raises
    ------
    Refused
        Where the step is not of the form that can be decided, or a premise could not be solved.
    """
    told = Wording(vocabulary).text
    _check_form(step, told)
    functions, columns = _functions(step, told), _columns(step, told)
    pairs = [
        (premise, unknown)
        for premise, unknown in zip(step.premises, step.eliminate, strict=False)
        if unknown not in functions and unknown not in columns
    ]

    def put(expression: Any) -> Any:
        return _rows_put(expression.xreplace(functions), columns)

    unsolved = step.premises[len(step.eliminate) :]
    equations = (step.claim, *(premise for premise, _ in pairs), *unsolved)
    given = [put(side) for equation in equations for side in equation.sides]
    given += [condition for equation in (*equations, *step.premises) for condition in equation.conditions]
    given += [unknown for _, unknown in pairs]
    given += [step.multiplier] if step.multiplier else []
    _check_running(given, told)
    cells = Cells.of(given)

    def plain(expression: Any) -> Any:
        return cells.plain(put(expression))

    def ends(equation: Equation) -> tuple[Expr, Expr]:
        return plain(equation.sides[0]), plain(equation.sides[-1])

    def domain(equation: Equation) -> dict[Any, Any]:
        """Where an equation says something: what it states, and that the cells exist which it names."""
        every = any(equation is law for law, _ in columns.values())  # then it speaks of the rows there are
        exist = () if every else cells.exist(map(put, equation.sides))
        return {plain(condition): condition for condition in (*equation.conditions, *exist)}

    conditions = tuple(domain(step.claim))
    inside = _inside(map(plain, given), cells.names, vocabulary)
    stated = Facts((*conditions, *inside))
    solution: dict[Expr, Expr] = {}
    chain: list[tuple[Expr, Solved]] = []
    for premise, cell in pairs:
        unknown = plain(cell)
        left, right = (settle(side, solution) for side in ends(premise))
        solved = solve_for(unknown, left, right, stated)
        if solved is None:
            raise Refused(f"{premise.label} was not seen to have one solution for {told(cell)}")
        if isinstance(unknown, Indexed) and any(
            row.base == unknown.base and not row.indices[0].is_Integer for row in solved.value.atoms(Indexed)
        ):
            raise Refused(f"{premise.label} holds {told(cell)} also as one of all its rows")
        solution = {known: value.xreplace({unknown: solved.value}) for known, value in solution.items()}
        solution[unknown] = solved.value
        chain.insert(0, (unknown, solved))
    known = [settle(condition, solution) for condition in (*conditions, *inside)]
    facts = Facts(known)
    for premise in step.premises:
        for condition, written in domain(premise).items():
            if condition not in conditions and not _is_implied(condition, solution, facts):
                raise Refused(
                    f"{premise.label} holds only where {told(written)}, which {step.claim.label} does not say"
                )
    multiplied = None
    if step.multiplier is not None:
        multiplied = (plain(step.multiplier), *ends(unsolved[0]))
        if not definite(stated.put(multiplied[0])):
            raise Refused(f"the factor {told(step.multiplier)} was not seen to be of one sign")
    return System(
        claim=tuple(plain(side) for side in step.claim.sides),
        premises=tuple((premise.label, *ends(premise)) for premise, _ in pairs),
        chain=tuple(chain),
        solution=solution,
        conditions=conditions,
        facts=facts,
        inside=" and ".join(told(each.xreplace(cells.names)) for each in inside),
        inner=Facts(known, inside=True),
        multiplied=multiplied,
        names=cells.names,
        vocabulary=vocabulary,
    )


def _inside(expressions: Iterable[Any], names: Mapping[Any, Any], vocabulary: Vocabulary) -> tuple[Rel, ...]:
    """Where the symbols of expressions are known to lie, whatever is said of them."""
    symbols = sorted({each for e in expressions for each in e.atoms(Symbol)}, key=str)
    found = ((symbol, vocabulary.find(names.get(symbol, symbol))) for symbol in symbols)
    every = (each for symbol, quantity in found if quantity is not None for each in quantity.inside(symbol))
    return tuple(each for each in every if each != true)


def _check_form(step: Step, told: Told) -> None:
    """Refuse what is no chain of equations, or does not say what each premise is for."""
    for equation in (step.claim, *step.premises):
        if len(equation.sides) < 2 or not all(isinstance(side, Expr) for side in equation.sides):
            raise Refused(f"{equation.label} does not say that expressions are equal")
        if any(side.has(Float) for side in equation.sides):
            raise Refused(f"{equation.label} holds a rounded number")
    premises, unknowns = len(step.premises), len(step.eliminate)
    if unknowns > premises:
        raise Refused(f"no premise is left to be solved for {told(step.eliminate[premises])}")
    if step.multiplier is None and unknowns < premises:
        loose = step.premises[unknowns]
        raise Refused(f"{loose.label} is a premise, but no step says what it is solved for")
    if step.multiplier is not None and (premises - unknowns != 1 or len(step.claim.sides) != 2):
        raise Refused("a factor turns one premise into an equation of two sides")


def _functions(step: Step, told: Told) -> dict[Expr, Expr]:
    """Laws for unknown functions: F(x) = ... holds for every x, so it may be put under an integral."""
    laws: dict[Expr, Expr] = {}
    for premise, unknown in zip(step.premises, step.eliminate, strict=False):
        if isinstance(unknown, AppliedUndef):
            if premise.sides[0] != unknown or premise.sides[-1].has(unknown.func) or unknown in laws:
                raise Refused(f"{premise.label} does not give {told(unknown)} in closed form")
            laws[unknown] = premise.sides[-1]
    return laws


def _columns(step: Step, told: Told) -> dict[Expr, tuple[Equation, Symbol]]:
    """Laws for columns, X[k] = ... of every row k, so that they may be put under a sum; with what k is."""
    laws: dict[Expr, tuple[Equation, Symbol]] = {}
    for premise, unknown in zip(step.premises, step.eliminate, strict=False):
        if isinstance(unknown, IndexedBase):
            cell, index = premise.sides[0], premise.sides[0].free_symbols & premise.sides[0].atoms(Symbol)
            row = next((s for s in index if cell == unknown[s]), None)
            if row is None or premise.sides[-1].has(unknown) or unknown in laws:
                raise Refused(
                    f"{premise.label} does not give every row of {told(unknown.label)} in closed form"
                )
            if any(condition.has(row) for condition in premise.conditions):
                raise Refused(f"{premise.label} does not hold for every row of {told(unknown.label)}")
            laws[unknown] = premise, row
    return laws


def _rows_put(expression: Any, columns: Mapping[Expr, tuple[Equation, Symbol]]) -> Any:
    """An expression without the columns of which every row is known."""
    for _ in columns:
        rows = {cell for cell in expression.atoms(Indexed) if cell.base in columns}
        if not rows:
            return expression
        laws = {cell: columns[cell.base] for cell in rows}
        expression = expression.xreplace(
            {cell: law.sides[-1].subs(index, cell.indices[0]) for cell, (law, index) in laws.items()}
        )
    if any(cell.base in columns for cell in expression.atoms(Indexed)):
        raise Refused("columns are told by one another in a circle")
    return expression


def _check_running(expressions: list[Any], told: Told) -> None:
    """Refuse what runs here and is fixed there, and what is positive by name but runs below zero."""
    limits = running(expressions)
    free = {symbol for expression in expressions for symbol in expression.free_symbols}
    bound = {limit[0] for limit in limits}
    for variable in sorted(bound & free, key=str):
        raise Refused(f"{told(variable)} runs in one expression and is fixed in another")
    cells = {cell for expression in expressions for cell in expression.atoms(Indexed)}
    for cell in sorted((c for c in cells if len(c.indices) > 1 and c.free_symbols & bound), key=str):
        raise Refused(f"{told(cell)} has several indices, and one of them runs")
    for variable, *places in limits:
        # A sum that ends before it begins has no terms; an integral runs backwards.
        if variable.is_integer and variable.is_positive:
            starts = bool(places[0].is_positive)
        else:
            starts = not variable.is_positive or all(place.is_nonnegative for place in places)
        if not starts:
            raise Refused(f"{told(variable)} is positive, but its limits are not")


def _is_implied(condition: Any, solution: Mapping[Expr, Expr], facts: Facts) -> bool:
    """Whether a condition of a premise follows from what is known once the solution is in."""
    if condition == true:
        return True
    if not isinstance(condition, Rel) or condition.rel_op not in (">", ">=", "<", "<="):
        return False
    margin = settle(condition.gts - condition.lts, solution)
    return facts.positive(margin) if condition.rel_op in "<>" else facts.nonnegative(margin)
