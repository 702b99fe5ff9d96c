"""Uncertainties as text: what is stated of a number, or of a whole column.

``u = 0.02``, ``U = 0.03, k = 2``, ``+-0.1 rect``, ``0.5 % of reading + 2 digits``, ``s = 0.02, n = 5``,
``exact``, or ``scatter`` of a column of readings; several errors of one number stand one after another, with
a semicolon between them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import inf, isqrt
from statistics import NormalDist
from typing import TYPE_CHECKING

from ..distribution import Error, Shape
from .number_text import NumberError, read_number
from .unit_text import UnitError, parse_unit

if TYPE_CHECKING:
    from ..quantity import Printed
    from .unit_text import ParsedUnit

__all__ = [
    "EXAMPLE",
    "LARGEST",
    "SCATTER",
    "SHAPES",
    "StatedErrors",
    "StatementError",
    "covariance",
    "read_statement",
]

EXAMPLE = "U = 0.03, k = 2"
SCATTER = "scatter"
SHAPES = {
    "rect": Shape.RECTANGULAR,
    "rectangular": Shape.RECTANGULAR,
    "uniform": Shape.RECTANGULAR,
    "tri": Shape.TRIANGULAR,
    "triangular": Shape.TRIANGULAR,
    "arcsine": Shape.ARCSINE,
    "normal": Shape.NORMAL,
}
"""The words for shapes."""

_LIMITS = re.compile(r"(?:±|\+-|\+/-)\s*")
_SHAPE = re.compile(rf"\s+(?P<shape>{'|'.join(SHAPES)})\s*$")
_NAMED = re.compile(r"(?P<name>t scale|t sd|dof|[uUkpsn])\s*=\s*")
_TERM = re.compile(r"(?P<number>[0-9.][0-9.]*(?:[eE][+-]?[0-9]+)?)\s*(?P<unit>.*)")
_RELATIVE = re.compile(r"%\s*(?:of\s+(?:the\s+)?(?:reading|value))?")
_DIGITS = re.compile(r"digits?")
_KEYS = {"u": {"dof"}, "U": {"k", "p", "dof"}, "s": {"n", "dof"}, "t scale": {"dof"}, "t sd": {"dof"}}
"""What may stand behind each beginning."""
LARGEST = 10**60
"""Of whatever unit: its square, and that of what follows from it, shall be numbers still."""
_LIMIT_KEYS = {"k", "p", "dof"}


class StatementError(ValueError):
    """A text that states no uncertainty: `code` says why, of the part `text` that begins at `start`."""

    def __init__(self, code: str, text: str, start: int, suggestion: str = "") -> None:
        super().__init__(code, text)
        self.code, self.text, self.start, self.suggestion = code, text, start, suggestion


@dataclass(frozen=True)
class _Part:
    """One error: a size, a share of the value, units of the last digit, and what they are divided by."""

    absolute: Fraction
    relative: Fraction
    digits: Fraction
    divisor: Fraction
    shape: Shape
    dof: float
    said: str

    def of(self, printed: Printed, sample: str) -> Error:
        """The error of a number; what has no unit of its own has the number's."""
        size = self.absolute + self.relative * abs(printed.value) + self.digits * 2 * printed.half_unit
        return Error(size / self.divisor, self.shape, self.dof, self.said, sample if self.dof < inf else "")


@dataclass(frozen=True)
class StatedErrors:
    """What a text says of the uncertainty of a number.

    Parameters
    ----------
    parts : tuple
        The errors, each independent of the others; none if it is exact.
    """

    parts: tuple[_Part, ...]

    def of(self, printed: Printed, of: str = "") -> tuple[Error, ...]:
        """The errors of a number: what is a share of it follows its value.

        Parameters
        ----------
        printed : Printed
        of : str
            What else it is stated of, each by the same estimate; nothing for a number alone.
        """
        return tuple(part.of(printed, of and f"{of} {n}") for n, part in enumerate(self.parts))


