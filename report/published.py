"""Values as a publication prints them, for the referee."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from .csvtable import Field, Row, Table, match_columns, read_table
from .errors import Findings, Location, listing, suggest
from .number_text import NumberError, read_printed
from .unit_text import UnitError, examples, parse_unit

if TYPE_CHECKING:
    from .inputs import Inputs
    from .quantity import Printed
    from .sources import Source

__all__ = ["PublishedValue", "check_published", "read_published"]

_REQUIRED = ("source", "cell", "index", "value", "unit")
_OPTIONAL = ("label", "expect", "reason")
_INDEX = re.compile(r"[1-9][0-9]{0,8}(?:-[1-9][0-9]{0,8})?")
_EXPECT = ("", "differs")


@dataclass(frozen=True)
class PublishedValue:
    """A number as a publication prints it.

    Parameters
    ----------
    source : str
        Where it is printed: ``Table 2``, ``text``.
    cell : str
        The name of the cell that it is a value of.
    index : tuple of int
        ``(1, 2)`` for a pair, ``(3,)`` for a test, ``()`` for a scalar.
    printed : Printed
        The number with its digits and its unit.
    expect : str
        Empty, or ``differs`` for a difference that is known.
    reason : str
        Why it differs.
    where : str
        ``file:line:column`` of the value, relative to the folder.
    places : mapping of str to Location
        The place of each field, for findings that need the sheet.
    label : str
        What the publication calls its row, if that names an equation: ``eq. 6``.
    """

    source: str
    cell: str
    index: tuple[int, ...]
    printed: Printed
    expect: str = ""
    reason: str = ""
    where: str = ""
    places: Mapping[str, Location] = field(default_factory=dict, compare=False, repr=False)
    label: str = ""


def read_published(source: Source, findings: Findings) -> tuple[PublishedValue, ...]:
    """Read published.csv, as far as it can be checked without the sheet.

    Parameters
    ----------
    source : Source
        The file.
    findings : Findings
        Where findings go.
    """
    table = read_table(source, [*_REQUIRED, *_OPTIONAL], findings)
    if table is None:
        return ()
    names = [field.text for field in table.header]
    places = match_columns(table, names, {name: name for name in _REQUIRED}, _OPTIONAL, findings)
    if not places.keys() >= set(_REQUIRED):
        return ()
    values = []
    first: dict[tuple[str, str, str], int | None] = {}
    for row in table.rows:
        if findings.full:
            break
        fields = {name: row.fields[place] for name, place in places.items()}
        value = _value(table, row, fields, findings)
        key = (fields["source"].text, fields["cell"].text, fields["index"].text)
        at = table.at(fields["cell"])
        if key in first:
            name = " ".join(filter(None, key[1:]))
            findings.add("LS504", at, text=name, source=key[0], first=first[key])
        first.setdefault(key, at.line)
        if value is not None:
            values.append(value)
    return tuple(values)


def _value(table: Table, row: Row, fields: Mapping[str, Field], findings: Findings) -> PublishedValue | None:
    before = len(findings.found)
    allowed = {"source": "where it is printed, such as Table 2", "cell": "the name of a cell, such as alpha"}
    for name, sentence in {**allowed, "unit": "a unit, 1 for a pure number"}.items():
        if not fields[name].text:
            findings.add("LS403", table.at(fields[name]), name=name, allowed=sentence)
    index = fields["index"]
    if index.text and not _INDEX.fullmatch(index.text):
        findings.add("LS501", table.at(index), text=index.text)
    expect = fields["expect"].text if "expect" in fields else ""
    reason = " ".join(fields["reason"].text.split()) if "reason" in fields else ""
    if expect not in _EXPECT:
        at = table.at(fields["expect"])
        findings.add("LS502", at, text=expect, suggestion=suggest(expect, ["differs"]))
    if expect == "differs" and not reason:
        findings.add("LS503", table.at(fields["reason" if "reason" in fields else "expect"]))
    printed = _printed(table, fields, findings)
    if printed is None or len(findings.found) > before:
        return None
    return PublishedValue(
        fields["source"].text,
        fields["cell"].text,
        tuple(int(number) for number in index.text.split("-")) if index.text else (),
        printed,
        expect,
        reason,
        printed.where,
        {name: table.at(field) for name, field in fields.items()},
        " ".join(fields["label"].text.split()) if "label" in fields else "",
    )


def _printed(table: Table, fields: Mapping[str, Field], findings: Findings) -> Printed | None:
    number, written = fields["value"], fields["unit"]
    unit = parse_unit("1")
    try:
        unit = parse_unit(written.text)
    except UnitError as error:
        at = table.at(written, error.start, len(error.text))
        known = "a unit, 1 for a pure number"
        findings.add(error.code, at, text=error.text, suggestion=error.suggestion, known=known)
    try:
        return read_printed(number.text, unit, where=table.source.trace(number.offset))
    except NumberError as error:
        findings.add(error.code, table.at(number), name="value", **error.fields)
    return None


def check_published(inputs: Inputs, cells: Mapping[str, tuple[str, Collection[tuple[int, ...]]]]) -> None:
    """Check the published values against the cells of the sheet.

    Parameters
    ----------
    inputs : Inputs
        What was read.
    cells : mapping of str to (str, collection of tuple of int)
        For each cell its SI unit and the indices that it has: ``{()}`` for a scalar. A unit that is not
        fixed, such as ``N/m^alpha``, is not compared.

    Raises
    ------
    InputError
        For unknown cells and indices, and units of another dimension.
    """
    findings = Findings()
    for name, place in inputs.free_at.items():
        if name not in cells:
            known, suggestion = listing(cells, most=24), suggest(name, cells)
            findings.add("LS505", place, text=name, known=known, suggestion=suggestion)
    for value in inputs.published:
        if findings.full:
            break
        if value.cell not in cells:
            at = value.places.get("cell")
            findings.add(
                "LS505",
                at,
                text=value.cell,
                known=listing(cells, most=24),
                suggestion=suggest(value.cell, cells),
            )
            continue
        unit, indices = cells[value.cell]
        if value.index not in indices:
            text = "-".join(map(str, value.index))
            findings.add(
                "LS506", value.places.get("index"), name=value.cell, text=text, known=_indices(indices)
            )
        try:
            expected = parse_unit(unit)
        except UnitError:
            continue
        if parse_unit(value.printed.unit).dimension != expected.dimension:
            at = value.places.get("unit")
            known = examples(expected)
            findings.add("LS422", at, name=value.cell, text=value.printed.unit, unit=unit, known=known)
    findings.check()


def _indices(indices: Collection[tuple[int, ...]]) -> str:
    if () in indices:
        return "nothing: it is a single number"
    return listing("-".join(map(str, index)) for index in sorted(indices))
