"""One impact under a force law, m x'' = -F(x, x', x_max), from the first touch until the bodies part.

The equation is integrated in units of an estimated depth and of the time that the impact speed takes for
it, so that tolerances mean the same for a steel ball and for a tyre. It is begun anew at corners of it:
the turning point, and where a force that may not pull becomes zero. What cannot be simulated is told by the
code of a cell and a sentence, not raised.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ..cells.values import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from sympy import Symbol

    from .law import ForceLaw, Forces

RELATIVE, ABSOLUTE = 1e-12, 1e-14
"""Tolerances of a step, in units of the estimated depth and the impact speed."""
LONGEST = 300.0
"""In units of the estimated depth over the impact speed; the contacts of the literature last from 2 to 6."""
SLOWEST = 1e-9
"""A rebound below this share of the impact speed is none: the steps cannot tell it from creeping."""
ROUNDED = 1e-12
"""Of the greatest approach: what two ways of reckoning one depth may differ by."""
CORNERS = 8
"""Of how many intervals in which a force acts a restitution may consist."""

STAY = "the bodies do not part: the damping is as strong as the spring"
"""Where nothing comes back."""


@dataclass(frozen=True)
class Impact:
    """What a simulated impact shows, in SI."""

    e: float = math.nan
    """The coefficient of restitution that is returned."""
    x_m: float = math.nan
    F_m: float = math.nan
    """`x_m` and `F_m`: the greatest approach and the greatest force, which need not come together."""
    x_p: float = math.nan
    """The approach at which the bodies part."""
    duration: float = math.nan
    compression: float = math.nan
    """`duration` and `compression`: until the force is zero for good, and until the greatest approach."""
    loss: float = math.nan
    """The area of the loop: the work of the force over the whole impact."""
    time: NDArray[np.float64] | None = None
    approach: NDArray[np.float64] | None = None
    speed: NDArray[np.float64] | None = None
    force: NDArray[np.float64] | None = None
    work: NDArray[np.float64] | None = None
    """`time`, `approach`, `speed`, `force` and `work`: of shape (steps,); the course of it, where the
    integration stepped, and the work of the force so far."""
    failure: str = ""
    status: Status = Status.OK
    """`failure` and `status`: why there is nothing of all this, and what cells show for it; empty and OK, if
    there is."""

    @property
    def code(self) -> str:
        """What a cell shows in place of a number; empty, if there is one."""
        return self.status.code if self.status else ""


class _Stopped(Exception):
    """The integration cannot go on, and why."""

    def __init__(self, status: Status, sentence: str) -> None:
        super().__init__(sentence)
        self.status = status


def simulate(
    law: ForceLaw, constants: Mapping[Symbol, float], mass: float, speed: float, before: float = 0.0
) -> Impact:
    """Simulate one impact.

    Parameters
    ----------
    constants : mapping of Symbol to float
        Of the law, in SI.
    mass : float
        The reduced mass in kg.
    speed : float
        The impact speed in m/s.
    before : float
        The greatest approach of impacts in the same place before, in m: the bodies touch at the imprint that
        it left, and are loaded along its restitution up to it.

    Returns
    -------
    Impact
        With `status` and `failure` where there is none: ``#INPUT!`` without mass or speed, ``#DOMAIN!`` where
        the law says no force, ``#NOROOT!`` where the bodies do not stop or do not part, ``#UNDECIDED!`` where
        the steps of the integration do not get through.

    Examples
    --------
    A linear spring of 1 N/m is loaded and unloaded in half a period, and loses nothing:

    >>> from sympy import Symbol
    >>> from loopsheet.report.impacts.law import ForceLaw, x
    >>> k = Symbol("k", positive=True)
    >>> found = simulate(ForceLaw("a spring", k * x), {k: 1.0}, 1.0, 1.0)
    >>> f"{found.e:.9f} {found.duration:.9f} {found.x_m:.9f}"
    '1.000000000 3.141592654 1.000000000'
    """
    try:
        forces = law.at(mass, speed, constants)
        depth = depth_of(forces, mass, speed)
        return _Course(forces, mass, speed, depth, before).impact()
    except _Stopped as stopped:
        return Impact(failure=str(stopped), status=stopped.status)
    except (ArithmeticError, TypeError, ValueError) as error:
        sentence = f"{law.name} has no force for these numbers ({error})"
        return Impact(failure=sentence, status=Status.DOMAIN)


def depth_of(forces: Forces, mass: float, speed: float) -> float:
    """An estimate of the greatest approach, m: where the force at rest times the depth is m v^2."""

    def excess(log_depth: float) -> float:
        depth = math.exp(log_depth)
        return math.log(forces.loading(depth, 0.0, depth)) + log_depth - math.log(mass * speed**2)

    low, high = math.log(1e-15), math.log(1e6)
    if not (mass > 0 and speed > 0):
        raise _Stopped(Status.INPUT, f"mass {mass:g} kg and impact speed {speed:g} m/s are not both positive")
    if not excess(low) < 0 < excess(high):
        raise _Stopped(Status.NOROOT, "no depth from a femtometre to 1000 km stops the bodies")
    return math.exp(brentq(excess, low, high, xtol=1e-3))


class _Course:
    """An integration in progress: lengths over `depth`, speeds over the impact speed, work over m v^2."""

    def __init__(self, forces: Forces, mass: float, speed: float, depth: float, before: float) -> None:
        self.forces, self.mass, self.speed, self.depth = forces, mass, speed, depth
        self.unit = mass * speed**2 / depth
        self.pieces: list[tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]] = []
        self.peak = 0.0
        self.greatest = math.nan
        self.imprint = self.least = 0.0
        if before > 0:
            self._leave(before / depth)
        self.t, self.state = 0.0, np.array([self.least, 1.0, 0.0])

    def _leave(self, greatest: float) -> None:
        """What a greatest approach leaves."""
        self.greatest = greatest
        self.imprint = self.forces.imprint(self.depth * greatest)
        self.least = self.imprint / self.depth
        if not 0 <= self.least < greatest:
            sentence = "the bodies would part at a depth that is not below the greatest approach"
            raise _Stopped(Status.DOMAIN, sentence)

    def force(self, approach: float, rate: float) -> float:
        """The force of the law, over its unit; it may be negative."""
        # No step goes below the imprint, by rounding neither: a power of less than nothing is no number.
        depth, greatest = max(self.depth * approach, self.imprint), self.depth * self.greatest
        law = self.forces.loading if math.isnan(greatest) else self.forces.unloading
        force = law(depth, self.speed * rate, greatest)
        # The law may reckon the imprint in another way: just there a power of next to nothing is nothing.
        if isinstance(force, complex) and depth - self.imprint <= ROUNDED * greatest:
            return 0.0
        return force / self.unit

    def acting(self, approach: float, rate: float) -> float:
        """The force that acts."""
        force = self.force(approach, rate)
        return force if self.forces.pulls else max(force, 0.0)

    def impact(self) -> Impact:
        """Go through it all."""
        # What was loaded before is loaded anew first; an impact that turns there goes no deeper.
        if math.isnan(self.greatest) or self._go(self._turns, self._was_here) == 1:
            self.greatest = math.nan
            self._go(self._turns, peak=True)
            self._leave(float(self.state[0]))
        compression, deepest = self.t, float(self.state[0])
        self.peak = max(self.peak, self.acting(deepest, 0.0))
        over = self._restitution()
        if -float(self.state[1]) < SLOWEST:
            raise _Stopped(Status.NOROOT, STAY)
        time, states, force = (np.concatenate(parts, axis=-1) for parts in zip(*self.pieces, strict=True))
        second, energy = self.depth / self.speed, self.mass * self.speed**2
        return Impact(
            e=-float(self.state[1]),
            x_m=self.depth * deepest,
            F_m=self.unit * self.peak,
            x_p=self.depth * self.least,
            duration=second * over,
            compression=second * compression,
            loss=energy * float(self.state[2]),
            time=second * time,
            approach=self.depth * states[0],
            speed=self.speed * states[1],
            force=self.unit * force,
            work=energy * states[2],
        )

    def _restitution(self) -> float:
        """Go on until the bodies part; when the last force acted."""
        for _ in range(CORNERS):
            ended_by = self._go(self._parts, *(() if self.forces.pulls else (self._lets_go,)))
            over = self.t
            if ended_by == 0 or not self._flies():
                return over
        raise _Stopped(Status.NOROOT, "the force begins and ends again and again while the bodies part")

    def _flies(self) -> bool:
        """Let them go on without a force: to where it acts again, if it does, else to where they part."""
        start, rate = float(self.state[0]), float(self.state[1])
        places = np.linspace(start, self.least, 65)[1:-1]
        again = next((float(place) for place in places if self.force(float(place), rate) > 0), None)
        end = self.least
        if again is not None:
            before = again + (start - self.least) / 64
            if self.force(before, rate) < 0:
                again = brentq(lambda place: self.force(place, rate), again, before, xtol=1e-15)
            end = again
        self.t += (end - start) / rate
        self.state = np.array([end, rate, self.state[2]])
        return again is not None

    def _go(self, *events: Any, peak: bool = False) -> int:
        """Integrate until one of the events happens; which it was."""

        def slope(_: float, state: NDArray[np.float64]) -> list[float]:
            approach, rate, _work = state.tolist()
            force = self.acting(approach, rate)
            return [rate, -force, force * rate]

        def grows(_: float, state: NDArray[np.float64]) -> float:
            approach, rate, _work = state.tolist()
            acceleration = -self.force(approach, rate) * self.unit / self.mass
            return self.forces.growth(self.depth * max(approach, 0.0), self.speed * rate, acceleration)

        watched: list[Callable[..., float]] = [_ending(event) for event in events]
        watched += [grows] if peak else []
        self.peak = max(self.peak, self.acting(*self.state[:2].tolist()))
        found = solve_ivp(
            slope,
            (self.t, self.t + LONGEST),
            self.state,
            method="DOP853",
            rtol=RELATIVE,
            atol=ABSOLUTE,
            events=watched,
            first_step=1e-4,
        )
        if found.status < 0:
            ended = f"the integration ended at {self.depth * float(found.y[0, -1]):.3g} m: {found.message}"
            raise _Stopped(Status.UNDECIDED, ended)
        if found.status == 0:
            raise _Stopped(Status.NOROOT, STAY)
        if peak:
            self.peak = max([self.peak, *(self.acting(*state[:2].tolist()) for state in found.y_events[-1])])
        self.pieces.append(
            (
                found.t,
                found.y,
                np.array([self.acting(*state[:2].tolist()) for state in found.y.T]),
            )
        )
        self.t, self.state = float(found.t[-1]), found.y[:, -1]
        return next(place for place, times in enumerate(found.t_events[: len(events)]) if times.size)

    def _turns(self, _: float, state: NDArray[np.float64]) -> float:
        return float(state[1])

    def _was_here(self, _: float, state: NDArray[np.float64]) -> float:
        return self.greatest - float(state[0])

    def _parts(self, _: float, state: NDArray[np.float64]) -> float:
        return float(state[0]) - self.least

    def _lets_go(self, _: float, state: NDArray[np.float64]) -> float:
        return self.force(*state[:2].tolist())


def _ending(event: Callable[..., float]) -> Callable[..., float]:
    """An event that ends the integration where it falls through zero."""

    def watched(time: float, state: NDArray[np.float64]) -> float:
        return event(time, state)

    watched.terminal, watched.direction = True, -1.0  # type: ignore[attr-defined]
    return watched
