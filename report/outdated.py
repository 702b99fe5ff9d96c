"""Outputs that are older than what they were built from: the report's own, and those that it takes from."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from .archive.crate import altered
from .files.manifest import NAME, manifest_of
from .inputs.folders import PAPER, changed, is_report, output
from .messages.diagnostics import Check
from .messages.errors import Location, listing
from .views import FORMATS


def outdated(folder: Path, files: Iterable[str]) -> Iterator[Check]:
    """A warning for each of them.

    Of an output without a manifest, or without a report folder above it, nobody can tell.

    `folder`: a report folder. `files`: the names of what it is read from.
    """
    yield from outdated_sources(folder, files)
    if folder != PAPER:
        yield from _older(folder, folder, "")
        yield from _touched(folder)


def outdated_sources(folder: Path, files: Iterable[str]) -> Iterator[Check]:
    """A warning for each report that is read from, and is older than what it was built from."""
    others = {(folder / name).parent for name in files}
    for each in sorted(out.parent for out in others if out.parent != folder and out == output(out.parent)):
        yield from _older(folder, each, ", and so are the numbers that are taken from it")


def _older(folder: Path, each: Path, so: str) -> Iterator[Check]:
    if is_report(each) and (names := _changed(each)):
        after = listing(names, last="and")
        said = f"{output(each).as_posix()} is older than what it was built from, {after}{so}: build it again"
        at = Location((folder / "report.toml").as_posix())
        yield Check("outputs", each.as_posix(), True, said, at, note="warning")


def _touched(folder: Path) -> Iterator[Check]:
    """A warning if outputs are not as they were built."""
    out = output(folder)
    manifest = manifest_of(out)
    said = ""
    if manifest is None:
        is_there = (out / NAME).exists()
        if is_there or any((out / file).is_file() for _, file, _ in FORMATS.values()):
            what = f"{(out / NAME).as_posix()} is {'damaged' if is_there else 'missing'}"
            said = (
                f"{what}, so that nobody can tell whether {out.as_posix()} is as it was built: build it again"
            )
    elif names := sorted({*changed(out, manifest.outputs), *altered(out)}):
        after = listing(names, last="and")
        said = f"{out.as_posix()} is not as it was built, {after}: 'loopsheet verify' tells more"
    if said:
        at = Location((folder / "report.toml").as_posix())
        yield Check("outputs", f"{folder.as_posix()} as built", True, said, at, note="warning")


def _changed(folder: Path) -> list[str]:
    """The inputs of a report folder that are not as they were when it was built."""
    manifest = manifest_of(output(folder))
    return sorted(changed(folder, manifest.inputs)) if manifest else []
