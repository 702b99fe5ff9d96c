"""Which tests belong together: those that have the same word in a column."""

from __future__ import annotations

from .inputs import Inputs

__all__ = ["groups", "words"]


def words(inputs: Inputs, column: str) -> list[str]:
    """The words of a column in the order in which they first appear, in tests that are left out too.

    Parameters
    ----------
    inputs : Inputs
    column : str
        By which the workbook groups.
    """
    found = [row[column] for row in inputs.texts.values()]
    for each in inputs.left_out:
        found.insert(each.place, each.texts[column])
    return list(dict.fromkeys(found))


def groups(inputs: Inputs, column: str) -> dict[int, int]:
    """The number of each test's word, from 1: whatever is left out, others keep theirs.

    Parameters
    ----------
    inputs, column
        As for :func:`words`.
    """
    number = {word: place for place, word in enumerate(words(inputs, column), start=1)}
    return {test: number[row[column]] for test, row in inputs.rows.items()}
