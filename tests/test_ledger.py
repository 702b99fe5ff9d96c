"""Ledgers: what may rest on what, what is refused although each step is right, and what a claim rests on."""

from dataclasses import replace

import pytest
from proving import X, a, b, c, n, q, w, y
from sympy import (
    Expr,
    Function,
    Integer,
    Integral,
    Min,
    Piecewise,
    Rational,
    Sum,
    Symbol,
    exp,
    log,
    sqrt,
)

from loopsheet.derivations import soft_impact as model
from loopsheet.derivations.equation import Derivation, Equation, Kind, Ledger, Step
from loopsheet.derivations.proof import prove, prove_entry
from loopsheet.derivations.proved import Proof, ProofStatus
from loopsheet.derivations.vocabulary import Quantity, Vocabulary

m = Symbol("m", integer=True, positive=True)
FIRST = Equation("(1)", (a, b + c), "", Kind.DEFINITION)
SECOND = Equation("(2)", (b * (a - c), b**2), "")
THIRD = Equation("(3)", (a**2 - (b + c) ** 2, Integer(0)), "")
SECOND_HOLDS = Derivation.of(SECOND, (FIRST,), (a,), "")
BY_CASES = Equation("(1)", (a, Piecewise((b, b > c), (2 * c, b <= c))), "", Kind.ASSUMPTION)
THIRD_HOLDS = Derivation.of(THIRD, (SECOND,), (a,), "")


def statuses(*entries: Equation | Derivation) -> list[ProofStatus]:
    return [found.status for found in prove(Ledger(entries))]


def _proof(entry: Equation | Derivation) -> Proof:
    return prove_entry(entry, {}, Ledger(()))[0]


def by_label(*entries: Equation | Derivation) -> dict[str, Proof]:
    return {found.equation.label: found for found in prove(Ledger(entries))}


def test_each_entry_may_rest_on_those_before_it() -> None:
    assert statuses(FIRST, SECOND_HOLDS, THIRD_HOLDS) == [
        ProofStatus.DEFINITION,
        ProofStatus.PROVED,
        ProofStatus.PROVED,
    ]


@pytest.mark.parametrize(
    "entries",
    [
        (THIRD_HOLDS,),
        (THIRD_HOLDS, FIRST, SECOND_HOLDS),
        (SECOND_HOLDS, FIRST),
        (SECOND, THIRD_HOLDS),
    ],
)
def test_nothing_rests_on_what_comes_later(entries: tuple[Equation | Derivation, ...]) -> None:
    first = prove(Ledger(entries))[0]
    assert first.status is ProofStatus.UNDECIDED
    if first.steps:
        assert first.steps[-1].why.startswith("rests on (")
        assert first.steps[-1].why.endswith("not proved before")


def test_what_rests_on_a_refuted_claim_is_undecided() -> None:
    wrong = Equation("(2)", (b * (a - c), 2 * b**2), "")
    rests = Derivation.of(Equation("(3)", (a, 2 * b + c), ""), (wrong,), (a,), "")
    assert statuses(FIRST, Derivation.of(wrong, (FIRST,), (a,), ""), rests)[1:] == [
        ProofStatus.REFUTED,
        ProofStatus.UNDECIDED,
    ]


def test_a_claim_without_a_derivation_is_undecided() -> None:
    assert _proof(SECOND).status is ProofStatus.UNDECIDED


@pytest.mark.parametrize(
    "forged",
    [
        replace(SECOND, members=(b * (a - c), 2 * b**2), parent=SECOND),
        replace(SECOND, members=(b * (a - c), 2 * b**2), parent=SECOND, kind=Kind.ASSUMPTION),
        Equation("(2)", (b * (a - c), 2 * b**2), "", parent=FIRST),
        SECOND.at({b: -b}),
        SECOND.at({b: y}),
        replace(SECOND.at({b: 2 * b}), renamed=()),
        replace(SECOND.at({b: 2 * b}), renamed=(((b, 3 * b),),)),
    ],
)
def test_an_instance_is_made_again_before_it_is_trusted(forged: Equation) -> None:
    found = prove(
        Ledger((FIRST, SECOND_HOLDS, Derivation.of(replace(forged, number="(4)"), (forged,), (a,), "")))
    )
    assert found[-1].status is ProofStatus.UNDECIDED


