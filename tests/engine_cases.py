"""What every engine is asked, and what is known of the answers: one sheet, whose columns are the cases.

A case is a column with what its rows are: numbers in closed form, or codes. An engine that is listed in
`ENGINES` is asked all of them by tests/test_engines.py. The data are such that a person can work them out.
"""

from __future__ import annotations

import importlib
import io
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import xlsxwriter
from helpers import whole
from sympy import (
    Abs,
    And,
    Expr,
    IndexedBase,
    Integer,
    Max,
    Min,
    Ne,
    Or,
    Piecewise,
    Rational,
    Sum,
    Symbol,
    acos,
    exp,
    log,
    pi,
    sqrt,
)

from loopsheet.derivations.equation import Equation, Kind
from loopsheet.derivations.reductions import Greatest, Least, Median
from loopsheet.report.cells.grid import Grid
from loopsheet.report.cells.values import Status, Values
from loopsheet.report.engines import ENGINES, excel_grid
from loopsheet.report.engines import numpy as engine
from loopsheet.report.judge.readers import Book, Case, Reading
from loopsheet.report.quantity import Bounds
from loopsheet.report.sheet import (
    Axis,
    Column,
    CountedAxis,
    Formula,
    Given,
    Iterated,
    PairAxis,
    RepeatAxis,
    Root,
    Sheet,
)
from loopsheet.report.views.xlsx_columns import ColumnwiseSheet

OK, INPUT, DOMAIN, OVERFLOW = Status.OK, Status.INPUT, Status.DOMAIN, Status.OVERFLOW
NOROOT, TWOROOTS = Status.NOROOT, Status.TWOROOTS
NAN = float("nan")

COLUMNS: list[Column] = []
LABELS: dict[str, Sequence[int]] = {}
DATA: dict[str, Any] = {}
KNOWN: dict[str, Sequence[Any]] = {}
"""Of a column, a number in closed form or a code for each row; ok says that there is a number."""


def given(name: str, axis: Axis | None, data: Any, bounds: Bounds | None = None, **more: Any) -> Column:
    rule = Given() if bounds is None else Given("given", bounds)
    COLUMNS.append(Column(name, axis, rule, **more))
    DATA[name] = data
    return COLUMNS[-1]


def case(name: str, value: Any, axis: Axis | None, known: Sequence[Any], **more: Any) -> Column:
    """A formula, and what its rows are."""
    equation = Equation("(1)", (Symbol("made"), value), "for a test", Kind.DEFINITION)
    COLUMNS.append(Column(name, axis, Formula(equation), **{"positive": False, **more}))
    KNOWN[name] = known
    return COLUMNS[-1]


def root(
    name: str, form: Expr, low: Any, high: Any, known: Sequence[Any], axis: Axis | None = None, **more: Any
) -> Column:
    """The root of a form in x, and what its rows are."""
    equation, column = Equation("(2)", (form, 0 * x), "for a test", Kind.DEFINITION), dict[str, Any]()
    column["requires"] = more.pop("requires", ())
    rule = {"value": x, "start": Rational(high) / 2, "steps": 8, **more}
    made = Root(equation, equation, x, rule.pop("value"), Rational(low), Rational(high), **rule)
    COLUMNS.append(Column(name, axis, made, positive=False, **column))
    KNOWN[name] = known
    return COLUMNS[-1]


x = Symbol("x", positive=True)
half = Rational(1, 2)
k, i, j, p, q, s = (whole(name) for name in "kijpqs")

# --- which row is meant: three rows, their three pairs, two points of each --------------------------------

