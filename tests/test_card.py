"""Cards for simulation codes: what is typed in returns what was measured, by the code's own formula."""

import json
import math
import os
import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from helpers import number_for
from sympy import Float, Symbol

from loopsheet.derivations.contact.power_law import POWER_LAW
from loopsheet.report.cells.values import Status
from loopsheet.report.cli import main
from loopsheet.report.impacts.card import Bodies, Unreachable, card
from loopsheet.report.impacts.code import ContactFormula, SimulationCode, Typed
from loopsheet.report.impacts.codes import CODES
from loopsheet.report.impacts.contact import law_of
from loopsheet.report.impacts.drops import Drops
from loopsheet.report.impacts.law import ForceLaw, rate, v_0, x
from loopsheet.report.impacts.simulation import STAY, Impact, simulate
from loopsheet.report.impacts.source import SOURCES, identified
from loopsheet.report.impacts.sweep import as_csv, course_as_csv, repeated, sweep
from loopsheet.report.result import card_words
from loopsheet.report.result.card import Card

STEEL = Drops(
    mass=8.365740479899688e-3,
    v=(2.334, 2.940, 4.089, 4.504, 4.993),
    e=(0.530, 0.512, 0.479, 0.467, 0.453),
    x_p=(23.5e-6, 29.7e-6, 41.6e-6, 45.97e-6, 51.03e-6),
    alpha=1.3013045283263331,
    C=1009332417.7957059,
    beta=1.5,
    radius=6.35e-3,
)
BUFFER = Drops(12.0, (0.4, 0.1), (0.82, 0.9), (math.nan, math.nan), 1.1, 3e4, 1.5, 0.2)
"""Something heavy and soft, in another order, without imprints."""


def of(code: SimulationCode, drops: Drops = STEEL, modulus: float | None = None) -> Card:
    return card(code, drops, drops.middle, "x", Bodies(modulus, 0.3, drops.radius))


@pytest.fixture(scope="module")
def cards() -> dict[str, Card]:
    return {name: of(code) for name, code in CODES.items()}


@pytest.mark.parametrize("name", CODES)
def test_a_card_returns_what_was_measured(name: str, cards: dict[str, Card]) -> None:
    """The formula is simulated again from the numbers as typed: nine digits, in units of the code."""
    code, made = CODES[name], cards[name]
    typed = {
        one.symbol: float(f"{value.value:.9g}") for one, value in zip(code.typed, made.typed, strict=True)
    }
    constants = {}
    for one in reversed(code.typed):  # a unit may hold an exponent, which is typed too
        scale = float(
            one.scale.subs({other.symbol: typed[other.symbol] for other in code.typed if other.unit == "1"})
        )
        constants[one.symbol] = typed[one.symbol] / scale
    constants |= {symbol: STEEL.radius for symbol in code.law.constants if str(symbol) == "R"}
    found = simulate(code.law, constants, STEEL.mass, made.speed)
    assert found.e == pytest.approx(0.479, abs=2e-9)
    wanted = (made.wanted.imprint, found.x_p) if name == "exudyn" else (made.wanted.approach, found.x_m)
    assert wanted[1] == pytest.approx(wanted[0], rel=2e-8)
    assert [row.measured for row in made.rows] == list(STEEL.e)
    assert made.rows[2].by_card == pytest.approx(0.479, abs=1e-9)
    assert all(f"{value.value:.9g}" in made.snippet for value in made.typed) or name == "liggghts"


def test_what_a_typed_restitution_returns(cards: dict[str, Card]) -> None:
    """What the codes make of the measured .453: 8/5 by Flores, Tsuji without a pull, Thornton 2013."""
    found = {name: made.rows[-1].typed for name, made in cards.items()}
    assert {name: typed and round(typed, 4) for name, typed in found.items()} == {
        "adams": None,
        "chrono": 0.4199,
        "damping-family": None,
        "drake": None,
        "exudyn": None,
        "exudyn-damped": 0.4535,
        "lammps": 0.5130,
        "liggghts": 0.5130,
        "mujoco": None,
        "recurdyn": None,
        "simbody": None,
        "yade": 0.4529,
    }


def test_the_card_of_the_family_has_the_exact_damping_number(cards: dict[str, Card]) -> None:
    typed = {value.word: value.value for value in cards["damping-family"].typed}
    assert typed["c"] == pytest.approx(number_for(0.479), rel=1e-8)
    assert [row.by_card for row in cards["damping-family"].rows] == pytest.approx([0.479] * 5, rel=1e-8)


