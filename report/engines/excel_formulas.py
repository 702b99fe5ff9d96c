"""Formulas of cells: what a cell refers to, which error it inherits, and how sums leave rows out.

A formula is printed once a column, with the cells that differ from row to row left open, and filled in row
by row: printing is slow, and a report may have a hundred thousand points.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import groupby
from operator import itemgetter
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray
from sympy import And, Expr, Float, Rational, Rel, Symbol

from ..cells.grid import FilledDown, Grouped, Place, as_issued, checked
from ..cells.layout import Layout, evenly
from ..cells.values import CODES, Status
from ..named import within
from ..plan.nodes import Leaf, Map, Plan, RootNode
from ..plan.order import Word
from ..quantity import Bounds
from ..sheet import Axis, Column, Given, Iterated, MemberAxis, Reference, RepeatAxis, Sheet
from .excel import ExcelPrinter, IfError
from .excel_loops import pass_name
from .excel_roots import Auxiliary, Unrolled
from .excel_values import READY, STAYS

_ON_RANGES = (*(f"{word.upper()}(IF(" for word in get_args(Word)), "MINVERSE(", "SMALL(")
"""What works on ranges in formulas: a spreadsheet that is not told so takes the cell of its own row."""

_CODE = {status: f'"{code}"' for status, code in CODES.items()}
_UNSETTLED = '"#STEPS!"'
"""Only a workbook has this code: its steps are columns and come to an end, other engines go on."""
_NOT_AVAILABLE = "NA()"
_SMALLEST = "(2)^(0-1022)"
"""The least positive number with all its digits; spreadsheets hold none below."""


@dataclass(frozen=True)
class Places:
    """Where everything stands."""

    columns: Mapping[str, Place]
    """Of columns, auxiliaries (``alpha.u_1``) and carried cells, by name; of a given column, those of its
    checked cells (:func:`~loopsheet.report.cells.grid.checked`), which all formulas name."""
    typed: Mapping[str, Place]
    """Of given columns, where they are typed."""
    indices: Mapping[str, tuple[Place, ...]]
    """By axis name; the numbers of an axis' rows, one place a part."""


def carried_name(cells: Leaf) -> str:
    """What the cells are called that repeat another axis' column for the rows of this one.

    >>> carried_name(Leaf("cells", "C", Axis("points", Symbol("q"), Symbol("n")), "p"))
    'C[p] of points'
    """
    return f"{cells.written} of {cells.axis and cells.axis.name}"


def carried(sheet: Sheet, column: Column) -> dict[str, tuple[Leaf, Axis]]:
    """Cells of another axis that are repeated on the rows of this one.

    No range reaches those that a column sums, and no formula is filled down that names others from row to
    row. Rows that repeat a row name the same cells one after the other, and need none of their own.
    """
    named = [(reference, reference.over or column.axis) for reference in sheet.named(column)]
    return {
        carried_name(leaf): (leaf, axis)
        for reference, axis in named
        if axis and (reference.over or not isinstance(axis, RepeatAxis))
        if (leaf := _leaf(reference, axis)).index is not None
    }


def _leaf(reference: Reference, axis: Axis | None) -> Leaf:
    """What is named on the rows of an axis."""
    name, index = reference.name, reference.index
    if axis is None or index is None:
        return Leaf("cells", name)
    return Leaf("cells", name, axis, None if index == axis.index_name else index)


