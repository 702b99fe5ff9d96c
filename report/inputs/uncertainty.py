"""The section ``[uncertainty]`` of report.toml: what is stated of whole columns, and what errors share.

[uncertainty]
plus_minus = "rect"                      # what +-0.1 means where nothing is said
digits = 1                               # of uncertainties that are shown; 2, if nothing is said
x_p = "0.5 % of reading + 2 digits"

paired = ["V", "I", "phi"]               # repeated readings, together in each row: they scatter, correlated

[uncertainty.shared."height datum"]      # one error, the same in every test
of = "x_p"
stated = "+-0.2 um rect"
groups = [[1, 2], [3, 4]]                # or the same in the tests of a group, or of a word: "height"

[uncertainty.correlation]
"v, e" = "0.3"                           # of the errors of one test
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Any, TypeVar

from ...derivations.unit_text import parse_unit
from ..distribution import SCATTER
from ..messages.errors import listing, suggest
from ..quantity import there
from ..sheet import Given, SheetError
from ..workbook import Measured
from .keys import ANY, fixed
from .number_text import NumberError, read_number
from .parameters import wrong_type
from .readings import correlations_of, read_paired
from .stated import SHAPES, Conventions, Of, StatedErrors, StatementError, read_statement

if TYPE_CHECKING:
    from ..distribution import Error, Shape
    from ..messages.errors import Location
    from ..quantity import Printed
    from ..sheet import Sheet
    from .measurements import Measurements
    from .number_text import Declared
    from .tables import TomlTables

SECTION = "uncertainty"
DIGITS = (1, 2)
"""How many digits an uncertainty may have: more would say nothing (JCGM 100, 7.2.6)."""
Numbers = Mapping[str, tuple["Printed | None", ...]]
One = TypeVar("One", "Printed", "Printed | None")


@dataclass(frozen=True)
class SharedError:
    """One error of many cells: of all of a column or of several, or of those of a group."""

    name: str
    """What it is, in the words of the file."""
    statements: Mapping[str, StatedErrors]
    """By column; what is a share of the value is a scale error, and larger for a larger value."""
    groups: tuple[tuple[int, ...], ...] = ()
    """The tests of each group; none: all tests are one. A test of no group has no such error, and one that is
    left out counts for nothing."""

    def error(self, of: str, printed: Printed) -> Error:
        """What it is for a number of a column."""
        return self.statements[of].of(printed, self.name)[0]

    def sign(self, of: str, printed: Printed) -> int:
        """Which way it moves a number: a gain moves -5 V down where it moves 5 V up."""
        (part,) = self.statements[of].parts
        return -1 if part.scales and printed.value < 0 else 1


@dataclass(frozen=True)
class Stated:
    """What the section says."""

    columns: Mapping[str, StatedErrors]
    """Of measured columns and of parameters."""
    shared: tuple[SharedError, ...] = ()
    correlations: Mapping[tuple[str, str], float] = field(default_factory=dict)
    """By (str, str); between the errors of two columns in the same test, or of two parameters."""
    paired: tuple[str, ...] = ()
    """The columns whose numbers are repeated readings that were taken together, a row each: all of it is one
    sample."""
    digits: int = DIGITS[-1]
    """Of an uncertainty that is shown: from these follow those of its value."""

    def of(self, numbers: Mapping[str, tuple[One, ...]]) -> dict[str, tuple[One, ...]]:
        """Numbers with what is stated of them."""
        together = dict.fromkeys(self.paired, ", ".join(self.paired))

        def said(name: str, each: One) -> One:
            return each and replace(each, stated=self.columns[name].of(each, together.get(name, name)))

        return {
            name: tuple(said(name, each) for each in column) if name in self.columns else column
            for name, column in numbers.items()
        }

    def is_of_readings(self, name: str) -> bool:
        """Whether what is stated of a column follows from how its numbers scatter, all of them together."""
        return name in self.columns and any(part.said == SCATTER for part in self.columns[name].parts)

    @staticmethod
    @lru_cache(maxsize=256)  # a workbook asks it of every row
    def again(said: str, unit: str, shape: Shape) -> StatedErrors | None:
        """What the text behind a number says; None if it is no statement that stands alone."""
        try:
            return read_statement(said, parse_unit(unit), shape)
        except StatementError:
            return None


def read_bare(tables: TomlTables) -> Shape | None:
    """What limits without a word mean, here and behind the numbers of parameters; None: it is not said."""
    word = tables.text((SECTION,), "plus_minus")
    words = [word for word, shape in SHAPES.items() if shape != "normal"]
    if word is None or word in words:
        return SHAPES[word] if word else None
    at, known = tables.toml.value(SECTION, "plus_minus"), listing(words)
    tables.findings.add("LS217", at, text=word, known=known, suggestion=suggest(word, words))
    return None


def read_uncertainty(
    tables: TomlTables,
    numbers: Numbers,
    declared: Mapping[str, Declared],
    measured: Sequence[Measurements],
    said: Conventions,
    sheet: Callable[[], Sheet] | None,
) -> Stated:
    """Read the section; what is wrong with it is told where it stands.

    Parameters
    ----------
    tables : TomlTables
        Of report.toml.
    numbers : mapping of str to tuple of Printed or None
        What was given, by column and parameter; None where a cell is empty.
    declared : mapping of str to Declared
        What the workbook says of them.
    measured : sequence of Measurements
        The tables of rows: a word in one may say which of its rows share an error.
    said : Conventions
        What the folder says of all uncertainties.
    sheet : callable or None
        Returns the columns of the workbook: of one that is computed nothing can be stated.
    """
    reader = _Reader(tables, numbers, declared, measured, said)
    written = tables.keys((SECTION,), numbers, why_not=lambda key: reader.of_computed(key, sheet))
    paired = read_paired(tables, SECTION, numbers, measured) if "paired" in written else ()
    columns = {name: reader.column(name) for name in written if name in numbers}
    columns |= {name: reader.of_readings(name, name in columns) for name in paired}
    shared = [reader.shared(name) for name in reader.names("shared")]
    own = {name: found for name, found in columns.items() if found is not None}
    several = {name for name, found in own.items() if len(found.parts) != 1 or found.parts[0].table}
    several |= set(said.taken) | {
        name for name, column in numbers.items() if not all(map(_is_one, there(column)))
    }
    correlations = reader.possible(dict(reader.correlations(several, paired)))
    if paired and not tables.findings.found:
        correlations |= correlations_of({name: there(numbers[name]) for name in paired})
    known = tuple(found for found in shared if found is not None)
    return Stated(own, known, correlations, paired, reader.digits())


def _is_one(number: Printed) -> bool:
    """Whether a number has one error by itself, as far as it says."""
    return number.stated is None or (len(number.stated) == 1 and not number.stated[0].table)


class _Reader:
    """Reads one section."""

    def __init__(
        self,
        tables: TomlTables,
        numbers: Numbers,
        declared: Mapping[str, Declared],
        measured: Sequence[Measurements],
        said: Conventions,
    ) -> None:
        self.tables, self.declared = tables, declared
        self.of_rows = {name: table for table in measured for name in table.measured}
        self.numbers = {name: there(column) for name, column in numbers.items()}
        self.rows = {name: len(column) for name, column in numbers.items()}
        self.said = said
        self.findings, self.toml = tables.findings, tables.toml

    def digits(self) -> int:
        """How many digits of an uncertainty are shown."""
        section: Any = self.toml.data.get(SECTION, {})
        wanted = section.get("digits", DIGITS[-1]) if isinstance(section, dict) else DIGITS[-1]
        if type(wanted) is int and wanted in DIGITS:
            return wanted
        self.findings.add("LS435", self.toml.value(SECTION, "digits"))
        return DIGITS[-1]

    def names(self, table: str) -> tuple[str, ...]:
        """The keys of a table of the section, whatever they are."""
        example = f"[{SECTION}.{table}]"
        return tuple(self.tables.table((SECTION, table), f"a table {example}", example))

    def statement(self, path: tuple[str, ...], of: str) -> StatedErrors | None:
        """What a text says of a column, whose unit is that of what has none."""
        text = self.tables.text(path[:-1], path[-1], "U = 0.03, k = 2", required=True)
        if text is None:
            return None
        if hint := self._why_not(of, text):
            self.findings.add("LS431", self.toml.value(*path), text=text, suggestion=hint)
            return None
        try:
            own = self.of(of, self.toml.value(*path)) if len(path) == 2 else Of()
            return read_statement(text, parse_unit(self.numbers[of][0].unit), self.said.bare, own)
        except StatementError as error:
            at = self.toml.value(*path, start=error.start, length=max(len(error.text), 1))
            self.findings.add(error.code, at, text=error.text, suggestion=error.suggestion)
            return None

    def _why_not(self, of: str, text: str) -> str:
        """Why a text cannot be said of a column, whatever its numbers are; empty if it can."""
        declared = self.declared[of]
        if declared.bounds.integer:
            return f"{of} is a whole number that the method counts with: it has none"
        if isinstance(declared, Measured) and declared.scatter and SCATTER in map(str.strip, text.split(";")):
            return (
                f"a model is fitted to {of}, which scatters about a curve and not about its mean: "
                f"{declared.scatter} tells how much; state that as u = ..., dof = rows less parameters"
            )
        return ""

    def of(self, name: str, at: Location) -> Of:
        """A column or a parameter, as what something is stated of."""
        numbers, declared, read = self.numbers[name], self.declared[name], self.said.draws
        if read is None or self.rows[name] != 1:
            return Of(numbers, declared.bounds)
        return Of(numbers, declared.bounds, lambda table: read(table, declared, at))

    def of_computed(self, name: str, sheet: Callable[[], Sheet] | None) -> str:
        """What to state in the place of the uncertainty of a computed column; nothing of what is none."""
        if sheet is None:
            return ""
        try:
            columns = sheet()
        except (SheetError, TypeError):  # which is told where the workbook is laid out
            return ""
        if name not in columns or isinstance(columns[name].rule, Given):
            return ""
        rests = [
            each.name
            for each in columns.ancestors(columns[name])
            if not each.exact and any(p.stated != () for p in self.numbers.get(each.name, ()))
        ]
        if not rests:
            return f"{name} is computed from what is exact"
        hint = (
            f"{name} is computed: its uncertainty follows from what is stated of {listing(rests, last='and')}"
        )
        tables = {id(self.of_rows[each]): self.of_rows[each] for each in rests if each in self.of_rows}
        if SCATTER not in str(self.toml.data[SECTION][name]) or len(tables) != 1:
            return hint
        readings = [each for each in rests if each in self.of_rows]
        if len(readings) == 1:
            return f'{hint}; for repeated readings: {readings[0]} = "{SCATTER}"'
        paired = ", ".join(f'"{each}"' for each in readings)
        return f"{hint}; for repeated readings that were taken together: paired = [{paired}]"

    def column(self, name: str) -> StatedErrors | None:
        """What is said of a column or a parameter, which says nothing itself."""
        beside = next((number for number in self.numbers[name] if number.stated is not None), None)
        if beside is not None:
            where = next((error.where for error in beside.stated or () if error.where), beside.where)
            hint = "leave out what stands in [uncertainty], or what stands beside the numbers"
            hint += f" ({where})" if where else ""
            self.findings.add("LS433", self.toml.key(SECTION, name), name=name, suggestion=hint)
            return None
        return self.statement((SECTION, name), name)

    def of_readings(self, name: str, is_stated: bool) -> StatedErrors | None:
        """What paired readings say of a column, of which nothing else is said."""
        if is_stated or any(number.stated is not None for number in self.numbers[name]):
            hint = f"'paired' says that {name} scatters; what its rows share stands in [uncertainty.shared]"
            at = self.toml.value(SECTION, "paired")
            self.findings.add("LS433", at, name=name, suggestion=hint)
            return None
        return read_statement(SCATTER, parse_unit("1"), of=Of(self.numbers[name]))

    def shared(self, name: str) -> SharedError | None:
        """An error that cells share."""
        path = (SECTION, "shared", name)
        written = self.tables.keys(path, fixed(SECTION, "shared", ANY))
        if isinstance(written.get("of"), list):
            of = [*self.tables.names(*path, "of")]
            if not written["of"]:
                wrong_type(self.toml, self.findings, (*path, "of"), "the names of columns", 'of = ["v", "e"]')
        else:
            text = self.tables.text(path, "of", next(iter(self.numbers), "x_p"), required=True)
            of = [] if text is None else [text]
        for unknown in (each for each in of if each not in self.numbers):
            known, suggestion = listing(self.numbers), suggest(unknown, self.numbers)
            at = self.toml.value(*path, "of")
            self.findings.add("LS505", at, text=unknown, known=known, suggestion=suggestion)
            return None
        statements = {each: said for each in of if (said := self.statement((*path, "stated"), each))}
        groups = self.groups_of(path, of) if of and "groups" in written else ()
        if len(statements) < len(of) or not of or groups is None:
            return None
        if any(len(said.parts) != 1 for said in statements.values()):
            at, hint = self.toml.value(*path, "stated"), "each error that is shared has a table of its own"
            self.findings.add("LS431", at, text=self.tables.text(path, "stated", ""), suggestion=hint)
            return None
        return SharedError(name, statements, groups)

    def groups_of(self, path: tuple[str, ...], of: Sequence[str]) -> tuple[tuple[int, ...], ...] | None:
        """The groups in the rows of columns, which have to be the same rows; None, with a finding, if not."""
        why = next((f"{each} is one number" for each in of if each not in self.of_rows), "")
        if not why and len({id(self.of_rows[each]) for each in of}) > 1:
            why = f"{listing(of)} are of different rows"
        if why:
            at, known = self.toml.key(*path, "groups"), f"no groups: {why}"
            self.findings.add("LS506", at, name=of[0], text="groups", known=known)
            return None
        return self.groups((*path, "groups"), self.of_rows[of[0]].rows)

    def groups(
        self, path: tuple[str, ...], rows: Mapping[int, Mapping[str, str]]
    ) -> tuple[tuple[int, ...], ...] | None:
        """Lists of tests, of which none stands in two; or those that have the same word in a column."""
        written: Any = self.toml.data
        for key in path:
            written = written[key]
        if isinstance(written, str):
            return self.of_words(path, written, rows)
        lists = isinstance(written, list) and all(isinstance(group, list) and group for group in written)
        if not written or not lists or not all(type(test) is int for group in written for test in group):
            example = "groups = [[1, 2], [3, 4]]"
            wanted = "a list of lists of tests, or the name of a column of words"
            wrong_type(self.toml, self.findings, path, wanted, example)
            return None
        seen: set[int] = set()
        for test in (test for group in written for test in group):
            if test in seen:
                hint = "a row has one error of this name: it stands in one group"
                self.findings.add("LS433", self.toml.value(*path), name=f"{test} in groups", suggestion=hint)
                return None
            if test not in rows:
                known = listing(map(str, rows)) + ", each once"
                self.findings.add("LS506", self.toml.value(*path), name="groups", text=test, known=known)
                return None
            seen.add(test)
        return tuple(map(tuple, written))

    def of_words(
        self, path: tuple[str, ...], column: str, rows: Mapping[int, Mapping[str, str]]
    ) -> tuple[tuple[int, ...], ...] | None:
        """The tests of each word of a column; where there is none, a test is of no group."""
        columns = next(iter(rows.values()))
        if column not in columns:
            lists = "a list of lists of tests: the table has no column of words"
            known = f"a column of the table: {listing(columns)}" if columns else lists
            like = suggest(column, columns)
            self.findings.add("LS303", self.toml.value(*path), text=column, known=known, suggestion=like)
            return None
        found: dict[str, list[int]] = {}
        for test, row in rows.items():
            found.setdefault(row[column], []).append(test)
        return tuple(tuple(tests) for word, tests in found.items() if word)

    def correlations(
        self, several: Collection[str], paired: Collection[str]
    ) -> Iterator[tuple[tuple[str, str], Fraction]]:
        """Coefficients by the names of two columns; one of 0 says nothing."""
        seen: set[frozenset[str]] = set()
        for key in self.names("correlation"):
            path = (SECTION, "correlation", key)
            text = self.tables.text(path[:-1], key, "0.3")
            pair = tuple(re.split(r"\s*,\s*", key.strip()))
            if text is None:
                continue
            if len(pair) == 2 and pair[0] == pair[1] and pair[0] in self.numbers:
                reason = f"{pair[0]} is correlated with itself anyway: name two columns"
                self.findings.add("LS434", self.toml.key(*path), reason=reason, suggestion="")
                continue
            wrong = [name for name in pair if name not in self.numbers]
            if len(pair) != 2 or wrong:
                known = f"two of {listing(self.numbers)} with a comma between them"
                text = wrong[0] if len(pair) == 2 else key
                self.findings.add("LS505", self.toml.key(*path), text=text, known=known, suggestion="")
                continue
            if frozenset(pair) in seen:
                both = " and ".join(pair)
                self.findings.add("LS433", self.toml.key(*path), name=f"{both} together", suggestion="")
                continue
            seen.add(frozenset(pair))
            if reason := self.why_not(text, pair, several, paired):
                self.findings.add("LS434", self.toml.value(*path), reason=reason, suggestion="")
                continue
            if float(number := read_number(text)):
                yield (pair[0], pair[1]), number

    def why_not(
        self, text: str, pair: Collection[str], several: Collection[str], paired: Collection[str]
    ) -> str:
        """Why a coefficient cannot be; empty if it can."""
        try:
            if not -1 <= read_number(text) <= 1:
                raise NumberError("LS434")
        except NumberError:
            return f"'{text}' is no correlation coefficient"
        tables = {self.of_rows[name].name for name in pair if name in self.of_rows}
        if len({self.rows[name] for name in pair}) != 1 or len(tables) > 1:
            return f"{' and '.join(pair)} have not the same rows"
        if odd := [name for name in pair if name in several]:
            return f"the numbers of {odd[0]} have not one error each"
        if odd := [name for name in pair if name in paired]:
            return f"what {odd[0]} correlates with follows from its paired readings"
        return ""

    def possible(self, found: dict[tuple[str, str], Fraction]) -> dict[tuple[str, str], float]:
        """Coefficients if they can hold together: then no combination has a negative variance.

        It is asked of them as they are written: 0.6 and 0.8 as doubles are a little more.
        """
        names = sorted({name for pair in found for name in pair})
        coefficients = {frozenset(pair): r for pair, r in found.items()}

        def hold(names: Sequence[str]) -> bool:
            return _is_covariance([
                [Fraction(1) if a == b else coefficients.get(frozenset((a, b)), Fraction(0)) for b in names]
                for a in names
            ])  # fmt: skip

        if hold(names):
            return {pair: float(r) for pair, r in found.items()}
        for name in names.copy():  # those alone without which the others could
            if not hold(others := [each for each in names if each != name]):
                names = others
        reason = f"these correlations of {listing(names, last='and')} cannot hold together"
        self.findings.add("LS434", self.toml.key(SECTION, "correlation"), reason=reason, suggestion="")
        return {}


def _is_covariance(matrix: list[list[Fraction]]) -> bool:
    """Whether a symmetric matrix has no negative eigenvalue, by elimination, exactly."""
    if not matrix:
        return True
    (pivot, *row), rest = matrix[0], [line[1:] for line in matrix[1:]]
    if pivot < 0 or (pivot == 0 and any(row)):
        return False
    if pivot:
        rest = [
            [a - x * y / pivot for a, y in zip(line, row, strict=True)]
            for line, x in zip(rest, row, strict=True)
        ]
    return _is_covariance(rest)
