"""A workbook of one's own, two axes, a root and a reduction, goes through all that the paper goes through.

Kepler's orbit: a planet is seen at known times; the anomaly E of each sighting is the root of (3), its
distance follows from (4), and the mean and the changes between sightings from (L1) and (L2).
"""

import ast
import json
import re
import zipfile
from pathlib import Path

import numpy as np
import pytest
from judged_values import compare

from loopsheet.derivations.proof import prove
from loopsheet.derivations.proved import ProofStatus
from loopsheet.report import build
from loopsheet.report.cells import units
from loopsheet.report.cli import main
from loopsheet.report.engines import exact
from loopsheet.report.engines import numpy as engine
from loopsheet.report.result.result import Report
from loopsheet.report.sheet import Sheet
from loopsheet.report.study import Study
from loopsheet.report.which_workbook import find_workbook
from loopsheet.report.workbook import Workbook

SOURCE = """\
from sympy import Abs, Rational, Sum, Symbol, cos, pi, sin
from loopsheet.derivations.equation import Derivation, Equation, Kind, Ledger, Step
from loopsheet.report.quantity import Bounds
from loopsheet.report.charts import Chart, Drawn, Series, drawn
from loopsheet.report.sheet import Axis, Column, Formula, Given, PairAxis, RepeatAxis, Root, Sheet
from loopsheet.report.workbook import FigureSpec, Measured, Parameter, TableSpec, Workbook

k, i, j, p, n, n_pairs = (Symbol(s, integer=True, positive=True) for s in ("k", "i", "j", "p", "n", "n_p"))
SIGHTINGS = Axis("sightings", k, n)
PAIRS = PairAxis("pairs", p, n_pairs, of=SIGHTINGS, first=i, second=j)
t, T, a, ecc, rate = (Symbol(name, positive=True) for name in ("t", "T", "a", "ecc", "rate"))
M, E, r = (Symbol(name, positive=True) for name in ("M", "E", "r"))

eq1 = Equation("(1)", (rate, 2 * pi / T), "one turn a period", Kind.DEFINITION, "mean motion", defines=rate)
eq2 = Equation("(2)", (M, rate * t), "uniform in time", Kind.DEFINITION, "mean anomaly", defines=M)
anomaly = Equation("(L1)", (M, 2 * pi * t / T), "put (1) in (2)", title="mean anomaly from the period")
put_in = Step(anomaly, (eq1, eq2), (rate, M), "Put the mean motion in.")
eq3 = Equation("(3)", (E - ecc * sin(E) - M, 0 * M), "equal areas", Kind.ASSUMPTION, "Kepler's equation")
eq4 = Equation("(4)", (r, a * (1 - ecc * cos(E))), "the ellipse", Kind.DEFINITION, "distance", defines=r)

times = Column("t", SIGHTINGS, Given("measured"), "s", "time", "t%s", display="like t")
period = Column("T", None, Given("parameter"), "s", "period", "T", display="like T")
axis = Column("a", None, Given("parameter"), "m", "semi-major axis", "a", display="like a")
shape = Column("ecc", None, Given("parameter"), "1", "eccentricity", "\\\\varepsilon")
M_k = Column("M", SIGHTINGS, Formula(anomaly.at({M: Symbol("M"), t: times[k]})), "1", "mean anomaly", "M%s")
kepler = eq3.at({M: M_k[k]})
root = Root(kepler, kepler, E, E, M_k[k] - 1, M_k[k] + 1, start=M_k[k], steps=5)
closed = ((shape.symbol < 1, "the orbit is open"),)
E_k = Column("E", SIGHTINGS, root, "1", "eccentric anomaly", "E%s", requires=closed)
r_k = Column("r", SIGHTINGS, Formula(eq4.at({E: E_k[k]})), "m", "distance", "r%s", display="like a")
eqL2 = Equation("(L2)", (Symbol("gap"), Abs(r_k[j] - r_k[i])), "definition", Kind.DEFINITION, "change")
gap = Column("gap", PAIRS, Formula(eqL2), "m", "change", "g%s", "like a", positive=False)
eqL3 = Equation("(L3)", (Symbol("r_mean"), Sum(r_k[k], (k, 1, n)) / n), "definition", Kind.DEFINITION, "mean")
mean = Column("r_mean", None, Formula(eqL3), "m", "mean distance", "\\\\bar{r}", display="like a")

MOST = 25
l, m, points, turn = (Symbol(s, integer=True, positive=True) for s in ("l", "m", "n_w", "n_t"))


def curves(sheet):
    # From one sighting to half a period later, by the anomaly that needs no root.
    way = RepeatAxis("way", l, points, of=SIGHTINGS, step=m, count="way_points")
    count = Column("way_points", None, Given("chart"), exact=True)
    E_w = drawn("E_way", way, E_k[k] + pi * (m - 1) / (count.symbol - 1))
    M_w = drawn("M_way", way, E_w[l] - ecc * sin(E_w[l]))
    t_w = drawn("t_way", way, M_w[l] * T / (2 * pi), "s", display="like t")
    r_w = drawn("r_way", way, a * (1 - ecc * cos(E_w[l])), "m", display="like a")
    return Drawn((count, E_w, M_w, t_w, r_w), {"way_points": MOST})


ORBIT = Chart(
    "sightings and the way between them",
    "time t of a sighting",
    "distance r",
    (
        Series("t_way", "r_way", "half a turn after %s", each=True),
        Series("t", "r", "%s", "points", named=True),
        Series("t", "r_mean", "mean", "level"),
    ),
    log="y",
)

WORKBOOK = Workbook(
    name="kepler",
    title="Distances of a planet",
    source="J Kepler: Astronomia nova",
    ledger=lambda: Ledger((eq1, eq2, Derivation((put_in,)), eq3, eq4, eqL2, eqL3)),
    measured=(Measured("t", "s", "time of a sighting", Bounds(low=0)),),
    parameters=(
        Parameter("T", "s", "period", Bounds(low=0, low_open=True)),
        Parameter("a", "m", "semi-major axis", Bounds(low=0, low_open=True)),
        Parameter("ecc", "1", "eccentricity", Bounds(low=0), default="0.1"),
    ),
    sheet=lambda given: Sheet((times, period, axis, shape, M_k, E_k, r_k, gap, mean)),
    headline=("r_mean",),
    figures=(FigureSpec("orbit", "1", "Distances over time, and the ellipse.", chart=ORBIT),),
    drawn=curves,
    tables=(TableSpec("seen", "Sightings", ("t", "M", "E", "r")), TableSpec("pairs", "Changes", ("gap",))),
)
"""
FILES = {
    "workbook.py": SOURCE,
    "report.toml": 'title = "Mars"\nworkbook = "workbook.py"\n[parameters]\nT = "687 d"\na = "227.9 Gm"\n'
    'ecc = "0.0934"\n[measurements]\nfile = "seen.csv"\n[published]\nfile = "published.csv"\n'
    '[expected]\n"M[1]" = "the planet is at its perihelion then, and zero is not positive"\n',
    "seen.csv": "test,t [d]\n1,0\n2,100\n3,250\n4,343.5\n",
    "published.csv": "source,cell,index,value,unit,expect,reason\nTables,r,4,249.2,Gm,,\n",
}
DAY = 86400.0


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("mars")
    for name, text in FILES.items():
        (place / name).write_text(text, encoding="utf-8")
    return place


