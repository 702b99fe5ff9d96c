"""Exponentials, logarithms and powers: right to the last bits, and the same bits on every processor."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest
from processors import lesser

from loopsheet.report.engines import elementary, intervals
from loopsheet.report.engines.intervals import Intervals

NUMBER = 1000
ULPS = 2.0
"""What the module promises."""


def between(low: float, high: float, rng: np.random.Generator) -> Any:
    return rng.uniform(low, high, NUMBER)


def magnitudes(low: float, high: float, rng: np.random.Generator) -> Any:
    return 10.0 ** rng.uniform(low, high, NUMBER)


CASES: dict[str, tuple[str, Callable[[np.random.Generator], tuple[Any, ...]]]] = {
    "exp near 0": ("exp", lambda rng: (between(-1e-3, 1e-3, rng),)),
    "exp": ("exp", lambda rng: (between(-5, 5, rng),)),
    "exp of all doubles": ("exp", lambda rng: (between(-708, 709, rng),)),
    "log near 1": ("log", lambda rng: (between(0.999, 1.001, rng),)),
    "log": ("log", lambda rng: (between(0.1, 10, rng),)),
    "log of all doubles": ("log", lambda rng: (magnitudes(-307, 308, rng),)),
    "log of the smallest": ("log", lambda rng: (5e-324 * np.round(magnitudes(0, 15, rng)),)),
    "power": ("power", lambda rng: (between(0.1, 10, rng), between(-3, 3, rng))),
    "power near 1": ("power", lambda rng: (between(0.99, 1.01, rng), between(-5000, 5000, rng))),
    "power of imprints": ("power", lambda rng: (magnitudes(-6, -4, rng), between(1, 2, rng))),
    "power to the ends": ("power", lambda rng: (magnitudes(-20, 20, rng), between(-15, 15, rng))),
    "whole power of a negative": ("power", lambda rng: (between(-9, -1, rng), np.rint(between(-9, 9, rng)))),
}


@pytest.mark.parametrize("case", CASES)
def test_as_exact_as_promised(case: str) -> None:
    name, draw = CASES[case]
    given = draw(np.random.default_rng(7))
    found = getattr(elementary, name)(*given)
    with mpmath.workdps(50):
        of = {"exp": mpmath.exp, "log": mpmath.log, "power": mpmath.power}[name]
        for cell, *at in zip(found.tolist(), *(each.tolist() for each in given), strict=True):
            true = of(*map(mpmath.mpf, at))
            assert abs(cell - true) <= ULPS * float(np.spacing(abs(float(true)))), at


@pytest.mark.parametrize("name", ["exp", "log"])
@pytest.mark.parametrize("width", [0.0, 1e-12, 1e-4, 0.01, 0.03, 2.0])
def test_neighbours_are_as_exact_as_promised(name: str, width: float) -> None:
    rng = np.random.default_rng(7)
    given = rng.uniform(0.02, 3, 10) * (1 + width * rng.uniform(-0.5, 0.5, (100, 10)))
    found = getattr(elementary, f"{name}_beside")(given)
    with mpmath.workdps(50):
        of = {"exp": mpmath.exp, "log": mpmath.log}[name]
        for cell, at in zip(found.reshape(-1).tolist(), given.reshape(-1).tolist(), strict=True):
            true = of(mpmath.mpf(at))
            assert abs(cell - true) <= ULPS * float(np.spacing(abs(float(true)))), at


@pytest.mark.parametrize("name", ["exp", "log"])
def test_what_has_no_near_neighbour_is_computed_by_itself(name: str) -> None:
    own, beside = (getattr(elementary, each) for each in (name, f"{name}_beside"))
    with np.errstate(all="ignore"):
        for given in (
            np.array([[1.0, 2.0], [np.nan, 2.0]]),
            np.array([[1.0], [5.0]]),
            np.array([1.0, 1.001]),
        ):
            np.testing.assert_array_equal(beside(given), own(given))


def test_the_constants_are_what_they_are_called() -> None:
    with mpmath.workdps(60):
        first, second = (mpmath.mpf(float(part)) for part in elementary._LN2)
        assert abs(first + second - mpmath.ln2) < mpmath.mpf(2) ** -97
        assert (first * 2**42) % 1 == 0, "42 bits"
        assert float(1 / mpmath.ln2) == elementary._PER_LN2
        coth = [mpmath.bernoulli(2 * k) / mpmath.factorial(2 * k) for k in range(1, 7)]
        assert tuple(map(float, coth)) == elementary._COTH
        inverse = [1 / mpmath.factorial(k) for k in range(len(elementary._PER_FACTORIALS))]
        assert tuple(map(float, inverse)) == elementary._PER_FACTORIALS


SPECIAL = np.array([0.0, -0.0, 1.0, -1.0, 2.0, -2.5, 0.5, np.inf, -np.inf, np.nan, 5e-324, 1e308, -1e-310])


@pytest.mark.parametrize("y", [0, 1, 2, 3, -1, 0.5, -0.5, np.inf, -np.inf, np.nan, 1e300, -1e300, 2.0**70])
def test_a_power_that_is_none_or_infinite_is_what_numpy_says(y: float) -> None:
    with np.errstate(all="ignore"):
        np.testing.assert_allclose(elementary.power(SPECIAL, y), np.power(SPECIAL, float(y)), rtol=1e-15)


@pytest.mark.parametrize("name", ["exp", "log"])
def test_what_is_none_or_infinite_is_what_numpy_says(name: str) -> None:
    with np.errstate(all="ignore"):
        for given in (SPECIAL, 800 * SPECIAL):
            own, numpys = (getattr(module, name)(given) for module in (elementary, np))
            np.testing.assert_allclose(own, numpys, rtol=1e-15)


def test_rows_and_scalars_go_together() -> None:
    x, y = np.array([[1.5], [2.0]]), np.array([1.0, 2.0, 3.0])
    assert elementary.power(x, y).shape == (2, 3)
    assert elementary.exp(0) == 1 == elementary.power(2.5, 0)
    assert elementary.log(1.0) == 0


def test_intervals_enclose_them() -> None:
    """What has an arithmetic of its own does it by that; its ends allow for twice as much."""
    x = Intervals([1.5], [2.5])
    assert elementary.exp(x).low[0] < elementary.exp(1.5) < elementary.exp(x).high[0]
    assert elementary.power(x, 1.3).low[0] < elementary.power(1.5, 1.3)
    assert intervals.WIDER >= ULPS * 2.0**-52


BITS = """
import hashlib, numpy as np
from loopsheet.report.engines import elementary
from loopsheet.report.engines import numpy as engine
from loopsheet.report.inputs.folders import PAPER
from loopsheet.report.machine.provenance import processor
from loopsheet.report.study import Study
rng = np.random.default_rng(3)
x, y = rng.uniform(.01, 9, 20_000), rng.uniform(-9, 9, 20_000)
for module in (elementary, np):
    found = (module.exp(y), module.log(x), module.power(x, y))
    print(hashlib.sha256(b"".join(each.tobytes() for each in found)).hexdigest())
