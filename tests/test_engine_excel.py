"""The Excel engine: what each construct is printed as, and where and how a sheet's formulas stand."""

import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sympy import (
    Abs,
    And,
    Eq,
    Float,
    Function,
    Integer,
    Max,
    Min,
    Mul,
    Ne,
    Not,
    Or,
    Piecewise,
    Rational,
    S,
    Sum,
    Symbol,
    cos,
    exp,
    gamma,
    log,
    pi,
    sign,
    sqrt,
    tanh,
    true,
)
from sympy.core.parameters import evaluate

from loopsheet.derivations.equation import Equation, Kind
from loopsheet.report.cells.grid import FilledDown, Grid, Place, checked, factors, letters, quoted
from loopsheet.report.engines import excel_assembly, excel_grid
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.excel import ExcelPrinter, IfError, IsNumber, NotPrintable
from loopsheet.report.engines.excel_assembly import auxiliary_texts
from loopsheet.report.engines.excel_formulas import _stretches, guard
from loopsheet.report.engines.excel_roots import Unrolled, unroll
from loopsheet.report.engines.excel_values import auxiliary_values
from loopsheet.report.machine.kept import SETTING
from loopsheet.report.plan.lowering import lowered_column
from loopsheet.report.plan.nodes import RootNode, RowSum
from loopsheet.report.quantity import Bounds
from loopsheet.report.sheet import Axis, Column, Formula, Given, PairAxis, RepeatAxis, Root, Sheet

x, y, z = (Symbol(name, real=True) for name in "xyz")
P = Symbol("P", positive=True)


def printed(expression: Any, rows: bool = False) -> str:
    return ExcelPrinter(str, rows=rows).doprint(expression)


# --- the printer -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("expression", "formula"),
    [
        (Integer(3), "3"),
        (Integer(-3), "(0-3)"),
        (Rational(1, 1000000), "(1/1000000)"),
        (Rational(-2, 3), "(0-2/3)"),
        (Integer(10) ** 18, "(1*(10)^(18))"),
        (Integer(12345678901234567890), "(123456789012345*(10)^(5)+6789*(10)^(1))"),
        (Integer(1000000000000000000003), "(1*(10)^(21)+3*(10)^(0))"),
        (Float("1e-7"), "0.0000001"),
        (Float("-2.5e10"), "(0-25000000000)"),
        (pi, "PI()"),
        (S.Exp1, "EXP(1)"),
        (x + y, "x+y"),
        (x - y, "x-y"),
        (y - x - 1, "y-x-1"),
        (-x, "(0-x)"),
        (-x - y, "0-x-y"),
        (-x * y, "(0-x*y)"),
        (x * (y + z), "x*(y+z)"),
        (x - 2 * (y + z), "x-2*y-2*z"),
        (Mul(-1, x + y, evaluate=False) * z, "(0-z*(x+y))"),
        (x / y, "x/y"),
        (x / (y * z), "x/(y*z)"),
        (x / (y + z), "x/(y+z)"),
        (2 * x / 3, "2*x/3"),
        (x / 3, "x/3"),
        (1 / x, "1/x"),
        (x**-2, "1/(x)^(2)"),
        (y * x**-2, "y/(x)^(2)"),
        (x**2, "(x)^(2)"),
        (-(x**2), "(0-(x)^(2))"),
        ((-x) ** 3, "(0-(x)^(3))"),
        ((x + 1) ** y, "(x+1)^(y)"),
        (x ** (-y), "(x)^(0-y)"),
        ((x**y) ** z, "((x)^(y))^(z)"),
        (x ** (y**z), "(x)^((y)^(z))"),
        (sqrt(P), "SQRT(P)"),
        (1 / sqrt(P), "1/SQRT(P)"),
        (P ** Rational(3, 2), "(P)^(3/2)"),
        (exp(x), "EXP(x)"),
        (log(x), "LN(x)"),
        (Abs(x), "ABS(x)"),
        (sign(x), "SIGN(x)"),
        (cos(x) + tanh(y), "COS(x)+TANH(y)"),
        (Max(x, y, 1), "MAX(1,x,y)"),
        (Min(x, y), "MIN(x,y)"),
        (x > y, "x>y"),
        (x <= y + 1, "x<=(y+1)"),
        (Eq(x, y), "x=y"),
        (Ne(x, y), "x<>y"),
        (And(x > 0, y > 0), "AND(x>0,y>0)"),
        (Or(x > 0, y > 0), "OR(x>0,y>0)"),
        (Not(IsNumber(x)), "NOT(ISNUMBER(x))"),
        (true, "TRUE()"),
        (Piecewise((x, x > 0), (y, True)), "IF(x>0,x,y)"),
        (Piecewise((x, x > 0), (y, x < -1), (z, True)), "IF(x>0,x,IF(x<(0-1),y,z))"),
        (Piecewise((x, x > 0)), "IF(x>0,x,NA())"),
        (IfError(1 / x, y), "IFERROR(1/x,y)"),
    ],
    ids=str,
)
def test_every_construct_is_printed(expression: Any, formula: str) -> None:
    assert printed(expression) == formula


