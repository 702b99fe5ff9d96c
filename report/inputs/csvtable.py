"""Comma-separated tables (RFC 4180) with the place of every field, which Python's csv does not keep.

A table of measurements may be separated by semicolons, too, as spreadsheets write it where the comma is
decimal; a line ``sep=;`` above its names says so, as Excel reads it. Its numbers then have decimal points, or
all of them decimal commas, of which one at least can mean nothing else: what most of them have is meant.
"""

from __future__ import annotations

import re
from collections import Counter
from itertools import compress, pairwise
from typing import TYPE_CHECKING, NamedTuple

from ..messages.errors import close, listing, suggest
from .keys import LEFT_OUT, for_left_out
from .number_text import NumberError, read_number

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..messages.errors import Findings, Location
    from .sources import Source

_BLANK = " \t\u00a0"
_SEPARATORS = {";": "semicolons", "\t": "tabs", "|": "vertical bars"}
_TITLE = 5
"""So many lines are looked through for the names of columns, where the first has none."""
_MOST_COLUMNS = 200
_STOP = {separator: re.compile(rf"[{separator}\r\n]") for separator in ",;"}
_COMMA = re.compile(r"(?P<whole>[+-]?[0-9]+),(?P<rest>[0-9]+(?:[eE][+-]?[0-9]+)?(?:\([0-9]+\))?)")
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2},[0-9]{3}")
"""What may mean a number and a thousand times it: 1,234."""
_POINT = re.compile(r"[+-]?[0-9]*\.[0-9].*")
_POINTED = re.compile(r"[+-]?[0-9]*\.[0-9]+(?:[eE][+-]?[0-9]+)?(?:\([0-9]+\))?")
"""A number with a decimal point."""
_MARKS = ".' \u00a0\u202f"
_GROUPED = re.compile(rf"[+-]?[1-9][0-9]{{0,2}}(?:[{_MARKS}][0-9]{{3}})+,[0-9]+")
"""One with marks between its thousands."""
_SAYS = re.compile(r'\s*"?sep=(?P<separator>[,;])"?[ \t]*(?:\r\n?|\n)', re.IGNORECASE)
"""A first line that says what stands between the fields."""
_QUOTE = re.compile(r'"("?)')


class Field(NamedTuple):
    """A field without the blanks and quotes around it, and where it begins.

    `exact` tells whether each character of it is one character of the file (a doubled quote is two); from
    `begin` to `end` is all that stands between its separators.
    """

    text: str
    offset: int
    length: int
    exact: bool = True
    begin: int = 0
    end: int = 0


class CsvRow(NamedTuple):
    """The fields of a line; `sound` is false if the line itself had a finding."""

    fields: list[Field]
    offset: int
    sound: bool = True


class CsvTable(NamedTuple):
    """A table as text: a first line of names, and rows that are as wide as it."""

    source: Source
    header: list[Field]
    rows: list[CsvRow]
    total: int
    """How many rows there are, with those that had findings and are left out of `rows`."""

    def at(self, field: Field, start: int = 0, length: int | None = None) -> Location:
        """Return the place of a field, or of a part of it."""
        if length is None or not field.exact:
            return self.source.at(field.offset, field.length)
        return self.source.at(field.offset + start, length)

    def end_of_header(self) -> Location:
        """Return the place after the last name, where one may be missing."""
        return self.source.at(self.source.line_end(self.header[-1].offset + self.header[-1].length))


