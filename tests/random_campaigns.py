"""Campaigns, sound and absurd, drawn by hypothesis, and what NumPy, node and 50 digits make of one."""

from __future__ import annotations

import json
import math
import subprocess
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as seeded
from hypothesis import strategies as st
from hypothesis.internal.conjecture import providers
from hypothesis.internal.constants_ast import Constants
from numpy.typing import NDArray

from loopsheet.report.cells.layout import Layout, lay_out
from loopsheet.report.cells.marks import with_margins
from loopsheet.report.cells.values import CODES, Status
from loopsheet.report.engines import exact
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.javascript import RUNTIME
from loopsheet.report.engines.numpy import Program
from loopsheet.report.judge import bounds
from loopsheet.report.judge import engines as judging
from loopsheet.report.judge.engines import Judge
from loopsheet.report.judge.readers import Reading, of_values
from loopsheet.report.sheet import Sheet
from loopsheet.report.views import live
from loopsheet.report.workbooks.soft_impact import WORKBOOK

VARIANTS = (
    {"ball_mass": 0.008},
    {"ball_diameter": 0.0127, "ball_density": 7800.0, "target_mass": 3.0},
)
SHEETS = [with_margins(WORKBOOK.sheet(frozenset(parameters))) for parameters in VARIANTS]
"""With how far their cells are inside of what is expected, so that engines agree on marks too."""

# --- campaigns ---


@dataclass(frozen=True)
class Campaign:
    """Measurements and parameters for one variant of the sheet."""

    variant: int
    tests: list[int]
    data: dict[str, list[float]]

    @property
    def labels(self) -> dict[str, list[int]]:
        return {"tests": self.tests}


@st.composite
def campaigns(
    draw: st.DrawFn,
    size: int,
    variants: Sequence[int] = (0, 1),
    points: Sequence[int] = (2, 3, 5),
    most: int = 17,
) -> Campaign:
    """One campaign: from the model with some noise, or anything at all, then perhaps spoiled."""
    digits = draw(st.sampled_from((2, 3, most)))  # as few as people write, so that some are the same

    def each(low: float, high: float) -> list[float]:
        return draw(st.lists(st.floats(low, high), min_size=size, max_size=size))

    alpha, beta = draw(st.floats(1, 1.6)), draw(st.sampled_from((1.5, 1.0, 1.25, 2.0, 2.5)))
    v, e = sorted(each(0.5, 8)), sorted(each(0.05, 0.7), reverse=True)
    match draw(st.sampled_from(("falls", "falls", "falls", "falls", "rises", "as it likes"))):
        case "rises":
            e.reverse()
        case "as it likes":
            e = each(0.001, 1)
    noise = draw(st.sampled_from((0, 1e-3, 0.03)))
    depth = [max(1 - (beta + 1) / (alpha + 1) * x**2, 0.02) for x in e]
    x_p = [
        3e-5 * speed ** (2 / (alpha + 1)) * part * (1 + noise * off)
        for speed, part, off in zip(v, depth, each(-1, 1), strict=True)
    ]
    if draw(st.integers(0, 9)) == 9:
        x_p = [10**x for x in each(-5, -4)]
    v, e, x_p = ([float(f"{x:.{digits}g}") for x in column] for column in (v, e, x_p))
    row, other = draw(st.permutations(range(size)))[:2]
    exponent = [beta]
    match draw(st.integers(0, 16)):
        case 7:
            v[row] = v[other]
        case 8:
            e[row] = e[other]
        case 9:
            v[row], e[row], x_p[row] = v[other], e[other], x_p[other]
        case 10:
            e[row] = draw(st.sampled_from((0.0, 0.95, 1.0)))
        case 11:
            e[row] = e[other] = draw(st.sampled_from((0.0, 1.0)))
        case 12 | 13:
            column = draw(st.sampled_from((v, e, x_p, exponent)))
            column[row % len(column)] = math.nan
        case 14:
            for column in (v, e, x_p):
                column.reverse()
        case 15 | 16:  # an exponent of some hundreds: no double holds the coefficient
            deeper = draw(st.sampled_from((1.0003, 1.001, 1.003)))
            v[row], e[row], x_p[row] = 1.1 * v[other], e[other], deeper * x_p[other]
    variant = draw(st.sampled_from(variants))
    parameters = {name: [value * draw(st.floats(0.5, 2))] for name, value in VARIANTS[variant].items()}
    number = [float(draw(st.sampled_from(points if size < 8 else points[:2])))]
    # The rows that were left out leave gaps in the numbers of the others.
    tests = sorted(draw(st.permutations(range(1, 16)))[:size])
    data = {"v": v, "e": e, "x_p": x_p, "beta": exponent, **parameters, "points_per_pair": number}
    return Campaign(variant, tests, data | digits_of(variant, data))


