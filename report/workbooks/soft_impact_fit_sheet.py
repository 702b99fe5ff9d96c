"""One curve for all tests at once: the columns of the global fit, each test with its true values."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from sympy import Expr

from ...derivations import global_fit as fit
from ...derivations.equation import Equation
from ...derivations.soft_impact import alpha as model_alpha
from ...derivations.soft_impact import eq4
from ...derivations.symbols import VOCABULARY, k
from ..quantity import Bounds
from ..sheet import Axis, Column, Formula, Given, Iterated, Limit, Sheet
from . import soft_impact_sheet
from .soft_impact_sheet import TESTS, e, v, x_p

__all__ = ["sheet"]

_CALLED = {
    "u_v": "u_v", "u_e": "u_e", "u_x": "u_x_p", "v": "v_eiv", "e": "e_eiv", "x_m": "x_m_eiv",
    "x_p": "x_p_eiv", "D": "D_eiv", "B_v": "B_v_eiv", "B_e": "B_e_eiv", "W": "W_eiv", "R": "R_eiv",
    "lam": "lambda_eiv", "x_0": "x_0", "v_0": "v_0", "F_0": "F_eiv", "alpha": "alpha_eiv",
    "C": "C_eiv", "chi2": "chi2_eiv", "u_alpha": "u_alpha_eiv", "R_B": "birge_eiv", "u_B": "u_birge_eiv",
    "z_R": "z_eiv", "alpha_0": "alpha_0",
}  # fmt: skip
"""What the quantities of the derivations are called in the sheet."""
_SCALARS = ("x_0", "v_0", "F_0", "alpha", "C", "chi2", "u_alpha", "R_B", "u_B", "alpha_0")
_ZERO = ("u_v", "u_e", "u_x", "chi2", "e")
"""What may be zero."""
_LATEX = {
    "v": r"\hat{v}'%s", "e": r"\hat{e}%s", "x_p": r"\hat{x}_{p%s}", "x_m": r"\hat{x}_{m%s}",
    "alpha": r"\alpha_{\mathrm{eiv}}", "C": r"C_{\mathrm{eiv}}", "chi2": r"\chi^2_{\mathrm{eiv}}",
    "u_alpha": r"u(\alpha_{\mathrm{eiv}})", "u_B": r"u_{\mathrm{B}}(\alpha_{\mathrm{eiv}})",
}  # fmt: skip


def sheet(given: frozenset[str]) -> Sheet:
    """The sheet of the paper, and the fit.

    Parameters
    ----------
    given : frozenset of str
        As for the sheet of the paper.
    """
    columns = _columns()
    (alpha,) = (column.cell for column in columns if column.name == "alpha_eiv")
    whole = Sheet((*soft_impact_sheet.sheet(given).columns, *columns))
    return whole.limited({"alpha_eiv": (Limit.of(eq4.at({model_alpha: alpha})),)})


def _columns() -> tuple[Column, ...]:
    made = _making(TESTS, (v, e, x_p))
    uncertain = (("u_v", v), ("u_e", e), ("u_x", x_p))
    return (
        *(
            made(like, Given("uncertainty", Bounds(low=0), own.name), display=f"like {own.name}", exact=True)
            for like, own in uncertain
        ),
        made("x_0", fit.depth_scale, display="like x_p"),
        made("v_0", fit.speed_scale, display="like v"),
        made("alpha_0", fit.first_exponent),
        made("x_m", fit.approach, display="like x_p", meaning="approach on the common curve"),
        made("x_p", fit.depth, display="like x_p", meaning="adjusted imprint depth"),
        made("D", fit.by_exponent, display="like x_p"),
        made("B_v", fit.by_speed),
        made("B_e", fit.by_restitution, display="like x_p"),
        made("W", fit.weight),
        made("R", fit.misfit, display="like x_p"),
        made("lam", fit.multiplier),
        made("v", (fit.speed, fit.speed_step, fit.VO[k]), display="like v", meaning="adjusted impact speed"),
        made("e", (fit.restitution, fit.restitution_step, fit.EO[k]), meaning="adjusted restitution"),
        made(
            "alpha",
            (fit.exponent, fit.alpha_step, VOCABULARY["alpha_0"].symbol),
            meaning="exponent of the global fit",
        ),
        made("F_0", (fit.force, fit.force_step, fit.force_start)),
        made("C", fit.coefficient, unit="N/m^alpha_eiv", meaning="coefficient of the global fit"),
        made("chi2", fit.squares, meaning="sum of squares of the global fit"),
        made("u_alpha", fit.by_adjusted),
        made("R_B", fit.birge),
        made("u_B", fit.by_scatter),
        made("z_R", fit.deviation),
    )


def _making(tests: Axis, measured: tuple[Column, ...]) -> Callable[..., Column]:
    """What makes a column: of a quantity, and an equation, or that with a step and a start."""

    def blank(like: str, **more: Any) -> Column:
        own = VOCABULARY[like]
        axis = None if like in _SCALARS else tests
        more = {
            "rule": Given(), "unit": own.unit, "meaning": own.meaning, "latex": _LATEX.get(like, own.latex),
            "positive": own.positive and like not in _ZERO, **more,
        }  # fmt: skip
        return Column(_CALLED[like], axis, **more)

    observed = (VOCABULARY[name][k] for name in ("v_obs", "e_obs", "x_obs"))
    where: dict[Expr, Expr] = {cell: own[k] for cell, own in zip(observed, measured, strict=True)}
    for like in _CALLED:
        own, cell = VOCABULARY[like], blank(like)
        where[own.symbol if like in _SCALARS else own[k]] = cell.cell

    def made(like: str, rule: Given | Equation | tuple[Equation, Expr, Expr], **more: Any) -> Column:
        if isinstance(rule, Given):
            return blank(like, rule=rule, **more)
        if isinstance(rule, Equation):
            return blank(like, rule=Formula(rule.at(where)), **more)
        equation, step, start = rule
        own = Iterated(equation.at(where | fit.least), step.xreplace(where), start.xreplace(where), _NONE)
        return blank(like, rule=own, **more)

    return made


_NONE = (
    "no law C x^alpha with a positive exponent comes near to all tests, or a test has speed, restitution and "
    "depth without uncertainty, which weighs more than all others"
)
