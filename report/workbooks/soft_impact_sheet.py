"""The sheet of the soft-impact paper: its equations, laid out over tests, pairs and points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from sympy import Expr, Integer, Rational, Symbol

from ...derivations import generated_points as points
from ...derivations import pair_curve as curve
from ...derivations import power_law_fit as fit
from ...derivations import soft_impact as model
from ...derivations.equation import Equation
from ...derivations.soft_impact import CP, XM, XP, E, V
from ...derivations.symbols import VOCABULARY, p, q, s
from ..sheet import Axis, Column, Formula, Given, PairAxis, RepeatAxis, Root, Sheet
from . import soft_impact_fit
from .soft_impact_limits import apart, limits
from .soft_impact_root import alpha_rule, two_tests

__all__ = ["TESTS", "beta", "e", "masses", "sheet", "v", "x_p"]

# --- index sets ------------------------------------------------------------------------------------------

k, i, j = (Symbol(name, integer=True, positive=True) for name in "kij")
TESTS = Axis("tests", k, Symbol("n_tests", integer=True, positive=True))
PAIRS = PairAxis("pairs", p, points.n_pairs, of=TESTS, first=i, second=j)
POINTS = RepeatAxis("points", q, fit.size, of=PAIRS, step=s, count="points_per_pair")


def _column(name: str, axis: Axis | None, rule: Formula | Root | Given, like: str, **more: Any) -> Column:
    """A column that takes unit, meaning and LaTeX of a quantity of the derivations."""
    quantity = VOCABULARY[like]
    more = {"unit": quantity.unit, "meaning": quantity.meaning, "latex": quantity.latex, **more}
    return Column(name, axis, rule, **more)


# Given columns and the cells they lead to, by the symbols of the derivations.
v, e, x_p = (
    _column(name, TESTS, Given("measured"), name, display=f"like {name}") for name in ("v", "e", "x_p")
)
beta = _column("beta", None, Given("parameter"), "beta", exact=True)
points_per_pair = Column(
    "points_per_pair", None, Given("parameter"), meaning="points of each pair's curve", latex="N", exact=True
)


def _pair_symbols() -> dict[Expr, Expr]:
    """What the two tests of the derivations are called in the sheet: rows i and j, cells of the pair."""

    def of_pair(name: str) -> Expr:
        return Column(name, PAIRS, Given())[p]

    return {
        V[1]: v[i], V[2]: v[j], E[1]: e[i], E[2]: e[j], XP[1]: x_p[i], XP[2]: x_p[j],
        XM[1]: of_pair("x_m1"), XM[2]: of_pair("x_m2"),
        CP[1]: of_pair("Cprime_1"), CP[2]: of_pair("Cprime_2"),
        model.C: of_pair("C"), model.alpha: of_pair("alpha"), points.x_top: of_pair("x_top"),
    }  # fmt: skip


def sheet(given: frozenset[str]) -> Sheet:
    """The sheet for the parameters that were given.

    `given`: names of parameters: they decide between the mass and the diameter, a free and a fixed target.
    """
    where = _pair_symbols()
    alpha = _column("alpha", PAIRS, alpha_rule(where), "alpha", requires=two_tests(where))
    peak_1, peak_2 = (curve.peak.at({k: Integer(test)}) for test in (1, 2))
    on_pair = {
        name: _column(
            name, PAIRS, Formula(equation.at(where)), like, meaning=meaning, display=shown, latex=latex
        )
        for name, equation, like, meaning, shown, latex in (
            ("x_m2", model.eq12a, "x_m", "approach of the pair's second test", "like x_p", r"x_{m_2%s}"),
            ("x_m1", model.eq12b, "x_m", "approach of the pair's first test", "like x_p", r"x_{m_1%s}"),
            ("C", model.eq12c, "C", "coefficient of the compression law", "", "C%s"),
            ("Cprime_1", peak_1, "Cprime", "maximum force of the pair's first test", "", "C'_{1%s}"),
            ("Cprime_2", peak_2, "Cprime", "maximum force of the pair's second test", "", "C'_{2%s}"),
            ("x_top", points.top, "x_top", "largest approach of the pair", "like x_p", r"x_{\mathrm{top}%s}"),
        )
    }
    # A pair that tells no exponent has no points; averages look at the points, and leave it out, too.
    x_top = replace(on_pair["x_top"], requires=(apart(where),))
    with_points = (x_top,)
    x = _column(
        "x", POINTS,
        Formula(points.abscissa.at({points.x_top: x_top[p], points.N: points_per_pair.symbol})), "x",
        meaning="approach of a generated point", display="like x_p",
    )  # fmt: skip
    F = _column(
        "F", POINTS,
        Formula(curve.on_curve.at({**where, model.x: x[q], model.F: Symbol("F")})), "F",
        meaning="force of a generated point",
    )  # fmt: skip
    columns = (
            v, e, x_p, beta, *masses(given), points_per_pair,
            alpha, *(on_pair | {"x_top": x_top}).values(),
            Column(
                "alpha_mean", None, Formula(points.mean), meaning="mean exponent", latex=r"\bar{\alpha}",
                alongside=with_points,
            ),
            Column(
                "alpha_median", None, Formula(points.middle),
                meaning="median exponent", latex=r"\tilde{\alpha}", alongside=with_points,
            ),
            x, F, *_log_fit(x, where, with_points), *_lin_fit(), *_tests_after_fit(),
            *soft_impact_fit.columns(TESTS, (v, e, x_p)),
    )  # fmt: skip
    return Sheet(columns).limited(limits(columns, where))


def masses(given: frozenset[str]) -> tuple[Column, ...]:
    """The mass of the ball and the reduced mass, from what was given."""
    columns: list[Column] = []
    ball = _mass("ball_mass", Given("parameter"), "mass of the ball", "m_1")
    if "ball_mass" not in given:
        diameter, density = (
            Column(name, None, Given("parameter"), unit, meaning, latex, f"like {name}")
            for name, unit, meaning, latex in (
                ("ball_diameter", "m", "diameter of the ball", "d"),
                ("ball_density", "kg/m^3", "density of the ball", r"\rho"),
            )
        )
        rule = Formula(model.ball_mass.at({model.rho: density.symbol, model.d: diameter.symbol}))
        ball = _mass("ball_mass", rule, "mass of the ball", "m_1")
        columns += [diameter, density]
    columns.append(ball)
    reduced = model.immobile_mass.at({model.m_1: ball.symbol})
    if "target_mass" in given:
        target = _mass("target_mass", Given("parameter"), "mass of the target", "m_2")
        reduced = model.eq8.at({model.m_1: ball.symbol, model.m_2: target.symbol})
        columns.append(target)
    columns.append(_mass("m_red", Formula(reduced), "reduced mass", "m_{red}"))
    return tuple(columns)


def _mass(name: str, rule: Formula | Given, meaning: str, latex: str) -> Column:
    return Column(name, None, rule, "kg", meaning, latex, "g")


def _log_fit(x: Column, pair: Mapping[Expr, Expr], with_points: tuple[Column, ...]) -> tuple[Column, ...]:
    """The straight line through the logarithms of the generated points."""
    ref = (
        _column("x_ref", None, Formula(points.x_scale), "x_ref", display="like x_p"),
        _column(
            "F_ref", None, Formula(points.F_scale.at({CP[p]: pair[CP[2]]})), "F_ref", alongside=with_points
        ),
    )
    ln_x, ln_F = (Column(name, POINTS, Given(), positive=False) for name in ("ln_x", "ln_F"))
    mean_x, mean_F, line = (
        Column(name, None, Given(), positive=False) for name in ("mean_ln_x", "mean_ln_F", "ln_F_at_ref")
    )
    alpha_log = VOCABULARY["alpha"].symbol.func("alpha_log", positive=True)
    where = {
        **pair, fit.x[q]: x[q], fit.X[q]: ln_x[q], fit.Y[q]: ln_F[q],
        fit.Xmean: mean_x.symbol, fit.Ymean: mean_F.symbol, fit.a: line.symbol, fit.b: alpha_log,
    }  # fmt: skip

    def own(name: str, equation: Equation, latex: str, meaning: str, **more: Any) -> Column:
        more = {"axis": None, "unit": "1", "positive": False, **more}
        return Column(name, rule=Formula(equation.at(where)), latex=latex, meaning=meaning, **more)

    return (
        *ref,
        own("ln_x", fit.log_x, "X%s", "logarithm of a point's approach over the reference", axis=POINTS),
        own("ln_F", curve.log_force, "Y%s", "logarithm of a point's force over the reference", axis=POINTS),
        own("mean_ln_x", fit.mean_X, r"\bar{X}", "mean of X"),
        own("mean_ln_F", fit.mean_Y, r"\bar{Y}", "mean of Y"),
        own("alpha_log", fit.alpha_log, r"\alpha_{\log}", "exponent of the log-log fit", positive=True),
        own("ln_F_at_ref", fit.intercept, "a", "intercept of the log-log fit"),
        own(
            "C_log", fit.log_scale, r"C_{\log}", "coefficient of the log-log fit",
            unit="N/m^alpha_log", positive=True,
        ),
    )  # fmt: skip


def _lin_fit() -> tuple[Column, ...]:
    """Least squares of the force: one equation for the exponent, then the coefficient."""
    alpha = Column("alpha_lin", None, Given()).symbol
    ln_x, ln_F = (Column(name, POINTS, Given(), positive=False) for name in ("ln_x", "ln_F"))
    where = {fit.alpha: alpha, fit.X[q]: ln_x[q], fit.Y[q]: ln_F[q]}
    equation = fit.alpha_lin.at(where)
    root = Root(
        equation=equation,
        form=equation,
        unknown=alpha,
        value=alpha,
        low=Rational(1, 10),
        high=Rational(5),
        start=Column("alpha_log", None, Given()).symbol,
        steps=8,
        none="the best power of the points lies outside 0.1 to 5",
    )
    return (
        Column(
            "alpha_lin", None, root, "1", "exponent of the least squares of force",
            r"\alpha_{\mathrm{lin}}",
        ),
        Column(
            "C_lin", None, Formula(fit.lin_scale.at(where)), "N/m^alpha_lin",
            "coefficient of the least squares of force", r"C_{\mathrm{lin}}",
        ),
    )  # fmt: skip


def _tests_after_fit() -> tuple[Column, ...]:
    """Table 3: each test's approach and maximum force on the fitted curve."""
    C_log, alpha_log = (Column(name, None, Given()).symbol for name in ("C_log", "alpha_log"))
    x_m = Column("x_m", TESTS, Given())
    seven, nine = (Column(name, TESTS, Given()) for name in ("Cprime_eq7", "Cprime_eq9"))
    where = {
        model.v: v[k], model.e: e[k], model.x_p: x_p[k], model.x_m: x_m[k],
        model.C: C_log, model.alpha: alpha_log,
    }  # fmt: skip
    return (
        _column("x_m", TESTS, Formula(model.x_m_of_test.at(where)), "x_m", display="like x_p"),
        _column(
            "Cprime_eq7", TESTS, Formula(model.Cprime_of_test.at({**where, model.Cprime: seven[k]})),
            "Cprime",
            meaning="maximum force, from the restitution (7)", latex=r"C'_{\text{(7)}%s}",
            requires=((x_m[k] > x_p[k], "the imprint is not shallower than the approach"),),
        ),
        _column(
            "Cprime_eq9", TESTS, Formula(model.eq9.reversed.at({**where, model.Cprime: nine[k]})), "Cprime",
            meaning="maximum force, from the compression (9)", latex=r"C'_{\text{(9)}%s}",
        ),
    )  # fmt: skip
