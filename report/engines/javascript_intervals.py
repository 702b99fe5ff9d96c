"""Prints a root's equation and its slope as JavaScript for intervals (templates/engines/intervals.js)."""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Sequence
from functools import reduce
from pathlib import Path
from typing import Any

import sympy as sp
from sympy.logic.boolalg import Boolean

from ..plan.nodes import RowSum

FUNCTIONS = Path(__file__).resolve().parents[2] / "templates" / "minified" / "intervals.js"
"""The functions, a part for each."""

_RISING = {
    sp.exp: "exp",
    sp.log: "log",
    sp.asin: "asin",
    sp.atan: "atan",
    sp.tanh: "tanh",
    sp.sinh: "sinh",
    sp.asinh: "asinh",
}
_BY_OTHERS = {
    sp.tan: lambda x: sp.sin(x) / sp.cos(x),
    sp.acos: lambda x: sp.pi / 2 - sp.asin(x),
    sp.cosh: lambda x: (sp.exp(x) + sp.exp(-x)) / 2,
}
NOTHING = sp.Symbol("ALL")
"""What stands for that of which the intervals know nothing: anything."""

Ends = tuple[str, str]
"""An interval as it is printed: its lower end, and then the upper one, which the call before it may leave."""


def interval(expression: Any, wide: Container[str]) -> Ends:
    """An expression of numbers and intervals, which have the names in `wide`.

    Examples
    --------
    >>> from sympy.abc import x, y
    >>> interval(x * y**2 - 1, {"x"})
    ('plus(-1, -1, times(power(y, y, 2), up[0], x, x_), up[0])', 'up[0]')
    >>> interval(sp.log(x) / 3, "x")
    ('times(rising(Math.log, x, x_), up[0], times(1, 1, power(3, 3, -1), up[0]), up[0])', 'up[0]')
    """
    if expression == NOTHING:
        return "-Infinity", "Infinity"
    if isinstance(expression, sp.Symbol):
        name = str(expression.name)
        return (name, f"{name}_" if name in wide else name)
    if expression.is_Integer:
        return str(expression), str(expression)
    if isinstance(expression, sp.Rational):
        above, below = str(expression.p), str(expression.q)
        return _call("times", above, above, *_call("power", below, below, "-1"))
    if isinstance(expression, sp.Number) or expression == sp.pi:
        number = repr(float(expression))
        return _call("out", number, number)
    if isinstance(expression, (sp.Add, sp.Mul)):
        function = "plus" if isinstance(expression, sp.Add) else "times"
        first, *others = sorted(interval(each, wide) for each in expression.args)
        return reduce(lambda found, each: _call(function, *found, *each), others, first)
    if isinstance(expression, sp.Pow):
        base, exponent = expression.args
        if exponent.is_Integer:
            return _call("power", *interval(base, wide), str(exponent))
        logarithm = _call("rising", "Math.log", *interval(base, wide))
        return _call("rising", "Math.exp", *_call("times", *interval(exponent, wide), *logarithm))
    if type(expression) in _RISING:
        inner = interval(expression.args[0], wide)
        return _call("rising", f"Math.{_RISING[type(expression)]}", *inner)
    if type(expression) in _BY_OTHERS:
        return interval(_BY_OTHERS[type(expression)](expression.args[0]), wide)
    if isinstance(expression, sp.cos):
        return _call("cosine", *interval(expression.args[0], wide))
    if isinstance(expression, sp.sin):
        quarter = _call("out", "-Math.PI / 2", "-Math.PI / 2")
        return _call("cosine", *_call("plus", *interval(expression.args[0], wide), *quarter))
    return interval(NOTHING, wide)


def _call(function: str, *arguments: str) -> Ends:
    return f"{function}({', '.join(arguments)})", "up[0]"


def _certain(condition: Any, wide: Container[str]) -> str:
    """That a condition holds all over its intervals."""
    if condition == sp.true:
        return "true"
    if isinstance(condition, sp.And):
        return " && ".join(_certain(each, wide) for each in sorted(condition.args, key=str))
    signs = {sp.Gt: "=== 1", sp.Lt: "=== -1", sp.Ne: "!== 0", sp.Ge: "=== 1", sp.Le: "=== -1"}
    if type(condition) in signs:
        ends = interval(condition.lhs - condition.rhs, wide)
        return f"side({', '.join(ends)}) {signs[type(condition)]}"
    return "false"


def enclose(
    form: sp.Expr,
    steepness: sp.Expr,
    known: Boolean,
    plain: Callable[[sp.Basic, dict[sp.Expr, sp.Symbol]], Any],
    terms: Callable[[RowSum], tuple[str, Any]],
) -> str:
    """A function of the row and an interval of the unknown: the form, and its slope if it has one all over.

    `plain`: puts what is printed for them in the place of cells, and the names that it gives them in that of
    sums. `terms`: of a sum, the axis and its terms, printed as those of the row ``q``.
    """
    found: dict[sp.Expr, sp.Symbol] = {}
    bodies = [plain(each, found) for each in (form, steepness)]
    wide = {"u"}
    condition = plain(known, found)
    by_axis: dict[str, list[tuple[sp.Symbol, Any]]] = {}
    for total, name in found.items():
        axis, body = terms(total)
        by_axis.setdefault(axis, []).append((name, body))
    lines = []
    for axis, own in by_axis.items():
        inner, terms_of = _common([body for _, body in own], "w_", wide)
        names = ", ".join(f"{name}, {name}_" for name, _ in own)
        lines.append(f"      const [{names}] = sums(k.{axis}, {len(own)}, (q, s) => {{")
        lines += [f"        {line}" for line in inner]
        ends = [end for both in terms_of for end in both]
        lines += [f"        s[{n}] = {end};" for n, end in enumerate(ends)]
        lines.append("      });")
        wide |= {str(name) for name, _ in own}
    outer, (value, course) = _common(bodies, "t_", wide)
    lines += [f"      {line}" for line in outer]
    certain = _certain(condition, wide)
    slope = ", ".join(course) if certain == "true" else f"...({certain} ? [{', '.join(course)}] : ALL)"
    return "\n".join(["(r, u, u_) => {", *lines, f"      return [{', '.join(value)}, {slope}];", "    }"])


def needed(program: str) -> str:
    """The functions for intervals that a program calls, and those that they call."""
    parts = FUNCTIONS.read_text(encoding="utf-8").strip().split("\n\n")
    names = {part: set(re.findall(r"^(?:let|function) (\w+)", part, re.MULTILINE)) for part in parts}
    found: set[str] = set()
    waiting = [program]
    while waiting:
        words = set(re.findall(r"\w+", waiting.pop()))
        new = [part for part in parts if part not in found and names[part] & words]
        found.update(new)
        waiting += new
    return "\n\n".join(part for part in parts if part in found)


def _common(bodies: Sequence[Any], prefix: str, wide: set[str]) -> tuple[list[str], list[Ends]]:
    """Statements for what expressions have in common, and the expressions; `wide` gets the new names."""
    common, reduced = sp.cse(list(bodies), symbols=sp.numbered_symbols(prefix), order="none", list=True)
    lines = []
    for name, value in common:
        low, high = interval(value, wide)
        lines.append(f"const {name} = {low}, {name}_ = {high};")
        wide.add(str(name))
    return lines, [interval(body, wide) for body in reduced]