def read_table(
    source: Source, known: Sequence[str], findings: Findings, semicolons: bool = False
) -> CsvTable | None:
    """Split a file into fields; None if it is no table at all.

    Parameters
    ----------
    source : Source
        The file.
    known : sequence of str
        The names a first line may hold, for the message when it holds none.
    findings : Findings
        Rows with a wrong number of fields, and quotes that do not close.
    semicolons : bool
        Whether they may stand between the fields: if a line above the names says so, or no comma stands in
        these.
    """
    if line := _below_title(source.text, known):
        findings.add("LS320", source.at(0, source.line_end(0)), line=line)
        return None
    says = _SAYS.match(source.text) if semicolons else None
    head = source.text.lstrip().partition("\n")[0]
    separator = ";" if semicolons and ";" in head and "," not in head else ","
    if says is not None:
        separator = says["separator"]
    rows = _rows(source, findings, separator, says.end() if says else 0)
    if separator == ";":
        rows = _pointed(source, rows, findings)
    while rows and _is_blank(rows[-1]):
        rows.pop()
    if not rows:
        findings.add("LS111", source.at(0), allowed=f"a first line with {listing(known)}")
        return None
    first = next(place for place, row in enumerate(rows) if not _is_blank(row))
    if first:
        findings.add("LS315", source.at(rows[0].offset))
        rows = rows[first:]
    if not rows[0].sound:
        return None
    header = rows[0].fields
    for other, name in _SEPARATORS.items():
        if len(header) == 1 and other in header[0].text:
            start = source.text.index(other, header[0].offset)
            findings.add("LS308", source.at(start), text=name)
            return None
    if len(header) > _MOST_COLUMNS:
        findings.add("LS316", source.at(header[0].offset), found=len(header), wanted=_MOST_COLUMNS)
        return None
    if all(is_number(field.text) for field in header):
        findings.add("LS309", source.at(header[0].offset, header[0].length), known=listing(known))
        return None
    (header, *_), *body = _without_trailing(rows)
    blank = [row for row in body if _is_blank(row)]
    if blank and not first:
        findings.add("LS315", source.at(blank[0].offset))
    full = [row for row in body if not _is_blank(row)]
    wide = [row for row in full if row.sound and len(row.fields) != len(header)]
    _report_widths(source, wide, len(header), findings, separator)
    good = [row for row in full if row.sound and len(row.fields) == len(header)]
    return CsvTable(source, header, good, len(full))


def _below_title(text: str, known: Sequence[str]) -> int:
    """The line that names the columns, where the first is a title; 0 where there is no such line."""
    names = {name.partition(" [")[0] for name in known}
    if len(names) < 3 or _SAYS.match(text) or not text.partition("\n")[0].strip(' ",;\t\r'):
        return 0
    lines = [set(map(_name, re.split("[,;\t]", line))) & names for line in text.split("\n", _TITLE)[:_TITLE]]
    # What rows are called need not stand there.
    every = (number for number, named in enumerate(lines, start=1) if len(named) > len(names) - 2)
    return 0 if lines[0] else next(every, 0)


def _name(field: str) -> str:
    return field.partition("[")[0].strip(' "\r')


def _report_widths(
    source: Source, wide: list[CsvRow], wanted: int, findings: Findings, separator: str
) -> None:
    """Report rows of another width: one finding for all that decimal commas explain, one for each other."""
    by_commas = [separator == "," and _looks_comma(row, wanted) for row in wide]
    commas = list(compress(wide, by_commas))
    for row in commas[:1]:
        at = source.at(row.offset, source.line_end(row.offset) - row.offset)
        findings.add("LS307", at, found=len(row.fields), wanted=wanted, count=len(commas))
    for row, explained in zip(wide, by_commas, strict=True):
        if explained:
            continue
        if len(row.fields) > wanted:
            at = source.at(row.fields[wanted].offset, row.fields[wanted].length)
        else:
            at = source.at(source.line_end(row.fields[-1].offset))
        comma = len(row.fields) > wanted and separator == ","
        more = "a comma separates fields: write 2.334, not 2,334" if comma else ""
        halves = (all(each.text.isdigit() for each in both) for both in pairwise(row.fields[1:]))
        empty = len(row.fields) > wanted and not any(field.text for field in row.fields[wanted:])
        if comma and any(field.text.count("(") > field.text.count(")") for field in row.fields):
            more = 'what has a comma in it stands in quotes: "r(a, b)"'
        if empty and not (comma and any(halves)):
            more = "a separator too many stands at the end of the row"
        number = len(row.fields)
        found = f"{number} field{'s' if number > 1 else ''}"
        findings.add("LS306", at, found=found, wanted=wanted, suggestion=more)


def _looks_comma(row: CsvRow, wanted: int) -> bool:
    digits = [field.text.lstrip("+-").isdigit() for field in row.fields]
    return wanted < len(row.fields) <= 2 * wanted and all(digits)


def _without_trailing(rows: list[CsvRow]) -> list[CsvRow]:
    """Rows without the empty columns at their end, which a spreadsheet leaves, if they are in all of them."""
    names = [bool(field.text) for field in rows[0].fields]
    wanted = len(names) - names[::-1].index(True) if True in names else len(names)
    full = [row for row in rows[1:] if not _is_blank(row)]
    behind = [row.fields[wanted:] for row in full]
    if any(field.text for fields in behind for field in fields) or (wanted == len(names) and not all(behind)):
        return rows
    return [row._replace(fields=row.fields[:wanted]) for row in rows]


def _is_blank(row: CsvRow) -> bool:
    return row.sound and not any(field.text for field in row.fields)


def is_number(text: str) -> bool:
    """Whether a text is a number, be it one with a comma."""
    try:
        read_number(text)
    except NumberError as error:
        return error.code == "LS402"
    return True


