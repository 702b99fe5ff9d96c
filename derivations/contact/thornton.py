"""Thornton 1997: Hertz's pressure, cut off where the target yields, with elastic unloading.

Source: C Thornton, Coefficient of restitution for collinear collisions of elastic-perfectly plastic spheres,
J Appl Mech 64 (1997) 383-386. Its closed form of the restitution is (L157); the way there is this project's.
"""

from __future__ import annotations

from dataclasses import replace

from sympy import Expr, Integer, Integral, Piecewise, Rational, Rel, acos, betainc, pi, sqrt
from sympy.core.parameters import evaluate

from ..equation import Derivation, Equation, Kind, Step, assume, define
from ..vocabulary import Quantity, Vocabulary
from . import hertz, johnson
from .model import ContactModel
from .one_constant import COMES_BACK, LOSES, taken
from .quantities import SHARED

OWN = (
    Quantity(
        "r_Y_alone",
        "speed of first yield over impact speed, by a restitution",
        "1",
        r"r_{Y%s}",
        (1e-6, 0.999),
    ),
    Quantity("p_y_alone", "limiting pressure by the restitution of one test", "Pa", r"p_{y%s}", (1e8, 4e9)),
    Quantity("p_y", "limiting pressure", "Pa", r"\bar{p}_{y%s}", (1e8, 4e9)),
    Quantity("p_y_without", "limiting pressure by all tests but one", "Pa", r"p'_{y%s}", (1e8, 4e9)),
    Quantity("x_y", "approach where the pressure is cut off", "m", "x_{y%s}", (1e-8, 1e-5)),
    Quantity("V_y", "impact speed where the pressure is cut off", "m/s", "V_{y%s}", (1e-3, 1.0)),
    Quantity(
        "a_thornton", "greatest radius of the contact by Thornton", "m", r"a_{\mathrm{T}%s}", (1e-4, 1e-3)
    ),
    Quantity("delta_thornton", "elastic recovery by Thornton", "m", r"\delta_{\mathrm{T}%s}", (1e-6, 1e-4)),
    Quantity(
        "s_y", "where the pressure is cut off, on the way of the spring beyond", "1", "s_{y%s}", (0.01, 0.9)
    ),
    Quantity("F_thornton", "force by Thornton", "N", r"F_{\mathrm{T}%s}", (1.0, 5000.0)),
    Quantity("F_y", "force where the pressure is cut off", "N", r"F_{y%s}", (0.1, 1000.0)),
    Quantity("x_m_thornton", "maximum approach by Thornton", "m", r"x_{m,\mathrm{T}%s}", (1e-5, 1e-4)),
    Quantity("F_m_thornton", "greatest force by Thornton", "N", r"F_{m,\mathrm{T}%s}", (100.0, 1e4)),
    Quantity("t_thornton", "duration of the contact by Thornton", "s", r"t_{\mathrm{T}%s}", (1e-6, 1e-3)),
    Quantity("e_thornton", "restitution by Thornton", "1", r"e_{\mathrm{T}%s}", (0.05, 0.99)),
    Quantity("x_p_thornton", "imprint by Thornton", "m", r"x_{p,\mathrm{T}%s}", (1e-6, 1e-4), positive=False),
)
_WORDS = Vocabulary(*SHARED.values(), *hertz.OWN, *johnson.YIELD_WORDS, *OWN)
v, e, m_red, x = SHARED.plain("v e m_red x")
E_star, R, K, any_a, any_delta, F_m, r = SHARED.plain("E_star R_b K a_c delta F_m r")
x_Y, p_Y, v_Y = _WORDS.plain("x_Y p_Y v_Y")
a, delta, share, alone, p_y, x_y, V_y, place, F, F_y, x_m, peak, t, e_T, x_p = _WORDS.plain(
    "a_thornton delta_thornton r_Y_alone p_y_alone p_y x_y V_y s_y F_thornton F_y x_m_thornton F_m_thornton "
    "t_thornton e_thornton x_p_thornton"
)
half = hertz.half
_part = 1 / (hertz.hertz + 1)

