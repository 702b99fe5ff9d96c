"""Where claims are evaluated: points drawn from the spans of symbols, and how a reader is told of one."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Mapping
from typing import Any

import mpmath
from sympy import Indexed, Integer, Symbol
from sympy.logic.boolalg import Boolean

from .proved import DIGITS
from .reductions import REDUCTIONS
from .text import text
from .vocabulary import Vocabulary

_DIGITS = 6
"""Of a number in a sentence."""
_FEW, _MANY = 5, 1000
"""Sizes of sums are drawn up to the first number, and about the rows that are named, up to the second."""

_Span = tuple[Any, Any, bool]
"""Where an interval begins, how wide it is, and whether only whole numbers count."""


def _drawn(rng: random.Random, span: _Span) -> Any:
    low, width, whole = span
    value = low + width * rng.random()
    return mpmath.floor(value) if whole else value


class SampledRows:
    """The rows of a column at a point, each drawn when it is asked for."""

    def __init__(self, seed: str, span: _Span) -> None:
        self.seed, self.span = seed, span
        self.known: dict[int, Any] = {}

    def __getitem__(self, row: int) -> Any:
        if row not in self.known:
            self.known[row] = _drawn(random.Random(f"{self.seed} {row}"), self.span)
        return self.known[row]

    def with_row(self, row: int, value: Any) -> SampledRows:
        """The same rows but one."""
        other = SampledRows(self.seed, self.span)
        other.known = {**self.known, row: value}
        return other


class Space:
    """Where symbols are drawn from: sizes of sums and numbers of rows, columns, and free symbols.

    Parameters
    ----------
    expressions : sequence of Expr
        What is to be evaluated.
    names : mapping
        The cell or the quantity that a symbol stands for, where it is not its own name.
    vocabulary : Vocabulary
        What the symbols are called, and in which interval each is drawn.
    fixed : collection of Expr
        Symbols that are not drawn.
    """

    def __init__(
        self, expressions: Any, names: Mapping[Any, Any], vocabulary: Vocabulary, fixed: Any = ()
    ) -> None:
        self.names, self.vocabulary = names, vocabulary
        cells = {cell for e in expressions for cell in e.atoms(Indexed)}
        columns = {cell.base.label for cell in cells}
        sums = [total for e in expressions for total in e.atoms(*REDUCTIONS)]
        ends = [end for total in sums for limit in total.limits for end in limit[1:]]
        rows = [row for cell in cells for row in cell.indices]
        free = {s for e in expressions for s in e.free_symbols if isinstance(s, Symbol)} - columns
        sizes = {s for place in (*ends, *rows) for s in place.free_symbols} & free
        bounds = [e for e in expressions if isinstance(e, Boolean) and e.free_symbols & sizes]
        named = (number for part in (*ends, *rows, *bounds) for number in part.atoms(Integer))
        most = max([_FEW, *(int(number) + 2 for number in named if number < _MANY)])
        self.counts = sorted({*range(1, _FEW + 1), *range(max(1, most - _FEW), most + 1)})
        self.sizes = sorted(sizes, key=self.name)
        self.columns = sorted(columns, key=self.name)
        self.scalars = sorted(free - sizes - set(fixed), key=self.name)

    @property
    def symbols(self) -> list[Any]:
        """All that is drawn, in the order of a point's values."""
        return [*self.sizes, *self.columns, *self.scalars]

    def name(self, symbol: Any) -> str:
        """How a reader knows the symbol."""
        return text(self.names.get(symbol, symbol), self.vocabulary)

    def points(self, seed: str, count: int) -> Iterator[list[Any]]:
        """Draw points; the same seed always gives the same ones."""
        rng = random.Random(seed)
        columns = [self._span(column) for column in self.columns]
        scalars = [self._span(symbol) for symbol in self.scalars]
        for number in range(count):
            yield [
                *(mpmath.mpf(rng.choice(self.counts)) for _ in self.sizes),
                *(SampledRows(f"{seed} {number} {place}", span) for place, span in enumerate(columns)),
                *(_drawn(rng, span) for span in scalars),
            ]

    def _span(self, symbol: Any) -> _Span:
        """The interval of a symbol.

        It is the vocabulary's, where its symbol is no freer than this one.
        """
        quantity, whole = self.vocabulary.find(self.names.get(symbol, symbol)), bool(symbol.is_integer)
        if quantity is not None and (quantity.positive or not symbol.is_positive):
            low, high = quantity.span
            if quantity.whole:
                low, high, whole = math.ceil(low), math.floor(high) + 1, True
        elif whole:
            low, high = (1.0 if symbol.is_positive else -9.0), 9.0
        else:
            low, high = (0.5 if symbol.is_positive else -2.0), 2.0
        return mpmath.mpf(low), mpmath.mpf(high) - mpmath.mpf(low), whole

    def describe(self, point: list[Any], more: Mapping[Any, Any] | None = None) -> dict[str, str]:
        """Say where a point lies; of a column, the rows that were asked for."""
        found: dict[str, str] = {}
        for symbol, value in [*zip(self.symbols, point, strict=True), *(more or {}).items()]:
            name = self.name(symbol)
            if not isinstance(value, SampledRows):
                found[name] = short(value)
            elif len(value.known) == max(value.known, default=0):
                found[name] = f"({', '.join(short(value[row + 1]) for row in range(len(value.known)))})"
            else:
                found |= {f"{name}_{row}": short(value[row]) for row in sorted(value.known)}
        return found


def short(value: Any, digits: int = _DIGITS) -> str:
    """Write a number for a reader."""
    return str(mpmath.nstr(value, digits))


def apart(one: Any, other: Any) -> tuple[str, str]:
    """Write two numbers that are not the same with the digits in which they differ."""
    written = ((short(one, n), short(other, n)) for n in range(_DIGITS, DIGITS + 1))
    return next((both for both in written if both[0] != both[1]), (short(one), short(other)))
