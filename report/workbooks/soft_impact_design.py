"""Drop tests that are not made yet: what they show, if they follow the curve of those that were."""

from __future__ import annotations

from ...derivations import global_fit
from ...derivations import power_law_fit as line
from ...derivations import soft_impact as model
from ...derivations.soft_impact import LEDGER, XM, E, V
from ...derivations.symbols import VOCABULARY, k, q
from ..method.words import Method, by, given, measured, standing
from ..sheet import Sheet
from ..workbook import Design

_E, _V = "coefficient of restitution", "impact speed"


class Restitution(Method, ledger=LEDGER, rows="tests", index="q", size="n_points"):
    """Restitution as a power of the speed, through the logarithms of all tests."""

    v = measured(V, _V)
    e = measured(E, _E)
    with standing({line.x[q]: v, line.F[q]: e, line.x_ref: 1, line.F_ref: 1}):
        ln_v = by(line.log_x)
        ln_e = by(line.log_F)
        mean_ln_v = by(line.mean_X)
        mean_ln_e = by(line.mean_Y)
        e_slope = by(line.alpha_log)
        ln_e_at_1 = by(line.intercept)
        e_at_1 = by(line.log_scale, "restitution at 1 m/s", "1")


class PlannedTest(Method, ledger=global_fit.LEDGER, rows="tests", size="n_tests"):
    """A test at a planned speed."""

    v = measured(V, _V)
    e_slope = given("1", "exponent of the restitution over the speed")
    e_at_1 = given("1", "restitution at 1 m/s", positive=True)
    alpha_log = given("1", "exponent of the curve", positive=True)
    C_log = given("N/m^alpha_log", "coefficient of the curve", positive=True)
    m_red = given(VOCABULARY["m_red"], "reduced mass")
    beta = given(VOCABULARY["beta"], "exponent of the restitution law")
    with standing({model.C: e_at_1, model.x: v, model.alpha: e_slope}):
        e = by(model.law_c, "restitution by a power of the speed", "1")
    with standing({model.v: v, model.C: C_log, model.alpha: alpha_log}):
        x_m = by(model.x_m_of_test)
        with standing({E[k]: e, XM[k]: x_m}):
            x_p = by(global_fit.depth, "imprint that gives that restitution")


def design(sheet: Sheet) -> Design:
    """How planned speeds become tests: by a curve of the sheet, and by how restitution falls with speed."""
    fitted, planned = (each.workbook.sheet(frozenset()).columns for each in (Restitution, PlannedTest))
    return Design(chosen="v", fitted=fitted, planned=planned, curve=("alpha_log", "C_log"))
