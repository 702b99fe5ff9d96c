"""Dimensions of expressions: which may be added, and what a product has.

A dimension maps base units to exponents, and an exponent may be an expression: the coefficient of a power
law F = C x^alpha has the unit N/m^alpha, whatever alpha turns out to be.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.logic.boolalg import BooleanFunction

from .equation import Equation
from .reductions import OrderStatistic, taken_of
from .text import text
from .unit_text import UnitError, coherent, parse_open
from .vocabulary import Vocabulary

Dimension = Mapping[str, sp.Expr]
"""Exponents of the base units; one that is zero is left out."""

PURE: Dimension = {}
"""The dimension of a pure number."""


class DimensionError(ValueError):
    """An expression adds, compares or raises what cannot be, or a unit cannot be read."""


def dimension_of_unit(unit: str, exponents: Mapping[str, sp.Expr] | None = None) -> Dimension:
    """Read a unit such as ``kg/m^3``, ``m/s^2`` or ``N/m^alpha``.

    Parameters
    ----------
    unit : str
        Units of SI without prefix, in the grammar of :func:`~loopsheet.derivations.unit_text.parse_unit`; an
        exponent may be a name, too.
    exponents : mapping of str to Expr
        What the names in exponents stand for.

    Raises
    ------
    DimensionError
        Names the unit or the exponent that is not known.

    Examples
    --------
    >>> dimension_of_unit("N*s/m") == dimension_of_unit("kg/s")
    True
    """
    try:
        found = parse_open(unit)
    except UnitError as error:
        hint = f"; {error.suggestion}" if error.suggestion else ""
        kind = "unknown unit" if error.code == "LS421" else "no unit"
        raise DimensionError(f"{unit!r} cannot be read: {kind} {error.text!r}{hint}") from None
    if not found.is_si:
        raise DimensionError(f"{unit!r} is no unit of SI without prefix, such as {coherent(found)}")
    total: Dimension = {base: sp.Rational(power) for base, power in found.dimension}
    for base, name, times in found.open:
        if name not in (exponents or {}):
            raise DimensionError(f"unknown exponent {name!r} in the unit {unit!r}")
        total = product(total, power({base: sp.Rational(times)}, (exponents or {})[name]))
    return total


def _tidy(exponent: sp.Expr) -> sp.Expr:
    exponent = exponent.doit()  # an author's 3/2 + 1 may stand there as it is printed
    exponent = sp.expand(sp.nsimplify(exponent, rational=True) if exponent.has(sp.Float) else exponent)
    return exponent if exponent.is_polynomial() else sp.cancel(exponent)


def product(a: Dimension, b: Dimension) -> Dimension:
    """The dimension of a product."""
    total = dict(a)
    for unit, exponent in b.items():
        summed = _tidy(total.get(unit, sp.Integer(0)) + exponent)
        if summed == 0:
            total.pop(unit, None)
        else:
            total[unit] = summed
    return total


def power(a: Dimension, exponent: sp.Expr) -> Dimension:
    """The dimension of a power."""
    return {unit: raised for unit, old in a.items() if (raised := _tidy(old * exponent)) != 0}


def text_of(dimension: Dimension) -> str:
    """Write a dimension for people, ``kg m^2 s^-2``."""

    def written(exponent: sp.Expr) -> str:
        raised = sp.sstr(exponent)
        return "" if raised == "1" else f"^{raised}" if re.fullmatch(r"-?\w+", raised) else f"^({raised})"

    return " ".join(unit + written(exponent) for unit, exponent in sorted(dimension.items())) or "1"


class Dimensions:
    """Finds dimensions of expressions in the symbols of a vocabulary.

    A subclass that knows other cells says so in `of_cell`, and how it complains in `fail`.
    """

    def __init__(self, vocabulary: Vocabulary) -> None:
        self.vocabulary = vocabulary

    def of_cell(self, cell: sp.Expr) -> Dimension:
        """The dimension of a symbol; what is not of the vocabulary is a pure number."""
        quantity = self.vocabulary.find(cell)
        if quantity is None:
            return PURE
        names = re.findall(r"\^([A-Za-z_]\w*)", quantity.unit)
        others = {name: self.vocabulary[name] for name in names if name in self.vocabulary}
        # N/m^alpha of row k has the alpha of row k in its exponent.
        if isinstance(cell, sp.Indexed):
            return dimension_of_unit(quantity.unit, {name: q[cell.indices[0]] for name, q in others.items()})
        return dimension_of_unit(quantity.unit, {name: q.symbol for name, q in others.items()})

    def fail(self, expression: sp.Basic, problem: str) -> Exception:
        """The complaint about an expression."""
        return DimensionError(f"{problem} in {sp.sstr(expression)}")

    def of(self, expression: Any) -> Dimension:
        """The dimension of an expression, checked from the inside out."""
        match expression:
            case sp.Number() | sp.NumberSymbol():
                return PURE
            case sp.Indexed() | sp.Symbol():
                return self.of_cell(expression)
            case AppliedUndef():
                return self.of_cell(sp.Symbol(expression.func.__name__))
            case sp.Add():
                return self.same(list(expression.args), expression, "add")
            case sp.Max() | sp.Min():
                return self.same(list(expression.args), expression, "compare")
            case sp.Mul():
                total = PURE
                for factor in expression.args:
                    total = product(total, self.of(factor))
                return total
            case sp.exp() | sp.log():
                return self.pure(expression.args[0], expression, "the argument of a function")
            case sp.Pow():
                self.pure(expression.exp, expression, "an exponent")
                return power(self.of(expression.base), expression.exp)
            case sp.Abs():
                return self.of(expression.args[0])
            case sp.sign():
                self.of(expression.args[0])
                return PURE
            case sp.Sum() | OrderStatistic():
                return self.of(taken_of(expression))
            case sp.Integral():
                total = self.of(expression.function)
                for variable, *ends in expression.limits:
                    self.same([variable, *ends], expression, "compare")
                    total = product(total, self.of(variable))
                return total
            case sp.Piecewise():
                for _, condition in expression.args:
                    self.relation(condition)
                return self.same([body for body, _ in expression.args], expression, "choose between")
            case _:
                for argument in expression.args:
                    self.pure(argument, expression, "the argument of a function")
                return PURE

    def same(self, parts: list[Any], expression: sp.Basic, verb: str) -> Dimension:
        """All parts must agree; a zero agrees with everything."""
        found: Dimension | None = None
        for part in parts:
            if part == 0:
                continue
            dimension = self.of(part)
            if found is None:
                found = dimension
            elif dict(found) != dict(dimension):
                raise self.fail(expression, f"cannot {verb} {text_of(found)} and {text_of(dimension)}")
        return found or PURE

    def pure(self, part: Any, expression: sp.Basic, what: str) -> Dimension:
        """What may only be a pure number."""
        dimension = self.of(part)
        if dimension:
            raise self.fail(expression, f"{what} must be a pure number, not {text_of(dimension)},")
        return PURE

    def relation(self, condition: Any) -> None:
        """Both sides of every comparison must agree."""
        if isinstance(condition, sp.Rel):
            self.same([condition.lhs, condition.rhs], condition, "compare")
        elif isinstance(condition, BooleanFunction):
            for part in condition.args:
                self.relation(part)


# --- equations of a ledger -------------------------------------------------------------------------------


class _Unsaid(Exception):
    """A symbol of which no unit is said."""


class _OfLedger(Dimensions):
    """Complains in the words of the ledger; of a symbol that it says nothing of, nothing is known."""

    def of_cell(self, cell: sp.Expr) -> Dimension:
        if self.vocabulary.find(cell) is None and not cell.is_integer:
            raise _Unsaid
        return super().of_cell(cell)

    def fail(self, expression: sp.Basic, problem: str) -> Exception:
        return DimensionError(f"{problem} in {text(expression, self.vocabulary)}")


def mixed(equation: Equation, vocabulary: Vocabulary) -> str:
    """Say what an equation mixes that cannot be equal, added or compared; empty where nothing was found.

    `vocabulary`: the units of its symbols. An equation with a symbol that it lacks is not judged; whole
    numbers are pure.
    """
    dimensions = _OfLedger(vocabulary)
    try:
        found: dict[str, sp.Expr] = {}
        for member in equation.members:
            if isinstance(member, sp.Expr) and member != 0:
                found.setdefault(text_of(dimensions.of(member)), member)
            elif not isinstance(member, sp.Expr):
                dimensions.relation(member)
        for condition in equation.conditions:
            dimensions.relation(condition)
    except _Unsaid:
        return ""
    except DimensionError as problem:
        return str(problem)
    told = [f"{text(member, vocabulary)} is in {unit}" for unit, member in found.items()]
    return ", ".join(told) if len(found) > 1 else ""
