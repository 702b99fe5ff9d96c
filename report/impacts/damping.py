"""Numbers of the damping family: what a damping number returns, and the one by an author's formula.

All is printed from :mod:`~loopsheet.derivations.contact.damping` and evaluated with 40 digits, because the
equations cancel where the damping is weak.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import mpmath
from scipy.optimize import brentq
from sympy import Expr, Symbol, lambdify

from ...derivations.contact import damping as model

_DIGITS = 40
_MARGIN = 1e-15
"""How near to an end a number is sought, over it."""
_STRONG = 37.0
"""With a stronger damping the restitution is 1/c within that margin."""


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
    if c > _STRONG:
        return 1 / c
    (residual,) = model.returned.residuals
    return _zero(lambda e: _value(residual, c=c, e_o=e), 0.0, min(1.0, 1 / c) * (1 - _MARGIN))


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
