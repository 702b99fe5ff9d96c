"""The figures that a method asks for: points, lines and levels."""

import re
import zipfile
from pathlib import Path

import pytest
from helpers import method_folder

import loopsheet.report.method.words
from loopsheet import Method, drawing, let, mean, measured, plot, trace
from loopsheet.report import build
from loopsheet.report.charts import BLUE, Series
from loopsheet.report.column import SheetError
from loopsheet.report.study import Study


def test_a_second_measured_column_is_points_with_bars() -> None:
    class Two(Method):
        """Two readings beside a line."""

        x = measured("m", "place")
        a = measured("N", "force of the first")
        b = measured("N", "force of the second")
        m = let((a + b) / 2, "mean of both")
        plot(x, a, b, m)

    (chart,) = Two.workbook.charts
    assert [(each.y, each.style, each.bars) for each in chart.series] == [
        ("a", "points", True), ("b", "points", True), ("m", "line", False),
    ]  # fmt: skip
    assert len({each.colour for each in chart.series}) == 3


def test_what_is_plotted() -> None:
    class Cooling(Method):
        """Cooling."""

        t = measured("s", "time")
        T = measured("K", "temperature")
        T_mean = let(mean(T), "mean temperature")
        later = let(T - T_mean, "temperature from the mean on")
        plot(t, T, T_mean, later, caption="Cold.", log="x")

    (chart,) = Cooling.workbook.charts
    assert [(s.x, s.y, s.style) for s in chart.series] == [
        ("t", "T", "points"),
        ("t", "T_mean", "level"),
        ("t", "later", "line"),
    ]
    left_out = " What is zero or below has no place on a logarithmic axis."
    assert (chart.log, Cooling.workbook.figures[0].caption) == ("x", f"Cold.{left_out}")


def test_a_caption_leaves_a_symbol_as_it_is() -> None:
    class Acid(Method):
        """An acid."""

        c = measured("mol/L", "concentration")
        pH = measured("1", "pH by an electrode")
        plot(c, pH)
        plot(pH, c)
        twice = let(2 * pH, "twice")

    assert [each.caption for each in Acid.workbook.figures] == [
        "pH by an electrode over concentration.", "Concentration over pH by an electrode.",
    ]  # fmt: skip


def test_of_what_is_positive_nothing_is_left_out() -> None:
    class Law(Method):
        """A power law."""

        x = measured("m", "length", positive=True)
        F = measured("N", "force")
        F_mean = let(mean(F), "mean force")
        plot(x, F, F_mean, caption="By length.", log="x")

    assert Law.workbook.figures[0].caption == "By length."


def test_how_it_looks_is_said() -> None:
    class Springs(Method):
        """Springs."""

        x = measured("m", "length")
        F = measured("N", "force")
        F_mean = let(mean(F), "mean force")
        drawing("spring", "A spring.", number="1", alt="A coil.")
        level = trace(x, F_mean, "the mean", value=F_mean)
        plot(
            trace(x, F, colour="#0072b2", named=True), level, F, labels=("stretch", ""), number="7", name="s"
        )

    drawn, shown = Springs.workbook.figures
    assert (drawn.name, drawn.fixed, drawn.chart, drawn.alt) == ("spring", True, None, "A coil.")
    assert (shown.name, shown.number, shown.caption) == ("s", "7", "Force over length.")
    assert shown.chart is not None
    assert (shown.chart.x, shown.chart.y) == ("stretch", "force")
    assert shown.chart.series == (
        Series("x", "F", "force", "points", "#0072b2", named=True),
        Series("x", "F_mean", "the mean", "level", value="F_mean"),
        Series("x", "F", "force", "points", BLUE, bars=True),
    )


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("plot()", "plot(x, y) is of two columns"),
        ("plot(x)", "plot(x, y) is of two columns"),
        ("plot(trace(m, x))", "m is a single number, which is no column to plot"),
        ("plot(trace(x, m, style='line'))", "style='line' is none of m: a level is of one number"),
        ("plot(trace(x, x, style='dots'))", "style='dots' is none of x"),
        ("plot(trace(x, x, colour='red'))", "colour='red' is none: #rrggbb, as '#0072b2'"),
        ("plot(x, x**2)", "a name of the body can be shown, no formula"),
        ("plot(x, x, log='q')", "log='q' names no axes: x, y or xy"),
        ("plot(m, x)", "m is a single number, which is no column to plot"),
    ],
)
def test_what_cannot_be_plotted(line: str, said: str) -> None:
    body = f"    x = measured('m', 'length')\n    m = let(mean(x), 'mean')\n    {line}\n"
    with pytest.raises(SheetError, match=re.escape(said)):
        exec(f"class Wrong(Method):\n{body}", {**vars(loopsheet.report.method.words)})


LENGTHS = """\
from loopsheet import Method, let, mean, measured, plot, points


class Lengths(Method, source="own", rows="readings", headline="r"):
    "A curve in SI beside readings in mm, mV and degC."
    x = measured("mm", "length", positive=True)
    V = measured("mV", "voltage", positive=True)
    T = measured("degC", "temperature")
    r = let(mean(V) / mean(x), "mean ratio", "V/m")
    h = points(0, 0.06, "length", "m")
    law = let(r * h, "law", "V")
    again = let(V * 1, "voltage again", "V")
    t = points(283.15, 323.15, "temperature", "K")
    warm = let(r * t / mean(T), "ratio", "V/m")
    ratio = let(V / x, "ratio of a reading", "V/m")
    plot(x, V, (h, law))
    plot(x, V, again)
    plot(T, ratio, (t, warm))
"""


def lengths(folder: Path, code: str = LENGTHS) -> Study:
    rows = "reading,x [mm],V [mV],T [degC]\n1,12.0,13.00,12.0\n2,25.0,26.05,25.0\n3,45.0,44.11,45.0\n"
    return Study(method_folder(folder, code, rows))


def test_what_a_workbook_draws_is_in_the_units_of_its_axes(tmp_path: Path) -> None:
    build.build(lengths(tmp_path), tmp_path / "out", ("xlsx",))
    with zipfile.ZipFile(tmp_path / "out" / "report.xlsx") as book:
        charts = [book.read(f"xl/charts/chart{n}.xml").decode() for n in (1, 2, 3)]

    def ends(chart: str, axis: str) -> list[tuple[float, float]]:
        """Of the points and of the line, the least and the greatest number as the chart has it."""
        drawn = re.findall(rf"<c:{axis}Val>.*?</c:{axis}Val>", chart, re.DOTALL)
        numbers = ([float(text) for text in re.findall(r"<c:v>([^<]*)</c:v>", each)] for each in drawn)
        return [(min(each), max(each)) for each in numbers][:2]

    law, again, warm = charts
    assert ends(law, "x") == [(12, 45), (0, 60)]
    assert ends(law, "y") == [(13, 44.11), (0, pytest.approx(60 * 83.16 / 82, rel=1e-5))]
    assert ends(again, "y") == [(13, 44.11)] * 2
    assert ends(warm, "x") == [(12, 45), (pytest.approx(10), pytest.approx(50))]


def test_what_a_curve_alone_rests_on_is_the_result(tmp_path: Path) -> None:
    report = lengths(tmp_path, LENGTHS.replace(', headline="r"', "")).computed
    assert report.workbook.headline == ("r",)
    assert {each.name for each in report.uncertain().budgets} == {"r"}
