"""Writes into published.csv what the known differences are now, and nothing else: the file keeps its bytes.

As a snapshot test does, it takes what is recomputed for what shall be expected. It never says why: that is
the user's.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..inputs.csvtable import CsvRow, CsvTable, Field, read_table
from ..inputs.published import COLUMNS, Pin
from ..inputs.sources import open_source
from ..messages.errors import Findings
from ..result.verdict import OTHERWISE, UNEXPECTED, UNEXPLAINED, UNPINNED, UNREASONED
from ..result.verdict_words import holds

if TYPE_CHECKING:
    from ..result.result import Comparison, Report

_BLANK = " \t\u00a0"
_BYTE_ORDER_MARK = "\ufeff".encode()

Words = Mapping[str, str]
"""What becomes of fields, by the name of their column."""


@dataclass(frozen=True)
class RowChange:
    """A row of the table that is written anew."""

    line: int
    """Where it begins, counted from 1."""
    before: str
    after: str
    """`before` and `after`: the row as it stands in the file."""


@dataclass(frozen=True)
class Accepted:
    """What becomes of published.csv."""

    path: Path
    """The file."""
    before: bytes
    after: bytes
    """`before` and `after`: all of it."""
    changes: tuple[RowChange, ...] = ()
    """The rows whose words change, the first line among them if it names another column."""
    others: int = 0
    """How many rows only get an empty field, because a column is new."""


def accepted(report: Report, reason: str = "") -> Accepted:
    """Say what published.csv has to hold for its differences to be known; nothing is written.

    A difference that nobody has announced becomes a known one only if there is a reason for it. One that is
    none any more is taken back, with all that was said of it.

    `report`: refereed: what is reachable is no difference. It has published values. `reason`: why they
    differ, for the rows that do not say it.
    """
    place = report.every_comparison[0].published.places["value"]
    name = report.every_comparison[0].published.where.rsplit(":", 2)[0]
    before, path = report.inputs.files[name], report.inputs.folder / name
    findings = Findings()
    source = open_source(place.path, name, before, "", findings)
    table = None if source is None else read_table(source, COLUMNS, findings)
    findings.check()
    assert table is not None  # it was read before, with the same content
    reasons = report.referee.possible_reasons
    words = [
        _words(comparison, reason, holds(comparison.published.explained, reasons))
        for comparison in report.every_comparison
    ]
    new = [name for name in COLUMNS if any(each.get(name) for each in words) and name not in _names(table)]
    lines = list(_lines(table, words, new))
    text = table.source.text
    for row, change, _ in reversed(lines):
        text = text[: row.offset] + change.after + text[row.fields[-1].end :]
    mark = _BYTE_ORDER_MARK if before.startswith(_BYTE_ORDER_MARK) else b""
    changes = tuple(change for _, change, told in lines if told)
    return Accepted(path, before, mark + text.encode(), changes, len(lines) - len(changes))


def _words(comparison: Comparison, reason: str, explained: bool) -> Words:
    """What has to be written of a published value, as far as it is not there.

    An explanation that is none any more is taken back: what is expected now is the difference alone.
    """
    published, finding = comparison.published, comparison.finding
    why = {} if published.reason or not reason else {"reason": reason}
    pin = {"recomputed": str(Pin(published.printed.text, comparison.again))}
    if finding == UNEXPECTED and published.expect:
        return dict.fromkeys(("expect", "recomputed", "explained", "reason"), "")
    if finding == UNEXPECTED and (published.reason or reason):
        return {"expect": "differs", **pin, **why}
    if finding in (UNPINNED, OTHERWISE, UNEXPLAINED):
        return {**pin, **({} if explained else {"explained": ""}), **why}
    return why if finding == UNREASONED else {}


# --- rows as they are written ------------------------------------------------------------------------------


def _names(table: CsvTable) -> list[str]:
    return [field.text for field in table.header]


def _lines(
    table: CsvTable, words: Sequence[Words], new: Sequence[str]
) -> Iterator[tuple[CsvRow, RowChange, bool]]:
    """The rows that change, and whether their words do: some only get an empty field for a new column."""
    header = CsvRow(table.header, table.header[0].begin)
    titles: list[tuple[CsvRow, Words, bool]] = [(header, {name: name for name in new}, True)] if new else []
    rows = ((row, each, bool(each)) for row, each in zip(table.rows, words, strict=True))
    for row, each, told in (*titles, *rows):
        before = table.source.text[row.offset : row.fields[-1].end]
        after = ",".join(_written(table, row, each, new))
        if after != before:
            line = table.source.at(row.offset).line or 0
            yield row, RowChange(line, before, after), told


def _written(table: CsvTable, row: CsvRow, words: Words, new: Sequence[str]) -> list[str]:
    """The fields of a row: those that do not change as they stand, with their quotes and blanks."""
    text, names = table.source.text, _names(table)
    quoted = all(_is_quoted(text, field) for field in row.fields)
    fields = [
        _put(text, field, words[name]) if name in words and words[name] != field.text else _raw(text, field)
        for name, field in zip(names, row.fields, strict=True)
    ]
    for name in new:
        before = [names.index(known) for known in COLUMNS[: COLUMNS.index(name)] if known in names]
        names.insert(before[-1] + 1, name)
        fields.insert(before[-1] + 1, _quote(words.get(name, ""), quoted))
    return fields


def _raw(text: str, field: Field) -> str:
    return text[field.begin : field.end]


def _is_quoted(text: str, field: Field) -> bool:
    return _raw(text, field).strip(_BLANK).startswith('"')


def _put(text: str, field: Field, word: str) -> str:
    """A field with another word in it, between the same blanks."""
    raw = _raw(text, field)
    inner = raw.strip(_BLANK)
    left = raw[: len(raw) - len(raw.lstrip(_BLANK))] if inner else ""
    right = raw[len(raw.rstrip(_BLANK)) :] if inner else ""
    return left + _quote(word, _is_quoted(text, field)) + right


def _quote(word: str, quoted: bool) -> str:
    if quoted or any(character in word for character in ',"\r\n'):
        return '"' + word.replace('"', '""') + '"'
    return word
