"""One curve for all tests at once, for other workbooks of the same tests."""

from __future__ import annotations

from ..sheet import Axis, Column
from .soft_impact import sheet
from .soft_impact_sheet import of_sheet

__all__ = ["columns"]


def columns(tests: Axis, measured: tuple[Column, Column, Column]) -> tuple[Column, ...]:
    """The columns of the fit, over the tests that were measured."""
    given = frozenset({"ball_mass"})
    names = [column.name for column in sheet(given).columns]
    return of_sheet(given, *names[names.index("u_v") :])
