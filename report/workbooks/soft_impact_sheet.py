"""Columns of the soft-impact sheet, for other workbooks of the same tests."""

from __future__ import annotations

from dataclasses import replace

from ..column import Column
from .soft_impact import sheet


def of_sheet(given: frozenset[str], *names: str) -> tuple[Column, ...]:
    """Some of its columns; what is odd of them is said by the other workbook."""
    own = sheet(given)
    return tuple(replace(own[name], limits=()) for name in names if name in own)


v, e, x_p, beta = of_sheet(frozenset({"ball_mass"}), "v", "e", "x_p", "beta")
TESTS = sheet(frozenset({"ball_mass"})).axes[0]


def masses(given: frozenset[str]) -> tuple[Column, ...]:
    """The mass of the ball and the reduced mass, from what was given."""
    shape = () if "ball_mass" in given else ("ball_diameter", "ball_density")
    own = given & {"ball_mass", "target_mass", *shape}
    return of_sheet(own, *shape, "ball_mass", "target_mass", "m_red")
