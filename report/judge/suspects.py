"""Which test of a campaign to look at first, where rows that rest on several tests are odd, or a fit is."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..engines.numpy import evaluate
from ..result.chi_square import SIGNIFICANT, largest, tail
from ..result.numbers import at
from ..sheet import Column, Given, Sheet

if TYPE_CHECKING:
    from ..cells.values import Values
    from ..result.result import Report
    from ..workbook import SquareSum

Tests = tuple[tuple[str, int], ...]
"""Each with the index set that it is of."""
MOST_ALIKE = 3
"""Of so many tests that are equally odd, one is sought; the three of three pairs are as many."""


def suspected(
    report: Report, odd: Collection[Tests], failed: Collection[Tests]
) -> tuple[tuple[str, int] | None, str]:
    """The test on which most odd rows rest; of several, most that failed; then which moves the result most.

    Parameters
    ----------
    odd : collection of tuple
        The tests of each odd row.
    failed : collection of tuple
        Of those without a value.

    Returns
    -------
    tuple of str and int, or None
        The test, with the index set that it is of.
    str
        Why it is that one.
    """
    on = {
        test: tuple(sum(test in pair for pair in of) for of in (odd, failed)) for pair in odd for test in pair
    }
    first = sorted(test for test, number in on.items() if number == max(on.values()))
    if len(first) == 1:
        number, size = on[first[0]][0], len(odd)
        return first[
            0
        ], f"{number} of {size} odd pairs rest on it" if number < size else "every odd pair rests on it"
    return _furthest(report, first) if 0 < len(first) <= MOST_ALIKE else (None, "")


def _furthest(report: Report, tests: Sequence[tuple[str, int]]) -> tuple[tuple[str, int] | None, str]:
    """The test without which the first sum of the result moves furthest."""
    headline = (report.sheet[name] for name in report.workbook.headline if name in report.sheet)
    column = next((one for one in headline if one.axis is None and report.sheet.summed_axes(one)), None)
    if column is None or (before := report.values.cell(column.name).value) is None:
        return None, ""
    # One draw for each suspect, in which its measured cells are missing: one evaluation for all.
    without = {
        table.name: np.array(
            [
                [number == other and report.inputs.on(axis) is table for other in table.tests]
                for axis, number in tests
            ]
        )
        for table in report.inputs.tables
    }
    after = _without(report, [column], without).value[column.name][:, 0]
    moved = np.nan_to_num(np.abs(after - before))
    if np.count_nonzero(moved == moved.max()) > 1:
        return None, ""
    row, how, (place,) = int(moved.argmax()), report.shown[column.name], report.places(column.name)
    was, now = (at(how.of(float(each)), place).text for each in (before, after[row]))
    return tests[row], f"without it {column.name} goes from {was} to {now}, further than without another"


def _without(report: Report, columns: Collection[Column], without: Mapping[str, Any]) -> Values:
    """Columns, and what they rest on, without the measured cells of some tests (..., tests), by table."""
    inputs = report.inputs
    needed = {own.name for column in columns for own in (*report.sheet.ancestors(column), column)}
    sheet = Sheet(tuple(own for own in report.sheet.columns if own.name in needed))
    data: Mapping[str, Any] = {
        one.name: own
        if one.name not in inputs.measured
        else np.where(without[inputs.of(one.name).name], np.nan, own)
        for one in sheet.columns
        if isinstance(one.rule, Given)
        for own in [report.values.value[one.name]]
    }
    labels = {axis.name: inputs.on(axis.name).tests for axis in sheet.axes if axis.is_given}
    return evaluate(sheet, labels, data)


@dataclass(frozen=True)
class Outlier:
    """A test that lies farther off a fit than chance leads, and the fit without it and those before it."""

    test: int
    deviation: float
    """In standard deviations of the fit that still has it."""
    among: int
    """Of how many tests it is the farthest."""
    chance: float
    """That the farthest of so many is so far off; every choice that was open is paid for."""
    chi2: float
    dof: int

    @property
    def left(self) -> float:
        """The probability of so large a sum of squares without them."""
        return tail(self.chi2, self.dof)


def outliers(report: Report, squares: SquareSum) -> tuple[Outlier, ...]:
    """The tests that lie off, one after another: the farthest is left out and all else fitted again.

    One bad test pulls the curve, and makes others lie off as well: which do is seen without it alone.

    Parameters
    ----------
    squares : SquareSum
        Of the fit; with a column of deviations.
    """
    column, total, of = report.sheet[squares.deviation], report.sheet[squares.name], report.inputs.only
    without, values, found = np.zeros(len(of.tests), dtype=bool), report.values, list[Outlier]()
    while True:
        deviations = np.abs(values.value[column.name])
        there = np.isfinite(deviations)
        among, gone = int(there.sum()), len(of.left_out) + len(found)
        if among - 1 <= squares.fitted:
            return tuple(found)
        row = int(np.where(there, deviations, 0.0).argmax())
        chance = largest(float(deviations[row]), among, gone)
        if chance >= SIGNIFICANT:
            return tuple(found)
        without[row] = True
        values = _without(report, [column, total], {of.name: without})
        chi2 = values.scalar(total.name)
        if not np.isfinite(chi2):
            return tuple(found)
        far = float(deviations[row]), among, chance
        found.append(Outlier(of.tests[row], *far, chi2, among - 1 - squares.fitted))
