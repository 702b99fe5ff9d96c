"""What law (3) says besides, beside what was measured and what an elastic unloading asks for.

A crater of the ball's own radius is taken where one is needed; that of the paper is flatter.

Sources: E Meyer, Z. Ver. dtsch. Ing. 52 (1908) 645, D Tabor, The Hardness of Metals, 1951, for the exponent n
of an indentation, P = k d^n; the rest is this project's own.
"""

from __future__ import annotations

from sympy import Expr, Integer, Rational, Symbol, log, pi, simplify, sqrt
from sympy.core.parameters import evaluate

from .. import power_law_fit as line
from .. import soft_impact as paper
from ..equation import Derivation, Equation, Kind, assume, define
from ..global_fit import n_tests, over_tests
from ..symbols import VOCABULARY as PAPER
from ..symbols import k, q
from ..vocabulary import Quantity, Vocabulary
from . import hertz, lankarani_1994, power_law
from .one_constant import COMES_BACK
from .quantities import SHARED

OWN = (
    Quantity("ln_v", "logarithm of the speed over the mean speed", "1", r"\ln(v'%s/v_0)", (-1.0, 1.0)),
    Quantity("ln_e", "logarithm of the restitution", "1", r"\ln e%s", (-1.0, -0.1)),
    Quantity("mean_ln_v", "mean of the first", "1", r"\overline{\ln v'}%s", (-0.5, 0.5)),
    Quantity("mean_ln_e", "mean of the second", "1", r"\overline{\ln e}%s", (-1, -0.1)),
    Quantity("e_slope", "power of the speed that the restitution follows", "1", "b%s", (-0.4, -0.01)),
    Quantity("alpha_by_e", "exponent by the restitutions alone", "1", r"\alpha_e%s", (0.6, 1.45)),
    Quantity("recovery_power", "elastic recovery by law (3)", "m", r"\delta_{(3)%s}", (1e-6, 1e-4)),
    Quantity("a_crater", "radius of a crater of the ball's radius", "m", r"a_{p%s}", (1e-4, 2e-3)),
    Quantity("recovery_asked", "elastic recovery, as the force asks for", "m", r"\delta_{E%s}", (1e-6, 1e-4)),
    Quantity("pressure_power", "greatest force over the crater", "Pa", r"\bar{p}_{(3)%s}", (1e8, 1e10)),
    Quantity("meyer_n", "exponent of Meyer's law that goes with it", "1", "n%s", (1.5, 3.0)),
    Quantity("meyer_k", "coefficient of Meyer's law", "N/m^meyer_n", r"k_{\mathrm{M}%s}", (1e8, 1e10)),
    Quantity("meyer_d", "diameter of the contact under load", "m", r"d_{\mathrm{M}%s}", (1e-4, 1e-3)),
    Quantity("meyer_way", "square of that diameter over approach", "m", r"l_{\mathrm{M}%s}", (1e-3, 1e-1)),
    Quantity("over_lankarani", "imprint, over Lankarani's", "1", r"x_p/x_{p,\mathrm{LN}}%s", (0.5, 3.0)),
    Quantity("deceleration_power", "greatest deceleration by law (3)", "m/s^2", r"a_{m,(3)%s}", (1e4, 1e6)),
)  # fmt: skip
_WORDS = Vocabulary(*SHARED.values(), *lankarani_1994.OWN, *power_law.OWN, *OWN)
e, x_p, R = SHARED.plain("e x_p R_b")
v_0, v, m_1 = PAPER.plain("v_0 v m_1")
x_m, peak, predicted = _WORDS.plain("x_m_power F_m_power x_p_power")
ln_e, mean_v, mean_e, b, alpha_e = _WORDS.plain("ln_e mean_ln_v mean_ln_e e_slope alpha_by_e")
recovery, a, asked, pressure, n, over, deceleration = _WORDS.plain(
    "recovery_power a_crater recovery_asked pressure_power meyer_n over_lankarani deceleration_power"
)
meyer_k, meyer_d, meyer_way = _WORDS.plain("meyer_k meyer_d meyer_way")
LV, LE = _WORDS["ln_v"], _WORDS["ln_e"]


