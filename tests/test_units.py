"""Dimensions are checked before any code is made: each kind of failure has its literal sentence."""

import re

import pytest
from helpers import whole
from sympy import Abs, And, Expr, Max, Min, Piecewise, Rational, Sum, Symbol, exp, log, sign, sin, sqrt

from loopsheet import Method, given, let, mean, measured
from loopsheet.derivations import soft_impact as model
from loopsheet.derivations.equation import Equation
from loopsheet.derivations.reductions import Greatest, Least, Median
from loopsheet.report.cells import units
from loopsheet.report.cells.units import DimensionMismatch, dimension_of_unit
from loopsheet.report.sheet import Axis, Column, Formula, Given, Root, Sheet
from loopsheet.report.workbooks.soft_impact import WORKBOOK

k, n = whole("k"), whole("n")
ROWS = Axis("rows", k, n)
length = Column("length", None, Given(), "m")
time = Column("time", None, Given(), "s")
mass = Column("mass", None, Given(), "kg")
power = Column("power", None, Given(), "1")
stiffness = Column("stiffness", None, Given(), "N/m^power")
reach = Column("reach", ROWS, Given(), "m")
rate = Column("rate", ROWS, Given(), "1")
soft = Column("soft", ROWS, Given(), "N/m^rate")
GIVEN = (length, time, mass, power, stiffness, reach, rate, soft)
L, T, M, a, S = (column.symbol for column in GIVEN[:5])


def check(
    expression: Expr, unit: str, axis: Axis | None = None, requires: tuple[tuple[Expr, str], ...] = ()
) -> None:
    equation = Equation("(7)", (Symbol("f"), expression), "for this test")
    column = Column("f", axis, Formula(equation), unit, requires=requires)
    units.check(Sheet((*GIVEN, column)))


# ---------------------------------------------------------------------------------------- unit text
@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("N", "kg*m/s^2"),
        ("J", "N*m"),
        ("W", "J/s"),
        ("Pa", "N/m^2"),
        ("Hz", "1/s"),
        ("1", "m/m"),
        ("m^1/s^-1", "m*s"),
        (" kg / m^3 ", "kg*m^-3"),
        ("m^3/m", "m^2"),
        ("J/(kg K)", "m^2 s⁻² K^-1"),
        ("N/m^(3/2)", "N·m**-1.5"),
        ("rad/s", "Hz"),
    ],
)
def test_units_are_products_of_base_units(text: str, same: str) -> None:
    assert dimension_of_unit(text) == dimension_of_unit(same)


def test_an_exponent_may_be_a_name() -> None:
    assert dimension_of_unit("N/m^q", {"q": a}) == {"kg": 1, "m": 1 - a, "s": -2}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("furlog", "'furlog' cannot be read: unknown unit 'furlog'; did you mean 'furlong'?"),
        ("m//s", "'m//s' cannot be read: no unit '/'"),
        ("m^3/2", "'m^3/2' cannot be read: no unit '2'; write a fraction as ^(3/2)"),
        ("m/", "'m/' cannot be read: no unit 'm/'"),
        ("mm", "'mm' is no unit of SI without prefix, such as m"),
        ("deg", "'deg' is no unit of SI without prefix, such as 1"),
        ("N/m^q", "unknown exponent 'q' in the unit 'N/m^q'"),
    ],
)
def test_what_is_no_unit_is_refused(text: str, message: str) -> None:
    with pytest.raises(DimensionMismatch, match="^" + re.escape(message) + "$"):
        dimension_of_unit(text)


def test_an_exponent_must_be_a_column() -> None:
    odd = Column("odd", None, Given(), "N/m^gamma")
    with pytest.raises(
        DimensionMismatch, match=r"^odd: its unit 'N/m\^gamma' names 'gamma', which is no column$"
    ):
        units.check(Sheet((odd,)))


# ----------------------------------------------------------------------------------------- formulas
RIGHT: dict[str, tuple[Expr, str, Axis | None]] = {
    "sum": (L + 2 * L, "m", None),
    "product": (M * L / T**2, "N", None),
    "power law": (S * L**a, "N", None),
    "work of a power law": (S * L ** (a + 1) / (a + 1), "J", None),
    "its inverse": ((M * L**2 / T**2 * (a + 1) / S) ** (1 / (a + 1)), "m", None),
    "power law of a row": (soft[k] * reach[k] ** rate[k], "N", ROWS),
    "root": (sqrt(L**2 + L * L), "m", None),
    "function of a ratio": (exp(log(L / L) + sin(T / T)), "1", None),
    "largest": (Max(L, 2 * L) + Min(L, L / 2), "m", None),
    "largest with zero": (Max(L - 2 * L, 0), "m", None),
    "size and sign": (Abs(L - 2 * L) * sign(T - 2 * T), "m", None),
    "sum over rows": (Sum(reach[k] ** 2, (k, 1, n)) / n, "m^2", None),
    "median over rows": (Median(reach[k], (k, 1, n)) ** 2, "m^2", None),
    "range": (Greatest(reach[k], (k, 1, n)) - Least(reach[k], (k, 1, n)), "m", None),
    "cases": (Piecewise((L, And(T > 0, L < 2 * L)), (2 * L, True)), "m", None),
    "zero has any unit": (L - L, "kg", None),
}