def test_an_imprint_is_the_measured_one_where_there_is_any(cards: dict[str, Card]) -> None:
    for name, made in cards.items():
        if name == "exudyn":
            assert made.returned.imprint == pytest.approx(41.6e-6, rel=1e-9)
            typed = {value.word: value.value for value in made.typed}
            assert typed["contactPlasticityRatio"] == pytest.approx(1 - 0.479**2, rel=1e-9)
        else:
            assert made.returned.imprint == 0
            assert "it leaves no imprint" in made.notes


@pytest.mark.parametrize("name", ["adams", "liggghts", "mujoco"])
def test_a_card_of_something_else(name: str) -> None:
    made = of(CODES[name], BUFFER)
    assert made.speed == 0.1
    assert made.returned.e == pytest.approx(0.9, abs=1e-9)
    assert made.returned.approach == pytest.approx(made.wanted.approach, rel=1e-9)


@pytest.mark.parametrize("name", ["chrono", "simbody"])
def test_a_given_modulus_is_the_stiffness(name: str) -> None:
    made = of(CODES[name], modulus=210e9)
    typed = made.typed[0]
    assert not typed.solved
    assert typed.value == pytest.approx(210e9 if name == "chrono" else 2**1.5 * 210e9 / 1.82, rel=1e-12)
    assert made.returned.e == pytest.approx(0.479, abs=1e-9)


def test_what_no_imprint_tells_is_unreachable() -> None:
    with pytest.raises(Unreachable, match="no loading curve is known"):
        of(CODES["exudyn"], BUFFER)


@pytest.mark.parametrize("radius", [1e297, 1e-293])
def test_a_radius_with_which_no_stiffness_stops_the_bodies(radius: float) -> None:
    with pytest.raises(
        Unreachable, match=rf"no stiffness from .* after 5\.5.*e-05 m with R = {re.escape(f'{radius:g}')} m"
    ):
        card(CODES["lammps"], STEEL, STEEL.middle, "x", Bodies(None, 0.3, radius))


def test_no_code_is_told_to_take_what_it_refuses() -> None:
    """LIGGGHTS takes no restitution of 0.05; LAMMPS goes on until nothing swings."""
    hard = replace(STEEL, e=(0.18,) * 5)
    with pytest.raises(Unreachable, match=r"returns from 0\.21"):
        of(CODES["liggghts"], hard)
    made = of(CODES["lammps"], replace(STEEL, e=(0.145,) * 5))
    assert made.returned.e == pytest.approx(0.145, abs=1e-9)


def test_a_formula_that_loses_nothing_is_unreachable() -> None:
    code = CODES["drake"]
    lossless = replace(code, law=ForceLaw("a spring", code.stiffness * x), damping_ends=(1e-3, 1e-2))
    with pytest.raises(
        Unreachable, match=r"the formula returns from 1\.0000 to 1\.0000 at 4\.089 m/s, not 0\.4790"
    ):
        of(lossless)


# --- the identified law -----------------------------------------------------------------------------------
def test_the_identified_law_returns_every_test() -> None:
    law = STEEL.law()
    for test in STEEL.tests:
        found = simulate(law, {}, STEEL.mass, test.speed)
        assert found.e == pytest.approx(test.e, abs=1e-9)
        assert found.x_m == pytest.approx(test.x_m, rel=1e-9)
        assert found.F_m == pytest.approx(STEEL.C * test.x_m**STEEL.alpha, rel=1e-9)
        assert found.x_p == pytest.approx(test.x_m * (1 - 2.5 / (STEEL.alpha + 1) * test.e**2), rel=1e-9)


def test_between_the_tests_it_goes_on_without_a_jump() -> None:
    law = STEEL.law()
    found = [simulate(law, {}, STEEL.mass, speed).e for speed in (2.0, 2.334, 3.5, 4.089, 6.0)]
    assert found[0] == pytest.approx(found[1], abs=1e-9)
    assert 0.479 < found[2] < 0.512
    assert found[4] == pytest.approx(0.453, abs=1e-9)


PLACES = [(x_m * share, x_m) for x_m in (1e-5, 3.6e-5, 5e-5, 9e-5) for share in (0.0, 0.5, 0.8, 0.9, 1.0)]


