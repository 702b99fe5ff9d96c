"""Campaigns as publications print them: made from the model, printed with few digits, and perhaps forged."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from math import prod
from pathlib import Path
from typing import Any

from loopsheet.report import verdict_words as words
from loopsheet.report.analysis.referee import print_as, referee
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.numpy import Program
from loopsheet.report.errors import Location
from loopsheet.report.inputs import Inputs
from loopsheet.report.published import PublishedValue
from loopsheet.report.quantity import Printed
from loopsheet.report.values import Values
from loopsheet.report.verdict import EXACT, REACHABLE, Referee
from loopsheet.report.workbooks.soft_impact import WORKBOOK

UM, ONE = Fraction(1, 10**6), Fraction(1)
# What is printed: column, unit, that in SI, decimals.
TABLE_1 = (("v", "m/s", ONE, 3), ("e", "1", ONE, 3), ("x_p", "um", UM, 2))
TABLES = (
    ("Table 2", "alpha", "1", ONE, 4),
    ("Table 3", "x_m", "um", UM, 2),
    ("Table 3", "Cprime_eq7", "N", ONE, 1),
    ("Table 3", "Cprime_eq9", "N", ONE, 1),
    ("text", "alpha_mean", "1", ONE, 4),
)
FREE = ("alpha_log", "C_log")
"""The publication prints neither coefficient nor exponent of its fit."""


@dataclass(frozen=True)
class Forgery:
    """What was done to a campaign after it had been printed.

    Parameters
    ----------
    kind, cell, source : str
        As in :class:`~loopsheet.report.verdict.Explanation`.
    rows : set of tuple of int
        The rows it was done to; an explanation names one of them. Empty for a column.
    """

    kind: str
    cell: str
    source: str
    rows: frozenset[tuple[int, ...]] = frozenset()

    def named_by(self, found: Referee) -> bool:
        """Whether one of the explanations is what was done."""
        return any(
            (each.kind, each.cell, each.source) == (self.kind, self.cell, self.source)
            and (each.index in self.rows or not self.rows)
            for explanation in found.explanations
            for each in explanation.changes
        )


@dataclass(frozen=True)
class Campaign:
    """A printed campaign."""

    measured: dict[str, list[Printed]]
    published: list[PublishedValue]
    mass: float
    forgery: Forgery | None = None

    def refereed(self) -> Referee:
        """What the referee says of it."""
        sheet = program().sheet
        data = {"beta": 1.5, "points_per_pair": 20.0, "ball_mass": self.mass}
        data |= {name: [float(p.value) for p in column] for name, column in self.measured.items()}
        tests = tuple(range(1, len(self.measured["v"]) + 1))
        values = engine.evaluate(sheet, {"tests": tests}, data, program())
        mass = Fraction(repr(self.mass))
        inputs = Inputs(
            Path(), "", WORKBOOK,
            {
                "ball_mass": Printed(repr(self.mass), "kg", mass, ONE),
                "beta": Printed("1.5", "1", Fraction(3, 2), ONE),
                "points_per_pair": Printed("20", "1", Fraction(20), ONE),
            },
            frozenset({"ball_mass"}), tests,
            {name: tuple(column) for name, column in self.measured.items()}, {}, tuple(self.published), {},
            dict.fromkeys(FREE, Location("")),
        )  # fmt: skip
        return referee(sheet, inputs, values, data)


@cache
def program() -> Program:
    """The program of the sheet that all campaigns share."""
    return Program.of(WORKBOOK.sheet(frozenset({"ball_mass"})))


def printed(value: float, unit: str, scale: Fraction, decimals: int, mode: str = "rounded") -> Printed:
    """A value as it is printed. That it was truncated is not said in print."""
    like = Printed("0." + "0" * decimals, unit, Fraction(0), scale, mode)
    text = print_as(value, like)
    return Printed(text, unit, Fraction(text) * scale, scale)


def _model(rng: random.Random, number: int) -> tuple[dict[str, list[float]], float]:
    """Tests on one compression curve but for a thousandth in depth, as measured ones are."""
    alpha, mass = rng.uniform(1.1, 1.45), rng.uniform(0.005, 0.02)
    coefficient = 10 ** (9 + 5 * (alpha - 1.3))
    # Speeds grow by a tenth at least; fewer of them by more.
    steps = [rng.uniform(1.1, max(1.15, 4 ** (1 / number))) for _ in range(number)]
    v = [1.2 * prod(steps[: n + 1]) for n in range(number)]
    e = [0.62 * x**-0.22 * rng.uniform(0.99, 1.01) for x in v]
    tops = [((alpha + 1) * mass * x**2 / (2 * coefficient)) ** (1 / (alpha + 1)) for x in v]
    x_p = [
        top * (1 - 2.5 / (alpha + 1) * f**2) * (1 + rng.gauss(0, 0.001))
        for top, f in zip(tops, e, strict=True)
    ]
    return {"v": v, "e": e, "x_p": x_p}, mass


def _computed(rng: random.Random, number: int) -> tuple[dict[str, list[float]], float, Values]:
    """A campaign of whose cells all have values, and sensible ones."""
    while True:
        truth, mass = _model(rng, number or rng.randint(4, 5))
        data = {**truth, "beta": 1.5, "points_per_pair": 20.0, "ball_mass": mass}
        values = engine.evaluate(program().sheet, {"tests": range(1, len(truth["v"]) + 1)}, data, program())
        cells = [values.value[name] for _, name, *_ in TABLES]
        if all((cell == cell).all() for cell in cells) and cells[0].min() > 0.5 and cells[0].max() < 3:
            return truth, mass, values


def honest(rng: random.Random, number: int = 0) -> Campaign:
    """Computed from what was measured, then all of it printed; of four or five tests, if nothing is said."""
    return _printed(*_computed(rng, number), truncated="")


def _printed(truth: dict[str, list[float]], mass: float, values: Values, truncated: str) -> Campaign:
    modes = dict.fromkeys(truth, "rounded") | {truncated: "truncated"}
    measured = {
        name: [printed(x, unit, scale, decimals, modes[name]) for x in truth[name]]
        for name, unit, scale, decimals in TABLE_1
    }
    published = [
        PublishedValue(source, cell, index, printed(x, unit, scale, decimals))
        for source, cell, unit, scale, decimals in TABLES
        for index, x in zip(values.labels(values.sheet[cell]), values.value[cell].tolist(), strict=True)
    ]
    return Campaign(measured, published, mass)


def _misprinted(rng: random.Random, of: Printed) -> Printed:
    """Another number with as many decimals."""
    return reprinted(of, rng.choice([-1, 1]) * rng.choice([2, 3, 5, 10, 20, 100]))


def reprinted(of: Printed, units: int) -> Printed:
    """A number that is so many units of its last digit more."""
    text = print_as(float(of.value + 2 * units * of.half_unit), of)
    return replace(of, text=text, value=Fraction(text) * of.scale)


def misprinted_input(rng: random.Random) -> Campaign:
    """One measured cell is another number."""
    campaign = honest(rng)
    name, row = rng.choice(sorted(campaign.measured)), rng.randrange(len(campaign.measured["v"]))
    column = campaign.measured[name]
    column[row] = _misprinted(rng, column[row])
    if not 0 < column[row].value < (1 if name == "e" else 100):
        return misprinted_input(rng)
    return replace(campaign, forgery=Forgery("misprint", name, "input", frozenset({(row + 1,)})))


def misprinted_table(rng: random.Random) -> Campaign:
    """One published cell is another number."""
    campaign = honest(rng)
    row = rng.randrange(len(campaign.published))
    value = campaign.published[row]
    campaign.published[row] = replace(value, printed=_misprinted(rng, value.printed))
    return replace(campaign, forgery=Forgery("misprint", value.cell, value.source, frozenset({value.index})))


def _two(rng: random.Random, among: Sequence[Any], text: Callable[[Any], str]) -> tuple[int, int]:
    while True:
        one, other = rng.sample(range(len(among)), 2)
        if text(among[one]) != text(among[other]):
            return one, other


def exchanged_table(rng: random.Random) -> Campaign:
    """Two rows of a table stand in each other's place."""
    campaign = honest(rng)
    source, cell, *_ = rng.choice(TABLES[:4])
    rows = [n for n, value in enumerate(campaign.published) if value.cell == cell]
    n, m = (rows[k] for k in _two(rng, rows, lambda row: campaign.published[row].printed.text))
    one, other = campaign.published[n], campaign.published[m]
    campaign.published[n] = replace(one, printed=other.printed)
    campaign.published[m] = replace(other, printed=one.printed)
    return replace(campaign, forgery=Forgery("label", cell, source, frozenset({one.index, other.index})))


