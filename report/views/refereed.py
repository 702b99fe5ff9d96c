"""What the referee found, in words: the one place that says what a verdict is called.

Nothing is judged here. A printed number stands for all values that print so; a mismatch counts half units of
the last printed digit, and up to one a value prints the same (:mod:`loopsheet.report.verdict`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import TYPE_CHECKING

from ..result import Report
from ..verdict import (
    EXACT,
    NOT_CHECKABLE,
    NOT_FOUND,
    REACHABLE,
    UNREACHABLE,
    WITHIN,
    Explanation,
    Fit,
    Referee,
    TableVerdict,
    Verdict,
)
from ..workbook import FigureSpec
from .numbers import Figure, decimals
from .parts import Head, Pair

if TYPE_CHECKING:
    from .document import Document

__all__ = [
    "CALLED",
    "FIGURE",
    "Candidate",
    "Finding",
    "Refereed",
    "Run",
    "Together",
    "Value",
    "figure",
    "mismatch",
]

CALLED = {
    EXACT: "exact",
    REACHABLE: "reachable",
    WITHIN: "within uncertainty",
    UNREACHABLE: "unreachable",
    NOT_FOUND: "not found",
    NOT_CHECKABLE: "no value",
}
"""A verdict in a table or a picture."""

GOOD = (EXACT, REACHABLE, WITHIN)
"""Verdicts that ask for no explanation."""

POSSIBLE = {
    "misprint": "possible misprint",
    "truncated": "possible truncation",
    "label": "possible confusion",
    "order": "possible disorder",
}
"""What an explanation would be, were it the right one."""

FIGURE = "referee"
"""The name of the picture, of its drawing and of the chapter."""

_ALL = "all"
"""How the referee calls all tables together."""


def mismatch(value: float) -> Figure:
    """A mismatch with one decimal, or with as many as tell on which side of one it is.

    >>> mismatch(8.4107).text, mismatch(1.02).text, mismatch(0.9996).text, mismatch(1.0).text
    ('8.4', '1.02', '0.9996', '1.0')
    """
    for places in range(1, 16):
        shown = decimals(value, places)
        seen = float(shown.plain)
        if (seen > 1, seen < 1) == (value > 1, value < 1):
            return shown
    return decimals(value, 1)


def certain(value: float) -> Figure:
    """What a mismatch is at least: rounded down, for no more is certain.

    >>> certain(6.4637).text, certain(1.04).text
    ('6.4', '1.04')
    """
    shown = (decimals(math.floor(value * 10**n) / 10**n, n) for n in range(1, 16))
    return next((one for one in shown if float(one.plain) > 1), decimals(value, 16))


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
        return CALLED[self.verdict.verdict]

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
        found = self.verdict.mismatch
        return None if found is None or not math.isfinite(found) else mismatch(found)

    def _shown(self, value: float | None, outwards: int = 0) -> Figure | None:
        """A value in the printed unit, with one decimal more than was printed."""
        if value is None or not math.isfinite(value):
            return None
        printed = self.pair.printed
        places = max(0, printed.decimals + 1)
        in_unit = value / float(printed.scale)
        if outwards:
            turn = math.ceil if outwards > 0 else math.floor
            in_unit = turn(in_unit * 10**places) / 10**places
        return decimals(in_unit, places)

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

    @property
    def certain(self) -> tuple[Figure, Figure] | None:
        """What no printed input can leave, rounded outwards."""
        low, high = self._shown(self.verdict.bound_low, -1), self._shown(self.verdict.bound_high, 1)
        return None if low is None or high is None else (low, high)


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
    out : int
        How many of them are out of reach by themselves.
    worst : Pair or None
        The value that presses most.
    """

    table: TableVerdict
    out: int
    worst: Pair | None

    @property
    def all(self) -> bool:
        """Whether these are all tables together."""
        return self.table.source == _ALL

    @property
    def name(self) -> str:
        """``Table 2``."""
        return "all together" if self.all else self.table.source

    @property
    def called(self) -> str:
        """The verdict in a word."""
        return CALLED[self.table.verdict]

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
        found = self.table.mismatch
        return None if found is None or not math.isfinite(found) else mismatch(found)

    @property
    def at_least(self) -> Figure | None:
        """What the worst is at least, whatever the input."""
        return None if self.table.at_least is None else certain(self.table.at_least)

    @property
    def finding(self) -> str:
        """What is certain, as the ledger says it."""
        return f"{self._whose} cannot come out of one input that prints as given"

    @property
    def evidence(self) -> str:
        """Why."""
        parts = []
        if self.mismatch is not None:
            parts.append(f"the best input that was found leaves a mismatch of {self.mismatch.text}")
        if self.at_least is not None:
            parts.append(f"by interval arithmetic none leaves less than {self.at_least.text}")
        elif self.out:
            parts.append(
                "one value is out of reach even by itself"
                if self.out == 1
                else f"{self.out} values are out of reach even by themselves"
            )
        return "; ".join(parts)

    @property
    def _whose(self) -> str:
        n = self.table.values
        if self.all:
            return f"all {n} published values together" if n > 1 else "the published value"
        return f"the {n} values of {self.table.source}" if n > 1 else f"the value of {self.table.source}"

    @property
    def sentence(self) -> str:
        """The verdict as a sentence."""
        whose, word = self._whose, self.table.verdict
        upper = whose[0].upper() + whose[1:]
        off = "" if self.mismatch is None else self.mismatch.text
        if word == EXACT:
            come = "comes" if self.table.values == 1 else "come"
            return f"{upper} {come} out as printed, from the inputs exactly as they are printed."
        if word == REACHABLE:
            return f"{upper} can come out of one input that prints as given, with a worst mismatch of {off}."
        if word == UNREACHABLE:
            because = f". {self.table.because} alone makes that certain" if self.table.because else ""
            return f"{upper} cannot come out of one input that prints as given: {self.evidence}{because}."
        if word == NOT_FOUND:
            return (
                f"No input that prints as given was found from which {whose} come out; the best leaves "
                f"a mismatch of {off}. That there is none is not certain."
            )
        return "None of the published values could be asked for: their cells have no values."


