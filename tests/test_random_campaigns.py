"""What is drawn at random is the same again, though tests run in two processes in whatever order."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_campaigns import campaigns, drawn


def seeded() -> str:
    return repr(drawn(campaigns(3), 100, seed=1))


def derandomized() -> str:
    """What hypothesis draws by itself, as it does in continuous integration."""
    found: list[float] = []

    @settings(derandomize=True, database=None)
    @given(st.floats(0.5, 8))
    def take(x: float) -> None:
        found.append(x)

    take()
    return repr(found)


@pytest.mark.parametrize("draw", [seeded, derandomized])
def test_the_same_is_drawn_whatever_is_loaded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, draw: Callable[[], str]
) -> None:
    before = draw()
    name = f"constants_for_{draw.__name__}"
    (tmp_path / f"{name}.py").write_text(f"MORE = {[n / (60 + len(name)) for n in range(64, 512)]}")
    monkeypatch.syspath_prepend(tmp_path)
    import_module(name)
    assert draw() == before


def test_another_seed_draws_others() -> None:
    one, other = (repr(drawn(campaigns(3), 10, seed)) for seed in (1, 2))
    assert one != other
