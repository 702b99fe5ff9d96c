"""Thousands of campaigns, sound and absurd, through the JavaScript, NumPy and exact engines.

Campaigns of one shape are one batch of the NumPy engine, and all of them one process of node. Every cell must
have the same status in every engine. Values may differ by 8 eps times the condition of the cell: how far it
moves, per unit of eps, when every cell of the sheet before it is rounded up or down at random.
"""

from __future__ import annotations

import json
import re
import subprocess
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray

from loopsheet.report.engines import exact, javascript
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.javascript import RUNTIME
from loopsheet.report.engines.numpy import Program
from loopsheet.report.layout import lay_out
from loopsheet.report.sheet import Column, Reference, Sheet, name_of
from loopsheet.report.values import Status, Values
from loopsheet.report.workbooks.soft_impact import WORKBOOK

EPS = float(np.finfo(float).eps)
Array = NDArray[np.float64]
EACH = 36
"""Campaigns of each shape; there are 66 shapes."""

VARIANTS = (
    {"ball_mass": 0.008},
    {"ball_diameter": 0.0127, "ball_density": 7800.0, "target_mass": 3.0},
)

RUN = """
const lines = require("fs").readFileSync(0, "utf8").trim().split("\\n");
for (const line of lines) {
  const [which, tests, data] = JSON.parse(line, (key, value) => (value === "missing" ? NaN : value));
  const { value, status, broken } = evaluateSheet(programs[which], { tests }, data);
  const out = {};
  for (const name in value) out[name] = [Array.from(value[name]), Array.from(status[name])];
  console.log(JSON.stringify([out, broken]));
}
"""

# --- campaigns ---


@dataclass(frozen=True)
class Batch:
    """Campaigns of one shape, for one variant of the sheet."""

    which: int
    sheet: Sheet
    program: Program
    labels: list[int]
    data: Mapping[str, Array]

    @property
    def count(self) -> int:
        return len(self.data["v"])

    def campaign(self, number: int) -> dict[str, list[float]]:
        return {
            name: (values[number] if values.ndim == 2 else values).tolist()
            for name, values in self.data.items()
        }

    @cached_property
    def values(self) -> Values:
        return engine.evaluate(self.sheet, {"tests": self.labels}, self.data, self.program)

    def of(self, column: Column) -> tuple[Array, NDArray[np.uint8]]:
        """Values and codes of all campaigns (campaigns, rows)."""
        value, status = self.values.value[column.name], self.values.status[column.name]
        shape = (self.count, value.shape[-1])
        return np.broadcast_to(value, shape), np.broadcast_to(status, shape)

    @cached_property
    def nearby(self) -> Values:
        """What a few roundings make of the campaigns: where they decide, engines may decide otherwise."""
        return self.rounded(8 * EPS, 64, together=True)

    def decides(self, column: Column, number: int, row: int, code: int) -> bool:
        """Whether roundings can give a cell this code."""
        codes = self.nearby.status[column.name]
        many = np.broadcast_to(codes, (64, self.count, codes.shape[-1]))
        return bool((many[:, number, row] == code).any())

    def rounded(self, by: float, draws: int, together: bool) -> Values:
        """All campaigns, with every cell moved up or down by a share of itself; draws come first."""
        counts = {"points_per_pair": int(self.data["points_per_pair"][0])}
        layouts = lay_out(self.sheet, {"tests": self.labels}, counts)
        return _Rounded(self, layouts, by, draws, together).values()

    @cached_property
    def condition(self) -> dict[str, Array]:
        """The condition of every cell, absolute; infinite where a small step leaves its domain."""
        step, draws = 2.0**-42, 12
        moved = [self.rounded(step, draws, together) for together in (True, False)]
        # What makes equal tests different may make them another case: there it says nothing about this one.
        another = np.zeros((draws, self.count), dtype=bool)
        for column in self.sheet.order:
            another |= (moved[1].status[column.name] != self.of(column)[1]).any(axis=-1)
        found = {}
        for column in self.sheet.order:
            value, _ = self.of(column)
            with np.errstate(over="ignore"):
                ways = [np.abs(each.value[column.name] - value) / step for each in moved]
            ways = [np.broadcast_to(way, (draws, *value.shape)) for way in ways]
            by = np.maximum(ways[0].max(axis=0), np.where(another[:, :, None], 0, ways[1]).max(axis=0))
            if column.positive:
                by[by * step > np.abs(value) / 8] = np.inf
            found[column.name] = np.where(np.isnan(by), np.inf, np.maximum(by, np.abs(value)))
        return found


