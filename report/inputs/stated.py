"""Uncertainties as text: what is stated of a number, or of a whole column.

``u = 0.02``, ``U = 0.03, k = 2``, ``+-0.1 rect``, ``0.5 % of reading + 2 digits``, ``s = 0.02, n = 5``,
``exact``, or ``scatter`` of a column of readings; ``u = 0.02, min = 0`` or ``u = 0.02, truncated`` of a
normal error that leaves no bounds, ``exponential`` of an estimate that is all that is known of a quantity
which is not negative, ``samples = mass.csv`` of draws that somebody else made; several errors of one number
stand one after another, with a semicolon between them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf, isqrt
from statistics import NormalDist
from typing import TYPE_CHECKING

from ...derivations.unit_text import UnitError, parse_unit
from ..distribution import DIVISORS, SCATTER, Error, Shape
from ..quantity import Bounds, behind, span
from .number_text import NumberError, read_number

if TYPE_CHECKING:
    from ...derivations.unit_text import ParsedUnit
    from ..messages.errors import Location
    from ..quantity import Printed
    from .number_text import Declared

    Draws = tuple[float, ...]
    Read = Callable[[str, Declared, Location], Draws | None]

EXAMPLE = "U = 0.03, k = 2"
MOST_K = 64
"""No factor is larger: that of one degree of freedom is 64 for 99 %."""
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
_NAMED = re.compile(r"(?P<name>t scale|t sd|dof|samples|[uUkpsn])\s*=\s*")
_END = re.compile(r"(?P<name>min|max)\s*=\s*(?P<sign>[+-]?)|(?P<bounds>truncated)")
_EXPONENTIAL = "exponential"
_TERM = re.compile(r"(?P<number>[0-9.][0-9.]*(?:[eE][+-]?[0-9]+)?)\s*(?P<unit>.*)")
PERCENT = ("%", "percent")
"""Of what is a pure number itself these may be a share of it, or of 1."""
_RELATIVE = re.compile(r"(?:%|percent|ppm)\s*(?:of\s+(?:the\s+)?(?:reading|value))?")
_DIGITS = re.compile(r"digits?")
_CALLED = re.compile(r"[A-Za-z]\(|=\s*\(")
"""What a formula has, ``u = sqrt(N)``, and a unit has not, ``N/m^(3/2)``."""
_KEYS = {"u": {"dof"}, "U": {"k", "p", "dof"}, "s": {"n", "dof"}, "t scale": {"dof"}, "t sd": {"dof"}}
"""What may stand behind each beginning."""
_ANYWHERE = Bounds()
_CUT = {"u", "U"}
"""What may be cut off."""
LARGEST = 10**60
"""Of whatever unit: its square, and that of what follows from it, shall be numbers still."""
LEVELS = Fraction(1, 100), Fraction(999_999, 1_000_000)
"""The least coverage probability, and the largest."""
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
    ends: tuple[Fraction | None, Fraction | None] = (None, None)
    """Of what is cut off, in SI."""
    table: str = ""
    draws: Draws | None = None
    """In SI, from the table of that name."""

    @property
    def share(self) -> float:
        """What of the number itself its standard uncertainty is, or a part of that."""
        return float(self.relative / self.divisor) / DIVISORS[self.shape]

    @property
    def scales(self) -> bool:
        """Whether it is a share of the number and nothing else: where cells share it, it has their signs."""
        return bool(self.relative) and not self.absolute and not self.digits

    def of(self, printed: Printed, sample: str) -> Error:
        """The error of a number; what has no unit of its own has the number's."""
        size = self.absolute + self.relative * abs(printed.value) + self.digits * 2 * printed.half_unit
        sample = sample if self.dof < inf else ""
        error = Error(size / self.divisor, self.shape, self.dof, self.said, sample)
        return self._with_law(error, printed.value) if error.width or self.table else error

    def _with_law(self, error: Error, value: Fraction) -> Error:
        """What is more than a word and a width; asked for only where it is stated."""
        if self.shape is Shape.EXPONENTIAL:
            from ..laws import Exponential

            return replace(error, law=Exponential())
        if self.shape is Shape.TRUNCATED:
            from ..laws import TruncatedNormal

            low, high = (None if end is None else float((end - value) / error.width) for end in self.ends)
            cut = TruncatedNormal(-inf if low is None else low, inf if high is None else high)
            return replace(error, width=error.width * Fraction(cut.sd), law=cut)
        if self.draws:
            from ..laws import Samples

            sd, law = Samples.around(float(value), self.draws, self.table)
            return replace(error, width=Fraction(sd), law=law)
        return error

    def why_not(self, number: Printed) -> str:
        """Why it cannot be the error of a number; empty if it can."""
        low, high = self.ends
        if self.draws:
            low, high = Fraction(min(self.draws)), Fraction(max(self.draws))
        value = number.value
        if self.shape is Shape.EXPONENTIAL and value <= 0:
            return (
                f"of {number.text} nothing can be exponential: its standard uncertainty is the number itself"
            )
        if (low is not None and value < low) or (high is not None and value > high):
            ends = span(*("" if end is None else f"{float(number.of(end)):.6g}" for end in (low, high)))
            return f"{number.text} is not {ends}{behind(number.unit)}, as it would have to be"
        return ""


