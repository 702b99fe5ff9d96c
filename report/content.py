"""What things say, as a text: two that say the same are the same to everything that is made of them."""

from __future__ import annotations

import sys
from dataclasses import fields, is_dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sympy import Basic

_OURS = {"sympy", __name__.partition(".")[0]}


class Untold(Exception):
    """Something of a class of somebody else's: what it does follows from no text that is known here."""


def content(part: Any) -> str:
    """Everything that a part is made of, assumptions included.

    Raises
    ------
    Untold
        Some of it is of a class that is neither sympy's nor loopsheet's.

    Examples
    --------
    >>> from sympy import Symbol
    >>> content((Symbol("x", positive=True) + 1, 2.0))
    "(Add(Integer(1), Symbol('x', positive=True)), 2.0)"
    """
    kind = type(part)
    sympy = sys.modules.get("sympy")  # without it, nothing is of it
    if sympy is not None and isinstance(part, sympy.Basic):
        if (kind.__module__ or "").partition(".")[0] not in _OURS:
            raise Untold
        return f"{kind.__name__}({', '.join(map(content, part.args))})" if part.args else _leaf(part)
    if isinstance(part, tuple):
        return f"({', '.join(map(content, part))})"
    if is_dataclass(part):
        if kind.__module__.partition(".")[0] not in _OURS:
            raise Untold
        own = ", ".join(content(getattr(part, field.name)) for field in fields(part))
        return f"{kind.__name__}({own})"
    return repr(part)


@lru_cache(maxsize=4096, typed=True)
def _leaf(part: Basic) -> str:
    from sympy import srepr

    return str(srepr(part))