BOUNDED = replace(FIRST, conditions=(b > c,))


@pytest.mark.parametrize(
    ("stated", "forged", "side"),
    [
        (FIRST, replace(FIRST, members=(a, b + 2 * c), parent=FIRST), b + 2 * c),
        (FIRST, FIRST.at({c: y**2}), b + y**2),
        (FIRST, replace(FIRST.at({c: 2 * c}), renamed=()), b + 2 * c),
        (BOUNDED, replace(BOUNDED, conditions=(), parent=BOUNDED), b + c),
        (BY_CASES, replace(BY_CASES.branch(1, ""), members=(a, 3 * c)), 3 * c),
    ],
)
def test_so_is_an_instance_of_what_is_stated(stated: Equation, forged: Equation, side: Expr) -> None:
    claim = Equation("(2)", (a**2, side**2), "")
    found = by_label(stated, Derivation.of(claim, (forged,), (a,), ""))["(2)"]
    assert found.status is ProofStatus.UNDECIDED
    assert found.steps[0].why == "rests on what is called (1) and is no instance of it"


def test_a_case_of_a_law_is_an_instance_of_it() -> None:
    claim = Equation("(2)", (a**2, 4 * c**2), "")
    case = BY_CASES.branch(1, "")
    assert by_label(BY_CASES, Derivation.of(claim, (case,), (a,), ""))["(2)"].rests_on == ("(1)",)


def test_a_true_instance_is_trusted() -> None:
    instance = SECOND.at({b: b * c}).at({c: 2 * c}).reversed
    assert (
        statuses(
            FIRST,
            SECOND_HOLDS,
            Derivation.of(Equation("(4)", (a, 2 * b * c + 2 * c), ""), (instance,), (a,), ""),
        )[-1]
        is ProofStatus.PROVED
    )


def test_an_instance_keeps_the_conditions_of_its_origin() -> None:
    bounded = replace(SECOND, conditions=(a > 1,))
    first = replace(FIRST, conditions=())
    rests = Derivation.of(THIRD, (replace(bounded, conditions=(), parent=bounded),), (a,), "")
    found = prove(Ledger((first, Derivation.of(bounded, (first,), (a,), ""), rests)))
    assert [one.status for one in found[1:]] == [ProofStatus.PROVED, ProofStatus.UNDECIDED]


@pytest.mark.parametrize(
    ("printed", "status", "remark"),
    [
        ((b * (a - c), b**2), ProofStatus.PROVED, ""),
        ((b * (a - c), 2 * b**2), ProofStatus.CORRECTED, "as printed, (2) fails: at b = "),
        (
            (c, c),
            ProofStatus.CORRECTED,
            "as printed, (2) does not contain a, which it should determine: it repeats c",
        ),
        (
            (b * (Min(a, 30) - c), b**2),
            ProofStatus.UNDECIDED,
            "as printed, (2) is undecided: the numbers agree, but",
        ),
    ],
)
def test_the_print_is_checked_too(printed: tuple[Expr, ...], status: ProofStatus, remark: str) -> None:
    meant = replace(SECOND, printed=printed, defines=a)
    found = prove(Ledger((FIRST, Derivation.of(meant, (FIRST,), (a,), ""))))[1]
    assert found.status is status
    assert found.remark.startswith(remark)
    assert bool(found.remark) == bool(remark)


def test_begin_is_told_of_each_equation_in_order() -> None:
    told: list[str] = []
    prove(Ledger((FIRST, SECOND_HOLDS, THIRD_HOLDS)), lambda equation: told.append(equation.label))
    assert told == ["(1)", "(2)", "(3)"]


