"""`design`: how sure a number will be that is not measured yet."""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING

from .common import (
    FINDINGS,
    OK,
    count,
    find,
    find_one,
    folder_argument,
    format_argument,
    keeping_arguments,
    studied,
)

if TYPE_CHECKING:
    from ..inputs.inputs import Inputs
    from ..result.design import Needed, Planned
    from ..result.result import Report
    from ..study import Study
    from ..uncertainty.design import Planner

MOST, MOST_PLANNED = 12, 60
"""Tests that are looked for, each of which makes the search longer, and tests that are planned."""

HELP = "tell how uncertain a number of planned drop tests will be, and what would make it surer"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    folder_argument(parser)
    said = "the planned impact speeds, such as '2.5, 3.5, 5 m/s' (default: those of the folder)"
    parser.add_argument("--speeds", metavar="LIST", help=said)
    said = (
        "uncertainties, such as 'v = +-0.5 %% rect; x_p = 0.1 um', each as [uncertainty] states it; "
        "a size alone is a standard uncertainty (default: what the folder states, else the digits of the "
        "nearest test)"
    )
    parser.add_argument("--u", metavar="LIST", help=said)
    said = "the cell whose uncertainty is wanted (default: the first result of the workbook)"
    parser.add_argument("--cell", metavar="CELL", help=said)
    said = "look for the N speeds with the smallest uncertainty; needs --between"
    parser.add_argument("--best", metavar="N", type=count, help=said)
    said = "the range of speeds to look in, such as '2 m/s .. 6 m/s'"
    parser.add_argument("--between", metavar="RANGE", help=said)
    said = "the uncertainty that the cell shall have, in the unit that it is shown in; needs --of"
    parser.add_argument("--want", metavar="U", help=said)
    said = "the column or parameter whose uncertainty is to be found for --want"
    parser.add_argument("--of", metavar="NAME", help=said)
    format_argument(parser, "text", "markdown", "json")
    keeping_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Print what a planned campaign will show; exit code 1 if it will not show what was asked for."""
    with studied(options.folder) as study:
        _refuse_what_does_not_fit(options)
        names = ("speeds", "u", "cell", "best", "between", "want", "of", "format")
        words = [f"{name} {getattr(options, name)!r}" for name in names]
        told, missed = study.kept("design", lambda: _told(study, options), *words)
    print(told)
    return FINDINGS if missed else OK


def _refuse_what_does_not_fit(options: argparse.Namespace) -> None:
    from ..messages.errors import wrong

    for one, other in (("best", "between"), ("want", "of")):
        if (getattr(options, one) is None) != (getattr(options, other) is None):
            raise wrong(f"--{one} and --{other} go together", "give both, or neither")
    if options.best is not None and options.speeds is not None:
        raise wrong("--best looks for the speeds that --speeds gives", "give one of the two")
    if options.best is not None and not 2 <= options.best <= MOST:
        raise wrong(f"--best {options.best} is no number of tests to look for", f"from 2 to {MOST}")


def _told(study: Study, options: argparse.Namespace) -> tuple[str, bool]:
    """What is printed, and whether what was wanted is out of reach or has no value."""
    from ..messages.errors import UsageError, diagnose
    from ..uncertainty.design import NotPlanned
    from ..views.design import FORMATS

    try:
        plan = _plan(study, options)
    except NotPlanned as error:
        raise UsageError(diagnose("LS619", reason=error)) from error
    missed = math.isnan(plan.budget.value) or (plan.needed is not None and plan.needed.is_out_of_reach)
    return FORMATS[options.format](plan), missed


def _plan(study: Study, options: argparse.Namespace) -> Planned:
    from ..prepared import Prepared
    from ..result.design import Planned
    from ..result.shares import shares
    from ..stages import evaluated
    from ..uncertainty.propagation import Spread

    report = study.computed
    planner, choice = _planner(report, options)
    best = None
    if isinstance(choice, tuple):
        study.step("looking for the best speeds")
        choice, best = planner.best(options.best, choice)
    # Without another choice each row is as its own is, even where two were measured at one speed.
    like = None if options.speeds or best else range(len(choice))
    planned = planner.inputs_of(choice, like)
    made = evaluated(Prepared(planned, report.sheet), lambda: study.ledger, study.step)
    spread = Spread(planned, made.values)
    name, label = planner.cell
    budget = spread.budget(name, made.values.row(report.sheet[name], label))
    chosen = planner.design.chosen
    u = {each: spread.u(each) for each in (chosen, *(n for n in planned.measured if n != chosen))}
    needed = _needed(planner, report, planned, options)
    columns, tests = shares(budget, planned)
    of_tests = {test: share for (_, test), share in tests.items()}
    curve = planner.design.curve
    return Planned(made, report, curve, budget, u, columns, of_tests, best, needed)


def _planner(
    report: Report, options: argparse.Namespace
) -> tuple[Planner, list[float] | tuple[float, float]]:
    """What plans, and what is chosen: a number for each test, or a range to choose from."""
    from dataclasses import replace

    from ..cells.address import parts
    from ..inputs.planned import read_numbers, read_u
    from ..messages.errors import UsageError, diagnose, wrong
    from ..stages import computing
    from ..uncertainty.design import Planner

    inputs = report.inputs
    if inputs.workbook.design is None:
        raise UsageError(diagnose("LS618", text=inputs.workbook.name))
    if gaps := [name for name, column in inputs.measured.items() if None in column]:
        test = inputs.only.tests[inputs.measured[gaps[0]].index(None)]
        raise wrong(f"test {test} has no {gaps[0]}", "say in a column 'left out' why it takes no part")
    design = inputs.workbook.design(report.sheet)
    address = options.cell or inputs.workbook.headline[0]
    found = parts(address)
    column = find(report, address if found is None else found[0])[0]
    compute = computing(report.sheet, (column, *(report.sheet[name] for name in inputs.measured)))
    said = read_u(options.u, "--u", inputs) if options.u is not None else {}
    planner = Planner(inputs, report.values, design, compute, (column.name, ()), said)
    own, unit = inputs.workbook.declared[design.chosen], inputs.header_units[design.chosen]
    choice: list[float] | tuple[float, float]
    if options.best is not None:
        ends = read_numbers(options.between, "--between", "..", own, unit)
        if len(ends) != 2 or not ends[0] < ends[1]:
            reason = f"--between '{options.between}' is no range"
            raise wrong(reason, "a range is two numbers that rise: '2 m/s .. 6 m/s'")
        choice = ends[0], ends[1]
        first = planner.equal(options.best, choice)
    else:
        text = options.speeds
        choice = (
            report.values.value[design.chosen].tolist()
            if text is None
            else (read_numbers(text, "--speeds", ",", own, unit))
        )
        if len(choice) > MOST_PLANNED:
            raise wrong(f"--speeds plans {len(choice)} tests", f"at most {MOST_PLANNED} are planned at once")
        first = list(choice)
    planned = replace(report, values=compute(planner.inputs_of(first)).values)
    return replace(planner, cell=(column.name, find_one(planned, address)[1])), choice


def _needed(planner: Planner, report: Report, planned: Inputs, options: argparse.Namespace) -> Needed | None:
    from ...derivations.unit_text import UnitError, parse_unit
    from ..inputs.planned import known, read_numbers
    from ..messages.errors import unknown, wrong
    from ..quantity import Bounds
    from ..workbook import Measured

    if options.of is None:
        return None
    names = known(planned)
    if options.of not in names:
        raise unknown("column or parameter", options.of, names)
    try:
        unit = parse_unit(report.shown[planner.cell[0]].unit).text
    except UnitError:
        unit = "1"  # its exponent is a symbol: it is shown in SI, and a bare number is meant so
    wanted = Measured("--want", unit, "a standard uncertainty", Bounds(low=0, low_open=True))
    found = read_numbers(options.want, "--want", ",", wanted, unit)
    if len(found) != 1:
        raise wrong(f"--want '{options.want}' is not one number", "--want 0.005")
    return planner.needed(options.of, found[0], planned)
