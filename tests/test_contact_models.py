"""Contact models: proved, wrong variants refuted, published digits, and simulated beside closed forms."""

from __future__ import annotations

import io
import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from dataclasses import replace
from functools import cache
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.stats import chi2
from sympy import Expr, Rational, Symbol, acos, lambdify

import loopsheet
from loopsheet.derivations import soft_impact as paper
from loopsheet.derivations.contact import checks, hertz, johnson, thornton
from loopsheet.derivations.contact.hertz import HERTZ
from loopsheet.derivations.contact.lankarani_1994 import LANKARANI_1994
from loopsheet.derivations.contact.model import ContactModel
from loopsheet.derivations.contact.models import LEDGER, MODELS
from loopsheet.derivations.contact.power_law import POWER_LAW
from loopsheet.derivations.contact.prescribed import AUTHORS
from loopsheet.derivations.equation import Derivation
from loopsheet.derivations.proof import check_step, prove
from loopsheet.derivations.proved import ProofStatus
from loopsheet.report import stages
from loopsheet.report.impacts.contact import law_of
from loopsheet.report.impacts.simulation import simulate
from loopsheet.report.machine.kept import SETTING
from loopsheet.report.result import chi_square
from loopsheet.report.study import Study
from loopsheet.report.views import figures, html
from loopsheet.report.workbooks.contact_models import WORKBOOK

SHIPPED = Path(loopsheet.__file__).parent / "data" / "contact_models"


def test_all_of_it_is_proved_and_each_model_agrees_with_what_it_rests_on() -> None:
    found = prove(LEDGER)
    failed = {proof.equation.label: proof.steps for proof in found if not proof.status.passes}
    assert {label: [step.sentence for step in steps] for label, steps in failed.items()} == {}
    claims = {entry.claim for entry in LEDGER.entries if isinstance(entry, Derivation)}
    assert {proof.equation for proof in found if proof.status is ProofStatus.PROVED} == claims


def test_what_contradicts_a_model_within_its_part_is_refused() -> None:
    """The check of what holds together is asked of each model."""
    says = LEDGER["(L130)"]
    otherwise = replace(says, number="(L999)", members=(says.members[0], Rational(1, 2)))
    part = LEDGER.parts[-len(MODELS) + 1]
    assert says in part
    wrong = replace(LEDGER, entries=(*LEDGER.entries, otherwise), parts=((*part, otherwise),))
    found = {proof.equation.label: proof for proof in prove(wrong)}
    assert found["(L999)"].status is ProofStatus.REFUSED


DERIVED = {entry.claim.label: entry for entry in LEDGER.entries if isinstance(entry, Derivation)}


@pytest.mark.parametrize("factor", [2, Rational(1, 2), -1])
@pytest.mark.parametrize("label", DERIVED)
def test_a_wrong_variant_is_refuted(label: str, factor: Any) -> None:
    """What a slip of the pen makes of the last side of any claim, of models that are yet to come too."""
    claim, steps = DERIVED[label].claim, DERIVED[label].steps
    slipped = replace(claim, members=(*claim.members[:-1], factor * claim.members[-1]))
    found = check_step(replace(steps[-1], claim=slipped), LEDGER.vocabulary)
    assert found.status is ProofStatus.REFUTED
    assert found.counterexample


def test_another_place_of_the_cut_is_refuted() -> None:
    """The spring beyond it would be at rest at a third of its approach, not at none of it."""
    derivation = LEDGER.derivation(LEDGER["(L167)"])
    assert derivation is not None
    (step,) = derivation.steps
    elsewhere = acos(thornton.x_y / thornton.x_m)
    members = tuple(side.replace(acos, lambda place: elsewhere) for side in step.claim.members)
    slipped = replace(step.claim, members=members)
    assert slipped != step.claim
    found = check_step(replace(step, claim=slipped), LEDGER.vocabulary)
    assert found.status is ProofStatus.REFUTED


# --- digits of others -------------------------------------------------------------------------------------


