"""The processors of this machine, for what NumPy computes: it lets other threads run meanwhile."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

MOST = 4
"""Threads: each holds something large, and who gives them work does that alone."""

Given = TypeVar("Given")
Found = TypeVar("Found")


def in_threads(function: Callable[[Given], Found], given: Iterable[Given]) -> Generator[Found]:
    """What a function makes of each, in their order, while as many more are computed as there are processors.

    Of `given` no more is taken than that: it may be large, and who has enough may close the iterator.

    >>> list(in_threads(str.upper, "abc"))
    ['A', 'B', 'C']
    """
    there = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    threads, begun = min(there, MOST), deque[Future[Found]]()
    pool = ThreadPoolExecutor(threads)
    try:
        for each in given:
            begun.append(pool.submit(function, each))
            if len(begun) > threads:
                yield begun.popleft().result()
        while begun:
            yield begun.popleft().result()
    finally:
        pool.shutdown(cancel_futures=True)
