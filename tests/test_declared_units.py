"""Units that a method declares: SI in formulas, as they are written in everything that a reader sees."""

import json
import re
from fractions import Fraction
from pathlib import Path

import mpmath
import numpy as np
import pytest

from loopsheet import Method, given, let, measured
from loopsheet.derivations.unit_text import parse_unit
from loopsheet.report.cells.grid import factors
from loopsheet.report.cli import main
from loopsheet.report.column import SheetError
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.quantity import Bounds
from loopsheet.report.study import Study

PI = Fraction("3.1415926535897932384626433832795028841971693993751")

WORKBOOK = """\
from sympy import asin, sin, sqrt

from loopsheet import Method, given, let, mean, measured, root, unknown


class Orbit(Method, source="J Kepler", rows="places"):
    \"\"\"Units of all kinds.\"\"\"

    M = measured("deg", "mean anomaly", low=0, high=180, example="5 90")
    a = measured("mm", "length", low=0.1, high=9)
    e = given("%", "eccentricity", low=0, high=99)
    K = given("N/mm^(3/2)", "stiffness", positive=True)
    E = unknown()
    E = root(E - e * sin(E), M, "eccentric anomaly", "deg", low=M - 1, high=M + 1)
    F = let(K * a**1.5, "force", "kN")
    turned = let(asin(e), "an angle", "arcmin")
    middle = let(mean(a), "mean length", "um")
"""
TOML = """\
title = "Orbit"
workbook = "workbook.py"
[parameters]
e = "10.0 %, exact"
K = "2.0 MPa mm^0.5"
[measurements]
file = "measurements.csv"
"""


def folder(path: Path, toml: str = TOML, header: str = "place,M [deg],a [mm]", code: str = WORKBOOK) -> Path:
    (path / "workbook.py").write_text(code, encoding="utf-8")
    (path / "report.toml").write_text(toml, encoding="utf-8")
    (path / "measurements.csv").write_text(f"{header}\n1,5,4.00\n2,180,0.10\n", encoding="utf-8")
    return path


def test_formulas_have_si_and_readers_the_unit_that_was_written(tmp_path: Path) -> None:
    report = Study(folder(tmp_path)).computed
    value = report.values.value
    e, k, a = 0.1, 2e6 * 0.001**0.5, np.array([0.004, 0.0001])
    assert value["M"].tolist() == [float(PI / 36), float(PI)]
    assert value["E"][0] == pytest.approx(np.deg2rad(5.554589), abs=1e-8)  # J Meeus, Astronomical Algorithms
    assert value["F"] == pytest.approx(k * a**1.5, rel=1e-15)
    assert value["turned"].item() == pytest.approx(np.arcsin(e), rel=1e-15)
    units = {name: how.unit for name, how in report.shown.items()}
    assert units == {
        **{"M": "deg", "a": "mm", "e": "%", "K": "MPa mm^0.5", "E": "deg", "F": "kN"},
        **{"turned": "arcmin", "middle": "um"},
    }
    assert {column.name: column.unit for column in report.sheet.columns} == {
        **{"M": "1", "a": "m", "e": "1", "K": "kg*m^(-1/2)*s^-2", "E": "1", "F": "N", "turned": "1"},
        "middle": "m",
    }
    assert report.workbook.example[0] == ("place", "M [deg]", "a [mm]")


def test_every_engine_has_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(folder(tmp_path)), "--format", "json"]) == 0
    engines = [each for each in json.loads(capsys.readouterr().out)["checks"] if each["kind"] == "engine"]
    assert all(each["passed"] or each["skipped"] for each in engines)
    assert len(engines) == 3


