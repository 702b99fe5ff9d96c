"""Campaigns as publications print them: made from the model, printed as their authors do, and perhaps forged.

Publications differ in how many tests and digits they print, whether all rows of a column have as many
decimals, what they compute from what was already printed, which average and fit they print, and which
conventions they leave unsaid. None of that is wrong. A forgery changes something after all of it was printed.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from decimal import Decimal
from fractions import Fraction
from functools import cache
from math import floor, log10, prod
from pathlib import Path
from statistics import median
from typing import Any

from uncertain_data import uncertain

from loopsheet.report.cells.values import Values
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.numpy import Program
from loopsheet.report.inputs.inputs import Inputs
from loopsheet.report.inputs.measurements import Measurements
from loopsheet.report.inputs.published import PublishedValue
from loopsheet.report.messages.errors import Location
from loopsheet.report.quantity import Printed
from loopsheet.report.referee import print_as
from loopsheet.report.referee.judging import referee
from loopsheet.report.referee.numbers import numbers_of
from loopsheet.report.result import verdict_words as words
from loopsheet.report.result.verdict import INPUT, Explanation, Referee
from loopsheet.report.sheet import Given, Sheet
from loopsheet.report.stages import silent
from loopsheet.report.workbooks.soft_impact import WORKBOOK

UM, ONE = Fraction(1, 10**6), Fraction(1)
UNITS = {"x_p": ("um", UM), "x_m": ("um", UM)}
"""Units in which columns are printed, where that is not SI."""
TABLES = (
    ("Table 2", "alpha"),
    ("Table 3", "x_m"),
    ("Table 3", "Cprime_eq7"),
    ("Table 3", "Cprime_eq9"),
    ("text", "alpha_mean"),
)
FIT = (("text", "alpha_log"), ("text", "C_log"))
"""Exponent and coefficient of the fit; where they are not printed, they are free."""
POINTS = 20


@dataclass(frozen=True)
class Forgery:
    """What was done to a campaign after it had been printed.

    Parameters
    ----------
    kinds : set of str
        As in :class:`~loopsheet.report.result.verdict.Change`; each of them says it.
    cells : set of (str, str, tuple of int)
        Source, column and row of what was changed; of an exchange either row may be named, of a column none.
    several : bool
        Whether each of the cells was changed.
    """

    kinds: frozenset[str]
    cells: frozenset[tuple[str, str, tuple[int, ...]]]
    several: bool = False

    @property
    def count(self) -> int:
        """How many changes it is."""
        return len(self.cells) if self.several else 1

    def said_by(self, found: Explanation) -> bool:
        """Whether an explanation is what was done."""
        named = {(change.source, change.cell, change.index) for change in found.changes}
        kinds = {change.kind for change in found.changes}
        right = named == self.cells if self.several else len(named) == 1 and named <= self.cells
        return right and kinds <= self.kinds


@dataclass(frozen=True)
class Habits:
    """How an author prints and computes.

    Parameters
    ----------
    digits : mapping of str to int
        Significant digits of each column.
    even : bool
        Whether all rows of a column have as many decimals, those of its middle row.
    fit : bool
        Whether the exponent and the coefficient of the fit are printed.
    mean_of_printed : bool
        Whether the mean is taken of the exponents as they are printed.
    curve_of_printed : bool
        Whether Table 3 is computed with the exponent and the coefficient as they are printed.
    beta, points : float
        What is not said.
    """

    digits: Mapping[str, int]
    even: bool = True
    fit: bool = False
    mean_of_printed: bool = False
    curve_of_printed: bool = False
    beta: float = 1.5
    points: int = POINTS


@dataclass(frozen=True)
class Truth:
    """What was measured, and what follows."""

    measured: dict[str, list[float]]
    mass: float
    values: Values


@dataclass(frozen=True)
class Campaign:
    """A printed campaign."""

    measured: dict[str, list[Printed]]
    published: list[PublishedValue]
    mass: Printed
    habits: Habits
    truth: Truth = field(repr=False)
    forgery: Forgery | None = None
    given: frozenset[str] = frozenset({"ball_mass"})
    beta: str = "1.5"

    def refereed(self) -> Referee:
        """What the referee says of it."""
        sheet, tests = program().sheet, tuple(range(1, len(self.measured["v"]) + 1))
        data = {
            "beta": float(self.beta),
            "points_per_pair": float(POINTS),
            "ball_mass": float(self.mass.value),
        }
        data |= {name: [float(p.value) for p in column] for name, column in self.measured.items()}
        data = uncertain(data)
        values = engine.evaluate(sheet, {"tests": tests}, data, program())
        inputs = Inputs(
            Path(), "", WORKBOOK,
            {
                "ball_mass": self.mass,
                "beta": Printed(self.beta, "1", Fraction(self.beta), ONE),
                "points_per_pair": Printed(str(POINTS), "1", Fraction(POINTS), ONE),
            },
            self.given,
            (Measurements(tests, {name: tuple(column) for name, column in self.measured.items()}, {}),),
            tuple(self.published), {},
            {} if self.habits.fit else dict.fromkeys(("alpha_log", "C_log"), Location("")),
        )  # fmt: skip
        return referee(sheet, inputs, values, data, silent, lambda: numbers_of(sheet, WORKBOOK.ledger()))


@cache
def program() -> Program:
    """The program of the sheet that all campaigns share."""
    return Program.of(WORKBOOK.sheet(frozenset({"ball_mass"})))


@cache
def curve() -> Program:
    """The same with the exponent and the coefficient of the fit given."""
    sheet = program().sheet
    given = ("alpha_log", "C_log")
    return Program.of(Sheet(tuple(replace(c, rule=Given()) if c.name in given else c for c in sheet.columns)))


# --- how numbers are printed ------------------------------------------------------------------------------


def printed(value: float, unit: str, scale: Fraction, decimals: int, mode: str = "rounded") -> Printed:
    """A value as it is printed. That it was truncated is not said in print."""
    power = 0
    if decimals < 0 or abs(value / float(scale)) >= 1e6:
        power = floor(log10(abs(value / float(scale))))
    digits = "0." + "0" * (decimals + power) if decimals + power else "0"
    like = Printed(digits, unit, Fraction(0), scale * 10**power, mode)
    text = print_as(value, like) + (f"e{power}" if power else "")
    return Printed(text, unit, Fraction(text) * scale, scale)


def column(values: Sequence[float], name: str, habits: Habits, mode: str = "rounded") -> list[Printed]:
    """The values of a column as they are printed."""
    unit, scale = UNITS.get(name, ("1", ONE))

    def places(value: float) -> int:
        return habits.digits[name] - 1 - floor(log10(abs(value / float(scale))))

    same = places(median(values))
    return [printed(x, unit, scale, same if habits.even else places(x), mode) for x in values]


def reprinted(of: Printed, units: int) -> Printed:
    """A number that is so many units of its last digit more."""
    mantissa, _, power = of.text.partition("e")
    places = len(mantissa.partition(".")[2])
    text = f"{Decimal(mantissa) + Decimal(units).scaleb(-places):.{places}f}" + (f"e{power}" if power else "")
    return respelt(of, text)


def respelt(of: Printed, text: str) -> Printed:
    """A number with other digits."""
    return replace(of, text=text, value=Fraction(text) * of.scale)


# --- campaigns that are as their authors made them --------------------------------------------------------


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


def _computed(rng: random.Random, number: int, habits: Habits) -> Truth:
    """A campaign of whose cells all have values, and sensible ones."""
    while True:
        measured, mass = _model(rng, number)
        data = {**measured, "beta": habits.beta, "points_per_pair": float(habits.points), "ball_mass": mass}
        values = engine.evaluate(program().sheet, {"tests": range(1, number + 1)}, uncertain(data), program())
        cells = [values.value[name] for _, name in (*TABLES, *FIT)]
        if all((cell == cell).all() for cell in cells) and cells[0].min() > 0.5 and cells[0].max() < 3:
            return Truth(measured, mass, values)


def habits_of(rng: random.Random, least: int, **more: Any) -> Habits:
    """How an author prints: about as many digits everywhere, of 2 to 6."""
    middle = rng.randint(least, 6)
    columns = ["v", "e", "x_p", "ball_mass", *(name for _, name in (*TABLES, *FIT))]
    digits = {name: min(6, max(least, middle + rng.choice([-1, 0, 0, 1]))) for name in columns}
    return Habits(digits, **{"even": rng.random() < 0.7, "fit": rng.random() < 0.5, **more})


def honest(rng: random.Random, number: int = 0, least: int = 2, truncated: str = "", **more: Any) -> Campaign:
    """Computed from what was measured, then all of it printed; of three to eight tests unless it is said."""
    habits = habits_of(rng, least, **more)
    truth = _computed(rng, number or rng.randint(3, 8), habits)
    return _printed(truth, habits, truncated)


def _printed(truth: Truth, habits: Habits, truncated: str = "") -> Campaign:
    measured = {
        name: column(values, name, habits, "truncated" if name == truncated else "rounded")
        for name, values in truth.measured.items()
    }
    (mass,) = column([truth.mass], "ball_mass", habits)
    cells = {name: truth.values.value[name].tolist() for _, name in (*TABLES, *FIT)}
    if habits.mean_of_printed:
        exponents = column(cells["alpha"], "alpha", habits)
        cells["alpha_mean"] = [float(sum(p.value for p in exponents) / len(exponents))]
    if habits.curve_of_printed:
        given = {name: [float(column(cells[name], name, habits)[0].value)] for _, name in FIT}
        data = {
            **truth.measured,
            "beta": habits.beta,
            "points_per_pair": POINTS,
            "ball_mass": truth.mass,
            **given,
        }
        tests = range(1, len(truth.measured["v"]) + 1)
        again = engine.evaluate(curve().sheet, {"tests": tests}, uncertain(data), curve())
        cells |= {name: again.value[name].tolist() for source, name in TABLES if source == "Table 3"}
    values = truth.values
    published = [
        PublishedValue(source, name, index, each)
        for source, name in (*TABLES, *(FIT if habits.fit else ()))
        for index, each in zip(
            values.labels(values.sheet[name]), column(cells[name], name, habits), strict=True
        )
    ]
    return Campaign(measured, published, mass, habits, truth)


def mean_of_printed(rng: random.Random) -> Campaign:
    """The mean is that of the printed exponents."""
    return honest(rng, mean_of_printed=True)


def curve_of_printed(rng: random.Random) -> Campaign:
    """Table 3 is computed with the fit as it is printed."""
    return honest(rng, curve_of_printed=True, fit=True)


def all_of_printed(rng: random.Random) -> Campaign:
    """Both."""
    return honest(rng, mean_of_printed=True, curve_of_printed=True, fit=True)


def other_beta(rng: random.Random) -> Campaign:
    """Another exponent of the restitution law, which is not said."""
    return honest(rng, beta=rng.choice([1.2, 1.25, 1.3, 1.4, 1.6, 1.75, 2.0]))


def other_points(rng: random.Random) -> Campaign:
    """Another number of generated points, which is not said."""
    return honest(rng, points=rng.choice([5, 10, 15, 25, 30, 40, 50, 100]), fit=True)


HONEST: tuple[Callable[[random.Random], Campaign], ...] = (
    honest,
    mean_of_printed,
    curve_of_printed,
    all_of_printed,
    other_beta,
    other_points,
)


# --- forgeries --------------------------------------------------------------------------------------------

LEAST = 3
"""Digits of a forged paper."""


def _of(kinds: str, *cells: tuple[str, str, tuple[int, ...]]) -> Forgery:
    return Forgery(frozenset(kinds.split()), frozenset(cells))


def _slipped(rng: random.Random, of: Printed) -> Printed:
    """Another number with as many decimals: one digit is another, two have changed places, or neither."""
    mantissa, e, power = of.text.partition("e")
    places = [n for n, character in enumerate(mantissa) if character.isdigit()]
    significant = places[next(n for n, p in enumerate(places) if mantissa[p] != "0") :]
    while True:
        digits = list(mantissa)
        kind = rng.random()
        if kind < 0.5:
            digits[rng.choice(significant)] = rng.choice("0123456789")
        elif kind < 0.8 and len(significant) > 1:
            n = rng.randrange(len(significant) - 1)
            one, other = significant[n : n + 2]
            digits[one], digits[other] = digits[other], digits[one]
        else:
            return reprinted(of, rng.choice([-1, 1]) * rng.choice([2, 3, 5, 10, 20, 100]))
        text = "".join(digits) + e + power
        if Fraction(text) != Fraction(of.text) and Fraction(text):
            return respelt(of, text)


def _sensible(name: str, of: Printed) -> bool:
    return 0 < of.value < (1 if name == "e" else 100)


def _with_input(campaign: Campaign, name: str, row: int, cell: Printed) -> Campaign:
    column = list(campaign.measured[name])
    column[row] = cell
    return replace(campaign, measured={**campaign.measured, name: column})


def _with_published(campaign: Campaign, cells: Mapping[int, Printed]) -> Campaign:
    published = [
        replace(value, printed=cells.get(n, value.printed)) for n, value in enumerate(campaign.published)
    ]
    return replace(campaign, published=published)


def misprinted_input(rng: random.Random) -> Campaign:
    """One measured cell is another number."""
    campaign = honest(rng, least=LEAST)
    while True:
        name, row = rng.choice(sorted(campaign.measured)), rng.randrange(len(campaign.measured["v"]))
        was = campaign.measured[name][row]
        cell = _slipped(rng, was)
        if _sensible(name, cell):
            forged = _with_input(campaign, name, row, cell)
            return replace(forged, forgery=_of("misprint unit", (INPUT, name, (row + 1,))))


def misprinted_table(rng: random.Random) -> Campaign:
    """One published cell is another number."""
    campaign = honest(rng, least=LEAST)
    row = rng.randrange(len(campaign.published))
    value = campaign.published[row]
    forged = _with_published(campaign, {row: _slipped(rng, value.printed)})
    return replace(forged, forgery=_of("misprint unit rows", (value.source, value.cell, value.index)))


def _two(rng: random.Random, texts: Sequence[str]) -> tuple[int, int] | None:
    pairs = [(n, m) for n in range(len(texts)) for m in range(n) if texts[n] != texts[m]]
    return rng.choice(pairs) if pairs else None


def exchanged_table(rng: random.Random) -> Campaign:
    """Two rows of a table stand in each other's place."""
    while True:
        campaign = honest(rng, least=LEAST)
        source, cell = rng.choice(TABLES[:4])
        rows = [n for n, value in enumerate(campaign.published) if value.cell == cell]
        two = _two(rng, [campaign.published[n].printed.text for n in rows])
        if two is None:
            continue
        n, m = (rows[k] for k in two)
        one, other = campaign.published[n], campaign.published[m]
        forged = _with_published(campaign, {n: other.printed, m: one.printed})
        cells = ((source, cell, each.index) for each in (one, other))
        return replace(forged, forgery=_of("label", *cells))


