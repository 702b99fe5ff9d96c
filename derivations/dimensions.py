"""Dimensions of expressions: which may be added, and what a product has.

A dimension maps base units to exponents, and an exponent may be an expression: the coefficient of a power
law F = C x^alpha has the unit N/m^alpha, whatever alpha turns out to be.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from sympy import (
    Abs,
    Add,
    Basic,
    Expr,
    Indexed,
    Integer,
    Integral,
    Max,
    Min,
    Mul,
    Number,
    NumberSymbol,
    Piecewise,
    Pow,
    Rational,
    Rel,
    Sum,
    Symbol,
    cancel,
    exp,
    expand,
    log,
    sign,
    sstr,
)
from sympy.core.function import AppliedUndef
from sympy.logic.boolalg import BooleanFunction

from .equation import Equation
from .reductions import Median
from .text import text
from .vocabulary import Vocabulary

__all__ = [
    "PURE",
    "Dimension",
    "DimensionError",
    "Dimensions",
    "dimension_of_unit",
    "mixed",
    "power",
    "product",
    "text_of",
]

Dimension = Mapping[str, Expr]
"""Exponents of the base units; one that is zero is left out."""

PURE: Dimension = {}
"""The dimension of a pure number."""

_UNITS: dict[str, dict[str, int]] = {
    "kg": {"kg": 1},
    "m": {"m": 1},
    "s": {"s": 1},
    "K": {"K": 1},
    "A": {"A": 1},
    "mol": {"mol": 1},
    "cd": {"cd": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "Hz": {"s": -1},
    "C": {"A": 1, "s": 1},
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1},
    "ohm": {"kg": 1, "m": 2, "s": -3, "A": -2},
    "S": {"kg": -1, "m": -2, "s": 3, "A": 2},
    "F": {"kg": -1, "m": -2, "s": 4, "A": 2},
    "Wb": {"kg": 1, "m": 2, "s": -2, "A": -1},
    "T": {"kg": 1, "s": -2, "A": -1},
    "H": {"kg": 1, "m": 2, "s": -2, "A": -2},
}

_WRITTEN = "write names, multiplied by * and divided by / without parentheses, as J/kg/K for J/(kg*K)"


class DimensionError(ValueError):
    """An expression adds, compares or raises what cannot be, or a unit cannot be read."""


def dimension_of_unit(unit: str, exponents: Mapping[str, Expr] | None = None) -> Dimension:
    """Read a unit such as ``kg/m^3``, ``m/s^2`` or ``N/m^alpha``.

    Parameters
    ----------
    unit : str
        Unit names of SI, multiplied by ``*`` and divided by ``/``, raised by ``^`` to a number, a fraction in
        parentheses or a name.
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
    # A name, and a power of it: a number, a fraction in parentheses or a symbol's name.
    factor = r"([^*/^()]+)(?:\^(\([^()]+\)|[^*/^()]+))?"
    if not re.fullmatch(rf"{factor}([*/]{factor})*", unit):
        raise DimensionError(f"{unit!r} is no unit: {_WRITTEN}")
    total = PURE
    for divided, named, raised in re.findall(rf"(^|[*/]){factor}", unit):
        name = named.strip()
        if name == "1":
            continue
        # `N m` would be read as one name.
        if name not in _UNITS and all(part in _UNITS for part in name.split()):
            raise DimensionError(f"{unit!r} leaves out a * or a / in {name!r}")
        if name not in _UNITS:
            raise DimensionError(f"unknown unit {name!r} in {unit!r}; known are {', '.join(_UNITS)}")
        exponent = _exponent(raised.strip("() ") or "1", unit, exponents or {})
        step = power({base: Integer(p) for base, p in _UNITS[name].items()}, exponent)
        total = product(total, step if divided != "/" else power(step, Integer(-1)))
    return total


def _exponent(raised: str, unit: str, names: Mapping[str, Expr]) -> Expr:
    if re.fullmatch(r"-?\d+(/\d+)?", raised):
        return Rational(raised)
    if raised not in names:
        raise DimensionError(f"unknown exponent {raised!r} in the unit {unit!r}")
    return names[raised]


def _tidy(exponent: Expr) -> Expr:
    exponent = expand(exponent)
    return exponent if exponent.is_polynomial() else cancel(exponent)


def product(a: Dimension, b: Dimension) -> Dimension:
    """The dimension of a product."""
    total = dict(a)
    for unit, exponent in b.items():
        summed = _tidy(total.get(unit, Integer(0)) + exponent)
        if summed == 0:
            total.pop(unit, None)
        else:
            total[unit] = summed
    return total


def power(a: Dimension, exponent: Expr) -> Dimension:
    """The dimension of a power."""
    return {unit: raised for unit, old in a.items() if (raised := _tidy(old * exponent)) != 0}


def text_of(dimension: Dimension) -> str:
    """Write a dimension for people, ``kg m^2 s^-2``."""

    def written(exponent: Expr) -> str:
        raised = sstr(exponent)
        return "" if raised == "1" else f"^{raised}" if re.fullmatch(r"-?\w+", raised) else f"^({raised})"

    return " ".join(unit + written(exponent) for unit, exponent in sorted(dimension.items())) or "1"


