"""Algebra with what the body of a method says: derivatives through its formulas, and claims to be proved."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from sympy import Basic, Dummy, Expr, Float, Indexed, Rational, Symbol

from ...derivations.equation import Derivation, Equation
from ...derivations.grounds import says
from ...derivations.reductions import REDUCTIONS
from ..cells.units import unit_of
from ..column import Column, Formula, Given, SheetError
from ..named import name_of
from ..workbook import Claimed

if TYPE_CHECKING:
    from .body import MethodBody

_NO_ALGEBRA = "{what} is of rows in groups, of which no proof is known: claim it without"


def in_fractions(formula: Expr) -> Expr:
    """A formula with its decimal fractions as fractions: a proof takes no rounded number."""
    found: Expr = formula.xreplace(_fractions(formula))
    return found


def _fractions(*formulas: Expr) -> dict[Expr, Expr]:
    """The decimal fractions in formulas, as fractions."""
    return {each: Rational(repr(float(each))) for formula in formulas for each in formula.atoms(Float)}


# --- derivatives


def derivative(body: MethodBody, formula: Expr, by: Expr) -> Expr:
    """The derivative by a quantity, through the formulas of all that rests on it."""
    if not isinstance(by, Indexed | Symbol):
        raise SheetError(f"a derivative is taken by what has a name, not by {by}")
    name, found = name_of(by), formula

    def other() -> list[Expr]:
        return [cell for cell in _cells(body, found) if name_of(cell) != name]

    while resting := [cell for cell in other() if name in _reached(body, name_of(cell))]:
        for cell in resting:
            column = body.columns.get(name_of(cell))
            rule = None if column is None else column.rule
            if column is None or not isinstance(rule, Formula) or rule.expression.has(*REDUCTIONS):
                raise SheetError(f"{cell} rests on {by}, and not by a formula of one row: write it out")
            place = dict(zip(column.cell.args[1:], cell.args[1:], strict=True))
            found = found.xreplace({cell: in_fractions(rule.expression).xreplace(place)})
    if found.has(*REDUCTIONS):
        raise SheetError(f"{formula} is taken over rows: write its derivative by {by} out")
    below = _inputs(body, name)
    for beside in (cell for cell in other() if _inputs(body, name_of(cell)) & below):
        raise SheetError(f"{by} and {beside}, beside it, rest on the same: what stays as it is?")
    # The second of a pair is not the first.
    apart = {cell: Dummy(real=True) for cell in _cells(body, found) if name_of(cell) == name and cell != by}
    if apart and not found.has(by):
        raise SheetError(f"{formula} has no {by}: say first(...) or second(...) of a pair")
    slope: Expr = found.xreplace(apart).diff(by).xreplace({own: cell for cell, own in apart.items()})
    return slope


def _cells(body: MethodBody, formula: Basic) -> list[Expr]:
    """What a formula names, each cell once, in an order that is always the same."""
    return sorted({each.cell for each in body.named_in(formula)}, key=str)


def _reached(body: MethodBody, name: str) -> set[str]:
    """A name and all that it rests on, by whatever steps: those of a fit go round."""
    found, ahead = {name}, [name]
    while ahead:
        more = {name_of(each) for each in _below(body, ahead.pop())} - found
        found |= more
        ahead += sorted(more)
    return found


def _inputs(body: MethodBody, name: str) -> set[str]:
    """What a name rests on that nothing computes."""
    return {each for each in _reached(body, name) if not _below(body, each)}


def _below(body: MethodBody, name: str) -> list[Expr]:
    """The cells that the rule of a column names."""
    parts = body.columns[name].expressions if name in body.columns else ()
    return [each for part in parts for each in _cells(body, part) if name_of(each) != name]


# --- claims


def claimed(
    body: MethodBody,
    left: Expr,
    right: Expr,
    meaning: str,
    because: str,
    from_: Sequence[Any] | None,
    label: str,
) -> None:
    """Put a claim into the ledger, with what it is to be derived from."""
    if body.is_grouped(left, right):
        raise SheetError(_NO_ALGEBRA.format(what=f"'{meaning}'"))
    found = _premises(body, (left, right) if from_ is None else from_, meaning, everything=from_ is None)
    row = Symbol("i", integer=True, positive=True)
    members = tuple(in_fractions(side).subs(body.axis.index, row) for side in (left, right))
    conditions = tuple(dict.fromkeys(each for premise, _ in found for each in premise.conditions))
    equation = Equation(
        body.free_number(f"'{meaning}'", label),
        members,
        because or "it follows by algebra",
        title=meaning,
        conditions=conditions,
    )
    for premise, _ in found:
        if says(equation, premise):
            raise SheetError(f"'{meaning}' is what {premise.label} says of itself: there is nothing to prove")
    zero = Equation(equation.label, (left, left - right), "", title=meaning)
    rows = body.axis_of(left, right)
    unit_of(body.columns, Column(meaning, rows, Formula(zero)))  # as long as both have one unit
    body.claims.append(Claimed(equation.label, meaning, rows, left, right))
    for premise, unknown in found:
        if body.is_grouped(*premise.members):
            raise SheetError(_NO_ALGEBRA.format(what=f"{unknown}, on which '{meaning}' rests,"))
    premises, unknowns = zip(*found, strict=True) if found else ((), ())
    body.entries.append(Derivation.of(equation, premises, unknowns, "Put in what the quantities are."))


def _premises(
    body: MethodBody, formulas: Sequence[Any], meaning: str, everything: bool
) -> list[tuple[Equation, Expr]]:
    """What says of the quantities in formulas what they are, and what each is solved for."""
    found: dict[str, tuple[Equation, Expr]] = {}
    normal = {name: equation for fit in body.fits for name, equation in fit.normal.items()}
    left = list(formulas)
    while left:
        named = {name_of(cell) for cell in left.pop().atoms(Symbol, Indexed)} & body.columns.keys()
        for column in (body.columns[name] for name in sorted(named - found.keys())):
            if isinstance(column.rule, Given):
                continue
            if not isinstance(column.rule, Formula):
                raise SheetError(
                    f"{column.name} is sought, it has no formula to put in: say what '{meaning}' follows "
                    "from without it, from_=[...]",
                    column.name,
                )
            equation, cell = normal.get(column.name, column.rule.equation), column.cell
            if typed := _fractions(*equation.sides):
                equation = equation.at(typed)
            found[column.name] = equation, cell.base if isinstance(cell, Indexed) else cell
            left += equation.members if everything else []
    return list(found.values())
