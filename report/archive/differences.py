"""Two results side by side, number by number: same, within rounding, moved, made by another method."""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass

from msgspec import UNSET

from ..cells.address import address
from ..files.form import Index
from ..files.values import Column, Conformity, Result
from ..quantity import behind
from ..result.agreement import LIMIT

__all__ = ["Differences", "Move", "OtherChange", "compare"]

SURELY = 1e-6
"""Relative: what an uncertainty may differ by, of which nobody reads the third digit."""
EPS = sys.float_info.epsilon
Held = tuple[float | None, str]
"""A number in SI and a status."""


@dataclass(frozen=True)
class Move:
    """A number that is another one."""

    address: str
    """``alpha[1-2]``."""
    unit: str
    """In which people read it; in SI, if that tells none."""
    kind: str
    """``input`` if the user gives it, ``result`` of one of the headline, ``moved`` of all else."""
    before: float | None
    after: float | None
    """`before` and `after`: in that unit; None where it has no value."""
    status: tuple[str, str]
    """Before and after."""
    by: tuple[float, str] | None = None
    """The difference in SI with its unit, where a share tells nothing: of temperatures in degC."""
    word: str = ""
    """What the row is known by besides its number, in both; empty for none."""

    @property
    def named(self) -> str:
        """The address, with the word of its row.

        >>> Move("x[2]", "m", "moved", 1.0, 2.0, ("ok", "ok"), word="Ref A").named
        'x[2] (Ref A)'
        """
        return f"{self.address} ({self.word})" if self.word else self.address

    @property
    def relative(self) -> float | None:
        """The difference relative to what it was; None where there is nothing to divide, or by."""
        if self.before is None or self.after is None or self.before == 0:
            return None
        return (self.after - self.before) / abs(self.before)


@dataclass(frozen=True)
class OtherChange:
    """Something else that is another one: an equation, a proof, a verdict; empty where there was none."""

    name: str
    before: str
    after: str


@dataclass(frozen=True)
class Differences:
    """What distinguishes two results."""

    before: str
    after: str
    """`before` and `after`: their names."""
    same: int
    """How many numbers are the same double, or have the same error; uncertainties are numbers too."""
    noise: int
    """How many differ by what rounding may do."""
    moved: tuple[Move, ...]
    """The others: what the user gives first, then the headline, then other scalars, then the rest in the
    order of the sheet, what only leads to other cells last. ``u(alpha_mean)``, the standard uncertainty of a
    number, stands behind what the user gives and behind a result; those of all else come last."""
    method: tuple[OtherChange, ...]
    """Columns that follow another equation, or have another unit or index set, and equations whose proof came
    out otherwise."""
    added: tuple[str, ...]
    removed: tuple[str, ...]
    """`added` and `removed`: columns and rows that only one of them has."""
    rows: tuple[OtherChange, ...]
    """Rows that are called otherwise: of an index set, by their numbers."""
    published: tuple[OtherChange, ...]
    """Published values with another verdict."""
    checks: tuple[OtherChange, ...]
    """What is told of the data: decisions on conformity, marks, warnings, what is expected or left out."""

    @property
    def any(self) -> bool:
        """Whether they differ by more than rounding."""
        told = self.moved, self.method, self.added, self.removed, self.rows, self.published, self.checks
        return any(told)


def compare(
    before: Result,
    after: Result,
    allowed: Mapping[str, Mapping[Index, float]] | None = None,
    names: tuple[str, str] = ("before", "after"),
) -> Differences:
    """Compare two results.

    Two doubles count as the same within rounding if they differ by at most 8 eps of the larger: the limit
    to which engines are held, for a number whose condition is 1. Who knows the conditions of the cells
    says what is allowed.

    `allowed` (mapping of column name to mapping of index to float): how much each cell may differ, in SI;
    used where it is more. `names`: what they are called.
    """
    same = noise = 0
    moved: list[tuple[tuple[int, ...], Move]] = []
    headline, aside = after.headline or before.headline, {*before.aside, *after.aside}
    for name, old in before.cells.items():
        new = after.cells.get(name)
        if new is None:
            continue
        kind, rank = "moved", (4 if name in aside else 3 if old.axis else 2, 0)
        if old.rule == new.rule == "given":
            kind, rank = "input", (0, 0)
        elif name in headline:
            kind, rank = "result", (1, headline.index(name))
        there, words = new.cells, dict(before.known(name).items() & after.known(name).items())
        for index, was in old.cells.items():
            if index not in there:
                continue
            now, named, word = there[index], address(name, index), words.get(index, "")
            if was == now:
                same += 1
            elif _within(was, now, (allowed or {}).get(name, {}).get(index, 0.0)):
                noise += 1
            else:
                moved.append(((0, *rank), _move(named, word, kind, new, was, now, False)))
            if index in old.uncertainties and index in new.uncertainties:
                surer = old.uncertainties[index], new.uncertainties[index]
                if _as_sure(*surer):
                    same += 1
                else:
                    u_was, u_now = ((each, "not known") for each in surer)
                    place = (int(kind == "moved"), *rank)
                    moved.append((place, _move(f"u({named})", word, kind, new, u_was, u_now, True)))
    return Differences(
        *names,
        same,
        noise,
        tuple(move for _, move in sorted(moved, key=lambda item: item[0])),
        (*_rules(before, after), *_changes(before.proofs, after.proofs)),
        tuple(_only_in(after, before)),
        tuple(_only_in(before, after)),
        tuple(_changes(_called(before), _called(after))),
        tuple(_changes(_verdicts(before), _verdicts(after))),
        tuple(_changes(_checks(before), _checks(after))),
    )


