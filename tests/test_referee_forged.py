"""The referee names what was forged, and accuses nobody who printed what was computed."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import count, islice

import pytest
from campaign_sizes import Sizes
from forged_campaigns import FIRST, FORGERS, UNSEEN, accused, judged

pytestmark = pytest.mark.campaigns

Say = Callable[[str], None]


def test_nobody_honest_is_accused(sizes: Sizes, summary: Say) -> None:
    found = [said for number in range(sizes.honest) if (said := accused(sizes.seed, number))]
    summary(f"honest papers: {len(found)} of {sizes.honest} accused")
    assert found == []


@pytest.fixture(scope="module")
def said(sizes: Sizes) -> Callable[[int], list[tuple[int, str]]]:
    """Give `said(kind)`: number and verdict of the forgeries that somebody could see, once for all tests."""

    @cache
    def said(kind: int) -> list[tuple[int, str]]:
        every = ((number, judged(kind, sizes.seed, number)) for number in count())
        return list(islice((each for each in every if each[1] not in UNSEEN), sizes.forged))

    return said


@pytest.mark.parametrize("kind", range(len(FORGERS)), ids=[forger.__name__ for forger in FORGERS])
def test_four_forgeries_of_five_are_named(
    said: Callable[[int], list[tuple[int, str]]], sizes: Sizes, summary: Say, kind: int
) -> None:
    """Of each kind, the first of those that explain it or another."""
    found = said(kind)
    missed = [verdict for _, verdict in found if verdict.startswith("missed")]
    first = sum(verdict == FIRST for _, verdict in found)
    summary(
        f"forged papers, {FORGERS[kind].__name__}: {first} of {len(found)} named first, {len(missed)} "
        f"missed, {found[-1][0] + 1 - len(found)} more that their digits allow"
    )
    assert len(missed) <= sizes.forged // 5, missed


def test_nineteen_forgeries_of_twenty_are_named_first(
    said: Callable[[int], list[tuple[int, str]]], sizes: Sizes, summary: Say
) -> None:
    every = [verdict for kind in range(len(FORGERS)) for _, verdict in said(kind)]
    others = [verdict for verdict in every if verdict != FIRST]
    summary(f"forged papers: {len(every) - len(others)} of {len(every)} named first")
    assert len(others) <= len(every) // 20, others
