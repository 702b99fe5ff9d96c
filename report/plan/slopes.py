"""What is told of the derivatives of a plan once they are made: which node has which, and what holds them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from ..column import Column, Root
from ..sheet import Sheet
from .order import Word


@dataclass(frozen=True)
class Slope:
    """The derivative of a node by what it names."""

    by: str
    """A column or a total."""
    axis: str | None
    index: str | None
    """`axis` and `index`: for cells of a column with rows, the axis whose rows name them, and the index by
    which they do; no index if they stand on the same rows."""
    value: str
    """The part that holds it, on the rows of the node; for a total, on those that it runs over."""


@dataclass(frozen=True)
class NodeDerivatives:
    """A node with its derivatives by what it names itself."""

    name: str
    """Of the column; for a total, of its symbol."""
    axis: str | None
    """None for a scalar, and for a total that is no group's."""
    over: str | None
    """The axis that a total runs over."""
    of: str
    """The column in whose rule it stands."""
    rounding: str
    """The part that holds its rounding in SI, in units of eps; empty if it was not asked for."""
    slopes: tuple[Slope, ...]
    word: Word | Literal[""]
    """What a total takes, empty for columns: where it is no sum, only the slopes of the rows that it takes
    count."""

    @property
    def by_order(self) -> bool:
        """Whether it takes its rows by their order."""
        return self.word not in ("", "sum")


def with_unknowns(sheet: Sheet, again: Mapping[str, str]) -> Sheet:
    """The sheet, and the unknowns that are sought again (:attr:`Derivatives.again`)."""
    return Sheet((*sheet.columns, *(unknown_of(sheet[root], name) for root, name in again.items())))


def unknown_of(column: Column, name: str) -> Column:
    """The unknown of a root as a root of its own."""
    assert isinstance(column.rule, Root)
    rule = replace(column.rule, value=column.rule.unknown)
    return replace(column, name=name, rule=rule, positive=False, requires=(), limits=())
