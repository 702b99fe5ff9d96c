"""ro-crate-metadata.json: an RO-Crate 1.1 as a graph of entities, in the words of schema.org."""

from __future__ import annotations

from msgspec import field

from .form import Form


class Reference(Form, frozen=True, kw_only=True):
    """One entity named by another."""

    id: str = field(name="@id")


class Entity(Form, frozen=True, kw_only=True, omit_defaults=True, rename="camel"):
    """A file, somebody, a program, what was done: whatever of this is told of it."""

    id: str = field(name="@id")
    type: str = field(name="@type")
    name: str = ""
    description: str = ""
    conforms_to: Reference | None = None
    about: Reference | None = None
    date_published: str = ""
    license: Reference | None = None
    identifier: str = ""
    encoding_format: str = ""
    content_size: str = ""
    version: str = ""
    sha256: str = ""
    software_version: str = ""
    instrument: Reference | None = None
    object: list[Reference] | None = None
    result: list[Reference] | None = None
    agent: Reference | None = None
    has_part: list[Reference] | None = None
    software_requirements: list[Reference] | None = None
    mentions: Reference | None = None
    author: Reference | None = None
    publisher: Reference | None = None
    url: str = ""
    affiliation: Reference | None = None


class Crate(Form, frozen=True, kw_only=True):
    """All entities, and where their words are explained."""

    context: list[str | dict[str, str]] = field(name="@context")
    graph: list[Entity] = field(name="@graph")
