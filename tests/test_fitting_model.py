"""Models with errors in one variable or in several: what is published, and other ways to the same numbers."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from sympy import Expr, Symbol, exp, symbols

from loopsheet.report.column import SheetError
from loopsheet.report.fitting.least_squares import Ending, NotFitted, least_squares
from loopsheet.report.fitting.model import Adjustment, Model
from loopsheet.report.fitting.triangle import Array

a, b, r, x, y = symbols("a b r x y")
LINE = Model(y - a - b * x, (a, b), (x, y))
PEARSON = {
    x: np.array([0, 0.9, 1.8, 2.6, 3.3, 4.4, 5.2, 6.1, 6.5, 7.4]),
    y: np.array([5.9, 5.4, 4.4, 4.6, 3.5, 3.7, 2.8, 2.8, 2.4, 1.5]),
}
YORK = {
    x: 1 / np.sqrt([1000, 1000, 500, 800, 200, 80, 60, 20, 1.8, 1]),
    y: 1 / np.sqrt([1, 1.8, 4, 8, 20, 20, 70, 70, 100, 500]),
}


def same(found: float, printed: str) -> bool:
    """Whether a number rounds to what is printed."""
    return f"{found:.{len(printed.partition('.')[2])}f}" == printed


def test_all_that_is_published_of_pearsons_data_with_yorks_weights() -> None:
    """Slope and intercept: Neri, Saitta, Chiofalo (1989). By the adjusted points: York, Evensen, Martinez,
    De Basabe Delgado (2004). Propagated: Kalantar (1992)."""
    found = LINE.fit(PEARSON, YORK, [5, 0])
    for number, printed in zip(
        (
            *(*found.parameters, *found.u, *found.u_propagated),
            *(found.propagated[0, 1], found.fitted.birge**2),
        ),
        (
            *("5.479910224", "-0.480533407", "0.294970735", "0.057985009", "0.29193", "0.057617"),
            *("-0.0162", "1.483294149"),
        ),
        strict=True,
    ):
        assert same(number, printed), (number, printed)


@pytest.mark.parametrize(
    ("data", "errors", "printed"),
    [
        (
            {x: [1, 2, 3, 4, 5, 6], y: [3.3, 5.6, 7.1, 9.3, 10.7, 12.1]},
            {y: 0.5},
            ("1.867", "1.757", "0.465", "0.120", "-0.050", "1.665"),
        ),
        (
            {x: [1, 2, 3, 4, 5, 6], y: [3.2, 4.3, 7.6, 8.6, 11.7, 12.8]},
            {y: [0.5, 0.5, 0.5, 1, 1, 1]},
            ("0.885", "2.057", "0.530", "0.178", "-0.082", "4.131"),
        ),
        (
            {x: [1.2, 1.9, 2.9, 4.0, 4.7, 5.9], y: [3.4, 4.4, 7.2, 8.5, 10.8, 13.5]},
            {x: 0.2, y: [0.2, 0.2, 0.2, 0.4, 0.4, 0.4]},
            ("0.5788", "2.1597", "0.4764", "0.1355", "-0.0577", "2.743"),
        ),
    ],
    ids=["6.3, alike", "6.3, not alike", "7.4, in both"],
)
def test_examples_of_iso_28037(
    data: dict[Symbol, list[float]], errors: dict[Symbol, list[float]], printed: tuple[str, ...]
) -> None:
    found = LINE.fit(data, errors, [0, 1])
    numbers = (*found.parameters, *found.u, found.covariance[0, 1], found.fitted.chi2)
    for number, text in zip(numbers, printed, strict=True):
        assert same(number, text), (number, text)


def test_three_variables_with_errors() -> None:
    """The global fit of the shipped paper, by the force at 50 um, from the digits that are printed."""
    v, e, depth = symbols("v e x_p")
    alpha, force = symbols("alpha F_0", positive=True)
    exponent, reference = alpha + 1, 50e-6
    deepest = reference * (exponent * 8.366e-3 * v**2 / (2 * force * reference)) ** (1 / exponent)
    model = Model(depth - deepest * (1 - e**2 * 2.5 / exponent), (alpha, force), (v, e, depth))
    found = model.fit(
        {
            v: [2.334, 2.940, 4.089, 4.504, 4.993],
            e: [0.530, 0.512, 0.479, 0.467, 0.453],
            depth: np.array([23.5, 29.7, 41.6, 45.97, 51.03]) * 1e-6,
        },
        {v: 5e-4 / 3**0.5, e: 5e-4 / 3**0.5, depth: np.array([5e-8] * 3 + [5e-9] * 2) / 3**0.5},
        [1.2, 2000],
    )
    assert same(found.parameters[0], "1.3013045")
    for u, printed in ((found.u, "0.0030539"), (found.u_by_hessian, "0.0030607")):
        assert same(u[0], printed)
    assert same(found.u_propagated[0], "0.0030676")
    assert same(found.fitted.chi2, "55.1908")
    assert same(found.fitted.birge, "4.289")


# ---------------------------------------------------------------------- another way to each number
CURVES = pytest.mark.parametrize(
    ("curve", "true"),
    [
        (y - a * x**b, lambda at: 2 * at**1.3),
        (y * (b + x) - a * x * y**2 / 10 - x, lambda at: at / (1 + at)),
        (y - a - 3 * exp(-b * x), lambda at: 1 + 3 * np.exp(-at)),
    ],
    ids=["a power", "implicit", "an exponential"],
)
Curve = Callable[[Array], Array]
SHARED = 0.4


def noisy(true: Curve) -> tuple[dict[Symbol, Array], dict[Symbol, Array]]:
    """Data, and their uncertainties."""
    rng = np.random.default_rng(3)
    at = np.linspace(1, 6, 9)
    errors = {x: 0.05 + 0 * at, y: 0.08 * true(at)}
    return {x: at + rng.normal(0, errors[x]), y: true(at) + rng.normal(0, errors[y])}, errors


def fitted(curve: Expr, data: dict[Symbol, Array], errors: dict[Symbol, Array]) -> Adjustment:
    return Model(curve, (a, b), (x, y)).fit(data, errors, [1, 1], {(x, y): SHARED})


@CURVES
def test_all_unknowns_together_yield_the_same(curve: Expr, true: Curve) -> None:
    """The true values as parameters of one large problem, the model a residual that hardly errs."""
    found = fitted(curve, *noisy(true))
    feet, count = found.feet, len(found.feet.rows)
    root, hardly = np.linalg.inv(np.linalg.cholesky([[1, SHARED], [SHARED, 1]])), 1e-7

    def ways(place: Array) -> Array:
        points = place[2:].reshape(count, 2)
        apart = ((points - feet.rows) / feet.sizes) @ root.T
        return np.concatenate([apart.ravel(), feet.slopes(points, place[:2])[:, 0] / hardly])

    def jacobian(place: Array) -> Array:
        slopes = feet.slopes(place[2:].reshape(count, 2), place[:2])
        whole = np.zeros((3 * count, 2 + 2 * count))
        whole[2 * count :, :2] = slopes[:, 3:] / hardly
        for row in range(count):
            own = slice(2 + 2 * row, 4 + 2 * row)
            whole[2 * row : 2 * row + 2, own] = root / feet.sizes[row]
            whole[2 * count + row, own] = slopes[row, 1:3] / hardly
        return whole

    together = least_squares(ways, jacobian, np.concatenate([found.parameters, feet.points.ravel()]))
    assert together.parameters[:2] == pytest.approx(found.parameters, rel=1e-8)
    assert together.parameters[2:] == pytest.approx(feet.points.ravel(), rel=1e-8)
    assert together.chi2 == pytest.approx(found.fitted.chi2, rel=1e-9)
    assert together.covariance[:2, :2] == pytest.approx(found.covariance, rel=1e-7)


@CURVES
def test_influences_are_what_a_changed_datum_does(curve: Expr, true: Curve) -> None:
    data, errors = noisy(true)
    found, step = fitted(curve, data, errors), 1e-4
    for column, symbol in enumerate((x, y)):
        for row, size in enumerate(errors[symbol]):
            change = step * size * (np.arange(len(errors[symbol])) == row)
            more, less = (
                fitted(curve, data | {symbol: data[symbol] + way}, errors).parameters
                for way in (change, -change)
            )
            assert (more - less) / (2 * step) == pytest.approx(
                found.influences[:, row, column], abs=1e-7 * found.u.max()
            )


@CURVES
def test_the_hessian_is_that_of_half_of_chi2(curve: Expr, true: Curve) -> None:
    found = fitted(curve, *noisy(true))

    def gradient(place: Array) -> Array:
        distances = found.feet.distances(place)
        return distances @ found.feet.jacobian(place)

    steps, at = np.diag(1e-3 * found.u), found.parameters
    hessian = [(gradient(at + step) - gradient(at - step)) / (2 * step.sum()) for step in steps]
    assert np.linalg.inv(hessian) == pytest.approx(found.by_hessian, rel=1e-4)


@pytest.mark.parametrize("in_x", [0.0, 0.3])
def test_an_error_that_all_rows_share_is_a_parameter_that_is_known(in_x: float) -> None:
    """Beside their own errors all y are off by one unknown amount: the intercept alone feels it."""
    own, common = 0.2, 0.5
    errors = {x: in_x, y: own}
    shifted = Model(y - a - b * x - r, (a, b, r), (x, y))
    found = shifted.fit(PEARSON, errors, [5, 0, 0], known={r: (0, common)})
    alone = LINE.fit(PEARSON, errors, [5, 0])
    assert found.parameters == pytest.approx([*alone.parameters, 0], abs=1e-12)
    for name in ("u", "u_by_hessian", "u_propagated"):
        apart, together = getattr(alone, name), getattr(found, name)
        assert together == pytest.approx([np.hypot(apart[0], common), apart[1], common], rel=1e-11)
    assert found.fitted.freedom == alone.fitted.freedom
    assert found.fitted.chi2 == pytest.approx(alone.fitted.chi2, rel=1e-12)


def test_what_is_known_of_a_parameter_is_a_datum() -> None:
    """A slope that is known as well as the data tell it halves its variance, and moves half way."""
    alone = LINE.fit(PEARSON, {y: 0.2}, [0, 0])
    elsewhere = alone.parameters[1] + 3 * alone.u[1]
    found = LINE.fit(PEARSON, {y: 0.2}, [0, 0], known={b: (elsewhere, alone.u[1])})
    assert found.parameters[1] == pytest.approx(alone.parameters[1] + 1.5 * alone.u[1], rel=1e-12)
    for u in (found.u, found.u_by_hessian, found.u_propagated):
        assert u[1] == pytest.approx(alone.u[1] / 2**0.5, rel=1e-12)
    assert found.fitted.chi2 == pytest.approx(alone.fitted.chi2 + 4.5, rel=1e-12)
    assert found.fitted.freedom == alone.fitted.freedom + 1
    with pytest.raises(SheetError, match="not zero"):
        LINE.fit(PEARSON, {y: 0.2}, [0, 0], known={b: (0, 0)})


def test_a_circle_is_fitted_by_distances() -> None:
    """The adjusted point of a circle is on the ray through the datum."""
    circle = Model((x - a) ** 2 + (y - b) ** 2 - r**2, (a, b, r), (x, y))
    data = {x: [0.1, 1.9, 4.0, 5.2, 3.1, 0.9], y: [2.2, 4.1, 3.9, 1.8, 0.1, 0.2]}
    found = circle.fit(data, {x: 0.1, y: 0.1}, [2, 2, 1])
    centre, radius = found.parameters[:2], found.parameters[2]
    ways = np.column_stack([data[x], data[y]]) - centre
    lengths = np.linalg.norm(ways, axis=1)
    assert np.abs(found.fitted.residuals) == pytest.approx(np.abs(lengths - radius) / 0.1)
    assert found.feet.points == pytest.approx(centre + ways * (radius / lengths)[:, None])
    assert (lengths - radius).sum() == pytest.approx(0, abs=1e-12), "the radius is the mean of the lengths"


def test_it_does_not_matter_which_variable_is_explained() -> None:
    found = LINE.fit(PEARSON, YORK, [5, 0])
    other = Model(x - (y - a) / b, (a, b), (x, y)).fit(PEARSON, YORK, [5, -1])
    assert other.parameters == pytest.approx(found.parameters, rel=1e-13)
    assert other.u == pytest.approx(found.u, rel=1e-13)
    assert other.u_propagated == pytest.approx(found.u_propagated, rel=1e-12)


def test_without_errors_in_x_all_three_covariances_of_a_line_are_one() -> None:
    found = LINE.fit(PEARSON, {y: 0.2}, [0, 0])
    assert found.by_hessian == pytest.approx(found.covariance, rel=1e-13)
    assert found.propagated == pytest.approx(found.covariance, rel=1e-13)
    slope, intercept = np.polyfit(PEARSON[x], PEARSON[y], 1)
    assert found.parameters == pytest.approx([intercept, slope], rel=1e-13)
    assert found.feet.points[:, 1] == pytest.approx(intercept + slope * PEARSON[x])


def test_where_nobody_knows_the_errors_only_the_scatter_tells() -> None:
    known, unknown = LINE.fit(PEARSON, {y: 1}, [0, 0]), LINE.fit(PEARSON, {y: None}, [0, 0])
    assert unknown.u_by_scatter == pytest.approx(known.u * known.fitted.birge, rel=1e-14)
    for refused in ("u", "covariance", "u_by_hessian", "propagated", "influences"):
        with pytest.raises(NotFitted, match="no uncertainty of the data was given"):
            getattr(unknown, refused)


def test_what_does_not_converge_has_no_numbers() -> None:
    one = Model(y - a - b + 0 * x - x, (a, b), (x, y)).fit(PEARSON, {y: 1}, [0, 0])
    assert one.fitted.ending is Ending.SINGULAR
    for refused in ("parameters", "u", "u_by_scatter", "u_propagated", "by_hessian"):
        with pytest.raises(NotFitted, match="cannot be told apart"):
            getattr(one, refused)


@pytest.mark.parametrize(
    ("errors", "correlated", "sentence"),
    [
        ({}, {}, "known of all variables with errors, or of none"),
        ({x: None, y: 1}, {}, "known of all variables with errors, or of none"),
        ({y: 0}, {}, "each row has one that is not zero"),
        ({y: -1}, {}, "not negative"),
        ({y: np.nan}, {}, "not negative"),
        ({x: 1, y: 1}, {(x, y): 1.1}, "fit together"),
    ],
)
def test_errors_that_are_none_are_refused(
    errors: dict[Symbol, float | None], correlated: dict[tuple[Symbol, Symbol], float], sentence: str
) -> None:
    with pytest.raises(SheetError, match=sentence):
        LINE.fit(PEARSON, errors, [0, 0], correlated)


def test_a_model_names_what_it_has() -> None:
    with pytest.raises(SheetError, match="nothing else: r"):
        Model(y - a - b * x - r, (a, b), (x, y))
    with pytest.raises(SheetError, match="nothing else: b"):
        Model(y - a, (a, b), (y,))