n, n_pairs, n_points = whole("n"), whole("n_pairs"), whole("n_points")
ROWS = Axis("rows", k, n)
PAIRS = PairAxis("pairs", p, n_pairs, of=ROWS, first=i, second=j)
POINTS = RepeatAxis("points", q, n_points, of=PAIRS, step=s, count="count")
LABELS["rows"] = (1, 2, 3)
a = given("a", ROWS, [2.0, 3.0, 7.0])
w, count = given("w", None, 0.5), given("count", None, 2, Bounds(high=9))
gap = case("gap", a[j] - a[i], PAIRS, [1, 5, 4])
case("a_point_on_its_way", s + 0 * gap[p], POINTS, [1, 2] * 3)
# On the points a pair's cell is its own pair's; in a sum over the pairs it is each in turn.
summed = Sum(gap[p], (p, 1, n_pairs))
case("own_and_summed", gap[p] / summed, POINTS, [Rational(g, 10) for g in (1, 1, 5, 5, 4, 4)])
case("own_in_a_sum", a[k] - Sum(a[k], (k, 1, n)) / n, ROWS, [-2, -1, 3])
case("a_constant_in_a_sum", Sum(w.symbol, (k, 1, n)), None, [Rational(3, 2)])
case("a_number_in_a_sum", Sum(2, (k, 1, n)), None, [6])
case("a_number_alone", Rational(2), None, [2])
case("a_number_in_every_row", Rational(0), ROWS, [0, 0, 0])
case("a_sum_in_a_sum", Sum(a[k] * Sum(gap[p] ** 2, (p, 1, n_pairs)), (k, 1, n)), None, [12 * 42])
case("pairs_of_a_sum_in_a_sum", Sum(a[k] * Sum(a[i] * a[j], (p, 1, n_pairs)), (k, 1, n)), None, [12 * 41])
case("members_in_a_sum", Sum(a[i] * a[j], (p, 1, n_pairs)), None, [41])
case("a_running_number", s * w.symbol + gap[p], POINTS, [Rational(g, 2) for g in (3, 4, 11, 12, 9, 10)])
case("a_running_number_in_a_sum", Sum(s * gap[p], (q, 1, n_points)), None, [30])
case("two_sums", Sum(2 * a[k], (k, 1, n)) - Sum(a[k], (k, 1, n)), None, [12])
case("powers_in_a_sum", Sum(Symbol("count", positive=True) ** (2 * a[k]), (k, 1, n)), None, [16 + 64 + 16384])
# No slope at its place, and rounding leaves it there by the square of what it does to the mean.
alike = given("alike", ROWS, [0.1, 0.1, 0.1])
mean_alike = case("mean_alike", Sum(alike[k], (k, 1, n)) / n, None, [Rational(0.1)])
case("squares_of_nothing", Sum((alike[k] - mean_alike.symbol) ** 2, (k, 1, n)), None, [0])
case("a_median", Median(gap[p], (p, 1, n_pairs)) * w.symbol, None, [2])
case("a_median_of_a_sets_parts", Median(gap[p], (q, 1, n_points)), None, [4])
case("a_median_of_members", a[k] - Median(a[j], (p, 1, n_pairs)), ROWS, [-5, -4, 0])
most, least = Greatest(gap[p], (q, 1, n_points)), Least(gap[p], (q, 1, n_points))
case("extremes", Greatest(gap[p], (p, 1, n_pairs)) * w.symbol - Least(a[k], (k, 1, n)), None, [half])
case("extremes_of_a_sets_parts", most + least, None, [6])
apart = Greatest(a[i], (p, 1, n_pairs)) - Least(a[j], (p, 1, n_pairs))
case("extremes_of_members", a[k] / (apart + 1), ROWS, [2, 3, 7])
below = case("below", 1 - gap[p], PAIRS, [0, -4, -3])
case("extremes_below_zero", Greatest(below[p], (p, 1, n_pairs)) - Least(below[p], (p, 1, n_pairs)), None, [4])
case("divided_by_an_extreme", a[k] / Greatest(below[p], (p, 1, n_pairs)), ROWS, [DOMAIN] * 3)
case("a_size_without_a_sum", gap[p] / n_pairs, PAIRS, [Rational(g, 3) for g in (1, 5, 4)])
case("a_scalar_on_an_axis", w.symbol + 0 * w.symbol, PAIRS, [Rational(1, 2)] * 3)
case("a_number_on_an_axis", Integer(4), PAIRS, [4] * 3)
case("a_choice", Piecewise((a[k], a[k] > 2), (w.symbol, True)), ROWS, [Rational(1, 2), 3, 7])
nested = Piecewise((1, And(a[k] > 2, a[k] < 5)), (2, Or(a[k] > 6, Ne(w.symbol, w.symbol))), (3, True))
case("a_choice_of_three", nested, ROWS, [3, 1, 2])
case(
    "functions", exp(sqrt(w.symbol)) * log(w.symbol) + pi, None, [exp(sqrt(2) / 2) * log(Rational(1, 2)) + pi]
)
case(
    "larger_and_smaller",
    Max(a[k], 3) * Min(a[k], 3, w.symbol + 2),
    ROWS,
    [6, Rational(15, 2), Rational(35, 2)],
)
divided = case("divided_by_zero", 1 / (a[k] - 3), ROWS, [-1, DOMAIN, Rational(1, 4)])
case("lost_in_a_quotient", 1 / (1 / (a[k] - 3) + 1), ROWS, [DOMAIN, DOMAIN, Rational(4, 5)])
case("lost_in_an_exponential", exp(-1 / (a[k] - 3) ** 2), ROWS, [exp(-1), DOMAIN, exp(Rational(-1, 16))])
case("lost_in_the_larger", Max(a[k], -1 / (a[k] - 3) ** 2), ROWS, [2, DOMAIN, 7])
case("lost_behind_a_sum", n / Sum(1 / (a[k] - 3) ** 2, (k, 1, n)), None, [DOMAIN])
case("lost_in_a_sum", Sum(exp(-1 / (a[k] - 3) ** 2), (k, 1, n)), None, [DOMAIN])
case("lost_behind_a_logarithm", w.symbol / log(a[k] - 2), ROWS, [DOMAIN, DOMAIN, half / log(5)])
case("the_size_of_no_number", Abs(log(a[k] - 4)), ROWS, [DOMAIN, DOMAIN, log(3)])
case("larger_than_no_number", Max(log(a[k] - 4), 0), ROWS, [DOMAIN, DOMAIN, log(3)])
case("not_lost", 1 / sqrt(a[k] - 3), ROWS, [DOMAIN, DOMAIN, Rational(1, 2)])
case("a_mean_alongside", Sum(a[k], (k, 1, n)) / n, None, [Rational(9, 2)], alongside=(divided,))
case("a_median_alongside", Median(a[k], (k, 1, n)), None, [Rational(9, 2)], alongside=(divided,))
lowered = case("lowered", divided[k] - 1, ROWS, [-2, DOMAIN, Rational(-3, 4)])
case("a_greatest_of_some", Greatest(lowered[k], (k, 1, n)), None, [Rational(-3, 4)])
without = case("without_the_least", 1 / (a[k] - 2), ROWS, [DOMAIN, 1, Rational(1, 5)])
case("a_least_alongside", Least(a[k], (k, 1, n)), None, [3], alongside=(without,))
needs = ((a[j] < a[i] + 5, "not far"), (a[i] > 2, "not small"))
case("conditions", 2 * gap[p], PAIRS, [DOMAIN, DOMAIN, 8], requires=needs)
large = ((log(a[k] - 2) > -1, "large"),)
case("a_condition_on_minus_infinity", 2 * a[k], ROWS, [DOMAIN, 6, 14], requires=large)

