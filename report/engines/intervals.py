"""Interval arithmetic on arrays: every result encloses what the operation gives for any values inside.

Ends are rounded outwards. Sums, products, quotients and square roots are rounded correctly by the processor
(IEEE 754), so that the neighbouring double encloses them; of exponentials and logarithms an error of
4 units in the last place is allowed for. An operation takes the part of an interval that lies in its domain,
and has no end on a side where the rest was left out.

NumPy's functions accept these arrays, so that a generated program runs on them as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache, reduce
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin
from numpy.typing import NDArray

from . import elementary

Array = NDArray[np.float64]

WIDER = 2.0**-50
"""Four units in the last place, at most: how far elementary functions may be off, relatively."""


_NOTHING = -(2.0**-800)
"""What rounding outwards makes of 0, and of that again: no part of it lies below 0."""
_BIT, _LEAST = 2.0**-53 * (1 + 2.0**-52), 2.0**-1074


class Intervals(NDArrayOperatorsMixin):
    """An array of closed intervals; of truths, an interval in 0 (false) to 1 (true).

    Parameters
    ----------
    low, high : float arrays of one shape
        Ends; infinite where nothing is known.

    Examples
    --------
    >>> x = Intervals([1.0], [2.0])
    >>> width = x - x
    >>> bool(width.low[0] <= -1 and width.high[0] >= 1)
    True
    """

    __slots__ = ("high", "low")

    def __init__(self, low: Any, high: Any) -> None:
        self.low: Array = np.asarray(low, dtype=np.float64)
        self.high: Array = np.asarray(high, dtype=np.float64)

    @classmethod
    def of(cls, value: Any) -> Intervals:
        """A number as an interval: a whole one is exact, another was rounded when it was written."""
        if isinstance(value, Intervals):
            return value
        if type(value) in (int, float):
            return _written(float(value))
        array = np.asarray(value, dtype=np.float64)
        if isinstance(value, (np.ndarray, np.floating)):
            return cls(array, array)
        exact = array == np.rint(array)
        return cls(np.where(exact, array, _below(array)), np.where(exact, array, _above(array)))

    @classmethod
    def near(cls, low: Any, high: Any) -> Intervals:
        """Ends that were rounded to doubles from what they are."""
        return cls(_below(np.asarray(low)), _above(np.asarray(high)))

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of both ends."""
        return np.broadcast_shapes(self.low.shape, self.high.shape)

    def __getitem__(self, key: Any) -> Intervals:
        return Intervals(self.low[key], self.high[key])

    def __setitem__(self, key: Any, value: Any) -> None:
        value = Intervals.of(value)
        self.low[key], self.high[key] = value.low, value.high

    def take(self, rows: NDArray[np.intp]) -> Intervals:
        """Rows of the last dimension."""
        return Intervals(self.low.take(rows, axis=-1), self.high.take(rows, axis=-1))

    def broadcast(self, shape: tuple[int, ...]) -> Intervals:
        """The same in a larger shape."""
        return Intervals(np.broadcast_to(self.low, shape), np.broadcast_to(self.high, shape))

    def where(self, known: NDArray[np.bool_]) -> Intervals:
        """The same where it is known, and anything elsewhere."""
        return Intervals(np.where(known, self.low, -np.inf), np.where(known, self.high, np.inf))

    def within(self, other: Intervals) -> Intervals:
        """What both contain; this one where they have nothing in common, which rounding alone can bring."""
        low, high = np.maximum(self.low, other.low), np.minimum(self.high, other.high)
        apart = ~(low <= high)
        return Intervals(np.where(apart, self.low, low), np.where(apart, self.high, high))

    def total(self, axis: int = -1, keepdims: bool = True) -> Intervals:
        """The sum along a dimension."""
        size = max(1, self.low.shape[axis] if self.low.ndim else 1)
        return self._summed(size, lambda end: end.sum(axis=axis, keepdims=keepdims))

    def totals(self, starts: NDArray[np.intp], axis: int = -1) -> Intervals:
        """Sums of neighbours along a dimension, counted from the last, each from a start to the next one."""
        sizes = np.diff(starts, append=self.low.shape[axis]).reshape(-1, *[1] * (-1 - axis))
        return self._summed(sizes, lambda end: np.add.reduceat(end, starts, axis=axis))

    def _summed(self, terms: Any, summed: Callable[[Array], Array]) -> Intervals:
        # n - 1 roundings, each of at most half an ulp of a partial sum, whatever the order of adding.
        slack = terms * 2.0**-52
        low, high, *sizes = map(summed, (self.low, self.high, np.abs(self.low), np.abs(self.high)))
        return _outwards(low - slack * sizes[0], high + slack * sizes[1])

    def in_order(self, places: Sequence[int]) -> list[Intervals]:
        """What stands at some places along the last dimension in the order of size, each (..., 1)."""
        ordered = Intervals(np.sort(self.low, axis=-1), np.sort(self.high, axis=-1))
        return [ordered[..., place, None] for place in places]

    @property
    def sign(self) -> Array:
        """-1 or 1 where it is certain, else 0."""
        return np.where(self.low > 0, 1.0, np.where(self.high < 0, -1.0, 0.0))

    # --- NumPy's functions ----------------------------------------------------------------------------

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        if ufunc is np.add and method == "reduceat":
            return inputs[0].totals(inputs[1], **options)
        run = _UFUNCS.get(ufunc.__name__)
        if run is None or method != "__call__" or options:
            return NotImplemented
        with np.errstate(all="ignore"):
            if ufunc.__name__ == "power":
                return _power(Intervals.of(inputs[0]), inputs[1])
            return run(*map(Intervals.of, inputs))

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        if function is not np.where or len(args) != 3:
            return NotImplemented
        truth, yes, no = map(Intervals.of, args)
        low = np.where(
            truth.low == 1, yes.low, np.where(truth.high == 0, no.low, np.minimum(yes.low, no.low))
        )
        high = np.where(
            truth.low == 1, yes.high, np.where(truth.high == 0, no.high, np.maximum(yes.high, no.high))
        )
        return _cleaned(low, high)


