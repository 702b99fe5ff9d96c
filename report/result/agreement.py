"""How well an engine agrees with 50 digits: what the judge of the engines found, for all who tell it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

LIMIT = 8.0
"""The difference, in eps times condition, at which an engine is no longer believed."""


@dataclass(frozen=True)
class Agreement:
    """How well an engine agrees with the exact one.

    Where an engine's numbers are read from a file that does not keep all digits, differences are those that
    are left when every number is moved towards the exact one by what its storage may have cut.

    For given inputs `cells` is the same everywhere. Differences depend on the machine: NumPy takes another
    logarithm on another processor, and the programs are whatever is installed. A report therefore has
    NumPy's alone unless the others are asked for.
    """

    cells: int
    """How many were compared."""
    worst: float
    """Largest difference, relative to the largest cell of its column, and for a pure number that may vanish
    to 1 at least: a logarithm near zero has no relative precision."""
    where: str
    """The cell of the largest such difference."""
    findings: tuple[str, ...]
    """Cells that differ in status, or by more than :data:`LIMIT`; why the engine failed."""
    units: float = 0.0
    """Largest difference in eps times condition."""
    units_where: str = ""
    """The cell of that one."""
    engine: str = "numpy"
    """``numpy``, ``JavaScript``, ``xlsx``."""
    program: str = ""
    """What ran it, ``node 20.19``; empty if it needs none."""
    missing: str = ""
    """The program that is not installed: then nothing was compared, and nothing is wrong."""
    unmade: str = ""
    """Why there is nothing that it could compute, without a full stop: then nothing was compared, either."""
    unbounded: int = 0
    """Cells whose condition is infinite, such as a square root of zero: only their status is judged."""
    of: int = 0
    """How many cells the report has, if these are those of a sample; else 0."""
    sample: str = ""
    """What the sample is: ``14 of 200 tests``."""

    @property
    def absent(self) -> str:
        """Why nothing was compared; empty if something was, or if the engine failed."""
        return f"{self.missing} not found" if self.missing else self.unmade

    @property
    def counted(self) -> str:
        """How many cells were compared, and of how many: ``2154 cells``."""
        return (
            f"{self.cells} of {self.of} cells, those of {self.sample}" if self.of else f"{self.cells} cells"
        )

    @property
    def summary(self) -> str:
        """The comparison in a sentence, in relative differences."""
        within = f"within {self.worst:.1e} ({self.where})"
        return f"{self.engine} agrees with 50 digits on {self.counted} {within}"

    @property
    def line(self) -> str:
        """The comparison in a line of a table, in eps times condition."""
        if self.absent:
            return f"{self.engine:<11} {self.absent}"
        ran = f", {self.program}" if self.program else ""
        if not self.cells:
            return f"{self.engine:<11} failed{ran}"
        place = f" ({self.units_where})" if self.units_where else ""
        rest = f", {self.unbounded} without a condition" if self.unbounded else ""
        most = f"at most {self.units:.2g} eps x condition"
        return f"{self.engine:<11} {self.counted}, {most}{place}{rest}{ran}"

    @property
    def data(self) -> dict[str, Any]:
        """The same for JSON."""
        return {
            "engine": self.engine,
            "program": self.program or None,
            "missing": self.missing or self.unmade or None,
            "cells": self.cells,
            "of": self.of or self.cells,
            "sample": self.sample or None,
            "unbounded": self.unbounded,
            "eps_condition": self.units,
            "eps_condition_cell": self.units_where or None,
            "limit": LIMIT,
            "relative": self.worst,
            "relative_cell": self.where or None,
            "findings": list(self.findings),
        }
