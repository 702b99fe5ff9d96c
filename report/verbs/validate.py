"""`validate`: published examples computed on this machine, and a record of it for the files."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from .common import Progress, folders_argument, format_argument, named, outcome

if TYPE_CHECKING:
    from ..result.validation import Validation

HELP = "compute published examples on this machine, and write a record of it that can be filed"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    folders_argument(parser)
    format_argument(parser, "text", "markdown", "json", "junit")
    said = "write the record into this file too (ISO/IEC 17025, 7.11.2), which is new or such a record: the "
    said += "same bytes whenever it is run"
    parser.add_argument("--out", metavar="FILE", type=named, help=said)


def run(options: argparse.Namespace) -> int:
    """Print the record; exit code 1 if anything fails. Nothing that was kept before is believed."""
    from ..machine.kept import nothing_kept
    from ..machine.staging import own, written
    from ..views.validation import FORMATS, TITLE

    out, mark = options.out and Path(options.out), TITLE.encode()
    before = None if out is None else own(out, mark)
    with nothing_kept(), Progress(sys.stderr) as progress:
        record = _validation(options.folders, progress)
    told = f"{FORMATS[options.format](record).rstrip()}\n"
    if out is not None:
        written(out, before, told.encode())
    print(told, end="")
    return outcome(record.checks)


def _validation(words: list[str], progress: Progress) -> Validation:
    from ..inputs.folders import EXAMPLES, called, report_folder
    from ..machine.provenance import processor, sources, versions
    from ..result.validation import Example, Validation
    from ..study import Study

    folders = [report_folder(word) for word in words] or EXAMPLES
    examples = []
    for folder in folders:
        name = called(folder)

        def step(said: str, name: str = name) -> None:
            progress(f"{name}: {said}")

        examples.append(Example.of(name, Study(folder, step=step).report))
    made_of = {f"sources, {part}": digest for part, digest in sources().items()}
    return Validation(tuple(examples), {**versions(), **made_of, "processor": processor()})
