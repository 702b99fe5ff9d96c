"""A method as the body of a class: what a name stands for, and what is told of a wrong line."""

import contextvars
import math
import re
import subprocess
import sys
from pathlib import Path

import mpmath
import pytest
from sympy import Symbol, pi, sin, sqrt

import loopsheet
import loopsheet.report.method
from loopsheet import Method, count, given, let, mean, measured, root, total, unknown
from loopsheet.report.cli import main
from loopsheet.report.column import Root, SheetError
from loopsheet.report.sheet import Sheet
from loopsheet.report.study import Study
from loopsheet.report.views import charts
from loopsheet.report.workbook import Workbook

README = Path(__file__).parent.parent / "README.md"


def sheet_of(method: type[Method]) -> Sheet:
    return method.workbook.sheet(frozenset())


class Pendulum(Method, source="C Huygens, Horologium oscillatorium", rows="swings"):
    """Free fall by a pendulum.

    The title is the first line alone.
    """

    T = measured("s", "period", positive=True)
    length = given("m", "length of the thread", positive=True)
    four_pi = 4 * pi**2
    g_k = let(four_pi * length / T**2, "free fall of a swing")
    g = let(mean(g_k), "free fall", "m/s^2", label="(H.1)")
    s = let(sqrt(total((g_k - g) ** 2) / (count() - 1)), "scatter")


def test_a_body_is_a_workbook() -> None:
    book = Pendulum.workbook
    assert isinstance(book, Workbook)
    assert (book.name, book.title, book.headline) == ("pendulum", "Free fall by a pendulum", ("s",))
    assert [one.name for one in book.measured] == ["T"]
    assert not book.parameters[0].bounds.allow(0.0)
    assert book.parameters[0].bounds.allow(1e-9)
    assert [entry.label for entry in book.ledger().entries] == ["(1)", "(H.1)", "(3)"]


def test_rows_and_units_follow_from_the_formula() -> None:
    sheet = sheet_of(Pendulum)
    assert {c.name: c.axis and c.axis.name for c in sheet.columns} == {
        "T": "swings",
        "length": None,
        "g_k": "swings",
        "g": None,
        "s": None,
    }
    assert {name: sheet[name].unit for name in ("g_k", "g", "s")} == {
        "g_k": "m*s^-2",
        "g": "m/s^2",
        "s": "m*s^-2",
    }


def test_a_root_of_every_row() -> None:
    class Kepler(Method):
        """Kepler's equation."""

        M = measured("1", "mean anomaly")
        ecc = given("1", "eccentricity", low=0, high=0.9)
        E = unknown()
        E = root(E - ecc * sin(E), M, "eccentric anomaly", low=M - 1, high=M + 1, start=M)

    column = sheet_of(Kepler)["E"]
    assert isinstance(column.rule, Root)
    assert column.axis is not None
    assert column.rule.unknown == Symbol("E", real=True)


PIPE = """\
from sympy import log, sqrt

from loopsheet import Method, given, let, root, unknown


class Colebrook(Method, source="C F Colebrook, J. Inst. Civ. Eng. 11 (1939) 133"):
    \"\"\"Friction factor of a rough pipe.\"\"\"

    Re = given("1", "Reynolds number", low=4000, high=1e8)
    rough = given("1", "roughness over diameter", low=0, high=0.05)
    f = unknown()
    turbulent = -2 * log(rough / 3.7 + 2.51 / (Re * sqrt(f))) / log(10)
    f = root(1 / sqrt(f), turbulent, "friction factor", low=0.004, high=0.2, start=0.02)
"""


def folder(path: Path, code: str, parameters: str) -> Path:
    (path / "workbook.py").write_text(code, encoding="utf-8")
    toml = f'title = "T"\nworkbook = "workbook.py"\n[parameters]\n{parameters}'
    (path / "report.toml").write_text(toml, encoding="utf-8")
    return path


