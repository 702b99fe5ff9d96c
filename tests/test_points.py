"""Points of a curve as a line of a method: what names them has a value for each, and is drawn as a line."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers import method_folder

import loopsheet
from loopsheet.report.column import SheetError
from loopsheet.report.method import words
from loopsheet.report.study import Study

METHOD = """
from loopsheet import Method, claim, groups, let, mean, measured, plot, points, table

class Springs(Method, headline="middle"):
    "Springs of several kinds."
    x = measured("mm", "depth", positive=True)
    F = measured("N", "force", positive=True)
    spring = groups("spring")
    c = let(mean(F / x, of=spring), "stiffness", "N/mm")
    top = let(max(x, of=spring), "greatest depth", "mm")
    h = points(0, top, "depth of the curve", "mm", number=9)
    law = let(c * h, "force by the law", "N")
    mean_c = let(mean(F / x), "mean stiffness", "N/mm")
    z = points(0.5, 4, "depth of the mean curve", "mm", number=8)
    of_all = let(mean_c * z, "force by the mean law", "N")
    to = points(0, x, "depth to a reading", "mm", number=3)
    force = let(F / x * to, "force to a reading", "N")
    middle = let(mean(of_all), "mean force", "N")
    claim(of_all / z, mean_c, "the mean law is a straight line through zero")
    plot(x, F, (h, law), (z, of_all), (to, force))
"""
READINGS = [("A", 1.0, 2.0), ("A", 2.0, 4.1), ("B", 1.5, 6.1), ("B", 2.5, 10.2)]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    rows = "".join(f"{n},{word},{x},{F}\n" for n, (word, x, F) in enumerate(READINGS, start=1))
    return method_folder(tmp_path, METHOD, f"reading,spring,x [mm],F [N]\n{rows}")


def test_it_is_what_numpy_makes(folder: Path) -> None:
    values = Study(folder).computed.values.value
    x, force = np.array([reading[1:] for reading in READINGS]).T
    stiffness = (force / x).reshape(2, 2).mean(axis=1)
    every = np.linspace(0, x.reshape(2, 2).max(axis=1), 9, axis=1)
    assert 1e3 * values["h"] == pytest.approx(every.ravel(), rel=1e-15)
    assert values["law"] == pytest.approx((stiffness[:, None] * every).ravel(), rel=1e-14)
    assert 1e3 * values["z"] == pytest.approx(np.linspace(0.5, 4, 8), rel=1e-15)
    assert values["of_all"] == pytest.approx((force / x).mean() * np.linspace(0.5, 4, 8), rel=1e-14)
    assert values["force"] == pytest.approx(np.linspace(0, force, 3, axis=1).ravel(), rel=1e-14)
    assert values["middle"][0] == pytest.approx((force / x).mean() * 2.25, rel=1e-14)


def test_every_engine_computes_it(folder: Path, every_engine: Callable[..., str]) -> None:
    every_engine(folder)


def test_ends_are_parameters_and_how_many_where_rows_have_some_each(folder: Path) -> None:
    toml, more = folder / "report.toml", '[parameters]\nh_each = "3"\nz_last = "0.6 cm"\n'
    toml.write_text(toml.read_text(encoding="utf-8") + more, encoding="utf-8")
    values = Study(folder).computed.values.value
    assert values["h"].size == 6
    assert 1e3 * values["z"][[0, -1]] == pytest.approx([0.5, 6.0], rel=1e-15)


def test_points_of_a_temperature_and_what_is_taken_over_points(tmp_path: Path) -> None:
    code = """
from loopsheet import Method, given, let, mean, points

class Beam(Method):
    "Deflection of a cantilever."
    F = given("N", "force")
    L = given("m", "length", positive=True)
    EI = given("N*m^2", "bending stiffness", positive=True)
    x = points(0, L, "place", "mm", number=21)
    t = points(0, 25, "temperature", "degC", number=6)
    w = let(F * x**2 * (3 * L - x) / (6 * EI), "deflection", "mm")
    d_max = let(max(w), "largest deflection", "mm")
    d_mean = let(mean(w), "mean deflection", "mm")
"""
    method_folder(tmp_path, code, more='[parameters]\nF = "12.0 N"\nL = "1.500 m"\nEI = "210 N*m^2"\n')
    report, x = loopsheet.load(tmp_path), np.linspace(0, 1.5, 21)
    w = 12e3 * x**2 * (4.5 - x) / (6 * 210)
    assert report["t"].value == pytest.approx([0, 5, 10, 15, 20, 25], abs=1e-12)
    assert report["w"].value == pytest.approx(w)
    assert float(report["d_max"]) == pytest.approx(12e3 * 1.5**3 / (3 * 210))
    assert float(report["d_mean"]) == pytest.approx(w.mean())


def test_figures_have_them_and_no_table_does(folder: Path) -> None:
    workbook = Study(folder).computed.workbook
    (figure,) = workbook.figures
    assert figure.chart is not None
    assert [each.style for each in figure.chart.series] == ["points", "line", "line", "line"]
    assert [each.each for each in figure.chart.series] == [False, True, False, True]
    told = Study(folder).computed.workbook.tables
    assert not {"h", "law", "z", "of_all"} & {name for spec in told for name in spec.columns}


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("a = points(0, h, 'of points')", "a: its ends are points themselves, of h_points"),
        ("a = points(0, 1, 'one', number=1)", "number is a whole number from 2 to 1000, not 1"),
        ("a = points(0, top, 'another kind', 's')", "but the formula gives"),
        ("points(0, 1, 'nameless')", "'nameless' has no name"),
        ("plot(x, F, (h, F))", "h and F are no columns of the same rows: h is of the "),
        ("a = let(h * z, 'both')", "one formula names h_points or z_points"),
        ("a = let(x * z, 'both')", "one formula names readings or z_points"),
    ],
)
def test_what_is_refused(line: str, said: str) -> None:
    names: dict[str, Any] = {**vars(words), **vars(loopsheet)}
    with pytest.raises(SheetError, match=re.escape(said)):
        exec(f"{METHOD}    {line}\n", names)
