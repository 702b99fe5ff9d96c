"""Checks that every formula is dimensionally sound before any code is made of it.

A dimension maps base units to exponents, and an exponent may be an expression: the coefficient of a power
law F = C x^alpha has the unit N/m^alpha, whatever alpha turns out to be.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from sympy import (
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
    expand,
    sstr,
)
from sympy.functions.elementary.exponential import exp, log
from sympy.logic.boolalg import BooleanFunction

from .sheet import Column, Formula, Given, Root, Sheet, SheetError, name_of

__all__ = ["Dimension", "UnitError", "check", "dimension_of_unit"]

Dimension = Mapping[str, Expr]
"""Exponents of the base units; one that is zero is left out."""

_ONE: Dimension = {}
_DERIVED: dict[str, dict[str, int]] = {
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
}


class UnitError(SheetError):
    """A formula adds, compares or raises what cannot be."""


def dimension_of_unit(text: str, exponents: Mapping[str, Expr] | None = None) -> Dimension:
    """Read a unit such as ``kg/m^3``, ``m/s^2`` or ``N/m^alpha``.

    Parameters
    ----------
    text : str
        Unit names of SI, multiplied by ``*`` and divided by ``/``, raised by ``^`` to a number or a name.
    exponents : mapping of str to Expr
        What the names in exponents stand for.

    Examples
    --------
    >>> dimension_of_unit("N*s/m") == dimension_of_unit("kg/s")
    True
    """
    total: Dimension = _ONE
    for sign, factor in re.findall(r"(^|[*/])([^*/]+)", text.strip()):
        name, _, power = factor.partition("^")
        if name.strip() == "1":
            continue
        base = _DERIVED.get(name.strip())
        if base is None:
            raise UnitError(f"unknown unit {name.strip()!r} in {text!r}; known are {', '.join(_DERIVED)}")
        exponent = _exponent(power.strip() or "1", text, exponents or {})
        step = _power({unit: Integer(p) for unit, p in base.items()}, exponent if sign != "/" else -exponent)
        total = _product(total, step)
    return total


def _exponent(power: str, text: str, names: Mapping[str, Expr]) -> Expr:
    if re.fullmatch(r"-?\d+(/\d+)?", power):
        return Rational(power)
    if power not in names:
        raise UnitError(f"unknown exponent {power!r} in the unit {text!r}")
    return names[power]


def _product(a: Dimension, b: Dimension) -> Dimension:
    total = dict(a)
    for unit, power in b.items():
        summed = expand(total.get(unit, Integer(0)) + power)
        if summed == 0:
            total.pop(unit, None)
        else:
            total[unit] = summed
    return total


def _power(a: Dimension, exponent: Expr) -> Dimension:
    return {unit: power for unit, old in a.items() if (power := expand(old * exponent)) != 0}


def text_of(dimension: Dimension) -> str:
    """Write a dimension for people, ``kg^1 m^2 s^-2``."""
    return " ".join(f"{unit}^{sstr(power)}" for unit, power in sorted(dimension.items())) or "1"


class _Checker:
    """Finds the dimension of an expression; remembers which column it works for, for its messages."""

    def __init__(self, sheet: Sheet, column: Column) -> None:
        self.sheet, self.column = sheet, column

    def fail(self, expression: Basic, problem: str) -> UnitError:
        return UnitError(f"{self.column.name} {self.column.source}: {problem} in {sstr(expression)}")

    def of_cell(self, cell: Expr) -> Dimension:
        if isinstance(self.column.rule, Root) and cell == self.column.rule.unknown:
            return self.of_unknown()
        name = name_of(cell)
        if name not in self.sheet:
            return _ONE  # a running number or a size
        column = self.sheet[name]
        index = cell.indices[0] if isinstance(cell, Indexed) else None
        return dimension_of_unit(column.unit, exponents(self.sheet, column, index))

    def of_unknown(self) -> Dimension:
        """The unknown of a root is a pure number unless it is the cell's value itself."""
        rule = self.column.rule
        assert isinstance(rule, Root)
        own = dimension_of_unit(self.column.unit, exponents(self.sheet, self.column, None))
        return own if rule.value == rule.unknown else _ONE

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
        return found or _ONE

    def pure(self, part: Any, expression: Basic, what: str) -> Dimension:
        dimension = self.of(part)
        if dimension:
            raise self.fail(expression, f"{what} must be a pure number, not {text_of(dimension)},")
        return _ONE

    def of(self, expression: Any) -> Dimension:
        match expression:
            case Number() | NumberSymbol():
                return _ONE
            case Indexed() | Symbol():
                return self.of_cell(expression)
            case Add():
                return self.same(list(expression.args), expression, "add")
            case Max() | Min():
                return self.same(list(expression.args), expression, "compare")
            case Mul():
                total: Dimension = _ONE
                for factor in expression.args:
                    total = _product(total, self.of(factor))
                return total
            case exp() | log():
                return self.pure(expression.args[0], expression, "the argument of a function")
            case Pow():
                self.pure(expression.exp, expression, "an exponent")
                return _power(self.of(expression.base), expression.exp)
            case Sum() | Integral():
                return self.of(expression.function)
            case Piecewise():
                for _, condition in expression.args:
                    self.relation(condition)
                return self.same([body for body, _ in expression.args], expression, "choose between")
            case _:
                for argument in expression.args:
                    self.pure(argument, expression, "the argument of a function")
                return _ONE

    def relation(self, condition: Any) -> None:
        if isinstance(condition, Rel):
            self.same([condition.lhs, condition.rhs], condition, "compare")
        elif isinstance(condition, BooleanFunction):
            for part in condition.args:
                self.relation(part)


def exponents(sheet: Sheet, column: Column, index: Expr | None) -> dict[str, Expr]:
    """What names in the exponent of a column's unit stand for: cells of the same row."""
    found: dict[str, Expr] = {}
    for name in re.findall(r"\^([A-Za-z_]\w*)", column.unit):
        if name not in sheet:
            raise UnitError(f"{column.name}: its unit {column.unit!r} names {name!r}, which is no column")
        other = sheet[name]
        row = index if index is not None else (None if column.axis is None else column.axis.index)
        found[name] = other.symbol if other.axis is None else other[row]
    return found


def check(sheet: Sheet) -> None:
    """Check every formula, root and condition of a sheet.

    Raises
    ------
    UnitError
        Names the column, its equation, the expression and both dimensions.
    """
    for column in sheet.columns:
        checker = _Checker(sheet, column)
        own = dimension_of_unit(column.unit, exponents(sheet, column, None))
        rule = column.rule
        if isinstance(rule, Formula):
            _expect(checker, rule.expression, own)
        elif isinstance(rule, Root):
            checker.of(rule.expression)
            _expect(checker, rule.value, own)
            for place in (rule.low, rule.high, rule.start, *rule.turning):
                if place != 0 and place.is_finite is not False:
                    _expect(checker, place, checker.of_unknown())
            for sign in (rule.sign_low, rule.sign_high):
                if sign is not None:
                    checker.of(sign)
        elif not isinstance(rule, Given):
            raise SheetError(f"{column.name}: unknown kind of rule {rule!r}")
        for condition, _ in column.requires:
            checker.relation(condition)


def _expect(checker: _Checker, expression: Expr, own: Dimension) -> None:
    if expression == 0:
        return
    found = checker.of(expression)
    if dict(found) != dict(own):
        raise checker.fail(
            expression,
            f"the unit {checker.column.unit} is {text_of(own)}, but the formula gives {text_of(found)}:",
        )
