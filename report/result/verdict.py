"""What the referee found about published numbers, for all who tell it: nothing is computed here.

A printed number stands for all values that print so. A *mismatch* is how far a value is from the middle of
the values that print as published, in half units of the last printed digit: at most 1 prints the same.
How all this is said: :mod:`loopsheet.report.result.verdict_words`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..inputs.published import PublishedValue

EXACT = "exact"
"""The recomputed value prints as published."""
REACHABLE = "reachable"
"""An input that prints as given yields a value that prints as published; it is kept."""
WITHIN = "within-uncertainty"
"""It is not reachable, but nearer than twice the standard uncertainty that the user gave: another measurement
would explain it, a calculation from the printed digits does not."""
UNREACHABLE = "unreachable"
"""It is certain that no input which prints as given yields it."""
NOT_FOUND = "not found"
"""None was found, and that there is none could not be made certain."""
NOT_CHECKABLE = "not-checkable"
"""The cell has no value to compare with."""

UNEXPECTED = "unexpectedly"
"""It differs, or has no value, and nobody has said so; or somebody has, and it prints the same."""
OTHERWISE = "otherwise than is known"
"""The known difference is another one."""
UNPINNED = "not pinned"
"""That it differs is said, but not what it differs to: any difference would do."""
UNREASONED = "without a reason"
"""Why it differs is not said."""
UNEXPLAINED = "no longer explained"
"""The explanation that the known difference rests on is none any more."""
UNAMENDED = "not by the known misprints"
"""It does not come out once the known misprints are put right."""


ALL = "all"
"""The source of all tables together."""
OTHERS = "all others"
"""That of all values that are neither known to differ nor out of reach by themselves."""
INPUT = "input"
"""The source of what is given; every other is a table."""


@dataclass(frozen=True)
class Witness:
    """A given cell and a value of it."""

    cell: str
    index: tuple[int, ...]
    value: float
    """In the unit that the cell was printed in; in SI if it was not printed."""


@dataclass(frozen=True)
class Verdict:
    """What can be said of one published value."""

    verdict: str
    """One of the words above."""
    low: float | None = None
    high: float | None = None
    """`low` and `high`: the values in SI that inputs which print as given were seen to yield; None where
    nothing is known."""
    bound_low: float | None = None
    bound_high: float | None = None
    """`bound_low` and `bound_high`: what no such input can leave, in SI, by interval arithmetic; None where
    that is not known."""
    mismatch: float | None = None
    """The least that was found, in half units of the last printed digit."""


@dataclass(frozen=True)
class TableVerdict:
    """Whether all values of a table, or of several, can come out of one and the same input."""

    source: str
    """``Table 2``; :data:`ALL` for all tables together."""
    values: int
    """How many were asked for together."""
    verdict: str
    """``exact``, ``reachable``, ``within-uncertainty``, ``unreachable``, ``not found`` or
    ``not-checkable``."""
    mismatch: float | None = None
    """The worst of the values, for the best input that was found."""
    at_least: float | None = None
    """What the worst mismatch is at least, for whatever input; None without a certificate."""
    worst: PublishedValue | None = None
    """A value that is as far off as the worst."""
    witness: tuple[Witness, ...] = ()
    """The best input that was found."""
    because: str = ""
    """The table that makes it impossible, where a part of the tables already does."""
    out: int = 0
    """How many of the values are out of reach by themselves."""

    @property
    def possible(self) -> bool:
        """Whether one input that prints as given yields them all, or nothing can be said of it."""
        return self.verdict in (EXACT, REACHABLE, NOT_CHECKABLE)


@dataclass(frozen=True)
class Change:
    """Something printed that may have been meant otherwise."""

    kind: str
    """``printed`` (computed from rounded, printed numbers), ``parameter`` (a convention is another),
    ``misprint`` (one cell has other digits), ``truncated`` (a column was cut, not rounded), ``zeros`` (those
    at its end are no digits), ``unit`` (off by a power of ten, or of another unit), ``factor`` (doubled,
    divided by n for n - 1, ...), ``rows`` (a mean over other rows), ``neglect`` (a column was taken as 0),
    ``label`` (two numbers or rows stand in each other's place, or a row holds another column) or ``order``
    (a list stands in another order)."""
    cell: str
    """The column; empty for a row of all columns of a table, and for what was computed of a whole table."""
    index: tuple[int, ...]
    """The row; empty for a scalar or a whole column."""
    source: str
    """The table, for what is published; :data:`INPUT` for what is given."""
    printed: str
    """As it stands."""
    would_print: str
    """As it would have to stand."""
    also: tuple[str, ...] = ()
    """Other ways that it could stand."""
    other: tuple[int, ...] = ()
    """The other row, of two that have changed places."""
    span: tuple[str, ...] = ()
    """The first and the last way that it could stand, where not all of them are listed."""
    power: int = 0
    """The power of ten that a unit is off by."""
    count: int = 1
    """How many printed numbers change; a manner of printing that holds for a column counts as one."""
    words: tuple[str, str] = ("", "")
    """What the groups are called that the row and the other row are, where they have words."""

    @property
    def row(self) -> tuple[int | str, ...]:
        """What its row is called."""
        return (self.words[0],) if self.words[0] else self.index

    @property
    def other_row(self) -> tuple[int | str, ...]:
        """What the other row is called."""
        return (self.words[1],) if self.words[1] else self.other


@dataclass(frozen=True)
class Explanation:
    """A small change of what is printed with which everything published comes out."""

    changes: tuple[Change, ...]
    mismatch: float
    """The worst of all values then."""
    values: int
    """How many published values then come out of one input."""
    of: int
    """How many are published: those that are themselves misprinted do not come out."""

    @property
    def first(self) -> Change:
        """The change; of several, the first."""
        return self.changes[0]

    @property
    def count(self) -> int:
        """How many printed numbers change; none, where only what is not printed is otherwise.

        Columns that are off by one factor have one cause.
        """
        alike = {change.would_print for change in self.changes if change.kind == "factor"}
        return len(alike) + sum(change.count for change in self.changes if change.kind != "factor")

    @property
    def as_printed(self) -> bool:
        """Whether everything stands as it is, and some of it was only computed from rounded numbers."""
        return all(change.kind == "printed" for change in self.changes)


@dataclass(frozen=True)
class Tried:
    """How many changes of the print were tried, and what became of them."""

    explaining: int
    """With these everything published comes out."""
    excluded: int
    """It is certain that these explain nothing."""
    open: int
    """These were searched for in vain, and it is not certain that they explain nothing."""


@dataclass(frozen=True)
class Relabelled:
    """A row of a table that is named after an equation which it cannot come from."""

    source: str
    """The table."""
    cell: str
    """The column that it comes out as."""
    printed: str
    right: str
    """`printed` and `right`: the number of the equation as printed, and that of the column's own."""
    gives: tuple[tuple[str, str], ...]
    """What the printed equation gives instead: columns with their units; empty if nothing of the kind."""
    wanted: tuple[str, str]
    """What the row holds and in which unit."""
    mismatch: float
    """The worst of all values, the row being that column's."""
    rivals: Mapping[str, float]
    """The same for other columns that it might be."""


@dataclass(frozen=True)
class Fit:
    """How well a published average or fit goes with each that the workbook knows."""

    published: PublishedValue
    mismatch: Mapping[str, float]
    """By column name; the worst mismatch of the tables it was made from and of itself, were it that column's;
    best first."""

    @property
    def best(self) -> str:
        """The column that goes with it best."""
        return next(iter(self.mismatch))


@dataclass(frozen=True)
class Referee:
    """All that the referee found."""

    values: tuple[Verdict, ...] = ()
    """In the order of the published values."""
    tables: tuple[TableVerdict, ...] = ()
    """One a source, in the order they are first published."""
    joint: TableVerdict | None = None
    """All of them together; None where nothing is published."""
    explanations: tuple[Explanation, ...] = ()
    """Those that change least come first; none where nothing needs one."""
    tried: Tried | None = None
    """Of what these were found; None where nothing needs one."""
    labels: tuple[Relabelled, ...] = ()
    """Rows whose printed names cannot be right."""
    fits: tuple[Fit, ...] = ()
    free: tuple[str, ...] = ()
    """The cells that the publication does not print."""
    errata: tuple[Change, ...] = ()
    """The misprints of the input that are known."""
    amended: TableVerdict | None = None
    """All tables together if the known misprints of the input are put right; None if none are known."""
    misprints: tuple[Explanation, ...] = ()
    """What else would have to change then, if they do not come out."""
    slips: tuple[Explanation, ...] = ()
    """One slip each that would explain what the stated uncertainties explain as well."""
    others: TableVerdict | None = None
    """All values that are neither known to differ nor out of reach by themselves; None where none is known to
    differ, or there are no others."""
    pinned: tuple[Explanation, ...] = ()
    """What explains the known differences where values that are none of them do not come out."""

    @property
    def possible_reasons(self) -> tuple[Explanation, ...]:
        """All that a known difference may be explained by."""
        return *self.explanations, *self.slips, *self.pinned

    @property
    def as_printed(self) -> bool:
        """Whether everything published comes out of what is printed, if by way of rounded numbers."""
        if self.joint is None:
            return False
        return self.joint.possible or (bool(self.explanations) and self.explanations[0].as_printed)

    @property
    def others_come(self) -> bool:
        """Whether all others come out: a known misprint does not hide the next one."""
        return self.as_printed or self.others is None or self.others.possible

    @property
    def asked_why(self) -> bool:
        """Whether explanations were looked for: nobody is accused of what is within uncertainty."""
        return self.joint is not None and not self.joint.possible and self.joint.verdict != WITHIN
