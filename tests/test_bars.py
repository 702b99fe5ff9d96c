"""Bars of standard uncertainties on the figures of a method: as long as they are, and told where they are."""

import io
import re
import zipfile
from pathlib import Path

import gas
import numpy as np
import openpyxl
import pytest
from matplotlib.patches import PathPatch
from numpy.typing import NDArray

from loopsheet.report import stages
from loopsheet.report.charts import BARS
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.views import charts

TABLE = "reading,T [degC],u(T) [K]\n1,20.0,0.2\n2,21.5,1\n3,-3.2,4\n"
TOML = gas.TOML.partition("[uncertainty]")[0]


def report_of(folder: Path, table: str = TABLE, toml: str = TOML, code: str = gas.WORKBOOK) -> Report:
    return Study(gas.folder(folder, toml=toml, table=table, code=code)).computed


def drawn(report: Report) -> tuple[NDArray[np.float64], list[str], list[tuple[float, float]]]:
    """The ends of all bars, with the shape (bars, 2, 2), what the legend says, and the ends of both axes."""
    (figure,) = report.workbook.figures
    assert figure.chart is not None
    picture = charts.draw(report, figure.chart)
    (axes,) = picture.axes
    ends = [
        np.asarray(patch.get_path().vertices).reshape(-1, 2, 2)
        for patch in axes.artists + axes.patches
        if isinstance(patch, PathPatch) and patch.get_linewidth() < 1
    ]
    told = [text.get_text() for legend in picture.legends for text in legend.get_texts()]
    return np.concatenate([np.empty((0, 2, 2)), *ends]), told, [axes.get_xlim(), axes.get_ylim()]


def test_a_bar_reaches_a_standard_uncertainty_to_both_sides(tmp_path: Path) -> None:
    report = report_of(tmp_path)
    ends, told, limits = drawn(report)
    u, middle = report.uncertain().u, ends.mean(axis=1)
    x, y = (report.shown[name].of(report.values.value[name]) for name in ("T", "warm"))
    assert u["T"] == pytest.approx([0.2, 1, 4])
    assert u["warm"] == pytest.approx(np.hypot(u["T"], report.inputs.printed("dT")[0].u))
    assert middle == pytest.approx(np.column_stack([np.tile(x, 2), np.tile(y, 2)]))
    reach = np.ptp(ends, axis=1) / 2
    assert reach[:3] == pytest.approx(np.column_stack([u["T"], np.zeros(3)]))
    assert reach[3:] == pytest.approx(np.column_stack([np.zeros(3), u["warm"]]))
    assert BARS in told
    # All of them is in the frame.
    for n, (low, high) in enumerate(limits):
        assert low < ends[..., n].min() < ends[..., n].max() < high


def test_what_is_exact_has_none(tmp_path: Path) -> None:
    toml = f'{TOML}[uncertainty]\nT = "exact"\n'.replace("1.5 delta_degC", "1.5 delta_degC, exact")
    report = report_of(tmp_path, gas.TABLE, toml)
    ends, told, _ = drawn(report)
    assert (len(ends), BARS in told) == (0, False)
    some = report_of(tmp_path / "some", TABLE.replace("21.5,1", "21.5,0"), toml.partition("[uncertainty]")[0])
    assert len(drawn(some)[0]) == 4


def test_a_logarithmic_axis_ends_a_bar_at_its_frame(tmp_path: Path) -> None:
    code = gas.WORKBOOK.replace("plot(T, warm, m)", 'plot(T, rho, log="y")')
    toml = TOML.replace('p = "1013.2 mbar"', 'p = "1013.2 mbar, u = 2000"')
    ends, _, (_, (low, high)) = drawn(report_of(tmp_path, toml=toml, code=code))
    assert ends[3:, 0, 1] == pytest.approx([low] * 3)
    assert all(low < top < high for top in ends[3:, 1, 1])


def test_the_workbook_draws_them_from_cells(tmp_path: Path) -> None:
    report = report_of(tmp_path)
    grid, book = stages.book(report)
    sheet = openpyxl.load_workbook(io.BytesIO(book))["figures"]
    columns = {cell.value: cell for cell in sheet[2] if cell.value}
    u = report.uncertain().u
    for name, unit in (("T", "degC"), ("warm", "degC")):
        at = columns[f"u({name}) as issued [{unit}]"]
        below = [sheet.cell(at.row + row, at.column).value for row in (1, 2, 3, 4)]
        assert below[:3] == pytest.approx(u[name].tolist())
        assert below[3] is None
    with zipfile.ZipFile(io.BytesIO(book)) as parts:
        chart = parts.read("xl/charts/chart1.xml").decode()
    bars = re.findall(
        r'<c:errDir val="(.)"/>.*?<c:plus><c:numRef><c:f>(.*?)</c:f>.*?<c:minus>(.*?)</c:minus>', chart
    )
    assert [(axis, cells) for axis, cells, _ in bars] == [
        ("x", "figures!$U$3:$U$5"),
        ("y", "figures!$X$3:$X$5"),
    ]
    assert all(f"<c:f>{cells}</c:f>" in below for _, cells, below in bars)
    assert f"; {BARS} as issued<" in chart
    # A frame has room for points, and the ends of bars are points that nobody sees.
    at = columns["warm less u [degC]"]
    cells = [grid["warm"].place.cell(row) for row in range(3)]
    assert [sheet.cell(row, at.column).value for row in (3, 4, 5)] == [
        f"=IF(ISNUMBER({cell}),{cell}-$X${row},NA())" for row, cell in enumerate(cells, start=3)
    ]
    shown = openpyxl.load_workbook(io.BytesIO(book), data_only=True)["figures"]
    low = [shown.cell(row, at.column).value for row in (3, 4, 5)]
    assert low == pytest.approx(report.shown["warm"].of(report.values.value["warm"]) - u["warm"])
    series = re.findall("<c:ser>.*?</c:ser>", chart)
    unseen = [each for each in series if f"<c:f>figures!${at.column_letter}$3:" in each]
    assert len(unseen) == 1
    assert len(re.findall("<c:legendEntry>.*?<c:delete", chart)) >= 4
    assert grid["T"].place.scale == 1
