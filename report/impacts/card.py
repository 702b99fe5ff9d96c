"""Solves for the parameters of a code's contact with which its own formula returns what was measured."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from scipy.optimize import brentq
from sympy import Expr, Symbol

from ...derivations.text import text
from ...derivations.vocabulary import NO_WORDS
from ..cells.values import Status
from ..result.card import Behaviour, Card, CardRow, Prescribed, TypedValue
from .code import ContactFormula, E, R, SimulationCode, Typed, alpha, depth, e, nu
from .drops import Drop, Drops
from .law import m_red, v_0
from .simulation import Impact, simulate

CLOSE = 1e-11
"""How near to the wanted depth the search for the stiffness ends, over it."""
_TURNS = 30
_STIFFNESSES = -60.0, 100.0
"""Between which stiffnesses one is sought: their logarithms, in SI."""
_STEP = 6.0
"""The factor by which a damping is made stronger until the restitution is passed."""


PRESCRIBED = tuple(n / 20 for n in range(1, 20))
"""The restitutions of which a card tells what comes back."""


class Unreachable(Exception):
    """No parameters make the formula return what was measured; the message says why."""


class Bodies(NamedTuple):
    """What is known of both bodies besides their masses, in SI."""

    modulus: float | None = None
    """Young's, for the stiffness of Hertz; None: that with which the greatest approach (of a law with an
    imprint: the imprint) is that of the drop."""
    poisson: float = math.nan
    """NaN where it is not known."""
    radius: float = math.nan
    """The effective one; NaN where it is not known."""


def card(code: ContactFormula, drops: Drops, drop: Drop, of: str, bodies: Bodies) -> Card:
    """Make a card.

    Parameters
    ----------
    code : ContactFormula
        Of a simulation code; or one of which all numbers are known.
    drops : Drops
        What was measured.
    drop : Drop
        The impact that the card is for.
    of : str
        The title of the report.
    bodies : Bodies
        What is taken of them.

    Raises
    ------
    Unreachable
        The formula cannot return this restitution.
    """
    constants, found, notes = solved(code, drops, drop, bodies)
    rows, why = [], dict[str, None]()
    for test in drops.tests:
        again = simulate(code.law, constants, drops.mass, test.speed)
        typed = _typed(code, constants, drops.mass, test.speed, test.e) if code.takes_e else Impact()
        told = typed.e if code.takes_e else None
        rows.append(CardRow(test.speed, test.e, again.e, told, test.x_p, again.x_p, again.code, typed.code))
        why |= {f"{each.code} in the table: {each.failure}": None for each in (again, typed) if each.failure}
    prescribed = PRESCRIBED if code.takes_e else ()
    values = tuple(
        TypedValue(
            one.word,
            float((one.symbol * one.scale).subs(constants)),
            one.unit,
            one.meaning,
            one.value is None and not _by_hertz(code, one, bodies.modulus),
        )
        for one in code.typed
    )
    imprint = code.law.imprint != 0
    return Card(
        of=of,
        name=code.name,
        title=code.title,
        version=code.version,
        sources=code.sources,
        formula=_formula(code),
        typed=values,
        snippet=_filled(code.snippet, values),
        mass=drops.mass,
        speed=drop.speed,
        wanted=Behaviour(drop.e, drop.x_p, drop.x_m),
        returned=Behaviour(found.e, found.x_p, found.x_m, found.F_m, found.duration),
        rows=tuple(rows),
        prescribed=tuple(
            Prescribed(typed, _typed(code, constants, drops.mass, drop.speed, typed).e)
            for typed in prescribed
        ),
        notes=(*notes, *why, *(() if imprint else ("it leaves no imprint",)), *code.notes),
    )


def solved(
    code: ContactFormula, drops: Drops, drop: Drop, bodies: Bodies
) -> tuple[dict[Symbol, float], Impact, list[str]]:
    """The constants with which it returns what was measured, in SI, the impact, and what was done for it.

    As for :func:`card`.
    """
    if isinstance(code, SimulationCode):
        solver = _Solver(code, drops, drop, bodies)
        return *solver.solved(), solver.notes
    known = {one.symbol: one.value.subs(e, drop.e) for one in code.typed if one.value is not None}
    constants = {symbol: float(value) for symbol, value in known.items()}
    lacking = [str(symbol) for symbol, value in constants.items() if math.isnan(value)]
    if lacking:
        raise Unreachable(f"{lacking[0]} has no value")
    found = simulate(code.law, constants, drops.mass, drop.speed)
    if found.failure:
        raise Unreachable(found.failure)
    return constants, found, []


def _by_hertz(code: ContactFormula, one: Typed, modulus: float | None) -> bool:
    """Whether it is the stiffness that a given modulus says."""
    stiffness = isinstance(code, SimulationCode) and one.symbol == code.stiffness
    return stiffness and modulus is not None and code.by_hertz is not None


def _typed(
    code: ContactFormula, constants: Mapping[Symbol, float], mass: float, speed: float, typed: float
) -> Impact:
    """What comes of a restitution that is typed in."""
    return simulate(code.law, {**constants, e: typed}, mass, speed)


def _formula(code: ContactFormula) -> str:
    law = code.law
    words = {one.symbol: Symbol(one.word) for one in code.typed if one.scale != -1}
    where = [f"{one.word} = -{one.symbol}" for one in code.typed if one.scale == -1]

    def told(expression: Expr) -> str:
        return text(expression.xreplace(words), NO_WORDS).replace("for True", "otherwise")

    force = told(law.loading)
    if law.unloading is not None:
        force += f"; after the turning point {told(law.unloading)}"
    elif not law.pulls:
        force = f"max(0, {force})"
    return ", ".join([f"F = {force}", *(f"{symbol} = {told(value)}" for symbol, value in law.where), *where])


def _filled(snippet: str, values: tuple[TypedValue, ...]) -> str:
    for value in values:
        snippet = snippet.replace("{" + value.word + "}", f"{value.value:.9g}")
    return snippet


@dataclass
class _Solver:
    """What is sought for one code and one drop."""

    code: SimulationCode
    drops: Drops
    drop: Drop
    bodies: Bodies

    def __post_init__(self) -> None:
        self.imprints = self.code.law.imprint != 0
        self.hertzian = self.bodies.modulus is not None and self.code.by_hertz is not None
        self.notes: list[str] = []
        self.wanted = self.drop.x_p if self.imprints else self.drop.x_m
        if self.hertzian:
            self.notes.append("the stiffness is Hertz's of the given modulus: the approach follows from it")
        elif not math.isfinite(self.wanted):
            raise Unreachable("no loading curve is known, from which the stiffness would follow")
        elif self.imprints:
            self.notes.append("the stiffness is the one with which the imprint is the measured one")
        else:
            self.notes.append(
                "the stiffness is the one with which the greatest approach is that of the identified curve"
            )
        self.known = self._known()
        self.stiffness = self._first_stiffness()

    def _known(self) -> dict[Symbol, float]:
        """All that is not solved for."""
        curve = self.drops.alpha if self.drops.has_curve else 1.5
        given: dict[Expr, float] = {
            m_red: self.drops.mass,
            v_0: self.drop.speed,
            alpha: curve,
            depth: self.drop.x_m if math.isfinite(self.drop.x_m) else self.wanted,
            nu: self.bodies.poisson,
            R: self.bodies.radius,
            E: self.bodies.modulus or math.nan,
        }
        found = {R: self.bodies.radius, nu: self.bodies.poisson}
        found |= {
            one.symbol: float(one.value.subs(given)) for one in self.code.typed if one.value is not None
        }
        self.unit = float(self.code.damping_unit.subs(given))
        if self.hertzian and self.code.by_hertz is not None:
            found[self.code.stiffness] = float(self.code.by_hertz.subs(given))
        return found

    def _static(self, stiffness: float, approach: float) -> float:
        """The force at rest, which hangs on no damping."""
        constants = {**self.known, self.code.damping: 0.5, self.code.stiffness: stiffness}
        return self.code.law.at(self.drops.mass, self.drop.speed, constants).loading(approach, 0.0, approach)

    def _first_stiffness(self) -> float:
        """One that lets the bodies come about as near as is wanted."""
        if self.hertzian:
            return self.known[self.code.stiffness]
        energy = self.drops.mass * self.drop.speed**2

        def excess(log: float) -> float:
            return math.log(self._static(math.exp(log), self.wanted) * self.wanted / energy)

        try:
            return math.exp(brentq(excess, *_STIFFNESSES, xtol=1e-6))
        except (ArithmeticError, ValueError) as error:
            least, most = map(math.exp, _STIFFNESSES)
            given = f" with R = {self.bodies.radius:g} m" if R in self.code.law.constants else ""
            raise Unreachable(
                f"no stiffness from {least:.0e} to {most:.0e} in SI units stops the bodies after "
                f"{self.wanted:g} m{given}"
            ) from error

    def _at(self, strength: float, stiffness: float) -> tuple[dict[Symbol, float], Impact]:
        damping = {self.code.damping: strength * self.unit}
        constants = {**self.known, **damping, self.code.stiffness: stiffness}
        return constants, simulate(self.code.law, constants, self.drops.mass, self.drop.speed)

    def _impact(self, strength: float) -> tuple[dict[Symbol, float], Impact]:
        """An impact with a damping, and the stiffness with which it comes as near as is wanted.

        The first step is exact where the damping has no scale of its own; then a secant in logarithms.
        """
        log, power = math.log(self.stiffness), self._power()
        before: tuple[float, float] | None = None
        for _ in range(_TURNS):
            constants, found = self._at(strength, math.exp(log))
            if self.hertzian or found.failure:
                return constants, found
            missed = math.log((found.x_p if self.imprints else found.x_m) / self.wanted)
            if abs(missed) < CLOSE:
                self.stiffness = math.exp(log)
                return constants, found
            if before is not None and missed != before[1]:
                power = (before[0] - log) / (missed - before[1])
            before = log, missed
            log += power * missed
        near = "no stiffness lets the bodies come as near as is wanted"
        return constants, Impact(failure=near, status=Status.NOROOT)

    def _power(self) -> float:
        """By which power of a depth the stiffness has to change."""
        there = self._static(self.stiffness, self.wanted)
        exponent = math.log(self._static(self.stiffness, 2 * self.wanted) / there, 2)
        power = math.log(self._static(2 * self.stiffness, self.wanted) / there, 2)
        return (exponent + 1) / power

    def solved(self) -> tuple[dict[Symbol, float], Impact]:
        """The constants with which the formula returns the restitution, and the impact."""
        low, high = self.code.damping_ends
        first = self._e(low)
        # Upwards in steps, as far as is needed: far too much damping has no stiffness that fits.
        near, e = low, first
        while (e - self.drop.e) * (first - self.drop.e) > 0 and near < high:
            low, near = near, min(near * _STEP, high)
            e = self._e(near)
        if (e - self.drop.e) * (first - self.drop.e) > 0:
            least, most = sorted((first, e))
            raise Unreachable(
                f"the formula returns from {least:.4f} to {most:.4f} at {self.drop.speed:.4g} m/s, "
                f"not {self.drop.e:.4f}"
            )
        ends = math.log(low), math.log(near)
        log = brentq(lambda log: self._e(math.exp(log)) - self.drop.e, *ends, xtol=1e-13, rtol=1e-14)
        constants, found = self._impact(math.exp(log))
        if found.failure or abs(found.e - self.drop.e) > 1e-8:
            raise Unreachable(found.failure or f"the formula jumps over {self.drop.e:.4f}")
        return constants, found

    def _e(self, strength: float) -> float:
        """What is returned; nothing, where the bodies do not part."""
        found = self._impact(strength)[1]
        return 0.0 if found.failure else found.e