# --- rows that are counted, whatever the data -------------------------------------------------------------

c, m = whole("c"), whole("m")
WAY = CountedAxis("way", m, whole("n_way"), c, 3)
first, last = Least(a[k], (k, 1, n)), Greatest(a[k], (k, 1, n))
way = case("points_between_extremes", first + (last - first) * (c - 1) / 2, WAY, [2, Rational(9, 2), 7])
case("a_curve", w.symbol * way[m] ** 2, WAY, [2, Rational(81, 8), Rational(49, 2)])

# --- roots ------------------------------------------------------------------------------------------------

root("square_root", x**2 - 2, 0, 2, [sqrt(2)])
root("far_from_its_guess", x**9 - 512, 0, 20, [2], steps=20)
root("behind_an_exponential", exp(-x) - exp(-40), 0, 100, [40], steps=20)
root("straight", (x - Rational(1, 7)) * (1 - Rational(1, 10**9)), 0, 1, [Rational(1, 7)])
root("at_the_guess", x - 1, 0, 2, [1])
root("no_sign_at_an_end", (x - 1) * (x - Rational(1, 3)), 0, 1, [Rational(1, 3)], sign_high=-Integer(1))
root("two", x**2 - 3 * x + 2, 0, 9, [TWOROOTS], turning=(Rational(3, 2),))
root("none", x + 1, 0, 1, [NOROOT])
root("of_a_sum", Sum(x * a[k], (k, 1, n)) - 6, 0, 2, [Rational(3, 2)], value=1 + x)

# --- loops: columns that rest on one another --------------------------------------------------------------


def iterated(name: str, step: Any, start: Any, known: Sequence[Any], axis: Axis | None = None) -> Column:
    """A value that is put into its own formula again, and what its rows come to."""
    equation = Equation("(3)", (Symbol("made"), step), "for a test", Kind.DEFINITION)
    COLUMNS.append(Column(name, axis, Iterated(equation, step, start)))
    KNOWN[name] = known
    return COLUMNS[-1]


def cell(name: str) -> Symbol:
    return Symbol(name, positive=True)


