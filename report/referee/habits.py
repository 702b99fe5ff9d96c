"""Honest habits: what was computed from rounded numbers, or in conventions that are not printed."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence, Set
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ...derivations.unit_text import is_pure
from ..cells.address import index_text
from ..engines.numpy import Program, evaluate
from ..inputs.measurements import Measurements
from ..result.verdict import INPUT, Change
from ..sheet import Axis, Column, Formula, Given, MemberAxis, Sheet
from .campaign import Array, Campaign
from .minimax import Best, best
from .misprints import freed
from .problem import Box, Problem
from .search import Explained, Search
from .ways import Way, from_printed, over_rows

NEUTRAL = ("0", "1")
"""What a correction is that is not made, and a factor."""
CHOSEN, MOST_DIGITS = 3, 6
"""Significant digits of a convention that somebody may have chosen, and of one that is looked for."""
CHOSEN_FOR_ONE = 2
"""The same where one published value alone is another: some number always yields that."""
MOST_TESTS = 100
"""Of more than so many none is left out of all averages at a time: with a hundred a check takes a minute."""


@dataclass(frozen=True)
class _Habit:
    """Some published values that were computed from what is printed."""

    change: Change
    members: frozenset[int]
    way: Way


def computed_from_printed(search: Search) -> Iterator[Explained]:
    """Published values that were computed from printed, rounded ones: one habit, else two together."""
    habits = list(_habits(search))
    for number in (1, 2):
        apart = filter(_apart, combinations(habits, number))
        some = [those for those in apart if search.worth(_members(those))]
        asked = [(_computed(search.problem, those), None) for those in some]
        found = search.likeliest(asked)
        # From more columns they were computed only if that makes a difference.
        different = {(_members(some[n]), now.mismatch): (n, now) for n, now in reversed(found)}
        for n, now in reversed(different.values()):
            problem = asked[n][0]
            yield search.explained([habit.change for habit in some[n]], problem, problem.box, now)
        if found:
            return


def _apart(habits: Sequence[_Habit]) -> bool:
    return len(_members(habits)) == sum(len(habit.members) for habit in habits)


def _members(habits: Sequence[_Habit]) -> frozenset[int]:
    return frozenset[int]().union(*(habit.members for habit in habits))


def _computed(problem: Problem, habits: Sequence[_Habit]) -> Problem:
    for habit in habits:
        problem = problem.computed(habit.way, habit.members)
    return problem


def _habits(search: Search) -> Iterator[_Habit]:
    """What may have been computed from what is printed: each column of a table, and each table."""
    problem = search.problem
    campaign, sheet = problem.campaign, problem.campaign.sheet
    printed = _printed_columns(search)
    tables: dict[str, list[tuple[str, list[int]]]] = {}
    for (source, cell), members in search.groups.items():
        tables.setdefault(source, []).append((cell, members))
        nearest = _nearest(problem, sheet[cell], printed)
        if nearest:
            given = {name: values for name, values in printed.items() if name in nearest}
            yield _habit(problem, source, [(cell, members)], given)
    for source, cells in tables.items():
        own = {cell for cell, _ in cells}
        for name in sorted(own & printed.keys()):  # all that rest on it, whatever is printed in between
            resting = [(cell, m) for cell, m in cells if _rests_on(problem, cell, [name])]
            if len(resting) > 1:
                yield _habit(problem, source, resting, {name: printed[name]})
        elsewhere = {name: values for name, values in printed.items() if name not in own}
        nearest = {name for cell in own for name in _nearest(problem, sheet[cell], elsewhere)}
        resting = [(cell, m) for cell, m in cells if _nearest(problem, sheet[cell], elsewhere)]
        if nearest and len(resting) > 1:
            given = {name: values for name, values in elsewhere.items() if name in nearest}
            yield _habit(problem, source, resting, given)
            measured = {
                name: np.array([float(p.value) if p else np.nan for p in column])
                for name, column in campaign.inputs.measured.items()
            }
            yield _habit(problem, source, resting, {**given, **measured})


def _printed_columns(search: Search) -> dict[str, Array]:
    """The computed columns of which every row is published, as printed, in SI."""
    problem = search.problem
    found: dict[str, Array] = {}
    for (_, cell), members in search.groups.items():
        size = len(problem.campaign.values.labels(problem.campaign.sheet[cell]))
        if {problem.places[n][1] for n in members} == set(range(size)) and len(members) == size:
            order = sorted(members, key=lambda n: problem.places[n][1])
            found.setdefault(cell, np.array([float(problem.published[n].printed.value) for n in order]))
    return found


def _nearest(problem: Problem, column: Column, printed: Collection[str]) -> set[str]:
    """The printed columns that a column rests on with no printed one in between."""
    sheet, found, waiting, seen = problem.campaign.sheet, set[str](), [column], set[str]()
    while waiting:
        for precedent in sheet.precedents(waiting.pop()):
            if precedent.name in printed:
                found.add(precedent.name)
            elif precedent.name not in seen:
                seen.add(precedent.name)
                waiting.append(precedent)
    return found


def _habit(
    problem: Problem, source: str, cells: Sequence[tuple[str, list[int]]], given: dict[str, Array]
) -> _Habit:
    names = [cell for cell, _ in cells]
    members = frozenset(n for _, rows in cells for n in rows)
    way = from_printed(problem.campaign, names, given)
    used = ", ".join(name for name in given if name in way.printed)
    cell = names[0] if len(names) == 1 else ""
    return _Habit(Change("printed", cell, (), source, "", used, count=0), members, way)


# --- sums and means over other rows -----------------------------------------------------------------------


def every_row(search: Search) -> Iterator[Explained]:
    """Published averages and fits that count the rows, too, which tell nothing and are left out for that."""
    problem, campaign = search.problem, search.problem.campaign
    sheet, values = campaign.sheet, campaign.values
    silent = {limit.mark for column in sheet.columns for limit in column.limits if limit.silent}
    by = {c.name: says for c in sheet.columns for says in c.conditions if says in silent}
    broken = [name for name in by if name in values.broken and values.broken[name].any()]
    resting = {name: {a.name for a in sheet.ancestors(sheet[name])} for _, name in search.groups}
    for name in broken:
        members = [n for n, value in enumerate(problem.published) if name in resting[value.cell]]
        if not members or not search.worth(members):
            continue
        cells = [problem.published[n].cell for n in members]
        program = campaign.program(cells, tuple(free for free in campaign.free if free not in cells))
        asked = [(problem.computed(Way(_with_every(program, silent), campaign.labels), members), None)]
        for _, now in search.likeliest(asked):
            scalars = [n for n in members if not problem.published[n].index] or members[:1]
            would = f"with all {sheet[name].axis.name}, those left out here, too ({by[name]})"  # type: ignore[union-attr]
            changes = [
                Change("rows", p.cell, p.index, p.source, p.printed.text, would, count=0)
                for p in (problem.published[n] for n in scalars)
            ]
            yield search.explained(changes, asked[0][0], problem.box, now)


def _with_every(program: Program, silent: Set[str]) -> Program:
    """The same without the conditions that leave rows out."""
    return Program.of(
        Sheet(
            tuple(
                replace(column, requires=tuple(each for each in column.requires if each[1] not in silent))
                if silent & set(column.conditions)
                else column
                for column in program.sheet.columns
            )
        )
    )


def without_a_test(search: Search) -> Iterator[Explained]:
    """Several published averages, scatters and fits that all leave out the same test."""
    problem, campaign = search.problem, search.problem.campaign
    for table in campaign.inputs.tables:
        columns = [name for name in table.measured if name in problem.sheet]
        resting = sorted(_resting_on(problem, columns))
        members = [n for n in resting if problem.sheet[problem.published[n].cell].axis is None]
        if len(members) < 2 or len(table.tests) > MOST_TESTS or not search.worth(members):
            continue
        yield from _without_one(search, members, table, range(len(table.tests)))


def _without_one(
    search: Search, members: Sequence[int], table: Measurements, rows: Sequence[int]
) -> Iterator[Explained]:
    """Published values that all leave out the same of some rows of a table."""
    campaign, cells = search.problem.campaign, [search.problem.published[n].cell for n in members]
    program = campaign.program(cells, tuple(free for free in campaign.free if free not in cells))
    own = [name for name in table.measured if name in program.sheet]
    ways = [Way(program, campaign.labels, gone=dict.fromkeys(own, row)) for row in rows]
    told = [f"without {table.row} {table.called(table.tests[row])}" for row in rows]
    yield from _over_rows(search, members, ways, told)


def _rests_on(problem: Problem, cell: str, columns: Collection[str]) -> bool:
    sheet = problem.sheet
    return any(each.name in columns for each in sheet.ancestors(sheet[cell]))


def other_rows(search: Search) -> Iterator[Explained]:
    """A published mean that leaves out a row or all rows of a test, or counts one twice.

    Of the mean of a group, one that leaves out a row.
    """
    problem, sheet = search.problem, search.problem.campaign.sheet
    for n, value in enumerate(problem.published):
        column = sheet[value.cell]
        axes = sheet.summed_axes(column)
        if len(axes) != 1 or axes[0].repeats or not isinstance(column.rule, Formula):
            continue
        axis = axes[0]
        if (column.axis is not None and not isinstance(axis, MemberAxis)) or not search.worth({n}):
            continue
        if isinstance(axis, MemberAxis):
            groups = enumerate(problem.campaign.labels[axis.name])
            own = [row for row, group in groups if (group,) == value.index]
            if len(own) <= MOST_TESTS:
                yield from _without_one(search, [n], problem.campaign.inputs.on(axis.of.name), own)
            continue
        rows = dict(_rows(problem.campaign, axis))
        yield from _over_rows(search, [n], over_rows(column, axis, list(rows.values()), sheet), list(rows))


def _over_rows(
    search: Search, members: Sequence[int], ways: Sequence[Way], told: Sequence[str]
) -> Iterator[Explained]:
    """Published values that all were computed in one of some ways, of which each is told."""
    asked = [(search.problem.computed(way, members), None) for way in ways]
    found = sorted(search.likeliest(asked), key=lambda one: one[1].mismatch)
    if found:
        would, *also = (told[place] for place, _ in found)
        first, *others = (
            Change("rows", value.cell, value.index, value.source, value.printed.text, would, count=0)
            for value in (search.problem.published[n] for n in members)
        )
        changes = [replace(first, also=tuple(also), count=1), *others]
        changed = asked[found[0][0]][0]
        yield search.explained(changes, changed, changed.box, found[0][1])


def _rows(campaign: Campaign, axis: Axis) -> Iterator[tuple[str, NDArray[np.intp]]]:
    """Rows of an axis, and what is said of them: the likelier mistakes first."""
    labels = campaign.values.layouts[axis.name].labels
    number = len(labels)
    every = np.arange(number)
    names = [index_text(label) for label in labels.tolist()]
    if axis.is_given:
        table = campaign.inputs.on(axis.name)
        names = [f"{table.row} {table.called(test)}" for (test,) in labels.tolist()]
    for row, name in enumerate(names):
        yield f"without {name}", np.delete(every, row)
    for row, name in enumerate(names):
        yield f"with {name} twice", np.append(every, row)
    if labels.shape[1] > 1:
        for test in np.unique(labels):
            kept = every[~(labels == test).any(axis=1)]
            if 0 < len(kept) < number - 1:
                yield f"without all of {test}", kept


# --- conventions ------------------------------------------------------------------------------------------


def other_conventions(search: Search) -> Iterator[Explained]:
    """A parameter that is a convention, and has another value than is said or taken for granted."""
    problem = search.problem
    counts = {axis.repeats for axis in problem.campaign.sheet.axes}
    for column in problem.campaign.sheet.columns:
        if (
            isinstance(column.rule, Given)
            and column.exact
            and column.name in problem.campaign.inputs.parameters
            and problem.campaign.suspects(column.name)
        ):
            yield from (_other_count if column.name in counts else _other_number)(search, column)


def _change(problem: Problem, column: Column, would: str, also: tuple[str, ...] = ()) -> Change:
    inputs = problem.campaign.inputs
    text = inputs.parameters[column.name].text
    count = int(column.name in inputs.given)
    return Change("parameter", column.name, (), INPUT, text, would, also, count=count)


def _other_number(search: Search, column: Column) -> Iterator[Explained]:
    """Another number, the one with fewest digits that will do."""
    own = search.problem
    problem = Problem.of(own.campaign, own.published, asked=(column.name,))
    (n,) = problem.rows.get(column.name, (None,))
    if n is None:
        return
    touches = frozenset(np.flatnonzero(problem.touched[:, n]).tolist())
    if not touches or not search.worth(touches):
        return
    point = freed(search, problem, n)
    if point is None:
        return
    printed = problem.campaign.inputs.parameters[column.name]
    for digits in range(1, MOST_DIGITS + 1):
        text = f"{float(f'{printed.of(point[n]):.{digits}g}'):g}"
        now, box = _taken_as(problem, n, text, point)
        if now.mismatch <= 1:
            change = _change(problem, column, text)
            if digits > (CHOSEN if len(search.differing) > 1 else CHOSEN_FOR_ONE):
                change = replace(change, count=1)
            yield search.explained([change], problem, box, now)
            return
    search.drop(certain=False)


def _taken_as(problem: Problem, n: int, text: str, start: Array) -> tuple[Best, Box]:
    """What comes out where a given cell is another number, in the unit of its print."""
    printed = problem.campaign.inputs.parameters[problem.unknowns[n].column]
    value = float(Fraction(text) * printed.scale + printed.zero)
    box = replace(problem.box, start=start).moved([n], [value], [value], [value])
    return best(problem, box), box


def neglected(search: Search) -> Iterator[Explained]:
    """What was taken as if there were none of it: as 0, also a measured column, or a factor as 1."""
    own = search.problem
    for name, printed in own.campaign.inputs.parameters.items():
        if name not in own.campaign.sheet or not own.campaign.suspects(name):
            continue
        column, touches = own.campaign.sheet[name], _resting_on(own, [name])
        if not touches or not search.worth(touches):
            continue
        problem = Problem.of(own.campaign, own.published, asked=(name,))
        for n in problem.rows.get(name, ()):
            for text in NEUTRAL[: 0 if printed.zero else 2 if is_pure(printed.unit) else 1]:
                value = Fraction(text) * printed.scale
                if value == printed.value or not problem.unknowns[n].allowed.allow(value):
                    continue
                now, box = _taken_as(problem, n, text, problem.box.start)
                if now.mismatch <= 1:
                    yield search.explained([replace(_change(own, column, text), count=1)], problem, box, now)
                else:
                    search.drop(certain=False)
    for name, members in own.rows.items():
        nothing, first = [0.0] * len(members), own.unknowns[members[0]].printed
        if name not in own.campaign.inputs.measured or first is None or first.zero:
            continue
        allowed = all(own.unknowns[n].allowed.allow(Fraction(0)) for n in members)
        is_there = own.campaign.suspects(name) and own.box.start[members].any()
        if allowed and is_there and search.worth(search.resting_on(members)):
            change = Change("neglect", name, (), INPUT, "", NEUTRAL[0])
            yield from search.if_met([change], own, own.box.moved(members, nothing, nothing, nothing))


def rounded_constants(search: Search) -> Iterator[Explained]:
    """A constant of nature, or of a standard, with fewer digits than it has: R = 8.314 of a textbook."""
    own = search.problem
    campaign, constants = own.campaign, own.campaign.inputs.workbook.constants
    for column in campaign.sheet.columns:
        name = column.name
        if name not in constants or campaign.suspects(name) or not column.exact:
            continue
        touched = _resting_on(own, [column.name])
        if not touched or not search.worth(touched):
            continue
        printed = campaign.inputs.parameters[name]
        fewer = range(2, min(MOST_DIGITS, printed.digits - 1) + 1)
        texts = list(dict.fromkeys(f"{float(printed.number):.{digits}g}" for digits in fewer))
        numbers = [float(Fraction(text) * printed.scale + printed.zero) for text in texts]
        asked = [(Problem.of(_with(campaign, column, number), own.published), None) for number in numbers]
        for place, now in search.likeliest(asked)[:1]:
            changed = asked[place][0]
            yield search.explained([_change(own, column, texts[place])], changed, changed.box, now)


COUNTS = (
    *range(2, 13), 15, 16, 20, 24, 25, 30, 32, 40, 50, 60, 64, 75, 80, 99, 100, 101, 120, 128, 150, 200, 250,
    256, 300, 400, 500, 512, 1000,
)  # fmt: skip
"""Numbers of rows that somebody may choose."""


def _other_count(search: Search, column: Column) -> Iterator[Explained]:
    """Another number of rows that each row of an axis is repeated to."""
    own = search.problem
    touched = _resting_on(own, [column.name])
    if not touched or not search.worth(touched):
        return
    counts = [count for count in COUNTS if count != own.campaign.data[column.name]]
    asked = [(Problem.of(_with(own.campaign, column, count), own.published), None) for count in counts]
    found = search.likeliest(asked)
    if found:
        texts = [str(counts[place]) for place, _ in found]
        changed = asked[found[0][0]][0]
        change = _change(own, column, texts[0], tuple(texts[1:]))
        yield search.explained([change], changed, changed.box, found[0][1])


def _with(campaign: Campaign, column: Column, value: float) -> Campaign:
    data = {**campaign.data, column.name: float(value)}
    program = campaign.program([c.name for c in campaign.sheet.columns])
    return replace(campaign, data=data, values=evaluate(program.sheet, campaign.labels, data, program))


def _resting_on(problem: Problem, names: Collection[str]) -> frozenset[int]:
    """The places of the published values that rest on one of some columns."""
    return frozenset(n for n, value in enumerate(problem.published) if _rests_on(problem, value.cell, names))