def _pointed(source: Source, rows: list[CsvRow], findings: Findings) -> list[CsvRow]:
    """Rows with decimal points for decimal commas, in columns of numbers.

    Commas are decimal if no number has a point, which is told if all of them could stand between thousands;
    or if they outnumber points, and not all of them could. Else what has one is refused where it is read.
    """
    header, *body = [row for row in rows if not _is_blank(row)] or [CsvRow([], 0)]
    worded = _worded(header, body)
    numbers = [[field for place, field in enumerate(row.fields) if place not in worded] for row in body]
    texts = [field.text for fields in numbers for field in fields]
    commas = [text for text in texts if _COMMA.fullmatch(text)]
    points = [text for text in texts if _POINT.fullmatch(text)]
    doubtful = all(map(_THOUSANDS.fullmatch, commas))
    if not commas or (points and (doubtful or len(points) >= len(commas))):
        return rows

    names = [head.text.partition("[")[0].strip() for head in header.fields]
    rows_by_name = [list(zip(names, row.fields, strict=False)) for row in body]
    named = [
        each
        for row in rows_by_name
        if not any(name == LEFT_OUT and field.text for name, field in row)  # nothing in it is wrong
        for place, each in enumerate(row)
        if place not in worded
    ]
    if doubtful:
        _tell_doubtful(source, [each for each in named if _COMMA.fullmatch(each[1].text)], findings)
    else:
        _tell_points(source, named, findings)

    def pointed(place: int, field: Field) -> Field:
        text = _without_marks(field.text)  # what has marks and a comma was told: it is read without
        told = _COMMA.fullmatch(text) and place not in worded
        return field._replace(text=_COMMA.sub(r"\g<whole>.\g<rest>", text)) if told else field

    return [row._replace(fields=[pointed(*each) for each in enumerate(row.fields)]) for row in rows]


def _worded(header: CsvRow, body: Sequence[CsvRow]) -> set[int]:
    """The places of columns of words: of dates, or remarks; 'left out' has a reason."""

    def has_words(place: int) -> bool:
        texts = (row.fields[place].text for row in body if place < len(row.fields))
        return any(text and not _like_number(text) for text in texts)

    return {n for n, head in enumerate(header.fields) if "[" not in head.text and has_words(n)}


def _tell_doubtful(source: Source, found: Sequence[tuple[str, Field]], findings: Findings) -> None:
    """Tell once of numbers whose commas may all stand between thousands."""
    for name, field in found[:1]:
        words = {"point": field.text.replace(",", "."), "whole": field.text.replace(",", "")}
        at = source.at(field.offset, field.length)
        findings.add("LS409", at, name=name, text=field.text, count=len(found), **words)


def _tell_points(source: Source, found: Sequence[tuple[str, Field]], findings: Findings) -> None:
    """Tell each number with a point, where others have decimal commas."""
    for name, field in found:
        example, either = _without_marks(field.text), ""
        if example == field.text:
            if not _POINTED.fullmatch(field.text):
                continue  # no number, which is told where it is read
            example = field.text.replace(".", ",")
            if _THOUSANDS.fullmatch(example):
                either = f" or '{field.text.replace('.', '')}', whichever is meant"
        at, mark = source.at(field.offset, field.length), "point" if "." in field.text else "mark"
        findings.add("LS408", at, name=name, mark=mark, text=field.text, example=example, thousands=either)


def _without_marks(text: str) -> str:
    """A number without marks between its thousands, if a comma stands behind them."""
    return re.sub(f"[{_MARKS}]", "", text) if _GROUPED.fullmatch(text) else text


def _like_number(text: str) -> bool:
    """Whether a text is a number, be it one with a decimal comma and its uncertainty."""
    return is_number(text) or _COMMA.fullmatch(text) is not None


def _rows(source: Source, findings: Findings, separator: str, position: int) -> list[CsvRow]:
    rows = []
    text = source.text
    while position < len(text):
        end = source.line_end(position)
        if '"' in text[position:end]:
            row, end = _quoted(source, position, findings, separator)
        else:
            row, offset = CsvRow([], position), position
            for part in text[position:end].split(separator):
                row.fields.append(_field(part, offset))
                offset += len(part) + 1
        rows.append(row)
        position = source.next_line(end)
    return rows


def _field(part: str, offset: int) -> Field:
    stripped = part.strip(_BLANK)
    shift = len(part) - len(part.lstrip(_BLANK)) if stripped else 0
    return Field(stripped, offset + shift, max(len(stripped), 1), True, offset, offset + len(part))


