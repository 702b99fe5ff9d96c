"""A million draws of the paper's ten pairs, from the errors of its digits to both intervals.

Against drawing alone: NumPy that fills one array with all errors. Beside it the same draws, each asked for
its statuses. Ratios of medians of one run. Then where the processor's time of all of it goes, the least of
several runs. Nothing here is a test.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any
from unittest.mock import patch

import numpy as np
from bench_engine import medians

from loopsheet.report.engines import numpy_beside
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.study import Study
from loopsheet.report.uncertainty import monte_carlo
from loopsheet.report.uncertainty.propagation import Spread

DRAWS = 1_000_000
ALONE = "drawing the inputs alone"
ALL = "all of it"
ROUNDS = 9
PARTS = {
    "errors drawn, and added": (monte_carlo._Draws, "_batch"),
    "roots": (numpy_beside._Rows, "root"),
    "cells named by pairs": (numpy_beside._Rows, "rows"),
    "what batches and all of them tell": (monte_carlo, "_told"),
}
"""What takes time, and the functions that do it; none calls another."""


def ways(draws: int = DRAWS) -> dict[str, Callable[[], Any]]:
    """The mean of the exponents in several ways; and an array of as many errors."""
    report = Study(PAPER).computed
    budget = Spread(report.inputs, report.values).budget("alpha_mean", 0)
    sources = monte_carlo._Draws(report.inputs, report.values, "alpha_mean", 1).sources
    errors, generator = np.empty((draws, len(sources))), np.random.default_rng(1)

    def drawn() -> Any:
        return monte_carlo.draw(report.inputs, report.values, budget, draws, tolerance=0.0)

    def each_asked() -> Any:
        with patch.object(monte_carlo._Draws, "_beside", lambda *_: None):
            return drawn()

    return {
        ALONE: lambda: generator.random(out=errors),
        ALL: drawn,
        "the same, each draw asked whether it has a value": each_asked,
    }


def timed(function: Callable[..., Any], part: str, spent: Counter[str]) -> Callable[..., Any]:
    """The same function, which counts what it takes."""

    def counting(*given: Any, **more: Any) -> Any:
        begun = time.process_time()
        found = function(*given, **more)
        spent[part] += time.process_time() - begun  # type: ignore[assignment]
        return found

    return counting


@contextmanager
def counted(spent: Counter[str]) -> Iterator[None]:
    """Count the processor's time of each part."""
    with ExitStack() as stack:
        for part, (place, name) in PARTS.items():
            stack.enter_context(patch.object(place, name, timed(getattr(place, name), part, spent)))
        yield


def spent(run: Callable[[], Any]) -> dict[str, float]:
    """Seconds of the processor that each part takes, and all of it, in the run that took the fewest."""
    runs: list[Counter[str]] = []
    for _ in range(ROUNDS):
        own: Counter[str] = Counter()
        with counted(own):
            begun = time.process_time()
            run()
            own[ALL] = time.process_time() - begun  # type: ignore[assignment]
        runs.append(own)
    return dict(min(runs, key=lambda own: own[ALL]))


if __name__ == "__main__":
    compared = ways()
    found = medians(compared)
    print(f"{DRAWS} draws of ten pairs: ms, ratio to {ALONE}")
    for name, seconds in found.items():
        print(f"  {seconds * 1e3:9.1f}  {seconds / found[ALONE]:6.2f}  {name}")
    parts = spent(compared[ALL])
    print("where that goes: ms of the processor, share")
    for name, seconds in parts.items():
        print(f"  {seconds * 1e3:9.1f}  {seconds / parts[ALL]:6.0%}  {name}")
