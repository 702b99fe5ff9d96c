r"""The report as a LaTeX article, and its PDF.

Nothing foreign reaches TeX unescaped, and TeX is run where it can neither read nor write outside the
folder nor start a program: the title may well be ``\input{/etc/passwd}``.
"""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Collection
from functools import cached_property
from pathlib import Path

from ...derivations.equation import Equation
from ..errors import LoopsheetError, diagnose
from ..programs import ProgramFailed, run
from ..result import Report
from .document import Document
from .escape import Markup, tex, tex_finalize
from .numbers import Figure, is_pure, table_format, unit_tex
from .parts import Head, Item
from .typeset import TEXT_WIDTH, Block
from .words import Words, environment

__all__ = ["TexFailed", "TexMissing", "compile", "render"]

PACKAGES = "latexmk texlive-latex-extra texlive-science texlive-fonts-recommended lmodern"
"""What Debian and Ubuntu call what is needed."""
DAGGER = r"\textsuperscript{\textdagger}"
"""What stands behind a number that lies outside of what is expected."""
_PATIENCE = 300
"""Seconds that TeX may take."""
_ROOM = 2_000_000
"""Bytes that a report.pdf may need."""
_MARKED = 0.82
"""From this part of the line's width on, an equation is shrunk where it turns out to be too wide."""


class TexMissing(LoopsheetError):
    """There is no TeX on this machine."""


class TexFailed(RuntimeError):
    """TeX could not print the report: that is our bug, for everything foreign was escaped."""


class LatexWords(Words):
    """What templates call to print something in LaTeX."""

    def escape(self, text: object) -> Markup:
        """Plain text."""
        return tex(text)

    def math(self, latex: str) -> Markup:
        """A formula in running text."""
        return Markup(f"${latex}$")

    def number(self, figure: Figure) -> Markup:
        """A number."""
        return Markup(figure.tex)

    def signed(self, figure: Figure) -> Markup:
        """A difference: with its sign, be it a plus."""
        zero = not int(figure.whole + figure.fraction)
        return Markup(figure.tex if figure.negative or zero else figure.tex.replace("{", "{+", 1))

    @cached_property
    def _exponents(self) -> dict[str, str]:
        return self.exponents()

    def unit(self, unit: str) -> Markup:
        """A unit; nothing for a pure number."""
        return Markup("") if is_pure(unit) else unit_tex(unit, self._exponents)

    def label(self, label: str) -> str:
        """What a reference to an equation is called."""
        return self.document.identifiers[label].replace("eq-", "eq:", 1)

    def refer(self, label: str) -> Markup:
        """A reference to an equation; to the first of a group, if that is what is meant."""
        known = any(equation.label == label for equation in self.document.equations)
        if known:
            return Markup(rf"\ref{{{self.label(label)}}}")
        return Markup(rf"\hyperref[{self.label(label)}]{{{tex(label)}}}")

    def equation(self, label: str) -> Markup:
        """A displayed equation with its number; it is labelled where it stands first."""
        equation = self.document.equation(label)
        number = tex(label)
        anchor = rf"\label{{{self.label(label)}}}" if self.first(label) else ""
        return _display(self.document.block(equation), rf"\tag*{{{number}}}{anchor}")

    def shown(self, label: str) -> bool:
        """Whether an equation stands somewhere above."""
        return label in self._used

    def claim(self, equation: Equation) -> Markup:
        """A displayed equation of a derivation, which is none of the ledger."""
        return _display(self.document.block(equation), r"\notag")

    def cell(self, item: Item) -> Markup:
        """A cell of a column that aligns numbers: what is no number goes in braces."""
        if item.figure is None:
            return Markup(rf"{{{tex(item.printed or item.code)}}}")
        return Markup(item.figure.plain + (rf"{{{DAGGER}}}" if item.mark else ""))

    dagger = Markup(DAGGER)

    def quantity(self, item: Item) -> Markup:
        """A cell's number with its unit, or the code of its error; a mark behind it."""
        return super().quantity(item) + Markup(DAGGER if item.mark else "")

    def columns(self, heads: tuple[Head, ...]) -> Markup:
        """The columns of a table, each as wide as its numbers."""
        return Markup("".join(f"S[table-format={head.format}]" for head in heads))

    def format(self, figures: list[Figure | None], signed: bool = False) -> Markup:
        """The ``table-format`` of some numbers."""
        form = table_format(figures)
        return Markup(f"-{form}" if signed and not form.startswith("-") else form)

    def plain(self, figure: Figure | None, text: str = "") -> Markup:
        """A number for a column that aligns them, or a text in braces."""
        return Markup(rf"{{{tex(text)}}}" if figure is None else figure.plain)

    def signed_plain(self, figure: Figure) -> Markup:
        """A difference for a column that aligns numbers."""
        zero = not int(figure.whole + figure.fraction)
        return Markup(figure.plain if figure.negative or zero else f"+{figure.plain}")


def _display(block: Block, number: str) -> Markup:
    """A displayed equation; one that may be too wide is shrunk to the line if it is."""
    body = block.aligned
    if block.width > _MARKED * TEXT_WIDTH:
        body = rf"\adjustbox{{max width=0.9\linewidth}}{{$\displaystyle {body}$}}"
    if number == r"\notag":
        return Markup(f"\\begin{{equation*}}\n{body}\n\\end{{equation*}}")
    return Markup(f"\\begin{{equation}}\n{body}\n{number}\n\\end{{equation}}")


def render(report: Report, figures: Collection[str]) -> str:
    """Print a report as LaTeX.

    Parameters
    ----------
    report : Report
    figures : collection of str
        Names of the figures that are there as ``figures/NAME.pdf``.
    """
    document = Document(report)
    words = LatexWords(document)
    pictures = {figure.name: figure for figure in document.figures if figure.name in figures}
    jinja = environment(tex_finalize)
    context = {
        "report": report,
        "doc": document,
        "w": words,
        "figures": pictures,
        "macros": "latex/macros.j2",
    }
    body = jinja.get_template(f"prose/{report.workbook.prose}.j2").render(context)
    # Blank lines are paragraphs in TeX; those that templates leave behind are one.
    body = re.sub(r"\n[ \t]*(?:\n[ \t]*)+\n", "\n\n", body)
    # A displayed equation belongs to the paragraph before it, and may not part from it.
    body = re.sub(r"\n\s*\n(?=\\begin\{equation)", "\n", body)
    return jinja.get_template("latex/article.j2").render(context, body=Markup(body))


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