NO_DATUM = (math.nan, math.inf, -math.inf)
PARAMETERS = tuple(sorted({name for each in VARIANTS for name in each}))
REFUSED = {
    "v": (0.0, -0.0, -2.5, -1e-9, -1e200, *NO_DATUM),
    "e": (-0.2, 1.2, 1.0001, 53.0, -1e-200, 1e200, *NO_DATUM),
    "x_p": (0.0, -3e-5, -1e-200, *NO_DATUM),
    "beta": (0.0, -0.0, -1.0, -1.5, -2.5, -1e100, *NO_DATUM),
    "points_per_pair": (0.0, 1.0, -2.0, 2.5, 10001.0, 1e300, *NO_DATUM),
    **dict.fromkeys(PARAMETERS, (0.0, -0.008, -1e100, *NO_DATUM)),
}
"""What no column of that name allows."""
MEASURED = ("v", "e", "x_p")
UNCERTAIN = tuple(f"u_{name}" for name in MEASURED)


def digits_of(variant: int, data: dict[str, list[float]]) -> dict[str, list[float]]:
    """The standard uncertainties of what is measured, by the last of a double's digits: as the page does."""

    def u(name: str, x: float) -> float:
        if not math.isfinite(x) or not SHEETS[variant].bounds[name].allow(x):
            return math.nan
        exponent = Decimal(repr(x)).as_tuple().exponent
        return float(f"1e{exponent}") * (1 / math.sqrt(12))

    return {f"u_{name}": [u(name, x) for x in data[name]] for name in MEASURED}


def _refused(draw: st.DrawFn, data: dict[str, list[float]]) -> None:
    """One to three data that are not allowed, a whole column of them, or all but one or two tests."""
    if draw(st.integers(0, 9)) == 9:
        name, kept = draw(st.sampled_from(MEASURED)), draw(st.sampled_from((1, 2)))
        data[name][kept:] = [math.nan] * len(data[name][kept:])
    for name in draw(st.lists(st.sampled_from(sorted(data)), min_size=1, max_size=3)):
        rows, every = range(len(data[name])), draw(st.integers(0, 7)) == 7
        for row in rows if every or not rows else [draw(st.sampled_from(rows))]:
            data[name][row] = draw(st.sampled_from(REFUSED[name]))


def _degenerate(draw: st.DrawFn, data: dict[str, list[float]]) -> None:
    """What is allowed and says little: all equal, the wrong way round, at a limit, of absurd size."""
    match draw(st.integers(0, 7)):
        case 0:
            for name in draw(st.sampled_from((("v",), ("e",), ("x_p",), ("v", "e"), MEASURED))):
                data[name][:] = [data[name][0]] * len(data[name])
        case 1:
            data["e"].sort()
            data["v"].sort()
        case 2:
            data["x_p"].sort(reverse=True)
            data["v"].sort()
        case 3:
            data["e"][:] = [draw(st.sampled_from((0.0, 1.0, 1e-9, 1 - 1e-9))) for _ in data["e"]]
        case 4:
            name, row = draw(st.sampled_from(("v", "x_p"))), draw(st.sampled_from(range(len(data["v"]))))
            data[name][row] *= 10.0 ** draw(st.sampled_from((-3, -1, 1, 3)))
        case 5 | 6:
            name = draw(st.sampled_from(("v", "x_p", *sorted(data.keys() & set(PARAMETERS)))))
            power = draw(st.sampled_from((-250, -120, -30, 30, 120, 250)))
            data[name][:] = [x * 10.0**power for x in data[name]]
        case 7:
            data["beta"] = [draw(st.sampled_from((1e-9, 0.01, 30.0, 1e4)))]


