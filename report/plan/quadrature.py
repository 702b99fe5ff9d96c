"""Integrals in terms that every engine has: sums over the nodes of a Gauss rule.

The integrand is a power -p, 0 < p < 1, of what is zero at both ends, as the time of a way is that begins and
ends at rest. Its infinite ends are taken out as the weight (1 - u^2)^-p, u from -1 to 1, of which the nodes
are the zeros of Gegenbauer's polynomials. What is left is smooth, and the rule's error falls as the power
-2n of the sum of the half axes of an ellipse, foci at the ends, within which it is regular.

Sources: P J Davis, P Rabinowitz, Methods of Numerical Integration, 1984, 2.7 and 4.6; DLMF 3.5.22, 18.9.1
and 18.16.8 for a first guess of the zeros.
"""

from __future__ import annotations

from functools import lru_cache
from math import ceil
from typing import Any

import mpmath
from sympy import Add, Expr, Float, Integral, Rational

_A_DIGIT = Rational(10, 9)
"""The nodes that make one more digit right, where those half axes sum to 10^(9/20) = 2.8 or more."""


def in_nodes(integral: Integral, digits: int) -> Expr:
    """An integral as a sum.

    `integral`: one of :func:`~loopsheet.report.named.is_summed`.
    `digits`: how many are right, if the integrand to the power -1/p, over the product of the distances from
    both ends, is regular and not zero in an ellipse around the way whose half axes sum to 2.8 halves of it.
    """
    ((variable, low, high),) = integral.limits
    inner, power = integral.function.args
    terms = (
        weight * inner.xreplace({variable: (1 - share) * low + share * high}) ** power
        for share, weight in _rule(power, ceil(_A_DIGIT * digits), digits)
    )
    return (high - low) * Add(*terms)


@lru_cache
def _rule(power: Rational, n: int, digits: int) -> tuple[tuple[Expr, Expr], ...]:
    """Of each node its share of the way, and its part of the sum."""
    with mpmath.workdps(digits + 20):
        a = mpmath.mpf(power.p) / power.q
        squares = [1 / (3 + 2 * a)]  # as the others, but for a factor of both parts that may be zero
        squares += [k * (k + 2 * a) / ((2 * k + 2 * a) ** 2 - 1) for k in range(2, n)]
        norm = mpmath.fprod(squares) * mpmath.beta(a + 1, mpmath.mpf(1) / 2)
        found = []
        for i in range(n):
            u = -mpmath.cospi((i + (2 * a + 3) / 4) / (n + a + mpmath.mpf(1) / 2))
            for _ in range(digits.bit_length() + 2):  # Newton's, of which each doubles the digits
                last, _, slope = _polynomial(u, squares)
                u -= last / slope
            _, before, slope = _polynomial(u, squares)
            weight = norm / (slope * before) * (1 - u**2) ** -a / 2
            found.append((Float((1 + u) / 2, digits + 2), Float(weight, digits + 2)))
        return tuple(found)


def _polynomial(u: Any, squares: list[Any]) -> tuple[Any, Any, Any]:
    """The polynomial whose zeros are the nodes, the one before it, and its slope; by their recurrence."""
    before, last, slope_before, slope = 1, u, 0, 1
    for square in squares:
        slope_before, slope = slope, last + u * slope - square * slope_before
        before, last = last, u * last - square * before
    return last, before, slope