@pytest.mark.parametrize(
    ("toml", "header", "code", "told"),
    [
        (TOML, "place,M [deg],a [inch]", "LS406", "between 0.1 and 9 mm (length)"),
        (TOML, "place,M [],a [mm]", "LS304", "the column 'M' does not name its unit"),
        (TOML, "place,M [mm],a [mm]", "LS422", "M is in 'mm', which does not convert to deg"),
        (TOML.replace("10.0 %", "10.0"), "place,M [deg],a [mm]", "LS211", '"10.0 %"'),
        (TOML.replace("10.0 %", "99.1 %"), "place,M [deg],a [mm]", "LS406", "between 0 and 99 %"),
        (
            TOML.replace("10.0 %", "10.0 prozent"),
            "place,M [deg],a [mm]",
            "LS421",
            "a unit that converts to %",
        ),
    ],
)
def test_what_is_wrong_is_told_in_that_unit(
    tmp_path: Path, toml: str, header: str, code: str, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["build", str(folder(tmp_path, toml, header))]) == 2
    err = capsys.readouterr().err
    assert f"error[{code}]" in err
    assert told in err


def test_an_angle_in_radians_is_one_in_degrees(tmp_path: Path) -> None:
    path = folder(tmp_path, TOML.replace("10.0 %", "0.1 1"), "place,M [arcmin],a [um]")
    (path / "measurements.csv").write_text("place,M [rad],a [um]\n1,1.5,4000\n2,3,100\n", encoding="utf-8")
    report = Study(path).computed
    assert report.values.value["M"].tolist() == [1.5, 3.0]
    assert report.shown["M"].unit == "rad"
    (path / "measurements.csv").write_text("place,M [rad],a [um]\n1,1.5,4000\n2,3.15,99\n", encoding="utf-8")
    assert main(["build", str(path)]) == 2  # more than 180 deg, and less than .1 mm


