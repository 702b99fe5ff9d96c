"""Where files are written: beside what they replace, moved in whole or not at all."""

from __future__ import annotations

import hashlib
import os
import shutil
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from itertools import count
from pathlib import Path

from ..messages.errors import EXHAUSTED, Diagnostic, Location, OutputError, diagnose, why
from .scratch import PREFIX, left_over, locked, scratch
from .stopping import unstoppable

PATIENCE = 60.0
"""Seconds to wait for somebody else who builds into the same folder."""


_MANIFEST = Path("manifest.json")
_HEAD = 1000
"""Bytes in which a file of ours says what it is."""


def put(path: Path, content: str | bytes) -> None:
    """Write a file, and the folders above it.

    `content`: text is written as UTF-8.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        path.write_bytes(content.encode() if isinstance(content, str) else content)
    except OSError as error:
        error.filename = error.filename or str(path)  # a full disk does not say which file
        raise


def replaced(path: Path, before: bytes | None, after: bytes) -> None:
    """Replace a user's file as a whole; what it may be read and written by stays as it is.

    Parameters
    ----------
    path : Path
        Where a link leads to is replaced, not the link.
    before : bytes or None
        What was read; a file that somebody has changed since is left alone. None if there was none.

    Raises
    ------
    OutputError
        It cannot be written; it is as it was then.
    """
    target = path.resolve()
    try:
        there = target.exists()
        # An administrator may write anything: what counts is what the owner has said.
        if there and (not target.stat().st_mode & 0o222 or not os.access(target, os.W_OK)):
            raise PermissionError("it is read-only")
        if target.is_dir():
            raise IsADirectoryError("it is a folder")
        with scratch(target.parent) as stage, unstoppable():
            draft = stage / target.name
            draft.write_bytes(after)
            if there:
                shutil.copymode(target, draft)
            if before is not None and target.read_bytes() != before:
                raise PermissionError("somebody has changed it meanwhile")
            os.replace(draft, target)
    except OSError as error:
        raise OutputError(_unwritable(path, error)) from error


def own(path: Path, mark: bytes) -> bytes | None:
    """What a file of the user's choice holds that may be written anew; None if there is none yet.

    Parameters
    ----------
    mark : bytes
        What a file of ours says in its first lines.

    Raises
    ------
    OutputError
        It is somebody else's, or cannot be read.
    """
    try:
        if not path.exists():
            return None
        if path.is_dir():
            raise IsADirectoryError("it is a folder")
        content = path.read_bytes()
    except OSError as error:
        raise OutputError(_unwritable(path, error)) from error
    if mark not in content[:_HEAD]:
        raise OutputError(diagnose("LS623", Location(path.as_posix()), text=path.name, what=mark.decode()))
    return content


def written(path: Path, before: bytes | None, content: bytes) -> None:
    """Write a file of the user's choice as a whole.

    Parameters
    ----------
    before : bytes or None
        What :func:`own` found there.

    Raises
    ------
    OutputError
        It cannot be written; what is there is as it was then.
    """
    if before is None and path.exists():
        raise OutputError(_unwritable(path, PermissionError("somebody has put a file there meanwhile")))
    replaced(path, before, content)


def _unwritable(path: Path, error: OSError) -> Diagnostic:
    return diagnose("LS613", Location(path.as_posix()), text=path.name, **why(error, "of both"))


def strangers(out: Path) -> list[str]:
    """The names in a folder that no build has written into; none of what is hidden, as .gitkeep is.

    Whose manifest is damaged, or whose build was killed, is of a build all the same.
    """
    try:
        names = sorted(path.name for path in out.iterdir())
        manifest = out / "manifest.json"
        if any(name.startswith(PREFIX) for name in names):
            return []
        if manifest.is_file() and b'"loopsheet"' in manifest.read_bytes():
            return []
    except OSError:
        return []  # who writes there is told why that cannot be
    return [name for name in names if not name.startswith(".")]


@contextmanager
def staged(
    out: Path,
    tell: Callable[[str], None] = lambda _: None,
    added: Callable[[Path], Mapping[Path, str]] = lambda _: {},
) -> Iterator[Path]:
    """Give a temporary folder beside the output, moved in whole when the block ends well.

    What a build before made of the same inputs, sources and versions, and is as it was built, stays where
    this one does not make it again. A file that is in its way, and that no build made as it is there, is kept
    under another name. Who builds into the same folder meanwhile waits for some time, and is told then.

    Parameters
    ----------
    out : Path
        The output; made if it does not exist.
    tell : callable
        Told which files are kept, and under which name, and which of the report before are removed.
    added : callable
        Given `out`, the sha256 of what was added to it since it was built: that is of the report which is
        there, and is removed with it if another one takes its place.

    Raises
    ------
    OutputError
        It cannot be written, or something stands in the way; all is left as it was then.
    """
    # Of a folder that may not be entered, nothing is known; to make it then says why it cannot be.
    if os.path.exists(out) and not os.path.isdir(out):
        raise OutputError(diagnose("LS602", text=str(out)))
    if not os.path.exists(out):
        refuse_link(out)
    made = [p for p in (out, *out.parents) if not os.path.exists(p)]
    stage = out
    try:
        out.mkdir(parents=True, exist_ok=True)
        with _alone(out):
            killed = [_listed(stage) or {} for stage in left_over(out)]  # the next line removes them
            with scratch(out) as stage:
                yield stage
                with unstoppable():
                    manifest, whole = _together(stage, out)
                    gone = _added(stage, out, manifest, added)
                    kept, removed = _move_in(stage, out, killed, gone, manifest, whole)
                    for name in removed:
                        _remove([out / parent for parent in name.parents[:-1]])
        for name, free in kept.items():
            tell(f"{name.as_posix()} was not as built: it is kept as {free.as_posix()}")
        if told := sorted({name.as_posix() for name in removed if name not in kept}):
            tell(f"{', '.join(told)}: removed, as of the report before")
    except OSError as error:
        _remove(made)
        file, place = Path(error.filename or ""), out
        if stage != out and file.is_relative_to(stage):
            if error.errno not in EXHAUSTED:
                raise  # not about what we write
            place = out / file.relative_to(stage)
        elif file.is_relative_to(out):
            place = file  # of an earlier build, and may not be read
        elif stage != out:
            raise
        raise OutputError(diagnose("LS601", text=place.as_posix(), **why(error))) from error
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
    # The manifest goes last: without one, it was killed before it had all files, or when all were in place.
    return any(not (stage / name).exists() for stage in left_over(out) for name in _listed(stage) or ())


def _remove(made: list[Path]) -> None:
    """Take back the empty folders that were made."""
    for folder in made:
        try:
            folder.rmdir()
        except OSError:
            return


def _move_in(
    stage: Path,
    out: Path,
    killed: list[dict[Path, str]],
    gone: Mapping[Path, str],
    manifest: bytes,
    whole: Collection[Path],
) -> tuple[dict[Path, Path], list[Path]]:
    """Put the staged files in place, all or none; return what was kept, and as what, and what was removed.

    The manifest comes last and never speaks of half an output. What an earlier build made and is not of the
    `whole` is taken away, as is what is `gone`: under its name it would be taken for a part of this report.
    What somebody changed of it is kept under another. `killed` is what other builds were about to put here.
    """
    names = sorted(
        (p.relative_to(stage) for p in stage.rglob("*") if p.is_file()),
        key=lambda name: (name == _MANIFEST, name),
    )
    for name in names:
        _refuse_what_is_in_the_way(out, name)
    before, built = stage / ".before", _listed(out)
    removed = [*gone, *_stale(out, [*names, *whole], built or {})]
    done: list[tuple[Path, Path | None]] = []
    kept_as: dict[Path, Path] = {}
    try:
        for name in _changed(stage, out, (*names, *removed), built, [*killed, gone]):
            kept_as[name] = _free(name, out)
            done.append((out / kept_as[name], None))
            shutil.copy2(out / name, out / kept_as[name])
        for name in (*removed, *names):
            target = out / name
            kept = _kept(target, before / name)
            done.append((target, kept))
            if name in names:
                target.parent.mkdir(parents=True, exist_ok=True)
                if name == _MANIFEST and manifest:
                    (stage / name).write_bytes(manifest)
                os.replace(stage / name, target)
            else:
                target.unlink()
    except OSError as error:
        for target, kept in reversed(done):
            if kept is None:
                target.unlink(missing_ok=True)
            else:
                os.replace(kept, target)
        raise OutputError(diagnose("LS601", text=str(out), **why(error))) from error
    return kept_as, removed


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
        error = FileExistsError("a folder has this name")
        raise OutputError(diagnose("LS601", text=name.as_posix(), **why(error)))
    for parent in name.parents[:-1]:
        if (out / parent).exists() and not (out / parent).is_dir():
            error = FileExistsError(f"{parent} is a file")
            raise OutputError(diagnose("LS601", text=name.as_posix(), **why(error)))
        refuse_link(out / parent)


def refuse_link(folder: Path) -> None:
    """Write nowhere but in folders that were named: where a link leads to was not.

    Raises
    ------
    OutputError
        The folder is a link.
    """
    if os.path.islink(folder):  # false where nobody may enter
        error = FileExistsError(f"it is a link to {os.readlink(folder)}")
        raise OutputError(diagnose("LS601", text=folder.as_posix(), **why(error)))


def _listed(folder: Path) -> dict[Path, str] | None:
    """The sha256 of what a build made, as its manifest says; None if there is none of ours."""
    from ..files.manifest import manifest_of

    found = manifest_of(folder)
    return None if found is None else {Path(name): digest for name, digest in found.outputs.items()}


def _changed(
    stage: Path,
    out: Path,
    names: Collection[Path],
    built: dict[Path, str] | None,
    killed: Collection[Mapping[Path, str]],
) -> Iterator[Path]:
    """What is about to be replaced or removed, and is neither as a build made it nor as it is built now."""
    for name in names:
        path = out / name
        if path.is_symlink() or not path.is_file() or (name == _MANIFEST and built is not None):
            continue
        ours = {listed.get(name) for listed in (built or {}, *killed)}
        now = {_sha256(stage / name)} if (stage / name).is_file() else set()
        if _sha256(path) not in ours | now:
            yield name


def _free(name: Path, out: Path) -> Path:
    """A name that no file has: ``report.edited.tex``, ``report.edited-2.tex``."""
    marks = ("edited" if number == 1 else f"edited-{number}" for number in count(1))
    names = (name.with_name(f"{name.stem}.{mark}{name.suffix}") for mark in marks)
    return next(free for free in names if not os.path.lexists(out / free))


def _added(
    stage: Path, out: Path, manifest: bytes, added: Callable[[Path], Mapping[Path, str]]
) -> dict[Path, str]:
    """What was added to the report that is there, if another one takes its place."""
    old = out / _MANIFEST
    if manifest and old.is_file() and old.read_bytes() == manifest:
        return {}
    return {
        name: digest
        for name, digest in added(out).items()
        if _is_there(out, name) and not (stage / name).exists()
    }


def _together(stage: Path, out: Path) -> tuple[bytes, list[Path]]:
    """The manifest of what is staged and of what stays, and their names.

    What stays is what a build before made of the very same inputs by the very same sources and versions.
    """
    from ..files.form import text
    from ..files.manifest import manifest_of

    new, old = manifest_of(stage), manifest_of(out)
    if new is None:
        return b"", []  # of nothing that is built
    stays = {}
    if old is not None and old.of(new.outputs) == new:
        stays = {
            name: digest
            for name, digest in old.outputs.items()
            if _is_there(out, Path(name)) and _sha256(out / name) == digest
        }
    whole = dict(sorted((stays | new.outputs).items()))
    return text(new.of(whole)).encode(), [*map(Path, whole)]


def _is_there(out: Path, name: Path) -> bool:
    """Whether what a manifest names is a file of an output; no name and no link lead outside of it."""
    if name.is_absolute() or ".." in name.parts or not os.path.isfile(out / name):
        return False  # or a name that no file can have
    return (out / name).resolve() == out.resolve() / name


def _stale(out: Path, names: Collection[Path], built: dict[Path, str]) -> list[Path]:
    """What an earlier build made, and this build does not make."""
    return [name for name in sorted(built) if name not in names and _is_there(out, name)]


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
