"""What a chart is: declared once in a workbook, drawn by matplotlib, by the page's script and by Excel."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from .column import shown_as
from .sheet import Axis, Column, Formula, Given, Sheet, SheetError

if TYPE_CHECKING:
    from sympy import Expr

INK, VERMILION, BLUE = "#1a1a1a", "#d55e00", "#0072b2"
COLOURS = (VERMILION, BLUE, "#009e73", "#cc79a7")
"""Of Okabe and Ito: told apart by every eye. `COLOURS`: of several series, one after the other."""
BARS = "bars: standard uncertainty"
"""What the legend says of them."""
STYLES = ("points", "line", "level")
MOST_DOTS = 500
"""Points of a series that are drawn; more are thinned: they would blacken the paper and bloat the file."""
MOST_GROUPS = 8
"""Of points that the legend tells apart; of more, those with a line are named at its end."""
MOST_PANELS, IN_A_ROW = 9, 3
"""Panels of a picture; of more rows some are drawn, evenly."""
_SHADES = ((68, 1, 84), (70, 50, 127), (54, 92, 141), (39, 127, 142), (31, 161, 135))


@dataclass(frozen=True)
class Series:
    """What a chart shows of two columns of one axis; a row without a value in both is left out."""

    x: str
    y: str
    """`x` and `y`: names of columns, of the sheet or drawn. A ``level`` has a single number as its y."""
    label: str
    """What the legend says, a plain sentence. ``%s`` stands for the rows: ``10 pairs``; where each is a line
    of its own, ``each test`` or ``test 5``."""
    style: str = "line"
    """``points``; ``line``, where rows are repeated through all points in the order of x; ``level``, over the
    whole width and named at its end."""
    colour: str = INK
    """``#rrggbb``; lines of their own go from dark to middling."""
    each: bool = False
    """Whether each row of the repeated axis is a line of its own, named where it ends."""
    named: bool = False
    """Whether the points have the names of their rows."""
    value: str = ""
    """A single number that the label is told to be, behind it."""
    bars: bool = False
    """Whether points have bars of a standard uncertainty to both sides, where one is known."""
    by: str = ""
    """The groups of the points, an index set: those of each have a colour, and its word in the legend."""

    @property
    def is_cloud(self) -> bool:
        """Whether it is points that nobody tells apart."""
        return self.style == "points" and not (self.named or self.bars)


@dataclass(frozen=True)
class Chart:
    """A chart of a figure, and of the workbook."""

    title: str
    x: str
    y: str
    """`title`, `x` and `y`: plain sentences of the document; the axes get their units from the columns."""
    series: tuple[Series, ...]
    """The last is drawn on top."""
    log: str = ""
    """The axes with a logarithmic scale: ``x``, ``y`` or ``xy``."""
    from_zero: bool = False
    """Whether both axes begin at zero."""
    zero: bool = False
    """Whether there is a line at zero across all of it."""
    whole: bool = False
    """Whether every point is drawn where it is, however far from the lines and the other points."""
    panels: bool = False
    """Whether each row of the repeated axis has a panel of its own, with axes in common; series are lines."""
    height: float = 8
    """In centimetres, of 16 cm of width; with panels, of a row of these."""

    @property
    def leading(self) -> Series:
        """The series in whose units the axes are."""
        return next((series for series in self.series if series.style != "level"), self.series[0])


@dataclass(frozen=True)
class Drawn:
    """The columns that only charts ask for, such as the points of a curve."""

    columns: tuple[Column, ...] = ()
    """Formulas as the sheet's."""
    given: Mapping[str, int] = field(default_factory=dict)
    """Values of the given columns among them: how often an axis that only charts have repeats its parent."""
    thinned: tuple[str, ...] = ()
    """The columns that are of clouds alone, of which a worksheet has no more cells than are drawn."""


def drawn(name: str, axis: Axis, value: Expr, unit: str = "1", meaning: str = "", **more: Any) -> Column:
    """A column that only charts ask for; what else a :class:`Column` takes is `more`."""
    from sympy import Symbol

    from ..derivations.equation import Equation, Kind

    equation = Equation("", (Symbol("drawn"), value), "", Kind.DEFINITION, "for the chart")
    return Column(name, axis, Formula(equation), unit, meaning, positive=False, **more)


def copied(name: str, axis: Axis, like: str, columns: Mapping[str, Column]) -> str:
    """The name of the copy of a column, or of a single number for each row, that Excel draws from.

    `like`: the column in whose unit it is drawn. `columns`: those of the sheet and those that are drawn.
    """
    own = f"plotted_{name}" if columns[name].axis else f"{axis.name}_{name}"
    return own if _in_one_unit(name, like, columns) else f"{own}_like_{like}"


def _in_one_unit(name: str, like: str, columns: Mapping[str, Column]) -> bool:
    """Whether two columns are shown in one unit, whatever that is; what is given may stand in any."""
    one, other = (shown_as(columns[each], columns) for each in (name, like))
    computed = not any(isinstance(each.rule, Given) for each in (one, other))
    return one == other or (computed and (one.unit, one.display) == (other.unit, other.display))


def with_copies(own: Drawn, sheet: Sheet, charts: Iterable[Chart]) -> Drawn:
    """The same with copies of what charts show, in the units of the axes.

    Of the sheet they are of all, for what would draw a cell in error as zero.
    """
    columns = {column.name: column for column in (*sheet.columns, *own.columns)}
    found: dict[str, Column] = {}
    whole: set[Axis] = set()
    for lead, series in ((chart.leading, series) for chart in charts for series in chart.series):
        axis = columns[series.x].axis
        assert axis is not None
        if not (series.is_cloud and {series.x, series.y} <= sheet.by_name.keys()):
            whole.add(axis)
        for own_name, like in ((series.x, lead.x), (series.y, lead.y)):
            column, is_alike = columns[own_name], _in_one_unit(own_name, like, columns)
            if is_alike and own_name not in sheet:
                continue  # what is drawn alone has no errors
            value = column[axis.index] if column.axis else column.symbol
            name, meaning = copied(own_name, axis, like, columns), f"{own_name}, for the chart"
            display = f"like {own_name if is_alike else like}"
            found[name] = drawn(name, axis, value, column.unit, meaning, display=display)
    thinned = tuple(name for name, column in found.items() if column.axis not in whole)
    return Drawn((*own.columns, *found.values()), own.given, thinned)


def series_of(x: Column, y: Column) -> Series:
    """Points of two columns, or a line where they are generated."""
    if x.axis is None or x.axis != y.axis:
        of = ", ".join(f"{each.name} is of the {each.axis.name}" for each in (x, y) if each.axis)
        raise SheetError(f"{x.name} and {y.name} are no columns of the same rows: {of}", y.name)
    if not x.axis.ordinals:
        return Series(x.name, y.name, y.meaning, "points", bars=True)
    if not x.axis.repeats:
        return Series(x.name, y.name, y.meaning)
    return Series(x.name, y.name, f"{y.meaning}, %s", each=True)


def shade(part: float) -> str:
    """The colour of a line among others, from dark (0) to middling (1): the greys climb, too.

    >>> shade(0), shade(1)
    ('#440154', '#1fa187')
    """
    place = part * (len(_SHADES) - 1)
    n = min(int(place), len(_SHADES) - 2)
    ends = zip(_SHADES[n], _SHADES[n + 1], strict=True)
    return "#" + "".join(f"{round(low + (place - n) * (high - low)):02x}" for low, high in ends)
