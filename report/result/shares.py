"""What the variance of a cell is made of: by column, and by test."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, TypeVar

from ..cells.address import address

if TYPE_CHECKING:
    from ..inputs.inputs import Inputs
    from .result import Report
    from .uncertain import Budget

K = TypeVar("K")
SEEN = 0.005
"""Shares of a variance that are nearer than this are told apart by nobody."""


def shares(budget: Budget, inputs: Inputs) -> tuple[dict[str, float], dict[tuple[str, int], float]]:
    """The parts of a cell's variance, the largest first.

    Parameters
    ----------
    inputs : Inputs
        That it is of.

    Returns
    -------
    mapping of str to float
        By column or parameter; what several cells share, by its own name.
    mapping of tuple of str and int to float
        By test, with the table that it is in.
    """
    columns: dict[str, float] = {}
    tests = {(table.name, test): 0.0 for table in inputs.tables for test in table.tests}
    for each in budget.contributions:
        name, row, _ = each.source.moves[0]
        table = inputs.of(name) if name in inputs.measured else None
        numbers = table.tests if table else ()
        own = each.source.name.partition(", ")[0] in {name, address(name, numbers[row : row + 1])}
        own |= bool(each.source.origin) and name in inputs.measured and len(each.source.moves) == 1
        key = name if own else each.source.name
        columns[key] = columns.get(key, 0.0) + each.share
        if own and table and name in table.measured:
            tests[table.name, table.tests[row]] += each.share
    return _ordered(columns), _ordered(tests)


def _ordered(found: Mapping[K, float]) -> dict[K, float]:
    return dict(sorted(found.items(), key=lambda item: -abs(item[1])))


def foremost(report: Report, budget: Budget) -> tuple[str, float] | None:
    """The test that most of the variance comes from, and its part; None if none is first of several."""
    _, tests = shares(budget, report.inputs)
    if len(tests) < 2:
        return None
    ((name, test), share), (_, less), *_ = tests.items()
    table = report.inputs.on(name)
    axis = next((report.sheet[one].axis for one in table.measured if one in report.sheet), None)
    row = axis.row if axis else table.row
    return (f"{row} {table.called(test)}", share) if 0 < less < share - SEEN else None
