"""Which rows sums leave out: all that one result rests on run over the same."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from ..axis import GroupAxis, MemberAxis
from ..column import Column
from ..sheet import Sheet
from .fitted import DeclaredFit


class SameRows:
    """The columns of a method, of which the sums and counts that one result rests on leave out the same rows.

    Those are rows in which what one of them, or what is computed from them, asks for has no value. What rests
    on a sum over these rows cannot be asked; groups can, whose values are sums over their own rows. As a sum
    has one value, results that share it are of the same rows.

    Parameters
    ----------
    columns : sequence of Column
        As they were declared.
    fits : sequence of DeclaredFit
    of_fits, margins : collection of str
        The columns of fits, and those that are compared with 0.
    """

    def __init__(
        self,
        columns: Sequence[Column],
        fits: Sequence[DeclaredFit],
        of_fits: Collection[str],
        margins: Collection[str],
    ) -> None:
        self.sheet, self.of_fits, self.margins = Sheet(tuple(columns)), of_fits, margins
        self.fits = [{each.name for each in fit.columns} for fit in fits]
        sheet = self.sheet
        self.below = {c.name: {c.name, *(each.name for each in sheet.ancestors(c))} for c in sheet.columns}
        self.over = {c.name: {*sheet.summed_axes(c), *sheet.algebra.counted(c)} for c in sheet.columns}
        for axes in self.over.values():
            axes |= {axis.of for axis in axes if isinstance(axis, MemberAxis)}
        self.sums = {name for name, axes in self.over.items() if axes}

    @property
    def columns(self) -> Iterator[Column]:
        """All of them, with what their sums look at besides what they name."""
        bound: list[set[str]] = []  # names of which those in one set rest on sums that they share
        for column in self.sheet.columns:
            if (names := self._together(column)) & self.sums:
                apart = [each for each in bound if not each & names & self.sums]
                bound = [*apart, names.union(*(each for each in bound if each not in apart))]
        asked = list(filter(self._is_asked, self.sheet.columns))
        # What a fit may lack (its scatter, with as many rows as unknowns) is asked for where a line names it.
        lines = (name for name in self.below if name not in self.of_fits)
        named = set[str]().union(*(self.below[name] for name in lines))
        for column in self.sheet.columns:
            own = replace(column, spare=False) if column.spare and column.name in named else column
            if column.name in self.sums:
                together = next(names for names in bound if column.name in names)
                near = together | self._groups_named(together)
                over = self.over[column.name]
                own = replace(own, alongside=tuple(c for c in asked if c.axis in over and c.name in near))
            yield own

    def _is_asked(self, column: Column) -> bool:
        """Whether a sum can ask a column whether a row has a value."""
        axis = column.axis
        own = {axis.members, axis.members.of} if isinstance(axis, GroupAxis) else set()
        return axis is not None and all(
            self.over[name] <= own for name in self.sums & self.below[column.name]
        )

    def _together(self, column: Column) -> set[str]:
        """The names of a column and of what it rests on, up to where another result begins.

        That is a fit, and for a fit, or a margin, all that is taken over rows: a blank that is subtracted
        has its own rows, and whoever compares a result with a limit does not change it.
        """
        own = next((names for names in self.fits if column.name in names), {column.name})
        other = set[str]().union(*self.fits)
        if own & (other | {*self.margins}):
            other |= self.sums
        return {column.name, *(each.name for each in self.sheet.ancestors(column, without=other - own))}

    def _groups_named(self, names: Collection[str]) -> set[str]:
        """The values of groups that some columns name, whose own rows are another result's."""
        every = (each for name in names for each in self.sheet.precedents(self.sheet[name]))
        return {each.name for each in every if isinstance(each.axis, GroupAxis)}
