"""Expressions printed for mpmath's intervals: rounded outwards, and what is exact not at all."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import mpmath
from mpmath import iv
from sympy import And, Basic, Gt, Lt, Ne, Symbol, cos, exp, lambdify, log, sin, true
from sympy.core.function import Application

from ...derivations.reductions import REDUCTIONS
from ..plan import RowMedian, RowSum

__all__ = ["Run", "differences", "holds", "printed", "sign"]

BITS = 53
"""As many as doubles have: what these cannot decide is not decided here either."""
KNOWN = {
    "exp": iv.exp, "log": iv.log, "sin": iv.sin, "cos": iv.cos, "sqrt": iv.sqrt, "pi": iv.pi, "e": iv.e,
    # A fraction is a quotient of intervals; a double is printed as the parts of its binary number.
    "mpf": lambda x: iv.mpf(mpmath.mp.make_mpf(x) if isinstance(x, tuple) else x),
}  # fmt: skip

Run = Callable[..., list[Any] | None]


def printed(symbols: Sequence[Symbol], bodies: Sequence[Basic]) -> Run | None:
    """A function of intervals that encloses expressions; None if mpmath knows no intervals of a part.

    It returns None where an expression has no value.
    """
    if any(body.has(*REDUCTIONS, RowSum, RowMedian) for body in bodies) or not all(
        isinstance(each, (exp, log, sin, cos)) for body in bodies for each in body.atoms(Application)
    ):
        return None
    function = lambdify(symbols, bodies, modules=[KNOWN, "mpmath"], cse=True)

    def run(*values: Any) -> list[Any] | None:
        iv.prec = BITS
        try:
            found = [iv.mpf(each) for each in function(*map(iv.mpf, values))]
        except (ArithmeticError, ValueError, TypeError, mpmath.libmp.ComplexResult):
            return None
        return found if all(isinstance(each, iv.mpf) for each in found) else None

    return run


def differences(known: Any) -> list[tuple[type[Basic], Any]] | None:
    """A condition as comparisons of differences with zero; None if it is no such."""
    conditions = () if known == true else known.args if isinstance(known, And) else (known,)
    if not all(isinstance(each, (Ne, Gt, Lt)) for each in conditions):
        return None
    return [(type(each), each.args[0] - each.args[1]) for each in sorted(conditions, key=str)]


def sign(found: Any) -> int:
    """The sign of all numbers of an interval; 0 if they have none in common."""
    return 1 if found.a > 0 else -1 if found.b < 0 else 0


def holds(kind: type[Basic], difference: Any) -> bool:
    """Whether a comparison with zero holds for all numbers of an interval."""
    of = sign(difference)
    return bool(of) if kind is Ne else of == (1 if kind is Gt else -1)
