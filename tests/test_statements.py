"""What is stated of given numbers stands beside them: in words, in the page, in the workbook."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import pytest
from helpers import method_folder

from loopsheet.report.cli import main
from loopsheet.report.result.statements import of_column, statements
from loopsheet.report.study import Study

CSV = """\
test,v [m/s],e [1],x_p [um],u(x_p) [um]
1,2.334,0.530(2),23.5,0.2
2,2.940,0.512,29.7,0.25
3,4.089,0.479,41.6,0
"""
TOML = """\
workbook = "soft_impact"
[parameters]
ball_mass = "8.366(4) g"
beta = "1.5, exact"
target_mass = "2.1 kg, U = 0.2, k = 2"
[measurements]
file = "measurements.csv"
[uncertainty]
v = "+-0.01 m/s rect; s = 0.02 m/s, n = 5"
[uncertainty.shared."height datum"]
of = "x_p"
stated = "+-0.2 um rect"
groups = [[1, 2]]
"""
KNOWN = {
    "v": "±0.01 m/s rect; s = 0.02 m/s, n = 5",
    "e": "u = 0.0020, –, –",
    "x_p": "u = 0.20, 0.25, 0 um; height datum: ±0.2 um rect (the same in each of 1-2)",
    "ball_mass": "u = 0.0040 g",
    "target_mass": "U = 0.2, k = 2",
    "beta": "exact",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("stated")
    (found / "report.toml").write_text(TOML, encoding="utf-8")
    (found / "measurements.csv").write_text(CSV, encoding="utf-8")
    return found


def test_each_column_says_what_was_said_of_it(folder: Path) -> None:
    report = Study(folder).computed
    assert dict(statements(report)) == KNOWN
    assert of_column(report, "points_per_pair") == ""


DEPTHS = """from loopsheet import Method, let, mean, measured


class Depths(Method):
    x_p = measured("um", "a depth")
    typical = let(mean(x_p), "mean of them")
"""


def test_of_many_rows_the_least_and_the_largest(tmp_path: Path) -> None:
    rows = "".join(f"{n},{20 + n}.0({n})\n" for n in range(1, 14))
    report = Study(method_folder(tmp_path, DEPTHS, f"test,x_p [um]\n{rows}")).computed
    assert of_column(report, "x_p") == "u from 0.10 to 1.3 um"


def test_page_and_workbook_say_it_and_the_page_says_nothing_of_digits(folder: Path) -> None:
    assert main(["build", str(folder), "--to", "html,latex,xlsx"]) == 0
    for name in ("report.html", "report.tex"):
        told = (folder / "out" / name).read_text(encoding="utf-8")
        assert "Stated uncertainties: " in told
        assert "height datum: " in told
        assert "their digits say how well they are known" not in " ".join(told.split())
    with zipfile.ZipFile(io.BytesIO((folder / "out/report.xlsx").read_bytes())) as book:
        texts = book.read("xl/sharedStrings.xml").decode()
        notes = "".join(book.read(n).decode() for n in book.namelist() if "comments" in n)
    assert f"x_p: {KNOWN['x_p']}." in texts
    assert "Its stated standard uncertainty is 0.25 um." in notes