def by_law(place: float, greatest: float) -> float:
    forces = STEEL.law().at(STEEL.mass, 1.0, {})
    if place >= greatest:
        return forces.loading(place, 0.0, place)
    return forces.unloading(place, 0.0, greatest) if place > forces.imprint(greatest) else 0.0


def test_the_law_in_python() -> None:
    space: dict[str, Callable[[float, float], float]] = {}
    exec(SOURCES["python"].printed(identified(STEEL, STEEL.middle)), space)
    for place in PLACES:
        assert space["contact_force"](*place) == pytest.approx(by_law(*place), rel=1e-14)


def test_the_law_in_c(require: Callable[..., str], tmp_path: Path) -> None:
    compiler = require("cc", "gcc")
    calls = "".join(
        f'    printf("%.17g\\n", contact_force({place!r}, {greatest!r}));\n' for place, greatest in PLACES
    )
    source = SOURCES["c"].printed(identified(STEEL, STEEL.middle))
    program = f"{source}\n#include <stdio.h>\nint main(void)\n{{\n{calls}    return 0;\n}}\n"
    (tmp_path / "law.c").write_text(program)
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]
    subprocess.run([compiler, *flags, "law.c", "-lm", "-o", "law"], cwd=tmp_path, check=True)
    told = subprocess.run([tmp_path / "law"], capture_output=True, text=True, check=True).stdout
    for place, line in zip(PLACES, told.split(), strict=True):
        assert float(line) == pytest.approx(by_law(*place), rel=1e-14)


def test_the_law_as_a_table_has_the_loop_of_the_measured_loss() -> None:
    first, *lines = SOURCES["table"].printed(identified(STEEL, STEEL.middle)).splitlines()
    assert first == "phase,x [m],F [N]"
    rows = [
        (phase, float(place), float(force)) for phase, place, force in (line.split(",") for line in lines)
    ]
    assert rows[100][1:] == pytest.approx(rows[101][1:], rel=1e-12)  # both branches meet
    assert rows[-1][2] == 0
    area = sum((b[1] - a[1]) * (a[2] + b[2]) / 2 for a, b in pairwise(rows))
    assert area == pytest.approx((1 - 0.479**2) * STEEL.mass * 4.089**2 / 2, rel=1e-4)


# --- impacts in the same place ------------------------------------------------------------------------------
def one_after_another(e: float, alpha: float, impacts: int) -> list[tuple[float, float]]:
    """Restitution and greatest approach of impacts in one place, over that of the first, under law (3).

    Each is loaded along the restitution of those before, which takes e^2 of the work y of the curve so far,
    over the energy of an impact; what is left goes on along the curve: 1 = e^2 y + (y' - y).
    """
    found, share = [], 0.0
    for _ in range(impacts):
        share = share * (1 - e**2) + 1
        found.append((e * math.sqrt(share), share ** (1 / (alpha + 1))))
    return found


def test_impacts_in_the_same_place_are_as_the_energies_say() -> None:
    """Under law (3) with one share of the imprint; the fifth returns nearly all."""
    model = law_of(POWER_LAW)
    given = {"C": STEEL.C, "alpha": STEEL.alpha, "beta": 1.5, "e": 0.479}
    constants = {symbol: given[str(symbol)] for symbol in model.constants}
    found = repeated(model, constants, STEEL.mass, 4.089, 5)
    assert [each.failure for each in found] == [""] * 5
    for each, (e, ratio) in zip(found, one_after_another(0.479, STEEL.alpha, 5), strict=True):
        assert each.e == pytest.approx(e, rel=1e-9)
        assert each.x_m == pytest.approx(found[0].x_m * ratio, rel=1e-9)
        assert each.F_m == pytest.approx(STEEL.C * each.x_m**STEEL.alpha, rel=1e-9)
        assert each.loss == pytest.approx((1 - each.e**2) * STEEL.mass * 4.089**2 / 2, rel=1e-9)
    slow = simulate(model, constants, STEEL.mass, 0.9 * found[-1].e * 4.089, found[-1].x_m)
    assert slow.e == pytest.approx(1, abs=1e-9)  # it goes no deeper, and so loses nothing
    assert slow.x_p == pytest.approx(found[-1].x_p, rel=1e-12)
    assert found[-1].x_p < slow.x_m < found[-1].x_m


