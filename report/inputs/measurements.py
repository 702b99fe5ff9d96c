"""The table of the tests: units in its first line, one row a test, the digits as printed."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

from ...derivations.unit_text import ParsedUnit, UnitError, is_pure, parse_unit
from ..distribution import Error
from ..messages.errors import Findings, close, listing
from ..workbook import RowTable
from .csvtable import CsvRow, CsvTable, Field, is_number, match_columns, read_table
from .keys import LEFT_OUT, NO_REASONS
from .number_text import NumberError, read_printed, read_unit_of, read_value
from .spelling import Alike, alike, in_case, same
from .stated import PERCENT
from .taken import Taken, alone

if TYPE_CHECKING:
    from ..messages.errors import Location
    from ..quantity import Printed
    from ..workbook import Measured
    from .number_text import Declared
    from .sources import Source

MODES = ("rounded", "truncated")
"""How a printed number may have been shortened."""

_GAP = f"say why it is missing in a column '{LEFT_OUT}': the row takes no part then"
_ONLY_U = "what has an uncertainty has a value: leave out both, or neither"
_NOWHERE = "no row of this column has one: leave out what the method does not need"
_EXCLUDING = re.compile(r"(?i)(exclu|omit|reject|discard|skip|ignor|outlier|left[_-]?out|leave[ _-]?out).*")

_HEAD = re.compile(r"(?P<name>u\([^()\[\]]*\)|[^()\[\]]+?)\s*(?:\[(?P<unit>[^\[\]]*)\])?")
_OTHER_BRACKETS = re.compile(r"(?P<name>\w+)\s*[(\[{<]\s*(?P<unit>[^()\[\]{}<>]+)")
_EXPANDED = re.compile(r"U\s?\((?P<name>[^()\[\]]*)\)\s*(?:\[(?P<unit>[^\[\]]*)\])?")
"""The head of a column of expanded uncertainties, which there is not."""
_MOST_DIGITS = 100
"""Of a word that may be a number; Python refuses to read thousands."""
_TEST = re.compile(r"0*[1-9][0-9]{0,8}")


@dataclass(frozen=True)
class LeftOut:
    """A test that takes no part in anything."""

    test: int
    """Its number."""
    reason: str
    """Why, in the words of the file."""
    texts: dict[str, str]
    """What stands in its row, as it stands, by the name of the column; it may be no number."""
    stated: dict[str, tuple[Error, ...] | None]
    """What is stated of its numbers, by their columns; None: what stands there is no uncertainty."""
    place: int
    """How many rows stand above it."""
    at: Location
    """Where its reason was written."""


@dataclass(frozen=True)
class Measurements:
    """A checked table: test numbers, and a printed number for each test and measured column."""

    tests: tuple[int, ...]
    """The numbers of its rows, in the order of the file."""
    measured: dict[str, tuple[Printed | None, ...]]
    """One number a row for each measured column; None where the cell is empty."""
    header_units: dict[str, str]
    """The unit of each measured column, as written in the header, and of the column of its uncertainties,
    which is called ``u(x_p)``."""
    left_out: tuple[LeftOut, ...] = ()
    """The rows that take no part, each with its reason; all else is about the others."""
    heads: dict[str, str] = field(default_factory=dict)
    """The first line as it stands, by what it names."""
    texts: dict[int, dict[str, str]] = field(default_factory=dict)
    """Each row as it stands, by column; one that is left out stands with that."""
    remarks: tuple[str, ...] = ()
    """The columns of words that come along; nothing is computed from them."""
    alike: tuple[Alike, ...] = ()
    """Words by which rows belong together, and that may be others misspelt."""
    table: RowTable = field(default_factory=RowTable)
    """What the workbook says of it."""
    file: str = "measurements.csv"
    """Where it stands, from the folder."""

    @property
    def name(self) -> str:
        """The index set of its rows; none of the only table."""
        return self.table.name

    @property
    def row(self) -> str:
        """What its rows are called."""
        return self.table.row

    @property
    def every_word(self) -> set[str]:
        """Those in columns of words."""
        return {row[name] for row in self.texts.values() for name in self.remarks if row[name]}

    @cached_property
    def rows(self) -> Mapping[int, Mapping[str, str]]:
        """Each row as it stands, by column, those that are left out last."""
        return {**self.texts, **{each.test: each.texts for each in self.left_out}}

    @cached_property
    def naming(self) -> tuple[str, ...]:
        """The column of words that says which row is which: the first with a word for each; or none."""
        return tuple(name for name in self.remarks if all(self.texts[test][name] for test in self.tests))[:1]

    def called(self, test: int) -> str:
        """A row in a sentence: its number, and its name if it has one, ``3 (S-17)``."""
        names = [self.rows[test][name] for name in self.naming]
        return f"{test} ({names[0]})" if any(names) else str(test)

    def words(self, column: str) -> list[str]:
        """The words of a column in the order in which they first appear, in rows that are left out too.

        `column`: by which the workbook groups.
        """
        found = [row[column] for row in self.texts.values()]
        for each in self.left_out:
            found.insert(each.place, each.texts[column])
        return list(dict.fromkeys(found))

    def groups(self, column: str) -> dict[int, int]:
        """The number of each row's word, from 1: whatever is left out, others keep theirs."""
        number = {word: place for place, word in enumerate(self.words(column), start=1)}
        return {test: number[row[column]] for test, row in self.rows.items()}

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
    elsewhere: Collection[str],
    of: RowTable,
    others: Mapping[str, str],
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
    of : RowTable
        What the workbook says of its rows: what else the column of their numbers may be called (without it,
        they are numbered as they stand), which columns of words group them, how many there must be.
    others : mapping of str to str
        The columns of other tables, and where these stand: they are not looked for here.
    """
    before = len(findings.found)
    columns = {column.name: column for column in measured or () if column.name not in elsewhere}
    required = {"test": of.row, **{name: f"{name} [{column.unit}]" for name, column in columns.items()}}
    table = read_table(source, list(required.values()), findings, semicolons=True)
    if table is None:
        return None
    reading = _Reading(source, table, columns, findings, of.row, of.groups, others)
    reading.find(None if measured is None else required, elsewhere)
    if measured is None and "test" not in reading.places:
        return None  # its rows may be called as the workbook says, which is not known
    tests, reasons = reading.tests(), reading.fields(LEFT_OUT)
    if answer := next((each for each in reasons if each.text.lower() in NO_REASONS), None):
        findings.add("LS321", table.at(answer), text=answer.text, name=of.row)
    gone = {place for place, each in enumerate(reasons) if each.text and each.text.lower() not in NO_REASONS}
    reading.count(len(gone), of.least)
    near = reading.alike(tests)
    used = [row for place, row in enumerate(table.rows) if place not in gone]
    values = reading.values(used, modes)
    if len(findings.found) > before:
        return None
    reading.refuse_nothing(used, list(values))
    if len(findings.found) > before:
        return None
    taken = tuple(test for place, test in enumerate(tests) if place not in gone)
    left_out = tuple(
        LeftOut(tests[n], reasons[n].text, *reading.as_it_stands(table.rows[n]), n, table.at(reasons[n]))
        for n in sorted(gone)
    )
    lines = dict(zip(taken, map(reading.texts, used), strict=True))
    first = {name: table.header[place].text for name, place in reading.places.items()}
    units = {each.name: (each.unit or "").strip() or "1" for each in reading.with_units}
    more = reading.remarks, near, of, source.name
    return Measurements(taken, values, units, left_out, first, lines, *more)


@dataclass
class _Reading:
    """A table as it is read: where its columns stand, and all that is wrong with them."""

    source: Source
    table: CsvTable
    columns: Mapping[str, Measured]
    findings: Findings
    called: str
    groups: Collection[str]
    others: Mapping[str, str]

    def __post_init__(self) -> None:
        """Read the first line."""
        read = (read_head(self.table, each, self.columns, self.findings) for each in self.table.header)
        self.heads = list(read)
        self.places: Mapping[str, int] = {}
        self.remarks: tuple[str, ...] = ()
        self.of_u: dict[str, ParsedUnit | None] = {}
        self.with_units: list[ColumnHead] = []

    def find(self, required: dict[str, str] | None, elsewhere: Collection[str]) -> None:
        """Find the columns; without a workbook, only that of the tests' numbers is known."""
        called, names = self.called, [head.name if head else "" for head in self.heads]
        # Where rows are called specimens, a column 'specimen' has their numbers, or else their names.
        numbers = [
            is_number(row.fields[names.index(called)].text) for row in self.table.rows if called in names
        ]
        has_names = bool(numbers) and not any(numbers)
        if "test" not in names and called not in self.columns and not has_names:
            names = ["test" if name == called else name for name in names]
        names = [self._here(n, name, elsewhere) for n, name in enumerate(names)]
        if required is None:
            self.places = {"test": names.index("test")} if "test" in names else {}
            return
        optional = [*(f"u({name})" for name in self.columns), LEFT_OUT]
        if "test" not in names:  # rows are numbered as they stand
            del required["test"]
            optional += ["test"] if has_names else list(dict.fromkeys(("test", called)))
        known = [*([] if has_names else [called]), *required, *optional, *elsewhere, *self.groups]
        self.remarks = tuple(self._remarks(names, known))
        required |= {name: name for name in self.groups}
        optional += self.remarks
        told, words = {"test": called}, [name for name in self.remarks if name not in self.groups]
        self.places = match_columns(self.table, names, required, optional, self.findings, told, words)

    def _here(self, place: int, name: str, elsewhere: Collection[str]) -> str:
        """The name in a field of the first line; none, with a finding, where its column stands elsewhere."""
        of = name.removeprefix("u(").removesuffix(")")
        if of in self.others:
            known, hint = listing(self.columns), f"{of} is a column of {self.others[of]}: it belongs there"
            at = self.table.at(self.table.header[place])
            self.findings.add("LS303", at, text=name, known=known, suggestion=hint)
            return ""
        if of not in elsewhere:
            return name
        hint = f"leave out this column, or what [measurements.taken] says of {of}"
        code = "LS317" if of == name else "LS433"
        self.findings.add(code, self.table.at(self.table.header[place]), name=of, suggestion=hint)
        return ""

    def _remarks(self, names: Sequence[str], known: Collection[str]) -> Iterator[str]:
        """The columns of words, by which rows belong together or that only come along.

        The latter have no unit and no misspelt name of another.
        """
        missing = {*known} - {head.name for head in self.heads if head is not None}
        for place, (head, name) in enumerate(zip(self.heads, names, strict=True)):
            if name in self.groups:
                yield name
                continue
            if head is None or head.unit is not None or not name:
                continue
            # What is there is hardly misspelt as well: 'name' beside 'sample' is what it says.
            if close(name, missing) or close(name, known, 0.75):
                continue
            if _EXCLUDING.fullmatch(name):
                continue  # whoever wrote it thinks that its rows take no part
            texts = [row.fields[place].text for row in self.table.rows]
            # Of a column without any word, or a table without rows, nobody knows: it may get some.
            if not any(texts) or any(text and not is_number(text) for text in texts):
                yield name

    def fields(self, name: str) -> list[Field]:
        """What stands in a column; nothing, if there is none."""
        return [row.fields[self.places[name]] for row in self.table.rows] if name in self.places else []

    def tests(self) -> tuple[int, ...]:
        """The numbers of the tests: those of their column, or of the rows as they stand."""
        if "test" not in self.places:
            return tuple(range(1, len(self.table.rows) + 1))
        lines: dict[int, int | None] = {}
        called = self.table.header[self.places["test"]].text
        for each in self.fields("test"):
            at, text = self.table.at(each), each.text
            if not text:
                self.findings.add("LS403", at, name=called, allowed="a positive whole number", suggestion="")
            elif not _TEST.fullmatch(text):
                hint = "a line that sums rows up does not belong here: the method computes it"
                self.findings.add(
                    "LS312", at, name=called, text=text, suggestion="" if is_number(text) else hint
                )
            elif int(text) in lines:
                self.findings.add("LS311", at, name=called, text=text, first=lines[int(text)])
            else:
                lines[int(text)] = at.line
        return tuple(lines)

    def count(self, gone: int, least: int) -> None:
        """Refuse a table with too few rows that are not left out."""
        table = self.table
        if (total := table.total - gone) >= least:
            return
        said = f"no {self.called}" if total == 0 else f"one {self.called} only"
        at = table.at(table.rows[-1].fields[0]) if table.rows else table.end_of_header()
        said += " that is not left out" * bool(gone)
        rows = "two rows" if least > 1 else "one row"
        self.findings.add("LS310", at, count=said, least=rows, row=self.called)

    def alike(self, tests: Sequence[int]) -> tuple[Alike, ...]:
        """Words that may be others misspelt, of all columns of words by which rows belong together."""
        near: list[Alike] = []
        for name in (name for name in self.groups if name in self.places):
            fields = self.fields(name)
            _check_words(self.table, fields, name, self.findings)
            if len(tests) == len(fields):
                near += _alike(self.table, dict(zip(tests, fields, strict=True)), name, self.findings)
        naming = next((each for each in self.remarks if all(one.text for one in self.fields(each))), None)
        if naming is not None and naming not in self.groups:
            named = dict(zip(tests, self.fields(naming), strict=False))
            _check_names(self.table, named, naming, self.findings)
        return tuple(near)

    def values(
        self, rows: Sequence[CsvRow], modes: Mapping[str, str]
    ) -> dict[str, tuple[Printed | None, ...]]:
        """The numbers of all columns in some rows."""
        found = {}
        for name, column in self.columns.items():
            unit, self.of_u[name] = (self._unit(each, column) for each in (name, f"u({name})"))
            self._check_share(column, unit, self.of_u[name])
            if name in self.places:
                mode = modes.get(name, "rounded")
                read = (self._value(row, column, unit, mode) for row in rows if not self.findings.full)
                found[name] = tuple(read)
        return found

    def _unit(self, name: str, column: Measured) -> ParsedUnit | None:
        head, unit = read_unit(self.table, self.heads, self.places.get(name), column, self.findings)
        if head is not None and head.unit is not None:
            self.with_units.append(head)  # empty brackets: a pure number
        return unit

    def _check_share(self, column: Measured, unit: ParsedUnit | None, of_u: ParsedUnit | None) -> None:
        """Refuse percent beside a pure number in another unit: they may be of the number, or of 1."""
        own, name = unit or parse_unit(column.unit), f"u({column.name})"
        if of_u is not None and of_u.text in PERCENT and not own.dimension and own.text not in PERCENT:
            hint = (
                f"write each in the unit of its number, {name} [{own.text}]; "
                f'or of all of them [uncertainty] {column.name} = "u = 2 % of reading"'
            )
            at = self.table.at(self.table.header[self.places[name]])
            self.findings.add("LS431", at, text=f"{name} [{of_u.text}]", suggestion=hint)

    def _value(self, row: CsvRow, column: Measured, unit: ParsedUnit | None, mode: str) -> Printed | None:
        """A cell, with the uncertainty that its row says."""
        name = column.name
        cell, beside = row.fields[self.places[name]], self._beside(row, name)
        if not cell.text and (beside is None or not beside.text):
            return None
        at, where = self.table.at(cell), self.source.trace(cell.offset)
        printed = read_value(
            cell.text, unit, column, at, self.findings, mode=mode, where=where, if_empty=_ONLY_U
        )
        if beside is None:
            return printed
        u = _uncertainty(self.table, beside, name, self.of_u[name], self.findings)
        if printed is None:
            return None
        if printed.stated is not None:
            hint = f"leave out the column u({name}), or what stands in parentheses"
            self.findings.add("LS433", at, name=name, suggestion=hint)
        return replace(printed, stated=_known(name, u, self.source.trace(beside.offset)))

    def _beside(self, row: CsvRow, name: str) -> Field | None:
        """The field of its uncertainty."""
        place = self.places.get(f"u({name})")
        return None if place is None else row.fields[place]

    def refuse_nothing(self, rows: Sequence[CsvRow], names: Sequence[str]) -> None:
        """Refuse columns and rows without any number: a cell may be empty, as long as others are not."""
        places = {name: self.places[name] for name in names}
        for name, place in places.items():
            if not any(row.fields[place].text for row in rows):
                allowed, at = f"a number ({self.columns[name].meaning})", self.table.at(rows[0].fields[place])
                self.findings.add("LS403", at, name=name, allowed=allowed, suggestion=_NOWHERE)
        for row in rows if places else ():
            if not any(row.fields[place].text for place in places.values()):
                at = self.table.at(row.fields[min(places.values())])
                allowed = "a number in one column at least"
                self.findings.add("LS403", at, name="the row", allowed=allowed, suggestion=_GAP)

    def texts(self, row: CsvRow) -> dict[str, str]:
        """What stands in a row, but for its number and why it is left out."""
        named = ((name, place) for name, place in self.places.items() if name not in ("test", LEFT_OUT))
        return {name: row.fields[place].text for name, place in named}

    def as_it_stands(self, row: CsvRow) -> tuple[dict[str, str], dict[str, tuple[Error, ...] | None]]:
        """The texts of a row that is left out, and what is stated of its numbers.

        Nothing in it is wrong: what is found of it, nobody hears.
        """
        given = ((name, self._beside(row, name)) for name in self.columns)
        return self.texts(row), {
            name: _known(name, _uncertainty(self.table, each, name, self.of_u[name], Findings()))
            for name, each in given
            if each is not None
        }