@pytest.fixture(scope="module")
def workbook(folder: Path) -> Workbook:
    return find_workbook("workbook.py", folder, SOURCE.encode())


@pytest.fixture(scope="module")
def sheet(workbook: Workbook) -> Sheet:
    return workbook.sheet(frozenset({"T", "a", "ecc"}))


@pytest.fixture(scope="module")
def report(folder: Path) -> Report:
    return Study(folder).proved


def data(ecc: float = 0.0934) -> dict[str, object]:
    return {"t": [x * DAY for x in (0.5, 100.0, 250.0, 343.5)], "T": 687 * DAY, "a": 2.279e11, "ecc": ecc}


def test_its_claim_is_proved(workbook: Workbook) -> None:
    verdicts = {proof.equation.label: proof.status for proof in prove(workbook.ledger())}
    assert verdicts["(L1)"] is ProofStatus.PROVED
    assert all(verdict.passes for verdict in verdicts.values())


def test_its_dimensions_are_checked(sheet: Sheet) -> None:
    units.check(sheet)


@pytest.mark.parametrize("ecc", [0.0934, 0.5, 0.99, 0.0])
def test_both_engines_solve_keplers_equation(sheet: Sheet, ecc: float) -> None:
    labels = {"sightings": [1, 2, 3, 4]}
    values = engine.evaluate(sheet, labels, data(ecc))
    E, M = values.value["E"], values.value["M"]
    np.testing.assert_allclose(E - ecc * np.sin(E), M, rtol=1e-14)
    agreement = compare(values, labels, data(ecc))
    assert agreement.findings == ()
    assert agreement.worst < 1e-14
    assert exact.evaluate(sheet, labels, data(ecc)).status["gap"] == [0] * 6


