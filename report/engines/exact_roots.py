"""How many roots a row has, for the judge: depth first, with mpmath's intervals.

Where an equation sums over rows, or has functions that mpmath's intervals do not know, it is put into the
intervals of arrays that NumPy's program uses: there the judge is independent in its search and its data only.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Any

import mpmath
import numpy as np
from mpmath import iv

from .interval_functions import holds, running, sign
from .intervals import Intervals
from .isolation import HALVINGS, crossings
from .kernels import Enclosing
from .numpy_enclosed import EnclosedRows

MOST_PARTS = 2000
"""How many parts of an interval are looked at."""
Enclose = Callable[[Any, Any], tuple[int, int]]
"""For both ends of a part, the signs of the equation and of its slope there; 0 where that is not certain."""


def brackets(enclose: Enclose, low: Any, high: Any, signs: Sequence[Any]) -> list[tuple[Any, Any, Any]]:
    """Isolate the roots of an open interval.

    Parameters
    ----------
    signs : sequence of mpf or None
        The equation's at both ends, where the rule gives it.

    Returns
    -------
    list of (left, right, sign at the right end)

    Raises
    ------
    Doubtful
        They cannot be counted.
    """
    if not low < high:
        return []
    ends = [
        enclose(end, end)[0] or (0 if told is None else mpmath.sign(told))
        for end, told in zip((low, high), signs, strict=True)
    ]
    left = iter(range(MOST_PARTS))
    return crossings((low, high), (ends[0], ends[1]), _parts(enclose, low, high, HALVINGS, left))


def _parts(enclose: Enclose, low: Any, high: Any, halvings: int, left: Iterator[int]) -> Iterator[Any]:
    """All of an interval in parts of which something is certain, or nothing, in order."""
    sign, slope = enclose(low, high)
    if sign or slope or not halvings or next(left, None) is None:
        yield low, high, sign, slope
        return
    middle = (low + high) / 2
    yield from _parts(enclose, low, middle, halvings - 1, left)
    yield from _parts(enclose, middle, high, halvings - 1, left)


# --- mpmath's intervals ----------------------------------------------------------------------------------


def of_mpmath(text: str, kinds: Sequence[str]) -> Callable[[Sequence[Any]], Enclose]:
    """What encloses a form by mpmath's intervals, for the values of the cells that it names.

    `text`: the function of these and of the unknown that returns the form, its slope, and the differences
    that must compare with zero so that the slope tells its course. `kinds`: how, for each
    (:func:`~loopsheet.report.engines.interval_functions.holds`).
    """
    run = running(text)

    def of_row(values: Sequence[Any]) -> Enclose:
        def enclose(low: Any, high: Any) -> tuple[int, int]:
            middle = (low + high) / 2
            here, there = run(*values, [low, high]), run(*values, [middle, middle])
            if here is None:
                return 0, 0
            if not all(holds(kind, each) for kind, each in zip(kinds, here[2:], strict=True)):
                return sign(here[0]), 0
            known = sign(here[0])
            if not known and there is not None:
                known = sign(there[0] + here[1] * (iv.mpf([low, high]) - iv.mpf(middle)))
            return known, sign(here[1])

        return enclose

    return of_row


# --- intervals of arrays ---------------------------------------------------------------------------------


def of_arrays(
    kernel: Enclosing, cells: Mapping[str, Intervals], terms_of: Collection[str], kept: Mapping[str, Any]
) -> Enclose:
    """What encloses a form by its printed program, for the cells of one row.

    `kernel`, `cells`, `terms_of` and `kept`: as for
    :class:`~loopsheet.report.engines.numpy_enclosed.EnclosedRows`.
    """
    rows = EnclosedRows(kernel, cells, terms_of, kept, (1,))

    def enclose(low: Any, high: Any) -> tuple[int, int]:
        a, b = (np.array([float(end)]) for end in (low, high))
        value, slope, _ = rows.enclose(np.zeros(1, dtype=np.intp), a, b)
        return int(value.sign[0]), int(slope.sign[0])

    return enclose