iterated("babylonian", (cell("babylonian") + 2 / cell("babylonian")) / 2, Integer(1), [sqrt(2)])
row = IndexedBase(cell("of_rows"))[k]
iterated("of_rows", (row + a[k] / row) / 2, a[k], [sqrt(2), sqrt(3), sqrt(7)], ROWS)
# Both at once, each from the other's last value.
iterated("one", (1 + cell("other")) / 100, w.symbol, [Rational(102, 9999)])
iterated("other", (2 + cell("one")) / 100, w.symbol, [Rational(201, 9999)])
case("after_both", cell("other") / cell("one"), None, [Rational(201, 102)])
iterated("growing", exp(cell("growing")), Integer(1), [NOROOT])
iterated("out_of_its_domain", cell("out_of_its_domain") - 1, Rational(7, 2), [NOROOT])
iterated("to_and_fro", 1 - cell("to_and_fro"), Rational(1, 4), [NOROOT])
iterated("without_a_start", cell("without_a_start") / 2, log(w.symbol), [DOMAIN])
case("after_growing", cell("growing") + 1, None, [NOROOT])


def weighted(tag: str, numbers: Sequence[float], **known: Sequence[Any]) -> None:
    """A mean that trusts a row the less the farther it lies off: weights and mean rest on one another."""
    size, k = whole(f"n_{tag}"), whole(f"k_{tag}")
    rows = Axis(f"rows_{tag}", k, size)
    LABELS[rows.name] = range(1, 1 + len(numbers))
    A = given(f"a_{tag}", rows, numbers)
    centre = cell(f"centre_{tag}")
    weight = case(
        f"weight_{tag}", 1 / (100 + (A[k] - centre) ** 2), rows, known.get("weight", []), positive=True
    )
    every = (k, 1, size)
    trusted = Sum(weight[k] * A[k], every) / Sum(weight[k], every)
    iterated(centre.name, trusted, Sum(A[k], every) / size, known.get("centre", []))


weighted("weighted", [1, 2, 6, 3.5])
weighted("weighted_alike", [4, 4], centre=[4], weight=[Rational(1, 100)] * 2)
weighted("weighted_missing", [1, NAN, 3], centre=[2], weight=[Rational(1, 101), INPUT, Rational(1, 101)])
weighted("weighted_of_nothing", [NAN], centre=[INPUT], weight=[INPUT])

# --- what no double holds ---------------------------------------------------------------------------------

n_items = whole("n_items")
r = whole("r")
ITEMS = Axis("items", r, n_items)
EXTREME: list[tuple[float, float, dict[str, Status]]] = [  # A, B, and the codes of some cells
    (2.0, 3.0, {"product": OK, "quotient": OK, "power": OK, "logarithm": OK, "difference": DOMAIN}),
    (2.0, 1.0, {"quotient": DOMAIN, "quotient_of_any_sign": DOMAIN, "power": DOMAIN, "all_or_none": DOMAIN}),
    (1e5, 3.0, {"product": OVERFLOW, "product_of_any_sign": OVERFLOW, "on_the_way": OVERFLOW}),
    (1e-5, 3.0, {"product": OVERFLOW, "product_of_any_sign": OK, "on_the_way": OVERFLOW, "solved": OVERFLOW}),
    (1e5, -3.0, {"product_of_any_sign": OVERFLOW, "on_the_way": OVERFLOW, "logarithm": DOMAIN, "cases": OK}),
    (2000.0, 3.0, {"power": OVERFLOW, "unknown": DOMAIN}),
    (2.5, -3.0, {"power": DOMAIN}),
    (1.0, 2.0, {"cases": DOMAIN, "difference": DOMAIN}),
    (1.0, 1.0, {"difference": DOMAIN, "unknown": OK}),
    (3e-308, 2.9e-308, {"difference": OVERFLOW}),
    (1e300, -1.7e308, {"difference": OK, "on_the_way": OVERFLOW}),
    (1e308, -1.7e308, {"difference": OVERFLOW, "on_the_way": OVERFLOW}),
    (1e-5, 4.0, {"factors": OVERFLOW, "power": OK}),
    (1e-5, 1.0, {"factors": DOMAIN}),
    (1e-5, -1.5, {"factors": OVERFLOW}),
    (1e-5, -3.0, {"factors": DOMAIN}),
]  # fmt: skip
LABELS["items"] = range(1, len(EXTREME) + 1)
large = given("A", ITEMS, [row[0] for row in EXTREME], Bounds(low=0, low_open=True))
signed = given("B", ITEMS, [row[1] for row in EXTREME], positive=False)
A, B = large[r], signed[r]


