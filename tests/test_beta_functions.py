"""Euler's beta functions: what is integrated by them, and how every engine computes them."""

from typing import Any

import mpmath
import pytest
from sympy import Expr, Integral, Rational, Symbol, acos, beta, betainc, lambdify, sqrt

from loopsheet.derivations.algebra import in_powers
from loopsheet.report.plan.special import EXACT, in_elementary_terms


@pytest.mark.parametrize(
    ("a", "m", "b"),
    [(0, Rational(5, 2), Rational(-1, 2)), (Rational(3, 2), 2, Rational(1, 2)), (0, 2, Rational(-1, 2)),
     (Rational(-1, 3), Rational(7, 3), Rational(3, 4))],
)  # fmt: skip
@pytest.mark.parametrize("gone", [1, Rational(2, 3), Rational(1, 100)])
def test_shares_of_a_way_are_summed_as_by_numbers(a: Expr, m: Expr, b: Expr, gone: Any) -> None:
    """`gone`: how much of the energy is gone at the end."""
    share, part = Symbol("r", positive=True), Symbol("z", positive=True)
    way = share**a * (1 - (gone if gone == 1 else part) * share**m) ** b
    closed = in_powers(Integral(way, (share, 0, 1)))
    assert closed is not None
    with mpmath.workdps(60):  # an end where the rate is zero costs half of the digits
        summed = mpmath.quad(lambdify(share, way.subs(part, gone), "mpmath"), [0, 0.5, 1])
        assert abs(closed.subs(part, gone).evalf(40) / summed - 1) < 1e-20


def test_the_rest_of_a_spring_s_way_is_an_arc() -> None:
    share, begun = Symbol("r", positive=True), Symbol("s", positive=True)
    rest = Integral(1 / sqrt(1 - share**2), (share, begun, 1))
    assert in_powers(rest) == acos(begun)
    assert in_powers(Integral(rest.function, (share, begun, 2))) is None


def test_what_is_no_share_of_a_way_is_not_summed_so() -> None:
    share, c = Symbol("r", positive=True), Symbol("c", positive=True)
    root = 1 / sqrt(1 - share ** Rational(5, 2))
    for integral in (
        Integral(root, (share, 0, c)),
        Integral(root**3, (share, 0, 1)),
        Integral(root / share, (share, 0, 1)),
        Integral(root / sqrt(1 - share), (share, 0, 1)),
    ):
        assert in_powers(integral) is None


@pytest.mark.parametrize("digits", [18, EXACT])
@pytest.mark.parametrize("a", ["0.02", "0.3333", "0.43", "0.5", "1.7", "40"])
def test_the_beta_function_is_said_in_powers_to_the_digits_that_are_asked_for(digits: int, a: str) -> None:
    own = Symbol("a", positive=True)
    said = in_elementary_terms(beta(own, Rational(1, 2)), digits)
    with mpmath.workdps(digits + 15):
        value = lambdify(own, said, "mpmath")(mpmath.mpf(a))
        right = mpmath.beta(mpmath.mpf(a), mpmath.mpf("0.5"))
        assert abs(value / right - 1) < mpmath.mpf(10) ** -digits * 3


@pytest.mark.parametrize("digits", [18, EXACT])
@pytest.mark.parametrize("a", [Rational(2, 5), Rational(1, 2), Rational(7, 3)])
def test_the_incomplete_one_is_said_in_powers_to_the_digits_that_are_asked_for(digits: int, a: Expr) -> None:
    z = Symbol("z", positive=True)
    said = in_elementary_terms(betainc(a, Rational(1, 2), 0, z), digits)
    with mpmath.workdps(digits + 15):
        for part in map(mpmath.mpf, ("1e-12", "0.001", "0.3", "0.9", "0.9999", "1")):
            right = mpmath.betainc(mpmath.mpf(a.p) / a.q, mpmath.mpf("0.5"), 0, part)
            assert abs(lambdify(z, said, "mpmath")(part) / right - 1) < mpmath.mpf(10) ** -digits


def test_of_no_other_incomplete_one_something_is_made_up() -> None:
    z = Symbol("z", positive=True)
    for other in (betainc(z, Rational(1, 2), 0, z), betainc(2, 2, 0, z), betainc(2, Rational(1, 2), z, 1)):
        with pytest.raises(NotImplementedError):
            in_elementary_terms(other)
