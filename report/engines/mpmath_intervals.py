"""Expressions printed for mpmath's numbers and its intervals: rounded outwards, what is exact not at all."""

from __future__ import annotations

import linecache
from collections.abc import Sequence
from typing import Any

from sympy import And, Basic, Gt, Lt, Ne, Symbol, cos, exp, lambdify, log, sin, true
from sympy.core.function import Application

from ...derivations.reductions import REDUCTIONS
from ..plan.nodes import OverRows
from .interval_functions import Run, running


def source_of(
    symbols: Sequence[Symbol], bodies: Sequence[Basic], common: bool, modules: str = "mpmath"
) -> str:
    """The text of a function of some symbols that returns a list.

    Parameters
    ----------
    bodies : sequence of Basic
        What it returns.
    common : bool
        Whether common parts are computed once.
    modules : str
        ``numpy`` for one of arrays.
    """
    function = lambdify(symbols, bodies, modules=modules, cse=common)
    return "".join(linecache.getlines(function.__code__.co_filename))


def text_of(symbols: Sequence[Symbol], bodies: Sequence[Basic]) -> str | None:
    """A function of intervals that encloses expressions; None if mpmath knows no intervals of a part."""
    if any(body.has(*REDUCTIONS, OverRows) for body in bodies) or not all(
        isinstance(each, (exp, log, sin, cos)) for body in bodies for each in body.atoms(Application)
    ):
        return None
    return source_of(symbols, bodies, True)


def printed(symbols: Sequence[Symbol], bodies: Sequence[Basic]) -> Run | None:
    """The function of it."""
    text = text_of(symbols, bodies)
    return None if text is None else running(text)


def differences(known: Any) -> list[tuple[str, Any]] | None:
    """A condition as comparisons of differences with zero; None if it is no such."""
    conditions = () if known == true else known.args if isinstance(known, And) else (known,)
    if not all(isinstance(each, (Ne, Gt, Lt)) for each in conditions):
        return None
    return [(type(each).__name__, each.args[0] - each.args[1]) for each in sorted(conditions, key=str)]
