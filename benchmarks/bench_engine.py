"""Nanoseconds a root: the generated solver against SymPy's lambdify of the same steps, and whole sheets.

One process, one thread; variants are shuffled in every round, so that a slow moment hits all of them, and
medians are printed with ratios. Nothing here is a test.
"""

from __future__ import annotations

import random
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import kernel
import numpy as np
from sympy import Symbol, lambdify

from loopsheet.derivations import soft_impact as model
from loopsheet.derivations.alpha_root import ISOLATED
from loopsheet.derivations.soft_impact import XP, E, V
from loopsheet.report.column import Root
from loopsheet.report.engines import numpy as engine
from loopsheet.report.engines.numpy import Program
from loopsheet.report.engines.roots import derivatives, householder
from loopsheet.report.method.places import Standing
from loopsheet.report.workbooks.soft_impact import sheet as soft_impact

ROUNDS = 7
SHEET = soft_impact(frozenset({"ball_mass"}))
PROGRAM = Program.of(SHEET)
FAST = Program.of(SHEET, functions=np)
"""With NumPy's own functions, whose last bits hang on the processor: for draws by the million."""
NAMES = ("beta", "v1", "v2", "e1", "e2", "xp1", "xp2")
PLAIN = {
    cell: Symbol(name, positive=True)
    for cell, name in zip((model.beta, V[1], V[2], E[1], E[2], XP[1], XP[2]), NAMES, strict=True)
}
RULE = Root(model.eq11, **{name: Standing([PLAIN]).put(part) for name, part in ISOLATED.items()})
OWN = "generated: decided, bracketed, checked"
NEWTON = "lambdify(cse=True), four Newton steps, 8k blocks"
C = "C, four Newton steps"


def pairs(count: int, seed: int = 1) -> dict[str, Any]:
    """Pairs like the paper's: e falls with the speed, alpha between 1 and 1.5."""
    rng = np.random.default_rng(seed)
    alpha = rng.uniform(1, 1.5, count)
    v = np.sort(rng.uniform(1, 6, (count, 2)), axis=1)
    e = 0.58 - 0.025 * v
    x_p = 1e-5 * v ** (2 / (alpha + 1))[:, None] * (1 - 2.5 / (alpha + 1)[:, None] * e**2)
    return {"v": v, "e": e, "x_p": x_p}


def columns(data: dict[str, Any]) -> list[Any]:
    """The arguments of a lambdified function."""
    return [1.5, *(data[name][:, side] for name in ("v", "e", "x_p") for side in (0, 1))]


def lambdified(order: int, steps: int, shared: bool, block: int) -> Callable[[dict[str, Any]], Any]:
    """Steps from the same starting value, as lambdify writes them; no bracket, no feasibility, no check."""
    f, u = RULE.expression, RULE.unknown
    every = derivatives(f, u)
    step = householder(*every) if order == 4 else every[0] / every[1]
    arguments = [PLAIN[cell] for cell in PLAIN]
    start = lambdify(arguments, RULE.start, "numpy", cse=shared)
    move = lambdify([u, *arguments], step, "numpy", cse=shared)

    def solve(data: dict[str, Any]) -> Any:
        beta, *rest = columns(data)
        out = np.empty(len(rest[0]))
        for begin in range(0, len(out), block):
            part = [beta, *(column[begin : begin + block] for column in rest)]
            here = start(*part)
            for _ in range(steps):
                here = here - move(here, *part)
            out[begin : begin + block] = 1 / here - 1
        return out

    return solve


def generated(data: dict[str, Any], program: Program = FAST) -> Any:
    """The engine's solver: feasibility, bracket, steps and check, from arrays of pairs."""
    root = program.roots["alpha"]
    named = dict(zip(("beta", "v_i", "v_j", "e_i", "e_j", "x_p_i", "x_p_j"), columns(data), strict=True))
    count = len(data["v"])
    out = np.empty(count)
    with np.errstate(all="ignore"):
        for begin in range(0, count, engine.BLOCK):
            part = slice(begin, min(begin + engine.BLOCK, count))
            cells = {n: a[part] if isinstance(a, np.ndarray) else np.array([a]) for n, a in named.items()}
            out[part] = root.solve(cells, {}, (part.stop - part.start,)).value
    return out


