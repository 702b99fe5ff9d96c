"""A test that is left out stays in its table, with its reason, and takes part in nothing."""

import html as markup
import json
import re
import shutil
from pathlib import Path

import openpyxl
import pytest

from loopsheet.report.cli import main
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.messages.errors import InputError
from loopsheet.report.result.findings import CONFORMITY, checks
from loopsheet.report.study import Study
from loopsheet.report.views import html, latex
from loopsheet.report.views.checks import FORMATS

REASON = "bounced twice"
LEFT_OUT = f"""\
test,v [m/s],e [1],x_p [um],left out
1,2.334,0.530,23.5,
2,2.940,0.512,29.7,
3,4.089,n/a,41.6,"{REASON}"
4,4.504,0.467,45.97,
5,4.993,0.453,51.03,
"""


def campaign(folder: Path, table: str = LEFT_OUT, published: bool = True, more: str = "") -> Path:
    """The paper with another table of the tests."""
    shutil.copytree(PAPER, folder)
    (folder / "measurements.csv").write_text(table, encoding="utf-8")
    toml = (folder / "report.toml").read_text(encoding="utf-8")
    if not published:
        toml = re.sub(r"\[published\].*", "", toml, flags=re.DOTALL)
    (folder / "report.toml").write_text(toml + more, encoding="utf-8")
    return folder


def refused(folder: Path) -> list[str]:
    with pytest.raises(InputError) as told:
        assert Study(folder).computed
    return [f"{d.code} {d.at.line}:{d.at.column} {d.message}" for d in told.value.diagnostics]


def test_it_takes_part_in_nothing(tmp_path: Path) -> None:
    report = Study(campaign(tmp_path / "left", published=False)).computed
    removed = "\n".join(re.sub(r",[^,]*$", "", line) for line in LEFT_OUT.splitlines() if "n/a" not in line)
    without = Study(campaign(tmp_path / "without", removed, published=False)).computed
    assert report.inputs.only.tests == without.inputs.only.tests == (1, 2, 4, 5)
    for column in report.sheet.columns:
        ours, theirs = report.values.cells(column.name), without.values.cells(column.name)
        assert [(cell.label, cell.value) for cell in ours] == [(cell.label, cell.value) for cell in theirs]
    (left,) = report.inputs.only.left_out
    assert (left.test, left.reason, left.place) == (3, REASON, 2)
    assert left.texts == {"v": "4.089", "e": "n/a", "x_p": "41.6"}
    assert (left.at.line, left.at.column) == (4, 19)


def test_what_rests_on_it_is_set_aside_and_counted(tmp_path: Path) -> None:
    more = '"x_p[3]" = "41.7"\n[expected]\n"test 3" = "double bounce"\n"alpha[2-3]" = "one height"\n'
    report = Study(campaign(tmp_path / "left", more=more)).computed
    assert len(report.comparisons) == len(report.inputs.published) == 20
    assert all(3 in value.index for value in report.inputs.aside)
    assert len(report.inputs.aside) == 7
    assert report.inputs.expected == ()
    assert list(report.inputs.errata) == [("x_p", 1)]
    assert all(check.kind != "expected" for check in report.oddities)


def test_a_limit_of_what_is_left_out_is_a_finding(tmp_path: Path) -> None:
    """Nobody has shown that it conforms; limits of the whole column are those of the rows that are there."""
    more = '[limits]\n"x_p[3]" = "<= 40 um"\nx_m = "<= 1 mm"\n'
    report = Study(campaign(tmp_path / "left", more=more, published=False)).computed
    failed = [check.message for check in checks(report) if check.kind == CONFORMITY and not check.passed]
    assert failed == ["no decision on x_p[3] (at most 40 um): it rests on a row that is left out"]


def test_a_cell_that_never_was_is_still_a_finding(tmp_path: Path) -> None:
    folder = campaign(tmp_path / "left")
    with (folder / "published.csv").open("a", encoding="utf-8") as file:
        file.write("Table 2,alpha,3-7,1.3,1,,,,\nTable 2,alpha,1-7,1.3,1,,,,\nTable 2,alhpa,1-3,1.3,1,,,,\n")
    assert [line.split(" ", 2)[0] for line in refused(folder)] == ["LS506", "LS505"]


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("3,4.089", "2,4.089", ["LS311 4:1 "]),
        ("3,4.089", "x,4.089", ["LS312 4:1 "]),
        ("left out", "leftout", ["LS303 1:29 ", "LS404 4:9 "]),
        (",n/a", "", ["LS306 4:"]),
        ('"bounced twice"', "", ["LS404 4:9 "]),
    ],
)
def test_its_row_is_a_row_of_the_table(tmp_path: Path, old: str, new: str, found: list[str]) -> None:
    lines = refused(campaign(tmp_path / "left", LEFT_OUT.replace(old, new), published=False))
    assert [line.startswith(start) for line, start in zip(lines, found, strict=True)] == [True] * len(found)


