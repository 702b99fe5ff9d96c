"""An output folder as an RO-Crate 1.1: what is in it, by whom, from what, computed by what.

All of it is read from manifest.json; the date and the licence are the user's words. There is no clock here:
the same folder and the same words give the same bytes.
"""

from __future__ import annotations

import datetime
import hashlib
import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

from .errors import OutputError, UsageError, diagnose
from .results import Manifest, read_manifest

__all__ = ["NAME", "crate", "write"]

NAME = "ro-crate-metadata.json"
SPECIFICATION = "https://w3id.org/ro/crate/1.1"
_SPDX = re.compile(r"[A-Za-z0-9][A-Za-z0-9.+-]{0,99}")
_ADDRESS = re.compile(r"https?://[^\s<>\"{}|\\^`]{1,2000}")
_MEDIA = {
    ".html": "text/html",
    ".tex": "text/x-tex",
    ".xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    ".json": "application/json",
    ".pdf": "application/pdf",
    ".svg": "image/svg+xml",
}
_WHAT = {
    "report.html": "The report as one page, which recalculates itself when a number is changed",
    "report.tex": "The report for LaTeX",
    "report.pdf": "The report for printing",
    "report.xlsx": "The report as a workbook with live formulas",
    "values.json": "Every number in SI, unrounded, with its status and its equation",
    "manifest.json": "The sha256 of what went in and of what came out, and the versions of what computed it",
}

Entity = dict[str, Any]


def write(out: Path, date: str, licence: str, author: str = "", organization: str = "") -> Path:
    """Write the metadata into an output folder.

    Parameters
    ----------
    out : Path
        What ``build`` wrote, unchanged.
    date : str
        The day of publication, YYYY-MM-DD.
    licence : str
        An SPDX identifier or an address.
    author, organization : str
        Whose it is, and who publishes it and employs the author, as ``NAME`` or ``NAME <https://...>``;
        both may be empty.

    Raises
    ------
    InputError
        There is no manifest.
    OutputError
        An output is missing or was changed, or the file cannot be written.
    UsageError
        The date is none, or the licence.
    """
    manifest = read_manifest(out)
    sizes = {name: _size(out, name, digest) for name, digest in manifest.outputs.items()}
    sizes["manifest.json"] = (out / "manifest.json").stat().st_size
    people = tuple(_people(" ".join(author.split()), " ".join(organization.split())))
    text = crate(manifest, sizes, _date(date), _licence(licence), people)
    target, draft = out / NAME, out / f".{NAME}.{os.getpid()}.new"
    try:
        draft.write_text(text, encoding="utf-8", newline="\n")
        draft.replace(target)
    except OSError as error:
        draft.unlink(missing_ok=True)
        raise OutputError(diagnose("LS601", text=target, reason=error.strerror or error)) from error
    return target


def _size(out: Path, name: str, digest: str) -> int:
    file = out / name
    if not file.resolve().is_relative_to(out.resolve()) or not file.is_file():
        raise OutputError(diagnose("LS610", text=name, reason="is missing"))
    content = file.read_bytes()
    if hashlib.sha256(content).hexdigest() != digest:
        raise OutputError(diagnose("LS610", text=name, reason="was changed after it was built"))
    return len(content)


def _date(text: str) -> str:
    try:
        if re.fullmatch(r"\d{4}-\d\d-\d\d", text, re.A):
            return datetime.date.fromisoformat(text).isoformat()
    except ValueError:
        pass
    raise UsageError(diagnose("LS611", text=text, suggestion="for example --date 2026-03-31"))


def _licence(text: str) -> Entity:
    if _ADDRESS.fullmatch(text):
        return {
            "@id": text,
            "@type": "CreativeWork",
            "name": text,
            "description": "The licence of this report",
        }
    if _SPDX.fullmatch(text):
        said = f"The licence that SPDX calls {text}"
        address = f"https://spdx.org/licenses/{text}"
        return {
            "@id": address,
            "@type": "CreativeWork",
            "name": text,
            "description": said,
            "identifier": text,
        }
    raise UsageError(diagnose("LS612", text=text))


def _people(author: str, organization: str) -> Iterator[Entity]:
    """Yield the author and the organization, if there are any."""
    person, house = _named("Person", "#author", author), _named("Organization", "#organization", organization)
    if author:
        yield person | ({"affiliation": {"@id": house["@id"]}} if organization else {})
    if organization:
        yield house


