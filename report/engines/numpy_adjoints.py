"""Adjoints as numbers: what the cells of a workbook show before a spreadsheet has recalculated them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from ..cells.layout import precedents
from ..cells.values import Status, Values, rows_kept
from ..plan.adjoints import Adjoint, Share, Solution, Term
from ..plan.order import Word, places
from ..plan.slopes import NodeDerivatives
from .kernels import Array


def computed(
    quantities: Iterable[Adjoint],
    nodes: Mapping[str, NodeDerivatives],
    parts: Mapping[str, Array],
    values: Values,
) -> dict[str, Array]:
    """Compute adjoints.

    Parameters
    ----------
    quantities : iterable of Adjoint
        Each after those that it names.
    nodes : mapping of str to NodeDerivatives
        Totals by order of which a share is asked.
    parts : mapping of str to array (rows,)
        Of the derivatives.
    values : Values
        All columns, without a batch.

    Returns
    -------
    mapping of str to array (rows,)
        By the names of the quantities.
    """
    run = _Adding(nodes, parts, values)
    with np.errstate(all="ignore"):  # a derivative may be beyond all doubles
        for quantity in quantities:
            run.found[quantity.name] = run.of(quantity)
    return run.found


class _Adding:
    def __init__(
        self, nodes: Mapping[str, NodeDerivatives], parts: Mapping[str, Array], values: Values
    ) -> None:
        self.nodes, self.parts, self.values = nodes, parts, values
        self.layouts = values.layouts
        self.found: dict[str, Array] = {}
        self.masks: dict[tuple[str, str], NDArray[np.bool_]] = {}

    def size(self, axis: str | None) -> int:
        return 1 if axis is None else self.layouts[axis].size

    def of(self, quantity: Adjoint) -> Array:
        if quantity.solved:
            return self.solved(quantity.solved, self.size(quantity.axis))
        if quantity.share:
            return self.share(quantity.share)
        found: Array = np.full(self.size(quantity.axis), quantity.plus)
        for term in quantity.terms:
            self.put(found, quantity, term)
        return found

    def put(self, found: Array, quantity: Adjoint, term: Term) -> None:
        """Add a term."""
        by = self.found[term.by] if term.by else np.ones(1)
        if term.group is not None and term.rows is not None:
            by = by[self.layouts[term.rows].group]
        product = by * np.ones(self.size(term.rows))
        for name in term.factors:
            product = product * (self.found[name] if name in self.found else self.parts[name])
        if term.of:
            product = np.where(self.counts(term), product, 0.0)
        if quantity.axis == term.rows:
            found += product
        elif quantity.axis is None:
            found += product.sum()
        else:
            assert term.axis is not None
            np.add.at(found, self.layouts[term.axis].rows[term.index or ""], product)

    def counts(self, term: Term) -> NDArray[np.bool_]:
        """The rows that count."""
        if not term.over:
            ok: NDArray[np.bool_] = self.values.status[term.of] == Status.OK
            return ok
        assert term.rows is not None
        return self.kept(term.of, term.rows)

    def kept(self, name: str, axis: str) -> NDArray[np.bool_]:
        """The rows that the sums of a column take."""
        if (name, axis) not in self.masks:
            column = self.values.sheet[name]
            named = precedents(self.values.sheet, self.layouts, column)
            kept = rows_kept(named, self.layouts, self.values.status)
            self.masks[name, axis] = kept.get(axis, np.ones(self.size(axis), dtype=bool))
        return self.masks[name, axis]

    def share(self, share: Share) -> Array:
        """How much of the change of each row counts by its place: rows with one value share it."""
        node = self.nodes[share.total]
        assert node.over is not None
        (slope,) = node.slopes
        value = self.values.value[slope.by]
        if slope.index is not None:
            value = value[self.layouts[node.over].rows[slope.index]]
        word, kept = node.word or "sum", self.kept(node.of, node.over)
        layout = self.layouts[node.over]
        if share.word == "value":
            return np.array([_place(value[rows][kept[rows]], word, share.place) for rows in layout.groups])
        one, *_ = taken = [self.found[name] for name in share.taken]
        if share.word == "number":
            return np.array([
                np.sum(kept[rows] & (value[rows] == own))
                for rows, own in zip(layout.groups, one, strict=True)
            ], dtype=np.float64)  # fmt: skip
        taken = [own[layout.group] for own in taken]
        found: Array = np.zeros(value.shape)
        for one, number in zip(taken[::2], taken[1::2], strict=True):
            found += np.where(kept & (value == one), 1 / number, 0.0)
        return found / (len(share.taken) / 2)

    def solved(self, solved: Solution, size: int) -> Array:
        """A place in the solution, for each row."""
        count = len(solved.right)
        left, right = np.zeros((size, count, count)), np.zeros((size, count, 1))
        for n, name in enumerate(solved.right):
            right[:, n, 0] = self.found[name]
            for m, value in enumerate(solved.matrix[n]):
                left[:, m, n] = (n == m) - (self.found[value] if value else 0.0)
        good = np.isfinite(left).all(axis=(1, 2)) & np.isfinite(right).all(axis=(1, 2))
        found: Array = np.full(size, np.nan)
        with suppress(np.linalg.LinAlgError):
            found[good] = np.linalg.solve(left[good], right[good])[:, solved.place, 0]
        return found


def _place(values: Array, word: Word, place: int) -> float:
    """What stands in a place that a total by order takes; NaN if there is none."""
    ordered = np.sort(values)
    return float(ordered[places(word, ordered.size)[place]]) if ordered.size else np.nan
