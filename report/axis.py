"""The index sets of a sheet: which rows there are, what they are made of and how they are called.

Nothing here knows a model, a number or an output.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from .content import content

if TYPE_CHECKING:
    from sympy import Symbol
    from sympy.logic.boolalg import Boolean

_ALIKE = ("series", "species")
"""Words of which there are as many of one as of several."""
_LONGER = "(?:ss|x|z|ch|sh|lens|gas|bias)"
"""How words end that take es."""


def plural(row: str) -> str:
    """What several rows are called.

    >>> [plural(word) for word in ("specimen", "lens", "batch", "body", "day", "series")]
    ['specimens', 'lenses', 'batches', 'bodies', 'days', 'series']
    """
    if row.endswith(_ALIKE):
        return row
    if re.search("[^aeiou]y$", row):
        return f"{row[:-1]}ies"
    return f"{row}es" if re.search(f"{_LONGER}$", row) else f"{row}s"


def singular(rows: str) -> str:
    """What one row is called, of the word for several.

    >>> [singular(word) for word in ("specimens", "lenses", "phases", "masses", "bodies", "series", "data")]
    ['specimen', 'lens', 'phase', 'mass', 'body', 'series', 'data']
    """
    if rows.endswith(_ALIKE) or re.search(f"{_LONGER}$", rows):
        return rows
    if re.search("[^aeiou]ies$", rows):
        return f"{rows[:-3]}y"
    return rows[:-2] if re.search(f"{_LONGER}es$", rows) else rows.removesuffix("s") or rows


def _called(symbol: str) -> cached_property[str]:
    return cached_property(lambda axis: str(getattr(axis, symbol).name))


@dataclass(frozen=True)
class Axis:
    """An index set whose rows come with the data, such as the tests of a campaign."""

    name: str
    """``tests``, ``pairs``, ``points``."""
    index: Symbol
    """The running number of a row in formulas, ``k``."""
    size: Symbol
    """How many rows there are: the upper limit of sums over the axis."""
    index_name, size_name = _called("index"), _called("size")
    """What both are called."""
    is_given: ClassVar[bool] = True
    """Whether its rows come with the data."""
    _WORDS: ClassVar[tuple[str, ...]] = ("index_name", "size_name")

    @property
    def row(self) -> str:
        """What one of its rows is called: ``test`` of ``tests``."""
        return singular(self.name)

    @property
    def words(self) -> dict[str, Any]:
        """What it says, but its symbols and parents."""
        own = {name: getattr(self, name) for name in self._WORDS}
        return {"name": self.name, "content": self.content, **own}

    @cached_property
    def alone(self) -> Axis:
        """The same with rows that come with the data, whatever it is made of."""
        return Axis(self.name, self.index, self.size)

    @property
    def maps(self) -> dict[Symbol, Axis]:
        """For every index that may be used in a formula on this axis, the axis whose rows it names."""
        return {self.index: self}

    @property
    def named(self) -> dict[str, Axis]:
        """The same by what the indices are called."""
        return {self.index_name: self}

    @property
    def ordinals(self) -> tuple[Symbol, ...]:
        """Running numbers that a formula on this axis may use as values, its own first."""
        return ()

    @cached_property
    def content(self) -> str:
        """All that it says."""
        return content(self)

    @property
    def parents(self) -> tuple[Axis, ...]:
        """The axes that its rows are made of."""
        return ()

    def grouped(self, axes: Iterable[Axis]) -> Iterator[MemberAxis]:
        """Those of some index sets that have its rows in groups: a formula on it may name a row's group."""
        return (each for each in axes if isinstance(each, MemberAxis) and each.of == self)

    @property
    def repeats(self) -> str | None:
        """The given scalar that says how many rows it has for each of its parent's."""
        return None

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """What the numbers that name a row are called, and what they are: ``i``, ``j``, ``s``."""
        return ((self.row, "number"),)

    @property
    def described(self) -> str:
        """Its rows in words."""
        return "one row each"


@dataclass(frozen=True)
class _Resting(Axis):
    """Rows that are made of those of another axis."""

    of: Axis
    is_given = False

    @property
    def parents(self) -> tuple[Axis, ...]:
        """The axis that is paired, repeated or grouped."""
        return (self.of,)

    @property
    def named(self) -> dict[str, Axis]:
        """What it maps, by what the indices are called."""
        return {self.index_name: self, **self.of.named}


