"""First yield under Hertz's pressure, and Johnson's fully plastic impact with elastic unloading.

Source: K L Johnson, Contact Mechanics, Cambridge 1985: 3.4 for the stresses on the axis, 11.4 for impact.
"""

from __future__ import annotations

from sympy import Integer, Integral, Rational, atan, diff, pi, sqrt
from sympy.core.parameters import evaluate

from ..equation import Derivation, Equation, Kind, assume, define
from ..vocabulary import Quantity, Vocabulary
from . import hertz
from .model import ContactModel
from .one_constant import COMES_BACK, LOSES, taken
from .quantities import SHARED

YIELD_WORDS = (
    Quantity("sigma_Y", "yield strength of the target", "Pa", "Y%s", (1e8, 2e9)),
    # From 0.38 (nu = 0) to 0.55 (nu = 1/2). The slope of (L136) keeps its sign up to 0.84.
    Quantity(
        "zeta_Y", "depth of first yield, over the radius of the contact", "1", r"\zeta_{Y%s}", (0.2, 0.8)
    ),
    Quantity("s_0", "stress difference on the axis, over the pressure at the centre", "1", "s%s", (0.1, 0.9)),
    Quantity("p_Y", "pressure at the centre at first yield", "Pa", "p_{Y%s}", (1e8, 4e9)),
    Quantity("x_Y", "approach at first yield", "m", "x_{Y%s}", (1e-9, 1e-5)),
    Quantity("a_Y", "radius of the contact at first yield", "m", "a_{Y%s}", (1e-6, 1e-4)),
    Quantity("v_Y", "impact speed of first yield", "m/s", "v_{Y%s}", (1e-4, 1.0)),
    Quantity("v_over_Y", "impact speed, over that of first yield", "1", "v/v_{Y%s}", (1.0, 1e3)),
)
OWN = (
    Quantity("a_p", "radius of a plastic contact", "m", "a_{p%s}", (1e-4, 1e-3)),
    Quantity("delta_johnson", "elastic recovery by Johnson", "m", r"\delta_{\mathrm{J}%s}", (1e-6, 1e-4)),
    Quantity("F_johnson", "force by Johnson", "N", r"F_{\mathrm{J}%s}", (1.0, 5000.0)),
    Quantity("p_d_alone", "dynamic pressure by the restitution of one test", "Pa", r"p_{d%s}", (1e8, 4e9)),
    Quantity("p_d", "dynamic pressure", "Pa", r"\bar{p}_{d%s}", (1e8, 4e9)),
    Quantity("p_d_without", "dynamic pressure by all tests but one", "Pa", r"p'_{d%s}", (1e8, 4e9)),
    Quantity("x_m_johnson", "maximum approach by Johnson", "m", r"x_{m,\mathrm{J}%s}", (1e-5, 1e-4)),
    Quantity("F_m_johnson", "greatest force by Johnson", "N", r"F_{m,\mathrm{J}%s}", (100.0, 1e4)),
    Quantity("e_johnson", "restitution by Johnson", "1", r"e_{\mathrm{J}%s}", (0.05, 0.89)),
    Quantity("x_p_johnson", "imprint by Johnson", "m", r"x_{p,\mathrm{J}%s}", (1e-6, 1e-4)),
    Quantity("t_johnson", "duration of the contact by Johnson", "s", r"t_{\mathrm{J}%s}", (1e-6, 1e-3)),
)
_WORDS = Vocabulary(*SHARED.values(), *YIELD_WORDS, *OWN)
v, e, m_red, x = SHARED.plain("v e m_red x")
E_star, R, K, a, p_0, any_delta, F_m, nu = SHARED.plain("E_star R_b K a_c p_0 delta F_m nu_2")
Y, zeta, s_0, p_Y, x_Y, v_Y, faster = _WORDS.plain("sigma_Y zeta_Y s_0 p_Y x_Y v_Y v_over_Y")
a_Y, a_p, delta, F, alone, p_d, x_m, peak, e_J, x_p, t = _WORDS.plain(
    "a_Y a_p delta_johnson F_johnson p_d_alone p_d x_m_johnson F_m_johnson e_johnson x_p_johnson t_johnson"
)
half = hertz.half

