"""`loopsheet design`: a planned campaign is computed as a measured one; best choices; backwards."""

from __future__ import annotations

import json
import math
import shutil
from collections.abc import Sequence
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from loopsheet.derivations.unit_text import parse_unit
from loopsheet.report.cli import main
from loopsheet.report.inputs.planned import planned, read_numbers, read_u
from loopsheet.report.inputs.stated import read_statement
from loopsheet.report.messages.errors import InputError
from loopsheet.report.result.result import Report
from loopsheet.report.stages import computing
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.design import Planner

PAPER = Path(__file__).parent.parent / "data" / "soft_steel"
STATED = "v = +-0.5 % rect; e = 0.002; x_p = u = 0.1 um, dof = 7"


@pytest.fixture(scope="module")
def paper() -> Report:
    """The shipped paper, computed."""
    return Study(PAPER).computed


@pytest.fixture(scope="module")
def planner(paper: Report) -> Planner:
    """Plans for the mean of its pairs."""
    return planner_of(paper, "alpha_mean")


def planner_of(report: Report, cell: str, label: tuple[int, ...] = ()) -> Planner:
    columns = [report.sheet[name] for name in (cell, "v", "e", "x_p")]
    assert report.workbook.design is not None
    design, compute = report.workbook.design(report.sheet), computing(report.sheet, columns)
    return Planner(report.inputs, report.values, design, compute, (cell, label), {})


def told(capsys: pytest.CaptureFixture[str], *words: str, code: int = 0) -> str:
    capsys.readouterr()
    assert main(["design", *words]) == code
    return capsys.readouterr().out


def as_json(capsys: pytest.CaptureFixture[str], *words: str, code: int = 0) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(told(capsys, *words, "--format", "json", code=code))
    return found


# --- what a planned campaign is ---------------------------------------------------------------------------