def test_a_batch_of_one_has_the_same_roots(sheet: Sheet) -> None:
    """Also where the steps do not settle, and brackets are halved."""
    labels, alone = {"sightings": [1, 2, 3, 4]}, data(93400)
    batch = {name: np.reshape(value, (1, -1)) for name, value in alone.items()}
    expected, found = (engine.evaluate(sheet, labels, given) for given in (alone, batch))
    for name in ("M", "E"):
        np.testing.assert_array_equal(found.value[name], expected.value[name][None])
        np.testing.assert_array_equal(found.status[name], expected.status[name][None])


def test_an_open_orbit_is_an_error_with_its_culprit(sheet: Sheet) -> None:
    values = engine.evaluate(sheet, {"sightings": [1, 2, 3, 4]}, data(1.2))
    assert values.cell("r_mean").reason == (
        "#DOMAIN! r_mean needs E[1]: outside the domain of (3): the orbit is open"
    )


def test_it_is_computed_from_its_folder(report: Report) -> None:
    values = report.values
    assert values.labels(report.sheet["gap"]) == [(1, 2), (1, 3), (1, 4), (2, 3), (2, 4), (3, 4)]
    assert values.cell("r", (1,)).reason.startswith("#DOMAIN! r[1] needs M[1]: ")
    assert values.cell("r", (4,)).value == pytest.approx(2.279e11 * 1.0934, rel=1e-9)
    assert values.counted == {"r_mean": {"sightings": 3}}
    assert [comparison.verdict for comparison in report.comparisons] == ["same"]
    assert [proof.status for proof in report.proofs if proof.equation.label == "(L1)"] == [ProofStatus.PROVED]