def read_statement(
    text: str, unit: ParsedUnit, bare: Shape | None = None, readings: Sequence[Printed] = ()
) -> StatedErrors:
    """Read what is stated of a number.

    Parameters
    ----------
    text : str
        As in the head of this module.
    unit : ParsedUnit
        The unit of the number: that of every size that names no other.
    bare : Shape, optional
        What ``+-0.1`` without a word means; it is refused without.
    readings : sequence of Printed
        The numbers of the column that it is stated of, whose standard deviation is their ``scatter``.

    Raises
    ------
    StatementError
        With the part of the text that is at fault.

    Examples
    --------
    >>> read_statement("U = 0.075 um, k = 3", parse_unit("mm")).parts[0].absolute
    Fraction(3, 40000000)
    """
    if text.strip() == "exact":
        return StatedErrors(())
    parts = (
        _scatter(readings, start) if part == SCATTER else _part(part, start, unit, bare)
        for part, start in _split(text, ";")
    )
    return StatedErrors(tuple(parts))


def _scatter(readings: Sequence[Printed], start: int) -> _Part:
    """The experimental standard deviation of readings, each of which has it (JCGM 100, 4.2.2)."""
    if (number := len(readings)) < 2:
        hint = "it is that of a measured column with two rows or more, stated in [uncertainty]"
        raise StatementError("LS431", SCATTER, start, hint)
    own, nothing = covariance(readings, readings), Fraction(0)
    return _Part(_root(own), nothing, nothing, Fraction(1), Shape.STUDENT, float(number - 1), SCATTER)


def covariance(one: Sequence[Printed], other: Sequence[Printed]) -> Fraction:
    """The experimental covariance of paired readings, exactly, in SI (JCGM 100, C.3.4)."""
    means = [sum((each.value for each in column), Fraction(0)) / len(column) for column in (one, other)]
    products = ((a.value - means[0]) * (b.value - means[1]) for a, b in zip(one, other, strict=True))
    return sum(products, Fraction(0)) / (len(one) - 1)


def _split(text: str, mark: str) -> Iterator[tuple[str, int]]:
    """The parts of a text between marks, without space around them, and where each begins."""
    start = 0
    for part in text.split(mark):
        yield part.strip(), start + len(part) - len(part.lstrip())
        start += len(part) + 1


def _part(text: str, start: int, unit: ParsedUnit, bare: Shape | None) -> _Part:
    (first, _), *others = [(field, start + place) for field, place in _split(text, ",")]
    begin = _NAMED.match(first)
    name = begin["name"] if begin else ""
    if begin and name not in _KEYS:
        raise StatementError("LS431", first, start, f"begin with the uncertainty itself: {EXAMPLE}")
    limits = _LIMITS.match(first)
    if not begin and not limits and "%" not in first and "digit" not in first:
        raise StatementError("LS431", text, start, "say what the number is: u = or U =, or +- and a shape")
    word = None if begin else _SHAPE.search(first)
    opened = begin or limits
    begins = opened.end() if opened else 0
    size = first[begins : word.start() if word else None]
    absolute, relative, digits = _amount(size, start + begins, unit)
    keys = dict(_keys(others, _KEYS[name] if begin else _LIMIT_KEYS))
    shape, divisor = _meant(first, start, name, word and SHAPES[word["shape"]], keys, bare)
    dof = float(keys.get("dof", keys["n"] - 1 if name == "s" else inf))
    if shape is Shape.NORMAL and dof < inf:
        shape = Shape.STUDENT  # JCGM 101, 6.4.9
    return _Part(absolute, relative, digits, divisor, shape, dof, text)


def _meant(
    text: str, start: int, name: str, shape: Shape | None, keys: dict[str, Fraction], bare: Shape | None
) -> tuple[Shape, Fraction]:
    """The shape of an error, and what the size that was stated is divided by."""

    def wrong(code: str, suggestion: str = "") -> StatementError:
        return StatementError(code, text, start, suggestion)

    one = Fraction(1)
    if name == "u":
        return Shape.NORMAL, one
    if name == "s":
        if "n" not in keys:
            raise wrong("LS431", "say of how many readings it is the standard deviation: s = 0.02, n = 5")
        return Shape.STUDENT, _root(keys["n"])
    if name in ("t scale", "t sd"):
        if "dof" not in keys:
            raise wrong("LS431", f"say the degrees of freedom: {text}, dof = 5")
        if name == "t scale":
            return Shape.STUDENT, one
        if keys["dof"] <= 2:
            raise wrong("LS431", "with two degrees of freedom or fewer there is no standard deviation")
        return Shape.STUDENT, _root(keys["dof"] / (keys["dof"] - 2))
    if name == "U" or shape is Shape.NORMAL:
        return Shape.NORMAL, _coverage(keys, wrong)
    if not name and shape is None:
        # Limits that an instrument's maker states say nothing of what is likelier within them (4.3.7).
        shape = bare if _LIMITS.match(text) else Shape.RECTANGULAR
    if shape is None:
        raise wrong("LS432")
    if {"k", "p"} & set(keys):
        raise wrong("LS431", "limits have no coverage factor; with one it is 'normal'")
    return shape, one


