"""`diff`: two results, number by number."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from .common import FINDINGS, OK, count, format_argument, named, told

if TYPE_CHECKING:
    from ..files.values import Result

HELP = "compare two results number by number"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    for name in ("before", "after"):
        parser.add_argument(
            name, metavar=name.upper(), type=named, help="what 'build' wrote, its values.json, or its FOLDER"
        )
    parser.add_argument(
        "--most", metavar="N", type=count, default=20, help="how many are named of each kind (default: 20)"
    )
    format_argument(parser, "text", "markdown")


def run(options: argparse.Namespace) -> int:
    """Print what is different; exit code 1 if anything is, beyond rounding."""
    from ..archive.differences import compare
    from ..files.values import NAME
    from ..inputs.folders import is_report, result
    from ..outdated import outdated
    from ..views.differences import FORMATS

    before, after = (
        path / NAME if path.is_dir() else path for path in map(result, (options.before, options.after))
    )
    names = before.as_posix(), after.as_posix()
    found = compare(_as_built(before), _as_built(after), names=names)
    print(FORMATS[options.format](found, options.most), end="")
    for word in (options.before, options.after):
        for line in told(tuple(outdated(Path(word), ()))) if is_report(Path(word)) else ():
            print(line, file=sys.stderr)
    return FINDINGS if found.any else OK


def _as_built(file: Path) -> Result:
    """A result, refused if it was changed after it was built."""
    from ..files.manifest import is_as_built
    from ..files.values import read_result
    from ..messages.errors import InputError, Location, diagnose

    found = read_result(file)
    if not is_as_built(file, file.read_bytes()):
        reason = "it was changed after it was built: the manifest beside it has another fingerprint"
        raise InputError(diagnose("LS607", Location(file.as_posix()), text=file.name, reason=reason))
    return found