def exchanged_input(rng: random.Random) -> Campaign:
    """Two measured cells of a column stand in each other's place."""
    campaign = honest(rng)
    name = rng.choice(sorted(campaign.measured))
    column = campaign.measured[name]
    n, m = _two(rng, column, lambda each: each.text)
    column[n], column[m] = column[m], column[n]
    return replace(campaign, forgery=Forgery("label", name, "input", frozenset({(n + 1,), (m + 1,)})))


def truncated(rng: random.Random) -> Campaign:
    """A measured column was cut off and not rounded."""
    name = rng.choice(TABLE_1)[0]
    campaign = _printed(*_computed(rng, 0), truncated=name)
    return replace(campaign, forgery=Forgery("truncated", name, "input"))


FORGERS: tuple[Callable[[random.Random], Campaign], ...] = (
    misprinted_input,
    misprinted_table,
    exchanged_table,
    exchanged_input,
    truncated,
)


def accused(seed: int, number: int) -> str:
    """What is wrongly said of one of the honest campaigns of a seed."""
    found = honest(random.Random(f"honest {seed} {number}")).refereed()
    assert found.joint is not None
    verdicts = {each.verdict for each in (*found.values, *found.tables, found.joint)}
    said = [*map(words.explained, found.explanations), *map(words.relabelled, found.labels)]
    return " ".join([*sorted(verdicts - {EXACT, REACHABLE}), *said])


def judged(kind: int, seed: int, number: int) -> str:
    """Whether a forgery was named; or that its digits can be reached all the same, so that nobody could."""
    campaign = FORGERS[kind](random.Random(f"{FORGERS[kind].__name__} {seed} {number}"))
    found = campaign.refereed()
    assert campaign.forgery is not None
    assert found.joint is not None
    if found.joint.verdict in (EXACT, REACHABLE):
        return "reachable"
    return (
        "named"
        if campaign.forgery.named_by(found)
        else f"missed {campaign.forgery}, number {number} of seed {seed}"
    )
