"""The plan of a sheet: what it lowers to, how it reads, and that an engine prints each shared part once."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from helpers import whole
from sympy import Eq, Expr, Integer, Piecewise, Rational, Sum, Symbol, exp, log, simplify, true
from sympy.core.symbol import Str

from loopsheet.derivations.equation import Equation
from loopsheet.derivations.reductions import Median
from loopsheet.report.cli import main
from loopsheet.report.engines.numpy import Program, evaluate
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.plan.derivatives import derivatives, rounding
from loopsheet.report.plan.domain import defined
from loopsheet.report.plan.lowering import lowered
from loopsheet.report.plan.nodes import Leaf, Map, Part, RowOrder, RowSum, Total
from loopsheet.report.plan.text import text
from loopsheet.report.quantity import Bounds
from loopsheet.report.sheet import Axis, Column, Formula, Given, PairAxis, Root, Sheet

k, n, i, j, p, n_pairs = map(whole, ("k", "n", "i", "j", "p", "n_pairs"))
ROWS = Axis("rows", k, n)
PAIRS = PairAxis("pairs", p, n_pairs, of=ROWS, first=i, second=j)
u = Symbol("u", positive=True)


def formula(name: str, value: Expr, axis: Axis | None = None, **more: Any) -> Column:
    return Column(name, axis, Formula(Equation("(1)", (Symbol(name), value), "")), **more)


a = Column("a", ROWS, Given(bounds=Bounds(low=0, low_open=True)))
gap = formula("gap", a[j] - a[i], PAIRS, positive=False)
mean = formula("mean", 2 * Sum(gap[p] / 3, (p, 1, n_pairs)) / n_pairs, positive=False)
middle = formula("middle", Median(a[k], (k, 1, n)), requires=((mean.symbol > 0, "the mean is positive"),))
form = Equation("(2)", (Sum(a[k] * exp(u * a[k]), (k, 1, n)) - Sum(a[k], (k, 1, n)) * 2, Integer(0)), "")
rate = Column("rate", None, Root(form, form, u, 1 / u, Rational(1, 9), Integer(9), Integer(1)))
SHEET = Sheet((a, gap, mean, middle, rate))

TEXT = """\
a on rows: given
    allowed: a > 0
gap on pairs = -a_i + a_j
mean_sum_1: sum over pairs of gap
mean = 2*mean_sum_1/(3*n_pairs_of_mean)
middle_median_1: median over rows of a
middle = middle_median_1
    requires: mean > 0
rate_sum_1: sum over rows of a
rate = 1/u for the only root u of
    0 = -2*rate_sum_1 + sum(a*exp(a*u), rows)
    between: 1/9 and 9
    start: 1, 4 steps

