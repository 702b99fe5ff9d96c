"""Engines judge one another: the same sheet in each of them, compared cell by cell with 50 digits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..engines import exact
from ..values import Values

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
        Largest difference, relative to the largest cell of its column, and for a pure number that may
        vanish to 1 at least: a logarithm near zero has no relative precision.
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
    cells, worst, where, findings = 0, 0.0, "all equal", []
    for column in values.sheet.order:
        exactly, codes = judged.value[column.name], judged.status[column.name]
        scale = max((abs(x) for x in exactly if x is not None), default=0)
        if column.unit == "1" and not column.positive:
            scale = max(scale, 1)
        for cell, true, code in zip(values.cells(column.name), exactly, codes, strict=True):
            cells += 1
            if cell.status is not code:
                findings.append(f"{cell.address}: numpy says {cell.status.code}, 50 digits say {code.code}")
            elif true is not None and scale:
                difference = float(abs(cell.value - true) / scale)
                if difference > worst:
                    worst, where = difference, cell.address
                if difference > LARGEST:
                    findings.append(f"{cell.address}: numpy is off by {difference:.1e}")
    return Agreement(cells, worst, where, tuple(findings))