def test_a_program_with_the_law_goes_on_in_the_same_crater() -> None:
    """The function in Python with its x_max, in small steps, for two impacts."""
    space: dict[str, Callable[[float, float], float]] = {}
    exec(SOURCES["python"].printed(identified(STEEL, STEEL.middle)), space)
    expected = repeated(STEEL.law(), {}, STEEL.mass, 4.089, 2)
    x_max, start, step = 0.0, 0.0, 2e-9
    for each in expected:
        place, rate = start, 4.089
        while rate > 0 or space["contact_force"](place, x_max) > 0:
            rate -= step / 2 * space["contact_force"](place, x_max) / STEEL.mass
            place += step * rate
            x_max = max(x_max, place)
            rate -= step / 2 * space["contact_force"](place, x_max) / STEEL.mass
        start = place
        assert (-rate / 4.089, x_max) == pytest.approx((each.e, each.x_m), rel=1e-5)


def test_the_course_of_impacts_keeps_their_energy(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["card", "paper", "--for", "table", "--course", "2"]) == 0
    head, *lines = capsys.readouterr().out.splitlines()
    assert head == "impact,t [s],x [m],v [m/s],F [N],kinetic energy [J],work of the force [J],failure"
    rows = [[float(cell) for cell in line.split(",")[:-1]] for line in lines]
    for row in rows:
        assert row[5] + row[6] == pytest.approx(STEEL.mass * 4.089**2 / 2, rel=1e-9)
    first, second = ([row for row in rows if row[0] == number] for number in (1, 2))
    assert first[0][1:5] == [0, 0, 4.089, 0]
    assert first[-1][2:4] == pytest.approx([second[0][2], -0.479 * 4.089], rel=1e-8)
    assert second[-1][3] < first[-1][3]
    impacts = [Impact(failure="none", status=Status.NOROOT)]
    assert course_as_csv(impacts, 1.0).splitlines()[1] == f'1,{"#NOROOT!," * 6}"none"'


