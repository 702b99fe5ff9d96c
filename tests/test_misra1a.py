"""Misra1a of NIST's Statistical Reference Datasets: least squares whose rate is a scalar root over all rows.

Source: NIST StRD, Nonlinear Regression, Misra1a (D. Misra, 1978), certified values to eleven digits.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from helpers import method_folder

from loopsheet.report import stages
from loopsheet.report.cli import main
from loopsheet.report.referee.campaign import Campaign
from loopsheet.report.referee.problem import Problem
from loopsheet.report.result.verdict import NOT_FOUND, UNREACHABLE
from loopsheet.report.study import Study

SOURCE = """\
from sympy import Integer, Rational, Sum, Symbol, exp
from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Axis, Column, Formula, Given, Root, Sheet
from loopsheet.report.workbook import Measured, TableSpec, Workbook

k, n = (Symbol(s, integer=True, positive=True) for s in ("k", "n"))
rows = Axis("rows", k, n)
x, y = (Column(name, rows, Given("measured"), "1", name) for name in ("x", "y"))
b1, b2 = (Column(name, None, Given()).symbol for name in ("b1", "b2"))
rise, slope = 1 - exp(-b2 * x[k]), x[k] * exp(-b2 * x[k])

def total(term):
    return Sum(term, (k, 1, n))

best = Equation(
    "(2)", (total(y[k] * slope) * total(rise**2) - total(y[k] * rise) * total(rise * slope), Integer(0)),
    "least squares, with the best b1 put in", Kind.ASSUMPTION, "best b2",
)
scale = Equation("(3)", (b1, total(y[k] * rise) / total(rise**2)), "least squares", Kind.DEFINITION, "b1")
left = Equation(
    "(4)", (Symbol("S"), total((y[k] - b1 * rise) ** 2)), "what is left", Kind.DEFINITION, "sum of squares"
)
root = Root(best, best, b2, b2, Rational(1, 10000), Rational(1, 100), Rational(1, 1000), steps=12)
WORKBOOK = Workbook(
    name="misra1a",
    title="Misra1a",
    source="NIST StRD",
    ledger=lambda: Ledger((best, scale, left)),
    measured=(Measured("x", "1", "pressure"), Measured("y", "1", "volume")),
    parameters=(),
    sheet=lambda given: Sheet((
        x, y, Column("b2", None, root, "1", "rate"), Column("b1", None, Formula(scale), "1", "amplitude"),
        Column("S", None, Formula(left), "1", "residual sum of squares"),
    )),
    headline=("b1", "b2", "S"),
)
"""
DATA = (
    (77.6, 10.07), (114.9, 14.73), (141.1, 17.94), (190.8, 23.93), (239.9, 29.61), (289.0, 35.18),
    (332.8, 40.02), (378.4, 44.82), (434.8, 50.76), (477.3, 55.05), (536.8, 61.01), (593.1, 66.40),
    (689.1, 75.47), (760.0, 81.78),
)  # fmt: skip
CERTIFIED = {"b1": 2.3894212918e02, "b2": 5.5015643181e-04, "S": 1.2455138894e-01}
PUBLISHED = "source,cell,index,value,unit\nNIST,b1,,238.94212918,1\nNIST,b2,,5.5015643181e-4,1\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    rows = "".join(f"{number},{x:.1f},{y:.2f}\n" for number, (x, y) in enumerate(DATA, start=1))
    return method_folder(tmp_path, SOURCE, f"test,x [1],y [1]\n{rows}", published=PUBLISHED)


def test_the_certified_values_come_out(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report = Study(folder).proved
    for name, certified in CERTIFIED.items():
        assert report.values.scalar(name) == pytest.approx(certified, rel=5e-11)
    assert [comparison.verdict for comparison in report.comparisons] == ["same", "same"]
    assert main(["check", str(folder)]) == 0, capsys.readouterr().out


def test_the_referee_ends_and_names_the_x_that_was_changed(folder: Path) -> None:
    """Every input is free within its last digit, and moves the root, which no step of a search counts."""
    data = folder / "measurements.csv"
    data.write_text(data.read_text().replace("760.0", "790.0"))
    (folder / "published.csv").write_text(PUBLISHED.replace("8.94212918", "8.9").replace("15643181", "02"))
    report = stages.refereed(Study(folder).computed)
    assert [comparison.verdict for comparison in report.comparisons] == ["differs", "differs"]
    assert all(c.refereed and c.refereed.verdict in (UNREACHABLE, NOT_FOUND) for c in report.comparisons)
    changed = {(change.cell, change.index) for each in report.referee.explanations for change in each.changes}
    assert ("x", (14,)) in changed


FOLD = """\
from sympy import Integer, Symbol
from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Axis, Column, Given, Root, Sheet
from loopsheet.report.workbook import Measured, Workbook

k, n, u = Symbol("k", integer=True, positive=True), Symbol("n", integer=True, positive=True), Symbol("u")
rows = Axis("rows", k, n)
x = Column("x", rows, Given("measured"), "1", "x")
fold = Equation("(1)", ((u - 1) * (u - 2) * (u - 3), x[k]), "a fold", Kind.ASSUMPTION, "")
root = Root(fold, fold, u, u, Integer(0), Integer(10), Integer(4), steps=12)
WORKBOOK = Workbook(
    name="fold", title="Fold", source="", ledger=lambda: Ledger((fold,)), measured=(Measured("x", "1", "x"),),
    parameters=(), sheet=lambda given: Sheet((x, Column("u", rows, root, "1", "u"))), headline=(),
)
"""


def test_a_search_that_counts_no_roots_claims_nothing(tmp_path: Path) -> None:
    """(u - 1)(u - 2)(u - 3) = x has one root at .4, and three wherever the largest prints as published."""
    published = "source,cell,index,value,unit\nA,u,1,3.150,1\n"
    folder = method_folder(tmp_path, FOLD, "test,x [1]\n1,0.4\n2,0.4\n", published=published)
    report = stages.refereed(Study(folder).computed)
    problem = Problem.of(
        Campaign(report.sheet, report.inputs, report.values, report.values.value), report.inputs.published
    )
    guessed = problem.guessing.mismatch(problem.guessing.evaluate(np.array([[0.371, 0.4]])))
    assert abs(guessed[0, 0]) < 1, "the search sees a root that prints as published"
    assert np.isnan(problem.evaluate(np.array([[0.371, 0.4]]))).all(), "one of three"
    (verdict,), (table,) = report.referee.values, report.referee.tables
    assert verdict.verdict in (UNREACHABLE, NOT_FOUND)
    assert table.verdict in (UNREACHABLE, NOT_FOUND)
    assert verdict.low is not None
    assert verdict.low > 3.1547, "the least that is told has one root, too"
