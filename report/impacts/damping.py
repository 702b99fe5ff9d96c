"""Numbers of the damping family: what a damping number returns, and the one that returns what is wanted.

All is printed from :mod:`~loopsheet.derivations.contact.damping` and evaluated with 40 digits, because the
equations cancel where the damping is weak.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import mpmath
from scipy.optimize import brentq
from sympy import Expr, Symbol, lambdify

from ...derivations.contact import damping as model

__all__ = ["Closed", "closed_form", "number_by", "returned", "wanted"]

_DIGITS = 40


class Closed(NamedTuple):
    """An impact of the family in closed form: restitution, greatest approach in m and force in N."""

    e: float
    x_m: float
    F_m: float


@lru_cache
def _printed(expression: Expr, names: tuple[Symbol, ...]) -> Callable[..., Any]:
    return lambdify(names, expression, modules="mpmath")  # type: ignore[no-any-return]


def _value(expression: Expr, **given: Any) -> Any:
    """An expression at a point, with 40 digits."""
    names = tuple(sorted(expression.free_symbols, key=str))
    with mpmath.workdps(_DIGITS):
        return _printed(expression, names)(*(mpmath.mpf(given[str(name)]) for name in names))


def _zero(of: Callable[[float], Any], low: float, high: float) -> float:
    return float(brentq(lambda value: float(of(value)), low, high, xtol=1e-300, rtol=1e-15))


def returned(c: float) -> float:
    """The restitution that the family F = K x^n (1 + c x'/v_0) returns, for any n, by (L106).

    Parameters
    ----------
    c : float
        The damping number, above 1e-6: weaker damping cannot be told from none.

    Examples
    --------
    >>> f"{returned(0.705):.4f}"  # Hunt and Crossley's c for e = .53
    '0.6770'
    """
    (residual,) = model.returned.residuals
    margin = 1e-15
    return _zero(lambda e: _value(residual, c=c, e_o=e), 0.0, min(1.0, 1 / c) * (1 - margin))


def wanted(e: float) -> float:
    """The damping number with which the family returns a restitution, by (L106).

    Parameters
    ----------
    e : float
        From 0.03 to below 1: for less the damping number is 1/e to all digits of a double.

    Raises
    ------
    ValueError
        It is outside of that.

    Examples
    --------
    >>> f"{wanted(0.53):.6f} {returned(wanted(0.53)):.12f}"
    '1.279600 0.530000000000'
    """
    if not 0.03 <= e < 1:
        raise ValueError(f"no damping number can be told for a restitution of {e}: from 0.03 to below 1")
    (residual,) = model.returned.residuals
    # Weak damping: c is about 1 - e^2; (L106) also holds for c = 0, which returns any e.
    return _zero(lambda c: _value(residual, c=c, e_o=e), 0.2 * (1 - e**2), (1 - 1e-15) / e)


def number_by(author: str, e: float, n: float) -> float:
    """The damping number by an author's formula, one of :data:`~...damping.MEMBERS`.

    Parameters
    ----------
    e, n : float
        The restitution that is wanted, and the exponent of the force.

    Examples
    --------
    >>> f"{number_by('flores', 0.53, 1.5):.4f}"
    '1.4205'
    """
    value = model.MEMBERS[author].value
    if value.has(model.J):
        value = value.xreplace({model.J: model.mean_flores.value})
    return float(value.subs({model.e: e, model.n: n}).evalf(20))


def closed_form(K: float, n: float, c: float, mass: float, speed: float) -> Closed:
    """Restitution, greatest approach and greatest force of the family, by (L105) to (L108).

    `K`, `n` and `c`: stiffness in N/m^n, exponent, damping number. `mass` and `speed`: the reduced mass in
    kg, the impact speed in m/s.
    """
    given = {"K": K, "n": n, "c": c, "m_red": mass, "v_0": speed}
    (residual,) = model.peak_speed.residuals
    u = _zero(lambda u: _value(residual, u_F=u, **given), 0.0, 1.0)
    power = _value(model.peak_approach.value, u_F=u, **given)
    peak = float(power ** (1 / (mpmath.mpf(n) + 1)))
    force = _value(model.family.value, x=peak, xdot=u * speed, **given)
    return Closed(returned(c), float(_value(model.approach.value, **given)), float(force))
