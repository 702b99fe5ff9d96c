"""How a simulation code's contact is declared: its formula, and the numbers that a user types into it."""

from __future__ import annotations

from dataclasses import dataclass

from sympy import Expr, Integer, Rational, Symbol, sqrt
from sympy.core.parameters import evaluate

from ...derivations.contact.damping import K_T, damping_ratio, tsuji, zeta
from ...derivations.contact.damping import e as typed_e
from .law import ForceLaw

E, nu, R = (Symbol(name, positive=True) for name in ("E", "nu", "R"))
"""Young's modulus in Pa and Poisson's ratio of both bodies, and the effective radius in m."""
ONE: Expr = Integer(1)
alpha = Symbol("alpha", positive=True)
"""The exponent of the loading curve."""
depth = Symbol("x_m", positive=True)
"""The greatest approach that is wanted, in m."""
STRENGTHS = 1e-3, 1e4
"""From no damping that anybody sees to one that leaves no rebound, in units of `damping_unit`."""
e = typed_e
"""The restitution that is typed in, which need not be the one that is returned."""

with evaluate(False):
    elastic: Expr = E / (2 * (1 - nu**2))
    """The effective modulus of two bodies of one material, Pa."""
    HERTZ = ((K_T, Rational(4, 3) * elastic * sqrt(R)),)
    """Hertz's stiffness, N/m^(3/2)."""

TSUJI: Expr = tsuji.members[-1]
"""Hertz's force with the damping of discrete elements, (L117)."""
BY_RATIO = ((zeta, damping_ratio.members[-1]), *HERTZ)
"""What stands in it, for a typed restitution: (L118), and Hertz's stiffness."""


@dataclass(frozen=True)
class Typed:
    """A number that a user types into a code."""

    word: str
    """What the code calls it."""
    symbol: Symbol
    """What it is in the law, in SI."""
    unit: str
    """Of the number that is typed."""
    meaning: str
    value: Expr | None = None
    """What it is, where it is not solved for: in terms of what is known of the impact (:data:`alpha`,
    :data:`depth`, :data:`nu`, :data:`R`, :data:`e`, the mass)."""
    scale: Expr = ONE
    """What turns SI into the unit, in terms of the law's own symbols."""


@dataclass(frozen=True, kw_only=True)
class ContactFormula:
    """A force of a contact, with the numbers that a user types into it."""

    name: str
    """The word for it on the command line."""
    title: str
    """Program and model."""
    version: str = ""
    """Of what was read, if it has any."""
    sources: tuple[str, ...]
    """Where the formula stands."""
    law: ForceLaw
    """In terms of what is typed."""
    typed: tuple[Typed, ...]
    by_hertz: Expr | None = None
    """The stiffness for Hertz's contact of a given modulus, if the law is Hertz's without its damping."""
    snippet: str = ""
    """How it is written in an input of the code; {word} is what is typed."""
    notes: tuple[str, ...] = ()
    """What a user has to know besides, a sentence each."""

    @property
    def solves(self) -> bool:
        """Whether some of its numbers are not known before."""
        return any(one.value is None for one in self.typed)

    @property
    def takes_e(self) -> bool:
        """Whether a restitution is typed in."""
        return any(one.symbol == e for one in self.typed)

    def asks(self, hertzian: bool) -> frozenset[Symbol]:
        """Which of Poisson's ratio and radius have to be known, with or without a modulus."""
        named = set(self.law.constants)
        if hertzian and self.by_hertz is not None:
            named |= self.by_hertz.free_symbols
        return frozenset(named & {nu, R})


@dataclass(frozen=True, kw_only=True)
class SimulationCode(ContactFormula):
    """That of a simulation code, of which two numbers are solved for."""

    stiffness: Symbol
    damping: Symbol
    """`stiffness` and `damping`: which of them: by the depth, and by the restitution."""
    damping_unit: Expr = ONE
    """A size of the damping that is neither weak nor strong, from speed, mass and depth."""
    damping_ends: tuple[float, float] = (1e-3, 1 - 1e-6)
    """What it may be, in that unit: a typed restitution and a share are below 1."""
