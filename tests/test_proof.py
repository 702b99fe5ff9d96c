"""The prover: what it proves, what it refutes, and every way found so far to fool it."""

from typing import Any

import mpmath
import pytest
from proving import X, a, b, c, claim, decide, given, n, q, w, y
from sympy import (
    Abs,
    Expr,
    Float,
    Function,
    Indexed,
    Integer,
    Integral,
    Max,
    Min,
    Piecewise,
    Rational,
    Sum,
    Symbol,
    asinh,
    atan,
    cos,
    cosh,
    erf,
    erfc,
    gamma,
    log,
    nan,
    oo,
    pi,
    sin,
    sinh,
    sqrt,
    tan,
    tanh,
    zoo,
)

from loopsheet.derivations import algebra, proof, sampling, system
from loopsheet.derivations.equation import Equation, Step
from loopsheet.derivations.proof import POINTS, check_step
from loopsheet.derivations.proved import ProofStatus
from loopsheet.derivations.reductions import Greatest, Least, Median
from loopsheet.derivations.vocabulary import NO_WORDS

# --- what must come out ---------------------------------------------------------------------------------


def test_a_true_claim_is_proved() -> None:
    found = decide(claim(a**2, b * (b + 2 * c) + c**2), (given(a, b + c), a))
    assert (found.status, found.points) == (ProofStatus.PROVED, POINTS)
    assert found.worst < 1e-40
    assert found.sentence.startswith("residual 0; 20 points at 50 digits agree within")


def test_a_false_claim_is_refuted_with_its_point_and_both_sides() -> None:
    found = decide(claim(a**2, b**2 + c**2), (given(a, b + c), a))
    assert found.status is ProofStatus.REFUTED
    assert list(found.counterexample) == ["b", "c", "a"]
    at = {name: float(value) for name, value in found.counterexample.items()}
    assert at["a"] == pytest.approx(at["b"] + at["c"], rel=1e-5)
    left, right = map(float, found.sides)
    assert left == pytest.approx(at["a"] ** 2, rel=1e-4)
    assert right == pytest.approx(at["b"] ** 2 + at["c"] ** 2, rel=1e-4)
    assert found.sentence == f"at b = {found.counterexample['b']}, c = {found.counterexample['c']}, " + (
        f"a = {found.counterexample['a']} the sides are {found.sides[0]} and {found.sides[1]}"
    )


def test_sides_are_told_with_the_digits_in_which_they_differ() -> None:
    found = decide(claim(a, a * (1 + Rational(1, 10**12))))
    assert found.status is ProofStatus.REFUTED
    assert found.sides[0] != found.sides[1]
    assert float(found.sides[0]) == pytest.approx(float(found.sides[1]), rel=1e-11)


def test_every_link_of_a_chain_of_equalities_counts() -> None:
    assert decide(claim(a, (a**2 + a * b) / (a + b), a * b / b)).status is ProofStatus.PROVED
    assert decide(claim(a, 2 * a, a)).status is ProofStatus.REFUTED


def test_what_does_not_change_and_is_zero_somewhere_is_zero_on_a_connected_domain() -> None:
    assert decide(claim(atan(1 / a), pi / 2 - atan(a))).status is ProofStatus.PROVED
    assert decide(claim(atan(b / a), pi / 2 - atan(a / b))).status is ProofStatus.PROVED
    for wrong in (pi / 3 - atan(a), pi / 2 + atan(a), pi / 2 - atan(a) + Rational(1, 10**30)):
        assert decide(claim(atan(1 / a), wrong)).status is ProofStatus.REFUTED
    # Both have the same slope, and are equal at 1, but not below zero.
    real = Symbol("y", real=True)
    assert not algebra.vanishes(atan(1 / real) - pi / 2 + atan(real))
    assert not algebra.vanishes(atan(1 / (a - 3)) + atan(a - 3) + pi / 2)


