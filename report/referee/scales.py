"""How numbers were shortened, and in which unit they stand: for a column, a parameter or a cell."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from ..quantity import Printed
from ..result.verdict import INPUT, Change
from .campaign import Unknown
from .problem import Box, Problem
from .search import Explained, Search

__all__ = ["misplaced_inputs", "misplaced_tables", "truncated_inputs", "truncated_tables"]

POWERS = (-1, 1, -2, 2, -3, 3, -6, 6)
"""By which powers of ten a unit or a decimal point may be wrong, the likelier first."""


def truncated_inputs(search: Search) -> Iterator[Explained]:
    """A given column that was cut where it is said to be rounded, or the reverse."""
    problem = search.problem
    for name, members in problem.rows.items():
        printed = problem.unknowns[members[0]].printed
        if printed is None or problem.sheet[name].exact or not problem.campaign.suspects(name):
            continue
        if not search.worth(search.resting_on(members)):
            continue
        was, would = printed.mode, _other(printed.mode)
        low, high = zip(*(problem.unknowns[n].interval(mode=would) for n in members), strict=True)
        if np.array_equal((low, high), (problem.box.low[members], problem.box.high[members])):
            continue  # of what is exact nothing was cut
        middles = [(one + other) / 2 for one, other in zip(low, high, strict=True)]
        moved = problem.box.moved(members, low, high, middles)
        now = search.met(problem, moved)
        if now is not None:
            change = Change("truncated", name, (), INPUT, was, would)
            yield search.explained([change], problem, moved, now)


def truncated_tables(search: Search) -> Iterator[Explained]:
    """A published column that was cut where it is said to be rounded, or the reverse."""
    problem = search.problem
    for (source, cell), members in search.groups.items():
        if not search.worth(members):
            continue
        was = problem.published[members[0]].printed.mode
        changed = problem.reprinted({
            n: replace(problem.published[n].printed, mode=_other(was)) for n in members
        })  # fmt: skip
        now = search.met(changed)
        if now is not None:
            change = Change("truncated", cell, (), source, was, _other(was))
            yield search.explained([change], changed, changed.box, now)


def _other(mode: str) -> str:
    return "rounded" if mode == "truncated" else "truncated"


@dataclass(frozen=True)
class _Misplaced:
    """Given cells whose decimal points may stand elsewhere."""

    members: Sequence[int]
    power: int
    box: Box

    def change(self, unknowns: Sequence[Unknown]) -> Change:
        """What that says."""
        first = unknowns[self.members[0]]
        assert first.printed is not None
        if len(self.members) > 1:
            return Change("unit", first.column, (), INPUT, "", "", power=self.power)
        would = shifted(first.printed, self.power).text
        return Change("unit", first.column, first.index, INPUT, first.printed.text, would, power=self.power)


def shifted(of: Printed, power: int) -> Printed:
    """The same digits with the decimal point elsewhere: 2.97 and 29.7."""
    mantissa, _, exponent = of.text.lower().partition("e")
    places = len(mantissa.partition(".")[2]) - int(exponent or 0) - power
    digits = mantissa.replace(".", "").lstrip("+-0") or "0"
    sign = "-" if mantissa.startswith("-") else ""
    if places < 0:
        text = f"{sign}{digits}e{-places}"
    else:
        padded = digits.zfill(places + 1)
        text = sign + (f"{padded[:-places]}.{padded[-places:]}" if places else padded)
    return replace(of, text=text, value=of.value * Fraction(10) ** power)


def misplaced_inputs(search: Search) -> Iterator[Explained]:
    """A given column, or a cell of it, in another unit than is said: off by a power of ten."""
    problem, tried = search.problem, list[_Misplaced]()
    for name, members in problem.rows.items():
        if problem.unknowns[members[0]].printed is None or problem.sheet[name].exact:
            continue
        if not problem.campaign.suspects(name):
            continue
        every = [members] if len(members) == 1 else [members, *([n] for n in members)]
        for some in every:
            # In another unit of a column a fit to it is far from where it is by this one.
            moved = [*some, *problem.fitted_to(name)] if some is members else some
            if search.worth(search.resting_on(moved)):
                boxes = ((power, _scaled(problem, some, power)) for power in POWERS)
                tried += [_Misplaced(some, power, box) for power, box in boxes if box is not None]
    alive = [tried[place] for place in search.screened([one.box for one in tried])]
    if not alive:
        return
    starts = problem.restarted(np.stack([one.box.start for one in alive]))
    asked = [(problem, replace(one.box, start=start)) for one, start in zip(alive, starts, strict=True)]
    for place, now in search.likeliest(asked):
        yield search.explained([alive[place].change(problem.unknowns)], *asked[place], now)


def _scaled(problem: Problem, members: Sequence[int], power: int) -> Box | None:
    """The box with some cells a power of ten larger; None where that is not allowed."""
    factor, allowed = 10.0**power, [problem.unknowns[n].allowed for n in members]
    starts = [problem.box.start[n] * factor for n in members]
    ends = [
        bounds.clip(problem.box.low[n] * factor, problem.box.high[n] * factor)
        for n, bounds in zip(members, allowed, strict=True)
    ]
    if any(not low <= start <= high for (low, high), start in zip(ends, starts, strict=True)):
        return None
    return problem.box.moved(members, [low for low, _ in ends], [high for _, high in ends], starts)


def misplaced_tables(search: Search) -> Iterator[Explained]:
    """A published column, or a cell of it, in another unit than is said."""
    problem, asked, changes = search.problem, list[tuple[Problem, Box]](), list[Change]()
    for (source, cell), members in search.groups.items():
        every = [members] if len(members) == 1 else [members, *([n] for n in members)]
        for some in every:
            if not search.worth(some):
                continue
            first = problem.published[some[0]]
            for power in POWERS:
                prints = {n: _other_unit(problem.published[n].printed, power) for n in some}
                asked.append((problem.reprinted(prints), problem.box))
                change = Change("unit", cell, (), source, "", "", power=power)
                if len(some) == 1:
                    texts = first.printed.text, shifted(first.printed, power).text
                    change = Change("unit", cell, first.index, source, *texts, power=power)
                changes.append(change)
    for place, now in search.likeliest(asked):
        yield search.explained([changes[place]], *asked[place], now)


def _other_unit(of: Printed, power: int) -> Printed:
    factor = Fraction(10) ** power
    return replace(of, value=(of.value - of.zero) * factor + of.zero, scale=of.scale * factor)
