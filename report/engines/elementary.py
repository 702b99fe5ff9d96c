"""Exponentials, logarithms and powers of arrays: the same bits on every processor.

NumPy's own have other last bits where the processor has other instructions. Here everything is made of sums,
products and quotients of doubles, which IEEE 754 rounds correctly, and of steps that round nothing. The last
bit may be wrong, as in NumPy's: an error is at most 2 units of it. It takes longer.
"""

from __future__ import annotations

from collections.abc import Callable
from math import factorial
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def _numbers(*values: float) -> tuple[Array, ...]:
    """Constants as arrays: NumPy takes twice as long for a number of Python's."""
    return tuple(map(np.array, values))


_LN2 = _numbers(float.fromhex("0x1.62e42fefa3800p-1"), float.fromhex("0x1.ef35793c76730p-45"))
"""The logarithm of 2 in two parts. The first has 42 bits: its product with an exponent is exact."""
_COTH = _numbers(1 / 12, -1 / 720, 1 / 30240, -1 / 1209600, 1 / 47900160, -691 / 1307674368000)
"""B_2k/(2k)!: the series of (r/2) coth(r/2) - 1 in r^2; as many terms as doubles tell for r up to
ln(2)/2."""
_ATANH = _numbers(*(2 / (2 * k + 1) for k in range(1, 11)))
"""The series of 2 atanh(s)/s - 2 in s^2; as many terms as doubles tell for s up to
(sqrt(2)-1)/(sqrt(2)+1)."""
_PER_LN2, _HALF, _ONE, _TWO, _LEAST = _numbers(float.fromhex("0x1.71547652b82fep+0"), 0.5, 1.0, 2.0, 0.5**0.5)
_LARGE, _FAINT = _numbers(-(2.0**64), 2.0**64), _numbers(-(2.0**-40), 2.0**-40)
_BEYOND = _numbers(-750.0, 750.0)
"""Exponentials of more, and of less than its opposite, are no positive double."""
_SPLIT = np.array(2.0**27 + 1)
_FEW = 2.0**-6
"""How far numbers may be from one, relatively for logarithms, to be computed from what that one has."""
_FAINTER = 2.0**-57
"""What is this small beside 1 is left out."""
_PER_FACTORIALS = _numbers(*(1 / factorial(k) for k in range(10)))
"""The series of exp(r), as many terms as doubles tell for r up to _FEW."""
_BLOCK = 1 << 13
"""How many numbers are computed at a time: what is written down on the way then stays in the processor's
cache."""


def exp(x: Any) -> Any:
    """The exponential.

    `x` (float array): what has an arithmetic of its own, such as intervals, does it by that.
    """
    if not _is_plain(x):
        return np.exp(x)
    x = np.asarray(x, dtype=np.float64)
    known = x == x
    if known.all():
        return _in_blocks(_exp, x)
    return np.where(known, _in_blocks(_exp, np.where(known, x, 0.0)), np.nan)


def log(x: Any) -> Any:
    """The natural logarithm; of what is not positive and finite, NumPy's.

    `x` (float array): as for :func:`exp`.
    """
    if not _is_plain(x):
        return np.log(x)
    x = np.asarray(x, dtype=np.float64)
    known = (x > 0) & (x < np.inf)
    if known.all():
        return _in_blocks(_log, x)
    return np.where(known, _in_blocks(_log, np.where(known, x, 1.0)), np.log(np.where(known, 1.0, x)))


def power(x: Any, y: Any) -> Any:
    """x to the y; of zeros and infinities, and of negative numbers to what is not whole, NumPy's.

    `x` and `y` (float arrays): as for :func:`exp`.
    """
    if not (_is_plain(x) and _is_plain(y)):
        return np.power(x, y)
    x, y = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    known = (np.abs(x) < np.inf) & (np.abs(y) < np.inf) & ((x > 0) | ((x < 0) & (y == np.rint(y))))
    if known.all() and (x > 0).all():
        return _in_blocks(_power, x, y)
    found = _in_blocks(_power, np.where(known, np.abs(x), 1.0), np.where(known, y, 0.0))
    found = np.where((x < 0) & (np.abs(np.fmod(np.where(known, y, 0.0), 2)) == 1), -found, found)
    return np.where(known, found, np.power(np.where(known, 1.0, x), y))


def exp_beside(x: Any) -> Any:
    """The exponential of a batch that lies close together: a few terms beside that of its first element.

    `x` (float array (batch, ...)): as for :func:`exp`. The last bits of an element hang on which is the first
    of the batch.
    """
    if not _is_plain(x) or np.ndim(x) < 2:
        return exp(x)
    r = x - x[:1]
    reach = max(float(r.max()), -float(r.min()))
    if not reach <= _FEW:
        return exp(x)
    terms, left = 1, reach
    while left > _FAINTER:
        terms += 1
        left *= reach / terms
    first = exp(x[:1])
    found = _series(_PER_FACTORIALS[1 : max(terms, 3)], r)
    found *= r
    found *= first
    found += first
    return found


