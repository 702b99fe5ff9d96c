"""Where files are written: beside what they replace, moved in whole or not at all."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import EXHAUSTED, Location, OutputError, diagnose
from .scratch import left_over, locked, scratch
from .stopping import unstoppable

__all__ = ["half_moved", "put", "replaced", "staged"]

PATIENCE = 60.0
"""Seconds to wait for somebody else who builds into the same folder."""


def put(path: Path, content: str | bytes) -> None:
    """Write a file, and the folders above it.

    Parameters
    ----------
    path : Path
    content : str or bytes
        Text is written as UTF-8.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        path.write_bytes(content.encode() if isinstance(content, str) else content)
    except OSError as error:
        error.filename = error.filename or str(path)  # a full disk does not say which file
        raise


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
    target = path.resolve()
    try:
        # An administrator may write anything: what counts is what the owner has said.
        if not target.stat().st_mode & 0o222 or not os.access(target, os.W_OK):
            raise PermissionError("it is read-only")
        with scratch(target.parent) as stage, unstoppable():
            draft = stage / target.name
            draft.write_bytes(after)
            shutil.copymode(target, draft)
            if target.read_bytes() != before:
                raise PermissionError("somebody has changed it meanwhile")
            os.replace(draft, target)
    except OSError as error:
        reason = error.strerror or str(error)
        raise OutputError(
            diagnose("LS613", Location(path.as_posix()), text=path.name, reason=reason)
        ) from error


@contextmanager
def staged(out: Path) -> Iterator[Path]:
    """Give a temporary folder beside the output, moved in whole when the block ends well.

    Who builds into the same folder meanwhile waits for some time, and is told then.

    Parameters
    ----------
    out : Path
        The output; made if it does not exist.

    Raises
    ------
    OutputError
        It cannot be written, or something stands in the way; all is left as it was then.
    """
    if out.exists() and not out.is_dir():
        raise OutputError(diagnose("LS602", text=str(out)))
    made = [p for p in (out, *out.parents) if not p.exists()]
    stage = out
    try:
        out.mkdir(parents=True, exist_ok=True)
        with _alone(out), scratch(out) as stage:
            yield stage
            with unstoppable():
                _move_in(stage, out)
    except OSError as error:
        _remove(made)
        file, place = Path(error.filename or ""), out
        if stage != out:
            if error.errno not in EXHAUSTED or not file.is_relative_to(stage):
                raise  # not about what we write
            place = out / file.relative_to(stage)
        reason = error.strerror or str(error)
        raise OutputError(diagnose("LS601", text=place.as_posix(), reason=reason)) from error
    except BaseException:
        _remove(made)
        raise


@contextmanager
def _alone(out: Path) -> Iterator[None]:
    try:
        lock = locked(out, PATIENCE)
    except BlockingIOError as error:
        raise OutputError(diagnose("LS621", text=out, seconds=f"{PATIENCE:g}")) from error
    try:
        yield
    finally:
        if lock is not None:
            os.close(lock)


def half_moved(out: Path) -> bool:
    """Whether a build was killed while it put its files in place: what is there is of two builds then."""
    for stage in left_over(out):
        try:
            listed = json.loads((stage / "manifest.json").read_text(encoding="utf-8"))["outputs"]
            if any(not (stage / name).exists() for name in listed):
                return True  # the manifest goes last
        except (OSError, ValueError, LookupError, TypeError):
            continue  # it was killed before it had all its files, or when all were in place
    return False


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
            kept = _kept(target, before / name)
            done.append((target, kept))
            if name in names:
                target.parent.mkdir(parents=True, exist_ok=True)
                os.replace(stage / name, target)
            else:
                target.unlink()
    except OSError as error:
        for target, kept in reversed(done):
            if kept is None:
                target.unlink(missing_ok=True)
            else:
                os.replace(kept, target)
        reason = error.strerror or str(error)
        raise OutputError(diagnose("LS601", text=str(out), reason=reason)) from error


def _kept(target: Path, place: Path) -> Path | None:
    """Give a file that is there another name too: a reader finds the old one or the new, never none."""
    if not os.path.lexists(target):
        return None
    place.parent.mkdir(parents=True, exist_ok=True)
    try:
        os.link(target, place, follow_symlinks=False)
    except OSError:  # not every file system has such names
        shutil.copy2(target, place, follow_symlinks=False)
    return place


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
