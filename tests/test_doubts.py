"""Where U may not hold is said where U stands, and what to use instead."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from helpers import method_folder

from loopsheet.report.cli import main
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.result.uncertain import Budget
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.monte_carlo import by_draws, sample

METHOD = '''\
"""Homogeneity of a bath."""

from loopsheet import Method, let, mean, measured, median


class Bath(Method, source="made up", headline="middle spread typical"):
    """Homogeneity of a bath."""

    t = measured("degC", "temperature at a place")
    middle = let(mean(t), "mean temperature", "degC")
    spread = let(max(t) - min(t), "range of temperature", "mK")
    typical = let(median(t), "median temperature", "degC")
'''
FILES = {
    "workbook.py": METHOD,
    "report.toml": """\
workbook = "workbook.py"
[measurements]
file = "t.csv"
[uncertainty]
t = "u = 5 mK"
""",
    "t.csv": "reading,t [degC]\n1,20.000\n2,20.0012\n3,20.0047\n4,20.0031\n5,20.0022\n",
}
FAILS = "U does not hold: second order was not looked at"
MAY = "U may not hold: second order was not looked at"
ASKED = "loopsheet budget spread --draws 1000000"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("bath")
    for name, text in FILES.items():
        (made / name).write_text(text)
    return made


def test_a_range_that_first_order_lets_be_negative(folder: Path) -> None:
    report = Study(folder).computed
    of = {budget.cell: budget for budget in report.uncertain().budgets}
    assert {cell: budget.least for cell, budget in of.items()} == {
        "middle": -math.inf, "spread": 0.0, "typical": -math.inf,
    }  # fmt: skip
    assert (of["middle"].advice, of["typical"].advice) == ("", MAY)
    spread = of["spread"]
    assert spread.value - spread.expanded < 0  # no range is negative
    assert spread.advice == f"{FAILS}; use '{ASKED}'"
    drawn = by_draws(sample(report.inputs, report.values, "spread", [0])[0], spread)
    assert drawn.because == "20000 draws: terms of second order were not looked at"
    assert drawn.law is not None
    (low,) = drawn.law.quantile(np.array([0.025]))
    assert spread.value + low * spread.u > 0


def test_a_sum_of_squares_is_not_negative() -> None:
    report = Study(PAPER.parent / "worked_example").computed
    (chi2,) = (each for each in report.uncertain().budgets if each.cell == "chi2_eiv")
    assert 0 < chi2.second < chi2.u**2 / 4  # which alone would be no reason
    assert chi2.value < chi2.expanded
    assert chi2.doubt == "U does not hold: second order counts"


def test_it_stands_where_the_number_stands(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = folder / "out"
    assert main(["build", str(folder), "--to", "html,latex,xlsx"]) == 0
    told = capsys.readouterr().out
    assert f"range of temperature (2)  ({FAILS}; use '{ASKED}')\n" in told
    assert f"median temperature (3)  ({MAY})\n" in told
    assert "mean temperature (1)\n" in told
    page = (out / "report.html").read_text()
    assert f"<span class=doubt>{FAILS}; use <code>{ASKED}</code></span>" in page
    assert f"<span class=doubt>{MAY}</span>" in page
    assert page.count("class=doubt") == 2
    assert f"{FAILS} (<code>spread</code>). {MAY} (<code>typical</code>). " in page
    assert f'"doubt":"{FAILS}; use \'{ASKED}\'"' in page  # what the bar tells
    paper = (out / "report.tex").read_text()
    assert paper.count(FAILS) == paper.count(MAY) == 2
    book = openpyxl.load_workbook(out / "report.xlsx")
    texts = {str(cell.value) for sheet in book for row in sheet for cell in row}
    assert {f"spread: {FAILS}; use '{ASKED}'.", f"typical: {MAY}.", f"{FAILS}; use '{ASKED}'", MAY} <= texts
    main(["budget", "spread", str(folder)])
    assert "take over when inputs move; U does not hold, --draws tells more\n" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("second", "value", "least", "doubt"),
    [
        (0.0, 1.0, 0.0, ""),
        (0.2, 9.0, 0.0, "U may not hold: second order counts"),
        (0.6, 9.0, 0.0, "U does not hold: second order counts"),
        (0.2, 1.0, 0.0, "U does not hold: second order counts"),
        (0.2, 1.0, -math.inf, "U may not hold: second order counts"),
    ],
)
def test_it_fails_where_second_order_is_more_or_u_leads_too_low(
    second: float, value: float, least: float, doubt: str
) -> None:
    assert Budget("x", "x", (), value, u=1.0, second=second, factor=2.0, least=least).doubt == doubt


TIED = """\
from loopsheet import Method, let, measured
class Tied(Method, rows="readings"):
    x = measured("mm", "reading")
    width = let(max(x) - min(x), "range", "mm")
"""


def test_the_range_of_equal_readings_is_not_certain(tmp_path: Path) -> None:
    """Which of them is the greatest, and which the least, changes with any error: slopes are nothing here."""
    more = '[uncertainty]\nx = "u = 0.01 mm"\n[limits]\nwidth = "<= 0.005 mm"\n'
    method_folder(tmp_path, TIED, "reading,x [mm]\n1,2.000\n2,2.000\n3,2.000\n", more)
    found = Study(tmp_path).computed.uncertain()
    assert not found.budgets[0].is_known
    (conformity,) = found.conformities
    # Of three normal numbers with u the range is less than u/2 so often (by integration).
    assert conformity.probability == pytest.approx(0.0664, abs=0.006)