@pytest.mark.parametrize(
    ("expression", "formula"),
    [
        (Max(x, y), "IF(x>=y,x,y)"),
        (Min(x, y, z), "IF(IF(x<=y,x,y)<=z,IF(x<=y,x,y),z)"),
        (And(x > 0, y > 0), "(x>0)*(y>0)"),
        (Or(x > 0, y > 0), "(x>0)+(y>0)>0"),
        (Piecewise((x, And(x > 0, y > 0)), (y, True)), "IF((x>0)*(y>0),x,y)"),
    ],
    ids=str,
)
def test_nothing_swallows_a_range_inside_of_a_sum(expression: Any, formula: str) -> None:
    assert printed(expression, rows=True) == formula


def test_what_tends_to_zero_is_added_without_rounding() -> None:
    assert ExcelPrinter(str).added(x - y) == "SUM(x,0-y)"
    assert ExcelPrinter(str).added(x * y) == "x*y"


def test_the_authors_order_is_computed_alike() -> None:
    with evaluate(False):
        expression = x * (y - z) / (P * P)
    assert printed(expression) == "x*(y-z)/(P*P)"


@pytest.mark.parametrize(
    "expression",
    [gamma(x), Function("f")(x), S.ComplexInfinity, RowSum(x, Symbol("rows"))],
    ids=str,
)
def test_half_a_formula_is_never_printed(expression: Any) -> None:
    with pytest.raises(NotPrintable):
        printed(x + expression)


# --- places ----------------------------------------------------------------------------------------------


def test_places() -> None:
    place = Place("tests", 7, 27, 3, Fraction(1, 1000))
    assert place.cell() == "tests!$AB$8"
    assert place.cell(2, "tests") == "$AB$10"
    assert place.range("pairs") == "tests!$AB$8:$AB$10"
    assert place.range("tests", first=1, rows=2) == "$AB$9:$AB$10"
    assert [letters(n) for n in (0, 25, 26, 701, 702, 16383)] == ["A", "Z", "AA", "ZZ", "AAA", "XFD"]


@pytest.mark.parametrize(
    ("name", "formula"),
    [("pairs", "pairs"), ("R1C1", "'R1C1'"), ("true", "'true'"), ("it's", "'it''s'"), ("XFD", "'XFD'")],
)
def test_a_worksheets_name_is_never_read_as_a_cell(name: str, formula: str) -> None:
    assert quoted(name) == formula


@pytest.mark.parametrize(
    ("scale", "both"),
    [
        (Fraction(1), ("", "")),
        (Fraction(1000), ("*1000", "/1000")),
        (Fraction(1, 10**6), ("/1000000", "*1000000")),
        (Fraction(254, 10000), ("*127/5000", "*5000/127")),
    ],
)
def test_units_are_whole_numbers(scale: Fraction, both: tuple[str, str]) -> None:
    assert factors(scale) == both


# --- the formulas of a sheet -----------------------------------------------------------------------------

k, p, q, i, j, s = (Symbol(name, integer=True, positive=True) for name in "kpqijs")
n_items, n_pairs, n_points = (
    Symbol(f"n_{n}", integer=True, positive=True) for n in ("items", "pairs", "points")
)
ITEMS = Axis("items", k, n_items)
PAIRS = PairAxis("pairs", p, n_pairs, of=ITEMS, first=i, second=j)
POINTS = RepeatAxis("points", q, n_points, of=PAIRS, step=s, count="per")


def formula(value: Any) -> Formula:
    return Formula(Equation("", (Symbol("made"), value), "for a test", Kind.DEFINITION, "made"))


