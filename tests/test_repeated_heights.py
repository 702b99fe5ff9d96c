"""Two tests at nearly one speed tell no exponent: their pair is in no average and no fit, which is told."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from slipped_campaigns import Texts, write

from loopsheet.report.cells.values import Status, Values
from loopsheet.report.cli import main
from loopsheet.report.engines.numpy import evaluate
from loopsheet.report.result.result import Report
from loopsheet.report.sheet import Given, Sheet
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.propagation import Spread
from loopsheet.report.workbooks.soft_impact import APART, NEAR

HEIGHTS: Texts = {
    "v": ("2.200", "2.222", "3.100", "3.131", "4.300", "4.343"),
    "e": ("0.5344", "0.5337", "0.5015", "0.4993", "0.4706", "0.4711"),
    "x_p": ("22.60", "22.83", "32.06", "32.50", "44.55", "44.93"),
}
"""Three heights, two tests of each, one per cent apart in speed."""
SAME = ((1, 2), (3, 4), (5, 6))
TOLD = [pair for pair in combinations(range(1, 7), 2) if pair not in SAME]
FITTED = ("alpha_mean", "alpha_median", "alpha_log", "C_log", "alpha_lin", "C_lin")


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Report:
    return Study(write(tmp_path_factory.mktemp("heights"), HEIGHTS)).computed


def exponents(values: Values) -> dict[tuple[int, ...], float]:
    return {cell.label: cell.value or math.nan for cell in values.cells("alpha")}


def with_every_pair(report: Report) -> Values:
    """What comes out where no pair is left out."""
    open_ones = (replace(c, requires=()) if c.name == "x_top" else c for c in report.sheet.columns)
    data = {c.name: report.values.value[c.name] for c in report.sheet.columns if isinstance(c.rule, Given)}
    return evaluate(Sheet(tuple(open_ones)), {"tests": report.inputs.only.tests}, data)


def test_every_exponent_has_a_value_and_averages_are_of_those_that_tell_one(report: Report) -> None:
    values, alpha = report.values, exponents(report.values)
    assert all(map(math.isfinite, alpha.values()))
    told = [alpha[pair] for pair in TOLD]
    assert values.scalar("alpha_mean") == pytest.approx(np.mean(told), rel=1e-14)
    assert values.scalar("alpha_median") == pytest.approx(np.median(told), rel=1e-14)
    forces = [values.cell("Cprime_2", pair).value for pair in TOLD]
    assert values.scalar("F_ref") == pytest.approx(np.mean(forces), rel=1e-14)  # type: ignore[arg-type]
    assert all(
        values.counted[name] == {"pairs": 12} for name in ("alpha_mean", "alpha_median", "F_ref", "x_ref")
    )
    assert all(values.counted[name] == {"points": 24} for name in ("alpha_log", "alpha_lin", "C_lin"))


def test_fits_go_through_the_points_of_those_pairs_alone(report: Report) -> None:
    values = report.values
    points = {
        name: [cell.value for cell in values.cells(name) if cell.label[:2] in TOLD] for name in ("x", "F")
    }
    slope, intercept = np.polyfit(np.log(points["x"]), np.log(points["F"]), 1)  # type: ignore[arg-type]
    assert values.scalar("alpha_log") == pytest.approx(slope, rel=1e-9)
    assert values.scalar("C_log") == pytest.approx(np.exp(intercept), rel=1e-8)
    assert all(
        (cell.status is Status.OK) == (cell.label[:2] in TOLD)
        for name in ("x", "F", "ln_x", "ln_F")
        for cell in values.cells(name)
    )
    every = with_every_pair(report)
    assert all(abs(every.scalar(name) / values.scalar(name) - 1) > 5e-4 for name in FITTED)


def test_uncertainties_are_those_of_the_pairs_that_count(report: Report) -> None:
    """By differences: each printed number moved by its own standard uncertainty."""
    data = {c.name: report.values.value[c.name] for c in report.sheet.columns if isinstance(c.rule, Given)}
    moved = []
    for name in ("v", "e", "x_p"):
        for row in range(6):
            u = data[f"u_{name}"][row]
            ends = [
                evaluate(
                    report.sheet,
                    {"tests": report.inputs.only.tests},
                    data | {name: data[name] + sign * u * (np.arange(6) == row)},
                ).scalar("alpha_mean")
                for sign in (1, -1)
            ]
            moved.append((ends[0] - ends[1]) / 2)
    # The ball and the number of points do not move an exponent.
    assert report.uncertain().u["alpha_mean"][0] == pytest.approx(np.linalg.norm(moved), rel=1e-3)


def test_all_engines_agree(
    report: Report, require: Callable[..., str], capsys: pytest.CaptureFixture[str]
) -> None:
    """And a campaign of which nothing but a warning is told is as expected."""
    require("node")
    require("soffice", "libreoffice")
    assert main(["check", str(report.inputs.folder)]) == 0
    out = capsys.readouterr().out
    assert [line.split()[1] for line in out.splitlines() if line.startswith("engine ")] == [
        "numpy", "JavaScript", "xlsx",
    ]  # fmt: skip


def test_the_pairs_are_named_once_and_accuse_nobody(report: Report) -> None:
    told = [f"{check.word}: {check.message}" for check in report.oddities if check.word]
    assert f"within {float(100 * (APART - 1)):g} %" in NEAR
    (near,) = [line for line in told if NEAR in line]
    assert near.startswith(f"warning: alpha: 3 of 15 pairs: {NEAR}: alpha[1-2] = ")
    assert all(line.startswith(("warning: alpha: ", "warning: chi2_eiv")) for line in told)
    assert not any("look at" in line for line in told)
    assert report.values.cell("x", (1, 2, 1)).reason.endswith(f"outside the domain of (L10): {NEAR}")


def test_a_result_of_such_pairs_alone_is_a_finding(tmp_path: Path) -> None:
    one = {name: column[:2] for name, column in HEIGHTS.items()}
    found = {check.name: check for check in Study(write(tmp_path, one)).computed.oddities}
    assert not found["result"].passed
    assert found["result"].message.startswith(
        "alpha_mean, alpha_median, alpha_log, C_log, alpha_lin and C_lin of "
    )
    assert found["result"].message.endswith("for want of x_top[1-2]")
    expected = '[expected]\n"x_top[1-2]" = "one height, to see the scatter"\n'
    found = {check.name: check for check in Study(write(tmp_path, one, expected)).computed.oddities}
    assert found["result"].passed
    assert found["x_top[1-2]"].passed


@pytest.mark.parametrize("fits", [("alpha_mean",), ("alpha_mean", "alpha_log", "alpha_lin")])
def test_who_averaged_all_pairs_is_told_so_and_has_misprinted_nothing(
    report: Report, tmp_path: Path, fits: tuple[str, ...]
) -> None:
    every = with_every_pair(report)
    cells = [f"T2,alpha,{i}-{j},{value:.4f},1" for (i, j), value in exponents(every).items()]
    cells += [f"text,{name},,{every.scalar(name):.4f},1" for name in fits]
    write(tmp_path, HEIGHTS, '[published]\nfile = "published.csv"\n')
    (tmp_path / "published.csv").write_text("\n".join(["source,cell,index,value,unit", *cells, ""]))
    (found,) = Study(tmp_path).refereed.referee.explanations
    assert [(one.kind, one.cell) for one in found.changes] == [("rows", name) for name in fits]
    assert found.first.would_print == f"with all pairs, those left out here, too ({NEAR})"
    assert found.count == 0


def test_a_budget_tells_together_what_the_average_is_of(report: Report) -> None:
    (together,) = Spread(report.inputs, report.values).budget("alpha_mean", 0).summed
    assert (together.name, len(together.eigenvalues)) == ("alpha", len(TOLD))


def test_a_pair_that_tells_nothing_is_neither_inside_nor_outside_of_a_range(report: Report) -> None:
    """Of 15 pairs three are of one height: what comes out as their exponent is no finding about (4)."""
    found = report.marks.limited("alpha")
    assert found.size == 12
    alpha = exponents(report.values)
    assert found.number == sum(not 1 <= alpha[pair] <= 1.5 for pair in TOLD)
    assert found.inside == f"{12 - found.number} of 12 pairs"
