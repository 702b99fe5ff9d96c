"""Cards of contact models: their laws with the numbers of a report, as a card and as source."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import loopsheet
from loopsheet.derivations.contact import johnson
from loopsheet.derivations.contact.model import ContactModel
from loopsheet.derivations.contact.models import LEDGER, MODELS
from loopsheet.report.cards import contacts_of, drops_of
from loopsheet.report.cli import main
from loopsheet.report.impacts.card import Bodies, Unreachable, solved
from loopsheet.report.impacts.contact import formula
from loopsheet.report.impacts.simulation import simulate
from loopsheet.report.impacts.source import SOURCES, modelled
from loopsheet.report.result.card import Card
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study

SHIPPED = Path(loopsheet.__file__).parent / "data" / "contact_models"


@cache
def shipped_cards() -> tuple[Report, dict[str, Card]]:
    shipped = Study(SHIPPED).computed
    return shipped, {card.name: card for card in shipped.cards().made}


def test_the_shipped_folder_has_cards_of_codes_and_of_all_models() -> None:
    _, cards = shipped_cards()
    assert [*cards] == ["lammps", "exudyn", *(model.name for model in MODELS)]
    assert [name for name, card in cards.items() if card.solved] == ["lammps", "exudyn"]


def of_test(values: Any, row: int) -> float:
    return float(values[row if values.size > 1 else 0])


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_a_card_of_a_model_returns_what_the_report_says_of_it(model: ContactModel) -> None:
    """Simulated from the numbers of the card at every measured speed, beside the cells of the sheet."""
    shipped, cards = shipped_cards()
    card, value = cards[model.name], shipped.values.value
    middle = 2  # the test whose restitution is told
    for row, told in enumerate(card.rows):
        expected = {"e": value["e"][middle] if model.told else of_test(value[model.predicts["e"].name], row)}
        if not model.told or row == middle:
            expected["x_p"] = of_test(value[model.predicts["x_p"].name], row)
        found = {"e": told.by_card, "x_p": told.imprint_by_card}
        for name, wanted in expected.items():
            assert found[name] == pytest.approx(wanted, rel=1e-8, abs=1e-15), (name, row)
    typed = {one.word: one.value for one in card.typed}
    scalars = {"e": value["e"][middle], "alpha": value["alpha_eiv"][0], "C": value["C_eiv"][0]}
    assert typed == {name: scalars[name] if name in scalars else value[name][0] for name in typed}
    assert (typed.keys() >= {"e"}) == model.told


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_the_law_of_a_model_in_python_and_in_c(
    model: ContactModel, require: Callable[..., str], tmp_path: Path
) -> None:
    shipped, _ = shipped_cards()
    drops, formula = drops_of(shipped), contacts_of(shipped)[model.name]
    written = modelled(formula, drops, drops.middle)
    forces = written.law.at(drops.mass, drops.middle.speed, {})
    places = [(x_m * share, x_m) for x_m in (2e-6, 3e-5, 9e-5) for share in (0.0, 0.1, 0.5, 0.8, 0.95, 1.0)]

    def by_law(place: float, greatest: float) -> float:
        if place <= 0:
            return 0.0
        if place >= greatest:
            return forces.loading(place, 0.0, place)
        return forces.unloading(place, 0.0, greatest) if place > forces.imprint(greatest) else 0.0

    expected = [by_law(*place) for place in places]
    assert 0 < sum(force == 0 for force in expected) < len(expected) - 6
    space: dict[str, Callable[[float, float], float]] = {}
    exec(SOURCES["python"].printed(written), space)
    assert [space["contact_force"](*place) for place in places] == pytest.approx(expected, rel=1e-12)
    calls = "".join(f'    printf("%.17g\\n", contact_force({a!r}, {b!r}));\n' for a, b in places)
    program = (
        f"{SOURCES['c'].printed(written)}\n#include <stdio.h>\nint main(void)\n{{\n{calls}    return 0;\n}}\n"
    )
    (tmp_path / "law.c").write_text(program, encoding="utf-8")
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]
    subprocess.run([require("cc", "gcc"), *flags, "law.c", "-lm", "-o", "law"], cwd=tmp_path, check=True)
    told = subprocess.run([tmp_path / "law"], capture_output=True, text=True, check=True).stdout
    assert [*map(float, told.split())] == pytest.approx(expected, rel=1e-12)


def test_a_model_without_its_constant_has_no_card() -> None:
    shipped, _ = shipped_cards()
    drops = drops_of(shipped)
    lacking = formula(johnson.JOHNSON, {johnson.p_d: float("nan")}, LEDGER.vocabulary)
    with pytest.raises(Unreachable, match="E_1 has no value"):
        solved(lacking, drops, drops.middle, Bodies(None, 0.3, drops.radius))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--for", "jonson"], "LS604]: unknown code 'jonson'"),
        (["--for", "c", "--model", "jonson"], "LS604]: unknown model 'jonson'"),
        (["--for", "lammps", "--model", "johnson"], "LS614]: --model says nothing to --for lammps"),
        (["--for", "johnson", "--E", "210 GPa"], "LS614]: --E says nothing to johnson here"),
        (["--for", "johnson", "--nu", "0.3"], "LS614]: --nu says nothing to johnson here"),
        (["--for", "c", "--model", "johnson", "--speed", "9 m/s"], "LS614]: --speed 9 m/s is not among"),
    ],
)
def test_what_does_not_fit_a_model_is_told(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["card", str(SHIPPED), *words]) == 2
    assert said in capsys.readouterr().err


def test_a_folder_without_models_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["card", "paper", "--for", "c", "--model", "johnson"]) == 2
    assert "none in this folder" in capsys.readouterr().err


def test_codes_have_poisson_s_ratio_of_the_ball(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "own"
    shutil.copytree(SHIPPED, folder)
    toml = (folder / "report.toml").read_text(encoding="utf-8")
    assert toml.count('nu_1 = "0.30') == 1
    (folder / "report.toml").write_text(toml.replace('nu_1 = "0.30', 'nu_1 = "0.25'), encoding="utf-8")
    assert main(["card", str(folder), "--for", "lammps"]) in (0, 1)
    assert "Poisson's ratio is that of the ball: 0.25" in capsys.readouterr().out


def test_codes_have_the_effective_radius_of_two_balls(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "own"
    shutil.copytree(SHIPPED, folder)
    with (folder / "report.toml").open("r+", encoding="utf-8") as file:
        toml = file.read().replace("[parameters]", '[parameters]\ntarget_diameter = "12.7 mm"', 1)
        file.seek(0)
        file.write(toml)
    assert main(["card", str(folder), "--for", "lammps"]) in (0, 1)
    assert "the effective radius is that of two balls, 0.003175 m" in capsys.readouterr().out


ALUMINIUM = """title = "Aluminium plate, 20 mm ball"
workbook = "contact_models"
[parameters]
ball_diameter = "20.00 mm"
ball_density = "7830 kg/m^3"
E_1 = "208 GPa"
nu_1 = "0.29"
E_2 = "70 GPa"
nu_2 = "0.33"
sigma_Y = "280 MPa"
beta = "1.5"
[measurements]
file = "measurements.csv"
"""
DROPS = """test,v [m/s],e [1],x_p [um]
1,2.204,0.532,46.2
2,2.226,0.530,46.7
3,3.128,0.499,66.4
4,3.121,0.500,66.4
5,3.951,0.480,83.1
6,4.842,0.460,100.8
"""


def test_a_way_back_ends_at_the_imprint_however_that_is_rounded(tmp_path: Path) -> None:
    """Where the law reckons it a rounding deeper than the sheet does, the power has a negative base there."""
    (tmp_path / "report.toml").write_text(ALUMINIUM, encoding="utf-8")
    (tmp_path / "measurements.csv").write_text(DROPS, encoding="utf-8")
    report = Study(tmp_path).computed
    contact, drops = contacts_of(report)["johnson"], drops_of(report)
    law = modelled(contact, drops, drops.middle).law
    for speed in [2.2 + 0.1 * n for n in range(27)] + [3.121, 3.128]:
        assert not simulate(law, {}, drops.mass, speed).failure, speed
