"""What a workbook declares: its inputs, its algebra, its sheet, and what a reader is shown of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Set
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any

from .charts import Chart
from .quantity import Bounds

if TYPE_CHECKING:
    from sympy import Expr, Symbol

    from ..derivations.equation import Ledger
    from .axis import Axis
    from .charts import Drawn
    from .column import Column
    from .sheet import Sheet


@dataclass(frozen=True)
class Measured:
    """A measured column of the tests' table, by its cell name."""

    name: str
    """The cell name, and the word in the header: ``x_p`` of ``x_p [um]``."""
    unit: str
    """The SI unit; a header may use any compatible one."""
    meaning: str
    """What it is, for messages and captions."""
    bounds: Bounds = field(default_factory=Bounds)
    """What values are allowed, in SI."""
    beyond: str = ""
    """How its method would allow others, if that is not plain where it is declared."""
    scatter: str = ""
    """Of what a model is fitted to, the cell that tells how it scatters about the curve."""
    table: str = ""
    """The name of the table of rows that it stands in, where there are several."""


@dataclass(frozen=True)
class RowTable:
    """A table of measured rows, which has a file of its own."""

    name: str = ""
    """The index set of its rows, and its place under ``[measurements]``; none of the only one."""
    row: str = "test"
    """What a row is called: the first line of the file may say that in place of ``test``."""
    least: int = 2
    """How many rows it takes at least."""
    groups: tuple[str, ...] = ()
    """The columns of words that say which rows belong together."""
    example: tuple[tuple[str, ...], ...] = ()
    """A small one that ``new`` writes; its first row is the header, with units."""

    @property
    def place(self) -> tuple[str, ...]:
        """Its place in report.toml."""
        return ("measurements", self.name) if self.name else ("measurements",)

    @property
    def file(self) -> str:
        """What its file is called, unless a folder calls it otherwise."""
        return f"{self.name or 'measurements'}.csv"


@dataclass(frozen=True)
class Parameter:
    """A scalar of the ``[parameters]`` section, by its cell name."""

    name: str
    unit: str
    meaning: str
    bounds: Bounds = field(default_factory=Bounds)
    beyond: str = ""
    """`name`, `unit`, `meaning`, `bounds` and `beyond`: as for :class:`Measured`."""
    default: str | None = None
    """The printed value with its unit that holds when it is left out; None: no default."""


@dataclass(frozen=True)
class Either:
    """A parameter that may be left out, and what it is computed from then."""

    name: str
    meaning: str
    instead: tuple[str, ...]

    def wrong(self, given: Set[str]) -> str | None:
        """What is missing or too much among the parameters that were given."""
        if self.name in given and (twice := sorted({*self.instead} & given)):
            return f"{self.name} and {' and '.join(twice)} say the same thing twice; keep one"
        if self.name not in given and not given >= {*self.instead}:
            return f"the {self.meaning} is missing: give {self.name}, or {' and '.join(self.instead)}"
        return None


@dataclass(frozen=True)
class TableSpec:
    """A table of the report: some columns of one axis (or scalars, one a row).

    Columns that the sheet does not have are left out: which parameters there are depends on the data.
    """

    name: str
    title: str
    columns: tuple[str, ...]
    note: str = ""
    number: str = ""
    """Its number; that of the source's table, where it corresponds to one."""
    words: tuple[tuple[str, ...], ...] = ()
    """Of a table without columns: what stands above these, and its rows, the same for all data."""
    beside: tuple[str, tuple[tuple[str, str], ...]] = ("", ())
    """Of scalars: what stands above one more column, and by their names what that says of each."""


def tables_of(sheet: Sheet, aside: Set[str]) -> Iterator[TableSpec]:
    """A table of what is given, one for the rows of each axis, and one of the results.

    `aside`: the columns that none shows. Generated points are too many to be shown.
    """
    shown = [column for column in sheet.columns if column.name not in aside]
    given = tuple(c.name for c in shown if c.axis is None and c.equation is None)
    if given:
        yield TableSpec("given", "Parameters", given)
    for axis in sheet.axes:
        columns = tuple(column.name for column in shown if column.axis == axis)
        if columns and not axis.ordinals:
            yield TableSpec(axis.name, f"Values of the {axis.name}", columns)
    scalars = tuple(c.name for c in shown if c.axis is None and c.name not in given)
    if scalars:
        yield TableSpec("scalars", "Results", scalars)