# --- circles ------------------------------------------------------------------------------------------------


def assumed(*members: Expr, title: str = "assumed") -> Equation:
    return Equation("", members, "", Kind.ASSUMPTION, title)


SAID = Equation("(2)", (a, b + c), "")


@pytest.mark.parametrize(
    "premise",
    [
        assumed(a, b + c),
        assumed(b + c, a),
        assumed(3 * a, 3 * b + 3 * c),
        assumed(-a / 7, -(b + c) / 7),
        assumed(a - b, c),
        assumed(a - b - c, Integer(0)),
        assumed(a, (b**2 - c**2) / (b - c)),
        assumed(log(exp(a)) - b, c),
        assumed(y, a, b + c),
        assumed(sqrt(2) * a, sqrt(2) * (b + c)),
        replace(assumed(a, b + c), kind=Kind.DEFINITION),
        replace(assumed(a, b + c), kind=Kind.LIMIT),
        assumed(y, b + c).at({y: a}),
        replace(assumed(y, b), members=(a, b + c), parent=assumed(y, b)),
    ],
)
def test_a_premise_that_says_what_the_claim_says_proves_nothing(premise: Equation) -> None:
    found = _proof(Derivation.of(SAID, (premise,), (a,), ""))
    assert found.status is ProofStatus.REFUSED
    assert found.remark == f"(2) rests on itself: (2) -> {premise.label} = (2)"
    assert found.rests_on == ()
    assert [step.status for step in found.steps] in ([ProofStatus.PROVED], [ProofStatus.UNDECIDED])


@pytest.mark.parametrize("kind", [Kind.DEFINITION, Kind.ASSUMPTION])
def test_so_does_a_premise_with_a_number(kind: Kind) -> None:
    stated = Equation("(1)", (b + c - a, Integer(0)), "", kind)
    found = by_label(stated, Derivation.of(SAID, (stated,), (a,), ""))
    assert found["(1)"].status is ProofStatus(kind.value)
    assert found["(2)"].status is ProofStatus.REFUSED
    assert found["(2)"].remark == "(2) rests on itself: (2) -> (1) = (2)"


@pytest.mark.parametrize(
    "premise",
    [
        assumed(a**2, (b + c) ** 2),  # a root is more than a number
        assumed(b * a, b * (b + c)),
        assumed(1 / a, 1 / (b + c)),
        assumed(log(a), log(b + c)),
        assumed(a, Sum(X[q], (q, 1, n)) + Integral(y, (y, 0, c)) * 2 / c - Sum(X[q], (q, 1, n)) + b),
    ],
)
def test_to_work_something_out_is_a_proof(premise: Equation) -> None:
    found = _proof(Derivation.of(SAID, (premise,), (a,), ""))
    assert found.status is ProofStatus.PROVED
    assert found.rests_on == ("assumed",)


def test_a_claim_that_was_proved_may_be_said_again() -> None:
    again = Equation("(3)", (2 * b**2, 2 * a * b - 2 * b * c), "")
    found = by_label(FIRST, SECOND_HOLDS, Derivation.of(again, (SECOND,), (a,), ""))
    assert found["(3)"].status is ProofStatus.PROVED
    assert found["(3)"].rests_on == ("(1)",)


def test_an_assumption_for_every_row_yields_one() -> None:
    every = Equation("(1)", (X[q], b * c), "", Kind.ASSUMPTION)
    first = Equation("(2)", (X[1], c * b), "")
    entries = every, Derivation.of(first, (every.at({q: Integer(1)}),), (X[1],), "")
    assert by_label(*entries)["(2)"].status is ProofStatus.PROVED


