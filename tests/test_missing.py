"""A measured cell may be empty: its row has no value there, and the rest of the report goes on."""

import json
import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from helpers import method_folder
from test_left_out import campaign, refused

import loopsheet
from loopsheet.report.cli import main
from loopsheet.report.result.verdict import EXACT, NOT_FOUND, REACHABLE
from loopsheet.report.study import Study
from loopsheet.report.views import html

GAP = """\
test,v [m/s],e [1],x_p [um]
1,2.334,0.530,23.5
2,2.940,0.512,29.7
3,4.089,0.479,
4,4.504,0.467,45.97
5,4.993,0.453,51.03
"""
METHOD = '''\
"""Readings of two instruments."""

from loopsheet import Method, let, mean, measured


class Readings(Method, source="own", headline="mean_a mean_both"):
    """Readings of two instruments."""

    a = measured("mm", "first instrument")
    b = measured("mm", "second instrument")
    both = let(a + b, "sum of both")
    mean_a = let(mean(a), "mean of the first")
    mean_both = let(mean(both), "mean of the sums")
'''
TABLE = "a [mm],b [mm]\n1.00,2.00\n1.10,\n1.30,2.20\n"


def readings(folder: Path, table: str = TABLE, more: str = "", code: str = METHOD) -> Path:
    return method_folder(folder, code, table, more)


def test_what_needs_it_has_no_value_and_the_rest_goes_on(tmp_path: Path) -> None:
    report = loopsheet.load(readings(tmp_path / "r"))
    assert report["b"].status == report["both"].status == ("ok", "#INPUT!", "ok")
    np.testing.assert_allclose(report["a"].value, [1.00, 1.10, 1.30])
    np.testing.assert_array_equal(np.isnan(report["b"].value), [False, True, False])
    assert float(report["mean_a"]) == pytest.approx(3.40 / 3)
    assert float(report["mean_both"]) == pytest.approx((3.00 + 3.50) / 2)  # in mm, as both are
    assert any("b[2] #INPUT!" in said for said in report.findings)
    assert any("over 2 of 3" in said for said in report.findings)


def test_it_is_told_where_its_row_stands(tmp_path: Path) -> None:
    folder = readings(tmp_path / "r")
    (cells,) = (check for check in Study(folder).computed.oddities if check.name == "cells")
    assert (cells.passed, cells.at.path) == (False, (folder / "measurements.csv").as_posix())
    assert cells.at.line == 3


def test_it_is_the_paper_without_that_datum_and_not_without_that_test(tmp_path: Path) -> None:
    report = Study(campaign(tmp_path / "gap", GAP, published=False)).computed
    status = {cell.address: cell.status.code for cell in report.values.errors()}
    assert set(status.values()) == {"#INPUT!"}
    exponents = [cell for cell in report.values.cells("alpha") if cell.value is not None]
    assert [cell.label for cell in exponents] == [(1, 2), (1, 4), (1, 5), (2, 4), (2, 5), (4, 5)]
    whole = "\n".join(line for line in GAP.splitlines() if not line.startswith("3,"))
    without = Study(campaign(tmp_path / "without", whole, published=False)).computed
    for name in ("alpha_mean", "alpha_eiv", "alpha_log"):
        ours, theirs = (each.values.cell(name).value for each in (report, without))
        assert ours == pytest.approx(theirs, rel=1e-12)
        u = [float(each.uncertain().u[name][0]) for each in (report, without)]
        assert u[0] == pytest.approx(u[1], rel=1e-9)
    assert report.values.cell("v", (3,)).value == 4.089
    # What is missing is the number; that its uncertainty is missing too is no fault of its own.
    assert [cell.address for cell in report.faults] == ["x_p[3]"]


def test_every_engine_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = readings(tmp_path / "r", more='[expected]\n"b[2]" = "not read off"\n')
    main(["check", str(folder)])
    said = capsys.readouterr().out
    assert len(re.findall(r"^engine .* cells, ", said, re.M)) == 3, said
    assert "engine says" not in said
    assert "50 digits say" not in said


