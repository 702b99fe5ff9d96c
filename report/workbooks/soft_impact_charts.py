"""What the soft-impact workbook wants drawn as native charts: figure 4, and the exponents of the pairs.

The points of every curve are columns with formulas: the branches of (3) as the derivations write them.
"""

from __future__ import annotations

from sympy import Expr, Integer, Symbol
from sympy.core.parameters import evaluate

from ...derivations import soft_impact as model
from ...derivations.equation import Equation, Kind
from ..charts import Chart, Drawn, Series
from ..sheet import Column, Formula, Given, PairAxis, RepeatAxis, Sheet

__all__ = ["POINTS_PER_BRANCH", "drawn"]

POINTS_PER_BRANCH = 41
"""Abscissae of each branch; straight lines between so many look like a curve."""

_row, _step, _size = (Symbol(name, integer=True, positive=True) for name in ("l", "m", "n_loops"))


def drawn(sheet: Sheet) -> Drawn:
    """The columns and charts for a sheet of the soft-impact workbook.

    Parameters
    ----------
    sheet : Sheet
    """
    tests, pairs, points = (sheet[name].axis for name in ("v", "alpha", "x"))
    assert tests is not None
    assert points is not None
    assert isinstance(pairs, PairAxis)
    loops = RepeatAxis("loops", _row, _size, of=tests, step=_step, count="loop_points")
    x_m, x_p, peak = (sheet[name][tests.index] for name in ("x_m", "x_p", "Cprime_eq9"))
    C_log, alpha_log, beta = (sheet[name].symbol for name in ("C_log", "alpha_log", "beta"))
    closed = ((x_m > x_p, "a loop is drawn where the imprint is shallower than the approach"),)

    def column(name: str, equation: Equation, like: str, meaning: str, unit: str) -> Column:
        return Column(
            name,
            loops,
            Formula(equation),
            unit,
            meaning,
            display=f"like {like}",
            positive=False,
            requires=closed,
        )

    x_c, x_r = (
        Column(name, loops, Formula(model.law_c), "m", positive=False)
        for name in ("loading_x", "unloading_x")
    )
    share = (_step - 1) / Integer(POINTS_PER_BRANCH - 1)
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
    copies = [
        Column(
            name,
            axis,
            Formula(_definition(sheet[of][axis.index], "what has no value is left out of the chart")),
            sheet[of].unit,
            f"{of}, for the chart",
            display=f"like {of}",
            positive=False,
        )
        for name, of, axis in (
            ("plotted_x", "x", points),
            ("plotted_F", "F", points),
            ("plotted_alpha", "alpha", pairs),
        )
    ]
    columns = (
        Column(loops.count, None, Given("chart"), meaning="points of each branch", exact=True),
        column("loading_x", up, "x_m", "approach while loading", "m"),
        column("loading_F", compression, "Cprime_eq9", "force while loading, on the fitted curve", "N"),
        column("unloading_x", down, "x_m", "approach while unloading", "m"),
        column("unloading_F", restitution, "Cprime_eq9", "force while unloading", "N"),
        *copies,
        Column("plotted_v", pairs, Formula(speed), "m/s", "mean impact speed of the pair", display="like v"),
    )
    law = Chart(
        "Figure 4: generated points, fitted curve, hysteresis loops",
        "approach x",
        "force F",
        (
            Series("generated points", "plotted_x", "plotted_F", "points"),
            Series("restitution, test %s", "unloading_x", "unloading_F", "branch", split=True),
            Series("compression, fitted", "loading_x", "loading_F", "line", split=True),
        ),
        from_zero=True,
    )
    exponents = Chart(
        "Exponent of every pair",
        "mean impact speed of the pair",
        "exponent α",
        (Series("pairs", "plotted_v", "plotted_alpha", "points"),),
    )
    return Drawn(columns, (law, exponents), {loops.count: POINTS_PER_BRANCH})


def _definition(value: Expr, because: str) -> Equation:
    return Equation("", (Symbol("drawn"), value), because, Kind.DEFINITION, "for the chart")
