"""What is published of the uncertainty of a cell: how it is written, and what is refused."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from helpers import method_folder
from small_report import FILES, end_gauge

from loopsheet.report.cli import main
from loopsheet.report.inputs.about import About, read_about
from loopsheet.report.study import Study

HEADER = "source,cell,index,value,unit,expect,recomputed,reason"


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("u(l)", About("u", "l")),
        ("u1( l )", About("u1", "l")),
        ("u(l, d)", About("u", "l", "d")),
        ("U99(l)", About("U", "l", "", 0.99)),
        ("k95.45(l)", About("k", "l", "", 0.9545)),
        ("U(l, k=2)", About("U", "l", factor=2.0)),
        ("U( l , k = 1.96 )", About("U", "l", factor=1.96)),
        *((text, None) for text in ("U(l, k=0)", "U95(l, k=2)", "u(l, k=2)x", "U(l, 2)", "U(l, k=-2)")),
        ("dof(l)", About("dof", "l")),
        ("r(R,X)", About("r", "R", "X")),
        ("low95(Y)", About("low", "Y", "", 0.95)),
        *((text, None) for text in ("l", "u", "u()", "u(l", "u(l))", "q(l)", "r(l)", "U(l)", "U0(l)")),
        *((text, None) for text in ("u1(l, d)", "U95(l, d)", "U100(l)", "dof(l, d)", "u(l, d, e)", "u((l))")),
    ],
)  # fmt: skip
def test_how_it_is_written(text: str, meant: About | None) -> None:
    assert read_about(text) == meant


@pytest.mark.parametrize(
    ("row", "code", "said"),
    [
        ("H.1,q(l),1,1,mm,,,", "LS509", "'q(l)' is nothing that is told of a cell"),
        ("H.1,u(nothing),1,1,mm,,,", "LS505", "the sheet has no cell 'nothing'"),
        ('H.1,"u(l, nothing)",1,1,mm,,,', "LS505", "the sheet has no cell 'nothing'"),
        ("H.1,u(l),3,1,mm,,,", "LS506", "l has no index '3'"),
        ('H.1,"r(l, theta)",1,1,1,,,', "LS506", "theta has no index '1'"),
        ("H.1,u(l),1,1,K,,,", "LS422", "l"),
        ("H.1,k95(l),1,1,mm,,,", "LS422", "mm"),
    ],
)
def test_what_is_wrong_is_told_where_it_stands(
    tmp_path: Path, row: str, code: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    end_gauge(tmp_path, f"{HEADER}\n{row}\n")
    assert main(["check", str(tmp_path)]) == 2
    told = capsys.readouterr().err
    assert f"error[{code}]" in told
    assert said in told
    assert "published.csv:2:" in told


def test_an_expanded_uncertainty_of_a_chosen_factor_is_so_many_u(tmp_path: Path) -> None:
    """Of two degrees of freedom U95 is more than twice u."""
    folder = end_gauge(tmp_path, f"{HEADER}\n" + "H.1,u(l),1,1,mm,,,\n")
    u = Study(folder).refereed.comparisons_u[0].cell.value
    assert u is not None
    rows = f'H.1,"U(l, k=2)",1,{2e9 * u:.3f},nm,,,\nH.1,"U(l, k=3)",1,{2e9 * u:.3f},nm,,,\n'
    (folder / "published.csv").write_text(f"{HEADER}\n{rows}")
    assert [each.verdict for each in Study(folder).refereed.comparisons_u] == ["same", "differs"]


@pytest.mark.parametrize(("mode", "right"), [("", 0), ("up", 1), ("truncated", 0)])
def test_an_uncertainty_may_have_been_rounded_up(tmp_path: Path, mode: str, right: int) -> None:
    """Where that is said; a whole unit too much is wrong even so."""
    folder = end_gauge(tmp_path, f"{HEADER}\n" + "H.1,u(l),1,1,nm,,,\n")
    u = Study(folder).refereed.comparisons_u[0].cell.value
    assert u is not None
    tenths = math.floor(1e10 * u)
    assert 0.1 < 1e10 * u - tenths < 0.4
    said = f'[published.printed]\n"u(l)" = "{mode}"\n' if mode else ""
    toml = folder / "report.toml"
    toml.write_text(toml.read_text(encoding="utf-8") + said, encoding="utf-8")
    for more in (-1, 0, 1, 2):
        row = f"H.1,u(l),1,{(tenths + more) / 10:.1f},nm,,,\n"
        (folder / "published.csv").write_text(f"{HEADER}\n{row}", encoding="utf-8")
        (found,) = Study(folder).refereed.comparisons_u
        assert found.verdict == ("same" if more == right else "differs"), row


def test_only_an_uncertainty_is_rounded_up(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    end_gauge(tmp_path, f"{HEADER}\n" + "H.1,l,1,50.000838,mm,,,\n")
    toml = tmp_path / "report.toml"
    toml.write_text(toml.read_text(encoding="utf-8") + '[published.printed]\nl = "up"\n', encoding="utf-8")
    assert main(["check", str(tmp_path)]) == 2
    assert "error[LS208]" in capsys.readouterr().err


def test_a_known_difference_of_an_uncertainty_is_pinned_in_its_row(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", "")
    rows = "H.1,u(l),1,99,nm,,,\nH.1,l,1,50.000838,mm,,,\nH.1,u(l),2,98,nm,,,\n"
    exact = "".join(f'{name} = "exact"\n' for name in ("d", "dalpha", "alpha_S", "theta", "cycle", "dtheta"))
    toml = FILES["report.toml"].replace(' mm"', ' mm, u = 25 nm"') + f"[uncertainty]\n{exact}"
    end_gauge(tmp_path, f"{HEADER}\n{rows}", report=toml)
    assert main(["check", str(tmp_path)]) == 1
    assert "H.1 u(l)[1] prints 99, recomputed 25 (differs)" in capsys.readouterr().out
    assert main(["check", "--accept", "--reason", "rounded up", str(tmp_path)]) == 0
    lines = (tmp_path / "published.csv").read_text(encoding="utf-8").splitlines()
    assert lines[1:] == [
        "H.1,u(l),1,99,nm,differs,99 -> 25,rounded up",
        "H.1,l,1,50.000838,mm,,,",
        "H.1,u(l),2,98,nm,differs,98 -> 25,rounded up",
    ]
    assert main(["check", str(tmp_path)]) == 0
    (tmp_path / "published.csv").write_text(f"{HEADER}\nH.1,u(l_S),,25,nm,,,\n", encoding="utf-8")
    assert main(["check", str(tmp_path)]) == 0


def test_the_report_shows_them_beside_what_is_computed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", "")
    rows = "Table 8,u(l_S),,25,nm,,,\nTable 9,u(l_S),,26,nm,differs,26 -> 25,a slip\n"
    toml = FILES["report.toml"].replace(' mm"', ' mm, u = 25 nm"')
    end_gauge(tmp_path, f"{HEADER}\n{rows}", report=toml)
    assert main(["build", str(tmp_path), "--to", "html,latex"]) == 0
    for name in ("report.html", "report.tex"):
        told = (tmp_path / "out" / name).read_text(encoding="utf-8")
        assert "Published uncertainties" in told
        assert "a slip" in told
        assert "26" in told


SIGNS = """from loopsheet import Method, let, mean, measured


