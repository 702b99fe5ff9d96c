"""The table of the tests: units in its first line, one row a test, the digits as printed."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from ...derivations.unit_text import ParsedUnit, UnitError, examples, is_pure, misfit, parse_unit
from ..distribution import Error
from ..messages.errors import Findings, close
from .csvtable import CsvRow, CsvTable, Field, is_number, match_columns, read_table
from .number_text import NumberError, read_printed, read_value
from .spelling import Alike, alike, same
from .taken import Taken, alone

if TYPE_CHECKING:
    from ..messages.errors import Location
    from ..quantity import Printed
    from ..workbook import Measured
    from .number_text import Declared
    from .sources import Source

__all__ = [
    "LEFT_OUT",
    "MODES",
    "ColumnHead",
    "LeftOut",
    "Measurements",
    "read_head",
    "read_measurements",
    "read_unit",
]

MODES = ("rounded", "truncated")
"""How a printed number may have been shortened."""

LEFT_OUT = "left out"
_GAP = f"say why it is missing in a column '{LEFT_OUT}': the row takes no part then"
_ONLY_U = "what has an uncertainty has a value: leave out both, or neither"
_NOWHERE = "no row of this column has one: leave out what the method does not need"
_EXCLUDING = re.compile(r"(?i)(exclu|omit|reject|discard|skip|ignor|outlier|left[_-]?out|leave[ _-]?out).*")
"""The column that says why a test takes no part; empty where it does."""

_HEAD = re.compile(r"(?P<name>u\([^()\[\]]*\)|[^()\[\]]+?)\s*(?:\[(?P<unit>[^\[\]]*)\])?")
_TEST = re.compile(r"0*[1-9][0-9]{0,8}")


@dataclass(frozen=True)
class LeftOut:
    """A test that takes no part in anything.

    Parameters
    ----------
    test : int
        Its number.
    reason : str
        Why, in the words of the file.
    texts : dict of str to str
        What stands in its row, as it stands, by the name of the column; it may be no number.
    stated : dict of str to tuple of Error or None
        What is stated of its numbers, by their columns; None: what stands there is no uncertainty.
    place : int
        How many rows stand above it.
    at : Location
        Where its reason was written.
    """

    test: int
    reason: str
    texts: dict[str, str]
    stated: dict[str, tuple[Error, ...] | None]
    place: int
    at: Location


@dataclass(frozen=True)
class Measurements:
    """The checked table: test numbers, and a printed number for each test and measured column.

    What is left out stands apart from them. A unit is that of a column or, called ``u(x_p)``, of its
    uncertainties. The heads are the first line as it stands, the texts the rows of the tests, by column.
    Remarks are columns of words, which only come along. Some words that say which rows belong together may be
    others misspelt: alike.
    """

    tests: tuple[int, ...]
    measured: dict[str, tuple[Printed | None, ...]]
    header_units: dict[str, str]
    left_out: tuple[LeftOut, ...] = ()
    heads: dict[str, str] = field(default_factory=dict)
    texts: dict[int, dict[str, str]] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    alike: tuple[Alike, ...] = ()

    def beside(self, taken: Mapping[str, Taken], order: Iterable[str]) -> Measurements:
        """The same with columns that were taken from other reports, all in the order of their names."""
        columns = self.measured | {name: column.printed for name, column in taken.items()}
        own, left_out = alone(taken, taken), []
        for each in self.left_out:
            spare = {
                name: column.spare[each.test] for name, column in taken.items() if each.test in column.spare
            }
            texts = {name: spare[name][0].text if name in spare else "" for name in taken}
            stated = {
                name: (Error(Fraction(taken[name].u(errors, own)), said=taken[name].file),)
                for name, (_, errors) in spare.items()
            }
            left_out.append(replace(each, texts={**each.texts, **texts}, stated={**each.stated, **stated}))
        return replace(
            self,
            measured={name: columns[name] for name in order},
            header_units=self.header_units | {name: each.printed[0].unit for name, each in taken.items()},
            left_out=tuple(left_out),
        )


@dataclass(frozen=True)
class ColumnHead:
    """What a field of the first line says: a column (or its uncertainty) and a unit, if it names one."""

    name: str
    unit: str | None
    start: int
    """Where the unit begins in the field."""


def read_measurements(
    source: Source,
    measured: Sequence[Measured] | None,
    modes: Mapping[str, str],
    findings: Findings,
    elsewhere: Collection[str] = (),
    called: str = "test",
    groups: Collection[str] = (),
) -> Measurements | None:
    """Read the table of the tests; None, with findings, if something is wrong with it.

    Parameters
    ----------
    source : Source
        The file.
    measured : sequence of Measured or None
        The columns that the workbook needs; None if the workbook is not known, and then only the shape
        of the table is looked at.
    modes : mapping of str to str
        How the numbers of a column were shortened, where it was not by rounding.
    findings : Findings
        Where findings go.
    elsewhere : collection of str
        The columns that are taken from other reports: they must not stand here.
    called : str
        What else the column of the tests' numbers may be called. Without it, rows are numbered as they stand.
    groups : collection of str
        The columns of words that say which rows belong together.
    """
    before = len(findings.found)
    columns = {column.name: column for column in measured or () if column.name not in elsewhere}
    required = {"test": called, **{name: f"{name} [{column.unit}]" for name, column in columns.items()}}
    table = read_table(source, list(required.values()), findings, semicolons=True)
    if table is None:
        return None
    heads = [read_head(table, field, columns, findings) for field in table.header]
    names = [head.name if head else "" for head in heads]
    # Where rows are called specimens, a column 'specimen' has their numbers, or else their names.
    numbers = [is_number(row.fields[names.index(called)].text) for row in table.rows if called in names]
    has_names = bool(numbers) and not any(numbers)
    if "test" not in names and called not in columns and not has_names:
        names = ["test" if name == called else name for name in names]
    names = [_not_here(table, n, name, elsewhere, findings) for n, name in enumerate(names)]
    remarks: tuple[str, ...] = ()
    if measured is None:
        if "test" not in names:
            return None  # its rows may be called as the workbook says, which is not known
        places = {"test": names.index("test")}
    else:
        optional = [*(f"u({name})" for name in columns), LEFT_OUT]
        if "test" not in names:  # rows are numbered as they stand
            del required["test"]
            optional += {"test": None} if has_names else {"test": None, called: None}
        known = [*([] if has_names else [called]), *required, *optional, *elsewhere, *groups]
        remarks = tuple(_remarks(table, heads, names, known, groups))
        required |= {name: name for name in groups}
        places = match_columns(table, names, required, [*optional, *remarks], findings, {"test": called})
    tests = tuple(range(1, len(table.rows) + 1))
    if "test" in places:
        tests = _tests(table, places["test"], findings)
    reasons = [row.fields[places[LEFT_OUT]] for row in table.rows] if LEFT_OUT in places else []
    gone = {place for place, reason in enumerate(reasons) if reason.text}
    total = table.total - len(gone)
    if total < 2:
        count = (f"no {called}" if total == 0 else f"one {called} only") + " that is not left out" * bool(
            gone
        )
        at = table.end_of_header() if table.total == 0 else _last(table)
        findings.add("LS310", at, count=count, row=called)
    used = [row for place, row in enumerate(table.rows) if place not in gone]
    near: list[Alike] = []
    for name in (name for name in groups if name in places):
        fields = [row.fields[places[name]] for row in table.rows]
        _check_words(table, fields, name, findings)
        if len(tests) == len(fields):
            near += _alike(table, dict(zip(tests, fields, strict=True)), name, findings)
    values: dict[str, tuple[Printed | None, ...]] = {}
    units: dict[str, str] = {}
    of_u: dict[str, ParsedUnit | None] = {}
    for name, column in columns.items():
        head, unit = read_unit(table, heads, places.get(name), column, findings)
        head_of_u, of_u[name] = read_unit(table, heads, places.get(f"u({name})"), column, findings)
        for each in (head, head_of_u):
            if each is not None and each.unit is not None:
                units[each.name] = each.unit.strip() or "1"  # empty brackets: a pure number
        if name in places:
            mode = modes.get(name, "rounded")
            read: list[Printed | None] = []
            for row in used:
                if findings.full:
                    break
                cell = row.fields[places[name]]
                beside = row.fields[places[f"u({name})"]] if f"u({name})" in places else None
                printed = None
                if cell.text or (beside is not None and beside.text):
                    at, where = table.at(cell), source.trace(cell.offset)
                    printed = read_value(
                        cell.text, unit, column, at, findings, mode=mode, where=where, if_empty=_ONLY_U
                    )
                    if beside is not None:
                        given = _uncertainty(table, beside, name, of_u[name], findings)
                        printed = printed and _with(
                            table, cell, printed, name, given, source.trace(beside.offset), findings
                        )
                read.append(printed)
            values[name] = tuple(read)
    if len(findings.found) > before:
        return None
    _refuse_nothing(table, used, {name: places[name] for name in values}, columns, findings)
    if len(findings.found) > before:
        return None
    taken = tuple(test for place, test in enumerate(tests) if place not in gone)
    named = {name: place for name, place in places.items() if name not in ("test", LEFT_OUT)}

    def texts(row: CsvRow) -> dict[str, str]:
        return {name: row.fields[place].text for name, place in named.items()}

    def stated(row: CsvRow) -> dict[str, tuple[Error, ...] | None]:
        # Nothing in a row that is left out is wrong: what is found of it, nobody hears.
        given = {name: row.fields[named[f"u({name})"]] for name in columns if f"u({name})" in named}
        us = {name: _uncertainty(table, each, name, of_u[name], Findings()) for name, each in given.items()}
        return {name: _known(name, u) for name, u in us.items()}

    left_out = tuple(
        LeftOut(
            tests[row],
            reasons[row].text,
            texts(table.rows[row]),
            stated(table.rows[row]),
            row,
            table.at(reasons[row]),
        )
        for row in sorted(gone)
    )
    lines = dict(zip(taken, map(texts, used), strict=True))
    first = {name: table.header[place].text for name, place in places.items()}
    return Measurements(taken, values, units, left_out, first, lines, remarks, tuple(near))


def _refuse_nothing(
    table: CsvTable,
    rows: Sequence[CsvRow],
    places: Mapping[str, int],
    columns: Mapping[str, Measured],
    findings: Findings,
) -> None:
    """Refuse columns and rows without any number: a cell may be empty, as long as others are not."""
    for name, place in places.items():
        if not any(row.fields[place].text for row in rows):
            allowed, at = f"a number ({columns[name].meaning})", table.at(rows[0].fields[place])
            findings.add("LS403", at, name=name, allowed=allowed, suggestion=_NOWHERE)
    for row in rows if places else ():
        if not any(row.fields[place].text for place in places.values()):
            allowed, at = "a number in one column at least", table.at(row.fields[min(places.values())])
            findings.add("LS403", at, name="the row", allowed=allowed, suggestion=_GAP)


def _check_words(table: CsvTable, fields: Sequence[Field], name: str, findings: Findings) -> None:
    """Refuse a row of which no word says to which others it belongs."""
    for each in fields:
        if not each.text:
            hint = f"write which {name} the row belongs to"
            findings.add("LS403", table.at(each), name=name, allowed="a word", suggestion=hint)
    if fields and all(is_number(each.text) for each in fields if each.text):
        findings.add("LS318", table.at(fields[0]), name=name, text=fields[0].text)


def _alike(table: CsvTable, fields: Mapping[int, Field], name: str, findings: Findings) -> Iterator[Alike]:
    """Words that may be others misspelt; those that differ as nobody means it are refused."""
    rows: dict[str, list[int]] = {}
    for test, each in fields.items():
        if each.text:
            rows.setdefault(each.text, []).append(test)
    first: dict[str, str] = {}
    for word in sorted(rows, key=lambda each: -len(rows[each])):
        if (other := first.setdefault(same(word), word)) != word:
            at, line = table.at(fields[rows[word][0]]), table.at(fields[rows[other][0]]).line
            findings.add("LS319", at, name=name, text=word, other=other, line=line)
    yield from (
        Alike(name, word, tuple(rows[word]), other, tuple(rows[other]), table.at(fields[rows[word][0]]))
        for word, other in alike(rows)
    )


def _remarks(
    table: CsvTable,
    heads: Sequence[ColumnHead | None],
    names: Sequence[str],
    known: Collection[str],
    groups: Collection[str],
) -> Iterator[str]:
    """The columns of words, by which rows belong together or that only come along.

    The latter have no unit and no misspelt name of another.
    """
    for place, head in enumerate(heads):
        if names[place] in groups:
            yield names[place]
            continue
        if head is None or head.unit is not None or not names[place] or close(names[place], known):
            continue
        if _EXCLUDING.fullmatch(names[place]):
            continue  # whoever wrote it thinks that its rows take no part
        texts = [row.fields[place].text for row in table.rows]
        if any(text and not is_number(text) for text in texts):
            yield names[place]


def _not_here(table: CsvTable, place: int, name: str, elsewhere: Collection[str], findings: Findings) -> str:
    """The name in a field of the first line; none, with a finding, where it is of a column that is taken."""
    of = name.removeprefix("u(").removesuffix(")")
    if of not in elsewhere:
        return name
    hint = f"leave out this column, or what [measurements.taken] says of {of}"
    code = "LS317" if of == name else "LS433"
    findings.add(code, table.at(table.header[place]), name=of, suggestion=hint)
    return ""


def _last(table: CsvTable) -> Location:
    row = table.rows[-1] if table.rows else None
    return table.at(row.fields[0]) if row else table.end_of_header()


def read_head(
    table: CsvTable, field: Field, columns: Mapping[str, Declared], findings: Findings
) -> ColumnHead | None:
    """Read a field of the first line; a column that should name its unit and does not is a finding."""
    match = _HEAD.fullmatch(field.text)
    meant = None if match and match["name"] in columns else _meant(field.text, columns)
    if match is None or meant is not None:
        if not field.text:
            return ColumnHead("", None, 0)
        column, unit = meant or (None, "um")
        example = f"{column.name if column else 'x_p'} [{unit}]"
        findings.add("LS305", table.at(field), text=field.text, example=example)
        return ColumnHead(column.name, None, 0) if column else None
    name = re.sub(r"\s", "", match["name"]) if match["name"].startswith("u(") else match["name"]
    column = columns.get(name.removeprefix("u(").removesuffix(")"))
    if column is not None and (match["unit"] is None or (not match["unit"].strip() and _has_scale(column))):
        example = f"{name} [{column.unit}]"
        findings.add("LS304", table.at(field), text=name, unit=column.unit, example=example)
    return ColumnHead(name, match["unit"], match.start("unit"))


def _has_scale(column: Declared) -> bool:
    """Whether it is a pure number that is declared in a unit: one without it would be read as another."""
    return not is_pure(column.unit) and not parse_unit(column.unit).dimension


def _meant(text: str, columns: Mapping[str, Declared]) -> tuple[Declared, str] | None:
    """The column that a text begins with, and the unit that follows somehow: ``x_p (mm)``, ``x_p_mm``.

    What follows and is no unit of that column leaves the column's own unit, if it stands in brackets of any
    kind; without them, the text means something else.
    """
    for name in sorted(columns, key=len, reverse=True):
        if not re.match(rf"{re.escape(name)}(?![^\W_])", text):
            continue
        column, rest = columns[name], text.removeprefix(name)
        word = re.sub(r"^[\W_]*(?:in\b)?", "", rest).strip(" ()[]{}<>")
        try:
            fits = parse_unit(word).dimension == parse_unit(column.unit).dimension if word else False
        except UnitError:
            fits = False
        if fits or re.search(r"[()\[\]{}]", rest):
            return column, word if fits else column.unit
    return None


def read_unit(
    table: CsvTable,
    heads: Sequence[ColumnHead | None],
    place: int | None,
    column: Declared,
    findings: Findings,
) -> tuple[ColumnHead | None, ParsedUnit | None]:
    """Return what the first line says of a column, and its unit if that is one of the right dimension."""
    head = None if place is None else heads[place]
    if place is None or head is None or head.unit is None:
        return head, None
    field = table.header[place]
    expected = parse_unit(column.unit)
    try:
        unit = parse_unit(head.unit.strip() or "1")
    except UnitError as error:
        shift = head.start + head.unit.index(head.unit.strip())
        at = table.at(field, shift + error.start, len(error.text))
        findings.add(error.code, at, text=error.text, suggestion=error.suggestion, known=examples(expected))
        return head, None
    if unit.dimension != expected.dimension:
        at = table.at(field, head.start, max(len(head.unit), 1))
        findings.add("LS422", at, name=head.name, text=head.unit, unit=column.unit, known=examples(expected))
        return head, None
    if head.name == column.name and (hint := misfit(unit, expected)):
        at = table.at(field, head.start, len(head.unit))
        findings.add("LS423", at, text=head.unit, suggestion=hint)
        return head, None
    return head, unit


def _tests(table: CsvTable, place: int, findings: Findings) -> tuple[int, ...]:
    lines: dict[int, int | None] = {}
    called = table.header[place].text
    for row in table.rows:
        field = row.fields[place]
        if not field.text:
            findings.add(
                "LS403", table.at(field), name=called, allowed="a positive whole number", suggestion=""
            )
        elif not _TEST.fullmatch(field.text):
            findings.add("LS312", table.at(field), text=field.text)
        elif int(field.text) in lines:
            first = lines[int(field.text)]
            findings.add("LS311", table.at(field), name=called, text=field.text, first=first)
        else:
            lines[int(field.text)] = table.at(field).line
    return tuple(lines)


def _uncertainty(
    table: CsvTable, field: Field, name: str, unit: ParsedUnit | None, findings: Findings
) -> Fraction | None:
    """Read the standard uncertainty that the user gave for a measured number, in SI."""
    try:
        u = read_printed(field.text, unit or parse_unit("1"))
    except NumberError as error:
        fields = {**error.fields, "allowed": "a standard uncertainty of at least 0"}
        findings.add(error.code, table.at(field), name=f"u({name})", **fields)
        return None
    if u.number < 0:
        findings.add("LS407", table.at(field), name=f"u({name})", text=field.text)
        return None
    return u.value - u.zero


def _with(
    table: CsvTable,
    field: Field,
    printed: Printed,
    name: str,
    u: Fraction | None,
    where: str,
    findings: Findings,
) -> Printed:
    """A number with the standard uncertainty of its column, of which it says nothing itself."""
    if printed.stated is not None:
        hint = f"leave out the column u({name}), or what stands in parentheses"
        findings.add("LS433", table.at(field), name=name, suggestion=hint)
    return replace(printed, stated=_known(name, u, where))


def _known(name: str, u: Fraction | None, where: str = "") -> tuple[Error, ...] | None:
    """The error that a column of uncertainties says."""
    return None if u is None else (Error(u, said=f"u({name})", where=where),)