def test_it_is_written_as_a_page_a_paper_and_data(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    build.build(Study(folder), out, ("html", "latex", "json"))
    page, paper = ((out / name).read_text(encoding="utf-8") for name in ("report.html", "report.tex"))
    # The script of every page can draw the figures of the shipped workbook; what is read must not show it.
    page = re.sub(r"<script(?: [^>]*)?>.*?</script>", "", page, flags=re.DOTALL)
    for text in (page, paper):
        assert "Distances of a planet" in text or "Mars" in text
        assert "alpha" not in text.replace("\\alpha", "").lower().replace("alphabet", "")
    assert "data-cell=r_mean" in page
    cells = json.loads((out / "values.json").read_text(encoding="utf-8"))["cells"]
    assert cells["gap"]["axis"] == "pairs"
    assert cells["r"]["status"] == ["#DOMAIN!", "ok", "ok", "ok"]


def test_one_declaration_of_a_chart_is_drawn_in_every_format(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    build.build(Study(folder), out, ("html", "latex", "xlsx"))
    page, paper = ((out / name).read_text(encoding="utf-8") for name in ("report.html", "report.tex"))
    said = ("half a turn after each sighting", "3 sightings", "mean 236.119 Gm", "distance r / Gm")
    picture = "".join(re.findall(r"<svg role=img.*?</svg>", page, re.DOTALL))
    assert [text for text in said if text not in re.sub("<[^>]*>", "", picture)] == []
    assert r"{figures/orbit.pdf}" in paper
    assert "Distances over time" in page
    assert "Distances over time" in paper
    assert (out / "figures" / "orbit.pdf").is_file()
    (data,) = re.findall(r'id="?live-data"?>(.*?)</script>', page, re.DOTALL)
    chart = json.loads(data)["figures"]["orbit"]
    assert [series["y"] for series in chart["series"]] == ["r_way", "r", "r_mean"]
    assert chart["y"] == {"title": [["", "distance r"]], "unit": "Gm", "size": 1e9}
    with zipfile.ZipFile(out / "report.xlsx") as archive:
        drawn = archive.read("xl/charts/chart1.xml").decode()
    assert "Figure 1: sightings and the way between them" in drawn
    assert '<c:logBase val="10"/>' in drawn
    # Four ways, the sightings, their mean: each with its cells and what they hold as issued.
    series = re.findall(r"<c:ser>.*?</c:ser>", drawn, re.DOTALL)
    assert [len(re.findall(r"<c:f>", one)) for one in series] == [2, 2, 2, 2, 2, 3]
    assert "half a turn after sighting 2" in series[1]
    assert "mean 236.119 Gm" in series[-1]
    heights = [float(v) for v in re.findall(r"<c:v>([-\d.]+)</c:v>", series[1].partition("<c:yVal>")[2])]
    report = Study(folder).computed
    values = report.plotted().values
    way = values.layouts["way"].rows["k"] == 1
    assert heights == [float(f"{height:.6g}") for height in values.value["r_way"][way] / 1e9]
    assert len(heights) == 25
    assert report.values.sheet.by_name.keys() < values.sheet.by_name.keys()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('Series("t", "r", ', 'Series("t", "rr", ', "there is no column 'rr', which a chart names; "),
        ('Series("t", "r", ', 'Series("a", "r", ', "'a' is a single number, and a chart needs rows"),
        ('Series("t", "r", ', 'Series("t", "gap", ', "'gap' is not of the rows of 't'"),
        ('"r_mean", "mean", "level"', '"r", "mean", "level"', "'r' has many rows, and is one level"),
        ('"points", named=True', '"points", value="r"', "'r' has many rows, and stands behind a label"),
        ('"points", named=True', '"dots"', "a chart has no style 'dots'; there are points, line or level"),
        ('log="y"', 'log="z"', "the logarithmic axes of a chart are x, y or xy, not 'z'"),
        ("chart=ORBIT", "chart=7", "the chart of figure 'orbit' is no Chart"),
    ],
)
def test_a_chart_that_cannot_be_drawn_is_told(
    old: str, new: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert old in SOURCE
    for name, text in FILES.items():
        (tmp_path / name).write_text(text.replace(old, new), encoding="utf-8")
    assert main(["check", str(tmp_path)]) == 2
    told = capsys.readouterr().err
    assert "LS213" in told
    assert said in told


def test_the_command_line_takes_it(folder: Path) -> None:
    assert main(["check", str(folder)]) == 0


# ------------------------------------------------------------------- nothing general knows the paper
HERE = Path(__file__).resolve().parent.parent
GENERAL = sorted(
    path
    for name in ("axis", "column", "sheet", "cells/*", "plan/*", "engines/*", "document/*", "views/*")
    for path in (HERE / "report").glob(f"{name}.py")
)
# Docstrings may take their examples from the paper; code may not.
OF_THE_PAPER = re.compile(r"\b(soft_impact|Ciornei|x_p|x_m|Cprime|alpha_log|alpha_mean|C_log|m_red)\b")


def code_of(path: Path) -> str:
    """The source without comments and docstrings."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list):
            node.body = [line for line in body if not _is_text(line)] or [ast.Pass()]  # type: ignore[attr-defined]
    return ast.unparse(tree)


def _is_text(line: ast.stmt) -> bool:
    value = line.value if isinstance(line, ast.Expr) else None
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


@pytest.mark.parametrize("path", GENERAL, ids=lambda path: path.stem)
def test_nothing_general_knows_the_paper(path: Path) -> None:
    assert not set(OF_THE_PAPER.findall(code_of(path)))
