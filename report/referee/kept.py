"""What the referee found as data that JSON can hold, so that it is kept from run to run.

What is published is told by its number among all that is: it has its text and place in the inputs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from ..inputs.inputs import Inputs
from ..inputs.published import PublishedValue
from ..result import verdict
from ..result.verdict import Referee


def as_data(found: Referee, inputs: Inputs) -> Any:
    """What was found of some inputs, as data."""
    numbers = {published: number for number, published in enumerate(inputs.published)}

    def told(part: Any) -> Any:
        if isinstance(part, PublishedValue):
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

    def read(part: Any) -> Any:
        if isinstance(part, list):
            return tuple(map(read, part))
        if not isinstance(part, dict):
            return part
        ((kind, value),) = part.items()
        if kind == "":
            return inputs.published[value]
        return dict(read(value)) if kind == "Mapping" else getattr(verdict, kind)(*read(value))

    found: Referee = read(data)
    return found
