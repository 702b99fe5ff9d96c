"""Each thing that may explain what was published, alone, on a sheet of squares; and what is certain."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from statistics import mean, stdev

import pytest
from helpers import method_folder
from small_report import found, pure
from sympy import Sum, Symbol, sin, sqrt

from loopsheet.derivations.equation import Equation, Kind
from loopsheet.derivations.unit_text import parse_unit
from loopsheet.report.distribution import Error
from loopsheet.report.inputs.published import Pin, PublishedValue
from loopsheet.report.quantity import Printed
from loopsheet.report.referee import certificate, misprints, search
from loopsheet.report.referee.digits import is_slip
from loopsheet.report.referee.scales import shifted
from loopsheet.report.result import verdict_words as words
from loopsheet.report.result.verdict import REACHABLE, WITHIN, Change, Explanation, Referee
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.study import Study

k, n = (Symbol(name, integer=True, positive=True) for name in "kn")
ROWS = Axis("rows", k, n)


def formula(name: str, expression: object) -> Formula:
    return Formula(Equation("", (Symbol(name), expression), "for a test", Kind.DEFINITION))


X = Column("x", ROWS, Given(), positive=False)
SQUARE = Column("square", ROWS, formula("square", X[k] ** 2), positive=False)
TENFOLD = Column("tenfold", ROWS, formula("tenfold", 10 * SQUARE[k]), positive=False)
HUNDREDFOLD = Column("hundredfold", ROWS, formula("hundredfold", 10 * TENFOLD[k]), positive=False)
MEAN = Column("mean", None, formula("mean", Sum(SQUARE[k], (k, 1, n)) / n), positive=False)
SHEET = Sheet((X, SQUARE, TENFOLD, HUNDREDFOLD, MEAN))


def said(x: str, **published: str) -> Referee:
    """Of the squares of some printed numbers; each published column is printed in a line."""
    return found(SHEET, {"x": [pure(text) for text in x.split()]}, in_table(published))


def in_table(published: Mapping[str, str]) -> list[PublishedValue]:
    return [
        PublishedValue("Table", name, () if SHEET[name].axis is None else (row,), pure(text))
        for name, line in published.items()
        for row, text in enumerate(line.split(), 1)
    ]


def changes(of: Referee) -> list[list[tuple[str, str, tuple[int, ...], str]]]:
    return [
        [(one.kind, one.cell, one.index, one.would_print) for one in each.changes] for each in of.explanations
    ]


def first(of: Referee) -> Change:
    return of.explanations[0].first


def test_a_search_that_begins_where_nothing_leads_on_begins_elsewhere_too() -> None:
    """In the middle of what prints as 0, the square does not change with it."""
    of = said("0 0", square="0.16 0.04", tenfold="1.6 0.4")
    assert of.joint is not None
    assert of.joint.verdict == REACHABLE


def test_computed_from_what_is_printed_accuses_nobody() -> None:
    of = said("1.2340 2.3120", square="1.5 5.3", tenfold="15.00 53.00")
    assert changes(of) == [[("printed", "tenfold", (), "square")]]
    assert of.explanations[0].count == 0
    assert of.as_printed
    assert words.claimed(first(of)) == "tenfold of Table was computed from the printed, rounded square"


@pytest.mark.parametrize(
    ("mean", "rows"),
    [("6.333", "without test 4"), ("24.600", "with test 4 twice"), ("22.333", "without test 2")],
)
def test_a_mean_over_other_rows(mean: str, rows: str) -> None:
    """The mean of 1, 4, 14 and 52 is 17.75."""
    of = said("1.00000 2.00000 3.74166 7.21110", square="1.000 4.000 14.000 52.000", mean=mean)
    assert changes(of)[0] == [("rows", "mean", (), rows)]


@pytest.mark.parametrize(
    ("x", "square", "cell"),
    [
        ("1.200 2.300 3.100", "1440 5290 9610", "square"),
        ("1200 2300 3100", "1.440 5.290 9.610", "x"),
    ],
)
def test_a_unit_off_by_a_power_of_ten(x: str, square: str, cell: str) -> None:
    of = said(x, square=square)
    assert changes(of)[0] == [("unit", cell, (), "")]
    assert first(of).power == -3


@pytest.mark.parametrize(
    ("x", "square", "cell", "factor"),
    [
        ("1.200 2.300 3.100", "2.880 10.580 19.220", "square", "1/2"),
        ("1.200 2.300 3.100", "0.7200 2.6450 4.8050", "square", "2"),
        ("1.200 2.300 3.100", "5.760 21.160 38.440", "x", "2"),
    ],
)
def test_a_radius_for_a_diameter(x: str, square: str, cell: str, factor: str) -> None:
    of = said(x, square=square)
    assert changes(of) == [[("factor", cell, (), factor)]]
    source = " of Table" if cell == "square" else ""
    assert words.claimed(first(of)) == f"the numbers of {cell}{source} are to be multiplied by {factor}"


@pytest.mark.parametrize(
    ("by", "factor"),
    [
        (math.log(10), "1/ln 10"),
        (1 / math.log(10), "ln 10"),
        (2 * math.pi, "1/(2π)"),
        (1 / (2 * math.pi), "2π"),
        (math.sqrt(2), "1/√2"),
    ],
)
def test_a_column_off_by_what_formulas_are_off_by(by: float, factor: str) -> None:
    of = said("1.2000 2.3000 3.1000", square=" ".join(f"{x * x * by:.4f}" for x in (1.2, 2.3, 3.1)))
    assert changes(of) == [[("factor", "square", (), factor)]]
    assert words.claimed(first(of)) == f"the numbers of square of Table are to be multiplied by {factor}"


def test_one_number_is_met_by_many_factors() -> None:
    assert "factor" not in [one[0][0] for one in changes(said("1.2000", square="3.3157"))]


SCATTER = Column("s", None, formula("s", sqrt(Sum((X[k] - Symbol("m")) ** 2, (k, 1, n)) / (n - 1))))
DRIFT = Column("drift", None, formula("drift", 2 * Symbol("s")))
M = Column("m", None, formula("m", Sum(X[k], (k, 1, n)) / n), positive=False)


@pytest.mark.parametrize(
    ("cell", "published", "factor"),
    [("s", "0.7789", "√(3/2)"), ("drift", "1.5578", "√(3/2)"), ("s", "0.954", ""), ("s", "1.168", "√(2/3)")],
)
def test_n_for_one_less(cell: str, published: str, factor: str) -> None:
    """Of 1.2, 2.3 and 3.1: 0.9539 about their mean, 0.7789 were they all there are."""
    given = {"x": [pure(text) for text in ("1.2000", "2.3000", "3.1000")]}
    of = found(Sheet((X, M, SCATTER, DRIFT)), given, [PublishedValue("Table", cell, (), pure(published))])
    own = [one for one in changes(of) if one[0][0] == "factor"]
    assert own == ([[("factor", cell, (), factor)]] if factor else [])


def printed_in(unit: str, text: str) -> Printed:
    size = parse_unit(unit)
    return Printed(text, unit, Fraction(text) * size.scale, size.scale)


@pytest.mark.parametrize(
    ("x_unit", "squares_unit", "squares", "claim"),
    [
        ("deg", "1", "1.440 5.290 9.610", "the numbers of x were taken in rad, not in deg"),
        ("rad", "1", "4.386e-4 1.6114e-3 2.9274e-3", "the numbers of x were taken in deg, not in rad"),
        ("1", "deg", "1.440 5.290 9.610", "the numbers of square of Table are in rad, not in deg"),
        ("1", "min", "1.440 5.290 9.610", "the numbers of square of Table are in s, not in min"),
    ],
)
def test_numbers_in_another_unit_of_the_kind(
    x_unit: str, squares_unit: str, squares: str, claim: str
) -> None:
    x = [printed_in(x_unit, text) for text in ("1.200", "2.300", "3.100")]
    cells = [
        PublishedValue("Table", "square", (row,), printed_in(squares_unit, text))
        for row, text in enumerate(squares.split(), 1)
    ]
    of = found(SHEET, {"x": x}, cells)
    assert [words.claimed(each.first) for each in of.explanations] == [claim]
    assert words.holds(claim, of.explanations)


def test_a_calculator_in_radians_spares_no_angle() -> None:
    """The sines of 15, 30 and 45 rad over those of 9.9, 19.5 and 28.1 rad."""
    y = Column("y", ROWS, Given(), positive=False)
    index = Column("index", ROWS, formula("index", sin(X[k]) / sin(y[k])), positive=False)
    given = {"x": ("15.0", "30.0", "45.0"), "y": ("9.9", "19.5", "28.1")}
    cells = [
        PublishedValue("Table", "index", (row,), pure(text))
        for row, text in enumerate(("-1.4213", "-1.6317", "4.9057"), 1)
    ]
    degrees = {name: [printed_in("deg", text) for text in texts] for name, texts in given.items()}
    of = found(Sheet((X, y, index)), degrees, cells)
    assert [words.claimed(each.first) for each in of.explanations] == [
        "all that is given in deg was taken in rad"
    ]
    assert words.suggested(of.explanations[0]) == "may be in rad, not in deg"


def test_several_columns_in_another_unit_are_said_together() -> None:
    """No two misprints explain six numbers."""
    of = said("1.200 2.300 3.100", square="1440 5290 9610", tenfold="28.80 105.80 192.20")
    assert changes(of) == [[("unit", "square", (), ""), ("factor", "tenfold", (), "1/2")]]
    assert of.explanations[0].count == 2


def test_two_rows_of_a_table_that_changed_places() -> None:
    of = said("1.200 2.300 3.100", square="5.290 1.440 9.610", tenfold="52.90 14.40 96.10")
    rows, given = of.explanations[1], of.explanations[0]
    assert [(each.kind, each.cell) for each in given.changes] == [("label", "x")]  # or those of x did
    assert rows.changes == (Change("label", "", (1,), "Table", "", "", other=(2,)),)
    assert words.claimed(rows.first) == "rows 1 and 2 of Table stand in each other's place"
    assert words.suggested(rows) == "rows 1 and 2 may have changed places"


@pytest.mark.parametrize(
    ("published", "perhaps"),
    [
        (
            {"square": "1.440 5.524 5.290 9.610"},
            "square[2] and square[3] of Table stand in each other's place (5.524 and 5.290)",
        ),
        (
            {"square": "1.440 5.524 5.290 9.610", "tenfold": "14.40 55.24 52.90 96.10"},
            "rows 2 and 3 of Table stand in each other's place",
        ),
    ],
)
def test_within_uncertainty_an_exchange_is_a_possibility(published: dict[str, str], perhaps: str) -> None:
    """The squares of 2.30 and 2.3503 are nearer to each other than u = 0.05 of a side says."""
    u = Error(Fraction("0.05"), said="u = 0.05")
    x = [replace(pure(text), stated=(u,)) for text in ("1.200", "2.3000", "2.3503", "3.100")]
    of = found(SHEET, {"x": x}, in_table(published))
    assert of.joint is not None
    assert (of.joint.verdict, of.explanations) == (WITHIN, ())
    assert perhaps in [words.claimed(each.first) for each in of.slips]


@pytest.mark.parametrize(
    ("text", "power", "would"),
    [
        ("29.7", -1, "2.97"), ("29.7", 1, "297"), ("29.7", 3, "297e2"), ("29.7", -3, "0.0297"),
        ("-0.50", 1, "-5.0"), ("1.25e-3", 2, "0.125"), ("0.00", 1, "0.0"), ("100", -2, "1.00"),
    ],
)  # fmt: skip
def test_a_point_that_stands_elsewhere(text: str, power: int, would: str) -> None:
    found = shifted(pure(text), power)
    assert (found.text, found.value) == (would, Fraction(would))


def test_of_one_cell_a_point_is_told_of_once_and_no_slip_stands_behind_it() -> None:
    """Anything up to 12 will do; 0.60 and 0.060 say no more than 6.0."""
    told = [each.first for each in said("60 1000.000 2000.000", mean="1.6667e6").explanations]
    points = [change.would_print for change in told if change.kind == "unit" and change.index]
    assert points == ["6.0"]
    assert told[0].kind == "misprint"
    assert is_slip(told[0].printed, told[0].would_print)


def test_transposed_digits_come_first_and_all_that_are_possible_are_listed() -> None:
    """What prints as 1.77 has a square from 3.115 to 3.151."""
    of = said("1.31 1.77 2.83", square="1.72 3.41 8.01")
    assert changes(of)[0] == [("misprint", "square", (2,), "3.14")]
    assert sorted(first(of).also) == ["3.12", "3.13", "3.15"]
    assert any(one[0][:3] == ("misprint", "x", (2,)) for one in changes(of)[1:])


@pytest.mark.parametrize(("listed", "span"), [(3, ()), (2, ("3.12", "3.15"))])
def test_where_not_all_are_listed_the_ends_are(
    listed: int, span: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Beside the likeliest three more are possible."""
    monkeypatch.setattr(misprints, "LISTED", listed)
    of = said("1.31 1.77 2.83", square="1.72 3.41 8.01")
    assert first(of).span == span
    assert len(first(of).also) == listed


