"""What is odd about repeated readings: whether their scatter tells what it is asked for."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from ..axis import MemberAxis
from ..distribution import SCATTER
from ..messages.diagnostics import Check
from ..messages.errors import listing
from ..quantity import behind
from ..sheet import Sheet

if TYPE_CHECKING:
    from ..inputs.inputs import Inputs
    from ..inputs.measurements import Measurements
    from ..result.result import Report

SCATTERS = "scatter"
"""The kind of these checks."""
PAIRED = "paired"
"""The check of paired readings."""
REACH = 2
"""Scatter about one mean that is so many times that about the means of groups is none of single readings."""
BY_CHANCE = 0.01
"""Of so few tables two rows would have the same numbers by chance."""


def names(sheet: Sheet, inputs: Inputs) -> list[str]:
    """The names of these checks, without computing anything."""
    paired = [PAIRED] * bool(inputs.uncertainty.paired)
    return [*_unmoved(inputs), *(name for name, _ in _scattering(sheet, inputs)), *paired]


def checks(report: Report) -> Iterator[Check]:
    """Check the repeated readings of a report that has been computed."""
    for name in _unmoved(report.inputs):
        yield _of_resolution(report, name)
    for name, axis in _scattering(report.sheet, report.inputs):
        yield _of_scatter(report, name, axis)
    if report.inputs.uncertainty.paired:
        yield _of_paired(report)


def twice(table: Measurements) -> list[tuple[int, int]]:
    """The rows that have the numbers of an earlier one in all columns, if chance hardly does that: both.

    A column has as many numbers to choose from as its digits leave between its ends; one that was set to a
    few of them has those.
    """
    rows = list(zip(*table.measured.values(), strict=True))
    known = [(test, row) for test, row in zip(table.tests, rows, strict=True) if None not in row]
    first: dict[tuple[Fraction, ...], int] = {}
    found = []
    for test, row in known:
        own = tuple(number.value for number in row if number is not None)
        if (other := first.setdefault(own, test)) != test:
            found.append((other, test))
    ways = 1.0
    for column in zip(*(row for _, row in known), strict=True) if found else ():
        numbers = [number for number in column if number is not None]
        values = {number.value for number in numbers}
        finest = min(number.spread[1] for number in numbers)
        few = 2 * len(values) <= len(numbers) or not finest
        ways *= len(values) if few else 1 + float(max(values) - min(values)) / (2 * finest)
    return found if math.comb(len(known), 2) < BY_CHANCE * ways else []


def _unmoved(inputs: Inputs) -> list[str]:
    """The columns of which scatter alone is stated, and whose readings are all the same."""
    return [
        name
        for name, stated in inputs.uncertainty.columns.items()
        if [part.said for part in stated.parts] == [SCATTER]
        and len({number.value for number in inputs.numbers(name)}) == 1
    ]


def _scattering(sheet: Sheet, inputs: Inputs) -> Iterator[tuple[str, MemberAxis]]:
    """The columns whose scatter is stated, with the groups of their rows, if these are of one kind."""
    for name, stated in inputs.uncertainty.columns.items():
        axis = sheet[name].axis if name in sheet else None
        found = [*axis.grouped(sheet.axes)] if axis else []
        scatters = name not in _unmoved(inputs) and any(part.said == SCATTER for part in stated.parts)
        if len(found) == 1 and scatters:
            yield name, found[0]


def _of_resolution(report: Report, name: str) -> Check:
    """Readings that are all the same: their scatter tells nothing, the digits of the instrument do."""
    numbers = report.inputs.numbers(name)
    said = f"{name}: all {len(numbers)} readings are {numbers[0].text}: their scatter is 0, and their "
    said += f"digits leave more; say '{SCATTER}; +-0.5 digits rect', or what they share"
    return Check(SCATTERS, name, True, said, report.inputs.place, note="warning")


def _of_paired(report: Report) -> Check:
    """What is computed of paired readings may scatter less than they do, and than their digits leave."""
    inputs, found = report.inputs, report.uncertain()
    paired = listing(inputs.uncertainty.paired, last="and")
    if not found.unresolved:
        return Check(SCATTERS, PAIRED, True, f"{paired}: what is made of them scatters", inputs.place)
    told = []
    for (name, row), left in found.unresolved.items():
        size = f"{report.sure(name, left).text}{behind(report.shown[name].unit)}"
        told.append(f"{report.values.address(name, row)} ({size})")
    said = f"{listing(told, last='and')}: {paired} scatter there by less than half of what their digits "
    said += "leave, which stands in brackets and in no u; add a correction of 0 with that u to say it"
    return Check(SCATTERS, PAIRED, True, said, inputs.place, note="warning")


def _of_scatter(report: Report, name: str, axis: MemberAxis) -> Check:
    """Whether readings that stand in groups scatter about one mean as about those of their groups."""
    values, place = report.values, report.inputs.place
    layout = values.layouts[axis.name]
    value = values.value[name][layout.rows[axis.of.index_name]]
    groups = [own[np.isfinite(own)] for own in (value[rows] for rows in layout.groups)]
    every, number = np.concatenate(groups), sum(own.size > 0 for own in groups)
    dof, within = every.size - number, sum(own.size * float(np.var(own)) for own in groups if own.size)
    whole = float(np.std(every, ddof=1)) if every.size > 1 else 0.0
    about = f"about the mean of their own {axis.by}"
    if whole**2 * dof <= REACH**2 * within:
        said = f"{name}: {axis.of.name} scatter as much {about} as about that of all"
        return Check(SCATTERS, name, True, said, place)
    unit = behind(report.shown[name].unit)
    size, own = (report.sure(name, each).text + unit for each in (whole, math.sqrt(within / dof)))
    said = f"{name}: {SCATTER} is {size}, of all {axis.of.name} about one mean; "
    said += f'{about} they scatter by {own}: "u = {own}, dof = {dof}" says so'
    return Check(SCATTERS, name, True, said, place, note="warning")
