"""The drawings: the same bytes everywhere, nothing clipped or overlapping, small, and true to the report."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from itertools import combinations
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import grouped
import numpy as np
import pytest
from drawn_files import pdf_of, svg_of
from helpers import method_folder
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.text import Text
from matplotlib.transforms import Bbox

import loopsheet
from loopsheet.report.impacts.codes import CODES
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.views import drawing, figures
from loopsheet.report.workbooks.soft_impact import WORKBOOK

CAMPAIGNS = ("paper", "2", "3", "10", "40", "in error", "no pair", "falling", "equal", "cards")
DRAWINGS = tuple(figures.drawings(WORKBOOK))
FIXED = [each.drawing for each in WORKBOOK.figures if each.fixed]
PICTURES = [(c, name) for c in CAMPAIGNS for name in DRAWINGS if c == "paper" or name not in FIXED]
"""Those that show no data once: they are the same files for all campaigns, as is tested below."""

TOML = """
title = "synthetic"
workbook = "soft_impact"
[parameters]
ball_diameter = "12.7 mm"
ball_density = "7800 kg/m^3"
[measurements]
file = "measurements.csv"
"""
CARDS = f"""
[cards]
codes = {json.dumps([*CODES])}
"""


def rows_of(campaign: str) -> list[tuple[float, float, float]]:
    """Speed in m/s, restitution coefficient and imprint depth in um of each test."""
    table_1 = [
        (2.334, 0.53, 23.5),
        (2.94, 0.512, 29.7),
        (4.089, 0.479, 41.6),
        (4.504, 0.467, 45.97),
        (4.993, 0.453, 51.03),
    ]
    match campaign:
        case "cards":
            return table_1
        case "in error":  # the second imprint is shallower than the first, the last is missing its root too
            return [(2.334, 0.53, 30.0), *table_1[1:4], (4.993, 0.453, 45.0)]
        case "no pair":
            return [(2.0, 0.5, 30.0), (3.0, 0.5, 20.0)]
        case "falling":  # the last test is so slow for its imprint that the best power is a falling one
            return [(1.84, 0.706, 12.6), (5.12, 0.334, 53.3), (0.82, 0.277, 74.4)]
        case "equal":  # nearly one speed: the axis must not fall back on an offset
            return [(3.0001, 0.5, 30.0001), (3.0002, 0.5, 30.0015), (3.0003, 0.5, 30.003)]
    tests = int(campaign)
    noise = np.random.default_rng(tests).standard_normal((3, tests))
    v = np.linspace(2.3, 5.0, tests)
    e = 0.55 - 0.04 * (v - 2.3)
    x_m = (2.31 * 8.366e-3 * v**2 / 2 / 1.1e9) ** (1 / 2.31)
    x_p = x_m * (1 - 2.5 / 2.31 * e**2) * 1e6
    given = v * (1 + 0.001 * noise[0]), e * (1 + 0.003 * noise[1]), x_p * (1 + 0.01 * noise[2])
    return [(float(a), float(b), float(c)) for a, b, c in zip(*given, strict=True)]


@pytest.fixture(scope="session")
def report_of(report: Report, tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Report]:
    @cache
    def report_of(campaign: str, depth: str = "um", scale: float = 1.0) -> Report:
        if campaign == "paper":
            return report
        folder = tmp_path_factory.mktemp("campaign")
        lines = [f"test,v [m/s],e [1],x_p [{depth}]"]
        lines += [
            f"{n},{v:.6g},{e:.4g},{x * scale:.6g}" for n, (v, e, x) in enumerate(rows_of(campaign), start=1)
        ]
        (folder / "measurements.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
        toml = TOML + CARDS * (campaign == "cards")
        (folder / "report.toml").write_text(toml, encoding="utf-8")
        return Study(folder).computed

    return report_of


@pytest.fixture(scope="session")
def files_of(report_of: Callable[..., Report]) -> Callable[[str, str], dict[str, bytes]]:
    """Give `files_of(campaign, name)`: a drawing as SVG and PDF, made once for all tests."""
    return cache(lambda campaign, name: figures.files(report_of(campaign), name, ["svg", "pdf"]))


def texts_of(figure: Figure) -> list[tuple[str, Bbox]]:
    """Every text that is seen, with its place."""
    renderer = FigureCanvasAgg(figure).get_renderer()  # type: ignore[no-untyped-call]
    (axes,) = figure.axes
    ticks: set[Text] = set()
    seen: list[Text] = []
    for axis in (axes.xaxis, axes.yaxis):
        assert isinstance(axis, Axis)
        low, high = sorted(axis.get_view_interval())
        for tick in axis.get_major_ticks():
            ticks |= {tick.label1, tick.label2}
            if axes.axison and low <= tick.get_loc() <= high:
                seen.append(tick.label1)
    seen += [text for text in figure.findobj(Text) if text not in ticks and text.get_visible()]
    # An annotation's own extent would include the line that leads to it.
    boxes = ((text.get_text(), Text.get_window_extent(text, renderer)) for text in seen if text.get_text())
    hidden = {id(axes.xaxis.label), id(axes.yaxis.label)} if not axes.axison else set()
    shown = [id(text) for text in seen if text.get_text()]
    return [pair for pair, which in zip(boxes, shown, strict=True) if which not in hidden]


# ------------------------------------------------------------------------------- every campaign draws


@pytest.mark.parametrize(("campaign", "name"), PICTURES)
def test_every_drawing_draws_as_svg_and_pdf(
    files_of: Callable[[str, str], dict[str, bytes]], campaign: str, name: str
) -> None:
    svg, pdf = (files_of(campaign, name)[form] for form in ("svg", "pdf"))
    root = ElementTree.fromstring(svg)
    assert root.get("width") == f"{16 / 2.54 * 96:.0f}"
    assert len(svg) < 65_000
    assert set(re.findall(rb'https?://[^"]*', svg)) == {b"http://www.w3.org/2000/svg"}
    assert pdf.startswith(b"%PDF-")
    assert len(pdf) < 65_000


@pytest.mark.parametrize(("campaign", "name"), PICTURES)
def test_no_text_overlaps_another_or_leaves_the_page(
    report_of: Callable[..., Report], campaign: str, name: str
) -> None:
    figure = figures.draw(report_of(campaign), name)
    texts = texts_of(figure)
    assert texts
    for text, box in texts:
        assert box.x0 >= 0, text
        assert box.y0 >= 0, text
        assert box.x1 <= figure.bbox.x1, text
        assert box.y1 <= figure.bbox.y1, text
    for (one, its), (other, others) in combinations(texts, 2):
        assert not its.overlaps(others), f"{one!r} overlaps {other!r}"


@pytest.mark.parametrize("name", DRAWINGS)
def test_no_letter_is_smaller_than_8_points(report_of: Callable[..., Report], name: str) -> None:
    figure = figures.draw(report_of("paper"), name)
    assert figure.get_size_inches()[0] == pytest.approx(16 / 2.54)
    assert min(float(text.get_fontsize()) for text in figure.findobj(Text)) >= 8


def test_a_drawing_that_is_not_there_is_told(report_of: Callable[..., Report]) -> None:
    with pytest.raises(
        KeyError, match="'loop'; there are hysteresis, lankarani, loops, alpha_pairs, band, referee"
    ):
        figures.draw(report_of("paper"), "loop")


def test_every_figure_of_the_workbook_has_its_drawing() -> None:
    assert {figure.drawing for figure in WORKBOOK.figures} <= set(DRAWINGS)


# ------------------------------------------------------------------------------------------ same bytes

DIGEST = """
import hashlib
import json
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.study import Study
from loopsheet.report.views import drawing, figures
import sys
report = Study(PAPER).computed
for name in figures.drawings(report.workbook):
    files = figures.files(report, name, ["svg", "pdf"])
    print(name, *(hashlib.sha256(files[form]).hexdigest() for form in ("svg", "pdf")))
