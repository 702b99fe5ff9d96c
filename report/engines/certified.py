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
from sympy import Add, Expr, Mul, Piecewise, Symbol, ceiling, degree, diff, exp, false, floor, sift, sign
from sympy.logic.boolalg import Boolean

from ..column import Root
from ..plan.domain import defined, typed_symbols
from ..plan.lowering import lowered_column
from ..plan.nodes import Leaf, Plan, RootNode, RowSum
from ..sheet import Column, Sheet, SheetError
from .interval_functions import holds
from .intervals import Intervals
from .kernels import Enclosing
from .mpmath_intervals import differences, printed
from .numpy_code import kernel
from .roots import magnitude

__all__ = ["certified", "enclosing", "held", "slope", "typed_form"]

JUMPS = (floor, ceiling, sign, Piecewise)


def certified(sheet: Sheet, column: Column) -> bool:
    """Whether the form of a root changes sign at most once between its turning points, whatever the inputs.

    `column`: its rule is a :class:`~loopsheet.report.sheet.RootNode`.
    """
    rule = column.rule
    assert isinstance(rule, Root)
    if rule.turning and rule.turning_by:
        return True
    plan = lowered_column(sheet, column)
    node = plan.nodes[-1]
    assert isinstance(node, RootNode)
    types = typed_symbols(sheet, plan.leaves)
    form, low, high, *turning = (
        each.xreplace(types) for each in (node.form, node.low, node.high, *node.turning)
    )
    # The unknown may be called as its column is.
    named = set().union(*(each.free_symbols for each in (form, low, high, *turning))) - {node.unknown}
    cells = tuple(
        (types.get(s, s), *_span(sheet, plan.leaves[s])) for s in plan.leaves if types.get(s, s) in named
    )
    return any(
        decide(form, points, node.unknown, cells)
        for decide, points in ((_by_stretch, (low, *turning, high)), (_one_way, (low, high)))
    )


def _span(sheet: Sheet, leaf: Leaf) -> tuple[float, float]:
    """What a leaf may be."""
    if leaf.kind == "total":
        return -np.inf, np.inf
    if leaf.kind != "cells":
        return 1.0, np.inf
    if leaf.name in sheet.bounds:
        bounds = sheet.bounds[leaf.name]
        return -np.inf if bounds.low is None else bounds.low, np.inf if bounds.high is None else bounds.high
    return 0.0 if sheet[leaf.name].positive else -np.inf, np.inf


Cells = tuple[tuple[Symbol, float, float], ...]


@lru_cache(maxsize=256)
def _by_stretch(form: Expr, points: tuple[Expr, ...], unknown: Symbol, cells: Cells) -> bool:
    """Whether the slope has one sign between points that follow one another, by mpmath's intervals."""
    plain = Symbol(unknown.name, real=True)
    steepness, known = slope(form.xreplace({unknown: plain}), plain)
    compared = differences(known)
    if compared is None:
        return False
    names, spans = [symbol for symbol, *_ in cells], [[low, high] for _, low, high in cells]
    ends = printed(names, list(points))
    run = printed([*names, plain], [steepness, *(each for _, each in compared)])
    places = None if ends is None else ends(*spans)
    if run is None or places is None:
        return False
    if len(points) > 2 and not all(a.b < b.a for a, b in pairwise(places)):
        return False  # a point that may lie outside does not divide the interval
    for left, right in pairwise(places):
        # Where a turning point may be depends on the inputs: both neighbours are taken as far as they reach.
        found = run(*spans, [left.a, right.b])
        if found is None or not (found[0].a >= 0 or found[0].b <= 0):
            return False
        if not all(holds(kind, each) for (kind, _), each in zip(compared, found[1:], strict=True)):
            return False
    return True


