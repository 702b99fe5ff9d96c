"""Columns of words beside what was measured come along: they name rows, and nothing is computed from them."""

import io
from contextlib import nullcontext
from pathlib import Path

import gas
import openpyxl
import pytest

import loopsheet
from loopsheet.report import build, stages
from loopsheet.report.cli import main
from loopsheet.report.document.material import Material
from loopsheet.report.document.parts import Item
from loopsheet.report.document.tables import Tables
from loopsheet.report.document.tree import Table
from loopsheet.report.messages.errors import InputError
from loopsheet.report.study import Study

TABLE = """\
reading,operator,T [degC],remark,left out
1,A <b>Smith</b>,20.0,,
2,B Jones,21.5,"door open, 5 %",
3,A <b>Smith</b>,-3.2,,
4,B Jones,30,,fell
"""


def words(table: Table) -> list[list[str]]:
    """The heads and rows of a table, as far as they are words."""
    head = ["".join(map(str, column.head)) for column in table.columns if column.kind != "number"]
    rows = [["".join(map(str, cell)) for cell in row.cells if isinstance(cell, tuple)] for row in table.rows]
    return [head, *rows]


def test_they_come_along(tmp_path: Path) -> None:
    plain = Study(gas.folder(tmp_path / "plain")).computed
    report = Study(gas.folder(tmp_path / "told", table=TABLE)).computed
    assert report.inputs.only.remarks == ("operator", "remark")
    assert report.values.value["m"].tolist() == plain.values.value["m"].tolist()
    build.build(Study(tmp_path / "told"), tmp_path / "out", ("html", "latex", "json"))
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "<th>2<td class=row>B Jones<td class=row>door open, 5 %<td><input " in page
    assert "<td class=row>A &lt;b&gt;Smith&lt;/b&gt;<td" in page
    tex = (tmp_path / "out" / "report.tex").read_text(encoding="utf-8")
    assert r"2 & B Jones & door open, 5 \% & 21.5 &" in tex
    assert "4, left out & B Jones &  & " in tex
    (values,) = (one for one in Tables(Material(report)).data.values() if "reading" in one.columns[0].head)
    assert not any(isinstance(cell, Item) for row in values.rows for cell in row.cells[:3])


def test_one_that_nobody_has_filled_in_comes_along(tmp_path: Path) -> None:
    empty = TABLE.replace('"door open, 5 %"', "")
    report = Study(gas.folder(tmp_path, table=empty)).computed
    assert report.inputs.only.remarks == ("operator", "remark")
    numbers = empty.replace("20.0,,", "20.0,5,")
    with pytest.raises(InputError, match="unknown column 'remark'"):
        assert Study(gas.folder(tmp_path, table=numbers)).inputs


def test_rows_may_be_called_as_the_column_of_their_names(tmp_path: Path) -> None:
    """A column `reading` holds the numbers of readings, or their names; not some of each."""
    table = TABLE.replace("reading,operator", "reading,by").replace("1,A", "R-1,A").replace("2,B", "R-2,B")
    named = table.replace("3,A", "R-3,A").replace("4,B", "R-4,B")
    inputs = Study(gas.folder(tmp_path / "named", table=named)).inputs
    assert (inputs.only.tests, inputs.only.naming) == ((1, 2, 3), ("reading",))
    assert inputs.only.called(3) == "3 (R-3)"
    shown = Tables(Material(Study(tmp_path / "named").computed)).data.values()
    heads = [[column.head for column in each.columns] for each in shown]
    heads = [each for each in heads if ("reading",) in each]
    assert all(each[:2] == [("no.",), ("reading",)] for each in heads)
    assert heads
    loaded = loopsheet.load(tmp_path / "named")
    assert loaded["T"].names == ("1 (R-1)", "2 (R-2)", "3 (R-3)")
    unequal = named.replace("T [degC]", "T [degC],u(T) [degC]").replace("-3.2,", "-3.2,0.5,")
    unequal = unequal.replace("20.0,", "20.0,0.1,").replace("21.5,", "21.5,0.1,").replace("30,,", "30,0.1,,")
    toml = gas.TOML.replace('T = "u = 0.1 degC"\n', "")
    code = gas.WORKBOOK.replace('"temperature", low', '"temperature of X", low')
    code = code.replace('rows="readings"', 'rows="readings", headline="m"')
    report = Study(gas.folder(tmp_path / "unequal", toml, unequal, code)).computed
    (table_of_m,) = Tables(Material(report)).budget()
    assert "Reading 3 (R-3) matters most" in str(table_of_m.legend)
    assert report.workbook.figures[0].caption.startswith("Warmer over temperature of X.")
    with pytest.raises(InputError, match="'R-1'"):
        _ = Study(gas.folder(tmp_path / "mixed", table=table)).inputs