print("pyplot", "matplotlib.pyplot" in sys.modules)
"""


def test_same_bytes_in_another_process_time_zone_and_with_other_settings(
    files_of: Callable[[str, str], dict[str, bytes]], tmp_path: Path
) -> None:
    """Of what is kept of the paper; tests/outside/test_same_anywhere.py draws with nothing kept."""
    settings = tmp_path / "matplotlibrc"
    settings.write_text("font.size: 21\nlines.linewidth: 7\nsvg.fonttype: none\nsavefig.transparent: True\n")
    expected = []
    for name in DRAWINGS:
        svg, pdf = (hashlib.sha256(files_of("paper", name)[form]).hexdigest() for form in ("svg", "pdf"))
        expected.append(f"{name} {svg} {pdf}")
    expected.append("pyplot False")
    other = {"PYTHONHASHSEED": "2", "TZ": "Asia/Tokyo", "MATPLOTLIBRC": str(settings), "LC_ALL": "C"}
    run = subprocess.run(
        [sys.executable, "-W", "error", "-c", DIGEST],
        capture_output=True, text=True, check=False, env={**os.environ, **other},
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert run.stdout.splitlines() == expected
    assert run.stderr == ""


def test_what_is_drawn_once_for_all_shows_no_data(
    files_of: Callable[[str, str], dict[str, bytes]],
) -> None:
    assert FIXED == ["hysteresis", "lankarani"]
    for name in FIXED:
        assert len({tuple(files_of(which, name).items()) for which in CAMPAIGNS}) == 1, name


def test_a_drawing_as_two_files_is_that_of_each(
    report_of: Callable[..., Report], files_of: Callable[[str, str], dict[str, bytes]]
) -> None:
    for name in DRAWINGS:
        report = report_of("paper")
        svg, pdf = svg_of(report, name).encode(), pdf_of(report, name)
        assert files_of("paper", name) == {"svg": svg, "pdf": pdf}


def test_a_drawing_leaves_the_settings_of_matplotlib_alone(report_of: Callable[..., Report]) -> None:
    import matplotlib

    before = dict(matplotlib.rcParams)
    svg_of(report_of("paper"), "loops")
    assert dict(matplotlib.rcParams) == before


def test_matplotlib_loads_when_something_is_drawn() -> None:
    code = "import sys, loopsheet.report.views.figures; print('matplotlib' in sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["False"]


# ----------------------------------------------------------------------------------- what is to be seen


def words(figure: Figure) -> list[str]:
    return [text for text, _ in texts_of(figure)]


def test_every_test_and_every_pair_of_the_paper_is_named(report_of: Callable[..., Report]) -> None:
    report = report_of("paper")
    loops = words(figures.draw(report, "loops"))
    assert {"1", "2", "3", "4", "5", "approach $x$ / µm", "force $F$ / kN", "points of 10 pairs"} <= set(
        loops
    )
    assert "compression fitted to them, $α$ = 1.3023" in loops
    pairs = words(figures.draw(report, "alpha_pairs"))
    assert {f"{i}–{j}" for i, j in combinations(range(1, 6), 2)} | {"mean 1.3026"} <= set(pairs)


def test_the_lines_are_the_reports_curves(report_of: Callable[..., Report]) -> None:
    report = report_of("paper")
    (axes,) = figures.draw(report, "loops").axes
    plotted = report.plotted().values.value
    *ways, fit = axes.lines
    assert len(ways) == 5
    for name, lines in (("unloading", ways), ("loading", [fit])):
        x, y = np.hstack([np.array(line.get_data(), dtype=float) for line in lines])
        # The fitted curve is one through the points of all tests.
        order = np.argsort(plotted[f"{name}_x"], kind="stable") if lines == [fit] else slice(None)
        np.testing.assert_array_equal(x, plotted[f"{name}_x"][order] / 1e-6)
        np.testing.assert_array_equal(y, plotted[f"{name}_F"][order] / 1e3)
    (points,) = (a for a in axes.get_children() if isinstance(a, PathPatch))
    assert np.shape(points.get_path().vertices) == (2 * 500, 2)  # none of the paper's points is left out


def test_the_depth_is_shown_in_the_users_unit(report_of: Callable[..., Report]) -> None:
    (um,) = figures.draw(report_of("3"), "loops").axes
    (mm,) = figures.draw(report_of("3", "mm", 1e-3), "loops").axes
    assert (um.get_xlabel(), mm.get_xlabel()) == ("approach $x$ / µm", "approach $x$ / mm")
    assert um.get_xlim()[1] == pytest.approx(1e3 * mm.get_xlim()[1], rel=1e-4)


def test_what_is_left_out_of_the_picture_is_told(report_of: Callable[..., Report]) -> None:
    report = report_of("40")
    (told,) = (word for word in words(figures.draw(report, "loops")) if word.startswith("points of"))
    pairs, apart, points = (report.values.status[name] == 0 for name in ("alpha", "x_top", "F"))
    assert told.startswith(f"points of {np.count_nonzero(apart)} pairs, one in ")
    assert f" of {np.count_nonzero(points)} lie outside" in told
    (told,) = (word for word in words(figures.draw(report, "alpha_pairs")) if word.startswith("outside"))
    assert re.fullmatch(rf"outside the frame: [1-9]\d* of {np.count_nonzero(pairs)}", told)


@pytest.mark.parametrize(
    ("campaign", "name", "sentence"),
    [
        ("no pair", "loops", "Nothing to draw"),
        ("no pair", "alpha_pairs", "Nothing to draw"),
        ("paper", "referee", "No reachable interval"),
        ("paper", "cards_returned", "No card to draw"),
        ("paper", "cards_restitutions", "No card to draw"),
        ("paper", "cards_imprints", "No card to draw"),
    ],
)
def test_nothing_to_draw_is_said(
    report_of: Callable[..., Report], campaign: str, name: str, sentence: str
) -> None:
    (said,) = words(figures.draw(report_of(campaign), name))
    assert said.startswith(sentence)


def test_points_without_a_fit_are_drawn_alone(report_of: Callable[..., Report]) -> None:
    (axes,) = figures.draw(report_of("falling"), "loops").axes
    assert not axes.lines
    assert any(isinstance(a, PathPatch) and np.size(a.get_path().vertices) for a in axes.get_children())


def test_the_loops_are_told_apart_without_colour(report_of: Callable[..., Report]) -> None:
    """Their greys climb from the smallest loop to the largest, and stay dark enough on white."""
    (axes,) = figures.draw(report_of("paper"), "loops").axes

    def luminance(colour: Any) -> float:
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)]
        return float(np.dot(linear, [0.2126, 0.7152, 0.0722]))

    greys = [luminance(line.get_color()) for line in axes.lines[:5]]
    assert (np.diff(greys) > 0).all()
    assert all(1.05 / (grey + 0.05) >= 3 for grey in greys)


def test_lines_of_tests_at_one_speed_are_seen(tmp_path: Path) -> None:
    """They lead nowhere to the side: they have dots. What has no value has no place in a legend of panels."""
    shipped = Path(loopsheet.__file__).parent / "data" / "contact_models"
    shutil.copy(shipped / "report.toml", tmp_path)
    rows = ("test,v [m/s],e [1],x_p [um]", "1,2.0,0.55,40.0", "2,2.0,0.54,41.0\n")
    (tmp_path / "measurements.csv").write_text("\n".join(rows))
    report = Study(tmp_path).computed
    (axes,) = figures.draw(report, "imprints").axes
    assert [line.get_marker() for line in axes.lines] == ["."] * 3
    (of_all,) = figures.draw(Study(shipped).computed, "imprints").axes
    assert [line.get_marker() for line in of_all.lines] == ["None"] * 4
    (legend,) = figures.draw(report, "loops").legends
    assert "law (3) of the paper" not in {text.get_text() for text in legend.get_texts()}


def test_words_of_the_data_are_no_formulas(tmp_path: Path) -> None:
    words = ("fund $5 \\xyz{ 10$", "b_$x^2$")
    rows = tuple((word, str(x), str(y)) for word in words for x, y in ((1, 2.0), (2, 3.1), (3, 3.9)))
    folder = grouped.write(tmp_path, rows, "catalyst,x [1],y [1]", grouped.RATES)
    report = Study(folder).computed
    drawn = [figures.draw(report, each.drawing) for each in figures.of(report) if not each.fixed]
    assert drawn
    texts = {text.get_text() for figure in drawn for text in figure.findobj(Text)}
    for word in words:
        assert word.replace("$", r"\$") in texts  # as matplotlib writes dollars


NAMED = """from loopsheet import Method, let, mean, measured, plot, trace


