"""A method as the body of a class: what a name stands for, and what is told of a wrong line."""

import contextvars
import math
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import mpmath
import numpy as np
import pytest
from helpers import method_folder
from sympy import Abs, Max, Min, Sum, Symbol, pi, sin, sqrt

import loopsheet
import loopsheet.report.method.words
from loopsheet import Method, count, given, let, load, mean, measured, median, root, total, unknown
from loopsheet.derivations.reductions import Greatest, Least, Median
from loopsheet.report.cli import main
from loopsheet.report.column import Formula, Root, SheetError
from loopsheet.report.engines.numpy import evaluate
from loopsheet.report.messages.errors import InputError
from loopsheet.report.method.lines import exact
from loopsheet.report.sheet import Sheet
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.monte_carlo import draw
from loopsheet.report.uncertainty.propagation import Spread
from loopsheet.report.views import charts
from loopsheet.report.workbook import Workbook


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
        "g_k": "m/s^2",
        "g": "m/s^2",
        "s": "m/s^2",
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


def test_a_root_in_a_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The friction factor of Colebrook's equation by mpmath, and decimals as they were typed."""
    where = method_folder(tmp_path, PIPE, more='[parameters]\nRe = "1.00e5, u = 1e3"\nrough = "0.0010"\n')
    report = Study(where).computed

    def residual(f: mpmath.mpf) -> mpmath.mpf:
        inside = mpmath.mpf("0.001") / mpmath.mpf("3.7") + mpmath.mpf("2.51") / (100_000 * mpmath.sqrt(f))
        return 1 / mpmath.sqrt(f) + 2 * mpmath.log10(inside)

    with mpmath.workdps(30):
        known = float(mpmath.findroot(residual, (0.01, 0.05), solver="anderson"))
    assert report.values.scalar("f") == pytest.approx(known, rel=1e-14)
    assert not report.faults
    assert main(["why", "f", str(where)]) == 0
    assert "log(10/37*rough + 2.51/Re/sqrt(f))" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            'x = measured("m", "w"); k = given("1", "w")',
            "call that otherwise, index='...' behind (Method, or take another name than k",
        ),
        (
            'n = given("1", "w"); x = measured("m", "w")',
            "n is the number of readings: call that otherwise, size",
        ),
        ('x = measured("m", "w"); k = unknown()', "k is the reading's number: call that otherwise"),
        ('c = let(sum(a, a), "x")', "sum(...) is of one formula, over the rows, or of a list"),
        ("c = let(2 * a)", "help: it is let(formula, meaning, unit='', *, label='', because='definition',"),
        (
            'c = let(round(a), "x")',
            "help: a name stands for a cell in formulas: no number yet, and no list",
        ),
        ('c = let(sum(sorted(a)), "x")', "help: a name stands for a cell in formulas"),
        ("c = let(a, 5)", "a meaning is a text in quotes, not 5"),
        ('c = given(a, "x")', "a unit is a text in quotes, not a"),
        (
            'c = given("m", "x", default=6)',
            "a default is a text, as printed and with its unit: default='6 m'",
        ),
        ('c = given("m", "x", low="3")', "low and high are numbers, in the unit that is declared, not '3'"),
        ('c = let("2 * a", "x")', "'2 * a' is a text: a formula stands there without quotes"),
        (
            'q = unknown(); q = root(q, a, "x", "m", low="0.1 mm", high=1)',
            "low and high are numbers, in the unit that is declared, not '0.1 mm'",
        ),
        ('let(2 * a, "no name")', "'no name' has no name: a line is a name, =, and what is declared"),
        ('c = [let(2 * a, "in a list")]', "'in a list' has no name"),
        ('claim(a > 0, 1, "positive")', "a > 0 is no formula of real numbers; what is claimed is that two"),
        ('c = let(a / 2, "half"); claim(2 * c, a, "twice")', "'twice' is what (1) says of itself"),
        ('a = given("m", "again")', "a is declared twice: it is the "),
        ('c = let(a + b, "of two kinds")', "cannot add m and s"),
        ('c = let(a + a, "length", "s")', "the unit is s, but the formula gives m"),
        ('c = let(a**b, "power")', "exponent"),
        ('c = let(2**(b / b) * a ** (b / Symbol("b")), "x") + 1', "unsupported operand"),
        ('f = root(a, 2 * a, "length", "m", low=0, high=1)', "write f = unknown() above"),
        ('c = let(q, "nothing")', "name 'q' is not defined"),
        ('c = let(2 * a, "twice", like=b)', "c: its unit is m, which is not shown in s"),
        ('c = let(2 * a, "twice", display="furlung")', "shown in 'furlung', which is no unit"),
        ('c = let(sympy.erf(b / b), "x")', "erf is none of the functions that every engine has: Abs, "),
        ('c = let(sympy.I * a, "x")', "I*a is no formula of real numbers"),
        ('c = let(a > 1, "x")', "a > 1 is no formula of real numbers"),
        ('c = let(b / (a - a), "x")', "a formula that divides by 0 has no value"),
        ('c = let((a - a) / (b - b), "x")', "a formula that divides by 0 has no value"),
        ('c = let(10**400 * a, "x")', "a number of the formula is beyond 1.8e308"),
        ('c = let(a / 10**400, "x")', "or below 2.2e-308: no double holds it"),
        ("q = unknown()", "q is announced as unknown, and neither a root nor a fit finds it"),
        ("q = 2 * a", "Colebrook computes nothing"),
        ('q = unknown(); q = root(q, 1, "x", low=3, high=1)', "between 3 and 1: low is not below high"),
        (
            'q = unknown(); q = root(q, 1, "x", "mm", low=1, high=3, start=4)',
            "the root is begun at 4, which is not between 1 and 3 mm",
        ),
    ],
)
def test_a_wrong_line_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], line: str, said: str
) -> None:
    head = "import sympy\nfrom sympy import Symbol\n" + PIPE.partition("    Re")[0]
    head = head.replace("import Method", "import claim, measured, Method")
    code = f'{head}    a = given("m", "length")\n    b = given("s", "time")\n    {line}\n'
    where = method_folder(tmp_path, code, more='[parameters]\na = "1.0 m"\nb = "2.0 s"\n')
    assert main(["check", str(where)]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert re.search(r"workbook\.py:\d+", told)


def test_what_python_makes_of_typed_numbers_is_what_was_typed() -> None:
    p = Symbol("p")
    made = [0.1 * p + 0.2 * p, p / 3.7, 1.1 * (1.1 * p), p * 0.7 / 49, 0.3 * p, 3.14159265358979 * p]
    assert [str(exact(each)) for each in made[:4]] == ["3*p/10", "10*p/37", "121*p/100", "p/70"]
    assert [exact(each) for each in made[4:]] == made[4:]


def test_points_and_lines_are_declared(tmp_path: Path, chdir: Callable[[Path], None]) -> None:
    """Every point is in the frame, however far from the line; page and workbook draw the same chart."""
    chdir(tmp_path)
    assert main(["new", "line", "--workbook", "linefit"]) == 0
    report = Study(Path("line")).computed
    fit, left = report.workbook.charts
    assert [(s.x, s.y, s.style) for s in fit.series] == [
        ("x", "y", "points"),
        ("line_curve_x", "line_curve_y", "line"),
    ]
    assert [(s.y, s.style) for s in left.series] == [("line_residual", "points")]
    assert "lie outside" not in charts.draw(report, fit).legends[0].get_texts()[0].get_text()
    assert fit.whole


def test_one_row_is_enough_for_a_formula(tmp_path: Path) -> None:
    assert main(["new", str(tmp_path / "c"), "--workbook", "formula"]) == 0
    (tmp_path / "c" / "measurements.csv").write_text("swing,T [s]\n1,2.001\n", encoding="utf-8")
    assert float(load(tmp_path / "c")["g"]) == pytest.approx(4 * math.pi**2 * 0.994 / 2.001**2)


def test_pairs_are_of_two_rows_at_least(tmp_path: Path) -> None:
    code = """\
from loopsheet import Method, let, mean, measured, pairs
class Steps(Method):
    x = measured("mm", "reading")
    first, second = pairs()
    step = let(second(x) - first(x), "step", "mm")
    m = let(mean(step), "mean step", "mm")
"""
    with pytest.raises(InputError, match="LS310"):
        load(method_folder(tmp_path, code, "reading,x [mm]\n1,2.0\n"))
    assert float(load(method_folder(tmp_path, code, "reading,x [mm]\n1,2.0\n2,3.0\n"))["m"]) == 1.0


def test_a_column_of_choices_is_exact(tmp_path: Path) -> None:
    code = """\
from loopsheet import Method, let, measured
class Doses(Method):
    dose = measured("g", "dose", exact=True)
    gain = measured("g", "gain")
    y = let(gain + dose, "both", "g")
"""
    report = load(method_folder(tmp_path, code, "reading,dose [g],gain [g]\n1,5,0.30\n2,9,0.70\n"))
    assert report["dose"].u.tolist() == [0, 0]
    assert report["y"].u == pytest.approx(report["gain"].u)


def test_sums_and_extremes_may_be_called_as_in_python() -> None:
    class Named(Method):
        x = measured("m", "length")
        S = let(sum(x), "sum")
        twice = let(sum([S, S]), "of a list")
        most = let(max(S, twice, x), "largest, of each row")
        least = let(min([S, twice]), "of a list")
        span = let(max(x) - min(x) - median(x), "over the rows")

    rules = {c.name: c.rule.expression for c in sheet_of(Named).columns if isinstance(c.rule, Formula)}
    assert isinstance(rules["S"], Sum)
    assert str(rules["twice"]) == "2*S"
    assert isinstance(rules["most"], Max)
    assert isinstance(rules["least"], Min)
    cell, rows = sheet_of(Named)["x"].cell, (Named.workbook.sheet(frozenset()).axes[0])
    over = (cell, (rows.index, 1, rows.size))
    assert rules["span"] == Greatest(*over) - Least(*over) - Median(*over)
    assert sum([1, 2]) == max(3, 2)


@pytest.mark.parametrize(
    ("formula", "said"),
    [
        ("max(2 * x)", "max() is of a column, not of 2*x[k]: name that first, off = let(...)"),
        ("median(x - min(x))", "name that first, off = let(...)"),
        ("min(m)", "min() is taken over rows, and m is the same for all of them"),
        ("median(max(x))", "median() is taken over rows, and Greatest(x[k], (k, 1, n)) is the same"),
        ("max(3)", "max() is taken over rows, and 3 is the same"),
        ("max()", "is no formula of real numbers"),
        ("median([x, m])", "is no formula of real numbers"),
    ],
)
def test_what_has_no_order_over_rows(formula: str, said: str) -> None:
    body = f"    x = measured('m', 'length')\n    m = let(mean(x), 'mean')\n    y = let({formula}, 'y')\n"
    with pytest.raises(SheetError, match=re.escape(said)):
        exec(f"class Wrong(Method):\n{body}", {**vars(loopsheet.report.method.words)})


def test_a_zero_with_a_point_is_a_number_that_every_double_holds() -> None:
    names = vars(loopsheet.report.method.words)
    exec("class Cut(Method):\n    x = given('1', 'share')\n    y = let(max(x, 0.0), 'cut')\n", {**names})


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (
            "y = unknown()\n    y = root(y, max(x), 'root', 'm', low=0, high=1)",
            "y: a max in a root has to be a column of its own",
        ),
        (
            "p = unknown('p', 'm', start=1)\n    f = fit(x, sqrt(p * max(x) + p**2))",
            "a max cannot stand in what is iterated; it jumps",
        ),
    ],
)
def test_where_order_may_not_stand(lines: str, said: str) -> None:
    body = f"    x = measured('m', 'length')\n    {lines}\n"
    with pytest.raises(SheetError, match=re.escape(said)):
        exec(
            f"class Wrong(Method):\n{body}\nWrong.workbook.sheet(frozenset())",
            {**vars(loopsheet.report.method.words), "sqrt": sqrt},
        )