@dataclass(frozen=True)
class Conventions:
    """What a folder says once for all uncertainties in it."""

    bare: Shape | None = None
    """What limits without a word mean; None: they are refused."""
    draws: Read | None = None
    """Takes the name of a table of draws, what quantity they are of, and where it is named; returns them in
    SI, or None with a finding."""
    take: Callable[[Mapping[str, object], Declared], Printed | None] | None = None
    """Takes what says where the number of a parameter is to be taken from; returns it, or None with a
    finding."""
    taken: Collection[str] = ()
    """The parameters and measured columns that were taken."""


@dataclass(frozen=True)
class Of:
    """What an uncertainty is stated of."""

    numbers: Sequence[Printed] = ()
    """All numbers of the column, or the one of a parameter; none of an error that tests share."""
    bounds: Bounds = _ANYWHERE
    """Between which the quantity lies, in SI."""
    draws: Callable[[str], Draws | None] | None = None
    """Takes the name of a table; returns the draws of the quantity in it, in SI, or None with a finding of
    its own. There is none where it is more than one quantity."""


@dataclass(frozen=True)
class StatedErrors:
    """What a text says of the uncertainty of a number."""

    parts: tuple[_Part, ...]
    """The errors, each independent of the others; none if it is exact."""

    def of(self, printed: Printed, of: str = "") -> tuple[Error, ...]:
        """The errors of a number: what is a share of it follows its value.

        `of`: what else it is stated of, each by the same estimate; nothing for a number alone.
        """
        return tuple(part.of(printed, of and f"{of} {n}") for n, part in enumerate(self.parts))

    def of_others(self, numbers: Sequence[Printed]) -> StatedErrors:
        """The same of other numbers: readings scatter as these do."""
        parts = [_scatter(numbers, 0) if part.said == SCATTER else part for part in self.parts]
        return StatedErrors(_or_digits(parts))


_NOTHING = Of()


