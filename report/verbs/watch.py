"""`watch`: build a report again whenever its folder is saved, and show it in the browser."""

from __future__ import annotations

import argparse
import re
import signal
import sys
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from .build import older, out_argument, out_of, summary
from .common import OK, Progress, folder_argument, keeping_arguments, say

if TYPE_CHECKING:
    from ..files.values import Result

HELP = "build a report again whenever something in its folder is saved, and show it"

PAUSE = 0.2
"""Seconds between two looks at a folder, and for which it has to be at rest: editors save in steps."""

MOST = 12
"""Of the numbers that moved, how many are named."""

_NAMED = re.compile(r"""["']([^"'\x00-\x1f]+)["']""")
"""A string of TOML, which may name a file."""
_KINDS = (".csv", ".json", ".py", ".toml")
"""What a report may be made of besides, as modules of its workbook: a log beside it is none of that."""

Look = dict[str, tuple[int, int, int]]


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what it takes."""
    folder_argument(parser)
    out_argument(parser)
    parser.add_argument("--to", metavar="FORMATS", default="html", help="as for build (default: html)")
    keeping_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Build and wait, until Ctrl-C."""
    from ..build import formats_there, parse_formats
    from ..files.values import NAME
    from ..inputs.folders import report_folder, told, written
    from ..machine.local_server import Server

    formats = parse_formats(options.to)
    folder = report_folder(options.folder)
    out = out_of(options, folder)
    issued = formats_there(out)
    try:
        with Server(out) as server:
            say(f"watching {told(folder)}; its report is at {server.address} (Ctrl-C ends)")
            _watch(folder, out / NAME, lambda: _again(folder, out, formats, server.tell))
    except KeyboardInterrupt as stopped:
        if getattr(stopped, "number", signal.SIGINT) != signal.SIGINT:
            raise
        # What told of the report before went when something changed.
        if gone := {*issued} - {*formats_there(out)}:
            there = f" --out {written(out)}" if options.out else ""
            command = f"loopsheet build {written(folder)} --to {','.join(issued)}{there}"
            say(f"'{command}' makes again what went: {', '.join(sorted(gone))}")
    return OK


def _watch(folder: Path, result: Path, build: Callable[[], Iterable[str]]) -> None:
    """Build whenever a file of the folder, or one that was read last, is another, or the result is gone.

    To the end, which is when it is stopped, or when nobody reads what it tells.
    """
    read: set[str] = set()
    seen: Look | None = None
    there = False
    while getattr(sys.stdout, "is_heard", True):
        now = _look(folder, read)
        if now == seen and result.exists() >= there:
            time.sleep(PAUSE)
            continue
        time.sleep(PAUSE)
        if now == _look(folder, read):
            read |= {*build()}
            seen = {**now, **{name: found for name, found in _look(folder, read).items() if name not in now}}
            there = result.exists()


def _look(folder: Path, names: Iterable[str]) -> Look:
    """What a report may be made of, and when it was written."""
    found: Look = {}
    files = {*names}
    with suppress(OSError, UnicodeError):
        files |= {path.name for path in folder.iterdir() if path.suffix in _KINDS}
        files |= {*_NAMED.findall((folder / "report.toml").read_text(encoding="utf-8"))}
    for name in sorted(files):
        try:
            status = (folder / name).stat()
        except OSError:
            continue  # somebody is just replacing it
        if not (folder / name).is_dir():
            found[name] = status.st_mtime_ns, status.st_size, status.st_ino
    return found


def _again(folder: Path, out: Path, formats: tuple[str, ...], tell: Callable[..., None]) -> Iterable[str]:
    """Build once more, and say what changed or what is wrong; the files that were read."""
    from ..archive.differences import compare
    from ..build import built
    from ..messages.errors import LoopsheetError, render_all
    from ..study import Study
    from ..views.differences import as_text

    before = _result(out)
    try:
        with Progress(sys.stderr) as progress:
            study = Study(folder, step=progress)
            found = built(study, out, formats, False, say, summary)
    except LoopsheetError as error:
        print(render_all(error.diagnostics), file=sys.stderr, flush=True)
        tell(error=render_all(error.diagnostics))
        return ()
    after = _result(out)
    changed = as_text(compare(before, after), MOST) if before and after else ""
    told = changed.splitlines() if changed else found.told["lines"]
    for line in (*told, *older(study)):
        print(line)
    say(f"{len(found.files)} files in {out}")
    tell(changed=changed)
    return study.files


def _result(out: Path) -> Result | None:
    """What an earlier build left, if that can be read."""
    from ..files.values import NAME, read_result
    from ..messages.errors import InputError

    try:
        return read_result(out / NAME)
    except InputError:
        return None
