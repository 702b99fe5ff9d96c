"""One force law for all tests at once: errors in speeds, restitutions and depths, by maximum likelihood.

System (10) for more than two tests has more equations than unknowns. Every test then has true values, on one
curve, and measured ones beside them; the best curve and the best true values make the sum of the squares of
all deviations, each over its standard uncertainty, least. What they satisfy is written so that a computer can
put it into itself again: Gauss and Helmert's adjustment of conditions.

Source: W. E. Deming, Statistical Adjustment of Data, 1943; ISO/TS 28037:2010 for the standard uncertainty by
the adjusted points; R. T. Birge, Phys. Rev. 40 (1932) 207 for the ratio.
"""

from __future__ import annotations

from dataclasses import replace

from sympy import Abs, Expr, Function, Integer, Max, Piecewise, Rational, Sum, Symbol, diff, exp, log, sqrt
from sympy.core.parameters import evaluate

from .equation import Derivation, Equation, Kind, assume, define
from .soft_impact import LEDGER as PAPER
from .soft_impact import ratio_step, v, x_m, x_m_of_test
from .symbols import VOCABULARY, k

# fmt: off
V, E, XM, XP = (VOCABULARY[name] for name in ("v", "e", "x_m", "x_p"))
VO, EO, XO, UV, UE, UX, D, BV, BE, W, R, LAM = (
    VOCABULARY[name]
    for name in ("v_obs", "e_obs", "x_obs", "u_v", "u_e", "u_x", "D", "B_v", "B_e", "W", "R", "lam")
)
ALPHA, alpha_0, beta, m_red, C, F_0, x_0, v_0, chi2, u_alpha, R_B, u_B, G_alpha, G_F = VOCABULARY.plain(
    "alpha alpha_0 beta m_red C F_0 x_0 v_0 chi2 u_alpha R_B u_B G_alpha G_F"
)
S_DD, S_DX, S_XX, Delta = VOCABULARY.plain("S_DD S_DX S_XX Delta")
# fmt: on
n_tests = Symbol("n_tests", integer=True, positive=True)
"""How many tests there are; the sums run over all of them."""
_A = ALPHA + 1


def over_tests(terms: Expr) -> Expr:
    """The sum of the terms of all tests."""
    return Sum(terms, (k, 1, n_tests))


def in_normal_matrix(number: str, own: Symbol, slopes: Expr, name: str) -> Equation:
    """An entry of the normal matrix: the product of two changes of the depth, by weight."""
    value = over_tests(W[k] * slopes)
    return define(number, own, value, f"normal matrix: {name}")


