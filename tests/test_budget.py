"""`loopsheet budget`: what it prints, and what it refuses."""

import json
import math
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers import method_folder, told

from loopsheet.report.cli import main
from loopsheet.report.document.material import Material
from loopsheet.report.document.tables import Tables
from loopsheet.report.document.tree import Bar, Code
from loopsheet.report.engines import numpy as engine
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.prepared import Prepared
from loopsheet.report.result.result import Report
from loopsheet.report.result.uncertain import Budget, Distributed
from loopsheet.report.sheet import Sheet
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.propagation import Spread
from loopsheet.report.views import html, latex
from loopsheet.report.views.budget import FORMATS, Besides

FILES = {
    "report.toml": """\
workbook = "soft_impact"
[parameters]
ball_mass = "8.363 g, exact"
[measurements]
file = "measurements.csv"
[uncertainty]
v = "exact"
e = "exact"
x_p = "u = 0.1 um, dof = 4"
[uncertainty.shared.datum]
of = "x_p"
stated = "u = 0.2 um"
groups = [[1, 2]]
""",
    "measurements.csv": (
        "test,v [m/s],e [1],x_p [um]\n1,2.2,0.535,22.58\n2,3.1,0.505,31.92\n3,4.3,0.47,44.61\n"
    ),
}


@pytest.fixture
def campaign(tmp_path: Path) -> str:
    """A campaign in which only depths are uncertain."""
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    return str(tmp_path)


def test_the_test_that_matters_most_is_told_by_its_share(capsys: pytest.CaptureFixture[str]) -> None:
    out = told(capsys, "alpha_eiv", "paper")
    sources = json.loads(told(capsys, "alpha_eiv", "paper", "--format", "json"))["sources"]
    tests = {n: sum(s["share"] for s in sources if s["source"].endswith(f"[{n}]")) for n in range(1, 6)}
    most = max(tests, key=lambda n: tests[n])
    assert f"\ntest {most} matters most: {100 * tests[most]:.1f} % of the variance\n" in f"{out}\n"
    assert "matters most" not in told(capsys, "x_p[1]", "paper")


def test_of_a_fitted_number_the_scatter_tells_another_one(capsys: pytest.CaptureFixture[str]) -> None:
    out = told(capsys, "alpha_eiv", "paper")
    assert "the scatter of what it was fitted to, u = 0.013, U = 0.042 with k = 3.18 for 95 % (Student" in out
    found = json.loads(told(capsys, "alpha_eiv", "paper", "--level", "99", "--format", "json"))
    assert (found["scatter"]["dof"], round(found["scatter"]["k"], 3)) == (3, 5.841)  # of tables of t
    by_stated = json.loads(told(capsys, "u_birge_eiv", "paper", "--format", "json"))
    assert found["scatter"]["u"] == by_stated["value"]
    assert "scatter" not in told(capsys, "alpha_mean", "paper")


def test_so_it_does_of_a_fit_in_a_method(capsys: pytest.CaptureFixture[str]) -> None:
    found = json.loads(told(capsys, "b_1", str(PAPER.parent / "misra1a"), "--format", "json"))["scatter"]
    assert (found["dof"], round(found["u"], 6)) == (12, 2.707008)  # as NIST certifies it


def test_the_report_draws_the_shares_of_the_first_result(report: Report) -> None:
    budget = report.uncertain().budgets[0]
    (table,) = Tables(Material(report)).budget()
    assert budget.cell == "alpha_eiv"
    shown = [(row.cells[0], row.cells[2]) for row in table.rows]
    drawn = {each.source.name: each.share for each in budget.contributions if each.share >= 0.005}
    assert [name for (name,), _ in shown] == [Code(name) for name in drawn]  # type: ignore[misc]
    assert [bar for _, (bar, _) in shown] == [Bar(share) for share in drawn.values()]  # type: ignore[misc]
    assert table.legend == ("The largest 7 of 15 sources. Test 1 matters most: 48\u00a0%.",)
    percents = [round(100 * share) for share in drawn.values()]
    page = re.findall(r"<meter value=([\d.]+) aria-hidden=true></meter> (\d+)", html.render(report, {}))
    assert [(float(long), int(percent)) for long, percent in page] == [(n / 100, n) for n in percents]
    article = re.findall(r"\\rule\{([\d.]+)mm\}\{1.2ex\}\} (\d+)", latex.render(report, []))
    assert [(float(length), int(percent)) for length, percent in article] == [(n / 4, n) for n in percents]
    assert [Bar(share).percent for share in (-0.1, 0.004, 0.555, 1.2)] == [0, 0, 56, 100]


