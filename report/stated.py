"""What a sheet must be whatever is given: all of it stated in the ledger, and of one dimension."""

from __future__ import annotations

from ..derivations.equation import Ledger
from ..derivations.grounds import stated, supported
from ..derivations.text import text_of_equation
from .cells import units
from .sheet import Given, Root, Sheet, SheetError


def refuse_what_is_not_stated(sheet: Sheet, ledger: Ledger) -> None:
    """A column computes what the ledger says, so that there is nothing that no proof looks at.

    Raises
    ------
    SheetError
        It does not, or mixes dimensions.
    """
    units.check(sheet)
    for column in sheet.columns:
        rule = column.rule
        if isinstance(rule, Given):
            continue
        for equation in rule.statements:
            if not stated(equation, ledger):
                written = text_of_equation(equation.origin, ledger.vocabulary)
                raise SheetError(
                    f"{column.name} is computed from {equation.label} {written}, "
                    "which the ledger does not have: add it there, with its derivation if it is a claim",
                    column.name,
                )
        if isinstance(rule, Root) and not supported(rule.form, rule.equation, ledger):
            raise SheetError(
                f"{column.name} solves {rule.form.label}, which is not derived from {rule.equation.label}",
                column.name,
            )
