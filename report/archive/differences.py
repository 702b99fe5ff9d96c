"""Two results side by side, number by number: same, within rounding, moved, made by another method."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass

from msgspec import UNSET

from ..axis import singular
from ..cells.address import address, named
from ..cells.address import word as is_word
from ..files.form import Index
from ..files.values import Column, Expanded, Result
from ..quantity import behind
from ..result.agreement import LIMIT

SURELY = 1e-6
"""Relative: what an uncertainty may differ by, of which nobody reads the third digit."""
EPS = sys.float_info.epsilon
Held = tuple[float | None, str]
"""A number in SI and a status."""
_CELL = re.compile(r"\w+\[[0-9-]+\]")
PAIRS = "pairs"
"""The index set whose rows are called by two numbers of others."""


@dataclass(frozen=True)
class Move:
    """A number that is another one."""

    address: str
    """``alpha[1-2]``; ``x[W1]``, where rows are compared by word."""
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
    printed: tuple[OtherChange, ...] = ()
    """What people read otherwise though its number is the same: digits, a level of coverage, the title."""
    order: tuple[str, ...] = ()
    """Index sets whose rows stand in another order, compared by word: nothing is another for that."""

    @property
    def any(self) -> bool:
        """Whether they differ by more than rounding, and than the order of rows that words tell apart."""
        told = self.moved, self.method, self.added, self.removed, self.rows, self.published
        return any((*told, self.checks, self.printed))


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

    Rows are the same if they have the same number; or the same word, where words tell all rows of an index
    set apart and their numbers only say how they stand.

    `allowed` (mapping of column name to mapping of index to float): how much each cell of `after` may differ,
    in SI; used where it is more. `names`: what they are called.
    """
    accepted = all(each.accepted is not UNSET for one in (before, after) for each in one.conformity or ())
    by_word = _by_word(before, after)
    first, last = (_Rows(each, _standing(each, by_word)) for each in (before, after))
    same = noise = 0
    moved: list[tuple[tuple[int, ...], Move]] = []
    printed = _changes({"title": before.title}, {"title": after.title})
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
        places, u_before, u_after = last.places(name), old.uncertainties, new.uncertainties
        U_before, U_after = _expanded(before, name), _expanded(after, name)
        read_before, read_after = _printed(old), _printed(new)
        for index, was in old.cells.items():
            place = places.get(first.row(name, index))
            if place is None:
                continue
            now, cell = there[place], last.address(name, place)
            word = words.get(index, "") if old.axis not in by_word else ""
            if was == now:
                same += 1
            elif _within(was, now, (allowed or {}).get(name, {}).get(place, 0.0)):
                noise += 1
            else:
                moved.append(((0, *rank), _move(cell, word, kind, new, was, now, False)))
            if index in u_before and place in u_after:
                surer = u_before[index], u_after[place]
                if _as_sure(*surer):
                    same += 1
                else:
                    u_was, u_now = ((each, "not known") for each in surer)
                    behind_all = (int(kind == "moved"), *rank)
                    moved.append((behind_all, _move(f"u({cell})", word, kind, new, u_was, u_now, True)))
                    continue
            U_was, U_now = (each.get(at) for each, at in ((U_before, index), (U_after, place)))
            if U_was and U_now and not _as_sure(U_was.U, U_now.U):  # with the same u
                U_held = (U_was.U, "not known"), (U_now.U, "not known")
                moved.append(((0, *rank), _move(f"U({cell})", word, kind, new, *U_held, True)))
            elif U_was and U_now:
                printed += _changes(*({f"U({cell})": _coverage(each)} for each in (U_was, U_now)))
            if was == now and index in read_before and place in read_after:
                printed += _changes({cell: read_before[index]}, {cell: read_after[place]})
    return Differences(
        *names,
        same=same,
        noise=noise,
        moved=tuple(move for _, move in sorted(moved, key=lambda item: item[0])),
        method=(*_rules(before, after), *_changes(before.proofs, after.proofs)),
        added=tuple(_only_in(last, first)),
        removed=tuple(_only_in(first, last)),
        rows=tuple(_changes(_called(first), _called(last))),
        published=tuple(_changes(_verdicts(first), _verdicts(last))),
        checks=tuple(_changes(_checks(first, accepted), _checks(last, accepted))),
        printed=tuple(printed),
        order=tuple(axis for axis in by_word if _reordered(_words(before, axis), _words(after, axis))),
    )


@dataclass(frozen=True)
class _Rows:
    """What tells the rows of a result apart: their numbers, or words that stand for them."""

    result: Result
    words: Mapping[str, Mapping[int, str]]
    """By index set, of those that are compared by word."""

    def row(self, name: str, index: Index) -> tuple[int | str, ...]:
        """What a row has in common with the same one of another result."""
        axis = self.result.cells[name].axis if name in self.result.cells else None
        words = self.words.get(axis or "", {})
        return tuple(words.get(number, number) for number in index)

    def address(self, name: str, index: Index) -> str:
        """A cell as both results call it: ``x[W1]``, ``alpha[W1-W3]``, ``v[2]``."""
        return address(name, self.row(name, index))

    def places(self, name: str) -> dict[tuple[int | str, ...], Index]:
        """The indices of a column, by what its rows have in common with those of another result."""
        return {self.row(name, index): index for index in self.result.cells[name].cells}

    def called(self, name: str) -> str:
        """What a check is about, a cell or ``fall 2``, as both results call it: ``v[S-1]``, ``fall S-1``."""
        rows, _, number = name.rpartition(" ")
        axis = next((axis for axis in self.words if axis != PAIRS and singular(axis) == rows), None)
        if axis is not None and number.isdecimal():
            return f"{rows} {self.words[axis].get(int(number), number)}"
        return self.address(*named(name)) if _CELL.fullmatch(name) else name


