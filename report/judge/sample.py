"""A part of the tests, which is judged in place of all where they are too many.

Pairs and points grow with the square of the tests, and 50 digits take .3 ms a cell. A part of the tests with
all their pairs and points is a report like any other; what rests on no sum is the very same cell in both, and
what rests on all tests is judged as that of the part.
"""

from __future__ import annotations

import hashlib
from dataclasses import replace

from ..cells.layout import how_large, lay_out
from ..cells.values import Values
from ..inputs.inputs import Inputs
from ..inputs.measurements import Measurements
from ..sheet import RepeatAxis, Sheet

FEWEST = 2
"""Tests without which there is no pair."""


def part(inputs: Inputs, values: Values, most: int) -> Inputs:
    """The inputs with so many tests that the sheet has at most so many cells, drawn by what was measured.

    Parameters
    ----------
    values : Values
        Of all tests; with all columns that count.
    most : int
        Cells.

    Returns
    -------
    Inputs
        The same if all tests have no more; else without what refers to tests by their numbers.
    """
    if how_large(values.sheet, values.layouts) <= most:
        return inputs
    number = _how_many(values, max(len(table.tests) for table in inputs.tables), most)
    chosen = {table.name: _drawn(table, number) for table in inputs.tables}

    def some(table: Measurements) -> Measurements:
        rows = chosen[table.name]
        columns = {name: tuple(column[row] for row in rows) for name, column in table.measured.items()}
        return replace(table, tests=tuple(table.tests[row] for row in rows), measured=columns)

    return replace(
        inputs,
        tables=tuple(map(some, inputs.tables)),
        taken={
            name: taken.of(chosen[inputs.of(name).name]) if name in inputs.measured else taken
            for name, taken in inputs.taken.items()
        },
        published=(),
        expected=(),
        errata={},
    )


def _how_many(values: Values, tests: int, most: int) -> int:
    """How many tests of a table make no more cells; doubled first, so that no large sheet is laid out."""
    few, many = FEWEST, 2 * FEWEST
    while many < tests and _size(values, many) <= most:
        few, many = many, 2 * many
    many = min(many, tests)
    while many - few > 1:
        middle = (few + many) // 2
        few, many = (middle, many) if _size(values, middle) <= most else (few, middle)
    return few


def _size(values: Values, tests: int) -> int:
    sheet = values.sheet
    labels = {name: own[:tests] for name, own in values.given_labels.items()}
    repeats = [axis.count for axis in sheet.axes if isinstance(axis, RepeatAxis)]
    return how_large(sheet, lay_out(sheet, labels, {name: int(values.scalar(name)) for name in repeats}))


def _drawn(table: Measurements, number: int) -> list[int]:
    """So many rows, or all, in the order of the table; drawn by the digits that were measured."""
    digits = "\n".join(
        f"{name} {' '.join(each.text if each else '' for each in column)}"
        for name, column in table.measured.items()
    )
    seed = hashlib.sha256(digits.encode()).hexdigest()
    lots = [hashlib.sha256(f"{test}\n{seed}".encode()).digest() for test in table.tests]
    return sorted(sorted(range(len(lots)), key=lots.__getitem__)[:number])


def with_own(values: Values, whole: Values) -> Values:
    """The values of a part, with those of the whole in every cell that is the same in both.

    `values` and `whole`: of some of the tests and of all; the same sheet.
    """
    sheet = values.sheet
    numbers, statuses = dict(values.value), dict(values.status)
    for column in sheet.columns:
        if not _rests_on_rows(sheet, column.name):
            rows = [whole.row(whole.sheet[column.name], label) for label in values.labels(column)]
            numbers[column.name] = whole.value[column.name][rows]
            statuses[column.name] = whole.status[column.name][rows]
    return replace(values, value=numbers, status=statuses)


def _rests_on_rows(sheet: Sheet, name: str) -> bool:
    """Whether a column sums over rows, or rests on one that does."""
    column = sheet[name]
    return any(sheet.summed_axes(each) for each in (column, *sheet.ancestors(column)))