def column(name: str, axis: Axis | None, value: Any = None, **more: Any) -> Column:
    return Column(name, axis, Given() if value is None else formula(value), **more)


a, w, per = column("a", ITEMS), column("w", None), column("per", None)


def made(
    *columns: Column,
    units: dict[str, str] | None = None,
    bounds: dict[str, Bounds] | None = None,
    items: tuple[int, ...] = (1, 2),
    **data: Any,
) -> Grid:
    given = {"a": [3.0, 5.0, 7.0][: len(items)], "w": 2.0, "per": 2, **data}
    sheet = Sheet(columns).bounded(bounds or {})
    values = engine.evaluate(sheet, {"items": items}, {name: given[name] for name in given if name in sheet})
    return excel_grid.grid(sheet, values, units or {})


def first(grid: Grid, name: str) -> str:
    return grid[name].formulas[0]


LEAST = "(2)^(0-1022)"
"""The least positive number that has all its digits."""


def test_a_row_names_the_cells_of_its_members_which_are_repeated_beside_it() -> None:
    grid = made(a, column("b", PAIRS, a[i] / a[j], positive=False), items=(1, 2, 3))
    one, other = grid["a[i] of pairs"], grid["a[j] of pairs"]
    assert one.formulas == ("=items!$D$8", "=items!$D$8", "=items!$D$9")
    assert other.formulas == ("=items!$D$9", "=items!$D$10", "=items!$D$10")
    assert grid["b"].filled == (
        FilledDown(
            3,
            "=IF(AND(ISNUMBER($D8),ISNUMBER($E8)),"
            'IFERROR($D8/$E8,IFERROR(IF($E8<>0,"#OVERFLOW!","#DOMAIN!"),"#DOMAIN!")),'
            '"#INPUT!")',
        ),
    )


def test_a_formula_is_filled_down_as_long_as_no_row_of_another_worksheet_moves() -> None:
    b = column("b", PAIRS, a[i] * a[j], positive=False)
    grid = made(a, per, b, column("c", POINTS, b[p] * s, positive=False), items=(1, 2, 3))
    assert grid["c"].filled == tuple(
        FilledDown(
            2,
            f"=IF(ISNUMBER(report!$G$6),IF(ISNUMBER(pairs!$C${row}),"
            f'IFERROR($C{top}*pairs!$C${row},"#OVERFLOW!"),pairs!$C${row}),"#INPUT!")',
        )
        for row, top in ((8, 8), (9, 10), (10, 12))
    )
    assert [block.name for block in grid.on("points") if block.kind == "carried"] == []


@pytest.mark.parametrize(
    ("rows", "near", "stretches"),
    [
        ([[0, 1, 2, 3]], [True], [(0, 3)]),
        ([[0, 1, 2, 3]], [False], [(0, 0), (1, 1), (2, 2), (3, 3)]),
        ([[5, 5, 5, 6]], [False], [(0, 2), (3, 3)]),
        ([[0, 1, 2, 3], [7, 7, 8, 8]], [True, False], [(0, 1), (2, 3)]),
        ([[0, 1, 2, 2]], [True], [(0, 2), (3, 3)]),
        ([[0, 1, 1, 2]], [True], [(0, 1), (2, 3)]),
        ([[0, 2, 4]], [True], [(0, 0), (1, 1), (2, 2)]),
        ([[4]], [True], [(0, 0)]),
    ],
)
def test_in_a_stretch_of_rows_each_address_stays_or_moves(
    rows: list[list[int]], near: list[bool], stretches: list[tuple[int, int]]
) -> None:
    assert list(_stretches(np.diff(np.array(rows)), np.array(near))) == stretches


@pytest.mark.parametrize(
    ("bounds", "tests"),
    [
        (Bounds(), []),
        (Bounds(low=0, low_open=True), ["{0}>0"]),
        (Bounds(-1, 0.5), ["{0}<=0.5", "{0}>=(0-1)"]),
        (Bounds(high=1.5707963267948966, high_open=True), ["{0}<1.5707963267948966"]),
        (Bounds(2, 1e22, integer=True), ["{0}<=10000000000000000000000", "{0}=INT({0})", "{0}>=2"]),
    ],
)
def test_what_is_allowed_is_asked_of_numbers_only(bounds: Bounds, tests: list[str]) -> None:
    asked = "NOT(ISLOGICAL({0}))"
    asked = f"AND({','.join([asked, *tests])})" if tests else asked
    assert guard(bounds) == f"IF(ISNUMBER({{0}}),{asked},FALSE())"


