"""The referee's parts, each by itself: digits, boxes, ways to print a cell, and what is certain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from small_report import found, problem, pure
from sympy import sqrt
from test_referee_explanations import ROWS, SHEET, X, formula, k

from loopsheet.report.inputs.published import PublishedValue
from loopsheet.report.referee import misprints, search
from loopsheet.report.referee.certificate import Certificate, excluded
from loopsheet.report.referee.digits import is_slip, moved, respelt, slips
from loopsheet.report.referee.explain import Doubts, _digits_moved
from loopsheet.report.referee.minimax import Best, _Counted
from loopsheet.report.referee.problem import Box, Problem
from loopsheet.report.referee.search import Explained, Search
from loopsheet.report.result.verdict import EXACT, NOT_CHECKABLE, Change, Explanation, TableVerdict
from loopsheet.report.sheet import Column, Sheet

Ways = Callable[[int], object]


def squares(x: str, square: str) -> Problem:
    """Of some printed numbers and their printed squares."""
    cells = [PublishedValue("T", "square", (n,), pure(text)) for n, text in enumerate(square.split(), 1)]
    return problem(SHEET, {"x": [pure(text) for text in x.split()]}, cells)


# --- digits ---


@pytest.mark.parametrize(
    ("text", "units", "again"),
    [("29.7", 1, "29.8"), ("29.7", -300, "-0.3"), ("1.50e-3", 7, "1.57e-3"), ("99", 1, "100")],
)
def test_so_many_units_further(text: str, units: int, again: str) -> None:
    found = respelt(pure(text), units)
    assert (found.text, found.value) == (again, Fraction(again))
    assert moved(pure(text), found.value) == units


def test_the_nearest_number_of_units_is_told() -> None:
    assert [moved(pure("2.0"), Fraction(text)) for text in ("2.04", "2.06", "1.94", "3")] == [0, 1, -1, 10]


def test_one_slip_changes_two_neighbours_or_one_digit() -> None:
    assert set(slips("1.2")) == {"2.1", *(f"{n}.2" for n in "023456789"), *(f"1.{n}" for n in "013456789")}
    assert [is_slip("29.7", other) for other in ("27.9", "92.7", "29.8", "79.2", "28.8", "29.7")] == [
        True, True, True, False, False, False,
    ]  # fmt: skip
    assert not any("e3" not in text for text in slips("1.2e3"))


# --- how a cell would be printed ---


def between(low: int, high: int) -> Ways:
    return lambda units: units if low <= units <= high else None


@pytest.mark.parametrize("furthest", [0, 1, 2, 3, 6, 7, 8, 1000])
def test_the_ways_to_print_a_cell_are_followed_to_both_ends(furthest: int) -> None:
    ways = between(4 - furthest, 4 + furthest)
    assert [misprints._last(4, way, ways) for way in (-1, 1)] == [4 - furthest, 4 + furthest]  # type: ignore[arg-type]


def test_they_are_followed_only_so_far() -> None:
    assert misprints._last(0, 1, lambda units: units) == misprints.FURTHEST - 1  # type: ignore[arg-type, return-value]


def test_slips_come_first_then_the_middle_and_never_what_is_printed() -> None:
    # From 1.75 to 1.79 each is a slip, from 1.98 to 2.02 none.
    assert misprints._in_order(pure("1.77"), -2, 2, None) == [-1, 1, -2, 2]
    assert misprints._in_order(pure("1.77"), 21, 25, None) == [23, 22, 24, 21, 25]
    assert misprints._in_order(pure("1.77"), 20, 24, None)[0] == 20, "1.97"
    assert misprints._in_order(pure("1.77"), 21, 25, 25) == [25, 23, 22, 24, 21], "what is recomputed"
    assert len(misprints._in_order(pure("1.77"), 1000, 2000, None)) == 2 * misprints.LISTED + 1


def test_a_misprint_is_looked_for_up_to_ten_times_what_is_printed() -> None:
    asked = squares("2.0 -3.0 0.0", "4.0 9.0 0.0")
    assert [misprints._range(asked, n) for n in range(3)] == [(0.2, 20.0), (-30.0, -0.3), (-3.0, 3.0)]
    for n, (low, high) in enumerate(((0.2, 20.0), (-30.0, -0.3))):
        edges = misprints._edges(asked, n)
        assert (edges[0], edges[-1], len(edges)) == (pytest.approx(low), pytest.approx(high), 161)
        assert np.diff(np.log(np.abs(edges))) == pytest.approx((1 - 2 * n) * np.log(100) / 160)
    assert misprints._edges(asked, 2) == pytest.approx(np.linspace(-3, 3, 161))


def test_pieces_hang_together_with_their_neighbours() -> None:
    alive = [1, 2, 3, 5, 6]
    assert [misprints._run(place, alive) for place in alive] == [(1, 3)] * 3 + [(5, 6)] * 2


# --- which is likelier ---


def misprint(printed: str, would: str) -> Change:
    return Change("misprint", "x", (1,), "input", printed, would)


NO_DOUBTS = Doubts()


def likelihood(change: Change, mismatch: float = 0.5, doubts: Doubts = NO_DOUBTS) -> tuple[float, ...]:
    one = Explanation((change,), mismatch, 3, 3)
    return doubts.likelihood(Explained(one, None, None, None))  # type: ignore[arg-type]


def test_a_slip_is_likelier_than_other_digits_and_what_holds_for_many_likelier_still() -> None:
    unit = Change("unit", "x", (), "input", "", "", power=3)
    short, long = (Change("parameter", "beta", (), "input", "1.5", text) for text in ("1.25", "1.253"))
    found = [unit, short, misprint("29.7", "29.8"), misprint("29.7", "30.8"), long]
    assert [likelihood(change)[0] for change in found] == [0, 0, 1, 2, 2]
    assert likelihood(unit, 0.1) < likelihood(unit, 0.9)


def test_a_slip_of_what_alone_does_not_print_is_likeliest_and_of_what_is_exact_least_likely() -> None:
    """What accuses nobody stands before it, for then nothing is wrong."""
    doubts = Doubts(0, ("T", "y", ()), frozenset({("x", (1,))}))
    rounded = Change("printed", "", (), "T", "", "y", count=0)
    unit = Change("unit", "x", (), "input", "", "", power=3)
    slip, other = (Change("misprint", "y", (), "T", "104.0", would) for would in ("103.0", "97.2"))
    found = [rounded, slip, unit, other, misprint("29.7", "29.8")]
    assert [likelihood(change, doubts=doubts)[0] for change in found] == [-2, -1, 0, 2, 3]


@pytest.mark.parametrize(
    ("printed", "would", "units"), [("29.7", "29.9", 2), ("3263", "3236", 27), ("1.250", "1.257", 7)]
)
def test_digits_that_move_are_counted_in_units_of_the_last(printed: str, would: str, units: float) -> None:
    assert _digits_moved(misprint(printed, would)) == units
    assert _digits_moved(replace(misprint(printed, would), kind="printed")) == 0


# --- what is certain, and what was found ---


def test_a_table_without_any_value_is_told_and_the_others_are_judged() -> None:
    half = Column("half", ROWS, formula("half", sqrt(X[k])), positive=False)
    square = Column("square", ROWS, formula("square", X[k] ** 2), positive=False)
    cells = [
        PublishedValue("Squares", "square", (1,), pure("1.72")),
        PublishedValue("Roots", "half", (1,), pure("1.15")),
    ]
    of = found(Sheet((X, half, square)), {"x": [pure("-1.31")]}, cells)
    assert [verdict.verdict for verdict in of.values] == [EXACT, NOT_CHECKABLE]
    squares, roots = of.tables
    assert (squares.source, squares.values, squares.verdict) == ("Squares", 1, EXACT)
    assert roots == TableVerdict("Roots", 0, NOT_CHECKABLE)


def test_a_box_is_excluded_if_a_value_certainly_does_not_come_out() -> None:
    asked = squares("1.310 1.770", "1.716 3.133")
    boxes = [asked.box, *(asked.box.moved([n], [1.9], [2.0], 1.95) for n in range(2))]
    assert excluded(asked, boxes).tolist() == [False, True, True]
    assert excluded(asked.ignoring({0}), boxes).tolist() == [False, False, True]
    edge = asked.box.moved([0], [1.3097], [1.3097], 1.3097)  # its square is 1.71531..., printed 1.715
    assert excluded(asked, [edge]).tolist() == [True]


@pytest.mark.parametrize(("mismatch", "is_met"), [(1.0, True), (1.0000001, False)])
def test_what_is_off_by_half_a_unit_still_prints_so(
    mismatch: float, is_met: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = squares("1.310", "1.716")
    best = Best(asked.box.start, np.array([1.7161]), mismatch, np.ones(1))
    sought = list[Best]()

    def meet(problem: Problem, box: Box | None, found: Best, until: float) -> Best:
        sought.append(found)
        return found

    monkeypatch.setattr(search, "best", lambda *_: best)
    monkeypatch.setattr(search, "meet", meet)
    searching = Search(asked)
    assert (searching.met(asked, wide=True) is best) == is_met
    assert (len(sought), searching.open) == ((0, 0) if is_met else (1, 1))


def test_a_search_counts_in_intervals_and_where_they_are_wide_in_logarithms() -> None:
    low, high, point = (
        np.array([1e-3, 2.0, 5.0, -1.0]),
        np.array([10.0, 3.0, 5.0, 90.0]),
        np.array([1.0, 2.5, 5.0, 1.0]),
    )
    counted = _Counted.of(Box(low, high, point), point)
    assert counted.log.tolist() == [True, False, False, False]
    assert counted.scale == pytest.approx([0.1, 0.25, 0.0, 0.1])
    assert counted.to(point) == pytest.approx([0.0, 10.0, 0.0, 10.0])
    moving = counted.scale > 0
    assert counted.back(counted.to(point))[moving] == pytest.approx(point[moving])
    step = 1e-6
    by_step = (counted.back(counted.to(point) + step) - counted.back(counted.to(point))) / step
    assert counted.slope(point) == pytest.approx(by_step, rel=1e-5)


def test_bounds_are_narrow_where_intervals_alone_forget_that_both_factors_are_one_number() -> None:
    """About 1, x (2 - x) moves by the square of what x moves by: 5e-5 for .005; the factors tell .02."""
    turn = Column("turn", ROWS, formula("turn", X[k] * (2 - X[k])), positive=False)
    cells = [PublishedValue("T", "turn", (1,), pure("1.00"))]
    bounds = Certificate(problem(Sheet((X, turn)), {"x": [pure("1.00")]}, cells)).bounds
    assert (bounds.low, bounds.high) == (pytest.approx([1], abs=6e-5), pytest.approx([1], abs=6e-5))
    assert bounds.low[0] <= 1 - 0.005**2
    assert bounds.high[0] >= 1