def test_page_workbook_and_result_show_the_gap(tmp_path: Path) -> None:
    folder, out = readings(tmp_path / "r"), tmp_path / "out"
    assert main(["build", str(folder), "--out", str(out)]) == 1  # a finding that nobody expected
    page = (out / "report.html").read_text(encoding="utf-8")
    (box,) = re.findall(r"<td class=error><input readonly [^>]*data-cell=b[^>]*>.*?(?=<td)", page)
    assert re.search(r"value(?!=).*missing.*#INPUT!</a>", box), box
    result = json.loads((out / "values.json").read_text(encoding="utf-8"))
    assert result["cells"]["b"]["value"] == [0.002, None, 0.0022], result["cells"]["b"]
    book = openpyxl.load_workbook(out / "report.xlsx")
    texts = [[cell.value for cell in row] for sheet in book for row in sheet.iter_rows()]
    assert any(row[:3] == [2, 1.1, None] for row in texts), texts


def test_a_fit_and_scatter_take_what_there_is(tmp_path: Path) -> None:
    folder = readings(tmp_path / "r", more='[uncertainty]\nb = "scatter"\n')
    report = Study(folder).computed
    (part,) = report.inputs.uncertainty.columns["b"].parts
    assert part.absolute**2 == pytest.approx(Fraction(2, 10**8))
    assert part.dof == 1


@pytest.mark.parametrize(
    ("table", "more", "said"),
    [
        ("a [mm],b [mm]\n1.00,\n1.10,\n", "", ["LS403 2:6 b is empty"]),
        ("a [mm],b [mm]\n1.00,2.0\n1.10,2.1\n,\n1.20,2.0\n", "", ["LS315 4:1 an empty line"]),
        ("test,a [mm],b [mm]\n1,1.00,2.0\n2,1.10,2.1\n3,,\n", "", ["LS403 4:3 the row is empty"]),
        ("a [mm],u(a) [mm],b [mm]\n1.00,0.1,2\n,0.1,2\n1.1,0.1,2\n", "", ["LS403 3:1 a is empty"]),
        ("a [mm],u(a) [mm],b [mm]\n1.00,0.1,2\n1.2,,2\n1.1,0.1,2\n", "", ["LS403 3:5 u(a) is empty"]),
        (TABLE, '[uncertainty]\npaired = ["a", "b"]\n', ["LS434 3:10"]),
    ],
)  # fmt: skip
def test_refused(tmp_path: Path, table: str, more: str, said: list[str]) -> None:
    told = refused(readings(tmp_path / "r", table, more))
    assert len(told) == len(said), told
    for each, beginning in zip(told, said, strict=True):
        assert each.startswith(beginning), told


def test_u_of_an_empty_cell_is_empty_too(tmp_path: Path) -> None:
    table = "a [mm],u(a) [mm],b [mm]\n1.00,0.1,2.0\n,,2.1\n1.10,0.1,2.2\n"
    report = Study(readings(tmp_path / "r", table)).computed
    u = report.uncertain().u["a"]
    assert u[0] == u[2] == pytest.approx(1e-4)
    assert not u[1] > 0


def test_the_verbs_go_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = str(readings(tmp_path / "r"))
    for words in (["show", "b"], ["why", "both[2]"], ["budget", "mean_both"], ["why", "b[2]"]):
        main([*words, folder])
    said = capsys.readouterr()
    assert "b[2]  #INPUT!" in re.sub(" +", "  ", said.out)
    assert "bug" not in said.err
    assert "reason" in said.out
    assert "mean_both = 3.2500 mm" in said.out


@pytest.mark.parametrize(
    ("printed", "verdict"), [("3.2500", EXACT), ("3.24", REACHABLE), ("3.60", NOT_FOUND)]
)
def test_the_referee_leaves_an_empty_cell_empty(tmp_path: Path, printed: str, verdict: str) -> None:
    """A number that was not taken explains nothing."""
    folder = readings(tmp_path / "r", more='[published]\nfile = "published.csv"\n')
    rows = f"source,cell,index,value,unit\nbook,mean_both,,{printed},mm\n"
    (folder / "published.csv").write_text(rows, encoding="utf-8")
    referee = Study(folder).refereed.referee
    assert referee is not None
    (found,) = referee.values
    assert found.verdict == verdict
    assert referee.joint is not None
    assert referee.joint.witness
    assert all((each.cell, each.index) != ("b", (2,)) for each in referee.joint.witness)


def test_the_page_keeps_an_empty_cell_empty(tmp_path: Path) -> None:
    page = html.render(Study(readings(tmp_path / "r")).computed, {}, program="")
    known = json.loads(re.findall(r'id="?live-data"?>(.*?)</script>', page, re.DOTALL)[0])
    (table,) = known["tables"].values()
    assert [row["cells"] for row in table["rows"]] == [
        {"a": "1.00", "b": "2.00"}, {"a": "1.10", "b": ""}, {"a": "1.30", "b": "2.20"},
    ]  # fmt: skip


