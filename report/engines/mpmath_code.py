"""Prints expressions as functions of mpmath's numbers."""

from __future__ import annotations

import linecache
from collections.abc import Sequence

from sympy import Basic, Symbol, lambdify


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
