"""A one-way analysis of variance as a method of one's own, of NIST's data or of a few made-up readings."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
from helpers import method_folder

DATA: dict[str, dict[str, Any]] = tomllib.loads(
    (Path(__file__).resolve().parent / "strd" / "variance.toml").read_text(encoding="utf-8")
)
METHOD = """
from sympy import sqrt
from loopsheet import Method, claim, count, fit, given, groups, let, mean, measured, median, pairs, table
from loopsheet import total, unknown

class Variance(Method, source="ISO 5725-2", headline="between within F R2 s apart"):
    "One-way analysis of variance."
    y = measured("mm", "reading")
    instrument = groups("instrument")
    many = let(count(y, of=instrument), "readings of an instrument")
    level = let(mean(y, of=instrument), "mean of an instrument", like=y)
    squares = let(sum((y - level) ** 2, of=instrument), "squares of an instrument", "mm^2")
    scatter = let(sqrt(squares / (many - 1)), "scatter of an instrument", like=y)
    all_y = let(mean(y), "mean of all", like=y)
    between = let(sum(many * (level - all_y) ** 2), "squares between instruments", "mm^2")
    within = let(sum(squares), "squares within instruments", "mm^2")
    F = let(between / (count(level) - 1) / (within / (count(y) - count(level))), "F statistic")
    R2 = let(between / (between + within), "share between instruments")
    s = let(sqrt(within / (count(y) - count(level))), "scatter, pooled", like=y)
    apart = let(max(level) - min(level), "range of the means", like=y)
    middle = let(sum(many * level) / count(y) - all_y, "mean of means and mean", like=y)
    wide = let(max(y, of=instrument) - min(y, of=instrument), "range of an instrument", like=y)
    widest = let(max(wide), "widest range", like=y)
    typical = let(median(y, of=instrument), "median of an instrument", like=y)
    off = let(y / level, "reading by the mean of its instrument")
    farthest = let(max(off), "farthest reading")
    again = let(sum((y - mean(y, of=instrument)) ** 2), "squares within instruments, by readings", "mm^2")
"""
RATES = """
from loopsheet import Method, fit, groups, let, measured, unknown

class Rates(Method, headline="spread b"):
    "Rates over two catalysts."
    x = measured("1", "inverse temperature")
    y = measured("1", "logarithm of the rate")
    catalyst = groups("catalyst")
    a = unknown("intercept")
    b = unknown("slope")
    line = fit(y, a + b * x, of=catalyst)
    spread = let(max(b) - min(b), "range of the slopes")
    scaled = let(line.residual / line.s, "residual in scatters of its catalyst")
"""
RATES_HEAD = "catalyst,x [1],y [1]"
FEW = (
    ("A", "1.50"),
    ("B", "2.25"),
    ("A", "1.75"),
    ("A", "1.25"),
    ("C", "3.50"),
    ("B", "2.75"),
    ("C", "3.25"),
)


def write(
    path: Path,
    rows: tuple[tuple[str, ...], ...] = FEW,
    head: str = "instrument,y [mm]",
    code: str = METHOD,
    more: str = "",
) -> Path:
    """A folder of these readings, each a word and a number."""
    text = "\n".join(",".join((str(n), *row)) for n, row in enumerate(rows, start=1))
    return method_folder(path, code, f"reading,{head}\n{text}\n", f'title = "Instruments"\n{more}')


def certified(name: str, path: Path) -> Path:
    """A folder of NIST's readings, the instruments taking turns."""
    each = [own.split() for own in DATA[name]["readings"]]
    rows = tuple(
        (f"I{group}", y) for turn in zip(*each, strict=True) for group, y in enumerate(turn, start=1)
    )
    return write(path, rows)


def rates(seed: int, groups: int = 3, number: int = 17) -> tuple[tuple[str, ...], ...]:
    """Readings about a line for each of some catalysts, which take turns as the dice fall."""
    dice = np.random.default_rng(seed)
    own = dice.permutation(np.arange(number) % groups)
    x = dice.uniform(1, 3, number)
    y = 2 + own - (1 + own) * x + dice.normal(0, 0.05, number)
    return tuple((f"C{n}", f"{a:.3f}", f"{b:.3f}") for n, a, b in zip(own, x, y, strict=True))
