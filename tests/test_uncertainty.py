"""The law of propagation over whole sheets: the paper, published budgets, and differences of whole sheets."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from statistics import NormalDist
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array
from small_report import end_gauge

from loopsheet.report.distribution import Shape
from loopsheet.report.engines.numpy import evaluate
from loopsheet.report.judge import chain
from loopsheet.report.result.result import Report
from loopsheet.report.result.uncertain import ErrorSource
from loopsheet.report.study import Study
from loopsheet.report.uncertainty import large, propagation, second_order
from loopsheet.report.uncertainty.coverage import assigned, coverage, effective
from loopsheet.report.uncertainty.large import Contributions
from loopsheet.report.uncertainty.propagation import Spread

PAPER = Path(__file__).parent.parent / "data" / "soft_steel"


@pytest.fixture(scope="module")
def paper() -> Report:
    """The shipped paper, computed."""
    return Study(PAPER).computed


@pytest.fixture(scope="module")
def spread(paper: Report) -> Spread:
    """Its uncertainties."""
    return Spread(paper.inputs, paper.values)


# --- the paper --------------------------------------------------------------------------------------------


def test_the_ten_exponents(spread: Spread) -> None:
    known = [0.0156, 0.0059, 0.0045, 0.0039, 0.0087, 0.0057, 0.0046, 0.0196, 0.0096, 0.0113]
    assert spread.u("alpha") == pytest.approx(known, abs=5.1e-5)


def test_a_mean_of_what_shares_tests_has_the_variance_it_has(spread: Spread) -> None:
    (u,) = spread.u("alpha_mean")
    assert u == pytest.approx(0.0035015, abs=5e-8)
    covariance = spread.covariance([("alpha", row) for row in range(10)])
    assert math.sqrt(covariance.sum()) / 10 == pytest.approx(u, rel=1e-12)
    assert np.sqrt(np.diag(covariance)) == pytest.approx(spread.u("alpha"), rel=1e-12)


def test_ten_pairs_of_five_tests_have_four_ways_to_vary(spread: Spread) -> None:
    covariance = spread.covariance([("alpha", row) for row in range(10)])
    scale = np.sqrt(np.diag(covariance))
    found = np.linalg.eigvalsh(covariance / np.outer(scale, scale))[::-1]
    assert found[:4] == pytest.approx([3.5, 3.0, 2.1, 1.4], abs=0.06)
    assert abs(found[4:]).max() < 1e-3


def test_the_interval_of_the_mean(spread: Spread) -> None:
    budget = spread.budget("alpha_mean", 0)
    ends = budget.value - budget.expanded, budget.value + budget.expanded
    assert ends == pytest.approx((1.29590, 1.30939), abs=5e-6)
    assert sum(each.share for each in budget.contributions) == pytest.approx(1, rel=1e-12)
    assert [each.source.name for each in budget.contributions][:3] == ["x_p[1]", "x_p[3]", "e[5]"]


def test_what_is_exact_has_no_uncertainty_and_moves_nothing(spread: Spread) -> None:
    assert spread.u("beta").tolist() == spread.u("points_per_pair").tolist() == [0]
    budget = spread.budget("beta", 0)
    assert (budget.u, budget.contributions, budget.is_known) == (0, (), True)


def test_of_a_large_sheet_what_rests_on_no_generated_rows(
    paper: Report, monkeypatch: pytest.MonkeyPatch, spread: Spread
) -> None:
    monkeypatch.setattr(propagation, "LARGEST", 10)
    large = Spread(paper.inputs, paper.values)
    assert large.u("alpha_mean") == pytest.approx(spread.u("alpha_mean"), rel=1e-12)
    assert np.isnan(large.u("alpha_log")).all()
    assert not large.budget("alpha_log", 0).is_known


def test_in_parts_it_is_the_same(paper: Report, monkeypatch: pytest.MonkeyPatch, spread: Spread) -> None:
    monkeypatch.setattr(propagation, "AT_ONCE", 1)
    assert Spread(paper.inputs, paper.values).u("C") == pytest.approx(spread.u("C"), rel=1e-14)


MATRIX = '\n[uncertainty.correlation]\n"v, x_p" = "0.4"\n"e, x_p" = "-0.3"\n'


@pytest.mark.parametrize("more", ["", MATRIX])
def test_without_the_zeros_it_is_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, more: str) -> None:
    """What rests on no sum has the same variances, and moves the same in other reports."""
    _shared(tmp_path)
    with (tmp_path / "report.toml").open("a", encoding="utf-8") as file:
        file.write(more)
    report = Study(tmp_path).computed
    monkeypatch.setattr(second_order, "LARGEST", 1)  # else all is of one block
    whole = Spread(report.inputs, report.values)
    columns = [column.name for column in report.sheet.columns if whole.knows(column.name)]
    beside = {name: (whole.variances(name), whole.influence([], [name]).rows) for name in columns}
    monkeypatch.setattr(propagation, "AT_ONCE", 1)
    kinds = {name: {type(own) for _, own in whole._blocks(name)} for name in columns}
    assert kinds["x_m1"] == kinds["alpha"] == {csr_array}
    assert kinds["C"] == kinds["alpha_mean"] == {Contributions}
    lost = large.LEFT**-1 * 2.0**-51  # where terms of a variance cancel
    for name, (variances, _) in beside.items():
        assert whole.variances(name) == pytest.approx(variances, rel=lost, abs=0, nan_ok=True)
    monkeypatch.setattr(Contributions, "filled", 0)
    for name, (variances, rows) in beside.items():
        assert whole.variances(name) == pytest.approx(variances, rel=1e-13, abs=0, nan_ok=True)
        few = whole.influence([], [name]).rows
        assert few.keys() == rows.keys()
        for cell, moved in few.items():
            assert dict(moved) == pytest.approx(dict(rows[cell]), rel=1e-13)


ABOUT_MEANS = """
from loopsheet import Method, groups, let, mean, measured

