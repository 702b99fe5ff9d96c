"""Decides whether a claim holds: a symbolic residual of zero *and* 50-digit agreement over the domain.

Neither half is trusted alone. A computer algebra system may simplify on assumptions that fail somewhere;
numbers may agree by chance. A claim is proved when both say so, refuted when the numbers show a point of
the domain where its premises hold and it does not, and undecided otherwise. Undecided is a failure.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from functools import lru_cache
from typing import Any

import mpmath
from sympy import (
    Add,
    Basic,
    Expr,
    Indexed,
    Integral,
    Sum,
    Symbol,
    expand,
    expand_log,
    expand_power_base,
    fraction,
    lambdify,
    powsimp,
    simplify,
    solve,
    together,
)
from sympy.core.function import AppliedUndef

from . import symbols
from .equation import Derivation, Equation, Kind, Ledger, Step

__all__ = ["DIGITS", "POINTS", "Proof", "Status", "StepProof", "check_step", "prove", "prove_equation"]

DIGITS = 50
POINTS = 24
"""Seeded points of the domain at which every claim is evaluated; the least that counts is 20."""
_AGREES = mpmath.mpf(10) ** (10 - DIGITS)
"""Largest relative residual that counts as zero: ten guard digits for the arithmetic in between."""
_TRIES = 60 * POINTS
_NUDGE = mpmath.mpf(2) ** -60
_TERMS = 7
"""How many terms a symbolic sum gets when it is evaluated."""


class Status(Enum):
    """What is known of an equation."""

    DEFINITION = "definition"
    ASSUMPTION = "assumption"
    PROVED = "proved"
    CORRECTED = "proved with a correction of the print"
    REFUTED = "refuted"
    UNDECIDED = "undecided"

    @property
    def passes(self) -> bool:
        """Whether a report may rest on it."""
        return self not in (Status.REFUTED, Status.UNDECIDED)


@dataclass(frozen=True)
class StepProof:
    """What was found of one step."""

    step: Step
    status: Status
    points: int
    worst: float
    """Largest relative residual over the points."""
    symbolic: bool
    counterexample: Mapping[str, str] = field(default_factory=dict)
    sides: tuple[str, str] = ("", "")
    """Both sides of the claim at the counterexample."""
    why: str = ""

    @property
    def sentence(self) -> str:
        """The finding, in words."""
        if self.status is Status.REFUTED:
            where = ", ".join(f"{name} = {value}" for name, value in self.counterexample.items())
            return f"at {where} the sides are {self.sides[0]} and {self.sides[1]}"
        if self.status is Status.UNDECIDED:
            return self.why
        return f"residual 0; {self.points} points at {DIGITS} digits agree within {self.worst:.0e}"


@dataclass(frozen=True)
class Proof:
    """What is known of one equation of the ledger."""

    equation: Equation
    status: Status
    steps: tuple[StepProof, ...] = ()
    remark: str = ""
    """How the print differs from what was proved."""


# --- algebra -------------------------------------------------------------------------------------------


def _linear_sums(expression: Any) -> Any:
    """Split every sum into terms and take out what does not run with its index."""
    if not isinstance(expression, Basic) or not expression.has(Sum):
        return expression
    if isinstance(expression, Sum):
        index, low, high = expression.limits[0]
        total = Add()
        body = expand(expand_log(expand_power_base(_linear_sums(expression.function))))
        for term in Add.make_args(body):
            outer, inner = term.as_independent(index, as_Add=False)
            inner = powsimp(inner)
            total += outer * ((high - low + 1) if inner == 1 else Sum(inner, (index, low, high)))
        return total
    return expression.func(*(_linear_sums(argument) for argument in expression.args))


def _vanishes(residual: Expr) -> bool:
    """Whether the residual is identically zero; False means that it was not seen to be."""
    if residual.has(Sum):
        residual = _linear_sums(residual)
    # From cheap to dear; the numerator over one denominator settles what the model's algebra asks for.
    attempts = (
        expand,
        lambda r: expand(powsimp(expand(fraction(together(expand_power_base(r)))[0]))),
        lambda r: simplify(fraction(together(expand_power_base(r)))[0]),
        simplify,
    )
    return any(attempt(residual) == 0 for attempt in attempts)


def _solve(left: Expr, right: Expr, unknown: Expr) -> Expr | None:
    """Solve left = right for the unknown; None where there is not exactly one positive solution."""
    if left == unknown and not right.has(unknown):
        return right
    if right == unknown and not left.has(unknown):
        return left
    difference = _linear_sums(left - right)
    if not difference.has(Integral):
        difference = expand(difference) if difference.has(Sum) else fraction(together(difference))[0]
    rest, factor = difference.subs(unknown, 0), difference.diff(unknown)
    if not factor.has(unknown) and factor != 0:
        return -rest / factor
    found = [solution for solution in solve(left - right, unknown) if solution.is_positive]
    return found[0] if len(found) == 1 else None


def _flat(expressions: Iterable[Any]) -> dict[Indexed, Symbol]:
    """Plain symbols for the indexed ones that no sum binds: algebra on them is faster and safer."""
    found: dict[Indexed, Symbol] = {}
    for expression in expressions:
        bound = {limit[0] for total in expression.atoms(Sum) for limit in total.limits}
        for cell in expression.atoms(Indexed):
            if not set(cell.indices) & bound:
                label = cell.base.label
                found[cell] = Symbol(f"{label}_{cell.indices[0]}", **label.assumptions0)
    return found


@dataclass(frozen=True)
class _System:
    """A step made ready: plain symbols, premises solved."""

    premises: tuple[tuple[Expr, Expr], ...]
    claim: tuple[Expr, ...]
    conditions: tuple[Expr, ...]
    solution: dict[Expr, Expr]
    """What each eliminated symbol is, in terms of the free ones."""
    chain: tuple[tuple[Expr, Expr], ...]
    """The same in the order of evaluation, each in terms of the ones before it."""
    multiplier: Expr | None
    names: dict[Symbol, Expr]


def _prepare(step: Step) -> _System | str:
    """Solve the premises in turn; a sentence instead where that cannot be done."""
    equations = (*step.premises, step.claim)
    flat = _flat(
        [side for equation in equations for side in equation.sides]
        + [condition for equation in equations for condition in equation.conditions]
        + list(step.eliminate)
    )

    def plain(expression: Any) -> Any:
        return expression.xreplace(flat)

    solution: dict[Expr, Expr] = {}

    premises: list[tuple[Expr, Expr]] = []
    chain: list[tuple[Expr, Expr]] = []
    for premise, unknown in zip(step.premises, map(plain, step.eliminate), strict=False):
        left, right = plain(premise.sides[0]), plain(premise.sides[-1])
        premises.append((left, right))
        solved = _solve(_settle(left, solution), _settle(right, solution), unknown)
        if solved is None:
            return f"{premise.label} could not be solved for {unknown}"
        solution = {known: value.xreplace({unknown: solved}) for known, value in solution.items()}
        solution[unknown] = solved
        chain.insert(0, (unknown, solved))
    multiplied = step.premises[len(step.eliminate) :]
    if step.multiplier is not None:
        premises.append((plain(multiplied[0].sides[0]), plain(multiplied[0].sides[-1])))
    elif multiplied:
        return f"{multiplied[0].label} is a premise, but no step says what it is solved for"
    return _System(
        premises=tuple(premises),
        claim=tuple(plain(side) for side in step.claim.sides),
        conditions=tuple(plain(c) for equation in equations for c in equation.conditions),
        solution=solution,
        chain=tuple(chain),
        multiplier=None if step.multiplier is None else plain(step.multiplier),
        names={plain_symbol: cell for cell, plain_symbol in flat.items()},
    )


def _symbolic(system: _System) -> bool:
    """Whether every difference of the claim vanishes once the premises are put in."""
    sides = [_settle(side, system.solution) for side in system.claim]
    if system.multiplier is not None:
        left, right = (_settle(side, system.solution) for side in system.premises[-1])
        difference = (sides[0] - sides[1]) - _settle(system.multiplier, system.solution) * (left - right)
        return len(sides) == 2 and _vanishes(difference)
    return all(_vanishes(a - b) for a, b in zip(sides, sides[1:], strict=False))


def _settle(expression: Expr, solution: Mapping[Expr, Expr]) -> Expr:
    """Put the solution in and integrate; sums stay (sympy would search closed forms for them)."""
    settled = expression.xreplace(dict(solution))
    return settled.xreplace({integral: _integrate(integral) for integral in settled.atoms(Integral)})


@lru_cache(maxsize=64)
def _integrate(integral: Integral) -> Expr:
    """Integrate once; the same work appears in a premise and in the claim."""
    return integral.doit()


# --- numbers -------------------------------------------------------------------------------------------


def _span(symbol: Symbol, names: Mapping[Symbol, Expr]) -> tuple[float, float]:
    quantity = symbols.find(names.get(symbol, symbol))
    return (0.5, 2.0) if quantity is None else quantity.span


def _function(given: list[Symbol], chain: list[tuple[Expr, Expr]]) -> Callable[[list[Any]], list[Any]]:
    """Evaluate the eliminated symbols one after the other from what is given."""
    names = list(given)
    links = []
    for unknown, value in chain:
        links.append(lambdify(names, value, modules="mpmath"))
        names = [*names, unknown]

    def run(values: list[Any]) -> list[Any]:
        found: list[Any] = []
        for link in links:
            found.append(link(*values, *found))
        return found

    return run


def _numeric(system: _System, rng: random.Random) -> tuple[int, float, dict[str, str], tuple[str, str]]:
    """Evaluate the claim where its premises hold.

    Returns the number of points, the largest relative residual and, if one is not zero, the point and
    both sides there.
    """
    functions = {f: value for f, value in system.chain if isinstance(f, AppliedUndef)}
    chain = [(unknown, value.xreplace(functions)) for unknown, value in system.chain if unknown not in functions]
    solved = [unknown for unknown, _ in chain]
    claim = [side.xreplace(functions) for side in system.claim]
    premises = [(a.xreplace(functions), b.xreplace(functions)) for a, b in system.premises]
    if system.multiplier is not None:
        left, right = premises.pop()
        claim = [claim[0] - claim[1], system.multiplier * (left - right)]
    everything = [*(v for _, v in chain), *(s for pair in premises for s in pair), *claim, *system.conditions]
    sizes = {limit[2] for e in everything for total in e.atoms(Sum) for limit in total.limits}
    series = sorted({cell.base.label for e in everything for cell in e.atoms(Indexed)}, key=str)
    free = sorted({s for e in everything for s in e.free_symbols if isinstance(s, Symbol)}
                  - set(solved) - sizes - set(series), key=str)
    given = [*sorted(sizes, key=str), *series, *free]
    first = _function(given, chain)
    gap = lambdify([*given, *solved], [a - b for a, b in premises], modules="mpmath")
    second = lambdify(
        [*given, *solved],
        [system.conditions, claim, [term for side in claim if side.is_Add for term in side.args]],
        modules="mpmath",
    )
    names = system.names
    counted, worst = 0, mpmath.mpf(0)
    for _ in range(_TRIES):
        lists = [[_draw(rng, *_span(label, names)) for _ in range(_TERMS + 1)] for label in series]
        point = [_draw(rng, *_span(symbol, names)) for symbol in free]
        drawn = [*(_TERMS for _ in sizes), *lists, *point]
        try:
            found = first(drawn)
            if any(
                isinstance(value, mpmath.mpc) or (symbol.is_positive and value < 0)
                for symbol, value in zip(solved, found, strict=True)
            ):
                continue
            gaps = gap(*drawn, *found)
            # What a gap is small against: what it becomes when the solved symbols are a little off.
            off = gap(*drawn, *(value * (1 + mpmath.mpf(i + 2) / 1000) + _NUDGE for i, value in enumerate(found)))
            held, sides, terms = second(*drawn, *found)
        except (ZeroDivisionError, ValueError, OverflowError):
            continue
        if not all(held) or any(isinstance(value, mpmath.mpc) for value in [*sides, *terms]):
            continue
        if any(abs(here) > _AGREES * abs(there) for here, there in zip(gaps, off, strict=True)):
            continue  # the premises do not hold here after all: no witness for or against the claim
        scale = max(abs(term) for term in [*sides, *terms])
        for a, b in zip(sides, sides[1:], strict=False):
            residual = abs(a - b) / scale if scale else mpmath.mpf(0)
            if residual > _AGREES:
                where = dict(zip([*free, *solved], [*point, *found], strict=True))
                return counted, float(residual), _readable(where, names), (_short(a), _short(b))
            worst = max(worst, residual)
        counted += 1
        if counted == POINTS:
            break
    return counted, float(worst), {}, ("", "")


def _draw(rng: random.Random, low: float, high: float) -> mpmath.mpf:
    return mpmath.mpf(low) + (mpmath.mpf(high) - mpmath.mpf(low)) * mpmath.mpf(rng.random())


def _short(value: Any) -> str:
    return mpmath.nstr(value, 6)


def _readable(point: Mapping[Symbol, Any], names: Mapping[Symbol, Expr]) -> dict[str, str]:
    return {str(names.get(symbol, symbol)): _short(value) for symbol, value in point.items()}


# --- verdicts ------------------------------------------------------------------------------------------


@lru_cache(maxsize=256)
def check_step(step: Step) -> StepProof:
    """Decide one step.

    The same step always gets the same points: the seed is the claim's label.
    """
    system = _prepare(step)
    if isinstance(system, str):
        return StepProof(step, Status.UNDECIDED, 0, 0.0, False, why=system)
    with mpmath.workdps(DIGITS):
        counted, worst, point, sides = _numeric(system, random.Random(step.claim.label))
    if point:
        return StepProof(step, Status.REFUTED, counted, worst, False, point, sides)
    if counted < POINTS:
        return StepProof(
            step, Status.UNDECIDED, counted, worst, False, why=f"only {counted} points of its domain were found"
        )
    if not _symbolic(system):
        why = "the numbers agree, but the residual was not reduced to zero"
        return StepProof(step, Status.UNDECIDED, counted, worst, False, why=why)
    return StepProof(step, Status.PROVED, counted, worst, True)


def _check_print(step: Step) -> str:
    """Say what is wrong with the print of a claim whose meaning was proved; empty if nothing is."""
    claim = step.claim
    assert claim.printed is not None
    as_printed = Equation(claim.number, claim.printed, claim.because, part=claim.part)
    if claim.defines is not None and not any(side.has(claim.defines) for side in as_printed.sides):
        return (
            f"as printed, {claim.label} does not contain {claim.defines}, which it should determine: "
            f"it repeats {as_printed.sides[0]}"
        )
    found = check_step(Step(as_printed, step.premises, step.eliminate, step.says, step.multiplier))
    return f"as printed, {claim.label} fails: {found.sentence}" if found.status is Status.REFUTED else ""


def prove_equation(entry: Equation | Derivation, known: frozenset[Equation] = frozenset()) -> Proof:
    """Decide one entry of a ledger, given the equations that stand before it."""
    if isinstance(entry, Equation):
        if entry.kind is Kind.CLAIM:
            return Proof(entry, Status.UNDECIDED, remark="a claim without a derivation")
        return Proof(entry, Status(entry.kind.value))
    steps: list[StepProof] = []
    reached = set(known)
    for step in entry.steps:
        found = check_step(step)
        loose = [
            premise.label
            for premise in step.premises
            if premise.origin.kind is Kind.CLAIM and premise.origin not in reached
        ]
        if loose:
            why = f"rests on {', '.join(loose)}, not proved before"
            found = StepProof(step, Status.UNDECIDED, found.points, found.worst, found.symbolic, why=why)
        steps.append(found)
        if found.status.passes:
            reached.add(step.claim)
    verdicts = {found.status for found in steps}
    for verdict in (Status.REFUTED, Status.UNDECIDED):
        if verdict in verdicts:
            return Proof(entry.claim, verdict, tuple(steps))
    remark = _check_print(entry.steps[-1]) if entry.claim.printed is not None else ""
    return Proof(entry.claim, Status.CORRECTED if remark else Status.PROVED, tuple(steps), remark)


def prove(ledger: Ledger, begin: Callable[[Equation], None] | None = None) -> tuple[Proof, ...]:
    """Decide every equation of a ledger, in its order; nothing may rest on what comes later.

    Parameters
    ----------
    ledger : Ledger
    begin : callable, optional
        Told of each equation before it is decided: proofs take seconds.
    """
    proofs: list[Proof] = []
    known: set[Equation] = set()
    for entry in ledger.entries:
        if begin is not None:
            begin(entry.claim if isinstance(entry, Derivation) else entry)
        proof = prove_equation(entry, frozenset(known))
        proofs.append(proof)
        if proof.status.passes:
            known.add(proof.equation)
    return tuple(proofs)
