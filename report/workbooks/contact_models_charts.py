"""The charts of the contact models: restitution and imprint over speed, and the loops of each model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..charts import BLUE, INK, VERMILION, Chart, Series

if TYPE_CHECKING:
    from ..charts import Drawn
    from ..sheet import Sheet

__all__ = ["IMPRINTS", "LOOPS", "RESTITUTIONS", "columns"]

GREEN, PURPLE = "#009e73", "#cc79a7"
"""Of Okabe and Ito, too."""
_COLOURS = {"lankarani": PURPLE, "johnson": VERMILION, "thornton": GREEN, "power": BLUE}
_TITLES = {
    "lankarani": "Lankarani and Nikravesh 1994",
    "johnson": "Johnson, fully plastic",
    "thornton": "Thornton 1997",
    "power": "law (3)",
}


def _over_speed(cell: str, title: str, axis: str, names: tuple[str, ...]) -> Chart:
    lines = (Series("v", f"{cell}_{name}", _TITLES[name], colour=_COLOURS[name]) for name in names)
    points = Series("v", cell, "%s, as measured", "points", INK, bars=True)
    return Chart(title, "impact speed", axis, (*lines, points), whole=True)


RESTITUTIONS = _over_speed(
    "e", "restitution over speed", "coefficient of restitution", ("johnson", "thornton")
)
IMPRINTS = _over_speed("x_p", "imprint over speed", "imprint depth", tuple(_TITLES))
POINTS_PER_BRANCH = 33
"""Abscissae of each branch; straight lines between so many look like a curve."""


def loops(name: str) -> Chart:
    """The loops of a model, one a test."""
    return Chart(
        f"loops by {_TITLES[name]}",
        "approach x",
        "force F",
        (
            Series(f"loading_x_{name}", f"loading_F_{name}", "compression of %s", each=True),
            Series(f"unloading_x_{name}", f"unloading_F_{name}", "restitution of %s", each=True),
        ),
        from_zero=True,
    )


LOOPS = {name: loops(name) for name in _TITLES}


def columns(sheet: Sheet) -> Drawn:
    """The branches of every model, point by point."""
    from .contact_models_sheet import branches

    return branches(sheet, tuple(_TITLES), POINTS_PER_BRANCH)
