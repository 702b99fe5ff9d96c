"""An output folder as an RO-Crate 1.1: what is in it, by whom, from what, computed by what.

All of it is read from manifest.json; the date and the licence are the user's words. The inputs are copied
into the crate, which can be built again from itself then. There is no clock here: the same folder and the
same words give the same bytes.
"""

from __future__ import annotations

import datetime
import hashlib
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from urllib.parse import quote

from msgspec.structs import replace

from ..files.crate import Crate, Entity, Reference
from ..files.form import indented, load
from ..files.manifest import Manifest, read_manifest
from ..inputs.folders import INPUTS, built_from, changed
from ..machine.scratch import scratch
from ..machine.staging import put
from ..machine.stopping import unstoppable
from ..messages.errors import Location, LoopsheetError, OutputError, UsageError, diagnose, why

NAME = "ro-crate-metadata.json"
_BUILD = "loopsheet build"
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
    ".csv": "text/csv",
    ".toml": "application/toml",
    ".py": "text/x-python",
}
_WHAT = {
    "report.html": "The report as one page, which recalculates itself when a number is changed",
    "report.tex": "The report for LaTeX",
    "report.pdf": "The report for printing",
    "report.xlsx": "The report as a workbook with live formulas",
    "values.json": "Every number in SI, unrounded, with its status and its equation",
    "manifest.json": "The sha256 of what went in and of what came out, and the versions of what computed it",
}


def write(
    out: Path,
    date: str,
    licence: str,
    author: str = "",
    organization: str = "",
    folder: Path | None = None,
) -> Path:
    """Write the metadata into an output folder, and what it was built from.

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
    folder : Path, optional
        The report folder; without it, :func:`~loopsheet.report.inputs.folders.built_from` finds it.

    Raises
    ------
    InputError
        There is no manifest.
    OutputError
        An output or an input is missing or was changed, or a file cannot be written.
    UsageError
        The date is none, or the licence; it is not known from which folder `out` was built.
    """
    manifest = read_manifest(out)
    sizes = {name: len(_read(out, name, digest)) for name, digest in manifest.outputs.items()}
    sizes["manifest.json"] = (out / "manifest.json").stat().st_size
    people = tuple(_people(" ".join(author.split()), " ".join(organization.split())))
    words = _date(date), _licence(licence)
    source = built_from(out, manifest.inputs) if folder is None else folder
    inputs = {f"{INPUTS}/{name}": _read(source, name, digest) for name, digest in manifest.inputs.items()}
    _refuse_what_somebody_changed(out, inputs)
    sizes |= {name: len(content) for name, content in inputs.items()}
    made = inputs | {NAME: crate(manifest, sizes, *words, people).encode()}
    try:
        with scratch(out) as stage, unstoppable():
            for name, content in made.items():
                put(stage / name, content)
            for name in made:
                (out / name).parent.mkdir(parents=True, exist_ok=True)
                (stage / name).replace(out / name)
    except OSError as error:
        raise OutputError(diagnose("LS601", text=out / NAME, **why(error))) from error
    return out / NAME


def _read(folder: Path, name: str, digest: str) -> bytes:
    """Return a file as the manifest has it."""
    file = folder / name
    if not file.resolve().is_relative_to(folder.resolve()) or not file.is_file():
        raise _not_as_built(folder, name, "is missing")
    content = file.read_bytes()
    if hashlib.sha256(content).hexdigest() != digest:
        raise _not_as_built(folder, name, "was changed after it was built")
    return content


def _not_as_built(folder: Path, name: str, reason: str, helps: str = "build the report again") -> OutputError:
    place = Location((folder / name).as_posix())
    return OutputError(diagnose("LS610", place, text=name, reason=reason, suggestion=helps))


def _refuse_what_somebody_changed(out: Path, inputs: Mapping[str, bytes]) -> None:
    """Replace no file that is neither the one to write nor as the crate before has it."""
    before = added(out)
    for name, content in inputs.items():
        if not (out / name).resolve().is_relative_to(out.resolve()):
            raise _not_as_built(out, name, "leads out of the folder", "delete the link")
        if not (out / name).is_file():
            continue
        there = (out / name).read_bytes()
        if there != content and hashlib.sha256(there).hexdigest() != before.get(Path(name)):
            raise _not_as_built(
                out, name, "was changed after it was put there", "delete it: it is copied again then"
            )


def added(out: Path) -> dict[Path, str]:
    """The sha256 of what :func:`write` added to an output folder, as it was then; empty if there is no crate.

    The metadata does not hold its own sha256: it is written again from its words and the manifest.
    """
    try:
        graph = load(out / NAME, Crate).graph
        entities = {entity.id: entity for entity in graph}
        if entities["#build"].name != _BUILD:
            return {}
        files = [entity for entity in graph if entity.type == "File"]
        inputs = {Path(file.name): file.sha256 for file in files if _is_input(file.name)}
        root, sizes = entities["./"], {file.name: int(file.content_size) for file in files}
        licence = entities[root.license.id if root.license else ""]
        people = [entity for entity in graph if entity.type in ("Person", "Organization")]
    except (ValueError, LookupError):
        return {}  # no crate, or none of ours
    try:
        metadata = crate(read_manifest(out), sizes, root.date_published, licence, people).encode()
    except (LoopsheetError, LookupError):
        metadata = b""  # not of this manifest
    return {**inputs, Path(NAME): hashlib.sha256(metadata).hexdigest()}


