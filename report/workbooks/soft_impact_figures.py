"""The drawings of the soft-impact paper's data: figure 4, and the exponent of every pair."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..charts import Curve
from ..document.numbers import rounded
from ..result.result import Report, Shown
from ..views import drawing
from ..views.drawing import INK, LOADING, UNLOADING, Array, Labels, Place

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_alpha_pairs", "draw_loops"]


def _curves(report: Report, figure: str) -> dict[str, list[Curve]]:
    """A figure's curves by their role."""
    roles: dict[str, list[Curve]] = {}
    for curve in report.curves:
        if curve.figure == figure:
            roles.setdefault(curve.role, []).append(curve)
    return roles


def _joined(
    curves: Sequence[Curve], x: float, y: float = 1.0, most: int | None = None
) -> tuple[Array, Array]:
    """The points of several curves, in units of these sizes; of each curve at most so many."""
    rows = [drawing.evenly(len(c.x), most or len(c.x)) for c in curves]
    all_x = np.concatenate([c.x[some] for c, some in zip(curves, rows, strict=True)])
    all_y = np.concatenate([c.y[some] for c, some in zip(curves, rows, strict=True)])
    return all_x / x, all_y / y


def _number(value: float, shown: Shown) -> str:
    return rounded(value / shown.scale, shown.digits).text


MOST_DOTS = 500
"""More are thinned: they would blacken the paper and bloat the file."""

ROOM = 1.25
"""How far beyond the largest loop the frame may go for the sake of generated points."""

MOST_CORNERS = 32
"""Corners of a curve: a smooth one is then right to a tenth of a point."""


# --- figure 4 -----------------------------------------------------------------------------------------------

BESIDE_TIP: tuple[Place, ...] = (
    (5, -3, "left", "top"),
    (-4, 4, "right", "bottom"),
    (-6, 14, "right", "bottom"),
    (-8, 26, "right", "bottom"),
)
"""Where the number of a test may stand: right of its loop's tip, under the curve, else left above it.

The last two are far enough for a line to the tip."""


MOST_NUMBERS = 12
"""Tests whose numbers are written; of more, so many from the smallest loop to the largest."""