def read_statement(text: str, unit: ParsedUnit, bare: Shape | None = None, of: Of = _NOTHING) -> StatedErrors:
    """Read what is stated of a number.

    Readings that are all the same are not exact: of them it is what their digits leave (JCGM 100, F.2.2.1).

    Parameters
    ----------
    text : str
        As in the head of this module.
    unit : ParsedUnit
        The unit of the number: that of every size that names no other.
    bare : Shape, optional
        What ``+-0.1`` without a word means; it is refused without.
    of : Of
        What it is stated of: the standard deviation of its numbers is their ``scatter``.

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
    parts = []
    for part, start in split(text, ";"):
        read = _scatter(of.numbers, start) if part == SCATTER else _part(part, start, unit, bare, of)
        if why := next(filter(None, map(read.why_not, of.numbers)), ""):
            raise StatementError("LS431", part, start, why)
        parts.append(read)
    return StatedErrors(_or_digits(parts))


def _or_digits(parts: Sequence[_Part]) -> tuple[_Part, ...]:
    """The errors of a number; of readings that are all the same what digits leave, where nothing else is."""
    if [part.said for part in parts] == [SCATTER] and not parts[0].absolute:
        return (replace(parts[0], digits=Fraction(1, 2), shape=Shape.RECTANGULAR, dof=inf),)
    return tuple(parts)


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


def split(text: str, mark: str) -> Iterator[tuple[str, int]]:
    """The parts of a text between marks, without space around them, and where each begins."""
    start = 0
    for part in text.split(mark):
        yield part.strip(), start + len(part) - len(part.lstrip())
        start += len(part) + len(mark)


def _part(text: str, start: int, unit: ParsedUnit, bare: Shape | None, of: Of) -> _Part:
    (first, _), *others = [(field, start + place) for field, place in split(text, ",")]
    named = _NAMED.match(first)
    if text == _EXPONENTIAL or (named and named["name"] == "samples"):
        if not of.numbers:
            raise StatementError(
                "LS431", text, start, "what cells share is an error around 0: state its size"
            )
        return _itself(text) if text == _EXPONENTIAL else _drawn(text, start, of)
    name, begins = _begun(named, first, text, start, others)
    word = None if name else _SHAPE.search(first)
    size = first[begins : word.start() if word else None]
    absolute, relative, digits = _amount(size, start + begins, unit)
    cut = [(field, place) for field, place in others if name in _CUT and _END.match(field)]
    others = [each for each in others if each not in cut]
    if not name:
        _refuse_shapes(first, size, others)
    keys = dict(_keys(others, _KEYS[name] if name else _LIMIT_KEYS))
    shape, divisor = _meant(first, start, name, word and SHAPES[word["shape"]], keys, bare)
    dof = float(keys.get("dof", keys["n"] - 1 if name == "s" else inf))
    if shape is Shape.NORMAL and dof < inf:
        shape = Shape.STUDENT  # JCGM 101, 6.4.9
    part = _Part(absolute, relative, digits, divisor, shape, dof, text)
    return _cut(part, cut, unit, of) if cut else part


def _begun(
    named: re.Match[str] | None, first: str, text: str, start: int, others: Sequence[tuple[str, int]]
) -> tuple[str, int]:
    """The name of what is stated, empty behind a sign and of a share, and where its size begins."""
    if named and named["name"] not in _KEYS:
        raise StatementError("LS431", first, start, f"begin with the uncertainty itself: {EXAMPLE}")
    limits = _LIMITS.match(first)
    if not (named or limits or re.search("%|ppm|digit", first)):
        raise StatementError("LS431", text, start, "say what the number is: u = or U =, or +- and a shape")
    if others and others[0][0][:1].isdigit():
        raise StatementError("LS431", *others[0], f"a decimal comma? write {first}.{others[0][0]}")
    if named and _CALLED.search(first):
        hint = "what follows another formula than a share of the reading stands beside it, in a column u(...)"
        raise StatementError("LS431", first, start, hint)
    opened = named or limits
    return named["name"] if named else "", opened.end() if opened else 0


def _refuse_shapes(first: str, size: str, others: Sequence[tuple[str, int]]) -> None:
    """Refuse a shape that stands behind a comma."""
    for field, place in others:
        if field in SHAPES:
            hint = f"a shape stands behind the size, without a comma: {first} {field}"
            if SHAPES[field] is Shape.NORMAL:
                hint = f"if it is a standard uncertainty, write u = {size.strip()}; else {hint}, k = 2"
            raise StatementError("LS431", field, place, hint)


def _itself(text: str) -> _Part:
    """The error of a number of which nothing is known but that it is the best estimate (JCGM 101, 6.4.10)."""
    nothing, one = Fraction(0), Fraction(1)
    return _Part(nothing, one, nothing, one, Shape.EXPONENTIAL, inf, text)


def _drawn(text: str, start: int, of: Of) -> _Part:
    """The error that draws have."""
    name = text.partition("=")[2].strip()
    if of.draws is None or not name:
        why = "say the name of a file" if of.draws else "draws are of one number: state them of a parameter"
        raise StatementError("LS431", text, start, why)
    nothing, one = Fraction(0), Fraction(1)
    return _Part(nothing, nothing, nothing, one, Shape.SAMPLES, inf, text, table=name, draws=of.draws(name))


def _cut(part: _Part, fields: list[tuple[str, int]], unit: ParsedUnit, of: Of) -> _Part:
    """A normal error that is cut off."""
    ends: dict[str, Fraction] = {}
    for text, start in fields:
        match = _END.match(text)
        if part.dof < inf:
            raise StatementError("LS431", text, start, "with degrees of freedom it is no normal error")
        if match is None or not of.numbers:
            raise StatementError("LS431", text, start, "what cells share has no bounds: they have")
        if match["bounds"]:
            if match.end() != len(text) or len(fields) > 1:
                raise StatementError("LS431", text, start, "say 'truncated', or the bounds: min = 0")
            known = {"min": of.bounds.low, "max": of.bounds.high}
            ends = {name: Fraction(repr(float(end))) for name, end in known.items() if end is not None}
            if not ends:
                raise StatementError("LS431", text, start, "the quantity has no bounds: say min = or max =")
            continue
        absolute, relative, digits = _amount(text[match.end() :], start + match.end(), unit)
        if relative or digits or match["name"] in ends:
            raise StatementError("LS431", text, start, "a bound is a number with its unit, said once")
        ends[match["name"]] = (-absolute if match["sign"] == "-" else absolute) + unit.zero
    low, high = ends.get("min"), ends.get("max")
    if low is not None and high is not None and low >= high:
        raise StatementError("LS431", *fields[-1], "the smaller bound is min")
    return replace(part, shape=Shape.TRUNCATED, ends=(low, high))


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
        return Shape.NORMAL, _coverage(keys, EXAMPLE if name else f"{text}, k = 2", wrong)
    if not name and shape is None:
        # Limits that an instrument's maker states say nothing of what is likelier within them (4.3.7).
        shape = bare if _LIMITS.match(text) else Shape.RECTANGULAR
    if shape is None:
        raise wrong("LS432")
    if {"k", "p"} & set(keys):
        raise wrong("LS431", "limits have no coverage factor; with one it is 'normal'")
    return shape, one


def _coverage(
    keys: dict[str, Fraction], example: str, wrong: Callable[[str, str], StatementError]
) -> Fraction:
    """The coverage factor; a normal error has no ends that could tell it."""
    if ("k" in keys) == ("p" in keys):
        raise wrong("LS431", f"say the coverage factor, once: {example}")
    if "k" in keys:
        return keys["k"]
    if "dof" in keys:
        raise wrong("LS431", "with degrees of freedom, say k itself: Student's t, 2.306 for 8 and 95 %")
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
        fits = {
            "p": LEVELS[0] <= number <= LEVELS[1],
            "n": number >= 2 and whole and not percent,
            "k": 0 < number <= MOST_K and not percent,
            "dof": number >= 1 and not percent,
        }
        if not fits.get(name, number > 0 and not percent):
            hints = {
                "p": "a coverage probability is from 1 % to 99.9999 %",
                "n": "two readings or more",
                "dof": "one degree of freedom or more",
                "k": "k is 2 or 3, say, and hardly more; a coverage probability is p = 95 %",
            }
            raise StatementError("LS431", field, start, hints.get(name, "it must be greater than 0"))
        seen.add(name)
        yield name, number


def _amount(text: str, start: int, unit: ParsedUnit) -> tuple[Fraction, Fraction, Fraction]:
    """A size as a sum: in SI, as a share of the value, and in units of the last digit."""
    absolute = relative = digits = Fraction(0)
    for term, place in split(text, "+"):
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
        elif _RELATIVE.fullmatch(behind) and unit.zero:
            raise StatementError("LS431", term, at, f"zero {unit.text} is not nothing: say how much, in K")
        elif _RELATIVE.fullmatch(behind) and ("of" in behind or unit.dimension):
            relative += number / (1_000_000 if behind.startswith("ppm") else 100)
        elif behind in PERCENT:  # of what is a pure number: of the reading, or of 1?
            size = f"{float(number / 100 / unit.scale):.15g}"
            hint = f"say '{match['number']} % of reading', or '{size}' for that much in its unit {unit.text}"
            raise StatementError("LS431", term, at, hint)
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
        raise StatementError("LS431", text, start, f"write a unit that converts to {unit.text}")
    return found.scale
