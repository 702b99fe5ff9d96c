"""The section ``[limits]`` of report.toml: where cells have to lie, and by which rule that is decided.

[limits]
alpha_mean = "1.25 .. 1.35"              # or "<= 1.35", ">= 1.25"; with a unit where the cell has one
x_p = "20 .. 45 um"                      # of every row that has none of its own
"x_p[1]" = "22 .. 24 um"
"x_p[3]" = "23 +- 1 um"                  # a nominal value and its tolerance; or 23 um +- 4 %
"x_p[2]" = "22 .. 24 um, guard = 0.2 um" # a rule of its own

[limits.rule]
guard = "U"                              # or "0.83 U", "0.2 um"; without it 0, simple acceptance
level = "95 %"                           # of U
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal, localcontext
from fractions import Fraction
from math import inf
from typing import TYPE_CHECKING

from ...derivations.unit_text import UnitError, examples, is_pure, parse_open
from ..cells.address import address
from ..distribution import LEVEL
from ..messages.errors import listing
from ..quantity import Bounds, behind, span
from .expected import Cells, OfCell, Words, check_expected
from .keys import fixed
from .number_text import NumberError, read_number, read_printed
from .published import unit_fits
from .stated import LARGEST, LEVELS, PERCENT, StatementError

if TYPE_CHECKING:
    from ..messages.errors import Findings, Location
    from ..quantity import Printed
    from .tables import TomlTables

SECTION, RULE = "limits", "rule"
EXAMPLE = "1.25 .. 1.35"
_BOTH = re.compile(r"(?P<low>.+?)\s*\.\.\s*(?P<high>.+)")
_AROUND = re.compile(r"(?P<nominal>.+?)\s*(?:±|\+-|\+/-)\s*(?P<tolerance>.+)")
_ONE = re.compile(r"(?P<sign><=|>=|≤|≥)\s*(?P<number>.+)")
_OWN = re.compile(r",\s*(?P<key>[A-Za-z]\w*)\s*=\s*(?P<text>.*?)\s*(?=,\s*[A-Za-z]\w*\s*=|$)")
"""Behind limits, a part of a rule; a comma that no key follows belongs to what is before it."""
_SHARES = (*PERCENT, "ppm")
_SHARE = re.compile(r"(?:(?P<times>[0-9.]+)\s*)?U")


@dataclass(frozen=True)
class Guard:
    """How far acceptance limits are drawn in (JCGM 106, 8.3.2): so many times U, or a width."""

    times: Fraction = Fraction(0)
    """Of U; 0 for simple acceptance."""
    width: Printed | None = None
    """Instead, as it is written."""
    level: float = LEVEL
    """The coverage probability of U."""
    at: Location | None = None
    """Where it is written."""

    @property
    def draws_in(self) -> bool:
        """Whether acceptance is not simple."""
        return bool(self.times) or self.width is not None


@dataclass(frozen=True)
class Limits(OfCell):
    """The tolerance limits of a cell, which are allowed values themselves; at least one of them is there."""

    low: Printed | None
    high: Printed | None
    guard: Guard
    text_at: Location | None = None
    """Where its numbers stand, behind the key."""

    def of_words(self, words: Words) -> Limits:
        """The same with the only row that its word stands for: ``slope[steel]``."""
        found = super().of_words(words)
        return found if len(found.rows) == 1 else self

    @property
    def ends(self) -> tuple[float, float]:
        """Both in SI; infinite where there is none."""
        low, high = self.low, self.high
        return -inf if low is None else float(low.value), inf if high is None else float(high.value)

    def __str__(self) -> str:
        """What is allowed, in the words of the file."""
        low, high = ("" if end is None else end.text + behind(end.unit) for end in (self.low, self.high))
        if self.low and self.high and self.low.unit == self.high.unit:
            low = self.low.text
        return span(low, high)


def read_limits(tables: TomlTables, margins: Mapping[str, str]) -> tuple[Limits, ...]:
    """Read the section; what is wrong with it is told where it stands.

    `margins`: what the workbook wants to be 0 or more, by name, in which unit; the section may say otherwise.
    """
    section = tables.toml.data.get(SECTION, {})
    written = tables.keys((SECTION,), section if isinstance(section, dict) else ())
    ruled = isinstance(written.get(RULE), dict)
    guard = _rule(tables) if ruled else Guard()
    stated = tuple(_limits(tables, written, guard, ruled))
    at, other = tables.toml.value("workbook"), {each.cell[0] for each in stated}
    own = (
        Limits(name, at, read_printed("0", parse_open(unit)), None, guard)
        for name, unit in margins.items()
        if name not in other
    )
    return (*own, *stated)


def _limits(tables: TomlTables, written: Collection[str], guard: Guard, ruled: bool) -> Iterator[Limits]:
    for cell in written:
        if cell == RULE and ruled:
            continue
        text = tables.text((SECTION,), cell, EXAMPLE)
        if text is None:
            continue
        try:
            low, high = _ends(_OWN.sub("", text))
            rule = _own_rule(guard, text, tables.toml.value(SECTION, cell))
        except StatementError as error:
            at = tables.toml.value(SECTION, cell, start=error.start, length=max(len(error.text), 1))
            tables.findings.add(error.code, at, text=error.text, suggestion=error.suggestion)
        else:
            at, text_at = tables.toml.key(SECTION, cell), tables.toml.value(SECTION, cell)
            yield Limits(cell, at, low, high, rule, text_at)


def _own_rule(rule: Guard, text: str, at: Location) -> Guard:
    """A rule with what is written behind limits in its place."""
    for one in _OWN.finditer(text):
        if one["key"] not in (known := fixed(SECTION, RULE)):
            raise StatementError(
                "LS442", one["key"], one.start("key"), f"the parts of a rule are {listing(known)}"
            )
        try:
            rule = _with(rule, one["key"], one["text"], at)
        except StatementError as error:
            raise StatementError(error.code, one["text"], one.start("text"), error.suggestion) from None
    return rule


def _ends(text: str) -> tuple[Printed | None, Printed | None]:
    """The lower and the upper limit."""
    if one := _ONE.fullmatch(text):
        end = _number(one["number"], one.start("number"), "LS441")
        return (end, None) if one["sign"] in (">=", "≥") else (None, end)
    if around := _AROUND.fullmatch(text):
        return _around(around)
    both = _BOTH.fullmatch(text)
    if both is None:
        raise StatementError("LS441", text, 0)
    high = _number(both["high"], both.start("high"), "LS441")
    unit = "" if " " in both["low"] else high.unit  # a unit behind the second is that of both
    low = _number(f"{both['low']} {unit}".strip(), both.start("low"), "LS441")
    if low.value >= high.value:
        raise StatementError("LS441", text, 0, "the lower one stands first")
    return low, high


def _around(text: re.Match[str]) -> tuple[Printed, Printed]:
    """The ends of a nominal value and its tolerance, in the unit of the nominal value."""
    tolerance = _width(text["tolerance"], text.start("tolerance"), "LS441")
    is_share = tolerance.unit in _SHARES
    unit = "" if " " in text["nominal"] or is_share else tolerance.unit  # a unit behind both is that of both
    nominal = _number(f"{text['nominal']} {unit}".strip(), 0, "LS441")
    if is_share and (is_pure(nominal.unit) or nominal.unit in _SHARES):
        if nominal.number == 0:
            nominal = replace(nominal, unit=tolerance.unit, scale=tolerance.scale)
        elif not nominal.unit == tolerance.unit == "ppm":
            raise StatementError("LS441", text[0], 0, _either(nominal, tolerance))
        is_share = False  # nothing has no share, and nobody tells one in ppm of ppm
    known = parse_open(nominal.unit)
    if is_share and known.zero:
        said = f"zero {nominal.unit} is not nothing, of which there is a share: say how much, in K"
        raise StatementError("LS441", text[0], 0, said)
    if tolerance.unit == "1" and nominal.unit != "1":
        width = tolerance.number
    elif is_share:
        width = abs(nominal.number) * tolerance.value
    elif (own := parse_open(tolerance.unit)).dimension == known.dimension and own.open == known.open:
        width = tolerance.value / nominal.scale
    else:
        raise StatementError("LS441", text[0], 0, f"{tolerance.unit} is no unit of what is in {nominal.unit}")
    if width <= 0:
        raise StatementError("LS441", text[0], 0, "a tolerance is greater than 0")
    places = max(nominal.decimals, tolerance.decimals, 0)
    ends = nominal.number - width, nominal.number + width
    try:
        low, high = (read_printed(_decimal(end, places), known) for end in ends)
    except NumberError as error:
        raise StatementError("LS441", text[0], 0, error.fields["suggestion"]) from None
    if low.value >= high.value:
        raise StatementError("LS441", text[0], 0, "the tolerance has to change fifteen digits")
    return low, high


def _either(nominal: Printed, share: Printed) -> str:
    """What to write where a percentage may be of a pure number, or of one."""
    unit, number = nominal.unit, nominal.number
    widths = [(abs(number) * share.value, unit), (share.value / nominal.scale, unit)]
    if unit == "1" and abs(number) > share.number:  # what is behind may be the unit of both
        widths.append((share.number, share.unit))
    ways = (f"{_decimal(number - w, 0)} .. {_decimal(number + w, 0)}{behind(of)}" for w, of in widths)
    return f"a share of {nominal.text}{behind(unit)}, or of one? write the limits: {' or '.join(ways)}"


def _decimal(number: Fraction, places: int) -> str:
    """In decimal digits, at least so many of them behind the point, and at most fifteen in all."""
    with localcontext(prec=15):
        exact = Decimal(number.numerator) / Decimal(number.denominator)
    return f"{exact:.{max(places, -int(exact.normalize().as_tuple().exponent))}f}"


def _number(text: str, start: int, code: str) -> Printed:
    digits, _, unit = text.partition(" ")
    try:
        number = read_printed(digits, parse_open(unit.strip() or "1"))
    except NumberError as error:
        point, hint = error.fields["example"], error.fields["suggestion"] or "a number, a space and a unit"
        raise StatementError(
            code, digits, start, f"a decimal comma? write {point}" if point else hint
        ) from None
    except UnitError as error:
        at = start + text.find(unit) + error.start
        raise StatementError(code, error.text, at, error.suggestion) from None
    if abs(number.value) > LARGEST:
        raise StatementError(code, digits, start, "a limit is a number up to 1e60")
    return number


def _rule(tables: TomlTables) -> Guard:
    """The decision rule; what is wrong with it is simple acceptance, and told."""
    path = (SECTION, RULE)
    tables.keys(path)
    found = Guard()
    for key in fixed(*path):
        if (text := tables.text(path, key)) is None:
            continue
        at = tables.toml.value(*path, key)
        try:
            found = _with(found, key, text, at)
        except StatementError as error:
            tables.findings.add(error.code, at, text=text, suggestion=error.suggestion)
    return found


def _with(rule: Guard, key: str, text: str, at: Location) -> Guard:
    return _guard(rule, text, at) if key == "guard" else replace(rule, level=_level(text))


def _guard(rule: Guard, text: str, at: Location) -> Guard:
    share = _SHARE.fullmatch(text)
    if share is None:
        width = _width(text, 0, "LS442")
        if width.value < 0:
            raise StatementError("LS442", text, 0, "a guard band is 0 or more wide")
        return replace(rule, times=Fraction(0), width=width if width.value else None, at=at)
    times = _number(share["times"] or "1", 0, "LS442").value
    return replace(rule, times=times, width=None, at=at)


def _width(text: str, start: int, code: str) -> Printed:
    """A difference: of a unit with a zero of its own its size alone counts."""
    number = _number(text, start, code)
    return replace(number, value=number.value - number.zero, zero=Fraction(0))


def _level(text: str) -> float:
    try:
        number = read_number(text.removesuffix("%").strip()) / (100 if text.endswith("%") else 1)
    except NumberError:
        number = Fraction(0)
    if not LEVELS[0] <= number <= LEVELS[1]:
        raise StatementError("LS442", text, 0, "a level is a probability from 1 % to 99.9999 %")
    return float(number)


def of_every_row(limits: Sequence[Limits], cells: Cells) -> Iterator[Limits]:
    """Limits of cells: those of a column are of each of its rows that has none of its own."""
    own = {each.cell for each in limits}
    for each in limits:
        name, index = each.cell
        rows = cells[name][1] if name in cells else ()
        if index or () in rows or not rows:
            yield each
        else:
            every = [row for row in sorted(rows) if (name, row) not in own]
            yield from (replace(each, address=address(name, row)) for row in every)


def check_limits(limits: Sequence[Limits], cells: Cells, findings: Findings, words: Words) -> None:
    """Find limits of cells that there are not, twice of one, in a unit of another dimension, or below 0 K."""
    check_expected(limits, (), cells, findings, words)
    for each in limits:
        name, index = each.cell
        if name not in cells or index not in cells[name][1]:
            continue
        if not each.rows and each.address != (own := address(name, index)):
            findings.add("LS506", each.at, name=name, text=each.address, known=own)
        ends, width = [number for number in (each.low, each.high) if number], each.guard.width
        said, unit, at = f"the limit of {name}", cells[name][0], each.text_at or each.at
        both = " .. ".join(number.text for number in ends)
        whole = both if len(ends) == 2 else f"{'<=' if each.high else '>='} {both}"
        if all(_in_place(number, whole, unit, said, at, findings) for number in ends) and width:
            _in_place(width, width.text, unit, said, each.guard.at, findings, width=True)


def _in_place(
    number: Printed,
    whole: str,
    unit: str,
    said: str,
    at: Location | None,
    findings: Findings,
    *,
    width: bool = False,
) -> bool:
    """Whether a number can be a limit of what is declared in a unit, or a width there; if not, it is told.

    `whole`: what is stated, without a unit.
    """
    if is_pure(number.unit) and not is_pure(unit):  # 5 of what is shown in deg would be read as radians
        if number.unit == "1":
            findings.add("LS211", at, name=said, text=whole, unit=unit, example=f"{whole} {unit}")
        else:
            known = examples(parse_open(unit))
            findings.add("LS422", at, name=said, text=number.unit, unit=unit, known=known, suggestion="")
        return False
    if not unit_fits(number.unit, unit, said, at, findings, width=width):
        return False
    declared = parse_open(unit)
    if declared.zero and not width and number.value < 0:
        text, allowed = f"{number.text}{behind(number.unit)}", Bounds(low=0).said(number.unit)
        findings.add("LS406", at, name=said, text=text, allowed=allowed, unit=number.unit, beyond="")
        return False
    return True
