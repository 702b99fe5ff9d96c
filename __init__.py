"""loopsheet: measured columns and published equations in, a report that can be refereed out."""

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
    "table",
    "total",
    "trace",
    "uncertainty",
    "unknown",
]


def __getattr__(name: str) -> object:
    """What declares a method, what loads a report and what that raises, once asked for: it imports much."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
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