@pytest.mark.parametrize(
    ("default", "code"),
    [("2 K", "LS422"), ("two m", "LS401"), ("2", "LS211"), ("2 m, u = 1 s", "LS431")],
)
def test_a_default_is_read_as_what_is_given(
    default: str, code: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = "from loopsheet import Method, given, let\nclass One(Method):\n    a = given('kg', 'a')\n"
    text += f"    b = given('m', 'b', default={default!r})\n    c = let(a * b, 'c')\n"
    assert main(["check", str(method_folder(tmp_path, text, more='[parameters]\na = "1 kg"\n'))]) == 2
    assert f"error[{code}]" in capsys.readouterr().err


def test_outside_of_a_body_there_are_no_rows() -> None:
    with pytest.raises(SheetError, match="stand in the body of a class of Method"):
        contextvars.Context().run(count)


@pytest.mark.parametrize("toml", ["", '[uncertainty]\nT = "u = 0.01 s"\n'])
def test_of_a_wrong_line_nothing_else_is_told(
    toml: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Neither that the rows are called as the workbook says, nor that its columns are not known."""
    assert main(["new", str(tmp_path / "c"), "--workbook", "formula"]) == 0
    for name, old, new in (
        ("workbook.py", "positive=True", "positiv=True"),
        ("report.toml", "# [unc", f"{toml}# [unc"),
    ):
        path = tmp_path / "c" / name
        path.write_text(path.read_text(encoding="utf-8").replace(old, new, 1), encoding="utf-8")
    capsys.readouterr()
    assert main(["check", str(tmp_path / "c")]) == 2
    told = capsys.readouterr().err
    assert "unexpected keyword argument 'positiv'" in told
    assert told.endswith("\n1 error\n")


def test_all_sums_leave_out_the_same_rows(tmp_path: Path) -> None:
    """A line through centred numbers, of which one was not measured, is that through the others."""
    assert main(["new", str(tmp_path / "c"), "--workbook", "linefit"]) == 0
    report = Study(tmp_path / "c").computed
    data = {name: own.copy() for name, own in report.values.value.items() if name in report.sheet.bounds}
    data["y"][0] = math.nan
    found = evaluate(report.sheet, report.values.given_labels, data)
    slope, intercept = np.polyfit(data["x"][1:], data["y"][1:], 1)
    assert found.scalar("slope") == pytest.approx(slope, rel=1e-9)
    assert found.scalar("intercept") == pytest.approx(intercept, rel=1e-9)


def test_a_root_over_a_number_that_may_be_zero(tmp_path: Path, require: Callable[..., str]) -> None:
    """Its slope has a part that is a plain number, which intervals in JavaScript once did not take."""
    code = PIPE.partition("    Re")[0] + (
        '    V = measured("V", "voltage")\n    c = given("V", "scale")\n    x = unknown()\n'
        '    x = root(x + x**3, V / c, "ratio", low=0, high=3)\n'
    )
    code = code.replace("let, root", "let, measured, root")
    where = method_folder(tmp_path, code, more='[parameters]\nc = "2.0 V"\n')
    with (where / "report.toml").open("a", encoding="utf-8") as file:
        file.write('[measurements]\nfile = "m.csv"\n')
    (where / "m.csv").write_text("reading,V [V]\n1,3.0\n2,5.0\n", encoding="utf-8")
    require("node")
    assert main(["check", str(where)]) == 0


def test_at_a_corner_nothing_is_told_of_second_order(tmp_path: Path) -> None:
    """The mean deviation of three numbers, one of which lies at the mean: draws give .9 of it."""

    class Deviation(Method):
        """Mean deviation."""

        T = measured("s", "time")
        m = let(mean(Abs(T - mean(T))), "mean deviation")

    code = (
        "from sympy import Abs\nfrom loopsheet import Method, let, mean, measured\n\n\nclass D(Method):\n"
        '    T = measured("s", "time")\n    m = let(mean(Abs(T - mean(T))), "mean deviation")\n'
    )
    assert sheet_of(Deviation)["m"].axis is None
    report = Study(method_folder(tmp_path, code, "test,T [s]\n1,1.2\n2,1.5\n3,1.8\n")).computed
    budget = Spread(report.inputs, report.values).budget("m", 0)
    drawn = draw(report.inputs, report.values, budget, 20_000)
    assert budget.second == 0
    assert budget.unlooked.startswith("it has a corner here")
    assert budget.u == pytest.approx(drawn.u, rel=0.15)


def test_what_else_is_refused() -> None:
    with pytest.raises(SheetError, match="the headline names x, which is not declared"):

        class Empty(Method, headline="x"):
            """Nothing."""

    with pytest.raises(SheetError, match="a class of Method alone"):

        class Again(Pendulum):
            """Nothing."""


def test_a_file_of_two_methods_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    both = PIPE + PIPE.replace("Colebrook(", "Other(")
    where = method_folder(tmp_path, both, more='[parameters]\nRe = "1.00e5"\nrough = "0.0010"\n')
    assert main(["check", str(where)]) == 2
    assert "it declares two methods" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "known"),
    [
        ("formula", {"g": 9.8038}),  # 4 pi^2 0.994 times the mean of the squares of 1/T
        ("linefit", {"slope": 0.00299, "later": -0.16554}),
        ("root", {"f": 0.0221745}),
        ("blank", {"y": 1.0}),
        ("fit", {"tau": 3.0442367, "U_0": 5.0049775}),  # as scipy.optimize.curve_fit has them
    ],
)
def test_a_folder_to_begin_with(
    name: str, known: dict[str, float], tmp_path: Path, chdir: Callable[[Path], None]
) -> None:
    chdir(tmp_path)
    assert main(["new", "one", "--workbook", name]) == 0
    assert main(["new", "other", "--workbook", "one/workbook.py"]) == 0
    both = [Path(folder) for folder in ("one", "other")]
    assert [sorted(path.name for path in folder.iterdir()) for folder in both] == [
        sorted(
            {"report.toml", "workbook.py"}
            | ({"measurements.csv"} if name not in ("root", "blank") else set())
        )
    ] * 2
    report = Study(both[1]).proved
    assert not report.faults
    assert all(proof.status.passes for proof in report.proofs)
    found = {cell: report.values.scalar(cell) for cell in known}
    assert found == pytest.approx(known, rel=2e-3 if name == "linefit" else 1e-5)


def test_what_can_be_imported_is_listed_and_raised(tmp_path: Path) -> None:
    assert {*loopsheet.__all__, "__version__"} <= {*dir(loopsheet)}
    with pytest.raises(loopsheet.LoopsheetError, match="LS"):  # type: ignore[arg-type]
        loopsheet.load(tmp_path)


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
    assert np.asarray(depth).tolist() == depth.value.tolist() == list(depth)
    assert np.log(depth).tolist() == np.log(depth.value).tolist()
    assert np.asarray(mean_alpha, dtype=np.float32).dtype == np.float32
    assert (depth[0], depth[1:].tolist(), depth[-1]) == (22.58, [31.92, 44.61], 44.61)
    assert f"{mean_alpha:.2f} {depth[0]:.1f}" == f"{float(mean_alpha):.2f} 22.6"
    assert f"{mean_alpha}" == str(mean_alpha)
    for wrong in (lambda: depth[3], lambda: mean_alpha[0]):
        with pytest.raises(IndexError):
            wrong()
    with pytest.raises(TypeError):
        list(mean_alpha)
    assert repr(depth.rows).startswith("(('x_p[1]', '22.58 um', '0.0029 um'), ('x_p[2]', ")
    assert (depth.names, alpha.names, mean_alpha.names) == (depth.index, alpha.index, ())
    assert "x_p" in found
    assert set(found) == set(sheet_names(tmp_path))
    shown = found._repr_html_()
    assert "&lt;Steel&gt;" in shown
    assert mean_alpha.texts[0] in shown
    assert mean_alpha.texts[0] in repr(found)
    with pytest.raises(KeyError, match="no quantity 'q': there are v, e, x_p"):
        found["q"]
    with pytest.raises(KeyError, match="no quantity 'alhpa': did you mean 'alpha'\\? there are v, e"):
        found["alhpa"]


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


@pytest.mark.parametrize(
    ("line", "near"),
    [("c = let(Tt / 2, 'x')", "'T'"), ("c = let(srqt(T / T), 'x')", "'sqrt'"), ("g = let(2 * g, 'x')", "")],
)
def test_what_a_star_brings_along_is_not_meant(tmp_path: Path, line: str, near: str) -> None:
    head = "from sympy import *\nfrom loopsheet import *\n\nclass Stars(Method):\n    'One.'\n"
    code = f"{head}    T = given('s', 'period')\n    {line}\n"
    with pytest.raises(InputError) as refused:
        Study(method_folder(tmp_path, code, more='[parameters]\nT = "1.0 s"\n')).report  # noqa: B018
    assert (f"did you mean {near}" in str(refused.value)) is bool(near)
    assert ("did you mean" in str(refused.value)) is bool(near)


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
        assert "did you mean 'swing'?" in capsys.readouterr().err


def test_rows_without_numbers_are_numbered_as_they_stand(tmp_path: Path) -> None:
    assert main(["new", str(tmp_path / "c"), "--workbook", "formula"]) == 0
    table = tmp_path / "c" / "measurements.csv"
    head, *lines = table.read_text(encoding="utf-8").splitlines()
    named = [f"{name},{line.partition(',')[2]}" for name, line in zip("CBA", lines, strict=False)]
    table.write_text("\n".join(["specimen,T [s]", *named, ""]), encoding="utf-8")
    study = Study(tmp_path / "c")
    assert study.inputs.only.tests == (1, 2, 3)
    assert study.inputs.only.remarks == ("specimen",)
    assert study.inputs.only.texts[2]["specimen"] == "B"
    table.write_text("\n".join([head, *lines[:3], ""]), encoding="utf-8")
    again = Study(tmp_path / "c").computed.values
    assert again.value["g"] == study.computed.values.value["g"]


def test_the_names_are_there_when_asked_for() -> None:
    """Nothing heavy comes with the package itself."""
    code = "import sys, loopsheet; assert 'sympy' not in sys.modules; loopsheet.Method"
    subprocess.run([sys.executable, "-c", f"{code}; assert 'sympy' in sys.modules"], check=True)
    assert all(getattr(loopsheet, name) for name in loopsheet.__all__)
    with pytest.raises(AttributeError, match="no attribute 'methods'"):
        loopsheet.methods  # noqa: B018


LOGS = """\
from sympy import log
from loopsheet import Method, given, let, mean, measured, total
class Logs(Method):
    "A power law on logarithmic scales."
    x = measured("m", "x")
    y = measured("m", "y")
    x_0 = given("m", "one metre", exact=True)
    lx = let(log(x / x_0), "its logarithm")
    ly = let(log(y / x_0), "its logarithm")
    dx = let(lx - mean(lx), "from the mean on")
    slope = let(total(dx * ly) / total(dx**2), "exponent")
    level = let(mean(ly) - slope * mean(lx), "logarithm of the coefficient")
    mean_x = let(mean(x), "mean of x")
"""


def test_sums_of_one_result_run_over_the_same_rows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A row that has no logarithm counts in none of them, as if it were left out; else x is as it was."""
    rows = [f"{n},{x},{y}" for n, (x, y) in enumerate([(1, 2), (2, 4.1), (-3, 6), (4, 7.9), (5, 10.2)], 1)]
    found = {}
    for name, more in (("failing", ("", "", "")), ("aside", (",left out", ",", ",odd"))):
        table = ["reading,x [m],y [m]" + more[0], *(row + more[2 if row[0] == "3" else 1] for row in rows)]
        at = method_folder(tmp_path / name, LOGS, "\n".join(table), '[parameters]\nx_0 = "1 m"\n')
        report = Study(at).computed
        cells = {each: report.values.cell(each).value for each in ("slope", "level", "mean_x")}
        spread = Spread(report.inputs, report.values)
        found[name] = cells, [float(spread.u(each)[0]) for each in ("slope", "level")]
    failing, aside = found["failing"], found["aside"]
    assert failing[1] == pytest.approx(aside[1], rel=1e-14)
    assert failing[0] == {**aside[0], "mean_x": pytest.approx(1.8)}
    told = [check.message for check in Study(tmp_path / "failing").computed.oddities if not check.passed]
    assert told[-1] == "level, dx and slope are over 4 of 5 readings"