def _move(named: str, word: str, kind: str, column: Column, was: Held, now: Held, is_u: bool) -> Move:
    """What moved, in the unit that its column is shown in; uncertainties of degC are differences, in K."""
    (before, status_before), (after, status_after) = was, now
    status = status_before, status_after
    shown = column.shown
    if shown is UNSET or (is_u and shown.zero):
        return Move(named, column.unit, kind, before, after, status, word=word)
    by = None
    if shown.zero and before is not None and after is not None:
        by = after - before, column.unit
    return Move(named, shown.text, kind, shown.of(before), shown.of(after), status, by, word)


def _within(was: Held, now: Held, allowed: float) -> bool:
    if was[0] is None or now[0] is None or was[1] != now[1]:
        return False
    return abs(now[0] - was[0]) <= max(LIMIT * EPS * max(abs(was[0]), abs(now[0])), allowed)


def _as_sure(was: float | None, now: float | None) -> bool:
    """Whether two standard uncertainties are the same."""
    return was == now if was is None or now is None else math.isclose(was, now, rel_tol=SURELY)


def _rules(before: Result, after: Result) -> list[OtherChange]:
    found = []
    for name, old in before.cells.items():
        new = after.cells.get(name)
        if new is not None and _method(old) != _method(new):
            found.append(OtherChange(name, _method(old), _method(new)))
    if before.workbook != after.workbook:
        found.insert(0, OtherChange("workbook", before.workbook, after.workbook))
    return found


def _method(column: Column) -> str:
    over = f" on {column.axis}" if column.axis else ""
    return f"{column.rule or 'not told'} [{column.unit}]{over}"


def _called(result: Result) -> dict[str, str]:
    """The word of each row that has one, as ``samples 2``."""
    every = {} if result.words is UNSET else result.words
    return {f"{axis} {number}": word for axis, words in every.items() for number, word in words.items()}


def _verdicts(result: Result) -> dict[str, str]:
    """Of each published value, as ``Table 2 alpha[1-2]``, what it prints and the verdict on it."""
    return {
        f"{each.source} {address(each.cell, each.index)}": f"{each.printed}: {each.verdict}"
        for each in (*result.published, *(() if result.published_u is UNSET else result.published_u))
    }


def _checks(result: Result) -> dict[str, str]:
    """Of each check that found something, as ``limit alpha``, what it told; of each limit, the decision."""
    told = {f"{each.kind} {each.name}": each.sentence for each in result.oddities}
    decided = () if result.conformity is UNSET else result.conformity
    return told | {
        f"limits {each.cell}": f"{each.limits}: {_decision(each, result.cells[each.column])}"
        for each in decided
    }


def _decision(found: Conformity, column: Column) -> str:
    unit, ends = column.unit, found.acceptance
    if column.shown is not UNSET:
        unit, ends = column.shown.text, (column.shown.of(ends[0]), column.shown.of(ends[1]))
    return f"{found.decision}, accepted from {' to '.join(map(_end, ends))}" + behind(unit)


def _end(value: float | None) -> str:
    return "..." if value is None else f"{value:.12g}"


def _changes(before: Mapping[str, str], after: Mapping[str, str]) -> list[OtherChange]:
    names = dict.fromkeys([*before, *after])
    pairs = [OtherChange(name, before.get(name, ""), after.get(name, "")) for name in names]
    return [change for change in pairs if change.before != change.after]


def _only_in(one: Result, other: Result) -> list[str]:
    """Columns, and rows of columns that both have; one name for rows that all columns of an axis gain."""
    found = []
    for name, column in one.cells.items():
        if name not in other.cells:
            found.append(name)
            continue
        there = other.cells[name].cells
        found += [address(name, index) for index in column.cells if index not in there]
    return found
