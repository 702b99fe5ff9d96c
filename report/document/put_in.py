"""Numbers put into equations, as engineers show a calculation: quantity = numbers = result."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from decimal import Decimal
from itertools import islice

from ..cells.trace import precedents_of
from ..column import Column, Formula, Given
from ..result.numbers import Numeral, at, last_place, read
from ..result.result import Report
from ..workbook import Workbook
from .material import Material
from .names import name_latex
from .tree import Blocks, PutIn
from .written import placed

MOST = 40
"""Equations that are shown so; of rows there is the first that has a value."""
DIGITS = 10
"""Significant digits of a computed number that is put in."""
LARGE = 1e6
"""From here on idle zeros are a power of ten."""
_PLACE = re.compile(r"\\text\{@(\d+)@\}")


def put_in(material: Material) -> Blocks:
    """What is computed by a formula of numbers, or satisfies an equation of them, in SI.

    A workbook that tells its report in words of its own has none: its equations are of many cells each.
    """
    is_told = material.report.workbook.prose != Workbook.prose
    return () if is_told else tuple(islice(_each(material), MOST))


def _each(material: Material) -> Iterator[PutIn]:
    report = material.report
    for column in report.sheet.columns:
        sources, rule = material.head(column).sources, column.rule
        equation = placed(column, report.sheet, material.names)
        row = next(
            (row for row, value in enumerate(report.values.numbers(column.name)) if value is not None), -1
        )
        if not sources or not equation.latex or row < 0 or column.name in report.workbook.aside:
            continue
        known = dict(_known(report, column, row))
        numbers = [_number(report, *known[place]) for place in equation.cells]
        sides = _filled(equation.latex, numbers).split(" = ")
        if isinstance(rule, Formula):
            label = report.values.labels(column)[row]
            symbol = name_latex(column.name, material.names, ",".join(map(str, label)))
            value = float(report.values.value[column.name][row])
            if len(sides) == 1 and sides[0] == _number(report, column.name, row, value):
                continue  # one number, by another name
            found = _written(_result(report, column.name, row, value))
            sides = [symbol, *sides, rf"{found}\,{_unit(column.unit)}" if column.unit != "1" else found]
        yield PutIn(sources[-1], tuple([(False, side)] for side in sides))


def _filled(latex: str, numbers: Sequence[str]) -> str:
    """An equation with numbers in its places."""
    return _PLACE.sub(lambda place: numbers[int(place[1])], latex)


def _known(
    report: Report, column: Column, row: int
) -> Iterator[tuple[tuple[str | None, str | None], tuple[str, int, float]]]:
    """For each place of an equation the column and row of its cell, if it is one, and its number in SI."""
    values, axis = report.values, column.axis
    own = None if axis is None else axis.index_name
    yield (column.name, own), (column.name, row, float(values.value[column.name][row]))
    groups = precedents_of(values, column, row)
    for reference, group in zip(report.sheet.named(column), groups, strict=True):
        name, one = reference.name, group.rows[0]
        yield (name, reference.index), (name, one, float(values.value[name][one]))
    for each in report.sheet.axes:
        yield ("", each.name), ("", 0, float(values.layouts[each.name].size))
    if axis is not None:
        for name, numbers in values.layouts[axis.name].ordinals.items():
            yield ("#", name), ("", 0, float(numbers[row]))


def _number(report: Report, name: str, row: int, value: float) -> str:
    """LaTeX of a number in a place; what would be misread there stands in brackets."""
    latex = _written(_figure(report, name, value))
    return rf"\left({latex}\right)" if re.search("^-|times", latex) else latex


def _written(figure: Numeral) -> str:
    digits = figure.whole + (f".{figure.fraction}" if figure.fraction else "")
    power = "" if figure.exponent is None else rf" \times 10^{{{figure.exponent}}}"
    return f"{'-' if figure.negative else ''}{digits}{power}"


def _figure(report: Report, name: str, value: float) -> Numeral:
    """A number in SI with so many digits that what comes out comes out on a pocket calculator, too."""
    is_given = not name or isinstance(report.sheet[name].rule, Given)
    short = f"{value:.{DIGITS + 2 if is_given else DIGITS}g}"
    figure = read(str(Decimal(short).normalize()) if abs(value) >= LARGE else short)
    assert figure is not None
    return figure


def _result(report: Report, name: str, row: int, value: float) -> Numeral:
    """What comes out in SI, with the digits that are known."""
    known = report.uncertain().u
    u = float(known[name][row]) if name in known else math.nan
    return at(value, last_place(value, u, report.shown[name].digits, report.inputs.uncertainty.digits))


def _unit(unit: str) -> str:
    """LaTeX of a unit of SI."""
    powers = re.sub(r"\^(?:\(([^()]+)\)|(-?\w+))", r"^{\1\2}", unit.replace("*", r"\,"))
    return re.sub(r"(?<![\\{\w-])[A-Za-z]+", lambda name: rf"\text{{{name.group()}}}", powers)
