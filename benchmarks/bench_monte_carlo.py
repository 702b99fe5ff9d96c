"""A million draws of the paper's ten pairs, from the errors of its digits to both intervals.

Against drawing alone: NumPy that fills one array with all errors. Beside it the same draws, each asked for
its statuses. Ratios of medians of one run. Nothing here is a test.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from unittest.mock import patch

import numpy as np
from bench_engine import medians

from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.study import Study
from loopsheet.report.uncertainty import monte_carlo
from loopsheet.report.uncertainty.propagation import Spread

DRAWS = 1_000_000
ALONE = "drawing the inputs alone"


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
        "all of it": drawn,
        "the same, each draw asked whether it has a value": each_asked,
    }


if __name__ == "__main__":
    found = medians(ways())
    print(f"{DRAWS} draws of ten pairs: ms, ratio to {ALONE}")
    for name, seconds in found.items():
        print(f"  {seconds * 1e3:9.1f}  {seconds / found[ALONE]:6.2f}  {name}")
