"""A folder that was read, with its sheet: what engines start from, and what they make of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

from .axis import GroupAxis, MemberAxis
from .column import Given, written_in
from .inputs.cells import check_cells
from .inputs.inputs import Inputs

if TYPE_CHECKING:
    from .cells.layout import Layout
    from .cells.values import Values
    from .engines.exact import ExactValues
    from .sheet import Sheet


def sheet_data(sheet: Sheet, inputs: Inputs) -> dict[str, Any]:
    """What a sheet is given, in SI as exact fractions: a list for a measured column, one for a parameter.

    What is missing is None.
    """
    given: dict[str, Any] = {
        name: [p and p.value for p in column] for name, column in inputs.measured.items()
    }
    given |= {name: printed.value for name, printed in inputs.parameters.items()}
    needed = {c.name for c in sheet.columns}
    data = {name: value for name, value in given.items() if name in needed}
    for column in sheet.columns:
        if isinstance(column.rule, Given) and (own := column.rule.u_of):
            data[column.name] = [None if math.isnan(u) else Fraction(u) for u in inputs.own_u(own)]
    return data


@dataclass(frozen=True)
class Prepared:
    """A folder that was read, with its sheet, checked and ready to be computed."""

    inputs: Inputs
    sheet: Sheet

    @property
    def labels(self) -> dict[str, tuple[int, ...]]:
        """Row numbers of the axes that come with the data, and of the group of each row."""
        inputs = self.inputs
        found = {axis.name: inputs.on(axis.name).tests for axis in self.sheet.axes if axis.is_given}
        for axis in self.sheet.axes:
            if isinstance(axis, MemberAxis):
                table = inputs.on(axis.of.name)
                number = table.groups(axis.by)
                found[axis.name] = tuple(number[test] for test in table.tests)
        return found

    @cached_property
    def layouts(self) -> dict[str, Layout]:
        """The rows of every axis."""
        from .engines.exact import laid_out

        return laid_out(self.sheet, self.labels, self.exact_data)

    @cached_property
    def words(self) -> dict[str, dict[tuple[int, ...], str]]:
        """What rows are known by besides their numbers, by axis: groups, and rows that the table names."""
        found, inputs = dict[str, dict[tuple[int, ...], str]](), self.inputs
        for axis in self.sheet.axes:
            if isinstance(axis, GroupAxis):
                words = inputs.on(axis.members.of.name).words(axis.row)
                found[axis.name] = {(n,): word for n, word in enumerate(words, start=1)}
            elif axis.is_given and (name := (table := inputs.on(axis.name)).naming):
                found[axis.name] = {(test,): row[name[0]] for test, row in table.rows.items()}
        return found

    def check_cells(self) -> Inputs:
        """Refuse what is said of cells that there are not.

        Returns
        -------
        Inputs
            Those without what is said of tests that are left out.

        Raises
        ------
        InputError
            With every finding.
        """
        rows = {name: set(map(tuple, layout.labels.tolist())) for name, layout in self.layouts.items()}
        by_name = self.sheet.by_name
        return check_cells(
            self.inputs,
            {
                c.name: (written_in(c, by_name), {()} if c.axis is None else rows[c.axis.name])
                for c in self.sheet.columns
            },
            {c.name: self.words.get(c.axis.name, {}) for c in self.sheet.columns if c.axis},
            {c.name: self.inputs.beneath(c.axis) for c in self.sheet.columns},
        )

    @property
    def exact_data(self) -> dict[str, Any]:
        """What the exact engine starts from."""
        return sheet_data(self.sheet, self.inputs)

    @property
    def data(self) -> dict[str, Any]:
        """What the other engines start from: the nearest doubles, NaN for what is missing."""
        return {
            n: [math.nan if x is None else float(x) for x in v] if isinstance(v, list) else float(v)
            for n, v in self.exact_data.items()
        }

    def computed(self, whole: Sheet, most: int) -> tuple[ExactValues | None, tuple[Values, Values]]:
        """All cells at 50 digits, if they are not too many, and the values of the sheet and of more columns.

        Parameters
        ----------
        whole : Sheet
            With what is computed besides.
        most : int
            Cells.

        Returns
        -------
        ExactValues or None
            Of which the values then are the nearest doubles; without it, they are NumPy's.
        tuple of Values
            Of the sheet, and of the whole.
        """
        from .cells.layout import how_large
        from .engines import exact
        from .engines import numpy as engine

        if how_large(whole, self.layouts) <= most:
            found = exact.evaluate(whole, self.labels, self.exact_data)
            return found, (self.worded(found.rounded(self.sheet)), self.worded(found.rounded(whole)))
        values = self.worded(engine.evaluate(self.sheet, self.labels, self.data))
        more = [column for column in whole.columns if column.name not in self.sheet]
        return None, (values, self.worded(engine.extend(values, more, {})))

    def worded(self, values: Values) -> Values:
        """The same with what its rows are known by."""
        return replace(values, words=self.words)
