"""Several threads: the order stays, no more is taken than is needed, and an error is raised in its turn."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import closing

import pytest

from loopsheet.report.machine.threads import in_threads


def test_the_order_stays_whoever_is_first() -> None:
    def slow_if_even(n: int) -> int:
        time.sleep(0.002 * (n % 2 == 0))
        return n * n

    assert list(in_threads(slow_if_even, range(20))) == [n * n for n in range(20)]


def test_who_has_enough_takes_no_more() -> None:
    taken: list[int] = []

    def given() -> Iterator[int]:
        for n in range(10_000):
            taken.append(n)
            yield n

    with closing(in_threads(str, given())) as found:
        assert next(found) == "0"
    assert len(taken) < 1000


def test_an_error_is_raised_in_its_turn() -> None:
    found = in_threads(lambda n: 6 // n, [3, 2, 0, 1])
    assert [next(found), next(found)] == [2, 3]
    with pytest.raises(ZeroDivisionError):
        next(found)
