"""`schema`: the form of a file that `build` writes."""

from __future__ import annotations

import argparse

from .common import OK

HELP = "print the JSON schema of values.json or of manifest.json"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    parser.add_argument("file", metavar="FILE", choices=("values", "manifest"), help="values or manifest")


def run(options: argparse.Namespace) -> int:
    """Print it."""
    from ..files.form import schema
    from ..files.manifest import Manifest
    from ..files.values import Result

    print(schema(Result if options.file == "values" else Manifest), end="")
    return OK
