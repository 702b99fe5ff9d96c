"""Temporary folders: gone at the end however it comes, and what a killed run left is removed by the next one.

Each is locked while somebody works in it, so that what nobody holds is known to be left over. Where there are
no such locks (Windows, some network drives) nothing is taken for left over.
"""

from __future__ import annotations

import os
import shutil
import stat
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .stopping import unstoppable

if sys.platform != "win32":
    import fcntl

PREFIX = ".loopsheet-"
_NAME = f"{PREFIX}{'[a-z0-9_]' * 8}"
"""How `tempfile` calls them; nobody calls a folder of theirs so."""


@contextmanager
def scratch(parent: Path | None = None) -> Iterator[Path]:
    """Give a folder to make something in.

    Parameters
    ----------
    parent : Path, optional
        Where it is; the system's place for temporary files otherwise.

    Raises
    ------
    OSError
        There can be none.
    """
    system = Path(tempfile.gettempdir())
    with unstoppable():
        for place in {system, parent or system}:
            for folder in left_over(place):
                shutil.rmtree(folder, ignore_errors=True)
        folder, lock = _made(parent or system)
    try:
        yield folder
    finally:
        with unstoppable():
            if lock is not None:
                os.close(lock)  # first, for removing takes open files too, of which there may be too many
            shutil.rmtree(folder, ignore_errors=True)


def left_over(place: Path) -> Iterator[Path]:
    """Yield our folders in which nobody works any more, each locked until the next one is asked for."""
    if sys.platform == "win32":
        return
    for folder in sorted(place.glob(_NAME)):
        try:
            found = folder.lstat()
            lock = _lock(folder) if stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid() else None
        except OSError:
            continue  # somebody else has just removed it
        if lock is not None:
            try:
                yield folder
            finally:
                os.close(lock)


def locked(folder: Path, seconds: float) -> int | None:
    """Lock a folder against all other processes that do the same; what is returned is to be closed.

    Parameters
    ----------
    seconds : float
        How long to wait for somebody else.

    Returns
    -------
    int or None
        None where nothing can be locked.

    Raises
    ------
    BlockingIOError
        Somebody else still holds it.
    """
    end = time.monotonic() + seconds
    while True:
        try:
            return _lock(folder, tell=True)
        except BlockingIOError:
            if time.monotonic() > end:
                raise
            time.sleep(0.05)


def _made(parent: Path) -> tuple[Path, int | None]:
    while True:
        folder = Path(tempfile.mkdtemp(prefix=PREFIX, dir=parent))
        try:
            lock = locked(folder, 60)
        except FileNotFoundError:
            continue  # somebody took it for left over, just before it was locked
        if folder.exists():
            return folder, lock
        if lock is not None:
            os.close(lock)


def _lock(folder: Path, tell: bool = False) -> int | None:
    if sys.platform == "win32":
        return None
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        os.close(handle)
        if tell and isinstance(error, BlockingIOError):
            raise
        return None
    return handle
