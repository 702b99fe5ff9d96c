"""The referee's picture: every published value on what the printed inputs can yield."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from ..charts import BLUE as UNLOADING
from ..charts import INK
from ..charts import VERMILION as LOADING
from ..document.names import latex_names, name_latex
from ..result.numbers import rounded
from ..result.result import Comparison, Report
from ..result.verdict import EXACT, REACHABLE, UNREACHABLE
from ..result.verdict_words import CALLED
from . import drawing
from .drawing import PALE
from .escape import visible

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_ROWS = 60
"""Of more published values, those are drawn that are out of reach or whose recomputation is furthest off."""

FURTHEST = 1000.0
"""Units of the last digit up to which a bar is drawn; what goes on beyond ends in an arrowhead."""

TICKS = (1, 3, 10, 30, 100, 300, 1000)
WIDE = 10.0
"""How wide a scale is on which only whole powers of ten have room."""
LONGEST = 46
"""Characters of a source's name; the tables have it in full."""
HALF = 0.26
"""Half the height of a bar, in rows."""
GRID = "#e6e6e6"


@dataclass(frozen=True)
class ReachRow:
    """A published value in the picture; lengths are in units of its last digit, from its own value."""

    place: str
    """Where it is published and, in a list of one cell's values, which cell it is: the heading above it."""
    name: str
    """What tells it from others under that heading, and the published digits."""
    low: float
    high: float
    """`low` and `high`: what is reachable."""
    here: float | None
    """The recomputed value."""
    band: tuple[float, float]
    """What prints as published."""
    verdict: str

    @property
    def solid(self) -> bool:
        """Whether it is reachable."""
        return self.verdict in (EXACT, REACHABLE)


def rows(report: Report) -> tuple[ReachRow, ...]:
    """The published values that have an interval of what is reachable, by where it is published."""
    names = latex_names(report.ledger.vocabulary, report.sheet.columns)
    found = [_row(one, names) for one in _known(report)]
    if len(found) > MOST_ROWS:
        worst = sorted(found, key=lambda row: (row.solid, -abs(row.here or 0.0)))[:MOST_ROWS]
        found = [row for row in found if any(row is one for one in worst)]
    order = list(dict.fromkeys(row.place for row in found))
    return tuple(sorted(found, key=lambda row: order.index(row.place)))


def _known(report: Report) -> list[Comparison]:
    return [one for one in report.comparisons if one.refereed and one.refereed.low is not None]


def _row(one: Comparison, names: dict[str, str]) -> ReachRow:
    published, verdict = one.published, one.refereed
    assert verdict is not None
    assert verdict.low is not None
    assert verdict.high is not None
    printed = published.printed
    centre, unit = float(printed.value), float(2 * printed.half_unit)
    index = drawable(published.called) or published.row.replace("-", "–")
    symbol = _symbol(name_latex(published.cell, names), published.cell)
    source = drawable(published.source)
    low, high = (float(end - printed.value) / unit for end in printed.interval)
    return ReachRow(
        f"{source}, {symbol}" if index else source,
        f"{index or symbol}: {printed.text}",
        (verdict.low - centre) / unit,
        (verdict.high - centre) / unit,
        one.distance,
        (low, high),
        verdict.verdict,
    )


# --- texts -----------------------------------------------------------------------------------------------


_SIMPLE = re.compile(r"(?:\\(?:alpha|beta|mu)|[A-Za-z])'?(?:_\w)?")


def _symbol(latex: str, name: str) -> str:
    r"""A cell's symbol where it is one letter with one below it, else its name as published.csv has it.

    >>> _symbol("x_{m}", "x_m"), _symbol(r"\bar{\alpha}", "alpha_mean")
    ('$x_m$', 'alpha_mean')
    """
    plain = re.sub(r"\{(\w?)\}", r"\1", latex)
    return f"${plain}$" if _SIMPLE.fullmatch(plain) else drawable(name)


