"""What every drawing is made with: the page and its style, dots, arrowheads, labels that find room.

matplotlib is loaded when something is drawn, without pyplot: no window, no global state. Whatever a
user's matplotlibrc says is set back to matplotlib's own defaults. Fonts are the ones that matplotlib ships.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..charts import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
Place = tuple[float, float, str, str]
"""Offset from a point in points of print, and which side of the text stands there."""

CM = 1 / 2.54
WIDTH = 16 * CM
"""The text width of a page: drawn at the size it is printed, so that 9 pt stay 9 pt."""

GREY, PALE = "#767676", "#e4e4e4"
NEAR = 8.0
"""Points of print within which a text is seen to belong to a place."""

STYLE: dict[str, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "mathtext.fontset": "dejavusans",
    "axes.labelsize": 9,
    "axes.linewidth": 0.7,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.5,
    "hatch.linewidth": 0.6,
    "legend.fontsize": 8.5,
    "legend.frameon": False,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "path.simplify_threshold": 0.1,
}


@contextmanager
def styled() -> Iterator[None]:
    """Our settings over matplotlib's own, whatever the user's are."""
    import matplotlib

    own: dict[Any, Any] = dict(matplotlib.rcParamsDefault)
    settings = {key: value for key, value in own.items() if not key.startswith("backend")}
    with matplotlib.rc_context(settings | STYLE):
        yield


def page(height: float) -> tuple[Figure, Axes]:
    """An empty picture of the text's width and a height in centimetres."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    # 72 dots an inch, as SVG and PDF have: then all three formats get the same places and measures.
    figure = Figure(figsize=(WIDTH, height * CM), dpi=72, layout="constrained")
    FigureCanvasAgg(figure)  # it measures texts; saving brings the canvas of its own format
    axes = figure.add_subplot()
    axes.patch.set_visible(False)  # the page is white already
    return figure, axes


def settle(figure: Figure) -> None:
    """Lay the picture out, once for all: saving would do it again, twice."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            for line in axis.get_gridlines():
                line.set_clip_on(False)  # it ends at the frame anyway, and would say so in every line
    if figure.get_layout_engine() is not None:
        figure.draw_without_rendering()
        figure.set_layout_engine(None)


def empty(axes: Axes, sentence: str) -> None:
    """Say why there is nothing to see."""
    axes.set_axis_off()
    axes.text(0.5, 0.5, sentence, ha="center", va="center", transform=axes.transAxes, color=GREY)


def dots(axes: Axes, x: Array, y: Array, size: float, colour: str) -> None:
    """Round dots as one path: as markers they would take four times the bytes.

    A dot is a stroke of next to no length with round ends, along a logarithmic axis, too.
    """
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    if axes.get_xscale() == "log":
        step = x * math.expm1(1e-6 * (math.log(x.max() / x.min()) or 1.0))
    else:
        step = np.full_like(x, (float(np.ptp(x)) or float(np.abs(x).max())) * 1e-6)
    corners = np.stack([np.column_stack([x, y]), np.column_stack([x + step, y])], axis=1).reshape(-1, 2)
    path = Path(corners, np.tile(np.array([Path.MOVETO, Path.LINETO], dtype=np.uint8), len(x)))
    path.should_simplify = False
    stroke: dict[str, Any] = {"edgecolor": colour, "linewidth": size, "capstyle": "round"}
    axes.add_artist(PathPatch(path, fill=False, snap=False, zorder=2, **stroke))
    axes.update_datalim(corners[::2])  # the places alone: a single one would else be as wide as its stroke


def bars(axes: Axes, ends: Array, colour: str) -> None:
    """Lines between two ends each as one path, with the shape (2, bars, 2): of x and y those of every bar."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    corners = np.moveaxis(ends, 0, -1).reshape(-1, 2)
    path = Path(corners, np.tile(np.array([Path.MOVETO, Path.LINETO], dtype=np.uint8), ends.shape[1]))
    path.should_simplify = False
    axes.add_artist(PathPatch(path, fill=False, snap=False, zorder=1.9, edgecolor=colour, linewidth=0.8))


def arrowhead(axes: Axes, x: Array, y: Array, part: float, colour: str, *, back: bool) -> None:
    """An arrowhead on a curve at a part of its length, in the order of its points or against it."""
    n = int(part * (len(x) - 1))
    tail, head = (n + 1, n) if back else (n, n + 1)
    style = "-|>,head_width=0.28,head_length=0.6"
    shape = {"arrowstyle": style, "color": colour, "shrinkA": 0, "shrinkB": 0, "lw": 0.8}
    axes.annotate("", xy=(x[head], y[head]), xytext=(x[tail], y[tail]), arrowprops=shape)


class Labels:
    """Texts put where nothing else is: the first place that is free, or none.

    `figure` and `axes`: the picture with its limits set; its layout is fixed here, because only then are
    places known.
    """

    def __init__(self, figure: Figure, axes: Axes) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        settle(figure)
        self.axes = axes
        self.renderer = FigureCanvasAgg(figure).get_renderer()  # type: ignore[no-untyped-call]
        self.taken = np.empty((0, 4))

    def avoid(self, x: Array, y: Array, radius: float = 1.0) -> None:
        """Keep texts off these points of the data, by so many points of print."""
        at = self.axes.transData.transform(np.column_stack([x, y]))
        self.taken = np.vstack([self.taken, np.hstack([at - radius, at + radius])])

    def place(self, text: str, at: tuple[float, float], places: Sequence[Place], **style: Any) -> bool:
        """Write a text at the first free place beside a point of the data; say whether there was one.

        From a place that is not near, a line leads to the point.
        """
        from matplotlib.text import Text

        leader = {"arrowstyle": "-", "color": style.get("color", INK), "lw": 0.5, "shrinkA": 0, "shrinkB": 1}
        note = self.axes.annotate(
            text, at, (0, 0), textcoords="offset points", annotation_clip=False, arrowprops=leader, **style
        )
        frame = self.axes.get_window_extent(self.renderer)
        x0, y0, x1, y1 = self.taken.T
        for dx, dy, ha, va in places:
            note.set(position=(dx, dy), ha=ha, va=va)
            note.update_positions(self.renderer)
            box = Text.get_window_extent(note, self.renderer)  # an annotation's own would include its line
            inside = box.x0 >= frame.x0 and box.y0 >= frame.y0 and box.x1 <= frame.x1 and box.y1 <= frame.y1
            if inside and not ((x0 < box.x1) & (x1 > box.x0) & (y0 < box.y1) & (y1 > box.y0)).any():
                far = max(abs(dx), abs(dy)) > NEAR
                assert note.arrow_patch is not None
                note.arrow_patch.set_visible(far)
                self.taken = np.vstack([self.taken, box.extents])
                if far:
                    start = self.axes.transData.transform(at)
                    line = start + np.linspace(0, 1, 20)[:, None] * (np.array([dx, dy]))
                    self.taken = np.vstack([self.taken, np.hstack([line - 1, line + 1])])
                return True
        note.remove()
        return False
