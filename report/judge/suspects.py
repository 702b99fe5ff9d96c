"""Which test of a campaign to look at first, where rows that rest on several tests are odd."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..engines.numpy import evaluate
from ..result.numbers import at
from ..sheet import Given, Sheet

if TYPE_CHECKING:
    from ..result.result import Report

__all__ = ["suspected"]

Tests = tuple[int, ...]
MOST_ALIKE = 3
"""Of so many tests that are equally odd, one is sought; the three of three pairs are as many."""


def suspected(report: Report, odd: Collection[Tests], failed: Collection[Tests]) -> tuple[int, str]:
    """The test on which most odd rows rest; of several, most that failed; then which moves the result most.

    Parameters
    ----------
    odd : collection of tuple of int
        The numbers of the tests of each odd row.
    failed : collection of tuple of int
        Of those without a value.

    Returns
    -------
    int
        The number of the test; 0 if there is none.
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
    return _furthest(report, first) if 0 < len(first) <= MOST_ALIKE else (0, "")


def _furthest(report: Report, tests: Sequence[int]) -> tuple[int, str]:
    """The test without which the first sum of the result moves furthest."""
    headline = (report.sheet[name] for name in report.workbook.headline if name in report.sheet)
    column = next((one for one in headline if one.axis is None and report.sheet.summed_axes(one)), None)
    if column is None or (before := report.values.cell(column.name).value) is None:
        return 0, ""
    sheet = Sheet((*report.sheet.ancestors(column), column))
    data = {one.name: report.values.value[one.name] for one in sheet.columns if isinstance(one.rule, Given)}
    own = report.inputs.tests
    # One draw for each suspect, in which its measured cells are missing: one evaluation for all.
    without = np.array([[test == other for other in own] for test in tests])
    for name in data.keys() & report.inputs.measured.keys():
        data[name] = np.where(without, np.nan, data[name])
    labels = {axis.name: own for axis in sheet.axes if axis.is_given}
    after = evaluate(sheet, labels, data).value[column.name][:, 0]
    moved = np.nan_to_num(np.abs(after - before))
    if np.count_nonzero(moved == moved.max()) > 1:
        return 0, ""
    row, how, (place,) = int(moved.argmax()), report.shown[column.name], report.places(column.name)
    was, now = (at(how.of(float(each)), place).text for each in (before, after[row]))
    return tests[row], f"without it {column.name} goes from {was} to {now}, further than without another"
