"""Conditions are known to the algebra, and no more is known than they say."""

import pytest
from proving import a, b, c, claim, decide, given, n, w, y
from sympy import Abs, Eq, Expr, Max, Ne, Or, Rational, log, sqrt

from loopsheet.derivations.proved import ProofStatus


@pytest.mark.parametrize(
    ("left", "right", "conditions"),
    [
        (sqrt((a - b) ** 2), a - b, (a > b,)),
        (sqrt((a - b) ** 2), a - b, (b <= a,)),
        (sqrt((a - b) ** 2), b - a, (a < b,)),
        (sqrt(a**2 - 2 * a * b + b**2), a - b, (a > b,)),
        (Abs(a**2 - b**2), (a - b) * (a + b), (a > b,)),
        (Max(a, b) + c, a + c, (a >= b,)),
        (log(a**2 - 2 * a * b + b**2), 2 * log(a - b), (a > b,)),
        (((a - b) ** c) ** (1 / c), a - b, (a > b,)),
        (sqrt((a - c) ** 2), a - c, (a > b, b > c)),
        (sqrt((a - c) ** 2), a - c, (b > c, a > b)),
        (sqrt((1 - a) ** 2), 1 - a, (a < 1,)),
        (sqrt((1 - a**2) ** 2), 1 - a**2, (a < 1,)),  # a is positive as well
        (sqrt((1 - c * a**2) ** 2), 1 - c * a**2, (1 - c * a**2 > 0,)),
        (log(1 - a) + log(1 + a), log(1 - a**2), (a < 1,)),
        (sqrt(y**2), -y, (y < 0,)),
        (sqrt((y - w) ** 2), y - w, (y > w,)),
        (sqrt((n - 2) ** 2), n - 2, (n > 1,)),  # n is whole
    ],
)
def test_conditions_are_used_by_the_algebra(left: Expr, right: Expr, conditions: tuple[Expr, ...]) -> None:
    assert decide(claim(left, right, conditions=conditions)).status is ProofStatus.PROVED
    assert decide(claim(left, -right, conditions=conditions)).status is ProofStatus.REFUTED
    assert decide(claim(left, right)).status is not ProofStatus.PROVED


@pytest.mark.parametrize(
    ("left", "right", "conditions", "status"),
    [
        (sqrt((a - b) ** 2), a - b, (a > c,), ProofStatus.REFUTED),
        (sqrt((a - b) ** 2), a - b, (Ne(a, b),), ProofStatus.REFUTED),
        (sqrt((a - b) ** 2), a - b, (Eq(a, b),), ProofStatus.UNDECIDED),
        (sqrt((a - b) ** 2), a - b, (a > b, b > a), ProofStatus.UNDECIDED),
        (sqrt((n - 2) ** 2), n - 2, (n > Rational(1, 2),), ProofStatus.REFUTED),
        (sqrt((a * b - c) ** 2), c - a * b, (a * b > c,), ProofStatus.REFUTED),
        (sqrt((1 - a**2) ** 2), 1 - a**2, (a < 2,), ProofStatus.REFUTED),
    ],
)
def test_no_more_is_known_than_the_conditions_say(
    left: Expr, right: Expr, conditions: tuple[Expr, ...], status: ProofStatus
) -> None:
    assert decide(claim(left, right, conditions=conditions)).status is status


def test_conditions_help_to_solve_a_premise() -> None:
    law = (given((a - b) ** c, y**2), a)
    assert decide(claim((a - b) ** (2 * c), y**4, conditions=(a > b,)), law).status is ProofStatus.PROVED
    assert "one solution for a" in decide(claim((a - b) ** (2 * c), y**4), law).why


def test_conditions_of_a_premise_follow_from_those_of_the_claim() -> None:
    premise = given(c, a - b, a > b)
    assert decide(claim(c + b, a, conditions=(a > b + 1,)), (premise, c)).status is ProofStatus.PROVED
    found = decide(claim(c + b, a, conditions=(a > b - 1,)), (given(c, a - b, a > b + 1), c))
    assert found.why == "c = a - b holds only where a > 1 + b, which (1) does not say"
    whole = given(y, a - n, n > 1)
    assert decide(claim(y + n, a, conditions=(n > 2,)), (whole, y)).status is ProofStatus.PROVED
    assert decide(claim(y + n, a, conditions=(n > 0,)), (whole, y)).status is ProofStatus.UNDECIDED


@pytest.mark.parametrize(
    ("needed", "said", "implied"),
    [
        (a >= b, (a > b,), True),
        (a > b, (a >= b,), False),
        (a >= b, (a >= c, c >= b), True),  # they may all be equal
        (a > b, (a >= c, c >= b), False),
        (a > b, (a >= c, c > b), True),
        (b > a, (a > b + 1,), False),
        (b < a, (a > b + 1,), True),
        (y < a, (), True),  # y is a - b, and b is positive
        (y > a, (), False),
        (y <= a, (), True),
        (Ne(a, b), (), False),
        (Ne(a, b), (a > b,), False),  # it follows, and is no inequality: to know less is sound
        (Or(a > b, c > b), (c > 2 * b,), False),
        (a > -b, (), True),
    ],
)
def test_a_condition_of_a_premise_is_implied_or_must_be_said(
    needed: Expr, said: tuple[Expr, ...], implied: bool
) -> None:
    found = decide(claim(y + b, a, conditions=said), (given(y, a - b, needed), y))
    assert found.status is (ProofStatus.PROVED if implied else ProofStatus.UNDECIDED)
    if not implied:
        assert found.why.endswith("which (1) does not say")


def test_a_factor_is_of_one_sign_where_the_conditions_hold() -> None:
    premise = (given(c * (a - b), b * (a - b)), None)
    assert decide(claim(c, b, conditions=(a > b,)), premise, factor=1 / (a - b)).status is ProofStatus.PROVED
    assert (
        decide(claim(c, b, conditions=(a >= b,)), premise, factor=1 / (a - b)).status is ProofStatus.UNDECIDED
    )
