"""Columns that rest on one another, with NumPy: passes until nothing moves that rounding does not move."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ..cells.values import Status
from .kernels import SAME, Array, Function, compiled

Codes = NDArray[np.uint8]

MOST = 100
"""How many passes a loop gets, to come so near as this:"""
ENOUGH = 2.0**-44
NEAR = 2.0**-30
"""Nearer than this, relatively, a pass that moves no less than the one before the last moves by rounding."""
STILL = 2.0**-51
"""What a pass may move and still be the last."""


@dataclass(frozen=True)
class LoopProgram:
    """Everything a loop needs, printed."""

    iterated: tuple[str, ...]
    formulas: tuple[str, ...]
    """`iterated` and `formulas`: its columns, in the order of a pass: formulas first."""
    start: Function
    once: Function
    """`start` and `once`: the first values of the iterated ones; a pass. They are called with a run."""

    @classmethod
    def of(cls, texts: Mapping[str, Any], functions: Any = SAME) -> Self:
        """The functions of the texts that :func:`~loopsheet.report.engines.numpy_texts.loop_texts` prints."""
        start, once = (compiled(texts[name], functions) for name in ("start", "pass"))
        return cls(tuple(texts["iterated"]), tuple(texts["formulas"]), start, once)


class Settling:
    """The iterated columns of a loop on their way; each element of a batch stops for itself.

    Parameters
    ----------
    begun : mapping of column name to integer array (..., rows)
        Their statuses at the start: a cell in error there takes no part.

    Attributes
    ----------
    values : dict of column name to float array (..., rows)
        After the last pass.
    done, failed : boolean array (..., 1)
        What has settled or failed, and what has failed: it lost a value on the way, or went on and on.
    """

    def __init__(self, begun: Mapping[str, Codes]) -> None:
        self.begun = begun
        self.values: dict[str, Array] = {}
        self.passes = 0
        self.moved: tuple[Any, Any] = np.inf, np.inf
        self.done: Any = np.zeros(1, dtype=bool)
        self.failed: Any = np.zeros(1, dtype=bool)

    @property
    def ended(self) -> bool:
        """Whether nothing is left to be done."""
        return bool(self.done.all())

    @property
    def statuses(self) -> dict[str, Codes]:
        """The statuses after all: a loop that failed has no root."""
        return {
            name: np.where(self.failed & (status == Status.OK), Status.NOROOT, status).astype(np.uint8)
            for name, status in self.begun.items()
        }

    def after(
        self, before: Mapping[str, Array], after: Mapping[str, Array], status: Mapping[str, Codes]
    ) -> None:
        """Look at what a pass has changed.

        Parameters
        ----------
        before, after : mapping of column name to float array (..., rows)
        status : mapping of column name to integer array (..., rows)
            After it.
        """
        self.passes += 1
        moved, lost = np.zeros(1), np.zeros(1, dtype=bool)
        with np.errstate(all="ignore"):
            for name, begun in self.begun.items():
                takes_part = begun == Status.OK
                step = np.abs(after[name] - before[name]) / np.abs(after[name])
                step = np.where(takes_part & (after[name] != before[name]), step, 0.0)
                moved = np.maximum(moved, step.max(axis=-1, keepdims=True, initial=0.0))
                lost = lost | (takes_part & (status[name] != Status.OK)).any(axis=-1, keepdims=True)
        last = self.passes >= MOST
        still = (moved <= (ENOUGH if last else STILL)) | ((moved <= NEAR) & (moved >= self.moved[0]))
        self.values = {name: np.where(self.done, before[name], after[name]) for name in self.begun}
        self.failed = self.failed | (~self.done & (lost | (~still & last)))
        self.done = self.done | still | lost | last
        self.moved = self.moved[1], moved