class Densities(Method):
    "Densities about their mean."
    m = measured("g", "mass")
    V = measured("mL", "volume")
    rho = let(m / V, "density")
    rho_mean = let(mean(rho), "their mean")
    V_mean = let(mean(V), "mean volume")
    deviation = let(rho - rho_mean, "deviation")
    share = let(V / V_mean, "share")
    both = let(deviation * share, "both")
    again = let(deviation + rho_mean - rho, "nothing")
    relative = let(rho / rho_mean, "relative density")
    lot = groups("lot")
    of_lot = let(mean(rho, of=lot), "mean of a lot")
    off = let(rho - of_lot, "from the mean of its lot")
    between = let(of_lot - mean(of_lot), "between lots")
    scatter = let(sum(off**2), "scatter in lots")
"""
OF_MANY = """
workbook = "workbook.py"
[measurements]
file = "measurements.csv"
[uncertainty]
m = "u = 2 mg"
V = "u = 0.3 %"
[uncertainty.correlation]
"m, V" = "0.4"
[uncertainty.shared.balance]
of = "m"
stated = "u = 1 % of reading"
"""


def test_about_their_means_many_rows_have_what_few_have(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A balance that reads too high moves no relative density; also where only what is left is looked at."""
    (tmp_path / "workbook.py").write_text(ABOUT_MEANS, encoding="utf-8")
    (tmp_path / "report.toml").write_text(OF_MANY, encoding="utf-8")
    rows = "1,A,20,10\n2,B,31,15\n3,A,12.5,7\n4,B,18,9.1\n5,A,14,7.2\n"
    (tmp_path / "measurements.csv").write_text(f"reading,lot,m [g],V [mL]\n{rows}", encoding="utf-8")
    report = Study(tmp_path).computed
    monkeypatch.setattr(second_order, "LARGEST", 1)  # else all is of one block
    spread = Spread(report.inputs, report.values)
    columns = [column.name for column in report.sheet.columns]
    few = {name: spread.variances(name) for name in columns}
    assert few["again"][0] == pytest.approx(0)
    monkeypatch.setattr(chain, "MOST", 0)
    spread = Spread(report.inputs, report.values)
    scalars = {column.name for column in report.sheet.columns if column.axis is None}
    assert any(name not in scalars for name in spread._along.chain.hubs)
    for name in columns:
        assert spread.variances(name) == pytest.approx(few[name], rel=1e-12, nan_ok=True, abs=1e-40)
    monkeypatch.setattr(propagation, "AT_ONCE", 1)
    monkeypatch.setattr(Contributions, "filled", 2)
    for left in (0.0, large.LEFT, 1.0):  # of what cancels; at last all is found from all errors
        monkeypatch.setattr(large, "LEFT", left)
        for name in columns:
            assert spread.variances(name) == pytest.approx(few[name], rel=1e-12, nan_ok=True, abs=1e-40)


