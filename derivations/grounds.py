"""What rests on what in a ledger: the assumptions behind a claim, and claims that rest on themselves.

A premise that says what a claim says is that claim, whatever it is called: with its sides swapped, its terms
moved or multiplied by a number. Whether two equations say the same is seen from their values.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator
from functools import lru_cache
from itertools import combinations
from typing import Any

import mpmath
from sympy import Expr, Indexed, Integral, Symbol
from sympy.core.function import AppliedUndef

from .equation import Derivation, Equation, Kind, Ledger, Step
from .evaluation import UNDEFINED, NotEvaluable, Tape
from .reductions import REDUCTIONS
from .sums import in_terms

_DIGITS, _POINTS = 30, 3
_ALIKE = mpmath.mpf(10) ** -20


def is_assumed(premise: Equation) -> bool:
    """Whether a premise is a definition or an assumption, and so what it is an instance of."""
    return Kind.CLAIM not in (premise.kind, premise.origin.kind)


# --- what an equation says -------------------------------------------------------------------------------


@lru_cache(maxsize=8192)
def says(said: Equation, equation: Equation) -> bool:
    """Whether an equation says all that another one does, up to a number that multiplies it.

    `said`: what may be contained in the other.
    """
    wanted, there = (_differences(each) for each in (said, equation))
    neighbours = [wanted.get((n, n + 1)) for n in range(len(said.members) - 1)]
    return bool(neighbours) and all(
        one is not None and any(_proportional(one, other) for other in there.values()) for one in neighbours
    )


def _proportional(one: tuple[Any, ...], other: tuple[Any, ...]) -> bool:
    ratios = [a / b for a, b in zip(one, other, strict=True)]
    return all(abs(ratio - ratios[0]) <= _ALIKE * abs(ratios[0]) for ratio in ratios)


@lru_cache(maxsize=512)
def _differences(equation: Equation) -> dict[tuple[int, int], tuple[Any, ...]]:
    """The differences of any two members at some points; those that vanish or have no value are left out.

    A symbol has the same value in whatever equation it stands. So has an integral, a sum or an unknown
    function: to work one out is more than to write an equation in another way.
    """
    if not all(isinstance(side, Expr) for side in equation.sides):
        return {}
    sides = [_with_symbols(side) for side in equation.sides]
    symbols = sorted({symbol for side in sides for symbol in side.free_symbols}, key=str)
    found: dict[tuple[int, int], tuple[Any, ...]] = {}
    with mpmath.workdps(_DIGITS):
        program = Tape(symbols)
        for i, j in combinations(range(len(sides)), 2):
            values = []
            try:
                group = program.add([sides[i] - sides[j]])
                for point in range(_POINTS):
                    program.start([_drawn(symbol, point) for symbol in symbols])
                    values += program.values(group)
            except (NotEvaluable, *UNDEFINED):
                continue
            if all(mpmath.isfinite(value) and value != 0 for value in values):
                found[i, j] = tuple(values)
    return found


def _with_symbols(side: Expr) -> Expr:
    """Symbols in the place of cells and of what is not worked out."""
    side = in_terms(side)
    for kind in ((Integral, *REDUCTIONS), (AppliedUndef,), (Indexed,)):
        parts = side.atoms(*kind)
        side = side.xreplace({p: Symbol(f"[{p}]", positive=True if p.is_positive else None) for p in parts})
    return side


def _drawn(symbol: Symbol, point: int) -> Any:
    rng = random.Random(f"{symbol} {point}")
    size = rng.randint(3, 9) if symbol.is_integer else 1 + rng.random()
    return mpmath.mpf(size if symbol.is_positive or point % 2 else -size)


# --- the graph -------------------------------------------------------------------------------------------


def circle(entry: Equation | Derivation, ledger: Ledger) -> str:
    """Draw the way on which a claim rests on itself, ``(2) -> (1) -> (2)``; empty if there is none."""
    if isinstance(entry, Equation):
        return ""
    steps = _steps((entry, *ledger.entries))
    claims = [each.claim for each in ledger.entries if isinstance(each, Derivation)]
    if entry.claim not in claims:
        claims.append(entry.claim)

    def below(claim: Equation) -> Iterator[tuple[str, Equation]]:
        """What a claim rests on directly, with what it is called there."""
        for premise in steps[claim].premises if claim in steps else ():
            if premise.origin in steps:
                yield premise.label, premise.origin
            elif is_assumed(premise):
                for other in claims:
                    if any(says(other, assumed) for assumed in _assumed(premise)):
                        yield f"{premise.label} = {other.label}", other

    seen: set[Equation] = set()

    def search(claim: Equation, path: tuple[str, ...]) -> str:
        for called, other in below(claim):
            if other == entry.claim:
                return " -> ".join((*path, called))
            if other not in seen:
                seen.add(other)
                if found := search(other, (*path, called)):
                    return found
        return ""

    return search(entry.claim, (entry.claim.label,))


def stated(equation: Equation, ledger: Ledger) -> bool:
    """Whether a ledger says what an equation, or the one that it is an instance of, says."""
    entries = {entry for entry in ledger.entries if isinstance(entry, Equation)}
    return equation.origin in entries or equation.origin in _steps(ledger.entries)


def supported(equation: Equation, by: Equation, ledger: Ledger) -> bool:
    """Whether an equation is another one, for other symbols perhaps, or is derived from it."""
    steps, seen, left = _steps(ledger.entries), set(), [equation.origin]
    while left:
        if (each := left.pop()) == by.origin:
            return True
        if each not in seen and each in steps:
            left += [premise.origin for premise in steps[each].premises]
        seen.add(each)
    return False


def behind(equations: Iterable[Equation], ledger: Ledger) -> set[Equation]:
    """Some equations and all that a ledger derives them from, however far back."""
    chains = {entry.claim: entry.steps for entry in ledger.entries if isinstance(entry, Derivation)}
    ends = {step.claim: claim for claim, steps in chains.items() for step in steps}
    found: set[Equation] = set()
    left = list(equations)
    while left:
        if (each := left.pop()) not in found:
            found.add(each)
            whole = ends.get(each, each)  # a step inside of a chain comes with all of it
            left += [whole, *(premise.origin for step in chains.get(whole, ()) for premise in step.premises)]
    return found


def _steps(entries: Iterable[Equation | Derivation]) -> dict[Equation, Step]:
    """The step that ends in each claim, those of earlier entries before others."""
    found: dict[Equation, Step] = {}
    for entry in entries:
        for step in entry.steps if isinstance(entry, Derivation) else ():
            found.setdefault(step.claim, step)
    return found


def _assumed(premise: Equation) -> Iterator[Equation]:
    """What is assumed with a premise: its origin; and itself, unless it is the origin for some number."""
    yield premise.origin
    put_in = [old for where in premise.renamed for old, _ in where]
    if not put_in or not all(old.is_integer for old in put_in):
        yield premise
