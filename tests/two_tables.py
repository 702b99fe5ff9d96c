"""A report folder with two tables of rows: standards of a calibration line, and samples."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

METHOD = '''\
from loopsheet import Method, count, fit, let, mean, measured, rows, unknown


class Calibration(Method, source="A Lab, 2026", rows="standards", headline="m b x_mean"):
    """Contents of samples by a calibration line."""

    samples = rows("samples")
    c = measured("mg/L", "concentration of a standard", positive=True, example="1.0 2.0 4.0")
    y = measured("1", "signal of a standard", example="0.113 0.209 0.402")
    y_s = measured("1", "signal of a sample", of=samples, example="0.314 0.501")
    m = unknown("slope", "L/mg")
    b = unknown("intercept", "1")
    line = fit(y, m * c + b)
    x = let((y_s - b) / m, "content of a sample", "mg/L")
    x_mean = let(mean(x), "mean content", "mg/L")
    many = let(count(of=samples), "how many samples", "1")
'''
TOML = """\
title = "Contents"
workbook = "workbook.py"

[measurements.standards]
file = "standards.csv"

[measurements.samples]
file = "samples/today.csv"

[uncertainty]
c = "exact"
y = "u = 0.002"
"""
STANDARDS = """\
standard,c [mg/L],y [1],left out
1,1.00,0.113,
2,2.00,0.209,
3,4.00,0.402,
4,6.00,0.605,
5,8.00,0.798,
7,9.00,0.951,spilled
"""
SAMPLES = """\
sample,lot,y_s [1],u(y_s) [1]
1,A-1,0.314,0.002
2,A-2,0.501,0.003
4,B-7,0.677,0.002
"""
FILES = {"workbook.py": METHOD, "report.toml": TOML, "standards.csv": STANDARDS, "samples/today.csv": SAMPLES}

C = np.array([1.0, 2.0, 4.0, 6.0, 8.0])
Y = np.array([0.113, 0.209, 0.402, 0.605, 0.798])
SIGNALS = np.array([0.314, 0.501, 0.677])
U_Y, U_SIGNALS = 0.002, np.array([0.002, 0.003, 0.002])


def write(folder: Path, **changed: str) -> Path:
    """Write it, with other texts in some of its files, each by the name before the dot."""
    for name, text in FILES.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(changed.get(path.stem, text), encoding="utf-8")
    return folder


def contents(y: NDArray[np.float64], signals: NDArray[np.float64]) -> NDArray[np.float64]:
    """Slope and intercept, and the contents, as NumPy finds them, in mg/L; `y` may be many lines."""
    apart = C - C.mean()
    slope = (apart * y).sum(axis=-1, keepdims=True) / (apart**2).sum()
    intercept = y.mean(axis=-1, keepdims=True) - slope * C.mean()
    return np.concatenate([slope, intercept, (signals - intercept) / slope], axis=-1)
