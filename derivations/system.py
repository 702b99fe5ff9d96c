"""A step made ready for proof: its premises solved in turn, its symbols plain, what it rests on in sight."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from sympy import Expr, Float, Indexed, IndexedBase, Integral, Rel, Symbol, true
from sympy.core.function import AppliedUndef

from .algebra import Solved, definite, settle, solve_for, vanishes
from .equation import Equation, Step
from .reductions import REDUCTIONS
from .text import Writer
from .vocabulary import Vocabulary

__all__ = ["Refused", "System", "prepare"]

Told = Callable[[Any], str]
"""How an expression is written in the words of the ledger."""


class Refused(Exception):
    """A step that cannot be decided; the message is the sentence for the reader."""


@dataclass(frozen=True)
class System:
    """A step whose premises are solved.

    Parameters
    ----------
    claim : tuple of Expr
        The members that are said to be equal.
    premises : tuple of (str, Expr, Expr)
        Label and both sides of what is assumed.
    chain : tuple of (Expr, Solved)
        Each eliminated symbol, in the order of evaluation: in terms of free symbols and of those before it.
    solution : dict
        Each eliminated symbol in terms of the free ones alone.
    conditions : tuple of Rel
        What the claim says of its domain.
    multiplied : tuple of Expr or None
        Factor and both sides of the premise that is not solved: factor times premise is the claim.
    names : dict
        What each plain symbol stands for: a cell, or the base of a column under a sum.
    vocabulary : Vocabulary
        What the symbols mean.
    """

    claim: tuple[Expr, ...]
    premises: tuple[tuple[str, Expr, Expr], ...]
    chain: tuple[tuple[Expr, Solved], ...]
    solution: dict[Expr, Expr]
    conditions: tuple[Rel, ...]
    multiplied: tuple[Expr, Expr, Expr] | None
    names: dict[Any, Any]
    vocabulary: Vocabulary

    @property
    def expressions(self) -> tuple[Any, ...]:
        """Everything that is to be evaluated."""
        solved = [part for _, s in self.chain for part in (s.value, *s.pivots, *s.powers)]
        sides = [side for _, *pair in self.premises for side in pair]
        return (*solved, *sides, *self.claim, *self.conditions, *(self.multiplied or ()))

    def residual_is_zero(self) -> bool:
        """Whether every difference of neighbouring members vanishes once the premises are put in."""
        sides = [settle(side, self.solution) for side in self.claim]
        if self.multiplied is not None:
            factor, left, right = (settle(part, self.solution) for part in self.multiplied)
            return vanishes((sides[0] - sides[1]) - factor * (left - right))
        return all(vanishes(a - b) for a, b in pairwise(sides))


def prepare(step: Step, vocabulary: Vocabulary) -> System:
    """Solve the premises of a step in turn.

    Parameters
    ----------
    step : Step
    vocabulary : Vocabulary
        Of the ledger that it belongs to.

    Raises
    ------
    Refused
        Where the step is not of the form that can be decided, or a premise could not be solved.
    """
    told = Writer(vocabulary).text
    _check_form(step, told)
    functions = _functions(step, told)
    pairs = [
        (premise, unknown)
        for premise, unknown in zip(step.premises, step.eliminate, strict=False)
        if unknown not in functions
    ]
    unsolved = step.premises[len(step.eliminate) :]
    equations = (step.claim, *(premise for premise, _ in pairs), *unsolved)
    given = [side.xreplace(functions) for equation in equations for side in equation.sides]
    given += [condition for equation in (*equations, *step.premises) for condition in equation.conditions]
    given += [unknown for unknown in step.eliminate if unknown not in functions]
    names, flat = _plain_names([*given, *([step.multiplier] if step.multiplier else [])], told)

    def plain(expression: Any) -> Any:
        return expression.xreplace(functions).xreplace(flat)

    def ends(equation: Equation) -> tuple[Expr, Expr]:
        return plain(equation.sides[0]), plain(equation.sides[-1])

    solution: dict[Expr, Expr] = {}
    chain: list[tuple[Expr, Solved]] = []
    for premise, cell in pairs:
        unknown = plain(cell)
        left, right = (settle(side, solution) for side in ends(premise))
        solved = solve_for(unknown, left, right)
        if solved is None:
            raise Refused(f"{premise.label} was not seen to have one solution for {told(cell)}")
        solution = {known: value.xreplace({unknown: solved.value}) for known, value in solution.items()}
        solution[unknown] = solved.value
        chain.insert(0, (unknown, solved))
    conditions = tuple(plain(condition) for condition in step.claim.conditions)
    for premise in step.premises:
        for condition in premise.conditions:
            if plain(condition) not in conditions and not _is_implied(plain(condition), solution):
                raise Refused(
                    f"{premise.label} holds only where {told(condition)}, "
                    f"which {step.claim.label} does not say"
                )
    multiplied = None
    if step.multiplier is not None:
        multiplied = (plain(step.multiplier), *ends(unsolved[0]))
        if not definite(multiplied[0]):
            raise Refused(f"the factor {told(step.multiplier)} was not seen to be of one sign")
    return System(
        claim=tuple(plain(side) for side in step.claim.sides),
        premises=tuple((premise.label, *ends(premise)) for premise, _ in pairs),
        chain=tuple(chain),
        solution=solution,
        conditions=conditions,
        multiplied=multiplied,
        names=names,
        vocabulary=vocabulary,
    )


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


def _plain_names(expressions: list[Any], told: Told) -> tuple[dict[Any, Any], dict[Indexed, Expr]]:
    """Plain symbols for cells: algebra on them is faster, and no cell shares its name with a column."""
    limits = [limit for e in expressions for loop in e.atoms(Integral, *REDUCTIONS) for limit in loop.limits]
    bound = {limit[0] for limit in limits}
    free = {symbol for expression in expressions for symbol in expression.free_symbols}
    for variable in sorted(bound & free, key=str):
        raise Refused(f"{told(variable)} runs in one expression and is fixed in another")
    for variable, *places in limits:
        if variable.is_positive and not all(_may_start(place, variable) for place in places):
            raise Refused(f"{told(variable)} is positive, but its limits are not")
    names: dict[Any, Any] = {}
    flat: dict[Indexed, Expr] = {}
    for cell in {cell for expression in expressions for cell in expression.atoms(Indexed)}:
        label = cell.base.label
        if cell.free_symbols & bound:
            column = Symbol(f"{label}[]", **label.assumptions0)
            names[column] = label
            flat[cell] = IndexedBase(column)[cell.indices]
        else:
            symbol = Symbol(f"{label}[{','.join(map(str, cell.indices))}]", **label.assumptions0)
            names[symbol] = cell
            flat[cell] = symbol
    return names, flat


def _may_start(place: Expr, variable: Expr) -> bool:
    return bool(place.is_positive if variable.is_integer else place.is_nonnegative)


def _is_implied(condition: Any, solution: Mapping[Expr, Expr]) -> bool:
    """Whether a condition of a premise follows from the signs of the symbols once the solution is in."""
    if condition == true:
        return True
    if not isinstance(condition, Rel) or condition.rel_op not in (">", ">=", "<", "<="):
        return False
    margin = settle(condition.gts - condition.lts, solution)
    return bool(margin.is_positive if condition.rel_op in "<>" else margin.is_nonnegative)
