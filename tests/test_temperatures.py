"""Temperatures in degC have a zero of their own, their differences and uncertainties have not."""

import json
import re
from pathlib import Path

import gas
import numpy as np
import pytest

import loopsheet
from loopsheet import Method, given
from loopsheet.derivations.unit_text import UnitError, coherent, parse_unit
from loopsheet.report.cli import main
from loopsheet.report.column import SheetError
from loopsheet.report.document.charted import Words
from loopsheet.report.study import Study
from loopsheet.report.views import charts


def test_a_temperature_is_shifted_and_a_difference_is_not(tmp_path: Path) -> None:
    report = Study(gas.folder(tmp_path)).computed
    value, u = report.values.value, report.uncertain().u
    assert value["T"].tolist() == [293.15, 294.65, 269.95]
    assert value["T_0"].item() == 293.15
    assert value["dT"].item() == 1.5
    assert value["apart"] == pytest.approx([0, 1.5, -23.2], abs=1e-12)
    assert value["rho"][0] == pytest.approx(101320 / (287.05 * 293.15), rel=1e-15)
    assert u["T"].tolist() == [0.1, 0.1, 0.1]
    assert u["m"].item() == pytest.approx(0.1 / 3**0.5)
    assert [figure and figure.text for figure in report.figures("warm")] == ["21.50", "23.00", "−1.70"]
    assert report.figures("warmest")[0].text == "57.68"
    assert report.shown["apart"].unit == "delta_degC"