def exchanged_input(rng: random.Random) -> Campaign:
    """Two measured cells of a column stand in each other's place."""
    while True:
        campaign = honest(rng, least=LEAST)
        name = rng.choice(sorted(campaign.measured))
        column = campaign.measured[name]
        two = _two(rng, [each.text for each in column])
        if two is None:
            continue
        n, m = two
        forged = _with_input(_with_input(campaign, name, n, column[m]), name, m, column[n])
        return replace(forged, forgery=_of("label", *((INPUT, name, (k + 1,)) for k in two)))


def truncated(rng: random.Random) -> Campaign:
    """A measured column was cut off and not rounded."""
    name = rng.choice(["v", "e", "x_p"])
    campaign = honest(rng, least=LEAST, truncated=name)
    return replace(campaign, forgery=_of("truncated", (INPUT, name, ())))


def wrong_unit(rng: random.Random) -> Campaign:
    """A cell, a column, a parameter or a row of a table is off by a power of ten."""
    campaign = honest(rng, least=LEAST)
    power = Fraction(10) ** rng.choice([-3, -3, -2, -1, 1, 2, 3, 3])
    kind = rng.randrange(4)
    if kind == 0:
        name, row = rng.choice(sorted(campaign.measured)), rng.randrange(len(campaign.measured["v"]))
        forged = _with_input(campaign, name, row, _scaled(campaign.measured[name][row], power))
        if not _sensible(name, forged.measured[name][row]):
            return wrong_unit(rng)
        return replace(forged, forgery=_of("unit", (INPUT, name, (row + 1,))))
    if kind == 1:
        name = rng.choice(sorted(campaign.measured))
        column = [_scaled(each, power) for each in campaign.measured[name]]
        if not all(_sensible(name, each) for each in column):
            return wrong_unit(rng)
        forged = replace(campaign, measured={**campaign.measured, name: column})
        return replace(forged, forgery=_of("unit", (INPUT, name, ())))
    if kind == 2:
        forged = replace(campaign, mass=_scaled(campaign.mass, power))
        return replace(forged, forgery=_of("unit", (INPUT, "ball_mass", ())))
    source, cell = rng.choice(TABLES[1:4])
    cells = {
        n: _scaled(value.printed, power)
        for n, value in enumerate(campaign.published) if value.cell == cell
    }  # fmt: skip
    return replace(_with_published(campaign, cells), forgery=_of("unit", (source, cell, ())))


