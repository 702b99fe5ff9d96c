"""The report as one HTML page: nothing loaded, everything in the file; with a program it recalculates."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path

from markupsafe import Markup

from ...derivations.equation import Equation
from ...derivations.unit_text import is_pure
from ..cells.values import Cell
from ..document.material import Material
from ..document.names import Terms
from ..document.parts import Item, why_address
from ..document.tables import Tables
from ..document.tree import Entry, Math, Number, Refer, Silent, TableColumn, Unit
from ..machine.staging import put
from ..result.result import Report
from . import live
from .compact import short_markup, short_style
from .escape import html
from .issued import Issued
from .live_uncertain import scatters
from .mathml import mathml, mathml_block
from .typeset import block
from .units import unit_html
from .writer import TEMPLATES, Writer


class HtmlWriter(Writer):
    """Prints a document in HTML."""

    macros = "html/blocks.j2"

    def escape(self, text: object) -> Markup:
        """Plain text."""
        return html(text)

    def math(self, node: Math) -> Markup:
        """A formula in running text."""
        return mathml(node.latex)

    def places(self, node: Math) -> Markup:
        """A formula with places for numbers: of each the number, where it stands."""
        return Markup(_PLACE.sub(r"<ms>\1</ms>", str(self.math(node))))

    def number(self, node: Number) -> Markup:
        """A number."""
        figure = node.figure
        if node.text or figure is None:
            return html(node.text)
        plus = node.signed and not figure.negative and int(figure.whole + figure.fraction)
        return html(f"+{figure.text}" if plus else figure.text)

    @cached_property
    def _exponents(self) -> dict[str, Markup]:
        return {name: mathml(latex) for name, latex in self.exponents.items()}

    def unit(self, node: Unit) -> Markup:
        """A unit; nothing for a pure number."""
        return Markup("") if is_pure(node.unit) else unit_html(node.unit, self._exponents)

    def refer(self, node: Refer) -> Markup:
        """A link to an equation."""
        return Markup('<a href="#{}">{}</a>').format(self.material.identifiers[node.label], html(node.label))

    def displayed(self, equation: Equation) -> Markup:
        """An equation on lines of its own."""
        return self.lines(self.material.written(equation).sides)

    def lines(self, sides: Sequence[Terms]) -> Markup:
        """The sides of an equation on lines of their own."""
        return mathml_block(block(sides))

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
        return why_address(cell)

    def entry(self, column: TableColumn, entry: Entry) -> Markup:
        """A cell of a table: one of the sheet, or words."""
        if isinstance(entry, Item):
            return Markup(self._macros.box(entry))
        return self(entry) if isinstance(entry, Silent) else Markup(self._macros.words(column, entry))

    def unit_of(self, item: Item) -> Markup:
        """The unit that a cell is shown in; nothing for a pure number."""
        return self(Unit(item.head.unit))


_PLACE = re.compile(r"<mtext>@([0-9]+)@</mtext>")
_MEASURES = re.compile(r' (?:width|height|viewBox)="[^"]*"')
_OPENING = re.compile(r"<svg\b[^>]*>")
_STYLE = re.compile(r' style="([^"]*)"')


def picture(svg: str, alt: str) -> Markup:
    """An SVG as a part of the page, as large as it wants to be, and what it shows in words.

    It was drawn here: what foreign text is in it was escaped by what drew it.
    """
    said = Markup('<svg role="img" aria-label="{}"').format(html(alt))
    opening = _OPENING.search(svg)
    assert opening is not None
    # The sheet of the page says how the rest of it looks.
    attributes = "".join(_MEASURES.findall(opening.group()))
    return said + Markup(f"{attributes}>{svg[opening.end() :]}")


def inlined(svgs: Mapping[str, str]) -> tuple[dict[str, str], str]:
    """Pictures that stand in one page, and the style sheet that they share: each style is told once."""
    styles = dict.fromkeys(style for svg in svgs.values() for style in _STYLE.findall(svg))
    names = {style: f"s{number:x}" for number, style in enumerate(styles)}
    short = {name: _STYLE.sub(lambda found: f' class="{names[found[1]]}"', svg) for name, svg in svgs.items()}
    return short, "".join(f".{name}{{{style}}}" for style, name in names.items())


def csp(style: str, script: str = "") -> str:
    """The content security policy of a page with this style, this script and nothing else.

    A script may begin workers of texts that are in the page.
    """

    def hashed(text: str) -> str:
        return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"

    return (
        f"default-src 'none'; script-src {hashed(script) if script else chr(39) + 'none' + chr(39)}; "
        f"style-src {hashed(style)}; img-src data:; base-uri 'none'; form-action 'none'"
        + "; worker-src blob:"
        * bool(script)
    )


def render(report: Report, figures: Mapping[str, str], program: str | None = None) -> str:
    """Print a report as HTML.

    `figures`: SVG text of each figure, by its name. `program`: the sheet as JavaScript, for a page that
    recalculates itself; None makes a page without a script.
    """
    material = Material(report)
    shown = [figure for figure in material.figures if figure.name in figures]
    drawn, style_of_drawn = inlined({figure.name: figures[figure.name] for figure in shown})
    # Both are hashed as they stand in the page, where there are no empty lines.
    live_style = _text("html/live.css") if program is not None else ""
    style = short_style(_text("html/style.css") + style_of_drawn + live_style)
    script = "" if program is None else _squeezed(_script(report, program))
    writer = HtmlWriter(
        material, {figure.name: picture(drawn[figure.name], figure.alt or figure.caption) for figure in shown}
    )
    body = Markup(_BETWEEN.sub("", writer(writer.sections)))
    parts = () if program is None else tuple(live.parts(report, material))
    data = Markup("" if program is None else live.data(report, material))
    whole = writer.render(
        "html/page.j2",
        body=body,
        style=Markup(style),
        script=Markup(script),
        csp=Markup(csp(style, script)),
        data=data,
        parts=parts,
        missing=Tables(material).missing(),
    )
    return _squeezed(short_markup(whole))


def write(made: Issued, stage: Path) -> None:
    """Write report.html."""
    figures = {name: svg.decode() for name, svg in made.figures("svg").items()}
    put(stage / "report.html", render(made.report, figures, made.program))


def _script(report: Report, program: str) -> str:
    drawings, runtime = bool(report.workbook.charts), _text("minified/runtime.js")
    return live.script(program, runtime, drawings, scatters(report))


_BETWEEN = re.compile(
    r"\n+(?=</?(?:article|aside|caption|d[dlt]|details|div|fig\w+|h\d|li|[ou]l|p|section|summary|t\w+)[ >])"
)
"""Line ends at elements that begin a line of their own: no space is seen there."""


def _squeezed(text: str) -> str:
    """Text without empty lines."""
    return re.sub(r"\n{2,}", "\n", text)


def _text(name: str) -> str:
    return (TEMPLATES / name).read_text(encoding="utf-8")
