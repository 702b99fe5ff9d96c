"""The workbook of the soft-impact paper: what it wants, and what a reader is shown of its sheet."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..quantity import Bounds
from ..workbook import FigureSpec, Measured, Parameter, SquareSum, TableSpec, Workbook
from .soft_impact_charts import BAND, EXPONENTS, LOOPS

if TYPE_CHECKING:
    from ...derivations.equation import Ledger
    from ..charts import Drawn
    from ..result.result import Report
    from ..sheet import Sheet
    from ..workbook import Design

__all__ = ["WORKBOOK"]

_POSITIVE = Bounds(low=0, low_open=True)

MEASURED = (
    Measured("v", "m/s", "impact speed", _POSITIVE),
    Measured("e", "1", "coefficient of restitution", Bounds(low=0, high=1)),
    Measured("x_p", "m", "imprint depth", _POSITIVE),
)
PARAMETERS = (
    Parameter("ball_diameter", "m", "diameter of the ball", _POSITIVE),
    Parameter("ball_density", "kg/m^3", "density of the ball", _POSITIVE),
    Parameter("ball_mass", "kg", "mass of the ball, instead of its diameter and density", _POSITIVE),
    Parameter("target_mass", "kg", "mass of the target; left out, the target is immobile", _POSITIVE),
    Parameter("beta", "1", "exponent of the restitution law", _POSITIVE, default="1.5"),
    Parameter(
        "points_per_pair",
        "1",
        "how many points of each pair's curve the fits get",
        Bounds(low=2, high=10000, integer=True),
        default="50",
    ),
)


def _masses_given(given: frozenset[str]) -> str | None:
    """Say what is missing or too much among the ball's parameters."""
    shape = {"ball_diameter", "ball_density"} & given
    if "ball_mass" in given and shape:
        return f"ball_mass and {' and '.join(sorted(shape))} say the same thing twice; keep one"
    if "ball_mass" not in given and len(shape) < 2:
        return "the mass of the ball is missing: give ball_mass, or ball_diameter and ball_density"
    return None


# --- what takes algebra is loaded when it is asked for ------------------------------------------------------


def _ledger() -> Ledger:
    from ...derivations.force_band import LEDGER

    return LEDGER


def _sheet(given: frozenset[str]) -> Sheet:
    from .soft_impact_sheet import sheet

    return sheet(given)


def _drawn(sheet: Sheet) -> Drawn:
    from .soft_impact_curves import columns

    return columns(sheet)


def _design(sheet: Sheet) -> Design:
    from .soft_impact_design import design

    return design(sheet)


def _drawings() -> dict[str, Callable[[Report], Any]]:
    from .soft_impact_schematics import draw_hysteresis, draw_lankarani

    return {"hysteresis": draw_hysteresis, "lankarani": draw_lankarani}


