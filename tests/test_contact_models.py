"""Contact models: proved, wrong variants refuted, published digits, and simulated beside closed forms."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
from contact_laws import law_of
from scipy.optimize import brentq
from sympy import Expr, Rational, Symbol, beta, lambdify

import loopsheet
from loopsheet.derivations import soft_impact as paper
from loopsheet.derivations.contact import checks, hertz, johnson, thornton
from loopsheet.derivations.contact.lankarani_1994 import LANKARANI_1994
from loopsheet.derivations.contact.model import ContactModel
from loopsheet.derivations.contact.models import LEDGER, MODELS
from loopsheet.derivations.equation import Derivation
from loopsheet.derivations.proof import check_step, prove
from loopsheet.derivations.proved import ProofStatus
from loopsheet.report.impacts.simulation import simulate
from loopsheet.report.plan.special import EXACT, in_elementary_terms

SHIPPED = Path(loopsheet.__file__).parent / "data" / "contact_models"


def test_all_of_it_is_proved_and_each_model_agrees_with_what_it_rests_on() -> None:
    found = prove(LEDGER)
    assert [(proof.equation.label, proof.remark) for proof in found if not proof.status.passes] == []
    claims = {entry.claim for entry in LEDGER.entries if isinstance(entry, Derivation)}
    assert {proof.equation for proof in found if proof.status is ProofStatus.PROVED} == claims


def test_what_contradicts_a_model_within_its_part_is_refused() -> None:
    """The check of what holds together is asked of each model."""
    says = LEDGER["(L130)"]
    otherwise = replace(says, number="(L999)", members=(says.members[0], Rational(1, 2)))
    wrong = replace(LEDGER, entries=(*LEDGER.entries, otherwise), parts=((*LEDGER.parts[2], otherwise),))
    found = {proof.equation.label: proof for proof in prove(wrong)}
    assert found["(L999)"].status is ProofStatus.REFUSED


def wrong() -> Iterator[tuple[str, Any]]:
    """The label of a claim, and what a slip of the pen makes of its last side."""
    for label, factors in {
        "(L126)": (2, Rational(3, 4)), "(L127)": (2, Rational(4, 5)), "(L132)": (2, Rational(4, 3)),
        "(L133)": (2, Rational(5, 2)), "(L134)": (2, Rational(4, 5)), "(L138)": (4, Rational(1, 2)),
        "(L139)": (2, Rational(1, 4)), "(L142)": (2, Rational(1, 2)), "(L143)": (2, Rational(1, 2)),
        "(L144)": (2,), "(L145)": (2, Rational(5, 3)), "(L146)": (2, Rational(4, 5)), "(L147)": (2,),
        "(L151)": (Rational(3, 2),), "(L153)": (2,), "(L154)": (3,), "(L155)": (2,),
        "(L156)": (2,), "(L157)": (Rational(25, 108), 2), "(L158)": (2,),
        "(L161)": (2,), "(L179)": (-1, Rational(3, 2)),
    }.items():  # fmt: skip
        for factor in factors:
            yield label, factor


@pytest.mark.parametrize(("label", "factor"), [*wrong()])
def test_a_wrong_variant_is_refuted(label: str, factor: Any) -> None:
    claim = LEDGER[label]
    derivation = LEDGER.derivation(claim)
    assert derivation is not None
    slipped = replace(claim, members=(claim.members[0], factor * claim.members[-1]))
    found = check_step(replace(derivation.steps[-1], claim=slipped), LEDGER.vocabulary)
    assert found.status is ProofStatus.REFUTED
    assert found.counterexample


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
        assert shown[name] == pytest.approx(expected, rel=2e-9, abs=1e-15 if name == "x_p" else 0), name
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


def test_a_restitution_of_one_leaves_no_imprint() -> None:
    where = numbers("steel") | {hertz.e: 1.0}
    assert closed(LANKARANI_1994, LANKARANI_1994.predicts["x_p"], where) == 0


def test_exponents_by_restitutions_follow_from_synthetic_ones() -> None:
    """Restitutions that an elastic unloading gives for an exponent tell that exponent."""
    alpha = 1.2
    power = (alpha - 1.5) / (alpha + 1)
    assert float(checks.by_restitution.value.subs({checks.b: power})) == pytest.approx(alpha, rel=1e-14)


# --- the beta function --------------------------------------------------------------------------------------


@pytest.mark.parametrize("digits", [18, EXACT])
@pytest.mark.parametrize("a", ["0.02", "0.3333", "0.43", "0.5", "1.7", "40"])
def test_the_beta_function_is_said_in_powers_to_the_digits_that_are_asked_for(digits: int, a: str) -> None:
    own = Symbol("a", positive=True)
    said = in_elementary_terms(beta(own, Rational(1, 2)), digits)
    with mpmath.workdps(digits + 15):
        value = lambdify(own, said, "mpmath")(mpmath.mpf(a))
        right = mpmath.beta(mpmath.mpf(a), mpmath.mpf("0.5"))
        assert abs(value / right - 1) < mpmath.mpf(10) ** -digits * 3
