"""`check`: the proofs, the engines against 50 digits, the published values."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from .common import folder_argument, format_argument, keeping_arguments, outcome, print_checks, studied, tell

if TYPE_CHECKING:
    from ..messages.diagnostics import Check
    from ..referee.accepting import Accepted
    from ..result.result import Comparison, Report

HELP = "check the proofs, the engines against each other, and the published values"

_WAYS = {
    "same": "print{} the same",
    "known": "differ{} as is known",
    "reachable": "come{} out of other inputs that print as given",
    "by printed": "come{} out of rounded numbers as they are printed",
    "within": "differ{} within the stated uncertainties alone",
    "missing": "cannot be checked",
    "rest": "differ{} otherwise",
}
"""How published values stand beside what is recomputed: what is told of those of each way."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    folder_argument(parser)
    format_argument(parser, "text", "json", "junit", "github", "markdown")
    parser.add_argument(
        "--accept",
        action="store_true",
        help="check published values and data alone, and write what is recomputed into published.csv "
        "for those that have a reason to differ",
    )
    parser.add_argument(
        "--reason", metavar="TEXT", default="", help="with --accept: why they differ, where that is not said"
    )
    keeping_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Check everything and print it in the format that is asked for."""
    from ..outdated import outdated
    from ..result.findings import checks

    if options.accept or options.reason:
        return _accept(options)
    with studied(options.folder) as study:
        report = study.report
    found = (*checks(report), *outdated(report.inputs.folder, report.inputs.files))
    if options.format == "text":
        _print(report, found)
    else:
        print_checks(found, options.format, report.title, _details(report))
    return outcome(found)


def _accept(options: argparse.Namespace) -> int:
    """Write the known differences of a folder, show what was written, and print what is left to find."""
    from ..inputs.folders import PAPER, report_folder
    from ..machine.staging import replaced
    from ..messages.errors import wrong
    from ..referee.accepting import accepted
    from ..result.findings import checks

    reason, folder = " ".join(options.reason.split()), report_folder(options.folder)
    if not options.accept or folder == PAPER or not reason.isprintable():
        known = "loopsheet check --accept --reason 'a sentence' FOLDER"
        said = "--accept needs a FOLDER of your own, --reason a sentence and --accept"
        raise wrong(said, known)
    with studied(options.folder) as study:
        report = study.refereed
    if report.every_comparison:
        found = accepted(report, reason)
        if found.after != found.before:
            replaced(found.path, found.before, found.after)
            with studied(options.folder) as study:
                report = study.refereed
        if options.format == "text":
            _show(found)
            _ask(report)
    left = checks(report)
    if options.format == "text":
        tell(left)
    else:
        print_checks(left, options.format, report.title, {})
    return outcome(left)


def _show(found: Accepted) -> None:
    from ..messages.diagnostics import visible

    number = len(found.changes)
    changed = "1 line" if number == 1 else f"{number or 'no'} lines"
    print(f"{visible(found.path.as_posix())}: {changed} changed")
    for change in found.changes:
        width = len(str(change.line))
        print(f"  {change.line} - {visible(change.before)}")
        print(f"  {' ' * width} + {visible(change.after)}")
    if found.others:
        print(f"  {found.others} more got an empty field")


def _ask(report: Report) -> None:
    """What was not written, for nobody said why it differs."""
    from ..result.verdict import UNEXPECTED

    number = sum(each.finding == UNEXPECTED and not each.published.expect for each in report.every_comparison)
    if number:
        values = "1 more value differs and is" if number == 1 else f"{number} more values differ and are"
        print(f"{values} not written: say why, with --reason 'a sentence' or in the column 'reason'")


def _print(report: Report, found: Sequence[Check]) -> None:
    from ..result.verdict_words import lines

    passed = sum(p.status.passes for p in report.proofs)
    print(f"proofs     {passed} of {len(report.proofs)} equations stand")
    for erratum in report.errata:
        print(f"  erratum  {erratum.sentence}")
    for agreement in report.engines:
        print(f"engine     {agreement.line}")
    every = report.every_comparison
    if every:
        ways = Counter(map(_way, every))
        said = [
            f"{ways[way]} {text.format('s' * (ways[way] == 1))}"
            for way, text in _WAYS.items()
            if ways[way] or way in ("same", "known")
        ]
        if nought := sum(c.verdict == "same" and c.says_nothing for c in every):
            said[0] += f" ({nought} as 0, which says little of a value)"
        print(f"published  {len(every)} value{'s' * (len(every) != 1)}: {', '.join(said)}")
    for comparison in every:
        if comparison.verdict != "same":
            where = f"{comparison.published.source} {comparison.cell.address}"
            printed, reason = comparison.published.printed.text, comparison.published.reason
            print(f"  {where:28} {printed:>8} -> {comparison.again:>8}  {comparison.word:13} {reason}")
    for line in lines(report.referee, lambda name: report.sheet[name].meaning):
        print(line)
    tell(map(_shortly, found))
    failed, warned = (sum(check.word == word for check in found) for word in ("finding", "warning"))
    number = f"{failed or 'no'} finding{'s' * (failed != 1)}"
    told = f"{number}, {warned} warning{'s' * (warned != 1)}" if warned else number
    print(told if failed or warned else "everything as expected")


def _way(each: Comparison) -> str:
    """How a published value stands beside what is recomputed, a key of :data:`_WAYS`."""
    from ..result.verdict import REACHABLE, WITHIN

    if each.verdict == "same":
        return "same"
    if each.published.expect:
        return "known" if each.as_expected else "rest"
    if each.verdict == "not-checkable":
        return "missing"
    if each.word == WITHIN:
        return "within"
    if not each.as_expected:
        return "rest"
    return "reachable" if each.word == REACHABLE else "by printed"


def _shortly(check: Check) -> Check:
    """What the referee says of tables stands above already."""
    from ..result.findings import MISPRINTS

    if check.kind != "table" or check.name == MISPRINTS:
        return check
    said = f"{check.name}: does not come out of one input that prints as given, as the referee says above"
    return replace(check, message=said)


def _details(report: Report) -> dict[str, Any]:
    """What JSON tells besides the checks: numbers instead of sentences."""
    from msgspec import to_builtins

    from ..result.verdict_data import data
    from ..views.json import proof_grounds

    return {
        "proofs": {p.equation.label: p.status.value for p in report.proofs},
        "rests_on": proof_grounds(report),
        "engines": [agreement.data for agreement in report.engines],
        "published": [
            {
                "source": c.published.source,
                "cell": c.cell.address,
                "printed": c.published.printed.text,
                "again": c.again,
                "verdict": c.word,
                "expected": c.as_expected,
                "finding": c.finding or None,
            }
            for c in report.every_comparison
        ],
        "referee": to_builtins(data(report.referee)),
    }
