"""What a shipped workbook declares besides its sheet, as data: what reads a folder by it needs no algebra.

What it does, such as to lay out its sheet, is done by itself, which is imported then.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import Any

from .machine.kept import kept
from .partly import partly
from .plan.kept import as_data, of_data
from .workbook import Either, FigureSpec, Measured, Parameter, RowTable, SquareSum, TableSpec, Workbook


@dataclass(frozen=True)
class _Told:
    """The fields of a workbook that are data, and the names of those that are functions and there."""

    name: str
    title: str
    source: str
    measured: tuple[Measured, ...]
    parameters: tuple[Parameter, ...]
    either: tuple[Either, ...]
    headline: tuple[str, ...]
    row: str
    least: int
    groups: tuple[str, ...]
    several: tuple[RowTable, ...]
    squares: tuple[SquareSum, ...]
    constants: frozenset[str]
    margins: Mapping[str, str]
    aside: frozenset[str]
    fits: tuple[str, ...]
    tables: tuple[TableSpec, ...]
    figures: tuple[FigureSpec, ...]
    prose: str
    told: Mapping[str, str]
    published_as: Mapping[str, str]
    example: tuple[tuple[str, ...], ...]
    example_parameters: Mapping[str, str]
    functions: tuple[str, ...]


_EMPTY = ("curves", "means", "claims", "models")
"""What is no data: a workbook that has some is imported."""
_FUNCTIONS = ("ledger", "sheet", "check_parameters", "drawn", "drawings", "card_constants", "design")


def known_workbook(name: str, whole: Callable[[], Workbook]) -> Workbook:
    """The workbook of a name, which is made whole only if somebody asks what it does."""

    def make() -> Any:
        own = whole()
        if any(getattr(own, name) for name in _EMPTY):
            return None
        there = tuple(name for name in _FUNCTIONS if getattr(own, name) is not None)
        data = {field.name: getattr(own, field.name) for field in fields(_Told) if field.name != "functions"}
        return as_data(_Told(**data, functions=there))

    def function(name: str) -> Callable[..., Any]:
        def called(*arguments: Any) -> Any:
            return getattr(whole(), name)(*arguments)

        return called

    data = kept("workbook", [name], make)
    if data is None:
        return whole()
    told = of_data(data, _Told)
    known = {field.name: getattr(told, field.name) for field in fields(told) if field.name != "functions"}
    known |= {name: function(name) if name in told.functions else None for name in _FUNCTIONS}
    return partly(Workbook, known | dict.fromkeys(_EMPTY, ()), whole)
