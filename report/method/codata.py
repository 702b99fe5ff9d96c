"""The constants of nature by their names: CODATA's values, as scipy has them."""

from __future__ import annotations

import difflib

from ..column import SheetError
from ..messages.errors import listing

_LETTERS = {
    **{"R": "molar gas constant", "N_A": "Avogadro constant", "F": "Faraday constant"},
    **{"k": "Boltzmann constant", "k_B": "Boltzmann constant", "h": "Planck constant"},
    **{"c": "speed of light in vacuum", "e": "elementary charge", "g": "standard acceleration of gravity"},
    **{"G": "Newtonian constant of gravitation", "sigma": "Stefan-Boltzmann constant"},
}
"""What constants are called whose letters everybody writes."""


def adjusted(name: str) -> tuple[float, str, float, str]:
    """The value of a constant, its unit, its standard uncertainty, 0 where it is exact, and its source.

    Raises
    ------
    SheetError
        There is none of that name; with those that may be meant.

    Examples
    --------
    >>> adjusted("speed of light in vacuum")[:3]
    (299792458.0, 'm*s^-1', 0.0)
    """
    from scipy import constants
    from scipy.constants import find, physical_constants

    if name in physical_constants:
        value, unit, u = physical_constants[name]
        # With its year, where scipy says it.
        source = getattr(getattr(constants, "_codata", None), "_current_codata", "CODATA")
        return value, "*".join(unit.split()) or "1", u, source
    if name in _LETTERS:
        raise SheetError(f"CODATA calls {name} {_LETTERS[name]!r}", name)
    near = dict.fromkeys((*find(name), *difflib.get_close_matches(name, physical_constants, 3)))
    meant = f"; do you mean {listing(list(near)[:5])}?" if near else ""
    raise SheetError(f"CODATA has no {name!r}{meant}", name)
