"""Euler's beta functions and integrals in terms that every engine has: products, powers, an exponential.

B(a, 1/2) is sqrt(pi) Gamma(a)/Gamma(a + 1/2). The argument is moved up, factor by factor, to where the series
of the ratio in 1/w, w = z - 1/4, converges to the wanted digits.

The incomplete one up to z is z^a/a times Gauss's function F(a, 1/2; a + 1; z), which is F(2a, 1; a + 1; w) at
w = (1 - sqrt(1 - z))/2, from 0 to 1/2: a polynomial by Chebyshev's.

Integrals are sums over the nodes of a Gauss rule. The integrand is a power -p, 0 < p < 1, of what is zero at
both ends, as the time of a way is that begins and ends at rest. Its infinite ends are taken out as the weight
(1 - u^2)^-p, u from -1 to 1, of which the nodes are the zeros of Gegenbauer's polynomials. What is left is
smooth, and the rule's error falls as the power -2n of the sum of the half axes of an ellipse, foci at the
ends, within which it is regular.

Sources: A Erdélyi, F G Tricomi, Pacific J Math 1 (1951) 133, for the ratio; DLMF 5.11.8 for its logarithm;
DLMF 8.17.7 and M Abramowitz, I A Stegun, Handbook of Mathematical Functions, 15.3.22, for both functions F;
P J Davis, P Rabinowitz, Methods of Numerical Integration, 1984, 2.7 and 4.6; DLMF 3.5.22, 18.9.1 and 18.16.8
for a first guess of the zeros.
"""

from __future__ import annotations

from functools import cache, lru_cache, reduce
from itertools import count
from math import ceil, log10
from operator import mul
from typing import Any

import mpmath
from sympy import Add, Expr, Float, Integer, Integral, Rational, bernoulli, beta, betainc, exp, pi, sqrt

SPECIAL = (beta, betainc, Integral)

DOUBLE, EXACT = 18, 60
"""The digits that are right: enough for doubles, and for the judge at 50."""
_A_DIGIT = Rational(10, 9)
"""The nodes that make one more digit right, where those half axes sum to 10^(9/20) = 2.8 or more."""


def in_elementary_terms(expression: Any, digits: int = DOUBLE) -> Any:
    """An expression without beta functions and integrals.

    `expression`: its beta functions are B(a, 1/2), a > 0, and that up to z, 0 <= z <= 1, of a fraction a; its
    integrals are those of :func:`in_nodes`.
    `digits`: how many are right.
    """
    if not expression.has(*SPECIAL):
        return expression
    parts = [in_elementary_terms(argument, digits) for argument in expression.args]
    if isinstance(expression, beta):
        a, half = parts
        return _beta(a, half, digits)
    if isinstance(expression, betainc):
        a, half, low, z = parts
        return _incomplete(a, half, low, z, digits)
    if isinstance(expression, Integral):
        return in_nodes(Integral(*parts), digits)
    return expression.func(*parts)


def _incomplete(a: Expr, half: Expr, low: Expr, z: Expr, digits: int) -> Expr:
    if half != Rational(1, 2) or low != 0 or not a.is_Rational:
        raise NotImplementedError(
            f"the beta function of {a} and {half} from {low}: that of 1/2 from 0 is known"
        )
    w = (1 - sqrt(1 - z)) / 2
    return z**a / a * Add(*(c * w**n for n, c in enumerate(_of_gauss(a, digits))))


@lru_cache
def _of_gauss(a: Rational, digits: int) -> tuple[Expr, ...]:
    """The coefficients of a polynomial that is F(2a, 1; a + 1; w) from 0 to 1/2.

    By Chebyshev's, of which each makes the error 3 + sqrt(8) times as small, for F is singular at 1. A cell
    of a spreadsheet has no room for its power series.
    """
    with mpmath.workdps(digits + 20):
        first = 2 * mpmath.mpf(a.p) / a.q

        @cache  # every coefficient asks for the same places
        def gauss(w: Any) -> Any:
            return mpmath.hyp2f1(first, 1, first / 2 + 1, w)

        for terms in count(ceil(digits / log10(3 + 8**0.5)) + 1):  # more for a large a
            found, error = mpmath.chebyfit(gauss, [0, mpmath.mpf(1) / 2], terms, error=True)
            if error < mpmath.mpf(10) ** -digits:
                break
        return tuple(Float(each, digits + 2) for each in reversed(found))


def _beta(a: Expr, half: Expr, digits: int) -> Expr:
    if a.is_number and half.is_number:
        number: Expr = beta(a, half).evalf(digits)
        return number
    if half != Rational(1, 2):
        raise NotImplementedError(f"the beta function of {half}: that of 1/2 is known")
    moved = _moved(digits)
    w = a + moved - Rational(1, 4)
    series = Add(*(c / w**n for n, c in _coefficients(digits)))
    factors = ((a + j + half) / (a + j) for j in range(moved))
    return sqrt(pi) * reduce(mul, factors, Integer(1)) / (sqrt(w) * exp(series))


@lru_cache
def _moved(digits: int) -> int:
    """How far the argument is moved up: the least term of the series there is smaller than asked for."""
    return digits // 2


@lru_cache
def _coefficients(digits: int) -> tuple[tuple[int, Expr], ...]:
    """Of the series of the logarithm of Gamma(z + 1/2)/Gamma(z) over that of sqrt(w), by powers of 1/w."""
    quarter, smallest = Rational(1, 4), Rational(1, 10**digits)
    found = list[tuple[int, Expr]]()
    for n in range(2, 4 * digits, 2):
        c = 2 * bernoulli(n + 1, quarter) / (n * (n + 1))
        if abs(c) < smallest * Rational(_moved(digits)) ** n:
            return tuple(found)
        found.append((n, c))
    raise AssertionError("the series does not become small enough")


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
