"""Writes expressions and equations for a terminal, in their author's order of terms.

The notation is a calculator's: ``*`` and ``/`` from left to right, ``^`` for powers. Symbols are called as
the vocabulary says; an index follows the name: the approach of the second test is ``x_m2``, and that of test
k is ``x_m,k``.
"""

from __future__ import annotations

from typing import Any

import sympy as sp
from sympy.core.function import Application

from .equation import Equation
from .reductions import OrderStatistic, member_of, taken_of
from .vocabulary import Vocabulary, subscripted

_SUM, _PRODUCT, _SIGN, _POWER, _ATOM = range(5)
"""How tightly an expression holds together; a looser one gets parentheses inside a tighter one."""


_FUNCTIONS = {"Max": "max", "Min": "min", "Abs": "abs"}
"""What a calculator calls a function, where the library's name is another."""


def text(expression: Any, vocabulary: Vocabulary) -> str:
    """Write an expression as a reader at a terminal expects it.

    Parameters
    ----------
    vocabulary : Vocabulary
        What its symbols are called; those it does not have keep their names.

    Examples
    --------
    >>> from loopsheet.derivations.soft_impact import LEDGER
    >>> text(LEDGER["(12b)"].members[1], LEDGER.vocabulary)
    "x_m2*(v'_1/v'_2)^(2/(alpha + 1))"
    >>> text(LEDGER["(12c)"].members[1], LEDGER.vocabulary)
    "m_red*v'_2^2/2*(alpha + 1)/x_m2^(alpha + 1)"
    >>> text(sp.Symbol("F") / sp.Symbol("A"), LEDGER.vocabulary)
    'F/A'
    """
    return Wording(vocabulary).text(expression)


def text_of_equation(equation: Equation, vocabulary: Vocabulary) -> str:
    """Write all members of an equation, ``C*x_m^alpha = C'``."""
    return " = ".join(map(Wording(vocabulary).text, equation.members))


