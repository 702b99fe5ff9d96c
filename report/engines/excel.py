"""The Excel engine's printer: a rule of the sheet as the text of a spreadsheet formula.

Excel 2016, LibreOffice 7.4 and other readers must understand every formula, so it uses nothing younger,
and no notation on which they disagree: a minus in front binds before a power in Excel, ``1E-6`` is refused
by some, and ``MAX``, ``AND`` and ``OR`` swallow a whole array where one of its cells is meant.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from decimal import Decimal
from functools import reduce
from typing import Any

from sympy import Add, Basic, Expr, Function, Integer, Mul, Pow, Rational, Symbol
from sympy.logic.boolalg import BooleanFunction
from sympy.printing.printer import Printer

from ...derivations.rebuilt import renamed
from ..plan.nodes import Leaf, Node, OverRows, Plan
from ..plan.order import Word
from .excel_values import NotPrintable

FUNCTIONS = {
    "Abs": "ABS",
    "acos": "ACOS",
    "asin": "ASIN",
    "atan": "ATAN",
    "cos": "COS",
    "cosh": "COSH",
    "exp": "EXP",
    "floor": "INT",
    "log": "LN",
    "sign": "SIGN",
    "sin": "SIN",
    "sinh": "SINH",
    "tan": "TAN",
    "tanh": "TANH",
}
"""Functions by their name in sympy."""

_EXACT_DIGITS = 15
"""Excel reads no more digits of a number."""


class IfError(Function):
    """The first argument, or the second where the first has no value."""

    is_real = True

    def _numpycode(self, printer: Any) -> str:
        value, otherwise = map(printer._print, self.args)
        return f"numpy.where(numpy.isfinite({value}), {value}, {otherwise})"


class IsNumber(BooleanFunction):
    """Whether the argument has a value."""

    def _numpycode(self, printer: Any) -> str:
        return f"{printer._module_format('numpy.isfinite')}({printer._print(self.args[0])})"


class _Cells(Symbol):
    """Cells of rows: in sums and products, they stand behind what is the same for all rows."""

    @classmethod
    def class_key(cls) -> tuple[int, int, str]:  # sympy orders terms by it
        return 5, 0, cls.__name__


class _Taken(_Cells):
    """What is taken over rows, which stands behind these."""


def ordered(plan: Plan) -> Plan:
    """The plan in symbols that stand in formulas in the order of the sheet's rules."""

    def behind(symbol: Symbol) -> Symbol:
        leaf = plan.named.get(symbol.name, Leaf("size"))
        kind = _Taken if leaf.kind == "total" else _Cells if leaf.kind == "cells" and leaf.axis else Symbol
        return kind(symbol.name, **symbol.assumptions0)

    def moved(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(map(moved, value))
        if isinstance(value, Node):
            return replace(value, **{f.name: moved(getattr(value, f.name)) for f in fields(value)})
        if not isinstance(value, Basic):
            return value
        return renamed(value, {symbol: behind(symbol) for symbol in value.atoms(Symbol)})

    return Plan(moved(plan.nodes), {behind(symbol): leaf for symbol, leaf in plan.leaves.items()})


class ExcelPrinter(Printer):
    """Prints an expression as a formula without its equals sign.

    Parameters
    ----------
    leaf : callable
        The text for a symbol.
    total : callable or None
        The text for what a word takes of terms over the axis of a name.
    rows : bool
        Whether the text stands for all rows of an axis at once, inside of a sum.
    """

    printmethod = "_excel"

    def __init__(
        self,
        leaf: Callable[[Symbol], str],
        total: Callable[[Expr, str, Word], str] | None = None,
        rows: bool = False,
    ) -> None:
        super().__init__()
        self.leaf, self.total, self.rows = leaf, total, rows

    def emptyPrinter(self, expr: Any) -> str:
        """Refuse what there is no rule for."""
        raise NotPrintable(f"{type(expr).__name__} has no spreadsheet formula: {expr}")

    # --- leaves

    def _print_Symbol(self, expr: Symbol) -> str:
        return self.leaf(expr)

    def _print_Integer(self, expr: Expr) -> str:
        return f"(0-{_digits(-int(expr))})" if expr < 0 else _digits(int(expr))

    def _print_Rational(self, expr: Expr) -> str:
        text = f"{_digits(abs(int(expr.p)))}/{_digits(int(expr.q))}"
        return f"(0-{text})" if expr < 0 else f"({text})"

    def _print_Float(self, expr: Expr) -> str:
        text = f"{Decimal(repr(float(expr))):f}".removesuffix(".0")
        return f"(0-{text[1:]})" if text.startswith("-") else text

    def _print_Pi(self, expr: Expr) -> str:
        return "PI()"

    def _print_Exp1(self, expr: Expr) -> str:
        return "EXP(1)"

    def _print_BooleanTrue(self, expr: Basic) -> str:
        return "TRUE()"

    def _print_BooleanFalse(self, expr: Basic) -> str:
        return "FALSE()"

    # --- arithmetic

    def _print_Add(self, expr: Add) -> str:
        plus, minus = self._terms(expr)
        return "+".join(plus or ["0"]) + "".join(f"-{term}" for term in minus)

    def added(self, expr: Expr) -> str:
        """A sum as a call of SUM, which rounds nothing.

        Where the last operation is a subtraction of nearly equal numbers, spreadsheets show zero.
        """
        if not isinstance(expr, Add):
            return str(self._print(expr))
        plus, minus = self._terms(expr)
        return f"SUM({','.join([*plus, *(f'0-{term}' for term in minus)])})"

    def _terms(self, expr: Add) -> tuple[list[str], list[str]]:
        """What is added, and what is taken away."""
        plus, minus = [], []
        for term in expr.as_ordered_terms():
            if term.could_extract_minus_sign():
                minus.append(self._taken(-term))
            else:
                plus.append(str(self._print(term)))
        return plus, minus

    def _print_Mul(self, expr: Mul) -> str:
        if expr.could_extract_minus_sign():
            return f"(0-{self._taken(-expr)})"
        above: list[Expr] = []
        below: list[Expr] = []
        for factor in expr.as_ordered_factors():
            if isinstance(factor, Pow) and factor.exp.is_Rational and factor.exp < 0:
                below.append(Pow(factor.base, -factor.exp))
            elif isinstance(factor, Rational) and not isinstance(factor, Integer):
                above += [Integer(factor.p)] if factor.p != 1 else []
                below.append(Integer(factor.q))
            else:
                above.append(factor)
        upper = "*".join(map(self.factor, above)) or "1"
        if not below:
            return upper
        lower = "*".join(map(self.factor, below)) if len(below) > 1 else self._divisor(below[0])
        return f"{upper}/({lower})" if len(below) > 1 else f"{upper}/{lower}"

    def factor(self, expr: Expr) -> str:
        """As a factor of a product: in parentheses where it needs them."""
        text = str(self._print(expr))
        bare = not isinstance(expr, Add) and not (isinstance(expr, Pow) and text.startswith("1/"))
        return text if bare else f"({text})"

    def _taken(self, expr: Expr) -> str:
        text = str(self._print(expr))
        return f"({text})" if isinstance(expr, Add) else text

    def _divisor(self, expr: Expr) -> str:
        text = self.factor(expr)
        return f"({text})" if isinstance(expr, Mul) and not text.startswith("(0-") else text

    def _print_Pow(self, expr: Pow) -> str:
        base, exponent = expr.base, expr.exp
        if exponent.is_Rational and exponent < 0:
            return f"1/{self._divisor(Pow(base, -exponent))}"
        if exponent == Rational(1, 2):
            return f"SQRT({self._print(base)})"
        return f"{_enclosed(self._print(base))}^{_enclosed(self._print(exponent))}"

    def _print_Function(self, expr: Expr) -> str:
        name = type(expr).__name__
        if name not in FUNCTIONS or len(expr.args) != 1:
            return self.emptyPrinter(expr)
        return f"{FUNCTIONS[name]}({self._print(expr.args[0])})"

    _print_exp = _print_log = _print_Abs = _print_sign = _print_Function

    def _print_IfError(self, expr: Expr) -> str:
        return f"IFERROR({self._print(expr.args[0])},{self._print(expr.args[1])})"

    def _print_IsNumber(self, expr: Basic) -> str:
        return f"ISNUMBER({self._print(expr.args[0])})"

    def _print_OverRows(self, expr: OverRows) -> str:
        if self.total is None:
            return self.emptyPrinter(expr)
        return self.total(expr.args[0], expr.args[1].name, expr.word)

    # --- choices

    def _print_Max(self, expr: Expr) -> str:
        return self._extreme("MAX", ">=", expr)

    def _print_Min(self, expr: Expr) -> str:
        return self._extreme("MIN", "<=", expr)

    def _extreme(self, function: str, relation: str, expr: Expr) -> str:
        parts = [self._print(argument) for argument in sorted(expr.args, key=str)]
        if not self.rows:
            return f"{function}({','.join(parts)})"
        text: str = reduce(lambda a, b: f"IF({a}{relation}{b},{a},{b})", parts)
        return text

    def _print_Piecewise(self, expr: Expr) -> str:
        pairs = [(self._print(body), condition) for body, condition in expr.args]
        text = pairs.pop()[0] if pairs[-1][1] == True else "NA()"  # noqa: E712 - sympy's true
        for body, condition in reversed(pairs):
            text = f"IF({self._held(condition)},{body},{text})"
        return text

    def _held(self, condition: Basic) -> str:
        """Whether a condition holds; one on a sum does not where a row has no value, which is an error."""
        text = self._print(condition)
        return f"IFERROR({text},FALSE())" if condition.has(_Taken) else str(text)

    def _print_Relational(self, expr: Expr) -> str:
        relation = {"==": "=", "!=": "<>"}.get(expr.rel_op, expr.rel_op)
        return f"{self._taken(expr.lhs)}{relation}{self._taken(expr.rhs)}"

    def _print_And(self, expr: Basic) -> str:
        parts = self._conditions(expr)
        return "*".join(f"({part})" for part in parts) if self.rows else f"AND({','.join(parts)})"

    def _print_Or(self, expr: Basic) -> str:
        parts = self._conditions(expr)
        return "+".join(f"({part})" for part in parts) + ">0" if self.rows else f"OR({','.join(parts)})"

    def _print_Not(self, expr: Basic) -> str:
        return f"NOT({self._print(expr.args[0])})"

    def _conditions(self, expr: Basic) -> list[str]:
        return sorted(str(self._print(argument)) for argument in expr.args)


def _enclosed(text: str) -> str:
    """In parentheses, but not twice."""
    depth, closed = 0, text.startswith("(")
    for place, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        closed = closed and (depth > 0 or place == len(text) - 1)
    return text if closed else f"({text})"


def _digits(number: int) -> str:
    """A whole number, in digits that every reader takes for what they are: of many, those of a double."""
    text = str(number)
    if len(text) <= _EXACT_DIGITS:
        return text
    told = []
    for first in (0, _EXACT_DIGITS):
        if part := text[first : first + _EXACT_DIGITS].rstrip("0"):
            told.append(f"{int(part)}*(10)^({len(text) - first - len(part)})")
    return f"({'+'.join(told)})"
