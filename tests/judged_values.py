"""Values of a sheet, as NumPy found them, beside 50 digits."""

from collections.abc import Mapping, Sequence
from typing import Any

from loopsheet.report.cells.values import Values
from loopsheet.report.judge.engines import Judge
from loopsheet.report.judge.readers import of_values
from loopsheet.report.result.agreement import Agreement

__all__ = ["compare"]


def compare(values: Values, labels: Mapping[str, Sequence[int]], exact_data: Mapping[str, Any]) -> Agreement:
    """Evaluate the sheet at 50 digits and compare values.

    `labels` and `exact_data`: as for :func:`loopsheet.report.engines.exact.evaluate`.
    """
    return Judge.of(values.sheet, values.layouts, labels, exact_data).agreement(of_values(values))