def test_a_plan_needs_whole_rows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = campaign(tmp_path / "gap", GAP, published=False)
    assert main(["design", str(folder)]) == 2
    assert "test 3 has no x_p" in capsys.readouterr().err


SUMS = """
from loopsheet import Method, count, let, mean, measured, total

class Sums(Method, headline="level slope"):
    "Sums by hand."
    x = measured("m", "place")
    y = measured("m", "height")
    n_x = let(count(x), "with a place")
    n_y = let(count(y), "with a height")
    n_both = let(count(x + y), "with both")
    mean_x = let(mean(x), "mean place")
    S_x, S_y = total(x), total(y)
    S_xy = let(total(x * y), "sum of products")
    S_xx = let(total(x**2), "sum of squares")
    slope = let((count() * S_xy - S_x * S_y) / (count() * S_xx - S_x**2), "slope")
    level = let((S_y - slope * S_x) / count(), "intercept")
    rows = let(count(), "rows")
"""


def test_sums_of_a_result_and_what_is_counted_beside_them_are_of_the_same_rows(tmp_path: Path) -> None:
    table = "x [m],y [m]\n1,2.1\n2,3.9\n3,\n4,8.2\n,9\n6,12.1\n"
    report = loopsheet.load(readings(tmp_path / "r", table, code=SUMS))
    x, y = np.array([1, 2, 4, 6]), np.array([2.1, 3.9, 8.2, 12.1])
    slope, level = np.polyfit(x, y, 1)
    assert [float(report[name]) for name in ("slope", "level")] == pytest.approx([slope, level], rel=1e-12)
    counts = {name: float(report[name]) for name in ("n_x", "n_y", "n_both", "rows")}
    assert counts == {"n_x": 5, "n_y": 5, "n_both": 4, "rows": 6}
    # A line that nothing of this rests on moves nothing: the mean of x is of all that x has.
    assert float(report["mean_x"]) == pytest.approx(np.mean([1, 2, 3, 4, 6]))


def test_results_that_share_a_sum_are_of_the_same_rows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of a mean of rows 2 to 4 and one of all rows, the product was of neither."""
    more = ("c = measured", "a_m = let(mean(a)", "b_m = let(mean(b)", "c_m = let(mean(c)")
    texts = ('("mm", "third")', ', "of a")', ', "of b")', ', "of c")')
    lines = [*map("{}{}".format, more, texts), 'P = let(a_m * b_m, "one")', 'Q = let(a_m * c_m, "other")']
    code = "\n    ".join(
        [METHOD.partition("    both")[0].rstrip().replace("mean_a mean_both", "P Q"), *lines, ""]
    )
    table = "a [mm],b [mm],c [mm]\n1.0,,1.0\n2.0,2.0,3.0\n5.0,1.0,1.0\n5.0,1.0,1.0\n"
    folder = readings(tmp_path / "r", table, '[expected]\n"b[1]" = "lost"\n', code)
    values = Study(folder).computed.values
    assert [1e6 * values.scalar(name) for name in "PQ"] == pytest.approx([4 * 4 / 3, 4 * 5 / 3], rel=1e-14)
    assert main(["check", str(folder)]) == 0
    assert len(re.findall(r"^engine ", capsys.readouterr().out, re.MULTILINE)) >= 1


@pytest.mark.parametrize("groups", ["", ", of=lot"])
@pytest.mark.parametrize(
    "observed", ["T**2 / mean(T{of}) ** 2", "log(T / mean(T{of}))", "T**2 / sum(T{of}) + 0 * mean(x{of})"]
)
def test_a_fit_is_of_rows_that_have_all_it_names(tmp_path: Path, observed: str, groups: str) -> None:
    """Also where the observed holds a sum of its own, over the rows that this has."""
    code = (
        "from sympy import log\nfrom loopsheet import Method, fit, groups, let, mean, measured, unknown\n\n"
    )
    code += 'class Line(Method, headline="b"):\n    "A line."\n    x = measured("m", "place")\n'
    code += '    T = measured("s", "period", positive=True)\n    lot = groups("lot")\n'
    code += f'    y = let({observed.replace("{of}", groups)}, "observed")\n    a = unknown("intercept")\n'
    code += f'    b = unknown("slope")\n    line = fit(y, a + b * x{groups})\n'
    x, T = np.array([1.0, 2.0, 3.0, 5.0, 4.0]), np.array([2.1, 2.9, 3.5, 4.4, np.nan])
    rows = "".join(f"A,{one},{'' if np.isnan(other) else other}\n" for one, other in zip(x, T, strict=True))
    report = loopsheet.load(readings(tmp_path / "r", f"lot,x [m],T [s]\n{rows}", code=code))
    mean, total = np.nanmean(T), np.nansum(T)
    y = {"T": T**2 / mean**2, "l": np.log(T / mean)}[observed[0]] if "sum" not in observed else T**2 / total
    slope, _ = np.polyfit(x[:4], y[:4], 1)
    assert np.ravel(report["b"].value) == pytest.approx([slope], rel=1e-12)
    assert np.ravel(report["line_N1"].value) == pytest.approx([4])


def test_a_mean_beside_a_fit_that_fails_stays(tmp_path: Path) -> None:
    """What rests on the fit has no value; the mean of x, in one quotient with it, is that of all x."""
    code = "from sympy import sqrt\nfrom loopsheet import Method, fit, let, mean, measured, unknown\n\n"
    code += 'class Line(Method, headline="q xbar"):\n    "A line."\n    x = measured("1", "place")\n'
    code += '    y = measured("1", "height")\n    a = unknown("intercept")\n    b = unknown("slope")\n'
    code += '    line = fit(y, a + b * x)\n    xbar = let(mean(x), "mean place")\n'
    code += '    r = let(sqrt(y - a - b * x + 1), "root")\n    q = let(mean(r) / xbar, "quotient")\n'
    report = Study(readings(tmp_path / "r", "x [1],y [1]\n1,2.1\n1,\n3,\n4,\n", code=code)).computed
    assert report.values.cell("q").value is None
    assert report.values.scalar("xbar") == 1


@pytest.mark.parametrize(
    ("name", "before"), [("count_of_a", True), ("count_of_a", False), ("of_readings_5", True)]
)
def test_what_counts_has_its_name_for_itself(
    name: str, before: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Else it would be divided by what somebody called so."""
    lines = ["n_a = let(count(a), 'with a')", "n_a2 = let(count(a + b), 'with both')"]
    lines.insert(0 if before else 2, f"{name} = let(2 * b, 'mine')")
    code = METHOD.replace("import Method,", "import Method, count,") + "".join(
        f"    {each}\n" for each in lines
    )
    assert main(["check", str(readings(tmp_path, code=code))]) == 2
    assert f"{name} is declared twice: it is the " in capsys.readouterr().err