# --- against whole sheets ---------------------------------------------------------------------------------


@settings(max_examples=10, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.floats(-0.02, 0.02), min_size=15, max_size=15))
def test_any_campaign_against_differences(paper: Report, shifts: list[float]) -> None:
    """Each source up and down by a thousandth of itself, through the engine."""
    sheet, base = paper.sheet, paper.values
    names = ("v", "e", "x_p")
    moved = {
        name: base.value[name] * (1 + np.array(shifts[5 * n : 5 * n + 5])) for n, name in enumerate(names)
    }
    data = {name: base.value[name] for name in sheet.bounds} | moved
    labels = {"tests": paper.inputs.only.tests}
    values = evaluate(sheet, labels, data)
    own = Spread(paper.inputs, values)
    if own.second is not None and np.isnan(values.value["alpha"]).any():
        return  # a pair without a root: told of elsewhere
    variance: dict[str, Any] = dict.fromkeys(("alpha", "alpha_mean", "C_log", "Cprime_eq7"))
    number = len(own.sources)
    beside = {name: np.tile(np.asarray(column, dtype=float), (2, number, 1)) for name, column in data.items()}
    for n, source in enumerate(own.sources):
        for name, row, u in source.moves:
            beside[name][:, n, row] += (1e-3 * u, -1e-3 * u)
    for name in ("beta", "points_per_pair"):
        beside[name] = data[name]
    sides = evaluate(sheet, labels, beside)
    for name in variance:
        up, down = sides.value[name]
        variance[name] = np.sum(((up - down) / 2e-3) ** 2, axis=0)
    for name, found in variance.items():
        first = own._variance(own.contributions([(name, row) for row in range(len(values.status[name]))]))
        assert first == pytest.approx(found, rel=1e-5)


# --- published budgets ------------------------------------------------------------------------------------

H1 = """\
workbook = "workbook.py"
[parameters]
l_S = "50.000623 mm, U = 0.075 um, k = 3, dof = 18"
dalpha = "0 K^-1, +-1e-6 rect, dof = 50"
alpha_S = "11.5e-6 K^-1, +-2e-6 rect"
theta = "-0.1 K, u = 0.2"
cycle = "0 +-0.5 K arcsine"
dtheta = "0 K, +-0.05 rect, dof = 2"
[measurements]
file = "d.csv"
[uncertainty]
d = "u = 5.8 nm, dof = 24; u = 3.9 nm, dof = 5; u = 6.7 nm, dof = 8"
"""


@pytest.fixture
def gauge_block(tmp_path: Path) -> Callable[..., Spread]:
    """The uncertainties of the end gauge, with its report.toml changed."""

    def made(*changes: tuple[str, str]) -> Spread:
        text = H1
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        end_gauge(tmp_path, report=text)
        report = Study(tmp_path).computed
        return Spread(report.inputs, report.values)

    return made