@pytest.mark.parametrize(
    ("v", "said"), [("exact", "The only source."), ("u = 1e-9 m/s", "The largest of 4 sources.")]
)
def test_one_source_is_told_as_one(tmp_path: Path, v: str, said: str) -> None:
    toml = FILES["report.toml"].replace('v = "exact"', f'v = "{v}"').replace("u = 0.1 um, dof = 4", "exact")
    for name, text in {**FILES, "report.toml": toml}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    (table,) = Tables(Material(Study(tmp_path).computed)).budget()
    assert table.legend[0].startswith(said)  # type: ignore[union-attr]


def test_a_given_number(campaign: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert told(capsys, "x_p[1]", campaign) == (
        "x_p[1] = 22.58 um, u = 0.22 um, U = 0.44 um with k = 1.98 for 95 %\n\n"
        "source              estimate  u        distribution  dof  contribution  share\n"
        "datum (tests 1, 2)  —         0.20 um  normal        ∞    0.200 um      80.0 %\n"
        "x_p[1]              22.58 um  0.10 um  t             4    0.100 um      20.0 %\n\n"
        "100 effective degrees of freedom\n"
        "k comes from a t distribution with 100 degrees of freedom\n"
    )


def test_for_a_program_it_has_all_digits(campaign: str, capsys: pytest.CaptureFixture[str]) -> None:
    found = json.loads(told(capsys, "x_p[3]", campaign, "--format", "json", "--level", "99"))
    assert (found["u"], found["dof"], found["level"]) == (pytest.approx(1e-7, rel=1e-12), 4, 0.99)
    assert found["k"] == pytest.approx(4.604, abs=5e-4)  # JCGM 100:2008, table G.2: 4.60
    assert [source["source"] for source in found["sources"]] == ["x_p[3]"]


def test_for_a_pull_request_it_is_a_table(campaign: str, capsys: pytest.CaptureFixture[str]) -> None:
    found = told(capsys, "alpha[1-2]", campaign, "--format", "markdown").splitlines()
    assert found[0].startswith("alpha\\[1-2\\] = 1.")
    assert found[2].startswith("| source | estimate | u |")
    assert found[4].startswith("| x\\_p\\[")


def test_how_much_pairs_of_the_same_tests_tell_together(capsys: pytest.CaptureFixture[str]) -> None:
    """Five tests make ten pairs, which tell as much as four: one exponent for all of them is all they ask."""
    said = told(capsys, "alpha_mean", "paper").splitlines()[-1].replace("\u00a0", " ")
    eigenvalues = "the eigenvalues of their correlation are 3.5, 3.0, 2.1, 1.4, then 7 × 10⁻⁵ and less"
    assert said == f"the 10 cells of alpha tell as much as 4 at a tolerance of 0.001: {eigenvalues}"
    found = json.loads(told(capsys, "alpha_mean", "paper", "--format", "json"))["summed"]["alpha"]
    assert (found["rank"], sum(found["eigenvalues"])) == (4, pytest.approx(10))
    assert json.loads(told(capsys, "alpha[1-2]", "paper", "--format", "json"))["summed"] == {}


def test_eigenvalues_are_those_of_drawn_campaigns(report: Report) -> None:
    rng = np.random.default_rng(3)
    made = Prepared(report.inputs, report.sheet)
    data: dict[str, Any] = dict(made.data)
    size = {"v": 1e-3, "e": 1e-3, "x_p": np.array([1e-7, 1e-7, 1e-7, 1e-8, 1e-8])}
    for name, step in size.items():
        data[name] = data[name] + step * rng.uniform(-0.05, 0.05, (20_000, 5))
    asked = report.sheet["alpha"]
    sheet = Sheet((*report.sheet.ancestors(asked), asked))
    alpha = engine.evaluate(
        sheet, made.labels, {name: data[name] for name in sheet.by_name.keys() & data}
    ).value["alpha"]
    drawn = np.linalg.eigvalsh(np.corrcoef(alpha.T))[::-1]
    (together,) = Spread(report.inputs, report.values).budget("alpha_mean", 0).summed
    np.testing.assert_allclose(together.eigenvalues[:4], drawn[:4], rtol=0.03)
    assert together.eigenvalues[4] == pytest.approx(drawn[4], rel=0.3)


def test_an_exact_one(campaign: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert told(capsys, "ball_mass", campaign) == "ball_mass = 8.363 g, exactly\n"


def test_a_level_that_is_no_percentage_is_told_as_one(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["budget", "alpha_mean", "paper", "--level", "0.95"]) == 2
    assert "'0.95'; write 95\n" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["alpha"], ["alfa"], ["alpha[1-9]"], ["x_p[1]", "--level", "100"]])
