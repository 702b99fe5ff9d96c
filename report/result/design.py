"""What is known of measurements that are only planned."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .result import Report
from .uncertain import Budget

__all__ = ["BestChoice", "Needed", "Planned"]


@dataclass(frozen=True)
class BestChoice:
    """The best choice that was found in a range.

    Parameters
    ----------
    ends : tuple of float
        Of the range, in SI.
    u, u_equal : float
        Of the cell for this choice and for equal steps from one end to the other; infinite where the cell has
        no uncertainty.
    tried : int
        How many choices were computed.
    """

    ends: tuple[float, float]
    u: float
    u_equal: float
    tried: int


@dataclass(frozen=True)
class Needed:
    """The uncertainty of a column with which a cell has a wanted one, all others kept.

    Parameters
    ----------
    of : str
        The column or parameter.
    wanted : float
        Of the cell, in SI.
    u : float
        Of every number of the column, in SI, the largest; NaN if none is small enough, infinite if any is.
    others : float
        The uncertainty of the cell if the column had none, in SI.
    """

    of: str
    wanted: float
    u: float
    others: float

    @property
    def is_out_of_reach(self) -> bool:
        """Whether none is small enough."""
        return math.isnan(self.u)


@dataclass(frozen=True)
class Planned:
    """A planned campaign and how sure one of its cells will be.

    Parameters
    ----------
    report : Report
        As if the planned rows had been measured.
    followed : Report
        That of the rows whose curve they follow.
    curve : tuple of str
        The cells that are this curve.
    budget : Budget
        Of the cell.
    u : mapping of str to float array (rows,)
        Of each measured column, in SI; the chosen one first.
    shares : mapping of str to float
        Of the cell's variance: by column or parameter, and by name of what cells share.
    of_tests : mapping of int to float
        The same by planned row.
    best : BestChoice or None
    needed : Needed or None
    """

    report: Report
    followed: Report
    curve: tuple[str, ...]
    budget: Budget
    u: Mapping[str, NDArray[np.float64]]
    shares: Mapping[str, float]
    of_tests: Mapping[int, float]
    best: BestChoice | None = None
    needed: Needed | None = None
