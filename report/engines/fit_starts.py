"""Where the passes of a fit begin: at its author's start, or, where that leads nowhere, where a solver ends.

A sheet goes to the least sum of squares by steps that every engine can print, a workbook by a number of them.
From far away, Levenberg's and Marquardt's method in SciPy (MINPACK's lmder) finds what they do not. What it
has to know of a model are cells of the sheet itself; and of where it ends the passes prove that the sum has
no slope there, as they do of any other place.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sympy import Rational, sqrt

from ...derivations.equation import Equation, Kind
from ..cells.values import Status, Values
from ..column import Column, Formula, Given
from ..quantity import Bounds
from ..sheet import Loop, Sheet
from ..workbook import Curve
from .excel_loops import PASSES
from .numpy import Program, evaluate

STEPS, LAST = 5000, 1e-15
"""How many steps it may take, and the share of anything that is not worth another."""

Array = NDArray[np.float64]
Labels = Mapping[str, Sequence[int]]


def begun(sheet: Sheet, curves: Iterable[Curve], labels: Labels, data: Mapping[str, Any]) -> Sheet:
    """The sheet with each fit begun from where it settles in as few passes as a workbook has.

    A fit that does so from its author's start keeps that, and so does one for which no better is found.

    Parameters
    ----------
    curves : iterable of Curve
        What is fitted in it.
    labels, data : mapping
        As for :func:`~loopsheet.report.engines.numpy.evaluate`.
    """
    values = None
    for curve in curves:
        loop = sheet.loop_of.get(curve.fitted[0])
        if loop is None or {each.name for each in loop.iterated if each.axis is None} != {*curve.fitted}:
            continue  # it is found without steps, or together with another
        values = values or evaluate(sheet, labels, data)
        if _passes(values, loop) == math.inf:
            sheet, values = _better(sheet, loop, values, _solved(sheet, curve, loop, values), data)
        if PASSES < _passes(values, loop) < math.inf:
            there = {name: values.scalar(name) for name in curve.fitted}
            sheet, values = _better(sheet, loop, values, there, data)
    return sheet


def begun_at(sheet: Sheet, start: Mapping[str, float]) -> Sheet:
    """The sheet with parameters of fits begun at finite numbers, of as many digits as a spreadsheet reads.

    `start`: in SI, by name.
    """

    def begin(column: Column) -> Column:
        if column.name not in start:
            return column
        return replace(column, rule=replace(_rule(column), start=Rational(f"{start[column.name]:.12g}")))

    return Sheet(tuple(map(begin, sheet.columns)))


def _passes(values: Values, loop: Loop) -> float:
    """How many passes a loop takes; infinity if it does not settle."""
    lost = any(np.any(values.status[column.name] == Status.NOROOT) for column in loop.iterated)
    return math.inf if lost else values.passes[loop.name]


def _better(
    sheet: Sheet, loop: Loop, values: Values, start: Mapping[str, float], data: Mapping[str, Any]
) -> tuple[Sheet, Values]:
    """A sheet and its values, or those from another start if its passes are fewer."""
    if not all(map(math.isfinite, start.values())):
        return sheet, values
    other = begun_at(sheet, start)
    found = evaluate(other, values.given_labels, data)
    return (other, found) if _passes(found, loop) < _passes(values, loop) else (sheet, values)


def _solved(sheet: Sheet, curve: Curve, loop: Loop, values: Values) -> dict[str, float]:
    """The parameters of a fit where a solver ends; whether that is one, the passes from there tell."""
    rows, firsts = (
        _rows(sheet, curve),
        [_made(sheet[name], _rule(sheet[name]).start, 0) for name in curve.fitted],
    )
    whole = Sheet((*(_free(column, loop) for column in sheet.columns), *rows, *firsts))
    wanted = {each.name for asked in (*rows, *firsts) for each in (*whole.ancestors(asked), asked)}
    free = Sheet(tuple(column for column in whole.columns if column.name in wanted))
    program, known = Program.of(free), {name: values.value[name] for name in free.bounds}
    given = [known[name] for name in known if free[name].axis == rows[0].axis]
    there = np.all(np.isfinite(given), axis=0)

    @lru_cache(maxsize=1)  # residuals and slopes are asked for one after the other
    def at(*place: float) -> Values:
        own = dict(zip(curve.fitted, place, strict=True))
        return evaluate(free, values.given_labels, known | own, program)

    def residuals(place: Array) -> Array:
        return at(*place).value[rows[0].name][there]

    def jacobian(place: Array) -> Array:
        return -np.stack([at(*place).value[row.name][there] for row in rows[1:]], axis=1)

    nowhere = at(*[math.nan] * len(firsts))
    start = np.array([nowhere.scalar(first.name) for first in firsts])
    if np.count_nonzero(there) < len(start) or not np.isfinite(residuals(start)).all():
        return dict.fromkeys(curve.fitted, math.nan)
    from scipy.optimize import (
        least_squares,  # a quarter of a second, for fits that do not settle by themselves
    )

    ends = dict.fromkeys(("ftol", "xtol", "gtol"), LAST)
    with np.errstate(all="ignore"):  # a step to where the model has no value is not taken
        end = least_squares(residuals, start, jacobian, method="lm", x_scale="jac", max_nfev=STEPS, **ends)
    return dict(zip(curve.fitted, end.x.tolist(), strict=True))


def _rule(column: Column) -> Any:
    return column.rule


def _made(like: Column, value: Any, *number: int) -> Column:
    """A column of a formula, for the rows of another or in its place."""
    equation = Equation("", (like.cell, value), "", Kind.DEFINITION, "on the way")
    name = "_".join(map(str, (like.name, *number)))
    return Column(name, like.axis, Formula(equation), positive=False)


def _rows(sheet: Sheet, curve: Curve) -> list[Column]:
    """What is squared and summed, and its slope by each parameter, downwards, row by row.

    They are what stands below the sums of the sheet: of squares, and of their slopes.
    """
    own = sheet[curve.residual]
    weight = _rule(sheet[curve.name]).expression.function / own.cell**2
    slopes = (_rule(sheet[name]).equation.value.function / weight / own.cell for name in curve.fitted)
    return [_made(own, sqrt(weight) * each, n) for n, each in enumerate((own.cell, *slopes))]


def _free(column: Column, loop: Loop) -> Column:
    """A column that is given, unless it is a formula of a loop; what is adjusted of a row is as it begins."""
    if column in loop.iterated and column.axis is not None:
        return _made(column, _rule(column).start)
    if column in loop.formulas:
        return column
    bounds = Bounds(low=0, low_open=True) if column.positive and column in loop.iterated else Bounds()
    return replace(column, rule=Given("free", bounds), requires=(), alongside=())