def log_beside(x: Any) -> Any:
    """The natural logarithm of a batch that lies close together: a few terms beside its first element's.

    `x` (float array (batch, ...)): as for :func:`exp_beside`.
    """
    if not _is_plain(x) or np.ndim(x) < 2:
        return log(x)
    first = x[:1]
    s = x - first
    s /= x + first
    reach, begun = max(float(s.max()), -float(s.min())), log(first)
    # A sum that cancels would lose digits of what it is made of.
    if not (reach <= _FEW and reach <= float(np.abs(begun).min()) / 8):
        return log(x)
    terms, left = 1, reach * reach
    while left > _FAINTER:
        terms += 1
        left *= reach * reach
    square = s * s
    found = _series(_ATANH[: max(terms, 2)], square)
    found *= square
    found += _TWO
    found *= s
    found += begun
    return found


def _is_plain(x: Any) -> bool:
    return isinstance(x, (np.ndarray, np.generic, float, int))


def _in_blocks(function: Callable[..., Any], *given: Array) -> Any:
    """A function of flat arrays, of which it may write to those that it makes, a block at a time."""
    first, *others = given
    shape = np.broadcast_shapes(*(each.shape for each in given)) if others else first.shape
    flat = [each if each.shape == shape else np.broadcast_to(each, shape) for each in given]
    flat = [each.reshape(-1) for each in flat]
    size = flat[0].size
    if size <= _BLOCK:
        found = function(*flat)
    else:
        found = np.empty(size)
        for begin in range(0, size, _BLOCK):
            block = slice(begin, begin + _BLOCK)
            found[block] = function(*(each[block] for each in flat))
    return found.reshape(shape) if shape else found[0]


def _exp(x: Array, more: Any = None) -> Any:
    """The exponential of x + more, where more is small.

    exp(r) = 1 + r/((r/2) coth(r/2) - r/2) for what is left of x beside a multiple of ln(2).
    """
    x = _clipped(x, _BEYOND)
    twos = x * _PER_LN2
    np.rint(twos, twos)
    first, second = twos * _LN2[0], twos * _LN2[1]
    np.subtract(x, first, first)
    r = first - second
    first -= r
    first -= second
    if more is not None:
        first += more
    square = r * r
    rest = _series(_COTH, square)
    rest *= square
    rest += _ONE
    np.multiply(r, _HALF, square)
    rest -= square
    np.divide(r, rest, rest)
    np.multiply(rest, first, square)
    first += square
    rest += first
    rest += _ONE
    return np.ldexp(rest, twos.astype(np.int32), rest)


def _log(x: Array) -> Any:
    """The logarithm of positive numbers: of a power of two, and 2 atanh(s) = f + s (s^2 P(s^2) - f)."""
    f, over, twos = _reduced(x)
    s = np.divide(f, over, over)
    square = s * s
    rest = _series(_ATANH, square)
    rest *= square
    rest -= f
    rest *= s
    rest += np.multiply(twos, _LN2[1], square)
    rest += f
    rest += np.multiply(twos, _LN2[0], square)
    return rest


def _power(x: Array, y: Array) -> Any:
    """The same of positive numbers to y, by way of a logarithm in two parts."""
    f, over, twos = _reduced(x)
    s = f / over
    product, lost = _product(s, over)
    # What the division lost, also by what the sum m + 1 had lost.
    left = ((f - product) - lost - s * (f + _ONE - (over - _ONE))) / over
    square = s * s
    whole, part = twos * _LN2[0], _TWO * s
    high = whole + part
    back = high - whole
    low = (whole - (high - back)) + (part - back)
    low += _TWO * left + s * square * _series(_ATANH, square) + twos * _LN2[1]
    high, low = high + low, low - ((high + low) - high)
    y = _clipped(y, _LARGE)
    product, lost = _product(high, y)
    return _exp(product, _clipped(lost + low * y, _FAINT))


def _clipped(x: Array, ends: tuple[Array, ...]) -> Array:
    """The nearest numbers between two."""
    found: Array = np.maximum(x, ends[0])
    return np.minimum(found, ends[1], out=found)


def _reduced(x: Array) -> tuple[Array, Array, Array]:
    """m - 1, m + 1 and n of x = m 2^n with m between sqrt(1/2) and sqrt(2)."""
    m, twos = np.frexp(x)
    less = m < _LEAST
    np.multiply(m, _TWO, m, where=less)
    return m - _ONE, m + _ONE, np.subtract(twos, less, dtype=np.float64)


def _series(coefficients: tuple[Array, ...], z: Array) -> Array:
    """A polynomial, by Horner's rule."""
    *others, second, first = coefficients
    found = z * first
    found += second
    for coefficient in reversed(others):
        found *= z
        found += coefficient
    return found


def _product(a: Array, b: Array) -> tuple[Array, Array]:
    """A product and what its rounding lost.

    Source: T. J. Dekker, A floating-point technique for extending the available precision, Numerische
    Mathematik 18 (1971) 224-242.
    """
    found = a * b
    (a_high, a_low), (b_high, b_low) = _halves(a), _halves(b)
    return found, ((a_high * b_high - found) + a_high * b_low + a_low * b_high) + a_low * b_low


def _halves(a: Array) -> tuple[Array, Array]:
    """A number as a sum of two of half as many bits."""
    large = a * _SPLIT
    high = large - (large - a)
    return high, a - high
