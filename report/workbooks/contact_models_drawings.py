"""The loops of all contact models, a panel for each test: a picture to compare them in."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...derivations.contact.models import MODELS
from ..cells.layout import evenly
from ..cells.values import Status
from ..document.charted import unit_text
from ..result.result import Plotted, Report
from ..views import drawing
from .contact_models_charts import COLOUR_OF

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy import bool_
    from numpy.typing import NDArray

__all__ = ["draw_loops"]

_MOST, _IN_A_ROW = 9, 3
"""Panels of a picture; of more tests some are drawn, evenly."""


def draw_loops(report: Report) -> Figure:
    """The loops of all models, a panel for each test, on common axes."""
    from matplotlib.lines import Line2D

    plotted = report.plotted()
    layout = plotted.values.layouts["loops"]
    tests = evenly(report.values.layouts["tests"].size, _MOST)
    rows = -(-len(tests) // _IN_A_ROW)
    figure, first = drawing.page(1.5 + 4.2 * rows)
    first.remove()
    panels = figure.subplots(rows, min(len(tests), _IN_A_ROW), sharex=True, sharey=True, squeeze=False).flat
    for panel, test in zip(panels, tests, strict=False):
        called = report.inputs.called(report.inputs.tests[test])
        panel.set_title(f"{report.workbook.row} {called}", fontsize=9)
        panel.grid(visible=True)
        here = layout.rows["k"] == test
        for model in reversed(MODELS):
            for way in ("loading", "unloading"):
                _branch(panel, plotted, f"{way}_%s_{model.name}", here, COLOUR_OF[model.name])
    across = min(len(tests), _IN_A_ROW)
    for panel in list(figure.axes)[len(tests) :]:
        panel.remove()
    for panel in figure.axes[-across:]:  # above a place that stays empty, too
        panel.tick_params(labelbottom=True)
    unit, force = (unit_text(plotted.shown[f"loading_{of}_{MODELS[0].name}"].unit) for of in "xF")
    figure.supxlabel(f"approach x / {unit}", fontsize=9)
    figure.supylabel(f"force F / {force}", fontsize=9)
    panel = figure.axes[0]
    panel.set(xlim=(0, None), ylim=(0, None))
    keys = [Line2D([], [], color=COLOUR_OF[model.name], label=model.title) for model in MODELS]
    figure.legend(handles=keys, loc="outside upper left", ncols=3, handlelength=1.5, columnspacing=1)
    return figure


def _branch(panel: Axes, plotted: Plotted, name: str, here: NDArray[bool_], colour: str) -> None:
    """One branch of a loop, where it has values."""
    at = []
    ok = here
    for letter in "xF":
        column = name % letter
        ok = ok & (plotted.values.status[column] == Status.OK)
        shown = plotted.shown[column]
        at.append((plotted.values.value[column] - shown.zero) / shown.scale)
    panel.plot(*(each[ok] for each in at), color=colour, lw=1.2)
