"""`card`: parameters for the contact of a simulation code, with which it returns what was measured."""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import replace
from typing import TYPE_CHECKING

from .common import FINDINGS, OK, Progress, folder_argument, format_argument, keeping_arguments, told

if TYPE_CHECKING:
    from sympy import Symbol

    from ..impacts.drops import Drop, Drops
    from ..messages.errors import UsageError
    from ..result.result import Report
    from ..study import Study

HELP = "tell what to type into a simulation code, so that its contact returns what was measured"

POISSON = "0.3"
"""Poisson's ratio of most metals, where none is given."""
_CURVES = (("alpha_eiv", "C_eiv"), ("alpha_log", "C_log"), ("alpha_lin", "C_lin"))
"""Cells of the identified loading curve, the best first."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    folder_argument(parser)
    said = (
        "the code that the card is for, or 'table', 'c' or 'python' for the identified law itself (default: "
    )
    parser.add_argument("--for", metavar="CODE", dest="code", default="list", help=said + "a list of them)")
    said = "the impact speed that the card is for, such as '3 m/s' (default: the test in the middle)"
    parser.add_argument("--speed", metavar="V", help=said)
    said = (
        "Young's modulus of both bodies, such as '210 GPa', for Hertz's stiffness (default: the stiffness of "
    )
    parser.add_argument("--E", metavar="E", help=said + "the identified loading curve)")
    said = f"Poisson's ratio of both bodies (default: {POISSON})"
    parser.add_argument("--nu", metavar="NU", help=said)
    said = "effective radius of the contact, such as '6.35 mm' (default: that of the ball)"
    parser.add_argument("--R", metavar="R", help=said)
    format_argument(parser, "text", "markdown", "json")
    keeping_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Print a card, a list of the codes, or the identified law; exit code 1 if the data are at fault."""
    from ..impacts.codes import CODES
    from ..impacts.source import SOURCES
    from ..inputs.folders import report_folder
    from ..messages.errors import UsageError, diagnose, listing, suggest
    from ..study import Study

    if options.code == "list":
        titles = [(code.name, code.title) for code in CODES.values()]
        titles += [(name, source.said) for name, source in SOURCES.items()]
        print(*(f"{name:14} {title}" for name, title in titles), sep="\n")
        return OK
    if options.code not in CODES and options.code not in SOURCES:
        known = [*CODES, *SOURCES]
        hint = suggest(options.code, known)
        allowed = listing(known, most=20)
        raise UsageError(diagnose("LS604", kind="code", text=options.code, known=allowed, suggestion=hint))
    with Progress(sys.stderr) as progress:
        study = Study(report_folder(options.folder), step=progress)
        names = ("code", "speed", "E", "nu", "R", "format")
        parts = [f"{name} {getattr(options, name)!r}" for name in names]
        # What is found names its place, and so the folder as it is written here.
        made, found = study.kept("card", lambda: _told(study, options), *parts, str(study.folder))
    for finding in found:  # first: who reads the card may close the pipe before its end
        print(finding, file=sys.stderr)
    print(made)
    return FINDINGS if found else OK


def _told(study: Study, options: argparse.Namespace) -> tuple[str, list[str]]:
    """The card, and what is found wrong with the data that it is made from."""
    report = study.computed
    return _made(study, report, options), told(odd for odd in report.oddities if not odd.passed)


def _made(study: Study, report: Report, options: argparse.Namespace) -> str:
    from ..impacts.card import Unreachable, card
    from ..impacts.code import R, nu
    from ..impacts.codes import CODES
    from ..impacts.source import SOURCES
    from ..messages.errors import UsageError, diagnose
    from ..views.card import FORMATS
    from ..views.checks import lines

    drops = _drops(report)
    taken = _taken(report, drops)
    if options.code in SOURCES:
        return _law(drops, options, [*lines(report.oddities), *taken])
    code = CODES[options.code]
    if options.E is not None and code.by_hertz is None:
        raise _wrong(f"--E says nothing to {code.name}: its stiffness is not Hertz's", "leave --E out")
    asked = code.asks(options.E is not None)
    for name, symbol in (("nu", nu), ("R", R)):
        if getattr(options, name) is not None and symbol not in asked:
            raise _wrong(f"--{name} says nothing to {code.name} here", f"leave --{name} out")
    drop = _drop(drops, options)
    modulus = None if options.E is None else _read(options.E, "--E", "Pa", "GPa")
    radius = drops.radius if options.R is None else _read(options.R, "--R", "m", "m")
    if R in asked and not math.isfinite(radius):
        raise _wrong(f"{code.name} wants the radius of the ball, which the folder does not say", "give --R")
    poisson = _read(options.nu or POISSON, "--nu", "1", "1", 0.5)
    study.step("solving for the parameters")
    try:
        made = card(code, drops, drop, report.title, modulus, poisson, radius)
    except Unreachable as error:
        raise UsageError(diagnose("LS625", text=code.title, reason=error)) from error
    notes = (*made.notes, *_assumptions(options, asked, radius, poisson), *taken)
    return FORMATS[options.format](replace(made, notes=notes, oddities=report.oddities))


