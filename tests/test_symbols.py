"""The vocabulary of the paper, the dimensions of its units, and how a terminal shows what is written."""

import pytest
from sympy import (
    Add,
    And,
    Expr,
    Function,
    Indexed,
    IndexedBase,
    Integral,
    Le,
    Max,
    Mul,
    Piecewise,
    Rational,
    Sum,
    Symbol,
    exp,
    log,
    sin,
    sqrt,
)
from sympy.core.parameters import evaluate

from loopsheet.derivations import soft_impact as model
from loopsheet.derivations.dimensions import DimensionError, Dimensions, dimension_of_unit, mixed, text_of
from loopsheet.derivations.equation import Derivation
from loopsheet.derivations.reductions import Least, Median
from loopsheet.derivations.soft_impact import LEDGER
from loopsheet.derivations.symbols import VOCABULARY, k
from loopsheet.derivations.text import text, text_of_equation
from loopsheet.derivations.unit_text import parse_unit

# --- the vocabulary ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", VOCABULARY)
def test_plain_and_indexed_symbols_agree(name: str) -> None:
    quantity = VOCABULARY[name]
    assert quantity.name == name
    assert str(quantity.symbol) == name
    assert quantity[k].base.label == quantity.symbol
    assert bool(quantity[k].is_positive) is bool(quantity.symbol.is_positive) is quantity.positive
    assert quantity.symbol.is_real
    assert VOCABULARY.find(quantity.symbol) is VOCABULARY.find(quantity[1]) is quantity


@pytest.mark.parametrize("name", VOCABULARY)
def test_every_quantity_is_complete(name: str) -> None:
    quantity = VOCABULARY[name]
    assert quantity.meaning
    assert quantity.latex.count("%s") == 1
    assert quantity.text.count("%s") == (1 if quantity.text else 0)
    low, high = quantity.span
    assert low < high
    assert low > 0 or not quantity.positive
    Dimensions(VOCABULARY).of_cell(quantity.symbol)  # its unit can be read


def test_what_the_vocabulary_does_not_say() -> None:
    assert VOCABULARY.find(Symbol("nothing")) is None
    assert VOCABULARY.plain("alpha x_m") == (model.alpha, model.x_m)


def test_the_vocabulary_says_every_symbol_of_the_ledger() -> None:
    counts = {"n_points", "n_pairs", "k", "p", "q", "s"}
    for equation in LEDGER.equations():
        for side in equation.sides:
            for symbol in side.free_symbols:
                name = symbol.base.label if isinstance(symbol, Indexed) else symbol
                assert VOCABULARY.find(symbol) is not None or str(name) in counts, equation.label


# --- dimensions -------------------------------------------------------------------------------------------


def test_every_equation_of_the_ledger_is_of_one_dimension() -> None:
    for entry in LEDGER.entries:
        steps = entry.steps if isinstance(entry, Derivation) else ()
        for equation in (
            entry.claim if steps else entry,
            *(e for s in steps for e in (s.claim, *s.premises)),
        ):
            assert mixed(equation, VOCABULARY) == "", equation.label
            for symbol in {s for member in equation.members for s in member.free_symbols}:
                assert symbol.is_integer or VOCABULARY.find(symbol) is not None  # so that it was judged


def test_a_wrong_exponent_is_of_another_dimension() -> None:
    dimensions = Dimensions(VOCABULARY)
    C, alpha, x_m = VOCABULARY.plain("C alpha x_m")
    assert dimensions.of(C * x_m**alpha) == dimension_of_unit("N")
    assert dimensions.of(C * x_m ** (alpha + 1)) == dimension_of_unit("J")
    assert dimensions.of(Integral(C * x_m**alpha, (x_m, 0, VOCABULARY["x"].symbol))) == dimension_of_unit("J")
    assert dimensions.of(C) == {**dimension_of_unit("N"), "m": 1 - alpha}


