"""Exponentials, logarithms and powers of arrays: the same bits on every processor.

NumPy's own have other last bits where the processor has other instructions. Here everything is made of sums,
products and quotients of doubles, which IEEE 754 rounds correctly, and of steps that round nothing. The last
bit may be wrong, as in NumPy's: an error is at most 2 units of it. It takes longer.
"""

from __future__ import annotations

from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["exp", "log", "power"]

Array = NDArray[np.float64]

_LN2 = (float.fromhex("0x1.62e42fefa3800p-1"), float.fromhex("0x1.ef35793c76730p-45"))
"""The logarithm of 2 in two parts. The first has 42 bits: its product with an exponent is exact."""
_PER_LN2 = float.fromhex("0x1.71547652b82fep+0")
_COTH = (1 / 12, -1 / 720, 1 / 30240, -1 / 1209600, 1 / 47900160, -691 / 1307674368000)
"""B_2k/(2k)!: the series of (r/2) coth(r/2) - 1 in r^2; as many terms as doubles tell for r up to
ln(2)/2."""
_ATANH = tuple(2 / (2 * k + 1) for k in range(1, 11))
"""The series of 2 atanh(s)/s - 2 in s^2; as many terms as doubles tell for s up to
(sqrt(2)-1)/(sqrt(2)+1)."""
_LEAST = 0.5**0.5
_BEYOND = 750.0
"""Exponentials of more, and of less than its opposite, are no positive double."""
_HALF = 2.0**27 + 1


def exp(x: Any) -> Any:
    """The exponential.

    Parameters
    ----------
    x : float array
        What has an arithmetic of its own, such as intervals, does it by that.
    """
    if not _is_plain(x):
        return np.exp(x)
    x = np.asarray(x, dtype=np.float64)
    known = x == x
    if known.all():
        return _exp(x, 0.0)
    return np.where(known, _exp(np.where(known, x, 0.0), 0.0), np.nan)


def log(x: Any) -> Any:
    """The natural logarithm; of what is not positive and finite, NumPy's.

    Parameters
    ----------
    x : float array
        As for :func:`exp`.
    """
    if not _is_plain(x):
        return np.log(x)
    x = np.asarray(x, dtype=np.float64)
    known = (x > 0) & (x < np.inf)
    if known.all():
        return _log(x)
    return np.where(known, _log(np.where(known, x, 1.0)), np.log(np.where(known, 1.0, x)))


def power(x: Any, y: Any) -> Any:
    """x to the y; of zeros and infinities, and of negative numbers to what is not whole, NumPy's.

    Parameters
    ----------
    x, y : float arrays
        As for :func:`exp`.
    """
    if not (_is_plain(x) and _is_plain(y)):
        return np.power(x, y)
    x, y = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    known = (np.abs(x) < np.inf) & (np.abs(y) < np.inf) & ((x > 0) | ((x < 0) & (y == np.rint(y))))
    if known.all() and (x > 0).all():
        return _power(x, y)
    found = _power(np.where(known, np.abs(x), 1.0), np.where(known, y, 0.0))
    found = np.where((x < 0) & (np.abs(np.fmod(np.where(known, y, 0.0), 2)) == 1), -found, found)
    return np.where(known, found, np.power(np.where(known, 1.0, x), y))


def _is_plain(x: Any) -> bool:
    return isinstance(x, (np.ndarray, np.generic, float, int))


def _exp(x: Array, more: Any) -> Any:
    """The exponential of x + more, where more is small.

    exp(r) = 1 + r/((r/2) coth(r/2) - r/2) for what is left of x beside a multiple of ln(2).
    """
    x = np.minimum(np.maximum(x, -_BEYOND), _BEYOND)
    twos = np.rint(x * _PER_LN2)
    first, second = x - twos * _LN2[0], twos * _LN2[1]
    r = first - second
    more = more + ((first - r) - second)
    square = r * r
    rest = r / ((_series(_COTH, square) * square + 1) - 0.5 * r)
    rest = rest + (more + rest * more)
    return np.ldexp(rest + 1, twos.astype(np.int32))


def _log(x: Array) -> Any:
    """The logarithm of positive numbers: of a power of two, and 2 atanh(s) = f + s (s^2 P(s^2) - f)."""
    f, over, twos = _reduced(x)
    s = f / over
    square = s * s
    return twos * _LN2[0] + (f + (s * (square * _series(_ATANH, square) - f) + twos * _LN2[1]))


def _power(x: Array, y: Array) -> Any:
    """The same of positive numbers to y, by way of a logarithm in two parts."""
    f, over, twos = _reduced(x)
    s = f / over
    product, lost = _product(s, over)
    # What the division lost, also by what the sum m + 1 had lost.
    left = ((f - product) - lost - s * (f + 1 - (over - 1))) / over
    square = s * s
    whole, part = twos * _LN2[0], 2 * s
    high = whole + part
    back = high - whole
    low = (whole - (high - back)) + (part - back)
    low = low + (2 * left + s * square * _series(_ATANH, square) + twos * _LN2[1])
    high, low = high + low, low - ((high + low) - high)
    y = np.minimum(np.maximum(y, -(2.0**64)), 2.0**64)
    product, lost = _product(high, y)
    return _exp(product, np.minimum(np.maximum(lost + low * y, -(2.0**-40)), 2.0**-40))


def _reduced(x: Array) -> tuple[Any, Any, Any]:
    """m - 1, m + 1 and n of x = m 2^n with m between sqrt(1/2) and sqrt(2)."""
    m, twos = np.frexp(x)
    less = m < _LEAST
    m = np.where(less, 2 * m, m)
    return m - 1, m + 1, twos - less


def _series(coefficients: tuple[float, ...], z: Any) -> Any:
    """A polynomial, by Horner's rule."""
    return reduce(lambda found, coefficient: found * z + coefficient, reversed(coefficients))


def _product(a: Any, b: Any) -> tuple[Any, Any]:
    """A product and what its rounding lost.

    Source: T. J. Dekker, A floating-point technique for extending the available precision, Numerische
    Mathematik 18 (1971) 224-242.
    """
    found = a * b
    (a_high, a_low), (b_high, b_low) = _halves(a), _halves(b)
    return found, ((a_high * b_high - found) + a_high * b_low + a_low * b_high) + a_low * b_low


def _halves(a: Any) -> tuple[Any, Any]:
    """A number as a sum of two of half as many bits."""
    large = a * _HALF
    high = large - (large - a)
    return high, a - high