class _Rounded(engine._Run):
    """Moves a cell by a share of itself, up or down at random, whenever a rule reads it.

    Equal data may move together: that two tests have the same speed is no accident of rounding.
    """

    def __init__(self, batch: Batch, layouts: Any, by: float, draws: int, together: bool) -> None:
        super().__init__(batch.program, layouts, batch.data)
        self.by, self.draws, self.count, self.together = by, draws, batch.count, together
        self.rng = np.random.default_rng(7)
        self.equal: dict[tuple[str, str], tuple[Array, Array]] = {}

    def _argument(self, reference: Reference, column: Column, kept: Any) -> Array:
        value, name = super()._argument(reference, column, kept), name_of(reference.cell)
        if reference.cell in self.sheet.sizes:
            return value
        if self.together and name in self.data:
            if (column.name, name) not in self.equal:
                each = np.unique(self.value[name])
                self.equal[column.name, name] = each, self._signs(each.size)
            each, signs = self.equal[column.name, name]
            return value * (1 + self.by * signs[:, np.searchsorted(each, np.atleast_2d(value))])
        return value * (1 + self.by * self._signs(self.count, value.shape[-1]))

    def _signs(self, *shape: int) -> Array:
        return self.rng.choice([-1.0, 1.0], (self.draws, *shape))


def campaign(rng: np.random.Generator, size: int) -> dict[str, Any]:
    """One campaign: from the model with some noise, or anything at all, then perhaps spoiled."""
    alpha, beta = rng.uniform(1, 1.6), float(rng.choice([1.0, 1.25, 1.5, 2.0, 2.5]))
    v, e = np.sort(rng.uniform(0.5, 8, size)), np.sort(rng.uniform(0.05, 0.7, size))[::-1]
    if rng.random() < 0.2:
        e = (
            e[::-1] if rng.random() < 0.5 else rng.uniform(0, 1, size)
        )  # e rises with the speed, or as it likes
    depth = np.maximum(1 - (beta + 1) / (alpha + 1) * e**2, 0.02)
    x_p = (
        3e-5 * v ** (2 / (alpha + 1)) * depth * (1 + rng.choice([0, 1e-3, 0.03]) * rng.standard_normal(size))
    )
    if rng.random() < 0.2:
        x_p = 10 ** rng.uniform(-5, -4, size)
    v, e, x_p = v.copy(), e.copy(), x_p.copy()
    if rng.random() < 0.3:  # as few digits as people write, so that some are the same
        v, e, x_p = np.round(v, 1), np.round(e, 2), np.round(x_p, 6)
    row, other = rng.choice(size, 2, replace=False)
    match rng.integers(12):
        case 0:
            v[row] = v[other]
        case 1:
            e[row] = e[other]
        case 2:
            v[row], e[row], x_p[row] = v[other], e[other], x_p[other]
        case 3:
            e[row] = rng.choice([0.0, 0.95, 1.0])
        case 4:
            e[row] = e[other] = rng.choice([0.0, 1.0])
        case 5:
            (v, e, x_p)[rng.integers(3)][row] = np.nan
        case 6:
            v, e, x_p = v[::-1], e[::-1], x_p[::-1]
    return {"v": v, "e": e, "x_p": x_p, "beta": [beta if rng.random() > 0.02 else np.nan]}


@pytest.fixture(scope="module")
def batches() -> list[Batch]:
    rng = np.random.default_rng(2024)
    found = []
    for which, parameters in enumerate(VARIANTS):
        sheet = WORKBOOK.sheet(frozenset(parameters))
        program = Program.of(sheet)
        for size in range(2, 13):
            for points in (2, 3, 5):
                many = [campaign(rng, size) for _ in range(EACH)]
                data = {name: np.array([one[name] for one in many], dtype=float) for name in many[0]}
                for name, value in parameters.items():
                    data[name] = value * rng.uniform(0.5, 2, (EACH, 1))
                data["points_per_pair"] = np.array([float(points)])
                # The rows that were left out leave gaps in the numbers of the others.
                labels = np.sort(rng.choice(np.arange(1, 16), size, replace=False)).tolist()
                found.append(Batch(which, sheet, program, labels, data))
    return found


