"""Printed functions of NumPy arrays: what runs of a text that was printed now or before."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import ModuleType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from . import elementary

Array = NDArray[np.float64]
Function = Callable[..., tuple[Array, ...]]


SAME: Any = ModuleType("numpy")
vars(SAME).update(vars(np), exp=elementary.exp, log=elementary.log, power=elementary.power)
"""NumPy, but its functions whose last bits hang on the processor are our own: what printed functions call, if
they are not told to call NumPy itself, which is faster."""


def _choose(condition: Any, yes: Callable[[], Any], no: Callable[[], Any]) -> Any:
    """One thing where a condition holds and another elsewhere; what no row asks for is not computed."""
    if isinstance(condition, np.ndarray) and (condition.all() or not condition.any()):
        found = yes() if condition.all() else no()
        batch = np.ndim(found) < condition.ndim > 1
        return (
            np.broadcast_to(found, np.broadcast_shapes(np.shape(found), condition.shape)) if batch else found
        )
    return np.where(condition, yes(), no())


def compiled(source: str, functions: Any) -> Any:
    """The function that a text is of."""
    return function_of(source, {"numpy": functions, "choose": _choose})


def function_of(source: str, names: Mapping[str, Any]) -> Any:
    """The function that a text is of, in which names stand for something."""
    namespace = dict(names)
    # Printed from our own expressions, never foreign text.
    exec(compile(source, "<generated>", "exec"), namespace)
    return namespace[source[len("def ") : source.index("(")]]


@dataclass(frozen=True)
class Kernel:
    """One printed function."""

    arguments: tuple[str, ...]
    """What it is called with, in order."""
    totals: tuple[str, ...]
    """The axes it takes something over: after its arguments, it is called with what does that for each, a
    :class:`~loopsheet.report.engines.numpy_rows.Kept`."""
    source: str
    """Its text."""
    functions: Any = field(default=SAME, repr=False)
    """What it calls: :data:`SAME`, or NumPy."""

    @cached_property
    def run(self) -> Function:
        """The function itself; it returns one array for each expression."""
        function: Function = compiled(self.source, self.functions)
        return function

    @property
    def plain(self) -> dict[str, Any]:
        """What it is, as data."""
        return {"arguments": self.arguments, "totals": self.totals, "source": self.source}

    @classmethod
    def of_plain(cls, plain: Mapping[str, Any], functions: Any = SAME) -> Self:
        """That of such data."""
        return cls(tuple(plain["arguments"]), tuple(plain["totals"]), plain["source"], functions)


@dataclass(frozen=True)
class Enclosing(Kernel):
    """What intervals are put into."""

    reach: Kernel | None = None
    """What the exponents are at most, for the largest sizes of all that they name, where the unknown stands
    in nothing but sums of exponentials over one axis: each of their terms rises, or falls, with it."""

    @property
    def plain(self) -> dict[str, Any]:
        """What it is, as data."""
        return {**super().plain, "reach": self.reach and self.reach.plain}

    @classmethod
    def of_plain(cls, plain: Mapping[str, Any], functions: Any = SAME) -> Self:
        """That of such data."""
        reach = plain["reach"] and Kernel.of_plain(plain["reach"])
        return replace(super().of_plain(plain, functions), reach=reach)
