"""Published values as a user of `check` meets them: what counts as the same, what pins a difference."""

import json
import os
import re
import shutil
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_report import end_gauge

from loopsheet.report import stages
from loopsheet.report.cli import main
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.numpy import Program
from loopsheet.report.inputs.csvtable import read_table
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.inputs.published import PublishedValue, read_published
from loopsheet.report.inputs.sources import Source
from loopsheet.report.messages.errors import Findings
from loopsheet.report.prepared import Prepared
from loopsheet.report.referee import compare, refereed
from loopsheet.report.result.findings import of_comparison
from loopsheet.report.result.verdict import (
    OTHERWISE,
    UNEXPECTED,
    UNEXPLAINED,
    UNPINNED,
    Change,
    Explanation,
    Referee,
    Verdict,
)
from loopsheet.report.study import Study

Check = Callable[..., tuple[int, str]]


@pytest.fixture
def check(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Check:
    """Give a function that runs `check` in the folder; the engines are judged elsewhere."""
    monkeypatch.setattr(stages, "judged", lambda report, step: report)
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> tuple[int, str]:
        code = main(["check", *arguments, "."])
        captured = capsys.readouterr()
        assert code < 3, captured.err
        return code, captured.err if code == 2 else captured.out

    return run


def published(folder: Path, *rows: str, header: str = "source,cell,index,value,unit") -> Path:
    """The end gauge with these published values: 50.000623 mm is given, 50.000838 mm is its length."""
    end_gauge(folder, "\n".join((header, *rows, "")))
    return folder / "published.csv"


# --- what is wrong with them -------------------------------------------------------------------------------


def test_rows_and_the_cells_that_they_name_are_told_in_one_round(tmp_path: Path, check: Check) -> None:
    """Of a row without a number its cell is asked for too; a field that is refused is told of once."""
    rows = (
        "A,lenght,1,abc,mm",
        "A,l,77,1.0,mm",
        "A,l,x,1.0,nonsuch",
        "A,l_S,,1.0,K",
        ",d,1,0,m",
        "A,l,1,1,m",
    )
    published(tmp_path, *rows)
    toml = tmp_path / "report.toml"
    expected = '[expected]\n"lenght[2]" = ""\n"test 88" = "late"\n'
    toml.write_text(toml.read_text().replace("[published]", expected + "[published]\nfree = ['alfa']"))
    code, said = check()
    assert code == 2
    found = re.findall(r"^error\[(LS\d+)\].*\n *--> ([^:]*):(\d+)", said, re.MULTILINE)
    of_rows = sorted((int(line), code) for code, file, line in found if file.endswith("published.csv"))
    assert of_rows == [
        (2, "LS401"), (2, "LS505"), (3, "LS506"), (4, "LS421"), (4, "LS501"), (5, "LS422"), (6, "LS403"),
    ]  # fmt: skip
    assert sorted(code for code, file, _ in found if file.endswith(".toml")) == [
        "LS403", "LS505", "LS505", "LS506",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("row", "told"),
    [
        (
            "A,l,1,50.00084(2),mm",
            "the number alone; its uncertainty is a row of its own, with the cell u(l)\n",
        ),
        ("A,l,1,50.00084 ± 0.00002,mm", "a row of its own, with the cell u(l)\n"),
        ("A,u(l),1,0.00003(1),mm", "the number alone\n"),
        ("A,l,1,< 50.1,mm", "a line is of a number: take it out; [limits] says where a cell has to lie\n"),
        ("A,l,1,,mm", "a line is of a number: take it out; [limits] says where a cell has to lie\n"),
        ("A,l,1,5 0,mm", "write the digits without spaces"),
    ],
)
def test_an_uncertainty_behind_a_value_is_told_where_it_belongs(
    tmp_path: Path, check: Check, row: str, told: str
) -> None:
    published(tmp_path, row)
    code, said = check()
    assert code == 2
    assert told in said
    assert "41.6(2)" not in said


def free(folder: Path, *names: str) -> None:
    toml = folder / "report.toml"
    line = f"[published]\nfree = {list(names)}"
    toml.write_text(toml.read_text(encoding="utf-8").replace("[published]", line), encoding="utf-8")


@pytest.mark.parametrize(("names", "found"), [((), True), (("l",), True), (("alpha_S",), False)])
def test_a_published_number_is_not_excused_by_its_own_column_being_free(
    tmp_path: Path, check: Check, names: tuple[str, ...], found: bool
) -> None:
    published(tmp_path, "H.1,l,1,77.001838,mm")
    free(tmp_path, *names)
    code, said = check()
    assert (code, "l[1] prints 77.001838" in said) == ((1, True) if found else (0, False))


def test_what_is_measured_is_not_free(tmp_path: Path, check: Check) -> None:
    shutil.copytree(PAPER, tmp_path, dirs_exist_ok=True)
    toml = tmp_path / "report.toml"
    text = toml.read_text(encoding="utf-8").replace('free = ["ball_density"', 'free = ["x_p", "ball_density"')
    toml.write_text(text, encoding="utf-8")
    code, said = check()
    assert code == 2
    assert "is measured: its digits count" in said


# --- what prints the same ----------------------------------------------------------------------------------


def test_a_nought_that_is_none_is_told(tmp_path: Path, check: Check) -> None:
    published(tmp_path, "H.1,l,1,0,km", "H.1,theta,,-0.1,K")
    code, out = check()
    assert code == 0
    assert "2 print the same (1 as 0, which says little of a value)" in out


@pytest.mark.parametrize("text", ["50.000838", "5.0000838e1", "5.0000838E+01", "+50.000838", "50000.838e-3"])
def test_check_counts_what_prints_the_same_in_any_notation(tmp_path: Path, check: Check, text: str) -> None:
    published(tmp_path, f"H.1,l,1,{text},mm")
    code, out = check()
    assert code == 0
    assert "published  1 value: 1 prints the same, 0 differ as is known\n" in out
    assert "->" not in out


@pytest.mark.parametrize(
    ("cell", "value", "verdict"), [("theta", "0.2", "unreachable"), ("theta", "-0.1", "")]
)
def test_one_number_without_an_index_is_judged(
    tmp_path: Path, check: Check, cell: str, value: str, verdict: str
) -> None:
    """The simplest question: can this one number be right?"""
    published(tmp_path, f"H.1,{cell},,{value},K")
    code, out = check()
    assert code == bool(verdict)
    assert f"published  1 value: {'0 print' if verdict else '1 prints'} the same" in out
    assert verdict in out


def test_a_measured_nothing_is_refereed_as_any_other_number(tmp_path: Path, check: Check) -> None:
    end_gauge(tmp_path, "source,cell,index,value,unit\nH.1,l,1,50.000700,mm\n", d="test,d [nm]\n1,0\n2,204\n")
    code, out = check()
    assert code == 0
    assert " reachable" in out


def test_check_warns_of_a_file_that_lost_its_values(tmp_path: Path, check: Check) -> None:
    end_gauge(tmp_path, "source,cell,index,value,unit\n")
    code, out = check()
    assert code == 0
    assert "published  " not in out
    assert "report.toml:12:8: the file of published values holds none, so that nothing is compared" in out
    assert "no findings, 1 warning" in out


def test_a_value_of_seventy_digits_can_be_compared(tmp_path: Path, check: Check) -> None:
    published(tmp_path, "H.1,l,1,1.5,mm")
    toml = tmp_path / "report.toml"
    toml.write_text(toml.read_text().replace("50.000623 mm", "5e70 mm"))
    code, out = check()
    assert code == 1
    assert f"1.5 -> 5{'0' * 70}.0 " in out


# --- known differences -------------------------------------------------------------------------------------

KNOWN = "source,cell,index,value,unit,expect,recomputed,explained,reason"


@pytest.mark.parametrize(
    ("value", "rest", "column", "said"),
    [
        ("51.2", "differs,51.2 -> 50.0,,a slip", None, ""),
        ("51.2", "differs,5.12e1 -> 50.0,,a slip", None, ""),
        ("51.2", "differs,51.2 -> 50.0,misprint l_S,a slip", None, ""),
        ("51.2", "differs,,,a slip", 26, "and its known difference is not pinned: any other would pass"),
        (
            "51.3",
            "differs,51.2 -> 50.0,,a slip",
            10,
            "and differs otherwise than is known (51.2 -> 50.0)",
        ),
        (
            "51.2",
            "differs,51.2 -> 50.1,,a slip",
            10,
            "and differs otherwise than is known (51.2 -> 50.1)",
        ),
        ("51.2", "differs,51.20 -> 50.0,,a slip", 10, "and differs otherwise than is known"),
        (
            "51.2",
            "differs,51.2 -> 50.0,,",
            40,
            "and why it differs is not said; say it in the column 'reason'",
        ),
        (
            "51.2",
            "differs,51.2 -> 50.0,misprint theta,a slip",
            39,
            "and rests on 'misprint theta', which explains it no more",
        ),
        ("51.2", ",,,", 10, "(unreachable: by interval arithmetic"),
    ],
)
def test_a_known_difference_is_green_only_as_it_is_known(
    tmp_path: Path, check: Check, value: str, rest: str, column: int | None, said: str
) -> None:
    published(tmp_path, f"H.1,l_S,,{value},mm,{rest}", header=KNOWN)
    code, out = check("--format", "json")
    data = json.loads(out)
    assert code == int(column is not None)
    assert data["published"][0]["expected"] is (column is None)
    found = [each for each in data["findings"] if "l_S prints" in each and "published.csv" in each]
    start = f"published.csv:2:{column}: H.1 l_S prints {value}, recomputed 50.0"
    assert [each.startswith(start) and said in each for each in found] == [True] * code


def test_a_known_difference_that_is_none_is_a_finding(tmp_path: Path, check: Check) -> None:
    published(tmp_path, "H.1,l_S,,50.0,mm,differs,51.2 -> 50.0,,a slip", header=KNOWN)
    code, out = check()
    assert code == 1
    assert "published.csv:2:10: H.1 l_S prints 50.0 and no longer differs; drop its 'differs'" in out


def test_a_cell_without_a_value_may_be_known(tmp_path: Path) -> None:
    """Then it is the code that is pinned; the sheet of the paper has a pair without an exponent here."""
    folder = tmp_path / "campaign"
    shutil.copytree(PAPER, folder)
    tests = folder / "measurements.csv"
    tests.write_text(tests.read_text().replace("5,4.993,0.453,51.03", "5,4.993,0.453,23.03"))
    report = Study(folder).computed
    assert report.values.cell("alpha", (1, 5)).status.code == "#NOROOT!"
    path = folder / "published.csv"
    for again, finding, said in (
        ("#NOROOT!", "", "prints 1.299, recomputed #NOROOT! (not-checkable): a slip"),
        ("1.294", OTHERWISE, "cannot be checked: #NOROOT! alpha[1-5]: (11) has no root here: "),
    ):
        path.write_text(f"{KNOWN}\nT,alpha,1-5,1.299,1,differs,1.299 -> {again},,a slip\n")
        (comparison,) = Study(folder).computed.comparisons
        assert comparison.finding == finding
        assert of_comparison(comparison, "alpha[1-5]").message.startswith(f"T alpha[1-5] {said}")


TWICE = """\
from loopsheet import Method, let, measured


class Twice(Method, rows="runs"):
    \"\"\"Twice the length.\"\"\"

    a, b = measured("m", "length"), measured("m", "width")
    y = let(2 * a, "twice the length", "m")
    z = let(2 * b, "twice the width", "m")
"""


@pytest.mark.parametrize("expected", ["", "a[2]", "y[2]", "run 2"])
def test_what_has_no_value_is_not_excused_by_the_others(tmp_path: Path, check: Check, expected: str) -> None:
    """The others come out; what nobody can recompute is skipped where it is expected, else a finding."""
    toml = (
        'workbook = "workbook.py"\n[measurements]\nfile = "runs.csv"\n[published]\nfile = "published.csv"\n'
    )
    toml += f'[expected]\n"{expected}" = "not read"\n' if expected else ""
    lines = "source,cell,index,value,unit\nT,y,1,2.46,m\nT,z,2,3.13,m\nT,y,2,5.00,m\nT,u(y),2,0.01,m\n"
    files = {"report.toml": toml, "workbook.py": TWICE, "published.csv": lines}
    files["runs.csv"] = "run,a [m],b [m]\n1,1.23,2.22\n2,,1.56\n"
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    _, out = check("--format", "json")
    found = {each["name"]: each for each in json.loads(out)["checks"] if each["kind"] == "published"}
    told = [(each["passed"], each["skipped"]) for each in found.values()]
    assert list(found) == ["y[1]", "z[2]", "y[2]", "u(y)[2]"]
    assert told == [(True, False)] * 2 + [(bool(expected), bool(expected))] * 2
    assert "T y[2] cannot be checked: #INPUT! y[2] needs a[2]: " in found["y[2]"]["message"]
    said = (
        "4 values: 1 prints the same, 0 differ as is known, 1 comes out of other inputs that print as given, "
    )
    assert f"published  {said}2 cannot be checked\n" in check()[1]


CANCELLING = """\
from loopsheet import Method, let, mean, measured


class Spread(Method, rows="runs"):
    \"\"\"A mean, and a variance as a difference.\"\"\"

    x = measured("1", "reading")
    m = let(mean(x), "mean")
    s2 = let(mean(x**2) - mean(x) ** 2, "variance")
"""


@pytest.mark.parametrize(
    ("m", "s2", "wrong", "perhaps"),
    [
        ("1000.23333333333", "0.0155555555555556", [], ""),
        ("1000.23333333333", "0.0155555555555565", ["s2"], "s2 of T is printed 0.0155555555555565 for "),
        ("1000.2", "0.0155555555555556", [], ""),
        ("1000.3", "0.0155555555555556", ["m"], "m of T is printed 1000.3 for 1000.2: then all"),
    ],
)
def test_more_digits_than_doubles_keep_are_right_or_wrong_all_the_same(
    tmp_path: Path, check: Check, m: str, s2: str, wrong: list[str], perhaps: str
) -> None:
    """Of the variance, 7/450, NumPy keeps eight digits."""
    toml = 'workbook = "workbook.py"\n[measurements]\nfile = "runs.csv"\n[uncertainty]\nx = "exact"\n'
    files = {"report.toml": f'{toml}[published]\nfile = "published.csv"\n', "workbook.py": CANCELLING}
    files["published.csv"] = f"source,cell,index,value,unit\nT,m,,{m},1\nT,s2,,{s2},1\n"
    files["runs.csv"] = "run,x [1]\n1,1000.1\n2,1000.2\n3,1000.4\n"
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    code, out = check("--format", "json")
    told = json.loads(out)
    failed = [each["name"] for each in told["checks"] if each["kind"] == "published" and not each["passed"]]
    assert (code, failed) == (int(bool(wrong)), wrong)
    assert perhaps in told["findings"][-1] if perhaps else not told["referee"]["explanations"]


def test_a_difference_of_an_old_file_is_not_pinned(tmp_path: Path, check: Check) -> None:
    published(
        tmp_path, "H.1,l_S,,51.2,mm,differs,a slip", header="source,cell,index,value,unit,expect,reason"
    )
    code, out = check("--format", "json")
    assert code == 1
    assert json.loads(out)["findings"][0] == (
        "published.csv:2:10: H.1 l_S prints 51.2, recomputed 50.0, and its known difference is not pinned: "
        "any other would pass; 'loopsheet check --accept FOLDER' pins it"
    )


def test_the_referee_excuses_no_known_difference(tmp_path: Path) -> None:
    """What is reachable need not print the same; what is known to differ has to differ as is known."""
    published(
        tmp_path,
        "H.1,l,1,50.1,mm,,,,",
        "H.1,l,2,50.1,mm,differs,,,a slip",
        "H.1,l_S,,51.2,mm,differs,51.2 -> 50.0,label x (T),a slip",
        header=KNOWN,
    )
    comparisons = Study(tmp_path).computed.comparisons
    assert [c.finding for c in comparisons] == [UNEXPECTED, UNPINNED, ""]
    said = Referee((Verdict("reachable"), Verdict("reachable"), Verdict("unreachable")))
    assert [c.finding for c in refereed(comparisons, said)] == ["", UNPINNED, UNEXPLAINED]
    exchanged = Explanation((Change("label", "x", (), "T", "1", "2"),), 0.5, 3, 3)
    explained = Referee(said.values, explanations=(exchanged,))
    assert [c.finding for c in refereed(comparisons, explained)] == ["", UNPINNED, ""]


# --- the paper ---------------------------------------------------------------------------------------------


def one_digit_off(text: str) -> Iterator[str]:
    """A number with one of its digits one more or one less."""
    for place, digit in enumerate(text):
        for other in (int(digit) - 1, int(digit) + 1) if digit.isdigit() else ():
            if 0 <= other <= 9:
                yield f"{text[:place]}{other}{text[place + 1 :]}"


def test_every_digit_of_the_paper_is_pinned() -> None:
    """One digit more or less in any published or measured value, and a known difference is another one.

    That is seen before the referee is asked, and the referee excuses no known difference.
    """
    report = Study(PAPER).computed
    program, prepared = Program.of(report.sheet), Prepared(report.inputs, report.sheet)
    assert all(c.published.pin is not None and c.as_expected for c in report.comparisons)
    rows = (PAPER / "published.csv").read_text().splitlines()
    tried = 0
    for line, row in enumerate(rows[1:], start=1):
        cells = row.split(",")
        for text in one_digit_off(cells[3]):
            changed = [*rows[:line], ",".join([*cells[:3], text, *cells[4:]]), *rows[line + 1 :]]
            found = compare(published_in(changed), report.values)
            assert [n for n, c in enumerate(found) if not c.as_expected] == [line - 1], text
            tried += 1
    for name, column in report.inputs.measured.items():
        for row, printed in enumerate(column):
            for text in one_digit_off(printed.text):
                data = {**prepared.data, name: list(prepared.data[name])}
                data[name][row] = float(Fraction(text) * printed.scale)
                values = engine.evaluate(report.sheet, prepared.labels, data, program)
                found = compare(report.inputs.published, values)
                assert not all(c.as_expected for c in found), (name, row, text)
                tried += 1
    assert tried > 270


def published_in(rows: list[str]) -> tuple[PublishedValue, ...]:
    findings = Findings()
    found = read_published(Source("p", "p", "\n".join(rows)), findings)
    findings.check()
    return found


# --- accepting ---------------------------------------------------------------------------------------------

ROWS = (
    "H.1,l,1,50.000838,mm,,,",
    "H.1,l,2,70.5,mm,differs,,read off a plot",
    "H.1,l_S,,51.2,mm,differs,51.2 -> 49.9,a slip",
    "H.1,theta,,0.2,K,,,",
    "H.1,d,1,215,nm,differs,216 -> 215,a slip",
    "H.1,d,2,207,nm,differs,,",
)
HEADER = "source,cell,index,value,unit,expect,recomputed,reason"
ACCEPTED = (
    "H.1,l,1,50.000838,mm,,,",
    "H.1,l,2,70.5,mm,differs,70.5 -> 50.0,read off a plot",
    "H.1,l_S,,51.2,mm,differs,51.2 -> 50.0,a slip",
    "H.1,theta,,0.2,K,,,",
    "H.1,d,1,215,nm,,,",
    "H.1,d,2,207,nm,differs,207 -> 204,",
)


@pytest.mark.parametrize("recomputed", ["", "51.2 -> 49.9", "51.2 -> 50.0"])
def test_accepting_takes_back_an_explanation_that_is_none_and_is_done_at_once(
    tmp_path: Path, check: Check, recomputed: str
) -> None:
    """What it has written it accepts, and a second time there is nothing to write."""
    path = published(tmp_path, f"H.1,l_S,,51.2,mm,differs,{recomputed},misprint d[1],a slip", header=KNOWN)
    assert check()[0] == 1
    code, out = check("--accept")
    assert (code, out.splitlines()[0]) == (0, "published.csv: 1 line changed")
    assert path.read_text().splitlines()[1] == "H.1,l_S,,51.2,mm,differs,51.2 -> 50.0,,a slip"
    assert check("--accept") == (0, "published.csv: no lines changed\n")


def test_accepting_writes_what_is_recomputed_and_shows_it(tmp_path: Path, check: Check) -> None:
    path = published(tmp_path, *ROWS, header=HEADER)
    code, out = check("--accept")
    assert path.read_text() == "\n".join((HEADER, *ACCEPTED, ""))
    assert out.splitlines()[:9] == [
        "published.csv: 4 lines changed",
        *(
            f"  {line} {sign} {row}" if sign == "-" else f"    {sign} {row}"
            for line in (3, 4, 6, 7)
            for sign, row in (("-", ROWS[line - 2]), ("+", ACCEPTED[line - 2]))
        ),
    ]
    # Of what nobody announced, and of what has no reason, none is invented.
    assert code == 1
    left = [line for line in out.splitlines() if line.startswith("finding: published.csv:")]
    assert [line.split(": ")[1] for line in left] == ["published.csv:5:12", "published.csv:7:35"]
    assert (
        "1 more value differs and is not written: say why, with --reason 'a sentence' or in the column" in out
    )
    code, out = check("--accept", "--reason", 'as "printed", by hand')
    assert code == 0
    assert "not written" not in out
    quoted = '"as ""printed"", by hand"'
    assert path.read_text().splitlines()[4:7] == [
        f"H.1,theta,,0.2,K,differs,0.2 -> -0.1,{quoted}",
        "H.1,d,1,215,nm,,,",
        f"H.1,d,2,207,nm,differs,207 -> 204,{quoted}",
    ]
    before = path.stat()
    code, out = check("--accept")
    assert (code, out.splitlines()[0]) == (0, "published.csv: no lines changed")
    assert path.stat().st_mtime_ns == before.st_mtime_ns
    assert check()[0] == 0


def test_a_table_without_the_columns_gets_those_it_needs(tmp_path: Path, check: Check) -> None:
    path = published(tmp_path, "H.1,l_S,,51.2,mm", "H.1,l,1,50.000838,mm")
    assert check("--accept")[0] == 1
    assert path.read_text() == "source,cell,index,value,unit\nH.1,l_S,,51.2,mm\nH.1,l,1,50.000838,mm\n"
    code, out = check("--accept", "--reason", "a slip")
    assert path.read_text() == (
        "source,cell,index,value,unit,expect,recomputed,reason\n"
        "H.1,l_S,,51.2,mm,differs,51.2 -> 50.0,a slip\nH.1,l,1,50.000838,mm,,,\n"
    )
    assert code == 0
    assert out.startswith("published.csv: 2 lines changed\n  1 - source,cell,index,value,unit\n")
    assert "  1 more got an empty field" in out
    path = published(
        tmp_path, "differs,H.1,l_S,,51.2,mm,a slip", header="expect,source,cell,index,value,unit,reason"
    )
    assert check("--accept")[0] == 0
    assert path.read_text().splitlines()[1] == "differs,51.2 -> 50.0,H.1,l_S,,51.2,mm,a slip"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("{h}\n{r}\n", "{h2}\n{r2}\n"),
        ("{h}\r\n{r}\r\n{s}\r\n", "{h2}\r\n{r2}\r\n{s2}\r\n"),
        ("{h}\r{r}\r", "{h2}\r{r2}\r"),
        ("\ufeff{h}\n{r}", "\ufeff{h2}\n{r2}"),
        ("{h}\n{r}\n\n ,,,,,,\n\n", "{h2}\n{r2}\n\n ,,,,,,\n\n"),
        ("{h}\n{s}\n{r}\n", "{h2}\n{s2}\n{r2}\n"),
        (
            'source, cell ,"index",value,unit,expect,reason\n'
            '"H.1",\tl_S , ,51.2, mm,"differs" , "a\r\n""slip"", µ" \n',
            'source, cell ,"index",value,unit,expect,recomputed,reason\n'
            '"H.1",\tl_S , ,51.2, mm,"differs" ,51.2 -> 50.0, "a\r\n""slip"", µ" \n',
        ),
        ('"{h3}"\n"{r3}"\n', '"{h4}"\n"{r4}"\n'),
        ("{h2}\n{r5}, 1 -> 2\t,a\n", "{h2}\n{r5}, 51.2 -> 50.0\t,a\n"),
        ('{h2}\n{r5},"",a\n', '{h2}\n{r5},"51.2 -> 50.0",a\n'),
    ],
)
def test_accepting_keeps_every_other_byte(tmp_path: Path, check: Check, before: str, after: str) -> None:
    """Line ends, byte order mark, quotes, blanks, empty lines at the end, rows over several lines."""
    parts = {
        "h": "source,cell,index,value,unit,expect,reason",
        "h2": "source,cell,index,value,unit,expect,recomputed,reason",
        "r": "H.1,l_S,,51.2,mm,differs,a slip",
        "r2": "H.1,l_S,,51.2,mm,differs,51.2 -> 50.0,a slip",
        "s": "H.1,l,1,50.000838,mm,,",
        "s2": "H.1,l,1,50.000838,mm,,,",
        "h3": '","'.join(HEADER.replace("recomputed,", "").split(",")),
        "h4": '","'.join(HEADER.split(",")),
        "r3": '","'.join(("H.1", "l_S", "", "51.2", "mm", "differs", "a")),
        "r4": '","'.join(("H.1", "l_S", "", "51.2", "mm", "differs", "51.2 -> 50.0", "a")),
        "r5": "H.1,l_S,,51.2,mm,differs",
    }
    path = published(tmp_path)
    path.write_bytes(before.format(**parts).encode())
    code, out = check("--accept")
    assert path.read_bytes().decode() == after.format(**parts)
    assert code == 0, out