paper = Study(PAPER).prepared
values = engine.evaluate(paper.sheet, paper.labels, paper.data).value
near = 1 + x[:10] * (1 + y.reshape(-1, 10) / 1000)
found = [each.tobytes() for each in (elementary.exp_beside(near), elementary.log_beside(near))]
found += [values[name].tobytes() for name in sorted(values)]
print(hashlib.sha256(b"".join(found)).hexdigest())
print(processor())
"""
"""What NumPy is told to compute, what it would by itself, and what it makes of the shipped paper."""


def test_another_processor_computes_the_same_bits() -> None:
    def bits(more: dict[str, str]) -> list[str]:
        command, environment = [sys.executable, "-c", BITS], {**os.environ, **more}
        return subprocess.run(
            command, env=environment, capture_output=True, text=True, check=True
        ).stdout.splitlines()

    (own, numpys, paper, processor), (again, other, paper_again, lesser_one) = bits({}), bits(lesser())
    assert own == again == PINNED
    assert paper == paper_again
    if not lesser()["NPY_DISABLE_CPU_FEATURES"]:
        pytest.skip(f"NumPy uses nothing of {processor} that could be left out")
    # Of doubles, NumPy takes exponentials of its own only with AVX-512; with less there is one kind of bits.
    differ = numpys != other or "X86_V4" not in processor.split()
    assert differ, "NumPy's own differ, or this test would show nothing"
    assert processor.startswith(f"{lesser_one} ")


PINNED = "87571969aeaa3459545a5a3d8840bc8fd72198e34e70a3f0d7bef49ca340967d"
"""What every processor computes."""