a_i = a[i] on pairs
a_j = a[j] on pairs
n_pairs_of_mean = number of pairs that the sums of mean keep
"""


def test_a_plan_can_be_read() -> None:
    assert text(lowered(SHEET)) == TEXT


def test_a_part_of_a_plan_tells_its_own_symbols() -> None:
    assert (
        text(lowered(SHEET), ["gap"])
        == "gap on pairs = -a_i + a_j\n\na_i = a[i] on pairs\na_j = a[j] on pairs\n"
    )
    assert text(lowered(SHEET), ["a"]) == "a on rows: given\n    allowed: a > 0\n"
    assert text(lowered(Sheet((Column("free", None, Given()),)))) == "free: given\n"


def test_the_values_of_a_column_ask_for_no_condition() -> None:
    plan, median = lowered(SHEET), "middle_median_1"
    told = f"a on rows: given\n{median}: median over rows of a\nmiddle = {median}\n"
    assert text(plan.alone("middle")) == told
    assert [node.column.name for node in plan.alone("mean").nodes] == ["a", "gap", "mean", "mean"]
    assert [node.column.name for node in plan.alone("rate").nodes] == ["a", "rate", "rate"]


def test_every_node_finds_what_it_names() -> None:
    plan, known = lowered(SHEET), set[str]()
    for node in plan.nodes:
        named = [] if not isinstance(node, (Map, Total)) else (
            node.terms if isinstance(node, Total) else node.value
        ).free_symbols  # fmt: skip
        leaves = {s: plan.leaves[s] for s in named}
        assert {leaf.name for leaf in leaves.values() if leaf.kind == "cells"} <= known
        assert {s.name for s, leaf in leaves.items() if leaf.kind == "total"} <= known
        known.add(str(node.symbol) if isinstance(node, Total) else node.column.name)


def test_a_number_before_a_sum_is_no_other_sum() -> None:
    twice = formula("twice", 2 * Sum(a[k], (k, 1, n)) + Sum(3 * a[k], (k, 1, n)))
    totals = [node for node in lowered(Sheet((a, twice))).nodes if isinstance(node, Total)]
    assert [str(total.terms) for total in totals] == ["a"]
    assert str(totals[0].written) == "Sum(a[k], (k, 1, n))"


def test_a_sum_of_nothing_is_nothing() -> None:
    assert RowSum(Integer(0), Symbol("rows")) == 0


X, Y = Symbol("X", positive=True), Symbol("Y", positive=True)


@pytest.mark.parametrize(
    ("expression", "found"),
    [
        (X, 0),
        (-X, 0),
        (-X * Y, X * Y),
        (X + Y, X + Y),
        (X / Y, X / Y),
        (X / (X + Y), X / (X + Y) + X / (X + Y) ** 2 * (X + Y)),
        (exp(X * Y), exp(X * Y) * (1 + X * Y)),
        (log(X * Y), abs(log(X * Y)) + 1),
        ((X + Y) ** 3, (X + Y) ** 3 * (1 + 3)),
    ],
)
def test_what_rounding_does_is_its_own_and_that_of_what_it_is_made_of(expression: Expr, found: Expr) -> None:
    assert simplify(rounding(expression) - found) == 0


def test_a_name_that_is_taken_is_not_given_twice() -> None:
    taken = Column("a_i", None, Given())
    plan = lowered(Sheet((a, taken, formula("gap", a[j] - a[i] * taken.symbol, PAIRS))))
    names = [symbol.name for symbol in plan.leaves]
    assert len(set(names)) == len(names)
    assert plan.named["a_i"] == Leaf("cells", "a_i")
    assert plan.named["a_i_of_pairs"] == Leaf("cells", "a", PAIRS, "i")


def test_what_columns_share_is_computed_once_and_costs_no_bit() -> None:
    """Whatever else a sheet has, a column has the same bits."""
    one = formula("one", log(1 + a[k] ** 2) * a[k] / 3, ROWS)
    other = formula("other", exp(-log(1 + a[k] ** 2)) * (1 + a[k] ** 2) ** 3, ROWS)
    source = Program.of(Sheet((a, one, other))).source
    assert source.count("numpy.log(") == 1
    assert source.count("(a*a)") == 1
    data = {"a": np.linspace(0.1, 7, 50)}
    both = evaluate(Sheet((a, one, other)), {"rows": range(50)}, data)
    for column in (one, other):
        alone = evaluate(Sheet((a, column)), {"rows": range(50)}, data)
        np.testing.assert_array_equal(alone.value[column.name], both.value[column.name])


def test_the_derivatives_are_a_plan_that_can_be_read() -> None:
    made = derivatives(Sheet((a, gap, mean)))
    lines = text(made.plan).splitlines()
    assert "gap_slope_0 on pairs = -1" in lines
    assert "mean_slope_0 = 2/(3*n_pairs_of_mean)" in lines
    assert "mean_sum_1_slope_0 on pairs = 1" in lines


def test_so_is_what_rounding_does() -> None:
    """Of a sum its terms and their own; of a root its equation's, by what it does to the unknown."""
    lines = text(derivatives(SHEET).plan).splitlines()
    assert "gap_rounding on pairs = a_i + a_j" in lines
    assert "mean_rounding = 4*Abs(mean_sum_1)/(3*n_pairs_of_mean)" in lines
    assert "middle_rounding = 0" in lines
    # Of a exp(u a): the exponent's product, the function, the product and the sum.
    assert "rate_more_2: sum over rows of a*(a*exp(a/rate)/rate + exp(a/rate)) + 2*a*exp(a/rate)" in lines
    assert "rate_more_3: sum over rows of a**2*exp(a/rate)" in lines
    form = "rate**2*(Abs(rate_sum_0) + 4*Abs(rate_sum_1))/Abs(rate_more_3)"
    assert f"rate_rounding = {form} + 2*rate" in lines


