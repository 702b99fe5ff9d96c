"""Numbers and rows that stand under the wrong name: exchanged cells, columns and orders."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..result.verdict import INPUT, Change
from .campaign import Array
from .minimax import best
from .problem import Box, Problem
from .search import Explained, Search


def exchanged_in_tables(search: Search) -> Iterator[Explained]:
    """Two published values of a column that stand in each other's place."""
    published = search.problem.published
    for members in search.groups.values():
        for n, m in combinations(members, 2):
            one, other = published[n], published[m]
            if one.printed.text == other.printed.text or not search.worth({n, m}):
                continue
            texts = one.printed.text, other.printed.text
            change = Change("label", one.cell, one.index, one.source, *texts, other=other.index)
            changed = search.problem.reprinted({n: other.printed, m: one.printed})
            yield from search.if_met([change], changed)


def exchanged_rows(search: Search) -> Iterator[Explained]:
    """Two rows of a table that stand in each other's place, in all of its columns."""
    problem, tables = search.problem, dict[tuple[str, str], dict[tuple[int, ...], dict[str, int]]]()
    for (source, cell), members in search.groups.items():
        if (axis := problem.campaign.sheet[cell].axis) is not None:
            rows = tables.setdefault((source, axis.name), {})
            for n in members:
                rows.setdefault(problem.published[n].index, {})[cell] = n
    tried = list[tuple[Change, Problem, Box | None]]()
    for (source, _), rows in tables.items():
        for one, other in combinations(rows, 2):
            pairs = [(rows[one][cell], rows[other][cell]) for cell in rows[one] if cell in rows[other]]
            prints = {n: problem.published[m].printed for pair in pairs for n, m in (pair, pair[::-1])}
            moved = [n for n, print_ in prints.items() if print_.text != problem.published[n].printed.text]
            if len(moved) > 2 and search.worth(moved):  # two numbers of a column are exchanged alone
                change = Change("label", "", one, source, "", "", other=other)
                tried.append((change, problem.reprinted(prints), None))
    yield from search.of_likeliest(tried)


def exchanged_inputs(search: Search) -> Iterator[Explained]:
    """Two numbers of a given column that stand in each other's place."""
    problem, tried = search.problem, list[tuple[int, int, Box]]()
    for members in problem.rows.values():
        for n, m in combinations(members, 2):
            one, other = problem.unknowns[n], problem.unknowns[m]
            if one.printed is None or other.printed is None or one.printed.text == other.printed.text:
                continue
            if search.worth(search.resting_on([n, m])):
                low, high = zip(other.interval(), one.interval(), strict=True)
                tried.append((n, m, problem.box.moved([n, m], low, high, [other.start, one.start])))
    for place in search.screened([box for *_, box in tried]):
        n, m, box = tried[place]
        box = replace(box, start=problem.restarted(box.start[None])[0])
        now = search.met_if_hopeful(problem, box)
        if now is not None:
            one, other = problem.unknowns[n], problem.unknowns[m]
            assert one.printed is not None
            assert other.printed is not None
            texts = one.printed.text, other.printed.text
            change = Change("label", one.column, one.index, INPUT, *texts, other=other.index)
            yield search.explained([change], problem, box, now)


def columns(search: Search) -> Iterator[Explained]:
    """A row of a table that holds another column than the one it is named after."""
    campaign = search.problem.campaign
    for (source, cell), members in search.groups.items():
        own = campaign.sheet[cell]
        alike = [
            column for column in campaign.sheet.columns
            if column.name != cell and column.axis == own.axis and column.unit == own.unit
        ]  # fmt: skip
        if not alike or not search.worth(members):
            continue
        for column in alike:
            change = Change("label", cell, (), source, cell, column.name)
            yield from search.if_met([change], search.problem.renamed(members, column.name))


def orders(search: Search) -> Iterator[Explained]:
    """A list of a table that stands in another order than its rows."""
    for (source, cell), members in search.groups.items():
        if len(members) < 3 or not search.worth(members):
            continue
        changed, point, order = search.problem, search.problem.box.start, list(members)
        for _ in range(5):
            cells = search.problem.guessing.evaluate(point[None])[0]
            if not np.isfinite(cells).all():
                break
            new = _assigned(search.problem, members, cells)
            if new == order:
                break
            order = new
            changed = search.problem.reprinted({
                n: search.problem.published[m].printed for n, m in zip(members, order, strict=True)
            })  # fmt: skip
            point = best(changed, replace(changed.box, start=point)).point
        if order == members:
            continue
        now = search.met(changed, replace(changed.box, start=point))
        if now is not None:
            texts, would = (
                ", ".join(search.problem.published[n].printed.text for n in rows) for rows in (members, order)
            )
            change = Change("order", cell, (), source, texts, would, count=_exchanges(members, order))
            yield search.explained([change], changed, changed.box, now)


def _assigned(problem: Problem, members: Sequence[int], cells: Array) -> list[int]:
    """Which print goes best with which row."""
    centre, half = problem.centre[list(members)], problem.half[list(members)]
    cost = ((cells[list(members)][:, None] - centre) / half) ** 2
    _, found = linear_sum_assignment(cost)
    return [members[n] for n in found.tolist()]


def _exchanges(before: Sequence[int], after: Sequence[int]) -> int:
    """How many exchanges of two make one order out of another."""
    follows, seen, cycles = dict(zip(before, after, strict=True)), set(), 0
    for start in before:
        here, cycles = start, cycles + (start not in seen)
        while here not in seen:
            seen.add(here)
            here = follows[here]
    return len(before) - cycles
