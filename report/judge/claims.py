"""What an author claims of the quantities of a method, looked at in the numbers of the data themselves.

A proof knows of no row without a value. Where sums leave such rows out, each its own, or where a count is one
of other rows, what was proved of the formulas need not hold of the cells.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ...derivations.equation import Equation
from ..cells.values import Status
from ..column import Column, Formula
from ..engines.exact import laid_out
from ..messages.diagnostics import Check, Location
from ..result.agreement import LIMIT
from ..sheet import Sheet
from .engines import EPS, Judge

if TYPE_CHECKING:
    from ..workbook import Claimed

CLAIM = "claim"
"""The kind of these checks."""


def claims(
    said: Sequence[Claimed], sheet: Sheet, labels: Mapping[str, Sequence[int]], data: Any, place: Location
) -> Iterator[Check]:
    """Whether each claim holds of the numbers, to what doubles would make of its difference.

    Parameters
    ----------
    sheet : Sheet
        Whose cells they name.
    labels, data
        As for :func:`loopsheet.report.engines.exact.evaluate`.
    place : Location
        What the findings are about.
    """
    own = [_difference(n, claim) for n, claim in enumerate(said)]
    whole = Sheet((*sheet.columns, *own))
    judge = Judge.of(whole, laid_out(whole, labels, data), labels, data)
    lost = any(status != Status.OK for c in sheet.columns for status in judge.judged.status[c.name])
    values = judge.judged.rounded(whole)
    for claim, column in zip(said, own, strict=True):
        off = list(_off(judge, column))
        empty = [cell.label for cell in values.cells(column.name) if cell.value is None and not cell.culprit]
        note = "warning" if empty and not off else ""
        yield Check(CLAIM, claim.label, not off, _sentence(claim, off, lost, empty), place, note=note)


def _difference(number: int, claim: Claimed) -> Column:
    """What must be zero, as a column."""
    rule = Formula(Equation("", (claim.left, claim.left - claim.right), ""))
    return Column(f"claim_{number}", claim.axis, rule, positive=False)


def _off(judge: Judge, column: Column) -> Iterator[tuple[str, float]]:
    """The rows in which it is not zero, and how far it is off."""
    exactly, bounds = judge.judged.value[column.name], judge.bounds[column.name]
    for address, value, bound in zip(judge.addresses[column.name], exactly, bounds, strict=True):
        if value is not None and abs(value) > LIMIT * EPS * bound:
            yield address, float(value)


def _sentence(
    claim: Claimed, off: list[tuple[str, float]], lost: bool, empty: Sequence[tuple[int, ...]]
) -> str:
    if not off and empty:
        rows = f" in row {', '.join(map(str, empty[0]))}" if empty[0] else ""
        return f"{claim.label}, {claim.meaning}, has no value for these data{rows}: no proof tells of that"
    if not off:
        return f"{claim.label} holds of these data"
    address, value = off[0]
    row = address.partition("[")[2].removesuffix("]")
    told = f"its sides differ by {value:.3g} in SI" + (f" in row {row}" if row else "")
    why = "; its sums or counts are over other rows, as some have no value" if lost else ""
    return f"{claim.label}, {claim.meaning}, does not hold of these data: {told}{why}"