def test_a_given_cell_is_checked_in_a_cell_of_its_own() -> None:
    grid = made(column("a", ITEMS, unit="m"), units={"a": "mm"}, bounds={"a": Bounds(high=0.5)})
    typed, check = grid["a"], grid[checked("a")]
    assert (typed.kind, typed.formulas, check.kind, check.of) == ("given", (), "checked", "a")
    assert (check.unit, check.values) == ("mm", ("#INPUT!", "#INPUT!"))
    assert typed.bounds == Bounds(high=500)
    assert check.formulas[1] == f'=IF({typed.guard.format("$B9")},$B9,"#INPUT!")'
    assert "$B9<=500" in check.formulas[1]
    assert (typed.place.column, grid.notes["items"].column, check.place.column) == (1, 2, 3)


def test_a_count_is_that_of_the_rows_there_are() -> None:
    grid = made(a, per, column("c", POINTS, s * a[i]), bounds={"per": Bounds(1, 9)})
    assert grid["per"].bounds == Bounds(2, 2)
    assert "{0}<=2,{0}>=2" in grid["per"].guard


def test_an_error_is_carried_on_before_anything_is_computed() -> None:
    b = column("b", ITEMS, a[k] * 2)
    grid = made(a, w, b, column("c", ITEMS, b[k] + w.symbol, positive=False))
    assert first(grid, "c") == (
        '=IF(ISNUMBER(report!$G$6),IF(ISNUMBER($D8),IFERROR(report!$G$6+$D8,"#OVERFLOW!"),$D8),"#INPUT!")'
    )


def test_a_positive_quantity_has_no_other_value() -> None:
    grid = made(
        a, w, column("c", ITEMS, a[k] - w.symbol), column("d", ITEMS, a[k] - w.symbol, positive=False)
    )
    core = "$F8-report!$G$6"
    small = f'IF({core}>0,"#OVERFLOW!","#DOMAIN!")'
    assert f'IFERROR(IF({core}>={LEAST},{core},{small}),"#OVERFLOW!")' in first(grid, "c")
    assert f'IFERROR({core},"#OVERFLOW!")' in first(grid, "d")


def test_what_is_typed_may_be_zero_although_its_symbol_is_positive() -> None:
    twice = column("b", ITEMS, a[k] * 2)
    grid = made(a, twice, column("c", ITEMS, twice[k] * 2))
    small = 'IF(OR(2*$F8>0,SIGN($F8)>0),"#OVERFLOW!","#DOMAIN!")'
    assert f"IF(2*$F8>={LEAST},2*$F8,{small})" in first(grid, "b")
    # The precedent was checked in its own cell: what is zero here was positive.
    assert f'IF(2*$D8>={LEAST},2*$D8,"#OVERFLOW!")' in first(grid, "c")


def test_conditions_come_before_the_value() -> None:
    needs = ((a[k] > w.symbol, "for a test"), (Ne(a[k], 4), "for a test"))
    grid = made(a, w, column("c", ITEMS, a[k] + w.symbol, requires=needs, positive=False))
    value = 'IFERROR(report!$G$6+$E8,"#OVERFLOW!")'
    body = f'IFERROR(IF(AND($E8>report!$G$6,$E8<>4),{value},"#DOMAIN!"),"#DOMAIN!")'
    assert body in first(grid, "c")


def test_cells_in_other_units_are_converted_where_they_are_named() -> None:
    length: dict[str, Any] = {"unit": "m", "positive": False}
    b = column("b", ITEMS, a[k] * 2, **length)
    grid = made(column("a", ITEMS, **length), b, units={"a": "mm", "b": "km"})
    assert 'IFERROR(2*($E8/1000)/1000,"#OVERFLOW!")' in first(grid, "b")
    assert grid["b"].values == (0.006, 0.01)
    assert grid["a"].unit == "mm"


def test_a_symbol_in_a_unit_leaves_si() -> None:
    grid = made(a, column("b", ITEMS, a[k] * 2, unit="N/m^alpha"), units={"b": "N/m^alpha"})
    assert (grid["b"].unit, grid["b"].place.scale) == ("N/m^alpha", 1)


