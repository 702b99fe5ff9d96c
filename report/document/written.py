"""How equations are written, in LaTeX and for a terminal: known, or printed of their algebra."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from ..partly import known
from ..sheet import Column, Given, Sheet
from .parts import Placed, Written

if TYPE_CHECKING:
    from ...derivations.equation import Equation, Step
    from ...derivations.vocabulary import Vocabulary


def written(equation: Equation, names: Mapping[str, str], vocabulary: Vocabulary) -> Written:
    """How an equation is written.

    `names`: from :func:`~loopsheet.report.document.names.latex_names`. `vocabulary`: of the ledger.
    """
    found: Written | None = known(equation, "written")
    if found is None:
        from .writing import written_of

        found = written_of(equation, names, vocabulary)
    return found


def gone(step: Step, names: Mapping[str, str]) -> tuple[str, ...]:
    """LaTeX of what a step eliminates."""
    found: tuple[str, ...] | None = known(step, "gone")
    if found is None:
        from .math import MathPrinter

        found = tuple(map(str, map(MathPrinter(names).doprint, step.eliminate)))
    return found


def text_of(equation: Equation, vocabulary: Vocabulary) -> str:
    """An equation for a terminal; parameters as for :func:`written`."""
    found: Written | None = known(equation, "written")
    if found is not None:
        return found.text
    from ...derivations.text import text_of_equation

    return text_of_equation(equation, vocabulary)


def placed(column: Column, sheet: Sheet, names: Mapping[str, str]) -> Placed:
    """The equation of a column with its places; `names` as for :func:`written`."""
    found: Placed | None = Placed("", ()) if isinstance(column.rule, Given) else known(column, "placed")
    if found is None:
        from .writing import placed_in

        found = placed_in(column, sheet, names)
    return found