with evaluate(False):
    cut_off = johnson.approach_at_yield.at({x_Y: x_y, p_Y: p_y})
    speed = johnson.speed_at_yield.at({x_Y: x_y, v_Y: V_y})
    force_there = Equation(
        "(L151)",
        (F_y, Rational(2, 3) * pi * R * p_y * x_y),
        "Hertz's force there",
        title="force where the pressure is cut off",
        defines=F_y,
    )
    beyond = Equation(
        "(L152)",
        (F, F_y + pi * R * p_y * (x - x_y)),
        "what lies within the limit carries no more; the contact goes on growing by (L124)",
        Kind.ASSUMPTION,
        "Thornton's force beyond yield",
    )
    energy = assume(
        (
            half * m_red * v**2,
            Integral(K * x**hertz.hertz, (x, 0, x_y))
            + Integral(F_y + pi * R * p_y * (x - x_y), (x, x_y, x_m)),
        ),
        "the kinetic energy at impact is the work of both forces",
        "energy of an impact by Thornton",
    )
    approach = Equation(
        "(L153)",
        (x_m, x_y / 3 + sqrt(m_red * v**2 / (pi * R * p_y) - Rational(4, 45) * x_y**2)),
        "all kinetic energy has become work",
        title="maximum approach by Thornton",
        conditions=(x_m > x_y,),
    )
    greatest = Equation(
        "(L154)",
        (peak, pi * R * p_y * (x_m - x_y / 3)),
        "(L152) there",
        title="greatest force by Thornton",
    )
    restitution = Equation(
        "(L155)",
        (e_T, sqrt(3 * peak**2 / (5 * E_star * m_red * v**2 * sqrt(R * x_m)))),
        "the work of the elastic recovery (L132)",
        title="restitution by Thornton",
    )
    imprint = Equation(
        "(L156)",
        (x_p, x_m - 3 * peak / (4 * E_star * sqrt(R * x_m))),
        "the approach less the elastic recovery",
        title="imprint by Thornton",
    )
    ratio = define("", share, V_y / v, "speed of first yield over impact speed")
    _root = sqrt(Rational(6, 5) - share**2 / 5)
    energy_by_share = Equation(
        "",
        (m_red * v**2, 8 * pi * R * p_y * x_y**2 / (15 * share**2)),
        "the square of the ratio is that of the energies",
        title="energy by the ratio of speeds",
    )
    approach_by_share = Equation(
        "",
        (x_m, x_y / 3 * (1 + 2 / share * _root)),
        "(L153) with that energy",
        title="maximum approach by the ratio of speeds",
        conditions=(x_m > x_y,),
    )
    force_by_share = Equation(
        "",
        (peak, 2 * pi * R * p_y * x_y / (3 * share) * _root),
        "(L154) with that approach",
        title="greatest force by the ratio of speeds",
        conditions=(x_m > x_y,),
    )
    published = Equation(
        "(L157)",
        (e_T**4, Rational(108, 25) * (1 - share**2 / 6) ** 2 * share / (share + 2 * _root)),
        "Thornton's closed form, to the fourth power",
        title="restitution by Thornton, closed form",
        conditions=(x_m > x_y,),
    )
    by_share = Equation(
        "(L158)",
        (p_y, 2 * E_star / pi * sqrt((5 * m_red * (share * v) ** 2 / (4 * K)) ** Rational(2, 5) / R)),
        "(L137) and (L138), solved for the pressure",
        title="limiting pressure by the speed of first yield",
        defines=p_y,
    )

    # Up to the limit the rate falls as sqrt(1 - (V_y/v)^2 (x/x_y)^(5/2)); beyond it the contact is a spring
    # that would be at rest at x_y/3, and back it goes as a power.
    cut_at = define("", place, 2 * x_y / (3 * x_m - x_y), "beginning of the spring's way")
    way = assume(
        (
            t,
            x_y / v * Integral(1 / sqrt(1 - (V_y / v) ** 2 * r ** (hertz.hertz + 1)), (r, 0, 1))
            + sqrt(m_red / (pi * R * p_y)) * Integral(1 / sqrt(1 - r**2), (r, place, 1))
            + (x_m - x_p) / (e_T * v) * hertz.passing(hertz.hertz),
        ),
        "the way of each branch over its rate, which the energy that is left tells",
        "shares of the way: duration by Thornton",
    )
    lasting = Equation(
        "(L167)",
        (
            t,
            _part * x_y / v * (v / V_y) ** Rational(4, 5) * betainc(_part, half, 0, (V_y / v) ** 2)
            + sqrt(m_red / (pi * R * p_y)) * acos(cut_at.value)
            + (x_m - x_p) / (e_T * v) * hertz.lasts(hertz.hertz),
        ),
        "the shares of the way summed, by Euler's beta functions (DLMF 5.12.1 and 8.17.1)",
        title="duration of the contact by Thornton",
        conditions=(x_m > x_y,),
    )

    def _by_cases(part: str, beyond: Equation, elastic: Expr, faster: Rel = x_m > x_y) -> Equation:
        """What holds at every speed: of an impact that is slower than the limit, Hertz's."""
        of, value = beyond.members
        because = "where the pressure stays below the limit, the impact is elastic"
        cases = Piecewise((value, faster), (elastic, True))
        return Equation("(L164)", (of, cases), because, Kind.ASSUMPTION, beyond.title, part, defines=of)

    CASES = (
        _by_cases("a", approach, hertz.approach.members[-1], v > V_y),
        _by_cases("b", greatest, hertz.force.at({x: x_m}).members[-1]),
        _by_cases("c", restitution, Integer(1)),
        _by_cases("d", imprint, Integer(0)),
        _by_cases("e", lasting, hertz.elastic_duration(x_m, over=hertz.lasts)),
    )