@pytest.mark.parametrize(
    ("left", "right", "wrong"),
    [
        (tan(a / 2), sin(a) / (1 + cos(a)), sin(a) / (1 - cos(a))),
        (sin(2 * atan(b)), 2 * b / (1 + b**2), 2 * b / (1 - b**2)),
        (
            b * (1 - c / 2 * cos(a)),
            b * (1 - c**2 / 4) / (1 + c / 2 * cos(2 * atan(sqrt((1 + c / 2) / (1 - c / 2)) * tan(a / 2)))),
            b * (1 - c / 2) / (1 + c / 2 * cos(2 * atan(sqrt((1 + c / 2) / (1 - c / 2)) * tan(a / 2)))),
        ),
    ],
)
def test_angles_and_their_halves_are_known(left: Expr, right: Expr, wrong: Expr) -> None:
    assert decide(claim(left, right)).status is ProofStatus.PROVED
    assert decide(claim(left, wrong)).status is ProofStatus.REFUTED
    assert decide(claim(left, right * (1 + Rational(1, 10**30)))).status is ProofStatus.REFUTED


def test_an_angle_is_not_written_by_a_hundredth_of_it() -> None:
    """A bound in degrees has a pi of fifty digits: so many times an angle is a polynomial of that degree."""
    angle = a * (10**49 + 1) / (10**49 * (a + 1))
    found = decide(claim(sqrt(1 - sin(angle) ** 2), cos(angle)))
    assert found.status is not ProofStatus.REFUTED
    assert decide(claim(sin(2 * angle), 2 * sin(angle) * cos(angle))).status is ProofStatus.PROVED


@pytest.mark.parametrize(
    ("premises", "claimed"),
    [
        (((given(c, log(a)), a),), claim(log(a * b), c + log(b))),
        (((given(b * a**2, c), a),), claim(a, sqrt(c / b))),
        (((given(1 / (a + b), c), a),), claim(a, 1 / c - b)),
        (((given(a ** (b + 1), c), a),), claim(a, c ** (1 / (b + 1)))),
    ],
)
def test_premises_are_solved(premises: tuple[tuple[Equation, Expr], ...], claimed: Equation) -> None:
    assert decide(claimed, *premises).status is ProofStatus.PROVED


def test_integrals_and_sums_are_claims_like_others() -> None:
    assert (
        decide(claim(Integral(a**y, (a, 0, b)), b ** (y + 1) / (y + 1))).status is not ProofStatus.PROVED
    )  # y > -1?
    assert decide(claim(Integral(a**c, (a, 0, b)), b ** (c + 1) / (c + 1))).status is ProofStatus.PROVED
    assert decide(claim(Integral(a**c, (a, 0, b)), b ** (c + 1) / (c + 2))).status is ProofStatus.REFUTED
    assert decide(claim(Sum(X[q] + b, (q, 1, n)), Sum(X[q], (q, 1, n)) + n * b)).status is ProofStatus.PROVED
    assert decide(claim(Sum(X[q] * b, (q, 1, n)), n * b)).status is ProofStatus.REFUTED


@pytest.mark.parametrize("kind", [Median, Greatest, Least])
def test_what_is_taken_by_order_is_evaluated_and_nothing_is_made_up_about_it(kind: Any) -> None:
    taken = kind(X[q], (q, 1, n))
    assert decide(claim(taken + b, b + taken)).status is ProofStatus.PROVED
    assert decide(claim(taken, Sum(X[q], (q, 1, n)) / n)).status is ProofStatus.REFUTED
    assert decide(claim(kind(X[q] + b, (q, 1, n)), taken)).status is ProofStatus.REFUTED
    # True, and seen at every point; but no algebra of ours knows of order.
    assert decide(claim(kind(X[q] + b, (q, 1, n)), taken + b)).status is ProofStatus.UNDECIDED


@pytest.mark.parametrize(
    ("left", "right"),
    [
        (Greatest(X[q], (q, 1, n)), Least(X[q], (q, 1, n))),
        (Greatest(-X[q], (q, 1, n)), Least(X[q], (q, 1, n))),
        (Greatest(X[q], (q, 1, n)), Median(X[q], (q, 1, n))),
        (Greatest(X[q] ** 2, (q, 1, n)) * Least(X[q], (q, 1, n)), Greatest(X[q], (q, 1, n)) ** 3),
    ],
)
def test_one_place_in_the_order_is_not_another(left: Expr, right: Expr) -> None:
    assert decide(claim(left, right)).status is ProofStatus.REFUTED