@pytest.mark.parametrize("case", RIGHT)
def test_sound_formulas_pass(case: str) -> None:
    check(*RIGHT[case])


WRONG: dict[str, tuple[Expr, str, str]] = {
    "adding": (L + T, "m", "f (7): cannot add m and s in length + time"),
    "adding a number": (1 + L, "m", "f (7): cannot add 1 and m in length + 1"),
    "another unit": (
        L / T,
        "m",
        "f (7): the unit is m, but the formula gives m s^-1: in length/time",
    ),
    "logarithm": (
        log(L),
        "1",
        "f (7): the argument of a function must be a pure number, not m, in log(length)",
    ),
    "exponential": (
        exp(T),
        "1",
        "f (7): the argument of a function must be a pure number, not s, in exp(time)",
    ),
    "sine": (
        sin(L),
        "1",
        "f (7): the argument of a function must be a pure number, not m, in sin(length)",
    ),
    "exponent": (
        L**T,
        "m",
        "f (7): an exponent must be a pure number, not s, in length**time",
    ),
    "largest": (Max(L, T), "m", "f (7): cannot compare m and s in Max(length, time)"),
    "smallest": (Min(L, T), "m", "f (7): cannot compare m and s in Min(length, time)"),
    "within a sum": (
        Sum(reach[k] + rate[k], (k, 1, n)),
        "m",
        "f (7): cannot add 1 and m in rate[k] + reach[k]",
    ),
    "cases": (
        Piecewise((L, a > 2), (T, True)),
        "m",
        "f (7): cannot choose between m and s in Piecewise((length, power > 2), (time, True))",
    ),
    "condition of a case": (
        Piecewise((L, T > L), (2 * L, True)),
        "m",
        "f (7): cannot compare m and s in length < time",
    ),
    "symbolic exponent": (
        S * L ** (a + 1),
        "N",
        "f (7): the unit is N, in SI kg m s^-2, but the formula gives kg m^2 s^-2: "
        "in length**(power + 1)*stiffness",
    ),
    "exponent of another quantity": (
        S * L ** (2 * a),
        "N",
        "f (7): the unit is N, in SI kg m s^-2, but the formula gives kg m^(power + 1) s^-2: "
        "in length**(2*power)*stiffness",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_each_failure_names_column_equation_expression_and_both_dimensions(case: str) -> None:
    expression, unit, message = WRONG[case]
    with pytest.raises(DimensionMismatch) as error:
        check(expression, unit)
    found = str(error.value)
    # sympy may turn a comparison round.
    assert found in (message, message.replace("m and s in length < time", "s and m in time > length"))


def test_a_condition_is_checked_too() -> None:
    with pytest.raises(DimensionMismatch, match=r"^f \(7\): cannot compare m and s in length > time$"):
        check(L, "m", requires=((L > T, "never"),))


def test_a_cell_of_another_row_has_that_rows_exponent() -> None:
    total = Sum(soft[k] * reach[k] ** rate[k], (k, 1, n))
    check(total, "N")
    with pytest.raises(DimensionMismatch, match=r"gives kg m\^\(2 - rate\[k\]\) s\^-2"):
        check(Sum(soft[k] * reach[k], (k, 1, n)), "N")


# -------------------------------------------------------------------------------------------- roots
u = Symbol("u", positive=True)
ROOT_SETTINGS = {"low": Rational(0), "high": Rational(1), "start": Rational(1, 2), "value": u}


def check_root(form: Expr, unit: str = "1", **changed: Expr) -> None:
    equation = Equation("(9)", (form, 0 * u), "for this test")
    rule = Root(equation=equation, form=equation, unknown=u, **{**ROOT_SETTINGS, **changed})
    units.check(Sheet((*GIVEN, Column("r", None, rule, unit))))


def test_a_sound_root_passes() -> None:
    check_root(u * L - 2 * L)
    check_root(u - L, "m", high=2 * L, start=L, turning=(L,), sign_low=-T, sign_high=M)
    check_root(u * L - 2 * L, "m", value=u * L)


@pytest.mark.parametrize(
    ("form", "unit", "changed", "message"),
    [
        (u * L - T, "1", {}, "cannot add s and m"),
        (u - L, "1", {}, "cannot add 1 and m"),
        (u * L - L, "m", {"value": u * T}, "the unit is m, but the formula gives s"),
        (u - a, "1", {"high": L}, "the unit is 1, but the formula gives m"),
        (u - a, "1", {"start": L}, "the unit is 1, but the formula gives m"),
        (u - a, "1", {"turning": (L,)}, "the unit is 1, but the formula gives m"),
        (u - a, "1", {"sign_low": L + T}, "cannot add m and s"),
    ],
)
def test_each_part_of_a_root_is_checked(
    form: Expr, unit: str, changed: dict[str, Expr], message: str
) -> None:
    with pytest.raises(DimensionMismatch, match=r"^r \(9\): ") as error:
        check_root(form, unit, **changed)
    assert message in str(error.value) or message.replace("s and m", "m and s") in str(error.value)


# ------------------------------------------------------------------------- the paper's own formulas
SHEET = WORKBOOK.sheet(frozenset({"ball_diameter", "ball_density", "target_mass"}))
NAMED = {column.name: column for column in SHEET.columns}
v, e, x_p, x_m = (NAMED[name][whole("k")] for name in ("v", "e", "x_p", "x_m"))
C, alpha, m = NAMED["C_log"].symbol, NAMED["alpha_log"].symbol, NAMED["m_red"].symbol


def with_formula(name: str, expression: Expr) -> Sheet:
    """The paper's sheet with another formula in one column."""
    old = NAMED[name]
    equation = Equation("(7)", (old.cell, expression), "a wrong variant")
    new = Column(name, old.axis, Formula(equation), old.unit)
    return Sheet(tuple(new if column is old else column for column in SHEET.columns))


def test_the_papers_own_formulas_are_sound() -> None:
    units.check(SHEET)


VARIANTS: dict[str, tuple[str, Expr]] = {
    "a dropped mass": ("x_m", ((alpha + 1) * v**2 / (2 * C)) ** (1 / (alpha + 1))),
    "a dropped speed": ("x_m", ((alpha + 1) * m * v / (2 * C)) ** (1 / (alpha + 1))),
    "the wrong exponent": ("x_m", ((alpha + 1) * m * v**2 / (2 * C)) ** (1 / alpha)),
    "a length added to a speed": ("x_m", x_p + v),
    "a length that is not divided": ("Cprime_eq7", m * (e * v) ** 2),
    "a difference with a speed": ("Cprime_eq7", m * (e * v) ** 2 / (x_m - v)),
    "an exponent with a unit": ("Cprime_eq9", C * x_m**x_m),
    "a missing exponent": ("Cprime_eq9", C * x_m),
    "an exponent of another fit": ("Cprime_eq9", C * x_m ** NAMED["alpha_lin"].symbol),
    "a logarithm of a length": ("alpha_mean", log(NAMED["x_ref"].symbol)),
    "a density for a mass": ("m_red", NAMED["ball_density"].symbol),
    "a product for a quotient": ("m_red", NAMED["ball_mass"].symbol * NAMED["target_mass"].symbol),
}


@pytest.mark.parametrize("case", VARIANTS)
def test_wrong_variants_of_the_papers_formulas_are_caught(case: str) -> None:
    name, expression = VARIANTS[case]
    with pytest.raises(DimensionMismatch, match=rf"^{name} \(7\): "):
        units.check(with_formula(name, expression))


def test_the_equations_of_the_ledger_give_the_sheets_formulas() -> None:
    assert NAMED["x_m"].equation is not None
    assert NAMED["x_m"].equation.origin == model.LEDGER["(L3)"]


def test_a_result_is_shown_as_what_of_its_kind_it_is_computed_from() -> None:
    class Rods(Method):
        """Rods."""

        a = measured("mm", "length")
        b = measured("um", "width")
        F = measured("kN", "force")
        T = measured("degC", "temperature")
        phi = given("deg", "angle")
        longer = let(a - mean(a), "length beyond the mean")
        twice = let(2 * abs(longer), "twice as much")
        both = let(a + b, "length and width")
        area = let(a * b, "area")
        work = let(a * F, "work")
        across = let(sin(phi), "sine")
        T_m = let(mean(T), "mean temperature")
        T_d = let(T - T_m, "deviation from it")
        stated = let(a / 2, "half of it", "cm")

    shown = {column.name: column.display for column in Rods.workbook.sheet(frozenset({"phi"})).columns}
    assert (shown["longer"], shown["twice"], shown["T_m"]) == ("like a", "like longer", "like T")
    assert shown["both"] == shown["area"] == shown["work"] == shown["across"] == ""
    assert (shown["T_d"], shown["stated"]) == ("delta_degC", "cm")
