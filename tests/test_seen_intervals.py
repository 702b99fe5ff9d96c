"""An interval that is shown with a value contains it, also where derivatives vanish or change their signs."""

import random
from collections.abc import Iterator
from pathlib import Path

import pytest
from random_sheets import printed, sheet_of
from small_report import end_gauge, judged, pure

from loopsheet.report.cells.values import Values
from loopsheet.report.document.material import Material
from loopsheet.report.inputs.published import PublishedValue
from loopsheet.report.referee import judging, print_as
from loopsheet.report.result.result import Comparison, Report
from loopsheet.report.result.verdict import EXACT, REACHABLE
from loopsheet.report.stages import refereed
from loopsheet.report.study import Study

# --- random sheets ----------------------------------------------------------------------------------------

SHEETS = 40


def comparisons_of(rng: random.Random) -> tuple[Comparison, ...]:
    """A random sheet of random numbers, each computed cell published rightly or somewhat wrongly."""

    def published(values: Values) -> Iterator[PublishedValue]:
        for name in "yz":
            for cell in values.cells(name):
                if cell.value is not None and abs(cell.value) < 1e6:
                    like = pure("0." + "0" * rng.randrange(1, 5))
                    text = print_as(cell.value + rng.choice((0, 0, 1, 30)) * float(like.half_unit), like)
                    yield PublishedValue("Table", name, cell.label, pure(text))

    measured = {name: [printed(rng) for _ in range(3)] for name in "ab"}
    parameters = {name: printed(rng) for name in "cd"}
    return judged(sheet_of(rng), measured, parameters, lambda values: list(published(values)))


def intervals(seeds: range) -> Iterator[tuple[int, Comparison]]:
    for seed in seeds:
        for comparison in comparisons_of(random.Random(seed)):
            yield seed, comparison


def test_what_inputs_were_seen_to_yield_contains_what_is_shown_with_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The recomputed value, the value of a witness, and where it is certain, nothing that is impossible."""
    # What would explain a difference takes longest, and says nothing of intervals.
    monkeypatch.setattr(judging, "explanations", lambda *_: ((), None))
    known = certain = 0
    for seed, comparison in intervals(range(SHEETS)):
        found, value, where = comparison.refereed, comparison.cell.value, (seed, comparison.cell.address)
        assert found is not None
        assert value is not None
        assert found.low is not None, where
        assert found.high is not None, where
        assert found.low <= value <= found.high, where
        known += 1
        if found.verdict in (EXACT, REACHABLE):
            low, high = (float(end) for end in comparison.published.printed.interval)
            slack = 1e-9 * (1 + abs(value))
            assert found.low <= high + slack, where
            assert found.high >= low - slack, where
        if found.bound_low is not None and found.bound_high is not None:
            slack = 1e-9 * (1 + abs(value))
            assert found.bound_low <= found.low + slack, where
            assert found.high <= found.bound_high + slack, where
            certain += 1
    assert known > 3 * SHEETS
    assert certain > 20


def test_what_only_rounding_moves_rests_on_no_free_unknown(paper: Report) -> None:
    """The mass of the ball is free: exponents do not rest on it, whatever their last digits do, forces do."""
    found = {each.published.cell: each.refereed for each in paper.comparisons}
    for name, known in (("alpha_log", True), ("alpha_mean", True), ("alpha", True), ("Cprime_eq9", False)):
        assert found[name] is not None
        assert (found[name].low is not None) == known, name


# --- one that is known --------------------------------------------------------------------------------------


def test_the_end_gauge_lies_between_its_least_and_its_largest_length(tmp_path: Path) -> None:
    """JCGM 100:2008, H.1: most of its corrections are zero, so that derivatives say little of the corners.

    The length is least and largest at corners of what prints as given, which can all be tried; theta and the
    difference of the coefficients matter most, as a product of what is -0.65 to 0.45 K and -0.5 to 0.5 / K.
    """
    report = refereed(Study(end_gauge(tmp_path)).computed)
    (comparison,) = report.comparisons
    found = comparison.refereed
    assert found is not None
    assert found.verdict == EXACT
    assert (found.low, found.high) == pytest.approx((0.050 * (1 - 0.325), 0.050 * (1 + 0.325)), rel=1e-4)
    (value,) = Material(report).refereed
    shown = [value.low, value.here, value.high]
    assert [figure.plain for figure in shown if figure] == ["33.7503459", "50.0008380", "66.2513304"]
