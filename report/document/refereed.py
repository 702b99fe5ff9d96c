"""The published values as the referee sees them, and the picture of them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..result import verdict_words as words
from ..result.numbers import Numeral, decimals, read
from ..result.result import Report
from ..result.verdict import EXACT, REACHABLE, UNREACHABLE, Verdict
from ..workbook import FigureSpec
from .parts import Head, Pair

GOOD = (EXACT, REACHABLE)
"""Verdicts on what comes out of what is printed."""

FIGURE = "referee"
"""The name of the picture, of its drawing and of the chapter."""


def figures(report: Report) -> tuple[FigureSpec, ...]:
    """The picture of the published values on what is reachable, without its number, if there is one."""
    verdicts = [c.refereed for c in report.comparisons if c.refereed is not None]
    drawn = [verdict for verdict in verdicts if verdict.low is not None]
    if not drawn:
        return ()
    out = sum(verdict.verdict == UNREACHABLE for verdict in drawn)
    said = {0: "none lies outside its bar", 1: "one lies outside its bar"}.get(
        out, f"{out} lie outside theirs"
    )
    drawn_so = FigureSpec(
        FIGURE,
        "",
        "Published values on what the printed inputs can yield. Each row is measured from its own published "
        "value, in units of its last digit; the scale is even near zero and shrinks as a logarithm far "
        "from it. The bar is what inputs that print as given were seen to yield, the grey band what prints "
        "as published. Where they do not meet, the bar is hollow and the published value a cross.",
        FIGURE,
        f"One row for each of {len(drawn)} published values: a bar from the least to the largest value that "
        f"the printed inputs can yield, a ring for the recomputed value, and a band at zero for what "
        f"prints as published. Of the published values {said}.",
    )
    return (drawn_so,)


@dataclass(frozen=True)
class RefereedPair:
    """A published value as the referee sees it."""

    pair: Pair
    """It and its recomputation."""
    found: Verdict

    @property
    def verdict(self) -> str:
        """As of :mod:`~loopsheet.report.result.verdict`."""
        return self.found.verdict

    @property
    def mismatch(self) -> float | None:
        """The least that was found, in half units of the last digit."""
        return self.found.mismatch

    @property
    def run(self) -> tuple[str, Head, str]:
        """The values that a place of the source prints of one cell, one after another."""
        return self.pair.comparison.published.source, self.pair.head, self.pair.printed.unit

    @property
    def here(self) -> Numeral | None:
        """The recomputed value, in the decimals of what surrounds it: rounded alike, it lies between."""
        return self._shown(self.pair.comparison.cell.value)

    @property
    def low(self) -> Numeral | None:
        """The least value that printed inputs were seen to yield; None where one of them is not printed."""
        return self._shown(self.found.low)

    @property
    def high(self) -> Numeral | None:
        """The largest."""
        return self._shown(self.found.high)

    def _shown(self, value: float | None) -> Numeral | None:
        """A value in the printed unit, with one decimal more than was printed."""
        if value is None or not math.isfinite(value):
            return None
        printed = self.pair.printed
        return decimals(
            float((value - float(printed.zero)) / float(printed.scale)), max(0, printed.decimals + 1)
        )


def shown_mismatch(mismatch: float | None) -> Numeral | None:
    """A mismatch as it is shown."""
    return None if mismatch is None or not math.isfinite(mismatch) else read(words.mismatch(mismatch))
