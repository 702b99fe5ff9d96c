"""Cells outside of a limit by more than their uncertainty: honest numbers lie on both sides of a true one."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..judge.oddities import REACH
from ..result.result import Report


def outside(report: Report) -> Mapping[str, NDArray[np.bool_]]:
    """The rows outside of each limit that tell something, by the name of its margin's column.

    Those that are outside by no more than :data:`REACH` standard uncertainties of the margin are not among
    them, but where a limit is silent: what it leaves out, however little beyond it, tells nothing. A margin
    of which no uncertainty is known has none.
    """
    marks = report.marks
    found = {each.column.name: marks.outside(each) & marks.telling(each) for each in marks.margins}
    if asked := [each for each in marks.margins if found[each.column.name].any() and not each.limit.silent]:
        from .propagation import Spread  # only what is odd needs it

        spread = Spread(report.inputs, marks.values)
        for name in (margin.column.name for margin in asked):
            found[name] &= -marks.values.value[name] > REACH * np.nan_to_num(spread.u(name))
    return found
