"""What damping returns of a restitution that is typed in: Hertz's force with the numbers of all authors.

Said with the equations of :mod:`~loopsheet.derivations.contact.damping` for Hertz's exponent, the impact
speed of a test and its measured restitution as the one that is wanted. Sources are told there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from sympy import Expr, Integer, Max, Rational, Rel, beta, log

from ..equation import Derivation, Equation, Step
from ..vocabulary import Quantity
from . import damping, hertz

_TAKEN = (
    "xdot", "c", "g", "q", "e_o", "s_d", "sdot", "xddot", "x_s", "t_d", "u_F", "x_F", "W_LN", "W_HG", "W_F",
)  # fmt: skip
_LEFT_ASIDE = ("(L109)", "(L117)", "(L118)")
_ELASTIC = replace(damping.VOCABULARY["W"], name="W_el", latex=r"W_{\mathrm{el}%s}")
_FORCE = Quantity("F_damped", "force with damping", "N", r"F_{d%s}", (1.0, 5000.0))
_HERE: Mapping[Any, Any] = {
    damping.n: hertz.hertz,
    damping.v_0: hertz.v,
    damping.W: _ELASTIC.symbol,
    damping.F: _FORCE.symbol,
    # (L109) is Euler's beta function (DLMF 5.12.1).
    damping.J: beta(hertz.hertz / 2 + hertz.half, Rational(3, 2)) / 2,
}
"""What is said there of any power, here of Hertz's: his stiffness has the same symbol."""


def _here(equation: Equation) -> Equation:
    return replace(equation.at(_HERE), parent=None, renamed=())


def _moved(entry: Equation | Derivation) -> Equation | Derivation:
    if isinstance(entry, Equation):
        return _here(entry)
    return Derivation(tuple(map(_step, entry.steps)))


def _step(step: Step) -> Step:
    return replace(
        step,
        claim=_here(step.claim),
        premises=tuple(map(_here, step.premises)),
        eliminate=tuple(of.xreplace(_HERE) for of in step.eliminate),
        multiplier=None if step.multiplier is None else step.multiplier.xreplace(_HERE),
    )


def course(author: Author, rate: Expr) -> tuple[Expr, Expr]:
    """Approach and force of an impact where its rate is so much of the impact speed; 1 at first, then less.

    From the greatest approach on it is negative, down to the restitution that comes back.
    """
    here = {c: author.c.own.symbol, u_F: rate}
    power, stopped = peak_approach.sides
    at = Max(stopped.xreplace(here), 0) ** (1 / power.exp)  # the bodies part at zero, which rounding may miss
    return at, family.value.xreplace({**here, damping.rate: rate * hertz.v, damping.x: at})


class Solving(NamedTuple):
    """Where a cell that both sides of its equation have is looked for."""

    low: Expr
    high: Expr
    start: Expr
    """`low`, `high` and `start`: an open interval, at whose low end the left side is the smaller one; and a
    first guess."""


class Told(NamedTuple):
    """A cell of each test: the equation that defines it, and how that is solved if both sides have it."""

    own: Quantity
    equation: Equation
    solved: Solving | None = None
    needs: tuple[tuple[Rel, str], ...] = ()
    """What must hold, and what it means if it does not."""


@dataclass(frozen=True)
class Author:
    """An author's damping number, and what it returns of each test."""

    title: str
    c: Told
    q: Told
    e: Told | None
    """`c`, `q` and `e`: the damping number, the logarithm of its factor at separation, and what comes back;
    None where that is what is typed in."""
    x_m: Told
    u_F: Told
    F_m: Told
    """`x_m`, `u_F` and `F_m`: the greatest approach; the greatest force, and the rate where it acts over the
    impact speed."""
    t: Told
    """The duration."""

    @property
    def told(self) -> tuple[Told, ...]:
        """All of them, each after what it needs."""
        first = (self.c, self.q, self.e) if self.e else (self.q, self.c)
        return tuple(each for each in (*first, self.x_m, self.u_F, self.F_m, self.t) if each)


family, by_decay, back, asked, approach, peak_approach, peak_speed, greatest, lasting = map(
    _here,
    (
        damping.family, damping.by_decay, damping.back, damping.asked, damping.approach,
        damping.peak_approach, damping.peak_speed, damping.greatest, damping.lasting,
    ),
)  # fmt: skip
c, q, e_o, x_m, u_F, F_m, t = (
    damping.c, damping.q, damping.e_o, damping.x_m, damping.u_F, damping.F_m, damping.t,
)  # fmt: skip