@dataclass(frozen=True)
class FigureSpec:
    """A figure of the report: its number, its caption, and what is drawn."""

    name: str
    number: str
    caption: str
    draw: str = ""
    """Name of the drawing among the workbook's `drawings`; without it, its own."""
    alt: str = ""
    """What the picture shows, for those who cannot see it."""
    chart: Chart | None = None
    """What it shows of the sheet: all views draw it, and those that recalculate draw it again."""
    fixed: bool = False
    """Whether it is the same for all data: then it is drawn once for all."""

    @property
    def drawing(self) -> str:
        """The name of what draws it."""
        return self.draw or self.name


@dataclass(frozen=True)
class SquareSum:
    """A least sum of squares: it tells whether what was fitted describes what was measured."""

    name: str
    """The cell of the sum; every square is that of a deviation over its standard uncertainty."""
    axis: str
    """The rows that it sums over."""
    fitted: int
    """How many numbers were fitted to them."""
    each: int = 1
    """How many squares a row has."""
    asked: bool = True
    """Whether data are odd if chance does not make it so: not where models are compared of which one holds at
    most."""
    deviation: str = ""
    """The column of how far each row lies off, in standard deviations."""
    residual: str = ""
    weight: str = ""
    """`residual` and `weight`: the columns of what the curve leaves of each row, and of one over the variance
    that its errors give to that."""
    by_scatter: Mapping[str, str] = field(default_factory=dict)
    """By the cell of what was fitted, the cell of its standard uncertainty by how far rows lie off."""

    def freedom(self, rows: int) -> int:
        """The degrees of freedom of so many rows."""
        return self.each * rows - self.fitted


@dataclass(frozen=True)
class Curve:
    """A curve that was fitted to rows: its residuals tell whether it describes them."""

    name: str
    """The cell of its sum of squares."""
    axis: str
    """The rows that it sums over."""
    observed: str
    residual: str
    """`observed` and `residual`: the columns of what was observed, and of what the curve leaves of that."""
    scatter: str
    """The cell of the scatter about the curve."""
    fitted: tuple[str, ...]
    """The cells that were fitted to them."""
    weighed: bool
    """Whether rows were weighed."""
    by_scatter: Mapping[str, str] = field(default_factory=dict)
    """By the cell of what was fitted, the cell of its standard uncertainty by the scatter."""
    slopes: tuple[str, ...] = ()
    """The labels of the claims that the sum of squares has no slope by each; none of a linear model, whose
    parameters have proved equations of their own."""

    def freedom(self, rows: int) -> int:
        """The degrees of freedom of so many rows."""
        return rows - len(self.fitted)


@dataclass(frozen=True)
class Claimed:
    """Two formulas in cells of the sheet that are to be equal whatever is measured."""

    label: str
    meaning: str
    """`label` and `meaning`: of its equation."""
    axis: Axis | None
    """Of its rows, if it is one of each row."""
    left: Expr
    right: Expr


@dataclass(frozen=True)
class Design:
    """How rows that are not measured yet are made forward from what is known."""

    chosen: str
    """The measured column that a planner chooses."""
    fitted: tuple[Column, ...]
    """What is made of the measured rows first: a sheet whose given columns are measured ones."""
    planned: tuple[Column, ...]
    """Another sheet over rows of the same axis: the chosen column and numbers of the workbook's sheet or of
    `fitted`, given, and formulas for every other measured column."""
    curve: tuple[str, ...]
    """The numbers of the workbook's sheet that these rows follow, for the reader."""


