"""The step towards a root, as algebra: every engine prints the same one.

Householder's method of order four needs three derivatives of the equation; sympy makes them, so that no
engine and no model types a derivative.
"""

from __future__ import annotations

from sympy import Expr, Symbol, diff

__all__ = ["derivatives", "householder"]


def derivatives(function: Expr, unknown: Symbol) -> tuple[Expr, Expr, Expr, Expr]:
    """The function and its first three derivatives."""
    first = diff(function, unknown)
    second = diff(first, unknown)
    return function, first, second, diff(second, unknown)


def householder(f: Expr, f1: Expr, f2: Expr, f3: Expr) -> Expr:
    """What is subtracted from the unknown: the third Householder step, of fourth order.

    Source: A. S. Householder, The Numerical Treatment of a Single Nonlinear Equation, McGraw-Hill, 1970.
    """
    return 3 * f * (2 * f1**2 - f * f2) / (6 * f1**3 - 6 * f * f1 * f2 + f**2 * f3)
