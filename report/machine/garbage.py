"""Python's search for objects that nobody has any more: a run is short, and its objects are many."""

from __future__ import annotations

import atexit
import gc

__all__ = ["seldom_collected"]

NEW = 100_000
"""So many objects more than before are looked through; of 700, as Python has it, it is a tenth of a build."""


def seldom_collected() -> None:
    """Look seldom for what can be thrown away in this process, and not once more when all of it goes."""
    gc.set_threshold(NEW, 50, 50)
    atexit.unregister(gc.freeze)
    atexit.register(gc.freeze)
