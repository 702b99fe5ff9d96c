"""The curves of the soft-impact paper's charts: columns with formulas, the branches of (3) as derived."""

from __future__ import annotations

from sympy import Symbol
from sympy.core.parameters import evaluate

from ...derivations import soft_impact as model
from ..charts import Drawn, drawn
from ..sheet import Column, Given, PairAxis, RepeatAxis, Sheet

__all__ = ["POINTS_PER_BRANCH", "columns"]

POINTS_PER_BRANCH = 33
"""Abscissae of each branch; straight lines between so many look like a curve."""

_row, _step, _size = (Symbol(name, integer=True, positive=True) for name in ("l", "m", "n_loops"))


def columns(sheet: Sheet) -> Drawn:
    """The columns that the charts ask for besides those of a sheet of the soft-impact workbook."""
    tests, pairs = (sheet[name].axis for name in ("v", "alpha"))
    assert tests is not None
    assert isinstance(pairs, PairAxis)
    loops = RepeatAxis("loops", _row, _size, of=tests, step=_step, count="loop_points")
    x_m, x_p, peak = (sheet[name][tests.index] for name in ("x_m", "x_p", "Cprime_eq9"))
    C_log, alpha_log, beta = (sheet[name].symbol for name in ("C_log", "alpha_log", "beta"))
    count = Column(loops.count, None, Given("chart"), meaning="points of each branch", exact=True)
    closed = ((x_m > x_p, "a loop is drawn where the imprint is shallower than the approach"),)
    share = (_step - 1) / (count.symbol - 1)
    v = sheet["v"]
    with evaluate(False):
        up, down, speed = x_m * share, x_p + (x_m - x_p) * share, (v[pairs.first] + v[pairs.second]) / 2
    x_c, x_r = (
        drawn(f"{way}ing_x", loops, x, "m", f"approach while {way}ing", display="like x_p", requires=closed)
        for way, x in (("load", up), ("unload", down))
    )
    compression = {model.x: x_c[_row], model.C: C_log, model.alpha: alpha_log}
    # The maximum force is that of (9): it is the continuity of (3), so that the loop closes on the fit.
    restitution = {model.x: x_r[_row], model.Cprime: peak, model.beta: beta, model.x_m: x_m, model.x_p: x_p}
    F_c, F_r = (
        drawn(f"{way}ing_F", loops, law.at(where).value, "N", f"force while {way}ing", requires=closed)
        for way, law, where in (("load", model.law_c, compression), ("unload", model.law_r, restitution))
    )
    mean_v = drawn("mean_v", pairs, speed, "m/s", "mean impact speed of the pair", display="like v")
    return Drawn((count, x_c, F_c, x_r, F_r, mean_v), {loops.count: POINTS_PER_BRANCH})
