"""Engines judge one another: the same sheet in each of them, compared cell by cell with 50 digits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..engines import exact
from ..values import Status, Values

__all__ = ["Agreement", "compare"]

LARGEST = 1e-11
"""The relative difference at which an engine is no longer believed."""


@dataclass(frozen=True)
class Agreement:
    """How well an engine agrees with the exact one.

    Parameters
    ----------
    cells : int
        How many were compared.
    worst : float
        Largest difference, relative to the cell, or to the largest of its column where that is larger
        (a logarithm near zero has no relative precision).
    where : str
        The cell of the largest difference.
    findings : tuple of str
        Cells that differ in status, or by more than :data:`LARGEST`.
    """

    cells: int
    worst: float
    where: str
    findings: tuple[str, ...]

    @property
    def summary(self) -> str:
        """The comparison in a line."""
        return f"numpy agrees with 50 digits on {self.cells} cells within {self.worst:.1e} ({self.where})"


def compare(values: Values, labels: Mapping[str, Sequence[int]], exact_data: Mapping[str, Any]) -> Agreement:
    """Evaluate the sheet at 50 digits and compare.

    Parameters
    ----------
    values : Values
        What the engine found.
    labels, exact_data
        As for :func:`loopsheet.report.engines.exact.evaluate`.
    """
    judged = exact.evaluate(values.sheet, labels, exact_data)
    count, worst, where, findings = 0, 0.0, "all equal", []
    for column in values.sheet.order:
        known = [abs(x) for x in judged.value[column.name] if x is not None]
        scale = max(known, default=0)
        for row, (label, true) in enumerate(zip(values.labels(column), judged.value[column.name], strict=True)):
            status = Status(int(values.status[column.name][row]))
            address = column.name + (f"[{'-'.join(map(str, label))}]" if label else "")
            count += 1
            if status is not judged.status[column.name][row]:
                findings.append(f"{address}: numpy says {status.code}, 50 digits say {judged.status[column.name][row].code}")
            elif true is not None and scale:
                difference = float(abs(float(values.value[column.name][row]) - true) / scale)
                if difference > worst:
                    worst, where = difference, address
                if difference > LARGEST:
                    findings.append(f"{address}: numpy is off by {difference:.1e}")
    return Agreement(count, worst, where, tuple(findings))