@lru_cache(maxsize=256)
def _written(number: float) -> Intervals:
    """A number of a program."""
    exact = not np.isfinite(number) or number.is_integer()
    return Intervals(number, number) if exact else Intervals(_below(number), _above(number))


def joined(parts: Sequence[Intervals]) -> Intervals:
    """Those of all parts beside one another, along the last dimension."""
    return Intervals(
        *(np.concatenate([getattr(part, end) for part in parts], axis=-1) for end in ("low", "high"))
    )


def whole(shape: tuple[int, ...]) -> Intervals:
    """Intervals of which nothing is known."""
    return Intervals(np.full(shape, -np.inf), np.full(shape, np.inf))


# --- ends ------------------------------------------------------------------------------------------------


def _below(value: Any) -> Array:
    found: Array = np.nextafter(value, -np.inf)
    return found


def _above(value: Any) -> Array:
    found: Array = np.nextafter(value, np.inf)
    return found


def _cleaned(low: Any, high: Any) -> Intervals:
    """No number means that nothing is known."""
    if (low <= high).all():
        return Intervals(low, high)
    unknown = np.isnan(low) | np.isnan(high)
    return Intervals(np.where(unknown, -np.inf, low), np.where(unknown, np.inf, high))


def _outwards(low: Any, high: Any) -> Intervals:
    """The neighbours of both ends, by a sum: nextafter() takes ten times as long.

    Source: S. M. Rump, P. Zimmermann, S. Boldo and G. Melquiond, Computing predecessor and successor in
    rounding to nearest, BIT Numerical Mathematics 49 (2009) 419-431.
    """
    below, above = low - (np.abs(low) * _BIT + _LEAST), high + (np.abs(high) * _BIT + _LEAST)
    if (below <= above).all():
        return Intervals(below, above)
    return _cleaned(_below(low), _above(high))  # some end is infinite, or no number


def _summed(low: Any, high: Any) -> Intervals:
    """The same of sums of two doubles each: one that is zero is exact."""
    found = _outwards(low, high)
    return Intervals(np.where(low == 0, 0.0, found.low), np.where(high == 0, 0.0, found.high))


def _loosely(low: Any, high: Any) -> Intervals:
    """Ends that an elementary function gave."""
    return _outwards(low - WIDER * np.abs(low), high + WIDER * np.abs(high))