def test_extremes_of_opposites() -> None:
    """True, and nothing that is false of it: the greatest is minus the least of what is opposite."""
    greatest = Greatest(X[q], (q, 1, n))
    assert decide(claim(greatest, -Least(-X[q], (q, 1, n)))).status is ProofStatus.UNDECIDED
    assert (
        decide(claim(Greatest(X[q] - b, (q, 1, n)) / c, (greatest - b) / c)).status is ProofStatus.UNDECIDED
    )


@pytest.mark.parametrize(
    ("left", "right", "wrong"),
    [
        (cosh(a) ** 2 - sinh(a) ** 2, Integer(1), cosh(a)),
        (tanh(a), sinh(a) / cosh(a), cosh(a) / sinh(a)),
        (gamma(a + 1), a * gamma(a), gamma(a)),
        (erf(a) + erfc(a), Integer(1), erf(a)),
        (Max(a, b) * Min(a, b), a * b, Max(a, b) ** 2),
        (Max(a - b, 0) - Max(b - a, 0), a - b, Abs(a - b)),
        (Max(a, b), (a + b + Abs(a - b)) / 2, (a + b - Abs(a - b)) / 2),
        (sinh(asinh(a) + log(b)), (b * (a + sqrt(a**2 + 1)) - 1 / (b * (a + sqrt(a**2 + 1)))) / 2, a * b),
    ],
)
def test_functions_of_every_field_have_values(left: Expr, right: Expr, wrong: Expr) -> None:
    assert decide(claim(left, right)).status is ProofStatus.PROVED
    assert decide(claim(left, wrong)).status is ProofStatus.REFUTED


def test_a_sum_is_tried_with_several_numbers_of_terms() -> None:
    assert decide(claim(Sum(Integer(1), (q, 1, n)) * X[1], 5 * X[1])).status is ProofStatus.REFUTED


def test_a_counterexample_names_the_terms_of_a_sum() -> None:
    found = decide(claim(Sum(X[q] ** 2, (q, 1, n)), Sum(X[q], (q, 1, n)) ** 2))
    assert found.counterexample["X"].count(",") + 1 == float(found.counterexample["n"])


# --- sabotage -------------------------------------------------------------------------------------------


def test_numbers_overrule_a_symbolic_half_that_says_yes_to_all(monkeypatch: pytest.MonkeyPatch) -> None:
    check_step.cache_clear()
    monkeypatch.setattr(system.System, "residual_is_zero", lambda self: "")
    assert decide(claim(a, b)).status is ProofStatus.REFUTED
    check_step.cache_clear()


@pytest.mark.parametrize("answer", [False, None])
def test_a_symbolic_half_that_cannot_tell_proves_nothing(
    monkeypatch: pytest.MonkeyPatch, answer: bool | None
) -> None:
    check_step.cache_clear()
    monkeypatch.setattr(system, "vanishes", lambda residual: answer)
    found = decide(claim(a + b, b + a))
    assert found.status is ProofStatus.UNDECIDED
    assert found.why == proof.NOT_REDUCED
    check_step.cache_clear()


@pytest.mark.parametrize("points", [0, 1, 19])
def test_a_numerical_half_that_is_switched_off_proves_nothing(
    monkeypatch: pytest.MonkeyPatch, points: int
) -> None:
    check_step.cache_clear()
    monkeypatch.setattr(proof, "examine", lambda prepared, seed: sampling.Outcome(points, 0.0))
    assert decide(claim(a + b, b + a)).status is ProofStatus.UNDECIDED
    monkeypatch.setattr(proof, "examine", lambda prepared, seed: sampling.Outcome(POINTS, 0.0))
    assert decide(claim(a, b)).status is ProofStatus.UNDECIDED
    check_step.cache_clear()


