"""The report as one HTML page: nothing loaded, everything in the file; with a program it recalculates."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Mapping
from functools import cached_property
from typing import Any

from ...derivations.equation import Equation
from ..result import Report
from ..values import Cell
from . import live
from .compact import short_markup, short_mathml, short_style
from .compact_svg import inlined
from .document import Document
from .escape import Markup, html, html_finalize
from .numbers import Figure, is_pure, unit_html
from .parts import Item, address
from .typeset import mathml, mathml_block
from .words import TEMPLATES, Words, environment

__all__ = ["csp", "render"]


class HtmlWords(Words):
    """What templates call to print something in HTML."""

    def escape(self, text: object) -> Markup:
        """Plain text."""
        return html(text)

    def math(self, latex: str) -> Markup:
        """A formula in running text."""
        return mathml(latex)

    def number(self, figure: Figure) -> Markup:
        """A number."""
        return html(figure.text)

    def signed(self, figure: Figure) -> Markup:
        """A difference: with its sign, be it a plus."""
        zero = not int(figure.whole + figure.fraction)
        return html(figure.text if figure.negative or zero else f"+{figure.text}")

    @cached_property
    def _exponents(self) -> dict[str, Markup]:
        return {name: mathml(latex) for name, latex in self.exponents().items()}

    def unit(self, unit: str) -> Markup:
        """A unit; nothing for a pure number."""
        return Markup("") if is_pure(unit) else unit_html(unit, self._exponents)

    def refer(self, label: str) -> Markup:
        """A link to an equation."""
        return Markup('<a href="#{}">{}</a>').format(self.document.identifiers[label], html(label))

    def equation(self, label: str) -> Markup:
        """A displayed equation."""
        return mathml_block(self.document.block(self.document.equation(label)))

    def data(self, item: Item, identified: bool = True) -> Markup:
        """The attributes of a cell; its identifier goes to the first element that shows it in a table."""
        name = Markup("")
        if identified and self.first(item.identifier):
            name = Markup('id="{}" ').format(item.identifier)
        mark = Markup(' data-mark="{0}" title="{0}"').format(item.mark) if item.mark else Markup("")
        return (
            name
            + Markup('data-cell="{}" data-index="{}" data-value="{}" data-status="{}"').format(
                item.cell.name, item.index, item.data, item.code
            )
            + mark
        )

    def padding(self, item: Item) -> str:
        """The classes that put the decimal sign of a cell below those above it."""
        if item.figure is None or not item.pad:
            return ""
        point = "" if item.figure.fraction else " nopoint"
        return f"p{min(item.pad, 8)}{point}"

    def why(self, cell: Cell) -> str:
        """The identifier of the sentence that says why a cell has no value."""
        return address(cell.name, cell.label).replace("cell-", "why-", 1)

    def address(self, name: str, label: tuple[int, ...]) -> str:
        """The identifier of a cell that has no value."""
        return address(name, label)

    def claim(self, equation: Equation) -> Markup:
        """A displayed equation of a derivation, which is none of the ledger."""
        return mathml_block(self.document.block(equation))


_OPENING = re.compile(r"<svg\b[^>]*>")
_SIZE = re.compile(r'\b(width|height)="([\d.]+)(pt|px|)"')


def picture(svg: str, alt: str) -> Markup:
    """An SVG as a part of the page, as large as it wants to be, and what it shows in words.

    It was drawn here: what foreign text is in it was escaped by what drew it.
    """
    said = Markup('<svg role="img" aria-label="{}"').format(html(alt))
    opening = _OPENING.search(svg)
    assert opening is not None
    attributes = _SIZE.sub(_pixels, opening.group().removeprefix("<svg"))
    return said + Markup(attributes + svg[opening.end() :])


def _pixels(found: re.Match[str]) -> str:
    return f'{found[1]}="{round(float(found[2]) * (4 / 3 if found[3] == "pt" else 1))}"'


class Count(int):
    """How many rows an axis has, or a column sums, marked where it stands so that it can follow."""

    def __new__(cls, number: int, axis: str, column: str = "") -> Count:
        made = super().__new__(cls, number)
        made.axis, made.column = axis, column
        return made

    axis: str
    column: str

    def __html__(self) -> str:
        column = Markup(' data-counted="{}"').format(self.column) if self.column else Markup()
        return str(Markup('<span data-count="{}"{}>{}</span>').format(self.axis, column, int(self)))


class Inside(str):
    """How many rows lie inside of a limit, marked where it stands so that it can follow."""

    margin: str

    def __html__(self) -> str:
        return str(Markup('<span data-inside="{}">{}</span>').format(self.margin, str(self)))


class HtmlDocument(Document):
    """A report whose counts of rows know what they count."""

    def inside(self, name: str) -> str:
        """How many cells of a column lie inside of the statement that limits them."""
        made = Inside(super().inside(name))
        made.margin = self.report.marks.limited(name).margin.column.name
        return made

    def count(self, axis: str) -> int:
        """How many rows an axis has."""
        return Count(super().count(axis), axis)

    def counted(self, name: str, axis: str) -> int:
        """Over how many rows of an axis a column sums."""
        return Count(super().counted(name, axis), axis, name)


def finalize(value: Any) -> Markup:
    """Escape whatever a template puts out, unless it is markup already."""
    return Markup(value.__html__()) if isinstance(value, (Count, Inside)) else html_finalize(value)


def csp(style: str, script: str = "") -> str:
    """The content security policy of a page with this style, this script and nothing else."""

    def hashed(text: str) -> str:
        return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"

    return (
        f"default-src 'none'; script-src {hashed(script) if script else chr(39) + 'none' + chr(39)}; "
        f"style-src {hashed(style)}; img-src data:; base-uri 'none'; form-action 'none'"
    )


def render(report: Report, figures: Mapping[str, str], program: str | None = None) -> str:
    """Print a report as HTML.

    Parameters
    ----------
    report : Report
    figures : mapping of str to str
        SVG text of each figure, by its name.
    program : str or None
        The sheet as JavaScript, for a page that recalculates itself; None makes a page without a script.
    """
    document = HtmlDocument(report)
    words = HtmlWords(document)
    shown = [figure for figure in document.figures if figure.name in figures]
    drawn, style_of_drawn = inlined({figure.name: figures[figure.name] for figure in shown})
    # Both are hashed as they stand in the page, where there are no empty lines.
    live_style = _text("html/live.css") if program is not None else ""
    style = short_style(_text("html/style.css") + style_of_drawn + live_style)
    script = "" if program is None else _squeezed(_script(report, program))
    jinja = environment(finalize)
    pictures = {figure.name: picture(drawn[figure.name], figure.alt or figure.caption) for figure in shown}
    context = {"report": report, "doc": document, "w": words, "figures": pictures, "macros": "html/macros.j2"}
    # The body comes first: the table of contents is made of the sections that it has.
    body = Markup(_BETWEEN.sub("", jinja.get_template(f"prose/{report.workbook.prose}.j2").render(context)))
    if program is not None:
        parts = tuple(live.parts(report, document))
        context["live"] = {
            "data": Markup(live.data(report, document)),
            "parts": parts,
            "script": Markup(script),
        }
    page = jinja.get_template("html/page.j2")
    whole = page.render(context, body=body, style=Markup(style), csp=Markup(csp(style, script)))
    return _squeezed(short_markup(short_mathml(whole)))


def _script(report: Report, program: str) -> str:
    return live.script(program, _text("engines/runtime.js"), bool(live.drawn(report)))


_BETWEEN = re.compile(
    r"\n+(?=</?(?:article|aside|caption|d[dlt]|details|div|fig\w+|h\d|li|[ou]l|p|section|summary|t\w+)[ >])"
)
"""Line ends at elements that begin a line of their own: no space is seen there."""


def _squeezed(text: str) -> str:
    """Text without empty lines."""
    return re.sub(r"\n{2,}", "\n", text)


def _text(name: str) -> str:
    return (TEMPLATES / name).read_text(encoding="utf-8")
