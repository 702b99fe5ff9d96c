"""The section ``[cards]`` of report.toml: for which simulation codes a report tells what to type into them.

[cards]
codes = ["lammps", "mujoco"]
speed = "3 m/s"                          # without it, the test in the middle
E = "210 GPa"                            # for Hertz's stiffness; without it, that of the identified curve
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ..messages.errors import close
from ..quantity import POISSON, Bounds
from ..workbook import Parameter
from .keys import TABLES
from .parameters import read_parameters
from .stated import Conventions

if TYPE_CHECKING:
    from ..messages.errors import Location
    from ..quantity import Printed
    from .tables import TomlTables

SECTION = "cards"
_POSITIVE = Bounds(low=0, low_open=True)
NUMBERS = {
    "speed": Parameter("speed", "m/s", "an impact speed", _POSITIVE),
    "E": Parameter("E", "Pa", "Young's modulus of both bodies", _POSITIVE),
    "nu": Parameter("nu", "1", "Poisson's ratio of both bodies", POISSON),
    "R": Parameter("R", "m", "the effective radius", _POSITIVE),
}
"""What a card may be asked besides its code, in SI."""


@dataclass(frozen=True)
class AskedCards:
    """The cards that a folder asks for."""

    codes: Mapping[str, Location] = field(default_factory=dict)
    """Their codes; whether there are such, only those know who make the cards."""
    numbers: Mapping[str, Printed] = field(default_factory=dict)
    """Of :data:`NUMBERS`, those that are given."""
    places: Mapping[str, Location] = field(default_factory=dict)
    """Where these stand."""
    at: Location | None = None
    """Where the codes stand."""


def read_cards(tables: TomlTables) -> AskedCards:
    """Read the section; what is wrong with it is told where it stands."""
    if SECTION not in tables.toml.data:
        return AskedCards()
    written, above = tables.keys((SECTION,)), tables.toml.data[SECTION]
    if "codes" not in written:
        # A misspelt key is one problem, not two.
        if isinstance(above, dict) and not any(close(word, ["codes"]) for word in above):
            example = f"codes = {TABLES[(SECTION,)]['codes'].example}"
            at = tables.toml.key(SECTION)
            tables.findings.add("LS204", at, text="codes", table=f"[{SECTION}]", example=example)
        return AskedCards()
    codes = tables.names(SECTION, "codes")
    given = {name: value for name, value in written.items() if name in NUMBERS}
    numbers = read_parameters(
        tables.toml, given, NUMBERS.values(), tables.findings, Conventions(), section=SECTION
    )
    places = {name: tables.toml.value(SECTION, name) for name in given}
    return AskedCards(codes, numbers, places, tables.toml.value(SECTION, "codes"))
