"""`card`: parameters for the contact of a simulation code, with which it returns what was measured."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from .common import FINDINGS, OK, count, folder_argument, format_argument, keeping_arguments, studied, told

if TYPE_CHECKING:
    from ..impacts.drops import Drops
    from ..result.result import Report
    from ..study import Study

HELP = "tell what to type into a simulation code, so that its contact returns what was measured"

MOST = 100_000
"""Impacts of a sweep: a quarter of an hour."""
MOST_IN_ONE_PLACE = 1000
"""Impacts of a course, of some hundred lines each."""
_NUMBERS = {"speed": "m/s", "E": "", "nu": "1", "R": ""}
"""The options that are numbers, and the unit of one that names none; empty where it has to name one."""
_OF_A_CARD = ("model", *_NUMBERS, "sweep", "course")
"""The options that say nothing to the list of codes."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    folder_argument(parser)
    said = (
        "the code or contact model that the card is for, or 'table', 'c' or 'python' for the identified law "
        "itself (default: "
    )
    parser.add_argument("--for", metavar="CODE", dest="code", default="list", help=said + "a list of them)")
    said = "of 'table', 'c' and 'python': the law of a contact model that the folder has"
    parser.add_argument("--model", metavar="MODEL", help=f"{said} (default: the identified law)")
    said = "the impact speed that the card is for, such as '3 m/s' (default: the test in the middle)"
    parser.add_argument("--speed", metavar="V", help=said)
    said = (
        "Young's modulus of both bodies, such as '210 GPa', for Hertz's stiffness (default: the stiffness of "
    )
    parser.add_argument("--E", metavar="E", help=said + "the identified loading curve)")
    said = "Poisson's ratio of both bodies (default: 0.3)"
    parser.add_argument("--nu", metavar="NU", help=said)
    said = "effective radius of the contact, such as '6.35 mm' (default: that of the ball)"
    parser.add_argument("--R", metavar="R", help=said)
    said = "instead of the card, N impacts under it from the slowest to the fastest measured speed, as CSV"
    many = parser.add_mutually_exclusive_group()
    many.add_argument("--sweep", metavar="N", type=partial(_impacts, least=2, most=MOST), help=said)
    said = (
        "instead of the card, time, approach, speed, force and energies of N impacts under it, one after the "
        "other in the same place, as CSV"
    )
    one_place = partial(_impacts, least=1, most=MOST_IN_ONE_PLACE)
    many.add_argument("--course", metavar="N", type=one_place, help=said)
    format_argument(parser, "text", "markdown", "json")
    keeping_arguments(parser)


def _impacts(text: str, least: int, most: int) -> int:
    """Read how many impacts there shall be, for argparse."""
    number = count(text)
    if not least <= number <= most:
        raise argparse.ArgumentTypeError(f"not from {least} to {most} impacts: '{text}'")
    return number


def run(options: argparse.Namespace) -> int:
    """Print a card, a list of the codes, or the identified law; exit code 1 if the data are at fault."""
    from ..impacts.codes import CODES
    from ..impacts.source import SOURCES
    from ..messages.errors import UsageError, diagnose, listing, suggest, wrong

    if options.code == "list":
        named = [name for name in _OF_A_CARD if getattr(options, name) is not None]
        if named:
            raise wrong(f"--{named[0]} says nothing without a code", "name one in --for CODE")
        titles = [(code.name, code.title) for code in CODES.values()]
        titles += [(name, source.said) for name, source in SOURCES.items()]
        if options.folder is not None:
            with studied(options.folder) as study:
                titles += [(model.name, model.title) for model in study.inputs.workbook.models]
        print(*(f"{name:14} {title}" for name, title in titles), sep="\n")
        return OK
    with studied(options.folder) as study:
        asked = {"code": [*CODES, *SOURCES, *_models(study)], "model": _models(study)}
        for kind, known in asked.items():
            text = getattr(options, kind)
            if text is not None and text not in known:
                hint, allowed = suggest(text, known), listing(known, most=20) or "none in this folder"
                raise UsageError(diagnose("LS604", kind=kind, text=text, known=allowed, suggestion=hint))
        names = ("code", "model", "speed", "E", "nu", "R", "format", "sweep", "course")
        parts = [f"{name} {getattr(options, name)!r}" for name in names]
        # What is found names its place, and so the folder as it is written here.
        made, found = study.kept("card", lambda: _told(study, options), *parts, str(study.folder))
    for finding in found:  # first: who reads the card may close the pipe before its end
        print(finding, file=sys.stderr)
    print(made)
    return FINDINGS if found else OK


