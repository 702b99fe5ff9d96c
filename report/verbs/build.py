"""`build`: compute a report and write it."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..views import FORMATS
from .common import FINDINGS, OK, Progress, folder_argument, keeping_arguments, named, say, told

if TYPE_CHECKING:
    from ..cells.values import Cell
    from ..result.result import Report
    from ..study import Study

HELP = "compute a report and write it"


def out_argument(parser: argparse.ArgumentParser) -> None:
    """Take --out."""
    where = "where it goes (default: FOLDER/out; for the shipped paper, out)"
    parser.add_argument("--out", metavar="DIR", type=named, help=where)


def out_of(options: argparse.Namespace, folder: Path) -> Path:
    """Where the report of a folder goes, if that is asked for or not.

    Raises
    ------
    OutputError
        There are files of something else.
    """
    from ..inputs.folders import output
    from ..machine.staging import strangers
    from ..messages.errors import OutputError, diagnose, listing

    out = Path(options.out) if options.out else output(folder)
    found = strangers(out)
    if found and out.resolve() != folder.resolve():  # a folder may hold its own report
        raise OutputError(diagnose("LS626", text=out.as_posix(), known=listing(found, most=3, last="and")))
    return out


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    folder_argument(parser)
    out_argument(parser)
    parser.add_argument(
        "--to",
        metavar="FORMATS",
        help=f"{', '.join(FORMATS)}; json comes with any (default: all but pdf, which only where one "
        "was built before, and no workbook that is too large)",
    )
    parser.add_argument(
        "--engines",
        action="store_true",
        help="judge JavaScript and the workbook too, and put that into the report",
    )
    keeping_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Build, and tell the result and what is not as expected."""
    from .. import build
    from ..inputs.folders import report_folder
    from ..study import Study

    formats = None if options.to is None else build.parse_formats(options.to)
    folder = report_folder(options.folder)
    out = out_of(options, folder)
    if formats is None:
        formats = build.formats_again(out)

    with Progress(sys.stderr) as progress:
        study = Study(folder, step=progress)
        found = build.built(study, out, formats, options.engines, say, summary)
    for line in (*found.told["lines"], *older(study)):
        print(line)
    names = {path.name: path for path in found.files}
    first = next(
        names[n]
        for n in ("report.html", "report.pdf", *(file for _, file, _ in FORMATS.values()), "manifest.json")
        if n in names
    )
    say(f"{len(found.files)} files in {out}; look at {first}")
    return OK if found.told["passed"] else FINDINGS


def older(study: Study) -> list[str]:
    """What is older than its inputs of the reports that a folder takes from; asked of a kept build, too."""
    from ..outdated import outdated_sources

    return told(tuple(outdated_sources(study.folder, study.files)))


def summary(report: Report) -> dict[str, Any]:
    """What to print of a report: its result, and what is not as expected."""
    from ..result.findings import checks

    lines = [_line(report, cell) for name in report.workbook.headline for cell in report.values.cells(name)]
    lines += [
        f"{agreement.engine}: {agreement.counted}, judged at 50 digits"
        for agreement in report.engines
        if agreement.sample
    ]
    found = checks(report)
    return {"lines": [*lines, *told(found)], "passed": all(check.passed for check in found)}


def _line(report: Report, cell: Cell) -> str:
    """A headline cell in a line, with the digits that its uncertainty leaves."""
    column, name = report.sheet[cell.name], cell.name
    if cell.value is None:
        return cell.reason
    row = report.values.row(column, cell.label)
    sizes = report.values.left_out(name, row)
    left = "".join(f"  (over {n} of {size} {report.sheet.rows_of(axis)})" for n, size, axis in sizes)
    left += "".join(f"  ({count.said})" for count in report.marks.behind(column) if count.number)
    left += (mark := report.marks.of(name)[row]) and f"  {mark}"
    left += (doubt := report.uncertain().advice.get(cell.address, "")) and f"  ({doubt})"
    return f"{cell.address:12} {report.text(cell)}  {column.meaning} {column.source}{left}"
