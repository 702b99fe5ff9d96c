"""How a cell is called, in messages, files and pages alike."""

from __future__ import annotations

import re
from collections.abc import Sequence

_ROW = re.compile("(?:[0-9]{1,9}(?:-[0-9]{1,9})*)?")


def index_text(index: Sequence[int | str]) -> str:
    """The row of a cell: ``2``, ``1-2``, empty for a scalar; a word stands for its number."""
    return "-".join(map(str, index))


def address(name: str, index: Sequence[int | str]) -> str:
    """A cell: its column and its row.

    >>> address("alpha", (1, 2)), address("alpha_mean", ())
    ('alpha[1-2]', 'alpha_mean')
    """
    return f"{name}[{index_text(index)}]" if index else name


def named(text: str, row: tuple[int, ...] | None = None) -> tuple[str, tuple[int, ...]]:
    """Column and index of an address that somebody wrote; what is none is a cell that there is not.

    A word in it stands for the row that is known of it.

    >>> named("alpha[1-2]"), named("alpha[x]"), named("alpha[x]", (3,))
    (('alpha', (1, 2)), ('alpha[x]', ()), ('alpha', (3,)))
    """
    if row is not None:
        return text.partition("[")[0], row
    found = parts(text)
    if found is None or not _ROW.fullmatch(found[1]):
        return text, ()
    return found[0], tuple(map(int, filter(None, found[1].split("-"))))


def word(text: str) -> bool:
    """Whether a word may stand for a row in an address: a number there is that of a row.

    >>> word("steel"), word("2"), word("[2]")
    (True, False, False)
    """
    return not _ROW.fullmatch(text) and parts(f"_[{text}]") is not None


def parts(text: str) -> tuple[str, str] | None:
    """Column and row of an address that somebody wrote, no row for a whole column; None of what is none.

    >>> parts("alpha[1-2]"), parts("alpha_mean"), parts("alpha[1-2")
    (('alpha', '1-2'), ('alpha_mean', ''), None)
    """
    found = re.fullmatch(r"([^\[\]]*)(?:\[([^\[\]]+)\])?", text)
    return None if found is None else (found[1], found[2] or "")