def _check_words(table: CsvTable, fields: Sequence[Field], name: str, findings: Findings) -> None:
    """Refuse a row of which no word says to which others it belongs."""
    for each in fields:
        if not each.text:
            hint = f"write which {name} the row belongs to"
            findings.add("LS403", table.at(each), name=name, allowed="a word", suggestion=hint)
    if fields and all(is_number(each.text) for each in fields if each.text):
        findings.add("LS318", table.at(fields[0]), name=name, what="numbers alone", text=fields[0].text)
        return
    words = list(dict.fromkeys(each.text for each in fields))
    for number, word in enumerate(words, start=1):
        if number != _number_in(word) in range(1, len(words) + 1):
            at, what = next(table.at(each) for each in fields if each.text == word), "the number of another"
            findings.add("LS318", at, name=name, what=what, text=word)


def _number_in(word: str) -> int | None:
    """The number of a row that a word may be taken for: none has as many digits as some words."""
    return int(word) if word.isdecimal() and len(word) <= _MOST_DIGITS else None


def _check_names(table: CsvTable, fields: Mapping[int, Field], name: str, findings: Findings) -> None:
    """Refuse the number of another row as the word of one: nobody knows which of them ``x[2]`` is."""
    times = Counter(each.text for each in fields.values())
    for test, each in fields.items():
        if test != _number_in(each.text) in fields and times[each.text] == 1:
            findings.add("LS318", table.at(each), name=name, what="the number of another row", text=each.text)
            return


