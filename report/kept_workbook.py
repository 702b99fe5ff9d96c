"""What a shipped workbook declares besides its sheet, as data: what reads a folder by it needs no algebra.

What it does, such as to lay out its sheet, is done by itself, which is imported then.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, make_dataclass
from typing import Any

from .machine.kept import kept
from .partly import partly
from .plan.kept import as_data, of_data
from .workbook import Workbook

_EMPTY = ("curves", "means", "claims", "models")
"""What is no data: a workbook that has some is imported."""
_FUNCTIONS = ("ledger", "sheet", "check_parameters", "drawn", "drawings", "card_constants", "design")
_DATA = {field.name: field.type for field in fields(Workbook) if field.name not in (*_EMPTY, *_FUNCTIONS)}
_Told = make_dataclass("_Told", [*_DATA.items(), ("functions", tuple[str, ...])])
"""The fields of a workbook that are data, and the names of those that are functions and there."""
_Told.__module__ = Workbook.__module__  # where their types are known


def known_workbook(name: str, whole: Callable[[], Workbook]) -> Workbook:
    """The workbook of a name, which is made whole only if somebody asks what it does."""

    def make() -> Any:
        own = whole()
        if any(getattr(own, name) for name in _EMPTY):
            return None
        there = tuple(name for name in _FUNCTIONS if getattr(own, name) is not None)
        return as_data(_Told(*(getattr(own, name) for name in _DATA), there))

    def function(name: str) -> Callable[..., Any]:
        def called(*arguments: Any) -> Any:
            return getattr(whole(), name)(*arguments)

        return called

    data = kept("workbook", [name], make)
    if data is None:
        return whole()
    told: Any = of_data(data, _Told)
    known = {name: getattr(told, name) for name in _DATA}
    known |= {name: function(name) if name in told.functions else None for name in _FUNCTIONS}
    return partly(Workbook, known | dict.fromkeys(_EMPTY, ()), whole)
