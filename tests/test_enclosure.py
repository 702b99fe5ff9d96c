"""Enclosures hold every sample of their box, and are narrow enough to decide something."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from sympy import Expr, Integer, Rational, Sum, Symbol, exp

from loopsheet.derivations.equation import Equation, Kind
from loopsheet.derivations.reductions import Greatest, Least, Median
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.intervals import Intervals
from loopsheet.report.engines.numpy import Program
from loopsheet.report.engines.numpy_enclosed import EnclosedRows
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.judge.chain import SheetDerivatives
from loopsheet.report.judge.enclosure import Enclosure
from loopsheet.report.quantity import Bounds
from loopsheet.report.referee import certificate
from loopsheet.report.referee.campaign import Campaign
from loopsheet.report.referee.certificate import Certificate
from loopsheet.report.referee.minimax import best
from loopsheet.report.referee.problem import Box, Problem
from loopsheet.report.referee.ways import from_printed
from loopsheet.report.sheet import Axis, Column, Formula, Given, Root, Sheet
from loopsheet.report.study import Study


@pytest.fixture(scope="module")
def campaign() -> Campaign:
    prepared = Study(PAPER).prepared
    values = engine.evaluate(prepared.sheet, prepared.labels, prepared.data)
    return Campaign(prepared.sheet, prepared.inputs, values, prepared.data, prepared.inputs.free)


def table(campaign: Campaign, *sources: str, tied: tuple[str, ...] = ()) -> Problem:
    return Problem.of(campaign, [p for p in campaign.inputs.published if p.source in sources], tied)


def samples(problem: Problem, number: int) -> np.ndarray:
    """Points of a box, its corners among them."""
    rng = np.random.default_rng(3)
    box = problem.box
    share = rng.random((number, len(box.low)))
    share[: number // 2] = np.rint(share[: number // 2])
    return box.low + share * box.width


@pytest.mark.parametrize(("sources", "tied"), [(("Table 2",), ()), (("text",), ("alpha_log",))])
def test_bounds_hold_every_sample(
    campaign: Campaign, sources: tuple[str, ...], tied: tuple[str, ...]
) -> None:
    problem = table(campaign, *sources, tied=tied)
    bounds, cells = Certificate(problem).bounds, problem.evaluate(samples(problem, 400))
    assert (cells >= bounds.low).all()
    assert (cells <= bounds.high).all()


def test_bounds_are_narrow(campaign: Campaign) -> None:
    """Within a tenth of what samples reach, so that they decide."""
    problem = table(campaign, "Table 2")
    bounds, cells = Certificate(problem).bounds, problem.evaluate(samples(problem, 4000))
    reached = cells.max(axis=0) - cells.min(axis=0)
    assert (bounds.high - bounds.low <= 1.35 * reached).all()


def test_derivatives_hold_those_of_every_sample(campaign: Campaign) -> None:
    """The search and the certificate have the same derivatives: one at a point, one over all of a box.

    Over a box that is a point these are known to ten digits, which no difference has.
    """
    problem = table(campaign, "Table 2")
    slopes = Certificate(problem)._slopes
    for point in samples(problem, 10):
        found = problem.slopes(problem.at(point), problem.box)
        for held in (slopes, Certificate(problem, Box(point, point, point))._slopes):
            slack = 1e-10 * np.abs(found)
            assert (found >= held.low - slack).all()
            assert (found <= held.high + slack).all()


def test_derivatives_of_some_values_are_those_of_all(campaign: Campaign) -> None:
    problem = table(campaign, "Table 2", "Table 3", "text")
    box, every, here = problem.box, range(len(problem.published)), problem.at(problem.box.start)
    all_of_them = problem.slopes(here, box)
    for n in every:
        alone, among = problem.only([n]), problem.ignoring(set(every) - {n})
        assert (alone.slopes(alone.at(box.start), box)[0] == all_of_them[n]).all()
        assert (among.slopes(here, box)[n] == all_of_them[n]).all()
        assert 0 < np.count_nonzero(all_of_them[n]) < len(problem.unknowns)


@pytest.mark.parametrize("tied", [(), ("alpha_log", "C_log")])
def test_derivatives_of_a_search_against_differences(campaign: Campaign, tied: tuple[str, ...]) -> None:
    """Also of what is free, and of what is computed in another way, which has only these."""
    problem = table(campaign, "Table 2", "Table 3", "text", tied=tied)
    point, here = problem.box.start, problem.at(problem.box.start)
    found = problem.slopes(here, problem.box)
    size = point / here.cells[:, None]
    assert found * size == pytest.approx(problem._differences(point, problem.box) * size, rel=1e-5, abs=1e-8)
    mean = next(n for n, value in enumerate(problem.published) if value.cell == "alpha_mean")
    other = problem.computed(from_printed(campaign, ["alpha_mean"], {"alpha": np.full(10, 1.3)}), [mean])
    among = other.slopes(other.at(point), problem.box)
    assert (among[mean] == 0).all()  # of what is printed nothing moves it
    assert (np.delete(among, mean, axis=0) == np.delete(found, mean, axis=0)).all()


def test_what_is_printed_is_computed_once(campaign: Campaign, monkeypatch: pytest.MonkeyPatch) -> None:
    """Most searches begin there; what they find elsewhere is of where they are."""
    problem, runs = table(campaign, "Table 2"), list[int]()
    run = Program.run
    monkeypatch.setattr(Program, "run", lambda *given: runs.append(1) or run(*given))
    start, other = problem.box.start, problem.box.low
    first, again, elsewhere = problem.at(start), problem.only([3]).at(start), problem.at(other)
    assert len(runs) == 2
    assert (again.cells == first.cells[[3]]).all()
    assert (elsewhere.cells == problem.evaluate(other[None])[0]).all()
    box = problem.box
    assert (problem.only([3]).slopes(again, box) == problem.slopes(first, box)[[3]]).all()
    assert (problem.slopes(elsewhere, box) != problem.slopes(first, box)).any()


def test_boxes_that_differ_in_one_cell_are_enclosed_as_each_alone(
    campaign: Campaign, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of ten pairs, six do not rest on the cell of one test: they are enclosed once for all boxes."""
    problem, solved = table(campaign, "Table 2"), []
    of_rows = Enclosure._root
    monkeypatch.setattr(Enclosure, "_root", lambda *given: solved.append(given[-1]) or of_rows(*given))
    (n,) = (n for n, u in enumerate(problem.unknowns) if (u.column, u.row) == ("x_p", 1))
    boxes = [problem.box.moved([n], [end], [end * 1.001], [end]) for end in np.array([29.6, 29.8, 30]) * 1e-6]
    low, high = (np.stack([getattr(box, end) for box in boxes]) for end in ("low", "high"))
    together = certificate._enclosure(problem, low, high)
    assert solved == [6 + 3 * 4]
    for number, box in enumerate(boxes):
        alone = certificate._enclosure(problem, box.low, box.high)
        every, own = together.value["alpha"][number], alone.value["alpha"]
        assert every.low == pytest.approx(own.low, rel=1e-9)
        assert every.high == pytest.approx(own.high, rel=1e-9)
        assert (together.sure["alpha"][number] == alone.sure["alpha"]).all()
    assert len(set(together.value["alpha"].low[:, 0])) == len(boxes)


