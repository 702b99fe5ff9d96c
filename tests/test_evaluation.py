"""What has a value at 50 digits: every function of the table, sums over several indices, cells of columns."""

import mpmath
import pytest
import sympy
from sympy import Expr, Rational, Symbol

from loopsheet.derivations.evaluation import UNDEFINED, NotEvaluable, Program, is_real

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
        program = Program([x, y])
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


def test_what_has_no_value_says_its_name() -> None:
    with pytest.raises(NotEvaluable, match="f has no value"):
        value(sympy.Function("f")(x))
    with pytest.raises(NotEvaluable, match="uppergamma has no value"):
        value(sympy.uppergamma(x, y))
    assert not is_real(value(sympy.acosh(x)))
    with pytest.raises(UNDEFINED):
        value(sympy.gamma(Symbol("x", positive=True) * 0 - 1 + sympy.floor(x)))
