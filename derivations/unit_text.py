"""Units as text: read exactly, and nothing but units; the only reader of them.

The grammar is ours (products, quotients, rational powers, parentheses); a name is looked up in a small table
and only then in pint, which therefore never sees more than one word and evaluates nothing. The table
saves pint's import (half a second with its registry, measured) for the units that nearly every report
uses; tests/test_unit_text.py holds every entry equal to pint's. Angles are pure numbers: one radian is 1.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from decimal import Context, Decimal
from fractions import Fraction
from functools import lru_cache
from typing import Any, NoReturn

_LONGEST = 60
_HIGHEST, _BELOW = 60, 12
"""The largest power, and the largest number below its stroke: m^9999 would make ten thousand digits.

A fit of fifth degree to volts has columns in s^-30.
"""
_DIGITS = Context(prec=60)
"""Of the size of a unit that is no fraction, such as mm^(3/2)."""
_PI = Fraction("3.1415926535897932384626433832795028841971693993751")

Power = Fraction | int
Dimension = tuple[tuple[str, Power], ...]
Open = tuple[tuple[str, str, Power], ...]


@dataclass(frozen=True)
class ParsedUnit:
    """A unit as printed, with its exact size."""

    text: str
    """As printed."""
    scale: Fraction
    """One of it in SI; a fraction to 60 digits, where it is none."""
    dimension: Dimension
    """Powers of SI's base units, by name; empty for a pure number and for an angle."""
    open: Open = ()
    """Powers that hang on a cell: of a base unit, the cell's name, and how often it counts."""
    zero: Fraction = Fraction(0)
    """Its zero in SI: 273.15 of degC, whose differences are those of K."""

    @property
    def is_si(self) -> bool:
        """Whether it is a unit of SI without prefix."""
        return self.scale == 1 and not self.zero


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
    def of(**powers: int) -> Dimension:
        return tuple(sorted(powers.items()))

    prefixes = {"G": 9, "M": 6, "k": 3, "": 0, "c": -2, "m": -3, "u": -6, "µ": -6, "μ": -6, "n": -9, "p": -12}
    families: tuple[tuple[str, str, int, Dimension], ...] = (
        ("m", "k cmuµμn", 0, of(m=1)),
        ("g", "k muµμ", -3, of(kg=1)),
        ("s", " muµμn", 0, of(s=1)),
        ("N", "Mk mu", 0, of(kg=1, m=1, s=-2)),
        ("Pa", "GMk ", 0, of(kg=1, m=-1, s=-2)),
        ("J", "k mu", 0, of(kg=1, m=2, s=-2)),
        ("A", " muµμn", 0, of(A=1)),
        ("mol", "k mu", 0, of(mol=1)),
        ("cd", " ", 0, of(cd=1)),
        ("W", "GMk mu", 0, of(kg=1, m=2, s=-3)),
        ("Hz", "GMk ", 0, of(s=-1)),
        ("C", " mu", 0, of(A=1, s=1)),
        ("V", "k muµμn", 0, of(kg=1, m=2, s=-3, A=-1)),
        ("ohm", "GMk m", 0, of(kg=1, m=2, s=-3, A=-2)),
        ("Ω", "GMk m", 0, of(kg=1, m=2, s=-3, A=-2)),
        ("S", " mu", 0, of(kg=-1, m=-2, s=3, A=2)),
        ("F", " munp", 0, of(kg=-1, m=-2, s=4, A=2)),
        ("Wb", " m", 0, of(kg=1, m=2, s=-2, A=-1)),
        ("T", " mu", 0, of(kg=1, s=-2, A=-1)),
        ("H", " mu", 0, of(kg=1, m=2, s=-2, A=-2)),
        ("L", " muµμ", -3, of(m=3)),
        ("l", " muµμ", -3, of(m=3)),
        ("bar", " m", 5, of(kg=1, m=-1, s=-2)),
    )
    table: dict[str, tuple[Fraction, Dimension]] = {}
    for symbol, letters, power, dimension in families:
        for letter in letters:
            prefix = letter.strip()
            table[prefix + symbol] = (Fraction(10) ** (prefixes[prefix] + power), dimension)
    return table | {
        "percent": (Fraction(1, 100), ()),
        "%": (Fraction(1, 100), ()),
        "ppm": (Fraction(1, 10**6), ()),
        "rad": (Fraction(1), ()),
        "mrad": (Fraction(1, 1000), ()),
        "deg": (_PI / 180, ()),
        "°": (_PI / 180, ()),
        "arcmin": (_PI / 180 / 60, ()),
        "arcsec": (_PI / 180 / 3600, ()),
        "rpm": (_PI / 30, of(s=-1)),
        "in": (Fraction(254, 10000), of(m=1)),
        "ft": (Fraction(3048, 10000), of(m=1)),
        "dm": (Fraction(1, 10), of(m=1)),
        "t": (Fraction(1000), of(kg=1)),
        "min": (Fraction(60), of(s=1)),
        "h": (Fraction(3600), of(s=1)),
        "sec": (Fraction(1), of(s=1)),
        "d": (Fraction(86400), of(s=1)),
        "hPa": (Fraction(100), of(kg=1, m=-1, s=-2)),
        "atm": (Fraction(101325), of(kg=1, m=-1, s=-2)),
        "mmHg": (Fraction(133322387415, 10**9), of(kg=1, m=-1, s=-2)),
        "kgf": (Fraction(980665, 10**5), of(kg=1, m=1, s=-2)),
        "cal": (Fraction(4184, 1000), of(kg=1, m=2, s=-2)),
        "eV": (Fraction(1602176634, 10**28), of(kg=1, m=2, s=-2)),
        "K": (Fraction(1), of(K=1)),
        "mK": (Fraction(1, 1000), of(K=1)),
        "delta_degC": (Fraction(1), of(K=1)),
    }