def test_no_sample_beats_the_certified_mismatch(campaign: Campaign) -> None:
    problem = table(campaign, "Table 2")
    found = best(problem)
    at_least = Certificate(problem).at_least(found.weights)
    assert 1 < at_least <= found.mismatch
    worst = np.abs(problem.mismatch(problem.evaluate(samples(problem, 4000)))).max(axis=1)
    assert worst.min() >= found.mismatch > at_least


def test_nothing_is_certified_of_a_table_that_can_be_reached(campaign: Campaign) -> None:
    """With the depth of the second test changed, the table is possible; then no weights may say otherwise."""
    inputs = campaign.inputs
    depths = list(inputs.measured["x_p"])
    depths[1] = replace(depths[1], text="29.8", value=Fraction("29.8e-6"))
    inputs = inputs.with_numbers({"x_p": tuple(depths)})
    data = {**campaign.data, "x_p": [float(p.value) for p in depths]}
    values = engine.evaluate(campaign.sheet, campaign.labels, data)
    problem = table(Campaign(campaign.sheet, inputs, values, data, campaign.free), "Table 2")
    assert best(problem).mismatch <= 1
    certificate, rng = Certificate(problem), np.random.default_rng(1)
    for _ in range(200):
        assert certificate.at_least(rng.standard_normal(10)) <= 1


def test_an_input_is_looked_for_among_those_that_are_allowed(campaign: Campaign) -> None:
    """A print of 1.00 stands for no restitution above 1, however it was rounded."""
    e = list(campaign.inputs.measured["e"])
    e[0] = replace(e[0], text="1.00", value=Fraction(1))
    inputs = campaign.inputs.with_numbers({"e": tuple(e)})
    problem = table(replace(campaign, inputs=inputs), "Table 2")
    (place,) = (n for n, u in enumerate(problem.unknowns) if (u.column, u.row) == ("e", 0))
    assert (problem.box.low[place], problem.box.high[place]) == (0.995, 1.0)