with evaluate(False):
    depth_scale = define(
        "(L29)",
        x_0,
        over_tests(XO[k]) / n_tests,
        "mean imprint depth",
        "a depth within the data: the force there is known best",
    )

    speed_scale = define(
        "(L30)",
        v_0,
        over_tests(VO[k]) / n_tests,
        "mean impact speed",
        "a speed within the data, where the search begins",
    )

    coefficient = define(
        "(L31)",
        C,
        F_0 / x_0**ALPHA,
        "coefficient by the force at the mean depth",
        "the curve has the force F_0 at the mean depth",
    )

    approach = Equation(
        "(L32)",
        (XM[k], x_0 * (_A * m_red * V[k] ** 2 / (2 * F_0 * x_0)) ** (1 / _A)),
        "(L3) by the force at the mean depth",
        title="approach of a test on the common curve",
        defines=XM[k],
    )

    depth = Equation(
        "(L33)",
        (XP[k], XM[k] * (1 - (beta + 1) / _A * E[k] ** 2)),
        "the energy ratio, solved for the imprint depth",
        title="imprint depth of a test on the common curve",
        defines=XP[k],
    )

    by_exponent = Equation(
        "(L34)",
        (D[k], (XM[k] - XP[k] + XP[k] * (1 / _A - log(XM[k] / x_0))) / _A),
        "(L32) and (L33), differentiated by the exponent",
        title="change of the imprint depth with the exponent",
        defines=D[k],
    )

    by_speed = Equation(
        "(L35)",
        (BV[k], 2 * XP[k] / (_A * V[k])),
        "(L32) and (L33), differentiated by the speed",
        title="change of the imprint depth with the speed",
        defines=BV[k],
    )

    by_restitution = Equation(
        "(L36)",
        (BE[k], -2 * (beta + 1) / _A * E[k] * XM[k]),
        "(L33), differentiated by the restitution",
        title="change of the imprint depth with the restitution",
        defines=BE[k],
    )

    weight = define(
        "(L37)",
        W[k],
        1 / (UX[k] ** 2 + (BV[k] * UV[k]) ** 2 + (BE[k] * UE[k]) ** 2),
        "weight of a test",
        "the variance of a measured depth beside the one that follows from speed and restitution",
    )

    misfit = define(
        "(L38)",
        R[k],
        XO[k] - XP[k] - BV[k] * (VO[k] - V[k]) - BE[k] * (EO[k] - E[k]),
        "misfit of a test",
        "how far the measured depth lies beside it, along the tangent at the adjusted point",
    )

    multiplier = Equation(
        "(L39)",
        (LAM[k], W[k] * R[k]),
        "the misfit is shared among depth, speed and restitution by their variances",
        title="multiplier of a test",
        defines=LAM[k],
    )

    speed = Equation(
        "(L40)",
        (VO[k], V[k] - UV[k] ** 2 * BV[k] * LAM[k]),
        "the sum of squares is least: no other true speed makes it smaller",
        title="adjusted impact speed",
    )

    restitution = Equation(
        "(L41)",
        (EO[k], E[k] - UE[k] ** 2 * BE[k] * LAM[k]),
        "the sum of squares is least: no other true restitution makes it smaller",
        title="adjusted coefficient of restitution",
    )

    squares_D = in_normal_matrix("(L50)", S_DD, D[k] ** 2, "exponent")
    products = in_normal_matrix("(L51)", S_DX, D[k] * XP[k], "exponent and force")
    squares_X = in_normal_matrix("(L52)", S_XX, XP[k] ** 2, "force")

    determinant = define(
        "(L53)",
        Delta,
        S_DD * S_XX - S_DX**2,
        "determinant of the normal matrix",
        "zero if a larger exponent does to every depth what a smaller force does",
    )

    exponent = define(
        "(L42)",
        G_alpha,
        over_tests(LAM[k] * D[k]),
        "global fit: exponent",
        "half the slope of the sum of squares, downwards; where that is least, it is zero",
    )

    force = define(
        "(L43)",
        G_F,
        over_tests(LAM[k] * XP[k]),
        "global fit: force",
        "the same by the force, times alpha + 1; where the sum of squares is least, it is zero",
    )

    squares = define(
        "(L44)",
        chi2,
        Piecewise((over_tests(LAM[k] * R[k]), n_tests > 2), (Integer(0), True)),
        "global fit: sum of squares",
        "the squares of a test's deviations, each over its variance, add up to this; two have none",
    )

    by_adjusted = define(
        "(L45)",
        u_alpha,
        sqrt(S_XX / Delta),
        "standard uncertainty of the exponent by the adjusted points",
        "the inverse of the normal matrix at the adjusted points, for errors as stated",
    )

    birge = define(
        "(L46)",
        R_B,
        sqrt(over_tests(LAM[k] * R[k]) / (n_tests - 2)),
        "Birge ratio",
        "how many times larger the deviations are than the standard uncertainties say",
    )

    by_scatter = define(
        "(L47)",
        u_B,
        u_alpha * R_B,
        "standard uncertainty of the exponent by the scatter",
        "how far the tests scatter about the curve, whatever their standard uncertainties say",
    )

    _ln_v, _ln_x = log(VO[k] / v_0), log(XO[k] / x_0)
    speeds = over_tests(_ln_v**2)
    """How far the speeds are apart."""
    _mean_e2 = over_tests(EO[k] ** 2) / n_tests

    first_exponent = define(
        "(L49)",
        alpha_0,
        Max(
            2 * speeds / over_tests(_ln_v * _ln_x),
            Rational(3, 2),
            Rational(6, 5) * (beta + 1) * _mean_e2,
        )
        - 1,
        "first exponent of the search",
        "depths rise with the speed to the power 2/(alpha + 1), if the restitution is the same; a test "
        "of the mean restitution has to leave an imprint",
    )

# --- what leads there --------------------------------------------------------------------------------------

