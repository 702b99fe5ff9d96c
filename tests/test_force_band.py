"""The band about the common curve: the covariance of exponent and force, and where a test lies beside it."""

import numpy as np
import pytest
from test_global_fit import SHEET, WORKBOOK, E, U, V, X, depth, fitted

from loopsheet.report.cells.values import Values
from loopsheet.report.engines import numpy as engine
from loopsheet.report.result.result import Report


@pytest.fixture(scope="module")
def drawn(report: Report) -> Values:
    assert report.workbook.drawn is not None
    own = report.workbook.drawn(report.sheet)
    return engine.extend(report.values, own.columns, own.given)


def curve(report: Report, alpha: float, force: float, x: np.ndarray) -> np.ndarray:
    return np.asarray(force * (x / report.values.scalar("x_0")) ** alpha)


def depths(report: Report, alpha: float, force: float) -> np.ndarray:
    """The imprints of the tests, by their adjusted speeds and restitutions, on another curve."""
    x_0, m_red, beta = (report.values.scalar(name) for name in ("x_0", "m_red", "beta"))
    v, e = (report.values.value[name] for name in ("v_eiv", "e_eiv"))
    return depth(v, e, alpha, force, x_0, m_red, beta)


def test_the_band_is_propagated_from_exponent_and_force(report: Report, drawn: Values) -> None:
    alpha, force = (report.values.scalar(name) for name in ("alpha_eiv", "F_eiv"))
    weight, x = report.values.value["W_eiv"], drawn.value["band_x"]

    def slopes(of: object) -> np.ndarray:
        assert callable(of)
        steps = ((1e-6, 0.0), (0.0, 1e-6))
        ends = [[of(alpha + sign * a, force * np.exp(sign * f)) for sign in (1, -1)] for a, f in steps]
        return np.array([(up - down) / 2e-6 for up, down in ends])

    jacobian = slopes(lambda a, f: depths(report, a, f))
    covariance = np.linalg.inv((jacobian * weight) @ jacobian.T)
    moved = slopes(lambda a, f: curve(report, a, f, x))
    expected = np.sqrt(np.einsum("ip,ij,jp->p", moved, covariance, moved))
    np.testing.assert_allclose(drawn.value["band_u"], expected, rtol=1e-6)
    np.testing.assert_allclose(drawn.value["above_band_u"], 2 * expected, rtol=1e-6)
    # A further test has, besides, the scatter of a test of the mean weight.
    scatter = curve(report, alpha, force, x) / np.sqrt(np.mean(weight * jacobian[1] ** 2))
    np.testing.assert_allclose(drawn.value["further_u"], np.hypot(expected, scatter), rtol=1e-6)


def test_with_the_force_beside_the_curve_a_test_has_its_depth(report: Report, drawn: Values) -> None:
    values = report.values
    alpha, force = values.scalar("alpha_eiv"), values.scalar("F_eiv")
    peak = curve(report, alpha, force, values.value["x_m_eiv"])
    for test, more in enumerate(drawn.value["beside"] / peak):
        moved = depths(report, alpha, force * (1 + more)) - depths(report, alpha, force)
        assert moved[test] == pytest.approx(values.value["R_eiv"][test], rel=0.02)


def test_the_curve_is_known_best_within_the_data(report: Report, drawn: Values) -> None:
    x, relative = drawn.value["band_x"], drawn.value["band_u"] / drawn.value["band_F"]
    depth = report.values.value["x_p"]
    assert depth.min() < x[np.argmin(relative)] < depth.max() * 1.3
    assert relative[np.argmin(x)] > 3 * relative.min()


def test_a_test_without_a_value_is_not_counted() -> None:
    """A further test scatters as those do that the curve goes by."""
    assert WORKBOOK.drawn is not None
    own, lost = WORKBOOK.drawn(SHEET), E.copy()
    lost[2] = np.nan
    without = fitted(*(np.delete(column, 2) for column in (V, E, X, *U)))
    bands = [engine.extend(values, own.columns, own.given) for values in (fitted(V, lost, X, *U), without)]
    for name in ("band_u", "further_u"):
        np.testing.assert_allclose(*(drawn.value[name][:5] for drawn in bands), rtol=1e-9)
