"""Random sheets against other programs: GTC, uncertainties, and differences at 50 digits."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import GTC
import mpmath
import numpy as np
import pytest
import uncertainties
from random_sheets import ROWS, definition, k, n, printed, sheet_of
from sympy import Abs, Add, Expr, Indexed, Mul, Number, Pow, Sum, Symbol, exp, log
from uncertainties import umath

from loopsheet.derivations.equation import Ledger
from loopsheet.report.cells.values import Values
from loopsheet.report.distribution import Error, Shape
from loopsheet.report.engines import exact
from loopsheet.report.inputs.inputs import Inputs
from loopsheet.report.inputs.measurements import Measurements
from loopsheet.report.inputs.uncertainty import Stated
from loopsheet.report.quantity import Printed
from loopsheet.report.sheet import Column, Formula, Sheet
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.propagation import Spread
from loopsheet.report.workbook import Workbook

SHEETS, TESTS = 60, 3
SAME = 1e-10
PAPER = Path(__file__).parent.parent / "data" / "soft_steel"
Cells = list[tuple[str, int]]


@dataclass(frozen=True)
class Drawn:
    """A random sheet with a mean, its numbers with their errors, and what is made of them."""

    sheet: Sheet
    given: Mapping[str, tuple[Printed, ...]]
    r: Mapping[tuple[str, str], float]
    inputs: Inputs
    values: Values
    spread: Spread

    @property
    def cells(self) -> Cells:
        """The computed ones with a value and derivatives; the mean if it is one of all rows."""
        rows = [(name, row) for name in "yz" for row in range(TESTS)]
        found = self.spread.contributions(rows)
        cells = [cell for cell, own in zip(rows, found, strict=True) if np.isfinite(own).all()]
        return [*cells, ("mean", 0)] if {("z", row) for row in range(TESTS)} <= {*cells} else cells

    def sizes(self, cells: Cells) -> Any:
        """What uncertainties would be if nothing cancelled: to this scale a difference is small or large."""
        found = np.abs(self.spread.contributions(cells))
        return found.sum(axis=1)


def error(rng: random.Random, dof: float, sample: str) -> tuple[Error, ...]:
    shape = Shape.NORMAL if math.isinf(dof) else Shape.STUDENT
    return (Error(Fraction(rng.randrange(1, 200), 1000), shape, dof, sample=sample),)


def drawn(seed: int, correlated: bool, dof: bool, together: bool = False) -> Drawn:
    """All of a seed.

    Parameters
    ----------
    seed : int
    correlated : bool
        Whether a and b are in every row, and c and d.
    dof : bool
        Whether degrees of freedom are finite.
    together : bool
        Whether c and d were estimated together, from one sample.
    """
    rng = random.Random(seed)
    sheet = sheet_of(rng)
    mean = Column("mean", None, definition(Sum(sheet["z"][k], (k, 1, n)) / n), positive=False)
    sheet = Sheet((*sheet.columns, mean))
    one = float(rng.randrange(2, 30))

    def number(sample: str = "") -> Printed:
        freedom = math.inf if not dof else one if sample else float(rng.randrange(2, 30))
        return replace(printed(rng), stated=error(rng, freedom, sample))

    sample = "c, d" if together else ""
    given = {name: tuple(number() for _ in range(TESTS)) for name in "ab"}
    given |= {name: (number(sample),) for name in "cd"}
    r = {pair: rng.uniform(-0.9, 0.9) for pair in (("a", "b"), ("c", "d"))} if correlated else {}
    if together:
        r = {("c", "d"): rng.uniform(-0.9, 0.9)}
    measured, single = {name: given[name] for name in "ab"}, {name: given[name][0] for name in "cd"}
    workbook = Workbook("drawn", "", "", lambda: Ledger(()), (), (), lambda names: sheet)
    inputs = Inputs(
        Path(), "", workbook, single, frozenset(single),
        (Measurements(tuple(range(1, TESTS + 1)), measured, {}),), (), {},
        uncertainty=Stated({}, (), r),
    )  # fmt: skip
    data = {name: [p.value for p in column] for name, column in measured.items()}
    data |= {name: p.value for name, p in single.items()}
    values = exact.evaluate(sheet, {ROWS.name: inputs.only.tests}, data).rounded(sheet)
    return Drawn(sheet, given, r, inputs, values, Spread(inputs, values))


# --- the same sheet, by the numbers of another program -----------------------------------------------------

Functions = Mapping[type, Callable[[Any], Any]]


class Walk:
    """Formulas over numbers of any kind.

    Parameters
    ----------
    sheet : Sheet
    given : mapping of str to sequence
        Their numbers, a row each.
    functions : mapping of sympy function to function
        For powers of 1/2 that of `Pow`.
    """

    def __init__(self, sheet: Sheet, given: Mapping[str, Sequence[Any]], functions: Functions) -> None:
        self.sheet, self.functions = sheet, functions
        self.found: dict[tuple[str, int], Any] = {}
        for name, column in given.items():
            self.found |= {(name, row): number for row, number in enumerate(column)}

    def cell(self, name: str, row: int) -> Any:
        if (name, row) not in self.found:
            rule = self.sheet[name].rule
            assert isinstance(rule, Formula)
            self.found[name, row] = self.of(rule.expression, row)
        return self.found[name, row]

    def followed(self, cells: Cells) -> Cells:
        """Those that the other program computes: it gives up at the root of zero, though that be squared."""
        return [cell for cell in cells if self.can(*cell)]

    def can(self, name: str, row: int) -> bool:
        try:
            self.cell(name, row)
        except ZeroDivisionError:
            return False
        return True

    def of(self, node: Expr, row: int) -> Any:
        if isinstance(node, Number):
            return float(node)
        if node == n:
            return float(TESTS)
        if isinstance(node, Indexed):
            return self.cell(str(node.base), row)
        if isinstance(node, Symbol):
            return self.cell(node.name, 0)
        if isinstance(node, Sum):
            return sum(self.of(node.function, other) for other in range(TESTS))
        if isinstance(node, Pow):
            return self.power(self.of(node.base, row), node.exp)
        parts = [self.of(part, row) for part in node.args]
        if isinstance(node, Add):
            return sum(parts)
        if isinstance(node, Mul):
            return math.prod(parts)
        return self.functions[type(node)](*parts)

    def power(self, base: Any, exponent: Expr) -> Any:
        """By roots and products, for a power of a negative number is not known everywhere."""
        while not exponent.is_integer:
            base, exponent = self.functions[Pow](base), 2 * exponent
        whole = math.prod([base] * abs(int(exponent)))
        return 1 / whole if exponent < 0 else whole


def absolute(value: Callable[[Any], float]) -> Callable[[Any], Any]:
    """The absolute value, which with its uncertainty the other programs do not have, or not for long."""
    return lambda number: number if value(number) >= 0 else -number


def by_gtc(found: Drawn) -> Walk:
    def number(p: Printed, name: str) -> Any:
        (own,) = p.errors
        alone = not any(name in pair for pair in found.r)
        return GTC.ureal(float(p.value), own.u, own.dof, independent=alone)

    given = {name: [number(p, name) for p in column] for name, column in found.given.items()}
    samples = [p for name in "cd" for p in found.given[name] if p.errors[0].sample]
    if samples:
        values, u = [float(p.value) for p in samples], [p.u for p in samples]
        given["c"], given["d"] = ([x] for x in GTC.multiple_ureal(values, u, samples[0].errors[0].dof))
    for (one, other), r in found.r.items():
        for pair in zip(given[one], given[other], strict=True):
            GTC.set_correlation(r, *pair)
    return Walk(found.sheet, given, {exp: GTC.exp, log: GTC.log, Abs: absolute(GTC.value), Pow: GTC.sqrt})


def by_uncertainties(found: Drawn) -> Walk:
    given: dict[str, list[Any]] = {
        name: [uncertainties.ufloat(float(p.value), p.u) for p in column]
        for name, column in found.given.items()
    }
    for pair, r in found.r.items():
        for row, numbers in enumerate(zip(*(found.given[name] for name in pair), strict=True)):
            u, own = [p.u for p in numbers], [float(p.value) for p in numbers]
            covariance = [[u[0] ** 2, r * u[0] * u[1]], [r * u[0] * u[1], u[1] ** 2]]
            made = uncertainties.correlated_values(own, covariance)
            for name, number in zip(pair, made, strict=True):
                given[name][row] = number
    return Walk(
        found.sheet,
        given,
        {exp: umath.exp, log: umath.log, Abs: absolute(uncertainties.nominal_value), Pow: umath.sqrt},
    )


def sheets(**how: bool) -> Iterator[tuple[Drawn, Cells]]:
    for seed in range(SHEETS):
        found = drawn(seed, **how)
        if cells := found.cells:
            yield found, cells


# --- what has to be the same -------------------------------------------------------------------------------


@pytest.mark.parametrize("correlated", [False, True], ids=["apart", "correlated"])
def test_every_u_and_correlation_is_that_of_gtc(correlated: bool) -> None:
    compared = 0
    for found, every in sheets(correlated=correlated, dof=False):
        walk = by_gtc(found)
        cells = walk.followed(every)
        theirs = [walk.cell(*cell) for cell in cells]
        ours, scale = found.spread.covariance(cells), found.sizes(cells)
        for a, one in enumerate(theirs):
            value = found.values.value[cells[a][0]][cells[a][1]]
            assert GTC.value(one) == pytest.approx(value, rel=1e-12, abs=1e-12)
            for b, other in enumerate(theirs[: a + 1]):
                known = GTC.get_covariance(one, other) if a != b else GTC.variance(one)
                assert abs(known - ours[a, b]) <= SAME * scale[a] * scale[b], (cells[a], cells[b])
                compared += 1
    assert compared > 500


@pytest.mark.parametrize("correlated", [False, True], ids=["apart", "correlated"])
def test_every_u_and_correlation_is_that_of_uncertainties(correlated: bool) -> None:
    compared = 0
    for found, every in sheets(correlated=correlated, dof=False):
        walk = by_uncertainties(found)
        cells = walk.followed(every)
        numbers = [walk.cell(*cell) for cell in cells]
        sure = 0 * uncertainties.ufloat(0, 1)  # what rests on nothing is no number of theirs
        theirs = np.array(uncertainties.covariance_matrix([number + sure for number in numbers]))
        ours, scale = found.spread.covariance(cells), found.sizes(cells)
        assert (abs(theirs - ours) <= SAME * np.outer(scale, scale)).all()
        compared += ours.size
    assert compared > 500


@pytest.mark.parametrize("together", [False, True], ids=["apart", "estimated together"])
def test_degrees_of_freedom_are_those_of_gtc(together: bool) -> None:
    """Those of a sample of several quantities as Willink combines them, which is what GTC does."""
    compared = 0
    for found, cells in sheets(correlated=False, dof=True, together=together):
        walk = by_gtc(found)
        for name, row in walk.followed(cells):
            theirs = GTC.dof(walk.cell(name, row))
            ours = found.spread.budget(name, row).dof
            if math.isfinite(theirs) and ours < 1e9:
                assert ours == max(1, math.floor(round(theirs, 2))), (name, row)
                compared += 1
    assert compared > 100


def test_every_derivative_is_a_difference_at_50_digits() -> None:
    """Central differences over steps of 1e-15 are right to some 1e-30; ours are doubles."""
    compared = 0
    for found, cells in sheets(correlated=False, dof=False):
        known = differences(
            found.sheet, found.inputs, [source.moves[0] for source in found.spread.sources], cells
        )
        ours = found.spread.contributions(cells)
        largest = np.maximum(np.abs(known).max(axis=1, keepdims=True), 1e-18)
        assert (np.abs(ours - known) <= SAME * largest).all()
        compared += int(np.count_nonzero(known))
    assert compared > 500


def test_derivatives_of_the_paper_are_differences_at_50_digits() -> None:
    """Roots by the implicit function theorem, and a mean of them."""
    report = Study(PAPER).computed
    wanted = report.sheet["alpha_mean"]
    sheet = Sheet((*report.sheet.ancestors(wanted), wanted))
    spread = Spread(report.inputs, report.values)
    moves = [source.moves[0] for source in spread.sources]
    cells = [*(("alpha", row) for row in range(10)), ("alpha_mean", 0)]
    known = differences(sheet, report.inputs, moves, cells)
    assert np.abs(spread.contributions(cells) - known).max() <= SAME * np.abs(known).max()
    assert np.count_nonzero(known) == 10 * 6 + 15


def differences(sheet: Sheet, inputs: Inputs, moves: Sequence[tuple[str, int, float]], cells: Cells) -> Any:
    """What a standard uncertainty of each given number does to cells (cells, moves)."""
    step = Fraction(1, 10**15)
    rows = {name: [p.value for p in inputs.printed(name)] for name in sheet.bounds}
    labels = {axis.name: inputs.only.tests for axis in sheet.axes if not axis.parents}

    def at(name: str, row: int, by: Fraction) -> list[Any]:
        moved = rows | {name: [value + by * (place == row) for place, value in enumerate(rows[name])]}
        data = {own: column if sheet[own].axis is not None else column[0] for own, column in moved.items()}
        found = exact.evaluate(sheet, labels, data)
        return [found.value[cell][place] for cell, place in cells]

    known = np.zeros((len(cells), len(moves)))
    with mpmath.workdps(60):
        for place, (name, row, u) in enumerate(moves):
            if name in rows:
                size = step * max(abs(rows[name][row]), Fraction(1, 10**6))
                up, down = at(name, row, size), at(name, row, -size)
                scale = mpmath.mpf(u) / (2 * mpmath.mpf(size.numerator) / size.denominator)
                known[:, place] = [float((a - b) * scale) for a, b in zip(up, down, strict=True)]
    return known
