"""`crate`: make an output folder an RO-Crate."""

from __future__ import annotations

import argparse

from .common import OK, result_argument, say, source_argument

HELP = "make an output folder an RO-Crate with its inputs, to be archived"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    result_argument(parser)
    source_argument(parser)
    parser.add_argument("--date", metavar="YYYY-MM-DD", required=True, help="the day of publication")
    parser.add_argument(
        "--license",
        metavar="LICENSE",
        required=True,
        help="SPDX's identifier, such as CC-BY-4.0, or an address",
    )
    who = "; NAME or 'NAME <https://...>'"
    parser.add_argument("--author", metavar="NAME", default="", help=f"whose it is{who}")
    parser.add_argument("--organization", metavar="NAME", default="", help=f"who publishes it{who}")


def run(options: argparse.Namespace) -> int:
    """Write ro-crate-metadata.json and name it."""
    from ..archive.crate import write
    from ..inputs.folders import report_folder, result

    folder = report_folder(options.folder) if options.folder else None
    whose = options.author, options.organization
    say(str(write(result(options.out), options.date, options.license, *whose, folder)))
    return OK
