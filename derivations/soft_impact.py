"""Impact of a ball on a soft target: compression F = C x^alpha, restitution with exponent beta.

Source: F C Ciornei, S Alaci, I C Romanu, M C Ciornei and G Sopon, "Identification of exponent from
load-deformation relation for soft materials from impact tests". Equations (1) to (12) carry the paper's
numbers and its order of terms; those that begin with L are this project's own and say so.
"""

from __future__ import annotations

from sympy import And, Expr, Integer, Integral, Le, Piecewise, Rational, pi
from sympy.core.parameters import evaluate

from . import alpha_root, errata, generated_points, pair_curve, power_law_fit
from .alpha_root import reciprocal, root_form, u
from .equation import Derivation, Equation, Kind, Ledger, Step, assume, define
from .symbols import VOCABULARY, F_LN_of, F_of, k

V, E, XP, XM, CP = (VOCABULARY[name] for name in ("v", "e", "x_p", "x_m", "Cprime"))
v, e, x_p, x_m, Cprime = VOCABULARY.plain("v e x_p x_m Cprime")
C, alpha, beta, m_red, m_1, m_2, mu, x, d, rho, z, n = VOCABULARY.plain(
    "C alpha beta m_red m_1 m_2 mu x d rho z n"
)
v_n1, v_n2, C_LN = VOCABULARY.plain("v_n1 v_n2 C_LN")
F = F_of(x)
half = Rational(1, 2)

# --- definitions and assumptions of the paper ----------------------------------------------------------

