"""What an equation is: its author's order, its instances, its place in a ledger."""

import pytest
from sympy import Add, Expr, IndexedBase, Integral, Mul, Piecewise, Sum, Symbol, sqrt
from sympy.core.parameters import evaluate

from loopsheet.derivations.equation import Derivation, Equation, Kind, Ledger, Step
from loopsheet.derivations.rebuilt import evaluated
from loopsheet.derivations.text import text, text_of_equation
from loopsheet.derivations.vocabulary import NO_WORDS

a, b, c, x = (Symbol(name, positive=True) for name in "abcx")
k = Symbol("k", integer=True, positive=True)
V = IndexedBase(Symbol("V", positive=True))

with evaluate(False):
    ORDERED = Equation("(7)", (c + b - a, b * a / c), "because", part="b", defines=c, conditions=(c > a,))
    OF_TEST = Equation("(8)", (V[k] * b, sqrt(c) + V[k]), "because")
LAW = Equation("(3)", (a, Piecewise((b, x < 1), (c, True))), "a law", Kind.ASSUMPTION, "law")


def test_the_author_orders_the_terms() -> None:
    assert text_of_equation(ORDERED, NO_WORDS) == "c + b - a = b*a/c"
    assert text_of_equation(ORDERED.at({a: x}), NO_WORDS) == "c + b - x = b*x/c"
    assert ORDERED.members[0].args[-1] == Mul(-1, a, evaluate=False)


def test_what_is_computed_is_the_same_evaluated() -> None:
    assert ORDERED.sides == (b + c - a, a * b / c)
    assert ORDERED.value == a * b / c
    assert ORDERED.residuals == (b + c - a - a * b / c,)
    with evaluate(False):
        doubled = Add(a, a)
    assert evaluated(doubled) == 2 * a
    assert evaluated(3) == 3


def test_integrals_and_sums_stay() -> None:
    for loop in (Integral(x + x, (x, 0, 1)), Sum(V[k], (k, 1, 3))):
        assert isinstance(evaluated(loop), type(loop))


@pytest.mark.parametrize(
    ("number", "part", "title", "label", "own"),
    [
        ("(12)", "a", "", "(12a)", False),
        ("(9)", "", "t", "(9)", False),
        ("(L3)", "", "", "(L3)", True),
        ("", "", "t", "t", False),
    ],
)
def test_label(number: str, part: str, title: str, label: str, own: bool) -> None:
    equation = Equation(number, (a, b), "", part=part, title=title)
    assert (equation.label, equation.own) == (label, own)


def test_at_puts_everything_in() -> None:
    moved = ORDERED.at({c: x})
    assert moved.members[0].args[0].args[0] == x
    assert moved.defines == x
    assert moved.conditions == (x > a,)
    assert moved.printed is None
    assert moved.origin == ORDERED
    assert moved.label == "(7b)"


def test_at_puts_in_at_once_not_one_after_the_other() -> None:
    assert Equation("(1)", (a, b), "").at({a: b, b: a}).members == (b, a)


def test_instances_of_instances_remember_their_origin() -> None:
    first = OF_TEST.at({k: 1 * k / k})
    assert first.members == (OF_TEST.at({k: 1}).members[0], first.members[1])
    twice = ORDERED.at({a: b * c}).at({b: x}).reversed
    assert twice.origin == ORDERED
    assert twice.follows_from_origin
    assert text(twice.members[0], NO_WORDS) in ("x*(x*c)/c", "x*x*c/c")


def test_brief_and_reversed() -> None:
    chain = Equation("(6)", (a, b, c), "")
    assert chain.brief.members == (a, c)
    assert chain.reversed.members == (c, b, a)
    assert chain.brief.origin == chain
    assert chain.brief.follows_from_origin
    assert chain.reversed.follows_from_origin


def test_one_branch_of_a_law() -> None:
    second = LAW.branch(1, "the other")
    assert second.members == (a, c)
    assert (second.label, second.because, second.kind) == ("(3)", "the other", Kind.ASSUMPTION)
    assert second.origin == LAW


@pytest.mark.parametrize("new", [-b, b - c, Symbol("r", real=True)])
def test_an_instance_outside_the_domain_does_not_follow(new: Expr) -> None:
    assert not ORDERED.at({a: new}).follows_from_origin
    assert ORDERED.at({a: b + c}).follows_from_origin


def test_a_ledger_is_asked_by_label() -> None:
    derivation = Derivation.of(ORDERED, (LAW,), (a,), "says")
    ledger = Ledger((LAW, derivation))
    assert [equation.label for equation in ledger.equations()] == ["(3)", "(7b)"]
    assert ledger["(7b)"] is ORDERED
    assert ledger.derivation(ORDERED) is derivation
    assert ledger.derivation(LAW) is None
    with pytest.raises(KeyError):
        ledger["(7)"]


def test_a_number_stands_for_one_equation() -> None:
    other = Equation("(3)", (b, c), "")
    with pytest.raises(ValueError, match=r"^the ledger has two equations \(3\); a number has exactly one$"):
        Ledger((LAW, ORDERED, other))
    assert Ledger((LAW, Equation("(3)", (b, c), "", part="b"), *(Equation("", (a, b), ""),) * 2))


def test_a_derivation_ends_in_its_claim() -> None:
    other = Equation("(9)", (a, b), "")
    steps = (Step(other, (), (), ""), Step(ORDERED, (other,), (a,), ""))
    assert Derivation(steps).claim is ORDERED
    assert Derivation.of(ORDERED, (other,), (a,), "") == Derivation((steps[1],))
