"""The drawings: finished curves in, SVG or PDF out, the same bytes every time."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING

from ..document.refereed import FIGURE
from ..document.refereed import figures as of
from ..result.result import Report
from ..workbook import Workbook
from . import charts, drawing, reach

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw", "drawings", "of", "pdf", "svg"]


def drawings(workbook: Workbook) -> Mapping[str, Callable[[Report], Figure]]:
    """Every drawing by its name in a FigureSpec: the workbook's charts and drawings, and the referee's."""
    own = {} if workbook.drawings is None else workbook.drawings()
    drawn = {f.drawing: partial(charts.draw, chart=f.chart) for f in workbook.figures if f.chart}
    return {**own, **drawn, FIGURE: reach.draw}


def draw(report: Report, name: str) -> Figure:
    """A drawing as a matplotlib figure.

    Parameters
    ----------
    report : Report
    name : str
        One of :func:`drawings`.

    Raises
    ------
    KeyError
        There is no drawing of that name.
    """
    known = drawings(report.workbook)
    if name not in known:
        raise KeyError(f"no drawing is called {name!r}; there are {', '.join(known)}")
    with drawing.styled():
        figure = known[name](report)
        drawing.settle(figure)
    return figure


def svg(report: Report, name: str) -> str:
    """A drawing as SVG text, without a date and without anything to load.

    Parameters
    ----------
    report, name
        As for :func:`draw`.
    """
    nobody = {"Date": None, "Creator": None, "Format": None, "Type": None}
    text = _saved(report, name, "svg", nobody).decode("utf-8")
    text = re.sub(r"<!DOCTYPE[^>]*>\n", "", text)  # it points to a file on the web, and nothing needs it
    text = re.sub(r'\s*<g id="[^"]*"/>', "", text)  # what a tick without length leaves
    return re.sub(r"\n\s+", "\n", _COORDINATES.sub(_shortened, text))


def pdf(report: Report, name: str) -> bytes:
    """A drawing as a PDF page of its own size, without a date.

    Parameters
    ----------
    report, name
        As for :func:`draw`.
    """
    return _saved(report, name, "pdf", {"CreationDate": None, "Producer": None, "Creator": None})


def _saved(report: Report, name: str, form: str, metadata: dict[str, None]) -> bytes:
    figure = draw(report, name)
    buffer = io.BytesIO()
    with drawing.styled():
        figure.savefig(buffer, format=form, metadata=metadata)
    return buffer.getvalue()


_COORDINATES = re.compile(r' (?:d|x|y)="[^"]*"')


def _shortened(attribute: re.Match[str]) -> str:
    """Coordinates to a tenth of a point, 35 µm on paper: half the file, and nothing is seen of it."""
    short = re.sub(r"-?\d+\.\d{2,}", lambda n: f"{float(n[0]):.1f}".rstrip("0").rstrip("."), attribute[0])
    short = re.sub(r"\s*\n", "", re.sub(r"([MLQC]) ", r"\1", short))
    # A dot is a line from a place to itself; said so, it takes two thirds of the bytes.
    return re.sub(r"M([-\d.]+ [-\d.]+)L\1(?=[M\"])", r"M\1h0", short)