def test_a_circle_is_refused_and_drawn() -> None:
    """(2) from (3) from (2), each by a step that is right."""
    squared = Equation("(3)", (a**2, (b + c) ** 2), "")
    back = Derivation.of(SAID, (squared,), (a,), "")
    found = by_label(back, Derivation.of(squared, (SAID,), (a,), ""))
    assert [proof.status for proof in found.values()] == [ProofStatus.REFUSED] * 2
    assert found["(2)"].remark == "(2) rests on itself: (2) -> (3) -> (2)"
    assert found["(3)"].remark == "(3) rests on itself: (3) -> (2) -> (3)"


def test_a_circle_is_seen_through_what_its_premise_is_called() -> None:
    """(3) from an assumption that says what (2) says, and (2) from (3)."""
    squared = Equation("(3)", (a**2, (b + c) ** 2), "")
    hidden = assumed(2 * a - 2 * b, 2 * c, title="the budget")
    found = by_label(Derivation.of(squared, (hidden,), (a,), ""), Derivation.of(SAID, (squared,), (a,), ""))
    assert [proof.status for proof in found.values()] == [ProofStatus.REFUSED] * 2
    assert found["(3)"].remark == "(3) rests on itself: (3) -> the budget = (2) -> (3)"
    assert found["(2)"].remark == "(2) rests on itself: (2) -> (3) -> the budget = (2)"


def test_a_circle_within_a_chain_of_steps_is_seen() -> None:
    between = Equation("", (a**2, (b + c) ** 2), "", title="between")
    chain = Derivation((Step(between, (assumed(a, b + c),), (a,), ""), Step(SAID, (between,), (a,), "")))
    found = _proof(chain)
    assert found.status is ProofStatus.REFUSED
    assert found.remark == "(2) rests on itself: (2) -> between -> assumed = (2)"


def test_what_rests_on_a_circle_is_no_part_of_it() -> None:
    squared = Equation("(3)", (a**2, (b + c) ** 2), "")
    after = Equation("(4)", (a**3, (b + c) ** 3), "")
    found = by_label(
        Derivation.of(SAID, (squared,), (a,), ""),
        Derivation.of(squared, (SAID,), (a,), ""),
        Derivation.of(after, (squared,), (a,), ""),
    )
    assert found["(4)"].status is ProofStatus.UNDECIDED
    assert found["(4)"].steps[0].why == "rests on (3), not proved before"


def test_an_unknown_function_is_like_no_other() -> None:
    f, g = Function("f")(y), Function("g")(y)
    work = assumed(a, Integral(f, (y, 0, b)))
    same, other = (Equation("(1)", (2 * Integral(h, (y, 0, b)), 2 * a), "") for h in (f, g))
    assert _proof(Derivation.of(same, (work,), (a,), "")).status is ProofStatus.REFUSED
    assert "rests on itself" not in _proof(Derivation.of(other, (work,), (a,), "")).remark


# --- dimensions ---------------------------------------------------------------------------------------------

MASS, FORCE, WAY, RATIO = (
    Quantity("a", "mass", "kg", "a%s"),
    Quantity("b", "force", "N", "b%s"),
    Quantity("c", "way", "m", "c%s"),
    Quantity("y", "exponent", "1", "y%s", positive=False),
)
WORDS = Vocabulary(MASS, FORCE, WAY, RATIO)