@pytest.mark.parametrize("more", ["", "    away = let(b - mean(b), 'away')\n"])
def test_who_expects_something_of_another_row_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], more: str
) -> None:
    """That a mean lacks the second reading is nothing odd about the third."""
    expected = '[expected]\n"reading 2" = "lost"\n"reading 3" = "innocent"\n'
    where = readings(tmp_path, more=expected, code=METHOD + more)
    assert main(["check", str(where)]) == 1
    told = capsys.readouterr().out
    assert "reading 2, lost: b[2] has no value (#INPUT!)" in told
    assert "reading 3 is expected to be odd (innocent), and is not" in told
    assert "1 finding" in told


def test_every_engine_counts_alike(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = "x [m],y [m]\n1,2.1\n2,3.9\n3,\n4,8.2\n,9\n6,12.1\n"
    main(["check", str(readings(tmp_path / "r", table, code=SUMS))])
    said = capsys.readouterr().out
    assert len(re.findall(r"^engine .* cells, ", said, re.M)) == 3, said
    assert not re.search(r"^finding: (numpy|JavaScript|xlsx|.*50 digits)", said, re.M), said


@pytest.mark.parametrize("named", [False, True])
def test_the_scatter_that_a_fit_lacks_is_missed_where_a_line_names_it(tmp_path: Path, named: bool) -> None:
    code = 'from loopsheet import Method, fit, let, measured, unknown\n\nclass Line(Method, headline="b"):\n'
    code += '    "A line."\n    x = measured("m", "place")\n    y = measured("m", "height")\n'
    code += '    a = unknown("intercept")\n    b = unknown("slope")\n    line = fit(y, a + b * x)\n'
    code += '    relative = let(line.s_b / b, "relative scatter")\n' * named
    report = Study(readings(tmp_path / "r", "x [m],y [m]\n1,2.1\n2,3.9\n", code=code)).computed
    assert report.values.cell("line_s").value is None
    told = [check.message for check in report.oddities if not check.passed]
    assert [said.partition(":")[0] for said in told] == ["line_s has no value"] * named
