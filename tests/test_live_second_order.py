"""The terms of second order that the page's worker finds: those of a build of what stands there."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest
import test_far_from_linear as far
from test_digits import CAMPAIGNS
from test_live_uncertain import EXAMPLES, of_page

from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.result import Report
from loopsheet.report.sheet import Given
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.propagation import Spread
from loopsheet.report.views import live, live_uncertain

SCRIPTS = (*live.ALONE, "numbers.js", "inputs.js", "trace.js", "coverage.js")
SCRIPTS += ("readings.js", "sure.js", "cells.js")
HARNESS = """
const tables = Object.fromEntries(Object.entries(LIVE.tables).map(([axis, { rows }]) => [axis, rows]));
const state = { tables, parameters: { ...LIVE.parameters, ...EDITS } };
const trace = new Trace(PROGRAM, LIVE.columns, computeSheet(PROGRAM, LIVE.columns, state));
const look = new Look(trace, state, null), { errors, pairs } = look.sure, { labels, data } = trace.sheet;
const names = ASKED.map(([name]) => [name, ...trace.ancestors(name)]);
const rough = ASKED.map(([name]) => LIVE.columns[name].rough ?? 0);
const more = secondOrder({ labels, data, errors, pairs, cells: ASKED, names, rough });
ASKED.forEach((cell, n) => look.sure.learn(cell, more[n]));
const found = ASKED.map(([name, row], n) => {
  const { u, factor } = look.sure.budget(name, row);
  return { more: more[n], u, factor };
});
console.log(JSON.stringify(found, (_, value) => Number.isNaN(value) ? null : value));
"""
Cell = tuple[str, int]
Told = Callable[[Report, list[Cell], dict[str, str]], list[dict[str, float | None]]]


@pytest.fixture(scope="module")
def told(require: Callable[..., str]) -> Told:
    """What the worker's scripts find for some cells, after an edit of parameters."""

    def run(report: Report, cells: list[Cell], edits: dict[str, str]) -> list[dict[str, float | None]]:
        known = {"self": {"document": 1}, "EDITS": edits, "ASKED": cells}
        found: list[dict[str, float | None]] = of_page(require("node"), report, known, SCRIPTS, HARNESS)
        return found

    return run


def asked_of(report: Report) -> list[Cell]:
    """The cells of the headline that have a value and of which the page can tell an uncertainty."""
    spread, values = Spread(report.inputs, report.values), report.values
    every = [(name, row) for name in report.workbook.headline for row in range(len(values.status[name]))]
    return [
        (name, row)
        for name, row in every
        if not values.status[name][row]
        and spread.knows(name)
        and not isinstance(values.sheet[name].rule, Given)
        and not values.sheet[name].is_u
    ]


def agrees(found: list[dict[str, float | None]], report: Report, cells: list[Cell]) -> int:
    """Whether every cell has the terms, u and k of a build; how many terms count."""
    spread = Spread(report.inputs, report.values)
    for (name, row), own in zip(cells, found, strict=True):
        budget = spread.budget(name, row)
        if budget.unlooked:
            assert own["more"] is None, (name, row, budget.unlooked)
            continue
        # The page's slopes are of doubles a little apart: of 50 mm that are known to 35 nm, to some 1e-6, and
        # 256 times that is what their changes are off by. U has two digits.
        assert own["more"] == pytest.approx(budget.second, rel=2e-3, abs=0), (name, row)
        assert own["u"] == pytest.approx(budget.u, rel=1e-4, abs=0)
        if math.isfinite(budget.factor) and budget.u:
            assert own["factor"] == pytest.approx(budget.factor, rel=1e-3)
    return sum(bool(own["more"]) for own in found)


@pytest.mark.parametrize("name", [*CAMPAIGNS, *EXAMPLES])
def test_as_issued(told: Told, tmp_path: Path, name: str) -> None:
    report = Study(CAMPAIGNS[name](tmp_path) if name in CAMPAIGNS else PAPER.parent / name).computed
    if live_uncertain.follows(report) and (cells := asked_of(report)):
        agrees(told(report, cells, {}), report, cells)


@pytest.mark.parametrize(
    ("folder", "name", "old", "new", "counts"),
    [
        ("gum_h1", "theta", "-0.1 K", "-4 K", 0),  # what is linear in dalpha is most of it now
        ("gum_h1", "dtheta", "0 K", "0.5 K", 1),
        ("ea_s4", "t", "0 K", "0.3 K", 1),
        ("ea_s4", "dalpha", "0 K^-1", "20e-6 K^-1", 0),
    ],
)
def test_an_edit_is_a_rebuild(
    told: Told, tmp_path: Path, folder: str, name: str, old: str, new: str, counts: int
) -> None:
    place = copytree(PAPER.parent / folder, tmp_path / "edited", ignore=lambda *_: ["out"])
    before, toml = Study(place).computed, (place / "report.toml").read_text(encoding="utf-8")
    (place / "report.toml").write_text(toml.replace(f'{name} = "{old}', f'{name} = "{new}'), encoding="utf-8")
    after = Study(place).computed
    cells = asked_of(after)
    assert cells == asked_of(before)
    assert agrees(told(before, cells, {name: new.split(maxsplit=1)[0]}), after, cells) == counts


def test_correlated_errors_bend_together(told: Told, tmp_path: Path) -> None:
    """Of a product of two that are zero: of what both have in common, and of what is each one's own."""
    place = copytree(PAPER.parent / "ea_s4", tmp_path / "tied", ignore=lambda *_: ["out"])
    toml = (place / "report.toml").read_text(encoding="utf-8")
    path = place / "report.toml"
    alone = Study(place).computed
    path.write_text(toml + '\n[uncertainty.correlation]\n"t, dalpha" = "0.6"\n', encoding="utf-8")
    tied = Study(place).computed
    cells = asked_of(tied)
    found = told(tied, cells, {})
    assert agrees(found, tied, cells) == 1
    assert not np.isclose(found[0]["more"], told(alone, cells, {})[0]["more"], rtol=0.1, atol=0)


@pytest.mark.parametrize("formula", far.CASES)
def test_far_from_linear_it_is_told_what_a_build_tells(told: Told, tmp_path: Path, formula: str) -> None:
    """Where a build does not know either, because of a corner or of third order, the page does not."""
    report = Study(far.folder(tmp_path, formula, *far.CASES[formula][:-1])).computed
    assert agrees(told(report, [("c", 0)], {}), report, [("c", 0)]) == 0
