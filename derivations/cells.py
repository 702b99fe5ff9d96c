"""Cells of columns: which are plain symbols in a proof, which stay rows of one column, and which exist.

Algebra on plain symbols is faster, and no cell then shares its name with a column. But a column that is
summed holds each of its cells: ``X[1]``, ``X[n]`` and the ``X[q]`` under a sum are one set of data.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from sympy import Expr, Indexed, IndexedBase, Integer, Integral, Or, Symbol

from .reductions import REDUCTIONS


def running(expressions: Iterable[Any]) -> list[tuple[Any, ...]]:
    """The limits of all reductions and integrals: what runs, then from where to where."""
    return [limit for e in expressions for loop in e.atoms(Integral, *REDUCTIONS) for limit in loop.limits]


@dataclass(frozen=True)
class Cells:
    """Plain forms of the cells of some expressions."""

    names: dict[Any, Any]
    """What each plain form stands for: a cell, or the base of a column."""
    flat: dict[Indexed, Expr]
    """The plain form of each cell: a symbol, or a row of a column that is kept together."""
    lengths: dict[Any, tuple[Expr, ...]]
    """Of each column that is summed, by its base: how many rows it has, as far as the sums say."""

    @classmethod
    def of(cls, expressions: list[Any]) -> Cells:
        """Find the cells of expressions that belong together."""
        bound = {limit[0] for limit in running(expressions)}
        columns: dict[Any, set[Indexed]] = {}
        for cell in _cells(expressions):
            columns.setdefault(cell.base.label, set()).add(cell)
        names: dict[Any, Any] = {}
        flat: dict[Indexed, Expr] = {}
        for label, cells in columns.items():
            together = any(cell.free_symbols & bound for cell in cells) or (
                len(cells) > 1 and not all(index.is_Integer for cell in cells for index in cell.indices)
            )
            column = Symbol(f"{label}[]", **label.assumptions0)
            for cell in cells:
                inside = ",".join(map(str, cell.indices))
                plain = (
                    IndexedBase(column)[cell.indices]
                    if together
                    else Symbol(f"{label}[{inside}]", **label.assumptions0)
                )
                flat[cell], names[plain] = plain, cell
            if together:
                names[column] = label
        return cls(names, flat, _lengths(expressions))

    def plain(self, expression: Any) -> Any:
        """An expression with every cell in its plain form."""
        return expression.xreplace(self.flat)

    def exist(self, expressions: Iterable[Any]) -> Iterator[Any]:
        """Where the rows exist that are named outside of sums: from 1 to the last that is summed."""
        expressions = list(expressions)
        bound = {limit[0] for limit in running(expressions)}
        for cell in _cells(expressions):
            row, *more = cell.indices
            if more or cell.free_symbols & bound or not isinstance(self.flat.get(cell), Indexed):
                continue
            lengths = self.lengths.get(cell.base.label, ())
            yield from _reached(Integer(1), (row,))
            # A column may be longer than what is summed of it; the sums do not bound its rows then.
            yield from _reached(row, lengths)


def _reached(row: Expr, ends: tuple[Expr, ...]) -> Iterator[Any]:
    """That some end is not before a row, unless it is known of one or of none."""
    margins = {end: end - row + 1 for end in ends}
    open_ends = [end for end, margin in margins.items() if not margin.is_nonpositive]
    if open_ends and not any(margin.is_positive for margin in margins.values()):
        yield Or(*(end >= row for end in open_ends))


def _cells(expressions: Iterable[Any]) -> list[Indexed]:
    return sorted({cell for e in expressions for cell in e.atoms(Indexed)}, key=str)


def _lengths(expressions: list[Any]) -> dict[Any, tuple[Expr, ...]]:
    """For each column under a sum, the ends of its sums, without those that another one reaches or passes."""
    found: dict[Any, list[Expr]] = {}
    bound = {limit[0] for limit in running(expressions)}
    for total in (total for e in expressions for total in e.atoms(*REDUCTIONS)):
        for cell in total.function.atoms(Indexed):
            for variable, *ends in total.limits:
                end = ends[-1] + cell.indices[0] - variable
                if not end.free_symbols & bound:
                    found.setdefault(cell.base.label, []).append(end)
    return {
        label: tuple(
            sorted(
                {
                    end
                    for end in ends
                    if not isinstance(end, Integer)
                    and not any(other != end and (other - end).is_nonnegative for other in ends)
                },
                key=str,
            )
        )
        for label, ends in found.items()
    }