@pytest.mark.parametrize(
    ("bounds", "low", "high", "sure"),
    [
        (Bounds(), 2.0, 3.0, True),
        (Bounds(2, 3), 2.0, 3.0, True),
        (Bounds(2, 3), 2.0, 3.5, False),
        (Bounds(2, 3, low_open=True), 2.0, 3.0, False),
        (Bounds(integer=True), 2.0, 3.0, False),
        (Bounds(integer=True), 2.0, 2.0, True),
    ],
)
def test_what_may_not_be_allowed_may_have_no_value(
    bounds: Bounds, low: float, high: float, sure: bool
) -> None:
    x = Column("x", None, Given("given", bounds), positive=False)
    twice = Formula(Equation("", (Symbol("y"), 2 * x.symbol), "", Kind.DEFINITION))
    sheet = Sheet((x, Column("y", None, twice, positive=False)))
    program = Program.of(sheet)
    found = Enclosure(sheet, program, {}, {"x": Intervals([low], [high])})
    assert (bool(found.sure["x"][0]), bool(found.sure["y"][0])) == (sure, sure)
    values = [engine.evaluate(sheet, {}, {"x": x}, program).status["y"][0] for x in np.linspace(low, high, 9)]
    assert sure == (not any(values))


@pytest.mark.parametrize("kind", [Median, Greatest, Least])
def test_what_is_taken_by_order_is_enclosed_with_its_derivatives(kind: Any) -> None:
    """Rows that may change places, that tie, that may have no value: every sample lies inside."""
    k, n = Symbol("k", integer=True, positive=True), Symbol("n", integer=True, positive=True)
    rows = Axis("rows", k, n)
    x = Column("x", rows, Given(), positive=False)

    def formula(name: str, value: Expr, axis: Axis | None = None, **more: Any) -> Column:
        definition = Equation("", (Symbol(name), value), "", Kind.DEFINITION)
        return Column(name, axis, Formula(definition), positive=False, **more)

    y = formula("y", 3 * x[k], rows, requires=((x[k] < 5, "x is less than 5"),))
    sheet = Sheet((x, y, formula("m", kind(y[k], (k, 1, n)) + 1)))
    program, made = Program.of(sheet), SheetDerivatives.of(sheet)
    rng, narrow = np.random.default_rng(4), 0
    for case in range(200):
        size = 2 + case % 5
        labels = {"rows": range(1, size + 1)}
        low = rng.uniform(0, 4, size)
        high = low + rng.choice([0.01, 1.0, 3.0], size)
        layouts = engine.evaluate(sheet, labels, {"x": low}, program).layouts
        enclosure = Enclosure(sheet, program, layouts, {"x": Intervals(low, high)})
        slopes = enclosure.derivatives(made, {"x": np.arange(size)})["m"]
        found = enclosure.value["m"]
        inside = low + rng.random((100, size)) * (high - low)
        value = engine.evaluate(sheet, labels, {"x": inside}, program).value["m"][:, 0]
        some = ~np.isnan(value)
        assert (found.low[0] <= value[some]).all()
        assert (value[some] <= found.high[0]).all()
        for row in range(size):
            moved = inside.copy()
            moved[:, row] += 1e-7
            step = engine.evaluate(sheet, labels, {"x": moved}, program).value["m"][:, 0]
            slope = (step - value)[some] / 1e-7
            assert (slopes.low[0, row] - 1e-6 <= slope).all()
            assert (slope <= slopes.high[0, row] + 1e-6).all()
        narrow += bool(np.isfinite(slopes.high).all() and (slopes.high - slopes.low < 1e-12).all())
    assert narrow


def test_a_sum_over_rows_that_may_have_no_value_is_not_known() -> None:
    """What breaks a condition is left out of a sum: its bounds must hold with and without it."""
    k, n = Symbol("k", integer=True, positive=True), Symbol("n", integer=True, positive=True)
    rows = Axis("rows", k, n)
    x = Column("x", rows, Given())

    def formula(name: str, value: Expr, axis: Axis | None = None, **more: Any) -> Column:
        return Column(
            name,
            axis,
            Formula(Equation("", (Symbol(name), value), "", Kind.DEFINITION)),
            positive=False,
            **more,
        )

    y = formula("y", 2 * x[k], rows, requires=((x[k] < 3, "x is less than 3"),))
    total = formula("total", Sum(y[k], (k, 1, n)))
    sheet = Sheet((x, y, total))
    program, labels = Program.of(sheet), {"rows": [1, 2]}
    layouts = engine.evaluate(sheet, labels, {"x": [1.0, 2.0]}, program).layouts
    for low, high, known in (([1.0, 2.0], [1.5, 2.5], True), ([1.0, 2.0], [1.5, 3.5], False)):
        found = Enclosure(sheet, program, layouts, {"x": Intervals(low, high)}).value["total"]
        assert bool(np.isfinite(found.low[0])) is known
        for data in (low, high):
            value = engine.evaluate(sheet, labels, {"x": data}, program).scalar("total")
            assert found.low[0] <= value <= found.high[0]