def _alike(table: CsvTable, fields: Mapping[int, Field], name: str, findings: Findings) -> Iterator[Alike]:
    """Words that may be others misspelt; those that differ as nobody means it are refused."""
    rows: dict[str, list[int]] = {}
    for test, each in fields.items():
        if each.text:
            rows.setdefault(each.text, []).append(test)
    first: dict[str, str] = {}
    for word in sorted(rows, key=lambda each: -len(rows[each])):
        if (other := first.setdefault(same(word), word)) != word and not in_case(word, other, rows):
            at, line = table.at(fields[rows[word][0]]), table.at(fields[rows[other][0]]).line
            findings.add("LS319", at, name=name, text=word, other=other, line=line)
    yield from (
        Alike(name, word, tuple(rows[word]), other, tuple(rows[other]), table.at(fields[rows[word][0]]))
        for word, other in alike(rows)
    )


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
        of = _OTHER_BRACKETS.match(field.text)
        name, more = column.name if column else of["name"] if of else "x_p", ""
        example = f"{name} [{unit if column or not of else of['unit']}]"
        expanded = _EXPANDED.fullmatch(field.text)
        if expanded and expanded["name"] in columns:
            example = f"u({expanded['name']}) [{expanded['unit'] or columns[expanded['name']].unit}]"
            more = ", and below it standard uncertainties: each U divided by its k"
        findings.add("LS305", table.at(field), text=field.text, example=example, suggestion=more)
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
    field, start = table.header[place], head.start
    unit = read_unit_of(
        head.unit, column, lambda first, length: table.at(field, start + first, length), findings, head.name
    )
    return head, unit and replace(unit, text=unit.text.strip() or "1")


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


def _known(name: str, u: Fraction | None, where: str = "") -> tuple[Error, ...] | None:
    """The error that a column of uncertainties says."""
    return None if u is None else (Error(u, said=f"u({name})", where=where),)
