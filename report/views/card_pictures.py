"""The pictures of cards: what comes back of a restitution, and what comes out over the speed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from ..charts import BLUE, INK, VERMILION
from ..result.card import Card, Point
from ..result.result import Report
from . import drawing
from .drawing import GREY

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLOURS = (BLUE, VERMILION, "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
"""Told apart by those who see few colours, too."""
_DASHES = ("-", "--", ":")
"""Of the first six codes, of the next six ..."""
_OF_LAWS = ("-", "--", ":", "-.", (0, (7, 1)), (0, (1, 1)), (0, (3, 1, 1, 1, 1, 1)))
_MICRO = 1e6
_COVERED = 2.0
"""How many standard uncertainties a bar reaches to either side."""


def _looks(codes: int) -> Iterator[dict[str, Any]]:
    """A look for each code: the later the thinner, so that none hides another that is the same."""
    looks = cycle([{"color": colour, "ls": dash} for dash in _DASHES for colour in _COLOURS])
    for look, width in zip(looks, np.linspace(min(1 + 0.3 * codes, 4), 1, codes).tolist(), strict=False):
        yield {**look, "lw": width}


def _empty() -> Figure:
    figure, axes = drawing.page(3)
    drawing.empty(axes, "No card to draw: the folder asks for none, or no code returns what was measured.")
    return figure


def draw_returned(report: Report) -> Figure:
    """Draw the restitution that is returned over the one that is typed in."""
    cards = report.cards()
    if not cards.made:
        return _empty()
    figure, axes = drawing.page(9.5)
    axes.set(xlim=(0, 1), ylim=(0, 1), xlabel="restitution typed in", ylabel="restitution returned")
    axes.plot([0, 1], [0, 1], color=GREY, lw=0.6)
    for (author, points), dash in zip(cards.laws.items(), cycle(_OF_LAWS), strict=False):
        axes.plot(*zip(*points, strict=True), color="#9a9a9a", ls=dash, lw=0.8, label=author)
    for card, look in zip(cards.made, _looks(len(cards.made)), strict=True):
        if card.prescribed:
            axes.plot(*zip(*card.prescribed, strict=True), label=card.name, **look)
            typed = np.interp(card.wanted.e, *_by_returned(card))
            drawing.dots(axes, np.array([typed]), np.array([card.wanted.e]), 5, look["color"])
    axes.axhline(cards.made[0].wanted.e, color=GREY, lw=0.6, ls=(0, (1, 2)))
    figure.legend(loc="outside right center")
    return figure


def _by_returned(card: Card) -> tuple[list[float], list[float]]:
    """What was typed over what came back of it, rising."""
    known = sorted((each.returned, each.typed) for each in card.prescribed if each.returned > 0)
    return [returned for returned, _ in known], [typed for _, typed in known]


def draw_restitutions(report: Report) -> Figure:
    """Draw the restitution over the speed, as measured and by each card."""
    cards = report.cards()
    lines = [(card, [row.by_card for row in card.rows]) for card in cards.made]
    values = [(point.e, point.u_e) for point in cards.measured]
    return _over_speed(cards.measured, values, lines, "coefficient of restitution")


def draw_imprints(report: Report) -> Figure:
    """Draw the imprint over the speed, as measured and by each card that leaves one."""
    cards = report.cards()
    known = [point for point in cards.measured if math.isfinite(point.imprint)]
    leaving = (card for card in cards.made if card.leaves_imprint)
    lines = [(card, [_MICRO * row.imprint_by_card for row in card.rows]) for card in leaving]
    values = [(_MICRO * point.imprint, _MICRO * point.u_imprint) for point in known]
    return _over_speed(known, values, lines, "imprint in µm")


def _over_speed(
    points: Sequence[Point],
    values: Sequence[tuple[float, float]],
    lines: Sequence[tuple[Card, list[float]]],
    said: str,
) -> Figure:
    """Draw measured values with their bars, and the line of each card."""
    if not lines:
        return _empty()
    figure, axes = drawing.page(7.5)
    axes.set(xlabel="impact speed in m/s", ylabel=said)
    _measured(axes, points, values)
    for (card, line), look in zip(lines, _looks(len(lines)), strict=True):
        axes.plot([row.speed for row in card.rows], line, label=card.name, **look)
    figure.legend(loc="outside right center")
    return figure


def _measured(axes: Axes, points: Sequence[Point], values: Sequence[tuple[float, float]]) -> None:
    """Dots with bars in both directions."""
    x = np.array([point.speed for point in points])
    u_x = np.nan_to_num([point.u_speed for point in points]) * _COVERED
    y, u = np.array(values).T
    u_y = np.nan_to_num(u) * _COVERED
    drawing.dots(axes, x, y, 4, INK)
    across = np.stack([np.column_stack([x - u_x, x + u_x]), np.column_stack([y, y])])
    along = np.stack([np.column_stack([x, x]), np.column_stack([y - u_y, y + u_y])])
    drawing.bars(axes, np.concatenate([across, along], axis=1), INK)