@st.composite
def spoiled(draw: st.DrawFn, size: int, **how: Any) -> Campaign:
    """One campaign with input that is refused, or that is allowed and says little; a single test does."""
    campaign = draw(campaigns(max(size, 2), **how))
    data = {name: list(column) for name, column in campaign.data.items() if name not in UNCERTAIN}
    for name in MEASURED:
        data[name] = data[name][:size]
    which = draw(st.sampled_from(("refused", "degenerate", "both")))
    if which != "refused" and size:
        _degenerate(draw, data)
    if which != "degenerate":
        _refused(draw, data)
    data |= digits_of(campaign.variant, data)
    return Campaign(campaign.variant, campaign.tests[:size], data)


KINDS = {"any": campaigns, "spoiled": spoiled}


def shares(size: int, number: int) -> dict[str, int]:
    """How many campaigns of each kind: half of all are spoiled, and whatever has but one test."""
    return {"spoiled": number} if size < 2 else {"any": number // 2, "spoiled": number - number // 2}


def for_each(
    strategy: st.SearchStrategy[Campaign], number: int, seed: int, check: Callable[[Campaign], None]
) -> None:
    """Check so many campaigns of a seed, which says all of them; make one that fails as simple as can be."""

    @seeded(seed)
    @settings(
        max_examples=number,
        database=None,
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
        phases=[Phase.generate, Phase.shrink],
    )
    @given(strategy)
    def one(campaign: Campaign) -> None:
        check(campaign)

    with pytest.MonkeyPatch.context() as patch:
        # Otherwise the constants in the package's source would say too what is drawn.
        patch.setattr(providers, "_get_local_constants", Constants)
        one()


def drawn(strategy: st.SearchStrategy[Campaign], number: int, seed: int) -> list[Campaign]:
    """So many different campaigns of a seed."""
    found: dict[str, Campaign] = {}

    def keep(campaign: Campaign) -> None:
        found.setdefault(repr(campaign), campaign)

    asked = number
    while len(found) < number:  # hypothesis likes to repeat itself, and wants the same answer then
        for_each(strategy, asked, seed, keep)
        asked *= 2
    return list(found.values())[:number]


# --- what the engines find ---


NO_NUMBERS = ("", "fast", "29.7 um", "2,94", "1e", "NaN", "#N/A", "true")
"""What may be typed where there is no datum."""


def texts(column: Sequence[float]) -> list[str]:
    """What somebody types into the page for these data, in SI."""
    return [
        repr(x) if math.isfinite(x) else NO_NUMBERS[place % len(NO_NUMBERS)] for place, x in enumerate(column)
    ]


def on_the_page(campaign: Campaign) -> tuple[dict[str, Any], dict[str, Any]]:
    """What the page knows of the given columns, and what somebody has typed into it."""
    sheet, typed = (
        SHEETS[campaign.variant],
        {name: texts(each) for name, each in campaign.data.items() if name not in UNCERTAIN},
    )
    bounds = {name: live.limits(own) for name, own in sheet.bounds.items()}
    given: dict[str, Any] = {
        name: {"given": {"scale": ["1", "1"], "bounds": bounds[name], "allowed": ""}} for name in bounds
    }
    given |= {f"u_{name}": {"of": name, "stated": {}} for name in MEASURED}
    tests = [
        {"label": label, "used": True, "cells": {name: typed[name][row] for name in MEASURED}}
        for row, label in enumerate(campaign.tests)
    ]
    parameters = {name: column[0] for name, column in typed.items() if name not in MEASURED}
    return given, {"tables": {"tests": tests}, "parameters": parameters}


class Node:
    """One process of node that has the programs of several sheets and answers a line for every campaign.

    It computes each twice: from numbers, as every engine does, and from texts, as the page does; both must be
    the same, bit by bit.
    """

    SCRIPT = """
    const differing = (one, other) => {
      const text = (columns, name) => String(Array.from(columns[name], (x) => x + 0));
      return Object.keys(one).filter((name) => text(one, name) !== text(other, name));
    };
    require("readline").createInterface({ input: process.stdin }).on("line", (line) => {
      const [which, labels, given, columns, state] = JSON.parse(line), data = {}, out = {};
      for (const name in given) data[name] = given[name].map(Number);
      try {
        const { value, status, broken } = evaluateSheet(programs[which], labels, data);
        const page = computeSheet(programs[which], columns, state);
        for (const name in value) out[name] = [Array.from(value[name]), Array.from(status[name])];
        const differ = [...differing(status, page.status), ...differing(value, page.value)];
        console.log(JSON.stringify([out, broken, differ.length ? `the page differs in ${differ}` : ""]));
      } catch (error) {
        console.log(JSON.stringify([{}, {}, String(error)]));
      }
    });
    """

    def __init__(self, path: str, folder: Path, programs: Sequence[str]) -> None:
        script = folder / "random.js"
        page = [RUNTIME.parents[1] / "live" / name for name in ("numbers.js", "inputs.js")]
        own = "\n".join(each.read_text(encoding="utf-8") for each in (RUNTIME, *page))
        script.write_text(f"{own}\nconst programs = [{', '.join(programs)}];\n{self.SCRIPT}", "utf-8")
        self.process = subprocess.Popen(
            [path, str(script)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, encoding="utf-8"
        )

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.communicate()

    def read(self, campaign: Campaign, which: int) -> tuple[Reading, Broken]:
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        numbers = {
            name: [repr(x).replace("inf", "Infinity") for x in column]
            for name, column in campaign.data.items()
        }
        line = json.dumps([which, campaign.labels, numbers, *on_the_page(campaign)])
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()
        columns, broken, failure = json.loads(self.process.stdout.readline())
        value = {name: found for name, (found, _) in columns.items()}
        status = {name: [CODES[Status(code)] for code in codes] for name, (_, codes) in columns.items()}
        return Reading("JavaScript", "node", value, status, failure=failure), {
            (name, int(row)): which for name, rows in broken.items() for row, which in rows.items()
        }


Broken = Mapping[tuple[str, int], int]
"""Which condition of its column a cell breaks."""


def numpy_reads(campaign: Campaign, program: Program) -> tuple[Reading, Broken]:
    values = engine.evaluate(SHEETS[campaign.variant], campaign.labels, campaign.data, program)
    rows = {name: np.flatnonzero(which).tolist() for name, which in values.broken.items()}
    broken = {(name, row): int(values.broken[name][row]) for name in rows for row in rows[name]}
    return of_values(values), broken


def laid_out(campaign: Campaign) -> dict[str, Layout]:
    sheet, points = SHEETS[campaign.variant], campaign.data["points_per_pair"][0]
    allowed = sheet.bounds["points_per_pair"].allow(points)
    return lay_out(sheet, campaign.labels, {"points_per_pair": int(points) if allowed else 0})


def judge_of(campaign: Campaign) -> Judge:
    return Judge.of(SHEETS[campaign.variant], laid_out(campaign), campaign.labels, campaign.data)


@contextmanager
def printed_once() -> Iterator[None]:
    """The programs of a sheet are the same for all campaigns, and take longer to print than to run."""

    def once(make: Callable[..., Any]) -> Callable[..., Any]:
        known: dict[Any, tuple[Any, Any]] = {}

        def made(sheet: Any, *more: Any) -> Any:
            key = id(sheet), *more
            if key not in known:
                known[key] = sheet, make(sheet, *more)
            return known[key][1]

        return made

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Program, "of", once(Program.of))
        patch.setattr(bounds.SheetDerivatives, "of", once(bounds.SheetDerivatives.of))
        patch.setattr(exact, "_texts", once(exact._texts))
        patch.setattr(judging, "RoundingBounds", known_bounds())
        yield


def known_bounds() -> Callable[..., Any]:
    """What rounding may do to the same cells, found once: all data that are refused leave the same."""
    known: dict[Any, bounds.RoundingBounds] = {}

    def found(sheet: Sheet, layouts: Mapping[str, Layout], value: Mapping[str, NDArray[np.float64]]) -> Any:
        sizes = tuple(sorted((name, layout.size) for name, layout in layouts.items()))
        key = id(sheet), sizes, *((name, column.tobytes()) for name, column in value.items())
        if key not in known:
            known[key] = bounds.RoundingBounds(sheet, layouts, value)
        return known[key]

    return found
