"""What a document is made of: inlines, and the blocks that hold them. Data only; formats print them.

An inline is one of the classes here, or plain text as a string; a run of them is a tuple.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from ...derivations.equation import Equation
from ...derivations.unit_text import is_pure
from ..cells.address import index_text
from ..result import numbers
from ..workbook import FigureSpec
from .names import Terms
from .parts import Item, cell_id


class Node:
    """What a format prints by a rule of its own, named after the class."""


class Block(Node):
    """A node that stands by itself, not in a line."""


# --- inlines ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Strong(Node):
    """What stands out."""

    content: Inlines


@dataclass(frozen=True)
class Code(Node):
    """What is typed: a command, the name of a file."""

    text: str


@dataclass(frozen=True)
class Math(Node):
    """A formula in running text."""

    latex: str


@dataclass(frozen=True)
class Number(Node):
    """A number that is no cell; `text` is what its author printed, `signed` a difference, with its plus."""

    figure: numbers.Numeral | None
    text: str = ""
    signed: bool = False


@dataclass(frozen=True)
class Unit(Node):
    """A unit; of a pure number nothing is shown."""

    unit: str


@dataclass(frozen=True)
class Bar(Node):
    """A share of a whole, as long as it is large."""

    share: float

    @property
    def percent(self) -> int:
        """How long it is, of 100."""
        return round(100 * min(max(self.share, 0.0), 1.0))


@dataclass(frozen=True)
class Value(Node):
    """A cell in running text, with its unit; the page keeps it up to date."""

    item: Item


@dataclass(frozen=True)
class Count(Node):
    """How many rows there are, which the page counts again.

    Of an axis (`kind` is ``count``), or of them in a column's sum; or inside of a margin (``inside``). Or how
    likely a sum of squares is (``tail``, ``head``).
    """

    text: str | Inlines
    kind: str
    name: str
    column: str = ""


@dataclass(frozen=True)
class Refer(Node):
    """A reference to an equation by its label."""

    label: str


@dataclass(frozen=True)
class Link(Node):
    """A reference to a ``section``, a ``table`` or a ``figure``."""

    kind: str
    name: str
    content: Inlines


@dataclass(frozen=True)
class Hint(Node):
    """Something short, and what it means."""

    content: Inlines
    title: str


@dataclass(frozen=True)
class Badge(Node):
    """What is known of an equation; the kind is ``stated``, ``holds`` or ``fails``."""

    word: str
    kind: str


Inline = str | Strong | Code | Math | Number | Unit | Value | Count | Refer | Link | Hint | Badge | Bar
Inlines = tuple[Inline, ...]


def in_unit(unit: str) -> Inlines:
    """A unit behind a number, on its line; nothing of a pure number."""
    return () if is_pure(unit) else ("\u00a0", Unit(unit))


def joined(parts: Iterable[Inlines], between: str, last: str = "") -> Inlines:
    """Runs in a row.

    >>> joined([("a",), ("b",), ("c",)], ", ", " and ")
    ('a', ', ', 'b', ' and ', 'c')
    """
    runs = list(parts)
    signs = [between] * (len(runs) - 2) + [last or between] * (len(runs) > 1)
    return tuple(one for n, run in enumerate(runs) for one in ((signs[n - 1], *run) if n else run))


# --- tables ----------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Silent(Node):
    """What was printed in a cell of a row that is left out: it has no value.

    `described` says what it is, for an input of it; empty for what is computed.
    """

    name: str
    label: tuple[int, ...]
    text: str
    described: str

    @property
    def index(self) -> str:
        """``2``."""
        return index_text(self.label)

    @property
    def identifier(self) -> str:
        """Its name in the page."""
        return cell_id(self.name, self.label)


Entry = Inlines | Item | Silent


@dataclass(frozen=True)
class TableColumn:
    """A column of a table."""

    head: Inlines
    kind: str = "left"
    """Or ``number`` (on the right), ``words`` (broken into lines), ``row``, ``symbol``, ``unitcell``, or
    ``verdict``, which stands out in a row that is a finding."""
    form: str = ""
    """The ``table-format`` of siunitx, where numbers stand below one another in print."""
    share: float = 0
    """The part of a line that words take in print."""
    unit: Inlines = ()
    """What stands below the head."""
    tip: str = ""
    """What the head means, where no legend tells it."""


@dataclass(frozen=True)
class Row:
    """A row of a table; its state is ``excluded``, ``unexpected`` or nothing."""

    cells: tuple[Entry, ...]
    state: str = ""
    identifier: str = ""


@dataclass(frozen=True)
class Rows:
    """Rows that belong together, below a title of their own if they have one."""

    rows: tuple[Row, ...]
    title: Inlines = ()


LONG = 30
"""A table of more rows than this scrolls in the page and breaks over pages in print."""


@dataclass(frozen=True)
class Table(Block):
    """A table; one without a number stands where it is mentioned."""

    name: str
    caption: Inlines
    columns: tuple[TableColumn, ...]
    groups: tuple[Rows, ...]
    number: str = ""
    look: str = ""
    """``list`` (no sheet of rows), ``compared`` (live beside what was published) or nothing."""
    legend: Inlines = ()
    limits: Inlines = ()
    """What a mark in it means."""
    cut: str = ""
    """A sentence about rows that are not shown."""
    wide: bool = False
    """Whether it takes more room than text does."""
    whole: bool = False
    """Whether it is always seen whole, however long it is."""

    @property
    def identifier(self) -> str:
        """What a reference leads to."""
        return f"table-{self.name}" if self.number else self.name

    @property
    def rows(self) -> Iterator[Row]:
        """All rows."""
        return (row for group in self.groups for row in group.rows)

    @cached_property
    def size(self) -> int:
        """How many rows it has."""
        return sum(len(group.rows) for group in self.groups)

    @property
    def long(self) -> bool:
        """Whether it needs room of its own."""
        return self.size > LONG and not self.whole

    @property
    def marked(self) -> bool:
        """Whether some cell of it carries a mark."""
        return any(isinstance(cell, Item) and cell.mark for row in self.rows for cell in row.cells)

    @property
    def filled(self) -> Table:
        """Without the columns in which no row says anything, for a format whose columns nobody counts."""
        said = [n for n in range(len(self.columns)) if any(row.cells[n] for row in self.rows)]
        groups = tuple(
            Rows(
                tuple(replace(row, cells=tuple(row.cells[n] for n in said)) for row in group.rows),
                group.title,
            )
            for group in self.groups
        )
        return replace(self, columns=tuple(self.columns[n] for n in said), groups=groups)


# --- other blocks ----------------------------------------------------------------------------------------

Blocks = tuple[Block, ...]


@dataclass(frozen=True)
class Paragraph(Block):
    """Running text; an aside is set smaller."""

    content: Inlines
    aside: bool = False


@dataclass(frozen=True)
class Note(Block):
    """What must not be overlooked."""

    content: Inlines


@dataclass(frozen=True)
class Items(Block):
    """A list; one of ``versions`` is set close together, one of what is ``decided`` follows no edit."""

    items: tuple[Inlines, ...]
    look: str = ""


@dataclass(frozen=True)
class HeadlineItem:
    """A cell that is a result: over how many rows if not all, how many carry marks, how sure it is."""

    symbol: Math
    meaning: Inlines
    item: Item
    said: tuple[str, ...]
    sure: Inlines = ()
    doubt: Inlines = ()


@dataclass(frozen=True)
class Headline(Block):
    """The results."""

    results: tuple[HeadlineItem, ...]


@dataclass(frozen=True)
class Figure(Block):
    """A picture that was drawn."""

    spec: FigureSpec
    caption: Inlines


@dataclass(frozen=True)
class Display(Block):
    """A displayed equation, with its number or without."""

    equation: Equation
    numbered: bool = False


@dataclass(frozen=True)
class PutIn(Block):
    """An equation with numbers in it, and the number of that which they were put into."""

    label: str
    sides: tuple[Terms, ...]


@dataclass(frozen=True)
class Claim(Block):
    """An equation with what is known of it: why it holds, what it rests on if proved, its derivation."""

    equation: Equation
    title: Inlines
    status: Badge
    because: Inlines
    grounds: Inlines
    summary: str
    steps: tuple[Blocks, ...]


@dataclass(frozen=True)
class Section(Block):
    """A chapter; what one says that was `issued` is not computed again when data are edited."""

    name: str
    title: str
    blocks: Blocks
    issued: bool = False
