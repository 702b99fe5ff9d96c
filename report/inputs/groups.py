"""Which tests belong together: those that have the same word in a column."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from .measurements import LeftOut

__all__ = ["groups", "rows", "words"]

Texts = Mapping[int, Mapping[str, str]]


def words(texts: Texts, left_out: Sequence[LeftOut], column: str) -> list[str]:
    """The words of a column in the order in which they first appear, in tests that are left out too.

    `texts`: the rows of the others, in the order of the table, by column. `column`: by which the workbook
    groups.
    """
    found = [row[column] for row in texts.values()]
    for each in left_out:
        found.insert(each.place, each.texts[column])
    return list(dict.fromkeys(found))


def rows(texts: Texts, left_out: Sequence[LeftOut]) -> dict[int, Mapping[str, str]]:
    """The row of each test as it stands, by column, those that are left out last."""
    return {**texts, **{each.test: each.texts for each in left_out}}


def groups(texts: Texts, left_out: Sequence[LeftOut], column: str) -> dict[int, int]:
    """The number of each test's word, from 1: whatever is left out, others keep theirs.

    `texts`, `left_out` and `column`: as for :func:`words`.
    """
    number = {word: place for place, word in enumerate(words(texts, left_out, column), start=1)}
    return {test: number[row[column]] for test, row in rows(texts, left_out).items()}
