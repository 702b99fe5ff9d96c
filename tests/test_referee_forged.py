"""The referee names what was forged, and accuses nobody who printed what was computed."""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from itertools import count
from multiprocessing import get_context
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from forged_campaigns import FORGERS, accused, judged

EACH = 40
"""Forged campaigns of each kind; there are five kinds."""
HONEST = 200


@pytest.fixture(scope="module")
def pool() -> Iterator[ProcessPoolExecutor]:
    with ProcessPoolExecutor(os.cpu_count(), mp_context=get_context("spawn")) as pool:
        yield pool


def test_nobody_honest_is_accused(pool: ProcessPoolExecutor) -> None:
    assert [said for said in pool.map(accused, range(HONEST)) if said] == []


def identifiable(pool: ProcessPoolExecutor, kind: int, wanted: int) -> list[str]:
    """What was found of as many forgeries as are wanted, leaving out those that nobody could see."""
    seeds, found = count(), list[str]()
    while len(found) < wanted:
        batch = [pool.submit(judged, kind, next(seeds)) for _ in range(wanted - len(found))]
        found += [said for each in batch if (said := each.result()) != "reachable"]
    return found


def test_forgeries_are_named(pool: ProcessPoolExecutor) -> None:
    """At least 95 % of all, and nine of ten of every kind."""
    said = {forger.__name__: identifiable(pool, n, EACH) for n, forger in enumerate(FORGERS)}
    named = {name: Counter(each)["named"] for name, each in said.items()}
    missed = [each for every in said.values() for each in every if each != "named"]
    assert sum(named.values()) >= 0.95 * EACH * len(FORGERS), missed
    assert min(named.values()) >= 0.9 * EACH, missed
