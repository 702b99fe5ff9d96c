"""A workbook as cells: where every quantity stands, and the formula that is in each of its cells.

The Excel engine makes it, the workbook view draws it; neither knows the other.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, partial
from typing import NamedTuple

from ..charts import Drawn
from ..quantity import Bounds
from ..sheet import Axis

FIRST_ROW = 7
"""The row, from 0, of the first cell below the header of an axis' worksheet."""
LONGEST = 8000
"""Characters of a formula; Excel takes 8192, and cannot open a file that has more."""
SCALARS = "report"
"""The worksheet of the scalars."""
CHECKED = 6
"""Its column, from 0, of what is given where it is allowed."""
TOP = 5
"""The row of its first cell."""
MOST_RESULTS = 50
"""Rows of a result that are shown there, too; of more, nobody reads them twice."""
STEPS = "steps"
"""The worksheet of the steps to a scalar root."""
SLOPES = "derivatives"
"""The worksheet of derivatives that are one number."""
BUDGETS = "uncertainty"
"""The worksheet of budgets."""


_READ = 15
"""Digits of a number that every spreadsheet reads."""


def letters(column: int) -> str:
    """The letters of a column that is counted from 0.

    >>> letters(0), letters(25), letters(26), letters(16383)
    ('A', 'Z', 'AA', 'XFD')
    """
    text = ""
    column += 1
    while column:
        column, rest = divmod(column - 1, 26)
        text = chr(ord("A") + rest) + text
    return text


def factors(scale: Fraction) -> tuple[str, str]:
    """What turns a cell's number into SI, and SI into a cell's number, in whole numbers.

    Spreadsheets read 15 digits of a number: one that has more is a quotient that is nearer than doubles are.

    >>> factors(Fraction(1, 1000000)), factors(Fraction(127, 5000)), factors(Fraction(1))
    (('/1000000', '*1000000'), ('*127/5000', '*5000/127'), ('', ''))
    """
    power, digits = Fraction(10) ** (len(str(scale.numerator)) - len(str(scale.denominator))), _READ
    near = scale
    while max(len(str(number).rstrip("0")) for number in near.as_integer_ratio()) > _READ:
        digits -= 1
        near = (scale / power).limit_denominator(10**digits) * power
    above, below = near.numerator, near.denominator
    up, down = (f"*{above}" if above > 1 else ""), (f"/{below}" if below > 1 else "")
    back = (f"*{below}" if below > 1 else "") + (f"/{above}" if above > 1 else "")
    return up + down, back


def _term(number: Fraction) -> str:
    """What is added, with its sign; nothing of zero."""
    below = f"/{number.denominator}" if number.denominator > 1 else ""
    return f"{number.numerator:+}{below}" if number else ""


def checked(name: str) -> str:
    """What the cells are called that hold a given column where it is allowed, and a code where it is not.

    All formulas name these: what is pasted, filled down or put in by a program is seen by no other check.

    >>> checked("x_p")
    'x_p checked'
    """
    return f"{name} checked"


def as_issued(name: str) -> str:
    """What the cells are called that keep a given column as it was when the workbook was made."""
    return f"{name} as issued"


