"""Standard uncertainties for made-up campaigns, which the fit to all tests asks for."""

from collections.abc import Mapping
from typing import Any

import numpy as np

__all__ = ["uncertain"]


def uncertain(data: Mapping[str, Any], part: float = 2.0**-11) -> dict[str, Any]:
    """The same data, each measured number known to a part of its size."""
    us = {name: part * np.abs(np.asarray(data[name], float)) for name in ("v", "e", "x_p")}
    alike = {name: u if isinstance(data[name], np.ndarray) else u.tolist() for name, u in us.items()}
    return {**data, **{f"u_{name}": u for name, u in alike.items()}}