def _models(study: Study) -> list[str]:
    """The names of the contact models that the workbook of a folder has."""
    return [model.name for model in study.inputs.workbook.models]


def _told(study: Study, options: argparse.Namespace) -> tuple[str, list[str]]:
    """The card, and what is found wrong with the data that it is made from."""
    report = study.computed
    return _made(study, report, options), told(odd for odd in report.oddities if not odd.passed)


def _made(study: Study, report: Report, options: argparse.Namespace) -> str:
    from ..cards import (
        Asked,
        NoImpacts,
        NotTogether,
        card,
        contacts_of,
        course,
        drop_at,
        drops_of,
        swept,
        taken,
    )
    from ..impacts.card import Unreachable
    from ..impacts.codes import CODES
    from ..impacts.source import SOURCES
    from ..messages.errors import UsageError, diagnose, listing, wrong
    from ..views.card import FORMATS
    from ..views.checks import lines

    try:
        drops = drops_of(report)
    except NoImpacts as error:
        title = f"the report '{report.title}'"
        raise UsageError(diagnose("LS624", text=title, reason=error)) from error
    left_out = taken(report, drops)
    if options.code in SOURCES:
        return _law(study, report, drops, options, [*lines(report.oddities), *left_out])
    if options.model is not None:
        raise wrong(f"--model says nothing to --for {options.code}", f"--for {listing(SOURCES)}")
    code = CODES[options.code] if options.code in CODES else contacts_of(report)[options.code]
    for name in ("sweep", "course"):
        if getattr(options, name) is not None and options.format != "text":
            raise wrong(f"--format {options.format} says nothing to --{name}", "leave --format out")
    try:
        asked = Asked("--", **{name: _read(options, name) for name in _NUMBERS})
        asked.check([code], drops)
        drop = drop_at(drops, asked)
        study.step("solving for the parameters")
        if options.sweep is not None:
            return swept(code, drops, drop, asked, options.sweep, study.step)
        if options.course is not None:
            return course(code, drops, drop, asked, options.course)
        made = card(code, drops, drop, report.title, asked)
    except NotTogether as error:
        raise wrong(error.reason, error.known) from error
    except Unreachable as error:
        raise UsageError(diagnose("LS625", text=code.title, reason=error)) from error
    return FORMATS[options.format](replace(made, notes=(*made.notes, *left_out), oddities=report.oddities))


def _law(study: Study, report: Report, drops: Drops, options: argparse.Namespace, remarks: list[str]) -> str:
    """The identified law itself, or that of a contact model."""
    from ..cards import Asked, NotTogether, contacts_of, course, drop_at, swept
    from ..impacts.card import Unreachable
    from ..impacts.source import SOURCES, identified, modelled
    from ..messages.errors import UsageError, diagnose, wrong

    names = [name for name in ("E", "nu", "R") if getattr(options, name) is not None]
    at_speed = options.code == "table" or options.model is not None
    names += ["speed"] if options.speed is not None and not at_speed else []
    names += ["format"] if options.format != "text" else []
    table = options.code == "table"
    names += [name for name in ("sweep", "course") if getattr(options, name) is not None and not table]
    if names:
        raise wrong(f"--{names[0]} says nothing to --for {options.code}", f"leave --{names[0]} out")
    model = None if options.model is None else contacts_of(report)[options.model]
    if model is None and not drops.has_curve:
        raise UsageError(diagnose("LS624", text="the folder", reason="no loading curve was found"))
    try:
        drop = drop_at(drops, Asked("--", _read(options, "speed")))
    except NotTogether as error:
        raise wrong(error.reason, error.known) from error
    try:
        if options.sweep is not None:
            return swept(model, drops, drop, Asked(), options.sweep, study.step)
        if options.course is not None:
            return course(model, drops, drop, Asked(), options.course)
        written = identified(drops, drop) if model is None else modelled(model, drops, drop)
    except Unreachable as error:
        raise UsageError(diagnose("LS625", text=options.model, reason=error)) from error
    return SOURCES[options.code].of(written, remarks)


def _read(options: argparse.Namespace, name: str) -> float | None:
    """Read the number of an option, in SI; None if it was not given."""
    from ..inputs.cards import NUMBERS
    from ..inputs.planned import read_numbers
    from ..messages.errors import wrong

    text = getattr(options, name)
    if text is None:
        return None
    found = read_numbers(text, f"--{name}", ";", NUMBERS[name], _NUMBERS[name])
    if len(found) != 1:
        raise wrong(f"--{name} '{text}' is not one number", f"--{name} '1 {NUMBERS[name].unit}'")
    return found[0]