def altered(out: Path) -> list[str]:
    """The names of what :func:`write` added to an output folder, and what is not as it was then."""
    try:
        json.loads((out / NAME).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return []
    except (OSError, ValueError):
        return [NAME]  # of the others nobody can tell
    return sorted(changed(out, {name.as_posix(): digest for name, digest in added(out).items()}))


def _date(text: str) -> str:
    try:
        if re.fullmatch(r"\d{4}-\d\d-\d\d", text, re.A):
            return datetime.date.fromisoformat(text).isoformat()
    except ValueError:
        pass
    raise UsageError(diagnose("LS611", text=text, suggestion="for example --date 2026-03-31"))


def _licence(text: str) -> Entity:
    if _ADDRESS.fullmatch(text):
        return Entity(id=text, type="CreativeWork", name=text, description="The licence of this report")
    if _SPDX.fullmatch(text):
        said = f"The licence that SPDX calls {text}"
        address = f"https://spdx.org/licenses/{text}"
        return Entity(id=address, type="CreativeWork", name=text, description=said, identifier=text)
    raise UsageError(diagnose("LS612", text=text))


def _people(author: str, organization: str) -> Iterator[Entity]:
    """Yield the author and the organization, if there are any."""
    person, house = _named("Person", "#author", author), _named("Organization", "#organization", organization)
    if author:
        yield replace(person, affiliation=Reference(id=house.id)) if organization else person
    if organization:
        yield house


def _named(kind: str, here: str, text: str) -> Entity:
    """Read ``NAME`` or ``NAME <https://...>``: the address, an ORCID or a home page, is then who it is."""
    name, _, address = text.removesuffix(">").rpartition(" <")
    if name and text.endswith(">") and _ADDRESS.fullmatch(address):
        return Entity(id=address, type=kind, name=name, url=address)
    return Entity(id=here, type=kind, name=text)


def crate(
    manifest: Manifest, sizes: Mapping[str, int], date: str, licence: Entity, people: Sequence[Entity]
) -> str:
    """The metadata as text.

    Parameters
    ----------
    sizes : mapping of str to int
        Every file of the crate but the metadata itself, and its bytes.
    date : str
        YYYY-MM-DD.
    people : sequence of Entity
        The author and the publisher, as far as there are any.
    """
    given = {f"{INPUTS}/{name}": digest for name, digest in manifest.inputs.items()}
    files = list(_files({name: size for name, size in sizes.items() if name not in given}, manifest.outputs))
    inputs = list(_files({name: sizes[name] for name in given}, given))
    software = list(_software(manifest))
    named = {entity.type: Reference(id=entity.id) for entity in people}
    action = Entity(
        id="#build",
        type="CreateAction",
        name=_BUILD,
        description="Computed every file of this folder from the inputs",
        instrument=Reference(id=software[0].id),
        object=_refer(inputs),
        result=_refer(files),
        agent=next(iter(named.values()), None),
    )
    title = manifest.title or "A report of loopsheet"
    root = Entity(
        id="./",
        type="Dataset",
        name=title,
        description=f"{title}: a report whose every number is traced to an equation and recomputed",
        date_published=date,
        license=Reference(id=licence.id),
        has_part=_refer([*files, *inputs]),
        mentions=Reference(id=action.id),
        author=named.get("Person"),
        publisher=named.get("Organization"),
    )
    conforms = Reference(id=SPECIFICATION)
    descriptor = Entity(id=NAME, type="CreativeWork", conforms_to=conforms, about=Reference(id=root.id))
    context: list[str | dict[str, str]] = [f"{SPECIFICATION}/context", {"sha256": "http://schema.org/sha256"}]
    graph = [descriptor, root, *files, action, *inputs, *software, *people, licence]
    return indented(Crate(context=context, graph=graph))


def _refer(entities: list[Entity]) -> list[Reference]:
    return [Reference(id=entity.id) for entity in entities]


def _files(sizes: Mapping[str, int], hashes: Mapping[str, str]) -> Iterator[Entity]:
    for name, size in sorted(sizes.items()):
        other = "What the report was computed from" if _is_input(name) else "A figure of the report"
        yield Entity(
            id=quote(name),
            type="File",
            name=name,
            description=_WHAT.get(name, other),
            encoding_format=_MEDIA.get(Path(name).suffix, "application/octet-stream"),
            content_size=str(size),
            sha256=hashes.get(name, ""),
        )


def _is_input(name: str) -> bool:
    return name.startswith(f"{INPUTS}/")


def _software(manifest: Manifest) -> Iterator[Entity]:
    """Yield loopsheet first, with its sources as parts and its libraries as what it needs."""
    versions = dict(manifest.software)
    own = versions.pop("loopsheet", "unknown")
    parts = [
        Entity(
            id=f"#loopsheet-{quote(part)}",
            type="SoftwareSourceCode",
            name=f"loopsheet: {part}",
            version=own,
            sha256=digest,
        )
        for part, digest in manifest.sources.items()
    ]
    needed = [
        Entity(
            id=f"#{quote(name)}-{quote(version)}",
            type="SoftwareApplication",
            name=name,
            software_version=version,
        )
        for name, version in versions.items()
    ]
    yield Entity(
        id=f"#loopsheet-{quote(own)}",
        type="SoftwareApplication",
        name="loopsheet",
        software_version=own,
        has_part=_refer(parts),
        software_requirements=_refer(needed),
    )
    yield from (*parts, *needed)
