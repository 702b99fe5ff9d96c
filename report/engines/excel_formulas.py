"""Formulas of cells: what a cell refers to, which error it inherits, and how sums leave rows out.

A formula is printed once a column, with the cells that differ from row to row left open, and filled in row
by row: printing is slow, and a report may have a hundred thousand points.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from sympy import And, Expr, Float, Indexed, Rational, Rel, Sum, Symbol

from ...derivations.reductions import Median
from ..grid import Place, as_issued, checked, factors
from ..layout import Layout, rows_of
from ..plan.domain import defined, is_positive, positive, typed
from ..quantity import Bounds
from ..sheet import Axis, Column, Formula, Given, Reference, Root, Sheet, name_of, within
from ..values import CODES, Status
from .excel import IfError, Printer
from .excel_roots import READY, Auxiliary, Unrolled

__all__ = ["Formulas", "Places", "carried", "carried_name", "guard"]

_CODE = {status: f'"{code}"' for status, code in CODES.items()}
_UNSETTLED = '"#STEPS!"'
"""Only a workbook has this code: its steps are columns and come to an end, other engines go on."""
_NOT_AVAILABLE = "NA()"
_SMALLEST = "(2)^(0-1022)"
"""The least positive number with all its digits; spreadsheets hold none below."""


@dataclass(frozen=True)
class Places:
    """Where everything stands.

    Parameters
    ----------
    columns : mapping of str to Place
        Of columns, auxiliaries (``alpha.u_1``) and carried cells, by name; of a given column, those of its
        checked cells (:func:`~loopsheet.report.grid.checked`), which all formulas name.
    typed : mapping of str to Place
        Of given columns, where they are typed.
    indices : mapping of axis name to tuple of Place
        The numbers of an axis' rows, one place a part.
    """

    columns: Mapping[str, Place]
    typed: Mapping[str, Place]
    indices: Mapping[str, tuple[Place, ...]]


def carried_name(cell: Indexed, axis: Axis) -> str:
    """What the cells are called that repeat another axis' column for the rows of this one.

    >>> from sympy import IndexedBase, Symbol
    >>> carried_name(IndexedBase("C")[Symbol("p")], Axis("points", Symbol("q"), Symbol("n")))
    'C[p] of points'
    """
    return f"{cell} of {axis.name}"


def carried(sheet: Sheet, column: Column) -> dict[str, tuple[Indexed, Axis]]:
    """Cells that a column sums although they stand on another axis: no range reaches them."""
    return {
        carried_name(reference.cell, reference.over): (reference.cell, reference.over)
        for reference in sheet.named(column)
        if reference.over is not None and reference.cell.indices[0] != reference.over.index
    }


class Formulas:
    """Prints the formulas of a sheet whose cells have their places.

    Parameters
    ----------
    sheet : Sheet
    layouts : mapping of axis name to Layout
    places : Places
    """

    def __init__(self, sheet: Sheet, layouts: Mapping[str, Layout], places: Places) -> None:
        self.sheet, self.layouts, self.places = sheet, layouts, places

    def checked(self, column: Column, guard: str) -> tuple[str, ...]:
        """The formulas of what is given, if it is allowed, or else its code."""
        writing = _Writing(self, column, column.name)
        cell = writing.fill(self.places.typed[column.name])
        return writing.rows(f"IF({guard.format(cell)},{cell},{_CODE[Status.INPUT]})")

    def column(self, column: Column, unrolled: Unrolled | None = None) -> tuple[str, ...]:
        """The formulas of a computed column, one a row."""
        writing = _Writing(self, column, column.name)
        return writing.rows(writing.computed(unrolled))

    def drawn(self, column: Column) -> tuple[str, ...]:
        """The formulas of a column for a chart: its values, or what charts leave out."""
        writing = _Writing(self, column, column.name)
        return writing.rows(writing.drawn())

    def check(self, unrolled: Unrolled) -> tuple[str, ...]:
        """The formulas of the cell that says whether a root can be sought."""
        writing = _Writing(self, unrolled.column, unrolled.check.name)
        return writing.rows(writing.inherited(f'"{READY}"'))

    def issued(self, name: str, column: Column, given: Sequence[str]) -> tuple[str, ...]:
        """The formulas of the cell that says whether given columns are as issued (1) or not (0)."""
        writing = _Writing(self, column, name)
        pairs = [(self.places.columns[checked(one)], self.places.columns[as_issued(one)]) for one in given]
        return writing.rows(writing.same(pairs))

    def auxiliary(self, unrolled: Unrolled, cell: Auxiliary) -> tuple[str, ...]:
        """The formulas of a cell on the way to a root."""
        writing = _Writing(self, unrolled.column, cell.name)
        return writing.rows(writing.auxiliary(unrolled, cell))

    def carried(self, cell: Indexed, axis: Axis) -> tuple[str, ...]:
        """The formulas that repeat another axis' cells on this one."""
        stand_in = Column(carried_name(cell, axis), axis, Given())
        writing = _Writing(self, stand_in, stand_in.name)
        return writing.rows(writing.own(cell))

    def kept(self, column: Column) -> dict[str, str]:
        """For each axis that a column sums over, the formula that counts the rows with values."""
        writing = _Writing(self, column, column.name)
        return {axis.name: f"={writing.number_kept(axis)}" for axis in self.sheet.summed_axes(column)}