class Dimensions:
    """Finds dimensions of expressions in the symbols of a vocabulary.

    A subclass that knows other cells says so in `of_cell`, and how it complains in `fail`.

    Parameters
    ----------
    vocabulary : Vocabulary
    """

    def __init__(self, vocabulary: Vocabulary) -> None:
        self.vocabulary = vocabulary

    def of_cell(self, cell: Expr) -> Dimension:
        """The dimension of a symbol; what is not of the vocabulary is a pure number."""
        quantity = self.vocabulary.find(cell)
        if quantity is None:
            return PURE
        names = re.findall(r"\^([A-Za-z_]\w*)", quantity.unit)
        others = {name: self.vocabulary[name] for name in names if name in self.vocabulary}
        # N/m^alpha of row k has the alpha of row k in its exponent.
        if isinstance(cell, Indexed):
            return dimension_of_unit(quantity.unit, {name: q[cell.indices[0]] for name, q in others.items()})
        return dimension_of_unit(quantity.unit, {name: q.symbol for name, q in others.items()})

    def fail(self, expression: Basic, problem: str) -> Exception:
        """The complaint about an expression."""
        return DimensionError(f"{problem} in {sstr(expression)}")

    def of(self, expression: Any) -> Dimension:
        """The dimension of an expression, checked from the inside out."""
        match expression:
            case Number() | NumberSymbol():
                return PURE
            case Indexed() | Symbol():
                return self.of_cell(expression)
            case AppliedUndef():
                return self.of_cell(Symbol(expression.func.__name__))
            case Add():
                return self.same(list(expression.args), expression, "add")
            case Max() | Min():
                return self.same(list(expression.args), expression, "compare")
            case Mul():
                total = PURE
                for factor in expression.args:
                    total = product(total, self.of(factor))
                return total
            case exp() | log():
                return self.pure(expression.args[0], expression, "the argument of a function")
            case Pow():
                self.pure(expression.exp, expression, "an exponent")
                return power(self.of(expression.base), expression.exp)
            case Abs():
                return self.of(expression.args[0])
            case sign():
                self.of(expression.args[0])
                return PURE
            case Sum() | Median():
                return self.of(expression.function)
            case Integral():
                total = self.of(expression.function)
                for variable, *ends in expression.limits:
                    self.same([variable, *ends], expression, "compare")
                    total = product(total, self.of(variable))
                return total
            case Piecewise():
                for _, condition in expression.args:
                    self.relation(condition)
                return self.same([body for body, _ in expression.args], expression, "choose between")
            case _:
                for argument in expression.args:
                    self.pure(argument, expression, "the argument of a function")
                return PURE

    def same(self, parts: list[Any], expression: Basic, verb: str) -> Dimension:
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

    def pure(self, part: Any, expression: Basic, what: str) -> Dimension:
        """What may only be a pure number."""
        dimension = self.of(part)
        if dimension:
            raise self.fail(expression, f"{what} must be a pure number, not {text_of(dimension)},")
        return PURE

    def relation(self, condition: Any) -> None:
        """Both sides of every comparison must agree."""
        if isinstance(condition, Rel):
            self.same([condition.lhs, condition.rhs], condition, "compare")
        elif isinstance(condition, BooleanFunction):
            for part in condition.args:
                self.relation(part)


# --- equations of a ledger -------------------------------------------------------------------------------


class _Unsaid(Exception):
    """A symbol of which no unit is said."""


class _OfLedger(Dimensions):
    """Complains in the words of the ledger; of a symbol that it says nothing of, nothing is known."""

    def of_cell(self, cell: Expr) -> Dimension:
        if self.vocabulary.find(cell) is None and not cell.is_integer:
            raise _Unsaid
        return super().of_cell(cell)

    def fail(self, expression: Basic, problem: str) -> Exception:
        return DimensionError(f"{problem} in {text(expression, self.vocabulary)}")


def mixed(equation: Equation, vocabulary: Vocabulary) -> str:
    """Say what an equation mixes that cannot be equal, added or compared; empty where nothing was found.

    Parameters
    ----------
    equation : Equation
    vocabulary : Vocabulary
        The units of its symbols. An equation with a symbol that it lacks is not judged; whole numbers are
        pure.
    """
    dimensions = _OfLedger(vocabulary)
    try:
        found: dict[str, Expr] = {}
        for member in equation.members:
            if isinstance(member, Expr) and member != 0:
                found.setdefault(text_of(dimensions.of(member)), member)
            elif not isinstance(member, Expr):
                dimensions.relation(member)
        for condition in equation.conditions:
            dimensions.relation(condition)
    except _Unsaid:
        return ""
    except DimensionError as problem:
        return str(problem)
    told = [f"{text(member, vocabulary)} is in {unit}" for unit, member in found.items()]
    return ", ".join(told) if len(found) > 1 else ""
