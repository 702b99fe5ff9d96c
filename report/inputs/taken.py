"""Numbers that another report has computed, with what their uncertainty comes from.

ball_mass = { from = "balance/values.json", cell = "m" }

Two numbers of one report, or of two reports that rest on a third, share its errors: each keeps the name that
it had where it was stated, and the sha256 of what that report was made from.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from ..cells.address import named
from ..distribution import Error, Shape
from ..messages.errors import Location, listing, suggest
from ..quantity import Printed
from .parameters import wrong_type
from .unit_text import UnitError, parse_unit

if TYPE_CHECKING:
    from ..files.values import Influences, Result, Source
    from ..messages.errors import Findings
    from .number_text import Declared
    from .tomlfile import TomlFile

    Read = Callable[[str, Location], Result | None]

__all__ = ["EXAMPLE", "Origin", "Taken", "TakenError", "open_result", "read_taken"]

EXAMPLE = '{ from = "balance/values.json", cell = "m" }'
_KEYS = ("from", "cell")
Origin = tuple[str, str]
"""Of an error: the sha256 of the inputs of the report where it was stated, and its name there."""


@dataclass(frozen=True)
class TakenError:
    """What one error of another report does to a number that was taken from it.

    Parameters
    ----------
    origin : tuple of str
    moved : float
        By its standard uncertainty, in SI, with its sign.
    error : Error
        Its shape, degrees of freedom and sample; its width is 1.
    """

    origin: Origin
    moved: float
    error: Error


@dataclass(frozen=True)
class Taken:
    """A number that was taken.

    Parameters
    ----------
    printed : Printed
        With all its digits, in SI.
    file, cell : str
    errors : tuple of TakenError
    correlations : mapping of two origins to float
        Between errors of that report.
    """

    printed: Printed
    file: str
    cell: str
    errors: tuple[TakenError, ...]
    correlations: Mapping[tuple[Origin, Origin], float]


def read_taken(
    said: Mapping[str, object],
    path: tuple[str, ...],
    of: Declared,
    toml: TomlFile,
    findings: Findings,
    read: Read,
) -> Taken | None:
    """Read what is to be taken; None, with a finding, if it cannot be.

    Parameters
    ----------
    said : mapping of str to object
        What stands in the file at that path.
    path : tuple of str
    of : Declared
        What it shall be.
    toml : TomlFile
    findings : Findings
    read : callable
        Takes the name of a file and where it stands; returns what it holds, or None with a finding.
    """
    for key in said:
        if key not in _KEYS:
            where, hint = ".".join(path), suggest(key, _KEYS)
            at = toml.key(*path, key)
            findings.add("LS203", at, text=key, table=where, known=listing(_KEYS), suggestion=hint)
            return None
    for key in _KEYS:
        if key not in said:
            findings.add("LS204", toml.key(*path), text=key, table=".".join(path), example=EXAMPLE)
            return None
        if not isinstance(said[key], str):
            wrong_type(toml, findings, (*path, key), "text in quotes", EXAMPLE)
            return None
    file, cell, at = str(said["from"]), str(said["cell"]), toml.value(*path, "cell")
    found = read(file, toml.value(*path, "from"))
    if found is None:
        return None
    value = _value(found, file, cell, of, at, findings)
    if value is None:
        return None
    from msgspec import UNSET

    influences = None if found.influences is UNSET else found.influences
    if influences is None or cell not in influences.cells:
        known = listing(influences.cells) if influences else "a file that tells of influences"
        reason = f"does not tell where the uncertainty of {cell} comes from"
        findings.add("LS437", at, file=file, reason=reason, known=known)
        return None
    errors, correlations = tuple(_errors(influences, cell)), _correlations(influences)
    u = math.sqrt(_variance(errors, correlations))
    stated = (Error(Fraction(u), Shape.NORMAL, said=f"from {file}, {cell}"),)
    text, unit = repr(value), parse_unit(of.unit)
    printed = Printed(text, unit.text, Fraction(value), unit.scale, "rounded", stated, toml.trace(*path))
    return Taken(printed, file, cell, errors, correlations)


def open_result(data: bytes, name: str, at: Location, findings: Findings) -> Result | None:
    """What a values.json holds; None, with a finding, if it is none."""
    from ..files.form import Malformed, decoded
    from ..files.values import Result

    try:
        return decoded(data, Result)
    except Malformed as error:
        reason = f"is no values.json: {error}"
        findings.add("LS437", at, file=name, reason=reason, known="what 'build' writes")
        return None


def _value(
    found: Result, file: str, cell: str, of: Declared, at: Location, findings: Findings
) -> float | None:
    """The value, if it is one that the parameter may have."""
    name, index = named(cell)
    column = found.cells.get(name)
    value, status = column.cells.get(index, (None, "")) if column else (None, "")
    if column is None or not status:
        known = list(found.cells)
        findings.add("LS505", at, text=cell, known=listing(known), suggestion=suggest(cell, known))
        return None
    if value is None:
        findings.add(
            "LS437", at, file=file, reason=f"has no value of {cell}: {status}", known="a cell with a value"
        )
        return None
    try:
        unit = parse_unit(column.unit)
    except UnitError:
        unit = None
    if (
        unit is None
        or unit.dimension != parse_unit(of.unit).dimension
        or unit.scale != parse_unit(of.unit).scale
    ):
        findings.add("LS422", at, name=of.name, text=column.unit, unit=of.unit, known=of.unit)
        return None
    if not of.bounds.allow(value):
        allowed = f"{of.bounds.said(of.unit)} ({of.meaning})"
        findings.add("LS406", at, name=of.name, text=repr(value), unit=of.unit, allowed=allowed)
        return None
    return float(value)


def _errors(found: Influences, cell: str) -> Iterator[TakenError]:
    """What moves the cell, and what no source tells of: the part of second order."""
    for source, moved in zip(found.sources, found.cells[cell], strict=True):
        if moved:
            sample = source.sample and (
                source.sample if source.report else f"{found.inputs}: {source.sample}"
            )
            dof = math.inf if source.dof is None else source.dof
            error = Error(Fraction(1), _shape(source.distribution), dof, "", sample)
            yield TakenError(_origin(found, source), moved, error)
    if rest := found.second.get(cell, 0.0):
        yield TakenError((found.inputs, f"second order of {cell}"), rest, Error(Fraction(1)))


def _shape(name: str) -> Shape:
    """What needs more than a word comes as a normal error of its standard uncertainty."""
    known = {shape.value: shape for shape in Shape}
    shape = known.get(name, Shape.NORMAL)
    return Shape.NORMAL if shape in (Shape.TRUNCATED, Shape.EXPONENTIAL, Shape.SAMPLES) else shape


def _origin(found: Influences, source: Source) -> Origin:
    return (source.report or found.inputs, source.name)


def _correlations(found: Influences) -> dict[tuple[Origin, Origin], float]:
    origins = [_origin(found, source) for source in found.sources]
    return {(origins[a], origins[b]): r for a, b, r in found.correlations}


def _variance(errors: Sequence[TakenError], correlations: Mapping[tuple[Origin, Origin], float]) -> float:
    moved = {error.origin: error.moved for error in errors}
    both = sum(2 * r * moved.get(a, 0.0) * moved.get(b, 0.0) for (a, b), r in correlations.items())
    return max(0.0, math.fsum(each**2 for each in moved.values()) + both)