# --- first yield -------------------------------------------------------------------------------------------

with evaluate(False):
    difference = Equation(
        "(L135)",
        (s_0, Rational(3, 2) / (1 + zeta**2) - (1 + nu) * (1 - zeta * atan(1 / zeta))),
        "Hertz's stresses on the axis below a circular contact: axial less radial",
        Kind.ASSUMPTION,
        "stress difference on the axis",
        defines=s_0,
    )

_steepness = diff(difference.value, zeta)

with evaluate(False):
    deepest = Equation(
        "(L136)",
        (_steepness, Integer(0)),
        "yield begins where the difference (L135) is greatest",
        Kind.DEFINITION,
        "depth of first yield",
        defines=zeta,
    )
    pressure_at_yield = define(
        "(L137)",
        p_Y,
        Y / difference.members[1],
        "pressure at first yield",
        "the difference reaches the yield strength (Tresca, and von Mises on the axis)",
    )
    approach_at_yield = Equation(
        "(L138)",
        (x_Y, R * (pi * p_Y / (2 * E_star)) ** 2),
        "(L123) and (L124) at that pressure",
        title="approach at first yield",
        defines=x_Y,
    )
    speed_at_yield = Equation(
        "(L139)",
        (v_Y, sqrt(4 * K * x_Y ** Rational(5, 2) / (5 * m_red))),
        "(L127) at that approach",
        title="impact speed of first yield",
        defines=v_Y,
    )

    beyond = define("(L171)", faster, v / v_Y, "impact speed over that of first yield")

    # --- fully plastic -------------------------------------------------------------------------------------
    crater = Equation(
        "(L140)",
        (a_p**2, 2 * R * x),
        "the target flows up to the ball's sphere: no bulge and no sinking in",
        Kind.ASSUMPTION,
        "radius of a plastic contact",
    )
    mean_pressure = Equation(
        "(L141)",
        (F, pi * a_p**2 * p_d),
        "the mean pressure is one number, at every depth and speed",
        Kind.ASSUMPTION,
        "force of a constant pressure",
    )
    law = Equation(
        "(L142)",
        (F, 2 * pi * R * p_d * x),
        "the pressure on the crater",
        title="Johnson's fully plastic force",
    )
    energy = assume(
        (half * m_red * v**2, Integral(2 * pi * R * p_d * x, (x, 0, x_m))),
        "the kinetic energy at impact is the plastic work",
        "energy of a fully plastic impact",
    )
    approach = Equation(
        "(L143)",
        (x_m, v * sqrt(m_red / (2 * pi * R * p_d))),
        "all kinetic energy has become work",
        title="maximum approach of a fully plastic impact",
        defines=x_m,
    )
    greatest = Equation(
        "(L144)", (peak, 2 * pi * R * p_d * x_m), "(L142)", title="greatest force of a fully plastic impact",
        defines=peak,
    )  # fmt: skip
    restitution = Equation(
        "(L145)",
        (e_J, sqrt(3 * pi * p_d * sqrt(2 * R / x_m) / (5 * E_star))),
        "the work of the elastic recovery (L132)",
        title="restitution of a fully plastic impact",
        defines=e_J,
    )
    imprint = Equation(
        "(L146)",
        (x_p, x_m * (1 - Rational(5, 4) * e_J**2)),
        "the approach less the elastic recovery",
        title="imprint of a fully plastic impact",
        defines=x_p,
    )
    lasting = hertz.timed(
        "(L150)", t, "duration of a fully plastic impact", hertz.duration, x_m, x_p, e_J, Integer(1)
    )
    by_restitution = Equation(
        "(L147)",
        (
            p_d,
            (5 * E_star * e_J**2 / (3 * pi)) ** Rational(4, 5)
            * (v * sqrt(m_red / (2 * pi * R)) / (2 * R)) ** Rational(2, 5),
        ),
        "(L145) with (L143), solved for the pressure",
        title="dynamic pressure by a restitution",
        defines=p_d,
    )  # fmt: skip