def test_a_claim_is_evaluated_at_twenty_points() -> None:
    assert decide(claim(a + b, b + a)).points == 20


@pytest.mark.parametrize("seed", range(10))
def test_points_suffice_to_see_what_fails_in_a_fifth_of_the_domain(seed: int) -> None:
    """With one point, four of five of these pass; with twenty, one of a hundred."""
    prepared = system.prepare(Step(claim(Min(a, Rational(17, 10)), a), (), (), ""), NO_WORDS)
    assert sampling.examine(prepared, f"seed {seed}").counterexample is not None


# --- what holds only in part, or nearly -------------------------------------------------------------------


@pytest.mark.parametrize(
    "wrong",
    [
        claim(Max(a, b), a),
        claim(Abs(y - w), y - w),
        claim(sqrt((a - b) ** 2), a - b),
        claim(Piecewise((a, a < 1), (b, True)), a),
        claim(log(a - b), log(b - a)),
        claim(a * (1 + Rational(1, 10**30)), a),
        claim(a + b / 10**30, a),
        claim(a, -a),
    ],
)
def test_refuted(wrong: Equation) -> None:
    assert decide(wrong).status is ProofStatus.REFUTED


@pytest.mark.parametrize(
    "out_of_sight",
    [
        claim(Min(a, 3), a),  # symbols without a table are drawn from 1/2 to 2
        claim(Piecewise((a, a < 100), (b, True)), a),
        claim(Max(a, b / 100), a),
        claim(a * (1 + Rational(1, 10**45)), a),
    ],
)
def test_what_the_points_cannot_see_is_left_to_the_algebra(out_of_sight: Equation) -> None:
    assert decide(out_of_sight).status is ProofStatus.UNDECIDED


def test_a_claim_that_has_a_value_only_here_and_there_is_not_proved(monkeypatch: pytest.MonkeyPatch) -> None:
    check_step.cache_clear()
    monkeypatch.setattr(system.System, "residual_is_zero", lambda self: "")
    found = decide(claim(Piecewise((a, a > 1)), a))
    assert found.status is ProofStatus.UNDECIDED
    assert found.why.startswith("it has no value at a = ")
    assert decide(claim(Piecewise((a, a > 1)), 2 * a)).status is ProofStatus.REFUTED
    check_step.cache_clear()


@pytest.mark.parametrize(
    ("claimed", "why"),
    [
        (claim(a * nan, b * nan), "has no value|no point"),
        (claim(a * zoo, zoo), "has no value|no point"),
        (claim(a * oo, oo), "has no value|no point"),
        (claim(1 / (a - a + (b - b)), Integer(0)), "has no value|no point"),
        (
            claim(0 / (sin(a) ** 2 + sin(a + 0) ** 2 - 2 * sin(a) ** 2 + a - a), Integer(0)),
            "no value|no point",
        ),
        (claim(a * Float("1.5"), a * Rational(3, 2)), "rounded number"),
        (claim(Function("f")(a), Function("f")(a)), "f has no value"),
        (claim((a - b) ** Rational(3, 2) / (a - b), sqrt(a - b)), "not real at a ="),
        (Equation("(1)", (a > b,), ""), "does not say that expressions are equal"),
        (Equation("(1)", (a,), ""), "does not say that expressions are equal"),
        (Equation("(1)", (a > b, b < a), ""), "does not say that expressions are equal"),
    ],
)
def test_undecided_with_a_sentence(claimed: Equation, why: str) -> None:
    found = decide(claimed)
    assert found.status is ProofStatus.UNDECIDED
    assert any(part in found.why for part in why.split("|")), found.why