def test_a_cell_without_a_value_is_told_with_the_name_of_its_row(tmp_path: Path) -> None:
    code = "from loopsheet import Method, let, measured\nclass Two(Method):\n    a = measured('m', 'a')\n"
    files = {
        "workbook.py": f"{code}    b = measured('m', 'b')\n    c = let(a * b, 'c')\n",
        "report.toml": 'workbook = "workbook.py"\n[measurements]\nfile = "measurements.csv"\n',
        "measurements.csv": "specimen,a [m],b [m]\nS-17,1.0,2.0\nS-18,1.1,\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    told = [each.sentence for each in Study(tmp_path).computed.oddities]
    assert any("b: 1 of 2 readings have no value: b[2] (S-18) #INPUT!" in each for each in told)


NOTE = "the door was open, 5 % of the time"


def test_a_name_stands_beside_its_row_in_every_table(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = gas.folder(tmp_path, table=gas.NAMED, code=gas.IN_TABLES)
    report = Study(folder).computed
    assert report.inputs.only.naming == ("specimen",)
    tables = Tables(Material(report)).data
    assert words(tables["measured"]) == [
        ["reading", "note", "specimen"],
        ["1", "", "=1+1"],
        ["2", NOTE, "@x <b>y</b>"],
        ["3", "", r"#9 {\a}"],
        ["4", "", "17"],
    ]
    assert [column.kind for column in tables["measured"].columns] == ["left", "words", "row", "number"]
    assert words(tables["computed"]) == [
        ["reading", "specimen"],
        ["1", "=1+1"],
        ["2", "@x <b>y</b>"],
        ["3", r"#9 {\a}"],
    ]
    assert main(["show", "warm", str(folder)]) == 0
    lines = [line.split("  u ")[0] for line in capsys.readouterr().out.splitlines() if "warm[" in line]
    assert lines[:2] == ["  warm[1]          =1+1         21.5", "  warm[2]          @x <b>y</b>  23.0"]
    assert main(["show", "m", str(folder)]) == 0  # of no row
    assert "12.766" in capsys.readouterr().out
    build.build(Study(folder), tmp_path / "out", ("html", "latex"))
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert page.count("<td class=row>@x &lt;b&gt;y&lt;/b&gt;<td") == 2
    assert f"<td class=w>{NOTE}<td" in page
    assert "reading 4 (17), fell" in page
    tex = (tmp_path / "out" / "report.tex").read_text(encoding="utf-8")
    assert r"3 & \#9 \{\textbackslash{}a\} & " in tex
    assert r"2 & the door was open, 5 \% of the time & @x " in tex
    assert r"\begin{tabular}{@{}l>{\raggedright\arraybackslash}p{0.2\linewidth}lS" in tex


def test_what_not_every_row_has_is_no_name(tmp_path: Path) -> None:
    table = gas.NAMED.replace("#9 {\\a}", "")
    assert table != gas.NAMED
    report = Study(gas.folder(tmp_path, table=table, code=gas.IN_TABLES)).computed
    assert report.inputs.only.naming == ()
    assert words(Tables(Material(report)).data["computed"])[:2] == [["reading"], ["1"]]
    (told,) = (check.message for check in report.oddities if check.name == "reading 4")
    assert told == "reading 4, fell"


def test_a_worksheet_has_them_as_texts_that_no_formula_reads(tmp_path: Path) -> None:
    plain, told = (
        Study(gas.folder(tmp_path / name, table=table))
        for name, table in (("plain", gas.TABLE + "4,30\n"), ("told", gas.NAMED.replace(",fell", ",")))
    )
    (_, bare), (grid, book) = (stages.book(study.computed) for study in (plain, told))
    assert [place.column for place in grid.words["readings"]] == [1, 2]
    sheet, other = (openpyxl.load_workbook(io.BytesIO(each))["readings"] for each in (book, bare))
    first = grid["T"].place.row + 1
    rows = [[cell.value for cell in row[:3]] for row in sheet.iter_rows(first, first + 3)]
    assert rows == [[1, None, "=1+1"], [2, NOTE, "@x <b>y</b>"], [3, None, r"#9 {\a}"], [4, None, "17"]]
    assert {cell.data_type for row in sheet.iter_rows(first, first + 3, 3, 3) for cell in row} == {"s"}
    assert [cell.value for cell in sheet[first - 4][1:3]] == ["note", "specimen"]
    assert sheet.freeze_panes == f"D{first}"
    # A name that begins as a code does is none.
    red = [str(each.sqref) for each in sheet.conditional_formatting if each.rules[0].type == "beginsWith"]
    assert red == [f"D{first}:{red[0].partition(':')[2]}"]
    # All else is as it would be without them, two columns further to the left.
    assert sheet.max_column == other.max_column + 2
    assert other.freeze_panes == f"B{first}"


def test_the_words_of_a_row_that_is_left_out_stand_with_it(tmp_path: Path) -> None:
    grid, book = stages.book(Study(gas.folder(tmp_path, table=gas.NAMED)).computed)
    sheet = openpyxl.load_workbook(io.BytesIO(book))["readings"]
    row = grid["T"].place.row + grid["T"].place.rows + 3
    assert [cell.value for cell in sheet[row][:4]] == ["4", "", "17", "30 [degC]"]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("operator", "T_", "unknown column 'T_'"),
        ("operator", "T_", "did you mean 'T', which is there? if it has words, give it a name less alike"),
        ("operator", "readings", "unknown column 'readings'"),
        ("operator", "left-out", "unknown column 'left-out'"),
        ("operator", "excluded", "unknown column 'excluded'"),
        ("operator", "Outlier?", "unknown column 'Outlier?'"),
        ("operator", "operator [1]", "unknown column 'operator'"),
        ("remark", "operator", "'operator'"),
        ("operator", "grain", None),  # four letters of 'reading', which is there
        ("open, 5 %", "open", None),
        ('"door open, 5 %"', "7", "unknown column 'remark'"),  # numbers may be meant to be computed with
        ("T [degC]", "T", "the column 'T' does not name its unit"),
    ],
)
def test_a_misspelt_column_is_still_refused(
    tmp_path: Path, old: str, new: str, said: str | None, capsys: pytest.CaptureFixture[str]
) -> None:
    assert TABLE.count(old) == 1
    code = main(["build", str(gas.folder(tmp_path, table=TABLE.replace(old, new))), "--to", "json"])
    err = capsys.readouterr().err
    assert (code, said is None or said in err) == ((0, True) if said is None else (2, True)), err


