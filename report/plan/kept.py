"""What is made of a sheet alone, whatever the data, is kept: by all that its columns say."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from ..content import Untold
from ..machine.kept import kept
from ..sheet import Sheet

__all__ = ["of_sheet"]


def of_sheet(sheet: Sheet, what: str, parts: Iterable[str], make: Callable[[], Any]) -> Any:
    """What is made of a sheet, now or before.

    Parameters
    ----------
    sheet : Sheet
    what : str
        What it is, in a word or two.
    parts : iterable of str
        What it hangs on besides.
    make : callable
        As for :func:`~loopsheet.report.machine.kept.kept`.
    """
    try:
        columns = [column.content for column in sheet.columns]
    except Untold:
        return make()
    return kept(what, [str(len(columns)), *columns, *parts], make)
