r"""Mathematics for the eye: from sympy to LaTeX, in the author's order of terms.

Equations are written under ``evaluate(False)``, so their tree is the author's: ``a*b/c*d`` is a fraction
with a factor behind it. The printer reads the tree from left to right and reorders nothing. Where sympy
has put terms in an order of its own, the author's is lost; there a sum begins with a positive term and a
product is one fraction.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational
from sympy.printing.latex import LatexPrinter

from ...derivations.reductions import OrderStatistic, member_of, taken_of
from ...derivations.text import flat
from ..named import name_of
from .names import Terms, join, name_latex

_RELATIONS = {"<=": r"\le", ">=": r"\ge", "<": "<", ">": ">", "==": "=", "!=": r"\ne"}
_MIRROR = {">=": "<=", ">": "<"}
_TALL = re.compile(r"\\(?:frac|sum|int|sqrt|left|begin)")
_WORD = re.compile(r"\\mathrm\{[^{}]{2,}\}")
_ENDS_WITH_WORD = re.compile(rf"{_WORD.pattern}(?:[_^]\{{[^{{}}]*\}})*$")


# --- expressions -----------------------------------------------------------------------------------------


class MathPrinter(LatexPrinter):  # type: ignore[misc] # sympy has no types
    """LaTeX in the order in which the author wrote it.

    `names`: as for :func:`name_latex`.
    """

    after_integral = " "
    """What stands between the sign of an integral and what is integrated."""

    def __init__(self, names: Mapping[str, str] | None = None) -> None:
        super().__init__({"order": "none", "ln_notation": True})
        self.names = dict(names or {})

    def emptyPrinter(self, expr: Any) -> str:
        """Refuse what has no LaTeX: half an equation is worse than none."""
        raise TypeError(f"no LaTeX for {type(expr).__name__}: {expr}")

    def _print_Basic(self, expr: sp.Basic) -> str:
        return self.emptyPrinter(expr)

    # names

    def _print_Symbol(self, expr: sp.Symbol, style: str = "plain") -> str:
        return name_latex(expr.name, self.names)

    def _print_Indexed(self, expr: sp.Indexed) -> str:
        return name_latex(name_of(expr), self.names, ",".join(self._print(i) for i in expr.indices))

    def _print_AppliedUndef(self, expr: AppliedUndef) -> str:
        return name_latex(expr.func.__name__, self.names)

    # sums and products

    def _print_Add(self, expr: sp.Add, order: str | None = None) -> str:
        return join(self.terms(expr))

    def sides(self, members: Iterable[sp.Expr]) -> list[Terms]:
        """The terms of the sides of an equation, or of one relation."""
        return [self.terms(member) for member in members]

    def terms(self, expr: sp.Expr) -> Terms:
        """The terms of a sum, each with whether it is subtracted."""
        summands = flat(expr, sp.Add)
        if len(summands) == 1 and isinstance(expr, sp.Piecewise):
            return [(False, self._print(expr))]
        parts = [self._signed(term) for term in summands]
        if len(parts) > 1 and parts[0][0] and _canonical(expr):
            first = next((place for place, (negative, _) in enumerate(parts) if not negative), 0)
            parts.insert(0, parts.pop(first))
        return parts

    def _signed(self, expr: sp.Expr) -> tuple[bool, str]:
        if isinstance(expr, sp.Mul):
            return self._product(expr)
        if isinstance(expr, sp.Number) and expr.is_negative:
            return True, self._print(-expr)
        text = self._print(expr)
        return False, self._bracket(text) if isinstance(expr, sp.Piecewise) else text

    def _print_Mul(self, expr: sp.Mul) -> str:
        negative, text = self._product(expr)
        return ("-" if negative else "") + text

    def _product(self, expr: sp.Mul) -> tuple[bool, str]:
        """The sign of a product and its LaTeX without it."""
        negative, units = self._units(expr)
        if not units:
            return negative, "1"
        alone = len(units) == 1 and not negative
        text = ""
        for place, (above, below) in enumerate(units):
            last = place == len(units) - 1
            printed = self._unit(above, below, alone, last)
            text += _apart(text, printed) + printed
        return negative, text

    def _units(self, expr: sp.Mul) -> tuple[bool, list[tuple[list[sp.Expr], list[sp.Expr]]]]:
        """Fractions and factors, from left to right: numerators and denominators of each."""
        negative = False
        units: list[tuple[list[sp.Expr], list[sp.Expr]]] = []
        one = _canonical(expr)  # sympy's order says nothing: one fraction
        closed = True
        for place, written in enumerate(_factors(expr)):
            below_zero = bool(isinstance(written, sp.Number) and written.is_negative)
            negative ^= below_zero
            factor = -written if below_zero else written
            if factor == 1:
                continue
            if isinstance(factor, sp.Mul):
                other, inner = self._units(factor)
                negative ^= other
                # A product in parentheses stands for itself if it has a fraction, else joins what is there.
                if closed or units[-1][1] or len(inner) > 1 or inner[0][1]:
                    units += inner
                else:
                    units[-1][0].extend(inner[0][0])
                closed = False
                continue
            above, below = _halves(factor)
            if place <= 1 and not units and above and below and isinstance(factor, sp.Rational):
                units.append((above, below))  # a number such as 1/2 stands for itself, in front
                closed = True
                continue
            # `a/b*c`: a factor behind a fraction is not pulled up into its numerator.
            if closed or (above and units[-1][1] and not one):
                units.append(([], []))
                closed = False
            units[-1][0].extend(above)
            units[-1][1].extend(below)
        return negative, units

    def _unit(self, above: list[sp.Expr], below: list[sp.Expr], alone: bool, last: bool) -> str:
        if not below:
            return self._chain(above, alone and len(above) == 1, last)
        if (
            len(above) == 1
            and isinstance(above[0], sp.Sum)
            and last
            and not any(part.has(sp.Sum) for part in below)
        ):
            # A mean: the sum beside the bar keeps its limits where they can be read.
            return rf"\frac{{1}}{{{self._chain(below, len(below) == 1, True)}}} {self._print(above[0])}"
        top = self._chain(above, len(above) == 1, True) if above else "1"
        return rf"\frac{{{top}}}{{{self._chain(below, len(below) == 1, True)}}}"

    def _chain(self, factors: list[sp.Expr], bare: bool, last: bool) -> str:
        """Factors side by side, with parentheses where they are needed."""
        text = ""
        for place, factor in enumerate(factors):
            printed = self._print(factor)
            ends = last and place == len(factors) - 1
            if not bare and (
                isinstance(factor, (sp.Add, sp.Piecewise))
                or (isinstance(factor, (sp.Sum, OrderStatistic, sp.Integral)) and not ends)
            ):
                printed = self._bracket(printed)
            text += _apart(text, printed) + printed
        return text

    @staticmethod
    def _bracket(text: str) -> str:
        """Parentheses, as high as what is in them."""
        return rf"\left({text}\right)" if _TALL.search(text) else f"({text})"

    # powers and functions

    def _print_Pow(self, expr: sp.Pow) -> str:
        base, exponent = expr.base, expr.exp
        if exponent == sp.Rational(1, 2):
            return rf"\sqrt{{{self._print(base)}}}"
        above, below = _halves(expr)
        if below:
            return self._unit(above, below, True, True)
        raised = self._inline(exponent)
        if isinstance(base, (sp.Symbol, sp.NumberSymbol, sp.Indexed, AppliedUndef)):
            name = self._print(base)
            primed = re.fullmatch(r"(\\?[A-Za-z]+)('+)(_\{.*\})?", name)
            if primed:  # a prime is a superscript already, and there is only one
                primes = r"\prime" * len(primed[2])
                return f"{primed[1]}{primed[3] or ''}^{{{primes} {raised}}}"
            if r"\cdot" not in name:
                return f"{name}^{{{raised}}}"
        if isinstance(base, sp.Number) and base.is_integer and base.is_nonnegative:
            return f"{self._print(base)}^{{{raised}}}"
        return f"{self._bracket(self._print(base))}^{{{raised}}}"

    def _inline(self, expr: sp.Expr) -> str:
        """An exponent: fractions with a slash, for a bar is hard to read up there."""
        if isinstance(expr, sp.Rational) and not expr.is_integer:
            return f"{expr.p}/{expr.q}"
        if isinstance(expr, (sp.Mul, sp.Pow)):
            negative, units = self._units(expr) if isinstance(expr, sp.Mul) else (False, [_halves(expr)])
            if len(units) == 1 and units[0][1]:
                above, below = units[0]
                top = self._chain(above, False, True) if above else "1"
                bottom = self._chain(below, False, True)
                if len(below) > 1:
                    bottom = self._bracket(bottom)
                return f"{'-' if negative else ''}{top}/{bottom}"
        return str(self._print(expr))

    def _print_exp(self, expr: sp.Expr, exp: str | None = None) -> str:
        # e is the coefficient of restitution.
        return self._call(r"\exp", self._print(expr.args[0]), exp)

    def _print_log(self, expr: sp.Expr, exp: str | None = None) -> str:
        return self._call(r"\ln", self._print(expr.args[0]), exp)

    def _print_beta(self, expr: sp.Expr, exp: str | None = None) -> str:
        # sympy's own writes what stands in it as text, not as LaTeX
        return self._call(r"\operatorname{B}", ", ".join(map(self._inline, expr.args)), exp)

    def _call(self, function: str, inside: str, exp: str | None) -> str:
        text = function + self._bracket(inside)
        return text if exp is None else f"{self._bracket(text)}^{{{exp}}}"

    def _print_Max(self, expr: sp.Expr, exp: str | None = None) -> str:
        return self._extreme(r"\max", expr)

    def _print_Min(self, expr: sp.Expr, exp: str | None = None) -> str:
        return self._extreme(r"\min", expr)

    def _extreme(self, which: str, expr: sp.Expr) -> str:
        inside = ", ".join(self._print(argument) for argument in sorted(expr.args, key=str))
        return which + self._bracket(inside)

    # sums, integrals, cases

    def _print_Sum(self, expr: sp.Sum) -> str:
        text = ""
        for index, low, high in expr.limits:
            text += rf"\sum_{{{self._print(index)}={self._print(low)}}}^{{{self._print(high)}}} "
        if within := self._in_group(expr):
            text = rf"\sum_{{{within}}} "
        return text + self._body(taken_of(expr))

    def _in_group(self, expr: sp.Sum | OrderStatistic) -> str:
        """Which rows it is of, if it is of those of a group."""
        member = member_of(expr)
        return "" if member is None else r" \in ".join(map(self._print, member.args))

    def _print_OrderStatistic(self, expr: OrderStatistic) -> str:
        runs = ", ".join(
            " \\le ".join(map(self._print, (low, index, high))) for index, low, high in expr.limits
        )
        runs = self._in_group(expr) or runs
        return rf"\underset{{{runs}}}{{\mathrm{{{expr.word}}}}} \, {self._body(taken_of(expr))}"

    def _print_Integral(self, expr: sp.Integral) -> str:
        text, ends = "", ""
        for variable, low, high in expr.limits:
            text += rf"\int_{{{self._print(low)}}}^{{{self._print(high)}}}{self.after_integral}"
            ends = rf" \, d{self._print(variable)}" + ends
        return text + self._body(expr.function) + ends

    def _body(self, expr: sp.Expr) -> str:
        """What stands behind a sign of summation or integration."""
        if isinstance(expr, sp.Mul):  # sympy writes 1*(a + b)
            factors = [factor for factor in expr.args if factor != 1]
            expr = factors[0] if len(factors) == 1 else expr
        printed = self._print(expr)
        return (
            self._bracket(printed)
            if isinstance(expr, (sp.Add, sp.Piecewise)) or printed[0] == "-"
            else printed
        )

    def _print_Piecewise(self, expr: sp.Piecewise) -> str:
        rows = []
        for body, condition in expr.args:
            when = r"\text{otherwise}" if condition == True else self._print(condition)  # noqa: E712
            rows.append(rf"{self._print(body)}, & {when}")
        return r"\begin{cases} " + r" \\ ".join(rows) + r" \end{cases}"

    def _print_Relational(self, expr: Relational) -> str:
        return rf"{self._print(expr.lhs)} {_RELATIONS[expr.rel_op]} {self._print(expr.rhs)}"

    def _print_And(self, expr: sp.And) -> str:
        """Join relations that share a side: ``0 <= x <= x_m``."""
        if not all(isinstance(part, Relational) for part in expr.args):
            return r" \ \text{and}\ ".join(self._print(part) for part in expr.args)
        left = [_upwards(part) for part in expr.args]
        chains: list[list[Any]] = []
        while left:
            low, sign, high = left.pop(0)
            chain = [low, sign, high]
            # a < b, b < c is read a < b < c: a chain grows at either end until no relation fits.
            grown = True
            while grown:
                grown = False
                for other in list(left):
                    if other[0] == chain[-1]:
                        chain += other[1:]
                    elif other[2] == chain[0]:
                        chain[:0] = other[:2]
                    else:
                        continue
                    left.remove(other)
                    grown = True
            chains.append(chain)
        printed = [
            " ".join(_RELATIONS[part] if isinstance(part, str) else self._print(part) for part in chain)
            for chain in chains
        ]
        return r" \ \text{and}\ ".join(printed)


def _upwards(relation: Relational) -> tuple[sp.Expr, str, sp.Expr]:
    """A relation read from the smaller side."""
    if relation.rel_op in _MIRROR:
        return relation.rhs, _MIRROR[relation.rel_op], relation.lhs
    return relation.lhs, relation.rel_op, relation.rhs


def _canonical(expr: sp.Expr) -> bool:
    """Whether sympy has ordered the arguments, so that no author's order is left in them."""
    if any(isinstance(argument, expr.func) for argument in expr.args):
        return False
    return bool(expr.func(*expr.args).args == expr.args)


