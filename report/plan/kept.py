"""What is made of a sheet alone, whatever the data, is kept: by all that its columns say."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, TypeVar

from msgspec import convert, to_builtins

from ..content import Untold
from ..machine.kept import kept
from ..sheet import Sheet

T = TypeVar("T")


def of_sheet(sheet: Sheet, what: str, parts: Iterable[str], make: Callable[[], Any]) -> Any:
    """What is made of a sheet, now or before.

    Parameters
    ----------
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


def as_data(made: Any) -> Any:
    """Dataclasses as data that JSON can hold."""
    return to_builtins(made, enc_hook=str)


def of_data(data: Any, kind: type[T]) -> T:
    """The dataclasses of such data.

    >>> from fractions import Fraction
    >>> of_data(as_data((Fraction(1, 3), "cells")), tuple[Fraction, str])
    (Fraction(1, 3), 'cells')
    """
    return convert(data, kind, dec_hook=lambda kind, text: kind(text))
