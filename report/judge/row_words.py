"""Whether a word that tells rows apart, or together, may be another one, and a number another row's."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from ..axis import GroupAxis
from ..cells.address import address
from ..messages.diagnostics import Check
from ..messages.errors import some

if TYPE_CHECKING:
    from ..inputs.expected import OfCell
    from ..inputs.inputs import Inputs
    from ..inputs.measurements import Measurements
    from ..result.result import Report

WORDS = "words"


def names(inputs: Inputs) -> list[str]:
    """The columns of words by which rows belong together, and those that are taken from other reports."""
    return [*(column for table in inputs.tables for column in table.table.groups), *_taken(inputs)]


def checks(report: Report) -> Iterator[Check]:
    """One of each."""
    for table in report.inputs.tables:
        yield from (_of_words(report, table, column) for column in table.table.groups)
    yield from (_of_taken(report, column) for column in _taken(report.inputs))


def _taken(inputs: Inputs) -> list[str]:
    """The columns that are taken from other reports, where either knows rows by words."""
    return [name for name, own in inputs.taken.items() if name in inputs.measured and own.told]


def called(report: Report, table: Measurements, rows: Sequence[int]) -> str:
    """``run 2``, ``runs 1 and 3``."""
    every = table.name or next((axis.name for axis in report.sheet.axes if not axis.parents), "")
    return f"{table.row if len(rows) == 1 else every} {some(list(map(str, rows)))}"


def _foreign(word: str, other: str) -> str:
    """The first letter of a word that another one has not, by its name, if it looks like one that it has.

    >>> _foreign("\u04121", "B1"), _foreign("B1", "\u04121"), _foreign("CO", "Co")
    (', with CYRILLIC CAPITAL LETTER VE', '', '')
    """
    odd = next(
        (letter for letter in word if letter not in other and letter.isalpha() and not letter.isascii()), ""
    )
    return f", with {unicodedata.name(odd, f'U+{ord(odd):04X}')}" if odd else ""


def _of_words(report: Report, table: Measurements, column: str) -> Check:
    """Whether a word by which rows belong together may be another one misspelt."""
    found = [each for each in table.alike if each.column == column]
    if not found:
        return _of_numbers(report, column)
    told = [
        f"'{word}' ({called(report, table, rows)}{_foreign(word, other)}) is nearly '{other}' "
        f"({called(report, table, others)}{_foreign(other, word)})"
        for _, word, rows, other, others, _ in found
    ]
    said = f"{column}: {some(told)}: is that misspelt? Each word is a group of its own"
    return Check(WORDS, column, True, said, found[0].at, note="warning")


def _of_numbers(report: Report, column: str) -> Check:
    """Whether a group is named by its number, which is another group's once the table is sorted."""
    axes = [axis for axis in report.sheet.axes if isinstance(axis, GroupAxis) and axis.members.by == column]
    said_of: tuple[OfCell, ...] = (*report.inputs.limits, *report.inputs.expected)
    for each in said_of:
        name, index = each.cell
        if name not in report.sheet or report.sheet[name].axis not in axes or not index:
            continue
        own, by_number = report.values.cell(name, index).address, address(name, index)
        if own != by_number and by_number in str(each.at.source):  # limits of the column name no group
            said = f"{by_number} is {own} as it stands; in a sorted table it is another {column}'s"
            return Check(WORDS, column, True, f"{said}: write {own}", each.at, note="warning")
    return Check(WORDS, column, True, f"{column}: no word is nearly another", report.inputs.place)


def _of_taken(report: Report, column: str) -> Check:
    """Whether rows of another report are found by words: its order may have made their numbers."""
    own = report.inputs.taken[column]
    hint = ": columns of the same words in both say which is which" * own.doubtful
    note = "warning" * own.doubtful
    return Check(WORDS, column, True, f"{column}: {own.told}{hint}", report.inputs.place, note=note)