def _scaled(of: Printed, power: Fraction) -> Printed:
    """The same digits in a unit that is larger."""
    return replace(of, value=of.value * power, scale=of.scale * power)


def wrong_rows(rng: random.Random) -> Campaign:
    """A mean without a row, with a row twice, or without all rows of a test."""
    campaign = honest(rng, least=LEAST)
    exponents = [(v.index, x) for v, x in zip(
        (v for v in campaign.published if v.cell == "alpha"), campaign.truth.values.value["alpha"].tolist(),
        strict=True,
    )]  # fmt: skip
    kind, row = rng.randrange(3), rng.randrange(len(exponents))
    test = rng.randint(1, len(campaign.measured["v"]))
    rows = {
        0: [x for n, (_, x) in enumerate(exponents) if n != row],
        1: [x for _, x in exponents] + [exponents[row][1]],
        2: [x for index, x in exponents if test not in index],
    }[kind]
    place = next(n for n, value in enumerate(campaign.published) if value.cell == "alpha_mean")
    (mean,) = column([sum(rows) / len(rows)], "alpha_mean", campaign.habits)
    forged = _with_published(campaign, {place: mean})
    return replace(forged, forgery=_of("rows", ("text", "alpha_mean", ())))


def wrong_beta(rng: random.Random) -> Campaign:
    """The exponent of the restitution law is stated, and was another."""
    campaign = honest(rng, least=LEAST, beta=rng.choice([1.2, 1.3, 1.4, 1.6, 2.0]))
    given = frozenset({"ball_mass", "beta"})
    return replace(campaign, given=given, forgery=_of("parameter", (INPUT, "beta", ())))


