"""What was made once is kept for the next run, by the content of all that it was made from.

It lies in the user's cache folder and is believed only there: the folder is the user's own and nobody else's,
and a file counts only if it holds what was written. What is damaged, foreign or of other sources is made
again; where nothing can be kept, nothing is. No result depends on it.
"""

from __future__ import annotations

import hashlib
import json
import os
import stat
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

from .provenance import sources, versions
from .stopping import unstoppable
from .timing import timed

SETTING = "LOOPSHEET_CACHE"
"""The variable that names another folder; if it is empty, nothing is kept."""

UNTOLD = ("markupsafe", "msgspec", "pint", "scipy")
"""Libraries that the manifest does not tell of."""

LARGEST = 300_000_000
"""Bytes. Above that, what was not used for the longest time goes."""

_LOOKS = 100
"""How often a process looks whether there is too much while it writes so much."""

_DAY = 86_400.0
_HASH = 64

_written: dict[Path, int] = {}
"""Bytes that this process put into a folder since it last looked."""


def kept(what: str, parts: Iterable[str | bytes], make: Callable[[], Any] | None) -> Any:
    """What `make` returns, made now or before.

    Parameters
    ----------
    what : str
        What it is, in a word or two.
    parts : iterable of str or bytes
        All that it is made from, but the sources of loopsheet, its libraries and Python: those are known.
    make : callable, optional
        Returns data that JSON can hold; without it, None is returned for what was not made before. What
        is returned here has been through JSON in any case: it is the same whether it was made now or before.
    """
    folder = place()
    if folder is None:
        if make is None:
            return None
        with timed(what):
            return json.loads(json.dumps(make()))
    made_by = _made_by()
    name = hashlib.sha256(b"".join(_framed(part) for part in (made_by, what, *parts))).hexdigest()
    with timed(f"{what}, kept before"):
        found = _read(folder / name)
    if found is not None or make is None:
        return None if found is None else json.loads(found)
    with timed(what):
        content = json.dumps(make()).encode()
    if json.loads(made_by)[0] == sources():
        _write(folder, name, content)
    else:
        _made_by.cache_clear()  # somebody changed the sources while they ran
    return json.loads(content)


@contextmanager
def nothing_kept() -> Iterator[None]:
    """Make everything again in the block, and keep nothing of it; so do processes that begin there."""
    before = os.environ.get(SETTING)
    os.environ[SETTING] = ""
    try:
        yield
    finally:
        if before is None:
            del os.environ[SETTING]
        else:
            os.environ[SETTING] = before


def place() -> Path | None:
    """The folder in which things are kept; None if there is none that is the user's alone."""
    try:
        folder = _place()
        if folder is None:
            return None
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        return folder if _is_private(folder.lstat(), stat.S_ISDIR) else None
    except (OSError, RuntimeError, ValueError):  # no home, no room, no such name
        return None


def told() -> str:
    """Where things are kept, in a line for ``--timing``."""
    if where := place():
        return f"kept for the next run in {where}"
    if os.environ.get(SETTING) == "":
        return "nothing was kept, as was asked for"
    return "nothing was kept: there is no folder for it that belongs to this user alone"


def _place() -> Path | None:
    named = os.environ.get(SETTING)
    if named is not None:
        return Path(named) if named else None
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData/Local") / "loopsheet" / "kept"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "loopsheet" / "kept"
    given = Path(os.environ.get("XDG_CACHE_HOME", ""))
    return (given if given.is_absolute() else Path.home() / ".cache") / "loopsheet" / "kept"


def _is_private(found: os.stat_result, kind: Callable[[int], bool]) -> bool:
    """Whether something is of a kind, ours, and open to nobody else."""
    if sys.platform == "win32":  # whose folder of settings nobody else may enter
        return kind(found.st_mode)
    return kind(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & 0o077


@cache
def _made_by() -> str:
    """The sources that run and what they run on."""
    from importlib.metadata import version

    return json.dumps([sources(), versions(), {name: version(name) for name in UNTOLD}, sys.version])


def _framed(part: str | bytes) -> bytes:
    """A part with its length: two parts are not one."""
    content = part.encode(errors="surrogatepass") if isinstance(part, str) else part
    return b"%d %s" % (len(content), content)


def _checksum(name: str, content: bytes) -> bytes:
    return hashlib.sha256(name.encode() + content).hexdigest().encode()


def _read(path: Path) -> bytes | None:
    """What a file holds, if it is all that was written under this name."""
    try:
        if not _is_private(path.lstat(), stat.S_ISREG):
            return None
        whole = path.read_bytes()
        if whole[:_HASH] != _checksum(path.name, whole[_HASH:]):
            return None
        os.utime(path)
    except OSError:
        return None
    return whole[_HASH:]


def _write(folder: Path, name: str, content: bytes) -> None:
    """Put a file in place as a whole, and make room for it; what cannot be kept is not."""
    with suppress(OSError), unstoppable():
        handle, draft = tempfile.mkstemp(prefix=".", dir=folder)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(_checksum(name, content) + content)
            os.replace(draft, folder / name)
        except OSError:
            os.unlink(draft)
            raise
        # A folder of thousands of files is not looked through for each that is put into it.
        _written[folder] = _written.get(folder, LARGEST) + len(content)
        if _written[folder] > LARGEST // _LOOKS:
            _make_room(folder)
            _written[folder] = 0


def _make_room(folder: Path) -> None:
    """Remove what a killed run left, and what was not used for long where there is too much."""
    files = sorted(((file.stat(), file) for file in folder.iterdir()), key=lambda each: -each[0].st_mtime)
    size = 0
    for found, file in files:
        size += found.st_size
        if size > LARGEST or (file.name.startswith(".") and time.time() - found.st_mtime > _DAY):
            file.unlink(missing_ok=True)
