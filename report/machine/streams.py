"""Streams whose reader goes, or that were never there: how a run ends does not depend on who listens."""

from __future__ import annotations

import os
import sys
from typing import Any, TextIO


def opened() -> None:
    """Give the streams that whoever began this process has closed to nobody.

    Else nothing can be printed, and a file that is opened next stands in their place.
    """
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115 - to the end


class Outlet:
    """A stream that goes on taking what is told when nobody reads it any more, and drops that.

    Parameters
    ----------
    lost : type of exception
        What a reader that is gone raises. Of a disk that is full somebody has to be told.

    Attributes
    ----------
    is_heard : bool
        Whether there is a reader still, as far as that is known.
    """

    def __init__(self, stream: TextIO, lost: type[OSError] = BrokenPipeError) -> None:
        self._stream, self._lost, self.is_heard = stream, lost, True

    def write(self, text: str) -> int:
        """Write text, and tell how much of it was taken: all."""
        try:
            self._stream.write(text)
        except self._lost:
            self.drop()
        return len(text)

    def flush(self) -> None:
        """Write what waits."""
        try:
            self._stream.flush()
        except self._lost:
            self.drop()

    def drop(self) -> None:
        """Write to nobody from now on; Python itself would write once more, and complain, while it closes."""
        self.is_heard = False
        nobody = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nobody, self._stream.fileno())
        os.close(nobody)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)
