"""What engines find in a campaign beside what 50 digits find, and where roundings decide between them."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import mpmath
import numpy as np
from random_campaigns import SHEETS, Broken, Campaign, Node, judge_of, laid_out, numpy_reads
from sympy import Float, preorder_traversal

from loopsheet.report.cells.layout import rows_of
from loopsheet.report.cells.values import CODES, Status
from loopsheet.report.engines import exact
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.excel_formulas import _UNSETTLED
from loopsheet.report.engines.excel_loops import PASSES, pass_columns, pass_name
from loopsheet.report.engines.excel_values import STAYS
from loopsheet.report.engines.numpy import Program
from loopsheet.report.judge.engines import EPS, Judge
from loopsheet.report.judge.readers import Reading
from loopsheet.report.quantity import LARGEST, SMALLEST
from loopsheet.report.result.agreement import LIMIT
from loopsheet.report.sheet import Column, Formula, Sheet

__all__ = ["Tally", "compare"]

_OVERFLOW = CODES[Status.OVERFLOW]


@dataclass
class Tally:
    """What was found in campaigns that passed."""

    seen: set[str] = field(default_factory=set)
    codes: Counter[str] = field(default_factory=Counter)
    excused: Counter[str] = field(default_factory=Counter)
    worst: dict[str, float] = field(default_factory=dict)
    cells: int = 0
    unbounded: int = 0
    broken: int = 0


def compare(campaign: Campaign, node: Node, tally: Tally, *others: Reading) -> None:
    """Assert that NumPy, the page and other engines find what 50 digits find; what is excused is counted."""
    judge = judge_of(campaign)
    ours, broken = numpy_reads(campaign, Program.of(judge.sheet))
    theirs, broken_too = node.read(campaign, campaign.variant)
    excuses = set()
    for reading in (ours, theirs, *others):
        agreement = judge.agreement(reading)
        if agreement.findings:
            why = excuse(campaign, judge, reading, agreement.findings)
            assert why, (campaign, agreement.findings)
            excuses.add(why)
        else:
            tally.worst[reading.engine] = max(tally.worst.get(reading.engine, 0.0), agreement.units)
            tally.unbounded += agreement.unbounded
            tally.cells += agreement.cells
    if not excuses and broken != broken_too:
        assert reasons_decided(campaign, broken, broken_too), (broken, broken_too)
        excuses.add("reasons")
    tally.excused.update(excuses)
    tally.broken += len(broken)
    tally.codes.update(code for codes in ours.status.values() for code in codes)


# --- what roundings decide ---


class Moved(exact._Exact):
    """50 digits of a sheet whose every cell is a few roundings off.

    Equal cells of a column move together: that two tests have the same speed is no accident of rounding.
    """

    def __init__(self, campaign: Campaign, judge: Judge, seed: int) -> None:
        bounds = judge.sheet.bounds
        given = {n: [exact._datum(x, bounds[n]) for x in column] for n, column in campaign.data.items()}
        super().__init__(judge.sheet, laid_out(campaign), given)
        self.rng = random.Random(seed)

    def _rule(self, column: Column, size: int, what: str) -> Any:
        status, compute = super()._rule(column, size, what)
        signs: dict[Any, int] = {}

        def off(row: int) -> Any:
            value = compute(row)
            sign = 0 if column.exact else signs.setdefault(value, self.rng.choice((-1, 1)))
            return value * (1 + sign * LIMIT * EPS)

        return status, off


def excuse(campaign: Campaign, judge: Judge, reading: Reading, findings: Sequence[str]) -> str:
    """Why the first cells that differ from 50 digits are right all the same; empty if they are not.

    Roundings decide: cells that are a few of them off have the same code at 50 digits too, or where a number
    differs, they have none, or one that has little to do with it. Or a step on the way is beyond doubles.
    """
    places = {
        place: (name, row) for name in judge.addresses for row, place in enumerate(judge.addresses[name])
    }
    found = [places[place] for f in findings if (place := f.partition(": ")[0]) in places]
    if not found:
        return ""
    name = found[0][0]
    rows = [row for other, row in found if other == name]
    true, codes, theirs = judge.judged.value[name], judge.judged.status[name], reading.status[name]

    if all(theirs[row] == _UNSETTLED.strip('"') for row in rows) and _passes_too_few(campaign, judge, name):
        return "passes"

    if all(theirs[row] == _OVERFLOW and _steps_beyond(campaign, judge, name, row) for row in rows):
        return "steps"

    def decided(row: int, off: exact.ExactValues) -> bool:
        if theirs[row] != CODES[codes[row]]:
            return theirs[row] == CODES[off.status[name][row]]
        value = off.value[name][row]
        return value is None or abs(value - true[row]) > abs(true[row]) / 8

    for seed in range(64):
        with mpmath.workdps(exact.DIGITS + exact._GUARD):
            off = Moved(campaign, judge, seed).run()
            rows = [row for row in rows if not decided(row, off)]
        if not rows:
            return "roundings"
    return ""


def _passes_too_few(campaign: Campaign, judge: Judge, name: str) -> bool:
    """Whether a loop that a column rests on still moves in the last pass of a workbook, at 50 digits too."""
    sheet = judge.sheet
    within = {name, *(each.name for each in sheet.ancestors(sheet[name]))}
    loops = [loop for loop in sheet.loops if within & set(loop.names)]
    whole = Sheet((*sheet.columns, *pass_columns(sheet, PASSES)))
    values = exact.evaluate(whole, campaign.labels, campaign.data).value
    last = [
        pair
        for loop in loops
        for column in loop.iterated
        for pair in zip(*(values[pass_name(column.name, PASSES - back)] for back in (1, 0)), strict=True)
    ]
    return any(new is not None and abs(new - old) * STAYS > abs(new) for old, new in last)


def _steps_beyond(campaign: Campaign, judge: Judge, name: str, row: int) -> bool:
    """Whether a step towards a value of a formula is one that no double holds: that has the same code."""
    column, layouts, cells = judge.sheet[name], laid_out(campaign), {}
    if not isinstance(column.rule, Formula) or judge.judged.value[name][row] is None:
        return False
    for reference in judge.sheet.named(column):
        if reference.over is not None:
            return False
        rows = rows_of(reference.index, column.axis, layouts)
        at = 0 if reference.index is None else row
        value = judge.judged.value[reference.name][at if rows is None else rows[row]]
        cells[reference.cell] = Float(value, exact.DIGITS)
    steps = (step.xreplace(cells) for step in preorder_traversal(column.rule.expression))
    return any(step.is_number and not SMALLEST <= abs(step) < LARGEST for step in steps if step != 0)


def reasons_decided(campaign: Campaign, ours: Broken, theirs: Broken) -> bool:
    """Whether roundings of the data decide which conditions cells break that have the same code anyway."""
    rng = np.random.default_rng(7)
    data = {name: np.array(column) for name, column in campaign.data.items()}
    for name in data.keys() - {"points_per_pair"}:
        data[name] = data[name] * (1 + LIMIT * EPS * rng.choice([-1, 1], (64, data[name].size)))
    broken = engine.evaluate(SHEETS[campaign.variant], campaign.labels, data).broken
    differ = [cell for cell in {*ours, *theirs} if ours.get(cell) != theirs.get(cell)]
    return all((broken[cell[0]][..., cell[1]] == theirs.get(cell, 0)).any() for cell in differ)
