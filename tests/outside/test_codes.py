"""Cards run in the simulation codes that they are for: what these return tends to what the cards say."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from loopsheet.report.cli import main

SCRIPT = Path(__file__).parents[2] / "benchmarks" / "card_in_code.py"
ROW = re.compile(r" *([\d.]+) m/s +(\d+) steps +e (-?[\d.]+), card ([\d.]+) +([\de.-]+) m")
pytestmark = pytest.mark.codes

CODES = ("drake", "exudyn", "lammps", "liggghts", "mujoco", "simbody", "yade")
"""Not exudyn-damped: Exudyn's solver gives up there where a step just meets the surface."""
PROGRAMS = ("liggghts", "yade")
"""What is no package of Python but a program, which may be missing."""
DIGITS = 2e-8
"""To which a card is solved, and what it is typed with."""

Run = Callable[[dict[str, object]], list[tuple[float, ...]]]


@pytest.fixture(scope="module")
def run(environment: Callable[..., Path], require: Callable[..., str]) -> Run:
    """What a code returns of a card: speed, steps, restitution, that of the card, and depth."""

    def run(card: dict[str, object]) -> list[tuple[float, ...]]:
        if card["name"] in PROGRAMS:
            require(str(card["name"]))
        python = sys.executable if card["name"] in PROGRAMS else environment("codes")
        done = subprocess.run(
            [python, SCRIPT], input=json.dumps(card), capture_output=True, text=True, check=True, timeout=300
        )
        return [tuple(map(float, found.groups())) for found in ROW.finditer(done.stdout)]

    return run


def card_for(code: str, capsys: pytest.CaptureFixture[str]) -> dict[str, object]:
    assert main(["card", "paper", "--for", code, "--format", "json"]) == 0
    card: dict[str, object] = json.loads(capsys.readouterr().out)
    return card


def within(fine: float, coarse: float, exact: float) -> bool:
    """Whether no more is left than what the last refinement took off: what falls with the step does that."""
    return abs(fine - exact) <= abs(coarse - fine) + DIGITS * exact


@pytest.mark.parametrize("code", CODES)
def test_what_a_code_returns_tends_to_its_card(
    code: str, run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    card = card_for(code, capsys)
    rows = run(card)
    assert len(rows) == 10
    returned = card["returned"]
    assert isinstance(returned, dict)
    for (speed, _, coarse, by_card, deep), (_, _, fine, _, deeper) in zip(rows[::2], rows[1::2], strict=True):
        assert within(fine, coarse, by_card)
        if speed == card["speed"]:
            assert within(deeper, deep, returned["imprint"] or returned["approach"])


def test_another_card_is_noticed(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    """One whose stiffness is typed as it is stored, to the power 2/3."""
    card = card_for("simbody", capsys)
    typed = card["typed"]
    assert isinstance(typed, list)
    typed[0]["value"] **= 2 / 3
    (_, _, coarse, by_card, _), (_, _, fine, _, _), *_ = run(card)
    assert not within(fine, coarse, by_card)