@pytest.mark.parametrize(("nu", "ratio"), [(0.2, 1.49859), (0.3, 1.61280), (0.4, 1.73848), (0.5, 1.87724)])
def test_the_pressure_of_first_yield_hangs_on_poissons_ratio(nu: float, ratio: float) -> None:
    slope = lambdify((johnson.zeta, johnson.nu), johnson.deepest.value * 0 + johnson.deepest.sides[0])
    depth = brentq(lambda zeta: slope(zeta, nu), 0.2, 0.9, xtol=1e-14)
    pressure = lambdify((johnson.zeta, johnson.nu, johnson.Y), johnson.pressure_at_yield.value)
    assert pressure(depth, nu, 1.0) == pytest.approx(ratio, abs=6e-6)


@pytest.fixture(scope="module")
def report() -> Any:
    return loopsheet.load(SHIPPED)


def of(report: Any, name: str) -> Any:
    return np.round(report[name].value, {"um": 2, "GPa": 4}.get(report[name].unit, 3)).tolist()


def test_the_paper_s_tests_are_predicted_as_known(report: Any) -> None:
    assert of(report, "x_p_lankarani") == [21.07, 26.00, 35.36, 38.76, 42.79]
    assert of(report, "over_lankarani") == [1.115, 1.142, 1.177, 1.186, 1.193]
    assert round(float(report["alpha_by_e"].value), 3) == 1.076
    assert round(float(report["alpha_eiv"].value), 7) == 1.3013045
    assert round(float(report["meyer_n"].value), 2) == 2.60
    assert report["t_power"].value[[0, 4]] == pytest.approx([34.3, 29.4], abs=0.06)
    assert report["recovery_power"].value[0] == pytest.approx(10.4, abs=0.05)
    assert report["recovery_asked"].value[0] == pytest.approx(18.4, abs=0.05)
    gravity = report["deceleration_power"].value / 9.80665
    assert gravity[[0, 4]] == pytest.approx([1.9e4, 4.4e4], rel=0.015)


def test_johnson_s_law_with_one_constant_comes_within_nine_percent_of_all(report: Any) -> None:
    for name in ("miss_e_johnson", "miss_x_p_johnson"):
        assert np.all(np.abs(report[name].value) < 9), name
        largest = report[name.replace("miss", "most")].value
        assert float(largest) == pytest.approx(np.max(np.abs(report[name].value)), rel=1e-14)
    assert re.search(r"none by more than\s+8\.93\s*%", words_of(shipped_page()))
    assert np.max(np.abs(report["miss_x_p_thornton"].value)) > 20


def test_leaving_a_test_out_is_taking_the_mean_of_the_others(report: Any) -> None:
    alone, without = report["p_d_alone"].value, report["p_d_without"].value
    for row in range(5):
        others = np.delete(alone, row)
        assert without[row] == pytest.approx(np.exp(np.log(others).mean()), rel=1e-13)


def test_sums_of_squares_are_those_of_a_search_for_the_true_speeds(report: Any) -> None:
    """Along the tangent that is a quadratic equation; here it is a matrix of each test."""
    v, e, x_p = (report[name].value for name in ("v", "e", "x_p"))
    u_v, u_e, u_x = (report[name].value for name in ("u_v", "u_e", "u_x_p"))
    slopes = np.array([report["d_e_v_johnson"].value, 1e6 * report["d_x_p_v_johnson"].value])
    off = np.array([e - report["e_johnson"].value, x_p - report["x_p_johnson"].value])
    total = 0.0
    for k in range(len(v)):
        covariance = np.diag([u_e[k] ** 2, u_x[k] ** 2]) + u_v[k] ** 2 * np.outer(slopes[:, k], slopes[:, k])
        total += off[:, k] @ np.linalg.solve(covariance, off[:, k])
    assert float(report["chi2_johnson"].value) == pytest.approx(total, rel=1e-9)


# --- few, slow and elastic tests, and what is left out ------------------------------------------------------


