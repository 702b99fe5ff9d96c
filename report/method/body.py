"""The body of a method while it is declared: what its lines say, and the columns that they become."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from sympy import Add, Expr, Indexed, Integer, Max, Min, Sum, Symbol, false, sqrt, sympify, true

from ...derivations.equation import Derivation, Equation, Kind, Ledger
from ...derivations.reductions import REDUCTIONS, Greatest, Least, Member, OrderStatistic
from ...derivations.unit_text import of_differences
from ..axis import Axis, CountedAxis, GroupAxis, MemberAxis, PairAxis, RepeatAxis
from ..cells.units import as_its_parts
from ..column import Column, Formula, Given, Reference, Root, SheetError, shown_in
from ..inputs.keys import fixed
from ..messages.errors import listing
from ..named import member, name_of, references, summed_over
from ..quantity import Bounds, behind
from ..workbook import Claimed, Curve, FigureSpec, Measured, Parameter, TableSpec
from .fitted import DeclaredFit, told_apart
from .lines import (
    ComputedLine,
    Declaration,
    FitLine,
    InputLine,
    PointsLine,
    TakenLine,
    UnknownLine,
    checked_label,
    exact,
    in_si,
    let_in,
    none_of,
    refuse_zero,
    size_of,
    spaced,
    stated_unit,
    unit_in_si,
    with_unit,
)
from .places import Optionals, Standing
from .same_rows import SameRows
from .temperatures import is_difference

_EXTREMES = {"max": (Max, Greatest), "min": (Min, Least)}
"""By their names in a body: of several formulas, and over the rows of one."""


def _numbers(*names: str) -> Iterator[Symbol]:
    return (Symbol(name, integer=True, positive=True) for name in names)


class MethodBody(dict[str, Any]):
    """The namespace of a method while it is declared: every name that is assigned becomes a cell."""

    def __init__(self, rows: str, index: str, size: str, ledger: Ledger | None = None) -> None:
        super().__init__()
        self.ledger = ledger
        self.places = Standing([{}])  # what its symbols stand for
        self.optional = Optionals()
        self.axis = Axis(rows, *_numbers(index, size))
        self.row_axes = [self.axis]  # and the rows of further ones
        self.axes = [self.axis]  # and these, the pairs of its rows, and groups of them
        self.groups: list[GroupAxis] = []
        self.columns: dict[str, Column] = {}
        self.inputs: list[Measured | Parameter] = []
        self.entries: list[Equation | Derivation] = []
        self.examples: dict[str, str] = {}
        self.figures: list[FigureSpec] = []
        self.drawn: list[Column] = []  # what figures alone ask for
        self.drawn_given: dict[str, int] = {}
        self.tables: list[TableSpec] = []
        self.announced: dict[str, UnknownLine] = {}
        self.bounds: dict[str, Bounds] = {}  # of parameters of fits, in SI
        self.constants: list[str] = []
        self.margins: dict[str, str] = {}  # what has to be 0 or more, and the unit that it is shown in
        self.unnamed: list[Declaration | FitLine] = []
        self.aside: list[str] = []
        self.of_fits: dict[str, bool] = {}  # and whether it is a parameter
        self.curves: list[Curve] = []
        self.fits: list[DeclaredFit] = []
        self.claims: list[Claimed] = []
        self.own = map("(L{})".format, itertools.count(1))

    def __missing__(self, name: str) -> Any:
        """In a body the sum, the greatest and the least are those of formulas, not of Python's numbers."""
        if name == "sum":
            return self.total
        if name in _EXTREMES:
            return partial(self._extreme, *_EXTREMES[name])
        raise KeyError(name)

    def _extreme(
        self, of_several: type[Expr], over_rows: type[OrderStatistic], *formulas: Any, of: Any = None
    ) -> Expr:
        """Of several formulas or of a list, of what is in it; of one formula, over all rows or pairs."""
        if len(formulas) != 1:
            if of is not None:
                raise SheetError(
                    f"{over_rows.word}() of several formulas is of each row: it has no of={of!s}"
                )
            return of_several(*map(exact, formulas))
        one = formulas[0]
        return of_several(*map(exact, one)) if isinstance(one, Iterable) else self.ordered(over_rows, one, of)

    def ordered(self, taken: type[OrderStatistic], formula: Any, of: Any = None) -> Expr:
        """What is taken over all rows, or all pairs, or the rows of each group, by their order."""
        cell = exact(formula)
        terms = cell if of is None else self._of_a_group(cell, of)
        over = self.axis_of(cell)
        if over is None:
            raise SheetError(f"{taken.word}() is taken over rows, and {cell} is the same for all of them")
        if not isinstance(cell, Indexed):
            raise SheetError(f"{taken.word}() is of a column, not of {cell}: name that first, off = let(...)")
        if of in self.groups and over is of:
            raise SheetError(
                f"{cell} is one number of each {of.row}: {taken.word}() of={of} has no rows to choose from"
            )
        return taken(terms, (over.index, 1, over.size))

    def total(self, formula: Any, *more: Any, of: Any = None) -> Expr:
        """The sum over all rows, or over those of each group; of a list, of what is in it."""
        if of is not None and not more:
            return self._of_groups(formula, of)
        if more:
            raise SheetError("sum(...) is of one formula, over the rows, or of a list, sum([a, b])")
        if isinstance(formula, Iterable):
            return Add(*map(exact, formula))
        formula = self._of_one_row(exact(formula))
        over = self.axis_of(formula) or self.axis
        if over not in self.row_axes and not isinstance(formula, Indexed):
            formula = self._of_rows(formula, over)
        return Sum(formula, (over.index, 1, over.size))

    def mean(self, formula: Any, of: Any = None) -> Expr:
        """The sum by the number of the rows that it runs over."""
        return self.total(formula, of=of) / self._summed(formula, of)

    def stdev(self, formula: Any, of: Any = None) -> Expr:
        """The root of the squares of what is off from the mean, by one less than the number of the rows."""
        cell = exact(formula)
        if self.axis_of(cell) is None:
            raise SheetError(f"stdev() is taken over rows, and {cell} is the same for all of them")
        squares = self.total((cell - self.mean(cell, of)) ** 2, of=of)
        return sqrt(squares / (self._summed(cell, of) - 1))

    def _summed(self, formula: Any, of: Any) -> Expr:
        """Of how many rows the sum of a formula is."""
        return (self.axis_of(formula) or self.axis).size if of is None else self._of_groups(1, of)

    def number(self, formula: Any, of: Any = None) -> Expr:
        """How many rows there are, where it stands; of a formula, in how many rows it has a value."""
        over = self.axis_of(formula)
        every, by = (over or self.axis).size, ""
        if of in self.row_axes and over in (None, of):
            every = of.size
        elif of is not None:
            every, over, by = self._of_groups(1, of), over and self.axis, f"_by_{of.row}"
        if over is None:
            return every
        is_cell = isinstance(formula, Indexed) and formula.indices == (over.index,)
        cell = formula if is_cell else self._of_rows(formula, over)
        name = f"count_of_{cell.base.name}{by}"
        if name not in self.aside:
            column = self._aside(name, f"{over.name} with a value", every)
            self.columns[name] = replace(column, alongside=(self.columns[cell.base.name],))
        return self.columns[name].cell

    def further(self, name: str, index: str, size: str) -> Axis:
        """The rows of a further table."""
        if len({index, size}) < 2 or not all(each.isidentifier() for each in (name, index, size)):
            raise SheetError(f"rows('{name}') needs names: letters, digits and _ make a name", name)
        if name in fixed("measurements"):
            said = "is a key of [measurements] in report.toml: call the rows otherwise"
            raise SheetError(f"{name} {said}", name)
        axis = Axis(name, *_numbers(index, size))
        if axis.row in [one.row for one in self.axes] or name in [one.name for one in self.axes]:
            said = "rows='readings' behind (Method says what those of the class are"
            raise SheetError(f"{name} are rows already: {said}", name)
        self.row_axes.append(axis)
        self.axes.append(axis)
        self._refuse_name_of_rows()
        return axis

    def grouped(self, by: str, name: str, index: str, size: str, example: str) -> GroupAxis:
        """The groups of the rows that have one word in a column."""
        index = index or (f"g_{by}" if self.groups else "g")
        size = size or (f"n_{name}" if self.groups else "groups")
        if again := {index, size} & {each for one in self.axes for each in (one.index_name, one.size_name)}:
            said = "counts other rows already: say index='...' and size='...' in groups()"
            raise SheetError(f"{listing(sorted(again))} {said}", by)
        if len({index, size}) < 2 or not all(each.isidentifier() for each in (by, name, index, size)):
            raise SheetError(f"groups('{by}') needs names: letters, digits and _ make a name", by)
        if by in (self.axis.row, self.axis.name) or name in [axis.name for axis in self.axes]:
            said = "rows='readings' behind (Method says what the table's are"
            raise SheetError(f"{by} or {name} are rows already: {said}", by)
        number, many = _numbers(index, size)
        row, own = _numbers(f"{self.axis.index_name}_of_{by}", f"{self.axis.size_name}_of_{by}")
        members = MemberAxis(f"{self.axis.name}_by_{by}", row, own, of=self.axis, group=number, by=by)
        self.groups.append(GroupAxis(name, number, many, members))
        self.axes.append(self.groups[-1])
        self.examples |= {by: example} if example else {}
        self._refuse_name_of_rows()
        return self.groups[-1]

    def _of_groups(self, formula: Any, of: Any) -> Sum:
        """The sum over the rows of each group."""
        return Sum(self._of_a_group(formula, of), (self.axis.index, 1, self.axis.size))

    def _of_a_group(self, formula: Any, of: Any) -> Expr:
        """A formula of a row where that belongs to a group."""
        if of in self.row_axes:
            said = "are the rows of a table: what names them is taken over them without a word"
            raise SheetError(f"of={of.name} {said}")
        if of not in self.groups:
            raise SheetError(none_of(of, "groups"))
        formula = self._without_groups(exact(formula))
        rows = self._rows_of(formula)
        if not set(rows) <= {self.axis, *self.groups}:
            raise SheetError(
                f"{formula} names {listing([axis.name for axis in rows])}, not the rows of one {of.row}"
            )
        return formula * member(of.members)

    def _of_one_row(self, formula: Any) -> Any:
        """A formula, in which what is taken over the rows of each group is a column if it is of one row."""
        return self._without_groups(formula) if self.axis in self._rows_of(formula) else formula

    def _without_groups(self, formula: Any, unknown: Symbol | None = None) -> Any:
        """A formula with columns for what is taken in it over the rows of each group without the unknown."""
        if not formula.has(Member):
            return formula
        if unknown is not None and formula.has(unknown):
            if isinstance(formula, REDUCTIONS):
                return formula  # which is refused
            parts = formula.as_independent(unknown, as_Add=False) if formula.is_Mul else formula.args
            return formula.func(*(self._without_groups(part, unknown) for part in parts))
        over = self.axis_of(formula)
        if over in self.groups:
            number, taken = formula.as_coeff_Mul()
            return number * self._of_rows(taken, over)
        return formula.func(*map(self._without_groups, formula.args))

    def _of_rows(self, formula: Any, over: Axis) -> Indexed:
        """A formula for rows, or pairs or groups of them, as a column of its own."""
        for column in (self.columns[each] for each in self.aside):
            if isinstance(column.rule, Formula) and column.rule.equation.members[-1] == formula:
                return column.cell
        own = f"of_{over.name}_{sum(column.axis == over for column in self.columns.values()) + 1}"
        found: Indexed = self._aside(own, f"term of each {over.row}", formula).cell
        return found

    def _aside(self, name: str, meaning: str, formula: Any) -> Column:
        """A column that no line declares."""
        if name in self.columns:
            raise SheetError(f"{name} is declared twice: it is the {meaning}, too", name)
        said = ComputedLine(meaning, "", {"positive": False}, (exact(formula),), next(self.own))
        self.columns[name] = column = self._computed(name, said)
        self.aside.append(name)
        return column

    def axis_of(self, *formulas: Any) -> Axis | None:
        """The rows that formulas have a value for each of; None for a single number.

        What names a row and what there is of groups has a value for each row: of its group.
        """
        found = self._rows_of(*formulas)
        beneath = {parent for axis in found if axis.repeats for parent in axis.parents}
        found = [axis for axis in found if axis not in beneath]  # a point may name what its curve is of
        if self.axis in found:
            found = [axis for axis in found if axis not in self.groups]
        if len(tables := [axis for axis in found if axis in self.row_axes]) > 1:
            first, second = (axis.name for axis in tables[:2])
            raise SheetError(
                f"one formula names {first} and {second}, which are rows of two tables: take a mean, "
                f"a sum or a fit over the {first} first, or over the {second}"
            )
        if len(found) > 1 and not self.groups:
            raise SheetError(
                "one formula names a row and a pair of rows: say first(...) or second(...) of which"
            )
        if len(found) > 1:
            told = listing([axis.name for axis in found])
            raise SheetError(
                f"one formula names {told}: take a mean or sum over the rows of each group, of=..., or say "
                "first(...) or second(...) of a pair"
            )
        return found[0] if found else None

    def named_in(self, *formulas: Any) -> Iterator[Reference]:
        """What formulas name, with the rows that they take it from."""
        sums = summed_over([*self.axes, *(axis.members for axis in self.groups)])
        return (cell for formula in formulas for cell in references(formula, sums))

    def is_grouped(self, *formulas: Expr) -> bool:
        """Whether formulas are of the rows of a group, or of the group of a row: algebra knows neither."""
        words = {axis.index_name for axis in self.groups}
        within = any(cell.over == self.axis and cell.index in words for cell in self.named_in(*formulas))
        both = {self.axis, *self.groups}.intersection(self._rows_of(*formulas))
        return within or len(both) > 1 or any(formula.has(Member) for formula in formulas)

    def _rows_of(self, *formulas: Any) -> list[Axis]:
        """All rows that formulas name."""
        every = [sympify(formula) for formula in formulas]
        cells = self.named_in(*every)
        named = {cell.index or cell.name for cell in cells if cell.over is None}
        named |= {str(told.args[1]) for formula in every for told in formula.atoms(Member)}
        beneath = {axis: {name for of in axis.parents for name in of.named} for axis in self.axes}
        own = {axis: {*axis.named, *map(str, axis.ordinals)} - beneath[axis] for axis in self.axes}
        return [axis for axis in self.axes if not named.isdisjoint(own[axis])]

    def shown_like(self, unit: str) -> str:
        """How a quantity of a ledger is shown: like what is measured in its unit, if that is one column."""
        same = [one.name for one in self.inputs if isinstance(one, Measured) and one.unit == unit != "1"]
        return f"like {same[0]}" if len(same) == 1 else ""

    def instead(self, column: Column, otherwise: Any) -> None:
        """Say what a column is where a parameter that it names, or that it is itself, is left out."""
        if not isinstance(otherwise, Equation):
            own = exact(otherwise), "where it is left out", Kind.DEFINITION, column.meaning
            otherwise = Equation(self.free_number(column.name), (column.cell, own[0]), *own[1:])
            self.entries.append(otherwise)
        of = otherwise.sides[0]
        rule = Formula(self.places.put(otherwise, {of: column.cell}))
        self.optional.others[column.name] = replace(column, rule=rule)
        self.places[-1][of] = column.cell

    def paired(self, index: str, size: str, members: Sequence[str]) -> tuple[Callable[[Any], Expr], ...]:
        """Every pair of rows, and what takes a formula for the rows at its first and at its second member."""
        if any(isinstance(axis, PairAxis) for axis in self.axes):
            raise SheetError("pairs() is asked for twice: what it returned before is good for all formulas")
        number, many, first, second = _numbers(index, size, *members)
        self.axes.append(PairAxis("pairs", number, many, of=self.axis, first=first, second=second))
        self._refuse_name_of_rows()
        return partial(self._of_member, first), partial(self._of_member, second)

    def _of_member(self, member: Symbol, formula: Any) -> Expr:
        formula = exact(formula)
        if self.axis_of(formula) != self.axis:
            raise SheetError(f"{formula} has no value for each row, of which a pair has two")
        if self.is_grouped(formula):
            formula = self._of_rows(formula, self.axis)
        found: Expr = formula.subs(self.axis.index, member)
        return found

    @property
    def whole(self) -> tuple[Column, ...]:
        """All columns: what one result rests on leaves out the same rows."""
        columns = tuple(self.columns.values())
        if self.ledger is not None:
            return columns
        return told_apart(SameRows(columns, self.fits, self.of_fits, self.margins).columns, self.fits)

    def column(self, name: str) -> Column:
        """What was declared under a name."""
        if name not in self.columns:
            raise SheetError(f"{name} is not declared: a name of the body can be shown, no formula", name)
        return self.columns[name]

    def __setitem__(self, name: str, value: Any) -> None:
        if name in self.columns:
            raise SheetError(f"{name} is declared twice: it is the {self.columns[name].meaning}", name)
        self.unnamed = [said for said in self.unnamed if said is not value]
        begins = isinstance(value, InputLine) and value.is_measured
        has_rows = begins or any(isinstance(each, Measured) for each in self.inputs)
        if has_rows and isinstance(value, Declaration):
            self._refuse_name_of_rows(name)
        if isinstance(value, UnknownLine):
            self.announced[name] = value
            rows = None if value.of is None else self.axis_of(value.of)
            value = Column(name, rows, Given(), positive=value.column["positive"]).cell
        if isinstance(value, TakenLine):
            value = value.declare(self, name)
        if isinstance(value, FitLine):
            value = self._fitted(name, value)
        if isinstance(value, Declaration):
            self.columns[name] = column = self._declared(name, value)
            value = column.cell
        super().__setitem__(name, value)

    def _refuse_name_of_rows(self, name: str = "") -> None:
        """What counts rows, or pairs of them, has its name for itself."""
        words = {
            self.axis.index_name: (f"the {self.axis.row}'s number", "index='...' behind (Method"),
            self.axis.size_name: (f"the number of {self.axis.name}", "size='...' behind (Method"),
        }
        for rows in self.row_axes[1:]:
            words[rows.index_name] = f"the {rows.row}'s number", "index='...' in rows()"
            words[rows.size_name] = f"the number of {rows.name}", "size='...' in rows()"
        for groups in self.groups:
            words[groups.index_name] = f"the {groups.row}'s number", "index='...' in groups()"
            words[groups.size_name] = f"the number of {groups.name}", "size='...' in groups()"
        for pairs in (axis for axis in self.axes if isinstance(axis, PairAxis)):
            words |= dict.fromkeys(pairs.named, ("the number of one of two", "members='...' in pairs()"))
            words[pairs.index_name] = "the pair's number", "index='...' in pairs()"
            words[pairs.size_name] = "the number of pairs", "size='...' in pairs()"
        for own, (said, there) in words.items():
            if own == name or own in self.columns:
                raise SheetError(
                    f"{own} is {said}: call that otherwise, {there}, or take another name than {own}", own
                )

    def _declared(self, name: str, said: Declaration) -> Column:
        """The column of a line."""
        if isinstance(said, ComputedLine):
            column = self._computed(name, said)
            if said.is_margin:
                self.margins[name] = shown_in(column, self.columns).text
            return column
        if isinstance(said, PointsLine):
            return self._points(name, said)
        assert isinstance(said, InputLine)
        return self._input(name, said)

    def _points(self, name: str, said: PointsLine) -> Column:
        """The points of a curve, or of one for each row or group that its ends hang on: rows of their own."""
        size = size_of(name, said.unit)
        low, high = self._end(f"{name}_first", said, said.low), self._end(f"{name}_last", said, said.high)
        over = self.axis_of(low, high)
        index, many, step = _numbers(f"{name}_row", f"{name}_points", f"{name}_point")
        if over is None:
            last: Expr = Integer(said.number)
            axis: Axis = CountedAxis(f"{name}_points", index, many, step, said.number)
        elif over.ordinals:
            raise SheetError(f"{name}: its ends are points themselves, of {over.name}", name)
        else:
            each, more = f"{name}_each", {"exact": True, "positive": True}
            count = InputLine(f"points of {name}", "1", more, Bounds(2, integer=True), str(said.number))
            self.columns[each] = column = self._input(each, count)
            last = column.symbol
            axis = RepeatAxis(f"{name}_points", index, many, of=over, step=step, count=each)
        self.axes.append(axis)
        self._refuse_name_of_rows()
        column = Column(name, axis, Given(), meaning=said.meaning, **unit_in_si(size), **said.column)
        sides, label = (column.cell, spaced(low, high, step, last)), self.free_number(name, said.label)
        equation = Equation(label, sides, "points", Kind.DEFINITION, said.meaning)
        self.entries.append(equation)
        return self._as_difference(replace(column, rule=Formula(equation)), said_so=True)

    def _end(self, name: str, said: PointsLine | ComputedLine, end: Expr) -> Expr:
        """An end of points, or of a root; a number in their unit is a parameter with a default."""
        if not end.is_number:
            return exact(self._of_one_row(end))
        if not end and not size_of(name, said.unit).zero:
            return end
        if name in self.columns:
            said_so = f"the number {float(end):.15g} is a parameter of that name: call the other otherwise"
            raise SheetError(f"{name} is declared twice: of the ends, {said_so}", name)
        which = name.rpartition("_")[2]
        line = InputLine(
            f"{said.meaning}, {which}",
            said.unit,
            {"exact": True, "positive": False},
            default=f"{float(end):.15g}{behind(said.unit)}",
        )
        self.columns[name] = column = self._input(name, line)
        return column.cell

    def _input(self, name: str, said: InputLine) -> Column:
        size = size_of(name, said.unit)
        refuse_zero(name, said, size)
        bounds = said.bounds.within(size.scale, size.zero)
        if size.zero:  # nothing is colder than 0 K
            bounds = replace(bounds, low=max(bounds.low or 0.0, 0.0))
        if said.quantity:
            bounds = let_in(said.quantity, bounds)
        own = name, said.unit, said.asked or said.meaning, bounds, said.beyond
        rows = self.axis if said.of is None else said.of
        if rows not in self.row_axes:
            raise SheetError(f"{name}: {none_of(rows, 'rows')}", name)
        measured = Measured(*own, table=rows.name)
        self.inputs.append(measured if said.is_measured else Parameter(*own, said.default))
        self.examples |= {name: said.example} if said.example else {}
        self.constants += [name] * said.is_constant
        positive = said.column["positive"] or bool(size.zero and bounds.low is not None and bounds.low > 0)
        rule = Given("measured" if said.is_measured else "parameter")
        axis = rows if said.is_measured else None
        words = {"meaning": said.meaning, **unit_in_si(size), **said.column, "positive": positive}
        if own_word := said.quantity:
            words |= {"meaning": own_word.meaning, "latex": own_word.latex, "positive": own_word.positive}
            words |= {"display": f"like {name}"}
        column = Column(name, axis, rule, **words)
        if own_word:
            self.places[-1].setdefault(own_word.symbol, column.cell)
        if said.optional or said.otherwise is not None:
            self.optional.names.append(name)
        if said.otherwise is not None:
            self.instead(column, said.otherwise)
        return column

    def free_number(self, name: str, label: object = "") -> str:
        """What an equation is called, as no other is; without a label the next number."""
        every = [*Ledger((*(self.ledger.entries if self.ledger else ()), *self.entries)).equations()]
        taken = dict.fromkeys(equation.number for equation in every if not equation.own)
        numbers = map("({})".format, itertools.count(len(taken) + 1))
        return checked_label(name, label, every) if label else next(n for n in numbers if n not in taken)

    def _fitted(self, name: str, said: FitLine) -> DeclaredFit:
        """The columns, equations and figures of a fit; what a name of the body stands for is told of it."""
        if not isinstance(said.observed, Indexed):
            raise SheetError(f"{name}: {said.observed} is no column over the rows: let(...) it be one", name)
        sought = {
            symbol: self._begun(with_unit(each, announced), each)
            for each, announced in self.announced.items()
            if each not in self.columns and (symbol := self[each]) in said.model.free_symbols
        }
        rows = self.axis_of(said.observed) or self.axis
        if said.of is not None and (said.of not in self.groups or rows != self.axis):
            raise SheetError(f"{name}: {none_of(said.of, 'groups', f', or has no {rows.name}')}", name)
        for formula in (said.model, *said.u.values()):
            if isinstance(formula, Expr) and rows in self.row_axes:
                self.axis_of(said.observed, formula)  # which refuses the rows of two tables
            if isinstance(formula, Expr) and rows in self.groups:
                self._refuse_rows(name, formula, rows)
            if isinstance(formula, Expr) and self.is_grouped(formula, said.observed):
                raise SheetError(f"{name}: {formula} is of rows in groups, which no fit takes", name)
        found = DeclaredFit(
            name, rows, self.columns, said.observed, said.model, sought, said.u,
            self.free_number(name, said.label), self.own, said.of,
        )  # fmt: skip
        for column in found.columns:
            if column.name in self.columns:
                raise SheetError(f"{column.name} is declared twice: {name} has one of that name, too", name)
            self.columns[column.name] = column
        for column in sorted(found.columns, key=lambda each: each.axis != rows):  # scatter rests on residuals
            said_so = column.name in self.announced
            self.columns[column.name] = self._as_difference(column, said_so)
        self.entries += found.entries
        self.aside += found.aside
        self.of_fits |= {column.name: column.name in self.announced for column in found.columns}
        self.bounds |= {str(each): line.bounds for each, line in sought.items()}
        self.fits.append(found)
        self.curves.append(found.curve)
        if said.of is None:
            self.inputs = [
                replace(each, scatter=found.curve.scatter)
                if isinstance(each, Measured) and each.name == name_of(said.observed)
                else each
                for each in self.inputs
            ]
        for symbol in sought:  # of each group, it is no longer the same for all
            super().__setitem__(symbol.name, self.columns[symbol.name].cell)
        if said.figures:
            self.figures += found.figures(len(self.figures) + 1)
            self.drawn += found.traced
            self.drawn_given |= found.given
        return found

    def _refuse_rows(self, name: str, formula: Expr, groups: Axis) -> None:
        """Say what a fit over the groups takes instead of what has a value for each of their rows."""
        word = next((word for word, value in self.items() if value is groups), groups.row)
        named = (cell for cell in self.named_in(formula) if cell.over is None)
        if of_rows := sorted({cell.name for cell in named if cell.index == self.axis.index_name}):
            raise SheetError(
                f"{name}: {of_rows[0]} has a value for each {self.axis.row}, and what is fitted one for each "
                f"{groups.row}; instead: name a let(mean({of_rows[0]}, of={word}), ...)",
                name,
            )
        if formula.has(Member):
            raise SheetError(f"{name}: let(...) what is taken of={word} be a column first", name)

    def _begun(self, sought: UnknownLine, name: str) -> UnknownLine:
        """The same with a start that takes nothing over rows: one that does is a column aside."""
        if sought.start is None or not sought.start.has(*REDUCTIONS):
            return sought
        own = f"{name}_start"
        meaning, positive = f"where the search for {name} begins", {"positive": False}
        said = ComputedLine(meaning, sought.unit, positive, (sought.start,), next(self.own))
        self.columns[own] = column = self._computed(own, said)
        self.aside.append(own)
        return replace(sought, start=column.cell)

    def _aside_of(self, unknown: str, side: Expr) -> Expr:
        """A side of an equation, as a column if it names the group of a row, and not what is sought."""
        named = {each.name for each in side.atoms(Symbol)}
        return self._of_rows(side, self.axis) if self.is_grouped(side) and unknown not in named else side

    def _computed(self, name: str, said: ComputedLine) -> Column:
        if self.axis in self._rows_of(*said.sides):  # whichever side names the row
            sought = Column(name, None, Given(), positive=False).symbol if said.ends else None
            sides = tuple(self._without_groups(side, sought) for side in said.sides)
            said = replace(said, sides=sides)
        if said.ends:  # a proof finds no point where a row and its group stand in one equation
            said = replace(said, sides=tuple(self._aside_of(name, side) for side in said.sides))
        named = {symbol for side in said.sides for symbol in side.free_symbols}
        axis = self.axis_of(*said.sides)
        unit = stated_unit(name, said.unit)
        column = Column(name, axis, Given(), meaning=said.meaning, **{**unit, **said.column})
        sides = said.sides if said.ends else (column.cell, *said.sides)
        kind = Kind.ASSUMPTION if said.ends else Kind.DEFINITION
        equation = Equation(self.free_number(name, said.label), sides, said.because, kind, said.meaning)
        self.entries.append(equation)
        if said.ends:
            if column.symbol not in named:
                raise SheetError(
                    f"the equation of {name} does not name it: write {name} = unknown() above", name
                )
            if self.announced.get(name) not in (None, UnknownLine("", "", {"latex": "", "positive": False})):
                raise SheetError(f"{name} = unknown() is enough: root(...) says what {name} is", name)
            ends, requires = self._ends(name, said)
            rule = Root(equation, equation, column.symbol, column.symbol, **{**said.ends, **ends})
            return self._as_difference(replace(column, rule=rule, requires=requires), said_so=True)
        column = replace(column, rule=Formula(equation))
        if not said.unit:
            column = as_its_parts(self.columns, column, self.aside)
        return self._as_difference(column, said_so=not column.display.startswith("like "))

    def _ends(self, name: str, said: ComputedLine) -> tuple[dict[str, Expr], tuple[tuple[Any, str], ...]]:
        """Between which a root lies and where it is begun, in SI, and that they are in order.

        Ends that hang on the row may change places. A number beside a formula has the unit of the unknown.
        """
        size, told = size_of(name, said.unit), said.ends or {}
        low, high, start = told["low"], told["high"], told["start"]
        if (low.is_number and high.is_number) or not size.dimension:
            low, high = (in_si(exact(self._of_one_row(end)), size) for end in (low, high))
        else:
            low, high = self._end(f"{name}_low", said, low), self._end(f"{name}_high", said, high)
        ends = {"low": low, "high": high, "start": (low + high) / 2 if start is None else in_si(start, size)}
        upright = low < high
        if upright in (true, false):
            return ends, ()
        return ends, ((upright, f"{high} is not above {low}, where {said.meaning} ends"),)

    def _as_difference(self, column: Column, said_so: bool) -> Column:
        """The column, shown in the unit of differences if it is one; refused if said to be in another."""
        unit, rule = shown_in(column, self.columns), column.rule
        if not unit.zero:
            return column
        if isinstance(rule, Formula | Root) and not column.is_u:
            apart = is_difference(rule.expression, self.columns, column.axis or self.axis)
        else:
            apart = column.is_u or (isinstance(rule, Given) and rule.u_of != "")
        shown = of_differences(unit)
        if apart and said_so:
            raise SheetError(
                f"{column.name} is a difference, which stays where all temperatures move: it is in K or "
                f"{shown}, not in {unit.text}; declare in {unit.text} whatever else is a temperature",
                column.name,
            )
        return replace(column, display=shown) if apart else column
