"""From a report folder to typed inputs: everything that is foreign is checked here, and all of it at once."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from ...derivations.unit_text import parse_unit
from ..cells.address import parts
from ..messages.errors import (
    Findings,
    ForeignCode,
    Location,
    LoopsheetError,
    UnknownWorkbook,
    close,
    listing,
    suggest,
)
from ..quantity import there
from ..sheet import Axis, with_parents
from ..workbook import RowTable
from .about import read_about
from .cards import AskedCards, read_cards
from .draws import read_draws
from .expected import Expectation, read_expected
from .keys import fixed
from .limits import Limits, read_limits
from .measurements import MODES, LeftOut, Measurements, read_measurements
from .number_text import NumberError, read_printed
from .parameters import read_parameters, wrong_type
from .published import PublishedValue, read_published
from .sources import Source, open_source, read_bytes
from .stated import Conventions
from .tables import TomlTables
from .taken import EXAMPLE as TAKING
from .taken import Taken, alone, open_result, read_taken
from .tomlfile import TomlFile, read_toml
from .uncertainty import Stated, read_bare, read_uncertainty

if TYPE_CHECKING:
    from ..files.values import Result
    from ..messages.errors import Diagnostic
    from ..quantity import Printed
    from ..workbook import Workbook
    from .number_text import Declared

Find = Callable[[str, Path, bytes | None], "Workbook"]
"""Finds a workbook by its name in report.toml, the folder, and what the file of that name holds."""

More = Callable[["Inputs"], Iterable["Diagnostic"]]
"""Looks at the cells that a folder names, where what is computed is in order and something else is not."""

LARGEST_TOML = 250_000
LARGEST_TABLE = 50_000_000
LARGEST_PUBLISHED = 5_000_000
"""Bytes. Anything larger is a mistake, and would be held in memory several times over."""

_SOURCE = "source"


@dataclass(frozen=True)
class Inputs:
    """What a report folder says, checked."""

    folder: Path
    """As it was given."""
    title: str
    """The title of the report; the workbook's, if none is given."""
    workbook: Workbook
    """The method."""
    parameters: dict[str, Printed]
    """Those that were given and those that have a default, in the workbook's order."""
    given: frozenset[str]
    """The names of those that were really given."""
    tables: tuple[Measurements, ...]
    """What was measured, table by table; what is left out there takes no part in all else."""
    published: tuple[PublishedValue, ...]
    """The values to referee."""
    files: dict[str, bytes]
    """The bytes of every file that was read, by its name relative to the folder."""
    named: tuple[tuple[str, str, str], ...] = ()
    """Where report.toml names these files: ``file:line:column``, what stands there (a whole string, with its
    quotes, or a part of one), and which file that is."""
    free_at: dict[str, Location] = field(default_factory=dict)
    """The columns that the publication does not print, with the place that says so."""
    expected: tuple[Expectation, ...] = ()
    """Cells and tests that are expected to be without a value or out of the ordinary, each with its
    reason."""
    errata: dict[tuple[str, int], Printed] = field(default_factory=dict)
    """By (str, int); measured cells that are known to be misprinted, by column and row, as they would have to
    be printed. Only the referee asks what would come out of them."""
    by_source: bool = False
    """Whether the published values are those of the workbook's own source."""
    empty: Location | None = None
    """Where report.toml names a file of published values that holds none."""
    aside: tuple[PublishedValue, ...] = ()
    """Published values that rest on a test that is left out: they are not compared."""
    uncertainty: Stated = field(default_factory=lambda: Stated({}))
    """What report.toml states of the errors of whole columns, of what they share, and of correlations."""
    published_u: tuple[PublishedValue, ...] = ()
    """What is published of the uncertainties of cells."""
    limits: tuple[Limits, ...] = ()
    undecided: tuple[Limits, ...] = ()
    """`limits` and `undecided`: where cells have to lie; those of cells that are missing because a test is
    left out."""
    taken: Mapping[str, Taken] = field(default_factory=dict)
    """The parameters and measured columns whose numbers were taken from other reports."""
    cards: AskedCards = field(default_factory=AskedCards)
    """For which simulation codes the report tells what to type into them."""

    @property
    def about_source(self) -> bool:
        """Whether the report is about its workbook's source, so that the errata of that are its matter.

        It is if it compares with the source, or brought the workbook along.
        """
        return self.by_source or self.own_workbook

    @property
    def own_workbook(self) -> bool:
        """Whether the workbook came with the folder."""
        return any(name.endswith(".py") for name in self.files)

    @property
    def free(self) -> tuple[str, ...]:
        """The columns that the publication does not print: they may have any value."""
        return tuple(self.free_at)

    @cached_property
    def measured(self) -> dict[str, tuple[Printed | None, ...]]:
        """The measured columns of all tables, as the workbook orders them."""
        every = {name: column for table in self.tables for name, column in table.measured.items()}
        order = [each.name for each in self.workbook.measured]
        return {name: every[name] for name in dict.fromkeys((*order, *every)) if name in every}

    @cached_property
    def header_units(self) -> dict[str, str]:
        """The units of all tables, as each has them."""
        return {name: unit for table in self.tables for name, unit in table.header_units.items()}

    def on(self, axis: str) -> Measurements:
        """The table that has the rows of an index set; of a method with one table it is that."""
        named = [each for each in self.tables if each.name == axis]
        return named[0] if named else self.only

    def of(self, name: str) -> Measurements:
        """The table that a measured column stands in."""
        return next(each for each in self.tables if name in each.measured)

    def beneath(self, axis: Axis | None) -> list[Measurements]:
        """The tables whose rows those of an index set are made of."""
        return [self.on(each.name) for each in with_parents((axis,)) if each.is_given]

    @property
    def only(self) -> Measurements:
        """That of a method that has one table; without rows, where nothing is measured."""
        (table,) = self.tables or (Measurements((), {}, {}),)
        return table

    @property
    def left_out(self) -> Iterator[tuple[Measurements, LeftOut]]:
        """The rows that take no part, each with its table."""
        return ((table, each) for table in self.tables for each in table.left_out)

    def with_numbers(self, measured: Mapping[str, tuple[Printed | None, ...]]) -> Inputs:
        """The same with other numbers in the rows of some measured columns."""

        def other(table: Measurements) -> Measurements:
            every = table.measured.items()
            return replace(table, measured={name: measured.get(name, column) for name, column in every})

        return replace(self, tables=tuple(map(other, self.tables)))

    @property
    def amended(self) -> Inputs:
        """The same with the known misprints put right."""
        measured = {
            name: tuple(self.errata.get((name, row), printed) for row, printed in enumerate(column))
            for name, column in self.measured.items()
        }
        return replace(self.with_numbers(measured), errata={})

    @property
    def place(self) -> Location:
        """The file that says what is to be reported."""
        return Location((self.folder / "report.toml").as_posix())

    def printed(self, name: str) -> tuple[Printed | None, ...]:
        """The numbers of a given column as they were printed, one a row, None in those without one.

        There are no rows of a column that the folder has nothing of.
        """
        if name in self.measured:
            return self.measured[name]
        return (self.parameters[name],) if name in self.parameters else ()

    def numbers(self, name: str) -> tuple[Printed, ...]:
        """The numbers of a given column that are there."""
        return there(self.printed(name))

    def own_u(self, name: str) -> tuple[float, ...]:
        """The standard uncertainty of each number of a measured column by itself, in SI.

        What is stated of the column and shared by tests has no part in it, nor has what moves several numbers
        that were taken from another report. An empty cell has NaN.
        """
        if (taken := self.taken.get(name)) is not None:
            own = alone(self.taken, self.of(name).measured)
            return tuple(taken.u(errors, own) for errors in taken.errors)
        return tuple(math.nan if each is None else each.u for each in self.printed(name))