def _define(number: str, of: Symbol, value: Expr, because: str = "definition") -> Equation:
    return define(number, of, value, _WORDS[of.name].meaning, because)


# The straight line through the logarithms is that of the log-log fit, here of restitution over speed.
_tests = {
    q: k, line.size: n_tests, line.X[q]: LV[k], line.Y[q]: LE[k], line.x[q]: v, line.x_ref: v_0,
    line.F[q]: e, line.F_ref: Integer(1), line.Xmean: mean_v, line.Ymean: mean_e, line.b: b,
}  # fmt: skip
LINE = tuple(each.at(_tests) for each in (line.log_x, line.log_F, line.mean_X, line.mean_Y, line.alpha_log))

# By (L132) the recovery is as the force over the radius of the contact, which is as the root of the approach.
_by_depth = Symbol("A_e", positive=True) * paper.x_m_of_test.value ** ((paper.alpha - Rational(3, 2)) / 2)
_steepness = simplify(v * log(_by_depth).diff(v)).xreplace({paper.alpha: alpha_e})

with evaluate(False):
    steepness = assume(
        (b, _steepness),
        "e^2 is as the recovery over the approach, and the radius as the root of the approach",
        "restitution by the speed under elastic unloading",
    )
    by_restitution = Equation(
        "(L179)",
        (alpha_e, (b + Rational(3, 2)) / (1 - b)),
        "an elastic unloading that (L132) describes",
        title="exponent by the restitutions alone",
        defines=alpha_e,
    )
    recovered = _define("(L180)", recovery, x_m - predicted)
    crater = _define("(L181)", a, sqrt(2 * R * x_p), "a flat cap of the ball's radius")
    mean_pressure = _define("(L182)", pressure, peak / (pi * a**2))
    meyer = _define("(L183)", n, 2 * paper.alpha, "(L188) is a power of the approach, with half of n")
    indentation = Equation(
        "(L186)",
        (paper.F, meyer_k * meyer_d**n),
        "of the diameter under load; Meyer measured that of the recovered indentation",
        Kind.ASSUMPTION,
        "Meyer's law",
    )
    by_area = Equation(
        "(L187)",
        (meyer_d**2, meyer_way * paper.x),
        "the area of the contact is as the approach: a ball that sinks in no deeper than a small cap",
        Kind.ASSUMPTION,
        "diameter of the contact",
    )
    by_approach = Equation(
        "(L188)",
        (paper.F, meyer_k * (meyer_way * paper.x) ** (n / 2)),
        "Meyer's law with that diameter",
        title="Meyer's law by the approach",
    )
    beside_lankarani = _define("(L184)", over, x_p / _WORDS["x_p_lankarani"].symbol)
    decelerates = _define("(L185)", deceleration, peak / m_1)

required = hertz.recovery.at({hertz.delta: asked, hertz.F_m: peak, hertz.a_u: a})

ENTRIES: tuple[Equation | Derivation, ...] = (
    line.log_x,
    line.log_F,
    line.mean_X,
    line.mean_Y,
    line.LOG_FIT[0],
    Derivation.of(by_restitution, (steepness,), (alpha_e,), "Solve for the exponent."),
    recovered,
    crater,
    mean_pressure,
    indentation,
    by_area,
    Derivation.of(by_approach, (indentation, by_area), (paper.F, meyer_d), "Put the diameter in."),
    meyer,
    beside_lankarani,
    decelerates,
)
CELLS = (
    *LINE, by_restitution, recovered, crater, required, mean_pressure, meyer, beside_lankarani, decelerates,
)  # fmt: skip
NEEDS = {
    ln_e: COMES_BACK,
    b: (
        over_tests((LV[k] - mean_v) ** 2) > Rational(1, 2**40),
        "all tests are at one speed, which tells nothing of how the restitution goes with it",
    ),
}
"""Without what the cells say nothing, and the sentence for that."""