COMMON = _table()
"""The commonest units: exact size in SI and dimension."""

_MICRO = re.compile(
    r"(?<![^\W_])[uμ](?=(?:m|g|s|N|Pa|J|A|V|K|in|mol|L|l|W|Hz|C|F|T|S|H|ohm|bar|rad|eV|Bq|Gy|Sv)(?![^\W_]))"
)

_CELSIUS = Fraction(1), (("K", 1),), (), Fraction(27315, 100)
_FAHRENHEIT = Fraction(5, 9), (("K", 1),), (), Fraction(45967, 180)
_SHIFTED: dict[str, tuple[Fraction, Dimension, Open, Fraction]] = {
    **dict.fromkeys(("degC", "°C", "celsius"), _CELSIUS),
    **dict.fromkeys(("degF", "°F", "fahrenheit"), _FAHRENHEIT),
}
"""Units with a zero of their own: they stand by themselves."""
_BASE = {
    "meter": "m",
    "kilogram": "kg",
    "second": "s",
    "ampere": "A",
    "kelvin": "K",
    "mole": "mol",
    "candela": "cd",
}
_COUNTED = frozenset({"radian", "count"})
"""Base units of pint that are pure numbers in SI: of Bq, a count per second."""
_PURE = frozenset({"", "1", "-", "–", "—", "−"})
_SUPERSCRIPTS = str.maketrans("⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "+-0123456789")
_TOKEN = re.compile(
    r"(?P<name>(?:[^\W\d⁰¹²³⁴⁵⁶⁷⁸⁹]|[°%])+)"
    r"|(?P<one>1(?![0-9.]))"
    r"|(?P<power>\s*(?:\^|\*\*)\s*(?:[+-]?[0-9]+(?:\.[0-9]+)?|\(\s*[+-]?[0-9]+(?:\.[0-9]+|\s*/\s*[0-9]+)?\s*\))"
    r"|[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)"
    r"|(?P<open>\^[A-Za-z_]\w*)"
    r"|(?P<times>\s*[*·⋅×]\s*)"
    r"|(?P<over>\s*[/∕]\s*)"
    r"|(?P<left>\()|(?P<right>\))"
    r"|(?P<space>[ \t\u00a0\u202f]+)"
)


@lru_cache(maxsize=256)
def parse_unit(text: str) -> ParsedUnit:
    """Read a unit, exactly.

    Parameters
    ----------
    text : str
        ``um``, ``m/s^2``, ``kg m**-3``, ``m·s⁻¹``, ``N/(m*s)``, ``N/m^(3/2)``, ``MPa m^0.5``, ``deg``, ``%``;
        ``1`` or ``-`` for a pure number.

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
    unit = parse_open(text)
    if unit.open:
        at = text.index("^")
        raise UnitError("LS424", text[at:].strip(), at, "its size hangs on a cell in an exponent")
    return unit


@lru_cache(maxsize=256)
def parse_open(text: str) -> ParsedUnit:
    """The same; an exponent may be the name of a cell.

    >>> parse_open("N/m^alpha").open
    (('m', 'alpha', -1),)
    """
    stripped = text.strip()
    if is_pure(text):
        return ParsedUnit(text, Fraction(1), ())
    if len(text) > _LONGEST:
        raise UnitError("LS424", text, 0)
    if stripped in _SHIFTED:
        return ParsedUnit(text, *_SHIFTED[stripped])
    scale, powers = _Parser(stripped, text.index(stripped)).whole()
    fixed = {base: power for (base, cell), power in powers.items() if not cell}
    hanging = sorted((base, cell, power) for (base, cell), power in powers.items() if cell and power)
    return ParsedUnit(text, scale, _sorted(fixed), tuple(hanging))


def coherent(unit: ParsedUnit) -> str:
    """The unit of SI without prefix that it is a multiple of; as it is written, if it is that itself.

    >>> [coherent(parse_unit(text)) for text in ("GPa", "mm^2/h", "deg", "degC", "kHz", "rpm")]
    ['Pa', 'm^2*s^-1', '1', 'K', 'Hz', 's^-1']
    """
    if unit.is_si and (unit.dimension or unit.open or is_pure(unit.text)):
        return unit.text.strip()
    for name, (scale, dimension) in COMMON.items():
        # Turns and decays by time are no hertz, which counts cycles, unless they are written so.
        if scale == 1 and dimension == unit.dimension and dimension and (name != "Hz" or name in unit.text):
            return name
    return "*".join(f"{base}{_behind(power)}" for base, power in unit.dimension) or "1"


def micro(text: str) -> str:
    """A unit for the eye: µ for u.

    >>> micro("umol/(L min)"), micro("us"), micro("u"), micro("turn")
    ('µmol/(L min)', 'µs', 'u', 'turn')
    """
    return _MICRO.sub("µ", text)


def well_named(text: str, known: Iterable[str]) -> str:
    """A product of base units in as few names as it takes, of those that stand in other units.

    >>> [well_named("kg*s^-2", known) for known in (["kN", "mm"], [])]
    ['N/m', 'kg/s^2']
    >>> well_named("kg*m^-1*s^-2", []), well_named("kg*m^2*s^-2", ["N"]), well_named("m*s^-2", ["N"])
    ('Pa', 'N*m', 'm/s^2')
    """
    dimension = parse_open(text).dimension
    powers = dict(dimension)
    ways = [dimension]
    if "kg" in powers:  # an acceleration in N/kg is nobody's
        names = {name for name in map(_plain, _words(known)) if "kg" in dict(COMMON.get(name, (1, ()))[1])}
        whole = coherent(ParsedUnit("", Fraction(2), dimension))
        for name in sorted(names - {"kg"} or {whole} & COMMON.keys()):
            for power in (1, -1, 2, -2):
                rest = {base: powers.get(base, 0) - power * own for base, own in COMMON[name][1]}
                if not rest["kg"]:
                    ways.append(((name, power), *_sorted({**powers, **rest})))
    return _spelt(min(ways, key=lambda way: len(way) + sum(float(abs(power)) for _, power in way)))


def _words(units: Iterable[str]) -> Iterator[str]:
    return (word for unit in units for word in re.findall(r"[^\W\d_]+", unit))


def _plain(word: str) -> str:
    """The unit of SI that a word is a multiple of; nothing, if it is no unit: an exponent in N/m^alpha."""
    try:
        return coherent(parse_open(word))
    except UnitError:
        return ""


def _spelt(way: Dimension) -> str:
    """Powers of units, with a stroke before the only one that divides."""
    above = [f"{name}{_behind(power)}" for name, power in way if power > 0]
    below = [(name, power) for name, power in way if power < 0]
    if above and len(below) == 1:
        ((name, power),) = below
        return f"{'*'.join(above)}/{name}{_behind(-power)}"
    return "*".join([*above, *(f"{name}{_behind(power)}" for name, power in below)]) or "1"


def _behind(power: Power) -> str:
    return "" if power == 1 else f"^{power}" if power == int(power) else f"^({power})"


def misfit(unit: ParsedUnit, declared: ParsedUnit) -> str:
    """Why a number in a unit is none of what is declared in another of its dimension; empty if it is one.

    Nobody knows whether 20 degC of a quantity in K is a temperature or a difference: it is never guessed.

    >>> misfit(parse_unit("K"), parse_unit("degC")), misfit(parse_unit("mm"), parse_unit("m"))
    ('', '')
    """
    if unit.zero and not declared.zero:
        return (
            f"declared in {declared.text}: a difference is in K or delta_degC; declare a temperature in degC"
        )
    if declared.zero and "delta" in unit.text:
        return f"this is a temperature, no difference: say {declared.text} or K"
    return ""


def degrees(text: str, declared: ParsedUnit) -> str:
    """What to write in the place of a letter that is no unit of temperature, where one is declared.

    >>> degrees("C", parse_unit("K")), degrees("C", parse_unit("A*s")), degrees("N", parse_unit("K"))
    ("did you mean 'degC'?", '', '')
    """
    meant = {"C": "degC", "F": "degF"}.get(text.strip())
    return f"did you mean '{meant}'?" if meant and declared.dimension == parse_unit("K").dimension else ""


def of_differences(unit: ParsedUnit) -> str:
    """The unit of differences of what is in a unit, as text.

    >>> [of_differences(parse_unit(text)) for text in ("°C", "degF", "mm")]
    ['delta_degC', 'delta_degF', 'mm']
    """
    return unit.text if not unit.zero else "delta_degC" if unit.scale == 1 else "delta_degF"


def is_pure(unit: str) -> bool:
    """Whether a unit says that a number is a pure one."""
    return unit.strip() in _PURE


def examples(unit: ParsedUnit) -> str:
    """Return units of the same dimension, for "allowed"."""
    names = [name for name, (_, dimension) in COMMON.items() if dimension == unit.dimension]
    names += [name for name in _SHIFTED if unit.zero]
    plain = [name for name in names if name.isascii() and not (unit.zero and "delta" in name)]
    shown = [unit.text, *(name for name in plain if name != unit.text)][:5]
    if is_pure(unit.text):
        return "1 for a pure number, or percent"
    return f"a unit that converts to {unit.text}" + (f": {', '.join(shown)} ..." if plain else "")


def _sorted(dimension: dict[str, Power]) -> Dimension:
    whole = {name: int(power) if power == int(power) else power for name, power in dimension.items()}
    return tuple(sorted((name, power) for name, power in whole.items() if power))


def _raised(scale: Fraction, power: Fraction) -> Fraction:
    """A power of a size: exact where that is a fraction."""
    if power.denominator == 1 or scale == 1:
        return scale ** int(power) if scale != 1 else scale
    ends = [_root(number, power.denominator) for number in (scale.numerator, scale.denominator)]
    if None not in ends:
        return Fraction(*ends) ** power.numerator  # type: ignore[arg-type]
    size = _DIGITS.divide(Decimal(scale.numerator), Decimal(scale.denominator))
    exponent = _DIGITS.divide(Decimal(power.numerator), Decimal(power.denominator))
    return Fraction(_DIGITS.power(size, exponent))


def _root(number: int, degree: int) -> int | None:
    """The whole root of a whole number, if there is one."""
    near = round(_DIGITS.power(Decimal(number), _DIGITS.divide(Decimal(1), Decimal(degree))))
    return near if near**degree == number else None


_Powers = dict[tuple[str, str], Power]
"""Of base units; of one that is raised to a cell, by its name and the cell's."""


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
        if raised := re.search(r"\^\s*([0-9]+)\s*/$", self.text[:position]):
            suggestion = f"write a fraction as ^({raised[1]}/{text})"
        raise UnitError(code, text, self.shift + position, suggestion)

    def peek(self) -> tuple[str, str, int]:
        return self.tokens[self.next] if self.next < len(self.tokens) else ("", "", len(self.text))

    def take(self) -> tuple[str, str, int]:
        token = self.peek()
        self.next += 1
        return token

    def whole(self) -> tuple[Fraction, _Powers]:
        result = self.product()
        kind, text, position = self.peek()
        if kind:
            self.refuse(position, text)
        return result

    def product(self) -> tuple[Fraction, _Powers]:
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

    def factor(self) -> tuple[Fraction, _Powers]:
        kind, text, position = self.take()
        dimension: _Powers = {}
        if kind == "name":
            scale, fixed = self.named(text, position)
            dimension = {(name, ""): power for name, power in fixed}
        elif kind == "one":
            scale = Fraction(1)
        elif kind == "left":
            scale, dimension = self.product()
            if self.take()[0] != "right":
                self.refuse(position, self.text[position:])
        else:
            self.refuse(position if text else 0, text or self.text)
        kind, raised, where = self.peek()
        if kind == "power":
            self.take()
            power = self.power(raised, where)
            scale = _raised(scale, power)
            dimension = {name: old * power for name, old in dimension.items()}
        elif kind == "open":
            self.take()
            if scale != 1 or any(cell for _, cell in dimension):
                self.refuse(where, raised, suggestion="only a unit of SI without prefix is raised to a cell")
            dimension = {(name, raised[1:]): old for (name, _), old in dimension.items()}
        return scale, dimension

    def power(self, raised: str, where: int) -> Fraction:
        """The number that a unit is raised to."""
        text = "".join(raised.translate(_SUPERSCRIPTS).split()).strip("^*()")
        power = Fraction(text) if len(text) <= 7 and not re.search(r"/0+$", text) else Fraction(0)
        if not 0 < abs(power) <= _HIGHEST or power.denominator > _BELOW:
            self.refuse(where, raised)
        return power

    def named(self, name: str, position: int) -> tuple[Fraction, Dimension]:
        if name in COMMON:
            return COMMON[name]
        if name.endswith("s") and (unit := name[:-1]) in COMMON and unit != unit.lower():
            # To pint Pas are several pascals; whoever writes so of a viscosity has lost a sign.
            self.refuse(position, name, "LS421", f"is it '{unit}*s' or '{unit}'?")
        try:
            return _from_pint(name)
        except LookupError:
            self.refuse(position, name, "LS421", _suggestion(name))
        except ArithmeticError:
            hint = "say K or delta_degC of a difference" if name in _SHIFTED else "convert the numbers first"
            self.refuse(position, name, "LS423", hint)


def _suggestion(name: str) -> str:
    """The unit that is perhaps meant: a common one, else one of pint's."""
    import difflib  # only errors need it

    if name == "per":
        return "write / for per"
    more = ["meter", "metre", "gram", "second", "newton", "pascal", "joule"]
    more += [
        f"{size}{each}"
        for each in more
        for size in ("nano", "micro", "milli", "centi", "kilo", "mega", "giga")
    ]
    for known in ([*COMMON, *_SHIFTED, "inch", "micron", *more], _registry()):
        by_lower = {each.lower(): each for each in reversed([*known])}
        if near := difflib.get_close_matches(name.lower(), by_lower, n=1, cutoff=0.6):
            return f"did you mean '{by_lower[near[0]]}'?"
    return ""


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
    powers: dict[str, Power] = {
        _BASE.get(base, base): Fraction(power).limit_denominator(_BELOW)
        for base, power in one.unit_items()
        if base not in _COUNTED
    }
    return Fraction(size), _sorted(powers)
