"""One curve for all tests at once: the columns of the global fit, each test with its true values."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from sympy import Expr, Rational, Rel

from ...derivations import fit_checks as checks
from ...derivations import global_fit as fit
from ...derivations.equation import Equation
from ...derivations.symbols import VOCABULARY, k
from ..quantity import Bounds
from ..sheet import Axis, Column, Formula, Given, Iterated

__all__ = ["CALLED", "columns"]

CALLED = {
    "u_v": "u_v", "u_e": "u_e", "u_x": "u_x_p", "v": "v_eiv", "e": "e_eiv", "x_m": "x_m_eiv",
    "x_p": "x_p_eiv", "D": "D_eiv", "B_v": "B_v_eiv", "B_e": "B_e_eiv", "W": "W_eiv", "R": "R_eiv",
    "lam": "lambda_eiv", "x_0": "x_0", "v_0": "v_0", "F_0": "F_eiv", "alpha": "alpha_eiv",
    "C": "C_eiv", "chi2": "chi2_eiv", "u_alpha": "u_alpha_eiv", "R_B": "birge_eiv", "u_B": "u_birge_eiv",
    "z_R": "z_eiv", "alpha_0": "alpha_0",
    "h": "leverage", "alpha_k": "alpha_without", "G": "G_eiv", "T": "T_eiv", "S_TT": "S_TT", "S_TD": "S_TD",
    "S_TX": "S_TX", "Q": "Q_eiv", "tau": "trend_eiv", "u_tau": "u_trend_eiv", "dchi2": "dchi2_trend",
    "S_DD": "S_DD", "S_DX": "S_DX", "S_XX": "S_XX", "Delta": "Delta_eiv",
}  # fmt: skip
"""What the quantities of the derivations are called in the sheet."""
_SCALARS = (
    *("x_0", "v_0", "F_0", "alpha", "C", "chi2", "u_alpha", "R_B", "u_B", "alpha_0"),
    *("S_DD", "S_DX", "S_XX", "Delta", "S_TT", "S_TD", "S_TX", "Q", "tau", "u_tau", "dchi2"),
)
_ZERO = (
    *("u_v", "u_e", "u_x", "chi2", "e", "S_DD", "Delta", "h", "S_TT", "Q", "dchi2", "R_B", "u_B"),
    *("x_p", "B_v"),  # on the way to a fit of nearly elastic tests; there they are positive
)
"""What may be zero."""
_LATEX = {
    "v": r"\hat{v}'%s", "e": r"\hat{e}%s", "x_p": r"\hat{x}_{p%s}", "x_m": r"\hat{x}_{m%s}",
    "alpha": r"\alpha_{\mathrm{eiv}}", "C": r"C_{\mathrm{eiv}}", "chi2": r"\chi^2_{\mathrm{eiv}}",
    "u_alpha": r"u(\alpha_{\mathrm{eiv}})", "u_B": r"u_{\mathrm{B}}(\alpha_{\mathrm{eiv}})",
}  # fmt: skip


def columns(tests: Axis, measured: tuple[Column, Column, Column]) -> tuple[Column, ...]:
    """The columns of the fit.

    `measured`: speed, restitution and imprint depth of a test.
    """
    made = _making(tests, measured)
    uncertain = zip(("u_v", "u_e", "u_x"), measured, strict=True)
    return (
        *(
            made(like, Given("uncertainty", Bounds(low=0), own.name), display=f"like {own.name}", exact=True)
            for like, own in uncertain
        ),
        made("x_0", fit.depth_scale, display="like x_p"),
        made("v_0", fit.speed_scale, display="like v"),
        made("alpha_0", fit.first_exponent, (fit.speeds > _NOTHING, _ONE_SPEED)),
        made("x_m", fit.approach, display="like x_p", meaning="approach on the common curve"),
        made("x_p", fit.depth, display="like x_p", meaning="adjusted imprint depth"),
        made("D", fit.by_exponent, display="like x_p"),
        made("B_v", fit.by_speed),
        made("B_e", fit.by_restitution, display="like x_p"),
        made("W", fit.weight),
        made("R", fit.misfit, display="like x_p"),
        made("lam", fit.multiplier, (fit.bowl > 0, _BOWL)),
        made("S_DD", fit.squares_D),
        made("S_DX", fit.products),
        made("S_XX", fit.squares_X),
        made("Delta", fit.determinant, (fit.determinant.value > fit.S_DD * fit.S_XX * _LEAST, _ALIKE)),
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
        made("u_alpha", fit.by_adjusted, is_u=True),
        made("R_B", fit.birge, (fit.n_tests > 2, _TWO), spare=True),
        made("u_B", fit.by_scatter, is_u=True),
        made("h", checks.leverage),
        made("z_R", checks.deviation, (1 - checks.H[k] > checks.FREE, _ALONE), spare=True),
        made("alpha_k", checks.without, (1 - checks.H[k] > checks.FREE, _ALONE), spare=True),
        made("G", checks.trend_of_approach, display="like x_p"),
        made("T", checks.trend_of_depth, display="like x_p"),
        made("S_TT", checks.squares_T),
        made("S_TD", checks.trend_with_exponent),
        made("S_TX", checks.trend_by_depth),
        made("Q", checks.projected, (checks.projected.value > checks.S_TT * _LEFT, _BENT), spare=True),
        made("tau", checks.trend),
        made("u_tau", checks.uncertain_trend, is_u=True),
        made("dchi2", checks.taken_off),
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
        return Column(CALLED[like], axis, **more)

    observed = (VOCABULARY[name][k] for name in ("v_obs", "e_obs", "x_obs"))
    where: dict[Expr, Expr] = {cell: own[k] for cell, own in zip(observed, measured, strict=True)}
    for like in CALLED:
        own, cell = VOCABULARY[like], blank(like)
        where[own.symbol if like in _SCALARS else own[k]] = cell.cell

    def made(
        like: str,
        rule: Given | Equation | tuple[Equation, Expr, Expr],
        *needs: tuple[Rel, str],
        **more: Any,
    ) -> Column:
        if isinstance(rule, Given):
            return blank(like, rule=rule, **more)
        if isinstance(rule, Equation):
            requires = tuple((condition.xreplace(where), says) for condition, says in needs)
            return blank(like, rule=Formula(rule.at(where)), requires=requires, **more)
        equation, step, start = rule
        own = Iterated(equation.at(where | fit.least), step.xreplace(where), start.xreplace(where), _NONE)
        return blank(like, rule=own, **more)

    return made


_LEAST = Rational(1, 2**30)
"""What is left of a difference, as a part of what it was made of, is more than rounding from here on."""
_LEFT = Rational(1, 2**20)
"""The same of a trend, which is a difference of what was made of such differences."""
_NOTHING = Rational(1, 2**48)
"""More than rounding makes of the logarithms of equal speeds, squared and added."""
_ONE_SPEED = "all tests are at one speed, which tells no exponent"
_ALONE = "the other tests alone tell no curve"
_TWO = "two tests lie on one curve, so that nothing is left over"
_BENT = "tests at two speeds tell no trend"
_ALIKE = "the tests tell no exponent: all are at one speed, or but one of them counts"
_BOWL = "a restitution of zero is so uncertain that a larger one fits better"
_NONE = (
    "no power law with a positive exponent comes near to all tests, or a test has speed, restitution and "
    f"depth without uncertainty, which weighs more than all others, or {_BOWL}: state one above zero"
)
