"""What a cell rests on, for a terminal: the same that the formula bar of the page tells."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from sympy import Expr, Symbol

from ...derivations.equation import Equation
from ...derivations.reductions import REDUCTIONS
from ...derivations.text import Wording, text_of_equation
from ..cells.trace import Group, dependents_of, precedents_of
from ..cells.values import Cell, Status
from ..quantity import behind
from ..result.result import Report
from ..sheet import Axis, Column, Formula, Given, Iterated, MemberAxis, Root
from ..workbook import Curve

MOST = 12
"""Cells of one column that are told one by one."""
_INDENT = "  "
_WIDTH = 10


def why(report: Report, name: str, label: tuple[int, ...] = ()) -> str:
    """Tell where a cell comes from and what is computed from it.

    Parameters
    ----------
    report : Report
        With the proofs of :func:`equations_of` the column.
    name : str
        Of a column.
    label : tuple of int
        ``(1, 2)`` for a pair, empty for a scalar.

    Raises
    ------
    KeyError
        There is no such cell.
    """
    column = report.sheet[name]
    row = report.values.row(column, label)
    cell = report.values.cell(name, label)
    given = _is_given(column) and cell.value is not None
    value = report.text(cell) if given else _full(report, cell)
    lines = [f"{cell.address} = {value}  {column.meaning}".rstrip()]
    if cell.reason:
        lines.append(_line("reason", cell.reason))
    if sure := _sure(report, name, row):
        lines.append(_line("uncertain", sure))
    if mark := report.marks.of(name)[row]:
        lines.append(_line("marked", mark))
    if _is_given(column):
        lines.append(_line("given", _where(report, name, row)))
    else:
        lines += list(_sources(report, column))
        lines += list(_equation(report, column, row, cell))
    curve = _curve_of(report, column)
    lines += list(_fitted(report, column, curve)) if curve else []
    groups = _data(report, curve) if curve else precedents_of(report.values, column, row)
    before = _told(report, (group for group in groups if group.column != column))
    lines += [_line("marked", count.said) for count in report.marks.behind(column) if count.number]
    aside = report.workbook.aside if curve else frozenset()
    users = dependents_of(report.values, column, row)
    after = _told(report, (each for each in users if each.column != column and each.column.name not in aside))
    lines += [_line("rests on", before)] if before else []
    lines += [_line("used by", after)] if after else []
    return "\n".join(lines)


def _line(what: str, text: str) -> str:
    return f"{_INDENT}{what:{_WIDTH}}{text}"


# --- numbers ---------------------------------------------------------------------------------------------


def _unit(report: Report, name: str) -> str:
    return behind(report.shown[name].unit)


def _full(report: Report, cell: Cell) -> str:
    """All digits, in the unit of the report."""
    if cell.value is None:
        return cell.status.code
    return report.shown[cell.name].digits_of(cell.value) + _unit(report, cell.name)


def _sure(report: Report, name: str, row: int) -> str:
    """The standard uncertainty of a cell that has one; empty of others."""
    known = report.uncertain().u
    u = float(known[name][row]) if name in known else 0.0
    if not u > 0:
        return ""
    value, short = report.stated(name, float(report.values.value[name][row]), u)
    unit = _unit(report, name)
    return f"u = {short.text}{unit}, of {value.text}{unit}; 'loopsheet budget' tells where it comes from"


def _is_given(column: Column) -> bool:
    return isinstance(column.rule, Given)


def _where(report: Report, name: str, row: int) -> str:
    """Where a given number was printed, and as what."""
    printed = report.inputs.printed(name)
    if not printed:
        return "by the workbook"
    number = printed[row]
    if number is None:
        return "nothing: its cell is empty"
    if number.stated and name in report.inputs.taken:
        return f"{number.stated[0].said}, as {number.where} says"
    return f"as {number.text}{_unit(report, name)}, {number.where or 'by default'} ({number.mode})"


# --- equations -------------------------------------------------------------------------------------------


def equations_of(report: Report, column: Column) -> list[Equation]:
    """The equations that a column comes from: its own, and the one that its root is sought in.

    Of what a fit that is not linear finds, also that the sum of squares has no slope there.
    """
    equations = [column.equation] if column.equation is not None else []
    if isinstance(column.rule, Root) and column.rule.form.label != column.rule.equation.label:
        equations.append(column.rule.form)
    if (curve := _curve_of(report, column)) and curve.slopes:
        label = curve.slopes[curve.fitted.index(column.name)]
        equations += [each for each in report.ledger.equations() if each.label == label]
    return equations


def _sources(report: Report, column: Column) -> Iterator[str]:
    """The numbers of its equations with what the proofs say of them."""
    equations = equations_of(report, column)
    statuses = {proof.equation.label: proof.status.value for proof in report.proofs}
    slopes = curve.slopes if (curve := _curve_of(report, column)) else ()
    told = [
        f"{e.label} {statuses[e.label]}" for e in equations if e.label in statuses and e.label not in slopes
    ]
    yield _line("from", ", solved as ".join(told) or column.source)


def _equation(report: Report, column: Column, row: int, cell: Cell) -> Iterator[str]:
    equation = column.equation
    assert equation is not None
    is_zero = isinstance(column.rule, Iterated) and 0 in column.rule.equation.sides
    yield _line("", text_of_equation(equation.origin, report.ledger.vocabulary) + " = 0" * is_zero)
    summed = report.sheet.summed_axes(column)
    if cell.value is None:
        return
    if any(member.has(*REDUCTIONS) for member in equation.members):
        sizes = [_over(report, column, row, axis) for axis in summed]
        if sizes:
            yield _line("", f"over {', '.join(sizes)}")
    else:
        # A formula's own side is the cell itself; a root's equation shows the cell inside of it.
        text = Wording(report.ledger.vocabulary).text
        numbers = [text(member) for member in equation.at(_numbers(report, column, row)).members]
        if isinstance(column.rule, Formula):
            numbers = [cell.address, numbers[-1], _number(cell.value)]
        yield _line("in SI", " = ".join(numbers))


def _over(report: Report, column: Column, row: int, axis: Axis) -> str:
    """Over how many rows of an axis a cell sums; it may be those of its group."""
    number, size = report.values.over(column.name, row, axis.name)
    rows = axis.of.name if isinstance(axis, MemberAxis) else axis.name
    return f"{number} {rows}" if number == size else f"{number} of {size} {rows}"


# --- fits ------------------------------------------------------------------------------------------------


def _curve_of(report: Report, column: Column) -> Curve | None:
    """The fit that finds a column, of all rows together."""
    alone = (curve for curve in report.workbook.curves if report.sheet[curve.name].axis is None)
    return next((curve for curve in alone if column.name in curve.fitted), None)


def _data(report: Report, curve: Curve) -> Iterator[Group]:
    """What was given, of the rows that a fit is over."""
    values, sheet = report.values, report.sheet
    own = sheet[curve.residual].axis
    used = tuple(np.flatnonzero(values.status[curve.residual] == Status.OK).tolist())
    for column in sheet.ancestors(sheet[curve.residual]):
        if _is_given(column) and column.axis in (own, None):
            yield Group(column, used if column.axis == own else (0,))


def _fitted(report: Report, column: Column, curve: Curve) -> Iterator[str]:
    """Over which rows a fit is, which are left out and why, and where it begins."""
    values = report.values
    size, used = values.layouts[curve.axis].size, values.rows_summed(curve.name, curve.axis)
    number = f"{used} {curve.axis}" if used == size else f"{used} of {size} {curve.axis}"
    beside = [name for name in curve.fitted if name != column.name]
    found = f", with {', '.join(beside)}" if beside else ""
    scatter = f"{curve.scatter} = {report.text(values.cell(curve.scatter))}"
    yield _line("fitted", f"to {curve.observed} of {number}{found}, by least squares; {scatter}")
    if isinstance(column.rule, Iterated):
        start, said = column.rule.start, report.workbook.sheet(report.inputs.given)[column.name].rule
        yield _line("begun", f"at {_place(report, column, start)}")
        if isinstance(said, Iterated) and said.start != start:
            stated = _place(report, column, said.start)
            yield _line("", f"from {stated}, as is stated, its passes lead nowhere, or there too slowly")
    for proof in (proof for proof in report.proofs if proof.equation.label in curve.slopes):
        yield _line("proof", f"{proof.equation.label} {proof.equation.title}: {proof.status.value}")
    lost = (
        {cell.label[0]: cell.reason for cell in values.cells(curve.residual) if cell.status is not Status.OK}
        if used < size
        else {}
    )
    for table in report.inputs.beneath(report.sheet[curve.residual].axis):
        gone = {each.test: each.reason for each in table.left_out}
        for test, reason in (*lost.items(), *gone.items()):
            yield _line("left out", f"{table.row} {table.called(test)}: {reason}")


def _place(report: Report, column: Column, start: Expr) -> str:
    """Where a parameter is sought from, in its unit if that is a number."""
    if not start.is_number:
        return Wording(report.ledger.vocabulary).text(start)
    return f"{report.shown[column.name].of(float(start)):.15g}{_unit(report, column.name)}"


def _number(value: float) -> str:
    return f"{value:.6g}"


def _stand_in(value: float) -> Symbol:
    """A number as it is to be read, in a place where a cell stood."""
    number = _number(value)
    return Symbol(f"({number})" if value < 0 or "e" in number else number, positive=True)


def _numbers(report: Report, column: Column, row: int) -> dict[Expr, Symbol]:
    """What to write in the place of every cell, size and running number of a column's equation."""
    values, axis = report.values, column.axis
    own = column.symbol if axis is None else column[axis.index]
    put: dict[Expr, Symbol] = {own: _stand_in(values.value[column.name][row])}
    if isinstance(column.rule, Root) and column.rule.value == column.rule.unknown:
        put[column.rule.unknown] = put[own]
    for reference, group in zip(report.sheet.named(column), precedents_of(values, column, row), strict=True):
        put[reference.cell] = _stand_in(values.value[reference.name][group.rows[0]])
    for size, its_axis in report.sheet.algebra.sizes.items():
        put[size] = _stand_in(values.layouts[its_axis.name].size)
    if axis is not None:
        for ordinal in axis.ordinals:
            put[ordinal] = _stand_in(values.layouts[axis.name].ordinals[ordinal.name][row])
    return put


# --- cells -----------------------------------------------------------------------------------------------


def _told(report: Report, groups: Iterable[Group]) -> str:
    """Cells with their values; those of a long sum as a number of rows."""
    told: dict[str, None] = {}
    for group in groups:
        if len(group.rows) > MOST:
            told[f"{group.column.name} ({len(group.rows)} rows)"] = None
        else:
            for cell in group.cells(report.values):
                told[f"{cell.address} = {report.text(cell)}"] = None
    return ", ".join(told)