FIELDS = st.one_of(
    st.text("ab1. é\u00a0\t", max_size=4),
    st.text('ab, "\r\n', max_size=5).map(lambda text: '"' + text.replace('"', '""') + '"'),
    st.sampled_from(('"" ', ' "a" ', "\t")),
)


@given(st.lists(st.tuples(FIELDS, FIELDS), min_size=1, max_size=4), st.sampled_from(("\n", "\r\n")))
def test_a_row_is_what_stands_between_its_separators(pairs: list[tuple[str, str]], end: str) -> None:
    """From beginning to end its fields are the row, quotes and blanks and all."""
    rows = [[one, "x", other] for one, other in pairs]
    text = end.join(["a,b,c", *map(",".join, rows)])
    table = read_table(Source("p", "p", text), ("a", "b", "c"), Findings())
    assert table is not None
    assert [[text[field.begin : field.end] for field in row.fields] for row in table.rows] == rows
    assert [text[row.offset : row.fields[-1].end] for row in table.rows] == [",".join(row) for row in rows]


def test_accepting_leaves_the_file_alone_if_it_cannot_be_written(tmp_path: Path, check: Check) -> None:
    path = published(tmp_path, *ROWS, header=HEADER)
    before = path.read_bytes()
    path.chmod(0o444)
    code, out = check("--accept")
    assert code == 2
    assert "error[LS613]: 'published.csv' cannot be written: it is read-only\n  --> published.csv\n" in out
    assert path.read_bytes() == before
    assert sorted(os.listdir(tmp_path)) == ["d.csv", "published.csv", "report.toml", "workbook.py"]