@pytest.mark.parametrize(
    ("members", "conditions", "problem"),
    [
        ((a, b), (), "a is in kg, b is in kg m s^-2"),
        ((a + c, b), (), "cannot add kg and m in a + c"),
        ((b, a * exp(c)), (), "the argument of a function must be a pure number, not m, in exp(c)"),
        ((a, a**c), (), "an exponent must be a pure number, not m, in a^c"),
        ((a, 2 * a * y), (a > c,), "cannot compare kg and m in a > c"),
        ((b, a * y, b * y), (), "b is in kg m s^-2, y*a is in kg"),
    ],
)
def test_what_mixes_dimensions_is_refused(
    members: tuple[Expr, ...], conditions: tuple[Expr, ...], problem: str
) -> None:
    mixing = Equation("(1)", members, "", Kind.DEFINITION, conditions=conditions)
    (found,) = prove(Ledger((mixing,), (), WORDS))
    assert (found.status, found.remark) == (ProofStatus.REFUSED, problem)
    (unsaid,) = prove(Ledger((mixing,)))
    assert unsaid.status is ProofStatus.DEFINITION
    premise = replace(mixing, number="", title="mixing")
    claim = Equation("(2)", (a**2 + c, a**2 + c), "")
    (found,) = prove(Ledger((Derivation.of(claim, (premise,), (a,), ""),), (), WORDS))
    assert found.status in (ProofStatus.REFUSED, ProofStatus.REFUTED)
    if found.status is ProofStatus.REFUSED:
        assert found.remark.startswith("mixing: ")


@pytest.mark.parametrize(
    "members",
    [
        (b * c**2, a * y),  # kg m^3/s^2 and kg
        (b * c ** (y + 1), b * c ** (1 + y) * y),
        (a, Integer(0)),
        (b, a * Symbol("g", positive=True)),  # nothing is said of g
        (sqrt(a), a ** Rational(1, 2)),
    ],
)
def test_only_what_is_known_to_differ_is_refused(members: tuple[Expr, ...]) -> None:
    (found,) = prove(Ledger((Equation("(1)", members, "", Kind.DEFINITION),), (), WORDS))
    differs = members == (b * c**2, a * y)
    assert (found.remark == "b*c^2 is in kg m^3 s^-2, y*a is in kg") is differs


def test_a_mass_is_no_coefficient() -> None:
    """The paper's reduced mass was proved to be its coefficient, from a definition that says so."""
    wrong = Equation("(20)", (model.m_red, model.C), "", Kind.DEFINITION)
    found = prove(replace(model.LEDGER, entries=(*model.LEDGER.entries, wrong)))
    assert found[-1].status is ProofStatus.REFUSED
    assert found[-1].remark == "m_red is in kg, C is in kg m^(1 - alpha) s^-2"
    assert all(proof.status.passes for proof in found[:-1])


# --- all of it together -------------------------------------------------------------------------------------


def said(number: str, *members: Expr, kind: Kind = Kind.DEFINITION) -> Equation:
    return Equation(number, members, "", kind)


@pytest.mark.parametrize(
    ("entries", "remarks"),
    [
        ((said("(1)", a, b + c), said("(2)", a, b + c + 1)), ["", "(2) cannot hold together with (1)"]),
        ((said("(1)", a, Integer(1)), said("(2)", a, Integer(2))), ["", "(2) cannot hold together with (1)"]),
        ((said("(1)", a, -b),), ["(1) cannot hold"]),
        (
            (said("(1)", a, b + c), said("(2)", a, b + c + c / 10**30)),
            ["", "(2) cannot hold together with (1)"],
        ),
        ((said("(1)", a, 1 + b), said("(2)", b, 1 + a)), ["", "(2) cannot hold together with (1)"]),
        (
            (said("(1)", a, 2 * b), said("(3)", y, c), said("(2)", b, 2 * c), said("(4)", c, 2 * a)),
            ["", "", "", "(4) cannot hold together with (1) and (2)"],
        ),
        (
            (said("(1)", a**2 + b**2, Integer(1)), said("(2)", a + b, Integer(3))),
            ["", "no point was found where (2) holds together with (1)"],
        ),
        (
            (said("(1)", a > b), said("(2)", b > a)),
            ["", "(2) cannot hold together with (1)"],
        ),
        (
            (said("(1)", a, b + 1), replace(said("(2)", c, 2 * b), conditions=(a < b,))),
            ["", "(2) cannot hold together with (1)"],
        ),
        ((said("(1)", X[q], b * q), said("(2)", X[2], b * 3)), ["", "(2) cannot hold together with (1)"]),
        (
            (said("(1)", X[q], b), said("(2)", Sum(X[q], (q, 1, n)), n * b + 1)),
            ["", "no point was found where (2) holds together with (1)"],
        ),
    ],
)
def test_assumptions_that_cannot_hold_together_are_refused(
    entries: tuple[Equation, ...], remarks: list[str]
) -> None:
    found = prove(Ledger(entries))
    assert [proof.remark for proof in found] == remarks
    meant = {"": ProofStatus.DEFINITION, "no": ProofStatus.UNDECIDED, "(": ProofStatus.REFUSED}
    assert [proof.status for proof in found] == [
        meant[remark[:2] if remark[:1] == "n" else remark[:1]] for remark in remarks
    ]


