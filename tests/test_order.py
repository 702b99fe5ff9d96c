"""The greatest, the least and the median over the rows of a method, from its file to every engine."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from loopsheet.derivations.proof import prove
from loopsheet.derivations.proved import ProofStatus
from loopsheet.report.cli import main
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.monte_carlo import draw
from loopsheet.report.uncertainty.propagation import Spread

WORKBOOK = """\
from loopsheet import Method, claim, given, let, mean, measured, median, total


class Disc(Method, rows="places", headline="R T_span"):
    \"\"\"Roundness of a disc.\"\"\"

    d = measured("mm", "diameter", positive=True)
    T = measured("degC", "temperature")
    d_0 = given("mm", "gauge", positive=True)
    R = let(max(d) - min(d), "out of roundness", like=d)
    middle = let(median(d), "median", like=d)
    part = let(d / max(d), "part of the greatest", "1")
    T_span = let(max(T) - min(T), "range of temperature", "K")
    hottest = let(max(T), "hottest", like=T)
    below = let(d_0 - 2 * d, "below the gauge", "mm")
    nearest = let(max(below), "nearest to it", "mm")
    turned = let(1 / (d - d_0), "turned", "1/mm")
    outermost = let(max(turned) - min(turned) + median(turned), "of rows that have a value", "1/mm")
    greatest = let(max(d), "greatest", like=d)
    claim(total(d / greatest) * greatest, total(d), "parts of the greatest")
"""
TOML = """\
title = "Disc"
workbook = "workbook.py"
[parameters]
d_0 = "12.030 mm"
[measurements]
file = "measurements.csv"
[uncertainty]
d = "u = 2 um"
T = "u = 0.1 degC"
d_0 = "u = 1 um"
"""
TABLE = """\
place,d [mm],T [degC]
1,12.010,20.0
2,12.050,-3.5
3,12.030,19.2
4,11.980,20.3
"""


def folder(where: Path, table: str = TABLE, workbook: str = WORKBOOK) -> Path:
    where.mkdir(parents=True, exist_ok=True)
    for name, text in {"workbook.py": workbook, "report.toml": TOML, "measurements.csv": table}.items():
        (where / name).write_text(text, encoding="utf-8")
    return where


def test_values_by_hand(tmp_path: Path) -> None:
    report = Study(folder(tmp_path)).computed
    value = report.values.value
    assert value["R"] * 1e3 == pytest.approx([0.07])
    assert value["middle"] * 1e3 == pytest.approx([12.02])
    assert value["part"] == pytest.approx(np.array([12.01, 12.05, 12.03, 11.98]) / 12.05)
    assert value["T_span"] == pytest.approx([23.8])
    assert value["hottest"] == [273.15 + 20.3]
    assert value["nearest"] * 1e3 == pytest.approx([12.03 - 2 * 11.98])
    assert value["outermost"] / 1e3 == pytest.approx([50 + 50 - 20])  # the third place has no value
    assert report.values.counted["outermost"] == {"places": 3}
    assert report.shown["hottest"].unit == "degC"


def test_every_engine_agrees_and_every_claim_stands(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], require: Callable[..., str]
) -> None:
    """NumPy, JavaScript and LibreOffice against 50 digits; the place without a value is what is found."""
    require("node")
    require("soffice", "libreoffice")
    assert main(["check", str(folder(tmp_path)), "--format", "json"]) == 1
    checks = json.loads(capsys.readouterr().out)["checks"]
    assert {each["name"] for each in checks if each["kind"] == "engine"} == {"numpy", "JavaScript", "xlsx"}
    assert {each["kind"] for each in checks if not each["passed"]} == {"data"}


@pytest.mark.parametrize(
    ("claimed", "status"),
    [
        ("R, greatest - min(d)", ProofStatus.PROVED),
        # True, and nothing here knows of order.
        ("nearest, d_0 - 2 * min(d)", ProofStatus.UNDECIDED),
        ("R, greatest", ProofStatus.REFUTED),
        ("R, max(d) + min(d)", ProofStatus.REFUTED),
        ("middle, greatest", ProofStatus.REFUTED),
        ("nearest, d_0 - 2 * greatest", ProofStatus.REFUTED),
    ],
)
def test_of_order_nothing_is_made_up(claimed: str, status: ProofStatus) -> None:
    scope: dict[str, Any] = {}
    exec(re.sub(r"claim\(.*", f'claim({claimed}, "claimed")', WORKBOOK), scope)
    assert prove(scope["Disc"].workbook.ledger())[-1].status is status


def test_only_the_outermost_rows_make_an_uncertainty(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    report = Study(folder(tmp_path)).computed
    spread = Spread(report.inputs, report.values)

    def parts(name: str) -> dict[str, float]:
        found = spread.budget(name, 0)
        return {each.source.name: each.u for each in found.contributions}

    assert parts("R") == pytest.approx({"d[2]": 2e-6, "d[4]": -2e-6})
    assert parts("middle") == pytest.approx({"d[1]": 1e-6, "d[3]": 1e-6})
    assert parts("T_span") == pytest.approx({"T[4]": 0.1, "T[2]": -0.1})
    assert parts("nearest") == pytest.approx({"d[4]": -4e-6, "d_0": 1e-6})
    assert main(["budget", "R", str(tmp_path)]) == 0
    assert "it rests on a max, which other rows take over when inputs move" in capsys.readouterr().out


def test_draws_take_the_outermost_of_each(tmp_path: Path) -> None:
    """Of four places that are alike, the range of normal draws: 2.059 standard deviations (Tippett)."""
    alike = re.sub(r"(?m)^(\d),[\d.]+", r"\1,12.030", TABLE)
    report = Study(folder(tmp_path, alike)).computed
    budget = Spread(report.inputs, report.values).budget("R", 0)
    drawn = draw(report.inputs, report.values, budget, 20_000)
    assert budget.value == 0
    assert drawn.mean == pytest.approx(2.0588 * 2e-6, rel=0.01)
    assert drawn.u == pytest.approx(0.8798 * 2e-6, rel=0.02)


@pytest.mark.parametrize(
    ("R", "said"),
    [
        ("0.0712", "a mismatch of 4.0 half units of the last digit; by interval arithmetic none leaves less"),
        ("0.0709", "come out of one input that prints as given, with a worst mismatch of 0.7 half units"),
    ],
)
def test_the_referee_knows_which_rows_may_be_the_outermost(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], R: str, said: str
) -> None:
    """Half a unit of the last digit of two diameters makes .0710 mm of .0700 mm, and no more."""
    toml = TOML.partition("[uncertainty]")[0] + '[published]\nfile = "published.csv"\n'
    table = f"source,cell,index,value,unit\nTable 1,R,,{R},mm\nTable 1,greatest,,12.050,mm\n"
    folder(tmp_path)
    (tmp_path / "report.toml").write_text(toml, encoding="utf-8")
    (tmp_path / "published.csv").write_text(table, encoding="utf-8")
    assert main(["check", str(tmp_path)]) == 1
    assert said in capsys.readouterr().out