_unloads = hertz.returned_work.at({F_m: peak, e: e_T, any_delta: delta})
_recovers = hertz.recovery.at({F_m: peak, hertz.a_u: a, any_delta: delta})
_reaches = hertz.contact.at({x: x_m, any_a: a})
CONSTANT, _entries = taken(
    (replace(published.at({e_T: e}), defines=share), by_share.at({p_y: alone})),
    _WORDS["p_y"], _WORDS["p_y_alone"], _WORDS["p_y_without"], E_star, ("(L159)", "(L160)"),
    COMES_BACK, LOSES,
)  # fmt: skip

THORNTON = ContactModel(
    name="thornton",
    title="Thornton 1997",
    mark="T",
    assumes="Hertz's pressure is cut off at one limit, at every depth and speed, and unloading is elastic",
    source="C Thornton, J Appl Mech 64 (1997) 383-386",
    quantities=OWN,
    entries=(
        Derivation.of(
            force_there,
            (hertz.force.at({hertz.F: F_y, x: x_y}), hertz.stiffness, cut_off),
            (F_y, K, E_star),
            "Put the approach where the pressure is cut off into Hertz's force.",
        ),
        beyond,
        Derivation.of(
            approach,
            (energy, force_there, hertz.stiffness, cut_off),
            (m_red, F_y, K, E_star),
            "Integrate, and solve for the approach.",
        ),
        Derivation.of(
            greatest, (beyond.at({x: x_m, F: peak}), force_there), (peak, F_y), "Put the maximum approach in."
        ),
        Derivation.of(
            restitution, (_unloads, _recovers, _reaches), (e_T, delta, a), "Put recovery and radius in."
        ),
        Derivation.of(
            imprint,
            (
                assume((x_p, x_m - delta), "definition", "imprint by Thornton", Kind.DEFINITION),
                _recovers,
                _reaches,
            ),
            (x_p, delta, a),
            "Put recovery and radius in.",
        ),
        Derivation(
            (
                Step(
                    energy_by_share,
                    (ratio, speed, hertz.stiffness, cut_off),
                    (share, V_y, K, p_y),
                    "Put the speed of first yield into the ratio.",
                ),
                Step(approach_by_share, (approach, energy_by_share), (x_m, m_red), "Put the energy in."),
                Step(force_by_share, (greatest, approach_by_share), (peak, x_m), "Put the approach in."),
                Step(
                    published,
                    (restitution, force_by_share, energy_by_share, approach_by_share, cut_off),
                    (e_T, peak, m_red, x_m, x_y),
                    "Put force, energy and approach in.",
                ),
            )
        ),
        Derivation.of(
            by_share,
            (ratio, speed, cut_off),
            (share, V_y, x_y),
            "Solve both for the pressure.",
        ),
        Derivation.of(lasting, (way, cut_at), (t, place), "Sum the shares of the way."),
        *CASES,
        *_entries,
    ),
    cells=(cut_off, speed, *CASES),
    predicts={"x_m": x_m, "F_m": peak, "t": t, "e": e_T, "x_p": x_p},
    loading=Piecewise((hertz.force.value, x < x_y), (beyond.value.xreplace({F_y: force_there.value}), True)),
    unloading=hertz.unloads(peak, x_m, x_p),
    constants=1,
    constant=CONSTANT,
    expects={p_y: (p_y >= p_Y, "below the pressure of first yield: the cut would come before the yield")},
)
