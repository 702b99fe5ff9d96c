"""The benchmarks can be run: what they call is there, and what they compare computes the same."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from loopsheet.report.inputs.folders import PAPER

FOLDER = Path(__file__).resolve().parent.parent / "benchmarks"


@pytest.fixture(scope="module")
def bench() -> Iterator[Callable[[str], ModuleType]]:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(FOLDER))
        yield importlib.import_module
    for path in FOLDER.glob("*.py"):
        sys.modules.pop(path.stem, None)


@pytest.mark.parametrize("name", sorted(path.stem for path in FOLDER.glob("bench_*.py")))
def test_each_begins(name: str, bench: Callable[[str], ModuleType]) -> None:
    assert bench(name).__doc__


def test_all_ways_to_a_root_find_the_same(
    bench: Callable[[str], ModuleType], require: Callable[..., str], tmp_path: Path
) -> None:
    require("gcc", "cc")
    engine, kernel = bench("bench_engine"), bench("kernel")
    data = engine.pairs(2000)
    in_c = kernel.built(engine.RULE, list(engine.PLAIN.values()), tmp_path)
    expected = engine.generated(data)
    assert np.isfinite(expected).all()
    for way in (in_c, engine.lambdified(2, 4, True, 1 << 13)):
        assert (
            np.abs(way(data) / expected - 1).max() < 1e-8
        )  # nothing is checked but that it is the same root


def test_without_a_compiler_there_is_no_kernel(
    bench: Callable[[str], ModuleType], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    engine = bench("bench_engine")
    assert bench("kernel").built(engine.RULE, list(engine.PLAIN.values()), tmp_path) is None


def test_the_page_that_is_measured_is_the_one_that_is_built(
    bench: Callable[[str], ModuleType], tmp_path: Path
) -> None:
    page = bench("bench_page").page(PAPER, tmp_path / "page.html").read_text()
    assert page.count("data-cell") > 100


def test_all_ways_to_draw_tell_the_same(bench: Callable[[str], ModuleType]) -> None:
    measured = bench("bench_monte_carlo")
    alone, *told = (way() for way in measured.ways(20_000).values())
    assert alone.shape == (20_000, 15)
    for other in told:
        assert other.number == 20_000
        assert other.symmetric == pytest.approx(told[0].symmetric, rel=1e-12)


def test_what_draws_take_is_told_part_by_part(bench: Callable[[str], ModuleType]) -> None:
    measured = bench("bench_monte_carlo")
    parts = measured.spent(measured.ways(20_000)[measured.ALL])
    assert parts.keys() == {*measured.PARTS, measured.ALL}
    whole = parts.pop(measured.ALL)
    assert 0 < sum(parts.values()) <= whole


def test_every_command_that_is_measured_is_one(bench: Callable[[str], ModuleType], tmp_path: Path) -> None:
    measured = bench("bench_build")
    assert measured.answers(tmp_path)["--help"]() > 0
    assert measured.answers(tmp_path)["show"]() > 0
    assert {"build --no-cache", "build, a number edited"} <= set(measured.builds(tmp_path))
