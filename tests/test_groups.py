"""Rows in groups, by a column of words: an axis of its own, on which all else goes on."""

import json
import re
import zipfile
from collections.abc import Callable
from pathlib import Path

import grouped
import numpy as np
import openpyxl
import pytest
from helpers import method_folder

import loopsheet
from loopsheet.report import build, method
from loopsheet.report.cli import main
from loopsheet.report.column import SheetError
from loopsheet.report.judge.sample import part
from loopsheet.report.result.findings import CONFORMITY, checks
from loopsheet.report.study import Study

SIZE = {"between": 1e-6, "within": 1e-6, "s": 1e-3, "F": 1.0, "R2": 1.0}  # of mm in SI


@pytest.mark.parametrize("name", grouped.DATA)
def test_it_is_what_nist_certifies(name: str, tmp_path: Path) -> None:
    values = Study(grouped.certified(name, tmp_path)).computed.values
    found = {cell: values.scalar(cell) / size for cell, size in SIZE.items()}
    assert found == pytest.approx({cell: grouped.DATA[name][cell] for cell in SIZE}, rel=2e-14)


@pytest.mark.parametrize("name", grouped.DATA)
def test_every_engine_computes_it(name: str, tmp_path: Path, every_engine: Callable[..., str]) -> None:
    every_engine(grouped.certified(name, tmp_path))


def test_a_group_is_a_row(tmp_path: Path) -> None:
    report = Study(grouped.write(tmp_path)).computed
    values = report.values
    assert values.labels(report.sheet["level"]) == [(1,), (2,), (3,)]
    assert values.value["many"].tolist() == [3, 2, 2]
    assert values.value["level"] == pytest.approx([1.5e-3, 2.5e-3, 3.375e-3], rel=1e-15)
    assert values.value["scatter"] == pytest.approx(
        1e-3 * np.array([0.25, 0.125**0.5, 0.03125**0.5]), rel=1e-15
    )
    assert report.sheet["level"].axis is not None
    assert report.sheet["level"].axis.row == "instrument"


def test_what_groups_share_is_one_error(tmp_path: Path) -> None:
    stated = '[uncertainty]\ny = "u = 0.2 mm"\n'
    sure = Study(grouped.write(tmp_path, more=stated)).computed.uncertain().u
    assert sure["level"] == pytest.approx(0.2e-3 / np.sqrt([3, 2, 2]), rel=1e-14)
    assert sure["apart"][0] == pytest.approx(0.2e-3 * np.sqrt(1 / 3 + 1 / 2), rel=1e-14)
    assert sure["middle"][0] == pytest.approx(0, abs=1e-18)  # both rest on the same readings
    level, all_y = np.array([1.5, 2.5, 3.375]), 16.25 / 7
    by_reading = 2 * (np.repeat(level, [3, 2, 2]) - all_y)
    assert sure["between"][0] == pytest.approx(0.2e-6 * np.sqrt((by_reading**2).sum()), rel=1e-12)


def test_what_is_taken_by_order_is_taken_in_each_group(tmp_path: Path) -> None:
    rows = (*grouped.FEW, ("B", "2.50"), ("A", "9.75"), ("C", "3.00"))
    report = Study(grouped.write(tmp_path, rows, more='[uncertainty]\ny = "u = 0.2 mm"\n')).computed
    sure = report.uncertain().u
    assert report.values.value["wide"] == pytest.approx([8.5e-3, 0.5e-3, 0.5e-3], rel=1e-14)
    assert report.values.value["typical"] == pytest.approx([1.625e-3, 2.5e-3, 3.25e-3], rel=1e-15)
    assert sure["typical"] == pytest.approx([0.2e-3 / 2**0.5, 0.2e-3, 0.2e-3], rel=1e-12)
    assert sure["wide"] == pytest.approx([0.2e-3 * 2**0.5] * 3, rel=1e-12)
    assert report.values.scalar("widest") == pytest.approx(8.5e-3, rel=1e-14)
    assert main(["check", str(tmp_path)]) == 0