# --- the command ------------------------------------------------------------------------------------------
def test_the_card_of_the_paper_for_programs(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["card", "paper", "--for", "drake", "--format", "json", "--speed", "4.993"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["wanted"]["e"] == 0.453
    assert told["returned"]["e"] == pytest.approx(0.453, abs=1e-9)
    assert [row["speed"] for row in told["rows"]] == list(STEEL.v)
    # c = d v is what the family wants for .453
    assert told["typed"][1]["value"] * 4.993 == pytest.approx(number_for(0.453), rel=1e-8)


def test_a_sweep_tells_every_impact(capsys: pytest.CaptureFixture[str]) -> None:
    """The measured ends of the identified law come back; of a card the speed that it is for."""
    assert main(["card", "paper", "--for", "table", "--sweep", "5"]) == 0
    head, *lines = capsys.readouterr().out.splitlines()
    rows = [[float(cell or "nan") for cell in line.split(",")] for line in lines]
    assert head.startswith("v [m/s],e [1],x_m [m],F_m [N],x_p [m],duration [s]")
    assert [len(line.split(",")[0]) for line in lines] == [5, 7, 6, 7, 5]  # as typed, and halves between
    assert [row[0] for row in rows] == pytest.approx([2.334, 2.99875, 3.6635, 4.32825, 4.993])
    assert (rows[0][1], rows[-1][1]) == pytest.approx((0.53, 0.453), abs=1e-9)
    for speed, e, *_, loss, failure in rows:
        assert loss == pytest.approx((1 - e**2) * STEEL.mass * speed**2 / 2, rel=1e-9)
        assert math.isnan(failure)
    assert main(["card", "paper", "--for", "simbody", "--sweep", "3", "--speed", "3.6635 m/s"]) == 0
    _, slow, middle, fast = capsys.readouterr().out.splitlines()
    drop = STEEL.at(3.6635)
    assert drop is not None
    assert float(middle.split(",")[1]) == pytest.approx(drop.e, abs=1e-8)
    assert float(slow.split(",")[1]) > drop.e > float(fast.split(",")[1])


def test_an_impact_that_there_is_not_is_a_line_of_a_sweep() -> None:
    law = ForceLaw("a dashpot", x + 100.0 * rate, pulls=True)
    said: list[str] = []
    found = sweep(law, {}, 1.0, [1.0, 2.0], said.append)
    assert said == ["simulating 0 of 2 impacts", "simulating 1 of 2 impacts"]
    (_, first, _) = as_csv([1.0, 2.0], found).splitlines()
    assert first == f'1,{"#NOROOT!," * 7}"the bodies do not part: the damping is as strong as the spring"'


def test_impacts_that_do_not_part_are_codes_in_a_card() -> None:
    """A dashpot that grows as the fourth power of the impact speed holds the faster balls."""
    spring, dashpot = Symbol("k", positive=True), Symbol("d", positive=True)
    law = ForceLaw("a dashpot", spring * x + dashpot * v_0**4 * rate, pulls=True)
    drop = STEEL.tests[0]
    given = {spring: 1e7, dashpot: 1.5 * math.sqrt(1e7 * STEEL.mass) / STEEL.tests[2].speed ** 4}
    typed = tuple(Typed(str(symbol), symbol, "SI", "", Float(value)) for symbol, value in given.items())
    made = card(
        ContactFormula(name="d", title="", sources=(), law=law, typed=typed), STEEL, drop, "", Bodies()
    )
    *told, last = card_words.rows(made)
    back = math.exp(-math.pi * 0.75 / math.sqrt(1 - 0.75**2))  # of a linear spring that may pull
    assert [line[2] for line in told[3:]] == [f"{back:.4f}", "#NOROOT!"]
    assert last[2] == "#NOROOT!"
    assert made.notes[0] == f"#NOROOT! in the table: {STAY}"


def test_the_list_of_codes_needs_no_folder(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["card", "--for", "list"]) == 0
    told = capsys.readouterr().out
    assert [line.split()[0] for line in told.splitlines()] == [*CODES, *SOURCES]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--model", "hertz"], "LS614]: --model says nothing without a code"),
        (["--for", "lammps", "--E", "210e9"], "LS211]: E has no unit: '210e9'"),
        (["--for", "lammps", "--E", "-5 GPa"], "LS406]: E is out of range: '-5'"),
        (["--for", "mujocco"], "LS604]: unknown code 'mujocco'"),
        (
            ["--for", "drake", "--E", "210 GPa"],
            "LS614]: --E says nothing to drake: its stiffness is not Hertz's",
        ),
        (["--for", "simbody", "--nu", "0.3"], "LS614]: --nu says nothing to simbody here"),
        (["--for", "c", "--speed", "3"], "LS614]: --speed says nothing to --for c"),
        (
            ["--for", "drake", "--speed", "9"],
            "LS614]: --speed 9 m/s is not among the measured speeds, 2.334 to 4.993",
        ),
        (["--for", "c", "--sweep", "3"], "LS614]: --sweep says nothing to --for c"),
        (["--for", "drake", "--sweep", "3", "--format", "json"], "LS614]: --format json says nothing to"),
        (["--for", "drake", "--speed", "3 mm"], "error[LS"),
        (["--for", "chrono", "--nu", "0.51"], "error[LS"),
        (["--for", "chrono", "--R", "-1 mm"], "error[LS"),
    ],
)
def test_what_does_not_fit_is_told(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["card", "paper", *words]) == 2
    assert said in capsys.readouterr().err


def test_a_folder_without_impacts(capsys: pytest.CaptureFixture[str]) -> None:
    folder = Path(__file__).parent.parent / "data" / "kepler"
    assert main(["card", os.fspath(folder), "--for", "drake"]) == 2
    assert (
        "has no impacts that a simulation could be held to: it has no v in m/s and no m_red in kg"
        in capsys.readouterr().err
    )


DATA = Path(__file__).parent.parent / "data" / "soft_steel"
FAULTS = {
    "interchanged depths": (("0.530,23.5", "0.530,51.03"), ("0.453,51.03", "0.453,23.5")),
    "a restitution of one": (("0.479", "1"),),
}


def changed(folder: Path, changes: tuple[tuple[str, str], ...], left_out: str = "") -> str:
    """The campaign of the paper with other digits, and a test that somebody left out."""
    shutil.copytree(DATA, folder)
    toml = (folder / "report.toml").read_text()
    (folder / "report.toml").write_text(toml[: toml.index("[published]")])
    table = folder / "measurements.csv"
    text = table.read_text()
    for before, after in changes:
        assert before in text
        text = text.replace(before, after, 1)
    if left_out:
        head, first, *others = text.splitlines()
        text = "\n".join([f"{head},left out", f"{first},{left_out}", *(f"{line}," for line in others), ""])
    table.write_text(text)
    return os.fspath(folder)