def test_two_that_are_used_are_the_least(tmp_path: Path) -> None:
    table = LEFT_OUT.replace(",\n", ",late\n", 3)
    (line,) = refused(campaign(tmp_path / "left", table, published=False))
    assert line.startswith("LS310 6:1 the table has one test only that is not left out")


def test_every_output_tells_it(tmp_path: Path, unjudged: None, capsys: pytest.CaptureFixture[str]) -> None:
    folder, out = campaign(tmp_path / "left", published=False), tmp_path / "out"
    assert main(["build", str(folder), "--out", str(out), "--to", "html,latex,xlsx,json"]) == 0
    said = f"test 3, {REASON}"
    assert f"left out: {folder.as_posix()}/measurements.csv:4:19: {said}" in capsys.readouterr().out
    page = (out / "report.html").read_text(encoding="utf-8")
    assert f"<strong>Left out</strong>: {said}." in page
    row = re.search(r"<tr class=\"?excluded\"?>.*?(?=<tr|</tbody)", page, re.DOTALL)
    assert row is not None
    assert re.findall(r' value="?([^" >]*)', row.group()) == ["4.089", "n/a", "41.6"]
    tex = (out / "report.tex").read_text(encoding="utf-8")
    assert re.search(r"^3, left out & \{\\color\{gray\}4.089\} & \{\\color\{gray\}n/a\}", tex, re.MULTILINE)
    book = openpyxl.load_workbook(out / "report.xlsx")
    told = [str(cell.value) for sheet in book for row in sheet.iter_rows() for cell in row if cell.value]
    assert f"Left out: {said}." in told
    rows = [
        [cell.value for cell in row if cell.value is not None] for row in book["tests"].iter_rows(min_row=11)
    ]
    assert ["left out, and in no formula:"] in rows
    assert ["3", "4.089 [m/s]", "n/a [1]", "41.6 [um]", REASON] in rows, "texts, which no formula counts"
    assert "In each of 4 tests a ball is dropped on the target; left out besides: 1. A test" in tex
    prose = re.sub("<[^>]*>", "", page)
    assert "In each of 4 tests a ball is dropped on the target; left out besides: 1. A test" in prose
    known = json.loads((out / "values.json").read_text(encoding="utf-8"))
    assert [each["sentence"] for each in known["oddities"] if each["kind"] == "left out"] == [said]


def test_no_name_in_the_workbook_is_clipped(tmp_path: Path, unjudged: None) -> None:
    folder, out = campaign(tmp_path / "left", published=False), tmp_path / "out"
    assert main(["build", str(folder), "--out", str(out), "--to", "xlsx"]) == 0
    sheet = openpyxl.load_workbook(out / "report.xlsx")["report"]
    names = [cell.value for cell in sheet["A"] if cell.font.b and str(cell.value).isidentifier()]
    assert "alpha_median_margin" in names
    assert sheet.column_dimensions["A"].width > 1.1 * max(map(len, names)), "letters are bold"


@pytest.mark.parametrize("form", FORMATS)
def test_every_format_of_check_tells_it(tmp_path: Path, form: str) -> None:
    report = Study(campaign(tmp_path / "left", published=False)).computed
    assert all(check.passed for check in report.oddities)
    assert f"test 3, {REASON}" in markup.unescape(FORMATS[form](report.oddities, "", {}))


def test_hostile_texts_of_it_are_text(tmp_path: Path) -> None:
    nasty = "<script>alert(1)</script> & \\input{x} $y$ %"
    table = LEFT_OUT.replace("n/a", f'"{nasty}"').replace(REASON, nasty)
    report = Study(campaign(tmp_path / "left", table, published=False)).computed
    assert "<script>alert" not in html.render(report, {})
    assert "\\input{x}" not in latex.render(report, {})


def test_a_bundle_of_it_verifies(tmp_path: Path, unjudged: None) -> None:
    folder = campaign(tmp_path / "left", published=False)
    assert main(["build", str(folder), "--to", "json"]) == 0
    assert main(["verify", str(folder)]) == 0
