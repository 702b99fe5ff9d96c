"""Sums in one form: split into terms, from row 1 to a common end, with what is added or missing written out.

So ``X[1] + Sum(X[q], (q, 2, n))`` and ``Sum(X[q], (q, 1, n))`` become the same expression. A sum is rewritten
only where that is right for every size that its symbols allow; a sum without terms is zero.
"""

from __future__ import annotations

from typing import Any

import sympy as sp

_MOST_WRITTEN = 30
"""A sum of known size, up to this many terms, is written out."""


def in_terms(expression: Any) -> Any:
    """Bring every sum of an expression into the common form."""
    if not isinstance(expression, sp.Basic) or not expression.has(sp.Sum):
        return expression
    if isinstance(expression, sp.Sum):
        *inner, (named, *ends) = expression.limits
        # Its own number is nobody else's: an inner sum may be called by the same one, and is called anew.
        index = sp.Dummy("row", **named.assumptions0)
        whole = sp.Sum(expression.function, *inner) if inner else expression.function
        body, limits = in_terms(_renumbered(whole, named, index)), (index, *ends)
        held: dict[sp.Expr, _Held] = {}
        body = sp.expand(sp.expand_log(sp.expand_power_base(_without_sums(body, index, held))))
        terms = sp.Add(*(_of_term(term, *limits) for term in sp.Add.make_args(body)))
        return terms.xreplace({dummy: part for part, dummy in held.items()})
    return expression.func(*(in_terms(argument) for argument in expression.args))


def _renumbered(body: Any, named: sp.Symbol, index: sp.Symbol) -> Any:
    """A body with another running number, but where that is the own one of what is taken over rows in it."""
    if named not in body.free_symbols:
        return body
    if body == named:
        return index
    last = max(
        (n for n, (own, *ends) in enumerate(getattr(body, "limits", ())) if own == named and ends), default=-1
    )
    if last >= 0:  # it owns what stands before it; of its own ends and of those behind it is another one
        function, *limits = body.args
        there = (
            limit if n < last else sp.Tuple(limit[0], *(_renumbered(end, named, index) for end in limit[1:]))
            for n, limit in enumerate(limits)
        )
        return body.func(function, *there)
    return body.func(*(_renumbered(part, named, index) for part in body.args))


class _Held(sp.Dummy):  # type: ignore[misc]
    """What stands for a part of a body that has sums, but does not run with the index of its own."""

    depth: int
    """How deep sums are nested in it."""


def _without_sums(body: Any, index: sp.Symbol, held: dict[sp.Expr, _Held]) -> Any:
    """A body with symbols for quotients and functions of sums that do not run with the index.

    They would be multiplied out with what does run, and then stand in no common place.

    `held`: what each of these is, to be put in again.
    """
    if not body.has(sp.Sum) or isinstance(body, sp.Sum):
        return body
    whole_power = isinstance(body, sp.Pow) and body.exp.is_Integer and body.exp.is_positive
    is_expanded = isinstance(body, (sp.Add, sp.Mul)) or whole_power
    if isinstance(body, sp.Expr) and not is_expanded and not body.has(index):
        part = sp.expand(body)
        if part not in held:
            held[part] = _Held("part", real=part.is_real, positive=part.is_positive)
            held[part].depth = _depth(part)
        return held[part]
    return body.func(*(_without_sums(part, index, held) for part in body.args))


def _of_term(term: sp.Expr, index: sp.Symbol, low: sp.Expr, high: sp.Expr) -> sp.Expr:
    """One term summed: what does not run with the index stands in front; powers of it have closed forms."""
    outer, inner = term.as_independent(index, as_Add=False)
    if inner.is_polynomial(index) and not inner.has(sp.Indexed, sp.Sum) and (high - low + 1).is_nonnegative:
        return sp.Mul(outer, sp.Sum(inner, (index, low, high)).doit())
    return sp.Mul(outer, _from_one(sp.powsimp(inner), index, low, high))


def _from_one(body: sp.Expr, index: sp.Symbol, low: sp.Expr, high: sp.Expr) -> sp.Expr:
    """The sum from 1 to an end without a number in it, and the terms by which it differs."""
    body, shift = _unshifted(body, index)
    low, high = low + shift, high + shift
    as_it_is = _named(body, index, low, high)
    (beyond, end), whole = high.as_coeff_Add(), bool(low.is_Integer and index.is_integer)
    if not (whole and beyond.is_Integer and abs(beyond) + abs(low) < _MOST_WRITTEN):
        return as_it_is
    if end == 0:
        return sp.Add(*(_at(body, index, row) for row in range(int(low), int(high) + 1)))
    # The sums to `end`, to `high` and to `low - 1` must all have no term or more of them.
    if not (end.is_nonnegative and high.is_nonnegative and (high - low + 1).is_nonnegative):
        return as_it_is
    added = [*range(int(low), 1), *(end + n for n in range(1, int(beyond) + 1))]
    missing = [*range(1, int(low)), *(end - n for n in range(int(-beyond)))]
    terms = [_at(body, index, row) for row in added] + [-_at(body, index, row) for row in missing]
    if any(term.has(sp.nan, sp.zoo, sp.oo) for term in terms):
        return as_it_is
    return sp.Add(_named(body, index, sp.Integer(1), end), *terms)


def _unshifted(body: sp.Expr, index: sp.Symbol) -> tuple[sp.Expr, sp.Expr]:
    """The body with X[q] where all its cells were X[q + c], and c."""
    shifts = {cell.indices[0] - index for cell in body.atoms(sp.Indexed) if cell.has(index)}
    shift = shifts.pop() if len(shifts) == 1 else sp.Integer(0)
    return (body.xreplace({index: index - shift}), shift) if shift.is_Integer else (body, sp.Integer(0))


def _at(body: sp.Expr, index: sp.Symbol, row: sp.Expr | int) -> sp.Expr:
    return in_terms(body.xreplace({index: sp.Integer(row) if isinstance(row, int) else row}))


def _named(body: sp.Expr, index: sp.Symbol, low: sp.Expr, high: sp.Expr) -> sp.Sum:
    """A sum whose running number is called by how deep sums are nested in it, not as its author called it."""
    kind = {"integer": True, "positive": True} if low.is_positive and index.is_integer else index.assumptions0
    name = sp.Symbol(f"row {_depth(body)}", **kind)
    return sp.Sum(body.xreplace({index: name}), (name, low, high))


def _depth(expression: sp.Basic) -> int:
    nested = [1 + _depth(total.function) for total in expression.atoms(sp.Sum)]
    return max([*nested, *(part.depth for part in expression.atoms(_Held))], default=0)