def _factors(expr: sp.Expr) -> list[sp.Expr]:
    """The factors of ``a*b/c*d`` in order; a product that was written in parentheses stays one."""
    head, *rest = expr.args
    while isinstance(head, sp.Number) and head == -1 and len(rest) == 1 and isinstance(rest[0], sp.Mul):
        return [head, *_factors(rest[0])]  # -(a*b)
    return [*(_factors(head) if isinstance(head, sp.Mul) else [head]), *rest]


def _halves(factor: sp.Basic) -> tuple[list[sp.Expr], list[sp.Expr]]:
    """What a factor puts above and below the bar of a fraction."""
    if isinstance(factor, sp.Rational) and not factor.is_integer:
        # In lowest terms tens stand above only where a decimal number stood below: 10/37 was typed 1/3.7.
        tens = 0
        while factor.p % 10 ** (tens + 1) == 0 and factor.q > 10 ** (tens + 1):
            tens += 1
        above = sp.Integer(factor.p // 10**tens)
        if not tens:
            return [above], [sp.Integer(factor.q)]
        return [] if above == 1 else [above], [sp.Float(f"{factor.q}e-{tens}")]
    if isinstance(factor, sp.Pow):
        exponent = factor.exp
        if isinstance(exponent, sp.Number) and exponent.is_negative:
            base, power = factor.base, -exponent
            if power == 1:
                return [], _factors(base) if isinstance(base, sp.Mul) and not _divides(base) else [base]
            return [], [sp.Pow(base, power, evaluate=False)]
        if isinstance(exponent, sp.Mul) and exponent.args[0] == -1:
            rest = exponent.args[1:]
            power = rest[0] if len(rest) == 1 else sp.Mul(*rest, evaluate=False)
            return [], [sp.Pow(factor.base, power, evaluate=False)]
    return [factor], []


def _apart(before: str, factor: str) -> str:
    """What stands between two factors: a dot between numbers; a word is set off from what is beside it."""
    if re.search(r"\d$", before) and re.match(r"\d|\\frac", factor):
        return r" \cdot "
    words = _ENDS_WITH_WORD.search(before) or (before and _WORD.match(factor))
    return r" \, " if words else " " * bool(before)


def _divides(expr: sp.Mul) -> bool:
    return any(_halves(factor)[1] or isinstance(factor, sp.Mul) for factor in _factors(expr))
