"""How often a root's equation can change its sign, for all inputs at once: by its slope or by proof.

A slope of one sign is seen by sympy's assumptions or by interval arithmetic over everything that the cells
may be. Where neither sees it, every row is decided alone (:mod:`~loopsheet.report.engines.isolation`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache
from itertools import pairwise
from math import comb, prod
from typing import Any

import numpy as np
import sympy as sp
from sympy.logic.boolalg import Boolean

from ...derivations.differentiated import differentiated
from ..column import Root
from ..named import name_of
from ..plan.domain import defined, typed_symbols
from ..plan.lowering import lowered_column
from ..plan.nodes import Leaf, Plan, RootNode, RowSum
from ..sheet import Column, Sheet, SheetError
from .interval_functions import holds
from .intervals import Intervals
from .kernels import Enclosing, Kernel
from .mpmath_intervals import differences, printed
from .numpy_code import kernel
from .roots import magnitude

JUMPS = (sp.floor, sp.ceiling, sp.sign, sp.Piecewise)
_HALVINGS, _PARTS = 16, 64
"""How often an interval of the unknown is halved, and how many parts may be open after that."""
_LARGEST = 200
"""Terms of a slope that is taken apart into factors, which takes long of many."""


def certified(sheet: Sheet, column: Column) -> bool:
    """Whether the form of a root changes sign at most once between its turning points, whatever the inputs.

    `column`: its rule is a :class:`~loopsheet.report.column.Root`.
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
    needed = _needed(column)
    cells = tuple(
        (types.get(s, s), *_within(_span(sheet, leaf), needed.get(leaf.name, ())))
        for s, leaf in plan.leaves.items()
        if types.get(s, s) in named
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


def _needed(column: Column) -> dict[str, list[sp.Rel]]:
    """What a column requires of single cells: that they are above or below a number."""
    found: dict[str, list[sp.Rel]] = {}
    for condition, _ in column.requires:
        single = isinstance(condition, sp.Rel) and isinstance(condition.lhs, (sp.Symbol, sp.Indexed))
        if single and condition.rhs.is_number:
            found.setdefault(name_of(condition.lhs), []).append(condition)
    return found


def _within(span: tuple[float, float], needed: Iterable[sp.Rel]) -> tuple[float, float]:
    low, high = span
    for each in needed:
        if each.rel_op in (">", ">="):
            low = max(low, float(each.rhs))
        elif each.rel_op in ("<", "<="):
            high = min(high, float(each.rhs))
    return low, high


Cells = tuple[tuple[sp.Symbol, float, float], ...]


@lru_cache(maxsize=256)
def _by_stretch(form: sp.Expr, points: tuple[sp.Expr, ...], unknown: sp.Symbol, cells: Cells) -> bool:
    """Whether the slope has one sign between points that follow one another, by mpmath's intervals."""
    plain = sp.Symbol(unknown.name, real=True)
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
def _one_way(form: sp.Expr, ends: tuple[sp.Expr, ...], unknown: sp.Symbol, cells: Cells) -> bool:
    """Whether the slope has one sign all over the interval, by assumptions or by intervals of arrays.

    Also as a product of factors, by the way from the lower end: 1 - exp(-q)/e of q > -log(e) is 1 - exp(-s).
    """
    low, high = ends
    plain = sp.Symbol(unknown.name, real=True, **({"positive": True} if low.is_nonnegative else {}))
    steepness, known = slope(form.xreplace({unknown: plain}), plain)
    if known == True and (steepness.is_nonnegative or steepness.is_nonpositive):  # noqa: E712 - sympy's true
        return True
    span = {symbol: Intervals([least], [most]) for symbol, least, most in cells}
    if _is_of_one_sign(steepness, known, plain, ends, span):
        return True
    if steepness.has(RowSum):
        return False
    way = sp.Symbol(unknown.name, positive=True)
    along = sp.together(sp.expand_power_exp(steepness.xreplace({plain: low + way})))
    if _terms(sp.fraction(along)[0]) > _LARGEST:
        return False
    open_ones = [
        base
        for each in sp.Mul.make_args(sp.factor(along))
        for base, power in (each.as_base_exp(),)
        if not (each.is_nonnegative or each.is_nonpositive or power.is_even)
    ]
    continuous, whole = known.xreplace({plain: low + way}), (sp.Integer(0), high - low)
    return all(_is_of_one_sign(each, continuous, way, whole, span) for each in (*open_ones, sp.Integer(1)))


def _is_of_one_sign(
    steepness: sp.Expr,
    known: Boolean,
    plain: sp.Symbol,
    ends: tuple[sp.Expr, ...],
    span: Mapping[sp.Symbol, Intervals],
) -> bool:
    """Whether a slope is, part by part: where intervals leave it open, both halves are asked."""
    try:
        low, high = _run(kernel(ends), span)
        asked = kernel([steepness, held(known)])
        parts, signs = Intervals(np.atleast_1d(low.low), np.atleast_1d(high.high)), set[bool]()
        for _ in range(_HALVINGS):
            found, sure = _run(asked, {**span, plain: parts})
            rises, falls, sure = found.low >= 0, found.high <= 0, sure.low == 1
            signs |= {True} if (rises & sure).any() else set()
            signs |= {False} if (falls & ~rises & sure).any() else set()
            left = np.broadcast_to(~((rises | falls) & sure), parts.low.shape)
            if len(signs) > 1 or not left.any():
                return len(signs) == 1
            at, to = parts.low[left], parts.high[left]
            if at.size > _PARTS or not np.isfinite([at, to]).all():
                return False
            middle = (at + to) / 2
            parts = Intervals(np.concatenate([at, middle]), np.concatenate([middle, to]))
    except (KeyError, SheetError, TypeError):
        return False
    return False


def _terms(expression: sp.Expr) -> int:
    """How many terms an expression has at most when it is multiplied out."""
    match expression:
        case sp.Add():
            return sum(map(_terms, expression.args))
        case sp.Mul():
            return prod(map(_terms, expression.args))
        case sp.Pow(base=base, exp=sp.Integer(p=power)) if power > 0:
            return comb(_terms(base) + power - 1, power)
    return 1


def _run(function: Kernel, span: Mapping[sp.Symbol, Intervals]) -> list[Intervals]:
    """Expressions over all that their symbols may be."""
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


def slope(form: sp.Expr, unknown: sp.Symbol) -> tuple[sp.Expr, Boolean]:
    """The slope of a form, and where the form is sure to be continuous so that the slope tells its course.

    `unknown`: of which only is assumed what holds in the interval.
    """
    jumps = any(part.has(unknown) for part in form.atoms(*JUMPS))
    return differentiated(form, unknown), sp.false if jumps else defined(form)


def held(condition: Boolean) -> sp.Expr:
    """1 where a condition holds, else 0."""
    return sp.Piecewise((1, condition), (0, True))


def typed_form(sheet: Sheet, plan: Plan, node: RootNode) -> tuple[sp.Expr, sp.Symbol]:
    """The form of a root, and its unknown, in symbols of which only is assumed what they may be."""
    plain = sp.Symbol(node.unknown.name, real=True)
    form: sp.Expr = node.form.xreplace({**typed_symbols(sheet, plan.leaves), node.unknown: plain})
    return form, plain


def enclosing(sheet: Sheet, plan: Plan, node: RootNode) -> Enclosing:
    """A function of what a root names and of its unknown: form, slope, whether that tells its course."""
    form, plain = typed_form(sheet, plan, node)
    for steepness, known in (slope(form, plain), (form, sp.false)):
        try:
            run = kernel([form, steepness, held(known)])
        except SheetError:
            continue
        exponents = _exponents((form, steepness), plain) if known == True else None  # noqa: E712
        reach = None if exponents is None or len(run.totals) != 1 else kernel([*map(magnitude, exponents)])
        return Enclosing(run.arguments, run.totals, run.source, reach=reach)
    raise SheetError(f"{node.column.name}: NumPy cannot compute {form}", node.column.name)


def _exponents(expressions: tuple[sp.Expr, ...], unknown: sp.Symbol) -> list[sp.Expr] | None:
    """Those of the terms of all sums, if each is at most four cells times one exponential of the unknown."""
    sums = sorted(set().union(*(each.atoms(RowSum) for each in expressions)), key=str)
    # With the sums put away nothing of the unknown may be left.
    hidden = {each: sp.Symbol(f"sum_{n}") for n, each in enumerate(sums)}
    if not sums or any(each.xreplace(hidden).has(unknown) for each in expressions):
        return None
    found = []
    for terms, _ in (each.args for each in sums):
        powers, rest = sp.sift(sp.Mul.make_args(terms), lambda part: part.func is sp.exp, binary=True)
        cells = [part.as_base_exp() for part in rest if not part.is_Number]
        exponent = sp.Add(*(power.args[0] for power in powers))
        if (
            not all(cell.is_Symbol and times.is_Integer and times > 0 for cell, times in cells)
            or sum(times for _, times in cells) > 4
            or unknown in {cell for cell, _ in cells}
            or len(powers) > 1
            or not exponent.is_polynomial()
            or sp.degree(exponent, unknown) > 1
        ):
            return None
        found.append(exponent)
    return found