def two_misprints(rng: random.Random) -> Campaign:
    """Two cells, measured or published, are other numbers."""
    campaign = honest(rng, least=LEAST)
    cells: set[tuple[str, str, tuple[int, ...]]] = set()
    while len(cells) < 2:
        if rng.random() < 0.5:
            row = rng.randrange(len(campaign.published))
            value = campaign.published[row]
            key = value.source, value.cell, value.index
            if key not in cells:
                campaign = _with_published(campaign, {row: _slipped(rng, value.printed)})
        else:
            name, row = rng.choice(sorted(campaign.measured)), rng.randrange(len(campaign.measured["v"]))
            key, cell = (INPUT, name, (row + 1,)), _slipped(rng, campaign.measured[name][row])
            if not _sensible(name, cell):
                continue
            if key not in cells:
                campaign = _with_input(campaign, name, row, cell)
        cells.add(key)
    kinds = frozenset({"misprint", "unit", "rows"})
    return replace(campaign, forgery=Forgery(kinds, frozenset(cells), several=True))


FORGERS: tuple[Callable[[random.Random], Campaign], ...] = (
    misprinted_input,
    misprinted_table,
    exchanged_table,
    exchanged_input,
    truncated,
    wrong_unit,
    wrong_rows,
    wrong_beta,
    two_misprints,
)