def test_every_engine_and_view_agrees(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """NumPy, JavaScript and LibreOffice against 50 digits, and published values in other units."""
    assert main(["check", str(gas.folder(tmp_path)), "--format", "json"]) == 0
    checks = json.loads(capsys.readouterr().out)["checks"]
    assert sum(each["kind"] == "engine" for each in checks) == 3
    assert sum(each["kind"] == "published" for each in checks) == 7
    assert main(["why", "warm[3]", str(tmp_path)]) == 0
    seen = capsys.readouterr().out
    assert "in SI     warm[3] = 1.5 + 269.95" in seen
    assert "warm[3] = -1.7 degC " in seen  # and no rounding of 271.45 - 273.15
    assert main(["show", "warm", str(tmp_path)]) == 0
    digits = re.findall(r"warm\[\d\] +(\S+)", capsys.readouterr().out)
    assert digits == ["21.5", "23.0", "-1.7"]
    assert loopsheet.load(tmp_path)["warm"].value.tolist() == [21.5, 23.0, -1.7]
    assert main(["budget", "m", str(tmp_path), "--draws", "4000"]) == 0
    told = capsys.readouterr().out
    assert "m = 12.767 degC, u = 0.058 degC" in told
    assert "acceptance limits 12.20 to 13.80 degC" in told
    assert "(equal tails; 12.7" in told
    assert "+0.1" in told.partition("equal tails")[2][:30]
    loaded = loopsheet.load(tmp_path)
    assert np.asarray(loaded["T"].value).tolist() == [20.0, 21.5, -3.2]
    assert float(loaded["m"].value) == pytest.approx(38.3 / 3)


def test_a_chart_is_drawn_in_degc(tmp_path: Path) -> None:
    report = Study(gas.folder(tmp_path)).computed
    (chart,) = report.workbook.charts
    words = Words(report)
    (_, *x), (_, *y) = charts._units(words, chart)
    (trace,) = charts.traces(words, chart, chart.series[0], [tuple(x), tuple(y)])
    assert trace.at[0] == pytest.approx([20.0, 21.5, -3.2], abs=1e-12)
    assert trace.at[1] == pytest.approx([21.5, 23.0, -1.7], abs=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("1.5 delta_degC", "1.5 degC", "declared in delta_degC: a difference is in K or delta_degC"),
        ('R = "', 'T_0 = "20 delta_degC"\nR = "', "this is a temperature, no difference: say degF or K"),
        ("u = 0.1 degC", "1 % of reading", "zero degC is not nothing: say how much, in K"),
        ("u = 0.1 degC", "u = 0.1 degC/m", "say K or delta_degC of a difference"),
        ("T [degC]", "T [delta_degC]", "this is a temperature, no difference: say degC or K"),
        ("T [degC]", "T [degc]", "did you mean 'degC'?"),
        ("T [degC]", "T [C]", "did you mean 'degC'?"),
        ("T [degC]", "T [F]", "did you mean 'degF'?"),
        ("12 .. 14 degC", "12 .. 14 C", "did you mean 'degC'?"),
        ("T [degC]", "T [kelvin*m/m*degC]", "say K or delta_degC of a difference"),
        ("3,-3.2", "3,-50.1", "between -50 and 60 degC (temperature)"),
        ("12 .. 14 degC", "12 .. 14 kg", "which does not convert to degC"),
    ],
)
def test_what_is_ambiguous_is_refused(
    tmp_path: Path, old: str, new: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (gas.TOML + gas.TABLE).count(old) == 1
    folder = gas.folder(tmp_path, gas.TOML.replace(old, new), gas.TABLE.replace(old, new))
    assert main(["build", str(folder)]) == 2
    assert said in capsys.readouterr().err


WIDTH = """\
from loopsheet import Method, given, let


class Width(Method):
    \"\"\"Of a transition, and the middle of it.\"\"\"

    D = given("K", "width")
    T = given("degC", "middle")
    W = let(D * 1, "width again", "K")
    M = let(T * 1, "middle again", like=T)
"""


def width(folder: Path, limits: str = "", guard: str = "", published: str = "W,,26.1,K") -> Path:
    toml = 'title = "W"\nworkbook = "workbook.py"\n[parameters]\nD = "26.1 K, u = 0.4 K"\nT = "20.0 degC"\n'
    toml += f'[limits]\n{limits}\n[limits.rule]\n{guard}\n[published]\nfile = "published.csv"\n'
    gas.folder(folder, toml, code=WIDTH)
    (folder / "published.csv").write_text(f"source,cell,index,value,unit\nL,{published}\n")
    return folder


NO_DIFFERENCE = "declared in K: a difference is in K or delta_degC; declare a temperature in degC"


@pytest.mark.parametrize(
    ("said", "place", "hint"),
    [
        ({"limits": 'W = "<= 20 degC"'}, "report.toml:7:5", NO_DIFFERENCE),
        ({"limits": 'W = "10 K .. 20 degC"'}, "report.toml:7:5", NO_DIFFERENCE),
        ({"limits": 'W = ">= -300 degC"'}, "report.toml:7:5", NO_DIFFERENCE),
        ({"limits": 'W = "<= 70 degF"'}, "report.toml:7:5", NO_DIFFERENCE),
        ({"limits": 'W = "<= 30 K"', "guard": 'guard = "1 degC"'}, "report.toml:9:9", NO_DIFFERENCE),
        ({"limits": 'M = "<= 25 delta_degC"'}, "report.toml:7:5", "this is a temperature, no difference"),
        ({"limits": 'M = ">= -300 degC"'}, "report.toml:7:5", "at least -273.15 degC"),
        ({"limits": 'M = ">= -20 K"'}, "report.toml:7:5", "at least 0 K"),
        ({"limits": 'M = "-460 .. 70 degF"'}, "report.toml:7:5", "at least -459.67 degF"),
        ({"published": "W,,26.1,degC"}, "published.csv:2:11", NO_DIFFERENCE),
        ({"published": "M,,20.0,delta_degC"}, "published.csv:2:11", "this is a temperature, no difference"),
        ({"published": "u(W),,0.4,degC"}, "published.csv:2:13", NO_DIFFERENCE),
    ],
)
def test_limits_and_published_values_are_in_a_unit_of_what_is_declared(
    tmp_path: Path, said: dict[str, str], place: str, hint: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["build", str(width(tmp_path, **said)), "--to", "json"]) == 2
    told = capsys.readouterr().err
    assert place in told
    assert hint in told
    assert told.count("LS4") == 1


@pytest.mark.parametrize(
    ("limits", "guard", "expected"),
    [
        ('W = "<= 30 K"', 'guard = "1 K"', 0),
        ('W = "<= 20 delta_degC"', "", 1),
        ('W = ">= -20 K"', "", 0),  # a difference may be negative
        ('M = "-10 .. 25 degC"', 'guard = "1 degC"', 0),
        ('M = "<= 19 degC"', "", 1),
        ('M = "<= 293.15 K"', "", 0),
        ('M = "0 K .. 68 degF"', 'guard = "0 delta_degC"', 0),
    ],
)
def test_a_limit_is_that_which_is_written(tmp_path: Path, limits: str, guard: str, expected: int) -> None:
    assert main(["build", str(width(tmp_path, limits, guard)), "--to", "json"]) == expected


def test_uncertainties_in_a_column_are_differences(tmp_path: Path) -> None:
    table = "reading,T [degC],u(T) [degC]\n1,293.15,0.2\n2,300,0.2\n3,301,0.3\n".replace("degC]\n", "degF]\n")
    toml = gas.TOML.replace('T = "u = 0.1 degC"\n', "")
    report = Study(gas.folder(tmp_path, toml, table.replace("293.15", "20").replace("30", "2"))).computed
    assert report.uncertain().u["T"] == pytest.approx([0.2 / 1.8, 0.2 / 1.8, 0.3 / 1.8])


@pytest.mark.parametrize(
    ("unit", "low", "said"),
    [
        ("degC", "", "at least -273.15 degC"),
        ("degF", "low=-500", "at least -459.67 degF"),
        ("degC", "low=-50, high=60", "between -50 and 60 degC"),
    ],
)
def test_nothing_is_colder_than_0_k(
    tmp_path: Path, unit: str, low: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code = gas.WORKBOOK.replace(
        '"degC", "temperature", low=-50, high=60', f'"{unit}", "temperature", {low or "low=None"}'
    )
    folder = gas.folder(tmp_path, table=gas.TABLE.replace("-3.2", "-500.0"), code=code)
    assert main(["build", str(folder)]) == 2
    told = capsys.readouterr().err
    assert "LS406" in told
    assert said in told


def test_positive_asks_above_which_zero() -> None:
    with pytest.raises(SheetError, match=r"T: above which zero\? say low=\.\.\., in degC"):

        class Wrong(Method):
            """A temperature that is positive, of one kind or the other."""

            T = given("degC", "temperature", positive=True)


@pytest.mark.parametrize(("text", "size", "zero"), [("degC", "1", "273.15"), ("°F", "5/9", "45967/180")])
def test_a_zero_is_exact_and_pints(text: str, size: str, zero: str) -> None:
    from fractions import Fraction

    import pint

    unit, registry = parse_unit(text), pint.UnitRegistry(non_int_type=Fraction)
    assert (unit.scale, unit.zero, unit.dimension) == (Fraction(size), Fraction(zero), (("K", 1),))
    for number in (0, 1, -40):
        judge = registry.Quantity(Fraction(number), text).to("kelvin").magnitude
        assert number * unit.scale + unit.zero == judge
    assert coherent(unit) == "K"


@pytest.mark.parametrize("text", ["degC/m", "W/(m^2*°C)", "degC^2", "1/degF", "m degC", "(degC)"])
def test_it_stands_by_itself(text: str) -> None:
    with pytest.raises(UnitError) as caught:
        parse_unit(text)
    assert (caught.value.code, caught.value.suggestion) == ("LS423", "say K or delta_degC of a difference")


TURNS = """\
from loopsheet import Method, count, fit, given, let, mean, measured, median, root, total, unknown


class Turns(Method, rows="readings"):
    \"\"\"Differences, some of which are not seen from their formulas alone.\"\"\"

    T = measured("degC", "temperature")
    T_ref = given("degC", "reference", default="20 degC")
    p = given("Pa", "pressure", default="101325 Pa")
    R = given("J/(kg K)", "gas constant", default="287.05 J/(kg K)")
    ratio = given("1", "ratio", default="2")
    start = given("K", "a temperature, or a difference: nobody knows", default="150 K")
    rho = let(p / (R * T), "density")
    m = let(mean(T), "mean")
    variance = let(total((T - mean(T)) ** 2) / (count() - 1), "variance")
    {line}
"""


def turned(folder: Path, line: str) -> Path:
    toml = 'title = "T"\nworkbook = "workbook.py"\n[measurements]\nfile = "measurements.csv"\n'
    return gas.folder(folder, toml, gas.TABLE, TURNS.format(line=line.replace("\n", "\n    ")))


DIFFERENCES = {
    'x = let(T - T_ref, "x", {})': 1.5,
    'x = let(m - T_ref, "x", {})': -7.233333,
    'x = let(abs(T - m), "x", {})': 8.733333,
    'x = let((T**2 - T_ref**2) / (T + T_ref), "x", {})': 1.5,
    'x = let(p / (R * rho) - mean(p / (R * rho)), "x", {})': 8.733333,
    'x = let((total((T - mean(T))**2) / (count() - 1))**0.5, "x", {})': 13.847864,
    'x = let(variance**0.5 / count()**0.5, "x", {})': 7.995068,
    'x = let(max(T) - min(T), "x", {})': 24.7,
    'x = let(T - median(T), "x", {})': 1.5,
    'y = let(T - m, "apart")\nx = let(max(y) - min(T - m, m - T), "x", {})': 17.466667,
    'y = let(T * ratio, "hot", "degC")\nx = let((y - T) / 2, "x", {})': 147.325,
}
TEMPERATURES = [
    'x = let(T + (T - T_ref) / 10, "x", {})',
    'x = let(m, "x", {})',
    'x = let(max(T), "x", {})',
    'x = let(2 * median(T) - min(T), "x", {})',
    'y = let(T + start, "hotter", "K")\nx = let(max(y) - start, "x", {})',
    'x = let(p / (R * rho), "x", {})',
    'x = let(T * ratio, "x", {})',
    'x = let(ratio * start, "x", {})',
    'x = let((T**2 - T_ref**2) / (T - T_ref) / 2, "x", {})',
]


@pytest.mark.parametrize(("line", "value"), DIFFERENCES.items())
def test_a_difference_has_no_zero(tmp_path: Path, line: str, value: float) -> None:
    report = Study(turned(tmp_path, line.format("like=T"))).computed
    assert report.shown["x"].unit == "delta_degC"
    shown = loopsheet.load(tmp_path)["x"]
    assert np.atleast_1d(shown.value)[-2 if np.ndim(shown.value) else 0] == pytest.approx(value, abs=1e-6)


@pytest.mark.parametrize("line", DIFFERENCES)
@pytest.mark.parametrize(("unit", "delta"), [("degC", "delta_degC"), ("degF", "delta_degF")])
def test_a_difference_with_a_zero_is_refused(
    tmp_path: Path, line: str, unit: str, delta: str, capsys: pytest.CaptureFixture[str]
) -> None:
    for said in (f'"{unit}"', f'display="{unit}"'):
        assert main(["build", str(turned(tmp_path, line.format(said)))]) == 2
        told = capsys.readouterr().err
        assert f"all temperatures move: it is in K or {delta}, not in {unit}" in told
        assert f"workbook.py:{16 + line.count(chr(10))}:" in told


@pytest.mark.parametrize("line", TEMPERATURES)
def test_a_temperature_keeps_its_zero(tmp_path: Path, line: str) -> None:
    report = Study(turned(tmp_path, line.format('"degC"'))).computed
    assert report.shown["x"].unit == "degC"


@pytest.mark.parametrize(
    ("formula", "unit", "refused"),
    [
        ("mean(T, of=bath)", "degC", False),
        ("max(T, of=bath)", "degC", False),
        ("mean(T, of=bath) + mean(T - T_ref)", "degC", False),
        ("mean(T, of=bath) - T_ref", "degC", True),
        ("max(T, of=bath) - min(T, of=bath)", "degC", True),
    ],
)
def test_a_mean_of_a_group_is_a_temperature(
    tmp_path: Path, formula: str, unit: str, refused: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    code = TURNS.format(line=f'bath = groups("bath")\n    x = let({formula}, "x", "{unit}")')
    toml = 'title = "T"\nworkbook = "workbook.py"\n[measurements]\nfile = "measurements.csv"\n'
    table = "reading,bath,T [degC]\n1,A,20.0\n2,A,21.5\n3,B,30.5\n"
    folder = gas.folder(tmp_path, toml, table, code.replace("given, let", "given, groups, let"))
    assert main(["show", "x", str(folder)]) == 2 * refused
    told = "".join(capsys.readouterr())
    assert ("x is a difference" in told) == refused
    assert refused or "[degC]" in told


def test_a_root_is_a_difference_or_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = 'x = unknown()\nx = root({}, 0, "x", "degC", low={}, high={})'
    assert main(["build", str(turned(tmp_path / "a", line.format("x - (m - T_ref)", -100, 100)))]) == 2
    assert "not in degC" in capsys.readouterr().err
    report = Study(turned(tmp_path / "b", line.format("x - 2 * m + T_ref", -100, 100))).computed
    assert report.shown["x"].unit == "degC"


@pytest.mark.parametrize("u", ["None", '"stated"'])
def test_what_is_left_over_of_a_fit_has_no_zero(tmp_path: Path, u: str) -> None:
    code = 't = measured("s", "time")\na = unknown("level", "degC")\nb = unknown("slope", "K/s")\n'
    code += "line = fit(T, a + b * t, u={})"
    table = "reading,T [degC],t [s]\n1,20.0,0\n2,21.5,1\n3,22.6,2\n4,24.1,3\n"
    folder = turned(tmp_path, code.format(u))
    (folder / "measurements.csv").write_text(table)
    report = Study(folder).computed
    units = {name: shown.unit for name, shown in report.shown.items() if shown.unit.endswith("degC")}
    differences = ("line_residual", "s_a", "line_s" if u == "None" else "u_T")
    assert units == {
        **dict.fromkeys(("T", "T_ref", "m", "a", "line_fitted"), "degC"),
        **dict.fromkeys(differences, "delta_degC"),
    }