# --- premises -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("premises", "why"),
    [
        ([(given(a, -b), a)], "no point satisfies its premises and conditions"),
        ([(given(a, b), a), (given(a, b + 1), b)], "was not seen to have one solution for b"),
        ([(given(a, b + 1), a), (given(b, a + 1), b)], "was not seen to have one solution for b"),
        ([(given(a + log(a), b), a)], "was not seen to have one solution for a"),
        ([(given(a**2 - 3 * a, -2 * b), a)], "was not seen to have one solution for a"),
        ([(given((a - b) * (a - (b - c)), Integer(0)), a)], "was not seen to have one solution for a"),
        ([(given(y**2, b), y)], "was not seen to have one solution for y"),
        ([(given((a - b) ** 2, c), a)], "was not seen to have one solution for a"),
        ([(given(a * (sqrt(b) ** 4 - b**2), b - b), a)], "was not seen to have one solution for a"),
        ([(given(a * (sin(b) ** 2 - (1 - sin(2 * b + 0) ** 2 / (4 * sin(b) ** 2))), 0 * a), a)], None),
        ([(given(sqrt(a), -b), a)], "no point satisfies its premises and conditions"),
        ([(given(log(a), log(b - c)), a)], None),
    ],
)
def test_premises_that_decide_nothing(premises: list[tuple[Equation, Expr]], why: str | None) -> None:
    found = decide(claim(a, 7 * b), *premises)
    assert found.status is not ProofStatus.PROVED
    if why is not None:
        assert found.status is ProofStatus.UNDECIDED
        assert why in found.why


def test_a_premise_that_leaves_its_unknown_open_is_seen() -> None:
    # sin^2 + (its own complement) - 1 is zero, though not to the eye: a may be anything, not 0/0.
    zero = sin(b) ** 2 + sin(b + c) * sin(b - c) - (2 * sin(b) ** 2 - sin(c) ** 2)
    found = decide(claim(a, (c - c) / b + a), (given(a * zero, c * zero), a))
    assert found.status is ProofStatus.UNDECIDED
    assert "does not determine" in found.why or "no point" in found.why


def test_a_root_whose_right_side_changes_sign_is_used_only_where_it_exists() -> None:
    found = decide(claim(a**2, b - c), (given(a**2, b - c), a))
    assert found.status is ProofStatus.PROVED
    assert decide(claim(a**2, c - b), (given(a**2, b - c), a)).status is ProofStatus.REFUTED


@pytest.mark.parametrize(
    ("step", "why"),
    [
        (Step(claim(a, b), (given(a, b),), (), ""), "is a premise, but no step says what it is solved for"),
        (Step(claim(a, b), (given(a, b),), (a, b), ""), "no premise is left to be solved for b"),
        (Step(claim(a, b), (), (), "", a), "a factor turns one premise"),
        (Step(claim(a, b, b), (given(a, b),), (), "", Integer(1)), "a factor turns one premise"),
    ],
)
def test_a_step_says_what_each_premise_is_for(step: Step, why: str) -> None:
    found = check_step(step)
    assert found.status is ProofStatus.UNDECIDED
    assert why in found.why


def test_too_few_points_are_said_to_be_too_few() -> None:
    half = Rational(1, 2)
    found = decide(claim(a + b, b + a, conditions=(a < half + Rational(1, 100),)))
    assert found.status is ProofStatus.UNDECIDED
    assert found.why.startswith("only ")
    assert found.why.endswith(" points of its domain were found")


def test_conditions_of_the_claim_bound_its_domain() -> None:
    assert decide(claim(Max(a, b), a)).status is ProofStatus.REFUTED
    bounded = claim(Max(a, b) * 2, 2 * a + b, conditions=(a > b,))
    found = decide(bounded)
    assert found.status is ProofStatus.REFUTED
    assert float(found.counterexample["a"]) > float(found.counterexample["b"])


def test_conditions_of_a_premise_must_be_said_by_the_claim() -> None:
    premise = given(c, a - b, a > b + 1)
    assert decide(claim(c + b, a), (premise, c)).why.endswith("which (1) does not say")
    assert decide(claim(c + b, a, conditions=premise.conditions), (premise, c)).status is ProofStatus.PROVED
    assert decide(claim(y + b, a), (given(y, a - b, y > 0), y)).status is ProofStatus.UNDECIDED
    assert decide(claim(y, a + b), (given(y, a + b, y > 0), y)).status is ProofStatus.PROVED
    assert (
        decide(claim(c, a + b), (given(c, a + b, c > 0), c)).status is ProofStatus.PROVED
    )  # c > 0 says nothing new


