"""Draws a declared chart with matplotlib; the page and the workbook draw theirs from the same declaration."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..cells.address import index_text
from ..cells.layout import evenly
from ..cells.values import Status
from ..charts import BARS, IN_A_ROW, INK, MOST_DOTS, MOST_GROUPS, MOST_PANELS, VERMILION, Chart, Series, shade
from ..document.charted import PREFIXES, Letters, Words, thinned
from ..quantity import behind
from ..result.numbers import rounded
from ..result.result import Report
from ..sheet import GroupAxis
from . import drawing
from .drawing import Array, Labels, Place

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

BESIDE_END: tuple[Place, ...] = (
    (5, -3, "left", "top"),
    (-4, 4, "right", "bottom"),
    (-6, 14, "right", "bottom"),
    (-8, 26, "right", "bottom"),
)
"""Where the name of a line may stand: right of its end, under it, else left above it.

The last two are far enough for a line to the end."""
AROUND: tuple[Place, ...] = (
    (0, -4, "center", "top"),
    (0, 4, "center", "bottom"),
    (5, 0, "left", "center"),
    (-5, 0, "right", "center"),
    (4, -3, "left", "top"),
    (-4, 3, "right", "bottom"),
    (-4, -3, "right", "top"),
    (4, 3, "left", "bottom"),
)
"""Where the name of a point may stand; it takes the first that is free."""

MOST_NAMES, SOME_NAMES = 21, 12
"""All of up to 21 points are named; of more the outermost, so that a name stays at its dot; of lines some."""
ROOM = 0.25
"""How far beyond what lines span the frame may go for the sake of points, in shares of it."""
CORNERS, FEWEST = 800, 12
"""Corners of all lines of a series together, and of each at least."""
LETTERS = 95
"""How many letters have room beside one another in a picture."""
LETTERS_UP = 4.5
"""How many have room upright, for each centimetre of its height."""
MARGINS = (0.06, 0.1)


# --- what there is to draw --------------------------------------------------------------------------------


@dataclass(frozen=True)
class Trace:
    """The points of a series, or of one row of the axis that is repeated.

    `at` has the shape (2, points), and so has `u`: what bars show, 0 where there is none.
    """

    labels: list[tuple[int, ...]]
    names: list[str]
    """What the points are called, or the row."""
    at: Array
    u: Array
    part: float
    """Which of all rows it is, from 0 to 1."""


def traces(
    words: Words, chart: Chart, series: Series, sizes: Sequence[tuple[float, float]]
) -> Iterator[Trace]:
    """What a series shows, in units of these sizes, and with these zeros."""
    if series.style == "level":
        return
    values, columns = words.plotted.values, (series.x, series.y)
    axis, of = values.sheet[series.x].axis, words.axis(series)
    assert axis is not None
    at = np.array(
        [(values.value[name] - zero) / size for name, (size, zero) in zip(columns, sizes, strict=True)]
    )
    known = words.report.uncertain().u if series.bars else {}
    us = [
        known.get(name, np.zeros(at.shape[1])) / size for name, (size, _) in zip(columns, sizes, strict=True)
    ]
    u = np.where(np.isfinite(us), us, 0.0)
    ok = np.all([values.status[name] == Status.OK for name in columns], axis=0)
    for letter in chart.log:
        ok &= at["xy".index(letter)] > 0
    layout, labels = values.layouts[axis.name], values.layouts[of.name].labels
    which = layout.rows[axis.index_name] * 0 if of is axis else layout.rows[of.index_name]
    for row in np.unique(which[ok]):
        here = np.flatnonzero(ok & (which == row))
        named = labels[here] if of is axis else labels[[row]]
        own = [tuple(label) for label in named.tolist()]
        part = float(row) / max(1, len(labels) - 1)
        yield Trace(own, [words.called(of, label) for label in own], at[:, here], u[:, here], part)


def _units(words: Words, chart: Chart) -> list[tuple[str, float, float]]:
    """The unit of each axis, its size and zero: a multiple of the newton, if that keeps its numbers short."""
    found = []
    for scale, names in zip(
        words.scales(chart), ([s.x for s in chart.series], [s.y for s in chart.series]), strict=True
    ):
        largest = max(float(np.nanmax(np.abs([*words.plotted.values.value[n], 0.0]))) for n in names)
        sign, size = next((one for one in PREFIXES if largest >= one[1]), PREFIXES[-1])
        found.append(
            (sign + scale.unit, size, 0.0) if scale.prefixed else (scale.unit, scale.size, scale.zero)
        )
    return found


def _bars(at: Array, u: Array) -> Array:
    """Both ends of the bars through points, in x and then in y, with the shape (2, bars, 2)."""
    beside = [(at[:, u[n] > 0], u[:, u[n] > 0] * np.eye(2)[n][:, None]) for n in (0, 1)]
    return np.concatenate([np.stack([to - far, to + far], axis=-1) for to, far in beside], axis=1)


class Frame:
    """The ends of both axes, which have room for the ends of bars, and which points they leave out."""

    def __init__(self, chart: Chart, lines: Array, dots: Array, bars: Array) -> None:
        self.log, self.whole = [axis in chart.log for axis in "xy"], chart.whole
        self.allowed = [self._allowed(lines, dots, n) for n in (0, 1)]
        for n in (0, 1):
            bars = bars[:, bars[n] > 0] if self.log[n] else bars
        seen = np.hstack([lines, dots[:, self.holds(dots)], bars[:, self.holds(bars)]])
        self.ends = [self._ends(chart, seen, n) for n in (0, 1)]

    def flat(self, at: Array, n: int) -> Array:
        """One of both coordinates as the axis has it."""
        return np.asarray(np.log10(at[n]) if self.log[n] else at[n])

    def _allowed(self, lines: Array, dots: Array, n: int) -> tuple[float, float]:
        """Between which values a point is drawn where it is: others must not shrink to nothing for it."""
        if self.whole:
            return -np.inf, np.inf
        if lines.size:
            low, high = np.quantile(self.flat(lines, n), [0, 1])
            reach = ROOM * (high - low)
        else:
            # Five times the distance of the quartiles, three times as far as a box plot's whiskers reach.
            low, high = np.quantile(self.flat(dots, n), [0.25, 0.75])
            reach = (n and 5 * (high - low)) or np.inf
        return low - reach, high + reach

    def _ends(self, chart: Chart, seen: Array, n: int) -> tuple[float, float]:
        low, high = np.quantile(self.flat(seen, n), [0, 1])
        room = MARGINS[n] * (high - low or 0.1 * abs(high) or 1.0)
        if self.log[n]:
            return float(10 ** (low - room)), float(10 ** (high + room))
        return 0.0 if chart.from_zero and low >= 0 else float(low - room), float(high + room)

    def holds(self, at: Array) -> NDArray[np.bool_]:
        """Which points are drawn where they are."""
        (left, right), (bottom, top) = self.allowed
        x, y = self.flat(at, 0), self.flat(at, 1)
        return np.asarray((left <= x) & (x <= right) & (bottom <= y) & (y <= top))


# --- how it is drawn --------------------------------------------------------------------------------------


def draw(report: Report, chart: Chart) -> Figure:
    """Draw a chart of a report."""
    words = Words(report)
    units = _units(words, chart)
    found = [
        list(traces(words, chart, series, [(size, zero) for _, size, zero in units]))
        for series in chart.series
    ]
    if chart.panels and any(found):
        return _panels(words, chart, [unit for unit, *_ in units], found)
    figure, axes = drawing.page(chart.height)
    if not any(found):
        drawing.empty(axes, "Nothing to draw: the cells that it shows have no value.")
        return figure
    for axis, scale, (unit, *_) in zip("xy", words.scales(chart), units, strict=True):
        axes.set(
            **{
                f"{axis}label": _titled(mathtext(scale.titled(unit)), axis, chart.height),
                f"{axis}scale": "log" if axis in chart.log else "linear",
            }
        )
    _Picture(words, chart, units[1], figure, axes, found).draw()
    return figure


def _panels(words: Words, chart: Chart, units: list[str], found: list[list[Trace]]) -> Figure:
    """Draw a panel for each row of the axis that is repeated, of many for some."""
    from matplotlib.lines import Line2D

    rows = sorted({tuple(trace.labels[0]) for own in found for trace in own})
    shown = [rows[n] for n in evenly(len(rows), MOST_PANELS)]
    across, down = min(len(shown), IN_A_ROW), -(-len(shown) // IN_A_ROW)
    figure, whole = drawing.page(1.5 + chart.height * down)
    whole.remove()
    every = figure.subplots(down, across, sharex=True, sharey=True, squeeze=False).ravel().tolist()
    panels, spare = every[: len(shown)], every[len(shown) :]
    for panel, row in zip(panels, shown, strict=True):
        panel.set_title(f"{words.axis(chart.series[0]).row} {index_text(row)}", fontsize=9)
        panel.grid(visible=True)
        for series, own in zip(chart.series, found, strict=True):
            for trace in own:
                if tuple(trace.labels[0]) == row:
                    _line(panel, trace.at, series.colour, 1.2)
    for panel in spare:
        panel.remove()
    for panel in panels[-across:]:  # above a place that stays empty, too
        panel.tick_params(labelbottom=True)
    if chart.from_zero:
        panels[0].set(xlim=(0, None), ylim=(0, None))
    for axis, scale, unit in zip("xy", words.scales(chart), units, strict=True):
        getattr(figure, f"sup{axis}label")(mathtext(scale.titled(unit)), fontsize=9)
    keys = {mathtext(words.label(s)): s.colour for s, own in zip(chart.series, found, strict=True) if own}
    handles = [Line2D([], [], color=colour, label=label) for label, colour in keys.items()]
    figure.legend(handles=handles, loc="outside upper left", ncols=3, handlelength=1.5, columnspacing=1)
    return figure


def _line(axes: Axes, at: Array, colour: str, width: float) -> None:
    """Draw a line; one that leads nowhere to the side, as of a single point, has dots, too."""
    axes.plot(*at, color=colour, lw=width, zorder=2.5, marker="None" if np.ptp(at[0]) else ".", ms=4)


def mathtext(letters: Letters) -> str:
    r"""As matplotlib writes it.

    >>> mathtext((("", "force "), ("i", "F"), ("_", "m")))
    'force $F_{m}$'
    """
    text = ""
    for kind, piece in letters:
        safe = re.sub(r"[{}_^$%#&\\]", r"\\\g<0>", piece)
        text += f"${safe}$" if kind == "i" else f"${kind}{{{safe}}}$" if kind else piece.replace("$", r"\$")
    return text.replace("$$", "")


def _in_columns(texts: Sequence[str]) -> int:
    """In how many columns the entries of a legend have room, which it fills one after the other."""

    def room(ncols: int) -> int:
        """In letters; a sign before each text is as wide as four."""
        return sum(4 + max(map(len, column)) for column in np.array_split(texts, ncols))

    return next((ncols for ncols in (len(texts), 2) if room(ncols) < LETTERS), 1)


def _titled(text: str, axis: str, height: float) -> str:
    """The title of an axis in lines that are no longer than the axis."""
    most = LETTERS if axis == "x" else round(LETTERS_UP * height)
    return "\n".join(wrap(text, most, break_long_words=False, break_on_hyphens=False))


class _Picture:
    """A chart being drawn; all numbers are in the units of its axes."""

    def __init__(
        self,
        words: Words,
        chart: Chart,
        up: tuple[str, float, float],
        figure: Figure,
        axes: Axes,
        found: list[list[Trace]],
    ) -> None:
        self.words, self.up, self.figure, self.axes, self.zero = words, up, figure, axes, chart.zero
        self.found = list(zip(chart.series, found, strict=True))
        lines, dots = (
            np.hstack([np.empty((2, 0)), *(t.at for s, own in self.found if s.style == style for t in own)])
            for style in ("line", "points")
        )
        ends = [_bars(t.at, t.u).reshape(2, -1) for s, own in self.found if s.bars for t in own]
        self.frame = Frame(chart, lines, dots, np.hstack([np.empty((2, 0)), *ends]))
        axes.set(xlim=self.frame.ends[0], ylim=self.frame.ends[1])
        if axes.get_xscale() == "linear":
            written = axes.xaxis.get_major_formatter().format_ticks(list(axes.get_xticks()))
            if max(map(len, written), default=0) > 6:  # of numbers that are nearly the same
                axes.locator_params(axis="x", nbins=4)
        self.keys: list[Line2D] = []
        self.taken: list[tuple[Array, float]] = []
        self.names: list[tuple[str, list[tuple[Array, Sequence[Place]]], dict[str, Any]]] = []

    def draw(self) -> None:
        """Draw all series, then what names them where there is room."""
        self.axes.grid(visible=True)
        if self.zero and self.frame.ends[1][0] < 0 < self.frame.ends[1][1]:
            self.axes.axhline(0, color=INK, lw=0.7, zorder=1.5)
        for series, own in self.found:
            if series.style == "level":
                self.level(series)
            elif own:
                (self.points if series.style == "points" else self.lines)(series, own)
        if len(self.keys) > 1 or any(key.get_marker() in ("^", "v") for key in self.keys):
            ncols = _in_columns([str(key.get_label()) for key in self.keys])
            self.figure.legend(
                handles=self.keys, loc="outside upper left", ncols=ncols, handlelength=1.5, columnspacing=1
            )
        labels = Labels(self.figure, self.axes)
        for at, radius in self.taken:
            labels.avoid(at[0], at[1], radius)
        for text, places, style in self.names:
            any(labels.place(text, (float(x), float(y)), beside, **style) for (x, y), beside in places)

    def key(self, series: Series, count: int, more: str = "", word: str = "", **looks: Any) -> None:
        """An entry of the legend, which stands above the picture, where nothing can be covered."""
        from matplotlib.lines import Line2D

        rows = "%s" if series.each else self.words.count(series, count)
        value = self.words.value(series.value) if series.value else ""
        label: Letters = (("", word),) if word else self.words.label(series, rows)
        text = mathtext((*label, ("", more + value)))
        if all(key.get_label() != text for key in self.keys):  # both sides of a band are one
            self.keys.append(Line2D([], [], label=text, **looks))

    def points(self, series: Series, own: list[Trace], word: str = "") -> None:
        """Dots, thinned if they are many; what is outside of the frame is counted, and marked if named."""
        from matplotlib.lines import Line2D

        if series.by:
            few = len(own) <= MOST_GROUPS
            for trace in own:
                alone = replace(series, by="", colour=shade(trace.part))
                self.points(alone, [trace], trace.names[0] if few else "")
            self.keys.sort(key=lambda key: key.get_label() == BARS)
            return
        at = np.hstack([trace.at for trace in own])
        total = at.shape[1]
        outermost = np.argsort(-np.abs(at[1] - np.median(at[1])), kind="stable")
        inside = self.frame.holds(at)
        within, beyond = np.flatnonzero(inside), outermost[~inside[outermost]][:SOME_NAMES]
        shown = within[evenly(len(within), MOST_DOTS)]
        size = 4.5 if total <= MOST_NAMES else 2.6
        more = thinned(len(within), len(shown))
        if series.named:
            named = outermost[: None if total <= MOST_NAMES else SOME_NAMES]
            shown = np.union1d(shown, named[inside[named]])
        elif len(within) < total:
            out = total - len(within)
            more += f"; {out} of {total} {'lies' if out == 1 else 'lie'} outside"
        ends = _bars(at[:, shown], np.hstack([trace.u for trace in own])[:, shown])
        if ends.size:
            low, high = np.transpose(self.frame.ends)[:, :, None, None]
            ends = np.clip(ends, low, high)
            drawing.bars(self.axes, ends, series.colour)
            along = np.linspace(ends[..., 0], ends[..., 1], 20, axis=-1)
            self.taken.append((along.reshape(2, -1), 1.0))
        if len(shown):  # all may lie outside
            drawing.dots(self.axes, at[0, shown], at[1, shown], size, series.colour)
        self.taken.append((at[:, shown], size / 2 + 0.75 if series.named else 1.0))
        count = total if series.named else len(own)
        self.key(series, count, more, word, ls="", marker="o", ms=min(size, 2.4), color=series.colour)
        if ends.size and BARS not in (key.get_label() for key in self.keys):
            self.keys.append(Line2D([], [], ls="", marker="|", ms=7, color=series.colour, label=BARS))
        if series.named:
            self.edge(at, beyond, f"outside the frame: {total - len(within)} of {total}")
            self.name(series, own, at, named, beyond)

    def edge(self, at: Array, beyond: NDArray[np.intp], told: str) -> None:
        """Triangles at the edges towards points that are outside."""
        (left, right), (bottom, top) = self.frame.ends
        for x, y in at[:, beyond].T:
            marker = "^" if y > top else "v" if y < bottom else ">" if x > right else "<"
            place = np.clip(x, left, right), np.clip(y, bottom, top)
            self.axes.plot(*place, marker, ms=5, color=VERMILION, clip_on=False, zorder=3)
        if len(beyond):
            self.outside(told, "^")

    def outside(self, told: str, marker: str) -> None:
        """Say above the picture what lies outside of it."""
        from matplotlib.lines import Line2D

        self.keys.append(Line2D([], [], ls="", marker=marker, ms=5, color=VERMILION, label=told))

    def name(
        self, series: Series, own: list[Trace], at: Array, named: NDArray[np.intp], beyond: NDArray[np.intp]
    ) -> None:
        """The names of points; the triangle at the edge says where one is, the text how far."""
        names, report = [name for trace in own for name in trace.names], self.words.report
        labels = [label for trace in own for label in trace.labels]
        held = np.clip(at.T, *np.transpose(self.frame.ends))
        for n in named:
            far, text = n in beyond, mathtext((("", names[n]),))
            if far:
                cell = report.values.cell(series.y, labels[n]) if series.y in report.sheet else None
                plain = rounded(float(at[1, n]), 2).text + behind(self.up[0])
                text += f": {report.text(cell) if cell else plain}"
            self.names.append((text, [(held[n], AROUND[:2] if far else AROUND)], {"fontsize": 8.5}))

    def lines(self, series: Series, own: list[Trace]) -> None:
        """One line, or one for each row, from the lowest end upwards."""
        if not series.each:
            at = np.hstack([trace.at for trace in own])
            if len(own) > 1:
                at = at[:, np.argsort(at[0], kind="stable")]
            self.line(at[:, evenly(at.shape[1], CORNERS)], series.colour, 1.1)
            self.key(series, len(own), color=series.colour, lw=1.1)
            return
        corners, width = max(FEWEST, CORNERS // len(own)), 1.4 if len(own) <= SOME_NAMES else 0.8
        ways = [(t.names[0], t.at[:, evenly(t.at.shape[1], corners)]) for t in own]
        ways.sort(key=lambda way: (float(way[1][1, -1]), way[0]))
        colours = [shade(n / max(1, len(ways) - 1)) for n in range(len(ways))]
        if isinstance(self.words.axis(series), GroupAxis):  # as its points
            of = {trace.names[0]: shade(trace.part) for trace in own}
            colours = [of[name] for name, _ in ways]
        for (_, at), colour in zip(ways, colours, strict=True):
            self.line(at, colour, width)
        for n in evenly(len(ways), SOME_NAMES)[::-1]:
            name = mathtext((("", ways[n][0]),))
            self.names.append((name, [(ways[n][1][:, -1], BESIDE_END)], {"color": colours[n]}))
        self.key(series, len(own), color=colours[len(colours) // 2], lw=1.4)

    def line(self, at: Array, colour: str, width: float) -> None:
        """Draw a line and keep texts off it."""
        _line(self.axes, at, colour, width)
        self.taken.append((at, 1.0))

    def level(self, series: Series) -> None:
        """A single number as a line over the whole width, named at an end that is free."""
        _, size, zero = self.up
        value = (self.words.plotted.values.scalar(series.y) - zero) / size
        (left, right), (bottom, top) = self.frame.ends
        text = mathtext((*self.words.label(series), ("", self.words.value(series.y))))
        if not bottom <= value <= top:
            if math.isfinite(value):
                self.outside(f"{text}, outside the frame", "^" if value > top else "v")
            return
        self.axes.axhline(value, color=series.colour, lw=1.0, ls=(0, (5, 3)), zorder=1.5)
        self.taken.append((np.linspace([left, value], [right, value], 200).T, 1.0))
        ends: list[tuple[Array, Sequence[Place]]] = [
            (np.array([x, value]), ((dx, 3, side, "bottom"), (dx, -3, side, "top")))
            for x, dx, side in ((left, 4, "left"), (right, -4, "right"))
        ]
        self.names.insert(0, (text, ends, {}))