def _quoted(source: Source, position: int, findings: Findings, separator: str) -> tuple[CsvRow, int]:
    """Read a line that has quotes; return it and where it ends, which may be lines later."""
    text, start = source.text, position
    fields: list[Field] = []
    sound = True
    while True:
        begin = position
        while text[begin : begin + 1] in {" ", "\t", "\u00a0"}:
            begin += 1
        if text[begin : begin + 1] == '"':
            closing = _QUOTE.search(text, begin + 1)
            while closing is not None and closing[1]:
                closing = _QUOTE.search(text, closing.end())
            if closing is None:
                findings.add("LS313", source.at(begin))
                return CsvRow(fields, start, False), len(text)
            content = text[begin + 1 : closing.start()]
            stop = _stop(text, closing.end(), separator)
            field = _field(content.replace('""', '"'), begin + 1)._replace(begin=position, end=stop)
            if '"' in content:
                field = field._replace(offset=begin, length=closing.end() - begin, exact=False)
            fields.append(field)
            stray = bool(text[closing.end() : stop].strip(_BLANK))
        else:
            stop = _stop(text, begin, separator)
            fields.append(_field(text[position:stop], position))
            stray = '"' in fields[-1].text
        if stray:
            findings.add("LS314", source.at(begin, stop - begin), text=text[begin:stop].strip(_BLANK))
            sound = False
        if text[stop : stop + 1] != separator:
            return CsvRow(fields, start, sound), stop
        position = stop + 1


def _stop(text: str, position: int, separator: str) -> int:
    stop = _STOP[separator].search(text, position)
    return stop.start() if stop else len(text)


def match_columns(
    table: CsvTable,
    names: Sequence[str],
    required: Mapping[str, str],
    optional: Sequence[str],
    findings: Findings,
    called: Mapping[str, str] | None = None,
    words: Sequence[str] = (),
) -> dict[str, int]:
    """Say where each column is, and report those that are missing, doubled or unknown.

    Parameters
    ----------
    table : CsvTable
        The table.
    names : sequence of str
        The name in each field of its first line; empty where a finding was already made.
    required : mapping of str to str
        The columns that must be there, with an example of how to write each.
    optional : sequence of str
        Those that may be there.
    findings : Findings
        Where findings go.
    called : mapping of str to str, optional
        What some of them are called in what is told.
    words : sequence of str
        The columns of words that nothing asks for: one of them may be what is missing, under another name.
    """
    known, own = [*required, *optional], called or {}
    strange = {name for name in names if name and name not in known}
    renamed = [own.get(name, name) for name in required if name not in names]
    places: dict[str, int] = {}
    meant: Counter[str | None] = Counter()
    for place, (name, field) in enumerate(zip(names, table.header, strict=True)):
        if name in places:
            findings.add("LS302", table.at(field), text=name)
        elif name in known:
            places[name] = place
        elif name or not field.text:
            told = list(dict.fromkeys(own.get(word, word) for word in known))
            missing = [own.get(word, word) for word in known if word not in names]
            meant[close(name, missing)] += 1  # a misspelt column is one problem, not two
            suggestion = for_left_out(name) or suggest(name, missing) or _alike_hint(name, told)
            if not suggestion and len(strange) == len(renamed) == 1:
                suggestion = f"'{renamed[0]}' is missing: did you mean that?"
                meant[renamed[0]] += 1
            findings.add("LS303", table.at(field), text=name, known=listing(told), suggestion=suggestion)
    lacking = [name for name in required if name not in places and not meant[own.get(name, name)]]
    are_words = bool(words) and all(required[name] == name for name in lacking)  # they have no unit
    others = listing(f"'{word}'" for word in words)
    instead = f", or write it in the place of {others}" * are_words
    without(table, findings, {name: required[name] for name in lacking}, instead)
    return places


def _alike_hint(name: str, there: Sequence[str]) -> str:
    """What helps with a column whose name is nearly that of one which is there; empty if it is not."""
    said = suggest(name, there).removesuffix("?")
    return said and f"{said}, which is there? if it has words, give it a name less alike"


def without(table: CsvTable, findings: Findings, examples: Mapping[str, str], instead: str = "") -> None:
    """Tell which columns a table lacks, if any, with a header for each as it may be written, or what else."""
    if examples:
        names = listing((f"'{name}'" for name in examples), last="and")
        told = f"s {names} are" if len(examples) > 1 else f" {names} is"
        example = ",".join(examples.values())
        findings.add("LS301", table.end_of_header(), text=told, example=example, suggestion=instead)