@dataclass(frozen=True)
class Place:
    """Where the cells of a quantity stand, one below the other."""

    worksheet: str
    row: int
    column: int
    """`row` and `column`: the first cell, from 0."""
    rows: int = 1
    """How many cells."""
    scale: Fraction = Fraction(1)
    """The unit of the cells, in SI."""
    zero: Fraction = Fraction(0)
    """Its zero, in SI."""

    def to_si(self, number: str) -> str:
        """The formula of a number of that unit, in SI; as a factor."""
        said = number + factors(self.scale)[0] + _term(self.zero)
        return number if said == number else f"({said})"

    def from_si(self, value: str) -> str:
        """The formula of a value in SI, a factor itself, as a number of that unit."""
        return (f"({value}{_term(-self.zero)})" if self.zero else value) + factors(self.scale)[1]

    def of(self, value: float) -> float:
        """A value in SI as a number of that unit, without digits that a zero taken off would make up.

        >>> Place("report", 1, 1, zero=Fraction("273.15")).of(273.16)
        0.01
        """
        if self.zero and math.isfinite(value):
            return float((Fraction(repr(float(value))) - self.zero) / self.scale)
        return value / float(self.scale)

    def cell(self, row: int = 0, seen_from: str = "") -> str:
        """The absolute address of a cell, with its worksheet unless it is seen from there."""
        return f"{self._prefix(seen_from)}${letters(self.column)}${self.row + row + 1}"

    def moving(self, row: int = 0, seen_from: str = "") -> str:
        """The address of a cell whose row moves where a formula is filled down."""
        return f"{self._prefix(seen_from)}${letters(self.column)}{self.row + row + 1}"

    def cells(self, rows: Iterable[int], seen_from: str = "") -> list[str]:
        """The absolute addresses of many cells."""
        column = f"{self._prefix(seen_from)}${letters(self.column)}$"
        return [f"{column}{self.row + row + 1}" for row in rows]

    def range(self, seen_from: str = "", first: int = 0, rows: int | None = None) -> str:
        """The absolute address of all its cells, or of a stretch of them."""
        column, last = letters(self.column), self.row + first + (self.rows if rows is None else rows)
        return f"{self._prefix(seen_from)}${column}${self.row + first + 1}:${column}${last}"

    def _prefix(self, seen_from: str) -> str:
        return "" if seen_from == self.worksheet else f"{quoted(self.worksheet)}!"


def quoted(worksheet: str) -> str:
    """A worksheet's name as formulas write it; in quotes if it could be read as something else.

    >>> quoted("tests"), quoted("C"), quoted("my pairs")
    ('tests', "'C'", "'my pairs'")
    """
    plain = (
        len(worksheet) > 3
        and worksheet.isascii()
        and worksheet.isalpha()
        and worksheet.upper() not in ("TRUE", "FALSE")
    )
    return worksheet if plain else "'" + worksheet.replace("'", "''") + "'"


class Grouped(NamedTuple):
    """The words by which rows stand in groups: sums go by the rows as issued, whatever is sorted since."""

    own: Place
    group: Place
    """`own` and `group`: the words beside the rows, and beside the groups."""
    rows: tuple[int, ...]
    """Of each row, the row of its group."""

    @staticmethod
    def same(own: str, group: str) -> str:
        """The formula, without its equals sign, that says whether two cells hold the same word."""
        return f"EXACT({own},{group})"


class Product(NamedTuple):
    """What is added to the derivative of a result by a given cell: one block, or two."""

    first: str
    """The block whose row is that of the result, or of the given cell if there is no other."""
    then: str = ""
    """The block whose row is that of the given cell."""
    named: str | None = None
    """Of a column of results, how the row of one names the given cell; empty for the same row."""
    rows: str = ""
    """Where the row of the given cell names that of a result, its group: the axis of the former."""


class FilledDown(NamedTuple):
    """A formula, filled down over so many rows: rows without a ``$`` move with the row that they stand in."""

    rows: int
    first: str
    """The formula of the first of them, beginning with ``=``."""

    def formulas(self) -> list[str]:
        """The formula of each row.

        >>> FilledDown(2, "=IF('a $B1'!$A$7>$B9,$B9,0)").formulas()
        ["=IF('a $B1'!$A$7>$B9,$B9,0)", "=IF('a $B1'!$A$7>$B10,$B10,0)"]
        """
        return [_ADDRESSES.sub(partial(_moved, down), self.first) for down in range(self.rows)]


_ADDRESSES = re.compile(r"""'[^']*'|"[^"]*"|(\$[A-Z]+)([0-9]+)""")
"""What is in quotes, or the address of a cell in a row that moves."""