def test_limits_of_an_angle_name_their_unit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Without it, degrees would be read as radians."""
    limits = '[limits]\nturned = "{}"\n'
    assert main(["build", str(folder(tmp_path, TOML + limits.format("300 .. 400"))), "--to", "json"]) == 2
    told = capsys.readouterr().err
    assert "error[LS211]: the limit of turned has no unit: '300 .. 400'" in told
    (help_,) = re.findall(r'for example "(.*)"', told)
    assert main(["build", str(folder(tmp_path, TOML + limits.format(help_))), "--to", "json"]) == 0
    assert main(["build", str(folder(tmp_path, TOML + limits.format("<= 400"))), "--to", "json"]) == 2
    assert 'for example "<= 400 arcmin"' in capsys.readouterr().err
    assert main(["build", str(folder(tmp_path, TOML + limits.format("5 .. 6 deg"))), "--to", "json"]) == 0


def test_an_unknown_unit_of_a_class_is_told_at_its_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = WORKBOOK.replace('measured("mm"', 'measured("mmm"')
    assert main(["build", str(folder(tmp_path, code=code))]) == 2
    err = capsys.readouterr().err
    assert "a: the unit 'mmm' is unknown; did you mean 'mm'?" in err
    assert "workbook.py:10:5\n" in err
    with pytest.raises(SheetError, match=r"x: the unit '2' cannot be read; write a fraction as \^\(3/2\)"):

        class Wrong(Method):
            """A stroke without parentheses."""

            x = given("N/m^3/2", "stiffness")


def test_the_unit_of_a_result_must_fit_its_formula() -> None:
    with pytest.raises(SheetError, match=r"the unit is mm, in SI m, but the formula gives m\^2"):

        class Area(Method):
            """An area that is called a length."""

            x = measured("mm", "side")
            A = let(x**2, "area", "mm")


@pytest.mark.parametrize(
    ("formula", "unit"),
    [
        ("mean(share)", "%"),
        ("mean(share) - e", "%"),
        ("2 * mean(share) / 3", "1"),
        ("max(share) - min(share)", "%"),
        ("median(share) + sum(share)", "%"),
        ("share - mean(share)", "%"),
        ("mean(M)", "deg"),
        ("stdev(share)", "%"),
        ("share - 2 * stdev(share)", "1"),
        ("(share - mean(share)) / stdev(share)", "1"),
        ("sqrt(mean(share**2))", "%"),
        ("sqrt(mean(share**2 * e))", "1"),
        ("stdev(M)", "deg"),
        ("stdev(a)", "mm"),
        ("stdev(first(a) - second(a))", "mm"),
        ("sqrt(sum(a**2))", "mm"),
        ("sqrt(sum(a**2) * mean(a))", "m^(3/2)"),
        ("100 * mean(share)", "1"),
        ("1 - mean(share)", "1"),
        ("mean(share) * e", "1"),
        ("mean(share**2)", "1"),
        ("sin(M)", "1"),
        ("M * share", "1"),
        ("M - mean(share)", "1"),
    ],
)
def test_what_adds_up_per_cents_is_in_per_cent(tmp_path: Path, formula: str, unit: str) -> None:
    lines = 'share = measured("%", "a share")', "first, second = pairs()", f'W = let({formula}, "a number")'
    code = WORKBOOK.replace("given, let, mean,", "count, given, let, mean, median, pairs, stdev,").replace(
        "    F = let(", "\n".join(f"    {line}" for line in (*lines, "F = let("))
    )
    folder(tmp_path, header="place,M [deg],a [mm],share [%]", code=code)
    (tmp_path / "measurements.csv").write_text("place,M [deg],a [mm],share [%]\n1,5,4,55\n2,18,1,57\n")
    assert (Study(tmp_path).computed.shown["W"].unit or "1") == unit


@pytest.mark.parametrize("unit", ["deg", "arcsec", "mm^(3/2)"])
@pytest.mark.parametrize("end", [0.1, 7, 90, 180, -33.3])
def test_an_end_that_is_no_double_still_allows_itself(unit: str, end: float) -> None:
    scale = parse_unit(unit).scale
    exact = Fraction(repr(end)) * scale
    for bounds in (Bounds(high=end).within(scale), Bounds(low=end).within(scale)):
        assert bounds.allow(exact)
        assert bounds.allow(float(exact))
        assert bounds.said(unit) == str(Bounds(bounds.low and end, bounds.high and end)) + f" {unit}"
    assert not Bounds(high=end).within(scale).allow(exact + abs(exact) * Fraction(1, 10**15))
    assert Bounds(0.1, 7).within(Fraction(1, 1000)) == Bounds(0.0001, 0.007)


@pytest.mark.parametrize("unit", ["deg", "arcsec", "mm^(3/2)", "rpm"])
def test_a_spreadsheet_can_read_the_size_of_a_unit(unit: str) -> None:
    scale, found = parse_unit(unit).scale, Fraction(1)
    for part in factors(scale)[0].replace("/", " /").replace("*", " *").split():
        assert len(part[1:].rstrip("0")) <= 15
        found = found * int(part[1:]) if part[0] == "*" else found / int(part[1:])
    assert abs(found / scale - 1) < Fraction(1, 10**25)


def test_the_shipped_examples_are_what_an_independent_solution_says() -> None:
    """Of every digit, where the publication prints some."""
    kepler, pipe, spheres = (Study(PAPER.parent / name).computed for name in ("kepler", "colebrook", "hertz"))
    with mpmath.workdps(50):
        m = mpmath.radians(5)
        for row, e in enumerate(["0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "0.99"]):
            found = mpmath.findroot(
                lambda x, e=e: x - mpmath.mpf(e) * mpmath.sin(x) - m, (m, m + 1), "anderson"
            )
            assert kepler.values.value["E"][row] == float(found)

        def residual(f: mpmath.mpf) -> mpmath.mpf:
            inside = mpmath.mpf("1e-4") / mpmath.mpf("3.7") + mpmath.mpf("2.51") / (100_000 * mpmath.sqrt(f))
            return 1 / mpmath.sqrt(f) + 2 * mpmath.log10(inside)

        assert pipe.values.scalar("f") == float(mpmath.findroot(residual, (0.01, 0.03), "anderson"))
        e_c, r_c, h = (
            mpmath.mpf(2e10) / 2 / (1 - mpmath.mpf("0.09")),
            mpmath.mpf("0.025"),
            mpmath.mpf("0.004"),
        )
        assert spheres.values.scalar("sigma") == float(-2 * e_c / mpmath.pi * mpmath.sqrt(h / r_c))
    assert (spheres.shown["K"].unit, spheres.sheet["K"].unit) == ("N/m^(3/2)", "N/m^(3/2)")
