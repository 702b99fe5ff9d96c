"""Words of a method that takes its equations from a ledger, where each stands once, with its proof.

class Drop(Method, ledger=LEDGER, rows="tests", size="n_tests"):
    v = measured(VOCABULARY["v"], "impact speed", positive=True)
    first, second = pairs(index="p", size="n_pairs")
    with standing({V[1]: first(v), V[2]: second(v)}):
        x_m1 = by(eq12b, "approach of the first test")

Name, unit, meaning and LaTeX are those of the quantity that an equation determines; the rows follow from what
it names, as in every formula of a method.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from sympy import Expr, Symbol, sympify

from ...derivations.equation import Equation
from ...derivations.vocabulary import Quantity
from ..axis import RepeatAxis
from ..cells.units import named_unit_of
from ..charts import drawn
from ..column import Column, Formula, Given, Iterated, Limit, Root, SheetError
from ..named import name_of
from ..quantity import Bounds
from .body import MethodBody
from .errors import current, named_next, told_together
from .fitted import stated_of
from .lines import TakenLine, stated_unit

# --- what symbols of a ledger stand for --------------------------------------------------------------------


@contextmanager
def standing(*cells: Mapping[Any, Any]) -> Iterator[None]:
    """Let symbols of the ledger stand for cells: ``with standing({V[1]: first(v), V[2]: second(v)}):``.

    In the lines below, what :func:`by` determines stands for itself from there on, too.

    Parameters
    ----------
    *cells : mapping of Expr to Expr
        By quantities of the ledger: names of the body, or an equation of the ledger, whose last side it is.
    """
    body = current()
    level = {}
    for old, new in (pair for each in cells for pair in each.items()):
        level[old] = sympify(body.places.put(new).value if isinstance(new, Equation) else new)
    body.places.append(level)
    try:
        yield
    finally:
        body.places.pop()


# --- lines -------------------------------------------------------------------------------------------------


def _determined(equation: Equation) -> Any:
    """The quantity that an equation determines."""
    return equation.sides[0] if equation.defines is None else equation.defines


def _word(body: MethodBody, of: Any) -> Quantity | None:
    """What the ledger says of a quantity."""
    return body.ledger.vocabulary.find(of) if body.ledger and of is not None else None


@dataclass(frozen=True)
class _By(TakenLine):
    """What an equation determines."""

    equation: Any = None
    otherwise: Equation | None = None
    needs: tuple[Any, str] | None = None
    over: Any = None
    rule: Mapping[str, Any] = field(default_factory=dict)

    def parts(self, body: MethodBody) -> tuple[Any, ...]:
        return body.places.put(self.equation).members if isinstance(self.equation, Equation) else ()

    def declare(self, body: MethodBody, name: str) -> Expr:
        if not isinstance(self.equation, Equation) or body.ledger is None:
            said = "by() takes an equation of the ledger, class X(Method, ledger=...)"
            raise SheetError(f"{name}: {said}", name)
        if name in body.announced:
            cell, where = body[name], body.places.merged
            own = _determined(self.equation)
            own = own if str(own) == name else None  # which stands for what is called so
            of = next((old for old, new in where.items() if new == cell), own)
        else:
            of = _determined(self.equation)
        column = self._column(body, name, of)
        known = {} if of is None else {of: column.cell}
        requires = () if self.needs is None else ((body.places.put(self.needs[0], known), self.needs[1]),)
        alongside = () if self.over is None else (body.column(name_of(self.over)),)
        column = replace(column, rule=self._rule(body, column, known), requires=requires, alongside=alongside)
        body.columns[name] = column
        body.places[-1] |= known
        if self.otherwise is not None:
            body.instead(column, self.otherwise)
        return column.cell

    def _column(self, body: MethodBody, name: str, of: Any) -> Column:
        """Its column, without what it is computed by."""
        said: dict[str, Any] = {"meaning": self.equation.title, "positive": False}
        if word := _word(body, of):
            said |= {each: getattr(word, each) for each in ("meaning", "unit", "latex", "positive")}
        said |= {"meaning": self.meaning} if self.meaning else {}
        said |= stated_unit(name, self.unit)
        said |= {each: told for each, told in self.column.items() if told not in ("", None)}
        held = body.places.put(self.rule.get("form", self.equation))
        parts = (body.places.put(self.rule["step"]),) if "step" in self.rule else held.sides
        column = Column(name, body.axis_of(*(parts if self.rule else parts[-1:])), Given(), **said)
        if "unit" not in said:
            known = {**body.columns, name: column}
            column = replace(column, unit=named_unit_of(known, replace(column, rule=Formula(held))))
        return replace(column, display=column.display or body.shown_like(column.unit))

    def _rule(self, body: MethodBody, column: Column, known: Mapping[Any, Any]) -> Any:
        put = partial(body.places.put, own=known)
        equation = put(self.equation)
        if "step" in self.rule:
            return Iterated(equation, **{each: put(part) for each, part in self.rule.items()})
        if not self.rule:
            return Formula(equation)
        own = {"form": self.equation, "unknown": column.symbol, "value": column.symbol, **self.rule}
        own |= {end: sympify(own[end]) for end in ("low", "high", "start")}
        as_it_is = {each: own.pop(each) for each in ("unknown", "turning_by") if each in own}
        return Root(equation, **{each: put(part) for each, part in own.items()}, **as_it_is)


@dataclass(frozen=True)
class _Sketch(TakenLine):
    """A column that charts alone ask for, or how many points it has."""

    formula: Any = None
    needs: tuple[Any, str] | None = None

    def declare(self, body: MethodBody, name: str) -> Expr:
        of, value = None, self.formula
        if isinstance(value, int):
            column = Column(name, None, Given("chart"), meaning=self.meaning, exact=True)
            body.drawn_given[name] = value
        else:
            if isinstance(value, Equation):
                of, value = _determined(value), body.places.put(value).value
            axis, word = body.axis_of(value), _word(body, of)
            if axis is None:
                raise SheetError(f"{name} is a single number, which is no column of a chart", name)
            more = stated_unit(name, self.unit) or {"unit": word.unit if word else "1"}
            more = {"display": body.shown_like(more["unit"]), **more}
            requires = () if self.needs is None else (self.needs,)
            column = drawn(name, axis, value, meaning=self.meaning, requires=requires, **more)
        body.drawn.append(column)
        body.places[-1] |= {} if of is None else {of: column.cell}
        return column.cell


@dataclass(frozen=True)
class _Uncertain(TakenLine):
    """The standard uncertainties that are stated of a column."""

    of: Any = None

    def declare(self, body: MethodBody, name: str) -> Expr:
        column = stated_of(body.column(name_of(self.of)))
        said = {each: own for each, own in {"meaning": self.meaning, **self.column}.items() if own}
        body.columns[name] = column = replace(column, name=name, **said)
        return column.cell


@told_together
def by(
    equation: Equation,
    meaning: str = "",
    unit: str = "",
    *,
    otherwise: Equation | None = None,
    needs: tuple[Any, str] | None = None,
    over: Any = None,
    spare: bool = False,
    positive: bool | None = None,
    is_u: bool = False,
    latex: str = "",
    root: Mapping[str, Any] | None = None,
    step: Any = None,
    start: Any = None,
    none: str = "",
    two: str = "",
) -> Any:
    """Declare what an equation of the ledger determines; it is written there, and nowhere again.

    Its symbols stand for what is called so in the body, or for what :func:`standing` says. What has the unit
    of the only measured column that has it is shown like that.

    Parameters
    ----------
    equation : Equation
        Of which the last side is computed. One that is solved (`root`) or iterated (`step`) finds what was
        announced by :func:`unknown` under this name, or what it `defines`.
    meaning, unit, latex : str
        As for :func:`let`, if they are others than those of the quantity in the vocabulary of the ledger.
    otherwise : Equation, optional
        What holds where an optional parameter that the first names is left out.
    needs : tuple of (relation, str), optional
        What must hold for a row to have a value, and what is said where it does not.
    over : Expr, optional
        A column: sums leave out the rows in which that has no value.
    spare : bool
        Whether nothing is odd about cells without what it needs: no data must have it.
    positive : bool, optional
        Whether it is positive wherever it has a value; as the vocabulary says, without.
    is_u : bool
        Whether it is an uncertainty itself, of which no more digits are shown than of any other.
    root : mapping of str to Expr, optional
        How the equation is solved: what a :class:`~loopsheet.report.column.Root` takes, at least ``low``,
        ``high`` and ``start``.
    step, start : Expr, optional
        The next value and the first one of what is put into its own equation again until it stays.
    none, two : str
        What it means that there is no root, or that no value stays, and that there are several.
    """
    rule = dict(root or {}) if step is None else {"step": step, "start": sympify(start)}
    rule |= {word: said for word, said in (("none", none), ("two", two)) if said}
    column = {"latex": latex, "positive": positive, "spare": spare, "is_u": is_u}
    return named_next(_By(meaning, unit, column, equation, otherwise, needs, over, rule))


@told_together
def sketch(formula: Any, meaning: str, unit: str = "", *, needs: tuple[Any, str] | None = None) -> Any:
    """Declare what charts alone ask for: it is no cell of the report, and no number of an equation is spent.

    Parameters
    ----------
    formula : Expr, Equation or int
        In names of the body, or an equation of the ledger, whose last side it is; a whole number says how
        many points something has.
    meaning, unit, needs
        As for :func:`by`; of a formula in names of the body the unit is stated, if it has one.
    """
    return named_next(_Sketch(meaning, unit, {}, formula, needs))


@told_together
def uncertainty(of: Any, quantity: Quantity | None = None) -> Any:
    """Declare the standard uncertainties that are stated of a column, as a column of its own.

    Parameters
    ----------
    of : Expr
        What is given or measured.
    quantity : Quantity, optional
        The word of the ledger for it.
    """
    said = {"latex": quantity.latex} if quantity else {}
    return named_next(_Uncertain(quantity.meaning if quantity else "", "", said, of))


@told_together
def numbered(rows: str, count: Any, *, of: Any, index: str, size: str, step: str) -> Symbol:
    """Take several rows for each row of a column: what names their number, from 1, has a value for each.

    Parameters
    ----------
    rows : str
        What they are called, ``points``.
    count : Expr
        The parameter that says how many.
    of : Expr
        The column.
    index, size, step : str
        What the running number of all, how many there are, and the running number within one row are called.
    """
    body = current()
    axis = body.axis_of(of)
    if axis is None:
        raise SheetError(f"{of} is a single number: rows are numbered of what has a value for each row")
    row, many, number = (Symbol(each, integer=True, positive=True) for each in (index, size, step))
    body.axes.append(RepeatAxis(rows, row, many, of=axis, step=number, count=name_of(count)))
    return number


@told_together
def expected(inside: Any, *cells: Any, says: str = "", silent: bool = False) -> None:
    """Say where cells are expected: one outside keeps its value, and is marked and counted.

    Parameters
    ----------
    inside : Equation, relation or tuple of two numbers
        An inequality of the ledger for one quantity, which each of the cells then is; what is to hold, in
        names of the body or of the ledger; or the ends, in SI.
    *cells : Expr
        Columns or numbers of the body.
    says : str
        What is odd outside; an equation says it itself.
    silent : bool
        Whether a row outside tells nothing of what it rests on, so that no measurement is suspected.
    """
    body = current()
    for cell in cells:
        column = body.column(name_of(cell))
        if isinstance(inside, Equation):
            (quantity,) = inside.members[-1].free_symbols
            limit = Limit.of(inside.at({quantity: column.cell}))
        else:
            kept = Bounds(*inside) if isinstance(inside, tuple) else body.places.put(inside)
            limit = Limit(kept, says, silent=silent)
        body.columns[column.name] = replace(column, limits=(*column.limits, limit))
