"""Cold build of the shipped paper against a marimo export of comparable content, and --help against Python.

Prints ratios of medians from one interleaved run. Nothing here is a test.
"""

from __future__ import annotations

import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROUNDS = 7
HERE = Path(__file__).resolve().parent


def seconds(command: list[str], cwd: Path) -> float:
    """Wall time of a process; it must succeed."""
    begun = time.perf_counter()
    subprocess.run(command, cwd=cwd, check=True, capture_output=True)
    return time.perf_counter() - begun


def interleaved(commands: dict[str, list[str]], cwd: Path) -> dict[str, float]:
    """Median seconds of each command, run in turn so that a slow moment hits all of them."""
    found: dict[str, list[float]] = {name: [] for name in commands}
    for round_ in range(ROUNDS + 1):
        for name, command in commands.items():
            taken = seconds(command, cwd)
            if round_:  # the first round warms the disk
                found[name].append(taken)
    return {name: statistics.median(times) for name, times in found.items()}


def main() -> None:
    """Run both comparisons."""
    binaries = Path(sys.executable).parent
    loopsheet = str(binaries / "loopsheet")
    with tempfile.TemporaryDirectory() as folder:
        cwd = Path(folder)
        commands = {"build": [loopsheet, "build", "--out", "out"]}
        if (binaries / "marimo").exists():
            shutil.copy(HERE / "notebook_marimo.py", cwd / "notebook.py")
            commands["marimo"] = [
                str(binaries / "marimo"),
                "export",
                "html",
                "notebook.py",
                "-o",
                "notebook.html",
            ]
        medians = interleaved(commands, cwd)
        for name, taken in medians.items():
            print(f"{name:8} {taken:6.2f} s")
        if "marimo" in medians:
            print(f"build / marimo export: {medians['build'] / medians['marimo']:.2f} (aim: 0.6 or less)")
        medians = interleaved(
            {"python": [sys.executable, "-c", "pass"], "--help": [loopsheet, "--help"]}, cwd
        )
        for name, taken in medians.items():
            print(f"{name:8} {1000 * taken:6.1f} ms")
        print(f"--help / bare interpreter: {medians['--help'] / medians['python']:.2f}")


if __name__ == "__main__":
    main()