def test_transposed_digits_of_an_input_come_first() -> None:
    of = said("1.31 7.17 2.83", square="1.72 3.1 8.01")
    assert changes(of)[0] == [("misprint", "x", (2,), "1.77")]
    assert sorted(first(of).also) == ["1.75", "1.76"]


def of_an_angle(x: str, published: str) -> Referee:
    """Of a sine in degrees, and of what it is the reciprocal of."""
    angle, names = Column("x", ROWS, Given(), "1", "deg", positive=False), ("sine", "cosecant")
    sine, other = (
        Column(name, ROWS, formula(name, sin(X[k]) ** power), positive=False)
        for name, power in zip(names, (1, -1), strict=True)
    )
    table = [
        PublishedValue("Table", name, (row,), pure(text))
        for name, line in zip(names, published.split(","), strict=False)
        for row, text in enumerate(line.split(), 1)
    ]
    given = [printed_in("deg", text) for text in x.split()]
    return found(Sheet((angle, sine, other)), {"x": given}, table)


@pytest.mark.parametrize(("more", "sine"), [("", ""), (" 90.0", " 1.0000"), (" 0.0", " 0.0000")])
def test_so_many_turns_explain_nothing(more: str, sine: str) -> None:
    """A million times an angle, in its printed digits, has any sine."""
    told = of_an_angle(f"23.0 41.0{more}", f"0.5299 0.6561{sine}")
    assert first(told).would_print == "32.0"
    assert {change.kind for each in told.explanations for change in each.changes} == {"misprint"}


