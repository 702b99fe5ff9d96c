"""Values as a publication prints them, for the referee."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from ...derivations.unit_text import ParsedUnit, UnitError, degrees, examples, misfit, parse_open, parse_unit
from ..cells.address import index_text
from ..messages.errors import Findings, Location, listing, suggest
from .about import FORMS, About, read_about
from .csvtable import CsvTable, Field, match_columns, read_table
from .expected import Cells, Words, row_of, rows
from .keys import PUBLISHED
from .number_text import NumberError, read_number, read_printed, with_uncertainty

if TYPE_CHECKING:
    from ..quantity import Printed
    from .measurements import Measurements
    from .sources import Source

_REQUIRED = tuple(name for name, column in PUBLISHED.items() if column.required)
_OPTIONAL = tuple(name for name, column in PUBLISHED.items() if not column.required)
COLUMNS = (*_REQUIRED, *_OPTIONAL)
_AS_DATE = "a spreadsheet may have turned 1-2 into a date: format the column as text"
_AS_WORD = (
    "no row is called so; one stands by its number here, or by its word in the table, which "
    "'loopsheet show {} FOLDER' lists"
)
_DATE = re.compile(r"^[0-9]|[0-9][-./ ]|[-./ ][0-9]")
_INDEX = re.compile(r"[1-9][0-9]{0,8}(?:-[1-9][0-9]{0,8})?")
_EXPECT = ("", "differs")
_ARROW = " -> "
_CODE = re.compile(r"#[A-Z]+!")
_BEGUN = re.compile(r"\s*[+\u2212\u2013-]?\.?[0-9]")


@dataclass(frozen=True)
class Pin:
    """What a known difference is: any other one is a finding."""

    printed: str
    """The published number when the difference was accepted."""
    again: str
    """The recomputed one, printed alike; or the code of a cell that had no value."""

    def __str__(self) -> str:
        """As it is written, ``1.234 -> 1.258``."""
        return f"{self.printed}{_ARROW}{self.again}"

    def holds(self, printed: Printed, again: str) -> bool:
        """Whether the difference is still that one; numbers are compared by value and decimals."""
        return _same(self.printed, printed.text) and _same(self.again, again)


def _same(one: str, other: str) -> bool:
    try:
        read = [read_printed(text, parse_unit("1")) for text in (one, other)]
    except NumberError:
        return one == other
    return read[0].value == read[1].value and read[0].decimals == read[1].decimals


@dataclass(frozen=True)
class PublishedValue:
    """A number as a publication prints it."""

    source: str
    """Where it is printed: ``Table 2``, ``text``."""
    cell: str
    """The name of the cell that it is a value of."""
    index: tuple[int, ...]
    """``(1, 2)`` for a pair, ``(3,)`` for a test, ``()`` for a scalar."""
    printed: Printed
    """The number with its digits and its unit."""
    expect: str = ""
    """Empty, or ``differs`` for a difference that is known."""
    pin: Pin | None = None
    """What it differs to; None where nobody has said it."""
    explained: str = ""
    """The name of the explanation that it rests on, as the referee calls it: ``misprint x_p[2]``."""
    reason: str = ""
    """Why it differs."""
    where: str = ""
    """``file:line:column`` of the value, relative to the folder."""
    places: Mapping[str, Location] = field(default_factory=dict, compare=False, repr=False)
    """The place of each field, for findings that need the sheet."""
    label: str = ""
    """What the publication calls its row, if that names an equation: ``eq. 6``."""
    unread: frozenset[str] = frozenset()
    """Fields that are refused already; the sheet is not asked for more about them."""
    about: About | None = None
    """What it tells of a cell besides its value, then `cell` is how that is written; None for a value."""
    word: str = ""
    """What stands for its row in the file, if no number does, as long as nobody knows which row that is."""
    called: str = ""
    """The word that does."""

    @property
    def row(self) -> str:
        """Its index as the file says it: ``1-2``, ``S-18``; empty for a scalar."""
        return self.called or self.word or index_text(self.index)

    def of_words(self, words: Words) -> PublishedValue:
        """The same with the row that its word stands for; one that stands for none is told later."""
        row = row_of(self.word, words.get(self.columns[0], {})) if self.word else None
        return self if row is None else replace(self, index=row, word="", called=self.word)

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns that it tells of."""
        about = self.about
        return (self.cell,) if about is None else tuple(filter(None, (about.cell, about.other)))


