"""The charts of the soft-impact paper's data: figure 4, and the exponent of every pair.

The points of every curve are columns with formulas: the branches of (3) as the derivations write them.
"""

from __future__ import annotations

from sympy import Expr, Symbol
from sympy.core.parameters import evaluate

from ...derivations import soft_impact as model
from ...derivations.equation import Equation, Kind
from ..charts import BLUE, VERMILION, Chart, Drawn, Series
from ..sheet import Column, Formula, Given, PairAxis, RepeatAxis, Sheet

__all__ = ["EXPONENTS", "LOOPS", "POINTS_PER_BRANCH", "drawn"]

POINTS_PER_BRANCH = 33
"""Abscissae of each branch; straight lines between so many look like a curve."""

LOOPS = Chart(
    "generated points, fitted curve, hysteresis loops",
    "approach x",
    "force F",
    (
        Series("x", "F", "points of %s", "points", VERMILION),
        Series("unloading_x", "unloading_F", "restitution of %s", each=True),
        Series("loading_x", "loading_F", "compression fitted to them, alpha", value="alpha_log"),
    ),
    from_zero=True,
    height=10,
)
EXPONENTS = Chart(
    "exponent of every pair",
    "mean impact speed of the pair",
    "exponent alpha of the pair",
    (
        Series("mean_v", "alpha_mean", "mean", "level"),
        Series("mean_v", "alpha", "%s", "points", BLUE, named=True),
    ),
)
"""One power law for all speeds would scatter the pairs about a level. The mean speed is the one that a pair
speaks for: on the paper's data the exponents climb with it without exception."""

_row, _step, _size = (Symbol(name, integer=True, positive=True) for name in ("l", "m", "n_loops"))


def drawn(sheet: Sheet) -> Drawn:
    """The columns that the charts ask for besides those of a sheet of the soft-impact workbook.

    Parameters
    ----------
    sheet : Sheet
    """
    tests, pairs = (sheet[name].axis for name in ("v", "alpha"))
    assert tests is not None
    assert isinstance(pairs, PairAxis)
    loops = RepeatAxis("loops", _row, _size, of=tests, step=_step, count="loop_points")
    x_m, x_p, peak = (sheet[name][tests.index] for name in ("x_m", "x_p", "Cprime_eq9"))
    C_log, alpha_log, beta = (sheet[name].symbol for name in ("C_log", "alpha_log", "beta"))
    count = Column(loops.count, None, Given("chart"), meaning="points of each branch", exact=True)
    closed = ((x_m > x_p, "a loop is drawn where the imprint is shallower than the approach"),)

    def column(name: str, equation: Equation, meaning: str, unit: str, display: str = "") -> Column:
        rule = Formula(equation)
        return Column(name, loops, rule, unit, meaning, display=display, positive=False, requires=closed)

    x_c, x_r = (
        Column(name, loops, Formula(model.law_c), "m", positive=False)
        for name in ("loading_x", "unloading_x")
    )
    share = (_step - 1) / (count.symbol - 1)
    with evaluate(False):
        up = _definition(x_m * share, "equal parts of the way to the maximum approach")
        down = _definition(
            x_p + (x_m - x_p) * share, "equal parts of the way from the imprint to the maximum approach"
        )
        speed = _definition(
            (sheet["v"][pairs.first] + sheet["v"][pairs.second]) / 2, "mean speed of the pair's tests"
        )
    compression = model.law_c.at(
        {model.x: x_c[_row], model.C: C_log, model.alpha: alpha_log, model.F: Symbol("F")}
    )
    # The maximum force is that of (9): it is the continuity of (3), so that the loop closes on the fit.
    restitution = model.law_r.at(
        {
            model.x: x_r[_row], model.Cprime: peak, model.beta: beta, model.x_m: x_m, model.x_p: x_p,
            model.F: Symbol("F"),
        }
    )  # fmt: skip
    columns = (
        count,
        column("loading_x", up, "approach while loading", "m", "like x_p"),
        column("loading_F", compression, "force while loading, on the fitted curve", "N"),
        column("unloading_x", down, "approach while unloading", "m", "like x_p"),
        column("unloading_F", restitution, "force while unloading", "N"),
        Column("mean_v", pairs, Formula(speed), "m/s", "mean impact speed of the pair", display="like v"),
    )
    return Drawn(columns, {loops.count: POINTS_PER_BRANCH})


def _definition(value: Expr, because: str) -> Equation:
    return Equation("", (Symbol("drawn"), value), because, Kind.DEFINITION, "for the chart")
