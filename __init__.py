"""loopsheet: measured columns and published equations in, a report that can be refereed out."""

__version__ = "0.1.0"

__all__ = [
    "Method",
    "claim",
    "constant",
    "count",
    "fit",
    "given",
    "let",
    "load",
    "mean",
    "measured",
    "median",
    "pairs",
    "plot",
    "root",
    "table",
    "total",
    "unknown",
]


def __getattr__(name: str) -> object:
    """What declares a method, and what loads a report, when they are asked for: they import much."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if name == "load":
        from .report.loaded import load

        return load
    from .report import method

    return getattr(method, name)
