"""A method of one's own in as few lines as the calculation has: what is given, measured, and what follows.

class EndGauge(Method, source="JCGM 100:2008, H.1"):
    "End-gauge calibration."

    l_S = given("m", "length of the standard at 20 °C")
    d = given("m", "difference in length")
    l = let(l_S + d, "length of the end gauge", label="(H.1)")

In the body of the class a name stands for its cell from the line on where it is declared, as an expression of
sympy: what is measured for the cell of a row, what is computed for a row if its formula names one.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from typing import Any

from sympy import Expr, Float, Function, Indexed, Rational, Sum, Symbol, false, sympify, true
from sympy.core.numbers import ComplexInfinity, ImaginaryUnit, Infinity, NaN, NegativeInfinity

from ..derivations.equation import Derivation, Equation, Kind, Ledger
from ..derivations.unit_text import ParsedUnit, UnitError, coherent, parse_open
from .cells.units import unit_of
from .charts import BLUE, VERMILION, Chart, Series
from .column import Axis, Column, Formula, Given, Root, SheetError
from .fitted import DeclaredFit
from .quantity import Bounds, behind
from .sheet import Sheet
from .workbook import FigureSpec, Measured, Parameter, SquareSum, Workbook

__all__ = [
    "Method",
    "claim",
    "count",
    "fit",
    "given",
    "let",
    "mean",
    "measured",
    "plot",
    "root",
    "total",
    "unknown",
]


FUNCTIONS = (
    *("exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh"),
    *("Abs", "Max", "Min"),
)
"""Besides powers; as sympy calls them."""


@dataclass(frozen=True)
class _Declared:
    """What a line of the body says; its name comes with the assignment."""

    meaning: str
    unit: str
    column: Mapping[str, Any]


@dataclass(frozen=True)
class _Input(_Declared):
    bounds: Bounds = field(default_factory=Bounds)
    default: str | None = None
    is_measured: bool = False
    example: str = ""


@dataclass(frozen=True)
class _Computed(_Declared):
    sides: tuple[Expr, ...] = ()  # of a definition the last alone
    label: str = ""
    because: str = ""
    ends: Mapping[str, Any] | None = None  # of a root: the interval that it lies in, and where it is begun


@dataclass(frozen=True)
class _Unknown(_Declared):
    """What a root or a fit will find."""

    start: Expr | None = None


@dataclass(frozen=True)
class _Fit:
    """A model whose unknowns make a sum of squares least."""

    observed: Any
    model: Expr
    u: Any
    label: str
    figures: bool


def given(
    unit: str,
    meaning: str,
    *,
    low: float | None = None,
    high: float | None = None,
    positive: bool = False,
    whole: bool = False,
    default: str | None = None,
    exact: bool = False,
    latex: str = "",
    example: str = "",
) -> Any:
    """Declare a number of ``[parameters]``.

    Parameters
    ----------
    unit : str
        Its unit, ``K^-1`` or ``um``, in which it is shown; in report.toml any that converts to it may stand.
        Formulas have it in SI, and an angle in radians.
    meaning : str
        What it is, for messages and captions.
    low, high : float, optional
        The least and the largest value that is allowed, in that unit.
    positive : bool
        Whether it must be greater than zero.
    whole : bool
        Whether it must be a whole number.
    default : str, optional
        As printed, with its unit: what holds where it is left out.
    exact : bool
        Whether it is a choice or a convention, so that its digits say nothing of precision.
    latex : str
        How it is printed; as its name is, without.
    example : str
        What `loopsheet new` writes for it, as in report.toml; of a column, its numbers with spaces between.
    """
    column = {"exact": exact, "latex": latex, "positive": positive}
    return _Input(meaning, unit, column, _bounds(low, high, positive, whole), default, example=example)


def measured(
    unit: str,
    meaning: str,
    *,
    low: float | None = None,
    high: float | None = None,
    positive: bool = False,
    latex: str = "",
    example: str = "",
) -> Any:
    """Declare a column of the table of measurements; parameters as for :func:`given`."""
    column = {"latex": latex, "positive": positive}
    return _Input(meaning, unit, column, _bounds(low, high, positive), is_measured=True, example=example)


def let(
    formula: Any,
    meaning: str,
    unit: str = "",
    *,
    label: str = "",
    because: str = "definition",
    like: Any = None,
    display: str = "",
    latex: str = "",
) -> Any:
    """Declare what is computed.

    Parameters
    ----------
    formula : Expr
        In names of the body; one that names a measured column, but in a sum, has a value for each row.
    meaning : str
        What it is.
    unit : str
        Its unit, which the formula must have, and in which it is shown; without it, that of SI that it has.
    label : str
        The number of its equation, ``(H.2)``; its place among the equations, without.
    because : str
        Why it holds, in a few words.
    like : Expr, optional
        What is given or measured in the unit in which it shall be shown.
    display : str
        That unit by itself.
    latex : str
        How it is printed; as its name is, without.
    """
    shown = f"like {_name(like)}" if like is not None else display
    column = {"latex": latex, "positive": False} | ({"display": shown} if shown else {})
    return _Computed(meaning, unit, column, (_exact(formula),), label, because)


def unknown(meaning: str = "", unit: str = "", *, start: Any = None, latex: str = "") -> Any:
    """Announce what a root or a parameter of a fit will be called, so that an equation can name it.

    Parameters
    ----------
    meaning, unit, latex : str
        Of a parameter, as for :func:`let`; a root says itself what it is.
    start : float or Expr, optional
        Where a fit begins that is not linear in its parameters; a number is in SI.
    """
    return _Unknown(meaning, unit, {"latex": latex}, None if start is None else _exact(start))


def root(
    left: Any,
    right: Any,
    meaning: str,
    unit: str = "1",
    *,
    low: Any,
    high: Any,
    start: Any = None,
    label: str = "",
    because: str = "the method",
    display: str = "",
    latex: str = "",
    steps: int = 8,
) -> Any:
    """Declare the root of an equation; that it is the only one is decided before it is sought.

    Parameters
    ----------
    left, right : Expr
        Both sides, in names of the body and in the one that is announced by :func:`unknown`.
    meaning, unit, label, because, display, latex
        As for :func:`let`; the unit is that of the unknown.
    low, high : Expr
        Between which it lies, themselves left out, as all formulas in SI; they may hang on other names.
    start : Expr, optional
        A first guess, alike; the middle, without. It costs steps, never truth.
    steps : int
        How many of Newton's steps are tried before it is bisected.
    """
    low, high = _exact(low), _exact(high)
    if low.is_number and high.is_number and low >= high:
        raise SheetError(f"the root is sought between {low} and {high}: low is not below high")
    ends = {"low": low, "high": high, "start": (low + high) / 2 if start is None else sympify(start)}
    first, last = (f"{float(end):.15g}" if end.is_number else str(end) for end in (low, high))
    between = f"{first} and {last}" + behind(unit)
    none = f"no value between {between}, which do not count, satisfies the equation"
    # Ends that hang on the row may change places.
    upright = low < high
    requires = (
        () if upright in (true, false) else ((upright, f"{high} is not above {low}, where {meaning} ends"),)
    )
    column = {"latex": latex, "positive": False, "requires": requires}
    column |= {"display": display} if display else {}
    sides = _exact(left), _exact(right)
    return _Computed(meaning, unit, column, sides, label, because, {**ends, "steps": steps, "none": none})


def fit(observed: Any, model: Any, *, u: Any = None, label: str = "", figures: bool = True) -> Any:
    """Declare a fit by least squares: it finds the unknowns that its model names.

    Of ``line = fit(...)`` there are ``line.fitted`` and ``line.residual`` of each row, ``line.S``, the sum of
    squares, ``line.s``, the scatter, and by scatter ``line.s_a``, the standard uncertainty of a parameter
    ``a``, and ``line.r_a_b``, the correlation of two. Their `u` is propagated as that of everything else.

    Parameters
    ----------
    observed : Expr
        A column over the rows.
    model : Expr
        In names of the body and in those that are announced by :func:`unknown`. If it is linear in these,
        nothing is iterated; else each needs a start.
    u : Expr or ``"stated"``, optional
        The standard uncertainties that rows are weighed by: a formula, or those that are stated of the
        column. Without, all rows are alike.
    label : str
        The number of its equations, ``(H.13)``, which get letters.
    figures : bool
        Whether points and curve, and the residuals, are figures of the report.
    """
    return _Fit(observed, _exact(model), u, label, figures)


def total(formula: Any) -> Expr:
    """The sum over all rows."""
    axis = _body().axis
    return Sum(formula, (axis.index, 1, axis.size))


def mean(formula: Any) -> Expr:
    """The mean over all rows."""
    return total(formula) / count()


def count() -> Symbol:
    """How many rows there are."""
    return _body().axis.size


def claim(
    left: Any,
    right: Any,
    meaning: str,
    *,
    because: str = "",
    from_: Sequence[Any] | None = None,
    label: str = "",
) -> None:
    """State that two formulas are equal whatever was measured: it is proved, or a finding of `check`.

    Parameters
    ----------
    left, right : Expr
        In names of the body; of one that has a value for each row, it is claimed of every row.
    meaning : str
        What is claimed, in a few words.
    because : str
        Why it holds.
    from_ : sequence of Expr, optional
        The quantities whose equations it follows from, all others may have any value; without, all that it
        rests on, back to what is given and measured.
    label : str
        The number of its equation; its place among the equations, without.
    """
    _body().claimed(_exact(left), _exact(right), meaning, because, from_, label)


def plot(x: Any, y: Any, *curves: Any, caption: str = "", log: str = "") -> None:
    """Show points of two columns, and what is computed beside them.

    Parameters
    ----------
    x, y : Expr
        Columns over the rows.
    *curves : Expr
        Computed columns, each drawn as a line in the order of x, or single numbers, each across all of it.
    caption : str
        Below the figure; what its axes are, without.
    log : str
        The axes with a logarithmic scale: ``x``, ``y`` or ``xy``.
    """
    body = _body()
    across, up, *beside = (body.column(_name(cell)) for cell in (x, y, *curves))
    for each in (across, up):
        if each.axis is None:
            raise SheetError(f"{each.name} is a single number, which is no column to plot", each.name)
    series = [Series(across.name, up.name, up.meaning, "points")]
    for column, colour in zip(beside, itertools.cycle((VERMILION, BLUE)), strict=False):
        style = "level" if column.axis is None else "line"
        series.append(Series(across.name, column.name, column.meaning, style, colour))
    said, number = f"{up.meaning} over {across.meaning}", str(len(body.figures) + 1)
    chart = Chart(said, across.meaning, up.meaning, tuple(series), log, whole=True)
    body.figures.append(FigureSpec(f"plot_{number}", number, caption or f"{said.capitalize()}.", chart=chart))


def _bounds(low: float | None, high: float | None, positive: bool, whole: bool = False) -> Bounds:
    above = positive and (low is None or low <= 0)
    return Bounds(0 if above else low, high, low_open=above, integer=whole)


def _size(name: str, unit: str) -> ParsedUnit:
    try:
        return parse_open(unit)
    except UnitError as error:
        hint = f"; {error.suggestion}" if error.suggestion else ""
        kind = "is unknown" if error.code == "LS421" else "cannot be read"
        raise SheetError(f"{name}: the unit {error.text!r} {kind}{hint}", name) from None


def _unit(size: ParsedUnit) -> dict[str, Any]:
    """The unit of a column, in SI, and the one that it is shown in, if that is another."""
    si = coherent(size)
    return {"unit": si} if si == size.text else {"unit": si, "display": size.text}


def _in_si(place: Expr, size: ParsedUnit) -> Expr:
    """A number in a unit, in SI; what names quantities is in SI."""
    return place * Rational(size.scale) + Rational(size.zero) if place.is_number else place


def _stated_unit(name: str, unit: str) -> dict[str, Any]:
    return _unit(_size(name, unit)) if unit else {}


def _exact(formula: Any) -> Expr:
    """A formula with its decimal fractions as they were typed: 0.27027027... was 1/3.7."""
    formula = sympify(formula)
    if not isinstance(formula, Expr) or formula.has(
        ImaginaryUnit, NaN, Infinity, NegativeInfinity, ComplexInfinity
    ):
        raise SheetError(f"{formula} is no formula of real numbers")
    for part in formula.atoms(Function):
        if part.func.__name__ not in FUNCTIONS:
            known = ", ".join(sorted(FUNCTIONS))
            raise SheetError(f"{part.func} is none of the functions that every engine has: {known}")
    typed = {}
    for number in formula.atoms(Float) - {Float(0)}:
        own, turned = repr(float(number)), f"{1 / float(number):.12g}"
        if len(turned) + 4 < len(own) and math.isclose(1 / float(turned), float(number), rel_tol=1e-15):
            typed[number] = 1 / Rational(turned)
    found: Expr = formula.xreplace(typed)
    return found


def _typed(formula: Expr) -> Expr:
    """A formula with its decimal fractions as fractions: a proof takes no rounded number."""
    typed: Expr = formula.xreplace({number: Rational(repr(float(number))) for number in formula.atoms(Float)})
    return typed


def _name(cell: Expr) -> str:
    return str(cell.base.label.name if isinstance(cell, Indexed) else cell)


def _named(column: Column) -> set[str]:
    """What the rule of a column names, itself too if it is a root."""
    return {_name(cell) for one in column.expressions for cell in one.atoms(Symbol, Indexed)}


class _Body(dict[str, Any]):
    """The namespace of a method while it is declared: every name that is assigned becomes a cell."""

    def __init__(self, rows: str, index: str, size: str) -> None:
        super().__init__()
        self.axis = Axis(rows, *(Symbol(name, integer=True, positive=True) for name in (index, size)))
        self.columns: dict[str, Column] = {}
        self.inputs: list[Measured | Parameter] = []
        self.entries: list[Equation | Derivation] = []
        self.examples: dict[str, str] = {}
        self.figures: list[FigureSpec] = []
        self.announced: dict[str, _Unknown] = {}
        self.aside: list[str] = []
        self.of_fits: dict[str, bool] = {}  # and whether it is a parameter
        self.squares: list[SquareSum] = []
        self.own = map("(L{})".format, itertools.count(1))

    @property
    def whole(self) -> tuple[Column, ...]:
        """All columns: the sums that one result rests on leave out the same rows.

        Those are rows in which something was not measured, or has no value that one of these sums, or what is
        computed from them, asks for; what rests on a sum itself cannot be asked.
        """
        every = tuple(self.columns.values())
        below = {c.name: {c.name, *_named(c)} & self.columns.keys() for c in every}
        for _ in every:  # what is iterated rests on itself
            below = {
                name: set[str]().union(*(below[each] for each in names)) for name, names in below.items()
            }
        sums = {c.name for c in every if any(e.has(Sum) for e in c.expressions)}
        rows = [c for c in every if c.axis and not sums & below[c.name]]

        def asked(total: Column) -> Iterator[Column]:
            together = set[str]().union(*(names for names in below.values() if total.name in names))
            return (c for c in rows if isinstance(c.rule, Given) or c.name in together)

        return tuple(replace(c, alongside=tuple(asked(c))) if c.name in sums else c for c in every)

    def column(self, name: str) -> Column:
        """What was declared under a name."""
        if name not in self.columns:
            raise SheetError(f"{name} is not declared: a name of the body can be plotted, no formula", name)
        return self.columns[name]

    def __setitem__(self, name: str, value: Any) -> None:
        if name in self.columns:
            raise SheetError(f"{name} is declared twice", name)
        if isinstance(value, _Unknown):
            self.announced[name] = value
            value = Column(name, None, Given(), positive=False).symbol
        if isinstance(value, _Fit):
            value = self._fitted(name, value)
        if isinstance(value, _Declared):
            if name in (self.axis.index_name, self.axis.size_name):
                word = "index" if name == self.axis.index_name else "size"
                what = (
                    f"the {self.axis.row}'s number" if word == "index" else f"the number of {self.axis.name}"
                )
                raise SheetError(
                    f"{name} is {what}: call that otherwise, {word}='...' behind the title", name
                )
            column = self._computed(name, value) if isinstance(value, _Computed) else self._input(name, value)
            self.columns[name] = column
            value = column.cell
        super().__setitem__(name, value)

    def _input(self, name: str, said: _Declared) -> Column:
        assert isinstance(said, _Input)
        size = _size(name, said.unit)
        if size.zero and said.column["positive"]:
            raise SheetError(f"{name}: above which zero? say low=..., in {said.unit}", name)
        bounds = said.bounds.within(size.scale, size.zero)
        own = name, said.unit, said.meaning, bounds
        self.inputs.append(Measured(*own) if said.is_measured else Parameter(*own, said.default))
        self.examples |= {name: said.example} if said.example else {}
        positive = said.column["positive"] or bool(size.zero and bounds.low is not None and bounds.low > 0)
        rule = Given("measured" if said.is_measured else "parameter")
        axis = self.axis if said.is_measured else None
        return Column(
            name, axis, rule, meaning=said.meaning, **_unit(size), **{**said.column, "positive": positive}
        )

    def _number(self) -> str:
        """The next number of an equation."""
        every = Ledger(tuple(self.entries)).equations()
        taken = dict.fromkeys(equation.number for equation in every if not equation.own)
        numbers = map("({})".format, itertools.count(len(taken) + 1))
        return next(number for number in numbers if number not in taken)

    def _fitted(self, name: str, said: _Fit) -> DeclaredFit:
        """The columns, equations and figures of a fit; what a name of the body stands for is told of it."""
        if not isinstance(said.observed, Indexed):
            raise SheetError(f"{name}: {said.observed} is no column over the rows: let(...) it be one", name)
        sought = {
            symbol: replace(announced, column={**_stated_unit(each, announced.unit), **announced.column})
            for each, announced in self.announced.items()
            if each not in self.columns and (symbol := Symbol(each, real=True)) in said.model.free_symbols
        }
        found = DeclaredFit(
            name, self.axis, self.columns, said.observed, said.model, sought, said.u,
            said.label or self._number(), self.own,
        )  # fmt: skip
        for column in found.columns:
            if column.name in self.columns:
                raise SheetError(f"{column.name} is declared twice: {name} has one of that name, too", name)
            self.columns[column.name] = column
        self.entries += found.entries
        self.aside += found.aside
        self.of_fits |= {column.name: Symbol(column.name, real=True) in sought for column in found.columns}
        self.squares += found.squares
        if said.figures:
            self.figures += found.figures(len(self.figures) + 1)
        return found

    def claimed(
        self, left: Expr, right: Expr, meaning: str, because: str, from_: Sequence[Any] | None, label: str
    ) -> None:
        """Put a claim into the ledger, with what it is to be derived from."""
        found = self._premises((left, right) if from_ is None else from_, meaning, everything=from_ is None)
        row = Symbol("i", integer=True, positive=True)
        members = tuple(_typed(side).subs(self.axis.index, row) for side in (left, right))
        conditions = tuple(dict.fromkeys(each for premise, _ in found for each in premise.conditions))
        equation = Equation(
            label or self._number(),
            members,
            because or "it follows by algebra",
            title=meaning,
            conditions=conditions,
        )
        zero = Equation(equation.label, (left, left - right), "", title=meaning)
        unit_of(self.columns, Column(meaning, self.axis, Formula(zero)))  # as long as both have one unit
        premises, unknowns = zip(*found, strict=True) if found else ((), ())
        self.entries.append(Derivation.of(equation, premises, unknowns, "Put in what the quantities are."))

    def _premises(
        self, formulas: Sequence[Any], meaning: str, everything: bool
    ) -> list[tuple[Equation, Expr]]:
        """What says of the quantities in formulas what they are, and what each is solved for."""
        found: dict[str, tuple[Equation, Expr]] = {}
        left = list(formulas)
        while left:
            named = {_name(cell) for cell in left.pop().atoms(Symbol, Indexed)} & self.columns.keys()
            for column in (self.columns[name] for name in sorted(named - found.keys())):
                if isinstance(column.rule, Given):
                    continue
                if not isinstance(column.rule, Formula):
                    raise SheetError(
                        f"{column.name} is sought, it has no formula to put in: say what '{meaning}' follows "
                        "from without it, from_=[...]",
                        column.name,
                    )
                equation, cell = column.rule.equation, column.cell
                found[column.name] = equation, cell.base if isinstance(cell, Indexed) else cell
                left += [equation.value] if everything else []
        return list(found.values())

    def _computed(self, name: str, said: _Computed) -> Column:
        named = {symbol for side in said.sides for symbol in side.free_symbols}
        axis = self.axis if self.axis.index in named else None
        unit = _stated_unit(name, said.unit)
        column = Column(name, axis, Given(), meaning=said.meaning, **{**unit, **said.column})
        sides = said.sides if said.ends else (column.cell, *said.sides)
        kind = Kind.ASSUMPTION if said.ends else Kind.DEFINITION
        equation = Equation(said.label or self._number(), sides, said.because, kind, said.meaning)
        self.entries.append(equation)
        if said.ends:
            if column.symbol not in named:
                raise SheetError(
                    f"the equation of {name} does not name it: write {name} = unknown() above", name
                )
            if self.announced.get(name) not in (None, _Unknown("", "", {"latex": ""})):
                raise SheetError(f"{name} = unknown() is enough: root(...) says what {name} is", name)
            size = _size(name, said.unit)
            places = {
                each: _in_si(place, size) for each, place in said.ends.items() if isinstance(place, Expr)
            }
            rule = Root(equation, equation, column.symbol, column.symbol, **{**said.ends, **places})
            return replace(column, rule=rule)
        column = replace(column, rule=Formula(equation))
        if not said.unit:
            column = replace(column, unit=unit_of(Sheet((*self.columns.values(), column)), column))
        return column


_CURRENT: ContextVar[_Body | None] = ContextVar("_CURRENT", default=None)


def _body() -> _Body:
    """That of the method which is being declared."""
    body = _CURRENT.get()
    if body is None:
        raise SheetError("sums, counts and plots stand in the body of a class of Method")
    return body


class _Declaring(type):
    """Makes a workbook of the body of a class."""

    workbook: Workbook

    @classmethod
    def __prepare__(
        cls, name: str, bases: tuple[type, ...], /, *, rows: str = "readings",
        index: str = "k", size: str = "n", **more: Any,
    ) -> _Body:  # fmt: skip
        body = _Body(rows, index, size)
        if bases:
            _CURRENT.set(body)
        if bases and bases != (Method,):
            raise SheetError("a method is a class of Method alone")
        return body

    def __new__(
        cls, name: str, bases: tuple[type, ...], body: Mapping[str, Any], /, *, source: str = "",
        headline: str = "", rows: str = "", index: str = "", size: str = "",
    ) -> _Declaring:  # fmt: skip
        """Take what the body declared; the first line of its docstring is the title.

        Parameters
        ----------
        source : str
            Where the method is published.
        headline : str
            The names of the results, first in every view; without, the parameters of fits, and else that of
            which nothing else is computed.
        rows, index, size : str
            What the rows of the table of measurements are called, ``readings``, their running number in
            formulas, ``k``, and how many there are, ``n``.
        """
        found = super().__new__(cls, name, bases, dict(body))
        if bases:
            assert isinstance(body, _Body)
            _CURRENT.set(None)
            title = (found.__doc__ or name).strip().partition("\n")[0].removesuffix(".")
            found.workbook = _workbook(name, body, title, source, re.findall(r"\w+", headline))
        return found


class Method(metaclass=_Declaring):
    """A method of one's own: `class Name(Method, source=...)` with its title and its quantities as its body.

    Attributes
    ----------
    workbook : Workbook
        What it declares, in the order in which it stands there.
    """


def _workbook(name: str, body: _Body, title: str, source: str, headline: Sequence[str]) -> Workbook:
    columns, entries = body.whole, tuple(body.entries)
    for each in headline:
        if each not in body.columns:
            raise SheetError(f"the headline names {each}, which is not declared", each)
    for announced in body.announced:
        if announced not in body.columns:
            raise SheetError(
                f"{announced} is announced as unknown, and neither a root nor a fit finds it", announced
            )
    if not entries:
        raise SheetError(f"{name} computes nothing: it has no let(...), no root(...) and no fit(...)", name)
    used = set[str]().union(*(_named(c) - {c.name} for c in columns))
    scalars = (c.name for c in columns if c.axis is None and c.equation)
    last = [each for each in scalars if body.of_fits.get(each, each not in used)]
    given_to = tuple(one for one in body.inputs if isinstance(one, Parameter))
    columns_of = tuple(one for one in body.inputs if isinstance(one, Measured))
    rows = zip(*(body.examples.get(one.name, "").split() for one in columns_of), strict=False)
    head = (body.axis.row, *(f"{one.name} [{one.unit}]" for one in columns_of))
    return Workbook(
        name=re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower(),
        title=title,
        source=source,
        ledger=lambda: Ledger(entries),
        measured=columns_of,
        parameters=given_to,
        sheet=lambda names: Sheet(columns),
        headline=tuple(headline) or tuple(last),
        row=body.axis.row,
        squares=tuple(body.squares),
        aside=frozenset(body.aside),
        figures=tuple(body.figures),
        example=(head, *((str(place), *row) for place, row in enumerate(rows, start=1)))
        if columns_of
        else (),
        example_parameters={
            one.name: body.examples[one.name] for one in given_to if one.name in body.examples
        },
    )
