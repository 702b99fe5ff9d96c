"""Drop tests that are not made yet: what they show, if they follow the curve of those that were."""

from __future__ import annotations

from sympy import Expr, Integer, solve

from ...derivations import power_law_fit as fit
from ...derivations import soft_impact as model
from ...derivations.equation import Equation
from ...derivations.soft_impact import XM, XP, E
from ...derivations.symbols import k, q
from ..charts import drawn
from ..sheet import Axis, Column, Formula, Given, Sheet
from ..workbook import Design
from .soft_impact_sheet import TESTS

__all__ = ["design"]

_MADE = Axis("tests", q, fit.size)
"""The tests that were made, by the index over which a power law is fitted."""


def design(sheet: Sheet, alpha: str = "alpha_log", C: str = "C_log") -> Design:
    """How planned speeds become tests: by a curve of the sheet, and by how restitution falls with speed.

    `sheet`: of the workbook; it has the cells `alpha` and `C`. `alpha` and `C`: the curve, in N and m.
    """
    given = {name: Column(name, None, Given(), sheet[name].unit) for name in (alpha, C, "m_red", "beta")}
    v, e, x_m = (Column(name, TESTS, Given(), sheet[name].unit) for name in ("v", "e", "x_m"))
    slope = Column("e_slope", None, Given(), positive=False)
    scale = Column("e_at_1", None, Given())
    (depth,) = solve(model.ratio.residuals[0], XP[k])
    where: dict[Expr, Expr] = {
        model.v: v[k], model.x_m: x_m[k], E[k]: e[k], XM[k]: x_m[k],
        model.alpha: given[alpha].symbol, model.C: given[C].symbol,
        model.beta: given["beta"].symbol, model.m_red: given["m_red"].symbol,
    }  # fmt: skip
    falls = model.law_c.at({model.C: scale.symbol, model.x: v[k], model.alpha: slope.symbol})
    return Design(
        chosen="v",
        fitted=_power_law(),
        planned=(
            v, slope, scale, *given.values(),
            drawn("e", TESTS, falls.value, "1", "restitution by a power of the speed"),
            drawn("x_m", TESTS, model.x_m_of_test.at(where).value, "m", "approach on the curve"),
            drawn("x_p", TESTS, depth.xreplace(where), "m", "imprint that gives that restitution"),
        ),
        curve=(alpha, C),
    )  # fmt: skip


def _power_law() -> tuple[Column, ...]:
    """The restitution as a power of the speed, through the logarithms of all tests: (L13) to (L19)."""
    v, e = (Column(name, _MADE, Given()) for name in ("v", "e"))
    ln_v, ln_e = (Column(name, _MADE, Given(), positive=False) for name in ("ln_v", "ln_e"))
    names = ("mean_ln_v", "mean_ln_e", "e_slope", "ln_e_at_1")
    mean_v, mean_e, slope, intercept = (Column(name, None, Given(), positive=False) for name in names)
    where = {
        fit.x[q]: v[q], fit.F[q]: e[q], fit.x_ref: Integer(1), fit.F_ref: Integer(1),
        fit.X[q]: ln_v[q], fit.Y[q]: ln_e[q], fit.Xmean: mean_v.symbol, fit.Ymean: mean_e.symbol,
        fit.a: intercept.symbol, fit.b: slope.symbol,
    }  # fmt: skip

    def own(name: str, equation: Equation, axis: Axis | None = None) -> Column:
        return Column(name, axis, Formula(equation.at(where)), positive=name == "e_at_1")

    return (
        v, e, own("ln_v", fit.log_x, _MADE), own("ln_e", fit.log_F, _MADE),
        own("mean_ln_v", fit.mean_X), own("mean_ln_e", fit.mean_Y),
        own("e_slope", fit.alpha_log), own("ln_e_at_1", fit.intercept), own("e_at_1", fit.log_scale),
    )  # fmt: skip
