"""`new`: a folder to start a campaign from."""

from __future__ import annotations

import argparse
from pathlib import Path

from .common import OK, named, say

HELP = "make a folder to start a campaign from"
METHODS = Path(__file__).resolve().parents[2] / "templates" / "methods"
"""Methods to write one's own from."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    parser.add_argument("folder", metavar="FOLDER", type=named)
    said = "the method: soft_impact (default); blank, formula, linefit, root or fit for one's own; or a file"
    parser.add_argument("--workbook", metavar="NAME", default="soft_impact", help=said)
    parser.add_argument(
        "--ci", metavar="SERVICE", default="", help="also write what makes it check every change: github"
    )


def run(options: argparse.Namespace) -> int:
    """Write the folder and name its files."""
    from ..archive import scaffold
    from ..inputs.folders import written
    from ..messages.errors import UnknownWorkbook, UsageError, diagnose, listing, unknown
    from ..which_workbook import find_workbook
    from ..workbooks import SHIPPED

    name = options.workbook
    code = next(
        (path for path in (METHODS / f"{name}.py", Path(name)) if path.suffix and path.is_file()), None
    )
    try:
        content = b"" if code is None else code.read_bytes()
        workbook = find_workbook(*((code.name, code.parent, content) if code else (name, Path())))
    except UnknownWorkbook as error:
        names = [*SHIPPED, *sorted(path.stem for path in METHODS.glob("*.py"))]
        if name.endswith(".py"):
            asked = f"the name of a file that is there, or {listing(names)}"
            reason = f"there is no such file: '{name}'"
            raise UsageError(diagnose("LS617", reason=reason, known=asked, suggestion="")) from error
        raise unknown("workbook", name, names) from error
    if options.ci and options.ci not in scaffold.CI:
        raise unknown("service", options.ci, scaffold.CI)
    folder = Path(options.folder)
    for path in scaffold.new(folder, workbook, options.ci, content):
        say(str(path))
    if options.ci and scaffold.repository(folder) is None:
        print(f"{options.ci} reads the last one once {folder} is the root of a repository")
    print(f"edit them, then: loopsheet build {written(folder)}")
    return OK
