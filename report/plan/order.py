"""What is taken over the rows of an axis, by its word, and which rows that is by their order."""

from __future__ import annotations

from typing import Any, Literal

Word = Literal["sum", "median", "max", "min"]
"""What is taken of terms: all of them added, or what stands in their order of size at some places."""


def places(word: str, number: Any) -> tuple[Any, ...]:
    """The places of which the mean is taken, from nought in ascending order.

    Parameters
    ----------
    word : str
        Which is no sum.
    number : int or integer array
        How many terms there are; of none there are no such places, and what is said here means nothing.

    Examples
    --------
    >>> places("median", 5), places("median", 6), places("max", 6), places("min", 6)
    ((2, 2), (2, 3), (5,), (0,))
    """
    if word == "median":
        return (number - 1) // 2, number // 2
    return (number - 1 if word == "max" else 0 * number,)