def _taken(report: Report, drops: Drops) -> list[str]:
    """Which tests are not in it, and which curve is, if not the best."""
    inputs = report.inputs
    found = [
        f"{inputs.workbook.row} {inputs.called(inputs.tests[row])} is left out here: {why}"
        for row, why in drops.aside
    ]
    better = [name for name, _ in _CURVES if name in report.sheet]
    name = _curve(report)[0]
    if name in better[1:]:
        found.append(f"the loading curve is that of {name}: {better[0]} has no value")
    return found


def _assumptions(
    options: argparse.Namespace, asked: frozenset[Symbol], radius: float, poisson: float
) -> tuple[str, ...]:
    """What was taken though nobody said it."""
    from ..impacts.code import R, nu

    told = []
    if R in asked and options.R is None:
        told.append(f"the effective radius is that of the ball, {radius:g} m: the target is flat")
    if nu in asked and options.nu is None:
        told.append(f"Poisson's ratio was not given: {poisson:g}")
    return tuple(told)


def _law(drops: Drops, options: argparse.Namespace, remarks: list[str]) -> str:
    """The identified law itself."""
    from ..impacts.source import SOURCES
    from ..messages.errors import UsageError, diagnose

    names = [name for name in ("E", "nu", "R") if getattr(options, name) is not None]
    names += ["speed"] if options.speed is not None and options.code != "table" else []
    names += ["format"] if options.format != "text" else []
    if names:
        raise _wrong(f"--{names[0]} says nothing to --for {options.code}", f"leave --{names[0]} out")
    if not drops.has_curve:
        raise UsageError(diagnose("LS624", text="the folder", reason="no loading curve was found"))
    return SOURCES[options.code].of(drops, _drop(drops, options), remarks)


def _drop(drops: Drops, options: argparse.Namespace) -> Drop:
    """The impact that is asked for."""
    if options.speed is None:
        return drops.middle
    speed = _read(options.speed, "--speed", "m/s", "m/s")
    drop = drops.at(speed)
    if drop is None:
        ends = f"{drops.tests[0].speed:g} to {drops.tests[-1].speed:g} m/s"
        raise _wrong(
            f"--speed {speed:g} m/s is not among the measured speeds, {ends}", "nothing is extrapolated"
        )
    return drop


def _drops(report: Report) -> Drops:
    """What a report says of impacts."""
    from ..impacts.drops import Drops
    from ..messages.errors import UsageError, diagnose

    wanted = {"v": "m/s", "e": "1", "m_red": "kg"}
    units = {column.name: column.unit for column in report.sheet.columns}
    lacking = [f"{name} in {unit}" for name, unit in wanted.items() if units.get(name) != unit]
    v = _column(report, "v")
    _, alpha, C = _curve(report)
    drops = Drops(
        _number(report, "m_red"),
        v,
        _column(report, "e"),
        _column(report, "x_p") or (math.nan,) * len(v),
        alpha,
        C,
        _number(report, "beta"),
        _number(report, "ball_diameter") / 2,
    )
    if lacking:
        reason = f"it has no {' and no '.join(lacking)}"
    elif not drops.mass > 0:
        reason = "m_red has no value"
    elif not drops.tests:
        reason = "no test has a speed and a restitution between 0 and 1"
    else:
        return drops
    raise UsageError(diagnose("LS624", text=f"the report '{report.title}'", reason=reason))


def _curve(report: Report) -> tuple[str, float, float]:
    """Which loading curve is taken, and its two numbers; NaN where there is none."""
    curves = ((a, _number(report, a), _number(report, c)) for a, c in _CURVES)
    return next((curve for curve in curves if math.isfinite(sum(curve[1:]))), ("", math.nan, math.nan))


def _column(report: Report, name: str) -> tuple[float, ...]:
    found = report.values.value
    return tuple(map(float, found[name])) if name in report.sheet and name in found else ()


def _number(report: Report, name: str) -> float:
    values = _column(report, name)
    return values[0] if len(values) == 1 else math.nan


def _read(text: str, option: str, unit: str, usual: str, high: float | None = None) -> float:
    """Read a number of an option, in SI."""
    from ..inputs.planned import read_numbers
    from ..quantity import Bounds
    from ..workbook import Measured

    bounds = Bounds(low=0, low_open=True, high=high, high_open=high is not None)
    found = read_numbers(text, option, ";", Measured(option, unit, "a number", bounds), usual)
    if len(found) != 1:
        raise _wrong(f"{option} '{text}' is not one number", f"{option} '1 {usual}'")
    return found[0]


def _wrong(reason: str, known: str) -> UsageError:
    from ..messages.errors import UsageError, diagnose

    return UsageError(diagnose("LS614", reason=reason, known=known))
