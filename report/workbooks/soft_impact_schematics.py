"""The schematic drawings of the soft-impact paper, its figures 1 and 2, in reduced units: x/x_m and F/F_m.

No force law is typed here: the branches are those of (2) and (3) in the derivations, with numbers that are
chosen for the eye. In figure 1 the loop without friction is (3); how friction widens it is an illustration of
this project, not a published law: while loading it adds, while unloading it takes away, a share of the force
that dies out with the speed towards the maximum approach.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...derivations import soft_impact as model
from ...derivations.rebuilt import evaluated
from ..cells.layout import evenly
from ..charts import BLUE as UNLOADING
from ..charts import INK
from ..charts import VERMILION as LOADING
from ..engines.numpy_code import kernel
from ..result.result import Report
from ..views import drawing
from ..views.drawing import GREY, PALE, Array, Place

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from sympy import Expr

SCHEMATIC = {"alpha": 1.3, "beta": 1.5, "x_m": 1.0, "x_p": 0.55, "Cprime": 1.0}
"""What the schematic figures assume, in reduced units; any test of a soft target looks like it."""

FRICTION = 0.35
"""The largest share of the force that friction has in figure 1: large enough to be seen."""


SAMPLES = 201
"""Abscissae of a curve. A polyline through so many is smooth to a tenth of a point in print."""
MOST_CORNERS = 32
"""Corners of the edge of an area."""


class Branch(NamedTuple):
    """A branch of a loop."""

    x: Array
    y: Array


def force(law: Expr, x: Array, **constants: float) -> Array:
    """The force of a branch of a law of the derivations at each approach, printed by the NumPy engine."""
    made = kernel([evaluated(law)])
    known = {"x": x, **SCHEMATIC, **constants}
    (found,) = made.run(*(known[name] for name in made.arguments))
    return np.asarray(found, dtype=np.float64)


def _closed(compression: Expr, restitution: Expr, x: Array, back: Array) -> tuple[Branch, Branch]:
    """Both branches with the constants of `SCHEMATIC`; the coefficient is the one that closes the loop."""
    end = np.array([SCHEMATIC["x_m"]])
    coefficient = float(force(restitution, end)[0] / force(compression, end, C=1.0)[0])
    return Branch(x, force(compression, x, C=coefficient)), Branch(back, force(restitution, back))


def lankarani() -> tuple[Branch, Branch]:
    """Equation (2): both branches as they stand in its cases."""
    # The author's own form: evaluated, the cases lose the second, whose domain lies in the first's.
    up, down = (case.expr.xreplace({model.C_LN: model.C}) for case in model.eq2.members[-1].args)
    x_m, x_p = SCHEMATIC["x_m"], SCHEMATIC["x_p"]
    return _closed(up, down, np.linspace(0.0, x_m, SAMPLES), np.linspace(x_p, x_m, SAMPLES))


def hysteresis() -> tuple[Branch, Branch, Branch, Branch]:
    """Equation (3) up and down without friction, and the loop that friction widens."""
    x_m, x_p = SCHEMATIC["x_m"], SCHEMATIC["x_p"]
    # Denser towards x_m, where the loop with friction turns round.
    s = np.sin(np.linspace(0.0, np.pi / 2, SAMPLES))
    x, back = s * x_m, x_p + s * (x_m - x_p)
    up, down = _closed(model.law_c.value, model.law_r.value, x, back)
    share = _friction_share(s)
    return up, down, Branch(x, up.y * (1 + share)), Branch(back, down.y * (1 - share))


def _friction_share(s: Array) -> Array:
    """What share of the force is friction at the part `s` of the way to the maximum approach.

    An illustration, not a law of the paper: it follows the speed of a body on a linear spring, so that it
    vanishes where the bodies are at rest and the loop stays closed.
    """
    return FRICTION * np.sqrt(np.clip(1 - s**2, 0.0, 1.0))


# --- the drawings ----------------------------------------------------------------------------------------


def _schematic(height: float, x_p: float, x_m: float, right: float, top: float) -> tuple[Figure, Axes]:
    """Axes without numbers, with the imprint depth and the maximum approach marked."""
    figure, axes = drawing.page(height)
    axes.set_xlim(0, right)
    axes.set_ylim(0, top)
    axes.set_xticks([0, x_p, x_m], ["0", "$x_p$", "$x_m$"])
    axes.set_yticks([])
    axes.set_xlabel("approach $x$")
    axes.set_ylabel("force $F$")
    return figure, axes


def draw_lankarani(_: Report) -> Figure:
    """Equation (2), up one branch and down the other."""
    up, down = lankarani()
    x_p, x_m, peak = float(down.x[0]), float(down.x[-1]), float(down.y[-1])
    figure, axes = _schematic(7.5, x_p, x_m, 1.2 * x_m, 1.12 * peak)
    axes.set_yticks([0, peak], ["0", "$C'$"])
    axes.plot([x_m, x_m, 0], [0, peak, peak], color=GREY, lw=0.7, ls=(0, (4, 3)))
    for curve, colour, back, dashes in ((up, LOADING, False, "-"), (down, UNLOADING, True, (0, (6, 1.5)))):
        axes.plot(curve.x, curve.y, color=colour, lw=1.8, ls=dashes, clip_on=False, zorder=3)
        drawing.arrowhead(axes, curve.x, curve.y, 0.62, colour, back=back)
    _name(axes, up, 0.55, "compression", (-8, 4, "right", "bottom"), LOADING)
    _name(axes, down, 0.4, "restitution", (8, -6, "left", "top"), UNLOADING)
    return figure


def _name(axes: Axes, curve: Branch, part: float, text: str, place: Place, colour: str) -> None:
    """Write a curve's name beside it."""
    n = int(part * (len(curve.x) - 1))
    dx, dy, ha, va = place
    at = (float(curve.x[n]), float(curve.y[n]))
    axes.annotate(text, at, (dx, dy), textcoords="offset points", ha=ha, va=va, color=colour)


