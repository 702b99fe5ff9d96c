"""The curves of the soft-impact paper's charts: columns with formulas, the branches of (3) as derived."""

from __future__ import annotations

from typing import Any

from sympy import Expr, Symbol
from sympy.core.parameters import evaluate

from ...derivations import force_band as force
from ...derivations import soft_impact as model
from ...derivations.symbols import VOCABULARY, k
from ..charts import Drawn, drawn
from ..sheet import Axis, Column, Given, PairAxis, RepeatAxis, Sheet
from .soft_impact_fit import CALLED

__all__ = ["POINTS_PER_BRANCH", "columns"]

POINTS_PER_BRANCH = 33
"""Abscissae of each branch; straight lines between so many look like a curve."""
POINTS_PER_TEST = 5
"""Abscissae of the band below the approach of each test: all of them make one line."""

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
    band = _band(sheet, tests)
    given = {loops.count: POINTS_PER_BRANCH, band[0].name: POINTS_PER_TEST}
    return Drawn((count, x_c, F_c, x_r, F_r, mean_v, *band), given)


def _band(sheet: Sheet, tests: Axis) -> tuple[Column, ...]:
    """A band about the common curve, one for a further test, and where each test lies."""
    row, step, size = (Symbol(name, integer=True, positive=True) for name in ("b", "g", "n_bands"))
    bands = RepeatAxis("bands", row, size, of=tests, step=step, count="band_points")
    count = Column(bands.count, None, Given("chart"), meaning="points of the band for each test", exact=True)
    where: dict[Expr, Expr] = {}
    for like, name in CALLED.items():
        own, quantity = sheet[name], VOCABULARY[like]
        where[quantity.symbol if own.axis is None else quantity[k]] = own.cell
    x_m, peak, u = (VOCABULARY[like][k] for like in ("x_m", "Cprime", "u_C"))
    beside = force.beside.at(where | {peak: force.peak.at(where).value})

    def on_band(name: str, value: Expr, unit: str = "N", **more: Any) -> Column:
        return drawn(name, bands, value, unit, "band of the common curve", **more)

    x = on_band("band_x", where[x_m] * step / count.symbol, "m", display="like x_p")
    where[x_m] = x[row]
    F = on_band("band_F", force.peak.at(where).value)
    where[peak] = F[row]
    band = on_band("band_u", force.uncertain.at(where).value)
    where[u] = band[row]
    further = on_band("further_u", force.further.at(where).value)
    ends = (
        on_band(f"{side}_{own.name}", times * own[row])
        for own in (band, further)
        for side, times in (("above", 2), ("below", -2))
    )
    offset = drawn("beside", tests, beside.value, "N", beside.title)
    return (count, x, F, band, further, *ends, offset)
