"""The parts of a report as they are shown: cells, tables, published values beside recomputed ones."""

from __future__ import annotations

import re
from dataclasses import dataclass

from ...derivations.unit_text import is_pure
from ..cells.address import index_text
from ..cells.values import Cell, Status
from ..quantity import Printed
from ..result.numbers import Numeral
from ..result.result import Comparison
from .names import Terms

MARK = "†"
"""What stands behind a number that lies outside of what is expected."""
MOST = 300
"""Rows that a page shows of an index set made of others, and cells to look at: nobody reads more."""


def cell_id(name: str, label: tuple[int, ...]) -> str:
    """The identifier of a cell: ``cell-alpha-1-2``."""
    return slug(f"cell-{name}-{index_text(label)}" if label else f"cell-{name}")


def why_address(cell: Cell) -> str:
    """The identifier of the sentence that says why a cell has no value."""
    return cell_id(cell.name, cell.label).replace("cell-", "why-", 1)


def slug(label: str) -> str:
    """Make an identifier of foreign text: letters, digits, ``_``, ``.`` and ``-``.

    >>> slug("(12a)"), slug("x_m[1-2]")
    ('12a', 'x_m-1-2')
    """
    return re.sub(r"[^A-Za-z0-9_.]+", "-", label).strip("-") or "x"


@dataclass(frozen=True)
class Head:
    """The head of a column."""

    name: str
    latex: str
    unit: str
    meaning: str
    """`name`, `latex`, `unit` and `meaning`: as the column's."""
    given: bool
    """Whether its cells are typed by the user: uncertainties that are stated with other numbers are not."""
    sources: tuple[str, ...]
    """Labels of the equations it comes from."""
    format: str = "1"
    """The ``table-format`` of siunitx."""
    places: int = 0
    """Digits behind the decimal point, at most."""


def described(head: Head, label: tuple[int, ...]) -> str:
    """What a cell is, for those who do not see where it stands."""
    index = f", {index_text(label)}" if label else ""
    return f"{head.meaning}{index}{'' if is_pure(head.unit) else f', in {head.unit}'}"


@dataclass(frozen=True)
class Item:
    """A cell as it is shown."""

    cell: Cell
    head: Head
    """Of its column."""
    figure: Numeral | None
    """Its number; None if it has none, or if it was printed in another notation."""
    printed: str | None = None
    """A given number as the user printed it."""
    mark: str = ""
    """What it lies outside of, if it does."""

    @property
    def ok(self) -> bool:
        """Whether it has a value."""
        return self.cell.status is Status.OK

    @property
    def code(self) -> str:
        """``ok``, or the code of its error."""
        return self.cell.status.code

    @property
    def index(self) -> str:
        """``2``, ``1-2``, or nothing."""
        return index_text(self.cell.label)

    @property
    def identifier(self) -> str:
        """Its name in the page."""
        return cell_id(self.cell.name, self.cell.label)

    @property
    def data(self) -> str:
        """The value in SI with all its digits; empty if there is none."""
        return "" if self.cell.value is None else repr(self.cell.value)

    @property
    def described(self) -> str:
        """What it is, for those who do not see where it stands."""
        return described(self.head, self.cell.label)

    @property
    def origin(self) -> Cell:
        """Where its error began."""
        return self.cell.culprit or self.cell

    @property
    def pad(self) -> int:
        """How many digits are missing on the right for the decimal signs to be in one line."""
        return 0 if self.figure is None else self.head.places - len(self.figure.fraction)


@dataclass(frozen=True)
class Remark:
    """A cell to look at: one without a value, or one with a mark."""

    cell: Cell
    code: str
    """Of its error, or :data:`MARK`."""
    why: str


@dataclass(frozen=True)
class Pair:
    """A published value beside its recomputation."""

    comparison: Comparison
    head: Head
    published: Numeral | None
    again: Numeral | None
    distance: Numeral | None
    axis: str = ""

    @property
    def printed(self) -> Printed:
        """The published number."""
        return self.comparison.published.printed

    @property
    def index(self) -> str:
        """``1–2``; the word that stands for it."""
        published = self.comparison.published
        return published.called or published.row.replace("-", "–")

    @property
    def row(self) -> str:
        """``pair 1–2``, ``test 3``; empty for a scalar."""
        return f"{self.axis} {self.index}" if self.index else ""

    @property
    def finding(self) -> str:
        """Whether it prints the same, and what there is to find of that."""
        verdict = self.comparison.verdict.replace("not-checkable", "no value")
        return f"{verdict}, {self.comparison.finding}" if self.comparison.finding else verdict


@dataclass(frozen=True)
class SourceGroup:
    """The published values of one place of the source."""

    source: str
    title: str
    pairs: tuple[Pair, ...]

    @property
    def same(self) -> int:
        """How many print the same."""
        return sum(pair.comparison.verdict == "same" for pair in self.pairs)

    @property
    def furthest(self) -> Pair | None:
        """The one that is furthest off, in units of its last digit."""
        known = [pair for pair in self.pairs if pair.comparison.distance is not None]
        return max(known, key=lambda pair: abs(pair.comparison.distance or 0), default=None)


@dataclass(frozen=True)
class Written:
    """An equation, written."""

    sides: tuple[Terms, ...]
    """LaTeX of its sides."""
    text: str
    """For a terminal."""
    conditions: tuple[str, ...]
    """LaTeX of its conditions."""
    where: tuple[str, ...]
    """These for a terminal."""
    speaks_of: str
    """LaTeX that says of which row it speaks, if it is an instance for one."""


@dataclass(frozen=True)
class Placed:
    """An equation of a column with places for the numbers in it."""

    latex: str
    """With ``@n@`` for the n-th cell in it; empty if the column is given or sums over rows."""
    cells: tuple[tuple[str | None, str | None], ...]
    """What belongs into each place: a column and an index, or how many rows an axis has."""
