"""What is stated of the errors of given numbers, in words: of each column, as it was said."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ..messages.errors import listing
from ..quantity import Printed, behind
from ..sheet import Given

if TYPE_CHECKING:
    from .result import Report

MOST = 12
"""Standard uncertainties that are listed; of more, the least and the largest are told."""
_SIZES = re.compile(r"u\(.*\)|.*\([0-9]+\)")
"""What says a size alone, a number each: a column u(x_p), or digits in parentheses."""
_NONE = "–"


def statements(report: Report) -> Iterator[tuple[str, str]]:
    """Each given column of which something is stated, and what."""
    for column in report.sheet.columns:
        if isinstance(column.rule, Given) and (told := of_column(report, column.name)):
            yield column.name, told


def of_column(report: Report, name: str) -> str:
    """What is stated of a given column; empty if its digits have to say it.

    `name`: of a measured column or of a parameter.
    """
    return "; ".join((*_own(report, name), *_shared(report, name), *_correlated(report, name)))


def _own(report: Report, name: str) -> Iterator[str]:
    inputs, printed = report.inputs, report.inputs.numbers(name)
    if name in inputs.taken:
        value = "its value" if name in inputs.parameters else "its values"
        yield f"{_sizes(report, name, printed)}, taken with {value} from {inputs.taken[name].file}"
        return
    said = {None if each.stated is None else tuple(error.said for error in each.stated) for each in printed}
    if said <= {None}:
        return
    (one, *others) = said
    if one is None or others or any(map(_SIZES.fullmatch, one)):
        yield _sizes(report, name, printed)
    else:
        yield "; ".join(map(_printed, one)) or "exact"


def _printed(said: str) -> str:
    """A statement as it is printed: ``±0.1 rect`` of ``+-0.1 rect``."""
    return re.sub(r"\+/?-", "±", said)


def _sizes(report: Report, name: str, printed: tuple[Printed, ...]) -> str:
    """The standard uncertainties in the unit of the numbers; of what says nothing itself a dash."""
    told = [_NONE if each.stated is None else _size(report, name, each.u) for each in printed]
    unit = behind(report.shown[name].unit)
    if len(set(told)) == 1:
        return f"u = {told[0]}{unit}"
    if len(told) <= MOST:
        return f"u = {', '.join(told)}{unit}"
    sizes = [each.u for each in printed if each.stated is not None]
    least, most = (_size(report, name, size) for size in (min(sizes), max(sizes)))
    return f"u from {least} to {most}{unit}"


def _size(report: Report, name: str, u: float) -> str:
    return report.sure(name, u).text if u else "0"


def _shared(report: Report, name: str) -> Iterator[str]:
    for each in report.inputs.uncertainty.shared:
        if name in each.statements:
            groups = ", ".join("-".join(map(str, group)) for group in each.groups)
            where = f"the same in each of {groups}" if groups else "the same in all"
            others = [other for other in each.statements if other != name]
            where += f", and in {listing(others)}" if others else ""
            yield f"{each.name}: {_printed(each.statements[name].parts[0].said)} ({where})"


def _correlated(report: Report, name: str) -> Iterator[str]:
    for pair, r in report.inputs.uncertainty.correlations.items():
        if pair[0] == name:
            yield f"correlated with {pair[1]}: {r:.3g}"