def load(
    folder: Path,
    find_workbook: Find,
    more: More = lambda _: (),
    read: Mapping[str, bytes] = MappingProxyType({}),
) -> Inputs:
    """Read a report folder.

    Parameters
    ----------
    folder : Path
        It holds report.toml and the files that report.toml names.
    find_workbook : callable
        Takes the name in report.toml, the folder, and what the file of this name holds if the workbook is
        the user's own; returns the workbook, or raises :class:`UnknownWorkbook` or :class:`ForeignCode`.
    more : callable
        Finds what is wrong with the cells, which only the sheet knows, so that it is told in the same round.
    read : mapping of str to bytes
        Files that were read already, as :func:`~loopsheet.report.inputs.sources.read_bytes` does.

    Raises
    ------
    InputError
        With every finding in every file, each with its place.
    """
    return _Reader(folder, find_workbook, more, read).read()


class _Reader:
    """One reading of a folder: what was found and what was read, so far."""

    def __init__(self, folder: Path, find_workbook: Find, more: More, before: Mapping[str, bytes]) -> None:
        self.folder = folder
        self.before = before
        self.find_workbook = find_workbook
        self.more = more
        self.findings = Findings()
        self.files: dict[str, bytes] = {}
        self.tabled: dict[str, str] = {}  # which table of rows a file is
        self.toml: TomlFile
        self.tables: TomlTables
        self.workbook: Workbook | None = None
        self.free: dict[str, Location] = {}
        self.by_source = False
        self.empty: Location | None = None
        self.said = Conventions()
        self.taken: dict[str, Taken] = {}
        self.results: dict[str, Result | None] = {}

    def read(self) -> Inputs:
        toml = self.open_toml()
        if toml is None:
            self.findings.check()
            raise AssertionError("a folder was refused without a finding")
        self.toml, self.tables = toml, TomlTables(toml, self.findings)
        self.tables.keys(())
        self.said = Conventions(read_bare(self.tables), self.draws, self.take, self.taken)
        self.workbook = self.open_workbook()
        title = self.title()
        parameters, given = self.parameters()
        measurements = self.measurements()
        uncertainty = Stated({})
        if self.workbook and measurements is not None and "uncertainty" in toml.data:
            uncertainty, parameters, measurements = self.uncertainty(parameters, given, measurements)
        computable = not self.findings.found
        words = None if measurements is None else {each for own in measurements for each in own.every_word}
        published = self.published(words)
        expected = read_expected(self.tables)
        limits = read_limits(self.tables, self.workbook.margins if self.workbook else {})
        cards = read_cards(self.tables)
        errata = self.errata(measurements) if self.workbook and measurements is not None else {}
        if not computable:
            self.findings.check()
        if self.workbook is None or measurements is None:
            raise AssertionError("a folder was refused without a finding")
        inputs = Inputs(
            self.folder,
            title or self.workbook.title,
            self.workbook,
            parameters,
            given,
            measurements,
            tuple(value for value in published if value.about is None),
            self.files,
            tuple(_naming(toml, self.files)),
            self.free,
            expected,
            errata,
            self.by_source,
            self.empty,
            uncertainty=uncertainty,
            published_u=tuple(value for value in published if value.about is not None),
            limits=limits,
            taken=self.taken,
            cards=cards,
        )
        if self.findings.found:
            self.findings.found.extend(self.more(inputs))
        self.findings.check()
        return inputs

    def open_toml(self) -> TomlFile | None:
        try:
            exists, is_folder = self.folder.exists(), self.folder.is_dir()
            has_toml = is_folder and (self.folder / "report.toml").exists()
        except (OSError, ValueError):
            exists = is_folder = has_toml = False
        if not exists:
            self.findings.add("LS101", text=self.folder)
        elif not is_folder:
            self.findings.add("LS102", text=self.folder)
        elif not has_toml:
            self.findings.add("LS103", Location(self.folder.as_posix()))
        else:
            source = self.source("report.toml", LARGEST_TOML, "a workbook, parameters and measurements")
            return read_toml(source, self.findings) if source else None
        return None

    def source(self, name: str, limit: int, wanted: str, asked: Location | None = None) -> Source | None:
        data = self.bytes_of(name, limit, asked)
        if data is None:
            return None
        return open_source(
            (self.folder / name).as_posix(), Path(name).as_posix(), data, wanted, self.findings
        )

    def bytes_of(self, name: str, limit: int, asked: Location | None = None) -> bytes | None:
        data = self.before.get(Path(name).as_posix())
        if data is None or len(data) > limit:
            data = read_bytes(self.folder, name, limit, self.findings, asked)
        if data is not None:
            self.files[Path(name).as_posix()] = data
        return data

    # ------------------------------------------------------------------ report.toml

    def title(self) -> str | None:
        return self.tables.text((), "title")

    def open_workbook(self) -> Workbook | None:
        beside = (self.folder / "workbook.py").is_file()
        name = self.tables.text((), "workbook", "workbook.py" if beside else None, required=True)
        if name is None:
            return None
        at = self.toml.value("workbook")
        data = None
        if name.endswith(".py"):  # the user's own code: it is part of what the report was made from
            data = self.bytes_of(name, LARGEST_TOML, at)
            if data is None:
                return None
        try:
            return self.find_workbook(name, self.folder, data if Path(name).name == name else None)
        except UnknownWorkbook as error:
            known = ", ".join([*error.known, "or the name of a .py file in the folder"])
            self.findings.add("LS207", at, text=name, known=known, suggestion=suggest(name, error.known))
        except ForeignCode:
            self.findings.add("LS214", at, text=name)
        except LoopsheetError as error:
            self.findings.found.extend(error.diagnostics)
        return None

    def parameters(self) -> tuple[dict[str, Printed], frozenset[str]]:
        data = self.toml.data.get("parameters", {})
        if self.workbook is None:
            return {}, frozenset()
        declared = {parameter.name: parameter for parameter in self.workbook.parameters}
        before = len(self.findings.found)
        columns = {column.name for column in self.workbook.measured}

        def measured(name: str) -> str:
            moved = "its numbers stand in the table of the measurements; take this line out"
            return f"{name} is a measured column of the workbook: {moved}" if name in columns else ""

        written = self.tables.keys(("parameters",), declared, why_not=measured)
        printed = read_parameters(self.toml, written, self.workbook.parameters, self.findings, self.said)
        given = frozenset(written)
        # A misspelt name would also be missing from its combination: that is one problem, not two.
        above = self.toml.data
        misspelt = "parameters" not in above and any(close(word, ["parameters"]) for word in above)
        if len(self.findings.found) == before and isinstance(data, dict) and not misspelt:
            sentence = self.workbook.wrong(given)
            if sentence:
                known = f"the parameters are {', '.join(declared)}"
                self.findings.add("LS209", self.toml.key("parameters"), reason=sentence, known=known)
        return printed, given

    # ------------------------------------------------------------------ the tables

    def measurements(self) -> tuple[Measurements, ...] | None:
        method, above = self.workbook, self.toml.data.get("measurements")
        if above is None and not (method and method.measured):
            # All that there is to give are parameters, or it cannot be known whether there is anything else.
            return () if method else None
        tables = method.row_tables if method else _named(above)
        if tables[0].name:
            self.tables.keys(("measurements",), [table.name for table in tables], alone=True)
            if not isinstance(above or {}, dict):
                return None
        found = [self.rows_of(table) for table in tables]
        return None if None in found else tuple(table for table in found if table)

    def rows_of(self, of: RowTable) -> Measurements | None:
        """Read one of the tables of rows."""
        method, above = self.workbook, self.toml.data
        table = self.tables.keys(of.place)
        missing = True
        for part in of.place:
            if part not in above:  # a misspelt header is one problem, not two
                missing = missing and not any(close(word, [part]) for word in above)
            above = above.get(part, {})
            if not isinstance(above, dict):
                missing, above = False, {}
        name = self.tables.text(of.place, "file", of.file if of.name else None, required=missing)
        columns = method.columns_of(of) if method else ()
        names = [column.name for column in columns]
        wanted = self.tables.keys((*of.place, "taken"), names) if "taken" in table and names else {}
        known = [name for name in names if name not in wanted] if method else None
        modes = self.modes(of.place, known) if "printed" in table else {}
        if name is None:
            return None
        at = self.toml.value(*of.place, "file")
        if (first := self.tabled.setdefault(Path(name).as_posix(), of.name)) != of.name:
            self.findings.add("LS216", at, text=name, known=first)
            return None
        source = self.source(
            name, LARGEST_TABLE, f"a first line with names and units, then a row for each {of.row}", at
        )
        if source is None:
            return None
        others = {
            column.name: f"the {table.name}, [{'.'.join(table.place)}]"
            for table in (method.row_tables if method else ())
            if table != of
            for column in (method.columns_of(table) if method else ())
        }
        known_columns = columns if method else None
        found = read_measurements(source, known_columns, modes, self.findings, wanted, of, others)
        return found and self.take_columns(found, wanted)

    def take_columns(self, measurements: Measurements, wanted: Mapping[str, object]) -> Measurements | None:
        """Take measured columns from the results of other reports; None, with findings, if one cannot be."""
        gone = [each.test for each in measurements.left_out]
        named = {
            column: {test: row.get(column, "") for test, row in measurements.rows.items()}
            for column in measurements.remarks
        }
        columns = self.workbook.columns_of(measurements.table) if self.workbook else ()
        taken = {}
        for of in (of for of in columns if of.name in wanted):
            path, said = (*measurements.table.place, "taken", of.name), wanted[of.name]
            if not isinstance(said, dict):
                wrong_type(self.toml, self.findings, path, "a table", f"{of.name} = {TAKING}")
                continue
            like = (of, self.toml, self.findings, self.result)
            taken[of.name] = read_taken(said, path, *like, measurements.tests, gone, named)
        known = {name: found for name, found in taken.items() if found}
        self.taken |= known
        if known.keys() != wanted.keys():
            return None
        return measurements.beside(known, [of.name for of in columns])

    def uncertainty(
        self, parameters: dict[str, Printed], given: frozenset[str], measurements: tuple[Measurements, ...]
    ) -> tuple[Stated, dict[str, Printed], tuple[Measurements, ...]]:
        """Read what is stated of columns and parameters, and state it of their numbers."""
        declared = self.workbook.declared if self.workbook else {}
        single = {name: (printed,) for name, printed in parameters.items()}
        every = {name: column for table in measurements for name, column in table.measured.items()}
        numbers = {name: every[name] for name in declared if every.get(name)}
        sheet = partial(self.workbook.sheet, given) if self.workbook else None
        stated = read_uncertainty(self.tables, numbers | single, declared, measurements, self.said, sheet)
        parameters = {name: printed for name, (printed,) in stated.of(single).items()}

        def said(table: Measurements) -> Measurements:
            left_out = tuple(_with(stated, each, table.header_units) for each in table.left_out)
            return replace(table, measured=stated.of(table.measured), left_out=left_out)

        return stated, parameters, tuple(map(said, measurements))

    def take(self, said: Mapping[str, object], of: Declared) -> Printed | None:
        """Take a parameter from the result of another report."""
        path = ("parameters", of.name)
        found = read_taken(said, path, of, self.toml, self.findings, self.result)
        if found is None:
            return None
        self.taken[of.name] = found
        return found.printed[0]

    def result(self, name: str, at: Location) -> Result | None:
        """Open the result of another report, once: what is wrong with it is one problem."""
        if name not in self.results:
            data = self.bytes_of(name, LARGEST_TABLE, at)
            file = self.folder / name
            self.results[name] = None if data is None else open_result(data, file, name, at, self.findings)
        return self.results[name]

    def draws(self, name: str, of: Declared, at: Location) -> tuple[float, ...] | None:
        """Read draws that somebody else made of a parameter."""
        source = self.source(
            name, LARGEST_TABLE, "a first line with names and units, then a row for each draw", at
        )
        return read_draws(source, of, self.findings) if source else None

    def modes(self, of: tuple[str, ...], columns: list[str] | None) -> dict[str, str]:
        """How the columns of a file were shortened, where it was not by rounding."""
        path = (*of, "printed")
        written: Any = self.toml.data
        for key in path:
            written = written[key]
        table = self.tables.keys(
            path, written if columns is None and isinstance(written, dict) else columns or ()
        )
        modes = {}
        for column in table:
            mode = self.tables.text(path, column, "truncated")
            known = (*MODES, *(["up"] if (about := read_about(column)) and about.is_width else []))
            if mode is not None and mode not in known:
                at, nearest = self.toml.value(*path, column), suggest(mode, known)
                self.findings.add("LS208", at, text=mode, known=listing(known), suggestion=nearest)
            elif mode is not None:
                modes[column] = mode
        return modes

    def errata(self, measurements: Sequence[Measurements]) -> dict[tuple[str, int], Printed]:
        """Read what measured cells would have to be printed as: ``"x_p[2]" = "29.8"``."""
        path = ("published", "errata")
        found = {}
        for address in self.tables.table(path, "a table of cells and their prints", '"x_p[2]" = "29.8"'):
            text = self.tables.text(path, address, "29.8")
            place = self.cell(address, measurements, self.toml.key(*path, address))
            if text is None or place is None:
                continue
            of = next(table for table in measurements if place[0] in table.measured)
            printed = of.measured[place[0]][place[1]]
            if printed is None:
                at = self.toml.key(*path, address)
                self.findings.add("LS506", at, name=place[0], text=place[1], known="rows with a number")
                continue
            try:
                found[place] = replace(
                    read_printed(text, parse_unit(printed.unit), mode=printed.mode), stated=printed.stated
                )
            except NumberError as error:
                self.findings.add(error.code, self.toml.value(*path, address), name=address, **error.fields)
        return found

    def cell(
        self, address: str, measurements: Sequence[Measurements], at: Location
    ) -> tuple[str, int] | None:
        """Return column and row of a measured cell, ``x_p[2]``."""
        name, index = parts(address) or (address, "")
        columns = {column: table for table in measurements for column in table.measured}
        tests = list(map(str, columns[name].tests)) if name in columns else []
        if name not in columns:
            hint = suggest(name, columns) or "of a published value say 'differs' in its column 'expect'"
            self.findings.add("LS505", at, text=name, known=listing(columns), suggestion=hint)
        elif index in [str(each.test) for each in columns[name].left_out]:
            pass  # it is misprinted in a row that nothing is computed from
        elif index not in tests:
            self.findings.add("LS506", at, name=name, text=index, known=listing(tests))
        else:
            return name, tests.index(index)
        return None

    def published(self, words: Collection[str] | None) -> tuple[PublishedValue, ...]:
        if "published" not in self.toml.data:
            return ()
        table = self.tables.keys(("published",))
        is_table = isinstance(self.toml.data["published"], dict)
        name = self.tables.text(("published",), "file", required=is_table)
        if name is None or not table:
            return ()
        self.free = self.tables.names("published", "free")
        if by := self.tables.text(("published",), "by"):
            self.by_source = by == _SOURCE
            if not self.by_source:
                at = self.toml.value("published", "by")
                self.findings.add("LS215", at, text=by)
        at = self.toml.value("published", "file")
        source = self.source(name, LARGEST_PUBLISHED, "a first line with the names of the columns", at)
        if source is None:
            return ()
        values = read_published(source, self.findings, words)
        self.empty = None if values else at
        modes = self.modes(("published",), list({v.cell: v for v in values})) if "printed" in table else {}
        return tuple(
            replace(value, printed=replace(value.printed, mode=modes.get(value.cell, "rounded")))
            for value in values
        )


