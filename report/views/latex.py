r"""The report as a LaTeX article.

Nothing foreign reaches TeX unescaped: the title may well be ``\input{/etc/passwd}``.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from pathlib import Path

from markupsafe import Markup

from ...derivations.equation import Equation
from ...derivations.unit_text import is_pure
from ..document.material import Material
from ..document.names import Terms
from ..document.parts import Item
from ..document.tree import Display, Entry, Math, Number, Refer, Silent, Table, TableColumn, Unit
from ..machine.staging import put
from ..result.result import Report
from .escape import tex
from .issued import Issued
from .typeset import TEXT_WIDTH, block
from .units import unit_tex
from .writer import Writer

DAGGER = r"\textsuperscript{\textdagger}"
"""What stands behind a number that lies outside of what is expected."""
_MARKED = 0.82
"""From this part of the line's width on, an equation is shrunk where it turns out to be too wide."""


class LatexWriter(Writer):
    """Prints a document in LaTeX."""

    macros = "latex/blocks.j2"
    dagger = Markup(DAGGER)

    def escape(self, text: object) -> Markup:
        """Plain text."""
        return tex(text)

    def math(self, node: Math) -> Markup:
        """A formula in running text."""
        return Markup(f"${node.latex}$")

    def number(self, node: Number) -> Markup:
        """A number."""
        plain = None if node.text else self.plain(node)
        return tex(node.text) if plain is None else Markup(rf"\num{{{plain}}}")

    @staticmethod
    def plain(node: Number) -> str | None:
        """A number as siunitx reads it."""
        figure = node.figure
        if figure is None:
            return None
        plus = node.signed and not figure.negative and int(figure.whole + figure.fraction)
        return f"+{figure.plain}" if plus else figure.plain

    def unit(self, node: Unit) -> Markup:
        """A unit; nothing for a pure number."""
        return Markup("") if is_pure(node.unit) else unit_tex(node.unit, self.exponents)

    def label(self, label: str) -> str:
        """What a reference to an equation is called."""
        return self.material.identifiers[label].replace("eq-", "eq:", 1)

    def refer(self, node: Refer) -> Markup:
        """A reference to an equation; to the first of a group, if that is what is meant."""
        known = any(equation.label == node.label for equation in self.material.equations)
        if known:
            return Markup(rf"\ref{{{self.label(node.label)}}}")
        return Markup(rf"\hyperref[{self.label(node.label)}]{{{tex(node.label)}}}")

    def display(self, node: Display) -> Markup:
        """A displayed equation; one with a number stands where it is shown first."""
        label = node.equation.label
        if not node.numbered:
            return self.displayed(node.equation, r"\notag")
        if not self.first(label):
            return Markup("")
        return self.displayed(node.equation, rf"\tag*{{{tex(label)}}}\label{{{self.label(label)}}}")

    def numbered(self, equation: Equation) -> Markup:
        """A displayed equation with its number, for a template."""
        return self.display(Display(equation, numbered=True))

    def reference(self, label: str) -> Markup:
        """A reference from a template."""
        return self.refer(Refer(label))

    def unit_of(self, item: Item) -> Markup:
        """The unit behind a cell's number; nothing for a pure one, and behind a code."""
        return self(Unit(item.head.unit)) if item.ok else Markup("")

    def shown(self, label: str) -> bool:
        """Whether an equation stands somewhere above."""
        return label in self._used

    def displayed(self, equation: Equation, number: str) -> Markup:
        """A displayed equation; one that may be too wide is shrunk to the line if it is."""
        return self.lines(self.material.written(equation).sides, number)

    def lines(self, sides: Sequence[Terms], number: str = r"\notag") -> Markup:
        """The sides of an equation on lines of their own."""
        lines = block(sides)
        body = lines.aligned
        if lines.width > _MARKED * TEXT_WIDTH:
            body = rf"\adjustbox{{max width=0.9\linewidth}}{{$\displaystyle {body}$}}"
        if number == r"\notag":
            return Markup(f"\\begin{{equation*}}\n{body}\n\\end{{equation*}}\n")
        return Markup(f"\\begin{{equation}}\n{body}\n{number}\n\\end{{equation}}\n")

    def quantity(self, item: Item) -> Markup:
        """A cell's number, or the code of its error; a mark behind it."""
        return super().quantity(item) + Markup(DAGGER if item.mark else "")

    # --- tables

    def columns(self, table: Table) -> Markup:
        """What the columns of a table are to LaTeX: aligned numbers, words that are broken, or neither."""
        return Markup("".join(map(_column, table.columns)))

    def entry(self, column: TableColumn, entry: Entry) -> Markup:
        """What stands in a cell; among numbers that are aligned, what is none goes in braces."""
        if isinstance(entry, Silent):
            return Markup(rf"{{\color{{gray}}{tex(entry.text)}}}")
        if isinstance(entry, Item):
            if not column.form:
                return self.quantity(entry)
            if entry.figure is None:
                return Markup(rf"{{{self.quantity(entry)}}}")
            return Markup(entry.figure.plain + (rf"{{{DAGGER}}}" if entry.mark else ""))
        plain = self.plain(entry[0]) if len(entry) == 1 and isinstance(entry[0], Number) else None
        if not column.form:
            return self(entry)
        return Markup(rf"{{{self(entry)}}}" if plain is None else plain)


def _column(column: TableColumn) -> str:
    if column.form:
        return f"S[table-format={column.form}]"
    if column.share:
        return rf">{{\raggedright\arraybackslash}}p{{{column.share}\linewidth}}"
    return "r" if column.kind == "number" else "l"


def render(report: Report, figures: Collection[str]) -> str:
    """Print a report as LaTeX.

    `figures`: names of the figures that are there as ``figures/NAME.pdf``.
    """
    material = Material(report)
    pictures = {figure.name: figure for figure in material.figures if figure.name in figures}
    writer = LatexWriter(material, pictures)
    body = str(writer(writer.sections))
    # Blank lines are paragraphs in TeX; those that templates leave behind are one.
    body = re.sub(r"\n[ \t]*(?:\n[ \t]*)+\n", "\n\n", body)
    # A displayed equation belongs to the paragraph before it, and may not part from it.
    body = re.sub(r"\n\s*\n(?=\\begin\{equation)", "\n", body)
    return writer.render("latex/article.j2", body=Markup(body))


def write(made: Issued, stage: Path) -> None:
    """Write report.tex beside its figures."""
    put(stage / "report.tex", render(made.report, made.figures("pdf")))