def _printed(column: Column) -> dict[Index, str]:
    """What people read, of every row that is listed; none where the file tells nothing of it."""
    every = column.text if isinstance(column.text, list) else [column.text or None]
    told = zip(column.cells, every, strict=False)
    return {index: f"{text}{_unit(column)}" for index, text in told if text}


def _unit(column: Column) -> str:
    """What stands behind what people read."""
    return behind(column.unit if column.shown is UNSET else column.shown.text)


def _coverage(found: Expanded) -> str:
    return "" if found.level is None else f"{100 * found.level:.12g} % coverage"


def _expanded(result: Result, name: str) -> dict[Index, Expanded]:
    """The expanded uncertainty of the rows of a column of which it is known."""
    every = () if result.expanded is UNSET else result.expanded
    index = {address(name, label): label for label in result.cells[name].cells}
    index |= {address(name, (word,)): label for label, word in result.known(name).items()}
    return {index[each.cell]: each for each in every if each.cell in index}


def _words(result: Result, axis: str) -> dict[int, str]:
    """What the rows of an index set are known by; a row that is left out may have no word."""
    every = (result.words or {}).get(axis, {})
    return {number: word for number, word in sorted(every.items()) if word}


def _by_word(before: Result, after: Result) -> tuple[str, ...]:
    """The index sets of which a word has another number since, and whose words stand for their rows."""
    found = []
    for axis in before.words or {}:
        since = {word: number for number, word in _words(after, axis).items()}
        moved = any(since.get(word, number) != number for number, word in _words(before, axis).items())
        if moved and _stand_for_rows(before, axis) and _stand_for_rows(after, axis):
            found.append(axis)
    return tuple(found)


def _stand_for_rows(result: Result, axis: str) -> bool:
    """Whether every row has a word of its own, and a number that only says where it stands.

    Other numbers were written by somebody: they are names, too.
    """
    words, numbers = _words(result, axis), {*(result.words or {}).get(axis, {})}
    rows = next(([*column.cells] for column in result.cells.values() if column.axis == axis), [])
    return (
        numbers == {*range(1, len(numbers) + 1)}
        and rows == sorted(rows)
        and {*rows} <= {(number,) for number in words}
        and len({*words.values()}) == len(words)
        and all(map(is_word, words.values()))
    )


def _standing(result: Result, axes: tuple[str, ...]) -> dict[str, dict[int, str]]:
    """The words that stand for numbers of rows, by index set; for both of a pair's, if there is one table."""
    found = {axis: _words(result, axis) for axis in axes}
    tables = {column.axis for column in result.cells.values() if column.axis and column.rule == "given"}
    if len(tables) == 1 and tables <= found.keys():
        found[PAIRS] = found[tables.pop()]
    return found


def _reordered(before: Mapping[int, str], after: Mapping[int, str]) -> bool:
    """Whether words that are in both stand in another order."""
    both = {*before.values()} & {*after.values()}
    old, new = ([word for word in words.values() if word in both] for words in (before, after))
    return old != new


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


def _called(rows: _Rows) -> dict[str, str]:
    """The word of each row that has one and is known by its number, as ``samples 2``."""
    return {
        f"{axis} {number}": word
        for axis, words in (rows.result.words or {}).items()
        if axis not in rows.words
        for number, word in words.items()
    }


def _verdicts(rows: _Rows) -> dict[str, str]:
    """Of each published value, as ``Table 2 alpha[1-2]``, what it prints and the verdict on it."""
    every = (*rows.result.published, *(rows.result.published_u or ()))
    known = (rows.row(re.sub(r".*\(|[,)].*", "", each.cell), tuple(each.index)) for each in every)
    return {
        f"{each.source} {address(each.cell, row)}": f"{each.printed}: {each.verdict}"
        for each, row in zip(every, known, strict=True)
    }


def _checks(rows: _Rows, accepted: bool) -> dict[str, str]:
    """Of each check that found something, as ``limit alpha``, what it told; of each limit, the decision.

    Of rows in another order only that it told something: its sentence names and counts them as they stand.

    `accepted`: whether acceptance limits belong to it, which files of before do not tell as they are read.
    """
    result = rows.result
    told = {
        f"{each.kind} {rows.called(each.name)}": each.word if rows.words else each.sentence
        for each in result.oddities
    }
    for each in result.conformity or ():
        unit = _unit(result.cells[each.column])
        within = f", acceptance limits {each.accepted}{unit}" if accepted and each.accepted else ""
        told[f"limits {rows.called(each.cell)}"] = f"{each.limits}: {each.decision}{within}"
    return told


def _changes(before: Mapping[str, str], after: Mapping[str, str]) -> list[OtherChange]:
    names = dict.fromkeys([*before, *after])
    pairs = [OtherChange(name, before.get(name, ""), after.get(name, "")) for name in names]
    return [change for change in pairs if change.before != change.after]


def _only_in(one: _Rows, other: _Rows) -> list[str]:
    """Columns, and rows of columns that both have; one name for rows that all columns of an axis gain."""
    found = []
    for name in one.result.cells:
        if name not in other.result.cells:
            found.append(name)
            continue
        there = other.places(name)
        found += [one.address(name, index) for row, index in one.places(name).items() if row not in there]
    return found