def test_end_gauge(gauge_block: Callable[..., Spread]) -> None:
    """JCGM 100:2008, H.1: 32 nm to first order, 16 degrees of freedom, 34 nm with the second order."""
    budget = gauge_block().budget("l", 0, 0.99)
    assert math.sqrt(budget.u**2 - budget.second) * 1e9 == pytest.approx(31.7, abs=0.05)
    assert round(budget.u * 1e9) == 34
    assert (budget.dof, round(budget.factor, 2)) == (16, 2.92)
    known = {"l_S": 25, "dtheta": 16.6, "dalpha": 2.9}
    found = {each.source.name: abs(each.u) * 1e9 for each in budget.contributions}
    assert {name: found[name] for name in known} == pytest.approx(known, abs=0.05)
    three = sum(u**2 for name, u in found.items() if name.startswith("d["))
    assert math.sqrt(three) == pytest.approx(9.7, abs=0.05)
    # u(alpha_S) and u(theta) contribute nothing to first order; the terms of H.1.7 are 11.7 nm and 1.7 nm.
    assert {"alpha_S", "theta", "cycle"}.isdisjoint(found)
    assert math.sqrt(budget.second) * 1e9 == pytest.approx(math.hypot(11.7, 1.7), abs=0.05)


def test_where_first_order_is_nothing(gauge_block: Callable[..., Spread]) -> None:
    """A product of two errors around zero."""
    exact = [("U = 0.075 um, k = 3, dof = 18", "exact"), ("+-0.05 rect, dof = 2", "exact")]
    d = ('d = "u = 5.8 nm, dof = 24; u = 3.9 nm, dof = 5; u = 6.7 nm, dof = 8"', 'd = "exact"')
    budget = gauge_block(*exact, d, ("-0.1 K, u = 0.2", "0 K, u = 0.2")).budget("l", 0)
    product = 0.050000623 * 1e-6 / 3**0.5 * math.hypot(0.2, 0.5 / 2**0.5)
    assert (budget.u, budget.contributions) == (pytest.approx(product, rel=1e-9), ())


@pytest.mark.parametrize(("r", "factor"), [("1", 2.0), ("-1", 0.0), ("0.5", math.sqrt(3))])
def test_correlation(gauge_block: Callable[..., Spread], r: str, factor: float) -> None:
    """Two equal contributions: as amounts if fully correlated, nothing if against one another."""
    spread = gauge_block(
        ("l_S = ", 'cycle = "0 K, exact"\nl_S = '),
        ('cycle = "0 +-0.5 K arcsine"\n', ""),
        ("U = 0.075 um, k = 3, dof = 18", "u = 10 nm"),
        ("+-1e-6 rect, dof = 50", "exact"),
        ("+-2e-6 rect", "exact"),  # its product with dtheta is of second order
        ("+-0.05 rect, dof = 2", f"u = {10e-9 / (0.050000623 * 11.5e-6)!r}"),
        ('d = "u = 5.8 nm, dof = 24; u = 3.9 nm, dof = 5; u = 6.7 nm, dof = 8"', 'd = "exact"'),
        ("[measurements]", f'[uncertainty.correlation]\n"l_S, dtheta" = "{r}"\n[measurements]'),
        ("[uncertainty]\n", "[uncertainty]\ntheta = 'exact'\n"),
        ("-0.1 K, u = 0.2", "-0.1 K"),
    )
    budget = spread.budget("l", 0)
    # dtheta lowers the length: what correlates positively cancels
    opposite = {2.0: 0.0, 0.0: 2.0, math.sqrt(3): 1.0}[factor]
    # the product of the two is of second order: 3e-6 nm
    assert budget.u * 1e9 == pytest.approx(10 * opposite, abs=1e-5)


def test_a_shared_error_does_not_average_out(tmp_path: Path) -> None:
    """Of five offsets the mean keeps a fifth of the variance, of one shared offset all of it."""
    report = Study(PAPER).computed
    base = Spread(report.inputs, report.values)
    everything = [(name, row) for name in ("x_p",) for row in range(5)]
    mean = np.full(5, 0.2)
    apart = mean @ base.covariance(everything) @ mean
    assert apart == pytest.approx(np.sum(base.u("x_p") ** 2) / 25, rel=1e-12)
    stated = replace(report.inputs, uncertainty=_shared(tmp_path))
    shared = Spread(stated, report.values)
    together = mean @ shared.covariance(everything) @ mean
    assert together - apart == pytest.approx((0.2e-6) ** 2 / 3, rel=1e-9)
    groups = {source.name for source in shared.sources if "datum" in source.name}
    assert groups == {"datum"}


