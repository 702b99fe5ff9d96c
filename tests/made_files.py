"""What stands in a folder that was written: every file's content, and what pdflatex says of an article."""

import hashlib
import subprocess
from pathlib import Path

from loopsheet.report.inputs.folders import PAPER

COMPLAINTS = r"^!|Overfull|undefined|multiply defined|Missing character"


def hashes(folder: Path) -> dict[str, str]:
    """Every file's content, by its relative name."""
    return {
        p.relative_to(folder).as_posix(): hashlib.sha256(p.read_bytes()).hexdigest()
        for p in sorted(folder.rglob("*"))
        if p.is_file()
    }


def without_a_root(folder: Path) -> Path:
    """The paper, unpublished, with a depth for which an equation has no root."""
    for name in ("report.toml", "measurements.csv"):
        text = (PAPER / name).read_text(encoding="utf-8").replace("29.7", "19.7")
        (folder / name).write_text(text.partition("[published]")[0], encoding="utf-8")
    return folder


def log_of_latex(folder: Path) -> str:
    """Run pdflatex by hand: `compile` leaves no log."""
    for _ in range(3):
        subprocess.run(
            ["pdflatex", "-no-shell-escape", "-interaction=nonstopmode", "report.tex"],
            cwd=folder, capture_output=True, check=False, timeout=120,
        )  # fmt: skip
    return (folder / "report.log").read_text(encoding="latin-1")
