"""Writes equations whose algebra is at hand: :mod:`~loopsheet.report.document.written` tells it."""

from __future__ import annotations

from collections.abc import Mapping

from sympy import Expr, Indexed, Integer

from ...derivations.equation import Equation, Step
from ...derivations.text import Wording
from ...derivations.vocabulary import Vocabulary
from .math import MathPrinter
from .parts import Written


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


def gone_of(step: Step, names: Mapping[str, str]) -> tuple[str, ...]:
    """LaTeX of what a step eliminates."""
    return tuple(map(str, map(MathPrinter(names).doprint, step.eliminate)))


def _speaks_of(equation: Equation) -> str:
    own, general = _indices(equation), _indices(equation.origin)
    if len(own) == len(general) == 1 and own != general and isinstance(next(iter(own)), Integer):
        return f"{general.pop()} = {own.pop()}"
    return ""


def _indices(equation: Equation) -> set[Expr]:
    """The indices that the cells of an equation carry."""
    return {index for member in equation.members for cell in member.atoms(Indexed) for index in cell.indices}
