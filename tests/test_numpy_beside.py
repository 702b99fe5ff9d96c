"""Draws around which all is certain: the same as those that are asked one by one, and told where not."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from loopsheet.report.engines import numpy_beside
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.judge.bounds import EPS, RoundingBounds
from loopsheet.report.result.agreement import LIMIT
from loopsheet.report.study import Study
from loopsheet.report.uncertainty import monte_carlo

WITHOUT_ENDS = """test,v [m/s],e [1],x_p [um]
1,2.200(9),0.535(2),21.5(2)
2,3.200(9),0.510(2),32.5(2)
3,4.900(9),0.470(2),49.61
"""
AT_ONE_DEPTH = "test,v [m/s],e [1],x_p [um]\n1,2.2,0.535,22.5(4)\n2,2.4,0.525,23.5(4)\n3,4.3,0.47,44.61\n"
"""Draws of the first two tests may have no root."""
NUMBER = 20_000


def of_folder(path: Path, measurements: str) -> Any:
    (path / "measurements.csv").write_text(measurements, encoding="utf-8")
    toml = 'workbook = "soft_impact"\n[parameters]\nball_mass = "8 g"\n[measurements]\n'
    (path / "report.toml").write_text(toml + 'file = "measurements.csv"\n', encoding="utf-8")
    return Study(path).computed


def draws(report: Any, name: str) -> monte_carlo._Draws:
    return monte_carlo._Draws(report.inputs, report.values, name, 1)


def apart(report: Any, name: str, row: int, found: Any, asked: Any) -> float:
    """How far draws are from those that were asked, in units of what rounding is allowed."""
    allowed = (
        LIMIT * EPS * RoundingBounds(report.sheet, report.values.layouts, report.values.value)[name][row]
    )
    return float(np.abs(found - asked).max() / allowed)


@pytest.mark.parametrize("name", ["alpha", "alpha_mean"])
def test_the_paper_is_certain_for_all_draws(name: str) -> None:
    report = Study(PAPER).computed
    drawn = draws(report, name)
    batch = next(drawn.batches(NUMBER, NUMBER))
    assert drawn.beside is not None
    for row in range(report.values.value[name].size):
        found, known = drawn.beside.column(name, row, batch)
        asked, there = drawn._asked(batch, row)
        assert known.all()
        assert there.all()
        assert apart(report, name, row, found, asked) < 1


def test_what_is_drawn_outside_the_box_is_asked_by_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(monte_carlo, "FAR", 1.5)
    report = of_folder(tmp_path, WITHOUT_ENDS)
    drawn = draws(report, "alpha")
    batch = next(drawn.batches(NUMBER, NUMBER))
    assert drawn.beside is not None
    beside, known = drawn.beside.column("alpha", 1, batch)
    # Eight errors without ends, each within 1.5 of their standard deviations.
    assert np.count_nonzero(known) / NUMBER == pytest.approx(0.8664**8, abs=0.01)
    asked, there = drawn._asked(batch, 1)
    found, own = drawn.of(batch, 1)
    np.testing.assert_array_equal(own, there)
    np.testing.assert_array_equal(found[~known], asked[~known])
    np.testing.assert_array_equal(found[known], beside[known])
    assert apart(report, "alpha", 1, found[known], asked[known]) < 1


def test_where_a_root_may_be_missing_all_are_asked(tmp_path: Path) -> None:
    assert draws(of_folder(tmp_path, AT_ONE_DEPTH), "alpha").beside is None


def test_loops_are_not_run_beside_a_point() -> None:
    assert draws(Study(PAPER).computed, "alpha_eiv").beside is None


@pytest.mark.parametrize("share", [0.05, 10.0])
def test_a_guess_that_leads_elsewhere_is_noticed(share: float) -> None:
    report = Study(PAPER).computed
    drawn = draws(report, "alpha")
    batch = next(drawn.batches(NUMBER, NUMBER))
    asked, _ = drawn._asked(batch, 0)
    assert drawn.beside is not None
    guess = drawn.beside.guesses["alpha"]
    drawn.beside.guesses["alpha"] = numpy_beside._Guess(guess.base * (1 + share), guess.slopes, guess.value)
    found, known = drawn.beside.column("alpha", 0, batch)
    assert not known.all() or share < 1
    assert np.abs(found[known] - asked[known]).max(initial=0.0) < 1e-12
    # and what it leads to is not believed beyond what encloses the root
    narrow = numpy_beside.Intervals(guess.value.low, (guess.value.low + guess.value.high) / 2)
    drawn.beside.guesses["alpha"] = numpy_beside._Guess(guess.base, guess.slopes, narrow)
    found, known = drawn.beside.column("alpha", 0, batch)
    assert known.any()
    assert (found[known] <= narrow.high[0]).all()
    assert not known.all()


@pytest.mark.parametrize(("there", "led"), [(2.0, True), (2.1, False), (np.nan, False)])
def test_a_step_is_judged_where_it_was_longest(there: float, led: bool) -> None:
    """Of two rows for three draws: the last draw of the second row went farthest."""
    line: Any = SimpleNamespace(newton=lambda at, root: (at - root, at - root))
    here, back = np.array([[1.0, 2.0], [1.0, 2.0], [1.0, there]]), np.array([[1e-3, 0], [0, 0], [0, 0.1]])
    assert numpy_beside._led(line, here, back, [np.array([1.0, 2.0])]) is led
