"""The workbook's native charts: drawn from cells, so that they follow every edit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ..cells.grid import CellBlock, Grid, Place
from ..cells.layout import evenly
from ..charts import BARS, IN_A_ROW, MOST_PANELS, Chart, Series, copied, shade
from ..document.charted import Words, plain, thinned
from ..quantity import behind
from ..result.result import Report
from ..workbook import FigureSpec
from .xlsx_style import Style, number_format, said

_SIZE = {"width": 900, "height": 540}
_ROWS = 29
"""Rows of the worksheet that a chart covers."""
_PANEL = 300, 240, 13
"""Width and height of one of many in pixels, and its rows."""
_BESIDE = 20
"""The first column, from 0, of how long bars are."""
_PICTURED = 6
"""Digits of a number that nobody reads but a chart, which is less than a thousand points wide."""
_IN_PANEL = 4
"""The same of a chart that is one of many, and a third as wide."""
_INK, _GRID = "#1F2A36", "#E3E8ED"
_UNSEEN: dict[str, Any] = {
    "name": "",
    "marker": {"type": "none"},
    "line": {"none": True},
    "x_error_bars": None,
    "y_error_bars": None,
}


def charted(report: Report, grid: Grid) -> list[FigureSpec]:
    """The figures whose columns are all on the grid: some have columns that are made for them alone."""
    return [
        figure
        for figure in report.workbook.figures
        if figure.chart and all({each.x, each.y} <= grid.by_name.keys() for each in figure.chart.series)
    ]


def write_charts(book: Any, sheet: Any, style: Style, report: Report, grid: Grid) -> None:
    """Draw every chart, one below the other."""
    figures, words = charted(report, grid), Words(report)
    sheet.hide_gridlines(2)
    style.page(sheet, "figures: drawn from the cells, they follow every edit")
    beside, tops = _BESIDE, [2]
    for figure in figures:
        assert figure.chart is not None
        if figure.chart.panels:
            tops.append(_panels(book, sheet, words, grid, figure, figure.chart, tops[-1]))
        else:
            beside = _whole(book, sheet, style, words, grid, figure, figure.chart, tops[-1], beside)
            tops.append(tops[-1] + _ROWS)
    sheet.set_h_pagebreaks([top - 1 for top in tops[1:-1]])
    if beside > _BESIDE:
        sheet.print_area(0, 0, tops[-1] - 1, _BESIDE - 6)


def _whole(
    book: Any,
    sheet: Any,
    style: Style,
    words: Words,
    grid: Grid,
    figure: FigureSpec,
    chart: Chart,
    top: int,
    beside: int,
) -> int:
    """Draw one chart; return the first column that is free beside it."""
    drawn = book.add_chart({"type": "scatter"})
    labels: list[str] = []
    ends: list[dict[str, Any]] = []
    for place, series in enumerate(chart.series):
        x, y = _drawn(words, grid, chart, series)
        bars = list(_barred(words, grid, series, x, y))
        for each in _series(words, series, x, y):
            each["name"] += f"; {BARS} as issued" if bars else ""
            for axis, block, u in bars:
                head = f"u({getattr(series, axis)}) as issued{said(block.unit)}"
                each[f"{axis}_error_bars"] = _bars(sheet, style, beside, head, u, series.colour)
                own = _ends(sheet, style, beside, axis, block, u, axis in chart.log)
                ends += [{**each, **end} for end in own]
                beside += 3
            labels.append(each["name"])
            if value := series.value or (series.y if series.style == "level" else ""):
                # Behind the chart, a formula: what is told of a number follows it.
                each["name"] = _told(sheet, style, top + place, labels[-1], grid[value], words)
            drawn.add_series(each)
    for each in ends:
        drawn.add_series(each)
    again = [place for place, label in enumerate(labels) if label in labels[:place]]
    again += range(len(labels), len(labels) + len(ends))
    told = len(labels) > 1 or BARS in labels[0]
    drawn.set_legend({"position": "right", "delete_series": again} if told else {"none": True})
    title = f"Figure {figure.number}: {plain(words.letters(chart.title))}"
    _framed(drawn, words, chart, title, 13)
    drawn.set_size(_SIZE)
    sheet.insert_chart(top, 0, drawn, {"description": title})
    return beside


def _panels(
    book: Any, sheet: Any, words: Words, grid: Grid, figure: FigureSpec, chart: Chart, top: int
) -> int:
    """Draw a chart for each row of the axis that is repeated, of many for some; return the row below them.

    What the lines are stands above, in their colours: so all panels are alike.
    """
    places = [_drawn(words, grid, chart, series) for series in chart.series]
    lines = [
        list(_series(words, series, *both, _IN_PANEL))
        for series, both in zip(chart.series, places, strict=True)
    ]
    colours = {own[0]["name"]: series.colour for own, series in zip(lines, chart.series, strict=True) if own}
    title = f"Figure {figure.number}: {plain(words.letters(chart.title))}"
    sheet.write_string(top, 0, title, book.add_format({"bold": True, "font_color": _INK}))
    for row, (label, colour) in enumerate(colours.items(), start=top + 1):
        sheet.write_string(
            row, 0, f"\N{HORIZONTAL BAR} {label}", book.add_format({"font_color": colour, "bold": True})
        )
    top += len(colours) + 2
    of = words.axis(chart.series[0])
    names = words.plotted.values.layouts[of.name].labels.tolist()
    shown = evenly(len(names), MOST_PANELS)
    width, height, rows = _PANEL
    for place, row in enumerate(shown):
        drawn = book.add_chart({"type": "scatter"})
        for own in lines:
            drawn.add_series(own[row])
        name = words.row(of, tuple(names[row]))
        _framed(drawn, words, chart, name, 11)
        drawn.set_legend({"none": True})
        drawn.set_size({"width": width, "height": height})
        down, across = divmod(place, IN_A_ROW)
        where = {"description": f"{title}, {name}", "x_offset": across * width}
        sheet.insert_chart(top + down * rows, 0, drawn, where)
    return int(top + -(-len(shown) // IN_A_ROW) * rows)


def _framed(drawn: Any, words: Words, chart: Chart, title: str, size: int) -> None:
    """Give a chart its title and its axes."""
    drawn.set_title({"name": title, "name_font": {"size": size, "color": _INK}, "overlay": False})
    for axis, scale, set_axis in zip(
        "xy", words.scales(chart), (drawn.set_x_axis, drawn.set_y_axis), strict=True
    ):
        set_axis(_axis(plain(scale.titled(scale.unit)), chart.from_zero, axis in chart.log))
    drawn.show_na_as_empty_cell()


def _axis(name: str, from_zero: bool, log: bool) -> dict[str, Any]:
    return {
        "name": name,
        "name_font": {"size": 11, "bold": False},
        "num_format": "General",
        "label_position": "low",  # below the points, also where the other axis crosses between them
        "major_gridlines": {"visible": True, "line": {"color": _GRID, "width": 0.75}},
        # Where the other axis crosses: on a logarithmic one, zero is nowhere.
        **({"log_base": 10, "crossing": "min"} if log else {"min": 0} if from_zero else {}),
    }


def _told(sheet: Any, style: Style, row: int, label: str, block: CellBlock, words: Words) -> str:
    """Write a label with a number behind it, in the unit of its cell; the address of what is written."""
    form = number_format(words.report.figures(block.name)[0])
    unit = behind(block.unit)
    told = '"{}"&TEXT({},"{}")&"{}"'.format(label.replace('"', '""'), block.place.cell(), form, unit)
    style.formula(sheet, row, 0, told, label + words.value(block.name), style("number"))
    return f"={sheet.get_name()}!$A${row + 1}"


def _drawn(words: Words, grid: Grid, chart: Chart, series: Series) -> tuple[CellBlock, CellBlock]:
    """The cells that a series is drawn from, in the units of the axes: copies, where there are some."""
    columns, lead = words.plotted.values.sheet.by_name, chart.leading
    axis = columns[series.x].axis
    assert axis is not None
    pairs = (series.x, lead.x), (series.y, lead.y)
    names = ((copied(name, axis, like, columns), name) for name, like in pairs)
    x, y = (grid[copy if copy in grid.by_name else name] for copy, name in names)
    return x, y


def _series(
    words: Words, series: Series, x: CellBlock, y: CellBlock, digits: int = _PICTURED
) -> Iterator[dict[str, Any]]:
    """A chart's series: one, or one for each row of the axis that is repeated."""
    values = words.plotted.values
    axis, of = values.sheet[series.x].axis, words.axis(series)
    assert axis is not None
    if axis is of or series.style == "points":
        label = plain(words.label(series, f"the {of.name}"))
        label += thinned(values.layouts[axis.name].size, x.place.rows)
        yield _one(label, series, series.colour, x, y, 0, x.place.rows, digits)
        return
    parents = values.layouts[of.name].labels.tolist()
    each = x.place.rows // max(1, len(parents))
    for number, label in enumerate(parents):
        own, colour = f"the {of.name}", series.colour
        if series.each:
            own, colour = words.row(of, tuple(label)), shade(number / max(1, len(parents) - 1))
        yield _one(plain(words.label(series, own)), series, colour, x, y, number * each, each, digits)