@dataclass(frozen=True)
class Workbook:
    """One published method, ready to be fed with measurements."""

    name: str
    """The word for ``workbook =`` in report.toml."""
    title: str
    """A short title of the method."""
    source: str
    """The publication, as a reference."""
    ledger: Callable[[], Ledger]
    """Returns the equations with their derivations, in the order of the source."""
    measured: tuple[Measured, ...]
    parameters: tuple[Parameter, ...]
    """`measured` and `parameters`: what the user gives."""
    sheet: Callable[[frozenset[str]], Sheet]
    """Takes the names of the given parameters; returns the :class:`Sheet`. What is given gets the bounds
    there that `measured` and `parameters` declare."""
    check_parameters: Callable[[frozenset[str]], str | None] | None = None
    """Takes the names that were given; returns None or a sentence that says which combination is missing or
    contradictory."""
    either: tuple[Either, ...] = ()
    """Parameters in whose place others may be given: what of these is missing or too much is told, too."""
    headline: tuple[str, ...] = ()
    """The cells that are the result, first in every view."""
    row: str = "test"
    """What a row of the table of measurements is called: its first line may say that in place of ``test``."""
    least: int = 2
    """How many of these it takes at least."""
    groups: tuple[str, ...] = ()
    """The columns of words that say which rows belong together."""
    squares: tuple[SquareSum, ...] = ()
    """The sums of squares to be no larger and no smaller than chance makes them."""
    curves: tuple[Curve, ...] = ()
    """The curves whose residuals are to be no larger and no smaller than their uncertainties make them."""
    means: tuple[tuple[str, str], ...] = ()
    """Results that are the mean of a column over the rows of the data, each with that column: if these are of
    one quantity, they differ by no more than their uncertainties make them."""
    claims: tuple[Claimed, ...] = ()
    """What is to hold of its cells, whatever is measured."""
    constants: frozenset[str] = frozenset()
    """Parameters whose defaults are constants of nature; those that are not exact were adjusted together."""
    margins: Mapping[str, str] = field(default_factory=dict)
    """What has to be 0 or more, unless a folder says otherwise, and its unit."""
    aside: frozenset[str] = frozenset()
    """What only leads to other cells: it is in no table, but in those that the workbook declares."""
    fits: tuple[str, ...] = ()
    """Names of three cells, if a source's choice of fit is to be told: the mean, the fit to logarithms (as
    published), the fit to the values themselves."""
    tables: tuple[TableSpec, ...] = ()
    figures: tuple[FigureSpec, ...] = ()
    """`tables` and `figures`: what a reader is shown."""
    prose: str = "generic"
    """Name of the narrative under templates/prose."""
    told: Mapping[str, str] = field(default_factory=dict)
    """Lines of that narrative that the workbook makes itself, by the name under which it asks for them."""
    published_as: Mapping[str, str] = field(default_factory=dict)
    """Titles of the published tables, by their ``source`` in published.csv."""
    example: tuple[tuple[str, ...], ...] = ()
    """A small table of measurements that ``new`` writes; its first row is the header, with units."""
    example_parameters: Mapping[str, str] = field(default_factory=dict)
    """The parameters that go with it, as printed, by name."""
    several: tuple[RowTable, ...] = ()
    """The tables of measured rows where there are several, which then say `row`, `least`, `groups` and
    `example` themselves; what is measured says in which it stands."""
    drawn: Callable[[Sheet], Drawn] | None = None
    """Takes the sheet; returns the columns that only the charts of its figures ask for."""
    drawings: Callable[[], Mapping[str, Callable[[Any], Any]]] | None = None
    """Returns what draws its figures, by name: each takes the report and returns a matplotlib figure."""
    models: tuple[Any, ...] = ()
    """The contact models beside its tests: cards are made of their forces."""
    card_constants: Callable[[Sheet], Mapping[Symbol, str]] | None = None
    """Takes the sheet; returns the cells that symbols of these models are, where one is for all rows."""
    design: Callable[[Sheet], Design] | None = None
    """Takes the sheet; returns how measurements are planned. Without it, they cannot be."""

    def __post_init__(self) -> None:
        """Every engine gets what the reader of a folder gets: bounds are declared once."""
        from .sheet import Sheet

        lay_out, bounds = self.sheet, {name: each.bounds for name, each in self.declared.items()}

        def bounded(given: frozenset[str]) -> Sheet:
            sheet = lay_out(given)
            if not isinstance(sheet, Sheet):  # a user's own code may return anything
                raise TypeError("what sheet() returns is no Sheet")
            return sheet.bounded(bounds)

        object.__setattr__(self, "sheet", cache(bounded))

    def wrong(self, given: frozenset[str]) -> str | None:
        """What is missing or contradictory among the parameters that were given; None if nothing is."""
        own = () if self.check_parameters is None else (self.check_parameters(given),)
        return next(filter(None, (*(each.wrong(given) for each in self.either), *own)), None)

    @property
    def row_tables(self) -> tuple[RowTable, ...]:
        """The tables of measured rows, in the order in which they are told."""
        return self.several or (RowTable("", self.row, self.least, self.groups, self.example),)

    def columns_of(self, table: RowTable) -> tuple[Measured, ...]:
        """What is measured in the rows of one of them."""
        return tuple(each for each in self.measured if each.table == table.name)

    @property
    def charts(self) -> tuple[Chart, ...]:
        """The charts of its figures."""
        return tuple(figure.chart for figure in self.figures if figure.chart is not None)

    @property
    def declared(self) -> dict[str, Measured | Parameter]:
        """What the user gives, by its cell name."""
        each: tuple[Measured | Parameter, ...] = (*self.measured, *self.parameters)
        return {one.name: one for one in each}
