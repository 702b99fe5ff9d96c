"""Campaigns with one decimal sign in the wrong place."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

PAPER = {
    "v": ("2.334", "2.940", "4.089", "4.504", "4.993"),
    "e": ("0.530", "0.512", "0.479", "0.467", "0.453"),
    "x_p": ("23.5", "29.7", "41.6", "45.97", "51.03"),
}
Texts = Mapping[str, Sequence[str]]
"""Printed measurements by column."""


def write(folder: Path, texts: Texts, more: str = "") -> Path:
    """Make a report folder of it, with `more` at the end of its report.toml."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = (",".join([str(n), *row]) for n, row in enumerate(zip(*texts.values(), strict=True), 1))
    (folder / "measurements.csv").write_text("\n".join(["test,v [m/s],e [1],x_p [um]", *rows, ""]))
    (folder / "report.toml").write_text(
        'workbook = "soft_impact"\n[parameters]\nball_diameter = "12.7 mm"\nball_density = "7800 kg/m^3"\n'
        f'points_per_pair = "2"\n[measurements]\nfile = "measurements.csv"\n{more}'
    )
    return folder


@dataclass(frozen=True)
class Slip:
    """A decimal sign one place too far to the right, or to the left."""

    column: str
    test: int
    up: bool

    def of(self, texts: Texts) -> Texts:
        """The campaign with it."""
        column = list(texts[self.column])
        column[self.test - 1] = moved(column[self.test - 1], self.up)
        return {**texts, self.column: column}


def moved(text: str, up: bool) -> str:
    """The same digits with the decimal sign one place further."""
    whole, _, fraction = text.partition(".")
    digits, place = ("0" + whole + fraction + "0", len(whole) + (2 if up else 0))
    return f"{digits[:place].lstrip('0') or '0'}.{digits[place:]}"


def slips(texts: Texts) -> Iterator[Slip]:
    """Every decimal sign moved to either side; a restitution above 1 is refused by the reader."""
    for column, numbers in texts.items():
        for test, number in enumerate(numbers, 1):
            for up in (True, False):
                if column != "e" or Fraction(moved(number, up)) <= 1:
                    yield Slip(column, test, up)


def campaign(dice: random.Random, number: int, noise: float) -> Texts:
    """Tests of the model with some noise, printed with three or four digits as people do."""
    alpha, mass, beta = dice.uniform(1.05, 1.45), 8.366e-3, 1.5
    coefficient, speed, v = 10 ** (9 + 5 * (alpha - 1.3)), 1.6, []
    for _ in range(number):
        speed *= dice.uniform(1.08, 1.4)
        v.append(round(speed, 3))
    e = [round(0.62 * x**-0.2 * (1 + dice.gauss(0, noise)), 3) for x in v]
    tops = [((alpha + 1) * mass * x**2 / (2 * coefficient)) ** (1 / (alpha + 1)) for x in v]
    x_p = [
        1e6 * top * (1 - (beta + 1) / (alpha + 1) * back**2) * (1 + dice.gauss(0, noise))
        for top, back in zip(tops, e, strict=True)
    ]
    return {"v": [f"{x:.3f}" for x in v], "e": [f"{x:.3f}" for x in e], "x_p": [f"{x:.2f}" for x in x_p]}