def _named(kind: str, here: str, text: str) -> Entity:
    """Read ``NAME`` or ``NAME <https://...>``: the address, an ORCID or a home page, is then who it is."""
    name, _, address = text.removesuffix(">").rpartition(" <")
    if name and text.endswith(">") and _ADDRESS.fullmatch(address):
        return {"@id": address, "@type": kind, "name": name, "url": address}
    return {"@id": here, "@type": kind, "name": text}


def crate(
    manifest: Manifest, sizes: Mapping[str, int], date: str, licence: Entity, people: Sequence[Entity]
) -> str:
    """The metadata as text.

    Parameters
    ----------
    manifest : Manifest
    sizes : mapping of str to int
        Every file of the crate but the metadata itself, and its bytes.
    date : str
        YYYY-MM-DD.
    licence : dict
        The entity of the licence.
    people : sequence of dict
        The entities of the author and the publisher, as far as there are any.
    """
    files = list(_files(manifest, sizes))
    inputs = [
        {
            "@id": f"#input-{quote(name)}",
            "@type": "CreativeWork",
            "name": name,
            "description": "What the report was computed from; it is not part of this folder",
            "sha256": digest,
        }
        for name, digest in sorted(manifest.inputs.items())
    ]
    software = list(_software(manifest))
    action = {
        "@id": "#build",
        "@type": "CreateAction",
        "name": "loopsheet build",
        "description": "Computed every file of this folder from the inputs",
        "instrument": {"@id": software[0]["@id"]},
        "object": _refer(inputs),
        "result": _refer(files),
    }
    title = manifest.title or "A report of loopsheet"
    root: Entity = {
        "@id": "./",
        "@type": "Dataset",
        "name": title,
        "description": f"{title}: a report whose every number is traced to an equation and recomputed",
        "datePublished": date,
        "license": {"@id": licence["@id"]},
        "hasPart": _refer(files),
        "mentions": {"@id": "#build"},
    }
    for entity in people:
        root["author" if entity["@type"] == "Person" else "publisher"] = {"@id": entity["@id"]}
        action.setdefault("agent", {"@id": entity["@id"]})
    descriptor = {
        "@id": NAME,
        "@type": "CreativeWork",
        "conformsTo": {"@id": SPECIFICATION},
        "about": {"@id": "./"},
    }
    context = [f"{SPECIFICATION}/context", {"sha256": "http://schema.org/sha256"}]
    graph = [descriptor, root, *files, action, *inputs, *software, *people, licence]
    return json.dumps({"@context": context, "@graph": graph}, indent=1, ensure_ascii=False) + "\n"


def _refer(entities: list[Entity]) -> list[Entity]:
    return [{"@id": entity["@id"]} for entity in entities]


def _files(manifest: Manifest, sizes: Mapping[str, int]) -> Iterator[Entity]:
    for name, size in sorted(sizes.items()):
        entity: Entity = {"@id": quote(name), "@type": "File", "name": name}
        entity["description"] = _WHAT.get(name, "A figure of the report")
        entity["encodingFormat"] = _MEDIA.get(Path(name).suffix, "application/octet-stream")
        entity["contentSize"] = str(size)
        if name in manifest.outputs:
            entity["sha256"] = manifest.outputs[name]
        yield entity


def _software(manifest: Manifest) -> Iterator[Entity]:
    """Yield loopsheet first, with its sources as parts and its libraries as what it needs."""
    versions = dict(manifest.versions)
    own = versions.pop("loopsheet", "unknown")
    parts = [
        {
            "@id": f"#loopsheet-{quote(part)}",
            "@type": "SoftwareSourceCode",
            "name": f"loopsheet: {part}",
            "version": own,
            "sha256": digest,
        }
        for part, digest in manifest.sources.items()
    ]
    needed = [
        {
            "@id": f"#{quote(name)}-{quote(version)}",
            "@type": "SoftwareApplication",
            "name": name,
            "softwareVersion": version,
        }
        for name, version in versions.items()
    ]
    yield {
        "@id": f"#loopsheet-{quote(own)}",
        "@type": "SoftwareApplication",
        "name": "loopsheet",
        "softwareVersion": own,
        "hasPart": _refer(parts),
        "softwareRequirements": _refer(needed),
    }
    yield from (*parts, *needed)