def test_a_sum_leaves_rows_without_values_out() -> None:
    grid = made(a, w, column("c", None, w.symbol * Sum(a[k] ** 2, (k, 1, n_items)) / n_items, positive=False))
    cells = "items!$D$8:$D$9"
    rows = f"SUM(IF(ISNUMBER({cells}),1,0))"
    assert first(grid, "c") == (
        f"=IF({rows}>0,IF(ISNUMBER($G$6),"
        f"IFERROR($G$6*SUM(IF(ISNUMBER({cells}),({cells})^(2),0))/"
        f'{rows},"#OVERFLOW!"),"#INPUT!"),"#INPUT!")'
    )
    assert grid["c"].array
    assert grid["c"].kept == {"items": f"={rows}"}


def test_the_size_of_an_axis_that_is_not_summed_counts_all_rows() -> None:
    grid = made(a, column("b", PAIRS, a[i]), w, column("c", None, w.symbol * n_pairs))
    assert "ROWS(pairs!$A$8:$A$8)*$G$6" in first(grid, "c")
    assert not grid["c"].array


def test_a_sum_reaches_another_axis_through_a_column_of_its_own() -> None:
    b = column("b", PAIRS, a[i] * a[j])
    grid = made(a, per, b, column("c", POINTS, b[p] * s), column("d", None, Sum(b[p] * s, (q, 1, n_points))))
    carried = grid["b[p] of points"]
    assert (carried.kind, carried.formulas) == ("carried", ("=pairs!$C$8", "=pairs!$C$8"))
    where = carried.place.range("report")
    assert f"SUM(IF(ISNUMBER({where}),points!$C$8:$C$9*{where},0))" in first(grid, "d")
    assert carried.place.column > grid["c"].place.column


def test_a_missing_datum_is_carried_as_such() -> None:
    grid = made(a, per, column("c", POINTS, s / 2 + a[i]), column("d", None, Sum(a[i] * s, (q, 1, n_points))))
    assert grid["a[i] of points"].formulas[0] == "=items!$D$8"


@pytest.mark.parametrize(
    ("names", "worksheets"),
    [
        (("report", "Figures"), ["report_rows", "Figures_rows"]),
        (("runs", "Runs", "runs_rows"), ["runs", "Runs_rows", "runs_rows_rows"]),
        (("r" * 31, "r" * 40, "r" * 41), ["r" * 31, "r" * 26 + "_rows", "r" * 24 + "_rows_2"]),
    ],
)
def test_no_two_worksheets_have_one_name(names: tuple[str, ...], worksheets: list[str]) -> None:
    columns = [
        Column(f"a_{n}", Axis(name, Symbol(f"k_{n}", integer=True), Symbol(f"n_{n}")), Given())
        for n, name in enumerate(names)
    ]
    sheet = Sheet(tuple(columns))
    values = engine.evaluate(
        sheet, dict.fromkeys(names, (1, 2)), {name: [1.0, 2.0] for name in sheet.by_name}
    )
    grid = excel_grid.grid(sheet, values, {})
    assert [grid[column.name].place.worksheet for column in columns] == worksheets


def test_more_rows_than_a_worksheet_should_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(excel_grid, "MOST_ROWS", 1)
    with pytest.raises(excel_grid.TooManyRows, match="items has 2 rows"):
        made(a)