def changed(place: Path, tests: str = "", leave: str = "", **parameters: str) -> Study:
    """The shipped folder with other tests and parameters, or without one."""
    text = (SHIPPED / "report.toml").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not leave or not line.startswith(leave)]
    for name, value in parameters.items():
        lines = [line for line in lines if not line.startswith(f"{name} ")]
        lines.insert(
            lines.index(next(line for line in lines if line.startswith("[parameters]"))) + 1,
            f'{name} = "{value}"',
        )
    (place / "report.toml").write_text("\n".join(lines), encoding="utf-8")
    rows = [f"{n},{row}" for n, row in enumerate(tests.split("; "), 1)] if tests else []
    own = "\n".join(("test,v [m/s],e [1],x_p [um]", *rows, ""))
    (place / "measurements.csv").write_text(
        own if rows else (SHIPPED / "measurements.csv").read_text(encoding="utf-8"), encoding="utf-8"
    )
    return Study(place)


ALL = ("2.334,0.530,23.5", "2.940,0.512,29.7", "4.089,0.479,41.6", "4.504,0.467,45.97", "4.993,0.453,51.03")


def test_two_tests_tell_no_curve_without_one_of_them(tmp_path: Path) -> None:
    """Their leverages are 1: what is left over is 0/0, whatever rounding makes of it."""
    report = changed(tmp_path, "; ".join(ALL[:2])).proved
    cell = report.values.cell("rms_x_p_power")
    assert cell.reason == (
        "#DOMAIN! rms_x_p_power needs x_p_power_without[1]: outside the domain of (L163): "
        "the others alone tell no curve: it takes three tests, none with all the weight"
    )
    assert [found for engine in report.engines for found in engine.findings] == []
    assert [check.message for check in report.oddities if not check.passed] == [
        "rms_x_p_power of the result has no value, for want of x_p_power_without[1]"
    ]
    assert report.values.rows_summed("rms_x_p_johnson", "tests") == 2


def test_all_models_are_asked_for_the_same_tests(tmp_path: Path) -> None:
    """Of a test without loss Thornton has no pressure; no other model may count it for itself."""
    elastic = (ALL[0], "2.940,1.000,29.7", *ALL[2:])
    values = changed(tmp_path, "; ".join(elastic)).computed.values
    names = [
        name for name in values.sheet.by_name if name.startswith(("rms_", "chi2_")) and name != "chi2_eiv"
    ]
    assert len(names) == 12
    assert {values.rows_summed(name, "tests") for name in names} == {4}
    # And the mean over the others is over those that tell a pressure.
    for alone, says, without in (
        ("p_d_alone", "p_d_alone", "p_d_without"),
        ("p_y_alone", "r_Y_alone", "p_y_without"),
    ):
        assert values.cell(says, (2,)).reason.endswith("e = 1: nothing is lost, which tells nothing of yield")
        others = np.array([values.value[alone][row] for row in (2, 3, 4)])
        assert values.value[without][0] == pytest.approx(np.exp(np.log(others).mean()), rel=1e-13)


def test_a_test_without_loss_leaves_the_constants_of_all_others_as_they_are(tmp_path: Path) -> None:
    found = []
    for number, tests in enumerate(((*ALL, "5.500,1.000,56.0"), ALL)):
        (place := tmp_path / str(number)).mkdir()
        found.append(changed(place, "; ".join(tests)).computed.values)
    lossless, fewer = found
    for name in ("p_d", "p_y"):
        assert lossless.scalar(name) == pytest.approx(fewer.scalar(name), rel=1e-13)
        assert lossless.rows_summed(name, "tests") == 5