def _barred(
    words: Words, grid: Grid, series: Series, x: CellBlock, y: CellBlock
) -> Iterator[tuple[str, CellBlock, list[float]]]:
    """The axes along which points have bars, the cells of each, and standard uncertainties in their unit."""
    known = words.report.uncertain().u if series.bars else {}
    for axis, name, copy in (("x", series.x, x), ("y", series.y, y)):
        block = grid[name] if grid[name].unit == copy.unit else copy
        scale = float(block.place.scale)
        u = [each / scale if each > 0 else 0.0 for each in known.get(name, np.empty(0)).tolist()]
        if any(u):
            yield axis, block, u


def _bars(sheet: Any, style: Style, column: int, head: str, u: list[float], colour: str) -> dict[str, Any]:
    """Write how long bars are into a column: as issued, for no other cell tells it."""
    style.text(sheet, 1, column, head, "head")
    sheet.set_column(column, column, 18)
    for row, each in enumerate(u, start=2):
        sheet.write_number(row, column, each, style("number"))
    cells = f"={sheet.get_name()}!{Place(sheet.get_name(), 2, column, len(u)).range(sheet.get_name())}"
    sides = {
        f"{side}_{what}": said
        for side in ("plus", "minus")
        for what, said in (("values", cells), ("data", u))
    }
    return {"type": "custom", **sides, "end_style": 0, "line": {"color": colour, "width": 0.75}}


