"""The referee names what was forged, and accuses nobody who printed what was computed."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import count, islice
from math import ceil

import pytest
from campaign_sizes import Sizes
from forged_campaigns import FORGERS, accused, judged

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
        return list(islice((each for each in every if each[1] != "reachable"), sizes.forged))

    return said


def missed(found: list[tuple[int, str]]) -> list[str]:
    return [verdict for _, verdict in found if verdict != "named"]


@pytest.mark.parametrize("kind", range(len(FORGERS)), ids=[forger.__name__ for forger in FORGERS])
def test_nine_forgeries_of_ten_are_named(
    said: Callable[[int], list[tuple[int, str]]], sizes: Sizes, summary: Say, kind: int
) -> None:
    found = said(kind)
    summary(
        f"forged papers, {FORGERS[kind].__name__}: {len(found) - len(missed(found))} of {len(found)} named, "
        f"{found[-1][0] + 1 - len(found)} more that their digits allow"
    )
    assert len(missed(found)) <= ceil(sizes.forged / 10), missed(found)


def test_nineteen_forgeries_of_twenty_are_named(
    said: Callable[[int], list[tuple[int, str]]], sizes: Sizes
) -> None:
    of_all = [each for kind in range(len(FORGERS)) for each in missed(said(kind))]
    assert len(of_all) <= ceil(sizes.forged * len(FORGERS) / 20), of_all
