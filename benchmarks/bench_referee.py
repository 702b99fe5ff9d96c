"""What the referee costs: the shipped paper, and campaigns of more and more tests, honest and misprinted.

Prints seconds of processor time and its ratio to that of the shipped paper, measured in one interleaved run.
"""

from __future__ import annotations

import random
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from forged_campaigns import Campaign, honest, reprinted

from loopsheet.report import stages
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.study import Study

ROUNDS = 3


def of_size(tests: int, misprinted: bool) -> Campaign:
    """A campaign of so many tests; every pair and every test of it is published."""
    campaign = honest(random.Random(tests), tests)
    if misprinted:
        depths = campaign.measured["x_p"]
        depths[1] = reprinted(depths[1], 30)
        campaign = replace(campaign, measured={**campaign.measured, "x_p": depths})
    return campaign


def main() -> None:
    paper = Study(PAPER).computed
    runs: dict[str, Callable[[], object]] = {"the shipped paper": lambda: stages.refereed(paper)}
    for tests in (5, 10, 20, 40):
        for misprinted in (False, True):
            name = f"{tests} tests, {'one cell misprinted' if misprinted else 'honest'}"
            runs[name] = of_size(tests, misprinted).refereed
    taken: dict[str, list[float]] = {name: [] for name in runs}
    for _ in range(ROUNDS):
        for name, run in runs.items():
            begun = time.process_time()
            run()
            taken[name].append(time.process_time() - begun)
            print(f"{name:36} {taken[name][-1]:7.2f} s", flush=True)
    print("\nmedians, and ratios to the shipped paper")
    first = statistics.median(taken["the shipped paper"])
    for name, times in taken.items():
        middle = statistics.median(times)
        print(f"{name:36} {middle:7.2f} s  {middle / first:6.2f}")


if __name__ == "__main__":
    main()