def test_below_its_limit_thornton_s_impact_is_hertz_s(tmp_path: Path) -> None:
    values = changed(
        tmp_path, "; ".join(("0.05,0.999,0.01", "2.940,0.512,29.7", "4.089,0.479,41.6"))
    ).computed.values
    v, V_y = values.value["v"], float(values.value["V_y"][0])
    assert v[0] < V_y < v[1]
    for name in ("x_m", "F_m", "e", "x_p"):
        own, elastic = values.value[f"{name}_thornton"], values.value[f"{name}_hertz"]
        assert own[0] == pytest.approx(elastic[0], rel=1e-12), name
    assert values.value["e_thornton"][0] == 1
    assert values.value["x_p_thornton"][0] == 0
    assert values.value["d_e_v_thornton"][0] == 0
    # On both sides of the limit the impact is the same.
    model, where = thornton.THORNTON, numbers("steel")
    limit = closed(model, thornton.V_y, where)
    for symbol, near in ((thornton.e_T, 1e-9), (thornton.x_m, 1e-9), (thornton.peak, 1e-9)):
        below, above = (
            closed(model, symbol, where | {hertz.v: limit * (1 + step)}) for step in (-1e-12, 1e-12)
        )
        assert below == pytest.approx(above, rel=near)


def test_slopes_of_a_model_are_those_of_its_cells() -> None:
    """Along the cells, with their cases; here as differences."""
    for case in ("steel", "polymer"):
        where = numbers(case)
        for model in MODELS:
            for symbol in model.predicts.values():
                if model.left_out:
                    continue
                slope = model.slope(symbol, hertz.v)
                for equation in (*reversed(model.cells), hertz.stiffness, hertz.radius, hertz.modulus):
                    slope = slope.xreplace({equation.sides[0]: equation.value})
                speed, step = where[hertz.v], 1e-6
                ends = (closed(model, symbol, where | {hertz.v: speed * (1 + s)}) for s in (-step, step))
                below, above = ends
                found = float(slope.subs(where).evalf(30))
                assert found == pytest.approx((above - below) / (2 * step * speed), rel=1e-7, abs=1e-15)


def test_a_recovery_that_is_the_whole_approach_is_told_with_its_inequality(tmp_path: Path) -> None:
    study = changed(tmp_path, "; ".join((*ALL[:4], "4.993,0.97,51.03")))
    told = study.computed.values.cell("x_p_power", (5,)).reason
    assert "e^2 is not below (alpha + 1)/(beta + 1)" in told


def test_a_target_may_be_a_ball(tmp_path: Path) -> None:
    """Of two equal balls that are free first yield comes at half of the speed that a plane has."""
    plane = Study(SHIPPED).computed.values
    ball = changed(tmp_path, target_diameter="12.7 mm", target_mass="8.36574048 g").computed.values
    assert ball.scalar("R_b") == pytest.approx(12.7e-3 / 4, rel=1e-14)
    assert ball.scalar("v_Y") == pytest.approx(plane.scalar("v_Y") / 2, rel=1e-9)
    assert ball.scalar("m_red") == pytest.approx(plane.scalar("m_red") / 2, rel=1e-9)


def test_what_the_paper_quotes_of_first_yield_is_consistent() -> None:
    """Speeds and falls, and how first yield goes with the strength, as the report says it."""
    narrative = WORKBOOK.told["first_yield"]
    gravity, fast = 9.80665, 3 * 0.0254
    quoted = f"3 in/s, {fast:.3f} m/s, which is a fall of {1e3 * fast**2 / (2 * gravity):.1f} mm"
    assert quoted in narrative
    assert f"a fall of 1 mm, which is {np.sqrt(2 * gravity * 1e-3):.2f} m/s" in narrative
    speeds = [
        (johnson.speed_at_yield.value.xreplace({johnson.x_Y: johnson.approach_at_yield.value})).subs(
            johnson.p_Y, pressure
        )
        for pressure in (1, 2)
    ]
    assert f"{float((speeds[1] / speeds[0]).simplify()):.1f} times as high" in narrative


def test_a_restitution_above_one_has_a_mark(tmp_path: Path) -> None:
    report = changed(tmp_path, "0.1,0.9,1.0; 1.0,0.9,10; 10,0.9,100").computed
    assert report.values.value["e_johnson"][0] > 1
    assert [bool(mark) for mark in report.marks.of("e_johnson")] == [True, False, False]
    assert report.values.cell("x_p_johnson", (1,)).reason.endswith("the recovery is the whole approach")


