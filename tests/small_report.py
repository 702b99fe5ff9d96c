"""Reports that take no time: the end gauge of JCGM 100:2008, H.1, and any small sheet without a folder."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

from loopsheet.derivations.equation import Ledger
from loopsheet.report.cells.values import Values
from loopsheet.report.engines import numpy as engine
from loopsheet.report.inputs.inputs import Inputs
from loopsheet.report.inputs.measurements import Measurements
from loopsheet.report.inputs.published import PublishedValue
from loopsheet.report.quantity import Printed
from loopsheet.report.referee import compare, refereed
from loopsheet.report.referee.campaign import Campaign
from loopsheet.report.referee.judging import referee
from loopsheet.report.referee.numbers import numbers_of
from loopsheet.report.referee.problem import Problem
from loopsheet.report.result.result import Comparison
from loopsheet.report.result.verdict import Referee
from loopsheet.report.sheet import Sheet
from loopsheet.report.stages import silent
from loopsheet.report.workbook import Workbook

SOURCE = """\
from sympy import Symbol
from loopsheet.derivations.equation import Equation, Kind, Ledger
from loopsheet.report.sheet import Axis, Column, Formula, Given, Sheet
from loopsheet.report.workbook import Measured, Parameter, Workbook

k, n = (Symbol(s, integer=True, positive=True) for s in ("k", "n"))
d = Column("d", Axis("readings", k, n), Given("measured"), "m", "difference", positive=False)
units = {"l_S": "m", "dalpha": "K^-1", "alpha_S": "K^-1", "theta": "K", "cycle": "K", "dtheta": "K"}
parameter = Given("parameter")
given = {name: Column(name, None, parameter, unit, name, positive=False) for name, unit in units.items()}
l_S, dalpha, alpha_S, theta, cycle, dtheta = (column.symbol for column in given.values())
length = l_S + d[k] - l_S * (dalpha * (theta + cycle) + alpha_S * dtheta)
eq = Equation("(H.1)", (Symbol("l"), length), "definition", Kind.DEFINITION, "length of the end gauge")
l = Column("l", d.axis, Formula(eq), "m", "length of the end gauge", positive=False)
WORKBOOK = Workbook(
    name="end_gauge",
    title="End gauge",
    source="JCGM 100:2008, H.1",
    ledger=lambda: Ledger((eq,)),
    measured=(Measured("d", "m", "difference"),),
    parameters=tuple(Parameter(name, unit, name) for name, unit in units.items()),
    sheet=lambda names: Sheet((d, *given.values(), l)),
)
"""
FILES = {
    "workbook.py": SOURCE,
    "report.toml": """\
workbook = "workbook.py"
[parameters]
l_S = "50.000623 mm"
dalpha = "0 K^-1"
alpha_S = "11.5e-6 K^-1"
theta = "-0.1 K"
cycle = "0 K"
dtheta = "0 K"
[measurements]
file = "d.csv"
[published]
file = "published.csv"
""",
    "d.csv": "test,d [nm]\n1,215\n2,204\n",
    "published.csv": "source,cell,index,value,unit\nH.1,l,1,50.000838,mm\n",
}


def end_gauge(folder: Path, published: str = "", **files: str | bytes) -> Path:
    """Write the folder, with other rows of published values and other files if they are given.

    Parameters
    ----------
    folder : Path
    published : str
        The whole published.csv.
    **files : str or bytes
        The content of a file by its name without its ending: ``report``, ``d``.
    """
    for name, text in FILES.items():
        content = (published if name == "published.csv" else "") or files.get(name.partition(".")[0], text)
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder


def pure(text: str) -> Printed:
    """A printed number without a unit and a file."""
    return Printed(text, "1", Fraction(text), Fraction(1))


def judged(
    sheet: Sheet,
    measured: Mapping[str, Sequence[Printed]],
    parameters: Mapping[str, Printed],
    publish: Callable[[Values], Sequence[PublishedValue]],
) -> tuple[Comparison, ...]:
    """Compare and referee what is published of a sheet over one axis of rows.

    Parameters
    ----------
    sheet : Sheet
    measured : mapping of column name to sequence of Printed
    parameters : mapping of column name to Printed
    publish : callable
        Takes the values of the sheet; returns what is published of them.
    """
    values, published, found = _asked(sheet, measured, parameters, publish)
    return refereed(compare(published, values), found)


def found(
    sheet: Sheet, measured: Mapping[str, Sequence[Printed]], published: Sequence[PublishedValue]
) -> Referee:
    """Everything that the referee says of what is published of such a sheet."""
    return _asked(sheet, measured, {}, lambda _: published)[2]


def problem(
    sheet: Sheet, measured: Mapping[str, Sequence[Printed]], published: Sequence[PublishedValue]
) -> Problem:
    """All that is published of such a sheet, to come out of one input."""
    inputs, values, data = _computed(sheet, measured, {}, lambda _: published)
    return Problem.of(Campaign(sheet, inputs, values, data), published)


Publish = Callable[[Values], Sequence[PublishedValue]]


def _asked(
    sheet: Sheet,
    measured: Mapping[str, Sequence[Printed]],
    parameters: Mapping[str, Printed],
    publish: Publish,
) -> tuple[Values, tuple[PublishedValue, ...], Referee]:
    inputs, values, data = _computed(sheet, measured, parameters, publish)
    told = referee(sheet, inputs, values, data, silent, lambda: numbers_of(sheet, inputs.workbook.ledger()))
    return values, inputs.published, told


def _computed(
    sheet: Sheet,
    measured: Mapping[str, Sequence[Printed]],
    parameters: Mapping[str, Printed],
    publish: Publish,
) -> tuple[Inputs, Values, dict[str, Any]]:
    rows = tuple(range(1, 1 + len(next(iter(measured.values())))))
    data: dict[str, Any] = {name: [float(p.value) for p in column] for name, column in measured.items()}
    data |= {name: float(p.value) for name, p in parameters.items()}
    (axis,) = sheet.axes
    values = engine.evaluate(sheet, {axis.name: rows}, data)
    inputs = Inputs(
        Path(), "", Workbook("made", "", "", lambda: Ledger(()), (), (), lambda given: sheet),
        dict(parameters), frozenset(parameters),
        (Measurements(rows, {name: tuple(column) for name, column in measured.items()}, {}),),
        tuple(publish(values)), {},
    )  # fmt: skip
    return inputs, values, data
