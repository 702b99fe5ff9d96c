"""A cell and the column that is summed are one set of data: what is proved and refuted of both."""

import pytest
from proving import X, a, b, claim, decide, given, n, q
from sympy import Add, Dummy, Eq, Expr, IndexedBase, Integer, Piecewise, Sum, Symbol, exp, log, sin

from loopsheet.derivations.algebra import vanishes
from loopsheet.derivations.proved import ProofStatus
from loopsheet.derivations.sums import in_terms

Y = IndexedBase(Symbol("Y", real=True))
Z = IndexedBase(Symbol("Z", positive=True))
k, m, r = (Symbol(name, integer=True, positive=True) for name in "kmr")


def total(body: Expr, low: Expr | int = 1, high: Expr | int = n, index: Symbol = q) -> Sum:
    return Sum(body, (index, low, high))


@pytest.mark.parametrize(
    ("left", "right", "conditions"),
    [
        (total(X[q]), X[1] + total(X[q], 2), ()),
        (total(X[q]), X[1] + X[2] + total(X[q], 3), ()),
        (total(X[q]), total(X[q], 1, n - 1) + X[n], ()),
        (total(X[q], 1, n + 1), total(X[q]) + X[n + 1], ()),
        (total(X[q]), X[1] + X[n] + total(X[q], 2, n - 1), (n > 1,)),
        (total(X[q]), X[1] + X[n] + total(X[q], 2, n - 1), (n >= 2,)),
        (total(X[q]) - total(X[q], 1, k - 1) - total(X[q], k + 1), X[k], ()),
        (total(X[q] ** 2 + X[q]), X[1] ** 2 + X[1] + total(X[q] ** 2, 2) + total(X[r], 2, n, r), ()),
        (total((X[q] - X[1]) ** 2), total((X[q] - X[1]) ** 2, 2), ()),
        (total(X[q]) / n - X[k], total(X[q] - X[k]) / n, ()),
        (total(X[q + 1] - X[q], 1, n - 1), X[n] - X[1], ()),
        (Sum(X[q] * Y[r], (q, 1, n), (r, 1, m)), total(X[q]) * total(Y[q], 1, m), ()),
        (Sum(X[q] * X[r], (q, 1, n), (r, 1, n)), total(X[q]) ** 2, ()),
        (Sum(X[r], (r, 1, q), (q, 1, n)), X[1] + Sum(X[r], (r, 1, q), (q, 2, n)), ()),
        (total(q**2 * b), b * n * (n + 1) * (2 * n + 1) / 6, ()),
        (total(X[q], 1, 3), X[1] + X[2] + X[3], ()),
        (total(X[q]) + X[7], total(X[q], 2) + X[7] + X[1], ()),
        (Piecewise((X[1], Eq(k, 1)), (X[k], True)), X[k], ()),
        (total(1 / q, 2), total(1 / q) - 1, ()),
    ],
)
def test_a_cell_is_one_of_the_data_that_are_summed(
    left: Expr, right: Expr, conditions: tuple[Expr, ...]
) -> None:
    assert decide(claim(left, right, conditions=conditions)).sentence.startswith("residual 0; 20 points")
    assert decide(claim(left + a / 10**20, right, conditions=conditions)).status is ProofStatus.REFUTED


@pytest.mark.parametrize(
    ("left", "right", "at"),
    [
        (total(X[q]), X[2] + total(X[q], 2), {}),
        (total(X[q]), 2 * X[1] + total(X[q], 2), {}),
        (total(X[q]), X[1] + X[n] + total(X[q], 2, n - 1), {"n": "1.0"}),  # the first is the last
        (total(X[q]), X[1] + X[2] + total(X[q], 2), {}),
        (Sum(X[q] * X[r], (q, 1, n), (r, 1, n)), total(X[q] ** 2), {}),
        (total(X[q]) - total(X[q], 1, m), total(X[q], m + 1), {}),  # m may be larger than n
        (total(X[q]), n * X[k], {}),
        (X[k] * (k - 1), X[1] * (k - 1), {}),
    ],
)
def test_what_is_wrong_of_the_data_is_refuted(left: Expr, right: Expr, at: dict[str, str]) -> None:
    found = decide(claim(left, right))
    assert found.status is ProofStatus.REFUTED
    assert at.items() <= found.counterexample.items()


def test_the_rows_of_a_counterexample_yield_its_sides() -> None:
    found = decide(claim(total(X[q]), 2 * X[1] + total(X[q], 2)))
    rows = [float(row) for row in found.counterexample["X"].strip("()").split(",")]
    assert len(rows) == float(found.counterexample["n"])
    assert [float(side) for side in found.sides] == pytest.approx([sum(rows), sum(rows) + rows[0]], rel=1e-4)
    far = decide(claim(X[4], X[9] + 0 * total(X[q])))
    assert set(far.counterexample) == {"X_4", "X_9"}


def test_a_row_that_is_eliminated_is_eliminated_from_the_sum() -> None:
    first = (given(X[1], b), X[1])
    assert decide(claim(b + total(X[q], 2), total(X[q])), first).status is ProofStatus.PROVED
    wrong = decide(claim(2 * b + total(X[q], 2), total(X[q])), first)
    assert wrong.status is ProofStatus.REFUTED
    assert wrong.counterexample["X"].startswith(f"({wrong.counterexample['b']}")
    found = decide(claim(X[1], b), (given(X[1], b - total(X[q])), X[1]))
    assert found.why.endswith("holds X_1 also as one of all its rows")