with evaluate(False):
    eq1 = define(
        "(1)", e, -(v_n2 / v_n1), "coefficient of restitution", "definition of the coefficient of restitution"
    )

    eq2 = Equation(
        "(2)",
        (
            F_LN_of(x),
            Piecewise(
                (C_LN * x ** Rational(3, 2), And(Le(0, x), Le(x, x_m))),
                (Cprime * ((x - x_p) / (x_m - x_p)) ** Rational(3, 2), And(Le(x_p, x), Le(x, x_m))),
            ),
        ),
        "model of Lankarani and Nikravesh (1994), quoted for comparison",
        Kind.ASSUMPTION,
        "Lankarani's force law",
    )

    _compression = C * x**alpha
    _restitution = Cprime * ((x - x_p) / (x_m - x_p)) ** beta

    eq3 = Equation(
        "(3)",
        (
            F,
            Piecewise((_compression, And(Le(0, x), Le(x, x_m))), (_restitution, And(Le(x_p, x), Le(x, x_m)))),
        ),
        "the model: Meyer's law while loading, an elastic law while unloading",
        Kind.ASSUMPTION,
        "force law of the model",
    )

    law_c = eq3.branch(0, "compression branch of (3)")
    law_r = eq3.branch(1, "restitution branch of (3)")

    eq4 = Equation(
        "(4)",
        (And(Le(1, alpha), Le(alpha, Rational(3, 2))),),
        "Meyer's law for loading: 1 perfectly plastic, 3/2 perfectly elastic",
        Kind.ASSUMPTION,
        "range of the exponent",
    )

    eq5 = Equation(
        "(5)",
        (beta, Rational(3, 2)),
        "no plastic deformation while unloading: Hertz's exponent",
        Kind.ASSUMPTION,
        "exponent of restitution",
        defines=beta,
    )

    # --- work and energy of one test, then of test k ---------------------------------------------

    energy_c = assume(
        (-(half * m_red * v**2), -Integral(F, (x, 0, x_m))),
        "the kinetic energy at impact is the work done up to the maximum approach",
        "theorem of kinetic energy, compression",
    )

    eq6 = Equation(
        "(6)",
        (-(half * m_red * v**2), -Integral(F, (x, 0, x_m)), -(C * x_m ** (alpha + 1) / (alpha + 1))),
        "work of the compression branch",
        title="work of compression",
    )

    energy_r = assume(
        (half * m_red * (e * v) ** 2, -Integral(F, (x, x_m, x_p))),
        "the kinetic energy at rebound is the work given back down to the imprint depth",
        "theorem of kinetic energy, restitution",
    )

    eq7 = Equation(
        "(7)",
        (
            half * m_red * (e * v) ** 2,
            -Integral(_restitution, (x, x_m, x_p)),
            Cprime * (x_m - x_p) / (beta + 1),
        ),
        "work of the restitution branch",
        title="work of restitution",
    )

    eq8 = define("(8)", m_red, m_1 * m_2 / (m_1 + m_2), "reduced mass", "definition of the reduced mass")

    continuity = Equation(
        "",
        (_compression.xreplace({x: x_m}), _restitution.xreplace({x: x_m})),
        "both branches of (3) meet at the maximum approach",
        title="continuity of (3) at the maximum approach",
    )

    eq9 = Equation("(9)", (C * x_m**alpha, Cprime), "continuity of the force", title="common maximum force")

    eq10a = Equation(
        "(10)",
        (C * XM[k] ** (alpha + 1) / (alpha + 1), half * m_red * V[k] ** 2),
        "(6) for test k",
        title="work of compression, test k",
        part="a",
    )

    eq10b = Equation(
        "(10)",
        (CP[k] * (XM[k] - XP[k]) / (beta + 1), half * m_red * (E[k] * V[k]) ** 2),
        "(7) for test k",
        title="work of restitution, test k",
        part="b",
    )

    eq10c = Equation(
        "(10)", (C * XM[k] ** alpha, CP[k]), "(9) for test k", title="common maximum force, test k", part="c"
    )

    # --- two tests ---------------------------------------------------------------------------------

    ratio = Equation(
        "",
        ((alpha + 1) / (beta + 1) * ((XM[k] - XP[k]) / XM[k]), E[k] ** 2),
        "share of the energy that is given back",
        title="energy ratio of test k",
    )

    eq11 = Equation(
        "(11)",
        (
            (alpha + 1) / (beta + 1)
            + XP[1] / XP[2] * (E[2] ** 2 - (alpha + 1) / (beta + 1)) * (V[2] / V[1]) ** (2 / (alpha + 1))
            - E[1] ** 2,
            Integer(0),
        ),
        "the one equation for alpha that is left of (10) for two tests",
        title="equation for alpha",
        defines=alpha,
    )

    _margin = (alpha + 1) - (beta + 1) * E[2] ** 2

    eq12a = Equation(
        "(12)",
        (XM[2], XP[2] * (1 / (1 - (beta + 1) / (alpha + 1) * E[2] ** 2))),
        "(10) for test 2",
        title="approach of the second test",
        part="a",
        defines=XM[2],
    )

    eq12b = Equation(
        "(12)",
        (XM[1], XM[2] * (V[1] / V[2]) ** (2 / (alpha + 1))),
        "both tests load along one curve",
        title="approach of the first test",
        part="b",
        defines=XM[1],
    )

    eq12c = Equation(
        "(12)",
        (C, m_red * V[2] ** 2 / 2 * ((alpha + 1) / XM[2] ** (alpha + 1))),
        "(10a) for test 2",
        title="coefficient of the pair",
        part="c",
        defines=C,
    )

    eq12d = Equation(
        "(12)",
        (CP[1], C * XM[1] ** alpha),
        "(10c) for test 1",
        title="maximum force of the first test",
        part="d",
        defines=CP[1],
    )

    eq12e = Equation(
        "(12)",
        (CP[2], C * XM[2] ** alpha),
        "(10c) for test 2",
        title="maximum force of the second test",
        part="e",
        defines=CP[2],
        printed=(CP[1], C * XM[1] ** alpha),
    )

    # --- this project's own: the mass, and each test after the fit -----------------------------------

    volume = assume(
        (m_1, rho * Integral(pi * ((d / 2) ** 2 - z**2), (z, -d / 2, d / 2))),
        "the mass of a homogeneous ball, slice by slice",
        "mass of a homogeneous ball",
        Kind.DEFINITION,
    )

    ball_mass = Equation("(L1)", (m_1, rho * pi * d**3 / 6), "volume of a ball", title="mass of the ball")

    mass_ratio = define("", mu, m_1 / m_2, "mass ratio")

    immobile = assume(
        (mu, Integer(0)),
        "the target does not move: its mass is beyond all bounds",
        "immobile target",
        Kind.LIMIT,
    )

    reduced_by_ratio = Equation(
        "", (m_red, m_1 / (1 + mu)), "(8) in terms of the mass ratio", title="reduced mass by ratio"
    )

    immobile_mass = Equation(
        "(L2)", (m_red, m_1), "(8) for an immobile target", title="reduced mass, immobile target"
    )

    x_m_of_test = Equation(
        "(L3)",
        (x_m, ((alpha + 1) * m_red * v**2 / (2 * C)) ** (1 / (alpha + 1))),
        "(6) solved for the maximum approach",
        title="approach of a test",
    )

    Cprime_of_test = Equation(
        "(L4)",
        (Cprime, (beta + 1) * m_red * (e * v) ** 2 / (2 * (x_m - x_p))),
        "(7) solved for the maximum force",
        title="maximum force from the restitution",
        conditions=(x_m > x_p,),
    )


def _one_test(equation: Equation, number: int | Expr) -> Equation:
    """The equation of one impact, for test `number`."""
    return equation.at({v: V[number], e: E[number], x_p: XP[number], x_m: XM[number], Cprime: CP[number]})


