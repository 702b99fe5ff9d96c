"""What is known of measurements that are only planned."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .result import Report
from .uncertain import Budget


@dataclass(frozen=True)
class BestChoice:
    """The best choice that was found in a range."""

    ends: tuple[float, float]
    """Of the range, in SI."""
    u: float
    u_equal: float
    """`u` and `u_equal`: of the cell for this choice and for equal steps from one end to the other; infinite
    where the cell has no uncertainty."""
    tried: int
    """How many choices were computed."""


@dataclass(frozen=True)
class Needed:
    """The uncertainty of a column with which a cell has a wanted one, all others kept."""

    of: str
    """The column or parameter."""
    wanted: float
    """Of the cell, in SI."""
    u: float
    """Of every number of the column, in SI, the largest; NaN if none is small enough, infinite if any is."""
    others: float
    """The uncertainty of the cell if the column had none, in SI."""

    @property
    def is_out_of_reach(self) -> bool:
        """Whether none is small enough."""
        return math.isnan(self.u)


@dataclass(frozen=True)
class Planned:
    """A planned campaign and how sure one of its cells will be."""

    report: Report
    """As if the planned rows had been measured."""
    followed: Report
    """That of the rows whose curve they follow."""
    curve: tuple[str, ...]
    """The cells that are this curve."""
    budget: Budget
    """Of the cell."""
    u: Mapping[str, NDArray[np.float64]]
    """Of shape (rows,); of each measured column, in SI; the chosen one first."""
    shares: Mapping[str, float]
    """Of the cell's variance: by column or parameter, and by name of what cells share."""
    of_tests: Mapping[int, float]
    """The same by planned row."""
    best: BestChoice | None = None
    needed: Needed | None = None
