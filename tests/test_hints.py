"""What a beginner writes wrong is told with its place and what to write instead."""

from pathlib import Path

import pytest

from loopsheet.report.messages.errors import InputError
from loopsheet.report.study import Study

CODE = """\
from loopsheet import Method, given, let, mean, measured, unknown


class Lab(Method, rows="readings", headline="m"):
    "Lab."

    x = measured("mm", "length")
    y = measured("N", "force")
    K = given("N/mm", "stiffness")
    z = let(K * x - y, "rest", "N")
    m = let(mean(z), "mean rest", "N")
"""
TABLE = "reading,x [mm],y [N]\n1,1.00,2.0\n2,1.10,2.2\n3,1.30,2.7\n"
FULLER = "reading,x [mm],y [N],z [N]\n1,1.00,2.0,3.0\n2,1.10,2.2,3.3\n"
EXPANDED = FULLER.replace("z [N]", "U(y) [mN]")
NOTED = "reading,x [mm],y [N],remark\n1,1,00,2.0,\n2,1.10,2.2,\n3,1.30,2.7,\n"
TOML = 'workbook = "workbook.py"\n[parameters]\nK = "2.00 N/mm"\n[measurements]\nfile = "measurements.csv"\n'
TOML_STATED = TOML.replace("2.00 ", "2.00(3) ") + '[uncertainty]\nK = "u = 0.03 N/mm"\n'
SHARED = '[uncertainty.shared.gauge]\nof = "x"\nstated = "u = 0.01 mm"\ngroups = [[1, 2], [2, 3]]\n'
WORDED = SHARED.replace("[[1, 2], [2, 3]]", '"batch"')


@pytest.mark.parametrize(
    ("file", "old", "new", "place", "told"),
    [
        ("report.toml", "", SHARED, "9:10", "the uncertainty of 2 in groups is stated twice"),
        ("report.toml", "", WORDED.replace("batch", "bathc"), "9:10", "a column of the table: x or y"),
        ("report.toml", "", '[limits]\nx = ">= 1 kg"\n', "7:5", "the limit of x is in 'kg'"),
        ("report.toml", "", '[limits]\nx = ">= 1"\n', "7:5", "the limit of x has no unit: '>= 1'"),
        ("report.toml", "", '[expected]\n"raeding 3" = "odd"\n', "7:1", "did you mean 'reading 3'?"),
        ("report.toml", "", '[expected]\n"reading 9" = "odd"\n', "7:1", "reading has no index '9'"),
        ("report.toml", "", '[uncertainty]\nz = "scatter"\n', "7:1", 'together: paired = ["x", "y"]'),
        ("report.toml", "", '[uncertainty]\nm = "u = 1 N"\n', "7:1", "from what is stated of x, y and K"),
        ("report.toml", TOML, TOML_STATED, "7:1", "what stands beside the numbers (report.toml:3:5)"),
        ("report.toml", "[measurements]", 'x = "1 mm"\n[measurements]', "4:1", "x is a measured column"),
        ("report.toml", "2.00", "2.00(3)e-1", "3:6", "stands before its uncertainty: 2.00e-1(3)"),
        ("report.toml", "N/mm", "N per mm", "3:13", "write / for per"),
        ("report.toml", "N/mm", "N/mm exact", "3:11", "a comma stands before what is stated: ', exact'"),
        ("report.toml", "N/mm", "N/mm u = 0.1", "3:11", "a comma stands before what is stated: ', u = 0.1'"),
        ("report.toml", '"measurements.csv"', '["a.csv", "b.csv"]', "5:8", "several files go into one"),
        ("report.toml", 'workbook = "workbook.py"', "", "None:None", 'write workbook = "workbook.py"'),
        ("report.toml", "", 2 * '[uncertainty]\nx = "u = 1 mm"\n', "8:13", "[uncertainty] is there twice"),
        ("report.toml", "", 2 * '[uncertainty]\nx = "u = 1 mm"\n', "8:13", "below the first"),
        ("workbook.py", "K * x", 'K["new"] * x', "10:5", "a formula names no single row or group"),
        ("workbook.py", "import ", "import max, ", "1:1", "max, min and sum are Python's"),
        ("workbook.py", 'rows="readings"', 'row="reading"', "4:1", 'rows="readings"'),
        ("workbook.py", "K * x", 'given("N", "F") * x', "10:5", "what is declared has a line of its own"),
        ("workbook.py", "K * x", "K (x)", "10:5", "is there a * missing"),
        ("workbook.py", "K * x", "K * x + m", "10:5", "m is declared below, in line 11: move this line"),
        ("workbook.py", "    z", "    K * x\n    let(y, 'force')\n    z", "11:5", "'force' has no name"),
        ("workbook.py", "K * x", "1 + K * x", "10:5", "a number has no unit; what is declared has"),
        ("workbook.py", "let(K * x - y,", "let(__import__('sympy').log(x),", "10:5", "log(c / c_0)"),
        ("workbook.py", "K * x", "K * x.mean()", "10:5", "mean(x) is its mean"),
        ("workbook.py", "K * x", "K * x^2", "10:5", "a power is written x**2"),
        ("workbook.py", '"mm"', '"milimeter"', "7:5", "did you mean 'millimeter'?"),
        ("workbook.py", "", '    q = unknown("nothing")\n', "12:5", "neither a root nor a fit finds it"),
        ("measurements.csv", "x [mm]", "gap [mm]", "1:9", "'x' is missing: did you mean that?"),
        ("measurements.csv", "reading,", "excluded,", "1:1", "a column 'left out' of the table"),
        ("report.toml", "", "[excluded]\n", "6:2", "a column 'left out' of the table"),
        ("measurements.csv", TABLE, NOTED, "2:12", "a comma separates fields: write 2.334"),
        ("measurements.csv", "2.0", "2.0,", "2:12", "a separator too many stands at the end"),
        ("measurements.csv", "1.10", "-", "3:3", "the cell of what was not measured is empty"),
        ("measurements.csv", "3,1.30", "2,1.30", "4:1", "reading 2 is there twice, first in line 3"),
        ("measurements.csv", TABLE, FULLER, "1:22", "allowed: reading, x, y, u(x), u(y) or left out"),
        ("measurements.csv", TABLE, EXPANDED, "1:22", "write 'u(y) [mN]', and below it standard"),
        ("measurements.csv", TABLE, EXPANDED.replace(" [mN]", ""), "1:22", "write 'u(y) [N]', and below it"),
        ("measurements.csv", "reading", "raeding", "1:1", "did you mean 'reading'?"),
    ],
)  # fmt: skip
def test_hints(tmp_path: Path, file: str, old: str, new: str, place: str, told: str) -> None:
    files = {"workbook.py": CODE, "measurements.csv": TABLE, "report.toml": TOML}
    files[file] = files[file].replace(old, new, 1) if old else files[file] + new
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        assert Study(tmp_path).computed
    (found,) = caught.value.diagnostics
    assert f"{found.at.line}:{found.at.column}" == place
    assert told in str(caught.value)