@pytest.mark.parametrize("cell", ["alpha_mean", "alpha_lin", "C_log", "alpha[1-3]"])
def test_a_folder_with_the_planned_numbers_has_the_same_budget(
    cell: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = as_json(capsys, "paper", "--speeds", "2.5, 3.5, 400 cm/s, 5", "--u", STATED, "--cell", cell)
    assert [test["v"]["value"] for test in plan["tests"]] == [2.5, 3.5, 4.0, 5.0]
    rows = [
        f"{t['test']},{','.join(repr(t[name]['value']) for name in ('v', 'e', 'x_p'))}" for t in plan["tests"]
    ]
    table = "\n".join(["test,v [m/s],e [1],x_p [m]", *rows, ""])
    toml = (PAPER / "report.toml").read_text(encoding="utf-8").partition("[measurements]")[0]
    stated = '[uncertainty]\nv = "+-0.5 % rect"\ne = "u = 0.002"\nx_p = "u = 0.1 um, dof = 7"\n'
    (tmp_path / "report.toml").write_text(f'{toml}[measurements]\nfile = "m.csv"\n{stated}', encoding="utf-8")
    (tmp_path / "m.csv").write_text(table, encoding="utf-8")
    assert main(["budget", cell, str(tmp_path), "--format", "json"]) == 0
    budget = json.loads(capsys.readouterr().out)
    for name in ("value", "u", "k", "U"):
        assert plan[name] == pytest.approx(budget[name], rel=1e-9), name
    shares: dict[str, float] = {}
    for source in budget["sources"]:
        column = source["source"].partition("[")[0]
        shares[column] = shares.get(column, 0) + source["share"]
    assert plan["shares"] == pytest.approx(shares, rel=1e-7)


def test_planned_on_its_own_measured_numbers_the_paper_has_its_own_uncertainty(
    paper: Report, planner: Planner
) -> None:
    own = {name: [float(each.value) for each in column] for name, column in paper.inputs.measured.items()}
    found = planner.u(planned(paper.inputs, own, range(5), {}))
    assert found == pytest.approx(0.0035015, abs=5e-8)


def test_on_the_curve_the_ten_pairs_are_as_uncertain_as_the_paper_within_two_percent(
    planner: Planner,
) -> None:
    """All that differs are the values at which the derivatives are taken: on the curve, or as measured."""
    found = planner.u(planner.inputs_of(planner.values.value["v"].tolist(), range(5)))
    assert found == pytest.approx(0.0035711, abs=5e-8)
    assert found / 0.0035015 - 1 < 0.02


def test_planned_tests_lie_on_the_curve(paper: Report, planner: Planner) -> None:
    made = planner.compute(planner.inputs_of([2.0, 3.0, 4.5])).values
    assert made.value["alpha"] == pytest.approx([paper.values.scalar("alpha_log")] * 3, rel=1e-12)


def test_a_planned_test_has_digits_and_groups_of_the_nearest_one(tmp_path: Path) -> None:
    for name in ("report.toml", "measurements.csv"):
        text = (PAPER / name).read_text(encoding="utf-8").partition("[published]")[0]
        (tmp_path / name).write_text(text, encoding="utf-8")
    with (tmp_path / "report.toml").open("a", encoding="utf-8") as toml:
        toml.write('[uncertainty.shared.datum]\nof = "x_p"\nstated = "u = 0.2 um"\ngroups = [[1, 2], [5]]\n')
    own = planner_of(Study(tmp_path).computed, "alpha_mean")
    made = own.inputs_of([2.2, 3.0, 4.1, 4.9])
    assert [each.decimals for each in made.measured["x_p"]] == [1, 1, 1, 2]
    assert made.measured["x_p"][3].u == pytest.approx(0.005e-6 / math.sqrt(3), rel=1e-12)
    assert made.uncertainty.shared[0].groups == ((1, 2), (4,))
    assert own.inputs_of([4.1, 4.2]).uncertainty.shared == ()


# --- best, and backwards ----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def best(planner: Planner) -> tuple[list[float], float, float]:
    """Four speeds from 2 to 6 m/s."""
    speeds, found = planner.best(4, (2.0, 6.0))
    assert found.u <= found.u_equal
    return speeds, found.u, found.u_equal


def test_the_best_speeds_are_what_they_are_said_to_be(
    planner: Planner, best: tuple[list[float], float, float]
) -> None:
    speeds, u, u_equal = best
    assert all(2 <= speed <= 6 for speed in speeds)
    assert planner.u(planner.inputs_of(speeds)) == u
    assert planner.u(planner.inputs_of(planner.equal(4, (2.0, 6.0)))) == u_equal


@settings(max_examples=60, deadline=None)
@given(parts=st.lists(st.floats(0, 1), min_size=4, max_size=4))
def test_no_random_speeds_are_better(
    parts: Sequence[float], planner: Planner, best: tuple[list[float], float, float]
) -> None:
    chosen = sorted(2 + 4 * part for part in parts)
    near = any(b < 1.04 * a for a, b in pairwise(chosen))
    assert near or planner.u(planner.inputs_of(chosen)) >= best[1]


def test_speeds_that_tell_no_exponent_are_no_choice(best: tuple[list[float], float, float]) -> None:
    """Two tests that are planned alike have no pair; measured, they have one of any exponent."""
    assert all(b >= 1.04 * a for a, b in pairwise(best[0]))


@settings(max_examples=10, deadline=None)
@given(of=st.sampled_from(["v", "e", "x_p"]), part=st.floats(0.02, 3))
def test_backwards_inverts_forwards(of: str, part: float, paper: Report, planner: Planner) -> None:
    base = planner.inputs_of([2.2, 3.1, 4.6, 5.5])
    forth = planner.needed(of, 1.0, base)
    wanted = math.hypot(forth.others, part * planner.u(base))
    found = planner.needed(of, wanted, base)
    same = {name: [float(each.value) for each in column] for name, column in base.measured.items()}
    size = parse_unit(paper.sheet[of].unit)
    stated = {of: read_statement(f"u = {found.u!r}", size)}
    assert planner.u(planned(base, same, range(4), stated)) == pytest.approx(wanted, rel=1e-9)


def test_the_global_fit_is_planned_too_and_may_repeat_speeds() -> None:
    """It rests on no pair: two tests at one speed are two tests."""
    own = planner_of(Study(PAPER).computed, "alpha_eiv")
    once, twice = (own.u(own.inputs_of(speeds)) for speeds in ([2.5, 3.5, 5.0], [2.5, 2.5, 3.5, 5.0]))
    assert twice < 0.95 * once


def test_what_others_make_no_depth_can_mend(capsys: pytest.CaptureFixture[str]) -> None:
    out = told(
        capsys, "paper", "--cell", "alpha_mean", "--u", "e = 0.01", "--want", "0.005", "--of", "x_p", code=1
    )
    assert "no u(x_p) is small enough for u(alpha_mean) = 0.0050: without it the others alone make" in out


def test_what_a_cell_does_not_hang_on_may_be_as_uncertain_as_it_will(
    capsys: pytest.CaptureFixture[str],
) -> None:
    found = as_json(capsys, "paper", "--want", "0.01", "--of", "ball_density")["needed"]
    assert (found["u"], found["out_of_reach"]) == (None, False)
    assert "any u(ball_density) is small enough" in told(
        capsys, "paper", "--want", "0.01", "--of", "ball_density"
    )


# --- what is said -----------------------------------------------------------------------------------------


def test_it_says_what_a_newcomer_asks(capsys: pytest.CaptureFixture[str]) -> None:
    words = (
        "paper",
        "--cell",
        "alpha_mean",
        "--speeds",
        "2, 2.05, 2.15, 5 m/s",
        "--u",
        "x_p = 0.5 um; v = 0.01",
    )
    out = told(capsys, *words)
    assert out.startswith("planned on the curve of 'Soft steel, ball drop': alpha_log = 1.3023")
    for line in (
        "test  v [m/s]  u(v)   e ",
        "1     2.000    0.010  0.55045  0.00029  19.95     0.50 ",
        "matters most:",
        "terms of second order make",
        "warning: alpha[1-2]: speeds within 4 %: too near for averages and fits",
    ):
        assert line in out
    assert "| test | v \\[m/s\\] | u(v) |" in told(capsys, *words, "--format", "markdown")
    assert "warning: tests 1, 2, 3 and 4: v beyond what was measured, 2.334 m/s to 4.993 m/s;" in out
    assert "beyond" not in told(capsys, "paper", "--speeds", "2.4, 3, 4.993 m/s", "--cell", "alpha_mean")


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["--speeds", "2.5,, 3 m/s"], "LS403"),
        (["--speeds", "2.5 kg, 3"], "LS422"),
        (["--speeds", "2.5 m/, 3"], "LS42"),
        (["--speeds", "-1, 3"], "LS406"),
        (["--speeds", "1e300, 3"], "LS619"),
        (["--speeds", "0.001, 3"], "LS619"),
        (["--speeds", ", ".join(["3"] * 61)], "LS614"),
        (["--u", "x_q = 3 um"], "LS604"),
        (["--u", "x_p = 3 kg"], "LS431"),
        (["--u", "x_p = +-3"], "LS432"),
        (["--u", "x_p = 1 um; x_p = 2 um"], "LS433"),
        (["--u", ""], "LS604"),
        (["--cell", "alfa"], "LS604"),
        (["--cell", "alpha"], "LS604"),
        (["--cell", "alpha[1-4]", "--speeds", "2, 3, 4"], "LS604"),
        (["--best", "3"], "LS614"),
        (["--best", "1", "--between", "2 .. 3"], "LS614"),
        (["--best", "3", "--between", "3 .. 2"], "LS614"),
        (["--best", "3", "--between", "2 .. 3", "--speeds", "3, 4"], "LS614"),
        (["--want", "0.1"], "LS614"),
        (["--want", "0.1", "--of", "points_per_pair"], "LS604"),
        (["--want", "0.1 m", "--of", "x_p"], "LS422"),
        (["--want", "0", "--of", "x_p"], "LS406"),
    ],
)
def test_what_is_refused(capsys: pytest.CaptureFixture[str], words: list[str], code: str) -> None:
    assert main(["design", "paper", *words]) == 2
    assert f"error[{code}" in capsys.readouterr().err