def extreme(name: str, value: Any, positive: bool = True) -> None:
    """A case of which the codes of some rows are thought out."""
    case(name, value, ITEMS, [row[2].get(name) for row in EXTREME], positive=positive)


extreme("product", A**80)
extreme("quotient", A / (B - 1))
extreme("quotient_of_any_sign", A / (B - 1), positive=False)
extreme("product_of_any_sign", B * A**80, positive=False)
extreme("factors", (B - 1) ** 2 * (B + 2) * A**80)
extreme("power", (B - 1) ** A)
extreme("logarithm", log(B), positive=False)
extreme("difference", A - B)
extreme("on_the_way", A**80 / (1 + A**79))
extreme("cases", Piecewise((exp(-A), B < 1), (log(B - 2), True)), positive=False)
extreme("unknown", acos(A), positive=False)
extreme("all_or_none", A + Sum(1 / (B - 1), (r, 1, n_items)), positive=False)
solved = [row[2].get("solved") for row in EXTREME]
root("solved", x * A - 1, 0, 10**9, solved, ITEMS, value=x**80, start=Rational(1, 2))

# --- errors and what they reach ---------------------------------------------------------------------------


def errors(
    tag: str,
    a: list[float],
    b: list[float],
    c: float = 2.0,
    labels: Sequence[int] = (),
    **known: Sequence[Any],
) -> None:
    """Rows of which some are in error, and what is made of them: `known` by the name of the column."""
    size, pairs, k, p, i, j = (whole(f"{name}_{tag}") for name in ("n", "n_pairs", "k", "p", "i", "j"))
    rows = Axis(f"rows_{tag}", k, size)
    both = PairAxis(f"pairs_{tag}", p, pairs, of=rows, first=i, second=j)
    LABELS[rows.name] = labels or range(1, 1 + len(a))
    A, B, C = given(f"a_{tag}", rows, a), given(f"b_{tag}", rows, b), given(f"c_{tag}", None, c)

    def add(name: str, value: Any, axis: Axis | None = None, **more: Any) -> Column:
        return case(f"{name}_{tag}", value, axis, known.get(name, []), **more)

    limits = ((A[j] > A[i], "a must rise"), (B[i] < 100, "b is at most 100"))
    slope = add("slope", log(B[j] / B[i]) / (A[j] - A[i]), both, requires=limits)
    mean = add("mean", Sum(slope[p], (p, 1, pairs)) / pairs)
    add("middle", Median(slope[p], (p, 1, pairs)))
    add("most", Greatest(slope[p], (p, 1, pairs)))
    add("least", Least(slope[p], (p, 1, pairs)))
    add("scaled", mean.symbol * C.symbol)
    add("offset", A[k] - mean.symbol, rows)
    add("excess", A[k] - Sum(A[k], (k, 1, size)) / size, rows)
    add("gap", B[k] - 1, rows, positive=True)
    add("lift", B[k] - Sum(A[k], (k, 1, size)) / size, rows)
    if "x0" in known:
        # One root, two or none: x^2 - a x + b = 0 between 0 and 10, which turns at a/2.
        found = root(
            f"x0_{tag}", x**2 - (A[i] + A[j]) * x + B[i] * B[j], 0, 10, known["x0"], both,
            turning=((A[i] + A[j]) / 2,), start=Rational(1), requires=((B[i] < 1000, "b is below 1000"),),
        )  # fmt: skip
        add("root_sum", Sum(found[p], (p, 1, pairs)))