def test_accepting_knows_rows_by_their_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = {
        "workbook.py": "from loopsheet import Method, let, measured\n\n\nclass Double(Method, rows='runs'):\n"
        "    a = measured('mm', 'length')\n    b = let(2 * a, 'double', 'mm')\n",
        "m.csv": "run,name,a [mm]\n1,left,1.0\n2,right,2.0\n",
        "published.csv": "source,cell,index,value,unit,expect,reason\n"
        "T,b,left,2.0,mm,,\nT,b,right,5.0,mm,differs,a slip\n",
        "report.toml": 'workbook = "workbook.py"\n[measurements]\nfile = "m.csv"\n'
        '[published]\nfile = "published.csv"\n',
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    assert main(["check", "--accept", str(tmp_path)]) == 0, capsys.readouterr()
    assert (tmp_path / "published.csv").read_text().endswith("T,b,right,5.0,mm,differs,5.0 -> 4.0,a slip\n")


@pytest.mark.parametrize(
    ("operators", "refused"),
    [
        (("2", "1", "x", "y"), True),
        (("1", "2", "x", "y"), False),
        (("2", "2", "x", "y"), False),
        (("7", "8", "x", "y"), False),
        (("1" * 5000, "2", "x", "y"), False),
    ],
    ids=[
        "numbers of others",
        "its own number",
        "of several rows",
        "numbers of no row",
        "thousands of digits",
    ],
)
def test_no_row_is_called_by_the_number_of_another(
    operators: tuple[str, ...], refused: bool, tmp_path: Path
) -> None:
    """`p[2]` would be of the second row to some, and of the one that is called so to others."""
    rows = zip(TABLE.splitlines()[1:], operators, strict=True)
    named = [",".join((row.split(",")[0], name, *row.split(",")[2:])) for row, name in rows]
    folder = gas.folder(tmp_path, table="\n".join((TABLE.splitlines()[0], *named, "")))
    said = r"measurements\.csv:2:3[\s\S]*S2" if refused else ""
    with pytest.raises(InputError, match=said) if refused else nullcontext():
        assert Study(folder).inputs.only.remarks == ("operator", "remark")