_unloads = hertz.returned_work.at({F_m: peak, e: e_J, any_delta: delta})
_recovers = hertz.recovery.at({F_m: peak, hertz.a_u: a_p, any_delta: delta})
CONSTANT, _entries = taken(
    (by_restitution.at({p_d: alone, e_J: e}),),
    _WORDS["p_d"], _WORDS["p_d_alone"], _WORDS["p_d_without"], E_star, ("(L148)", "(L149)"),
    COMES_BACK, LOSES,
)  # fmt: skip

FIRST_YIELD = (deepest, pressure_at_yield, approach_at_yield, speed_at_yield, beyond)
"""What tells at which speed the target begins to yield, and how much faster a test is."""
SLOW = {faster: (faster > 1, "slower than first yield: such an impact is elastic and leaves no imprint")}
"""What is expected of tests that leave an imprint."""
YIELD: tuple[Equation | Derivation, ...] = (
    difference,
    deepest,
    pressure_at_yield,
    Derivation.of(
        approach_at_yield,
        (hertz.pressure.at({p_0: p_Y, a: a_Y}), hertz.contact.at({x: x_Y, a: a_Y})),
        (p_Y, a_Y),
        "Put the radius of the contact into the pressure.",
    ),
    Derivation.of(
        speed_at_yield,
        (hertz.approach.at({hertz.x_m: x_Y, v: v_Y}),),
        (v_Y,),
        "Solve for the speed.",
    ),
    beyond,
)

JOHNSON = ContactModel(
    name="johnson",
    title="Johnson, fully plastic",
    mark="J",
    assumes="the target flows at one mean pressure, at every depth and speed, and unloads elastically",
    source="K L Johnson, Contact Mechanics, Cambridge 1985, 11.4, 10.1017/CBO9781139171731",
    quantities=(*YIELD_WORDS, *OWN),
    entries=(
        *YIELD,
        crater,
        mean_pressure,
        Derivation.of(law, (mean_pressure, crater), (F, a_p), "Put the radius of the crater in."),
        Derivation.of(approach, (energy,), (m_red,), "Integrate, and solve for the approach."),
        Derivation.of(greatest, (law.at({x: x_m, F: peak}),), (peak,), "Put the maximum approach in."),
        Derivation.of(
            restitution,
            (_unloads, _recovers, greatest, crater.at({x: x_m}), approach),
            (e_J, delta, peak, a_p, m_red),
            "Put recovery, force and radius into the work that is given back.",
        ),
        Derivation.of(
            imprint,
            (
                assume((x_p, x_m - delta), "definition", "imprint by Johnson", Kind.DEFINITION),
                _unloads, greatest, approach,
            ),
            (x_p, delta, peak, m_red),
            "Put the recovery in that the restitution asks for.",
        ),
        Derivation.of(
            by_restitution, (restitution, approach), (e_J, x_m), "Put the approach in, and solve."
        ),
        *_entries,
        lasting,
    ),
    cells=(approach, greatest, restitution, imprint, lasting.claim),
    predicts={"x_m": x_m, "F_m": peak, "t": t, "e": e_J, "x_p": x_p},
    loading=law.value,
    unloading=hertz.unloads(peak, x_m, x_p),
    constants=1,
    constant=CONSTANT,
    needs={x_p: (Rational(5, 4) * e_J**2 < 1, "5 e^2/4 is not below 1: the recovery is the whole approach")},
    expects={e_J: (e_J <= 1, "e > 1: an elastic recovery of this pressure gives back more than there was")},
)  # fmt: skip