def test_formulas_are_kept_by_all_that_they_hang_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Made from nothing and taken up again, whatever else is kept, a grid is the same."""
    mean = column("mean", None, Sum(a[k], (k, 1, n_items)) / n_items)
    counted = column("counted", POINTS, Symbol("s", integer=True, positive=True) * a[i] * w.symbol)
    columns = (a, w, per, mean, counted, cubic(1))
    others: tuple[Any, ...] = (
        {},
        {"units": {"a": "um", "mean": "mm"}},
        {"bounds": {"a": Bounds(low=0)}},
        {"bounds": {"a": Bounds(low=0, low_open=True)}},
        {"per": 3},
        {"a": [4.0, 1.0]},
    )

    two = engine.evaluate(Sheet((w, per)), {}, {"w": 2.0, "per": 2})

    def every() -> list[Grid]:
        grids = [made(*columns, **other) for other in others]
        values = engine.evaluate(Sheet((a,)), {"items": (3, 1)}, {"a": [3.0, 5.0]})
        say = replace(a, meaning="a word", unit="m")
        said = engine.evaluate(Sheet((say,)), {"items": (3, 1)}, {"a": [3.0, 5.0]})
        first = [excel_grid.grid(Sheet((w, per)), two, {}, own) for own in ((), ("per",))]
        grids += [excel_grid.grid(each.sheet, each, {}) for each in (values, said)]
        return [*grids, *first]

    expected = every()
    assert len({repr(grid.blocks) for grid in expected}) == len(expected)
    monkeypatch.setenv(SETTING, str(tmp_path / "kept"))
    assert every() == expected
    with monkeypatch.context() as patch:
        patch.setattr(excel_assembly, "lowered", lambda *_: pytest.fail("it was lowered again"))
        assert every() == expected


# --- roots -----------------------------------------------------------------------------------------------


def cubic(steps: int = 3) -> Column:
    """z^3 - 3z = a between -3 and 3: one root, or three for |a| < 2; none beyond 18."""
    unknown = Symbol("z", real=True)
    form = Equation("", (unknown**3 - 3 * unknown - a[k], Integer(0)), "for a test", Kind.DEFINITION, "cubic")
    turning = (Integer(-1), Integer(1))
    root = Root(
        form, form, unknown, unknown**2, Integer(-3), Integer(3), a[k] / 3, turning=turning, steps=steps
    )
    return Column("root", ITEMS, root)


def unrolled(column: Column) -> Unrolled:
    plan = lowered_column(Sheet((a, column)), column)
    (node,) = (each for each in plan.nodes if isinstance(each, RootNode))
    return unroll(plan, node, certified=True, times=2)


def test_a_root_is_unrolled_in_the_order_of_its_evaluation() -> None:
    names = [cell.name for cell in unrolled(cubic(1)).cells]
    assert names == [
        f"root.{name}"
        for name in (
            "low", "high", "start", "form_low", "sign_low", "turn1_raw", "turn1", "form_turn1", "sign_turn1",
            "turn2_raw", "turn2", "form_turn2", "sign_turn2", "form_high", "sign_high", "roots", "left_0",
            "right_0",
            "rising", "u_0", "f_1", "slope0_1", "slope1_1", "slope2_1", "step_1", "left_1", "right_1", "u_1",
            "f_2", "slope0_2", "slope1_2", "slope2_2", "step_2", "left_2", "right_2", "u_2",
        )
    ]  # fmt: skip


def test_the_cells_of_a_root() -> None:
    grid = made(a, cubic())
    at = {
        name: grid[f"root.{name}"].place.moving(0, "items")
        for name in ("check", "roots", "u_0", "f_1", "step_1")
    }
    assert first(grid, "root.check") == '=IF(ISNUMBER($E8),"ready","#INPUT!")'
    assert first(grid, "root.low") == f'=IF({at["check"]}="ready",IFERROR((0-3),""),"")'
    u = at["u_0"]
    assert first(grid, "root.f_1") == f'=IF({at["roots"]}=1,IFERROR(SUM(({u})^(3),0-3*{u},0-$E8),""),"")'
    f, *slopes = (
        grid[f"root.{name}"].place.moving(0, "items") for name in ("f_1", "slope0_1", "slope1_1", "slope2_1")
    )
    g, h, m = slopes
    step = f"3*{f}*(2*({g})^(2)-{f}*{h})/(({f})^(2)*{m}+6*({g})^(3)-6*{f}*{g}*{h})"
    assert first(grid, "root.step_1") == f'=IF({at["roots"]}=1,IFERROR({step},""),"")'
    last, before, value = (grid[f"root.{name}"].place.moving(0, "items") for name in ("u_6", "u_5", "f_6"))
    square = f"({last})^(2)"
    square = f'IFERROR(IF({square}>={LEAST},{square},IF({square}>0,"#OVERFLOW!","#DOMAIN!")),"#OVERFLOW!")'
    settled = f'IF(10000000*ABS({before}-{last})<=ABS({last}),{square},"#STEPS!")'
    n, ready = at["roots"], at["check"]
    one = f'IF({n}=1,IF(ISNUMBER({value}),{settled},"#DOMAIN!"),IF({n}=0,"#NOROOT!","#TWOROOTS!"))'
    found = f'IFERROR(IF(ISNUMBER({n}),{one},"#DOMAIN!"),"#DOMAIN!")'
    assert first(grid, "root") == f'=IF({ready}="ready",{found},{ready})'


def test_the_steps_show_what_the_solver_found() -> None:
    column = cubic(8)
    sheet = Sheet((a, column))
    values = engine.evaluate(sheet, {"items": (1, 2, 3, 4)}, {"a": [2.5, 1.0, 30.0, np.nan]})
    shown = auxiliary_values(values, auxiliary_texts(sheet, unrolled(column)))
    assert shown["root.check"] == ("ready", "ready", "ready", "#INPUT!")
    assert shown["root.roots"] == (1.0, 3.0, 0.0, "")
    assert shown["root.u_8"][1:] == ("", "", "")
    assert float(shown["root.u_8"][0]) ** 2 == pytest.approx(values.value["root"][0], rel=1e-15)


def test_every_sum_of_a_scalar_root_has_a_cell_of_its_own() -> None:
    unknown = Symbol("u", positive=True)
    side = Sum(exp(-unknown * a[k]), (k, 1, n_items)) - unknown * Sum(a[k], (k, 1, n_items))
    form = Equation("", (side, Integer(0)), "for a test", Kind.DEFINITION, "balance")
    root = Column(
        "root", None, Root(form, form, unknown, unknown, Integer(0), Integer(9), Integer(1), steps=6)
    )
    grid = made(a, root)
    sums = [b for b in grid.on("steps") if "sum_" in b.name]
    assert all(b.array and b.formulas[0].count("SUM(") == 1 for b in sums)
    assert [b.title for b in sums if b.step == 1] == ["Σ₁", "Σ₂"]
    assert first(grid, "root.step_1").count("/") == 1, "Newton's step: a derivative is a sum"
    assert grid["root"].values[0] == pytest.approx(float(grid["root.u_6"].values[0] or 0), rel=1e-14)


def test_a_sum_in_a_sum_is_named_by_its_cell() -> None:
    unknown, all_a = Symbol("u", positive=True), Sum(a[k], (k, 1, n_items))
    side = Sum(exp(-unknown * a[k]) * all_a, (k, 1, n_items)) - Sum(unknown * a[k], (k, 1, n_items)) / 9
    form = Equation("", (side, Integer(0)), "for a test", Kind.DEFINITION, "balance")
    root = Root(form, form, unknown, unknown, Integer(0), Integer(9), Integer(1), steps=6)
    grid = made(a, Column("root", None, root))
    sums = [b for b in grid.on("steps") if "sum_" in b.name]
    assert [b.formulas[0].count("SUM(") for b in sums] == [1] * len(sums)
    said = [b.meaning for b in sums]
    assert said.count("sum of a[k]") == 1
    assert "sum of (sum of a[k])*exp(-u*a[k])" in said
    assert grid["root"].values[0] == pytest.approx(float(grid["root.u_12"].values[0] or 0), rel=1e-14)


def decades(low: str = "1e-14", steps: int = 4) -> Column:
    """z + 1e-8 = a 1e-15/z between some 1e-14 and 1: near 3e-7 for a = 100, and 1e-8 for 0.3."""
    z = Symbol("z", positive=True)
    side = z + Rational("1e-8") - a[k] * Rational("1e-15") / z
    form = Equation("", (side, Integer(0)), "for a test", Kind.DEFINITION, "decades")
    root = Root(form, form, z, z, Rational(low), Integer(1), Rational("1/2"), Integer(-1), steps=steps)
    return Column("root", ITEMS, root)


def test_so_many_steps_are_laid_out_that_all_rows_settle() -> None:
    found = {}
    for low in ("1e-14", "0"):
        grid = made(a, decades(low), a=[100.0, 0.3])
        steps = 0
        while f"root.u_{steps + 1}" in grid.by_name:
            steps += 1
        found[low] = steps
        last = [float(grid[f"root.u_{steps}"].values[row] or 0) for row in (0, 1)]
        roots = [2e-15 * own / (math.sqrt(1e-16 + 4e-15 * own) + 1e-8) for own in (100, 0.3)]
        assert last == pytest.approx(roots, rel=1e-14, abs=0)
        assert last == pytest.approx(grid["root"].values, rel=1e-14, abs=0)
    # Without a zero among the ends its decades are halved; with one it is its width.
    assert found == {"1e-14": 8, "0": 32}


def test_a_bracket_over_decades_is_halved_by_its_decades() -> None:
    grid = made(a, decades())
    left, right = (grid[f"root.{end}_1"].place.moving(0, "items") for end in ("left", "right"))
    assert f"SQRT({left})*SQRT({right})" in first(grid, "root.u_1")
