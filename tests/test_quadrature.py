"""Integrals as sums: against closed forms, and against another program's nodes."""

from __future__ import annotations

import mpmath
import pytest
from sympy import Expr, Integral, Rational, Symbol, exp, log
from sympy.integrals.quadrature import gauss_jacobi

from loopsheet.derivations.contact import damping
from loopsheet.derivations.equation import Equation
from loopsheet.report.plan.special import DOUBLE, EXACT, _rule, in_nodes
from loopsheet.report.sheet import Column, Formula, Sheet, SheetError

x, a = Symbol("x", positive=True), Symbol("a", positive=True)


@pytest.mark.parametrize("power", [Rational(-3, 5), Rational(-1, 2), Rational(-1, 7)])
def test_nodes_and_weights_are_those_of_another_program(power: Rational) -> None:
    shares, weights = zip(*_rule(power, 20, DOUBLE), strict=True)
    nodes, own = gauss_jacobi(20, power, power, DOUBLE)
    for share, weight, node, other in zip(shares, weights, nodes, own, strict=True):
        assert abs(2 * share - 1 - node) < 1e-17
        assert abs(2 * weight * (1 - node**2) ** power / other - 1) < 1e-16


@pytest.mark.parametrize("digits", [DOUBLE, EXACT])
@pytest.mark.parametrize("power", [Rational(-3, 5), Rational(-1, 2), Rational(-1, 3)])
def test_a_beta_function_to_all_digits(power: Rational, digits: int) -> None:
    """Of a x - x^2, on which the rule is exact; from 0 to a it is Euler's."""
    found = in_nodes(Integral((a * x - x**2) ** power, (x, 0, a)), digits).subs(a, 3)
    with mpmath.workdps(digits + 5):
        p = mpmath.mpf(power.p) / power.q
        exact = mpmath.mpf(3) ** (2 * p + 1) * mpmath.beta(p + 1, p + 1)
        assert abs(mpmath.mpf(str(found.evalf(digits + 5))) / exact - 1) < mpmath.mpf(10) ** (1 - digits)


@pytest.mark.parametrize("number", ["0.05", "1.5", "6", "15"])
def test_a_damped_impact_lasts_to_all_digits(number: str) -> None:
    """The duration up to the largest damping number that has one, by two rules with other nodes."""
    c, q, s = damping.c, damping.q, damping.s_d
    integral = Integral((1 + c - log(1 + c) - exp(s) + s) ** Rational(-3, 5), (s, -q, log(1 + c)))
    with mpmath.workdps(80):
        given = mpmath.mpf(number)

        def sides(left: mpmath.mpf) -> mpmath.mpf:
            return mpmath.log1p(given) + left - given - 1 + mpmath.exp(-left)

        at = {c: given, q: mpmath.findroot(sides, (mpmath.log1p(given), given), solver="anderson")}
        coarse, fine = (in_nodes(integral, digits).evalf(70, subs=at) for digits in (DOUBLE, EXACT))
        assert abs(coarse / fine - 1) < 10**-17


@pytest.mark.parametrize("function", [exp(x), x**2, (x - x**2) ** Rational(1, 2), x ** Rational(-3, 2)])
def test_another_integral_is_refused(function: Expr) -> None:
    equation = Equation("(1)", (a, Integral(function, (x, 0, 1))), "a test")
    with pytest.raises(SheetError, match="a: an integral is of a power between -1 and 0"):
        Sheet((Column("a", None, Formula(equation)),))
