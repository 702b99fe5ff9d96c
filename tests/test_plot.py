"""The figures that a method asks for: points, lines and levels."""

import re

import pytest

import loopsheet.report.method
from loopsheet import Method, let, mean, measured, plot
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


def test_of_what_is_positive_nothing_is_left_out() -> None:
    class Law(Method):
        """A power law."""

        x = measured("m", "length", positive=True)
        F = measured("N", "force")
        F_mean = let(mean(F), "mean force")
        plot(x, F, F_mean, caption="By length.", log="x")

    assert Law.workbook.figures[0].caption == "By length."


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("plot(x, x**2)", "a name of the body can be shown, no formula"),
        ("plot(x, x, log='q')", "log='q' names no axes: x, y or xy"),
        ("plot(m, x)", "m is a single number, which is no column to plot"),
    ],
)
def test_what_cannot_be_plotted(line: str, said: str) -> None:
    body = f"    x = measured('m', 'length')\n    m = let(mean(x), 'mean')\n    {line}\n"
    with pytest.raises(SheetError, match=re.escape(said)):
        exec(f"class Wrong(Method):\n{body}", {**vars(loopsheet.report.method)})
