"""`diff`: two results, number by number."""

from __future__ import annotations

import argparse

from .common import FINDINGS, OK, count, format_argument, named

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
    from ..files.values import NAME, read_result
    from ..inputs.folders import result
    from ..views.differences import FORMATS

    before, after = (
        path / NAME if path.is_dir() else path for path in map(result, (options.before, options.after))
    )
    names = before.as_posix(), after.as_posix()
    found = compare(read_result(before), read_result(after), names=names)
    print(FORMATS[options.format](found, options.most), end="")
    return FINDINGS if found.any else OK