def test_a_slip_is_found_at_another_root_than_the_nearest() -> None:
    """0.4620 is the sine of 27.52 and of 152.48 degrees: only the first is a digit from what is printed."""
    told = of_an_angle("22.52 41.00", "0.4621 0.6561,2.1642 1.5243")
    assert first(told).would_print == "27.52"


def test_all_slips_that_explain_it_are_told() -> None:
    """(x - 5)^2 is that of 2.8 and of 7.2; 2.7 is a digit from the one, and two from the other."""
    square = Column("square", ROWS, formula("square", (X[k] - 5) ** 2), positive=False)
    value = [
        PublishedValue("Table", "square", (row,), pure(text)) for row, text in ((1, "4.840"), (2, "1.00"))
    ]
    told = found(Sheet((X, square)), {"x": [pure("2.7"), pure("4.0")]}, value)
    change = next(each.first for each in told.explanations if each.first.kind == "misprint")
    assert (change.would_print, change.also) == ("2.8", ("7.2",))


@pytest.mark.parametrize("text", ["2.07", "2.15", "2.25"])
def test_each_way_to_print_it_is_told_once_and_slips_first(text: str) -> None:
    """5 is the square of what is 2.236 off 5: 2.76 or 7.24."""
    square = Column("square", ROWS, formula("square", (X[k] - 5) ** 2), positive=False)
    value = [PublishedValue("Table", "square", (row,), pure(text)) for row, text in ((1, "5"), (2, "1.00"))]
    told = found(Sheet((X, square)), {"x": [pure(text), pure("4.0")]}, value)
    change = next(each.first for each in told.explanations if each.first.cell == "x")
    ways = [change.would_print, *change.also]
    assert len(set(ways)) == len(ways) <= misprints.LISTED + 1
    slips = [is_slip(text, way) for way in ways]
    assert slips[0]
    assert slips == sorted(slips, reverse=True)