@dataclass(frozen=True)
class Candidate:
    """What a published average or fit may be.

    Parameters
    ----------
    name : str
        The column.
    meaning : str
        What it is.
    mismatch : Figure
        The worst mismatch, were it that.
    fits : bool
        Whether everything then prints the same.
    """

    name: str
    meaning: str
    mismatch: Figure
    fits: bool


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
    document : Document
    """

    def __init__(self, document: Document) -> None:
        self.document = document
        self.report: Report = document.report
        self.found: Referee = document.report.referee

    @property
    def present(self) -> bool:
        """Whether the referee was asked about anything."""
        return bool(self.found.values)

    @cached_property
    def values(self) -> tuple[Value, ...]:
        """The published values by their source, in the order of the file."""
        return tuple(
            Value(pair, pair.comparison.refereed)
            for group in self.document.groups
            for pair in group.pairs
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
    def amended(self) -> tuple[str, ...]:
        """What is said of the known misprints: what they are, then what comes out with them put right."""
        if self.found.amended is None:
            return ()
        inputs, right = self.report.inputs, []
        for (name, row), printed in inputs.errata.items():
            was = inputs.measured[name][row].text
            right.append(f"{name}[{inputs.tests[row]}] as {printed.text}, not {was}")
        said = [f"With {' and '.join(right)}, {self.found.amended.sentence}"]
        return (*said, *(each.sentence for each in self.found.misprints))

    @property
    def free(self) -> tuple[str, ...]:
        """The columns that the publication does not print."""
        return tuple(name for name in self.found.free if self.document.has(name))

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
        out = sum(
            v.pair.comparison.published.source == table.source or table.source == _ALL for v in self.out
        )
        worst = None
        if table.worst is not None and table.verdict not in GOOD:
            pairs = [value.pair for value in self.values if value.pair.comparison.published is table.worst]
            worst = pairs[0] if pairs else self.document.published(table.worst.cell, table.worst.index)
        return Together(table, out, worst)

    @property
    def possible(self) -> bool:
        """Whether everything published can come out of what is printed."""
        return self.joint is not None and self.joint.good

    @property
    def asked_why(self) -> bool:
        """Whether explanations were looked for."""
        joint = self.joint
        return joint is not None and joint.checked and not joint.good

    def candidates(self, fit: Fit) -> tuple[Candidate, ...]:
        """What a published average may be, best first; in the workbook's order where the digits tell none."""
        order = [name for name in self.report.workbook.fits if name in fit.mismatch]
        found = [
            Candidate(name, self.report.sheet[name].meaning, mismatch(off), off <= 1)
            for name in (*order, *(name for name in fit.mismatch if name not in order))
            for off in (fit.mismatch[name],)
        ]
        return tuple(sorted(found, key=lambda one: float(one.mismatch.plain)))

    def told(self, fit: Fit) -> str:
        """What that says of a published average."""
        good = [f"the {one.meaning}" for one in self.candidates(fit) if one.fits]
        if not good:
            return "None of them goes with what is published"
        if len(good) == 1:
            return f"Only {good[0]} goes with what is published"
        return f"The digits do not tell {' from '.join(good)}"

    def fit_of(self, cell: str) -> Fit | None:
        """What was found of the published value of an average or a fit."""
        return next((fit for fit in self.found.fits if fit.published.cell == cell), None)

    # --- the ledger of errata

    @cached_property
    def errata(self) -> tuple[Finding, ...]:
        """What the checks of the equations found, then what the referee found in the data."""
        equations = (Finding(e.about, e.kind, e.sentence, e.evidence) for e in self.report.errata)
        return (*equations, *self._labels(), *self._tables(), *self._values(), *self._possible())

    def _labels(self) -> Iterable[Finding]:
        for label in self.found.labels:
            finding = f"named after {label.printed}, but comes out of {label.would_print}"
            evidence = label.sentence.removeprefix(label.source).partition(": ")[2]
            yield Finding("", "label", finding, evidence, label.source, label.cell, label.index)

    def _tables(self) -> Iterable[Finding]:
        for table in self.tables:
            if table.table.verdict == UNREACHABLE:
                yield Finding("", "contradiction", table.finding, table.evidence, table.name)

    def _values(self) -> Iterable[Finding]:
        for value in self.out:
            published, bounds = value.pair.comparison.published, value.certain
            evidence = (
                f"by interval arithmetic they yield at least {bounds[0].text} and at most {bounds[1].text}"
                if bounds is not None
                else ""
            )
            finding = f"{published.printed.text} cannot come out of inputs that print as given"
            yield Finding(
                "", "unreachable", finding, evidence, published.source, published.cell, published.index
            )

    def _possible(self) -> Iterable[Finding]:
        for each in self.found.explanations:
            source = "" if each.source == "input" else each.source
            off = mismatch(each.mismatch).text
            then = f"then everything published comes out, with a worst mismatch of {off}"
            yield Finding("", POSSIBLE[each.kind], changed(each), then, source, each.cell, each.index)


def changed(explanation: Explanation) -> str:
    """What an explanation changes, shortly."""
    printed, would = explanation.printed, " or ".join((explanation.would_print, *explanation.also))
    match explanation.kind:
        case "truncated":
            return f"may have been {would}, not {printed}"
        case "order":
            return f"may belong in the order {would}"
        case "label":
            return (
                f"{printed} and {would} may have changed places" if explanation.index else f"may be {would}"
            )
    return f"{printed} may have to read {would}"
