"""Sums of exponentials of an unknown are enclosed by what their terms are at both ends of a part."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import mpmath
import numpy as np
import pytest
from sympy import Expr, Rational, S, Sum, Symbol, exp

from loopsheet.derivations.equation import Equation
from loopsheet.report.cells.values import Status
from loopsheet.report.engines import exact
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines import numpy_enclosed as enclosed
from loopsheet.report.engines.intervals import Intervals
from loopsheet.report.engines.numpy import Program
from loopsheet.report.engines.numpy_enclosed import EnclosedRows
from loopsheet.report.sheet import Axis, Column, Given, Root, Sheet

w = Symbol("w", real=True)
k, size = (Symbol(name, integer=True, positive=True) for name in ("k", "n_rows"))
rows = Axis("rows", k, size)
c, g = (Column(name, rows, Given(), positive=False) for name in "cg")


def sheet(terms: Expr, more: Expr = S.Zero) -> Sheet:
    """A root of a sum over the rows."""
    equation = Equation("(1)", (Sum(terms, (k, 1, size)) + more, 0 * w), "")
    rule = Root(equation, equation, w, w, Rational(-3), Rational(4), Rational(1, 2), steps=8)
    return Sheet((c, g, Column("r", None, rule, positive=False)))


SUMS = sheet(c[k] * exp(w * g[k]))
PROGRAM = Program.of(SUMS)


def evaluated(coefficients: Any, rates: Any, program: Program = PROGRAM) -> Any:
    labels = {"rows": range(1, len(coefficients) + 1)}
    return engine.evaluate(SUMS, labels, {"c": coefficients, "g": rates}, program)


def by_intervals(program: Program) -> Program:
    """The same with every operation in intervals."""
    root = program.roots["r"]
    assert root.enclosing is not None
    return replace(program, roots={"r": replace(root, enclosing=replace(root.enclosing, reach=None))})


@pytest.mark.parametrize(
    ("terms", "more"),
    [
        (c[k] * exp(w * g[k]), w),  # the unknown stands beside the sum
        (c[k] * exp(w * g[k]), Sum(c[k] * w, (k, 1, size))),
        (w * c[k] * exp(w * g[k]), S.Zero),
        (c[k] * exp(w**2 * g[k]), S.Zero),
        (c[k] * exp(exp(w * g[k])), S.Zero),
        ((c[k] - g[k] ** 2) ** 2 * exp(w * g[k]), S.Zero),  # a difference may lose its digits
        (c[k] ** 4 * exp(w * g[k]), S.Zero),  # its slope has five factors
        (c[k] / g[k] * exp(w * g[k]), S.Zero),
    ],
)
def test_any_other_form_is_put_into_intervals(terms: Expr, more: Expr) -> None:
    enclosing = Program.of(sheet(terms, more)).roots["r"].enclosing
    assert enclosing is not None
    assert enclosing.reach is None


def rows_of(coefficients: Any, rates: Any) -> EnclosedRows:
    kernel = PROGRAM.roots["r"].enclosing
    assert kernel is not None
    assert kernel.reach is not None
    cells = {name: Intervals.of(np.array(own)) for name, own in (("c", coefficients), ("g", rates))}
    return EnclosedRows(kernel, cells, {"c", "g"}, {"rows": np.ones(len(rates), dtype=bool)}, (1,))


@pytest.mark.parametrize(
    ("coefficients", "rates", "tame"),
    [
        ([1.0, -3.0], [1.0, 0.0], True),
        ([2.0**61, -3.0], [1.0, 0.0], False),
        ([2.0**-61, -3.0], [1.0, 0.0], False),
        ([1.0, np.nan], [1.0, 0.0], False),
        ([1.0, -3.0], [100.0, 0.0], True),
        ([1.0, -3.0], [-100.01, 0.0], False),  # times 4, the upper end
    ],
)
def test_terms_that_may_leave_the_doubles_are_put_into_intervals(
    coefficients: list[float], rates: list[float], tame: bool
) -> None:
    assert rows_of(coefficients, rates)._tame(np.array([-3.0]), np.array([4.0])) == tame


def test_the_enclosures_hold_what_50_digits_find_and_are_as_narrow_as_intervals() -> None:
    rng = np.random.default_rng(4)
    for _ in range(20):
        coefficients, rates = rng.normal(0, 1, 12), rng.normal(0, 3, 12)
        natural = rows_of(coefficients, rates)
        low = rng.uniform(-3, 4, 9)
        high = low + np.array([0.0, 0, 0, 1e-9, 1e-3, 0.1, 0.1, 0.5, 2])
        asked = np.zeros(9, dtype=np.intp)
        assert natural._tame(low, high)
        own, theirs = (each._run(asked, low, high) for each in (replace(natural, by_points=True), natural))
        share = rng.uniform(0, 1, 9)
        share[::2] = np.rint(share[::2])
        inside = np.clip(low + share * (high - low), low, high)
        for n, at in enumerate(inside.tolist()):
            with mpmath.workdps(50):
                pairs = list(zip(coefficients, rates, strict=True))
                terms = [mpmath.mpf(a) * mpmath.exp(mpmath.mpf(b) * at) for a, b in pairs]
                slopes = [term * b for term, b in zip(terms, rates, strict=True)]
                for part, true in zip(own, (mpmath.fsum(terms), mpmath.fsum(slopes)), strict=False):
                    assert mpmath.mpf(float(part.low[n])) <= true <= mpmath.mpf(float(part.high[n]))
        sizes = np.abs(coefficients * (1 + np.abs(rates)))
        scale = np.exp(np.outer(low, rates)) @ sizes + np.exp(np.outer(high, rates)) @ sizes
        for part, wide in zip(own[:2], theirs[:2], strict=True):
            assert ((part.high - part.low) <= (wide.high - wide.low) + 2.0**-28 * scale).all()


EXPONENTIALS = {
    "two": ((1, -5, 6), (2, 1, 0), Status.TWOROOTS),
    "one": ((1, -1, -6), (2, 1, 0), Status.OK),
    "none": ((1, -4, 5), (2, 1, 0), Status.NOROOT),
    "touches": ((1, -4, 4), (2, 1, 0), Status.UNDECIDED),
    "a term is nothing": ((1, -3, 0), (1, 0, 2), Status.OK),
    "cells too large": ((2.0**70, -3 * 2.0**70), (1, 0), Status.OK),
    "cells too small": ((2.0**-70, -3 * 2.0**-70), (1, 0), Status.OK),
    "exponents too large": ((1, -3, 1e-300), (1, 0, -150), Status.OK),
    "no row": ((), (), Status.DOMAIN),
    "a row without a value": ((1, -3, np.nan), (1, 0, 2), Status.INPUT),
}


@pytest.mark.parametrize("case", EXPONENTIALS)
def test_roots_are_counted_as_intervals_and_the_judge_count_them(case: str) -> None:
    coefficients, rates, status = EXPONENTIALS[case]
    own, natural = (evaluated(coefficients, rates, each) for each in (PROGRAM, by_intervals(PROGRAM)))
    assert own.status["r"].tolist() == natural.status["r"].tolist()
    judged = exact.evaluate(
        SUMS, {"rows": range(1, len(rates) + 1)}, {"c": list(coefficients), "g": list(rates)}
    )
    assert own.status["r"].tolist() == judged.status["r"]
    if status == Status.OK:
        assert own.value["r"][0] == pytest.approx(np.log(3), rel=1e-14)
    if status == Status.TWOROOTS:
        assert own.roots["r"][0] == pytest.approx(np.log([2, 3]), rel=1e-12)


def test_random_sums_have_the_same_roots_in_batches_and_by_intervals(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(6)
    coefficients, rates = rng.normal(0, 1, (60, 6)), rng.normal(0, 2, (60, 6))
    batch = evaluated_batch(coefficients, rates)
    counts = {status: int((batch.status["r"] == status).sum()) for status in Status}
    assert min(counts[status] for status in (Status.OK, Status.NOROOT, Status.TWOROOTS)) >= 3
    for n in range(60):
        one = evaluated(coefficients[n], rates[n])
        natural = evaluated(coefficients[n], rates[n], by_intervals(PROGRAM))
        assert batch.status["r"][n] == one.status["r"] == natural.status["r"]
        np.testing.assert_array_equal(batch.value["r"][n], one.value["r"])
    monkeypatch.setattr(enclosed, "PARTS", 3)
    np.testing.assert_array_equal(evaluated_batch(coefficients, rates).status["r"], batch.status["r"])


def evaluated_batch(coefficients: Any, rates: Any) -> Any:
    return engine.evaluate(SUMS, {"rows": range(1, 7)}, {"c": coefficients, "g": rates}, PROGRAM)