errors(
    "sound",
    [6, 7, 8],
    [2, 3, 5],
    mean=[(log(3 / Integer(2)) + log(Rational(5, 3)) + log(Rational(5, 2)) / 2) / 3],
)
errors(
    "missing", [1, 2, 3], [2, NAN, 5], labels=(10, 30, 20),
    slope=[INPUT, log(5 * half) / 2, INPUT], mean=[log(5 * half) / 2], middle=[log(5 * half) / 2],
    most=[log(5 * half) / 2], scaled=[log(5 * half)], gap=[1, INPUT, 4],
)  # fmt: skip
errors(
    "many_missing", [1, 2, 3], [NAN, NAN, 5],
    slope=[INPUT] * 3, mean=[INPUT], middle=[INPUT], most=[INPUT], least=[INPUT], scaled=[INPUT],
    offset=[INPUT] * 3, excess=[-1, 0, 1],
)  # fmt: skip
errors(
    "of_several_kinds", [3, 2, NAN], [2, 3, 5], NAN,
    slope=[DOMAIN, INPUT, INPUT], mean=[DOMAIN], offset=[DOMAIN, DOMAIN, INPUT], scaled=[INPUT],
)  # fmt: skip
errors(
    "left_out", [1, NAN, 4], [2, 3, 5],
    excess=[-3 * half, INPUT, 3 * half], lift=[-half, half, 5 * half],
)  # fmt: skip
errors("without_a_culprit", [1, NAN, 4], [2, 3, NAN], lift=[-half, half, INPUT])
errors("without_a_scalar", [1, 2], [2, 3], NAN, scaled=[INPUT], mean=[log(3 * half)])
errors("of_conditions", [1, 1, 3], [200, 3, 5], slope=[DOMAIN, DOMAIN, log(Rational(5, 3)) / 2])
errors(
    "not_positive", [1, 2, 3], [-2, 1, 5], slope=[DOMAIN, DOMAIN, log(Integer(5))], gap=[DOMAIN, DOMAIN, 4]
)
errors(
    "of_roots", [0, 0, 10, 4], [1, 21, 1, 1], root_sum=[7 - sqrt(48)],
    x0=[NOROOT, TWOROOTS, TWOROOTS, TWOROOTS, NOROOT, 7 - sqrt(48)],
)  # fmt: skip
errors("not_sought", [4, 4.5, 5], [1000, 1, 2], x0=[DOMAIN, DOMAIN, TWOROOTS])

GAPS = {
    ("exact", "on_the_way"): "numbers of 50 digits may be of any size",
    ("xlsx", "factors"): "a spreadsheet does not tell the sign of what is too large",
    ("xlsx", "product_of_any_sign"): "a power that is too small for a double is an error of a spreadsheet",
    ("xlsx", "solved"): "the same, and its steps come to an end",
    ("xlsx", "to_and_fro"): "its passes come to an end, and it does not know that others' go on",
}
"""What an engine is known not to do, and why; a gap that is closed is noticed."""

PROGRAMS = {"JavaScript": ("node",), "xlsx": ("soffice", "libreoffice")}
"""What an engine needs to be installed: one of these."""


def found_by(name: str, case: Case, require: Callable[..., str]) -> Reading:
    """What an engine of the registry finds."""
    if name in PROGRAMS:
        require(*PROGRAMS[name])
    module, _, function = ENGINES[name].partition(":")
    found: Reading = getattr(importlib.import_module(module), function)(case)
    assert not found.failure, found.failure
    return found


# --- all of it --------------------------------------------------------------------------------------------

SHEET = Sheet(tuple(COLUMNS))


def book_of(grid: Grid) -> bytes:
    """A workbook with the formulas of a grid and what is given, and no results."""
    buffer = io.BytesIO()
    with xlsxwriter.Workbook(buffer, {"in_memory": True}) as book:
        sheets: dict[str, Any] = {}
        for block in grid.blocks:
            place = block.place
            if place.worksheet not in sheets:
                sheets[place.worksheet] = book.add_worksheet(place.worksheet, ColumnwiseSheet)
            for row in range(place.rows):
                at = (place.row + row, place.column)
                if block.formulas and block.array:
                    sheets[place.worksheet].write_array_formula(*at * 2, block.formulas[row], None, "")
                elif block.formulas:
                    sheets[place.worksheet].write_formula(*at, block.formulas[row], None, "")
                elif block.values[row] is not None:
                    sheets[place.worksheet].write(*at, block.values[row])
    return buffer.getvalue()


def group(tag: str) -> Sheet:
    """The columns of some rows in error."""
    return Sheet(tuple(column for column in COLUMNS if column.name.endswith(f"_{tag}")))


def values() -> Values:
    """What NumPy finds."""
    return engine.evaluate(SHEET, LABELS, DATA)


class Printed(Book):
    """The workbook of the cases, made when an engine asks for it."""

    def __init__(self, values: Values) -> None:
        self.values = values

    @cached_property
    def grid(self) -> Grid:  # type: ignore[override]
        return excel_grid.grid(SHEET, self.values, {})

    @cached_property
    def content(self) -> bytes:  # type: ignore[override]
        return book_of(self.grid)


def asked() -> Case:
    """What an engine is given."""
    found = values()
    return Case(SHEET, LABELS, DATA, found, Printed(found))
