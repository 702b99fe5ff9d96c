"""loopsheet: measured columns and published equations in, a report that can be refereed out."""

__version__ = "0.1.0"

__all__ = ["Method", "count", "given", "let", "mean", "measured", "root", "total", "unknown"]


def __getattr__(name: str) -> object:
    """What declares a method, when it is asked for: it imports sympy."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from .report import method

    return getattr(method, name)