@pytest.mark.parametrize("row", ["reading 3", "test 3"])
def test_a_row_is_expected_to_be_odd_by_its_own_word(tmp_path: Path, row: str) -> None:
    table = TABLE.replace("3,1.30", "3,")
    more = f'[expected]\n"{row}" = "slipped"\n'
    for name, text in {"workbook.py": CODE, "measurements.csv": table, "report.toml": TOML + more}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    oddities = Study(tmp_path).computed.oddities
    assert f"{row}, slipped: x[3] has no value (#INPUT!)" in [check.message for check in oddities]


def test_a_column_of_words_tells_which_rows_share_an_error(tmp_path: Path) -> None:
    table = "reading,batch,x [mm],y [N],left out\n1,B,1.00,2.0,\n2,A,1.05,2.1,\n3,,1.10,2.2,\n4,B,1.30,2.7,\n"
    files = {"workbook.py": CODE, "measurements.csv": table + "5,A,1.0,2.0,slipped\n"}
    for name, text in {**files, "report.toml": TOML + WORDED}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    study = Study(tmp_path)
    (shared,) = study.inputs.uncertainty.shared
    assert shared.groups == ((1, 4), (2, 5))
    (budget,) = study.computed.uncertain().budgets
    told = {one.source.name for one in budget.contributions}
    assert {"gauge (readings 1, 4)", "gauge (readings 2, 5)"} <= told


def test_an_error_that_rows_share_names_them_by_their_own_word(tmp_path: Path) -> None:
    shared = SHARED.replace("[[1, 2], [2, 3]]", "[[1, 2], [3]]")
    for name, text in {"workbook.py": CODE, "measurements.csv": TABLE, "report.toml": TOML + shared}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    report = Study(tmp_path).computed
    (budget,) = report.uncertain().budgets
    assert {"gauge (readings 1, 2)", "gauge (reading 3)"} <= {one.source.name for one in budget.contributions}
    (tmp_path / "report.toml").write_text(TOML + shared.replace(", [3]", ""), encoding="utf-8")
    told = [check.message for check in Study(tmp_path).computed.oddities if check.kind == "groups"]
    assert told == ["gauge: reading 3 is in no group of it, and so without it; a group may be of one reading"]
