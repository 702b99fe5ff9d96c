"""Where files are written: beside what they replace, moved in whole or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import Location, OutputError, diagnose

__all__ = ["put", "replaced", "staged"]


def put(path: Path, content: str | bytes) -> None:
    """Write a file, and the folders above it.

    Parameters
    ----------
    path : Path
    content : str or bytes
        Text is written as UTF-8.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content.encode() if isinstance(content, str) else content)


def replaced(path: Path, before: bytes, after: bytes) -> None:
    """Replace a user's file as a whole; what it may be read and written by stays as it is.

    Parameters
    ----------
    path : Path
        Where a link leads to is replaced, not the link.
    before : bytes
        What was read; a file that somebody has changed since is left alone.
    after : bytes

    Raises
    ------
    OutputError
        It cannot be written; it is as it was then.
    """
    target, stage = path.resolve(), None
    try:
        # An administrator may write anything: what counts is what the owner has said.
        if not target.stat().st_mode & 0o222 or not os.access(target, os.W_OK):
            raise PermissionError("it is read-only")
        if target.read_bytes() != before:
            raise PermissionError("somebody has changed it meanwhile")
        handle, stage = tempfile.mkstemp(prefix=".loopsheet-", dir=target.parent)
        with os.fdopen(handle, "wb") as file:
            file.write(after)
        shutil.copymode(target, stage)
        os.replace(stage, target)
    except OSError as error:
        if stage is not None:
            Path(stage).unlink(missing_ok=True)
        reason = error.strerror or str(error)
        raise OutputError(
            diagnose("LS613", Location(path.as_posix()), text=path.name, reason=reason)
        ) from error


@contextmanager
def staged(out: Path) -> Iterator[Path]:
    """Give a temporary folder beside the output, moved in whole when the block ends well.

    Parameters
    ----------
    out : Path
        The output; made if it does not exist.

    Raises
    ------
    OutputError
        It cannot be written, or something stands in the way; all is left as it was then.
    """
    made: list[Path] = []
    try:
        if out.exists() and not out.is_dir():
            raise OutputError(diagnose("LS602", text=str(out)))
        made = [p for p in (out, *out.parents) if not p.exists()]
        out.mkdir(parents=True, exist_ok=True)
        stage = Path(tempfile.mkdtemp(prefix=".loopsheet-", dir=out))
    except OSError as error:
        _remove(made)
        raise OutputError(diagnose("LS601", text=str(out), reason=error.strerror or str(error))) from error
    try:
        yield stage
        _move_in(stage, out)
    except BaseException:
        shutil.rmtree(stage, ignore_errors=True)
        _remove(made)
        raise
    shutil.rmtree(stage, ignore_errors=True)


def _remove(made: list[Path]) -> None:
    """Take back the empty folders that were made."""
    for folder in made:
        try:
            folder.rmdir()
        except OSError:
            return


def _move_in(stage: Path, out: Path) -> None:
    """Put the staged files in place: all of them, or none if one cannot be.

    The manifest comes last and never speaks of half an output. What an earlier build made and this one does
    not is taken away, unless somebody changed it.
    """
    names = sorted(
        (p.relative_to(stage) for p in stage.rglob("*") if p.is_file()),
        key=lambda name: (name.name == "manifest.json", name),
    )
    for name in names:
        _refuse_what_is_in_the_way(out, name)
    before = stage / ".before"
    done: list[tuple[Path, Path | None]] = []
    try:
        for name in (*_stale(out, names), *names):
            target = out / name
            kept = None
            if target.exists():
                kept = before / name
                kept.parent.mkdir(parents=True, exist_ok=True)
                os.replace(target, kept)
            done.append((target, kept))
            if name in names:
                target.parent.mkdir(parents=True, exist_ok=True)
                os.replace(stage / name, target)
    except BaseException as error:
        for target, kept in reversed(done):
            target.unlink(missing_ok=True)
            if kept is not None:
                os.replace(kept, target)
        if isinstance(error, OSError):
            reason = error.strerror or str(error)
            raise OutputError(diagnose("LS601", text=str(out), reason=reason)) from error
        raise


def _refuse_what_is_in_the_way(out: Path, name: Path) -> None:
    """A folder where a file goes, or a file where a folder goes, is the user's: nothing is done then."""
    if (out / name).is_dir():
        raise OutputError(diagnose("LS601", text=name.as_posix(), reason="a folder has this name"))
    for parent in name.parents[:-1]:
        if (out / parent).exists() and not (out / parent).is_dir():
            raise OutputError(diagnose("LS601", text=name.as_posix(), reason=f"{parent} is a file"))


def _stale(out: Path, names: Collection[Path]) -> list[Path]:
    """What the manifest of an earlier build lists, unchanged since, and this build does not make."""
    import hashlib
    import json

    try:
        listed = json.loads((out / "manifest.json").read_text(encoding="utf-8"))["outputs"]
        known = {Path(name): str(digest) for name, digest in listed.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return []  # no earlier build, or a manifest that is not ours
    found = []
    for name, digest in sorted(known.items()):
        path = out / name
        if (
            name in names
            or name.is_absolute()
            or ".." in name.parts
            or path.is_symlink()
            or not path.is_file()
        ):
            continue
        if hashlib.sha256(path.read_bytes()).hexdigest() == digest:
            found.append(name)
    return found