def _ends(
    sheet: Any, style: Style, column: int, axis: str, block: CellBlock, u: list[float], log: bool
) -> Iterator[dict[str, Any]]:
    """Write the ends of bars beside how long they are: points that nobody sees, which a frame takes in."""
    lengths, what = Place(sheet.get_name(), 2, column, len(u)), "categories" if axis == "x" else "values"
    for n, (way, head) in enumerate(((-1, "less"), (1, "and")), start=1):
        style.text(sheet, 1, column + n, f"{block.name} {head} u{said(block.unit)}", "head")
        sheet.set_column(column + n, column + n, 18)
        ends: list[float | None] = []
        for row, (value, length) in enumerate(zip(block.values, u, strict=True)):
            end = value + way * length if isinstance(value, float) else None
            ends.append(None if end is None or (log and end <= 0) else end)
            cell = block.place.cell(row)
            far = f"{cell}{'-+'[way > 0]}{lengths.cell(row, lengths.worksheet)}"
            asked = f"IF(ISNUMBER({cell}),{far}>0,FALSE)" if log else f"ISNUMBER({cell})"
            formula = f"=IF({asked},{far},NA())"
            style.formula(sheet, lengths.row + row, column + n, formula, ends[-1], style("number"))
        place = replace(lengths, column=column + n)
        yield {what: f"={place.range()}", f"{what}_data": ends, **_UNSEEN}


def _one(
    label: str, series: Series, colour: str, x: CellBlock, y: CellBlock, first: int, rows: int, digits: int
) -> dict[str, Any]:
    looks: dict[str, Any] = {"marker": {"type": "none"}, "line": {"color": colour, "width": 1.5}}
    if series.style == "points":
        fill = {"type": "circle", "size": 3, "fill": {"color": colour}, "border": {"none": True}}
        looks = {"marker": fill, "line": {"none": True}}
    elif series.style == "level":
        looks["line"]["dash_type"] = "dash"
    stretch = slice(first, first + rows)
    return {
        "name": label,
        "categories": f"={x.place.range(first=first, rows=rows)}",
        "values": f"={y.place.range(first=first, rows=rows)}",
        # What viewers draw before they calculate.
        "categories_data": _pictured(x.values[stretch], digits),
        "values_data": _pictured(y.values[stretch], digits),
        **looks,
    }


def _pictured(values: Iterable[float | str | None], digits: int) -> list[float | str | None]:
    """What a chart knows of cells before it reads them; one without a value is a gap."""
    return [float(f"{value:.{digits}g}") if isinstance(value, float) else value for value in values]
