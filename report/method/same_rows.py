"""Which rows sums leave out: all that one result rests on run over the same."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from functools import cached_property

from ..axis import Axis, GroupAxis, MemberAxis
from ..column import Column
from ..sheet import Sheet
from .fitted import DeclaredFit


class SameRows:
    """The columns of a method, of which the sums and counts that one result rests on leave out the same rows.

    Those are rows in which what one of them, or what is computed from them, asks for has no value. What rests
    on a sum over these rows cannot be asked, but by a fit to which it is given; groups can, whose values are
    sums over their own rows. As a sum has one value, results that share it are of the same rows.

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
        # What a fit may lack (its scatter, with as many rows as unknowns) is asked for where a line names it.
        lines = (name for name in self.below if name not in self.of_fits)
        named = set[str]().union(*(self.below[name] for name in lines))
        for column in self.sheet.columns:
            own = replace(column, spare=False) if column.spare and column.name in named else column
            if column.name in self.sums:
                looks_at = dict.fromkeys((*column.alongside, *self._alongside(column)))
                own = replace(own, alongside=tuple(looks_at))
            yield own

    def _alongside(self, total: Column) -> Iterator[Column]:
        """What a column that sums over rows asks whether a row has a value."""
        over = self.over[total.name]
        asked = {axis: self._asked(total, axis) for axis in over}
        return (each for each in self.sheet.columns if each.axis in over and each.name in asked[each.axis])

    def _asked(self, total: Column, axis: Axis) -> set[str]:
        """The names of columns on the rows of an axis that it asks."""
        groups = axis if isinstance(axis, GroupAxis) else None
        together = next(names for names in self._bound[groups] if total.name in names)
        if groups is None:
            if total.name not in self.of_fits:
                return {name for name in together if not self.sums & self.below[name]}
            # Of a fit also what is named and rests on other sums than its own: an observed over its mean.
            named = {each.name for name in together for each in self.sheet.precedents(self.sheet[name])}
            sums = self.sums & together
            return {name for name in together | named if not sums & self.below[name]}
        # What these sums name on the groups, although their own rows are another result's.
        own_sums = (self.sheet[name] for name in together if axis in self.over[name])
        near = {each.name for column in own_sums for each in self.sheet.precedents(column)}
        own = {groups.members, groups.members.of}
        below = {name: self.sums & self.below[name] for name in near}
        return {name for name, those in below.items() if all(self.over[each] <= own for each in those)}

    @cached_property
    def _bound(self) -> dict[GroupAxis | None, list[set[str]]]:
        """What rests on sums that it shares: on any, and on those over groups."""
        found: dict[GroupAxis | None, list[set[str]]] = {None: self._sharing(self.sums)}
        for axis in self.sheet.axes:
            if isinstance(axis, GroupAxis):
                found[axis] = self._sharing({name for name, over in self.over.items() if axis in over})
        return found

    def _sharing(self, sums: set[str]) -> list[set[str]]:
        """Names of which those in one set rest on some of these sums that they share."""
        bound: list[set[str]] = []
        for column in self.sheet.columns:
            if (names := self._together(column)) & sums:
                apart = [each for each in bound if not each & names & sums]
                bound = [*apart, names.union(*(each for each in bound if each not in apart))]
        return bound

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