class Formulas:
    """Prints the formulas of a sheet whose cells have their places.

    Parameters
    ----------
    plan : Plan
        Of the sheet.
    layouts : mapping of axis name to Layout
    passes : int
        How many each loop has.
    """

    def __init__(
        self, sheet: Sheet, plan: Plan, layouts: Mapping[str, Layout], places: Places, passes: int
    ) -> None:
        self.sheet, self.plan, self.layouts, self.places, self.passes = sheet, plan, layouts, places, passes
        self.maps = {node.column.name: node for node in plan.every if isinstance(node, Map)}

    def checked(self, column: Column, guard: str, groups: Sequence[Grouped] = ()) -> tuple[FilledDown, ...]:
        """The formulas of what is given, if it is allowed and its row has its words, or else its code."""
        writing = Writing(self, column, column.name)
        cell = writing.fill(self.places.typed[column.name])
        same = [
            Grouped.same(writing.fill(own), writing.fill(group, np.array(rows)))
            for own, group, rows in groups
        ]
        return writing.rows(f"IF({_all([*same, guard.format(cell)])},{cell},{_CODE[Status.INPUT]})")

    def column(self, column: Column, unrolled: Unrolled | None = None) -> tuple[FilledDown, ...]:
        """The formulas of a computed column, one a row."""
        writing = Writing(self, column, column.name, unrolled.plan if unrolled else None)
        if isinstance(column.rule, Iterated):
            return writing.rows(writing.iterated())
        return writing.rows(writing.root(unrolled) if unrolled else writing.formula(self.maps[column.name]))

    def drawn(self, column: Column) -> tuple[FilledDown, ...]:
        """The formulas of a column for a chart: its values, or what charts leave out."""
        writing = Writing(self, column, column.name)
        return writing.rows(writing.drawn(self.maps[column.name]))

    def passed(self, column: Column, name: str, named: Callable[[str], str]) -> tuple[FilledDown, ...]:
        """The formulas of a column of the first pass of a loop, as another pass names what it names."""
        writing = Writing(self, column, name, named=named)
        return writing.rows(writing.formula(self.maps[column.name]))

    def check(self, unrolled: Unrolled) -> tuple[FilledDown, ...]:
        """The formulas of the cell that says whether a root can be sought."""
        writing = Writing(self, unrolled.column, unrolled.check.name)
        return writing.rows(writing.inherited(f'"{READY}"'))

    def issued(self, name: str, column: Column, given: Sequence[str]) -> tuple[FilledDown, ...]:
        """The formulas of the cell that says whether given columns are as issued (1) or not (0)."""
        writing = Writing(self, column, name)
        pairs = [(self.places.columns[checked(one)], self.places.columns[as_issued(one)]) for one in given]
        return writing.rows(writing.same(pairs))

    def auxiliary(self, unrolled: Unrolled, cell: Auxiliary) -> tuple[FilledDown, ...]:
        """The formulas of a cell on the way to a root."""
        writing = Writing(self, unrolled.column, cell.name, unrolled.plan)
        return writing.rows(writing.auxiliary(unrolled, cell))

    def carried(self, cells: Leaf) -> tuple[FilledDown, ...]:
        """The formulas that repeat another axis' cells on this one."""
        assert cells.axis is not None
        stand_in = Column(carried_name(cells), cells.axis, Given())
        writing = Writing(self, stand_in, stand_in.name)
        which = self.layouts[cells.axis.name].rows[cells.index or ""]
        return writing.rows(writing.fill(self.places.columns[cells.name], which))

    def kept(self, column: Column) -> dict[str, str]:
        """For each axis that a column sums over, the formula that counts the rows with values."""
        writing = Writing(self, column, column.name)
        # Of groups there is a number for each, which stands in no single cell.
        axes = (axis for axis in self.sheet.summed_axes(column) if not isinstance(axis, MemberAxis))
        return {axis.name: f"={writing.number_kept(axis.name)}" for axis in axes}


def works_on_ranges(formula: str) -> bool:
    """Whether a formula has to be entered as an array formula."""
    return any(each in formula for each in _ON_RANGES)


def guard(bounds: Bounds) -> str:
    """The formula, without its equals sign, that says whether the cell ``{0}`` holds a number within bounds.

    A truth value is a number to some readers and larger than any to others, and an error passes through all
    that is asked of it. Two numbers that fifteen digits do not tell apart are equal to every spreadsheet.

    >>> guard(Bounds(low=0, low_open=True))
    'IF(ISNUMBER({0}),AND(NOT(ISLOGICAL({0})),{0}>0),FALSE())'
    """
    allowed = within(Symbol("{0}", real=True), bounds)
    allowed = allowed.xreplace({number: Float(float(number)) for number in allowed.atoms(Rational)})
    tests = [str(ExcelPrinter(str).doprint(test)) for test in And.make_args(allowed) if isinstance(test, Rel)]
    return f"IF(ISNUMBER({{0}}),{_all(['NOT(ISLOGICAL({0}))', *sorted(tests)])},FALSE())"


