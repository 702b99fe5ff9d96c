"""What the fit says of a test left out and of a trend, by one step, beside fits that are made again."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, least_squares
from test_global_fit import ALPHA, BETA, MASS, Array, C, E, U, V, X, by_scipy, depth, fitted

Campaign = tuple[Array, ...]


def quiet(part: float) -> Campaign:
    """A campaign whose deviations are that part of the data: one step then is nearly all of the way."""
    rng = np.random.default_rng(5)
    x = depth(V, E, ALPHA, C * 4e-5**ALPHA, 4e-5)
    measured = [true * (1 + part * rng.standard_normal(true.size)) for true in (V, E, x)]
    return (*measured, *(part * true for true in (V, E, x)))


CAMPAIGNS = [((V, E, X, *U), 0.03), (quiet(1e-3), 5e-3), (quiet(1e-4), 5e-4)]
"""The paper, whose tests lie several standard deviations off; and smaller deviations, nearer to a refit."""


@pytest.mark.parametrize(("campaign", "near"), CAMPAIGNS)
def test_a_test_that_is_left_out_moves_the_fit_as_a_fit_without_it(campaign: Campaign, near: float) -> None:
    values = fitted(*campaign)
    alpha, chi2 = values.scalar("alpha_eiv"), values.scalar("chi2_eiv")
    for test in range(V.size):
        exponent, squares, _ = by_scipy(*(np.delete(column, test) for column in campaign))
        moved = values.value["alpha_without"][test] - alpha
        assert moved == pytest.approx(exponent - alpha, rel=3 * near, abs=near * values.scalar("u_alpha_eiv"))
        lost = values.value["z_eiv"][test] ** 2
        assert lost == pytest.approx(chi2 - squares, rel=3 * near, abs=near)


def bent(v: Array, e: Array, alpha: float, force: float, trend: float, x_0: float) -> Array:
    """The imprint depths by a force whose exponent goes with the depth: the works by quadrature."""

    def law(x: float) -> float:
        return float(force * (x / x_0) ** alpha * (1 + trend * np.log(x / x_0) ** 2 / 2))

    def too_much(x: float, energy: float) -> float:
        return float(quad(law, 0, x, epsabs=0, epsrel=1e-12)[0] - energy)

    found = []
    for speed, restitution in zip(v, e, strict=True):
        energy = MASS * speed**2 / 2
        x_m = brentq(too_much, 1e-6, 4e-4, args=(energy,), xtol=1e-18)
        found.append(x_m - (BETA + 1) * restitution**2 * energy / law(x_m))
    return np.array(found)


@pytest.mark.parametrize(
    ("campaign", "near"), [(CAMPAIGNS[0][0], 0.1), *((quiet(part), 50 * part) for part in (1e-3, 1e-4, 1e-5))]
)
def test_the_trend_is_that_of_a_fit_with_a_third_parameter(campaign: Campaign, near: float) -> None:
    v, e, x_p, u_v, u_e, u_x = campaign
    values, n = fitted(*campaign), v.size
    x_0 = values.scalar("x_0")

    def deviations(z: Array) -> Array:
        dv, de = z[3 : 3 + n], z[3 + n :]
        true = bent(v + u_v * dv, e + u_e * de, z[0], np.exp(z[1]), z[2], x_0)
        return np.concatenate([dv, de, (x_p - true) / u_x])

    start = [values.scalar("alpha_eiv"), np.log(values.scalar("F_eiv")), 0.0, *np.zeros(2 * n)]
    found = least_squares(deviations, start, method="lm")
    sure = float(np.sqrt(np.linalg.inv(found.jac.T @ found.jac)[2, 2]))
    assert values.scalar("u_trend_eiv") == pytest.approx(sure, rel=near)
    assert values.scalar("trend_eiv") == pytest.approx(found.x[2], rel=near, abs=near * sure)
    taken = values.scalar("chi2_eiv") - 2 * found.cost
    assert values.scalar("dchi2_trend") == pytest.approx(taken, rel=near, abs=near)