def guard(bounds: Bounds) -> str:
    """The formula, without its equals sign, that says whether the cell ``{0}`` holds a number within bounds.

    A truth value is a number to some readers and larger than any to others, and an error passes through all
    that is asked of it. Two numbers that fifteen digits do not tell apart are equal to every spreadsheet.

    >>> guard(Bounds(low=0, low_open=True))
    'IF(ISNUMBER({0}),AND(NOT(ISLOGICAL({0})),{0}>0),FALSE())'
    """
    allowed = within(Symbol("{0}", real=True), bounds)
    allowed = allowed.xreplace({number: Float(float(number)) for number in allowed.atoms(Rational)})
    tests = [str(Printer(str).doprint(test)) for test in And.make_args(allowed) if isinstance(test, Rel)]
    return f"IF(ISNUMBER({{0}}),{_all(['NOT(ISLOGICAL({0}))', *sorted(tests)])},FALSE())"


class _Writing:
    """The formulas of one quantity, being written: cells that change with the row are left open."""

    def __init__(self, formulas: Formulas, column: Column, name: str) -> None:
        self.sheet, self.layouts, self.places = formulas.sheet, formulas.layouts, formulas.places
        self.column, self.axis = column, column.axis
        self.place = self.places.columns[name]
        self.here = self.place.worksheet
        self.open: list[tuple[Place, Any]] = []
        """Cells that change with the row: their column's place, and the row for each row of the axis."""

    def rows(self, template: str) -> tuple[str, ...]:
        """Fill the template in for every row."""
        every = range(self.place.rows)
        cells = [
            place.cells(every if which is None else which.tolist(), self.here) for place, which in self.open
        ]
        if not cells:
            return (f"={template}",) * self.place.rows
        return tuple(f"={template.format(*row)}" for row in zip(*cells, strict=True))

    # --- references

    def fill(self, place: Place, which: Any = None) -> str:
        """Leave a cell open: that of the same row, or the rows that are named."""
        if self.axis is None:
            return place.cell(0, self.here)
        for number, (known, rows) in enumerate(self.open):
            if known == place and rows is which:
                return f"{{{number}}}"
        self.open.append((place, which))
        return f"{{{len(self.open) - 1}}}"

    def own(self, cell: Expr) -> str:
        """The address of a cell that a row names: ``x_p[i]``, ``beta``, ``s``, ``alpha.u_1``."""
        if isinstance(cell, Indexed):
            return self.fill(self.places.columns[name_of(cell)], rows_of(cell, self.axis, self.layouts))
        if cell.name in self.sheet:
            return self.places.columns[cell.name].cell(0, self.here)
        if cell.name in self.places.columns:
            return self.fill(self.places.columns[cell.name])
        assert self.axis is not None
        return self.fill(self.ordinal(cell, self.axis))

    def ordinal(self, symbol: Symbol, axis: Axis) -> Place:
        """Where a running number stands: among the parts that name a row, its own number is the last."""
        return self.places.indices[axis.name][-1 - axis.ordinals.index(symbol)]

    def ranged(self, cell: Expr, axis: Axis) -> str:
        """The address that a sum over an axis gives to a cell: a range, unless it is a scalar."""
        if isinstance(cell, Indexed):
            name = name_of(cell) if cell.indices[0] == axis.index else carried_name(cell, axis)
            return self.places.columns[name].range(self.here)
        if cell in axis.ordinals:
            return self.ordinal(cell, axis).range(self.here)
        return self.own(cell)

    def leaf(self, cell: Expr, axis: Axis | None = None) -> str:
        """A cell in SI: that of a row, or all that a sum over an axis runs over."""
        if cell in self.sheet.sizes:
            return self.size(self.sheet.sizes[cell])
        address = self.own(cell) if axis is None else self.ranged(cell, axis)
        place = self.places.columns.get(name_of(cell))
        to_si = "" if place is None else factors(place.scale)[0]
        return f"({address}{to_si})" if to_si else address

    def size(self, axis: Axis) -> str:
        """How many rows: of those that are summed over, only the kept ones count."""
        if self.summed(axis):
            return self.number_kept(axis)
        return f"ROWS({self.places.indices[axis.name][0].range(self.here)})"

    # --- sums

    def summed(self, axis: Axis) -> list[Reference]:
        """The cells that a column sums over an axis."""
        return [reference for reference in self.sheet.named(self.column) if reference.over == axis]

    def number_kept(self, axis: Axis) -> str:
        """How many rows of an axis have values."""
        return f"SUM(IF({self.mask(axis)},1,0))"

    def mask(self, axis: Axis) -> str:
        """Not zero for each row of an axis whose cells all have values."""
        tests = [f"ISNUMBER({self.ranged(reference.cell, axis)})" for reference in self.summed(axis)]
        return "*".join(tests) or f"ISNUMBER({self.places.indices[axis.name][0].range(self.here)})"

    def total(self, total: Sum | Median) -> str:
        """A sum or a median over the rows that have values."""
        axis = self.sheet.indices[total.limits[0][0]]
        terms = Printer(lambda cell: self.leaf(cell, axis), self.total, rows=True).doprint(total.function)
        if isinstance(total, Median):
            return f'MEDIAN(IF({self.mask(axis)},{terms},""))'  # of a text, no reader takes account
        return f"SUM(IF({self.mask(axis)},{terms},0))"

    def same(self, pairs: Sequence[tuple[Place, Place]]) -> str:
        """1 where the cells of two places are the same, row by row, for each pair of them."""
        here = self.here
        ranges = [
            (a.range(here), b.range(here)) if a.rows > 1 else (a.cell(0, here), b.cell(0, here))
            for a, b in pairs
        ]
        tests = [f"SUM(IF({a}={b},0,1))=0" if ":" in a else f"{a}={b}" for a, b in ranges] or ["TRUE()"]
        return f"IFERROR(IF({_all(tests)},1,0),0)"

    # --- errors

    def inherited(self, otherwise: str) -> str:
        """The first error among the precedents, or what stands where there is none."""
        groups: list[tuple[list[str], str]] = []  # what must hold, and the code if it does not
        for reference in self.sheet.named(self.column):
            cell, axis = reference.cell, reference.over
            given = isinstance(self.sheet[name_of(cell)].rule, Given)
            if axis is None:
                address = self.own(cell)
                holds = f"ISNUMBER({address})"
            else:
                name = name_of(cell) if cell.indices[0] == axis.index else carried_name(cell, axis)
                # Its first row tells why: if no row has values, some cell of it is in error.
                address = self.places.columns[name].cell(0, self.here)
                holds = f"OR({self.number_kept(axis)}>0,ISNUMBER({address}))"
            code = _CODE[Status.INPUT] if given else address
            if groups and groups[-1][1] == code:
                groups[-1][0].append(holds)
            else:
                groups.append(([holds], code))
        for tests, code in reversed(groups):
            otherwise = f"IF({_all(tests)},{otherwise},{code})"
        return otherwise

    # --- whole formulas

    @cached_property
    def printer(self) -> Printer:
        return Printer(self.leaf, self.total)

    def number(self, expression: Expr) -> str:
        """A value in the cells' unit."""
        from_si = factors(self.place.scale)[1]
        return (
            f"{self.printer.factor(expression)}{from_si}"
            if from_si
            else str(self.printer.doprint(expression))
        )

    def where_it_holds(self, text: str, otherwise: str) -> str:
        """A value where the column's conditions hold, and where it is none, what stands for that."""
        conditions = [str(self.printer.doprint(condition)) for condition, _ in self.column.requires]
        return f"IFERROR({f'IF({_all(conditions)},{text},{otherwise})' if conditions else text},{otherwise})"

    def value(self, expression: Expr, none: str) -> str:
        """A value that a double holds, or the code of what stands for it; `none` where it is an error."""
        domain, beyond = _CODE[Status.DOMAIN], _CODE[Status.OVERFLOW]
        text = self.number(expression)
        if self.column.positive:
            # A unit of the cells could lift what is too small, so SI is asked.
            si, formula = self.printer.doprint(expression), typed(self.sheet, expression)
            # What is made of a root is one of several values that are sought: no signs are asked of it.
            sign = is_positive(formula) if isinstance(self.column.rule, Root) else positive(formula)
            above = f"{si}>0" if sign in (True, False) else f"OR({si}>0,{self.printer.doprint(sign)})"
            small = beyond if sign == True else f"IF({above},{beyond},{domain})"  # noqa: E712 - sympy's true
            text = f"IF({si}>={_SMALLEST},{text},{small})"
        return f"IFERROR({text},{none})"

    def failure(self, expression: Expr) -> str:
        """What a formula is that is an error: a value that no double holds, or none."""
        domain, beyond = _CODE[Status.DOMAIN], _CODE[Status.OVERFLOW]
        where = defined(typed(self.sheet, expression))
        if where == True:  # noqa: E712 - sympy's true
            return beyond
        return f"IFERROR(IF({self.printer.doprint(where)},{beyond},{domain}),{domain})"

    def computed(self, unrolled: Unrolled | None) -> str:
        """A computed cell: an error of its precedents, its own, or its value."""
        rule, domain = self.column.rule, _CODE[Status.DOMAIN]
        if isinstance(rule, Formula):
            value = self.value(rule.expression, self.failure(rule.expression))
            return self.inherited(self.where_it_holds(value, domain) if self.column.requires else value)
        assert isinstance(rule, Root)
        assert unrolled is not None
        check, number = self.own(unrolled.check), self.own(unrolled.number)
        none, two = _CODE[Status.NOROOT], _CODE[Status.TWOROOTS]
        known, settled = (self.printer.doprint(test) for test in (unrolled.known, unrolled.settled))
        found = f"IF({settled},{self.value(unrolled.value, _CODE[Status.OVERFLOW])},{_UNSETTLED})"
        found = f"IF({number}=1,IF({known},{found},{domain}),IF({number}=0,{none},{two}))"
        if unrolled.issued is not None:
            undecided = _CODE[Status.UNDECIDED]
            found = f"IF({number}<0,{undecided},{found})"
            found = f"IF({self.own(unrolled.issued)}=1,IF(ISNUMBER({number}),{found},{domain}),{undecided})"
        else:
            found = f"IF(ISNUMBER({number}),{found},{domain})"
        found = self.where_it_holds(found, domain)
        return f'IF({check}="{READY}",{found},{check})'

    def drawn(self) -> str:
        """A cell for a chart: its value, or what charts leave out."""
        rule = self.column.rule
        assert isinstance(rule, Formula)
        tests = [f"ISNUMBER({self.own(reference.cell)})" for reference in self.sheet.named(self.column)]
        value = self.where_it_holds(self.number(rule.expression), _NOT_AVAILABLE)
        return f"IF({_all(tests)},{value},{_NOT_AVAILABLE})"

    def auxiliary(self, unrolled: Unrolled, cell: Auxiliary) -> str:
        """A cell on the way to a root; empty where there is none to seek."""
        wanted = f"{self.own(unrolled.number)}=1" if cell.alone else f'{self.own(unrolled.check)}="{READY}"'
        printed = (
            self.printer.added(cell.expression) if cell.residual else self.printer.doprint(cell.expression)
        )
        if not isinstance(cell.expression, IfError):
            printed = f'IFERROR({printed},"")'
        return f'IF({wanted},{printed},"")'


def _all(tests: list[str]) -> str:
    """That all of these hold."""
    return tests[0] if len(tests) == 1 else f"AND({','.join(tests)})" if tests else "TRUE()"