# --- a running number is nobody else's --------------------------------------------------------------------


def test_a_row_of_a_column_is_not_its_sum() -> None:
    found = decide(claim(Sum(X[q], (q, 1, n)), n * X[q]))
    assert found.status is ProofStatus.UNDECIDED
    assert found.why == "q runs in one expression and is fixed in another"


def test_a_premise_for_one_abscissa_is_not_put_under_an_integral() -> None:
    found = decide(claim(Integral(b, (a, 0, 1)), Rational(1, 2)), (given(b, a), b))
    assert found.status is ProofStatus.UNDECIDED
    assert found.why == "a runs in one expression and is fixed in another"


def test_a_law_for_every_abscissa_is() -> None:
    f = Function("f")(a)
    assert decide(claim(Integral(f, (a, 0, c)), c**2 / 2), (given(f, a), f)).status is ProofStatus.PROVED
    assert decide(claim(Integral(f, (a, 0, c)), c**2), (given(f, a), f)).status is ProofStatus.REFUTED
    assert "closed form" in decide(claim(Integral(f, (a, 0, c)), c), (given(f, f**2), f)).why


def test_a_positive_variable_does_not_run_below_zero() -> None:
    assert (
        decide(claim(Integral(sqrt(a**2), (a, -c, c)), Integer(0))).why
        == "a is positive, but its limits are not"
    )
    assert decide(claim(Integral(y**2 + y, (y, -c, c)), 2 * c**3 / 3)).status is ProofStatus.PROVED
    assert decide(claim(Integral(y**2, (y, -c, c)), Integer(0))).status is ProofStatus.REFUTED
    assert (
        decide(claim(Integral(Abs(y), (y, -c, c)), c**2)).status is not ProofStatus.PROVED
    )  # a kink: not resolved


def test_a_cell_and_a_symbol_of_the_same_name_are_two() -> None:
    x_1 = Symbol("X_1", positive=True)
    assert isinstance(X[1], Indexed)
    assert decide(claim(X[1], x_1)).status is ProofStatus.REFUTED
    column = Symbol("X", positive=True)
    assert (
        decide(claim(Sum(X[q] * column, (q, 1, n)), column * Sum(X[q], (q, 1, n)))).status
        is ProofStatus.PROVED
    )


# --- a claim that is a multiple of its premise -------------------------------------------------------------


def test_a_multiple_of_a_premise() -> None:
    premise = (given(a**2 + b, c), None)
    assert decide(claim(b * a**2 + b**2, b * c), premise, factor=b).status is ProofStatus.PROVED
    wrong = decide(claim(b * a**2 + b, b * c), premise, factor=b)
    assert wrong.status is ProofStatus.REFUTED
    at = {name: mpmath.mpf(value) for name, value in wrong.counterexample.items()}
    assert at["a"] ** 2 + at["b"] == pytest.approx(at["c"], rel=1e-4)
    assert wrong.sides[0] != wrong.sides[1]


def test_a_wrong_factor_refutes_nothing() -> None:
    found = decide(claim(b * a, b * c), (given(a, c), None), factor=b + 1)
    assert found.status is ProofStatus.UNDECIDED
    assert found.why == "the premise times the factor is not the claim"


@pytest.mark.parametrize("factor", [1 / (a - b), y, a - c, zoo])
def test_a_factor_that_may_vanish_or_burst_proves_nothing(factor: Expr) -> None:
    # 1 = 0 is a - b = 0 divided by a - b.
    found = decide(claim(Integer(1), Integer(0)), (given(a, b), None), factor=factor)
    assert found.status is ProofStatus.UNDECIDED
    assert "was not seen to be of one sign" in found.why


# --- every time -------------------------------------------------------------------------------------------


def test_the_same_points_every_time() -> None:
    def found() -> list[object]:
        check_step.cache_clear()
        return [decide(claim(a, b)).counterexample, decide(claim(a + b, b + a)).worst]

    assert found() == found()
