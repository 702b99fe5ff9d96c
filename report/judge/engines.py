"""Engines judge one another: the same sheet in each of them, compared cell by cell with 50 digits.

A difference is measured in units of eps times the condition of its cell: the bound that follows from the
sheet's own derivatives (:mod:`~loopsheet.report.judge.bounds`), so that an engine is neither blamed for
what no doubles could do better nor excused where they could.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import mpmath
import numpy as np

from ..cells.layout import Layout
from ..cells.values import CODES, Cell, Status, Values
from ..engines import ENGINES, exact
from ..quantity import SMALLEST
from ..result.agreement import LIMIT, Agreement
from ..sheet import Column, Formula, Root, Sheet
from .bounds import RoundingBounds
from .readers import Case, Reading

EPS = float(np.finfo(float).eps)

UNSETTLED = "#STEPS!"
"""What only a workbook says: its steps to a root are columns and come to an end, others go on."""

_STATUS = {code: status for status, code in CODES.items()}

MOST_FINDINGS = 20
"""How many cells of an engine are named; the rest are counted."""


@dataclass(frozen=True)
class Judge:
    """The exact values of a sheet and how wrong doubles may be."""

    sheet: Sheet
    judged: exact.ExactValues
    bounds: RoundingBounds
    """Of the exact values."""
    addresses: Mapping[str, Sequence[str]] = field(repr=False)
    """By column name; what the cells are called."""

    @classmethod
    def of(
        cls,
        sheet: Sheet,
        layouts: Mapping[str, Layout],
        labels: Mapping[str, Sequence[int]],
        data: Any,
        judged: exact.ExactValues | None = None,
    ) -> Judge:
        """Evaluate a sheet at 50 digits and bound the errors of doubles.

        Parameters
        ----------
        layouts : mapping of axis name to Layout
        labels, data
            As for :func:`loopsheet.report.engines.exact.evaluate`.
        judged : ExactValues, optional
            What that gives, if it is known.
        """
        judged = judged or exact.evaluate(sheet, labels, data)
        doubles = {
            name: np.array([np.nan if x is None else float(x) for x in found], dtype=np.float64)
            for name, found in judged.value.items()
        }
        empty = Values(sheet, layouts, {}, {})
        addresses = {column.name: _addresses(empty, column) for column in sheet.columns}
        return cls(sheet, judged, RoundingBounds(sheet, layouts, doubles), addresses)

    def agreement(self, reading: Reading) -> Agreement:
        """Judge what an engine found."""
        engine, program = reading.engine, reading.program
        if reading.missing or reading.unmade:
            nothing = Agreement(0, 0.0, "", (), engine=engine)
            return replace(nothing, missing=reading.missing, unmade=reading.unmade)
        if reading.failure:
            said = f"{engine} ({program}) failed: {reading.failure}"
            return Agreement(0, 0.0, "", (said,), engine=engine, program=program)
        tally = _Tally(engine)
        with mpmath.workdps(exact.DIGITS):
            for column in self.sheet.order:
                self._column(column, reading, tally)
        tally.findings += reading.beside
        more = len(tally.findings) - MOST_FINDINGS
        findings = tally.findings[:MOST_FINDINGS]
        if more > 0:
            findings.append(f"{engine}: {more} more cells differ")
        return Agreement(
            tally.cells,
            tally.worst,
            tally.where,
            tuple(findings),
            units=tally.units,
            units_where=tally.units_where,
            engine=engine,
            program=program,
            unbounded=tally.unbounded,
        )

    def _column(self, column: Column, reading: Reading, tally: _Tally) -> None:
        name = column.name
        exactly = self.judged.value[name]
        scale = max((abs(x) for x in exactly if x is not None), default=0)
        if column.unit == "1" and not column.positive:
            scale = max(scale, 1)
        numbers, codes = reading.value[name], reading.status[name]
        if not len(numbers) == len(codes) == len(exactly):
            tally.findings.append(f"{name}: {reading.engine} has {len(numbers)} rows, not {len(exactly)}")
            return
        followed = self._followed(column, reading)
        for row, (true, status) in enumerate(zip(exactly, self.judged.status[name], strict=True)):
            place, number = self.addresses[name][row], numbers[row]
            tally.cells += 1
            if codes[row] != CODES[status]:
                if followed and codes[row] == CODES[followed[row]]:
                    tally.unbounded += 1  # rounding before it decides whether it has a value: 0/0
                else:
                    tally.differs(place, codes[row], CODES[status])
            elif true is not None and number is not None:
                # Of what a file has cut, nothing is the engine's fault.
                lost = exact.as_mpf(reading.rounded[name][row]) if name in reading.rounded else 0
                difference = max(abs(exact.as_mpf(number) - true) - lost, 0)
                tally.add(place, difference, self.bounds.allowing(name, row, float(difference)), scale)

    def _followed(self, column: Column, reading: Reading) -> Sequence[Status]:
        """What 50 digits make of the engine's own numbers, where it has a cell that has another status."""
        codes, name = reading.status, column.name
        exactly = [CODES[each] for each in self.judged.status[name]]
        by_rule = isinstance(column.rule, (Formula, Root)) and name not in self.sheet.loop_of
        if list(codes[name]) == exactly or not by_rule:
            return ()
        status = {each: [_STATUS.get(code, Status.NOROOT) for code in own] for each, own in codes.items()}
        return exact.follows(column, self.sheet, self.judged.layouts, reading.value, status)


@dataclass
class _Tally:
    """What is counted while the cells of an engine are gone through."""

    engine: str
    cells: int = 0
    worst: float = 0.0
    where: str = "all equal"
    units: float = 0.0
    units_where: str = ""
    unbounded: int = 0
    findings: list[str] = field(default_factory=list)

    def differs(self, place: str, theirs: str, exactly: str) -> None:
        """A cell with another status."""
        if theirs == UNSETTLED:
            self.findings.append(
                f"{place}: the steps of {self.engine} to a root do not settle ({UNSETTLED}), 50 digits say "
                f"{exactly}: take a start nearer to it, or more steps, root(..., start=..., steps=60)"
            )
        else:
            self.findings.append(f"{place}: {self.engine} says {theirs}, 50 digits say {exactly}")

    def add(self, place: str, difference: Any, bound: float, scale: Any) -> None:
        """A cell with a number; what underflows is as near to the truth as doubles come."""
        if difference < SMALLEST:
            difference = 0
        relative = float(difference / scale) if scale else 0.0
        if relative > self.worst:
            self.worst, self.where = relative, place
        if not np.isfinite(bound):
            self.unbounded += 1
            return
        if not difference:
            return
        units = float(difference / (EPS * bound)) if bound else float("inf")
        if units > self.units:
            self.units, self.units_where = units, place
        if not units <= LIMIT:
            off = f"{relative:.1e}" if scale else f"{float(difference):.1e} (in SI), where 50 digits say 0"
            self.findings.append(f"{place}: {self.engine} is off by {off}")


def _addresses(values: Values, column: Column) -> list[str]:
    labels = values.labels(column)
    return [Cell(column.name, label, None, Status.OK).address for label in labels]


def compare_all(judge: Judge, case: Case) -> tuple[Agreement, ...]:
    """Compare every engine that is found on this machine."""
    found = []
    for reader in ENGINES.values():
        module, _, function = reader.partition(":")
        reading: Reading | None = getattr(importlib.import_module(module), function)(case)
        if reading is not None:
            found.append(judge.agreement(reading))
    return tuple(found)
