"""Which equation a row of a table comes from, and which fit a published average is."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from math import inf, isfinite, isnan

from ..result.verdict import Fit, Relabelled
from ..result.verdict_words import mismatch as in_words
from ..sheet import Column
from .minimax import best, counted
from .problem import Box, Problem
from .search import Explained

Numbers = Mapping[str, Collection[str]]

PLENTY = 0.5
"""A fit that comes out within so many half units goes with the print; no better input is looked for."""

_NUMBER = re.compile(r"(?:eqs?\.?\s*\(?|\()([0-9]+[a-z]?)\)?", re.IGNORECASE)


def labels(problem: Problem, numbers: Numbers, first: Explained | None) -> tuple[Relabelled, ...]:
    """Find rows that are printed under the number of an equation they cannot come from.

    Parameters
    ----------
    problem : Problem
        All published values.
    numbers : mapping of column name to collection of str
        From :func:`~loopsheet.report.referee.numbers.numbers_of`.
    first : Explained or None
        The change with which all values come out, if they need one.
    """
    return tuple(_labels(problem, numbers, first))


def _labels(problem: Problem, numbers: Numbers, first: Explained | None) -> Iterator[Relabelled]:
    sheet = problem.campaign.sheet
    groups: dict[tuple[str, str, str], list[int]] = {}
    for n, value in enumerate(problem.published):
        found = _NUMBER.search(value.label)
        if found is not None:
            groups.setdefault((value.source, value.cell, f"({found[1]})"), []).append(n)
    for (source, cell, number), members in groups.items():
        column = sheet[cell]
        own = numbers[column.name]
        if number in own or not own:
            continue
        named = [other for other in sheet.columns if number in numbers[other.name]]
        fitting = [other for other in named if _alike(other, column)]
        mismatch = {cell: _as(problem, members, cell, first)}
        rivals = [
            other.name for other in sheet.columns
            if other.name != cell and _alike(other, column) and numbers[other.name]
        ]  # fmt: skip
        mismatch |= {name: _as(problem, members, name, first) for name in rivals}
        would = min(mismatch, key=lambda name: mismatch[name])
        if mismatch[would] > 1 or (would in {f.name for f in fitting}):
            continue
        right = next(iter(sorted(numbers[would])))
        gives = tuple((other.name, other.unit) for other in named if not fitting)
        wanted = column.meaning.split(",")[0], column.unit
        others = {name: off for name, off in mismatch.items() if name != would and isfinite(off)}
        yield Relabelled(source, would, number, right, gives, wanted, mismatch[would], others)


def _alike(one: Column, other: Column) -> bool:
    return one.axis == other.axis and one.unit == other.unit


def _as(problem: Problem, members: Sequence[int], cell: str, first: Explained | None) -> float:
    """The worst mismatch of all values if some were those of another column; infinite where none has a value.

    A row that has none there, such as one that rests on what was not measured, is not asked for.
    """
    asked = (problem if first is None else first.problem).renamed(members, cell)
    box = _like(asked, first)
    cells = asked.at((box or asked.box).start).cells
    lost = [n for n in members if isnan(cells[n])]
    if len(lost) == len(members):
        return inf
    asked = asked.ignoring(lost)
    return counted(asked, best(asked, box), box).mismatch


def _like(problem: Problem, first: Explained | None) -> Box | None:
    """A problem's box with what an explanation changes in it."""
    if first is None:
        return None
    where = {(u.column, u.row): n for n, u in enumerate(first.problem.unknowns)}
    box = problem.box
    for n, unknown in enumerate(problem.unknowns):
        its = where.get((unknown.column, unknown.row))
        if its is not None and unknown.printed is not None:
            box = box.moved([n], [first.box.low[its]], [first.box.high[its]], [first.best.point[its]])
    return box


def fits(problem: Problem, names: Sequence[str], first: Explained | None) -> tuple[Fit, ...]:
    """Tell which of the workbook's averages and fits each published one is.

    Each is asked for together with the published values that it is computed from.

    Parameters
    ----------
    problem : Problem
        All published values.
    names : sequence of str
        The columns it may be.
    first : Explained or None
        The change with which all values come out, if they need one.
    """
    found, whole = [], problem if first is None else first.problem
    campaign, sheet = whole.campaign, whole.campaign.sheet
    for value in problem.published:
        if value.cell not in names:
            continue
        rivals = [name for name in names if sheet[name].unit == sheet[value.cell].unit]
        behind = {a.name for name in rivals for a in sheet.ancestors(sheet[name])}
        asked = [other for other in whole.published if other.cell in behind and other.cell not in names]
        if len(rivals) < 2 or not asked:
            continue
        mismatch = {}
        for name in rivals:
            those = [*asked, replace(value, cell=name)]
            own = Problem.of(campaign, those, campaign.free, whole.conventions)
            box = _like(own, first)
            mismatch[name] = counted(own, best(own, box, until=PLENTY), box).mismatch
        mismatch = {name: off for name, off in mismatch.items() if isfinite(off)}
        if len(mismatch) < 2:
            continue
        # Which of two that are shown alike comes first shall not depend on their last digits.
        ranked = sorted(mismatch.items(), key=lambda item: (float(in_words(item[1])), names.index(item[0])))
        found.append(Fit(value, dict(ranked)))
    return tuple(found)