def read_published(
    source: Source, findings: Findings, words: Collection[str] | None = ()
) -> tuple[PublishedValue, ...]:
    """Read published.csv, as far as it can be checked without the sheet.

    Parameters
    ----------
    source : Source
        The file.
    findings : Findings
        Where findings go.
    words : collection of str or None
        Those of the table of measurements: one may stand for a row. Where that could not be read, None: then
        what begins with a letter may be one.
    """
    table = read_table(source, COLUMNS, findings)
    if table is None:
        return ()
    names = [field.text for field in table.header]
    places = match_columns(table, names, {name: name for name in _REQUIRED}, _OPTIONAL, findings)
    if not places.keys() >= set(_REQUIRED):
        return ()
    values = []
    first: dict[tuple[str, str, str], int | None] = {}
    for row in table.rows:
        if findings.full:
            break
        fields = {name: row.fields[place] for name, place in places.items()}
        values.append(_value(table, fields, findings, words))
        key = (fields["source"].text, fields["cell"].text, fields["index"].text)
        at = table.at(fields["cell"])
        if key in first:
            name = " ".join(filter(None, key[1:]))
            findings.add("LS504", at, text=name, source=key[0], first=first[key])
        first.setdefault(key, at.line)
    return tuple(values)


def _value(
    table: CsvTable, fields: Mapping[str, Field], findings: Findings, known: Collection[str] | None
) -> PublishedValue:
    unread = set()
    allowed = {"source": "where it is printed, such as Table 2", "cell": "the name of a cell, such as alpha"}
    for name, sentence in {**allowed, "unit": "a unit, 1 for a pure number"}.items():
        if not fields[name].text:
            findings.add("LS403", table.at(fields[name]), name=name, allowed=sentence, suggestion="")
            unread.add(name)
    about = read_about(fields["cell"].text)
    if about is None and "(" in fields["cell"].text:
        findings.add("LS509", table.at(fields["cell"]), text=fields["cell"].text, known=FORMS)
        unread.add("cell")
    index = fields["index"]
    may_be = index.text[:1].isalpha() if known is None else index.text in known
    is_word = may_be and not _INDEX.fullmatch(index.text)
    if index.text and not is_word and not _INDEX.fullmatch(index.text):
        hint = _AS_DATE if _DATE.search(index.text) else _AS_WORD.format(fields["cell"].text)
        findings.add("LS501", table.at(index), text=index.text, suggestion=hint)
        unread.add("index")
    words = {name: " ".join(fields[name].text.split()) if name in fields else "" for name in _OPTIONAL}
    if words["expect"] not in _EXPECT:
        at, text = table.at(fields["expect"]), words["expect"]
        findings.add("LS502", at, text=text, suggestion=suggest(text, ["differs"]))
    for name in ("recomputed", "explained"):
        if words[name] and not words["expect"]:
            findings.add("LS508", table.at(fields[name]), name=name)
    pin = _pin(table, fields["recomputed"], findings) if words["recomputed"] else None
    printed = _printed(table, fields, unread, findings)
    if about is not None and about.is_width:
        printed = replace(printed, value=printed.value - printed.zero, zero=Fraction(0))
    return PublishedValue(
        fields["source"].text,
        fields["cell"].text,
        tuple(int(number) for number in index.text.split("-"))
        if index.text and not is_word and "index" not in unread
        else (),
        printed,
        words["expect"],
        pin,
        words["explained"],
        words["reason"],
        printed.where,
        {name: table.at(field) for name, field in fields.items()},
        words["label"],
        frozenset(unread),
        about,
        index.text if is_word else "",
    )


def _pin(table: CsvTable, field: Field, findings: Findings) -> Pin | None:
    printed, _, again = (part.strip() for part in field.text.partition(_ARROW.strip()))
    try:
        read_number(printed)
        if not _CODE.fullmatch(again):
            read_number(again)
    except NumberError:
        findings.add("LS507", table.at(field), text=field.text)
        return None
    return Pin(printed, again)


def _printed(table: CsvTable, fields: Mapping[str, Field], unread: set[str], findings: Findings) -> Printed:
    number, written = fields["value"], fields["unit"]
    unit = parse_unit("1")
    try:
        unit = parse_open(written.text)
    except UnitError as error:
        at = table.at(written, error.start, len(error.text))
        known = "a unit, 1 for a pure number"
        findings.add(error.code, at, text=error.text, suggestion=error.suggestion, known=known)
        unread.add("unit")
    return _number(table, number, unit, fields["cell"].text, findings)


def _number(table: CsvTable, number: Field, unit: ParsedUnit, cell: str, findings: Findings) -> Printed:
    try:
        return read_printed(number.text, unit, where=table.source.trace(number.offset))
    except NumberError as error:
        told = dict(error.fields)
        if error.code == "LS401" and with_uncertainty(number.text):
            own = "" if "(" in cell else f"; its uncertainty is a row of its own, with the cell u({cell})"
            told["suggestion"] = f"the number alone{own}"
        elif not _BEGUN.match(number.text):
            told["suggestion"] = "a line is of a number: take it out; [limits] says where a cell has to lie"
        findings.add(error.code, table.at(number), name="value", **told)
    return read_printed("0", unit)  # it is refused, and its cell is looked at all the same


