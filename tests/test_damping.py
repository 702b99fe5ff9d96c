"""The damping family: proved, wrong variants refuted, and its closed forms beside simulated impacts."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import mpmath
import numpy as np
import pytest
from helpers import number_for
from sympy import Expr, Piecewise, Rational, log

from loopsheet.derivations.contact import damping as model
from loopsheet.derivations.contact.damping import (
    LEDGER,
    MEMBERS,
    K,
    c,
    e,
    e_o,
    g,
    m_red,
    n,
    u_F,
    v_0,
    x_m,
)
from loopsheet.derivations.equation import Derivation, Equation
from loopsheet.derivations.proof import check_step, prove
from loopsheet.derivations.proved import ProofStatus
from loopsheet.report.cli import main
from loopsheet.report.impacts.code import R
from loopsheet.report.impacts.codes import CODES, stiffness
from loopsheet.report.impacts.codes import k as K_EXUDYN
from loopsheet.report.impacts.damping import _value, _zero, number_by, returned
from loopsheet.report.impacts.law import ForceLaw, rate, x
from loopsheet.report.impacts.simulation import simulate

FAMILY = ForceLaw("the family", model.family.value)


def test_all_of_it_is_proved() -> None:
    found = prove(LEDGER)
    passed = (ProofStatus.PROVED, ProofStatus.ASSUMPTION, ProofStatus.DEFINITION)
    assert [proof.equation.label for proof in found if proof.status not in passed] == []
    claims = [entry.claim for entry in LEDGER.entries if isinstance(entry, Derivation)]
    assert [proof.equation for proof in found if proof.status is ProofStatus.PROVED] == claims


@pytest.mark.parametrize(("word", "claim"), [("damping", "(L106) proved"), ("damped-loop", "(L214) proved")])
def test_the_command_proves_what_no_workbook_computes(
    word: str, claim: str, capsys: pytest.CaptureFixture[str], tmp_path: Path, chdir: Callable[[Path], None]
) -> None:
    assert main(["prove", word]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith(claim) for line in lines)
    assert main(["prove", claim.partition(" ")[0], word]) == 0
    assert "agree within" in capsys.readouterr().out
    assert main(["prove", "(11)", word]) == 2
    assert "unknown equation '(11)'" in capsys.readouterr().err
    (tmp_path / word).mkdir()
    (tmp_path / word / "report.toml").write_text("", encoding="utf-8")
    chdir(tmp_path)
    assert main(["prove", word]) == 2  # a report folder of that name is meant
    assert f"{word}/report.toml" in capsys.readouterr().err


def wrong() -> Iterator[tuple[Equation, Expr]]:
    """A claim and what a slip of the pen makes of its last side."""
    energy = m_red * v_0**2 / c**2
    yield from ((model.work_compression, energy * value) for value in (c + log(1 + c), -c, 1 - log(1 + c)))
    yield from ((model.work_rebound, energy * value) for value in (g + 1 - log(g), g - 1 + log(g), 1 - g))
    power = K * x_m ** (n + 1)
    yield from ((model.power, value) for value in (power, power / n, power / (n + 2)))
    yield from ((model.approach, model.approach.value * factor) for factor in (2, 1 + c, n))
    yield from (
        (model.returned, value)
        for value in (
            log((1 + c) / (1 + c * e_o)),
            log((1 - c * e_o) * (1 + c)),
            log((1 + c) / (1 - e_o * c) ** 2),
        )
    )
    yield from ((model.peak_approach, model.peak_approach.value * factor) for factor in (2, u_F, c))
    yield from ((model.peak_speed, model.peak_speed.value * factor) for factor in (2, c, 1 + u_F))
    yield from (
        (MEMBERS["lankarani_nikravesh"], value)
        for value in (3 * (1 - e) / 4, (1 - e**2) / 2, 3 * (1 + e**2) / 4)
    )
    yield from (
        (MEMBERS["hu_guo"], value) for value in (3 * (1 - e) / 2, 3 * (1 - e**2) / (2 * e), (1 - e) / e)
    )
    flores = MEMBERS["flores"].value
    yield from ((MEMBERS["flores"], flores * factor) for factor in (e, n + 1, Rational(8, 5)))


@pytest.mark.parametrize(("claim", "value"), [*wrong()], ids=lambda each: getattr(each, "label", ""))
def test_a_wrong_variant_is_refuted(claim: Equation, value: Expr) -> None:
    derivation = LEDGER.derivation(claim)
    assert derivation is not None
    step = derivation.steps[-1]
    other = replace(claim, members=(claim.members[0], value))
    found = check_step(replace(step, claim=other), LEDGER.vocabulary)
    assert found.status is ProofStatus.REFUTED
    assert found.counterexample


# --- numbers: published, and as they come from both ways --------------------------------------------------
PUBLISHED = {  # what is returned where .53 is prescribed
    "lankarani_nikravesh": 0.7337,
    "hunt_crossley": 0.6770,
    "lee_wang": 0.8090,
    "hu_guo": 0.5198,
}


@pytest.mark.parametrize("author", PUBLISHED)
def test_what_is_returned_for_a_prescribed_restitution(author: str) -> None:
    assert round(returned(number_by(author, 0.53, 1.5)), 4) == PUBLISHED[author]


def test_flores_is_printed_with_a_rounded_number() -> None:
    assert round(returned(8 * (1 - 0.53) / (5 * 0.53)), 4) == 0.5026
    assert round(returned(number_by("flores", 0.53, 1.5)), 4) == 0.5023
    assert round(number_by("flores", 0.5, 1.5), 4) == 1.6018
    assert round(number_by("flores", 0.5, 1.3), 3) == 1.562


EXUDYN = {
    "carvalho_martins": {0.9: 9.000168963897542, 0.8: 8.000159389915021, 0.5: 5.001975126052718},
    "gonthier": {0.3: 3.0423710530759065, 0.1: 1.0098986986792768, 0.025: 0.25015634771732226},
    "hunt_crossley": {
        0.9: 9.090298887177969, 0.8: 8.32903493005253, 0.5: 6.629838391096419, 0.3: 5.813176318310211,
        0.1: 5.158573889338283,
    },
}  # fmt: skip
"""Speeds of rebound after 10 m/s with steps of 2e-5 s, from the end of Exudyn's TestModels,
contactSphereSphereTest.py (github.com/jgerstmayr/EXUDYN, commit 7de98d3): a linear spring with the damping of
Hunt and Crossley, and with its formula of two parts."""
COARSER = 5.003239017129689
"""The same for .5, with steps of 5e-5 s."""


def test_what_exudyn_publishes_comes_out_to_its_time_step() -> None:
    """No rebound is farther off than the coarser step is from the finer one."""
    at_step = EXUDYN["carvalho_martins"][0.5]
    law, typed = CODES["exudyn-damped"].law, {K_EXUDYN: 1e6, n: 1.0}
    for author, rebounds in EXUDYN.items():
        for restitution, speed in rebounds.items():
            found = [returned(number_by(author, restitution, 1.0))]
            if author != "hunt_crossley":
                found.append(simulate(law, {**typed, e: restitution}, 1.6, 10.0).e)
            assert 10 * np.array(found) == pytest.approx(speed, abs=COARSER - at_step)
    assert 10 * returned(number_by("gonthier", 0.5, 1.0)) != pytest.approx(at_step, abs=COARSER - at_step)


def test_the_force_that_simbody_s_own_test_expects() -> None:
    """TestHuntCrossleyForce.cpp, commit 48fbaf3, for two surfaces alike."""
    forces = CODES["simbody"].law.at(1.0, 1.0, {R: 0.8, stiffness: 2.0, c: 0.5})
    for depth in (0.1, 0.3, 0.7):
        for speed in (-1.0, -0.3, 0.0, 0.7):
            k = 2 ** (2 / 3) / 2
            expected = 4 / 3 * k * depth * math.sqrt(0.8 * k * depth) * (1 + 1.5 * 0.5 * speed)
            assert forces.loading(depth, speed, depth) == pytest.approx(expected, rel=1e-14)


MATERIALS = [(1e9, 1.3, 0.0084, 4.0), (3e4, 1.0, 12.0, 0.2), (2e10, 1.5, 1e-6, 30.0)]
"""Stiffness, exponent, mass and speed: a steel ball, a buffer, a grain."""


def closed_form(K: float, n: float, c: float, mass: float, speed: float) -> tuple[float, float, float]:
    """Restitution, greatest approach and greatest force of the family, by (L105) to (L108)."""
    given = {"K": K, "n": n, "c": c, "m_red": mass, "v_0": speed}
    (residual,) = model.peak_speed.residuals
    u = _zero(lambda u: _value(residual, u_F=u, **given), 0.0, 1.0)
    peak = float(_value(model.peak_approach.value, u_F=u, **given) ** (1 / (mpmath.mpf(n) + 1)))
    force = _value(model.family.value, x=peak, xdot=u * speed, **given)
    return returned(c), float(_value(model.approach.value, **given)), float(force)


@pytest.mark.parametrize(("stiffness", "exponent", "mass", "speed"), MATERIALS)
@pytest.mark.parametrize("author", ["exact", *MEMBERS])
def test_a_simulated_impact_is_as_the_closed_forms_say(
    author: str, stiffness: float, exponent: float, mass: float, speed: float
) -> None:
    damping = number_for(0.45) if author == "exact" else number_by(author, 0.45, exponent)
    returns, deepest, strongest = closed_form(stiffness, exponent, damping, mass, speed)
    found = simulate(FAMILY, {K: stiffness, n: exponent, c: damping}, mass, speed)
    assert not found.failure
    assert found.e == pytest.approx(returns, rel=1e-9, abs=0)
    assert found.x_m == pytest.approx(deepest, rel=1e-9, abs=0)
    assert found.F_m == pytest.approx(strongest, rel=1e-9, abs=0)
    assert found.loss == pytest.approx((1 - returns**2) * mass * speed**2 / 2, rel=1e-9, abs=0)
    assert found.e**2 + 2 * found.loss / (mass * speed**2) == pytest.approx(1, rel=1e-10, abs=0)
    if author == "exact":
        assert found.e == pytest.approx(0.45, rel=1e-9, abs=0)


def test_another_member_is_not_taken_for_it() -> None:
    """The bound above is one that a wrong damping fails."""
    damping = number_by("hu_guo", 0.45, 1.5)
    found = simulate(FAMILY, {K: 1e9, n: 1.5, c: damping * (1 + 1e-7)}, 0.01, 3.0)
    assert found.e != pytest.approx(returned(damping), rel=1e-9, abs=0)


@pytest.mark.parametrize("value", [0.001, 0.026, 0.028, 0.3, 0.9, 0.999])
def test_the_damping_number_returns_what_was_wanted(value: float) -> None:
    assert returned(number_for(value)) == pytest.approx(value, rel=1e-12, abs=0)


@pytest.mark.parametrize(("typed", "clipped"), [(0.5, 0.550283), (0.453, 0.513046)])
def test_discrete_elements_return_what_is_typed_if_they_may_pull(typed: float, clipped: float) -> None:
    ratio = float(model.damping_ratio.value.subs(e, typed))
    for pulls, expected, digits in ((True, typed, 9), (False, clipped, 6)):
        law = ForceLaw("Tsuji", model.tsuji.value, pulls=pulls)
        for speed in (0.5, 5.0):
            found = simulate(law, {model.K_T: 1e9, model.zeta: ratio}, 0.01, speed)
            assert round(found.e, digits) == round(expected, digits)


# --- what cannot be simulated is told ---------------------------------------------------------------------
def test_bodies_that_do_not_part() -> None:
    law = ForceLaw("a dashpot", K * x + 100.0 * rate, pulls=True)
    assert simulate(law, {K: 1.0}, 1.0, 1.0).failure == (
        "the bodies do not part: the damping is as strong as the spring"
    )


@pytest.mark.parametrize(
    ("law", "mass", "speed", "code", "said"),
    [
        (ForceLaw("nothing", K * x), -1.0, 1.0, "#INPUT!", "mass -1 kg and impact speed 1 m/s are not both"),
        (ForceLaw("nothing", K * x), 1.0, 1e30, "#NOROOT!", "no depth from a femtometre to 1000 km stops"),
        (
            ForceLaw("a root", (K - x) ** Rational(1, 2)),
            1.0,
            1.0,
            "#DOMAIN!",
            "a root has no force for these",
        ),
        (ForceLaw("a plate", K * x, K * x, 2 * x), 1.0, 1.0, "#DOMAIN!", "the bodies would part at a depth"),
    ],
)
def test_what_has_no_impact_says_so(law: ForceLaw, mass: float, speed: float, code: str, said: str) -> None:
    found = simulate(law, {K: 1e3}, mass, speed)
    assert (found.code, found.failure[: len(said)]) == (code, said)
    assert found.time is None


def test_a_clipped_force_may_act_again() -> None:
    """A dashpot that a depth turns on lets go; below that the spring pushes on."""
    depth = Rational(1, 10)
    step = Piecewise(((x / depth) ** 2 * (3 - 2 * x / depth), x < depth), (1, True))
    found = simulate(ForceLaw("two regimes", K * x + 12 * step * rate), {K: 100.0}, 1.0, 3.0)
    assert not found.failure
    assert found.loss == pytest.approx((1 - found.e**2) * 9 / 2, rel=1e-9)
    assert found.approach is not None
    assert found.speed is not None
    flights = [
        (a, b)
        for (a, u), (b, w) in pairwise(zip(found.approach, found.speed, strict=True))
        if u == w and a > b > 0
    ]
    assert len(flights) == 1
