"""What a run keeps in memory: it is short and its objects are many, so it throws away late."""

from __future__ import annotations

import atexit
import gc
import os

NEW = 100_000
"""So many objects more than before are looked through; of 700, as Python has it, it is a tenth of a build."""

REMEMBERED = "20000"
"""So many answers each function of sympy keeps; with a thousand, as it has it, fits take a tenth longer."""


def ample() -> None:
    """Let this process, and those that it begins, take memory rather than time.

    What can be thrown away is looked for seldom, and not once more when all of it goes. Sympy keeps more
    answers if it is not imported yet, unless somebody has set ``SYMPY_CACHE_SIZE``.
    """
    gc.set_threshold(NEW, 50, 50)
    atexit.unregister(gc.freeze)
    atexit.register(gc.freeze)
    os.environ.setdefault("SYMPY_CACHE_SIZE", REMEMBERED)
