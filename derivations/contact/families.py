"""The ledgers of contact models that no workbook computes, by the words by which `prove` knows them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..equation import Ledger

FAMILIES = ("damping", "damped-loop")
"""Forces that simulation codes have, and law (3) with damping."""


def family(word: str) -> Ledger:
    """The ledger that a word is for."""
    from . import damped_loop, damping

    return dict(zip(FAMILIES, (damping.LEDGER, damped_loop.LEDGER), strict=True))[word]