def _at_ends(function: Callable[[Any], Any], a: Intervals) -> tuple[Any, Any]:
    """A function of both ends, called once: what it takes is mostly the calling."""
    if a.low is a.high:
        found = function(a.low)
        return found, found
    if a.low.shape != a.high.shape:
        return function(a.low), function(a.high)
    low, high = function(np.stack([a.low, a.high]))
    return low, high


# --- operations ------------------------------------------------------------------------------------------


def _multiply(a: Intervals, b: Intervals) -> Intervals:
    if a is b:  # printed so, a square is one
        return _whole_power(a, 2)
    # A number, which has one array for both ends, goes second: two products in place of four.
    if a.low is a.high:
        a, b = b, a
    ends = [x * y for x in (a.low, a.high) for y in ((b.low,) if b.low is b.high else (b.low, b.high))]
    low, high = reduce(np.minimum, ends), reduce(np.maximum, ends)
    if np.isnan(low).any():
        # Nothing times anything is nothing, however large.
        ends = [np.nan_to_num(end, nan=0.0, posinf=np.inf, neginf=-np.inf) for end in ends]
        low, high = reduce(np.minimum, ends), reduce(np.maximum, ends)
    return _outwards(low, high)


def _divide(a: Intervals, b: Intervals) -> Intervals:
    through_zero = (b.low <= 0) & (b.high >= 0)
    inverse = Intervals(
        np.where(through_zero, -np.inf, _below(1 / b.high)), np.where(through_zero, np.inf, _above(1 / b.low))
    )
    # A denominator that only touches zero has quotients of one sign.
    touches = through_zero & (b.low == 0) & (b.high > 0)
    inverse = Intervals(np.where(touches, _below(1 / b.high), inverse.low), inverse.high)
    touches = through_zero & (b.high == 0) & (b.low < 0)
    inverse = Intervals(inverse.low, np.where(touches, _above(1 / b.low), inverse.high))
    return _multiply(a, inverse)


def _power(base: Intervals, exponent: Any) -> Intervals:
    if not isinstance(exponent, Intervals) and np.ndim(exponent) == 0 and float(exponent).is_integer():
        return _whole_power(base, int(exponent))
    found = _exp(_multiply(Intervals.of(exponent), _log(base)))
    return Intervals(np.where(base.low < _NOTHING, -np.inf, found.low), found.high)


def _whole_power(base: Intervals, exponent: int) -> Intervals:
    if exponent < 0:
        return _divide(Intervals.of(1), _whole_power(base, -exponent))
    low, high = elementary.power(base.low, exponent), elementary.power(base.high, exponent)
    if exponent % 2 == 0:
        inside = (base.low <= 0) & (base.high >= 0)
        low, high = np.where(inside, 0.0, np.minimum(low, high)), np.maximum(low, high)
        found = _loosely(low, high)
        return Intervals(np.maximum(found.low, 0.0), found.high)
    return _loosely(low, high)


def _exp(a: Intervals) -> Intervals:
    """On which side of 1 it lies is certain: that of zero is 1."""
    found = _loosely(*_at_ends(elementary.exp, a))
    low = np.maximum(found.low, np.where(a.low >= 0, 1.0, 0.0))
    return Intervals(low, np.where(a.high <= 0, np.minimum(found.high, 1.0), found.high))


def _log(a: Intervals) -> Intervals:
    low, high = _at_ends(elementary.log, a)
    return _loosely(np.where(a.low > 0, low, -np.inf), np.where(a.high > 0, high, np.nan))


def _sqrt(a: Intervals) -> Intervals:
    found = _outwards(np.sqrt(np.maximum(a.low, 0.0)), np.sqrt(a.high))
    return Intervals(np.where(a.low < _NOTHING, -np.inf, np.maximum(found.low, 0.0)), found.high)


def _absolute(a: Intervals) -> Intervals:
    inside = (a.low <= 0) & (a.high >= 0)
    ends = np.abs(a.low), np.abs(a.high)
    return Intervals(np.where(inside, 0.0, np.minimum(*ends)), np.maximum(*ends))


def _rising(function: Callable[[Array], Array]) -> Callable[[Intervals], Intervals]:
    return lambda a: _loosely(function(a.low), function(a.high))


