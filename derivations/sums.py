"""Sums in one form: split into terms, from row 1 to a common end, with what is added or missing written out.

So ``X[1] + Sum(X[q], (q, 2, n))`` and ``Sum(X[q], (q, 1, n))`` become the same expression. A sum is rewritten
only where that is right for every size that its symbols allow; a sum without terms is zero.
"""

from __future__ import annotations

from typing import Any

from sympy import (
    Add,
    Basic,
    Expr,
    Indexed,
    Integer,
    Mul,
    Sum,
    Symbol,
    expand,
    expand_log,
    expand_power_base,
    nan,
    oo,
    powsimp,
    zoo,
)

_MOST_WRITTEN = 30
"""A sum of known size, up to this many terms, is written out."""


def in_terms(expression: Any) -> Any:
    """Bring every sum of an expression into the common form."""
    if not isinstance(expression, Basic) or not expression.has(Sum):
        return expression
    if isinstance(expression, Sum):
        *inner, limits = expression.limits
        body = in_terms(Sum(expression.function, *inner) if inner else expression.function)
        body = expand(expand_log(expand_power_base(body)))
        return Add(*(_of_term(term, *limits) for term in Add.make_args(body)))
    return expression.func(*(in_terms(argument) for argument in expression.args))


def _of_term(term: Expr, index: Symbol, low: Expr, high: Expr) -> Expr:
    """One term summed: what does not run with the index stands in front; powers of it have closed forms."""
    outer, inner = term.as_independent(index, as_Add=False)
    if inner.is_polynomial(index) and not inner.has(Indexed, Sum) and (high - low + 1).is_nonnegative:
        return Mul(outer, Sum(inner, (index, low, high)).doit())
    return Mul(outer, _from_one(powsimp(inner), index, low, high))


def _from_one(body: Expr, index: Symbol, low: Expr, high: Expr) -> Expr:
    """The sum from 1 to an end without a number in it, and the terms by which it differs."""
    body, shift = _unshifted(body, index)
    low, high = low + shift, high + shift
    as_it_is = _named(body, index, low, high)
    (beyond, end), whole = high.as_coeff_Add(), bool(low.is_Integer and index.is_integer)
    if not (whole and beyond.is_Integer and abs(beyond) + abs(low) < _MOST_WRITTEN):
        return as_it_is
    if end == 0:
        return Add(*(_at(body, index, row) for row in range(int(low), int(high) + 1)))
    # The sums to `end`, to `high` and to `low - 1` must all have no term or more of them.
    if not (end.is_nonnegative and high.is_nonnegative and (high - low + 1).is_nonnegative):
        return as_it_is
    added = [*range(int(low), 1), *(end + n for n in range(1, int(beyond) + 1))]
    missing = [*range(1, int(low)), *(end - n for n in range(int(-beyond)))]
    terms = [_at(body, index, row) for row in added] + [-_at(body, index, row) for row in missing]
    if any(term.has(nan, zoo, oo) for term in terms):
        return as_it_is
    return Add(_named(body, index, Integer(1), end), *terms)


def _unshifted(body: Expr, index: Symbol) -> tuple[Expr, Expr]:
    """The body with X[q] where all its cells were X[q + c], and c."""
    shifts = {cell.indices[0] - index for cell in body.atoms(Indexed) if cell.has(index)}
    shift = shifts.pop() if len(shifts) == 1 else Integer(0)
    return (body.xreplace({index: index - shift}), shift) if shift.is_Integer else (body, Integer(0))


def _at(body: Expr, index: Symbol, row: Expr | int) -> Expr:
    return in_terms(body.xreplace({index: Integer(row) if isinstance(row, int) else row}))


def _named(body: Expr, index: Symbol, low: Expr, high: Expr) -> Sum:
    """A sum whose running number is called by how deep sums are nested in it, not as its author called it."""
    kind = {"integer": True, "positive": True} if low.is_positive and index.is_integer else index.assumptions0
    name = Symbol(f"row {_depth(body)}", **kind)
    return Sum(body.xreplace({index: name}), (name, low, high))


def _depth(expression: Basic) -> int:
    return max((1 + _depth(total.function) for total in expression.atoms(Sum)), default=0)
