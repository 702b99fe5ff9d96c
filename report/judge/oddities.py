"""What is odd about a campaign's own data: cells without a value, rows left out, cells outside of a limit."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..axis import GroupAxis
from ..cells.address import address
from ..cells.marks import Margin, MarkCount, margins
from ..cells.values import Cell, Status
from ..messages.diagnostics import Check, Location
from ..messages.errors import listing, some
from ..quantity import behind
from ..result.chi_square import RARE, asked_of_chance, freedom, head, tail, tied, ties
from ..result.numbers import degrees_of_freedom, probability, rounded
from ..result.statements import of_column
from ..sheet import Column, Given, Sheet
from . import mixed_rows, readings, row_words, taken
from .claims import CLAIM
from .row_words import called
from .suspects import outliers, suspected

if TYPE_CHECKING:
    from ..inputs.inputs import Inputs
    from ..inputs.measurements import Measurements
    from ..inputs.uncertainty import SharedError
    from ..quantity import Printed
    from ..result.result import Report
    from ..result.uncertain import Misfit
    from ..workbook import Curve, SquareSum

DATA, LIMIT, UNCERTAINTY, SQUARES, GROUPS = "data", "limit", "uncertainty", "squares", "groups"
CONSTANTS, TWICE = "constants", "twice"
EXPECTED, LEFT_OUT = "expected", "left out"
"""The kinds of these checks."""
CELLS, ROWS, RESULT, PUBLISHED = "cells", "rows", "result", "published"
"""The checks of the first kind: every cell has a value, every sum is over all rows, there is a result, and
published.csv, where there is one, holds values."""
MISFIT = "what is fitted does not describe all {axis}, or their standard uncertainties are understated"
OVERSTATED = (
    "the standard uncertainties of the {axis} are overstated, or their deviations are not independent"
)
REACH = 2
"""So many standard uncertainties make an interval of 95 %."""
CAUSES = 4
"""So many causes of one column are named."""


def names(sheet: Sheet, inputs: Inputs) -> dict[str, list[str]]:
    """The names of all checks of a campaign's data, by kind, without computing anything."""
    workbook = inputs.workbook
    return {
        DATA: [CELLS, ROWS, RESULT, *([PUBLISHED] if inputs.empty else [])],
        LIMIT: list(map(_name, margins(sheet))),
        UNCERTAINTY: _stated(sheet, inputs),
        SQUARES: [
            *(each.name for each in workbook.squares if each.asked),
            *(each.name for each in workbook.curves),
            *(name for name, _ in workbook.means),
        ],
        GROUPS: [shared.name for shared in inputs.uncertainty.shared if shared.groups],
        row_words.WORDS: row_words.names(inputs),
        TWICE: [table.name or table.row for table in inputs.tables],
        readings.SCATTERS: readings.names(sheet, inputs),
        mixed_rows.MIXED: mixed_rows.names(sheet),
        taken.TAKEN: list(inputs.taken),
        CONSTANTS: [cell for cell, _ in _adjusted(sheet, inputs)],
        CLAIM: [claim.label for claim in workbook.claims],
        EXPECTED: [expectation.address for expectation in inputs.expected],
        LEFT_OUT: [f"{table.row} {each.test}" for table, each in inputs.left_out],
    }


def _name(margin: Margin) -> str:
    return f"{margin.of.name}: {margin.limit.mark}"


def _stated(sheet: Sheet, inputs: Inputs) -> list[str]:
    """The given columns of positive quantities of whose uncertainty something is stated."""
    shared = set[str]().union(*(each.statements for each in inputs.uncertainty.shared))
    return [
        name
        for name, bounds in sheet.bounds.items()
        if bounds.low == 0 and bounds.low_open and not bounds.integer
        if name in shared or any(each.stated for each in inputs.numbers(name))
    ]


