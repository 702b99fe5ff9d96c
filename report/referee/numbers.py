"""Which equations of the source a column is computed by."""

from __future__ import annotations

from ...derivations.equation import Derivation, Ledger
from ..sheet import Column, Sheet


def numbers_of(sheet: Sheet, ledger: Ledger) -> dict[str, list[str]]:
    """The source's own numbers of the equations that each column is computed by, ``(7)``.

    An equation of this project's stands for those of the source that it is a form of.
    """
    return {column.name: sorted(_numbers(column, ledger)) for column in sheet.columns}


def _numbers(column: Column, ledger: Ledger) -> set[str]:
    if column.equation is None:
        return set()
    if not column.equation.own:
        return {column.equation.number, column.equation.label}
    premises = [
        premise
        for entry in ledger.entries
        if isinstance(entry, Derivation)
        for step in entry.steps
        if step.claim.label == column.equation.label
        for premise in step.premises
    ]
    return {number for p in premises if not p.own for number in (p.number, p.label)}