class Named(Method, rows="coupons"):
    x = measured("m", "a length")
    y = measured("m", "a width")
    wide = let(mean(y), "mean width")
    plot(trace(x, y, "each", named=True))
"""


def test_rows_with_names_are_named_by_them(tmp_path: Path) -> None:
    rows = "specimen,x [m],y [m]\nS-17,1.0,1.1\nS-4,2.0,2.3\n"
    report = Study(method_folder(tmp_path, NAMED, rows)).computed
    (figure,) = (figures.draw(report, each.drawing) for each in figures.of(report) if not each.fixed)
    assert {"S-17", "S-4"} <= {text.get_text() for text in figure.findobj(Text)}


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_a_dot_is_round_whatever_its_axis(scale: str) -> None:
    """Its stroke is shorter than a thousandth of a pixel, over eight decades, too."""
    _, axes = drawing.page(3.0)
    axes.set_xscale(scale)
    drawing.dots(axes, np.array([1e-8, 1e-6, 1e-4, 1e-2, 1.0]), np.arange(1.0, 6.0), 3.0, "#000000")
    axes.set(xlim=(1e-9, 10), ylim=(0, 6))
    (dots,) = axes.patches
    ends = axes.transData.transform(dots.get_path().vertices).reshape(-1, 2, 2)
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert np.all((lengths > 0) & (lengths < 1e-3))
