"""A sheet beside a point around which every cell is certain to have a value: for draws by the million.

Where it is known for a whole box of given cells that all formulas have a value and all equations one root,
nothing is asked of single rows, and nothing is computed but what the values of one column rest on. A root is
sought from where it lies for the given cells of the point, along its derivatives: one step of fourth order,
which is believed if Newton's leaves it alone where it was longest. What a few steps more do not bring to
rounding, within what encloses the root for all of the box, is told: it is to be computed as any sheet is.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import elementary
from .intervals import Intervals
from .kernels import SAME, Array
from .numpy import Laid, Numbered, Program
from .numpy_root import RootProgram, RootRows
from .numpy_rows import Kept, in_groups

Mask = NDArray[np.bool_]

BESIDE: Any = ModuleType("numpy")
vars(BESIDE).update(vars(SAME), exp=elementary.exp_beside, log=elementary.log_beside)
"""What a program calls here: a batch of what lies close together takes fewer operations."""
BLOCK = 1 << 16
"""How many cells the widest column has, at most, of what is computed at a time: more do not stay in the
cache, and of fewer calling takes longer than computing."""
STEP = 2.0**-20
"""What is changed, relatively, to see how a root moves: its steps begin there, and nothing rests on it."""
ENOUGH = 2.0**-40
"""How much of a root, relatively, may be left to find: far less than draws can tell."""


@dataclass(frozen=True)
class _Guess:
    """About where a root is, by the constants of its equation, and between what its value certainly is."""

    base: Array
    slopes: Sequence[Array]
    value: Intervals

    @classmethod
    def of(cls, program: RootProgram, unknown: Array, constants: Sequence[Array], value: Intervals) -> _Guess:
        """That of constants near to some."""

        def change(n: int) -> Array:
            """Of the equation, by the unknown or a constant."""
            at = [unknown, *constants]
            by = STEP * np.where(at[n] == 0, 1.0, np.abs(at[n]))
            up, down = (program.at(*at[:n], at[n] + way * by, *at[n + 1 :])[0] for way in (1, -1))
            return np.asarray((up - down) / (2 * by))

        steepness = change(0)
        slopes = [-change(n) / steepness for n in range(1, len(constants) + 1)]
        moved = sum(slope * own for slope, own in zip(slopes, constants, strict=True))
        return cls(unknown - moved, slopes, value)

    def at(self, constants: Sequence[Array]) -> Array:
        """Of other constants."""
        found = self.base
        for slope, own in zip(self.slopes, constants, strict=True):
            found = found + slope * own
        return found


class Beside:
    """The cells of a sheet for batches of given cells in a box.

    Parameters
    ----------
    program : Program
        With the functions :data:`BESIDE`.
    laid : Laid
        Its sheet over the rows.
    point : mapping of column name to float array (rows,)
        The given columns in SI, somewhere in the box.
    cells : mapping of column name to Intervals (rows,)
        What every column is for all of the box; all cells are certain to have a value.
    """

    def __init__(
        self, program: Program, laid: Laid, point: Mapping[str, Array], cells: Mapping[str, Intervals]
    ) -> None:
        self.program, self.laid, self.cells = program, laid, cells
        self.point = {name: own[None] for name, own in point.items()}
        self.guesses: dict[str, _Guess] = {}
        self._run(self.point)

    @staticmethod
    def serves(program: Program) -> bool:
        """Whether it can compute the sheet of a program: no loops, and no equations of sums."""
        return not program.loops and not any(root.totals for root in program.roots.values())

    def column(self, name: str, row: int | list[int], batch: Mapping[str, Array]) -> tuple[Array, Mask]:
        """A row of a column, or some, for a batch, and of which of its elements it is known (batch,).

        `batch` (mapping of column name to float array (batch, rows)): given columns that are others than in
        the point; best in memory row by row.
        """
        (size,) = {len(each) for each in batch.values()}
        found, known = [], []
        widest = max(map(self.laid.size, self.program.sheet.columns))
        for some in np.array_split(np.arange(size), math.ceil(size * widest / BLOCK)):
            block = slice(some[0], some[-1] + 1)
            rows = self._run({**self.point, **{name: each[block] for name, each in batch.items()}})
            own = rows.value[name][..., row]
            found.append(np.broadcast_to(own, (len(some), *own.shape[1:])))
            known.append(np.broadcast_to(rows.known, len(some)))
        return np.concatenate(found), np.concatenate(known)

    def _run(self, data: Mapping[str, Array]) -> _Rows:
        rows = _Rows(self, data)
        with np.errstate(all="ignore"):
            self.program.function(rows)
        return rows


class _Every(Kept):
    """Rows of which each holds a batch as a whole in memory."""

    def total(self, terms: Any) -> Any:
        """The sum of all rows (..., 1), one added after the other."""
        return self._every(terms).sum(axis=-1, keepdims=True)


class _Rows(Numbered):
    """What the printed function calls."""

    def __init__(self, beside: Beside, data: Mapping[str, Array]) -> None:
        self.beside, self.data, self.laid = beside, data, beside.laid
        self.value: dict[str, Array] = {}
        self.known: Mask = np.ones(1, dtype=bool)

    def rows(self, name: str, axis: str, index: str) -> Array:
        """The cells of a column that the rows of an axis name by an index."""
        # Row by row in memory: then a batch of one row is copied as a whole.
        return self.value[name].T.take(self.laid.layouts[axis].rows[index], axis=0).T

    def kept(self, _: str, axis: str) -> Any:
        """All rows of an axis."""
        layout = self.laid.layouts[axis]
        return in_groups(_Every(np.ones(layout.size, dtype=bool)), layout)

    def given(self, name: str, value: Array, _: Any = True) -> Array:
        """The data of a column: what is outside the box is not known."""
        self._within(value, self.beside.cells[name])
        self.value[name] = value
        return value

    def formula(self, name: str, value: Any, *_: Any) -> Array:
        """A column by its formula."""
        size = (self.laid.size(self.beside.program.sheet[name]),)
        if np.shape(value)[-1:] != size:
            value = np.broadcast_to(value, np.broadcast_shapes(np.shape(value), size))
        self.value[name] = value
        return self.value[name]

    def root(self, name: str, arguments: Sequence[Array], requires: Sequence[Any] = ()) -> Array:
        """A column by its root."""
        program = self.beside.program.roots[name]
        named = dict(zip(program.arguments, arguments, strict=True))
        found = program.constants.run(*(named[each] for each in program.constants.arguments))
        constants = [np.atleast_1d(np.asarray(each, dtype=np.float64)) for each in found]
        if name not in self.beside.guesses:
            size = self.laid.size(self.beside.program.sheet[name])
            unknown = program.solve(named, self.laid.every, (1, size)).unknown
            own = self.beside.cells[name]
            self.beside.guesses[name] = _Guess.of(program, unknown, constants, own)
        guess = self.beside.guesses[name]
        start = guess.at(constants)
        here = start - (back := program.step(start, *constants)[1])
        if not _led(program, here, back, constants):
            here, settled = RootRows(program, constants, (), start.shape).unwatched(start)
            self.known = self.known & settled.all(axis=-1)
        (value,) = program.value(here, *constants)
        self._within(value, guess.value)
        self.value[name] = value
        return value

    def _within(self, value: Array, ends: Intervals) -> None:
        """What is outside of what encloses the rows is not known."""
        if not ((value.min(axis=0) >= ends.low).all() and (value.max(axis=0) <= ends.high).all()):
            self.known = self.known & ((value >= ends.low) & (value <= ends.high)).all(axis=-1)


def _led(program: RootProgram, here: Array, back: Array, constants: Sequence[Array]) -> bool:
    """Whether a step led all of a batch to a root, by Newton's from where it was the longest of a row."""
    rows = np.arange(here.shape[-1])
    longest = np.abs(back).argmax(axis=0), rows
    at, *own = (np.broadcast_to(each, here.shape)[longest] for each in (here, *constants))
    _, left = program.newton(at, *own)
    return bool((np.abs(left) <= ENOUGH * np.abs(at)).all())
