"""manifest.json: what went in, what came out and what computed it, by content; no clock and no place."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

from msgspec import Meta, field
from msgspec.structs import replace

from .form import Form, Malformed, Schema, Text, load, read

NAME = "manifest.json"

FileName = Annotated[Text, Meta(max_length=1000)]
Sums = dict[FileName, Text]


class Manifest(Form, frozen=True, kw_only=True):
    """What a build says of itself.

    Parameters
    ----------
    schema : 1
    title : str
        The report's.
    inputs, outputs, sources : table of str
        The sha256 of every file and part of the program, by name; `sources` is empty if it is not told.
    versions : table of str
        The program and its libraries.
    engines : table of str
        Whose agreement the report tells, with the programs that ran them; empty if that is this one.
    processor : str
        On which it ran; empty if it is not told.
    values : str
        Whether the values are correctly rounded.
    """

    schema: Schema
    title: Text = ""
    inputs: Annotated[Sums, Meta(min_length=1)]
    outputs: Sums
    sources: dict[Text, Text] = field(default_factory=dict)
    versions: dict[Text, Text]
    engines: dict[Text, Text] = field(default_factory=lambda: {"numpy": ""})
    processor: Text = ""
    values: Text = ""

    def __post_init__(self) -> None:
        for name in (*self.inputs, *self.outputs):
            if any(len(part.encode()) > 255 for part in name.split("/")):
                raise ValueError(f"'{name[:20]}...' can be no file")

    def of(self, outputs: Sums) -> Manifest:
        """The same of other outputs."""
        return replace(self, outputs=outputs)

    @property
    def software(self) -> Mapping[str, str]:
        """The program, its libraries, and the programs that ran other engines."""
        return self.versions | {engine: program for engine, program in self.engines.items() if program}


def read_manifest(folder: Path) -> Manifest:
    """Read the manifest of an output folder.

    Raises
    ------
    InputError
        There is none, or it is none of loopsheet's.
    """
    return read(folder / NAME, Manifest, "LS608")


def manifest_of(folder: Path) -> Manifest | None:
    """The manifest of an output folder; None if there is none that can be read."""
    try:
        return load(folder / NAME, Manifest)
    except Malformed:
        return None


def is_as_built(file: Path, data: bytes) -> bool:
    """Whether what a file holds is what its build wrote; without a manifest beside it nobody can tell."""
    manifest = manifest_of(file.parent)
    built = manifest.outputs.get(file.name) if manifest else None
    return built in (None, hashlib.sha256(data).hexdigest())