def draw_loops(report: Report) -> Figure:
    """Generated points, the fitted compression curve, and every test's way back."""
    from matplotlib import colormaps

    figure, axes = drawing.page(10)
    roles = _curves(report, "loops")
    if "compression" not in roles:
        drawing.empty(axes, "No loop to draw: there is no fit, or no test whose loop it closes.")
        return figure
    (fit,), points = roles["compression"], roles["points"]
    back = sorted(roles["restitution"], key=lambda c: (float(c.y[-1]), c.label))
    depth = report.shown["x_m"]
    force, newtons = drawing.newtons(max(float(c.y.max()) for c in (fit, *points)))
    all_x, all_y = _joined(points, depth.scale, newtons)
    fit_x, fit_y = _joined([fit], depth.scale, newtons)
    corners = min(MOST_CORNERS, max(12, 800 // len(back)))
    ways = [_joined([curve], depth.scale, newtons, corners) for curve in back]
    # The points of a pair that is far off the others must not shrink the loops to nothing.
    right, top = (min(float(a.max()), ROOM * float(f.max())) for a, f in ((all_x, fit_x), (all_y, fit_y)))
    within = np.flatnonzero((all_x <= right) & (all_y <= top))
    shown = within[drawing.evenly(len(within), MOST_DOTS)]
    x, y = all_x[shown], all_y[shown]
    # From dark to middling: the order of the tests is an order of greys as well.
    colours = [colormaps["viridis"](0.58 * n / max(1, len(back) - 1)) for n in range(len(back))]

    drawing.dots(axes, x, y, 2.6, LOADING)
    for (way_x, way_y), colour in zip(ways, colours, strict=True):
        axes.plot(way_x, way_y, color=colour, lw=1.4 if len(back) <= 12 else 0.8, zorder=2.5)
    axes.plot(fit_x, fit_y, color=INK, lw=1.1, zorder=3)
    axes.set_xlim(0, 1.05 * max(right, float(fit_x.max())))
    axes.set_ylim(0, 1.06 * max(top, float(fit_y.max())))
    axes.set_xlabel(f"approach $x$ / {drawing.unit_text(depth.unit)}")
    axes.set_ylabel(f"force $F$ / {force}")
    axes.grid(visible=True)
    named = f"points of {len(points)} pairs" if len(points) > 1 else "points of the pair"
    if len(shown) < len(within):
        named += f", one in {round(len(within) / len(shown))} drawn"
    if len(within) < len(all_x):
        named += f"; {len(all_x) - len(within)} of {len(all_x)} lie outside"
    _key(figure, report, named, colours[len(colours) // 2])

    labels = Labels(figure, axes)
    for drawn in ((x, y), (fit_x, fit_y), *ways):
        labels.avoid(*drawn)
    for n in drawing.evenly(len(back), MOST_NUMBERS)[::-1]:
        tip = float(ways[n][0][-1]), float(ways[n][1][-1])
        labels.place(back[n].label, tip, BESIDE_TIP, color=colours[n])
    return figure


def _key(figure: Figure, report: Report, points: str, colour: Any) -> None:
    """What the three kinds of marks are, above the picture, where nothing can be covered."""
    from matplotlib.lines import Line2D

    exponent = _number(report.values.scalar("alpha_log"), report.shown["alpha_log"])
    figure.legend(
        handles=[
            Line2D([], [], ls="", marker="o", ms=2.4, color=LOADING, label=points),
            Line2D([], [], color=INK, lw=1.1, label=rf"compression fitted to them, $\alpha$ = {exponent}"),
            Line2D([], [], color=colour, lw=1.4, label="restitution of each test"),
        ],
        loc="outside upper left",
        ncols=3 if len(points) < 25 else 2 if len(points) < 48 else 1,
        handlelength=1.5,
        columnspacing=1.5,
    )


# --- the exponent of every pair -----------------------------------------------------------------------------

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
"""Where the name of a pair may stand; it takes the first that is free."""

MOST_NAMES, SOME_NAMES = 21, 12
"""All pairs of up to seven tests are named; of more only the outermost, so that a name stays at its dot."""


def draw_alpha_pairs(report: Report) -> Figure:
    """Every pair's exponent over its mean speed."""
    from matplotlib.lines import Line2D

    figure, axes = drawing.page(8)
    roles = _curves(report, "alpha_pairs")
    if "pair" not in roles:
        drawing.empty(axes, "No exponent to draw: every pair is in error.")
        return figure
    pairs, speed = roles["pair"], report.shown["v"]
    few = len(pairs) <= MOST_NAMES
    x, y = _joined(pairs, speed.scale)
    low, high = _fences(y)
    outermost = np.argsort(-np.abs(y - np.median(y)), kind="stable")
    # However many are thinned out, none of those that are named may be missing.
    drawn = np.union1d(drawing.evenly(len(x), MOST_DOTS), outermost[:SOME_NAMES])
    beyond = drawn[(y[drawn] < low) | (y[drawn] > high)]
    inside = np.setdiff1d(drawn, beyond)
    drawing.dots(axes, x[inside], y[inside], 4.5 if few else 2.2, UNLOADING)
    axes.margins(0.06, 0.1)
    axes.autoscale_view()
    axes.set_xlim(axes.get_xlim())
    edges = axes.set_ylim(axes.get_ylim())
    outside = int(np.count_nonzero((y < low) | (y > high)))
    if outside:
        mark = Line2D(
            [], [], ls="", marker="^", ms=5, color=LOADING, label=f"outside the frame: {outside} of {len(y)}"
        )
        figure.legend(handles=[mark], loc="outside upper right", handlelength=1)
    held = np.clip(y, *edges)
    for sign, marker, edge in ((-1, "v", edges[0]), (1, "^", edges[1])):
        there = beyond[np.sign(y[beyond] - np.median(y)) == sign]
        axes.plot(x[there], np.full(len(there), edge), marker, ms=5, color=LOADING, clip_on=False, zorder=3)
    axes.set_xlabel(f"mean impact speed of the pair / {drawing.unit_text(speed.unit)}")
    axes.set_ylabel(r"exponent $\alpha$ of the pair")
    axes.grid(visible=True)

    labels = Labels(figure, axes)
    labels.avoid(x[drawn], held[drawn], radius=3.0)
    if "mean" in roles:
        _mean(axes, labels, float(roles["mean"][0].y[0]), report.shown["alpha_mean"])
    for n in outermost[: None if few else SOME_NAMES]:
        name = pairs[n].label.replace("-", "–")
        if n in beyond:  # the triangle at the edge says where, the text how far
            name += f": {_number(float(y[n]), report.shown['alpha'])}"
        places = AROUND[:2] if n in beyond else AROUND
        labels.place(name, (float(x[n]), float(held[n])), places, fontsize=8.5)
    return figure


def _fences(y: Array) -> tuple[float, float]:
    """Beyond these an exponent is marked at the edge: two tests at nearly one speed may give any.

    Five times the distance of the quartiles, three times as far as a box plot's whiskers reach.
    """
    low, high = np.quantile(y, [0.25, 0.75])
    reach = 5 * (high - low) or np.inf
    return float(low - reach), float(high + reach)


def _mean(axes: Axes, labels: Labels, mean: float, shown: Shown) -> None:
    """The mean as a line over the whole width, named at an end that is free."""
    axes.axhline(mean, color=INK, lw=1.0, ls=(0, (5, 3)), zorder=1.5)
    low, high = axes.get_xlim()
    labels.avoid(np.linspace(low, high, 200), np.full(200, mean))
    text = f"mean {_number(mean, shown)}"
    for end, inwards, side in ((low, 4, "left"), (high, -4, "right")):
        if labels.place(text, (end, mean), ((inwards, 3, side, "bottom"), (inwards, -3, side, "top"))):
            return
