"""Campaigns, sound and absurd, drawn by hypothesis, and what NumPy, node and 50 digits make of one."""

from __future__ import annotations

import json
import math
import subprocess
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as seeded
from hypothesis import strategies as st
from hypothesis.internal.conjecture import providers
from hypothesis.internal.constants_ast import Constants

from loopsheet.report.analysis import bounds
from loopsheet.report.analysis.engines import Judge
from loopsheet.report.analysis.readers import Reading, of_values
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.javascript import RUNTIME
from loopsheet.report.engines.numpy import Program
from loopsheet.report.layout import Layout, lay_out
from loopsheet.report.marks import with_margins
from loopsheet.report.values import CODES, Status
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
def campaigns(draw: st.DrawFn, size: int, variants: Sequence[int] = (0, 1)) -> Campaign:
    """One campaign: from the model with some noise, or anything at all, then perhaps spoiled."""
    digits = draw(st.sampled_from((2, 3, 17)))  # as few as people write, so that some are the same

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
    points = [float(draw(st.sampled_from((2, 3, 5) if size < 8 else (2, 3))))]
    # The rows that were left out leave gaps in the numbers of the others.
    tests = sorted(draw(st.permutations(range(1, 16)))[:size])
    data = {"v": v, "e": e, "x_p": x_p, "beta": exponent, **parameters, "points_per_pair": points}
    return Campaign(variant, tests, data)


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
    """So many campaigns of a seed."""
    found: list[Campaign] = []
    for_each(strategy, number, seed, found.append)
    return found


# --- what the engines find ---


class Node:
    """One process of node that has the programs of several sheets and answers a line for every campaign."""

    SCRIPT = """
    require("readline").createInterface({ input: process.stdin }).on("line", (line) => {
      const [which, labels, data] = JSON.parse(line, (key, value) => (value === null ? NaN : value));
      try {
        const { value, status, broken } = evaluateSheet(programs[which], labels, data);
        const out = {};
        for (const name in value) out[name] = [Array.from(value[name]), Array.from(status[name])];
        console.log(JSON.stringify([out, broken, ""]));
      } catch (error) {
        console.log(JSON.stringify([{}, {}, String(error)]));
      }
    });
    """

    def __init__(self, path: str, folder: Path, programs: Sequence[str]) -> None:
        script = folder / "random.js"
        runtime = RUNTIME.read_text(encoding="utf-8")
        script.write_text(f"{runtime}\nconst programs = [{', '.join(programs)}];\n{self.SCRIPT}", "utf-8")
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
        line = json.dumps([which, campaign.labels, campaign.data])
        line = line.replace("NaN", "null").replace("Infinity", "1e999")
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
    counts = {"points_per_pair": int(campaign.data["points_per_pair"][0])}
    return lay_out(SHEETS[campaign.variant], campaign.labels, counts)


def judge_of(campaign: Campaign) -> Judge:
    return Judge.of(SHEETS[campaign.variant], laid_out(campaign), campaign.labels, campaign.data)


@contextmanager
def printed_once() -> Iterator[None]:
    """The programs of a sheet are the same for all campaigns, and take longer to print than to run."""

    def once(make: Callable[[Any], Any]) -> Callable[[Any], Any]:
        known: dict[int, tuple[Any, Any]] = {}

        def made(sheet: Any) -> Any:
            if id(sheet) not in known:
                known[id(sheet)] = sheet, make(sheet)
            return known[id(sheet)][1]

        return made

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Program, "of", once(Program.of))
        patch.setattr(bounds, "conditions", once(bounds.conditions))
        yield