def _cos(a: Intervals) -> Intervals:
    # Which multiples of pi may lie inside, where the cosine is 1 or -1: rather one too many.
    first, last = np.ceil(a.low / np.pi - 1e-9), np.floor(a.high / np.pi + 1e-9)
    known = (np.abs(a.low) < 1e6) & (np.abs(a.high) < 1e6) & (last - first < 1)
    ends, even = (np.cos(a.low), np.cos(a.high)), first % 2 == 0
    low = np.where((first == last) & ~even, -1.0, np.minimum(*ends) - WIDER)
    high = np.where((first == last) & even, 1.0, np.maximum(*ends) + WIDER)
    return _cleaned(np.where(known, np.maximum(low, -1.0), -1.0), np.where(known, np.minimum(high, 1.0), 1.0))


def _sin(a: Intervals) -> Intervals:
    quarter = Intervals(np.array(_below(np.pi / 2)), np.array(_above(np.pi / 2)))
    return _cos(_UFUNCS["subtract"](a, quarter))


def _tan(a: Intervals) -> Intervals:
    # Which odd multiples of pi/2 may lie inside, where it jumps: rather one too many.
    first, last = np.ceil(a.low / np.pi - 0.5 - 1e-9), np.floor(a.high / np.pi - 0.5 + 1e-9)
    known = (np.abs(a.low) < 1e6) & (np.abs(a.high) < 1e6) & (last < first)
    found = _loosely(np.tan(a.low), np.tan(a.high))
    return Intervals(np.where(known, found.low, -np.inf), np.where(known, found.high, np.inf))


def _truth(certain: Any, possible: Any) -> Intervals:
    return Intervals(np.where(certain, 1.0, 0.0), np.where(possible, 1.0, 0.0))


def _equal(a: Intervals, b: Intervals) -> Intervals:
    same = (a.low == a.high) & (b.low == b.high) & (a.low == b.low)
    return _truth(same, (a.low <= b.high) & (b.low <= a.high))


def _not(a: Intervals) -> Intervals:
    return Intervals(1 - a.high, 1 - a.low)


def _smaller(a: Intervals, b: Intervals) -> Intervals:
    return Intervals(np.minimum(a.low, b.low), np.minimum(a.high, b.high))


def _larger(a: Intervals, b: Intervals) -> Intervals:
    return Intervals(np.maximum(a.low, b.low), np.maximum(a.high, b.high))


def _less(a: Intervals, b: Intervals) -> Intervals:
    return _truth(a.high < b.low, a.low < b.high)


def _less_equal(a: Intervals, b: Intervals) -> Intervals:
    return _truth(a.high <= b.low, a.low <= b.high)


_UFUNCS: dict[str, Callable[..., Intervals]] = {
    "add": lambda a, b: _summed(a.low + b.low, a.high + b.high),
    "subtract": lambda a, b: _summed(a.low - b.high, a.high - b.low),
    "multiply": _multiply,
    "divide": _divide,
    "power": _power,
    "negative": lambda a: Intervals(-a.high, -a.low),
    "positive": lambda a: a,
    "absolute": _absolute,
    "square": lambda a: _whole_power(a, 2),
    "sign": lambda a: Intervals(np.sign(a.low), np.sign(a.high)),
    "sqrt": _sqrt,
    "exp": _exp,
    "log": _log,
    "cos": _cos,
    "sin": _sin,
    "tan": _tan,
    "arccos": lambda a: _loosely(np.arccos(a.high), np.arccos(a.low)),
    "cosh": lambda a: _loosely(np.cosh(_absolute(a).low), np.cosh(_absolute(a).high)),
    **{
        function.__name__: _rising(function)
        for function in (np.expm1, np.log1p, np.cbrt, np.arcsin, np.arctan, np.sinh, np.tanh, np.arcsinh)
    },
    "floor": lambda a: Intervals(np.floor(a.low), np.floor(a.high)),
    "ceil": lambda a: Intervals(np.ceil(a.low), np.ceil(a.high)),
    "heaviside": lambda a, _: _truth(a.low > 0, a.high >= 0),
    "minimum": _smaller,
    "maximum": _larger,
    "less": _less,
    "greater": lambda a, b: _less(b, a),
    "less_equal": _less_equal,
    "greater_equal": lambda a, b: _less_equal(b, a),
    "equal": _equal,
    "not_equal": lambda a, b: _not(_equal(a, b)),
    "logical_and": _smaller,
    "logical_or": _larger,
    "logical_not": _not,
}
"""What intervals can do; a program that asks for more is not run on them."""
