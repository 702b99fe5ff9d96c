"""Clouds of points in a workbook: as many cells as a chart draws dots."""

import re
from dataclasses import replace

import pytest
from large_campaigns import write

from loopsheet.report import stages
from loopsheet.report.cells.grid import Grid, letters
from loopsheet.report.charts import MOST_DOTS, Chart, Drawn, Series, with_copies
from loopsheet.report.engines import excel_grid
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study


@pytest.fixture(scope="module")
def crowded(tmp_path_factory: pytest.TempPathFactory) -> Grid:
    report = Study(write(tmp_path_factory.mktemp("crowded"), 12, 30)).computed
    units = {name: shown.unit for name, shown in report.shown.items()}
    return excel_grid.grid(report.sheet, report.values, units, drawn=stages.for_a_grid(report))


def test_of_a_cloud_a_worksheet_has_no_more_points_than_are_drawn(crowded: Grid) -> None:
    points, shown = crowded["x"], crowded["plotted_x"]
    assert (points.place.rows, shown.place.rows) == (66 * 30, MOST_DOTS)
    named = []
    for formula in shown.formulas:
        (row,) = {int(row) for row in re.findall(rf"\$?{letters(points.place.column)}\$?(\d+)", formula)}
        named.append(row - points.place.row - 1)
    assert (named[0], named[-1]) == (0, 66 * 30 - 1)
    assert named == sorted(set(named))
    known = [points.values[row] for row in named]
    assert list(shown.values) == [None if isinstance(value, str) else value for value in known]
    assert crowded["plotted_F"].place.rows == MOST_DOTS
    assert crowded["plotted_alpha"].place.rows == 66, "each has a name"


def test_points_that_a_line_or_a_bar_shows_too_are_not_thinned(report: Report) -> None:
    sheet = report.sheet
    cloud = Series("x", "F", "points", "points")
    assert with_copies(Drawn(), sheet, [Chart("", "x", "F", (cloud,))]).thinned == ("plotted_x", "plotted_F")
    for other in (replace(cloud, style="line"), replace(cloud, bars=True), replace(cloud, named=True)):
        charts = [Chart("", "x", "F", (cloud,)), Chart("", "x", "F", (other,))]
        assert with_copies(Drawn(), sheet, charts).thinned == ()
