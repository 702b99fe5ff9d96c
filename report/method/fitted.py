"""A fit in the body of a method: its columns, its figures, and what its name stands for."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import combinations
from typing import Any

from sympy import Abs, Expr, Indexed, IndexedBase, Integer, Min, Rational, Sum, Symbol, diff

from ...derivations.equation import Equation
from ...derivations.least_squares import FitQuantity, LeastSquares
from ...derivations.reductions import Greatest, Least
from ...derivations.unit_text import parse_open
from ...derivations.vocabulary import spelt
from ..axis import Axis, CountedAxis, GroupAxis, RepeatAxis
from ..cells.units import is_alike, named_unit_of
from ..charts import VERMILION, Chart, Series, drawn
from ..column import Column, Formula, Given, Iterated, SheetError
from ..messages.errors import sentence_case
from ..named import member, name_of
from ..quantity import Bounds
from ..workbook import Curve, FigureSpec
from .lines import spaced

STATED = "stated"
POINTS = 65
"""Of a fitted curve: straight lines between so many look like one."""
BEYOND = Rational(1, 20)
"""How far a fitted curve goes on beyond the rows: in shares of their range, or of their distance to zero."""
NONE = (
    "its steps lead nowhere from the stated start: begin nearer; or no parameters make the sum of squares "
    "least, or these rows do not tell them apart"
)


class DeclaredFit:
    """What the name of a fit stands for: an attribute is a cell, ``line.residual``.

    Parameters
    ----------
    name : str
        What it is called.
    axis : Axis
        Of its rows.
    known : mapping of str to Column
        What is declared before it.
    observed, model : Expr
    sought : mapping of Symbol to declaration
        The parameters: `meaning`, `start` and `column` of each, its unit if that is stated.
    u : mapping of Indexed to (Expr, "stated" or None)
        How large the errors of the observed are, by which rows are weighed, and those of what else has some.
    number : str
        Of its equations.
    own : iterator of str
        Numbers of those that only lead there.
    of : GroupAxis or None
        Whose rows have a fit each. What is proved of one holds for each: its columns are those of one fit,
        with sums over the rows of a group.

    Attributes
    ----------
    columns : tuple of Column
    entries : tuple of Equation or Derivation
    aside : tuple of str
        The columns that only lead there, and stated uncertainties, which no table shows.
    curve : Curve
        What tells whether the model describes the rows.
    given : mapping of str to int
        How many points each of several curves has in figures.
    letters : tuple of str
        The columns that are printed by letters of the fit's own, such as s.
    """

    def __init__(
        self,
        name: str,
        axis: Axis,
        known: Mapping[str, Column],
        observed: Indexed,
        model: Expr,
        sought: Mapping[Symbol, Any],
        u: Mapping[Any, Any],
        number: str,
        own: Iterator[str],
        of: GroupAxis | None = None,
    ) -> None:
        self._of, self.given = of, dict[str, int]()
        self._axis, self._known, self._model, self._observed = axis, known, model, known[name_of(observed)]
        _refuse_names(name, sought)
        _refuse_errors(name, observed, model, u, of)
        every = {each: known[name_of(each)] for each in u}
        stated = {each: stated_of(own) for each, own in every.items() if _is_stated(name, own, u[each])}
        others = {each: stated[each].cell if each in stated else size for each, size in u.items()}
        for each, size in u.items():
            if isinstance(size, Expr) and not size.free_symbols & sought.keys():
                _refuse_unit(name, every[each], size, known)
        own_size = others.pop(observed)
        words = {each: said.meaning or str(each) for each, said in sought.items()}
        rows = f"of the {axis.size_name} {axis.name} of each {of.row}" if of else ""
        self._fit = fit = LeastSquares(
            name, observed, model, self._observed.meaning, words, own_size, others,
            axis.index, axis.size, number, own, rows,
        )  # fmt: skip
        if not fit.linear:
            _refuse_curved(name, {} if fit.flat else sought, of)
        self.entries, self.aside = tuple(fit.entries), tuple(part.name for part in fit.helpers)
        self.aside += tuple(column.name for column in stated.values())
        self.curve = Curve(
            fit.names["S"], axis.name, self._observed.name, fit.names["residual"], fit.names["s"],
            tuple(map(str, sought)), own_size is not None,
            {each: fit.names[f"s_{each}"] for each in map(str, sought)},
            tuple(each.claim.label for each in fit.claims),
        )  # fmt: skip
        made = {column.name: column for column in stated.values()}
        for each, said in sought.items():
            unit = {"unit": "" if fit.linear else "1", **said.column}
            made[str(each)] = Column(str(each), of, Given(), meaning=words[each], **unit)
        self._weighed, self._shown = own_size is not None, {f"s_{each}": f"like {each}" for each in sought}
        self._latex = self._printed([made[str(each)] for each in sought])
        for each, foot in fit.feet.items():
            made[str(foot.base)] = self._adjusted(every[each], str(foot.base))
        parts = (*fit.results, *fit.helpers)
        for part in _in_turn(parts, [part.name for part in parts if part.step is not None]):
            start = sought[part.cell].start if part.cell in sought else part.start
            made[part.name] = self._computed(part, made, Integer(0) if start is None else start)
        # Another fit of the same column may have declared them.
        new = [column for column in stated.values() if known.get(column.name) != column]
        self.columns = (*new, *(made[part.name] for part in parts))
        self._rows = made[fit.names["fitted"]], made[fit.names["residual"]]
        self.letters = tuple(part.name for part in parts if part.latex)

    @property
    def normal(self) -> dict[str, Equation]:
        """What an equation of its own says each parameter is, of a model that is linear in them.

        What is computed takes them from the last to the first, by helpers: a proof that begins with these
        would have far more to see through.
        """
        fit = self._fit
        every = fit.normal if fit.linear and self._of is None else {}
        return {str(each): replace(equation, conditions=fit.enough) for each, equation in every.items()}

    def _adjusted(self, own: Column, name: str) -> Column:
        """The true values of what was observed, as the fit has them."""
        latex = own.latex or spelt(own.name)
        head = re.split("[_%]", latex, maxsplit=1)[0]
        hat = latex.replace(head, rf"\tilde{{{head}}}", 1)
        meaning = f"{own.meaning}, adjusted"
        return Column(
            name, self._axis, Given(), own.unit, meaning, hat, f"like {own.name}", positive=own.positive
        )

    def _computed(self, part: FitQuantity, made: Mapping[str, Column], start: Expr | None) -> Column:
        """The column of a part, by its formula or by the steps from a start."""
        column, equation, needs = made.get(part.name) or self._blank(part), part.equation, part.needs
        if part.step is not None:
            first = (
                equation if isinstance(part.cell, Indexed) else equation.at({equation.sides[0]: Integer(0)})
            )
            return replace(column, rule=Iterated(first, part.step, start, NONE))
        if self._of:
            put = self._put(*equation.members, *(condition for condition, _ in needs))
            equation = equation.at(put)
            needs = tuple((condition.xreplace(put), says) for condition, says in needs)
        column = replace(column, rule=Formula(equation), requires=needs)
        return replace(column, unit=column.unit or named_unit_of({**self._known, **made}, column))

    def __getattr__(self, name: str) -> Expr:
        """The cell of one of its quantities."""
        names = {} if name.startswith("_") else self._fit.names
        if name not in names:
            raise AttributeError(f"{name} is nothing that a fit has: there are {', '.join(names)}")
        return next(column.cell for column in self.columns if column.name == names[name])

    def _put(self, *formulas: Any) -> dict[Any, Expr]:
        """What stands in formulas of one fit for that of each group: its numbers, and sums over its rows."""
        if self._of is None:
            return {}
        own = {part.cell for part in (*self._fit.results, *self._fit.helpers) if part.cell.is_Symbol}
        within, over = member(self._of.members), (self._axis.index, 1, self._axis.size)
        put: dict[Any, Expr] = {cell: IndexedBase(cell)[self._of.index] for cell in own}
        put[self._fit.size] = Sum(within, over)
        totals = set[Sum]().union(*(formula.atoms(Sum) for formula in formulas))
        return put | {each: Sum(each.function * within, over) for each in totals}

    def _printed(self, parameters: Iterable[Column]) -> dict[str, str]:
        """LaTeX of the results."""
        latex = {column.name: (column.latex or spelt(column.name)).replace("%s", "") for column in parameters}
        letter = self._observed.latex or spelt(self._observed.name)
        head = re.split("[_%]", letter, maxsplit=1)[0]
        return {
            self._fit.names["fitted"]: letter.replace(head, rf"\hat{{{head}}}", 1),
            self._fit.names["residual"]: rf"\delta {letter}",
            **{f"s_{name}": f"s({each})" for name, each in latex.items()},
            **{f"r_{a}_{b}": f"r({latex[a]}, {latex[b]})" for a, b in combinations(latex, 2)},
        }

    def _blank(self, part: FitQuantity) -> Column:
        """The column of a part, without what it is computed from."""
        names, rows = self._fit.names, isinstance(part.cell, Indexed)
        own = self._observed
        as_observed = {names["fitted"], names["residual"], *(() if self._weighed else [names["s"]])}
        like = f"like {own.name}" if part.name in as_observed else self._shown.get(part.name, "")
        if part.name == names["S"] and not self._weighed:
            like = _squared(own)
        latex = self._latex.get(part.name, part.latex)
        symbol = part.cell.base.label if rows else part.cell
        more: dict[str, Any] = {"is_u": part.name.startswith("s_"), "spare": part.name == names["s"]}
        axis, positive = self._axis if rows else self._of, bool(symbol.is_positive)
        return Column(part.name, axis, Given(), "", part.title, latex, like, positive=positive, **more)

    @property
    def _over(self) -> Column | None:
        """The column that the model names, if it is one."""
        named = sorted({name_of(cell) for cell in self._model.atoms(Indexed)})
        return self._known[named[0]] if len(named) == 1 else None

    @cached_property
    def traced(self) -> tuple[Column, ...]:
        """What the model says between the rows and a little beyond, but not beyond zero: figures show it.

        Two ends are enough of a straight line. There is none of a model that names several columns.
        """
        over, own, called = self._over, self._observed, self._fit.called
        if over is None:
            return ()
        row, size, step = (
            Symbol(f"{called}_{each}", integer=True, positive=True) for each in ("row", "points", "point")
        )
        straight = diff(self._model, over.cell, 2) == 0
        number: Any = 2 if straight else POINTS
        name, counts = f"{called}_curve", tuple[Column, ...]()
        axis: Axis = CountedAxis(name, row, size, step, number)
        if self._of:  # a curve each
            count = Column(f"{called}_each", None, Given("chart"), meaning="points of each curve", exact=True)
            axis = RepeatAxis(name, row, size, of=self._of, step=step, count=count.name)
            self.given[count.name], number, counts = number, count.symbol, (count,)
        low, high = (taken(over.cell, (self._axis.index, 1, self._axis.size)) for taken in (Least, Greatest))
        first, last = (end + way * BEYOND * Min(high - low, Abs(end)) for way, end in ((-1, low), (1, high)))
        x = spaced(first, last, step, number)
        y = self._rows[0]
        across = drawn(f"{axis.name}_x", axis, x, over.unit, over.meaning, display=f"like {over.name}")
        value = self._model.xreplace({over.cell: across[row], **self._put()})
        return (
            *counts,
            across,
            drawn(f"{axis.name}_y", axis, value, own.unit, y.meaning, display=f"like {own.name}"),
        )

    def figures(self, number: int) -> Iterator[FigureSpec]:
        """Points and curve, and what is left over; over the column that the model names, if it is one."""
        own, (fitted, residual) = self._observed, self._rows
        over = self._over or fitted

        def points(up: Column) -> Series:
            return Series(
                over.name, up.name, up.meaning, "points", bars=True, by=self._of.name if self._of else ""
            )

        *_, across, up = self.traced or (over, fitted)
        curve = Series(across.name, up.name, fitted.meaning, "line", VERMILION)
        if self._of and self.traced:
            curve = replace(curve, label="fit of %s", each=True)
        for n, up, more, with_it in (
            (number, own, (curve,), ", with the fit"),
            (number + 1, residual, (), ""),
        ):
            said = f"{up.meaning} over {over.meaning}{with_it}"
            left = up is residual
            chart = Chart(said, over.meaning, up.meaning, (points(up), *more), zero=left, whole=True)
            yield FigureSpec(f"plot_{n}", str(n), f"{sentence_case(said)}.", chart=chart)


def _refuse_names(name: str, sought: Mapping[Symbol, Any]) -> None:
    """Refuse a fit of nothing, and parameters that are called as what a fit has."""
    if not sought:
        raise SheetError(f"the model of {name} names no unknown: write a = unknown('...') above", name)
    own_words = {"s", "S", "fitted", "residual", *(f"s_{each}" for each in sought)}
    for each in sorted(own_words & {str(each) for each in sought}):
        raise SheetError(f"{each} is a word of the fit {name} itself: call the parameter otherwise", each)


def _refuse_errors(
    name: str, observed: Indexed, model: Expr, u: Mapping[Any, Any], of: GroupAxis | None
) -> None:
    """Refuse errors of what the model does not name, and of other variables without those of the observed."""
    others = [each for each in u if each != observed]
    for each in others:
        if not isinstance(each, Indexed) or not model.has(each):
            raise SheetError(f"{name}: u is of columns that the model names; {each} is none", name)
    if others and of is not None:
        raise SheetError(f"{name}: a fit of={of.row} has errors in {observed} alone", name)
    if observed not in u or (others and None in u.values()):
        names = " and ".join(name_of(each) for each in (observed, *others))
        raise SheetError(f"{name}: u says how uncertain {names} are, each of them", name)


def _refuse_unit(name: str, own: Column, u: Expr, known: Mapping[str, Column]) -> None:
    """Refuse a standard uncertainty in another unit than that of its column: a plain number has none."""
    if is_alike(known, own, u):
        return
    unit = own.unit if parse_open(own.written).zero else own.written  # differences have no zero
    raise SheetError(
        f"{name}: u of {own.name} is not in its unit, {unit}, as a standard uncertainty is: "
        f"state it in the folder and write u='stated', or declare one, u_{own.name} = given('{unit}', "
        f"'standard uncertainty of {own.name}')",
        name,
    )


def _refuse_curved(name: str, sought: Mapping[Symbol, Any], of: GroupAxis | None) -> None:
    """Refuse a model that is not linear where nothing says from where its parameters are sought."""
    if of:
        raise SheetError(
            f"the model of {name} is not linear: of each {of.row} there are fits of linear models alone", name
        )
    lost = [str(each) for each, said in sought.items() if said.start is None]
    if lost:
        raise SheetError(
            f"the model of {name} is not linear: say where to begin, {lost[0]} = unknown(..., start=...)",
            name,
        )


def told_apart(columns: Iterable[Column], fits: Sequence[DeclaredFit]) -> tuple[Column, ...]:
    """Columns with the name of its fit in what would be printed as something else is: of two fits, s of each.

    Parameters
    ----------
    columns : iterable of Column
        Of a sheet.
    fits : sequence of DeclaredFit
    """
    columns = tuple(columns)
    printed = {column.name: (column.latex or spelt(column.name)).replace("%s", "") for column in columns}
    often = Counter(printed.values())
    named = dict[str, str]()
    some = any(often[printed[name]] > 1 for fit in fits for name in fit.letters)
    for fit in fits:
        rows = (column.name for column in fit._rows if often[printed[column.name]] > 1)
        named |= dict.fromkeys((*rows, *(fit.letters if some else ())), fit._fit.called)
    return tuple(
        replace(column, latex=_of_fit(column.latex, named[column.name])) if column.name in named else column
        for column in columns
    )


def _of_fit(latex: str, name: str) -> str:
    r"""A symbol with the name of a fit below it.

    >>> [_of_fit(latex, "line") for latex in ("s", "z'%s", "J_{1%s}")]
    ['s_{\\mathrm{line}}', "z'_{\\mathrm{line}%s}", 'J_{1,\\mathrm{line}%s}']
    """
    parts = re.fullmatch(r"(?P<letter>[^_%]+)(_\{(?P<below>.*?)(?P<inner>%s)?\})?(?P<index>%s)?", latex)
    if parts is None:
        return latex  # as its author printed it
    below = f"{parts['below']}," if parts["below"] else ""
    index = parts["inner"] or parts["index"] or ""
    return rf"{parts['letter']}_{{{below}\mathrm{{{name.replace('_', ' ')}}}{index}}}"


def _squared(of: Column) -> str:
    """The unit that squares of a column are shown in, if that is another than in SI."""
    unit = parse_open(of.written)
    if of.written == of.unit or unit.zero or not unit.dimension:
        return ""
    return f"{of.written}^2" if of.written.isalpha() else f"({of.written})^2"


def _is_stated(name: str, of: Column, u: Any) -> bool:
    """Whether it is weighed by what is stated of it, of which something can be stated."""
    if not isinstance(u, str):
        return False
    if u != STATED:
        raise SheetError(f"{name}: u is a formula, or 'stated', not {u!r}", name)
    if not isinstance(of.rule, Given):
        raise SheetError(
            f"{name}: nothing is stated of {of.name}, which is computed: give a formula "
            "of its standard uncertainties instead of 'stated', or leave u out",
            name,
        )
    return True


def stated_of(of: Column) -> Column:
    """The stated standard uncertainties of a column."""
    rule, meaning = Given("uncertainty", Bounds(low=0), of.name), f"standard uncertainty of the {of.meaning}"
    more: dict[str, Any] = {"display": f"like {of.name}", "positive": False, "exact": True}
    return Column(f"u_{of.name}", of.axis, rule, of.unit, meaning, **more)


def _in_turn(parts: Iterable[FitQuantity], first: Iterable[str]) -> Iterator[FitQuantity]:
    """Parts in an order in which each follows from those before it, some of which are known."""
    left = list(parts)
    waiting = {part.name for part in left} - set(first)

    def waits(part: FitQuantity) -> bool:
        named = {str(symbol) for symbol in (part.step or part.equation.value).free_symbols}
        return bool(waiting & named - {part.name})

    while left:
        ready = next(part for part in left if not waits(part))
        yield ready
        left.remove(ready)
        waiting.discard(ready.name)