def _adjusted(sheet: Sheet, inputs: Inputs) -> Iterator[tuple[str, list[str]]]:
    """The results that rest on two adjusted constants or more of whose correlation nothing is stated."""
    for name in (name for name in inputs.workbook.headline if name in sheet):
        behind = {each.name for each in sheet.ancestors(sheet[name]) if not each.exact}
        own = behind & inputs.workbook.constants
        pairs = map(frozenset, combinations(sorted(own), 2))
        if any(pair not in map(frozenset, inputs.uncertainty.correlations) for pair in pairs):
            yield name, sorted(own)


def oddities(report: Report, beyond: Mapping[str, NDArray[np.bool_]]) -> tuple[Check, ...]:
    """Check the data of a report that has been computed.

    `beyond`: the rows outside of each limit by more than their uncertainty, by the name of its margin.
    """
    return tuple(_Oddities(report, beyond).checks())


class _Oddities:
    """One look at a report: what is odd, and what of that somebody expects."""

    def __init__(self, report: Report, beyond: Mapping[str, NDArray[np.bool_]]) -> None:
        self.report, self.inputs, self.sheet, self.values = report, report.inputs, report.sheet, report.values
        self.met: dict[str, list[str]] = {each.address: [] for each in self.inputs.expected}
        self.failed, self.beyond = _Odd(self, report.faults), beyond
        self.outside = {
            margin.column.name: _Odd(self, self.cells(margin), _marked(margin))
            for margin in report.marks.margins
        }
        self.silent = {
            pair
            for margin in report.marks.margins
            if margin.limit.silent
            for pair in self.pairs(self.outside[margin.column.name].cells)
        }
        failed = self.pairs(self.failed.open) - self.silent
        odd = failed.union(*(self.pairs(each.open) for each in self.outside.values())) - self.silent
        self.suspect, self.because = suspected(report, odd, failed)

    def checks(self) -> Iterator[Check]:
        yield self.of_cells()
        yield self.of_rows()
        yield self.of_result()
        if at := self.inputs.empty:
            said = "the file of published values holds none, so that nothing is compared"
            yield Check(DATA, PUBLISHED, True, said, at, note="warning")
        yield from map(self.of_limit, self.report.marks.margins)
        yield from map(self.of_uncertainty, _stated(self.sheet, self.inputs))
        yield from (self.of_squares(each) for each in self.report.workbook.squares if each.asked)
        yield from map(self.of_curve, self.report.workbook.curves)
        yield from (self.of_mean(*each) for each in self.report.workbook.means)
        yield from (self.of_groups(each) for each in self.inputs.uncertainty.shared if each.groups)
        yield from row_words.checks(self.report)
        yield from map(self.of_twice, self.inputs.tables)
        yield from readings.checks(self.report)
        yield from mixed_rows.checks(self.report)
        yield from taken.checks(self.inputs)
        yield from (self.of_constants(*each) for each in _adjusted(self.sheet, self.inputs))
        yield from self.of_expectations()
        yield from self.of_left_out()

    def cells(self, margin: Margin) -> Iterator[Cell]:
        """The cells outside of a limit by more than their uncertainty, of those that tell something."""
        labels, marks = self.values.labels(margin.of), self.report.marks
        for row in np.flatnonzero(marks.outside(margin) & marks.telling(margin)).tolist():
            cell = self.values.cell(margin.of.name, labels[row])
            if self.beyond[margin.column.name][row]:
                yield cell
            else:  # what somebody expects of it has come about
                self.reason(cell, _marked(margin))

    def pairs(self, cells: Iterable[Cell]) -> set[tuple[tuple[str, int], ...]]:
        """The tests of the rows that rest on several."""
        return {tests for cell in cells if len(tests := self.values.tests(cell)) > 1}

    def reason(self, cell: Cell, says: str, by_test: bool = True) -> str:
        """Why somebody expects what is said of a cell; empty if nobody does. A loop rests on all tests.

        `by_test`: whether who expects something of a test expects it of its cells.
        """
        found, tests = "", self.values.tests(cell)
        if cell.name in self.sheet.loop_of:
            tests = tuple((table.name, test) for table in self.inputs.tables for test in table.tests)
        for each in self.inputs.expected:
            if (by_test or each.cell[0]) and each.covers(cell.name, cell.label, tests):
                self.met[each.address].append(f"{cell.address} {says}")
                found = found or each.reason
        return found

    def is_expected(self, cell: Cell, says: str) -> bool:
        """Whether somebody expects what is said of a cell, or of one that people know it by."""
        every = (cell, *self.leads(cell))
        reasons = [self.reason(each, says or _no_value(each)) for each in every]  # each is met
        return any(reasons)

    # --- what has no value

    def of_cells(self) -> Check:
        """Whether every cell has a value."""
        if not self.failed:
            told = " where it can" if any(self.values.errors()) else ""
            return Check(DATA, CELLS, True, f"every cell has a value{told}", self.inputs.place)
        by_column: dict[str, list[Cell]] = {}
        for cell in self.failed.told:
            by_column.setdefault(cell.name, []).append(cell)
        said = [self.without_value(self.sheet[name], cells) for name, cells in by_column.items()]
        return self.check(DATA, CELLS, "; ".join((*self.exact(), *said)), self.failed)

    def exact(self) -> Iterator[str]:
        """The tests whose numbers are all stated to be exact, where a fit weighs by what is stated."""
        for table in self.inputs.tables:
            weighed = {name: of for name, of in self.sheet.weighed.items() if of in table.measured}
            of = some(list(weighed.values()))
            for row, test in enumerate(table.tests):
                if weighed and not any(self.values.value[name][row] for name in weighed):
                    said = f"{table.row} {table.called(test)} has {of} without uncertainty"
                    yield f"{said}, so that no other {table.row} would count beside it"

    def without_value(self, column: Column, cells: Sequence[Cell]) -> str:
        """``alpha: 4 of 10 pairs have no value: alpha[1-2] and alpha[2-3] #NOROOT!: ...``."""
        by_cause: dict[str, list[Cell]] = {}
        for cell in cells:
            by_cause.setdefault(f"{cell.status.code}: {cell.why}", []).append(cell)
        known = {cause: map(self.named, map(self.known_as, each)) for cause, each in by_cause.items()}
        causes = [f"{some(list(each))} {cause}" for cause, each in known.items()]
        if (more := len(causes) - CAUSES) > 0:
            causes[CAUSES:] = [f"and {more} other causes" if more > 1 else "and another cause"]
        have = f": {len(cells)} of {self.size(column)} have" if column.axis is not None else " has"
        name = some([each.name for each in self.leads(cells[0])]) or column.name
        return f"{name}{have} no value: {'; '.join(causes)}"

    def named(self, cell: Cell) -> str:
        """A cell by its address, with the name of its row if that has one: ``w[3] (S-17)``."""
        axis = self.sheet[cell.name].axis
        if axis is None or not axis.is_given:
            return cell.address
        table = self.inputs.on(axis.name)
        return " ".join((cell.address, *(f"({table.rows[cell.label[0]][name]})" for name in table.naming)))

    def size(self, column: Column) -> str:
        axis = column.axis
        return "" if axis is None else f"{self.values.layouts[axis.name].size} {axis.name}"

    def of_rows(self) -> Check:
        """Whether all sums, means and fits are over all rows."""
        found: dict[str, list[str]] = {}
        foreseen: dict[str, list[str]] = {}
        for name in self.first(self.values.counted):
            for row, cell in enumerate(self.values.cells(name)):
                for rows, size, axis in self.values.left_out(name, row) if cell.value is not None else ():
                    over = f"over {rows} of {size} {self.sheet.rows_of(axis)}"
                    # It is another test that is missing in the sum.
                    which = foreseen if self.follows(cell, f"is {over}", by_test=False) else found
                    which.setdefault(over, []).extend(self.told_of(cell))
        told = ((over, self.first(dict.fromkeys(names))) for over, names in (found or foreseen).items())
        said = "; ".join(f"{some(n)} {'is' if len(n) == 1 else 'are'} {over}" for over, n in told)
        if found:
            return Check(DATA, ROWS, False, said, self.inputs.place)
        if said and not self.failed.open and any(self.met.values()):  # nobody else tells of it
            return Check(DATA, ROWS, True, f"{said}, as is expected", self.inputs.place, note="expected")
        said = "sums, means and fits are over all rows"
        if self.failed or self.values.counted:
            said = "rows are left out as is expected"
        return Check(DATA, ROWS, True, said, self.inputs.place)

    def of_result(self) -> Check:
        """Whether every cell of the result has a value."""
        headline = [name for name in self.report.workbook.headline if name in self.sheet]
        missing = [
            cell
            for name in headline
            for cell in self.values.cells(name)
            if cell.status is not Status.OK and not self.follows(cell, _no_value(cell))
        ]
        lacks = any(cell.status is not Status.OK for name in headline for cell in self.values.cells(name))
        said = "the result has a value" + (" where one is expected" if lacks or self.failed else "")
        if missing:
            causes = dict.fromkeys(self.known_as(cell.culprit or cell).address for cell in missing)
            has = "has" if len(missing) == 1 else "have"
            said = f"{some([cell.address for cell in missing])} of the result {has} no value"
            said += f", for want of {some(list(causes))}" * any(cell.culprit for cell in missing)
        return Check(DATA, RESULT, not missing, said, self.inputs.place)

    def told_of(self, cell: Cell) -> list[str]:
        """What :meth:`leading_to` names: of a group its own cells."""
        axis, columns = self.sheet[cell.name].axis, self.leading_to(cell.name)
        if not isinstance(axis, GroupAxis):
            return columns
        return [
            self.values.cell(name, cell.label).address if self.sheet[name].axis == axis else name
            for name in columns
        ]

    def leading_to(self, name: str) -> list[str]:
        """A column itself; of one that only leads somewhere those that it leads to."""
        found, waiting, seen = list[str](), [name], set[str]()
        while waiting:
            if (one := waiting.pop()) not in self.report.workbook.aside:
                found.append(one)
            elif one not in seen:
                seen.add(one)
                waiting += [each.name for each in reversed(self.sheet.dependents(self.sheet[one]))]
        return found

    def leads(self, cell: Cell) -> list[Cell]:
        """The cells of the same row to which one leads that no line declares: people know it by them."""
        if cell.name not in self.report.workbook.aside:
            return []
        led, axis = {*self.leading_to(cell.name)}, self.sheet[cell.name].axis
        return [
            self.values.cell(column.name, cell.label)
            for column in self.sheet.columns
            if column.name in led and column.axis == axis
        ]

    def known_as(self, cell: Cell) -> Cell:
        return next(iter(self.leads(cell)), cell)

    def first(self, names: Iterable[str]) -> list[str]:
        """Names, those of the result first."""
        return sorted(names, key=lambda name: name not in self.report.workbook.headline)

    def follows(self, cell: Cell, says: str, by_test: bool = True) -> bool:
        """Whether somebody expects what is said of a cell, or all errors that it may follow from."""
        behind = {cell.name, *(column.name for column in self.sheet.ancestors(self.sheet[cell.name]))}
        begun = cell.culprit or cell
        silent = self.report.marks.is_faultless(begun) and not self.reason(begun, _no_value(begun))
        return bool(self.reason(cell, says, by_test)) or not (
            silent or any(odd.name in behind for odd in self.failed.open)
        )

    # --- what is implausible, what is expected

    def of_limit(self, margin: Margin) -> Check:
        """Whether the cells of a column lie inside of one limit."""
        odd, name, limit = self.outside[margin.column.name], _name(margin), margin.limit
        marked, of = self.report.marks.count(margin), margin.of.name
        if not odd:
            inside = f"inside {limit.source}" if limit.source else f"none {limit.mark}"
            if marked.number:
                inside = f"{limit.told if margin.of.axis is None else marked.said} by no more than {REACH} u"
            return Check(LIMIT, name, True, f"{of}: {inside}", self.inputs.place)
        said = MarkCount(margin, len(odd.told), marked.size).said if margin.of.axis else limit.told
        by = f" by more than {REACH} u" * (len(odd.cells) < marked.number)
        told = f"{of}: {said}{by}: {some(list(map(self.valued, odd.told)))}"
        return self.check(LIMIT, name, told, odd)

    def of_uncertainty(self, name: str) -> Check:
        """Whether what is stated of the numbers of a positive quantity leaves them above zero."""
        column, reach = self.sheet[name], dict[Cell, str]()
        for cell in self.values.cells(name):
            number = self.printed(cell)
            u = 0.0 if number is None else self.stated_u(name, cell.label, number)
            if number is not None and REACH * u > number.value > 0:
                unit = behind(self.report.shown[name].unit)
                reach[cell] = f"{self.report.sure(name, u).text}{unit} of {self.valued(cell)}"
        if not reach:
            return Check(UNCERTAINTY, name, True, f"u({name}): plausible", self.inputs.place)
        odd = _Odd(self, reach, "has an implausible uncertainty")
        of = f"{len(odd.told)} of {self.size(column)}: " if column.axis is not None else ""
        said = f"u({name}): {of}{REACH} u reach below 0, where none can lie: "
        said += f"{some([reach[cell] for cell in odd.told])}; stated is {of_column(self.report, name)}: "
        said += "is its unit right, and is it a standard uncertainty?"
        return self.check(UNCERTAINTY, name, said, odd, self.where_stated(odd.told[0]))

    def stated_u(self, name: str, label: tuple[int, ...], number: Printed) -> float:
        """What is stated of a number and of what shares errors with it, in SI; not what keeps to bounds."""
        shared = (
            each.error(name, number)
            for each in self.inputs.uncertainty.shared
            if name in each.statements
            if not each.groups or any(set(label) & set(group) for group in each.groups)
        )
        return math.hypot(*(error.u for error in (*(number.stated or ()), *shared) if error.law is None))

    def where_stated(self, cell: Cell) -> str:
        """Where the uncertainty of a number stands, if that is beside it."""
        number = self.printed(cell)
        errors = (number.stated or ()) if number is not None else ()
        return next((error.where for error in errors if error.where), "")

    def of_squares(self, squares: SquareSum) -> Check:
        """Whether chance makes a sum of squares as large as it is, and as small."""
        cell, name, dof = self.values.cell(squares.name), squares.name, freedom(squares, self.report)
        if cell.value is None or dof < 1:
            said = "no value" if cell.value is None else f"nothing left over of {squares.axis}"
            return Check(SQUARES, name, True, f"{name}: {said}", self.inputs.place)
        known, together = asked_of_chance(squares, self.report), tied(self.report)
        if known is None:
            said = f"{name}: errors are shared or correlated, and its weights leave that out"
            return Check(SQUARES, name, True, said, self.inputs.place, skipped=True)
        found = f", {rounded(known[0], 2).plain} with what errors have in common," * together
        found = f"{name} = {self.report.text(cell)}{found} on {degrees_of_freedom(known[1])}"
        found += f" by a u with {known[2]:.0f}" * math.isfinite(known[2])
        large, small = tail(*known), head(*known)
        # What is left without some rows is a sum by the weights of the fit.
        instead = self.without(squares) if large < RARE and squares.deviation and not together else ""
        return self.by_chance(cell, found, squares.axis, large, small, instead)

    def without(self, squares: SquareSum) -> str:
        """What is left of a sum of squares without the rows that lie off, as they were found one by one."""
        found = outliers(self.report, squares)
        told = ", then ".join(
            f"{called(self.report, self.inputs.only, [each.test])} (farthest of {each.among}, "
            f"{rounded(each.deviation, 2).plain} standard deviations off: {probability(each.chance)})"
            for each in found
        )
        left = (
            f"{rounded(each.chi2, 2).plain} on {each.dof}: {probability(each.left)}" for each in found[-1:]
        )
        return "".join(f"; without {told} it is {each}" for each in left)

    def of_curve(self, curve: Curve) -> Check:
        """What of the residuals; and whether its weights take errors for independent ones that are not."""
        found, own = self.of_residuals(curve), {e.name for e in self.sheet.ancestors(self.sheet[curve.name])}
        told = ties(self.report, [of for u, of in self.sheet.weighed.items() if u in own])
        said = f"{found.message}; {curve.name} and its weights leave out that {told}: "
        said += f"{listing(curve.fitted, last='and')} are not the likeliest numbers; their u counts it"
        return replace(found, message=said, note=found.note or "warning") if told else found

    def of_residuals(self, curve: Curve) -> Check:
        """Whether the uncertainties of its rows make the residuals of a curve as large as they are."""
        known, (first, *_) = self.report.uncertain().misfits.get(curve.name), self.values.cells(curve.name)
        if known is None:
            left = self.values.rows_summed(curve.name, curve.axis) > len(curve.fitted)
            said = f"nothing left over of {curve.axis}"
            if left:
                said = f"{curve.observed} has no uncertainty to compare the residuals with, or too many rows"
            return Check(SQUARES, curve.name, True, f"{curve.name}: {said}", self.inputs.place, skipped=left)
        found = f"{curve.residual}: {known.said}"
        if math.isfinite(known.known_by):
            found += f" by a u with {known.known_by:.0f}"
        large, small = (how(known.chi2, known.dof, known.known_by) for how in (tail, head))
        if not known.is_stated:
            small = 1.0  # nobody overstated what the printed digits say
        instead = self.instead(curve, known) if large < RARE else ""
        return self.by_chance(first, found, curve.axis, large, small, instead)

    def instead(self, curve: Curve, known: Misfit) -> str:
        """What to state if the model is right: what the scatter about the curve tells."""
        what = "what is stated" if known.is_stated else "what the printed digits say"
        told = f"; if the model is right, u is {rounded(known.birge, 2).plain} times {what} (Birge's ratio)"
        if curve.observed not in self.inputs.measured or curve.weighed or self.sheet[curve.name].axis:
            return f"{told}, and by the scatter {some([f's_{each}' for each in curve.fitted])}"
        shown = self.report.shown[curve.scatter]
        size = rounded(shown.of(self.values.scalar(curve.scatter)), 2).plain + behind(shown.unit)
        return f'{told}: {curve.observed} = "u = {size}, dof = {known.dof}" under [uncertainty] says so'

    def of_mean(self, name: str, of: str) -> Check:
        """Whether what a result is the mean of differs by no more than its uncertainties make it."""
        known, every = self.report.uncertain().misfits.get(name), self.values.value[of]
        number = np.count_nonzero(np.isfinite(every))
        found = f"{name} is the mean of {number} {of}"
        if known is None or not known.is_stated:
            said = f"{found}, of which no uncertainty is stated that could say how far they differ"
            return Check(SQUARES, name, True, said, self.inputs.place)
        found += f": {known.said}"
        large, cell = tail(known.chi2, known.dof, known.known_by), self.values.cell(name)
        if large >= RARE:
            return Check(SQUARES, name, True, f"{found}, which is what chance makes", self.inputs.place)
        about, shown = every - self.values.scalar(name), self.report.shown[name]
        far = address(of, self.values.labels(self.sheet[of])[int(np.nanargmax(np.abs(about)))])
        scatter = math.sqrt(float(np.nanvar(every, ddof=1)) / number)
        size = rounded(shown.of(scatter) - shown.of(0.0), 2).plain + behind(shown.unit)
        said = (
            f"{found}; the probability of so much is {probability(large)}: one of them is wrong, they are of "
            f"several quantities, or their standard uncertainties are understated; {far} is farthest; by "
            f"their scatter u of {name} is {size}"
        )
        return self.check(SQUARES, name, said, _Odd(self, [cell], "is improbable"))

    def by_chance(self, cell: Cell, found: str, axis: str, large: float, small: float, instead: str) -> Check:
        """What to say of a sum of squares with the probabilities of so much and of so little."""
        if min(large, small) >= RARE:
            return Check(SQUARES, cell.name, True, f"{found}, which is what chance makes", self.inputs.place)
        said = (
            f"the probability of so much is {probability(large)}: {MISFIT}"
            if large < RARE
            else f"the probability of so little is {probability(small)}: {OVERSTATED}"
        )
        said = f"{found}; {said.format(axis=axis)}{instead}"
        return self.check(SQUARES, cell.name, said, _Odd(self, [cell], "is improbable"))

    def of_groups(self, shared: SharedError) -> Check:
        """Whether every row is in a group of an error that groups share."""
        table = self.inputs.of(next(iter(shared.statements)))
        rest = [test for test in table.tests if not any(test in group for group in shared.groups)]
        row = table.row
        if not rest:
            said = f"{shared.name}: every {row} is in a group"
            return Check(GROUPS, shared.name, True, said, self.inputs.place)
        which = f"{called(self.report, table, rest)} {'is' if len(rest) == 1 else 'are'}"
        said = f"{shared.name}: {which} in no group of it, and so without it; a group may be of one {row}"
        return Check(GROUPS, shared.name, True, said, self.inputs.place, note="warning")

    def of_twice(self, table: Measurements) -> Check:
        """Whether a row stands in a table under two numbers."""
        pairs, name = readings.twice(table), table.name or table.row
        if not pairs:
            return Check(TWICE, name, True, f"no {table.row} stands there twice", self.inputs.place)
        column = next(iter(table.measured))
        odd = _Odd(self, [self.values.cell(column, (test,)) for _, test in pairs], "stands there twice")
        told = some([called(self.report, table, pair) for pair in pairs])
        said = f"{told} have the same numbers in all columns: is one of them another, or entered twice?"
        return self.check(TWICE, name, said, odd)

    def of_constants(self, cell: str, constants: Sequence[str]) -> Check:
        """That a result rests on constants whose errors are not independent."""
        said = (
            f"{cell} rests on {some(constants)}, which were adjusted together: their errors are correlated, "
        )
        said += "which its u leaves out; state it under [uncertainty.correlation]"
        return Check(CONSTANTS, cell, True, said, self.inputs.place, note="warning")

    def valued(self, cell: Cell) -> str:
        """``alpha[1-2] = 2.73``; a given cell as it was printed."""
        return f"{cell.address}{' ' if cell.value is None else ' = '}{self.report.text(cell)}"

    def of_expectations(self) -> Iterator[Check]:
        """Whether each expectation has come true."""
        for cell in (self.values.cell(*each.cell) for each in self.inputs.limits):
            if cell.status is not Status.OK:
                self.reason(cell, _no_value(cell))
        for each in self.inputs.expected:
            met = list(dict.fromkeys(self.met[each.address]))
            said = f"{each.address}, {each.reason}: {some(met)}"
            if not met:
                said = f"{each.address} is expected to be odd ({each.reason}), and is not: drop that line"
                said += "; a column 'left out' of its table leaves a row out" * (not each.cell[0])
            yield Check(EXPECTED, each.address, bool(met), said, each.at, note="expected")

    def of_left_out(self) -> Iterator[Check]:
        """The tests that somebody left out, and what is not compared for that."""
        for table, each in self.inputs.left_out:
            said = f"{table.row} {table.called(each.test)}, {each.reason}"
            aside = ((value, self.sheet[value.columns[0]].axis) for value in self.inputs.aside)
            if rests := sum(each.test in v.index and table in self.inputs.beneath(on) for v, on in aside):
                said += f"; {rests} published {'value rests' if rests == 1 else 'values rest'} on it"
            yield Check(LEFT_OUT, f"{table.row} {each.test}", True, said, each.at, note="left out")

    def check(self, kind: str, name: str, said: str, odd: _Odd, where: str = "") -> Check:
        """A check that found something: with the test to look at, or with why it is expected."""
        if not odd.open:
            return Check(kind, name, True, f"{said}, as is expected", self.inputs.place)
        if self.suspect and self.is_due_to_suspect(odd.open):
            axis, test = self.suspect
            table = self.inputs.on(axis)
            said += f"; look at {table.row} {table.called(test)} first: {self.because}"
        warns = kind in (LIMIT, UNCERTAINTY, SQUARES, TWICE)
        at = self.at(where) if where else self.place(odd.open)
        return Check(kind, name, warns, said, at, note="warning" * warns)

    def is_due_to_suspect(self, cells: Iterable[Cell]) -> bool:
        """Whether any rests on the test to look at and is not odd by itself, as pairs at one speed are."""
        return any(self.suspect in tests for tests in {*map(self.values.tests, cells)} - self.silent)

    # --- where

    def place(self, cells: Sequence[Cell]) -> Location:
        """Where the first cell was printed, or the first number of its row, or of the test to look at.

        An empty cell is in a row; what is in none is told of report.toml.
        """
        if (printed := self.printed(cells[0])) is not None:
            return self.at(printed.where, len(printed.text))
        if (row := self.row(cells)) is None:
            return self.inputs.place
        axis, test = row
        table = self.inputs.on(axis)
        columns, place = table.measured.items(), table.tests.index(test)
        every = (column[place] for name, column in columns if name not in self.inputs.taken)
        first = next(filter(None, every), None)
        return self.inputs.place if first is None else self.at(first.where, len(first.text))

    def row(self, cells: Sequence[Cell]) -> tuple[str, int] | None:
        """The axis and the test of an empty cell, or what to look at first."""
        axis = self.sheet[cells[0].name].axis
        if axis is not None and axis.is_given and isinstance(self.sheet[cells[0].name].rule, Given):
            return axis.name, cells[0].label[0]
        return self.suspect if self.is_due_to_suspect(cells) else None

    def at(self, where: str, length: int = 1) -> Location:
        """The place that a trace tells, else report.toml."""
        found = re.fullmatch(r"(.*):(\d+):(\d+)", where)
        if found is None:
            return self.inputs.place
        path = Path(self.inputs.folder, found[1]).as_posix()
        return Location(path, int(found[2]), int(found[3]), length)

    def printed(self, cell: Cell) -> Printed | None:
        """A given cell as it was printed."""
        column = self.sheet[cell.name]
        printed = self.inputs.printed(cell.name) if isinstance(column.rule, Given) else ()
        return printed[self.values.row(column, cell.label)] if printed else None


class _Odd:
    """Odd cells of one kind, and those of them that nobody expects."""

    def __init__(self, look: _Oddities, cells: Iterable[Cell], says: str = "") -> None:
        self.cells = list(cells)
        self.open = [cell for cell in self.cells if not look.is_expected(cell, says)]

    def __bool__(self) -> bool:
        return bool(self.cells)

    @property
    def told(self) -> list[Cell]:
        """Those to tell of: what nobody expects; if all are expected, all."""
        return self.open or self.cells


def _marked(margin: Margin) -> str:
    return f"is marked ({margin.limit.mark})"


def _no_value(cell: Cell) -> str:
    return f"has no value ({cell.status.code})"
