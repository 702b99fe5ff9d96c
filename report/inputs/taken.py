"""Numbers that another report has computed, with what their uncertainty comes from.

[parameters]
ball_mass = { from = "balance/values.json", cell = "m" }
[measurements.taken]
x_p = { from = "imprints/values.json", cell = "depth", unit = "um" }

Of each test it is the row of the same word, where both have words of rows, else that of the same number.

Two numbers of one report, or of two reports that rest on a third, share its errors: each keeps the name that
it had where it was stated, and the sha256 of what that report was made from.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import PurePath
from types import MappingProxyType
from typing import TYPE_CHECKING

from ...derivations.unit_text import UnitError, coherent, parse_unit
from ..cells.address import address, index_text, named, parts
from ..distribution import PARTS, Error, Shape
from ..messages.errors import Location, listing, suggest
from ..quantity import Printed
from .expected import row_of
from .folders import output
from .keys import ANY, TABLES
from .number_text import read_unit_of, what_is_allowed
from .parameters import wrong_type
from .spelling import same

if TYPE_CHECKING:
    from pathlib import Path

    from ...derivations.unit_text import ParsedUnit
    from ..files.form import Index
    from ..files.values import Influences, Result, Source
    from ..laws import Law
    from ..messages.errors import Findings
    from .number_text import Declared
    from .tomlfile import TomlFile

    Read = Callable[[str, Location], Result | None]
    Number = tuple[Printed, tuple["TakenError", ...]]

EXAMPLE = '{ from = "balance/values.json", cell = "m" }'
_KEYS = TABLES["parameters", ANY]
_AGAIN = "build that report again, and take what its result tells"
Origin = tuple[str, str]
"""Of an error: the sha256 of the inputs of the report where it was stated, and its name there."""


@dataclass(frozen=True)
class TakenError:
    """What one error of another report does to a number that was taken from it."""

    origin: Origin
    moved: float
    """By its standard uncertainty, in SI, with its sign."""
    error: Error
    """Its shape, degrees of freedom and sample; its width is 1."""


@dataclass(frozen=True)
class Taken:
    """A parameter or a measured column that was taken."""

    file: str
    cell: str
    printed: tuple[Printed, ...]
    """Its numbers, one a row, with all their digits, in SI."""
    errors: tuple[tuple[TakenError, ...], ...]
    """Of each of them."""
    correlations: Mapping[tuple[Origin, Origin], float]
    """By two origins; between errors of that report."""
    spare: Mapping[int, Number] = field(default_factory=dict)
    """The same of tests that take no part, as far as there are such."""
    told: str = ""
    """How its rows were found, where either report knows rows by words; else empty."""
    doubtful: bool = False
    """Whether they may be others than those that are meant, though they have their numbers."""
    doubts: tuple[str, ...] = ()
    """Why their uncertainties may not hold there, each with its cell."""
    made_from: str = ""
    """The sha256 of what that report was made from: the errors that begin there have it."""

    def of(self, rows: Iterable[int]) -> Taken:
        """The same of some rows."""
        chosen = tuple(rows)
        printed, errors = (tuple(self.printed[n] for n in chosen), tuple(self.errors[n] for n in chosen))
        return replace(self, printed=printed, errors=errors)

    def u(self, errors: Iterable[TakenError], only: Collection[Origin]) -> float:
        """The standard uncertainty that some errors make of a number, in SI."""
        some = [error for error in errors if error.origin in only]
        return math.sqrt(_variance(some, self.correlations))


def alone(taken: Mapping[str, Taken], columns: Collection[str]) -> frozenset[Origin]:
    """The errors of what was taken that move numbers of one test alone, of those that take no part, too.

    `columns`: those with a row a test.
    """
    rows: dict[Origin, set[str]] = {}
    for name, column in taken.items():
        spare = ((f"test {test}", errors) for test, (_, errors) in column.spare.items())
        own = ((f"row {row}" if name in columns else "", each) for row, each in enumerate(column.errors))
        for row, errors in (*own, *spare):
            for error in errors:
                rows.setdefault(error.origin, set()).add(row)
    return frozenset(origin for origin, moved in rows.items() if len(moved) == 1 and "" not in moved)


def read_taken(
    said: Mapping[str, object],
    path: tuple[str, ...],
    of: Declared,
    toml: TomlFile,
    findings: Findings,
    read: Read,
    tests: Sequence[int] | None = None,
    spare: Sequence[int] = (),
    words: Mapping[str, Mapping[int, str]] = MappingProxyType({}),
) -> Taken | None:
    """Read what is to be taken; None, with a finding, if it cannot be.

    Parameters
    ----------
    said : mapping of str to object
        What stands in the file at that path.
    of : Declared
        What it shall be.
    read : callable
        Takes the name of a file and where it stands; returns what it holds, or None with a finding.
    tests : sequence of int or None
        Whose rows of a column are taken, in this order; None: one number.
    spare : sequence of int
        The tests that take no part.
    words : mapping of str to mapping of int to str
        The columns of words beside the tests, with the word of each.
    """
    for key in said:
        if key not in _KEYS:
            where, hint = ".".join(path), suggest(key, _KEYS)
            at = toml.key(*path, key)
            findings.add("LS203", at, text=key, table=where, known=listing(_KEYS), suggestion=hint)
            return None
    for key, of_key in _KEYS.items():
        if of_key.required and key not in said:
            findings.add("LS204", toml.key(*path), text=key, table=".".join(path), example=EXAMPLE)
            return None
        if not isinstance(said.get(key, ""), str):
            wrong_type(toml, findings, (*path, key), "text in quotes", EXAMPLE)
            return None
    file, cell, at = str(said["from"]), str(said["cell"]), toml.value(*path, "cell")
    found = read(file, toml.value(*path, "from"))
    if found is None:
        return None
    unit = read_unit_of(str(said.get("unit", of.unit)), of, lambda *_: toml.value(*path, "unit"), findings)
    if unit is None:
        return None
    reader, where = _Reader(found, file, cell, of, unit, at, findings), toml.trace(*path)
    if tests is None:
        rows: Mapping[int, Index] | None = {0: reader.index}
    else:
        rows = reader.rows(tests, spare, words) if reader.column() else None
    numbers = reader.numbers([rows[test] for test in tests or (0,)], where) if rows is not None else None
    if rows is None or numbers is None:
        return None
    printed, errors = zip(*(numbers[rows[test]] for test in tests or (0,)), strict=True)
    gone = reader.spare({test: rows.get(test, ()) for test in spare}, where)
    doubts = tuple(reader.doubts([rows[test] for test in tests or (0,)]))
    own = reader.influences.inputs if reader.influences else ""
    told = reader.told, reader.doubtful, doubts, own
    return Taken(file, cell, printed, errors, reader.correlations, gone, *told)


def open_result(data: bytes, file: Path, name: str, at: Location, findings: Findings) -> Result | None:
    """What a values.json holds; None, with a finding, if it is none, or not as it was built."""
    from ..files.form import Malformed, decoded
    from ..files.manifest import is_as_built
    from ..files.values import Result

    folder = file.parents[len(PurePath(name).parts) - 1]
    known, reason, found = "what 'build' writes", "", None
    if file.parent.resolve() == output(folder).resolve():
        known = "the values.json of another report"
        reason = "is what this report itself was built to: each build would begin with the last one"
    else:
        try:
            found = decoded(data, Result)
        except Malformed as error:
            reason = f"is no values.json: {error}"
        else:
            if not is_as_built(file, data):
                reason = "was changed after it was built: the manifest beside it has another fingerprint"
    if reason:
        findings.add("LS437", at, reason=reason, file=name, known=known, suggestion=_AGAIN)
        return None
    return found


class _Reader:
    """Reads cells of one column of another report."""

    def __init__(
        self,
        found: Result,
        file: str,
        cell: str,
        of: Declared,
        shown: ParsedUnit,
        at: Location,
        findings: Findings,
    ) -> None:
        from msgspec import UNSET

        self.found, self.file, self.cell, self.of, self.shown = found, file, cell, of, shown
        self.at, self.findings = at, findings
        self.influences = None if found.influences is UNSET else found.influences
        self.correlations = _correlations(self.influences) if self.influences else {}
        name, word = parts(cell) or ("", "")
        self.name, self.index = named(cell, row_of(word, found.known(name)))
        self.words, self.told, self.doubtful = found.known(self.name), "", False
        column = found.cells.get(self.name)
        self.unit = column.unit if column else ""
        self.cells = column.cells if column else {}

    def numbers(self, labels: Sequence[Index], where: str) -> Mapping[Index, Number] | None:
        """The numbers of some rows with their errors; None, with findings, if one of them cannot be taken."""
        before = len(self.findings.found)
        for check in (self.has, self.converts, self.allows, self.tells):
            check(labels)
            if len(self.findings.found) > before:
                return None
        return {label: self.number(label, where) for label in labels}

    def spare(self, rows: Mapping[int, Index], where: str) -> dict[int, Number]:
        """The numbers of tests that take no part, as far as there are such; numbers were taken before."""
        values = {test: self.cells.get(row, (None, ""))[0] for test, row in rows.items()}
        known = (test for test, value in values.items() if value is not None and self.of.bounds.allow(value))
        return {test: self.number(rows[test], where) for test in known if self.moved(rows[test]) is not None}

    def rows(
        self, tests: Sequence[int], spare: Sequence[int], words: Mapping[str, Mapping[int, str]]
    ) -> Mapping[int, Index] | None:
        """The row of each test, of those that take no part, too: None, with a finding, if one has none.

        It is that of its word, where both reports know rows by words, else that of its number.
        """
        by_word = {same(word): row for row, word in self.words.items() if word}
        unique = len(by_word) == len(self.words)
        for column in words.values() if unique else ():
            if by_word.keys().isdisjoint(map(same, column.values())):
                continue  # what else is said of rows
            missing = dict.fromkeys(column[test] for test in tests if same(column[test]) not in by_word)
            if missing:
                known = f"the rows {listing(self.words.values())}"
                self.refuse(f"has no {listing(f'{self.name}[{word}]' for word in missing)}", known)
                return None
            rows = {test: by_word[same(word)] for test, word in column.items() if same(word) in by_word}
            self.told = f"of each row that of its word in {self.file}"
            if others := [
                f"{test} is {address(self.name, row)}" for test, row in rows.items() if (test,) != row
            ]:
                more = ", ..." * (len(others) > 3)
                self.told += f", whatever the numbers: {', '.join(others[:3])}{more}"
            return rows
        if self.words or any(map(any, (column.values() for column in words.values()))):
            there = listing(self.words.values()) if self.words else "nothing but numbers"
            self.told = f"of each row that of its number in {self.file}, where rows are called {there}"
            self.doubtful = True
        return {test: (test,) for test in (*tests, *spare)}

    def column(self) -> bool:
        """Whether what is named is a column with a row a test."""
        rows = [name for name, column in self.found.cells.items() if {*map(len, column.cells)} == {1}]
        if self.index or self.name not in rows:
            self.unknown(rows)
        return not self.index and self.name in rows

    def has(self, labels: Iterable[Index]) -> None:
        """Find the rows that there are not, and those without a value."""
        there = [index_text(label) for label, (value, _) in self.cells.items() if label and value is not None]
        known = f"the rows {listing(there)}" if there else "a cell with a value"
        missing = [label for label in labels if label not in self.cells]
        if missing == [self.index]:  # the one cell that is asked for
            self.unknown(list(self.found.cells))
        elif missing:
            self.refuse(f"has no {listing(address(self.name, label) for label in missing)}", known)
        for label in labels:
            value, status = self.cells.get(label, (None, ""))
            if value is None and status:
                self.refuse(f"has no value of {address(self.name, label)}: {status}", known)

    def converts(self, _: Iterable[Index]) -> None:
        """Find a unit that is not the one that is wanted: what is in SI needs no conversion."""
        wanted = parse_unit(self.of.unit)
        try:
            unit = parse_unit(self.unit)
        except UnitError:
            unit = None
        if unit is None or unit.dimension != wanted.dimension or not unit.is_si:
            name, own = self.of.name, coherent(wanted)
            self.findings.add("LS422", self.at, name=name, text=self.unit, unit=own, known=own, suggestion="")

    def allows(self, labels: Iterable[Index]) -> None:
        """Find values that the quantity cannot have."""
        for label in labels:
            value, name = self.value(label), address(self.of.name, () if label == self.index else label)
            if not self.of.bounds.allow(value):
                words = {"text": repr(value), "unit": coherent(parse_unit(self.of.unit))}
                self.findings.add("LS406", self.at, name=name, **words, **what_is_allowed(self.of, value))

    def tells(self, labels: Sequence[Index]) -> None:
        """Find numbers of which nobody knows what their uncertainty comes from."""
        if silent := [address(self.name, label) for label in labels if self.moved(label) is None]:
            told = self.influences.known if self.influences else ()
            known = listing(told) or "a file that tells of influences"
            whose = self.cell if len(silent) == len(labels) else listing(silent)
            again = (
                "take one of these: a report by a workbook that ships tells of no other cells"
                if told
                else _AGAIN
            )
            self.refuse(f"does not tell where the uncertainty of {whose} comes from", known, again)

    def number(self, label: Index, where: str) -> Number:
        """A number that can be taken, and its errors."""
        errors, value = tuple(self.errors(label)), self.value(label)
        u = math.sqrt(_variance(errors, self.correlations))
        said = f"from {self.file}, {address(self.name, label)}"
        stated, unit, exact = (Error(Fraction(u), Shape.NORMAL, said=said),), self.shown, Fraction(value)
        text = repr(float((exact - unit.zero) / unit.scale))
        return Printed(text, unit.text, exact, unit.scale, "rounded", stated, where, unit.zero), errors

    def errors(self, label: Index) -> Iterator[TakenError]:
        """What moves the cell, and what no source tells of: the part of second order."""
        found, cell = self.influences, address(self.name, label)
        if found is None:
            return
        for place, moved in self.moved(label) or ():
            source = found.sources[place]
            sample = source.sample and (
                source.sample if source.report else f"{found.inputs}: {source.sample}"
            )
            dof, (shape, law) = math.inf if source.dof is None else source.dof, _shape(source)
            error = Error(Fraction(1), shape, dof, "", sample, law)
            yield TakenError(_origin(found, source), moved, error)
        if rest := found.second.get(cell, 0.0):
            yield TakenError((found.inputs, f"second order of {cell}"), rest, Error(Fraction(1)))

    def doubts(self, labels: Sequence[Index]) -> Iterator[str]:
        """Why the uncertainties of some rows may not hold."""
        known = self.influences.doubts if self.influences else {}
        cells = (address(self.name, label) for label in labels)
        yield from (f"{cell}: {known[cell]}" for cell in cells if cell in known)

    def value(self, label: Index) -> float:
        return float(self.cells[label][0] or 0.0)

    def moved(self, label: Index) -> Sequence[tuple[int, float]] | None:
        return self.influences.of(address(self.name, label)) if self.influences else None

    def unknown(self, known: Sequence[str]) -> None:
        """Find that there is no such cell."""
        words = {"known": listing(known) or "none of a row a test", "suggestion": suggest(self.cell, known)}
        self.findings.add("LS505", self.at, text=self.cell, **words)

    def refuse(self, reason: str, known: str, suggestion: str = _AGAIN) -> None:
        words = {"reason": reason, "known": known, "suggestion": suggestion}
        self.findings.add("LS437", self.at, file=self.file, **words)


def _shape(source: Source) -> tuple[Shape, Law | None]:
    """The shape of an error, and its law; draws come as a normal error of their standard uncertainty."""
    from msgspec import UNSET

    from ..laws import Exponential, TruncatedNormal  # which imports NumPy

    known = {shape.value: shape for shape in Shape}
    shape = known.get(source.distribution, Shape.NORMAL)
    if shape is Shape.EXPONENTIAL:
        return shape, Exponential()
    if shape is Shape.TRUNCATED and source.ends is not UNSET:  # either side of the number, by its form
        low, high = source.ends
        return shape, TruncatedNormal(-math.inf if low is None else low, math.inf if high is None else high)
    return (shape if shape is Shape.STUDENT or shape in PARTS else Shape.NORMAL), None


def _origin(found: Influences, source: Source) -> Origin:
    return (source.report or found.inputs, source.name)


def _correlations(found: Influences) -> dict[tuple[Origin, Origin], float]:
    origins = [_origin(found, source) for source in found.sources]
    return {(origins[a], origins[b]): r for a, b, r in found.correlations}


def _variance(errors: Sequence[TakenError], correlations: Mapping[tuple[Origin, Origin], float]) -> float:
    moved = {error.origin: error.moved for error in errors}
    both = sum(2 * r * moved.get(a, 0.0) * moved.get(b, 0.0) for (a, b), r in correlations.items())
    return max(0.0, math.fsum(each**2 for each in moved.values()) + both)
