"""NIST's Statistical Reference Datasets for regression: the models, and what `strd/*.toml` says of them.

Source: NIST/ITL StRD, Nonlinear and Linear Least Squares Regression (public domain).
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from sympy import Expr, Rational, Symbol, atan, cos, exp, pi, sin, symbols

Array = NDArray[np.float64]
FOLDER = Path(__file__).resolve().parent / "strd"

x, x1, x2, y = symbols("x x1 x2 y")
b1, b2, b3, b4, b5, b6, b7, b8, b9 = PARAMETERS = symbols("b1:10")
_growth = b1 * (1 - exp(-b2 * x))
_decay = exp(-b1 * x) / (b2 + b3 * x)
_cubic = (b1 + b2 * x + b3 * x**2 + b4 * x**3) / (1 + b5 * x + b6 * x**2 + b7 * x**3)
_peaks = b1 * exp(-b2 * x) + b3 * exp(-((x - b4) ** 2) / b5**2) + b6 * exp(-((x - b7) ** 2) / b8**2)
_exponentials = b1 * exp(-b2 * x) + b3 * exp(-b4 * x) + b5 * exp(-b6 * x)


def _wave(a: Expr, b: Expr, period: Expr | int) -> Expr:
    return a * cos(2 * pi * x / period) + b * sin(2 * pi * x / period)


MODELS: dict[str, Expr] = {
    "Bennett5": b1 * (b2 + x) ** (-1 / b3),
    "BoxBOD": _growth,
    "Chwirut1": _decay,
    "Chwirut2": _decay,
    "DanWood": b1 * x**b2,
    "ENSO": b1 + _wave(b2, b3, 12) + _wave(b5, b6, b4) + _wave(b8, b9, b7),
    "Eckerle4": b1 / b2 * exp(-(((x - b3) / b2) ** 2) / 2),
    "Gauss1": _peaks,
    "Gauss2": _peaks,
    "Gauss3": _peaks,
    "Hahn1": _cubic,
    "Kirby2": (b1 + b2 * x + b3 * x**2) / (1 + b4 * x + b5 * x**2),
    "Lanczos1": _exponentials,
    "Lanczos2": _exponentials,
    "Lanczos3": _exponentials,
    "MGH09": b1 * (x**2 + x * b2) / (x**2 + x * b3 + b4),
    "MGH10": b1 * exp(b2 / (x + b3)),
    "MGH17": b1 + b2 * exp(-x * b4) + b3 * exp(-x * b5),
    "Misra1a": _growth,
    "Misra1b": b1 * (1 - (1 + b2 * x / 2) ** -2),
    "Misra1c": b1 * (1 - (1 + 2 * b2 * x) ** Rational(-1, 2)),
    "Misra1d": b1 * b2 * x / (1 + b2 * x),
    "Nelson": b1 - b2 * x1 * exp(-b3 * x2),  # of the logarithm of y
    "Rat42": b1 / (1 + exp(b2 - b3 * x)),
    "Rat43": b1 / (1 + exp(b2 - b3 * x)) ** (1 / b4),
    "Roszman1": b1 - b2 * x - atan(b3 / (x - b4)) / pi,
    "Thurber": _cubic,
}


class Strd(NamedTuple):
    """One set: y = value of others, plus an error."""

    value: Expr
    parameters: tuple[Symbol, ...]
    starts: tuple[Array, ...]
    certified: Array
    deviations: Array
    squares: float
    y: Array
    of: Mapping[Symbol, Array]


def _numbers(text: str, end: str) -> Array:
    return np.array([[float(number) for number in row.split()] for row in text.split(end) if row.strip()])


def nonlinear() -> dict[str, Strd]:
    """All nonlinear sets, by their names."""
    found = {}
    for name, said in tomllib.loads((FOLDER / "nonlinear.toml").read_text(encoding="utf-8")).items():
        first, second, certified, deviations = _numbers(said["parameters"], "\n").T
        observed, *given = _numbers(said["rows"], ";").T
        of = dict(zip((x,) if len(given) == 1 else (x1, x2), given, strict=True))
        found[name] = Strd(
            MODELS[name],
            PARAMETERS[: len(certified)],
            (first, second),
            certified,
            deviations,
            float(said["squares"]),
            np.log(observed) if name == "Nelson" else observed,
            of,
        )
    return found


def linear() -> dict[str, Strd]:
    """All linear sets, by their names: polynomials, without a constant term in NoInt, and Longley's plane."""
    found = {}
    for name, said in tomllib.loads((FOLDER / "linear.toml").read_text(encoding="utf-8")).items():
        certified, deviations = _numbers(said["parameters"], "\n").T
        observed, *given = _numbers(said["rows"], ";").T
        of = dict(zip(symbols("x1:7") if name == "Longley" else (x,), given, strict=True))
        first = 1 if name.startswith("NoInt") else 0
        terms = (
            [1, *of] if name == "Longley" else [x**power for power in range(first, first + len(certified))]
        )
        parameters = symbols(f"b0:{len(certified)}")
        value = sum(b * term for b, term in zip(parameters, terms, strict=True))
        start = np.zeros(len(certified))
        found[name] = Strd(value, parameters, (start,), certified, deviations, np.nan, observed, of)
    return found


def digits(found: Array, certified: Array, printed: int = 11) -> float:
    """How many significant digits of all numbers are right, of those that are printed."""
    apart = np.abs(np.asarray(found) - certified) / np.abs(certified)
    return float(-np.log10(np.maximum(apart, 10.0**-printed).max()))
