"""A force law of a contact, declared once as sympy; what is computed of it is printed from that."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from sympy import Expr, Integer, Symbol, lambdify

from ...derivations.contact.damping import m_red, rate, v_0, x
from ...derivations.rebuilt import evaluated

__all__ = ["ForceLaw", "m_red", "rate", "v_0", "x", "x_max"]

x_max = Symbol("x_max", positive=True)
"""The greatest approach so far, which is what a contact remembers."""


@dataclass(frozen=True)
class ForceLaw:
    """A force that is not a function of the approach alone."""

    name: str
    """What it is called in a sentence."""
    loading: Expr
    """The force in N while the approach grows, in terms of :data:`x`, :data:`rate`, the impact speed
    :data:`v_0`, the reduced mass :data:`m_red` and constants; zero or more there."""
    unloading: Expr | None = None
    """The force after the turning point, which may hold :data:`x_max` too; left out, as in loading."""
    imprint: Expr = field(default=Integer(0))
    """The approach at which the bodies part, in terms of :data:`x_max` and constants."""
    pulls: bool = False
    """Whether a negative force acts; else there is none where the law says less than zero. No code of
    ``codes.py`` has such a force: tests show that Tsuji's ratio would return what is typed if one had."""
    where: tuple[tuple[Symbol, Expr], ...] = ()
    """What some of its symbols stand for; each may name those after it."""

    @property
    def back(self) -> Expr:
        """The force after the turning point."""
        return self.loading if self.unloading is None else self.unloading

    def with_numbers(self, numbers: Mapping[Symbol, Expr]) -> ForceLaw:
        """The law with numbers in place of constants."""

        def put(part: Expr) -> Expr:
            return part.xreplace(numbers).evalf(17)

        back = None if self.unloading is None else put(self.unloading)
        where = tuple((symbol, put(value)) for symbol, value in self.where)
        return replace(
            self, loading=put(self.loading), unloading=back, imprint=put(self.imprint), where=where
        )

    @cached_property
    def constants(self) -> tuple[Symbol, ...]:
        """What has to be given besides impact speed and mass, by name."""
        every = set[Symbol]().union(*(part.free_symbols for part in self._whole))
        return tuple(sorted(every - {x, rate, x_max, v_0, m_red}, key=str))

    @cached_property
    def _whole(self) -> tuple[Expr, ...]:
        """Both branches and the imprint, with all that symbols stand for put in."""
        parts = [self.loading, self.back, self.imprint]
        for symbol, value in self.where:
            parts = [part.xreplace({symbol: value}) for part in parts]
        return tuple(map(evaluated, parts))

    @cached_property
    def _printed(self) -> tuple[Callable[..., float], ...]:
        # Dummies keep names such as lambda out of the source.
        arguments = (x, rate, x_max, v_0, m_red, *self.constants)

        def printed(expression: Expr) -> Callable[..., float]:
            return lambdify(arguments, expression, modules="math", cse=True)  # type: ignore[no-any-return]

        loading, back, imprint = self._whole
        return tuple(map(printed, (loading, back, imprint, loading.diff(x), loading.diff(rate))))

    def at(self, mass: float, speed: float, constants: Mapping[Symbol, float]) -> Forces:
        """The law with numbers in it, all in SI.

        Raises
        ------
        KeyError
            A constant is missing.
        """
        given = (speed, mass, *(float(constants[name]) for name in self.constants))
        loading, unloading, parting, by_approach, by_rate = (_bound(of, given) for of in self._printed)
        return Forces(loading, unloading, parting, by_approach, by_rate, self.pulls)


def _bound(function: Callable[..., float], given: tuple[float, ...]) -> Callable[..., float]:
    def of(approach: float, rate: float, greatest: float) -> float:
        return function(approach, rate, greatest, *given)

    return of


@dataclass(frozen=True)
class Forces:
    """A law with all numbers in it: functions of approach, rate and greatest approach, in SI."""

    loading: Callable[..., float]
    unloading: Callable[..., float]
    parting: Callable[..., float]
    by_approach: Callable[..., float]
    by_rate: Callable[..., float]
    pulls: bool = False

    def imprint(self, greatest: float) -> float:
        """The approach at which the bodies part."""
        return self.parting(greatest, 0.0, greatest)

    def growth(self, approach: float, rate: float, acceleration: float) -> float:
        """How fast the force grows in loading, in N/s; infinite at the first touch of some laws."""
        try:
            slope = self.by_approach(approach, rate, approach)
        except ZeroDivisionError:
            return float("inf")
        return slope * rate + self.by_rate(approach, rate, approach) * acceleration
