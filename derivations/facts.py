"""What conditions say of signs, for the algebra: x_m > x_p makes the root of (x_m - x_p)^2 be x_m - x_p.

A condition is used by writing one of its symbols as the others and a positive remainder: x_m = x_p + t. What
then holds for every positive t holds wherever the condition does.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from sympy import Abs, Add, Expr, Integer, Pow, Rel, Symbol, factor


class Facts:
    """The signs that follow from conditions, beyond the assumptions that symbols carry.

    Parameters
    ----------
    conditions : iterable of Rel
        What is no inequality is left aside: to know less is always sound.
    inside : bool
        Whether the ends of the domain do not count.
    """

    def __init__(self, conditions: Iterable[Any] = (), inside: bool = False) -> None:
        self._symbols: dict[Expr, Expr] = {}
        self._margins: dict[Expr, Expr] = {}
        for condition in conditions:
            if isinstance(condition, Rel) and condition.rel_op in (">", ">=", "<", "<="):
                margin = condition.gts - condition.lts
                within = inside and not margin.is_integer  # of whole numbers none is near the end
                self._learn(margin, strict=within or condition.rel_op in "<>")

    def _learn(self, margin: Expr, strict: bool) -> None:
        margin = self.put(margin)
        if margin.is_number or margin.is_positive or (margin.is_nonnegative and not strict):
            return
        count = len(self._symbols) + len(self._margins)
        sign = {"positive": True} if strict else {"nonnegative": True}
        remainder = Symbol(f"margin {count}", **sign, **({"integer": True} if margin.is_integer else {}))
        forms = [form for s in sorted(margin.free_symbols, key=str) for form in _forms(s, margin, remainder)]
        # One that keeps what is known of its symbol, if there is any.
        forms.sort(key=lambda form: bool(form[0].is_positive and not form[1].is_positive))
        for symbol, form in forms:
            if not symbol.is_integer or form.is_integer:
                self._symbols = {old: new.xreplace({symbol: form}) for old, new in self._symbols.items()}
                self._margins = {
                    old.xreplace({symbol: form}): new.xreplace({symbol: form})
                    for old, new in self._margins.items()
                }
                self._symbols[symbol] = form
                return
        self._margins |= {margin: remainder, -margin: -remainder}

    def put(self, expression: Any) -> Any:
        """Put the facts into an expression: it may then say of itself what sign it has."""
        if not self._symbols and not self._margins:
            return expression
        known = expression.xreplace(self._symbols).xreplace(self._margins)
        return known.replace(_hides_a_sign, lambda e: e.func(factor(e.args[0]), *e.args[1:]))

    def positive(self, expression: Expr) -> bool:
        """Whether an expression is positive wherever the conditions hold."""
        return bool(expression.is_positive or factor(self.put(expression)).is_positive)

    def nonnegative(self, expression: Expr) -> bool:
        """Whether it is positive or zero there."""
        return bool(expression.is_nonnegative or factor(self.put(expression)).is_nonnegative)


def _forms(symbol: Expr, margin: Expr, remainder: Symbol) -> Iterator[tuple[Expr, Expr]]:
    """A symbol by what remains of a margin a - c x: x = (a - t)/c, or where x is positive x = a/(1 + t)/c."""
    slope = margin.diff(symbol) if isinstance(symbol, Symbol) else Integer(0)
    if not slope.is_number or slope == 0:
        return
    rest = margin.xreplace({symbol: Integer(0)})
    yield symbol, (remainder - rest) / slope
    if symbol.is_positive and slope.is_negative and rest.is_positive:
        yield symbol, -rest / slope / (1 + remainder)


def _hides_a_sign(expression: Any) -> bool:
    """Whether a root or an absolute value is of a sum, which may be a square."""
    whole = isinstance(expression, Pow) and expression.exp.is_integer
    return isinstance(expression, (Abs, Pow)) and isinstance(expression.args[0], Add) and not whole