@lru_cache(maxsize=256)
def _one_way(form: Expr, ends: tuple[Expr, ...], unknown: Symbol, cells: Cells) -> bool:
    """Whether the slope has one sign all over the interval, by assumptions or by intervals of arrays."""
    low, high = ends
    plain = Symbol(unknown.name, real=True, **({"positive": True} if low.is_nonnegative else {}))
    steepness, known = slope(form.xreplace({unknown: plain}), plain)
    if known == True and (steepness.is_nonnegative or steepness.is_nonpositive):  # noqa: E712 - sympy's true
        return True
    span = {symbol: Intervals([least], [most]) for symbol, least, most in cells}
    try:
        found_ends = _run([low, high], span)
        here = Intervals(found_ends[0].low, found_ends[1].high)
        found, sure = _run([steepness, held(known)], {**span, plain: here})
    except (KeyError, SheetError, TypeError):
        return False
    return bool(((found.low >= 0) | (found.high <= 0)).all() and (sure.low == 1).all())


def _run(expressions: list[Any], span: Mapping[Symbol, Intervals]) -> list[Intervals]:
    """Expressions over all that their symbols may be."""
    function = kernel(expressions)
    named = {symbol.name: each for symbol, each in span.items()}
    given: Any = [named[name] for name in function.arguments]
    with np.errstate(all="ignore"):
        return [Intervals.of(each) for each in function.run(*given, *(_AnyRows() for _ in function.totals))]


class _AnyRows:
    """Sums over one row or more."""

    def total(self, terms: Any) -> Intervals:
        terms = Intervals.of(terms)
        return Intervals(
            np.where(terms.low >= 0, terms.low, -np.inf), np.where(terms.high <= 0, terms.high, np.inf)
        )


def slope(form: Expr, unknown: Symbol) -> tuple[Expr, Boolean]:
    """The slope of a form, and where the form is sure to be continuous so that the slope tells its course.

    `unknown`: of which only is assumed what holds in the interval.
    """
    jumps = any(part.has(unknown) for part in form.atoms(*JUMPS))
    return diff(form, unknown), false if jumps else defined(form)


def held(condition: Boolean) -> Expr:
    """1 where a condition holds, else 0."""
    return Piecewise((1, condition), (0, True))


def typed_form(sheet: Sheet, plan: Plan, node: RootNode) -> tuple[Expr, Symbol]:
    """The form of a root, and its unknown, in symbols of which only is assumed what they may be."""
    plain = Symbol(node.unknown.name, real=True)
    form: Expr = node.form.xreplace({**typed_symbols(sheet, plan.leaves), node.unknown: plain})
    return form, plain


def enclosing(sheet: Sheet, plan: Plan, node: RootNode) -> Enclosing:
    """A function of what a root names and of its unknown: form, slope, whether that tells its course."""
    form, plain = typed_form(sheet, plan, node)
    for steepness, known in (slope(form, plain), (form, false)):
        try:
            run = kernel([form, steepness, held(known)])
        except SheetError:
            continue
        exponents = _exponents((form, steepness), plain) if known == True else None  # noqa: E712
        reach = None if exponents is None or len(run.totals) != 1 else kernel([*map(magnitude, exponents)])
        return Enclosing(run.arguments, run.totals, run.source, reach=reach)
    raise SheetError(f"{node.column.name}: NumPy cannot compute {form}", node.column.name)


def _exponents(expressions: tuple[Expr, ...], unknown: Symbol) -> list[Expr] | None:
    """Those of the terms of all sums, if each is at most four cells times one exponential of the unknown."""
    sums = sorted(set().union(*(each.atoms(RowSum) for each in expressions)), key=str)
    # With the sums put away nothing of the unknown may be left.
    hidden = {each: Symbol(f"sum_{n}") for n, each in enumerate(sums)}
    if not sums or any(each.xreplace(hidden).has(unknown) for each in expressions):
        return None
    found = []
    for terms, _ in (each.args for each in sums):
        powers, rest = sift(Mul.make_args(terms), lambda part: part.func is exp, binary=True)
        cells = [part.as_base_exp() for part in rest if not part.is_Number]
        exponent = Add(*(power.args[0] for power in powers))
        if (
            not all(cell.is_Symbol and times.is_Integer and times > 0 for cell, times in cells)
            or sum(times for _, times in cells) > 4
            or unknown in {cell for cell, _ in cells}
            or len(powers) > 1
            or not exponent.is_polynomial()
            or degree(exponent, unknown) > 1
        ):
            return None
        found.append(exponent)
    return found
