"""Formulas of rows that name what there is of a row's group: each reading less the mean of its specimen."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import grouped
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import loopsheet
from loopsheet.report.cli import main
from loopsheet.report.engines import exact, numpy
from loopsheet.report.method import words
from loopsheet.report.sheet import Sheet
from loopsheet.report.study import Study

CROSSED = """
from loopsheet import Method, groups, let, mean, measured, pairs

class Crossed(Method, headline="scatter"):
    "Two-way layout."
    y = measured("mm", "reading")
    lab = groups("lab", size="labs")
    day = groups("day", index="h", size="days")
    t = let(mean(y, of=lab), "mean of a lab", like=y)
    v = let(mean(y - t, of=day), "effect of a day", like=y)
    left = let(y - t - v, "reading without its lab and its day", like=y)
    scaled = let(left / t, "the same as a part of its lab's mean")
    scatter = let(sum((y - t - v) ** 2), "sum of squares", "mm^2")
    by_lab = let(sum((y - v) ** 2, of=lab), "squares of a lab without the days", "mm^2")
    first, second = pairs()
    apart = let(first(y - t) - second(y - t), "difference of two", like=y)
"""


def sheet() -> Sheet:
    names: dict[str, Any] = {**vars(words), **vars(loopsheet)}
    exec(CROSSED, names)
    found: Sheet = names["Crossed"].workbook.sheet(())
    return found


SHEET = sheet()


def expected(y: Any, lab: Any, day: Any) -> dict[str, Any]:
    """The same in plain NumPy."""
    labs, at = np.unique(lab, return_inverse=True)
    days, on = np.unique(day, return_inverse=True)
    t = np.array([y[lab == each].mean() for each in labs])
    v = np.array([(y - t[at])[day == each].mean() for each in days])
    left = y - t[at] - v[on]
    first, second = np.triu_indices(y.size, 1)
    by_lab = np.array([((y - v[on])[lab == each] ** 2).sum() for each in labs])
    own = {"left": left, "scaled": left / t[at], "scatter": (left**2).sum(), "by_lab": by_lab}
    return own | {"t": t, "v": v, "apart": (y - t[at])[first] - (y - t[at])[second]}


READINGS = st.lists(
    st.tuples(st.integers(1000, 9000), st.integers(1, 5), st.integers(1, 4)), min_size=2, max_size=9
)


@settings(deadline=None, max_examples=60)
@given(READINGS)
def test_random_groupings_are_what_plain_numpy_makes_of_them(readings: list[tuple[int, int, int]]) -> None:
    y, lab, day = (np.array(each) for each in zip(*readings, strict=True))
    labels = {"readings": range(1, y.size + 1), "readings_by_lab": lab, "readings_by_day": day}
    labels = {name: [int(each) for each in own] for name, own in labels.items()}
    data = {"y": y / 1e3}
    by_numpy = numpy.evaluate(SHEET, labels, data).value
    judged = exact.evaluate(SHEET, labels, {"y": [float(each) for each in y / 1e3]}).value
    for name, known in expected(y / 1e3, lab, day).items():
        assert by_numpy[name] == pytest.approx(np.ravel(known), rel=0, abs=1e-12), name
        assert [float(each) for each in judged[name]] == pytest.approx(np.ravel(known), rel=0, abs=1e-12)


def crossed(path: Path, seed: int = 5) -> tuple[Path, Any, Any, Any]:
    """A folder of readings whose labs and days are drawn."""
    dice = np.random.default_rng(seed)
    lab, day = dice.integers(0, 4, 23), dice.integers(0, 3, 23)
    y = dice.normal(5, 0.4, 23).round(3)
    rows = tuple((f"L{a}", f"D{b}", f"{each:.3f}") for a, b, each in zip(lab, day, y, strict=True))
    more = '[uncertainty]\ny = "u = 0.2 mm"\n'
    return grouped.write(path, rows, "lab,day,y [mm]", CROSSED, more), y, lab, day


def test_every_engine_finds_the_group_of_a_row(tmp_path: Path, every_engine: Callable[..., str]) -> None:
    folder, y, lab, day = crossed(tmp_path)
    every_engine(folder)
    found = Study(folder).computed.values.value["left"]
    assert found * 1e3 == pytest.approx(expected(y, lab, day)["left"], abs=1e-12)


def test_its_uncertainty_knows_that_a_reading_is_in_the_mean_of_its_group(tmp_path: Path) -> None:
    folder, y, lab, day = crossed(tmp_path)
    sure = Study(folder).computed.uncertain().u["left"]
    moved = np.array([expected(y + step, lab, day)["left"] for step in np.eye(y.size)])
    slopes = moved - expected(y, lab, day)["left"]  # it is linear
    assert sure * 1e3 == pytest.approx(0.2 * np.sqrt((slopes**2).sum(axis=0)), rel=1e-10)


def test_draws_follow_the_group_of_a_row(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder, *_ = crossed(tmp_path)
    u = Study(folder).computed.uncertain().u["left"][4] * 1e3
    assert main(["budget", "left[5]", str(folder), "--draws", "20000"]) == 0
    found = re.search(r"Monte Carlo, 20000 draws: median \S+ mm, u = ([\d.]+) mm", capsys.readouterr().out)
    assert found is not None
    assert float(found[1]) == pytest.approx(u, rel=0.03)


def test_it_is_told_of_which_group(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = grouped.write(tmp_path)
    assert main(["why", "off[6]", str(folder)]) == 0
    assert re.search(r"rests on +y\[6\] = 2.75 mm, level\[B\] = 2.50* mm\n", capsys.readouterr().out)
    assert main(["why", "level[2]", str(folder)]) == 0
    used = capsys.readouterr().out
    assert ("off[2]" in used, "off[6]" in used, "off[1]" in used) == (True, True, False)


def test_a_root_names_the_group_of_its_row(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    more = '    q = unknown()\n    q = root(q**3 + q, y / level, "root", low=0, high=5)\n'
    code = (grouped.METHOD + more).replace("import total, unknown", "import root, total, unknown")
    folder = grouped.write(tmp_path, code=code)
    assert main(["check", str(folder)]) == 0, capsys.readouterr().out
    values = Study(folder).computed.values.value
    assert values["q"] ** 3 + values["q"] == pytest.approx(values["off"], rel=1e-14)
