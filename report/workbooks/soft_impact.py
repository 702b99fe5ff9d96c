"""The workbook of the soft-impact paper: its equations, laid out over tests, pairs and points.

Every equation stands in ``derivations/``, with its proof. Here is said which cells its symbols are, and what
a reader is shown of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from sympy import Integer, Max, Min, Ne, Or, Rational
from sympy.core.parameters import evaluate

from ...derivations import alpha_root
from ...derivations import fit_checks as checks
from ...derivations import force_band as force
from ...derivations import generated_points as points
from ...derivations import global_fit as fit
from ...derivations import pair_curve as curve
from ...derivations import power_law_fit as line
from ...derivations import soft_impact as model
from ...derivations.soft_impact import CP, XM, XP, E, V
from ...derivations.symbols import VOCABULARY as WORDS
from ...derivations.symbols import k, p
from ..charts import BLUE, VERMILION
from ..method.words import (
    Method,
    by,
    drawing,
    expected,
    given,
    measured,
    numbered,
    pairs,
    plot,
    sketch,
    standing,
    table,
    trace,
    uncertainty,
    unknown,
)
from ..workbook import SquareSum

if TYPE_CHECKING:
    from ..result.result import Report
    from ..sheet import Sheet
    from ..workbook import Design

APART = Rational(104, 100)
"""The least ratio of two speeds. One per cent of an imprint depth moves the exponent of a pair by some
.01 (alpha + 1)^2/(2 ln(v_2/v_1)), if the restitution is the same: at alpha = 1, the lower end of (4), by its
whole width at 4 %."""
NEAR = f"speeds within {100 * (APART - 1)} %: too near for averages and fits"
_APART = Max(V[1], V[2]) >= APART * Min(V[1], V[2])
_FALLS = (E[2] - E[1]) * (V[2] - V[1]) <= 0
_TWO_TESTS = Or(*(Ne(quantity[1], quantity[2]) for quantity in (V, E, XP)))

# Of the fit to all tests: what is left of a difference, as a part of what it was made of, is more than
# rounding from here on; the same of a trend, which is a difference of what was made of such differences; and
# more than rounding makes of the logarithms of equal speeds, squared and added.
_LEAST, _LEFT, _NOTHING = (Rational(1, 2**bits) for bits in (30, 20, 48))
_OTHERS = (1 - checks.H[k] > checks.FREE, "the other tests alone tell no curve")
_BOWL = "a restitution of zero is so uncertain that a larger one fits better"
_NONE = (
    "no power law with a positive exponent comes near to all tests, or a test has speed, restitution and "
    f"depth without uncertainty, which weighs more than all others, or {_BOWL}: state one above zero"
)


class SoftImpact(
    Method,
    source="F C Ciornei, S Alaci, I C Romanu, M C Ciornei and G Sopon: Identification of exponent from "
    "load-deformation relation for soft materials from impact tests",
    headline="alpha_eiv C_eiv chi2_eiv alpha_mean alpha_median alpha_log C_log alpha_lin C_lin",
    ledger=force.LEDGER,
    prose="soft_impact",
    rows="tests",
    size="n_tests",
):
    """Exponent of the force law from drop tests on a soft target."""

    v = measured(V, "impact speed", positive=True)
    e = measured(E, "coefficient of restitution", low=0, high=1)
    x_p = measured(XP, "imprint depth", positive=True)
    beta = given(
        WORDS["beta"], "exponent of the restitution law", positive=True, default="1.5", exact=True,
        example="1.5",
    )  # fmt: skip
    ball_diameter = given(WORDS["d"], "diameter of the ball", positive=True, optional=True)
    ball_density = given(WORDS["rho"], "density of the ball", positive=True, optional=True)
    with standing({model.d: ball_diameter, model.rho: ball_density}):
        ball_mass = given(
            "g", "mass of the ball", positive=True, latex="m_1", otherwise=model.ball_mass,
            asked="mass of the ball, instead of its diameter and density", example="8.366 g",
        )  # fmt: skip
        target_mass = given(
            "g", "mass of the target", positive=True, latex="m_2", optional=True,
            asked="mass of the target; left out, the target is immobile",
        )  # fmt: skip
        with standing({model.m_1: ball_mass, model.m_2: target_mass}):
            m_red = by(model.eq8, "reduced mass", "g", otherwise=model.immobile_mass)
    points_per_pair = given(
        "1", "points of each pair's curve", asked="how many points of each pair's curve the fits get",
        low=2, high=10000, positive=True, whole=True, default="50", exact=True, latex="N",
    )  # fmt: skip

    # --- two tests, and the points between them ----------------------------------------------------------

    first, second = pairs(index="p", size="n_pairs")
    with standing(
        {V[1]: first(v), E[1]: first(e), XP[1]: first(x_p)},
        {V[2]: second(v), E[2]: second(e), XP[2]: second(x_p)},
    ):
        alpha = by(
            model.eq11,
            needs=(_TWO_TESTS, "two equal tests are one; every exponent fits them"),
            root=alpha_root.ISOLATED,
            none="no exponent above 0 gives both tests a positive approach on one loading curve; "
            "the imprint does not deepen with the speed, or deepens too steeply for what is given back",
            two="e rises with the speed, and the two tests alone cannot tell which exponent is meant",
        )
        expected(model.eq4, alpha)
        expected(_FALLS, alpha, says="e rises with the speed")
        expected(_APART, alpha, says=NEAR, silent=True)
        x_m2 = by(model.eq12a, "approach of the pair's second test", latex=r"x_{m_2%s}")
        x_m1 = by(model.eq12b, "approach of the pair's first test", latex=r"x_{m_1%s}")
        C = by(model.eq12c)
        peaks = curve.peak.at({k: Integer(1)}), curve.peak.at({k: Integer(2)})
        Cprime_1 = by(peaks[0], "maximum force of the pair's first test", latex="C'_{1%s}")
        Cprime_2 = by(peaks[1], "maximum force of the pair's second test", latex="C'_{2%s}")
        # A pair that tells no exponent has no points; averages look at the points, and leave it out, too.
        x_top = by(points.top, needs=(_APART, NEAR))
        alpha_mean = by(points.mean, over=x_top)
        alpha_median = by(points.middle, over=x_top)
        s = numbered("points", points_per_pair, of=x_top, index="q", size="n_points", step="s")
        with standing({points.N: points_per_pair, CP[p]: Cprime_2}):
            x = by(points.abscissa, "approach of a generated point")
            F = by(curve.on_curve, "force of a generated point")
            x_ref = by(points.x_scale)
            F_ref = by(points.F_scale, over=x_top)
            ln_x = by(line.log_x)
            ln_F = by(curve.log_force)
            mean_ln_x = by(line.mean_X, "mean of X")
            mean_ln_F = by(line.mean_Y, "mean of Y")
            alpha_log = by(
                line.alpha_log, "exponent of the log-log fit", latex=r"\alpha_{\log}", positive=True
            )
            ln_F_at_ref = by(line.intercept, "intercept of the log-log fit")
            C_log = by(line.log_scale, "coefficient of the log-log fit", "N/m^alpha_log", latex=r"C_{\log}")
            alpha_lin = unknown(positive=True)
            with standing({line.alpha: alpha_lin}):
                alpha_lin = by(
                    line.alpha_lin, "exponent of the least squares of force", latex=r"\alpha_{\mathrm{lin}}",
                    root={"low": Rational(1, 10), "high": 5, "start": alpha_log, "steps": 8},
                    none="the best power of the points lies outside 0.1 to 5",
                )  # fmt: skip
                C_lin = by(
                    line.lin_scale, "coefficient of the least squares of force", "N/m^alpha_lin",
                    latex=r"C_{\mathrm{lin}}",
                )  # fmt: skip

    # --- each test on the curve through the logarithms -----------------------------------------------------

    with standing({model.C: C_log, model.alpha: alpha_log, model.v: v, model.e: e, model.x_p: x_p}):
        x_m = by(model.x_m_of_test)
        Cprime_eq7 = by(
            model.Cprime_of_test, "maximum force, from the restitution (7)", latex=r"C'_{\text{(7)}%s}",
            needs=(model.x_m > model.x_p, "the imprint is not shallower than the approach"),
        )  # fmt: skip
        Cprime_eq9 = by(
            model.eq9.reversed, "maximum force, from the compression (9)", latex=r"C'_{\text{(9)}%s}"
        )

    # Hysteresis loops, for charts alone.

    loop_points = sketch(33, "points of each branch")
    m = numbered("loops", loop_points, of=x_m, index="l", size="n_loops", step="m")
    closed = (x_m > x_p, "a loop is drawn where the imprint is shallower than the approach")
    share = (m - 1) / (loop_points - 1)
    with evaluate(False):
        up, down, speed = x_m * share, x_p + (x_m - x_p) * share, (first(v) + second(v)) / 2
    loading_x = sketch(up, "approach while loading", "m", needs=closed)
    with standing({model.x: loading_x, model.C: C_log, model.alpha: alpha_log}):
        loading_F = sketch(model.law_c, "force while loading", needs=closed)
    unloading_x = sketch(down, "approach while unloading", "m", needs=closed)
    # The maximum force is that of (9): it is the continuity of (3), so that the loop closes on the fit.
    with standing({model.x: unloading_x, model.Cprime: Cprime_eq9, model.x_m: x_m, model.x_p: x_p}):
        unloading_F = sketch(model.law_r, "force while unloading", needs=closed)
    mean_v = sketch(speed, "mean impact speed of the pair", "m/s")

    # --- one curve for all tests at once, each with its true values ----------------------------------------

    u_v = uncertainty(v, WORDS["u_v"])
    u_e = uncertainty(e, WORDS["u_e"])
    u_x_p = uncertainty(x_p, WORDS["u_x"])
    v_eiv, e_eiv = unknown(of=v, positive=True), unknown(of=v)
    alpha_eiv, F_eiv = unknown(positive=True), unknown(positive=True)
    with standing(
        {fit.VO[k]: v, fit.EO[k]: e, fit.XO[k]: x_p, fit.UV[k]: u_v, fit.UE[k]: u_e, fit.UX[k]: u_x_p},
        {V[k]: v_eiv, E[k]: e_eiv, fit.ALPHA: alpha_eiv, fit.F_0: F_eiv, **fit.least},
    ):
        x_0 = by(fit.depth_scale)
        v_0 = by(fit.speed_scale)
        alpha_0 = by(
            fit.first_exponent,
            needs=(fit.speeds > _NOTHING, "all tests are at one speed, which tells no exponent"),
        )
        x_m_eiv = by(fit.approach, "approach on the common curve", latex=r"\hat{x}_{m%s}")
        x_p_eiv = by(fit.depth, "adjusted imprint depth", latex=r"\hat{x}_{p%s}", positive=False)
        D_eiv = by(fit.by_exponent)
        B_v_eiv = by(fit.by_speed, positive=False)
        B_e_eiv = by(fit.by_restitution)
        W_eiv = by(fit.weight)
        R_eiv = by(fit.misfit)
        lambda_eiv = by(fit.multiplier, needs=(fit.bowl > 0, _BOWL))
        S_DD = by(fit.squares_D, positive=False)
        S_DX = by(fit.products)
        S_XX = by(fit.squares_X)
        Delta_eiv = by(
            fit.determinant,
            needs=(
                fit.determinant.value > fit.S_DD * fit.S_XX * _LEAST,
                "the tests tell no exponent: all are at one speed, or but one of them counts",
            ),
            positive=False,
        )
        v_eiv = by(
            fit.speed, "adjusted impact speed", latex=r"\hat{v}'%s",
            step=fit.speed_step, start=fit.VO[k], none=_NONE,
        )  # fmt: skip
        e_eiv = by(
            fit.restitution, "adjusted restitution", latex=r"\hat{e}%s", positive=False,
            step=fit.restitution_step, start=fit.EO[k], none=_NONE,
        )  # fmt: skip
        alpha_eiv = by(
            fit.exponent, "exponent of the global fit", latex=r"\alpha_{\mathrm{eiv}}",
            step=fit.alpha_step, start=alpha_0, none=_NONE,
        )  # fmt: skip
        F_eiv = by(fit.force, step=fit.force_step, start=fit.force_start, none=_NONE)
        C_eiv = by(
            fit.coefficient, "coefficient of the global fit", "N/m^alpha_eiv", latex=r"C_{\mathrm{eiv}}"
        )
        chi2_eiv = by(
            fit.squares, "sum of squares of the global fit", latex=r"\chi^2_{\mathrm{eiv}}", positive=False
        )
        u_alpha_eiv = by(fit.by_adjusted, latex=r"u(\alpha_{\mathrm{eiv}})", is_u=True)
        birge_eiv = by(
            fit.birge, needs=(fit.n_tests > 2, "two tests lie on one curve, so that nothing is left over"),
            spare=True, positive=False,
        )  # fmt: skip
        u_birge_eiv = by(
            fit.by_scatter, latex=r"u_{\mathrm{B}}(\alpha_{\mathrm{eiv}})", is_u=True, positive=False
        )
        leverage = by(checks.leverage, positive=False)
        z_eiv = by(checks.deviation, needs=_OTHERS, spare=True)
        alpha_without = by(checks.without, needs=_OTHERS, spare=True)
        G_eiv = by(checks.trend_of_approach)
        T_eiv = by(checks.trend_of_depth)
        S_TT = by(checks.squares_T, positive=False)
        S_TD = by(checks.trend_with_exponent)
        S_TX = by(checks.trend_by_depth)
        Q_eiv = by(
            checks.projected,
            needs=(checks.projected.value > checks.S_TT * _LEFT, "tests at two speeds tell no trend"),
            spare=True, positive=False,
        )  # fmt: skip
        trend_eiv = by(checks.trend)
        u_trend_eiv = by(checks.uncertain_trend, is_u=True)
        dchi2_trend = by(checks.taken_off, positive=False)

        # How sure its force is, for charts alone.
        band = "band of the common curve"
        band_points = sketch(5, "points of the band for each test")
        g = numbered("bands", band_points, of=x_m_eiv, index="b", size="n_bands", step="g")
        band_x = sketch(x_m_eiv * g / band_points, band, "m")
        with standing({XM[k]: band_x}):
            band_F = sketch(force.peak, band)
            band_u = sketch(force.uncertain, band)
            further_u = sketch(force.further, band)
        above_band_u = sketch(2 * band_u, band, "N")
        below_band_u = sketch(-2 * band_u, band, "N")
        above_further_u = sketch(2 * further_u, band, "N")
        below_further_u = sketch(-2 * further_u, band, "N")
        with standing({CP[k]: force.peak}):
            beside = sketch(force.beside, force.beside.title)

    expected(model.eq4, alpha_mean, alpha_median, alpha_log, alpha_lin, alpha_eiv)
    expected((0.1, 20), v, says="a speed of no drop test: a fall of less than 0.5 mm, or of more than 20 m")
    expected((10, 23000), ball_density, says="lighter than foam, or denser than osmium")
    expected(x_p <= ball_diameter / 2, x_p, says="deeper than the radius of the ball")

    # --- what a reader is shown ----------------------------------------------------------------------------

    table("Impact parameters, as measured", v, e, x_p, name="measured", number="1")
    table("Exponent of every pair of tests", alpha, name="alpha", number="2")
    table(
        "Maximum approach and maximum force of each test on the fitted curve", x_m, Cprime_eq7, Cprime_eq9,
        name="tests", number="3",
    )  # fmt: skip
    table(
        "Ball, target and settings", ball_diameter, ball_density, ball_mass, target_mass, m_red, beta,
        points_per_pair, name="given", number="L1",
    )  # fmt: skip
    table(
        "What else follows from each pair", x_m1, x_m2, x_top, C, Cprime_1, Cprime_2, name="pairs",
        number="L2",
    )  # fmt: skip
    table(
        "One curve for all tests: the mean and the two fits", alpha_mean, alpha_median, alpha_log, C_log,
        alpha_lin, C_lin, x_ref, F_ref, mean_ln_x, mean_ln_F, ln_F_at_ref, name="fit", number="L3",
    )  # fmt: skip
    table(
        "The curve nearest to all tests", alpha_eiv, u_alpha_eiv, u_birge_eiv, F_eiv, x_0, C_eiv, chi2_eiv,
        birge_eiv, trend_eiv, u_trend_eiv, dchi2_trend, name="common", number="L4",
    )  # fmt: skip
    table(
        "Each test on that curve: adjusted values, and how far off it was measured", v_eiv, e_eiv, x_p_eiv,
        x_m_eiv, R_eiv, leverage, z_eiv, alpha_without, name="adjusted", number="L5",
    )  # fmt: skip
    table(
        "What the fit weighs a test by: how its depth follows from the rest, and its weight", D_eiv, B_v_eiv,
        B_e_eiv, W_eiv, lambda_eiv, G_eiv, T_eiv, name="slopes", number="L7",
    )  # fmt: skip
    table(
        "Sums of the fit over all tests, and where its search began", v_0, alpha_0, S_DD, S_DX, S_XX,
        Delta_eiv, S_TT, S_TD, S_TX, Q_eiv, name="normal", number="L8",
    )  # fmt: skip
    table(
        "Exponent of one curve for all tests, by five estimates",
        alpha_eiv,
        alpha_mean,
        alpha_median,
        alpha_log,
        alpha_lin,
        name="estimates",
        number="L6",
        beside=(
            "what counts",
            {
                alpha_eiv: "each test by what is known of it: the one to trust",
                alpha_mean: "all pairs alike, whatever each tells",
                alpha_median: "all pairs alike, whatever each tells",
                alpha_log: "points made of all pairs alike",
                alpha_lin: "points made of all pairs alike",
            },
        ),
    )

    drawing(
        "hysteresis",
        "Hysteresis loop of an impact. The hatched areas are lost to internal friction, while loading and "
        "while unloading; the grey area between them is the work of plastic deformation. The model has the "
        "grey loop alone.",
        number="1",
        alt="A loop of force over approach: up along the loading curve, down along the unloading curve to "
        "the imprint depth. Two hatched areas, the works of friction, enclose a grey one, the plastic "
        "work.",
    )
    drawing(
        "lankarani",
        "Force in the model of Lankarani and Nikravesh (2): loading and unloading with the exponent 3/2.",
        number="2",
        alt="Force over approach: the loading curve rises from zero to the maximum approach, the unloading "
        "curve falls from there to the imprint depth.",
    )
    plot(
        trace(x, F, "points of %s", "points", VERMILION),
        trace(unloading_x, unloading_F, "restitution of %s", each=True),
        trace(loading_x, loading_F, "compression fitted to them, alpha", value=alpha_log),
        title="generated points, fitted curve, hysteresis loops",
        labels=("approach x", "force F"),
        name="loops",
        number="4",
        caption="Generated points, the curve fitted through their logarithms, and the restitution curve of "
        "each test.",
        alt="Force over approach: the generated points of all pairs lie along one fitted loading curve; "
        "from it one steep unloading curve for each test falls to its imprint depth.",
        from_zero=True,
        whole=False,
        height=10,
    )
    # One power law for all speeds would scatter the pairs about a level. The mean speed is the one that a
    # pair speaks for: on the paper's data the exponents climb with it without exception.
    plot(
        trace(mean_v, alpha_mean, "mean"),
        trace(mean_v, alpha, "%s", "points", BLUE, named=True),
        title="exponent of every pair",
        labels=("mean impact speed of the pair", "exponent alpha of the pair"),
        name="alpha_pairs",
        number="L1",
        caption="Exponent of every pair over the mean speed of its two tests.",
        alt="One mark for each pair of tests, its exponent over its mean speed; a line marks the mean "
        "exponent.",
        whole=False,
    )
    # One power law leaves most of the tests within the outer band.
    _further, _curve = "two standard deviations of a further test", "two standard uncertainties of the curve"
    plot(
        trace(band_x, above_further_u, _further, colour=BLUE),
        trace(band_x, below_further_u, _further, colour=BLUE),
        trace(band_x, above_band_u, _curve, colour=VERMILION),
        trace(band_x, below_band_u, _curve, colour=VERMILION),
        trace(x_m_eiv, beside, "%s", "points", named=True),
        title="force beside the common curve",
        labels=("approach x", "force beside the common curve"),
        name="band",
        number="L2",
        caption="Force of each test beside the common curve, a band of two standard uncertainties of the "
        "curve, and one of two standard deviations of a further test.",
        alt="One mark for each test over its approach, and two pairs of lines that open to the right.",
        whole=False,
    )


def _drawings() -> dict[str, Callable[[Report], Any]]:
    from .soft_impact_schematics import draw_hysteresis, draw_lankarani

    return {"hysteresis": draw_hysteresis, "lankarani": draw_lankarani}


def _design(sheet: Sheet) -> Design:
    from .soft_impact_design import design

    return design(sheet)


_BETA, *_BODIES, _POINTS = SoftImpact.workbook.parameters
WORKBOOK = replace(
    SoftImpact.workbook,
    parameters=(*_BODIES, _BETA, _POINTS),  # in the order in which they are typed
    least=2,
    squares=(
        SquareSum(
            "chi2_eiv",
            axis="tests",
            fitted=2,
            deviation="z_eiv",
            residual="R_eiv",
            weight="W_eiv",
            by_scatter={"alpha_eiv": "u_birge_eiv"},
        ),
    ),
    fits=("alpha_mean", "alpha_log", "alpha_lin"),
    published_as={
        "Table 2": "exponent of every pair",
        "Table 3": "maximum approach and maximum force",
        "text": "the two averages in the text",
    },
    # Made from (6), (7) and (9) with alpha = 1.3, C = 9.6e8 N/m^1.3 and 8.366 g, then printed.
    example=(
        ("test", "v [m/s]", "e [1]", "x_p [um]"),
        ("1", "2.200", "0.5350", "22.58"),
        ("2", "3.100", "0.5050", "31.92"),
        ("3", "4.300", "0.4700", "44.61"),
    ),
    drawings=_drawings,
    design=_design,
)
sheet = WORKBOOK.sheet
"""The sheet for the names of the parameters that were given; what is given has its bounds."""
MEASURED, PARAMETERS = WORKBOOK.measured, WORKBOOK.parameters
