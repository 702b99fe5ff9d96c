"""The scalars of report.toml: a number as printed, a space, a unit."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...derivations.unit_text import ParsedUnit, examples, is_pure, parse_unit
from ..messages.errors import Findings, Location
from ..quantity import behind
from .number_text import read_unit_of, read_value
from .stated import SHAPES, Conventions, Of, StatementError, read_statement

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from ..quantity import Printed
    from ..workbook import Parameter
    from .tomlfile import TomlFile

# An exponent is never given back: 8.366e-3 g is no 8.366 of a unit "e-3 g".
_STATED = re.compile(r"\s(exact|[uUs]\s*=.*|(?:\+-|±).*)$")
"""Behind a unit, without the comma."""
_SPACELESS = re.compile(
    r"(?P<number>[+-]?[0-9]*\.?[0-9]+(?:[eE][+-]?[0-9]+)?+)(?P<unit>[^\W\d_].*|[°%].*)", re.DOTALL
)
_ENDS = re.compile(r"\s|[;±]|,\s|(?<=.)\+/?-")
"""Where a number ends: at a space, or where something is stated of it. A comma before a digit is decimal."""
_BEHIND = re.compile(r"[,;]\s*|(?=±|\+-|\+/-)")
_LIMITS = re.compile(r"(?:±|\+-|\+/-)\s*[0-9.]+(?:[eE][+-]?[0-9]+)?(?P<behind>[^,;]*)")
_TYPES = {
    str: "text",
    bool: "true or false",
    int: "a number",
    float: "a number",
    dict: "a table",
    list: "a list",
}


def read_parameters(
    toml: TomlFile,
    written: Mapping[str, object],
    declared: Iterable[Parameter],
    findings: Findings,
    said: Conventions,
    section: str = "parameters",
) -> dict[str, Printed]:
    """Read the parameters that were given, and fill in the defaults of the others.

    Parameters
    ----------
    toml : TomlFile
        The file, for places.
    written : mapping of str to object
        The section, without unknown names.
    declared : iterable of Parameter
        What the workbook wants.
    findings : Findings
        Where findings go.
    said : Conventions
        What the folder says of all uncertainties.
    section : str
        Where they stand.
    """
    printed: dict[str, Printed] = {}
    for parameter in declared:
        number = None
        if parameter.name in written:
            number = _Reader(toml, parameter, findings, said, section).read(written[parameter.name])
        elif parameter.default is not None:
            number = _OfDefault(toml, parameter, findings, said).read(parameter.default)
        if number is not None:
            printed[parameter.name] = number
    return printed


def wrong_type(toml: TomlFile, findings: Findings, path: tuple[str, ...], wanted: str, example: str) -> None:
    """Report a value that is a number, a list, a date ... where something else was wanted."""
    value: Any = toml.data
    for name in path:
        value = value[name]
    found = _TYPES.get(type(value), "a date or time")
    at = toml.value(*path)
    findings.add("LS205", at, text=".".join(path), found=found, wanted=wanted, example=example)


class _Reader:
    """Reads one parameter."""

    def __init__(
        self,
        toml: TomlFile,
        parameter: Parameter,
        findings: Findings,
        said: Conventions,
        section: str = "parameters",
    ) -> None:
        self.toml, self.said = toml, said
        self.parameter = parameter
        self.findings = findings
        self.path: tuple[str, ...] = (section, parameter.name)
        self.expected = parse_unit(parameter.unit)
        self.suffix = behind(parameter.unit)

    def read(self, value: object) -> Printed | None:
        name = self.parameter.name
        at = self.toml.value(*self.path)
        if isinstance(value, int | float) and not isinstance(value, bool):
            digits = (at.source or "")[(at.column or 1) - 1 :][: at.length]
            if_in = f" if it is in {self.parameter.unit}, and else its own unit" if self.suffix else ""
            self.findings.add("LS206", at, text=name, example=f'"{digits}{self.suffix}"{if_in}')
            return None
        if isinstance(value, dict) and self.said.take:
            return self.said.take(value, self.parameter)
        if not isinstance(value, str):
            wanted = "a number as printed and its unit, in quotes"
            wrong_type(self.toml, self.findings, self.path, wanted, f'{name} = "1.5{self.suffix}"')
            return None
        joined = _SPACELESS.fullmatch(value.strip())
        if joined:
            example = f"{joined['number']} {joined['unit']}"
            self.findings.add("LS210", at, text=value.strip(), example=example)
            return None
        text = value.strip()
        found = _ENDS.search(text)
        end = found.start() if found else len(text)
        digits, rest = text[:end], text[end:]
        start = value.find(digits)
        unit, said, begins = _apart(rest, value.find(rest, start + len(digits)) if rest else 0)
        size = self.unit(unit, value.find(unit, start + len(digits)), digits)
        place = self.part(start, max(len(digits), 1))
        printed = read_value(digits, size, self.parameter, place, self.findings, where=self.where)
        if said and printed and size:
            printed = self.stated(printed, said, begins)
        if printed and printed.stated is not None and self.parameter.bounds.integer:
            hint = f"{self.parameter.name} is a whole number that the method counts with: it has none"
            self.findings.add("LS431", self.toml.value(*self.path), text=text, suggestion=hint)
        return printed

    def stated(self, printed: Printed, text: str, begins: int) -> Printed | None:
        """The number with what is stated behind it; None, with a finding, if that is not understood."""
        if printed.stated is not None:
            hint = "leave out what stands in parentheses, or what stands behind the number"
            self.findings.add(
                "LS433", self.part(begins, len(text)), name=self.parameter.name, suggestion=hint
            )
            return None
        read, at = self.said.draws, self.toml.value(*self.path)
        draws = None if read is None else lambda name: read(name, self.parameter, at)
        of = Of((printed,), self.parameter.bounds, draws)
        try:
            found = read_statement(text, parse_unit(printed.unit), self.said.bare, of)
            return replace(printed, stated=found.of(printed))
        except StatementError as error:
            at = self.part(begins + error.start, max(len(error.text), 1))
            self.findings.add(error.code, at, text=error.text, suggestion=error.suggestion)
            return None

    def unit(self, text: str, start: int, digits: str) -> ParsedUnit | None:
        """Read the unit; None, with a finding, if it is not one of the right dimension."""
        if joined := _STATED.search(text):
            at, known = self.part(start, len(text)), examples(self.expected)
            hint = f"a comma stands before what is stated: ', {joined[1]}'"
            self.findings.add("LS421", at, text=text, suggestion=hint, known=known)
            return None
        if text or is_pure(self.parameter.unit):
            return read_unit_of(
                text or "1", self.parameter, lambda at, size: self.part(start + at, size), self.findings
            )
        name, wanted, example = self.parameter.name, self.parameter.unit, f"{digits}{self.suffix}"
        at = self.toml.value(*self.path)
        self.findings.add("LS211", at, name=name, text=digits, unit=wanted, example=example)
        return None

    @property
    def where(self) -> str:
        """Where the number stands, for its trace."""
        return self.toml.trace(*self.path)

    def part(self, start: int, length: int) -> Location:
        return self.toml.value(*self.path, start=start, length=length)


class _OfDefault(_Reader):
    """Reads what the workbook declares: what is wrong with it is told where that is named."""

    where = ""

    def __init__(self, *about: Any) -> None:
        super().__init__(*about)
        self.path = ("workbook",)

    def part(self, start: int, length: int) -> Location:
        return self.toml.value(*self.path)


def _apart(text: str, start: int) -> tuple[str, str, int]:
    """What stands behind a number: its unit, what is stated of it, and where that begins.

    >>> _apart("mm, U = 0.03, k = 2", 5), _apart("+-0.1 mm rect", 5)
    (('mm', 'U = 0.03, k = 2', 9), ('mm', '+-0.1 mm rect', 5))
    """
    found = _BEHIND.search(text)
    if found is None:
        return text.strip(), "", 0
    unit, said = text[: found.start()].strip(), text[found.end() :]
    if not unit and (limits := _LIMITS.match(said)):
        unit = " ".join(word for word in limits["behind"].split() if word not in SHAPES)
    return unit, said.strip(), start + found.end()