@lru_cache(maxsize=1)
def _characters() -> frozenset[int]:
    """The characters that the font has."""
    from matplotlib.font_manager import FontProperties, findfont, get_font

    return frozenset(get_font(findfont(FontProperties(family="DejaVu Sans"))).get_charmap())


def drawable(text: str) -> str:
    r"""A foreign text for a picture: what it cannot show becomes a question mark.

    >>> drawable("Table 2 <b> $x$ \u6771")
    'Table 2 <b> ?x? ?'
    """
    plain = "".join(c if ord(c) in _characters() and c not in "$\\" else "?" for c in visible(text))
    return plain if len(plain) <= LONGEST else plain[: LONGEST - 1] + "…"


# --- the picture -----------------------------------------------------------------------------------------


def _scaled(units: float | Sequence[float]) -> drawing.Array:
    """Even near zero, as a logarithm far from it; cut at the furthest that is drawn."""
    found: drawing.Array = np.arcsinh(np.clip(np.asarray(units, dtype=np.float64), -FURTHEST, FURTHEST))
    return found


def draw(report: Report) -> Figure:
    """Draw each published value on what is reachable."""
    found = rows(report)
    if not found:
        figure, axes = drawing.page(3)
        drawing.empty(axes, "No reachable interval to draw: no published value has one.")
        return figure
    lines = len(found) + len({row.place for row in found})
    figure, axes = drawing.page(2.4 + 0.52 * lines)
    left, right = _limits(found)
    axes.set_xlim(left, right)
    axes.set_ylim(lines - 0.4, -0.6)

    places: list[tuple[float, ReachRow]] = []
    line = 0
    for heading, members in groupby(found, key=lambda row: row.place):
        _beside(axes, heading, (left, line + 0.05), 3)
        line += 1
        for row in members:
            _beside(axes, row.name, (left, line), -4)
            places.append((line, row))
            line += 1
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    _abscissa(axes, lines)
    if (every := len(_known(report))) > len(found):
        axes.set_xlabel(f"{axes.get_xlabel()}; {len(found)} of {every} values are drawn")
    _band(axes, places)
    _bars(axes, places)
    _marks(axes, places)
    for place, row in places:
        if not row.solid:  # said in words too
            here = row.here or 0.0
            sign = "+" if here > 0 else ""
            far = f", off by {sign}{rounded(here, 3).text}" if abs(here) > FURTHEST else ""
            _beside(axes, CALLED[row.verdict] + far, (right, place), -2)
    _key(figure, places)
    return figure


def _beside(axes: Axes, text: str, at: tuple[float, float], points: float) -> None:
    """Write a text so many points of print to the right of a place, or to the left."""
    side = "left" if points > 0 else "right"
    axes.annotate(
        text, at, (points, 0), textcoords="offset points", ha=side, va="center",
        fontsize=8.5, annotation_clip=False,
    )  # fmt: skip


def _limits(found: Iterable[ReachRow]) -> tuple[float, float]:
    ends = [end for row in found for end in (row.low, row.high, row.here or 0.0, *row.band)]
    low, high = _scaled(ends).min(), _scaled(ends).max()
    wide = high - low
    # Words stand to the right of all marks, and further numbers behind them.
    words = 0.0 if all(row.solid for row in found) else 0.2 if max(map(abs, ends)) <= FURTHEST else 0.55
    return float(low - 0.06 * wide), float(high + (0.06 + words) * wide)


def _abscissa(axes: Axes, lines: int) -> None:
    left, right = axes.get_xlim()
    ticks = TICKS if right - left < WIDE else TICKS[::2]
    units = [sign * tick for tick in ticks for sign in (-1, 1)]
    inside = sorted([0, *(unit for unit in units if left < _scaled(unit) < right)])
    at = _scaled(inside)
    axes.set_xticks(at, [f"{unit:+d}".replace("-", "−") if unit else "0" for unit in inside])
    axes.tick_params(axis="x", length=0)
    axes.set_xlabel("distance from the published value, in units of its last digit")
    ends = [(x, y) for x in at for y in (lines - 0.4, -0.6)]
    _strokes(axes, ends, color=GRID, lw=0.5, zorder=0.7)


