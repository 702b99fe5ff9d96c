"""Draws in the background of the page, after an edit: beside those of the report's own Monte Carlo."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import driving
import numpy as np
import pytest
from driving import Live
from helpers import method_folder
from scipy import stats

from loopsheet.report.cli import main
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.monte_carlo import _Draws

Open = Callable[..., Live]

DRAWS = 500
SURE = 5.0
"""Standard deviations: what the page draws is always the same, but for this test it is as good as any."""

# What the page's own worker gives for a message of ours.
ASK = """(message) => new Promise((resolve, reject) => {
  const text = document.querySelector("script:not([type])").textContent;
  const worker = new Worker(URL.createObjectURL(new Blob([text], { type: "text/javascript" })));
  worker.onerror = ({ message }) => reject(message);
  worker.onmessage = ({ data }) => resolve(data.found.map((one) => Array.from(one)));
  worker.postMessage({ ...message, names: message.cells.map(() => message.names) });
})"""


@pytest.fixture
def draws_at_once() -> bool:
    return True


def drawn(report: Report, name: str, label: tuple[int, ...] = (), size: int = 20_000) -> np.ndarray[Any, Any]:
    """As many draws of a cell as NumPy makes; NaN where it has no value."""
    draws = _Draws(report.inputs, report.values, name, seed=2)
    row = report.values.row(report.values.sheet[name], label)
    (batch,) = draws.batches(size, size)
    own, there = draws.of(batch, row)
    return np.where(there, own, np.nan)


def shown(live: Live, name: str, index: str = "") -> Mapping[str, float | list[float]]:
    """What draws told of the cell in the formula bar, in SI, when they have come."""
    page, cell = live.page, f'#formula-bar[data-cell="{name}"][data-index="{index}"]'
    live.page.locator(f'main [data-cell="{name}"][data-index="{index}"]').first.click()
    page.wait_for_selector(f"{cell} #bar-draws[data-u]")
    found = page.locator("#bar-draws").evaluate("({ dataset }) => ({ ...dataset })")
    return {
        "u": float(found["u"]),
        "lost": float(found["lost"]),
        "ends": [float(end) for end in found["ends"].split(",") if end],
    }


def agrees(found: Mapping[str, Any], ours: np.ndarray[Any, Any]) -> None:
    """Both told of one distribution, as far as so few draws can say."""
    known = ours[~np.isnan(ours)]
    lost = np.isnan(ours).mean()
    assert abs(found["lost"] - DRAWS * lost) <= SURE * math.sqrt(DRAWS * lost * (1 - lost)) + 1e-9
    number = DRAWS - found["lost"]
    # The standard deviation of a variance goes with the fourth moment.
    wide = math.sqrt((stats.kurtosis(known, fisher=False) - 1) / (4 * number))
    assert found["u"] / known.std(ddof=1) == pytest.approx(1, abs=SURE * wide)
    # How many draws lie below an end is binomial, whatever the distribution.
    for share, end in zip((0.025, 0.975), found["ends"], strict=True):
        assert stats.binomtest(round(share * number), int(number), float((known < end).mean())).pvalue > 1e-6


@pytest.fixture(scope="module")
def edited(tmp_path_factory: pytest.TempPathFactory) -> Report:
    tests = driving.edited({("x_p", 2): "29.9", ("v", 1): "2.33"})
    return Study(driving.write(tmp_path_factory.mktemp("draws") / "paper", tests)).computed


@pytest.mark.parametrize("cell", ["alpha_eiv", "chi2_eiv", "alpha_median", "alpha-2-4", "C_log"])
def test_draws_tell_what_the_monte_carlo_of_the_report_tells(live: Live, edited: Report, cell: str) -> None:
    live.type("x_p", 2, "29.9")
    live.type("v", 1, "2.33")
    name, *label = cell.split("-")
    found = shown(live, name, "-".join(label))
    assert len(found["ends"]) == 2  # type: ignore[arg-type]
    agrees(found, drawn(edited, name, tuple(map(int, label))))


def test_the_panel_has_the_interval_of_every_result(live: Live) -> None:
    assert live.page.locator("#live-panel td span").count() == 0
    live.type("x_p", 2, "29.9")
    found = live.page.locator("#live-panel td span").filter(has_text=re.compile(r"\d … \d"))
    found.nth(3).wait_for()
    texts = found.all_text_contents()
    assert len(texts) == 4
    for text in texts:
        low, high = (float(end.split("\u00a0")[0]) for end in text.split(" … "))
        assert low < high


def test_the_panel_has_no_first_order_where_tails_are_too_long_for_u(live: Live) -> None:
    """Coarse depths: the coefficient goes over decades."""
    for test, depth in enumerate(("23", "30", "40", "20", "40"), start=1):
        live.type("x_p", test, depth)
    row = live.page.locator("#live-panel tbody tr").nth(1)
    row.get_by_text("…", exact=False).filter(has_text=re.compile(r"\d … \d")).wait_for()
    assert "draws differ" in row.inner_text()
    live.page.locator('[data-cell="C_eiv"]').first.click()
    live.page.wait_for_selector('#bar-draws[data-u="NaN"]')


FEW = """from loopsheet import Method, let, mean, measured


