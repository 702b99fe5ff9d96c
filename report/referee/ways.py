"""How published values may have been computed that do not follow the sheet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..cells.values import Values
from ..engines.numpy import Program, evaluate
from ..sheet import Axis, Column, Given, Sheet
from .campaign import Array, Campaign


@dataclass(frozen=True, eq=False)
class Way:
    """A program of its own for some published values."""

    program: Program
    """What is computed from columns that are given to it."""
    labels: Mapping[str, Sequence[int]]
    """By axis name; row numbers of the axes that come with the data."""
    printed: Mapping[str, Array] = field(default_factory=dict)
    """Of shape (rows,), by column name; columns that are taken as they are printed, in SI."""
    rows: Mapping[str, NDArray[np.intp]] = field(default_factory=dict)
    """By column name; columns of which some rows are taken as the sheet computes them."""
    gone: Mapping[str, int] = field(default_factory=dict)
    """By name of a given column; the row in which its datum is missing."""

    @cached_property
    def guessing(self) -> Way:
        """The same without counting roots."""
        program = self.program.guessing
        return self if program is self.program else replace(self, program=program)

    def evaluate(self, campaign: Campaign, data: Mapping[str, Any], plain: Values) -> Values:
        """Its columns, from the given columns of the whole sheet and what that computes."""
        own = {c.name for c in self.program.sheet.columns}
        given = {name: column for name, column in (*campaign.data.items(), *data.items()) if name in own}
        taken = {name: plain.value[name][..., rows] for name, rows in self.rows.items()}
        for name, row in self.gone.items():
            given[name] = np.array(given[name], dtype=np.float64)
            given[name][..., row] = np.nan
        return evaluate(self.program.sheet, self.labels, {**given, **taken, **self.printed}, self.program)


def from_printed(campaign: Campaign, cells: Sequence[str], printed: Mapping[str, Array]) -> Way:
    """Compute cells from columns as they are printed, the rest as the sheet says.

    `printed` (mapping of column name to float array (rows,)): in SI.
    """
    cut = tuple(name for name in (*campaign.free, *printed) if name not in cells)
    program = campaign.program(cells, tuple(dict.fromkeys(cut)))
    own = {c.name for c in program.sheet.columns}
    return Way(program, campaign.labels, {name: x for name, x in printed.items() if name in own})


def over_rows(column: Column, axis: Axis, every: Sequence[NDArray[np.intp]], sheet: Sheet) -> list[Way]:
    """Compute a sum or mean over other rows than all.

    `column`: its rule sums over the axis. `every` (sequence of integer array): rows, of which one may come
    twice: a way for each.
    """
    given = [
        Column(c.name, axis.alone if c.axis == axis else None, Given(), c.unit, positive=c.positive)
        for c in sheet.precedents(column)
    ]
    program = Program.of(Sheet((*given, column)))
    once = np.zeros(1, dtype=np.intp)
    return [
        Way(
            program,
            {axis.name: range(1, len(rows) + 1)},
            rows={c.name: once if c.axis is None else rows for c in given},
        )
        for rows in every
    ]