def test_a_premise_speaks_only_of_rows_that_there_are() -> None:
    found = decide(claim(total(X[q]), n * b), (given(X[k], b), X[k]))
    assert found.why == "X[k] = b holds only where n >= k, which (1) does not say"
    assert (
        decide(claim(X[k] + total(X[q]), b + total(X[q])), (given(X[k], b), X[k])).status
        is ProofStatus.PROVED
    )


@pytest.mark.parametrize(
    ("left", "right"),
    [
        (total(Z[q, 1]), total(Z[q, 2])),
        (total(X[q / 2]), total(X[q / 2])),
        (total(X[q - 1]), total(X[q - 1])),  # there is no row 0
        (total(1 / (q - 1)), total(1 / (q - 1))),
        (Sum(X[q], (q, 1, n / 2)), Sum(X[q], (q, 1, n / 2))),
    ],
)
def test_rows_that_do_not_exist_prove_nothing(left: Expr, right: Expr) -> None:
    found = decide(claim(left, right))
    assert found.status is ProofStatus.UNDECIDED
    assert "has several indices, and one of them runs" in found.why or "has no value at" in found.why


# --- sums in one form ---------------------------------------------------------------------------------------

ROW, INNER, SIZE, PART = (Symbol(name, integer=True, positive=True) for name in ("j", "i", "n", "m"))
A_X, A_Y = (IndexedBase(Symbol(name, real=True)) for name in "xy")
WHOLE = Sum(A_X[INNER], (INNER, 1, SIZE))
"""Of a column, by itself."""


@pytest.mark.parametrize(
    ("one", "other", "unlike"),
    [
        (1 / ((WHOLE + 1) * A_Y[ROW] + 1), 1 / (WHOLE * A_Y[ROW] + A_Y[ROW] + 1), 1 / (WHOLE * A_Y[ROW] + 1)),
        (exp((WHOLE + 1) * A_Y[ROW]), exp(WHOLE * A_Y[ROW]) * exp(A_Y[ROW]), exp(WHOLE * A_Y[ROW])),
        (
            log((A_X[ROW] - WHOLE / SIZE) ** 2 + 1),
            log(A_X[ROW] ** 2 - 2 * A_X[ROW] * WHOLE / SIZE + WHOLE**2 / SIZE**2 + 1),
            log(A_X[ROW] ** 2 - WHOLE**2 / SIZE**2 + 1),
        ),
        (A_Y[ROW] / (WHOLE**2 + 1), A_Y[ROW] * (1 / (1 + WHOLE**2)), A_Y[ROW] / (WHOLE**2 + 2)),
    ],
)
def test_sums_beside_sums_have_one_form(one: Expr, other: Expr, unlike: Expr) -> None:
    first, second, third = (in_terms(Sum(each, (ROW, 1, SIZE))) for each in (one, other, unlike))
    assert first == second == in_terms(first)
    assert first != third


def test_a_sum_may_choose_between_its_row_and_another_sum() -> None:
    chosen = Piecewise((A_Y[ROW], A_Y[ROW] > 0), (WHOLE, True))
    assert in_terms(Sum(chosen, (ROW, 1, SIZE))).has(Piecewise)
    inner = Sum(exp(Sum(A_X[INNER], (INNER, 1, PART)) ** 2 * A_Y[ROW]), (ROW, 1, SIZE))
    assert len(in_terms(Sum(inner, (SIZE, 1, 3))).args) == 3


def test_a_form_that_was_changed_is_formed_again() -> None:
    """A sum that is put in nests sums deeper: no running number takes that of another for its own."""
    double = Sum(exp(a * A_X[INNER] * A_Y[ROW]), (INNER, 1, SIZE), (ROW, 1, SIZE))
    diagonal = SIZE * Sum(exp(a * A_X[ROW] * A_Y[ROW]), (ROW, 1, SIZE))
    inside = {a: Sum(A_X[INNER], (INNER, 1, PART))}
    twice = in_terms(in_terms(double).xreplace(inside))
    assert twice == in_terms(double.xreplace(inside)) == in_terms(twice)
    assert not vanishes(twice - diagonal.xreplace(inside))
    one = in_terms(in_terms(Sum(exp(a * A_Y[ROW]), (ROW, 1, SIZE))).xreplace(inside))
    assert in_terms(one.xreplace({SIZE: Integer(3)})).func is Add


def test_the_end_of_an_inner_sum_is_that_of_the_sum_which_it_stands_in() -> None:
    """Both count to j here, and the one whose number is j is the nearer."""
    near, far = (Sum(A_X[INNER], (INNER, 1, ROW), (own, 1, ROW), (ROW, 1, SIZE)) for own in (ROW, PART))
    assert in_terms(near) != in_terms(far)
    right = Sum(A_X[INNER], (INNER, 1, PART), (PART, 1, ROW), (ROW, 1, SIZE))
    assert in_terms(near) == in_terms(right)


@pytest.mark.parametrize("count", [8, 9, 98, 99, 100])
def test_a_form_does_not_hang_on_what_was_formed_before(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    body = sin(ROW - INNER) * A_X[ROW] * A_Y[INNER]
    first = in_terms(Sum(body, (ROW, 1, SIZE), (INNER, 1, SIZE)))
    monkeypatch.setattr(Dummy, "_count", count)
    assert in_terms(Sum(body, (ROW, 1, SIZE), (INNER, 1, SIZE))) == first
