"""Checks that every formula is dimensionally sound before any code is made of it.

A dimension maps base units to exponents, and an exponent may be an expression: the coefficient of a power
law F = C x^alpha has the unit N/m^alpha, whatever alpha turns out to be.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace

from sympy import Add, Basic, Expr, Indexed, Mul, Pow, S, Sum, Symbol, sstr

from ...derivations import dimensions
from ...derivations.dimensions import PURE, Dimension, DimensionError, Dimensions, text_of
from ...derivations.reductions import OrderStatistic
from ...derivations.unit_text import well_named
from ...derivations.vocabulary import NO_WORDS
from ..column import written_in
from ..named import name_of
from ..quantity import Bounds
from ..sheet import Column, Formula, Given, Iterated, Root, Sheet, SheetError


class DimensionMismatch(SheetError):
    """A formula adds, compares or raises what cannot be."""


def dimension_of_unit(text: str, exponents: Mapping[str, Expr] | None = None) -> Dimension:
    """As :func:`~.dimensions.dimension_of_unit` of the derivations, whose error is one of the sheet here."""
    try:
        return dimensions.dimension_of_unit(text, exponents)
    except DimensionError as problem:
        raise DimensionMismatch(str(problem)) from None


class _Checker(Dimensions):
    """Finds the dimension of an expression; remembers which column it works for, for its messages."""

    def __init__(self, sheet: Sheet | Mapping[str, Column], column: Column) -> None:
        super().__init__(NO_WORDS)  # the columns say what their cells are
        self.sheet, self.column = sheet, column

    def fail(self, expression: Basic, problem: str) -> DimensionMismatch:
        """The complaint names the column and its equation."""
        said = f"{self.column.name} {self.column.source}: {problem} in {sstr(expression)}"
        return DimensionMismatch(said, self.column.name)

    def of_cell(self, cell: Expr) -> Dimension:
        """The dimension of a cell of the sheet."""
        if isinstance(self.column.rule, Root) and cell == self.column.rule.unknown:
            return self.of_unknown()
        name = name_of(cell)
        if name not in self.sheet:
            return PURE  # a running number or a size
        column = self.sheet[name]
        index = cell.indices[0] if isinstance(cell, Indexed) else None
        return dimension_of_unit(column.unit, exponents(self.sheet, column, index))

    def of_unknown(self) -> Dimension:
        """The unknown of a root is a pure number unless it is the cell's value itself."""
        rule = self.column.rule
        assert isinstance(rule, Root)
        own = dimension_of_unit(self.column.unit, exponents(self.sheet, self.column, None))
        return own if rule.value == rule.unknown else PURE


def exponents(sheet: Sheet | Mapping[str, Column], column: Column, index: Expr | None) -> dict[str, Expr]:
    """What names in the exponent of a column's unit stand for: cells of the same row."""
    found: dict[str, Expr] = {}
    for name in re.findall(r"\^([A-Za-z_]\w*)", column.unit):
        if name not in sheet:
            raise DimensionMismatch(
                f"its unit {column.unit!r} names {name!r}, which is no column", column.unit
            )
        other = sheet[name]
        row = index if index is not None else (None if column.axis is None else column.axis.index)
        found[name] = other.symbol if other.axis is None else other[row]
    return found


def check(sheet: Sheet) -> None:
    """Check every formula, root and condition of a sheet.

    Raises
    ------
    DimensionMismatch
        Names the column, its equation, the expression and both dimensions.
    """
    for column in sheet.columns:
        check_column(sheet, column)


def check_column(sheet: Sheet | Mapping[str, Column], column: Column) -> None:
    """Check one of them, of a sheet or among the columns that there are."""
    checker = _Checker(sheet, column)
    try:
        own = dimension_of_unit(column.unit, exponents(sheet, column, None))
    except DimensionMismatch as problem:
        raise DimensionMismatch(f"{column.name}: {problem}", column.unit, column.name) from None
    rule = column.rule
    if isinstance(rule, Formula):
        _expect(checker, rule.expression, own)
    elif isinstance(rule, Iterated):
        _expect(checker, rule.step, own)
        if not rule.start.is_number:  # a number is one in SI
            _expect(checker, rule.start, own)
    elif isinstance(rule, Root):
        checker.of(rule.expression)
        _expect(checker, rule.value, own)
        for place in (rule.low, rule.high, rule.start, *rule.turning):
            if not place.is_number:  # a number is in SI
                _expect(checker, place, checker.of_unknown())
        for end in (rule.sign_low, rule.sign_high):
            if end is not None:
                checker.of(end)
    elif not isinstance(rule, Given):
        raise SheetError(f"{column.name}: unknown kind of rule {rule!r}", column.name)
    for condition, _ in column.requires:
        checker.relation(condition)
    for limit in column.limits:
        if not isinstance(limit.inside, Bounds):
            checker.relation(limit.inside)


