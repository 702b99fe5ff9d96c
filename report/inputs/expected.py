"""What a user expects to be odd, and why: the section ``[expected]`` of report.toml."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Protocol, Self, TypeVar

from ..cells.address import index_text, named, parts
from ..messages.errors import Findings, Location, listing, suggest

if TYPE_CHECKING:
    from .tables import TomlTables

Index = tuple[int, ...]
Words = Mapping[str, Mapping[Index, str]]
"""For each cell what its rows are known by, by their indices."""
Cells = Mapping[str, tuple[str, Collection[Index]]]
"""For each cell its unit and the indices that it has: ``{()}`` for a scalar."""

EXAMPLE = '"alpha[1-2]" = "both drops from one height"'
"""A line of the section."""

_ROW = re.compile(r"(?P<word>[^\W\d]\w*) +(?P<number>[0-9]{1,9})")


@dataclass(frozen=True)
class OfCell:
    """What report.toml says of a cell."""

    address: str
    """As it was written: ``alpha[1-2]``, ``alpha_mean``, ``c``, ``c[blank]``, ``test 3``."""
    at: Location
    """Where it was written."""
    rows: tuple[Index, ...] = field(default=(), kw_only=True)
    """Which rows its word stands for, where one does."""

    @property
    def cell(self) -> tuple[str, Index]:
        """Column and index of the cell, or of the first; no column for a test, no index for a whole column.

        What is no address is a cell that there is not.
        """
        return named(self.address, self.rows[0] if self.rows else None)

    def of_words(self, words: Words) -> Self:
        """The same with the rows that its word stands for: all readings of ``c[blank]``."""
        name, word = parts(self.address) or ("", "")
        found = () if self.cell[1] else rows_of(word, words.get(name, {}))
        return replace(self, rows=tuple(found))


class OfRows(Protocol):
    """A table of measured rows."""

    @property
    def name(self) -> str:
        """Their index set; none of the only table."""

    @property
    def row(self) -> str:
        """What one is called."""

    @property
    def tests(self) -> Sequence[int]:
        """Their numbers."""


T = TypeVar("T", bound=OfRows)


@dataclass(frozen=True)
class Expectation(OfCell):
    """A cell that is expected to be odd, or several of a column, or a test whose cells are."""

    reason: str
    axis: str = ""
    """The index set that its test is of, where there are several tables of rows."""

    @property
    def cell(self) -> tuple[str, Index]:
        """That of the cell; of a test its number, without a column.

        >>> Expectation("alpha[1-2]", Location(), "one height").cell
        ('alpha', (1, 2))
        >>> Expectation("test 3", Location(), "heard twice").cell
        ('', (3,))
        """
        row = _ROW.fullmatch(self.address)
        return ("", (int(row["number"]),)) if row else super().cell

    def tables(self, tables: Iterable[T]) -> list[T]:
        """The table that its test is in, by what a row is called there: ``test 3`` of the only one, too."""
        every, word = list(tables), self.address.partition(" ")[0]
        return [each for each in every if word == each.row or (word == "test" and not each.name)]

    def in_table(self, tables: Iterable[OfRows]) -> Expectation:
        """The same with the index set that its test is of."""
        return replace(self, axis=next((each.name for each in self.tables(tables)), ""))

    def covers(self, cell: str, index: Index, tests: Collection[tuple[str, int]]) -> bool:
        """Whether it speaks of a cell, by itself, by its column or by one of the tests that it rests on.

        `tests`: with the index set that each is of.
        """
        name, own = self.cell
        if not name:
            return any(test == own[0] and self.axis in ("", axis) for axis, test in tests)
        return name == cell and (not own or index in (self.rows or (own,)))


def read_expected(tables: TomlTables) -> tuple[Expectation, ...]:
    """Read the section; what is wrong with it is told where it stands."""
    toml, path = tables.toml, "expected"
    table = tables.table((path,), "a table [expected]", EXAMPLE)
    # What has no reason is refused, and its cell is looked at all the same.
    reasons = {address: tables.text((path,), address, "double bounce heard") for address in table}
    return tuple(
        Expectation(address, toml.key(path, address), reason or "") for address, reason in reasons.items()
    )


def rows_of(word: str, words: Mapping[Index, str]) -> list[Index]:
    """The rows that a word stands for."""
    return [index for index, own in words.items() if own == word and word]


def row_of(word: str, words: Mapping[Index, str]) -> Index | None:
    """The only row that a word stands for."""
    found = rows_of(word, words)
    return found[0] if len(found) == 1 else None


def check_expected(
    expected: Sequence[OfCell],
    tables: Sequence[OfRows],
    cells: Cells,
    findings: Findings,
    words: Words,
) -> None:
    """Find what is expected of cells and tests that there are not.

    Parameters
    ----------
    tables : sequence of OfRows
        The tables of rows that there are.
    findings : Findings
        Where unknown cells, indices and tests go.
    """
    called = [f"{table.row} {test}" for table in tables for test in table.tests]
    first = [f"{table.row} {test}" for table in tables for test in table.tests[:1]]
    for each in expected:
        name, index = each.cell
        several = isinstance(each, Expectation)  # may be of all rows of a word
        of, word = parts(each.address) or ("", "")
        if name not in cells and word and of in cells and () not in cells[of][1]:
            findings.add(
                "LS506", each.at, name=of, text=word, known=rows(cells[of][1], words.get(of, {}), several)
            )
            continue
        own = each.tables(tables) if isinstance(each, Expectation) and not name else []
        is_other = not name and not own
        if is_other or ((name or not index) and name not in cells):
            near = suggest(name or each.address, [*called, *cells])
            known, suggestion = listing([*first, *cells], most=24), near
            findings.add("LS505", each.at, text=each.address, known=known, suggestion=suggestion)
            continue
        indices = cells[name][1] if name else {(test,) for table in own for test in table.tests}
        if index and index not in indices:
            known = rows(indices, words.get(name, {}), several)
            findings.add("LS506", each.at, name=name or own[0].row, text=index_text(index), known=known)


def rows(indices: Collection[Index], words: Mapping[Index, str], several: bool = False) -> str:
    """The rows that a cell has, and the words that stand for one of them, or for `several`."""
    known = listing(index_text(one) or "no index" for one in sorted(indices))
    told = Counter(words.values())
    alone = [word for word, number in told.items() if several or number == 1]
    return f"{known}; or {listing(alone)}" if alone else known