def accused(seed: int, number: int) -> str:
    """What is wrongly said of one of the honest campaigns of a seed."""
    maker = HONEST[number % len(HONEST)]
    found = maker(random.Random(f"{maker.__name__} {seed} {number}")).refereed()
    assert found.joint is not None
    if found.joint.possible or (found.explanations and found.explanations[0].count == 0):
        return ""
    said = [*map(words.explained, found.explanations), *map(words.relabelled, found.labels)]
    return "; ".join([maker.__name__, str(number), found.joint.verdict, *said])


FIRST = "first"
UNSEEN = {"reachable", "explained by less"}
"""What is said of a forgery that its digits do not show: nobody could name it."""


def judged(kind: int, seed: int, number: int) -> str:
    """Whether a forgery was named, and in which place; or that its digits do not show it."""
    maker = FORGERS[kind]
    campaign = maker(random.Random(f"{maker.__name__} {seed} {number}"))
    found, forgery = campaign.refereed(), campaign.forgery
    assert forgery is not None
    assert found.joint is not None
    if found.joint.possible:
        return "reachable"
    if found.explanations and found.explanations[0].count < forgery.count:
        return "explained by less"
    named = [forgery.said_by(each) for each in found.explanations]
    if any(named):
        place = named.index(True)
        return f"{maker.__name__} {number} named in place {place + 1}" if place else FIRST
    return f"missed {maker.__name__}, number {number} of seed {seed}: {forgery}"
