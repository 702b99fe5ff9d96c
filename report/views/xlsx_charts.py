"""The workbook's native charts: drawn from cells, so that they follow every edit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..cells.grid import Block, Grid
from ..charts import Series
from ..result.result import Report
from ..sheet import RepeatAxis
from .xlsx_style import Style

__all__ = ["write_charts"]

_SIZE = {"width": 900, "height": 540}
_ROWS = 29
"""Rows of the worksheet that a chart covers."""
_INK, _POINTS, _GRID = "#1F2A36", "#7A8896", "#E3E8ED"
_BRANCHES = ("#3B1F6E", "#36528C", "#2A788E", "#22A384", "#5DBE5A", "#A5A52A", "#C2782B", "#A8323E")


def write_charts(book: Any, sheet: Any, style: Style, report: Report, grid: Grid) -> None:
    """Draw every chart, one below the other."""
    assert grid.drawn is not None
    sheet.hide_gridlines(2)
    sheet.set_landscape()
    sheet.set_paper(9)
    sheet.fit_to_pages(1, 0)
    sheet.set_h_pagebreaks([1 + number * _ROWS for number in range(1, len(grid.drawn.charts))])
    style.text(sheet, 0, 0, "figures: drawn from the cells, they follow every edit", "title")
    for number, chart in enumerate(grid.drawn.charts):
        drawn = book.add_chart({"type": "scatter"})
        every = [each for series in chart.series for each in _series(report, grid, series)]
        for each in every:
            drawn.add_series(each)
        x, y = (grid[name] for name in (chart.series[0].x, chart.series[0].y))
        drawn.set_title({"name": chart.title, "name_font": {"size": 13, "color": _INK}, "overlay": False})
        drawn.set_x_axis(_axis(chart.x_title, x, chart.from_zero))
        drawn.set_y_axis(_axis(chart.y_title, y, chart.from_zero))
        labels = [each["name"] for each in every]
        again = [place for place, label in enumerate(labels) if label in labels[:place]]
        drawn.set_legend({"position": "right", "delete_series": again} if len(labels) > 1 else {"none": True})
        drawn.set_size(_SIZE)
        drawn.show_na_as_empty_cell()
        sheet.insert_chart(2 + number * _ROWS, 0, drawn, {"description": chart.title})


def _axis(title: str, block: Block, from_zero: bool) -> dict[str, Any]:
    return {
        "name": title if block.unit == "1" else f"{title} / {block.unit}",
        "name_font": {"size": 11, "bold": False},
        "num_format": "General",
        "major_gridlines": {"visible": True, "line": {"color": _GRID, "width": 0.75}},
        **({"min": 0} if from_zero else {}),
    }


def _series(report: Report, grid: Grid, series: Series) -> Iterator[dict[str, Any]]:
    """A chart's series: one, or one for each row of the parent's axis."""
    x, y = grid[series.x], grid[series.y]
    if not series.split:
        yield _one(series.label, series.style, 0, x, y, 0, x.place.rows)
        return
    axis = grid.axes[x.place.worksheet]
    assert isinstance(axis, RepeatAxis)
    parents = report.values.layouts[axis.of.name].labels.tolist()
    each = x.place.rows // max(1, len(parents))
    for number, label in enumerate(parents):
        name = series.label.replace("%s", "-".join(map(str, label)))
        yield _one(name, series.style, number, x, y, number * each, each)


def _one(label: str, style: str, number: int, x: Block, y: Block, first: int, rows: int) -> dict[str, Any]:
    looks: dict[str, Any] = {"marker": {"type": "none"}, "line": {"color": _INK, "width": 2.0}}
    if style == "points":
        looks = {
            "marker": {"type": "circle", "size": 3, "fill": {"color": _POINTS}, "border": {"none": True}},
            "line": {"none": True},
        }
    elif style == "branch":
        looks["line"] = {"color": _BRANCHES[number % len(_BRANCHES)], "width": 1.5}
    stretch = slice(first, first + rows)
    return {
        "name": label,
        "categories": f"={x.place.range(first=first, rows=rows)}",
        "values": f"={y.place.range(first=first, rows=rows)}",
        # What viewers draw before they calculate; a cell without a value is a gap.
        "categories_data": list(x.values[stretch]),
        "values_data": list(y.values[stretch]),
        **looks,
    }