def check_published(
    published: Sequence[PublishedValue],
    free: Mapping[str, Location],
    cells: Cells,
    tables: Collection[Measurements],
    findings: Findings,
    words: Words,
) -> None:
    """Compare what the published values are values of with the cells of the sheet.

    Parameters
    ----------
    free : mapping of str to Location
        The columns that the publication does not print, with the place that says so.
    cells : Cells
        A unit that is not fixed, such as ``N/m^alpha``, has no other that it converts to.
    tables : collection of Measurements
        The tables of measurements.
    findings : Findings
        Where unknown cells and indices go, and units of another dimension.
    """
    gone = _of_rows_that_are_gone(published, cells, tables, findings, words)
    for name, place in free.items():
        if any(name in table.measured for table in tables):
            findings.add("LS510", place, text=name)
        elif name not in cells:
            known, suggestion = listing(cells, most=24), suggest(name, cells)
            findings.add("LS505", place, text=name, known=known, suggestion=suggestion)
    for value in published:
        if findings.full:
            break
        if "cell" in value.unread:
            continue
        unknown = [name for name in value.columns if name not in cells]
        for name in unknown:
            at, known = value.places.get("cell"), listing(cells, most=24)
            findings.add("LS505", at, text=name, known=known, suggestion=suggest(name, cells))
        if unknown:
            continue
        unit, _ = cells[value.columns[0]]
        of_rows = value.columns if value.about and value.about.kind == "r" else value.columns[:1]
        for name in of_rows if "index" not in value.unread and id(value) not in gone else ():
            if value.word or value.index not in cells[name][1]:
                at, text = value.places.get("index"), value.row
                known = _indices(cells[name][1], words.get(name, {}))
                findings.add("LS506", at, name=name, text=text, known=known)
        if value.about and value.about.is_pure:
            unit = "1"
        if "unit" not in value.unread:
            at, width = value.places.get("unit"), value.about is not None and value.about.is_width
            unit_fits(value.printed.unit, unit, value.cell, at, findings, width=width)


def _of_rows_that_are_gone(
    published: Sequence[PublishedValue],
    cells: Cells,
    tables: Collection[Measurements],
    findings: Findings,
    words: Words,
) -> set[int]:
    """Several values of one row that the table has not, by identity: that is told once."""
    if len(tables) != 1:
        return set()  # and a number is not that of one row
    (table,) = tables
    there, of = set(table.tests), dict[int, list[PublishedValue]]()
    for value in published:
        name = value.columns[0]
        if name not in cells or value.word or "index" in value.unread:
            continue
        is_of_rows = name in table.measured or not words.get(name)  # groups have words
        if is_of_rows and all(there.issuperset(index) for index in cells[name][1]):
            for test in set(value.index) - there:
                of.setdefault(test, []).append(value)
    several = {test: values for test, values in of.items() if len(values) > 1}
    for test, values in several.items():
        known = f"{table.row} {listing(map(str, sorted(there)))}"
        told = {"file": table.file, "row": f"{table.row} {test}", "number": len(values), "known": known}
        findings.add("LS511", values[0].places.get("index"), **told)
    return {id(value) for values in several.values() for value in values}


def unit_fits(
    written: str, unit: str, name: str, at: Location | None, findings: Findings, *, width: bool
) -> bool:
    """Whether a number of a cell may be in a unit; if not, it is told.

    Parameters
    ----------
    written : str
        The unit of the number.
    unit : str
        That which the cell is declared in.
    name : str
        What the number is.
    at : Location or None
        Where it stands.
    width : bool
        Whether it is a difference of values of the cell, as an uncertainty is.
    """
    if (others := _not_convertible(written, unit)) is not None:
        hint = degrees(written, parse_open(unit))
        findings.add("LS422", at, name=name, text=written, unit=unit, known=others, suggestion=hint)
        return False
    try:
        declared, own = parse_unit(unit), parse_unit(written)
    except UnitError:
        return True  # the unit hangs on an exponent, and is the same
    hint = "" if width and declared.zero else misfit(own, declared)
    if hint:
        known = examples(declared)
        findings.add("LS422", at, name=name, text=written, unit=unit, known=known, suggestion=hint)
    return not hint


def _not_convertible(written: str, unit: str) -> str | None:
    """None where a unit converts to that of a cell, else what does."""
    try:
        expected = parse_unit(unit)
    except UnitError:
        return None if written == unit else f"{unit} as it stands: its size hangs on the exponent"
    try:
        fits = parse_unit(written).dimension == expected.dimension
    except UnitError:
        fits = False
    return None if fits else examples(expected)


def _indices(indices: Collection[tuple[int, ...]], words: Mapping[tuple[int, ...], str]) -> str:
    if () in indices:
        return "nothing: it is a single number"
    return rows(indices, words)
