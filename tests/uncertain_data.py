"""Standard uncertainties for made-up campaigns, which the fit asks for; and what its misfits lose."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from loopsheet.report.cells.values import Values

__all__ = ["MISFITS", "lost_to_differences", "uncertain"]


def uncertain(data: Mapping[str, Any], part: float = 2.0**-11) -> dict[str, Any]:
    """The same data, each measured number known to a part of its size."""
    us = {name: part * np.abs(np.asarray(data[name], float)) for name in ("v", "e", "x_p")}
    alike = {name: u if isinstance(data[name], np.ndarray) else u.tolist() for name, u in us.items()}
    return {**data, **{f"u_{name}": u for name, u in alike.items()}}


MISFITS = {
    *("R_eiv", "lambda_eiv", "z_eiv", "chi2_eiv", "birge_eiv", "u_birge_eiv", "alpha_without"),
    *("trend_eiv", "dchi2_trend", "beside"),
}
"""What is made of differences of two depths that are nearly the same."""


def lost_to_differences(values: Values) -> float:
    """How many times less than a depth the difference of two is: so much of its precision is gone."""
    if "R_eiv" not in values.value or not np.isfinite(values.value["R_eiv"]).any():
        return 1.0
    depth, misfit = (np.nanmax(np.abs(values.value[name])) for name in ("x_p", "R_eiv"))
    return float(depth / max(misfit, 1e-300))


POLES = """from loopsheet import Method, given, let, mean, measured


class Poles(Method, headline="apart level by_b"):
    V = measured("V", "of both polarities")
    b = given("V", "another")
    level = let(mean(V), "mean")
    apart = let(max(V) - min(V), "range")
    by_b = let(level / b, "by another")
"""
"""Of which all share a gain."""
