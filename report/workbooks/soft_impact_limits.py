"""Where the numbers of a drop test are expected: by the paper's (4), and by what a drop test is."""

from __future__ import annotations

from collections.abc import Mapping

from sympy import Expr, Max, Min, Rational, Rel

from ...derivations import soft_impact as model
from ...derivations.soft_impact import E, V
from ..quantity import Bounds
from ..sheet import Column, Limit

__all__ = ["apart", "limits"]

Cells = Mapping[Expr, Expr]
"""What the two tests of the derivations are called in a sheet."""

SPEEDS = Limit(Bounds(0.1, 20), "a speed of no drop test: a fall of less than 0.5 mm, or of more than 20 m")
"""In m/s; free fall in vacuum, v^2/(2 g), is 0.51 mm and 20.4 m."""
DENSITIES = Limit(Bounds(10, 23000), "lighter than foam, or denser than osmium")
"""In kg/m^3."""
APART = Rational(104, 100)
"""The least ratio of two speeds. One per cent of an imprint depth moves the exponent of a pair by some
.01 (alpha + 1)^2/(2 ln(v_2/v_1)), if the restitution is the same: at alpha = 1, the lower end of (4), by its
whole width at 4 %."""
NEAR = f"speeds within {100 * (APART - 1)} %: too near for averages and fits"


def apart(where: Cells) -> tuple[Rel, str]:
    """That the speeds of two tests tell an exponent, and what is said where they do not.

    `where`: the cells that the symbols of the two tests stand for.
    """
    return (Max(V[1], V[2]) >= APART * Min(V[1], V[2])).xreplace(dict(where)), NEAR


def limits(columns: tuple[Column, ...], where: Cells) -> dict[str, tuple[Limit, ...]]:
    """The limits of the columns of a sheet, by name.

    `where`: the cells that the symbols of the two tests stand for.
    """
    by_name = {column.name: column for column in columns}
    exponents = ("alpha", "alpha_mean", "alpha_median", "alpha_log", "alpha_lin", "alpha_eiv")
    found: dict[str, tuple[Limit, ...]] = {
        name: (Limit.of(model.eq4.at({model.alpha: by_name[name].cell})),) for name in exponents
    }
    falls = (E[2] - E[1]) * (V[2] - V[1]) <= 0
    found["alpha"] += (
        Limit(falls.xreplace(dict(where)), "e rises with the speed"),
        Limit(*apart(where), silent=True),
    )
    found["v"] = (SPEEDS,)
    if "ball_density" in by_name:
        found["ball_density"] = (DENSITIES,)
        radius = by_name["ball_diameter"].symbol / 2
        found["x_p"] = (Limit(by_name["x_p"].cell <= radius, "deeper than the radius of the ball"),)
    return found