@pytest.mark.parametrize(
    ("x", "tenfold"), [("0.0 1.2 2.3", "0 120 230"), ("-2.0 -1.0 0.0 3.0", "-200 -100 0 300")]
)
def test_another_unit_is_told_of_a_column_with_a_zero(x: str, tenfold: str) -> None:
    y = Column("y", ROWS, formula("y", 10 * X[k]), positive=False)
    value = [PublishedValue("Table", "y", (row,), pure(text)) for row, text in enumerate(tenfold.split(), 1)]
    told = found(Sheet((X, y)), {"x": [pure(text) for text in x.split()]}, value)
    assert ("unit", "x") in [
        (change.kind, change.cell) for each in told.explanations for change in each.changes
    ]


def test_two_misprints_are_the_smallest_set_without_which_the_rest_comes_out() -> None:
    of = said("1.310 1.770 2.830 3.370", square="1.716 3.331 8.009 11.537")
    assert {one[1] for each in changes(of) for one in each} == {"square", "x"}
    assert [one[:3] for one in changes(of)[0]] == [("misprint", "square", (2,)), ("misprint", "square", (4,))]
    assert all(len(each.changes) == 2 == each.count for each in of.explanations)
    # 1.7695^2 = 3.1311 to 1.7705^2 = 3.1347, and 3.3695^2 = 11.3535 to 3.3705^2 = 11.3603: no other digits.
    ways = [sorted((each.would_print, *each.also)) for each in of.explanations[0].changes]
    assert ways == [
        [f"3.{n}" for n in range(131, 136)],
        [f"11.{n}" for n in range(354, 361)],
    ]
    assert [each.span for each in of.explanations[0].changes] == [(), ()]
    assert "or 3.131" in words.explained(of.explanations[0])
    assert words.EACH_ALONE in words.explained(of.explanations[0])


