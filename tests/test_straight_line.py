"""The weighted straight line: proved, refuted where it is written wrongly, and what the solver finds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sympy import Expr, Integer, Sum, lambdify, symbols

from loopsheet.derivations import straight_line as line
from loopsheet.derivations.equation import Step
from loopsheet.derivations.proof import check_step, prove
from loopsheet.derivations.proved import ProofStatus
from loopsheet.derivations.straight_line import LEDGER, k, n, w, x, x_mean, y, y_mean
from loopsheet.report.fitting.model import Model


def test_slope_and_intercept_follow_from_the_normal_equations() -> None:
    found = {proof.equation.label: proof.status for proof in prove(LEDGER)}
    assert found == {
        "(1)": ProofStatus.DEFINITION,
        "(2)": ProofStatus.DEFINITION,
        "(3)": ProofStatus.PROVED,
        "(4)": ProofStatus.PROVED,
    }


def total(term: Expr) -> Expr:
    return Sum(term, (k, 1, n))


@pytest.mark.parametrize(
    ("number", "wrong"),
    [
        ("(3)", total((x[k] - x_mean) * (y[k] - y_mean)) / total((x[k] - x_mean) ** 2)),
        ("(3)", total(w[k] * (x[k] - x_mean) * (y[k] - y_mean)) / total(w[k] * (y[k] - y_mean) ** 2)),
        ("(3)", total(w[k] * x[k] * y[k]) / total(w[k] * x[k] ** 2)),
        ("(4)", y_mean + line.b * x_mean),
        ("(4)", total(y[k]) / n - line.b * x_mean),
        ("(4)", y_mean - line.b * total(x[k]) / n),
    ],
)
def test_wrong_ones_are_refuted(number: str, wrong: Expr) -> None:
    derivation = LEDGER.derivation(LEDGER[number])
    assert derivation is not None
    (step,) = derivation.steps
    claim = replace(step.claim, members=(step.claim.members[0], wrong))
    assert check_step(replace(step, claim=claim)).status is ProofStatus.REFUTED


def test_the_sums_of_jcgm_100_are_the_same_without_weights() -> None:
    """(H.13a) and (H.13b), from the same normal equations with all weights 1."""
    derivation = LEDGER.derivation(LEDGER["(3)"])
    assert derivation is not None
    normal_a, normal_b = (
        replace(premise, members=tuple(member.xreplace({w[k]: Integer(1)}) for member in premise.members))
        for premise in derivation.steps[0].premises[2:]
    )
    sum_x, sum_y = total(x[k]), total(y[k])
    determinant = n * total(x[k] ** 2) - sum_x**2
    slope = (n * total(x[k] * y[k]) - sum_x * sum_y) / determinant
    intercept = (sum_y * total(x[k] ** 2) - total(x[k] * y[k]) * sum_x) / determinant
    for symbol, formula, premises, unknowns in (
        (line.b, slope, (normal_a, normal_b), (line.a, line.b)),
        (line.a, intercept, (normal_b, normal_a), (line.b, line.a)),
    ):
        for claimed, status in ((formula, ProofStatus.PROVED), (formula * (1 + sum_x), ProofStatus.REFUTED)):
            claim = replace(LEDGER["(3)"], members=(symbol, claimed), parent=None)
            assert check_step(Step(claim, premises, unknowns, "")).status is status


def test_the_solver_finds_what_is_proved() -> None:
    rng = np.random.default_rng(5)
    at, sizes = rng.uniform(2, 5, 12), rng.uniform(0.1, 1, 12)
    observed = 3 - 0.7 * at + rng.normal(0, sizes)
    columns = {x: [0, *at], y: [0, *observed], w: [0, *sizes**-2.0]}
    found = {n: 12}
    for number in ("(1)", "(2)", "(3)", "(4)"):
        symbol, formula = LEDGER[number].sides
        arguments = [*columns, *found]
        found[symbol] = lambdify(arguments, formula, "math")(*columns.values(), *found.values())
    p, q, u, v = symbols("p q u v")
    fit = Model(v - p - q * u, (p, q), (u, v)).fit({u: at, v: observed}, {v: sizes}, [0, 0])
    assert fit.parameters == pytest.approx([found[line.a], found[line.b]], rel=1e-13)