WORKBOOK = Workbook(
    name="soft_impact",
    title="Exponent of the force law from drop tests on a soft target",
    source="F C Ciornei, S Alaci, I C Romanu, M C Ciornei and G Sopon: Identification of exponent from "
    "load-deformation relation for soft materials from impact tests",
    ledger=_ledger,
    measured=MEASURED,
    parameters=PARAMETERS,
    check_parameters=_masses_given,
    sheet=_sheet,
    squares=(SquareSum("chi2_eiv", axis="tests", fitted=2, deviation="z_eiv"),),
    fits=("alpha_mean", "alpha_log", "alpha_lin"),
    headline=(
        *("alpha_eiv", "C_eiv", "chi2_eiv"),
        *("alpha_mean", "alpha_median", "alpha_log", "C_log", "alpha_lin", "C_lin"),
    ),
    prose="soft_impact",
    tables=(
        TableSpec("measured", "Impact parameters, as measured", ("v", "e", "x_p"), number="1"),
        TableSpec("alpha", "Exponent of every pair of tests", ("alpha",), number="2"),
        TableSpec(
            "tests",
            "Maximum approach and maximum force of each test on the fitted curve",
            ("x_m", "Cprime_eq7", "Cprime_eq9"),
            number="3",
        ),
        TableSpec(
            "given",
            "Ball, target and settings",
            (
                "ball_diameter",
                "ball_density",
                "ball_mass",
                "target_mass",
                "m_red",
                "beta",
                "points_per_pair",
            ),
            number="L1",
        ),
        TableSpec(
            "pairs",
            "What else follows from each pair",
            ("x_m1", "x_m2", "x_top", "C", "Cprime_1", "Cprime_2"),
            number="L2",
        ),
        TableSpec(
            "fit",
            "One curve for all tests: the mean and the two fits",
            (
                *("alpha_mean", "alpha_median", "alpha_log", "C_log", "alpha_lin", "C_lin"),
                *("x_ref", "F_ref", "mean_ln_x", "mean_ln_F", "ln_F_at_ref"),
            ),
            number="L3",
        ),
        TableSpec(
            "common",
            "The curve nearest to all tests",
            (
                *(
                    "alpha_eiv",
                    "u_alpha_eiv",
                    "u_birge_eiv",
                    "F_eiv",
                    "x_0",
                    "C_eiv",
                    "chi2_eiv",
                    "birge_eiv",
                ),
                *("trend_eiv", "u_trend_eiv", "dchi2_trend"),
            ),
            number="L4",
        ),
        TableSpec(
            "adjusted",
            "Each test on that curve: adjusted values, and how far off it was measured",
            ("v_eiv", "e_eiv", "x_p_eiv", "x_m_eiv", "R_eiv", "leverage", "z_eiv", "alpha_without"),
            number="L5",
        ),
        TableSpec(
            "slopes",
            "What the fit weighs a test by: how its depth follows from the rest, and its weight",
            ("D_eiv", "B_v_eiv", "B_e_eiv", "W_eiv", "lambda_eiv", "G_eiv", "T_eiv"),
            number="L7",
        ),
        TableSpec(
            "normal",
            "Sums of the fit over all tests, and where its search began",
            (
                *("v_0", "alpha_0", "S_DD", "S_DX", "S_XX", "Delta_eiv"),
                *("S_TT", "S_TD", "S_TX", "Q_eiv"),
            ),
            number="L8",
        ),
        TableSpec(
            "estimates",
            "Exponent of one curve for all tests, by five estimates",
            ("alpha_eiv", "alpha_mean", "alpha_median", "alpha_log", "alpha_lin"),
            number="L6",
            beside=(
                "what counts",
                (
                    ("alpha_eiv", "each test by what is known of it: the one to trust"),
                    *(
                        (name, "all pairs alike, whatever each tells")
                        for name in ("alpha_mean", "alpha_median")
                    ),
                    *((name, "points made of all pairs alike") for name in ("alpha_log", "alpha_lin")),
                ),
            ),
        ),
    ),
    figures=(
        FigureSpec(
            "hysteresis",
            "1",
            "Hysteresis loop of an impact. The hatched areas are lost to internal friction, while loading "
            "and while unloading; the grey area between them is the work of plastic deformation. The model "
            "has the grey loop alone.",
            alt="A loop of force over approach: up along the loading curve, down along the unloading curve "
            "to the imprint depth. Two hatched areas, the works of friction, enclose a grey one, the plastic "
            "work.",
            fixed=True,
        ),
        FigureSpec(
            "lankarani",
            "2",
            "Force in the model of Lankarani and Nikravesh (2): loading and unloading with the exponent 3/2.",
            alt="Force over approach: the loading curve rises from zero to the maximum approach, the "
            "unloading curve falls from there to the imprint depth.",
            fixed=True,
        ),
        FigureSpec(
            "loops",
            "4",
            "Generated points, the curve fitted through their logarithms, and the restitution curve of each "
            "test.",
            alt="Force over approach: the generated points of all pairs lie along one fitted loading curve; "
            "from it one steep unloading curve for each test falls to its imprint depth.",
            chart=LOOPS,
        ),
        FigureSpec(
            "alpha_pairs",
            "L1",
            "Exponent of every pair over the mean speed of its two tests.",
            alt="One mark for each pair of tests, its exponent over its mean speed; a line marks the mean "
            "exponent.",
            chart=EXPONENTS,
        ),
        FigureSpec(
            "band",
            "L2",
            "Force of each test beside the common curve, a band of two standard uncertainties of the curve, "
            "and one of two standard deviations of a further test.",
            alt="One mark for each test over its approach, and two pairs of lines that open to the right.",
            chart=BAND,
        ),
    ),
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
    example_parameters={"ball_mass": "8.366 g", "beta": "1.5"},
    drawn=_drawn,
    drawings=_drawings,
    design=_design,
)

sheet = WORKBOOK.sheet
"""The sheet for the names of the parameters that were given; what is given has its bounds."""
