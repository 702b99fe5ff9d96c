"""Sums of independent errors, beside integrals of their densities and draws of their own."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import stdtrit

from loopsheet.report.distribution import DIVISORS, Shape
from loopsheet.report.laws import Exponential, Law, Samples, TruncatedNormal
from loopsheet.report.result.uncertain import ErrorSource
from loopsheet.report.uncertainty.conformity import beyond
from loopsheet.report.uncertainty.coverage import LITTLE, Convolved, _Part, convolved, of_sum

CLOSE = 2e-6
"""Bins are 1/2048 wide: their square, times what the densities below are and bend at most."""


def source(shape: Shape, dof: float = math.inf, law: Law | None = None, sample: str = "") -> ErrorSource:
    return ErrorSource("g", shape, dof, (), "", sample, law)


def of(*parts: tuple[ErrorSource, float], pairs: tuple[tuple[int, int, float], ...] = ()) -> Convolved | None:
    """The sum of some errors, in its standard uncertainties where they are independent."""
    sources, sizes = zip(*parts, strict=True)
    return convolved(sources, np.array(sizes), math.hypot(*sizes), pairs)


def known(*parts: tuple[ErrorSource, float]) -> Convolved:
    found = of(*parts)
    assert found is not None
    return found


RECTANGULAR, ARCSINE, NORMAL = (source(s) for s in (Shape.RECTANGULAR, Shape.ARCSINE, Shape.NORMAL))
ESTIMATE = source(Shape.EXPONENTIAL, law=Exponential())


@pytest.mark.parametrize("ratio", [1.0, 0.8, 0.3, 0.01])
def test_two_rectangular_errors_make_a_trapezoid(ratio: float) -> None:
    """EA-4/02, S10.13: its coverage factor, where the flat part holds less than the level."""
    found, u = known((RECTANGULAR, 1.0), (RECTANGULAR, -ratio)), math.hypot(1, ratio)
    long, short = math.sqrt(3) / u, math.sqrt(3) * ratio / u
    for x in np.linspace(0, long + short, 9)[:-1]:
        inner = x / (2 * long) if x < long - short else 0.5 - (long + short - x) ** 2 / (8 * long * short)
        assert found.above(x) == pytest.approx(0.5 - inner, abs=CLOSE)
        assert found.below(-x) == pytest.approx(0.5 - inner, abs=CLOSE)
    assert found.above(long + short) == 0 == found.below(-long - short)
    assert found.above((long + short) * (1 - 1e-9)) > 0
    beta = (long - short) / (long + short)
    if beta < 0.95 / (2 - 0.95):
        factor = (1 - math.sqrt(0.05 * (1 - beta**2))) / math.sqrt((1 + beta**2) / 6)
        assert found.half(0.95) == pytest.approx(factor, abs=CLOSE)


@pytest.mark.parametrize(
    ("other", "size"),
    [
        (NORMAL, 0.3), (NORMAL, 1.0), (NORMAL, 3.0), (RECTANGULAR, 1.0), (source(Shape.TRIANGULAR), 0.7),
        (source(Shape.STUDENT, 3), 1.0), (source(Shape.STUDENT, 1), 0.5),
        (ESTIMATE, 1.0), (ESTIMATE, -1.0),
        (source(Shape.TRUNCATED, law=TruncatedNormal(-0.5, math.inf)), -0.6),
    ],
)  # fmt: skip
def test_beside_a_rectangular_error_it_is_a_mean_of_the_other(other: ErrorSource, size: float) -> None:
    """Of what the other one has beyond, over the width."""
    found, u = known((RECTANGULAR, 1.0), (other, size)), math.hypot(1, size)
    half = math.sqrt(3)

    def above(y: mpmath.mpf) -> float:
        z = float(y) / abs(size)
        if size < 0 and other.law:
            return 1 - beyond(-z, other.shape, other.dof, other.law)
        return beyond(z, other.shape, other.dof, other.law)

    for z in (-2.0, -0.5, 0.0, 1.0, 1.7, 3.0, 6.0):
        kinks = (0.0, *(s * DIVISORS[other.shape] * abs(size) for s in (-1, 1)))
        corner = [each for each in kinks if z * u - half < each < z * u + half]
        ends = sorted([z * u - half, *corner, z * u + half])
        whole = mpmath.quad(above, ends) / (2 * half)
        assert found.above(z) == pytest.approx(float(whole), abs=1e-5 if other.dof < 2 else CLOSE)


def test_two_arcsine_errors() -> None:
    found, u = known((ARCSINE, 1.0), (ARCSINE, 0.8)), math.hypot(1, 0.8)
    for z in (0.5, 1.0, 1.5, 1.9):

        def above(turn: mpmath.mpf, z: float = z) -> float:
            left = (z * u / math.sqrt(2) - math.sin(turn)) / 0.8
            return 0.5 - math.asin(min(max(left, -1.0), 1.0)) / math.pi

        kinks = [math.asin(x) for x in (z * u / 2**0.5 - 0.8, z * u / 2**0.5 + 0.8) if abs(x) < 1]
        whole = mpmath.quad(above, [-math.pi / 2, *kinks, math.pi / 2]) / math.pi
        assert found.above(z) == pytest.approx(float(whole), abs=CLOSE)


ENDED = st.sampled_from([Shape.RECTANGULAR, Shape.TRIANGULAR, Shape.ARCSINE])


@settings(deadline=None, max_examples=8)
@given(st.lists(st.tuples(ENDED, st.floats(0.05, 1)), min_size=2, max_size=12))
def test_moments_and_ends_are_those_of_a_sum(parts: list[tuple[Shape, float]]) -> None:
    found = known(*((source(shape), size) for shape, size in parts))
    u = math.hypot(*(size for _, size in parts))
    fourth = {Shape.RECTANGULAR: -1.2, Shape.TRIANGULAR: -0.6, Shape.ARCSINE: -1.5}
    assert found.mean == pytest.approx(0, abs=1e-9)
    assert found.moment(3) == pytest.approx(0, abs=1e-9)
    # what an arcsine error has in the bins at its ends goes with the root of their width; of each error
    bins = len(parts) * 2048**-1.5
    assert found.moment(4) == pytest.approx(3 + sum(fourth[s] * (c / u) ** 4 for s, c in parts), abs=3 * bins)
    assert found.ends[1] == pytest.approx(sum(DIVISORS[s] * c / u for s, c in parts), rel=1e-11)
    assert found.above(1.3) + found.below(1.3) == pytest.approx(1, abs=1e-9)


def test_many_small_errors_are_nearly_normal() -> None:
    found = known(*[(RECTANGULAR, 1.0)] * 400)
    # of the excess kurtosis -1.2/400; what is taken as normal leaves out so much of it at most
    assert found.half(0.95) == pytest.approx(1.959964 - 0.0687 * 1.2 / 400, abs=0.0687 * 1.5 * LITTLE)


def test_thousands_of_errors_come_to_a_normal_one_in_no_time() -> None:
    """Those of a size, or beside a large one, whose shape is seen: then it is what it was within 4e-5."""
    (only,) = known(*[(RECTANGULAR, 1.0)] * 5000).parts
    assert (only.shape, only.size) == (Shape.NORMAL, pytest.approx(1, rel=1e-9))
    beside = known((RECTANGULAR, 40.0), *[(RECTANGULAR, 0.4)] * 400)
    assert [part.shape for part in beside.parts] == [Shape.RECTANGULAR, Shape.NORMAL]
    whole = Convolved([_Part(Shape.RECTANGULAR, size / math.hypot(40, 8)) for size in (40.0, *[0.4] * 400)])
    assert len(known(*[(RECTANGULAR, 1.0)] * 50).parts) == 50
    for z in (1.0, 1.6, 1.7, 1.8, 2.0):
        assert beside.above(z) == pytest.approx(whole.above(z), abs=4e-5)


def test_what_is_all_normal_or_t_is_not_convolved() -> None:
    student = source(Shape.STUDENT, 5)
    assert of((NORMAL, 1.0), (student, 1.0)) is None
    assert of((NORMAL, 1.0), (source(Shape.RECTANGULAR, 7), 1.0)) is None  # its limits are not certain
    assert of((RECTANGULAR, 1.0), (RECTANGULAR, 1.0), pairs=((0, 1, 0.5),)) is None  # drawn as normal, too


def test_errors_of_one_estimate_have_one_t_distribution() -> None:
    """Correlated or not, a sum of them is t, of their degrees of freedom."""
    some = [(RECTANGULAR, 1.0), *((source(Shape.STUDENT, 4, sample="e"), size) for size in (0.6, 0.8))]
    one = known((RECTANGULAR, 1.0), (source(Shape.STUDENT, 4), 1.0))
    assert known(*some).above(1.5) == pytest.approx(one.above(1.5), abs=1e-12)
    found = of(*some, pairs=((1, 2, 0.5),))
    assert found is not None
    assert found.parts[1].size * math.sqrt(2) == pytest.approx(math.sqrt(1.48))


def test_rows_of_one_table_stay_together() -> None:
    draws = np.random.default_rng(3).exponential(1, (2, 4000))
    laws = [Samples.around(0.0, each, "mass.csv")[1] for each in (draws[0], draws[0] + 0.5 * draws[1])]
    parts = [(source(Shape.SAMPLES, law=law), size) for law, size in zip(laws, (1.0, -0.7), strict=True)]
    together = laws[0].errors - 0.7 * laws[1].errors
    found = known((NORMAL, 0.2), *parts)
    u = math.sqrt(0.04 + 1 + 0.49)
    for z in (-0.5, 0.0, 0.3):
        mean = np.mean([math.erfc((z * u - each) / 0.2 / math.sqrt(2)) / 2 for each in together])
        # by the rule of succession one more draw lies beyond all others
        assert found.above(z) == pytest.approx(mean, abs=1 / 4000)


def test_beside_a_very_wide_error_one_that_is_less_wide_keeps_its_shape() -> None:
    """Of a t distribution with one degree of freedom a ten thousandth lies beyond 3000 of its widths."""
    parts = [
        (RECTANGULAR, 0.43),
        (source(Shape.STUDENT, 3), 0.32),
        (source(Shape.STUDENT, 1), 0.15),
        (NORMAL, 0.6),
    ]
    draws, size = np.random.default_rng(1), 400_000
    errors = 0.43 * draws.uniform(-(3**0.5), 3**0.5, size) + 0.6 * draws.standard_normal(size)
    errors += 0.32 * draws.standard_t(3, size) + 0.15 * draws.standard_t(1, size)
    u = math.hypot(*(size for _, size in parts))
    found = Convolved([_Part(each.shape, size / u, each.dof) for each, size in parts])
    for z in (1.0, 2.5, 10.0):
        beyond_it = np.mean(np.abs(errors) > z * u)
        spread = math.sqrt(beyond_it / size)
        assert 2 * found.above(z) == pytest.approx(beyond_it, abs=4 * spread)


@pytest.mark.parametrize("more", [(NORMAL, 0.8), (source(Shape.STUDENT, 3), 0.5)])
def test_a_source_with_ends_that_moves_next_to_nothing_changes_nothing(
    more: tuple[ErrorSource, float],
) -> None:
    """An estimate of few degrees of freedom has them together with others, whatever else there is."""
    parts = [(source(Shape.STUDENT, 1), 0.6), more]
    sources, sizes = zip(*parts, strict=True)
    _, dof = of_sum(sources, np.array(sizes), ())
    assert dof == (7 if more[0] is NORMAL else 2)
    for little in (1e-9, 1e-5, 1e-3):
        assert known((RECTANGULAR, little), *parts).half(0.95) == pytest.approx(stdtrit(dof, 0.975), rel=1e-4)
    assert known((RECTANGULAR, 0.3), *parts).half(0.95) < stdtrit(dof, 0.975)