@settings(max_examples=300, deadline=None)
@given(text=st.text(alphabet="vexp_u=;,.+-%1259 mkU\n/", max_size=24))
def test_bad_text_is_never_a_traceback(text: str, paper: Report) -> None:
    with suppress(InputError):
        read_u(text, "--u", paper.inputs)
    with suppress(InputError):
        read_numbers(text, "--speeds", ",", paper.workbook.measured[0], "m/s")


def test_what_is_said_of_measured_tests_is_not_said_of_planned_ones(tmp_path: Path) -> None:
    toml = 'workbook = "soft_impact"\n[parameters]\nball_mass = "8.4 g"\n[measurements]\nfile = "m.csv"\n'
    more = '[expected]\n"test 3" = "heard twice"\n[limits]\n"alpha[2-3]" = "1 .. 1.5"\n'
    rows = "1,2.2,0.535,22.58\n2,3.1,0.505,31.92\n3,4.3,0.47,44.61\n"
    (tmp_path / "report.toml").write_text(toml + more, encoding="utf-8")
    (tmp_path / "m.csv").write_text(f"test,v [m/s],e [1],x_p [um]\n{rows}", encoding="utf-8")
    assert main(["design", str(tmp_path), "--speeds", "2.5, 4"]) == 0


def test_only_a_workbook_with_a_design_plans(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["design", str(PAPER.parent / "gum_h1")]) == 2
    assert "error[LS618]" in capsys.readouterr().err


