"""Many impacts under one force law: over a range of speeds, or one after the other in the same place."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from .simulation import Impact, simulate

if TYPE_CHECKING:
    from sympy import Symbol

    from .law import ForceLaw

COURSE = "impact,t [s],x [m],v [m/s],F [N],kinetic energy [J],work of the force [J],failure"
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


def repeated(
    law: ForceLaw, constants: Mapping[Symbol, float], mass: float, speed: float, impacts: int
) -> list[Impact]:
    """Simulate impacts at one speed, each in the crater of those before it, up to one that there is not."""
    found, before = [Impact()], 0.0
    while len(found) <= impacts and not found[-1].failure:
        found.append(simulate(law, constants, mass, speed, before))
        before = max(before, found[-1].x_m)
    return found[1:]


def course_as_csv(impacts: Sequence[Impact], mass: float) -> str:
    """What happens step by step, with the digits that are sure; of an impact that there is not, its code."""
    lines = [COURSE]
    for number, each in enumerate(impacts, 1):
        if each.failure:
            codes = [each.code] * COURSE.count("[")
            lines.append(",".join([f"{number}", *codes, f'"{each.failure}"']))
            continue
        assert each.speed is not None
        columns = (each.time, each.approach, each.speed, each.force, mass * each.speed**2 / 2, each.work)
        for row in zip(*(column for column in columns if column is not None), strict=True):
            lines.append(",".join([f"{number}", *(f"{value:.10g}" for value in row), ""]))
    return "\n".join(lines)


def as_csv(speeds: Sequence[float], impacts: Sequence[Impact]) -> str:
    """What the impacts show, a line each, with the digits that are sure; or the code of what there is not."""
    lines = [HEAD]
    for speed, each in zip(speeds, impacts, strict=True):
        numbers = (each.e, each.x_m, each.F_m, each.x_p, each.duration, each.compression, each.loss)
        cells = [f"{number:.10g}" if not each.failure else each.code for number in numbers]
        lines.append(",".join([f"{speed:.10g}", *cells, f'"{each.failure}"' if each.failure else ""]))
    return "\n".join(lines)