@pytest.mark.parametrize(
    "entries",
    [
        (said("(1)", a + b, Integer(3)), said("(2)", a - b, Integer(1))),
        (said("(1)", a**2 + b**2, Integer(1)), said("(2)", a + b, Rational(5, 4))),
        (said("(1)", a * exp(b), c), said("(2)", b * exp(a), c / 2), said("(3)", a + b + c, Integer(4))),
        (said("(1)", a, b + c), said("(2)", b, a - c), said("(3)", 2 * a, 2 * b + 2 * c)),
        (said("(1)", y, b - a), said("(2)", a > 2 * b), said("(3)", b > c), said("(4)", c > Rational(6, 10))),
        (said("(1)", X[q], b * q), said("(2)", Sum(X[q], (q, 1, n)), c), said("(3)", a, X[3] - X[1])),
        (said("(1)", n, Integer(50)), said("(2)", a, b * n)),
        (said("(1)", a, Sum(X[q], (q, 1, n)) / n), said("(2)", Sum((X[q] - a) ** 2, (q, 1, n)), b**2)),
        (said("(1)", Function("f")(y), a * y), said("(2)", b, Integral(Function("f")(y), (y, 0, c)))),
        (said("(1)", a, Integral(exp(-(y**2)), (y, 0, b))), said("(2)", a, Rational(1, 2))),
        (said("(1)", Symbol("gap"), abs(X[q] - X[n])),),
        (said("(1)", a, 2 * a * y), said("(2)", b * c, b * a)),
        (said("(1)", a * (b - 1), c - 2), said("(2)", c, Integer(2))),
        (said("(1)", y, Integer(0)), said("(2)", a * y, b * y)),
        (said("(1)", a > 100), said("(2)", b > a), said("(3)", c > b)),  # far from where they are drawn
        (said("(1)", Sum(X[q], (q, 1, n)), Integer(1)), said("(2)", a, Sum(q * X[q], (q, 1, n)))),
        (said("(1)", n**2 + n, Integer(56)), said("(2)", a, b**n)),
    ],
)
def test_assumptions_that_can_hold_together_are_left_alone(entries: tuple[Equation, ...]) -> None:
    assert [proof.status for proof in prove(Ledger(entries))] == [ProofStatus.DEFINITION] * len(entries)


MEAN = said("(1)", a, Sum(X[q], (q, 1, n)) / n)


