"""The honest example that ships beside the paper: everything published in it comes out, digit for digit."""

from __future__ import annotations

import csv
import io

import mpmath
import numpy as np
import pytest

from loopsheet.report import stages
from loopsheet.report.engines import exact
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.prepared import Prepared
from loopsheet.report.referee.campaign import Campaign
from loopsheet.report.referee.problem import Problem
from loopsheet.report.result.findings import checks
from loopsheet.report.result.result import Report
from loopsheet.report.result.verdict import EXACT
from loopsheet.report.study import Study

FOLDER = PAPER.parent / "worked_example"
PRINTED = (
    ("Table A", "alpha", "1", 0, 4),
    ("Table A", "x_m1", "um", -6, 2),
    ("Table A", "x_m2", "um", -6, 2),
    ("Table A", "Cprime_2", "kN", 3, 3),
    ("Table B", "x_m", "um", -6, 2),
    ("Table B", "Cprime_eq7", "kN", 3, 3),
    ("Table B", "Cprime_eq9", "N", 0, 0),
    ("text", "m_red", "g", -3, 3),
    ("text", "alpha_mean", "1", 0, 5),
    ("text", "alpha_median", "1", 0, 5),
    ("text", "alpha_log", "1", 0, 5),
    ("text", "alpha_lin", "1", 0, 5),
)
"""Source, cell, unit, its power of ten and decimals of everything that is published."""


def made() -> str:
    """published.csv as it follows from the inputs at 50 digits."""
    report = Study(FOLDER).computed
    prepared = Prepared(report.inputs, report.sheet)
    found, values = exact.evaluate(report.sheet, prepared.labels, prepared.exact_data), report.values
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["source", "cell", "index", "value", "unit"])
    for source, cell, unit, power, decimals in PRINTED:
        for label, value in zip(values.labels(report.sheet[cell]), found.value[cell], strict=True):
            index = "-".join(map(str, label))
            rows.writerow([source, cell, index, printed(value, power, decimals, cell == "Cprime_eq9"), unit])
    return text.getvalue()


def printed(value: mpmath.mpf, power: int, decimals: int, truncated: bool) -> str:
    with mpmath.workdps(50):
        scaled = value / mpmath.mpf(10) ** power * mpmath.mpf(10) ** decimals
        digits = int(mpmath.floor(scaled) if truncated else mpmath.nint(scaled))
    whole = str(digits).zfill(decimals + 1)
    return f"{whole[:-decimals]}.{whole[-decimals:]}" if decimals else whole


@pytest.fixture(scope="module")
def example() -> Report:
    return stages.refereed(Study(FOLDER).computed)


def test_what_is_published_follows_from_the_inputs() -> None:
    assert (FOLDER / "published.csv").read_text(encoding="utf-8") == made()


def test_every_published_value_prints_the_same(example: Report) -> None:
    assert len(example.comparisons) == 41
    assert {c.verdict for c in example.comparisons} == {"same"}
    assert {c.word for c in example.comparisons} == {EXACT}
    assert not any(c.published.expect for c in example.comparisons)


def test_every_column_behind_it_is_held(example: Report) -> None:
    """A hundredth more in every other cell of any column shows, but for the units of the fits."""
    sheet = example.sheet
    behind = {a.name for c in example.comparisons for a in sheet.ancestors(sheet[c.cell.name]) if not a.exact}
    data, held = Prepared(example.inputs, sheet).data, set()
    for name in behind:
        campaign = Campaign(sheet, example.inputs, example.values, data, (name,))
        problem = Problem.of(campaign, example.inputs.published)
        points = np.stack([problem.box.start] * 2)
        size = np.abs(points[0, problem.rows[name]]).max()
        points[1, problem.rows[name][::2]] += 0.01 * (max(size, 1.0) if sheet[name].unit == "1" else size)
        as_it_is, otherwise = np.abs(problem.mismatch(problem.evaluate(points))).max(axis=1)
        assert as_it_is < 2.001  # half units; what is truncated may be two off its middle
        held |= {name} if otherwise > 3 else set()
    assert behind - held == {"F_ref", "x_ref"}


def test_nothing_is_found_in_it(example: Report) -> None:
    assert example.referee.joint is not None
    assert example.referee.joint.verdict == EXACT
    assert example.referee.explanations == ()
    assert example.referee.tried is None
    assert all(check.passed for check in checks(example))
