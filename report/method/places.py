"""What symbols of a ledger stand for in the body of a method, and what is left out with a parameter."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from dataclasses import replace
from typing import Any

from sympy import Basic, Indexed, Symbol
from sympy.core.function import AppliedUndef

from ...derivations.equation import Equation
from ..column import Column
from ..named import name_of
from ..quantity import Bounds
from ..sheet import Sheet
from ..workbook import Either


class Standing(list[dict[Any, Any]]):
    """What symbols stand for, level by level: the last says most."""

    @property
    def merged(self) -> dict[Any, Any]:
        """All of it."""
        return {old: new for level in self for old, new in level.items()}

    def put(self, part: Any, own: Mapping[Any, Any] | None = None) -> Any:
        """An equation, a formula or a condition of the ledger in cells of the body.

        `own`: what else stands for something.
        """
        if isinstance(part, tuple):
            return tuple(self.put(each, own) for each in part)
        if not isinstance(part, Equation | Basic):
            return part
        where = self.merged | dict(own or {})
        # A cell stays what it is, though another may be called as its name is.
        where = {new: new for new in where.values() if isinstance(new, Indexed)} | where
        named = _named(*((*part.members, *part.conditions) if isinstance(part, Equation) else (part,)))
        where = {old: new for old, new in where.items() if old in named}
        return part.at(where) if isinstance(part, Equation) else part.xreplace(where)


class Optionals:
    """The parameters that may be left out, and what columns are where they are."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.others: dict[str, Column] = {}

    def sheet(self, columns: tuple[Column, ...], given: Set[str]) -> Sheet:
        """The sheet for the parameters that were given."""
        gone, computed = {name for name in self.names if name not in given}, set[str]()
        kept, waiting = {column.name: column for column in columns}, list(gone)
        while waiting:
            for name in waiting:
                if name in self.others.keys() - computed:
                    kept[name] = replace(kept[name], rule=self.others[name].rule)
                    computed.add(name)
                    gone.discard(name)
                else:
                    del kept[name]
                    gone.add(name)
            waiting = [name for name, column in kept.items() if _names(*column.expressions) & gone]
        return Sheet(tuple(_limited(column, gone) for column in kept.values()))

    @property
    def either(self) -> Iterator[Either]:
        """Those in whose place others may be given."""
        for name in self.names:
            if name in self.others:
                named = _names(*self.others[name].expressions)
                instead = tuple(each for each in self.names if each in named)
                yield Either(name, self.others[name].meaning, instead)


def _limited(column: Column, gone: Set[str]) -> Column:
    """The column without limits that name what is left out."""
    kept = (own for own in column.limits if isinstance(own.inside, Bounds) or not _names(own.inside) & gone)
    limits = tuple(kept)
    return column if limits == column.limits else replace(column, limits=limits)


def _named(*parts: Basic) -> set[Basic]:
    return set[Basic]().union(*(part.atoms(Symbol, Indexed, AppliedUndef) for part in parts))


def _names(*parts: Basic) -> set[str]:
    return {name_of(cell) for part in parts for cell in part.atoms(Symbol, Indexed)}