class Few(Method, rows="readings", headline="V"):
    "Readings whose uncertainty is known with few degrees of freedom: a t distribution deviates by 1.6 u."
    v = measured("V", "reading")
    V = let(mean(v), "voltage", "V")
"""


def test_errors_of_few_degrees_of_freedom_leave_the_panel_its_uncertainty(
    open_page: Open, tmp_path: Path
) -> None:
    stated = '[uncertainty]\nv = "u = 0.1 V, dof = 3"\n'
    method_folder(tmp_path, FEW, "reading,v [V]\n1,9.31\n2,9.42\n3,9.28\n", stated)
    main(["build", str(tmp_path), "--out", str(tmp_path / "out")])
    live = open_page(tmp_path / "out" / "report.html")
    live.type("v", 2, "9.43")
    row = live.page.locator("#live-panel tbody tr").first
    row.get_by_text(re.compile(r"\d … \d")).wait_for()
    assert row.inner_text().split("\t")[-1].startswith("9.340 (58)"), row.inner_text()
    assert "draws differ" not in row.inner_text()


def test_the_same_edit_draws_the_same(open_page: Open) -> None:
    pages = open_page(own=True), open_page(own=True)
    for live in pages:
        live.type("x_p", 2, "29.8")
    one, other = (shown(live, "alpha_mean") for live in pages)
    assert one == other


def test_the_next_edit_ends_what_was_begun(live: Live) -> None:
    live.type("x_p", 2, "29.9")
    live.page.wait_for_timeout(250)
    assert len(live.page.workers) <= 1
    live.type("x_p", 2, "29.7")  # as issued
    again = shown(live, "alpha_eiv")
    assert live.page.workers == []
    assert again["ends"][0] < 1.3013 < again["ends"][1]  # type: ignore[index]


def test_draws_without_a_value_are_counted(live: Live, tmp_path: Path) -> None:
    edits = {("x_p", 5): "46"}  # as deep as the test before, give or take the digit
    live.type("x_p", 5, "46")
    report = Study(driving.write(tmp_path / "near", driving.edited(edits))).computed
    ours = drawn(report, "alpha", (4, 5))
    assert 0.025 < np.isnan(ours).mean() < 1
    found = shown(live, "alpha", "4-5")
    assert found["ends"] == []
    lost = np.isnan(ours).mean()
    assert abs(found["lost"] - DRAWS * lost) < SURE * math.sqrt(DRAWS * lost * (1 - lost))  # type: ignore[operator]
    assert "too many without a value" in live.text("bar-draws")


def test_draws_over_other_rows_than_the_estimate_are_counted(live: Live, tmp_path: Path) -> None:
    """A restitution of 0 cannot be less: half of the draws have a test less to fit."""
    live.type("e", 1, "0.000")
    report = Study(driving.write(tmp_path / "zero", driving.edited({("e", 1): "0.000"}))).computed
    ours = drawn(report, "alpha_eiv")
    assert np.isnan(ours).mean() == pytest.approx(0.5, abs=0.02)
    found = shown(live, "alpha_eiv")
    assert found["ends"] == []
    assert abs(found["lost"] - DRAWS / 2) < SURE * math.sqrt(DRAWS) / 2
    assert "without a value over these rows" in live.text("bar-draws")


def test_a_browser_without_workers_says_so(open_page: Open) -> None:
    live = open_page(own=True)
    live.page.add_init_script("delete self.Worker")
    live.load()
    live.type("x_p", 2, "29.9")
    live.page.locator('main [data-cell="alpha_eiv"]').first.click()
    live.page.wait_for_selector("#bar-draws:has-text('no page draw')")
    assert "u = 0.0031" in live.text("bar-sure")


SHAPES = {
    "normal": stats.norm(),
    "rectangular": stats.uniform(-math.sqrt(3), 2 * math.sqrt(3)),
    "triangular": stats.triang(0.5, -math.sqrt(6), 2 * math.sqrt(6)),
    "arcsine": stats.arcsine(-math.sqrt(2), 2 * math.sqrt(2)),
    "t": stats.t(4.5),
}


def test_errors_are_drawn_from_what_was_stated(live: Live) -> None:
    """Speeds of tests are drawn alone, in every shape, and come back as they are."""
    shapes = list(SHAPES)
    errors = [
        {"moves": [["v", n, 0.01]], "shape": shape} | ({"dof": 4.5} if shape == "t" else {})
        for n, shape in enumerate(shapes)
    ]
    found = asked(live, errors, [], [["v", n] for n in range(5)])
    for shape, own in zip(shapes, found, strict=True):
        assert stats.kstest((np.array(own) - 1) / 0.01, SHAPES[shape].cdf).pvalue > 1e-4, shape


def asked(live: Live, errors: Any, pairs: Any, cells: Any, count: int = 4000) -> list[list[float]]:
    """What the worker draws of speeds of 1 m/s, and of what rests on nothing else."""
    tests = [[1.0] * 5, [0.5] * 5, [1e-5] * 5]
    data = dict(zip(("v", "e", "x_p"), tests, strict=True))
    data |= {"beta": [1.5], "ball_diameter": [0.01], "ball_density": [7800.0], "points_per_pair": [2]}
    message = {
        "count": count,
        "labels": {"tests": [1, 2, 3, 4, 5]},
        "data": data,
        "errors": errors,
        "pairs": pairs,
        "cells": cells,
        "names": ["v", "e", "x_p", "v_0", "beta", "ball_diameter", "ball_density", "points_per_pair"],
    }
    found: list[list[float]] = live.page.evaluate(ASK, message)
    return found


@pytest.mark.parametrize("r", [-1.0, -0.6, 0.0, 0.9, 1.0])
def test_correlated_errors_are_drawn_together(live: Live, r: float) -> None:
    """The mean of five speeds, two of them correlated, has the variance of the law of propagation."""
    errors = [{"moves": [["v", n, 0.01]], "shape": "rectangular"} for n in (1, 3)]
    (mean,) = asked(live, errors, [[0, 1, r]], [["v_0", 0]])
    wanted = 0.01 * math.sqrt(2 + 2 * r) / 5
    assert np.std(mean) == pytest.approx(wanted, rel=SURE / math.sqrt(2 * len(mean)), abs=1e-10)


def test_errors_of_one_sample_are_wrong_together(live: Live) -> None:
    """The mean of five readings of one sample has the t distribution of the sample (JCGM 101, 6.4.9)."""
    errors = [{"moves": [["v", n, 0.01]], "shape": "t", "dof": 3, "sample": "v 0"} for n in range(5)]
    (mean,) = asked(live, errors, [], [["v_0", 0]])
    scaled = (np.array(mean) - 1) / (0.01 / math.sqrt(5))
    assert stats.kstest(scaled, stats.t(3).cdf).pvalue > 1e-4
    for error in errors:
        del error["sample"]
    (apart,) = asked(live, errors, [], [["v_0", 0]])
    assert stats.kstest((np.array(apart) - 1) / (0.01 / math.sqrt(5)), stats.t(3).cdf).pvalue < 1e-4