def _coverage(keys: dict[str, Fraction], wrong: Callable[[str, str], StatementError]) -> Fraction:
    """The coverage factor."""
    if ("k" in keys) == ("p" in keys):
        raise wrong("LS431", f"say the coverage factor, once: {EXAMPLE}")
    if "k" in keys:
        return keys["k"]
    if "dof" in keys:
        raise wrong("LS431", "with degrees of freedom, say the coverage factor itself: k = 2.13")
    return Fraction(NormalDist().inv_cdf((1 + float(keys["p"])) / 2))


def _root(number: Fraction) -> Fraction:
    """The square root: exact where it is rational, else to 60 bits and more."""
    scale = 1 << 60
    whole = isqrt(number.numerator * number.denominator)
    if whole * whole == number.numerator * number.denominator:
        return Fraction(whole, number.denominator)
    return Fraction(isqrt(number.numerator * number.denominator * scale * scale), number.denominator * scale)


def _keys(fields: list[tuple[str, int]], allowed: set[str]) -> Iterator[tuple[str, Fraction]]:
    """What stands behind the size: k, p, dof or n."""
    seen: set[str] = set()
    for field, start in fields:
        named = _NAMED.match(field)
        if named is not None and named["name"] in seen:
            raise StatementError("LS431", field, start, "it is said already")
        if named is None or named["name"] not in allowed:
            raise StatementError("LS431", field, start, f"here may stand {' or '.join(sorted(allowed))}")
        text = field[named.end() :].strip()
        name, percent = named["name"], text.endswith("%")
        try:
            number = read_number(text.removesuffix("%").strip()) / (100 if percent else 1)
        except NumberError:
            raise StatementError("LS431", field, start, "behind the sign stands a number") from None
        whole = number.denominator == 1
        fits = {"p": 0 < number < 1, "n": number >= 2 and whole and not percent}
        if not fits.get(name, number > 0 and not percent):
            hints = {"p": "a probability is between 0 and 1, or 95 %", "n": "two readings or more"}
            raise StatementError("LS431", field, start, hints.get(name, "it must be greater than 0"))
        seen.add(name)
        yield name, number


def _amount(text: str, start: int, unit: ParsedUnit) -> tuple[Fraction, Fraction, Fraction]:
    """A size as a sum: in SI, as a share of the value, and in units of the last digit."""
    absolute = relative = digits = Fraction(0)
    for term, place in _split(text, "+"):
        at = start + place
        match = _TERM.fullmatch(term)
        try:
            number = read_number(match["number"]) if match else Fraction(-1)
        except NumberError:
            match = None
        if match is None or number > LARGEST:
            raise StatementError(
                "LS431", term or text, at, "a size is a number from 0 to 1e60, with its unit"
            )
        behind = match["unit"].strip()
        if _DIGITS.fullmatch(behind):
            digits += number
        elif _RELATIVE.fullmatch(behind) and not (behind == "%" and not unit.dimension):
            relative += number / 100
        elif behind == "%":
            raise StatementError("LS431", term, at, "say '% of reading', or the size in the unit 1")
        else:
            absolute += number * _scale(behind, at + match.start("unit"), unit)
    return absolute, relative, digits


def _scale(text: str, start: int, unit: ParsedUnit) -> Fraction:
    if not text:
        return unit.scale
    try:
        found = parse_unit(text)
    except UnitError as error:
        raise StatementError("LS431", error.text, start + error.start, error.suggestion) from None
    if found.dimension != unit.dimension:
        raise StatementError("LS431", text, start, f"its unit converts to {unit.text}")
    return found.scale