GAUGE = """
from loopsheet import Method, let, measured, total

class Gauge(Method, headline="all_gaps"):
    "Two lengths by one gauge."
    a = measured("mm", "first length")
    b = measured("mm", "second length")
    gap = let(a - b, "their difference")
    both = let(a + b, "both")
    area = let(a * b, "area")
    all_gaps = let(total(gap), "all differences")
"""
BY_ONE_GAUGE = """
workbook = "workbook.py"
[measurements]
file = "measurements.csv"
[uncertainty]
a = "u = 0 mm"
b = "u = 0 mm"
[uncertainty.shared.gain]
of = ["a", "b"]
stated = "u = 1 %"
"""


def _by_one_gauge(folder: Path, more: str = "") -> Report:
    (folder / "workbook.py").write_text(GAUGE, encoding="utf-8")
    (folder / "report.toml").write_text(BY_ONE_GAUGE + more, encoding="utf-8")
    (folder / "measurements.csv").write_text(
        "reading,a [mm],b [mm]\n1,50,30\n2,20,40\n3,10,10\n", encoding="utf-8"
    )
    return Study(folder).computed


def test_one_error_of_several_columns(tmp_path: Path) -> None:
    """A gain moves both lengths alike, by its share of each: a difference has its share of the difference."""
    spread = _by_one_gauge(tmp_path).uncertain()
    assert spread.u["gap"] == pytest.approx([0.2e-3, 0.2e-3, 0], rel=1e-12, abs=1e-18)
    assert spread.u["both"] == pytest.approx([0.8e-3, 0.6e-3, 0.2e-3], rel=1e-12)
    assert spread.u["area"] == pytest.approx(
        [2 * 0.01 * 1500e-6, 2 * 0.01 * 800e-6, 2 * 0.01 * 1e-4], rel=1e-12
    )
    assert spread.u["all_gaps"] == pytest.approx([0], abs=1e-18)


def test_one_error_of_several_columns_in_groups(tmp_path: Path) -> None:
    report = _by_one_gauge(tmp_path, "groups = [[1, 3], [2]]\n")
    spread = Spread(report.inputs, report.values)
    assert [source.name for source in spread.sources] == ["gain (readings 1, 3)", "gain (reading 2)"]
    assert report.uncertain().u["all_gaps"] == pytest.approx([0.2e-3 * 2**0.5], rel=1e-12)


def _shared(folder: Path) -> object:
    for name in ("measurements.csv", "published.csv"):
        (folder / name).write_bytes((PAPER / name).read_bytes())
    text = (PAPER / "report.toml").read_text(encoding="utf-8")
    more = '\n[uncertainty.shared.datum]\nof = "x_p"\nstated = "+-0.2 um rect"\n'
    (folder / "report.toml").write_text(text + more, encoding="utf-8")
    return Study(folder).inputs.uncertainty


CAMPAIGN = """\
workbook = "soft_impact"
[parameters]
ball_mass = "8.366 g, exact"
[measurements]
file = "measurements.csv"
[uncertainty]
v = "exact"
e = "exact"
x_p = "exact"
[uncertainty.shared.gain]
of = "x_p"
stated = "u = 1 % of reading"
groups = [[1, 3], [2]]
"""


