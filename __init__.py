"""loopsheet: measured columns and published equations in, a report that can be refereed out."""

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # which imports much
    from .report.loaded import load
    from .report.messages.errors import LoopsheetError
    from .report.method.words import *

__version__ = "0.1.0"

__all__ = [
    "LoopsheetError",
    "Method",
    "by",
    "claim",
    "constant",
    "count",
    "derivative",
    "drawing",
    "expected",
    "fit",
    "given",
    "groups",
    "let",
    "load",
    "mean",
    "measured",
    "median",
    "numbered",
    "pairs",
    "plot",
    "points",
    "required",
    "root",
    "rows",
    "sketch",
    "standing",
    "stdev",
    "table",
    "total",
    "trace",
    "uncertainty",
    "unknown",
]


def __getattr__(name: str) -> object:
    """What declares a method, what loads a report and what that raises, once asked for: it imports much."""
    if name not in __all__:
        said = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(said, name=name, obj=sys.modules[__name__])
    if name == "load":
        from .report.loaded import load

        return load
    if name == "LoopsheetError":
        from .report.messages.errors import LoopsheetError

        return LoopsheetError
    from .report.method import words

    return getattr(words, name)


def __dir__() -> list[str]:
    """What there is, asked for already or not."""
    return sorted({*globals(), *__all__})
