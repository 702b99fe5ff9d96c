"""Numbers as text: plain decimal notation and nothing else, read exactly."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from ...derivations.unit_text import UnitError, degrees, examples, misfit, parse_unit
from ..distribution import Error
from ..quantity import Printed

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...derivations.unit_text import ParsedUnit
    from ..messages.errors import Findings, Location
    from ..workbook import Measured, Parameter

    Declared = Measured | Parameter

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE](?P<exponent>[+-]?[0-9]+))?")
_COMMA = re.compile(
    r"[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]+)?"
    r"|[+-]?[1-9][0-9]{0,2}(?:([. '\u00a0\u202f])[0-9]{3})(?:\1[0-9]{3})*,[0-9]+(?:[eE][+-]?[0-9]+)?"
    r"|[+-]?[1-9][0-9]{0,2}(?:,[0-9]{3})+\.[0-9]*"
)
_TWO_NUMBERS = re.compile(r"[+-]?[0-9]+\.[0-9]+,[+-]?[0-9]+(?:\.[0-9]+)?|[+-]?[0-9]+,[0-9]+\.[0-9]+")
_EITHER = re.compile(r"[+-]?[1-9][0-9]{0,2},[0-9]{3}")
_NOT_FINITE = frozenset(
    {"nan", "inf", "infinity", "∞", "#n/a", "#div/0!", "#value!", "#num!", "#ref!", "n/a"}
)
_CONCISE = re.compile(r"(?P<digits>[^()]*)\((?P<u>[0-9]+)\)")
_POWER_BEHIND = re.compile(r"([^()]*)(\([0-9]+\))([eE][+-]?[0-9]+)")
_LONGEST = 100
_TOP = 300
_LARGEST = Fraction(10) ** _TOP
_SMALLEST = 1 / _LARGEST


class NumberError(ValueError):
    """A text that is not a number we take; `code` says why, `fields` what its sentences name."""

    def __init__(self, code: str, **fields: str) -> None:
        super().__init__(code)
        self.code = code
        self.fields = {"suggestion": "", "example": "", "thousands": "", "allowed": "a number", **fields}


def read_number(text: str) -> Fraction:
    """Read a decimal number exactly.

    Parameters
    ----------
    text : str
        An optional sign, ASCII digits with an optional point, an optional exponent.

    Raises
    ------
    NumberError
        For anything else, with the code of what it looks like.

    Examples
    --------
    >>> read_number("2.940")
    Fraction(147, 50)
    """
    match = _NUMBER.fullmatch(text) if len(text) <= _LONGEST else None
    if match is None:
        raise _why_not(text)
    exponent = match["exponent"] or "0"
    # Both ends are tested before Fraction computes a power of ten with that many digits.
    if len(exponent.lstrip("+-0")) > len(str(_TOP)) or abs(int(exponent)) > _TOP:
        raise NumberError("LS405", text=text)
    return Fraction(text)


def _why_not(text: str) -> NumberError:
    if not text:
        return NumberError("LS403")
    if len(text) > _LONGEST:
        return NumberError("LS405", text=text)
    if text.lower().lstrip("+-") in _NOT_FINITE:
        return NumberError("LS404", text=text, suggestion="leave the cell of what was not measured empty")
    usual = re.sub("[\u2212\u2013]", "-", text)  # word processors make a minus sign or a dash of the hyphen
    if _COMMA.fullmatch(usual):
        point = max(usual.rfind("."), usual.rfind(","))
        plain = re.sub(r"[., '\u00a0\u202f]", "", usual[:point]) + "." + usual[point + 1 :]
        # Nobody knows whether 1,234 is a little more than one or a thousand: it is never guessed.
        thousands = f" or '{usual.replace(',', '')}', whichever is meant" if _EITHER.fullmatch(usual) else ""
        return NumberError("LS402", text=text, example=plain, thousands=thousands)
    suggestion = ""
    if behind := _POWER_BEHIND.fullmatch(text):
        suggestion = f"the power of ten stands before its uncertainty: {behind[1]}{behind[3]}{behind[2]}"
    elif _TWO_NUMBERS.fullmatch(usual):
        suggestion = "are these two numbers, each for a column? Marks between thousands stand by three"
    elif with_uncertainty(text):
        suggestion = "its uncertainty stands in parentheses behind all digits, 41.6(2), or in [uncertainty]"
    elif _NUMBER.fullmatch(usual):
        suggestion = "write the minus sign as an ordinary hyphen"
    elif re.match("[<>\u2264\u2265]", text):
        suggestion = "what is beyond a limit has no number: say the limit in a text, and leave its cell empty"
    elif not re.search(r"[0-9]", text):
        suggestion = "in a table of measurements the cell of what was not measured is empty"
    elif _NUMBER.fullmatch(re.sub(r"[\s_']", "", text, flags=re.ASCII)):
        suggestion = "write the digits without spaces or marks between them"
    return NumberError("LS401", text=text, suggestion=suggestion)


def with_uncertainty(text: str) -> bool:
    """Whether what is no number looks like one with its uncertainty behind it.

    >>> with_uncertainty("41.6(2)"), with_uncertainty("41.6 ± 0.2"), with_uncertainty("+-41.6")
    (True, True, False)
    """
    return re.search(r"[(±]|.\+/?-", text) is not None


def read_printed(text: str, unit: ParsedUnit, *, mode: str = "rounded", where: str = "") -> Printed:
    """Read a number as it was printed in a unit.

    Raises
    ------
    NumberError
        If it is not a number, or one that no double could hold together with its last digit.
    """
    value = read_number(text) * unit.scale + unit.zero
    printed = Printed(text, unit.text, value, unit.scale, mode, None, where, unit.zero)
    sizes = [2 * printed.half_unit, *([abs(value)] if value else [])]
    if not all(_SMALLEST <= size <= _LARGEST for size in sizes):
        raise NumberError("LS405", text=text)
    return printed


def read_value(
    text: str,
    unit: ParsedUnit | None,
    declared: Declared,
    at: Location,
    findings: Findings,
    *,
    mode: str = "rounded",
    where: str = "",
    if_empty: str = "",
) -> Printed | None:
    """Read the number of an input as its workbook declares it; None, with a finding, if it is not allowed.

    Parameters
    ----------
    text : str
        The number; in parentheses behind it its standard uncertainty in units of its last digit.
    unit : ParsedUnit or None
        Its unit; None if that is not known, and then the range is not looked at.
    declared : Declared
        What it is: a measured column or a parameter.
    at : Location
        Where it stands.
    findings : Findings
        Where findings go.
    mode, where : str
        As for :class:`Printed`.
    if_empty : str
        What to do where there is no number.
    """
    concise = _CONCISE.fullmatch(text)
    digits = concise["digits"] if concise else text
    try:
        printed = read_printed(digits, unit or parse_unit(declared.unit), mode=mode, where=where)
        if concise:
            u = read_number(concise["u"]) * 2 * printed.half_unit
            printed = replace(printed, stated=(Error(u, said=text),))
    except NumberError as error:
        fields = {**error.fields, "allowed": f"a number ({declared.meaning})"}
        fields |= {"suggestion": if_empty} if error.code == "LS403" else {}
        findings.add(error.code, at, name=declared.name, **fields)
        return None
    if unit is not None and not declared.bounds.allow(printed.value):
        words = what_is_allowed(declared, printed.value)
        findings.add("LS406", at, name=declared.name, text=text, unit=unit.text, **words)
        return None
    return printed


def what_is_allowed(declared: Declared, value: Fraction | float) -> dict[str, str]:
    """What is told of a value in SI that no input may have: what it may have, and how to let others in."""
    beyond = declared.beyond if value <= 0 else ""
    return {"allowed": f"{declared.bounds.said(declared.unit)} ({declared.meaning})", "beyond": beyond}


def read_unit_of(
    text: str, like: Declared, place: Callable[[int, int], Location], findings: Findings, name: str = ""
) -> ParsedUnit | None:
    """Read a unit of an input; None, with a finding, if it does not convert to that of its declaration.

    `place`: of a part of the text, by where it starts and how long it is. `name`: what is in the unit, if not
    the input itself: its uncertainty, of which the unit may be one of differences.
    """
    expected, name = parse_unit(like.unit), name or like.name
    try:
        size = parse_unit(text)
    except UnitError as error:
        at, known = place(error.start, len(error.text)), examples(expected)
        findings.add(error.code, at, text=error.text, suggestion=error.suggestion, known=known)
        return None
    at = place(0, max(len(text), 1))
    unlike = size.dimension != expected.dimension
    hint = degrees(text, expected) if unlike else misfit(size, expected) if name == like.name else ""
    if unlike or hint:
        words = {"known": examples(expected), "suggestion": hint}
        findings.add("LS422", at, name=name, text=text, unit=like.unit, **words)
        return None
    return size