def test_what_is_refused(campaign: str, capsys: pytest.CaptureFixture[str], words: list[str]) -> None:
    assert main(["budget", words[0], campaign, *words[1:]]) == 2
    assert "error[LS6" in capsys.readouterr().err


def test_the_report_says_it_of_every_result(issued: Path, report: Report) -> None:
    values = json.loads((issued / "out" / "values.json").read_text(encoding="utf-8"))["cells"]
    page, tex = ((issued / "out" / f"report.{form}").read_text(encoding="utf-8") for form in ("html", "tex"))
    row = re.search(r'id="?caption-uncertain.*?</table>', page, re.DOTALL)
    assert row is not None
    known = {each.name: each for each in report.uncertain().budgets}
    for name in ("alpha_mean", "alpha_median", "alpha_log", "alpha_lin"):
        u = f"{values[name]['u']:.4f}"
        assert f"<td>{u}<td>{known[name].factor:.2f}<td>" in row[0]
        assert rf"\num{{{u}}}" in tex
    assert r"\num{0.038e9}" in tex
    assert f"{values['C_log']['u']:.2g}" == "3.8e+07"


@pytest.mark.parametrize("u", [0.0035, math.nan])
def test_draws_tell_of_a_cell_of_which_nothing_else_is_known(report: Report, u: float) -> None:
    """As in a sheet that is too large for propagation; where they have no standard deviation, too."""
    found = Distributed(
        1000,
        0,
        1.3026,
        math.nan,
        u,
        (1.2959, 1.3094),
        (1.2958, 1.3093),
        1.0,
        0.01,
        True,
        (math.nan, math.nan),
    )
    told = FORMATS["text"](
        report, Budget("alpha_mean", "alpha_mean", (), 1.30264, level=0.95), Besides(found)
    )
    digits = "1.2959 and 1.3094" if math.isfinite(u) else "1.296 and 1.309"
    assert "alpha_mean = 1.3026, and its uncertainty is not known" in told
    assert f"between {digits} (equal tails" in told
    assert "nan" not in told.lower()
    assert "law of propagation" not in told


@pytest.mark.parametrize(
    ("ends", "around"),
    [
        ((1.2959, 1.3094), "; 1.3026 +0.0068/-0.0067)"),
        ((1.3020, 1.3194), "; 1.3026 +0.0168/-0.0006)"),  # both to the last digit of the estimate
        ((1.3040, 1.3194), ")"),  # the estimate lies outside
    ],
)
def test_distances_from_the_estimate_to_the_ends(
    report: Report, ends: tuple[float, float], around: str
) -> None:
    found = Distributed(
        1000, 0, 1.3026, 1.3026, 0.0035, ends, ends, math.inf, 0.01, True, (math.nan, math.nan)
    )
    told = FORMATS["text"](
        report, Budget("alpha_mean", "alpha_mean", (), 1.30264, level=0.95), Besides(found)
    )
    assert f"(equal tails{around}" in told
    assert f"(the shortest{around}" in told


@pytest.mark.parametrize(
    ("draws", "level", "least"), [("0", "95", 400), ("1", "95", 400), ("401", "99.9", 20000)]
)
def test_too_few_draws_are_refused(
    campaign: str, capsys: pytest.CaptureFixture[str], draws: str, level: str, least: int
) -> None:
    assert main(["budget", "alpha_mean", campaign, "--draws", draws, "--level", level]) == 2
    told = capsys.readouterr().err
    assert f"error[LS614]: --draws {draws} tells nothing of an interval of {level} %" in told
    assert f"at least {least}, of which some 10 lie beyond each end" in told
    assert main(["budget", "alpha_mean", campaign, "--draws", "400"]) == 0