def test_tests_slower_than_first_yield_have_a_mark(tmp_path: Path) -> None:
    report = changed(tmp_path, sigma_Y="400 GPa").computed
    assert all(mark.startswith("slower than first yield") for mark in report.marks.of("v_over_Y"))
    assert report.marks.of("p_y")[0].startswith("below the pressure of first yield")
    (tmp_path / "sound").mkdir()
    sound = changed(tmp_path / "sound").computed
    assert [mark for name in ("v_over_Y", "p_y", "e_johnson") for mark in sound.marks.of(name) if mark] == []


def test_what_is_said_of_first_yield_is_true_of_other_bodies_and_without_an_imprint(tmp_path: Path) -> None:
    report = changed(tmp_path, "; ".join((*ALL[:2], "0.010,1.000,"))).computed
    assert [bool(mark) for mark in report.marks.of("v_over_Y")] == [False, False, True]
    said = words_of(shipped_page())  # of a target that may be a ball, too, and of any metal
    assert "ball and a plane" not in said
    assert "steel" not in WORKBOOK.told["daily_life"]
    assert "is not has a mark: if it left one all the same, it contradicts the yield strength" in said


def test_the_yield_strength_may_be_left_out(tmp_path: Path) -> None:
    study = changed(tmp_path, leave="sigma_Y")
    assert {"v_Y", "v_over_Y", "sigma_Y"}.isdisjoint(study.computed.sheet.by_name)
    assert "Where yield begins" not in html.render(study.computed, {})
    assert "Where yield begins" in shipped_page()


def test_a_parameter_that_is_missing_is_asked_for_with_an_example(tmp_path: Path) -> None:
    with pytest.raises(loopsheet.LoopsheetError, match=r'write E_1 = "210 GPa"'):
        _ = changed(tmp_path, leave="E_1").computed


def test_the_deceleration_is_that_of_the_ball(tmp_path: Path) -> None:
    values = changed(tmp_path, target_mass="20 g").computed.values
    mass, force = float(values.value["ball_mass"][0]), values.value["F_m_power"]
    assert mass > 1.3 * float(values.value["m_red"][0])
    assert values.value["deceleration_power"] == pytest.approx(force / mass, rel=1e-14)


# --- what is shown of the models ----------------------------------------------------------------------------


@cache
def shipped_page() -> str:
    """Without a script, and without what is drawn: captions stand below empty pictures."""
    report = Study(SHIPPED).proved
    empty = '<svg xmlns="http://www.w3.org/2000/svg"></svg>'
    return html.render(report, {figure.name: empty for figure in figures.of(report)})


def words_of(page: str) -> str:
    return re.sub(r"\s+", " ", re.sub("<[^>]*>", " ", unescape(page)))


def test_a_table_says_what_each_model_assumes_and_takes() -> None:
    said = words_of(shipped_page())
    for model in MODELS:
        assert model.assumes in said
        assert model.source in said
    assert "two numbers; each restitution is told" in said
    assert WORKBOOK.told["results"].count("no number") == 2
    assert all(author.title in said for author in AUTHORS)
    assert "each test: of all authors, and the exact one" in said


def test_sums_of_squares_have_their_number_and_a_probability(report: Any) -> None:
    """Two squares of each test, less the constant; as scipy has the distribution."""
    table = next(
        each for each in re.findall(r"<table.*?</table>", shipped_page(), re.DOTALL) if "probability" in each
    )
    rows = [
        re.findall(r"<td[^>]*>([^<]*)", row) for row in re.findall(r"<tr.*?(?=<tr|</table)", table, re.DOTALL)
    ]
    found = {tuple(row[-4:]) for row in rows if row}
    rare = "below 1\u00a0×\u00a010⁻¹⁵"
    assert {row[:3] for row in found} == {
        ("10", "0", "10"),
        ("5", "0", "5"),
        ("10", "1", "9"),
        ("5", "2", "3"),
    }
    assert {row[3] for row in found} == {rare, "6\u00a0×\u00a010⁻¹²"}
    square = {each.name: each for each in WORKBOOK.squares}["chi2_johnson"]
    assert chi_square.freedom(square, Study(SHIPPED).computed) == 9
    assert chi_square.tail(14.0, 9) == pytest.approx(chi2.sf(14.0, 9), rel=1e-12)


