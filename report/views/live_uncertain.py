"""The errors of what was given, for the page that propagates them through its sheet again after an edit."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from ..cells.address import index_text
from ..cells.layout import how_large
from ..distribution import DIVISORS, LEVEL, SCATTER, Error, Shape
from ..quantity import Printed, there
from ..result.numbers import order
from ..result.result import Report
from ..result.uncertain import Conformity
from ..sheet import Column, RepeatAxis

FOLLOWED = frozenset({Shape.NORMAL, Shape.STUDENT, Shape.RECTANGULAR, Shape.TRIANGULAR, Shape.ARCSINE})
"""The shapes that a width tells whole."""
ROUNDING = 1e-12
"""Of a variance: what is left of it beside a part is nothing, if it is less."""
MOST_DECIDED = 12
"""Cells on which U decides, of which the page finds out whether second order counts: that takes a while."""
LARGEST = 4_000_000
"""Given numbers times cells; of a larger sheet the uncertainties stay as issued: they would take too long."""


def follows(report: Report) -> bool:
    """Whether the uncertainties of the page follow its edits.

    Those of numbers with a law of their own or from another report do not, nor does a column of the sheet
    that is made of how readings scatter.
    """
    stated, sheet = report.inputs.uncertainty, report.sheet
    told = [part.shape for each in stated.columns.values() for part in each.parts]
    numbers = [number for c in sheet.columns for number in there(report.printed(c.name))]
    told += [error.shape for number in numbers for error in number.stated or ()]
    told += [p.shape for each in stated.shared for said in each.statements.values() for p in said.parts]
    weighs = any(stated.is_of_readings(of) for of in sheet.weighed.values())
    known = not (weighs or report.inputs.taken) and FOLLOWED.issuperset(told)
    return known and len(numbers) * how_large(sheet, report.values.layouts) <= LARGEST


def decided(report: Report) -> list[dict[str, Any]]:
    """The cells on which a rule decides, with their limits in SI; those that only a build decides say so.

    The page knows U for one level, and whether second order counts of a few cells.
    """
    conformities = report.uncertain().conformities if report.inputs.limits else ()
    by_u = [each.budget.cell for each in conformities if each.limits.guard.times]

    def told(found: Conformity) -> dict[str, Any]:
        limits, rule = found.limits, found.limits.guard
        ends = [float(end.value) if end else None for end in (limits.low, limits.high)]
        of = [limits.cell[0], index_text(limits.cell[1])]
        entry: dict[str, Any] = {"cell": found.budget.cell, "of": of, "ends": ends}
        if rule.width is not None:
            return entry | {"width": float(rule.width.value)}
        if not rule.times:
            return entry
        followed = rule.level == LEVEL and found.budget.cell in by_u[:MOST_DECIDED]
        return entry | ({"times": float(rule.times)} if followed else {"build": 1})

    return list(map(told, conformities))


def scatters(report: Report) -> bool:
    """Whether the page follows how readings scatter."""
    stated = report.inputs.uncertainty
    return follows(report) and any(map(stated.is_of_readings, stated.columns))


def uncertain(report: Report) -> dict[str, Any]:
    """What errors share, their correlations, how many digits are shown; nothing, if all stays as issued."""
    if not follows(report):
        return {}
    stated = report.inputs.uncertainty
    return {
        "shared": [
            {"called": each.name, "of": of, **_stated(said, each.name)[0]}
            | ({"gain": 1} if said.parts[0].scales else {})
            | ({"groups": each.groups} if each.groups else {})
            for each in stated.shared
            for of, said in each.statements.items()
            if of in report.sheet
        ],
        "correlated": [
            [one, other, r]
            for (one, other), r in stated.correlations.items()
            if one in report.sheet and other in report.sheet and not {one, other} <= {*stated.paired}
        ],
        "most": stated.digits,
    } | ({"paired": [*stated.paired]} if scatters(report) else {})


def errors(report: Report, column: Column) -> list[Any] | dict[str, Any] | None:
    """What is stated of the numbers of a given column: of all, or of each by its label; None: nothing.

    Of a test that is left out, too: the page takes it in again. A text in its place is no uncertainty. Of
    a column from another report it is what each test has by itself.
    """
    said = report.inputs.uncertainty.columns.get(column.name)
    if said is not None and FOLLOWED.issuperset(part.shape for part in said.parts):
        paired = report.inputs.uncertainty.paired
        return _stated(said, ", ".join(paired) if column.name in paired else column.name)
    printed = report.inputs.printed(column.name)
    own = report.inputs.own_u(column.name) if column.name in report.inputs.taken and column.axis else None
    found = {
        index_text(label): [
            _error(report, each, error) | ({"u": own[row]} if own else {}) for error in each.stated
        ]
        for row, (label, each) in enumerate(zip(report.values.labels(column), printed, strict=True))
        if each is not None and each.stated is not None
    }
    found |= dict(_of_left_out(report, column.name))
    return found or ([] if column.exact else None)


def _of_left_out(report: Report, name: str) -> Iterator[tuple[str, Any]]:
    """What is stated of the numbers of a column in the tests that are left out."""
    printed = report.inputs.numbers(name)
    for _, each in report.inputs.left_out:
        if name in each.stated:
            stated = each.stated[name]
            none = each.texts.get(f"u({name})", "")
            yield str(each.test), none if stated is None else [_error(report, printed[0], e) for e in stated]


def digits(report: Report, column: Column) -> dict[str, Any]:
    """The digits of a computed column where no uncertainty tells, and those of cells that stay as issued.

    Of a cell to which terms of second order count the variance that they make, that of first order and its
    value: an edit leaves the first as it is, or less where first order is less, as its square; where there
    is none of that, as the square of the cell.
    """
    warranted = report.shown[column.name].digits
    if isinstance(column.axis, RepeatAxis):
        return {"digits": warranted}
    every, name, labels = not follows(report), column.name, report.values.labels(column)
    issued = {
        index_text(label): order(value) - place + 1
        for label, value, place in zip(labels, report.in_unit(name), report.places(name), strict=True)
        if value is not None and (every or column.is_u)
    }
    least = min(issued.values(), default=warranted) if every else warranted
    kept = {index: number for index, number in issued.items() if not every or number != least}
    second, u = (known.get(name, ()) for known in (report.uncertain().second, report.uncertain().u))
    told = zip(labels, report.values.numbers(name), second, u, strict=False)
    bent = {
        index_text(label): [float(f"{one:.6g}") for one in (part, value, _beside(own**2, part))]
        for label, value, part, own in told
        if part and value is not None
    }
    return {"digits": least} | ({"kept": kept} if kept else {"bent": bent} if bent and not every else {})


def _beside(variance: float, part: float) -> float:
    """What is left of a variance beside a part: nothing, where that is no more than rounding."""
    return variance - part if variance - part > ROUNDING * variance else 0.0


def _stated(said: Any, sample: str) -> list[dict[str, Any]]:
    """What is stated of a column, part by part: a size, shares of the value, units of the last digit."""
    found = []
    for n, part in enumerate(said.parts):
        if part.said == SCATTER:  # how large it is, and with how many degrees of freedom, the page finds
            found.append({"scatter": True, **_kind(Shape.STUDENT, 1, SCATTER, f"{sample} {n}")})
            continue
        by = float(part.divisor) * DIVISORS[part.shape]
        sizes = {"u": part.absolute, "share": part.relative, "digits": part.digits}
        told: dict[str, Any] = {name: float(size) / by for name, size in sizes.items() if size}
        found.append(told | _kind(part.shape, part.dof, part.said, f"{sample} {n}"))
    return found


def _error(report: Report, printed: Printed, error: Error) -> dict[str, Any]:
    """An error of one number; what its own text says in shares of it follows an edit, all else stays."""
    said = report.inputs.uncertainty.again(error.said, printed.unit, error.shape)
    part = _stated(said, "")[0] if said else {}
    sizes = part if "share" in part or "digits" in part else {"u": error.u}
    return sizes | _kind(error.shape, error.dof, error.said, error.sample)


def _kind(shape: Shape, dof: float, said: str, sample: str) -> dict[str, Any]:
    kind: dict[str, Any] = {"shape": shape.value, "said": said}
    return kind | ({} if math.isinf(dof) else {"dof": dof} | ({"sample": sample} if sample else {}))