@pytest.mark.parametrize("fault", FAULTS)
def test_a_card_tells_what_check_finds_in_the_data(
    fault: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """On the card, on the other stream with the place, and by the exit code."""
    folder = changed(tmp_path / "own", FAULTS[fault])
    assert main(["card", folder, "--for", "mujoco"]) == 1
    told = capsys.readouterr()
    found = [line for line in told.err.splitlines() if line.startswith("finding: ")]
    assert found
    assert "\nfinding: alpha: " in told.out
    assert folder not in told.out
    assert main(["card", folder, "--for", "mujoco", "--format", "json"]) == 1
    oddities = json.loads(capsys.readouterr().out)["oddities"]
    assert [odd["word"] for odd in oddities].count("finding") == len(found)
    assert main(["card", folder, "--for", "mujoco", "--format", "markdown"]) == 1
    assert "\nfinding: alpha: " in capsys.readouterr().out


def test_a_card_of_the_paper_has_the_warning_of_its_fit(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["card", "paper", "--for", "mujoco"]) == 0
    told = capsys.readouterr()
    assert "\nwarning: chi2_eiv = 55 on 3 degrees of freedom" in told.out
    assert "warning" not in told.err


@pytest.mark.parametrize("code", ["mujoco", "python"])
def test_tests_that_are_not_in_a_card_are_named(
    code: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """By whom they are left out: by the card, which no damping can return e = 1, or by the author."""
    folder = changed(tmp_path / "own", FAULTS["a restitution of one"], left_out="bounced twice")
    assert main(["card", folder, "--for", code]) == 1
    told = capsys.readouterr().out
    assert "left out: test 1, bounced twice" in told
    assert "test 3 is left out here: e = 1, nothing is lost" in told


def test_tests_at_one_speed_are_told_to_be_taken_together(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = changed(tmp_path / "own", (("2,2.940,0.512", "2,2.334,0.512"),))
    main(["card", folder, "--for", "mujoco"])
    told = capsys.readouterr().out
    assert "test 1 and test 2 are at one speed, 2.334 m/s: restitution and imprint are their means" in told
    assert re.search(r"^2\.334 +0\.5210 ", told, re.MULTILINE)
    main(["card", "paper", "--for", "mujoco"])
    assert "at one speed" not in capsys.readouterr().out


def test_a_card_tells_which_curve_it_took(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = changed(tmp_path / "own", FAULTS["interchanged depths"])
    assert main(["card", folder, "--for", "mujoco"]) == 1
    assert "the loading curve is that of alpha_log: alpha_eiv has no value" in capsys.readouterr().out
    assert main(["card", "paper", "--for", "mujoco"]) == 0
    assert "curve is that of alpha" not in capsys.readouterr().out


@pytest.mark.parametrize("code", SOURCES)
def test_what_is_found_is_a_comment_of_the_law_which_nothing_ends(
    code: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = changed(tmp_path / "own", FAULTS["interchanged depths"], left_out="*/ /*/ \\")
    assert main(["card", folder, "--for", code]) == 1
    source = SOURCES[code]
    lines = capsys.readouterr().out.splitlines()
    remarks = [
        line for line in lines if line.startswith((f"{source.begins}finding", f"{source.begins}left out"))
    ]
    assert len(remarks) > 1
    for line in remarks:
        inside = line.removeprefix(source.begins).removesuffix(source.ends)
        assert line == source.begins + inside + source.ends
        assert code != "c" or not ("*/" in inside or "/*" in inside)


def test_a_campaign_of_one_s_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A ball of which only the mass is known: what wants its radius says so, and takes it."""
    folder = tmp_path / "own"
    shutil.copytree(Path(__file__).parent.parent / "data" / "worked_example", folder)
    assert main(["card", os.fspath(folder), "--for", "liggghts"]) == 2
    assert "liggghts wants the radius of the ball, which the folder does not say" in capsys.readouterr().err
    assert main(["card", os.fspath(folder), "--for", "liggghts", "--R", "8 mm"]) == 0
    assert "coefficientRestitution" in capsys.readouterr().out
