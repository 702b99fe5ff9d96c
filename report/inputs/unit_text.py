"""Units as text: read exactly, and nothing but units.

The grammar is ours (products, quotients, whole powers, parentheses); a name is looked up in a small table
and only then in pint, which therefore never sees more than one word and evaluates nothing. The table
saves pint's import (half a second with its registry, measured) for the units that nearly every report
uses; tests/test_unit_text.py holds every entry equal to pint's.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["COMMON", "ParsedUnit", "UnitError", "examples", "parse_open", "parse_unit"]

_LONGEST = 60
_OPEN = re.compile(r"\^[^\W\d]\w*$")
"""The end of a unit whose exponent is another cell, such as ``N/m^alpha``."""
_HIGHEST = 12
"""The largest power: m^9999 would make numbers of ten thousand digits."""

Dimension = tuple[tuple[str, int], ...]


@dataclass(frozen=True)
class ParsedUnit:
    """A unit as printed, with its exact size.

    Parameters
    ----------
    text : str
        As printed.
    scale : Fraction
        One of it in SI.
    dimension : tuple of (str, int)
        Powers of SI's base units (and of the radian), by name; empty for a pure number.
    """

    text: str
    scale: Fraction
    dimension: Dimension


class UnitError(ValueError):
    """A text that is no unit.

    Parameters
    ----------
    code : str
        The code of the finding.
    text : str
        The part of the text that is at fault, which begins at the character `start`.
    start : int
        Counted from 0.
    """

    def __init__(self, code: str, text: str, start: int, suggestion: str = "") -> None:
        super().__init__(code, text)
        self.code = code
        self.text = text
        self.start = start
        self.suggestion = suggestion


def _table() -> dict[str, tuple[Fraction, Dimension]]:
    force: Dimension = (("kg", 1), ("m", 1), ("s", -2))
    pressure: Dimension = (("kg", 1), ("m", -1), ("s", -2))
    energy: Dimension = (("kg", 1), ("m", 2), ("s", -2))
    prefixes = {"G": 9, "M": 6, "k": 3, "": 0, "c": -2, "m": -3, "u": -6, "µ": -6, "μ": -6, "n": -9}
    families: tuple[tuple[str, str, int, Dimension], ...] = (
        ("m", "k cmuµμn", 0, (("m", 1),)),
        ("g", "k muµμ", -3, (("kg", 1),)),
        ("s", " muµμn", 0, (("s", 1),)),
        ("N", "Mk mu", 0, force),
        ("Pa", "GMk ", 0, pressure),
        ("J", "k mu", 0, energy),
    )
    table: dict[str, tuple[Fraction, Dimension]] = {}
    for symbol, letters, power, dimension in families:
        for letter in letters:
            prefix = letter.strip()
            table[prefix + symbol] = (Fraction(10) ** (prefixes[prefix] + power), dimension)
    return table | {
        "percent": (Fraction(1, 100), ()),
        "%": (Fraction(1, 100), ()),
        "in": (Fraction(254, 10000), (("m", 1),)),
        "ft": (Fraction(3048, 10000), (("m", 1),)),
        "min": (Fraction(60), (("s", 1),)),
        "h": (Fraction(3600), (("s", 1),)),
        "sec": (Fraction(1), (("s", 1),)),
        "K": (Fraction(1), (("K", 1),)),
    }


COMMON = _table()
"""The commonest units: exact size in SI and dimension."""

_BASE = {
    "meter": "m",
    "kilogram": "kg",
    "second": "s",
    "ampere": "A",
    "kelvin": "K",
    "mole": "mol",
    "candela": "cd",
    "radian": "rad",
}
_PURE = frozenset({"", "1", "-", "–", "—", "−"})
_SUPERSCRIPTS = str.maketrans("⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "+-0123456789")
_TOKEN = re.compile(
    r"(?P<name>(?:[^\W\d⁰¹²³⁴⁵⁶⁷⁸⁹]|[°%])+)"
    r"|(?P<one>1(?![0-9.]))"
    r"|(?P<power>\s*(?:\^|\*\*)\s*(?:[+-]?[0-9]+|\([+-]?[0-9]+\))|[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)"
    r"|(?P<times>\s*[*·⋅×]\s*)"
    r"|(?P<over>\s*[/∕]\s*)"
    r"|(?P<open>\()|(?P<close>\))"
    r"|(?P<space>[ \t\u00a0\u202f]+)"
)


@lru_cache(maxsize=256)
def parse_unit(text: str) -> ParsedUnit:
    """Read a unit, exactly.

    Parameters
    ----------
    text : str
        ``um``, ``m/s^2``, ``kg m**-3``, ``m·s⁻¹``, ``N/(m*s)``, ``%``; ``1`` or ``-`` for a pure number.

    Raises
    ------
    UnitError
        If it is not a unit, or not a plain multiple of an SI unit.

    Examples
    --------
    >>> parse_unit("kg/m^3").dimension
    (('kg', 1), ('m', -3))
    >>> parse_unit("inch").scale
    Fraction(127, 5000)
    """
    stripped = text.strip()
    if stripped in _PURE:
        return ParsedUnit(text, Fraction(1), ())
    if len(text) > _LONGEST:
        raise UnitError("LS424", text, 0)
    start = text.index(stripped)
    scale, dimension = _Parser(stripped, start).whole()
    return ParsedUnit(text, scale, _sorted(dimension))


def parse_open(text: str) -> ParsedUnit:
    """The same; a unit whose exponent is a cell, of which the sheet knows, stays as it stands.

    >>> parse_open("N/m^alpha").scale
    Fraction(1, 1)
    """
    try:
        return parse_unit(text)
    except UnitError:
        if not _OPEN.search(text):
            raise
        return ParsedUnit(text, Fraction(1), ())


def examples(unit: ParsedUnit) -> str:
    """Return units of the same dimension, for "allowed"."""
    names = [name for name, (_, dimension) in COMMON.items() if dimension == unit.dimension]
    plain = [name for name in names if name.isascii()]
    shown = [unit.text, *(name for name in plain if name != unit.text)][:5]
    if unit.text in _PURE:
        return "1 for a pure number, or percent"
    return f"a unit that converts to {unit.text}" + (f": {', '.join(shown)} ..." if plain else "")


def _sorted(dimension: dict[str, int]) -> Dimension:
    return tuple(sorted((name, power) for name, power in dimension.items() if power))


class _Parser:
    """Recursive descent over a text of at most sixty characters."""

    def __init__(self, text: str, shift: int) -> None:
        self.text = text
        self.shift = shift
        self.tokens: list[tuple[str, str, int]] = []
        position = 0
        while position < len(text):
            match = _TOKEN.match(text, position)
            if match is None:
                self.refuse(position, text[position:])
            self.tokens.append((match.lastgroup or "", match.group(), position))
            position = match.end()
        self.next = 0

    def refuse(self, position: int, text: str, code: str = "LS424", suggestion: str = "") -> NoReturn:
        if code == "LS424" and text[:1].isdigit() and position and self.text[position - 1].isalpha():
            suggestion = f"write a power as {self.text[:position]}^{text}"
        raise UnitError(code, text, self.shift + position, suggestion)

    def peek(self) -> tuple[str, str, int]:
        return self.tokens[self.next] if self.next < len(self.tokens) else ("", "", len(self.text))

    def take(self) -> tuple[str, str, int]:
        token = self.peek()
        self.next += 1
        return token

    def whole(self) -> tuple[Fraction, dict[str, int]]:
        result = self.product()
        kind, text, position = self.peek()
        if kind:
            self.refuse(position, text)
        return result

    def product(self) -> tuple[Fraction, dict[str, int]]:
        scale, dimension = self.factor()
        over = False
        while self.peek()[0] in {"times", "over", "space"}:
            kind, _, _ = self.take()
            position = self.peek()[2]
            if over and kind == "space":
                self.refuse(position, self.text[position:], "LS425")
            over = over or kind == "over"
            sign = -1 if kind == "over" else 1
            size, powers = self.factor()
            scale *= size**sign
            for name, power in powers.items():
                dimension[name] = dimension.get(name, 0) + sign * power
        return scale, dimension

    def factor(self) -> tuple[Fraction, dict[str, int]]:
        kind, text, position = self.take()
        dimension: dict[str, int] = {}
        if kind == "name":
            scale, fixed = self.named(text, position)
            dimension = dict(fixed)
        elif kind == "one":
            scale = Fraction(1)
        elif kind == "open":
            scale, dimension = self.product()
            if self.take()[0] != "close":
                self.refuse(position, self.text[position:])
        else:
            self.refuse(position if text else 0, text or self.text)
        if self.peek()[0] == "power":
            _, raised, where = self.take()
            digits = raised.translate(_SUPERSCRIPTS).strip(" \t^*()")
            if len(digits) > 3 or not 0 < abs(int(digits)) <= _HIGHEST:
                self.refuse(where, raised)
            scale **= int(digits)
            dimension = {name: power * int(digits) for name, power in dimension.items()}
        return scale, dimension

    def named(self, name: str, position: int) -> tuple[Fraction, Dimension]:
        if name in COMMON:
            return COMMON[name]
        try:
            return _from_pint(name)
        except LookupError:
            from ..messages.errors import suggest

            self.refuse(position, name, "LS421", suggest(name, _names()))
        except ArithmeticError:
            self.refuse(position, name, "LS423")


def _names() -> Iterable[str]:
    return [*COMMON, "inch", "meter", "metre", "gram", "second", "newton", "pascal", "joule", "micron"]


@lru_cache(maxsize=1)
def _registry() -> Any:
    import pint  # half a second with its registry, for uncommon units only

    return pint.UnitRegistry(non_int_type=Fraction)


@lru_cache(maxsize=256)
def _from_pint(name: str) -> tuple[Fraction, Dimension]:
    """Ask pint for the size of one named unit.

    Raises
    ------
    LookupError
        If there is no such unit.
    ArithmeticError
        If it has an offset or is logarithmic.
    """
    registry = _registry()
    if not registry.parse_unit_name(name):  # a table look-up: pint's parser and tokenizer stay out of it
        raise LookupError(name)
    try:
        zero, one = (registry.Quantity(Fraction(n), name).to_base_units() for n in (0, 1))
    except (TypeError, ValueError, AttributeError) as error:  # a logarithm of a Fraction
        raise ArithmeticError(name) from error
    size = one.magnitude
    if zero.magnitude != 0 or not isinstance(size, int | Fraction) or size <= 0:
        raise ArithmeticError(name)
    powers: dict[str, int] = {}
    for base, power in one.unit_items():
        if power != int(power):  # half powers of the centimetre-gram-second systems
            raise LookupError(name)
        powers[_BASE.get(base, base)] = int(power)
    return Fraction(size), _sorted(powers)
