"""Checks of how a source prints its equations: each looks for one kind of slip and names its evidence.

Every function here, told what to look at, returns a check; a check takes the ledger and returns an
:class:`Erratum`, or None where the print is right. What an erratum says is put together from what was found.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import wraps
from typing import Any, Concatenate, ParamSpec

import mpmath
from sympy import And, Expr, Indexed, Integer, Piecewise, Symbol, expand

from .cells import Cells
from .dimensions import Dimensions, dimension_of_unit, power, product
from .equation import Equation, Erratum, Kind, Ledger
from .evaluation import UNDEFINED, Tape, is_real
from .proved import DIGITS, enumerated, said
from .sampling import AGREES
from .space import Space, short
from .text import Wording
from .vocabulary import Quantity, Vocabulary

Check = Callable[[Ledger], "Erratum | None"]
Say = Callable[[Any], str]
_P = ParamSpec("_P")
_TRIES = 400


def _told(find: Callable[Concatenate[Ledger, Say, _P], Erratum | None]) -> Callable[_P, Check]:
    """What a function looks for in a ledger, with its words for formulas, once it is told of what."""

    @wraps(find)
    def told(*args: _P.args, **named: _P.kwargs) -> Check:
        return lambda ledger: find(ledger, Wording(ledger.vocabulary).text, *args, **named)

    return told


@dataclass(frozen=True)
class Citation:
    """A place of the source that names an equation as the origin of a quantity."""

    where: str
    number: str
    quantity: Expr


def _values(
    expressions: list[Any], seed: str, vocabulary: Vocabulary
) -> Iterator[tuple[dict[str, str], list[Any]]]:
    """Yield seeded points of the symbols' spans, with the expressions' values there."""
    cells = Cells.of(expressions)
    plain = [cells.plain(expression) for expression in expressions]
    space = Space(plain, cells.names, vocabulary)
    with mpmath.workdps(DIGITS):
        program = Tape(space.symbols)
        group = program.add(plain)
        for point in space.points(seed, _TRIES):
            program.start(point)
            try:
                values = program.values(group)
            except UNDEFINED:
                continue
            if all(isinstance(value, bool) or is_real(value) for value in values):
                yield space.describe(point), values


@_told
def check_overlap(ledger: Ledger, text: Say, equation: Equation) -> Erratum | None:
    """Look for an approach at which two branches of a law both apply and differ.

    Kind ``overlap``.
    """
    law = next(side for side in equation.members if isinstance(side, Piecewise))
    (first, when_first), (second, when_second) = law.args[:2]
    for point, (a, b, both) in _values(
        [first, second, And(when_first, when_second)], equation.label, ledger.vocabulary
    ):
        if both and abs(a - b) > AGREES * max(abs(a), abs(b)):
            return Erratum(
                equation.label,
                "overlap",
                f"The branches of {equation.label} overlap: both {text(when_first)} and "
                f"{text(when_second)} hold on a whole interval, and without saying which phase is meant "
                f"{text(equation.members[0])} has two values there.",
                f"at {said(point)} the branches give {short(a)} and {short(b)}",
            )
    return None


@_told
def check_range(
    ledger: Ledger, text: Say, equation: Equation, scale: int, symbol: Symbol, known: tuple[str, Any, Any]
) -> Erratum | None:
    """Compare a printed range with a published one of the same quantity times `scale`.

    Kind ``range``.
    """
    low_side, high_side = equation.members[0].args
    low, high = scale * low_side.lhs, scale * high_side.rhs
    name, known_low, known_high = known
    if (low, high) == (known_low, known_high):
        return None
    quantity = text(high_side.lhs)
    meant_low, meant_high = (text(end / Integer(scale)) for end in (known_low, known_high))
    return Erratum(
        equation.label,
        "range",
        f"The range in {equation.label} is that of Meyer's exponent {text(symbol)} = {scale} {quantity} "
        f"in [{text(low)}, {text(high)}]. {name} is [{text(known_low)}, {text(known_high)}], which would "
        f"mean {meant_low} <= {quantity} <= {meant_high}.",
        f"{equation.label} prints {text(equation.members[0])}",
    )


@_told
def check_count(
    ledger: Ledger,
    text: Say,
    group: tuple[Equation, ...],
    unknowns: tuple[Expr, ...],
    claimed: tuple[Expr, Expr],
) -> Erratum | None:
    """Count equations and unknowns of a system written for k = 1, 2, ...; compare with what is said.

    Kind ``count``.
    """
    (k,) = set().union(*(count.free_symbols for count in claimed))
    equations = len(group) * k
    present = [u for u in unknowns if any(side.has(u) for equation in group for side in equation.sides)]
    counted = sum(k if u.has(k) else 1 for u in present)
    if (equations - claimed[0], counted - claimed[1]) == (0, 0):
        return None
    return Erratum(
        group[0].number,
        "count",
        f"{group[0].number} has {text(equations)} equations and {text(counted)} unknowns, "
        f"not {text(claimed[0])} and {text(claimed[1])} as is said.",
        f"the unknowns are {', '.join(map(text, present))}",
    )


@_told
def check_spurious(
    ledger: Ledger, text: Say, equation: Equation, solve_for: Expr, approach: Equation, condition: Expr
) -> Erratum | None:
    """Look for a point where an equation holds but the approach it stands for is negative.

    Kind ``condition``. The equation is linear in `solve_for`; `condition` is what must be positive and is
    not said to be.
    """
    if any(expand(stated.gts - stated.lts - condition) == 0 for stated in equation.conditions):
        return None
    residual = equation.sides[0] - equation.sides[1]
    root = -residual.xreplace({solve_for: Integer(0)}) / residual.diff(solve_for)
    depth_there = approach.value.xreplace({solve_for: root})
    for point, (value, depth, margin) in _values(
        [root, depth_there, condition], equation.label, ledger.vocabulary
    ):
        if value > 0 and depth < 0 and margin < 0:
            return Erratum(
                equation.label,
                "condition",
                f"{equation.label} also vanishes where {text(condition)} is negative. There "
                f"{approach.label} gives a negative approach, so such a root belongs to no impact. "
                "The condition is not printed.",
                f"at {said({**point, text(solve_for): short(value)})} {equation.label} holds, and "
                f"{approach.label} gives {text(approach.members[0])} = {short(depth)}",
            )
    return None


@_told
def check_determined(ledger: Ledger, text: Say, number: str, unknowns: tuple[Expr, ...]) -> Erratum | None:
    """Look whether the printed lines of a numbered group determine every unknown once.

    Kind ``determined``.
    """
    lines = [equation for equation in ledger.equations() if equation.number == number]
    left = [(line.printed or line.members)[0] for line in lines]
    missing = [u for u in unknowns if u not in left]
    twice = [text(u) for n, u in enumerate(left) if u in left[:n]]
    if not missing:
        return None
    meant = [line.label for line in lines if line.defines in missing]
    repeats = f"prints {enumerated(twice)} twice and " if twice else ""
    advice = f"; what is meant is {enumerated(meant)}" if meant else ""
    return Erratum(
        number,
        "determined",
        f"{number} {repeats}does not give {enumerated(map(text, missing))}{advice}.",
        f"left-hand sides as printed: {', '.join(map(text, left))}",
    )


def _holds(equation: Equation, quantity: Expr) -> bool:
    """Whether an equation is about the quantity of one test, not of test k."""
    return any(quantity in side.free_symbols and not side.atoms(Indexed) for side in equation.sides)


@_told
def check_citation(ledger: Ledger, text: Say, citation: Citation) -> Erratum | None:
    """Look whether the equation that a place names contains the quantity that is said to come from it.

    Kind ``citation``.
    """
    lines = [equation for equation in ledger.equations() if equation.number == citation.number]
    if any(side.has(citation.quantity) for line in lines for side in line.sides):
        return None
    holders = [
        equation.label
        for equation in ledger.equations()
        if equation.kind is Kind.CLAIM and not equation.own and _holds(equation, citation.quantity)
    ]
    where = f"the claims that do are {enumerated(holders)}" if holders else "no claim does"
    inside = sorted({text(s) for line in lines for side in line.sides for s in side.free_symbols})
    return Erratum(
        citation.where,
        "citation",
        f"{citation.where}: {citation.number} does not contain {text(citation.quantity)}; {where}.",
        f"{citation.number} holds {enumerated(inside)}" if inside else f"there is no {citation.number}",
    )


@_told
def check_whose(
    ledger: Ledger, text: Say, law: Equation, symbol: Symbol, where: str, said: str
) -> Erratum | None:
    """Look which branch of a law holds a symbol that a passage attributes to the `said` phase.

    Kind ``attribution``.
    """
    phases = ("compression", "restitution")
    branches = next(side for side in law.members if isinstance(side, Piecewise)).args
    laws = dict(zip(phases, (body for body, _ in branches), strict=False))
    holders = [phase for phase, body in laws.items() if body.has(symbol)]
    if said in holders:
        return None
    return Erratum(
        where,
        "attribution",
        f"The {where} attribute the exponent that is found to the {said} phase. It is {text(symbol)}, "
        f"which stands only in the {enumerated(holders)} branch of {law.label}.",
        f"{said}: {text(laws[said])}",
    )


@_told
def check_units(
    ledger: Ledger, text: Say, law: Equation, printed: Mapping[Symbol, str | None]
) -> Erratum | None:
    """Find the units of a law's coefficients from the law; compare with those that are printed, if any are.

    Kind ``unit``. `law` says force = branches, each with one of the coefficients as a factor.
    """
    branches = next(side for side in law.members if isinstance(side, Piecewise)).args
    of_force, of_approach = (_quantity(s, ledger.vocabulary) for s in (law.members[0], *law.members[0].args))
    dimensions, force = Dimensions(ledger.vocabulary), dimension_of_unit(of_force.unit)
    found = {}
    for symbol in printed:
        (body,) = (body for body, _ in branches if body.has(symbol))
        rest = dimensions.of(body.xreplace({symbol: Integer(1)}))
        found[symbol] = product(force, power(rest, Integer(-1)))
    names = {str(s): s for body, _ in branches for s in body.free_symbols}
    wrong = [s for s, unit in printed.items() if unit is None or dimension_of_unit(unit, names) != found[s]]
    if not wrong:
        return None
    units = {s: _unit(s, found[s], ledger.vocabulary) for s in wrong}
    prints = [f"{text(s)} in {printed[s] or 'no unit'}" for s in wrong]
    return Erratum(
        law.label,
        "unit",
        f"By {law.label} {enumerated(f'{text(s)} has the unit {unit}' for s, unit in units.items())}"
        + (", so that they are not of one kind" if len(set(units.values())) > 1 else "")
        + f". The source prints {enumerated(prints)}.",
        " and ".join(f"{text(q.symbol)} is in {q.unit}" for q in (of_force, of_approach)),
    )


def _unit(symbol: Symbol, found: Any, vocabulary: Vocabulary) -> str:
    """The vocabulary's name for a dimension that was found; it must agree with the law."""
    if Dimensions(vocabulary).of_cell(symbol) != found:
        raise ValueError(f"the vocabulary gives {symbol} another unit than its law does")
    return _quantity(symbol, vocabulary).unit


def _quantity(symbol: Expr, vocabulary: Vocabulary) -> Quantity:
    quantity = vocabulary.find(symbol)
    if quantity is None:
        raise ValueError(f"the vocabulary does not say what {symbol} is")
    return quantity


@_told
def check_missing(
    ledger: Ledger, text: Say, where: str, formulas: tuple[Equation, ...], printed: tuple[Symbol, ...]
) -> Erratum | None:
    """Look whether a place can be computed from what is printed.

    Kind ``missing``. `formulas` compute what the place shows, the later ones from the earlier ones.
    """
    known = set(printed)
    needs: dict[Symbol, list[str]] = {}
    for formula in formulas:
        for symbol in sorted(formula.value.free_symbols - known, key=str):
            needs.setdefault(symbol, []).append(formula.label)
        known.add(formula.members[0])
    if not needs:
        return None
    by = enumerated(f"{text(symbol)} by {enumerated(labels)}" for symbol, labels in needs.items())
    return Erratum(
        where,
        "missing",
        f"{where} cannot be computed from what is printed: it needs {by}, and the source gives no value "
        f"of {'it' if len(needs) == 1 else 'either' if len(needs) == 2 else 'any of them'}.",
        f"printed are {enumerated(map(text, printed))}",
    )
