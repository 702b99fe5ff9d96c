"""What the referee found is said in one place: the same in every format, and never more than is certain."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from loopsheet.report import stages
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.quantity import Printed
from loopsheet.report.result import verdict_data
from loopsheet.report.result import verdict_words as words
from loopsheet.report.result.findings import checks
from loopsheet.report.result.result import Report
from loopsheet.report.result.verdict import UNREACHABLE, Verdict
from loopsheet.report.study import Study
from loopsheet.report.verbs import check
from loopsheet.report.views import checks as formats
from loopsheet.report.views import html, latex
from loopsheet.report.views import json as values_json

UM = Fraction(1, 10**6)


@pytest.fixture(scope="module")
def paper() -> Report:
    return stages.refereed(Study(PAPER).computed)


@given(st.floats(-1e3, 1e3), st.floats(0, 1e3), st.integers(0, 6), st.sampled_from([Fraction(1), UM]))
def test_bounds_are_rounded_outwards(low: float, width: float, decimals: int, scale: Fraction) -> None:
    ends = low * float(scale), (low + width) * float(scale)
    text = "1." + "0" * decimals if decimals else "1"
    found = Verdict(UNREACHABLE, bound_low=ends[0], bound_high=ends[1])
    shown = words.bounds(found, Printed(text, "u", scale, scale))
    assert shown is not None
    assert Fraction(shown[0]) * scale <= Fraction(ends[0]) <= Fraction(ends[1]) <= Fraction(shown[1]) * scale
    # No wider than one more decimal than was printed makes necessary.
    unit = scale / 10 ** (decimals + 1)
    assert Fraction(ends[0]) - Fraction(shown[0]) * scale < unit
    assert Fraction(shown[1]) * scale - Fraction(ends[1]) < unit


def test_bounds_that_are_not_known_are_not_shown() -> None:
    assert (
        words.bounds(Verdict(UNREACHABLE, bound_low=1.0), Printed("1", "1", Fraction(1), Fraction(1))) is None
    )


@given(st.floats(1.0000001, 1e4))
def test_no_more_than_is_certain_is_claimed(value: float) -> None:
    assert 1 < Fraction(words.at_least(value)) <= Fraction(value)
    rounded = verdict_data.certain(value)
    assert rounded is not None
    assert rounded <= value


@given(st.floats(-1e6, 1e6, allow_subnormal=False))
def test_bounds_in_json_are_rounded_outwards(value: float) -> None:
    low, high = verdict_data.certain(value), verdict_data.certain(value, upwards=True)
    assert low is not None
    assert high is not None
    assert low <= value <= high
    assert high - low <= 2e-5 * abs(value)


def test_every_format_says_the_same(paper: Report, capsys: pytest.CaptureFixture[str]) -> None:
    """One sentence: in the terminal, on the page, in the article, and in the formats of findings.

    Where these tell a table first that makes it so, they do not say it again of all together.
    """
    joint, first = paper.referee.joint, paper.referee.explanations[1]
    assert joint is not None
    verdict, reason = words.together(joint), words.explained(first)
    assert verdict.endswith(words.at_least(joint.at_least or 0))
    found = [replace(one, passed=one.kind != "table") for one in checks(paper)]
    check._print(paper, found)
    told = {"terminal": capsys.readouterr().out}
    told |= {name: write(found, "title", {}) for name, write in formats.FORMATS.items()}
    table, again = words.together(paper.referee.tables[0]), words.all_together(paper.referee)
    assert again.endswith("cannot come out either, as is told of Table 2")
    for name, text in told.items():
        assert table in text, name
        assert again in text, name
        assert verdict not in text, name
        assert reason in text.replace("\\", ""), name  # Markdown escapes brackets
    assert [told["terminal"].count(said) for said in (table, again)] == [1, 1]
    data = json.loads(values_json.values(paper))["referee"]
    assert data["explanations"][1]["sentence"] == reason
    # On a page cells are symbols, and LaTeX keeps some signs apart; what follows is the same.
    for text in (html.render(paper, {}), latex.render(paper, []).replace("{}", "")):
        assert verdict[1:] in text
        assert words.follows(first) in text


def test_certain_bounds_are_the_same_everywhere(paper: Report, capsys: pytest.CaptureFixture[str]) -> None:
    out = [c for c in paper.comparisons if c.word == UNREACHABLE]
    assert out
    page, article = html.render(paper, {}), latex.render(paper, [])
    messages = [one.message for one in checks(paper)]
    for comparison in out:
        found = comparison.refereed
        assert found is not None
        ends = words.bounds(found, comparison.published.printed)
        assert ends is not None
        said = words.certain(ends)
        assert any(said in message for message in messages)
        assert said[1:] in page
        assert said[1:] in article


def test_intervals_in_json_are_the_right_way_round(paper: Report) -> None:
    published = json.loads(values_json.values(paper))["published"]
    known = [one for one in published if one["interval"] is not None]
    assert len(known) == 12
    assert all(one["interval"][0] <= one["value"] <= one["interval"][1] for one in known)
    assert all(one["interval"][0] < one["interval"][1] for one in known)
    certain = [one for one in published if one["bounds"] is not None]
    assert [tuple(one["index"]) for one in certain] == [(2, 4), (2, 5)]
    for one in certain:
        # What was seen lies within what is certain.
        assert one["bounds"][0] <= one["interval"][0] <= one["interval"][1] <= one["bounds"][1]


def test_nothing_explains_it_is_said(paper: Report, capsys: pytest.CaptureFixture[str]) -> None:
    report = replace(paper, referee=replace(paper.referee, explanations=()))
    check._print(report, ())
    assert words.NOTHING_EXPLAINS in capsys.readouterr().out
    assert any(words.NOTHING_EXPLAINS in one.message for one in checks(report))
