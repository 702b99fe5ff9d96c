"""`why`: where one number comes from."""

from __future__ import annotations

import argparse
import sys

from .common import OK, Progress, find, folder_argument

HELP = "tell where one number comes from and what is computed from it"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    parser.add_argument("cell", metavar="CELL", help="alpha[1-2], x_m[3] or alpha_mean")
    folder_argument(parser)


def run(options: argparse.Namespace) -> int:
    """Print what the formula bar of the page tells of a cell."""
    from .. import build
    from ..errors import UsageError, diagnose, listing
    from ..folders import report_folder
    from ..views.why import why

    with Progress(sys.stderr) as progress:
        report = build.compute(report_folder(options.folder), progress)
    column, labels = find(report, options.cell)
    if len(labels) != 1:
        known = listing(report.values.cell(column.name, label).address for label in labels)
        raise UsageError(diagnose("LS604", kind="single cell", text=options.cell, known=known, suggestion=""))
    print(why(report, column.name, labels[0]))
    return OK
