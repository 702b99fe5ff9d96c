"""The charts of the soft-impact paper's data: figure 4, exponents of pairs, the band of the common curve."""

from __future__ import annotations

from ..charts import BLUE, VERMILION, Chart, Series

__all__ = ["BAND", "EXPONENTS", "LOOPS"]

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
BAND = Chart(
    "force beside the common curve",
    "approach x",
    "force beside the common curve",
    (
        *(
            Series("band_x", f"{side}_{name}", label, colour=colour)
            for name, label, colour in (
                ("further_u", "two standard deviations of a further test", BLUE),
                ("band_u", "two standard uncertainties of the curve", VERMILION),
            )
            for side in ("above", "below")
        ),
        Series("x_m_eiv", "beside", "%s", "points", named=True),
    ),
)
"""One power law leaves most of the tests within the outer band."""
