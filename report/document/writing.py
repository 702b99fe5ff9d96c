"""Writes equations whose algebra is at hand: :mod:`~loopsheet.report.document.written` tells it.

As they stand, and with a place for every number in them.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from sympy import Expr, Indexed, Integer, Symbol

from ...derivations.equation import Equation
from ...derivations.reductions import REDUCTIONS
from ...derivations.text import Wording
from ...derivations.vocabulary import Vocabulary
from ..named import name_of
from ..sheet import Column, Formula, Given, Root, Sheet
from .math import MathPrinter
from .parts import Placed, Written


def written_of(equation: Equation, names: Mapping[str, str], vocabulary: Vocabulary) -> Written:
    """An equation, written; parameters as for :func:`~loopsheet.report.document.written.written`."""
    printer, wording = MathPrinter(names), Wording(vocabulary)
    return Written(
        tuple(printer.sides(equation.members)),
        " = ".join(map(wording.text, equation.members)),
        tuple(str(printer.doprint(condition)) for condition in equation.conditions),
        tuple(map(wording.text, equation.conditions)),
        _speaks_of(equation),
    )


def _speaks_of(equation: Equation) -> str:
    own, general = _indices(equation), _indices(equation.origin)
    if len(own) == len(general) == 1 and own != general and isinstance(next(iter(own)), Integer):
        return f"{general.pop()} = {own.pop()}"
    return ""


def _indices(equation: Equation) -> set[Expr]:
    """The indices that the cells of an equation carry."""
    return {index for member in equation.members for cell in member.atoms(Indexed) for index in cell.indices}


_BETWEEN = re.compile(
    r"(?:(?<=[\d})])|(?<=\\pi))(?<!\\begin\{cases\}) (?=\\text\{@|\\left|\(|\\frac|\\sqrt|\\pi|\d|"
    r"\\(?:ln|exp|sin|cos|tan|sinh|cosh|tanh|operatorname)\b)"
)


def placed_in(column: Column, sheet: Sheet, names: Mapping[str, str]) -> Placed:
    """What :func:`~loopsheet.report.document.written.placed` tells of a column whose algebra is at hand."""
    placing = _Placing(column, sheet, names)
    return Placed(placing.equation(), tuple((name, index) for name, index in placing.cells))


class _Placing(MathPrinter):
    """Prints an equation with a numbered place for every cell, size and running number in it."""

    after_integral = r"\, "  # its end is no factor

    def __init__(self, column: Column, sheet: Sheet, names: Mapping[str, str]) -> None:
        super().__init__(names)
        self.column, self.sheet = column, sheet
        self.cells: list[list[str | None]] = []
        """What belongs into each place: a column and an index, or how many rows an axis has."""

    def equation(self) -> str:
        """The equation of the column in LaTeX; empty if it has none, or sums over rows."""
        rule = self.column.rule
        assert not isinstance(rule, Given)
        members = rule.equation.members[-1:] if isinstance(rule, Formula) else rule.equation.members
        if any(member.has(*REDUCTIONS) for member in members):
            return ""
        text = " = ".join(str(self.doprint(member)) for member in members)
        # Two numbers side by side would be read as one.
        return _BETWEEN.sub(r" \\cdot ", text)

    def _place(self, name: str, index: str | None) -> str:
        cell: list[str | None] = [name, index]
        if cell not in self.cells:
            self.cells.append(cell)
        return rf"\text{{@{self.cells.index(cell)}@}}"

    def _print_Symbol(self, expr: Symbol, style: str = "plain") -> str:
        axis = self.column.axis
        if expr in self.sheet.algebra.sizes:
            return self._place("", self.sheet.algebra.sizes[expr].name)
        if axis is not None and expr in axis.ordinals:
            return self._place("#", expr.name)
        if isinstance(self.column.rule, Root) and expr == self.column.rule.unknown:
            return self._place(self.column.name, None if axis is None else str(axis.index))
        if expr.name in self.sheet:
            # The left side of an equation may name a column without its index.
            return self._place(
                expr.name, None if self.sheet[expr.name].axis is None else str(axis and axis.index)
            )
        return super()._print_Symbol(expr, style)

    def _print_Indexed(self, expr: Indexed) -> str:
        return self._place(name_of(expr), str(expr.indices[0]))
