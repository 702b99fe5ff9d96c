"""What rounding may do to every cell: all roundings of a sheet, each times what it does to the cell.

To first order the error of a cell is at most eps times the sum, over all cells and sums s that it rests on,
of |dc/ds| R_s, with the total derivative dc/ds along all ways from s to c: what cancels between two ways
cancels here too. This bound over |c|, at least 1, is the condition of the cell.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ..cells.layout import Layout, precedents
from ..cells.values import Status, Values, rows_kept
from ..engines.numpy import Program, parts, program_texts
from ..plan.derivatives import Local, Slope, derivatives, with_unknowns
from ..plan.kept import as_data, of_data, of_sheet
from ..result.agreement import LIMIT
from ..sheet import Sheet

__all__ = ["Made", "bounds"]

Array = NDArray[np.float64]
EPS = float(np.finfo(float).eps)
Masks = Mapping[str, NDArray[np.bool_]]


def bounds(
    sheet: Sheet, layouts: Mapping[str, Layout], value: Mapping[str, Array], made: Made | None = None
) -> dict[str, Array]:
    """Bound the rounding error of every cell.

    Parameters
    ----------
    sheet : Sheet
    layouts : mapping of axis name to Layout
    value : mapping of column name to float array (rows,)
        All columns in SI; NaN where a cell has no value.
    made : Made, optional
        Of the sheet, if it was made before.

    Returns
    -------
    mapping of column name to float array (rows,)
        In SI and units of eps, at least the cell's own size; infinite where nothing is known, NaN where
        the cell has no value.
    """
    made = made or Made.of(sheet)
    status = {name: np.where(np.isnan(each), Status.INPUT, Status.OK) for name, each in value.items()}
    values = Values(sheet, layouts, value, status)
    kept = {
        column.name: rows_kept(precedents(sheet, layouts, column), layouts, status)
        for column in sheet.columns
        if sheet.summed_axes(column)
    }
    return _Spread(values, parts(made.program, values), made.nodes, kept).bounds()


@dataclass(frozen=True)
class Made:
    """The derivatives of a sheet: its nodes, each after those that it names, and what computes them."""

    nodes: tuple[Local, ...]
    program: Program

    @classmethod
    def of(cls, sheet: Sheet) -> Made:
        """Make them, or take them as they were made before."""

        def make() -> dict[str, Any]:
            found = derivatives(sheet)
            texts = program_texts(with_unknowns(sheet, found.again), found.plan)
            return {"nodes": as_data(found.nodes), "again": found.again, "program": texts}

        told = of_sheet(sheet, "derivatives", (), make)
        nodes = of_data(told["nodes"], tuple[Local, ...])
        return cls(nodes, Program.of_texts(with_unknowns(sheet, told["again"]), told["program"]))


EXPANDED = 1 << 24
"""Up to so many numbers, what scalars do to a column's rows is added up source by source; beyond, their
bounds are added, which is never less."""


class _Spread:
    """The total derivatives of every node, in the sheet's order, by all roundings there are.

    Those of a row are kept in two parts: `direct`, by ways that pass no scalar, has few entries a row;
    `scalars` has the derivatives by the scalars, which rest on almost everything.
    """

    def __init__(
        self, found: Values, parts: Mapping[str, Array], nodes: Sequence[Local], kept: Mapping[str, Masks]
    ) -> None:
        self.sheet, self.found, self.parts, self.nodes, self.kept = found.sheet, found, parts, nodes, kept
        self.sizes = {node.name: self.size(node) for node in nodes}
        ends = np.cumsum(list(self.sizes.values())).tolist()
        self.start = {name: end - self.sizes[name] for name, end in zip(self.sizes, ends, strict=True)}
        self.sources = ends[-1] if ends else 0
        self.rounding = np.zeros(self.sources)
        alone = [node.name for node in nodes if node.axis is None]
        self.scalar = {name: n for n, name in enumerate(alone)}
        self.whole = np.zeros((len(alone), self.sources))
        self.direct: dict[str, Any] = {}
        self.scalars: dict[str, Any] = {}

    def size(self, node: Local) -> int:
        return 1 if node.axis is None else self.found.layouts[node.axis].size

    def bounds(self) -> dict[str, Array]:
        found = {}
        with np.errstate(all="ignore"):  # a derivative beyond all doubles leaves nothing known of the cell
            for node in self.nodes:
                self.spread(node)
            of_scalars = self.weighed(self.whole)
            for name in self.sheet.by_name:
                own, total = np.abs(self.found.value[name]), self.total(name, of_scalars)
                found[name] = np.where(np.isnan(own), np.nan, np.maximum(total, own))
        return found

    def total(self, name: str, of_scalars: Array) -> Array:
        """All roundings times what they do to each row of a column."""
        if name in self.scalar:
            return of_scalars[[self.scalar[name]]]
        direct, scalars = self.direct[name], self.scalars[name]
        if scalars.nnz and self.sizes[name] * self.sources <= EXPANDED:
            return self.weighed(direct.toarray() + scalars @ self.whole)
        return self.weighed(direct) + _weighed(scalars, of_scalars)

    def weighed(self, derivatives: Any) -> Array:
        """The sizes of derivatives times all roundings."""
        return _weighed(derivatives, self.rounding)

    def spread(self, node: Local) -> None:
        """The derivatives of one node: by its own rounding, and by what it names times its slopes."""
        size, start = self.sizes[node.name], self.start[node.name]
        rounding = self.parts[node.rounding].copy()
        alive = node.over is not None or ~np.isnan(self.found.value[node.name])
        rows = np.arange(size)
        direct = sparse.csr_array((np.ones(size), (rows, start + rows)), shape=(size, self.sources))
        scalars = sparse.csr_array((size, len(self.scalar)))
        for slope in node.slopes:
            values, columns = self.parts[slope.value], self.rows_named(slope)
            by = slope.by
            positions = np.arange(values.size)
            if node.over is not None:
                values, positions = np.where(self.summed(node), values, 0.0), np.zeros_like(positions)
            if node.median:
                values = np.where((share := self.share(node, by, columns)) > 0, share * values, 0.0)
            rounding[positions[np.isnan(values)]] = np.nan
            entries = np.nan_to_num(values)
            if by in self.scalar:
                columns = np.full_like(columns, self.scalar[by])
                scalars += sparse.csr_array((entries, (positions, columns)), shape=scalars.shape)
            else:
                step = sparse.csr_array((entries, (positions, columns)), shape=(size, self.sizes[by]))
                direct += step @ self.direct[by]
                scalars += step @ self.scalars[by]
        # What has no value has no error; a value of which a slope is unknown may be wrong by anything.
        rounding = np.where(np.isfinite(rounding), rounding, np.inf)
        self.rounding[start : start + size] = np.where(alive, rounding, 0.0)
        if node.name in self.scalar:
            self.whole[self.scalar[node.name]] = (direct.toarray() + scalars @ self.whole)[0]
        else:
            self.direct[node.name], self.scalars[node.name] = direct, scalars

    def rows_named(self, slope: Slope) -> NDArray[np.intp]:
        """The row of what a slope is by, for each row of the slope."""
        number = self.parts[slope.value].size
        if slope.axis is None:
            return np.zeros(number, dtype=np.intp)
        if slope.index is None:
            return np.arange(number)
        return self.found.layouts[slope.axis].named[slope.index]

    def share(self, node: Local, name: str, rows: NDArray[np.intp]) -> Array:
        """How much of the change of each row a median makes: that of the middle, or half of two there.

        A row that rounding may exchange with one in the middle counts as that one does.
        """
        value = self.found.value[name][rows]
        room = LIMIT * EPS * self.total(name, self.weighed(self.whole))[rows]
        ordered = np.sort(value[self.summed(node)])
        middle = ordered[[(ordered.size - 1) // 2, ordered.size // 2]] if ordered.size else ordered
        found: Array = sum((np.abs(value - one) <= room) / 2 for one in middle.tolist()) + np.zeros(
            value.size
        )
        return np.where(self.summed(node), found, 0.0)

    def summed(self, node: Local) -> NDArray[np.bool_]:
        """The rows that a sum runs over."""
        assert node.over is not None
        everything = np.ones(self.found.layouts[node.over].size, dtype=bool)
        return self.kept[node.of].get(node.over, everything)


def _weighed(derivatives: Any, errors: Array) -> Array:
    """The sizes of derivatives times errors; an infinite error counts only where something rests on it."""
    sizes, known = abs(derivatives), np.isfinite(errors)
    total: Array = sizes @ np.where(known, errors, 0.0)
    return np.where((sizes @ (~known).astype(float) > 0) | ~np.isfinite(total), np.inf, total)
