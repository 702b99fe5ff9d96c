"""Hertz and Mindlin of Yade with a typed restitution: the damping ratio of Thornton and others, no pull.

C Thornton, S J Cummins, P W Cleary, Powder Technol 233 (2013) 30-46, gave the ratio as a polynomial so that a
force that ends where it would pull returns what is typed. The damping is of the tangent stiffness, 3/2 of the
secant one that (L117) has.
"""

from functools import reduce

from sympy import Expr, Float, Integer, Rational, Symbol, exp, sqrt
from sympy.core.parameters import evaluate

from ....derivations.contact.damping import zeta
from ..code import HERTZ, TSUJI, E, SimulationCode, Typed, e, nu
from ..law import ForceLaw

ratio = Symbol("beta_n", positive=True)
_POWERS = (
    "-6.918798", "-16.41105", "146.8049", "-796.4559", "2928.711",
    "-7206.864", "11494.29", "-11342.18", "6276.757", "-1489.915",
)  # fmt: skip
"""Of the first and higher powers of the restitution."""


def _and_lower(higher: Expr, factor: str) -> Expr:
    return e * (Float(factor) + higher)


POLYNOMIAL: Expr = reduce(_and_lower, reversed(_POWERS), Integer(0))
with evaluate(False):
    BY_POLYNOMIAL = (
        (zeta, sqrt(Rational(6, 5)) * ratio),
        (ratio, sqrt(1 / (1 - (1 + e) ** 2 * exp(POLYNOMIAL)) - 1)),
        *HERTZ,
    )

CODE = SimulationCode(
    name="yade",
    title="Yade, Ip2_FrictMat_FrictMat_MindlinPhys with en",
    version="2023.02a, run in it; commit 15182ac of its MPI branch has Tsuji's damping, which pulls",
    sources=(
        "Yade 2023.02a, help of Ip2_FrictMat_FrictMat_MindlinPhys: c_n = 2 beta_n sqrt(m k_n) of the tangent "
        "stiffness, beta_n by formula (B6) of Thornton and others 2013",
        "gitlab.com/yade-dev/trunk merge request 919, Update Hertz-Mindlin model and docs",
        "the polynomial: gitlab.com/yade-dev/trunk, benchmarks of Chung and Ooi, Test3.py",
    ),
    law=ForceLaw("MindlinPhys", TSUJI, where=BY_POLYNOMIAL),
    typed=(
        Typed("young", E, "Pa", "of both materials"),
        Typed("poisson", nu, "1", "of both materials", value=nu),
        Typed("en", e, "1", "normal coefficient of restitution"),
    ),
    stiffness=E,
    damping=e,
    by_hertz=E,
    snippet="FrictMat(young={young}, poisson={poisson}), Ip2_FrictMat_FrictMat_MindlinPhys(en={en})",
    notes=(
        "for two spheres: with a wall or facet Yade takes half of the ball's radius for the effective one",
    ),
)
