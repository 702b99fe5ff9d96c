"""The figures that a method asks for: points, lines and levels."""

import re

import pytest

import loopsheet.report.method.words
from loopsheet import Method, drawing, let, mean, measured, plot, trace
from loopsheet.report.charts import BLUE, Series
from loopsheet.report.column import SheetError


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