def _band(axes: Axes, places: Sequence[tuple[float, ReachRow]]) -> None:
    """What prints as published: one band, for all that were shortened in the same way."""
    if len({row.band for _, row in places}) == 1:
        axes.axvspan(*_scaled(places[0][1].band), color=PALE, lw=0, zorder=0.5)
        return
    _boxes(axes, [(place, *row.band) for place, row in places], 0.5, color=PALE, lw=0, zorder=0.5)


def _boxes(axes: Axes, boxes: Sequence[tuple[float, float, float]], half: float, **style: Any) -> None:
    """Rectangles: their place, and where they begin and end."""
    for place, low, high in boxes:
        left, right = _scaled([low, high])
        axes.barh(place, right - left, 2 * half, left, **style)


def _strokes(axes: Axes, ends: Sequence[tuple[float, float]], **style: Any) -> None:
    """Lines: where each begins and where it ends."""
    for pair in zip(ends[::2], ends[1::2], strict=True):
        axes.plot(*zip(*pair, strict=True), **style)


def _bars(axes: Axes, places: Sequence[tuple[float, ReachRow]]) -> None:
    """Full where the published value is reachable, hollow where it is not; arrowheads where they go on."""
    solid = [(place, row.low, row.high) for place, row in places if row.solid]
    hollow = [(place, row.low, row.high) for place, row in places if not row.solid]
    _boxes(axes, solid, HALF, facecolor=UNLOADING, lw=0, zorder=2)
    _boxes(axes, hollow, HALF, facecolor="#ffffff", edgecolor=LOADING, lw=1.3, zorder=2)
    for place, row in places:
        colour = UNLOADING if row.solid else LOADING
        for end, marker in ((row.low, "<"), (row.high, ">")):
            if abs(end) > FURTHEST:
                axes.plot(_scaled([end]), [place], marker, ms=5, color=colour, clip_on=False, zorder=3)


def _marks(axes: Axes, places: Sequence[tuple[float, ReachRow]]) -> None:
    """A ring for the recomputed value, or an arrowhead beyond the scale; a cross on what is out of reach."""
    known = [(row.here, place) for place, row in places if row.here is not None]
    for units, place in known:
        if abs(units) > FURTHEST:
            marker = ">" if units > 0 else "<"
            axes.plot(_scaled([units]), [place], marker, ms=6, color=INK, clip_on=False, zorder=5)
    here = [(float(_scaled(units)), place) for units, place in known if abs(units) <= FURTHEST]
    if here:
        x, y = np.array(here).T
        drawing.dots(axes, x, y, 5.4, INK)
        drawing.dots(axes, x, y, 3.0, "#ffffff")
    across = (axes.get_xlim()[1] - axes.get_xlim()[0]) * 0.0085
    ends: list[tuple[float, float]] = []
    for place, row in places:
        if row.verdict == UNREACHABLE:
            middle = float(_scaled(sum(row.band) / 2))
            for way in (0.24, -0.24):
                ends += [(middle - across, place - way), (middle + across, place + way)]
    _strokes(axes, ends, color=LOADING, lw=1.8, zorder=4)


def _key(figure: Figure, places: Sequence[tuple[float, ReachRow]]) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list[Patch | Line2D] = [
        Patch(color=PALE, lw=0, label="prints as published"),
        Patch(color=UNLOADING, lw=0, label="reachable"),
        Line2D([], [], ls="", marker="o", ms=4.2, mfc="#ffffff", mec=INK, mew=1.2, label="recomputed"),
    ]
    if any(row.verdict == UNREACHABLE for _, row in places):
        handles.append(
            Line2D([], [], ls="", marker="x", ms=5, mew=1.8, color=LOADING, label="published, out of reach")
        )
    figure.legend(
        handles=handles, loc="outside upper left", ncols=len(handles), handlelength=1.3, columnspacing=1.5
    )
