"""What is odd about numbers that were taken from other reports: where their uncertainties may not hold."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ..messages.diagnostics import Check

if TYPE_CHECKING:
    from ..inputs.inputs import Inputs

TAKEN = "taken"
"""The kind of these checks."""


def checks(inputs: Inputs) -> Iterator[Check]:
    """Check each parameter and column that was taken."""
    for name, taken in inputs.taken.items():
        said, note = f"{name}: what is known of its uncertainty came from {taken.file} with it", ""
        if taken.doubts:
            first, *others = taken.doubts
            more = f", and so of {len(others)} more" * bool(others)
            said, note = f"{name} is taken from {taken.file}, where of {first}{more}", "warning"
        yield Check(TAKEN, name, True, said, inputs.place, note=note)
