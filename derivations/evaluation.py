"""Evaluates expressions with many digits: what a proof's numerical half and the checks of the print use.

Expressions become one list of operations. Common parts are computed once, and what does not run with the
index of a sum or the variable of an integral is taken out of its loop. No text is generated or executed.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache, partial, reduce
from statistics import median
from typing import Any

import mpmath
import sympy as sp
from sympy.logic.boolalg import BooleanAtom

from .reductions import REDUCTIONS, Greatest, Least, Median

UNDEFINED = (ZeroDivisionError, ValueError, OverflowError, TypeError, IndexError)
"""What running a program raises where an expression has no value."""

_SAME_NAME = (
    "exp log sin cos tan cot sec csc asin acos atan atan2 sinh cosh tanh coth sech csch "
    "asinh acosh atanh acoth gamma loggamma polygamma beta factorial binomial erf erfc erfi erfinv zeta "
    "floor sign besselj bessely besseli besselk"
)
"""Functions that sympy and mpmath call by one name and define alike."""

_FUNCTIONS: dict[Any, Callable[..., Any]] = {
    **{getattr(sp, name): getattr(mpmath, name) for name in _SAME_NAME.split()},
    sp.betainc: mpmath.betainc,
    sp.ceiling: mpmath.ceil,
    sp.LambertW: mpmath.lambertw,
    sp.elliptic_k: mpmath.ellipk,
    sp.elliptic_e: mpmath.ellipe,
    sp.Abs: abs,
    sp.Max: max,
    sp.Min: min,
    sp.Lt: operator.lt,
    sp.Le: operator.le,
    sp.Gt: operator.gt,
    sp.Ge: operator.ge,
    sp.Eq: operator.eq,
    sp.Ne: operator.ne,
    sp.And: lambda *parts: all(parts),
    sp.Or: lambda *parts: any(parts),
    sp.Not: operator.not_,
}
_TAKEN: dict[Any, Callable[[Iterator[Any]], Any]] = {
    sp.Sum: partial(sum, start=mpmath.mpf(0)),
    Median: median,
    Greatest: max,
    Least: min,
}


class NotEvaluable(Exception):
    """An expression holds something that has no numerical meaning here; the message names it."""


def is_real(value: Any) -> bool:
    """Whether a computed value is a finite real number."""
    return isinstance(value, mpmath.mpf) and bool(mpmath.isfinite(value))


_FINEST, _BLURRED = 2, 1e-6
"""How often the step of the integration rule is halved, and how uncertain an integral may then still be."""


_GUARD = 10
"""More digits for what is integrated: an abscissa next to an end must not be rounded to it."""


_REMEMBERED = 64
"""Values of an integral that are kept."""


@lru_cache(maxsize=8)
def _nodes(digits: int, halvings: int) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """Abscissae on (0, 1) and weights of the double-exponential rule.

    Measured on t^p, p from 1 to 5/2, whose derivatives are infinite at an end: `digits` digits are right.
    """
    steps = 4 * (digits // 7) << halvings
    places, weights = [], []
    with mpmath.workdps(digits + _GUARD):
        # Beyond |t| = 6 no weight is left, whatever the digits.
        for n in range(-6 * steps, 6 * steps + 1):
            t = mpmath.mpf(n) / steps
            # x = 1/(1 + exp(-pi sinh t)): near both ends the weights fall doubly exponentially.
            grow = mpmath.exp(-mpmath.pi * mpmath.sinh(t))
            place = 1 / (1 + grow)
            weight = mpmath.pi * mpmath.cosh(t) * grow * place**2 / steps
            if weight > mpmath.mpf(10) ** -(digits + 1):
                places.append(place)
                weights.append(weight)
    return tuple(places), tuple(weights)


def _folded(operation: Callable[[Any, Any], Any], count: int) -> Callable[..., Any]:
    return operation if count == 2 else lambda *parts: reduce(operation, parts)


def _whole_power(n: int) -> Callable[[Any], Any]:
    if n == 2:
        return lambda x: x * x
    return (lambda x: x**n) if n > 0 else (lambda x: 1 / x**-n)


def _power(base: Any, exponent: Any) -> Any:
    if isinstance(base, mpmath.mpf) and base == 0 and exponent <= 0:
        raise ZeroDivisionError
    return base**exponent


def _row(column: Any, number: Any) -> Any:
    """A row of a column; the first has the number one."""
    if number < 1 or number != int(number):
        raise IndexError(number)
    return column[int(number)]


def _choose(*parts: Any) -> Any:
    for value, condition in zip(parts[::2], parts[1::2], strict=True):
        if condition:
            return value
    raise ValueError("no branch applies")


class Tape:
    """Operations that compute expressions from given symbols, in groups that run one after the other.

    Parameters
    ----------
    given : sequence of Expr
        Symbols whose values `start` gets; the label of an indexed symbol gets a list.

    Raises
    ------
    NotEvaluable
        By `add` and `define`, on a rounded number, an unknown symbol or function.
    """

    def __init__(self, given: Sequence[Any]) -> None:
        self._slots: list[Any] = []
        self._levels: list[int] = []
        self._known: list[dict[Any, int]] = [{}]
        self._tapes: list[list[tuple[int, Callable[..., Any], tuple[int, ...]]]] = [[]]
        self._beneath: dict[int, list[int]] = {}
        """What a loop names of what stands outside of it, by its slot."""
        self._done = 0
        self.blur = mpmath.mpf(0)
        """How far, relatively, integrals may be off that were not resolved to all digits, since `start`."""
        self._given = [self._fresh(symbol, 0) for symbol in given]

    # --- writing the list ------------------------------------------------------------------------------

    def _fresh(self, expression: Any, level: int, value: Any = None) -> int:
        self._slots.append(value)
        self._levels.append(level)
        slot = len(self._slots) - 1
        self._known[level][expression] = slot
        return slot

    def define(self, symbol: Any, expression: Any) -> tuple[int, int]:
        """Let a symbol stand for an expression from here on; returns the group of its value."""
        slot = self._slot(expression)
        self._known[0][symbol] = slot
        return slot, len(self._tapes[0])

    def add(self, expressions: Iterable[Any]) -> tuple[list[int], int]:
        """Append a group of expressions; `values` computes them."""
        return [self._slot(expression) for expression in expressions], len(self._tapes[0])

    def _slot(self, expression: Any) -> int:
        # What stands outside of a loop is known inside; what stands inside is forgotten when it ends.
        for known in self._known:
            if expression in known:
                return known[expression]
        if isinstance(expression, (sp.Float, complex, float)):
            raise NotEvaluable(f"{expression} is a rounded number")
        if isinstance(expression, sp.Rational):
            value: Any = mpmath.mpf(expression.p) / mpmath.mpf(expression.q)
            return self._fresh(expression, 0, value)
        if isinstance(expression, sp.NumberSymbol):
            return self._fresh(expression, 0, expression._to_mpmath(mpmath.mp.prec))
        if isinstance(expression, BooleanAtom):
            return self._fresh(expression, 0, bool(expression))
        if isinstance(expression, (sp.Integral, *REDUCTIONS)):
            return self._loop(expression)
        function, arguments = self._operation(expression)
        slots = tuple(self._slot(argument) for argument in arguments)
        level = max((self._levels[slot] for slot in slots), default=0)
        slot = self._fresh(expression, level)
        self._tapes[level].append((slot, function, slots))
        return slot

    @staticmethod
    def _operation(expression: Any) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        """Which function of which arguments an expression is."""
        match expression:
            case sp.Add():
                return _folded(operator.add, len(expression.args)), expression.args
            case sp.Mul():
                return _folded(operator.mul, len(expression.args)), expression.args
            case sp.Pow():
                base, exponent = expression.args
                if exponent.is_Integer:
                    return _whole_power(int(exponent)), (base,)
                if exponent == sp.Rational(1, 2):
                    return mpmath.sqrt, (base,)
                return _power, (base, exponent)
            case sp.Indexed() if len(expression.indices) == 1:
                return _row, (expression.base.label, expression.indices[0])
            case sp.Piecewise():
                return _choose, tuple(part for branch in expression.args for part in branch.args)
        for kind, function in _FUNCTIONS.items():
            if isinstance(expression, kind):
                return function, expression.args
        name = (
            expression
            if isinstance(expression, sp.Basic) and expression.is_Atom
            else type(expression).__name__
        )
        raise NotEvaluable(f"{name} has no value")

    def _loop(self, expression: Any) -> int:
        """A reduction or an integral: its body has a list of operations of its own, run at each place."""
        *inner, limits = expression.limits
        if len(limits) != 3:
            raise NotEvaluable(f"{expression} has no limits")
        variable, low, high = limits
        function = expression.func(expression.function, *inner) if inner else expression.function
        if any(variable in known for known in self._known):  # what runs inside hides what runs outside
            hidden, variable = variable, sp.Symbol(f"{variable}'", **variable.assumptions0)
            function = function.xreplace({hidden: variable})
        ends = (self._slot(low), self._slot(high))
        level = len(self._tapes)
        self._tapes.append([])
        self._known.append({})
        running = self._fresh(variable, level)
        body = self._slot(function)
        tape = self._tapes.pop()
        self._known.pop()
        kind = type(expression)
        at = self._integral if kind is sp.Integral else partial(self._taken, _TAKEN[kind])
        named = {body, *(each for _, _, used in tape for each in used)}
        named |= {each for inner, _, _ in tape for each in self._beneath.get(inner, ())}
        beneath = sorted(each for each in named if self._levels[each] < level)
        # The loop stands in the innermost loop that anything in it runs with, and is taken out of all others.
        outer = max(self._levels[each] for each in (*ends, *beneath))
        slot = self._fresh(expression, outer)
        self._beneath[slot] = beneath
        run: Callable[..., Any] = partial(at, tape, running, body)
        if kind is sp.Integral:
            run = self._remembering(run, beneath)
        # A body that does not run with the variable is no part of the tape: it must be there before.
        arguments = (*ends, *((body,) if self._levels[body] < level else ()))
        self._tapes[outer].append((slot, lambda start, stop, *_: run(start, stop), arguments))
        return slot

    def _remembering(self, run: Callable[..., Any], beneath: Sequence[int]) -> Callable[..., Any]:
        """An integral that is not computed again where nothing in it has moved: in most steps of a search."""
        known: dict[Any, tuple[Any, Any]] = {}

        def remembered(*ends: Any) -> Any:
            moves = (self._slots[slot] for slot in beneath)
            key = (mpmath.mp.prec, *ends, *(tuple(v) if isinstance(v, list) else v for v in moves))
            if key not in known:
                if len(known) >= _REMEMBERED:
                    known.clear()
                known[key] = run(*ends)
            value, blur = known[key]
            self.blur = max(self.blur, blur)
            return value

        return remembered

    # --- running it ------------------------------------------------------------------------------------

    def start(self, values: Sequence[Any]) -> None:
        """Begin anew with these values of the given symbols."""
        for slot, value in zip(self._given, values, strict=True):
            self._slots[slot] = value
        self._done, self.blur = 0, mpmath.mpf(0)

    def values(self, group: tuple[Any, int]) -> Any:
        """Compute a group; groups run in the order in which they were added."""
        wanted, end = group
        self._run(self._tapes[0][self._done : end])
        self._done = max(self._done, end)
        return self._slots[wanted] if isinstance(wanted, int) else [self._slots[slot] for slot in wanted]

    def _run(self, tape: Sequence[tuple[int, Callable[..., Any], tuple[int, ...]]]) -> None:
        slots = self._slots
        for slot, function, arguments in tape:
            slots[slot] = function(*[slots[argument] for argument in arguments])

    def _terms(self, tape: Any, running: int, body: int, low: Any, high: Any) -> Iterator[Any]:
        if low != int(low) or high != int(high):
            raise ValueError("a sum runs over whole numbers")
        for number in range(int(low), int(high) + 1):
            self._slots[running] = mpmath.mpf(number)
            self._run(tape)
            yield self._slots[body]

    def _taken(self, take: Callable[[Iterator[Any]], Any], *loop: Any) -> Any:
        return take(self._terms(*loop))

    def _integral(self, tape: Any, running: int, body: int, low: Any, high: Any) -> tuple[Any, Any]:
        """The integral, and by what part of itself it may be off where it was not resolved to all digits."""
        digits = mpmath.mp.dps
        for halvings in range(_FINEST + 1):
            places, weights = _nodes(digits, halvings)
            with mpmath.workdps(digits + _GUARD):
                values = []
                for place in places:
                    self._slots[running] = low + (high - low) * place
                    self._run(tape)
                    values.append(self._slots[body])
                fine, size = mpmath.fdot(weights, values), mpmath.fdot(weights, map(abs, values))
                # With half as many places about two thirds of the digits are left. Measured on (t + c)^p with
                # c down to 1e-7 of the interval: a gap of 1e-35 leaves 43 digits of 50.
                gap = abs(fine - 2 * mpmath.fdot(weights[::2], values[::2]))
            if gap <= mpmath.mpf(10) ** (-7 * digits // 10) * size:
                return (high - low) * fine, mpmath.mpf(0)
        if not gap <= _BLURRED * size:
            raise ValueError("the integral was not resolved")
        return (high - low) * fine, gap / size