ratio_step = Step(
    ratio,
    (eq10a, eq10c, eq10b),
    (m_red, CP[k], XP[k]),
    "Divide (10b) by (10a); with (10c) the coefficient, the mass and the speed cancel.",
)
_ratio_1, _ratio_2 = ratio.at({k: Integer(1)}), ratio.at({k: Integer(2)})
_work_1, _work_2 = eq10a.at({k: Integer(1)}), eq10a.at({k: Integer(2)})

_law_work_1 = Step(
    eq12b,
    (_work_2, _work_1),
    (m_red, XM[1]),
    "Divide (10a) of test 1 by (10a) of test 2: mass and coefficient cancel.",
)
_approach_2 = Step(eq12a, (_ratio_2,), (XP[2],), "Solve the energy ratio of test 2 for its approach.")

LEDGER = Ledger(
    entries=(
        eq1,
        eq2,
        eq3,
        eq4,
        eq5,
        Derivation.of(
            eq6,
            (law_c, energy_c),
            (F, m_red),
            "Put the compression branch of (3) under the integral and integrate.",
        ),
        Derivation.of(
            eq7,
            (law_r, energy_r),
            (F, m_red),
            "Put the restitution branch of (3) under the integral and integrate.",
        ),
        eq8,
        Derivation(
            (
                Step(
                    continuity,
                    (law_r.at({x: x_m}), law_c.at({x: x_m})),
                    (F_of(x_m), C),
                    "Both branches give the force at the maximum approach.",
                ),
                Step(eq9, (continuity,), (C,), "At x = x_m the bracket of the restitution branch is 1."),
            )
        ),
        Derivation.of(eq10a, (_one_test(eq6.brief, k),), (m_red,), "Write (6) for test k."),
        Derivation.of(eq10b, (_one_test(eq7.brief, k),), (m_red,), "Write (7) for test k."),
        Derivation.of(eq10c, (_one_test(eq9, k),), (C,), "Write (9) for test k."),
        Derivation.of(
            eq11,
            (eq12b, eq12a, _ratio_1),
            (XM[1], XM[2], XP[1]),
            "Put both approaches into the energy ratio of test 1 and divide by the approach: only "
            "alpha is left.",
            after=(ratio_step, _approach_2, _law_work_1),
        ),
        Derivation((ratio_step, _approach_2)),
        Derivation((_law_work_1,)),
        Derivation.of(eq12c, (_work_2,), (m_red,), "Solve (10a) of test 2 for the coefficient."),
        Derivation.of(eq12d, (eq10c.at({k: Integer(1)}),), (CP[1],), "Read (10c) for test 1."),
        Derivation.of(eq12e, (eq10c.at({k: Integer(2)}),), (CP[2],), "Read (10c) for test 2."),
        Derivation.of(ball_mass, (volume,), (m_1,), "Integrate."),
        Derivation(
            (
                Step(
                    reduced_by_ratio, (eq8, mass_ratio), (m_red, m_1), "Divide (8) by the mass of the target."
                ),
                Step(immobile_mass, (reduced_by_ratio, immobile), (m_red, mu), "Let the mass ratio be zero."),
            )
        ),
        Derivation.of(x_m_of_test, (eq6.brief,), (m_red,), "Solve (6) for the maximum approach."),
        Derivation.of(Cprime_of_test, (eq7.brief,), (m_red,), "Solve (7) for the maximum force."),
        Derivation.of(
            root_form, (reciprocal, eq11), (u,), "Multiply (11) by (beta + 1) u.", multiplier=(beta + 1) * u
        ),
        *alpha_root.ENTRIES,
        *generated_points.ENTRIES,
        *power_law_fit.ENTRIES,
        *pair_curve.entries(eq10a, eq10c, law_c),
    ),
    checks=(
        errata.check_overlap(eq2),
        errata.check_overlap(eq3),
        errata.check_range(
            eq4, scale=2, symbol=n, known=("Tabor's plastic range of Meyer's exponent", 2, Rational(5, 2))
        ),
        errata.check_count(
            (eq10a, eq10b, eq10c), unknowns=(C, alpha, XM[k], CP[k]), claimed=(3 * k, 2 * k + 2)
        ),
        errata.check_spurious(eq11, solve_for=XP[1], approach=eq12a, condition=_margin),
        errata.check_determined("(12)", unknowns=(C, XM[1], XM[2], CP[1], CP[2])),
        errata.check_citation(errata.Citation("Table 3, row C', (eq. 6)", "(6)", Cprime)),
        errata.check_citation(errata.Citation("Table 3, row C', (eq. 8)", "(8)", Cprime)),
        errata.check_units(eq3, printed={C: None, Cprime: None}),
        errata.check_missing("Table 3", (x_m_of_test, Cprime_of_test), printed=(alpha, beta, v, e, x_p)),
        errata.check_whose(eq3, alpha, "conclusions", said="restitution"),
    ),
    vocabulary=VOCABULARY,
)
