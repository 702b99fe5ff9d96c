"""Prints a root's equation and its slope as JavaScript for intervals (templates/engines/intervals.js)."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from sympy import (
    Add,
    And,
    Basic,
    Expr,
    Ge,
    Gt,
    Le,
    Lt,
    Mul,
    Ne,
    Number,
    Pow,
    Rational,
    Symbol,
    asinh,
    atan,
    cos,
    cse,
    exp,
    log,
    numbered_symbols,
    pi,
    sin,
    sinh,
    tanh,
    true,
)  # fmt: skip
from sympy.logic.boolalg import Boolean

from ..plan.nodes import RowSum

__all__ = ["FUNCTIONS", "enclose", "interval", "needed"]

FUNCTIONS = Path(__file__).resolve().parents[2] / "templates" / "minified" / "intervals.js"
"""The functions, a part for each."""

_RISING = {exp: "exp", log: "log", atan: "atan", tanh: "tanh", sinh: "sinh", asinh: "asinh"}
_UNKNOWN = "ALL"
"""What is printed for a function that the intervals do not know: anything."""


def interval(expression: Any) -> str:
    """An expression of numbers and intervals.

    Examples
    --------
    >>> from sympy.abc import x, y
    >>> interval(x * y**2 - 1)
    'plus(-1, times(power(y, 2), x))'
    >>> interval(log(x) / 3)
    'times(rising(Math.log, x), times(1, power(3, -1)))'
    """
    if isinstance(expression, (Add, Mul)):
        function = "plus" if isinstance(expression, Add) else "times"
        return _nested(function, sorted(map(interval, expression.args)))
    if isinstance(expression, Symbol):
        return str(expression.name)
    if isinstance(expression, Rational):
        whole = expression.is_Integer
        return str(expression) if whole else f"times({expression.p}, power({expression.q}, -1))"
    if isinstance(expression, Number) or expression == pi:
        number = float(expression)
        return f"out({number!r}, {number!r})"
    if isinstance(expression, Pow):
        return _power(*expression.args)
    if type(expression) in _RISING:
        return f"rising(Math.{_RISING[type(expression)]}, {interval(expression.args[0])})"
    if isinstance(expression, (cos, sin)):
        inner = interval(expression.args[0])
        return (
            f"cosine(plus({inner}, out(-Math.PI / 2, -Math.PI / 2)))"
            if isinstance(expression, sin)
            else f"cosine({inner})"
        )
    return _UNKNOWN


def _nested(function: str, parts: Sequence[str]) -> str:
    found = parts[0]
    for part in parts[1:]:
        found = f"{function}({found}, {part})"
    return found


def _power(base: Expr, exponent: Expr) -> str:
    if exponent == 2 and base.is_Symbol and base.name.startswith("$"):
        return f"times({base.name}, {base.name})"  # a number, not an interval
    if exponent.is_Integer:
        return f"power({interval(base)}, {exponent})"
    return f"rising(Math.exp, times({interval(exponent)}, rising(Math.log, {interval(base)})))"


def _certain(condition: Any) -> str:
    """That a condition holds all over its intervals."""
    if condition == true:
        return "true"
    if isinstance(condition, And):
        return " && ".join(map(_certain, sorted(condition.args, key=str)))
    signs = {Gt: "=== 1", Lt: "=== -1", Ne: "!== 0", Ge: "=== 1", Le: "=== -1"}
    if type(condition) in signs:
        return f"side({interval(condition.lhs - condition.rhs)}) {signs[type(condition)]}"
    return "false"


def enclose(
    form: Expr,
    steepness: Expr,
    known: Boolean,
    plain: Callable[[Basic, dict[Expr, Symbol]], Any],
    terms: Callable[[RowSum], tuple[str, Any]],
) -> str:
    """A function of the row and an interval of the unknown: the form, and its slope if it has one all over.

    `plain`: puts what is printed for them in the place of cells, and the names that it gives them in that of
    sums. `terms`: of a sum, the axis and its terms, printed as those of the row ``q``.
    """
    found: dict[Expr, Symbol] = {}
    bodies = [plain(each, found) for each in (form, steepness)]
    condition = _certain(plain(known, found))
    by_axis: dict[str, list[tuple[Symbol, Any]]] = {}
    for total, name in found.items():
        axis, body = terms(total)
        by_axis.setdefault(axis, []).append((name, body))
    lines = []
    for axis, own in by_axis.items():
        names = ", ".join(str(name) for name, _ in own)
        inner, texts = _common([body for _, body in own], "w_")
        lines.append(f"      const [{names}] = sums(k.{axis}, (q) => {{")
        lines += [f"        {line}" for line in inner]
        lines += [f"        return [{', '.join(texts)}];", "      });"]
    outer, texts = _common(bodies, "t_")
    lines += [f"      {line}" for line in outer]
    value, course = texts
    if condition != "true":
        course = f"{condition} ? {course} : ALL"
    return "\n".join(["(r, u) => {", *lines, f"      return [{value}, {course}];", "    }"])


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


def _common(bodies: Sequence[Any], prefix: str) -> tuple[list[str], list[str]]:
    """Statements for what expressions have in common, and the texts of the expressions."""
    common, reduced = cse(list(bodies), symbols=numbered_symbols(prefix), order="none", list=True)
    return [f"const {name} = {interval(value)};" for name, value in common], list(map(interval, reduced))
