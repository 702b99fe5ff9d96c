"""Builds of the shipped paper against a marimo export of comparable content, and answers against Python.

A build from nothing, after one number was edited, and of what was built before; and what of these cannot be
done without, by itself: matplotlib with the figures that show data, the proofs. Beside two builds the same
without uncertainties: nothing is propagated, for the report or by its page. Prints ratios of medians from
interleaved runs. Nothing here is a test.
"""

from __future__ import annotations

import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from itertools import count
from pathlib import Path

ROUNDS = 7
HERE = Path(__file__).resolve().parent
BINARIES = Path(sys.executable).parent


def seconds(command: list[str], cwd: Path) -> float:
    """Wall time of a process; it must do what it is asked for, whatever it finds."""
    begun = time.perf_counter()
    done = subprocess.run(command, cwd=cwd, check=False, capture_output=True, text=True)
    taken = time.perf_counter() - begun
    if done.returncode not in (0, 1):
        sys.exit(f"{' '.join(command)}: {done.stderr}")
    return taken


def interleaved(runs: dict[str, Callable[[], float]]) -> dict[str, float]:
    """Median seconds of each, run in turn so that a slow moment hits all of them."""
    found: dict[str, list[float]] = {name: [] for name in runs}
    for round_ in range(ROUNDS + 1):
        for name, run in runs.items():
            taken = run()
            if round_:  # the first round warms the disk
                found[name].append(taken)
    return {name: statistics.median(times) for name, times in found.items()}


def builds(cwd: Path) -> dict[str, Callable[[], float]]:
    """Ways to build the paper, in a folder of its own; and the notebook, if marimo is there."""
    loopsheet, campaign = str(BINARIES / "loopsheet"), cwd / "campaign"
    paper = HERE.parent / "data" / "soft_steel"
    shutil.copytree(paper, campaign)
    table, digits = campaign / "measurements.csv", count(1)

    def edited(*command: str) -> float:
        row = re.sub(r"29\.7\d*", f"29.7{next(digits):03}", (paper / table.name).read_text())
        table.write_text(row)
        return seconds([*command, "build", "campaign"], cwd)

    without = sys.executable, "-c", WITHOUT
    runs = {
        "build --no-cache": lambda: seconds([loopsheet, "build", "paper", "--no-cache"], cwd),
        "  without uncertainties": lambda: seconds([*without, "build", "paper", "--no-cache"], cwd),
        "build, a number edited": lambda: edited(loopsheet),
        "  edited, without": lambda: edited(*without),
        "build, nothing changed": lambda: seconds([loopsheet, "build", "paper"], cwd),
    }
    if (BINARIES / "marimo").exists():
        shutil.copy(HERE / "notebook_marimo.py", cwd / "notebook.py")
        export = [str(BINARIES / "marimo"), "export", "html", "notebook.py", "-o", "notebook.html"]
        runs["marimo export"] = lambda: seconds(export, cwd)
    return runs


WITHOUT = """
import sys
from unittest.mock import patch
from loopsheet.report import cli, stages
from loopsheet.report.result.uncertain import Uncertainties
from loopsheet.report.views import live_uncertain
patch.object(stages, "uncertain", lambda *_: Uncertainties({})).start()
patch.object(live_uncertain, "follows", lambda _: False).start()
sys.exit(cli.main())
"""
DRAWING = """
import sys, time
from pathlib import Path
from loopsheet.report.study import Study
from loopsheet.report.views import figures
report = Study(Path("campaign")).refereed
drawn = [figure.drawing for figure in figures.of(report) if not figure.fixed]
report.plotted()
begun = time.perf_counter()
for name in drawn[int(sys.argv[1])::int(sys.argv[2])]:
    figures.files(report, name, ["svg", "pdf"])
print(time.perf_counter() - begun)
"""
PROVING = """
import sys
from loopsheet.derivations.proof import prove
from loopsheet.derivations.soft_impact import LEDGER
labels = [equation.label for equation in LEDGER.equations()]
prove(LEDGER, only=set(labels[int(sys.argv[1])::int(sys.argv[2])]))
"""


def shared(code: str, cwd: Path, parts: int, told: bool = False) -> float:
    """Wall time of processes that do a part each, side by side; or the longest time that they tell."""
    begun = time.perf_counter()
    commands = [[sys.executable, "-c", code, str(part), str(parts)] for part in range(parts)]
    running = [subprocess.Popen(command, cwd=cwd, stdout=subprocess.PIPE, text=True) for command in commands]
    answers = [process.communicate()[0] for process in running]
    return max(map(float, answers)) if told else time.perf_counter() - begun


def floors(cwd: Path) -> dict[str, Callable[[], float]]:
    """What no build does without, by itself: below that, only less can be drawn or proved."""
    return {
        "  Python and NumPy": lambda: seconds([sys.executable, "-c", "import numpy"], cwd),
        "  drawing, one process": lambda: shared(DRAWING, cwd, 1, True),
        "  drawing, two": lambda: shared(DRAWING, cwd, 2, True),
        "  proving, one process": lambda: shared(PROVING, cwd, 1),
        "  proving, two": lambda: shared(PROVING, cwd, 2),
    }


def answers(cwd: Path) -> dict[str, Callable[[], float]]:
    """What is asked of a report, and the interpreter alone."""
    loopsheet = str(BINARIES / "loopsheet")
    commands = {
        "python": [sys.executable, "-c", "pass"],
        "--help": [loopsheet, "--help"],
        "show": [loopsheet, "show", "alpha_mean", "paper"],
        "why": [loopsheet, "why", "alpha[1-2]", "paper"],
        "why --no-cache": [loopsheet, "why", "alpha[1-2]", "paper", "--no-cache"],
    }
    return {name: lambda command=command: seconds(command, cwd) for name, command in commands.items()}  # type: ignore[misc]


def main() -> None:
    """Run both comparisons, with a cache of their own."""
    with tempfile.TemporaryDirectory() as folder:
        cwd = Path(folder)
        os.environ["LOOPSHEET_CACHE"] = str(cwd / "cache")
        medians = interleaved({**builds(cwd), **floors(cwd)})
        marimo = medians.get("marimo export")
        for name, taken in medians.items():
            print(
                f"{name:24} {taken:6.2f} s" + (f"  {taken / marimo:5.2f} of marimo export" if marimo else "")
            )
        if marimo is None:
            print("marimo is not installed: there is nothing to compare with")
        medians = interleaved(answers(cwd))
        for name, taken in medians.items():
            print(
                f"{name:24} {1000 * taken:6.1f} ms, {1000 * (taken - medians['python']):6.1f} ms above Python"
            )


if __name__ == "__main__":
    main()