class Writing:
    """The formulas of one quantity, being written: cells that change with the row are left open."""

    def __init__(
        self,
        formulas: Formulas,
        column: Column,
        name: str,
        plan: Plan | None = None,
        named: Callable[[str], str] = str,
    ) -> None:
        self.formulas, self.plan, self.called = formulas, plan or formulas.plan, named
        self.sheet, self.layouts, self.places = formulas.sheet, formulas.layouts, formulas.places
        self.column, self.axis = column, column.axis
        self.place = self.places.columns[name]
        self.here = self.place.worksheet
        self.open: list[tuple[Place, Any]] = []
        """Cells that change with the row: their column's place, and the row for each row of the axis."""

    def rows(self, template: str) -> tuple[FilledDown, ...]:
        """Fill the template in for every row, as few times as filling it down gives all rows."""
        size = self.place.rows
        if not self.open:
            return (FilledDown(size, f"={template}"),)
        # Of a cloud that is thinned, not every row of the axis has a cell.
        every = evenly(self.layouts[self.axis.name].size, size) if self.axis else np.arange(size)
        rows = np.array([every if which is None else which[every] for _, which in self.open])
        steps = np.diff(rows)
        # Excel fills no formula down by itself in which a row of another worksheet moves.
        near = np.array([place.worksheet == self.here for place, _ in self.open])
        filled = []
        for first, last in _stretches(steps, near):
            moves = (
                steps[:, first] if last > first else [size > 1 and which is None for _, which in self.open]
            )
            cells = [
                (place.moving if move else place.cell)(int(row), self.here)
                for (place, _), row, move in zip(self.open, rows[:, first], moves, strict=True)
            ]
            filled.append(FilledDown(last - first + 1, f"={template.format(*cells)}"))
        return tuple(filled)

    # --- references

    @cached_property
    def named(self) -> list[tuple[Leaf, Axis | None]]:
        """What the column's rule names, and the axis it is summed over."""
        return [(_leaf(r, r.over or self.axis), r.over) for r in self.sheet.named(self.column)]

    def fill(self, place: Place, which: Any = None) -> str:
        """Leave a cell open: that of the same row, or the rows that are named."""
        for number, (known, rows) in enumerate(self.open):
            if known == place and rows is which:
                return f"{{{number}}}"
        self.open.append((place, which))
        return f"{{{len(self.open) - 1}}}"

    def place_of(self, leaf: Leaf) -> Place:
        """Where cells and running numbers stand."""
        if leaf.kind == "ordinal" and leaf.axis and leaf.index:
            # Among the parts that name a row, its own number is the last.
            steps = [step.name for step in leaf.axis.ordinals]
            return self.places.indices[leaf.axis.name][-1 - steps.index(leaf.index)]
        return self.repeated(leaf) or self.places.columns[self.called(leaf.name)]

    def repeated(self, leaf: Leaf) -> Place | None:
        """Where cells of another axis are repeated on this one."""
        if leaf.index is None:
            return None
        return self.places.columns.get(carried_name(replace(leaf, name=self.called(leaf.name))))

    def address(self, leaf: Leaf, rows: bool = False) -> str:
        """The address of what a row names, or of all rows that a sum runs over."""
        place = self.place_of(leaf)
        if leaf.axis is None:
            return place.cell(0, self.here)
        if rows:
            return self.stretch(place, leaf.axis.name)
        named = None if self.repeated(leaf) else leaf.index
        return self.fill(place, self.layouts[leaf.axis.name].rows.get(named or ""))

    def symbol(self, symbol: Symbol, rows: bool = False) -> str:
        """What a symbol stands for, in SI: on a row, or on all rows that a sum runs over."""
        leaf = self.plan.named[symbol.name]
        if leaf.kind == "total":
            total = self.plan.totals[symbol.name]
            return self.summing(total.column.name).total(total.terms, total.over.name, total.word)
        if leaf.kind in ("kept", "size") and leaf.axis:
            axis = leaf.axis.name
            return (
                self.summing(leaf.name).number_kept(axis)
                if leaf.kind == "kept"
                else f"ROWS({self.numbers(axis)})"
            )
        return self.place_of(leaf).to_si(self.address(leaf, rows))

    def summing(self, name: str) -> Writing:
        """What writes the formulas of the column whose sums leave rows out, for a cell that stands here."""
        if name == self.column.name:
            return self
        found = Writing(self.formulas, self.formulas.sheet[name], name, named=self.called)
        found.here = self.here
        return found

    def numbers(self, axis: str) -> str:
        """The range of numbers that name an axis' rows."""
        return self.stretch(self.places.indices[axis][0], axis)

    def stretch(self, place: Place, axis: str) -> str:
        """The range of all rows of an axis that a sum runs over; of the rows of a group, with open ends."""
        layout = self.layouts[axis]
        if layout.starts is None:
            return place.range(self.here)
        # Behind its first cell, a range does not name its worksheet again.
        last = self.fill(replace(place, worksheet=self.here), layout.lasts)
        return f"{self.fill(place, layout.starts)}:{last}"

    # --- sums

    def number_kept(self, axis: str) -> str:
        """How many rows of an axis have values."""
        return f"SUM(IF({self.mask(axis)},1,0))"

    def mask(self, axis: str) -> str:
        """Not zero for each row of an axis whose cells all have values."""
        summed = [self.address(leaf, rows=True) for leaf, over in self.named if over and over.name == axis]
        return "*".join(f"ISNUMBER({each})" for each in summed or [self.numbers(axis)])

    def total(self, terms: Expr, axis: str, word: Word) -> str:
        """What is taken over the rows that have values."""
        text = self.printer_of_rows.doprint(terms)
        # Of a text, no reader takes account.
        otherwise = "0" if word == "sum" else '""'
        return f"{word.upper()}(IF({self.mask(axis)},{text},{otherwise}))"

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
        runs: list[tuple[str, list[tuple[str, str]]]] = []  # of an axis: what must be a number, and the code
        for leaf, over in self.named:
            given, axis = isinstance(self.sheet[leaf.name].rule, Given), "" if over is None else over.name
            if over is None:
                address = self.address(leaf)
            else:
                starts, place = self.layouts[axis].starts, self.place_of(leaf)
                address = place.cell(0, self.here) if starts is None else self.fill(place, starts)
            if not runs or runs[-1][0] != axis:
                runs.append((axis, []))
            runs[-1][1].append((f"ISNUMBER({address})", _CODE[Status.INPUT] if given else address))
        last = {axis: n for n, (axis, _) in enumerate(runs)}
        for n, (axis, tests) in reversed(list(enumerate(runs))):
            kept = self.number_kept(axis) if axis else ""
            # The first row tells why: if no row has values, some cell of it is in error, here or further on.
            if axis and n == last[axis]:
                otherwise = f"IF({kept}>0,{otherwise},{_unless(tests[:-1], tests[-1][1])})"
            else:
                held = [(f"OR({kept}>0,{test})" if axis else test, code) for test, code in tests]
                otherwise = _unless(held, otherwise)
        return otherwise

    # --- whole formulas

    @cached_property
    def printer(self) -> ExcelPrinter:
        """What prints with these addresses."""
        return ExcelPrinter(self.symbol, self.total)

    @cached_property
    def printer_of_rows(self) -> ExcelPrinter:
        """The same with those of all rows."""
        return ExcelPrinter(partial(self.symbol, rows=True), self.total, rows=True)

    def number(self, expression: Expr) -> str:
        """A value in the cells' unit."""
        if self.place.from_si(""):
            return self.place.from_si(self.printer.factor(expression))
        return str(self.printer.doprint(expression))

    def where_it_holds(self, node: Map | RootNode, text: str, otherwise: str) -> str:
        """A value where the column's conditions hold, and where it is none, what stands for that."""
        conditions = [str(self.printer.doprint(condition)) for condition in node.requires]
        return f"IFERROR({f'IF({_all(conditions)},{text},{otherwise})' if conditions else text},{otherwise})"

    def value(self, expression: Expr, sign: Any, none: str) -> str:
        """A value that a double holds, or the code of what stands for it; `none` where it is an error."""
        domain, beyond = _CODE[Status.DOMAIN], _CODE[Status.OVERFLOW]
        text = self.number(expression)
        if self.column.positive:
            # A unit of the cells could lift what is too small, so SI is asked.
            si = self.printer.doprint(expression)
            above = f"{si}>0" if sign in (True, False) else f"OR({si}>0,{self.printer.doprint(sign)})"
            small = beyond if sign == True else f"IF({above},{beyond},{domain})"  # noqa: E712 - sympy's true
            text = f"IF({si}>={_SMALLEST},{text},{small})"
        return f"IFERROR({text},{none})"

    def failure(self, node: Map) -> str:
        """What a formula is that is an error: a value that no double holds, or none."""
        domain, beyond = _CODE[Status.DOMAIN], _CODE[Status.OVERFLOW]
        if node.defined == True:  # noqa: E712 - sympy's true
            return beyond
        return f"IFERROR(IF({self.printer.doprint(node.defined)},{beyond},{domain}),{domain})"

    def formula(self, node: Map) -> str:
        """A cell with a formula: an error of its precedents, its own, or its value."""
        value = self.value(node.value, node.positive, self.failure(node))
        if node.requires:
            value = self.where_it_holds(node, value, _CODE[Status.DOMAIN])
        return self.inherited(value)

    def root(self, unrolled: Unrolled) -> str:
        """A cell with a root: an error of its precedents, its own, or its value."""
        node, domain = unrolled.node, _CODE[Status.DOMAIN]
        check, number = self.address(unrolled.check), self.address(unrolled.number)
        none, two = _CODE[Status.NOROOT], _CODE[Status.TWOROOTS]
        known, settled = (self.printer.doprint(test) for test in (unrolled.known, unrolled.settled))
        value = self.value(unrolled.value, node.positive, _CODE[Status.OVERFLOW])
        found = f"IF({settled},{value},{_UNSETTLED})"
        found = f"IF({number}=1,IF({known},{found},{domain}),IF({number}=0,{none},{two}))"
        if unrolled.issued is not None:
            undecided = _CODE[Status.UNDECIDED]
            found = f"IF({number}<0,{undecided},{found})"
            found = f"IF(ISNUMBER({number}),{found},{domain})"
            found = f"IF({self.address(unrolled.issued)}=1,{found},{undecided})"
        else:
            found = f"IF(ISNUMBER({number}),{found},{domain})"
        found = self.where_it_holds(node, found, domain)
        return f'IF({check}="{READY}",{found},{check})'

    def iterated(self) -> str:
        """A cell that the last pass has left where it was: an error of its start, or its value."""
        done = self.formulas.passes
        start, before, last = (
            self.address(Leaf("cells", pass_name(self.column.name, number), self.axis))
            for number in (0, done - 1, done)
        )
        gone = none = _CODE[Status.NOROOT]
        lost = f"OR({last}={_CODE[Status.DOMAIN]},{last}={_CODE[Status.OVERFLOW]})"
        found = f"IF(ABS({last}-{before})*{STAYS}<=ABS({last}),{last},{_UNSETTLED})"
        failed = f"IF({lost},{{}},{last})"
        for each in self.sheet.loop_of[self.column.name].iterated:
            if each.axis is not None:
                # A row that is lost on the way takes the loop with it: without it another one would settle.
                every = (Leaf("cells", pass_name(each.name, number), each.axis) for number in (0, done))
                begun, ended = (
                    "+".join(
                        f"COUNTIF({self.address(leaf, rows=True)},{_CODE[code]})"
                        for code in (Status.DOMAIN, Status.OVERFLOW)
                    )
                    for leaf in every
                )
                found = f"IF({begun}={ended},{found},{none})"
                if self.axis is None:
                    # Of a sum without any row left, the first row's code says nothing of that.
                    failed = f"IF({begun}={ended},{failed},{{}})"
            elif self.axis is not None:
                # All rows rest on a single number, and on its error.
                other = self.address(Leaf("cells", pass_name(each.name, 0)))
                gone = f"IF(ISNUMBER({other}),{gone},{other})"
        found = f"IF(ISNUMBER({last}),{found},{failed.replace('{}', gone)})"
        return f"IF(ISNUMBER({start}),{found},{start})"

    def drawn(self, node: Map) -> str:
        """A cell for a chart: its value, or what charts leave out."""
        # A sum leaves out the rows without a value.
        tests = [f"ISNUMBER({self.address(leaf)})" for leaf, over in self.named if over is None]
        value = self.where_it_holds(node, self.number(node.value), _NOT_AVAILABLE)
        return f"IF({_all(tests)},{value},{_NOT_AVAILABLE})"

    def auxiliary(self, unrolled: Unrolled, cell: Auxiliary) -> str:
        """A cell on the way to a root; empty where there is none to seek."""
        check, number = self.address(unrolled.check), self.address(unrolled.number)
        wanted = f"{number}=1" if cell.alone else f'{check}="{READY}"'
        value = cell.part.value
        printed = self.printer.added(value) if cell.residual else self.printer.doprint(value)
        if not isinstance(value, IfError):
            printed = f'IFERROR({printed},"")'
        return f'IF({wanted},{printed},"")'


def _stretches(steps: NDArray[np.intp], near: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """The first and the last row of stretches in which each address stays or moves with its row.

    `steps` (array of int, shape (addresses, rows - 1)): how far each goes from a row to the next. `near`
    (array of bool, shape (addresses,)): whether it may move.
    """
    stays = (steps == 0) | (near[:, None] & (steps == 1))
    breaks = ~stays.all(axis=0)
    changes = np.append([False], (steps[:, 1:] != steps[:, :-1]).any(axis=0))[: breaks.size]
    first = 0
    for row in np.flatnonzero(breaks | changes).tolist():
        if breaks[row] or row > first:
            yield first, row
            first = row + 1
    yield first, breaks.size


def _all(tests: list[str]) -> str:
    """That all of these hold."""
    return tests[0] if len(tests) == 1 else f"AND({','.join(tests)})" if tests else "TRUE()"


def _unless(tests: Sequence[tuple[str, str]], otherwise: str) -> str:
    """The code of the first test that fails, or what stands where none does."""
    for code, some in reversed([(code, list(some)) for code, some in groupby(tests, key=itemgetter(1))]):
        otherwise = f"IF({_all([test for test, _ in some])},{otherwise},{code})"
    return otherwise
