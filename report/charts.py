"""What a workbook wants drawn: curves of numbers, and charts of columns for views that recalculate.

The columns are of the same kind as the sheet's.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .sheet import Column, Sheet

__all__ = ["Chart", "Curve", "Drawn", "Series"]


@dataclass(frozen=True)
class Curve:
    """A line or a set of points of a figure, in SI.

    Parameters
    ----------
    figure : str
        Which figure it belongs to: the name of its drawing.
    role : str
        What it is there: ``compression``, ``restitution``, ``fit``, ``points``, ...
    label : str
        What tells it from others of the same role: the test's or the pair's number.
    x, y : float arrays of the same length
    """

    figure: str
    role: str
    label: str
    x: NDArray[np.float64]
    y: NDArray[np.float64]


@dataclass(frozen=True)
class Series:
    """Points of a chart: two drawn columns of one axis.

    Parameters
    ----------
    label : str
        What the legend says; ``%s`` is where the parent's row is named if there is one series for each.
    x, y : str
        Names of drawn columns.
    style : str
        ``points``, ``line`` or ``branch`` (one of several lines of a kind).
    split : bool
        Whether each row of the parent's axis is a line of its own.
    """

    label: str
    x: str
    y: str
    style: str = "line"
    split: bool = False


@dataclass(frozen=True)
class Chart:
    """A native chart of the workbook.

    Parameters
    ----------
    title, x_title, y_title : str
        The axes' titles without their units.
    series : tuple of Series
        The last is drawn on top.
    from_zero : bool
        Whether both axes begin at zero.
    """

    title: str
    x_title: str
    y_title: str
    series: tuple[Series, ...]
    from_zero: bool = False


@dataclass(frozen=True)
class Drawn:
    """What a workbook wants drawn as charts: columns for their points, and the charts.

    Parameters
    ----------
    columns : tuple of Column
        Formulas as the sheet's. A cell in error shows ``#N/A``, which charts leave out.
    charts : tuple of Chart
    given : mapping of str to int
        Values of the given columns among them: how often an axis that only charts have repeats its parent.
    """

    columns: tuple[Column, ...]
    charts: tuple[Chart, ...]
    given: Mapping[str, int]

    def with_curves(self, sheet: Sheet) -> Sheet:
        """The sheet with the curves: without what only copies its columns for a chart."""
        known = set(sheet.axes)
        return Sheet((*sheet.columns, *(c for c in self.columns if c.axis not in known)))
