"""Outputs that are older than what they were built from: the report's own, and those that it takes from."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from .files.manifest import manifest_of
from .inputs.folders import PAPER, changed, is_report, output
from .messages.diagnostics import Check
from .messages.errors import listing

if TYPE_CHECKING:
    from pathlib import Path

    from .inputs.inputs import Inputs

__all__ = ["outdated"]


def outdated(inputs: Inputs) -> Iterator[Check]:
    """A warning for each of them.

    Of an output without a manifest, or without a report folder above it, nobody can tell.
    """
    folder = inputs.folder
    others = {(folder / one.file).parent.parent for one in inputs.taken.values()} - {folder}
    for each in [*sorted(others), *([folder] if folder != PAPER else [])]:
        if is_report(each) and (names := _changed(each)):
            after = listing(names, last="and")
            said = f"{output(each).as_posix()} is older than what it was built from, {after}"
            so = " and so are the numbers that are taken from it" if each in others else ""
            at, told = inputs.place, f"{said}{so and ',' + so}: build it again"
            yield Check("outputs", each.as_posix(), True, told, at, note="warning")


def _changed(folder: Path) -> list[str]:
    """The inputs of a report folder that are not as they were when it was built."""
    manifest = manifest_of(output(folder))
    return sorted(changed(folder, manifest.inputs)) if manifest else []