def medians(variants: dict[str, Callable[[], Any]]) -> dict[str, float]:
    """Median seconds of each variant, shuffled in every round; the first round only warms up."""
    found: dict[str, list[float]] = {name: [] for name in variants}
    order = list(variants)
    shuffle = random.Random(1)
    for round_ in range(ROUNDS + 1):
        shuffle.shuffle(order)
        for name in order:
            begun = time.perf_counter()
            variants[name]()
            if round_:
                found[name].append(time.perf_counter() - begun)
    return {name: statistics.median(times) for name, times in found.items()}


def solvers(count: int, in_c: Callable[[dict[str, Any]], Any] | None) -> None:
    """Compare the ways to solve (11) for many pairs."""
    data = pairs(count)
    ways: dict[str, Callable[[dict[str, Any]], Any]] = {
        OWN: generated,
        "the same, the same bits on every processor": lambda data: generated(data, PROGRAM),
        "lambdify(cse=True), two order-4 steps, 8k blocks": lambdified(4, 2, True, 1 << 13),
        "lambdify(cse=True), four order-4 steps, 8k blocks": lambdified(4, 4, True, 1 << 13),
        NEWTON: lambdified(2, 4, True, 1 << 13),
        "lambdify, four Newton steps, 8k blocks": lambdified(2, 4, False, 1 << 13),
        "lambdify(cse=True), four order-4 steps, whole arrays": lambdified(4, 4, True, count),
    }
    if in_c is not None:
        ways[C] = in_c
    reference = generated(data)
    print(f"\n{count} pairs: ns a root, ratio to the generated one, largest difference")
    found = medians({name: (lambda way=way: way(data)) for name, way in ways.items()})  # type: ignore[misc]
    own = found[OWN]
    for name, seconds in found.items():
        apart = np.nanmax(abs(ways[name](data) / reference - 1))
        print(f"  {seconds / count * 1e9:8.1f}  {seconds / own:5.2f}  {apart:.0e}  {name}")
    for name in (NEWTON, C):
        if name in found:
            print(f"generated / {name}: {own / found[name]:.2f}")


def sheets() -> None:
    """Whole campaigns: all columns, and batches of the paper's size."""
    print("\nwhole sheets: ms, and ns a pair")
    for tests, points in ((5, 50), (40, 50), (200, 5), (200, 50)):
        v = np.linspace(1, 6, tests)
        e = 0.58 - 0.02 * v
        data = {"v": v, "e": e, "x_p": 2e-5 * v**0.87 * (1 - 1.09 * e**2)}
        _whole(f"{tests} tests, {points} points a pair", data, tests, points, 1, PROGRAM)
    rng = np.random.default_rng(2)
    for draws in (1000, 20_000):
        v = np.array([2.334, 2.940, 4.089, 4.504, 4.993]) * rng.normal(1, 1e-4, (draws, 5))
        e = np.array([0.530, 0.512, 0.479, 0.467, 0.453]) * rng.normal(1, 1e-4, (draws, 5))
        x_p = np.array([23.5, 29.7, 41.6, 45.97, 51.03]) * 1e-6 * rng.normal(1, 1e-4, (draws, 5))
        _whole(f"{draws} draws of 5 tests, 5 points", {"v": v, "e": e, "x_p": x_p}, 5, 5, draws, FAST)


def _whole(what: str, data: dict[str, Any], tests: int, points: int, draws: int, program: Program) -> None:
    given = {**data, "beta": 1.5, "ball_mass": 8.366e-3, "points_per_pair": points}
    labels = {"tests": range(1, tests + 1)}
    (seconds,) = medians({what: lambda: engine.evaluate(SHEET, labels, given, program)}).values()
    print(f"  {seconds * 1e3:9.2f}  {seconds / (draws * tests * (tests - 1) / 2) * 1e9:9.0f}  {what}")


def preparation() -> None:
    """What it takes before the first number: the sheet and its program."""
    given = frozenset({"ball_mass"})
    found = medians({"sheet": lambda: soft_impact(given), "program": lambda: Program.of(SHEET)})
    print("\npreparation, with SymPy's caches warm: ms")
    for name, seconds in found.items():
        print(f"  {seconds * 1e3:9.1f}  {name}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        in_c = kernel.built(RULE, list(PLAIN.values()), Path(folder))
        if in_c is None:
            print("no C compiler was found: there is no kernel to compare with")
        for size in (100_000, 1_000_000):
            solvers(size, in_c)
    sheets()
    preparation()