def draw_hysteresis(_: Report) -> Figure:
    """The loop with friction round the loop without, and the three works between them."""
    up, down, loading, unloading = hysteresis()
    x_p, x_m = float(down.x[0]), float(down.x[-1])
    figure, axes = _schematic(8, x_p, x_m, 1.3 * x_m, 1.08 * float(loading.y.max()))
    some = evenly(len(up.x), MOST_CORNERS)
    plastic = np.append(up.x[some], down.x[some][::-1]), np.append(up.y[some], down.y[some][::-1])
    axes.fill(*plastic, color=PALE, lw=0)
    # With and without friction the abscissae are the same.
    for inner, outer, colour, hatch in (
        (up, loading, LOADING, "////"),
        (down, unloading, UNLOADING, r"\\\\"),
    ):
        low, high = inner.y[some], outer.y[some]
        axes.fill_between(inner.x[some], low, high, facecolor="none", edgecolor=colour, hatch=hatch, lw=0)
    for curve in (up, down):
        axes.plot(curve.x, curve.y, color=INK, lw=0.9, ls=(0, (4, 2)))
    for curve, colour, back in ((loading, LOADING, False), (unloading, UNLOADING, True)):
        axes.plot(curve.x, curve.y, color=colour, lw=1.8, clip_on=False, zorder=3)
        drawing.arrowhead(axes, curve.x, curve.y, 0.45, colour, back=back)
    _area(axes, "$W_c$: internal friction\nwhile loading", _middle(up, loading, 0.4), (-74, 34), LOADING)
    _area(
        axes,
        "$W_r$: internal friction\nwhile unloading",
        _middle(down, unloading, 0.55),
        (84, -14),
        UNLOADING,
    )
    _area(axes, "$W_p$: plastic\ndeformation", (x_p, 0.24 * float(up.y.max())), None, INK)
    return figure


def _middle(inner: Branch, outer: Branch, part: float) -> tuple[float, float]:
    """A point half-way between two curves of the same abscissae."""
    n = int(part * (len(inner.x) - 1))
    return float(inner.x[n]), float(inner.y[n] + outer.y[n]) / 2


def _area(
    axes: Axes, text: str, at: tuple[float, float], offset: tuple[float, float] | None, colour: str
) -> None:
    """Name an area, in it or from outside with a line to it."""
    if offset is None:
        axes.text(*at, text, ha="center", va="center", color=colour)
        return
    line = {"arrowstyle": "-", "color": colour, "lw": 0.7, "shrinkA": 1, "shrinkB": 0}
    axes.annotate(
        text, at, offset, textcoords="offset points", ha="center", va="center", color=colour, arrowprops=line
    )