def test_a_sum_is_defined_where_no_row_lies_outside() -> None:
    x, rows = Symbol("x", real=True), Symbol("rows")
    outside = Piecewise((0, x > 0), (1, True))
    for reduced in (RowSum, lambda *of: RowOrder(*of, Str("max"))):
        assert defined(reduced(log(x), rows)) == Eq(RowSum(outside, rows), 0)
        assert defined(reduced(exp(x), rows)) is true
    assert defined(Sum(log(k - 2), (k, 1, n))) == Eq(Sum(Piecewise((0, k - 2 > 0), (1, True)), (k, 1, n)), 0)


def test_of_a_root_they_follow_from_its_equation() -> None:
    """0 = S(u) - 2 T with S = sum a exp(u a): du/dT = 2 / S', and the cell is 1/u."""
    made = derivatives(SHEET)
    (node,) = (each for each in made.nodes if each.name == "rate")
    values = evaluate(SHEET, {"rows": [1, 2, 3]}, {"a": [0.5, 1.0, 1.5]})
    own = {s.by: s.value for s in node.slopes}
    assert set(own) == {"rate_sum_0", "rate_sum_1"}
    parts = {part.symbol.name: part.value for part in made.plan.nodes if isinstance(part, Part)}
    here = 1 / values.scalar("rate")
    steep = float(sum(x**2 * np.exp(here * x) for x in (0.5, 1.0, 1.5)))
    (more,) = (s for s in parts[own["rate_sum_1"]].free_symbols if s.name != "rate")
    found = parts[own["rate_sum_1"]].subs({more: steep, Symbol("rate", positive=True): 1 / here})
    assert float(found) == pytest.approx(-(here**-2) * 2 / steep)


def test_sums_are_linear_and_differentiate_term_by_term() -> None:
    x, y = Symbol("x", positive=True), Symbol("y", positive=True)
    rows = Symbol("rows")
    assert RowSum(2 * x * y, rows) == 2 * RowSum(x * y, rows)
    assert RowSum(x * y**2, rows).diff(y) == 2 * RowSum(x * y, rows)
    assert RowSum(x, rows).is_positive
    assert RowSum(Symbol("z"), rows).is_positive is None


def test_the_command_line_shows_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["show", "alpha_mean", "paper", "--plan"]) == 0
    told = capsys.readouterr().out
    assert (
        "alpha_mean_sum_1: sum over pairs of alpha\nalpha_mean = alpha_mean_sum_1/n_pairs_of_alpha_mean\n"
        in told
    )
    assert main(["show", "all", "paper", "--plan"]) == 0
    assert "x_m2 on pairs = x_p_j/(" in capsys.readouterr().out


def test_conditions_are_written_as_people_do(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["show", "line_s", str(PAPER.parent / "gum_h3"), "--plan"]) == 0
    condition = "1/(n_of_line_s - 2) >= 0 and sum(line_residual**2, readings) >= 0 and n_of_line_s - 2 != 0"
    assert f"    defined: {condition}\n" in capsys.readouterr().out


def test_a_condition_that_doubles_would_lose_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    """2 s_1/s_3 at s_3 = 0, of which the greatest of several may be another."""
    assert main(["show", "alpha_0", "paper", "--plan"]) == 0
    assert "    finite only if: alpha_0_sum_3 != 0\n" in capsys.readouterr().out
