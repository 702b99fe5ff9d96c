"""`new`: a folder to start a campaign from."""

from __future__ import annotations

import argparse
from pathlib import Path

from .common import OK, named

HELP = "make a folder to start a campaign from"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    parser.add_argument("folder", metavar="FOLDER", type=named)
    parser.add_argument(
        "--workbook", metavar="NAME", default="soft_impact", help="the method (default: soft_impact)"
    )
    parser.add_argument(
        "--ci", metavar="SERVICE", default="", help="also write what makes it check every change: github"
    )


def run(options: argparse.Namespace) -> int:
    """Write the folder and name its files."""
    from ..archive import scaffold
    from ..inputs.folders import written
    from ..messages.errors import UnknownWorkbook, UsageError, diagnose, listing, suggest
    from ..which_workbook import find_workbook
    from ..workbooks import SHIPPED

    try:
        workbook = find_workbook(options.workbook, Path())
    except UnknownWorkbook as error:
        known, hint = listing(SHIPPED), suggest(options.workbook, SHIPPED)
        raise UsageError(
            diagnose("LS604", kind="workbook", text=options.workbook, known=known, suggestion=hint)
        ) from error
    if options.ci and options.ci not in scaffold.CI:
        known, hint = listing(scaffold.CI), suggest(options.ci, scaffold.CI)
        raise UsageError(diagnose("LS604", kind="service", text=options.ci, known=known, suggestion=hint))
    folder = Path(options.folder)
    for path in scaffold.new(folder, workbook, options.ci):
        print(path)
    if options.ci and scaffold.repository(folder) is None:
        print(f"{options.ci} reads the last one once {folder} is the root of a repository")
    print(f"edit them, then: loopsheet build {written(folder)}")
    return OK
