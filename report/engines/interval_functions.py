"""Printed functions of mpmath's intervals, and what is certain of the intervals that they return."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import mpmath
from mpmath import iv

from .kernels import function_of

BITS = 53
"""As many as doubles have: what these cannot decide is not decided here either."""
KNOWN = {
    "exp": iv.exp, "log": iv.log, "sin": iv.sin, "cos": iv.cos, "sqrt": iv.sqrt, "pi": iv.pi, "e": iv.e,
    # A fraction is a quotient of intervals; a double is printed as the parts of its binary number.
    "mpf": lambda x: iv.mpf(mpmath.mp.make_mpf(x) if isinstance(x, tuple) else x),
}  # fmt: skip

Run = Callable[..., list[Any] | None]


@lru_cache(maxsize=256)
def running(text: str) -> Run:
    """The function of a text that :func:`~loopsheet.report.engines.mpmath_intervals.text_of` prints.

    It returns None where an expression has no value.
    """
    function = function_of(text, {**vars(mpmath), **KNOWN})

    def run(*values: Any) -> list[Any] | None:
        iv.prec = BITS
        try:
            found = [iv.mpf(each) for each in function(*map(iv.mpf, values))]
        except (ArithmeticError, ValueError, TypeError, mpmath.libmp.ComplexResult):
            return None
        return found if all(isinstance(each, iv.mpf) for each in found) else None

    return run


def sign(found: Any) -> int:
    """The sign of all numbers of an interval; 0 if they have none in common."""
    return 1 if found.a > 0 else -1 if found.b < 0 else 0


def holds(kind: str, difference: Any) -> bool:
    """Whether a comparison with zero, by the name of its class, holds for all numbers of an interval."""
    of = sign(difference)
    return bool(of) if kind == "Unequality" else of == (1 if kind == "StrictGreaterThan" else -1)