def test_a_misprinted_input_and_another_in_a_table_of_the_same_columns_are_found() -> None:
    """Whatever was misprinted in the table must not exclude what the input may be."""
    of = said("1.310 7.170 2.830", square="1.916 3.133 8.009", tenfold="17.16 31.33 80.09")
    expected = [("misprint", "x", (2,), "1.770"), ("misprint", "square", (1,), "1.716")]
    assert expected in changes(of)


def test_nothing_explains_it_and_how_much_was_tried_is_said() -> None:
    of = said("1.310 1.770 2.830 3.370", square="1.916 3.531 8.909 11.937")
    assert of.explanations == ()
    assert of.tried is not None
    told = list(words.lines(of, str))
    assert f"  {words.NOTHING_EXPLAINS}" in told
    assert f"  {words.tried(of.tried)}" in told
    assert of.tried.explaining == 0 < of.tried.excluded


def test_nothing_is_excluded_without_a_certificate(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where nothing is certain, everything stays open, and the same is found."""
    asked = "1.31 1.77 2.83", "1.72 3.41 8.01"
    certain = said(asked[0], square=asked[1])
    monkeypatch.setattr(certificate.Certificate, "at_least", lambda *_: 0.0)
    monkeypatch.setattr(search, "excluded", lambda _, boxes: certificate.np.zeros(len(boxes), dtype=bool))
    uncertain = said(asked[0], square=asked[1])
    assert certain.tried is not None
    assert uncertain.tried is not None
    assert certain.tried.excluded > 0 == uncertain.tried.excluded
    assert changes(certain) == changes(uncertain)


def test_what_is_pinned_does_not_hide_the_next_error() -> None:
    """A known misprint of a published value, and then x in another unit: neither alone explains all."""
    texts = {"square": "1.520 5.350", "tenfold": "15.20 53.05"}  # the squares are 1.523 and 5.350
    pin = Pin("53.05", "53.50")
    cells = [
        PublishedValue("Table", name, (row,), pure(text), *(("differs", pin) if text == pin.printed else ()))
        for name, line in texts.items()
        for row, text in enumerate(line.split(), 1)
    ]
    x = [pure("1.233e3"), pure("2.313e3")]
    of = found(SHEET, {"x": x}, cells)
    assert [each[:3] for each in changes(of)[0]] == [("unit", "x", ())]
    assert (of.explanations[0].values, of.explanations[0].of) == (3, 4)
    assert of.pinned == ()
    known = [replace(cell, explained="misprint tenfold[2]") if cell.pin else cell for cell in cells]
    of = found(SHEET, {"x": x}, known)
    assert not words.holds("misprint tenfold[2]", of.explanations)
    assert words.holds("misprint tenfold[2]", of.possible_reasons)
    wrong = found(SHEET, {"x": x}, [replace(cell, explained="misprint x[2]") for cell in known])
    assert not words.holds("misprint x[2]", wrong.possible_reasons)
    unpinned = [replace(cell, expect="", pin=None) for cell in cells]
    assert not any(each[0][:3] == ("unit", "x", ()) for each in changes(found(SHEET, {"x": x}, unpinned)))


@pytest.mark.parametrize(("tenfold", "come"), [("15.20", True), ("15.30", False)])
def test_beside_a_known_misprint_all_others_have_to_come_out(tenfold: str, come: bool) -> None:
    """Each of them is near enough by itself to ten times a square; together they are not."""
    texts = {"square": ("1.520", "5.350"), "tenfold": (tenfold, "59.50")}
    pin = Pin("59.50", "53.50")
    cells = [
        PublishedValue("Table", name, (row,), pure(text), *(("differs", pin) if text == pin.printed else ()))
        for name, line in texts.items()
        for row, text in enumerate(line, 1)
    ]
    of = found(SHEET, {"x": [pure("1.2"), pure("2.3")]}, cells)
    assert of.others is not None
    assert (of.others.values, of.others_come) == (3, come)


@pytest.mark.parametrize(
    ("said", "holds"),
    [
        ("", True),
        ("misprint tenfold[2] (Table)", True),
        ("misprint tenfold[2]", True),
        ("perhaps tenfold[2] of Table is printed 53.05 for 53.50", True),
        ("tenfold[2] of Table is printed 53.05 for 53.50", True),
        ("misprint tenfold[1]", False),
        ("tenfold[2] of Table is printed 53.05 for 53.51", False),
    ],
)
def test_an_explanation_is_known_by_its_name_and_by_what_is_said_of_it(said: str, holds: bool) -> None:
    change = Change("misprint", "tenfold", (2,), "Table", "53.05", "53.50")
    every = (Explanation((change,), 0.5, 3, 4),)
    assert words.holds(said, every) is holds
    assert words.names(every).endswith(": misprint tenfold[2] (Table)")


def test_what_a_rounded_column_leads_to_need_not_be_computed_from_all_that_is_printed() -> None:
    """The squares were rounded; tenfold squares were not before they were multiplied once more."""
    of = said("1.1100 1.3700", square="1.23 1.88", tenfold="12 19", hundredfold="123.0 188.0")
    assert of.as_printed
    (only,) = of.explanations
    assert (only.first.kind, only.first.source, only.first.would_print) == ("printed", "Table", "square")
    # One digit of them that is wrong is not excused by that.
    of = said("1.1100 1.3700", square="1.23 1.88", tenfold="12 19", hundredfold="123.0 183.0")
    assert not of.as_printed


DROPS = """from sympy import sqrt
from loopsheet import Method, count, let, mean, measured


class Drops(Method, rows="drops", headline="m s"):
    eta = measured("Pa*s", "viscosity", positive=True)
    m = let(mean(eta), "its mean", "Pa*s")
    s = let(sqrt(sum((eta - m) ** 2) / (count() - 1)), "its scatter", "Pa*s")
"""
VISCOSITIES = ("1.0312", "1.0291", "1.0353", "1.0304", "1.0281", "1.0507")


def test_a_test_that_all_averages_leave_out_is_one_change(tmp_path: Path) -> None:
    """Not a misprint of each of them; the search over one average alone finds nothing."""
    without = [float(each) for each in VISCOSITIES[:-1]]
    rows = (f"text,m,,{mean(without):.5f},Pa*s", f"text,s,,{stdev(without):.5f},Pa*s")
    published = "\n".join(["source,cell,index,value,unit", *rows, ""])
    method_folder(tmp_path, DROPS, "\n".join(["eta [Pa*s]", *VISCOSITIES, ""]), published=published)
    of = Study(tmp_path).refereed.referee
    would = "without drop 6"
    assert changes(of)[0] == [("rows", "m", (), would), ("rows", "s", (), would)]
    assert of.explanations[0].count == 1
