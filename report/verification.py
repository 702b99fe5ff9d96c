"""Builds a report again and says what is not as it was: what went in, what computed it, what came out."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from .archive.crate import altered
from .archive.differences import EPS, Differences, compare
from .build import build
from .files.form import Index
from .files.manifest import Manifest, read_manifest
from .files.values import NAME, read_result
from .inputs.folders import built_from
from .inputs.inputs import Find
from .machine.kept import nothing_kept
from .machine.scratch import scratch
from .machine.staging import half_moved
from .messages.diagnostics import Check
from .messages.errors import InputError
from .quantity import behind
from .result.agreement import LIMIT
from .result.result import Report
from .study import Study
from .views import FORMATS
from .which_workbook import shipped_workbook

_UNTOLD = "lies there, but is no part of the build that its manifest tells of"
_UNEXPLAINED = (
    "input, sources, libraries and processor are the same, so nothing that is recorded explains it; an "
    "output was edited together with its fingerprint, or a program that the manifest does not tell made it"
)
_NOT_OF_CRATE = "is not as the crate has it"
_ENDS = ", in the ends of its lines alone: '* -text' in .gitattributes keeps Git from that"
_HALF = "a build was killed while it put its files in place: some are of it, some are older"


@dataclass(frozen=True)
class Verification:
    """What was found when a report was built again."""

    checks: tuple[Check, ...]
    """Of the kinds ``input``, ``source``, ``library``, ``output`` and ``number``."""
    differences: Differences | None
    """Number by number; None if the report that was there has no readable values.json."""
    verdict: str
    """The conclusion, in a sentence."""


def verify(
    out: Path,
    folder: Path | None,
    step: Callable[[str], None] = lambda _: None,
    find: Find = shipped_workbook,
) -> Verification:
    """Build a report again in a temporary folder and compare it with what is there, which stays as it is.

    Parameters
    ----------
    out : Path
        What ``build`` wrote.
    folder : Path, optional
        The report folder; without it, :func:`~loopsheet.report.inputs.folders.built_from` finds it.
    step : callable
        Told what is begun.
    find : callable
        As for :class:`~loopsheet.report.study.Study`: without it, code that came with the folder is not run.

    Raises
    ------
    InputError
        `out` has no manifest, or the report folder is not as it must be.
    UsageError
        It is not known from which folder `out` was built.
    """
    then = read_manifest(out)
    folder = built_from(out, then.inputs) if folder is None else folder
    with scratch() as place, nothing_kept():
        again = place / "out"
        # What a manifest leaves out may lie there all the same, and be taken for a part of the report.
        formats = [
            name for name, (_, file, _) in FORMATS.items() if file in then.outputs or (out / file).is_file()
        ]
        report, _ = build(Study(folder, find, step), again, formats, len(then.engines) > 1)
        now = read_manifest(again)
        differences = _numbers(out, again, report) if NAME in then.outputs else None
        # What is correctly rounded is the same on every processor.
        rounded = "" if report.exactly else _rounded_otherwise(then, now, differences)
        checks = (
            *_same("input", then.inputs, now.inputs, "the input", folder),
            *_same("source", then.sources, now.sources, "the"),
            *_same("library", then.software, now.software, ""),
            *_statements(then, now),
            *_outputs(out, then, now, rounded),
            *(Check("output", name, False, f"{name} {_NOT_OF_CRATE}") for name in altered(out)),
            *(_moves(differences) if differences else _unread(out)),
        )
        verdict = _verdict(checks, then, now, differences, rounded, bool(report.exactly))
    return Verification(checks, differences, verdict)


def _rounded_otherwise(then: Manifest, now: Manifest, found: Differences | None) -> str:
    """What another processor did to the outputs, in words; empty if that is not all that happened."""
    of = (then.inputs, then.sources, then.software), (now.inputs, now.sources, now.software)
    if of[0] != of[1] or then.processor == now.processor or found is None or found.any or not found.noise:
        return ""
    return f"another processor rounds {found.noise} numbers otherwise"


def _ends_alone(file: Path, was: str) -> bool:
    """Whether a file is what it was but for the ends of its lines."""
    plain = file.read_bytes().replace(b"\r\n", b"\n")
    return was in (hashlib.sha256(each).hexdigest() for each in (plain, plain.replace(b"\n", b"\r\n")))


def _same(
    kind: str, then: Mapping[str, str], now: Mapping[str, str], what: str, folder: Path | None = None
) -> Iterator[Check]:
    """A check for each name that there was or is; `folder`: where their files are."""
    if not then and now:
        yield Check(kind, "all", True, f"the manifest does not say with which {kind}s", skipped=True)
        return
    for name in sorted({*then, *now}):
        was, is_now = then.get(name), now.get(name)
        said = f"{what} {name}".strip()
        if was == is_now:
            yield Check(kind, name, True, f"{said} is the same")
        elif was is None:
            yield Check(kind, name, False, f"{said} is new")
        elif is_now is None:
            yield Check(kind, name, False, f"{said} is not there any more")
        elif kind == "library":
            yield Check(kind, name, False, f"{said} was {was} and is {is_now}")
        else:
            ends = _ENDS if folder and _ends_alone(folder / name, was) else ""
            yield Check(kind, name, False, f"{said} was changed{ends}")


def _statements(then: Manifest, now: Manifest) -> Iterator[Check]:
    """A check for what a manifest says of the report otherwise than one that is built again."""
    for name, was, is_now in (("title", then.title, now.title), ("values", then.values, now.values)):
        if was and was != is_now:
            said = f"the {name} was '{was}', as the manifest says, and is '{is_now}' when it is built again"
            yield Check("manifest", name, False, said)


def _outputs(out: Path, then: Manifest, now: Manifest, rounded: str) -> Iterator[Check]:
    """Each file as it was built, as it is there, as it is built again.

    What the last digits of numbers make another file is the same report, if nothing but `rounded` is known.
    """
    if half_moved(out):
        yield Check("output", "all", False, _HALF)
    for name in sorted({*then.outputs, *now.outputs}):
        was, again = then.outputs.get(name), now.outputs.get(name)
        file = out / name
        if was is None:
            yield Check(
                "output", name, False, f"{name} {_UNTOLD if file.is_file() else 'was not built then'}"
            )
        elif not _is_inside(out, file) or not file.is_file():
            yield Check("output", name, False, f"{name} is missing")
        elif hashlib.sha256(file.read_bytes()).hexdigest() != was:
            also = "" if again == was else "; built again it is another file than it was then, too"
            yield Check("output", name, False, f"{name} was changed after it was built{also}")
        elif again is None:
            yield Check("output", name, False, f"{name} was built then, and is not now")
        else:
            said = "is the same, byte for byte" if again == was else "is another file when it is built again"
            told = f": {rounded}" if rounded and again != was else ""
            yield Check("output", name, again == was or bool(rounded), f"{name} {said}{told}")


def _is_inside(out: Path, file: Path) -> bool:
    """A manifest that was tampered with must not make us read other files."""
    return file.resolve().is_relative_to(out.resolve())


def _numbers(out: Path, again: Path, report: Report) -> Differences | None:
    try:
        before = read_result(out / NAME)
    except InputError:
        return None  # missing or changed by hand: told of the file
    after = read_result(again / NAME)
    if before.cells == after.cells:
        return compare(before, after)  # nothing to allow for
    return compare(before, after, _allowed(report))


def _allowed(report: Report) -> dict[str, dict[Index, float]]:
    """What rounding may do: each of two engines may be off by what the judge of the engines allows."""
    from .judge.bounds import MOVES, RoundingBounds

    found = RoundingBounds(report.sheet, report.values.layouts, report.values.value).after_moves(MOVES - 1)
    return {
        column.name: {
            label: 2 * LIMIT * EPS * float(bound) if bound < float("inf") else 0.0
            for label, bound in zip(report.values.labels(column), found[column.name], strict=True)
        }
        for column in report.sheet.columns
    }


def _unread(out: Path) -> Iterator[Check]:
    """Why no number is compared, where that is not told of the file itself."""
    if (out / NAME).is_file():
        try:
            read_result(out / NAME)
        except InputError as error:
            yield Check(
                "number", "all", True, f"no number is compared: {error.diagnostics[0].message}", skipped=True
            )


def _moves(found: Differences) -> Iterator[Check]:
    from .views.differences import moved, reordered

    for move in found.moved:
        was, now, by = moved(move)
        said = f"{move.named} was {was} and is {now}" + behind(move.unit)
        yield Check("number", move.address, False, f"{said} ({by})" if by else said)
    for word, names in (("new", found.added), ("not there any more", found.removed)):
        for name in names:
            yield Check("number", name, False, f"{name} is {word}")
    kinds = {"method": found.method, "row": found.rows, "published": found.published}
    kinds |= {"data": found.checks, "printed": found.printed}
    for kind, changes in kinds.items():
        for change in changes:
            said = (
                f"{change.name} was '{change.before or 'not there'}' and is '{change.after or 'not there'}'"
            )
            yield Check(kind, change.name, False, said)
    for rows, said in zip(found.order, reordered(found), strict=True):
        yield Check("order", rows, True, said, note="expected")


def _verdict(
    checks: tuple[Check, ...],
    then: Manifest,
    now: Manifest,
    found: Differences | None,
    rounded: str,
    exactly: bool,
) -> str:
    """What changed, as far as it is known."""
    failed = [check for check in checks if not check.passed]
    if not failed:
        return "the same report again" + (f": {rounded}" if rounded else "")
    by_kind = {kind: [c.name for c in failed if c.kind == kind] for kind in ("input", "source", "library")}
    words = {"input": "the input", "source": "the sources of loopsheet", "library": "the libraries"}
    changed = [f"{words[kind]} ({', '.join(names)})" for kind, names in by_kind.items() if names]
    if changed:
        return f"different: {' and '.join(changed)} changed"
    if any(check.message == _HALF for check in failed):
        return f"different: {_HALF}; build it again"
    since = ("after it was built", "is missing", _UNTOLD, _NOT_OF_CRATE)
    if all(check.message.endswith(since) for check in failed if check.kind == "output"):
        return "different: the outputs were changed after they were built, and nothing else was"
    if not then.sources:
        return "different: the manifest does not say with which sources it was built"
    if found is not None and not found.any and found.noise and not exactly:
        return f"different: nothing changed but the machine, which rounds {found.noise} numbers otherwise"
    if then.processor == now.processor:
        return f"different: {_UNEXPLAINED}"
    return "different: input, sources and libraries are the same; other programs or the machine made it"
