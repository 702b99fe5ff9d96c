"""What the referee found as data that JSON can hold, so that it is kept from run to run.

What is printed is told by its number among all that the inputs print: it has its text, places and laws there.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from itertools import chain
from typing import Any

import numpy as np

from ..inputs.inputs import Inputs
from ..inputs.published import PublishedValue
from ..quantity import Printed
from ..result import verdict
from ..result.verdict import Referee

__all__ = ["as_data", "of_data"]


def as_data(found: Referee, inputs: Inputs) -> Any:
    """What was found of some inputs, as data."""
    numbers = {printed: number for number, printed in enumerate(_prints(inputs))}

    def told(part: Any) -> Any:
        if isinstance(part, Printed | PublishedValue):
            return {"": numbers[part]}
        if is_dataclass(part):
            return {type(part).__name__: [told(getattr(part, field.name)) for field in fields(part)]}
        if isinstance(part, Mapping):
            return {"Mapping": [[name, told(value)] for name, value in part.items()]}
        if isinstance(part, tuple):
            return [told(each) for each in part]
        return part.item() if isinstance(part, np.generic) else part

    return told(found)


def of_data(data: Any, inputs: Inputs) -> Referee:
    """What was found, from such data of the same inputs."""
    prints = tuple(_prints(inputs))

    def read(part: Any) -> Any:
        if isinstance(part, list):
            return tuple(map(read, part))
        if not isinstance(part, dict):
            return part
        ((kind, value),) = part.items()
        if kind == "":
            return prints[value]
        return dict(read(value)) if kind == "Mapping" else getattr(verdict, kind)(*read(value))

    found: Referee = read(data)
    return found


def _prints(inputs: Inputs) -> Iterator[Printed | PublishedValue]:
    """All that is printed and that a finding may name, in an order that the inputs give."""
    yield from inputs.published
    every = chain(*inputs.measured.values(), inputs.parameters.values(), inputs.errata.values())
    yield from (printed for printed in every if printed is not None)