class Signs(Method, rows="readings"):
    'Values of both signs.'

    x = measured("mm", "length")
    y = let(-x / 7, "share", "mm")
    m = let(mean(y), "mean share", "mm")
"""


@pytest.mark.parametrize(
    ("modes", "m", "u", "differs"),
    [
        ('m = "truncated"\n"u(y)" = "truncated"', "-2.88", "0.0041", 0),
        ('m = "truncated"\n"u(y)" = "truncated"', "-2.89", "0.0041", 1),
        ('m = "truncated"\n"u(y)" = "truncated"', "-2.88", "0.0042", 1),
        ('m = "truncated"', "-2.88", "0.0041", 1),
        ('"u(y)" = "truncated"', "-2.89", "0.0041", 0),
    ],
)
def test_digits_were_cut_off_of_what_is_said_to_be_truncated(
    tmp_path: Path, modes: str, m: str, u: str, differs: int
) -> None:
    """A mean of -2.88571 and u = 0.00419: each of both ways is told from the other."""
    published = f"source,cell,index,value,unit\nT,m,,{m},mm\nT,u(y),1,{u},mm\n"
    toml = 'workbook = "workbook.py"\n[measurements]\nfile = "m.csv"\n[uncertainty]\nx = "u = 0.0293 mm"\n'
    toml += f'[published]\nfile = "published.csv"\n[published.printed]\n{modes}\n'
    table = "reading,x [mm]\n1,10.0000\n2,20.0000\n3,30.6000\n"
    files = {"workbook.py": SIGNS, "published.csv": published, "report.toml": toml, "m.csv": table}
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    study = Study(tmp_path)
    found = [c for c in (*study.refereed.comparisons, *study.refereed.comparisons_u) if c.verdict != "same"]
    assert len(found) == differs


TWO = """\
from loopsheet import Method, given, let


