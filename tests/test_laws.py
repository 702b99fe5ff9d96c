"""Laws of errors against scipy, as they are stated in a folder, and as they go through a sheet."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from helpers import method_folder
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats
from test_monte_carlo import SUM

from loopsheet.derivations.unit_text import parse_unit
from loopsheet.report.cli import main
from loopsheet.report.distribution import Shape
from loopsheet.report.inputs.number_text import read_printed
from loopsheet.report.inputs.stated import Of, StatementError, read_statement
from loopsheet.report.laws import Exponential, Law, TruncatedNormal
from loopsheet.report.messages.errors import InputError
from loopsheet.report.quantity import Bounds
from loopsheet.report.result.result import Report
from loopsheet.report.study import Study
from loopsheet.report.uncertainty.conformity import beyond
from loopsheet.report.uncertainty.monte_carlo import draw
from loopsheet.report.uncertainty.propagation import Spread

MM = parse_unit("mm")
LAWS: dict[str, tuple[Law, stats.rv_continuous]] = {
    "exponential": (Exponential(), stats.expon(loc=-1)),
    **{
        f"{low} to {high}": (law, stats.truncnorm(low, high, scale=1 / law.sd))
        for low, high in [(0, math.inf), (-1, math.inf), (-math.inf, 0.3), (-0.5, 2), (-9, 9)]
        for law in [TruncatedNormal(low, high)]
    },
}


@pytest.mark.parametrize("name", LAWS)
def test_a_law_is_that_of_scipy(name: str) -> None:
    law, known = LAWS[name]
    skewness, kurtosis = (float(each) for each in known.stats(moments="sk"))
    assert float(known.std()) == pytest.approx(1, rel=1e-9)
    assert law.mean == pytest.approx(float(known.mean()), abs=1e-9)
    assert (law.moment(3), law.moment(4)) == pytest.approx((skewness, kurtosis + 3), rel=1e-7, abs=1e-9)
    shares = np.linspace(0.001, 0.999, 21)
    assert law.quantile(shares) == pytest.approx(known.ppf(shares), rel=1e-9, abs=1e-9)
    for z in np.linspace(-3, 3, 13):
        assert law.below(z) == pytest.approx(float(known.cdf(z)), abs=1e-12)
        assert law.turned().below(z) == pytest.approx(float(known.sf(-z)), abs=1e-12)
        assert beyond(z, Shape.TRUNCATED, math.inf, law) == pytest.approx(float(known.sf(z)), abs=1e-12)
    assert law.turned().quantile(shares) == pytest.approx(-known.isf(shares), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", ["exponential", "0 to inf", "-1 to inf"])
def test_what_is_little_far_out_keeps_its_digits(name: str) -> None:
    law, known = LAWS[name]
    for z in (3.0, 9.0, 20.0):
        tail = float(known.sf(z))
        assert law.above(z) == pytest.approx(tail, rel=1e-9)
        assert law.turned().below(-z) == pytest.approx(tail, rel=1e-9)


@pytest.mark.parametrize("width", [1e-3, 1e-7, 1e-20, 1e-60])
def test_a_normal_error_far_wider_than_its_ends_is_rectangular(width: float) -> None:
    law = TruncatedNormal(-width, 3 * width)
    shares, level = np.array([0.0, 0.25, 0.5, 1.0]), stats.uniform(-math.sqrt(3) / 2, 2 * math.sqrt(3))
    assert law.quantile(shares) == pytest.approx(level.ppf(shares), abs=1e-5)
    for z in (-0.5, 0.0, 1.0):
        assert (law.below(z), law.above(z)) == pytest.approx((level.cdf(z), level.sf(z)), abs=1e-5)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("level", [0.5, 0.95, 0.9545])
def test_a_coverage_factor_holds_its_share_around_the_value(name: str, level: float) -> None:
    law, known = LAWS[name]
    k = law.half(level)
    assert float(known.cdf(k) - known.cdf(-k)) == pytest.approx(level, abs=1e-12)


@given(st.floats(0, 8), st.floats(1e-3, 8))
def test_standard_deviations_of_cut_normal_errors(below: float, above: float) -> None:
    law, known = TruncatedNormal(-below, above), stats.truncnorm(-below, above)
    # scipy's own is a difference: it has 1e-9 of a width squared of a thousandth left, times 1e6
    assert law.sd == pytest.approx(float(known.std()), rel=1e-5)
    assert law.mean * law.sd == pytest.approx(float(known.mean()), abs=1e-8)
    assert law.sd <= min(1, (below + above) / 12**0.5) * (1 + 1e-12)


def test_between_near_ends_it_is_rectangular() -> None:
    assert TruncatedNormal(-1e-6, 1e-6).sd == pytest.approx(1e-6 / 3**0.5, rel=1e-10)


# --- stated -----------------------------------------------------------------------------------------------


def stated(text: str, number: str = "0.30", bounds: Bounds | None = None) -> tuple[float, Shape, Law | None]:
    """Standard uncertainty in mm, shape and law of what is stated of a number in mm."""
    printed = read_printed(number, MM)
    (error,) = read_statement(text, MM, None, Of((printed,), bounds or Bounds())).of(printed)
    return error.u * 1000, error.shape, error.law


@pytest.mark.parametrize(
    ("text", "low", "high"),
    [
        ("u = 0.2, min = 0", -1.5, math.inf),
        ("U = 0.4, k = 2, min = 0 mm, max = 400 um", -1.5, 0.5),
        ("u = 200 um, max = 0.3", -math.inf, 0.0),
        ("u = 0.2, min = -0.1", -2.0, math.inf),
        ("u = 0.2, truncated", -1.5, 3.5),
    ],
)
def test_a_normal_error_that_leaves_no_bounds(text: str, low: float, high: float) -> None:
    u, shape, law = stated(text, bounds=Bounds(low=0, high=0.001))
    assert shape is Shape.TRUNCATED
    assert isinstance(law, TruncatedNormal)
    assert (law.low, law.high) == pytest.approx((low, high), rel=1e-12)
    assert u == pytest.approx(0.2 * float(stats.truncnorm(low, high).std()), rel=1e-9)


def test_an_estimate_alone_is_exponential() -> None:
    u, shape, law = stated("exponential")
    assert (u, shape) == (pytest.approx(0.3, rel=1e-15), Shape.EXPONENTIAL)
    assert isinstance(law, Exponential)
    assert stated("u = 0, min = 0") == (0, Shape.TRUNCATED, None)


@pytest.mark.parametrize(
    ("text", "culprit", "start"),
    [
        ("u = 0.2, min = 0.4", "u = 0.2, min = 0.4", 0),
        ("u = 0.2, max = 0.2", "u = 0.2, max = 0.2", 0),
        ("u = 0.2, max = 0.1, min = 0.5", "min = 0.5", 20),
        ("u = 0.2, min = 0, min = 0", "min = 0", 18),
        ("u = 0.2, min = 1 %", "min = 1 %", 9),
        ("u = 0.2, min = 1 s", "s", 17),
        ("u = 0.2, min = x", "x", 15),
        ("u = 0.2, min = ", "", 14),
        ("u = 0.2, dof = 5, min = 0", "min = 0", 18),
        ("u = 0.2, truncated", "truncated", 9),
        ("u = 0.2, truncated, min = 0", "truncated", 9),
        ("u = 0.2, truncated at 0", "truncated at 0", 9),
        ("+-0.2 rect, min = 0", "min = 0", 12),
        ("samples = draws.csv", "samples = draws.csv", 0),
        ("samples =", "samples =", 0),
        ("exponential, dof = 3", "exponential, dof = 3", 0),
    ],
)
def test_what_is_refused_and_where(text: str, culprit: str, start: int) -> None:
    with pytest.raises(StatementError) as refused:
        stated(text)
    assert (refused.value.code, refused.value.text, refused.value.start) == ("LS431", culprit, start)


@pytest.mark.parametrize("number", ["0.00", "-0.30"])
def test_what_is_not_positive_is_not_exponential(number: str) -> None:
    with pytest.raises(StatementError, match="LS431"):
        stated("exponential", number)


@pytest.mark.parametrize("text", ["exponential", "u = 0.2, min = 0", "samples = draws.csv"])
def test_what_cells_share_is_an_error_around_nothing(text: str) -> None:
    with pytest.raises(StatementError, match="LS431"):
        read_statement(text, MM)


# --- in a folder ------------------------------------------------------------------------------------------

Make = Callable[..., Report]


@pytest.fixture
def made(tmp_path: Path) -> Make:
    """Compute a sum of four terms, of which this is given."""

    def made(*terms: str, draws: str = "", more: str = "") -> Report:
        (tmp_path / "draws.csv").write_text(draws, encoding="utf-8")
        terms = (*terms, *["0, exact"] * (4 - len(terms)))
        said = "".join(f'x_{n} = "{text}"\n' for n, text in enumerate(terms, start=1))
        method_folder(tmp_path, SUM, "test,r [1]\n1,1\n2,2\n", f"[parameters]\n{said}{more}")
        return Study(tmp_path).computed

    return made


@pytest.mark.parametrize(
    ("term", "known"),
    [
        ("2, exponential", stats.expon(scale=2)),
        ("0.5, u = 2, min = 0", stats.truncnorm(-0.25, math.inf, loc=0.5, scale=2)),
        ("0.5, u = 2, min = -1, max = 3", stats.truncnorm(-0.75, 1.25, loc=0.5, scale=2)),
    ],
)
def test_both_methods_know_the_distribution(made: Make, term: str, known: stats.rv_continuous) -> None:
    report = made(term)
    budget = Spread(report.inputs, report.values).budget("y", 0)
    assert budget.u == pytest.approx(float(known.std()), rel=1e-9)
    inside = known.cdf(budget.value + budget.expanded) - known.cdf(budget.value - budget.expanded)
    assert float(inside) == pytest.approx(0.95, abs=1e-9)
    found = draw(report.inputs, report.values, budget, 400_000, tolerance=0.0)
    assert found.mean == pytest.approx(float(known.mean()), abs=5 * budget.u / 400_000**0.5)
    assert found.u == pytest.approx(budget.u, rel=0.01)
    assert found.symmetric == pytest.approx(known.ppf([0.025, 0.975]), abs=0.02)


def table(size: int = 5_000) -> tuple[np.ndarray, str]:
    """Draws of two terms that hang together: neither is normal."""
    generator = np.random.default_rng(7)
    one = generator.gamma(2.0, 1.0, size)
    both = np.stack([one, 3 - one + generator.random(size)], axis=1)
    return both, "x_1 [1],x_2 [1],other\n" + "".join(f"{a!r},{b!r},-\n" for a, b in both.tolist())


def test_draws_that_somebody_else_made(made: Make) -> None:
    both, text = table()
    report = made("2.0, samples = draws.csv", draws=text)
    budget = Spread(report.inputs, report.values).budget("y", 0)
    assert budget.u == pytest.approx(both[:, 0].std(ddof=1), rel=1e-12)
    assert budget.factor * budget.u == pytest.approx(np.quantile(abs(both[:, 0] - 2), 0.95), rel=1e-3)
    found = draw(report.inputs, report.values, budget, 300_000, tolerance=0.0)
    assert found.symmetric == pytest.approx(np.quantile(both[:, 0], [0.025, 0.975]), abs=0.03)
    assert found.mean == pytest.approx(both[:, 0].mean(), abs=0.02)
    assert draw(report.inputs, report.values, budget, 20_000) == draw(
        report.inputs, report.values, budget, 20_000
    )
    assert "draws.csv" in report.inputs.files


def test_draws_of_one_table_stay_together(made: Make) -> None:
    both, text = table()
    more = '[uncertainty]\nx_2 = "samples = draws.csv"\n'
    report = made("2.0, samples = draws.csv", "1.5", draws=text, more=more)
    budget = Spread(report.inputs, report.values).budget("y", 0)
    assert budget.u == pytest.approx(both.sum(axis=1).std(ddof=1), rel=1e-9)
    assert budget.u < 0.5 * both[:, 0].std(ddof=1)
    found = draw(report.inputs, report.values, budget, 200_000, tolerance=0.0)
    assert found.u == pytest.approx(budget.u, rel=0.01)
    assert found.symmetric == pytest.approx(np.quantile(both.sum(axis=1), [0.025, 0.975]), abs=0.02)


def test_draws_whose_sum_does_not_vary(made: Make) -> None:
    """Shares of one whole: beside them another error is alone."""
    draws = "x_1 [1],x_2 [1]\n" + 50 * "0.25,0.75\n0.5,0.5\n0.75,0.25\n"
    more = '[uncertainty]\nx_2 = "samples = draws.csv"\n'
    report = made("0.5, samples = draws.csv", "0.5", "2.0, +-0.1 rect", draws=draws, more=more)
    budget = Spread(report.inputs, report.values).budget("y", 0)
    assert budget.expanded == pytest.approx(0.095, rel=1e-9)


@pytest.mark.parametrize("error", ["+-1e-251 rect", "u = 1e-251"])
def test_what_is_next_to_nothing_beside_another_error(made: Make, error: str) -> None:
    report = made("1.00, +-0.05 tri", f"1e-250, {error}")
    budget = Spread(report.inputs, report.values).budget("y", 0)
    assert budget.factor == pytest.approx(math.sqrt(6) * (1 - math.sqrt(0.05)), rel=1e-6)


def test_two_errors_of_one_number_that_are_said_alike(made: Make) -> None:
    """They are two, in a budget and where they are drawn."""
    error = "u = 0.50, min = 0.5, max = 1.5"
    report = made(f"1.00, {error}; {error}")
    budget = Spread(report.inputs, report.values).budget("y", 0)
    assert len({each.source.name for each in budget.contributions}) == 2
    found = draw(report.inputs, report.values, budget, 100_000, tolerance=0.0)
    assert found.u == pytest.approx(budget.u, rel=0.01)


def test_a_square_of_what_is_exponential_to_second_order(tmp_path: Path) -> None:
    """Of x**2 with mean m the variance is 20 m**4, of which the skewness makes 8."""
    own = SUM.replace("sum(c.symbol for c in x)", "x[0].symbol**2").replace("(r, *x, y)", "(r, x[0], y)")
    own = own.replace("for name in names),", "for name in names[:1]),")
    method_folder(tmp_path, own, "test,r [1]\n1,1\n2,2\n", '[parameters]\nx_1 = "3, exponential"\n')
    report = Study(tmp_path).computed
    assert Spread(report.inputs, report.values).budget("y", 0).u == pytest.approx(
        math.sqrt(20 * 81), rel=1e-9
    )


@pytest.mark.parametrize(
    ("draws", "code"),
    [
        ("x_2 [1]\n" + "1\n2\n" * 60, "LS301"),
        ("x_1 [kg]\n" + "1\n3\n" * 60, "LS422"),
        ("x_1 [1]\n" + "1\nthree\n" * 1 + "1\n" * 200, "LS401"),
        ("x_1 [1]\n" + "2\n" * 200, "LS436"),
        ("x_1 [1]\n" + "5\n6\n" * 60, "LS431"),
        ("", "LS111"),
    ],
)
def test_what_is_wrong_with_a_table_is_told(made: Make, draws: str, code: str) -> None:
    with pytest.raises(InputError) as refused:
        made("2.0, samples = draws.csv", draws=draws)
    assert [found.code for found in refused.value.diagnostics] == [code]


def test_a_correlation_of_draws_is_not_stated_again(made: Make) -> None:
    more = '[uncertainty]\nx_1 = "samples = draws.csv"\nx_2 = "u = 1"\n'
    more += '[uncertainty.correlation]\n"x_1, x_2" = "0.5"\n'
    with pytest.raises(InputError) as refused:
        made("2.0", "1.5", draws=table()[1], more=more)
    assert [found.code for found in refused.value.diagnostics] == ["LS434"]


def test_the_budget_names_them(made: Make, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    made(
        "2, exponential",
        "1, u = 2, min = 0",
        "2.0, samples = draws.csv",
        draws=table()[1].replace("x_1", "x_3"),
    )
    assert main(["budget", "y", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    far = float(stats.truncnorm(-0.5, math.inf).mean()) * 2  # of 1, u = 2, min = 0
    assert f"the expectation of x_2 lies {far:.1f} above the given number: --draws counts it" in told
    assert "expectation of x_1" not in told
    assert all(f"  {shape}" in told for shape in ("exponential", "truncated normal", "samples"))