@pytest.mark.parametrize(
    ("expression", "problem"),
    [
        (model.x_m + model.v, "cannot add m s^-1 and m"),
        (Max(model.x_m, model.v), "cannot compare"),
        (exp(model.x_m), "the argument of a function must be a pure number"),
        (log(model.v), "the argument of a function must be a pure number"),
        (model.alpha**model.x_m, "an exponent must be a pure number"),
        (Piecewise((model.x_m, model.x_m > model.v), (model.x_p, True)), "cannot compare"),
        (Piecewise((model.x_m, model.x_m > model.x_p), (model.v, True)), "cannot choose between"),
        (Integral(model.x, (model.x, 0, model.v)), "cannot compare"),
        (sin(model.v), "the argument of a function must be a pure number"),
    ],
)
def test_what_has_no_dimension(expression: Expr, problem: str) -> None:
    with pytest.raises(DimensionError, match=problem.replace("^", r"\^")):
        Dimensions(VOCABULARY).of(expression)


@pytest.mark.parametrize(
    ("unit", "problem"),
    [
        ("furlong", "no unit of SI without prefix"),
        ("N/m^gamma", "unknown exponent 'gamma'"),
        ("N/m^(3/2", "no unit '\\^"),
        ("m/", "no unit 'm/'"),
        ("m^3/2", "no unit '2'; write a fraction"),
    ],
)
def test_units_that_cannot_be_read(unit: str, problem: str) -> None:
    with pytest.raises(DimensionError, match=problem):
        dimension_of_unit(unit)


NAMED_UNITS = [
    "kg", "m", "s", "K", "A", "mol", "cd", "N", "J", "Pa", "W", "Hz", "C", "V", "ohm", "S", "F", "Wb", "T",
    "H",
]  # fmt: skip


@pytest.mark.parametrize("name", NAMED_UNITS)
def test_named_units_are_those_of_the_data(name: str) -> None:
    unit = parse_unit(name)
    assert unit.scale == 1
    assert dict(dimension_of_unit(name)) == dict(unit.dimension)


def test_units() -> None:
    assert dimension_of_unit("1") == {}
    assert dimension_of_unit("kg*m/s^2") == dimension_of_unit("N") == dimension_of_unit("J/m")
    assert dimension_of_unit("m/s^-1") == dimension_of_unit("m*s")
    assert text_of(dimension_of_unit("N/m^(3/2)")) == "kg m^(-1/2) s^-2"
    assert text_of(dimension_of_unit("Pa")) == "kg m^-1 s^-2"
    assert text_of({}) == "1"


# --- the terminal -----------------------------------------------------------------------------------------

a, b, c = (IndexedBase("w")[n] for n in (1, 2, 3))
w = Symbol("w")
with evaluate(False):
    WRITTEN = [
        (w**2, "w^2"),
        (-w, "-w"),
        (2 * w, "2*w"),
        (Rational(1, 2) * w, "1/2*w"),
        (w * Rational(3, 2), "w*(3/2)"),
        (w ** Rational(3, 2), "w^(3/2)"),
        (w**-2, "1/w^2"),
        (1 / w, "1/w"),
        (1 / (1 + w), "1/(1 + w)"),
        (w - (1 - w), "w - (1 - w)"),
        (-(w / (w + 1)), "-w/(w + 1)"),
        ((w + 1) * (w - 1), "(w + 1)*(w - 1)"),
        (w / 2 * ((w + 1) / w**w), "w/2*(w + 1)/w^w"),
        (w / (w * w), "w/(w*w)"),
        ((-w) ** 2, "(-w)^2"),
        (2 ** (-w), "2^(-w)"),
        ((w**2) ** 3, "(w^2)^3"),
        (sqrt(w + 1), "sqrt(w + 1)"),
        (exp(w) * log(w), "exp(w)*log(w)"),
        (Max(w, a), "max(w, w_1)"),
        (Function("F")(w), "F(w)"),
        (a + b * c, "w_1 + w_2*w_3"),
        (And(Le(0, w), Le(w, 1)), "0 <= w <= 1"),
        (Sum(IndexedBase("w")[k], (k, 1, 5)), "sum(w_k, k = 1..5)"),
        (Median(IndexedBase("w")[k], (k, 1, 5)), "median(w_k, k = 1..5)"),
        (Least(IndexedBase("w")[k], (k, 1, 5)), "min(w_k, k = 1..5)"),
        (Integral(w**2, (w, 0, 1)), "int(w^2, w = 0..1)"),
    ]


