"""A card for a simulation code: what to type into it, and what it then returns."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from ..messages.diagnostics import Check


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
    """One measured speed, in m/s: restitution as measured, by the card, and if it is typed in as measured.

    Then the imprint in m as measured, NaN where it was not, and by the card; and the codes of both
    restitutions that nothing returns, which are NaN.
    """

    speed: float
    measured: float
    by_card: float
    typed: float | None
    imprint: float
    imprint_by_card: float
    code: str = ""
    typed_code: str = ""


class Prescribed(NamedTuple):
    """A restitution that is typed in, or put into a formula, and the one that is returned."""

    typed: float
    returned: float


@dataclass(frozen=True)
class Card:
    """Parameters for the contact formula of a code, in SI where nothing else is said."""

    of: str
    """The title of the report that it was made from."""
    name: str
    title: str
    version: str
    """`name`, `title` and `version`: the word for the code, program and model, and what version of it was
    read."""
    sources: tuple[str, ...]
    """Where its formula stands."""
    formula: str
    """The force while the approach grows, in the code's own words, and after that if it is another one."""
    typed: tuple[TypedValue, ...]
    snippet: str
    """How it is written in an input of the code."""
    mass: float
    speed: float
    """`mass` and `speed`: the reduced mass and the impact speed that the card is for."""
    wanted: Behaviour
    returned: Behaviour
    """`wanted` and `returned`: what was measured at that speed (of other speeds: between neighbours), its
    approach by the identified law; and what the formula returns with what is typed."""
    rows: tuple[CardRow, ...]
    prescribed: tuple[Prescribed, ...]
    """What it returns for restitutions from near 0 to near 1; empty if none is typed in."""
    notes: tuple[str, ...]
    oddities: tuple[Check, ...] = ()
    """What is told of the data that it was made from."""

    @property
    def solved(self) -> bool:
        """Whether anything that is typed was solved for; of a contact model nothing is."""
        return any(one.solved for one in self.typed)

    @property
    def takes_e(self) -> bool:
        """Whether the code wants a restitution."""
        return any(row.typed is not None for row in self.rows)

    @property
    def leaves_imprint(self) -> bool:
        """Whether its contact is left with an imprint."""
        return self.returned.imprint > 0

    @property
    def furthest(self) -> CardRow:
        """The measured speed at which its restitution is furthest from the measured one."""
        returned = [row for row in self.rows if row.by_card == row.by_card]
        return max(returned, key=lambda row: abs(row.by_card - row.measured))


class Point(NamedTuple):
    """A measured impact in SI, with standard uncertainties: speed, restitution, imprint; NaN is not known."""

    speed: float
    u_speed: float
    e: float
    u_e: float
    imprint: float
    u_imprint: float


class NoCard(NamedTuple):
    """A code that cannot return what was measured, and why."""

    name: str
    title: str
    reason: str


@dataclass(frozen=True)
class Cards:
    """The cards of a report."""

    made: tuple[Card, ...] = ()
    measured: tuple[Point, ...] = ()
    """The impacts that they are held to."""
    refused: tuple[NoCard, ...] = ()
    laws: Mapping[str, tuple[Prescribed, ...]] = field(default_factory=dict)
    """What damping numbers return, by their author."""
    notes: tuple[str, ...] = ()
    """What is told of all of them."""