def test_tables_are_numbered_as_they_come() -> None:
    numbers_of = [
        int(n)
        for n in re.findall(r"<caption[^>]*>(?:<[^>]*>)*Table[\s\u00a0](?:<[^>]*>)*(\d+)", shipped_page())
    ]
    assert len(numbers_of) > 15
    assert numbers_of == sorted(numbers_of)


_DAMPED = False
"""Damping numbers are of simulation codes: no model of the tests stands among their authors."""
_IN_CARDS = [True, True, True]
"""Restitutions that are typed in, since a toy is told one; restitutions; imprints, of which it leaves one."""
TOY = '''\
"""A toy: what is lost is lost from the approach."""

from __future__ import annotations

from sympy.core.parameters import evaluate

from ..equation import Equation, Kind
from ..vocabulary import Quantity, Vocabulary
from . import hertz
from .model import ContactModel
from .quantities import SHARED

OWN = (Quantity("x_p_toy", "imprint by the toy", "m", r"x_{p,\\mathrm{toy}%s}", (1e-6, 1e-4)),)
_WORDS = Vocabulary(*SHARED.values(), *hertz.OWN, *OWN)
(e,) = SHARED.plain("e")
x_m, peak, x_p = _WORDS.plain("x_m_hertz F_m_hertz x_p_toy")

with evaluate(False):
    value = x_m * (1 - e)
    imprint = Equation("(L401)", (x_p, value), "a toy says so", Kind.ASSUMPTION, "a toy", defines=x_p)

TOY = ContactModel(
    name="toy",
    title="a toy of the tests",
    mark="toy",
    assumes="what is lost is lost from the approach",
    source="nobody, nowhere",
    quantities=OWN,
    entries=(imprint,),
    cells=(hertz.approach, hertz.greatest, imprint),
    predicts={"x_p": x_p},
    loading=hertz.HERTZ.loading,
    unloading=hertz.unloads(peak, x_m, x_p),
)
'''


