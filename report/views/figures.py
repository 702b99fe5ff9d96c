"""The drawings: finished curves in, SVG or PDF out, the same bytes every time."""

from __future__ import annotations

import io
from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import TYPE_CHECKING

from ..document import cards
from ..document.pictures import figures as of
from ..document.refereed import FIGURE
from ..result.result import Report
from ..workbook import Workbook
from . import card_pictures, charts, drawing, reach

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw", "drawings", "files", "of"]


def drawings(workbook: Workbook) -> Mapping[str, Callable[[Report], Figure]]:
    """Every drawing by its name in a FigureSpec: of the workbook, and those that are of none."""
    own = {} if workbook.drawings is None else workbook.drawings()
    return {**own, **_of_data(workbook)}


def _of_data(workbook: Workbook) -> dict[str, Callable[[Report], Figure]]:
    """Those that are no code of the workbook's."""
    drawn: dict[str, Callable[[Report], Figure]]
    drawn = {f.drawing: partial(charts.draw, chart=f.chart) for f in workbook.figures if f.chart}
    drawn |= {FIGURE: reach.draw, cards.RETURNED: card_pictures.draw_returned}
    drawn |= {
        cards.RESTITUTIONS: card_pictures.draw_restitutions,
        cards.IMPRINTS: card_pictures.draw_imprints,
    }
    return drawn


def draw(report: Report, name: str) -> Figure:
    """A drawing as a matplotlib figure.

    Parameters
    ----------
    name : str
        One of :func:`drawings`.

    Raises
    ------
    KeyError
        There is no drawing of that name.
    """
    known: Mapping[str, Callable[[Report], Figure]] = _of_data(report.workbook)
    if name not in known:
        known = drawings(report.workbook)
    if name not in known:
        raise KeyError(f"no drawing is called {name!r}; there are {', '.join(known)}")
    with drawing.styled():
        figure = known[name](report)
        drawing.settle(figure)
    return figure


def files(report: Report, name: str, forms: Collection[str]) -> dict[str, bytes]:
    """A drawing that is made once, as a file of each form, without a date and without anything to load.

    `report` and `name`: as for :func:`draw`. `forms`: ``svg``, ``pdf``.
    """
    from .svg import written

    figure, buffer, found = draw(report, name), io.BytesIO(), dict[str, bytes]()
    with drawing.styled():
        if "svg" in forms:
            found["svg"] = written(figure, f"{name}-").encode()
        if "pdf" in forms:
            nobody = {"CreationDate": None, "Producer": None, "Creator": None}
            figure.savefig(buffer, format="pdf", metadata=nobody)
            found["pdf"] = buffer.getvalue()
    return found