@pytest.mark.parametrize(
    ("entries", "holds"),
    [
        ((MEAN, said("(2)", n, Integer(5)), said("(3)", Sum(X[q], (q, 1, n)), 5 * a)), True),
        ((MEAN, said("(2)", n, Integer(5)), said("(3)", Sum(X[q], (q, 1, n)), 6 * a)), False),
        ((MEAN, said("(2)", n, Integer(5)), said("(3)", n, Integer(6))), False),
        (
            (MEAN, said("(2)", n, Integer(5)), said("(3)", n, m + 1), said("(4)", b, Sum(X[q], (q, 1, m)))),
            True,
        ),
        (
            (
                MEAN,
                said("(2)", n, Integer(5)),
                said("(3)", m, n + 1),
                said("(4)", a, Sum(X[q] / m, (q, 1, m))),
            ),
            True,
        ),
        ((MEAN, said("(2)", n, Integer(5)), said("(3)", X[4], 5 * a), said("(4)", n > 4)), False),
        ((MEAN, said("(2)", n * a, b + Sum(X[q], (q, 1, 4)))), True),  # n is 5 or more
        ((MEAN, said("(2)", n, Integer(1000)), said("(3)", b, 1000 * c / n)), True),
        ((MEAN, said("(2)", n, Integer(1000)), said("(3)", b, 2 * c), said("(4)", c * n, 1000 * b)), False),
        ((MEAN, said("(2)", a, Sum(X[q], (q, 1, m)) / m), said("(3)", m, n * (n - 1) / 2)), True),
    ],
)
def test_sizes_are_chosen_so_that_what_is_said_of_them_holds(
    entries: tuple[Equation, ...], holds: bool
) -> None:
    assert all(proof.status.passes for proof in prove(Ledger(entries))) is holds


def test_a_definition_may_not_contradict_what_was_proved() -> None:
    wrong = said("(4)", a, 2 * b + c)
    found = prove(Ledger((FIRST, SECOND_HOLDS, wrong, said("(5)", y, a))))
    assert [proof.status for proof in found] == [
        ProofStatus.DEFINITION, ProofStatus.PROVED, ProofStatus.REFUSED, ProofStatus.DEFINITION,
    ]  # fmt: skip
    assert found[2].remark == "(4) cannot hold together with (1)"


def test_a_premise_may_not_contradict_what_stands() -> None:
    twice = assumed(a, 3 * b + c, title="twice")
    after = Equation("(3)", (a**2, (3 * b + c) ** 2), "")
    found = by_label(FIRST, SECOND_HOLDS, Derivation.of(after, (twice,), (a,), ""))
    assert found["(2)"].status is ProofStatus.PROVED
    assert found["(3)"].status is ProofStatus.REFUSED
    assert found["(3)"].remark == "twice cannot hold together with (1)"


def test_one_equation_is_proved_as_with_all_others() -> None:
    """With what it rests on, and no more; what the whole ledger does not agree with is refused here too."""
    told: list[str] = []
    ledger = Ledger((FIRST, SECOND_HOLDS, THIRD_HOLDS, said("(4)", c, b), said("(5)", c, 2 * b)))
    for entries in (ledger.entries[:4], ledger.entries):
        some = replace(ledger, entries=entries)
        whole = {proof.equation.label: proof for proof in prove(some)}
        assert all(prove(some, only=[label]) == (proof,) for label, proof in whole.items())
    assert whole["(5)"].status is ProofStatus.REFUSED
    prove(ledger, lambda equation: told.append(equation.label), only=["(2)"])
    assert told == ["(1)", "(2)", "(4)", "(5)"]
    alone = [prove(model.LEDGER, only=[label]) for label in ("(11)", "(12e)")]
    assert [proof for (proof,) in alone] == [
        p for p in prove(model.LEDGER) if p.equation.label in ("(11)", "(12e)")
    ]


def limit(*members: Expr) -> Equation:
    return Equation("", members, "", Kind.LIMIT, "none")


def test_a_limit_is_approached_and_not_reached() -> None:
    ratio = said("(1)", y, a / b)
    claims = (
        Derivation.of(Equation("(2)", (c + a, c + b * y), ""), (ratio,), (a,), ""),
        Derivation.of(Equation("(3)", (c * (1 + y), c), ""), (limit(y, Integer(0)),), (y,), ""),
    )
    found = by_label(ratio, *claims)
    assert {proof.status for proof in found.values()} == {ProofStatus.DEFINITION, ProofStatus.PROVED}
    assert found["(3)"].rests_on == ("none",)
    reached = replace(limit(y, Integer(0)), kind=Kind.ASSUMPTION)
    found = by_label(ratio, claims[0], Derivation.of(claims[1].claim, (reached,), (y,), ""))
    assert found["(3)"].remark == "none cannot hold together with (1)"
    # What has a value of its own does not go to zero.
    found = by_label(ratio, said("(4)", a, 2 * b), claims[1])
    assert found["(3)"].remark == "none cannot hold together with (1) and (4)"


