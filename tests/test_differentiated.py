"""Derivatives of long expressions are those of sympy, to the last term."""

from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import (
    Abs,
    Expr,
    Function,
    Heaviside,
    Integral,
    Max,
    Piecewise,
    Rational,
    Symbol,
    beta,
    cos,
    diff,
    exp,
    log,
    sqrt,
    symbols,
)  # fmt: skip

from loopsheet.derivations.differentiated import differentiated
from loopsheet.report.engines.roots import derivatives
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.plan.lowering import lowered
from loopsheet.report.plan.nodes import Map, Plan, RootNode, RowSum
from loopsheet.report.study import Study

x, y = symbols("x y", positive=True)
z = Symbol("z", real=True)
SHIPPED = sorted(folder.name for folder in PAPER.parent.iterdir() if (folder / "report.toml").is_file())


def asked(plan: Plan) -> Iterator[tuple[Expr, Symbol]]:
    """What the derivatives of a plan are made of."""
    for node in plan.nodes:
        if isinstance(node, Map):
            yield from ((node.value, by) for by in node.value.free_symbols)
        elif isinstance(node, RootNode):
            *steps, _ = derivatives(node.form, node.unknown)
            yield from ((step, node.unknown) for step in steps)
            yield from ((node.form, by) for by in node.form.free_symbols)


@pytest.mark.parametrize("name", SHIPPED)
def test_of_every_shipped_sheet_they_are_those_of_sympy(name: str) -> None:
    plan = lowered(Study(PAPER.parent / name).prepared.sheet)
    found = [(differentiated(each, by), diff(each, by)) for each, by in asked(plan)]
    assert found
    assert all(ours == theirs for ours, theirs in found)


@pytest.mark.parametrize(
    "expression",
    [
        Integral(sqrt(y + x), (y, 0, x)),
        Integral(sqrt(x), (x, 0, y)),
        RowSum(x**2 * y, Symbol("tests")) * x,
        Function("f")(x * y) ** 2,
        Heaviside(x - 1) * x,
        Max(x, y) ** 2 + Abs(z * x),
        beta(x, Rational(1, 2)) * x,
        Piecewise((x**y, x > 1), (y**x, True)),
        x**x + exp(y) ** x,
    ],
    ids=str,
)
def test_what_has_a_rule_of_its_own_keeps_it(expression: Expr) -> None:
    assert [differentiated(expression, by) for by in (x, y, z)] == [diff(expression, by) for by in (x, y, z)]


leaves = st.sampled_from([x, y, z, Rational(3, 2), Rational(-2)])
expressions = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.builds(lambda *terms: sum(terms[1:], terms[0]), inner, inner, inner),
        st.builds(lambda a, b: a * b, inner, inner),
        st.builds(lambda a, n: a**n, inner, st.sampled_from([2, -1, Rational(1, 2), Rational(-5, 2)])),
        st.builds(lambda f, a: f(a), st.sampled_from([exp, log, cos, sqrt]), inner),
        st.builds(lambda a, b: Piecewise((a, x > y), (b, True)), inner, inner),
    ),
    max_leaves=8,
)


@settings(max_examples=60)
@given(expressions)
def test_of_any_expression_they_are_those_of_sympy(expression: Expr) -> None:
    assert all(differentiated(expression, by) == diff(expression, by) for by in (x, z))