def test_accepting_leaves_a_file_alone_that_has_changed_meanwhile(
    tmp_path: Path, check: Check, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = published(tmp_path, *ROWS, header=HEADER)
    honest = stages.refereed

    def meanwhile(*arguments):  # type: ignore[no-untyped-def]
        path.write_text("somebody else's\n")
        return honest(*arguments)

    monkeypatch.setattr(stages, "refereed", meanwhile)
    code, out = check("--accept")
    assert code == 2
    assert "somebody has changed it meanwhile" in out
    assert path.read_text() == "somebody else's\n"


def test_accepting_follows_a_link_and_keeps_the_permissions(tmp_path: Path, check: Check) -> None:
    path = published(tmp_path, *ROWS, header=HEADER)
    (tmp_path / "tables").mkdir()
    target = path.rename(tmp_path / "tables" / "own.csv")
    path.symlink_to(target)
    target.chmod(0o640)
    check("--accept")
    assert path.is_symlink()
    assert target.stat().st_mode & 0o777 == 0o640
    assert "70.5 -> 50.0" in target.read_text()


def test_accepting_needs_a_folder_and_a_reason_needs_accepting(
    tmp_path: Path, check: Check, capsys: pytest.CaptureFixture[str]
) -> None:
    published(tmp_path, *ROWS, header=HEADER)
    assert main(["check", "--accept", "paper"]) == 2
    assert "LS614" in capsys.readouterr().err
    for arguments in (("--reason", "a slip"), ("--accept", "--reason", "a\x1bslip")):
        code, out = check(*arguments)
        assert (code, "LS614" in out) == (2, True)
    assert (tmp_path / "published.csv").read_text().splitlines()[1:] == list(ROWS)


def test_accepting_tells_machines_what_is_left(tmp_path: Path, check: Check) -> None:
    published(tmp_path, *ROWS, header=HEADER)
    code, out = check("--accept", "--format", "github")
    assert code == 1
    assert out.startswith("::error file=published.csv,line=5,col=12,")
    toml = tmp_path / "report.toml"
    toml.write_text(toml.read_text().partition("[published]")[0])
    assert check("--accept")[0] == 0