def unit_of(sheet: Sheet | Mapping[str, Column], column: Column) -> str:
    """The SI unit that a column's formula gives, whatever it declares.

    Parameters
    ----------
    sheet : Sheet or mapping of str to Column
        The columns that the formula names.

    Raises
    ------
    DimensionMismatch
        There is none, or one that hangs on a quantity.
    """
    checker = _Checker(sheet, column)
    assert isinstance(column.rule, Formula)
    found = checker.of(column.rule.expression)
    if any(not exponent.is_Rational for exponent in found.values()):
        raise checker.fail(
            column.rule.expression, f"its unit is {text_of(found)}; write it with names, N/m^alpha:"
        )
    return text_of(found).replace(" ", "*")


def is_alike(columns: Mapping[str, Column], column: Column, expression: Expr) -> bool:
    """Whether an expression is of the unit of a column, as its standard uncertainty is."""
    checker = _Checker(columns, column)
    return dict(checker.of(expression)) == dict(checker.of(column.cell))


def named_unit_of(columns: Mapping[str, Column], column: Column) -> str:
    """The same in names that stand in the units of the columns, as N/m where there are newtons."""
    units = (each.display or each.unit for each in columns.values())
    return well_named(unit_of(columns, column), [unit for unit in units if not unit.startswith("like ")])


def as_its_parts(columns: Mapping[str, Column], column: Column, aside: Sequence[str] = ()) -> Column:
    """A column with the unit that its formula gives, and shown as what of that kind it is computed from.

    Where that is shown in several units it is shown in SI; so is a pure number, as a sine is no angle, unless
    it is a sum, a mean or a difference of such columns: of per cents.

    `aside`: columns that no line declares, which are parts of a formula as it was written.
    """
    column = replace(column, unit=named_unit_of({**columns, column.name: column}, column))
    own = dict(dimension_of_unit(column.unit))
    if column.display:
        return column
    assert isinstance(column.rule, Formula)
    parts = [(columns[name].cell, columns[name].rule) for name in aside]
    formula = column.rule.expression.xreplace(
        {cell: rule.expression for cell, rule in parts if isinstance(rule, Formula)}
    )
    named, alike = _named(formula), list[Column]()
    root = isinstance(formula, Pow) and formula.exp.is_Rational and not formula.exp.is_Integer
    while named and not alike:
        alike = [columns[name] for name in columns if name in named and _kind(columns[name]) == own]
        # A root of squares is shown as what is squared, in other columns, too.
        rules = (columns[name].rule for name in named if own and root and name in columns)
        named = set().union(*(_named(rule.expression) for rule in rules if isinstance(rule, Formula)))
    if not own and not _adds_up(formula, {each.name for each in alike}):
        return column
    shown = {written_in(each, columns) for each in alike}
    return replace(column, display=f"like {alike[0].name}") if len(shown) == 1 else column


def _named(formula: Expr) -> set[str]:
    return {str(symbol) for symbol in formula.free_symbols}


def _adds_up(formula: Expr, names: AbstractSet[str], degree: Expr = S.One) -> bool:
    """Whether a formula adds up, takes away or divides by how many there are what is of such columns.

    `degree`: 2 of their squares, of which a root is such a formula again.
    """
    match formula:
        case Symbol() | Indexed():
            return degree == 1 and name_of(formula) in names
        case Pow():
            return _adds_up(formula.base, names, degree / formula.exp)
        case Add():
            return all(_adds_up(term, names, degree) for term in formula.args)
        case Sum() | OrderStatistic():
            return _adds_up(formula.function, names, degree)
        case Mul():
            rest = [factor for factor in formula.args if not _adds_up(factor, names, degree)]
            signs = all(factor == -1 for factor in rest if not factor.free_symbols)
            sizes = all(symbol.is_integer for factor in rest for symbol in factor.free_symbols)
            return len(rest) == len(formula.args) - 1 and signs and sizes
    return False


def _kind(column: Column) -> dict[str, object] | None:
    """What a column is of; nothing where that hangs on a quantity."""
    try:
        return dict(dimension_of_unit(column.unit))
    except DimensionMismatch:
        return None


def _expect(checker: _Checker, expression: Expr, own: Dimension) -> None:
    if expression == 0:
        return
    found = checker.of(expression)
    if dict(found) != dict(own):
        column, si = checker.column, text_of(own)
        said = column.unit if column.display.startswith("like ") else column.display or column.unit
        meant = said if said == si else f"{said}, in SI {si}"
        raise checker.fail(expression, f"the unit is {meant}, but the formula gives {text_of(found)}:")
