"""The charts of the soft-impact paper's data: figure 4, exponents of pairs, misfits of tests."""

from __future__ import annotations

from ..charts import BLUE, VERMILION, Chart, Series

__all__ = ["EXPONENTS", "LOOPS", "MISFITS"]

LOOPS = Chart(
    "generated points, fitted curve, hysteresis loops",
    "approach x",
    "force F",
    (
        Series("x", "F", "points of %s", "points", VERMILION),
        Series("unloading_x", "unloading_F", "restitution of %s", each=True),
        Series("loading_x", "loading_F", "compression fitted to them, alpha", value="alpha_log"),
    ),
    from_zero=True,
    height=10,
)
EXPONENTS = Chart(
    "exponent of every pair",
    "mean impact speed of the pair",
    "exponent alpha of the pair",
    (
        Series("mean_v", "alpha_mean", "mean", "level"),
        Series("mean_v", "alpha", "%s", "points", BLUE, named=True),
    ),
)
"""One power law for all speeds would scatter the pairs about a level. The mean speed is the one that a pair
speaks for: on the paper's data the exponents climb with it without exception."""
MISFITS = Chart(
    "misfit of each test",
    "impact speed of the test",
    "misfit in standard deviations",
    (Series("v", "z_eiv", "%s", "points", BLUE, named=True),),
)