def _named(section: object) -> tuple[RowTable, ...]:
    """The tables that a folder has, where the workbook that should say so is not known."""
    own = fixed("measurements")
    every = section.items() if isinstance(section, dict) else ()
    names = [name for name, said in every if name not in own and isinstance(said, dict)]
    return tuple(map(RowTable, names)) or (RowTable(),)


def _with(said: Stated, test: LeftOut, units: Mapping[str, str]) -> LeftOut:
    """A test that is left out with what is stated of its columns; of what is no number of them, nothing."""
    numbers = {}
    for name, errors in said.columns.items():
        try:
            number = read_printed(test.texts[name], parse_unit(units[name])) if name in test.texts else None
        except NumberError:
            continue
        if number and not any(part.why_not(number) for part in errors.parts):
            numbers[name] = (number,)
    found = {name: number.stated for name, (number,) in said.of(numbers).items()}
    return replace(test, stated={**test.stated, **found})


def _naming(toml: TomlFile, files: Collection[str]) -> Iterator[tuple[str, str, str]]:
    """The places that name files, however TOML spells them: strings, and tables of draws in strings."""
    for path, start, end in toml.strings:
        text = toml.source.text[start:end]
        if path and path[-1] in {"file", "from"}:
            found = [(start, text, tomllib.loads(f"it = {text}")["it"].strip())]
        else:
            draws = re.finditer(r"\bsamples\s*=\s*([^;\"']*[^;\"'\s])", text)
            found = [(start + each.start(1), each[1], each[1]) for each in draws]
        for begin, written, name in found:
            if (name := Path(name).as_posix()) in files:
                yield toml.source.trace(begin), written, name
