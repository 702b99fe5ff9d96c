"""The lines of a method: what each declares, its formula as it was typed, and its unit."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from sympy import Expr, Float, Function, Number, Rational, sign, sympify
from sympy.core.numbers import ComplexInfinity, ImaginaryUnit, Infinity, NaN, NegativeInfinity
from sympy.core.relational import Relational

from ...derivations.equation import Equation
from ...derivations.reductions import Member
from ...derivations.unit_text import ParsedUnit, UnitError, coherent, parse_open
from ...derivations.vocabulary import Quantity, amiss
from ..column import Limit, SheetError
from ..quantity import LARGEST, SMALLEST, Bounds, behind

FUNCTIONS = (
    *("exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh"),
    *("Abs", "Max", "Min"),
)
"""Besides powers; as sympy calls them."""
_ANY_SIGN = "positive=False in its Quantity"
MOST_POINTS = 1000
"""Of one curve; beyond, a picture shows no more of it."""


@dataclass(frozen=True)
class Declaration:
    """What a line of the body says; its name comes with the assignment."""

    meaning: str
    unit: str
    column: Mapping[str, Any]

    def __post_init__(self) -> None:
        latex = self.column.get("latex", "")
        for what, text in (("meaning", self.meaning), ("unit", self.unit), ("LaTeX", latex)):
            if not isinstance(text, str):
                raise SheetError(f"a {what} is a text in quotes, not {text!r}")
        if self.unit.strip() and not _is_unit(self.unit) and self.meaning.strip() and _is_unit(self.meaning):
            raise SheetError(
                f"{self.unit!r} is no unit, and {self.meaning!r}, the meaning, is: have they changed places?"
            )
        if wrong := amiss(latex):
            raise SheetError(f"latex={latex!r} {wrong}")


class TakenLine(Declaration):
    """What puts a column of its own into a body."""

    def parts(self, body: Any) -> tuple[Any, ...]:
        """The formulas that it is made of."""
        return ()

    def declare(self, body: Any, name: str) -> Expr:
        """Do so; what the name then stands for."""
        raise NotImplementedError


@dataclass(frozen=True)
class InputLine(Declaration):
    """What is given or measured; a word of a ledger may stand in the place of the unit."""

    bounds: Bounds = field(default_factory=Bounds)
    default: str | None = None
    is_measured: bool = False
    of: Any = None  # of what is measured: what rows() returned
    example: str = ""
    is_constant: bool = False
    optional: bool = False
    otherwise: Any = None  # what it is where it is left out
    asked: str = ""  # what who gives it is told it is
    quantity: Quantity | None = field(default=None, init=False)  # of a ledger, in the place of a unit

    def __post_init__(self) -> None:
        if isinstance(self.unit, Quantity):
            object.__setattr__(self, "quantity", self.unit)
            object.__setattr__(self, "meaning", self.meaning or self.unit.meaning)
            object.__setattr__(self, "unit", self.unit.unit)
        super().__post_init__()
        if not self.meaning.strip():
            raise SheetError(f"say what it is, behind the unit: {self.unit!r}, 'length of the rod'")
        if not self.unit.strip():
            object.__setattr__(self, "unit", "1")
        default: Any = self.default
        if default is not None and not isinstance(default, str):
            written = f"{default}{behind(self.unit)}"
            raise SheetError(f"a default is a text, as printed and with its unit: default={written!r}")

    @property
    def beyond(self) -> str:
        """How to let in more than its word does, which says so without its author having written it."""
        unsaid = self.quantity and self.quantity.positive and not self.column["positive"]
        return f"; with {_ANY_SIGN} the method lets any number in" if unsaid else ""


@dataclass(frozen=True)
class ComputedLine(Declaration):
    """What a formula computes, or a root is sought for."""

    sides: tuple[Expr, ...] = ()  # of a definition the last alone
    label: str = ""
    because: str = ""
    ends: Mapping[str, Any] | None = None  # of a root: the interval that it lies in, and where it is begun
    is_margin: bool = False  # which has to be 0 or more


@dataclass(frozen=True)
class PointsLine(Declaration):
    """Points between two ends, themselves among them."""

    low: Expr
    high: Expr
    number: int
    label: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        if not isinstance(self.number, int) or not 2 <= self.number <= MOST_POINTS:
            raise SheetError(f"number is a whole number from 2 to {MOST_POINTS}, not {self.number!r}")


@dataclass(frozen=True)
class UnknownLine(Declaration):
    """What a root or a fit will find; what is wrong is told in its own line, not in that of the fit."""

    start: Expr | None = None
    bounds: Bounds = field(default_factory=Bounds)
    of: Any = None  # a column of whose rows there is one of each

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.unit:
            size_of("", self.unit)
        start = self.start
        if start is not None and start.is_number and not self.bounds.allow(float(start)):
            said = f"has to be {self.bounds}{behind(self.unit or '1')}: positive, low and high say so"
            raise SheetError(f"the start, {float(start):.15g}, {said}")


@dataclass(frozen=True)
class FitLine:
    """A model whose unknowns make a sum of squares least."""

    observed: Any
    model: Expr
    u: Mapping[Any, Any]
    label: str
    figures: bool
    of: Any = None


def none_of(of: Any, word: str, more: str = "") -> str:
    """What is said of ``of=`` where no `word`, such as ``rows``, returned it; texts are seen."""
    said = f"of={of!r}" if isinstance(of, str) else f"of={getattr(of, 'row', of)}"
    quotes = f": write of={of}, without quotes" if isinstance(of, str) else ""
    return f"{said} is none of what {word}() returned{more}{quotes}"


def size_of(name: str, unit: str) -> ParsedUnit:
    """A unit that a line states, read."""
    try:
        return parse_open(unit)
    except UnitError as error:
        hint = f"; {error.suggestion}" if error.suggestion else ""
        kind = "is unknown" if error.code == "LS421" else "cannot be read"
        whose = f"{name}: " if name else ""
        raise SheetError(f"{whose}the unit {error.text!r} {kind}{hint}", name) from None


def _is_unit(text: str) -> bool:
    try:
        return bool(parse_open(text))
    except UnitError:
        return False


def unit_in_si(size: ParsedUnit) -> dict[str, Any]:
    """The unit of a column, in SI, and the one that it is shown in, if that is another."""
    si = coherent(size)
    return {"unit": si} if si == size.text else {"unit": si, "display": size.text}


def in_si(place: Expr, size: ParsedUnit) -> Expr:
    """A number in a unit, in SI; what names quantities is in SI."""
    return place * Rational(size.scale) + Rational(size.zero) if place.is_number else place


def stated_unit(name: str, unit: str) -> dict[str, Any]:
    """The same, if there is one."""
    return unit_in_si(size_of(name, unit)) if unit else {}


def with_unit(name: str, sought: UnknownLine) -> UnknownLine:
    """The parameter of a fit with its unit, if that is stated, its start and its bounds in SI."""
    start, bounds = sought.start, sought.bounds
    if sought.unit:
        size = size_of(name, sought.unit)
        refuse_zero(name, sought, size)
        start = start if start is None else in_si(start, size)
        bounds = bounds.within(size.scale, size.zero)
    column = {**stated_unit(name, sought.unit), **sought.column}
    if bounds != Bounds() and not (column["positive"] and bounds == Bounds(low=0, low_open=True)):
        column["limits"] = (Limit(bounds, f"outside of what is said of {name}"),)
    return replace(sought, column=column, start=start, bounds=bounds)


def let_in(word: Quantity, bounds: Bounds) -> Bounds:
    """What is allowed of an input, without what its word does not let in: formulas count on that. In SI."""
    below = [end for end in (bounds.low, bounds.high) if end is not None and end < 0]
    if word.positive and below:
        said = f"{word.name} is positive, as its word says: no end is {below[0]:g}; {_ANY_SIGN} lets it be"
        raise SheetError(said)
    if word.positive and bounds.low is None:  # low=0 lets 0 in, where formulas have the same value or none
        bounds = replace(bounds, low=0, low_open=True)
    if word.low is not None and (bounds.low is None or bounds.low < word.low):
        bounds = replace(bounds, low=word.low, low_open=False)
    if word.high is not None and (bounds.high is None or bounds.high > word.high):
        bounds = replace(bounds, high=word.high, high_open=False)
    return replace(bounds, integer=bounds.integer or word.whole)


def refuse_zero(name: str, said: Declaration, size: ParsedUnit) -> None:
    """Refuse what is positive in a unit whose zero is another than that of SI."""
    if size.zero and said.column["positive"]:
        raise SheetError(f"{name}: above which zero? say low=..., in {said.unit}", name)


def spaced(first: Expr, last: Expr, place: Expr, number: Expr) -> Expr:
    """Of so many points from the first to the last, all equally far apart, the one at a place, from 1."""
    return (first * (number - place) + last * (place - 1)) / (number - 1)


def exact(formula: Any) -> Expr:
    """A formula with decimal fractions as they were typed: 0.27027... was 1/3.7, 0.30000000000000004 0.3."""
    if isinstance(formula, str):
        raise SheetError(f"{formula!r} is a text: a formula stands there without quotes")
    formula = sympify(formula)
    if isinstance(formula, Relational):
        raise SheetError(f"{formula} is no formula of real numbers; what is claimed is that two are equal")
    if isinstance(formula, Expr) and formula.has(NaN, ComplexInfinity):
        raise SheetError("a formula that divides by 0 has no value")
    if not isinstance(formula, Expr) or formula.has(ImaginaryUnit, Infinity, NegativeInfinity):
        raise SheetError(f"{formula} is no formula of real numbers")
    if not all(number.is_zero or SMALLEST <= abs(number) < LARGEST for number in formula.atoms(Number)):
        raise SheetError("a number of the formula is beyond 1.8e308, or below 2.2e-308: no double holds it")
    for part in formula.atoms(Function):
        if part.func.__name__ not in FUNCTIONS and not isinstance(part, Member):
            known = ", ".join(sorted(FUNCTIONS))
            said = f"{part.func}{', of which the derivative of Abs is made,' if part.func is sign else ''}"
            raise SheetError(f"{said} is none of the functions that every engine has: {known}")
    typed = {}
    for number in formula.atoms(Float) - {Float(0)}:
        own, value = repr(float(number)), float(number)
        for of, text in ((value, f"{value:.12g}"), (1 / value, f"{1 / value:.12g}")):
            if len(text) + 4 < len(own) and math.isclose(float(text), of, rel_tol=1e-15):
                typed[number] = Rational(text) if of == value else 1 / Rational(text)
                break
    found: Expr = formula.xreplace(typed)
    return found


def checked_label(name: str, label: object, others: Iterable[Equation]) -> str:
    """What a method calls an equation; refused if it is no text of one line, or another one is called so."""
    if not isinstance(label, str) or not label.isprintable():
        raise SheetError(f"{name}: the label of an equation is a text of one line in quotes, not {label!r}")
    if any(other.label == label for other in others):
        raise SheetError(f"{name}: another equation is called {label} already; a label has exactly one")
    return label