class Two(Method):
    a = given("1", "one")
    b = given("1", "other")
    y = let(a + b, "sum")
"""


@pytest.mark.parametrize(
    ("text", "same"),
    [("6.86", True), ("6.9", True), ("7", True), ("6", True), ("6.80", False), ("5", False), ("8", False)],
)
def test_degrees_of_freedom_are_printed_truncated_or_before(tmp_path: Path, text: str, same: bool) -> None:
    """Two equal errors of 4 and 3 degrees of freedom have 4 / (1/4 + 1/3) = 6.857 (JCGM 100, G.2b)."""
    errors = 'a = "1.00, u = 0.01, dof = 4"\nb = "1.00, u = 0.01, dof = 3"\n'
    published = f"{HEADER}\nT,dof(y),,{text},1,,,\n"
    method_folder(tmp_path, TWO, more=f"[parameters]\n{errors}", published=published)
    (found,) = Study(tmp_path).refereed.comparisons_u
    assert (found.verdict == "same") is same


@pytest.mark.parametrize(("text", "reached"), [("2.1", True), ("2", True), ("2.9", False)])
def test_degrees_of_freedom_are_looked_for_as_they_are_printed(
    tmp_path: Path, text: str, reached: bool
) -> None:
    """Of two numbers of which u is a share: these print as given while their ratio changes."""
    stated = '[parameters]\na = "1.0"\nb = "0.1"\n'
    stated += '[uncertainty]\na = "u = 20 % of reading, dof = 2"\nb = "u = 20 % of reading, dof = 2"\n'
    method_folder(tmp_path, TWO, more=stated, published=f"{HEADER}\nT,dof(y),,{text},1,,,\n")
    (found,) = Study(tmp_path).refereed.comparisons_u
    assert (found.verdict == "same" or found.refereed is not None) is reached


THRICE = """
from loopsheet import Method, given, let

class Thrice(Method):
    "A number and three of it."
    a = given("1", "number")
    y = let(3 * a, "three of it")
"""


@pytest.mark.parametrize(
    ("stated", "u", "reached"),
    [
        ("u = 0.12", "0.37", True),  # of 0.1234, say
        ("u = 0.12", "0.39", False),
        ("u = 0.120", "0.37", False),
        ("6 % of reading", "0.37", False),  # what is specified is as it is
        ("+-0.21 rect", "0.37", False),
        ("u = 60000 ppm", "0.37", False),
        ("u = 120 digits", "0.37", False),  # of a thousandth, and a count
        ("u = 0.1 + 2 % of reading", "0.32", False),  # the digit is of the first alone
    ],
)
def test_authors_compute_with_more_digits_of_an_uncertainty_than_they_print(
    tmp_path: Path, stated: str, u: str, reached: bool
) -> None:
    method_folder(
        tmp_path,
        THRICE,
        more=f'[parameters]\na = "2.000, {stated}"\n',
        published=f"{HEADER}\nT,u(y),,{u},1,,,\n",
    )
    (found,) = Study(tmp_path).refereed.comparisons_u
    assert found.verdict == "differs"
    assert (found.refereed is not None) is reached
