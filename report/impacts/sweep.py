"""Many impacts under one force law, over a range of speeds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from .simulation import Impact, simulate

if TYPE_CHECKING:
    from sympy import Symbol

    from .law import ForceLaw

__all__ = ["as_csv", "sweep"]

HEAD = "v [m/s],e [1],x_m [m],F_m [N],x_p [m],duration [s],compression [s],loss [J],failure"


def sweep(
    law: ForceLaw,
    constants: Mapping[Symbol, float],
    mass: float,
    speeds: Sequence[float],
    told: Callable[[str], None],
) -> list[Impact]:
    """Simulate an impact at each speed.

    Parameters
    ----------
    law, constants, mass
        As for :func:`~loopsheet.report.impacts.simulation.simulate`.
    speeds : sequence of float
        In m/s.
    told : callable
        Told how many are done.
    """
    found = []
    for number, speed in enumerate(speeds):
        told(f"simulating {number} of {len(speeds)} impacts")
        found.append(simulate(law, constants, mass, speed))
    return found


def as_csv(speeds: Sequence[float], impacts: Sequence[Impact]) -> str:
    """What the impacts show, a line each, with the digits that are sure; of one that there is not, why."""
    lines = [HEAD]
    for speed, each in zip(speeds, impacts, strict=True):
        numbers = (each.e, each.x_m, each.F_m, each.x_p, each.duration, each.compression, each.loss)
        cells = [f"{number:.10g}" if number == number else "" for number in numbers]
        lines.append(",".join([f"{speed:.10g}", *cells, f'"{each.failure}"' if each.failure else ""]))
    return "\n".join(lines)