speed_step: Expr = VO[k] + V[k] - speed.value
restitution_step: Expr = EO[k] + E[k] - restitution.value
"""The next true values: they stay where (L38) and (L39) hold."""
bowl: Expr = Max((BE[k] / XM[k]) ** 2, 1 - UE[k] ** 2 * W[k] * R[k] * diff(by_restitution.value, E[k]))
"""Positive but where a restitution of zero is a top of a test's squares, which no step leaves, and not their
least: the second is their second derivative there, over that of the restitution's own square."""
_more_alpha, _less_force = exponent.sides[1], force.sides[1]
_step = (S_XX * _more_alpha - S_DX * _less_force) / Delta
_part = 1 / Max(1, Abs(_step) / (Rational(3, 10) * _A))
"""Of a step, where tangents lead too far: imprints that are shallow beside their approach bend so much."""
alpha_step: Expr = ALPHA + _part * _step
"""The next exponent, by least squares along the tangents: it stays where (L42) and (L43) are 0."""
force_step: Expr = F_0 * exp(_part * _A * (S_DX * _more_alpha - S_DD * _less_force) / Delta)
"""The next force, which stays positive."""
force_start: Expr = (
    (alpha_0 + 1) * m_red * v_0**2 / (2 * x_0) * (1 - (beta + 1) / (alpha_0 + 1) * _mean_e2) ** (alpha_0 + 1)
)
"""The force with which the mean test lies on a curve of the first exponent."""
least = {G_alpha: Integer(0), G_F: Integer(0)}
"""What holds at the least sum of squares."""

# --- why they hold -----------------------------------------------------------------------------------------

on_curve: Expr = depth.sides[1].xreplace({XM[k]: approach.sides[1]})
"""The imprint depth of a test by its true speed and restitution, and by the curve."""


def _slope(of: Expr, by: Expr, name: str) -> Equation:
    because = f"derivative of the imprint depth by the {name}"
    return define("", of, diff(on_curve, by), because)


_depth_of = Function("x_p")(V[k], E[k])
_squares = (
    (VO[k] - V[k]) ** 2 / UV[k] ** 2
    + (EO[k] - E[k]) ** 2 / UE[k] ** 2
    + (XO[k] - _depth_of) ** 2 / UX[k] ** 2
)
"""Those of a test, whose depth is a function of its true speed and its true restitution."""


def _least(true: Expr, slope: Expr, name: str) -> Equation:
    because = f"the squares of a test are least where their derivative by the true {name} vanishes"
    derivative = diff(_squares, true).xreplace({diff(_depth_of, true): slope}).xreplace({_depth_of: XP[k]})
    return assume((derivative, Integer(0)), because, f"normal equation of the true {name}", Kind.DEFINITION)


_least_speed = _least(V[k], BV[k], "speed")
_least_restitution = _least(E[k], BE[k], "restitution")
_multiplied = assume(
    (XO[k], XP[k] + UX[k] ** 2 * LAM[k]),
    "definition: Lagrange's multiplier of the condition that the depth lies on the curve",
    "multiplier by the depth",
    Kind.DEFINITION,
)
_curve, _cells = (depth, approach), (XP[k], XM[k])


def _entries() -> tuple[Equation | Derivation, ...]:
    """All of it, in the order of a ledger."""
    work = x_m_of_test.at({v: V[k], x_m: XM[k]})
    return (
        depth_scale,
        speed_scale,
        coefficient,
        Derivation.of(approach, (coefficient, work), (C, XM[k]), "Put the coefficient (L31) into (L3)."),
        Derivation.of(
            depth, (ratio_step.claim,), (XP[k],), "Solve the energy ratio for the depth.", after=(ratio_step,)
        ),
        *(
            Derivation.of(
                claim,
                (_slope(of, by, name), *_curve),
                (of, *_cells),
                "Differentiate (L33) with (L32) in it; what is left are the depths themselves.",
            )
            for claim, of, by, name in (
                (by_exponent, D[k], ALPHA, "exponent"),
                (by_speed, BV[k], V[k], "speed"),
                (by_restitution, BE[k], E[k], "restitution"),
            )
        ),
        weight,
        misfit,
        Derivation.of(
            multiplier,
            (_multiplied, weight, misfit, _least_speed, _least_restitution),
            (XO[k], W[k], R[k], VO[k], EO[k]),
            "Put what the normal equations say of speed and restitution into the misfit.",
        ),
        Derivation.of(
            speed, (_multiplied, _least_speed), (XO[k], VO[k]), "Solve the normal equation of the speed."
        ),
        Derivation.of(
            restitution,
            (_multiplied, _least_restitution),
            (XO[k], EO[k]),
            "Solve the normal equation of the restitution.",
        ),
        squares_D,
        products,
        squares_X,
        determinant,
        exponent,
        force,
        squares,
        by_adjusted,
        birge,
        by_scatter,
        first_exponent,
    )


LEDGER = replace(PAPER, entries=(*PAPER.entries, *_entries()))
"""The equations of the paper, then those of the fit."""