# --- in node ---


def in_node(node: str, folder: Path, programs: list[str], batches: list[Batch]) -> list[list[Any]]:
    """What the JavaScript engine finds: for each batch and campaign the columns and broken conditions."""
    script = folder / "random.js"
    runtime = RUNTIME.read_text(encoding="utf-8")
    script.write_text(f"{runtime}\nconst programs = [{', '.join(programs)}];\n{RUN}", encoding="utf-8")
    lines = [
        json.dumps([batch.which, batch.labels, batch.campaign(number)]).replace("NaN", '"missing"')
        for batch in batches
        for number in range(batch.count)
    ]
    done = subprocess.run(
        [node, str(script)], input="\n".join(lines), capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    answers = iter(done.stdout.splitlines())
    return [[json.loads(next(answers)) for _ in range(batch.count)] for batch in batches]


@pytest.fixture(scope="module")
def node(
    require: Callable[..., str], batches: list[Batch], tmp_path_factory: pytest.TempPathFactory
) -> list[list[Any]]:
    programs = [javascript.program(WORKBOOK.sheet(frozenset(given))) for given in VARIANTS]
    return in_node(require("node"), tmp_path_factory.mktemp("random"), programs, batches)


def differences(batch: Batch, answers: list[Any]) -> tuple[Counter[str], int]:
    """How often the answers differ from NumPy's, by column: in a code, or by more than 8 eps x condition.

    Where roundings decide about a cell, what rests on it is left aside; also returns in how many campaigns.
    """
    found: Counter[str] = Counter()
    aside = np.zeros(batch.count, dtype=bool)
    for column in batch.sheet.order:
        value, status = batch.of(column)
        theirs = np.array([answer[0][column.name][0] for answer in answers], dtype=float).reshape(value.shape)
        codes = np.array([answer[0][column.name][1] for answer in answers]).reshape(value.shape)
        for number, row in np.argwhere((codes != status) & ~aside[:, None]).tolist():
            if batch.decides(column, number, row, codes[number, row]):
                aside[number] = True
            else:
                found[f"{column.name}: status"] += 1
        off = ~(np.abs(theirs - value) <= 8 * EPS * batch.condition[column.name])
        off &= ~(np.isnan(theirs) & np.isnan(value)) & ~aside[:, None]
        found[f"{column.name}: value"] += int(off.sum())
    return +found, int(aside.sum())


# --- the tests ---


def test_javascript_finds_what_numpy_finds_in_thousands_of_campaigns(
    batches: list[Batch], node: list[list[Any]]
) -> None:
    assert sum(batch.count for batch in batches) >= 2000
    seen: Counter[Status] = Counter()
    cells = unbounded = undecided = 0
    for batch, answers in zip(batches, node, strict=True):
        found, aside = differences(batch, answers)
        assert not found, (found, batch.labels)
        undecided += aside
        for column in batch.sheet.order:
            value, status = batch.of(column)
            seen.update(Status(code) for code in status.ravel().tolist())
            unbounded += int((np.isinf(batch.condition[column.name]) & ~np.isnan(value)).sum())
            cells += value.size
    assert set(seen) == set(Status)
    assert min(seen.values()) > 1000
    assert unbounded < cells / 1000
    assert undecided <= 3


def test_broken_conditions_are_the_same(batches: list[Batch], node: list[list[Any]]) -> None:
    total = 0
    for batch, answers in zip(batches, node, strict=True):
        for name, codes in batch.values.broken.items():
            ours = np.broadcast_to(codes, (batch.count, batch.values.value[name].shape[-1]))
            theirs = np.zeros_like(ours)
            for number, (_, broken) in enumerate(answers):
                for row, which in broken.get(name, {}).items():
                    theirs[number, int(row)] = which
            for number, row in np.argwhere(ours != theirs).tolist():
                near = np.broadcast_to(batch.nearby.broken[name], (64, *ours.shape))[:, number, row]
                assert (near == theirs[number, row]).any(), (name, row, batch.campaign(number))
            total += np.count_nonzero(theirs)
    assert total > 1000


def test_fifty_digits_agree_on_hundreds_of_campaigns(batches: list[Batch], node: list[list[Any]]) -> None:
    """Statuses are those of 50 digits, unless roundings decide or no double holds what 50 digits find."""
    small = [n for n, batch in enumerate(batches) if batch.values.layouts["points"].size <= 9]
    judged, aside = 0, 0
    for n in small:
        batch = batches[n]
        for number in range(24):
            data = batch.campaign(number)
            truth = exact.evaluate(batch.sheet, {"tests": batch.labels}, data)
            judged += 1
            for column in batch.sheet.order:
                name, codes = column.name, np.array(truth.status[column.name])
                value, status = (each[number] for each in batch.of(column))
                theirs, theirs_codes = node[n][number][0][name]
                both = [(row, code) for found in (status, theirs_codes) for row, code in enumerate(found)]
                differ = [(row, code) for row, code in both if code != codes[row]]
                for row, code in differ:
                    true = truth.value[name][row]
                    held = true is None or 1e-300 < abs(true) < 1e300
                    assert not held or batch.decides(column, number, row, codes[row]), (name, row, code, data)
                if differ:
                    aside += 1
                    break
                for row in np.flatnonzero(codes == Status.OK).tolist():
                    bound = 8 * EPS * batch.condition[name][number, row]
                    with mpmath.workdps(exact.DIGITS):
                        for found in (value[row], theirs[row]):
                            error = abs(truth.value[name][row] - mpmath.mpf(found))
                            assert error <= bound, (name, row, error, bound, data)
    assert judged >= 200
    assert aside <= judged / 20


# --- changes to the program are caught ---

FLIPPED = {**dict(zip("+-*/<>", "-+/*><", strict=True)), **dict(zip("0123456789", "1234567890", strict=True))}

SPOT = re.compile(r"(?<= )[-+<>](?= )|(?<=[\w)\]])[*/](?=[\w($])|(?<![\w$.])\d(?![\d\]])")
"""Operators and short numbers; no names and no numbers of rows."""

SEARCH = re.compile(r"    (ends|at|step): (.|\n)*?(?=\n    \w+: )")
"""What guides a search decides on statuses; a wrong step is slower, but what it settles on is right."""


def mutants(text: str, each: int) -> list[tuple[str, str]]:
    """Programs with one operator or digit of one column changed, so many for every column."""
    rng = np.random.default_rng(1)
    found = []
    for column in re.finditer(r'"name": "(\w+)", "axis".*"kernels": ((?:.|\n)*?\n  )}', text):
        own = column.span(2)
        skipped = [m.span() for m in SEARCH.finditer(text, *own)]
        # How many sums a pass has room for does not change them.
        skipped += [m.span() for m in re.finditer(r"total\(.*", text[: own[1]])]
        spots = [m.start() for m in SPOT.finditer(text, *own)]
        spots = [spot for spot in spots if not any(start <= spot < end for start, end in skipped)]
        for spot in rng.permutation(spots)[:each].tolist():
            line = text[text.rfind("\n", 0, spot) + 1 : text.find("\n", spot)].strip()
            changed = text[:spot] + FLIPPED[text[spot]] + text[spot + 1 :]
            found.append((f"{column[1]}: {text[spot]} in {line}", changed))
    return found


def test_a_character_changed_in_the_program_is_caught(
    require: Callable[..., str], batches: list[Batch], tmp_path: Path
) -> None:
    (batch,) = (
        b for b in batches if b.which == 1 and len(b.labels) == 6 and b.data["points_per_pair"][0] == 3
    )
    changed = mutants(javascript.program(batch.sheet), each=4)
    names = {name.partition(":")[0] for name, _ in changed}
    without_operator = {"v", "e", "x_p", "beta", "points_per_pair", "x_top", *VARIANTS[1]}
    assert names == {column.name for column in batch.sheet.order} - without_operator
    programs = [program for _, program in changed]
    each = [replace(batch, which=n) for n in range(len(programs))]
    for (name, _), answers in zip(changed, in_node(require("node"), tmp_path, programs, each), strict=True):
        found, _ = differences(batch, answers)
        assert found, name
