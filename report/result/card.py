"""A card for a simulation code: what to type into it, and what it then returns."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ..messages.diagnostics import Check

__all__ = ["Behaviour", "Card", "CardRow", "TypedValue"]


class TypedValue(NamedTuple):
    """A number to be typed in: its word in the code, its unit, and whether it was solved for."""

    word: str
    value: float
    unit: str
    meaning: str
    solved: bool


class Behaviour(NamedTuple):
    """What an impact leaves, in SI: restitution, imprint, greatest approach and force, contact time.

    NaN where it is not known.
    """

    e: float
    imprint: float
    approach: float
    force: float = math.nan
    duration: float = math.nan


class CardRow(NamedTuple):
    """One measured speed, in m/s: restitution as measured, by the card, and if it is typed in as measured."""

    speed: float
    measured: float
    by_card: float
    typed: float | None


@dataclass(frozen=True)
class Card:
    """Parameters for the contact formula of a code, in SI where nothing else is said.

    Parameters
    ----------
    of : str
        The title of the report that it was made from.
    name, title, version : str
        The word for the code, program and model, and what version of it was read.
    sources : tuple of str
        Where its formula stands.
    formula : str
        The force while the approach grows, in the code's own words, and after that if it is another one.
    typed : tuple of TypedValue
    snippet : str
        How it is written in an input of the code.
    mass, speed : float
        The reduced mass and the impact speed that the card is for.
    wanted, returned : Behaviour
        What was measured at that speed (of other speeds: between neighbours), its approach by the identified
        law; and what the formula returns with what is typed.
    rows : tuple of CardRow
    notes : tuple of str
    oddities : tuple of Check
        What is told of the data that it was made from.
    """

    of: str
    name: str
    title: str
    version: str
    sources: tuple[str, ...]
    formula: str
    typed: tuple[TypedValue, ...]
    snippet: str
    mass: float
    speed: float
    wanted: Behaviour
    returned: Behaviour
    rows: tuple[CardRow, ...]
    notes: tuple[str, ...]
    oddities: tuple[Check, ...] = ()

    @property
    def takes_e(self) -> bool:
        """Whether the code wants a restitution."""
        return any(row.typed is not None for row in self.rows)
