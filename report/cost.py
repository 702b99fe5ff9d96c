"""What a build will take, by what there is to compute: told before a long one begins."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from .cells.layout import Layout, how_large
from .sheet import Sheet

ALWAYS = 6.0
"""Seconds that every build takes: proofs, pictures, the judge. Measured on two cores, as are the others."""
EACH = 5e-6
"""Seconds a cell, computed and counted."""
EACH_IN_WORKBOOK = 4e-5
"""Seconds a cell, written as a formula."""
LONG = 10.0
"""Seconds that nobody wonders about."""


def told(sheet: Sheet, layouts: Mapping[str, Layout], formats: Collection[str]) -> str:
    """What is to be computed and how long that takes, in a sentence; empty if it does not take long.

    Parameters
    ----------
    layouts : mapping of axis name to Layout
    formats : collection of str
        What is to be written.
    """
    each = EACH + (EACH_IN_WORKBOOK if "xlsx" in formats else 0.0)
    seconds = ALWAYS + each * how_large(sheet, layouts)
    if seconds < LONG:
        return ""
    counts = ", ".join(f"{layout.size} {name}" for name, layout in layouts.items())
    return f"{counts}: this takes about {seconds:.0f} s, without what the referee needs"