def test_a_group_may_hold_a_test_that_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "report.toml").write_text(CAMPAIGN, encoding="utf-8")
    rows = "1,2.2,0.535,22.58,\n2,3.1,0.505,31.92,it bounced\n3,4.3,0.47,44.61,\n4,4.9,0.45,50.9,\n"
    table = f"test,v [m/s],e [1],x_p [um],left out\n{rows}"
    (tmp_path / "measurements.csv").write_text(table, encoding="utf-8")
    report = Study(tmp_path).computed
    spread = Spread(report.inputs, report.values)
    assert [source.name for source in spread.sources] == ["gain (tests 1, 3)"]
    assert spread.u("x_p") == pytest.approx([22.58e-8, 44.61e-8, 0])
    # a common scale factor of both depths cancels in the exponent of their pair, to first order and beyond
    assert spread.u("alpha")[0] == pytest.approx(0, abs=1e-12)
    assert spread.u("alpha")[1] > 0.01


GAIN = """workbook = "workbook.py"
[parameters]
b = "-2.5 V, exact"
[measurements]
file = "measurements.csv"
[uncertainty]
V = "exact"
[uncertainty.shared.gain]
of = ["V", "b"]
stated = "u = 1 % of reading"
"""


def test_a_gain_has_the_signs_of_its_readings(tmp_path: Path) -> None:
    """One per cent more of all: a range is so much more, a mean, too, and a ratio is what it was."""
    code = (
        "from loopsheet import Method, given, let, mean, measured\n\nclass Gain(Method):\n    'Readings.'\n"
    )
    code += (
        "    V = measured('V', 'reading')\n    b = given('V', 'other')\n    level = let(mean(V), 'mean')\n"
    )
    code += "    wide = let(max(V) - min(V), 'range')\n    ratio = let(max(V) / b, 'ratio')\n"
    (tmp_path / "workbook.py").write_text(code, encoding="utf-8")
    (tmp_path / "report.toml").write_text(GAIN, encoding="utf-8")
    (tmp_path / "measurements.csv").write_text("reading,V [V]\n1,10.0\n2,-5.0\n", encoding="utf-8")
    report = Study(tmp_path).computed
    spread = Spread(report.inputs, report.values)
    assert [*spread.u("level"), *spread.u("wide")] == pytest.approx([0.025, 0.15], rel=1e-12)
    assert spread.budget("ratio", 0).u == 0


def test_second_order_of_correlated_errors(gauge_block: Callable[..., Spread]) -> None:
    """A correlation of next to nothing changes next to nothing; of a product of two it makes a square."""
    whole = gauge_block().budget("l", 0)
    more = ("[measurements]", '[uncertainty.correlation]\n"theta, alpha_S" = "1e-9"\n[measurements]')
    assert gauge_block(more).budget("l", 0).u == pytest.approx(whole.u, rel=1e-9)
    exact = [("U = 0.075 um, k = 3, dof = 18", "exact"), ("+-0.05 rect, dof = 2", "exact")]
    none = ('d = "u = 5.8 nm, dof = 24; u = 3.9 nm, dof = 5; u = 6.7 nm, dof = 8"', 'd = "exact"')
    product = [*exact, none, ("-0.1 K, u = 0.2", "0 K, u = 0.2"), ("+-0.5 K arcsine", "K, exact")]
    normal = ("+-1e-6 rect, dof = 50", "u = 1e-6")
    one = ("[measurements]", '[uncertainty.correlation]\n"theta, dalpha" = "1"\n[measurements]')
    size = 0.050000623 * 1e-6 * 0.2
    assert gauge_block(*product, normal).budget("l", 0).u == pytest.approx(size, rel=1e-9)
    # the product of two errors that are one is the square of one, of which the variance is 2
    assert gauge_block(*product, normal, one).budget("l", 0).u == pytest.approx(size * 2**0.5, rel=1e-9)


