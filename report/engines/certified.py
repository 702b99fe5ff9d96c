"""How often a root's equation can change its sign, for all inputs at once: by its slope or by proof.

A slope of one sign is seen by sympy's assumptions or by interval arithmetic over everything that the cells
may be. Where neither sees it, every row is decided alone (:mod:`~loopsheet.report.engines.isolation`).
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
from sympy import Basic, Expr, Indexed, Piecewise, Symbol, ceiling, diff, false, floor, sign
from sympy.logic.boolalg import Boolean

from ..intervals import Intervals
from ..sheet import Axis, Column, Reference, Root, Sheet, SheetError, name_of
from .domain import defined, typed
from .mpmath_intervals import differences, holds, printed
from .numpy_code import Kernel, Writer

__all__ = ["certified", "enclosing", "held", "slope"]

JUMPS = (floor, ceiling, sign, Piecewise)


def certified(sheet: Sheet, column: Column) -> bool:
    """Whether the form of a root changes sign at most once between its turning points, whatever the inputs.

    Parameters
    ----------
    sheet : Sheet
    column : Column
        Its rule is a :class:`~loopsheet.report.sheet.Root`.
    """
    rule = column.rule
    assert isinstance(rule, Root)
    if rule.turning and rule.turning_by:
        return True
    cells = tuple((r, *_span(sheet, r)) for r in sheet.named(column))
    sizes = tuple((Reference(size), 1.0, np.inf) for size in sheet.sizes)
    ordinals = {s for axis in sheet.axes for s in axis.ordinals}
    counted = tuple((Reference(s), 1.0, np.inf) for s in sorted(ordinals, key=str))
    form = typed(sheet, rule.expression)
    every, indices = (*cells, *sizes, *counted), tuple(sheet.indices.items())
    ends, turning = (rule.low, rule.high), tuple(rule.turning)
    return any(
        decide(form, tuple(typed(sheet, point) for point in points), rule.unknown, every, indices)
        for decide, points in ((_by_stretch, (ends[0], *turning, ends[1])), (_one_way, ends))
    )


def _span(sheet: Sheet, reference: Reference) -> tuple[float, float]:
    """What a cell may be."""
    name = name_of(reference.cell)
    if name in sheet.bounds:
        bounds = sheet.bounds[name]
        return -np.inf if bounds.low is None else bounds.low, np.inf if bounds.high is None else bounds.high
    return 0.0 if sheet[name].positive else -np.inf, np.inf


Cells = tuple[tuple[Reference, float, float], ...]


@lru_cache(maxsize=256)
def _by_stretch(form: Expr, points: tuple[Expr, ...], unknown: Symbol, cells: Cells, _: Any) -> bool:
    """Whether the slope has one sign between points that follow one another, by mpmath's intervals."""
    plain = Symbol(unknown.name, real=True)
    steepness, known = slope(form.xreplace({unknown: plain}), plain)
    compared = differences(known)
    named = {r.place[0]: (low, high) for r, low, high in cells if r.over is None}
    inside = {cell: Symbol(f"cell_{n}") for n, cell in enumerate(sorted(_cells(steepness, points), key=str))}
    if compared is None or not {str(cell) for cell in inside} - {plain.name} <= named.keys():
        return False
    given = {symbol: named[str(cell)] for cell, symbol in inside.items() if cell != plain}
    ends = printed(list(given), [point.xreplace(inside) for point in points])
    bodies = [each.xreplace(inside) for each in (steepness, *(each for _, each in compared))]
    run = printed([*given, inside.get(plain, plain)], bodies)
    places = None if ends is None else ends(*map(list, given.values()))
    if run is None or places is None:
        return False
    if len(points) > 2 and not all(a.b < b.a for a, b in pairwise(places)):
        return False  # a point that may lie outside does not divide the interval
    for left, right in pairwise(places):
        found = run(*map(list, given.values()), [left.a, right.b])
        if found is None or not (found[0].a >= 0 or found[0].b <= 0):
            return False
        if not all(holds(kind, each) for (kind, _), each in zip(compared, found[1:], strict=True)):
            return False
    return True


def _cells(*expressions: Any) -> set[Basic]:
    """The cells, and the unknown, that expressions name."""
    found: set[Basic] = set()
    for each in expressions:
        for expression in each if isinstance(each, tuple) else (each,):
            cells = expression.atoms(Indexed)
            inner = set().union(*(cell.free_symbols for cell in cells))
            found |= cells | (expression.free_symbols - inner)
    return found


@lru_cache(maxsize=256)
def _one_way(form: Expr, ends: tuple[Expr, ...], unknown: Symbol, cells: Cells, indices: Any) -> bool:
    """Whether the slope has one sign all over the interval, by assumptions or by intervals of arrays."""
    low, high = ends
    plain = Symbol(unknown.name, real=True, **({"positive": True} if low.is_nonnegative else {}))
    steepness, known = slope(form.xreplace({unknown: plain}), plain)
    if known == True and (steepness.is_nonnegative or steepness.is_nonpositive):  # noqa: E712 - sympy's true
        return True
    span = {r.place: Intervals([least], [most]) for r, least, most in cells}
    try:
        found_ends = _run([low, high], span, indices)
        here = Intervals(found_ends[0].low, found_ends[1].high)
        found, sure = _run([steepness, held(known)], {**span, (plain.name, None): here}, indices)
    except (KeyError, SheetError, TypeError):
        return False
    return bool(((found.low >= 0) | (found.high <= 0)).all() and (sure.low == 1).all())


def _run(
    expressions: list[Any], span: Mapping[tuple[str, Axis | None], Intervals], indices: Any
) -> list[Intervals]:
    """Expressions over all that their cells may be."""
    writer = Writer(dict(indices))
    kernel = writer.kernel([writer.plain(expression) for expression in expressions])
    given: Any = [span[r.place] for r in kernel.references]
    with np.errstate(all="ignore"):
        return [Intervals.of(each) for each in kernel.run(*given, *(_AnyRows() for _ in kernel.totals))]


class _AnyRows:
    """Sums over one row or more."""

    def total(self, terms: Any) -> Intervals:
        terms = Intervals.of(terms)
        return Intervals(
            np.where(terms.low >= 0, terms.low, -np.inf), np.where(terms.high <= 0, terms.high, np.inf)
        )


def slope(form: Expr, unknown: Symbol) -> tuple[Expr, Boolean]:
    """The slope of a form, and where the form is sure to be continuous so that the slope tells its course.

    Parameters
    ----------
    form : Expr
    unknown : Symbol
        Of which only is assumed what holds in the interval.
    """
    jumps = any(part.has(unknown) for part in form.atoms(*JUMPS))
    return diff(form, unknown), false if jumps else defined(form)


def held(condition: Boolean) -> Expr:
    """1 where a condition holds, else 0."""
    return Piecewise((1, condition), (0, True))


def enclosing(sheet: Sheet, column: Column) -> Kernel:
    """A function of a root's cells and unknown: the form, its slope and whether the slope tells its course.

    Parameters
    ----------
    sheet : Sheet
    column : Column
        Its rule is a :class:`~loopsheet.report.sheet.Root`.
    """
    rule = column.rule
    assert isinstance(rule, Root)
    plain = Symbol(rule.unknown.name, real=True)
    form = typed(sheet, rule.expression).xreplace({rule.unknown: plain})
    for steepness, known in (slope(form, plain), (form, false)):
        writer = Writer(sheet.indices)
        try:
            return writer.kernel([writer.plain(each) for each in (form, steepness, held(known))])
        except SheetError:
            continue
    raise SheetError(f"{column.name}: NumPy cannot compute {form}")
