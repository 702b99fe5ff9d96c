"""The charts of the contact models: restitution and imprint over speed, and the loops of all models."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING

from ...derivations.contact.models import MODELS
from ...derivations.contact.prescribed import AUTHORS
from ..charts import BLUE, INK, VERMILION, Chart, Series

if TYPE_CHECKING:
    from ..charts import Drawn
    from ..sheet import Sheet

_COLOURS = ("#56b4e9", "#cc79a7", VERMILION, "#009e73", BLUE, "#e69f00", "#f0e442")
"""Of Okabe and Ito: told apart by every eye."""
_COLOUR_OF = {model.name: colour for model, colour in zip(MODELS, cycle(_COLOURS), strict=False)}
"""The same in every picture."""
_POINTS = 33
"""Abscissae of each branch; straight lines between so many look like a curve."""


def over_speed(cell: str, title: str, axis: str) -> Chart:
    """What was measured over the speed, and what every model predicts that says more of it than a number."""
    lines = (
        Series("v", f"{cell}_{model.name}", model.title, colour=_COLOUR_OF[model.name])
        for model in MODELS
        if model.varies(cell)
    )
    points = Series("v", cell, "%s, as measured", "points", INK, named=True, bars=True)
    return Chart(title, "impact speed", axis, (*lines, points), whole=True)


LOOPS = Chart(
    "force over approach by all models",
    "approach x",
    "force F",
    tuple(
        Series(f"{way}_x_{model.name}", f"{way}_F_{model.name}", model.title, colour=_COLOUR_OF[model.name])
        for model in reversed(MODELS)
        for way in ("loading", "unloading")
    ),
    from_zero=True,
    panels=True,
    height=4.2,
)
"""The first on top: where two load alike, the loop of the elastic one is but a line."""
DAMPED = Chart(
    "force over approach with the damping of a typed restitution",
    "approach x",
    "force F",
    tuple(
        Series(f"{way}_x_{name}", f"{way}_F_{name}", author.title, colour=colour)
        for author, colour in zip(AUTHORS, (*_COLOURS, INK), strict=True)
        for name in (author.c.own.name,)
        for way in ("loading", "unloading")
    ),
    from_zero=True,
    panels=True,
    height=4.2,
)
"""On top the one that returns what is typed in."""


def columns(sheet: Sheet) -> Drawn:
    """The branches of every model, point by point."""
    from .contact_models_sheet import branches

    return branches(sheet, _POINTS)