def test_a_root_in_a_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The friction factor of Colebrook's equation by mpmath, and decimals as they were typed."""
    where = folder(tmp_path, PIPE, 'Re = "1.00e5, u = 1e3"\nrough = "0.0010"\n')
    report = Study(where).report

    def residual(f: mpmath.mpf) -> mpmath.mpf:
        inside = mpmath.mpf("0.001") / mpmath.mpf("3.7") + mpmath.mpf("2.51") / (100_000 * mpmath.sqrt(f))
        return 1 / mpmath.sqrt(f) + 2 * mpmath.log10(inside)

    with mpmath.workdps(30):
        known = float(mpmath.findroot(residual, (0.01, 0.05), solver="anderson"))
    assert report.values.scalar("f") == pytest.approx(known, rel=1e-14)
    assert not report.faults
    assert main(["why", "f", str(where), "--no-cache"]) == 0
    assert "log(10/37*rough + 2.51/Re/sqrt(f))" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('k = given("1", "stiffness")', "k is the reading's number: call that otherwise, index='...'"),
        ('n = given("1", "number")', "n is the number of readings: call that otherwise, size='...'"),
        ('a = given("m", "again")', "a is declared twice"),
        ('c = let(a + b, "of two kinds")', "cannot add m and s"),
        ('c = let(a + a, "length", "s")', "the unit s is s, but the formula gives m"),
        ('c = let(a**b, "power")', "exponent"),
        ('c = let(2**(b / b) * a ** (b / Symbol("b")), "x") + 1', "unsupported operand"),
        ('f = root(a, 2 * a, "length", "m", low=0, high=1)', "write f = unknown() above"),
        ('c = let(q, "nothing")', "name 'q' is not defined"),
    ],
)
def test_a_wrong_line_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], line: str, said: str
) -> None:
    head = "from sympy import Symbol\n" + PIPE.partition("    Re")[0]
    code = f'{head}    a = given("m", "length")\n    b = given("s", "time")\n    {line}\n'
    where = folder(tmp_path, code, 'a = "1.0 m"\nb = "2.0 s"\n')
    assert main(["check", str(where), "--no-cache"]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert re.search(r"workbook\.py:\d+", told)


def test_points_and_lines_are_declared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every point is in the frame, however far from the line; page and workbook draw the same chart."""
    monkeypatch.chdir(tmp_path)
    assert main(["new", "line", "--workbook", "line"]) == 0
    report = Study(Path("line")).report
    fit, left = report.workbook.charts
    assert [(s.x, s.y, s.style) for s in fit.series] == [("x", "y", "points"), ("x", "fitted", "line")]
    assert [(s.y, s.style) for s in left.series] == [("residual", "points")]
    assert "lie outside" not in charts.draw(report, fit).legends[0].get_texts()[0].get_text()
    assert fit.whole


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("plot(x, x**2)", "a name of the body can be plotted, no formula"),
        ("plot(m, x)", "m is a single number, which is no column to plot"),
    ],
)
def test_what_cannot_be_plotted(line: str, said: str) -> None:
    body = f"    x = measured('m', 'length')\n    m = let(mean(x), 'mean')\n    {line}\n"
    with pytest.raises(SheetError, match=re.escape(said)):
        exec(f"class Wrong(Method):\n{body}", {**vars(loopsheet.report.method)})


def test_outside_of_a_body_there_are_no_rows() -> None:
    with pytest.raises(SheetError, match="stand in the body of a class of Method"):
        contextvars.Context().run(count)


def test_what_else_is_refused() -> None:
    with pytest.raises(SheetError, match="the headline names x, which is not declared"):

        class Empty(Method, headline="x"):
            """Nothing."""

    with pytest.raises(SheetError, match="a class of Method alone"):

        class Again(Pendulum):
            """Nothing."""


def test_a_file_of_two_methods_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    where = folder(tmp_path, PIPE + PIPE.replace("Colebrook(", "Other("), 'Re = "1.00e5"\nrough = "0.0010"\n')
    assert main(["check", str(where), "--no-cache"]) == 2
    assert "it declares two methods" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "known"),
    [
        ("formula", {"g": 9.8038}),  # 4 pi^2 0.994 times the mean of the squares of 1/T
        ("line", {"slope": 0.00299, "later": -0.16554}),
        ("root", {"f": 0.0221745}),
    ],
)
def test_a_folder_to_begin_with(
    name: str, known: dict[str, float], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "one", "--workbook", name]) == 0
    assert main(["new", "other", "--workbook", "one/workbook.py"]) == 0
    both = [Path(folder) for folder in ("one", "other")]
    assert [sorted(path.name for path in folder.iterdir()) for folder in both] == [
        sorted({"report.toml", "workbook.py"} | ({"measurements.csv"} if name != "root" else set()))
    ] * 2
    report = Study(both[1]).report
    assert not report.faults
    assert all(proof.status.passes for proof in report.proofs)
    found = {cell: report.values.scalar(cell) for cell in known}
    assert found == pytest.approx(known, rel=2e-3 if name == "line" else 1e-5)


def test_a_report_is_loaded(tmp_path: Path) -> None:
    """Pairs and scalars, in the units that were typed, with texts for a notebook."""
    table = "test,v [m/s],e [1],x_p [um]\n1,2.200,0.5350,22.58\n2,3.100,0.5050,31.92\n3,4.300,0.4700,44.61\n"
    (tmp_path / "measurements.csv").write_text(table, encoding="utf-8")
    toml = 'title = "<Steel>"\nworkbook = "soft_impact"\n[parameters]\nball_mass = "8.366 g"\n'
    (tmp_path / "report.toml").write_text(
        f'{toml}[measurements]\nfile = "measurements.csv"\n', encoding="utf-8"
    )
    found = loopsheet.load(tmp_path)
    depth, alpha, mean_alpha = found["x_p"], found["alpha"], found["alpha_mean"]
    assert (depth.unit, depth.value.tolist(), depth.index) == ("um", [22.58, 31.92, 44.61], ("1", "2", "3"))
    assert depth.u == pytest.approx([0.005 / math.sqrt(3)] * 3)
    assert (alpha.index, len(alpha), alpha.status) == (("1-2", "1-3", "2-3"), 3, ("ok",) * 3)
    assert float(mean_alpha) == pytest.approx(alpha.value.mean(), rel=1e-14)
    assert (mean_alpha.value.shape, mean_alpha.index) == ((), ())
    assert (found.title, found.headline[0]) == ("<Steel>", "alpha_eiv")
    assert "x_p" in found
    assert set(found) == set(sheet_names(tmp_path))
    shown = found._repr_html_()
    assert "&lt;Steel&gt;" in shown
    assert mean_alpha.texts[0] in shown
    assert mean_alpha.texts[0] in repr(found)
    with pytest.raises(KeyError, match="no quantity 'q': there are v, e, x_p"):
        found["q"]


def sheet_names(folder: Path) -> list[str]:
    return list(Study(folder).computed.sheet.by_name)


def test_a_cell_without_a_value_is_told(tmp_path: Path) -> None:
    table = "test,v [m/s],e [1],x_p [um]\n1,2.200,0.5350,22.58\n2,3.100,0.5050,2.192\n3,4.300,0.4700,44.61\n"
    (tmp_path / "measurements.csv").write_text(table, encoding="utf-8")
    toml = 'workbook = "soft_impact"\n[parameters]\nball_mass = "8.366 g"\n'
    table_of = '[measurements]\nfile = "measurements.csv"\n'
    (tmp_path / "report.toml").write_text(toml + table_of, encoding="utf-8")
    found = loopsheet.load(tmp_path)
    assert "#NOROOT!" in found["alpha"].status
    lost = found["alpha"].status.index("#NOROOT!")
    assert math.isnan(found["alpha"].value[lost])
    assert found["alpha"].sure[lost] == ""
    assert any(line.startswith("finding: ") for line in found.findings)


@pytest.mark.parametrize(("head", "code"), [("swing", 0), ("test", 0), ("swings", 2)])
def test_the_rows_may_be_called_as_the_method_calls_them(
    head: str, code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["new", str(tmp_path / "c"), "--workbook", "formula"]) == 0
    table = tmp_path / "c" / "measurements.csv"
    text = table.read_text(encoding="utf-8")
    assert text.startswith("swing,T [s]\n")
    table.write_text(text.replace("swing", head, 1), encoding="utf-8")
    assert main(["show", "g", str(tmp_path / "c")]) == code
    if code:
        assert "add 'swing' to the first line" in capsys.readouterr().err


def test_the_names_are_there_when_asked_for() -> None:
    """Nothing heavy comes with the package itself."""
    code = "import sys, loopsheet; assert 'sympy' not in sys.modules; loopsheet.Method"
    subprocess.run([sys.executable, "-c", f"{code}; assert 'sympy' in sys.modules"], check=True)
    assert all(getattr(loopsheet, name) for name in loopsheet.__all__)
    with pytest.raises(AttributeError, match="no attribute 'methods'"):
        loopsheet.methods  # noqa: B018


def test_the_example_of_the_readme(tmp_path: Path) -> None:
    """As it stands there, it is a folder that can be built."""
    text = README.read_text(encoding="utf-8").partition("## Your own method")[2]
    code, toml, table = (
        re.search(rf"```{kind}\n(.*?)```", text, re.DOTALL)[1]  # type: ignore[index]
        for kind in ("python", "toml", "csv")
    )
    for name, content in (("workbook.py", code), ("report.toml", toml), ("measurements.csv", table)):
        (tmp_path / name).write_text(content, encoding="utf-8")
    report = Study(tmp_path).report
    assert not report.faults
    assert report.values.scalar("g") == pytest.approx(9.81, abs=0.02)
    assert math.isfinite(report.uncertain().u["g"][0])
