"""The referee's chapter: its tables and its part of the ledger of errata.

Nothing is judged here, and nothing is worded: its sentences are those of every other format
(:mod:`loopsheet.report.verdict_words`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby

from .. import verdict_words as words
from ..result import Report
from ..verdict import (
    ALL,
    EXACT,
    INPUT,
    NOT_CHECKABLE,
    REACHABLE,
    UNREACHABLE,
    WITHIN,
    Referee,
    TableVerdict,
    Verdict,
)
from ..workbook import FigureSpec
from .numbers import Figure, decimals, read
from .parts import Head, Pair

__all__ = ["FIGURE", "Finding", "Refereed", "Run", "Together", "Value", "figure", "figures"]

GOOD = (EXACT, REACHABLE, WITHIN)
"""Verdicts that ask for no explanation."""

FIGURE = "referee"
"""The name of the picture, of its drawing and of the chapter."""


def figure(report: Report) -> FigureSpec | None:
    """The picture of the published values on what is reachable; None where there is none to draw."""
    verdicts = [c.refereed for c in report.comparisons if c.refereed is not None]
    drawn = [verdict for verdict in verdicts if verdict.low is not None]
    if not drawn:
        return None
    taken = {spec.number for spec in report.workbook.figures}
    number = next(f"L{n}" for n in range(1, len(taken) + 2) if f"L{n}" not in taken)
    out = sum(verdict.verdict == UNREACHABLE for verdict in drawn)
    said = {0: "none lies outside its bar", 1: "one lies outside its bar"}.get(
        out, f"{out} lie outside theirs"
    )
    return FigureSpec(
        FIGURE,
        number,
        "Published values on what the printed inputs can yield. Each row is measured from its own published "
        "value, in units of its last digit; the scale is even near zero and shrinks as a logarithm far "
        "from it. The bar is what inputs that print as given were seen to yield, the grey band what prints "
        "as published. Where they do not meet, the bar is hollow and the published value a cross.",
        FIGURE,
        f"One row for each of {len(drawn)} published values: a bar from the least to the largest value that "
        f"the printed inputs can yield, a ring for the recomputed value, and a band at zero for what "
        f"prints as published. Of the published values {said}.",
    )


def figures(report: Report) -> tuple[FigureSpec, ...]:
    """All figures of a report: its workbook's, and the referee's if it found something to draw."""
    own = figure(report)
    return report.workbook.figures if own is None else (*report.workbook.figures, own)


@dataclass(frozen=True)
class Value:
    """A published value as the referee sees it.

    Parameters
    ----------
    pair : Pair
        It and its recomputation.
    verdict : Verdict
    """

    pair: Pair
    verdict: Verdict

    @property
    def called(self) -> str:
        """The verdict in a word."""
        return words.CALLED[self.verdict.verdict]

    @property
    def good(self) -> bool:
        """Whether it asks for no explanation."""
        return self.verdict.verdict in GOOD

    @property
    def out(self) -> bool:
        """Whether it is certain that it is out of reach."""
        return self.verdict.verdict == UNREACHABLE

    @property
    def key(self) -> tuple[str, Head, str]:
        """Which run it belongs to."""
        return self.pair.comparison.published.source, self.pair.head, self.pair.printed.unit

    @property
    def mismatch(self) -> Figure | None:
        """The least that was found, in half units of the last digit."""
        return _off(self.verdict.mismatch)

    def _shown(self, value: float | None) -> Figure | None:
        """A value in the printed unit, with one decimal more than was printed."""
        if value is None or not math.isfinite(value):
            return None
        printed = self.pair.printed
        return decimals(value / float(printed.scale), max(0, printed.decimals + 1))

    @property
    def here(self) -> Figure | None:
        """The recomputed value, in the decimals of what surrounds it: rounded alike, it lies between."""
        return self._shown(self.pair.comparison.cell.value)

    @property
    def low(self) -> Figure | None:
        """The least value that printed inputs were seen to yield; None where one of them is not printed."""
        return self._shown(self.verdict.low)

    @property
    def high(self) -> Figure | None:
        """The largest."""
        return self._shown(self.verdict.high)


@dataclass(frozen=True)
class Run:
    """The values of one cell that a place of the source prints one after another.

    Parameters
    ----------
    source : str
    head : Head
        Of the cell.
    unit : str
        As printed.
    values : tuple of Value
    """

    source: str
    head: Head
    unit: str
    values: tuple[Value, ...]


@dataclass(frozen=True)
class Together:
    """All values of a table, or of all tables.

    Parameters
    ----------
    table : TableVerdict
    worst : Pair or None
        The value that presses most.
    """

    table: TableVerdict
    worst: Pair | None

    @property
    def all(self) -> bool:
        """Whether these are all tables together."""
        return self.table.source == ALL

    @property
    def name(self) -> str:
        """``Table 2``."""
        return "all together" if self.all else self.table.source

    @property
    def called(self) -> str:
        """The verdict in a word."""
        return words.CALLED[self.table.verdict]

    @property
    def good(self) -> bool:
        """Whether they ask for no explanation."""
        return self.table.verdict in GOOD

    @property
    def checked(self) -> bool:
        """Whether they could be asked for at all."""
        return self.table.verdict != NOT_CHECKABLE

    @property
    def mismatch(self) -> Figure | None:
        """The worst of them, for the best input that was found."""
        return _off(self.table.mismatch)

    @property
    def at_least(self) -> Figure | None:
        """What the worst is at least, whatever the input."""
        return None if self.table.at_least is None else read(words.at_least(self.table.at_least))

    @property
    def sentence(self) -> str:
        """The verdict as a sentence."""
        return f"{words.together(self.table)}."


@dataclass(frozen=True)
class Finding:
    """A line of the ledger of errata.

    Parameters
    ----------
    about : str
        The equation or the place of the source, for what the algebra found; else empty.
    kind, finding, evidence : str
        Sentences with symbols in them.
    source : str
        The place in the data, as the user wrote it.
    cell : str
        The column in question; empty for a whole table.
    index : tuple of int
    """

    about: str
    kind: str
    finding: str
    evidence: str
    source: str = ""
    cell: str = ""
    index: tuple[int, ...] = ()


class Refereed:
    """The chapter on the referee: what both formats tell of it.

    Parameters
    ----------
    report : Report
    pairs : sequence of Pair
        Its published values by their source, in the order of the file.
    """

    def __init__(self, report: Report, pairs: Sequence[Pair]) -> None:
        self.report, self.pairs = report, pairs
        self.found: Referee = report.referee

    @property
    def present(self) -> bool:
        """Whether the referee was asked about anything."""
        return bool(self.found.values)

    @cached_property
    def values(self) -> tuple[Value, ...]:
        """The published values by their source, in the order of the file."""
        return tuple(
            Value(pair, pair.comparison.refereed)
            for pair in self.pairs
            if pair.comparison.refereed is not None
        )

    @cached_property
    def runs(self) -> tuple[Run, ...]:
        """The same, those of one cell and one place together."""
        return tuple(
            Run(source, head, unit, tuple(values))
            for (source, head, unit), values in groupby(self.values, lambda value: value.key)
        )

    @property
    def out(self) -> tuple[Value, ...]:
        """Those that are out of reach by themselves."""
        return tuple(value for value in self.values if value.out)

    @property
    def without(self) -> int:
        """How many have a value but no interval: something that they rest on is not printed."""
        return sum(
            value.verdict.low is None and value.verdict.verdict != NOT_CHECKABLE for value in self.values
        )

    @property
    def nothing(self) -> str:
        """What is said if nothing explains it."""
        return words.NOTHING_EXPLAINS

    @property
    def headline(self) -> str:
        """What is said above explanations."""
        return words.headline(self.found.explanations)

    @property
    def tried(self) -> str:
        """How many changes were tried; empty if none were."""
        return "" if self.found.tried is None else words.tried(self.found.tried)

    @property
    def explanations(self) -> tuple[str, ...]:
        """What would explain that not everything comes out."""
        return tuple(map(words.explained, self.found.explanations))

    @property
    def amended(self) -> tuple[str, ...]:
        """What is said of the known misprints: what they are, then what comes out with them put right."""
        if self.found.amended is None:
            return ()
        return (words.amended(self.found), *map(words.explained, self.found.misprints))

    @property
    def fits(self) -> tuple[str, ...]:
        """What is said of each published average."""
        return tuple(words.fit(found, self._meaning) for found in self.found.fits)

    def _meaning(self, name: str) -> str:
        return self.report.sheet[name].meaning

    @property
    def free(self) -> tuple[str, ...]:
        """The columns that the publication does not print."""
        return tuple(name for name in self.found.free if name in self.report.sheet)

    @property
    def joint(self) -> Together | None:
        """All tables together."""
        return None if self.found.joint is None else self._together(self.found.joint)

    @cached_property
    def tables(self) -> tuple[Together, ...]:
        """Each table, and all of them together if there are several."""
        found = [self._together(table) for table in self.found.tables]
        joint = self.joint
        return tuple(found) if joint is None or len(found) == 1 else (*found, joint)

    def _together(self, table: TableVerdict) -> Together:
        worst = None
        if table.worst is not None and table.verdict not in GOOD:
            worst = next((pair for pair in self.pairs if pair.comparison.published is table.worst), None)
        return Together(table, worst)

    @property
    def possible(self) -> bool:
        """Whether everything published can come out of what is printed."""
        return self.joint is not None and self.joint.good

    @property
    def asked_why(self) -> bool:
        """Whether explanations were looked for."""
        return self.found.asked_why

    def fit_of(self, cell: str) -> str:
        """What is said of the published value of an average or a fit; empty if it was not asked for."""
        found = next((fit for fit in self.found.fits if fit.published.cell == cell), None)
        return "" if found is None else words.fit(found, self._meaning)

    # --- the ledger of errata

    @cached_property
    def errata(self) -> tuple[Finding, ...]:
        """What the checks of the equations found, then what the referee found in the data."""
        equations = (Finding(e.about, e.kind, e.sentence, e.evidence) for e in self.report.errata)
        return (*equations, *self._labels(), *self._tables(), *self._values(), *self._possible())

    def _labels(self) -> Iterable[Finding]:
        for label in self.found.labels:
            finding = f"named after {label.printed}, but comes out of {label.right}"
            yield Finding("", "label", finding, words.because(label), label.source, label.cell)

    def _tables(self) -> Iterable[Finding]:
        for table in self.tables:
            if table.table.verdict == UNREACHABLE:
                finding, evidence = words.contradiction(table.table), words.evidence(table.table)
                yield Finding("", "contradiction", finding, evidence, table.name)

    def _values(self) -> Iterable[Finding]:
        for value in self.out:
            published = value.pair.comparison.published
            ends = words.bounds(value.verdict, published.printed)
            evidence = "" if ends is None else words.certain(ends)
            finding = f"{published.printed.text} cannot come out of inputs that print as given"
            yield Finding(
                "", "unreachable", finding, evidence, published.source, published.cell, published.index
            )

    def _possible(self) -> Iterable[Finding]:
        for each in self.found.explanations:
            first, then = each.first, words.follows(each)
            if each.as_printed:
                continue  # nothing that is printed needs to be otherwise
            source = "" if first.source == INPUT else first.source
            kind, finding = words.POSSIBLE[first.kind], words.suggested(each)
            yield Finding("", kind, finding, then, source, first.cell, first.index)


def _off(mismatch: float | None) -> Figure | None:
    """A mismatch as it is shown."""
    return None if mismatch is None or not math.isfinite(mismatch) else read(words.mismatch(mismatch))
