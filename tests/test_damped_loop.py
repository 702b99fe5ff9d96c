"""Law (3) with damping on both branches: proved, wrong variants refuted, and beside simulated impacts."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import product

import pytest
from sympy import Expr, Integer, Rational, Symbol, log

from loopsheet.derivations.contact import damped_loop as loop
from loopsheet.derivations.contact.damped_loop import (
    LEDGER,
    C,
    C_u,
    Cprime,
    alpha,
    beta,
    beta_u,
    c_c,
    c_r,
    e,
    m_red,
    s_c,
    s_r,
    v_0,
    x_m,
    x_p,
)
from loopsheet.derivations.equation import Derivation, Equation
from loopsheet.derivations.proof import check_step, prove
from loopsheet.derivations.proved import ProofStatus
from loopsheet.report.impacts.law import ForceLaw, x_max
from loopsheet.report.impacts.simulation import Impact, simulate

CLAIMS = [entry.claim for entry in LEDGER.entries if isinstance(entry, Derivation)]


def test_all_of_it_is_proved() -> None:
    found = prove(LEDGER)
    passed = (ProofStatus.PROVED, ProofStatus.ASSUMPTION, ProofStatus.DEFINITION)
    assert [(proof.equation.label, proof.remark) for proof in found if proof.status not in passed] == []
    assert [proof.equation for proof in found if proof.status is ProofStatus.PROVED] == CLAIMS


def wrong() -> Iterator[tuple[Equation, Expr]]:
    """A claim and what a slip of the pen makes of its last side."""
    energy = m_red * v_0**2 / 2
    slips: Mapping[str, tuple[Expr, ...]] = {
        "(L205)": (energy, energy / s_c, 2 * s_c * energy),
        "(L206)": (s_r * energy, s_r * e * energy, e**2 * energy),
        "(L207)": (C * x_m ** (alpha + 1), C * x_m**alpha / (alpha + 1), C * x_m ** (alpha + 1) / alpha),
        "(L208)": (Cprime * x_m / (beta + 1), Cprime * (x_m - x_p), Cprime * (x_m - x_p) / beta),
        "(L211)": ((s_c - 1) * energy, (1 - s_c**2) * energy, s_c * energy),
        "(L212)": ((s_r - 1) * energy, (1 - s_r) * e**2 * energy, s_r * e**2 * energy),
        "(L213)": ((s_c - s_r) * energy, (s_c - e**2) * energy, (1 - s_r * e**2) * energy),
        "(L214)": ((1 - e) * energy, (1 + e**2) * energy, (1 - s_r * e**2) * energy),
        "(L209)": tuple(loop.approach.value * factor for factor in (2, s_c, alpha)),
        "(L210)": tuple(
            x_m * (1 - (beta + 1) * factor * e**2 / (alpha + 1)) for factor in (s_c * s_r, s_c / s_r, s_r)
        ),
        "(L216)": tuple(loop.like_3.value * factor for factor in (s_c, 2, 1 + e)),
    }
    assert slips.keys() == {claim.label for claim in CLAIMS}
    yield from ((claim, value) for claim in CLAIMS for value in slips[claim.label])


@pytest.mark.parametrize(("claim", "value"), [*wrong()], ids=lambda each: getattr(each, "label", ""))
def test_a_wrong_variant_is_refuted(claim: Equation, value: Expr) -> None:
    derivation = LEDGER.derivation(claim)
    assert derivation is not None
    other = replace(claim, members=(claim.members[0], value))
    found = check_step(replace(derivation.steps[-1], claim=other), LEDGER.vocabulary)
    assert found.status is ProofStatus.REFUTED
    assert found.counterexample


def test_a_wrong_share_is_refuted() -> None:
    """With the sign of c_r e turned, the elastic work of restitution would be less than the rebound."""
    other = replace(loop.share_r, members=(s_r, 2 * (c_r * e - log(1 + c_r * e)) / (c_r * e) ** 2))
    derivation = LEDGER.derivation(loop.elastic_r)
    assert derivation is not None
    (step,) = derivation.steps
    premises = tuple(other if premise == loop.share_r else premise for premise in step.premises)
    assert check_step(replace(step, premises=premises), LEDGER.vocabulary).status is ProofStatus.REFUTED


# --- simulated impacts ------------------------------------------------------------------------------------
STEEL = {"m_red": 8.366e-3, "C": 1.009e9, "alpha": 1.3013, "beta": 1.5}
BUFFER = {"m_red": 12.0, "C": 3e4, "alpha": 1.1, "beta": 1.5}
Numbers = Mapping[str, float]


def value(of: Expr, numbers: Numbers) -> float:
    """A formula at a point, with what the shares and the approach stand for put in."""
    for told in (loop.imprint, loop.approach, loop.share_c, loop.share_r):
        of = of.xreplace({told.sides[0]: told.value})
    return float(
        of.evalf(40, subs={symbol: Rational(repr(numbers[str(symbol)])) for symbol in of.free_symbols})
    )


def law_for(numbers: Numbers, share: float) -> ForceLaw:
    """The force, whose imprint is a share of the greatest approach: so that a law holds for any speed."""
    here: dict[Expr, Expr] = {x_m: x_max, Cprime: C * x_max**alpha}
    unloading = loop.unloading.value.xreplace(here)
    return ForceLaw("the loop", loop.loading.value, unloading, x_p, where=((x_p, share * x_max),))


def impact(numbers: Numbers) -> Impact:
    share = value(loop.imprint.value / x_m, numbers)
    constants = {Symbol(name, positive=True): numbers[name] for name in ("C", "alpha", "beta", "c_c", "c_r")}
    return simulate(law_for(numbers, share), constants, numbers["m_red"], numbers["v_0"])


@pytest.mark.parametrize("damping", [(0.3, 0.2), (1.4, 0.05), (0.01, 1.2)])
@pytest.mark.parametrize(("body", "speed", "rebound"), [(STEEL, 4.089, 0.479), (BUFFER, 0.2, 0.3)])
def test_a_simulated_impact_is_as_the_closed_forms_say(
    body: Numbers, speed: float, rebound: float, damping: tuple[float, float]
) -> None:
    numbers = {**body, "v_0": speed, "e": rebound, "c_c": damping[0], "c_r": damping[1]}
    found = impact(numbers)
    assert not found.failure
    assert found.e == pytest.approx(rebound, rel=1e-9, abs=0)
    assert found.x_m == pytest.approx(value(loop.approach.value, numbers), rel=1e-9, abs=0)
    assert found.x_p == pytest.approx(value(loop.imprint.value, numbers), rel=1e-9, abs=0)
    works = [value(claim.value, numbers) for claim in (loop.friction_c, loop.friction_r, loop.plastic)]
    assert found.loss == pytest.approx(sum(works), rel=1e-9, abs=0)
    assert found.loss == pytest.approx(value(loop.loss.value, numbers), rel=1e-9, abs=0)
    # Each by itself: the kinetic energy less what the elastic curves hold at the simulated approaches.
    energy = numbers["m_red"] * speed**2 / 2
    by_c = numbers["C"] * found.x_m ** (numbers["alpha"] + 1) / (numbers["alpha"] + 1)
    force = numbers["C"] * found.x_m ** numbers["alpha"]
    by_r = force * (found.x_m - found.x_p) / (numbers["beta"] + 1)
    simulated = (energy - by_c, by_r - found.e**2 * energy, by_c - by_r)
    for simulation, closed in zip(simulated, works, strict=True):
        assert simulation == pytest.approx(closed, rel=0, abs=1e-9 * energy)


def test_another_damping_is_not_taken_for_it() -> None:
    """The bound above is one that a wrong damping fails."""
    numbers = {**STEEL, "v_0": 4.089, "e": 0.479, "c_c": 0.3, "c_r": 0.2}
    share = value(loop.imprint.value / x_m, numbers)
    constants = {Symbol(name, positive=True): numbers[name] for name in ("C", "alpha", "beta", "c_c")}
    constants[c_r] = 0.2 * (1 + 1e-6)
    found = simulate(law_for(numbers, share), constants, numbers["m_red"], numbers["v_0"])
    assert found.e != pytest.approx(0.479, rel=1e-9, abs=0)


def test_without_damping_it_is_law_3() -> None:
    from sympy import limit

    assert limit(loop.share_c.value, c_c, 0) == 1
    assert limit(loop.share_r.value, c_r, 0) == 1
    undamped = {s_c: Integer(1), s_r: Integer(1)}
    assert loop.friction_c.value.subs(undamped) == 0
    assert loop.friction_r.value.subs(undamped) == 0


@pytest.mark.parametrize("shares", [*product([0.2, 1.2], [0.1, 0.6])])
def test_speed_restitution_and_imprint_do_not_tell_the_damping(shares: tuple[float, float]) -> None:
    """Undamped impacts of another material show the same e and x_p at all speeds, and have no friction.

    c_r is in inverse proportion to the restitution, which need not be the same at every speed.
    """
    damping, at_rebound = shares
    for speed, rebound in ((2.334, 0.53), (4.993, 0.453)):
        numbers = {**STEEL, "v_0": speed, "e": rebound, "c_c": damping, "c_r": at_rebound / rebound}
        damped = impact(numbers)
        other = {
            **numbers,
            "C": value(C / s_c, numbers),
            "beta": value((beta + 1) * s_r / s_c, numbers) - 1,
        }
        law = ForceLaw(
            "law (3)",
            loop.loading.value.subs(c_c, 0),
            loop.unloading.value.subs(c_r, 0).xreplace({x_m: x_max, Cprime: C * x_max**alpha}),
            x_p,
            where=((x_p, damped.x_p / damped.x_m * x_max),),
        )
        # The greatest approach stays, and so the share of the imprint.
        constants = {Symbol(name, positive=True): other[name] for name in ("C", "alpha", "beta")}
        undamped = simulate(law, constants, numbers["m_red"], speed)
        assert undamped.e == pytest.approx(damped.e, rel=1e-9, abs=0)
        assert undamped.x_p == pytest.approx(damped.x_p, rel=1e-9, abs=0)
        numbers |= {str(C_u): other["C"], str(beta_u): other["beta"]}
        assert value(loop.like_3.value, numbers) == pytest.approx(damped.x_p, rel=1e-9, abs=0)
        assert value(loop.friction_c.value, numbers) > 0.05 * value(loop.loss.value, numbers)