CLOCK = '''from loopsheet import Method, given, let


class Clock(Method, headline="f"):
    """A clock."""

    f_Sr = given("Hz", "strontium", positive=True)
    c = given("1", "another number")
    f = let(f_Sr * 1, "frequency", "Hz")
    far = let(f_Sr * c, "both", "Hz")
    none = let(f_Sr - f_Sr * c / c, "nothing", "Hz")
'''


@pytest.fixture
def clock(tmp_path: Path) -> Path:
    """A frequency that is known to less than the last bit of a double of it."""
    stated = '[parameters]\nf_Sr = "429228004229872.99 Hz, u = 0.08 Hz"\nc = "1.1, +-0.1 rect"\n'
    return method_folder(tmp_path, CLOCK, more=stated)


def test_an_uncertainty_below_the_last_bit_of_its_value_is_one(
    clock: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "u = 0.080 Hz, U = 0.16 Hz" in told(capsys, "f", str(clock))
    assert ", exactly" in told(capsys, "none", str(clock))


def test_one_that_stands_alone_has_its_own_distribution_though_it_is_correlated(
    clock: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    report = (clock / "report.toml").read_text()
    rectangular = report.replace("429228004229872.99 Hz, u = 0.08 Hz", "5 Hz, +-0.2 rect")
    correlated = '[uncertainty.correlation]\n"f_Sr, c" = "0.4"\n'
    (clock / "report.toml").write_text(rectangular + correlated)
    alone, both = (told(capsys, name, str(clock)) for name in ("f", "far"))
    assert "k comes from the rectangular source that dominates" in alone
    assert "correlated errors are taken as normal" in both
    assert "k comes from a normal distribution" in both


def test_draws_stand_alone_where_there_is_no_coverage_factor(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = shutil.copytree(PAPER.parent / "gum_h1", tmp_path / "gauge")
    with (folder / "report.toml").open("a") as file:
        file.write('\n[uncertainty.correlation]\n"l_S, dtheta" = "0.4"\n')
    said = told(capsys, "l", str(folder), "--draws", "2000")
    assert "k is not known: correlated sources have finite degrees of freedom" in said
    assert said.endswith("the law of propagation tells no interval to compare with\n")


TIED = '[uncertainty.correlation]\n"a, b" = "0.5"\n'
APART = """from loopsheet import Method, given, let


class Apart(Method, headline="y"):
    a, b = given("mm", "a"), given("mm", "b")
    y = let(a - b, "difference", "mm")
"""
EQUAL = """from loopsheet import Method, let, mean, measured


class Equal(Method, rows="readings", headline="y"):
    v = measured("V", "reading")
    y = let(mean(v), "mean", "V")
"""
SAMPLES = "a [mm],b [mm]\n" + "".join(
    f"{11.7 + n % 7 / 10:.2f},{3.5 + n % 7 / 30 + n % 3 / 100:.4f}\n" for n in range(120)
)


@pytest.mark.parametrize(
    ("book", "toml"),
    [
        (APART, '[parameters]\na = "12.0 mm, +-1 mm arcsine"\nb = "3.6 mm, +-0.2 mm tri"\n' + TIED),
        (APART, '[parameters]\na = "12.0 mm, samples = s.csv"\nb = "3.6 mm, samples = s.csv"\n'),
        (EQUAL, '[measurements]\nfile = "m.csv"\n[uncertainty]\nv = "scatter"\n'),
    ],
    ids=["correlated, of other shapes", "from one table", "equal readings"],
)
def test_a_spreadsheet_calculates_what_was_issued(
    require: Callable[..., str], tmp_path: Path, book: str, toml: str
) -> None:
    require("soffice", "libreoffice")
    (tmp_path / "workbook.py").write_text(book)
    (tmp_path / "report.toml").write_text(f'workbook = "workbook.py"\n{toml}')
    (tmp_path / "s.csv").write_text(SAMPLES)
    (tmp_path / "m.csv").write_text("reading,v [V]\n1,5.007\n2,5.007\n3,5.007\n")
    (found,) = (each for each in Study(tmp_path).engines if each.engine == "xlsx")
    assert found.findings == ()