def _moved(down: int, found: re.Match[str]) -> str:
    column, row = found.groups()
    return f"{column}{int(row) + down}" if column else found[0]


@dataclass(frozen=True)
class CellBlock:
    """The cells of one quantity."""

    name: str
    """The column's name; for a cell on the way to a root the column's, a dot and its own."""
    kind: str
    """``index`` (the numbers of rows), ``given``, ``checked`` (what is given, if it is allowed),
    ``computed``, ``carried`` (another axis' cells, repeated on this one), ``step`` (on the way to a root),
    ``margin`` (how far inside of a limit another's cells lie), ``drawn`` (for a chart) or ``slope`` (a
    derivative of a result, or what is needed for it)."""
    title: str
    meaning: str
    """`title` and `meaning`: what stands above or beside its cells."""
    place: Place
    filled: tuple[FilledDown, ...] = ()
    """The formulas of the cells, from top to bottom; none if the cells hold values."""
    array: bool = False
    """Whether they must be entered as array formulas."""
    shows: tuple[str, ...] = ()
    """Where its values come from: the ``labels`` of an axis, a ``column``, which may be ``drawn``,
    ``carried`` to an axis by an index, or ``typed`` as it is now, or a ``cell`` on the way to a root."""
    values: tuple[float | str | None, ...] = ()
    """What the cells show, in the cells' unit: a number, an error's code, or None for an error of Excel's."""
    unit: str = "1"
    """The unit of its cells, as text."""
    source: str = ""
    """The number of its equation, or where it was given."""
    of: str = ""
    """The column whose root it is on the way to, or that it carries or checks."""
    step: int = 0
    """Which step towards the root; 0 before the first."""
    kept: Mapping[str, str] = field(default_factory=dict)
    """For each axis that is summed over, the array formula that counts its rows that have values."""
    bounds: Bounds = field(default_factory=Bounds)
    """What a given cell may be, in its unit; a count no other than that of the rows there are."""
    guard: str = ""
    """The formula, without its equals sign, that says whether the cell `{0}` is that."""

    @cached_property
    def formulas(self) -> tuple[str, ...]:
        """The formula of each cell."""
        return tuple(formula for each in self.filled for formula in each.formulas())


@dataclass(frozen=True)
class Grid:
    """All cells of the workbook that come from the sheet."""

    blocks: tuple[CellBlock, ...]
    """Worksheet by worksheet, from left to right or from top to bottom."""
    axes: Mapping[str, Axis]
    """By worksheet name; those that hold the rows of an axis."""
    drawn: Drawn | None = None
    notes: Mapping[str, Place] = field(default_factory=dict)
    """By worksheet name; free cells beside the given columns of an axis, for what is wrong with them."""
    words: Mapping[str, tuple[Place, ...]] = field(default_factory=dict)
    """By worksheet name; free columns beside the numbers of its rows, for what is said of them in words; one
    beside groups."""
    groups: Mapping[str, tuple[Grouped, ...]] = field(default_factory=dict)
    """By worksheet name; how rows that stand in groups are held to their words."""
    slopes: Mapping[str, Mapping[str, tuple[Product, ...]]] = field(default_factory=dict)
    """By the name of a result, by that of what is given: the products of blocks, in SI, whose sum its
    derivative is. Nothing where there are no formulas."""
    passes: int = 0
    """How many a loop has."""

    @cached_property
    def by_name(self) -> Mapping[str, CellBlock]:
        """Every block but those of rows' numbers by its name."""
        return {block.name: block for block in self.blocks if block.kind != "index"}

    def __getitem__(self, name: str) -> CellBlock:
        return self.by_name[name]

    def on(self, worksheet: str, *kinds: str) -> tuple[CellBlock, ...]:
        """The blocks of a worksheet, all or some kinds of them."""
        return tuple(
            b for b in self.blocks if b.place.worksheet == worksheet and (not kinds or b.kind in kinds)
        )
