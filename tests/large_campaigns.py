"""Folders with many tests: pairs grow with the square of their number."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from test_synthetic import campaign

REPORT = """\
title = "{tests} tests"
workbook = "soft_impact"
[parameters]
ball_mass = "8.4 g"
target_mass = "1.5 kg"
points_per_pair = "{points}"
[measurements]
file = "measurements.csv"
"""


def write(folder: Path, tests: int, points: int = 2) -> Path:
    """A folder with so many tests at speeds from 2 to 5 m/s, made forward and printed with four digits.

    Parameters
    ----------
    folder : Path
    tests, points : int
        How many tests, and points for each pair of them.
    """
    v = np.linspace(2, 5, tests)
    e = 0.55 - 0.03 * (v - 2)
    made = campaign(v.tolist(), e.tolist(), alpha=1.3, beta=1.5)
    rows = zip(*(made.data[name] for name in ("v", "e", "x_p")), strict=True)
    lines = [f"{n},{v:.3f},{e:.4f},{x_p * 1e6:.2f}" for n, (v, e, x_p) in enumerate(rows, start=1)]
    (folder / "report.toml").write_text(REPORT.format(tests=tests, points=points))
    (folder / "measurements.csv").write_text("\n".join(["test,v [m/s],e [1],x_p [um]", *lines, ""]))
    return folder
