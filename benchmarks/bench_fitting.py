"""Fits of NIST's 27 nonlinear sets from both starts: time against SciPy's, with the same printed model.

One process, one thread; variants are shuffled in every round, and medians are printed with ratios. SciPy is
asked for the last digits, too; what each reaches is printed beside. Nothing here is a test.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from bench_engine import medians
from scipy import optimize

sys.path.append(str(Path(__file__).resolve().parent.parent / "tests"))
import nist_strd

from loopsheet.report.fitting.least_squares import least_squares

OWN = "report.fitting"
METHODS = {"scipy lm": "lm", "scipy trf": "trf"}
EPS = 4 * float(np.finfo(float).eps)


def ways(one: nist_strd.Strd, start: Any) -> dict[str, Callable[[], Any]]:
    """What each way finds, as a function."""
    feet = one.fit(start).feet

    def by(method: str) -> Callable[[], Any]:
        def run() -> Any:
            ends = {"xtol": EPS, "ftol": EPS, "gtol": EPS, "max_nfev": 5000}
            with np.errstate(all="ignore"):
                try:
                    return optimize.least_squares(
                        feet.residuals, start, feet.jacobian, method=method, x_scale="jac", **ends
                    ).x
                except ValueError:  # it does not go on where the model has no value
                    return start * np.nan

        return run

    def own() -> Any:
        found = least_squares(feet.residuals, feet.jacobian, start)
        return found.parameters if found.converged else start * np.nan

    return {OWN: own} | {name: by(method) for name, method in METHODS.items()}


def main(names: tuple[str, ...] = tuple(nist_strd.MODELS)) -> dict[str, float]:
    """Run all, and return the sums of the medians."""
    every = {name: one for name, one in nist_strd.nonlinear().items() if name in names}
    totals: dict[str, float] = {}
    right: dict[str, int] = {}
    print("ms of report.fitting, and ratios of the others to it; in parentheses how many digits are right")
    for name, one in every.items():
        for number, start in enumerate(one.starts, start=1):
            asked = ways(one, start)
            took = medians(asked)
            told = [f"{name:9} {number} {took[OWN] * 1e3:8.2f} ms"]
            for way, run in asked.items():
                digits = max(0.0, np.nan_to_num(nist_strd.digits(run(), one.certified)))
                totals[way] = totals.get(way, 0.0) + took[way]
                right[way] = right.get(way, 0) + (digits >= 6)
                told.append(f"{took[way] / took[OWN]:6.2f} ({digits:4.1f})")
            print("  ".join(told))
    for way, total in totals.items():
        print(f"{total * 1e3:9.1f} ms, {total / totals[OWN]:5.2f}, {right[way]} right: {way}")
    return totals


if __name__ == "__main__":
    main()