def test_what_cannot_be_looked_at_is_told(paper: Report, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(second_order, "LARGEST", 1)
    large = Spread(paper.inputs, paper.values).budget("alpha", 0)
    assert large.unlooked == "the sheet is too large for that"
    monkeypatch.undo()
    assert Spread(paper.inputs, paper.values).budget("alpha", 0).unlooked == ""


# --- coverage ---------------------------------------------------------------------------------------------


NORMAL = 1.9599639845400536


def source(shape: Shape, dof: float = math.inf) -> ErrorSource:
    """An error of no number in particular."""
    return ErrorSource("g", shape, dof, ())


def factor_of(
    sources: Sequence[ErrorSource], sizes: Any, dof: float, level: float = 0.95, second: float = 0.0
) -> float:
    """The coverage factor of a sum of errors."""
    u = math.sqrt(float(sizes @ sizes) + second)
    return coverage(*assigned(sources, sizes, u, dof, second), dof, level)[0]


@pytest.mark.parametrize(
    ("shape", "level", "factor"),
    [
        (Shape.RECTANGULAR, 0.95, 0.95 * 3**0.5),
        (Shape.ARCSINE, 0.95, 2**0.5 * math.sin(0.95 * math.pi / 2)),
        (Shape.TRIANGULAR, 0.95, 6**0.5 * (1 - 0.05**0.5)),
        (Shape.NORMAL, 0.95, 1.959963984540054),
        (Shape.NORMAL, 0.9545, 2.0000024),
    ],
)
def test_the_factor_follows_the_source_that_dominates(shape: Shape, level: float, factor: float) -> None:
    sources = [source(Shape.NORMAL), source(shape), source(Shape.RECTANGULAR)]
    sizes, normal = np.array([0.1, -1.0, 0.2]), NormalDist().inv_cdf((1 + level) / 2)
    # beside terms of second order, of which nobody knows how they are distributed
    assert factor_of(sources, sizes, math.inf, level, second=0.01) == pytest.approx(factor, rel=1e-7)
    assert factor_of(sources, np.array([0.6, -1.0, 0.6]), math.inf, level, second=0.01) == normal
    assert factor_of(sources, sizes, math.inf, level, second=0.1) == normal
    assert factor_of([source(shape)], np.array([-2.0]), math.inf, level) == pytest.approx(factor, rel=1e-7)
    doubtful = [sources[0], source(shape, 2), sources[2]]
    assert factor_of(doubtful, sizes, 2) == pytest.approx(4.303, abs=5e-4)  # the limits are not certain


def test_without_terms_of_second_order_it_is_that_of_the_sum() -> None:
    """EA-4/02, S9: the coverage factor of a rectangular source that dominates, 1.65, comes near to it."""
    sources, sizes = [source(Shape.RECTANGULAR)] * 2, np.array([0.05, -0.011])
    found = factor_of(sources, sizes, math.inf)
    assert found == pytest.approx(
        3**0.5 * (0.061 - math.sqrt(0.05 * 2 * 0.05 * 0.022)) / math.hypot(*sizes), rel=1e-6
    )


def test_nothing_dominates_where_nothing_is_of_first_order() -> None:
    assert factor_of([source(Shape.RECTANGULAR)], np.array([0.0]), math.inf, second=1.0) == NORMAL


@pytest.mark.parametrize(("dof", "level", "factor"), [(16, 0.99, 2.92), (5, 0.95, 2.57), (1, 0.95, 12.71)])
def test_the_factor_of_t(dof: float, level: float, factor: float) -> None:
    """JCGM 100:2008, table G.2."""
    found = factor_of([source(Shape.STUDENT, dof)], np.array([1.0]), dof, level)
    assert found == pytest.approx(factor, abs=0.005)


@pytest.mark.parametrize(
    ("sizes", "dof", "found"),
    [
        ([3.0, 4.0], [4.0, math.inf], 30),
        ([1.0], [8.999], 9),
        ([1.0], [8.99], 8),
        ([1.0], [0.5], 1),
        ([0.0, 0.0], [1.0, 1.0], math.inf),
        ([1.0, 1.0], [math.inf, math.inf], math.inf),
    ],
)
def test_effective_degrees_of_freedom(sizes: list[float], dof: list[float], found: float) -> None:
    own = np.array(sizes)
    assert effective(float(np.sqrt(np.sum(own**2))), own, dof) == found
