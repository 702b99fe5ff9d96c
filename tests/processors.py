"""Processors that NumPy may take this one for: without the instructions that it finds."""

from __future__ import annotations

import numpy as np


def lesser() -> dict[str, str]:
    """What to set in the environment of a process so that NumPy uses nothing beyond what it always needs.

    NumPy ignores what it does not know by that name, so that they are asked of this NumPy.
    """
    return {"NPY_DISABLE_CPU_FEATURES": " ".join(_found())}


def beyond() -> list[str]:
    """The same words for every step down: without the last instructions, without the last two, ..."""
    found = _found()
    return [" ".join(found[first:]) for first in range(len(found))]


def _found() -> list[str]:
    found: list[str] = np.show_config(mode="dicts")["SIMD Extensions"].get("found", [])
    return found
