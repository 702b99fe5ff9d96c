"""The rows of index sets, their labels, and which rows a rule names."""

import numpy as np
import pytest
from helpers import whole
from hypothesis import given
from hypothesis import strategies as st
from sympy import Sum, Symbol

from loopsheet.derivations.equation import Equation
from loopsheet.report.cells.layout import lay_out, precedents
from loopsheet.report.sheet import Axis, Column, CountedAxis, Formula, Given, PairAxis, RepeatAxis, Sheet

k, i, j, p, q, s, r, t = (whole(name) for name in "kijpqsrt")
ROWS = Axis("rows", k, whole("n"))
PAIRS = PairAxis("pairs", p, whole("n_pairs"), of=ROWS, first=i, second=j)
POINTS = RepeatAxis("points", q, whole("n_points"), of=PAIRS, step=s, count="count")
TICKS = RepeatAxis("ticks", r, whole("n_ticks"), of=POINTS, step=t, count="often")
a, count, often = Column("a", ROWS, Given()), Column("count", None, Given()), Column("often", None, Given())
tick = Column("tick", TICKS, Formula(Equation("(T)", (Symbol("tick"), a[i] * s + t), "for this test")))
SHEET = Sheet((a, count, often, tick))


def test_pairs_are_in_lexical_order_and_carry_the_labels_of_their_members() -> None:
    layout = lay_out(SHEET, {"rows": [3, 7, 5]}, {"count": 1, "often": 1})["pairs"]
    assert layout.labels.tolist() == [[3, 7], [3, 5], [7, 5]]
    assert layout.rows["i"].tolist() == [0, 0, 1]
    assert layout.rows["j"].tolist() == [1, 2, 2]
    assert layout.rows["p"].tolist() == [0, 1, 2]


def test_a_repeated_axis_of_a_repeated_axis_keeps_both_running_numbers() -> None:
    layout = lay_out(SHEET, {"rows": [1, 2]}, {"count": 2, "often": 3})["ticks"]
    assert layout.size == 6
    assert layout.ordinals["s"].tolist() == [1, 1, 1, 2, 2, 2]
    assert layout.ordinals["t"].tolist() == [1, 2, 3, 1, 2, 3]
    assert layout.labels.tolist()[-1] == [1, 2, 2, 3]
    assert set(layout.rows) == set("pijqr")


def test_a_counted_axis_has_its_rows_whatever_the_data() -> None:
    way = CountedAxis("way", whole("m"), whole("n_way"), whole("c"), 3)
    point = Column("point", way, Formula(Equation("(P)", (Symbol("point"), way.step), "for this test")))
    for rows in ([], [1, 4]):
        layout = lay_out(Sheet((*SHEET.columns, point)), {"rows": rows}, {"count": 1, "often": 1})["way"]
        assert (layout.size, layout.labels.tolist()) == (3, [[1], [2], [3]])
        assert layout.ordinals["c"].tolist() == [1, 2, 3]
        assert layout.rows["m"].tolist() == [0, 1, 2]


@given(st.integers(0, 12), st.integers(0, 4))
def test_sizes_follow_from_the_number_of_rows(rows: int, repeat: int) -> None:
    layouts = lay_out(SHEET, {"rows": range(1, rows + 1)}, {"count": repeat, "often": 2})
    pairs = rows * (rows - 1) // 2
    sizes = {"rows": rows, "pairs": pairs, "points": pairs * repeat, "ticks": pairs * repeat * 2}
    assert {name: layout.size for name, layout in layouts.items()} == sizes
    for layout in layouts.values():
        assert layout.labels.shape[0] == layout.size
        assert all(row.shape == (layout.size,) for row in layout.rows.values())


@pytest.mark.parametrize("number", [-1, 2.5])
def test_a_count_is_a_whole_number(number: float) -> None:
    with pytest.raises(ValueError, match=rf"^count must be a whole number of at least 0, not {number}$"):
        lay_out(SHEET, {"rows": [1, 2]}, {"count": number, "often": 1})  # type: ignore[dict-item]


def test_precedents_say_which_rows_are_named_and_which_are_summed() -> None:
    step = Column("step", PAIRS, Formula(Equation("(T)", (Symbol("step"), a[j] - a[i]), "")))
    share = Formula(Equation("(T)", (Symbol("share"), step[p] / Sum(step[p], (p, 1, PAIRS.size))), ""))
    column = Column("share", PAIRS, share)
    sheet = Sheet((a, step, column))
    layouts = lay_out(sheet, {"rows": [1, 2, 3]}, {})
    first, second = precedents(sheet, layouts, step)
    assert (first.column, first.over, first.row(2), second.row(2)) == (a, None, 1, 2)
    assert second.take(np.array([[1.0, 2.0, 3.0]])).tolist() == [[2.0, 3.0, 3.0]]
    own, summed = precedents(sheet, layouts, column)
    assert (own.over, summed.over) == (None, PAIRS)
    assert own.row(2) == 2


def test_two_hundred_rows_make_19_900_pairs() -> None:
    layouts = lay_out(SHEET, {"rows": range(1, 201)}, {"count": 5, "often": 1})
    assert (layouts["pairs"].size, layouts["points"].size) == (19_900, 99_500)
    assert layouts["pairs"].labels[-1].tolist() == [199, 200]
    assert layouts["points"].labels[-1].tolist() == [199, 200, 5]
