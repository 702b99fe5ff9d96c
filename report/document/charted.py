"""The words of a chart: its axes with their units, its legend, in letters that any view can draw."""

from __future__ import annotations

from dataclasses import dataclass

from ...derivations.unit_text import is_pure, micro
from ..cells.address import index_text
from ..charts import Chart, Series
from ..result.result import Report
from ..sheet import Axis, RepeatAxis
from .material import Material
from .notation import fragments
from .tree import Math, Refer

Letters = tuple[tuple[str, str], ...]
"""Pieces of a text: upright (``""``) or a symbol's, on the line (``i``), below or above it (``_``, ``^``)."""

PREFIXES = (("M", 1e6), ("k", 1e3), ("", 1.0), ("m", 1e-3))
"""What keeps the numbers of an axis short."""


@dataclass(frozen=True)
class Scale:
    """An axis: its title, the unit of its numbers and the unit's size in SI."""

    title: Letters
    unit: str
    size: float
    zero: float
    """Zero of the unit in SI."""
    prefixed: bool
    """Whether the unit takes one of :data:`PREFIXES`."""

    def titled(self, unit: str) -> Letters:
        """With a unit behind it."""
        return (*self.title, ("", f" / {text}")) if (text := unit_text(unit)) else self.title


def unit_text(unit: str) -> str:
    """A unit behind the stroke of an axis label: µ for u, and nothing for a pure number.

    >>> unit_text("um"), unit_text("m/s"), unit_text("1")
    ('µm', '(m/s)', '')
    """
    pretty = plain_unit(unit)
    return f"({pretty})" if "/" in pretty else pretty


def plain_unit(unit: str) -> str:
    """A unit as plain text: µ for u, and nothing for a pure number.

    >>> plain_unit("um/(L min)"), plain_unit("1")
    ('µm/(L min)', '')
    """
    return "" if is_pure(unit) else micro(unit)


def thinned(there: int, drawn: int) -> str:
    """What the legend says behind points, if not all that are there are drawn.

    >>> thinned(39000, 500), thinned(500, 500)
    (', one in 78 drawn', '')
    """
    return f", one in {round(there / drawn)} drawn" if drawn < there else ""


def plain(letters: Letters) -> str:
    """Without italics and heights."""
    return "".join(text for _, text in letters)


class Words:
    """What the charts of a report say."""

    def __init__(self, report: Report) -> None:
        self.report, self.plotted = report, report.plotted()
        self.sentences = Material(report).sentences

    def letters(self, text: str) -> Letters:
        """A plain sentence with its symbols."""
        found: list[tuple[str, str]] = []
        for part in self.sentences.rich(text):
            match part:
                case Math(latex):
                    found += [(height or "i", letters) for height, letters in fragments(latex)]
                case Refer(label):
                    found.append(("", label))
                case _:
                    found.append(("", str(part)))
        return tuple(found)

    def scales(self, chart: Chart) -> tuple[Scale, Scale]:
        """Both axes, in the units of the first series."""
        first = chart.leading
        return self._scale(chart.x, first.x), self._scale(chart.y, first.y)

    def _scale(self, title: str, name: str) -> Scale:
        shown = self.plotted.shown[name]
        # Of a name's letter, such as N and Pa; as SI has it, not as somebody measured in it.
        prefixed = shown.unit[:1].isupper() and shown.unit.isalpha() and shown.scale == 1
        return Scale(self.letters(title), shown.unit, shown.scale, shown.zero, prefixed)

    def label(self, series: Series, rows: str = "%s") -> Letters:
        """What the legend says of a series, up to the number behind it."""
        said = f"each {self.axis(series).row}" if series.each and rows == "%s" else rows
        behind = " = " if series.value else " " if series.style == "level" else ""
        return self.letters(series.label.replace("%s", said) + behind)

    def axis(self, series: Series) -> Axis:
        """The axis whose rows a series tells of."""
        if series.by:
            return next(axis for axis in self.plotted.values.sheet.axes if axis.name == series.by)
        axis = self.plotted.values.sheet[series.x].axis
        assert axis is not None
        return axis.of if isinstance(axis, RepeatAxis) else axis

    def called(self, axis: Axis, label: tuple[int, ...]) -> str:
        """What one of its rows is called: by its word, if it has one."""
        return self._word(axis, label) or index_text(label).replace("-", "–")

    def row(self, axis: Axis, label: tuple[int, ...]) -> str:
        """The same where nothing else says what it is: ``test 2``."""
        return self._word(axis, label) or f"{axis.row} {index_text(label)}"

    def _word(self, axis: Axis, label: tuple[int, ...]) -> str:
        return self.report.values.words.get(axis.name, {}).get(label, "")

    def count(self, series: Series, number: int) -> str:
        """So many rows: ``10 pairs``."""
        axis = self.axis(series)
        return f"{number} {axis.name if number != 1 else axis.row}"

    def value(self, name: str) -> str:
        """A single number as the report prints it, with its unit; empty if there is none."""
        cell = self.report.values.cell(name)
        return "" if cell.value is None else self.report.text(cell)