def _author(mark: str, title: str, member: Equation | None) -> Author:
    """The cells of one.

    `member`: its formula; None is (L106) solved for the number with which what is typed in comes back.
    """

    def own(name: str, meaning: str, unit: str, latex: str, span: tuple[float, float]) -> Quantity:
        said = f"{meaning}, damping by {title}" if name != "c" else f"damping number by {title}"
        return Quantity(f"{name}_{mark}", said, unit, latex.replace("*", rf"\mathrm{{{mark}}}%s"), span)

    typed, number = hertz.e, damping.VOCABULARY.get(f"c_{mark}")
    number = number or own("c", "", "1", "c_{*}", (0.05, 1.5))
    left = own("q", "logarithm of the factor at separation", "1", "q_{*}", (0.05, 3.0))
    returned = own("e", "restitution", "1", "e_{*}", (0.05, 0.6))
    deepest = own("x_m", "maximum approach", "m", "x_{m,*}", (1e-5, 1e-4))
    rate = own("u_F", "rate at the greatest force over the impact speed", "1", "u_{F,*}", (0.05, 0.95))
    peak = own("F_m", "greatest force", "N", "F_{m,*}", (100.0, 1e4))
    lasts = replace(own("t", "duration of the contact", "s", "t_{*}", (1e-6, 1e-3)), positive=False)
    comes_back = returned.symbol if member else typed
    here = {
        c: number.symbol, q: left.symbol, e_o: comes_back, x_m: deepest.symbol, u_F: rate.symbol,
        F_m: peak.symbol, t: lasts.symbol,
    }  # fmt: skip

    def told(of: Quantity, equation: Equation, **more: Any) -> Told:
        return Told(of, replace(equation.at(here), defines=of.symbol), **more)

    divides = member is None or not member.value.subs(typed, 0).is_finite
    needs = (_LOSSY, _FINITE) if divides else (_LOSSY,)

    # The sides of (L120) are alike at q = 0, where the bodies part as fast as they met. Its other root is
    # between log(1 + c) and c; if the restitution is known, so that c is (1 - exp(-q))/e, between -log(e) and
    # the number of (L115). From the upper ends on, Newton's steps come down to it.
    if member is None:
        low, high = -log(typed), 1 / typed - typed
        by_typed = by_decay.at({c: asked.value.xreplace({e_o: typed})})
        factor = told(left, by_typed, solved=Solving(low, high, high), needs=needs)
        tells, gives = told(number, asked, needs=needs), None
    else:
        low, high = log(1 + number.symbol), number.symbol
        factor = told(left, by_decay, solved=Solving(low, high, high))
        tells, gives = Told(number, member, needs=needs), told(returned, back)
    return Author(
        title,
        tells,
        factor,
        gives,
        told(deepest, approach),
        told(rate, peak_speed, solved=Solving(*_FROM_ZERO_TO_ONE)),
        told(peak, greatest),
        told(lasts, lasting, needs=((number.symbol <= _MOST, _TOO_DAMPED),)),
    )


_MOST = 15
_TOO_DAMPED = (
    f"the damping number is above {_MOST}, with which less than a fifteenth of the speed comes back: the "
    "duration would not be right to all digits"
)
_LOSSY = (hertz.e < 1, "e = 1: nothing is lost, so that nothing is damped")
_FINITE = (hertz.e > Rational(1, 2**30), "e = 0: the damping number would have to be infinite")
_FROM_ZERO_TO_ONE = (Integer(0), Integer(1), hertz.half)
_MARKS = {
    "hunt_crossley": "HC",
    "lee_wang": "LW",
    "lankarani_nikravesh": "LN",
    "gonthier": "G",
    "flores": "F",
    "hu_guo": "HG",
    "carvalho_martins": "CM",
}
"""Of the authors' symbols."""
AUTHORS = (
    *(
        _author(mark, damping.MEMBERS[name].title, _here(damping.MEMBERS[name]))
        for name, mark in _MARKS.items()
    ),
    _author("D", "the exact inverse", None),
)
"""Those of :data:`~loopsheet.derivations.contact.damping.MEMBERS`, and the one that all of them approach."""

ENTRIES = tuple(
    _moved(entry)
    for entry in damping.LEDGER.entries
    if (entry.claim if isinstance(entry, Derivation) else entry).label not in _LEFT_ASIDE
)
"""The ledger of the damping family for Hertz's exponent, without what discrete elements have."""
OWN = (
    *(damping.VOCABULARY[name] for name in _TAKEN),
    _ELASTIC,
    _FORCE,
    *(each.own for author in AUTHORS for each in author.told),
)