@pytest.mark.parametrize(("expression", "written"), WRITTEN, ids=[written for _, written in WRITTEN])
def test_text(expression: Expr, written: str) -> None:
    assert text(expression, VOCABULARY) == written


@pytest.mark.parametrize(
    ("expression", "written"), WRITTEN[:18], ids=[written for _, written in WRITTEN[:18]]
)
def test_text_can_be_calculated_with(expression: Expr, written: str) -> None:
    """A calculator that reads from left to right gets the expression's value."""
    read = eval(written.replace("^", "**"), {"w": 1.7, "sqrt": lambda x: x**0.5})
    assert read == pytest.approx(float(expression.subs(w, 1.7)))


@pytest.mark.parametrize(
    ("cell", "written"),
    [
        (model.V[2], "v'_2"),
        (model.CP[1], "C'_1"),
        (model.Cprime, "C'"),
        (model.XM[2], "x_m2"),
        (model.XM[k], "x_m,k"),
        (model.E[k], "e_k"),
        (VOCABULARY["x_top"][k], "x_top,k"),
        (VOCABULARY["v_n1"].symbol, "v'.n"),
        (model.m_red, "m_red"),
    ],
)
def test_names(cell: Expr, written: str) -> None:
    assert text(cell, VOCABULARY) == written


@pytest.mark.parametrize(
    ("label", "written"),
    [
        ("(1)", "e = -v''.n/v'.n"),
        ("(3)", "F(x) = C*x^alpha for 0 <= x <= x_m; C'*((x - x_p)/(x_m - x_p))^beta for x_p <= x <= x_m"),
        ("(6)", "-1/2*m_red*v'^2 = -int(F(x), x = 0..x_m) = -C*x_m^(alpha + 1)/(alpha + 1)"),
        ("(10a)", "C*x_m,k^(alpha + 1)/(alpha + 1) = 1/2*m_red*v'_k^2"),
        (
            "(11)",
            "(alpha + 1)/(beta + 1) + x_p1/x_p2*(e_2^2 - (alpha + 1)/(beta + 1))*(v'_2/v'_1)^(2/(alpha + 1)) "
            "- e_1^2 = 0",
        ),
        ("(12a)", "x_m2 = x_p2/(1 - (beta + 1)/(alpha + 1)*e_2^2)"),
        ("(12c)", "C = m_red*v'_2^2/2*(alpha + 1)/x_m2^(alpha + 1)"),
        ("(L12)", "alpha_mean = sum(alpha_p, p = 1..n_pairs)/n_pairs"),
    ],
)
def test_equations_read_as_they_are_printed(label: str, written: str) -> None:
    assert text_of_equation(LEDGER[label], VOCABULARY) == written


def test_nothing_of_the_library_shows() -> None:
    for equation in LEDGER.equations():
        written = text_of_equation(equation, VOCABULARY)
        assert not any(word in written for word in ("**", "[", "Cprime", "Piecewise", "Integral", "Sum(")), (
            written
        )


def test_products_and_sums_are_read_flat() -> None:
    nested = Mul(
        w, Mul(a, Add(b, Add(c, -w, evaluate=False), evaluate=False), evaluate=False), evaluate=False
    )
    assert text(nested, VOCABULARY) == "w*w_1*(w_2 + w_3 - w)"