class Wording:
    """Writes in the words of one vocabulary.

    `vocabulary`: what symbols are called; those it does not have keep their names.
    """

    def __init__(self, vocabulary: Vocabulary) -> None:
        self.vocabulary = vocabulary

    def text(self, expression: Any) -> str:
        """The text of an expression that stands alone."""
        return self._write(expression)[0]

    def _write(self, expression: Any) -> tuple[str, int]:
        """The text of an expression and how tightly it holds together."""
        match expression:
            case sp.Indexed():
                return self._name(expression.base.label, ",".join(map(self.text, expression.indices))), _ATOM
            case sp.Symbol():
                return self._name(expression, ""), _ATOM
            case sp.Number():
                tight = _SIGN if expression < 0 else _PRODUCT if not expression.is_Integer else _ATOM
                return sp.sstr(expression, full_prec=False), tight
            case sp.Add():
                return self._sum(expression), _SUM
            case sp.Mul():
                return self._product(expression)
            case sp.Pow():
                return self._power(expression)
            case sp.Piecewise():
                return "; ".join(
                    f"{self.text(law)} for {self.text(where)}" for law, where in expression.args
                ), _SUM
            case sp.Integral() | sp.Sum() | OrderStatistic():
                name = {sp.Integral: "int", sp.Sum: "sum"}.get(type(expression)) or expression.word
                ends = [
                    f"{self.text(variable)} = {self.text(low)}..{self.text(high)}"
                    for variable, low, high in expression.limits
                ]
                if (member := member_of(expression)) is not None:
                    ends = [" in ".join(map(self.text, member.args))]
                return f"{name}({self.text(taken_of(expression))}, {', '.join(ends)})", _ATOM
            case sp.And():
                return self._chain(expression), _SUM
            case sp.Or():
                return " or ".join(map(self.text, expression.args)), _SUM
            case sp.Rel():
                sign = {"==": "=", "!=": "<>"}.get(expression.rel_op, expression.rel_op)
                return f"{self.text(expression.lhs)} {sign} {self.text(expression.rhs)}", _SUM
            case Application():
                name = self._name(
                    sp.Symbol(_FUNCTIONS.get(expression.func.__name__, expression.func.__name__)), ""
                )
                return f"{name}({', '.join(map(self.text, expression.args))})", _ATOM
        return sp.sstr(expression), _ATOM if isinstance(expression, sp.Basic) and expression.is_Atom else _SUM

    def _inside(self, expression: Any, tight: int) -> str:
        """The text of a part, in parentheses where it holds together less tightly than it must."""
        written, holds = self._write(expression)
        return written if holds >= tight else f"({written})"

    def _name(self, symbol: sp.Symbol, subscript: str) -> str:
        quantity = self.vocabulary.find(symbol)
        if quantity is not None and quantity.text:
            return quantity.called(subscript)
        return subscripted(str(symbol), subscript)

    def _sum(self, expression: sp.Add) -> str:
        written = ""
        for term in flat(expression, sp.Add):
            part = self._inside(term, _PRODUCT) if not isinstance(term, sp.Number) else self.text(term)
            negative = part.startswith("-")
            part = part.removeprefix("-")
            if not written:
                written = f"-{part}" if negative else part
            else:
                written += f" {'-' if negative else '+'} {part}"
        return written

    def _product(self, expression: sp.Mul) -> tuple[str, int]:
        """Factors from left to right; what has a negative power is divided by."""
        factors = [factor for factor in flat(expression, sp.Mul) if factor != 1]
        sign = ""
        while factors and factors[0] == -1:
            sign = "" if sign else "-"
            factors.pop(0)
        if factors and _is_reciprocal(factors[0]):  # F/s, where 1/s*F stands; one half may lead
            factors.sort(key=_is_reciprocal)
        written = ""
        for factor in factors:
            below = _divisor(factor)
            if below is None:
                # A fraction that leads needs no parentheses, and neither does a leading minus.
                part = self._inside(factor, _POWER) if written else self._inside(factor, _PRODUCT)
                written = f"{written}*{part}" if written else part
            else:
                written = f"{written or '1'}/{self._inside(below, _POWER)}"
        written = written or "1"
        if sign and written.startswith("-"):
            written = f"({written})"
        return sign + written, _PRODUCT if not sign else _SIGN if len(factors) == 1 else _PRODUCT

    def _power(self, expression: sp.Pow) -> tuple[str, int]:
        base, exponent = expression.args
        below = _divisor(expression)
        if below is not None:
            return f"1/{self._inside(below, _POWER)}", _PRODUCT
        if exponent == sp.Rational(1, 2):
            return f"sqrt({self.text(base)})", _ATOM
        return f"{self._inside(base, _ATOM)}^{self._inside(exponent, _ATOM)}", _POWER

    def _chain(self, expression: sp.And) -> str:
        """Two inequalities that meet in the middle are one: a <= x <= b."""
        first, second = expression.args if len(expression.args) == 2 else (None, None)
        for a, b in ((first, second), (second, first)):
            if isinstance(a, sp.Rel) and isinstance(b, sp.Rel) and a.rel_op in ("<", "<="):
                if a.rhs == b.lhs and b.rel_op in ("<", "<="):
                    return f"{self.text(a.lhs)} {a.rel_op} {self.text(a.rhs)} {b.rel_op} {self.text(b.rhs)}"
                if a.rhs == b.rhs and b.rel_op in (">", ">="):
                    return f"{self.text(a)} and {self.text(b)}"
        return " and ".join(map(self.text, expression.args))


def flat(expression: Any, kind: type[sp.Basic]) -> list[Any]:
    """The parts of nested sums or nested products, from left to right."""
    if not isinstance(expression, kind):
        return [expression]
    return [part for argument in expression.args for part in flat(argument, kind)]


def _is_reciprocal(factor: Any) -> bool:
    return isinstance(factor, sp.Pow) and _divisor(factor) is not None


def _divisor(factor: Any) -> sp.Expr | None:
    """What a factor divides by, if it does."""
    if isinstance(factor, sp.Rational) and factor.p == 1 and factor.q != 1:
        return sp.Rational(factor.q)
    if isinstance(factor, sp.Pow) and isinstance(factor.exp, sp.Number) and factor.exp < 0:
        return factor.base if factor.exp == -1 else sp.Pow(factor.base, -factor.exp, evaluate=False)
    return None
