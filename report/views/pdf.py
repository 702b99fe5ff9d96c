"""report.pdf: TeX makes it where it can neither read nor write outside the folder nor start a program."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

from ..machine.programs import ProgramFailed, run
from ..messages.errors import LoopsheetError, diagnose
from . import latex
from .issued import Issued

PACKAGES = "latexmk texlive-latex-extra texlive-science texlive-fonts-recommended lmodern"
"""What Debian and Ubuntu call what is needed."""
_PATIENCE = 300
"""Seconds that TeX may take."""
_ROOM = 2_000_000
"""Bytes that a report.pdf may need."""


class TexMissing(LoopsheetError):
    """There is no TeX on this machine."""


class TexFailed(RuntimeError):
    """TeX could not print the report: that is our bug, for everything foreign was escaped."""


def write(made: Issued, stage: Path) -> None:
    """Write report.tex beside its figures, and report.pdf of them."""
    latex.write(made, stage)
    compile(stage)


def compile(folder: Path) -> None:
    """Make report.pdf of report.tex with latexmk.

    Parameters
    ----------
    folder : Path
        It holds report.tex and its figures; of what TeX writes only report.pdf is left in it.

    Raises
    ------
    TexMissing
        There is no latexmk or no pdflatex.
    TexFailed
        TeX stopped; the message holds the lines of its log that say why.
    """
    for program in ("latexmk", "pdflatex"):
        if shutil.which(program) is None:
            raise TexMissing(
                diagnose("LS605", kind="--to pdf", text=program, known=f"TeX: apt-get install {PACKAGES}")
            )
    safe = {
        "openin_any": "p",
        "openout_any": "p",
        "SOURCE_DATE_EPOCH": "0",
        "FORCE_SOURCE_DATE": "1",
        "TZ": "UTC",
        "max_print_line": "10000",
    }
    before = set(folder.iterdir())
    options = ["-pdf", "-norc", "-interaction=nonstopmode", "-halt-on-error", "-file-line-error"]
    command = ["latexmk", *options, "-pdflatex=pdflatex -no-shell-escape %O %S", "report.tex"]
    try:
        run(command, _PATIENCE, folder=folder, environment={**os.environ, **safe})
        failed = not (folder / "report.pdf").is_file()
    except ProgramFailed:
        failed = True
    log = folder / "report.log"
    said = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
    for path in set(folder.iterdir()) - before:
        if path.name != "report.pdf" and path.is_file():
            path.unlink()
    if failed:
        (folder / "report.log").write_bytes(b" " * _ROOM)  # TeX does not say that the disk is full: this does
        (folder / "report.log").unlink()
        raise TexFailed(f"TeX could not print report.tex: {_complaint(said)}")


def _complaint(log: str) -> str:
    """The lines of a log that say what went wrong."""
    lines = log.splitlines()
    for place, line in enumerate(lines):
        if line.startswith("!") or re.match(r"\S+\.tex:\d+: ", line):
            return " ".join(part.strip() for part in lines[place : place + 3])
    missing = next((line for line in lines if "not found" in line), "")
    return missing or "TeX wrote no log"
