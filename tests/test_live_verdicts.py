"""How likely the page says that a sum of squares is: as the report says it."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest
from helpers import in_node
from hypothesis import given, settings
from hypothesis import strategies as st

from loopsheet.report.result.chi_square import head, tail
from loopsheet.report.views.writer import TEMPLATES

GRID = [
    (chi2, dof)
    for dof in (1, 2, 3, 4, 5, 8, 17, 40, 101)
    for chi2 in (1e-9, 1e-3, 0.1, 0.5, 0.999, 1.0, 2.0, 3.9, 4.0, 4.1, 10.0, 55.19, 200.0, 1000.0, 1e5)
]


@pytest.fixture(scope="session")
def squares(require: Callable[..., str]) -> Callable[[list[tuple[float, int]]], list[tuple[float, float]]]:
    """The page's own probabilities, in node."""
    text = (TEMPLATES / "live" / "verdicts.js").read_text(encoding="utf-8")

    def run(asked: list[tuple[float, int]]) -> list[tuple[float, float]]:
        ask = f"console.log(JSON.stringify({json.dumps(asked)}.map((one) => squares(...one))))"
        return [(each["tail"], each["head"]) for each in in_node(require("node"), text, ask)]

    return run


def agrees(found: tuple[float, float], chi2: float, dof: int) -> bool:
    """To nine digits, far into both tails, and to nothing where doubles have none."""
    wanted = tail(chi2, dof), head(chi2, dof)
    return all(
        ours == pytest.approx(theirs, rel=1e-9, abs=1e-290)
        for ours, theirs in zip(found, wanted, strict=True)
    )


def test_probabilities_are_those_of_the_report(squares: Callable[..., list[tuple[float, float]]]) -> None:
    for (chi2, dof), found in zip(GRID, squares(GRID), strict=True):
        assert agrees(found, chi2, dof), (chi2, dof, found)


@settings(max_examples=10, deadline=None)
@given(st.lists(st.tuples(st.floats(1e-12, 600), st.integers(1, 60)), min_size=50, max_size=50))
def test_drawn_probabilities_too(
    squares: Callable[..., list[tuple[float, float]]], asked: list[tuple[float, int]]
) -> None:
    for (chi2, dof), found in zip(asked, squares(asked), strict=True):
        assert agrees(found, chi2, dof), (chi2, dof, found)