@pytest.mark.parametrize("members", [(a, 2 * b), (y, Integer(1)), (y + w, Integer(0))])
def test_a_limit_is_a_quantity_that_goes_to_zero(members: tuple[Expr, ...]) -> None:
    claim = Equation("(2)", (c * members[0], c * members[1]), "")
    unknown = max(members[0].free_symbols, key=str)
    found = by_label(said("(1)", a, b), Derivation.of(claim, (limit(*members),), (unknown,), ""))
    assert found["(2)"].status is ProofStatus.REFUSED
    assert found["(2)"].remark == "none: a limit says of a quantity that it is zero"


def test_claims_for_different_domains_need_not_hold_at_one_point() -> None:
    root = said("(1)", y, a - b)
    sides = [
        Derivation.of(Equation(number, (sqrt(y**2), side), "", conditions=(condition,)), (root,), (y,), "")
        for number, side, condition in (("(2)", a - b, a > b), ("(3)", b - a, b > a))
    ]
    assert all(proof.status.passes for proof in prove(Ledger((root, *sides))))
    never = Equation("(4)", (sqrt(y**2) + c, a - b + c), "", conditions=(a > b,))
    small = said("(0)", a, b / 2)
    found = by_label(small, root, *sides, Derivation.of(never, (root,), (y,), ""))
    assert found["(2)"].remark == "(2) cannot hold together with (0)"


@pytest.mark.parametrize(
    ("wrong", "others"),
    [
        ((model.XM[1], 2 * model.XM[2] * (model.V[1] / model.V[2]) ** (2 / (model.alpha + 1))), "(12b)"),
        ((model.m_red, 2 * model.m_1), "(8)"),
        ((model.beta, Integer(2)), "(5)"),
    ],
)
def test_the_ledger_of_the_paper_refuses_what_contradicts_it(wrong: tuple[Expr, ...], others: str) -> None:
    added = Equation("(20)", wrong, "", Kind.DEFINITION)
    found = prove(replace(model.LEDGER, entries=(*model.LEDGER.entries, added)))
    assert found[-1].status is ProofStatus.REFUSED
    assert found[-1].remark == f"(20) cannot hold together with {others}"
    assert all(proof.status.passes for proof in found[:-1])


# --- what a claim rests on ----------------------------------------------------------------------------------


def test_a_claim_says_what_it_finally_rests_on() -> None:
    extra = assumed(c, 2 * y, title="c is twice y")
    fourth = Equation("(4)", (a**3, (b + 2 * y) ** 3), "", conditions=(y > 0,))
    last = Derivation.of(fourth, (THIRD, extra), (a, c), "")
    found = by_label(FIRST, SECOND_HOLDS, THIRD_HOLDS, last)
    assert {label: proof.rests_on for label, proof in found.items()} == {
        "(1)": (),
        "(2)": ("(1)",),
        "(3)": ("(1)",),
        "(4)": ("(1)", "c is twice y"),
    }


def test_the_claims_of_the_paper_rest_on_its_laws() -> None:
    found = {proof.equation.label: proof.rests_on for proof in prove(model.LEDGER)}
    work = "theorem of kinetic energy, {}"
    assert found["(9)"] == ("(3)",)
    assert found["(6)"] == ("(3)", work.format("compression"))
    assert set(found["(11)"]) == {"(3)", work.format("compression"), work.format("restitution")}
    assert set(found["(L2)"]) == {"(8)", "mass ratio", "immobile target"}
    assert found["(L6)"] == ()
    assert set(found["(L17)"]) == {
        "(L15)", "(L16)", "normal equation of the intercept", "normal equation of the slope",
    }  # fmt: skip
