"""A table of draws from somebody else's Monte Carlo: a column a quantity, a row a draw of all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .csvtable import read_table, without
from .measurements import read_head, read_unit
from .number_text import NumberError, read_number

if TYPE_CHECKING:
    from ..messages.errors import Findings
    from .number_text import Declared
    from .sources import Source

FEWEST = 100
"""Draws: fewer say nothing of a distribution."""


def read_draws(source: Source, of: Declared, findings: Findings) -> tuple[float, ...] | None:
    """The draws of a quantity in SI, in the order of the table; None, with a finding, if there are none.

    Parameters
    ----------
    source : Source
        The file; other columns in it are not looked at.
    of : Declared
        What its column is called, with its unit in brackets.
    findings : Findings
        Where findings go.
    """
    before, example = len(findings.found), f"{of.name} [{of.unit}]"
    table = read_table(source, [example], findings)
    if table is None:
        return None
    heads = [read_head(table, field, {of.name: of}, findings) for field in table.header]
    place = next((n for n, head in enumerate(heads) if head and head.name == of.name), None)
    if place is None:
        without(table, findings, {of.name: example})
        return None
    _, unit = read_unit(table, heads, place, of, findings)
    if unit is None or len(findings.found) > before:
        return None
    found = []
    for row in table.rows:
        field = row.fields[place]
        try:
            found.append(float(read_number(field.text) * unit.scale + unit.zero))
        except NumberError as error:
            findings.add(error.code, table.at(field), name=of.name, **error.fields)
            if findings.full:
                break
    if len(findings.found) > before:
        return None
    if len(found) < FEWEST or min(found) == max(found):
        findings.add("LS436", source.at(0), name=of.name, number=len(found), fewest=FEWEST)
        return None
    return tuple(found)
