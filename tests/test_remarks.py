"""Columns of words beside what was measured come along, and nothing is computed from them."""

from pathlib import Path

import gas
import pytest

from loopsheet.report import build
from loopsheet.report.cli import main
from loopsheet.report.study import Study

TABLE = """\
reading,operator,T [degC],remark,left out
1,A <b>Smith</b>,20.0,,
2,B Jones,21.5,"door open, 5 %",
3,A <b>Smith</b>,-3.2,,
4,B Jones,30,,fell
"""


def test_they_come_along(tmp_path: Path) -> None:
    plain = Study(gas.folder(tmp_path / "plain")).computed
    report = Study(gas.folder(tmp_path / "told", table=TABLE)).computed
    assert report.inputs.remarks == ("operator", "remark")
    assert report.values.value["m"].tolist() == plain.values.value["m"].tolist()
    build.build(Study(tmp_path / "told"), tmp_path / "out", ("html", "latex", "json"))
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    said = "Remarks: operator: A &lt;b&gt;Smith&lt;/b&gt; (1, 3), B Jones (2, 4); remark: door open, 5 % (2)."
    assert said in page
    assert r"door open,{} 5 \% (2)" in (tmp_path / "out" / "report.tex").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("operator", "T_", "unknown column 'T_'"),
        ("operator", "readings", "unknown column 'readings'"),
        ("operator", "left-out", "unknown column 'left-out'"),
        ("operator", "excluded", "unknown column 'excluded'"),
        ("operator", "Outlier?", "unknown column 'Outlier?'"),
        ("operator", "operator [1]", "unknown column 'operator'"),
        ("remark", "operator", "'operator'"),
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