def test_a_model_is_one_file_and_one_line(tmp_path: Path) -> None:
    """In a copy of the sources it is then in algebra, sheet, tables, pictures, sentences and cards."""
    root = tmp_path / "loopsheet"
    left = shutil.ignore_patterns(".*", "tests", "out", "docs", "requirements", "benchmarks", "__pycache__")
    shutil.copytree(Path(loopsheet.__file__).parent, root, ignore=left)
    (root / "derivations" / "contact" / "toy.py").write_text(TOY, encoding="utf-8")
    models = root / "derivations" / "contact" / "models.py"
    text = models.read_text(encoding="utf-8").replace(", POWER_LAW)\n", ", POWER_LAW, TOY)\n", 1)
    models.write_text(
        text.replace("from .thornton", "from .toy import TOY\nfrom .thornton"), encoding="utf-8"
    )

    def run(*words: str) -> str:
        own = {**os.environ, "PYTHONPATH": str(tmp_path), SETTING: str(tmp_path / "kept")}
        done = subprocess.run(
            [sys.executable, *words], cwd=tmp_path, env=own, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    assert "x_p_toy = x_m_hertz*(1 - e)" in run(
        "-m", "loopsheet", "prove", "(L401)", "loopsheet/data/contact_models"
    )
    run("-m", "loopsheet", "build", "loopsheet/data/contact_models", "--out", "out", "--to", "html")
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    page = re.sub(r"<script(?: [^>]*)?>.*?</script>", "", page, flags=re.DOTALL)
    for name in ("x_p_toy", "miss_x_p_toy", "rms_x_p_toy", "chi2_toy"):
        assert re.search(rf'data-cell="?{name}\b', page), name
    said = words_of(page)
    assert (
        "A toy of the tests : with no number from the tests and each restitution it misses the imprints by"
        in said
    )
    assert "nobody, nowhere" in said
    pictures = re.findall(r"<svg role=img.*?</svg>", page, re.DOTALL)
    assert ["toy" in words_of(picture) for picture in pictures] == [True, False, True, _DAMPED, *_IN_CARDS]
    cells = json.loads((tmp_path / "out" / "values.json").read_text(encoding="utf-8"))["cells"]
    assert cells["x_p_toy"]["value"][0] == pytest.approx(cells["x_m_hertz"]["value"][0] * 0.47, rel=1e-14)
    chapter = words_of(page.partition("<section id=cards")[2].partition("</section>")[0])
    assert "x_p_toy = x_max*(1 - e)" in chapter
    assert "nobody, nowhere" in chapter
    # Of the approach a simulated impact under its law leaves what the test in the middle has lost.
    card = json.loads(
        run("-m", "loopsheet", "card", "loopsheet/data/contact_models", "--for", "toy", "--format", "json")
    )
    assert card["returned"]["imprint"] / card["returned"]["approach"] == pytest.approx(1 - 0.479, rel=1e-9)


def test_loops_are_native_charts_of_the_workbook_a_panel_for_each_test() -> None:
    """Drawn from the cells of the worksheet, as the page draws them from its own."""
    _, content = stages.book(Study(SHIPPED).computed)
    with zipfile.ZipFile(io.BytesIO(content)) as parts:
        charts = [parts.read(name).decode() for name in parts.namelist() if "charts/chart" in name]
    panels = [chart for chart in charts if "loops!" in chart]
    assert len(panels) == 10
    for chart in panels[5:]:
        assert all(author.title in chart for author in AUTHORS)
    for number, chart in enumerate(panels[:5]):
        assert f"<a:t>test {number + 1}</a:t>" in chart
        first = 8 + 33 * number
        places = [
            re.findall(r"<c:f>loops!(.*?)</c:f>", one) for one in re.findall("<c:ser>.*?</c:ser>", chart)
        ]
        assert len(places) == 2 * len(MODELS)
        rows = {tuple(re.findall(r"[$](\d+)", place)) for own in places for place in own}
        assert rows == {(str(first), str(first + 32))}
        assert len({place for own in places for place in own}) == 4 * len(MODELS)
        assert all(model.title in chart for model in MODELS)


# --- closed forms beside simulated impacts ------------------------------------------------------------------

CASES = {  # E of both, radius, mass, speed, pressure that the target stands
    "steel": (210e9, 6.35e-3, 8.366e-3, 3.0, 1.5e9),
    "soft steel": (210e9, 6.35e-3, 8.366e-3, 4.5, 0.95e9),
    "aluminium": (70e9, 5e-3, 1.4e-3, 2.0, 0.5e9),
    "polymer": (3e9, 10e-3, 5e-3, 5.0, 0.02e9),
}


def numbers(case: str) -> dict[Expr, float]:
    """The constants of the models, in SI."""
    E, radius, mass, speed, pressure = CASES[case]
    return {
        hertz.E_1: E, hertz.E_2: E, hertz.nu_1: 0.3, hertz.nu_2: 0.3, hertz.d: 2 * radius, hertz.m_red: mass,
        hertz.v: speed, johnson.p_d: pressure, thornton.p_y: pressure, hertz.e: 0.6,
        paper.alpha: 1.25, paper.C: pressure**1.25 * radius**0.75,
        paper.beta: 1.5,
    }  # fmt: skip


def closed(model: ContactModel, of: Symbol, where: dict[Expr, float]) -> float:
    """What a cell is, by its equation and those that it needs."""
    found = of
    for equation in (*reversed(model.cells), hertz.stiffness, hertz.radius, hertz.modulus):
        found = found.xreplace({equation.sides[0]: equation.value})
    return float(found.subs(where).evalf(30))


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_a_simulated_impact_is_as_the_closed_forms_say(model: ContactModel, case: str) -> None:
    where = numbers(case)
    law = law_of(model)
    constants = {symbol: where[symbol] for symbol in law.constants}
    mass, speed = where[hertz.m_red], where[hertz.v]
    found = simulate(law, constants, mass, speed)
    assert not found.failure
    shown = {"x_m": found.x_m, "F_m": found.F_m, "t": found.duration, "e": found.e, "x_p": found.x_p}
    for name, symbol in model.predicts.items():
        expected = closed(model, symbol, where)
        assert shown[name] == pytest.approx(expected, rel=1e-9, abs=1e-15 if name == "x_p" else 0), name
    e = closed(model, model.predicts["e"], where) if "e" in model.predicts else where[hertz.e]
    assert found.e == pytest.approx(e, rel=1e-9)
    assert found.loss == pytest.approx((1 - e**2) * mass * speed**2 / 2, rel=1e-9, abs=1e-12)


def test_the_time_of_hertz_has_its_known_coefficients() -> None:
    where = numbers("steel")
    model = MODELS[0]
    x_m, t = (closed(model, model.predicts[name], where) for name in ("x_m", "t"))
    assert t == pytest.approx(2.94327518432470 * x_m / where[hertz.v], rel=1e-14)
    E, radius, mass, speed, _ = CASES["steel"]
    modulus = E / (2 * (1 - 0.3**2))
    expected = 2.86826569919533 * (mass**2 / (radius * modulus**2 * speed)) ** 0.2
    assert t == pytest.approx(expected, rel=1e-13)


def test_johnson_s_restitution_has_its_known_coefficient() -> None:
    where = numbers("soft steel")
    E, radius, mass, speed, pressure = CASES["soft steel"]
    modulus, energy = E / (2 * (1 - 0.3**2)), mass * speed**2 / 2
    expected = 1.883874 * (pressure / modulus) ** 0.5 * (energy / (pressure * radius**3)) ** (-1 / 8)
    assert closed(johnson.JOHNSON, johnson.e_J, where) == pytest.approx(expected, rel=1e-6)


def test_thornton_s_closed_form_is_that_of_its_loop() -> None:
    where = numbers("steel")
    share = closed(thornton.THORNTON, thornton.V_y, where) / where[hertz.v]
    fourth = float(thornton.published.value.subs({thornton.share: share}))
    assert closed(thornton.THORNTON, thornton.e_T, where) == pytest.approx(fourth**0.25, rel=1e-12)
    assert 0 < share < 1


@pytest.mark.parametrize("e", [0.0, 0.3, 0.999, 1.0])
def test_law_3_has_its_limits(e: float) -> None:
    """Of Hertz's exponent on both branches it is Lankarani's, which is Hertz's if all comes back."""
    where = numbers("steel") | {hertz.e: e, paper.alpha: 1.5}
    where[paper.C] = closed(HERTZ, hertz.K, where)
    imprints = [closed(model, model.predicts["x_p"], where) for model in (POWER_LAW, LANKARANI_1994)]
    x_m = closed(HERTZ, hertz.x_m, where)
    assert imprints == pytest.approx([x_m * (1 - e**2)] * 2, rel=1e-12, abs=0)
    if e > 0:
        times = [closed(model, model.predicts["t"], where) for model in (POWER_LAW, LANKARANI_1994)]
        assert times[0] == pytest.approx(times[1], rel=1e-14)
        assert (times[1] == pytest.approx(closed(HERTZ, hertz.t, where), rel=1e-14)) is (e == 1)


def test_exponents_by_restitutions_follow_from_synthetic_ones() -> None:
    """Restitutions that an elastic unloading gives for an exponent tell that exponent."""
    alpha = 1.2
    power = (alpha - 1.5) / (alpha + 1)
    assert float(checks.by_restitution.value.subs({checks.b: power})) == pytest.approx(alpha, rel=1e-14)