@dataclass(frozen=True)
class PairAxis(_Resting):
    """Pairs of another axis' rows in lexical order: every i < j, or what a subclass chooses."""

    first: Symbol
    second: Symbol
    _WORDS = (*Axis._WORDS, "members", "choice")

    @property
    def maps(self) -> dict[Symbol, Axis]:
        """The pair's own number and those of its two members."""
        return {self.index: self, self.first: self.of, self.second: self.of}

    @cached_property
    def members(self) -> tuple[str, str]:
        """What the numbers of both members are called."""
        return self.first.name, self.second.name

    @property
    def named(self) -> dict[str, Axis]:
        """The same by what the indices are called."""
        return {self.index_name: self, **dict.fromkeys(self.members, self.of)}

    @property
    def chosen(self) -> Boolean:
        """Which of all pairs are rows, by the places of both members, from 1."""
        return self.first < self.second

    @cached_property
    def choice(self) -> str:
        """The same in words; empty if it is every i < j."""
        return "" if self.chosen == (self.first < self.second) else str(self.chosen)

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """The numbers of both members."""
        return tuple(
            (member, f"{which} of {self.of.name}")
            for member, which in zip(self.members, ("first", "second"), strict=True)
        )

    @property
    def described(self) -> str:
        """Which pairs."""
        return f"every pair {self.choice or ' < '.join(self.members)} of {self.of.name}"


@dataclass(frozen=True)
class RepeatAxis(_Resting):
    """A number of rows, counted by `step` = 1, 2, ..., for each row of another axis."""

    step: Symbol
    step_name = _called("step")
    count: str
    """Name of the given scalar that says how many, the same for all."""
    _WORDS = (*Axis._WORDS, "step_name", "count")

    @property
    def maps(self) -> dict[Symbol, Axis]:
        """The row's own number, and all that its parent's row may name."""
        return {self.index: self, **self.of.maps}

    @property
    def ordinals(self) -> tuple[Symbol, ...]:
        """The running number within the parent's row, then what the parent's row may use."""
        return (self.step, *self.of.ordinals)

    @property
    def repeats(self) -> str:
        """The given scalar that says how many."""
        return self.count

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """What names the parent's row, and the number in it."""
        return (*self.of.parts, (self.step_name, f"running number in each of {self.of.name}"))

    @property
    def described(self) -> str:
        """How its rows are counted."""
        return f"{self.step_name} = 1, 2, ... {self.count} for each of {self.of.name}"


@dataclass(frozen=True)
class CountedAxis(Axis):
    """A number of rows, counted by `step` = 1, 2, ..., whatever the data: the points of a curve."""

    step: Symbol
    step_name = _called("step")
    number: int
    is_given = False
    _WORDS = (*Axis._WORDS, "step_name", "number")

    @property
    def ordinals(self) -> tuple[Symbol, ...]:
        """The running number."""
        return (self.step,)

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """The running number."""
        return ((self.step_name, "running number"),)

    @property
    def described(self) -> str:
        """How many."""
        return f"{self.number} rows, whatever the data"


@dataclass(frozen=True)
class MemberAxis(_Resting):
    """Another axis' rows once more, those of one group beside one another: what a group takes sums over."""

    group: Symbol
    """The index of the groups, in whose formulas alone such sums stand."""
    group_name = _called("group")
    by: str
    """The column of words that says of each row to which group it belongs."""
    _WORDS = (*Axis._WORDS, "group_name", "by")

    @property
    def maps(self) -> dict[Symbol, Axis]:
        """The row's own number and that of the row that it repeats; its group is known to the sheet."""
        return {self.index: self, self.of.index: self.of}

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """The number of the group, and of the row."""
        return ((self.by, "number"), *self.of.parts)

    @property
    def described(self) -> str:
        """In which order."""
        return f"the {self.of.name} of each {self.by}, one {self.by} after the other"


@dataclass(frozen=True)
class GroupAxis(Axis):
    """Groups of another axis' rows, one for each word of a column, in the order in which these appear."""

    members: MemberAxis
    is_given = False

    @property
    def row(self) -> str:
        """What its rows are called: as the column of words."""
        return self.members.by

    @property
    def parents(self) -> tuple[Axis, ...]:
        """The rows in groups."""
        return (self.members,)

    @property
    def described(self) -> str:
        """What makes a group."""
        return f"one row for each {self.row} of the {self.members.of.name}"