def test_a_campaign_without_a_curve_plans_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    toml = 'workbook = "soft_impact"\n[parameters]\nball_mass = "8.4 g"\n[measurements]\nfile = "m.csv"\n'
    (tmp_path / "report.toml").write_text(toml, encoding="utf-8")
    (tmp_path / "m.csv").write_text(
        "test,v [m/s],e [1],x_p [um]\n1,2.2,0.53,22.5\n2,3.1,0.5,20.1\n", encoding="utf-8"
    )
    assert main(["design", str(tmp_path), "--speeds", "2, 3"]) == 2
    assert "error[LS619]: this cannot be planned: there is no curve" in capsys.readouterr().err


def test_a_cell_without_a_value_is_a_finding(capsys: pytest.CaptureFixture[str]) -> None:
    assert "#DOMAIN! alpha_eiv" in told(capsys, "paper", "--speeds", "3, 3 m/s", code=1)


def test_without_any_error_a_number_is_exact(capsys: pytest.CaptureFixture[str]) -> None:
    """Mass and beta move no exponent: what rounding leaves of their derivatives is no uncertainty."""
    found = as_json(capsys, "paper", "--u", "v = 0; e = 0; x_p = 0", "--cell", "alpha_log")
    assert (found["u"], found["shares"]) == (0, {})
    assert "alpha_log = 1.3023464025015523, exactly" in told(
        capsys, "paper", "--u", "v = 0; e = 0; x_p = 0", "--cell", "alpha_log"
    )


def test_planned_tests_have_no_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The second is none of the specimen that stands in the second row of what was measured."""
    shutil.copytree(PAPER, tmp_path / "named", ignore=lambda *_: ["out"])
    table = tmp_path / "named" / "measurements.csv"
    head, *rows = table.read_text(encoding="utf-8").splitlines()
    named = "".join(f"{row},S-{n}\n" for n, row in enumerate(rows, start=1))
    table.write_text(f"{head},specimen\n{named}", encoding="utf-8")
    out = told(capsys, str(tmp_path / "named"), "--speeds", "4.9, 2.1, 3 m/s")
    assert "matters most" in out
    assert "S-" not in out