def test_a_root_over_all_rows_is_counted_once_and_not_once_a_row(monkeypatch: pytest.MonkeyPatch) -> None:
    """What its sums run over are terms: each of them as a root of its own took minutes."""
    k, n = Symbol("k", integer=True, positive=True), Symbol("n", integer=True, positive=True)
    x, z = Column("x", Axis("rows", k, n), Given()), Symbol("z", positive=True)
    equation = Equation("", (Sum(x[k] * exp(-z * x[k]), (k, 1, n)) - 1, Integer(0)), "", Kind.DEFINITION)
    root = Root(equation, equation, z, z, Rational(1, 10), Rational(10), Rational(1))
    sheet, asked = Sheet((x, Column("rate", None, root))), []
    program = Program.of(sheet)
    data = np.linspace(1.0, 2.0, 40)
    layouts = engine.evaluate(sheet, {"rows": range(40)}, {"x": data}, program).layouts
    isolate = EnclosedRows.isolate

    def counting(rows: EnclosedRows, which: Any, *ends: Any) -> Any:
        asked.append(len(which))
        return isolate(rows, which, *ends)

    monkeypatch.setattr(EnclosedRows, "isolate", counting)
    found = Enclosure(sheet, program, layouts, {"x": Intervals(data - 1e-3, data + 1e-3)})
    value = engine.evaluate(sheet, {"rows": range(40)}, {"x": data}).scalar("rate")
    assert set(asked) <= {1}
    assert found.value["rate"].low.shape == (1,)
    assert found.value["rate"].low[0] < value < found.value["rate"].high[0]


def enclosed(sheet: Sheet, low: float, high: float) -> Enclosure:
    """The cells of a sheet whose only given one, `a`, lies in an interval."""
    program = Program.of(sheet)
    layouts = engine.evaluate(sheet, {}, {"a": [low]}, program).layouts
    return Enclosure(sheet, program, layouts, {"a": Intervals([low], [high])})


@pytest.mark.parametrize(
    ("low", "high", "known"),
    [
        (0.04, 0.05, True),
        (0.10, 0.14, True),
        (0.14, 0.16, False),  # 3/exp(3) is .1494: one root for some of these, two for others
        (0.16, 0.30, False),  # two
        (0.36, 0.38, False),  # 1/e is .3679: two roots or none
    ],
)
def test_a_root_is_known_if_it_is_the_only_one_whatever_lies_in_the_box(
    low: float, high: float, known: bool
) -> None:
    a, z = Column("a", None, Given()), Symbol("z", positive=True)
    equation = Equation("", (z * exp(-z) - a.symbol, Integer(0)), "", Kind.DEFINITION)
    ends = Rational(1, 100), Rational(3)
    sheet = Sheet((a, Column("root", None, Root(equation, equation, z, z, *ends, Rational(1, 2)))))
    found = enclosed(sheet, low, high)
    assert bool(found.sure["root"][0]) is known
    for datum in np.linspace(low, high, 5) if known else ():
        value = engine.evaluate(sheet, {}, {"a": [datum]}, found.program).scalar("root")
        assert found.value["root"].low[0] <= value <= found.value["root"].high[0]


@pytest.mark.parametrize(("low", "high", "known"), [(0.2, 0.3, True), (0.05, 0.2, False), (0.9, 1.1, False)])
def test_a_root_is_not_known_if_it_may_lie_outside_of_its_interval(
    low: float, high: float, known: bool
) -> None:
    a, z = Column("a", None, Given()), Symbol("z", positive=True)
    equation = Equation("", (z - a.symbol, Integer(0)), "", Kind.DEFINITION)
    ends = Rational(1, 10), Rational(1)
    sheet = Sheet((a, Column("root", None, Root(equation, equation, z, z, *ends, Rational(1, 2)))))
    assert bool(enclosed(sheet, low, high).sure["root"][0]) is known


def test_what_may_be_zero_is_not_sure_to_be_positive() -> None:
    a = Column("a", None, Given(bounds=Bounds(low=0)))
    twice = Column("twice", None, Formula(Equation("", (Symbol("twice"), 2 * a.symbol), "", Kind.DEFINITION)))
    sheet = Sheet((a, twice))
    for low, known in ((0.0, False), (1e-3, True)):
        assert bool(enclosed(sheet, low, 1.0).sure["twice"][0]) is known
