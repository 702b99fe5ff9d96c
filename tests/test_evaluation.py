"""What has a value at 50 digits: every function of the table, sums over several indices, cells of columns."""

import mpmath
import pytest
import sympy
from sympy import Expr, Rational, Sum, Symbol

from loopsheet.derivations.evaluation import UNDEFINED, NotEvaluable, Tape, is_real

x, y = Symbol("x", positive=True), Symbol("y", positive=True)
AT = {x: Rational(37, 100), y: Rational(81, 100)}
ONE = (
    "exp log sin cos tan cot sec csc asin acos atan sinh cosh tanh coth sech csch asinh atanh gamma loggamma "
    "factorial erf erfc erfi erfinv zeta floor ceiling LambertW elliptic_k elliptic_e Abs sign"
)
TWO = "beta binomial atan2 besselj bessely besseli besselk zeta Max Min"
EXPRESSIONS = [
    *(getattr(sympy, name)(x) for name in ONE.split()),
    *(getattr(sympy, name)(x, y) for name in TWO.split()),
    sympy.acosh(1 + x),
    sympy.acoth(1 + x),
    sympy.polygamma(0, x),
    sympy.polygamma(2, x),
    sympy.sqrt(x) ** y,
    sympy.Piecewise((x, x > y), (y, True)),
]


def value(expression: Expr) -> mpmath.mpf:
    with mpmath.workdps(50):
        program = Tape([x, y])
        group = program.add([expression])
        program.start([mpmath.mpf(n.p) / n.q for n in AT.values()])
        return program.values(group)[0]


@pytest.mark.parametrize("expression", EXPRESSIONS, ids=str)
def test_a_function_has_the_value_that_the_library_gives_it(expression: Expr) -> None:
    """The library evaluates by another way: its own evalf of the rational arguments."""
    found = value(expression)
    assert is_real(found)
    with mpmath.workdps(50):
        expected = mpmath.mpmathify(sympy.N(expression.subs(AT), 50))
        assert abs(found - expected) <= mpmath.mpf(10) ** -46 * max(1, abs(expected))


X = sympy.IndexedBase(Symbol("X", positive=True))
q, r, n = (Symbol(name, integer=True, positive=True) for name in "qrn")
ROWS = [None, 2, 3, 5, 7]


def of_rows(expression: Expr, size: int = 4) -> mpmath.mpf:
    program = Tape([n, X.label])
    group = program.add([expression])
    program.start([mpmath.mpf(size), ROWS])
    return program.values(group)[0]


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (Sum(X[q], (q, 1, n)), 17),
        (Sum(X[q], (q, 2, n)) + X[1], 17),
        (Sum(X[q], (q, 2, n - 3)), 0),
        (Sum(X[q] * X[r], (q, 1, n), (r, 1, n)), 17**2),
        (Sum(X[q], (q, 1, r), (r, 1, n)), 2 + 5 + 10 + 17),
        (Sum(X[r] * Sum(X[q], (q, 1, r)), (r, 1, n)), 2 * 2 + 3 * 5 + 5 * 10 + 7 * 17),
        (Sum(X[q] * Sum(X[q], (q, 1, 2)), (q, 1, n)), 5 * 17),  # what runs inside hides what runs outside
        (X[n] - X[n - 1], 2),
    ],
    ids=str,
)
def test_sums_run_over_the_rows_of_a_column(expression: Expr, expected: int) -> None:
    assert of_rows(expression) == expected


@pytest.mark.parametrize(
    "expression", [X[n - 4], X[n - 5], X[n / 3], X[5], Sum(X[q], (q, 1, n / 3))], ids=str
)
def test_a_row_that_is_not_there_has_no_value(expression: Expr) -> None:
    with pytest.raises(UNDEFINED):
        of_rows(expression)


@pytest.mark.parametrize("beside", ["0.1", "1e-3", "1e-5", "1e-7", "0"])
@pytest.mark.parametrize("power", ["0.03", "1.58", "2.5"])
def test_an_integral_beside_a_branch_point_is_resolved(beside: str, power: str) -> None:
    """Its error was a hundred thousand times what a proof allows, and true claims were refuted."""
    with mpmath.workdps(50):
        program = Tape([x, y])
        group = program.add(
            [sympy.Integral((q + x) ** y, (q, 0, 1)), ((1 + x) ** (y + 1) - x ** (y + 1)) / (y + 1)]
        )
        program.start([mpmath.mpf(beside), mpmath.mpf(power)])
        found, expected = program.values(group)
        assert abs(found - expected) <= mpmath.mpf(10) ** -43 * expected


def test_what_has_no_value_says_its_name() -> None:
    with pytest.raises(NotEvaluable, match="f has no value"):
        value(sympy.Function("f")(x))
    with pytest.raises(NotEvaluable, match="uppergamma has no value"):
        value(sympy.uppergamma(x, y))
    assert not is_real(value(sympy.acosh(x)))
    with pytest.raises(UNDEFINED):
        value(sympy.gamma(Symbol("x", positive=True) * 0 - 1 + sympy.floor(x)))