def test_a_decision_is_drawn_where_rows_stand_in_groups(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    more = '[uncertainty]\ny = "u = 0.2 mm"\n[limits]\ns = "<= 0.5 mm"\n'
    folder = grouped.write(tmp_path, more=more)
    assert main(["budget", "s", str(folder), "--draws", "20000"]) == 0
    told = capsys.readouterr().out
    found = re.search(r"Monte Carlo, 20000 draws: median ([\d.]+) mm, u = ([\d.]+) mm", told)
    assert found is not None
    rng = np.random.default_rng(3)
    drawn = np.array([float(y) for _, y in grouped.FEW]) + rng.normal(0, 0.2, (20000, 7))
    own = [np.array([n for n, (word, _) in enumerate(grouped.FEW) if word == each]) for each in "ABC"]
    squares = sum(((drawn[:, at] - drawn[:, at].mean(axis=1, keepdims=True)) ** 2).sum(axis=1) for at in own)
    s = np.sqrt(squares / 4)
    assert [float(each) for each in found.groups()] == pytest.approx([np.median(s), s.std()], rel=0.02)
    assert "by 20000 draws" in told


def test_a_reading_that_is_missing_is_left_out(tmp_path: Path) -> None:
    rows = tuple((word, "" if n == 2 else y) for n, (word, y) in enumerate(grouped.FEW))
    code = grouped.METHOD.replace("    instrument =", '    x = measured("mm", "another")\n    instrument =')
    folder = grouped.write(
        tmp_path, tuple((*row, "1.0") for row in rows), "instrument,y [mm],x [mm]", code,
        '[expected]\n"y[3]" = "not taken"\n',
    )  # fmt: skip
    report = Study(folder).computed
    assert report.values.value["many"].tolist() == [2, 2, 2]
    left_out = [[each[:2] for each in report.values.left_out("level", row)] for row in range(3)]
    assert left_out == [[(2, 3)], [], []]
    assert report.values.value["level"] == pytest.approx([1.375e-3, 2.5e-3, 3.375e-3], rel=1e-15)
    assert report.values.value["wide"] == pytest.approx([0.25e-3, 0.5e-3, 0.25e-3], rel=1e-14)
    assert report.values.value["typical"] == pytest.approx([1.375e-3, 2.5e-3, 3.375e-3], rel=1e-15)
    assert main(["check", str(folder)]) == 0


def test_a_group_without_readings_has_no_value(tmp_path: Path, every_engine: Callable[..., str]) -> None:
    code = grouped.METHOD.replace("    instrument =", '    x = measured("mm", "another")\n    instrument =')
    rows = tuple((word, "" if word == "B" else y, "1.0") for word, y in grouped.FEW)
    folder = grouped.write(tmp_path, rows, "instrument,y [mm],x [mm]", code)
    values = Study(folder).computed.values
    assert values.cell("level", (2,)).reason == (
        "#INPUT! level[B] needs y[2]: the datum is missing or invalid"
    )
    assert values.numbers("level")[0] == pytest.approx(1.5e-3)
    assert values.scalar("within") == pytest.approx(0.15625e-6, rel=1e-14)
    every_engine(folder, code=1)


FAR_FROM_A_MEAN = """\
from sympy import sqrt
from loopsheet import Method, count, groups, let, mean, measured

class Far(Method, rows="readings", headline="over over_g"):
    "What has a value only above the mean."
    y = measured("1", "reading")
    std = groups("std")
    t = let(mean(y, of=std), "mean of a standard")
    m, m_g = let(mean(y), "mean"), let(mean(t), "mean of the standards")
    z = let(sqrt(y - m), "above the mean")
    z_g = let(sqrt(t - m_g), "standards above their mean")
    over, over_g = let(count(z), "how many are"), let(count(z_g), "how many standards are")
"""


def test_what_rests_on_a_mean_is_counted_where_it_has_a_value(tmp_path: Path) -> None:
    rows = (("A", "1.0"), ("A", "2.0"), ("B", "4.0"), ("B", "5.0"), ("C", "1.5"))
    values = Study(grouped.write(tmp_path, rows, "std,y [1]", FAR_FROM_A_MEAN)).computed.values
    assert (values.scalar("over"), values.scalar("over_g")) == (2, 1)


TWO_WAYS = """\
from loopsheet import Method, groups, mean, measured, let

class Both(Method, rows="readings"):
    "Readings of specimens in lots."
    y = measured("mm", "reading")
    specimen = groups("specimen")
    lot = groups("lot")
    a = let(mean(y, of=specimen), "mean of a specimen", "mm")
    b = let(mean(y, of=lot), "mean of a lot", "mm")
"""


def test_rows_may_be_in_groups_of_two_kinds(tmp_path: Path) -> None:
    """Their running numbers are told apart without a word."""
    rows = "reading,specimen,lot,y [mm]\n1,a,u,1.0\n2,a,v,1.2\n3,b,u,2.0\n4,b,v,2.4\n"
    found = loopsheet.load(method_folder(tmp_path, TWO_WAYS, rows))
    assert found["a"].value.tolist() == pytest.approx([1.1, 2.2])
    assert found["b"].value.tolist() == pytest.approx([1.5, 1.8])
    assert main(["check", str(tmp_path)]) == 0


OVER_GROUPS = """\
from sympy import sqrt
from loopsheet import Method, count, fit, groups, let, mean, measured, median, total, unknown

class Line(Method, rows="readings", headline="b typical"):
    "A line through the means of standards, and of what there is of them."
    x = measured("1", "content")
    y = measured("mV", "signal", positive=False)
    std = groups("std")
    x_m = let(mean(x, of=std), "content of a standard")
    y_m = let(mean(y, of=std), "signal of a standard", "mV")
    a, b = unknown("intercept", "mV"), unknown("slope", "mV")
    line = fit(y_m, a + b * x_m)
    p, q = unknown("intercept of the squares", "mV"), unknown("slope of the squares", "mV")
    u_m = let(0.1 * y_m, "weight of a standard", "mV")
    bent = fit(y_m, p + q * x_m**2, u=u_m)
    many = let(count(y_m), "how many have a signal")
    typical = let(mean(y_m), "mean signal", "mV")
    middle = let(median(y_m), "median signal", "mV")
    by_hand = let(total(y_m) / count(y_m), "mean by hand", "mV")
    scatter = let(sqrt(total((y_m - typical) ** 2) / (count(y_m) - 1)), "scatter", "mV")
"""


def test_a_group_without_a_value_is_as_if_it_were_not_there(tmp_path: Path) -> None:
    """Whatever is taken over groups: sums, counts and the equations of fits leave out the same."""
    rows = [("S1", "1", "10.0"), ("S1", "1", "10.4"), ("S2", "2", ""), ("S3", "6", "20.0"), ("S4", "7", "25")]
    lacking, without = (
        Study(grouped.write(tmp_path / name, tuple(own), "std,x [1],y [mV]", OVER_GROUPS)).computed
        for name, own in (("lacking", rows), ("without", [row for row in rows if row[0] != "S2"]))
    )
    scalars = [column.name for column in without.sheet.columns if column.axis is None]
    assert {"b", "q", "count_of_y_m", "line_S"} <= {*scalars}
    for name in scalars:
        assert lacking.values.scalar(name) == without.values.scalar(name), name
    assert without.values.scalar("many") == 3


def test_whatever_is_left_out_others_keep_their_number(tmp_path: Path) -> None:
    rows = tuple((*row, "dropped" if row[0] == "A" else "") for row in grouped.FEW)
    folder = grouped.write(tmp_path, rows, "instrument,y [mm],left out")
    report = Study(folder).computed
    assert report.values.labels(report.sheet["level"]) == [(2,), (3,)]
    build.build(Study(folder), tmp_path / "out", ("html", "json", "latex"))
    cells = json.loads((tmp_path / "out" / "values.json").read_text(encoding="utf-8"))["cells"]
    assert (cells["level"]["axis"], cells["level"]["index"]) == ("instruments", [2, 3])
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    table = next(
        each for each in re.findall(r"<table.*?</table>", page, re.DOTALL) if "data-cell=level" in each
    )
    assert re.findall(r"<tr><th>(\d)<td[^>]*>(\w)", table) == [("2", "B"), ("3", "C")]


def test_it_is_told_where_it_comes_from(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = grouped.write(tmp_path)
    assert main(["why", "level[2]", str(folder)]) == 0
    told = capsys.readouterr().out
    assert "sum(y_k, k in g)" in told
    assert "over 2 readings\n" in told
    assert re.search(r"rests on +y\[2\] = 2.25 mm, y\[6\] = 2.75 mm\n", told)
    assert main(["why", "y[5]", str(folder)]) == 0
    assert "level[C]" in (told := capsys.readouterr().out)
    assert "level[1]" not in told
    assert main(["show", "level", str(folder)]) == 0
    assert re.search(r"level\[B\] +2\.5", capsys.readouterr().out)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("reading,instrument", "reading,device"), ("LS301", "the column 'instrument' is missing", ":1:",
          "add 'instrument' to the first line, or write it in the place of 'device'")),
        (("reading,instrument", "reading,instrumnet"), ("LS303", "unknown column 'instrumnet'", ":1:9")),
        (("1,A,1.50", "1,,1.50"), ("LS403", "instrument is empty", ":2:3")),
    ],
)  # fmt: skip
def test_a_table_without_its_words_is_refused(
    change: tuple[str, str], said: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = grouped.write(tmp_path)
    table = folder / "measurements.csv"
    before = table.read_text(encoding="utf-8")
    assert change[0] in before
    table.write_text(before.replace(*change), encoding="utf-8")
    assert main(["check", str(folder)]) == 2
    told = capsys.readouterr().err
    assert [word for word in said if word not in told] == []


def test_numbers_are_no_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = tuple(("123"["ABC".index(word)], y) for word, y in grouped.FEW)
    assert main(["check", str(grouped.write(tmp_path, rows))]) == 2
    told = capsys.readouterr().err
    assert "LS318" in told
    assert "measurements.csv:2:3" in told


def test_a_word_that_is_the_number_of_another_group_is_none(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`level[1]` would be that of the first group to some, and of the one that is called so to others."""
    rows = tuple((word if word != "B" else "1", y) for word, y in grouped.FEW)
    assert main(["check", str(grouped.write(tmp_path, rows))]) == 2
    told = capsys.readouterr().err
    assert "LS318" in told
    assert "has the number of another, such as '1'" in told
    for other in ("7", "7" * 5000):
        rows = tuple((word if word != "B" else other, y) for word, y in grouped.FEW)
        assert main(["check", str(grouped.write(tmp_path / other[:9], rows))]) < 2


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            "other = groups('day', index='h', size='days'); z = let(mean(y, of=other) - level, 'both')",
            "one formula names instruments or days: take a mean",
        ),
        (
            "first, second = pairs(); z = let(first(y) - level, 'of which')",
            "one formula names instruments or pairs: take a mean",
        ),
        ("z = let(mean(y, of='instrument'), 'text')", "returned: write of=instrument, without quotes"),
        ("z = let(max(2 * y, of=instrument), 'most')", "max() is of a column, not of 2*y[k]"),
        ("z = let(max(level, of=instrument), 'most')", "level[g] is one number of each instrument"),
        ("z = let(max(y, 2 * y, of=instrument), 'most')", "of several formulas is of each row"),
        ("z = let(median(y, of='instrument'), 'text')", "of='instrument' is none of what groups() returned"),
        ("reading = groups('reading')", "rows already"),
        ("again = groups('instrument')", "rows already"),
        ("two = groups('a word')", "needs names"),
        ("two = groups('word', index='k')", "k counts other rows already: say index='...' and size='...'"),
        (
            "g = given('m/s^2', 'free fall')",
            "g is the instrument's number: call that otherwise, index='...' in groups()",
        ),
        ("claim(sum(many * level), sum(y), 'all')", "of which no proof is known"),
        ("claim(sum(off) * all_y, sum(y), 'false', from_=[off])", "of which no proof is known"),
        ("x = unknown('x'); f = fit(y, x * level)", "f: x*level[g] is of rows in groups, which no fit takes"),
        ("claim(off * level, y, 'true', from_=[off])", "of which no proof is known"),
    ],
)
def test_what_is_refused_of_groups(line: str, said: str) -> None:
    with pytest.raises(SheetError, match=re.escape(said)):
        exec(f"{grouped.METHOD}    {line}\n", {**vars(method), **vars(loopsheet)})


def test_a_new_folder_has_its_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code = tmp_path / "workbook.py"
    code.write_text(
        grouped.METHOD.replace('"reading")', '"reading", example="1.1 1.2 1.3 1.5")'), encoding="utf-8"
    )
    assert main(["new", str(tmp_path / "made"), "--workbook", str(code)]) == 0
    table = (tmp_path / "made" / "measurements.csv").read_text(encoding="utf-8")
    assert table == "reading,instrument,y [mm]\n1,S1,1.1\n2,S1,1.2\n3,S2,1.3\n4,S2,1.5\n"
    assert main(["show", "level", str(tmp_path / "made")]) == 0


def test_other_words_are_another_workbook(tmp_path: Path) -> None:
    """What is kept of a sheet hangs on which rows stand together."""
    books = {}
    for name, words in {"one": "AABB", "other": "ABBB"}.items():
        folder = grouped.write(tmp_path / name, tuple(zip(words, ("1.1", "1.2", "1.4", "1.9"), strict=True)))
        build.build(Study(folder), folder / "out", ("xlsx",))
        with zipfile.ZipFile(folder / "out" / "report.xlsx") as archive:
            books[name] = "".join(
                archive.read(each).decode() for each in archive.namelist() if "/sheet" in each
            )
    ends = {name: set(re.findall(r"!\$[A-Z]+\$(\d+):\$[A-Z]+\$(\d+)", text)) for name, text in books.items()}
    assert {("8", "9"), ("10", "11")} <= ends["one"]
    assert {("8", "8"), ("9", "11")} <= ends["other"]


def test_published_values_of_groups_are_refereed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = grouped.write(tmp_path, more='[published]\nfile = "published.csv"\n')
    said = "source,cell,index,value,unit,expect,reason\n"
    rows = "Table,level,1,1.50,mm,,\nTable,level,2,2.50,mm,,\nTable,scatter,1,0.25,mm,,\n"
    (folder / "published.csv").write_text(said + rows, encoding="utf-8")
    assert main(["check", str(folder)]) == 0
    assert "3 values: 3 print the same" in capsys.readouterr().out
    (folder / "published.csv").write_text(said + rows.replace("2.50", "2.61"), encoding="utf-8")
    assert main(["check", str(folder)]) == 1
    assert "level[B]" in capsys.readouterr().out
    (folder / "published.csv").write_text(said + rows.replace("level,2", "level,b"), encoding="utf-8")
    assert main(["check", str(folder)]) == 2
    told = capsys.readouterr().err
    assert "not an index: 'b'" in told
    assert "'loopsheet show level FOLDER' lists" in told


def test_words_stand_for_rows_in_the_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = tuple((f"P{n}", word, y) for n, (word, y) in enumerate(grouped.FEW, start=1))
    more = (
        '[published]\nfile = "published.csv"\n[limits]\n"level[B]" = "2 .. 3 mm"\n"level[C]" = "2 .. 3 mm"\n'
        '"y[P3]" = ">= 1 mm"\n[expected]\n"scatter[B]" = "rough"\n'
    )
    folder = grouped.write(tmp_path, rows, "part,instrument,y [mm]", more=more)
    said = (
        "source,cell,index,value,unit\nTable,level,{},{},mm\nTable,u(level),B,0.002,mm\nTable,y,{},1.75,mm\n"
    )
    table = folder / "published.csv"
    table.write_text(said.format("B", "2.50", "P3"), encoding="utf-8")
    assert main(["check", str(folder)]) == 1
    told = capsys.readouterr().out
    assert "level[C] does not conform" in told
    assert "level[B] does not" not in told
    assert "scatter[B] is expected to be odd (rough), and is not" in told
    assert "3 values: 3 print the same" in told
    assert main(["budget", "y[P3]", str(folder)]) == 0
    assert "y[3] conforms" in capsys.readouterr().out
    table.write_text(said.format("C", "2.50", "P3"), encoding="utf-8")
    main(["check", str(folder)])
    assert "Table level[C] prints 2.50" in capsys.readouterr().out
    table.write_text(said.format("P3", "2.50", "B"), encoding="utf-8")
    assert main(["check", str(folder)]) == 2
    wrong = capsys.readouterr().err
    assert "level has no index 'P3'" in wrong
    assert "allowed: 1, 2 or 3; or A, B or C" in wrong
    assert "y has no index 'B'" in wrong


@pytest.mark.parametrize("section", ['[limits]\n"level[X]" = "< 3 mm"', '[expected]\n"level[X]" = "odd"'])
def test_a_word_of_no_group_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str], section: str) -> None:
    more = f"{section.replace('<', '<=')}\n"
    assert main(["check", str(grouped.write(tmp_path, more=more))]) == 2
    told = capsys.readouterr().err
    assert "level has no index 'X'" in told
    assert "1, 2 or 3; or A, B or C" in told


def test_a_large_table_is_judged_by_some_of_its_rows(tmp_path: Path) -> None:
    rng = np.random.default_rng(7)
    rows = tuple((f"S{n % 40}", f"{y:.3f}") for n, y in enumerate(rng.normal(2, 0.1, 400)))
    report = Study(grouped.write(tmp_path, rows)).computed
    some = part(report.inputs, report.values, 300)
    assert 4 < len(some.only.tests) < 400
    assert set(some.only.groups("instrument").items()) >= {(1, 1), (40, 40), (41, 1)}


@pytest.mark.parametrize("place", ["3", "C"])
def test_a_limit_of_a_group_that_is_left_out_is_a_finding(place: str, tmp_path: Path) -> None:
    """Its number is that of no row that is left out."""
    rows = tuple((*row, "cracked" if row[0] == "C" else "") for row in grouped.FEW)
    folder = grouped.write(tmp_path, rows, "instrument,y [mm],left out")
    with (folder / "report.toml").open("a", encoding="utf-8") as file:
        file.write(f'[limits]\n"level[{place}]" = "<= 2 mm"\n"level[1]" = "<= 2 mm"\n')
    failed = [
        check.message
        for check in checks(Study(folder).computed)
        if check.kind == CONFORMITY and not check.passed
    ]
    assert failed == [f"no decision on level[{place}] (at most 2 mm): it rests on a row that is left out"]


@pytest.mark.parametrize(
    ("cell", "told"),
    [("level[3]", "level[3] is level[C] as it stands"), ("level[C]", ""), ("level", "")],
)
def test_a_group_that_is_named_by_its_number_is_told(cell: str, told: str, tmp_path: Path) -> None:
    """Whoever sorts the table would have the limit of another one."""
    folder = grouped.write(tmp_path, grouped.FEW)
    with (folder / "report.toml").open("a", encoding="utf-8") as file:
        file.write(f'[limits]\n"{cell}" = "<= 9 mm"\n')
    (found,) = (each for each in Study(folder).computed.oddities if each.kind == "words")
    assert (found.note, told in found.message) == ("warning" if told else "", True)


def test_words_in_two_cases_are_two_groups_if_each_has_several_rows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = tuple(({"A": "CO", "B": "Co"}.get(word, word), y) for word, y in grouped.FEW)
    folder = grouped.write(tmp_path, rows)
    assert Study(folder).computed.values.numbers("many") == [3, 2, 2]
    main(["check", str(folder)])
    told = capsys.readouterr().out
    assert "warning" in told
    assert "'Co' (readings 2 and 6) is nearly 'CO' (readings 1, 3 and 4)" in told


@pytest.mark.parametrize("other", ["a", "A\u200b", "\uff21"])
def test_a_word_in_another_case_is_no_other_group(
    other: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = tuple((other if n == 2 else word, y) for n, (word, y) in enumerate(grouped.FEW))
    assert main(["check", str(grouped.write(tmp_path, rows))]) == 2
    told = capsys.readouterr().err
    assert "LS319" in told
    seen = other.replace("\u200b", "\\u200b")
    assert f"instrument is '{seen}', and 'A' in line 2" in told
    assert "measurements.csv:4:3" in told


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("B40", "B4O", "B40"), ":3:3: instrument: 'B4O' (reading 2) is nearly 'B40' (readings 1 and 3)"),
        (
            ("B40", "\u041240", "B40"),
            ":3:3: instrument: '\u041240' (reading 2, with CYRILLIC CAPITAL LETTER VE) is nearly 'B40'",
        ),
        (("S01", "S02", "S1"), ":4:3: instrument: 'S1' (reading 3) is nearly 'S01' (reading 1)"),
        (("S-2", "S2", "S-2"), ":3:3: instrument: 'S2' (reading 2) is nearly 'S-2' (readings 1 and 3)"),
        (("S-2", "S-2", "S_2"), ":4:3: instrument: 'S_2' (reading 3) is nearly 'S-2' (readings 1 and 2)"),
        (("S\u20132", "S 2", "S 2"), ":2:3: instrument: 'S\u20132' (reading 1) is nearly 'S 2'"),
        (("S.2", "S.2", "s02"), ":4:3: instrument: 's02' (reading 3) is nearly 'S.2'"),
        (("S2.", "S2", "S2"), ":2:3: instrument: 'S2.' (reading 1) is nearly 'S2'"),
        (("1-1", "1.1", "1-1"), ":3:3: instrument: '1.1' (reading 2) is nearly '1-1'"),
        (("Aldrich", "Aldrich", "Aldrch"), ":4:3: instrument: 'Aldrch' (reading 3) is nearly 'Aldrich'"),
        (
            ("steel", "setel", "steel"),
            ":3:3: instrument: 'setel' (reading 2) is nearly 'steel' (readings 1 and",
        ),
        (("B40", "B41", "B40", "B4", "B400"), ""),
        (("A1", "A2", "A1", "A11", "A12"), ""),
        (("butane", "butene", "butane", "batchA", "batchB", "CO2", "C2"), ""),
        (("plant", "planet"), ""),
        (("1-11", "11-1", "111a"), ""),
        (("-5 K", "5 K", "Cl-", "Cl", "0.5 M", "5 M"), ""),
    ],
)
def test_a_word_that_is_nearly_another_is_told(words: tuple[str, ...], said: str, tmp_path: Path) -> None:
    rows = tuple((word, str(1.25 + n / 8)) for n, word in enumerate((*words, "other", "other")))
    found = {each.kind: each for each in Study(grouped.write(tmp_path, rows)).computed.oddities}["words"]
    assert found.note == ("warning" if said else "")
    assert said in found.sentence


def test_a_table_of_names_alone_has_no_reading(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(grouped.write(tmp_path, ()))]) == 2
    told = capsys.readouterr().err
    assert told.count("error[") == 1
    assert "LS310" in told
    assert "the table has no reading" in told


def test_over_how_many_readings_a_mean_is_is_told_where_that_is_expected(tmp_path: Path) -> None:
    code = grouped.METHOD.replace("    instrument =", '    x = measured("mm", "another")\n    instrument =')
    rows = tuple((word, "" if n == 2 else y, "1.0") for n, (word, y) in enumerate(grouped.FEW))
    more = '[expected]\n"y[3]" = "not taken"\n'
    report = Study(grouped.write(tmp_path, rows, "instrument,y [mm],x [mm]", code, more)).computed
    (told,) = (each for each in report.oddities if (each.kind, each.name) == ("data", "rows"))
    assert (told.word, told.message[-36:]) == ("expected", "over 6 of 7 readings, as is expected")


def test_a_group_that_lacks_a_reading_is_told_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = grouped.METHOD.replace("    instrument =", '    x = measured("mm", "another")\n    instrument =')
    rows = tuple((word, "" if n == 2 else y, "1.0") for n, (word, y) in enumerate(grouped.FEW))
    folder = grouped.write(tmp_path, rows, "instrument,y [mm],x [mm]", code)
    report = Study(folder).computed
    (told,) = (each for each in report.oddities if (each.kind, each.name) == ("data", "rows"))
    over = dict(reversed(part.split(" over ")) for part in told.message.split("; "))
    assert over["2 of 3 readings"].startswith("many[A], level[A]")
    assert "level" not in over["6 of 7 readings"]
    assert "[B]" not in told.message
    assert "[C]" not in told.message
    for group, said in (("A", "over 2 of 3 readings"), ("B", "over 2 readings")):
        assert main(["why", f"level[{group}]", str(folder)]) == 0
        assert f" {said}\n" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("shift", "said"),
    [
        ({"A": 0.0, "B": 0.0}, "y: readings scatter as much about the mean of their own instrument"),
        ({"A": 0.0, "B": 9.0}, '"u = 0.089 mm, dof = 4" says so'),
    ],
)
def test_readings_scatter_about_the_means_of_their_groups(
    shift: dict[str, float], said: str, tmp_path: Path
) -> None:
    """Of readings at several places the standard deviation of all is none of one of them."""
    read = [("A", 1.5), ("A", 1.6), ("A", 1.7), ("B", 1.55), ("B", 1.6), ("B", 1.7)]
    rows = tuple((word, f"{value + shift[word]:.2f}") for word, value in read)
    report = Study(grouped.write(tmp_path, rows, more='[uncertainty]\ny = "scatter"\n')).computed
    (found,) = (check for check in report.oddities if check.kind == "scatter")
    assert found.name == "y"
    assert said in found.message
    assert found.note == ("warning" if shift["B"] else "")
    own = [np.array([value for word, value in read if word == which]) for which in "AB"]
    pooled = np.sqrt(sum(((each - each.mean()) ** 2).sum() for each in own) / 4)
    assert f"{pooled:.2g}" == "0.089"


def test_a_row_is_found_by_its_word(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = str(grouped.write(tmp_path))
    for row in ("2", "B"):
        assert main(["show", f"level[{row}]", folder]) == 0
    by_number, by_word = capsys.readouterr().out.split("level  ")[1:]
    assert by_number == by_word
    assert main(["show", "y[C]", folder]) == 0  # every reading of it
    assert re.findall(r"y\[\d\]", capsys.readouterr().out) == ["y[5]", "y[7]"]
    assert main(["show", "level[D]", folder]) == 2
    assert "1, 2 or 3; or A, B or C" in capsys.readouterr().err


def test_the_first_worksheet_tells_results_with_their_uncertainties(tmp_path: Path) -> None:
    code = grouped.METHOD.replace("between within F R2 s apart", "level all_y")
    folder = grouped.write(tmp_path, code=code, more='[uncertainty]\ny = "u = 0.02 mm"\n')
    build.build(Study(folder), folder / "out", ("xlsx",))
    formulas, values = (
        openpyxl.load_workbook(folder / "out" / "report.xlsx", data_only=now) for now in (False, True)
    )
    of: dict[str, str] = {}
    title = ""
    for name, value, *_ in values["uncertainty"].iter_rows(values_only=True):
        title = str(name).partition(" [")[0] if " [mm]: " in str(name) else title
        of |= {title: str(value)} if name == "statement" else {}
    told = {}
    for shown, behind in zip(values["report"].iter_rows(), formulas["report"].iter_rows(), strict=True):
        for now, formula in zip(shown, behind, strict=True):
            if str(formula.value).startswith("=uncertainty!"):
                told[str(shown[0].value)] = str(now.value)
                at = str(formula.value).rpartition("!")[2].replace("$", "")
                assert values["uncertainty"][at].value == now.value
    assert told == of
    assert told["all_y"] == "(2.321 ± 0.015) mm, k = 1.96"
    assert told.keys() == {"all_y", "level[A]", "level[B]", "level[C]"}


POOLED = '''\
from sympy import sqrt
from loopsheet import Method, count, groups, let, mean, measured


class Pooled(Method, source="own", rows="readings", headline="s_w"):
    """Scatter within specimens, of which one has a single reading."""

    x = measured("mm", "reading")
    specimen = groups("specimen")
    m = let(mean(x, of=specimen), "mean of a specimen", "mm")
    many = let(count(x, of=specimen), "readings of a specimen")
    s = let(sqrt(sum((x - m) ** 2, of=specimen) / (many - 1)), "scatter of a specimen", "mm")
    s_w = let(sqrt(sum((many - 1) * s**2) / (DOF)), "pooled scatter", "mm")
'''
READINGS = "reading,specimen,x [mm]\n1,A1,9.000\n2,B7,2.010\n3,B7,2.026\n4,C3,2.050\n5,C3,2.062\n"


IN_LINES = """N = let(count(x), "all readings")
    G = let(count(m), "all specimens")
    SS = let(sum((many - 1) * s**2), "squares", "mm^2")
    s_w = let(sqrt(SS / (N - G)), "pooled scatter", "mm")
"""


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        (POOLED.replace("DOF", "count(x) - count(m)"), "s_w"),
        (POOLED.replace("DOF", "sum(many - 1)"), ""),
        (re.sub(r"s_w = .*\n", IN_LINES, POOLED), "s_w"),
        # What is taken over all, and rests on no group, is beside it.
        (POOLED.replace("DOF", "sum(many - 1)") + '    x_m = let(mean(x), "mean", "mm")\n', ""),
    ],
)
def test_sums_over_groups_beside_sums_over_the_rows_of_others_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], lines: str, told: str
) -> None:
    """s_w was 0.0082 mm for 0.0100, by 5 readings less 2 specimens, and green."""
    folder = method_folder(tmp_path, lines, READINGS, '[expected]\n"s[A1]" = "one"\n')
    assert main(["check", str(folder)]) == 0
    said = "warning: s_w rests on sums that leave out some specimens, and on others over readings of these"
    out = capsys.readouterr().out
    assert (said in out, "leave out some" in out) == (bool(told), bool(told))
    values = Study(tmp_path).computed.values
    assert (values.scalar("s_w") == pytest.approx(1e-5, rel=1e-12)) != bool(told)
