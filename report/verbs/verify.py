"""`verify`: build a report again and say what is not as it was."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from .common import Progress, count, format_argument, outcome, print_checks, result_argument, source_argument

if TYPE_CHECKING:
    from ..verification import Verification

HELP = "build a report again and say what is not as it was, and why"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    result_argument(parser)
    source_argument(parser)
    parser.add_argument(
        "--most", metavar="N", type=count, default=20, help="how many are named of each kind (default: 20)"
    )
    parser.add_argument(
        "--run-workbook", action="store_true", help="run the workbook.py of FOLDER, if it has one: it is code"
    )
    format_argument(parser, "text", "json", "junit", "github", "markdown")


def run(options: argparse.Namespace) -> int:
    """Verify, and print what differs; exit code 1 if anything does."""
    from ..inputs.folders import report_folder, result
    from ..verification import verify
    from ..which_workbook import find_workbook, shipped_workbook

    folder = report_folder(options.folder) if options.folder else None
    find = find_workbook if options.run_workbook else shipped_workbook
    with Progress(sys.stderr) as progress:
        found = verify(result(options.out), folder, progress, find)
    if options.format == "text":
        _print(found, options.most)
    else:
        print_checks(found.checks, options.format, found.verdict, {})
    return outcome(found.checks)


def _print(found: Verification, most: int) -> None:
    """One line for what is the same of a kind, one for each of what is not, or is worth a word."""
    for kind in dict.fromkeys(check.kind for check in found.checks):
        own = [check for check in found.checks if check.kind == kind]
        told = [check.sentence for check in own if check.word or check.skipped]
        if len(own) > len(told):
            print(f"{kind:10} {len(own) - len(told)} the same")
        for sentence in told[:most]:
            print(f"{kind:10} {sentence}")
        if len(told) > most:
            print(f"{'':10} and {len(told) - most} more")
    if found.differences is not None:
        same, noise = found.differences.same, found.differences.noise
        print(f"{'number':10} {same} the same" + (f", {noise} within rounding" if noise else ""))
    print(found.verdict)
